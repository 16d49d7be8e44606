//! The slips that friction prevents in a stage, and those among them that are rows of its system.

use carom_contact::{Along, Hold, Row, Rows};

use crate::equations::Equations;
use crate::evaluation::Evaluation;
use crate::independent::{DEPENDENT, independent_above, slip_remainder};

/// Contact, pair and number of a row in its pair: 0 for its gap.
pub(crate) type Name = (usize, usize, usize);

/// The slips that friction prevents.
pub(crate) struct Held {
    /// Their names, ascending, and their components.
    names: Vec<(Name, Along)>,
    rows: Rows,
}

impl Held {
    /// Of the closed pairs of an iterate.
    pub(crate) fn of(equations: &Equations, evaluation: &Evaluation) -> Self {
        let d = equations.model.dimension;
        let mut held = Self { names: Vec::new(), rows: Rows::new(d) };
        for (k, p) in evaluation.pressing() {
            let pair = &evaluation.at.pairings[k].pairs[p];
            for (number, along) in equations.held(k, pair).enumerate() {
                held.names.push(((k, p, number + 1), along));
                held.rows.push_combined(&evaluation.slips[k], p * (d - 1), &along[..d - 1]);
            }
        }
        held
    }

    fn iter(&self) -> impl Iterator<Item = (Name, Row<'_>)> {
        self.names.iter().map(|(name, _)| *name).zip(self.rows.iter())
    }

    /// The components and the row of one.
    pub(crate) fn find(&self, name: Name) -> (Along, Row<'_>) {
        let place = self.names.partition_point(|(other, _)| *other < name);
        (self.names[place].1, self.rows.row(place))
    }
    /// The gaps and slips that are rows, ascending. Springs may depend on each other: each adds its
    /// stiffness.
    pub(crate) fn kept(&self, equations: &Equations, evaluation: &Evaluation) -> Vec<Name> {
        let model = equations.model;
        let is_spring = |k: usize| !model.contacts[k].interface.is_constraint();
        let gaps = evaluation.pressing().filter(|&(k, _)| !is_spring(k));
        let gaps = gaps.map(|(k, p)| ((k, p, 0), evaluation.rows[k].row(p), DEPENDENT));
        // The slip of a pair after all gaps: what depends on both keeps its gap.
        let least = slip_remainder(model);
        let slips = self.iter().filter(|((k, ..), _)| !is_spring(*k));
        let slips = slips.map(|(name, row)| (name, row, least));
        let mut kept = independent_above(model, gaps.chain(slips));
        kept.extend(evaluation.pressing().filter(|&(k, _)| is_spring(k)).map(|(k, p)| (k, p, 0)));
        kept.extend(self.names.iter().map(|(name, _)| *name).filter(|&(k, ..)| is_spring(k)));
        kept.sort_unstable();
        kept
    }

    /// Contact, pair and components of the slips of sticks that are not among these.
    pub(crate) fn dropped(&self, evaluation: &Evaluation, kept: &[Name]) -> Vec<((usize, usize), Along)> {
        let sticks = |&&((k, p, _), _): &&(Name, Along)| {
            evaluation.at.pairings[k].pairs[p].tangential.hold == Hold::Stick
        };
        let dropped = self.names.iter().filter(sticks).filter(|(name, _)| kept.binary_search(name).is_err());
        dropped.map(|&((k, p, _), along)| ((k, p), along)).collect()
    }
}
