//! The kinematics of contacts between sides of bodies: each side with its siblings, which are sides
//! that other contacts have in its place, and with the rest of its body's boundary.

use std::collections::{HashMap, HashSet};

use carom_case::{self as case, Case, ContactSpec, Problem, SKIN};
use carom_contact::{
    AtJoints, Boundary, Combined, ContactPoint, Detection, EdgePoints, EdgeToEdge, Kinematics, Mortar,
    NodeToFacet, NodeToObstacle, NodeToPatch, NodesWithDepth, Outward, Quadrature, Surface, TipToFacet,
};
use carom_mechanics::model::{BodyInstance, bounds};
use carom_solid::{longest_edge, shortest_edge};

use super::side::{Side, side};

/// Depth of smooth nodes of the primary in edges of the secondary, over the shortest edge of its
/// facets.
const ALLOWED: f64 = 0.02;

/// A model as far as the contacts between its sides need it.
pub(super) struct Bodies<'a> {
    pub(super) case: &'a Case,
    pub(super) parts: &'a [BodyInstance],
    pub(super) reference: &'a [f64],
    pub(super) fixed: &'a [bool],
    /// Whether a support moves a dof.
    pub(super) moved: &'a [bool],
    /// Facets that a tie has closed.
    pub(super) closed: &'a HashSet<Vec<usize>>,
}

/// A side of a contact.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Which {
    Primary,
    Secondary,
}

