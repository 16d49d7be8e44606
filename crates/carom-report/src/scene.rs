//! The picture of a run: its deformed bodies, to be played, turned, cut and coloured.
//!
//! Frames are field files; nothing is interpolated. The page holds the mesh once and, in each
//! frame, the displacement and as many components of the other fields as its size allows, as
//! integers over their ranges; `scene.js` draws them.

mod mesh;
mod packed;
mod quantities;

use std::collections::HashMap;

use carom_record::{FieldEntry, FieldSet, LARGEST_VON_MISES};
use maud::{Markup, html};
use serde_json::{Value, json};

use crate::bodies::{fill_space, is_plane, places};
use crate::labels::{amount, number};
use crate::noise::largest;
use crate::obstacles;
use crate::recorded::Recorded;
use crate::space::{Place, View, wires};
use crate::text::Label;
use mesh::{Mesh, symmetries};
use packed::{Frame, packed};
use quantities::Choice;

/// Largest number of bytes of the scene in the page, in base 64.
const BUDGET: usize = 7_000_000;
/// Largest number of numbers in all frames: one of each node, frame and channel.
const NUMBERS: usize = 6_000_000;
const FRAMES: usize = 300;
/// Channels beside the displacement below which frames are left out instead of fields.
const LEAST: usize = 2;
/// Largest number of contact forces in all frames.
const FORCES: usize = 60_000;

/// The scene of a page, and what was seen of the fields on the way.
pub(crate) struct Scene {
    pub(crate) figure: Markup,
    /// For the script.
    pub(crate) data: Value,
    /// The largest von Mises stress and displacement in any frame: at the nodes, and the stress at
    /// the quadrature points where that is recorded.
    pub(crate) stress: Option<Peak>,
    pub(crate) displacement: Option<Peak>,
    /// Times of the frames, and the rotation of each body in them.
    pub(crate) times: Vec<f64>,
    pub(crate) rotations: Vec<(String, Vec<f64>)>,
}

/// A largest value, with its time and unit.
pub(crate) struct Peak {
    pub(crate) value: f64,
    pub(crate) time: f64,
    pub(crate) unit: String,
}

/// The largest length of the vectors of an array.
fn largest_length(fields: &FieldSet, name: &str, time: f64) -> Option<Peak> {
    let array = fields.array(name)?;
    let vectors = array.values.chunks_exact(array.components);
    let lengths = vectors.map(|vector| vector.iter().map(|x| x * x).sum::<f64>().sqrt());
    let value = lengths.filter(|x| x.is_finite()).fold(0.0, f64::max);
    Some(Peak { value, time, unit: array.unit.clone() })
}

/// The largest von Mises stress.
fn largest_stress(fields: &FieldSet, time: f64) -> Option<Peak> {
    let Some(array) = fields.of_cells(LARGEST_VON_MISES) else {
        return largest_length(fields, "von_mises", time);
    };
    Some(Peak { value: largest(&array.values), time, unit: array.unit.clone() })
}

/// The larger one of two peaks, the first of equal ones.
fn higher(known: Option<Peak>, next: Option<Peak>) -> Option<Peak> {
    match (known, next) {
        (Some(known), Some(next)) => Some(if next.value > known.value { next } else { known }),
        (known, next) => known.or(next),
    }
}

/// Every `stride`-th of a number of frames, and the last one.
fn thinned(count: usize, stride: usize) -> impl Iterator<Item = usize> {
    (0..count).filter(move |i| i % stride.max(1) == 0 || i + 1 == count)
}

/// The rotation of the nodes of a plane body about their mean, in the sense of least squares.
pub(crate) struct Turned {
    /// Angle in degrees, up to whole turns.
    pub(crate) degrees: f64,
    /// Angular velocity in degrees per unit of time; zero where no velocities are recorded.
    pub(crate) rate: f64,
}

