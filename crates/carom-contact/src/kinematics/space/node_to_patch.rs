//! Secondary nodes against a primary side of curved facets in space.
//!
//! The gap is measured at the closest point of the pair's facet, which is extrapolated up to a
//! fifth of its height beyond its edges; between solves a pair past an edge is handed over:
//!
//! ```text
//! blunt edge       to the facet on which the nearest point lies; where that is the edge itself, the
//!                  pair keeps its facet
//! concave corner   a node that would be handed back within the step has a pair with either facet, and
//!                  one below a crease also with the facet of which it is deepest
//! sharp edge, end  nothing is faced past it; an active pair keeps its facet to the end of the step and
//!                  leaves at the start of the next one
//! ```
//!
//! Which facet a node without a pair meets is in `candidate.rs`.

use std::sync::{Arc, Mutex, PoisonError};

use carom_algebra::Vector;
use carom_solid::{Bounds, Hull};

use super::boundary::Boundary;
use super::folds::PatchFolds;
use super::patch::{Feature, PatchPoint, place};
use super::paths::{Around, Paths};
use crate::constants::{EXTENDED, HAND_BACK, MEETS, NEAR_END_SPACE, PAST_END, ROUND_OFF};
use crate::kinematics::apart::Apart;
use crate::kinematics::hand_over::{Held, Measured, Next, Sliding};
use crate::kinematics::joint::{AtJoints, OnFacets};
use crate::kinematics::opposed::is_left;
use crate::kinematics::recent::Recent;
use crate::kinematics::reversed::{Corners, Faced};
use crate::kinematics::rounding::rounding;
use crate::kinematics::{Facets, Kinematics, ON_FACET, OnFacet, Passed, Side, SweptPatch};
use crate::pair::{ContactError, Pair, PairEvent, Pairing, in_order};
use crate::rows::Rows;

/// Secondary nodes against a primary side of facets in space.
#[derive(Debug)]
pub struct NodeToPatch {
    pub(super) secondary: Vec<usize>,
    pub(super) primary: Boundary,
    pub(super) hull: Hull,
    /// Depth that each node may have without contact; empty if none may have any.
    allowed: Vec<f64>,
    /// Initial depth that is kept for each node; empty if all are zero.
    kept: Vec<f64>,
    /// For contact of a side with itself: which facets a node may meet, and which of two places
    /// that meet is that of the nodes.
    pub(super) folds: Option<(Arc<PatchFolds>, Side)>,
    /// The boundary of the body to which the secondary nodes belong.
    pub(super) own: Option<Boundary>,
    pub(super) at_joints: AtJoints,
    /// For nodes of the primary side against the secondary one: their corners.
    reversed: Option<Corners>,
    tools: Mutex<Tools>,
}

/// Memory that searches reuse; results do not depend on its content.
#[derive(Debug)]
pub(super) struct Tools {
    pub(super) paths: Paths,
    pub(super) apart: Apart,
    pub(super) recent: Recent<[f64; 2]>,
    pub(super) swept: SweptPatch,
}

impl NodeToPatch {
    /// Contact of secondary nodes with a primary boundary, in global node numbers.
    pub fn new(secondary: Vec<usize>, primary: Boundary) -> Self {
        let hull = Hull::facet(primary.shape());
        let apart = Apart::new(primary.nodes().iter().chain(&secondary).copied(), 3, hull.weight());
        let recent = Recent::new(apart.nodes().to_vec(), 3, hull.weight(), secondary.len());
        let swept = SweptPatch::new(primary.shape());
        let tools = Mutex::new(Tools { paths: Paths::default(), apart, recent, swept });
        Self {
            secondary,
            primary,
            hull,
            allowed: Vec::new(),
            kept: Vec::new(),
            folds: None,
            own: None,
            at_joints: AtJoints::default(),
            reversed: None,
            tools,
        }
    }

    /// Contact in which each node may have a depth without contact; its gap is larger by that
    /// depth.
    #[must_use]
    pub fn with_allowed(self, allowed: Vec<f64>) -> Self {
        Self { allowed, ..self }
    }

    /// Contact with another rule for nodes over joints.
    #[must_use]
    pub fn with_joints(self, at_joints: AtJoints) -> Self {
        Self { at_joints, ..self }
    }

    /// Contact of nodes that belong to a body with the boundary `own`.
    #[must_use]
    pub fn of_body(self, own: Boundary) -> Self {
        Self { own: Some(own), ..self }
    }

