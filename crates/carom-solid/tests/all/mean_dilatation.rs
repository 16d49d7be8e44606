//! Mean dilatation: derivatives, work of the discrete gradient, invariance, and what a cell keeps.

use carom_algebra::jacobian_error;
use carom_solid::{Body, Element, Law, Mesh, Past, RegionMaterial, body, generate, mean_dilatation_body};

const LAWS: [Law; 3] = [
    Law::NeoHookean { lambda: 40.0, mu: 1.5 },
    Law::SaintVenantKirchhoff { lambda: 40.0, mu: 1.5 },
    Law::LinearElastic { lambda: 40.0, mu: 1.5 },
];

/// One cell with sides that are not parallel.
fn mesh(element: Element) -> Mesh {
    let mut mesh = match element {
        Element::Q4 => generate::rectangle(element, [0.0, 0.0], [1.0, 1.5], [1, 1]).unwrap(),
        _ => generate::cuboid(element, [0.0; 3], [1.0, 1.5, 0.8], [1, 1, 1]).unwrap(),
    };
    let d = element.dimension();
    let mut places: Vec<f64> = mesh.nodes.flat().to_vec();
    places.iter_mut().enumerate().for_each(|(i, x)| *x += 0.08 * (1.7 * i as f64).sin());
    mesh.nodes = carom_solid::Positions::new(d, places);
    mesh
}

fn moved(mesh: &Mesh, by: f64) -> Vec<f64> {
    let places = mesh.nodes.flat().iter().enumerate();
    places.map(|(i, x)| x + by * (2.3 * i as f64 + 10.0 * by).cos()).collect()
}

fn averaged(mesh: Mesh, law: Law) -> Box<dyn Body> {
    mean_dilatation_body(mesh, &[RegionMaterial { law, density: 0.7 }], 2.0).unwrap()
}

fn bodies() -> impl Iterator<Item = (Law, Box<dyn Body>)> {
    [Element::Q4, Element::Hex8]
        .into_iter()
        .flat_map(|element| LAWS.into_iter().map(move |law| (law, averaged(mesh(element), law))))
}

/// The vector of a body of one cell from that of the cell, and back.
fn force(body: &dyn Body, y: &[f64]) -> (f64, Vec<f64>) {
    let mut f = vec![0.0; y.len()];
    let energy = body.cell_force(0, y, &mut f).unwrap();
    (energy, f)
}

/// Positions in the order of the cell.
fn of_nodes(body: &dyn Body, of_cell: &[f64]) -> Vec<f64> {
    let d = body.mesh().dimension();
    let mut all = vec![0.0; of_cell.len()];
    for (a, &node) in body.mesh().cell(0).iter().enumerate() {
        all[node * d..][..d].copy_from_slice(&of_cell[a * d..][..d]);
    }
    all
}

fn of_cell(body: &dyn Body, all: &[f64]) -> Vec<f64> {
    let d = body.mesh().dimension();
    body.mesh().cell(0).iter().flat_map(|&node| all[node * d..][..d].to_vec()).collect()
}

#[test]
fn forces_and_tangents_are_derivatives() {
    for (law, body) in bodies() {
        let y = of_cell(&*body, &moved(body.mesh(), 0.1));
        let n = y.len();
        let (mut f, mut tangent) = (vec![0.0; n], vec![0.0; n * n]);
        body.cell_tangent(0, &of_nodes(&*body, &y), &mut f, &mut tangent).unwrap();
        let at = |y: &[f64]| force(&*body, &of_nodes(&*body, y));
        let error = jacobian_error(&y, 1e-3, |y| vec![at(y).0], &f);
        assert!(error < 1e-8, "{law:?}: {error:e}");
        let error = jacobian_error(&y, 1e-3, |y| at(y).1, &tangent);
        assert!(error < 1e-8, "{law:?}: {error:e}");
        let change: Vec<f64> = (0..n).map(|i| (0.9 * i as f64).sin()).collect();
        let mut product = vec![0.0; n];
        body.cell_product(0, None, &of_nodes(&*body, &y), &of_nodes(&*body, &change), &mut product).unwrap();
        for (row, product) in tangent.chunks_exact(n).zip(&product) {
            let sum: f64 = row.iter().zip(&change).map(|(k, v)| k * v).sum();
            assert!((sum - product).abs() < 1e-11 * sum.abs().max(1.0), "{law:?}");
        }
    }
}

