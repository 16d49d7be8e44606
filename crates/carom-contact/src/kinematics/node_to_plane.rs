//! Secondary nodes against a rigid half-space: g = (y − p)·n, ∇g = n, ∇²g = 0. In any dimension.

use super::{Kinematics, watch_every_node};
use crate::pair::{ContactError, Pair, PairEvent, Pairing};
use crate::rows::Rows;

/// A rigid plane as primary.
#[derive(Clone, Debug)]
pub struct NodeToPlane {
    secondary: Vec<usize>,
    dimension: usize,
    point: [f64; 3],
    normal: [f64; 3],
}

impl NodeToPlane {
    /// Keeps the secondary nodes on the side of `point` to which `normal` (any length > 0) points.
    /// Both have one component per dimension, at most three.
    pub fn new(secondary: Vec<usize>, point: &[f64], normal: &[f64]) -> Self {
        let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        let padded = |x: &[f64], factor: f64| std::array::from_fn(|i| x.get(i).map_or(0.0, |x| x * factor));
        Self {
            secondary,
            dimension: point.len(),
            point: padded(point, 1.0),
            normal: padded(normal, length.recip()),
        }
    }

    fn gap(&self, node: usize, y: &[f64]) -> f64 {
        let y = &y[node * self.dimension..(node + 1) * self.dimension];
        y.iter().zip(&self.point).zip(&self.normal).map(|((y, p), n)| (y - p) * n).sum()
    }
}

impl Kinematics for NodeToPlane {
    fn secondary(&self) -> &[usize] {
        &self.secondary
    }

    fn facet_nodes(&self, _: usize) -> &[usize] {
        &[]
    }

    fn stencil(&self) -> usize {
        1
    }

    fn signed_distance(&self, node: usize, y: &[f64]) -> Option<f64> {
        Some(self.gap(self.secondary[node], y))
    }

    fn search(&self, _: &[f64], _: &[f64], pairing: &mut Pairing, _: &mut Vec<PairEvent>) -> bool {
        watch_every_node(self.secondary.len(), &mut pairing.pairs);
        false
    }

    fn measure(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let node = self.secondary[pair.node];
        rows.push(self.gap(node, y), [(node, self.normal)]);
        Ok(())
    }

    fn curvature_into(&self, _: &Pair, _: &[f64], curvature: &mut [f64]) {
        curvature[..self.dimension * self.dimension].fill(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gap_is_the_signed_distance() {
        let plane = NodeToPlane::new(vec![0], &[0.0, 1.0], &[0.0, 4.0]);
        let (mut pairing, mut rows) = (Pairing::default(), Rows::new(2));
        plane.search(&[], &[], &mut pairing, &mut Vec::new());
        plane.measure(&mut pairing.pairs[0], &[7.0, 0.25], &mut rows).unwrap();
        assert_eq!((rows.row(0).gap, rows.row(0).gradient), (-0.75, &[0.0, 1.0][..]));
    }
}
