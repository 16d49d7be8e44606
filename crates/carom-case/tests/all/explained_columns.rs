//! Columns that are found by parts of their names.

use carom_case::explained_columns;

fn names(word: &str) -> Vec<String> {
    explained_columns(word).iter().map(|column| format!("{}:{}", column.file, column.names[0])).collect()
}

#[test]
fn columns_are_found_by_any_part_of_their_names() {
    assert_eq!(names("contact_force_z"), ["history.csv:contact_force_x"]);
    assert_eq!(names("contact_force"), ["history.csv:contact_force_x"]);
    assert_eq!(names("ball.center_x"), ["history.csv:BODY.center_x", "history.csv:CONTACT.center_x"]);
    assert_eq!(names("BODY.center"), ["history.csv:BODY.center_x"]);
    assert_eq!(names("force_y"), ["history.csv:CONTACT.force_x", "history.csv:TIE.force_x"]);
    assert_eq!(names("A.von_mises"), ["history.csv:PROBE.von_mises"]);
    assert_eq!(names("time"), ["history.csv:time", "contact.csv:time"]);
    assert_eq!(names("nominal_pressure"), ["contact.csv:nominal_pressure"]);
    assert!(names("center_w").is_empty());
    let [column] = &explained_columns("A.vx")[..] else { panic!() };
    assert_eq!((&*column.unit, &*column.meaning), ("length/time", "velocity along x"));
}
