//! Several kinds of contact of the same sides in one set of pairs, numbered part after part: nodes
//! of either side against facets of the other one (`reversed.rs`), and what may lie between nodes:
//! in space sharp edges against sharp edges, the edges of the primary being numbered after its
//! facets, and points of edges against facets; in the plane convex corners and round parts of an
//! obstacle against facets; and coefficients of a pressure field with bounds for single nodes.

use carom_algebra::{Mat, Threads};

use super::obstacle::Tip;
use super::{BetweenNodes, InPlane, Kinematics, NodalPressure, Passed};
use crate::pair::{ContactError, Pair, PairEvent, Pairing};
use crate::rows::Rows;

/// Contact in several parts. A pressure field and the nodes of a rigid obstacle come first.
#[derive(Debug)]
pub struct Combined {
    parts: Vec<Box<dyn Kinematics>>,
    /// The number of the first secondary node of each part.
    firsts: Vec<usize>,
    all: Vec<usize>,
    threads: Threads,
}

/// The pairs of one part, numbered within it, and what a search did to them.
struct OfPart {
    pairing: Pairing,
    events: Vec<PairEvent>,
    has_changed: bool,
}

impl Combined {
    /// Combines kinds of contact.
    pub fn new(parts: Vec<Box<dyn Kinematics>>) -> Self {
        let mut all = Vec::new();
        let mut firsts = Vec::new();
        for part in &parts {
            firsts.push(all.len());
            all.extend_from_slice(part.secondary());
        }
        Self { parts, firsts, all, threads: Threads::one() }
    }

    /// Combines two kinds of contact, such as nodes of either side.
    pub fn both(first: impl Kinematics + 'static, second: impl Kinematics + 'static) -> Self {
        Self::new(vec![Box::new(first), Box::new(second)])
    }

    /// The index of the part to which a secondary node, given by index, belongs.
    fn part_of(&self, node: usize) -> usize {
        self.firsts.partition_point(|&first| first <= node) - 1
    }

    /// The part to which a secondary node, given by index, belongs, and its index there.
    fn of(&self, node: usize) -> (&dyn Kinematics, usize) {
        let part = self.part_of(node);
        (&*self.parts[part], node - self.firsts[part])
    }

    /// The part to which a pair belongs, and the pair with its number there.
    fn of_pair(&self, pair: &Pair) -> (&dyn Kinematics, Pair) {
        let (part, node) = self.of(pair.node);
        (part, Pair { node, ..*pair })
    }

    /// Applies a function to the pairs of each part, and collects their events in order.
    fn each(
        &self,
        pairing: &mut Pairing,
        events: &mut Vec<PairEvent>,
        of: impl Fn(&dyn Kinematics, &mut Pairing, &mut Vec<PairEvent>) -> bool + Sync,
    ) -> bool {
        let later = self.firsts[1..].iter().rev();
        let mut own: Vec<Pairing> = later.map(|&first| pairing.split_off(first)).collect();
        own.push(std::mem::take(pairing));
        let with_events = |pairing| OfPart { pairing, events: Vec::new(), has_changed: false };
        let mut own: Vec<OfPart> = own.into_iter().rev().map(with_events).collect();
        self.threads.for_each(&mut own, |k, own| {
            own.has_changed = of(&*self.parts[k], &mut own.pairing, &mut own.events);
        });
        let mut has_changed = false;
        for (k, mut own) in own.into_iter().enumerate() {
            has_changed |= own.has_changed;
            events.append(&mut own.events);
            if k == 0 {
                *pairing = own.pairing;
            } else {
                pairing.append(own.pairing, self.firsts[k]);
            }
        }
        has_changed
    }
}

impl Kinematics for Combined {
    fn secondary(&self) -> &[usize] {
        &self.all
    }

    fn nodes(&self) -> usize {
        let mut nodes = 0;
        for part in &self.parts {
            nodes += part.nodes();
            // Multipliers of a mortar are no nodes; nodes after them are not counted.
            if part.nodes() < part.secondary().len() {
                break;
            }
        }
        nodes
    }

    fn allowed(&self, node: usize) -> f64 {
        let (part, node) = self.of(node);
        part.allowed(node)
    }

    fn keep(&mut self, depths: &[f64]) {
        let mut rest = depths;
        for part in &mut self.parts {
            let (own, later) = rest.split_at(part.secondary().len().min(rest.len()));
            part.keep(own);
            rest = later;
        }
    }

    fn kept(&self, node: usize) -> f64 {
        let (part, node) = self.of(node);
        part.kept(node)
    }

    fn on(&mut self, threads: &Threads) {
        self.threads = threads.clone();
        self.parts.iter_mut().for_each(|part| part.on(threads));
    }

    fn kept_at_nodes(&self) -> Vec<(usize, f64)> {
        self.parts.iter().flat_map(|part| part.kept_at_nodes()).collect()
    }

    fn roundings(&self, y: &[f64]) -> Vec<f64> {
        let mut all = Vec::new();
        let mut are_chords = false;
        for part in &self.parts {
            let mut own = part.roundings(y);
            are_chords |= !own.is_empty();
            own.resize(part.secondary().len(), 0.0);
            all.append(&mut own);
        }
        if are_chords { all } else { Vec::new() }
    }

