//! The sets of pairs visited in one step, so that one that recurs is noticed. At first the set may
//! change in every iteration; when one recurs, changes wait until Newton's method has converged;
//! when one recurs again, only one pair changes at a time.

use std::collections::HashSet;
use std::hash::Hash;

/// How often a set of pairs may change within a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Caution {
    EveryIteration,
    AfterConvergence,
    OneAtATime,
}

/// The sets of pairs visited in one step, and the restriction of further changes.
#[derive(Clone, Debug)]
pub(crate) struct Visited<S> {
    sets: HashSet<S>,
    caution: Caution,
    /// The set at which changes were restricted to one pair. It does not count as visited: its
    /// other pairs have not been tried.
    restricted_at: Option<S>,
}

impl<S: Eq + Hash> Visited<S> {
    /// Starts with no visited sets; `within`: whether changes are allowed before Newton's method
    /// has converged.
    pub(crate) fn new(within: bool) -> Self {
        let caution = if within { Caution::EveryIteration } else { Caution::AfterConvergence };
        Self { sets: HashSet::new(), caution, restricted_at: None }
    }

    /// Whether changes are restricted to one pair at a time.
    pub(crate) fn is_cautious(&self) -> bool {
        self.caution == Caution::OneAtATime
    }

    /// Whether a set must not change before Newton's method has converged.
    pub(crate) fn waits(&self, converged: bool) -> bool {
        self.caution > Caution::EveryIteration && !converged
    }

    pub(crate) fn contains(&self, set: &S) -> bool {
        self.sets.contains(set)
    }

    /// Whether changes were restricted to one pair at this set.
    pub(crate) fn was_restricted_at(&self, set: &S) -> bool {
        self.restricted_at.as_ref() == Some(set)
    }

    /// Records a set that is to change into another one, `next`, and restricts changes if `next`
    /// was visited before.
    pub(crate) fn visit(&mut self, set: S, next: &S, converged: bool) {
        if self.contains(next) && !self.is_cautious() {
            self.sets.clear();
            if self.caution == Caution::AfterConvergence {
                self.caution = Caution::OneAtATime;
                self.restricted_at = Some(set);
                return;
            }
            self.caution = Caution::AfterConvergence;
            if self.waits(converged) {
                return;
            }
        }
        self.sets.insert(set);
    }

    /// Clears the visited sets, for pairs that have changed themselves.
    pub(crate) fn restart(&mut self) {
        self.sets.clear();
        self.restricted_at = None;
    }
}
