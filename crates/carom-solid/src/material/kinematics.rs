//! Functions of F = I + H without cancellation for small H: J − 1 = tr H + … + det H, cof F − I, x
//! − ln(1 + x).

use carom_algebra::{Mat, Real};

/// A determinant J of the deformation gradient that is not positive.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("J = {0:.3e} is not positive")]
pub struct NotPositive(pub f64);

/// det(I + H) − 1.
#[inline(always)]
pub fn excess_det<const D: usize, T: Real>(h: &Mat<D, T>) -> T {
    match D {
        1 => h.0[0][0],
        2 => h.trace() + h.det(),
        _ => h.trace() + h.cofactor().trace() + h.det(),
    }
}

/// det(I + H) − 1 of a deformation that is one.
#[inline(always)]
pub(crate) fn valid_excess<const D: usize, T: Real>(h: &Mat<D, T>) -> Result<T, NotPositive> {
    let excess = excess_det(h);
    match excess.find(|excess| excess <= -1.0 || excess.is_nan()) {
        Some(excess) => Err(NotPositive(1.0 + excess)),
        None => Ok(excess),
    }
}

/// cof(I + H) − I.
#[inline(always)]
pub fn excess_cofactor<const D: usize, T: Real>(h: &Mat<D, T>) -> Mat<D, T> {
    match D {
        1 => Mat::ZERO,
        2 => h.cofactor(),
        _ => Mat::identity() * h.trace() - h.transposed() + h.cofactor(),
    }
}

/// ln(1 + x), and x − ln(1 + x), which is x²/2 for small x. With s = x/(2 + x): ln(1 + x) = 2
/// artanh s = 2s + r and x − 2s = x s.
#[inline(always)]
pub fn ln_1p<T: Real>(x: T) -> [T; 2] {
    if x.find(|x| x.abs() > 0.1).is_some() {
        let part = |k: usize| {
            x.map(|x| if x.abs() > 0.1 { [x.ln_1p(), x - x.ln_1p()][k] } else { series_of_ln_1p(x)[k] })
        };
        return [part(0), part(1)];
    }
    series_of_ln_1p(x)
}

/// Coefficients of the series of artanh. Loops over indices are unrolled.
const ODD: [f64; 5] = [1.0 / 11.0, 1.0 / 9.0, 1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0];

/// Coefficients 1/k! of the exponential, k = 9, 8, …, 1.
const FACTORIALS: [f64; 9] = [
    1.0 / 362_880.0,
    1.0 / 40_320.0,
    1.0 / 5_040.0,
    1.0 / 720.0,
    1.0 / 120.0,
    1.0 / 24.0,
    1.0 / 6.0,
    0.5,
    1.0,
];

#[inline(always)]
fn series_of_ln_1p<T: Real>(x: T) -> [T; 2] {
    let s = x / (T::of(2.0) + x);
    let t = s * s;
    let mut series = T::of(1.0 / 13.0);
    for k in 0..ODD.len() {
        series = T::of(ODD[k]) + t * series;
    }
    let r = T::of(2.0) * s * t * series;
    [T::of(2.0) * s + r, x * s - r]
}

/// exp(x) − 1. The terms omitted are below |x|¹¹/11!: round-off.
#[inline(always)]
pub fn exp_m1<T: Real>(x: T) -> T {
    if x.find(|x| x.abs() > 0.05).is_some() {
        return x.map(|x| if x.abs() > 0.05 { x.exp_m1() } else { series_of_exp_m1(x) });
    }
    series_of_exp_m1(x)
}

#[inline(always)]
fn series_of_exp_m1<T: Real>(x: T) -> T {
    let mut series = T::of(1.0 / 3_628_800.0);
    for k in 0..FACTORIALS.len() {
        series = T::of(FACTORIALS[k]) + x * series;
    }
    x * series
}
