//! Meshes whose cells are divided, compared with finer meshes.

use std::collections::HashSet;

use carom_solid::generate::ball;
use carom_solid::{Element, Law, Mesh, body, generate};

use super::generate::solids::{sound, volume};

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
                all.sort_unstable();
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
            x.sort_unstable_by(f64::total_cmp);
            x
        };
        for (a, b) in sorted(&divided).iter().zip(sorted(&fine)) {
            assert!((a - b).abs() < 1e-14);
        }
    }
}

/// A ball and its parts have the same curved boundary, so the same volume; a facet becomes
/// parts².
#[test]
fn parts_of_tetrahedra_fill_the_whole() {
    for element in [Element::Tet4, Element::Tet10, Element::Tet20] {
        let whole = ball(element, 1.0, [0.0; 3], 0.8, [true, false, false]).unwrap();
        for parts in [2, 3] {
            let divided = whole.subdivided(parts);
            assert_eq!(divided.cell_count(), whole.cell_count() * parts.pow(3));
            for (side, facets) in &whole.sides {
                assert_eq!(divided.sides[side].len(), facets.len() * parts * parts);
            }
            let (before, after) = (volume(&whole), sound(&divided));
            assert!((before - after).abs() < 1e-13 * before, "{element:?} {parts}: {before} {after}");
        }
    }
}

/// Dividing again and again leaves the cells as they are: their quality stays.
#[test]
fn the_quality_of_tetrahedra_is_kept() {
    let mut mesh = ball(Element::Tet4, 1.0, [0.0; 3], 1.0, [true; 3]).unwrap();
    let first = mesh.subdivided(2).scaled_jacobian().unwrap();
    for _ in 0..2 {
        mesh = mesh.subdivided(2);
    }
    let last = mesh.scaled_jacobian().unwrap();
    assert!(last > 0.99 * first, "{first} {last}");
}

/// Numbers of corners, edges, faces and cells of a mesh of hexahedra.
fn counts(mesh: &Mesh) -> [usize; 4] {
    let (mut corners, mut edges, mut faces) = (HashSet::new(), HashSet::new(), HashSet::new());
    for cell in 0..mesh.cell_count() {
        for local in mesh.element.facets() {
            let mut face = [0, 1, 2, 3].map(|k| mesh.cell(cell)[local[k]]);
            for k in 0..4 {
                let [a, b] = [face[k], face[(k + 1) % 4]];
                corners.insert(a);
                edges.insert([a.min(b), a.max(b)]);
            }
            face.sort_unstable();
            faces.insert(face);
        }
    }
    [corners.len(), edges.len(), faces.len(), mesh.cell_count()]
}

/// A ball and its parts have the same curved boundary, so the same volume; every edge, face and
/// cell gets the nodes of its lattice, each once; a facet becomes parts².
#[test]
fn parts_of_hexahedra_fill_the_whole() {
    for element in [Element::Hex8, Element::Hex27] {
        let whole = ball(element, 1.0, [0.0; 3], 0.8, [true, false, false]).unwrap();
        let [v, e, f, c] = counts(&whole);
        assert_eq!(v + f, e + c + 1, "Euler");
        for parts in [2, 3] {
            let divided = whole.subdivided(parts);
            assert_eq!(divided.cell_count(), c * parts.pow(3));
            let between = element.degree() * parts - 1;
            let nodes = v + e * between + f * between.pow(2) + c * between.pow(3);
            assert_eq!(divided.nodes.len(), nodes, "{element:?} {parts}");
            let [v, e, f, c] = counts(&divided);
            assert_eq!(v + f, e + c + 1, "Euler");
            for (side, facets) in &whole.sides {
                assert_eq!(divided.sides[side].len(), facets.len() * parts * parts);
            }
            let (before, after) = (volume(&whole), sound(&divided));
            assert!((before - after).abs() < 1e-14 * before, "{element:?} {parts}: {before} {after}");
        }
    }
}

/// Two halves of every half are four quarters: the same nodes at the same places.
#[test]
fn parts_of_parts_are_parts() {
    for element in [Element::Hex8, Element::Hex27] {
        let whole = ball(element, 1.0, [0.0; 3], 1.0, [true; 3]).unwrap();
        let places = |mesh: Mesh| {
            let mut all: Vec<_> = mesh.nodes.of_dimension::<3>().to_vec();
            all.sort_unstable_by_key(|x| x.map(|x| (x * 1e12).round() as i64));
            all
        };
        let (twice, once) = (places(whole.subdivided(2).subdivided(2)), places(whole.subdivided(4)));
        assert_eq!(twice.len(), once.len());
        for (a, b) in twice.iter().zip(&once) {
            assert!((0..3).all(|i| (a[i] - b[i]).abs() < 1e-14), "{a:?} {b:?}");
        }
    }
}
