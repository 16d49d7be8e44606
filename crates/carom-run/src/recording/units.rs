//! Unit labels of what is recorded.

use carom_case::Case;
use carom_record::units::Labels;

/// From the labels of a case.
pub(super) fn labels(case: &Case) -> Labels {
    Labels::of(&case.units.length, &case.units.time, &case.units.mass)
}
