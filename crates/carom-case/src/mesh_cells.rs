//! Numbers and sizes of the cells of a built-in shape.

use super::problem::{Problem, rounded};
use super::tree::Node;
use super::view::View;

/// Numbers of cells between two corners, given or by their size.
pub(super) fn divided<const D: usize>(
    v: View,
    min: [f64; D],
    max: [f64; D],
    path: &str,
    problems: &mut Vec<Problem>,
) -> Option<[usize; D]> {
    for i in 0..D {
        ordered(min[i], max[i], &format!("[{i}]"), path, problems)?;
    }
    let extents: [f64; D] = std::array::from_fn(|i| max[i] - min[i]);
    match (v.has("cells"), v.has("size")) {
        (true, false) => {
            v.value("cells")?.list()?.iter().map(Node::count).collect::<Option<Vec<_>>>()?.try_into().ok()
        }
        (false, true) => {
            let size = v.number("size").filter(|size| *size > 0.0)?;
            let (name, longest) = (
                if D == 2 { "longer side" } else { "longest side" },
                extents.iter().copied().fold(0.0, f64::max),
            );
            fitting(size, (name, longest), path, problems)?;
            Some(extents.map(|extent| (extent / size - 1e-9).ceil().max(1.0) as usize))
        }
        (both, _) => {
            let misspelt =
                v.table.0.iter().any(|e| e.key != "shape" && !v.keys.iter().any(|k| k.name == e.key));
            if both || !misspelt {
                let shape = if D == 2 { "rectangle" } else { "box" };
                let what = if both {
                    format!("a {shape} has `cells` or `size`, not both")
                } else {
                    format!("the {shape} has neither `cells` nor `size`")
                };
                let example = if D == 2 { "[8, 4]" } else { "[8, 4, 4]" };
                problems.push(Problem::new(
                    path,
                    what,
                    "each of them sets the size of the cells",
                    format!("write for example `cells = {example}`"),
                ));
            }
            None
        }
    }
}

/// Reports cells that are larger than their body.
pub(super) fn fitting(
    size: f64,
    (extent, length): (&str, f64),
    path: &str,
    problems: &mut Vec<Problem>,
) -> Option<()> {
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

pub(super) fn ordered(
    min: f64,
    max: f64,
    index: &str,
    path: &str,
    problems: &mut Vec<Problem>,
) -> Option<()> {
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
