//! Edges that cross at joints. Where the crossing of two edges lies over the node at which another
//! edge continues one of them, both edges there are as near as each other, and the normals with
//! them lean to either side, as the edges bend. As over joints of facets (`../joint.rs`) gap, slip
//! and their derivatives are means: over two pairs of edges, or over four at a node of either side.
//! A choice among them, by number, would push symmetric bodies aside.

use std::collections::BTreeSet;

use super::edge_gap::EdgeGap;
use super::edge_to_edge::{EdgeToEdge, OnEdges, past_ends};
use super::patch::place;
use crate::constants::{AT_JOINT, EXTENDED};
use crate::kinematics::joint::mean_of_matrices;
use crate::pair::{ContactError, Pair};
use crate::rows::Rows;

/// Mark of a pair whose crossing lies at a joint of the edge of one side, the secondary one first.
const AT: [u8; 2] = [1, 2];

impl EdgeToEdge {
    /// The joints over which two edges with a gap cross, if they do.
    pub(super) fn joints(&self, edges: [usize; 2], gap: &EdgeGap, y: &[f64]) -> Option<u8> {
        let is_near = |i: usize| (gap.xi[i].abs() - 1.0).abs() <= EXTENDED;
        let joint = |i: usize| is_near(i).then(|| self.sides[i].joint(edges[i], gap.xi[i], y)).flatten();
        let found = [0, 1].map(joint);
        // Whether what lies at a place of the other edge is over the joint.
        let is_over = |i: usize, other| {
            found[i].is_some_and(|(node, along)| {
                let aside = (place(y, node) - other).dot(&along) / along.norm();
                aside.abs() <= AT_JOINT * self.sides[i].length(edges[i], y)
            })
        };
        let node = |i: usize| found[i].map(|(node, _)| place(y, node));
        if let [Some(own), Some(other)] = [node(0), node(1)]
            && is_over(0, other)
            && is_over(1, own)
        {
            return Some(AT[0] | AT[1]);
        }
        (0..2).find(|&i| is_over(i, gap.point(1 - i))).map(|i| AT[i])
    }

    /// Finds the joints over which a pair lies at the start of a solve; `known`: the edges that
    /// have a pair.
    pub(super) fn start_joint(&self, pair: &mut Pair, y: &[f64], known: &mut BTreeSet<[usize; 2]>) {
        let [own, other] = self.of(pair);
        let gap = self.closest([own, other], [pair.xi, pair.eta], y);
        let joint = gap.and_then(|gap| self.joints([own, other], &gap, y));
        if pair.joint.is_some() && joint.is_none() {
            self.settle(pair, y, known);
        }
        pair.joint = joint;
    }

    /// Moves a pair that has left its joints to the edges there on which its crossing lies, or past
    /// whose ends it lies least, so that a choice by number that the mean has hidden does not come
    /// back.
    fn settle(&self, pair: &mut Pair, y: &[f64], known: &mut BTreeSet<[usize; 2]>) {
        let past = |gap: &EdgeGap| past_ends(gap.xi);
        let gaps = self.gaps(pair, y).unwrap_or_default();
        let Some((to, gap)) = gaps.iter().min_by(|a, b| past(&a.1).total_cmp(&past(&b.1))) else { return };
        let from = self.of(pair);
        if *to != from && known.insert(*to) {
            let facet = self.sides[1].facets() + to[1];
            let handed = pair.handed + from[0] as isize - to[0] as isize;
            *pair = Pair { node: to[0], facet, handed, ..*pair };
            [pair.xi, pair.eta] = gap.xi;
        }
    }

    /// The pairs of edges that meet at the joints of a pair, itself first.
    fn parts(&self, pair: &Pair) -> Vec<OnEdges> {
        let mut parts = vec![OnEdges { edges: self.of(pair), xi: [pair.xi, pair.eta] }];
        for i in (0..2).filter(|&i| pair.joint.is_some_and(|joint| joint & AT[i] != 0)) {
            let OnEdges { edges, xi } = parts[0];
            let Some(next) = self.sides[i].beyond(edges[i], xi[i]) else { continue };
            let across = |part: &OnEdges| {
                let mut part = *part;
                part.edges[i] = next.edge;
                part.xi[i] = next.xi;
                part
            };
            let more: Vec<OnEdges> = parts.iter().map(across).collect();
            parts.extend(more.into_iter().filter(|part| self.may_meet(part.edges)));
        }
        parts
    }

    /// The gaps of these pairs at positions `y`.
    fn gaps(&self, pair: &Pair, y: &[f64]) -> Option<Vec<([usize; 2], EdgeGap)>> {
        let gap = |OnEdges { edges, xi }: OnEdges| Some((edges, self.closest(edges, xi, y)?));
        self.parts(pair).into_iter().map(gap).collect()
    }

    /// Adds the mean rows, `count` for each of these pairs, that `push` adds for one of them.
    ///
    /// # Errors
    /// If one has no gap; no row is added.
    pub(super) fn push_means(
        &self,
        (pair, count): (&Pair, usize),
        y: &[f64],
        rows: &mut Rows,
        push: impl Fn([usize; 2], &EdgeGap, &mut Rows),
    ) -> Result<(), ContactError> {
        let gaps = self.gaps(pair, y).ok_or_else(|| self.lost(pair))?;
        let first = rows.len();
        gaps.iter().for_each(|(edges, gap)| push(*edges, gap, rows));
        if gaps.len() > 1 {
            rows.average_from(first, count);
        }
        Ok(())
    }

    /// Overwrites a matrix over the nodes of a pair's row with the mean of those of these pairs,
    /// zero if one has no gap.
    pub(super) fn mean_into(
        &self,
        pair: &Pair,
        y: &[f64],
        mean: &mut [f64],
        matrix: impl Fn(&EdgeGap, &mut [f64]),
    ) {
        let Some(gaps) = self.gaps(pair, y) else {
            mean.fill(0.0);
            return;
        };
        if let [(_, gap)] = &gaps[..] {
            matrix(gap, mean);
            return;
        }
        let nodes: Vec<_> =
            gaps.iter().map(|(edges, _)| [0, 1].map(|of| self.nodes(*edges, of).to_vec())).collect();
        mean_of_matrices(3, &nodes, mean, |part, of_part| matrix(&gaps[part].1, of_part));
    }
}
