//! Bodies through their interface: rigid motion, derivatives, affine patch test, masses, stress,
//! location of points.

use carom_solid::{
    Body, Bounds, Element, Law, Mesh, Past, PointLocator, SolidError, body, cell_lumped_mass, generate,
    line_shape,
};

const LAMBDA: f64 = 2.0;
const MU: f64 = 1.5;
const TRIANGLES: [Element; 3] = [Element::T3, Element::T6, Element::T10];
const LINES: [Element; 3] = [Element::L2, Element::L3, Element::L4];
const LAWS: [Law; 3] = [
    Law::NeoHookean { lambda: LAMBDA, mu: MU },
    Law::SaintVenantKirchhoff { lambda: LAMBDA, mu: MU },
    Law::LinearElastic { lambda: LAMBDA, mu: MU },
];

/// A straight and a curved mesh of an element.
fn meshes(element: Element) -> [Mesh; 2] {
    [
        generate::rectangle(element, [-1.0, 0.5], [1.0, 2.0], [2, 3]).unwrap(),
        generate::disc(element, 1.0, [0.3, -0.2], 0.5).unwrap(),
    ]
}

fn all_bodies() -> impl Iterator<Item = (Element, Law, Box<dyn Body>)> {
    TRIANGLES.into_iter().flat_map(|element| {
        LAWS.into_iter().flat_map(move |law| {
            meshes(element).into_iter().map(move |mesh| (element, law, body(mesh, law, 0.7, 2.0).unwrap()))
        })
    })
}

fn moved(body: &dyn Body, motion: impl Fn(&[f64]) -> [f64; 2]) -> Vec<f64> {
    body.mesh().nodes.iter().flat_map(motion).collect()
}

/// Energy and nodal forces of the whole body.
fn forces<const D: usize>(body: &dyn Body, y: &[f64]) -> (f64, Vec<[f64; D]>) {
    let mut sum = vec![[0.0; D]; y.len() / D];
    let mut local = vec![0.0; body.mesh().element.nodes() * D];
    let mut energy = 0.0;
    for cell in 0..body.mesh().cell_count() {
        energy += body.cell_force(cell, y, &mut local).unwrap();
        for (a, &node) in body.mesh().cell(cell).iter().enumerate() {
            for i in 0..D {
                sum[node][i] += local[a * D + i];
            }
        }
    }
    (energy, sum)
}

fn largest(forces: &[[f64; 2]]) -> f64 {
    forces.iter().flatten().fold(0.0, |m, f| m.max(f.abs()))
}

#[test]
fn rigid_motion_gives_no_force() {
    for (element, law, body) in all_bodies() {
        if matches!(law, Law::LinearElastic { .. }) {
            continue;
        }
        let (s, c) = 2.3_f64.sin_cos();
        let y = moved(&*body, |x| [c * x[0] - s * x[1] + 5.0, s * x[0] + c * x[1] - 3.0]);
        let (energy, f) = forces::<2>(&*body, &y);
        assert!(
            largest(&f) < 1e-12 && energy.abs() < 1e-12,
            "{element:?} {law:?}: {:e}, {energy:e}",
            largest(&f)
        );
    }
}

#[test]
fn force_and_tangent_are_derivatives_and_the_tangent_is_symmetric() {
    for (element, law, body) in all_bodies() {
        let n = element.nodes() * 2;
        let mut y = moved(&*body, |x| {
            [x[0] + 0.1 * x[1] * x[1] - 0.05 * x[0] * x[1], 0.9 * x[1] + 0.07 * x[0].sin()]
        });
        let (mut force, mut only, mut tangent) = (vec![0.0; n], vec![0.0; n], vec![0.0; n * n]);
        // The last cell of the disc is curved.
        let cell = body.mesh().cell_count() - 1;
        let nodes = body.mesh().cell(cell).to_vec();
        let energy = body.cell_tangent(cell, &y, &mut force, &mut tangent).unwrap();
        assert_eq!(energy, body.cell_force(cell, &y, &mut only).unwrap());
        assert_eq!(force, only);
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
            let slope = (plus.0 - minus.0) / (2.0 * h);
            assert!(
                (slope - force[column]).abs() < 1e-8,
                "{element:?} {law:?}: {slope} against {}",
                force[column]
            );
            for row in 0..n {
                let slope = (plus.1[row] - minus.1[row]) / (2.0 * h);
                let value = tangent[row * n + column];
                assert!((slope - value).abs() < 1e-7, "{element:?} {law:?}: {slope} against {value}");
                assert_eq!(value, tangent[column * n + row]);
            }
        }
    }
}

