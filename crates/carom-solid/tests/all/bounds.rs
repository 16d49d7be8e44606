//! Boxes: what they contain and meet, also if they are empty or a coordinate is not a number.

use carom_solid::Bounds;

#[test]
fn a_box_holds_its_points_and_has_their_size() {
    let plane: Bounds = [[1.0, 5.0], [3.0, 4.0], [2.0, -1.0]].iter().collect();
    assert_eq!((plane.low(), plane.high()), ([1.0, -1.0, 0.0], [3.0, 5.0, 0.0]));
    assert_eq!((plane.size(), plane.extents(), plane.centre()), (6.0, [2.0, 6.0, 0.0], [2.0, 2.0, 0.0]));
    assert!(plane.contains(&[1.0, 5.0]) && plane.contains(&[2.0, 0.0]) && !plane.contains(&[0.999, 0.0]));
    assert!(plane.grown(0.5).contains(&[0.5, 5.5]) && !plane.grown(0.5).contains(&[0.4, 0.0]));
    let line = Bounds::of(&[2.0]);
    assert!(line.contains(&[2.0]) && !line.contains(&[2.1]) && line.size() == 0.0);
}

#[test]
fn boxes_meet_where_they_touch() {
    let a: Bounds = [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]].iter().collect();
    let meets = |low: [f64; 3]| {
        let b: Bounds = [low, low.map(|x| x + 1.0)].iter().collect();
        assert_eq!(a.meets(&b), b.meets(&a));
        a.meets(&b)
    };
    assert!(meets([1.0, -1.0, 0.5]) && meets([0.2, 0.2, 0.2]));
    assert!(!meets([1.1, 0.0, 0.0]) && !meets([0.0, -1.1, 0.0]) && !meets([0.0, 0.0, 1.1]));
    assert_eq!(a.distance(&[0.5, 0.5, 1.0]), 0.0);
    assert_eq!(a.distance(&[4.0, 0.5, -4.0]), 5.0);
}

#[test]
fn nothing_is_in_an_empty_box() {
    let a = Bounds::of(&[1.0, 2.0]);
    for b in [Bounds::EMPTY, Bounds::EMPTY.grown(2.0), Bounds::EMPTY.grown(f64::INFINITY)] {
        assert!(!b.meets(&a) && !a.meets(&b) && !b.meets(&Bounds::of(&[f64::NAN])) && !b.contains(&[0.0]));
        assert!(!b.meets(&b) && b.size() == 0.0 && b.distance(&[0.0]).is_nan());
        assert_eq!(a.union(&b).low(), a.low());
        assert_eq!(b.union(&a).high(), a.high());
    }
}

#[test]
fn a_coordinate_that_is_no_number_may_be_anywhere() {
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let bad = Bounds::of(&[1.0, x]);
        assert!(bad.meets(&Bounds::of(&[1.0, 7.0])) && bad.meets(&Bounds::of(&[1.0, -1e300])));
        assert!(!bad.meets(&Bounds::of(&[2.0, 0.0])));
        assert_eq!((bad.size(), bad.centre()), (f64::INFINITY, [1.0, 0.0, 0.0]));
        let grown = bad.grown(0.35 * bad.size()).union(&Bounds::of(&[0.0, 0.0]));
        assert!(grown.meets(&Bounds::of(&[-1e300, 1e300])));
    }
    assert!(Bounds::of(&[0.0]).grown(f64::NAN).contains(&[1e300]));
}
