//! Unilateral contact with Coulomb's law over a few rows, which explicit steps, impulse schemes and
//! the fallback solve in every iteration:
//!
//! ```text
//! u = A z + b,   z = (P, Q),   0 ≤ P_i ⊥ u_i ≥ 0
//! |Q_j| ≤ r_j,   Q_j = −r_j u_j/|u_j| where u_j ≠ 0,   r_j = min(μ_j P_j, limit_j)
//! ```
//!
//! A symmetric and positive semi-definite. Without tangential forces principal pivoting solves it
//! in finitely many steps (`pivoting.rs`); with them sweeps of the nonlinear Gauss–Seidel method
//! find which contacts are open, stick or slip (`sweeps.rs`), for which the problem is linear and
//! is solved exactly (`exact.rs`).

mod couplings;
mod exact;
mod kind;
#[doc(hidden)]
pub mod pivoting;
#[doc(hidden)]
pub mod sweeps;

pub use couplings::Couplings;
pub use kind::Kind;

use crate::LinearError;
use couplings::PROXIMAL;

/// A problem of unilateral contact with friction for the forces z: motions u = A z + b.
#[derive(Debug, PartialEq)]
pub struct Cone<'a> {
    /// Matrix A.
    pub matrix: &'a mut Couplings,
    /// Right-hand side b: the motions without forces.
    pub right: &'a mut [f64],
    /// Law of each unknown force.
    pub kinds: &'a [Kind],
    /// Whether A is singular, because rows of contacts depend on each other. The solution is then
    /// that of a proximal step from the guess, with friction from the forces that the sweeps find:
    /// ε D_ii is added to the diagonal and −ε D_ii z_i to b, ε = 1e-10. Each inequality still
    /// counts, and repeated steps converge to a solution of the problem itself.
    pub is_dependent: bool,
}

impl Cone<'_> {
    /// Overwrites `z`, a guess (zero where it is too short), with the solution.
    ///
    /// # Errors
    /// If A is not positive definite on the forces that act, or no solution is found, as for large
    /// μ, where there may be none.
    ///
    /// ```
    /// use carom_algebra::{Cone, Couplings, Kind};
    /// let kinds = [Kind::Normal, Kind::Tangential { of: 0, coefficient: 0.5, limit: f64::INFINITY }];
    /// let matrix = &mut Couplings::dense(2, vec![2.0, 0.0, 0.0, 1.0]);
    /// let right = &mut [-4.0, 3.0];
    /// let mut z = Vec::new();
    /// Cone { matrix, right, kinds: &kinds, is_dependent: false }.solve(&mut z)?;
    /// assert_eq!(z, [2.0, -1.0]); // P = 2; it slips against 0.5 P
    /// # Ok::<(), carom_algebra::LinearError>(())
    /// ```
    pub fn solve(self, z: &mut Vec<f64>) -> Result<(), LinearError> {
        let n = self.right.len();
        z.resize(n, 0.0);
        if self.kinds.iter().any(|kind| *kind != Kind::Normal) {
            return sweeps::coulomb(self.matrix, self.right, self.kinds, z, self.is_dependent);
        }
        if self.is_dependent {
            for i in 0..n {
                let diagonal = self.matrix.at(i, i);
                let near = PROXIMAL * diagonal;
                self.matrix.set(i, i, diagonal + near);
                self.right[i] -= near * z[i];
            }
        }
        pivoting::complementarity(self.matrix, self.right, z)
    }
}
