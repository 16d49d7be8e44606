//! Which figures a run has, and from which columns and files they are made.

use carom_record::{Cell, FieldEntry, Run, metrics};

use crate::bodies::{self, Instant};
use crate::chart::{Chart, Panel, Series};
use crate::labels::{symbol, with_unit, words};
use crate::palette::{LINES, sequence};

/// A figure of a report.
#[derive(Clone, Debug)]
pub struct Figure {
    /// File name without its ending.
    pub name: &'static str,
    /// Caption, in the markup of labels: `σ_{yy}`.
    pub caption: String,
    /// The picture.
    pub svg: String,
}

/// All figures a record allows, and what could not be drawn.
pub(crate) fn all(run: &Run) -> (Vec<Figure>, Vec<String>) {
    let mut notes = Vec::new();
    if run.times().is_empty() {
        notes.push("The history has no rows yet: nothing to draw.".to_string());
        return (Vec::new(), notes);
    }
    let bodies = instants(run, &mut notes);
    let charts = [probes(run), force(run), energy(run), solver(run)];
    (bodies.into_iter().chain(charts.into_iter().flatten()).collect(), notes)
}

/// Contact intervals to shade.
fn shades(run: &Run) -> Vec<(f64, f64)> {
    let t = run.times();
    let end = |e: &metrics::Episode| e.end.map_or(t[t.len() - 1], |i| t[i]);
    metrics::episodes(&run.history, 0.0).iter().map(|e| (t[e.start], end(e))).collect()
}

fn chart<'a>(run: &Run, title: &'a str, panels: Vec<Panel<'a>>) -> Option<String> {
    let panels: Vec<Panel> = panels.into_iter().filter(|p| !p.series.is_empty()).collect();
    let x_label = with_unit("time t", run.history.unit("time"));
    (!panels.is_empty()).then(|| Chart { title, x_label, shades: shades(run), panels }.svg())
}

/// Curves of columns with their labels; those without a column, or zero throughout compared with `size`, are left out.
fn curves<'a>(run: &'a Run, columns: &[(&str, &str)], size: f64) -> Vec<Series<'a>> {
    let found = columns.iter().enumerate().filter_map(|(i, (name, label))| {
        let y = run.column(name)?;
        let shown = size == 0.0 || y.iter().any(|y| y.abs() > 1e-9 * size);
        let series =
            |y: &[f64]| Series { label: (*label).into(), color: LINES[i % LINES.len()], x: run.times(), y: y.to_vec() };
        shown.then(|| series(y))
    });
    found.collect()
}

fn panel<'a>(label: &str, unit: &str, height: f64, series: Vec<Series<'a>>) -> Panel<'a> {
    Panel { label: label.into(), unit: unit.into(), height, series }
}

/// Names in an array of the resolved case.
fn names<'a>(run: &'a Run, list: &str) -> Vec<&'a str> {
    let items = run.manifest.case.get(list).and_then(|v| v.as_array());
    items.into_iter().flatten().filter_map(|item| item.get("name")?.as_str()).collect()
}

/// Every quantity of every probe against time, one panel per quantity.
fn probes(run: &Run) -> Option<Figure> {
    let probes = names(run, "probes");
    let mut panels: Vec<(String, Panel)> = Vec::new();
    for column in &run.history.columns {
        let Some((probe, quantity)) = column.name.rsplit_once('.').filter(|(p, _)| probes.contains(p)) else {
            continue;
        };
        let Some(values) = run.column(&column.name) else { continue };
        let at = panels.iter().position(|(q, _)| q == quantity).unwrap_or_else(|| {
            panels.push((quantity.to_string(), panel(&symbol(quantity), &column.unit, 190.0, Vec::new())));
            panels.len() - 1
        });
        let color = LINES[probes.iter().position(|p| *p == probe).unwrap_or(0) % LINES.len()];
        let label = format!("{} at {probe}", symbol(quantity));
        panels[at].1.series.push(Series { label, color, x: run.times(), y: values.to_vec() });
    }
    let mut list: Vec<String> = panels.iter().map(|(q, _)| format!("{} {}", words(q), symbol(q))).collect();
    list.dedup();
    let svg = chart(run, "Probes against time", panels.into_iter().map(|(_, p)| p).collect())?;
    let caption = format!("Probes against time: {}. Shaded: contact.", list.join(", "));
    Some(Figure { name: "probes", caption, svg })
}

/// Contact force and impulse against time.
fn force(run: &Run) -> Option<Figure> {
    let h = &run.history;
    let size = metrics::contact_force(h).into_iter().fold(f64::MIN_POSITIVE, f64::max);
    let impulse = ["contact_impulse_x", "contact_impulse_y"].iter().filter_map(|c| run.column(c)).flatten();
    let largest = impulse.fold(f64::MIN_POSITIVE, |m: f64, x| m.max(x.abs()));
    let forces = curves(run, &[("contact_force_x", "f_{x}"), ("contact_force_y", "f_{y}")], size);
    let impulses = curves(run, &[("contact_impulse_x", "P_{x}"), ("contact_impulse_y", "P_{y}")], largest);
    let panels = vec![
        panel("contact force f", h.unit("contact_force_x"), 200.0, forces),
        panel("impulse P", h.unit("contact_impulse_x"), 130.0, impulses),
    ];
    let caption = "Contact force on the secondary side at the end of each step, and its impulse so far. Shaded: contact. \
                   Single peaks of the force depend on the time step; impulse, duration and restitution do not.";
    Some(Figure { name: "force", caption: caption.into(), svg: chart(run, "Contact force and impulse", panels)? })
}

