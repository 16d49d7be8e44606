//! The weight with which a point of the secondary side faces the primary, from 0 to 1 without a
//! jump, with its derivatives. With the unit normals m of the secondary side and n of the primary,
//!
//! ```text
//! w = φ(c),  c = −m·n,    m = t rotated / |t|,  t = Σ_a N_a' y_a,    n = ∂g/∂x
//! ∂m = −τ (m·∂t)/|t|,     ∂²m = (2τ (τ·∂t)(m·∂t) − m (m·∂t)²)/|t|²,  τ: the unit vector along t
//! ∂n: the rows of the point in ∇²g
//! ```
//!
//! A point that counts partly adds w g to a weighted gap, with
//!
//! ```text
//! ∇(w g) = w ∇g + g φ' ∇c,   ∇²(w g) = w ∇²g + φ' (∇c ⊗ ∇g + ∇g ⊗ ∇c) + g (φ'' ∇c ⊗ ∇c + φ' ∇²c).
//! ```
//!
//! By the first, forces have a potential, and sum to zero with their moments. In the second, which
//! only Newton's method uses, ∂²n is left out.

use carom_algebra::Vector;

use super::opposite::PointGap;
use crate::constants::MORTAR_FACES;

/// Most vectors on which a gap and its weight depend: the point, four nodes opposite, and the
/// tangent.
pub(super) const MOST: usize = 6;

/// Weight φ of a cosine, with its first two derivatives.
fn weight(cosine: f64) -> [f64; 3] {
    let [fully, hardly] = MORTAR_FACES;
    let rate = (fully - hardly).recip();
    let x = ((cosine - hardly) * rate).clamp(0.0, 1.0);
    let inner = if x > 0.0 && x < 1.0 { 1.0 } else { 0.0 };
    [x * x * (3.0 - 2.0 * x), 6.0 * x * (1.0 - x) * rate, inner * (6.0 - 12.0 * x) * rate * rate]
}

/// Weight φ of a pair of unit normals.
pub(super) fn faces(own: Vector<2>, other: Vector<2>) -> f64 {
    weight(-own.dot(&other))[0]
}

/// A tangent t of the secondary side, not normalised, with the unit normal there.
#[derive(Clone, Copy)]
pub(super) struct Own {
    pub(super) tangent: Vector<2>,
    pub(super) normal: Vector<2>,
}

/// Derivatives of the weight of a point that counts partly, relative to the weight, by the point,
/// the nodes opposite and, last, the tangent.
#[derive(Clone, Debug)]
pub(super) struct Turned {
    /// Ratios φ'/φ and φ''/φ.
    rates: [f64; 2],
    /// Gradient ∇c.
    slopes: Vec<Vector<2>>,
    /// Second derivative ∇²c, two components each, row-major.
    curvature: Vec<f64>,
}

impl Turned {
    /// The weight of a point with a gap; its derivatives, where it is neither 0 nor 1.
    pub(super) fn of(own: &Own, gap: &PointGap) -> (f64, Option<Box<Self>>) {
        let normal = gap.normal();
        let [value, first, second] = weight(-own.normal.dot(&normal));
        if value == 0.0 || value == 1.0 {
            return (value, None);
        }
        let count = gap.count();
        let mut hessian = [0.0; 4 * MOST * MOST];
        gap.curvature_into(&mut hessian);
        // The derivative of v·n by each vector of the gap, from the rows of the point. That of the
        // gradient along itself is no rotation.
        let turn = |v: Vector<2>, p: usize| {
            let across = v - normal * v.dot(&normal);
            let row = |i: usize| Vector([0, 1].map(|j| hessian[i * 2 * count + 2 * p + j]));
            row(0) * across.0[0] + row(1) * across.0[1]
        };
        let length = own.tangent.norm();
        let along = own.tangent * length.recip();
        // The derivative of m is along times this.
        let turn_of_own = own.normal * -length.recip();
        let mut slopes: Vec<Vector<2>> = (0..count).map(|p| -turn(own.normal, p)).collect();
        slopes.push(turn_of_own * -along.dot(&normal));
        let size = 2 * (count + 1);
        let mut curvature = vec![0.0; size * size];
        let last = 2 * count;
        for p in 0..count {
            let across = turn(along, p);
            for i in 0..2 {
                for j in 0..2 {
                    let value = -turn_of_own.0[i] * across.0[j];
                    curvature[(last + i) * size + 2 * p + j] += value;
                    curvature[(2 * p + j) * size + last + i] += value;
                }
            }
        }
        let [sine, cosine] = [along.dot(&normal), own.normal.dot(&normal)];
        for i in 0..2 {
            for j in 0..2 {
                let mixed = along.0[i] * own.normal.0[j] + own.normal.0[i] * along.0[j];
                let square = own.normal.0[i] * own.normal.0[j];
                curvature[(last + i) * size + last + j] -=
                    (sine * mixed - cosine * square) / (length * length);
            }
        }
        (value, Some(Box::new(Self { rates: [first / value, second / value], slopes, curvature })))
    }

    /// Calls a function with the parts g φ'/φ ∇c of the gradient.
    pub(super) fn gradient(&self, gap: f64, mut of: impl FnMut(usize, Vector<2>)) {
        for (p, slope) in self.slopes.iter().enumerate() {
            of(p, *slope * (gap * self.rates[0]));
        }
    }

    /// Number of vectors, the tangent included.
    pub(super) fn count(&self) -> usize {
        self.slopes.len()
    }

    /// The second derivative of φ g over φ; `gap`: g, with an initial depth.
    pub(super) fn curvature_into(&self, gap: f64, of: &PointGap, matrix: &mut [f64]) {
        let count = self.count();
        let [inner, size] = [2 * (count - 1), 2 * count];
        let mut hessian = [0.0; 4 * MOST * MOST];
        of.curvature_into(&mut hessian);
        let mut gradient = [Vector::ZERO; MOST];
        of.gradient(0.0, |p, slope| gradient[p] = slope);
        let [first, second] = self.rates;
        for row in 0..size {
            for column in 0..size {
                let [p, q] = [row / 2, column / 2];
                let [i, j] = [row % 2, column % 2];
                let is_inner = row < inner && column < inner;
                let own = if is_inner { hessian[row * inner + column] } else { 0.0 };
                let [of_row, of_column] = [self.slopes[p].0[i], self.slopes[q].0[j]];
                let mixed = of_row * gradient[q].0[j] + gradient[p].0[i] * of_column;
                let turned = second * of_row * of_column + first * self.curvature[row * size + column];
                matrix[row * size + column] = own + first * mixed + gap * turned;
            }
        }
    }
}
