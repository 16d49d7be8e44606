//! The scene of a run in space: its skin, to be turned and played.
//!
//! The frames are the field files; nothing is interpolated. Of every node of the skin the scene has
//! the reference position, and in each frame the displacement, the stress of von Mises, the mean
//! stress and, where bodies touch, the contact pressure, as integers over their ranges. What is
//! stored is how each number differs from what the two frames before and the node before let
//! expect, compressed (RFC 1950); `scene.js` draws it.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use carom_record::{FieldEntry, Run};
use maud::{PreEscaped, html};
use serde_json::json;

use super::figure::box_around;
use super::skin::{Facet, Place, skin};
use super::view::{View, length};
use super::wires::wires;
use crate::animation::{Animation, controls, explained, help, histories, of_files, scripts, thinned, until};
use crate::bands::{Bands, color_bands, positive_bands_of};
use crate::labels::is_static;
use crate::noise::largest;
use crate::quantity::{Quantity, bars, choice, stresses};
use crate::sheet::Legend;
use crate::text::Label;

/// Largest number of bytes of the scene in the page, in base 64; frames are left out evenly to stay
/// below.
const BUDGET: usize = 7_000_000;
const FRAMES: usize = 300;
/// Largest number of nodes times frames that is tried.
const NUMBERS: usize = 3_000_000;
/// Steps of a displacement on either side of zero, of a reference position, and of a stress within
/// its bands.
const MOVED: f64 = 32_767.0;
const PLACED: f64 = 65_535.0;
const LEVELS: f64 = 500.0;

/// Nodes of a facet row by row, for small triangles between them.
const ROWS: [&[&[usize]]; 3] =
    [&[&[0, 1], &[2]], &[&[0, 3, 1], &[5, 4], &[2]], &[&[0, 3, 4, 1], &[8, 9, 5], &[7, 6], &[2]]];

/// The nodes of a skin in ascending order, the triangles between them, and the edges of cells, with
/// numbers of these nodes.
struct Surface {
    nodes: Vec<usize>,
    triangles: Vec<u32>,
    edges: Vec<u32>,
}

impl Surface {
    fn new(skin: &[Facet]) -> Self {
        let mut nodes: Vec<usize> = skin.iter().flat_map(|f| f.nodes.iter().copied()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let (mut triangles, mut edges) = (Vec::new(), Vec::new());
        for facet in skin {
            let number = |k: usize| nodes.partition_point(|n| *n < facet.nodes[k]) as u32;
            let rows = ROWS[facet.degree.clamp(1, 3) - 1];
            for (low, high) in rows.iter().zip(&rows[1..]) {
                for i in 0..high.len() {
                    triangles.extend([low[i], low[i + 1], high[i]].map(number));
                    if i + 1 < high.len() {
                        triangles.extend([low[i + 1], high[i + 1], high[i]].map(number));
                    }
                }
            }
            // Each edge belongs to two facets, which have it in opposite directions.
            for e in (0..3).filter(|&e| facet.sides[e] && facet.nodes[e] < facet.nodes[(e + 1) % 3]) {
                let walk: Vec<u32> =
                    crate::bodies::edge_nodes(facet.degree, &facet.nodes, e).map(|n| n as u32).collect();
                let number = |n: &u32| nodes.partition_point(|m| *m < *n as usize) as u32;
                edges.extend(walk.windows(2).flat_map(|w| [number(&w[0]), number(&w[1])]));
            }
        }
        Self { nodes, triangles, edges }
    }
}

/// The nodes of the skin in one frame.
struct Frame {
    moved: Vec<Place>,
    mises: Vec<f64>,
    mean: Vec<f64>,
    /// Contact pressure; empty of a record without it.
    pressure: Vec<f64>,
}

/// Everything that is drawn.
struct Scene {
    surface: Surface,
    /// Reference positions.
    places: Vec<Place>,
    frames: Vec<Frame>,
    /// Largest component of a displacement.
    largest: f64,
    mises: Colors,
    mean: Colors,
    /// None if there is no contact in any frame.
    pressure: Option<Colors>,
    displacement: Colors,
}

/// Bands of a quantity, and whether values lie below or above them.
type Colors = (Bands, [bool; 2]);

impl Scene {
    fn new(surface: Surface, places: Vec<Place>, frames: Vec<Frame>) -> Self {
        let moved = || frames.iter().flat_map(|f| &f.moved);
        let largest = largest(moved().flatten());
        let mises = positive_bands_of(frames.iter().map(|f| f.mises.iter().copied()));
        let mean = color_bands(frames.iter().flat_map(|f| f.mean.iter().copied()));
        // Few nodes of a body are in contact.
        let pressed = || frames.iter().map(|f| f.pressure.iter().copied().filter(|p| *p > 0.0));
        let pressure = pressed().flatten().next().map(|_| positive_bands_of(pressed()));
        let displacement = positive_bands_of(frames.iter().map(|f| f.moved.iter().map(|u| length(*u))));
        Self { surface, places, frames, largest, mises, mean, pressure, displacement }
    }