/// The rotation of each plane body.
fn rotations(fields: &FieldSet) -> Vec<Turned> {
    let now: Vec<[f64; 2]> = places(fields);
    let velocities = fields.array("velocity");
    let velocity = |k: usize, d: usize| velocities.map_or(0.0, |of| of.values[k * of.components + d]);
    let angle = |block: &carom_record::Block| {
        let mut nodes = block.connectivity.clone();
        nodes.sort_unstable();
        nodes.dedup();
        let mean = |of: &dyn Fn(usize) -> f64| nodes.iter().map(|&k| of(k)).sum::<f64>() / nodes.len() as f64;
        let before = [0, 1].map(|d| mean(&|k| fields.points[k][d]));
        let after = [0, 1].map(|d| mean(&|k| now[k][d]));
        let moves = [0, 1].map(|d| mean(&|k| velocity(k, d)));
        let mut across = 0.0;
        let mut along = 0.0;
        let mut turning = 0.0;
        let mut inertia = 0.0;
        for &k in &nodes {
            let a = [0, 1].map(|d| fields.points[k][d] - before[d]);
            let b = [0, 1].map(|d| now[k][d] - after[d]);
            across += a[0] * b[1] - a[1] * b[0];
            along += a[0] * b[0] + a[1] * b[1];
            let v = [0, 1].map(|d| velocity(k, d) - moves[d]);
            turning += b[0] * v[1] - b[1] * v[0];
            inertia += b[0] * b[0] + b[1] * b[1];
        }
        let rate = if inertia > 0.0 { (turning / inertia).to_degrees() } else { 0.0 };
        Turned { degrees: across.atan2(along).to_degrees(), rate }
    };
    fields.blocks.iter().filter(|block| is_plane(block)).map(angle).collect()
}

/// Angles in degrees with their whole turns: from one frame to the next, as many as the mean of
/// their rates tells.
fn continued(frames: &[&Turned], times: &[f64]) -> Vec<f64> {
    let mut angles: Vec<f64> = Vec::new();
    for (k, frame) in frames.iter().enumerate() {
        let expected = match k.checked_sub(1) {
            None => 0.0,
            Some(before) => {
                let length = times[k] - times[before];
                let rate = f64::midpoint(frames[before].rate, frame.rate);
                // Rates that change by half a turn say nothing of the time between.
                let is_steady = (frame.rate - frames[before].rate).abs() * length < 180.0;
                angles[before] + if is_steady { rate * length } else { 0.0 }
            }
        };
        angles.push(frame.degrees + 360.0 * ((expected - frame.degrees) / 360.0).round());
    }
    angles
}

/// Contact forces −λn on the secondary nodes by step: position and force in so many dimensions.
fn forces(run: &Recorded, entries: &[&FieldEntry]) -> HashMap<u64, Vec<f64>> {
    let dimension = run.case.dimension;
    let mut found: HashMap<u64, Vec<f64>> = entries.iter().map(|entry| (entry.step, Vec::new())).collect();
    let rounded = |x: f64| format!("{x:.4e}").parse().unwrap_or(0.0);
    for row in &run.contact {
        let Some(list) = found.get_mut(&row.step) else { continue };
        let force = row.normal.map(|n| -row.multiplier * n);
        if force.iter().all(|f| f.is_finite()) {
            list.extend(row.point[..dimension].iter().chain(&force[..dimension]).map(|x| rounded(*x)));
        }
    }
    let count: usize = found.values().map(Vec::len).sum();
    if count > 2 * dimension * FORCES { HashMap::new() } else { found }
}

