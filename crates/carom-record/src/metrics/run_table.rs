//! The tables of metrics that need more of a run than its history: case, contact rows, counters,
//! timings.

use super::cost::cost;
use super::definition::{Definition, OWN, d};
use super::given::Given;
use super::pressure;
use super::rebound;
use crate::units::Unit;

/// Metrics of the bodies of the first episode.
pub const REBOUND: [Definition; 2] = [
    d(
        "turning_time",
        Unit::Time,
        "t with w(t)·n = 0, linear between rows",
        OWN,
        "time in the first episode at which the striker ceases to approach what it strikes: approach turns into separation, in every frame",
        rebound::turning_time,
    ),
    d(
        "restitution",
        Unit::None,
        "−(w⁺·n)/(w⁻·n), w = v − v_other, n = Σ −λ n_c",
        "Newton 1687",
        "Newton's coefficient of restitution: −(relative velocity after)/(relative velocity before the first contact) of the centres of the striker and of what it strikes, along the normal contact impulse; fixed obstacles are at rest, one that moves has that of its point at the mean place of the contact relative to its centre, a tied body has none, and a body moves like its supports along an axis in which they hold it",
        |g| rebound::restitution(g.run?),
    ),
];

/// Metrics of the contact pressure at the end of a static run; not defined for dynamic runs.
pub(crate) const PRESSURE: [Definition; 6] = [
    d(
        "pressure_min",
        Unit::Stress,
        "min pᵢ",
        OWN,
        "smallest pressure at a node in contact at the end of a static run",
        |g| pressure::smallest(g.run?),
    ),
    d(
        "pressure_max",
        Unit::Stress,
        "max pᵢ",
        OWN,
        "largest pressure at a node in contact at the end of a static run",
        |g| pressure::largest(g.run?),
    ),
    d(
        "traction_max",
        Unit::Stress,
        "max |qᵢ|",
        OWN,
        "largest tangential traction at a node in contact at the end of a static run",
        |g| pressure::largest_traction(g.run?),
    ),
    d(
        "pressure_center",
        Unit::Length,
        "Σ λᵢ sᵢ/Σ λᵢ",
        OWN,
        "coordinate along the contact, across its mean normal and towards +x (or +y), of the resultant pressure at the end of a static run in the plane",
        |g| pressure::center(g.run?),
    ),
    d(
        "hertz_peak",
        Unit::Stress,
        "p₀ that minimises Σ (pᵢ² − p₀² (1 − ((sᵢ − c)/a)²))²",
        "Johnson 1985, § 4.2",
        "peak of Hertz's ellipse fitted to the pressures at the end of a static run in the plane",
        |g| Some(pressure::ellipse(g.run?)?.0),
    ),
    d(
        "hertz_half_width",
        Unit::Length,
        "a of the fit of hertz_peak",
        "Johnson 1985, § 4.2",
        "half-width of Hertz's ellipse fitted to the pressures at the end of a static run in the plane",
        |g| Some(pressure::ellipse(g.run?)?.1),
    ),
];

/// Metrics of the computational work.
pub(crate) const WORK: [Definition; 7] = [
    d("steps", Unit::None, "counter steps", OWN, "completed time steps", |g| count(g, "steps")),
    d("newton_iterations", Unit::None, "counter newton", OWN, "Newton iterations of all steps", |g| {
        count(g, "newton")
    }),
    d("rejected_steps", Unit::None, "counter rejected", OWN, "steps that were rejected and bisected", |g| {
        count(g, "rejected")
    }),
    d(
        "factorisations",
        Unit::None,
        "counter factorisations",
        OWN,
        "factorisations of linear systems, including those of the start and of projections",
        |g| count(g, "factorisations"),
    ),
    d(
        "cost",
        Unit::None,
        "5 steps + 2 newton + 10 factorisations + linear_iterations; with energy-momentum 5 newton; of explicit schemes 1.5 steps + 10 factorisations",
        OWN,
        "counted cost, in evaluations of the internal forces; the same on every machine",
        |g| cost(&g.run?.manifest.counters, g.run?.manifest.facts.stepping),
    ),
    d(
        "cpu_time",
        Unit::Second,
        "timing cpu",
        OWN,
        "processor seconds of the thread that computed the steps, without output",
        |g| seconds(g, "cpu"),
    ),
    d(
        "wall_time",
        Unit::Second,
        "timing total",
        OWN,
        "wall seconds of all processes that computed the run, including output",
        |g| seconds(g, "total"),
    ),
];

fn count(given: &Given, name: &str) -> Option<f64> {
    given.run?.manifest.counters.get(name).map(|&n| n as f64)
}

fn seconds(given: &Given, name: &str) -> Option<f64> {
    given.run?.manifest.timings.get(name).copied()
}
