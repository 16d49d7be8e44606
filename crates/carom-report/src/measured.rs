//! Measured data and expected values as points beside the columns that they belong to, and their
//! differences.

use std::fmt::Write as _;

use carom_record::question::{Form, Quantity, Question};
use carom_record::{Expectation, Expression, Run, metrics};

use crate::axis::range;
use crate::chart::{Panel, Series};
use crate::ordered::grouped;
use crate::palette::LINES;

/// The label of measured data beside curves.
pub(crate) fn measured_label(overlay: &metrics::Overlay) -> String {
    format!("measured: {}", overlay.name)
}

/// Height in pixels of a panel of differences: of the column, linear between its rows, less the
/// data.
const LOW: f64 = 84.0;

/// Colours of measured data, in turn.
const DATA: [&str; 3] = [LINES[2], LINES[4], LINES[3]];

/// Points of a column within the time of the run.
pub(crate) struct Points {
    pub(crate) label: String,
    pub(crate) column: String,
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    /// The name of the data; none of expected values.
    measured: Option<String>,
}

impl Points {
    /// Points of all measured data, then those of all expectations.
    pub(crate) fn all(run: &Run) -> Vec<Self> {
        let (first, last) = range(run.times());
        let cut = |o: &metrics::Overlay| {
            let (x, y) = o.within(first, last);
            let label = measured_label(o);
            let measured = Some(o.name.clone());
            Self { label, column: o.column.clone(), x, y, measured }
        };
        metrics::overlays(run).iter().map(cut).chain(expected(run)).collect()
    }
}

/// The values that expectations state for a column at an instant.
fn expected(run: &Run) -> Vec<Points> {
    let (first, last) = range(run.times());
    let point = |e: &Expectation| {
        let Ok(Expression::Quantity(Quantity::Reduced(form, series))) = Question::parse(&e.what) else {
            return None;
        };
        let Expression::Quantity(asked) = &series.columns else { return None };
        let time = match form {
            Form::First => first,
            Form::Last => last,
            Form::At(time) => time,
            _ => return None,
        };
        Some((asked.column.clone(), (time, e.value?)))
    };
    let stated = run.manifest.expectations.iter().filter(|e| e.tolerance.is_some());
    let points = |(column, points): (String, Vec<(f64, f64)>)| {
        let (x, y) = points.into_iter().unzip();
        Points { label: "expected".to_owned(), column, x, y, measured: None }
    };
    grouped(stated.filter_map(point)).into_iter().map(points).collect()
}

/// Adds the points of a column to its panel.
pub(crate) fn add_points<'a>(all: &'a [Points], column: &str, panel: &mut Vec<Series<'a>>) {
    for points in all.iter().filter(|points| points.column == column) {
        let number = panel.iter().filter(|s| s.dotted).count();
        let is_named = panel.iter().any(|s| s.dotted && s.label == points.label);
        panel.push(Series {
            // Several curves of a panel can have expected values; one entry of the legend is
            // enough.
            label: points.label.clone(),
            color: if points.measured.is_none() { LINES[1] } else { DATA[number % 3] },
            x: &points.x,
            y: points.y.clone(),
            dotted: true,
            unlisted: is_named,
        });
    }
}

/// A panel for the differences between a column and each of its measured data.
pub(crate) fn differences<'a>(run: &Run, all: &'a [Points], column: &str, symbol: &str) -> Option<Panel<'a>> {
    let computed = run.column(column)?;
    let mut series = Vec::new();
    for points in all.iter().filter(|points| points.column == column && points.measured.is_some()) {
        let name = points.measured.as_deref().unwrap_or_default();
        let at = |(x, y): (&f64, &f64)| between(run.times(), computed, *x) - y;
        series.push(Series {
            label: format!("computed {symbol} − “{name}”"),
            color: DATA[series.len() % 3],
            x: &points.x,
            y: points.x.iter().zip(&points.y).map(at).collect(),
            dotted: true,
            ..Series::default()
        });
    }
    let unit = run.history.unit(column).to_owned();
    (!series.is_empty()).then(|| Panel { label: "difference".to_owned(), unit, height: LOW, series })
}

/// Linear between rows.
fn between(times: &[f64], values: &[f64], t: f64) -> f64 {
    let k = times.partition_point(|x| *x < t).clamp(1, times.len().max(2) - 1);
    let (Some([a, b]), Some([p, q])) = (times.get(k - 1..=k), values.get(k - 1..=k)) else {
        return values.first().copied().unwrap_or(f64::NAN);
    };
    p + (q - p) * (t - a) / (b - a)
}

/// Where the points of these columns come from.
pub(crate) fn sources(run: &Run, all: &[Points], columns: &[&str]) -> String {
    let mut out = String::new();
    let of = |name: &str| columns.contains(&name);
    for overlay in metrics::overlays(run).into_iter().filter(|overlay| of(&overlay.column)) {
        let source = overlay.source.map_or_else(String::new, |source| format!(" ({source})"));
        let _ = write!(out, " Dots: data “{}”{source}.", overlay.name);
    }
    if all.iter().any(|points| points.measured.is_none() && of(&points.column)) {
        out.push_str(" Dots “expected”: values of expectations.");
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_linear_between_rows() {
        let times = [0.0, 1.0, 3.0];
        let values = [0.0, 2.0, -2.0];
        assert_eq!([0.0, 0.5, 2.0, 3.0].map(|t| between(&times, &values, t)), [0.0, 1.0, 0.0, -2.0]);
        assert!(between(&[], &[], 0.0).is_nan());
        assert_eq!(between(&[1.0], &[5.0], 1.0), 5.0);
    }
}
