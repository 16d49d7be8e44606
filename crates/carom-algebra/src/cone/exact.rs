//! The exact solution of Coulomb's problem for given states.

use faer::Mat;
use faer::linalg::solvers::Solve;

use super::kind::Kind;

/// Largest number of corrections of the directions of slips.
const CORRECTIONS: usize = 40;
/// Force across a slip, relative to the largest force that slips, that is round-off.
const TURN: f64 = 1e-13;

/// State of an unknown force: open, preventing its motion, or slipping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum State {
    Zero,
    /// The motion along the force is zero: a closed or sticking contact.
    Fixed,
    /// A slip with the force −μ P d or, where the flag is set, −limit d; for a vector in the state
    /// of its first component.
    Slips([f64; 2], bool),
    /// The second component of a vector that slips.
    Follows,
}

/// Index of the second component of a tangential vector whose first component is i; none if i is
/// not the first component of a vector.
pub(super) fn second(kinds: &[Kind], i: usize) -> Option<usize> {
    let of = |i: usize| match kinds.get(i) {
        Some(Kind::Tangential { of, .. }) => Some(*of),
        _ => None,
    };
    let is_first = of(i).is_some() && (i == 0 || of(i - 1) != of(i));
    (is_first && of(i) == of(i + 1)).then_some(i + 1)
}

/// The exact solution for given states, in which the directions of vectors that slip are corrected.
pub(super) fn settle(
    a: &[f64],
    b: &[f64],
    kinds: &[Kind],
    states: &mut [State],
    z: &[f64],
) -> Option<Vec<f64>> {
    let n = kinds.len();
    let mut worth = vec![0.0; n];
    let mut now = z.to_vec();
    for _ in 0..CORRECTIONS {
        for i in 0..n {
            let Some(j) = second(kinds, i) else { continue };
            let State::Slips(direction, limited) = states[i] else { continue };
            let Kind::Tangential { of, coefficient, limit } = kinds[i] else { continue };
            let [u, v] = [i, j].map(|row| b[row] + (0..n).map(|k| a[row * n + k] * now[k]).sum::<f64>());
            let radius = if limited { limit } else { coefficient * now[of] };
            let along = direction[0] * u + direction[1] * v;
            worth[i] = if radius > 0.0 { along.max(0.0) / radius } else { f64::INFINITY };
        }
        let Solution { z: exact, turns } = solve(a, b, kinds, states, &worth, &now)?;
        let radius = |i: usize| match (kinds[i], states[i]) {
            (Kind::Tangential { limit, .. }, State::Slips(_, true)) => limit,
            (Kind::Tangential { of, coefficient, .. }, _) => coefficient * exact[of],
            _ => 0.0,
        };
        let turns: Vec<_> = turns.into_iter().map(|(i, across)| (i, across, radius(i))).collect();
        let widest = turns.iter().map(|turn| turn.2).fold(0.0, f64::max);
        if turns.iter().all(|(_, across, _)| across.abs() <= TURN * widest) {
            return Some(exact);
        }
        for (i, across, radius) in turns {
            if let State::Slips([x, y], limited) = states[i] {
                let turn = if radius > 0.0 { across / radius } else { return None };
                let turned = [x + y * turn, y - x * turn];
                let size = turned[0].hypot(turned[1]);
                states[i] = State::Slips(turned.map(|x| x / size), limited);
            }
        }
        now = exact;
    }
    None
}

/// Solution of the linear problem for given states.
struct Solution {
    z: Vec<f64>,
    /// Vectors that slip, by their first component, with the force s across their direction.
    turns: Vec<(usize, f64)>,
}

/// The linear problem for given states. Its unknowns are the forces of motions that are prevented,
/// and those across the directions of slips; its equations are that these motions vanish.
struct Reduced {
    /// Components of z that each unknown contributes to, with factors.
    forces: Vec<Vec<(usize, f64)>>,
    /// The motion that each unknown prevents, as components of u with factors.
    motions: Vec<Vec<(usize, f64)>>,
    /// Component that each unknown belongs to, and whether it is the force across a slip.
    names: Vec<(usize, bool)>,
    /// Additions to the diagonal of the linear problem.
    diagonal: Vec<f64>,
    /// Components of z that are known: slips at their limit.
    fixed: Vec<f64>,
}

