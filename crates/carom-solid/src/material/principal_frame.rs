//! Isotropic laws in logarithmic principal strains: with b = F A Fᵀ = Σ λₐ² nₐ ⊗ nₐ, A constant,
//! εₐ = ln λₐ, and principal Kirchhoff stresses τₐ(ε),
//!
//! ```text
//! τ = Σ τₐ nₐ ⊗ nₐ,   P = τ F⁻ᵀ,   dP = (dτ − τ Lᵀ) F⁻ᵀ,   L = dF F⁻¹
//! dτₐₐ = Σ Dₐᵦ Lᵦᵦ,   dτₐᵦ = gₐᵦ (λᵦ² Lₐᵦ + λₐ² Lᵦₐ),   gₐᵦ = (τₐ − τᵦ)/(λₐ² − λᵦ²)
//! ```
//!
//! in the principal axes (J. C. Simo, Comput. Methods Appl. Mech. Engrg. 99 (1992) 61–112). A is I,
//! or C_p⁻¹ of a plastic law. The differences τₐ − τᵦ are 2G times those of the strains, and
//!
//! ```text
//! (εₐ − εᵦ)/(λₐ² − λᵦ²) = ½ ln(1 + x)/x / λᵦ²,   x = (λₐ² − λᵦ²)/λᵦ²,
//! ```
//!
//! which is exact for all eigenvalues, equal ones included. In directions in which a body does not
//! extend, the stretches are those of A.
//!
//! The eigenvalues are those of b − I = H + Hᵀ + H Hᵀ + F (A − I) Fᵀ, so that small strains keep
//! their accuracy.

use carom_algebra::{Four, Mat, Real, Vector, principal_axes};

use super::kinematics::{excess_cofactor, ln_1p, valid_excess};
use super::{Moduli, NotPositive};
use crate::points::lanes;

/// F, its inverse, and the principal axes of b.
#[derive(Clone, Copy)]
pub(super) struct PrincipalFrame<const D: usize, T = f64> {
    /// F⁻ᵀ.
    pub(super) inverse_transposed: Mat<D, T>,
    /// J.
    pub(super) det_f: T,
    /// nₐ, one in each column.
    pub(super) axes: Mat<D, T>,
    /// λₐ²; those of the other directions last.
    pub(super) squares: [T; 3],
    /// (εₐ − εᵦ)/(λₐ² − λᵦ²) within the dimensions of the body.
    slopes: [[T; D]; D],
    /// εₐ.
    pub(super) strains: [T; 3],
}

impl<const D: usize, T: Real> PrincipalFrame<D, T> {
    /// The frame of H and A − I, of which `across` is the component in the directions in which the
    /// body does not extend.
    #[inline(always)]
    pub(super) fn new(h: &Mat<D, T>, offset: Option<&Mat<D, T>>, across: T) -> Result<Self, NotPositive> {
        let one = T::of(1.0);
        let det_f = one + valid_excess(h)?;
        let inverse_transposed = (Mat::identity() + excess_cofactor(h)) * (one / det_f);
        let mut excess = *h + h.transposed() + *h * h.transposed();
        if let Some(offset) = offset {
            let f = Mat::identity() + *h;
            excess += f * *offset * f.transposed();
        }
        let found = principal_axes(&excess);
        let mut excesses = [across; 3];
        excesses[..D].copy_from_slice(&found.values);
        let mut squares = [one; 3];
        let mut strains = [T::ZERO; 3];
        for a in 0..3 {
            if let Some(least) = excesses[a].find(|x| !(x > -1.0 && x.is_finite())) {
                return Err(NotPositive(1.0 + least));
            }
            squares[a] = one + excesses[a];
            strains[a] = T::of(0.5) * ln_1p(excesses[a])[0];
        }
        let mut slopes = [[T::ZERO; D]; D];
        for a in 0..D {
            for b in 0..a {
                let x = (excesses[a] - excesses[b]) / squares[b];
                // Both are zero where x is: their quotient is one.
                let equal = x.map(|x| if x == 0.0 { 1.0 } else { 0.0 });
                let quotient = (ln_1p(x)[0] + equal) / (x + equal);
                slopes[a][b] = T::of(0.5) * quotient / squares[b];
                slopes[b][a] = slopes[a][b];
            }
        }
        Ok(Self { inverse_transposed, det_f, axes: found.axes, squares, slopes, strains })
    }

    /// tr ε.
    #[inline(always)]
    pub(super) fn trace(&self) -> T {
        self.strains[0] + self.strains[1] + self.strains[2]
    }

    /// The deviator of ε.
    #[inline(always)]
    pub(super) fn deviator(&self) -> [T; 3] {
        let mean = self.trace() / T::of(3.0);
        let mut strains = self.strains;
        for a in 0..3 {
            strains[a] = strains[a] - mean;
        }
        strains
    }

    /// Σ xₐ nₐ ⊗ nₐ within the dimensions of the body.
    #[inline(always)]
    pub(super) fn tensor(&self, of_axes: &[T; 3]) -> Mat<D, T> {
        let mut scaled = self.axes;
        for row in &mut scaled.0 {
            for a in 0..D {
                row[a] = row[a] * of_axes[a];
            }
        }
        scaled * self.axes.transposed()
    }
}

/// Stress and stiffness in a principal frame.
pub(super) struct PrincipalStress<const D: usize, T = f64> {
    pub(super) frame: PrincipalFrame<D, T>,
    /// τₐ.
    pub(super) kirchhoff: [T; 3],
    /// Dₐᵦ = volumetric + shear δₐᵦ − softening Nₐ Nᵦ.
    pub(super) volumetric: T,
    /// The factor of the differences of strains in those of stresses.
    pub(super) shear: T,
    pub(super) softening: T,
    /// N, a deviator of norm one.
    pub(super) direction: [T; 3],
}

