//! The exact solution of Coulomb's problem for given states.

use faer::Mat;
use faer::linalg::solvers::Solve;

use super::kind::Kind;

/// Corrections of directions, and a force across one, relative to the largest of those that slip,
/// that is round-off.
const CORRECTIONS: usize = 40;
const TURN: f64 = 1e-13;

/// What an unknown does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum State {
    Zero,
    /// Its motion is zero.
    Fixed,
    /// −μ P d, or −limit d; of a vector, in the state of its first component.
    Slips([f64; 2], bool),
    /// The second component of a vector that slips.
    Follows,
}

/// The second component of the vector whose first one this is.
pub(super) fn second(kinds: &[Kind], i: usize) -> Option<usize> {
    let of = |i: usize| match kinds.get(i) {
        Some(Kind::Tangential { of, .. }) => Some(*of),
        _ => None,
    };
    let is_first = of(i).is_some() && (i == 0 || of(i - 1) != of(i));
    (is_first && of(i) == of(i + 1)).then_some(i + 1)
}

/// The solution for given states, with the directions of vectors that slip, which are corrected.
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
            let (Some(j), State::Slips(direction, limited)) = (second(kinds, i), states[i]) else { continue };
            let Kind::Tangential { of, coefficient, limit } = kinds[i] else { continue };
            let [u, v] = [i, j].map(|row| b[row] + (0..n).map(|k| a[row * n + k] * now[k]).sum::<f64>());
            let radius = if limited { limit } else { coefficient * now[of] };
            let along = direction[0] * u + direction[1] * v;
            worth[i] = if radius > 0.0 { along.max(0.0) / radius } else { f64::INFINITY };
        }
        let (exact, turns) = solve(a, b, kinds, states, &worth)?;
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

/// The solution of the linear problem for given states, and the forces s across the directions of
/// vectors that slip. `worth`: d·u/r of these.
#[allow(clippy::type_complexity)]
fn solve(
    a: &[f64],
    b: &[f64],
    kinds: &[Kind],
    states: &[State],
    worth: &[f64],
) -> Option<(Vec<f64>, Vec<(usize, f64)>)> {
    let n = kinds.len();
    // The forces and the motions of the unknowns: those that are prevented, and those across a
    // slip.
    let (mut forces, mut motions) = (Vec::new(), Vec::new());
    let (mut names, mut diagonal) = (Vec::new(), Vec::new());
    // What moves nothing across the direction does not turn it.
    let is_turned = |i: usize, j: usize, [x, y]: [f64; 2]| {
        let moved = y * y * a[i * n + i] - 2.0 * x * y * a[i * n + j] + x * x * a[j * n + j];
        moved + worth[i] > 0.0
    };
    for i in 0..n {
        match (states[i], second(kinds, i)) {
            (State::Fixed, _) => {
                forces.push(vec![(i, 1.0)]);
                motions.push(vec![(i, 1.0)]);
                names.push((i, false));
                diagonal.push(0.0);
            }
            (State::Slips([x, y], _), Some(j)) if worth[i].is_finite() && is_turned(i, j, [x, y]) => {
                forces.push(vec![(i, -y), (j, x)]);
                motions.push(vec![(i, -y), (j, x)]);
                names.push((i, true));
                diagonal.push(worth[i]);
            }
            _ => {}
        }
    }
    // A slip carries its normal force with it.
    let slip = |j: usize| match (kinds[j], states[j]) {
        (Kind::Tangential { of, coefficient, limit }, State::Slips(direction, limited)) => {
            let components = [Some(j), second(kinds, j)].into_iter().flatten().zip(direction);
            Some((of, components, if limited { (0.0, limit) } else { (coefficient, 0.0) }))
        }
        _ => None,
    };
    let mut fixed = vec![0.0; n];
    for (of, components, (coefficient, limit)) in (0..n).filter_map(slip) {
        let normal = names.iter().position(|&(i, across)| i == of && !across);
        for (k, direction) in components {
            if let Some(column) = normal.filter(|_| coefficient != 0.0) {
                forces[column].push((k, -direction * coefficient));
            }
            if limit != 0.0 {
                fixed[k] = -direction * limit;
            }
        }
    }
    let size = names.len();
    let along = |motion: &[(usize, f64)], of: &dyn Fn(usize) -> f64| -> f64 {
        motion.iter().map(|&(row, factor)| factor * of(row)).sum()
    };
    let mut matrix = Mat::from_fn(size, size, |r, c| {
        let moved = |row: usize| forces[c].iter().map(|&(j, factor)| factor * a[row * n + j]).sum::<f64>();
        along(&motions[r], &moved)
    });
    (0..size).for_each(|i| matrix[(i, i)] += diagonal[i]);
    let known = |row: usize| b[row] + (0..n).map(|j| a[row * n + j] * fixed[j]).sum::<f64>();
    let mut right = Mat::from_fn(size, 1, |r, _| -along(&motions[r], &known));
    matrix.partial_piv_lu().solve_in_place(right.as_mut());
    let (mut z, mut turns) = (fixed, Vec::new());
    for (r, &(i, across)) in names.iter().enumerate() {
        if across {
            turns.push((i, right[(r, 0)]));
        } else {
            forces[r].iter().for_each(|&(j, factor)| z[j] = factor * right[(r, 0)]);
        }
    }
    z.iter().all(|value| value.is_finite()).then_some((z, turns))
}
