//! What solves with a frozen tangent instead of the exact one, and with the mass: directly
//! (`direct.rs`, a factor) or by iteration (`iterative.rs`, no factor).
//!
//! ```text
//! [ A + Σ w λ∇²g  Fᵀ ] [Δy]   [−r]       A = w.mass a' M + w.internal K_int − w.external K_ext at the frozen point
//! [ G             −C ] [Δλ] = [−g]       (or M where velocities are projected)
//! ```
//!
//! C is the gap per unit of multiplier of rows that yield. Newton's method and its linear problem
//! know no more of it. Its tangent is a function of the [`Point`] in the state alone.

use std::sync::Arc;

use carom_algebra::LinearError;

use crate::contact::constraints::Constraints;
use crate::model::Model;
use crate::rejected::Rejected;
use crate::stage::renewal::Point;
use carom_solid::Configuration;

/// Solves with the tangent of a point, or with the mass.
pub trait Preconditioner: Send + Sync {
    /// Cost of forming a tangent, in solves with it.
    fn cost(&self) -> f64;

    /// Iterations of all its solves so far; none without.
    fn iterations(&self) -> Option<u64> {
        None
    }

    /// Whether solves iterate, with no factor of the tangent.
    fn is_iterative(&self) -> bool {
        self.iterations().is_some()
    }

    /// Diagonals over the free dofs of the mass and of the last tangent of the internal forces.
    fn diagonals(&self) -> &[Vec<f64>; 2];

    /// Assembles the tangent of the internal forces at positions.
    ///
    /// # Errors
    /// If a cell is inverted there.
    fn assemble(&mut self, model: &Model, at: &Configuration) -> Result<(), Rejected>;

    /// Whether the tangent is positive definite, if it is that of this point.
    fn of(&self, point: &Arc<Point>) -> Option<bool>;

    /// Forms the tangent of a point; `double`: in double precision. Returns whether it is positive
    /// definite, as far as is known.
    ///
    /// # Errors
    /// If a cell is inverted there, or a load has no value.
    fn form(&mut self, model: &Model, point: &Arc<Point>, double: bool) -> Result<bool, Rejected>;

    /// Prepares solves with M and these rows, over the dofs with mass: the others have a unit
    /// diagonal and are excluded from the rows.
    ///
    /// # Errors
    /// If M is not positive definite there, or the rows are linearly dependent.
    fn form_mass(&mut self, model: &Model, rows: &Constraints) -> Result<(), Rejected>;

    /// The nodes that a tangent for these rows eliminates last.
    fn boundary(&self, model: &Model, y: &[f64], rows: &Constraints, last: Option<&Point>) -> Vec<usize>;

    /// Whether the tangent serves these rows.
    fn spans(&self, model: &Model, rows: &Constraints) -> bool;

    /// Prepares solves with the tangent and these rows; returns whether the system is positive
    /// definite on the kernel of the rows, as far as is known.
    ///
    /// # Errors
    /// If the rows are linearly dependent.
    fn prepare(&mut self, model: &Model, rows: &Constraints) -> Result<bool, LinearError>;

    /// Whether the tangent at a point is positive definite for all motions that keep these rows,
    /// where that is known: then an equilibrium is stable. The factor of the last tangent stays.
    ///
    /// # Errors
    /// If a cell is inverted there, or the tangent has no factor.
    fn is_stable(
        &mut self,
        _model: &Model,
        _point: &Point,
        _rows: &Constraints,
    ) -> Result<Option<bool>, Rejected> {
        Ok(None)
    }

    /// See [`carom_algebra::Saddle::regularity`].
    fn regularity(&self) -> Option<f64>;

    /// Solves the prepared system: forces over all dofs, gaps one per row; results likewise (zero
    /// for constrained dofs and springs).
    ///
    /// # Errors
    /// If there is no solution.
    fn solve(
        &mut self,
        model: &Model,
        right: [&[f64]; 2],
        increment: &mut [f64],
        multipliers: &mut Vec<f64>,
    ) -> Result<(), LinearError>;
}
