//! Convex corners and round parts of a rigid obstacle against the facets of a deformable side in
//! the plane, between whose nodes they lie. The centre c of a part with the radius r ≥ 0 is a point
//! of the obstacle, a constant combination of the carrying nodes (`carrier.rs`),
//!
//! ```text
//! c = Σ w_a y_a        g = distance of c from the facet − r        ∂g/∂y = (−φᵏ n; w_a n)
//! ```
//!
//! and the gap is that of a node at c (`gap.rs`). The slip is that of the point of the facet
//! closest to c relative to the point p of the obstacle at the same place, which has other weights,
//! those of p: its rows (−φᵏ t; w_a(p) t) have no part in a rigid motion of both. With ξ' = ∂ξ/∂y,
//! t' = n ⊗ D, D = ((φᵏ)' n + κ ξ')/J, and γ = −(−φᵏ; w_a),
//!
//! ```text
//! ∂(−φᵏ t) = −t (φᵏ)' ξ' − φᵏ n D        ∂(w_a t) = t (Ω_a γ + J (Ω_a·t) ξ') + w_a n D
//! ```
//!
//! The nodes of the side are held by the obstacle themselves (`node_to_obstacle.rs`). A wide circle
//! is held by the nodes that lie on it, up to h²/8r, the height of its arc over a chord of length
//! h. Rows of the chords would constrain a body twice there, and a curved facet that follows the
//! circle has no unique point closest to its centre. A narrow one passes between the nodes, or
//! slides over them as over the teeth of a comb. A part has a row where r < h, so that contact is
//! hardly wider than a facet; elsewhere h²/8r ≤ h/8. Where it meets a node, it is left to that node
//! if the rows of both would be the same. Over a joint of facets its row is the mean of theirs, as
//! that of a node (`joint.rs`), but with friction: the slip is that on one facet.

use carom_algebra::Vector;

use super::carrier::{Carrier, Local};
use super::joint::OnFacets;
use super::node_to_facet::{Detection, NodeToFacet};
use super::node_to_obstacle::NodeToObstacle;
use super::obstacle::{Point, Tip, dot};
use super::passed::Passed;
use super::surface::Surface;
use super::{BetweenNodes, Facets, Kinematics};
use crate::constants::{FOLLOWS, NEAR_END, PARALLEL, SAME_NORMAL};
use crate::pair::{ContactError, Pair, PairEvent, Pairing, in_order};
use crate::places::Places;
use crate::rows::Rows;

impl Tip {
    /// Whether the part can lie between the nodes of a facet of this length.
    fn is_narrow(&self, length: f64) -> bool {
        self.size < length
    }

    /// Depth to which nodes alone hold the part outside of a facet of this length; zero if they do
    /// not hold it.
    pub fn permitted(&self, length: f64) -> f64 {
        if self.is_narrow(length) { 0.0 } else { 0.125 * length }
    }
}

/// Convex parts of a rigid obstacle against facets.
#[derive(Debug)]
pub struct TipToFacet {
    /// The convex parts in the coordinates of the obstacle.
    tips: Vec<Tip>,
    carrier: Option<Carrier>,
    /// Number of the nodes, after which the centres of the parts are numbered.
    nodes: usize,
    /// The node nearest to each part in the reference configuration.
    names: Vec<usize>,
    side: Surface,
    /// The centres as nodes against the facets.
    centers: NodeToFacet,
    /// Whether a part is left to a node that it meets.
    leaves: bool,
    /// Whether a part over a joint has one facet.
    single: bool,
}

impl TipToFacet {
    /// Contact of the convex parts of an obstacle with a side; `reference`: the reference
    /// positions, flat over all nodes.
    pub fn new(obstacle: &NodeToObstacle, side: Surface, reference: &[f64]) -> Self {
        let tips = obstacle.tips.clone();
        let nodes = reference.len() / 2;
        let nearest = |tip: &Tip| {
            let square =
                |node: &usize| (0..2).map(|i| (reference[2 * node + i] - tip.center[i]).powi(2)).sum();
            let distance = |node: &&usize| -> f64 { square(node) };
            let secondary = obstacle.secondary().iter();
            secondary.min_by(|a, b| distance(a).total_cmp(&distance(b))).copied().unwrap_or(0)
        };
        let names = obstacle.tips(reference).iter().map(nearest).collect();
        let numbers = (nodes..nodes + tips.len()).collect();
        let centers = NodeToFacet::new(numbers, side.clone(), Detection::ClosestPoint)
            .with_radii(tips.iter().map(|tip| tip.radius).collect());
        Self {
            tips,
            carrier: obstacle.carrier.clone(),
            nodes,
            names,
            side,
            centers,
            leaves: true,
            single: false,
        }
    }

