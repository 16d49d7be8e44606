//! Meshes: built-in shapes and files; read, their sides by name, their size estimated before they are made.

use std::path::Path;

use carom_solid::Element;

use super::keys;
use super::mesh_file;
use super::problem::Problem;
use super::tree::{Node, Table};
use super::view::View;
use super::{MeshSpec, Preset};

impl MeshSpec {
    /// Names of the shape's sides, in the order in which its boundary is walked.
    pub fn sides(&self) -> Vec<&str> {
        match self {
            Self::File { sides, .. } => sides.iter().map(String::as_str).collect(),
            Self::Interval { .. } => vec!["left", "right"],
            Self::Rectangle { .. } => vec!["bottom", "right", "top", "left"],
            Self::Disc { .. } => vec!["arc"],
            Self::HalfDisc { .. } => vec!["arc", "axis"],
        }
    }

    /// Roughly how many cells and nodes the mesh will have, in floating point: nothing overflows.
    pub fn estimate(&self, element: Element) -> (f64, f64) {
        let k = element.degree() as f64;
        let rings = |radius: f64, size: f64| (radius / size).ceil().max(1.0);
        match *self {
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
    if let Some(spec) = keys::SHAPES.or.filter(|_| table.get("file").is_some()) {
        let v = View { table, keys: spec.keys, preset };
        return mesh_file::read(v, dimension, element, folder, path, problems);
    }
    let shape = table.get("shape")?.text()?;
    let v = View { table, keys: keys::SHAPES.table(shape)?.keys, preset };
    let wanted = if shape == "interval" { 1 } else { 2 };
    if wanted != dimension {
        let what = format!("the shape \"{shape}\" is of dimension {wanted}");
        let why = format!("the case has dimension = {dimension}");
        let help =
            if dimension == 1 { "use shape = \"interval\"" } else { "use \"rectangle\", \"disc\" or \"half-disc\"" };
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
        "disc" => {
            Some(MeshSpec::Disc { radius: v.number("radius")?, center: point("center")?, size: v.number("size")? })
        }
        _ => {
            Some(MeshSpec::HalfDisc { radius: v.number("radius")?, center: point("center")?, size: v.number("size")? })
        }
    }
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
