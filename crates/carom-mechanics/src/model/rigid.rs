//! Rigid modes that supports leave free. Without inertia only contact can constrain them; otherwise
//! there is no equilibrium.
//!
//! The rigid modes of a body are its translations and rotations about its centre, u = t + ω × (x −
//! c)/size: one in dimension 1, three in the plane, six in space. Constrained dofs (supports) and
//! active contacts (their gradients) are rows over these few unknowns; the null space of the rows
//! is free.

use carom_contact::Row;

use super::body_instance::BodyInstance;

/// Norm (rows are of order one) below which a row constrains nothing.
const SHORT: f64 = 1e-8;

/// A rigid mode of a body that supports leave free.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Index of the body.
    pub part: usize,
    translation: [f64; 3],
    rotation: [f64; 3],
    centre: [f64; 3],
    size: f64,
}

/// An unconstrained body.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("body \"{body}\" is free to {motion}: {}", if *slips { SLIPS } else { FREE })]
pub struct Unconstrained {
    /// Its name.
    pub body: String,
    /// Its free motion.
    pub motion: &'static str,
    /// Whether closed contacts would constrain it if they did not slip.
    pub slips: bool,
}

const FREE: &str = "neither supports nor closed contacts constrain this motion. Add a support, press the body with \
    a support that moves instead of a force, start with the contact closed, or use a scheme with inertia";
const SLIPS: &str = "its closed contacts slip, and the load exceeds what friction can carry. Use a smaller load, a \
    larger coefficient or shear limit of friction, a support that moves, or a scheme with inertia";

/// Axes of the translations and of the rotations in a dimension.
fn axes(dimension: usize) -> (&'static [usize], &'static [usize]) {
    match dimension {
        1 => (&[0], &[]),
        2 => (&[0, 1], &[2]),
        _ => (&[0, 1, 2], &[0, 1, 2]),
    }
}

impl Mode {
    /// All rigid modes of a body.
    fn all(place: usize, part: &BodyInstance) -> Vec<Self> {
        let mesh = part.body.mesh();
        let mut centre = [0.0; 3];
        for i in 0..mesh.dimension() {
            centre[i] = mesh.nodes.iter().map(|x| x[i]).sum::<f64>() / mesh.nodes.len() as f64;
        }
        let zero =
            Self { part: place, translation: [0.0; 3], rotation: [0.0; 3], centre, size: mesh.diameter() };
        let unit = |axis: usize| std::array::from_fn(|i| f64::from(u8::from(i == axis)));
        let (along, about) = axes(mesh.dimension());
        let translations = along.iter().map(|&i| Self { translation: unit(i), ..zero.clone() });
        translations.chain(about.iter().map(|&i| Self { rotation: unit(i), ..zero.clone() })).collect()
    }

    /// Σ shares · modes, of one body.
    fn combined(modes: &[Self], shares: &[f64]) -> Self {
        let sum = |of: &dyn Fn(&Self) -> [f64; 3]| {
            std::array::from_fn(|i| modes.iter().zip(shares).map(|(mode, share)| share * of(mode)[i]).sum())
        };
        Self { translation: sum(&|m| m.translation), rotation: sum(&|m| m.rotation), ..modes[0].clone() }
    }

    /// Displacement of a point along an axis.
    pub(crate) fn at(&self, place: &[f64], axis: usize) -> f64 {
        let arm = |i: usize| place.get(i).map_or(0.0, |x| (x - self.centre[i]) / self.size);
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        self.translation[axis] + self.rotation[j] * arm(k) - self.rotation[k] * arm(j)
    }

    /// Its name, from the largest share.
    pub fn motion(&self) -> &'static str {
        const NAMES: [&str; 4] = ["turn", "move along x", "move along y", "move along z"];
        let turn = self.rotation.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let shares = [turn, self.translation[0].abs(), self.translation[1].abs(), self.translation[2].abs()];
        let largest = (0..4).fold(0, |most, k| if shares[k] > shares[most] { k } else { most });
        NAMES[largest]
    }
}

/// Rigid modes that constrained dofs leave to the bodies.
pub fn free_motions(parts: &[BodyInstance], fixed: &[bool]) -> Vec<Mode> {
    let mut free = Vec::new();
    for (place, part) in parts.iter().enumerate().filter(|(_, part)| !part.is_rigid()) {
        let (mesh, modes) = (part.body.mesh(), Mode::all(place, part));
        let d = mesh.dimension();
        let constrained =
            part.nodes().flat_map(|n| (0..d).map(move |i| (n, i))).filter(|(n, i)| fixed[n * d + i]);
        let row = |(node, axis): (usize, usize)| {
            modes.iter().map(|m| m.at(&mesh.nodes[node - part.first_node], axis)).collect::<Vec<f64>>()
        };
        free.extend(
            null_space(modes.len(), constrained.map(row)).iter().map(|shares| Mode::combined(&modes, shares)),
        );
    }
    free
}

/// A basis of the null space of all rows, of `size` entries each.
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

/// Checks that active contacts, by their rows at positions `y`, constrain the rigid modes left free
/// by supports. `slips`: the rows of pairs that slip.
///
/// # Errors
/// The body and its motion.
pub(crate) fn check_rigid_modes<'a>(
    parts: &[BodyInstance],
    free: &[Mode],
    y: &[f64],
    rows: impl Iterator<Item = Row<'a>>,
    slips: impl Iterator<Item = Row<'a>>,
) -> Result<(), Unconstrained> {
    if free.is_empty() {
        return Ok(());
    }
    let row = |gap: Row| -> Vec<f64> {
        let d = gap.dimension();
        let along = |mode: &Mode| {
            let nodes = parts[mode.part].nodes();
            let own = gap.entries().filter(|(dof, _)| nodes.contains(&(dof / d)));
            own.map(|(dof, slope)| slope * mode.at(&y[dof / d * d..dof / d * d + d], dof % d)).sum::<f64>()
        };
        free.iter().map(along).collect()
    };
    let rows: Vec<Vec<f64>> = rows.map(row).collect();
    let Some(remaining) = null_space(free.len(), rows.iter().cloned()).into_iter().next() else {
        return Ok(());
    };
    let remaining_with_slips = null_space(free.len(), rows.into_iter().chain(slips.map(row)));
    let largest =
        (0..remaining.len()).max_by(|a, b| remaining[*a].abs().total_cmp(&remaining[*b].abs())).unwrap_or(0);
    let mode = &free[largest];
    Err(Unconstrained {
        body: parts[mode.part].name.clone(),
        motion: mode.motion(),
        slips: remaining_with_slips.is_empty(),
    })
}
