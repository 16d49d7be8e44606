//! Charts over the time of a run, with their tables and scripts.

use carom_record::{Run, metrics};

use crate::animation;
use crate::chart::{Chart, Options, Panel};
use crate::figure::{Figure, NARROW};
use crate::labels::time_label;
use crate::redraw::of_chart;

/// Share of the recorded time from which shading says nothing.
const THROUGHOUT: f64 = 0.97;

/// Contact intervals to shade; none where one lasts throughout.
pub(crate) fn shades(run: &Run) -> Vec<(f64, f64)> {
    let t = run.times();
    let end = |e: &metrics::Episode| e.end.map_or(t[t.len() - 1], |i| t[i]);
    let all: Vec<(f64, f64)> =
        metrics::episodes(&run.history, 0.0).iter().map(|e| (t[e.start], end(e))).collect();
    let lasts = |(from, to): &(f64, f64)| to - from > THROUGHOUT * (t[t.len() - 1] - t[0]);
    if all.iter().any(lasts) { Vec::new() } else { all }
}

/// A chart over time with its files.
pub(crate) fn chart<'a>(
    run: &Run,
    (name, title): (&'static str, &'a str),
    caption: String,
    panels: Vec<Panel<'a>>,
) -> Option<Figure> {
    let panels: Vec<Panel> = panels.into_iter().filter(|p| !p.series.is_empty()).collect();
    let x_label = time_label(run);
    (!panels.is_empty()).then(|| {
        let tracks = if title == "Solver" { animation::tracks(run) } else { Vec::new() };
        let options = Options { tracks: &tracks, time: true, ..Options::default() };
        let chart = Chart { title, x_label, shades: shades(run), panels };
        let plot = of_chart(name, &chart);
        let narrow = chart.draw(&Options { width: NARROW, ..options });
        let figure = Figure::new(name, caption, chart.draw(&options)).with_narrow(narrow);
        figure.with(plot.csv(), plot.script())
    })
}

/// Names of the items of a list of the resolved case.
pub(crate) fn names<'a>(run: &'a Run, list: &str) -> Vec<&'a str> {
    let items = run.manifest.case.get(list).and_then(|v| v.as_array());
    items.into_iter().flatten().filter_map(|item| item.get("name")?.as_str()).collect()
}
