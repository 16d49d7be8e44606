//! The contact pressure along the secondary side: a map over time and arc length, and the profile
//! of an instant beside the animation. From the rows of `contact.csv`; in the plane only.

use std::fmt::Write as _;

use carom_record::{ContactRow, FieldEntry, Run};
use serde_json::{Value, json};

use crate::arc::{Place, places};
use crate::axis::{Axis, range};
use crate::bands::{Bands, positive_bands};
use crate::chart::{ground, opened, time_axis, turned, write_text};
use crate::figure::{Figure, NARROW};
use crate::labels::{number, scaled};
use crate::ordered::grouped;
use crate::pen::{Pen, open_grid};
use crate::sheet::{Legend, arrowheads, color_bar};
use crate::text::said_if;
use crate::values::list;

const WIDTH: f64 = 720.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 106.0;
const HEIGHT: f64 = 200.0;
/// Size of the profile beside the animation.
const SMALL: [f64; 2] = [470.0, 150.0];
/// Instants in the map; more are thinned evenly.
const INSTANTS: usize = 360;

/// The pressures of one contact.
struct Side<'a> {
    name: &'a str,
    /// Rows with the places of their nodes.
    rows: Vec<(&'a ContactRow<'static>, Place)>,
}

impl Side<'_> {
    /// Arc lengths of its ends.
    fn extent(&self) -> (f64, f64) {
        range(self.rows.iter().flat_map(|(_, place)| &place.part))
    }

    /// The bands of its pressures, and whether some lie outside.
    fn bands(&self) -> (Bands, [bool; 2]) {
        positive_bands(self.rows.iter().map(|(row, _)| row.pressure))
    }
}

/// The sides of all contacts of the plane that have had pressure.
fn sides<'a>(run: &'a Run) -> Vec<Side<'a>> {
    // Without field files there are neither positions nor units.
    if run.manifest.facts.dimension == 3 || run.fields.is_empty() {
        return Vec::new();
    }
    let side = |(name, rows): (&'a str, Vec<&'a ContactRow<'static>>)| {
        let (places, _) = places(run, name, &rows);
        let with_place = |row: &'a ContactRow<'static>| {
            let place = *places.get(&row.node)?;
            (place.is_secondary && row.pressure.is_finite()).then_some((row, place))
        };
        Side { name, rows: rows.into_iter().filter_map(with_place).collect() }
    };
    let by_contact = grouped(run.contact.iter().map(|row| (row.contact.as_ref(), row)));
    // A profile needs a side, not a corner or the end of a bar.
    by_contact.into_iter().map(side).filter(|side| side.extent().1 > side.extent().0).collect()
}

fn units(run: &Run) -> (String, String) {
    let first = run.fields.first().and_then(|entry| run.field(entry).ok()).unwrap_or_default();
    (first.unit("displacement").to_owned(), first.unit("contact_pressure").to_owned())
}

/// The time from the first to the last pressure with a margin, within the run.
fn in_contact(run: &Run, sides: &[Side]) -> (f64, f64) {
    let (start, end) = range(run.times());
    let (first, last) = range(sides.iter().flat_map(|side| &side.rows).map(|(row, _)| &row.time));
    let margin = 0.04 * (last - first).max(0.02 * (end - start));
    // A pressure is drawn up to the next instant.
    let next = run.times().iter().copied().find(|t| *t > last).unwrap_or(last);
    ((first - margin).max(start), (last + margin).max(next).min(end))
}

/// The map of every contact.
pub(crate) fn figure(run: &Run) -> Option<Figure> {
    let sides = sides(run);
    if sides.is_empty() || run.times().len() < 2 {
        return None;
    }
    let (_, stress) = units(run);
    let mut table = String::from("contact,node,s,time,pressure\n");
    for (side, (row, place)) in sides.iter().flat_map(|side| side.rows.iter().map(move |row| (side, row))) {
        let _ =
            writeln!(table, "{},{},{:?},{:?},{:?}", side.name, row.node, place.at, row.time, row.pressure);
    }
    let [(out, cuts, stride), (narrow, ..)] = [WIDTH, NARROW].map(|width| draw(run, &sides, width));
    let thinned =
        if stride > 1 { format!(" {} recorded step is drawn.", every(stride)) } else { String::new() };
    let mut contacts = list(&run.manifest.case, "contacts").iter();
    let unmatched = said_if(
        contacts.any(|contact| contact.pointer("/primary/side").is_some()),
        " Where the nodes of the two sides do not match, nodal pressures have errors of 10 % or more.",
    );
    let classes = classes(&sides, &stress);
    let bars = cuts.into_iter().zip(sides.iter().map(|side| format!("“{}”", side.name)));
    let caption = format!(
        "Contact pressure p during contact, over time and the arc length s of the secondary side in the reference \
         configuration; one band per node, grey where the node is not in contact.{classes}{thinned}{}{unmatched} Data: \
         `contact.csv`, column `pressure`.",
        arrowheads(bars)
    );
    Some(Figure::new("pressure", caption, [out, narrow]).with_table(table))
}

