//! Sweeps of the nonlinear Gauss–Seidel method for contacts with friction.

use carom_algebra::cone::pivoting::complementarity;
use carom_algebra::cone::sweeps::coulomb;
use carom_algebra::{Couplings, Kind};

/// Two contacts of a body, each with its tangential force.
const KINDS: fn(f64, f64) -> [Kind; 4] = |coefficient, limit| {
    let tangential = |of| Kind::Tangential { of, coefficient, limit };
    [Kind::Normal, Kind::Normal, tangential(0), tangential(1)]
};
const A: [f64; 16] = [4.0, 1.0, 0.7, 0.2, 1.0, 3.0, -0.3, 0.5, 0.7, -0.3, 5.0, 0.4, 0.2, 0.5, 0.4, 2.0];

#[test]
fn every_state_obeys_the_law() {
    let mut seen = [false; 4];
    for k in 0..400 {
        let b: Vec<f64> = (0..4).map(|i| (f64::from(k) * 1.7 + f64::from(i) * 2.3).sin() * 3.0).collect();
        let mut z = Vec::new();
        let limit = if k % 2 == 0 { f64::INFINITY } else { 0.2 };
        coulomb(&Couplings::dense(4, A.to_vec()), &b, &KINDS(0.4, limit), &mut z, false).unwrap();
        let u: Vec<f64> = (0..4).map(|i| b[i] + (0..4).map(|j| A[i * 4 + j] * z[j]).sum::<f64>()).collect();
        for i in 0..2 {
            let p = z[i];
            let q = z[i + 2];
            let radius = (0.4 * z[i]).min(limit);
            assert!(p >= 0.0 && u[i] >= -1e-12 && p * u[i].abs() < 1e-12, "{k}");
            assert!(q.abs() <= radius + 1e-12, "{k}");
            if p == 0.0 {
                seen[0] = true;
            } else if q.abs() < radius - 1e-9 {
                seen[1] = true;
                assert!(u[i + 2].abs() < 1e-12, "{k}");
            } else {
                seen[if q > 0.0 { 2 } else { 3 }] = true;
                assert!(q * u[i + 2] <= 1e-12, "{k}");
            }
        }
    }
    assert_eq!(seen, [true; 4]);
}

/// A body with two contacts in space, each with a tangential vector.
fn in_space(limit: f64) -> ([f64; 36], [Kind; 6]) {
    // A = LᵀL.
    let entry = |i: usize, j: usize| ((i * 7 + j * 3) as f64 * 0.77).sin() + if i == j { 2.0 } else { 0.0 };
    let a = std::array::from_fn(|e| (0..6).map(|k| entry(k, e / 6) * entry(k, e % 6)).sum());
    let tangential = |of| Kind::Tangential { of, coefficient: 0.3, limit };
    let kinds = [Kind::Normal, Kind::Normal, tangential(0), tangential(0), tangential(1), tangential(1)];
    (a, kinds)
}

/// Whether it is open, sticks, or slips, of a contact whose forces and motions obey the law.
fn checked(k: i32, limit: f64, [p, u]: [f64; 2], q: [f64; 2], v: [f64; 2]) -> usize {
    let radius = (0.3 * p).min(limit);
    let size = q[0].hypot(q[1]);
    let rate = v[0].hypot(v[1]);
    assert!(p >= 0.0 && u >= -1e-11 && p * u.abs() < 1e-11, "{k}");
    assert!(size <= radius + 1e-12, "{k}: {size} {radius}");
    if p == 0.0 {
        return 0;
    }
    if size < radius - 1e-9 {
        assert!(rate < 1e-11, "{k}: {rate}");
        return 1;
    }
    let along = q[0] * v[0] + q[1] * v[1];
    assert!((along + size * rate).abs() < 1e-11 * (1.0 + size * rate), "{k}: {q:?} {v:?}");
    2
}

/// Solutions for many right-hand sides, if given after a change of A and of them.
fn vectors(change: impl Fn(&mut [f64; 36], &mut [f64])) {
    let mut seen = [0; 3];
    for k in 0..400 {
        let limit = if k % 2 == 0 { f64::INFINITY } else { 0.4 };
        let (mut a, kinds) = in_space(limit);
        let mut b: Vec<f64> = (0..6).map(|i| (f64::from(k) * 1.7 + f64::from(i) * 2.3).sin() * 3.0).collect();
        if k % 3 == 0 {
            // The right-hand side of forces within the cone, disturbed.
            let forces: [f64; 6] = [2.0, 1.5, 0.1, -0.3, 0.2, 0.25];
            (0..6).for_each(|i| b[i] = 0.02 * b[i] - (0..6).map(|j| a[i * 6 + j] * forces[j]).sum::<f64>());
        }
        change(&mut a, &mut b);
        let mut z = Vec::new();
        coulomb(&Couplings::dense(6, a.to_vec()), &b, &kinds, &mut z, false).unwrap();
        let u: Vec<f64> = (0..6).map(|i| b[i] + (0..6).map(|j| a[i * 6 + j] * z[j]).sum::<f64>()).collect();
        for i in 0..2 {
            let [q, v] = [&z, &u].map(|values| [values[2 + 2 * i], values[3 + 2 * i]]);
            seen[checked(k, limit, [z[i], u[i]], q, v)] += 1;
        }
        for i in (0..6).filter(|i| a[i * 7] == 0.0 && b[*i] == 0.0) {
            assert_eq!(z[i], 0.0, "{k}");
        }
    }
    assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
}

