//! Numbers as labels: significant digits, with powers of ten as superscripts.

use std::fmt::Write as _;

/// Most significant digits of a number in text.
const MOST: usize = 5;

/// A number with a number of significant digits, as a label: `17.85`, `4.762×10^{−4}`.
pub(crate) fn significant(x: f64, digits: usize) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    if !x.is_finite() {
        return "–".to_owned();
    }
    let last = digits.saturating_sub(1);
    let rounded = format!("{x:.last$e}");
    let Some((mantissa, order)) = rounded.split_once('e') else { return rounded };
    let order: i32 = order.parse().unwrap_or(0);
    let decimals = (last as i32 - order).max(0) as usize;
    let is_near = (-3..6).contains(&order);
    let text = if is_near { format!("{x:.decimals$}") } else { format!("{mantissa}×10^{{{order}}}") };
    text.replace('-', "−")
}

/// Typesets a number without zeros at the end of its decimals, for values that were given.
pub(crate) fn given(x: f64) -> String {
    let text = significant(x, 4);
    let (number, power) = text.split_once('×').unwrap_or((&text, ""));
    match (without_zeros(number), power) {
        (number, "") => number.to_owned(),
        ("1", power) => power.to_owned(),
        (number, power) => format!("{number}×{power}"),
    }
}

/// Without zeros at the end of a fraction; those of 19500 stay.
pub(crate) fn without_zeros(number: &str) -> &str {
    if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { number }
}

/// Text with its numbers like `1.2e-5` as labels: `1.2×10^{−5}`, and `10^{−5}` for `1e-5`.
pub(crate) fn powers(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find('e') {
        let front = &rest[..at];
        let after = &rest[at + 1..];
        let mantissa = front.len() - front.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.').len();
        let sign = if after.starts_with(['-', '−']) { "−" } else { "" };
        let digits = after.trim_start_matches(['-', '−', '+']);
        let count = digits.len() - digits.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let (before, mantissa) = front.split_at(front.len() - mantissa);
        // Not in words, such as `case1e3`.
        let is_word = |c: char| c.is_alphanumeric() || c == '_';
        let is_number = mantissa.starts_with(|c: char| c.is_ascii_digit())
            && !(if before.is_empty() { &out } else { before }).ends_with(is_word)
            && count > 0
            && !digits[count..].starts_with(is_word);
        if !is_number {
            out.push_str(&rest[..=at]);
            rest = after;
            continue;
        }
        out.push_str(before);
        let order = digits[..count].trim_start_matches('0');
        let order = if order.is_empty() { "0" } else { order };
        let value: f64 = format!("{mantissa}e{}{order}", sign.replace('−', "-")).parse().unwrap_or(f64::NAN);
        // Messages of events have up to ten digits.
        let digits_given = mantissa.chars().filter(char::is_ascii_digit).count();
        if digits_given > MOST || (order != "0" && (0.01..1000.0).contains(&value)) {
            out += &significant(value, digits_given.min(MOST));
        } else if order == "0" {
            out.push_str(mantissa);
        } else {
            let factor = if mantissa == "1" { String::new() } else { format!("{mantissa}×") };
            let _ = write!(out, "{factor}10^{{{sign}{order}}}");
        }
        rest = &digits[count..];
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_significant() {
        let cases = [(17.8512, "17.85"), (0.9, "0.9000"), (4.76169e-4, "4.762×10^{−4}"), (-99.996, "−100.0")];
        for (x, text) in cases {
            assert_eq!(significant(x, 4), text);
        }
        assert_eq!([0.0, f64::NAN].map(|x| significant(x, 3)), ["0", "–"]);
    }

    #[test]
    fn given_values_have_no_padding() {
        let cases = [(2.5e-7, "2.5×10^{−7}"), (1e8, "10^{8}"), (200.0, "200"), (-78.7402, "−78.74")];
        for (x, text) in cases {
            assert_eq!(given(x), text);
        }
    }

    #[test]
    fn exponents_in_text_are_powers() {
        assert_eq!(powers("last 1.21e-5 L (allowed: 1.0e-9)"), "last 1.21×10^{−5} L (allowed: 1.0×10^{−9})");
        assert_eq!(powers("at t = 3.192743194e-1 by 7.714270e-6"), "at t = 0.31927 by 7.7143×10^{−6}");
        assert_eq!(powers("residual 9.97e-1, 2.5e2 m"), "residual 0.997, 250 m");
        assert_eq!(powers("1e−10 %, case1e3, 0.9e0 e"), "10^{−10} %, case1e3, 0.9 e");
    }
}
