//! Node-to-segment contact on curved sides of any order, dimension 2.
//!
//! Gap at the closest point ξ of the pair's facet, with t = y_S', J = |t|, n = t turned right / J, κ = n·y_S'', a = J² − gκ (theory.md §1):
//!
//! ```text
//! g = (y_N − y_S(ξ))·n        ∇g = N_n = (n; −φᵅ n)
//! ∇²g = −(N_t T_nᵀ + T_n N_tᵀ)/a − κ/(a J²) N_t N_tᵀ − (g/a) T_n T_nᵀ,    N_t = (t; −φᵅ t),  T_n = (0; φ'ᵅ n)
//! ```
//!
//! ξ is solved again in every call, up to |ξ| = 1.2 beyond an end; the pair is handed to the neighbour only between solves, and never back within a step.

use carom_algebra::{Mat, Vector};
use carom_solid::line_shape;

use crate::pair::{ContactError, ContactMethod, Linearised, Pair, PairEvent};
use crate::projection::{closest_from, closest_point, curve_point};
use crate::surface::Surface;
use crate::trajectory::crossing;

/// How far beyond its end a facet is extrapolated.
const REACH: f64 = 1.2;
/// How far the closest point may wander while Newton has not converged.
const WANDER: f64 = 3.0;
/// Beyond this a pair is handed over while Newton is on its way, and beyond that also back.
const FOLLOWED: f64 = 1.02;
const FOLLOWED_BACK: f64 = 1.1;
/// Cosine of the kink between neighbouring facets above which a node past both ends has left the side (a corner's vertex cone).
const CORNER_COSINE: f64 = 0.87;
/// A node this much behind a facet (times the facet's length) at the start of a step came from elsewhere, not through the facet.
const BEHIND: f64 = 1e-6;

/// Which gap decides that a node has reached the primary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detection {
    /// The gap at the closest point; trajectories only give candidates.
    ClosestPoint,
    /// The gap at the point where the trajectories cross, eq. (8) as printed.
    Trajectory,
}

/// Secondary nodes against a primary side of curved facets.
#[derive(Clone, Debug)]
pub struct NodeToSegment {
    secondary: Vec<usize>,
    primary: Surface,
    detection: Detection,
}

impl NodeToSegment {
    /// Secondary nodes and primary surface in global node numbers; a node of the primary itself is left out of the secondary.
    pub fn new(secondary: Vec<usize>, primary: Surface, detection: Detection) -> Self {
        Self { secondary, primary, detection }
    }

    fn gap(&self, node: usize, facet: usize, xi: f64, y: &[[f64; 2]]) -> f64 {
        let c = curve_point(self.primary.facet(facet), y, xi);
        (Vector(y[node]) - c.position).dot(&c.tangent.turned_right()) / c.tangent.norm()
    }

    /// Facet and ξ where a node may touch: the first crossing of trajectories, else the closest facet at `now` that the node was not behind before.
    fn candidate(&self, node: usize, before: &[[f64; 2]], now: &[[f64; 2]]) -> Option<(usize, f64, bool)> {
        let near = self.primary.near(node, before, now);
        let mut first: Option<(f64, usize, f64)> = None;
        let mut closest: Option<(f64, usize, f64)> = None;
        for facet in near {
            let nodes = self.primary.facet(facet);
            if let Some(c) = crossing(nodes, before, now, node)
                && first.is_none_or(|(theta, ..)| c.theta < theta)
            {
                first = Some((c.theta, facet, c.xi));
            }
            let Some(xi) = closest_point(nodes, now, Vector(now[node]), REACH) else { continue };
            let beyond = (xi.abs() - 1.0).max(0.0);
            let distance = self.gap(node, facet, xi, now).abs() + beyond * self.primary.length(facet, now);
            if closest.is_none_or(|(d, ..)| distance < d) {
                closest = Some((distance, facet, xi));
            }
        }
        if let Some((_, facet, xi)) = first {
            return Some((facet, xi, true));
        }
        let (_, facet, xi) = closest?;
        let start = closest_point(self.primary.facet(facet), before, Vector(before[node]), REACH);
        let came_from_behind =
            start.is_some_and(|s| self.gap(node, facet, s, before) < -BEHIND * self.primary.length(facet, before));
        (!came_from_behind).then_some((facet, xi, false))
    }