#[test]
fn vectors_obey_the_law() {
    vectors(|_, _| {});
}

/// Rows and columns of tangents along which supports constrain a node.
fn without(a: &mut [f64; 36], rows: &[usize]) {
    for &row in rows {
        for i in 0..6 {
            a[row * 6 + i] = 0.0;
            a[i * 6 + row] = 0.0;
        }
    }
}

#[test]
fn vectors_of_which_a_component_moves_nothing_obey_the_law() {
    for rows in [&[2][..], &[3], &[2, 5]] {
        vectors(|a, b| {
            without(a, rows);
            rows.iter().for_each(|&row| b[row] = 0.0);
        });
    }
}

/// A component of a contact that supports move has no force, and the others obey the law.
#[test]
fn vectors_obey_the_law_where_supports_move_a_component() {
    vectors(|a, b| {
        without(a, &[3]);
        b[3] = 0.5 * b[3] + 0.1;
    });
}

/// The second one is about to open, and its force is the round-off of the first one's.
#[test]
fn vectors_settle_beside_one_without_a_force() {
    let (a, kinds) = in_space(f64::INFINITY);
    for k in 0..400 {
        let wave = |i: usize| (f64::from(k) * 1.7 + i as f64 * 2.3).sin();
        let p = [2.0, 1e-16 * f64::from(k % 7)];
        let v = [[wave(0), wave(1)], [wave(2), wave(3)]];
        let q = |i: usize| v[i].map(|v_a| -0.3 * p[i] * v_a / v[i][0].hypot(v[i][1]));
        let z = [p[0], p[1], q(0)[0], q(0)[1], q(1)[0], q(1)[1]];
        let u = [0.0, 0.0, v[0][0], v[0][1], v[1][0], v[1][1]];
        let b: Vec<f64> = (0..6).map(|i| u[i] - (0..6).map(|j| a[i * 6 + j] * z[j]).sum::<f64>()).collect();
        let mut found = Vec::new();
        coulomb(&Couplings::dense(6, a.to_vec()), &b, &kinds, &mut found, false).unwrap();
        for i in 0..6 {
            assert!((found[i] - z[i]).abs() < 1e-11, "{k}: {found:?} {z:?}");
        }
    }
}

#[test]
fn without_friction_it_is_the_complementarity_of_normal_forces() {
    let b = [-1.0, 0.5, 2.0, -0.3];
    let mut z = Vec::new();
    let mut normal = Vec::new();
    coulomb(&Couplings::dense(4, A.to_vec()), &b, &KINDS(0.0, f64::INFINITY), &mut z, false).unwrap();
    let normals = Couplings::dense(2, vec![4.0, 1.0, 1.0, 3.0]);
    complementarity(&normals, &b[..2], &mut normal).unwrap();
    assert!((z[0] - normal[0]).abs() < 1e-15 && (z[1] - normal[1]).abs() < 1e-15);
    assert_eq!(z[2..], [0.0, 0.0]);
}

/// A node between two walls that meet at 70°: of the four rows of its two degrees of freedom any
/// two depend on the others, and sweeps change its forces by a thousandth each. It slips on both.
#[test]
fn forces_of_dependent_rows_drift_to_the_solution() {
    let angle = 70.0_f64.to_radians();
    let walls = [0.0, angle];
    let normals = walls.map(|at: f64| [at.cos(), at.sin()]);
    let tangents = normals.map(|[x, y]| [-y, x]);
    let rows = [normals, tangents].concat();
    let a: Vec<f64> =
        (0..16).map(|e| 400.0 * (0..2).map(|i| rows[e / 4][i] * rows[e % 4][i]).sum::<f64>()).collect();
    let mut seen = 0;
    for k in 0..20 {
        // Motions that the walls prevent, and slips that differ from theirs by little.
        let free = [-1350.0, -750.0 - 40.0 * f64::from(k)];
        let along = |row: &[f64; 2]| row[0] * free[0] + row[1] * free[1];
        let b: Vec<f64> =
            rows.iter().zip([0.0, 0.0, 1.1, 0.4]).map(|(row, more)| along(row) + more).collect();
        let mut z = Vec::new();
        coulomb(&Couplings::dense(4, a.clone()), &b, &KINDS(0.3, f64::INFINITY), &mut z, false).unwrap();
        let u: Vec<f64> = (0..4).map(|i| b[i] + (0..4).map(|j| a[i * 4 + j] * z[j]).sum::<f64>()).collect();
        for i in 0..2 {
            assert!(z[i] >= 0.0 && u[i] >= -1e-8 && z[i] * u[i].abs() < 1e-7, "{k}: {z:?} {u:?}");
            assert!(z[i + 2].abs() <= 0.3 * z[i] + 1e-10, "{k}: {z:?}");
            let slips = z[i] > 0.0 && z[i + 2].abs() >= 0.3 * z[i] - 1e-10;
            assert!(if slips { z[i + 2] * u[i + 2] <= 1e-8 } else { z[i] == 0.0 || u[i + 2].abs() < 1e-8 });
            seen += usize::from(slips);
        }
    }
    assert!(seen > 20, "{seen}");
}
