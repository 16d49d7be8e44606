//! Friction in a stage and in a state. With y_½ = (y_s + y)/2, the row H of
//! [`Kinematics::slip`](carom_contact::Kinematics::slip) and the states of `carom_contact::StickSlip`
//!
//! ```text
//! S = H(y_½)·(Δy − Δy_free),   force  λ∇g + qH(y_½),   ∂S/∂y = H + ½ ∂H/∂yᵀ (Δy − Δy_free)
//! ```
//!
//! Δy_free = 0, except for a pair that was open at the step's start. What slips before it touches
//! does not count: its S is the velocity at the end of the stage, v(Δy) = v'·(Δy − Δy_free), divided
//! by v'. A pair that slips has q = −sμλ and is the normal row with the direction ∇g − sμH; one that
//! sticks is a row of its own with S = 0 and the multiplier q.
//!
//! Between steps q acts along H(y_s): in the averaged forces of the next step and in what is
//! recorded.

use carom_contact::{ContactError, Pair, Row, Rows, Tangential};

use crate::equations::{Equations, Evaluation};
use crate::model::{Contact, Model};
use crate::state::State;

impl Model {
    /// Whether a contact has friction.
    pub(crate) fn has_friction(&self) -> bool {
        self.contacts.iter().any(|contact| contact.friction.is_some())
    }
}

impl Equations<'_> {
    /// Adds the row H of a closed pair at y_½, with S as its gap.
    pub(crate) fn slip_into(
        &self,
        contact: usize,
        pair: &Pair,
        middle: &[f64],
        increment: &[f64],
        slips: &mut Rows,
    ) -> Result<(), ContactError> {
        let kinematics = &self.model.contacts[contact].kinematics;
        let mut at_middle = *pair;
        kinematics.measure(&mut at_middle, middle, slips)?;
        slips.pop();
        let closes = self.closes(contact, pair);
        kinematics.slip(&at_middle, middle, slips)?;
        let row = slips.row(slips.len() - 1);
        let counted = |(dof, slope): (usize, f64)| slope * self.counted(dof, closes, increment);
        let slip = row.entries().map(counted).sum();
        *slips.gap_mut(slips.len() - 1) = slip;
        Ok(())
    }

    /// S of a pair that closes in an iterate; 0 if it has none.
    pub(crate) fn slip(&self, contact: usize, pair: &Pair, middle: &[f64], increment: &[f64]) -> f64 {
        let mut rows = Rows::new(self.model.dimension);
        self.slip_into(contact, pair, middle, increment, &mut rows).map_or(0.0, |()| rows.row(0).gap)
    }

    /// A component of Δy − Δy_free.
    fn counted(&self, dof: usize, closes: bool, increment: &[f64]) -> f64 {
        let velocity = &self.stage.velocity;
        increment[dof] + if closes { velocity.at_start[dof] / velocity.slope } else { 0.0 }
    }

    /// Whether a pair was open at the step's start.
    fn closes(&self, contact: usize, pair: &Pair) -> bool {
        let old = &self.state.pairs[contact];
        let first = old.partition_point(|other| other.node < pair.node);
        let mut of_node = old[first..].iter().take_while(|other| other.node == pair.node);
        !self.stage.is_static() && !of_node.any(|other| other.active)
    }

    /// ∂H/∂y of a pair at y_½ halved, the derivative of its row by the end of the step, row-major; and
    /// ∂S/∂y.
    pub(crate) fn slip_derivatives(
        &self,
        evaluation: &Evaluation,
        (contact, p): (usize, usize),
        rows: &mut Rows,
    ) -> (Vec<f64>, Vec<f64>) {
        let kinematics = &self.model.contacts[contact].kinematics;
        let (row, pair) = (evaluation.slips[contact].row(p), &evaluation.at.pairings[contact].pairs[p]);
        let mut matrix = vec![0.0; row.gradient.len().pow(2)];
        let mut gradient = row.gradient.to_vec();
        let mut at_middle = *pair;
        rows.clear();
        let closes = self.closes(contact, pair);
        // It was measured in the evaluation.
        if kinematics.measure(&mut at_middle, &evaluation.middle, rows).is_err() {
            return (matrix, gradient);
        }
        kinematics.slip_derivative_into(&at_middle, &evaluation.middle, &mut matrix);
        matrix.iter_mut().for_each(|entry| *entry *= 0.5);
        let counted = row.entries().map(|(dof, _)| self.counted(dof, closes, &evaluation.at.increment));
        for (turned, moved) in matrix.chunks_exact(gradient.len()).zip(counted) {
            gradient.iter_mut().zip(turned).for_each(|(slope, h)| *slope += h * moved);
        }
        (matrix, gradient)
    }
}

/// Calls `visit(contact, pair, H)` for the closed pairs of a state that have friction, with H at its
/// positions.
pub fn each_slip(model: &Model, state: &State, mut visit: impl FnMut(usize, usize, Row)) {
    let mut rows = Rows::new(model.dimension);
    let rubs = |(_, contact): &(usize, &Contact)| contact.friction.is_some();
    for (k, contact) in model.contacts.iter().enumerate().filter(rubs) {
        for (p, pair) in state.pairs[k].iter().enumerate().filter(|(_, pair)| pair.active) {
            let mut at = *pair;
            rows.clear();
            if contact.kinematics.measure(&mut at, &state.y, &mut rows).is_ok()
                && contact.kinematics.slip(&at, &state.y, &mut rows).is_ok()
            {
                visit(k, p, rows.row(1));
            }
        }
    }
}

/// Force of friction on a secondary side, −Σ q ∂S/∂y_N over the closed pairs.
pub(crate) fn secondary_friction<'a>(pairs: &[Pair], slips: impl Iterator<Item = Row<'a>>) -> [f64; 3] {
    let mut force = [0.0; 3];
    for (pair, row) in pairs.iter().zip(slips).filter(|(pair, _)| pair.active) {
        let along = row.normal();
        (0..3).for_each(|i| force[i] -= pair.tangential.traction * along[i]);
    }
    force
}

/// Adds the slips of a solved step to those of the closed pairs; open pairs have none.
pub(crate) fn take_slips(model: &Model, state: &mut State, slips: &[Rows]) {
    for (k, contact) in model.contacts.iter().enumerate() {
        if contact.friction.is_none() {
            continue;
        }
        for (pair, row) in state.pairs[k].iter_mut().zip(slips[k].iter()) {
            if pair.active {
                pair.tangential.slip += row.gap;
            } else {
                pair.tangential = Tangential::default();
            }
        }
    }
}
