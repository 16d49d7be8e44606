//! Cells that are computed together, four in lanes where strain is constant, have the forces,
//! energies and margins of each alone to the last bit.

use carom_solid::{Body, Element, Inverted, Law, Mesh, body, generate, plane_stress_body};

const LAWS: [Law; 3] = [
    Law::NeoHookean { lambda: 2.0, mu: 1.5 },
    Law::SaintVenantKirchhoff { lambda: 2.0, mu: 1.5 },
    Law::LinearElastic { lambda: 2.0, mu: 1.5 },
];

fn meshes() -> Vec<Mesh> {
    let plane = |element| generate::rectangle(element, [0.0; 2], [1.0, 2.0], [3, 5]).unwrap();
    let space = |element| generate::cuboid(element, [0.0; 3], [1.0, 2.0, 1.5], [2, 1, 3]).unwrap();
    let mut meshes: Vec<Mesh> = [Element::T3, Element::T6, Element::Q4].map(plane).into();
    meshes.push(generate::interval(Element::L2, 0.0, 2.0, 7).unwrap());
    meshes.extend([Element::Tet4, Element::Tet10, Element::Hex8].map(space));
    meshes
}

/// Volumes change by less and by more than a tenth.
fn moved(mesh: &Mesh) -> Vec<f64> {
    let d = mesh.dimension();
    let component = |x: &[f64], i: usize| {
        x[i] + 0.03 * (3.0 * x[(i + 1) % d]).sin() + if i == 1 { 0.15 * x[1] * x[1] } else { 0.0 }
    };
    mesh.nodes.iter().flat_map(|x| (0..d).map(move |i| component(x, i))).collect()
}

fn check(body: &dyn Body, y: &[f64], name: &str) {
    let (cells, dofs) = (body.mesh().cell_count(), body.mesh().element.dofs());
    for first in [0, 1, 4] {
        let count = cells - first;
        let (mut forces, mut energies) = (vec![f64::NAN; count * dofs], vec![f64::NAN; count]);
        let mut margins = energies.clone();
        body.cell_forces(first, y, &mut forces, &mut energies).unwrap();
        body.cell_margins(first, y, &mut margins).unwrap();
        let mut alone = vec![0.0; dofs];
        for k in 0..count {
            let energy = body.cell_force(first + k, y, &mut alone).unwrap();
            assert_eq!((energies[k], &forces[k * dofs..(k + 1) * dofs]), (energy, &alone[..]), "{name}");
            assert_eq!(margins[k], body.cell_margin(first + k, y).unwrap(), "{name}");
        }
    }
}

#[test]
fn cells_together_have_the_bits_of_each_alone() {
    for mesh in meshes() {
        let y = moved(&mesh);
        for law in LAWS {
            let name = format!("{:?} {law:?}", mesh.element);
            check(&*body(mesh.clone(), law, 1.0, 0.7).unwrap(), &y, &name);
            if mesh.dimension() == 2 {
                check(&*plane_stress_body(mesh.clone(), law, 1.0, 0.7).unwrap(), &y, &name);
            }
        }
    }
}

#[test]
fn the_first_inverted_cell_among_several_is_named() {
    for mesh in meshes() {
        let body = body(mesh, LAWS[0], 1.0, 1.0).unwrap();
        let (mesh, d) = (body.mesh(), body.mesh().dimension());
        let mut y = moved(mesh);
        // A corner of the fifth cell goes through the opposite side.
        let (cell, corner) = (mesh.cell(4), mesh.cell(4)[0]);
        let far = cell[1..=d].iter().map(|node| y[node * d]).sum::<f64>() / d as f64;
        y[corner * d] += 6.0 * (far - y[corner * d]) + 4.0;
        let first =
            |of: &dyn Fn(usize) -> Result<f64, Inverted>| (0..mesh.cell_count()).find_map(|c| of(c).err());
        let (dofs, count) = (mesh.element.dofs(), mesh.cell_count());
        let alone = first(&|c| body.cell_force(c, &y, &mut vec![0.0; dofs]));
        let together = body.cell_forces(0, &y, &mut vec![0.0; count * dofs], &mut vec![0.0; count]);
        assert!(alone.is_some());
        assert_eq!(together.err(), alone, "{:?}", mesh.element);
        let together = body.cell_margins(0, &y, &mut vec![0.0; count]).err();
        assert_eq!(together, first(&|c| body.cell_margin(c, &y)), "{:?}", mesh.element);
    }
}