/// Rigid obstacles in the plane: outlines with normals, and their positions in each frame.
fn rigid_in_plane(run: &Recorded, entries: &[&FieldEntry], bodies: [f64; 4]) -> (Value, [f64; 4]) {
    let all = obstacles::all(run, bodies);
    let mut frame = bodies;
    for (obstacle, entry) in
        all.iter().flat_map(|obstacle| entries.iter().map(move |entry| (obstacle, entry)))
    {
        frame = obstacle.shown_in(&obstacle.at(run, entry.time), frame, bodies);
    }
    let poses: Vec<Vec<[f64; 4]>> = entries
        .iter()
        .map(|entry| all.iter().map(|obstacle| obstacle.pose(run, entry.time)).collect())
        .collect();
    let walls: Vec<Vec<f64>> = all.iter().map(obstacles::Obstacle::base).collect();
    let marked: Vec<bool> = all.iter().map(|obstacle| obstacle.mark(run, 0.0).is_some()).collect();
    (json!({ "walls": walls, "marked": marked, "poses": poses }), frame)
}

/// Rigid obstacles in space: lines, and how they have turned and moved in each frame.
fn rigid_in_space(run: &Recorded, entries: &[&FieldEntry], bodies: [Place; 2]) -> Value {
    let all = wires(run, bodies);
    let lines: Vec<Vec<f32>> = all
        .iter()
        .map(|wire| wire.at_first().iter().flatten().flatten().map(|x| *x as f32).collect())
        .collect();
    let moves: Vec<Vec<[[f64; 4]; 3]>> =
        entries.iter().map(|entry| all.iter().map(|wire| wire.pose(run, entry.time)).collect()).collect();
    json!({ "lines": lines, "moves": moves })
}

