//! Bodies in space: the skin of their cells, seen in parallel projection, drawn for print and as a
//! scene to turn.

mod figure;
mod pieces;
mod raster;
mod skin;
mod view;
mod wires;

pub(crate) use figure::{box_around, instants, underlay};
pub(crate) use pieces::{Paint, pieces};
pub(crate) use raster::image;
pub(crate) use skin::{Facet, Place, corners, skin};
pub(crate) use view::{View, cross, dot, length, minus};
pub(crate) use wires::wires;
