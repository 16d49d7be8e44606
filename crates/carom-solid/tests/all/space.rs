//! Cells in space, and quadrilaterals: volumes, patch tests, discrete gradients, tangents, loads on
//! faces, against exact values.

use carom_solid::{Body, Element, Law, LoadedSide, Mesh, body, generate};

const CELLS: [Element; 5] = [Element::Tet4, Element::Tet10, Element::Tet20, Element::Hex8, Element::Hex27];
const RUBBER: Law = Law::NeoHookean { lambda: 200.0, mu: 15.0 };

/// A box whose inner nodes are shifted at random, so that its cells are curved.
fn shaken(element: Element, amount: f64) -> Mesh {
    let mut mesh = match element {
        Element::Q4 | Element::Q9 => generate::rectangle(element, [0.0; 2], [1.0, 1.5], [2, 3]).unwrap(),
        _ => generate::cuboid(element, [0.0; 3], [1.0, 1.5, 0.8], [2, 3, 2]).unwrap(),
    };
    let on_boundary = mesh.on_boundary();
    for (node, x) in mesh.nodes.iter_mut().enumerate().filter(|(node, _)| !on_boundary[*node]) {
        for (i, x) in x.iter_mut().enumerate() {
            *x += amount * ((3 * node + i) as f64 * 12.9898).sin();
        }
    }
    mesh
}

fn all() -> impl Iterator<Item = Element> {
    CELLS.into_iter().chain([Element::Q4, Element::Q9])
}

fn solid(mesh: Mesh, law: Law) -> Box<dyn Body> {
    body(mesh, law, 3.0, 1.0).unwrap()
}

/// Internal forces on all nodes.
fn forces(body: &dyn Body, y: &[f64]) -> Vec<f64> {
    let (mesh, mut all) = (body.mesh(), vec![0.0; y.len()]);
    let (d, mut local) = (mesh.dimension(), vec![0.0; mesh.element.dofs()]);
    for cell in 0..mesh.cell_count() {
        body.cell_force(cell, y, &mut local).unwrap();
        for (a, node) in mesh.cell(cell).iter().enumerate() {
            (0..d).for_each(|i| all[node * d + i] += local[a * d + i]);
        }
    }
    all
}

#[test]
fn a_box_has_its_volume_its_sides_and_closed_faces() {
    for element in all() {
        let mesh = shaken(element, 0.01);
        let d = mesh.dimension();
        let exact = if d == 3 { 1.0 * 1.5 * 0.8 } else { 1.5 };
        let body = solid(mesh.clone(), RUBBER);
        let mut volumes = vec![0.0; element.nodes()];
        let of_cell = |cell| {
            body.cell_volumes(cell, &mut volumes);
            volumes.iter().sum::<f64>()
        };
        let volume: f64 = (0..mesh.cell_count()).map(of_cell).sum();
        assert!((volume - exact).abs() < 1e-14, "{element:?}: {volume}");
        // A unit pressure on the whole skin: Σ f = 0 and Σ f·x = −D V, by the divergence theorem.
        let skin = LoadedSide::new(&mesh, &mesh.skin(), 0, 1.0);
        let mut force = vec![0.0; d * mesh.nodes.len()];
        skin.add_pressure(&vec![1.0; skin.positions().len()], mesh.nodes.flat(), &mut force);
        for i in 0..d {
            assert!(force.iter().skip(i).step_by(d).sum::<f64>().abs() < 1e-14, "{element:?}");
        }
        let virial: f64 = force.iter().zip(mesh.nodes.flat()).map(|(f, x)| f * x).sum();
        assert!((virial + d as f64 * exact).abs() < 1e-13, "{element:?}: {virial}");
        // The named sides are the skin.
        let named: usize = mesh.sides.values().map(Vec::len).sum();
        assert_eq!(named, mesh.skin().len(), "{element:?}");
    }
}

/// xᵀMx over the curved cells of a box is ρ∫x² dV, to round-off.
#[test]
fn masses_of_curved_cells_are_exact() {
    for element in all() {
        let (mesh, n) = (shaken(element, 0.02), element.nodes());
        let (d, body) = (mesh.dimension(), solid(mesh.clone(), RUBBER));
        let (mut mass, mut second) = (vec![0.0; n * n], [0.0; 3]);
        for cell in 0..mesh.cell_count() {
            body.cell_mass(cell, &mut mass);
            let nodes = mesh.cell(cell);
            for (e, m) in mass.iter().enumerate() {
                let [a, b] = [e / n, e % n].map(|a| &mesh.nodes[nodes[a]]);
                (0..d).for_each(|i| second[i] += m * a[i] * b[i]);
            }
        }
        let size = &[1.0, 1.5, 0.8][..d];
        for i in 0..d {
            let exact = 3.0 * size.iter().product::<f64>() * size[i] * size[i] / 3.0;
            assert!((second[i] / exact - 1.0).abs() < 1e-13, "{element:?}: {} {exact}", second[i]);
        }
    }
}

