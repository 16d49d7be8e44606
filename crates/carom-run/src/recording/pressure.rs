//! The pressure of contact on both sides of every pair, at the nodes of their surfaces.
//!
//! The force −λ∇g of a pair acts on its own node and on those of the facet opposite. With the
//! Bernstein polynomials Bᵢ of the facets, which span the shape functions φⱼ and are ≥ 0:
//!
//! ```text
//! Fᵢ = Σⱼ Bᵢ(xⱼ) fⱼ,    pᵢ = Fᵢ / ∫ Bᵢ da,    p = Σᵢ pᵢ Bᵢ
//! ```
//!
//! where f are the nodal forces. The nodal forces of a uniform pressure, fⱼ = p ∫ φⱼ da, give p;
//! the resultant is that of the forces, ∫ p da = Σ f, because the Bᵢ sum to one; and a force at a
//! point of a facet gives a pressure ≥ 0 there and on its neighbours, bounded by the force over a
//! part of their area. Of degree 1, Bᵢ = φᵢ. ∫ φᵢ da itself is zero at the corners of a triangle of
//! degree 2.
//!
//! At a sharp edge only the facets that face the force carry it: facet e counts in ∫ Bᵢ da with
//! min(1, 2cₑ/max c), cₑ the cosine between Fᵢ and its inner normal. Facets within 60° of the
//! direction that faces the force best count fully, those across a right angle not at all.

use std::collections::{BTreeMap, BTreeSet};

use carom_algebra::Vector;
use carom_contact::Rows;
use carom_mechanics::State;
use carom_mechanics::model::Model;
use carom_solid::FacetShape;

/// The surfaces of all contacts of a model.
pub(super) struct Surfaces {
    facets: Vec<Facet>,
    /// Facets of each node.
    around: BTreeMap<usize, Vec<usize>>,
    thickness: f64,
}

struct Facet {
    shape: FacetShape,
    nodes: Vec<usize>,
}

/// Forces on a node, or of a Bernstein polynomial.
#[derive(Clone, Copy)]
struct Load {
    /// Sum of the forces' sizes.
    size: f64,
    /// Their resultant.
    force: Vector<3>,
}

/// A facet at a state.
struct Area {
    /// ∫ Bᵢ da of its nodes.
    parts: Vec<f64>,
    /// Unit outward normal, mean over the facet; zero of a point.
    normal: Vector<3>,
}

impl Load {
    const NONE: Self = Self { size: 0.0, force: Vector::ZERO };

    fn add(&mut self, other: Self, factor: f64) {
        self.size += factor * other.size;
        self.force += other.force * factor;
    }
}

impl Surfaces {
    /// The surfaces of the contacts of a model with bodies of this thickness.
    pub(super) fn new(model: &Model, thickness: f64) -> Self {
        let mut surfaces = Self { facets: Vec::new(), around: BTreeMap::new(), thickness };
        // Several contacts may share a side.
        let mut known = BTreeSet::new();
        for (shape, facets) in model.contacts.iter().flat_map(|contact| &contact.facets) {
            for nodes in facets {
                let mut key = nodes.clone();
                key.sort_unstable();
                if known.insert(key) {
                    nodes.iter().for_each(|&node| {
                        surfaces.around.entry(node).or_default().push(surfaces.facets.len());
                    });
                    surfaces.facets.push(Facet { shape: *shape, nodes: nodes.clone() });
                }
            }
        }
        surfaces
    }

    /// The pressures of a state by node; nodes that are not listed have none. Where a contact has a
    /// pressure field, that of its secondary side is taken from it.
    pub(super) fn pressures(&self, model: &Model, state: &State) -> BTreeMap<usize, f64> {
        let mut pressures = self.of_forces(model, state);
        for (contact, pairs) in model.contacts.iter().zip(&state.pairs) {
            for of in contact.kinematics.pressure_field(pairs, &state.y, self.thickness) {
                // Forces of other contacts may act there, too.
                *pressures.entry(of.node).or_default() += of.actual;
            }
        }
        pressures
    }

    /// The pressures per area of the reference surface of contacts with a pressure field, by node
    /// of their secondary sides.
    pub(super) fn nominal_pressures(&self, model: &Model, state: &State) -> BTreeMap<usize, f64> {
        let mut pressures = BTreeMap::new();
        for (contact, pairs) in model.contacts.iter().zip(&state.pairs) {
            for of in contact.kinematics.pressure_field(pairs, &state.y, self.thickness) {
                *pressures.entry(of.node).or_default() += of.nominal;
            }
        }
        pressures
    }

