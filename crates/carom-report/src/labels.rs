//! Labels of columns and numbers in figures and tables.

use std::borrow::Borrow;

use carom_formula::instant;

use crate::recorded::Recorded;
use crate::scientific::{given, significant, without_zeros};

/// Symbol of a probe quantity: `σ_{yy}`.
pub(crate) fn symbol(quantity: &str) -> String {
    match quantity {
        "ux" | "uy" | "uz" | "vx" | "vy" | "vz" | "ax" | "ay" | "az" => {
            format!("{}_{{{}}}", &quantity[..1], &quantity[1..])
        }
        "von_mises" => "σ_{vM}".into(),
        "det_f" => "det F".into(),
        _ => match quantity.strip_prefix("sigma_") {
            Some(component) => format!("σ_{{{component}}}"),
            None => quantity.replace('_', " "),
        },
    }
}

/// Whether a probe quantity is a stress.
pub(crate) fn is_stress(quantity: &str) -> bool {
    quantity == "von_mises" || quantity.starts_with("sigma_")
}

/// Description of a probe quantity.
pub(crate) fn words(quantity: &str) -> String {
    match quantity {
        "ux" | "uy" | "uz" => "displacement".into(),
        "vx" | "vy" | "vz" => "velocity".into(),
        "ax" | "ay" | "az" => "acceleration".into(),
        "von_mises" => "von Mises stress".into(),
        "det_f" => "volume ratio".into(),
        _ if quantity.starts_with("sigma_") => "Cauchy stress".into(),
        _ => quantity.replace('_', " "),
    }
}

/// A label followed by its unit, if it has one.
pub(crate) fn with_unit(label: &str, unit: &str) -> String {
    if unit.is_empty() || unit == "1" { label.to_string() } else { format!("{label} ({unit})") }
}

/// The name of the axis of time, which in a static analysis is a parameter of the load.
pub(crate) fn time_name(run: &Recorded) -> &'static str {
    if run.is_static() { "load parameter t" } else { "time t" }
}

/// The label of the axis of time.
pub(crate) fn time_label(run: &Recorded) -> String {
    with_unit(time_name(run), run.time_unit())
}

/// `t = 0.315 s`, `t = 1.8 µs`, with the digits that tell the rows of a run apart.
pub(crate) fn instant_label(run: &Recorded, time: f64) -> String {
    let apart = run.times().windows(2).map(|pair| pair[1] - pair[0]);
    let step = apart.filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min);
    // Six digits, or more where rows are closer.
    let digits =
        |time: f64, step: f64| if step < 1e-5 * time.abs() { instant(time, step, 4) } else { number(time) };
    let unit = run.time_unit();
    let exponent = thousands(time);
    match prefixed(unit, exponent).filter(|_| time.abs() < 1e-3) {
        Some(unit) => {
            let scale = 10f64.powi(exponent);
            format!("t = {} {unit}", digits(time / scale, step / scale))
        }
        None => format!("t = {} {unit}", digits(time, step)).trim_end().to_owned(),
    }
}

/// The power of a thousand below a number; 0 of zero.
fn thousands(x: f64) -> i32 {
    if x == 0.0 || !x.is_finite() { 0 } else { 3 * (x.abs().log10() / 3.0 + 1e-12).floor() as i32 }
}

/// A unit times a power of ten: with another prefix where it has one, otherwise with the power.
pub(crate) fn scaled(unit: &str, exponent: i32) -> String {
    match (exponent, unit) {
        (0, unit) => unit.to_string(),
        (_, "" | "1") => format!("10^{{{exponent}}}"),
        _ => prefixed(unit, exponent).unwrap_or_else(|| format!("10^{{{exponent}}} {unit}")),
    }
}

/// A number with its unit, whose prefix is chosen so that the number is from 1 to 1000 where there
/// is such a prefix: 525 µN.
pub(crate) fn amount(x: f64, unit: &str) -> String {
    in_thousands(x, unit, |x| significant(x, 3))
}

/// A value that was given, with a prefix where it is far from one.
pub(crate) fn given_amount(x: f64, unit: &str) -> String {
    if (1e-3..1e6).contains(&x.abs()) {
        format!("{} {unit}", given(x)).trim_end().to_owned()
    } else {
        in_thousands(x, unit, given)
    }
}

/// A number in a format, divided by a power of a thousand for which its unit has a prefix.
fn in_thousands(x: f64, unit: &str, format: impl Fn(f64) -> String) -> String {
    let exponent = thousands(x);
    match prefixed(unit, exponent) {
        Some(unit) => format!("{} {unit}", format(x / 10f64.powi(exponent))),
        None => format!("{} {unit}", format(x)).trim_end().to_owned(),
    }
}