    /// Where a pair past the end of its facet goes.
    fn next_facet(&self, pair: &Pair, y: &[[f64; 2]]) -> Next {
        if pair.xi.abs() <= 1.0 + 1e-9 {
            return Next::Stay;
        }
        let node = self.secondary[pair.node];
        let forward = pair.xi > 0.0;
        let Some(neighbour) = self.primary.neighbour(pair.facet, forward) else {
            return if pair.xi.abs() <= REACH { Next::Stay } else { Next::Leave };
        };
        if pair.left == Some(neighbour) {
            return if pair.xi.abs() <= REACH { Next::Stay } else { Next::Leave };
        }
        if let Some(xi) = closest_point(self.primary.facet(neighbour), y, Vector(y[node]), REACH) {
            let inside = if forward { xi >= -1.0 } else { xi <= 1.0 };
            if inside {
                return Next::HandOver(neighbour, xi);
            }
        }
        // Past both ends: the vertex cone of a convex kink. A blunt one is bridged by extrapolation, at a corner the node is free.
        let end = if forward { 1.0 } else { -1.0 };
        let here = curve_point(self.primary.facet(pair.facet), y, end).tangent;
        let there = curve_point(self.primary.facet(neighbour), y, -end).tangent;
        let blunt = here.dot(&there) >= CORNER_COSINE * here.norm() * there.norm();
        if blunt && pair.xi.abs() <= REACH { Next::Stay } else { Next::Leave }
    }
}

enum Next {
    Stay,
    HandOver(usize, f64),
    Leave,
}

impl ContactMethod<2> for NodeToSegment {
    fn secondary(&self) -> &[usize] {
        &self.secondary
    }

    fn facet_nodes(&self, facet: usize) -> &[usize] {
        self.primary.facet(facet)
    }

    fn signed_distance(&self, node: usize, y: &[[f64; 2]]) -> Option<f64> {
        let node = self.secondary[node];
        (0..self.primary.facets())
            .filter_map(|f| {
                closest_point(self.primary.facet(f), y, Vector(y[node]), 1.0 + 1e-9).map(|xi| self.gap(node, f, xi, y))
            })
            .min_by(|a, b| a.abs().total_cmp(&b.abs()))
    }

    fn detect(
        &self,
        before: &[[f64; 2]],
        now: &[[f64; 2]],
        pairs: &mut Vec<Pair>,
        events: &mut Vec<PairEvent>,
    ) -> Result<bool, ContactError> {
        let mut changed = false;
        pairs.retain_mut(|pair| {
            let node = self.secondary[pair.node];
            // Neighbours in turn until the closest point lies on the facet; bounded by the facets there are.
            for _ in 0..=self.primary.facets() {
                match self.next_facet(pair, now) {
                    Next::Stay => return true,
                    Next::HandOver(facet, xi) => {
                        if pair.active {
                            events.push(PairEvent::HandOver { node, from: pair.facet, to: facet });
                        }
                        // In a concave joint an open pair may be in front of the one facet and behind the other.
                        changed |= pair.active || self.gap(node, facet, xi, now) < 0.0;
                        pair.left = Some(pair.facet);
                        (pair.facet, pair.xi) = (facet, xi);
                    }
                    Next::Leave => {
                        if pair.active {
                            events.push(PairEvent::SlidOff { node, facet: pair.facet });
                            changed = true;
                        }
                        return false;
                    }
                }
            }
            true
        });
        let mut watched = pairs.iter().map(|p| p.node).collect::<Vec<_>>().into_iter().peekable();
        let mut found = Vec::new();
        if self.primary.any_near(&self.secondary, before, now) {
            for (k, &node) in self.secondary.iter().enumerate() {
                if watched.next_if_eq(&k).is_some() {
                    continue;
                }
                if let Some((facet, xi, crossed)) = self.candidate(node, before, now) {
                    let pair = Pair { node: k, facet, xi, active: false, lambda: 0.0, start: None, left: None };
                    match self.detection {
                        Detection::ClosestPoint => {
                            // A candidate that is already behind must be looked at again by the solver.
                            changed |= self.gap(node, facet, xi, now) < 0.0;
                            found.push(pair);
                        }
                        Detection::Trajectory => {
                            // Eq. (8) decides at the crossing. A node that was already in by round-off crosses nothing: its closest point decides.
                            let gap = self.gap(node, facet, xi, now);
                            if gap < 0.0 || (crossed && gap == 0.0) {
                                changed = true;
                                found.push(Pair { active: true, ..pair });
                            }
                        }
                    }
                }
            }
        }
        pairs.append(&mut found);
        pairs.sort_by_key(|p| p.node);
        Ok(changed)
    }

