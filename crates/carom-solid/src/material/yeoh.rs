//! Yeoh's law, W = C₁₀ x + C₂₀ x² + C₃₀ x³ with x = Ī₁ − 3 (O. H. Yeoh, Rubber Chem. Technol. 66
//! (1993) 754–771). Its shear modulus is 2 C₁₀ at small strains, and rises at large ones.

use super::isochoric::{OfInvariants, Slopes};

/// W of Yeoh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Yeoh {
    /// C₁₀.
    pub c10: f64,
    /// C₂₀.
    pub c20: f64,
    /// C₃₀.
    pub c30: f64,
}

impl OfInvariants for Yeoh {
    #[inline(always)]
    fn at(&self, [x, _]: [f64; 2]) -> Slopes {
        let Self { c10, c20, c30 } = self;
        Slopes {
            energy: x * (c10 + x * (c20 + x * c30)),
            first: c10 + x * (2.0 * c20 + 3.0 * c30 * x),
            second: 0.0,
            curvature: 2.0 * c20 + 6.0 * c30 * x,
        }
    }
}