    /// Contact in which no part is left to a node that it meets: by springs, whose rows may depend
    /// on each other, and after which that of the part would begin with a depth; and beside a
    /// mortar, which has no rows of nodes.
    #[must_use]
    pub fn not_left_to_nodes(self) -> Self {
        Self { leaves: false, ..self }
    }

    /// Contact in which a part over a joint has a pair with one facet.
    #[must_use]
    pub fn with_single_facets(self) -> Self {
        Self { single: true, ..self }
    }

    /// Positions of the nodes, then of the centres.
    fn with_centers(&self, y: &[f64]) -> Vec<f64> {
        let mut all = y[..2 * self.nodes].to_vec();
        for tip in &self.tips {
            let carrier = self.carrier.as_ref();
            let center = carrier.map_or(tip.center, |carrier| carrier.placed(tip.center, y, 2));
            all.extend_from_slice(&center[..2]);
        }
        all
    }

    /// The carrying nodes.
    fn carriers(&self) -> &[usize] {
        self.carrier.as_ref().map_or(&[], |carrier| &carrier.nodes)
    }

    /// Weights of the carrying nodes in the centre of a part.
    fn weights(&self, tip: usize) -> Vec<f64> {
        let weights = |carrier: &Carrier| carrier.weights(self.tips[tip].center).collect();
        self.carrier.as_ref().map_or_else(Vec::new, weights)
    }

    /// The point of the obstacle at a place.
    fn local(&self, place: Point, y: &[f64]) -> Local {
        self.carrier.as_ref().map_or(Local::fixed(place), |carrier| carrier.local(place, y, 2))
    }

    /// Whether a part faces the facet of a pair and is not left to its nodes.
    fn acts(&self, pair: &Pair, y: &[f64]) -> bool {
        let tip = &self.tips[pair.node];
        let places = Places::new(y, 2);
        let center = places.at(self.nodes + pair.node);
        let gap = self.centers.gap_of(pair, places);
        let foot = gap.at;
        let length = self.side.length(pair.facet, places);
        if !tip.is_narrow(length) || gap.a < FOLLOWS * foot.measure * foot.measure {
            return false;
        }
        let along = foot.tangent * foot.measure.recip();
        let near = NEAR_END * length;
        let meets = |&node: &usize| (places.at(node) - center - foot.position).dot(&along).abs() < near;
        let meets_node = self.leaves && self.side.nodes_of(pair.facet).iter().any(meets);
        match self.faces(pair.node, center, foot.normal, y) {
            None => false,
            Some(is_parallel) => !(meets_node && (is_parallel || tip.radius > 0.0 || tip.normals.is_none())),
        }
    }

    /// Whether a part with this centre can press on a facet with this outward normal, and one of
    /// the pieces beside it is parallel to the facet; none if it cannot.
    fn faces(&self, tip: usize, center: Vector<2>, outward: Vector<2>, y: &[f64]) -> Option<bool> {
        let Some([first, last]) = self.tips[tip].normals else { return Some(false) };
        let normal = self.local([center[0], center[1], 0.0], y).back([-outward[0], -outward[1], 0.0]);
        let cross = |a: Point, b: Point| a[0] * b[1] - a[1] * b[0];
        let is_along = |own: Point| dot(own, normal) > PARALLEL.cosine * dot(normal, normal).sqrt();
        let is_parallel = is_along(first) || is_along(last);
        let is_between = cross(first, normal) >= 0.0 && cross(normal, last) >= 0.0;
        let faces = is_parallel || is_between && dot(first, normal) + dot(last, normal) > 0.0;
        faces.then_some(is_parallel)
    }

    /// The facet of the whole boundary that is nearest to a part with this centre, among those on
    /// which it can press, if there are any.
    fn nearest(&self, tip: usize, center: Vector<2>, y: &[f64]) -> Option<usize> {
        let faces = |facet: &usize| {
            let outward = self.side.facet(*facet).at(Places::new(y, 2), 0.0).normal;
            self.faces(tip, center, outward, y).is_some()
        };
        self.closest(center, y, faces).or_else(|| self.closest(center, y, |_| true))
    }

