//! A node that slides along a chain of facets during the Newton iteration is handed over to its
//! current facet in one go, and back.

use carom_contact::{Detection, Kinematics, NodeToFacet, Pair, PairEvent, Pairing, Surface};
use carom_solid::FacetShape;

/// Facets of length 1 from x = 0 to x = 4, and a node (0) at `x`, pressed onto them.
fn scene(x: f64) -> (NodeToFacet, Vec<f64>) {
    let facets: Vec<Vec<usize>> = (0..4).map(|k| vec![k + 2, k + 1]).collect();
    let mut y = vec![x, 0.0];
    y.extend((0..5).flat_map(|k| [f64::from(k), 0.0]));
    (NodeToFacet::new(vec![0], Surface::new(FacetShape::L2, &facets, &[1.0; 4]), Detection::ClosestPoint), y)
}

/// Moves the node of a pairing to `x` and updates its facet.
fn update_facets(pairing: &mut Pairing, x: f64) -> Vec<PairEvent> {
    let (contact, y) = scene(x);
    let pair = &mut pairing.pairs[0];
    // ξ is opposite to x here: the outward normal of the chain points up.
    pair.xi = 2.0 * (pair.facet as f64 + 0.5 - x);
    let mut events = Vec::new();
    assert_eq!(contact.update_facets(&y, pairing, &mut events), !events.is_empty());
    events
}

/// Facet and position of a pair on the facet from x = 1 to x = 2, to which it may have `come_from`
/// another, updated to a node at `x`.
fn updated(x: f64, come_from: Option<usize>) -> (usize, f64, Vec<PairEvent>) {
    let facet = come_from.unwrap_or(1);
    let pair = Pair { active: true, lambda: -1.0, ..Pair::open(0, facet, 0.0) };
    let mut pairing = Pairing::new(vec![pair]);
    update_facets(&mut pairing, 1.5);
    assert_eq!(pairing.pairs[0].facet, 1);
    let events = update_facets(&mut pairing, x);
    (pairing.pairs[0].facet, pairing.pairs[0].xi, events)
}

#[test]
fn a_node_is_followed_over_several_facets_at_once() {
    let (facet, xi, events) = updated(2.1, None);
    assert!(facet == 2 && (xi - 0.8).abs() < 1e-12, "{facet} {xi}");
    assert_eq!(events, [PairEvent::HandOver { node: 0, from: 1, to: 2 }]);
    // 1.2 facets further: the closest point on the next one lies beyond its end.
    let (facet, xi, _) = updated(3.05, None);
    assert!(facet == 3 && (xi - 0.9).abs() < 1e-12, "{facet} {xi}");
}

#[test]
fn a_node_barely_past_the_end_stays() {
    assert_eq!(updated(2.005, None).0, 1);
    // It was handed over from there: it returns only when it is clearly there.
    assert_eq!(updated(2.04, Some(2)).0, 1);
    assert_eq!(updated(2.06, Some(2)).0, 2);
}
