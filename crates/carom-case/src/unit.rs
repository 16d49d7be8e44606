//! Numbers with a unit, which a case does not take: the number alone, in the case's own units.

use super::tree::{Node, Table};

/// Prefixes with their powers of ten.
const PREFIXES: [(&str, i32); 10] = [
    ("", 0),
    ("p", -12),
    ("n", -9),
    ("u", -6),
    ("µ", -6),
    ("m", -3),
    ("c", -2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
];

/// Name of each quantity, its unit without prefix, and its default label in `[units]`.
const QUANTITIES: [(&str, &str, &str); 3] = [("length", "m", "m"), ("time", "s", "s"), ("mass", "g", "kg")];

/// Unit labels of a case: of length, time and mass.
pub(super) struct Labels([String; 3]);

impl Default for Labels {
    fn default() -> Self {
        Self(QUANTITIES.map(|(.., label)| label.to_owned()))
    }
}

impl Labels {
    /// Labels that a case gives, and the defaults for the others.
    pub(super) fn of(case: &Table) -> Self {
        let units = case.get("units").and_then(Node::table);
        let label = |name: &str| units.and_then(|units| units.get(name)?.text()).map(str::to_owned);
        Self(QUANTITIES.map(|(name, _, default)| label(name).unwrap_or_else(|| default.to_owned())))
    }

    /// Advice if `text`, the value of `key`, is a number with a unit: what to write instead. `unit`
    /// is the dimension of the key, such as "time", if it is known.
    pub(super) fn advice(&self, key: &str, unit: Option<&str>, text: &str) -> Option<String> {
        let (number, suffix) = split(text)?;
        for (label, (name, base, _)) in self.0.iter().zip(QUANTITIES) {
            let power = match [power(suffix, base), power(label, base)] {
                _ if unit.is_some_and(|unit| unit != name) => None,
                _ if suffix == label => Some(0),
                [Some(given), Some(own)] => Some(given - own),
                _ => None,
            };
            if let Some(number) = power.and_then(|power| shifted(number, power)) {
                return Some(format!(
                    "write `{key} = {number}`: the number alone, in {label}, the unit of {name} of the case"
                ));
            }
        }
        let [length, time, mass] = &self.0;
        let of = match unit {
            Some("") => return Some(format!("write `{key} = {number}`: the number alone, it has no unit")),
            Some("degrees") => return Some("write the number alone, in degrees".to_owned()),
            Some(unit) => format!("{unit} of the case"),
            None => "the units of the case".to_owned(),
        };
        Some(format!(
            "write the number alone, in {of}, whose length is in {length}, time in {time}, mass in {mass}"
        ))
    }
}

/// Splits a text into a number and the unit after it, which begins with no digit; none if either is
/// missing.
fn split(text: &str) -> Option<(&str, &str)> {
    let is_number = |end: &usize| text.is_char_boundary(*end) && text[..*end].trim().parse::<f64>().is_ok();
    let starts = text.trim_start().starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    let end = (1..=text.len()).rev().filter(|_| starts).find(is_number)?;
    let number = text[..end].trim();
    let unit = text[end..].trim();
    (!unit.is_empty()).then_some((number, unit))
}

/// Power of ten of the prefix of `unit`, whose unit without prefix is `base`.
fn power(unit: &str, base: &str) -> Option<i32> {
    let prefix = unit.strip_suffix(base)?;
    PREFIXES.iter().find(|(name, _)| *name == prefix).map(|(_, power)| *power)
}

/// Text of a number multiplied by a power of ten.
fn shifted(number: &str, power: i32) -> Option<String> {
    if power == 0 {
        return Some(number.to_owned());
    }
    let (digits, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    let exponent = exponent.parse::<i32>().ok()? + power;
    let value: f64 = format!("{digits}e{exponent}").parse().ok()?;
    Some(if (1e-4..1e6).contains(&value.abs()) || value == 0.0 {
        format!("{value}")
    } else {
        format!("{value:e}")
    })
}

/// Key, value and place of the value in a line `key = 2e-4 s`, which is no TOML.
pub(super) fn bare(line: &str) -> Option<(&str, &str)> {
    let (key, rest) = line.split_once('=')?;
    let key = key.trim();
    let value = rest.split('#').next()?.trim();
    let is_key = !key.is_empty() && key.chars().all(|c| c.is_alphanumeric() || "_-.".contains(c));
    let is_unit = |(_, unit): (&str, &str)| {
        unit.starts_with(char::is_alphabetic) && !unit.contains(['"', '\'', '[', ']', '{', '}', ',', '='])
    };
    (is_key && split(value).is_some_and(is_unit)).then_some((key, value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_converted_to_the_units_of_the_case() {
        let labels = Labels(["mm", "s", "t"].map(str::to_owned));
        for (text, number) in [
            ("100 ms", "0.1"),
            ("2e-4 s", "2e-4"),
            ("2e-4s", "2e-4"),
            ("3 us", "3e-6"),
            ("-0.7 m", "-700"),
            ("7 µm", "0.007"),
            ("1.5e3 cm", "15000"),
        ] {
            let advice = labels.advice("key", None, text).unwrap();
            assert!(
                advice.starts_with(&format!("write `key = {number}`: the number alone, in ")),
                "{advice}"
            );
        }
        // Of tonnes no prefix is known, and a pressure is made of several units.
        for text in ["2 kg", "1 MPa", "20 °", "3 m/s"] {
            let advice = labels.advice("key", None, text).unwrap();
            let words = "write the number alone, in the units of the case, whose length is in mm, time in s, mass in t";
            assert_eq!(advice, words);
        }
        let advice = |unit, text| labels.advice("key", Some(unit), text).unwrap();
        assert!(advice("time", "100 ms").starts_with("write `key = 0.1`: the number alone, in s"));
        assert!(
            advice("mass/length³", "2 mm").starts_with("write the number alone, in mass/length³ of the case")
        );
        assert_eq!(advice("", "0.3 m"), "write `key = 0.3`: the number alone, it has no unit");
        for text in ["heavy", "2", "2e-4", "", "s 3", "nan s"] {
            assert_eq!(labels.advice("key", None, text), None, "{text}");
        }
    }

    #[test]
    fn values_without_quotes() {
        assert_eq!(bare("step = 2e-4 s   # short"), Some(("step", "2e-4 s")));
        for line in ["step = 2e-4", "title = two s", "# step", "at = [1 m, 2 m]", "on = 3.", "a = 1979-05-27"]
        {
            assert_eq!(bare(line), None, "{line}");
        }
    }
}
