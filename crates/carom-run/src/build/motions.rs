//! Moving supports: which dofs follow which formula.

use std::collections::BTreeMap;

use carom_case::{Case, FormulaSpec, Problem};
use carom_mechanics::model::{BodyInstance, Motion, Motions};

use super::given::in_space_and_time;
use super::obstacles::Moving;
use super::side::{coordinates, owner, side};

const AXES: [&str; 3] = ["x", "y", "z"];

/// The motions, and that of each prescribed dof.
#[derive(Default)]
pub(super) struct Moves {
    motions: Vec<Motion>,
    pub(super) by_dof: BTreeMap<usize, usize>,
}

/// The motions of a case, ascending by dof. A dof that is fixed and moved by anything but 0, or
/// prescribed by two different formulas, is a problem.
pub(super) fn moves(
    case: &Case,
    parts: &[BodyInstance],
    obstacles: &[Moving],
    fixed: &[bool],
    problems: &mut Vec<Problem>,
) -> Moves {
    let d = case.dimension;
    let mut moves = Moves::default();
    for (k, spec) in case.supports.iter().enumerate() {
        for (axis, formula) in &spec.moves {
            let path = format!("support[{k}].move.{}", AXES[*axis]);
            let read = match in_space_and_time(case, formula, &path) {
                Ok(formula) => formula,
                Err(problem) => {
                    problems.push(problem);
                    continue;
                }
            };
            let named = spec.name.as_ref().map_or_else(|| spec.on.join(", "), Clone::clone);
            let place = moves.motions.len();
            let label = format!("the motion of support \"{named}\"");
            moves.motions.push(Motion::Displacement { label, formula: read });
            let sides = spec.on.iter().filter_map(|name| side(parts, name, "").ok());
            for node in sides.flat_map(|s| s.nodes) {
                if let Some(with) = moves.conflict(node * d + axis, place, fixed) {
                    problems.push(Problem::new(
                        path.clone(),
                        format!("a node of {named} is moved along {} and also {with}", AXES[*axis]),
                        format!(
                            "the node at {} has two conditions along {}",
                            coordinates(&place_of(parts, node)),
                            AXES[*axis]
                        ),
                        "fix and move different directions, remove one of the sides, or give both the same motion",
                    ));
                    break;
                }
            }
        }
    }
    for obstacle in obstacles {
        match obstacle.motions(case) {
            Ok(motions) => {
                for (dofs, motion) in motions {
                    moves.by_dof.extend(dofs.into_iter().map(|dof| (dof, moves.motions.len())));
                    moves.motions.push(motion);
                }
            }
            Err(problem) => problems.push(problem),
        }
    }
    if let Some(y) = &case.manufactured {
        moves.manufactured(case, y, parts, problems);
    }
    moves
}

impl Moves {
    /// The formula of a moved dof.
    pub(super) fn text(&self, dof: usize) -> Option<&str> {
        self.by_dof.get(&dof).map(|motion| text(&self.motions[*motion]))
    }

    /// The motions of the model.
    pub(super) fn motions(self, case: &Case, parts: &[BodyInstance]) -> Motions {
        let place = |dof: usize| place_of(parts, dof / case.dimension);
        let moved = self.by_dof.into_iter().map(|(dof, formula)| (dof, formula, place(dof)));
        Motions::new(self.motions, moved)
    }

    /// Assigns a formula to a dof; returns a conflicting assignment.
    fn conflict(&mut self, dof: usize, formula: usize, fixed: &[bool]) -> Option<String> {
        let text = |motion: usize| text(&self.motions[motion]);
        if fixed[dof] && text(formula).parse::<f64>() == Ok(0.0) {
            return None;
        }
        let other = self.by_dof.insert(dof, formula).map(text).filter(|other| *other != text(formula));
        if fixed[dof] { Some("fixed".to_owned()) } else { other.map(|text| format!("moved as {text}")) }
    }

    /// Prescribes y − X at all boundary nodes.
    fn manufactured(
        &mut self,
        case: &Case,
        y: &[FormulaSpec],
        parts: &[BodyInstance],
        problems: &mut Vec<Problem>,
    ) {
        for (axis, formula) in y.iter().enumerate() {
            let moved = FormulaSpec::Text(format!("({formula}) - {}", ["X", "Y", "Z"][axis]));
            match in_space_and_time(case, &moved, "manufactured.y") {
                Ok(formula) => {
                    let label = format!("component {} of [manufactured]", axis + 1);
                    self.motions.push(Motion::Displacement { label, formula });
                }
                Err(problem) => return problems.push(problem),
            }
            let place = self.motions.len() - 1;
            for part in parts {
                let on = part.on_boundary();
                let nodes = part.nodes().zip(on).filter_map(|(node, on)| on.then_some(node));
                self.by_dof.extend(nodes.map(|node| (node * case.dimension + axis, place)));
            }
        }
    }
}

/// The formula of a motion, by which two are compared; of a rigid motion that of its angle.
fn text(motion: &Motion) -> &str {
    match motion {
        Motion::Displacement { formula, .. } => formula.text(),
        Motion::Rigid(turn) => turn.angle.text(),
    }
}

/// Reference position of a node.
fn place_of(parts: &[BodyInstance], node: usize) -> Vec<f64> {
    owner(parts, node).map_or_else(Vec::new, |p| p.body.mesh().nodes[node - p.first_node].to_vec())
}
