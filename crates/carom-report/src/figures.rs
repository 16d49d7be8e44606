//! The figures of a run, and the columns and files from which they are drawn.

use carom_formula::Formula;

use crate::chart::{Panel, Series};
use crate::figure::Figure;
use crate::histories::{HIGH, Histories, LOW, Line, tracks};
use crate::instants::instants;
use crate::noise::{force_size, largest};
use crate::ordered::{distinct, grouped};
use crate::palette::LINES;
use crate::recorded::Recorded;
use crate::scene::{Scene, scene};
use crate::{maps, setup, stopped};

/// Everything that can be drawn from a record.
#[derive(Default)]
pub(crate) struct Shown {
    pub(crate) figures: Vec<Figure>,
    pub(crate) scene: Option<Scene>,
    /// Notes on what could not be drawn.
    pub(crate) notes: Vec<String>,
}

/// Draws everything that the record of a run allows.
pub(crate) fn all(run: &Recorded) -> Shown {
    let mut shown = Shown::default();
    if run.times().is_empty() {
        shown.notes.push("The history has no rows yet; there is nothing to draw.".to_owned());
        return shown;
    }
    shown.scene = scene(run);
    shown.figures.extend(stopped::figure(run));
    shown.figures.extend(setup(run));
    shown.figures.extend(instants(run, &mut shown.notes));
    let histories = Histories::new(run);
    shown.figures.extend(probes(run, &histories));
    shown.figures.extend(reactions(run, &histories));
    shown.figures.extend(force(run, &histories));
    shown.figures.extend(maps::pressure(run));
    shown.figures.extend(maps::stick_slip(run));
    shown.figures.extend(shown.scene.as_ref().and_then(|scene| rotation(&histories, scene)));
    shown.figures.extend(energy(run, &histories));
    shown.figures.extend(others(run, &histories));
    shown.figures.extend(solver(run, &histories));
    shown
}

/// The initial configuration.
fn setup(run: &Recorded) -> Option<Figure> {
    let fields = run.field(run.fields.first()?).ok()?;
    let mut figure = setup::figure(run, &fields)?;
    "Set-up".clone_into(&mut figure.title);
    Some(figure)
}

fn probes(run: &Recorded, histories: &Histories) -> Option<Figure> {
    let columns: Vec<&str> = run.history.columns.iter().map(|column| column.name.as_str()).collect();
    let of_probe = |column: &&str| {
        column
            .rsplit_once('.')
            .is_some_and(|(name, _)| run.case.probes.iter().any(|probe| probe.name == name))
    };
    let columns: Vec<&str> = columns.into_iter().filter(of_probe).collect();
    let caption = format!(
        "Quantities at the probes.{}{} Data: `history.csv`, columns `PROBE.QUANTITY`.",
        histories.shaded(),
        histories.sources(&columns)
    );
    histories.figure("probes", "Probes", caption, histories.probes(), &[])
}

/// The forces of supports, of obstacles whose motion is prescribed and of ties, each in its panels.
fn reactions(run: &Recorded, histories: &Histories) -> Option<Figure> {
    let mut panels = Vec::new();
    let columns = run.history.columns.iter().map(|column| column.name.as_str());
    let stems = columns.filter_map(|name| {
        name.strip_suffix("_x").filter(|stem| stem.ends_with(".reaction") || stem.ends_with(".moment"))
    });
    for stem in distinct(stems) {
        let (name, what) = stem.rsplit_once('.').unwrap_or((stem, ""));
        let lines = Line::vector(run, stem, if what == "moment" { "M" } else { "R" });
        let most = lines.iter().filter_map(|line| run.column(&line.column)).flatten();
        let least = 1e-10 * largest(most);
        panels.extend(histories.vector(&format!("{what}, {name}"), HIGH, lines, least));
    }
    let ties = &run.case.ties;
    for tie in ties {
        let lines = Line::vector(run, &format!("{}.force", tie.name), "f");
        let most = lines.iter().filter_map(|line| run.column(&line.column)).flatten();
        let least = 1e-10 * largest(most);
        panels.extend(histories.vector(&format!("tie force, {}", tie.name), HIGH, lines, least));
    }
    let [of_ties, columns] = if ties.is_empty() {
        ["", ""]
    } else {
        [" Tie force: on the secondary side of a tie.", ", `TIE.force_…`"]
    };
    let caption = format!(
        "Forces of the supports, and of obstacles that are moved, on the bodies.{of_ties}{} Data: `history.csv`, columns `SUPPORT.reaction_…`{columns}.",
        histories.shaded()
    );
    let title = if ties.is_empty() { "Support reactions" } else { "Forces of supports and ties" };
    histories.figure("reactions", title, caption, panels, &[])
}

