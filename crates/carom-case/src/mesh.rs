//! Meshes: built-in shapes and files; read, their sides by name, their size estimated before they are made.

use std::f64::consts::PI;
use std::path::Path;

use carom_solid::{Element, generate};

use super::keys::{self, Kind};
use super::mesh_file;
use super::problem::{Problem, rounded};
use super::tree::{Node, Table};
use super::view::View;
use super::{MeshSpec, Preset, RefineSpec};

impl MeshSpec {
    /// Names of the shape's sides, in the order in which its boundary is walked.
    pub fn sides(&self) -> Vec<String> {
        let words: &[&str] = match self {
            Self::File { sides, .. } => return sides.clone(),
            Self::Polygon { points, .. } => return (1..=points.len()).map(|k| format!("side{k}")).collect(),
            Self::Interval { .. } => &["left", "right"],
            Self::Rectangle { .. } => &["bottom", "right", "top", "left"],
            Self::Disc { .. } => &["arc"],
            Self::HalfDisc { .. } => &["arc", "axis"],
            Self::Ring { .. } => &["inner", "outer"],
        };
        words.iter().map(ToString::to_string).collect()
    }

    /// Roughly how many cells and nodes the mesh will have, in floating point: nothing overflows.
    pub fn estimate(&self, element: Element) -> (f64, f64) {
        let k = element.degree() as f64;
        let rings = |radius: f64, size: f64| (radius / size).ceil().max(1.0);
        // Equilateral triangles with the edges h fill an area.
        let filled = |area: f64, h: f64| area / (0.75_f64.sqrt() / 2.0 * h * h);
        let nodes = |cells: f64| (cells, 0.5 * k * k * cells * 1.1 + 10.0 * k);
        match *self {
            Self::Ring { inner, outer, size, .. } => {
                let h = size.min(outer - inner);
                // Twelve to the circle near a small inner one.
                let growing = 24.0 * (outer / inner).ln().max(1.0);
                nodes(filled(PI * (outer * outer - inner * inner), h) + growing)
            }
            Self::Polygon { ref points, size, ref refine } => {
                let next = points.iter().cycle().skip(1);
                let twice: f64 = points.iter().zip(next).map(|(p, q)| p[0] * q[1] - p[1] * q[0]).sum();
                let area = twice.abs() / 2.0;
                let place = |r: &RefineSpec| filled(area.min(PI * (r.radius + 3.0 * r.size).powi(2)), r.size);
                nodes(filled(area, size) + refine.iter().map(place).sum::<f64>())
            }
            Self::File { nodes, cells, .. } => (cells as f64, nodes as f64),
            Self::Interval { cells, .. } => (cells as f64, k * cells as f64 + 1.0),
            Self::Rectangle { cells: [nx, ny], .. } => {
                let (nx, ny) = (nx as f64, ny as f64);
                (2.0 * nx * ny, (k * nx + 1.0) * (k * ny + 1.0))
            }
            Self::Disc { radius, size, .. } => {
                let n = rings(radius, size);
                (6.0 * n * n, 1.0 + 3.0 * k * n * (k * n + 1.0))
            }
            Self::HalfDisc { radius, size, .. } => {
                let n = rings(radius, size);
                (3.0 * n * n, 1.0 + 1.5 * k * n * (k * n + 1.0) + k * n)
            }
        }
    }
}

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
        let what = format!("the shape \"{shape}\" is of dimension {wanted}");
        let why = format!("the case has dimension = {dimension}");
        let help = if dimension == 1 { "use shape = \"interval\"" } else { "use for example shape = \"rectangle\"" };
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

/// A polygon whose outline can be filled.
fn polygon(v: View, path: &str, problems: &mut Vec<Problem>) -> Option<MeshSpec> {
    let pair = |node: &Node| node.list()?.iter().map(Node::number).collect::<Option<Vec<_>>>()?.try_into().ok();
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
        let why = "a polygon is one closed line that does not meet itself";
        problems.push(Problem::new(format!("{path}.points"), error.to_string(), why, "list its corners in order"));
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
        (true, false) => v.value("cells")?.list()?.iter().map(Node::count).collect::<Option<Vec<_>>>()?.try_into().ok(),
        (false, true) => {
            let size = v.number("size").filter(|size| *size > 0.0)?;
            fitting(size, ("longer side", (max[0] - min[0]).max(max[1] - min[1])), path, problems)?;
            Some([0, 1].map(|i| ((max[i] - min[i]) / size - 1e-9).ceil().max(1.0) as usize))
        }
        (both, _) => {
            let misspelt = v.table.0.iter().any(|e| e.key != "shape" && !v.keys.iter().any(|k| k.name == e.key));
            if both || !misspelt {
                let what = if both {
                    "a rectangle has `cells` or `size`, not both"
                } else {
                    "the rectangle has neither `cells` nor `size`"
                };
                problems.push(Problem::new(
                    path,
                    what,
                    "they both say how fine the mesh is",
                    "write for example `cells = [8, 4]`",
                ));
            }
            None
        }
    }
}

/// Refuses cells that are meant to be larger than their body.
fn fitting(size: f64, (extent, length): (&str, f64), path: &str, problems: &mut Vec<Problem>) -> Option<()> {
    // What is not positive has a message of its own.
    if size > length && length > 0.0 {
        let what = format!("`size` = {size} is larger than the {extent}, {}", rounded(length));
        let why = "it is the length of the cells, and none would fit";
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
