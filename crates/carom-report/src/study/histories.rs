//! Histories of the arms of a study, a figure for each column: the curves of a few arms over each
//! other, and enlarged for the first contact; of more arms, and with a reference, a pane for each.

use carom_record::study::Study;
use carom_record::study::reference::{FORCE, Reference};

use super::collected::{Column, Measured, common_time, intervals, named};
use super::comparison::{methods, style_of};
use super::curves::{Keys, contact, is_rough};
use crate::labels::{capitalised, file_name, with_unit};
use crate::plot::{Band, Curve, Pane, Plot};
use crate::text::said_if;
use crate::trace::ends_and_extremes;

/// Most curves over each other.
const TOGETHER: usize = 8;
/// Most panes.
const PANES: usize = 24;
/// Panes and figures that are shown; the other figures are folded away.
const OPEN_PANES: usize = 36;
const OPEN: usize = 4;
/// Intervals of the reference in a pane, of which the ends and the extremes are drawn.
const INTERVALS: usize = 600;

/// The figures of all columns.
pub(super) fn plots(study: &Study, columns: &[Column], measured: &Measured, time: &str) -> Vec<Plot> {
    let mut panes = 0;
    let shown = columns.iter().filter_map(|column| plot(study, column, measured)).enumerate();
    let placed = |(k, plot): (usize, Plot)| {
        panes += plot.panes.len();
        Plot { folded: k >= OPEN || panes > OPEN_PANES, x_label: with_unit("time t", time), ..plot }
    };
    shown.map(placed).collect()
}

/// The reference of a column as a line, and where its value is established, the band of its
/// uncertainty.
fn reference_of(reference: &Reference, column: &str) -> Option<(Curve, Option<Band>)> {
    let is_shared = !reference.differs;
    let (times, values) = reference.column(column).filter(|(times, _)| is_shared && !times.is_empty())?;
    let off = reference.band(column);
    let mut y = Vec::new();
    let mut band = Band { name: "uncertainty", x: Vec::new(), low: Vec::new(), high: Vec::new() };
    for rows in intervals(times.len(), INTERVALS) {
        let low = rows.clone().map(|i| values[i] - off[i]).fold(f64::INFINITY, f64::min);
        let high = rows.clone().map(|i| values[i] + off[i]).fold(f64::NEG_INFINITY, f64::max);
        for i in ends_and_extremes(rows, |i| values[i]) {
            y.push(values[i]);
            band.x.push(times[i]);
            band.low.push(low);
            band.high.push(high);
        }
    }
    let line = Curve { label: "reference".to_owned(), thin: true, x: band.x.clone(), y, ..Curve::default() };
    Some((line, reference.uncertainty(column).is_ok().then_some(band)))
}

/// The curves of a column: with a goal of every method at its finest level, else of every arm.
fn curves(study: &Study, column: &Column) -> Vec<Curve> {
    let keys = Keys::of(study.rows.iter().map(|row| row.name.as_str()), common_time(study));
    let chosen = study.recommended();
    let shown: Vec<(String, Vec<usize>)> = if study.manifest.goal.is_some() {
        methods(study).into_iter().map(|(name, arms)| (name.to_owned(), arms)).collect()
    } else {
        (0..study.rows.len()).map(|arm| (keys.label(&study.rows[arm].name), vec![arm])).collect()
    };
    let curve = |(label, arms): (String, Vec<usize>)| {
        let finest = *arms.last()?;
        let (_, x, y) = column.curves.iter().find(|(arm, ..)| *arm == finest)?;
        Some(Curve {
            label,
            style: style_of(study, finest),
            x: x.clone(),
            y: y.clone(),
            apart: study.rows[finest].is_unsound(),
            chosen: arms.iter().any(|arm| chosen == Some(*arm)),
            ..Curve::default()
        })
    };
    shown.into_iter().filter_map(curve).collect()
}

