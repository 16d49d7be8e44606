//! Charts over the time of a run, with their tables and scripts.

use carom_record::{Column, Run, metrics};

use crate::chart::{Chart, Options, Panel, Series, Track};
use crate::figure::Figure;
use crate::labels::{is_stress, symbol, time_label};
use crate::measured::{Points, add_points};
use crate::noise::{has_contact, is_noise, largest};
use crate::ordered::grouped;
use crate::palette::LINES;
use crate::text::said_if;
use crate::values::names;

/// Share of the recorded time from which shading says nothing.
const THROUGHOUT: f64 = 0.97;

/// Largest number of kinds of events drawn; the rarest come first.
const KINDS: usize = 6;

/// Times of the events of each kind, the rarest kind first.
pub(crate) fn tracks(run: &Run) -> Vec<Track> {
    let kinds = grouped(run.log.iter().map(|event| (event.kind.clone(), event.time)));
    let mut tracks: Vec<Track> = kinds.into_iter().map(|(label, times)| Track { label, times }).collect();
    tracks.sort_by_key(|t| t.times.len());
    tracks.truncate(KINDS);
    tracks
}

/// Contact intervals to shade; none where one lasts throughout.
pub(crate) fn shades(run: &Run) -> Vec<(f64, f64)> {
    let t = run.times();
    let end = |e: &metrics::Episode| e.end.map_or(t[t.len() - 1], |i| t[i]);
    let all: Vec<(f64, f64)> =
        metrics::episodes(&run.history, 0.0).iter().map(|e| (t[e.start], end(e))).collect();
    let lasts = |(from, to): &(f64, f64)| to - from > THROUGHOUT * (t[t.len() - 1] - t[0]);
    if all.iter().any(lasts) { Vec::new() } else { all }
}

/// What the shading means.
pub(crate) fn shaded(run: &Run) -> &'static str {
    if shades(run).is_empty() {
        said_if(has_contact(run), " In contact throughout.")
    } else {
        " Shaded: contact."
    }
}

/// Curves of columns with their labels, without those that are missing or, compared with `size`,
/// zero throughout.
pub(crate) fn curves<'a>(
    run: &'a Run,
    points: &'a [Points],
    columns: &[(&str, &str)],
    size: f64,
) -> Vec<Series<'a>> {
    let found = columns.iter().enumerate().filter_map(|(i, (name, label))| {
        let y = run.column(name)?;
        let shown = size == 0.0 || y.iter().any(|y| y.abs() > 1e-9 * size);
        let series = |y: &[f64]| Series {
            label: (*label).into(),
            color: LINES[i % LINES.len()],
            x: run.times(),
            y: y.to_vec(),
            ..Series::default()
        };
        shown.then(|| series(y))
    });
    let mut found: Vec<Series> = found.collect();
    columns.iter().for_each(|(name, _)| add_points(points, name, &mut found));
    found
}

/// The columns of probes with their quantities and curves; without stresses of bodies that are not
/// deformed.
pub(crate) fn of_probes<'a>(run: &'a Run) -> Vec<(&'a str, (&'a Column, Series<'a>))> {
    let probes = names(&run.manifest.case, "probes");
    let curve = |column: &'a Column| {
        let (probe, quantity) = column.name.rsplit_once('.')?;
        let number = probes.iter().position(|name| *name == probe)?;
        let is_idle = is_stress(quantity) && is_noise(run, &column.name);
        let y = run.column(&column.name).filter(|_| !is_idle)?.to_vec();
        let (label, color) = (format!("{} at {probe}", symbol(quantity)), LINES[number % LINES.len()]);
        Some((quantity, (column, Series { label, color, x: run.times(), y, ..Series::default() })))
    };
    run.history.columns.iter().filter_map(curve).collect()
}

pub(crate) fn panel<'a>(label: &str, unit: &str, height: f64, series: Vec<Series<'a>>) -> Panel<'a> {
    Panel { label: label.into(), unit: unit.into(), height, series }
}

/// A component below this share of the largest one has a panel of its own.
pub(crate) const SMALL: f64 = 0.125;

/// A panel, or two of which the second has the components that would be flat in the first.
pub(crate) fn by_size(all: Panel) -> Vec<Panel> {
    let peak = |series: &Series| largest(&series.y);
    let most = all.series.iter().map(peak).fold(0.0, f64::max);
    let (large, small): (Vec<Series>, Vec<Series>) =
        all.series.into_iter().partition(|series| peak(series) >= SMALL * most);
    let both = [(all.height, large), (110.0, small)].into_iter().filter(|(_, series)| !series.is_empty());
    both.map(|(height, series)| panel(&all.label, &all.unit, height, series)).collect()
}

/// A chart over time with its files.
pub(crate) fn chart<'a>(
    run: &Run,
    (name, title): (&str, &'a str),
    caption: String,
    panels: Vec<Panel<'a>>,
) -> Option<Figure> {
    let panels: Vec<Panel> = panels.into_iter().filter(|p| !p.series.is_empty()).collect();
    let x_label = time_label(run);
    (!panels.is_empty()).then(|| {
        let tracks = if title == "Solver" { tracks(run) } else { Vec::new() };
        let options = Options { tracks: &tracks, time: true, ..Options::default() };
        Chart { title, x_label, shades: shades(run), panels }.figure(name, caption, &options)
    })
}
