//! Numbers that matrices are made of: one, or four in the lanes of a register. A formula that is
//! written for any of them gives the same bits in every lane as for one number.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number, or several numbers in lanes.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// Zero in every lane.
    const ZERO: Self;

    /// A number copied to every lane.
    fn of(number: f64) -> Self;

    /// Applies a function to the number in each lane.
    #[must_use]
    fn map(self, function: impl Fn(f64) -> f64) -> Self;

    /// Applies a function of two numbers, lane by lane.
    #[must_use]
    fn zip(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self;

    /// The larger one of two numbers, lane by lane.
    #[must_use]
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, f64::max)
    }

    /// The number in the first lane that has a property, if there is one.
    fn find(self, has: impl Fn(f64) -> bool) -> Option<f64>;
}

impl Real for f64 {
    const ZERO: Self = 0.0;

    #[inline(always)]
    fn of(number: f64) -> Self {
        number
    }

    #[inline(always)]
    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        function(self)
    }

    #[inline(always)]
    fn zip(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        function(self, other)
    }

    #[inline(always)]
    fn find(self, has: impl Fn(f64) -> bool) -> Option<f64> {
        has(self).then_some(self)
    }
}

/// Four numbers in lanes.
///
/// ```
/// use carom_algebra::{Four, Mat, Real};
/// let swollen = Mat::<2, Four>::identity() * Four([1.0, 2.0, 3.0, 4.0]);
/// assert_eq!(swollen.det().0, [1.0, 4.0, 9.0, 16.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Four(pub [f64; 4]);

impl Real for Four {
    const ZERO: Self = Self([0.0; 4]);

    #[inline(always)]
    fn of(number: f64) -> Self {
        Self([number; 4])
    }

    #[inline(always)]
    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        let mut lanes = self;
        for l in 0..4 {
            lanes.0[l] = function(self.0[l]);
        }
        lanes
    }

    #[inline(always)]
    fn zip(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        let mut lanes = self;
        for l in 0..4 {
            lanes.0[l] = function(self.0[l], other.0[l]);
        }
        lanes
    }

    #[inline(always)]
    fn find(self, has: impl Fn(f64) -> bool) -> Option<f64> {
        // Without a branch for each lane.
        let mut any = false;
        for l in 0..4 {
            any |= has(self.0[l]);
        }
        if any { self.0.into_iter().find(|x| has(*x)) } else { None }
    }
}

macro_rules! in_lanes {
    ($($operation:ident $method:ident $symbol:tt),*) => {$(
        impl $operation for Four {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let mut lanes = self;
                for l in 0..4 {
                    lanes.0[l] = self.0[l] $symbol other.0[l];
                }
                lanes
            }
        }
    )*};
}

in_lanes!(Add add +, Sub sub -, Mul mul *, Div div /);

impl Neg for Four {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|x| -x)
    }
}