    /// The nearest facet of the whole boundary to a point, of those asked for.
    fn closest(&self, center: Vector<2>, y: &[f64], counts: impl Fn(&usize) -> bool) -> Option<usize> {
        let distance = |facet: &usize| self.side.distance(*facet, center, y);
        (0..self.side.all()).filter(counts).min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    /// Adds the pairs of parts that keep a depth and have none: nearer to the end of the side than
    /// they are deep, they seem to have entered the body there.
    fn find_kept(&self, y: &[f64], pairs: &mut Vec<Pair>) {
        let places = Places::new(y, 2);
        for tip in (0..self.tips.len()).filter(|&tip| self.centers.kept(tip) > 0.0) {
            if pairs.iter().any(|pair| pair.node == tip) {
                continue;
            }
            let center = places.at(self.nodes + tip);
            let faced = self.nearest(tip, center, y).filter(|&facet| self.side.is_of_side(facet));
            let at = |facet: usize| Some((facet, self.side.facet(facet).closest_point(places, center, 1.0)?));
            pairs.extend(faced.and_then(at).map(|(facet, xi)| Pair::open(tip, facet, xi)));
        }
    }

    /// Adds pairs of a round part with the facets next to that of a pair that it penetrates too:
    /// near a concave joint it touches both before its centre faces the joint.
    fn beside(&self, pair: &Pair, y: &[f64], known: &[Pair], found: &mut Vec<Pair>) {
        let places = Places::new(y, 2);
        let center = places.at(self.nodes + pair.node);
        let own = self.centers.gap_of(pair, places).at.normal;
        for facet in
            [false, true].into_iter().filter_map(|ahead| self.side.neighbour_of_side(pair.facet, ahead))
        {
            let is_same = |other: &Pair| other.node == pair.node && other.facet == facet;
            let Some(xi) = self.side.facet(facet).closest_point(places, center, 1.0) else { continue };
            let other = Pair::open(pair.node, facet, xi);
            let gap = self.centers.gap_of(&other, places);
            let turns = gap.at.normal.dot(&own) < SAME_NORMAL.cosine;
            let enters = turns && gap.distance > 0.0 && gap.distance + self.centers.slack(pair.node) < 0.0;
            if enters && !known.iter().chain(found.iter()).any(is_same) && self.acts(&other, y) {
                found.push(other);
            }
        }
    }

    /// Adds a row over the nodes of a facet and the carrying nodes, whose gradients are multiples
    /// of one vector.
    fn push(
        &self,
        gap: f64,
        facet: &[usize],
        slopes: impl Iterator<Item = [f64; 2]>,
        [of_carrier, weights]: [&[f64]; 2],
        rows: &mut Rows,
    ) {
        let carried = weights.iter().map(|weight| [weight * of_carrier[0], weight * of_carrier[1]]);
        let nodes = facet.iter().chain(self.carriers()).copied();
        rows.push(gap, nodes.zip(slopes.chain(carried)));
        rows.begin_with_edge(facet.len());
    }

    /// An error with the name of the part.
    fn lost(&self, pair: &Pair) -> ContactError {
        ContactError::Tip { node: self.names[pair.node], facet: pair.facet, xi: pair.xi }
    }

    /// The name of a part in the place of the number of its centre.
    fn name(&self, center: usize) -> usize {
        self.names[center - self.nodes]
    }

    /// Applies a function to events, and replaces the centres in them by the parts' names.
    fn named<T>(&self, events: &mut Vec<PairEvent>, of: impl FnOnce(&mut Vec<PairEvent>) -> T) -> T {
        let first = events.len();
        let result = of(events);
        for event in &mut events[first..] {
            match event {
                PairEvent::HandOver { node, .. } | PairEvent::SlidOff { node, .. } => {
                    *node = self.name(*node);
                }
            }
        }
        result
    }
}

impl Kinematics for TipToFacet {
    fn secondary(&self) -> &[usize] {
        &self.names
    }

    fn nodes(&self) -> usize {
        0
    }

    fn keep(&mut self, depths: &[f64]) {
        self.centers.keep(depths);
    }

    fn kept(&self, tip: usize) -> f64 {
        self.centers.kept(tip)
    }

    fn facet_nodes(&self, _: &Pair) -> &[usize] {
        &[]
    }

    fn between_nodes(&self, pair: &Pair) -> Option<BetweenNodes<'_>> {
        Some(BetweenNodes::on_line(self.side.nodes_of(pair.facet), pair.xi))
    }