    /// Numbers per node and frame.
    fn channels(&self) -> usize {
        5 + usize::from(self.pressure.is_some())
    }

    /// Corners of the box of the reference positions.
    fn box_of(&self) -> [Place; 2] {
        box_around(self.places.iter().copied())
    }

    /// Corners of the box of all positions.
    fn moved_box(&self) -> [Place; 2] {
        let all = self.frames.iter().flat_map(|frame| self.places.iter().zip(&frame.moved));
        box_around(all.map(|(place, moved)| [0, 1, 2].map(|d| place[d] + moved[d])))
    }

    /// Triangles, edges, reference positions and the given frames, in base 64.
    fn packed(&self, frames: &[usize]) -> String {
        let mut bytes = Vec::new();
        for number in self.surface.triangles.iter().chain(&self.surface.edges) {
            bytes.extend(number.to_le_bytes());
        }
        let [low, high] = self.box_of();
        for d in 0..3 {
            let scale = if high[d] > low[d] { PLACED / (high[d] - low[d]) } else { 0.0 };
            put(&mut bytes, self.places.iter().map(|p| ((p[d] - low[d]) * scale).round() as u16));
        }
        let by = if self.largest > 0.0 { MOVED / self.largest } else { 0.0 };
        // Stresses that are not finite are −1.
        let level = |x: f64, bands: &Bands| {
            let share = (x - bands.low) / (bands.high - bands.low);
            if share.is_finite() { (share.clamp(0.0, 1.0) * LEVELS).round() as i16 } else { -1 }
        };
        let levels = |values: &[f64], (bands, _): &Colors| values.iter().map(|x| level(*x, bands)).collect();
        let none = vec![0i16; self.places.len()];
        let mut before = vec![[none.clone(), none.clone()]; self.channels()];
        for (k, frame) in frames.iter().map(|&k| &self.frames[k]).enumerate() {
            for channel in 0..self.channels() {
                let now: Vec<i16> = match (channel, &self.pressure) {
                    (3, _) => levels(&frame.mises, &self.mises),
                    (4, _) => levels(&frame.mean, &self.mean),
                    (5, Some(colors)) => levels(&frame.pressure, colors),
                    (d, _) => frame.moved.iter().map(|u| (u[d] * by).round() as i16).collect(),
                };
                let [last, older] = &mut before[channel];
                let mut left = 0i16;
                let differs = (0..now.len()).map(|i| {
                    // From the second frame on, displacements are extrapolated linearly.
                    let expected = if channel < 3 && k > 1 {
                        last[i].wrapping_mul(2).wrapping_sub(older[i])
                    } else {
                        last[i]
                    };
                    let error = now[i].wrapping_sub(expected);
                    let step = error.wrapping_sub(left);
                    left = error;
                    // Small numbers of either sign become small numbers.
                    ((step << 1) ^ (step >> 15)) as u16
                });
                put(&mut bytes, differs);
                *older = std::mem::replace(last, now);
            }
        }
        STANDARD.encode(miniz_oxide::deflate::compress_to_vec_zlib(&bytes, 6))
    }