#[test]
fn a_linear_motion_of_curved_cells_has_no_force_inside() {
    let map = [[1.1, 0.2, -0.1], [0.05, 0.9, 0.15], [-0.2, 0.1, 1.2]];
    for element in all() {
        let mesh = shaken(element, 0.02);
        let d = mesh.dimension();
        let inside: Vec<bool> = mesh.on_boundary().iter().map(|on| !on).collect();
        let y: Vec<f64> = mesh
            .nodes
            .iter()
            .flat_map(|x| (0..d).map(move |i| (0..d).map(|j| map[i][j] * x[j]).sum::<f64>()))
            .collect();
        let force = forces(&*solid(mesh, RUBBER), &y);
        assert!(inside.iter().any(|inside| *inside), "{element:?}");
        for (node, f) in force.chunks_exact(d).enumerate().filter(|(node, _)| inside[*node]) {
            // Terms of the sum are of the size of λ times an area.
            assert!(f.iter().all(|f| f.abs() < 1e-12), "{element:?}, node {node}: {f:?}");
        }
    }
}

#[test]
fn force_and_tangent_are_derivatives_and_the_product_is_theirs() {
    for element in all() {
        let mesh = shaken(element, 0.02);
        let (d, n) = (mesh.dimension(), element.dofs());
        let bent =
            |x: &[f64]| (0..x.len()).map(|i| x[i] * 1.05 + 0.1 * x[(i + 1) % x.len()].powi(2)).collect();
        let y: Vec<f64> = mesh.nodes.iter().flat_map(|x| -> Vec<f64> { bent(x) }).collect();
        let body = solid(mesh, RUBBER);
        let cell = 1;
        let (mut force, mut tangent) = (vec![0.0; n], vec![0.0; n * n]);
        body.cell_tangent(cell, &y, &mut force, &mut tangent).unwrap();
        let dofs: Vec<usize> =
            body.mesh().cell(cell).iter().flat_map(|node| (0..d).map(move |i| node * d + i)).collect();
        let change: Vec<f64> = (0..y.len()).map(|k| (k as f64 * 7.3).sin()).collect();
        let at = |h: f64| {
            let moved: Vec<f64> = y.iter().zip(&change).map(|(y, c)| y + h * c).collect();
            let mut f = vec![0.0; n];
            (body.cell_force(cell, &moved, &mut f).unwrap(), f)
        };
        let h = 1e-5;
        let (plus, minus) = (at(h), at(-h));
        let sizes = dofs.iter().zip(&force).map(|(dof, f)| f * change[*dof]);
        let (work, size) = sizes.fold((0.0, 0.0), |(sum, size), w| (sum + w, size + w.abs()));
        assert!(((plus.0 - minus.0) / (2.0 * h) - work).abs() < 1e-6 * size, "{element:?}");
        let largest = tangent.iter().fold(0.0_f64, |most, k| most.max(k.abs()));
        let mut product = vec![0.0; n];
        body.cell_product(cell, None, &y, &change, &mut product).unwrap();
        for row in 0..n {
            let slope = (plus.1[row] - minus.1[row]) / (2.0 * h);
            let of_tangent: f64 =
                dofs.iter().enumerate().map(|(k, dof)| tangent[row * n + k] * change[*dof]).sum();
            assert!((slope - product[row]).abs() < 1e-6 * largest, "{element:?}: {slope} {}", product[row]);
            assert!((of_tangent - product[row]).abs() < 1e-13 * largest, "{element:?}");
        }
    }
}

#[test]
fn the_discrete_gradient_has_the_change_of_the_energy() {
    for element in all() {
        let mesh = shaken(element, 0.02);
        let before = mesh.nodes.flat().to_vec();
        let now: Vec<f64> =
            before.iter().enumerate().map(|(k, x)| 1.1 * x + 0.005 * (k as f64 * 3.7).sin()).collect();
        let body = solid(mesh, RUBBER);
        let (d, mut force) = (body.mesh().dimension(), vec![0.0; element.dofs()]);
        for cell in 0..body.mesh().cell_count() {
            let start = body.cell_force(cell, &before, &mut force).unwrap();
            let end = body.cell_between(cell, &before, &now, &mut force).unwrap();
            let nodes = body.mesh().cell(cell).iter().enumerate();
            let work: f64 = nodes
                .flat_map(|(a, node)| (0..d).map(move |i| (a * d + i, node * d + i)))
                .map(|(local, dof)| force[local] * (now[dof] - before[dof]))
                .sum();
            assert!((work - (end - start)).abs() < 1e-13 * end, "{element:?}");
        }
    }
}

