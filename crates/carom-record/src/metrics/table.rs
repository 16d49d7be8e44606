//! The table of named metrics: name, formula, unit, source and meaning of each beside the function
//! that computes it. Reports, studies, the book and expectations know a metric by its entry here
//! and by nothing else.

use super::column::{column_roughness, in_contact, peak_of_means};
use super::definition::{Definition, Unit};
use super::episode::first_episode;
use super::facts::{Facts, vector};
use super::samples::{extreme, peak_mean, roughness, total_variation};
use super::striker::{apex, restitution, turning_time};
use super::{force, ledger, oscillation, pressure};
use crate::{History, Run};

const fn d(
    name: &'static str,
    unit: Unit,
    formula: &'static str,
    source: &'static str,
    meaning: &'static str,
) -> Definition {
    Definition { name, formula, unit, source, meaning }
}

const OWN: &str = "this project";
const TABLES: &str = "Doyen, Ern, Piperno 2011 compare by it";

/// Metrics of a history.
pub const HISTORY: [(Definition, fn(&Facts) -> Option<f64>); 24] = [
    (
        d(
            "contact_start",
            Unit::Time,
            "t_a, a the first row with active > 0",
            TABLES,
            "first recorded time with an active contact node",
        ),
        |f| Some(f.time(f.first()?.start)),
    ),
    (
        d(
            "contact_end",
            Unit::Time,
            "t_b, b the first row after the episode",
            TABLES,
            "first recorded time without one after the first episode",
        ),
        |f| Some(f.time(f.first()?.end?)),
    ),
    (
        d("contact_duration", Unit::Time, "t_b − t_a", TABLES, "from start to end of the first episode"),
        |f| f.duration(),
    ),
    (
        d(
            "contact_episodes",
            Unit::None,
            "spans of rows with active > 0, gaps < 0.02 (t_last − t_0) closed",
            OWN,
            "number of contact episodes; gaps under 2 % of the recorded time do not count",
        ),
        |f| f.history.column("active").map(|_| f.episodes.len() as f64),
    ),
    (
        d(
            "impulse_x",
            Unit::Impulse,
            "P_x(t_b) − P_x(t_{a−1})",
            TABLES,
            "x component of the contact impulse of the first episode, on the secondary side",
        ),
        |f| f.impulse(0),
    ),
    (
        d(
            "impulse_y",
            Unit::Impulse,
            "P_y(t_b) − P_y(t_{a−1})",
            TABLES,
            "y component of the contact impulse of the first episode, on the secondary side",
        ),
        |f| f.impulse(1),
    ),
    (
        d(
            "peak_force",
            Unit::Force,
            "max |F|",
            TABLES,
            "largest contact force of any recorded step (does not converge with the time step)",
        ),
        |f| extreme(&f.force, f64::gt).map(|x| x.1),
    ),
    (
        d(
            "peak_mean_force",
            Unit::Force,
            "max_t |P(t + w) − P(t)|/w, w = (t_b − t_a)/16",
            OWN,
            "largest contact force averaged over 1/16 of the first episode",
        ),
        |f| peak_mean(f.history.times(), &vector(f.history, "contact_impulse"), f.duration()? / 16.0),
    ),
    (
        d(
            "force_roughness",
            Unit::None,
            "TV(|F|)/(2 max |F| − |F|_{a−1} − |F|_b) − 1, TV = Σ |x_{n+1} − x_n|",
            "total variation: Harten 1983",
            "total variation of the contact force over what one rise and one fall need, minus 1",
        ),
        |f| roughness(f.force.get(f.rows.clone()?)?),
    ),
    (
        d(
            "force_variation",
            Unit::Force,
            "TV(|F|) over the first episode",
            "total variation: Harten 1983",
            "total variation of the contact force in the first episode",
        ),
        force::variation,
    ),
    (
        d(
            "force_high_frequency",
            Unit::None,
            "1 − Σ_{|k| ≤ 16} |F_k|²/(N Σ F_n²), F_k the discrete Fourier transform over the episode",
            "Parseval's identity",
            "share of the contact force's power above 16 cycles per first episode",
        ),
        force::high,
    ),
    (
        d(
            "chatter",
            Unit::PerTime,
            "Σ (activations + releases) / Σ (t_b − t_a)",
            OWN,
            "switches of contact nodes, on and off, per time in contact",
        ),
        force::chatter,
    ),
    (
        d(
            "restitution",
            Unit::None,
            "−(v⁺·n)/(v⁻·n), n along the impulse",
            "Newton's coefficient",
            "velocity of the striker's centre along the impulse: after / before the first episode, sign reversed",
        ),
        |f| restitution(f.history, f.first()?),
    ),
    (
        d(
            "turning_time",
            Unit::Time,
            "t with v(t)·n = 0, linear between rows",
            OWN,
            "phase of the impact: time at which the striker's centre turns in the first episode",
        ),
        turning_time,
    ),
    (
        d(
            "apex",
            Unit::Length,
            "vertex of the parabola through the highest row and its neighbours, − y_0",
            OWN,
            "highest rise of the striker's centre over its start, after the first episode",
        ),
        |f| apex(f).map(|a| a.1),
    ),
    (d("apex_time", Unit::Time, "time of that vertex", OWN, "time of the apex"), |f| apex(f).map(|a| a.0)),
    (
        d(
            "energy_lost",
            Unit::None,
            "−ΔE_last/E*, ΔE = total − total_0 − external_work, E* = max (kinetic + strain)",
            "Krenk 2006",
            "energy lost by the end / largest kinetic + strain energy; negative: created",
        ),
        ledger::lost,
    ),
    (
        d(
            "energy_created",
            Unit::None,
            "max_t [E(t) − min_{s ≤ t} E(s)] / max(E*, Σ |ΔW|), E = total − W, W = external_work",
            "Krenk 2006",
            "largest rise of the energy above its running minimum / largest kinetic + strain energy or Σ of |external work|",
        ),
        ledger::created,
    ),
    (
        d(
            "energy_drift",
            Unit::None,
            "max |ΔE|/E*",
            "Krenk 2006",
            "largest change of energy, up or down, at any time / largest kinetic + strain energy",
        ),
        ledger::drift,
    ),
    (
        d(
            "energy_lost_impact",
            Unit::None,
            "the ΔE(t_{a−1}) − ΔE(t_b) of largest size, over E*",
            OWN,
            "energy lost over the impact that changes it most / largest kinetic + strain energy; energy_lost:N asks for the N-th",
        ),
        ledger::at_worst_impact,
    ),
    (
        d(
            "dissipated_integrator",
            Unit::None,
            "dissipation_last/E*",
            "Krenk 2006",
            "energy the time integrator itself dissipated by the end / largest kinetic + strain energy",
        ),
        ledger::by_integrator,
    ),
    (
        d(
            "dissipated_contact",
            Unit::None,
            "−contact_work_last/E*",
            "Krenk 2006",
            "energy that contact forces and projections took by the end / largest kinetic + strain energy",
        ),
        ledger::by_contact,
    ),
    (
        d("penetration", Unit::Length, "max (0, −g)", TABLES, "deepest penetration of a secondary node"),
        |f| extreme(f.history.column("penetration")?, f64::gt).map(|x| x.1),
    ),
    (
        d(
            "penetration_mean",
            Unit::Length,
            "mean of the deepest over the rows with active > 0",
            OWN,
            "deepest penetration of a row, averaged over the rows in contact",
        ),
        force::mean_penetration,
    ),
];

