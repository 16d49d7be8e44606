//! Animation of a run: deformed bodies coloured by stress, contact forces as arrows, and time
//! histories with a cursor.
//!
//! The frames are the field files; nothing is interpolated. Positions and stresses are stored as
//! 16-bit integers over their range (a 65 000th of the width of the picture), the mesh only once;
//! `animation.js` draws them with the colours of the figure `bodies`, or of the von Mises stress.

use std::collections::HashMap;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use carom_record::{Block, Cell, FieldEntry, FieldSet, Run};
use maud::{Markup, PreEscaped, html};
use serde_json::{Value, json};

use crate::bands::{Bands, color_bands, positive_bands_of};
use crate::bodies::{Instant, frame, triangles};
use crate::chart::{Chart, Options, Panel, Series};
use crate::labels::{amount, is_static, number, symbol, time_label};
use crate::noise;
use crate::obstacles;
use crate::ordered::grouped;
use crate::over_time::{of_probes, panel, tracks};
use crate::palette::LINES;
use crate::pen::Point;
use crate::pressure;
use crate::quantity::{Quantity, bars, choice, stresses};
use crate::scientific::significant;
use crate::sheet::{Legend, arrowheads};
use crate::text::{Label, Prose};
use crate::values::{self, list, text};

/// Largest number of bytes of positions and stresses in the page; field files are skipped evenly to
/// stay below.
const BUDGET: usize = 3_200_000;
const FRAMES: usize = 300;
/// Play, pause, slider and cursors, for all animations.
const PLAYER: &str = include_str!("player.js");

/// An animation; its scripts come after all figures of the page, whose time histories they use.
#[derive(Clone, Debug)]
pub(crate) struct Animation {
    pub(crate) figure: Markup,
    pub(crate) scripts: Markup,
}

/// The bodies in one frame; bars are drawn as strips.
pub(crate) fn instant(fields: &FieldSet, time: String) -> Option<Instant> {
    if fields.blocks.iter().all(|b| b.cell == Cell::Curve) {
        strip(fields, time)
    } else {
        Instant::new(fields, "stress", 1, time)
    }
}

/// Bars as strips of triangles around the x axis, with σ_xx.
fn strip(fields: &FieldSet, time: String) -> Option<Instant> {
    let stress = fields.array("stress").filter(|a| a.components == 6)?;
    let u = fields.array("displacement").filter(|a| a.components == 3)?;
    let reference = |k: usize| fields.points[k][0];
    let xs: Vec<f64> = (0..fields.points.len()).map(reference).collect();
    let (low, high) = crate::axis::range(&xs);
    let half = 0.03 * (high - low);
    let n = fields.points.len();
    let side = |s: f64| (0..n).map(move |k| [reference(k) + u.values[3 * k], s * half]);
    let values: Vec<f64> = (0..n).map(|k| stress.values[6 * k]).collect();
    let mut cells = Vec::new();
    for cell in fields.blocks.iter().flat_map(Block::cells) {
        let mut walk = cell.to_vec();
        walk.sort_by(|&a, &b| reference(a).total_cmp(&reference(b)));
        for w in walk.windows(2) {
            cells.extend([(1, vec![w[0], w[1], w[1] + n]), (1, vec![w[0], w[1] + n, w[0] + n])]);
        }
    }
    Some(Instant {
        time,
        points: side(-1.0).chain(side(1.0)).collect(),
        values: [&values[..], &values].concat(),
        cells,
    })
    .filter(|i| !i.cells.is_empty())
}

/// Values as 16-bit integers over a range, in base 64; the smallest integer stands for a value that
/// is not finite.
fn packed<'a>(values: impl Iterator<Item = &'a f64>, (low, high): (f64, f64)) -> String {
    let scale = if high > low { 65534.0 / (high - low) } else { 0.0 };
    let integer =
        |x: &f64| if x.is_finite() { ((x - low) * scale - 32767.0).round() as i16 } else { i16::MIN };
    STANDARD.encode(values.flat_map(|x| integer(x).to_le_bytes()).collect::<Vec<u8>>())
}