impl<const D: usize, T: Real> PrincipalStress<D, T> {
    /// Dₐᵦ.
    #[inline(always)]
    fn stiffness(&self, a: usize, b: usize) -> T {
        let diagonal = if a == b { self.shear } else { T::ZERO };
        self.volumetric + diagonal - self.softening * self.direction[a] * self.direction[b]
    }

    /// P.
    #[inline(always)]
    pub(super) fn stress(&self) -> Mat<D, T> {
        self.frame.tensor(&self.kirchhoff) * self.frame.inverse_transposed
    }

    /// ∂P/∂F, the blocks of unit vectors. The upper ones follow from the symmetry of the tangent.
    #[inline(always)]
    pub(super) fn moduli(&self) -> [[Mat<D, T>; D]; D] {
        let to_axes = (self.frame.axes.transposed() * self.frame.inverse_transposed).transposed();
        let mut moduli = [[Mat::ZERO; D]; D];
        for j in 0..D {
            for l in 0..=j {
                let block = self.block(&to_axes.0[j], &to_axes.0[l]);
                moduli[j][l] = block;
                moduli[l][j] = block.transposed();
            }
        }
        moduli
    }

    /// The block of vectors given by F⁻ᵀa and F⁻ᵀb in the principal axes.
    #[inline(always)]
    fn block(&self, a: &[T; D], b: &[T; D]) -> Mat<D, T> {
        let PrincipalFrame { axes, squares, slopes, .. } = &self.frame;
        let mut block = Mat::ZERO;
        for i in 0..D {
            block.0[i][i] = a[i] * (self.stiffness(i, i) - self.kirchhoff[i]) * b[i];
            for k in 0..D {
                if k != i {
                    let turning = self.shear * slopes[i][k];
                    block.0[i][k] = a[i] * self.stiffness(i, k) * b[k]
                        + (turning * squares[i] - self.kirchhoff[i]) * b[i] * a[k];
                    block.0[i][i] = block.0[i][i] + turning * squares[k] * b[k] * a[k];
                }
            }
        }
        *axes * block * axes.transposed()
    }

    /// dP of dF.
    #[inline(always)]
    pub(super) fn change(&self, df: &Mat<D, T>) -> Mat<D, T> {
        let PrincipalFrame { axes, squares, slopes, inverse_transposed, .. } = &self.frame;
        let l = axes.transposed() * *df * inverse_transposed.transposed() * *axes;
        let mut change = Mat::ZERO;
        for i in 0..D {
            for k in 0..D {
                change.0[i][i] = change.0[i][i] + self.stiffness(i, k) * l.0[k][k];
                if k != i {
                    let turning = self.shear * slopes[i][k];
                    let turned = turning * (squares[k] * l.0[i][k] + squares[i] * l.0[k][i]);
                    change.0[i][k] = change.0[i][k] + turned;
                }
                change.0[i][k] = change.0[i][k] - self.kirchhoff[i] * l.0[k][i];
            }
        }
        *axes * change * axes.transposed() * *inverse_transposed
    }
}

impl<const D: usize> PrincipalStress<D> {
    /// The block K(a, b) of [`Material::tangent`](super::Material::tangent): dP a for dF = e ⊗ b
    /// with each unit vector e.
    #[inline(always)]
    pub(super) fn tangent(&self, a: &Vector<D>, b: &Vector<D>) -> Mat<D> {
        let to_axes = self.frame.axes.transposed() * self.frame.inverse_transposed;
        self.block(&to_axes.apply(a).0, &to_axes.apply(b).0)
    }

    /// Cauchy stress within the dimensions of the body.
    pub(super) fn cauchy(&self) -> Mat<D> {
        self.frame.tensor(&self.kirchhoff) * (1.0 / self.frame.det_f)
    }

    /// Cauchy normal stress in the other directions; zero in space, which has none.
    pub(super) fn lateral(&self) -> f64 {
        if D < 3 { self.kirchhoff[2] / self.frame.det_f } else { 0.0 }
    }
}

/// Stores ∂P/∂F of the points of a law in principal stresses.
#[inline(always)]
pub(super) fn store_moduli<const D: usize>(of: &PrincipalStress<D, Four>, moduli: &mut Moduli<D>) {
    let found = of.moduli();
    for j in 0..D {
        for l in 0..D {
            moduli[j][l] = lanes(&found[j][l]);
        }
    }
}

/// The functions of [`Material`](super::Material) that a point of a law in principal stresses, in
/// its field `of`, knows alone.
macro_rules! by_principal_stress {
    ($dimension:ident) => {
        #[inline(always)]
        fn stress(&self, p: &Self::Point) -> carom_algebra::Mat<$dimension> {
            p.of.stress()
        }

        #[inline(always)]
        fn tangent(
            &self,
            p: &Self::Point,
            a: &carom_algebra::Vector<$dimension>,
            b: &carom_algebra::Vector<$dimension>,
        ) -> carom_algebra::Mat<$dimension> {
            p.of.tangent(a, b)
        }

        #[inline(always)]
        fn change(
            &self,
            p: &Self::Point,
            df: &carom_algebra::Mat<$dimension>,
        ) -> carom_algebra::Mat<$dimension> {
            p.of.change(df)
        }

        fn cauchy(
            &self,
            p: &Self::Point,
            _: &carom_algebra::Mat<$dimension>,
        ) -> carom_algebra::Mat<$dimension> {
            p.of.cauchy()
        }

        fn lateral(&self, p: &Self::Point) -> f64 {
            p.of.lateral()
        }
    };
}

pub(super) use by_principal_stress;
