//! Complementarity of normal and tangential forces with Coulomb's law in the plane:
//!
//! ```text
//! u = A z + b,   z = (P, Q),   0 ≤ P_i ⊥ u_i ≥ 0
//! |Q_j| ≤ r_j,   Q_j = −r_j sign u_j where u_j ≠ 0,   r_j = min(μ_j P_j, limit_j)
//! ```
//!
//! A symmetric and positive semi-definite; a force of zero diagonal moves nothing and is zero. Rows
//! that depend on each other come as a proximal step (`complementarity.rs`). Each tangential force
//! belongs to one normal one. Sweeps of the nonlinear Gauss–Seidel method find which contacts are
//! open, stick, or slip; with that the problem is linear and is solved exactly. Where its solution
//! contradicts it, the sweeps go on.

use faer::Mat;
use faer::linalg::solvers::Solve;

use crate::linear::LinearError;

/// Sweeps between two attempts, and attempts.
const SWEEPS: usize = 10;
const ATTEMPTS: usize = 200;
/// Contradiction, relative to the largest force or motion, that is round-off.
const ROUND_OFF: f64 = 1e-11;

/// Coulomb's law of an unknown: `Normal`, or `Tangential` with the index of its normal force and μ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// P ≥ 0.
    Normal,
    /// Q.
    Tangential {
        /// Index of P.
        of: usize,
        /// μ ≥ 0.
        coefficient: f64,
        /// Largest Q; may be infinite.
        limit: f64,
    },
}

/// r and whether it is the limit.
fn radius(coefficient: f64, limit: f64, normal: f64) -> (f64, bool) {
    let cone = coefficient * normal;
    if normal <= 0.0 {
        (0.0, false)
    } else if cone < limit {
        (cone, false)
    } else {
        (limit, true)
    }
}

/// What an unknown does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    Zero,
    /// Its motion is zero.
    Held,
    /// −s μ P, or −s limit.
    Slips(f64, bool),
}

/// Overwrites `z`, a first guess if it has the size, with the solution for a matrix by rows.
/// Contacts that do not feel each other are solved apart.
///
/// # Errors
/// If none is found, as for large μ, where there may be none.
pub fn coulomb(a: &[f64], b: &[f64], kinds: &[Kind], z: &mut Vec<f64>) -> Result<(), LinearError> {
    let n = kinds.len();
    z.resize(n, 0.0);
    let mut group: Vec<Option<usize>> = vec![None; n];
    for first in 0..n {
        if group[first].is_some() {
            continue;
        }
        let (mut members, mut next) = (vec![first], 0);
        group[first] = Some(first);
        while let Some(&i) = members.get(next) {
            next += 1;
            let belong = |j: usize| matches!(kinds[j], Kind::Tangential { of, .. } if of == i);
            let owns = |j: usize| matches!(kinds[i], Kind::Tangential { of, .. } if of == j);
            for j in (0..n).filter(|&j| a[i * n + j] != 0.0 || belong(j) || owns(j)) {
                if group[j].is_none() {
                    group[j] = Some(first);
                    members.push(j);
                }
            }
        }
        members.sort_unstable();
        let place = |i: usize| members.partition_point(|&member| member < i);
        let part: Vec<f64> = members.iter().flat_map(|i| members.iter().map(|j| a[*i * n + *j])).collect();
        let right: Vec<f64> = members.iter().map(|&i| b[i]).collect();
        let local = |&i: &usize| match kinds[i] {
            Kind::Tangential { of, coefficient, limit } => {
                Kind::Tangential { of: place(of), coefficient, limit }
            }
            Kind::Normal => Kind::Normal,
        };
        let of_part: Vec<Kind> = members.iter().map(local).collect();
        let mut solution: Vec<f64> = members.iter().map(|&i| z[i]).collect();
        coupled(&part, &right, &of_part, &mut solution)?;
        members.iter().zip(solution).for_each(|(&i, value)| z[i] = value);
    }
    Ok(())
}

