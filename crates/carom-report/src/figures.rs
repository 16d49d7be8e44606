//! The figures of a run, and the columns and files from which they are drawn.

use carom_record::Run;

use crate::animation::Animation;
use crate::energy::{ENERGIES, WORKS};
use crate::figure::Figure;
use crate::instants::instants;
use crate::labels::{capitalised, listed, symbol, words};
use crate::measured::{Points, add_points, differences, sources};
use crate::ordered::grouped;
use crate::over_time::{by_size, chart, curves, of_probes, panel, shaded, shades};
use crate::recorded::Recorded;
use crate::values::is_in_space;
use crate::{animation, energy, noise, pressure, setup, space, stick_slip, stopped, unshown};

/// Everything that can be drawn from a record.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shown {
    pub(crate) figures: Vec<Figure>,
    pub(crate) animation: Option<Animation>,
    /// Notes on what could not be drawn.
    pub(crate) notes: Vec<String>,
}

/// Draws everything that the record of a run allows.
pub(crate) fn all(run: &Run) -> Shown {
    let mut shown = Shown::default();
    if run.times().is_empty() {
        shown.notes.push("The history has no rows yet; there is nothing to draw.".to_string());
        return shown;
    }
    shown.figures.extend(stopped::figure(run));
    shown.figures.extend(setup(run));
    let place = shown.figures.len() + 1;
    if let Some((bodies, bands)) = instants(run, &mut shown.notes) {
        shown.figures.push(bodies);
        let is_solid = run.manifest.facts.dimension == 3;
        let section = if is_solid { space::section } else { animation::section };
        shown.animation = section(run, &bands, shades(run), place);
    }
    let lists = [&FORCES[..], &IMPULSES, &ENERGIES, &WORKS];
    let others = [
        probes(run),
        force(run),
        pressure::figure(run),
        stick_slip::figure(run),
        energy::figure(run),
        unshown::measured(run, &lists),
        unshown::expected(run, &lists),
        solver(run),
    ];
    shown.figures.extend(others.into_iter().flatten());
    shown
}

/// The initial configuration.
fn setup(run: &Run) -> Option<Figure> {
    let fields = run.field(run.fields.first()?).ok()?;
    setup::figure(&Recorded::new(run.clone()).ok()?, &fields)
}

/// Time histories of all probes, one panel per quantity.
fn probes(run: &Run) -> Option<Figure> {
    let points = Points::all(run);
    let shown = of_probes(run);
    let columns: Vec<&str> = shown.iter().map(|(_, (column, _))| column.name.as_str()).collect();
    let quantities = grouped(shown);
    // No axis of the plane is horizontal or vertical in space.
    let solid = is_in_space(&run.manifest.case);
    let words = |q: &str| {
        let words = words(q);
        let plain = words.strip_prefix("horizontal ").or(words.strip_prefix("vertical ")).filter(|_| solid);
        plain.map_or(words.clone(), str::to_owned)
    };
    let mut list: Vec<String> =
        quantities.iter().map(|(q, _)| format!("{} {}", words(q), symbol(q))).collect();
    list.dedup();
    let caption = format!(
        "Time histories at the probes: {}.{}{} Data: `history.csv`, {}.",
        listed(&list),
        shaded(run),
        sources(run, &points, &columns),
        coded(&columns)
    );
    let mut drawn = Vec::new();
    for (quantity, members) in quantities {
        let (symbol, unit) = (symbol(quantity), &members[0].0.unit);
        let names: Vec<&str> = members.iter().map(|(column, _)| column.name.as_str()).collect();
        let mut series = Vec::new();
        for (column, curve) in members {
            series.push(curve);
            add_points(&points, &column.name, &mut series);
        }
        drawn.push(panel(&symbol, unit, 190.0, series));
        drawn.extend(names.into_iter().filter_map(|name| differences(run, &points, name, &symbol)));
    }
    chart(run, ("probes", "Time histories at the probes"), caption, drawn)
}

