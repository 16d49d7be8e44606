//! Sweeps of the nonlinear Gauss–Seidel method for contacts with friction.
//!
//! A force of zero diagonal moves nothing and is zero, also as a component of a vector, unless that
//! component has a motion of its own, b_i ≠ 0. Where rows depend on each other, sweeps and exact
//! solutions are those of a proximal step. Each tangential force belongs to one normal one; two in
//! a row that belong to the same one are the components of a vector. Sweeps of the nonlinear
//! Gauss–Seidel method find which contacts are open, stick, or slip; with that and the directions d
//! of the slips the problem is linear and is solved exactly. Where its solution contradicts it, the
//! sweeps go on. What rests with forces on the edges of its cones has no such states: in the end
//! forces of the sweeps themselves are taken if they solve the problem to round-off. Directions of
//! vectors follow from Newton's method: with e across d, Q = −r d + s e and
//!
//! ```text
//! e·u + (d·u/r) s = 0,   δd = −e s/r
//! ```

use super::couplings::{Couplings, PROXIMAL};
use super::exact::{State, second, settle};
use super::kind::Kind;
use super::pivoting;
use crate::linear::LinearError;
use crate::sums::max_abs;

/// Number of sweeps between two attempts to solve the problem exactly.
const SWEEPS: usize = 10;
/// Largest number of attempts to solve the problem exactly.
const ATTEMPTS: usize = 200;
/// Number of attempts of the sweeps alone, times the number of entries of the matrix: of 33 forces
/// of a cube flush on a larger one up to 3200 attempts were needed. Many forces have as many as
/// exact solutions have.
const LAST_WORK: usize = 5_000_000;
/// Number of attempts from which on the way of a sweep is followed further, and for as many
/// attempts all normal forces are solved for together.
const PATIENCE: usize = 10;
/// Longest way, in those of one sweep, that is followed at once.
const FARTHEST: f64 = 65536.0;
/// Violation of the law, relative to the largest force or motion, that is round-off.
const ROUND_OFF: f64 = 1e-11;
/// Bisections for the first forces on a way that are not admissible.
const BISECTIONS: usize = 52;
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
pub fn coulomb(
    a: &Couplings,
    b: &[f64],
    kinds: &[Kind],
    z: &mut Vec<f64>,
    is_dependent: bool,
) -> Result<(), LinearError> {
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
        let mut solution: Vec<f64> = members.iter().map(|&i| z[i]).collect();
        let mut right: Vec<f64> = members.iter().map(|&i| b[i]).collect();
        let mut near = vec![0.0; members.len()];
        for k in (0..members.len()).filter(|_| is_dependent) {
            near[k] = PROXIMAL * part[k * (members.len() + 1)];
            part[k * (members.len() + 1)] += near[k];
            right[k] -= near[k] * solution[k];
        }
        let local = |&i: &usize| match kinds[i] {
            Kind::Tangential { of, coefficient, limit } => {
                Kind::Tangential { of: place(of), coefficient, limit }
            }
            Kind::Normal => Kind::Normal,
        };
        let of_part: Vec<Kind> = members.iter().map(local).collect();
        let guess = solution.clone();
        Coupled { a: &part, b: right, kinds: &of_part, near: &near, guess }.solve(&mut solution)?;
        members.iter().zip(solution).for_each(|(&i, value)| z[i] = value);
    }
    Ok(())
}

/// The problem of contacts that are coupled with each other.
struct Coupled<'a> {
    /// Matrix A, row by row.
    a: &'a [f64],
    b: Vec<f64>,
    kinds: &'a [Kind],
    /// Addition of the proximal step to the diagonal.
    near: &'a [f64],
    /// Forces from which the proximal step begins.
    guess: Vec<f64>,
}