/// The problem of contacts that feel each other.
fn coupled(a: &[f64], b: &[f64], kinds: &[Kind], z: &mut Vec<f64>) -> Result<(), LinearError> {
    let n = kinds.len();
    let motion = |z: &[f64], i: usize| b[i] + (0..n).map(|j| a[i * n + j] * z[j]).sum::<f64>();
    let project = |z: &[f64], i: usize, value: f64| match kinds[i] {
        Kind::Normal => value.max(0.0),
        Kind::Tangential { of, coefficient, limit } => {
            let (radius, _) = radius(coefficient, limit, z[of]);
            value.clamp(-radius, radius)
        }
    };
    for _ in 0..ATTEMPTS {
        for _ in 0..SWEEPS {
            for i in 0..n {
                let value = z[i] - motion(z, i) / a[i * n + i];
                z[i] = if a[i * n + i] > 0.0 { project(z, i, value) } else { 0.0 };
            }
        }
        let state = |i: usize| match kinds[i] {
            _ if a[i * n + i] <= 0.0 => State::Zero,
            Kind::Normal if z[i] > 0.0 => State::Held,
            Kind::Normal => State::Zero,
            Kind::Tangential { of, .. } if z[of] <= 0.0 => State::Zero,
            Kind::Tangential { of, coefficient, limit } => match radius(coefficient, limit, z[of]) {
                (radius, _) if z[i].abs() < radius => State::Held,
                (_, limited) => State::Slips(-z[i].signum(), limited),
            },
        };
        let states: Vec<State> = (0..n).map(state).collect();
        let Some(exact) = solve(a, b, kinds, &states) else { continue };
        let motions: Vec<f64> = (0..n).map(|i| motion(&exact, i)).collect();
        let size = |values: &[f64]| ROUND_OFF * values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let (force, moved) = (size(&exact), size(b).max(size(&motions)));
        let holds = |i: usize| match (kinds[i], states[i]) {
            (Kind::Normal, State::Held) => exact[i] >= -force,
            (Kind::Normal, _) => motions[i] >= -moved,
            (Kind::Tangential { of, coefficient, limit }, State::Held) => {
                exact[i].abs() <= radius(coefficient, limit, exact[of]).0 + force
            }
            (Kind::Tangential { of, coefficient, limit }, State::Slips(sign, limited)) => {
                radius(coefficient, limit, exact[of]).1 == limited && sign * motions[i] >= -moved
            }
            (Kind::Tangential { .. }, State::Zero) => true,
        };
        if (0..n).all(holds) {
            *z = exact;
            // What is negative by round-off is none.
            for i in 0..n {
                z[i] = project(z, i, z[i]);
            }
            return Ok(());
        }
    }
    Err(LinearError::Inaccurate { size: n, residual: f64::NAN })
}

/// The solution of the linear problem for given states.
fn solve(a: &[f64], b: &[f64], kinds: &[Kind], states: &[State]) -> Option<Vec<f64>> {
    let n = kinds.len();
    let held: Vec<usize> = (0..n).filter(|&i| states[i] == State::Held).collect();
    // A slip carries its normal force with it.
    let mut carried: Vec<Vec<(usize, f64)>> = vec![Vec::new(); n];
    for j in 0..n {
        if let (Kind::Tangential { of, coefficient, .. }, State::Slips(sign, false)) = (kinds[j], states[j]) {
            carried[of].push((j, -sign * coefficient));
        }
    }
    let entry = |r: usize, c: usize| {
        let (row, column) = (held[r], held[c]);
        let slips = carried[column].iter().map(|&(j, factor)| factor * a[row * n + j]);
        a[row * n + column] + slips.sum::<f64>()
    };
    let matrix = Mat::from_fn(held.len(), held.len(), entry);
    let fixed = |j: usize| match (kinds[j], states[j]) {
        (Kind::Tangential { limit, .. }, State::Slips(sign, true)) => -sign * limit,
        _ => 0.0,
    };
    let known = |row: usize| (0..n).map(|j| a[row * n + j] * fixed(j)).sum::<f64>();
    let mut right = Mat::from_fn(held.len(), 1, |r, _| -b[held[r]] - known(held[r]));
    matrix.partial_piv_lu().solve_in_place(right.as_mut());
    let mut z = vec![0.0; n];
    held.iter().enumerate().for_each(|(r, &i)| z[i] = right[(r, 0)]);
    for j in 0..n {
        match (kinds[j], states[j]) {
            (Kind::Tangential { of, coefficient, .. }, State::Slips(sign, false)) => {
                z[j] = -sign * coefficient * z[of];
            }
            (_, State::Slips(_, true)) => z[j] = fixed(j),
            _ => {}
        }
    }
    z.iter().all(|value| value.is_finite()).then_some(z)
}

#[cfg(test)]
mod tests {
    use super::*;

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
            coulomb(&A, &b, &KINDS(0.4, limit), &mut z).unwrap();
            let u: Vec<f64> =
                (0..4).map(|i| b[i] + (0..4).map(|j| A[i * 4 + j] * z[j]).sum::<f64>()).collect();
            for i in 0..2 {
                let (p, q, radius) = (z[i], z[i + 2], (0.4 * z[i]).min(limit));
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

    #[test]
    fn without_friction_it_is_the_complementarity_of_normal_forces() {
        let b = [-1.0, 0.5, 2.0, -0.3];
        let (mut z, mut normal) = (Vec::new(), Vec::new());
        coulomb(&A, &b, &KINDS(0.0, f64::INFINITY), &mut z).unwrap();
        crate::complementarity(&[4.0, 1.0, 1.0, 3.0], &b[..2], &mut normal).unwrap();
        assert!((z[0] - normal[0]).abs() < 1e-15 && (z[1] - normal[1]).abs() < 1e-15);
        assert_eq!(z[2..], [0.0, 0.0]);
    }
}
