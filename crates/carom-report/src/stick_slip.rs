//! Where nodes stick and slip: a map over time and the arc length of the secondary side, a band per
//! node, from the rows of `contact.csv`.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use carom_record::{ContactRow, Run};

use crate::axis::{Axis, range};
use crate::chart::{open, write_text};
use crate::labels::with_unit;
use crate::palette::LINES;

const WIDTH: f64 = 720.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 14.0;
const HEIGHT: f64 = 180.0;

/// The states, with their colours: slip is dark, with one colour per direction.
const STATES: [(&str, &str); 3] =
    [("sticks", LINES[6]), ("slips forward", LINES[2]), ("slips backward", LINES[0])];

/// A map of each contact that has friction, and the caption.
pub(crate) fn figure(run: &Run) -> Option<(String, String)> {
    let mut contacts: Vec<&str> = Vec::new();
    for row in run.contact.iter().filter(|row| row.friction != "none") {
        if !contacts.contains(&row.contact.as_ref()) {
            contacts.push(row.contact.as_ref());
        }
    }
    if contacts.is_empty() {
        return None;
    }
    let (first, last) = range(run.times());
    let x_axis = Axis::new((first, last), 8.0, true);
    let plot = WIDTH - LEFT - RIGHT;
    let height = contacts.len() as f64 * (HEIGHT + 44.0) + 52.0;
    let mut out = open("Stick and slip", WIDTH, height);
    for (i, (label, colour)) in STATES.iter().enumerate() {
        let x = LEFT + 150.0 * i as f64;
        let _ = writeln!(out, "<rect x=\"{x:.1}\" y=\"6\" width=\"16\" height=\"11\" fill=\"{colour}\"/>");
        write_text(&mut out, x + 22.0, 16.0, "", label);
    }
    for (k, name) in contacts.iter().enumerate() {
        let top = 40.0 + k as f64 * (HEIGHT + 44.0);
        let rows = run.contact.iter().filter(|row| row.contact == *name);
        draw(&mut out, run, name, &rows.collect::<Vec<_>>(), &x_axis, top);
        if k + 1 == contacts.len() {
            for (value, label) in &x_axis.ticks {
                let x = LEFT + plot * x_axis.position(*value);
                write_text(&mut out, x, top + HEIGHT + 19.0, "text-anchor=\"middle\"", label);
            }
            let label = with_unit("time t", run.history.unit("time"));
            write_text(&mut out, LEFT + 0.5 * plot, top + HEIGHT + 40.0, "text-anchor=\"middle\"", &label);
        }
    }
    out.push_str("</svg>\n");
    let caption = "Nodes in contact over time, along the secondary side in the reference configuration: where \
                   they stick and slip, at the recorded instants; nothing is drawn for open nodes. Data: \
                   `contact.csv`, columns `friction` and `traction`.";
    Some((out, caption.into()))
}

