//! The tables of metrics that need more of a run than its history: case, contact rows, counters,
//! timings.

use super::definition::{Definition, OWN, Unit, d};
use super::pressure;
use super::rebound::restitution;
use crate::Run;

/// Metrics of the bodies of the first episode.
pub const REBOUND: [(Definition, fn(&Run) -> Option<f64>); 1] = [(
    d(
        "restitution",
        Unit::None,
        "−(w⁺·n)/(w⁻·n), w = v − v_other, n = Σ −λ n_c",
        "Newton 1687",
        "Newton's coefficient of restitution: −(relative velocity after)/(relative velocity before the first episode) of the centres of the striker and of what it strikes, along the normal contact impulse; fixed obstacles are at rest, and a body moves like its supports along an axis in which they hold it",
    ),
    restitution,
)];

/// Metrics of the contact pressure at the end of a static run; not defined for dynamic runs.
pub const PRESSURE: [(Definition, fn(&Run) -> Option<f64>); 6] = [
    (
        d(
            "pressure_min",
            Unit::Stress,
            "min pᵢ",
            OWN,
            "smallest pressure at a node in contact at the end of a static run",
        ),
        pressure::smallest,
    ),
    (
        d(
            "pressure_max",
            Unit::Stress,
            "max pᵢ",
            OWN,
            "largest pressure at a node in contact at the end of a static run",
        ),
        pressure::largest,
    ),
    (
        d(
            "traction_max",
            Unit::Stress,
            "max |qᵢ|",
            OWN,
            "largest tangential traction at a node in contact at the end of a static run",
        ),
        pressure::largest_traction,
    ),
    (
        d(
            "pressure_center",
            Unit::Length,
            "Σ λᵢ sᵢ/Σ λᵢ",
            OWN,
            "coordinate along the contact, across its mean normal, of the resultant pressure at the end of a static run in the plane",
        ),
        pressure::center,
    ),
    (
        d(
            "hertz_peak",
            Unit::Stress,
            "p₀ that minimises Σ (pᵢ² − p₀² (1 − ((sᵢ − c)/a)²))²",
            "Johnson 1985, § 4.2",
            "peak of Hertz's ellipse fitted to the pressures at the end of a static run in the plane",
        ),
        |r| pressure::ellipse(r).map(|fit| fit.0),
    ),
    (
        d(
            "hertz_half_width",
            Unit::Length,
            "a of the fit of hertz_peak",
            "Johnson 1985, § 4.2",
            "half-width of Hertz's ellipse fitted to the pressures at the end of a static run in the plane",
        ),
        |r| pressure::ellipse(r).map(|fit| fit.1),
    ),
];

/// Metrics of the computational work.
pub const WORK: [(Definition, fn(&Run) -> Option<f64>); 6] = [
    (d("steps", Unit::None, "counter steps", OWN, "completed time steps"), |r| count(r, "steps")),
    (d("newton_iterations", Unit::None, "counter newton", OWN, "Newton iterations of all steps"), |r| {
        count(r, "newton")
    }),
    (
        d("rejected_steps", Unit::None, "counter rejected", OWN, "steps that were rejected and bisected"),
        |r| count(r, "rejected"),
    ),
    (
        d(
            "factorisations",
            Unit::None,
            "counter factorisations",
            OWN,
            "factorisations of linear systems, including those of the start and of projections",
        ),
        |r| count(r, "factorisations"),
    ),
    (
        d(
            "cpu_time",
            Unit::Second,
            "timing cpu",
            OWN,
            "processor seconds of the thread that computed the steps, without output",
        ),
        |r| r.manifest.timings.get("cpu").copied(),
    ),
    (
        d(
            "wall_time",
            Unit::Second,
            "timing total",
            OWN,
            "wall seconds of all processes that computed the run, including output",
        ),
        |r| r.manifest.timings.get("total").copied(),
    ),
];

fn count(run: &Run, name: &str) -> Option<f64> {
    run.manifest.counters.get(name).map(|&n| n as f64)
}
