//! Records of runs in which secondary and primary sides are swapped.

use carom_record::study::roles::as_in_arm;
use carom_record::{Column, ContactFacts, Facts, History};

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
    assert_eq!((one.column("contact_impulse_y"), one.column("momentum_x")), (None, Some(&[3.0, 4.0][..])));
}
