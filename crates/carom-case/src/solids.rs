//! Reads the shapes of space: box, ball, cylinder and tube, whole or cut by planes of symmetry.

use carom_solid::generate::Frame;

use super::MeshSpec;
use super::mesh_cells::{divided, fitting, radii};
use super::view::View;

/// Reads a shape.
pub(super) fn read(v: &View, shape: &str) -> Option<MeshSpec> {
    let point = |name| -> Option<[f64; 3]> { v.numbers(name)?.try_into().ok() };
    let symmetry = symmetry(v)?;
    if shape == "box" {
        let (mut min, max) = (point("min")?, point("max")?);
        for i in 0..3 {
            if symmetry[i] && min[i] < max[i] {
                min[i] = 0.5 * (min[i] + max[i]);
            }
        }
        return Some(MeshSpec::Box { min, max, cells: divided(v, min, max)?, symmetry });
    }
    let (center, size) = (point("center")?, v.number("size")?);
    if shape == "ball" {
        let radius = v.number("radius")?;
        fitting(v, size, ("radius", radius))?;
        return Some(MeshSpec::Ball { radius, center, size, symmetry });
    }
    let (height, axis) = (v.number("height")?, axis(v, center, symmetry)?);
    if shape == "cylinder" {
        let radius = v.number("radius")?;
        fitting(v, size, ("longest extent", radius.max(height)))?;
        return Some(MeshSpec::Cylinder { radius, height, center, axis, size, symmetry });
    }
    let (inner, outer) = radii(v, "the tube would have no wall")?;
    fitting(v, size, ("longest extent", outer.max(height)))?;
    Some(MeshSpec::Tube { inner, outer, height, center, axis, size, symmetry })
}

/// Directions across which planes of symmetry cut.
pub(super) fn symmetry(v: &View) -> Option<[bool; 3]> {
    let words = if v.has("symmetry") { v.texts("symmetry")? } else { Vec::new() };
    Some(["x", "y", "z"].map(|direction| words.iter().any(|word| word == direction)))
}

/// The direction of an axis that planes of symmetry may cut.
fn axis(v: &View, center: [f64; 3], symmetry: [bool; 3]) -> Option<[f64; 3]> {
    let axis = match v.value("axis")?.text() {
        Some(word) => ["x", "y", "z"].map(|direction| f64::from(u8::from(direction == word))),
        None => v.numbers("axis")?.try_into().ok()?,
    };
    if let Err(error) = Frame::along(axis, center).and_then(|frame| frame.cuts(symmetry)) {
        let why = "an axis has a direction; planes of symmetry need one along x, y or z";
        let help = "write for example axis = \"z\"";
        return v.wrong("axis", error.to_string(), why, help);
    }
    Some(axis)
}
