//! Discrete gradient of a strain energy between two deformations (O. Gonzalez, Comput. Methods Appl. Mech. Engrg. 190 (2000) 1763–1783):
//!
//! ```text
//! P = F_m S,   S = S(E_m) + φ ΔE,   φ = [W₁ − W₀ − S(E_m):ΔE] / (ΔE:ΔE),   F_m = (F₀ + F₁)/2,   E_m = (E₀ + E₁)/2,   ΔE = E₁ − E₀ = sym(F_mᵀ ΔF)
//! ```
//!
//! so that P:ΔF = S:ΔE = W₁ − W₀ exactly, S is symmetric (moment of momentum) and turns with the body. S(E_m) comes from the law itself, S = F̂⁻¹ P(F̂)
//! with the triangular F̂ᵀF̂ = I + 2E_m, and so does its derivative: dF̂ = F̂⁻ᵀ dE has sym(F̂ᵀ dF̂) = dE, and dS = F̂⁻¹ (dP − dF̂ S).
//! A law of the small strain has a quadratic energy in H: its stress at the middle is such a gradient as it stands.

use carom_algebra::{Mat, Vector};

use crate::material::{Material, NotPositive};
use crate::points::Moduli;

/// Below this ΔE:ΔE the correction is left out: it is of third order in ΔE and would be the rounding of W divided by ‖ΔE‖.
const NO_STRAIN: f64 = 1e-12;

/// W₁, P, and ∂P/∂F₁, which is not symmetric: F_m stands on its left, F₁ on its right.
#[inline(always)]
pub(crate) fn between<const D: usize, L: Material<D>>(
    law: &L,
    h: [&Mat<D>; 2],
    with_moduli: bool,
) -> Result<(f64, Mat<D>, Option<Moduli<D>>), NotPositive> {
    let ends = [law.at(h[0])?, law.at(h[1])?];
    let [start, end] = ends.each_ref().map(|point| law.energy(point));
    let middle = (*h[0] + *h[1]) * 0.5;
    if !L::OBJECTIVE {
        let point = law.at(&middle)?;
        let moduli = with_moduli.then(|| scaled(moduli_of(law, &point), 0.5));
        return Ok((end, law.stress(&point), moduli));
    }
    let f_middle = Mat::identity() + middle;
    let change = symmetric(&(f_middle.transposed() * (*h[1] - *h[0])));
    let [e0, e1] = h.map(strain);
    let excess = root(&((e0 + e1) * 0.5)).ok_or(NotPositive(0.0))?;
    let point = law.at(&excess)?;
    let inverse = (Mat::identity() + excess).inverse();
    let at_middle = symmetric(&(inverse * law.stress(&point)));
    let square = change.double_dot(&change);
    let correct = square > NO_STRAIN;
    let phi = if correct { (end - start - at_middle.double_dot(&change)) / square } else { 0.0 };
    let s = at_middle + change * phi;
    let stress = f_middle * s;
    if !with_moduli {
        return Ok((end, stress, None));
    }

    let (f_end, p_end) = (Mat::identity() + *h[1], law.stress(&ends[1]));
    let of_law = moduli_of(law, &point);
    let mut moduli = [[Mat::ZERO; D]; D];
    for j in 0..D {
        for l in 0..D {
            let mut unit = Mat::ZERO;
            unit.0[j][l] = 1.0;
            let de = symmetric(&(f_end.transposed() * unit));
            let df = inverse.transposed() * (de * 0.5);
            let mut ds = inverse * (contracted(&of_law, &df) - df * at_middle);
            let mut dphi = 0.0;
            if correct {
                let numerator = p_end.0[j][l] - at_middle.double_dot(&de) - ds.double_dot(&change);
                dphi = (numerator - 2.0 * phi * change.double_dot(&de)) / square;
            }
            ds = ds + change * dphi + de * phi;
            let dp = unit * s * 0.5 + f_middle * ds;
            for big_j in 0..D {
                for i in 0..D {
                    moduli[big_j][l].0[i][j] = dp.0[i][big_j];
                }
            }
        }
    }
    Ok((end, stress, Some(moduli)))
}

/// ∂P/∂F of the law at a point.
#[inline(always)]
pub(crate) fn moduli_of<const D: usize, L: Material<D>>(law: &L, point: &L::Point) -> Moduli<D> {
    let unit = Mat::<D>::identity().0.map(Vector);
    let mut moduli = [[Mat::ZERO; D]; D];
    for j in 0..D {
        for l in 0..D {
            moduli[j][l] = law.tangent(point, &unit[j], &unit[l]);
        }
    }
    moduli
}

/// The part of the moduli that has a symmetric tangent.
#[inline(always)]
pub(crate) fn symmetric_part<const D: usize>(moduli: &Moduli<D>) -> Moduli<D> {
    std::array::from_fn(|j| std::array::from_fn(|l| (moduli[j][l] + moduli[l][j].transposed()) * 0.5))
}

#[inline(always)]
fn scaled<const D: usize>(moduli: Moduli<D>, factor: f64) -> Moduli<D> {
    moduli.map(|row| row.map(|block| block * factor))
}