/// Metrics of a probe's column `C`, called `C:min` and so on.
pub const COLUMNS: [(Definition, fn(&History, &str) -> Option<f64>); 6] = [
    (d("min", Unit::Column, "min c", OWN, "smallest recorded value of the column"), |h, c| {
        extreme(h.column(c)?, f64::lt).map(|x| x.1)
    }),
    (d("max", Unit::Column, "max c", OWN, "largest recorded value of the column"), |h, c| {
        extreme(h.column(c)?, f64::gt).map(|x| x.1)
    }),
    (
        d(
            "roughness",
            Unit::None,
            "TV(c)/(2 (max c − min c)) − 1",
            "total variation: Harten 1983",
            "total variation over twice the range, minus 1, in the first contact episode: 0 for one hump",
        ),
        column_roughness,
    ),
    (
        d(
            "variation",
            Unit::Column,
            "TV(c)",
            "total variation: Harten 1983",
            "total variation of the column in the first contact episode",
        ),
        |h, c| Some(total_variation(h.column(c)?.get(first_episode(h)?.span(h))?)),
    ),
    (
        d(
            "peak_mean",
            Unit::Column,
            "max_t |∫ c dt|/w from t to t + w, w = (t_b − t_a)/16",
            OWN,
            "largest size of the column averaged over 1/16 of the first contact episode",
        ),
        peak_of_means,
    ),
    (
        d(
            "high_frequency",
            Unit::None,
            "1 − Σ_{|k| ≤ 16} |C_k|²/(N Σ c_n²)",
            "Parseval's identity",
            "share of the column's power above 16 cycles per first contact episode",
        ),
        |h, c| force::high_frequency(in_contact(h, c)?),
    ),
];