/// The unit with the prefix that stands for its own times 10^exponent: 10^{-6} MPa is Pa.
fn prefixed(unit: &str, exponent: i32) -> Option<String> {
    const PREFIXES: [(&str, i32); 9] =
        [("p", -12), ("n", -9), ("µ", -6), ("m", -3), ("", 0), ("k", 3), ("M", 6), ("G", 9), ("T", 12)];
    let (first, rest) = unit.split_at(unit.find([' ', '/']).unwrap_or(unit.len()));
    let base = ["Pa", "N", "J", "m", "s"].into_iter().find(|base| first.ends_with(base))?;
    let own = PREFIXES.iter().find(|(prefix, _)| *prefix == &first[..first.len() - base.len()])?.1;
    let (prefix, _) = PREFIXES.iter().find(|(_, power)| *power == own + exponent)?;
    // Nobody writes kilometres and megaseconds for a body that is struck.
    (!(matches!(base, "m" | "s") && own + exponent > 0)).then(|| format!("{prefix}{base}{rest}"))
}

/// Splits a label into text and the unit in brackets at its end.
pub(crate) fn unit_of(label: &str) -> (&str, &str) {
    label.strip_suffix(')').and_then(|l| l.rsplit_once(" (")).unwrap_or((label, ""))
}

/// A sentence or caption with a capital letter at its start.
pub(crate) fn capitalised(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().into_iter().flat_map(char::to_uppercase).chain(chars).collect()
}

/// `a`, `a and b`, `a, b and c`.
pub(crate) fn listed(items: &[impl Borrow<str>]) -> String {
    match items {
        [] => String::new(),
        [one] => one.borrow().to_owned(),
        [front @ .., last] => format!("{} and {}", front.join(", "), last.borrow()),
    }
}

/// A name with only those characters that are safe in a file name.
pub(crate) fn file_name(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || "._-".contains(c) { c } else { '-' }).collect()
}

/// A number with six digits, with an exponent when far from one.
pub(crate) fn number(x: f64) -> String {
    // Without the sign of a negative zero.
    let x = x + 0.0;
    if x != 0.0 && !(1e-4..1e6).contains(&x.abs()) {
        return format!("{x:.5e}").replace('-', "−");
    }
    let decimals = if x == 0.0 { 0 } else { (5 - x.abs().log10().floor() as i32).clamp(0, 9) as usize };
    without_zeros(&format!("{x:.decimals$}")).replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::{amount, given_amount, number, scaled};

    #[test]
    fn amounts_have_the_prefix_of_their_size() {
        let cases = [(5.24548e-4, "N", "525 µN"), (0.0, "N", "0 N"), (2.5e-3, "kg", "0.00250 kg")];
        for (x, unit, text) in cases {
            assert_eq!(amount(x, unit), text);
        }
        assert_eq!(amount(-31.25e6, "kPa"), "−31.2 GPa");
        let values = [(4.395e-5, "MPa"), (200.0, "Pa"), (2.1e11, "Pa"), (1e8, "lb/(in s^2)")];
        let texts = ["43.95 Pa", "200 Pa", "210 GPa", "10^{8} lb/(in s^2)"];
        assert_eq!(values.map(|(x, unit)| given_amount(x, unit)), texts);
    }

    /// 10^-6 MPa = 1 Pa, 10^3 N = 1 kN, 10^-3 m/s = 1 mm/s.
    #[test]
    fn powers_of_ten_are_prefixes() {
        for (unit, exponent, text) in [
            ("MPa", -6, "Pa"),
            ("N", 3, "kN"),
            ("N s", -3, "mN s"),
            ("m/s", -3, "mm/s"),
            ("mm", 3, "m"),
            ("m", 3, "10^{3} m"),
            ("", -3, "10^{-3}"),
            ("kg/m^3", 3, "10^{3} kg/m^3"),
        ] {
            assert_eq!(scaled(unit, exponent), text);
        }
    }

    #[test]
    fn numbers() {
        let cases = [
            (0.0, "0"),
            (-0.0, "0"),
            (-0.7827, "−0.7827"),
            (400.0, "400"),
            (1.0 / 3.0, "0.333333"),
            (123456.7, "123457"),
            (1.5e-7, "1.50000e−7"),
            (2e6, "2.00000e6"),
        ];
        for (x, text) in cases {
            assert_eq!(number(x), text);
        }
    }
}