/// The curves of a column, with what is drawn behind and before them.
struct Found {
    curves: Vec<Curve>,
    /// Measured data.
    points: Vec<Curve>,
    /// The reference, with the band of its uncertainty.
    reference: Option<(Curve, Option<Band>)>,
    /// The first contact, where it is short.
    contact: Option<(f64, f64)>,
}

impl Found {
    /// Whether each curve has a pane of its own.
    fn is_each(&self) -> bool {
        let rough = self.curves.iter().filter(|curve| is_rough(curve)).count();
        let hide_each_other = self.reference.is_some() || rough > 1;
        self.curves.len() > TOGETHER || self.curves.len() > 1 && hide_each_other
    }

    /// A pane for each curve.
    fn each(&self, y_label: &str) -> Vec<Pane> {
        let pane = |curve: &Curve| {
            let mark = if curve.chosen { "▸ " } else { "" };
            let own = Curve { unlisted: true, ..curve.clone() };
            Pane {
                name: curve.label.clone(),
                title: format!("{mark}{}", curve.label),
                y_label: y_label.to_owned(),
                curves: self
                    .reference
                    .iter()
                    .map(|(line, _)| line.clone())
                    .chain([own])
                    .chain(self.points.iter().cloned())
                    .collect(),
                band: self.reference.as_ref().and_then(|(_, band)| band.clone()),
                span: self.contact,
                ..Pane::default()
            }
        };
        self.curves.iter().take(PANES).map(pane).collect()
    }

    /// All curves in a pane, and in another one during the first contact.
    fn together(&self, y_label: &str) -> Vec<Pane> {
        let curves = self.curves.iter().chain(&self.points).cloned().collect();
        let whole =
            Pane { name: "whole time".into(), y_label: y_label.to_owned(), curves, ..Pane::default() };
        let title = "during the first contact".to_owned();
        let part =
            self.contact.map(|span| Pane { name: String::new(), title, span: Some(span), ..whole.clone() });
        std::iter::once(whole).chain(part).collect()
    }

    /// Words for the caption, after the name of the column.
    fn words(&self, study: &Study) -> String {
        let is_apart = self.curves.iter().any(|curve| curve.apart);
        let grey = said_if(is_apart, " Grey: failed or created energy; no influence on the axes.");
        if !self.is_each() {
            return format!(".{grey}");
        }
        let hidden = match self.curves.len().saturating_sub(PANES) {
            0 => String::new(),
            hidden => format!(" {hidden} more are not drawn."),
        };
        let reference = match &self.reference {
            None => "",
            Some((_, None)) => " Dashed: the reference.",
            Some((_, Some(_))) => " Dashed: the reference, with the band of its uncertainty.",
        };
        [
            said_if(self.contact.is_some(), " during the first contact"),
            said_if(study.manifest.goal.is_some(), ", for each method at its finest level"),
            "; all panes have the same axes.",
            reference,
            said_if(self.curves.iter().any(|curve| curve.chosen), " ▸: recommended."),
            grey,
            &hidden,
        ]
        .concat()
    }
}

fn plot(study: &Study, column: &Column, measured: &Measured) -> Option<Plot> {
    let (label, what) = named(&column.name);
    let y_label = with_unit(&label, &column.unit);
    let curves = curves(study, column);
    let end = curves.iter().filter_map(|curve| curve.x.last()).copied().fold(0.0, f64::max);
    let reference = study.reference.as_ref().and_then(|reference| reference_of(reference, &column.name));
    let contact = contact(study, end);
    let points = measured.points(&column.name, end);
    let found = Found { curves, points, reference, contact };
    let is_each = found.is_each();
    let panes = if is_each { found.each(&y_label) } else { found.together(&y_label) };
    if panes.iter().all(|pane| pane.curves.is_empty()) {
        return None;
    }
    let name = if column.name == FORCE { "contact-force" } else { &column.name };
    Some(Plot {
        name: file_name(name),
        caption: [capitalised(&what), found.words(study), measured.words(&column.name)].concat(),
        across: if is_each { 3 } else { 1 },
        same: is_each,
        panes,
        ..Plot::default()
    })
}