impl Bodies<'_> {
    /// The side of a contact. A whole boundary is without the faces that a tie has closed: nothing
    /// meets them, and to what slides over the joint of two bodies they would be walls.
    pub(super) fn side(&self, name: &str, path: &str) -> Result<Side, Problem> {
        let side = side(self.parts, name, path)?;
        let is_skin = name.split_once('.').is_some_and(|(_, side)| side == SKIN);
        Ok(if is_skin { side.without(self.closed) } else { side })
    }

    /// Kinematics of contact `k` between two sides, of which one may be the other.
    pub(super) fn kinematics(&self, k: usize, secondary: &Side, primary: &Side) -> Box<dyn Kinematics> {
        match (self.case.dimension, primary.part == secondary.part) {
            (3, true) => Box::new(self.itself_in_space(k, secondary)),
            (_, true) => Box::new(self.itself(k, secondary)),
            (3, false) => Box::new(self.in_space(k, secondary, primary)),
            (_, false) => self.in_the_plane(k, secondary, primary),
        }
    }

    fn in_the_plane(&self, k: usize, secondary: &Side, primary: &Side) -> Box<dyn Kinematics> {
        let spec = &self.case.contacts[k];
        let detection = match spec.detection {
            case::Detection::ClosestPoint => Detection::ClosestPoint,
            case::Detection::Trajectory => Detection::Trajectory,
        };
        let point = match spec.xi {
            case::ContactPoint::Closest => ContactPoint::Closest,
            case::ContactPoint::Frozen => ContactPoint::Frozen,
        };
        let at_joints = self.at_joints(k);
        let of_secondary = self.siblings(k, secondary.part, Which::Secondary);
        let of_primary = self.siblings(k, primary.part, Which::Primary);
        let side = self.surface(primary, &of_primary.concat());
        let opposite = self.surface(secondary, &of_secondary.concat());
        let nodes = NodeToFacet::new(without(&secondary.nodes, &of_secondary[0]), side.clone(), detection)
            .with_point(point)
            .with_joints(at_joints)
            .of_body(opposite.clone());
        if self.case.dimension == 1 || point == ContactPoint::Frozen {
            return Box::new(nodes);
        }
        let corners = |surface: &Surface| surface.corners(self.reference);
        let theirs = self.others(primary, &of_primary[0], secondary, &corners(&side));
        let against = |of: NodesWithDepth, own: &Surface, other: &Surface| {
            NodeToFacet::new(of.nodes, other.clone(), Detection::ClosestPoint)
                .with_allowed(of.depths)
                .with_joints(at_joints)
                .of_body(own.clone())
        };
        let both = Combined::both(nodes, against(theirs.clone(), &side, &opposite).reversed());
        if spec.method == case::Method::NodeToSegment {
            return Box::new(both);
        }
        let ours = self.others(secondary, &of_secondary[0], primary, &corners(&opposite));
        let ours = bounded(spec, ours, self.depth_in(primary));
        let theirs = bounded(spec, theirs, self.depth_in(secondary));
        let single =
            Combined::both(against(ours, &opposite, &side), against(theirs, &side, &opposite).reversed());
        let mortar = integrated(spec, Mortar::new(opposite, side, self.reference, both));
        let mortar = self.without_held(spec, mortar, &primary.nodes);
        Box::new(Combined::both(mortar, single))
    }

    fn in_space(&self, k: usize, secondary: &Side, primary: &Side) -> Combined {
        let of_secondary = self.siblings(k, secondary.part, Which::Secondary);
        let of_primary = self.siblings(k, primary.part, Which::Primary);
        let side = self.boundary(primary, &of_primary.concat());
        let opposite = self.boundary(secondary, &of_secondary.concat());
        let corners = side.nodes_of_sharp_edges(self.reference);
        let own = self.others(primary, &of_primary[0], secondary, &corners);
        let earlier =
            [&of_secondary, &of_primary].map(|of| of[0].iter().flat_map(|s| s.nodes.clone()).collect());
        let at_joints = self.at_joints(k);
        let edges = EdgeToEdge::new([opposite.clone(), side.clone()], &earlier, self.reference);
        let nodes = NodeToPatch::new(without(&secondary.nodes, &of_secondary[0]), side.clone())
            .with_joints(at_joints)
            .of_body(opposite.clone());
        let mut parts: Vec<Box<dyn Kinematics>> = vec![Box::new(nodes)];
        let others = NodeToPatch::new(own.nodes, opposite.clone())
            .with_allowed(own.depths)
            .with_joints(at_joints)
            .of_body(side.clone())
            .reversed();
        parts.push(Box::new(others));
        parts.push(Box::new(edges));
        let spec = &self.case.contacts[k];
        // An overlap that is kept or relaxed is one of nodes, which points between them would
        // close; springs let in nodes and points alike, and those of both would add up.
        if spec.overlap == case::Overlap::Refuse && spec.enforcement.is_exact() {
            let [ours, theirs] = &earlier;
            let depths = [primary, secondary].map(|side| self.depth_in(side));
            let points = EdgePoints::new(&opposite, side.clone(), depths[0], ours, self.reference);
            let reverse = EdgePoints::new(&side, opposite, depths[1], theirs, self.reference);
            let both = [points, reverse.map(EdgePoints::reversed)];
            parts.extend(both.into_iter().flatten().map(|points| Box::new(points) as Box<dyn Kinematics>));
        }
        Combined::new(parts)
    }

    /// Contact with a rigid obstacle, in the plane with its convex parts.
    pub(super) fn with_tips(&self, k: usize, side: &Side, obstacle: NodeToObstacle) -> Box<dyn Kinematics> {
        let siblings = self.siblings(k, side.part, Which::Secondary).concat();
        if self.case.dimension == 1 {
            return Box::new(obstacle);
        }
        if self.case.dimension == 3 {
            return Box::new(obstacle.of_body(Outward::Space(self.boundary(side, &siblings))));
        }
        let surface = self.surface(side, &siblings);
        let obstacle = obstacle.of_body(Outward::Plane(surface.clone()));
        let tips = (!obstacle.tips(self.reference).is_empty()).then(|| {
            let tips = TipToFacet::new(&obstacle, surface.clone(), self.reference);
            let spec = &self.case.contacts[k];
            let springs = spec.enforcement == case::Enforcement::Penalty;
            let rubs = spec.friction.exists();
            let alone = springs || spec.method == case::Method::Mortar;
            let tips = if alone { tips.not_left_to_nodes() } else { tips };
            if springs || rubs { tips.with_single_facets() } else { tips }
        });
        match self.case.contacts[k].method {
            case::Method::Mortar => self.mortar_with_obstacle(k, side, surface, obstacle, tips),
            case::Method::NodeToSegment => match tips {
                Some(tips) => Box::new(Combined::both(obstacle, tips)),
                None => Box::new(obstacle),
            },
        }
    }

    /// Contact on average with a rigid obstacle, with bounds for single nodes and with the corners
    /// of the obstacle, if any.
    fn mortar_with_obstacle(
        &self,
        k: usize,
        side: &Side,
        surface: Surface,
        obstacle: NodeToObstacle,
        tips: Option<TipToFacet>,
    ) -> Box<dyn Kinematics> {
        let spec = &self.case.contacts[k];
        let single = self.others(side, &[], side, &surface.corners(self.reference));
        let single = bounded(spec, single, self.depth_in(side));
        let single = obstacle.of_nodes(&single);
        let carriers = obstacle.carriers().to_vec();
        let mortar = integrated(spec, Mortar::with_obstacle(surface, obstacle, self.reference));
        let mortar = self.without_held(spec, mortar, &carriers);
        let mut parts: Vec<Box<dyn Kinematics>> = vec![Box::new(mortar), Box::new(single)];
        parts.extend(tips.map(|tips| Box::new(tips) as Box<dyn Kinematics>));
        Box::new(Combined::new(parts))
    }

    /// A mortar contact by multipliers without those of nodes that are not free, if no node of the
    /// opposite side is. Springs press on nodes that are held, too.
    fn without_held(&self, spec: &ContactSpec, mortar: Mortar, opposite: &[usize]) -> Mortar {
        let stands = opposite.iter().all(|node| self.fixed[2 * node] && self.fixed[2 * node + 1]);
        let multipliers = spec.enforcement == case::Enforcement::Multiplier;
        if stands && multipliers { mortar.without_held(self.fixed) } else { mortar }
    }

    /// Pairs of nodes over joints. The springs of several facets would add up, and in the plane
    /// those of a mean chatter; in load steps of space the slip of a mean may depend on others.
    fn at_joints(&self, k: usize) -> AtJoints {
        let spec = &self.case.contacts[k];
        let has_springs = spec.enforcement == case::Enforcement::Penalty;
        let is_in_space = self.case.dimension == 3;
        let rubs_at_rest = spec.friction.exists() && self.case.time.scheme.is_static();
        let mean = if is_in_space { !rubs_at_rest } else { !has_springs };
        AtJoints { mean, several: !has_springs }
    }

    fn itself(&self, k: usize, side: &Side) -> Combined {
        let spec = &self.case.contacts[k];
        let surface = self.surface(side, &[]);
        let part = &self.parts[side.part];
        let pieces = part.body.mesh().pieces();
        let at_joints = self.at_joints(k);
        let against = |nodes: [NodesWithDepth; 2]| {
            NodeToFacet::of_itself(&surface, nodes, &pieces, part.first_node, self.reference, at_joints)
        };
        let with_depth = self.others(side, &[], side, &surface.corners(self.reference));
        let both = against([NodesWithDepth::all_held(side.nodes.clone()), with_depth.clone()]);
        if spec.method == case::Method::NodeToSegment {
            return both;
        }
        let bounded = bounded(spec, with_depth, self.depth_in(side));
        let bounds = against([bounded.clone(), bounded]);
        let mortar = Mortar::of_itself(surface.clone(), &pieces, part.first_node, self.reference, both);
        Combined::both(integrated(spec, mortar), bounds)
    }

    fn itself_in_space(&self, k: usize, side: &Side) -> Combined {
        let boundary = self.boundary(side, &[]);
        let sharp = boundary.nodes_of_sharp_edges(self.reference);
        let earlier = self.others(side, &[], side, &sharp);
        let part = &self.parts[side.part];
        let pieces = part.body.mesh().pieces();
        let at_joints = self.at_joints(k);
        NodeToPatch::of_itself(
            &boundary,
            side.nodes.clone(),
            earlier,
            &pieces,
            part.first_node,
            self.reference,
            at_joints,
        )
    }

    /// Whether a support moves a node in the plane along a direction.
    pub(super) fn moves(&self, node: usize, along: [f64; 2]) -> bool {
        along.iter().enumerate().any(|(axis, component)| *component != 0.0 && self.moved[2 * node + axis])
    }

    fn is_fixed(&self) -> impl Fn(usize, usize) -> bool {
        let dimension = self.case.dimension;
        move |node, axis| self.fixed[dimension * node + axis]
    }

    /// The nodes of a side, except those on sides of `earlier` contacts, each with the depth to
    /// which it may enter facets of another side: none at corners.
    fn others(&self, side: &Side, earlier: &[Side], other: &Side, corners: &[usize]) -> NodesWithDepth {
        let depth = self.depth_in(other);
        let mut nodes = without(&side.nodes, earlier);
        nodes.sort_unstable();
        let allowed = |node| if corners.contains(node) { 0.0 } else { depth };
        let depths = nodes.iter().map(allowed).collect();
        NodesWithDepth { nodes, depths }
    }

    /// The depth to which smooth nodes may enter a side.
    fn depth_in(&self, side: &Side) -> f64 {
        let facets = side.facets.iter().filter(|facet| facet.len() > 1);
        let lengths = facets.map(|facet| shortest_edge(facet, self.reference, self.case.dimension));
        ALLOWED * lengths.fold(f64::INFINITY, f64::min)
    }

    /// The sides of a body that other contacts have in the place of this one's, with the same
    /// opposite side: of earlier contacts, and of later ones. Together they are one surface.
    pub(super) fn siblings(&self, k: usize, part: usize, which: Which) -> [Vec<Side>; 2] {
        let spec = &self.case.contacts[k];
        let of = |other: &ContactSpec| {
            let (same, name) = match which {
                Which::Primary => (other.secondary == spec.secondary, other.primary.side()?),
                Which::Secondary => (other.primary == spec.primary, other.secondary.as_str()),
            };
            // There may be a contact per pair of bodies: few of them need their nodes.
            if same { self.side(name, "").ok().filter(|side| side.part == part) } else { None }
        };
        let earlier = &self.case.contacts[..k];
        let later = &self.case.contacts[k + 1..];
        [earlier, later].map(|contacts| contacts.iter().filter_map(of).collect())
    }

    /// A side of the plane with its siblings and the rest of its body's boundary.
    fn surface(&self, side: &Side, siblings: &[Side]) -> Surface {
        let (rest, count) = self.rest(side, siblings);
        let surface = Surface::new(side.shape, &side.facets, &side.orientations).bounded_by(&rest, count);
        let surface =
            surface.with_mirrors(self.reference, &bounds(self.parts, self.reference), self.is_fixed());
        surface.with_closed(self.closed)
    }

    /// A side in space with its siblings and the rest of its body's boundary.
    fn boundary(&self, side: &Side, siblings: &[Side]) -> Boundary {
        let (rest, count) = self.rest(side, siblings);
        let boundary = Boundary::new(side.shape, &side.facets, &rest, count);
        let boundary =
            boundary.with_mirrors(self.reference, &bounds(self.parts, self.reference), self.is_fixed());
        boundary.with_closed(self.closed)
    }

    /// The rest of the boundary of a side's body, the facets of its siblings first, and their
    /// number.
    fn rest(&self, side: &Side, siblings: &[Side]) -> (Vec<Vec<usize>>, usize) {
        let own: HashSet<&Vec<usize>> = siblings.iter().flat_map(|sibling| &sibling.facets).collect();
        let mut rest = side.rest(self.parts);
        rest.sort_by_key(|facet| !own.contains(facet));
        let count = rest.iter().filter(|facet| own.contains(facet)).count();
        (rest, count)
    }
}