    /// A test whether a node can press on a facet, rather than on one beside it (`opposed.rs`),
    /// given the middles of all facets.
    pub(super) fn may_press<'a>(
        &'a self,
        node: usize,
        y: &'a [f64],
        middle: impl Fn(usize) -> PatchPoint + 'a,
    ) -> impl Fn(usize) -> bool + 'a {
        let around = self.own.as_ref().map(|own| own.normals_at(node, y));
        move |facet| {
            let Some(around) = &around else { return true };
            let here = middle(facet);
            let height = (place(y, node) - here.position).dot(&here.normal);
            let sized = |other: usize| (middle(other).normal, self.primary.patch(other).length(y));
            !is_left(&around.iter().copied(), here.normal, height, || {
                self.primary.bent_away(facet, y).map(sized)
            })
        }
    }

    /// Keeps those of the facets near a node on which it can press at the start of a step.
    pub(super) fn retain_pressed(&self, node: usize, before: &[f64], paths: &Paths, near: &mut Vec<usize>) {
        if !near.is_empty() {
            let may_press = self.may_press(node, before, |facet| paths.middle(facet));
            near.retain(|&facet| !self.primary.is_mirror(facet) && may_press(facet));
        }
    }

    /// Contact of nodes of the primary side with the secondary one (`../reversed.rs`), once the
    /// body of the nodes and their depths are known.
    #[must_use]
    pub fn reversed(self) -> Self {
        let corners = self
            .own
            .as_ref()
            .map(|own| Corners::new(own, &self.secondary, |place| self.allowed(place), NEAR_END_SPACE));
        Self { reversed: Some(corners.unwrap_or_default()), ..self }
    }

    /// Whether the pair of a corner of the primary side is left to a node of its facet.
    fn is_left_to_node(&self, pair: &Pair, y: &[f64]) -> bool {
        let (Some(corners), Some(own)) = (&self.reversed, &self.own) else { return false };
        let node = self.secondary[pair.node];
        let at = OnFacet { facet: pair.facet, xi: [pair.xi, pair.eta] };
        let corner = Faced { place: pair.node, node, at };
        corners.is_left_to_node(corner, [own, &self.primary], y)
    }

    /// Contact of nodes of the primary side with that side itself.
    pub(super) fn folding(self, folds: Arc<PatchFolds>, side: Side) -> Self {
        Self { folds: Some((folds, side)), ..self }
    }

    /// An inactive pair at a point of a facet, with the joint over which it lies.
    fn opened(&self, node: usize, at: OnFacet<[f64; 2]>, y: &[f64]) -> Pair {
        let pair = Pair::opened(node, at);
        Pair { joint: self.joint_of(&pair, y), ..pair }
    }

    pub(super) fn slack(&self, place: usize) -> f64 {
        self.allowed(place) + self.kept(place)
    }

    /// Where facets are near nodes, with a margin relative to their size.
    fn around(&self, margin: f64) -> Around {
        let distance = (0..self.secondary.len()).map(|place| self.slack(place).abs()).fold(0.0, f64::max);
        Around { margin, distance }
    }

    pub(super) fn gap(&self, facet: usize, xi: [f64; 2], from: Vector<3>, y: &[f64]) -> f64 {
        let at = self.primary.patch(facet).seen_from(from, y, xi);
        -at.position.dot(&at.normal)
    }

    /// The point nearest to a secondary node of the facets that it faces and can press on, and the
    /// gap there.
    fn faced(&self, node: usize, y: &[f64]) -> Option<(OnFacet<[f64; 2]>, f64)> {
        let node = self.secondary[node];
        let from = place(y, node);
        let may_press = self.may_press(node, y, |facet| self.primary.middle(facet, y));
        (0..self.primary.facets())
            .filter_map(|facet| {
                let xi = self.primary.patch(facet).closest_point(y, from, PAST_END)?;
                let faced = (OnFacet { facet, xi }, self.gap(facet, xi, from, y));
                may_press(facet).then_some(faced)
            })
            .min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
    }

    /// Whether ξ lies past an edge of a facet at which no blunt joint with another facet of the
    /// side follows.
    pub(super) fn faces_nothing(&self, facet: usize, xi: [f64; 2], y: &[f64]) -> bool {
        self.is_past_end(facet, xi, PAST_END, y)
    }

    /// Whether ξ lies, by more than a tolerance, past an edge of a facet at which no blunt joint
    /// with another facet of the side follows, or past the end of the facets around it.
    pub(super) fn is_past_end(&self, facet: usize, xi: [f64; 2], tolerance: f64, y: &[f64]) -> bool {
        let patch = self.primary.patch(facet);
        let mut past =
            (0..patch.corners()).zip(patch.beyond(xi)).filter(|(_, beyond)| *beyond > ROUND_OFF).peekable();
        past.peek().is_some()
            && (past.any(|(edge, beyond)| {
                let is_within = beyond <= tolerance && !self.primary.meets_sibling(facet, edge);
                !is_within && self.primary.is_end(facet, edge, y)
            }) || self.primary.is_past_rim(facet, patch.at(y, xi).position, tolerance, y))
    }

    /// Whether a node whose closest point on a facet is on an edge may have a pair with it: just
    /// past the rim, where the facet continues the pair's own one, or over a joint, along which
    /// it slides from one facet to the next.
    fn lies_on_edge(&self, own: usize, facet: usize, edge: usize, from: Vector<3>, y: &[f64]) -> bool {
        let patch = self.primary.patch(facet);
        let is_beside = self.primary.is_rim(facet, edge, y)
            && self.primary.is_smooth(own, facet, y)
            && patch.closest_point(y, from, PAST_END).is_some();
        is_beside || self.is_blunt(facet, (patch.corners() + edge) as u8, y)
    }

    /// Facet to which a pair whose closest point lies past an edge of its facet is handed over.
    fn next_facet(&self, pair: &Pair, came_from: Option<usize>, y: &[f64]) -> Next {
        let xi = [pair.xi, pair.eta];
        let patch = self.primary.patch(pair.facet);
        // A pair with all facets of a joint slides on any of them, but not past their other edges.
        let corners = patch.corners();
        let is_of_joint = |edge: usize| {
            pair.joint.map(usize::from).is_some_and(|joint| match joint.checked_sub(corners) {
                Some(own) => edge == own,
                None => edge == joint || (edge + 1) % corners == joint,
            })
        };
        let tolerance = |edge: usize| if is_of_joint(edge) { PAST_END } else { ROUND_OFF };
        if (0..corners).zip(patch.beyond(xi)).all(|(edge, beyond)| beyond <= tolerance(edge)) {
            return Next::Stay;
        }
        let node = self.secondary[pair.node];
        if self.ends_at(node, pair.facet, xi, y) {
            return Next::Leave;
        }
        let from = place(y, node);
        let own = patch.nearest(y, from);
        let is_across =
            |facet: usize| (0..corners).any(|edge| self.primary.across(pair.facet, edge) == Some(facet));
        let mut best: Option<(usize, f64, [f64; 2])> = None;
        for &facet in self.primary.ring(pair.facet) {
            if self.primary.is_mirror(facet) || !self.may_take(node, facet, y) {
                continue;
            }
            let found = self.primary.patch(facet).nearest(y, from);
            // Two may be as near as each other, as beside a corner over an edge. The one across an
            // own edge is taken: the pairs of a node on both sides of the edge go on side by side.
            let least = best.map_or((1.0 - ROUND_OFF) * own.distance, |(known, least, _)| {
                let leads = f64::from(i8::from(is_across(facet)) - i8::from(is_across(known)));
                (1.0 + leads * ROUND_OFF) * least
            });
            let lies_on = || match found.at {
                Feature::Inside => true,
                Feature::Edge(edge) => self.lies_on_edge(pair.facet, facet, edge, from, y),
                Feature::Corner(_) => false,
            };
            if found.distance < least && lies_on() {
                best = Some((facet, found.distance, found.xi));
            }
        }
        let adds_up = |facet: usize| !self.at_joints.several && self.primary.is_smooth(pair.facet, facet, y);
        match best {
            Some((facet, ..))
                if !self.primary.is_of_side(facet)
                    || self.primary.bent_away(pair.facet, y).any(|bent| bent == facet) =>
            {
                if self.faces_nothing(pair.facet, xi, y) { Next::Leave } else { Next::Stay }
            }
            Some((facet, _, xi_there)) if came_from == Some(facet) => {
                let gaps = [(pair.facet, xi), (facet, xi_there)].map(|(f, xi)| self.gap(f, xi, from, y));
                let is_flat = (gaps[0] - gaps[1]).abs() <= ROUND_OFF * patch.length(y);
                if is_flat && patch.furthest(xi) <= PAST_END || adds_up(facet) {
                    Next::Stay
                } else {
                    Next::Concave(facet, xi_there)
                }
            }
            Some((facet, _, xi)) => Next::HandOver(facet, xi),
            None => {
                if let Some(OnFacet { facet, xi }) = self.in_crease(pair, y)
                    && !adds_up(facet)
                {
                    return Next::Concave(facet, xi);
                }
                let bridged = patch.furthest(xi) <= EXTENDED && !self.faces_nothing(pair.facet, xi, y);
                if bridged { Next::Stay } else { Next::Leave }
            }
        }
    }

    /// Hands over, adds or drops pairs past the edges of their facets. Returns whether anything but
    /// an inactive pair changed.
    fn slide(&self, [before, now]: [&[f64]; 2], pairing: &mut Pairing, events: &mut Vec<PairEvent>) -> bool {
        let depth = |place_of: usize, facet: usize, xi: [f64; 2]| {
            -self.gap(facet, xi, place(now, self.secondary[place_of]), now) - self.slack(place_of)
        };
        let next = |pair: &Pair, came_from| {
            let at = OnFacet { facet: pair.facet, xi: [pair.xi, pair.eta] };
            let is_left = |y| self.is_left_to_edge(self.secondary[pair.node], at, y);
            if !pair.active && is_left(before) && is_left(now) {
                return Next::Leave;
            }
            self.next_facet(pair, came_from, now)
        };
        let sliding = Sliding { nodes: &self.secondary, facets: self.primary.facets(), next };
        let held = Held::all(&pairing.pairs);
        let is_past = |pair: &Pair| self.beyond(pair) > PAST_END;
        let is_near = |pair: &Pair| self.beyond(pair) <= EXTENDED;
        let size = |facet: usize| self.primary.patch(facet).length(now);
        let measured = Measured { is_past: &is_past, is_near: &is_near, depth: &depth, size: &size };
        sliding.search(pairing, held, &measured, events)
    }

    /// Adds a pair for every node that may have reached a facet, and for nodes with pairs that
    /// enter the side elsewhere. Returns whether one of them penetrates. `repeats`: whether what
    /// the last search found still holds; `separation`: the gap beyond which a candidate stays
    /// open.
    fn find_pairs(
        &self,
        tools: &mut Tools,
        pairs: &mut Vec<Pair>,
        [before, now]: [&[f64]; 2],
        repeats: bool,
        separation: f64,
    ) -> bool {
        let Tools { paths, recent, swept, .. } = tools;
        let mut changed = false;
        let known = pairs.len();
        let mut next = 0;
        let mut near = Vec::new();
        for (k, &node) in self.secondary.iter().enumerate() {
            let first = next;
            while next < known && pairs[next].node == k {
                next += 1;
            }
            let held = &pairs[first..next];
            if held.is_empty()
                && repeats
                && let Some(candidate) = recent.get(k)
            {
                pairs.extend(candidate.map(|at| self.opened(k, at, now)));
                continue;
            }
            paths.find_into(node, [before, now], &mut near);
            self.retain_met(node, paths, &mut near);
            if !held.is_empty() {
                if let Some(at) = self.elsewhere(swept, &mut near, paths, k, held, [before, now]) {
                    changed = true;
                    pairs.push(Pair::opened(k, at));
                }
                continue;
            }
            let candidate = self.candidate(swept, &mut near, paths, k, before, now);
            let gap = candidate.map_or(f64::INFINITY, |OnFacet { facet, xi }| {
                self.gap(facet, xi, place(now, node), now) + self.slack(k)
            });
            let candidate = candidate.filter(|_| self.allowed(k) == 0.0 || gap < 0.0);
            if candidate.is_none() || gap > separation {
                recent.set(k, candidate);
            }
            changed |= gap < 0.0;
            pairs.extend(candidate.map(|at| self.opened(k, at, now)));
        }
        changed
    }

    /// How far a pair is past an edge of its facet, over the height of the facet.
    fn beyond(&self, pair: &Pair) -> f64 {
        self.primary.patch(pair.facet).furthest([pair.xi, pair.eta])
    }
}

