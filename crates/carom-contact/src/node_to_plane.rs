//! Secondary nodes against a rigid half-space: g = (y − p)·n, ∇g = n, ∇²g = 0. In any dimension.

use carom_algebra::{Mat, Vector};

use crate::pair::{ContactError, ContactMethod, Linearised, Pair, PairEvent};

/// A rigid plane as primary.
#[derive(Clone, Debug)]
pub struct NodeToPlane<const D: usize> {
    secondary: Vec<usize>,
    point: Vector<D>,
    normal: Vector<D>,
}

impl<const D: usize> NodeToPlane<D> {
    /// Keeps the secondary nodes on the side of `point` that `normal` (any length > 0) points to.
    pub fn new(secondary: Vec<usize>, point: [f64; D], normal: [f64; D]) -> Self {
        let normal = Vector(normal);
        Self { secondary, point: Vector(point), normal: normal * normal.norm().recip() }
    }
}

impl<const D: usize> ContactMethod<D> for NodeToPlane<D> {
    fn secondary(&self) -> &[usize] {
        &self.secondary
    }

    fn facet_nodes(&self, _: usize) -> &[usize] {
        &[]
    }

    fn signed_distance(&self, node: usize, y: &[[f64; D]]) -> Option<f64> {
        Some((Vector(y[self.secondary[node]]) - self.point).dot(&self.normal))
    }

    fn detect(
        &self,
        _: &[[f64; D]],
        _: &[[f64; D]],
        pairs: &mut Vec<Pair>,
        _: &mut Vec<PairEvent>,
    ) -> Result<bool, ContactError> {
        watch_every_node(self.secondary.len(), pairs);
        Ok(false)
    }

    fn linearise(&self, pair: &mut Pair, y: &[[f64; D]], _: f64, out: &mut Linearised<D>) -> Result<(), ContactError> {
        let node = self.secondary[pair.node];
        out.count = 1;
        out.nodes[0] = node;
        out.gap = (Vector(y[node]) - self.point).dot(&self.normal);
        out.gradient[0] = self.normal;
        out.hessian[0][0] = Mat::ZERO;
        Ok(())
    }
}

/// Where a gap costs nothing, every node is watched in every step.
pub(crate) fn watch_every_node(nodes: usize, pairs: &mut Vec<Pair>) {
    if pairs.len() == nodes {
        return;
    }
    let known = std::mem::take(pairs);
    let mut known = known.into_iter().peekable();
    for node in 0..nodes {
        let old = known.next_if(|p| p.node == node);
        pairs.push(old.unwrap_or(Pair {
            node,
            facet: 0,
            xi: 0.0,
            active: false,
            lambda: 0.0,
            start: None,
            left: None,
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gap_is_the_signed_distance() {
        let plane = NodeToPlane::new(vec![0], [0.0, 1.0], [0.0, 4.0]);
        let mut pairs = Vec::new();
        plane.detect(&[], &[], &mut pairs, &mut Vec::new()).unwrap();
        let mut out = Linearised::default();
        plane.linearise(&mut pairs[0], &[[7.0, 0.25]], -1.0, &mut out).unwrap();
        assert_eq!((out.gap, out.gradient[0]), (-0.75, Vector([0.0, 1.0])));
    }
}