/// The nodes with a bound on their depth beside gaps that are zero on average, which keep out no
/// single node: beside a kink of the other side one would enter far. Springs let in every node;
/// with them only corners are kept out, from the depth on that other nodes may have: the force
/// would be shared between a corner and the coefficients around it.
fn bounded(spec: &ContactSpec, nodes: NodesWithDepth, depth: f64) -> NodesWithDepth {
    match spec.enforcement {
        case::Enforcement::Multiplier | case::Enforcement::Augmented => nodes,
        case::Enforcement::Penalty => nodes.without_depth().with_at_least(depth),
    }
}

/// Mortar contact as its table says.
fn integrated(spec: &ContactSpec, mortar: Mortar) -> Mortar {
    let mortar = mortar.integrated(match spec.quadrature {
        case::Quadrature::Segments => Quadrature::Segments,
        case::Quadrature::Fixed => Quadrature::Fixed,
    });
    if spec.enforcement == case::Enforcement::Penalty { mortar.with_springs() } else { mortar }
}

/// Nodes that belong to none of these sides.
pub(super) fn without(nodes: &[usize], sides: &[Side]) -> Vec<usize> {
    let belongs = |node: &usize| sides.iter().any(|side| side.nodes.contains(node));
    nodes.iter().copied().filter(|node| !belongs(node)).collect()
}

/// The longest edge of the facets of each node of a side, in `d` dimensions.
pub(super) fn longest(nodes: &[usize], facets: &[Vec<usize>], reference: &[f64], d: usize) -> Vec<f64> {
    let mut of: HashMap<usize, f64> = HashMap::new();
    for facet in facets.iter().filter(|facet| facet.len() > 1) {
        let length = longest_edge(facet, reference, d);
        for &node in facet {
            let longest = of.entry(node).or_default();
            *longest = longest.max(length);
        }
    }
    nodes.iter().filter_map(|node| of.get(node).copied()).collect()
}
