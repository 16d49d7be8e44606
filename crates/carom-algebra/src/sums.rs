//! Sums of fixed order, in parallel lanes that processors add at once.

/// Number of lanes in which sums are evaluated.
const LANES: usize = 8;

/// Scalar product of two vectors.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    sum([a, b], |[a, b]| a * b)
}

/// Sum of a term of the i-th components, Σ term(aᵢ, bᵢ, …), over vectors of the same length.
#[inline(always)]
pub fn sum<const K: usize>(of: [&[f64]; K], term: impl Fn([f64; K]) -> f64) -> f64 {
    sums(of, |at| [term(at)])[0]
}

/// Sums of several terms in one pass over the vectors, each with the bits of [`sum`].
#[inline(always)]
pub fn sums<const K: usize, const T: usize>(
    of: [&[f64]; K],
    terms: impl Fn([f64; K]) -> [f64; T],
) -> [f64; T] {
    let whole = of.map(|x| x.as_chunks::<LANES>().0);
    let tails = of.map(|x| x.as_chunks::<LANES>().1);
    let mut sums = [[0.0; LANES]; T];
    for i in 0..whole[0].len() {
        let at = whole.map(|x| &x[i]);
        for l in 0..LANES {
            let terms = terms(at.map(|x| x[l]));
            for t in 0..T {
                sums[t][l] += terms[t];
            }
        }
    }
    // The sum of no numbers is −0.
    let mut tail = [-0.0; T];
    for i in 0..tails[0].len() {
        let terms = terms(tails.map(|x| x[i]));
        for t in 0..T {
            tail[t] += terms[t];
        }
    }
    std::array::from_fn(|t| sums[t].iter().sum::<f64>() + tail[t])
}

/// The larger one of two numbers; NaN if one of them is, which [`f64::max`] ignores.
#[inline]
pub fn max_or_nan(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// Largest absolute value of a vector; infinite if a component is not finite.
pub fn max_abs(x: &[f64]) -> f64 {
    let (whole, tail) = x.as_chunks::<LANES>();
    let mut most = [0.0_f64; LANES];
    let mut zeros = [0.0; LANES];
    for x in whole {
        for l in 0..LANES {
            most[l] = if x[l].abs() > most[l] { x[l].abs() } else { most[l] };
            // Zero for finite numbers only.
            zeros[l] += 0.0 * x[l];
        }
    }
    let finite = zeros.iter().all(|zero| *zero == 0.0) && tail.iter().all(|x| x.is_finite());
    if finite { most.iter().chain(tail).fold(0.0, |m, x| f64::max(m, x.abs())) } else { f64::INFINITY }
}