/// An affine motion has constant stress, and interior nodes are in equilibrium on straight and
/// curved cells.
#[test]
fn affine_patch() {
    for (element, law, body) in all_bodies() {
        let y = moved(&*body, |x| [1.1 * x[0] + 0.2 * x[1], -0.1 * x[0] + 0.95 * x[1]]);
        let first = body.point(0, &[0.2, 0.3], &y, &Past::default()).unwrap();
        for cell in 0..body.mesh().cell_count() {
            let here = body.point(cell, &[0.5, 0.1], &y, &Past::default()).unwrap();
            assert!((here.det_f - (1.1 * 0.95 + 0.02)).abs() < 1e-13);
            assert!((body.min_det_f(cell..cell + 1, &y, &Past::default()) - here.det_f).abs() < 1e-13);
            for (a, b) in here.cauchy.as_flattened().iter().zip(first.cauchy.as_flattened()) {
                assert!((a - b).abs() < 1e-12, "{element:?} {law:?}");
            }
        }
        let boundary: Vec<usize> =
            body.mesh().sides.values().flatten().flat_map(|f| f.nodes.clone()).collect();
        let (_, f) = forces::<2>(&*body, &y);
        for (node, f) in f.iter().enumerate().filter(|(node, _)| !boundary.contains(node)) {
            assert!(f[0].hypot(f[1]) < 1e-12, "{element:?} {law:?}: node {node} is pulled by {f:?}");
        }
        // Forces and (for objective laws) moments of all nodes balance.
        for i in 0..2 {
            assert!(f.iter().map(|f| f[i]).sum::<f64>().abs() < 1e-11);
        }
    }
}

/// Tension on an edge: consistent forces of a uniform stress are 1/2 1/2, 1/6 1/6 4/6 and 1/8 1/8
/// 3/8 3/8 of the edge's share.
#[test]
fn uniform_stress_gives_the_consistent_edge_forces() {
    for (element, weights) in [
        (Element::T3, vec![0.5, 0.5]),
        (Element::T6, vec![1.0 / 6.0, 1.0 / 6.0, 4.0 / 6.0]),
        (Element::T10, vec![0.125, 0.125, 0.375, 0.375]),
    ] {
        let mesh = generate::rectangle(element, [0.0, 0.0], [1.0, 0.5], [1, 1]).unwrap();
        let law = Law::LinearElastic { lambda: 0.0, mu: 0.5 };
        let body = body(mesh, law, 1.0, 3.0).unwrap();
        let (_, f) = forces::<2>(&*body, &moved(&*body, |x| [1.01 * x[0], x[1]]));
        for (&node, weight) in body.mesh().sides["right"][0].nodes.iter().zip(weights) {
            assert!((f[node][0] - 0.01 * 0.5 * 3.0 * weight).abs() < 1e-15);
        }
    }
}

