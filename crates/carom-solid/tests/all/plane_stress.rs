//! Sheets in plane stress: cells by differences, and Cook's membrane.

use carom_solid::{Element, Law, generate, line_shape, plane_stress_body};

const LAWS: [Law; 3] = [
    Law::NeoHookean { lambda: 2.0, mu: 1.5 },
    Law::SaintVenantKirchhoff { lambda: 2.0, mu: 1.5 },
    Law::LinearElastic { lambda: 2.0, mu: 1.5 },
];

#[test]
fn force_and_tangent_are_derivatives() {
    for (element, law) in
        [Element::T3, Element::T6, Element::T10].into_iter().flat_map(|e| LAWS.map(|l| (e, l)))
    {
        let body =
            plane_stress_body(generate::ring(element, 0.5, 1.0, [0.3, -0.2], 0.5).unwrap(), law, 0.7, 2.0)
                .unwrap();
        let n = element.nodes() * 2;
        let bent =
            |x: &[f64]| [x[0] + 0.1 * x[1] * x[1] - 0.05 * x[0] * x[1], 0.9 * x[1] + 0.07 * x[0].sin()];
        let mut y: Vec<f64> = body.mesh().nodes.iter().flat_map(bent).collect();
        let cell = body.mesh().sides["outer"][1].cell;
        let nodes = body.mesh().cell(cell).to_vec();
        let (mut force, mut tangent) = (vec![0.0; n], vec![0.0; n * n]);
        body.cell_tangent(cell, &y, &mut force, &mut tangent).unwrap();
        let h = 1e-6;
        for column in 0..n {
            let mut at = |s: f64| {
                let mut f = vec![0.0; n];
                y[2 * nodes[column / 2] + column % 2] += s;
                let energy = body.cell_force(cell, &y, &mut f).unwrap();
                y[2 * nodes[column / 2] + column % 2] -= s;
                (energy, f)
            };
            let (plus, minus) = (at(h), at(-h));
            assert!(((plus.0 - minus.0) / (2.0 * h) - force[column]).abs() < 1e-8, "{element:?} {law:?}");
            for row in 0..n {
                let slope = (plus.1[row] - minus.1[row]) / (2.0 * h);
                assert!((slope - tangent[row * n + column]).abs() < 1e-7, "{element:?} {law:?}");
                assert_eq!(tangent[row * n + column], tangent[column * n + row]);
            }
        }
    }
}

/// Solves A x = b, A symmetric positive definite, by Cholesky factorisation.
fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for j in 0..n {
        let (above, below) = a.split_at_mut(j);
        let row = &mut below[0];
        for k in 0..j {
            let dot: f64 = above[k][..k].iter().zip(&row[..k]).map(|(x, y)| x * y).sum();
            row[k] = (row[k] - dot) / above[k][k];
        }
        let pivot = row[j] - row[..j].iter().map(|x| x * x).sum::<f64>();
        assert!(pivot > 0.0);
        row[j] = pivot.sqrt();
        b[j] = (b[j] - row[..j].iter().zip(&b).map(|(x, y)| x * y).sum::<f64>()) / row[j];
    }
    for j in (0..n).rev() {
        b[j] /= a[j][j];
        let x = b[j];
        b[..j].iter_mut().zip(&a[j]).for_each(|(y, l)| *y -= l * x);
    }
    b
}

/// Deflection of Cook's membrane at (48, 52): clamped at x = 0, a uniform shear of total 1 at x =
/// 48, E = 1, ν = 1/3, thickness 1.
fn cook(element: Element, size: f64) -> f64 {
    let corners = [[0.0, 0.0], [48.0, 44.0], [48.0, 60.0], [0.0, 44.0]];
    let mesh = generate::polygon(element, &corners, size, &[]).unwrap();
    let (young, poisson) = (1.0, 1.0 / 3.0);
    let lambda = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    let body =
        plane_stress_body(mesh, Law::LinearElastic { lambda, mu: young / (2.0 * (1.0 + poisson)) }, 0.0, 1.0)
            .unwrap();
    let mesh = body.mesh();
    let clamped = mesh.side_nodes("side4").unwrap();
    let mut unknown = vec![usize::MAX; mesh.nodes.len()];
    let mut count = 0;
    for node in (0..mesh.nodes.len()).filter(|n| !clamped.contains(n)) {
        (unknown[node], count) = (count, count + 1);
    }
    let (mut a, mut b) = (vec![vec![0.0; 2 * count]; 2 * count], vec![0.0; 2 * count]);
    let n = element.nodes();
    let (mut force, mut tangent) = (vec![0.0; 2 * n], vec![0.0; 4 * n * n]);
    for cell in 0..mesh.cell_count() {
        body.cell_tangent(cell, mesh.nodes.flat(), &mut force, &mut tangent).unwrap();
        let dof = |k: usize| unknown[mesh.cell(cell)[k / 2]].checked_mul(2).map(|d| d + k % 2);
        for (i, j) in (0..2 * n).flat_map(|i| (0..2 * n).map(move |j| (i, j))) {
            if let (Some(row), Some(column)) = (dof(i), dof(j)) {
                a[row][column] += tangent[i * 2 * n + j];
            }
        }
    }
    for facet in &mesh.sides["side2"] {
        let length = mesh.nodes[facet.nodes[1]][1] - mesh.nodes[facet.nodes[0]][1];
        for (xi, w) in [(-0.6_f64.sqrt(), 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.6_f64.sqrt(), 5.0 / 18.0)] {
            for (&node, value) in facet.nodes.iter().zip(&line_shape(facet.nodes.len(), xi).values) {
                b[2 * unknown[node] + 1] += w * value * length / 16.0;
            }
        }
    }
    let u = solve(a, b);
    let (cell, xi) = &body.locate(&[48.0, 52.0])[0];
    let mut shape = vec![0.0; n];
    body.shape(xi, &mut shape);
    mesh.cell(*cell).iter().zip(&shape).map(|(&node, s)| s * u[2 * unknown[node] + 1]).sum()
}

/// The problem of R. D. Cook (J. Struct. Div. ASCE 100 (1974) 1851–1863); 23.96 is the commonly
/// used value of refined meshes.
#[test]
fn cooks_membrane() {
    for (element, size, tolerance) in
        [(Element::T6, 4.0, 0.02), (Element::T6, 2.8, 0.01), (Element::T10, 5.5, 0.01)]
    {
        let v = cook(element, size);
        assert!((v - 23.96).abs() < tolerance, "{element:?} {size}: {v}");
    }
}
