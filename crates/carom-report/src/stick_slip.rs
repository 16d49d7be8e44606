//! Where nodes stick and slip: a map over time and the arc length of the secondary side, a band per
//! node, from the rows of `contact.csv`.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use carom_record::{ContactRow, Run};
use serde_json::Value;

use crate::arc::{self, places};
use crate::axis::{Axis, range};
use crate::chart::{ground, opened, time_axis, write_text};
use crate::figure::{Figure, NARROW};
use crate::ordered::distinct;
use crate::palette::LINES;
use crate::text::said_if;
use crate::values::{is_in_space, list, text};

const WIDTH: f64 = 720.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 14.0;
const HEIGHT: f64 = 180.0;

/// The colours of the states: sticks, slips against the tangent, slips along it. The tangent is the
/// outward normal of the primary side turned by a quarter clockwise; a positive traction is the
/// friction along it on the secondary side, which then slips the other way.
const COLOURS: [&str; 3] = [LINES[6], LINES[2], LINES[3]];

/// The two directions of slip in words: along an axis if the normals of all contacts have one
/// direction, around a rigid circle, or else by a definition in the caption.
fn directions(run: &Run, contacts: &[&str]) -> Option<[&'static str; 2]> {
    let case = list(&run.manifest.case, "contacts");
    let is_round = |name: &&str| {
        let contact = case.iter().find(|contact| text(contact, "name") == *name);
        let circle = contact.and_then(|contact| contact.pointer("/primary/circle"));
        circle.is_some_and(|circle| circle.get("inside").and_then(Value::as_bool) != Some(true))
    };
    if contacts.iter().all(is_round) {
        return Some(["slips counterclockwise", "slips clockwise"]);
    }
    let rows = || run.contact.iter().filter(|row| row.friction != "none");
    let is_normal = |d: usize, sign: f64| rows().all(|row| sign * row.normal[d] > 0.9);
    let words = [
        (1, 1.0, ["slips towards −x", "slips towards +x"]),
        (1, -1.0, ["slips towards +x", "slips towards −x"]),
        (0, 1.0, ["slips towards +y", "slips towards −y"]),
        (0, -1.0, ["slips towards −y", "slips towards +y"]),
    ];
    words.into_iter().find(|(d, sign, _)| is_normal(*d, *sign)).map(|(.., words)| words)
}

/// A map of each contact that has friction. A side in space has no arc length.
pub(crate) fn figure(run: &Run) -> Option<Figure> {
    if is_in_space(&run.manifest.case) {
        return None;
    }
    let rubbing = run.contact.iter().filter(|row| row.friction != "none");
    let contacts = distinct(rubbing.map(|row| row.contact.as_ref()));
    if contacts.is_empty() {
        return None;
    }
    let words = directions(run, &contacts);
    let [against, along] = words.unwrap_or(["slips backward", "slips forward"]);
    let pictures = [WIDTH, NARROW].map(|width| picture(run, &contacts, [against, along], width));
    let is_length = !run.fields.is_empty();
    let counted =
        said_if(!is_length, " Nodes are numbered along the side, because no field file has their positions.");
    let forward = "; forward: along the outward normal of the primary side turned by a quarter clockwise";
    let forward = said_if(words.is_none(), forward);
    let caption = format!(
        "Nodes in contact over time, along the secondary side in the reference configuration: where they \
         stick and slip, at the recorded steps; one band per node, grey where it is not in contact.{counted} Slip: \
         motion of the secondary side relative to the primary{forward}. Data: `contact.csv`, columns `friction` and `traction`."
    );
    Some(Figure::new("stick-slip", caption, pictures).with_table(table(run, &contacts)))
}

