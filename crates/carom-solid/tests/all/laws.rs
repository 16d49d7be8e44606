//! Every law in every dimension: energy → stress → tangent by differences, objectivity, the
//! undeformed state, small displacements, J ≤ 0.

use carom_algebra::{Four, Mat, Vector};
use carom_solid::material::{
    Hencky, Isochoric, LinearElastic, Material, MooneyRivlin, NeoHookean, NotPositive, SaintVenantKirchhoff,
    Yeoh,
};

use super::random::lists;

mod plane_stress;
mod plastic;
mod rubber;

const LAMBDA: f64 = 2.0;
const MU: f64 = 1.5;

fn neo_hookean() -> NeoHookean {
    NeoHookean { lambda: LAMBDA, mu: MU }
}

fn saint_venant_kirchhoff() -> SaintVenantKirchhoff {
    SaintVenantKirchhoff { lambda: LAMBDA, mu: MU }
}

fn hencky() -> Hencky {
    Hencky { lambda: LAMBDA, mu: MU }
}

const BULK: f64 = LAMBDA + 2.0 * MU / 3.0;

fn mooney_rivlin() -> Isochoric<MooneyRivlin> {
    Isochoric { of: MooneyRivlin { c10: 0.3 * MU, c01: 0.2 * MU }, bulk: BULK }
}

fn yeoh() -> Isochoric<Yeoh> {
    Isochoric { of: Yeoh { c10: 0.5 * MU, c20: -0.1, c30: 0.3 }, bulk: BULK }
}

fn linear_elastic() -> LinearElastic {
    LinearElastic { lambda: LAMBDA, mu: MU }
}

/// A law behind a pointer, evaluated at H: a test is compiled once for all laws of a dimension.
trait AtPoint<const D: usize> {
    fn energy_at(&self, h: &Mat<D>) -> f64;
    fn stress_at(&self, h: &Mat<D>) -> Mat<D>;
    fn tangent_at(&self, h: &Mat<D>, a: &Vector<D>, b: &Vector<D>) -> Mat<D>;
    fn cauchy_at(&self, h: &Mat<D>) -> Mat<D>;
    fn lateral_at(&self, h: &Mat<D>) -> f64;
    fn error_at(&self, h: &Mat<D>) -> Option<NotPositive>;
}

impl<const D: usize, L: Material<D>> AtPoint<D> for L {
    fn energy_at(&self, h: &Mat<D>) -> f64 {
        self.energy(&self.at(h).unwrap())
    }

    fn stress_at(&self, h: &Mat<D>) -> Mat<D> {
        self.stress(&self.at(h).unwrap())
    }

    fn tangent_at(&self, h: &Mat<D>, a: &Vector<D>, b: &Vector<D>) -> Mat<D> {
        self.tangent(&self.at(h).unwrap(), a, b)
    }

    fn cauchy_at(&self, h: &Mat<D>) -> Mat<D> {
        self.cauchy(&self.at(h).unwrap(), h)
    }

    fn lateral_at(&self, h: &Mat<D>) -> f64 {
        self.lateral(&self.at(h).unwrap())
    }

    fn error_at(&self, h: &Mat<D>) -> Option<NotPositive> {
        self.at(h).err()
    }
}

/// All laws; the first one alone is not objective.
fn laws<const D: usize>() -> [Box<dyn AtPoint<D>>; 6] {
    [
        Box::new(linear_elastic()),
        Box::new(neo_hookean()),
        Box::new(saint_venant_kirchhoff()),
        Box::new(hencky()),
        Box::new(mooney_rivlin()),
        Box::new(yeoh()),
    ]
}

fn objective_laws<const D: usize>() -> impl Iterator<Item = Box<dyn AtPoint<D>>> {
    laws().into_iter().skip(1)
}

fn distance<const D: usize>(a: &Mat<D>, b: &Mat<D>) -> f64 {
    let e = *a - *b;
    e.double_dot(&e).sqrt()
}

/// Derivative of a scalar function by sixth-order central differences.
fn slope(h: f64, f: &dyn Fn(f64) -> f64) -> f64 {
    let d = |m: f64| f(m * h) - f(-m * h);
    (45.0 * d(1.0) - 9.0 * d(2.0) + d(3.0)) / (60.0 * h)
}

