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
mod pivoting;
mod sweeps;

pub use couplings::Couplings;
pub use kind::Kind;

use crate::LinearError;

/// Weight ε of the proximal step, relative to the diagonal of the matrix.
const PROXIMAL: f64 = 1e-10;

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
    /// that of a proximal step from the guess: ε D_ii is added to the diagonal and −ε D_ii z_i to
    /// b, ε = 1e-10. Each inequality still counts, and repeated steps converge to a solution of the
    /// problem itself.
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
        if self.is_dependent {
            for i in 0..n {
                let diagonal = self.matrix.at(i, i);
                let near = PROXIMAL * diagonal;
                self.matrix.set(i, i, diagonal + near);
                self.right[i] -= near * z[i];
            }
        }
        if self.kinds.iter().all(|kind| *kind == Kind::Normal) {
            pivoting::complementarity(self.matrix, self.right, z)
        } else {
            sweeps::coulomb(self.matrix, self.right, self.kinds, z)
        }
    }
}

#[cfg(test)]
mod tests {
    use faer::linalg::solvers::Solve;

    use super::*;

    /// Two rows that are the same: proximal steps converge to the stricter of their conditions.
    #[test]
    fn of_dependent_rows_each_inequality_counts() {
        let kinds = [Kind::Normal; 2];
        let mut z = Vec::new();
        for _ in 0..2 {
            let matrix = &mut Couplings::dense(2, vec![1.0; 4]);
            let right = &mut [-1.0, -2.0];
            Cone { matrix, right, kinds: &kinds, is_dependent: true }.solve(&mut z).unwrap();
        }
        assert!((z[0] + z[1] - 2.0).abs() < 1e-15);
    }

    /// All combinations of open, sticking and slipping contacts, tried one by one, against the
    /// solution: of two contacts in the plane, for many motions and coefficients.
    #[test]
    fn the_solution_is_the_one_that_brute_force_finds() {
        let wave = |k: usize| (k as f64 * 12.9898).sin() * 43758.5453 % 1.0;
        for case in 0..400 {
            let basis: Vec<f64> = (0..16).map(|k| wave(k + 100 * case)).collect();
            let mut matrix = vec![0.0; 16];
            for i in 0..4 {
                for j in 0..4 {
                    let dot = (0..4).map(|k| basis[4 * i + k] * basis[4 * j + k]).sum::<f64>();
                    matrix[4 * i + j] = dot + f64::from(u8::from(i == j)) * 0.5;
                }
            }
            let right: Vec<f64> = (0..4).map(|k| wave(k + 7 + 100 * case)).collect();
            let mu = [0.0, 0.1, 0.3][case % 3];
            let tangential = |of| Kind::Tangential { of, coefficient: mu, limit: f64::INFINITY };
            let kinds = [Kind::Normal, Kind::Normal, tangential(0), tangential(1)];
            let mut z = Vec::new();
            let couplings = &mut Couplings::dense(4, matrix.clone());
            let free = &mut right.clone();
            let cone = Cone { matrix: couplings, right: free, kinds: &kinds, is_dependent: false };
            cone.solve(&mut z).unwrap();
            let found = brute_force(&matrix, &right, mu);
            let is_one = |other: &[f64; 4]| (0..4).all(|i| (other[i] - z[i]).abs() < 1e-9);
            assert!(found.iter().any(is_one), "{case}: {z:?} is none of {found:?}");
        }
    }

    /// Every solution of two contacts in the plane: of 4 × 4 ways, open, sticking or slipping
    /// either way, those whose forces and motions obey the law.
    fn brute_force(a: &[f64], b: &[f64], mu: f64) -> Vec<[f64; 4]> {
        let mut solutions = Vec::new();
        for ways in 0..16 {
            let way = [ways % 4, ways / 4];
            // Columns of P₀, P₁, Q₀, Q₁ in terms of the unknowns, and the rows that vanish.
            let mut system = faer::Mat::<f64>::identity(4, 4);
            let mut right = faer::Mat::<f64>::zeros(4, 1);
            for contact in 0..2 {
                let normal = contact;
                let slip = contact + 2;
                if way[contact] > 0 {
                    (0..4).for_each(|j| system[(normal, j)] = a[4 * normal + j]);
                    right[(normal, 0)] = -b[normal];
                }
                match way[contact] {
                    1 => {
                        (0..4).for_each(|j| system[(slip, j)] = a[4 * slip + j]);
                        right[(slip, 0)] = -b[slip];
                    }
                    2 => system[(slip, normal)] = -mu,
                    3 => system[(slip, normal)] = mu,
                    _ => {}
                }
            }
            system.partial_piv_lu().solve_in_place(right.as_mut());
            let z: [f64; 4] = std::array::from_fn(|i| right[(i, 0)]);
            let u: [f64; 4] =
                std::array::from_fn(|i| b[i] + (0..4).map(|j| a[4 * i + j] * z[j]).sum::<f64>());
            let obeys = |contact: usize| {
                let [p, q, gap, rate] = [z[contact], z[contact + 2], u[contact], u[contact + 2]];
                let closes = p >= -1e-12 && gap >= -1e-12;
                closes && q.abs() <= mu * p + 1e-12 && (way[contact] < 2 || q * rate <= 1e-12)
            };
            if obeys(0) && obeys(1) {
                solutions.push(z);
            }
        }
        solutions
    }
}
