//! Certified validity of a cell: det(∂y/∂ξ) > 0 everywhere in it, at given positions or while its
//! nodes move on straight lines in 0 ≤ θ ≤ 1.
//!
//! The determinant is a polynomial in ξ, and of degree D in θ. Where all its Bernstein coefficients
//! (`bernstein.rs`) are positive, so is the determinant; otherwise the cell is divided (Johnen,
//! Remacle, Geuzaine, J. Comput. Phys. 233 (2013) 359–372). J = det(∂y/∂ξ)/det(∂X/∂ξ) has the sign
//! of the numerator, because the reference cell is valid.
//!
//! Round-off, with u = 2⁻⁵³, positions relative to the first node of magnitude ≤ m, weights of
//! control points Σ|w| ≤ Λ: a control point is wrong by (N + 2) u Λ m, a difference of size ≤ 2Λm
//! by twice that, a determinant by D! (2Λm)ᴰ (D (N + 3) + D) u, and the sum over its n terms adds
//! n. Every halving adds at most the degree.

use carom_algebra::{Mat, Real, Vector};

use crate::bernstein::{Bernstein, Direction, factorial, halves};
use crate::earliest::{Earliest, Piece};
use crate::shape::Shape;

/// Differences of control points: one list per direction.
type Differences<const D: usize, const N: usize> = [[Vector<D>; N]; D];

/// Pieces examined before a cell counts as not certified.
const BUDGET: usize = 2000;
/// Halvings of a piece before it counts as not certified.
const DEEPEST: u32 = 60;
/// Round-offs that a determinant is above zero if it may fall to a thousandth.
const FAR: f64 = 1e4;
/// Tolerance of θ of a loss.
const TOLERANCE: f64 = 1e-6;

/// The validity test of cells of one shape with `D` reference coordinates and `N` nodes.
#[derive(Clone, Debug)]
pub struct Validity<const D: usize, const N: usize> {
    tables: Bernstein<D, N>,
    /// Whether control points are the nodes, and the determinant is that of the edges from the
    /// first, for which there is a shorter formula.
    pub is_affine: bool,
    /// Λ.
    amplification: f64,
    /// Largest change of a difference if every node moves by at most 1.
    sensitivity: f64,
}

/// A place where the determinant is not certified positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loss<const D: usize> {
    /// Lower bound of the first θ, within 1e-6; 1 for given positions.
    pub theta: f64,
    /// Reference coordinates of the place.
    pub place: Vector<D>,
}

impl<const D: usize, const N: usize> Validity<D, N> {
    /// For cells of shape `S`.
    #[must_use]
    pub fn of<S: Shape<D, N>>() -> Self {
        let tables = Bernstein::of::<S>();
        let control = &tables.control;
        let sum = |of: &dyn Fn(usize) -> f64| (0..N).map(|a| of(a).abs()).sum::<f64>();
        let amplification = (0..N).map(|c| sum(&|a| control[a][c])).fold(0.0, f64::max);
        let change = |&(start, end): &(usize, usize)| sum(&|a| control[a][end] - control[a][start]);
        let sensitivity = tables.differences.iter().flatten().map(change).fold(0.0, f64::max);
        let is_node = |a: usize, c: usize| control[a][c] == f64::from(u8::from(a == c));
        let is_edge = |i: usize| tables.differences[i] == [(0, i + 1)];
        let is_affine = matches!(&tables.terms[..], [only] if only.weight == 1.0)
            && (0..N * N).all(|k| is_node(k / N, k % N))
            && (0..D).all(is_edge);
        Self { tables, is_affine, amplification, sensitivity }
    }

