//! Certified validity of a cell: det(∂y/∂ξ) > 0 everywhere in it, at given positions or while its
//! nodes move on straight lines in 0 ≤ θ ≤ 1.
//!
//! With control points c of degree k (`shape/hull.rs`) and corners e₀ … e_D,
//!
//! ```text
//! ∂y/∂ξᵢ ∝ Σ (c_{β+eᵢ} − c_{β+e₀}) B_β,    |β| = k − 1
//! det(∂y/∂ξ) ∝ Σ d_γ B_γ,    d_γ = Σ_{β₁+…+β_D=γ} ∏ᵢ C(β₁)…C(β_D)/C(γ) det(… c_{βᵢ+eᵢ} − c_{βᵢ+e₀} …)
//! ```
//!
//! C the multinomial coefficients: a polynomial of degree D(k − 1) in ξ, and D in θ. Where all its
//! Bernstein coefficients are positive, so is the determinant; otherwise the cell is divided
//! (Johnen, Remacle, Geuzaine, J. Comput. Phys. 233 (2013) 359–372). J = det(∂y/∂ξ)/det(∂X/∂ξ) has
//! the sign of the numerator, because the reference cell is valid.
//!
//! Round-off, with u = 2⁻⁵³, positions relative to the first node of magnitude ≤ m, weights of
//! control points Σ|w| ≤ Λ: a control point is wrong by (N + 2) u Λ m, a difference of size ≤ 2Λm by
//! twice that, a determinant by D! (2Λm)ᴰ (D (N + 3) + D) u, and the sum over its n terms adds n.
//! Every halving adds at most the degree.

use carom_algebra::{Mat, Vector};

use crate::earliest::{Earliest, Piece};
use crate::shape::{Hull, Shape};

/// Exponents of a Bernstein polynomial, one per corner.
type Exponents = [usize; 4];
/// Differences of control points: one list over β per direction.
type Differences<const D: usize, const N: usize> = [[Vector<D>; N]; D];

/// Pieces examined before a cell counts as not certified.
const BUDGET: usize = 2000;
/// Halvings of a piece before it counts as not certified.
const DEEPEST: u32 = 60;
/// Tolerance of θ of a loss.
const TOLERANCE: f64 = 1e-6;

/// The validity test of cells of one shape with `D` reference coordinates and `N` nodes.
#[derive(Clone, Debug)]
pub struct Validity<const D: usize, const N: usize> {
    degree: usize,
    /// Weights of nodes in control points: a row per node.
    control: [[f64; N]; N],
    /// Λ.
    amplification: f64,
    /// Largest change of a difference if every node moves by at most 1.
    sensitivity: f64,
    /// Control points β + e₀ and β + eᵢ of every β.
    differences: Vec<(usize, [usize; D])>,
    /// Ascending in γ.
    terms: Vec<Term<D>>,
    /// Exponents of every degree up to that of the determinant.
    exponents: Vec<Vec<Exponents>>,
}

/// A product of D derivatives in a coefficient of the determinant.
#[derive(Clone, Copy, Debug)]
struct Term<const D: usize> {
    coefficient: usize,
    weight: f64,
    factors: [usize; D],
}

/// A place where the determinant is not certified positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loss {
    /// Lower bound of the first θ, within 1e-6; 1 for given positions.
    pub theta: f64,
    /// Barycentric coordinates of the place; the last ones are zero.
    pub place: [f64; 4],
}

