//! Instants of a run in figures, tables and messages.

/// Decimals beyond which an instant is written with an exponent.
const MOST: i32 = 9;

/// A time with at least so many decimals, and with so many that the times a `step` before and after
/// it are written differently.
///
/// ```
/// use carom_formula::instant;
///
/// assert_eq!(instant(0.5, 1e-3, 4), "0.5000");
/// assert_eq!(instant(2.6e-4, 2e-5, 4), "0.00026");
/// assert_eq!(instant(1.25e-4, 2.5e-5, 4), "0.000125");
/// assert_eq!(instant(1.02e-6, 2e-8, 4), "0.00000102");
/// assert_eq!(instant(1.0002e-6, 2e-10, 4), "1.0002e-6");
/// ```
pub fn instant(time: f64, step: f64, least: usize) -> String {
    let decimals = decimals(step);
    if decimals > MOST && time != 0.0 {
        let digits = (decimals + time.abs().log10().floor() as i32).clamp(0, 16) as usize;
        return format!("{time:.digits$e}");
    }
    let decimals = least.max(decimals.clamp(0, MOST) as usize);
    format!("{time:.decimals$}")
}

/// Decimals of a multiple of a step, or one more than its first if it has more.
fn decimals(step: f64) -> i32 {
    if !(step.is_finite() && step > 0.0) {
        return 0;
    }
    let first = (-step.log10() - 1e-6).ceil() as i32;
    let multiple = step * 10f64.powi(first);
    first + i32::from((multiple - multiple.round()).abs() > 1e-3)
}
