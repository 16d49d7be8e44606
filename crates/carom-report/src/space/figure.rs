//! Deformed solids at several instants, coloured by the stress of von Mises.

use carom_record::FieldSet;

use super::painter::{Paint, Piece, paint, pieces};
use super::raster::image;
use super::skin::{Facet, Place, places, skin};
use super::view::View;
use crate::bands::{Bands, positive_bands};
use crate::pen::Point;
use crate::quantity::stresses;
use crate::sheet::{Legend, Sheet};

/// Largest number of triangles of a figure that are drawn one by one.
pub(crate) const DRAWN: usize = 6000;
/// Room for the axes below the pictures.
const FOOT: f64 = 84.0;

/// Bounding box of facets on the page in units of length: left, right, bottom, top.
pub(crate) fn frame(skin: &[Facet], places: &[Place], view: &View) -> [f64; 4] {
    let mut frame = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY];
    for [x, y, _] in skin.iter().flat_map(|f| &f.nodes).map(|&k| view.of(places[k])) {
        frame = [frame[0].min(x), frame[1].max(x), frame[2].min(y), frame[3].max(y)];
    }
    frame
}

/// Draws pieces one by one or, if there are too many, as an image.
pub(crate) fn draw(
    out: &mut String,
    pieces: &[Piece],
    colors: (&Paint, usize),
    (corner, size): (Point, Point),
    drawn: bool,
) {
    if drawn {
        paint(out, pieces, colors.0);
    } else {
        out.push_str(&image(pieces, colors.0, colors.1, corner, size));
    }
}

/// The figure with its caption, and the bands of its colours; nothing without stresses.
pub(crate) fn instants(
    sets: &[(f64, FieldSet)],
    (time, length): (&str, &str),
    during: &str,
) -> Option<(String, String)> {
    let view = View::axonometric();
    let skin = skin(&sets.first()?.1);
    let mut list = Vec::new();
    for (t, set) in sets.iter().filter(|(_, set)| set.points.len() == sets[0].1.points.len()) {
        let [mises, _] = stresses(set)?;
        list.push((format!("t = {t:.4} {time}"), places(set), mises));
    }
    let values = list.iter().flat_map(|(_, _, mises)| {
        skin.iter().flat_map(|facet| &facet.nodes).map(|&k| mises[k]).collect::<Vec<_>>()
    });
    let (bands, cut) = positive_bands(values);
    let frames = list.iter().map(|(_, places, _)| frame(&skin, places, &view));
    let wide = frames.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1]), a[2].min(b[2]), a[3].max(b[3])])?;
    if !(wide[1] > wide[0] && wide[3] > wide[2]) {
        return None;
    }
    let mut sheet = Sheet::new("Deformed bodies with von Mises stress", list.len(), wide, FOOT);
    let seen = |(k, (_, places, mises)): (usize, &(String, Vec<Place>, Vec<f64>))| {
        pieces(&skin, places, &|_, node| mises[node], &view, &sheet.map(k), sheet.scale)
    };
    let all: Vec<Vec<Piece>> = list.iter().enumerate().map(seen).collect();
    let drawn = all.iter().map(Vec::len).sum::<usize>() <= DRAWN;
    for (k, ((heading, ..), pieces)) in list.iter().zip(&all).enumerate() {
        sheet.heading(k, heading);
        let place = sheet.picture(k);
        draw(&mut sheet.out, pieces, (&Paint::Bands(&bands), bands.count), place, drawn);
    }
    let triad = [36.0, sheet.pictures + 36.0];
    view.triad(&mut sheet.out, triad, 28.0);
    let unit = sets[0].1.array("stress")?.unit.clone();
    let svg = sheet.finish(&Legend { bands: &bands, cut, label: "σ_{vM}", unit: &unit }, length);
    Some((svg, caption(&bands, cut, &unit, during)))
}

fn caption(bands: &Bands, cut: [bool; 2], unit: &str, during: &str) -> String {
    let arrow = if cut[1] {
        format!(
            " Arrow at the colour bar: up to 0.5 % of the values are above {}{}{unit}.",
            bands.high,
            if unit.is_empty() { "" } else { " " }
        )
    } else {
        String::new()
    };
    format!(
        "Deformed bodies with von Mises stress (of nodal averages of the Cauchy stress) at instants \
         {during}. All at the same scale; displacements are not magnified. View: {}. The scale applies to \
         lengths parallel to the page.{arrow} Data: stress and displacement in the field files.",
        View::words()
    )
}