/// The map of one contact.
fn draw(out: &mut String, run: &Run, name: &str, rows: &[&ContactRow], x_axis: &Axis, top: f64) {
    let plot = WIDTH - LEFT - RIGHT;
    let places = arc_lengths(run, name, rows);
    let (low, high) = range(places.values());
    let y_axis = Axis::new((low, high), 4.0, false);
    let to_x = |t: f64| LEFT + plot * x_axis.position(t);
    let to_y = |s: f64| top + HEIGHT * (1.0 - y_axis.position(s));
    write_text(out, LEFT, top - 6.0, "font-size=\"12\"", name);
    let mut sorted: Vec<f64> = places.values().copied().collect();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup();
    // Half-way to the neighbours.
    let band = |s: f64| {
        let i = sorted.partition_point(|other| *other < s);
        let below = i.checked_sub(1).map_or(s, |i| 0.5 * (s + sorted[i]));
        let above = sorted.get(i + 1).map_or(s, |next| 0.5 * (s + next));
        if sorted.len() == 1 { (y_axis.low, y_axis.high) } else { (below, above) }
    };
    let times = instants(run, rows);
    for row in rows {
        let Some(s) = places.get(&row.node) else { continue };
        let state = match (row.friction.as_ref(), row.traction >= 0.0) {
            ("slip", true) => 1,
            ("slip", false) => 2,
            _ => 0,
        };
        let i = times.partition_point(|t| *t <= row.time);
        let (from, to) = (to_x(row.time), to_x(times.get(i).copied().unwrap_or(row.time)));
        let (below, above) = band(*s);
        let (y, h) = (to_y(above), to_y(below) - to_y(above));
        let _ = writeln!(
            out,
            "<rect x=\"{from:.1}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"{}\"/>",
            (to - from).max(0.5),
            h.max(0.5),
            STATES[state].1
        );
    }
    for (value, label) in &y_axis.ticks {
        write_text(out, LEFT - 8.0, to_y(*value) + 4.3, "text-anchor=\"end\"", label);
    }
    for (value, _) in &x_axis.ticks {
        let (x, y) = (to_x(*value), top + HEIGHT);
        let _ = writeln!(out, "<path d=\"M{x:.1} {y:.1}v5\" stroke=\"#222\" stroke-width=\"0.8\"/>");
    }
    let _ = writeln!(
        out,
        "<path d=\"M{LEFT} {top:.1}v{HEIGHT}h{plot}\" fill=\"none\" stroke=\"#222\" stroke-width=\"0.9\"/>"
    );
    let length = run.fields.first().and_then(|entry| run.field(entry).ok());
    let unit = length.and_then(|set| set.array("displacement").map(|array| array.unit.clone()));
    let label = with_unit("arc length s", &unit.unwrap_or_default());
    let (x, y) = (16.0, top + 0.5 * HEIGHT);
    write_text(out, x, y, &format!("text-anchor=\"middle\" transform=\"rotate(-90 {x} {y})\""), &label);
}

/// Recorded instants, from which a state lasts until the next one.
fn instants(run: &Run, rows: &[&ContactRow]) -> Vec<f64> {
    let mut times: Vec<f64> = run.fields.iter().map(|entry| entry.time).collect();
    times.extend(rows.iter().map(|row| row.time));
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

/// Arc length of each node along the secondary side in the reference configuration; its number in the
/// order of the rows for nodes of no chain.
fn arc_lengths(run: &Run, name: &str, rows: &[&ContactRow]) -> BTreeMap<u64, f64> {
    let mut places = BTreeMap::new();
    let contacts = run.manifest.case.get("contacts").and_then(|value| value.as_array());
    let of_name = |item: &&serde_json::Value| item.get("name").and_then(|v| v.as_str()) == Some(name);
    let side = contacts.into_iter().flatten().find(of_name).and_then(|item| item.get("secondary")?.as_str());
    let chains = side.and_then(|side| run.manifest.sides.get(side)).map_or(&[][..], Vec::as_slice);
    let first = run.fields.first().and_then(|entry| run.field(entry).ok());
    let mut s = 0.0;
    for chain in chains {
        let mut last: Option<[f64; 3]> = None;
        for &node in chain {
            let Some(point) = first.as_ref().and_then(|set| set.points.get(node).copied()) else { continue };
            let step = last.map_or(0.0, |last: [f64; 3]| {
                (0..3).map(|i| (point[i] - last[i]).powi(2)).sum::<f64>().sqrt()
            });
            s += step;
            places.entry(node as u64).or_insert(s);
            last = Some(point);
        }
    }
    let rubbing: std::collections::BTreeSet<u64> = rows.iter().map(|row| row.node).collect();
    places.retain(|node, _| rubbing.contains(node));
    for (i, row) in rows.iter().enumerate() {
        let end = s + i as f64;
        places.entry(row.node).or_insert(end);
    }
    places
}
