//! Records of runs in which secondary and primary sides are swapped. Force and impulse of contact
//! are those on the secondary sides, so that they have the other sign.

use crate::{Facts, History};

/// Columns of forces and impulses on the secondary sides, without their axes.
const OF_SECONDARY: [&str; 3] = ["contact_force_", "contact_impulse_", "algorithmic_impulse_"];

/// Gives the columns of a swapped member the signs of its arm; `facts`: those of arm and member. If
/// only some contacts are swapped, the sums over all of them have no counterpart in the arm, and
/// the columns are removed.
pub(super) fn as_in_arm(history: &mut History, facts: [&Facts; 2]) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Column, ContactFacts};

    /// With sides a, b and c, d swapped both, signs change; with only one of the two, nothing can
    /// be said of the sums.
    #[test]
    fn sums_over_the_secondary_sides() {
        let history = |names: [&str; 2]| {
            let column = |name: &str| Column {
                name: name.into(),
                unit: "N".into(),
                description: String::new(),
                integer: false,
            };
            History::new(names.map(column).to_vec(), vec![vec![1.0, -2.0], vec![3.0, 4.0]])
        };
        let case = |sides: [&str; 2]| {
            let contact = |side: &str| ContactFacts { secondary: side.into(), ..ContactFacts::default() };
            Facts { contacts: sides.map(contact).into(), ..Facts::default() }
        };
        let arm = case(["a", "c"]);
        let mut all = history(["contact_force_x", "momentum_x"]);
        as_in_arm(&mut all, [&arm, &case(["b", "d"])]);
        assert_eq!(
            (all.column("contact_force_x"), all.column("momentum_x")),
            (Some(&[-1.0, 2.0][..]), Some(&[3.0, 4.0][..]))
        );
        let mut one = history(["contact_impulse_y", "momentum_x"]);
        as_in_arm(&mut one, [&arm, &case(["b", "c"])]);
        assert_eq!(
            (one.column("contact_impulse_y"), one.column("momentum_x")),
            (None, Some(&[3.0, 4.0][..]))
        );
    }
}
