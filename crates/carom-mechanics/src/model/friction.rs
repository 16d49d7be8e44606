//! Friction of a contact: the law of each secondary node at a time, and its tangential spring.

use carom_contact::Law;
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
    /// Reference positions of the secondary nodes.
    pub places: Vec<Vec<f64>>,
    /// Largest traction of each secondary node; empty if it has none.
    pub limits: Vec<f64>,
    /// Stiffness of the tangential spring of each secondary node; empty for constraints.
    pub springs: Vec<f64>,
    /// Number of edges after these nodes, which have no friction.
    pub edges: usize,
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
            springs: Vec::new(),
            edges: 0,
        }
    }

    /// Whether a node has friction: it is no edge, nor a coefficient of the pressure in a plane of
    /// symmetry, whose limit is zero.
    pub fn acts_on(&self, node: usize) -> bool {
        node < self.places.len() && self.limits.get(node) != Some(&0.0)
    }

    /// The law of every secondary node at a time, and of the edges that follow them.
    ///
    /// # Errors
    /// A coefficient that is negative or not finite.
    pub fn laws(&self, time: f64) -> Result<Vec<Law>, NoValue> {
        let law = |(node, place): (usize, &Vec<f64>)| {
            let limit = self.limits.get(node).copied().unwrap_or(f64::INFINITY);
            let Some((formula, label)) = &self.stick else {
                return Ok(Law { stick: f64::INFINITY, slip: f64::INFINITY, decay: 0.0, limit });
            };
            let stick = value(formula, label, place, time)?;
            if stick < -ROUND_OFF {
                let formula = formula.text().to_owned();
                let place = place.clone();
                return Err(NoValue { what: label.clone(), formula, place, time, value: stick });
            }
            let stick = stick.max(0.0);
            Ok(Law { stick, slip: self.slip.unwrap_or(stick).min(stick), decay: self.decay, limit })
        };
        let none = Law { stick: 0.0, slip: 0.0, decay: 0.0, limit: f64::INFINITY };
        let of_edges = std::iter::repeat_n(Ok(none), self.edges);
        self.places.iter().enumerate().map(law).chain(of_edges).collect()
    }
}
