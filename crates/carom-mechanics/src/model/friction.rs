//! Friction of a contact: the law of each secondary node at a time, and its tangential spring.

use std::collections::HashMap;

use carom_contact::{Kinematics, Law, Pair};
use carom_formula::Formula;

use super::formulas::{NoValue, value};

/// A negative coefficient down to this one is the round-off of a formula that ends at zero.
const ROUND_OFF: f64 = 1e-12;

/// Friction between the sides of a contact.
pub struct Friction {
    /// μ_s as a formula of reference position and time, and its label; none: only the limit counts.
    pub stick: Option<(Formula, String)>,
    /// μ_d; μ_s if none, or where this is less.
    pub slip: Option<f64>,
    /// See [`Law::decay`].
    pub decay: f64,
    /// Reference positions of the secondary nodes, and of the nodes that stand for what lies
    /// between them.
    pub places: Vec<Vec<f64>>,
    /// Largest traction of each secondary node; empty if it has none.
    pub limits: Vec<f64>,
    /// Largest traction of the nodes of the secondary side, by their global numbers, between which
    /// the row of a part of an obstacle, of an edge or of a point of an edge lies.
    pub limits_of_nodes: HashMap<usize, f64>,
}

impl Friction {
    /// Coulomb's law with one coefficient, by constraints.
    pub fn coulomb(coefficient: f64, nodes: usize) -> Self {
        Self {
            stick: Some((Formula::constant(coefficient), "mu".into())),
            slip: None,
            decay: 0.0,
            places: vec![Vec::new(); nodes],
            limits: Vec::new(),
            limits_of_nodes: HashMap::new(),
        }
    }

    /// Whether a node has friction: its limit is not zero, as that of a coefficient of the pressure
    /// in a plane of symmetry is, and that of nodes of the primary side without `mu`.
    pub fn acts_on(&self, node: usize) -> bool {
        self.limits.get(node) != Some(&0.0)
    }

    /// The law of every secondary node at a time, and of what follows them: a part of an obstacle,
    /// an edge and a point of an edge have that of the point where their pair is, with the
    /// reference positions of all nodes.
    ///
    /// # Errors
    /// A coefficient that is negative or not finite.
    pub(crate) fn laws(
        &self,
        time: f64,
        (kinematics, pairs): (&dyn Kinematics, &[Pair]),
        (reference, dimension): (&[f64], usize),
    ) -> Result<Vec<Law>, NoValue> {
        let limit = |node| self.limit(node);
        let of_nodes = self.places.iter().enumerate();
        let mut laws: Vec<Law> =
            of_nodes.map(|(node, place)| self.law(place, limit(node), time)).collect::<Result<_, _>>()?;
        if kinematics.nodes() < self.places.len() {
            for pair in pairs {
                if let Some(law) = self.law_between(time, (kinematics, pair), (reference, dimension))? {
                    laws[pair.node] = law;
                }
            }
        }
        Ok(laws)
    }

    /// The law of a pair that is of no node, at a time; none of others.
    ///
    /// # Errors
    /// A coefficient that is negative or not finite.
    pub(crate) fn law_between(
        &self,
        time: f64,
        (kinematics, pair): (&dyn Kinematics, &Pair),
        (reference, dimension): (&[f64], usize),
    ) -> Result<Option<Law>, NoValue> {
        let Some(point) = kinematics.between_nodes(pair) else { return Ok(None) };
        let own = self.limit(pair.node);
        let of_node = |node| self.limits_of_nodes.get(&node).copied().unwrap_or(0.0);
        // A limit of zero is that of a plane of symmetry. Nodes of the primary side have no limited
        // traction.
        let is_of_side = |node: &usize| self.limits_of_nodes.contains_key(node);
        let has_own = own == 0.0 || !point.nodes.iter().any(is_of_side);
        let limit = if has_own { own } else { point.mean(of_node) };
        self.law(&point.place(reference, dimension), limit, time).map(Some)
    }

    fn limit(&self, node: usize) -> f64 {
        self.limits.get(node).copied().unwrap_or(f64::INFINITY)
    }

    fn law(&self, place: &[f64], limit: f64, time: f64) -> Result<Law, NoValue> {
        let Some((formula, label)) = &self.stick else {
            return Ok(Law { stick: f64::INFINITY, slip: f64::INFINITY, decay: 0.0, limit });
        };
        let stick = value(formula, label, place, time)?;
        if stick < -ROUND_OFF {
            let formula = formula.text().to_owned();
            let place = place.to_vec();
            return Err(NoValue { what: label.clone(), formula, place, time, value: stick });
        }
        let stick = stick.max(0.0);
        Ok(Law { stick, slip: self.slip.unwrap_or(stick).min(stick), decay: self.decay, limit })
    }
}
