//! Areas of polygons within circles.

use carom_case::spec::polygon::area_within;

#[test]
fn a_quarter_and_a_half_of_a_circle() {
    let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
    let circle = std::f64::consts::PI;
    for (center, share) in [([0.0, 0.0], 0.25), ([2.0, 0.0], 0.5), ([2.0, 2.0], 1.0), ([6.0, 2.0], 0.0)] {
        assert!((area_within(&square, center, 1.0) / circle - share).abs() < 0.02, "{center:?}");
    }
}