    /// Distance by which every component of every node's position may change, relative to a common
    /// translation, while the cell remains valid; 0 if the cell is only certified after division.
    ///
    /// If differences change by at most q per component, their determinant u × v in the plane
    /// changes by at most (|u|₁ + |v|₁) q + 2q², and in general by D! ((E + q)ᴰ − Eᴰ), E the
    /// largest component.
    ///
    /// # Errors
    /// A place where the determinant is not certified positive.
    #[inline(always)]
    pub fn margin(&self, nodes: &[Vector<D>; N]) -> Result<f64, Loss<D>> {
        if self.is_affine {
            let mut edges = Mat::ZERO;
            for i in 0..D {
                edges.0[i] = (nodes[i + 1] - nodes[0]).0;
            }
            if let Some(margin) = self.margin_of_edges(&edges) {
                return Ok(margin);
            }
        }
        let (differences, error) = self.differences_of(nodes, nodes);
        // A comparison with a NaN certifies nothing.
        let mut least = f64::INFINITY;
        let mut certified = true;
        let mut sum = 0.0;
        let mut current = 0;
        for term in &self.tables.terms {
            if term.coefficient != current {
                certified &= sum > error;
                least = least.min(sum);
                (sum, current) = (0.0, term.coefficient);
            }
            let columns = std::array::from_fn(|i| differences[i][term.factors[i]].0);
            sum += term.weight * Mat(columns).det();
        }
        certified &= sum > error;
        least = least.min(sum);
        if certified {
            let mut sums = [0.0_f64; D];
            for (i, sum) in sums.iter_mut().enumerate() {
                for d in &differences[i][..self.tables.differences[i].len()] {
                    *sum = sum.max(d.0.iter().map(|x| x.abs()).sum());
                }
            }
            return Ok(self.distance(least - error, sums));
        }
        match self.first_loss(vec![self.coefficients([&differences; 2], 0)], error) {
            None => Ok(0.0),
            Some(loss) => Err(Loss { theta: 1.0, ..loss }),
        }
    }

    /// [`Self::margin`] of simplices of degree 1 from their edges from the first node, the rows of
    /// E; `None` if one is not certified.
    ///
    /// If nodes move by at most m, E changes by dE with |dEᵢⱼ| ≤ 2m, and |E⁻¹dE| ≤ 2m r 1ᵀ with
    /// rᵢ = Σⱼ|E⁻¹ᵢⱼ|, which has the spectral radius 2m Σ|E⁻¹ᵢⱼ|. Where that is at most 0.9,
    /// det(E + dE) ≥ 0.1ᴰ det E: certified, if det E is far above its round-off, which grows by
    /// less than 2ᴰ, because m ≤ 0.45 max|Eᵢⱼ|.
    #[inline(always)]
    pub(crate) fn margin_of_edges<T: Real>(&self, edges: &Mat<D, T>) -> Option<T> {
        let mut largest = T::ZERO;
        let mut sum = T::ZERO;
        let cofactors = edges.cofactor();
        for i in 0..D {
            for j in 0..D {
                largest = largest.max(edges.0[i][j].map(f64::abs));
                sum = sum + cofactors.0[i][j].map(f64::abs);
            }
        }
        let det = edges.det();
        let error = self.round_off(largest);
        let is_lost = (det - error).find(|free| free <= 0.0 || free.is_nan()).is_some();
        let free = (det - T::of(FAR) * error).max(T::ZERO);
        (self.is_affine && !is_lost).then(|| T::of(0.449) * free / sum)
    }

    /// Distance by which positions may change until a determinant falls by `free`, for differences
    /// whose components have these largest sums.
    fn distance(&self, free: f64, sums: [f64; D]) -> f64 {
        let sum: f64 = sums.iter().sum();
        let change = match D {
            1 => free,
            2 => 2.0 * free / (sum + (sum * sum + 8.0 * free).sqrt()),
            _ => {
                // With x = free/(D! Eᴰ), less than the exact (1 + x)^(1/D) − 1.
                let ratio = free / (factorial(D) * power::<D, f64>(sum));
                sum * ratio / (D as f64 * (1.0 + ratio))
            }
        };
        0.999 * change / self.sensitivity
    }

