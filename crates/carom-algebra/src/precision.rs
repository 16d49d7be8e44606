//! Precision of a factor, and the scaling that single precision needs.

use faer::traits::RealField;

/// Precision of a factor's entries. Single precision halves memory and time; as a preconditioner
/// the factor loses nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Double precision, 53 bits.
    Double,
    /// Single precision, 24 bits.
    Single,
}

/// Type of the entries of a factor.
pub(crate) trait Entry: RealField + Copy + Into<f64> {
    /// Exponent of two to which the largest entry of the matrix is scaled; none if the range is
    /// wide enough.
    const TOP: Option<i32>;

    fn rounded(value: f64) -> Self;
}

impl Entry for f64 {
    const TOP: Option<i32> = None;

    fn rounded(value: f64) -> Self {
        value
    }
}

/// Where mass dominates, entries of the factor decay with the distance of their unknowns, below the
/// range of 8 exponent bits; subnormal numbers are slow. With the matrix scaled to near the upper
/// end of the range they may decay by 55 decades instead of 38.
impl Entry for f32 {
    const TOP: Option<i32> = Some(110);

    fn rounded(value: f64) -> Self {
        value as f32
    }
}
