//! The numbers of a factor: double or single precision, and the range that single precision needs.

use faer::traits::RealField;

/// Entries of a factor: all of their digits, or half of them in half of the memory and the time.
/// What takes the factor for an approximation loses nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// 53 bits.
    Double,
    /// 24 bits.
    Single,
}

/// A number of the factor.
pub(crate) trait Entry: RealField + Copy + Into<f64> {
    /// Power of two that the largest entry of the matrix is brought to; none where the range is
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

/// Where mass prevails, entries of the factor fall off with the distance of their unknowns, below
/// what 8 bits of exponent hold; and numbers with fewer bits than 24 are slow. With the matrix near
/// the upper end of the range they may fall by 55 decades instead of 38.
impl Entry for f32 {
    const TOP: Option<i32> = Some(110);

    fn rounded(value: f64) -> Self {
        value as f32
    }
}
