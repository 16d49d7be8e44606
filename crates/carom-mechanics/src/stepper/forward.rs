//! The gaps that the law of an explicit step wants ≥ 0, at predicted positions.

use carom_contact::{Pair, Rows};

use crate::contact::depths::gap_at;
use crate::model::Contact;
use crate::state::State;

/// Positions to which a step moves.
#[derive(Debug, Default)]
pub(crate) struct Moved {
    /// y_n + Δt v_{n+½}.
    pub to: Vec<f64>,
    /// ȳ of a law with restitution.
    pub rebound: Vec<f64>,
}

/// A step from y_n with v_{n−½} = `before` and v_{n+½} = `velocity`.
pub(super) struct Forward<'a> {
    pub state: &'a State,
    pub before: &'a [f64],
    pub velocity: &'a [f64],
    pub dt: f64,
}

impl Forward<'_> {
    /// ȳ = (y_{n+1} + e y_{n−1})/(1 + e), where a law with restitution e evaluates gaps.
    fn place(&self, e: f64, at: &mut [f64]) {
        for i in 0..at.len() {
            at[i] = self.state.y[i] + self.dt * (self.velocity[i] - e * self.before[i]) / (1.0 + e);
        }
    }

    /// Replaces the gaps at y_n by those that the law wants ≥ 0. `start` of a pair that is behind
    /// since a longer step is the gap that it may still have at y_{n+1}. Returns whether any pair
    /// is behind at y_n.
    pub(super) fn gaps_of_law(
        &self,
        contact: &Contact,
        pairs: &mut [Pair],
        rows: &mut Rows,
        tolerance: f64,
        at: &mut Moved,
        row: &mut Rows,
    ) -> bool {
        let share = self.dt / self.state.half_step.longest.max(self.dt);
        let mut behind = false;
        let mut leaves = false;
        for (p, pair) in pairs.iter_mut().enumerate() {
            let gap = rows.row(p).gap;
            behind |= gap < -tolerance;
            pair.start = (gap < -tolerance && share < 1.0).then_some((1.0 - share) * gap);
            leaves |= pair.start.is_some();
        }
        let Moved { to, rebound } = at;
        let law = if contact.restitution == 0.0 {
            &to[..]
        } else {
            rebound.resize(to.len(), 0.0);
            self.place(contact.restitution, rebound);
            &rebound[..]
        };
        for (p, pair) in pairs.iter_mut().enumerate().filter(|(_, pair)| pair.start.is_none()) {
            if rows.row(p).gap.is_finite() {
                *rows.gap_mut(p) = gap_at(contact, pair, law, row);
            }
        }
        if leaves {
            for (p, pair) in pairs.iter_mut().enumerate() {
                if let Some(left) = pair.start {
                    *rows.gap_mut(p) = gap_at(contact, pair, to, row) - left;
                }
            }
        }
        behind
    }
}
