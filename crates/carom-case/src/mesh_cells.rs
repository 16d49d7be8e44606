//! Numbers and sizes of the cells of a built-in shape.

use super::problem::rounded;
use super::tree::Node;
use super::view::View;

/// Numbers of cells between two corners, given or by their size.
pub(super) fn divided<const D: usize>(v: &View, min: [f64; D], max: [f64; D]) -> Option<[usize; D]> {
    for i in 0..D {
        ordered(v, min[i], max[i], &format!("[{i}]"))?;
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
            fitting(v, size, (name, longest))?;
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
                let why = "each of them sets the size of the cells";
                return v.wrong("", what, why, format!("write for example `cells = {example}`"));
            }
            None
        }
    }
}

/// Reports cells that are larger than their body.
pub(super) fn fitting(v: &View, size: f64, (extent, length): (&str, f64)) -> Option<()> {
    // A value that is not positive is reported elsewhere.
    if size > length && length > 0.0 {
        let what = format!("`size` = {size} is larger than the {extent}, {}", rounded(length));
        let why = "it is the edge length of the cells, and none would fit";
        let help = format!("give size ≤ {}, for example size = {}", rounded(length), rounded(length / 5.0));
        return v.wrong("size", what, why, help);
    }
    Some(())
}

/// The inner and the outer radius of a shape; `why`: if the outer one is not greater.
pub(super) fn radii(v: &View, why: &str) -> Option<(f64, f64)> {
    let (inner, outer) = (v.number("inner")?, v.number("outer")?);
    if inner >= outer {
        let what = format!("`outer` = {outer} is not greater than `inner` = {inner}");
        return v.wrong("outer", what, why, "give outer > inner");
    }
    Some((inner, outer))
}

/// Reports ends of an extent in the wrong order; `index`: of its direction.
pub(super) fn ordered(v: &View, min: f64, max: f64, index: &str) -> Option<()> {
    if min < max {
        return Some(());
    }
    if min.is_finite() && max.is_finite() {
        let what = format!("`max` = {max} is not greater than `min` = {min}");
        return v.wrong(&format!("max{index}"), what, "the shape would have no extent", "give max > min");
    }
    None
}