#[test]
fn the_discrete_gradient_works_and_has_its_tangent() {
    for (law, body) in bodies() {
        let (start, end) = (moved(body.mesh(), 0.1), moved(body.mesh(), 0.14));
        let y = of_cell(&*body, &end);
        let n = y.len();
        let mut f = vec![0.0; n];
        let energy = body.cell_between(0, &start, &end, &mut f).unwrap();
        assert!((energy - force(&*body, &end).0).abs() < 1e-13 * energy);
        let work: f64 =
            f.iter().zip(y.iter().zip(of_cell(&*body, &start))).map(|(f, (b, a))| f * (b - a)).sum();
        let gained = energy - force(&*body, &start).0;
        assert!((work - gained).abs() < 1e-13 * energy, "{law:?}: {work} {gained}");
        let mut jacobian = vec![0.0; n * n];
        for column in 0..n {
            let mut unit = vec![0.0; n];
            unit[column] = 1.0;
            let mut product = vec![0.0; n];
            body.cell_product(0, Some(&start), &end, &of_nodes(&*body, &unit), &mut product).unwrap();
            (0..n).for_each(|row| jacobian[row * n + column] = product[row]);
        }
        let between = |y: &[f64]| {
            let mut f = vec![0.0; n];
            body.cell_between(0, &start, &of_nodes(&*body, y), &mut f).unwrap();
            f
        };
        let error = jacobian_error(&y, 1e-3, between, &jacobian);
        assert!(error < 1e-7, "{law:?}: {error:e}");
        // Angular momentum: Σ y_m × f = 0.
        if !matches!(law, Law::LinearElastic { .. }) {
            let d = body.mesh().dimension();
            let middle: Vec<f64> =
                y.iter().zip(of_cell(&*body, &start)).map(|(b, a)| 0.5 * (a + b)).collect();
            for (i, j) in (0..d).flat_map(|j| (0..j).map(move |i| (i, j))) {
                let nodes = middle.chunks_exact(d).zip(f.chunks_exact(d));
                let moment: f64 = nodes.map(|(y, f)| y[i] * f[j] - y[j] * f[i]).sum();
                assert!(moment.abs() < 1e-12, "{law:?}: {moment:e}");
            }
        }
    }
}

#[test]
fn a_homogeneous_deformation_is_that_of_the_law() {
    for element in [Element::Q4, Element::Hex8] {
        for law in LAWS {
            let plain = body(mesh(element), law, 0.7, 2.0).unwrap();
            let mean = averaged(mesh(element), law);
            let d = element.dimension();
            let bent = |x: &[f64]| -> Vec<f64> {
                (0..d).map(|i| 1.1 * x[i] + 0.2 * x[(i + 1) % d] - 0.05 * i as f64 * x[i]).collect()
            };
            let y: Vec<f64> = plain.mesh().nodes.iter().flat_map(bent).collect();
            let ((a, f), (b, g)) = (force(&*plain, &y), force(&*mean, &y));
            assert!((a - b).abs() < 1e-13 * a, "{law:?}: {a} {b}");
            assert!(f.iter().zip(&g).all(|(f, g)| (f - g).abs() < 1e-12), "{law:?}");
            let xi = vec![0.3; d];
            let [p, q] = [&plain, &mean].map(|body| body.point(0, &xi, &y, &Past::default()).unwrap().cauchy);
            let stresses = p.as_flattened().iter().zip(q.as_flattened());
            assert!(stresses.into_iter().all(|(p, q)| (p - q).abs() < 1e-12), "{law:?}");
        }
    }
}

#[test]
fn other_elements_are_refused() {
    let mesh = generate::rectangle(Element::T3, [0.0; 2], [1.0; 2], [1, 1]).unwrap();
    let refused =
        mean_dilatation_body(mesh, &[RegionMaterial { law: LAWS[0], density: 1.0 }], 1.0).err().unwrap();
    assert_eq!(refused.to_string(), "element T3 has no mean dilatation: it is for Q4 and Hex8");
}
