//! Secondary nodes against a primary side of facets: curved ones of any order in the plane, a point
//! at the end of a bar.
//!
//! Rows are in `facet_rows.rs`, the gap and its derivatives in `gap.rs`. ξ is that of the closest
//! point, solved for in every call up to |ξ| = 1.2 beyond an end. With [`ContactPoint::Frozen`] it
//! is that of the crossing of the paths in the first step of a pair, and of the closest point at
//! the start of the step in the later ones; a step leaves it unchanged.
//!
//! Which facet a node faces, at joints and ends, is in `facing.rs`. A pair is handed to the
//! neighbour only between solves.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use carom_solid::FacetShape;

use super::facets::{Facets, OnFacet};
use super::facing::Reached;
use super::folds::{Folds, Side, Turns};
use super::hand_over::{Held, Measured, Next, Sliding};
use super::joint::{AtJoints, OnFacets};
use super::opposed::is_left;
use super::passed::{Boxes, Passed, Paths};
use super::reversed::{Corners, Faced};
use super::rounding::rounding;
use super::surface::{Search, Surface};
use super::swept::SweptTest;
use super::trajectory::crossing;
use super::way::Met;
use super::{Kinematics, watch_every_node, zero};
use crate::constants::{HAND_BACK_XI, HAND_OVER_XI, NEAR_END, PAST_SIDE, REACH_XI};
use crate::pair::{ContactError, Pair, PairEvent, Pairing, in_order};
use crate::places::Places;
use crate::rows::Rows;

/// The gap that decides that a node has reached the primary side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detection {
    /// The gap at the closest point; trajectories only give candidates.
    ClosestPoint,
    /// The gap at the point where the trajectories cross, eq. (8) as printed.
    Trajectory,
}

/// The point of a facet at which the gap is measured during the iterations of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactPoint {
    /// The closest point, which follows the iterate.
    Closest,
    /// The point found by the detection, or the closest point at the start of the step.
    Frozen,
}

/// Secondary nodes against a primary side of facets.
#[derive(Debug)]
pub struct NodeToFacet {
    pub(super) secondary: Vec<usize>,
    pub(super) primary: Surface,
    pub(super) detection: Detection,
    pub(super) point: ContactPoint,
    /// Depth that each node may have without contact; empty if none may have any.
    allowed: Vec<f64>,
    /// Initial depth that is kept for each node; empty if all are zero.
    kept: Vec<f64>,
    /// Radius of the circle around each node that must not penetrate; empty if all are zero.
    radii: Vec<f64>,
    /// For contact of a side with itself: where its boundary folds, and which of two places that
    /// meet is that of the nodes.
    pub(super) folds: Option<(Arc<Folds>, Side)>,
    /// The boundary of the body to which the secondary nodes belong, and the facets at each of its
    /// nodes.
    pub(super) own: Option<(Surface, HashMap<usize, Vec<usize>>)>,
    pub(super) at_joints: AtJoints,
    /// For nodes of the primary side against the secondary one: their corners.
    reversed: Option<Corners>,
    tools: Mutex<Tools>,
}

/// Memory that searches reuse; results do not depend on its content.
#[derive(Debug)]
pub(super) struct Tools {
    pub(super) search: Search,
    pub(super) swept: SweptTest,
    pub(super) turns: Turns,
}

impl NodeToFacet {
    /// Contact of secondary nodes with a primary surface, in global node numbers.
    pub fn new(secondary: Vec<usize>, primary: Surface, detection: Detection) -> Self {
        let swept = SweptTest::new(primary.shape());
        let tools = Tools { search: Search::new(&primary, &secondary), swept, turns: Turns::default() };
        Self {
            secondary,
            primary,
            detection,
            point: ContactPoint::Closest,
            allowed: Vec::new(),
            kept: Vec::new(),
            radii: Vec::new(),
            folds: None,
            own: None,
            at_joints: AtJoints::default(),
            reversed: None,
            tools: Mutex::new(tools),
        }
    }

    /// Contact with another rule for the contact point; only [`Detection::Trajectory`] finds a
    /// point that can be frozen.
    #[must_use]
    pub fn with_point(self, point: ContactPoint) -> Self {
        Self { point, ..self }
    }

