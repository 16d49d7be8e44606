//! Surfaces of triangles: their neighbours, and what is rejected.

use carom_solid::{Triangles, TrianglesError};

fn tetrahedron() -> (Vec<[f64; 3]>, Vec<[usize; 3]>) {
    let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    (points, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
}

/// A cube of twelve triangles has twelve edges; the diagonals of its faces are none.
#[test]
fn the_outline_is_where_the_surface_has_kinks() {
    let points: Vec<[f64; 3]> = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(f64::from)).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let corners = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let cube = Triangles::new(points, corners).unwrap();
    let outline = cube.outline(100);
    assert_eq!((outline.len(), cube.outline(5).len()), (12, 5));
    let length = |[a, b]: [[f64; 3]; 2]| (0..3).map(|i| (b[i] - a[i]).abs()).sum::<f64>();
    assert!(outline.into_iter().all(|ends| length(ends) == 1.0));
}

#[test]
fn neighbours_share_their_edges_also_when_reversed() {
    let (points, corners) = tetrahedron();
    let closed = Triangles::new(points.clone(), corners.clone()).unwrap();
    let open = Triangles::new(points, corners[1..].to_vec()).unwrap();
    assert_eq!((closed.rim(), open.rim()), (0, 3));
    for surface in [closed.clone(), closed.placed(2.0, true), open.clone(), open.placed(0.5, true)] {
        for (k, edge) in (0..surface.corners().len()).flat_map(|k| (0..3).map(move |edge| (k, edge))) {
            let Some(other) = surface.across(k, edge) else { continue };
            let [a, b] = surface.edge(k, edge);
            assert!((0..3).any(
                |edge| surface.edge(other, edge) == [b, a] && surface.across(other, edge) == Some(k)
            ));
        }
    }
}

#[test]
fn what_is_no_surface_is_named() {
    let (mut points, corners) = tetrahedron();
    let error = |points: &[[f64; 3]], corners: &[[usize; 3]]| {
        Triangles::new(points.to_vec(), corners.to_vec()).unwrap_err()
    };
    assert_eq!(error(&points, &[]), TrianglesError::Empty);
    points.push([2.0, 0.0, 0.0]);
    points.push([0.0, -1.0, 0.0]);
    let flat = error(&points, &[corners[0], [0, 1, 4]]);
    assert_eq!(flat, TrianglesError::Flat { triangle: 2, at: [0.0; 3] });
    let at = [0.5, 0.0, 0.0];
    let crowded = error(&points, &[corners[0], corners[1], [1, 0, 5]]);
    assert_eq!(crowded, TrianglesError::Crowded { first: 1, second: 2, third: 3, at });
    let opposed = error(&points, &[corners[0], [1, 0, 3]]);
    assert_eq!(opposed, TrianglesError::Opposed { first: 1, second: 2, at });
    let pinched = error(&points, &[[0, 1, 2], [0, 5, 3]]);
    assert_eq!(pinched, TrianglesError::Pinched { triangle: 1, at: [0.0; 3] });
}