    /// A part of an obstacle is held from the depth on that it has at the start.
    fn keeps_depth(&self, _: &Pair) -> bool {
        false
    }

    fn facets(&self, _: usize) -> usize {
        self.side.facets()
    }

    /// Signed distance to the body, and of a part that reaches into it to those facets of the whole
    /// boundary, of which the side is a part, on which it can press; infinite where the nodes of
    /// the nearest facet hold the part.
    fn signed_distance(&self, tip: usize, y: &[f64]) -> Option<f64> {
        let all = self.with_centers(y);
        let center = Places::new(&all, 2).at(self.nodes + tip);
        let nearest = self.nearest(tip, center, y)?;
        if !self.tips[tip].is_narrow(self.side.length(nearest, Places::new(y, 2))) {
            return Some(f64::INFINITY);
        }
        let distance = |facet: usize| self.side.depth(facet, center, y).distance - self.tips[tip].radius;
        // Outside, the facets on which it can press may be those on the far side.
        let outside = self.closest(center, y, |_| true).map(distance).filter(|distance| *distance > 0.0);
        Some(outside.unwrap_or_else(|| distance(nearest)) + self.kept(tip))
    }

    fn search(
        &self,
        before: &[f64],
        now: &[f64],
        pairing: &mut Pairing,
        events: &mut Vec<PairEvent>,
    ) -> bool {
        let [before, now] = [before, now].map(|y| self.with_centers(y));
        let changed = self.named(events, |events| self.centers.search(&before, &now, pairing, events));
        pairing.pairs.iter_mut().filter(|_| self.single).for_each(|pair| pair.joint = None);
        let known = pairing.pairs.len();
        let mut beside = Vec::new();
        pairing.pairs.iter().for_each(|pair| self.beside(pair, &now, &pairing.pairs, &mut beside));
        pairing.pairs.append(&mut beside);
        let penetrates = pairing.pairs.len() > known;
        self.find_kept(&now, &mut pairing.pairs);
        in_order(&mut pairing.pairs);
        changed || penetrates
    }

    fn passed(&self, before: &[f64], now: &[f64], bounce: f64) -> Option<Passed> {
        let [before, now] = [before, now].map(|y| self.with_centers(y));
        let passed = self.centers.passed(&before, &now, bounce)?;
        Some(Passed { what: "the rigid obstacle near node", node: self.name(passed.node), ..passed })
    }

    fn met(&self, tips: &[usize], _: &[f64], _: &[f64]) -> Vec<Option<f64>> {
        vec![None; tips.len()]
    }

    fn update_facets(&self, now: &[f64], pairing: &mut Pairing, events: &mut Vec<PairEvent>) -> bool {
        let now = self.with_centers(now);
        self.named(events, |events| self.centers.update_facets(&now, pairing, events))
    }

    fn measure(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let all = self.with_centers(y);
        let mut of_center = Rows::new(2);
        if self.centers.measure(pair, &all, &mut of_center).is_err() {
            if pair.active {
                return Err(self.lost(pair));
            }
            of_center.push_open();
        }
        let row = of_center.row(0);
        if row.nodes.is_empty() || !pair.active && !self.acts(pair, &all) {
            rows.push_open();
            return Ok(());
        }
        let (center, facet) = row.gradient.split_at(2);
        let facet = facet.as_chunks::<2>().0.iter().copied();
        self.push(row.gap, &row.nodes[1..], facet, [center, &self.weights(pair.node)], rows);
        Ok(())
    }

