//! Nodes that are points of other bodies. A material point is a constant combination of nodes,
//!
//! ```text
//! y_P = Σ w_a y_a,   Σ w_a = 1
//! ```
//!
//! so a node that is tied to a point P has the same combination of positions, velocities and
//! accelerations, y = T q with the remaining nodes q. Every linear problem is solved for those:
//! forces are pulled back by Tᵀ (`gather`), motions follow by T (`carry`). What remains of the
//! balance at a tied node is the force of the tie, as the reaction of a support is that of a
//! constrained dof; it does no work, and T makes force and moment balance.

use std::collections::BTreeMap;

/// A node as a point: the nodes that carry it, with their weights.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Global number of the node.
    pub node: usize,
    /// Global numbers of nodes that are no points themselves, with weights of sum 1.
    pub weights: Vec<(usize, f64)>,
}

/// The nodes of a model that are points of others.
#[derive(Clone, Debug, Default)]
pub struct Points {
    dimension: usize,
    list: Vec<Point>,
    /// Place in the list of each node, `u32::MAX` of others; empty without points.
    places: Vec<u32>,
    /// Points that are carried by points, as they were given; each before those that carry it.
    chained: Vec<Point>,
}

/// A chain of points that leads back to its first node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the position of node {node} would depend on itself")]
pub struct Circular {
    /// The node.
    pub node: usize,
}

/// Weights that are round-off.
const NOTHING: f64 = 1e-14;

impl Points {
    /// The points of a model with `nodes` nodes. One that is carried by points is carried by what
    /// carries those.
    ///
    /// # Errors
    /// If a chain of points is circular.
    pub fn new(dimension: usize, nodes: usize, given: Vec<Point>) -> Result<Self, Circular> {
        if given.is_empty() {
            return Ok(Self { dimension, ..Self::default() });
        }
        let mut places = vec![u32::MAX; nodes];
        let mut list: Vec<Point> = Vec::with_capacity(given.len());
        let mut chained = Vec::new();
        for point in carriers_first(given)? {
            let is_point = |node: usize| places[node] != u32::MAX;
            let of_carrier = |&(node, weight): &(usize, f64)| -> Vec<(usize, f64)> {
                if !is_point(node) {
                    return vec![(node, weight)];
                }
                let weights = &list[places[node] as usize].weights;
                weights.iter().map(|&(carrier, share)| (carrier, weight * share)).collect()
            };
            let weights = summed(point.weights.iter().flat_map(of_carrier).collect());
            if point.weights.iter().any(|(node, _)| is_point(*node)) {
                chained.push(point.clone());
            }
            places[point.node] = list.len() as u32;
            list.push(Point { node: point.node, weights });
        }
        chained.reverse();
        list.sort_unstable_by_key(|point| point.node);
        for (place, point) in list.iter().enumerate() {
            places[point.node] = place as u32;
        }
        Ok(Self { dimension, list, places, chained })
    }

    /// Whether no node is a point.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// All points, by their nodes.
    pub fn iter(&self) -> impl Iterator<Item = &Point> {
        self.list.iter()
    }

    /// The nodes that carry a node with their weights, if it is a point.
    pub fn of(&self, node: usize) -> Option<&[(usize, f64)]> {
        let place = *self.places.get(node)?;
        self.list.get(place as usize).map(|point| point.weights.as_slice())
    }

    /// The dofs that carry a dof with their weights: itself unless its node is a point.
    pub(crate) fn carriers(&self, dof: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let d = self.dimension.max(1);
        let weights = self.of(dof / d);
        let own = if weights.is_none() { Some((dof, 1.0)) } else { None };
        let carrying = weights.unwrap_or_default().iter();
        own.into_iter().chain(carrying.map(move |&(node, weight)| (node * d + dof % d, weight)))
    }

    /// Entries of a row pulled back to the dofs that carry its own; a dof may occur repeatedly.
    pub(crate) fn pulled<'a>(
        &'a self,
        entries: impl Iterator<Item = (usize, f64)> + 'a,
    ) -> impl Iterator<Item = (usize, f64)> + 'a {
        entries.flat_map(|(dof, slope)| {
            self.carriers(dof).map(move |(carrier, weight)| (carrier, weight * slope))
        })
    }

    /// The nodes that carry these, which are replaced.
    pub(crate) fn carrying(&self, nodes: &[usize]) -> Vec<usize> {
        let mut all = Vec::with_capacity(nodes.len());
        for &node in nodes {
            match self.of(node) {
                Some(weights) => all.extend(weights.iter().map(|(carrier, _)| *carrier)),
                None => all.push(node),
            }
        }
        all
    }

    /// Gives the points the motion of what carries them: x := T x.
    pub fn carry(&self, x: &mut [f64]) {
        let d = self.dimension;
        for point in &self.list {
            for i in 0..d {
                let sum = point.weights.iter().map(|(node, weight)| weight * x[node * d + i]).sum();
                x[point.node * d + i] = sum;
            }
        }
    }

    /// Adds to the forces on points what they carry to the points that carry them: the forces that
    /// ties transmit, where several meet at a node.
    pub fn pass_on(&self, forces: &mut [f64]) {
        let d = self.dimension;
        for point in &self.chained {
            for &(carrier, weight) in point.weights.iter().filter(|(node, _)| self.of(*node).is_some()) {
                for axis in 0..d {
                    forces[carrier * d + axis] += weight * forces[point.node * d + axis];
                }
            }
        }
    }

    /// Gives the forces on the points to what carries them: f := Tᵀf, zero at the points.
    pub fn gather(&self, forces: &mut [f64]) {
        let d = self.dimension;
        for point in &self.list {
            for i in 0..d {
                let force = std::mem::take(&mut forces[point.node * d + i]);
                for (node, weight) in &point.weights {
                    forces[node * d + i] += weight * force;
                }
            }
        }
    }
}

/// Points in an order in which each comes after those that carry it.
///
/// # Errors
/// If there is none.
fn carriers_first(given: Vec<Point>) -> Result<Vec<Point>, Circular> {
    let mut waiting: BTreeMap<usize, Point> = given.into_iter().map(|point| (point.node, point)).collect();
    let mut ordered = Vec::with_capacity(waiting.len());
    while let Some(first) = waiting.keys().next().copied() {
        let is_ready =
            |point: &&Point| !point.weights.iter().any(|(carrier, _)| waiting.contains_key(carrier));
        let ready: Vec<usize> = waiting.values().filter(is_ready).map(|point| point.node).collect();
        if ready.is_empty() {
            return Err(Circular { node: first });
        }
        ordered.extend(ready.iter().filter_map(|node| waiting.remove(node)));
    }
    Ok(ordered)
}

/// One weight a node, ascending; without those that are round-off.
fn summed(mut weights: Vec<(usize, f64)>) -> Vec<(usize, f64)> {
    weights.sort_by_key(|(node, _)| *node);
    let mut sums: Vec<(usize, f64)> = Vec::new();
    for (node, weight) in weights {
        match sums.last_mut() {
            Some((last, sum)) if *last == node => *sum += weight,
            _ => sums.push((node, weight)),
        }
    }
    sums.retain(|(_, weight)| weight.abs() > NOTHING);
    sums
}
