//! Reads the table of a mesh: a built-in shape, or a file.

use carom_solid::generate;

use super::keys;
use super::mesh_cells::{divided, fitting, ordered, radii};
use super::mesh_file::{self, Purpose};
use super::view::View;
use super::{MeshSpec, RefineSpec};

/// Reads the table of a mesh.
pub(super) fn read(v: &View, purpose: Purpose) -> Option<MeshSpec> {
    let Purpose { dimension, element, .. } = purpose;
    if v.has("file") {
        let v = View { keys: keys::shapes().or?.keys, ..v.clone() };
        return mesh_file::read(&v, purpose);
    }
    let shape = v.table.get("shape")?.text()?;
    let v = &View { keys: keys::shapes().table(shape)?.keys, ..v.clone() };
    let wanted = match shape {
        "interval" => 1,
        "box" | "ball" | "cylinder" | "tube" | "extrusion" => 3,
        _ => 2,
    };
    if wanted != dimension {
        let what = format!("the shape \"{shape}\" has dimension {wanted}");
        let why = format!("the case has dimension = {dimension}");
        let help = match dimension {
            1 => "use shape = \"interval\"",
            2 => "use for example shape = \"rectangle\"",
            _ => "use for example shape = \"box\"",
        };
        return v.wrong("shape", what, why, help);
    }
    if shape == "extrusion" {
        let table = v.at("of")?;
        let of = read(&table, Purpose { dimension: 2, element, extruded: true })?;
        let (height, layers) = (v.number("height")?, v.count("layers")?);
        let symmetry = super::solids::symmetry(v)?;
        let of = half(of, &table, symmetry)?;
        return Some(MeshSpec::Extrusion { of: Box::new(of), height, layers, symmetry });
    }
    if dimension == 3 {
        return super::solids::read(v, shape);
    }
    let point = |name| v.numbers(name)?.try_into().ok();
    match shape {
        "interval" => {
            let (min, max) = (v.number("min")?, v.number("max")?);
            ordered(v, min, max, "")?;
            Some(MeshSpec::Interval { min, max, cells: v.count("cells")? })
        }
        "rectangle" => {
            let (min, max): ([f64; 2], [f64; 2]) = (point("min")?, point("max")?);
            Some(MeshSpec::Rectangle { min, max, cells: divided(v, min, max)? })
        }
        "ring" => {
            let (inner, outer) = radii(v, "the ring would have no width")?;
            let size = v.number("size")?;
            fitting(v, size, ("outer radius", outer))?;
            Some(MeshSpec::Ring { inner, outer, center: point("center")?, size })
        }
        "polygon" => polygon(v),
        _ => {
            let (radius, center, size) = (v.number("radius")?, point("center")?, v.number("size")?);
            fitting(v, size, ("radius", radius))?;
            Some(match shape {
                "disc" => MeshSpec::Disc { radius, center, size },
                _ => MeshSpec::HalfDisc { radius, center, size },
            })
        }
    }
}

/// What planes of symmetry across x and y leave of a shape of the plane: the part with the larger
/// coordinates.
fn half(of: MeshSpec, v: &View, [x, y, _]: [bool; 3]) -> Option<MeshSpec> {
    match of {
        _ if !x && !y => Some(of),
        MeshSpec::Rectangle { min, max, .. } => {
            let middle = |i: usize, cut: bool| if cut { 0.5 * (min[i] + max[i]) } else { min[i] };
            let min = [middle(0, x), middle(1, y)];
            let v = &View { keys: keys::shapes().table("rectangle")?.keys, ..v.clone() };
            Some(MeshSpec::Rectangle { min, max, cells: divided(v, min, max)? })
        }
        MeshSpec::Disc { radius, center, size } if !y => Some(MeshSpec::HalfDisc { radius, center, size }),
        _ => {
            let across = if y { "y" } else { "x" };
            let what = format!("`symmetry` has \"{across}\", and this plane shape is not cut by that plane");
            let why = "a rectangle is cut across x and y, a disc across x, and every extrusion across z";
            let help = "extrude a polygon or a plane mesh that is the half, and hold its side";
            v.wrong("shape", what, why, help)
        }
    }
}

/// Reads a polygon; its outline must be simple.
fn polygon(v: &View) -> Option<MeshSpec> {
    let points = v.points("points")?;
    let refine = v.each("refine", |v| {
        let near = v.numbers("near")?.try_into().ok()?;
        Some(RefineSpec { near, radius: v.number("radius")?, size: v.number("size")? })
    });
    let refine = refine?.into_iter().collect::<Option<_>>()?;
    if let Err(error) = generate::outline(&points) {
        let why = "the outline of a polygon must not touch or intersect itself";
        return v.wrong("points", error.to_string(), why, "list its corners in order");
    }
    Some(MeshSpec::Polygon { points, size: v.number("size")?, refine })
}
