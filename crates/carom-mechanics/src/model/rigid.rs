//! Rigid modes that supports leave free. Without inertia only contact can constrain them; otherwise
//! there is no equilibrium.
//!
//! The rigid modes of a piece of a body are its translations and rotations about its centre,
//! u = t + ω × (x − c)/size: one in dimension 1, three in the plane, six in space. Constrained dofs
//! (supports), ties and active contacts (their gradients) are rows over these few unknowns; the
//! null space of the rows is free. Pieces that ties connect have modes together.

use std::sync::Arc;

use carom_contact::Row;

use super::body_instance::BodyInstance;
use super::pieces::{Piece, tied_pieces};
use super::points::{Point, Points};

/// Norm (rows are of order one) below which a row constrains nothing.
const SHORT: f64 = 1e-8;

/// Share of the largest motion from which another body moves with it.
const TOGETHER_FROM: f64 = 0.5;

/// A rigid mode of pieces that ties connect, or of one piece, that supports leave free.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// The motion of each of them.
    pub motions: Vec<RigidMotion>,
}

/// A rigid motion of a piece of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidMotion {
    /// Index of the body.
    pub part: usize,
    /// Global numbers of the nodes of the piece, ascending.
    pub nodes: Arc<[usize]>,
    translation: [f64; 3],
    rotation: [f64; 3],
    centre: [f64; 3],
    size: f64,
}

/// A body, or several that contacts hold together, that nothing constrains.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{} free to {motion}: {}", self.subject(), self.cause())]
pub struct Unconstrained {
    /// Names of the bodies that move together, the one that moves most first.
    pub bodies: Vec<String>,
    /// Whether a piece of the first one moves, not all of it.
    pub is_piece: bool,
    /// Their free motion.
    pub motion: &'static str,
    /// Whether closed contacts would constrain them if they did not slip.
    pub slips: bool,
}

impl Unconstrained {
    fn subject(&self) -> String {
        let names: Vec<String> = self.bodies.iter().map(|name| format!("\"{name}\"")).collect();
        match &names[..] {
            [only] if self.is_piece => format!("a piece of body {only} is"),
            [only] => format!("body {only} is"),
            _ => format!("bodies {} are together", names.join(", ")),
        }
    }

    fn cause(&self) -> &'static str {
        match self.bodies.len() {
            _ if self.slips => SLIPS,
            0 | 1 => FREE,
            _ => TOGETHER,
        }
    }
}

const FREE: &str = "neither supports nor closed contacts constrain this motion. Add a support, press the body with \
    a support that moves instead of a force, start with the contact closed, or use a scheme with inertia";
const TOGETHER: &str = "contacts hold them to each other, but no support constrains this motion. Add a support to one of \
    them, or use a scheme with inertia";
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
    /// The name of the largest motion, that of the first body among equal ones.
    pub fn motion(&self) -> &'static str {
        let first =
            self.motions.iter().reduce(|most, next| if next.most() > most.most() { next } else { most });
        first.map_or("move", RigidMotion::motion)
    }
}

impl RigidMotion {
    /// All rigid modes of a piece.
    fn all(parts: &[BodyInstance], piece: &Piece) -> Vec<Self> {
        let part = &parts[piece.part];
        let mesh = part.body.mesh();
        let mut centre = [0.0; 3];
        for i in 0..mesh.dimension() {
            let along = piece.nodes.iter().map(|node| mesh.nodes[node - part.first_node][i]);
            centre[i] = along.sum::<f64>() / piece.nodes.len() as f64;
        }
        let zero = Self {
            part: piece.part,
            nodes: piece.nodes.as_slice().into(),
            translation: [0.0; 3],
            rotation: [0.0; 3],
            centre,
            size: mesh.diameter(),
        };
        let unit = |axis: usize| std::array::from_fn(|i| f64::from(u8::from(i == axis)));
        let (along, about) = axes(mesh.dimension());
        let translations = along.iter().map(|&i| Self { translation: unit(i), ..zero.clone() });
        translations.chain(about.iter().map(|&i| Self { rotation: unit(i), ..zero.clone() })).collect()
    }

    /// Whether it moves a node.
    fn moves(&self, node: usize) -> bool {
        self.nodes.binary_search(&node).is_ok()
    }

    /// Whether it moves some nodes of its body and not others.
    pub fn is_of_piece(&self, parts: &[BodyInstance]) -> bool {
        self.nodes.len() < parts[self.part].nodes().len()
    }

    /// Σ shares · modes, of one piece.
    fn combined(modes: &[Self], shares: &[f64]) -> Self {
        let sum = |of: &dyn Fn(&Self) -> [f64; 3]| {
            std::array::from_fn(|i| modes.iter().zip(shares).map(|(mode, share)| share * of(mode)[i]).sum())
        };
        Self { translation: sum(&|m| m.translation), rotation: sum(&|m| m.rotation), ..modes[0].clone() }
    }

