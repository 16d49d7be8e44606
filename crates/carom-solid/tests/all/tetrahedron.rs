//! One tetrahedron: nothing beneath a body assumes two dimensions.

use std::collections::BTreeMap;

use carom_algebra::Mat;
use carom_solid::{Body, Element, Law, Mesh, body};

fn tetrahedron() -> Box<dyn Body> {
    let nodes = vec![[0.0, 0.0, 0.0], [2.0, 0.1, 0.0], [0.2, 1.5, 0.1], [0.1, 0.2, 1.0]].into();
    let mesh = Mesh {
        element: Element::Tet4,
        nodes,
        cells: vec![0, 1, 2, 3],
        sides: BTreeMap::new(),
        regions: Vec::new(),
        repairs: Vec::new(),
    };
    body(mesh, Law::NeoHookean { lambda: 2.0, mu: 1.5 }, 3.0, 1.0).unwrap()
}

#[test]
fn a_tetrahedron_has_its_volume_and_mass() {
    let body = tetrahedron();
    let [a, b, c] = [1, 2, 3].map(|n| body.mesh().nodes.of_dimension::<3>()[n]);
    let volume = Mat([a, b, c]).det() / 6.0;
    let mut volumes = [0.0; 4];
    body.cell_volumes(0, &mut volumes);
    assert!(volumes.iter().all(|v| (v - volume / 4.0).abs() < 1e-15));
    let mut mass = [0.0; 16];
    body.cell_mass(0, &mut mass);
    assert!((mass[0] - 3.0 * volume / 10.0).abs() < 1e-15 && (mass[1] - 3.0 * volume / 20.0).abs() < 1e-15);
}

#[test]
fn a_tetrahedron_s_force_and_tangent_are_derivatives() {
    let body = tetrahedron();
    let bent = |x: &[f64]| [1.1 * x[0] - 0.2 * x[1], 0.9 * x[1] + 0.1 * x[2], x[2] + 0.2 * x[0]];
    let mut y: Vec<f64> = body.mesh().nodes.iter().flat_map(bent).collect();
    let (mut force, mut tangent) = ([0.0; 12], [0.0; 144]);
    body.cell_tangent(0, &y, &mut force, &mut tangent).unwrap();
    let h = 1e-6;
    for column in 0..12 {
        let mut at = |s: f64| {
            y[column] += s;
            let mut f = [0.0; 12];
            let energy = body.cell_force(0, &y, &mut f).unwrap();
            y[column] -= s;
            (energy, f)
        };
        let (plus, minus) = (at(h), at(-h));
        assert!(((plus.0 - minus.0) / (2.0 * h) - force[column]).abs() < 1e-8);
        for row in 0..12 {
            let slope = (plus.1[row] - minus.1[row]) / (2.0 * h);
            assert!((slope - tangent[row * 12 + column]).abs() < 1e-8);
            assert_eq!(tangent[row * 12 + column], tangent[column * 12 + row]);
        }
    }
    assert_eq!(body.locate(&[0.5, 0.4, 0.25]).len(), 1);
    assert!(body.locate(&[2.0, 1.5, 1.0]).is_empty());
}