/// Reads the scene of a run; nothing for fewer than two field files of the same points.
pub(crate) fn scene(run: &Recorded) -> Option<Scene> {
    let first = run.field(run.fields.first()?).ok()?;
    let dimension = run.case.dimension;
    let count = run.fields.len().min(FRAMES);
    let fits = |mesh: &Mesh, channels: usize| mesh.nodes.len() * count * channels <= NUMBERS;
    let with_inside = Mesh::new(run, &first, fill_space(&first));
    // The inside goes before the fields do.
    let inside = fits(&with_inside, dimension + 7);
    let mesh = if inside { with_inside } else { Mesh::new(run, &first, false) };
    if mesh.facets.is_empty() {
        return None;
    }
    let most = NUMBERS / (mesh.nodes.len() * count).max(1);
    let choice = Choice::new(run, &first, most.max(dimension + LEAST));
    let most = (NUMBERS / (mesh.nodes.len() * choice.channels.len())).clamp(2, FRAMES);
    let mut entries: Vec<&FieldEntry> =
        thinned(run.fields.len(), run.fields.len().div_ceil(most)).map(|k| &run.fields[k]).collect();
    let mut frames = Vec::new();
    let mut turned: Vec<Vec<Turned>> = Vec::new();
    let mut stress = None;
    let mut displacement = None;
    entries.retain(|entry| {
        let Some(fields) = run.field(entry).ok().filter(|fields| fields.points.len() == first.points.len())
        else {
            return false;
        };
        let values = choice.channels.iter().map(|channel| channel.values(&fields, &mesh.nodes)).collect();
        let Some(values) = values else { return false };
        frames.push(Frame { values });
        turned.push(rotations(&fields));
        stress = higher(stress.take(), largest_stress(&fields, entry.time));
        displacement = higher(displacement.take(), largest_length(&fields, "displacement", entry.time));
        true
    });
    if frames.len() < 2 {
        return None;
    }
    let places: Vec<Place> = mesh
        .nodes
        .iter()
        .zip(&mesh.across)
        .map(|(&k, y)| {
            let [x, v, z] = first.points[k];
            [x, v + y, z]
        })
        .collect();
    let mut stride = 1;
    let (chosen, pack) = loop {
        let chosen: Vec<usize> = thinned(frames.len(), stride).collect();
        let pack = packed(&mesh, &places, &frames, &chosen, dimension);
        if pack.text.len() <= BUDGET || chosen.len() <= 2 {
            break (chosen, pack);
        }
        stride = (stride + 1).max((stride * pack.text.len()).div_ceil(BUDGET));
    };
    let shown: Vec<&FieldEntry> = chosen.iter().map(|&k| entries[k]).collect();
    let [low, high] = box_of(&places, &frames, dimension);
    let mut data = pack.data;
    data["packed"] = json!(pack.text);
    data["unit"] = json!(run.time_unit());
    data["first"] = json!(stress.as_ref().map(|peak: &Peak| peak.time));
    if dimension == 3 {
        data["box"] = json!([low, high]);
        data["rigid"] = rigid_in_space(run, &shown, [low, high]);
        data["view"] = json!(View::axonometric().axes);
    } else {
        let (rigid, [x0, x1, y0, y1]) = rigid_in_plane(run, &shown, [low[0], high[0], low[1], high[1]]);
        data["box"] = json!([[x0, y0, 0.0], [x1, y1, 0.0]]);
        data["rigid"] = rigid;
        data["view"] = json!([[1, 0, 0], [0, 1, 0], [0, 0, 1]]);
    }
    let (quantities, bars): (Vec<Value>, Vec<Markup>) =
        choice.quantities.iter().map(|quantity| quantity.shown(&frames)).unzip();
    data["quantities"] = json!(quantities);
    let forces = forces(run, &shown);
    let mut largest = 0.0_f64;
    for node in forces.values().flat_map(|list| list.chunks_exact(2 * dimension)) {
        largest = largest.max(node[dimension..].iter().map(|f| f * f).sum::<f64>().sqrt());
    }
    let none = Vec::new();
    let frame = |entry: &&FieldEntry| {
        let forces = forces.get(&entry.step).unwrap_or(&none);
        json!({ "time": entry.time, "step": entry.step, "file": entry.file(), "forces": forces })
    };
    data["frames"] = json!(shown.iter().map(frame).collect::<Vec<_>>());
    data["largest"] = json!(largest);
    let mirrors = symmetries(run, &first);
    data["mirrors"] = json!(mirrors);
    let names: Vec<&str> = choice.quantities.iter().map(|quantity| quantity.name.as_str()).collect();
    let has_sides = mesh.flags.iter().any(|flag| flag >> 3 != 0);
    let tools = Tools {
        names: &names,
        is_solid: dimension == 3,
        mirrors: &mirrors,
        has_sides,
        has_forces: largest > 0.0,
    };
    let figure = html! {
        figure.animation #animation hidden {
            div.stage {
                div.scene {
                    canvas tabindex="0" aria-label="the deformed bodies" {}
                    canvas.over aria-hidden="true" {}
                }
                @for (k, bar) in bars.iter().enumerate() { div.bar hidden[k > 0] { (bar) } }
                button.full type="button" { "full screen" }
            }
            (tools.controls())
            figcaption {
                (frames_in_words(run, &shown))
                @if largest > 0.0 {
                    " Longest arrow: normal force of " (Label(&amount(largest, run.history.unit("contact_force_x")))) " at a node."
                }
                (run.projected())
                @if dimension == 3 && !inside { " The inside is not in the page, which would exceed 8 MB." }
            }
        }
    };
    let names: Vec<&str> =
        first.blocks.iter().filter(|block| is_plane(block)).map(|block| block.body.as_str()).collect();
    let times: Vec<f64> = entries.iter().map(|entry| entry.time).collect();
    let of_body = |(k, name): (usize, &&str)| {
        let frames: Vec<&Turned> = turned.iter().map(|all| &all[k]).collect();
        ((*name).to_owned(), continued(&frames, &times))
    };
    let rotations = names.iter().enumerate().map(of_body).collect();
    Some(Scene { figure, data, stress, displacement, times, rotations })
}

/// Corners of the box of all positions in all frames.
fn box_of(places: &[Place], frames: &[Frame], dimension: usize) -> [Place; 2] {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for frame in frames {
        for (i, place) in places.iter().enumerate() {
            for d in 0..3 {
                let moved = if d < dimension { f64::from(frame.values[d][i]) } else { 0.0 };
                low[d] = low[d].min(place[d] + moved);
                high[d] = high[d].max(place[d] + moved);
            }
        }
    }
    [low, high]
}

