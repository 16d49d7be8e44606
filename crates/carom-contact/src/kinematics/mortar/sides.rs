//! The sides of a mortar contact with their multipliers.

use std::sync::Mutex;

use super::cache::Cache;
use super::cut::{Quadrature, Rule};
use super::multipliers::{MOST, Multiplier, Part, degree_of_pressure, multipliers, without_held};
use super::opposite::{Opposite, Primary};
use crate::kinematics::facets::Facets;
use crate::kinematics::folds::Folds;
use crate::kinematics::surface::Surface;
use crate::kinematics::{Kinematics, NodeToObstacle};
use crate::places::Places;

/// Contact on average of a side in the plane with a side of another body or a rigid obstacle.
#[derive(Debug)]
pub struct Mortar {
    pub(super) secondary: Surface,
    pub(super) opposite: Opposite,
    pub(super) multipliers: Vec<Multiplier>,
    /// Nodes that represent the multipliers.
    pub(super) nodes: Vec<usize>,
    /// The multiplier of each polynomial of each facet of the secondary side.
    pub(super) of_facets: Vec<[usize; MOST]>,
    /// Degree of the pressure.
    pub(super) degree: usize,
    pub(super) rule: Rule,
    /// Whether springs press in place of multipliers.
    pub(super) springs: bool,
    pub(super) reference: Vec<f64>,
    /// Nodes on whose positions gaps depend.
    pub(super) surface: Vec<usize>,
    /// Whether each secondary facet belongs to a multiplier.
    pub(super) used: Vec<bool>,
    pub(super) cache: Mutex<Cache>,
    /// Initial depth that is kept for each multiplier; empty if all are zero.
    pub(super) kept: Vec<f64>,
    /// Depth that is kept at every point of a multiplier's part of the side.
    pub(super) kept_depths: Vec<f64>,
    /// Nodes of both sides against the other one: none may pass through it.
    pub(super) sides: Box<dyn Kinematics>,
    /// Initial depths that are kept at the nodes of both sides; multipliers keep `kept`.
    pub(super) sides_kept: Vec<(usize, f64)>,
}

impl Mortar {
    /// Contact of a secondary with a primary side; `reference`: reference positions, flat over all
    /// nodes; `sides`: contact of their nodes, which finds those that pass through a body.
    pub fn new(
        secondary: Surface,
        primary: Surface,
        reference: &[f64],
        sides: impl Kinematics + 'static,
    ) -> Self {
        Self::between(secondary, Opposite::Side(Primary::new(primary, None)), reference, Box::new(sides))
    }

    /// Contact of a side with itself: of two places that meet the later one along the boundary is
    /// the secondary; `piece`: the connected piece of its body to which each node belongs, from
    /// `first_node` on; `reference` and `sides` as in [`new`](Self::new).
    pub fn of_itself(
        side: Surface,
        piece: &[usize],
        first_node: usize,
        reference: &[f64],
        sides: impl Kinematics + 'static,
    ) -> Self {
        let folds = Box::new(Folds::new(&side, piece, first_node, reference));
        let opposite = Opposite::Side(Primary::new(side.clone(), Some(folds)));
        Self::between(side, opposite, reference, Box::new(sides))
    }

    /// Contact of a secondary side with the obstacle of its nodes; `reference`: reference
    /// positions, flat over all nodes.
    pub fn with_obstacle(secondary: Surface, nodes: NodeToObstacle, reference: &[f64]) -> Self {
        Self::between(secondary, Opposite::Obstacle(Box::new(nodes.clone())), reference, Box::new(nodes))
    }

    fn between(
        secondary: Surface,
        opposite: Opposite,
        reference: &[f64],
        sides: Box<dyn Kinematics>,
    ) -> Self {
        let multipliers = multipliers(&secondary, reference);
        let degree = secondary.shape().degree();
        let rule = Rule::new(Quadrature::default(), [degree, opposite.degree()]);
        let mut used = vec![false; secondary.facets()];
        multipliers.iter().flat_map(|of| &of.parts).for_each(|part| used[part.facet] = true);
        let own = &secondary.nodes[..secondary.facets() * secondary.shape.nodes()];
        let mut surface = [own, opposite.all_nodes(), &opposite.sibling_nodes()].concat();
        surface.sort_unstable();
        surface.dedup();
        Self {
            surface,
            used,
            of_facets: of_facets(&multipliers, secondary.facets()),
            cache: Mutex::default(),
            nodes: multipliers.iter().map(|of| of.node).collect(),
            degree: degree_of_pressure(degree),
            secondary,
            opposite,
            multipliers,
            rule,
            springs: false,
            reference: reference.to_vec(),
            kept: Vec::new(),
            kept_depths: Vec::new(),
            sides,
            sides_kept: Vec::new(),
        }
    }

    /// With springs in place of multipliers: where little of a coefficient's area has a partner,
    /// its pressure is no larger than elsewhere, and no neighbour carries it.
    #[must_use]
    pub fn with_springs(self) -> Self {
        Self { springs: true, ..self }
    }

    /// With multipliers that leave the nodes of facets of degree 1 that supports hold along the
    /// normal to their neighbours; `fixed`: by dof, whether it is not free. For an opposite side
    /// without free dofs: otherwise its motion tells their gaps apart.
    #[must_use]
    pub fn without_held(mut self, fixed: &[bool]) -> Self {
        if self.secondary.shape().degree() == 1 {
            let all = std::mem::take(&mut self.multipliers);
            self.multipliers = without_held(all, &self.secondary, &self.reference, fixed);
            self.of_facets = of_facets(&self.multipliers, self.secondary.facets());
            self.nodes = self.multipliers.iter().map(|of| of.node).collect();
        }
        self
    }

    /// With another quadrature than in parts.
    #[must_use]
    pub fn integrated(mut self, quadrature: Quadrature) -> Self {
        self.rule = Rule::new(quadrature, [self.secondary.shape().degree(), self.opposite.degree()]);
        self
    }

    /// Positions of the reference configuration.
    pub(super) fn reference(&self) -> Places<'_> {
        Places::new(&self.reference, 2)
    }
}

/// The multiplier of each polynomial of each facet of the secondary side.
fn of_facets(multipliers: &[Multiplier], facets: usize) -> Vec<[usize; MOST]> {
    let mut numbers = vec![[0; MOST]; facets];
    for (number, of) in multipliers.iter().enumerate() {
        for &Part { facet, polynomial, .. } in &of.parts {
            numbers[facet][polynomial] = number;
        }
    }
    numbers
}
