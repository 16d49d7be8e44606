//! Contact over the joints of facets, whose gap is the mean of those to all of them: derivatives
//! against differences, balance, and the symmetry that no single facet has.

use carom_algebra::{Vector, jacobian_error};
use carom_contact::{
    Boundary, Detection, Kinematics, NodeToFacet, NodeToPatch, Pair, Pairing, Rows, Surface,
};
use carom_solid::FacetShape;

/// Node 0 over the joint of two quadratic facets with a kink, and the pair there.
fn in_the_plane() -> (Box<dyn Kinematics>, Vec<f64>, Pair) {
    let y = [[0.012, 0.27], [1.0, 0.0], [0.0, 0.1], [-1.1, -0.03], [0.5, 0.08], [-0.5, 0.07]];
    let surface = Surface::new(FacetShape::L3, &[vec![1, 2, 4], vec![2, 3, 5]], &[1.0; 2]);
    let contact = NodeToFacet::new(vec![0], surface, Detection::ClosestPoint);
    let pair = Pair { joint: Some(1), active: true, ..Pair::open(0, 0, 1.0) };
    (Box::new(contact), y.as_flattened().to_vec(), pair)
}

/// Node 0 over the corner of four bilinear facets, and the pair there.
fn in_space() -> (Box<dyn Kinematics>, Vec<f64>, Pair) {
    let mut y = vec![[0.013, -0.02, 0.3]];
    for k in 0..9 {
        let [x, z] = [f64::from(k % 3) - 1.0, f64::from(k / 3) - 1.0];
        y.push([x, z, 0.1 - 0.07 * x * x - 0.05 * z * z + 0.01 * x * z]);
    }
    let facets: Vec<Vec<usize>> = [1, 2, 4, 5].map(|k| vec![k, k + 1, k + 4, k + 3]).to_vec();
    let contact = NodeToPatch::new(vec![0], Boundary::new(FacetShape::Q4, &facets, &[], 0));
    let pair = Pair { joint: Some(2), active: true, eta: 1.0, ..Pair::open(0, 0, 1.0) };
    (Box::new(contact), y.as_flattened().to_vec(), pair)
}

fn scenes() -> [(Box<dyn Kinematics>, Vec<f64>, Pair); 2] {
    [in_the_plane(), in_space()]
}

/// The gap, and its gradient over all dofs.
fn measured(contact: &dyn Kinematics, y: &[f64], mut pair: Pair) -> (f64, Vec<f64>, Pair) {
    let mut rows = Rows::new(dimension(y));
    contact.measure(&mut pair, y, &mut rows).unwrap();
    let mut full = vec![0.0; y.len()];
    rows.row(0).add_to(1.0, &mut full);
    (rows.row(0).gap, full, pair)
}

#[test]
fn derivatives_of_the_mean_agree_with_differences() {
    for (contact, y, pair) in scenes() {
        let (_, gradient, at) = measured(&*contact, &y, pair);
        let error = jacobian_error(&y, 1e-3, |y| vec![measured(&*contact, y, pair).0], &gradient);
        assert!(error < 1e-9, "gradient {error:e}");

        let mut rows = Rows::new(dimension(&y));
        contact.measure(&mut at.clone(), &y, &mut rows).unwrap();
        let dofs: Vec<usize> = rows.row(0).entries().map(|(dof, _)| dof).collect();
        let mut curvature = vec![0.0; dofs.len().pow(2)];
        contact.curvature_into(&at, &y, &mut curvature);
        let mut full = vec![0.0; y.len().pow(2)];
        for (a, row) in dofs.iter().enumerate() {
            for (b, column) in dofs.iter().enumerate() {
                full[row * y.len() + column] = curvature[a * dofs.len() + b];
            }
        }
        let error = jacobian_error(&y, 1e-3, |y| measured(&*contact, y, pair).1, &full);
        assert!(error < 1e-8, "second derivative {error:e}");
    }
}

fn dimension(y: &[f64]) -> usize {
    if y.len() == 12 { 2 } else { 3 }
}

#[test]
fn forces_over_a_joint_balance() {
    for (contact, y, pair) in scenes() {
        let (_, gradient, _) = measured(&*contact, &y, pair);
        let d = dimension(&y);
        for i in 0..d {
            let sum: f64 = gradient.iter().skip(i).step_by(d).sum();
            assert!(sum.abs() < 1e-14, "{sum:e}");
            let j = (i + 1) % d;
            let moment = |(y, f): (&[f64], &[f64])| y[i] * f[j] - y[j] * f[i];
            let moment: f64 = y.chunks(d).zip(gradient.chunks(d)).map(moment).sum();
            assert!(moment.abs() < 1e-14, "{moment:e}");
        }
    }
}

