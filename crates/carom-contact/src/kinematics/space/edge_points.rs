//! Points of sharp edges, between their nodes, against the facets of the other side: an edge that
//! crosses a dented facet between its nodes enters it with none of them, and crosses no edge.
//!
//! A point x = Σ w_a y_a is a constant combination of the nodes of its edge. It is numbered after
//! all nodes and treated as one of them (`node_to_patch.rs`); the nodes of its edge share the
//! derivatives of its gap:
//!
//! ```text
//! ∂g/∂y_a = w_a ∂g/∂x,    ∂²g/∂y_a∂y_b = w_a w_b ∂²g/∂x²,    ∂²g/∂y_a∂z = w_a ∂²g/∂x∂z
//! ```
//!
//! with z the nodes of the facet. Like smooth nodes of the primary (`../reversed.rs`), points may
//! enter the other side by a small depth, so that nodes and points do not constrain an edge twice.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

use carom_algebra::Vector;

use super::boundary::Boundary;
use super::clear::Clear;
use super::node_to_patch::NodeToPatch;
use super::patch::place;
use crate::kinematics::{BetweenNodes, Kinematics};
use crate::pair::{ContactError, Pair, PairEvent, Pairing};
use crate::rows::Rows;

/// The weights of at most four nodes.
fn weights(nodes: &[(usize, f64)]) -> [f64; 4] {
    std::array::from_fn(|k| nodes.get(k).map_or(0.0, |&(_, weight)| weight))
}

/// Points of the sharp edges of a side against the facets of the other one.
#[derive(Debug)]
pub struct EdgePoints {
    /// Contact of the points as of nodes.
    points: NodeToPatch,
    /// Number of the first point.
    first: usize,
    /// Nodes of the edge of every point.
    edges: Vec<Vec<usize>>,
    /// The weights of those nodes.
    weights: Vec<[f64; 4]>,
    /// A node of the edge of every point, which represents the point.
    names: Vec<usize>,
    tools: Mutex<Tools>,
}

/// Memory that searches reuse; results do not depend on its content.
#[derive(Debug)]
struct Tools {
    /// Positions of the nodes and of the points.
    places: [Vec<f64>; 2],
    /// Whether points may be too deep; none where the surface of the body is not known.
    clear: Option<Clear>,
}

impl EdgePoints {
    /// Points of the sharp edges of the side `own` against the side `other`, which each of them may
    /// enter by `depth`; none if there are no such edges. `earlier`: the nodes of sides whose own
    /// contacts hold the edges that they share with this one; `reference`: the reference positions
    /// of all nodes.
    pub fn new(
        own: &Boundary,
        other: Boundary,
        depth: f64,
        earlier: &BTreeSet<usize>,
        reference: &[f64],
    ) -> Option<Self> {
        let mut points = own.edge_points(reference);
        points.retain(|point| !point.nodes.iter().all(|(node, _)| earlier.contains(node)));
        if points.is_empty() {
            return None;
        }
        let first = reference.len() / 3;
        let numbers: Vec<usize> = (first..first + points.len()).collect();
        let allowed = vec![depth; points.len()];
        let own = own.clone().with_points(first, &points);
        let nodes: Vec<Vec<(usize, f64)>> = points.into_iter().map(|point| point.nodes).collect();
        let clear = other.is_whole().then(|| Clear::new(&nodes, other.clone(), depth));
        Some(Self {
            first,
            names: nodes.iter().map(|nodes| nodes[0].0).collect(),
            edges: nodes.iter().map(|nodes| nodes.iter().map(|&(node, _)| node).collect()).collect(),
            weights: nodes.iter().map(|nodes| weights(nodes)).collect(),
            points: NodeToPatch::new(numbers, other).with_allowed(allowed).of_body(own),
            tools: Mutex::new(Tools { places: [Vec::new(), Vec::new()], clear }),
        })
    }

    /// Contact of points of the primary side with the secondary one.
    #[must_use]
    pub fn reversed(self) -> Self {
        Self { points: self.points.reversed(), ..self }
    }

