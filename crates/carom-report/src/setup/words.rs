//! The model of a run in words, for a page without a drawing of it.

use std::fmt::Write as _;

use serde_json::Value;

use super::forces::written;
use crate::scientific::given;
use crate::values::{list, text, tuple, unit, vector};

/// What a case consists of, as labels: bodies with gravity and initial velocity, materials, probes.
pub(crate) fn in_words(case: &Value) -> Vec<(&'static str, Vec<String>)> {
    let [length, time, mass] = ["length", "time", "mass"].map(|of| unit(case, of));
    let stress = match (mass, length, time) {
        ("kg", "m", "s") => "Pa".to_owned(),
        ("g", "mm", "ms") => "MPa".to_owned(),
        _ => format!("{mass}/({length} {time}^2)"),
    };
    let body = |body: &Value| {
        let name = format!("{}: {}", text(body, "name"), text(body, "material"));
        [vec![name], gravity_and_velocity(body, length, time)].concat().join(", ")
    };
    let material = |m: &Value| {
        let mut words = format!("{}: {}", text(m, "name"), law_name(text(m, "law")));
        let density = format!("{mass}/{length}^3");
        for (key, symbol, unit) in
            [("density", "ρ", &density), ("lambda", "λ", &stress), ("mu", "G", &stress)]
        {
            if let Some(x) = m.get(key).and_then(Value::as_f64) {
                let _ = write!(words, ", {symbol} = {} {unit}", given(x));
            }
        }
        words
    };
    let probe = |probe: &Value| {
        let at = tuple(&vector(probe.get("at")));
        format!("{}: {} at {at} {length}", text(probe, "name"), text(probe, "body")).trim_end().to_owned()
    };
    let all = |key: &str, words: &dyn Fn(&Value) -> String| list(case, key).iter().map(words).collect();
    let rows: [(&'static str, Vec<String>); 3] = [
        ("Bodies", all("bodies", &body)),
        ("Materials", all("materials", &material)),
        ("Probes", all("probes", &probe)),
    ];
    rows.into_iter().filter(|(_, lines)| !lines.is_empty()).collect()
}

/// Gravity and initial velocity of a body, if it has them.
pub(super) fn gravity_and_velocity(body: &Value, length: &str, time: &str) -> Vec<String> {
    let kinds =
        [("gravity", "g", format!("{length}/{time}^2")), ("velocity", "v_{0}", format!("{length}/{time}"))];
    let words = |(key, symbol, unit): (&str, &str, String)| {
        let given = list(body, key);
        let v = vector(body.get(key));
        if key == "gravity" && v.len() < given.len() {
            // Formulas in t.
            let parts: Vec<String> = given.iter().map(written).collect();
            return Some(format!("{symbol} = ({}) {unit}", parts.join(", ")));
        }
        v.iter().any(|x| *x != 0.0).then(|| format!("{symbol} = {} {unit}", tuple(&v)))
    };
    kinds.into_iter().filter_map(words).collect()
}

/// `plane strain, thickness 1 m`, in bars `cross-section 1 m²`; none in space.
pub(super) fn plane_in_words(case: &Value, length: &str) -> Option<String> {
    let thickness = given(case.get("thickness").and_then(Value::as_f64)?);
    match case.get("dimension").and_then(Value::as_u64) {
        Some(1) => Some(format!("bar, cross-section {thickness} {length}^2")),
        Some(2) => Some(format!("plane {}, thickness {thickness} {length}", text(case, "plane"))),
        _ => None,
    }
}

/// The name of a material law.
pub(super) fn law_name(law: &str) -> &str {
    match law {
        "neo-hookean" => "neo-Hookean",
        "saint-venant-kirchhoff" => "Saint Venant–Kirchhoff",
        law => law,
    }
}

/// Elements and idealisation, which the arms of a study may change.
pub(crate) fn model_in_words(case: &Value) -> Vec<(&'static str, Vec<String>)> {
    let length = unit(case, "length");
    let element = |body: &Value| format!("{}: {}", text(body, "name"), text(body, "element"));
    let elements: Vec<String> = list(case, "bodies").iter().map(element).collect();
    let plane: Vec<String> = plane_in_words(case, length).into_iter().collect();
    [("Elements", elements), ("Model", plane)].into_iter().filter(|(_, lines)| !lines.is_empty()).collect()
}
