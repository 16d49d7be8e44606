//! The loads of a case as nodal forces f_ext(y, t), gravity apart: dead tractions and body forces, known when the time is, and follower
//! pressures, which turn with the side (`carom_solid::LoadedSide`). Where the motion is given, the load that makes it one is the only load.

use carom_formula::Formula;
use carom_solid::LoadedSide;

use super::formulas::{NoValue, value};
use super::{MAX_CELL_DOFS, Manufactured, Part};
use crate::case::load::load_variables;
use crate::case::{Case, FormulaSpec, LoadKind, Problem, TableSpec};

/// All loads of a model.
pub struct Loads<const D: usize> {
    tractions: Vec<SideLoad<D>>,
    pressures: Vec<SideLoad<D>>,
    body_forces: Vec<BodyForce>,
    /// The motion that was given, if one was.
    pub manufactured: Option<Manufactured<D>>,
}

/// A traction (`D` formulas) or a pressure (one) on a side.
struct SideLoad<const D: usize> {
    label: String,
    side: LoadedSide<D>,
    value: Vec<Formula>,
    table: Option<TableSpec>,
}

struct BodyForce {
    label: String,
    part: usize,
    value: Vec<Formula>,
    table: Option<TableSpec>,
}

/// Loads at one time: what does not depend on the positions.
#[derive(Clone, Debug, Default)]
pub struct LoadsAt {
    /// Nodal forces of the dead loads, flat.
    dead: Vec<f64>,
    /// Pressures at the quadrature points of each pressure's side.
    pressures: Vec<Vec<f64>>,
}

impl<const D: usize> Loads<D> {
    /// The loads of a case; names and formulas have been checked when it was read.
    pub(super) fn build(case: &Case, parts: &[Part<D>], problems: &mut Vec<Problem>) -> Self {
        let mut loads =
            Self { tractions: Vec::new(), pressures: Vec::new(), body_forces: Vec::new(), manufactured: None };
        if let Some(y) = &case.manufactured {
            match y.iter().map(|f| f.formula(&load_variables(D))).collect::<Result<Vec<_>, _>>() {
                Ok(y) => loads.manufactured = y.try_into().ok().map(Manufactured::new),
                Err(error) => problems.push(Problem::new("manufactured.y", error.to_string(), "", "")),
            }
        }
        for (k, spec) in case.loads.iter().enumerate() {
            let label = format!("the load \"{}\"", spec.label());
            let mut formulas = |specs: &[FormulaSpec]| -> Vec<Formula> {
                let read = |f: &FormulaSpec| f.formula(&load_variables(D));
                specs.iter().map(read).collect::<Result<_, _>>().unwrap_or_else(|error| {
                    problems.push(Problem::new(format!("load[{k}]"), error.to_string(), "", ""));
                    Vec::new()
                })
            };
            let (value, is_pressure) = match &spec.kind {
                LoadKind::Traction { value, .. } | LoadKind::BodyForce { value, .. } => (formulas(value), false),
                LoadKind::Pressure { value, .. } => (formulas(std::slice::from_ref(value)), true),
            };
            if let LoadKind::BodyForce { body, .. } = &spec.kind {
                let Some(part) = parts.iter().position(|p| p.name == *body) else { continue };
                loads.body_forces.push(BodyForce { label, part, value, table: spec.table.clone() });
                continue;
            }
            for (j, name) in spec.sides().iter().enumerate() {
                let found = match super::build::side(parts, name, &format!("load[{k}].on[{j}]")) {
                    Ok(side) => &parts[side.part],
                    Err(problem) => {
                        problems.push(problem);
                        continue;
                    }
                };
                let mesh = found.body.mesh();
                let facets = name.split_once('.').and_then(|(_, side)| mesh.sides.get(side));
                let side = LoadedSide::new(mesh, facets.map_or(&[], Vec::as_slice), found.first_node, case.thickness);
                let load = SideLoad { label: label.clone(), side, value: value.clone(), table: spec.table.clone() };
                if is_pressure { &mut loads.pressures } else { &mut loads.tractions }.push(load);
            }
        }
        loads
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.tractions.is_empty()
            && self.pressures.is_empty()
            && self.body_forces.is_empty()
            && self.manufactured.is_none()
    }

    /// Whether some depend on the positions.
    pub fn follow(&self) -> bool {
        !self.pressures.is_empty()
    }

