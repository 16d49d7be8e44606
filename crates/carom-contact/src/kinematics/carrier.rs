//! What carries a rigid obstacle: nodes that move with it. Every point p of the obstacle, in the
//! coordinates in which its shape is given, is a constant combination of them,
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

/// The nodes that carry an obstacle.
#[derive(Clone, Debug, PartialEq)]
pub struct Carrier {
    /// Global numbers of its nodes: one, or one more than there are dimensions.
    pub nodes: Vec<usize>,
    /// Position X₀ of the first for which the shape is given.
    pub origin: [f64; 3],
    /// Length ℓ of the edges of the simplex.
    pub length: f64,
}

/// A point of space in the coordinates of the shape.
#[derive(Clone, Copy, Debug)]
pub(super) struct Local {
    /// p.
    pub at: Point,
    /// w_a(p) of each node of the carrier.
    pub weights: [f64; 4],
    /// F⁻¹; none of an obstacle that does not turn.
    inverse: Option<Mat<3>>,
    /// F⁻ᵀ ω_a, zero where it does not turn.
    slopes: [Point; 4],
}

impl Carrier {
    /// Reference positions of its nodes, flat, in a space of some dimension.
    pub fn places(&self, dimension: usize) -> Vec<f64> {
        let mut places = Vec::new();
        for a in 0..self.nodes.len() {
            for i in 0..dimension {
                places.push(self.origin[i] + if a == i + 1 { self.length } else { 0.0 });
            }
        }
        places
    }

    /// Whether it may turn.
    pub fn turns(&self) -> bool {
        self.nodes.len() > 1
    }

    /// The point of the obstacle at a place, `y` the positions of all nodes.
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
            let mut f = Mat::<3>::identity();
            for a in 1..self.nodes.len() {
                let end = node(a);
                (0..dimension).for_each(|i| f.0[i][a - 1] = (end[i] - origin[i]) / self.length);
            }
            let back = f.inverse();
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

    /// x(p).
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
    /// A point of an obstacle that does not move.
    pub(super) fn fixed(at: Point) -> Self {
        Self { at, weights: [0.0; 4], inverse: None, slopes: [[0.0; 3]; 4] }
    }

    /// F⁻¹ v.
    pub(super) fn back(&self, v: Point) -> Point {
        self.inverse.map_or(v, |inverse| inverse.apply(&Vector(v)).0)
    }

    /// F⁻ᵀ v.
    pub(super) fn forth(&self, v: Point) -> Point {
        self.inverse.map_or(v, |inverse| inverse.transposed().apply(&Vector(v)).0)
    }

    /// F⁻ᵀ ω_a of a node of the carrier.
    pub(super) fn slope(&self, a: usize) -> Point {
        self.slopes[a]
    }
}