    fn follow(&self, now: &[[f64; 2]], pairs: &mut [Pair], events: &mut Vec<PairEvent>) -> bool {
        let mut changed = false;
        for pair in pairs.iter_mut().filter(|pair| pair.active) {
            if pair.xi.abs() <= if pair.left.is_some() { FOLLOWED_BACK } else { FOLLOWED } {
                continue;
            }
            let (from, left) = (pair.facet, pair.left.take());
            for _ in 0..self.primary.facets() {
                let Next::HandOver(facet, xi) = self.next_facet(pair, now) else { break };
                (pair.left, pair.facet, pair.xi) = (Some(pair.facet), facet, xi);
            }
            if pair.facet == from {
                pair.left = left;
            } else {
                events.push(PairEvent::HandOver { node: self.secondary[pair.node], from, to: pair.facet });
                changed = true;
            }
        }
        changed
    }

    fn linearise(
        &self,
        pair: &mut Pair,
        y: &[[f64; 2]],
        lambda: f64,
        out: &mut Linearised<2>,
    ) -> Result<(), ContactError> {
        let node = self.secondary[pair.node];
        let facet = self.primary.facet(pair.facet);
        let from = Vector(y[node]);
        let lost = ContactError::Lost { node, facet: pair.facet, xi: pair.xi };
        pair.xi = closest_from(facet, y, from, pair.xi, WANDER)
            .or_else(|| closest_point(facet, y, from, REACH))
            .ok_or(lost)?;

        let c = curve_point(facet, y, pair.xi);
        let shape = line_shape(facet.len(), pair.xi);
        let j = c.tangent.norm();
        let n = c.tangent.turned_right() * j.recip();
        let gap = (from - c.position).dot(&n);
        let kappa = n.dot(&c.second);
        let a = j * j - gap * kappa;
        if a <= 0.0 || !a.is_finite() {
            return Err(ContactError::Focal { node, facet: pair.facet, xi: pair.xi, a });
        }

        let count = facet.len() + 1;
        out.gap = gap;
        out.count = count;
        out.nodes[0] = node;
        out.nodes[1..count].copy_from_slice(facet);
        // Every vector of the stencil is a scalar per node times n or t.
        let mut phi = [0.0; 5];
        let mut slope = [0.0; 5];
        phi[0] = 1.0;
        for k in 1..count {
            phi[k] = -shape.values[k - 1];
            slope[k] = shape.first[k - 1];
        }
        let (nn, tt, tn, nt) = (n.outer(&n), c.tangent.outer(&c.tangent), c.tangent.outer(&n), n.outer(&c.tangent));
        for p in 0..count {
            out.gradient[p] = n * phi[p];
            for q in 0..count {
                let mut block: Mat<2> = tn * (-phi[p] * slope[q] / a);
                block += nt * (-slope[p] * phi[q] / a);
                block += tt * (-kappa / (a * j * j) * phi[p] * phi[q]);
                block += nn * (-gap / a * slope[p] * slope[q]);
                out.hessian[p][q] = block * lambda;
            }
        }
        Ok(())
    }
}
