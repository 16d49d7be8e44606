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
pub struct Labels(pub [String; 3]);

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
    pub fn advice(&self, key: &str, unit: Option<&str>, text: &str) -> Option<String> {
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
            Some("") if suffix == "%" => {
                let number = shifted(number, -2).unwrap_or_else(|| number.to_owned());
                return Some(format!("write `{key} = {number}`: a fraction, not percent"));
            }
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
pub fn bare(line: &str) -> Option<(&str, &str)> {
    let (key, rest) = line.split_once('=')?;
    let key = key.trim();
    let value = rest.split('#').next()?.trim();
    let is_key = !key.is_empty() && key.chars().all(|c| c.is_alphanumeric() || "_-.".contains(c));
    let is_unit = |(_, unit): (&str, &str)| {
        unit.starts_with(char::is_alphabetic) && !unit.contains(['"', '\'', '[', ']', '{', '}', ',', '='])
    };
    (is_key && split(value).is_some_and(is_unit)).then_some((key, value))
}