    /// Bound of the round-off of a determinant's coefficient for positions of magnitude `largest`
    /// relative to the first node.
    #[inline(always)]
    fn round_off<T: Real>(&self, largest: T) -> T {
        let unit = power::<D, T>(T::of(2.0 * self.amplification) * largest);
        let factor = 0.5 * f64::EPSILON * factorial(D) * (D * (N + 4) + self.tables.terms.len()) as f64;
        T::of(factor) * unit + T::of(f64::MIN_POSITIVE)
    }

    /// The first loss of validity while the nodes move on straight lines; `None` certifies that
    /// there is none.
    #[must_use]
    pub fn lost_between(&self, before: &[Vector<D>; N], now: &[Vector<D>; N]) -> Option<Loss<D>> {
        let (start, error) = self.differences_of(before, now);
        let (end, other) = self.differences_of(now, before);
        let rows = (0..=D).map(|t| self.coefficients([&start, &end], t)).collect();
        self.first_loss(rows, error.max(other))
    }

    /// Differences of control points, and the bound of the round-off of a determinant's
    /// coefficient, also of those of `other` positions.
    #[inline(always)]
    fn differences_of(&self, nodes: &[Vector<D>; N], other: &[Vector<D>; N]) -> (Differences<D, N>, f64) {
        let mut local = [Vector::ZERO; N];
        let mut largest = 0.0_f64;
        for a in 0..N {
            local[a] = nodes[a] - nodes[0];
            let there = other[a] - other[0];
            for i in 0..D {
                largest = largest.max(local[a][i].abs()).max(there[i].abs());
            }
        }
        let mut control = [[0.0; N]; D];
        for i in 0..D {
            for a in 0..N {
                for c in 0..N {
                    control[i][c] += local[a][i] * self.tables.control[a][c];
                }
            }
        }
        let mut differences = [[Vector::ZERO; N]; D];
        for i in 0..D {
            for (b, &(start, end)) in self.tables.differences[i].iter().enumerate() {
                for j in 0..D {
                    differences[i][b][j] = control[j][end] - control[j][start];
                }
            }
        }
        (differences, self.round_off(largest))
    }

    /// Bernstein coefficients in ξ of the coefficient `t` in θ: a mean over the choices of `t`
    /// factors at the end and the others at the start.
    fn coefficients(&self, ends: [&Differences<D, N>; 2], t: usize) -> Vec<f64> {
        let choices: Vec<usize> =
            (0..1_usize << D).filter(|choice| choice.count_ones() as usize == t).collect();
        let mut out = vec![0.0; self.tables.count];
        for term in &self.tables.terms {
            for choice in &choices {
                let columns = std::array::from_fn(|i| ends[choice >> i & 1][i][term.factors[i]].0);
                out[term.coefficient] += term.weight * Mat(columns).det() / choices.len() as f64;
            }
        }
        out
    }

    /// The earliest place that division does not certify, of coefficients in ξ per coefficient in
    /// θ.
    fn first_loss(&self, rows: Vec<Vec<f64>>, error: f64) -> Option<Loss<D>> {
        let corners = self.tables.corners.iter().map(|corner| corner.place).collect();
        let whole = Subdomain { rows, corners, theta: [0.0, 1.0], level: 0, error };
        if whole.is_clear() {
            return None;
        }
        let domain = Earliest::new(BUDGET).first(whole, |_| false, |domain| self.halves(domain))?;
        let value = |&corner: &usize| domain.rows[0][self.tables.corners[corner].coefficient];
        let worst = (0..domain.corners.len()).min_by(|i, j| value(i).total_cmp(&value(j)));
        Some(Loss { theta: domain.theta[0], place: domain.corners[worst.unwrap_or(0)] })
    }