/// Contact forces, in all and by contact, and their impulse.
fn force(run: &Recorded, histories: &Histories) -> Option<Figure> {
    let size = 1e-9 * force_size(run).max(f64::MIN_POSITIVE);
    let mut panels = histories.vector("contact force", HIGH, Line::vector(run, "contact_force", "f"), size);
    for contact in &run.case.contacts {
        let lines = Line::vector(run, &format!("{}.force", contact.name), "f");
        panels.extend(histories.vector(&format!("force, {}", contact.name), LOW, lines, size));
    }
    let impulses = Line::vector(run, "contact_impulse", "P");
    let most = impulses.iter().filter_map(|line| run.column(&line.column)).flatten();
    let least = 1e-9 * largest(most).max(f64::MIN_POSITIVE);
    panels.extend(histories.vector("impulse", LOW, impulses, least));
    let shown = [
        "contact_force_x",
        "contact_force_y",
        "contact_force_z",
        "contact_impulse_x",
        "contact_impulse_y",
        "contact_impulse_z",
    ];
    let caption = format!(
        "Contact force on the secondary sides at the ends of the steps, and its impulse.{}{} Data: `history.csv`, \
         columns `contact_force_…`, `CONTACT.force_…`, `contact_impulse_…`.",
        histories.shaded(),
        histories.sources(&shown)
    );
    histories.figure("force", "Contact forces", caption, panels, &[])
}

/// The rotation of the bodies of the plane, where one turns by more than a little.
fn rotation(histories: &Histories, scene: &Scene) -> Option<Figure> {
    const LEAST: f64 = 5.0;
    let mut series = Vec::new();
    for (k, (body, degrees)) in scene.rotations.iter().enumerate() {
        // An angle goes on beyond half a turn.
        let mut y: Vec<f64> = Vec::new();
        for degree in degrees {
            let last = y.last().copied().unwrap_or(0.0);
            y.push(degree + 360.0 * ((last - degree) / 360.0).round());
        }
        if largest(&y) > LEAST {
            series.push(Series {
                label: body.clone(),
                color: LINES[k % LINES.len()],
                x: &scene.times,
                y,
                ..Series::default()
            });
        }
    }
    let panel = Panel { label: "rotation".to_owned(), unit: "°".to_owned(), height: HIGH, series };
    let caption = format!(
        "Rotation of the nodes of each body about their mean, by least squares.{} Data: field files.",
        histories.shaded()
    );
    histories.figure("rotation", "Rotation of the bodies", caption, vec![panel], &[])
}

/// Energies, and accumulated work and dissipation.
fn energy(run: &Recorded, histories: &Histories) -> Option<Figure> {
    const SHARE: f64 = 1e-6;
    let energies = ["total", "kinetic", "strain", "potential"].map(|name| Line::new(name, name));
    let works = ["dissipation", "external_work", "contact_work", "friction_work", "plastic_work"]
        .map(|name| Line::new(name, name.replace('_', " ")));
    let peak = |lines: &[Line]| {
        lines
            .iter()
            .filter_map(|line| run.column(&line.column))
            .flatten()
            .fold(0.0_f64, |most, x| if x.is_finite() { most.max(x.abs()) } else { most })
    };
    let size = peak(&energies);
    let panels = vec![
        histories.panel("energy", HIGH, &energies, SHARE * size),
        histories.panel("work", 150.0, &works, (SHARE * peak(&works)).max(1e-12 * size)),
    ];
    let columns: Vec<&str> = energies.iter().chain(&works).map(|line| line.column.as_str()).collect();
    let caption = format!(
        "Energies; accumulated work, and dissipation: all work less the change of the total energy. Curves below \
         10^{{-6}} of the largest are omitted.{}{} Data: `history.csv`.",
        histories.shaded(),
        histories.sources(&columns)
    );
    histories.figure("energy", "Energy", caption, panels, &[])
}

