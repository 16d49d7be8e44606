//! The table of named metrics of a history: name, unit, formula, source and meaning of each, next
//! to the function that computes it. Reports, studies, the book and expectations all use this table
//! and that of whole runs (`run_table.rs`).

use super::column::{column_roughness, peak_of_means};
use super::definition::{Definition, OWN, TABLES, VARIATION, d};
use super::samples::{extreme, peak_mean, roughness};
use super::striker::apex;
use super::{force, ledger, oscillation};
use crate::units::Unit;

/// Metrics of a history.
pub const HISTORY: [Definition; 29] = [
    d(
        "contact_start",
        Unit::Time,
        "t_a, a the first row in contact",
        TABLES,
        "first recorded time in contact",
        |f| Some(f.time(f.first()?.start)),
    ),
    d(
        "contact_end",
        Unit::Time,
        "t_b, b the first row after the episode",
        TABLES,
        "first recorded time without contact after the first episode",
        |f| Some(f.time(f.first()?.end?)),
    ),
    d("contact_duration", Unit::Time, "t_b − t_a", TABLES, "duration of the first episode", |f| {
        f.duration()
    }),
    d(
        "contact_episodes",
        Unit::None,
        "spans of rows in contact, interruptions < 0.02 (t_last − t_0) included",
        OWN,
        "number of contact episodes; interruptions shorter than 2 % of the recorded time are ignored",
        |f| f.history.column("active").map(|_| f.episodes.len() as f64),
    ),
    d(
        "impulse_x",
        Unit::Impulse,
        "P_x(t_b) − P_x(t_{a−1})",
        TABLES,
        "x component of the contact impulse of the first episode, on the secondary side; not available for contacts that do not count as one",
        |f| f.impulse(0),
    ),
    d(
        "impulse_y",
        Unit::Impulse,
        "P_y(t_b) − P_y(t_{a−1})",
        TABLES,
        "y component of the contact impulse of the first episode, on the secondary side; not available for contacts that do not count as one",
        |f| f.impulse(1),
    ),
    d(
        "impulse_z",
        Unit::Impulse,
        "P_z(t_b) − P_z(t_{a−1})",
        OWN,
        "z component of the contact impulse of the first episode, on the secondary side; not available for contacts that do not count as one",
        |f| f.impulse(2),
    ),
    d(
        "peak_force",
        Unit::Force,
        "max |F|",
        TABLES,
        "largest contact force at the end of any recorded step, of contacts that do not count as one the largest (does not converge with the time step)",
        |f| extreme(&f.force(), f64::gt).map(|x| x.1),
    ),
    d(
        "peak_mean_force",
        Unit::Force,
        "max_t |P(t + w) − P(t)|/w, w = (t_b − t_a)/16",
        OWN,
        "largest contact force averaged over a window of 1/16 of the first episode, from the impulse; not available for contacts that do not count as one; with about one step per window it may exceed peak_force",
        |f| peak_mean(f.history.times(), &f.impulses()?, f.window()?),
    ),
    d(
        "force_roughness",
        Unit::None,
        "TV(|F|)/(2 max |F| − |F|_{a−1} − |F|_b) − 1, TV = Σ |x_{n+1} − x_n|",
        VARIATION,
        "total variation of the contact force in the first episode, divided by that of one rise and fall, minus 1",
        |f| roughness(f.force_of_first()?.get(f.rows()?)?),
    ),
    d(
        "force_high_frequency",
        Unit::None,
        "1 − Σ_{|k| ≤ 16} |F_k|²/(N Σ F_n²), F_k the discrete Fourier transform over the episode",
        "Parseval's identity",
        "fraction of the power of the contact force above 16 cycles per first episode",
        force::high,
    ),
    d(
        "chatter",
        Unit::PerTime,
        "Σ (activations + releases) / Σ (t_b − t_a)",
        OWN,
        "activations and releases of contact nodes, the first activations included, divided by the time in contact",
        force::chatter,
    ),
    d(
        "apex",
        Unit::Length,
        "vertex of the parabola through the highest row and its neighbours, − y_0",
        OWN,
        "largest height of the striker's centre above its initial position, along the last axis (y in the plane, z in space, x in one dimension), after its first contact",
        |f| apex(f).map(|a| a.1),
    ),
    d("apex_time", Unit::Time, "time of that vertex", OWN, "time of the apex", |f| apex(f).map(|a| a.0)),
    d(
        "energy_lost",
        Unit::None,
        "−ΔE_last/E*, ΔE = total − total_0 − external_work, E* = max (kinetic + strain)",
        "Krenk 2006",
        "energy lost by the end, divided by the largest kinetic + strain energy; negative if created; above 1 where supports or obstacles supply what is lost",
        ledger::lost,
    ),
    d(
        "energy_created",
        Unit::None,
        "max_t [E(t) − E(s) − m⁺] / max(E*, Σ |ΔW|), E = total − external_work, at its minimum before t at s; m = work ahead of the velocities from s to t (theory/energy.md)",
        "Krenk 2006",
        "largest rise of the energy (total − work of loads, supports and obstacles) above its lowest value before, less what velocities of the α family are ahead of the work while forces change; divided by the largest kinetic + strain energy or, if larger, the sum of all |work|",
        ledger::created,
    ),
    d(
        "energy_drift",
        Unit::None,
        "max |ΔE|/E*",
        "Krenk 2006",
        "largest change of energy, up or down, at any time, divided by the largest kinetic + strain energy",
        ledger::drift,
    ),
    d(
        "energy_error",
        Unit::None,
        "max |dissipation − contact_work|/E*",
        OWN,
        "largest energy that time integrator and contact dissipated or created up to any time, divided by the largest kinetic + strain energy; friction and loads do not count",
        ledger::by_scheme,
    ),
    d(
        "energy_lost_impact",
        Unit::None,
        "the ΔE(t_{a−1}) − ΔE(t_b) of largest absolute value, over E*",
        OWN,
        "energy lost in the impact that changes the energy most, divided by the largest kinetic + strain energy; energy_lost:N is that of the N-th impact",
        ledger::at_worst_impact,
    ),
    d(
        "friction_lost",
        Unit::None,
        "−W_f,last/E*",
        OWN,
        "energy lost in friction by the end, divided by the largest kinetic + strain energy; above 1 where supports or obstacles supply it",
        ledger::by_friction,
    ),
    d(
        "plastic_lost",
        Unit::None,
        "−W_p,last/E*",
        OWN,
        "energy dissipated by plastic flow by the end, divided by the largest kinetic + strain energy",
        ledger::by_flow,
    ),
    d(
        "permanent_set",
        Unit::None,
        "max BODY.plastic_strain_last",
        OWN,
        "largest accumulated equivalent plastic strain at the end, over the quadrature points of all bodies",
        ledger::permanent_set,
    ),
    d(
        "slip_distance",
        Unit::Length,
        "max |Σ S| over pairs and steps",
        OWN,
        "largest slip of a contact node since it closed",
        |f| f.last("slip"),
    ),
    d(
        "stick_share",
        Unit::None,
        "Σ t_stick/Σ t_closed over pairs",
        OWN,
        "share of the time in contact in which nodes stick; each node counts by its own time",
        |f| Some(f.last("stick_time")? / f.last("rub_time").filter(|&time| time > 0.0)?),
    ),
    d(
        "dissipated_integrator",
        Unit::None,
        "dissipation_last/E*",
        "Krenk 2006",
        "energy dissipated by the time integrator by the end, divided by the largest kinetic + strain energy; negative if created, or if the work of a force that varies within steps is inexact",
        ledger::by_integrator,
    ),
    d(
        "dissipated_contact",
        Unit::None,
        "−contact_work_last/E*",
        "Krenk 2006",
        "energy removed by contact forces and projections by the end, divided by the largest kinetic + strain energy; negative if contact creates energy; work of obstacles that move is not among it",
        ledger::by_contact,
    ),
    d(
        "penetration",
        Unit::Length,
        "max (0, −g)",
        TABLES,
        "depth of the deepest node of either side of a contact in the other body, in space also of points of its sharp edges (not where a body meets itself), constrained by the contact or not (column penetration_secondary: constrained nodes); smooth nodes of the primary side, which contact lets in by a fiftieth of a facet, included",
        |f| extreme(f.history.column("penetration")?, f64::gt).map(|x| x.1),
    ),
    d(
        "penetration_secondary",
        Unit::Length,
        "max (0, −g)",
        TABLES,
        "depth of the deepest node that a contact constrains",
        |f| extreme(f.history.column("penetration_secondary")?, f64::gt).map(|x| x.1),
    ),
    d(
        "penetration_mean",
        Unit::Length,
        "mean of max (0, −g) over the rows with active > 0",
        OWN,
        "depth of the deepest node of either side of a contact in the other body, as in the column penetration, averaged over the rows in contact",
        force::mean_penetration,
    ),
];

