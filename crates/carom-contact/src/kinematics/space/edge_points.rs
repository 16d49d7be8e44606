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

use std::sync::{Mutex, PoisonError};

use carom_algebra::Vector;

use super::boundary::Boundary;
use super::node_to_patch::NodeToPatch;
use super::patch::place;
use crate::friction::FrictionState;
use crate::kinematics::Kinematics;
use crate::pair::{ContactError, Pair, PairEvent, Pairing};
use crate::rows::Rows;

/// Points of the sharp edges of a side against the facets of the other one.
#[derive(Debug)]
pub struct EdgePoints {
    /// Contact of the points as of nodes.
    points: NodeToPatch,
    /// Number of the first point.
    first: usize,
    /// Nodes of the edge of every point, with their weights.
    nodes: Vec<Vec<(usize, f64)>>,
    /// A node of the edge of every point, which represents the point.
    names: Vec<usize>,
    /// Positions of the nodes and of the points, in memory that is reused.
    places: Mutex<[Vec<f64>; 2]>,
}

impl EdgePoints {
    /// Points of the sharp edges of the side `own` against the side `other`, which each of them may
    /// enter by `depth`; `reference`: the reference positions of all nodes.
    pub fn new(own: &Boundary, other: Boundary, depth: f64, reference: &[f64]) -> Self {
        let points = own.edge_points(reference);
        let first = reference.len() / 3;
        let numbers: Vec<usize> = (first..first + points.len()).collect();
        let allowed = vec![depth; points.len()];
        let own = own.clone().with_points(first, &points);
        Self {
            first,
            names: points.iter().map(|point| point.nodes[0].0).collect(),
            points: NodeToPatch::new(numbers, other).with_allowed(allowed).of_body(own),
            nodes: points.into_iter().map(|point| point.nodes).collect(),
            places: Mutex::default(),
        }
    }

    /// Contact of points of the primary side with the secondary one.
    #[must_use]
    pub fn reversed(self) -> Self {
        Self { points: self.points.reversed(), ..self }
    }

    /// The positions of all nodes, followed by those of the points.
    fn extend(&self, y: &[f64], places: &mut Vec<f64>) {
        places.clear();
        places.extend_from_slice(y);
        for nodes in &self.nodes {
            let weighted = |&(node, weight): &(usize, f64)| place(y, node) * weight;
            let point = nodes.iter().map(weighted).fold(Vector::ZERO, |sum, part| sum + part);
            places.extend(point.0);
        }
    }

    /// The result of a function of the positions of all nodes and points.
    fn with_points<T>(&self, y: &[f64], of: impl FnOnce(&[f64]) -> T) -> T {
        let [places, _] = &mut *self.places.lock().unwrap_or_else(PoisonError::into_inner);
        self.extend(y, places);
        of(places)
    }

    /// Adds rows of a point as rows of the nodes of its edge.
    fn share(&self, point: usize, of_point: &Rows, rows: &mut Rows) {
        let own = &self.nodes[point];
        for row in of_point.iter() {
            let Some(others) = row.nodes.get(1..) else {
                rows.push_open();
                continue;
            };
            let slope = |k: usize, weight: f64| std::array::from_fn(|i| weight * row.gradient[3 * k + i]);
            let of_edge = own.iter().map(|&(node, weight)| (node, slope(0, weight)));
            let of_facet = others.iter().enumerate().map(|(k, &node)| (node, slope(k + 1, 1.0)));
            rows.push::<3>(row.gap, of_edge.chain(of_facet));
            rows.begin_with_edge(own.len());
            rows.reverse_from(rows.len() - 1, row.reversed);
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

    fn rubbing(&self) -> usize {
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
        let mut of_points = Vec::new();
        let [start, end] = &mut *self.places.lock().unwrap_or_else(PoisonError::into_inner);
        self.extend(before, start);
        self.extend(now, end);
        let changed = self.points.search(start, end, pairing, &mut of_points);
        pairing.pairs.iter_mut().for_each(|pair| pair.tangential.friction_state = FrictionState::FREE);
        events.extend(of_points.into_iter().map(|event| self.named(event)));
        changed
    }

    /// None: a point is held once it is too deep.
    fn met(&self, points: &[usize], _: &[f64], _: &[f64]) -> Vec<Option<f64>> {
        vec![None; points.len()]
    }

    fn update_facets(&self, now: &[f64], pairing: &mut Pairing, events: &mut Vec<PairEvent>) -> bool {
        let mut of_points = Vec::new();
        let changed = self.with_points(now, |now| self.points.update_facets(now, pairing, &mut of_points));
        events.extend(of_points.into_iter().map(|event| self.named(event)));
        changed
    }

    fn measure(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let mut of_point = Rows::new(3);
        self.with_points(y, |y| self.points.measure(pair, y, &mut of_point))
            .map_err(|error| error.at_node(self.names[pair.node]))?;
        self.share(pair.node, &of_point, rows);
        Ok(())
    }

    fn curvature_into(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]) {
        let mut row = Rows::new(3);
        let mut of_point = Vec::new();
        let is_measured = self.with_points(y, |y| {
            let is_measured = self.points.measure(&mut { *pair }, y, &mut row).is_ok();
            if is_measured {
                let size = row.row(0).gradient.len();
                of_point.resize(size * size, 0.0);
                self.points.curvature_into(pair, y, &mut of_point);
            }
            is_measured
        });
        if !is_measured {
            curvature.fill(0.0);
            return;
        }
        let count = row.row(0).gradient.len();
        let own = &self.nodes[pair.node];
        let size = 3 * (own.len() - 1) + count;
        // The dof of the point's row that stands for a dof of the edge's row, and its share in it.
        let of = |dof: usize| match own.get(dof / 3) {
            Some(&(_, weight)) => (dof % 3, weight),
            None => (dof - 3 * (own.len() - 1), 1.0),
        };
        for row in 0..size {
            let (from, share) = of(row);
            for column in 0..size {
                let (to, other) = of(column);
                curvature[row * size + column] = share * other * of_point[from * count + to];
            }
        }
    }

    fn slip(&self, pair: &Pair, y: &[f64], moved: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let mut of_point = Rows::new(3);
        self.with_points(y, |y| self.points.slip(pair, y, moved, &mut of_point))?;
        self.share(pair.node, &of_point, rows);
        Ok(())
    }

    /// Zero: edges have no friction, whose force would need it.
    fn slip_derivative_into(&self, _: &Pair, _: &[f64], _: &[f64], _: usize, matrix: &mut [f64]) {
        matrix.fill(0.0);
    }
}