/// Columns that measured data or expectations concern and no other figure shows.
fn others(run: &Recorded, histories: &Histories) -> Option<Figure> {
    const MOST: usize = 8;
    const ROUND_OFF: f64 = 1e-12;
    let is_probe = |name: &str| run.case.probes.iter().any(|probe| probe.name == name);
    let is_shown = |column: &str| {
        let shown = ["contact_force", "contact_impulse"].iter().any(|stem| column.starts_with(stem))
            || [
                "time",
                "step",
                "active",
                "newton",
                "rejected",
                "total",
                "kinetic",
                "strain",
                "potential",
                "dissipation",
                "external_work",
                "contact_work",
                "friction_work",
                "plastic_work",
            ]
            .contains(&column);
        shown
            || column.rsplit_once('.').is_some_and(|(name, rest)| {
                is_probe(name)
                    || rest.starts_with("reaction")
                    || rest.starts_with("moment")
                    || rest.starts_with("force")
            })
    };
    let measured: Vec<String> =
        carom_record::metrics::overlays(run).into_iter().map(|data| data.column).collect();
    let asked = run.manifest.expectations.iter().flat_map(|e| columns_in(run, &e.what));
    let asked = asked.filter(|column| run.column(column).is_some_and(|values| largest(values) > ROUND_OFF));
    let mut columns = distinct(measured.iter().cloned().chain(asked).filter(|column| !is_shown(column)));
    columns.truncate(MOST);
    let stem = |column: &str| {
        let stem = column.strip_suffix(['x', 'y', 'z']).filter(|stem| stem.ends_with('_'));
        stem.map_or(column, |stem| stem.trim_end_matches('_')).to_owned()
    };
    let formulas: Vec<(String, Series)> =
        run.manifest.expectations.iter().filter_map(|e| formula(run, &e.what)).collect();
    let mut panels = Vec::new();
    for (name, members) in grouped(columns.iter().map(|column| (stem(column), column))) {
        let has_formula = |column: &String| formulas.iter().any(|(known, _)| known == column);
        let word = |column: &String| match members.len() {
            1 if has_formula(column) => "computed".to_owned(),
            1 => String::new(),
            _ => column.clone(),
        };
        let lines = members.iter().map(|column| Line::new(column.as_str(), word(column))).collect();
        let name = if members.len() == 1 { members[0].clone() } else { name };
        for mut panel in histories.vector(&name, 150.0, lines, 0.0) {
            // Of two panels for large and small components, one can be empty.
            if panel.series.is_empty() {
                continue;
            }
            for (_, series) in formulas.iter().filter(|(column, _)| members.contains(&column)) {
                let Series { color, x, .. } = *series;
                panel.series.push(Series {
                    label: series.label.clone(),
                    color,
                    x,
                    y: series.y.clone(),
                    ..Series::default()
                });
            }
            panels.push(panel);
        }
        panels.extend(members.iter().filter_map(|column| histories.differences(column)));
    }
    let all: Vec<&str> = columns.iter().map(String::as_str).collect();
    let caption = format!(
        "Columns with measured data or expected values.{} Data: `history.csv`.",
        histories.sources(&all)
    );
    histories.figure("columns", "Other columns", caption, panels, &[])
}

/// The names of columns in what an expectation asks for.
pub(crate) fn columns_in(run: &Recorded, what: &str) -> Vec<String> {
    let sum = what.split_once("− (").map_or(what, |(column, _)| column);
    let words = sum.split(|c: char| !(c.is_alphanumeric() || matches!(c, '_' | '.' | ':')));
    words.filter(|word| run.column(word).is_some()).map(str::to_owned).collect()
}

/// The column of an expectation, and the formula of t that it is compared with.
fn formula<'a>(run: &'a Recorded, what: &str) -> Option<(String, Series<'a>)> {
    let (column, text) = what.split_once(" − (")?;
    let column = column.rsplit_once('|')?.1;
    let formula = Formula::parse(text.rsplit_once(")|")?.0, &["t"]).ok()?;
    let y = run.times().iter().map(|t| formula.value(&[*t])).collect();
    Some((
        column.to_owned(),
        Series { label: "expected".to_owned(), color: LINES[2], x: run.times(), y, ..Series::default() },
    ))
}

/// Iterations, active nodes and rejections by step, with the events.
fn solver(run: &Recorded, histories: &Histories) -> Option<Figure> {
    let all = [("newton", "iterations"), ("active", "active nodes"), ("rejected", "rejected")];
    let occurs = |name: &str| run.column(name).is_some_and(|column| column.iter().any(|x| *x > 0.0));
    let shown = all.into_iter().filter(|(name, _)| occurs(name));
    let panels =
        shown.map(|(name, label)| histories.panel(label, 84.0, &[Line::new(name, "")], 0.0)).collect();
    let caption = "Iterations per step, contact nodes, rejected attempts; ticks: events. Data: `history.csv`, `log.jsonl`.";
    histories.figure("solver", "Solver", caption.to_owned(), panels, &tracks(run))
}
