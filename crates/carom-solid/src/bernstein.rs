//! The determinant det(∂y/∂ξ) of a cell in Bernstein polynomials, which are ≥ 0 and sum to 1.
//!
//! With control points c of degree k (`shape/hull.rs`), on a simplex with corners e₀ … e_D
//!
//! ```text
//! ∂y/∂ξᵢ ∝ Σ (c_{β+eᵢ} − c_{β+e₀}) B_β,    |β| = k − 1
//! det(∂y/∂ξ) ∝ Σ d_γ B_γ,    d_γ = Σ_{β₁+…+β_D=γ} ∏ᵢ C(β₁)…C(β_D)/C(γ) det(… c_{βᵢ+eᵢ} − c_{βᵢ+e₀} …)
//! ```
//!
//! C the multinomial coefficients: a polynomial of degree D(k − 1). On a square or cube the
//! polynomials are products of those of a line, ∂y/∂ξᵢ ∝ Σ (c_{β+eᵢ} − c_β) B_β has the degree
//! k − 1 along ξᵢ and k along the others, and the determinant Dk − 1 along each. Restricted to
//! either half of the domain, the coefficients follow from de Casteljau's algorithm along lines of
//! them.

use carom_algebra::Vector;

use crate::shape::{Domain, Hull, Shape};

/// Exponents of a Bernstein polynomial of a simplex, one per corner; of a square or cube, indices
/// along its axes.
type Exponents = [usize; 4];

/// The tables of one shape with `D` reference coordinates and `N` nodes.
#[derive(Clone, Debug)]
pub(crate) struct Bernstein<const D: usize, const N: usize> {
    /// Weights of nodes in control points: a row per node.
    pub(crate) control: [[f64; N]; N],
    /// Start and end of the differences of control points per direction.
    pub(crate) differences: [Vec<(usize, usize)>; D],
    /// Products of differences in the coefficients of the determinant, ascending in these.
    pub(crate) terms: Vec<Term<D>>,
    /// Number of coefficients of the determinant.
    pub(crate) count: usize,
    /// Largest degree along a line of coefficients.
    pub(crate) degree: usize,
    pub(crate) corners: Vec<Corner<D>>,
    pub(crate) directions: Vec<Direction>,
}

/// A product of D derivatives in a coefficient of the determinant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Term<const D: usize> {
    pub(crate) coefficient: usize,
    pub(crate) weight: f64,
    pub(crate) factors: [usize; D],
}

/// A corner of the domain: its coefficient is the value there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner<const D: usize> {
    pub(crate) coefficient: usize,
    pub(crate) place: Vector<D>,
}

/// A direction in which the domain can be halved.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// Lines of coefficients from the start to the end.
    pub lines: Vec<Vec<usize>>,
    /// Corners at the start and at the end, joined by an edge.
    pub edges: Vec<(usize, usize)>,
}

impl<const D: usize, const N: usize> Bernstein<D, N> {
    /// The tables of shape `S`.
    pub(crate) fn of<S: Shape<D, N>>() -> Self {
        let hull = Hull::of::<D, N, S>();
        let control = std::array::from_fn(|a| std::array::from_fn(|c| hull.weights(c)[a]));
        let determinant = if S::Domain::TENSOR {
            Determinant::of_box(S::DEGREE)
        } else {
            Determinant::of_simplex(S::DEGREE, &S::NODES)
        };
        let Determinant { differences, terms, count, degree, corners, directions } = determinant;
        Self { control, differences, terms, count, degree, corners, directions }
    }
}

/// The part of the tables that does not depend on the number of nodes, compiled once for each
/// dimension.
struct Determinant<const D: usize> {
    differences: [Vec<(usize, usize)>; D],
    terms: Vec<Term<D>>,
    count: usize,
    degree: usize,
    corners: Vec<Corner<D>>,
    directions: Vec<Direction>,
}

impl<const D: usize> Determinant<D> {
    fn of_simplex(k: usize, nodes: &[Vector<D>]) -> Self {
        let degree = D * (k - 1);
        let points = exponents::<D>(k);
        let parts = exponents::<D>(k - 1);
        let whole = exponents::<D>(degree);
        let plus = |e: &Exponents, corner: usize| {
            let mut e = *e;
            e[corner] += 1;
            index(&points, &e)
        };
        let differences =
            std::array::from_fn(|i| parts.iter().map(|e| (plus(e, 0), plus(e, i + 1))).collect());
        let terms = products(&[parts.len(); D], &|factors: [usize; D]| {
            let sum = sum(factors.map(|f| parts[f]));
            let weight = factors.iter().map(|&f| multinomial(&parts[f])).product::<f64>() / multinomial(&sum);
            Term { coefficient: index(&whole, &sum), weight, factors }
        });
        let corner = |c: usize| {
            let mut e = [0; 4];
            e[c] = degree;
            Corner { coefficient: index(&whole, &e), place: nodes[c] }
        };
        Self {
            differences,
            terms,
            count: whole.len(),
            degree,
            corners: (0..=D).map(corner).collect(),
            directions: directions_of_simplex::<D>(degree),
        }
    }

