//! Rows that are linearly independent.

use carom_algebra::{Independent, Plane};

/// A line t, and two directions across it that other rows take away, are combined to two rows: what
/// is left is along t, whatever the shares are.
#[test]
fn what_is_left_of_a_plane_is_a_line() {
    let taken = [[0.0, 0.6, 0.8, 0.5], [1.0, 0.0, 2.0, 0.0]];
    let line = [0.3, -0.2, 0.5, 1.0];
    let sparse = |row: [f64; 4]| (4..8).zip(row).collect::<Vec<_>>();
    for (i, j) in [(1.0, 0.0), (0.6, 0.8), (-0.8, 0.6), (2e-3, 1.0), (0.0, 1.0), (1.0, 3e-3)] {
        let mut set = Independent::default();
        assert!(taken.iter().all(|row| set.accept(sparse(*row), 1e-8)));
        let row = |share: f64, parts: [f64; 2]| {
            let entry = |k: usize| share * line[k] + parts[0] * taken[0][k] + parts[1] * taken[1][k];
            sparse(std::array::from_fn(entry))
        };
        let Plane::Line(found) = set.accept_plane([row(i, [0.3, -0.7]), row(j, [-1.2, 0.4])], 1e-3) else {
            panic!("{i} {j}")
        };
        let size = f64::hypot(i, j);
        let across = (found[0] * j - found[1] * i) / size;
        assert!(across.abs() < 1e-12 && (found[0].hypot(found[1]) - 1.0).abs() < 1e-15, "{found:?}");
        // The line is taken too.
        assert!(!set.accept(sparse(line), 1e-3));
    }
}

#[test]
fn a_plane_is_taken_as_a_whole_or_not_at_all() {
    let mut set = Independent::default();
    assert_eq!(set.accept_plane([vec![(0, 1.0)], vec![(0, 1.0), (3, -0.1)]], 1e-3), Plane::All);
    assert_eq!(set.accept_plane([vec![(3, 1.0)], vec![(0, 1.0)]], 1e-3), Plane::Nothing);
}