/// Metrics of the column `C` of a probe, named `C:min` etc.
pub const COLUMNS: [Definition; 5] = [
    d("min", Unit::Column, "min c", OWN, "smallest recorded value of the column", |f| {
        Some(extreme(f.values()?, f64::lt)?.1)
    }),
    d("max", Unit::Column, "max c", OWN, "largest recorded value of the column", |f| {
        Some(extreme(f.values()?, f64::gt)?.1)
    }),
    d(
        "roughness",
        Unit::None,
        "TV(c)/(2 (max c − min c)) − 1",
        VARIATION,
        "total variation divided by twice the range, minus 1, in the first contact episode; 0 for a single hump",
        column_roughness,
    ),
    d(
        "peak_mean",
        Unit::Column,
        "max_t |∫ c dt|/w from t to t + w, w = (t_b − t_a)/16",
        OWN,
        "largest absolute mean of the column over a window of 1/16 of the first contact episode",
        peak_of_means,
    ),
    d(
        "high_frequency",
        Unit::None,
        "1 − Σ_{|k| ≤ 16} |C_k|²/(N Σ c_n²)",
        "Parseval's identity",
        "fraction of the power of the column above 16 cycles per first contact episode",
        |f| force::high_frequency(f.values()?.get(f.rows_in_contact()?)?),
    ),
];

/// Metrics of a column that oscillates freely, named like those of [`COLUMNS`]; not defined for
/// other columns.
pub(super) const FREE: [Definition; 2] = [
    d(
        "damping_ratio",
        Unit::None,
        "−ln|z|/arg z, z of c_{n+1} = 2 Re z c_n − |z|² c_{n−1} by least squares over the second half",
        "Prony 1795",
        "damping ratio of a column that oscillates freely about zero",
        oscillation::damping_ratio,
    ),
    d(
        "period",
        Unit::Time,
        "2π Δt/arg z, z as for damping_ratio",
        "Prony 1795",
        "period of a column that oscillates freely about zero",
        oscillation::period,
    ),
];
