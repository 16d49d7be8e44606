//! Law of Mooney and Rivlin, W = C₁₀ (Ī₁ − 3) + C₀₁ (Ī₂ − 3) (M. Mooney, J. Appl. Phys. 11 (1940)
//! 582–592; R. S. Rivlin, Phil. Trans. R. Soc. A 241 (1948) 379–397). Its shear modulus is 2 (C₁₀ +
//! C₀₁).

use super::isochoric::{OfInvariants, Slopes};

/// W of Mooney and Rivlin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MooneyRivlin {
    /// C₁₀.
    pub c10: f64,
    /// C₀₁.
    pub c01: f64,
}

impl OfInvariants for MooneyRivlin {
    #[inline(always)]
    fn at(&self, [first, second]: [f64; 2]) -> Slopes {
        let energy = self.c10 * first + self.c01 * second;
        Slopes { energy, first: self.c10, second: self.c01, curvature: 0.0 }
    }
}
