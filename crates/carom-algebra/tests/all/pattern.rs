//! Lower triangle of a sparse symmetric matrix, column by column.

use carom_algebra::Pattern;

#[test]
fn multiplies_with_both_triangles() {
    // [2 1 0; 1 3 4; 0 4 5] * [1 2 3]
    let pattern = Pattern::from_entries(3, [(1, 0), (2, 1)]);
    let mut values = vec![0.0; pattern.len()];
    for (i, j, v) in [(0, 0, 2.0), (1, 0, 1.0), (1, 1, 3.0), (1, 2, 4.0), (2, 2, 5.0)] {
        values[pattern.slot(i, j).unwrap()] = v;
    }
    let mut out = vec![0.0; 3];
    pattern.multiply_add(&values, &[1.0, 2.0, 3.0], &mut out);
    assert_eq!(out, [4.0, 19.0, 23.0]);
}
