//! Meshes whose cells are divided, compared with finer meshes.

use carom_solid::{Element, Law, Mesh, body, generate};

/// A divided rectangle has the nodes and cells of the finer rectangle and the same sides; on a
/// disc the divided cells keep the area of the curved ones, and every facet is an edge of its
/// cell.
#[test]
fn counts_sides_and_area() {
    for element in [Element::T3, Element::T6, Element::T10] {
        for parts in [2, 3] {
            let coarse = generate::rectangle(element, [0.0, 0.0], [2.0, 1.0], [4, 2]).unwrap();
            let fine = generate::rectangle(element, [0.0, 0.0], [2.0, 1.0], [4 * parts, 2 * parts]).unwrap();
            let divided = coarse.subdivided(parts).unwrap();
            assert_eq!((divided.nodes.len(), divided.cell_count()), (fine.nodes.len(), fine.cell_count()));
            for side in ["bottom", "right", "top", "left"] {
                let at = |mesh: &Mesh| -> Vec<Vec<f64>> {
                    let nodes = mesh.side_nodes(side).unwrap();
                    nodes.iter().map(|&n| mesh.nodes[n].to_vec()).collect()
                };
                for (a, b) in at(&divided).iter().zip(&at(&fine)) {
                    assert!((a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-14, "{side}: {a:?} {b:?}");
                }
            }
            let disc = generate::disc(element, 1.0, [0.0, 0.0], 0.5).unwrap();
            let divided = disc.subdivided(parts).unwrap();
            let area = |mesh: &Mesh| {
                let law = Law::NeoHookean { lambda: 1.0, mu: 1.0 };
                let body = body(mesh.clone(), law, 1.0, 1.0).unwrap();
                let mut total = 0.0;
                for cell in 0..mesh.cell_count() {
                    body.each_volume_point(cell, &mut |_, _, volume| total += volume);
                }
                total
            };
            assert!((area(&divided) - area(&disc)).abs() < 1e-13);
            for facet in divided.sides.values().flatten() {
                let cell = divided.cell(facet.cell);
                assert!(facet.nodes.iter().all(|n| cell.contains(n)));
                assert!(divided.on_boundary()[facet.nodes[0]]);
            }
        }
    }
}

#[test]
fn a_divided_bar_is_the_finer_bar() {
    for element in [Element::L2, Element::L3, Element::L4] {
        let coarse = generate::interval(element, 0.0, 2.0, 3).unwrap();
        let (divided, fine) =
            (coarse.subdivided(2).unwrap(), generate::interval(element, 0.0, 2.0, 6).unwrap());
        let ends = |mesh: &Mesh| ["left", "right"].map(|s| mesh.nodes[mesh.sides[s][0].nodes[0]][0]);
        assert_eq!((divided.nodes.len(), ends(&divided)), (fine.nodes.len(), ends(&fine)));
        let sorted = |mesh: &Mesh| {
            let mut x: Vec<f64> = mesh.nodes.iter().map(|p| p[0]).collect();
            x.sort_by(f64::total_cmp);
            x
        };
        for (a, b) in sorted(&divided).iter().zip(sorted(&fine)) {
            assert!((a - b).abs() < 1e-14);
        }
    }
}
