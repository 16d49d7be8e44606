//! Which pairs have zero gap: g ≥ 0, λ ≤ 0, λ g = 0 (eq. 12 as a complementarity problem).
//!
//! Primal–dual active set: a pair is active in the next iteration if λ + c g < 0. With λ = 0 on
//! inactive pairs and g = 0 on active ones this is "activate if g < 0, release if λ > 0", whatever
//! c > 0. Visited sets are stored. When one recurs, changes wait until Newton has converged; when
//! one recurs again, only the worst pair changes at a time.
//!
//! Friction makes the problem unsymmetric, and of two nearly dependent gaps, as of two nodes that
//! meet, the second can be violated while open and in tension while closed, against the first. Then
//! the second alone solves it: the two are exchanged.

use crate::constants::ALIKE;
use crate::visited::Visited;

/// Tension, as a fraction of the largest multiplier, above which an active pair is released: ties
/// stay active.
const RELEASE: f64 = 1e-10;

/// Gap and multiplier of one pair, and whether it is active.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contender {
    /// Whether the gap of the pair is constrained to zero.
    pub active: bool,
    /// Gap g of the pair; negative for penetration.
    pub gap: f64,
    /// Multiplier λ of the pair; negative for pressure.
    pub lambda: f64,
    /// Diagonal of the stage's tangent, a force per gap: makes gaps and multipliers comparable.
    pub stiffness: f64,
}

/// Primal–dual active set of the pairs of a contact, with the sets that it has visited in one step.
#[derive(Clone, Debug)]
pub struct ActiveSet {
    visited: Visited<Vec<usize>>,
    gap_tolerance: f64,
}

/// Error: the active set returns to a visited one in spite of all restrictions.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the active set cycles: pairs {pairs:?} alternate between open and closed")]
pub struct Cycle {
    /// Indices of the pairs that alternate between open and closed.
    pub pairs: Vec<usize>,
}

impl ActiveSet {
    /// Starts with no visited sets. `gap_tolerance`: penetration that still counts as contact;
    /// `within`: whether pairs may change before Newton's method has converged.
    pub fn new(gap_tolerance: f64, within: bool) -> Self {
        Self { visited: Visited::new(within), gap_tolerance }
    }

    /// Whether cycling has restricted changes to one pair at a time.
    pub fn is_cautious(&self) -> bool {
        self.visited.is_cautious()
    }

    /// Indices of the pairs to activate or release, given the state of an iteration; empty if the
    /// set is correct or must not change yet. `alike`: cosine of the angle between the gradients of
    /// two gaps.
    ///
    /// # Errors
    /// If the set returns to a visited one in spite of all restrictions.
    pub fn changes(
        &mut self,
        pairs: &[Contender],
        converged: bool,
        alike: impl Fn(usize, usize) -> f64,
    ) -> Result<Vec<usize>, Cycle> {
        if self.visited.waits(converged) {
            return Ok(Vec::new());
        }
        let strongest = pairs.iter().map(|p| p.lambda.abs()).fold(0.0, f64::max);
        // Violation of a pair's condition as a force; 0 if satisfied.
        let violation = |p: &Contender| -> f64 {
            if p.active {
                if p.lambda > RELEASE * strongest { p.lambda } else { 0.0 }
            } else if p.gap < -self.gap_tolerance {
                -p.gap * p.stiffness
            } else {
                0.0
            }
        };
        let mut wrong: Vec<usize> = (0..pairs.len()).filter(|&k| violation(&pairs[k]) > 0.0).collect();
        if wrong.is_empty() {
            return Ok(wrong);
        }
        let after = |wrong: &[usize]| -> Vec<usize> {
            (0..pairs.len()).filter(|k| pairs[*k].active != wrong.contains(k)).collect()
        };
        self.visited.visit(after(&[]), &after(&wrong), converged);
        if self.visited.waits(converged) {
            return Ok(Vec::new());
        }
        if self.visited.is_cautious() {
            wrong.sort_by(|&a, &b| violation(&pairs[b]).total_cmp(&violation(&pairs[a])));
            let is_untried = |&k: &usize| !self.visited.contains(&after(&[k]));
            let leads_on = |&k: &usize| is_untried(&k) && !self.visited.was_restricted_at(&after(&[k]));
            let next = wrong.iter().copied().find(leads_on);
            let next = next.or_else(|| opponents(pairs, &wrong, alike).into_iter().find(is_untried));
            let next = next.or_else(|| wrong.iter().copied().find(is_untried));
            return next.map(|k| vec![k]).ok_or(Cycle { pairs: wrong });
        }
        Ok(wrong)
    }

    /// Clears the visited sets, for pairs that have changed themselves.
    pub fn restart(&mut self) {
        self.visited.restart();
    }
}

/// The closed pairs under pressure on which a gap in tension, the first of those that are wrong,
/// nearly depends: that with the most similar gradient first.
fn opponents(pairs: &[Contender], wrong: &[usize], alike: impl Fn(usize, usize) -> f64) -> Vec<usize> {
    let Some(&pulled) = wrong.iter().find(|&&k| pairs[k].active) else { return Vec::new() };
    let pressed = (0..pairs.len()).filter(|&k| pairs[k].active && pairs[k].lambda < 0.0);
    let mut alike: Vec<(f64, usize)> = pressed.map(|k| (alike(pulled, k), k)).collect();
    alike.retain(|&(cosine, _)| cosine >= ALIKE.cosine);
    alike.sort_by(|a, b| b.0.total_cmp(&a.0));
    alike.into_iter().map(|(_, k)| k).collect()
}
