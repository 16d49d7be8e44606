//! Small multiples of a study: a column of every method with the reference, one pane each.

use carom_record::study::Study;
use carom_record::study::reference::{FORCE, Reference};

use crate::collected::{Column, Measured, named};
use crate::curves;
use crate::labels::{capitalised, file_name, with_unit};
use crate::laboratory::{methods, style_of};
use crate::plot::{Band, Curve, Pane, Plot};

/// Colour of the reference in small multiples.
const REFERENCE: &str = "#222";

/// Most points of the reference in a pane.
const POINTS: usize = 1200;

/// Largest number of small multiples in one figure.
const MULTIPLES: usize = 24;

/// The figures of a study with a goal; none for a study without.
pub(crate) fn plots(study: &Study, columns: &[Column], measured: &Measured, time: &str) -> Vec<Plot> {
    if study.manifest.goal.is_none() {
        return Vec::new();
    }
    columns.iter().filter_map(|column| multiples(study, column, measured, time)).collect()
}

/// The reference of a column as a line, and where its value is established, the band of its
/// uncertainty.
fn reference_of(reference: &Reference, column: &str) -> Option<(Curve, Option<Band>)> {
    let (x, y) = reference.column(column)?;
    let off = reference.band(column);
    let piece = (2 * x.len()).div_ceil(POINTS).max(1);
    if x.is_empty() {
        return None;
    }
    let rows = extremes(y, piece);
    let around = |i: usize| i / piece * piece..(i / piece * piece + piece).min(y.len());
    let low = |i: &usize| around(*i).map(|k| y[k] - off[k]).fold(f64::INFINITY, f64::min);
    let high = |i: &usize| around(*i).map(|k| y[k] + off[k]).fold(f64::NEG_INFINITY, f64::max);
    let x: Vec<f64> = rows.iter().map(|i| x[*i]).collect();
    let known = reference.uncertainty(column).established().is_some();
    let band = known.then(|| Band {
        name: "uncertainty",
        x: x.clone(),
        low: rows.iter().map(low).collect(),
        high: rows.iter().map(high).collect(),
    });
    let line = Curve {
        label: "reference".to_owned(),
        color: Some(REFERENCE),
        over: true,
        x,
        y: rows.iter().map(|i| y[*i]).collect(),
        unlisted: true,
        ..Curve::default()
    };
    Some((line, band))
}

/// The rows with the least and the largest value of every piece, and both ends: no peak is lost.
fn extremes(y: &[f64], piece: usize) -> Vec<usize> {
    let mut found = vec![0];
    for from in (0..y.len()).step_by(piece.max(1)) {
        let rows = || from..(from + piece).min(y.len());
        let least = rows().min_by(|a, b| y[*a].total_cmp(&y[*b]));
        let largest = rows().max_by(|a, b| y[*a].total_cmp(&y[*b]));
        found.extend(least.into_iter().chain(largest));
    }
    found.push(y.len().saturating_sub(1));
    found.sort_unstable();
    found.dedup();
    found
}

/// A column of every method at its finest level, one pane each; during the first contact, if this
/// is a small part of the time. Methods with the same curve share a pane.
fn multiples(study: &Study, column: &Column, measured: &Measured, time: &str) -> Option<Plot> {
    let reference = study.reference.as_ref().and_then(|r| reference_of(r, &column.name));
    let (line, band) = reference.map_or((None, None), |(line, band)| (Some(line), band));
    let (label, what) = named(&column.name);
    let chosen = study.recommended();
    let curve = |(name, arms): (&str, Vec<usize>)| {
        let finest = arms.last()?;
        let (_, x, y) = column.curves.iter().find(|(arm, ..)| arm == finest)?;
        let chosen = arms.iter().any(|arm| chosen == Some(*arm));
        let (style, apart) = (style_of(study, *finest), study.rows[*finest].is_unsound());
        let label = name.to_owned();
        Some(Curve { label, style, apart, x: x.clone(), y: y.clone(), chosen, ..Curve::default() })
    };
    let found = curves::merged(methods(study).into_iter().filter_map(curve).take(MULTIPLES).collect());
    // A single pane compares nothing; the overlays show the column as well.
    if found.len() < 2 {
        return None;
    }
    let end = found.iter().filter_map(|(curve, _)| curve.x.last()).copied().fold(0.0, f64::max);
    let span = curves::contact(study, end);
    let drawn_once = curves::drawn_once(found.iter().map(|(curve, others)| (&curve.label, others)));
    let points = measured.points(&column.name, end, true);
    let pane = |(k, (curve, others)): (usize, (Curve, Vec<String>))| {
        let mark = if curve.chosen { "▸ " } else { "" };
        let more = match &others[..] {
            [] => String::new(),
            [other] => format!(" and {other}"),
            others => format!(" and {} others", others.len()),
        };
        let creates = if curve.apart { ", creates energy" } else { "" };
        let title = format!("{mark}{}{more}{creates}", curve.label);
        let name = curve.label.clone();
        let curve = Curve { unlisted: true, ..curve };
        let curves = line.iter().cloned().chain([curve]).chain(points.iter().cloned()).collect();
        Pane {
            name,
            title,
            y_label: if k % 3 == 0 { with_unit(&label, &column.unit) } else { String::new() },
            curves,
            band: band.clone(),
            span,
            ..Pane::default()
        }
    };
    let grey = match (&line, &band) {
        (None, _) => "",
        (_, Some(_)) => " Dashed line: the reference, with the band of its uncertainty",
        (_, None) => " Dashed line: the reference; its uncertainty is not established.",
    };
    let mark = if found.iter().any(|(curve, _)| curve.chosen) { " ▸: recommended." } else { "" };
    let is_apart = found.iter().any(|(curve, _)| curve.apart);
    let apart = if is_apart { " Methods that create energy do not affect the axes." } else { "" };
    let when = if span.is_some() { " during the first contact" } else { "" };
    let panes: Vec<Pane> = found.into_iter().enumerate().map(pane).collect();
    let name = if column.name == FORCE { "contact-force" } else { &column.name };
    let mut plot = Plot {
        name: format!("each-{}", file_name(name)),
        x_label: with_unit("time t", time),
        across: 3,
        same: true,
        panes,
        ..Plot::default()
    };
    let shown = plot.panes.first().map_or_else(Vec::new, |pane| plot.shown_band(pane));
    let part = match () {
        () if shown.is_empty() => "",
        () if shown.iter().all(|shown| *shown) => ".",
        () => ", where it does not exceed the axis.",
    };
    plot.caption = format!(
        "{}{when}, for each method at its finest level.{grey}{part}{mark}{apart}{drawn_once}{} All panels have \
         the same axes.",
        capitalised(&what),
        measured.words(&column.name)
    );
    Some(plot)
}

#[cfg(test)]
mod tests {
    use super::extremes;

    /// A peak of one row is drawn, wherever it lies in its piece.
    #[test]
    fn no_peak_is_lost() {
        for at in 0..40 {
            let mut y = vec![1.0; 40];
            y[at] = 7.0;
            let rows = extremes(&y, 9);
            assert!(rows.contains(&at) && rows.contains(&0) && rows.contains(&39), "{at}: {rows:?}");
            assert!(rows.len() <= 12);
        }
    }
}