/// The energy ledger.
fn energy(run: &Run) -> Option<Figure> {
    let unit = run.history.unit("total");
    let energies = [("total", "total"), ("kinetic", "kinetic"), ("strain", "strain"), ("potential", "potential")];
    let works = [("dissipation", "dissipation"), ("external_work", "external work"), ("contact_work", "contact work")];
    let panels = vec![
        panel("energy", unit, 200.0, curves(run, &energies, 0.0)),
        panel("work, dissipation", unit, 150.0, curves(run, &works, 0.0)),
    ];
    let caption = "Energy ledger: energies above, work done so far and dissipation below. \
                   Dissipation = external work + contact work − change of the total; where it is negative, energy was created.";
    Some(Figure { name: "energy", caption: caption.into(), svg: chart(run, "Energy ledger", panels)? })
}

/// What the solver did.
fn solver(run: &Run) -> Option<Figure> {
    let one = |name: &str, label: &str| panel(label, "", 84.0, curves(run, &[(name, "")], 0.0));
    let mut panels = vec![one("newton", "iterations"), one("active", "active nodes")];
    if run.column("rejected").is_some_and(|c| c.iter().any(|&x| x > 0.0)) {
        panels.push(one("rejected", "rejected"));
    }
    let quiet = if panels.len() == 2 { " No step was rejected." } else { "" };
    let caption =
        format!("Newton iterations and active contact nodes of each step, and attempts rejected in it.{quiet}");
    Some(Figure { name: "solver", caption, svg: chart(run, "Solver", panels)? })
}

/// Field files nearest to five instants spread evenly over the first contact (or the run, without contact).
fn five(run: &Run) -> (Vec<&FieldEntry>, bool) {
    let t = run.times();
    let contact = metrics::first_episode(&run.history).map(|e| (t[e.start], t[e.end.unwrap_or(t.len()) - 1]));
    let span = |(a, b): (f64, f64)| {
        let near = |k: i32| {
            let at = a + (b - a) * f64::from(k) / 4.0;
            run.fields.iter().min_by(|p, q| (p.time - at).abs().total_cmp(&(q.time - at).abs()))
        };
        let mut list: Vec<&FieldEntry> = (0..5).filter_map(near).collect();
        list.dedup();
        list
    };
    match contact {
        Some(contact) => (span(contact), true),
        None => (span((t[0], t[t.len() - 1])), false),
    }
}

fn instants(run: &Run, notes: &mut Vec<String>) -> Option<Figure> {
    let (entries, contact) = five(run);
    if entries.is_empty() {
        notes.push("No field files were written (output.fields_every = 0): no picture of the bodies.".into());
    }
    let mut sets = Vec::new();
    for entry in entries {
        match run.field(entry) {
            Ok(set) => sets.push((entry.time, set)),
            Err(error) => notes.push(error.to_string()),
        }
    }
    let first = &sets.first()?.1;
    let during = if contact { "of the first contact" } else { "of the run, which had no contact" };
    let unit = run.history.unit("time");
    if first.blocks.iter().all(|b| b.cell == Cell::Curve) {
        return bars(run, &sets, during);
    }
    let stress = first.array("stress")?.unit.clone();
    let length = first.array("displacement").map(|a| a.unit.clone()).unwrap_or_default();
    let instant = |(time, set): &_| Instant::new(set, "stress", 1, format!("t = {time:.4} {unit}"));
    let list: Vec<Instant> = sets.iter().filter_map(instant).collect();
    let (svg, cut) = bodies::figure(&list, "Deformed bodies with vertical Cauchy stress", "σ_{yy}", &stress, &length);
    let arrow =
        if cut { " Arrows at the colour bar: the outermost half per cent of the values lies beyond." } else { "" };
    let caption = format!(
        "Deformed bodies with vertical Cauchy stress σ_{{yy}} (nodal means) at instants {during}, all at one scale, displacements as \
         they are. Blue presses, red pulls.{arrow}"
    );
    Some(Figure { name: "bodies", caption, svg })
}

/// Dimension 1: displacement along the bars at the instants.
fn bars(run: &Run, sets: &[(f64, carom_record::FieldSet)], during: &str) -> Option<Figure> {
    let positions: Vec<Vec<(f64, f64)>> = sets
        .iter()
        .map(|(_, set)| {
            let u = set.array("displacement").filter(|a| a.components == 3);
            let mut list = Vec::new();
            for block in &set.blocks {
                let mut nodes = block.connectivity.clone();
                nodes.sort_by(|&a, &b| set.points[a][0].total_cmp(&set.points[b][0]));
                nodes.dedup();
                list.extend(nodes.iter().map(|&k| (set.points[k][0], u.map_or(f64::NAN, |u| u.values[3 * k]))));
                // A gap between bodies.
                list.push((set.points[*nodes.last()?][0], f64::NAN));
            }
            Some(list)
        })
        .collect::<Option<_>>()?;
    let x: Vec<Vec<f64>> = positions.iter().map(|l| l.iter().map(|p| p.0).collect()).collect();
    let time = run.history.unit("time");
    let series = positions.iter().zip(&x).zip(sets).enumerate().map(|(i, ((list, x), (t, _)))| Series {
        label: format!("t = {t:.4} {time}"),
        color: sequence(i, sets.len()),
        x,
        y: list.iter().map(|p| p.1).collect(),
    });
    let length = sets.first()?.1.array("displacement").map(|a| a.unit.clone()).unwrap_or_default();
    let panels = vec![panel("u_{x}", &length, 230.0, series.collect())];
    let x_label = with_unit("reference position X", &length);
    let svg = Chart { title: "Displacement along the bars", x_label, shades: Vec::new(), panels }.svg();
    Some(Figure { name: "bodies", caption: format!("Displacement along the bars at instants {during}."), svg })
}
