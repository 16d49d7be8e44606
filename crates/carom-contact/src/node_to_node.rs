//! Dimension 1: a side is a node, and the gap of two bars is g = s (y_N − y_P) with s = ±1 the primary's outward direction.

use carom_algebra::{Mat, Vector};

use crate::node_to_plane::watch_every_node;
use crate::pair::{ContactError, ContactMethod, Linearised, Pair, PairEvent};

/// The end of one bar against the end of another.
#[derive(Clone, Debug)]
pub struct NodeToNode {
    secondary: [usize; 1],
    primary: [usize; 1],
    outward: f64,
}

impl NodeToNode {
    /// `outward`: +1 where the primary bar ends towards +x, −1 where it ends towards −x.
    pub fn new(secondary: usize, primary: usize, outward: f64) -> Self {
        Self { secondary: [secondary], primary: [primary], outward }
    }
}

impl ContactMethod<1> for NodeToNode {
    fn secondary(&self) -> &[usize] {
        &self.secondary
    }

    fn facet_nodes(&self, _: usize) -> &[usize] {
        &self.primary
    }

    fn signed_distance(&self, _: usize, y: &[[f64; 1]]) -> Option<f64> {
        Some(self.outward * (y[self.secondary[0]][0] - y[self.primary[0]][0]))
    }

    fn detect(
        &self,
        _: &[[f64; 1]],
        _: &[[f64; 1]],
        pairs: &mut Vec<Pair>,
        _: &mut Vec<PairEvent>,
    ) -> Result<bool, ContactError> {
        watch_every_node(1, pairs);
        Ok(false)
    }

    fn linearise(&self, _: &mut Pair, y: &[[f64; 1]], _: f64, out: &mut Linearised<1>) -> Result<(), ContactError> {
        out.count = 2;
        out.nodes[..2].copy_from_slice(&[self.secondary[0], self.primary[0]]);
        out.gap = self.outward * (y[self.secondary[0]][0] - y[self.primary[0]][0]);
        out.gradient[..2].copy_from_slice(&[Vector([self.outward]), Vector([-self.outward])]);
        for row in &mut out.hessian[..2] {
            row[..2].fill(Mat::ZERO);
        }
        Ok(())
    }
}