/// The maps as a picture of a width; the other argument is the two directions of slip in words.
fn picture(run: &Run, contacts: &[&str], [against, along]: [&str; 2], width: f64) -> String {
    let (first, last) = range(run.times());
    let x_axis = Axis::new((first, last), 8.0, true);
    let plot = width - LEFT - RIGHT;
    let height = contacts.len() as f64 * (HEIGHT + 44.0) + 52.0;
    let mut out = opened("chart", "Stick and slip", width, height);
    for (i, (label, colour)) in ["sticks", against, along].iter().zip(COLOURS).enumerate() {
        let x = if width < WIDTH { 8.0 } else { LEFT } + [0.0, 80.0, 270.0][i];
        let _ = writeln!(out, "<rect x=\"{x:.1}\" y=\"6\" width=\"16\" height=\"11\" fill=\"{colour}\"/>");
        write_text(&mut out, x + 22.0, 16.0, "", label);
    }
    for (k, name) in contacts.iter().enumerate() {
        let top = 40.0 + k as f64 * (HEIGHT + 44.0);
        let rows = run.contact.iter().filter(|row| row.contact == *name);
        draw(&mut out, run, (name, &rows.collect::<Vec<_>>()), &x_axis, (top, width));
        if k + 1 == contacts.len() {
            for (value, label) in &x_axis.ticks {
                let x = LEFT + plot * x_axis.position(*value);
                write_text(&mut out, x, top + HEIGHT + 19.0, "text-anchor=\"middle\"", label);
            }
            let label = x_axis.label("time t", run.history.unit("time"));
            write_text(&mut out, LEFT + 0.5 * plot, top + HEIGHT + 40.0, "text-anchor=\"middle\"", &label);
        }
    }
    let tops = (0..contacts.len()).map(|k| 40.0 + k as f64 * (HEIGHT + 44.0));
    let spans: Vec<[f64; 2]> = tops.map(|top| [top, top + HEIGHT]).collect();
    out.push_str(&time_axis((LEFT, LEFT + plot), &x_axis, &spans));
    out.push_str("</svg>\n");
    out
}

/// What the maps show.
fn table(run: &Run, contacts: &[&str]) -> String {
    let mut out = String::from("contact,node,s,time,state,traction\n");
    for name in contacts {
        let rows: Vec<&ContactRow> = run.contact.iter().filter(|row| row.contact == *name).collect();
        let (places, _) = places(run, name, &rows);
        for row in rows {
            let Some(place) = places.get(&row.node) else { continue };
            let (node, state) = (row.node, &row.friction);
            let _ = writeln!(out, "{name},{node},{:?},{:?},{state},{:?}", place.at, row.time, row.traction);
        }
    }
    out
}

/// The map of one contact.
fn draw(
    out: &mut String,
    run: &Run,
    (name, rows): (&str, &[&ContactRow]),
    x_axis: &Axis,
    (top, width): (f64, f64),
) {
    let plot = width - LEFT - RIGHT;
    let (places, is_length) = places(run, name, rows);
    let y_axis = Axis::new(range(places.values().flat_map(|place| &place.part)), 4.0, true);
    let to_x = |t: f64| LEFT + plot * x_axis.position(t);
    let to_y = |s: f64| top + HEIGHT * (1.0 - y_axis.position(s));
    write_text(out, LEFT, top - 6.0, "font-size=\"12\"", name);
    let times = instants(run, rows);
    let next = |time: f64| times.get(times.partition_point(|t| *t <= time)).copied().unwrap_or(time);
    let mut of_nodes: BTreeMap<u64, Vec<(f64, f64, usize)>> = BTreeMap::new();
    for row in rows {
        let state = match (row.friction.as_ref(), row.traction >= 0.0) {
            ("slip", true) => 1,
            ("slip", false) => 2,
            _ => 0,
        };
        let spans = of_nodes.entry(row.node).or_default();
        match spans.last_mut() {
            // The same state continues.
            Some(last) if last.1 >= row.time && last.2 == state => last.1 = next(row.time),
            _ => spans.push((row.time, next(row.time), state)),
        }
    }
    ground(out, [LEFT, top, plot, HEIGHT]);
    for (node, spans) in &of_nodes {
        let Some([below, above]) = places.get(node).map(|place| &place.part) else { continue };
        // Edges at whole tenths, which neighbours share: a gap would read as an open node.
        let [y, end] = [above, below].map(|s| (10.0 * to_y(*s)).round() / 10.0);
        let h = end - y;
        for (from, to, state) in spans {
            let (x, w) = (to_x(*from), to_x(*to) - to_x(*from));
            let _ = writeln!(
                out,
                "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"{h:.1}\" fill=\"{}\" shape-rendering=\"crispEdges\"/>",
                w.max(0.5),
                COLOURS[*state]
            );
        }
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
    let unit = length(run);
    let (words, unit) = arc::label(is_length, &unit);
    let label = y_axis.label(words, unit);
    let (x, y) = (16.0, top + 0.5 * HEIGHT);
    write_text(out, x, y, &format!("text-anchor=\"middle\" transform=\"rotate(-90 {x} {y})\""), &label);
}

/// The unit of length.
fn length(run: &Run) -> String {
    let first = run.fields.first().and_then(|entry| run.field(entry).ok()).unwrap_or_default();
    first.unit("displacement").to_owned()
}

/// Recorded instants, from which a state lasts until the next one.
fn instants(run: &Run, rows: &[&ContactRow]) -> Vec<f64> {
    let mut times: Vec<f64> = run.fields.iter().map(|entry| entry.time).collect();
    times.extend(rows.iter().map(|row| row.time));
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}