/// A roof of straight facets, symmetric about x = 0: the normal at its ridge is vertical, and a
/// search finds the joint, from whichever side, until the node has slid off.
#[test]
fn the_normal_at_a_ridge_is_that_of_symmetry() {
    let surface = Surface::new(FacetShape::L2, &[vec![1, 2], vec![2, 3]], &[1.0; 2]);
    let contact = NodeToFacet::new(vec![0], surface, Detection::ClosestPoint);
    let at = |x: f64, height: f64| vec![x, height, 1.0, 0.0, 0.0, 0.1, -1.0, 0.0];
    for x in [0.0, 1e-12, -1e-12] {
        let mut pairing = Pairing::default();
        assert!(contact.search(&at(x, 0.2), &at(x, 0.09), &mut pairing, &mut Vec::new()));
        let mut rows = Rows::new(2);
        contact.measure(&mut pairing.pairs[0], &at(x, 0.09), &mut rows).unwrap();
        let normal = rows.row(0).normal();
        // The cosine of the slope, 0.1, of either facet.
        assert!(normal[0].abs() < 1e-15 && (normal[1] - 1.01_f64.sqrt().recip()).abs() < 1e-12, "{normal:?}");
        pairing.pairs[0].active = true;
        contact.measure(&mut pairing.pairs[0], &at(0.01, 0.099), &mut rows).unwrap();
        assert!(contact.search(&at(x, 0.2), &at(0.01, 0.099), &mut pairing, &mut Vec::new()));
        assert_eq!((pairing.pairs[0].joint, pairing.pairs[0].facet), (None, 0));
    }
}

/// A pair that leaves the joint of a ridge goes on with the facet whose end is nearer, whatever
/// facet it had there: in the cone of the ridge, where its node is past the end of both, too.
#[test]
fn a_node_that_leaves_a_joint_lies_on_the_nearer_facet() {
    let surface = Surface::new(FacetShape::L2, &[vec![1, 2], vec![2, 3]], &[1.0; 2]);
    let contact = NodeToFacet::new(vec![0], surface, Detection::ClosestPoint);
    // The second facet is a tenth as long as the first.
    let at = |x: f64, height: f64| vec![x, height, 1.0, 0.0, 0.0, 0.1, -0.1, 0.09];
    for facet in [0, 1] {
        for (x, nearer) in [(1e-4, 0), (-1e-4, 1), (0.01, 0), (-0.01, 1)] {
            let xi = [1.0, -1.0][facet];
            let pair = Pair { active: true, joint: Some(u8::from(facet == 0)), ..Pair::open(0, facet, xi) };
            let mut events = Vec::new();
            // Within a solve.
            let mut pairing = Pairing::new(vec![pair]);
            pairing.fresh = false;
            contact.search(&at(0.0, 0.11), &at(x, 0.11), &mut pairing, &mut events);
            assert_eq!((pairing.pairs[0].joint, pairing.pairs[0].facet), (None, nearer), "{facet} {x}");
            // Between two solves.
            let mut pairing = Pairing::new(vec![pair]);
            contact.search(&at(x, 0.11), &at(x, 0.11), &mut pairing, &mut events);
            assert_eq!((pairing.pairs[0].joint, pairing.pairs[0].facet), (None, nearer), "{facet} {x}");
            assert!(events.is_empty(), "{events:?}");
        }
    }
}

/// Where one of the facets of a joint has no closest point, the pair has no row: the rows of other
/// pairs stay as they are.
#[test]
fn a_joint_that_cannot_be_measured_adds_no_row() {
    // The node is below the end of a straight facet, and twice as deep as the radius of curvature
    // of the other one.
    let y = [[0.0, -5.0], [1.0, 0.0], [0.0, 0.0], [-1.0, 0.0], [0.5, 0.0], [-0.5, 0.05]];
    let surface = Surface::new(FacetShape::L3, &[vec![1, 2, 4], vec![2, 3, 5]], &[1.0; 2]);
    let contact = NodeToFacet::new(vec![0], surface, Detection::ClosestPoint);
    let [single, joint] = [None, Some(1)].map(|joint| Pair { joint, active: true, ..Pair::open(0, 0, 1.0) });
    let y = y.as_flattened();
    let mut rows = Rows::new(2);
    contact.measure(&mut single.clone(), y, &mut rows).unwrap();
    assert!(contact.measure(&mut joint.clone(), y, &mut rows).is_err());
    assert_eq!(rows.len(), 1);
    let mut slips = Rows::new(2);
    contact.slip(&single, y, y, &mut slips).unwrap();
    assert!(contact.slip(&joint, y, y, &mut slips).is_err());
    assert_eq!(slips.len(), 1);
}

/// The mean of the tangents to several facets is shorter across a kink than along it: tangents that
/// are carried over a joint again and again stay where they are.
#[test]
fn tangents_do_not_turn_over_a_joint() {
    let (contact, y, mut pair) = in_space();
    contact.measure(&mut pair, &y, &mut Rows::new(3)).unwrap();
    pair.tangential.tangents = [[0.8, 0.6, 0.0], [-0.6, 0.8, 0.0]];
    let mut rows = Rows::new(3);
    let mut carry = |pair: &mut Pair| {
        rows.clear();
        contact.slip(pair, &y, &y, &mut rows).unwrap();
        pair.tangential.tangents = rows.tangents(0);
    };
    (0..3).for_each(|_| carry(&mut pair));
    let [along, across] = pair.tangential.tangents.map(Vector);
    for (product, expected) in
        [(along.dot(&along), 1.0), (across.dot(&across), 1.0), (along.dot(&across), 0.0)]
    {
        assert!((product - expected).abs() < 1e-14, "{product}");
    }
    // Normalising the means one after the other would turn them by half a degree.
    assert!((along[1] / along[0] - 0.75).abs() < 2e-3, "{along:?}");
    (0..1000).for_each(|_| carry(&mut pair));
    let turned = (Vector(pair.tangential.tangents[0]) - along).norm();
    assert!(turned < 1e-12, "{turned:e}");
}
