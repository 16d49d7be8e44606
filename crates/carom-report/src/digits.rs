//! Numbers on the page of a study: in five digits, and in three where a table beside it has them
//! all.

/// A number in five digits, an exponent when far from one.
pub(crate) fn five(x: f64) -> String {
    let text = if x != 0.0 && !(1e-4..1e6).contains(&x.abs()) {
        format!("{x:.3e}")
    } else if x.fract() == 0.0 {
        format!("{x}")
    } else {
        let decimals = (4 - x.abs().log10().floor() as i32).clamp(0, 8) as usize;
        format!("{x:.decimals$}").trim_end_matches('0').trim_end_matches('.').to_owned()
    };
    text.replace('-', "−")
}

/// A number in three digits: the tables have them all.
pub(crate) fn three(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return five(x);
    }
    if !(1e-4..1e6).contains(&x.abs()) {
        return format!("{x:.2e}").replace('-', "−");
    }
    let scale = 10f64.powi(2 - x.abs().log10().floor() as i32);
    five((x * scale).round() / scale)
}
