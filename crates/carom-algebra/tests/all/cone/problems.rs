//! Unilateral contact with Coulomb's law against brute force.

use carom_algebra::{Cone, Couplings, Kind};
use faer::linalg::solvers::Solve;

/// Two rows that are the same: proximal steps converge to the stricter of their conditions.
#[test]
fn of_dependent_rows_each_inequality_counts() {
    let kinds = [Kind::Normal; 2];
    let mut z = Vec::new();
    for _ in 0..2 {
        let matrix = &mut Couplings::dense(2, vec![1.0; 4]);
        let right = &mut [-1.0, -2.0];
        Cone { matrix, right, kinds: &kinds, is_dependent: true }.solve(&mut z).unwrap();
    }
    assert!((z[0] + z[1] - 2.0).abs() < 1e-15);
}

/// All combinations of open, sticking and slipping contacts, tried one by one, against the
/// solution: of two contacts in the plane, for many motions and coefficients.
#[test]
fn the_solution_is_the_one_that_brute_force_finds() {
    let wave = |k: usize| (k as f64 * 12.9898).sin() * 43758.5453 % 1.0;
    for case in 0..400 {
        let basis: Vec<f64> = (0..16).map(|k| wave(k + 100 * case)).collect();
        let mut matrix = vec![0.0; 16];
        for i in 0..4 {
            for j in 0..4 {
                let dot = (0..4).map(|k| basis[4 * i + k] * basis[4 * j + k]).sum::<f64>();
                matrix[4 * i + j] = dot + f64::from(u8::from(i == j)) * 0.5;
            }
        }
        let right: Vec<f64> = (0..4).map(|k| wave(k + 7 + 100 * case)).collect();
        let mu = [0.0, 0.1, 0.3][case % 3];
        let tangential = |of| Kind::Tangential { of, coefficient: mu, limit: f64::INFINITY };
        let kinds = [Kind::Normal, Kind::Normal, tangential(0), tangential(1)];
        let mut z = Vec::new();
        let couplings = &mut Couplings::dense(4, matrix.clone());
        let free = &mut right.clone();
        let cone = Cone { matrix: couplings, right: free, kinds: &kinds, is_dependent: false };
        cone.solve(&mut z).unwrap();
        let found = brute_force(&matrix, &right, mu);
        let is_one = |other: &[f64; 4]| (0..4).all(|i| (other[i] - z[i]).abs() < 1e-9);
        assert!(found.iter().any(is_one), "{case}: {z:?} is none of {found:?}");
    }
}

/// Every solution of two contacts in the plane: of 4 × 4 ways, open, sticking or slipping
/// either way, those whose forces and motions obey the law.
fn brute_force(a: &[f64], b: &[f64], mu: f64) -> Vec<[f64; 4]> {
    let mut solutions = Vec::new();
    for ways in 0..16 {
        let way = [ways % 4, ways / 4];
        // Columns of P₀, P₁, Q₀, Q₁ in terms of the unknowns, and the rows that vanish.
        let mut system = faer::Mat::<f64>::identity(4, 4);
        let mut right = faer::Mat::<f64>::zeros(4, 1);
        for contact in 0..2 {
            let normal = contact;
            let slip = contact + 2;
            if way[contact] > 0 {
                (0..4).for_each(|j| system[(normal, j)] = a[4 * normal + j]);
                right[(normal, 0)] = -b[normal];
            }
            match way[contact] {
                1 => {
                    (0..4).for_each(|j| system[(slip, j)] = a[4 * slip + j]);
                    right[(slip, 0)] = -b[slip];
                }
                2 => system[(slip, normal)] = -mu,
                3 => system[(slip, normal)] = mu,
                _ => {}
            }
        }
        system.partial_piv_lu().solve_in_place(right.as_mut());
        let z: [f64; 4] = std::array::from_fn(|i| right[(i, 0)]);
        let u: [f64; 4] = std::array::from_fn(|i| b[i] + (0..4).map(|j| a[4 * i + j] * z[j]).sum::<f64>());
        let obeys = |contact: usize| {
            let [p, q, gap, rate] = [z[contact], z[contact + 2], u[contact], u[contact + 2]];
            let closes = p >= -1e-12 && gap >= -1e-12;
            closes && q.abs() <= mu * p + 1e-12 && (way[contact] < 2 || q * rate <= 1e-12)
        };
        if obeys(0) && obeys(1) {
            solutions.push(z);
        }
    }
    solutions
}

