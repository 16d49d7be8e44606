//! Discrete gradient of a strain energy between two deformations (O. Gonzalez, Comput. Methods
//! Appl. Mech. Engrg. 190 (2000) 1763–1783):
//!
//! ```text
//! P = F_m S,   S = S(E_m) + φ ΔE,   φ = [W₁ − W₀ − S(E_m):ΔE] / (ΔE:ΔE),   F_m = (F₀ + F₁)/2,   E_m = (E₀ + E₁)/2,   ΔE = E₁ − E₀ = sym(F_mᵀ ΔF)
//! ```
//!
//! so that P:ΔF = S:ΔE = W₁ − W₀ exactly, and S is symmetric (angular momentum) and objective.
//! S(E_m) comes from the law itself, S = F̂⁻¹ P(F̂) with the triangular F̂ᵀF̂ = I + 2E_m, and so
//! does its derivative: dF̂ = F̂⁻ᵀ dE has sym(F̂ᵀ dF̂) = dE, and dS = F̂⁻¹ (dP − dF̂ S). For small
//! strains the energy is quadratic in H, and the stress at the midpoint is a discrete gradient
//! already.

use carom_algebra::Mat;

use crate::material::{Material, NotPositive};

/// Below this ΔE:ΔE the correction is omitted: it is of third order in ΔE and would amount to the
/// round-off of W divided by ‖ΔE‖.
const NO_STRAIN: f64 = 1e-12;

/// W₁ and P. Not inlined: the cost of a call is small in comparison.
#[inline(never)]
pub(crate) fn between<const D: usize, L: Material<D>>(
    law: &L,
    h: [&Mat<D>; 2],
) -> Result<(f64, Mat<D>), NotPositive> {
    if L::OBJECTIVE {
        return Middle::new(law, h).map(|middle| (middle.energy, middle.f * middle.s));
    }
    let (end, middle) = (law.at(h[1])?, law.at(&((*h[0] + *h[1]) * 0.5))?);
    Ok((law.energy(&end), law.stress(&middle)))
}

/// ∂P/∂F₁ : dF₁. It is not symmetric: F_m multiplies from the left, F₁ from the right.
#[inline(never)]
pub(crate) fn change_between<const D: usize, L: Material<D>>(
    law: &L,
    h: [&Mat<D>; 2],
    dh: &Mat<D>,
) -> Result<Mat<D>, NotPositive> {
    if !L::OBJECTIVE {
        let point = law.at(&((*h[0] + *h[1]) * 0.5))?;
        return Ok(law.change(&point, &(*dh * 0.5)));
    }
    let Middle { f, point, inverse, of_law, change, square, phi, s, .. } = Middle::new(law, h)?;
    let de = symmetric(&((Mat::identity() + *h[1]).transposed() * *dh));
    let df = inverse.transposed() * (de * 0.5);
    let mut ds = inverse * (law.change(&point, &df) - df * of_law);
    if square > NO_STRAIN {
        let end = law.stress(&law.at(h[1])?);
        let numerator = end.double_dot(dh) - of_law.double_dot(&de) - ds.double_dot(&change);
        let dphi = (numerator - 2.0 * phi * change.double_dot(&de)) / square;
        ds = ds + change * dphi + de * phi;
    }
    Ok(*dh * s * 0.5 + f * ds)
}

/// Terms of the formulas above.
struct Middle<const D: usize, P> {
    /// W₁.
    energy: f64,
    f: Mat<D>,
    /// The law at F̂, and F̂⁻¹.
    point: P,
    inverse: Mat<D>,
    /// S(E_m).
    of_law: Mat<D>,
    /// ΔE and ΔE:ΔE.
    change: Mat<D>,
    square: f64,
    phi: f64,
    s: Mat<D>,
}

impl<const D: usize, P> Middle<D, P> {
    #[inline(always)]
    fn new<L: Material<D, Point = P>>(law: &L, h: [&Mat<D>; 2]) -> Result<Self, NotPositive> {
        let [start, energy] = [law.at(h[0])?, law.at(h[1])?].map(|point| law.energy(&point));
        let f = Mat::identity() + (*h[0] + *h[1]) * 0.5;
        let change = symmetric(&(f.transposed() * (*h[1] - *h[0])));
        let [e0, e1] = h.map(strain);
        let excess = root(&((e0 + e1) * 0.5)).ok_or(NotPositive(0.0))?;
        let point = law.at(&excess)?;
        let inverse = (Mat::identity() + excess).inverse();
        let of_law = symmetric(&(inverse * law.stress(&point)));
        let square = change.double_dot(&change);
        let excess_work = energy - start - of_law.double_dot(&change);
        let phi = if square > NO_STRAIN { excess_work / square } else { 0.0 };
        Ok(Self { energy, f, point, inverse, of_law, change, square, phi, s: of_law + change * phi })
    }
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

/// F̂ − I with F̂ upper triangular and F̂ᵀF̂ = I + 2E (Cholesky); √(1 + x) − 1 = x/(1 + √(1 + x))
/// avoids cancellation for small E.
#[inline(always)]
fn root<const D: usize>(e: &Mat<D>) -> Option<Mat<D>> {
    let mut h = Mat::ZERO;
    for i in 0..D {
        for j in i..D {
            let known: f64 = (0..i).map(|k| h.0[k][i] * h.0[k][j]).sum();
            let remainder = 2.0 * e.0[i][j] - known;
            if i == j {
                let diagonal = (1.0 + remainder).sqrt();
                if diagonal.is_nan() || diagonal <= 0.0 {
                    return None;
                }
                h.0[i][i] = remainder / (1.0 + diagonal);
            } else {
                h.0[i][j] = remainder / (1.0 + h.0[i][i]);
            }
        }
    }
    Some(h)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_is_a_root_in_three_dimensions() {
        let e = Mat([[0.2, -0.1, 0.05], [-0.1, -0.1, 0.15], [0.05, 0.15, 0.3]]);
        let f = Mat::identity() + root(&e).unwrap();
        let error = f.transposed() * f - Mat::identity() - e * 2.0;
        assert!(error.double_dot(&error) < 1e-30);
        assert!(root(&(Mat::<3>::identity() * -0.6)).is_none());
    }
}
