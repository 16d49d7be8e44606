//! Bodies in space: the skin of their cells, seen in parallel projection, drawn for print and as a
//! scene to turn.

mod figure;
mod painter;
mod raster;
mod skin;
mod view;
mod wires;

pub(crate) use figure::{DRAWN, box_of, draw, frame, instants, underlay};
pub(crate) use painter::{Paint, pieces};
pub(crate) use skin::{Facet, Place, corners, skin};
pub(crate) use view::{View, cross, length, minus};
pub(crate) use wires::wires;
