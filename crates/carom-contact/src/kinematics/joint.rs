//! Nodes at the joints of facets. Where a closest point lies on a blunt joint, every facet there is
//! as near as the others, and a choice among them, by number or by round-off, would turn the normal
//! by half the kink. The gap is the mean of those to all facets of the joint,
//!
//! ```text
//! g = (1/m) Σ g_k,    ∇g, ∇²g, H and ∂H/∂y likewise,
//! ```
//!
//! so that a symmetric contact stays symmetric, and neither numbering nor a rigid motion matters.
//! Which pairs lie on a joint is decided at the start of a solve. One that has slid off it by the
//! end goes on with the facet where it lies: over a hollow joint the mean would let it sink. That
//! facet follows from positions alone: it is the one furthest from whose end the node lies inside
//! or, past the ends of all of them, the one whose end is nearest.

use crate::constants::AT_JOINT;
use crate::pair::{ContactError, Pair};
use crate::rows::Rows;

/// The pairs of a node over a blunt joint of facets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AtJoints {
    /// Whether it has the mean gap of all facets there; otherwise that of one of them.
    pub mean: bool,
    /// Whether it has a pair with each facet behind which it lies; the springs of several would add
    /// up.
    pub several: bool,
}

impl Default for AtJoints {
    fn default() -> Self {
        Self { mean: true, several: true }
    }
}

/// Contact of nodes with single facets, of which that with joints is made.
pub(super) trait OnFacets {
    /// Dimension of the positions.
    fn dimension(&self) -> usize;

