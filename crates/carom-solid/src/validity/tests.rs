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

/// It certifies what the general formula certifies, and nodes may move as far as it says: to every
/// corner of the box of displacements, where the test of the general formula holds again.
#[test]
fn cells_of_degree_one_have_a_margin_of_their_own() {
    fn check<const D: usize, const N: usize, S: Shape<D, N>>(at_least: f64) {
        let test = Validity::<D, N>::of::<S>();
        assert!(test.is_affine);
        let general = Validity { is_affine: false, ..test.clone() };
        let mut nodes = S::NODES;
        for (a, node) in nodes.iter_mut().enumerate() {
            (0..D).for_each(|i| node[i] += 0.1 * (3.7 * a as f64 + 1.3 * i as f64).sin() + 5.0);
        }
        let found = margin(&test, &nodes).unwrap();
        assert!(found > at_least * margin(&general, &nodes).unwrap());
        for corner in 0..1_usize << (N * D) {
            let mut moved = nodes;
            for (k, x) in moved.iter_mut().flat_map(|node| &mut node.0).enumerate() {
                *x += if corner >> k & 1 == 1 { found } else { -found };
            }
            assert!(margin(&general, &moved).is_ok() && margin(&test, &moved).is_ok(), "{corner:b}");
        }
        // A sliver that is valid may not move at all.
        let mut flat = S::NODES;
        flat[N - 1][D - 1] *= 1e-10;
        assert_eq!(margin(&test, &flat), Ok(0.0));
        nodes.swap(0, 1);
        assert!(margin(&test, &nodes).is_err());
        assert_eq!(margin(&test, &nodes), margin(&general, &nodes));
    }
    check::<2, 3, Tri3>(0.8);
    check::<3, 4, Tet4>(20.0);
    assert!(!Validity::<2, 4>::of::<Quad4>().is_affine && !Validity::<3, 10>::of::<Tet10>().is_affine);
}