fn derivatives<const D: usize>(law: &dyn AtPoint<D>, h: &Mat<D>) {
    let p = law.stress_at(h);
    let moved = |i: usize, j: usize, s: f64| {
        let mut m = *h;
        m.0[i][j] += s;
        m
    };
    for i in 0..D {
        for j in 0..D {
            let expected = slope(2e-3, &|s| law.energy_at(&moved(i, j, s)));
            assert!((expected - p.0[i][j]).abs() < 1e-9, "P{i}{j} is {}, ∂Ψ/∂F {expected}", p.0[i][j]);
        }
    }
    let unit = Mat::<D>::identity().0.map(Vector);
    for column in 0..D {
        for l in 0..D {
            for i in 0..D {
                for k in 0..D {
                    let expected = slope(2e-3, &|s| law.stress_at(&moved(column, l, s)).0[i][k]);
                    let block = law.tangent_at(h, &unit[k], &unit[l]);
                    assert!(
                        (expected - block.0[i][column]).abs() < 1e-8,
                        "{expected} against {}",
                        block.0[i][column]
                    );
                }
            }
        }
    }
    let a = Vector(std::array::from_fn(|i| 0.3 + i as f64));
    let b = Vector(std::array::from_fn(|i| 0.7 - 0.4 * i as f64));
    let symmetric = law.tangent_at(h, &a, &b) - law.tangent_at(h, &b, &a).transposed();
    assert!(symmetric.double_dot(&symmetric).sqrt() < 1e-13);
}

fn objectivity<const D: usize>(law: &dyn AtPoint<D>, h: &Mat<D>, q: &Mat<D>) {
    let f = Mat::identity() + *h;
    let turned = *q * f - Mat::identity();
    assert!((law.energy_at(&turned) - law.energy_at(h)).abs() < 1e-13);
    assert!(distance(&law.stress_at(&turned), &(*q * law.stress_at(h))) < 1e-13);
    let expected = *q * law.cauchy_at(h) * q.transposed();
    assert!(distance(&law.cauchy_at(&turned), &expected) < 1e-13);
    assert!((law.lateral_at(&turned) - law.lateral_at(h)).abs() < 1e-13);
}

/// The same deformation padded to three dimensions gives the same energy and the same Cauchy stress
/// with its lateral component.
fn padded<const D: usize>(x: &[f64]) {
    let h = matrix::<D>(x, 0.2);
    let wide =
        Mat(std::array::from_fn(|i| std::array::from_fn(|j| if i < D && j < D { h.0[i][j] } else { 0.0 })));
    for (law, in_space) in laws::<D>().iter().zip(laws::<3>()) {
        assert!((in_space.energy_at(&wide) - law.energy_at(&h)).abs() < 1e-14);
        let solid = in_space.cauchy_at(&wide);
        let plane = law.cauchy_at(&h);
        for i in 0..3 {
            for j in 0..3 {
                let expected = match (i < D && j < D, i == j) {
                    (true, _) => plane.0[i][j],
                    (false, true) => law.lateral_at(&h),
                    (false, false) => 0.0,
                };
                assert!((solid.0[i][j] - expected).abs() < 1e-14);
            }
        }
    }
}

fn rotation(angles: [f64; 3]) -> Mat<3> {
    let about = |axis: usize, angle: f64| {
        let (s, c) = angle.sin_cos();
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut q = Mat::<3>::identity();
        (q.0[i][i], q.0[j][j], q.0[i][j], q.0[j][i]) = (c, c, -s, s);
        q
    };
    about(0, angles[0]) * about(1, angles[1]) * about(2, angles[2])
}

/// The first entries times a factor.
fn matrix<const D: usize>(entries: &[f64], factor: f64) -> Mat<D> {
    Mat(std::array::from_fn(|i| std::array::from_fn(|j| factor * entries[i * D + j])))
}

#[test]
fn stress_and_tangent_are_derivatives() {
    fn in_dimension<const D: usize>(x: &[f64]) {
        laws::<D>().iter().for_each(|law| derivatives(&**law, &matrix(x, 0.2)));
    }
    lists(256, 9, &|x| {
        in_dimension::<1>(x);
        in_dimension::<2>(x);
        in_dimension::<3>(x);
    });
}

