//! Coulomb's and Tresca's laws, with exact projection onto the cone.

use carom_contact::{FrictionPair, FrictionState, Law, Radius, StateChange, StickSlip};

const FORWARD: FrictionState = FrictionState::Slip([1.0, 0.0]);
const BACKWARD: FrictionState = FrictionState::Slip([-1.0, 0.0]);

fn change(pair: usize, friction_state: FrictionState) -> StateChange {
    StateChange { pair, friction_state }
}

#[allow(clippy::unnecessary_wraps)]
fn rub(friction_state: FrictionState, traction: f64, slip: f64) -> Option<FrictionPair> {
    Some(FrictionPair { friction_state, traction: [traction, 0.0], slip: [slip, 0.0], cone: 1.0 })
}

#[test]
fn tractions_leave_the_cone_and_slips_turn_into_stick() {
    let pairs = [
        rub(FrictionState::Stick, 0.9, 0.0),
        rub(FrictionState::Stick, 1.1, 0.0),
        rub(FrictionState::Stick, -1.1, 0.0),
        rub(FrictionState::Stick, 1.0 + 1e-11, 0.0),
        None,
        rub(FORWARD, 1.0, 0.5),
        rub(FORWARD, 1.0, -0.5),
        rub(BACKWARD, -1.0, 0.5),
        rub(BACKWARD, -1.0, 1e-13),
    ];
    let changes = StickSlip::new(1e-12, true).changes(&pairs, false).unwrap();
    assert_eq!(
        changes,
        [
            change(1, FORWARD),
            change(2, BACKWARD),
            change(6, FrictionState::Stick),
            change(7, FrictionState::Stick)
        ]
    );
}

#[test]
fn in_space_a_stick_slips_along_its_traction() {
    let pair =
        |friction_state, traction, slip| Some(FrictionPair { friction_state, traction, slip, cone: 1.0 });
    let oblique = FrictionState::Slip([0.6, -0.8]);
    let pairs = [
        pair(FrictionState::Stick, [0.9, -1.2], [0.0; 2]),
        pair(FrictionState::Stick, [0.7, -0.7], [0.0; 2]),
        pair(oblique, [0.6, -0.8], [0.8, 0.59]),
        pair(oblique, [0.6, -0.8], [0.8, 0.61]),
    ];
    let changes = StickSlip::new(1e-12, true).changes(&pairs, false).unwrap();
    let [
        StateChange { pair: 0, friction_state: FrictionState::Slip(d) },
        StateChange { pair: 3, friction_state: FrictionState::Stick },
    ] = changes[..]
    else {
        panic!("{changes:?}")
    };
    assert!((d[0] - 0.6).abs() < 1e-15 && (d[1] + 0.8).abs() < 1e-15, "{d:?}");
}

#[test]
fn the_radius_has_its_derivatives_and_its_limits() {
    let law = Law { stick: 0.6, slip: 0.2, decay: 3.0, limit: 1.5 };
    assert_eq!(law.grip(2.0), 1.2);
    assert_eq!((law.grip(5.0), law.grip(-1.0)), (1.5, 0.0));
    let h = 1e-6;
    for (pressure, rate) in [(2.0, 0.0), (2.0, 0.4), (5.0, 2.0), (9.0, 0.1), (0.0, 0.1), (-2.0, 0.4)] {
        let radius = law.slip(pressure, rate);
        let by_pressure =
            (law.slip(pressure + h, rate).value - law.slip(pressure - h, rate).value) / (2.0 * h);
        let by_rate = (law.slip(pressure, rate + h).value - law.slip(pressure, rate - h).value) / (2.0 * h);
        assert!((radius.by_pressure - by_pressure).abs() < 1e-8, "{pressure} {rate}");
        assert!((radius.by_rate - by_rate).abs() < 1e-8, "{pressure} {rate}");
    }
    let none = Law { limit: 0.0, ..law };
    assert!(none.is_none() && none.slip(-2.0, 0.0) == Radius::default());
    let tresca = Law { stick: f64::INFINITY, slip: f64::INFINITY, decay: 0.0, limit: 0.7 };
    assert_eq!(
        (tresca.grip(1e-9), tresca.slip(1e-9, 1.0)),
        (0.7, Radius { value: 0.7, ..Radius::default() })
    );
    assert_eq!(Law::coulomb(0.3).slip(2.0, 7.0), Radius { value: 0.6, by_pressure: 0.3, by_rate: 0.0 });
}

#[test]
fn a_two_cycle_is_named_in_the_end() {
    let mut set = StickSlip::new(0.0, true);
    let stick = [rub(FrictionState::Stick, 2.0, 0.0)];
    let slip = [rub(FORWARD, 1.0, -1.0)];
    assert_eq!(set.changes(&stick, false).unwrap(), [change(0, FORWARD)]);
    assert!(set.changes(&slip, false).unwrap().is_empty());
    assert_eq!(set.changes(&slip, true).unwrap(), [change(0, FrictionState::Stick)]);
    let mut named = false;
    for k in 0..6 {
        named |= set.changes(if k % 2 == 0 { &stick } else { &slip }, true).is_err();
    }
    assert!(named);
}
