//! Reads the shapes of space: box, ball, cylinder and tube, whole or cut by planes of symmetry.

use carom_solid::generate::Frame;

use super::MeshSpec;
use super::mesh_cells::{divided, fitting};
use super::problem::Problem;
use super::view::View;

/// Reads a shape.
pub(super) fn read(v: View, shape: &str, path: &str, problems: &mut Vec<Problem>) -> Option<MeshSpec> {
    let point = |name| -> Option<[f64; 3]> { v.numbers(name)?.try_into().ok() };
    let symmetry = symmetry(v)?;
    if shape == "box" {
        let (mut min, max) = (point("min")?, point("max")?);
        for i in 0..3 {
            if symmetry[i] && min[i] < max[i] {
                min[i] = 0.5 * (min[i] + max[i]);
            }
        }
        return Some(MeshSpec::Box { min, max, cells: divided(v, min, max, path, problems)?, symmetry });
    }
    let (center, size) = (point("center")?, v.number("size")?);
    if shape == "ball" {
        let radius = v.number("radius")?;
        fitting(size, ("radius", radius), path, problems)?;
        return Some(MeshSpec::Ball { radius, center, size, symmetry });
    }
    let (height, axis) = (v.number("height")?, axis(v, center, symmetry, path, problems)?);
    if shape == "cylinder" {
        let radius = v.number("radius")?;
        fitting(size, ("longest extent", radius.max(height)), path, problems)?;
        return Some(MeshSpec::Cylinder { radius, height, center, axis, size, symmetry });
    }
    let (inner, outer) = (v.number("inner")?, v.number("outer")?);
    if inner >= outer {
        let what = format!("`outer` = {outer} is not greater than `inner` = {inner}");
        let why = "the tube would have no wall";
        problems.push(Problem::new(format!("{path}.outer"), what, why, "give outer > inner"));
        return None;
    }
    fitting(size, ("longest extent", outer.max(height)), path, problems)?;
    Some(MeshSpec::Tube { inner, outer, height, center, axis, size, symmetry })
}

/// Directions across which planes of symmetry cut.
pub(super) fn symmetry(v: View) -> Option<[bool; 3]> {
    let words = if v.has("symmetry") { v.texts("symmetry")? } else { Vec::new() };
    Some(["x", "y", "z"].map(|direction| words.iter().any(|word| word == direction)))
}

/// The direction of an axis that planes of symmetry may cut.
fn axis(
    v: View,
    center: [f64; 3],
    symmetry: [bool; 3],
    path: &str,
    problems: &mut Vec<Problem>,
) -> Option<[f64; 3]> {
    let axis = match v.value("axis")?.text() {
        Some(word) => ["x", "y", "z"].map(|direction| f64::from(u8::from(direction == word))),
        None => v.numbers("axis")?.try_into().ok()?,
    };
    if let Err(error) = Frame::along(axis, center).and_then(|frame| frame.cuts(symmetry)) {
        let why = "an axis has a direction; planes of symmetry need one along x, y or z";
        let help = "write for example axis = \"z\"";
        problems.push(Problem::new(format!("{path}.axis"), error.to_string(), why, help));
        return None;
    }
    Some(axis)
}