/// The maps as a picture of a width, whether the colours of each leave values out, and of how many
/// steps one is drawn.
fn draw(run: &Run, sides: &[Side], width: f64) -> (String, Vec<[bool; 2]>, usize) {
    let (length, stress) = units(run);
    let (from, to) = in_contact(run, sides);
    let x_axis = Axis::new((from, to), 7.0, true);
    let plot = width - LEFT - RIGHT;
    let step = HEIGHT + 46.0;
    let mut out = opened("chart", "Contact pressure along the side", width, sides.len() as f64 * step + 34.0);
    let shown: Vec<f64> = run.times().iter().copied().filter(|t| (from..=to).contains(t)).collect();
    let stride = shown.len().div_ceil(INSTANTS).max(1);
    let kept: Vec<f64> = shown.into_iter().step_by(stride).collect();
    let to_x = |t: f64| LEFT + plot * x_axis.position(t);
    let mut cuts = Vec::new();
    for (k, side) in sides.iter().enumerate() {
        let top = 26.0 + k as f64 * step;
        let (bands, cut) = side.bands();
        cuts.push(cut);
        let y_axis = Axis::new(side.extent(), 6.0, true);
        let to_y = |s: f64| top + HEIGHT * (1.0 - y_axis.position(s));
        write_text(&mut out, LEFT, top - 8.0, "font-size=\"12\" font-weight=\"600\"", side.name);
        ground(&mut out, [LEFT, top, plot, HEIGHT]);
        map(&mut out, side, &kept, &bands, (&to_x, &to_y));
        frame(&mut out, (&x_axis, &y_axis), [LEFT, plot, top, HEIGHT]);
        let label = y_axis.label("arc length s", &length);
        turned(&mut out, (17, top + 0.5 * HEIGHT), "", &label);
        let legend = Legend { bands: &bands, cut, label: "p", unit: &stress };
        color_bar(&mut out, &legend, LEFT + plot + 20.0, (top - 4.0, top + HEIGHT - 8.0));
    }
    let y = sides.len() as f64 * step + 22.0;
    let label = x_axis.label("time t", run.history.unit("time"));
    write_text(&mut out, LEFT + 0.5 * plot, y, "text-anchor=\"middle\"", &label);
    let spans: Vec<[f64; 2]> =
        (0..sides.len()).map(|k| 26.0 + k as f64 * step).map(|top| [top, top + HEIGHT]).collect();
    out.push_str(&time_axis((LEFT, LEFT + plot), &x_axis, &spans));
    out.push_str("</svg>\n");
    (out, cuts, stride)
}

/// The range of pressure of one colour, which a map of nearly one pressure makes look large.
fn classes(sides: &[Side], stress: &str) -> String {
    let [side] = sides else { return String::new() };
    let bands = side.bands().0;
    let step = (bands.high - bands.low) / bands.count as f64;
    // Steps are round, and have the unit of the colour bar.
    let exponent = Axis::new((bands.low, bands.high), 6.0, true).exponent;
    let (step, unit) = (number(step / 10f64.powi(exponent)), scaled(stress, exponent));
    format!(" One colour covers {step} {unit}.")
}

/// `Every second`, `Every third`, `Every 4th`.
fn every(stride: usize) -> String {
    match stride {
        2 => "Every second".to_owned(),
        3 => "Every third".to_owned(),
        n => format!("Every {n}th"),
    }
}

/// Ticks and axes of a pane at left, width, top and height.
fn frame(out: &mut String, (x_axis, y_axis): (&Axis, &Axis), [left, wide, top, high]: [f64; 4]) {
    let bottom = top + high;
    for (value, label) in &y_axis.ticks {
        let y = bottom - high * y_axis.position(*value);
        write_text(out, left - 8.0, y + 4.3, "text-anchor=\"end\" font-size=\"12\"", label);
        let _ = writeln!(out, "<path d=\"M{left} {y:.1}h-4\" stroke=\"#222\" stroke-width=\"0.8\"/>");
    }
    for (value, label) in &x_axis.ticks {
        let x = left + wide * x_axis.position(*value);
        let _ = writeln!(out, "<path d=\"M{x:.1} {bottom:.1}v5\" stroke=\"#222\" stroke-width=\"0.8\"/>");
        write_text(out, x, bottom + 18.0, "text-anchor=\"middle\" font-size=\"12\"", label);
    }
    let _ = writeln!(
        out,
        "<path d=\"M{left} {top:.1}v{high}h{wide}\" fill=\"none\" stroke=\"#222\" stroke-width=\"0.9\"/>"
    );
}

