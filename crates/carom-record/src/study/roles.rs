//! Records of runs in which secondary and primary sides are swapped. Force and impulse of contact
//! are those on the secondary sides, so that they have the other sign.

use crate::{Facts, History};

/// Columns of forces and impulses on the secondary sides, without their axes.
const OF_SECONDARY: [&str; 3] = ["contact_force_", "contact_impulse_", "algorithmic_impulse_"];

/// Gives the columns of a swapped member the signs of its arm; `facts`: those of arm and member. If
/// only some contacts are swapped, the sums over all of them have no counterpart in the arm, and
/// the columns are removed.
pub fn as_in_arm(history: &mut History, facts: [&Facts; 2]) {
    let [arm, member] = facts.map(|facts| facts.contacts.iter().map(|contact| &contact.secondary));
    let all_swapped = arm.zip(member).all(|(a, b)| a != b);
    let is_of_secondary = |name: &str| OF_SECONDARY.iter().any(|column| name.starts_with(column));
    let columns = std::mem::take(&mut history.columns).into_iter();
    let kept = columns.zip(std::mem::take(&mut history.values)).filter_map(|(column, mut values)| {
        if is_of_secondary(&column.name) {
            if !all_swapped {
                return None;
            }
            values.iter_mut().for_each(|value| *value = -*value);
        }
        Some((column, values))
    });
    let (columns, values) = kept.unzip();
    *history = History::new(columns, values);
}
