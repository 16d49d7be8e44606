//! Rubber against formulas of incompressible laws (R. S. Rivlin, Phil. Trans. R. Soc. A 241 (1948);
//! L. R. G. Treloar, The Physics of Rubber Elasticity): with the nominal stress P, stretches (λ,
//! λ₂, 1/(λ λ₂)) of a sheet, and W₁ = ∂W/∂I₁, W₂ = ∂W/∂I₂,
//!
//! ```text
//! λ P = 2 (λ² − λ₃²) (W₁ + λ₂² W₂)
//! ```
//!
//! uniaxial with λ₂ = 1/√λ, equibiaxial with λ₂ = λ, in pure shear with λ₂ = 1.

use carom_solid::material::{OfInvariants, PlaneStress, Slopes};

use super::*;

/// Λ/μ of nearly incompressible rubber.
const RATIO: f64 = 1e4;

/// P along the first axis of an incompressible sheet.
fn incompressible(of: &impl OfInvariants, [first, second]: [f64; 2]) -> f64 {
    let third = 1.0 / (first * second);
    let squares = [first, second, third].map(|stretch| stretch * stretch);
    let excess = [squares.iter().sum::<f64>() - 3.0, squares.iter().map(|s| 1.0 / s).sum::<f64>() - 3.0];
    let Slopes { first: w1, second: w2, .. } = of.at(excess);
    2.0 * (squares[0] - squares[2]) * (w1 + squares[1] * w2) / first
}

/// P of the sheet of a law of large bulk modulus, whose second stretch is free if none is given.
fn of_sheet<W: OfInvariants>(law: Isochoric<W>, first: f64, second: Option<f64>) -> f64 {
    let sheet = PlaneStress(law);
    let at = |second: f64| Mat([[first - 1.0, 0.0], [0.0, second - 1.0]]);
    let mut across = second.unwrap_or(1.0 / first.sqrt());
    if second.is_none() {
        for _ in 0..30 {
            let unit = Vector([0.0, 1.0]);
            let slope = sheet.tangent_at(&at(across), &unit, &unit).0[1][1];
            across -= sheet.stress_at(&at(across)).0[1][1] / slope;
        }
        assert!(sheet.stress_at(&at(across)).0[1][1].abs() < 1e-9);
    }
    sheet.stress_at(&at(across)).0[0][0]
}

fn agrees<W: OfInvariants>(of: W) {
    let shear = 2.0 * (of.at([0.0; 2]).first + of.at([0.0; 2]).second);
    let law = Isochoric { of, bulk: RATIO * shear };
    for stretch in [0.5_f64, 1.5, 3.0] {
        for (second, given) in [(1.0 / stretch.sqrt(), None), (stretch, Some(stretch)), (1.0, Some(1.0))] {
            let expected = incompressible(&law.of, [stretch, second]);
            let found = of_sheet(law.clone(), stretch, given);
            // J − 1 is a mean stress over K.
            let mean = stretch * expected / (RATIO * shear);
            let bound = 4.0 * (mean.abs() + 1.0 / RATIO) * expected.abs();
            assert!((found - expected).abs() < bound, "{stretch} {second}: {found} against {expected}");
        }
    }
}

#[test]
fn sheets_of_rubber_have_the_stress_of_incompressible_laws() {
    agrees(MooneyRivlin { c10: 0.4, c01: 0.1 });
    agrees(MooneyRivlin { c10: 0.5, c01: 0.0 });
    agrees(Yeoh { c10: 0.5, c20: -0.02, c30: 0.004 });
}

/// By hand: 2 (λ² − 1/λ)(C₁₀ + C₀₁/λ) is the true stress in tension.
#[test]
fn tension_of_mooney_and_rivlin_is_the_formula() {
    let of = MooneyRivlin { c10: 0.4, c01: 0.1 };
    let stretch = 3.0_f64;
    let expected = 2.0 * (9.0 - 1.0 / 3.0) * (0.4 + 0.1 / 3.0) / 3.0;
    assert!((incompressible(&of, [stretch, 1.0 / stretch.sqrt()]) - expected).abs() < 1e-14);
}

/// Pure swelling of a ball: P = 3 equal stresses K ln J/λ, whatever the isochoric energy.
#[test]
fn swelling_has_the_stress_of_the_bulk_modulus() {
    let h = Mat::<3>::identity() * 0.2;
    for found in [mooney_rivlin().stress_at(&h), yeoh().stress_at(&h)] {
        let expected = BULK * 3.0 * 1.2_f64.ln() / 1.2;
        assert!(distance(&found, &(Mat::identity() * expected)) < 1e-14);
    }
}