impl Kinematics for NodeToPatch {
    fn secondary(&self) -> &[usize] {
        &self.secondary
    }

    fn allowed(&self, node: usize) -> f64 {
        self.allowed.get(node).copied().unwrap_or(0.0)
    }

    fn keep(&mut self, depths: &[f64]) {
        self.kept = depths.to_vec();
    }

    fn kept(&self, node: usize) -> f64 {
        self.kept.get(node).copied().unwrap_or(0.0)
    }

    fn facet_nodes(&self, pair: &Pair) -> &[usize] {
        self.primary.nodes_of(pair.facet)
    }

    fn is_on_facet(&self, pair: &Pair) -> bool {
        self.primary.patch(pair.facet).furthest([pair.xi, pair.eta]) <= ON_FACET
    }

    fn facets(&self, _: usize) -> usize {
        self.primary.facets()
    }

    fn signed_distance(&self, node: usize, y: &[f64]) -> Option<f64> {
        let (_, gap) = self.faced(node, y)?;
        Some(gap + self.kept(node))
    }

    fn is_left(&self, node: usize, y: &[f64]) -> bool {
        let faced = self.faced(node, y);
        faced.is_some_and(|(at, _)| self.is_left_to_edge(self.secondary[node], at, y))
    }

    fn roundings(&self, y: &[f64]) -> Vec<f64> {
        if self.folds.is_some() || self.primary.shape().degree() != 1 {
            return Vec::new();
        }
        let rounding = |node: usize| {
            let (OnFacet { facet, xi }, _) = self.faced(node, y)?;
            Some(rounding(&self.primary, facet, xi, y))
        };
        (0..self.secondary.len()).map(|node| rounding(node).unwrap_or(0.0)).collect()
    }

