//! Time histories: columns of a run as curves in panels, with measured data and expected values.

use carom_record::{Run, Sizes, metrics};

use crate::chart::{Chart, Options, Panel, Series, Track};
use crate::figure::Figure;
use crate::labels::{is_stress, symbol, time_label};
use crate::measured::{Points, add_points, differences, sources};
use crate::noise::{is_noise, largest};
use crate::ordered::grouped;
use crate::palette::LINES;
use crate::recorded::Recorded;

/// Share of the recorded time from which shading says nothing.
const THROUGHOUT: f64 = 0.97;
/// Largest number of kinds of events drawn; the rarest come first.
const KINDS: usize = 6;
/// A component below this share of the largest one has a panel of its own.
const SMALL: f64 = 0.125;
/// Heights of panels in pixels.
pub(crate) const HIGH: f64 = 190.0;
pub(crate) const LOW: f64 = 110.0;

/// A column to draw, with its label.
pub(crate) struct Line {
    pub(crate) column: String,
    pub(crate) label: String,
}

impl Line {
    pub(crate) fn new(column: impl Into<String>, label: impl Into<String>) -> Self {
        Self { column: column.into(), label: label.into() }
    }

    /// The components of [`Self::vector`], with the name of what has the vector.
    pub(crate) fn vector_of(run: &Run, stem: &str, symbol: &str, name: &str) -> Vec<Self> {
        let named = |line: Self| Self { label: format!("{}, {name}", line.label), ..line };
        Self::vector(run, stem, symbol).into_iter().map(named).collect()
    }

    /// The components of a vector that are recorded; of a moment in the plane the only one.
    pub(crate) fn vector(run: &Run, stem: &str, symbol: &str) -> Vec<Self> {
        let component = |axis: &str| Self::new(format!("{stem}_{axis}"), format!("{symbol}_{{{axis}}}"));
        let all = ["x", "y", "z"].map(component).into_iter().chain([Self::new(stem, symbol)]);
        all.filter(|line| run.column(&line.column).is_some()).collect()
    }
}

/// The histories of a run.
pub(crate) struct Histories<'a> {
    run: &'a Recorded,
    points: Vec<Points>,
    shades: Vec<(f64, f64)>,
}

impl<'a> Histories<'a> {
    pub(crate) fn new(run: &'a Recorded) -> Self {
        Self { run, points: Points::all(run), shades: shades(run) }
    }

