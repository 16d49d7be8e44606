//! The discrete gradient of a cell with constant strain, whose forces on two nodes are P itself.

use std::collections::BTreeMap;

use carom_algebra::{Mat, jacobian_error};
use carom_solid::{Body, Element, Law, Mesh, body, plane_stress_body};

const H: [[f64; 2]; 2] = [[0.25, -0.4], [0.35, -0.15]];
const NEXT: [[f64; 2]; 2] = [[0.31, -0.47], [0.41, -0.05]];

/// The unit triangle with corners at 0, e₁ and e₂, of volume 1.
fn triangle() -> Mesh {
    Mesh {
        element: Element::T3,
        nodes: vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].into(),
        cells: vec![0, 1, 2],
        sides: BTreeMap::new(),
        repairs: Vec::new(),
    }
}

/// Displacements whose gradient is H.
fn displacements(h: &Mat<2>) -> [f64; 6] {
    let [[a, b], [c, d]] = h.0;
    [0.0, 0.0, a, c, b, d]
}

fn moved(h: &Mat<2>) -> [f64; 6] {
    displacements(&(*h + Mat::identity()))
}

/// H of positions, with their round-off.
fn gradient(y: &[f64; 6]) -> Mat<2> {
    Mat([[y[2] - 1.0, y[4]], [y[3], y[5] - 1.0]])
}

/// P of forces fᵃ = P ∇φᵃ.
fn stress(force: &[f64; 6]) -> Mat<2> {
    let sum = [force[0] + force[2] + force[4], force[1] + force[3] + force[5]];
    assert!(sum.iter().all(|sum| sum.abs() < 1e-15));
    Mat([[force[2], force[4]], [force[3], force[5]]])
}

/// W₁ and P.
fn between(body: &dyn Body, h: [&Mat<2>; 2]) -> (f64, Mat<2>) {
    let mut force = [0.0; 6];
    let energy = body.cell_between(0, &moved(h[0]), &moved(h[1]), &mut force).unwrap();
    (energy, stress(&force))
}

fn check(body: &dyn Body, is_objective: bool) {
    let [h0, h1] = [H, NEXT].map(|h| gradient(&moved(&Mat(h))));
    let (end, p) = between(body, [&h0, &h1]);
    let energy = |h: &Mat<2>| body.cell_force(0, &moved(h), &mut [0.0; 6]).unwrap();
    assert!((end - energy(&h1)).abs() < 1e-15, "{end} {}", energy(&h1));
    let work = p.double_dot(&(h1 - h0));
    assert!((work - (end - energy(&h0))).abs() < 1e-14, "{work}");
    if is_objective {
        // P F_mᵀ is symmetric: angular momentum is conserved.
        let tau = p * (Mat::identity() + (h0 + h1) * 0.5).transposed();
        assert!((tau.0[0][1] - tau.0[1][0]).abs() < 1e-14);
        // P rotates with the body.
        let (s, c) = 0.8_f64.sin_cos();
        let q = Mat([[c, -s], [s, c]]);
        let turned = |h: &Mat<2>| q * (Mat::identity() + *h) - Mat::identity();
        let (_, other) = between(body, [&turned(&h0), &turned(&h1)]);
        let error = other - q * p;
        assert!(error.double_dot(&error).sqrt() < 1e-13);
    }
    let mut jacobian = [0.0; 16];
    for column in 0..4 {
        let (mut unit, mut product) = (Mat::ZERO, [0.0; 6]);
        unit.0[column / 2][column % 2] = 1.0;
        body.cell_product(0, Some(&moved(&h0)), &moved(&h1), &displacements(&unit), &mut product).unwrap();
        for (row, value) in stress(&product).0.as_flattened().iter().enumerate() {
            jacobian[row * 4 + column] = *value;
        }
    }
    let stress = |x: &[f64]| {
        let (_, p) = between(body, [&h0, &Mat([[x[0], x[1]], [x[2], x[3]]])]);
        p.0.as_flattened().to_vec()
    };
    let error = jacobian_error(NEXT.as_flattened(), 1e-3, stress, &jacobian);
    assert!(error < 1e-7, "{error:e}");
}

#[test]
fn work_is_the_change_of_energy_and_the_tangent_its_derivative() {
    for (law, is_objective) in [
        (Law::NeoHookean { lambda: 2.0, mu: 1.5 }, true),
        (Law::SaintVenantKirchhoff { lambda: 2.0, mu: 1.5 }, true),
        (Law::LinearElastic { lambda: 2.0, mu: 1.5 }, false),
    ] {
        check(&*body(triangle(), law, 1.0, 2.0).unwrap(), is_objective);
        check(&*plane_stress_body(triangle(), law, 1.0, 2.0).unwrap(), is_objective);
    }
}
