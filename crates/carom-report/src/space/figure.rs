//! Deformed solids at several instants, coloured by the stress of von Mises.

use carom_record::FieldSet;

use super::pieces::{Paint, pieces};
use super::raster::image;
use super::skin::{Facet, Place, skin};
use super::view::View;
use super::wires::wires;
use crate::bands::positive_bands;
use crate::bodies::places;
use crate::labels::instant_label;
use crate::noise::floor;
use crate::pen::{GRID, NOTHING, Pen, Point, around, path};
use crate::recorded::Recorded;
use crate::sheet::{Legend, Sheet};

/// Room for the axes below the pictures.
const FOOT: f64 = 84.0;
/// Colour and width of the lines on rigid obstacles.
const RIGID: &str = "#b9b4ab";
const THIN: f64 = 0.7;

/// Bounding box of facets on the page in units of length: left, right, bottom, top.
fn frame(skin: &[Facet], places: &[Place], view: &View) -> [f64; 4] {
    around(NOTHING, skin.iter().flat_map(|f| &f.nodes).map(|&k| view.on_page(places[k])))
}

/// The figure, broad and narrow; nothing without stresses.
pub(crate) fn instants(run: &Recorded, sets: &[(f64, FieldSet)]) -> Option<[String; 2]> {
    let view = View::axonometric();
    let skin = skin(&sets.first()?.1);
    let mut list = Vec::new();
    for (t, set) in sets.iter().filter(|(_, set)| set.points.len() == sets[0].1.points.len()) {
        let mises = &set.array("von_mises")?.values;
        list.push((instant_label(run, *t), places(set), mises));
    }
    let values = list.iter().flat_map(|(_, _, mises)| {
        skin.iter().flat_map(|facet| &facet.nodes).map(|&k| mises[k]).collect::<Vec<_>>()
    });
    let (bands, cut) = positive_bands(values, floor(run, &sets[0].1, "von_mises"));
    let frames = list.iter().map(|(_, places, _)| frame(&skin, places, &view));
    let mut wide = frames.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1]), a[2].min(b[2]), a[3].max(b[3])])?;
    let rigid = wires(run, box_around(list.iter().flat_map(|(_, places, _)| box_of(&skin, places))));
    let lines: Vec<Vec<[Place; 2]>> =
        sets.iter().map(|(time, _)| rigid.iter().flat_map(|wire| wire.at(run, *time)).collect()).collect();
    wide = around(wide, lines.iter().flatten().flatten().map(|place| view.on_page(*place)));
    if !(wide[1] > wide[0] && wide[3] > wide[2]) {
        return None;
    }
    let unit = sets[0].1.unit("stress");
    let length = sets[0].1.unit("displacement");
    let seen = |k: usize, to: &dyn Fn(Point) -> Point, scale: f64| {
        let (_, places, mises) = &list[k];
        pieces(&skin, places, &|_, node| mises[node], &view, to, scale)
    };
    let picture = |sheet: &mut Sheet, k: usize| {
        let place = sheet.picture(k);
        let to = sheet.map(k);
        underlay(&mut sheet.out, &lines[k], &view, &to);
        let pieces = seen(k, &to, sheet.scale);
        sheet.out.push_str(&image(&pieces, &Paint::Bands(&bands), place));
    };
    let finish = |mut sheet: Sheet| {
        let triad = [36.0, sheet.pictures + 36.0];
        view.triad(&mut sheet.out, triad, 28.0);
        sheet.finish(&Legend { bands: &bands, cut, label: "σ_{vM}", unit }, length)
    };
    let headings = list.iter().map(|(heading, ..)| heading.as_str());
    Some(Sheet::pair("Deformed bodies with von Mises stress", headings, wide, FOOT, picture).map(finish))
}

/// Corners of the box of all places of a skin.
pub(crate) fn box_of(skin: &[Facet], places: &[Place]) -> [Place; 2] {
    box_around(skin.iter().flat_map(|facet| &facet.nodes).map(|&node| places[node]))
}

/// Corners of the box of these places.
pub(crate) fn box_around(places: impl Iterator<Item = Place>) -> [Place; 2] {
    let nothing = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    places.fold(nothing, |[low, high], place| {
        [[0, 1, 2].map(|d| low[d].min(place[d])), [0, 1, 2].map(|d| high[d].max(place[d]))]
    })
}

/// Draws the lines of rigid obstacles, over which bodies are drawn.
pub(crate) fn underlay(out: &mut String, lines: &[[Place; 2]], view: &View, to: &dyn Fn(Point) -> Point) {
    if lines.is_empty() {
        return;
    }
    let mut pen = Pen::default();
    let mut last = None;
    for [a, b] in lines.iter().map(|piece| piece.map(|place| to(view.on_page(place)))) {
        if last != Some(a) {
            pen.go(a);
        }
        pen.draw(&[b]);
        last = Some(b);
    }
    let style = format!("fill=\"none\" stroke=\"{RIGID}\" stroke-width=\"{}\"", THIN * GRID);
    path(out, &pen, &style);
}
