//! Sweeps of the nonlinear Gauss–Seidel method for contacts with friction.
//!
//! A force of zero diagonal moves nothing and is zero, also
//! as a component of a vector, unless that component has a motion of its own, b_i ≠ 0. Rows that
//! depend on each other come as a proximal step. Each tangential force
//! belongs to one normal one; two in a row that belong to the same one are the components of a
//! vector. Sweeps of the nonlinear Gauss–Seidel method find which contacts are open, stick, or
//! slip; with that and the directions d of the slips the problem is linear and is solved exactly.
//! Where its solution contradicts it, the sweeps go on. Directions of vectors follow from Newton's
//! method: with e across d, Q = −r d + s e and
//!
//! ```text
//! e·u + (d·u/r) s = 0,   δd = −e s/r
//! ```

use super::Couplings;
use super::exact::{State, second, settle};
use super::kind::Kind;
use crate::linear::LinearError;

/// Number of sweeps between two attempts to solve the problem exactly.
const SWEEPS: usize = 10;
/// Largest number of attempts to solve the problem exactly.
const ATTEMPTS: usize = 200;
/// Violation of the law, relative to the largest force or motion, that is round-off.
const ROUND_OFF: f64 = 1e-11;
/// Number of projections of a tangential vector in each sweep.
const PROJECTIONS: usize = 4;
/// Distance from the edge of the friction cone, relative to its radius, at which a vector slips.
const EDGE: f64 = 1e-12;

/// Radius of the friction cone for a normal force, and whether it is the limit of the tangential
/// force.
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

/// Overwrites `z`, a first guess if it has the size of the problem, with the solution for a matrix
/// by rows. Contacts that are not coupled are solved separately.
///
/// # Errors
/// If none is found, as for large μ, where there may be none.
pub(super) fn coulomb(a: &Couplings, b: &[f64], kinds: &[Kind], z: &mut Vec<f64>) -> Result<(), LinearError> {
    let n = kinds.len();
    let normal = |j: usize| match kinds[j] {
        Kind::Tangential { of, .. } => Some(of),
        Kind::Normal => None,
    };
    // The tangential forces by their normal ones.
    let mut tangential: Vec<usize> = (0..n).filter(|&j| normal(j).is_some()).collect();
    tangential.sort_by_key(|&j| normal(j));
    z.resize(n, 0.0);
    let mut group: Vec<Option<usize>> = vec![None; n];
    for first in 0..n {
        if group[first].is_some() {
            continue;
        }
        let mut members = vec![first];
        let mut next = 0;
        group[first] = Some(first);
        while let Some(&i) = members.get(next) {
            next += 1;
            let coupled = a.row(i).filter(|(_, value)| *value != 0.0).map(|(j, _)| j);
            let begin = tangential.partition_point(|&j| normal(j) < Some(i));
            let belong = tangential[begin..].iter().copied().take_while(|&j| normal(j) == Some(i));
            for j in coupled.chain(normal(i)).chain(belong) {
                if group[j].is_none() {
                    group[j] = Some(first);
                    members.push(j);
                }
            }
        }
        members.sort_unstable();
        let place = |i: usize| members.partition_point(|&member| member < i);
        let mut part = vec![0.0; members.len() * members.len()];
        for (row, &i) in part.chunks_exact_mut(members.len()).zip(&members) {
            for (j, value) in a.row(i).filter(|(j, _)| group[*j] == Some(first)) {
                row[place(j)] = value;
            }
        }
        let right: Vec<f64> = members.iter().map(|&i| b[i]).collect();
        let local = |&i: &usize| match kinds[i] {
            Kind::Tangential { of, coefficient, limit } => {
                Kind::Tangential { of: place(of), coefficient, limit }
            }
            Kind::Normal => Kind::Normal,
        };
        let of_part: Vec<Kind> = members.iter().map(local).collect();
        let mut solution: Vec<f64> = members.iter().map(|&i| z[i]).collect();
        Coupled { a: &part, b: &right, kinds: &of_part }.solve(&mut solution)?;
        members.iter().zip(solution).for_each(|(&i, value)| z[i] = value);
    }
    Ok(())
}

/// The problem of contacts that are coupled with each other.
struct Coupled<'a> {
    /// Matrix A, row by row.
    a: &'a [f64],
    b: &'a [f64],
    kinds: &'a [Kind],
}

