//! Figures of the columns that measured data belong to or expectations evaluate, where no other
//! figure shows them.

use carom_formula::Formula;
use carom_record::Run;

use crate::chart::{Panel, Series};
use crate::figure::Figure;
use crate::labels::listed;
use crate::measured::{Points, add_points, differences, sources};
use crate::noise::largest;
use crate::ordered::{distinct, grouped};
use crate::over_time::{self, SMALL, chart};
use crate::palette::LINES;
use crate::values::names;

/// A column below this size shows only round-off.
const ROUND_OFF: f64 = 1e-12;
/// Columns of the figure of expected values; more make it longer than a page.
const MOST: usize = 8;

/// Whether another figure shows a column; `lists` are the columns of the figures of all runs.
fn is_shown(run: &Run, lists: &[&[(&str, &str)]], column: &str) -> bool {
    let is_probed = |probe: &str| names(&run.manifest.case, "probes").contains(&probe);
    column.rsplit_once('.').is_some_and(|(probe, _)| is_probed(probe))
        || lists.iter().any(|list| list.iter().any(|(name, _)| *name == column))
        || ["time", "step", "active", "newton", "rejected"].contains(&column)
}

/// Measured data of columns that no other figure shows, with these columns.
pub(crate) fn measured(run: &Run, lists: &[&[(&str, &str)]]) -> Option<Figure> {
    let points = Points::all(run);
    let mut columns: Vec<String> = carom_record::metrics::overlays(run)
        .into_iter()
        .map(|overlay| overlay.column)
        .filter(|column| !is_shown(run, lists, column))
        .collect();
    columns.sort_unstable();
    columns.dedup();
    let mut panels = Vec::new();
    for column in &columns {
        panels.push(panel(run, &points, &[column], column));
        panels.extend(differences(run, &points, column, column));
    }
    let words = "Measured data and the columns that they belong to.";
    figure(run, ("measured", "Measured data"), words, (&points, &columns, panels))
}

/// The columns that expectations evaluate and no other figure shows, with the expected values.
pub(crate) fn expected(run: &Run, lists: &[&[(&str, &str)]]) -> Option<Figure> {
    let points = Points::all(run);
    let measured = carom_record::metrics::overlays(run);
    let asked = run.manifest.expectations.iter().flat_map(|e| columns_in(run, &e.what));
    let worth = |column: &String| {
        !is_shown(run, lists, column)
            && measured.iter().all(|overlay| overlay.column != *column)
            && run.column(column).is_some_and(|values| largest(values) > ROUND_OFF)
    };
    let mut columns = distinct(asked.filter(worth));
    columns.truncate(MOST);
    // The components of a vector have one panel, those that would be flat in it a second one.
    let stem = |column: &'_ str| {
        let stem = column.strip_suffix(['x', 'y', 'z']).filter(|stem| stem.ends_with('_'));
        stem.map_or(column, |stem| stem.trim_end_matches('_')).to_owned()
    };
    let groups = grouped(columns.iter().map(|column| (stem(column), column.as_str())));
    let formulas: Vec<(String, String, Vec<f64>)> =
        run.manifest.expectations.iter().filter_map(|e| formula(run, &e.what)).collect();
    let mut panels = Vec::new();
    let peak = |column: &str| run.column(column).map_or(0.0, largest);
    let by_size = groups.iter().flat_map(|(name, members)| {
        let most = members.iter().map(|column| peak(column)).fold(0.0, f64::max);
        let (large, small): (Vec<&str>, Vec<&str>) =
            members.iter().partition(|column| peak(column) >= SMALL * most);
        [large, small].map(|members| (name, members))
    });
    for (name, members) in by_size.filter(|(_, members)| !members.is_empty()) {
        let label = if let [one] = members[..] { one } else { name };
        let mut panel = panel(run, &points, &members, label);
        for (_, text, y) in formulas.iter().filter(|(column, ..)| members.contains(&column.as_str())) {
            panel.series.push(Series {
                label: format!("expected: {text}"),
                color: LINES[2],
                x: run.times(),
                y: y.clone(),
                ..Series::default()
            });
        }
        panels.push(panel);
    }
    let words = "Columns that expectations evaluate and no other figure shows.";
    figure(run, ("expected", "Columns of expectations"), words, (&points, &columns, panels))
}

/// The figure of some columns in panels, with points.
fn figure(
    run: &Run,
    names: (&str, &str),
    words: &str,
    (points, columns, panels): (&[Points], &[String], Vec<Panel>),
) -> Option<Figure> {
    let all: Vec<&str> = columns.iter().map(String::as_str).collect();
    let coded: Vec<String> = columns.iter().map(|column| format!("`{column}`")).collect();
    let caption = format!(
        "{words}{} Data: `history.csv`, {} {}.",
        sources(run, points, &all),
        if columns.len() == 1 { "column" } else { "columns" },
        listed(&coded)
    );
    chart(run, names, caption, panels)
}

/// A panel with columns of one unit and their points.
fn panel<'a>(run: &'a Run, points: &'a [Points], columns: &[&str], label: &str) -> Panel<'a> {
    let curve = |(k, column): (usize, &&str)| {
        Some(Series {
            label: (*column).to_owned(),
            // The second colour is that of expected values.
            color: LINES[if k == 0 { 0 } else { k + 2 } % LINES.len()],
            x: run.times(),
            y: run.column(column)?.to_vec(),
            ..Series::default()
        })
    };
    let mut series: Vec<Series> = columns.iter().enumerate().filter_map(curve).collect();
    columns.iter().for_each(|column| add_points(points, column, &mut series));
    over_time::panel(label, columns.first().map_or("", |column| run.history.unit(column)), 150.0, series)
}

/// The names of columns in what an expectation asks for.
pub(crate) fn columns_in(run: &Run, what: &str) -> Vec<String> {
    let sum = what.split_once("− (").map_or(what, |(column, _)| column);
    sum.split(|c: char| !(c.is_alphanumeric() || matches!(c, '_' | '.' | ':')))
        .filter(|word| run.column(word).is_some())
        .map(str::to_owned)
        .collect()
}

/// Column, text and values of the formula that it is compared with.
fn formula(run: &Run, what: &str) -> Option<(String, String, Vec<f64>)> {
    let (column, text) = what.split_once(" − (")?;
    let (column, text) = (column.rsplit_once('|')?.1, text.rsplit_once(")|")?.0);
    let formula = Formula::parse(text, &["t"]).ok()?;
    Some((column.to_owned(), text.to_owned(), run.times().iter().map(|t| formula.value(&[*t])).collect()))
}
