//! Nodes that carry a rigid obstacle and move with it. Every point p of the obstacle, in the
//! coordinates in which its shape is given, is a constant combination of their positions,
//!
//! ```text
//! x(p) = Σ w_a(p) y_a,   w_a = ω_a·(p − X₀) (a ≥ 1),   w₀ = 1 − Σ w_a,   F = ∂x/∂p = Σ y_a ω_aᵀ
//! ```
//!
//! with the nodes of a simplex of edges ℓ along the axes, X_a = X₀ + ℓ e_a, ω_a = e_a/ℓ, if it may
//! turn, or of one node X₀ with which it only moves along, F = 1. Motion of an obstacle is motion
//! of nodes: supports prescribe it, masses make it free, and reactions and works are theirs.

use carom_algebra::{Mat, Vector};

use super::obstacle::Point;

/// The nodes that carry a rigid obstacle.
#[derive(Clone, Debug, PartialEq)]
pub struct Carrier {
    /// Global numbers of the carrying nodes: one if the obstacle only translates, d + 1 in d
    /// dimensions if it may turn.
    pub nodes: Vec<usize>,
    /// Position X₀ of the first carrying node in the coordinates in which the shape is given.
    pub origin: [f64; 3],
    /// Length ℓ of the edges of the simplex that the carrying nodes form.
    pub length: f64,
}

/// A point of space in the coordinates in which the shape of an obstacle is given.
#[derive(Clone, Copy, Debug)]
pub(super) struct Local {
    /// Position p in the coordinates of the shape.
    pub at: Point,
    /// Weight w_a(p) of each carrying node in the position of the point.
    pub weights: [f64; 4],
    /// Inverse F⁻¹ of the deformation of the carrying simplex; none if the obstacle does not turn.
    inverse: Option<Mat<3>>,
    /// Spatial gradient F⁻ᵀ ω_a of the weight of each carrying node; zero if the obstacle does not
    /// turn.
    slopes: [Point; 4],
}

impl Carrier {
    /// Reference positions of the carrying nodes, flat, with `dimension` components each.
    pub fn places(&self, dimension: usize) -> Vec<f64> {
        let mut places = Vec::new();
        for a in 0..self.nodes.len() {
            for i in 0..dimension {
                places.push(self.origin[i] + if a == i + 1 { self.length } else { 0.0 });
            }
        }
        places
    }

    /// Whether the obstacle may turn.
    pub fn turns(&self) -> bool {
        self.nodes.len() > 1
    }

    /// F = ∂x/∂p of an obstacle that turns, its rotation since the start.
    pub(super) fn gradient(&self, y: &[f64], dimension: usize) -> Mat<3> {
        let coordinate = |a: usize, i: usize| y[self.nodes[a] * dimension + i];
        let mut f = Mat::<3>::identity();
        for a in 1..self.nodes.len() {
            (0..dimension).for_each(|i| f.0[i][a - 1] = (coordinate(a, i) - coordinate(0, i)) / self.length);
        }
        f
    }

    /// The point of the obstacle that lies at a place in space, at the positions `y` of all nodes.
    pub(super) fn local(&self, place: Point, y: &[f64], dimension: usize) -> Local {
        let node = |a: usize| -> Point {
            let first = self.nodes[a] * dimension;
            std::array::from_fn(|i| if i < dimension { y[first + i] } else { 0.0 })
        };
        let origin = node(0);
        let mut arm: Point = std::array::from_fn(|i| place[i] - origin[i]);
        let mut weights = [1.0, 0.0, 0.0, 0.0];
        let mut inverse = None;
        let mut slopes = [[0.0; 3]; 4];
        if self.turns() {
            let back = self.gradient(y, dimension).inverse();
            arm = back.apply(&Vector(arm)).0;
            for a in 1..self.nodes.len() {
                weights[a] = arm[a - 1] / self.length;
                weights[0] -= weights[a];
                slopes[a] = back.0[a - 1].map(|x| x / self.length);
                (0..3).for_each(|i| slopes[0][i] -= slopes[a][i]);
            }
            inverse = Some(back);
        }
        let at = std::array::from_fn(|i| self.origin[i] + arm[i]);
        Local { at, weights, inverse, slopes }
    }

    /// Weights w_a(p) of the carrying nodes in the position of a point p of the obstacle.
    pub(super) fn weights(&self, p: Point) -> impl Iterator<Item = f64> + '_ {
        let arm =
            move |a: usize| if self.turns() { (p[a - 1] - self.origin[a - 1]) / self.length } else { 0.0 };
        let arms = move || (1..self.nodes.len()).map(arm);
        std::iter::once(1.0 - arms().sum::<f64>()).chain(arms())
    }

    /// Position x(p) in space of a point p of the obstacle.
    pub(super) fn placed(&self, p: Point, y: &[f64], dimension: usize) -> Point {
        let coordinate = |a: usize, i: usize| {
            if i < dimension { y[self.nodes[a] * dimension + i] } else { 0.0 }
        };
        std::array::from_fn(|i| {
            let arm = |a: usize| (p[a - 1] - self.origin[a - 1]) / self.length;
            let moved = (1..self.nodes.len()).map(|a| arm(a) * (coordinate(a, i) - coordinate(0, i)));
            if self.turns() {
                coordinate(0, i) + moved.sum::<f64>()
            } else {
                coordinate(0, i) + p[i] - self.origin[i]
            }
        })
    }
}

impl Local {
    /// A point of an obstacle that is fixed in space.
    pub(super) fn fixed(at: Point) -> Self {
        Self { at, weights: [0.0; 4], inverse: None, slopes: [[0.0; 3]; 4] }
    }

    /// A vector v of space in the coordinates of the shape, F⁻¹ v.
    pub(super) fn back(&self, v: Point) -> Point {
        self.inverse.map_or(v, |inverse| inverse.apply(&Vector(v)).0)
    }

    /// A gradient v in the coordinates of the shape as a gradient in space, F⁻ᵀ v.
    pub(super) fn forth(&self, v: Point) -> Point {
        self.inverse.map_or(v, |inverse| inverse.transposed().apply(&Vector(v)).0)
    }

    /// Spatial gradient F⁻ᵀ ω_a of the weight of a carrying node.
    pub(super) fn slope(&self, a: usize) -> Point {
        self.slopes[a]
    }
}
