//! What a prescribed motion needs of a body: the divergence of its stress, errors at its points,
//! and the nodes on the boundary.

use carom_solid::{Body, Element, Law, Mesh, Past, body, generate, plane_stress_body};

/// A quadratic motion: H = ∂y/∂X − 1 is linear in X.
fn motion([x, y]: [f64; 2]) -> [f64; 2] {
    [x + 0.1 * x * x + 0.05 * x * y - 0.02 * y, y - 0.08 * x * x + 0.03 * y * y + 0.1 * x]
}

fn gradient([x, y]: [f64; 2]) -> [[f64; 2]; 2] {
    [[0.2 * x + 0.05 * y, 0.05 * x - 0.02], [-0.16 * x + 0.1, 0.06 * y]]
}

/// Its second derivatives ∂²yₖ/∂Xᴶ∂Xᴸ, k first.
const SECOND: [f64; 8] = [0.2, 0.05, 0.05, 0.0, -0.16, 0.0, 0.0, 0.06];

/// P = J σ F⁻ᵀ from the stress at reference coordinates of a cell in this motion; the small-strain
/// law has only one stress.
fn nominal(body: &dyn Body, law: Law, y: &[f64], xi: [f64; 2], place: [f64; 2]) -> [[f64; 2]; 2] {
    let state = body.point(0, &xi, y, &Past::default()).unwrap();
    if matches!(law, Law::LinearElastic { .. }) {
        return std::array::from_fn(|i| std::array::from_fn(|j| state.cauchy[i][j]));
    }
    let h = gradient(place);
    let f = [[1.0 + h[0][0], h[0][1]], [h[1][0], 1.0 + h[1][1]]];
    let det = f[0][0] * f[1][1] - f[0][1] * f[1][0];
    // F⁻ᵀ, row by row.
    let inverse = [[f[1][1] / det, -f[1][0] / det], [-f[0][1] / det, f[0][0] / det]];
    std::array::from_fn(|i| {
        std::array::from_fn(|j| state.det_f * (0..2).map(|k| state.cauchy[i][k] * inverse[k][j]).sum::<f64>())
    })
}

/// Σ ∂Pᵢᴶ/∂Xᴶ by differences of the stress at neighbouring points of a cell, for every law and
/// plane state.
#[test]
fn the_divergence_of_the_stress_by_differences() {
    let (lambda, mu) = (2.0, 1.5);
    let laws = [
        Law::NeoHookean { lambda, mu },
        Law::SaintVenantKirchhoff { lambda, mu },
        Law::LinearElastic { lambda, mu },
    ];
    for law in laws {
        for stress in [false, true] {
            let mesh = generate::rectangle(Element::T6, [0.0, 0.0], [1.0, 1.0], [1, 1]).unwrap();
            let nodes = mesh.nodes.of_dimension::<2>();
            let y: Vec<f64> = nodes.iter().flat_map(|x| motion(*x)).collect();
            let corners: [[f64; 2]; 3] = std::array::from_fn(|k| nodes[mesh.cell(0)[k]]);
            let body =
                if stress { plane_stress_body(mesh, law, 1.0, 1.0) } else { body(mesh, law, 1.0, 1.0) }
                    .unwrap();
            let place = |xi: [f64; 2]| -> [f64; 2] {
                std::array::from_fn(|i| {
                    corners[0][i]
                        + xi[0] * (corners[1][i] - corners[0][i])
                        + xi[1] * (corners[2][i] - corners[0][i])
                })
            };
            // The cell's edges run along the axes or diagonally: differences in ξ are transformed
            // to X.
            let xi = [0.3, 0.4];
            let step = 1e-5;
            let at = |axis: usize, sign: f64| {
                let mut moved = xi;
                moved[axis] += sign * step;
                nominal(body.as_ref(), law, &y, moved, place(moved))
            };
            let edge: [[f64; 2]; 2] =
                std::array::from_fn(|axis| std::array::from_fn(|i| corners[axis + 1][i] - corners[0][i]));
            let det = edge[0][0] * edge[1][1] - edge[0][1] * edge[1][0];
            let inverse = [[edge[1][1] / det, -edge[0][1] / det], [-edge[1][0] / det, edge[0][0] / det]];
            let rates: [[[f64; 2]; 2]; 2] = std::array::from_fn(|axis| {
                let (after, before) = (at(axis, 1.0), at(axis, -1.0));
                std::array::from_fn(|i| std::array::from_fn(|j| (after[i][j] - before[i][j]) / (2.0 * step)))
            });
            let mut found = [0.0; 2];
            body.stress_divergence(0, gradient(place(xi)).as_flattened(), &SECOND, &mut found).unwrap();
            for i in 0..2 {
                // ∂/∂Xᴶ = Σ (∂ξ_axis/∂Xᴶ) ∂/∂ξ_axis.
                let expected: f64 = (0..2)
                    .map(|j| (0..2).map(|axis| inverse[j][axis] * rates[axis][i][j]).sum::<f64>())
                    .sum();
                assert!((found[i] - expected).abs() < 1e-8, "{law:?} {stress}: {found:?} {expected}");
            }
        }
    }
    let unit = generate::rectangle(Element::T3, [0.0, 0.0], [1.0, 1.0], [1, 1]).unwrap();
    let rubber = body(unit, laws[0], 1.0, 1.0).unwrap();
    assert_eq!(rubber.stress_divergence(0, &[-2.0, 0.0, 0.0, 0.0], &SECOND, &mut [0.0; 2]), Err(-1.0));
}

/// T6 represents a quadratic motion exactly at all points, and the points fill the volume.
#[test]
fn moved_points_have_their_places() {
    let mesh = generate::rectangle(Element::T6, [0.0, 0.0], [2.0, 1.0], [3, 2]).unwrap();
    let y: Vec<f64> = mesh.nodes.of_dimension::<2>().iter().flat_map(|x| motion(*x)).collect();
    let law = Law::NeoHookean { lambda: 2.0, mu: 1.5 };
    let body = body(mesh, law, 1.0, 0.5).unwrap();
    let mut sum = 0.0;
    for cell in 0..body.mesh().cell_count() {
        body.each_moved_point(cell, &y, &mut |place, moved, h, volume| {
            sum += volume;
            let place = [place[0], place[1]];
            for i in 0..2 {
                assert!((moved[i] - motion(place)[i]).abs() < 1e-14);
                assert!((0..2).all(|j| (h[2 * i + j] - gradient(place)[i][j]).abs() < 1e-13));
            }
        });
    }
    assert!((sum - 1.0).abs() < 1e-14, "{sum}");
}

/// The boundary of built-in shapes is the union of their sides.
#[test]
fn the_boundary_is_all_sides() {
    fn check(mesh: &Mesh) {
        let on = mesh.on_boundary();
        let mut named = vec![false; mesh.nodes.len()];
        for side in mesh.sides.keys() {
            mesh.side_nodes(side).unwrap().into_iter().for_each(|n| named[n] = true);
        }
        assert!(on == named && on.contains(&true) && on.contains(&false));
    }
    for element in [Element::L2, Element::L3, Element::L4] {
        check(&generate::interval(element, 0.0, 1.0, 3).unwrap());
    }
    for element in [Element::T3, Element::T6, Element::T10] {
        check(&generate::rectangle(element, [0.0, 0.0], [1.0, 2.0], [2, 3]).unwrap());
        check(&generate::half_disc(element, 1.0, [0.0, 0.0], 0.4).unwrap());
        check(&generate::ring(element, 0.5, 1.0, [0.0, 0.0], 0.2).unwrap());
    }
}