impl<const D: usize, const N: usize> Validity<D, N> {
    /// For cells of shape `S`.
    #[must_use]
    pub fn of<S: Shape<D, N>>() -> Self {
        let k = S::DEGREE;
        let exponents: Vec<_> = (0..=(D * (k - 1)).max(k)).map(exponents::<D>).collect();
        let control: [[f64; N]; N] = {
            let hull = Hull::of::<D, N, S>();
            std::array::from_fn(|a| std::array::from_fn(|c| hull.weights(c)[a]))
        };
        let sum = |of: &dyn Fn(usize) -> f64| (0..N).map(|a| of(a).abs()).sum::<f64>();
        let amplification = (0..N).map(|c| sum(&|a| control[a][c])).fold(0.0, f64::max);
        let place = |e: &Exponents, corner: usize| {
            let mut e = *e;
            e[corner] += 1;
            index(&exponents[k], &e)
        };
        let differences: Vec<(usize, [usize; D])> = exponents[k - 1]
            .iter()
            .map(|e| (place(e, 0), std::array::from_fn(|i| place(e, i + 1))))
            .collect();
        let changes = |(base, ends): &(usize, [usize; D])| {
            ends.map(|end| sum(&|a| control[a][end] - control[a][*base])).into_iter().fold(0.0, f64::max)
        };
        let sensitivity = differences.iter().map(changes).fold(0.0, f64::max);
        let (parts, whole) = (&exponents[k - 1], &exponents[D * (k - 1)]);
        let mut terms = Vec::new();
        for code in 0..parts.len().pow(D as u32) {
            let factors: [usize; D] = std::array::from_fn(|i| code / parts.len().pow(i as u32) % parts.len());
            let sum = factors.iter().fold([0; 4], |sum: Exponents, &f| {
                std::array::from_fn(|corner| sum[corner] + parts[f][corner])
            });
            let weight = factors.iter().map(|&f| multinomial(&parts[f])).product::<f64>() / multinomial(&sum);
            terms.push(Term { coefficient: index(whole, &sum), weight, factors });
        }
        terms.sort_by_key(|term| term.coefficient);
        Self { degree: D * (k - 1), control, amplification, sensitivity, differences, terms, exponents }
    }

    /// Distance by which every component of every node's position may change, relative to a common
    /// translation, while the cell remains valid; 0 if the cell is only certified after division.
    ///
    /// If differences change by at most q per component, their determinant u × v in the plane changes
    /// by at most (|u|₁ + |v|₁) q + 2q², and in general by D! ((E + q)ᴰ − Eᴰ), E the largest
    /// component.
    ///
    /// # Errors
    /// A place where the determinant is not certified positive.
    #[inline(always)]
    pub fn margin(&self, nodes: &[Vector<D>; N]) -> Result<f64, Loss> {
        let (differences, error) = self.differences_of(nodes, nodes);
        // A comparison with a NaN certifies nothing.
        let (mut least, mut certified) = (f64::INFINITY, true);
        let (mut sum, mut current) = (0.0, 0);
        for term in &self.terms {
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
            for (sum, list) in sums.iter_mut().zip(&differences) {
                for d in &list[..self.differences.len()] {
                    *sum = sum.max(d.0.iter().map(|x| x.abs()).sum());
                }
            }
            let (free, sum) = (least - error, sums.iter().sum::<f64>());
            let change = match D {
                1 => free,
                2 => 2.0 * free / (sum + (sum * sum + 8.0 * free).sqrt()),
                _ => {
                    // With x = free/(D! Eᴰ), less than the exact (1 + x)^(1/D) − 1.
                    let ratio = free / (factorial(D) * sum.powi(D as i32));
                    sum * ratio / (D as f64 * (1.0 + ratio))
                }
            };
            return Ok(0.999 * change / self.sensitivity);
        }
        match self.first_loss(vec![self.coefficients([&differences; 2], 0)], error) {
            None => Ok(0.0),
            Some(loss) => Err(Loss { theta: 1.0, ..loss }),
        }
    }