    fn facet_nodes(&self, pair: &Pair) -> &[usize] {
        let (part, pair) = self.of_pair(pair);
        part.facet_nodes(&pair)
    }

    fn between_nodes(&self, pair: &Pair) -> Option<BetweenNodes<'_>> {
        let (part, pair) = self.of_pair(pair);
        part.between_nodes(&pair)
    }

    fn rotation_of_primary(&self, pair: &Pair, ends: [&[f64]; 2]) -> Option<Mat<3>> {
        let (part, pair) = self.of_pair(pair);
        part.rotation_of_primary(&pair, ends)
    }

    fn is_on_facet(&self, pair: &Pair) -> bool {
        let (part, pair) = self.of_pair(pair);
        part.is_on_facet(&pair)
    }

    fn keeps_depth(&self, pair: &Pair) -> bool {
        let (part, pair) = self.of_pair(pair);
        part.keeps_depth(&pair)
    }

    fn facets(&self, node: usize) -> usize {
        let (part, node) = self.of(node);
        part.facets(node)
    }

    fn signed_distance(&self, node: usize, y: &[f64]) -> Option<f64> {
        let (part, node) = self.of(node);
        part.signed_distance(node, y)
    }

    fn is_left(&self, node: usize, y: &[f64]) -> bool {
        let (part, node) = self.of(node);
        part.is_left(node, y)
    }

    fn distance_to_obstacle(&self, node: usize, y: &[f64]) -> Option<f64> {
        self.parts[0].distance_to_obstacle(node, y)
    }

    fn tips(&self, y: &[f64]) -> Vec<Tip> {
        self.parts[0].tips(y)
    }

    fn search(
        &self,
        before: &[f64],
        now: &[f64],
        pairing: &mut Pairing,
        events: &mut Vec<PairEvent>,
    ) -> bool {
        self.each(pairing, events, |part, pairing, events| part.search(before, now, pairing, events))
    }

    fn passed(&self, before: &[f64], now: &[f64], bounce: f64) -> Option<Passed> {
        let mut of_parts: Vec<Option<Passed>> = vec![None; self.parts.len()];
        self.threads.for_each(&mut of_parts, |k, passed| {
            *passed = self.parts[k].passed(before, now, bounce);
        });
        of_parts.into_iter().flatten().next()
    }

    fn met(&self, nodes: &[usize], before: &[f64], now: &[f64]) -> Vec<Option<f64>> {
        let mut all = vec![None; nodes.len()];
        for (k, part) in self.parts.iter().enumerate() {
            let places: Vec<usize> = (0..nodes.len()).filter(|&i| self.part_of(nodes[i]) == k).collect();
            if places.is_empty() {
                continue;
            }
            let own: Vec<usize> = places.iter().map(|&i| nodes[i] - self.firsts[k]).collect();
            for (i, met) in places.into_iter().zip(part.met(&own, before, now)) {
                all[i] = met;
            }
        }
        all
    }

    fn update_facets(&self, now: &[f64], pairing: &mut Pairing, events: &mut Vec<PairEvent>) -> bool {
        self.each(pairing, events, |part, pairing, events| part.update_facets(now, pairing, events))
    }

    fn start_step(&self, pair: &mut Pair, y: &[f64]) {
        let (part, mut own) = self.of_pair(pair);
        part.start_step(&mut own, y);
        *pair = Pair { node: pair.node, ..own };
    }

    fn measure(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let (part, mut own) = self.of_pair(pair);
        let measured = part.measure(&mut own, y, rows);
        *pair = Pair { node: pair.node, ..own };
        measured
    }

    fn nearest(&self, pair: &Pair, gap: f64, y: &[f64]) -> f64 {
        let (part, pair) = self.of_pair(pair);
        part.nearest(&pair, gap, y)
    }

    fn is_of_field(&self, node: usize) -> bool {
        let (part, node) = self.of(node);
        part.is_of_field(node)
    }

    fn area(&self, node: usize) -> Option<f64> {
        let (part, node) = self.of(node);
        part.area(node)
    }

    fn in_plane_of_symmetry(&self, node: usize) -> Option<InPlane> {
        let (part, node) = self.of(node);
        part.in_plane_of_symmetry(node)
    }

    fn pressure_field(&self, pairs: &[Pair], y: &[f64], thickness: f64) -> Vec<NodalPressure> {
        let count = self.parts[0].secondary().len();
        let own = &pairs[..pairs.partition_point(|pair| pair.node < count)];
        self.parts[0].pressure_field(own, y, thickness)
    }

    fn curvature_into(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]) {
        let (part, pair) = self.of_pair(pair);
        part.curvature_into(&pair, y, curvature);
    }

    fn slip(&self, pair: &Pair, y: &[f64], moved: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let (part, pair) = self.of_pair(pair);
        part.slip(&pair, y, moved, rows)
    }

    fn slip_derivative_into(
        &self,
        pair: &Pair,
        y: &[f64],
        moved: &[f64],
        tangent: usize,
        matrix: &mut [f64],
    ) {
        let (part, pair) = self.of_pair(pair);
        part.slip_derivative_into(&pair, y, moved, tangent, matrix);
    }
}