    /// Evaluates all formulas and tables at a time; `out` is reused.
    ///
    /// # Errors
    /// The first formula without a finite value.
    pub fn at(&self, parts: &[Part<D>], dofs: usize, time: f64, out: &mut LoadsAt) -> Result<(), NoValue> {
        out.dead.clear();
        out.dead.resize(dofs, 0.0);
        let factor = |table: &Option<TableSpec>| table.as_ref().map_or(1.0, |t| t.value(time));
        for load in &self.tractions {
            let factor = factor(&load.table);
            let mut refused = None;
            let traction = load.side.positions().map(|x| {
                vector::<D>(&load.value, &load.label, x, time, factor).unwrap_or_else(|error| {
                    refused.get_or_insert(error);
                    [0.0; D]
                })
            });
            load.side.add_traction(traction, out.dead.as_chunks_mut::<D>().0);
            if let Some(error) = refused {
                return Err(error);
            }
        }
        for load in &self.body_forces {
            add_body_force(load, &parts[load.part], time, factor(&load.table), &mut out.dead)?;
        }
        if let Some(motion) = &self.manufactured {
            motion.add_load(parts, time, &mut out.dead)?;
        }
        out.pressures.resize_with(self.pressures.len(), Vec::new);
        for (load, pressures) in self.pressures.iter().zip(&mut out.pressures) {
            let factor = factor(&load.table);
            pressures.clear();
            for x in load.side.positions() {
                pressures.push(factor * value(&load.value[0], &load.label, x, time)?);
            }
        }
        Ok(())
    }

    /// Overwrites `force` with f_ext at positions `y`.
    pub fn force_into(&self, at: &LoadsAt, y: &[f64], force: &mut [f64]) {
        force.copy_from_slice(&at.dead);
        let (y, force) = (y.as_chunks::<D>().0, force.as_chunks_mut::<D>().0);
        for (load, pressure) in self.pressures.iter().zip(&at.pressures) {
            load.side.add_pressure(pressure, y, force);
        }
    }

    /// Calls `visit(nodes, tangent)` for every facet under pressure, tangent = ∂f_ext/∂y (`(n·D)²`, row-major); without `at`, of zeros.
    pub(crate) fn each_facet_tangent(&self, at: Option<&LoadsAt>, mut visit: impl FnMut(&[usize], &[f64])) {
        let mut tangent = [0.0; (carom_solid::MAX_FACET_NODES * 2).pow(2)];
        for (k, load) in self.pressures.iter().enumerate() {
            for (facet, nodes) in load.side.facets().iter().enumerate() {
                let tangent = &mut tangent[..(nodes.len() * D).pow(2)];
                if let Some(at) = at {
                    load.side.facet_tangent(facet, &at.pressures[k], tangent);
                }
                visit(nodes, tangent);
            }
        }
    }
}

fn vector<const D: usize>(
    formulas: &[Formula],
    label: &str,
    place: &[f64; D],
    time: f64,
    factor: f64,
) -> Result<[f64; D], NoValue> {
    let mut vector = [0.0; D];
    for i in 0..D {
        vector[i] = factor * value(&formulas[i], label, place, time)?;
    }
    Ok(vector)
}

/// fᵃ += ∫φᵃ b dΩ₀.
fn add_body_force<const D: usize>(
    load: &BodyForce,
    part: &Part<D>,
    time: f64,
    factor: f64,
    force: &mut [f64],
) -> Result<(), NoValue> {
    let mesh = part.body.mesh();
    let mut refused = None;
    for cell in 0..mesh.cell_count() {
        let mut local = [0.0; MAX_CELL_DOFS];
        part.body.each_volume_point(cell, &mut |shape, place, volume| match vector::<D>(
            &load.value,
            &load.label,
            place,
            time,
            factor,
        ) {
            Ok(density) => {
                for (a, phi) in shape.iter().enumerate() {
                    for i in 0..D {
                        local[a * D + i] += phi * volume * density[i];
                    }
                }
            }
            Err(error) => {
                refused.get_or_insert(error);
            }
        });
        for (a, node) in mesh.cell(cell).iter().enumerate() {
            for i in 0..D {
                force[(part.first_node + node) * D + i] += local[a * D + i];
            }
        }
    }
    refused.map_or(Ok(()), Err)
}
