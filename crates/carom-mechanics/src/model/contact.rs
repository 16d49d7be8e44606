//! A contact of two sides, of a side and a rigid obstacle, or of a side with itself.

use std::collections::HashMap;

use carom_contact::{BetweenNodes, Direction, Interface, Kinematics, Pair};
use carom_solid::FacetShape;

use super::friction::Friction;

/// Allowed depths of nodes, over the length of a facet.
#[derive(Clone, Copy, Debug)]
pub struct AllowedDepths {
    /// Of nodes that the contact constrains, away from kinks of over 30° of either side.
    pub smooth: f64,
    /// Of nodes that it constrains, at such kinks.
    pub kinks: f64,
    /// Of other nodes of its sides.
    pub others: f64,
}

/// A contact: relative position of its surfaces, contact law, and treatment by the schemes.
#[allow(clippy::struct_excessive_bools)] // Each is a choice of the case, independent of the others.
pub struct Contact {
    /// Name in the case.
    pub name: String,
    /// Gaps at positions.
    pub kinematics: Box<dyn Kinematics>,
    /// Law and enforcement.
    pub interface: Box<dyn Interface>,
    /// Body of the primary side; `None` for a rigid primary, unless it has a mass.
    pub primary_part: Option<usize>,
    /// Whether the primary side is the secondary one.
    pub itself: bool,
    /// Facets of either side in global nodes with their shape, for consistent weights; the
    /// secondary side first; once if the side is in contact with itself.
    pub facets: Vec<(FacetShape, Vec<Vec<usize>>)>,
    /// A step in which a node is deeper is rejected.
    pub depths: AllowedDepths,
    /// Friction.
    pub friction: Option<Friction>,
    /// Springs of its penalty.
    pub springs: Option<Springs>,
    /// Springs of its augmented Lagrangian.
    pub augmentation: Option<Augmentation>,
    /// Whether penetration by the predictor y + Δt v is prevented too.
    pub predictor: bool,
    /// Nodes of both sides and of the carrier of a rigid primary, ascending.
    pub surface: Vec<usize>,
    /// Whether its force acts entirely at the end of the step, not averaged with the scheme's
    /// weights.
    pub at_the_end: bool,
    /// Whether velocities and accelerations are projected at activation.
    pub projects: bool,
    /// Whether the active set may change before Newton's method has converged.
    pub within: bool,
    /// Coefficient of restitution e; 0 unless the scheme or its conserving constraint uses it.
    pub restitution: f64,
}

/// The springs of a penalty, as multiples of the diagonal of the bodies' tangent in the reference
/// configuration.
pub struct Springs {
    /// Normal and tangential multiple.
    pub factors: [f64; 2],
    /// The diagonal.
    pub diagonal: OfRows,
}

/// A positive quantity of the rows of a contact.
#[derive(Default)]
pub struct OfRows {
    /// Values of the secondary nodes, by index, and of what follows the nodes.
    pub of_rows: Vec<f64>,
    /// Values of the nodes of the secondary side, by their global numbers: a row that is of none of
    /// them has the mean of those next to it.
    pub of_nodes: HashMap<usize, f64>,
}

impl OfRows {
    /// The value of the row of a pair.
    pub(crate) fn at(&self, kinematics: &dyn Kinematics, pair: &Pair) -> f64 {
        let known = |point: &BetweenNodes| point.nodes.iter().all(|node| self.of_nodes.contains_key(node));
        match kinematics.between_nodes(pair).filter(known) {
            Some(point) => point.mean(|node| self.of_nodes[&node]),
            None => self.of_rows[pair.node],
        }
    }
}

/// The springs of an augmented Lagrangian, as multiples of the diagonal of a step's tangent.
pub struct Augmentation {
    /// Normal and tangential multiple.
    pub factors: [f64; 2],
    /// Diagonal of the bodies' tangent in the reference configuration at each secondary node.
    pub stiffness: Vec<f64>,
}

impl Contact {
    /// The secondary node of a pair; an edge has the number of one of its nodes.
    pub(crate) fn node(&self, pair: &Pair) -> usize {
        self.kinematics.secondary()[pair.node]
    }

    /// Gives a pair the diagonal of which its springs are multiples, if it has none yet.
    pub(crate) fn find_spring(&self, pair: &mut Pair) {
        let Some(springs) = self.springs.as_ref().filter(|_| pair.diagonal.is_none()) else { return };
        pair.diagonal = Some(springs.diagonal.at(&*self.kinematics, pair));
    }

    /// Stiffness of the penalty spring of a pair; none of a constraint.
    pub(crate) fn spring(&self, pair: &Pair) -> Option<f64> {
        let springs = self.springs.as_ref()?;
        let there = || springs.diagonal.at(&*self.kinematics, pair);
        Some(springs.factors[0] * pair.diagonal.unwrap_or_else(there))
    }

    /// Lets the spring of a pair be that of its place, at the start of a step: an energy-conserving
    /// one only if the pair is open, since the energy of a spring that changes is not conserved.
    pub(crate) fn renew_spring(&self, pair: &mut Pair) {
        if !(pair.active && self.interface.direction().accumulates()) {
            pair.diagonal = None;
        }
    }

    /// Stiffness of the tangential spring of a pair; none where friction is a constraint.
    pub(crate) fn stick_spring(&self, pair: &Pair) -> Option<f64> {
        let springs = self.springs.as_ref()?;
        let rubs = self.friction.as_ref().is_some_and(|friction| pair.node < friction.places.len());
        let there = || springs.diagonal.at(&*self.kinematics, pair);
        rubs.then(|| springs.factors[1] * pair.diagonal.unwrap_or_else(there))
    }

    /// Whether a pair keeps out a single node beside a field of pressure.
    pub(crate) fn bounds(&self, pair: &Pair) -> bool {
        self.kinematics.is_of_field(0) && !self.kinematics.is_of_field(pair.node)
    }

    /// Whether it is a constraint whose closed gaps do no work.
    pub(crate) fn conserves(&self) -> bool {
        self.interface.is_constraint() && self.interface.direction() == Direction::DiscreteGradient
    }
}

impl AllowedDepths {
    /// Of a node that the contact constrains or not, at a kink of its own side or not.
    pub(crate) fn of(self, constrained: bool, is_kink: bool) -> f64 {
        match (constrained, is_kink) {
            (true, false) => self.smooth,
            (true, true) => self.kinks,
            (false, _) => self.others,
        }
    }
}
