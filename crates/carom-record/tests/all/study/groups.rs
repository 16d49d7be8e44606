//! Quantities in which runs are compared over their whole history: columns that belong to one
//! vector or tensor of one body have one scale.

use carom_record::study::groups::{groups, is_stress};
use carom_record::study::trajectory::Trajectory;

fn run(columns: &[(&str, [f64; 3])]) -> Trajectory {
    let columns = columns.iter().map(|(name, values)| ((*name).to_owned(), values.to_vec())).collect();
    Trajectory { times: vec![0.0, 0.5, 1.0], columns, ..Trajectory::default() }
}

/// By hand: a body moves 3 along x and 4e-5 along y. An error of 4e-5 along y is 1.3e-5 of its
/// motion, not all of it.
#[test]
fn a_tiny_component_has_the_scale_of_its_vector() {
    let bodies = [("P".to_owned(), "disc".to_owned())].into();
    let right = run(&[("P.ux", [0.0, 1.0, 3.0]), ("P.uy", [0.0, 4e-5, 0.0]), ("P.vx", [1.0; 3])]);
    let arm = run(&[("P.ux", [0.0, 1.0, 3.0]), ("P.uy", [0.0; 3])]);
    let [group] = &groups(&right, &bodies)[..] else { panic!() };
    assert_eq!((group.name.as_str(), group.columns.len()), ("displacements of disc", 2));
    assert_eq!(group.scale(&right), Some(3.0));
    let signal = |run| group.signal(run).unwrap();
    let error = signal(&arm).distance(&signal(&right), 0.0).unwrap().relative_to(3.0).smooth;
    assert!(error < 1e-5, "{error}");
    assert!(is_stress("B.sigma_yy") && is_stress("B.von_mises") && !is_stress("B.uy"));
}

/// By hand: the error of a body is that of one of its probes, however many there are of it.
#[test]
fn more_probes_do_not_change_an_error() {
    let error = |count: usize| {
        let names: Vec<String> = (0..count).map(|i| format!("P{i}.ux")).collect();
        let bodies = (0..count).map(|i| (format!("P{i}"), "disc".to_owned())).collect();
        let of = |end: f64| {
            let columns: Vec<_> = names.iter().map(|name| (name.as_str(), [0.0, end, end])).collect();
            run(&columns)
        };
        let right = of(2.0);
        let [group] = &groups(&right, &bodies)[..] else { panic!() };
        let arm = of(2.2);
        let far = group.signal(&arm).unwrap().distance(&group.signal(&right).unwrap(), 0.0).unwrap();
        far.smooth / group.scale(&right).unwrap()
    };
    assert!((error(4) - error(1)).abs() < 1e-12);
}
