//! Numbers and durations for people.

/// A number with five digits, in the shorter of the two notations.
pub(crate) fn short(x: f64) -> String {
    if x == 0.0 || (1e-3..1e6).contains(&x.abs()) {
        let digits = (4 - x.abs().max(1e-3).log10().floor() as i32).clamp(0, 7) as usize;
        let text = format!("{x:.digits$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    } else {
        format!("{x:.4e}")
    }
}

/// A number, or a dash.
pub(crate) fn short_or_dash(x: Option<f64>) -> String {
    x.map_or_else(|| "–".to_owned(), short)
}

/// A number with its unit, if it has one.
pub(crate) fn quantity(x: f64, unit: &str) -> String {
    format!("{} {unit}", short(x)).trim_end().to_owned()
}

/// A number that misses an expected value, with all its digits where few do not show the miss.
pub(crate) fn missed(got: f64, expected: Option<f64>) -> String {
    let text = short(got);
    let lost = (text.parse().unwrap_or(got) - got).abs();
    if expected.is_some_and(|value| lost > 0.1 * (got - value).abs()) { format!("{got:?}") } else { text }
}

/// `1 cell`, `2 cells`.
pub(crate) fn several(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// A duration for people: `2 min 10 s`.
pub(crate) fn duration(seconds: f64) -> String {
    if !seconds.is_finite() {
        return "?".to_owned();
    }
    let whole = seconds.max(0.0).round() as u64;
    match whole {
        0..10 => format!("{seconds:.1} s"),
        10..120 => format!("{whole} s"),
        120..7200 => format!("{} min {} s", whole / 60, whole % 60),
        _ => format!("{} h {} min", whole / 3600, whole % 3600 / 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let numbers = [1.0, -0.097, 123456.7, 1.875e-3, 1e-5, 25.30801, 2e9];
        let expected = ["1", "-0.097", "123457", "0.001875", "1.0000e-5", "25.308", "2.0000e9"];
        assert_eq!(numbers.map(short), expected);
    }

    #[test]
    fn a_miss_shows_in_the_digits() {
        assert_eq!(missed(5.000000000023, Some(5.0)), "5.000000000023");
        assert_eq!(missed(0.1 + 0.2, Some(0.4)), "0.3");
        assert_eq!(missed(25.308012, None), "25.308");
    }

    #[test]
    fn durations_have_two_units() {
        assert_eq!([0.26, 61.0, 7300.0, f64::NAN].map(duration), ["0.3 s", "61 s", "2 h 1 min", "?"]);
    }
}