    /// The nodes of the edge of a point with their weights.
    fn own(&self, point: usize) -> impl Iterator<Item = (usize, f64)> {
        self.edges[point].iter().copied().zip(self.weights[point])
    }

    /// Position of a point.
    fn point(&self, point: usize, y: &[f64]) -> Vector<3> {
        let weighted = |(node, weight)| place(y, node) * weight;
        self.own(point).map(weighted).fold(Vector::ZERO, |sum, part| sum + part)
    }

    /// The positions of all nodes, followed by those of the points.
    fn extend(&self, y: &[f64], places: &mut Vec<f64>) {
        places.clear();
        places.extend_from_slice(y);
        (0..self.edges.len()).for_each(|point| places.extend(self.point(point, y).0));
    }

    /// The result of a function of the positions of all nodes and of one point.
    fn with_point<T>(&self, point: usize, y: &[f64], of: impl FnOnce(&[f64]) -> T) -> T {
        let Tools { places: [places, _], .. } =
            &mut *self.tools.lock().unwrap_or_else(PoisonError::into_inner);
        places.clear();
        places.extend_from_slice(y);
        places.resize(y.len() + 3 * self.edges.len(), 0.0);
        let at = y.len() + 3 * point;
        places[at..at + 3].copy_from_slice(&self.point(point, y).0);
        of(places)
    }

    /// Adds rows of a point as rows of the nodes of its edge.
    fn share(&self, point: usize, of_point: &Rows, rows: &mut Rows) {
        for row in of_point.iter() {
            let Some(others) = row.nodes.get(1..) else {
                rows.push_open();
                continue;
            };
            let slope = |k: usize, weight: f64| std::array::from_fn(|i| weight * row.gradient[3 * k + i]);
            let of_edge = self.own(point).map(|(node, weight)| (node, slope(0, weight)));
            let of_facet = others.iter().enumerate().map(|(k, &node)| (node, slope(k + 1, 1.0)));
            rows.push::<3>(row.gap, of_edge.chain(of_facet));
            rows.begin_with_edge(self.edges[point].len());
            rows.reverse_from(rows.len() - 1, row.reversed);
        }
    }

    /// Spreads a matrix over the dofs of a pair's point and facet to those of the nodes of its edge
    /// and the facet; zero where the pair has no gap.
    fn share_matrix(
        &self,
        pair: &Pair,
        y: &[f64],
        matrix: &mut [f64],
        fill: impl FnOnce(&[f64], &mut [f64]),
    ) {
        let mut row = Rows::new(3);
        let mut of_point = Vec::new();
        let is_measured = self.with_point(pair.node, y, |y| {
            let is_measured = self.points.measure(&mut { *pair }, y, &mut row).is_ok();
            if is_measured {
                let size = row.row(0).gradient.len();
                of_point.resize(size * size, 0.0);
                fill(y, &mut of_point);
            }
            is_measured
        });
        if !is_measured {
            matrix.fill(0.0);
            return;
        }
        let count = row.row(0).gradient.len();
        let own = self.edges[pair.node].len();
        let size = 3 * (own - 1) + count;
        // The dof of the point's row that stands for a dof of the edge's row, and its share in it.
        let of = |dof: usize| {
            let node = dof / 3;
            if node < own { (dof % 3, self.weights[pair.node][node]) } else { (dof - 3 * (own - 1), 1.0) }
        };
        for row in 0..size {
            let (from, share) = of(row);
            for column in 0..size {
                let (to, other) = of(column);
                matrix[row * size + column] = share * other * of_point[from * count + to];
            }
        }
    }

    /// The event of a point as one of its edge.
    fn named(&self, event: PairEvent) -> PairEvent {
        let name = |point: usize| self.names[point - self.first];
        match event {
            PairEvent::HandOver { node, from, to } => PairEvent::HandOver { node: name(node), from, to },
            PairEvent::SlidOff { node, facet } => PairEvent::SlidOff { node: name(node), facet },
        }
    }
}

