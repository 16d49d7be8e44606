//! Cells that are computed together, four in lanes where strain is constant, have the forces,
//! energies and margins of each alone to the last bit.

use carom_solid::{
    Ask, Body, Configuration, Constitutive, Element, Inverted, Law, Mesh, PlaneState, RegionMaterial,
    Response, body, body_of_regions, generate, mean_dilatation_body, plane_stress_body,
};

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

/// Forces and energies of consecutive cells.
fn cell_forces(
    body: &dyn Body,
    first: usize,
    y: &[f64],
    forces: &mut [f64],
    energies: &mut [f64],
) -> Result<(), Inverted> {
    let out = Response { numbers: forces, energies, memory: &mut [], dissipated: &mut [] };
    body.respond(first, &Configuration::at(y), Ask::Force, out).map(|_| ())
}

fn check(body: &dyn Body, y: &[f64], name: &str) {
    let (cells, dofs) = (body.mesh().cell_count(), body.mesh().element.dofs());
    for first in [0, 1, 4] {
        let count = cells - first;
        let (mut forces, mut energies) = (vec![f64::NAN; count * dofs], vec![f64::NAN; count]);
        let mut margins = energies.clone();
        cell_forces(body, first, y, &mut forces, &mut energies).unwrap();
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
        let together = cell_forces(&*body, 0, &y, &mut vec![0.0; count * dofs], &mut vec![0.0; count]);
        assert!(alone.is_some());
        assert_eq!(together.err(), alone, "{:?}", mesh.element);
        let together = body.cell_margins(0, &y, &mut vec![0.0; count]).err();
        assert_eq!(together, first(&|c| body.cell_margin(c, &y)), "{:?}", mesh.element);
    }
}

/// Laws of regions, which a mesh mixes cell by cell.
fn regions(mesh: &mut Mesh, laws: &[Law], plane: PlaneState) -> Box<dyn Body> {
    mesh.regions = (0..mesh.cell_count()).map(|cell| ((cell * cell / 3) % laws.len()) as u16).collect();
    let laws: Vec<Box<dyn Constitutive>> = laws.iter().map(|law| law.constitutive()).collect();
    let materials: Vec<_> = laws.iter().map(|law| RegionMaterial { law: &**law, density: 1.0 }).collect();
    body_of_regions(mesh.clone(), &materials, plane, 0.7).unwrap()
}

/// Each cell of a body of several materials has the bits that it has in a body of its material.
#[test]
fn cells_of_several_materials_have_the_bits_of_their_own() {
    for mut mesh in meshes() {
        let y = moved(&mesh);
        for plane in [PlaneState::Strain, PlaneState::Stress] {
            if plane == PlaneState::Stress && mesh.dimension() != 2 {
                continue;
            }
            let mixed = regions(&mut mesh, &LAWS, plane);
            check(&*mixed, &y, &format!("{:?} of several materials", mesh.element));
            // The rule of the quadrature is the one that all laws need.
            let alone = LAWS.map(|law| regions(&mut mesh.clone(), &[law, LAWS[1]], plane));
            let dofs = mesh.element.dofs();
            let [mut one, mut other] = [(); 2].map(|()| vec![0.0; dofs]);
            for cell in 0..mesh.cell_count() {
                let single = &alone[mesh.region(cell)];
                if single.mesh().region(cell) == 0 {
                    let energies = [
                        mixed.cell_force(cell, &y, &mut one).unwrap(),
                        single.cell_force(cell, &y, &mut other).unwrap(),
                    ];
                    assert_eq!((energies[0], &one), (energies[1], &other));
                }
            }
        }
    }
}

/// Regions of the same law are no difference, to the last bit.
#[test]
fn regions_of_one_law_are_one_material() {
    for mut mesh in meshes() {
        let (y, count) = (moved(&mesh), mesh.cell_count());
        let numbers = count * mesh.element.dofs();
        for law in LAWS {
            let bodies = [
                body(mesh.clone(), law, 1.0, 0.7).unwrap(),
                regions(&mut mesh.clone(), &[law, law, law], PlaneState::Strain),
            ];
            let found = bodies.each_ref().map(|body| {
                let (mut forces, mut energies) = (vec![0.0; numbers], vec![0.0; count]);
                cell_forces(&**body, 0, &y, &mut forces, &mut energies).unwrap();
                (forces, energies)
            });
            assert_eq!(found[0], found[1], "{:?} {law:?}", mesh.element);
        }
        mesh.regions.clear();
    }
}

#[test]
fn a_region_without_a_material_is_refused() {
    let mut mesh = generate::rectangle(Element::Q4, [0.0; 2], [1.0; 2], [2, 1]).unwrap();
    mesh.regions = vec![0, 1];
    let refused = mean_dilatation_body(mesh, &[RegionMaterial { law: LAWS[0], density: 1.0 }], 1.0);
    assert_eq!(refused.err().unwrap().to_string(), "cell 1 is of region 1, but the body has 1 materials");
}