impl Reduced {
    /// The linear problem for given states; `worth`: d·u/r of the vectors that slip.
    fn new(a: &[f64], kinds: &[Kind], states: &[State], worth: &[f64]) -> Self {
        let n = kinds.len();
        let mut reduced = Self {
            forces: Vec::new(),
            motions: Vec::new(),
            names: Vec::new(),
            diagonal: Vec::new(),
            fixed: vec![0.0; n],
        };
        // A force across a slip turns its direction only where it moves something.
        let is_turned = |i: usize, j: usize, [x, y]: [f64; 2]| {
            let moved = y * y * a[i * n + i] - 2.0 * x * y * a[i * n + j] + x * x * a[j * n + j];
            moved + worth[i] > 0.0
        };
        for i in 0..n {
            match (states[i], second(kinds, i)) {
                (State::Fixed, _) => reduced.add(i, false, vec![(i, 1.0)], 0.0),
                (State::Slips([x, y], _), Some(j)) if worth[i].is_finite() && is_turned(i, j, [x, y]) => {
                    reduced.add(i, true, vec![(i, -y), (j, x)], worth[i]);
                }
                _ => {}
            }
        }
        reduced.add_slips(kinds, states);
        reduced
    }

    /// Adds an unknown of component i whose force acts along the motion that it prevents.
    fn add(&mut self, i: usize, across: bool, motion: Vec<(usize, f64)>, diagonal: f64) {
        self.forces.push(motion.clone());
        self.motions.push(motion);
        self.names.push((i, across));
        self.diagonal.push(diagonal);
    }

    /// Makes every slip follow its normal force, or fixes it at its limit.
    fn add_slips(&mut self, kinds: &[Kind], states: &[State]) {
        for j in 0..kinds.len() {
            let Kind::Tangential { of, coefficient, limit } = kinds[j] else { continue };
            let State::Slips(direction, limited) = states[j] else { continue };
            let normal = self.names.iter().position(|&(i, across)| i == of && !across);
            let (coefficient, limit) = if limited { (0.0, limit) } else { (coefficient, 0.0) };
            for (k, direction) in [Some(j), second(kinds, j)].into_iter().flatten().zip(direction) {
                if let Some(column) = normal.filter(|_| coefficient != 0.0) {
                    self.forces[column].push((k, -direction * coefficient));
                }
                if limit != 0.0 {
                    self.fixed[k] = -direction * limit;
                }
            }
        }
    }
}

/// Solves the linear problem for given states; none if the solution is not finite. Its unknowns are
/// the differences to the forces `from`, because forces of rows that depend on each other follow
/// from the linear problem to few digits only.
fn solve(
    a: &[f64],
    b: &[f64],
    kinds: &[Kind],
    states: &[State],
    worth: &[f64],
    from: &[f64],
) -> Option<Solution> {
    let n = kinds.len();
    let Reduced { forces, motions, names, diagonal, fixed } = Reduced::new(a, kinds, states, worth);
    let size = names.len();
    let along = |motion: &[(usize, f64)], of: &dyn Fn(usize) -> f64| -> f64 {
        motion.iter().map(|&(row, factor)| factor * of(row)).sum()
    };
    let mut matrix = Mat::from_fn(size, size, |r, c| {
        let moved = |row: usize| forces[c].iter().map(|&(j, factor)| factor * a[row * n + j]).sum::<f64>();
        along(&motions[r], &moved)
    });
    (0..size).for_each(|i| matrix[(i, i)] += diagonal[i]);
    let first: Vec<f64> = names.iter().map(|&(i, across)| if across { 0.0 } else { from[i] }).collect();
    let mut known = fixed.clone();
    for (force, value) in forces.iter().zip(&first) {
        force.iter().for_each(|&(j, factor)| known[j] += factor * value);
    }
    let moved = |row: usize| b[row] + (0..n).map(|j| a[row * n + j] * known[j]).sum::<f64>();
    let mut right = Mat::from_fn(size, 1, |r, _| -along(&motions[r], &moved));
    matrix.partial_piv_lu().solve_in_place(right.as_mut());
    let mut z = fixed;
    let mut turns = Vec::new();
    for (r, &(i, across)) in names.iter().enumerate() {
        let value = first[r] + right[(r, 0)];
        if across {
            turns.push((i, value));
        } else {
            forces[r].iter().for_each(|&(j, factor)| z[j] = factor * value);
        }
    }
    z.iter().all(|value| value.is_finite()).then_some(Solution { z, turns })
}
