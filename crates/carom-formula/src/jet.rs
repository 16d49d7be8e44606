//! Numbers a formula is evaluated in: plain ones, and second-order jets (x, ẋ, ẍ) that carry their
//! derivatives along,
//!
//! ```text
//! h(x)˙ = h′ẋ,   h(x)¨ = h″ẋ² + h′ẍ,   (xy)¨ = ẍy + 2ẋẏ + xÿ
//! ```
//!
//! exact to round-off: forward-mode differentiation (A. Griewank, A. Walther, *Evaluating
//! Derivatives*, 2nd ed., SIAM 2008, ch. 13).

use std::ops::{Add, Div, Mul, Neg, Sub};

/// What formulas are evaluated in.
pub(crate) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// A number that does not change.
    fn constant(value: f64) -> Self;
    /// Its value.
    fn value(self) -> f64;
    /// Whether it does not change.
    fn is_constant(self) -> bool;
    /// A function of it: its value, and its first and second derivative, asked for only if needed.
    fn map(self, value: f64, derivatives: impl FnOnce() -> [f64; 2]) -> Self;
}

impl Number for f64 {
    fn constant(value: f64) -> Self {
        value
    }

    fn value(self) -> f64 {
        self
    }

    fn is_constant(self) -> bool {
        true
    }

    fn map(self, value: f64, _: impl FnOnce() -> [f64; 2]) -> Self {
        value
    }
}

/// A value with its first and second derivative with respect to one variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Jet(pub [f64; 3]);

impl Number for Jet {
    fn constant(value: f64) -> Self {
        Self([value, 0.0, 0.0])
    }

    fn value(self) -> f64 {
        self.0[0]
    }

    fn is_constant(self) -> bool {
        self.0[1] == 0.0 && self.0[2] == 0.0
    }

    fn map(self, value: f64, derivatives: impl FnOnce() -> [f64; 2]) -> Self {
        // A constant stays one where the function has an infinite slope: √0, |0|.
        if self.is_constant() {
            return Self::constant(value);
        }
        let ([_, d, dd], [first, second]) = (self.0, derivatives());
        let curvature = if d == 0.0 { 0.0 } else { second * d * d };
        let slope = if dd == 0.0 { 0.0 } else { first * dd };
        Self([value, first * d, curvature + slope])
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + b.0[k]))
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] - b.0[k]))
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let ([x, dx, ddx], [y, dy, ddy]) = (self.0, b.0);
        Self([x * y, dx * y + x * dy, ddx * y + 2.0 * dx * dy + x * ddy])
    }
}

impl Div for Jet {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let ([x, dx, ddx], [y, dy, ddy]) = (self.0, b.0);
        let q = x / y;
        let dq = (dx - q * dy) / y;
        Self([q, dq, (ddx - 2.0 * dq * dy - q * ddy) / y])
    }
}
