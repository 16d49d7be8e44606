//! Numbers of cells under refinement.

use carom_case::refine::{Counts, problem};

fn message(factor: f64, meshes: &[&[usize]]) -> Option<String> {
    let counts = |(k, n): (usize, &&[usize])| Counts {
        path: if **n == [1] { format!("body[{k}].mesh") } else { format!("body[{k}].mesh.cells") },
        of_file: **n == [1],
        numbers: n.to_vec(),
    };
    let meshes: Vec<_> = meshes.iter().enumerate().map(counts).collect();
    problem(factor, &meshes).map(|problem| format!("{}: {}", problem.what, problem.help))
}

#[test]
fn numbers_of_cells_remain_whole() {
    for (factor, meshes) in [
        (1.25, &[&[8, 4][..]][..]),
        (1.5, &[&[8, 4], &[2]]),
        (4.0 / 3.0, &[&[3]]),
        (1.333_333_333_333, &[&[3]]),
        (3.0, &[&[1], &[7]]),
        (1.1, &[]),
    ] {
        assert_eq!(message(factor, meshes), None);
    }
    let text = message(1.25, &[&[8, 4], &[4, 3]]).unwrap();
    for part in ["body[1].mesh.cells = [4, 3] into [5, 3.75]", "`refine = 1` or `refine = 2`"] {
        assert!(text.contains(part), "{text}");
    }
    assert!(message(1.5, &[&[8, 4], &[1]]).unwrap().contains("body[1].mesh comes from a file"));
    // Multiples of 1/6.
    assert!(message(1.25, &[&[12, 6]]).unwrap().contains("`refine = 1.166666667` or `refine = 1.333333333`"));
}
