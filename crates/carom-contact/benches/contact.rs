//! Search and gaps of contact with facets: an arc of secondary nodes, some of which have just
//! penetrated a flat side of linear, quadratic or cubic facets.
//!
//!     cargo bench -p carom-contact            times
//!     bench/instructions.py carom-contact     instructions

use std::hint::black_box;

use carom_algebra::Vector;
use carom_contact::{
    Crossings, Detection, Kinematics, NodeToFacet, Pairing, Rows, Surface, Swept, SweptTest,
};
use carom_solid::FacetShape;
use divan::Bencher;
use divan::counter::ItemsCount;

const SHAPES: [FacetShape; 3] = [FacetShape::L2, FacetShape::L3, FacetShape::L4];
/// Facets of the side and nodes of the arc.
const FACETS: usize = 48;
const NODES: usize = 216;

fn main() {
    divan::main();
}

/// The contact, and positions before and after the step in which the arc penetrates the side.
fn scene(shape: FacetShape) -> (NodeToFacet, Vec<f64>, Vec<f64>) {
    let order = shape.degree();
    let points = FACETS * order;
    // Traversed with the body below on the left: from right to left.
    let side = (0..=points).map(|k| [2.0 - 4.0 * k as f64 / points as f64, 0.0]);
    let angle = |k: usize| std::f64::consts::TAU * k as f64 / NODES as f64;
    let arc = |height: f64| (0..NODES).map(move |k| [angle(k).sin(), height - angle(k).cos()]);
    let at = |height: f64| side.clone().chain(arc(height)).flatten().collect::<Vec<_>>();
    let facet = |f: usize| {
        let first = f * order;
        [first, first + order].into_iter().chain(first + 1..first + order).collect::<Vec<_>>()
    };
    let secondary = (points + 1..points + 1 + NODES).collect();
    let surface = Surface::new(shape, &(0..FACETS).map(facet).collect::<Vec<_>>(), &[1.0; FACETS]);
    (NodeToFacet::new(secondary, surface, Detection::ClosestPoint), at(1.01), at(0.99))
}

/// Pairs found in a scene.
fn found(contact: &NodeToFacet, before: &[f64], now: &[f64]) -> Pairing {
    let mut pairing = Pairing::default();
    contact.search(before, now, &mut pairing, &mut Vec::new());
    assert!(pairing.pairs.len() > 5, "{} pairs", pairing.pairs.len());
    pairing
}

/// All pairs are new.
#[divan::bench(args = SHAPES)]
fn detection_at_first_contact(bencher: Bencher, shape: FacetShape) {
    let (contact, before, now) = scene(shape);
    let mut pairing = found(&contact, &before, &now);
    bencher.bench_local(|| {
        pairing.pairs.clear();
        contact.search(&before, black_box(&now), &mut pairing, &mut Vec::new())
    });
}

/// A whole search: as many nodes as facets, a quarter of which penetrate in the step while the
/// others come near. Times per facet grow logarithmically.
#[divan::bench(args = [1_000, 10_000, 100_000], sample_count = 20)]
fn search_of_a_long_side(bencher: Bencher, facets: usize) {
    let points = 2 * facets;
    let length = 2.0 / facets as f64;
    let side = (0..=points).map(|k| [2.0 - length * k as f64, 0.0]);
    let wave = |x: f64| 0.25 * length * (40.0 * std::f64::consts::PI * x).sin();
    let row = |height: f64| {
        (0..facets).map(move |k| 2.0 - 2.0 * length * (k as f64 + 0.3)).map(move |x| [x, height + wave(x)])
    };
    let at = |height: f64| side.clone().chain(row(height)).flatten().collect::<Vec<_>>();
    let nodes: Vec<_> = (0..facets).map(|f| vec![2 * f, 2 * f + 2, 2 * f + 1]).collect();
    let secondary = (points + 1..points + 1 + facets).collect();
    let surface = Surface::new(FacetShape::L3, &nodes, &vec![1.0; facets]);
    let contact = NodeToFacet::new(secondary, surface, Detection::ClosestPoint);
    let before = at(length);
    let now = at(0.177 * length);
    let mut pairing = found(&contact, &before, &now);
    bencher.counter(ItemsCount::new(facets)).bench_local(|| {
        pairing.pairs.clear();
        contact.search(&before, black_box(&now), &mut pairing, &mut Vec::new())
    });
}

/// All pairs are known: only their facets are checked.
#[divan::bench(args = SHAPES)]
fn detection_in_contact(bencher: Bencher, shape: FacetShape) {
    let (contact, before, now) = scene(shape);
    let mut pairing = found(&contact, &before, &now);
    bencher.bench_local(|| contact.search(&now, black_box(&now), &mut pairing, &mut Vec::new()));
}

/// Gap, gradient and second derivative of one pair.
#[divan::bench(args = SHAPES)]
fn gap(bencher: Bencher, shape: FacetShape) {
    let (contact, before, now) = scene(shape);
    let found = found(&contact, &before, &now).pairs[3];
    let mut rows = Rows::new(2);
    assert!(contact.measure(&mut found.clone(), &now, &mut rows).is_ok());
    let mut curvature = vec![0.0; rows.row(0).gradient.len().pow(2)];
    bencher.bench_local(|| {
        let mut pair = found;
        rows.clear();
        let measured = contact.measure(&mut pair, black_box(&now), &mut rows).is_ok();
        contact.curvature_into(&pair, black_box(&now), &mut curvature);
        measured
    });
}

/// Swept test of a node that starts at a height above an arc and falls by 0.1.
fn swept(bencher: Bencher, shape: FacetShape, height: f64, clear: bool) {
    let places: &[f64] = match shape {
        FacetShape::L3 => &[-1.0, 1.0, 0.0],
        _ => &[-1.0, 1.0, -1.0 / 3.0, 1.0 / 3.0],
    };
    let facet: Vec<_> = places[..shape.nodes()].iter().map(|x| Vector([-x, 0.1 * (1.0 - x * x)])).collect();
    let node = [Vector([0.2, height]), Vector([0.25, height - 0.1])];
    let mut test = SweptTest::new(shape);
    bencher.bench_local(|| {
        let answer = test.first(black_box(node), [&facet, &facet], Crossings::Inward, 1e-9);
        assert_eq!(answer == Swept::Clear, clear);
    });
}

#[divan::bench(args = SHAPES)]
fn swept_clear(bencher: Bencher, shape: FacetShape) {
    swept(bencher, shape, 0.3, true);
}

#[divan::bench(args = SHAPES)]
fn swept_hit(bencher: Bencher, shape: FacetShape) {
    swept(bencher, shape, if shape == FacetShape::L2 { 0.05 } else { 0.15 }, false);
}
