//! An angle by which directions are told apart, with its sine and cosine, which no function of the
//! standard library computes at compile time.

use std::f64::consts::PI;

/// An angle with its cosine and sine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Angle {
    /// In radians.
    pub(crate) radians: f64,
    /// Cosine of the angle.
    pub(crate) cosine: f64,
    /// Sine of the angle.
    pub(crate) sine: f64,
}

impl Angle {
    /// An angle between −180 and 180 in degrees. The power series are cut off where their terms are
    /// below round-off: π³⁰/30! = 3e-18.
    pub(crate) const fn degrees(degrees: f64) -> Self {
        let radians = degrees * PI / 180.0;
        let mut cosine = 0.0;
        let mut sine = 0.0;
        let mut term = 1.0;
        let mut power = 0.0;
        while power < 30.0 {
            cosine += term;
            term *= radians / (power + 1.0);
            sine += term;
            term *= -radians / (power + 2.0);
            power += 2.0;
        }
        Self { radians, cosine, sine }
    }

    /// The angle from here to a right one.
    pub(crate) const fn complement(self) -> Self {
        Self { radians: 0.5 * PI - self.radians, cosine: self.sine, sine: self.cosine }
    }

    /// Half of the angle.
    pub(crate) const fn half(self) -> Self {
        Self::degrees(0.5 * self.radians * 180.0 / PI)
    }
}