    /// Contact in which each node may have a depth without contact; its gap is larger by that
    /// depth.
    #[must_use]
    pub fn with_allowed(self, allowed: Vec<f64>) -> Self {
        let mut contact = Self { allowed, ..self };
        contact.search_to_depth();
        contact
    }

    /// Nodes are found up to the depths, or distances, at which their gaps are zero.
    fn search_to_depth(&mut self) {
        let depth = |place: usize| (self.allowed(place) + self.kept(place)).abs();
        let most = (0..self.secondary.len()).map(depth).fold(0.0, f64::max);
        self.tools.get_mut().unwrap_or_else(PoisonError::into_inner).search.look_around(most);
    }

    /// Contact of circles around the nodes, whose gaps are smaller by their radii.
    #[must_use]
    pub(super) fn with_radii(mut self, radii: Vec<f64>) -> Self {
        let tools = self.tools.get_mut().unwrap_or_else(PoisonError::into_inner);
        tools.search.reach_out(radii.iter().copied().fold(0.0, f64::max));
        Self { radii, ..self }
    }

    /// Contact with another rule for nodes over joints.
    #[must_use]
    pub fn with_joints(self, at_joints: AtJoints) -> Self {
        Self { at_joints, ..self }
    }

    /// Contact of nodes that belong to a body with the boundary `own`.
    #[must_use]
    pub fn of_body(self, own: Surface) -> Self {
        let mut around: HashMap<usize, Vec<usize>> = HashMap::new();
        for facet in 0..own.all() {
            let ends = own.facet(facet).nodes.iter();
            ends.for_each(|&node| around.entry(node).or_default().push(facet));
        }
        Self { own: Some((own, around)), ..self }
    }

    /// Whether a node can press on a facet, rather than on one beside it (`opposed.rs`).
    pub(super) fn may_press(&self, node: usize, facet: usize, y: Places) -> bool {
        let Some((own, around)) = &self.own else { return true };
        let Some(around) = around.get(&node) else { return true };
        let normals = own.normals_at(node, around, y);
        let here = self.primary.facet(facet).at(y, 0.0);
        let height = (y.at(node) - here.position).dot(&here.normal);
        let sized =
            |other: usize| (self.primary.facet(other).at(y, 0.0).normal, self.primary.length(other, y));
        !is_left(&normals, here.normal, height, || self.primary.across_corners(facet, y).map(sized))
    }

    /// Contact of nodes of the primary side with the secondary one (`reversed.rs`), once the body
    /// of the nodes and their depths are known.
    #[must_use]
    pub fn reversed(self) -> Self {
        let corners = self
            .own
            .as_ref()
            .map(|(own, _)| Corners::new(own, &self.secondary, |place| self.allowed(place), NEAR_END));
        Self { reversed: Some(corners.unwrap_or_default()), ..self }
    }

    /// Whether the pair of a corner of the primary side is left to a node of its facet.
    fn is_left_to_node(&self, pair: &Pair, y: &[f64]) -> bool {
        let (Some(corners), Some((own, _))) = (&self.reversed, &self.own) else { return false };
        let node = self.secondary[pair.node];
        let at = OnFacet { facet: pair.facet, xi: [pair.xi, pair.eta] };
        let corner = Faced { place: pair.node, node, at };
        corners.is_left_to_node(corner, [own, &self.primary], y)
    }

    /// Depth at which the gap of a node is zero: its allowed and its kept depth, less the radius of
    /// its circle.
    pub(super) fn slack(&self, place: usize) -> f64 {
        self.allowed(place) + self.kept(place) - self.radii.get(place).copied().unwrap_or(0.0)
    }

    /// The point nearest to a secondary node of the facets that it faces and can press on, and the
    /// gap there.
    fn faced(&self, node: usize, y: Places) -> Option<(OnFacet<f64>, f64)> {
        let node = self.secondary[node];
        (0..self.primary.facets())
            .filter_map(|facet| {
                let xi = self.primary.facet(facet).closest_point(y, y.at(node), 1.0 + PAST_SIDE)?;
                let faced = (OnFacet { facet, xi }, self.gap(node, facet, xi, y));
                self.may_press(node, facet, y).then_some(faced)
            })
            .min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
    }

