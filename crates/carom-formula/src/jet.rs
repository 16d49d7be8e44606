//! Numbers that formulas are evaluated in: the Taylor coefficients x₀ = x, x₁ = ẋ, x₂ = ẍ/2 along
//! one variable, all three (N = 3) or the value alone (N = 1),
//!
//! ```text
//! (xy)_k = Σ_{j≤k} x_{k−j} y_j,   (x/y)_k = (x_k − Σ_{0<j≤k} (x/y)_{k−j} y_j) / y₀,
//! h(x)₁ = h′x₁,   h(x)₂ = h″x₁²/2 + h′x₂
//! ```
//!
//! exact to round-off: forward-mode differentiation (A. Griewank, A. Walther, *Evaluating
//! Derivatives*, 2nd ed., SIAM 2008, ch. 13).

use std::array::from_fn;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value and N − 1 Taylor coefficients, N = 1 or 3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Jet<const N: usize>(pub(crate) [f64; N]);

impl<const N: usize> Jet<N> {
    /// A number that does not change.
    pub(crate) fn constant(value: f64) -> Self {
        Self(from_fn(|k| if k == 0 { value } else { 0.0 }))
    }

    /// Its value.
    pub(crate) fn value(self) -> f64 {
        self.0[0]
    }

    /// Whether it does not change.
    pub(crate) fn is_constant(self) -> bool {
        self.0[1..].iter().all(|x| *x == 0.0)
    }

    /// A function of it: its value, and its first and second derivative, asked for only if needed.
    pub(crate) fn map(self, value: f64, derivatives: impl FnOnce() -> [f64; 2]) -> Self {
        let mut image = Self::constant(value);
        // A constant stays one where the function has an infinite slope: √0, |0|.
        if let [_, x1, x2] = self.0[..]
            && !self.is_constant()
        {
            let [first, second] = derivatives();
            let curvature = if x1 == 0.0 { 0.0 } else { 0.5 * second * x1 * x1 };
            let slope = if x2 == 0.0 { 0.0 } else { first * x2 };
            image.0[1..].copy_from_slice(&[first * x1, curvature + slope]);
        }
        image
    }
}

impl<const N: usize> Add for Jet<N> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self(from_fn(|k| self.0[k] + b.0[k]))
    }
}

impl<const N: usize> Sub for Jet<N> {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self(from_fn(|k| self.0[k] - b.0[k]))
    }
}

impl<const N: usize> Neg for Jet<N> {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl<const N: usize> Mul for Jet<N> {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Self(from_fn(|k| (0..=k).map(|j| self.0[k - j] * b.0[j]).sum()))
    }
}

impl<const N: usize> Div for Jet<N> {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let mut q = self.0;
        for k in 0..N {
            for j in 1..=k {
                q[k] -= q[k - j] * b.0[j];
            }
            q[k] /= b.0[0];
        }
        Self(q)
    }
}