    /// A panel of columns of one unit with their points, without those that are below `least`.
    pub(crate) fn panel(&self, label: &str, height: f64, lines: &[Line], least: f64) -> Panel<'_> {
        let curve = |(k, line): (usize, &Line)| {
            let y = self.run.column(&line.column)?;
            let is_shown = least == 0.0 || y.iter().any(|y| y.abs() > least);
            is_shown.then(|| Series {
                label: line.label.clone(),
                color: LINES[k % LINES.len()],
                x: self.run.times(),
                y: y.to_vec(),
                ..Series::default()
            })
        };
        let mut series: Vec<Series> = lines.iter().enumerate().filter_map(curve).collect();
        lines.iter().for_each(|line| add_points(&self.points, &line.column, &mut series));
        let unit = lines.first().map_or("", |line| self.run.history.unit(&line.column));
        Panel { label: label.to_owned(), unit: unit.to_owned(), height, series }
    }

    /// Panels of the components of a vector: those that would be flat beside the largest one have a
    /// panel of their own.
    pub(crate) fn vector(&self, label: &str, height: f64, lines: Vec<Line>, least: f64) -> Vec<Panel<'_>> {
        let peak = |line: &Line| self.run.column(&line.column).map_or(0.0, largest);
        let most = lines.iter().map(peak).fold(0.0, f64::max);
        let (large, small): (Vec<Line>, Vec<Line>) =
            lines.into_iter().partition(|line| peak(line) >= SMALL * most);
        let both = [(height, large), (LOW, small)];
        both.map(|(height, lines)| self.panel(label, height, &lines, least)).into()
    }

    /// Panels of the probes by quantity, without stresses of bodies that are not deformed, and what
    /// is round-off.
    pub(crate) fn probes(&self) -> Vec<Panel<'_>> {
        let sizes = Sizes::of(self.run);
        let mut found = Vec::new();
        for column in &self.run.history.columns {
            let Some((probe, quantity)) = column.name.rsplit_once('.') else { continue };
            let Some(number) = self.run.case.probes.iter().position(|known| known.name == probe) else {
                continue;
            };
            let is_idle = if is_stress(quantity) {
                is_noise(self.run, &column.name)
            } else {
                let most = self.run.column(&column.name).map_or(0.0, largest);
                !column.unit.is_empty() && sizes.is_round_off(most, &column.unit)
            };
            if let Some(y) = self.run.column(&column.name).filter(|_| !is_idle) {
                let label = format!("{} at {probe}", symbol(quantity));
                let color = LINES[number % LINES.len()];
                let series = Series { label, color, x: self.run.times(), y: y.to_vec(), ..Series::default() };
                found.push((quantity, (column, series)));
            }
        }
        let mut panels = Vec::new();
        for (quantity, members) in grouped(found) {
            let symbol = symbol(quantity);
            let unit = members[0].0.unit.clone();
            let mut series = Vec::new();
            let mut apart = Vec::new();
            for (column, curve) in members {
                series.push(curve);
                add_points(&self.points, &column.name, &mut series);
                apart.extend(differences(self.run, &self.points, &column.name, &symbol));
            }
            panels.push(Panel { label: symbol, unit, height: HIGH, series });
            panels.extend(apart);
        }
        panels
    }

    /// A panel for the differences of a column from its data.
    pub(crate) fn differences(&self, column: &str) -> Option<Panel<'_>> {
        differences(self.run, &self.points, column, column)
    }

    /// Where the points in a figure of these columns come from.
    pub(crate) fn sources(&self, columns: &[&str]) -> String {
        sources(self.run, &self.points, columns)
    }

    /// The sentence of a caption that says what shading means.
    pub(crate) fn shaded(&self) -> &'static str {
        if self.shades.is_empty() { "" } else { " Shaded: contact." }
    }

    /// The figure of panels with a title, if there are any curves; with events below them.
    pub(crate) fn figure(
        &self,
        name: &'a str,
        title: &'a str,
        caption: String,
        panels: Vec<Panel<'_>>,
        tracks: &[Track],
    ) -> Option<Figure> {
        let panels: Vec<Panel> = panels.into_iter().filter(|panel| !panel.series.is_empty()).collect();
        if panels.is_empty() {
            return None;
        }
        let chart = Chart { title, x_label: time_label(self.run), shades: self.shades.clone(), panels };
        let options = Options { tracks, time: true, name, ..Options::default() };
        let mut figure = chart.figure(name, caption, &options);
        title.clone_into(&mut figure.title);
        figure.data = Some(chart.data(tracks));
        Some(figure)
    }
}

/// Times of the events of each kind, the rarest kind first.
pub(crate) fn tracks(run: &Run) -> Vec<Track> {
    let kinds = grouped(run.log.iter().map(|event| (event.kind.clone(), event.time)));
    let mut tracks: Vec<Track> = kinds.into_iter().map(|(label, times)| Track { label, times }).collect();
    tracks.sort_by_key(|track| track.times.len());
    tracks.truncate(KINDS);
    tracks
}

/// Contact intervals to shade; none where one lasts throughout.
fn shades(run: &Run) -> Vec<(f64, f64)> {
    let t = run.times();
    let Some(last) = t.last() else { return Vec::new() };
    let end = |episode: &metrics::Episode| episode.end.map_or(*last, |row| t[row]);
    let all: Vec<(f64, f64)> =
        metrics::episodes(&run.history, 0.0).iter().map(|episode| (t[episode.start], end(episode))).collect();
    let lasts = |(from, to): &(f64, f64)| to - from > THROUGHOUT * (last - t[0]);
    if all.iter().any(lasts) { Vec::new() } else { all }
}
