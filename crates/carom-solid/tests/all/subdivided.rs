//! Meshes whose cells are divided, compared with finer meshes.

use carom_solid::{Element, Law, Mesh, body, generate};

fn area(mesh: &Mesh) -> f64 {
    let law = Law::NeoHookean { lambda: 1.0, mu: 1.0 };
    let body = body(mesh.clone(), law, 1.0, 1.0).unwrap();
    let mut total = 0.0;
    for cell in 0..mesh.cell_count() {
        body.each_volume_point(cell, &mut |_, _, volume| total += volume);
    }
    total
}

/// A rectangle bent into a part of a ring, whose sides of degree 2 and 3 are curved.
fn bent(element: Element) -> Mesh {
    let mut mesh = generate::rectangle(element, [0.0, 0.0], [2.0, 1.0], [4, 2]).unwrap();
    for x in &mut mesh.nodes {
        let (sin, cos) = x[0].sin_cos();
        let radius = 2.0 - x[1];
        x.copy_from_slice(&[radius * sin, -radius * cos]);
    }
    mesh
}

/// A divided rectangle has the nodes and cells of the finer rectangle and the same sides; on a
/// part of a ring the divided cells keep the area of the curved ones, and every facet is an edge of
/// its cell, after the one before it.
#[test]
fn counts_sides_and_area() {
    for element in [Element::T3, Element::T6, Element::T10, Element::Q4, Element::Q9] {
        for parts in [2, 3] {
            let coarse = generate::rectangle(element, [0.0, 0.0], [2.0, 1.0], [4, 2]).unwrap();
            let fine = generate::rectangle(element, [0.0, 0.0], [2.0, 1.0], [4 * parts, 2 * parts]).unwrap();
            let divided = coarse.subdivided(parts);
            assert_eq!((divided.nodes.len(), divided.cell_count()), (fine.nodes.len(), fine.cell_count()));
            for side in ["bottom", "right", "top", "left"] {
                let at = |mesh: &Mesh| -> Vec<Vec<f64>> {
                    let nodes = mesh.side_nodes(side).unwrap();
                    nodes.iter().map(|&n| mesh.nodes[n].to_vec()).collect()
                };
                assert_eq!(at(&divided).len(), at(&fine).len());
                for (a, b) in at(&divided).iter().zip(&at(&fine)) {
                    assert!((a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-14, "{side}: {a:?} {b:?}");
                }
            }
            let ring = bent(element);
            let divided = ring.subdivided(parts);
            assert!((area(&divided) - area(&ring)).abs() < 1e-13);
            assert_eq!(divided.sides.values().flatten().count(), divided.skin().len());
            for facets in divided.sides.values() {
                assert!(facets.windows(2).all(|pair| pair[0].nodes[1] == pair[1].nodes[0]));
                for facet in facets {
                    let cell = divided.cell(facet.cell);
                    assert!(facet.nodes.iter().all(|n| cell.contains(n)));
                    assert!(divided.skin().contains(facet), "{element:?} {facet:?}");
                }
            }
        }
    }
}

/// The same in space: a divided box is the finer box, cell by cell where its cells are boxes.
#[test]
fn a_divided_box_is_the_finer_box() {
    for element in [Element::Hex8, Element::Hex27] {
        for parts in [2, 3] {
            let made =
                |n: usize| generate::cuboid(element, [0.0; 3], [1.0, 1.5, 0.8], [2 * n, 3 * n, n]).unwrap();
            let (divided, fine) = (made(1).subdivided(parts), made(parts));
            let cells = |mesh: &Mesh| {
                let at = |&n: &usize| [0, 1, 2].map(|i| (mesh.nodes[n][i] * 1e12).round() as i64);
                let mut all: Vec<Vec<_>> =
                    (0..mesh.cell_count()).map(|c| mesh.cell(c).iter().map(at).collect()).collect();
                all.sort();
                all
            };
            assert_eq!(divided.nodes.len(), fine.nodes.len());
            assert_eq!(cells(&divided), cells(&fine), "{element:?} {parts}");
            for (side, facets) in &fine.sides {
                assert_eq!(divided.sides[side].len(), facets.len());
                let skin = divided.skin();
                assert!(divided.sides[side].iter().all(|facet| skin.contains(facet)), "{side}");
            }
        }
    }
}

#[test]
fn a_divided_bar_is_the_finer_bar() {
    for element in [Element::L2, Element::L3, Element::L4] {
        let coarse = generate::interval(element, 0.0, 2.0, 3).unwrap();
        let (divided, fine) = (coarse.subdivided(2), generate::interval(element, 0.0, 2.0, 6).unwrap());
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
