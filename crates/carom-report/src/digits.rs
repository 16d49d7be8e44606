//! Numbers on the page of a study: five digits, or three where a file has them in full precision.

use crate::scientific::{significant, without_zeros};

/// A number with five digits as a label, with a power of ten when far from one.
pub(crate) fn five(x: f64) -> String {
    if x != 0.0 && !(1e-4..1e6).contains(&x.abs()) {
        return significant(x, 4);
    }
    let text = if x.fract() == 0.0 {
        format!("{x}")
    } else {
        let decimals = (4 - x.abs().log10().floor() as i32).clamp(0, 8) as usize;
        without_zeros(&format!("{x:.decimals$}")).to_owned()
    };
    text.replace('-', "−")
}

/// A count, with all its digits; a mean of counts with three.
pub(crate) fn count(x: f64) -> String {
    if x.fract() == 0.0 && x.abs() < 1e15 { format!("{x}").replace('-', "−") } else { three(x) }
}

/// A number with three digits as a label.
pub(crate) fn three(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return five(x);
    }
    if !(1e-4..1e6).contains(&x.abs()) {
        return significant(x, 3);
    }
    let scale = 10f64.powi(2 - x.abs().log10().floor() as i32);
    five((x * scale).round() / scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Only zeros of a fraction are left out.
    #[test]
    fn large_numbers_keep_their_zeros() {
        let cases = [(19_500.411, "19500"), (120_000.4, "120000"), (-99_999.7, "−100000"), (2.5, "2.5")];
        for (x, text) in cases {
            assert_eq!(five(x), text);
        }
        assert_eq!(three(19_500.411), "19500");
    }

    #[test]
    fn counts_keep_all_digits() {
        let cases = [(1254.0, "1254"), (12_345_678.0, "12345678"), (0.0, "0"), (2505.5, "2510")];
        for (x, text) in cases {
            assert_eq!(count(x), text);
        }
    }
}