impl Coupled<'_> {
    /// Overwrites `z`, a first guess, with the solution of the coupled problem.
    fn solve(&self, z: &mut Vec<f64>) -> Result<(), LinearError> {
        let n = self.kinds.len();
        for _ in 0..ATTEMPTS {
            (0..SWEEPS).for_each(|_| self.sweep(z));
            let mut states: Vec<State> = (0..n).map(|i| self.state(z, i)).collect();
            let Some(exact) = settle(self.a, self.b, self.kinds, &mut states, z) else { continue };
            if self.obeys(&exact, &states) {
                *z = exact;
                self.remove_round_off(z);
                return Ok(());
            }
        }
        Err(LinearError::NoStates { forces: n, sweeps: ATTEMPTS * SWEEPS })
    }

    /// Motion u_i along the i-th force for forces z.
    fn motion(&self, z: &[f64], i: usize) -> f64 {
        let n = self.kinds.len();
        self.b[i] + (0..n).map(|j| self.a[i * n + j] * z[j]).sum::<f64>()
    }

    /// Diagonal entry of the matrix for a force.
    fn diagonal(&self, i: usize) -> f64 {
        self.a[i * self.kinds.len() + i]
    }

    /// Whether a force is the second component of a tangential vector.
    fn is_second(&self, i: usize) -> bool {
        i > 0 && second(self.kinds, i - 1).is_some()
    }

    /// The admissible value of a force that is nearest to `value`.
    fn project(&self, z: &[f64], i: usize, value: f64) -> f64 {
        match self.kinds[i] {
            Kind::Normal => value.max(0.0),
            Kind::Tangential { of, coefficient, limit } => {
                let (radius, _) = radius(coefficient, limit, z[of]);
                value.clamp(-radius, radius)
            }
        }
    }

    /// A sweep of the nonlinear Gauss–Seidel method over all forces.
    fn sweep(&self, z: &mut [f64]) {
        for i in (0..self.kinds.len()).filter(|&i| !self.is_second(i)) {
            if let Some(other) = second(self.kinds, i) {
                self.sweep_vector(z, [i, other]);
                continue;
            }
            let value = z[i] - self.motion(z, i) / self.diagonal(i);
            z[i] = if self.diagonal(i) > 0.0 { self.project(z, i, value) } else { 0.0 };
        }
    }

    /// The projections of a tangential vector onto its friction cone in a sweep.
    fn sweep_vector(&self, z: &mut [f64], [i, j]: [usize; 2]) {
        let stiffness = stiffness(self.a, self.kinds.len(), [i, j]);
        let Kind::Tangential { of, coefficient, limit } = self.kinds[i] else { return };
        let (radius, _) = radius(coefficient, limit, z[of]);
        if stiffness <= 0.0 || radius == 0.0 {
            z[i] = 0.0;
            z[j] = 0.0;
            return;
        }
        let moves = [i, j].map(|row| self.diagonal(row) > 0.0 || self.b[row] != 0.0);
        for _ in 0..PROJECTIONS {
            let [u, v] = [i, j].map(|row| self.motion(z, row));
            let pulled = |row: usize, u: f64, moves: bool| if moves { z[row] - u / stiffness } else { 0.0 };
            [z[i], z[j]] = on_disc([pulled(i, u, moves[0]), pulled(j, v, moves[1])], radius);
        }
    }

    /// State of a force as the sweeps have left it: open, sticking or slipping.
    fn state(&self, z: &[f64], i: usize) -> State {
        match self.kinds[i] {
            Kind::Tangential { .. } if second(self.kinds, i).is_some() || self.is_second(i) => {
                self.state_in_vector(z, i)
            }
            _ if self.diagonal(i) <= 0.0 => State::Zero,
            Kind::Normal if z[i] > 0.0 => State::Fixed,
            Kind::Normal => State::Zero,
            Kind::Tangential { of, .. } if z[of] <= 0.0 => State::Zero,
            Kind::Tangential { of, coefficient, limit } => match radius(coefficient, limit, z[of]) {
                (radius, _) if z[i].abs() < radius => State::Fixed,
                (_, limited) => State::Slips([-z[i].signum(), 0.0], limited),
            },
        }
    }

    /// State of a component of a tangential vector as the sweeps have left it.
    fn state_in_vector(&self, z: &[f64], i: usize) -> State {
        let Kind::Tangential { of, coefficient, limit } = self.kinds[i] else { return State::Zero };
        let first = i - usize::from(self.is_second(i));
        let x = z[first];
        let y = z[first + 1];
        let (radius, limited) = radius(coefficient, limit, z[of]);
        let size = x.hypot(y);
        let is_driven = [first, first + 1].iter().any(|&k| self.diagonal(k) <= 0.0 && self.b[k] != 0.0);
        if z[of] <= 0.0 || stiffness(self.a, self.kinds.len(), [first, first + 1]) <= 0.0 {
            State::Zero
        } else if size < radius * (1.0 - EDGE) && !is_driven {
            if self.diagonal(i) > 0.0 { State::Fixed } else { State::Zero }
        } else if i > first {
            State::Follows
        } else if size > 0.0 {
            State::Slips([-x / size, -y / size], limited)
        } else {
            // Without a cone the direction has no effect.
            State::Slips([1.0, 0.0], limited)
        }
    }

    /// Whether the forces of an exact solution obey the law in the states for which it was
    /// computed, to round-off.
    fn obeys(&self, exact: &[f64], states: &[State]) -> bool {
        let n = self.kinds.len();
        let motions: Vec<f64> = (0..n).map(|i| self.motion(exact, i)).collect();
        let size = |values: &[f64]| ROUND_OFF * values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let force = size(exact);
        let moved = size(self.b).max(size(&motions));
        let pair = |values: &[f64], i: usize| match second(self.kinds, i) {
            Some(j) => [values[i], values[j]],
            None if self.is_second(i) => [values[i - 1], values[i]],
            None => [values[i], 0.0],
        };
        let holds = |i: usize| match (self.kinds[i], states[i]) {
            (Kind::Normal, State::Fixed) => exact[i] >= -force,
            (Kind::Normal, _) => motions[i] >= -moved,
            (Kind::Tangential { of, coefficient, limit }, State::Fixed) => {
                let [x, y] = pair(exact, i);
                x.hypot(y) <= radius(coefficient, limit, exact[of]).0 + force
            }
            (Kind::Tangential { of, coefficient, limit }, State::Slips(direction, limited)) => {
                let [x, y] = pair(&motions, i);
                let (radius, is_limit) = radius(coefficient, limit, exact[of]);
                // Without a cone the direction of a vector has no effect.
                let forward = direction[0] * x + direction[1] * y >= -moved;
                is_limit == limited && (forward || radius <= force && second(self.kinds, i).is_some())
            }
            (Kind::Tangential { .. }, State::Zero | State::Follows) => true,
        };
        (0..n).all(holds)
    }

    /// Projects forces that violate the law by round-off onto admissible ones.
    fn remove_round_off(&self, z: &mut [f64]) {
        let n = self.kinds.len();
        for i in (0..n).filter(|&i| second(self.kinds, i).is_none() && !self.is_second(i)) {
            z[i] = self.project(z, i, z[i]);
        }
        for i in 0..n {
            let Kind::Tangential { of, coefficient, limit } = self.kinds[i] else { continue };
            let Some(j) = second(self.kinds, i) else { continue };
            [z[i], z[j]] = on_disc([z[i], z[j]], radius(coefficient, limit, z[of]).0);
        }
    }
}

