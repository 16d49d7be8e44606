//! Supports that move: y = X + u(X, t) with v = u̇ and a = ü by the formula's own derivatives. The scheme's relations between d, v and a are not
//! used for these dofs, so they cannot ring, and their inertia M a acts on their neighbours.

use std::collections::BTreeMap;

use carom_formula::Formula;

use super::Part;
use super::build::side;
use super::formulas::{NoValue, arguments, finite};
use crate::case::load::load_variables;
use crate::case::{Case, FormulaSpec, Problem};

/// A dof that moves as a formula says.
#[derive(Clone, Copy, Debug)]
struct Moved<const D: usize> {
    dof: usize,
    /// Place in `formulas`.
    formula: usize,
    place: [f64; D],
}

/// All prescribed motions of a model.
pub struct Motions<const D: usize> {
    formulas: Vec<(String, Formula)>,
    moved: Vec<Moved<D>>,
}

/// A dof's displacement, velocity and acceleration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prescribed {
    /// Global dof.
    pub dof: usize,
    /// u, u̇, ü.
    pub motion: [f64; 3],
}

impl<const D: usize> Motions<D> {
    /// The motions of a case, by dof ascending. A dof that is fixed, or moved by two different formulas, is a problem.
    pub(super) fn build(case: &Case, parts: &[Part<D>], fixed: &[bool], problems: &mut Vec<Problem>) -> Self {
        let mut motions = Self { formulas: Vec::new(), moved: Vec::new() };
        let mut by_dof = BTreeMap::new();
        for (k, spec) in case.supports.iter().enumerate() {
            for (axis, formula) in &spec.moves {
                let path = format!("support[{k}].move.{}", ["x", "y"][*axis]);
                let read = match formula.formula(&load_variables(D)) {
                    Ok(formula) => formula,
                    Err(error) => {
                        problems.push(Problem::new(path, error.to_string(), "", ""));
                        continue;
                    }
                };
                let label = spec.name.as_ref().map_or_else(|| spec.on.join(", "), Clone::clone);
                let place = motions.formulas.len();
                motions.formulas.push((format!("the motion of support \"{label}\""), read));
                let sides = spec.on.iter().filter_map(|name| side(parts, name, "").ok());
                for node in sides.flat_map(|s| s.nodes) {
                    let dof = node * D + axis;
                    let other = by_dof.insert(dof, place).map(|p| motions.formulas[p].1.text().to_owned());
                    let with = if fixed[dof] {
                        Some("fixed".to_owned())
                    } else {
                        other
                            .filter(|text| text != motions.formulas[place].1.text())
                            .map(|text| format!("moved as {text}"))
                    };
                    if let Some(with) = with {
                        let what = format!("a node of {label} is moved along {} and also {with}", ["x", "y"][*axis]);
                        let why = format!("the node at {:?} is on two supports", place_of(parts, node));
                        problems.push(Problem::new(
                            path.clone(),
                            what,
                            why,
                            "take one of the sides out, or give both the same motion",
                        ));
                        break;
                    }
                }
            }
        }
        if let Some(y) = &case.manufactured {
            motions.manufactured(y, parts, &mut by_dof, problems);
        }
        motions.moved =
            by_dof.into_iter().map(|(dof, formula)| Moved { dof, formula, place: place_of(parts, dof / D) }).collect();
        motions
    }

    /// All nodes of the boundary, moved by y − X.
    fn manufactured(
        &mut self,
        y: &[FormulaSpec],
        parts: &[Part<D>],
        by_dof: &mut BTreeMap<usize, usize>,
        problems: &mut Vec<Problem>,
    ) {
        for (axis, formula) in y.iter().enumerate() {
            let text = format!("({formula}) - {}", ["X", "Y"][axis]);
            match Formula::parse(&text, &load_variables(D)) {
                Ok(read) => self.formulas.push((format!("component {} of [manufactured]", axis + 1), read)),
                Err(error) => return problems.push(Problem::new("manufactured.y", error.to_string(), "", "")),
            }
            let place = self.formulas.len() - 1;
            for part in parts {
                let on = part.body.mesh().on_boundary();
                let nodes = part.nodes().zip(on).filter_map(|(node, on)| on.then_some(node));
                by_dof.extend(nodes.map(|node| (node * D + axis, place)));
            }
        }
    }

    /// Whether nothing moves.
    pub fn is_empty(&self) -> bool {
        self.moved.is_empty()
    }

    /// Moved dofs, ascending.
    pub fn dofs(&self) -> impl Iterator<Item = usize> + '_ {
        self.moved.iter().map(|m| m.dof)
    }

    /// Displacements, velocities and accelerations at a time; `out` is reused.
    ///
    /// # Errors
    /// The first formula without a finite value or derivative.
    pub fn at(&self, time: f64, out: &mut Vec<Prescribed>) -> Result<(), NoValue> {
        out.clear();
        for moved in &self.moved {
            let (label, formula) = &self.formulas[moved.formula];
            let motion = formula.with_derivatives(&arguments(&moved.place, time)[..=D], D);
            for value in motion {
                finite(value, formula, label, &moved.place, time)?;
            }
            out.push(Prescribed { dof: moved.dof, motion });
        }
        Ok(())
    }
}

fn place_of<const D: usize>(parts: &[Part<D>], node: usize) -> [f64; D] {
    let part = parts.iter().find(|p| p.nodes().contains(&node));
    part.map_or([f64::NAN; D], |p| p.body.mesh().nodes[node - p.first_node])
}
