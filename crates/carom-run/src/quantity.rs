//! Numbers with their units, for messages.

/// Significant digits.
const DIGITS: i32 = 4;

/// A number to four digits, with its unit: `12.35 mm`.
pub fn quantity(x: f64, unit: &str) -> String {
    with_unit(rounded(x, f64::round), unit)
}

/// A number with its unit, rounded up, for what is needed at least.
pub fn at_least(x: f64, unit: &str) -> String {
    with_unit(rounded(x, f64::ceil), unit)
}

/// A number with its unit, rounded down, for what is allowed at most.
pub fn at_most(x: f64, unit: &str) -> String {
    with_unit(rounded(x, f64::floor), unit)
}

fn with_unit(x: f64, unit: &str) -> String {
    let is_plain = x == 0.0 || (1e-3..1e6).contains(&x.abs());
    let number = if is_plain { format!("{x}") } else { format!("{x:e}") };
    format!("{number} {unit}").trim_end().to_owned()
}

/// A positive number to four digits by a rule of rounding; ten times that are round-off.
fn rounded(x: f64, rule: impl Fn(f64) -> f64) -> f64 {
    if x == 0.0 || !x.is_finite() {
        return x;
    }
    let exponent = x.abs().log10().floor() as i32 - DIGITS + 1;
    // Read from text: a product with a power of ten would have digits of its own.
    let scaled: f64 = format!("{:.9}", x / 10f64.powi(exponent)).parse().unwrap_or(x);
    format!("{}e{exponent}", rule(scaled)).parse().unwrap_or(x)
}
