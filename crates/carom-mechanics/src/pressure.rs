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
//!
//! Several contacts may press on a node: on one side, as two bodies beside each other, or on two,
//! as the floor and the wall of a corner. In the direction dₖ of contact k acts
//! Σⱼ pⱼ max(0, dⱼ·dₖ).

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use carom_algebra::Vector;
use carom_contact::{Pair, Rows};
use carom_solid::{FacetFunctions, FacetShape};

use crate::model::{Contact, Model};
use crate::state::State;

/// The surfaces of all contacts of a model, and what their pressures need of them.
#[derive(Debug)]
pub struct Surfaces {
    /// Nodes of the facets, ascending; the others refer to them by their place here.
    nodes: Vec<usize>,
    facets: Vec<Facet>,
    /// Facets of each node.
    around: Vec<Vec<usize>>,
    thickness: f64,
}

#[derive(Debug)]
struct Facet {
    shape: FacetShape,
    /// Places of its nodes.
    nodes: Vec<usize>,
    rule: Arc<[RulePoint]>,
}

/// A point of a rule for ∫ φ da, which is exact on facets that remain flat, where |y'| is constant.
#[derive(Debug)]
struct RulePoint {
    functions: FacetFunctions,
    weight: f64,
}

/// Degree of the rule on facets that may be curved.
const CURVED: usize = 5;
/// Facets that a thread measures.
const SHARE: usize = 64;