/// A node on three surfaces whose normals lie in one plane, rough on the first: of their rows any
/// two normal ones determine the third, and with those the node sticks along the edge or not.
#[test]
fn a_node_on_three_surfaces_of_one_edge_obeys_the_law() {
    let angles = [0.0_f64, 14.0, 45.0].map(f64::to_radians);
    let normals = angles.map(|at| [at.cos(), at.sin(), 0.0]);
    let rows = [normals.as_slice(), &[[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]].concat();
    let matrix: Vec<f64> =
        (0..25).map(|e| 1354.0 * (0..3).map(|i| rows[e / 5][i] * rows[e % 5][i]).sum::<f64>()).collect();
    let rough = Kind::Tangential { of: 0, coefficient: 0.1, limit: f64::INFINITY };
    let kinds = [Kind::Normal, Kind::Normal, Kind::Normal, rough, rough];
    let mut sticks = 0;
    for case in 0..40 {
        // Along the edge it moves slowly; gaps are not quite those of one place.
        let free = [-184.0, 77.0 - 7.0 * f64::from(case), 13.0];
        let along = |row: &[f64; 3]| (0..3).map(|i| row[i] * free[i]).sum::<f64>();
        let more = [0.0, 8e-5, -3e-7, 0.0, 0.0];
        let right: Vec<f64> = rows.iter().zip(more).map(|(row, more)| along(row) + more).collect();
        let mut z = Vec::new();
        let couplings = &mut Couplings::dense(5, matrix.clone());
        Cone { matrix: couplings, right: &mut right.clone(), kinds: &kinds, is_dependent: true }
            .solve(&mut z)
            .unwrap_or_else(|error| panic!("{case}: {error}"));
        let u: Vec<f64> =
            (0..5).map(|i| right[i] + (0..5).map(|j| matrix[i * 5 + j] * z[j]).sum::<f64>()).collect();
        for i in 0..3 {
            assert!(z[i] >= 0.0 && u[i] >= -1e-6 && z[i] * u[i].abs() < 1e-6, "{case}: {z:?} {u:?}");
        }
        let force = z[3].hypot(z[4]);
        let slip = u[3].hypot(u[4]);
        assert!(force <= 0.1 * z[0] * (1.0 + 1e-9), "{case}: {z:?}");
        // Power −μ P |u|: against the slip, where there is one.
        let power = z[3] * u[3] + z[4] * u[4];
        assert!((power + 0.1 * z[0] * slip).abs() < 1e-6, "{case}: {z:?} {u:?}");
        sticks += usize::from(z[0] > 0.0 && slip < 1e-5);
    }
    assert!((1..40).contains(&sticks), "{sticks}");
}

/// An edge of two nodes and three points between them over a plane: the rows of the points are
/// means of those of the nodes, whose coefficient of friction is 1.
#[test]
fn points_between_the_nodes_of_an_edge_obey_the_law() {
    let normal = [0.48, 0.6, 0.64];
    let tangents = [[0.8, 0.0, -0.6], [0.36, -0.8, 0.48]];
    let of_node = |node: usize, along: [f64; 3]| -> [f64; 6] {
        std::array::from_fn(|dof| if dof / 3 == node { along[dof % 3] } else { 0.0 })
    };
    let shares = [0.25, 0.5, 0.75];
    let point = |share: f64| -> [f64; 6] {
        std::array::from_fn(|dof| normal[dof % 3] * if dof < 3 { 1.0 - share } else { share })
    };
    let mut rows = vec![of_node(0, normal), of_node(1, normal)];
    rows.extend(shares.map(point));
    rows.extend([0, 0, 1, 1].iter().zip([0, 1, 0, 1]).map(|(&node, along)| of_node(node, tangents[along])));
    let rough = |of| Kind::Tangential { of, coefficient: 1.0, limit: f64::INFINITY };
    let kinds = [[Kind::Normal; 5].as_slice(), &[rough(0), rough(0), rough(1), rough(1)]].concat();
    let n = rows.len();
    // A body couples its nodes: inverse masses along and across.
    let moved = |dof: usize, force: &[f64; 6]| 900.0 * force[dof] + 650.0 * force[(dof + 3) % 6];
    let matrix: Vec<f64> = (0..n * n)
        .map(|e| (0..6).map(|dof| rows[e / n][dof] * moved(dof, &rows[e % n])).sum::<f64>())
        .collect();
    for case in 0..200 {
        let wave = |k: usize| (f64::from(case) * 1.7 + k as f64 * 2.3).sin();
        let free: [f64; 6] = std::array::from_fn(|dof| 20.0 * wave(dof) - 15.0 * normal[dof % 3]);
        let right: Vec<f64> =
            rows.iter().map(|row| (0..6).map(|dof| row[dof] * free[dof]).sum::<f64>()).collect();
        let mut z = Vec::new();
        let couplings = &mut Couplings::dense(n, matrix.clone());
        Cone { matrix: couplings, right: &mut right.clone(), kinds: &kinds, is_dependent: true }
            .solve(&mut z)
            .unwrap_or_else(|error| panic!("{case}: {error}"));
        let u: Vec<f64> =
            (0..n).map(|i| right[i] + (0..n).map(|j| matrix[i * n + j] * z[j]).sum::<f64>()).collect();
        for i in 0..5 {
            assert!(z[i] >= 0.0 && u[i] >= -1e-7 && z[i] * u[i].abs() < 1e-8, "{case}: {z:?} {u:?}");
        }
        for (of, i) in [(0, 5), (1, 7)] {
            let force = z[i].hypot(z[i + 1]);
            let slip = u[i].hypot(u[i + 1]);
            assert!(force <= z[of] * (1.0 + 1e-9), "{case}: {z:?}");
            let power = z[i] * u[i] + z[i + 1] * u[i + 1];
            assert!((power + z[of] * slip).abs() < 1e-7, "{case}: {z:?} {u:?}");
        }
    }
}
