//! A small dense saddle point by two Cholesky factors,
//!
//! ```text
//! [ S  Gᵀ ] [x]   [b]      S = L Lᵀ,  T = L⁻¹Gᵀ,  z = L⁻¹b,  TᵀT λ = Tᵀz − c,  x = L⁻ᵀ(z − Tλ).
//! [ G  0  ] [λ] = [c]
//! ```
//!
//! Where forces act along other directions F than G (friction), U = L⁻¹Fᵀ replaces the second T of
//! each product, and TᵀU is factored by LU with partial pivoting. Seen relative to the matrix
//! without friction, TᵀT = K Kᵀ, it is R = K⁻¹TᵀU K⁻ᵀ, the identity for F = G. A row that yields, g
//! x − C λ = c with C ≥ 0, adds C to the diagonals of both; it and its multiplier are scaled by σ =
//! (1 + C/TᵀT)^−½.
//!
//! Both factors exist if S is positive definite and G has full rank; the matrix then has one
//! negative eigenvalue per row of G (Benzi, Golub, Liesen, Acta Numerica 14 (2005), §3.4). The
//! pivot of a row in TᵀT, over its diagonal, is the square of the sine of its angle to the earlier
//! rows in the metric of S⁻¹. If it is round-off, the earlier rows say what that row says, and
//! nothing determines its multiplier: it is left out, with the multiplier zero. If S is positive
//! definite only on the kernel of G, S + Σ κ gᵀg with b + Σ κ c g has the same solution and is
//! positive definite everywhere (ibid., §3.5: the augmented Lagrangian). Otherwise (a buckling
//! structure) the whole matrix is factored with pivoting (Bunch, Kaufman).

use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::solvers::{Lblt, PartialPivLu, Solve};
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::prelude::{Reborrow, ReborrowMut};
use faer::{Accum, Mat, MatMut, MatRef, Par, Side};

use crate::pivots::{Room, diagonal_size};

/// Pivot over the diagonal below which it is round-off: about 50 times that of a product.
const DEPENDENT: f64 = 1e-14;
/// Number of inverse iterations for the smallest singular value.
const INVERSE_ITERATIONS: usize = 8;

/// The factor of a square matrix that need not be positive definite.
enum Whole {
    Symmetric(Lblt<f64>),
    General(PartialPivLu<f64>),
}

impl Whole {
    fn solve(&self, x: &mut [f64]) {
        let size = x.len();
        let x = MatMut::from_column_major_slice_mut(x, size, 1);
        match self {
            Self::Symmetric(factor) => factor.solve_in_place(x),
            Self::General(factor) => factor.solve_in_place(x),
        }
    }
}

/// A small dense saddle point: its matrices, buffers and factors.
#[derive(Default)]
pub struct Saddle {
    size: usize,
    count: usize,
    /// Matrix S, then its factor L; column-major.
    stiffness: Vec<f64>,
    /// S, in case it has no factor.
    before: Vec<f64>,
    /// Transposed rows Gᵀ, then T = L⁻¹Gᵀ; a column per row of G.
    rows: Vec<f64>,
    /// Transposed directions Fᵀ, then U = L⁻¹Fᵀ; empty where F = G.
    directions: Vec<f64>,
    /// Lower triangle of TᵀT, then its Cholesky factor.
    small: Vec<f64>,
    /// LU factor of the product TᵀU.
    skew: Option<PartialPivLu<f64>>,
    /// Penalty κ of each row of G.
    penalties: Vec<f64>,
    /// Compliance C of each row of G.
    yields: Vec<f64>,
    /// Scale σ of each row of G.
    scales: Vec<f64>,
    /// Rows of G that depend linearly on earlier ones.
    dependent: Vec<usize>,
    nonzeros: Vec<usize>,
    /// Absolute values on the diagonal of S before rows add to it.
    diagonal: Vec<f64>,
    room: Room,
    /// Factor of the whole saddle-point matrix if S is not positive definite.
    indefinite: Option<Whole>,
}

impl Saddle {
    /// Starts a saddle point with the matrix S (column-major, its lower triangle) and `count` empty
    /// rows of G.
    pub fn begin(&mut self, stiffness: &[f64], size: usize, count: usize) {
        self.size = size;
        self.count = count;
        self.stiffness.resize(size * size, 0.0);
        copy_lower(stiffness, size, &mut self.stiffness);
        self.rows.clear();
        self.rows.resize(size * count, 0.0);
        self.directions.clear();
        for list in [&mut self.penalties, &mut self.yields] {
            list.clear();
            list.resize(count, 0.0);
        }
        self.scales.clear();
        self.scales.resize(count, 1.0);
    }

