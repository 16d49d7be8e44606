//! Reads the table of a mesh: a built-in shape, or a file.

use std::path::Path;

use carom_solid::{Element, generate};

use super::keys::{self, Kind};
use super::mesh_file;
use super::problem::{Problem, rounded};
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
        return mesh_file::read(v, dimension, element, folder, path, problems);
    }
    let shape = table.get("shape")?.text()?;
    let v = View { table, keys: keys::shapes().table(shape)?.keys, preset };
    let wanted = if shape == "interval" { 1 } else { 2 };
    if wanted != dimension {
        let what = format!("the shape \"{shape}\" has dimension {wanted}");
        let why = format!("the case has dimension = {dimension}");
        let help =
            if dimension == 1 { "use shape = \"interval\"" } else { "use for example shape = \"rectangle\"" };
        problems.push(Problem::new(format!("{path}.shape"), what, why, help));
        return None;
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
            ordered(min[0], max[0], "[0]", path, problems)?;
            ordered(min[1], max[1], "[1]", path, problems)?;
            Some(MeshSpec::Rectangle { min, max, cells: rectangle_cells(v, min, max, path, problems)? })
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

fn rectangle_cells(
    v: View,
    min: [f64; 2],
    max: [f64; 2],
    path: &str,
    problems: &mut Vec<Problem>,
) -> Option<[usize; 2]> {
    match (v.has("cells"), v.has("size")) {
        (true, false) => {
            v.value("cells")?.list()?.iter().map(Node::count).collect::<Option<Vec<_>>>()?.try_into().ok()
        }
        (false, true) => {
            let size = v.number("size").filter(|size| *size > 0.0)?;
            fitting(size, ("longer side", (max[0] - min[0]).max(max[1] - min[1])), path, problems)?;
            Some([0, 1].map(|i| ((max[i] - min[i]) / size - 1e-9).ceil().max(1.0) as usize))
        }
        (both, _) => {
            let misspelt =
                v.table.0.iter().any(|e| e.key != "shape" && !v.keys.iter().any(|k| k.name == e.key));
            if both || !misspelt {
                let what = if both {
                    "a rectangle has `cells` or `size`, not both"
                } else {
                    "the rectangle has neither `cells` nor `size`"
                };
                problems.push(Problem::new(
                    path,
                    what,
                    "each of them sets the size of the cells",
                    "write for example `cells = [8, 4]`",
                ));
            }
            None
        }
    }
}

/// Reports cells that are larger than their body.
fn fitting(size: f64, (extent, length): (&str, f64), path: &str, problems: &mut Vec<Problem>) -> Option<()> {
    // A value that is not positive is reported elsewhere.
    if size > length && length > 0.0 {
        let what = format!("`size` = {size} is larger than the {extent}, {}", rounded(length));
        let why = "it is the edge length of the cells, and none would fit";
        let help = format!("give size ≤ {}, for example size = {}", rounded(length), rounded(length / 5.0));
        problems.push(Problem::new(format!("{path}.size"), what, why, help));
        return None;
    }
    Some(())
}

fn ordered(min: f64, max: f64, index: &str, path: &str, problems: &mut Vec<Problem>) -> Option<()> {
    if min < max {
        return Some(());
    }
    if min.is_finite() && max.is_finite() {
        let what = format!("`max` = {max} is not greater than `min` = {min}");
        problems.push(Problem::new(
            format!("{path}.max{index}"),
            what,
            "the shape would have no extent",
            "give max > min",
        ));
    }
    None
}