    pub(super) fn is_frozen(&self) -> bool {
        self.point == ContactPoint::Frozen
    }

    pub(super) fn places<'a>(&self, y: &'a [f64]) -> Places<'a> {
        Places::new(y, self.primary.shape().dimension())
    }

    pub(super) fn gap(&self, node: usize, facet: usize, xi: f64, y: Places) -> f64 {
        self.primary.gap(facet, xi, y.at(node), y)
    }

    /// Hands over, adds or drops pairs past the ends of their facets. Returns whether anything but
    /// an inactive pair changed.
    fn slide(&self, before: Places, now: Places, pairing: &mut Pairing, events: &mut Vec<PairEvent>) -> bool {
        // A frozen contact point belongs to the positions at the start of the step.
        let placed = if self.is_frozen() { before } else { now };
        let next = |pair: &Pair, came_from: Option<usize>| {
            let node = self.secondary[pair.node];
            let is_corners = || self.is_left_to_corner(node, pair.facet, pair.xi, before);
            if self.ends_at(node, pair.facet, pair.xi) || is_corners() {
                return Next::Leave;
            }
            match self.primary.next_facet(pair, placed.at(node), came_from, placed) {
                Next::HandOver(facet, _) if !self.may_press(node, facet, placed) => {
                    let leaves = self.primary.faces_nothing(pair.facet, pair.xi, placed);
                    if leaves { Next::Leave } else { Next::Stay }
                }
                // Two springs at a blunt joint are too stiff, and the second begins with a depth.
                Next::Concave(..)
                    if !self.at_joints.several
                        && self.is_blunt(pair.facet, u8::from(pair.xi > 0.0), placed.flat()) =>
                {
                    Next::Stay
                }
                next => next,
            }
        };
        let depth = |place: usize, facet: usize, [xi, _]: [f64; 2]| {
            -self.gap(self.secondary[place], facet, xi, now) - self.slack(place)
        };
        let held = Held::several(&pairing.pairs);
        let is_past = |pair: &Pair| pair.xi.abs() > HAND_OVER_XI;
        let is_near = |pair: &Pair| pair.xi.abs() <= REACH_XI;
        let sliding = Sliding { nodes: &self.secondary, facets: self.primary.facets(), next };
        let size = |facet: usize| self.primary.length(facet, now);
        let measured = Measured { is_past: &is_past, is_near: &is_near, depth: &depth, size: &size };
        sliding.search(pairing, held, &measured, events)
    }

    /// Adds a pair for every node that may have reached a facet, and for nodes with pairs that
    /// enter the side elsewhere. Returns whether one of them penetrates.
    fn find_pairs(&self, tools: &mut Tools, pairs: &mut Vec<Pair>, before: Places, now: Places) -> bool {
        let mut changed = false;
        let known = pairs.len();
        let mut next = 0;
        for (k, &node) in self.secondary.iter().enumerate() {
            let first = next;
            while next < known && pairs[next].node == k {
                next += 1;
            }
            if next > first {
                if self.detection == Detection::ClosestPoint
                    && let Some(OnFacet { facet, xi }) =
                        self.elsewhere(tools, k, &pairs[first..next], before, now)
                {
                    changed = true;
                    pairs.push(Pair::open(k, facet, xi));
                }
                continue;
            }
            let Some(Reached { facet, xi, crossed }) = self.candidate(tools, k, before, now) else {
                continue;
            };
            let pair = Pair::open(k, facet, xi);
            let pair = Pair { joint: self.joint_of(&pair, now.flat()), ..pair };
            let gap = self.gap(node, facet, xi, now) + self.slack(k);
            match self.detection {
                Detection::ClosestPoint if self.allowed(k) > 0.0 && gap >= 0.0 => {}
                Detection::ClosestPoint => {
                    // A candidate that already penetrates must be rechecked by the solver.
                    changed |= gap < 0.0;
                    pairs.push(pair);
                }
                // Eq. (8) decides at the crossing. A node inside by round-off crosses nothing: its
                // closest point decides.
                Detection::Trajectory if gap < 0.0 || (crossed && gap == 0.0) => {
                    changed = true;
                    pairs.push(Pair { active: true, ..pair });
                }
                Detection::Trajectory => {}
            }
        }
        changed
    }
}