    /// Sets the compliance C of a row of G, which then needs a direction of its own
    /// ([`direct`](Self::direct)).
    pub fn yields(&mut self, row: usize, compliance: f64) {
        self.yields[row] = compliance;
    }

    /// Adds κ gᵀg to S for every row g of G, where κ is `share` times the stiffness of S along g,
    /// and subtracts κ C g from its direction. The solution does not change; an S that is positive
    /// definite only where G x = 0 becomes so everywhere. Rows that share entries of x do not add
    /// to each other's κ, which would grow from row to row.
    pub fn augment(&mut self, share: f64) {
        let n = self.size.max(1);
        self.diagonal.clear();
        self.diagonal.extend(self.stiffness.iter().step_by(n + 1).map(|stiffness| stiffness.abs()));
        for (r, (row, penalty)) in self.rows.chunks_exact(n).zip(&mut self.penalties).enumerate() {
            self.nonzeros.clear();
            self.nonzeros.extend((0..n).filter(|&j| row[j] != 0.0));
            let square: f64 = self.nonzeros.iter().map(|&j| row[j] * row[j]).sum();
            let along: f64 = self.nonzeros.iter().map(|&j| row[j] * row[j] * self.diagonal[j]).sum();
            if square == 0.0 {
                continue;
            }
            *penalty = share * along / (square * square);
            // A row that yields has at most the stiffness 1/C.
            *penalty /= 1.0 + *penalty * self.yields[r];
            for (k, &j) in self.nonzeros.iter().enumerate() {
                for &i in &self.nonzeros[k..] {
                    self.stiffness[j * n + i] += *penalty * row[i] * row[j];
                }
                if self.yields[r] != 0.0 {
                    self.directions[r * n + j] -= *penalty * self.yields[r] * row[j];
                }
            }
        }
    }