    fn search(
        &self,
        before: &[f64],
        now: &[f64],
        pairing: &mut Pairing,
        events: &mut Vec<PairEvent>,
    ) -> bool {
        let starts = pairing.fresh;
        let mut left = if starts {
            // A pair over a joint does not slide to another facet of it.
            self.start_joints(&mut pairing.pairs, before);
            Vec::new()
        } else {
            self.leave_joints(&mut pairing.pairs, now)
        };
        let on_joints = |pairs: &[Pair]| -> Vec<usize> {
            pairs.iter().filter(|pair| pair.joint.is_some()).map(|pair| pair.node).collect()
        };
        let known = on_joints(&pairing.pairs);
        let has_slid = self.slide([before, now], pairing, events);
        // A node that slides along an edge goes on along the next one.
        let kept = on_joints(&pairing.pairs);
        left.extend(known.into_iter().filter(|node| !kept.contains(node)));
        let slid = has_slid | self.take_joints(&mut pairing.pairs, &left, now);
        if starts {
            self.start_joints(&mut pairing.pairs, before);
        }
        let Pairing { pairs, margin, .. } = pairing;
        let mut tools = self.tools.lock().unwrap_or_else(PoisonError::into_inner);
        let Tools { paths, apart, recent, .. } = &mut *tools;
        if starts {
            recent.forget();
        }
        if apart.holds(*margin, [before, now]) {
            return slid;
        }
        let separation = MEETS * self.primary.shortest(before);
        let repeats = recent.repeats(*margin, [before, now], separation);
        if !repeats {
            recent.begin(*margin, [before, now]);
            paths.update(&self.primary, &self.hull, self.around(*margin), [before, now]);
            let own = self.secondary.iter().map(|&node| paths.path(node, [before, now]));
            let nodes = own.fold(Bounds::EMPTY, |all, path| all.union(&path));
            let boxes = [&paths.tree().bounds(), &nodes.grown(ROUND_OFF * nodes.size())];
            apart.searched(boxes, [*margin, ROUND_OFF], now);
        }
        let found = self.find_pairs(&mut tools, pairs, [before, now], repeats, separation);
        in_order(pairs);
        slid || found
    }

