//! Degrees of the quadrature rules for forces, by measurement: the change of the nodal forces from
//! a rule to one of a far higher degree, over the error of these forces that is due to the shape
//! functions, in a block of 2 cells per side with straight or curved cells and strains of up to a
//! half.
//!
//! ```text
//! forces of the mesh    fᵃ = Σ w P(F_h) ∇₀φᵃ,   F_h of positions that are exact at the nodes
//! exact ones            fᵃ = ∫ P(F) ∇₀φᵃ dX
//! ```
//!
//!     cargo test --release -p carom-solid rules -- --nocapture        prints the table

#![allow(clippy::print_stdout)]

use carom_algebra::{Mat, Vector};
use carom_solid::material::{Material, NeoHookean};
use carom_solid::reference::gradient;
use carom_solid::shape::{Domain, Hex8, Hex27, Quad4, Quad9, Shape, Tet10, Tet20, Tri6, Tri10};
use carom_solid::{Element, Mesh, generate};

const LAW: NeoHookean = NeoHookean { lambda: 5.0, mu: 1.0 };

/// A smooth displacement and its gradient.
fn moved<const D: usize>(x: &Vector<D>) -> (Vector<D>, Mat<D>) {
    let mut u = Vector::ZERO;
    let mut h = Mat::ZERO;
    for i in 0..D {
        let j = (i + 1) % D;
        let phase = 1.5 * x[i] + 1.1 * x[j] + i as f64;
        u[i] = 0.2 * phase.sin();
        h.0[i][i] += 0.3 * phase.cos();
        h.0[i][j] += 0.22 * phase.cos();
    }
    (u, h)
}

fn stress<const D: usize>(h: &Mat<D>) -> Mat<D> {
    LAW.stress(&LAW.at(h).expect("it is valid"))
}

/// Largest change of a nodal force from the rule of a degree to one of degree `exact`, and largest
/// error of those.
fn errors<const D: usize, const N: usize, S: Shape<D, N>>(
    mesh: &Mesh,
    curved: bool,
    degree: usize,
    exact: usize,
) -> [f64; 2] {
    let bent = |x: &[f64; D]| {
        let bend = |i: usize| if curved { 0.12 * (2.0 * x[(i + 1) % D] + x[i]).sin() } else { 0.0 };
        Vector(std::array::from_fn(|i| x[i] + bend(i)))
    };
    let nodes: Vec<Vector<D>> = mesh.nodes.of_dimension::<D>().iter().map(bent).collect();
    let mut forces = [(); 3].map(|()| vec![Vector::<D>::ZERO; nodes.len()]);
    for cell in 0..mesh.cell_count() {
        let of_cell = mesh.cell(cell);
        let x: [Vector<D>; N] = std::array::from_fn(|a| nodes[of_cell[a]]);
        let u = x.map(|x| moved(&x).0);
        for (k, degree) in [degree, exact, exact].into_iter().enumerate() {
            for (xi, weight) in S::Domain::rule(degree).iter() {
                let values = S::values(xi);
                let local = S::gradients(xi);
                let map = gradient(&x, &local);
                let inverse_transposed = map.inverse().transposed();
                let gradients = local.map(|g| inverse_transposed.apply(&g));
                let place = (0..N).fold(Vector::ZERO, |sum, a| sum + x[a] * values[a]);
                let h = if k == 2 { moved(&place).1 } else { gradient(&u, &gradients) };
                let stress = stress(&h) * (weight * map.det());
                for a in 0..N {
                    forces[k][of_cell[a]] += stress.apply(&gradients[a]);
                }
            }
        }
    }
    let [rule, mesh, exact] = &forces;
    let largest =
        |a: &[Vector<D>], b: &[Vector<D>]| a.iter().zip(b).map(|(a, b)| (*a - *b).norm()).fold(0.0, f64::max);
    [largest(rule, mesh), largest(mesh, exact)]
}

/// The line of the table of an element; ratios of the rules that bodies use, straight and curved.
fn measure<const D: usize, const N: usize, S: Shape<D, N>>(element: Element) -> [f64; 2] {
    let mesh = if D == 2 {
        generate::rectangle(element, [0.0; 2], [1.0; 2], [2; 2])
    } else {
        generate::cuboid(element, [0.0; 3], [1.0; 3], [2; 3])
    };
    let mesh = mesh.expect("it is a block");
    let k = S::DEGREE;
    let exact = if D == 2 && !S::Domain::TENSOR { 10 } else { 14 };
    let chosen = [2 * k, (2 * k).max(4 * (k - 1))];
    [false, true].map(|curved| {
        let ratio = |degree: usize| {
            let [rule, shape] = errors::<D, N, S>(&mesh, curved, degree, exact);
            rule / shape
        };
        let of_chosen = chosen[usize::from(curved)];
        let ratios: Vec<String> = (of_chosen.saturating_sub(2)..=of_chosen + 2)
            .step_by(2)
            .map(|degree| format!("degree {degree}: {:8.5}", ratio(degree)))
            .collect();
        println!("{element:?}, {}  {}", if curved { "curved  " } else { "straight" }, ratios.join("   "));
        ratio(of_chosen)
    })
}

/// What the rules leave is small beside what the shape functions leave.
#[test]
fn the_rules_for_forces_cost_little_accuracy() {
    for [straight, curved] in [
        measure::<2, 6, Tri6>(Element::T6),
        measure::<2, 10, Tri10>(Element::T10),
        measure::<2, 4, Quad4>(Element::Q4),
        measure::<2, 9, Quad9>(Element::Q9),
        measure::<3, 10, Tet10>(Element::Tet10),
        measure::<3, 20, Tet20>(Element::Tet20),
        measure::<3, 8, Hex8>(Element::Hex8),
        measure::<3, 27, Hex27>(Element::Hex27),
    ] {
        assert!(straight < 0.1 && curved < 0.1, "{straight} {curved}");
    }
}
