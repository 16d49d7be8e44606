//! Maps over time and the arc length of the secondary sides of contacts, a band per node: the
//! contact pressure, and where nodes stick and slip. From the rows of `contact.csv`, in the plane.

use std::fmt::Write as _;

use carom_case::{ContactSpec, PrimarySpec};
use carom_record::ContactRow;

use crate::arc::{self, Place, places};
use crate::axis::{Axis, range};
use crate::bands::{Bands, positive_bands};
use crate::chart::{ground, opened, tick_label, time_axis, turned, write_text};
use crate::figure::{Figure, NARROW};
use crate::labels::time_name;
use crate::noise::floor;
use crate::ordered::grouped;
use crate::palette::LINES;
use crate::pen::{Pen, open_grid};
use crate::recorded::Recorded;
use crate::sheet::{Legend, color_bar};

const WIDTH: f64 = 720.0;
const LEFT: f64 = 74.0;
const HEIGHT: f64 = 190.0;
/// Height of a map with its heading and axis.
const STEP: f64 = HEIGHT + 52.0;
/// Instants in a map; more are thinned evenly.
const INSTANTS: usize = 360;

/// The rows of one contact, with the places of their nodes.
struct Side<'a> {
    name: &'a str,
    rows: Vec<(&'a ContactRow<'static>, Place)>,
    /// Whether places are lengths; otherwise nodes are counted.
    is_length: bool,
}

/// The sides of the contacts of the plane, with those rows that are chosen.
fn sides(run: &Recorded, chosen: impl Fn(&ContactRow, &Place) -> bool) -> Vec<Side<'_>> {
    if run.case.dimension != 2 {
        return Vec::new();
    }
    let mut sides = Vec::new();
    for (name, rows) in grouped(run.contact.iter().map(|row| (row.contact.as_ref(), row))) {
        let (places, is_length) = places(run, name, &rows);
        let with_place = rows.into_iter().filter_map(|row| Some((row, *places.get(&row.node)?)));
        let rows: Vec<_> = with_place.filter(|(row, place)| chosen(row, place)).collect();
        let (first, last) = range(rows.iter().flat_map(|(_, place)| &place.part));
        // A map needs a side, not a corner.
        if last > first {
            sides.push(Side { name, rows, is_length });
        }
    }
    sides
}

