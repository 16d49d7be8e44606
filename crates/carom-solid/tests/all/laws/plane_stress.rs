//! Laws in plane stress: derivatives, objectivity, zero out-of-plane stress, uniaxial tension in
//! closed form.

use carom_solid::Past;
use carom_solid::material::{PlaneStress, Thickness, excess_det};

use super::*;

const YOUNG: f64 = MU * (3.0 * LAMBDA + 2.0 * MU) / (LAMBDA + MU);
const POISSON: f64 = LAMBDA / (2.0 * (LAMBDA + MU));

/// The out-of-plane stress is zero, and the Cauchy stress is that of the three-dimensional law at
/// the solved stretch.
fn free_across<L: Thickness + Copy>(law: &L, h: &Mat<2>) {
    let across = law.excess_stretch(h).unwrap();
    let [[a, b], [c, d]] = h.0;
    let wide = Mat([[a, b, 0.0], [c, d, 0.0], [0.0, 0.0, across]]);
    let point = Material::<3>::at(law, &wide).unwrap();
    let cauchy = Material::<3>::cauchy(law, &point, &wide);
    let p = Material::<3>::stress(law, &point);
    assert!(p.0[2][2].abs() < 1e-14, "{:e}", p.0[2][2]);
    let plane = PlaneStress(*law);
    let sheet = plane.at(h).unwrap();
    for i in 0..2 {
        for j in 0..2 {
            assert_eq!(plane.cauchy(&sheet, h).0[i][j], cauchy.0[i][j]);
        }
    }
    assert!((plane.volume_ratio(h, &Past::default()) - (1.0 + excess_det(&wide))).abs() < 1e-15);
}

/// All laws in plane stress; the first one alone is not objective.
fn sheets() -> [Box<dyn AtPoint<2>>; 6] {
    [
        Box::new(PlaneStress(linear_elastic())),
        Box::new(PlaneStress(neo_hookean())),
        Box::new(PlaneStress(saint_venant_kirchhoff())),
        Box::new(PlaneStress(hencky())),
        Box::new(PlaneStress(mooney_rivlin())),
        Box::new(PlaneStress(yeoh())),
    ]
}

#[test]
fn stress_and_condensed_tangent_are_derivatives() {
    lists(256, 4, &|x| sheets().iter().for_each(|law| derivatives(&**law, &matrix(x, 0.2))));
}

#[test]
fn rotations_turn_the_stress() {
    lists(256, 5, &|x| {
        let (s, c) = f64::sin_cos(3.0 * x[4]);
        let q = Mat([[c, -s], [s, c]]);
        sheets().iter().skip(1).for_each(|law| objectivity(&**law, &matrix(x, 0.2), &q));
    });
}

#[test]
fn nothing_presses_across() {
    lists(256, 4, &|x| {
        free_across(&neo_hookean(), &matrix(x, 0.3));
        free_across(&saint_venant_kirchhoff(), &matrix(x, 0.3));
        free_across(&linear_elastic(), &matrix(x, 0.3));
        free_across(&hencky(), &matrix(x, 0.3));
        free_across(&mooney_rivlin(), &matrix(x, 0.3));
        free_across(&yeoh(), &matrix(x, 0.3));
    });
}

#[test]
fn small_motions_are_hooke_s() {
    lists(256, 4, &|x| {
        let h = matrix::<2>(x, 1e-9);
        let [linear, others @ ..] = sheets();
        let hooke = linear.stress_at(&h);
        let size = MU * h.double_dot(&h).sqrt();
        for law in others {
            assert!(distance(&law.stress_at(&h), &hooke) < 3e-8 * size);
        }
    });
}

/// The thickness is found for any plane stretch: the neo-Hookean root over twelve decades of J,
/// nearly incompressible and foam-like.
#[test]
fn extreme_stretches_have_a_thickness() {
    for lambda in [0.0, 1e-3, 2.0, 1e6] {
        for stretch in [1e-6, 1e-3, 0.1, 10.0, 1e3, 1e6] {
            let law = NeoHookean { lambda, mu: MU };
            let h = Mat([[stretch - 1.0, 0.0], [0.0, 0.0]]);
            let f33 = 1.0 + law.excess_stretch(&h).unwrap();
            let terms = [MU * (f33 * f33 - 1.0), lambda * excess_det(&h).ln_1p(), lambda * f33.ln()];
            let size = terms.iter().map(|t| t.abs()).sum::<f64>().max(f64::MIN_POSITIVE);
            // The excess over 1 resolves a small thickness only to ε/f₃₃.
            let rounding = f64::EPSILON * (lambda + MU) / f33;
            assert!(terms.iter().sum::<f64>().abs() < 1e-12 * size + rounding, "{lambda} {stretch}: {f33}");
        }
    }
    let svk = saint_venant_kirchhoff();
    assert_eq!(svk.excess_stretch(&Mat([[3.0, 0.0], [0.0, 3.0]])), Err(NotPositive(0.0)));
    assert_eq!(neo_hookean().excess_stretch(&Mat([[-2.0, 0.0], [0.0, 0.0]])), Err(NotPositive(-1.0)));
}

/// A strip under tension along x: lateral stretch x₂ = x₃ in closed form, P₁₁ and σ₁₁ = P₁₁/(x₂x₃).
#[test]
fn uniaxial_tension() {
    let check = |law: &dyn AtPoint<2>, along: f64, lateral: f64, p11: f64, area: f64| {
        let h = Mat([[along - 1.0, 0.0], [0.0, lateral - 1.0]]);
        let p = law.stress_at(&h);
        let cauchy = law.cauchy_at(&h);
        assert!((p.0[0][0] - p11).abs() < 1e-13, "{} for {p11}", p.0[0][0]);
        assert!(p.0[1][1].abs() < 1e-13, "{:e}", p.0[1][1]);
        assert!((cauchy.0[0][0] - p11 / area).abs() < 1e-13 && cauchy.0[1][1].abs() < 1e-13);
    };
    for strain in [-0.2, 0.1, 0.4] {
        check(&PlaneStress(linear_elastic()), 1.0 + strain, 1.0 - POISSON * strain, YOUNG * strain, 1.0);

        let green: f64 = strain;
        let (along, lateral) = ((1.0 + 2.0 * green).sqrt(), (1.0 - 2.0 * POISSON * green).sqrt());
        check(
            &PlaneStress(saint_venant_kirchhoff()),
            along,
            lateral,
            along * YOUNG * green,
            lateral * lateral,
        );

        // Λ ln(x₁x²) = −μ(x² − 1) gives x₁ from the lateral stretch x.
        let x = 1.0 - 0.4 * strain;
        let along = (-MU * (x * x - 1.0) / LAMBDA - 2.0 * x.ln()).exp();
        let p11 = MU * (along - 1.0 / along) + LAMBDA * (along * x * x).ln() / along;
        check(&PlaneStress(neo_hookean()), along, x, p11, x * x);
    }
}