    /// Displacement of a point along an axis.
    pub(crate) fn at(&self, place: &[f64], axis: usize) -> f64 {
        let arm = |i: usize| place.get(i).map_or(0.0, |x| (x - self.centre[i]) / self.size);
        let j = (axis + 1) % 3;
        let k = (axis + 2) % 3;
        self.translation[axis] + self.rotation[j] * arm(k) - self.rotation[k] * arm(j)
    }

    /// Its shares of a rotation and of translations along the axes.
    fn shares(&self) -> [f64; 4] {
        let turn = self.rotation.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        [turn, self.translation[0].abs(), self.translation[1].abs(), self.translation[2].abs()]
    }

    fn most(&self) -> f64 {
        self.shares().into_iter().fold(0.0, f64::max)
    }

    /// Its name, from the largest share.
    fn motion(&self) -> &'static str {
        const NAMES: [&str; 4] = ["turn", "move along x", "move along y", "move along z"];
        let shares = self.shares();
        let largest = (0..4).fold(0, |most, k| if shares[k] > shares[most] { k } else { most });
        NAMES[largest]
    }
}

/// Rigid modes that constrained dofs and ties leave to the pieces of bodies.
pub fn free_motions(parts: &[BodyInstance], fixed: &[bool], points: &Points) -> Vec<Mode> {
    let mut free = Vec::new();
    for group in tied_pieces(parts, points) {
        let motions: Vec<RigidMotion> =
            group.iter().flat_map(|piece| RigidMotion::all(parts, piece)).collect();
        let supports = group.iter().flat_map(|piece| support_rows(parts, piece, fixed, &motions));
        let is_own = |point: &&Point| motions.iter().any(|motion| motion.moves(point.node));
        let ties = points.iter().filter(is_own).flat_map(|point| tie_rows(parts, point, &motions));
        for shares in null_space(motions.len(), supports.chain(ties)) {
            free.push(Mode { motions: combined(&motions, &shares) });
        }
    }
    free
}

/// The motions of the constrained dofs of a piece.
fn support_rows<'a>(
    parts: &'a [BodyInstance],
    piece: &'a Piece,
    fixed: &'a [bool],
    motions: &'a [RigidMotion],
) -> impl Iterator<Item = Vec<f64>> + 'a {
    let d = parts[piece.part].body.mesh().dimension();
    let dofs = piece.nodes.iter().flat_map(move |&node| (0..d).map(move |axis| (node, axis)));
    let constrained = dofs.filter(move |(node, axis)| fixed[node * d + axis]);
    constrained.map(move |(node, axis)| moved(parts, motions, node, axis))
}

/// The motions of a tied node relative to its point.
fn tie_rows<'a>(
    parts: &'a [BodyInstance],
    point: &'a Point,
    motions: &'a [RigidMotion],
) -> impl Iterator<Item = Vec<f64>> + 'a {
    let d = parts[0].body.mesh().dimension();
    (0..d).map(move |axis| {
        let mut row = moved(parts, motions, point.node, axis);
        for (carrier, weight) in &point.weights {
            let carried = moved(parts, motions, *carrier, axis);
            row.iter_mut().zip(carried).for_each(|(row, carried)| *row -= weight * carried);
        }
        row
    })
}

/// Displacement of a node along an axis by each motion, zero by those of other pieces.
fn moved(parts: &[BodyInstance], motions: &[RigidMotion], node: usize, axis: usize) -> Vec<f64> {
    let of = |motion: &RigidMotion| {
        if !motion.moves(node) {
            return 0.0;
        }
        let part = &parts[motion.part];
        motion.at(&part.body.mesh().nodes[node - part.first_node], axis)
    };
    motions.iter().map(of).collect()
}

/// Σ shares · motions, of each piece.
fn combined(motions: &[RigidMotion], shares: &[f64]) -> Vec<RigidMotion> {
    let mut first = 0;
    let mut all = Vec::new();
    for own in motions.chunk_by(|a, b| a.nodes == b.nodes) {
        all.push(RigidMotion::combined(own, &shares[first..first + own.len()]));
        first += own.len();
    }
    all
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
        let of_body = |motion: &RigidMotion| {
            let own = gap.entries().filter(|(dof, _)| motion.moves(dof / d));
            own.map(|(dof, slope)| slope * motion.at(&y[dof / d * d..dof / d * d + d], dof % d)).sum::<f64>()
        };
        let along = |mode: &Mode| mode.motions.iter().map(of_body).sum::<f64>();
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
    let first = mode.motions.first();
    let moves = |k: &usize| remaining[*k].abs() > TOGETHER_FROM * remaining[largest].abs();
    let together = (0..free.len()).filter(moves).filter(|&k| free[k].motion() == mode.motion());
    let mut bodies: Vec<String> = Vec::new();
    for motion in std::iter::once(largest).chain(together).filter_map(|k| free[k].motions.first()) {
        let name = &parts[motion.part].name;
        if !bodies.contains(name) {
            bodies.push(name.clone());
        }
    }
    Err(Unconstrained {
        bodies,
        is_piece: first.is_some_and(|motion| motion.is_of_piece(parts)),
        motion: mode.motion(),
        slips: remaining_with_slips.is_empty(),
    })
}
