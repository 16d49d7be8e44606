//! Convex and concave corners, and ends of sides: which facets a node faces there.

use carom_contact::{Combined, Detection, Kinematics, NodeToFacet, Pair, Pairing, Rows, Surface};
use carom_solid::FacetShape;

/// A square of side 1 with its corners as nodes 0 to 3; its top is the facet from 2 to 3.
const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

fn top() -> Surface {
    let rest = [vec![3, 0], vec![0, 1], vec![1, 2]];
    Surface::new(FacetShape::L2, &[vec![2, 3]], &[1.0]).bounded_by(&rest, 0)
}

fn positions(others: &[[f64; 2]]) -> Vec<f64> {
    [&SQUARE, others].concat().into_flattened()
}

/// The pairs after a search, with their gaps.
fn found(contact: &dyn Kinematics, before: &[f64], now: &[f64], pairing: &mut Pairing) -> Vec<(Pair, f64)> {
    contact.search(before, now, pairing, &mut Vec::new());
    let mut rows = Rows::new(2);
    let measured = |pair: &mut Pair| contact.measure(pair, now, &mut rows).is_ok();
    assert!(pairing.pairs.iter_mut().all(measured));
    pairing.pairs.iter().copied().zip(rows.iter().map(|row| row.gap)).collect()
}

#[test]
fn a_node_beside_a_corner_is_not_behind_the_extension_of_the_side() {
    let contact = NodeToFacet::new(vec![4], top(), Detection::ClosestPoint);
    for (from, to, touches) in [
        // It sinks beside the square, below the line of its top.
        ([-0.1, 1.05], [-0.1, 0.9], false),
        // It slides onto the top from the side, through the left side.
        ([-0.05, 0.95], [0.02, 0.95], false),
        // It sinks into the top.
        ([0.1, 1.05], [0.1, 0.9], true),
    ] {
        let before = positions(&[from]);
        let now = positions(&[to]);
        let pairs = found(&contact, &before, &now, &mut Pairing::default());
        assert_eq!(pairs.iter().any(|(_, gap)| *gap < 0.0), touches, "{from:?} {to:?}");
    }
}

#[test]
fn a_node_that_goes_to_and_fro_in_a_dent_has_a_pair_with_either_facet() {
    // A notch with its bottom at the origin, traversed with the body below on the left.
    let notch = [[1.0, 1.0], [0.0, 0.0], [-1.0, 1.0]];
    let sides = Surface::new(FacetShape::L2, &[vec![0, 1], vec![1, 2]], &[1.0; 2]);
    let contact = NodeToFacet::new(vec![3], sides, Detection::ClosestPoint);
    let at = |node: [f64; 2]| [&notch[..], &[node]].concat().into_flattened();
    let before = at([0.01, 0.1]);
    let mut pairing = Pairing::default();
    let mut changed = false;
    for node in [[0.05, -0.02], [-0.05, -0.02], [0.05, -0.02]] {
        pairing.pairs.iter_mut().for_each(|pair| pair.tangential.slip[0] = 0.2);
        // Each pair follows its closest point before the search, as in an iteration.
        let mut rows = Rows::new(2);
        pairing.pairs.iter_mut().for_each(|pair| contact.measure(pair, &at(node), &mut rows).unwrap());
        changed = contact.search(&before, &at(node), &mut pairing, &mut Vec::new());
    }
    // The node is inside the facet of the new pair.
    assert!(changed);
    let facets: Vec<usize> = pairing.pairs.iter().map(|pair| pair.facet).collect();
    assert!(facets == [0, 1] || facets == [1, 0], "{facets:?}");
    assert!(pairing.pairs.iter().all(|pair| pair.tangential.slip[0] == 0.2), "slip goes on");
    // At the bottom both gaps are closed.
    let mut rows = Rows::new(2);
    pairing.pairs.iter_mut().for_each(|pair| contact.measure(pair, &at([0.0; 2]), &mut rows).unwrap());
    assert!(rows.iter().all(|row| row.gap.abs() < 1e-15));
}

/// A node on a ridge has two pairs: the one that holds it on the extension of its facet, above
/// the other facet over which the node lies, goes; its state goes on with the other one.
#[test]
fn the_extension_of_a_facet_holds_no_node_off_a_ridge() {
    let ridge = [[1.0, 0.0], [0.0, 0.1], [-1.0, 0.0]];
    let sides = Surface::new(FacetShape::L2, &[vec![0, 1], vec![1, 2]], &[1.0; 2]);
    let contact = NodeToFacet::new(vec![3], sides, Detection::ClosestPoint);
    // On the line through the first facet.
    let y = [&ridge[..], &[[-0.01, 0.101]]].concat().into_flattened();
    let mut closed = Pair { active: true, lambda: -2.0, ..Pair::open(0, 0, 0.0) };
    closed.tangential.slip[0] = 0.3;
    let mut pairing = Pairing::new(vec![closed, Pair::open(0, 1, 0.0)]);
    pairing.fresh = false;
    let mut rows = Rows::new(2);
    pairing.pairs.iter_mut().for_each(|pair| contact.measure(pair, &y, &mut rows).unwrap());
    assert!(rows.row(0).gap.abs() < 1e-15 && rows.row(1).gap > 1e-3);
    assert!(contact.search(&y, &y, &mut pairing, &mut Vec::new()));
    let [pair] = pairing.pairs[..] else { panic!("{:?}", pairing.pairs) };
    assert_eq!((pair.facet, pair.active, pair.lambda, pair.tangential.slip[0]), (1, true, -2.0, 0.3));
}