    /// The numbers of the frames that fit into the page, and the packed scene.
    fn fitted(&self) -> (Vec<usize>, String) {
        let mut stride = 1;
        loop {
            let frames: Vec<usize> = thinned(self.frames.len(), stride).collect();
            let packed = self.packed(&frames);
            if packed.len() <= BUDGET || frames.len() <= 2 {
                return (frames, packed);
            }
            stride = (stride + 1).max((stride * packed.len()).div_ceil(BUDGET));
        }
    }
}

/// Adds the low bytes of numbers, then their high bytes.
fn put(bytes: &mut Vec<u8>, numbers: impl Iterator<Item = u16>) {
    let numbers: Vec<u16> = numbers.collect();
    bytes.extend(numbers.iter().map(|n| n.to_le_bytes()[0]));
    bytes.extend(numbers.iter().map(|n| n.to_le_bytes()[1]));
}

/// The nodes of a skin in a field file.
fn frame(run: &Run, entry: &FieldEntry, nodes: &[usize], points: usize) -> Option<Frame> {
    let fields = run.field(entry).ok().filter(|fields| fields.points.len() == points)?;
    let u = fields.array("displacement").filter(|a| a.components == 3)?;
    let [mises, mean] = stresses(&fields)?;
    let pressure = fields.array("contact_pressure").map_or(&[][..], |array| &array.values);
    Some(Frame {
        moved: nodes.iter().map(|&k| [0, 1, 2].map(|d| u.values[3 * k + d])).collect(),
        mises: nodes.iter().map(|&k| mises[k]).collect(),
        mean: nodes.iter().map(|&k| mean[k]).collect(),
        pressure: nodes.iter().filter_map(|&k| pressure.get(k).copied()).collect(),
    })
}

fn quantity<'a>(name: &'static str, label: &'a str, unit: &'a str, (bands, cut): &'a Colors) -> Quantity<'a> {
    Quantity { name, legend: Legend { bands, cut: *cut, label, unit } }
}

/// The section of the page, hidden until its script runs; nothing for fewer than two field files.
pub(crate) fn section(run: &Run, bands: &Bands, shades: Vec<(f64, f64)>, figure: usize) -> Option<Animation> {
    let first = run.field(run.fields.first()?).ok()?;
    let surface = Surface::new(&skin(&first));
    let most = (NUMBERS / surface.nodes.len().max(1)).min(FRAMES);
    if most < 2 {
        return None;
    }
    let chosen = thinned(run.fields.len(), run.fields.len().div_ceil(most));
    let entries: Vec<&FieldEntry> = chosen.map(|k| &run.fields[k]).collect();
    let read = |entry: &&FieldEntry| frame(run, entry, &surface.nodes, first.points.len());
    let frames: Vec<Frame> = entries.iter().map(read).collect::<Option<_>>()?;
    if frames.len() < 2 {
        return None;
    }
    let places = surface.nodes.iter().map(|&k| first.points[k]).collect();
    let mut scene = Scene::new(surface, places, frames);
    // The colours of the figure.
    let most = scene.frames.iter().flat_map(|f| &f.mises).copied().fold(0.0, f64::max);
    let Bands { low, high, count } = *bands;
    scene.mises = (Bands { low, high, count }, [false, most > high]);
    let (chosen, packed) = scene.fitted();
    let peak = |k: &usize| scene.frames[*k].mises.iter().copied().fold(0.0, f64::max);
    let start = chosen.iter().max_by(|a, b| peak(a).total_cmp(&peak(b)).then(b.cmp(a))).copied()?;
    let [stress, length] = ["stress", "displacement"].map(|array| first.unit(array));
    // As their channels are; the displacement has three of its own.
    let mut quantities = vec![
        quantity("von Mises stress", "σ_{vM}", stress, &scene.mises),
        quantity("pressure, as mean stress", "σ_{m} = −p", stress, &scene.mean),
    ];
    quantities.extend(scene.pressure.iter().map(|of| quantity("contact pressure", "p_{c}", stress, of)));
    quantities.push(quantity("displacement", "|u|", length, &scene.displacement));
    let entry = |k: &usize| {
        let entry = entries[*k];
        json!({ "time": entry.time, "step": entry.step, "file": entry.file() })
    };
    let [low, high] = scene.box_of();
    let rigid = wires(run, scene.moved_box());
    let lines: Vec<Vec<f32>> = rigid
        .iter()
        .map(|wire| wire.at_first().iter().flatten().flatten().map(|x| *x as f32).collect())
        .collect();
    let moves: Vec<Vec<Place>> =
        chosen.iter().map(|&k| rigid.iter().map(|wire| wire.moved(run, entries[k].time)).collect()).collect();
    let data = json!({
        "unit": if is_static(run) { "" } else { run.history.unit("time") }, "nodes": scene.places.len(),
        "triangles": scene.surface.triangles.len(), "edges": scene.surface.edges.len(),
        "low": low, "high": high, "largest": scene.largest, "levels": LEVELS,
        "view": View::axonometric().axes, "first": entries[start].time,
        "quantities": quantities.iter().map(Quantity::data).collect::<Vec<_>>(),
        "frames": chosen.iter().map(entry).collect::<Vec<_>>(), "packed": packed,
        "rigid": lines, "moves": moves,
    });
    let every = of_files(chosen.len(), run.fields.len());
    let last = chosen.last().map_or_else(String::new, |&k| until(run, entries[k].time));
    let explained = explained(run, &quantities, !shades.is_empty());
    let figure = html! {
        figure.animation #animation hidden {
            div.stage {
                div.scene {
                    canvas tabindex="0" aria-label="the deformed bodies; arrow keys turn them" {}
                    canvas.axes aria-hidden="true" {}
                }
                (bars(&quantities))
                div { (PreEscaped(histories(run, shades))) }
            }
            div.controls { (controls()) }
            div.controls {
                (choice(&quantities))
                label {
                    "cut "
                    select.cut {
                        option value="" { "none" }
                        @for axis in ["x", "y", "z", "−x", "−y", "−z"] { option value=(axis) { (axis) } }
                    }
                }
                input.depth type="range" min="0" max="1" step="any" value="0.5" disabled
                    aria-label="position of the cut";
                button.home type="button" { "reset" }
            }
            figcaption {
                b { "Scene." } " The bodies, initially in the view of figure " (figure) "; frames are " (every)
                ", without interpolation" (Label(&last)) ". Displacements are not magnified. " (Label("σ_{vM}"))
                " and the mean stress " (Label("σ_{m}")) " = tr σ/3 = −p, minus the pressure (blue: compression, \
                 red: tension), are those of nodal averages of the Cauchy stress. The inside of a cut body is grey."
                @if scene.pressure.is_some() {
                    " The contact pressure " (Label("p_{c}")) " is zero outside of facets in contact."
                }
                (explained)
            }
            (help(&html! {
                "Drag the bodies: turn; with the right button or Shift: move. Wheel, after a click: zoom. Touch: one \
                 finger turns, two move and zoom. Keys, after a click on the bodies: arrows turn, with Shift they \
                 move; + and −: zoom; 0: reset; comma and full stop: previous and next frame; Space: play or pause."
            }))
        }
    };
    Some(Animation { figure, scripts: scripts(&data, include_str!("scene.js")) })
}