/// Contact forces −λn on the secondary nodes by step: x, y, fx, fy.
fn forces(run: &Run) -> HashMap<u64, Vec<[f64; 4]>> {
    let mut found: HashMap<u64, Vec<[f64; 4]>> = HashMap::new();
    for row in &run.contact {
        let f = row.normal.map(|n| -row.multiplier * n);
        if f.iter().all(|f| f.is_finite()) {
            found.entry(row.step).or_default().push([row.point[0], row.point[1], f[0], f[1]]);
        }
    }
    found
}

/// Time histories beside the picture: contact force (its label is short, for a low panel), then the
/// probes.
pub(crate) fn histories(run: &Run, shades: Vec<(f64, f64)>) -> String {
    let h = &run.history;
    // In the plane y, as in the figures; in space the component that grows largest.
    let peak = |name: &str| h.column(name).map(noise::largest);
    let candidates = ["contact_force_x", "contact_force_y", "contact_force_z"];
    let present = || candidates.into_iter().enumerate().filter_map(|(i, name)| Some((i, peak(name)?)));
    let axis = match present().count() {
        3 => present().fold((0, -1.0), |most, next| if next.1 > most.1 { next } else { most }).0,
        count => count.saturating_sub(1),
    };
    let force = candidates[axis];
    let mut panels: Vec<Panel> = Vec::new();
    let label = ["f_{x}", "f_{y}", "f_{z}"][axis];
    let low = |label: &str, unit: &str, series| panel(label, unit, 96.0, series);
    if let Some(y) = h.column(force) {
        let series = Series { color: LINES[0], x: run.times(), y: y.to_vec(), ..Series::default() };
        panels.push(low(&format!("force {label}"), h.unit(force), vec![series]));
    }
    let room = 5 - panels.len();
    for (quantity, members) in grouped(of_probes(run)).into_iter().take(room) {
        let unit = &members[0].0.unit;
        panels.push(low(&symbol(quantity), unit, members.into_iter().map(|(_, series)| series).collect()));
    }
    // A force that is zero throughout needs no panel, unless there is no other for the cursor.
    if panels.len() > 1 && panels[0].label.starts_with("force") && noise::is_noise(run, force) {
        panels.remove(0);
    }
    let x_label = time_label(run);
    let chart = Chart { title: "Time histories beside the animation", x_label, shades, panels };
    chart.draw(&Options { width: 470.0, tracks: &tracks(run), time: true })
}

/// Rigid planes: a point, which in 1D is that at a recorded time, and the normal out of the rigid
/// body.
fn planes(run: &Run, flat: bool, time: f64) -> Vec<[Point; 2]> {
    let at = |contact: &Value| {
        let plane = contact.pointer("/primary/plane")?;
        let [p, n] = ["point", "normal"].map(|key| values::flat(plane.get(key)));
        if !flat {
            return Some([p, n]);
        }
        let name = text(contact, "name");
        let place = obstacles::recorded(run, &format!("{name}.center_x"), time);
        Some([[place.unwrap_or(p[0]), 0.0], [n[0], 0.0]])
    };
    list(&run.manifest.case, "contacts").iter().filter_map(at).collect()
}

/// Field files that are used as frames, of which each has so many numbers.
fn chosen(run: &Run, numbers: usize) -> Vec<&FieldEntry> {
    // Two bytes are 8/3 characters in base 64.
    let most = (3 * BUDGET / (8 * numbers.max(1))).clamp(2, FRAMES);
    thinned(run.fields.len(), run.fields.len().div_ceil(most)).map(|i| &run.fields[i]).collect()
}

/// Every `stride`-th of a number of frames, and the last one.
pub(crate) fn thinned(count: usize, stride: usize) -> impl Iterator<Item = usize> {
    (0..count).filter(move |i| i % stride.max(1) == 0 || i + 1 == count)
}

