//! The slips that friction prevents in a stage, and those among them that are rows of its system.

use carom_contact::{Along, FrictionState, Row, Rows};

use crate::contact::independent::{DEPENDENT, independent_above, same_contact, slip_remainder};
use crate::stage::equations::Equations;
use crate::stage::evaluation::Evaluation;

/// Contact, pair and number of a row in its pair: 0 for its gap.
pub(crate) type Name = (usize, usize, usize);

/// The slips that friction prevents.
pub(crate) struct PreventedSlips {
    /// Their names, ascending, and their components.
    names: Vec<(Name, Along)>,
    rows: Rows,
}

impl PreventedSlips {
    /// Of the closed pairs of an iterate.
    pub(crate) fn of(equations: &Equations, evaluation: &Evaluation) -> Self {
        let d = equations.model.dimension;
        let mut slips = Self { names: Vec::new(), rows: Rows::new(d) };
        for (k, p) in evaluation.pressing() {
            let pair = &evaluation.at.pairings[k].pairs[p];
            for (number, along) in equations.prevented(k, pair).enumerate() {
                slips.names.push(((k, p, number + 1), along));
                slips.rows.push_combined(&evaluation.slips[k], p * (d - 1), &along[..d - 1]);
            }
        }
        slips
    }

    fn iter(&self) -> impl Iterator<Item = (Name, Row<'_>)> {
        self.names.iter().map(|(name, _)| *name).zip(self.rows.iter())
    }

    /// The components and the row of one.
    pub(crate) fn find(&self, name: Name) -> (Along, Row<'_>) {
        let place = self.names.partition_point(|(other, _)| *other < name);
        (self.names[place].1, self.rows.row(place))
    }

    /// The gaps and slips that are rows, ascending. Springs may depend on each other, because each
    /// adds its stiffness, and so may rows that yield.
    pub(crate) fn independent(&self, equations: &Equations, evaluation: &Evaluation) -> Vec<Name> {
        let model = equations.model;
        let is_elastic = |&(k, p, number): &Name| {
            let contact = &model.contacts[k];
            let pair = &evaluation.at.pairings[k].pairs[p];
            let yields = number == 0 || pair.tangential.friction_state == FrictionState::Stick;
            !contact.interface.is_constraint() || contact.augmentation.is_some() && yields
        };
        let gaps = || evaluation.pressing().map(|(k, p)| ((k, p, 0), evaluation.rows[k].row(p)));
        // The slip of a pair after all gaps: what depends on both keeps its gap.
        let least = slip_remainder(model);
        let bounds = |&(k, p, _): &Name| model.contacts[k].bounds(&evaluation.at.pairings[k].pairs[p]);
        let above = |name: Name, row, least: f64| {
            (name, row, if bounds(&name) { same_contact(model, row).max(least) } else { least })
        };
        let rows = gaps().map(|(name, row)| above(name, row, DEPENDENT));
        let rows = rows.chain(self.iter().map(|(name, row)| above(name, row, least)));
        let mut chosen = independent_above(model, rows.filter(|(name, ..)| !is_elastic(name)));
        let acts = |row: Row| row.entries().any(|(dof, slope)| slope != 0.0 && !model.fixed[dof]);
        let elastic = gaps().chain(self.iter()).filter(|(name, _)| is_elastic(name));
        chosen.extend(elastic.filter(|(_, row)| acts(*row)).map(|(name, _)| name));
        chosen.sort_unstable();
        chosen
    }

    /// Contact, pair and components of the slips of sticks that are not among these.
    pub(crate) fn dropped(&self, evaluation: &Evaluation, rows: &[Name]) -> Vec<((usize, usize), Along)> {
        let sticks = |&&((k, p, _), _): &&(Name, Along)| {
            evaluation.at.pairings[k].pairs[p].tangential.friction_state == FrictionState::Stick
        };
        let dropped = self.names.iter().filter(sticks).filter(|(name, _)| rows.binary_search(name).is_err());
        dropped.map(|&((k, p, _), along)| ((k, p), along)).collect()
    }
}