#[cfg(test)]
mod tests {
    use super::super::skin::tests::solid;
    use super::*;

    /// A block of 20 172 triangles that falls, spins and rings for 100 frames, with the
    /// stresses of waves that travel through it: 5.39 MB, all frames included.
    #[test]
    fn twenty_thousand_triangles_and_a_hundred_frames_are_below_eight_megabytes() {
        let n = 41;
        let surface = Surface::new(&skin(&solid(1, n, |p| p)));
        assert_eq!(surface.triangles.len() / 3, 12 * n * n);
        let full = solid(1, n, |[x, y, z]| [2.0 * x, y, 0.7 * z - 0.3 * x * y]);
        let places: Vec<Place> = surface.nodes.iter().map(|&k| full.points[k]).collect();
        let frame = |k: u32| {
            let t = f64::from(k) / 100.0;
            let (sin, cos) = (40.0 * t).sin_cos();
            let ring = |p: &Place, w: f64| 0.02 * (w * p[0] + 60.0 * t).sin() * (5.0 * p[1] + w * t).cos();
            let moved = |p: &Place| {
                let q = [p[0] + ring(p, 9.0), p[1] + ring(p, 14.0), p[2] + ring(p, 23.0)];
                [
                    cos * q[0] - sin * q[2] - p[0] + 3.0 * t,
                    q[1] - p[1] - 5.0 * t * t,
                    sin * q[0] + cos * q[2] - p[2],
                ]
            };
            let wave = |p: &Place, s: f64| {
                (s * (p[0] + 0.3 * p[1]) - 90.0 * t).sin() * (-p[2]).exp()
                    + 0.3 * (37.0 * p[1] * p[2] + 50.0 * t).cos()
            };
            Frame {
                moved: places.iter().map(moved).collect(),
                mises: places.iter().map(|p| wave(p, 17.0).abs()).collect(),
                mean: places.iter().map(|p| wave(p, 11.0)).collect(),
                // It presses with one side.
                pressure: places
                    .iter()
                    .map(|p| if p[2] == 0.0 { wave(p, 5.0).max(0.0) } else { 0.0 })
                    .collect(),
            }
        };
        let scene = Scene::new(surface, places.clone(), (0..100).map(frame).collect());
        let (frames, packed) = scene.fitted();
        assert_eq!(frames.len(), 100);
        assert!(packed.len() < 6_000_000, "{}", packed.len());
        // What the page will read is what was there.
        let bytes = miniz_oxide::inflate::decompress_to_vec_zlib(&STANDARD.decode(&packed).unwrap()).unwrap();
        let count = places.len();
        let start = 4 * (scene.surface.triangles.len() + scene.surface.edges.len());
        let number = |list: usize, i: usize| {
            let at = start + 2 * list * count + i;
            u16::from_le_bytes([bytes[at], bytes[at + count]])
        };
        let channels = 6;
        assert_eq!(bytes.len(), start + 2 * count * (3 + channels * frames.len()));
        let back = |z: u16| (z >> 1) as i16 ^ -((z & 1) as i16);
        let mut history = vec![vec![0i16; count]; 2];
        for k in 0..100 {
            let mut error = 0i16;
            let next: Vec<i16> = (0..count)
                .map(|i| {
                    error = error.wrapping_add(back(number(3 + channels * k + 1, i)));
                    let (last, older) = (history[1][i], history[0][i]);
                    error.wrapping_add(if k > 1 { last.wrapping_mul(2).wrapping_sub(older) } else { last })
                })
                .collect();
            history = vec![history.pop().unwrap(), next];
            let off =
                |i: usize| f64::from(history[1][i]) * scene.largest / MOVED - scene.frames[k].moved[i][1];
            assert!((0..count).all(|i| off(i).abs() < 0.6 * scene.largest / MOVED));
        }
    }

    /// Small triangles and edges of curved facets are those of the lattice of their nodes.
    #[test]
    fn surfaces_are_closed() {
        for degree in 1..=3 {
            let surface = Surface::new(&skin(&solid(degree, 2, |p| p)));
            assert_eq!(surface.triangles.len(), 3 * 48 * degree * degree);
            assert_eq!(surface.edges.len(), 2 * 72 * degree);
            let sides: std::collections::HashSet<[u32; 2]> = surface
                .triangles
                .as_chunks::<3>()
                .0
                .iter()
                .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
                .collect();
            assert_eq!(sides.len(), surface.triangles.len());
            assert!(sides.iter().all(|&[a, b]| sides.contains(&[b, a])));
        }
    }
}