    /// The first loss of validity while the nodes move on straight lines; `None` certifies that
    /// there is none.
    #[must_use]
    pub fn lost_between(&self, before: &[Vector<D>; N], now: &[Vector<D>; N]) -> Option<Loss> {
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
                    control[i][c] += local[a][i] * self.control[a][c];
                }
            }
        }
        let mut differences = [[Vector::ZERO; N]; D];
        for (b, (base, ends)) in self.differences.iter().enumerate() {
            for i in 0..D {
                for j in 0..D {
                    differences[i][b][j] = control[j][ends[i]] - control[j][*base];
                }
            }
        }
        let unit = 0.5 * f64::EPSILON * factorial(D) * (2.0 * self.amplification * largest).powi(D as i32);
        (differences, unit * (D * (N + 4) + self.terms.len()) as f64 + f64::MIN_POSITIVE)
    }

    /// Bernstein coefficients in ξ of the coefficient `t` in θ: a mean over the choices of `t`
    /// factors at the end and the others at the start.
    fn coefficients(&self, ends: [&Differences<D, N>; 2], t: usize) -> Vec<f64> {
        let choices: Vec<usize> =
            (0..1_usize << D).filter(|choice| choice.count_ones() as usize == t).collect();
        let mut out = vec![0.0; self.exponents[self.degree].len()];
        for term in &self.terms {
            for choice in &choices {
                let columns = std::array::from_fn(|i| ends[choice >> i & 1][i][term.factors[i]].0);
                out[term.coefficient] += term.weight * Mat(columns).det() / choices.len() as f64;
            }
        }
        out
    }

    /// The earliest place that division does not certify, of coefficients in ξ per coefficient in θ.
    fn first_loss(&self, rows: Vec<Vec<f64>>, error: f64) -> Option<Loss> {
        let mut corners = [[0.0; 4]; 4];
        (0..=D).for_each(|i| corners[i][i] = 1.0);
        let whole = Part { rows, corners, theta: [0.0, 1.0], level: 0, error };
        if whole.is_clear() {
            return None;
        }
        let part = Earliest::new(BUDGET).first(whole, |_| false, |part| self.halves(part))?;
        let worst = (0..=D)
            .min_by(|&i, &j| self.at_corner(&part.rows[0], i).total_cmp(&self.at_corner(&part.rows[0], j)));
        Some(Loss { theta: part.theta[0], place: part.corners[worst.unwrap_or(0)] })
    }

    /// The value at a corner.
    fn at_corner(&self, row: &[f64], corner: usize) -> f64 {
        let mut exponents = [0; 4];
        exponents[corner] = self.degree;
        row[index(&self.exponents[self.degree], &exponents)]
    }

    /// Halves in θ or along the edge with the larger changes; `None` where the loss is located.
    fn halves(&self, part: &Part) -> Option<[Part; 2]> {
        let (first, last) = (&part.rows[0], &part.rows[part.rows.len() - 1]);
        // A NaN is a loss.
        let lost = |row: &[f64]| !(0..=D).all(|i| self.at_corner(row, i) > part.error);
        if lost(first) || part.level >= DEEPEST {
            return None;
        }
        let in_time = part
            .rows
            .windows(2)
            .map(|rows| rows[0].iter().zip(&rows[1]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max));
        let in_time = in_time.fold(0.0, f64::max);
        let mut longest = (-1.0, 0, 1);
        for i in 0..=D {
            for j in 0..i {
                let size = part.rows.iter().map(|row| self.change(row, i, j)).fold(0.0, f64::max);
                longest = if size > longest.0 { (size, i, j) } else { longest };
            }
        }
        let wide = part.theta[1] - part.theta[0] > TOLERANCE;
        if wide && (in_time >= longest.0 || lost(last)) {
            return Some(part.halves_in_time());
        }
        if lost(last) {
            return None;
        }
        let (_, i, j) = longest;
        let mut parts = [(); 2].map(|()| Part { rows: Vec::new(), level: part.level + 1, ..part.clone() });
        for row in &part.rows {
            let [near, far] = self.halves_of(row, i, j);
            parts[0].rows.push(near);
            parts[1].rows.push(far);
        }
        let middle = std::array::from_fn(|c| 0.5 * (part.corners[i][c] + part.corners[j][c]));
        (parts[0].corners[j], parts[1].corners[i]) = (middle, middle);
        let added = part.error * self.degree as f64 / 100.0;
        parts.iter_mut().for_each(|half| half.error += added);
        Some(parts)
    }

    /// Largest difference of coefficients along an edge.
    fn change(&self, row: &[f64], i: usize, j: usize) -> f64 {
        if self.degree == 0 {
            return 0.0;
        }
        let of = |e: &Exponents, corner: usize| {
            let mut e = *e;
            e[corner] += 1;
            row[index(&self.exponents[self.degree], &e)]
        };
        let edges = self.exponents[self.degree - 1].iter();
        edges.map(|e| (of(e, i) - of(e, j)).abs()).fold(0.0, f64::max)
    }

    /// De Casteljau's algorithm at the middle of an edge: the half with corner i, then that with j.
    fn halves_of(&self, row: &[f64], i: usize, j: usize) -> [Vec<f64>; 2] {
        let mut levels = vec![row.to_vec()];
        for n in (0..self.degree).rev() {
            let finer = &levels[levels.len() - 1];
            let of = |e: &Exponents, corner: usize| {
                let mut e = *e;
                e[corner] += 1;
                finer[index(&self.exponents[n + 1], &e)]
            };
            levels.push(self.exponents[n].iter().map(|e| 0.5 * (of(e, i) + of(e, j))).collect());
        }
        [j, i].map(|gone| {
            let of = |e: &Exponents| {
                let (mut rest, times) = (*e, e[gone]);
                rest[gone] = 0;
                levels[times][index(&self.exponents[self.degree - times], &rest)]
            };
            self.exponents[self.degree].iter().map(of).collect()
        })
    }
}

