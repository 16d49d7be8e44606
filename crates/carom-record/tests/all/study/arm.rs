//! An arm of a study: one variant that is simulated, as stored in the manifest.

use carom_record::study::arm::scalar;
use carom_record::study::{Arm, count, sets_step};

#[test]
fn only_the_step_is_the_step() {
    assert!(sets_step("time.step=1") && sets_step(" time.step = 1e-3"));
    assert!(!sets_step("time.stepper=1") && !sets_step("title=time.step"));
}

#[test]
fn numbers_have_any_sign_and_are_no_arrays() {
    let arm = |set: &str| Arm {
        sets: vec![set.to_owned()],
        case: serde_json::json!({ "friction": -0.5 }),
        ..Arm::default()
    };
    assert_eq!(scalar(&arm("a.v=-2"), "a.v"), Some(-2.0));
    assert_eq!(scalar(&arm("a.v = 0"), "a.v"), Some(0.0));
    assert_eq!(scalar(&arm("a.v=1_000"), "friction"), Some(-0.5));
    assert_eq!(scalar(&arm("a.v=[0, -2]"), "a.v"), None);
    assert_eq!(scalar(&arm("a.v=inf"), "a.v"), None);
    assert_eq!(scalar(&arm("a.mesh.cells=[8, 4]"), "a.mesh.cells"), Some(0.125));
    assert_eq!(scalar(&arm("refine=4"), "refine"), Some(0.25));
    assert_eq!(scalar(&arm("a.mesh.layers=4"), "a.mesh.layers"), Some(0.25));
    assert_eq!(
        [count("a.mesh.layers"), count("a.mesh.size"), count("refine")],
        [Some("layers"), None, Some("refine")]
    );
}
