//! Loops in the widest registers of the machine. Lanes do not depend on the width, so results are
//! bitwise equal on every machine.

/// Number of lanes of a sum; constant, so that the order of summation is.
const LANES: usize = 8;

/// Calls `work` compiled for the widest vector instructions of this processor.
#[inline(always)]
pub fn wide<R>(work: impl FnOnce() -> R) -> R {
    pulp::Arch::new().dispatch(work)
}

/// Subtracts a x from y; x may be of single precision.
#[inline(always)]
pub(crate) fn subtract<T: Copy + Into<f64>>(y: &mut [f64], a: f64, x: &[T]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y -= a * (*x).into();
    }
}

/// Subtracts a₀ x₀ and then a₁ x₁ from y; both x may be of single precision.
#[inline(always)]
pub(crate) fn subtract_both<T: Copy + Into<f64>>(y: &mut [f64], a: [f64; 2], x: [&[T]; 2]) {
    for ((y, x0), x1) in y.iter_mut().zip(x[0]).zip(x[1]) {
        *y = *y - a[0] * (*x0).into() - a[1] * (*x1).into();
    }
}

/// Scalar product x·y, summed in eight lanes; x may be of single precision.
#[inline(always)]
pub(crate) fn dot<T: Copy + Into<f64>>(x: &[T], y: &[f64]) -> f64 {
    let (x, x_tail) = x.as_chunks::<LANES>();
    let (y, y_tail) = y.as_chunks::<LANES>();
    let mut strands = [0.0; LANES];
    for (x, y) in x.iter().zip(y) {
        for l in 0..LANES {
            strands[l] += x[l].into() * y[l];
        }
    }
    let tail: f64 = x_tail.iter().zip(y_tail).map(|(x, y)| (*x).into() * y).sum();
    let [a, b, c, d, e, f, g, h] = strands;
    (((a + e) + (c + g)) + ((b + f) + (d + h))) + tail
}