impl Kinematics for EdgePoints {
    fn secondary(&self) -> &[usize] {
        &self.names
    }

    fn nodes(&self) -> usize {
        0
    }

    fn allowed(&self, point: usize) -> f64 {
        self.points.allowed(point)
    }

    fn keep(&mut self, _: &[f64]) {}

    fn kept(&self, _: usize) -> f64 {
        0.0
    }

    fn facet_nodes(&self, pair: &Pair) -> &[usize] {
        self.points.facet_nodes(pair)
    }

    fn between_nodes(&self, pair: &Pair) -> Option<BetweenNodes<'_>> {
        Some(BetweenNodes { nodes: &self.edges[pair.node], values: self.weights[pair.node] })
    }

    fn is_on_facet(&self, pair: &Pair) -> bool {
        self.points.is_on_facet(pair)
    }

    fn facets(&self, point: usize) -> usize {
        self.points.facets(point)
    }

    /// Infinite: nodes tell where the sides are at the start.
    fn signed_distance(&self, _: usize, _: &[f64]) -> Option<f64> {
        Some(f64::INFINITY)
    }

    fn search(
        &self,
        before: &[f64],
        now: &[f64],
        pairing: &mut Pairing,
        events: &mut Vec<PairEvent>,
    ) -> bool {
        let Tools { places: [start, end], clear } =
            &mut *self.tools.lock().unwrap_or_else(PoisonError::into_inner);
        // The searches that were left out are unknown to the memory of the last one.
        pairing.fresh |= pairing.pairs.is_empty();
        let mut clear =
            clear.as_mut().filter(|clear| pairing.pairs.is_empty() && clear.is_slow([before, now]));
        if clear.as_ref().is_some_and(|clear| clear.holds(now)) {
            return false;
        }
        self.extend(now, end);
        let points = end[3 * self.first..].as_chunks::<3>().0.iter();
        if clear.as_mut().is_some_and(|clear| clear.measure(points, now)) {
            return false;
        }
        self.extend(before, start);
        let mut of_points = Vec::new();
        let changed = self.points.search(start, end, pairing, &mut of_points);
        events.extend(of_points.into_iter().map(|event| self.named(event)));
        changed
    }

    /// None: a point is held once it is too deep.
    fn met(&self, points: &[usize], _: &[f64], _: &[f64]) -> Vec<Option<f64>> {
        vec![None; points.len()]
    }

    fn update_facets(&self, now: &[f64], pairing: &mut Pairing, events: &mut Vec<PairEvent>) -> bool {
        let mut of_points = Vec::new();
        let Tools { places: [places, _], .. } =
            &mut *self.tools.lock().unwrap_or_else(PoisonError::into_inner);
        self.extend(now, places);
        let changed = self.points.update_facets(places, pairing, &mut of_points);
        events.extend(of_points.into_iter().map(|event| self.named(event)));
        changed
    }

    fn measure(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let mut of_point = Rows::new(3);
        self.with_point(pair.node, y, |y| self.points.measure(pair, y, &mut of_point))
            .map_err(|error| error.at_node(self.names[pair.node]))?;
        self.share(pair.node, &of_point, rows);
        Ok(())
    }

    fn curvature_into(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]) {
        self.share_matrix(pair, y, curvature, |y, of_point| self.points.curvature_into(pair, y, of_point));
    }

    fn slip(&self, pair: &Pair, y: &[f64], moved: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let mut of_point = Rows::new(3);
        self.with_point(pair.node, y, |y| self.points.slip(pair, y, moved, &mut of_point))
            .map_err(|error| error.at_node(self.names[pair.node]))?;
        self.share(pair.node, &of_point, rows);
        Ok(())
    }

    fn slip_derivative_into(
        &self,
        pair: &Pair,
        y: &[f64],
        moved: &[f64],
        tangent: usize,
        matrix: &mut [f64],
    ) {
        self.share_matrix(pair, y, matrix, |y, of_point| {
            self.points.slip_derivative_into(pair, y, moved, tangent, of_point);
        });
    }
}
