//! Detection and gaps of node-to-segment contact: an arc of secondary nodes, a part of which has just come through a flat side of linear, quadratic or
//! cubic facets.
//!
//!     cargo bench -p carom-contact            times
//!     bench/instructions.py carom-contact     instructions

use std::hint::black_box;

use carom_contact::{ContactMethod, Detection, Linearised, NodeToSegment, Pair, Surface};
use divan::Bencher;

const ORDERS: [usize; 3] = [1, 2, 3];
/// Facets of the side and nodes of the arc.
const FACETS: usize = 48;
const NODES: usize = 216;

fn main() {
    divan::main();
}

/// The contact, and positions before and after the step in which the arc comes through the side.
fn scene(order: usize) -> (NodeToSegment, Vec<[f64; 2]>, Vec<[f64; 2]>) {
    let points = FACETS * order;
    // Walked with the body below on the left: from right to left.
    let side = (0..=points).map(|k| [2.0 - 4.0 * k as f64 / points as f64, 0.0]);
    let angle = |k: usize| std::f64::consts::TAU * k as f64 / NODES as f64;
    let arc = |height: f64| (0..NODES).map(move |k| [angle(k).sin(), height - angle(k).cos()]);
    let at = |height: f64| side.clone().chain(arc(height)).collect::<Vec<_>>();
    let facet = |f: usize| {
        let first = f * order;
        [first, first + order].into_iter().chain(first + 1..first + order).collect::<Vec<_>>()
    };
    let secondary = (points + 1..points + 1 + NODES).collect();
    let surface = Surface::new(&(0..FACETS).map(facet).collect::<Vec<_>>());
    (NodeToSegment::new(secondary, surface, Detection::ClosestPoint), at(1.01), at(0.99))
}

/// Pairs found in a scene.
fn found(contact: &NodeToSegment, before: &[[f64; 2]], now: &[[f64; 2]]) -> Vec<Pair> {
    let mut pairs = Vec::new();
    contact.detect(before, now, &mut pairs, &mut Vec::new()).expect("on the side");
    assert!(pairs.len() > 5, "{} pairs", pairs.len());
    pairs
}

/// All pairs are new.
#[divan::bench(args = ORDERS)]
fn detection_at_first_touch(bencher: Bencher, order: usize) {
    let (contact, before, now) = scene(order);
    let mut pairs = found(&contact, &before, &now);
    bencher.bench_local(|| {
        pairs.clear();
        contact.detect(&before, black_box(&now), &mut pairs, &mut Vec::new()).is_ok()
    });
}

/// All pairs are known: their facets are looked over.
#[divan::bench(args = ORDERS)]
fn detection_in_contact(bencher: Bencher, order: usize) {
    let (contact, before, now) = scene(order);
    let mut pairs = found(&contact, &before, &now);
    bencher.bench_local(|| contact.detect(&now, black_box(&now), &mut pairs, &mut Vec::new()).is_ok());
}

/// Gap, gradient and second derivative of one pair.
#[divan::bench(args = ORDERS)]
fn gap(bencher: Bencher, order: usize) {
    let (contact, before, now) = scene(order);
    let pair = found(&contact, &before, &now)[3];
    let mut gap = Linearised::default();
    bencher.bench_local(|| contact.linearise(&mut pair.clone(), black_box(&now), -1.0, &mut gap).is_ok());
}
