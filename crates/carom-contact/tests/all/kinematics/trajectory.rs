//! Crossings of trajectories.

use carom_contact::SweptTest;
use carom_contact::kinematics::projection::Facet;
use carom_contact::kinematics::trajectory::{Crossing, crossing, lerp};
use carom_contact::places::Places;
use carom_solid::FacetShape;

/// Facet along x traversed so that its normal is +y, i.e. from right to left.
const FACET: Facet = Facet { shape: FacetShape::L4, nodes: &[1, 2, 3, 4], orientation: 1.0 };

fn scene(from: [f64; 2], to: [f64; 2], bulge: f64) -> (Vec<f64>, Vec<f64>) {
    let curve = [[1.0, 0.0], [-1.0, 0.0], [1.0 / 3.0, bulge], [-1.0 / 3.0, bulge]];
    let with = |node: [f64; 2]| [&node[..], curve.as_flattened()].concat();
    (with(from), with(to))
}

fn crossed(before: &[f64], now: &[f64]) -> Option<Crossing> {
    let mut swept = SweptTest::new(FACET.shape);
    crossing(&mut swept, FACET, Places::new(before, 2), Places::new(now, 2), 0)
}

#[test]
fn meets_a_cubic_where_the_node_is_on_it() {
    let (before, now) = scene([0.2, 1.0], [0.3, -1.0], 0.2);
    let found = crossed(&before, &now).unwrap();
    let y = lerp(Places::new(&before, 2).at(0), Places::new(&now, 2).at(0), found.theta);
    let surface = FACET.at(Places::new(&before, 2), found.xi).position;
    assert!((y - surface).norm() < 1e-12);
}

#[test]
fn passes_right_through_a_thin_body_are_seen_and_exits_are_not() {
    let (before, now) = scene([0.0, 5.0], [0.0, -5.0], 0.0);
    assert!((crossed(&before, &now).unwrap().theta - 0.5).abs() < 1e-12);
    assert!(crossed(&now, &before).is_none());
}

#[test]
fn touching_at_the_start_counts_within_the_tolerance() {
    let (before, now) = scene([0.0, -1e-9], [0.0, -0.1], 0.0);
    assert!(crossed(&before, &now).is_some());
    let (before, now) = scene([2.0, 1.0], [2.0, -1.0], 0.0);
    assert!(crossed(&before, &now).is_none());
}

#[test]
fn moving_facets_are_met_where_they_will_be() {
    let (before, mut now) = scene([0.1, 1.0], [0.1, 1.0], 0.1);
    for y in now[2..].as_chunks_mut::<2>().0 {
        y[1] += 2.0;
    }
    let found = crossed(&before, &now).unwrap();
    assert!(found.theta > 0.4 && found.theta < 0.5);
}
