//! The discrete gradient of a cell with constant strain, whose forces on two nodes are P itself.

use std::collections::BTreeMap;

use carom_algebra::{Mat, jacobian_error};
use carom_solid::discrete_gradient::root;
use carom_solid::material::{Material, NeoHookean, PlaneStress, SaintVenantKirchhoff};
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
        regions: Vec::new(),
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
    check_tangent(body, [&h0, &h1], 1e-3);
}

/// P is differentiable once where the strain does not change: `step` is smaller than its change.
fn check_tangent(body: &dyn Body, [h0, h1]: [&Mat<2>; 2], step: f64) {
    let mut jacobian = [0.0; 16];
    for column in 0..4 {
        let (mut unit, mut product) = (Mat::ZERO, [0.0; 6]);
        unit.0[column / 2][column % 2] = 1.0;
        body.cell_product(0, Some(&moved(h0)), &moved(h1), &displacements(&unit), &mut product).unwrap();
        for (row, value) in stress(&product).0.as_flattened().iter().enumerate() {
            jacobian[row * 4 + column] = *value;
        }
    }
    let stress = |x: &[f64]| {
        let (_, p) = between(body, [h0, &Mat([[x[0], x[1]], [x[2], x[3]]])]);
        p.0.as_flattened().to_vec()
    };
    let error = jacobian_error(h1.0.as_flattened(), step, stress, &jacobian);
    assert!(error < 1e-8, "{error:e}");
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

/// S of a law at the strain E, from P at the triangular F with FᵀF = I + 2E.
fn second<L: Material<2>>(law: &L, e: &Mat<2>) -> Mat<2> {
    let first = (1.0 + 2.0 * e.0[0][0]).sqrt();
    let across = 2.0 * e.0[0][1] / first;
    let last = (1.0 + 2.0 * e.0[1][1] - across * across).sqrt();
    let f = Mat([[first, across], [0.0, last]]);
    let point = law.at(&(f - Mat::identity())).unwrap();
    f.inverse() * law.stress(&point)
}

/// P by the formula of Gonzalez, with W₁ − W₀ − S(E_m):ΔE as the integral of S(E) − S(E_m) along
/// the path, by 64 midpoint rules with Richardson's extrapolation.
fn reference<L: Material<2>>(law: &L, h: [&Mat<2>; 2]) -> Mat<2> {
    let strain = |h: &Mat<2>| (*h + h.transposed() + h.transposed() * *h) * 0.5;
    let f = Mat::identity() + (*h[0] + *h[1]) * 0.5;
    let raw = f.transposed() * (*h[1] - *h[0]);
    let change = (raw + raw.transposed()) * 0.5;
    let middle = (strain(h[0]) + strain(h[1])) * 0.5;
    let at_middle = second(law, &middle);
    let sum = |intervals: i32| -> f64 {
        let width = 1.0 / f64::from(intervals);
        let difference = |i: i32| {
            let along = (f64::from(i) + 0.5) * width - 0.5;
            second(law, &(middle + change * along)) - at_middle
        };
        (0..intervals).map(|i| width * difference(i).double_dot(&change)).sum()
    };
    let excess = (4.0 * sum(64) - sum(32)) / 3.0;
    f * (at_middle + change * (excess / change.double_dot(&change)))
}

/// A body that turns by half a radian while its strain changes by any amount.
fn turning(size: f64) -> [Mat<2>; 2] {
    let turned = |angle: f64, stretch: &Mat<2>| {
        let (s, c) = angle.sin_cos();
        let f = Mat([[c, -s], [s, c]]) * (Mat::identity() + *stretch);
        gradient(&moved(&(f - Mat::identity())))
    };
    let before = Mat([[0.02, 0.01], [-0.01, -0.03]]) * size.sqrt();
    let change = Mat([[0.7, -0.3], [0.5, 0.4]]) * size;
    [turned(1.0, &before), turned(1.5, &(before + change))]
}

fn check_round_off<L: Material<2>>(body: &dyn Body, law: &L) {
    for decade in 0..18 {
        let size = 10.0_f64.powf(-2.0 - 0.5 * f64::from(decade));
        let [start, end] = turning(size);
        let (_, p) = between(body, [&start, &end]);
        let error = p - reference(law, [&start, &end]);
        let error = error.double_dot(&error).sqrt();
        // The strain of a turned body has the round-off of its positions, 1e-16; Λ + 2μ is 5.
        assert!(error < 5e-15, "{error:e} for a change of {size:e}");
    }
}

/// Before the excess work was integrated, 1e-10 at changes of 1e-6.
#[test]
fn stresses_of_nearly_rigid_motion_are_accurate_to_round_off() {
    let [lambda, mu] = [2.0, 1.5];
    let laws = (NeoHookean { lambda, mu }, SaintVenantKirchhoff { lambda, mu });
    check_round_off(&*body(triangle(), Law::NeoHookean { lambda, mu }, 1.0, 2.0).unwrap(), &laws.0);
    check_round_off(&*body(triangle(), Law::SaintVenantKirchhoff { lambda, mu }, 1.0, 2.0).unwrap(), &laws.1);
    let sheet = |law| plane_stress_body(triangle(), law, 1.0, 2.0).unwrap();
    check_round_off(&*sheet(Law::NeoHookean { lambda, mu }), &PlaneStress(laws.0));
    check_round_off(&*sheet(Law::SaintVenantKirchhoff { lambda, mu }), &PlaneStress(laws.1));
}

/// The tangent of every branch, with a change of strain of 1e-2, 1e-5 and none.
#[test]
fn the_tangent_is_the_derivative_for_any_change_of_strain() {
    let law = Law::NeoHookean { lambda: 2.0, mu: 1.5 };
    for (size, step) in [(1e-2, 1e-4), (1e-5, 1e-6), (0.0, 1e-4)] {
        let [start, end] = turning(size);
        check_tangent(&*body(triangle(), law, 1.0, 2.0).unwrap(), [&start, &end], step);
        check_tangent(&*plane_stress_body(triangle(), law, 1.0, 2.0).unwrap(), [&start, &end], step);
    }
}

/// The energy of a body that turns, with strains of 1e-8: its round-off is that of the strain,
/// 1e-16, times the stress. From H alone it was that of the rotation, 1e-16 of the moduli.
#[test]
fn a_rotation_does_not_add_its_round_off_to_the_energy() {
    let [lambda, mu] = [2.0, 1.5];
    for law in [Law::NeoHookean { lambda, mu }, Law::SaintVenantKirchhoff { lambda, mu }] {
        for body in
            [body(triangle(), law, 1.0, 2.0).unwrap(), plane_stress_body(triangle(), law, 1.0, 2.0).unwrap()]
        {
            let stretch = Mat([[1.0 + 2e-8, 1e-8], [-3e-8, 1.0 - 1e-8]]);
            let energy = |angle: f64| {
                let (s, c) = angle.sin_cos();
                let turned = Mat([[c, -s], [s, c]]) * stretch;
                body.cell_force(0, &displacements(&turned), &mut [0.0; 6]).unwrap()
            };
            let straight = energy(0.0);
            for tenths in 1..60 {
                let error = energy(0.1 * f64::from(tenths)) / straight - 1.0;
                assert!(error.abs() < 1e-6, "{law:?}: {error:e}");
            }
        }
    }
}

#[test]
fn the_root_is_a_root_in_three_dimensions() {
    let e = Mat([[0.2, -0.1, 0.05], [-0.1, -0.1, 0.15], [0.05, 0.15, 0.3]]);
    let f = Mat::identity() + root(&e).unwrap();
    let error = f.transposed() * f - Mat::identity() - e * 2.0;
    assert!(error.double_dot(&error) < 1e-30);
    assert!(root(&(Mat::<3>::identity() * -0.6)).is_err());
}
