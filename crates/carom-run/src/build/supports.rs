//! Supports: the dofs that they fix, and the dofs whose reactions are recorded.

use carom_case::{Case, Problem};
use carom_mechanics::model::{BodyInstance, Model, Pivot, Support};

use super::side::side;

/// The supports of a case.
pub(super) struct Supported {
    /// Whether each dof is fixed; those that are moved are not.
    pub(super) fixed: Vec<bool>,
    /// The supports with a name.
    pub(super) supports: Vec<Support>,
}

pub(super) fn supported(
    case: &Case,
    parts: &[BodyInstance],
    reference: &[f64],
    problems: &mut Vec<Problem>,
) -> Supported {
    let d = case.dimension;
    let mut fixed = vec![false; reference.len()];
    let mut supports = Vec::new();
    for (k, spec) in case.supports.iter().enumerate() {
        let mut constrained = Vec::new();
        for (j, name) in spec.on.iter().enumerate() {
            let side = match side(parts, name, &format!("support[{k}].on[{j}]")) {
                Ok(side) => side,
                Err(problem) => {
                    problems.push(problem);
                    continue;
                }
            };
            let dofs = |axis: usize| side.nodes.iter().map(move |n| n * d + axis).collect::<Vec<_>>();
            let normal = spec.normal.then(|| across(&side.nodes, reference, d));
            if normal == Some(None) {
                problems.push(not_plane(name, format!("support[{k}].fix")));
            }
            for dof in spec.fix.iter().copied().chain(normal.flatten()).flat_map(dofs) {
                fixed[dof] = true;
                constrained.push(dof);
            }
            constrained.extend(spec.moves.iter().flat_map(|(i, _)| dofs(*i)));
        }
        constrained.sort_unstable();
        constrained.dedup();
        if let Some(name) = &spec.name {
            let moment_about = spec.moment_about.clone().filter(|_| d > 1).map(Pivot::Point);
            supports.push(Support { name: name.clone(), dofs: constrained, moment_about });
        }
    }
    Supported { fixed, supports }
}

/// The axis across each side that is held across, in the order of the supports and their sides.
pub(crate) fn axes_across(case: &Case, model: &Model) -> Vec<Option<usize>> {
    let sides = case.supports.iter().filter(|support| support.normal).flat_map(|support| &support.on);
    let axis =
        |name: &String| across(&side(&model.parts, name, "").ok()?.nodes, &model.reference, case.dimension);
    sides.map(axis).collect()
}

/// Deviation from a plane, relative to the size of a side, that is round-off of its coordinates.
const PLANE: f64 = 1e-9;

/// The axis across a side whose nodes are in a plane x, y or z = constant.
fn across(nodes: &[usize], reference: &[f64], d: usize) -> Option<usize> {
    let extent = |axis: usize| {
        let places = nodes.iter().map(|node| reference[node * d + axis]);
        let ends =
            places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
        ends[1] - ends[0]
    };
    let extents: Vec<f64> = (0..d).map(extent).collect();
    let size = extents.iter().copied().fold(0.0, f64::max);
    let mut flat = (0..d).filter(|&axis| extents[axis] <= PLANE * size);
    flat.next().filter(|_| flat.next().is_none())
}

fn not_plane(side: &str, path: String) -> Problem {
    let what = format!("the side \"{side}\" is not in a plane x, y or z = constant");
    let why = "\"normal\" fixes one coordinate of all nodes of a side";
    Problem::new(
        path,
        what,
        why,
        "place the body so that the side faces along x, y or z, or fix directions by name",
    )
}
