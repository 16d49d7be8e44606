//! Records of runs in which secondary and primary sides are swapped. Force and impulse of contact
//! are those on the secondary sides, so that they have the other sign, in sums and of each contact.

use crate::{ContactFacts, Facts, History};

/// Columns of forces and impulses on the secondary sides, without their axes.
const OF_SECONDARY: [&str; 3] = ["contact_force_", "contact_impulse_", "algorithmic_impulse_"];

/// Gives the columns of a swapped member the signs of its arm; `facts`: those of arm and member. If
/// only some contacts are swapped, the sums over all of them have no counterpart in the arm, and
/// the columns are removed.
pub fn as_in_arm(history: &mut History, facts: [&Facts; 2]) {
    let [arm, member] = facts.map(|facts| facts.contacts.iter().map(|contact| &contact.secondary));
    let all_swapped = arm.zip(member).all(|(a, b)| a != b);
    let is_of_secondary = |name: &str| OF_SECONDARY.iter().any(|column| name.starts_with(column));
    // Columns of single contacts, `CONTACT.force_x`.
    let of_swapped = |name: &str| {
        let force = |contact: &ContactFacts| {
            name.strip_prefix(&contact.name).is_some_and(|rest| rest.starts_with(".force_"))
        };
        let mut sides = facts[0].contacts.iter().zip(&facts[1].contacts);
        sides.any(|(own, swapped)| force(own) && own.secondary != swapped.secondary)
    };
    let columns = std::mem::take(&mut history.columns).into_iter();
    let kept = columns.zip(std::mem::take(&mut history.values)).filter_map(|(column, mut values)| {
        if is_of_secondary(&column.name) && !all_swapped {
            return None;
        }
        if is_of_secondary(&column.name) || of_swapped(&column.name) {
            values.iter_mut().for_each(|value| *value = -*value);
        }
        Some((column, values))
    });
    let (columns, values) = kept.unzip();
    *history = History::new(columns, values);
}