impl Coupled<'_> {
    /// Overwrites `z`, a first guess, with the solution of the coupled problem.
    fn solve(mut self, z: &mut Vec<f64>) -> Result<(), LinearError> {
        let n = self.kinds.len();
        let mut pressed = Vec::new();
        for attempt in 0..ATTEMPTS {
            if attempt == PATIENCE {
                pressed.clone_from(z);
            }
            if attempt >= PATIENCE {
                self.leap(z, Self::sweep);
            }
            let presses = (PATIENCE..2 * PATIENCE).contains(&attempt);
            if presses {
                self.leap(&mut pressed, Self::press);
                (0..SWEEPS).for_each(|_| self.press(&mut pressed));
            }
            (0..SWEEPS).for_each(|_| self.sweep(z));
            let of_pressed = || if presses { self.walked(&pressed) } else { None };
            if let Some(exact) = self.settled(z).or_else(of_pressed) {
                *z = exact;
                self.admit(z);
                return Ok(());
            }
        }
        z.clone_from(&self.guess);
        let last = (LAST_WORK / (n * n)).max(ATTEMPTS);
        for _ in 0..last {
            self.begin_at(z);
            self.leap(z, Self::sweep);
            self.begin_at(z);
            (0..SWEEPS).for_each(|_| self.sweep(z));
            if self.is_solved_by(z) {
                return Ok(());
            }
        }
        Err(LinearError::NoStates { forces: n, sweeps: (ATTEMPTS + last) * SWEEPS })
    }

    /// Begins the proximal step of dependent rows at these forces.
    fn begin_at(&mut self, z: &[f64]) {
        for (i, force) in z.iter().enumerate() {
            self.b[i] += self.near[i] * (self.guess[i] - force);
            self.guess[i] = *force;
        }
    }

    /// Whether the sweeps have found admissible forces that no motion changes. What rests with
    /// forces on the edges of their cones, as a body in a corner does, has no states of which one
    /// could be told from another.
    fn is_solved_by(&self, z: &[f64]) -> bool {
        let n = self.kinds.len();
        let motions: Vec<f64> =
            (0..n).map(|i| self.motion(z, i) + self.near[i] * (self.guess[i] - z[i])).collect();
        let moved = ROUND_OFF * max_abs(&self.b).max(max_abs(&motions));
        let stays = |i: usize| {
            if self.is_second(i) {
                return true;
            }
            let Some(j) = second(self.kinds, i) else {
                let stiffness = self.diagonal(i);
                let pulled = self.project(z, i, z[i] - motions[i] / stiffness);
                let is_open = self.kinds[i] != Kind::Normal || motions[i] >= -moved;
                return if stiffness > 0.0 { stiffness * (pulled - z[i]).abs() <= moved } else { is_open };
            };
            let stiffness = stiffness(self.a, n, [i, j]);
            let Kind::Tangential { of, coefficient, limit } = self.kinds[i] else { return true };
            let (radius, _) = radius(coefficient, limit, z[of]);
            let pulled = on_disc([i, j].map(|row| z[row] - motions[row] / stiffness), radius);
            let change = (pulled[0] - z[i]).hypot(pulled[1] - z[j]);
            stiffness <= 0.0 || stiffness * change <= moved
        };
        (0..n).all(stays)
    }

    /// The exact solution for the states of these forces, if it obeys the law.
    fn settled(&self, z: &[f64]) -> Option<Vec<f64>> {
        let (exact, obeys) = self.exact(z)?;
        obeys.then_some(exact)
    }

    /// The exact solution for the states of these forces, and whether it obeys the law. The
    /// proximal step of dependent rows begins from these forces.
    fn exact(&self, z: &[f64]) -> Option<(Vec<f64>, bool)> {
        let n = self.kinds.len();
        let mut states: Vec<State> = (0..n).map(|i| self.state(z, i)).collect();
        let right: Vec<f64> = (0..n).map(|i| self.b[i] + self.near[i] * (self.guess[i] - z[i])).collect();
        let exact = settle(self.a, &right, self.kinds, &mut states, z)?;
        let Self { a, kinds, near, .. } = *self;
        let of_these = Coupled { a, b: right, kinds, near, guess: z.to_vec() };
        let obeys = of_these.obeys(&exact, &states);
        Some((exact, obeys))
    }

    /// The exact solution for the states of these forces; while it does not obey the law, that for
    /// those of the first forces on the way there that are not admissible: of contacts that depend
    /// on each other it lies far beyond their cones.
    fn walked(&self, z: &[f64]) -> Option<Vec<f64>> {
        let mut now = z.to_vec();
        for _ in self.kinds {
            let (exact, obeys) = self.exact(&now)?;
            if obeys {
                return Some(exact);
            }
            let at = |share: f64| -> Vec<f64> {
                now.iter().zip(&exact).map(|(from, to)| from + share * (to - from)).collect()
            };
            let mut admissible = 0.0;
            let mut share = 1.0;
            for _ in 0..BISECTIONS {
                let middle = 0.5 * (admissible + share);
                let forces = at(middle);
                let mut admitted = forces.clone();
                self.admit(&mut admitted);
                if admitted == forces {
                    admissible = middle;
                } else {
                    share = middle;
                }
            }
            now = at(share);
            self.admit(&mut now);
        }
        None
    }

    /// Lets all normal forces follow the tangential ones together, by pivoting, and these then
    /// follow in a sweep: of contacts that depend on each other, those that are not needed open,
    /// which single forces never find.
    fn press(&self, z: &mut [f64]) {
        let n = self.kinds.len();
        let normals: Vec<usize> =
            (0..n).filter(|&i| self.kinds[i] == Kind::Normal && self.diagonal(i) > 0.0).collect();
        let entries = normals.iter().flat_map(|&i| normals.iter().map(move |&j| self.a[i * n + j]));
        let matrix = Couplings::dense(normals.len(), entries.collect());
        let before: Vec<f64> = normals.iter().map(|&i| std::mem::take(&mut z[i])).collect();
        let right: Vec<f64> = normals.iter().map(|&i| self.motion(z, i)).collect();
        let mut forces = Vec::new();
        let solved = pivoting::complementarity(&matrix, &right, &mut forces);
        let forces = if solved.is_ok() { forces } else { before };
        normals.iter().zip(&forces).for_each(|(&i, &force)| z[i] = force);
        self.follow(z, |i| self.kinds[i] != Kind::Normal);
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
        self.follow(z, |_| true);
    }

    /// Lets each of some forces follow the others in turn.
    fn follow(&self, z: &mut [f64], is_chosen: impl Fn(usize) -> bool) {
        for i in (0..self.kinds.len()).filter(|&i| is_chosen(i) && !self.is_second(i)) {
            if let Some(other) = second(self.kinds, i) {
                self.sweep_vector(z, [i, other]);
                continue;
            }
            let value = z[i] - self.motion(z, i) / self.diagonal(i);
            z[i] = if self.diagonal(i) > 0.0 { self.project(z, i, value) } else { 0.0 };
        }
    }

    /// Follows the way of a sweep, twice as far each time, while a sweep from there moves no force
    /// further than the first one did. Where rows of contacts depend on each other, forces that
    /// move nothing drift by the same amount in every sweep until another contact slips or opens.
    fn leap(&self, z: &mut [f64], sweep: impl Fn(&Self, &mut [f64])) {
        let start = z.to_vec();
        sweep(self, z);
        let way: Vec<f64> = z.iter().zip(&start).map(|(now, start)| now - start).collect();
        let length = max_abs(&way) * (1.0 + ROUND_OFF);
        let mut far = start;
        let mut next = z.to_vec();
        let mut factor = 1.0;
        while factor < FARTHEST {
            factor *= 2.0;
            for (far, (now, way)) in far.iter_mut().zip(z.iter().zip(&way)) {
                *far = now + factor * way;
            }
            self.admit(&mut far);
            next.copy_from_slice(&far);
            sweep(self, &mut next);
            let is_longer = far.iter().zip(&next).any(|(far, next)| (next - far).abs() > length);
            if is_longer {
                return;
            }
            z.copy_from_slice(&next);
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
        let moved = size(&self.b).max(size(&motions));
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

    /// Projects forces onto admissible ones.
    fn admit(&self, z: &mut [f64]) {
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