#[test]
fn a_node_behind_both_facets_of_a_notch_has_a_pair_with_either() {
    let notch = [[1.0, 1.0], [0.0, 0.0], [-1.0, 1.0]];
    let sides = Surface::new(FacetShape::L2, &[vec![0, 1], vec![1, 2]], &[1.0; 2]);
    let contact = NodeToFacet::new(vec![3], sides, Detection::ClosestPoint);
    let at = |node: [f64; 2]| [&notch[..], &[node]].concat().into_flattened();
    let mut pairing = Pairing::default();
    // The second pair is found in the search after the one that has found that the node is deep.
    (0..2).for_each(|_| {
        found(&contact, &at([0.0, 0.1]), &at([0.0, -0.02]), &mut pairing);
    });
    let gaps: Vec<f64> = found(&contact, &at([0.0, 0.1]), &at([0.0, -0.02]), &mut pairing)
        .into_iter()
        .map(|(_, gap)| gap)
        .collect();
    let depth = -0.02 * 0.5_f64.sqrt();
    assert!(gaps.len() == 2 && gaps.iter().all(|gap| (gap - depth).abs() < 1e-15), "{gaps:?}");
}

#[test]
fn a_corner_of_the_primary_does_not_cut_into_an_edge_of_the_secondary() {
    // The edge above the square, of a body that lies above it: its ends are far from the corner.
    let edge = Surface::new(FacetShape::L2, &[vec![4, 5]], &[1.0]);
    let others = NodeToFacet::new(vec![2, 3], edge, Detection::ClosestPoint).with_allowed(vec![0.0, 0.02]);
    let contact =
        Combined::both(NodeToFacet::new(vec![4, 5], top(), Detection::ClosestPoint), others.reversed());
    let sloped = |height: f64| positions(&[[-1.0, height + 1.0], [2.0, height - 0.5]]);
    let before = sloped(1.1);
    let now = sloped(0.97);
    let pairs = found(&contact, &before, &now, &mut Pairing::default());
    // Node 2, at (1, 1), lies 0.03/√1.25 inside; node 3 is free.
    let inside: Vec<_> = pairs.iter().filter(|(_, gap)| *gap < 0.0).collect();
    let [(corner, gap)] = inside[..] else { panic!("{pairs:?}") };
    assert_eq!(contact.secondary()[corner.node], 2);
    assert!((gap + 0.03 / 1.25_f64.sqrt()).abs() < 1e-14, "{gap}");
    // The normal is still the primary's outward one: the force on the secondary is along it.
    let mut rows = Rows::new(2);
    contact.measure(&mut corner.clone(), &now, &mut rows).unwrap();
    let [x, y, _] = rows.row(0).normal();
    assert!((x - 0.5 / 1.25_f64.sqrt()).abs() < 1e-14 && (y - 1.0 / 1.25_f64.sqrt()).abs() < 1e-14);
    assert_eq!(contact.allowed(3), 0.02);
}

#[test]
fn a_joint_of_two_sides_belongs_to_the_facet_that_ends_there() {
    // Top and left side of the square as primaries of two contacts.
    let rest = |own: usize| (0..4).map(|k| vec![k, (k + 1) % 4]).filter(|f| f[0] != own).collect::<Vec<_>>();
    let side = |own: usize, sibling: usize| {
        let mut rest = rest(own);
        rest.sort_by_key(|facet| facet[0] != sibling);
        let surface = Surface::new(FacetShape::L2, &[vec![own, (own + 1) % 4]], &[1.0]);
        NodeToFacet::new(vec![4], surface.bounded_by(&rest, 1), Detection::ClosestPoint)
    };
    let at_corner = positions(&[[0.0, 1.0]]);
    let faces = |contact: NodeToFacet, xi: f64| {
        let mut rows = Rows::new(2);
        contact.measure(&mut Pair::open(0, 0, xi), &at_corner, &mut rows).unwrap();
        rows.row(0).gap.is_finite()
    };
    assert!(faces(side(2, 3), 1.0), "the top ends at the corner");
    assert!(!faces(side(3, 2), -1.0), "the left side begins there");
}