#[test]
fn rotations_turn_the_stress_and_keep_the_energy() {
    lists(256, 11, &|x| {
        let [a, b] = [3.0 * x[9], 3.0 * x[10]];
        let (s, c) = f64::sin_cos(a);
        let q = Mat([[c, -s], [s, c]]);
        objective_laws::<2>().for_each(|law| objectivity(&*law, &matrix(x, 0.2), &q));
        let q = rotation([a, b, 0.7]);
        objective_laws::<3>().for_each(|law| objectivity(&*law, &matrix(x, 0.2), &q));
    });
}

#[test]
fn fewer_dimensions_are_the_law_in_three_without_strain_across() {
    lists(256, 4, &|x| {
        padded::<1>(x);
        padded::<2>(x);
    });
}

#[test]
fn small_motions_keep_their_digits() {
    lists(256, 9, &|x| {
        // To first order every law is Hooke's; at 1e-9 the relative remainder is 1e-9.
        let h = matrix::<3>(x, 1e-9);
        let hooke = linear_elastic().stress_at(&h);
        let energy_hooke = linear_elastic().energy_at(&h);
        let size = hooke.double_dot(&hooke).sqrt() + MU * h.double_dot(&h).sqrt();
        for law in objective_laws::<3>() {
            assert!(distance(&law.stress_at(&h), &hooke) < 3e-8 * size);
            assert!((law.energy_at(&h) - energy_hooke).abs() < 1e-7 * MU * h.double_dot(&h));
        }
    });
}

#[test]
fn the_undeformed_state_has_no_stress_and_no_energy() {
    fn at_rest<const D: usize>() {
        for law in laws::<D>() {
            assert_eq!(law.energy_at(&Mat::ZERO), 0.0);
            assert_eq!(law.stress_at(&Mat::ZERO), Mat::ZERO);
        }
    }
    at_rest::<1>();
    at_rest::<2>();
    at_rest::<3>();
}

/// cos 1e-9 − 1 = −5e-19 is lost in F, not in H.
#[test]
fn a_small_rotation_is_no_strain() {
    let (s, c) = (1e-9_f64.sin(), -2.0 * 0.5e-9_f64.sin().powi(2));
    let h = Mat([[c, -s], [s, c]]);
    for law in objective_laws() {
        assert!(distance(&law.stress_at(&h), &Mat::ZERO) < 1e-33);
    }
}

#[test]
fn inversion_is_an_error_that_says_j() {
    for law in objective_laws() {
        assert_eq!(law.error_at(&Mat([[-1.5, 0.0], [0.0, 0.0]])), Some(NotPositive(-0.5)));
        assert!(law.error_at(&Mat([[f64::NAN, 0.0], [0.0, 0.0]])).is_some());
    }
    for law in objective_laws() {
        assert!(law.error_at(&Mat([[-1.0]])).is_some());
    }
}

#[test]
fn a_linear_bar_without_lateral_contraction_has_young_s_modulus() {
    let law = LinearElastic { lambda: 0.0, mu: 450.0 };
    assert_eq!(law.stress_at(&Mat([[1e-3]])).0[0][0], 0.9);
}

/// Uniaxial stretch in closed form: P = μ(F − 1/F) + Λ ln F / F.
#[test]
fn neo_hookean_stretch_matches_the_scalar_formula() {
    let f = 1.3_f64;
    let expected = MU * (f - 1.0 / f) + LAMBDA * f.ln() / f;
    assert!((neo_hookean().stress_at(&Mat([[f - 1.0]])).0[0][0] - expected).abs() < 1e-15);
}

/// Uniaxial strain in closed form: P = (Λ + 2μ) ln F / F; and a large shear against the strain of
/// its principal stretches, ln λ with λ − 1/λ = γ.
#[test]
fn hencky_stretch_and_shear_match_scalar_formulas() {
    let f = 1.3_f64;
    let expected = (LAMBDA + 2.0 * MU) * f.ln() / f;
    assert!((hencky().stress_at(&Mat([[f - 1.0]])).0[0][0] - expected).abs() < 1e-15);
    let gamma = 3.0_f64;
    let strain = (0.5 * gamma).asinh();
    let h = Mat([[0.0, gamma], [0.0, 0.0]]);
    assert!((hencky().energy_at(&h) - 2.0 * MU * strain * strain).abs() < 1e-13);
    // τ₁₂ = 2μ ln λ sin 2θ of the axis of b: tan 2θ = 2/γ.
    let shear = 2.0 * MU * strain * 2.0 / (4.0 + gamma * gamma).sqrt();
    assert!((hencky().cauchy_at(&h).0[0][1] - shear).abs() < 1e-14);
}