/// Two digits of a force, with a prefix only where it is far from one.
fn size(x: f64, unit: &str) -> String {
    if (0.01..1000.0).contains(&x) { format!("{} {unit}", significant(x, 2)) } else { amount(x, unit) }
}

/// The end of the captions: what arrowheads of the colour bars, shades, the line and ticks mean.
pub(crate) fn explained(run: &Run, quantities: &[Quantity], shaded: bool) -> Markup {
    html! {
        (Label(&arrowheads(quantities.iter().map(|q| (q.legend.cut, q.legend.label.to_owned())))))
        @if shaded { " Shaded: contact." }
        " Vertical line, here and in the figures below: the instant shown."
        @if !run.log.is_empty() { (Prose(" Ticks below the histories: events in `log.jsonl`.")) }
    }
}

/// The data of an animation, and the scripts that draw and play it.
pub(crate) fn scripts(data: &Value, script: &str) -> Markup {
    // Only `<` could end the script element.
    let data = data.to_string().replace('<', "\\u003c");
    html! {
        script #animation-data type="application/json" { (PreEscaped(data)) }
        script { (PreEscaped(PLAYER)) (PreEscaped(script)) }
    }
}

/// How many of the field files are frames.
pub(crate) fn of_files(frames: usize, files: usize) -> String {
    if frames < files {
        format!("{frames} of the {files} field files")
    } else {
        format!("all {files} field files")
    }
}

/// The time of the last frame, as a part of a sentence, where the record goes on after it.
pub(crate) fn until(run: &Run, last: f64) -> String {
    let ends = run.times().last().is_some_and(|end| end - last > 1e-9 * end.abs());
    let unit = run.history.unit("time");
    if ends { format!("; the last is at {} {unit}", number(last)) } else { String::new() }
}

/// How an animation is controlled; folded, because it is no part of what is shown.
pub(crate) fn help(keys: &Markup) -> Markup {
    html! {
        details.small {
            summary { "Controls" }
            (keys)
            " At speed 1 the whole run takes 8 s. The line in the time histories of this page is at the instant \
             shown; a click in one goes to that instant, a drag across one enlarges all of them, and a double click or \
             Esc shows the whole time again."
        }
    }
}

/// Play, time, what is shown, and speed; the first controls of an animation.
pub(crate) fn controls() -> Markup {
    html! {
        button type="button" aria-label="play or pause" { "▶" }
        input type="range" min="0" max="1" step="any" aria-label="time";
        output {}
        label {
            "speed "
            select {
                @for speed in ["0.1", "0.25", "0.5", "1", "2", "4"] {
                    option value=(speed) selected[speed == "1"] { (speed) }
                }
            }
        }
    }
}