#[test]
fn masses_and_volumes_add_up() {
    for (element, _, body) in all_bodies() {
        let n = element.nodes();
        let (mut volume, mut mass, mut lumped) = (0.0, 0.0, 0.0);
        for cell in 0..body.mesh().cell_count() {
            let (mut volumes, mut matrix, mut work, mut masses) =
                (vec![0.0; n], vec![0.0; n * n], vec![0.0; n * n], vec![0.0; n]);
            body.cell_volumes(cell, &mut volumes);
            body.cell_mass(cell, &mut matrix);
            cell_lumped_mass(&*body, cell, &mut work, &mut masses);
            // Row sums of the consistent mass are ρ₀ times the nodal volumes.
            for a in 0..n {
                assert!((matrix[a * n..(a + 1) * n].iter().sum::<f64>() - 0.7 * volumes[a]).abs() < 1e-15);
                assert!(masses[a] > 0.0);
            }
            volume += volumes.iter().sum::<f64>();
            mass += matrix.iter().sum::<f64>();
            lumped += masses.iter().sum::<f64>();
        }
        assert!((mass - 0.7 * volume).abs() < 1e-13 && (lumped - mass).abs() < 1e-13);
        if body.mesh().sides.contains_key("top") {
            assert!((volume - 2.0 * 3.0).abs() < 1e-13, "{element:?}: volume {volume}");
        }
    }
}

/// Two rings: the polygon misses 4.5 % of the disc's area; curved cells converge to it with their
/// order.
#[test]
fn curved_discs_have_their_area() {
    let area = |element, size: f64| {
        let body = body(generate::disc(element, 1.0, [0.0, 0.0], size).unwrap(), LAWS[0], 1.0, 1.0).unwrap();
        let mut volumes = vec![0.0; element.nodes()];
        let cells = 0..body.mesh().cell_count();
        let mut sum = 0.0;
        cells.for_each(|cell| {
            body.cell_volumes(cell, &mut volumes);
            sum += volumes.iter().sum::<f64>();
        });
        (sum / std::f64::consts::PI - 1.0).abs()
    };
    assert!(area(Element::T6, 0.5) < 2e-4 && area(Element::T10, 0.5) < 3e-5);
    // A polynomial arc of degree k is of order k + 1, and its area of one order more for even k,
    // where the error is odd along the arc.
    for (element, order) in [(Element::T3, 2.0), (Element::T6, 4.0), (Element::T10, 4.0)] {
        let measured = (area(element, 0.5) / area(element, 0.25)).log2();
        assert!(measured > order - 0.1, "{element:?}: order {measured}");
    }
}

#[test]
fn lateral_stress_of_plane_strain_follows_from_three_dimensions() {
    for (law, expected) in [
        (LAWS[0], |j: f64, _: f64| LAMBDA * j.ln() / j),
        (LAWS[1], |j: f64, e: f64| LAMBDA * (e + 0.5 * e * e) / j),
        (LAWS[2], |_: f64, e: f64| LAMBDA * e),
    ] as [(Law, fn(f64, f64) -> f64); 3]
    {
        let [mesh, _] = meshes(Element::T6);
        let body = body(mesh, law, 1.0, 1.0).unwrap();
        let y = moved(&*body, |x| [1.2 * x[0], x[1]]);
        let state = body.point(0, &[0.3, 0.3], &y, &Past::default()).unwrap();
        assert!((state.cauchy[2][2] - expected(1.2, 0.2)).abs() < 1e-14);
        // Stretched along x only, y and z are equivalent.
        assert!((state.cauchy[1][1] - state.cauchy[2][2]).abs() < 1e-14);
        assert_eq!((state.cauchy[0][2], state.cauchy[1][2]), (0.0, 0.0));
    }
}

#[test]
fn an_inverted_cell_is_named() {
    let [mesh, _] = meshes(Element::T6);
    let body = body(mesh, LAWS[0], 1.0, 1.0).unwrap();
    let y = moved(&*body, |x| [-x[0], x[1]]);
    let error = body.cell_force(3, &y, &mut [0.0; 12]).unwrap_err();
    assert_eq!(error.to_string(), "cell 3 is inverted: J = -1.000e0");
    assert!((body.min_det_f(3..4, &y, &Past::default()) + 1.0).abs() < 1e-14);
}