    /// The pairs of a node with every facet of the joint at which its pair lies, itself first, at
    /// their closest points; only itself if it lies at none.
    fn parts<'a>(&'a self, pair: &'a Pair, y: &'a [f64]) -> impl Iterator<Item = Pair> + 'a;

    /// Size of a facet.
    fn size(&self, facet: usize, y: &[f64]) -> f64;

    /// Distance of the node of a pair from a joint of its facet, along the surface and over the
    /// size of the facet.
    fn past_joint(&self, pair: &Pair, joint: u8, y: &[f64]) -> f64;

    /// Whether the facets of the side at a joint of a facet form a smooth surface, but for small
    /// kinks; never if there is only one.
    fn is_blunt(&self, facet: usize, joint: u8, y: &[f64]) -> bool;

    /// The joint of its facet over which a pair lies, if it does.
    fn joint_of(&self, pair: &Pair, y: &[f64]) -> Option<u8>;

    /// How far the contact point of a pair lies past the end or edge of its facet, over the size of
    /// the facet; negative inside.
    fn past_end(&self, pair: &Pair) -> f64;

    /// Finds the joints over which pairs lie at the start of a solve. A node that has a pair with
    /// every facet of a concave joint keeps these.
    fn start_joints(&self, pairs: &mut [Pair], y: &[f64]) {
        for own in pairs.chunk_by_mut(|one, other| one.node == other.node) {
            let count = own.len();
            for pair in own {
                let joint = self
                    .joint_of(pair, y)
                    .filter(|&joint| count == 1 || count != self.meeting(pair, joint, y).len());
                if let (Some(left), None, 1) = (pair.joint, joint, count) {
                    self.settle(pair, &self.meeting(pair, left, y), y);
                }
                pair.joint = joint;
            }
        }
    }

    /// Takes active pairs off joints where a facet's gap differs from the mean by more than
    /// round-off in positions: the node has slid away. Returns their nodes.
    fn leave_joints(&self, pairs: &mut [Pair], y: &[f64]) -> Vec<usize> {
        let mut left = Vec::new();
        let mut gaps = Rows::new(self.dimension());
        for own in pairs.chunk_by_mut(|one, other| one.node == other.node) {
            let is_single = own.len() == 1;
            for pair in own.iter_mut().filter(|pair| pair.active) {
                let Some(joint) = pair.joint else { continue };
                gaps.clear();
                let parts = self.meeting(pair, joint, y);
                let is_measured =
                    parts.iter().all(|part| self.measure_one(&mut { *part }, y, &mut gaps).is_ok());
                let mean = gaps.iter().map(|row| row.gap).sum::<f64>() / gaps.len() as f64;
                let apart = gaps.iter().map(|row| (row.gap - mean).abs()).fold(0.0, f64::max);
                if is_measured && apart <= AT_JOINT * self.size(pair.facet, y) {
                    continue;
                }
                if is_single {
                    self.settle(pair, &parts, y);
                }
                pair.joint = None;
                left.push(pair.node);
            }
        }
        left
    }

    /// The pairs of a node with the facets that meet at a joint.
    fn meeting(&self, pair: &Pair, joint: u8, y: &[f64]) -> Vec<Pair> {
        self.parts(&Pair { joint: Some(joint), ..*pair }, y).collect()
    }

    /// Moves a pair that has left a joint to the facet where its node lies, one of `parts`, so that
    /// a choice by number that the mean has hidden does not come back. With facets that cannot all
    /// be measured it keeps its own.
    fn settle(&self, pair: &mut Pair, parts: &[Pair], y: &[f64]) {
        let mut row = Rows::new(self.dimension());
        let mut best: Option<(f64, Pair)> = None;
        for part in parts {
            let mut part = *part;
            row.clear();
            if self.measure_one(&mut part, y, &mut row).is_err() {
                return;
            }
            let past = self.past_end(&part) * self.size(part.facet, y);
            if best.is_none_or(|(least, _)| past < least) {
                best = Some((past, part));
            }
        }
        if let Some((_, part)) = best {
            [pair.xi, pair.eta] = [part.xi, part.eta];
            pair.facet = part.facet;
        }
    }

    /// Puts pairs of these nodes on the joints over which they lie after they slid; returns whether
    /// one of them is active. A node that leaves a corner may lie over an edge.
    fn take_joints(&self, pairs: &mut [Pair], nodes: &[usize], y: &[f64]) -> bool {
        let mut is_active = false;
        for pair in pairs.iter_mut().filter(|pair| nodes.contains(&pair.node)) {
            pair.joint = self.joint_of(pair, y);
            is_active |= pair.active;
        }
        is_active
    }

    /// Nodes of the row of a pair with one facet.
    fn nodes_with(&self, pair: &Pair) -> Vec<usize>;

    /// See [`Kinematics::measure`](super::Kinematics::measure).
    fn measure_one(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError>;

    /// See [`Kinematics::curvature_into`](super::Kinematics::curvature_into).
    fn curvature_of_one(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]);

    /// See [`Kinematics::slip`](super::Kinematics::slip).
    fn slip_of_one(&self, pair: &Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError>;

    /// See [`Kinematics::slip_derivative_into`](super::Kinematics::slip_derivative_into).
    fn slip_derivative_of_one(&self, pair: &Pair, y: &[f64], tangent: usize, matrix: &mut [f64]);

    fn measure_mean(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        if pair.joint.is_none() {
            return self.measure_one(pair, y, rows);
        }
        let first = rows.len();
        let mut own = None;
        for mut part in self.parts(pair, y) {
            self.measure_one(&mut part, y, rows).inspect_err(|_| rows.truncate(first))?;
            own = own.or(Some([part.xi, part.eta]));
        }
        [pair.xi, pair.eta] = own.unwrap_or([pair.xi, pair.eta]);
        rows.average_from(first, 1);
        Ok(())
    }

    fn curvature_of_mean(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]) {
        if pair.joint.is_none() {
            self.curvature_of_one(pair, y, curvature);
            return;
        }
        let parts: Vec<Pair> = self.parts(pair, y).collect();
        self.mean_matrix(&parts, curvature, |part, matrix| self.curvature_of_one(part, y, matrix));
    }

    fn slip_of_mean(&self, pair: &Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        if pair.joint.is_none() {
            return self.slip_of_one(pair, y, rows);
        }
        let first = rows.len();
        for part in self.parts(pair, y) {
            self.slip_of_one(&part, y, rows).inspect_err(|_| rows.truncate(first))?;
        }
        rows.average_from(first, self.dimension() - 1);
        Ok(())
    }

    fn slip_derivative_of_mean(&self, pair: &Pair, y: &[f64], tangent: usize, matrix: &mut [f64]) {
        if pair.joint.is_none() {
            self.slip_derivative_of_one(pair, y, tangent, matrix);
            return;
        }
        let parts: Vec<Pair> = self.parts(pair, y).collect();
        self.mean_matrix(&parts, matrix, |part, matrix| {
            self.slip_derivative_of_one(part, y, tangent, matrix);
        });
    }

    /// Overwrites the first entries of `mean` with the mean of the matrices of pairs, over the
    /// nodes of their mean row.
    fn mean_matrix(&self, parts: &[Pair], mean: &mut [f64], matrix: impl Fn(&Pair, &mut [f64])) {
        let nodes_of = |part: &Pair| {
            let mut own = self.nodes_with(part);
            let others = own.split_off(1);
            [own, others]
        };
        let nodes: Vec<_> = parts.iter().map(nodes_of).collect();
        mean_of_matrices(self.dimension(), &nodes, mean, |part, of_part| matrix(&parts[part], of_part));
    }
}

/// Overwrites the first entries of `mean` with the mean of matrices over nodes, over those of the
/// mean row ([`Rows::average_from`]); `nodes`: those with which each row begins, and the others.
pub(super) fn mean_of_matrices(
    dimension: usize,
    nodes: &[[Vec<usize>; 2]],
    mean: &mut [f64],
    matrix: impl Fn(usize, &mut [f64]),
) {
    let mut all: Vec<usize> = Vec::new();
    for &node in [0, 1].into_iter().flat_map(|part| nodes.iter().flat_map(move |of| &of[part])) {
        if !all.contains(&node) {
            all.push(node);
        }
    }
    let size = dimension * all.len();
    // A pair may have moved to a joint of more facets since its row was measured: its tangent is
    // then left out, and the next iteration has it.
    let Some(mean) = mean.get_mut(..size * size) else {
        mean.fill(0.0);
        return;
    };
    mean.fill(0.0);
    let count = nodes.len() as f64;
    for (part, of) in nodes.iter().enumerate() {
        let nodes = of.concat();
        let own = dimension * nodes.len();
        let mut of_part = vec![0.0; own * own];
        matrix(part, &mut of_part);
        let place = |dof: usize| {
            let node = nodes[dof / dimension];
            let at = all.iter().position(|&other| other == node).unwrap_or(0);
            dimension * at + dof % dimension
        };
        for row in 0..own {
            for column in 0..own {
                mean[place(row) * size + place(column)] += of_part[row * own + column] / count;
            }
        }
    }
}