impl Kinematics for NodeToFacet {
    fn secondary(&self) -> &[usize] {
        &self.secondary
    }

    fn facet_nodes(&self, pair: &Pair) -> &[usize] {
        self.primary.facet(pair.facet).nodes
    }

    /// A contact point that is frozen leaves a depth in every step, and the next one closes it.
    fn keeps_depth(&self, _: &Pair) -> bool {
        !self.is_frozen()
    }

    fn facets(&self, _: usize) -> usize {
        self.primary.facets()
    }

    fn signed_distance(&self, node: usize, y: &[f64]) -> Option<f64> {
        let (_, gap) = self.faced(node, self.places(y))?;
        Some(gap + self.kept(node))
    }

    fn roundings(&self, y: &[f64]) -> Vec<f64> {
        if self.folds.is_some() || self.primary.shape().degree() != 1 {
            return Vec::new();
        }
        let rounding = |node: usize| {
            let (OnFacet { facet, xi }, _) = self.faced(node, self.places(y))?;
            Some(rounding(&self.primary, facet, [xi, 0.0], y))
        };
        (0..self.secondary.len()).map(|node| rounding(node).unwrap_or(0.0)).collect()
    }

    fn keep(&mut self, depths: &[f64]) {
        self.kept = depths.to_vec();
        self.search_to_depth();
    }

    fn kept(&self, node: usize) -> f64 {
        self.kept.get(node).copied().unwrap_or(0.0)
    }

    fn allowed(&self, node: usize) -> f64 {
        self.allowed.get(node).copied().unwrap_or(0.0)
    }

    fn search(
        &self,
        before: &[f64],
        now: &[f64],
        pairing: &mut Pairing,
        events: &mut Vec<PairEvent>,
    ) -> bool {
        if self.primary.shape() == FacetShape::Point {
            // A point has no neighbours to search, and no ends to slide off.
            watch_every_node(self.secondary.len(), &mut pairing.pairs);
            return false;
        }
        let before = self.places(before);
        let now = self.places(now);
        let starts = pairing.fresh;
        let left = if starts {
            // A pair over a joint does not slide to another facet of it.
            self.start_joints(&mut pairing.pairs, before.flat());
            Vec::new()
        } else {
            self.leave_joints(&mut pairing.pairs, now.flat())
        };
        let slid = self.slide(before, now, pairing, events)
            | self.take_joints(&mut pairing.pairs, &left, now.flat());
        if starts {
            self.start_joints(&mut pairing.pairs, before.flat());
        }
        let Pairing { pairs, margin, .. } = pairing;
        let mut tools = self.tools.lock().unwrap_or_else(PoisonError::into_inner);
        if !tools.search.update(&self.primary, &self.secondary, *margin, before, now) {
            return slid;
        }
        if let Some((folds, _)) = &self.folds {
            tools.turns.update(folds, &self.primary, before);
        }
        let found = self.find_pairs(&mut tools, pairs, before, now);
        in_order(pairs);
        slid || found
    }

    fn met(&self, nodes: &[usize], before: &[f64], now: &[f64]) -> Vec<Option<f64>> {
        let [before, now] = [before, now].map(|y| self.places(y));
        if self.primary.shape() == FacetShape::Point {
            let gap = |node, y| self.gap(self.secondary[node], 0, 0.0, y) + self.slack(node);
            return nodes.iter().map(|&node| zero(gap(node, before), gap(node, now))).collect();
        }
        let mut tools = self.tools.lock().unwrap_or_else(PoisonError::into_inner);
        let margin = Pairing::default().margin;
        if !tools.search.update(&self.primary, &self.secondary, margin, before, now) {
            return vec![None; nodes.len()];
        }
        if let Some((folds, _)) = &self.folds {
            tools.turns.update(folds, &self.primary, before);
        }
        let mut met = |&node: &usize| {
            let Met { theta, facet, .. } = self.first(&mut tools, node, before, now)?;
            let counts = self.primary.is_of_side(facet) && self.slack(node) == 0.0;
            counts.then(|| theta.clamp(0.0, 1.0))
        };
        nodes.iter().map(&mut met).collect()
    }

