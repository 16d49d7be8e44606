//! The model of a run in words, for a page without a drawing of it.

use std::fmt::Write as _;

use serde_json::Value;

use super::key::{law_name, plane_in_words};
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
        let mut words = format!("{}: {}", text(body, "name"), text(body, "material"));
        for (key, symbol, unit) in [
            ("gravity", "g", format!("{length}/{time}^2")),
            ("velocity", "v_{0}", format!("{length}/{time}")),
        ] {
            let v = vector(body.get(key));
            if v.iter().any(|x| *x != 0.0) {
                let _ = write!(words, ", {symbol} = {} {unit}", tuple(&v));
            }
        }
        words
    };
    let material = |m: &Value| {
        let mut words = format!("{}: {}", text(m, "name"), law_name(text(m, "law")));
        for (key, symbol, unit) in [
            ("density", "ρ", format!("{mass}/{length}^3")),
            ("lambda", "λ", stress.clone()),
            ("mu", "G", stress.clone()),
        ] {
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

/// Elements and idealisation, which the arms of a study may change.
pub(crate) fn model_in_words(case: &Value) -> Vec<(&'static str, Vec<String>)> {
    let length = unit(case, "length");
    let element = |body: &Value| format!("{}: {}", text(body, "name"), text(body, "element"));
    let elements: Vec<String> = list(case, "bodies").iter().map(element).collect();
    let plane: Vec<String> = plane_in_words(case, length).into_iter().collect();
    [("Elements", elements), ("Model", plane)].into_iter().filter(|(_, lines)| !lines.is_empty()).collect()
}