/// ``columns `a`, `b` ``.
fn coded(columns: &[&str]) -> String {
    format!("{} `{}`", if columns.len() == 1 { "column" } else { "columns" }, columns.join("`, `"))
}

/// Columns of figures, with their labels.
const FORCES: [(&str, &str); 3] =
    [("contact_force_x", "f_{x}"), ("contact_force_y", "f_{y}"), ("contact_force_z", "f_{z}")];
const IMPULSES: [(&str, &str); 3] =
    [("contact_impulse_x", "P_{x}"), ("contact_impulse_y", "P_{y}"), ("contact_impulse_z", "P_{z}")];
/// Contact force and impulse against time.
fn force(run: &Run) -> Option<Figure> {
    let h = &run.history;
    let size = noise::force_size(run).max(f64::MIN_POSITIVE);
    let largest = noise::largest(IMPULSES.iter().filter_map(|(c, _)| run.column(c)).flatten());
    let largest = largest.max(f64::MIN_POSITIVE);
    let points = Points::all(run);
    let (forces, impulses) = (curves(run, &points, &FORCES, size), curves(run, &points, &IMPULSES, largest));
    let panels = [
        panel("contact force f", h.unit("contact_force_x"), 200.0, forces),
        panel("impulse P", h.unit("contact_impulse_x"), 130.0, impulses),
    ];
    let panels = panels.into_iter().flat_map(by_size).collect();
    let shown: Vec<&str> = FORCES.iter().chain(&IMPULSES).map(|(name, _)| *name).collect();
    let caption = format!(
        "Contact force on the secondary side at the end of each step, and its accumulated impulse, which also has \
         the forces within a step.{} Single peaks of the force depend on the time step far more than the impulse \
         does.{} Data: `history.csv`, columns `contact_force_…` and `contact_impulse_…`.",
        shaded(run),
        sources(run, &points, &shown)
    );
    chart(run, ("force", "Contact force and impulse"), caption, panels)
}

/// Iterations, active nodes and rejections by step.
fn solver(run: &Run) -> Option<Figure> {
    let one = |name: &str, label: &str| panel(label, "", 84.0, curves(run, &[], &[(name, "")], 0.0));
    let occurs = |name: &str| run.column(name).is_some_and(|c| c.iter().any(|&x| x > 0.0));
    // A scheme without a linear system counts the evaluations of its forces.
    let is_explicit =
        run.manifest.case.pointer("/time/scheme/kind").is_some_and(|kind| kind == "central-difference");
    let iterations = if is_explicit { "iterations of the contact forces" } else { "Newton iterations" };
    let all = [
        ("newton", "iterations", iterations),
        ("active", "active nodes", "active contact nodes"),
        ("rejected", "rejected", "rejected attempts"),
    ];
    let shown: Vec<_> = all.into_iter().filter(|(name, ..)| occurs(name)).collect();
    let panels = shown.iter().map(|(name, label, _)| one(name, label)).collect();
    let words: Vec<&str> = shown.iter().map(|(_, _, words)| *words).collect();
    let names: Vec<&str> = shown.iter().map(|(name, ..)| *name).collect();
    // The column has the rejections of steps that were accepted in the end.
    let rejected = run.log.iter().filter(|event| event.kind == "rejected").count();
    let none = match rejected {
        _ if occurs("rejected") => String::new(),
        0 => " No step was rejected.".to_owned(),
        1 => " One attempt of the last step was rejected.".to_owned(),
        n => format!(" {n} attempts of the last step were rejected."),
    };
    let [ticks, log] =
        if run.log.is_empty() { [""; 2] } else { [" Ticks: events by kind.", "; `log.jsonl`"] };
    let caption = format!(
        "{} per step.{none}{}{ticks} Data: `history.csv`, {}{log}.",
        capitalised(&listed(&words)),
        shaded(run),
        coded(&names)
    );
    chart(run, ("solver", "Solver"), caption, panels)
}
