//! One step with contact implicit in velocity, where no step of the scheme is accepted: backward
//! Euler, with a complementarity problem of impulses and of the velocities at the end,
//!
//! ```text
//! M (v_{n+1} − v_n) = Δt (f_ext − f_int)_{n+1} + GᵀP,   y_{n+1} = y_n + Δt v_{n+1}
//! 0 ≤ [g + G (y_n − ŷ)]/Δt + G v_{n+1} ⊥ P ≥ 0,   g and G at ŷ
//! ```
//!
//! (D. E. Stewart, J. C. Trinkle, Int. J. Numer. Meth. Engng 39 (1996) 2673–2691; M. Anitescu, G.
//! D. Hart, Int. J. Numer. Meth. Engng 60 (2004) 2335–2371). Given ŷ, pivoting finds the impulses
//! without an active set that could cycle (`impulses.rs`). ŷ is y_n, and then the end found with
//! the ŷ before, until no pair is added and the gaps themselves are zero, or [`PASSES`] times: an
//! error of the linearisation is left as a penetration, which is measured and limited as in every
//! step.

use carom_contact::{Pairing, Rows};
use carom_time::ImpulseShares;

use super::impulses::Impulses;
use super::impulsive;
use super::watch::measure_into;
use crate::contact::depths::{begin, beginning};
use crate::contact::update::search;
use crate::model::Model;
use crate::rejected::Rejected;
use crate::settings::Settings;
use crate::stage::equations::Equations;
use crate::stage::evaluation::Evaluation;
use crate::stage::newton::Effort;
use crate::timings::timed;
use crate::workspace::Workspace;

/// Linearisations of the gaps in a step.
const PASSES: usize = 12;
/// Gap, as a fraction of L, at which they end.
const CLOSED: f64 = 1e-11;

/// Solves a stage of backward Euler from the start of its step, with the pairs that are closed
/// there.
pub(super) fn solve_in_velocity(
    equations: &Equations,
    dt: f64,
    settings: &Settings,
    mut pairings: Vec<Pairing>,
    work: &mut Workspace,
) -> Result<(Evaluation, Effort), Rejected> {
    let model = equations.model;
    let state = equations.state;
    let shares = ImpulseShares { force: 1.0 / dt, ..ImpulseShares::default() };
    let mut effort = Effort::default();
    let mut increment = vec![0.0; state.y.len()];
    equations.arrive(&mut increment);
    let mut measured = Vec::new();
    let mut solved: Option<(Evaluation, Impulses)> = None;
    for pass in 0..PASSES {
        let at: Vec<f64> = state.y.iter().zip(&increment).map(|(y, d)| y + d).collect();
        let mut found = pairings.clone();
        let mut events = Vec::new();
        let error = timed(&mut work.timings.contact, || {
            search(model, &state.y, &at, &mut found, &mut events);
            begin(model, beginning(state, &state.y), &mut found);
            measure_into(model, &at, &mut found, &mut measured)?;
            Ok::<f64, Rejected>(close(model, &mut found, &measured))
        })?;
        if pass > 0 && error <= CLOSED * model.scale {
            break;
        }
        effort.events.extend(events);
        pairings = found;
        let mut impulses = Impulses::linearised(model, (state, dt), &at, &pairings, &measured)?;
        let now = impulsive::solve(
            settings,
            equations,
            shares,
            std::mem::take(&mut increment),
            &mut impulses,
            &mut effort.iterations,
            work,
        )?;
        for pair in pairings.iter_mut().flat_map(|pairing| &mut pairing.pairs) {
            (pair.active, pair.lambda) = (false, 0.0);
        }
        for (row, impulse) in impulses.rows.list.iter().zip(&impulses.values) {
            let (k, p) = row.place;
            let pair = &mut pairings[k].pairs[p];
            (pair.active, pair.lambda) = (*impulse > 0.0, -impulse / dt);
        }
        increment.clone_from(&now.at.increment);
        if let Some((before, _)) = solved.replace((now, impulses)) {
            work.spare.put(before);
        }
    }
    let Some((mut now, impulses)) = solved else {
        return Err(Rejected::NotFinite { what: "a step of no passes" });
    };
    measure_into(model, &now.y, &mut pairings, &mut now.rows)?;
    turn(&pairings, &impulses, &mut now.turned);
    now.at.pairings = pairings;
    Ok((now, effort))
}

/// Closes pairs that penetrate, and returns the largest gap that is not as it should be: of an open
/// pair behind its facet, or of a closed one.
fn close(model: &Model, pairings: &mut [Pairing], measured: &[Rows]) -> f64 {
    let mut error = 0.0_f64;
    for (pairing, rows) in pairings.iter_mut().zip(measured) {
        for (pair, row) in pairing.pairs.iter_mut().zip(rows.iter()) {
            if pair.active || row.gap < 0.0 {
                error = error.max(row.gap.abs());
            }
            pair.active |= row.gap < -CLOSED * model.scale;
        }
    }
    error
}

/// The directions in which the impulses act, a row per pair.
fn turn(pairings: &[Pairing], impulses: &Impulses, turned: &mut [Rows]) {
    let rows = &impulses.rows;
    for (k, (pairing, turned)) in pairings.iter().zip(turned).enumerate() {
        turned.clear();
        for p in 0..pairing.pairs.len() {
            match rows.list.binary_search_by_key(&(k, p), |row| row.place) {
                Ok(row) => turned.push_row(rows.rows.row(row)),
                Err(_) => turned.push_open(),
            }
        }
    }
}
