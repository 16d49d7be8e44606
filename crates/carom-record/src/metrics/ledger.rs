//! Energy balance, from the columns of the ledger. ΔE_i = total_i − total_0 − external_work_i is
//! the energy that the bodies gained beyond the work of loads and supports; it is 0 for the exact
//! motion of elastic bodies. The ledger splits it (its columns are exact for the integrated
//! equations, Krenk 2006):
//!
//! ```text
//! −ΔE = dissipation + (−contact_work) + (−plastic_work)
//!       by the integrator, by contact forces and projections, by plastic flow
//! ```
//!
//! All metrics are divided by the largest kinetic + strain energy of any row. Static runs have no
//! losses but those of friction and plastic flow: the work of load steps is a sum over few steps,
//! and its difference from the energies is the error of this sum.

use super::episode::Episode;
use super::given::Given;
use crate::History;

/// Share of created energy from which a run is not to be trusted: the default of
/// `time.energy_guard`.
pub const MUCH_CREATED: f64 = 0.02;

/// Largest kinetic + strain energy of any row.
fn scale(history: &History) -> Option<f64> {
    let kinetic = history.column("kinetic")?;
    let strain = history.column("strain")?;
    kinetic.iter().zip(strain).map(|(k, s)| k + s).reduce(f64::max).filter(|&s| s > 0.0)
}

/// Whether steps have a balance of energy: load steps have none.
fn has_balance(given: &Given) -> bool {
    given.run.is_none_or(|run| !run.manifest.facts.is_static)
}

/// Change ΔE of the total energy less the external work, by row; and the largest kinetic + strain
/// energy.
fn changes(history: &History) -> Option<(Vec<f64>, f64)> {
    let total = history.column("total")?;
    let work = history.column("external_work")?;
    let scale = scale(history)?;
    Some((total.iter().zip(work).map(|(e, w)| e - total[0] - w).collect(), scale))
}

/// [`changes`] of a run whose steps have a balance.
fn balanced(given: &Given) -> Option<(Vec<f64>, f64)> {
    changes(given.history).filter(|_| has_balance(given))
}

pub(super) fn lost(given: &Given) -> Option<f64> {
    let (changes, scale) = balanced(given)?;
    Some(-changes.last()? / scale)
}

/// The columns have the running values of the run, between rows too.
pub(super) fn created(given: &Given) -> Option<f64> {
    let scale = given.last("energy_scale").filter(|&scale| scale > 0.0)?;
    Some(given.last("energy_created")? / scale)
}

pub(super) fn drift(given: &Given) -> Option<f64> {
    let (changes, scale) = balanced(given)?;
    Some(changes.iter().fold(0.0, |most, x| f64::max(most, x.abs())) / scale)
}

/// Largest energy that time integrator and contact dissipated or created up to any time. The work
/// that an obstacle does by its motion is not among it, but external work.
pub(super) fn by_scheme(given: &Given) -> Option<f64> {
    let (_, scale) = balanced(given)?;
    let dissipation = given.history.column("dissipation")?;
    let work = given.history.column("contact_work");
    let lost = |row: usize| dissipation[row] - work.map_or(0.0, |work| work[row]);
    Some((0..dissipation.len()).map(|row| lost(row).abs()).fold(0.0, f64::max) / scale)
}

/// Last value of a cumulative column, divided by the scale.
fn share(given: &Given, column: &str) -> Option<f64> {
    Some(given.last(column)? / scale(given.history)?)
}

pub(super) fn by_integrator(given: &Given) -> Option<f64> {
    share(given, "dissipation").filter(|_| has_balance(given))
}

/// Energy dissipated by friction, divided by the largest kinetic + strain energy; none without
/// friction.
pub(super) fn by_friction(given: &Given) -> Option<f64> {
    given.history.column("slip")?;
    share(given, "friction_work").map(|work| 0.0 - work)
}

/// Energy dissipated by plastic flow, divided by the largest kinetic + strain energy; none of
/// elastic bodies.
pub(super) fn by_flow(given: &Given) -> Option<f64> {
    share(given, "plastic_work").map(|work| 0.0 - work)
}

/// Largest equivalent plastic strain at the end over the quadrature points; none of elastic bodies.
pub(super) fn permanent_set(given: &Given) -> Option<f64> {
    let names = given.history.columns.iter().map(|column| column.name.as_str());
    // Bodies have plastic work, too; probes lie between quadrature points.
    let is_of_body = |name: &&str| {
        let body = name.strip_suffix(".plastic_strain");
        body.is_some_and(|body| given.history.column(&format!("{body}.plastic_work")).is_some())
    };
    let strains: Vec<f64> = names.filter(is_of_body).filter_map(|name| given.last(name)).collect();
    // A law of the user's own does not tell its strain.
    let is_known = strains.iter().all(|strain| !strain.is_nan());
    strains.into_iter().reduce(f64::max).filter(|_| is_known)
}

pub(super) fn by_contact(given: &Given) -> Option<f64> {
    share(given, "contact_work").filter(|_| has_balance(given)).map(|work| 0.0 - work)
}

fn over(history: &History, episode: Episode) -> Option<f64> {
    let (changes, scale) = changes(history)?;
    let rows = episode.span(history);
    episode.end.map(|_| (changes[rows.start] - changes[rows.end - 1]) / scale)
}

pub(super) fn at_worst_impact(given: &Given) -> Option<f64> {
    let losses = given.episodes.iter().filter(|_| has_balance(given)).filter_map(|e| over(given.history, *e));
    losses.reduce(|worst, next| if next.abs() > worst.abs() { next } else { worst })
}

/// Energy lost over the n-th contact episode, counted from 1; none if it did not end.
pub fn energy_lost_at(history: &History, n: usize) -> Option<f64> {
    Given::of(history).episodes.get(n.checked_sub(1)?).and_then(|e| over(history, *e))
}