/// Meaning of the colours of a map.
enum Colours {
    /// Ranges of the pressure, and whether values lie outside.
    Pressure(Bands, [bool; 2]),
    /// States in words; whether slip along the tangent comes first.
    States([&'static str; 3], bool),
}

/// Colours of sticking and of slip in either direction, the first one against the tangent unless
/// flipped. The tangent is the outward
/// normal of the primary side turned by a quarter clockwise; a positive traction is the friction
/// along it on the secondary side, which then slips the other way.
const STATES: [&str; 3] = [LINES[6], LINES[2], LINES[3]];

impl Colours {
    fn of(&self, row: &ContactRow) -> usize {
        match self {
            Self::Pressure(bands, _) => bands.of(row.pressure),
            Self::States(_, flipped) if row.friction == "slip" => {
                if (row.traction >= 0.0) == *flipped {
                    2
                } else {
                    1
                }
            }
            Self::States(..) => 0,
        }
    }

    fn all(&self) -> Vec<String> {
        match self {
            Self::Pressure(bands, _) => (0..bands.count).map(|band| bands.color(band)).collect(),
            Self::States(..) => STATES.map(str::to_owned).into(),
        }
    }
}

/// Maps of several contacts below each other.
struct Maps<'a> {
    run: &'a Recorded,
    title: &'a str,
    name: &'a str,
    sides: Vec<(Side<'a>, Colours)>,
    length: String,
    stress: String,
}

/// The map of the contact pressure.
pub(crate) fn pressure(run: &Recorded) -> Option<Figure> {
    // Without field files there are neither positions nor units.
    let fields = run.field(run.fields.first()?).ok()?;
    let sides = sides(run, |row, place| place.is_secondary && row.pressure.is_finite());
    let mut table = String::from("contact,node,s,time,pressure\n");
    for (side, (row, place)) in sides.iter().flat_map(|side| side.rows.iter().map(move |row| (side, row))) {
        let _ =
            writeln!(table, "{},{},{:?},{:?},{:?}", side.name, row.node, place.at, row.time, row.pressure);
    }
    let mut coloured = Vec::new();
    for side in sides {
        let floor = floor(run, &fields, "contact_pressure");
        let (bands, cut) = positive_bands(side.rows.iter().map(|(row, _)| row.pressure), floor);
        coloured.push((side, Colours::Pressure(bands, cut)));
    }
    let maps = Maps {
        run,
        title: "Contact pressure",
        name: "pressure",
        length: fields.unit("displacement").to_owned(),
        stress: fields.unit("contact_pressure").to_owned(),
        sides: coloured,
    };
    let caption = "Contact pressure along the secondary side; s is the reference arc length. A closed side begins, for each contact, in the middle of its part without contact. Data: `contact.csv`.";
    maps.figure(caption, table)
}

/// The map of the friction.
pub(crate) fn stick_slip(run: &Recorded) -> Option<Figure> {
    // A row without traction has no direction of slip.
    let has_state =
        |row: &ContactRow| row.friction == "stick" || row.friction == "slip" && row.traction != 0.0;
    let sides = sides(run, |row, place| place.is_secondary && has_state(row));
    let words = directions(run, &sides);
    let [against, along] = words.unwrap_or(["slips backward", "slips forward"]);
    // Slip towards −x or −y has the first colour, whichever side lies above.
    let flipped = against.contains('+');
    let states = if flipped { ["sticks", along, against] } else { ["sticks", against, along] };
    let mut table = String::from("contact,node,s,time,state,traction\n");
    for (side, (row, place)) in sides.iter().flat_map(|side| side.rows.iter().map(move |row| (side, row))) {
        let node = row.node;
        let state = &row.friction;
        let _ =
            writeln!(table, "{},{node},{:?},{:?},{state},{:?}", side.name, place.at, row.time, row.traction);
    }
    let fields = run.fields.first().and_then(|entry| run.field(entry).ok()).unwrap_or_default();
    let maps = Maps {
        run,
        title: "Stick and slip",
        name: "stick-slip",
        length: fields.unit("displacement").to_owned(),
        stress: String::new(),
        sides: sides.into_iter().map(|side| (side, Colours::States(states, flipped))).collect(),
    };
    let forward =
        if words.is_some() { "" } else { "; forward: along the normal of the primary side turned clockwise" };
    let caption = format!(
        "State of the nodes in contact; slip is that of the secondary side{forward}. Data: `contact.csv`."
    );
    maps.figure(&caption, table)
}

/// The two directions of slip in words: along an axis if all normals have one direction, around a
/// rigid circle; none where the caption defines them.
fn directions(run: &Recorded, sides: &[Side]) -> Option<[&'static str; 2]> {
    let is_round =
        |contact: &ContactSpec| matches!(contact.primary, PrimarySpec::Circle { inside: false, .. });
    let mut contacts =
        run.case.contacts.iter().filter(|contact| sides.iter().any(|side| side.name == contact.name));
    if contacts.all(is_round) {
        return Some(["slips counterclockwise", "slips clockwise"]);
    }
    let is_normal = |d: usize, sign: f64| {
        sides.iter().flat_map(|side| &side.rows).all(|(row, _)| sign * row.normal[d] > 0.9)
    };
    let words = [
        (1, 1.0, ["slips towards −x", "slips towards +x"]),
        (1, -1.0, ["slips towards +x", "slips towards −x"]),
        (0, 1.0, ["slips towards +y", "slips towards −y"]),
        (0, -1.0, ["slips towards −y", "slips towards +y"]),
    ];
    words.into_iter().find(|(d, sign, _)| is_normal(*d, *sign)).map(|(.., words)| words)
}

impl Maps<'_> {
    fn figure(&self, caption: &str, table: String) -> Option<Figure> {
        if self.sides.is_empty() || self.run.times().len() < 2 {
            return None;
        }
        let pictures = [WIDTH, NARROW].map(|width| self.draw(width));
        let mut figure = Figure::new(self.name, caption, pictures).with_table(table);
        self.title.clone_into(&mut figure.title);
        Some(figure)
    }

    /// The time in contact with a margin, within the run.
    fn span(&self) -> (f64, f64) {
        let (start, end) = range(self.run.times());
        let (first, last) =
            range(self.sides.iter().flat_map(|(side, _)| &side.rows).map(|(row, _)| &row.time));
        let margin = 0.04 * (last - first).max(0.02 * (end - start));
        // A state is drawn up to the next instant.
        let next = self.run.times().iter().copied().find(|t| *t > last).unwrap_or(last);
        ((first - margin).max(start), (last + margin).max(next).min(end))
    }

    fn draw(&self, width: f64) -> String {
        let is_pressure = self.sides.iter().any(|(_, colours)| matches!(colours, Colours::Pressure(..)));
        let plot = width - LEFT - if is_pressure { 106.0 } else { 20.0 };
        let (from, to) = self.span();
        let x_axis = Axis::new((from, to), plot / 78.0, true);
        let to_x = |t: f64| LEFT + plot * x_axis.position(t);
        let head = if is_pressure { 0.0 } else { 24.0 };
        let count = self.sides.len() as f64;
        let mut out = opened("chart", self.title, width, head + count * STEP + 30.0);
        let shown: Vec<f64> = self.run.times().iter().copied().filter(|t| (from..=to).contains(t)).collect();
        let mut kept: Vec<f64> =
            shown.iter().copied().step_by(shown.len().div_ceil(INSTANTS).max(1)).collect();
        // The map ends where its last row does.
        if let Some(last) = shown.last().filter(|last| kept.last() != Some(last)) {
            kept.push(*last);
        }
        if let Some((_, Colours::States(words, _))) = self.sides.first() {
            key(&mut out, words, width);
        }
        let mut spans = Vec::new();
        for (k, (side, colours)) in self.sides.iter().enumerate() {
            let top = head + 26.0 + k as f64 * STEP;
            let bottom = top + HEIGHT;
            let y_axis = Axis::new(range(side.rows.iter().flat_map(|(_, place)| &place.part)), 6.0, true);
            let to_y = |s: f64| bottom - HEIGHT * y_axis.position(s);
            write_text(&mut out, LEFT, top - 8.0, "font-size=\"12\" font-weight=\"600\"", side.name);
            ground(&mut out, [LEFT, top, plot, HEIGHT]);
            bands(&mut out, side, colours, &kept, &to_x, &to_y);
            for (value, label) in &y_axis.ticks {
                let y = to_y(*value);
                write_text(&mut out, LEFT - 8.0, y + 4.3, "text-anchor=\"end\"", label);
                let _ = writeln!(out, "<path d=\"M{LEFT} {y:.1}h-4\" stroke=\"#222\" stroke-width=\"0.8\"/>");
            }
            for (value, label) in &x_axis.ticks {
                let x = to_x(*value);
                let _ =
                    writeln!(out, "<path d=\"M{x:.1} {bottom:.1}v5\" stroke=\"#222\" stroke-width=\"0.8\"/>");
                tick_label(&mut out, x, bottom + 19.0, label, width);
            }
            let _ = writeln!(
                out,
                "<path d=\"M{LEFT} {top:.1}v{HEIGHT}h{plot}\" fill=\"none\" stroke=\"#222\" stroke-width=\"0.9\"/>"
            );
            let (words, unit) = arc::label(side.is_length, &self.length);
            turned(&mut out, (17, top + 0.5 * HEIGHT), "", &y_axis.label(words, unit));
            if let Colours::Pressure(bands, cut) = colours {
                let legend = Legend { bands, cut: *cut, label: "p", unit: &self.stress };
                color_bar(&mut out, &legend, LEFT + plot + 20.0, (top - 4.0, bottom - 8.0));
            }
            spans.push([top, bottom]);
        }
        let label = x_axis.label(time_name(self.run), self.run.time_unit());
        let y = head + count * STEP + 22.0;
        write_text(&mut out, LEFT + 0.5 * plot, y, "text-anchor=\"middle\"", &label);
        out.push_str(&time_axis((LEFT, LEFT + plot), &x_axis, &spans, ""));
        out + "</svg>\n"
    }
}

/// The colours of the states.
fn key(out: &mut String, words: &[&str; 3], width: f64) {
    for (k, (word, colour)) in words.iter().zip(STATES).enumerate() {
        let x = if width < WIDTH { 8.0 } else { LEFT } + [0.0, 80.0, 260.0][k];
        let _ = writeln!(out, "<rect x=\"{x:.1}\" y=\"6\" width=\"16\" height=\"11\" fill=\"{colour}\"/>");
        write_text(out, x + 22.0, 16.0, "", word);
    }
}

/// The coloured parts of a map: from each kept instant to the next one.
fn bands(
    out: &mut String,
    side: &Side,
    colours: &Colours,
    kept: &[f64],
    to_x: &dyn Fn(f64) -> f64,
    to_y: &dyn Fn(f64) -> f64,
) {
    let cell = |(row, place): &(&ContactRow, Place)| {
        let at = kept.partition_point(|t| *t < row.time);
        (kept.get(at) == Some(&row.time)).then(|| (place.number, at, colours.of(row), place.part))
    };
    let mut rows: Vec<(usize, usize, usize, [f64; 2])> = side.rows.iter().filter_map(cell).collect();
    rows.sort_by_key(|row| (row.0, row.1));
    let all = colours.all();
    let mut paths = vec![Pen::default(); all.len()];
    for run in rows.chunk_by(|a, b| a.0 == b.0 && a.1 + 1 == b.1 && a.2 == b.2) {
        let first = run[0];
        let last = run[run.len() - 1].1;
        let end = kept.get(last + 1).or(kept.last()).copied().unwrap_or_default();
        let [x, right] = [kept[first.1], end].map(to_x);
        let right = right.max(x + 1.0);
        let [bottom, top] = first.3.map(to_y);
        paths[first.2].polygon(&[[x, top], [right, top], [right, bottom], [x, bottom]]);
    }
    out.push_str(&open_grid());
    for (pen, color) in paths.iter().zip(&all).filter(|(pen, _)| !pen.is_empty()) {
        let _ = writeln!(out, "<path d=\"{}\" fill=\"{color}\" shape-rendering=\"crispEdges\"/>", pen.data());
    }
    out.push_str("</g>\n");
}
