//! Values of the case in `manifest.json`; missing values are empty.

use serde_json::Value;

use crate::scientific::given;

pub(super) fn list<'a>(value: &'a Value, key: &str) -> &'a [Value] {
    value.get(key).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

pub(super) fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value.get(key).and_then(Value::as_str).unwrap_or_default()
}

pub(super) fn vector(value: Option<&Value>) -> Vec<f64> {
    value.and_then(Value::as_array).map_or(Vec::new(), |v| v.iter().filter_map(Value::as_f64).collect())
}

/// A vector in parentheses; a single component without.
pub(super) fn tuple(v: &[f64]) -> String {
    let parts: Vec<String> = v.iter().map(|x| given(*x)).collect();
    if parts.len() == 1 { parts[0].clone() } else { format!("({})", parts.join(", ")) }
}