    fn of_box(k: usize) -> Self {
        let degree = D * k - 1;
        let points = lattice::<D>(&[k; D]);
        let whole = lattice::<D>(&[degree; D]);
        let parts: [Vec<Exponents>; D] = std::array::from_fn(|i| {
            let mut degrees = [k; D];
            degrees[i] = k - 1;
            lattice(&degrees)
        });
        let differences = std::array::from_fn(|i| {
            let pair = |e: &Exponents| {
                let mut end = *e;
                end[i] += 1;
                (index(&points, e), index(&points, &end))
            };
            parts[i].iter().map(pair).collect()
        });
        let terms = products(&std::array::from_fn(|i| parts[i].len()), &|factors: [usize; D]| {
            let of = |i: usize| parts[i][factors[i]];
            let sum = sum(std::array::from_fn::<_, D, _>(of));
            let along = |axis: usize| {
                let ways = |i: usize| binomial(if i == axis { k - 1 } else { k }, of(i)[axis]);
                (0..D).map(ways).product::<f64>() / binomial(degree, sum[axis])
            };
            Term { coefficient: index(&whole, &sum), weight: (0..D).map(along).product(), factors }
        });
        let upper = |corner: usize, axis: usize| corner >> axis & 1 == 1;
        let corner = |c: usize| {
            let e = std::array::from_fn(|axis| if axis < D && upper(c, axis) { degree } else { 0 });
            let place = Vector(std::array::from_fn(|axis| if upper(c, axis) { 1.0 } else { -1.0 }));
            Corner { coefficient: index(&whole, &e), place }
        };
        Self {
            differences,
            terms,
            count: whole.len(),
            degree,
            corners: (0..1 << D).map(corner).collect(),
            directions: directions_of_box::<D>(degree),
        }
    }
}

/// The directions of a simplex, one along each edge, for polynomials of a degree.
pub(crate) fn directions_of_simplex<const D: usize>(degree: usize) -> Vec<Direction> {
    let whole = exponents::<D>(degree);
    let direction = |(start, end): (usize, usize)| {
        let lines = whole.iter().filter(|e| e[end] == 0).map(|first| {
            let along = |t: usize| {
                let mut e = *first;
                (e[start], e[end]) = (first[start] - t, t);
                index(&whole, &e)
            };
            (0..=first[start]).map(along).collect()
        });
        Direction { lines: lines.collect(), edges: vec![(start, end)] }
    };
    (0..=D).flat_map(|i| (0..i).map(move |j| (i, j))).map(direction).collect()
}

/// The directions of a square or cube, its axes.
pub(crate) fn directions_of_box<const D: usize>(degree: usize) -> Vec<Direction> {
    let whole = lattice::<D>(&[degree; D]);
    let direction = |axis: usize| {
        let lines = whole.iter().filter(|e| e[axis] == 0).map(|first| {
            let along = |t: usize| {
                let mut e = *first;
                e[axis] = t;
                index(&whole, &e)
            };
            (0..=degree).map(along).collect()
        });
        let starts = (0..1 << D).filter(|c| c >> axis & 1 == 0);
        Direction { lines: lines.collect(), edges: starts.map(|c| (c, c | 1 << axis)).collect() }
    };
    (0..D).map(direction).collect()
}

/// The halves of coefficients at the start and at the end of a direction.
pub(crate) fn halves(row: &[f64], direction: &Direction) -> [Vec<f64>; 2] {
    let mut halves = [row.to_vec(), row.to_vec()];
    let mut line = Vec::new();
    for places in &direction.lines {
        line.clear();
        line.extend(places.iter().map(|&place| row[place]));
        let count = line.len();
        for k in 0..count {
            halves[0][places[k]] = line[0];
            halves[1][places[count - 1 - k]] = line[count - 1 - k];
            for r in 0..count - 1 - k {
                line[r] = 0.5 * (line[r] + line[r + 1]);
            }
        }
    }
    halves
}

/// All products of one factor of each list of these lengths, ascending in their coefficients.
fn products<const D: usize>(lengths: &[usize; D], term: &dyn Fn([usize; D]) -> Term<D>) -> Vec<Term<D>> {
    let factor = |code: usize, i: usize| code / lengths[..i].iter().product::<usize>() % lengths[i];
    let codes = 0..lengths.iter().product();
    let mut terms: Vec<_> = codes.map(|code| term(std::array::from_fn(|i| factor(code, i)))).collect();
    terms.sort_by_key(|term| term.coefficient);
    terms
}

fn sum<const D: usize>(exponents: [Exponents; D]) -> Exponents {
    exponents.iter().fold([0; 4], |sum: Exponents, e| std::array::from_fn(|i| sum[i] + e[i]))
}

/// All exponents of a degree over D + 1 corners, in the order of [`Hull`].
fn exponents<const D: usize>(degree: usize) -> Vec<Exponents> {
    let corners = D + 1;
    let mut all = Vec::new();
    for code in 0..corners.pow(degree as u32) {
        let chosen: Vec<_> = (0..degree).map(|k| code / corners.pow(k as u32) % corners).collect();
        if chosen.is_sorted() {
            let mut e = [0; 4];
            chosen.iter().for_each(|&corner| e[corner] += 1);
            all.push(e);
        }
    }
    all
}

/// All indices up to these degrees along the axes, the first axis fastest, as in [`Hull`].
fn lattice<const D: usize>(degrees: &[usize; D]) -> Vec<Exponents> {
    let stride = |axis: usize| degrees[..axis].iter().map(|n| n + 1).product::<usize>();
    let at = |code: usize| {
        std::array::from_fn(|axis| if axis < D { code / stride(axis) % (degrees[axis] + 1) } else { 0 })
    };
    (0..stride(D)).map(at).collect()
}

/// The place of exponents in a list that contains them.
fn index(all: &[Exponents], exponents: &Exponents) -> usize {
    all.iter().position(|e| e == exponents).unwrap_or_default()
}

pub(crate) fn factorial(n: usize) -> f64 {
    (1..=n).map(|i| i as f64).product()
}

fn binomial(n: usize, k: usize) -> f64 {
    factorial(n) / (factorial(k) * factorial(n - k))
}

/// |e|!/∏ eᵢ!.
fn multinomial(exponents: &Exponents) -> f64 {
    factorial(exponents.iter().sum()) / exponents.iter().map(|&e| factorial(e)).product::<f64>()
}