/// The animation, hidden until its script runs; nothing for fewer than two field files.
pub(crate) fn section(run: &Run, bands: &Bands, shades: Vec<(f64, f64)>, figure: usize) -> Option<Animation> {
    let first = run.field(run.fields.first()?).ok()?;
    let flat = first.blocks.iter().all(|b| b.cell == Cell::Curve);
    // A node of a bar is two points with a stress; one of the plane has two stresses and a
    // pressure.
    let entries = chosen(run, if flat { 6 } else { 5 } * first.points.len());
    let read = |entry: &FieldEntry| {
        let fields = run.field(entry).ok()?;
        let [mises, _] = stresses(&fields)?;
        let none = || vec![0.0; fields.points.len()];
        let pressure = fields.array("contact_pressure").map_or_else(none, |array| array.values.clone());
        Some(((entry.clone(), instant(&fields, String::new())?), (mises, pressure)))
    };
    let (frames, colors): (Vec<(FieldEntry, Instant)>, Vec<_>) =
        entries.iter().filter_map(|e| read(e)).unzip();
    let (mises, pressure): (Vec<Vec<f64>>, Vec<Vec<f64>>) = colors.into_iter().unzip();
    let of_cell = |(degree, nodes): &(usize, Vec<usize>)| {
        let degree = *degree;
        triangles(nodes).into_iter().map(move |half| (degree, half))
    };
    let cells: Vec<_> = frames.first()?.1.cells.iter().flat_map(of_cell).collect();
    if frames.len() < 2 || frames.iter().any(|(_, i)| i.points.len() != frames[0].1.points.len()) {
        return None;
    }
    let [mut x0, mut x1, y0, y1] = frame(frames.iter().map(|f| &f.1));
    let fixed = planes(run, flat, 0.0);
    for p in frames.iter().filter(|_| flat).flat_map(|(entry, _)| planes(run, flat, entry.time)) {
        (x0, x1) = (x0.min(p[0][0]), x1.max(p[0][0]));
    }
    let [mut y0, mut y1] = [y0, y1];
    let bodies = [x0, x1, y0, y1];
    let surfaces = if flat { Vec::new() } else { obstacles::all(run, bodies) };
    let planes_move = surfaces.iter().any(|obstacle| obstacle.is_plane && obstacle.moves(run));
    let surfaces: Vec<_> = surfaces.iter().filter(|obstacle| !obstacle.is_plane || planes_move).collect();
    for (obstacle, (entry, _)) in surfaces.iter().flat_map(|o| frames.iter().map(move |f| (o, f))) {
        [x0, x1, y0, y1] = obstacle.shown_in(&obstacle.at(run, entry.time), [x0, x1, y0, y1], bodies);
    }
    let fixed = if planes_move { Vec::new() } else { fixed };
    let walls: Vec<_> = surfaces.iter().map(|obstacle| obstacle.base()).collect();
    let values: Vec<f64> = frames.iter().flat_map(|(_, i)| i.values.iter().copied()).collect();
    let range = crate::axis::range(&values);
    let own = color_bands(values.iter().copied()).0;
    let bands = if flat { &own } else { bands };
    let cut = [range.0 < bands.low, range.1 > bands.high];
    let unit = first.unit("stress");
    let label = if flat { "σ_{xx}" } else { "σ_{yy}" };
    let along = Quantity {
        name: if flat { "axial stress" } else { "vertical stress" },
        legend: Legend { bands, cut, label, unit },
    };
    let (of_mises, beyond) = positive_bands_of(mises.iter().map(|values| values.iter().copied()));
    // Few nodes of a body are in contact.
    let pressed = || pressure.iter().map(|values| values.iter().copied().filter(|p| *p > 0.0));
    let (of_pressure, above) = positive_bands_of(pressed());
    let has_contact = pressed().flatten().next().is_some();
    let others = [
        ("von Mises stress", Legend { bands: &of_mises, cut: beyond, label: "σ_{vM}", unit }, true),
        ("contact pressure", Legend { bands: &of_pressure, cut: above, label: "p_{c}", unit }, has_contact),
    ];
    // In a bar von Mises is the absolute value of the axial stress but for a factor, and ends are
    // points.
    let others = others.into_iter().filter(|(_, _, offered)| *offered && !flat);
    let others = others.map(|(name, legend, _)| Quantity { name, legend });
    let quantities: Vec<Quantity> = std::iter::once(along).chain(others).collect();
    let [mises, pressure] = [mises.concat(), pressure.concat()];
    let data_of = |(quantity, values): (&Quantity, &Vec<f64>)| {
        let mut data = quantity.data();
        let range = crate::axis::range(values);
        data["range"] = json!([range.0, range.1]);
        data["values"] = json!(packed(values.iter(), range));
        data
    };
    let coordinates = |d: usize| frames.iter().flat_map(move |(_, i)| i.points.iter().map(move |p| &p[d]));
    let forces = forces(run);
    let largest = forces.values().flatten().map(|f| f[2].hypot(f[3])).fold(0.0, f64::max);
    let shown: Vec<&FieldEntry> = frames.iter().map(|(entry, _)| entry).collect();
    let (profiles, pressures) = pressure::profiles(run, &shown).filter(|_| !flat).unwrap_or_default();
    let frame_of = |(k, (entry, _)): (usize, &(FieldEntry, Instant))| {
        let list: Vec<f64> = forces.get(&entry.step).into_iter().flatten().flatten().copied().collect();
        let rounded: Vec<f64> = list.iter().map(|x| format!("{x:.5e}").parse().unwrap_or(0.0)).collect();
        json!({ "time": entry.time, "step": entry.step, "file": entry.file(), "forces": rounded,
                "pressure": pressures.get(k),
                "planes": if flat { planes(run, flat, entry.time) } else { Vec::new() },
                "poses": surfaces.iter().map(|obstacle| obstacle.pose(run, entry.time)).collect::<Vec<_>>() })
    };
    let numbers: Vec<u8> =
        cells.iter().flat_map(|(_, n)| n.iter().flat_map(|k| (*k as u32).to_le_bytes())).collect();
    let data = json!({
        "unit": if is_static(run) { "" } else { run.history.unit("time") }, "box": [x0, x1, y0, y1],
        "points": frames[0].1.points.len(), "frames": frames.iter().enumerate().map(frame_of).collect::<Vec<_>>(),
        "degrees": cells.iter().map(|(d, _)| d.to_string()).collect::<String>(),
        "cells": STANDARD.encode(numbers),
        "x": packed(coordinates(0), (x0, x1)), "y": packed(coordinates(1), (y0, y1)),
        "quantities": quantities.iter().zip([&values, &mises, &pressure]).map(data_of).collect::<Vec<_>>(),
        "largest": largest, "planes": fixed, "walls": walls, "flat": flat,
        "marked": surfaces.iter().map(|obstacle| obstacle.mark(run, 0.0).is_some()).collect::<Vec<_>>(),
    });
    let every = of_files(entries.len(), run.fields.len());
    let last = frames.last().map_or_else(String::new, |(entry, _)| until(run, entry.time));
    let explained = explained(run, &quantities, !shades.is_empty());
    let figure = html! {
        figure.animation #animation hidden {
            div.stage {
                canvas {}
                (bars(&quantities))
                div { (PreEscaped(histories(run, shades))) (PreEscaped(profiles)) }
            }
            div.controls {
                (controls())
                @if quantities.len() > 1 { (choice(&quantities)) }
            }
            figcaption {
                b { "Animation." } " " (Label(label))
                @if flat { " in colour" } @else {
                    " in the colours of figure " (figure) ", or " (Label("σ_{vM}"))
                    " (of nodal averages of the Cauchy stress)"
                }
                "; frames are " (every) ", without interpolation" (Label(&last)) "."
                @if largest > 0.0 {
                    (Prose(" Arrows: contact forces on the secondary nodes (`contact.csv`); the longest is "))
                    (Label(&size(largest, run.history.unit("contact_force_x")))) "."
                }
                (explained)
            }
            (help(&html! {
                "Keys, after a click on the animation: Space: play or pause; ← and → (or comma and full stop): previous and \
                 next frame."
            }))
        }
    };
    Some(Animation { figure, scripts: scripts(&data, include_str!("animation.js")) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packing_keeps_five_digits() {
        let values = [-3.0, 0.25, 5.0, f64::NAN];
        let bytes = STANDARD.decode(packed(values.iter(), (-3.0, 5.0))).unwrap();
        let back: Vec<i16> = bytes.as_chunks::<2>().0.iter().map(|b| i16::from_le_bytes(*b)).collect();
        assert_eq!((back[0], back[2], back[3]), (-32767, 32767, i16::MIN));
        let x = -3.0 + 8.0 * (f64::from(back[1]) + 32767.0) / 65534.0;
        assert!((x - 0.25).abs() < 1e-4);
    }
}