#[test]
fn places_are_found_in_straight_and_curved_cells() {
    for element in TRIANGLES {
        for mesh in meshes(element) {
            let body = body(mesh, LAWS[0], 1.0, 1.0).unwrap();
            let mesh = body.mesh();
            let mut values = vec![0.0; element.nodes()];
            let mut interpolated = |cell: usize, xi: &[f64]| {
                body.shape(xi, &mut values);
                let at = |i: usize| {
                    mesh.cell(cell).iter().zip(&values).map(|(&n, v)| mesh.nodes[n][i] * v).sum::<f64>()
                };
                [at(0), at(1)]
            };
            for cell in 0..mesh.cell_count() {
                // Also on the curved edge and just inside.
                for xi in [[0.2, 0.3], [0.5, 0.5], [0.499, 0.5], [0.0, 0.4]] {
                    let x = interpolated(cell, &xi);
                    let found = body.locate(&x);
                    let here = found.iter().find(|(c, _)| *c == cell).unwrap();
                    assert!((here.1[0] - xi[0]).abs() + (here.1[1] - xi[1]).abs() < 1e-12);
                    for (cell, xi) in &found {
                        let again = interpolated(*cell, xi);
                        assert!((again[0] - x[0]).hypot(again[1] - x[1]) < 1e-12);
                    }
                }
            }
            for (node, x) in mesh.nodes.iter().enumerate() {
                let around = (0..mesh.cell_count())
                    .filter(|&cell| mesh.cell(cell).contains(&node))
                    .collect::<Vec<_>>();
                let found = body.locate(x).into_iter().map(|(cell, _)| cell).collect::<Vec<_>>();
                assert_eq!(found, around, "{element:?}, node {node}");
            }
            for code in 0..400 {
                let x = [f64::from(code % 20), f64::from(code / 20)].map(|c| 0.2 * c - 2.03);
                let one_by_one = (0..mesh.cell_count())
                    .filter_map(|cell| Some((cell, body.invert(cell, mesh.nodes.flat(), &x)?)))
                    .collect::<Vec<_>>();
                assert_eq!(body.locate(&x), one_by_one);
            }
            assert!(body.locate(&[10.0, 0.0]).is_empty());
            assert!(body.locate(&[1.4, 0.6]).is_empty());
        }
    }
}

#[test]
fn bars_stretch_like_bars() {
    for element in LINES {
        let mesh = generate::interval(element, 0.0, 10.0, 4).unwrap();
        let bar = body(mesh, Law::LinearElastic { lambda: 0.0, mu: 450.0 }, 1.0, 2.0).unwrap();
        let y: Vec<f64> = bar.mesh().nodes.iter().map(|x| 1.01 * x[0] - 4.0).collect();
        let (energy, f) = forces::<1>(&*bar, &y);
        assert!((energy - 0.5 * 900.0 * 1e-4 * 20.0).abs() < 1e-11);
        let right = bar.mesh().sides["right"][0].nodes[0];
        let left = bar.mesh().sides["left"][0].nodes[0];
        assert!((f[right][0] - 18.0).abs() < 1e-11 && (f[left][0] + 18.0).abs() < 1e-11);
        let inner = (0..f.len()).filter(|n| *n != left && *n != right);
        assert!(inner.map(|n| f[n][0].abs()).fold(0.0, f64::max) < 1e-11);
        assert_eq!(bar.locate(&[5.0]).len(), 2);
        assert_eq!(bar.locate(&[10.0]).len(), 1);
    }
}

/// Below the round-off of positions if H were formed from F.
#[test]
fn small_motions_keep_their_digits() {
    for law in [LAWS[0], LAWS[1]] {
        let [mesh, _] = meshes(Element::T10);
        let solid = body(mesh.clone(), law, 1.0, 1.0).unwrap();
        let hooke = body(mesh, LAWS[2], 1.0, 1.0).unwrap();
        let y = moved(&*solid, |x| [x[0] + 1e-9 * x[1], x[1] + 2e-9 * x[0] * x[1]]);
        let ((e, f), (e_hooke, f_hooke)) = (forces::<2>(&*solid, &y), forces(&*hooke, &y));
        assert!((e / e_hooke - 1.0).abs() < 1e-6, "{e:e} against {e_hooke:e}");
        for (f, g) in f.iter().zip(&f_hooke) {
            assert!((f[0] - g[0]).hypot(f[1] - g[1]) < 1e-6 * largest(&f_hooke));
        }
    }
}