    /// Halves in θ or in the direction with the larger changes; `None` where the loss is located.
    fn halves(&self, domain: &Subdomain<D>) -> Option<[Subdomain<D>; 2]> {
        let first = &domain.rows[0];
        let last = &domain.rows[domain.rows.len() - 1];
        // A NaN is a loss.
        let positive = |row: &[f64]| self.tables.corners.iter().all(|c| row[c.coefficient] > domain.error);
        let lost = |row: &[f64]| !positive(row);
        if lost(first) || domain.level >= DEEPEST {
            return None;
        }
        let in_time = domain
            .rows
            .windows(2)
            .map(|rows| rows[0].iter().zip(&rows[1]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max));
        let in_time = in_time.fold(0.0, f64::max);
        let mut largest = (-1.0, 0);
        for (i, direction) in self.tables.directions.iter().enumerate() {
            let size = domain.rows.iter().map(|row| change(row, direction)).fold(0.0, f64::max);
            largest = if size > largest.0 { (size, i) } else { largest };
        }
        let wide = domain.theta[1] - domain.theta[0] > TOLERANCE;
        if wide && (in_time >= largest.0 || lost(last)) {
            return Some(domain.halves_in_time());
        }
        if lost(last) {
            return None;
        }
        let direction = &self.tables.directions[largest.1];
        let mut children =
            [(); 2].map(|()| Subdomain { rows: Vec::new(), level: domain.level + 1, ..domain.clone() });
        for row in &domain.rows {
            let [near, far] = halves(row, direction);
            children[0].rows.push(near);
            children[1].rows.push(far);
        }
        for &(start, end) in &direction.edges {
            let middle = (domain.corners[start] + domain.corners[end]) * 0.5;
            (children[0].corners[end], children[1].corners[start]) = (middle, middle);
        }
        let added = domain.error * self.tables.degree as f64 / 100.0;
        children.iter_mut().for_each(|half| half.error += added);
        Some(children)
    }
}

/// Largest difference of neighbouring coefficients in a direction.
fn change(row: &[f64], direction: &Direction) -> f64 {
    let steps = direction.lines.iter().flat_map(|line| line.windows(2));
    steps.map(|step| (row[step[0]] - row[step[1]]).abs()).fold(0.0, f64::max)
}

/// xᴰ.
#[inline(always)]
fn power<const D: usize, T: Real>(x: T) -> T {
    let mut power = x;
    for _ in 1..D {
        power = power * x;
    }
    power
}

/// The determinant over a part of the cell and an interval of θ.
#[derive(Clone, Debug)]
struct Subdomain<const D: usize> {
    /// Coefficients in ξ per coefficient in θ; one row without motion.
    rows: Vec<Vec<f64>>,
    /// Reference coordinates of the corners.
    corners: Vec<Vector<D>>,
    theta: [f64; 2],
    level: u32,
    error: f64,
}

impl<const D: usize> Subdomain<D> {
    fn halves_in_time(&self) -> [Self; 2] {
        let mut children = [self.clone(), self.clone()];
        let count = self.rows.len();
        for c in 0..self.rows[0].len() {
            let mut column: Vec<f64> = self.rows.iter().map(|row| row[c]).collect();
            for k in 0..count {
                children[0].rows[k][c] = column[0];
                children[1].rows[count - 1 - k][c] = column[count - 1 - k];
                for r in 0..count - 1 - k {
                    column[r] = 0.5 * (column[r] + column[r + 1]);
                }
            }
        }
        let middle = 0.5 * (self.theta[0] + self.theta[1]);
        (children[0].theta[1], children[1].theta[0]) = (middle, middle);
        let added = self.error * count as f64 / 100.0;
        for domain in &mut children {
            domain.level += 1;
            domain.error += added;
        }
        children
    }
}

impl<const D: usize> Piece for Subdomain<D> {
    fn theta(&self) -> f64 {
        self.theta[0]
    }

    fn level(&self) -> u32 {
        self.level
    }

    fn place(&self) -> f64 {
        let weight = |i: usize| 3.0_f64.powi(i as i32);
        self.corners.iter().map(|c| (0..D).map(|i| weight(i) * c[i]).sum::<f64>()).sum()
    }

    fn is_clear(&self) -> bool {
        self.rows.iter().flatten().all(|&c| c > self.error)
    }
}
