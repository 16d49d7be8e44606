//! The figures of a run, and the columns and files from which they are drawn.

use carom_case::ObstacleMotion;
use carom_formula::Formula;

use crate::chart::{Panel, Series};
use crate::figure::Figure;
use crate::histories::{HIGH, Histories, LOW, Line, tracks};
use crate::instants::instants;
use crate::labels::capitalised;
use crate::noise::{force_size, largest};
use crate::ordered::{distinct, grouped};
use crate::palette::LINES;
use crate::recorded::Recorded;
use crate::scene::{Scene, scene};
use crate::text::said_if;
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
        "Quantities at the probes.{}{}{} Data: `history.csv`, columns `PROBE.QUANTITY`.",
        histories.shaded(),
        if columns.iter().any(|column| column.contains(".sigma_") || column.ends_with(".von_mises")) {
            run.projected()
        } else {
            ""
        },
        histories.sources(&columns)
    );
    histories.figure("probes", "Probes", caption, histories.probes(), &[])
}

/// The forces of supports, of obstacles whose motion is prescribed and of ties, each in its panels.
fn reactions(run: &Recorded, histories: &Histories) -> Option<Figure> {
    let mut panels = Vec::new();
    let columns = run.history.columns.iter().map(|column| column.name.as_str());
    // A moment in the plane has one component, without an axis in its name.
    let stems = columns
        .map(|name| name.strip_suffix("_x").unwrap_or(name))
        .filter(|stem| stem.ends_with(".reaction") || stem.ends_with(".moment"));
    for stem in distinct(stems) {
        let (name, what) = stem.rsplit_once('.').unwrap_or((stem, ""));
        let lines = Line::vector_of(run, stem, if what == "moment" { "M" } else { "R" }, name);
        let most = lines.iter().filter_map(|line| run.column(&line.column)).flatten();
        let least = 1e-10 * largest(most);
        panels.extend(histories.vector(what, HIGH, lines, least));
    }
    let ties = &run.case.ties;
    let of_supports = panels.iter().any(|panel: &Panel| !panel.series.is_empty());
    for tie in ties {
        let lines = Line::vector_of(run, &format!("{}.force", tie.name), "f", &tie.name);
        let most = lines.iter().filter_map(|line| run.column(&line.column)).flatten();
        let least = 1e-10 * largest(most);
        panels.extend(histories.vector("tie force", HIGH, lines, least));
    }
    let is_moved = |motion: &ObstacleMotion| matches!(motion, ObstacleMotion::Prescribed { .. });
    let of_obstacles = run.case.contacts.iter().any(|contact| is_moved(&contact.motion));
    let named = run.case.supports.iter().any(|support| support.name.is_some());
    let (words, columns): (Vec<&str>, Vec<&str>) = [
        (
            of_supports && named && of_obstacles,
            "Forces of the supports, and of obstacles that are moved, on the bodies.",
            "`SUPPORT.reaction_…`, `CONTACT.reaction_…`",
        ),
        (
            of_supports && named && !of_obstacles,
            "Forces of the supports on the bodies.",
            "`SUPPORT.reaction_…`",
        ),
        (of_supports && !named, "Forces of obstacles that are moved on the bodies.", "`CONTACT.reaction_…`"),
        (!ties.is_empty(), "Tie force: on the secondary side of a tie.", "`TIE.force_…`"),
    ]
    .into_iter()
    .filter(|(is_drawn, ..)| *is_drawn)
    .map(|(_, words, columns)| (words, columns))
    .unzip();
    let caption = format!(
        "{}{} Data: `history.csv`, columns {}.",
        words.join(" "),
        histories.shaded(),
        columns.join(", ")
    );
    let title = if ties.is_empty() { "Support reactions" } else { "Forces of supports and ties" };
    histories.figure("reactions", title, caption, panels, &[])
}