    fn met(&self, nodes: &[usize], before: &[f64], now: &[f64]) -> Vec<Option<f64>> {
        let mut tools = self.tools.lock().unwrap_or_else(PoisonError::into_inner);
        let Tools { paths, recent, swept, .. } = &mut *tools;
        recent.forget();
        let around = self.around(Pairing::default().margin);
        paths.update(&self.primary, &self.hull, around, [before, now]);
        let mut near = Vec::new();
        let mut met = |&k: &usize| {
            let node = self.secondary[k];
            paths.find_into(node, [before, now], &mut near);
            self.retain_met(node, paths, &mut near);
            self.retain_pressed(node, before, paths, &mut near);
            let first = self.first(swept, &near, paths, node, before, now);
            let first = first.filter(|first| self.is_met(node, first.facet, paths))?;
            (self.slack(k) == 0.0).then(|| first.theta.clamp(0.0, 1.0))
        };
        nodes.iter().map(&mut met).collect()
    }

    fn passed(&self, before: &[f64], now: &[f64], bounce: f64) -> Option<Passed> {
        let mut tools = self.tools.lock().unwrap_or_else(PoisonError::into_inner);
        self.deepest(&mut tools, [before, now], bounce)
    }

    fn update_facets(&self, now: &[f64], pairing: &mut Pairing, events: &mut Vec<PairEvent>) -> bool {
        let is_near = |pair: &Pair, came: bool| self.beyond(pair) <= if came { HAND_BACK } else { PAST_END };
        let next = |pair: &Pair, previous| self.next_facet(pair, previous, now);
        let sliding = Sliding { nodes: &self.secondary, facets: self.primary.facets(), next };
        sliding.update(pairing, is_near, events)
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