#[test]
fn bad_bodies_are_refused_with_cell_and_place() {
    let mesh = || generate::rectangle(Element::T3, [0.0, 0.0], [1.0, 1.0], [1, 1]).unwrap();
    let error = |mesh, density, thickness| body(mesh, LAWS[0], density, thickness).err().unwrap();
    assert_eq!(error(mesh(), -1.0, 1.0), SolidError::Density(-1.0));
    assert_eq!(error(mesh(), 1.0, 0.0), SolidError::Thickness(0.0));
    assert!(matches!(error(mesh(), f64::NAN, 1.0), SolidError::Density(_)));
    let mut turned = mesh();
    turned.cells.swap(3, 4);
    let message = error(turned, 1.0, 1.0).to_string();
    assert!(message.starts_with("cell 1 is degenerate at [1.0000, 1.0000]: the Jacobian"), "{message}");
    let mut missing = mesh();
    missing.cells[4] = 9;
    assert_eq!(error(missing, 1.0, 1.0), SolidError::MissingNode { cell: 1, node: 9, count: 4 });
    let mut loose = mesh();
    loose.sides.get_mut("top").unwrap()[0].cell = 2;
    let message = error(loose, 1.0, 1.0).to_string();
    assert!(message.starts_with("a facet of side \"top\" refers to cell 2 and nodes ["), "{message}");
    let mut wrong = mesh();
    wrong.element = Element::L3;
    assert!(matches!(error(wrong, 1.0, 1.0), SolidError::Dimension { dimension: 2, .. }));
}

/// Ray casting: a point lies in a polygon if a ray from it crosses its boundary an odd number of
/// times.
#[test]
fn a_body_contains_what_its_boundary_encloses() {
    for element in TRIANGLES {
        for mesh in meshes(element) {
            let body = body(mesh, LAWS[0], 1.0, 1.0).unwrap();
            let mesh = body.mesh();
            let y = moved(&*body, |x| [x[0] - 0.3 * x[1] + 0.1 * x[0] * x[0], 0.2 * x[0] + 1.1 * x[1]]);
            let locator = PointLocator::new(&*body, &y);
            let mut boundary = Vec::new();
            for facet in mesh.sides.values().flatten() {
                let at = |xi: f64| {
                    let shape = line_shape(facet.nodes.len(), xi).values;
                    let sum =
                        |i: usize| facet.nodes.iter().zip(shape).map(|(&n, v)| v * y[2 * n + i]).sum::<f64>();
                    [sum(0), sum(1)]
                };
                boundary.extend((0..40).map(|k| f64::from(k) / 20.0 - 1.0).map(|xi| [at(xi), at(xi + 0.05)]));
            }
            let bounds: Bounds = y.chunks(2).collect();
            let mut inside = 0;
            for code in 0..900 {
                let unit = [f64::from(code % 30), f64::from(code / 30)].map(|c| (c + 0.37) / 30.0);
                let [p, q] = [0, 1].map(|i| bounds.low()[i] + unit[i] * bounds.extents()[i]);
                let crossed = boundary.iter().filter(|[a, b]| {
                    (a[1] > q) != (b[1] > q) && a[0] + (q - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) > p
                });
                let odd = crossed.count() % 2 == 1;
                inside += usize::from(odd);
                let cells = (0..mesh.cell_count()).any(|cell| body.invert(cell, &y, &[p, q]).is_some());
                assert_eq!(locator.contains(&[p, q]), cells, "the boxes have left out a cell");
                // Too near to the polygon to be distinguished from the curve.
                let near = boundary.iter().any(|[a, _]| (a[0] - p).hypot(a[1] - q) < 0.02 * bounds.size());
                assert!(near || locator.contains(&[p, q]) == odd, "{element:?} at {p}, {q}");
            }
            assert!(inside > 200, "{inside}");
            assert!(y.chunks(2).all(|node| locator.contains(node)));
            assert!(!locator.contains(&[f64::NAN, 0.0]));
        }
    }
}