    /// Adds a value to the entry S(i, j); only the lower triangle i ≥ j is used.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        self.stiffness[j * self.size + i] += value;
    }

    /// Adds a value to the entry G(row, j).
    pub fn add_row(&mut self, row: usize, j: usize, value: f64) {
        self.rows[row * self.size + j] += value;
    }

    /// Gives forces directions F of their own, which are zero at first.
    pub fn direct(&mut self) {
        self.directions.resize(self.rows.len(), 0.0);
    }

    /// Adds a value to the entry F(row, j), after [`direct`](Self::direct).
    pub fn add_direction(&mut self, row: usize, j: usize, value: f64) {
        self.directions[row * self.size + j] += value;
    }

    /// Factors the saddle point and returns whether S is positive definite. Then rows that depend
    /// linearly on earlier ones are left out.
    pub fn factor(&mut self) -> bool {
        let n = self.size;
        let m = self.count;
        self.before.resize(n * n, 0.0);
        copy_lower(&self.stiffness, n, &mut self.before);
        self.indefinite = None;
        self.skew = None;
        self.dependent.clear();
        let size = diagonal_size(self.stiffness.iter().step_by(n + 1).copied());
        if self.room.cholesky(MatMut::from_column_major_slice_mut(&mut self.stiffness, n, n), size).is_err() {
            std::mem::swap(&mut self.stiffness, &mut self.before);
            self.indefinite = Some(self.whole());
            return false;
        }
        self.substitute_rows();
        let lower = MatRef::from_column_major_slice(&self.stiffness, n, n);
        let t = MatRef::from_column_major_slice(&self.rows, n, m);
        self.small.clear();
        self.small.resize(m * m, 0.0);
        let product = MatMut::from_column_major_slice_mut(&mut self.small, m, m);
        let half = BlockStructure::TriangularLower;
        let whole = BlockStructure::Rectangular;
        triangular::matmul(product, half, Accum::Replace, t.transpose(), whole, t, whole, 1.0, Par::Seq);
        if !self.directions.is_empty() {
            let mut u = MatMut::from_column_major_slice_mut(&mut self.directions, n, m);
            solve_lower_triangular_in_place(lower, u.rb_mut(), Par::Seq);
        }
        (0..m).for_each(|i| self.small[i * m + i] += self.yields[i]);
        self.factor_independent();
        if !self.directions.is_empty() {
            let t = MatRef::from_column_major_slice(&self.rows, n, m);
            let u = MatRef::from_column_major_slice(&self.directions, n, m);
            let mut product = Mat::zeros(m, m);
            matmul(product.as_mut(), Accum::Replace, t.transpose(), u, 1.0, Par::Seq);
            (0..m).for_each(|i| product[(i, i)] += self.yields[i]);
            self.dependent.iter().for_each(|&i| product[(i, i)] = 1.0);
            self.skew = Some(product.partial_piv_lu());
        }
        true
    }

    /// Whether S, with what rows add to it, was positive definite when it was factored.
    pub fn is_positive(&self) -> bool {
        self.indefinite.is_none()
    }

    /// Factors TᵀT without the rows that depend linearly on earlier ones: theirs become those of
    /// the identity.
    fn factor_independent(&mut self) {
        let n = self.size;
        let m = self.count;
        let mut product = self.small.clone();
        let diagonal: Vec<f64> = (0..m).map(|i| product[i * m + i]).collect();
        loop {
            let factored =
                self.room.cholesky(MatMut::from_column_major_slice_mut(&mut self.small, m, m), 0.0);
            let repeats = |&i: &usize| self.small[i * m + i].powi(2) <= DEPENDENT * diagonal[i];
            let last = factored.err();
            let known = (0..last.unwrap_or(m)).filter(|i| !self.dependent.contains(i));
            let Some(row) = known.into_iter().find(repeats).or(last) else { return };
            self.dependent.push(row);
            (0..m).for_each(|j| product[row.min(j) * m + row.max(j)] = 0.0);
            product[row * m + row] = 1.0;
            self.rows[row * n..(row + 1) * n].fill(0.0);
            self.directions.iter_mut().skip(row * n).take(n).for_each(|slope| *slope = 0.0);
            self.yields[row] = 0.0;
            self.small.copy_from_slice(&product);
        }
    }

    /// Factors the whole saddle-point matrix with pivoting.
    fn whole(&self) -> Whole {
        let n = self.size;
        let m = self.count;
        let is_skew = !self.directions.is_empty();
        let entry = |i: usize, j: usize| match (i < n, j < n) {
            (true, true) => self.stiffness[i.min(j) * n + i.max(j)],
            (false, true) => self.rows[(i - n) * n + j],
            (true, false) if is_skew => self.directions[(j - n) * n + i],
            (false, false) if i == j => -self.yields[i - n],
            _ => 0.0,
        };
        let whole = Mat::from_fn(n + m, n + m, entry);
        if is_skew {
            Whole::General(whole.partial_piv_lu())
        } else {
            Whole::Symmetric(whole.lblt(Side::Lower))
        }
    }

    /// Replaces Gᵀ by T = L⁻¹Gᵀ, and scales the rows that yield by σ.
    fn substitute_rows(&mut self) {
        let n = self.size;
        let m = self.count;
        let lower = MatRef::from_column_major_slice(&self.stiffness, n, n);
        let mut t = MatMut::from_column_major_slice_mut(&mut self.rows, n, m);
        solve_lower_triangular_in_place(lower, t.rb_mut(), Par::Seq);
        for r in 0..m {
            let square: f64 = (0..n).map(|j| t[(j, r)] * t[(j, r)]).sum();
            if self.yields[r] != 0.0 && square > 0.0 {
                let scale = (1.0 + self.yields[r] / square).sqrt().recip();
                (0..n).for_each(|j| t[(j, r)] *= scale);
                self.directions[r * n..(r + 1) * n].iter_mut().for_each(|slope| *slope *= scale);
                self.scales[r] = scale;
                self.yields[r] = self.yields[r] * scale * scale;
                self.penalties[r] /= scale * scale;
            }
        }
    }

    /// Smallest singular value of R = K⁻¹TᵀU K⁻ᵀ with the sign of its determinant, by inverse
    /// iteration; none if F = G. Where it is not positive, a solution for other states of the
    /// contacts exists for some forces, or none does.
    pub fn regularity(&self) -> Option<f64> {
        let skew = self.skew.as_ref()?;
        let m = self.count;
        let turns = |places: &[usize]| {
            let mut seen = vec![false; places.len()];
            let mut count = 0;
            for first in 0..places.len() {
                let mut next = first;
                let mut length = 0;
                while !std::mem::replace(&mut seen[next], true) {
                    next = places[next];
                    length += 1;
                }
                count += usize::from(length > 0 && length % 2 == 0);
            }
            count
        };
        let pivots = skew.U().diagonal().column_vector();
        let negative = (0..m).filter(|&i| pivots[i] < 0.0).count() + turns(skew.P().arrays().0);
        let sign = if negative % 2 == 0 { 1.0 } else { -1.0 };
        let lower = MatRef::from_column_major_slice(&self.small, m, m);
        // Entries of many signs, so that no singular vector is orthogonal to them.
        let mut x = Mat::from_fn(m, 1, |i, _| 1.0 + 0.5 * (1.7 * i as f64).sin());
        let mut smallest = f64::INFINITY;
        for _ in 0..INVERSE_ITERATIONS {
            let size = x.norm_l2();
            x *= faer::Scale(size.recip());
            // R⁻ᵀ x, of a size of at most 1/σ, and R⁻¹ of it.
            multiply(lower, BlockStructure::TriangularLower, &mut x);
            skew.solve_transpose_in_place(x.as_mut());
            multiply(lower.transpose(), BlockStructure::TriangularUpper, &mut x);
            smallest = x.norm_l2().recip();
            multiply(lower, BlockStructure::TriangularLower, &mut x);
            skew.solve_in_place(x.as_mut());
            multiply(lower.transpose(), BlockStructure::TriangularUpper, &mut x);
        }
        Some(if smallest.is_finite() { sign * smallest } else { 0.0 })
    }

    /// Solves the saddle point: overwrites the right-hand side `b` with x and `c` with the
    /// multipliers λ.
    pub fn solve(&self, b: &mut [f64], c: &mut [f64]) {
        let n = self.size;
        let m = self.count;
        if let Some(indefinite) = &self.indefinite {
            for (i, row) in self.rows.chunks_exact(n.max(1)).enumerate() {
                let pull = self.penalties[i] * c[i];
                b.iter_mut().zip(row).for_each(|(b, slope)| *b += pull * slope);
            }
            let mut both = [&*b, &*c].concat();
            indefinite.solve(&mut both);
            b.copy_from_slice(&both[..n]);
            c.copy_from_slice(&both[n..]);
            return;
        }
        c.iter_mut().zip(&self.scales).for_each(|(c, scale)| *c *= scale);
        self.dependent.iter().for_each(|&row| c[row] = 0.0);
        let lower = MatRef::from_column_major_slice(&self.stiffness, n, n);
        let t = MatRef::from_column_major_slice(&self.rows, n, m);
        let small = MatRef::from_column_major_slice(&self.small, m, m);
        let mut x = MatMut::from_column_major_slice_mut(b, n, 1);
        let mut multipliers = MatMut::from_column_major_slice_mut(c, m, 1);
        solve_lower_triangular_in_place(lower, x.rb_mut(), Par::Seq);
        for i in 0..m {
            let pull = self.penalties[i] * multipliers[(i, 0)];
            for j in 0..n {
                x[(j, 0)] += pull * t[(j, i)];
            }
        }
        for i in 0..m {
            multipliers[(i, 0)] = -multipliers[(i, 0)];
        }
        matmul(multipliers.rb_mut(), Accum::Add, t.transpose(), x.rb(), 1.0, Par::Seq);
        let directions = if let Some(skew) = &self.skew {
            skew.solve_in_place(multipliers.rb_mut());
            MatRef::from_column_major_slice(&self.directions, n, m)
        } else {
            solve_lower_triangular_in_place(small, multipliers.rb_mut(), Par::Seq);
            solve_upper_triangular_in_place(small.transpose(), multipliers.rb_mut(), Par::Seq);
            t
        };
        matmul(x.rb_mut(), Accum::Add, directions, multipliers.rb(), -1.0, Par::Seq);
        solve_upper_triangular_in_place(lower.transpose(), x.rb_mut(), Par::Seq);
        c.iter_mut().zip(&self.scales).for_each(|(c, scale)| *c *= scale);
    }
}

/// Copies the lower triangle of a matrix, column-major; the upper one is not used.
fn copy_lower(from: &[f64], size: usize, to: &mut [f64]) {
    for column in 0..size {
        let entries = column * (size + 1)..(column + 1) * size;
        to[entries.clone()].copy_from_slice(&from[entries]);
    }
}

/// Overwrites x with A x for a triangular matrix A.
fn multiply(triangle: MatRef<f64>, structure: BlockStructure, x: &mut Mat<f64>) {
    let mut product = Mat::zeros(x.nrows(), 1);
    let whole = BlockStructure::Rectangular;
    triangular::matmul(
        product.as_mut(),
        whole,
        Accum::Replace,
        triangle,
        structure,
        x.as_ref(),
        whole,
        1.0,
        Par::Seq,
    );
    *x = product;
}
