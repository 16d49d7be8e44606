//! Rigid motions that supports leave to a body: where there is no inertia, only contact can hold them, and what holds nothing has no equilibrium.
//!
//! The rigid motions of a body are its translations and, in the plane, the rotation about its middle. Held dofs (supports) and active contacts
//! (their gradients) are rows over these few unknowns; what is orthogonal to all rows is free.

use carom_contact::Linearised;

use super::{Contact, Model, Part};
use crate::case::Problem;

/// Translations along x and y, and the rotation.
const MODES: usize = 3;
/// Rows shorter than this (they are of order one) hold nothing.
const SHORT: f64 = 1e-8;

/// A rigid motion of a body that no support hinders.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Place of the body.
    pub part: usize,
    /// Translation along x, along y, rotation about `centre` × `size`.
    coefficients: [f64; MODES],
    centre: [f64; 2],
    size: f64,
}

/// A body that nothing holds.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "body \"{body}\" is free to {motion}: supports do not hold it there, and no closed contact does. Hold it with a [[support]], press it with \
     a support's `move` instead of a force, let it touch at the start, or take a scheme with inertia"
)]
pub struct Unheld {
    /// Its name.
    pub body: String,
    /// What it is free to do.
    pub motion: &'static str,
}

impl Mode {
    /// Displacement of a place along an axis.
    fn at<const D: usize>(&self, place: &[f64; D], axis: usize) -> f64 {
        let arm = |i: usize| if i < D { (place[i] - self.centre[i]) / self.size } else { 0.0 };
        self.coefficients[axis] + self.coefficients[2] * if axis == 0 { -arm(1) } else { arm(0) }
    }

    /// Its name by the largest coefficient.
    fn motion(&self) -> &'static str {
        let [x, y, turn] = self.coefficients.map(f64::abs);
        if turn >= x && turn >= y {
            "turn"
        } else if x >= y {
            "move along x"
        } else {
            "move along y"
        }
    }
}

/// Rigid motions left by the supports; a body that has one and no contact is a problem.
pub(super) fn unheld<const D: usize>(
    parts: &[Part<D>],
    fixed: &[bool],
    contacts: &[Contact<D>],
    problems: &mut Vec<Problem>,
) -> Vec<Mode> {
    let mut free = Vec::new();
    for (place, part) in parts.iter().enumerate() {
        let mesh = part.body.mesh();
        let count = mesh.nodes.len() as f64;
        let centre =
            std::array::from_fn(|i| if i < D { mesh.nodes.iter().map(|x| x[i]).sum::<f64>() / count } else { 0.0 });
        let mode = |coefficients| Mode { part: place, coefficients, centre, size: mesh.diameter() };
        let modes: Vec<Mode> = (0..if D == 1 { 1 } else { MODES })
            .map(|k| mode(std::array::from_fn(|i| f64::from(u8::from(i == k)))))
            .collect();
        let held = part.nodes().flat_map(|n| (0..D).map(move |i| (n, i))).filter(|(n, i)| fixed[n * D + i]);
        let row = |(node, axis): (usize, usize)| {
            modes.iter().map(|m| m.at(&mesh.nodes[node - part.first_node], axis)).collect::<Vec<f64>>()
        };
        for null in null_space(modes.len(), held.map(row)) {
            free.push(mode(std::array::from_fn(|k| null.get(k).copied().unwrap_or(0.0))));
        }
        let touches = |c: &Contact<D>| {
            c.primary_part == Some(place) || c.method.secondary().iter().any(|n| part.nodes().contains(n))
        };
        if let Some(mode) = free.iter().find(|m| m.part == place).filter(|_| !contacts.iter().any(touches)) {
            problems.push(Problem::new(
                format!("body[{place}]"),
                format!("body \"{}\" is free to {}: it has no equilibrium", part.name, mode.motion()),
                "the scheme \"static\" has no inertia, and neither a support nor a contact can hold the body",
                "add a [[support]], or take a scheme with inertia",
            ));
        }
    }
    free
}

/// A basis of what is orthogonal to all rows, of `size` entries each.
fn null_space(size: usize, rows: impl Iterator<Item = Vec<f64>>) -> Vec<Vec<f64>> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    // Orthonormal vectors, by Gram–Schmidt twice: first those that span the rows.
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut add = |mut row: Vec<f64>, short: f64| {
        for _ in 0..2 {
            for other in &basis {
                let overlap = dot(&row, other);
                row.iter_mut().zip(other).for_each(|(r, o)| *r -= overlap * o);
            }
        }
        let length = dot(&row, &row).sqrt();
        if length > short {
            row.iter_mut().for_each(|r| *r /= length);
            basis.push(row);
        }
        basis.len()
    };
    let mut spanned = 0;
    for row in rows {
        spanned = add(row, SHORT);
        if spanned == size {
            return Vec::new();
        }
    }
    for k in 0..size {
        add((0..size).map(|i| f64::from(u8::from(i == k))).collect(), 1e-3);
    }
    basis.split_off(spanned)
}

impl<const D: usize> Model<D> {
    /// Refuses active contacts that leave a body free to move as its supports do.
    ///
    /// # Errors
    /// The body and its motion.
    pub(crate) fn check_held<'a>(
        &self,
        y: &[f64],
        rows: impl Iterator<Item = &'a Linearised<D>>,
    ) -> Result<(), Unheld> {
        if self.unheld.is_empty() {
            return Ok(());
        }
        let y = y.as_chunks::<D>().0;
        let row = |gap: &Linearised<D>| -> Vec<f64> {
            let along = |mode: &Mode| {
                let own = |p: &usize| self.parts[mode.part].nodes().contains(&gap.nodes[*p]);
                let product = |p: usize| (0..D).map(|i| gap.gradient[p][i] * mode.at(&y[gap.nodes[p]], i)).sum::<f64>();
                (0..gap.count).filter(own).map(product).sum::<f64>()
            };
            self.unheld.iter().map(along).collect()
        };
        let Some(free) = null_space(self.unheld.len(), rows.map(row)).into_iter().next() else { return Ok(()) };
        let largest = (0..free.len()).max_by(|a, b| free[*a].abs().total_cmp(&free[*b].abs())).unwrap_or(0);
        let mode = &self.unheld[largest];
        Err(Unheld { body: self.parts[mode.part].name.clone(), motion: mode.motion() })
    }
}
