//! Reads the table of a mesh: a built-in shape, or a file.

use std::path::Path;

use carom_solid::{Element, generate};

use super::keys::{self, Kind};
use super::mesh_cells::{divided, fitting, ordered};
use super::mesh_file::{self, Purpose};
use super::problem::Problem;
use super::tree::{Node, Table};
use super::view::View;
use super::{MeshSpec, Preset, RefineSpec};

/// Reads the table of a mesh.
pub(super) fn read(
    table: &Table,
    dimension: usize,
    element: Option<Element>,
    folder: &Path,
    preset: Preset,
    path: &str,
    problems: &mut Vec<Problem>,
) -> Option<MeshSpec> {
    if let Some(spec) = keys::shapes().or.filter(|_| table.get("file").is_some()) {
        let v = View { table, keys: spec.keys, preset };
        let purpose = Purpose { dimension, element, extruded: false };
        return mesh_file::read(v, purpose, folder, path, problems);
    }
    let shape = table.get("shape")?.text()?;
    let v = View { table, keys: keys::shapes().table(shape)?.keys, preset };
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
        problems.push(Problem::new(format!("{path}.shape"), what, why, help));
        return None;
    }
    if shape == "extrusion" {
        let (of, path) = (v.value("of")?, format!("{path}.of"));
        let table = of.table()?;
        let of = if table.get("file").is_some() {
            let v = View { table, keys: keys::shapes().or?.keys, preset };
            let purpose = Purpose { dimension: 2, element, extruded: true };
            mesh_file::read(v, purpose, folder, &path, problems)?
        } else {
            read(table, 2, None, folder, preset, &path, problems)?
        };
        let (height, layers) = (v.number("height")?, v.count("layers")?);
        let symmetry = super::solids::symmetry(v)?;
        let of = half(of, table, symmetry, preset, &path, problems)?;
        return Some(MeshSpec::Extrusion { of: Box::new(of), height, layers, symmetry });
    }
    if dimension == 3 {
        return super::solids::read(v, shape, path, problems);
    }
    let point = |name| v.numbers(name)?.try_into().ok();
    match shape {
        "interval" => {
            let (min, max) = (v.number("min")?, v.number("max")?);
            ordered(min, max, "", path, problems)?;
            Some(MeshSpec::Interval { min, max, cells: v.count("cells")? })
        }
        "rectangle" => {
            let (min, max): ([f64; 2], [f64; 2]) = (point("min")?, point("max")?);
            Some(MeshSpec::Rectangle { min, max, cells: divided(v, min, max, path, problems)? })
        }
        "ring" => {
            let (inner, outer) = (v.number("inner")?, v.number("outer")?);
            if inner >= outer {
                let what = format!("`outer` = {outer} is not greater than `inner` = {inner}");
                let (path, why) = (format!("{path}.outer"), "the ring would have no width");
                problems.push(Problem::new(path, what, why, "give outer > inner"));
                return None;
            }
            let size = v.number("size")?;
            fitting(size, ("outer radius", outer), path, problems)?;
            Some(MeshSpec::Ring { inner, outer, center: point("center")?, size })
        }
        "polygon" => polygon(v, path, problems),
        _ => {
            let (radius, center, size) = (v.number("radius")?, point("center")?, v.number("size")?);
            fitting(size, ("radius", radius), path, problems)?;
            Some(match shape {
                "disc" => MeshSpec::Disc { radius, center, size },
                _ => MeshSpec::HalfDisc { radius, center, size },
            })
        }
    }
}

/// What planes of symmetry across x and y leave of a shape of the plane: the part with the larger
/// coordinates.
fn half(
    of: MeshSpec,
    table: &Table,
    [x, y, _]: [bool; 3],
    preset: Preset,
    path: &str,
    problems: &mut Vec<Problem>,
) -> Option<MeshSpec> {
    match of {
        _ if !x && !y => Some(of),
        MeshSpec::Rectangle { min, max, .. } => {
            let middle = |i: usize, cut: bool| if cut { 0.5 * (min[i] + max[i]) } else { min[i] };
            let min = [middle(0, x), middle(1, y)];
            let v = View { table, keys: keys::shapes().table("rectangle")?.keys, preset };
            Some(MeshSpec::Rectangle { min, max, cells: divided(v, min, max, path, problems)? })
        }
        MeshSpec::Disc { radius, center, size } if !y => Some(MeshSpec::HalfDisc { radius, center, size }),
        _ => {
            let across = if y { "y" } else { "x" };
            let what = format!("`symmetry` has \"{across}\", and this plane shape is not cut by that plane");
            let why = "a rectangle is cut across x and y, a disc across x, and every extrusion across z";
            let help = "extrude a polygon or a plane mesh that is the half, and hold its side";
            problems.push(Problem::new(format!("{path}.shape"), what, why, help));
            None
        }
    }
}

/// Reads a polygon; its outline must be simple.
fn polygon(v: View, path: &str, problems: &mut Vec<Problem>) -> Option<MeshSpec> {
    let pair =
        |node: &Node| node.list()?.iter().map(Node::number).collect::<Option<Vec<_>>>()?.try_into().ok();
    let points: Vec<[f64; 2]> = v.value("points")?.list()?.iter().map(pair).collect::<Option<_>>()?;
    let tables = v.table.get("refine").map_or(Some(&[][..]), Node::list)?;
    let refine = tables.iter().map(|node| {
        let Kind::Tables(spec) = v.keys.iter().find(|k| k.name == "refine")?.kind else { return None };
        let v = View { table: node.table()?, keys: spec.keys, preset: v.preset };
        let near = v.numbers("near")?.try_into().ok()?;
        Some(RefineSpec { near, radius: v.number("radius")?, size: v.number("size")? })
    });
    let refine = refine.collect::<Option<_>>()?;
    if let Err(error) = generate::outline(&points) {
        let why = "the outline of a polygon must not touch or intersect itself";
        problems.push(Problem::new(
            format!("{path}.points"),
            error.to_string(),
            why,
            "list its corners in order",
        ));
        return None;
    }
    Some(MeshSpec::Polygon { points, size: v.number("size")?, refine })
}