/// The point of a disc nearest to a given one.
fn on_disc(point: [f64; 2], radius: f64) -> [f64; 2] {
    let size = point[0].hypot(point[1]);
    if size > radius { point.map(|x| x * (radius / size)) } else { point }
}

/// Largest eigenvalue of the diagonal block of two unknowns.
fn stiffness(a: &[f64], n: usize, [i, j]: [usize; 2]) -> f64 {
    let x = a[i * n + i];
    let y = a[j * n + j];
    let mixed = a[i * n + j];
    0.5 * (x + y) + (0.5 * (x - y)).hypot(mixed)
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
            coulomb(&Couplings::dense(4, A.to_vec()), &b, &KINDS(0.4, limit), &mut z).unwrap();
            let u: Vec<f64> =
                (0..4).map(|i| b[i] + (0..4).map(|j| A[i * 4 + j] * z[j]).sum::<f64>()).collect();
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
        let entry =
            |i: usize, j: usize| ((i * 7 + j * 3) as f64 * 0.77).sin() + if i == j { 2.0 } else { 0.0 };
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
            let mut b: Vec<f64> =
                (0..6).map(|i| (f64::from(k) * 1.7 + f64::from(i) * 2.3).sin() * 3.0).collect();
            if k % 3 == 0 {
                // That of forces within the cone, disturbed.
                let forces: [f64; 6] = [2.0, 1.5, 0.1, -0.3, 0.2, 0.25];
                (0..6)
                    .for_each(|i| b[i] = 0.02 * b[i] - (0..6).map(|j| a[i * 6 + j] * forces[j]).sum::<f64>());
            }
            change(&mut a, &mut b);
            let mut z = Vec::new();
            coulomb(&Couplings::dense(6, a.to_vec()), &b, &kinds, &mut z).unwrap();
            let u: Vec<f64> =
                (0..6).map(|i| b[i] + (0..6).map(|j| a[i * 6 + j] * z[j]).sum::<f64>()).collect();
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

    /// What supports move never sticks.
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
            let b: Vec<f64> =
                (0..6).map(|i| u[i] - (0..6).map(|j| a[i * 6 + j] * z[j]).sum::<f64>()).collect();
            let mut found = Vec::new();
            coulomb(&Couplings::dense(6, a.to_vec()), &b, &kinds, &mut found).unwrap();
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
        coulomb(&Couplings::dense(4, A.to_vec()), &b, &KINDS(0.0, f64::INFINITY), &mut z).unwrap();
        let normals = Couplings::dense(2, vec![4.0, 1.0, 1.0, 3.0]);
        super::super::pivoting::complementarity(&normals, &b[..2], &mut normal).unwrap();
        assert!((z[0] - normal[0]).abs() < 1e-15 && (z[1] - normal[1]).abs() < 1e-15);
        assert_eq!(z[2..], [0.0, 0.0]);
    }
}
