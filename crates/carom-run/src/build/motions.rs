//! Moving supports: which dofs follow which formula.

use std::collections::BTreeMap;

use carom_case::{Case, FormulaSpec, Problem};
use carom_formula::Formula;
use carom_mechanics::model::{BodyInstance, Motions};

use super::given::in_space_and_time;
use super::obstacles::Moving;
use super::side::{coordinates, owner, side};

const AXES: [&str; 3] = ["x", "y", "z"];

/// Formulas with their labels, and the formula of each prescribed dof.
#[derive(Default)]
pub(super) struct Moves {
    formulas: Vec<(String, Formula)>,
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
            let label = spec.name.as_ref().map_or_else(|| spec.on.join(", "), Clone::clone);
            let place = moves.formulas.len();
            moves.formulas.push((format!("the motion of support \"{label}\""), read));
            let sides = spec.on.iter().filter_map(|name| side(parts, name, "").ok());
            for node in sides.flat_map(|s| s.nodes) {
                if let Some(with) = moves.conflict(node * d + axis, place, fixed) {
                    problems.push(Problem::new(
                        path.clone(),
                        format!("a node of {label} is moved along {} and also {with}", AXES[*axis]),
                        format!("the node at {} is on two supports", coordinates(&place_of(parts, node))),
                        "remove one of the sides, or give both the same motion",
                    ));
                    break;
                }
            }
        }
    }
    for obstacle in obstacles {
        for (dof, formula) in obstacle.prescribed() {
            let Some(formula) = formula else { continue };
            let path = format!("{}.motion", case.contacts[obstacle.contact].path("primary"));
            match in_space_and_time(case, &formula, &path) {
                Ok(read) => {
                    moves.by_dof.insert(dof, moves.formulas.len());
                    moves.formulas.push((obstacle.label(), read));
                }
                Err(problem) => problems.push(problem),
            }
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
        self.by_dof.get(&dof).map(|formula| self.formulas[*formula].1.text())
    }

    /// The motions of the model.
    pub(super) fn motions(self, case: &Case, parts: &[BodyInstance]) -> Motions {
        let place = |dof: usize| place_of(parts, dof / case.dimension);
        let moved = self.by_dof.into_iter().map(|(dof, formula)| (dof, formula, place(dof)));
        Motions::new(self.formulas, moved)
    }

    /// Assigns a formula to a dof; returns a conflicting assignment.
    fn conflict(&mut self, dof: usize, formula: usize, fixed: &[bool]) -> Option<String> {
        let text = |formula: usize| self.formulas[formula].1.text();
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
                Ok(read) => self.formulas.push((format!("component {} of [manufactured]", axis + 1), read)),
                Err(problem) => return problems.push(problem),
            }
            let place = self.formulas.len() - 1;
            for part in parts {
                let on = part.body.mesh().on_boundary();
                let nodes = part.nodes().zip(on).filter_map(|(node, on)| on.then_some(node));
                self.by_dof.extend(nodes.map(|node| (node * case.dimension + axis, place)));
            }
        }
    }
}

/// Reference position of a node.
fn place_of(parts: &[BodyInstance], node: usize) -> Vec<f64> {
    owner(parts, node).map_or_else(Vec::new, |p| p.body.mesh().nodes[node - p.first_node].to_vec())
}
