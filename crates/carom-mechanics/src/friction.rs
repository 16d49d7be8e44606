//! Friction in a stage and in a state. With y_½ = (y_s + y)/2, the row H of
//! [`Kinematics::slip`](carom_contact::Kinematics::slip) and the states of `carom_contact::StickSlip`
//!
//! ```text
//! S = H(y_½)·(Δy − θ Δy_free),   force  λ∇g + qH(y_½),   ∂S/∂y = H + ½ ∂H/∂yᵀ (Δy − θ Δy_free)
//! ```
//!
//! θ = 0, except for a pair that was open at the step's start: a free flight Δy_free = τ v_s + τ²/2 a_s
//! would close it at the fraction θ of the time τ, and what slips before that, up to nine tenths of the step, does not count. A pair
//! that slips has q = −sμλ and is the normal row with the direction ∇g − sμH; one that sticks is a row
//! of its own with S = 0 and the multiplier q.
//!
//! Between steps q acts along H(y_s): in the averaged forces of the next step and in what is recorded.

use carom_contact::{ContactError, Pair, Row, Rows, Tangential};

use crate::equations::{Equations, Evaluation};
use crate::model::{Contact, Model};
use crate::rejected::Rejected;
use crate::state::State;

/// Largest θ: a slip must be left by which to decide on stick or slip.
const LATEST: f64 = 0.9;
/// Most corrections of the tractions of a state, each of which reduces the error by about μ.
const CORRECTIONS: usize = 200;

impl Model {
    /// Whether a contact has friction.
    pub(crate) fn has_friction(&self) -> bool {
        self.contacts.iter().any(|contact| contact.friction.is_some())
    }
}

impl Equations<'_> {
    /// Positions y_s + Δy_free after a time; empty without friction.
    pub(crate) fn free_flight(model: &Model, state: &State, time: f64) -> Vec<f64> {
        if !model.has_friction() {
            return Vec::new();
        }
        let motion = state.v.iter().zip(&state.a);
        state.y.iter().zip(motion).map(|(y, (v, a))| y + time * (v + 0.5 * time * a)).collect()
    }

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
        let share = self.before_touch(contact, pair, slips)?;
        kinematics.slip(&at_middle, middle, slips)?;
        let row = slips.row(slips.len() - 1);
        let counted = |(dof, slope): (usize, f64)| slope * self.counted(dof, share, increment);
        let slip = row.entries().map(counted).sum();
        *slips.gap_mut(slips.len() - 1) = slip;
        Ok(())
    }

    /// S of a pair that closes in an iterate; 0 if it has none.
    pub(crate) fn slip(&self, contact: usize, pair: &Pair, middle: &[f64], increment: &[f64]) -> f64 {
        let mut rows = Rows::new(self.model.dimension);
        self.slip_into(contact, pair, middle, increment, &mut rows).map_or(0.0, |()| rows.row(0).gap)
    }

    /// A component of Δy − θ Δy_free.
    fn counted(&self, dof: usize, share: f64, increment: &[f64]) -> f64 {
        if share == 0.0 {
            increment[dof]
        } else {
            increment[dof] - share * (self.flight[dof] - self.state.y[dof])
        }
    }

    /// θ of a pair.
    fn before_touch(&self, contact: usize, pair: &Pair, rows: &mut Rows) -> Result<f64, ContactError> {
        let old = &self.state.pairs[contact];
        let first = old.partition_point(|other| other.node < pair.node);
        if old[first..].iter().take_while(|other| other.node == pair.node).any(|other| other.active) {
            return Ok(0.0);
        }
        let start = self.gap_at_start(contact, pair, rows)?;
        if start <= 0.0 || self.stage.is_static() {
            return Ok(0.0);
        }
        self.model.contacts[contact].kinematics.measure(&mut pair.clone(), &self.flight, rows)?;
        let end = rows.pop();
        Ok(if end < 0.0 { (start / (start - end)).min(LATEST) } else { LATEST })
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
        // Both were measured in the evaluation.
        let Ok(share) = self.before_touch(contact, pair, rows) else { return (matrix, gradient) };
        if kinematics.measure(&mut at_middle, &evaluation.middle, rows).is_err() {
            return (matrix, gradient);
        }
        kinematics.slip_derivative_into(&at_middle, &evaluation.middle, &mut matrix);
        matrix.iter_mut().for_each(|entry| *entry *= 0.5);
        let counted = row.entries().map(|(dof, _)| self.counted(dof, share, &evaluation.at.increment));
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

/// Σ qH of a state.
pub(crate) fn add_friction(model: &Model, state: &State, force: &mut [f64]) {
    each_slip(model, state, |k, p, row| row.add_to(state.pairs[k][p].tangential.traction, force));
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

/// Tractions for the multipliers of a state: those of slipping pairs by Coulomb's law, those of sticking
/// pairs reduced to the cone. Returns the largest change.
fn follow(model: &Model, state: &mut State) -> f64 {
    let mut change = 0.0_f64;
    for (contact, pairs) in model.contacts.iter().zip(&mut state.pairs) {
        let Some(coefficient) = contact.friction else { continue };
        for pair in pairs.iter_mut().filter(|pair| pair.active) {
            let cone = coefficient * (-pair.lambda).max(0.0);
            let new = pair.tangential.of_law(coefficient, pair.lambda).clamp(-cone, cone);
            change = change.max((new - pair.tangential.traction).abs());
            pair.tangential.traction = new;
        }
    }
    change
}

/// Multipliers and accelerations of a state with friction: `solve` finds them for given tractions, which
/// then follow from the multipliers.
pub(crate) fn balance_friction(
    model: &Model,
    state: &mut State,
    mut solve: impl FnMut(&mut State) -> Result<(), Rejected>,
) -> Result<(), Rejected> {
    solve(state)?;
    if !model.has_friction() {
        return Ok(());
    }
    for _ in 0..CORRECTIONS {
        let change = follow(model, state);
        if change == 0.0 {
            return Ok(());
        }
        let before = largest(state);
        solve(state)?;
        if change <= 1e-14 * before {
            follow(model, state);
            return Ok(());
        }
    }
    Err(Rejected::NoFrictionBalance)
}

fn largest(state: &State) -> f64 {
    state.pairs.iter().flatten().map(|pair| pair.lambda.abs()).fold(0.0, f64::max)
}
