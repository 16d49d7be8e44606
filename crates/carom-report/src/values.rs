//! Values of the case in `manifest.json`; missing values are empty.

use serde_json::Value;

use crate::scientific::given;

pub(crate) fn list<'a>(value: &'a Value, key: &str) -> &'a [Value] {
    value.get(key).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

pub(crate) fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value.get(key).and_then(Value::as_str).unwrap_or_default()
}

/// The texts of a list.
pub(crate) fn texts<'a>(value: &'a Value, key: &str) -> impl Iterator<Item = &'a str> {
    list(value, key).iter().filter_map(Value::as_str)
}

pub(crate) fn vector(value: Option<&Value>) -> Vec<f64> {
    value.and_then(Value::as_array).map_or(Vec::new(), |v| v.iter().filter_map(Value::as_f64).collect())
}

/// A point or vector with this number of components.
pub(crate) fn place<const D: usize>(value: Option<&Value>) -> Option<[f64; D]> {
    vector(value).try_into().ok()
}

/// The first two components of a point or vector; those that are missing are zero.
pub(crate) fn flat(value: Option<&Value>) -> [f64; 2] {
    let v = vector(value);
    [0, 1].map(|i| v.get(i).copied().unwrap_or(0.0))
}

/// A vector in parentheses; a single component without.
pub(crate) fn tuple(v: &[f64]) -> String {
    let parts: Vec<String> = v.iter().map(|x| given(*x)).collect();
    if parts.len() == 1 { parts[0].clone() } else { format!("({})", parts.join(", ")) }
}

/// The unit of length, time or mass of a case.
pub(crate) fn unit<'a>(case: &'a Value, of: &str) -> &'a str {
    text(case.get("units").unwrap_or(&Value::Null), of)
}

/// Whether the bodies of a case are in space.
pub(crate) fn is_in_space(case: &Value) -> bool {
    case.get("dimension").and_then(Value::as_u64) == Some(3)
}
