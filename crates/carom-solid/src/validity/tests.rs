//! The shorter formula of simplices of degree 1.

use super::*;
use crate::shape::{Quad4, Tet4, Tet10, Tri3};

/// Compiled once for each shape.
#[inline(never)]
fn margin<const D: usize, const N: usize>(
    test: &Validity<D, N>,
    nodes: &[Vector<D>; N],
) -> Result<f64, Loss<D>> {
    test.margin(nodes)
}

/// The determinant of edges alone gives the bits of the general formula.
#[test]
fn cells_of_degree_one_have_the_margin_of_their_edges() {
    fn check<const D: usize, const N: usize, S: Shape<D, N>>() {
        let test = Validity::<D, N>::of::<S>();
        assert!(test.is_affine);
        let general = Validity { is_affine: false, ..test.clone() };
        let mut nodes = S::NODES;
        for (a, node) in nodes.iter_mut().enumerate() {
            (0..D).for_each(|i| node[i] += 0.1 * (3.7 * a as f64 + 1.3 * i as f64).sin() + 5.0);
        }
        assert_eq!(margin(&test, &nodes), margin(&general, &nodes));
        assert!(margin(&test, &nodes).unwrap() > 0.0);
        nodes.swap(0, 1);
        assert!(margin(&test, &nodes).is_err());
        assert_eq!(margin(&test, &nodes), margin(&general, &nodes));
    }
    check::<2, 3, Tri3>();
    check::<3, 4, Tet4>();
    assert!(!Validity::<2, 4>::of::<Quad4>().is_affine && !Validity::<3, 10>::of::<Tet10>().is_affine);
}