/// The sentence about the recorded instants that are played.
fn frames_in_words(run: &Recorded, shown: &[&FieldEntry]) -> String {
    let last = shown.last().map_or(0.0, |entry| entry.time);
    let ends = run.times().last().is_some_and(|end| end - last > 1e-9 * end.abs());
    let until =
        if ends { format!(", up to t = {} {}", number(last), run.time_unit()) } else { String::new() };
    let all = run.fields.len();
    let frames = if shown.len() < all { format!("{} of {all}", shown.len()) } else { all.to_string() };
    format!("{frames} recorded instants{until}; displacements are not magnified.")
        .replace(" = ", "\u{a0}=\u{a0}")
}

/// Choices below the picture.
struct Tools<'a> {
    names: &'a [&'a str],
    is_solid: bool,
    mirrors: &'a [(usize, f64)],
    has_sides: bool,
    has_forces: bool,
}

impl Tools<'_> {
    fn controls(&self) -> Markup {
        let tick = |name: &str, words: &str, on: bool| {
            html! { label { input.(name) type="checkbox" checked[on]; " " (words) } }
        };
        html! {
            div.controls {
                button.play type="button" aria-label="play or pause" { "▶" }
                input.time type="range" min="0" max="1" step="any" aria-label="time";
                output {}
                label {
                    "speed "
                    select.speed {
                        @for speed in ["0.1", "0.25", "0.5", "1", "2", "4"] {
                            option value=(speed) selected[speed == "1"] { (speed) }
                        }
                    }
                }
            }
            div.controls {
                label {
                    "colour "
                    select.quantity autocomplete="off" {
                        @for (k, name) in self.names.iter().enumerate() { option value=(k) { (name) } }
                    }
                }
                @if self.is_solid {
                    label {
                        "cut "
                        select.cut {
                            option value="" { "none" }
                            @for axis in ["x", "y", "z", "−x", "−y", "−z"] { option value=(axis) { (axis) } }
                        }
                    }
                    input.depth type="range" min="0" max="1" step="any" value="0.5" disabled
                        aria-label="position of the cut";
                    label {
                        "view "
                        select.from {
                            option value="" { "oblique" }
                            @for axis in ["x", "y", "z", "−x", "−y", "−z"] { option value=(axis) { "from " (axis) } }
                        }
                    }
                }
                @for (axis, _) in self.mirrors { (tick("mirror", &format!("mirror {}", ["x", "y", "z"][*axis]), false)) }
                (tick("mesh", "mesh", self.is_solid))
                @if self.has_sides { (tick("sides", "contact sides", self.is_solid)) }
                @if self.has_forces { (tick("arrows", "contact forces", !self.is_solid)) }
                button.home type="button" { "reset" }
            }
            details.small {
                summary { "Mouse and keys" }
                @if self.is_solid {
                    "Drag: turn; with Alt: roll; with Shift or the right button: move. "
                } @else { "Drag: move. " }
                "Wheel, after a click: zoom. One finger turns or moves, two move and zoom. Keys: arrows, + and −, 0: first \
                 view; Space: play; comma and full stop: previous and next instant."
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Turned, continued};

    /// A body that turns by 450° from one frame to the next, forwards and backwards.
    #[test]
    fn angles_go_on_beyond_whole_turns() {
        for sign in [1.0, -1.0] {
            let frame = |degrees: f64| Turned { degrees: sign * degrees, rate: sign * 360.0 };
            let frames = [frame(0.0), frame(90.0), frame(180.0), frame(-90.0)];
            let found = continued(&frames.each_ref(), &[0.0, 1.25, 2.5, 3.75]);
            assert_eq!(found, [0.0, 450.0, 900.0, 1350.0].map(|degrees| sign * degrees));
        }
    }
}