/// Metrics of a column that oscillates freely, called like those of [`COLUMNS`]; none of any other
/// column.
pub const FREE: [(Definition, fn(&History, &str) -> Option<f64>); 2] = [
    (
        d(
            "damping_ratio",
            Unit::None,
            "−ln|z|/arg z, z of c_{n+1} = 2 Re z c_n − |z|² c_{n−1} by least squares over the second half",
            "Prony 1795",
            "damping ratio of a column that oscillates freely about zero",
        ),
        oscillation::damping_ratio,
    ),
    (
        d("period", Unit::Time, "2π Δt/arg z, z likewise", "Prony 1795", "period of that oscillation"),
        oscillation::period,
    ),
];

/// Metrics of the pressure between bodies at the end of a static run; none of a motion.
pub const PRESSURE: [(Definition, fn(&Run) -> Option<f64>); 4] = [
    (
        d(
            "pressure_min",
            Unit::Stress,
            "min pᵢ",
            OWN,
            "smallest pressure of the nodes in contact at the end of a static run",
        ),
        pressure::smallest,
    ),
    (
        d(
            "pressure_max",
            Unit::Stress,
            "max pᵢ",
            OWN,
            "largest pressure of the nodes in contact at the end of a static run",
        ),
        pressure::largest,
    ),
    (
        d(
            "hertz_peak",
            Unit::Stress,
            "p₀ of the least Σ (pᵢ² − p₀² (1 − ((sᵢ − c)/a)²))²",
            "Johnson 1985, § 4.2",
            "peak of Hertz's ellipse through the pressures at the end of a static run",
        ),
        |r| pressure::ellipse(r).map(|fit| fit.0),
    ),
    (
        d(
            "hertz_half_width",
            Unit::Length,
            "a of that ellipse",
            "Johnson 1985, § 4.2",
            "half-width of that ellipse",
        ),
        |r| pressure::ellipse(r).map(|fit| fit.1),
    ),
];

/// Metrics of the work.
pub const WORK: [(Definition, fn(&Run) -> Option<f64>); 6] = [
    (d("steps", Unit::None, "counter steps", OWN, "time steps of the grid done"), |r| count(r, "steps")),
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
            "factorisations of the linear systems, of the start and of projections included",
        ),
        |r| count(r, "factorisations"),
    ),
    (
        d(
            "cpu_time",
            Unit::Second,
            "timing cpu",
            OWN,
            "processor seconds of the thread that computed the steps, output excluded",
        ),
        |r| r.manifest.timings.get("cpu").copied(),
    ),
    (
        d(
            "wall_time",
            Unit::Second,
            "timing total",
            OWN,
            "wall seconds of all processes that computed the run, output included",
        ),
        |r| r.manifest.timings.get("total").copied(),
    ),
];

fn count(run: &Run, name: &str) -> Option<f64> {
    run.manifest.counters.get(name).map(|&n| n as f64)
}