/// The coloured parts of a map: from each kept instant to the next one.
fn map(
    out: &mut String,
    side: &Side,
    kept: &[f64],
    bands: &Bands,
    (to_x, to_y): (&dyn Fn(f64) -> f64, &dyn Fn(f64) -> f64),
) {
    let cell = |(row, place): &(&ContactRow, Place)| {
        let at = kept.partition_point(|t| *t < row.time);
        (kept.get(at) == Some(&row.time)).then(|| (place.number, at, bands.of(row.pressure), place.part))
    };
    let mut rows: Vec<(usize, usize, usize, [f64; 2])> = side.rows.iter().filter_map(cell).collect();
    rows.sort_by_key(|row| (row.0, row.1));
    let mut paths = vec![Pen::default(); bands.count];
    for run in rows.chunk_by(|a, b| a.0 == b.0 && a.1 + 1 == b.1 && a.2 == b.2) {
        let (first, last) = (run[0], run[run.len() - 1].1);
        let end = kept.get(last + 1).or(kept.last()).copied().unwrap_or_default();
        let [x, right] = [kept[first.1], end].map(to_x);
        let right = right.max(x + 1.0);
        let [bottom, top] = first.3.map(to_y);
        paths[first.2].polygon(&[[x, top], [right, top], [right, bottom], [x, bottom]]);
    }
    out.push_str(&open_grid());
    for (band, pen) in paths.iter().enumerate().filter(|(_, pen)| !pen.is_empty()) {
        let (d, color) = (pen.data(), bands.color(band));
        let _ = writeln!(out, "<path d=\"{d}\" fill=\"{color}\" shape-rendering=\"crispEdges\"/>");
    }
    out.push_str("</g>\n");
}

/// The empty diagrams of the profiles for the animation, and the points of each of its frames:
/// number, arc length and pressure of the nodes of each contact.
pub(crate) fn profiles(run: &Run, frames: &[&FieldEntry]) -> Option<(String, Vec<Value>)> {
    let sides = sides(run);
    if sides.is_empty() {
        return None;
    }
    let (length, stress) = units(run);
    let mut drawn = String::new();
    for side in &sides {
        let [width, height] = SMALL;
        let (wide, high) = (width - LEFT - 14.0, height - 66.0);
        let x_axis = Axis::new(side.extent(), 6.0, true);
        // As on the map: a few peaks are cut off.
        let y_axis = Axis::new((0.0, side.bands().0.high), 2.0, false);
        let mut out = opened("chart", "Contact pressure at the instant of the animation", width, height);
        let top = 24.0;
        for (value, _) in &y_axis.ticks {
            let y = top + high * (1.0 - y_axis.position(*value));
            let _ =
                writeln!(out, "<path d=\"M{LEFT} {y:.1}h{wide}\" stroke=\"#d8d8d8\" stroke-width=\"0.6\"/>");
        }
        frame(&mut out, (&x_axis, &y_axis), [LEFT, wide, top, high]);
        write_text(&mut out, LEFT, 14.0, "font-size=\"12\"", &format!("contact pressure, “{}”", side.name));
        turned(&mut out, (17, top + 0.5 * high), "", &y_axis.label("p", &stress));
        let label = x_axis.label("arc length s", &length);
        write_text(&mut out, LEFT + 0.5 * wide, height - 8.0, "text-anchor=\"middle\"", &label);
        let _ = writeln!(
            out,
            "<g class=\"profile\" data-axis=\"{LEFT} {} {:e} {:e} {} {top} {:e} {:e}\"><path fill=\"none\" \
             stroke=\"#0072b2\" stroke-width=\"1.5\"/><path fill=\"none\" stroke=\"#0072b2\" stroke-width=\"5\" \
             stroke-linecap=\"round\"/></g>",
            LEFT + wide,
            x_axis.low,
            x_axis.high,
            top + high,
            y_axis.low,
            y_axis.high
        );
        drawn.push_str(&(out + "</svg>\n"));
    }
    let short = |x: f64| -> f64 { format!("{x:.4e}").parse().unwrap_or(0.0) };
    let points = |side: &Side, step: u64| -> Vec<f64> {
        let mut points: Vec<_> = side.rows.iter().filter(|(row, _)| row.step == step).collect();
        points.sort_by_key(|(_, place)| place.number);
        let numbers =
            |(row, place): &(&ContactRow, Place)| [place.number as f64, short(place.at), short(row.pressure)];
        points.into_iter().flat_map(numbers).collect()
    };
    let frame =
        |entry: &&FieldEntry| json!(sides.iter().map(|side| points(side, entry.step)).collect::<Vec<_>>());
    Some((drawn, frames.iter().map(frame).collect()))
}