#[test]
fn the_tangent_of_a_pressure_on_faces_is_its_derivative() {
    for element in CELLS {
        let mesh = shaken(element, 0.0);
        let top = LoadedSide::new(&mesh, &mesh.sides["top"], 0, 1.0);
        let pressure: Vec<f64> = top.positions().map(|x| 1.0 + x[0] * x[1]).collect();
        let y: Vec<f64> = mesh
            .nodes
            .iter()
            .flat_map(|x| [x[0] + 0.1 * x[1] * x[2], x[1], x[2] + 0.2 * x[0].sin()])
            .collect();
        let at = |h: f64| {
            let moved: Vec<f64> =
                y.iter().enumerate().map(|(k, y)| y + h * (k as f64 * 12.9898).sin()).collect();
            let mut force = vec![0.0; y.len()];
            top.add_pressure(&pressure, &moved, &mut force);
            force
        };
        let mut product = vec![0.0; y.len()];
        for (f, nodes) in top.facets().iter().enumerate() {
            let n = 3 * nodes.len();
            let mut tangent = vec![0.0; n * n];
            top.facet_tangent(f, &pressure, &y, &mut tangent);
            for a in 0..n {
                for b in 0..n {
                    let (row, column) = (3 * nodes[a / 3] + a % 3, 3 * nodes[b / 3] + b % 3);
                    product[row] += tangent[a * n + b] * (column as f64 * 12.9898).sin();
                }
            }
        }
        // The force is quadratic in y: central differences are exact.
        let (plus, minus) = (at(0.5), at(-0.5));
        for dof in 0..y.len() {
            assert!((plus[dof] - minus[dof] - product[dof]).abs() < 1e-13, "{element:?} dof {dof}");
        }
    }
}

#[test]
fn points_are_found_and_inverted() {
    for element in all() {
        let mesh = shaken(element, 0.02);
        let (d, y) = (mesh.dimension(), mesh.nodes.flat().to_vec());
        let body = solid(mesh, RUBBER);
        for k in 0..20 {
            let point: Vec<f64> =
                (0..d).map(|i| 0.1 + 0.6 * (0.5 + 0.5 * ((3 * k + i) as f64 * 5.1).sin())).collect();
            let found = body.locate(&point);
            assert!(!found.is_empty(), "{element:?} {point:?}");
            let (cell, xi) = &found[0];
            let mut values = vec![0.0; element.nodes()];
            body.shape(xi, &mut values);
            for i in 0..d {
                let nodes = body.mesh().cell(*cell).iter().zip(&values);
                let x: f64 = nodes.map(|(node, value)| value * y[node * d + i]).sum();
                assert!((x - point[i]).abs() < 1e-10, "{element:?}");
            }
        }
        assert!(body.locate(&vec![3.0; d]).is_empty());
    }
}

/// Facets with the same nodes in several cells, also of three cells, are none of the boundary.
#[test]
fn the_boundary_is_what_one_cell_alone_has() {
    let mut meshes = Vec::new();
    for element in [Element::Tet4, Element::Tet10, Element::Hex8, Element::Hex27] {
        meshes.push(generate::cuboid(element, [0.0; 3], [1.0; 3], [3, 2, 4]).unwrap());
    }
    let mut thrice = meshes[0].clone();
    thrice.cells.extend_from_within(0..40);
    meshes.push(thrice);
    for mesh in meshes {
        let mut alone = std::collections::BTreeMap::new();
        for cell in 0..mesh.cell_count() {
            for facet in mesh.element.facets() {
                let nodes: Vec<usize> = facet.iter().map(|&a| mesh.cell(cell)[a]).collect();
                let mut key = nodes.clone();
                key.sort_unstable();
                let count = alone.entry(key).or_insert((0, cell, nodes));
                count.0 += 1;
            }
        }
        let expected: Vec<_> = alone.into_values().filter(|(count, ..)| *count == 1).collect();
        let skin = mesh.skin();
        assert_eq!(skin.len(), expected.len());
        for (facet, (_, cell, nodes)) in skin.iter().zip(&expected) {
            assert_eq!((facet.cell, &facet.nodes), (*cell, nodes), "{:?}", mesh.element);
        }
    }
}