    /// The pressures that follow from the forces on nodes.
    fn of_forces(&self, model: &Model, state: &State) -> BTreeMap<usize, f64> {
        let loads = self.loads(&forces(model, state));
        let reached: BTreeSet<usize> = loads.keys().flat_map(|node| &self.around[node]).copied().collect();
        let areas: BTreeMap<usize, Area> =
            reached.iter().map(|&facet| (facet, self.area(facet, &state.y))).collect();
        let coefficient = |(&node, load): (&usize, &Load)| {
            let area = self.loaded_area(node, load, &areas);
            (node, if area > 0.0 { load.size / area } else { 0.0 })
        };
        let coefficients: BTreeMap<usize, f64> = loads.iter().map(coefficient).collect();
        let mut pressures = BTreeMap::new();
        for facet in reached.iter().map(|&facet| &self.facets[facet]) {
            for (node, values) in facet.nodes.iter().zip(facet.shape.bernstein_at_nodes()) {
                let of = |(i, value): (&usize, &f64)| value * coefficients.get(i).copied().unwrap_or(0.0);
                // Neighbouring facets agree: at a node of both, no other polynomial differs from
                // zero.
                pressures.entry(*node).or_insert_with(|| facet.nodes.iter().zip(values).map(of).sum());
            }
        }
        pressures
    }

    /// The forces Fᵢ from nodal forces.
    fn loads(&self, forces: &BTreeMap<usize, Load>) -> BTreeMap<usize, Load> {
        let mut loads: BTreeMap<usize, Load> = BTreeMap::new();
        for (node, force) in forces {
            // The carrier of an obstacle has no facets; of several facets any one will do, because
            // the polynomials that differ from zero at a node are those of facets around it.
            let Some(facet) = self.around.get(node).map(|around| &self.facets[around[0]]) else { continue };
            let place = facet.nodes.iter().position(|n| n == node).unwrap_or_default();
            for (i, &value) in facet.nodes.iter().zip(&facet.shape.bernstein_at_nodes()[place]) {
                if value != 0.0 {
                    loads.entry(*i).or_insert(Load::NONE).add(*force, value);
                }
            }
        }
        loads
    }

    /// ∫ Bᵢ da over the facets that face the force.
    fn loaded_area(&self, node: usize, load: &Load, areas: &BTreeMap<usize, Area>) -> f64 {
        let around = self.around[&node].iter().map(|facet| (&self.facets[*facet], &areas[facet]));
        let facing = |area: &Area| -area.normal.dot(&load.force);
        let best = around.clone().map(|(_, area)| facing(area)).fold(0.0, f64::max);
        let part = |(facet, area): (&Facet, &Area)| {
            let share = if best > 0.0 { (2.0 * facing(area) / best).clamp(0.0, 1.0) } else { 1.0 };
            let place = facet.nodes.iter().position(|n| *n == node).unwrap_or_default();
            share * area.parts[place]
        };
        around.map(part).sum()
    }

    fn area(&self, facet: usize, y: &[f64]) -> Area {
        let Facet { shape, nodes } = &self.facets[facet];
        let d = shape.dimension();
        let mut of_shape = vec![0.0; nodes.len()];
        let mut normal = Vector::ZERO;
        // Exact for constant |y'| and φ of degree 3.
        for (xi, weight) in shape.rule(5) {
            let functions = shape.functions(xi);
            let tangents = functions.slopes.map(|slopes| {
                let mut tangent = [0.0; 3];
                for (&node, slope) in nodes.iter().zip(slopes) {
                    (0..d).for_each(|i| tangent[i] += slope * y[node * d + i]);
                }
                tangent
            });
            let area = Vector(shape.area_vector(tangents, 1.0)) * (weight * self.thickness);
            of_shape.iter_mut().zip(functions.values).for_each(|(sum, value)| *sum += value * area.norm());
            normal += area;
        }
        let at_nodes = shape.bernstein_at_nodes();
        let part = |i: usize| of_shape.iter().zip(at_nodes).map(|(area, values)| values[i] * area).sum();
        let has_normal = *shape != FacetShape::Point && normal.norm() > 0.0;
        Area {
            parts: (0..nodes.len()).map(part).collect(),
            normal: if has_normal { normal * (1.0 / normal.norm()) } else { Vector::ZERO },
        }
    }
}

/// The nodal forces of all active pairs on both sides.
fn forces(model: &Model, state: &State) -> BTreeMap<usize, Load> {
    let mut forces: BTreeMap<usize, Load> = BTreeMap::new();
    let mut rows = Rows::new(model.dimension);
    for (contact, pairs) in model.contacts.iter().zip(&state.pairs) {
        for pair in pairs.iter().filter(|pair| pair.active) {
            rows.clear();
            if contact.kinematics.measure(&mut pair.clone(), &state.y, &mut rows).is_err() {
                continue;
            }
            let row = rows.row(0);
            let is_of_field = contact.kinematics.is_of_field(pair.node);
            let mean = Vector(row.first());
            let along = if is_of_field { mean * mean.norm().recip() } else { mean };
            for (k, (&node, slope)) in
                row.nodes.iter().zip(row.gradient.chunks_exact(model.dimension)).enumerate()
            {
                if is_of_field && k < row.own {
                    // The pressure field gives the pressure of the secondary side.
                    continue;
                }
                let mut force = Vector::ZERO;
                slope.iter().enumerate().for_each(|(i, slope)| force[i] = -pair.lambda * slope);
                // The sides are pressed by opposite forces.
                let sign = if k < row.own { 1.0 } else { -1.0 };
                forces
                    .entry(node)
                    .or_insert(Load::NONE)
                    .add(Load { size: sign * along.dot(&force), force }, 1.0);
            }
        }
    }
    forces
}