    fn passed(&self, before: &[f64], now: &[f64], bounce: f64) -> Option<Passed> {
        let mut tools = self.tools.lock().unwrap_or_else(PoisonError::into_inner);
        let Tools { search, swept, .. } = &mut *tools;
        let [start, end] = [before, now].map(|y| self.places(y));
        // Within one piece, a path may begin and end on either side of its own boundary.
        let is_itself = self.folds.as_ref().is_some_and(|(folds, _)| !folds.has_pieces());
        let is_point = self.primary.shape() == FacetShape::Point;
        if is_itself || is_point || !self.primary.is_whole() || search.is_apart(0.0, start, end) {
            return None;
        }
        let bounds = |node: usize, facet: usize| {
            self.folds.as_ref().is_none_or(|(folds, _)| folds.is_of_another_piece(node, facet))
        };
        let paths = Paths {
            boundary: &self.primary,
            nodes: &self.secondary,
            allowed: &|place| self.slack(place).max(0.0),
            enters: &|node, facet| !self.excludes(node, facet),
            bounds: &bounds,
            bounce,
        };
        let motion = paths.motion([before, now])?;
        if !search.update(&self.primary, &self.secondary, 0.0, start, end) {
            return None;
        }
        let of_node = |node: usize| search.path(node, start, end);
        let boxes = Boxes { tree: search.tree(), drift: search.drift(), of_node: &of_node };
        paths.deepest(motion, [before, now], boxes, |facet, ends, _, node| {
            let [from, to] = ends.map(|y| self.places(y));
            let met = crossing(swept, self.primary.facet(facet), from, to, node)?;
            Some(Met { theta: met.theta, facet, xi: [met.xi, 0.0] })
        })
    }

    fn update_facets(&self, now: &[f64], pairing: &mut Pairing, events: &mut Vec<PairEvent>) -> bool {
        if self.is_frozen() {
            return false;
        }
        let now = self.places(now);
        let next = |pair: &Pair, previous: Option<usize>| {
            let node = self.secondary[pair.node];
            match self.primary.next_facet(pair, now.at(node), previous, now) {
                Next::HandOver(facet, _)
                    if self.excludes(node, facet) || !self.may_press(node, facet, now) =>
                {
                    Next::Stay
                }
                next => next,
            }
        };
        let is_near =
            |pair: &Pair, came: bool| pair.xi.abs() <= if came { HAND_BACK_XI } else { HAND_OVER_XI };
        let sliding = Sliding { nodes: &self.secondary, facets: self.primary.facets(), next };
        sliding.update(pairing, is_near, events)
    }

    fn start_step(&self, pair: &mut Pair, y: &[f64]) {
        if self.is_frozen() {
            let y = self.places(y);
            // Without a unique closest point the pair keeps its point.
            pair.xi = self.closest(pair, y).unwrap_or(pair.xi);
        }
    }

    fn measure(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        if !pair.active && self.is_left_to_node(pair, y) {
            rows.push_open();
            return Ok(());
        }
        let first = rows.len();
        self.measure_mean(pair, y, rows)?;
        rows.reverse_from(first, self.reversed.is_some());
        Ok(())
    }

    fn curvature_into(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]) {
        self.curvature_of_mean(pair, y, curvature);
    }

    fn slip(&self, pair: &Pair, y: &[f64], _: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let first = rows.len();
        self.slip_of_mean(pair, y, rows)?;
        rows.reverse_from(first, self.reversed.is_some());
        Ok(())
    }

    fn slip_derivative_into(&self, pair: &Pair, y: &[f64], _: &[f64], tangent: usize, matrix: &mut [f64]) {
        self.slip_derivative_of_mean(pair, y, tangent, matrix);
    }
}