/// Contact forces, in all and by contact, and their impulse.
fn force(run: &Recorded, histories: &Histories) -> Option<Figure> {
    let size = 1e-9 * force_size(run).max(f64::MIN_POSITIVE);
    let mut panels = histories.vector("contact force", HIGH, Line::vector(run, "contact_force", "f"), size);
    let is_drawn = |panels: &[Panel]| panels.iter().any(|panel| !panel.series.is_empty());
    let mut by_contact = Vec::new();
    for contact in &run.case.contacts {
        let lines = Line::vector_of(run, &format!("{}.force", contact.name), "f", &contact.name);
        by_contact.extend(histories.vector("force", LOW, lines, size));
    }
    let has_several = is_drawn(&by_contact);
    panels.extend(by_contact);
    let impulses = Line::vector(run, "contact_impulse", "P");
    let most = impulses.iter().filter_map(|line| run.column(&line.column)).flatten();
    let least = 1e-9 * largest(most).max(f64::MIN_POSITIVE);
    // In load steps a sum over the load parameter has no meaning.
    let impulses = if run.is_static() { Vec::new() } else { impulses };
    let of_impulse = histories.vector("impulse", LOW, impulses, least);
    let has_impulse = is_drawn(&of_impulse);
    panels.extend(of_impulse);
    let shown = [
        "contact_force_x",
        "contact_force_y",
        "contact_force_z",
        "contact_impulse_x",
        "contact_impulse_y",
        "contact_impulse_z",
    ];
    let caption = format!(
        "Contact force on the secondary sides at the ends of the steps{}{}.{}{} Data: `history.csv`, columns \
         `contact_force_…`{}{}.",
        said_if(has_several, ", their sum, which need not act on one body, and by contact"),
        said_if(has_impulse, ", and its impulse"),
        histories.shaded(),
        histories.sources(&shown),
        said_if(has_several, ", `CONTACT.force_…`"),
        said_if(has_impulse, ", `contact_impulse_…`")
    );
    histories.figure("force", "Contact forces", caption, panels, &[])
}

/// The rotation of the bodies of the plane, where one turns by more than a little.
fn rotation(histories: &Histories, scene: &Scene) -> Option<Figure> {
    const LEAST: f64 = 5.0;
    let mut series = Vec::new();
    for (k, (body, degrees)) in scene.rotations.iter().enumerate() {
        if largest(degrees) > LEAST {
            series.push(Series {
                label: body.clone(),
                color: LINES[k % LINES.len()],
                x: &scene.times,
                y: degrees.clone(),
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
    // Load steps have no balance of energy.
    let works = ["dissipation", "external_work", "contact_work", "friction_work", "plastic_work"];
    let works = works.into_iter().filter(|name| !(run.is_static() && *name == "dissipation"));
    let works: Vec<Line> = works.map(|name| Line::new(name, name.replace('_', " "))).collect();
    let peak = |lines: &[Line]| {
        lines
            .iter()
            .filter_map(|line| run.column(&line.column))
            .flatten()
            .fold(0.0_f64, |most, x| if x.is_finite() { most.max(x.abs()) } else { most })
    };
    let size = peak(&energies);
    let of_energy = histories.panel("energy", HIGH, &energies, SHARE * size);
    let of_work = histories.panel("work", 150.0, &works, (SHARE * peak(&works)).max(1e-12 * size));
    let has_dissipation = of_work.series.iter().any(|series| series.label == "dissipation");
    let has_work = of_work.series.len() > usize::from(has_dissipation);
    let panels = vec![of_energy, of_work];
    let columns: Vec<&str> = energies.iter().chain(&works).map(|line| line.column.as_str()).collect();
    let caption = format!(
        "Energies{}{}. Curves below 10^{{-6}} of the largest are omitted.{}{} Data: `history.csv`.",
        said_if(has_work, "; accumulated work"),
        said_if(has_dissipation, "; dissipation: all work less the change of the total energy"),
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
fn columns_in(run: &Recorded, what: &str) -> Vec<String> {
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
    let all = [
        ("newton", "iterations", "iterations per step"),
        ("active", "active nodes", "contact nodes"),
        ("rejected", "rejected", "rejected attempts"),
    ];
    let occurs = |name: &str| run.column(name).is_some_and(|column| column.iter().any(|x| *x > 0.0));
    let shown: Vec<_> = all.into_iter().filter(|(name, ..)| occurs(name)).collect();
    let panels =
        shown.iter().map(|(name, label, _)| histories.panel(label, 84.0, &[Line::new(*name, "")], 0.0));
    let tracks = tracks(run);
    let mut words: Vec<&str> = shown.iter().map(|(.., words)| *words).collect();
    words.extend((!tracks.is_empty()).then_some("ticks: events"));
    let log = said_if(!tracks.is_empty(), ", `log.jsonl`");
    let caption = format!("{}. Data: `history.csv`{log}.", capitalised(&words.join("; ")));
    histories.figure("solver", "Solver", caption, panels.collect(), &tracks)
}