/// ∂P/∂F : dF.
#[inline(always)]
pub(crate) fn contracted<const D: usize>(moduli: &Moduli<D>, df: &Mat<D>) -> Mat<D> {
    let mut dp = Mat::ZERO;
    for (j, row) in moduli.iter().enumerate() {
        for (l, block) in row.iter().enumerate() {
            for i in 0..D {
                dp.0[i][j] += (0..D).map(|k| block.0[i][k] * df.0[k][l]).sum::<f64>();
            }
        }
    }
    dp
}

#[inline(always)]
fn symmetric<const D: usize>(a: &Mat<D>) -> Mat<D> {
    (*a + a.transposed()) * 0.5
}

/// E = (H + Hᵀ + HᵀH)/2.
#[inline(always)]
fn strain<const D: usize>(h: &Mat<D>) -> Mat<D> {
    (*h + h.transposed() + h.transposed() * *h) * 0.5
}

/// F̂ − I with F̂ upper triangular and F̂ᵀF̂ = I + 2E (Cholesky); √(1 + x) − 1 = x/(1 + √(1 + x)) keeps the digits of a small E.
#[inline(always)]
fn root<const D: usize>(e: &Mat<D>) -> Option<Mat<D>> {
    let mut h = Mat::ZERO;
    for i in 0..D {
        for j in i..D {
            let known: f64 = (0..i).map(|k| h.0[k][i] * h.0[k][j]).sum();
            let rest = 2.0 * e.0[i][j] - known;
            if i == j {
                let diagonal = (1.0 + rest).sqrt();
                if diagonal.is_nan() || diagonal <= 0.0 {
                    return None;
                }
                h.0[i][i] = rest / (1.0 + diagonal);
            } else {
                h.0[i][j] = rest / (1.0 + h.0[i][i]);
            }
        }
    }
    Some(h)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{LinearElastic, NeoHookean, PlaneStress, SaintVenantKirchhoff};
    use carom_algebra::jacobian_error;

    const H: [[f64; 2]; 2] = [[0.25, -0.4], [0.35, -0.15]];
    const NEXT: [[f64; 2]; 2] = [[0.31, -0.47], [0.41, -0.05]];

    fn check<L: Material<2>>(law: &L) {
        let (h0, h1) = (Mat(H), Mat(NEXT));
        let (end, p, moduli) = between(law, [&h0, &h1], true).unwrap();
        let energy = |h: &Mat<2>| law.energy(&law.at(h).ok().unwrap());
        assert_eq!(end, energy(&h1));
        let work = p.double_dot(&(h1 - h0));
        assert!((work - (end - energy(&h0))).abs() < 1e-14, "{work}");
        // P F_mᵀ symmetric: no moment.
        if L::OBJECTIVE {
            let kirchhoff = p * (Mat::identity() + (h0 + h1) * 0.5).transposed();
            assert!((kirchhoff.0[0][1] - kirchhoff.0[1][0]).abs() < 1e-14);
        }
        // Turned as a whole, P turns along.
        let (s, c) = 0.8_f64.sin_cos();
        let q = Mat([[c, -s], [s, c]]);
        let turned = |h: &Mat<2>| q * (Mat::identity() + *h) - Mat::identity();
        if L::OBJECTIVE {
            let (_, other, _) = between(law, [&turned(&h0), &turned(&h1)], false).unwrap();
            let error = other - q * p;
            assert!(error.double_dot(&error).sqrt() < 1e-13);
        }
        let moduli = moduli.unwrap();
        let mut jacobian = [0.0; 16];
        for i in 0..2 {
            for big_j in 0..2 {
                for j in 0..2 {
                    for l in 0..2 {
                        jacobian[(i * 2 + big_j) * 4 + j * 2 + l] = moduli[big_j][l].0[i][j];
                    }
                }
            }
        }
        let stress = |x: &[f64]| {
            let (_, p, _) = between(law, [&h0, &Mat([[x[0], x[1]], [x[2], x[3]]])], false).unwrap();
            p.0.as_flattened().to_vec()
        };
        let error = jacobian_error(NEXT.as_flattened(), 1e-3, stress, &jacobian);
        assert!(error < 1e-7, "{error:e}");
    }

    #[test]
    fn work_is_the_change_of_energy_and_the_tangent_its_derivative() {
        check(&NeoHookean { lambda: 2.0, mu: 1.5 });
        check(&SaintVenantKirchhoff { lambda: 2.0, mu: 1.5 });
        check(&LinearElastic { lambda: 2.0, mu: 1.5 });
        check(&PlaneStress(NeoHookean { lambda: 2.0, mu: 1.5 }));
        check(&PlaneStress(SaintVenantKirchhoff { lambda: 2.0, mu: 1.5 }));
        check(&PlaneStress(LinearElastic { lambda: 2.0, mu: 1.5 }));
    }

    #[test]
    fn the_root_is_a_root_in_three_dimensions() {
        let e = Mat([[0.2, -0.1, 0.05], [-0.1, -0.1, 0.15], [0.05, 0.15, 0.3]]);
        let f = Mat::identity() + root(&e).unwrap();
        let error = f.transposed() * f - Mat::identity() - e * 2.0;
        assert!(error.double_dot(&error) < 1e-30);
        assert!(root(&(Mat::<3>::identity() * -0.6)).is_none());
    }
}
