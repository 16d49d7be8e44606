//! Ensembles: their members and what is said of them.

use carom_record::study::ensemble::{Ensemble, Spread};

#[test]
fn members_are_all_combinations_and_the_first_changes_nothing() {
    let sets = vec![vec!["contact.wall.persistency=\"none\"".to_owned()]];
    let ensemble = Ensemble { phases: 5, swapped: true, mesh: vec![1.0, 1.5, 2.0], sets };
    let members = ensemble.members();
    let name = |i: usize| ensemble.name(&members[i]);
    assert_eq!((members.len(), name(0)), (60, String::new()));
    assert_eq!(name(29), "mesh 2, swapped, phase 0.8");
    assert_eq!(name(30), "contact.wall.persistency=\"none\"");
    assert_eq!([ensemble.changes(&members[29]).len(), ensemble.changes(&members[59]).len()], [0, 1]);
    let names: std::collections::BTreeSet<String> = (0..60).map(name).collect();
    assert_eq!(names.len(), 60);
    let words = ensemble.words();
    assert!(words.contains("3 meshes") && words.contains("5 phases") && words.contains("2 settings"));
}

#[test]
fn median_and_range() {
    let spread = Spread::of([3.0, 1.0, 2.0, 10.0, f64::NAN]).unwrap();
    assert_eq!((spread.count(), spread.median(), spread.range()), (4, 2.5, (1.0, 10.0)));
    assert_eq!((spread.half_width(), Spread::of([]).is_none()), (7.5, true));
}
