//! Observed orders of convergence, and extrapolation to step zero.
//!
//! ```text
//! f(h) = f₀ + C hᵖ:   (f₁ − f₂)/(f₂ − f₃) = (h₁ᵖ − h₂ᵖ)/(h₂ᵖ − h₃ᵖ)        p from three steps h₁ > h₂ > h₃
//!                     e₁/e₂ = (h₁/h₂)ᵖ                                     p from two errors
//!                     f₀ = f₃ − (f₂ − f₃)·h₃ᵖ/(h₂ᵖ − h₃ᵖ)                  Richardson; band 1.25·|f₃ − f₀|
//! ```
//!
//! The band is Roache's grid convergence index with the safety factor 1.25, for studies with more
//! than two grids (P. J. Roache, "Perspective: a method for uniform reporting of grid refinement
//! studies", J. Fluids Eng. 116, 1994). An order is established if the estimates of two successive
//! triples of steps agree within [`MARGIN`].

use crate::Reason;

/// Largest difference of two successive estimates of an established order.
pub const MARGIN: f64 = 0.3;

/// Safety factor of the distance from a value that is extrapolated with an observed order (P. J.
/// Roache).
pub(crate) const SAFE: f64 = 1.25;

/// A difference below this fraction of the values is round-off.
pub(crate) const ROUND_OFF: f64 = 1e-12;

/// An established order, and the extrapolated value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extrapolation {
    /// Order from the three finest steps.
    pub order: f64,
    /// Value at step zero.
    pub value: f64,
    /// Half width of the uncertainty band of the value.
    pub band: f64,
}

/// Order from the differences f₁ − f₂ and f₂ − f₃ (or their norms) at three decreasing steps.
///
/// # Errors
/// Steps that do not decrease, differences of opposite signs, or a difference of zero.
pub fn from_differences(steps: [f64; 3], differences: [f64; 2]) -> Result<f64, Reason> {
    decreasing(&steps)?;
    let quotient = differences[0] / differences[1];
    if differences.contains(&0.0) || !quotient.is_finite() {
        return Err(format!(
            "the quotient of the differences {:.3e} and {:.3e} is not defined",
            differences[0], differences[1]
        )
        .into());
    }
    if quotient < 0.0 {
        return Err(format!(
            "convergence is not monotonic: the differences {:.3e} and {:.3e} have opposite signs",
            differences[0], differences[1]
        )
        .into());
    }
    // (h₁ᵖ − h₂ᵖ)/(h₂ᵖ − h₃ᵖ), divided by h₂ᵖ; it grows with p from 0 to infinity.
    let coarse = (steps[0] / steps[1]).ln();
    let fine = (steps[1] / steps[2]).ln();
    let ratio = |p: f64| {
        if p.abs() < 1e-9 { coarse / fine } else { (p * coarse).exp_m1() / -(-p * fine).exp_m1() }
    };
    let mut low = -20.0;
    let mut high = 40.0;
    if ratio(low) > quotient || ratio(high) < quotient {
        return Err(format!(
            "no order fits the differences {:.3e} and {:.3e}",
            differences[0], differences[1]
        )
        .into());
    }
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if ratio(middle) < quotient { low = middle } else { high = middle }
    }
    Ok(0.5 * (low + high))
}

/// Order from two errors at two decreasing steps.
///
/// # Errors
/// Steps that do not decrease, or an error of zero.
pub fn from_errors(steps: [f64; 2], errors: [f64; 2]) -> Result<f64, Reason> {
    decreasing(&steps)?;
    let order = (errors[0] / errors[1]).abs().ln() / (steps[0] / steps[1]).ln();
    if order.is_finite() {
        Ok(order)
    } else {
        Err(format!("no order fits the errors {:.3e} and {:.3e}", errors[0], errors[1]).into())
    }
}

/// Orders of successive triples of steps.
pub fn orders(steps: &[f64], values: &[f64]) -> Vec<Result<f64, Reason>> {
    let triples = steps.windows(3).zip(values.windows(3));
    triples.map(|(h, f)| triple([h[0], h[1], h[2]], [f[0], f[1], f[2]])).collect()
}

fn triple(steps: [f64; 3], values: [f64; 3]) -> Result<f64, Reason> {
    let differences = [values[0] - values[1], values[1] - values[2]];
    let size = values.iter().fold(0.0, |size, x| f64::max(size, x.abs()));
    if differences.iter().any(|d| d.abs() <= ROUND_OFF * size) {
        return Err("the differences are round-off".into());
    }
    from_differences(steps, differences)
}

/// The value at step zero, if an order is established.
///
/// # Errors
/// Why no order is established.
pub fn extrapolated(steps: &[f64], values: &[f64]) -> Result<Extrapolation, Reason> {
    decreasing(steps)?;
    if values.len() < 4 || steps.len() != values.len() {
        return Err(format!("two estimates of an order need four values, not {}", values.len()).into());
    }
    let last = values.len() - 4;
    let [before, order] = &orders(&steps[last..], &values[last..])[..] else {
        return Err("four values are needed".into());
    };
    let before = before.clone()?;
    let order = order.clone()?;
    if (order - before).abs() > MARGIN {
        return Err(format!(
            "the last two estimates, {before:.2} and {order:.2}, differ by more than {MARGIN}"
        )
        .into());
    }
    if order <= 0.0 {
        return Err(
            format!("the differences grow as the step decreases: the estimated order is {order:.2}").into()
        );
    }
    let [.., h2, h3] = steps else { return Err("four values are needed".into()) };
    let [.., f2, f3] = values else { return Err("four values are needed".into()) };
    let value = f3 - (f2 - f3) / (order * (h2 / h3).ln()).exp_m1();
    Ok(Extrapolation { order, value, band: SAFE * (f3 - value).abs() })
}

fn decreasing(steps: &[f64]) -> Result<(), Reason> {
    if steps.windows(2).all(|h| h[0] > h[1]) && steps.iter().all(|h| *h > 0.0 && h.is_finite()) {
        Ok(())
    } else {
        Err(format!("the steps {steps:?} do not decrease").into())
    }
}
