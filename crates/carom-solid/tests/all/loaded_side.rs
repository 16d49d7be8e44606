//! Loads on sides: resultants, balance, and the tangent of a pressure by exact differences.

use carom_solid::{Element, LoadedSide, Mesh, generate};

fn side(mesh: &Mesh, name: &str) -> LoadedSide {
    LoadedSide::new(mesh, &mesh.sides[name], 0, 0.5)
}

fn total(force: &[f64]) -> [f64; 2] {
    force.as_chunks::<2>().0.iter().fold([0.0; 2], |s, f| [s[0] + f[0], s[1] + f[1]])
}

#[test]
fn tractions_on_a_straight_side_and_an_arc_have_their_resultants() {
    let mesh = generate::rectangle(Element::T10, [0.0, 0.0], [2.0, 1.0], [3, 2]).unwrap();
    let top = side(&mesh, "top");
    let mut force = vec![0.0; 2 * mesh.nodes.len()];
    let traction: Vec<_> = top.positions().map(|x| [1.0, x[0].powi(3)]).collect();
    top.add_traction(traction.iter().map(|t| &t[..]), &mut force);
    let [fx, fy] = total(&force);
    assert!((fx - 1.0).abs() < 1e-14 && (fy - 2.0).abs() < 1e-14, "{fx} {fy}");
    // Also the moment of a cubic traction: φ reproduces x exactly.
    let moment: f64 = force.as_chunks::<2>().0.iter().zip(&mesh.nodes).map(|(f, x)| f[1] * x[0]).sum();
    assert!((moment - 0.5 * 32.0 / 5.0).abs() < 1e-14);

    // The circle's length by cubics through its points: the error is of fourth order.
    let errors = [0.5, 0.25].map(|size| {
        let mesh = generate::disc(Element::T10, 2.0, [0.0, 0.0], size).unwrap();
        let arc = side(&mesh, "arc");
        let mut force = vec![0.0; 2 * mesh.nodes.len()];
        arc.add_traction(std::iter::repeat_n(&[0.0, 1.0][..], arc.positions().len()), &mut force);
        total(&force)[1] / 0.5 - 4.0 * std::f64::consts::PI
    });
    assert!(errors[1].abs() < 1e-5 && (errors[0] / errors[1]).log2() > 3.9, "{errors:?}");
}

#[test]
fn a_uniform_pressure_on_a_closed_side_is_balanced_and_points_inwards() {
    let mesh = generate::disc(Element::T6, 1.0, [0.3, -0.2], 0.4).unwrap();
    let arc = side(&mesh, "arc");
    let y: Vec<f64> = mesh.nodes.iter().flat_map(|x| [x[0] + 0.1 * x[1] * x[1], x[1] - 0.2 * x[0]]).collect();
    let mut force = vec![0.0; 2 * mesh.nodes.len()];
    arc.add_pressure(&vec![3.0; arc.positions().len()], &y, &mut force);
    let [fx, fy] = total(&force);
    assert!(fx.abs() + fy.abs() < 1e-13);
    // Virial: Σ f·y = −2 p A, with A the area enclosed by the same polynomials.
    let virial: f64 = force.iter().zip(&y).map(|(f, y)| f * y).sum();
    assert!(virial < 0.0);
}

#[test]
fn the_tangent_of_the_pressure_is_its_derivative() {
    for element in [Element::T3, Element::T6, Element::T10] {
        let mesh = generate::half_disc(element, 1.0, [0.0, 0.0], 0.5).unwrap();
        let arc = side(&mesh, "arc");
        let pressure: Vec<f64> = arc.positions().map(|x| 1.0 + x[1] * x[0]).collect();
        let y: Vec<f64> =
            mesh.nodes.iter().flat_map(|x| [x[0] + 0.2 * x[1].sin(), x[1] + 0.1 * x[0]]).collect();
        let at = |y: &[f64]| {
            let mut force = vec![0.0; y.len()];
            arc.add_pressure(&pressure, y, &mut force);
            force
        };
        let direction = |dof: usize| (dof as f64 * 12.9898).sin();
        let moved =
            |h: f64| -> Vec<f64> { y.iter().enumerate().map(|(k, y)| y + h * direction(k)).collect() };
        let (plus, minus) = (at(&moved(0.5)), at(&moved(-0.5)));
        let mut product = vec![0.0; y.len()];
        for (f, nodes) in arc.facets().iter().enumerate() {
            let n = nodes.len();
            let mut tangent = vec![0.0; 4 * n * n];
            arc.facet_tangent(f, &pressure, &y, &mut tangent);
            for a in 0..2 * n {
                for b in 0..2 * n {
                    product[2 * nodes[a / 2] + a % 2] +=
                        tangent[a * 2 * n + b] * direction(2 * nodes[b / 2] + b % 2);
                }
            }
        }
        // The force is linear in y: the difference is exact.
        for dof in 0..y.len() {
            let difference = plus[dof] - minus[dof];
            assert!((difference - product[dof]).abs() < 1e-14, "{element:?} dof {dof}");
        }
    }
}

#[test]
fn a_bar_is_loaded_on_its_cross_section() {
    let mesh = generate::interval(Element::L3, 1.0, 3.0, 4).unwrap();
    for (name, sign) in [("left", 1.0), ("right", -1.0)] {
        let end = LoadedSide::new(&mesh, &mesh.sides[name], 0, 0.25);
        let y = mesh.nodes.flat();
        let mut force = vec![0.0; y.len()];
        end.add_pressure(&[8.0], y, &mut force);
        assert_eq!(force.iter().sum::<f64>(), sign * 2.0);
        end.add_traction([&[-sign * 8.0][..]], &mut force);
        assert!(force.iter().all(|f| *f == 0.0));
    }
}