/// The determinant over a simplex in ξ and an interval of θ.
#[derive(Clone, Debug)]
struct Part {
    /// Coefficients in ξ per coefficient in θ; one row without motion.
    rows: Vec<Vec<f64>>,
    /// Barycentric coordinates of the corners.
    corners: [[f64; 4]; 4],
    theta: [f64; 2],
    level: u32,
    error: f64,
}

impl Part {
    fn halves_in_time(&self) -> [Self; 2] {
        let mut parts = [self.clone(), self.clone()];
        let count = self.rows.len();
        for c in 0..self.rows[0].len() {
            let mut column: Vec<f64> = self.rows.iter().map(|row| row[c]).collect();
            for k in 0..count {
                parts[0].rows[k][c] = column[0];
                parts[1].rows[count - 1 - k][c] = column[count - 1 - k];
                for r in 0..count - 1 - k {
                    column[r] = 0.5 * (column[r] + column[r + 1]);
                }
            }
        }
        let middle = 0.5 * (self.theta[0] + self.theta[1]);
        (parts[0].theta[1], parts[1].theta[0]) = (middle, middle);
        let added = self.error * count as f64 / 100.0;
        for part in &mut parts {
            part.level += 1;
            part.error += added;
        }
        parts
    }
}

impl Piece for Part {
    fn theta(&self) -> f64 {
        self.theta[0]
    }

    fn level(&self) -> u32 {
        self.level
    }

    fn place(&self) -> f64 {
        self.corners.iter().enumerate().map(|(i, c)| c[1] + 3.0 * c[2] + i as f64 * c[3]).sum()
    }

    fn is_clear(&self) -> bool {
        self.rows.iter().flatten().all(|&c| c > self.error)
    }
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

/// The place of exponents in a list that contains them.
fn index(all: &[Exponents], exponents: &Exponents) -> usize {
    all.iter().position(|e| e == exponents).unwrap_or_default()
}

fn factorial(n: usize) -> f64 {
    (1..=n).map(|i| i as f64).product()
}

/// |e|!/∏ eᵢ!.
fn multinomial(exponents: &Exponents) -> f64 {
    factorial(exponents.iter().sum()) / exponents.iter().map(|&e| factorial(e)).product::<f64>()
}

#[cfg(test)]
mod tests;
