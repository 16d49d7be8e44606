//! The slips that friction prevents in a stage, and those among them that are rows of its system.

use carom_algebra::Independent;
use carom_contact::{Along, FrictionState, Row, Rows};

use crate::contact::independent::{DEPENDENT, accept_stick, on_free_dofs, same_contact, slip_remainder};
use crate::stage::equations::Equations;
use crate::stage::evaluation::Evaluation;

/// Contact, pair and number of a row in its pair: 0 for its gap.
pub(crate) type Name = (usize, usize, usize);

/// The slips that friction prevents, and which of them and of the gaps are rows.
pub(crate) struct PreventedSlips {
    /// Their names, ascending, and their components.
    names: Vec<(Name, Along)>,
    rows: Rows,
    /// The gaps and slips that are rows, ascending.
    independent: Vec<Name>,
}

impl PreventedSlips {
    /// Of the closed pairs of an iterate.
    pub(crate) fn of(equations: &Equations, evaluation: &Evaluation) -> Self {
        let d = equations.model.dimension;
        let mut slips = Self { names: Vec::new(), rows: Rows::new(d), independent: Vec::new() };
        for (k, p) in evaluation.pressing() {
            let pair = &evaluation.at.pairings[k].pairs[p];
            for (number, along) in equations.prevented(k, pair).enumerate() {
                slips.names.push(((k, p, number + 1), along));
                slips.rows.push_combined(&evaluation.slips[k], p * (d - 1), &along[..d - 1]);
            }
        }
        slips.choose(equations, evaluation);
        slips
    }

    /// Chooses the rows. Springs may depend on each other, because each adds its stiffness, and so
    /// may rows that yield. The slip of a pair comes after all gaps: what depends on both keeps its
    /// gap.
    fn choose(&mut self, equations: &Equations, evaluation: &Evaluation) {
        let model = equations.model;
        let pair = |k: usize, p: usize| &evaluation.at.pairings[k].pairs[p];
        let sticks = |k: usize, p: usize| pair(k, p).tangential.friction_state == FrictionState::Stick;
        let is_elastic = |&(k, p, number): &Name| {
            let contact = &model.contacts[k];
            let yields = number == 0 || sticks(k, p);
            !contact.interface.is_constraint() || contact.augmentation.is_some() && yields
        };
        let acts = |row: Row| row.entries().any(|(dof, slope)| slope != 0.0 && !model.fixed[dof]);
        let above = |k: usize, p: usize, row: Row, least: f64| {
            let bounds = model.contacts[k].bounds(pair(k, p));
            if bounds { same_contact(model, row).max(least) } else { least }
        };
        // Rows of nodes come first, with the friction of the places where the nodes lie. The row of
        // a corner of an obstacle, or of an edge, may depend on nodes of another contact.
        let is_of_node = |&(k, p): &(usize, usize)| pair(k, p).node < model.contacts[k].kinematics.nodes();
        let (of_nodes, between): (Vec<_>, Vec<_>) = evaluation.pressing().partition(is_of_node);
        let mut set = Independent::default();
        for (k, p) in of_nodes.into_iter().chain(between) {
            let row = evaluation.rows[k].row(p);
            let name = (k, p, 0);
            let is_row = if is_elastic(&name) {
                acts(row)
            } else {
                set.accept(on_free_dofs(model, row), above(k, p, row, DEPENDENT))
            };
            if is_row {
                self.independent.push(name);
            }
        }
        let mut first = 0;
        while let Some(&(name @ (k, p, _), _)) = self.names.get(first) {
            let count = if sticks(k, p) { model.dimension - 1 } else { 1 };
            let rows = first..first + count;
            if is_elastic(&name) {
                let acting = rows.clone().filter(|&row| acts(self.rows.row(row)));
                self.independent.extend(acting.map(|row| self.names[row].0));
            } else {
                let above = |least, row| above(k, p, self.rows.row(row), least);
                let least = rows.clone().fold(slip_remainder(model), above);
                let mut along: Vec<Along> = self.names[rows.clone()].iter().map(|name| name.1).collect();
                let added = accept_stick(model, &mut set, &mut self.rows, first, least, &mut along);
                self.names[rows.clone()].iter_mut().zip(along).for_each(|(name, along)| name.1 = along);
                self.independent.extend(self.names[rows.clone()].iter().take(added).map(|name| name.0));
            }
            first = rows.end;
        }
        self.independent.sort_unstable();
    }

    /// The gaps and slips that are rows, ascending.
    pub(crate) fn independent(&self) -> &[Name] {
        &self.independent
    }

    /// The components and the row of one.
    pub(crate) fn find(&self, name: Name) -> (Along, Row<'_>) {
        let place = self.names.partition_point(|(other, _)| *other < name);
        (self.names[place].1, self.rows.row(place))
    }

    /// Contact, pair and components of the slips of sticks that are not rows.
    pub(crate) fn dropped(&self, evaluation: &Evaluation) -> Vec<((usize, usize), Along)> {
        let sticks = |&&((k, p, _), _): &&(Name, Along)| {
            evaluation.at.pairings[k].pairs[p].tangential.friction_state == FrictionState::Stick
        };
        let is_row = |name: &Name| self.independent.binary_search(name).is_ok();
        let dropped = self.names.iter().filter(sticks).filter(|(name, _)| !is_row(name));
        dropped.map(|&((k, p, _), along)| ((k, p), along)).collect()
    }
}
