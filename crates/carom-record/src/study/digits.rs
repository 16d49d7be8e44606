//! Numbers in messages.

/// A number with three significant digits.
pub(super) fn short(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e4).contains(&x.abs()) {
        return format!("{x:.2e}");
    }
    let scale = 10f64.powi(2 - x.abs().log10().floor() as i32);
    format!("{}", (x * scale).round() / scale)
}