    fn curvature_into(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]) {
        let all = self.with_centers(y);
        let facets = self.centers.parts(pair, &all).map(|part| part.facet);
        let mut nodes: Vec<usize> = Vec::new();
        for &node in facets.flat_map(|facet| self.side.nodes_of(facet)) {
            if !nodes.contains(&node) {
                nodes.push(node);
            }
        }
        let count = nodes.len();
        let own = 2 * (1 + count);
        let mut of_center = vec![0.0; own * own];
        self.centers.curvature_into(pair, &all, &mut of_center);
        // Every node moves one of the nodes of the gap, with a weight: that of the facet or the
        // centre.
        let facet = (1..=count).map(|node| (node, 1.0));
        let nodes: Vec<(usize, f64)> =
            facet.chain(self.weights(pair.node).into_iter().map(|weight| (0, weight))).collect();
        let size = 2 * nodes.len();
        for (row, values) in curvature[..size * size].chunks_exact_mut(size).enumerate() {
            for (column, value) in values.iter_mut().enumerate() {
                let (k, left) = nodes[row / 2];
                let (l, right) = nodes[column / 2];
                *value = left * right * of_center[(2 * k + row % 2) * own + 2 * l + column % 2];
            }
        }
    }

    fn slip(&self, pair: &Pair, y: &[f64], _: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let at = self.sliding(pair, y);
        if at.a <= 0.0 || !at.a.is_finite() {
            return Err(self.lost(pair));
        }
        let count = at.facet;
        let slopes = at.values[..count].iter().map(|value| [value * at.tangent[0], value * at.tangent[1]]);
        let facet = self.side.nodes_of(pair.facet);
        self.push(0.0, facet, slopes, [&at.tangent[..2], &at.values[count..]], rows);
        Ok(())
    }

    fn slip_derivative_into(&self, pair: &Pair, y: &[f64], _: &[f64], _: usize, matrix: &mut [f64]) {
        let at = self.sliding(pair, y);
        let size = 2 * at.values.len();
        for (row, values) in matrix[..size * size].chunks_exact_mut(size).enumerate() {
            for (column, value) in values.iter_mut().enumerate() {
                let [k, i] = [row / 2, row % 2];
                let [l, j] = [column / 2, column % 2];
                let changed = at.slopes[k] * at.moved[l][j] - at.gradients[k][j] * at.values[l];
                *value = at.tangent[i] * changed + at.values[k] * at.normal[i] * at.turned[l][j];
            }
        }
    }
}

/// The slip of a part on a facet: over the nodes of the facet, then the carrying nodes.
struct Sliding {
    /// Number of the nodes of the facet.
    facet: usize,
    tangent: Point,
    normal: Point,
    /// Second derivative of half the squared distance by ξ.
    a: f64,
    /// Factors −φᵏ and w_a of the tangent in the row.
    values: Vec<f64>,
    /// Derivatives −(φᵏ)' and J Ω_a·t of the factors by ξ.
    slopes: Vec<f64>,
    /// Spatial gradients Ω of the factors: zero, and those of the weights.
    gradients: Vec<Point>,
    /// Derivatives ξ' of ξ by the positions.
    moved: Vec<[f64; 2]>,
    /// Derivatives D of the angle of the tangent by the positions.
    turned: Vec<[f64; 2]>,
}

impl TipToFacet {
    fn sliding(&self, pair: &Pair, y: &[f64]) -> Sliding {
        let all = self.with_centers(y);
        let places = Places::new(&all, 2);
        let gap = self.centers.gap_of(pair, places);
        let count = self.side.nodes_of(pair.facet).len();
        let measure = gap.at.measure;
        let along = gap.at.tangent * measure.recip();
        let [tangent, normal] = [along, gap.at.normal].map(|v| [v[0], v[1], 0.0]);
        let foot = places.at(self.nodes + pair.node) + gap.at.position;
        let local = self.local([foot[0], foot[1], 0.0], y);
        let carriers = self.carriers().len();
        let [shape, first] = [gap.shape.values, gap.shape.first];
        let weights = local.weights[..carriers].iter().copied();
        let values: Vec<f64> = shape[..count].iter().map(|value| -value).chain(weights).collect();
        let gradients: Vec<Point> =
            vec![[0.0; 3]; count].into_iter().chain((0..carriers).map(|a| local.slope(a))).collect();
        let of_carrier = gradients[count..].iter().map(|gradient| measure * dot(*gradient, tangent));
        let slopes = first[..count].iter().map(|slope| -slope).chain(of_carrier).collect();
        // The row of the slip of the centre gives the motion of its foot.
        let mut of_center = gap.slip(count);
        let center = of_center.next().unwrap_or(along);
        let of_center = of_center.chain(self.weights(pair.node).into_iter().map(|weight| center * weight));
        let moved: Vec<[f64; 2]> = of_center.map(|row| (row * (measure / gap.a)).0).collect();
        let turned = moved.iter().enumerate().map(|(k, moved)| {
            let slope = if k < count { first[k] } else { 0.0 };
            std::array::from_fn(|j| (slope * normal[j] + gap.kappa * moved[j]) / measure)
        });
        let turned = turned.collect();
        Sliding { facet: count, tangent, normal, a: gap.a, values, slopes, gradients, moved, turned }
    }
}