/// Force, relative to the largest one of a contact, that has no direction.
const ROUND_OFF: f64 = 1e-9;

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
    pub fn new(model: &Model, thickness: f64) -> Self {
        let of_contacts = || model.contacts.iter().flat_map(|contact| &contact.facets);
        let mut nodes: Vec<usize> =
            of_contacts().flat_map(|(_, facets)| facets.iter().flatten()).copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let around = vec![Vec::new(); nodes.len()];
        let mut surfaces = Self { nodes, facets: Vec::new(), around, thickness };
        // Several contacts may share a side.
        let mut known = BTreeSet::new();
        for (shape, facets) in of_contacts() {
            let at = |(xi, weight)| RulePoint { functions: shape.functions(xi), weight };
            let is_flat = shape.degree() == 1 && shape.corners() < 4;
            let rule = shape.rule(if is_flat { 1 } else { CURVED });
            let rule: Arc<[RulePoint]> = rule.into_iter().map(at).collect();
            for nodes in facets {
                let mut key = nodes.clone();
                key.sort_unstable();
                if known.insert(key) {
                    let nodes: Vec<usize> = nodes.iter().filter_map(|node| surfaces.place(*node)).collect();
                    nodes.iter().for_each(|&node| surfaces.around[node].push(surfaces.facets.len()));
                    surfaces.facets.push(Facet { shape: *shape, nodes, rule: rule.clone() });
                }
            }
        }
        surfaces
    }

    /// The pressures of a state with these rows ([`active_rows`](crate::active_rows)). Where a
    /// contact has a pressure field, that of its secondary side is taken from it.
    pub fn pressures(&self, model: &Model, state: &State, rows: &[Rows]) -> Pressures {
        let contacts = model.contacts.iter().zip(&state.pairs).zip(rows);
        let of_contact = |((contact, pairs), rows): ((&Contact, &Vec<Pair>), &Rows)| {
            if pairs.iter().all(|pair| !pair.active) {
                return BTreeMap::new();
            }
            let forces = self.forces(contact, pairs, rows);
            let mut pressing = self.of_forces(model, &state.y, &forces);
            for of in contact.kinematics.pressure_field(pairs, &state.y, self.thickness) {
                let at: &mut Pressing = pressing.entry(of.node).or_insert(Pressing::NONE);
                // The node at the tip of a fold belongs to both flanks.
                at.actual = if contact.itself { at.actual.max(of.actual) } else { at.actual + of.actual };
                at.nominal += of.nominal;
            }
            pressing
        };
        Pressures { contacts: contacts.map(of_contact).collect() }
    }

    /// Place of a node among those of the facets; none of the carrier of an obstacle.
    fn place(&self, node: usize) -> Option<usize> {
        self.nodes.binary_search(&node).ok()
    }

    /// The pressures that follow from the forces of a contact on nodes.
    fn of_forces(&self, model: &Model, y: &[f64], forces: &[Option<Load>]) -> BTreeMap<usize, Pressing> {
        let loads = self.loads(forces);
        let loaded = |node: &usize| loads[*node].is_some();
        let mut reached: Vec<usize> =
            (0..loads.len()).filter(loaded).flat_map(|node| &self.around[node]).copied().collect();
        reached.sort_unstable();
        reached.dedup();
        let mut areas: Vec<Option<Area>> = self.facets.iter().map(|_| None).collect();
        let mut measured: Vec<Option<Area>> = reached.iter().map(|_| None).collect();
        model.threads.for_each_block(&mut measured, SHARE, |first, areas| {
            let facets = &reached[first..];
            areas.iter_mut().zip(facets).for_each(|(area, facet)| *area = Some(self.area(*facet, y)));
        });
        reached.iter().zip(measured).for_each(|(&facet, area)| areas[facet] = area);
        let coefficient = |(node, load): (usize, &Option<Load>)| {
            let load = load.as_ref()?;
            let area = self.loaded_area(node, load, &areas);
            Some(if area > 0.0 { load.size / area } else { 0.0 })
        };
        let coefficients: Vec<Option<f64>> = loads.iter().enumerate().map(coefficient).collect();
        let mut pressures = vec![None; self.nodes.len()];
        for facet in reached.iter().map(|&facet| &self.facets[facet]) {
            for (node, values) in facet.nodes.iter().zip(facet.shape.bernstein_at_nodes()) {
                let of = |(i, value): (&usize, &f64)| value * coefficients[*i].unwrap_or(0.0);
                // Neighbouring facets agree: at a node of both, no other polynomial differs from
                // zero.
                pressures[*node].get_or_insert_with(|| {
                    let mut force = Vector::ZERO;
                    for (i, value) in facet.nodes.iter().zip(values) {
                        force += loads[*i].map_or(Vector::ZERO, |load| load.force * *value);
                    }
                    let actual = facet.nodes.iter().zip(values).map(of).sum();
                    Pressing { actual, nominal: 0.0, force }
                });
            }
        }
        let sizes = pressures.iter().flatten().map(|of: &Pressing| of.force.norm());
        let round_off = ROUND_OFF * sizes.fold(0.0, f64::max);
        let known = self.nodes.iter().zip(pressures).filter_map(|(node, pressing)| Some((*node, pressing?)));
        let directed = |(node, pressing): (usize, Pressing)| {
            let force = if pressing.force.norm() > round_off { pressing.force } else { Vector::ZERO };
            (node, Pressing { force, ..pressing })
        };
        known.map(directed).collect()
    }

    /// The forces Fᵢ from nodal forces.
    fn loads(&self, forces: &[Option<Load>]) -> Vec<Option<Load>> {
        let mut loads = vec![None; forces.len()];
        for (node, force) in forces.iter().enumerate() {
            let Some(force) = force else { continue };
            // Any facet around the node will do: polynomials of other facets are zero there.
            let facet = &self.facets[self.around[node][0]];
            let place = facet.nodes.iter().position(|n| *n == node).unwrap_or_default();
            for (i, &value) in facet.nodes.iter().zip(&facet.shape.bernstein_at_nodes()[place]) {
                if value != 0.0 {
                    loads[*i].get_or_insert(Load::NONE).add(*force, value);
                }
            }
        }
        loads
    }

    /// ∫ Bᵢ da over the facets that face the force.
    fn loaded_area(&self, node: usize, load: &Load, areas: &[Option<Area>]) -> f64 {
        let facets = self.around[node].iter();
        let around = facets.filter_map(|facet| Some((&self.facets[*facet], areas[*facet].as_ref()?)));
        let facing = |area: &Area| -area.normal.dot(&load.force);
        let best = around.clone().map(|(_, area)| facing(area)).fold(0.0, f64::max);
        let part = |(facet, area): (&Facet, &Area)| {
            // Walls that lean over what the body stands on are not loaded.
            let share = if best > 0.0 { (4.0 * facing(area) / best - 2.0).clamp(0.0, 1.0) } else { 1.0 };
            let place = facet.nodes.iter().position(|n| *n == node).unwrap_or_default();
            share * area.parts[place]
        };
        around.map(part).sum()
    }

    fn area(&self, facet: usize, y: &[f64]) -> Area {
        let Facet { shape, nodes, rule } = &self.facets[facet];
        let d = shape.dimension();
        let mut of_shape = vec![0.0; nodes.len()];
        let mut normal = Vector::ZERO;
        for RulePoint { functions, weight } in rule.iter() {
            let tangents = functions.slopes.map(|slopes| {
                let mut tangent = [0.0; 3];
                for (&node, slope) in nodes.iter().zip(slopes) {
                    (0..d).for_each(|i| tangent[i] += slope * y[self.nodes[node] * d + i]);
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

    /// The nodal forces of the active pairs of a contact on both sides.
    fn forces(&self, contact: &Contact, pairs: &[Pair], rows: &Rows) -> Vec<Option<Load>> {
        let mut forces = vec![None; self.nodes.len()];
        let dimension = rows.dimension();
        for (pair, row) in pairs.iter().zip(rows.iter()).filter(|(_, row)| !row.nodes.is_empty()) {
            let is_of_field = contact.kinematics.is_of_field(pair.node);
            let mean = Vector(row.first());
            let along = if is_of_field { mean * mean.norm().recip() } else { mean };
            for (k, (&node, slope)) in row.nodes.iter().zip(row.gradient.chunks_exact(dimension)).enumerate()
            {
                // The pressure field gives the pressure of the secondary side.
                let has_field = is_of_field && k < row.own;
                if has_field && contact.itself {
                    continue;
                }
                let mut force = Vector::ZERO;
                slope.iter().enumerate().for_each(|(i, slope)| force[i] = -pair.lambda * slope);
                // The sides are pressed by opposite forces.
                let sign = if k < row.own { 1.0 } else { -1.0 };
                let size = if has_field { 0.0 } else { sign * along.dot(&force) };
                if let Some(place) = self.place(node) {
                    forces[place].get_or_insert(Load::NONE).add(Load { size, force }, 1.0);
                }
            }
        }
        forces
    }
}

/// The pressures of all contacts of a state.
pub struct Pressures {
    /// By node, those of each contact; nodes that are not listed have none.
    contacts: Vec<BTreeMap<usize, Pressing>>,
}

/// Pressures of a contact on a node.
#[derive(Clone, Copy)]
struct Pressing {
    /// Pressure per area of the deformed surface.
    actual: f64,
    /// Pressure per area of the reference surface, of contacts with a pressure field.
    nominal: f64,
    /// A force in its direction; zero if that is not known.
    force: Vector<3>,
}

impl Pressing {
    const NONE: Self = Self { actual: 0.0, nominal: 0.0, force: Vector::ZERO };
}

impl Pressures {
    /// Pressure at a node in the direction of a contact, per area of the deformed surface.
    pub fn actual(&self, contact: usize, node: usize) -> f64 {
        self.along(contact, node, |pressing| pressing.actual)
    }

    /// Pressure at a node in the direction of a contact, per area of the reference surface, of
    /// contacts with a pressure field.
    pub fn nominal(&self, contact: usize, node: usize) -> f64 {
        self.along(contact, node, |pressing| pressing.nominal)
    }

    /// The nodes on which a contact presses, and the largest pressure in the direction of one.
    pub fn largest(&self) -> BTreeMap<usize, f64> {
        let mut largest = BTreeMap::new();
        for (contact, pressing) in self.contacts.iter().enumerate() {
            for &node in pressing.keys() {
                let pressure = self.actual(contact, node);
                largest
                    .entry(node)
                    .and_modify(|most: &mut f64| *most = most.max(pressure))
                    .or_insert(pressure);
            }
        }
        largest
    }

    fn along(&self, contact: usize, node: usize, of: impl Fn(&Pressing) -> f64) -> f64 {
        let Some(own) = self.contacts[contact].get(&node) else { return 0.0 };
        let mut sum = of(own);
        for (k, pressing) in self.contacts.iter().enumerate() {
            let Some(other) = pressing.get(&node).filter(|_| k != contact) else { continue };
            let sizes = own.force.norm() * other.force.norm();
            if sizes > 0.0 {
                sum += of(other) * (own.force.dot(&other.force) / sizes).max(0.0);
            }
        }
        sum
    }
}
