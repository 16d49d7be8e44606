//! Loads in the drawing of a case: arrows at sides and in bodies. Their directions are those at the
//! end of the run or, where the load is then zero, at the last of a few earlier times.

use carom_formula::Formula;
use serde_json::Value;

use super::drawing::Setup;
use super::values::{list, text, vector};
use crate::labels::number;
use crate::pen::Point;
use crate::symbols::{along, arrow, direction, plus};

pub(super) const COLOR: &str = "#7a2f8f";
/// Length of an arrow at a side, and its gap to the side.
const LENGTH: f64 = 20.0;
const GAP: f64 = 3.0;
const SPACING: f64 = 26.0;

/// A load of the manifest.
pub(super) struct Load<'a> {
    pub(super) kind: &'a str,
    pub(super) spec: &'a Value,
    components: Vec<&'a Value>,
}

pub(super) fn load(value: &Value) -> Option<Load<'_>> {
    let (kind, spec) = value.get("kind")?.as_object()?.iter().next()?;
    let given = spec.get("value")?;
    let components = given.as_array().map_or_else(|| vec![given], |list| list.iter().collect());
    Some(Load { kind, spec, components })
}

/// A number or a formula as written.
pub(super) fn written(value: &Value) -> String {
    value.as_str().map_or_else(|| value.as_f64().map_or(String::new(), number), str::to_owned)
}

impl Setup<'_> {
    /// The value of a formula at a reference position and a time.
    fn value(given: &Value, place: &[f64], time: f64) -> f64 {
        let names = [&["X", "Y", "Z"][..place.len()], &["t"]].concat();
        let values = [place, &[time]].concat();
        let formula = |text: &str| Formula::parse(text, &names).map_or(0.0, |f| f.value(&values));
        given.as_str().map_or_else(|| given.as_f64().unwrap_or(0.0), formula)
    }

    /// The components of a load at a pixel.
    fn values(&self, load: &Load, pixel: Point) -> Vec<f64> {
        let place = [(pixel[0] - self.origin[0]) / self.scale, (self.origin[1] - pixel[1]) / self.scale];
        self.values_at(load, &place[..if self.flat { 1 } else { 2 }])
    }

    /// The components of a load at a place, at the last time when they are not all zero.
    pub(super) fn values_at(&self, load: &Load, place: &[f64]) -> Vec<f64> {
        let end = self.case().pointer("/time/end").and_then(Value::as_f64).unwrap_or(0.0);
        let at = |share: f64| -> Vec<f64> {
            load.components.iter().map(|c| Self::value(c, place, share * end)).collect()
        };
        let times = [1.0, 0.75, 0.5, 0.25, 0.125, 0.03, 0.0];
        times.into_iter().map(at).find(|v| v.iter().any(|x| *x != 0.0 && x.is_finite())).unwrap_or_default()
    }

    /// Draws the arrows of all loads.
    pub(super) fn forces(&self, out: &mut String) {
        for load in list(self.case(), "loads").iter().filter_map(load) {
            if load.kind == "body-force" {
                let Some(center) = self.center(text(load.spec, "body")) else { continue };
                if let Some(d) = heading(&self.values(&load, center)) {
                    arrow(out, plus(center, -2.0 * LENGTH, d), center, COLOR);
                }
                continue;
            }
            for walk in
                list(load.spec, "on").iter().filter_map(Value::as_str).flat_map(|side| self.walks(side))
            {
                let spots = if self.flat {
                    vec![(plus(walk[0].0, 0.5, [0.0, walk[1].0[1] - walk[0].0[1]]), walk[0].1)]
                } else {
                    along(&walk, SPACING)
                };
                for (spot, n) in spots {
                    let values = self.values(&load, spot);
                    let towards = match (load.kind, values.first()) {
                        ("pressure", Some(p)) if *p != 0.0 => n.map(|c| -c * p.signum()),
                        ("pressure", _) => continue,
                        _ => match heading(&values) {
                            Some(d) => d,
                            None => continue,
                        },
                    };
                    // A compressive load ends at the side, a tensile load begins there.
                    let presses = towards[0] * n[0] + towards[1] * n[1] < 0.0;
                    let [from, to] = if presses { [-GAP - LENGTH, -GAP] } else { [GAP, GAP + LENGTH] };
                    arrow(out, plus(spot, from, towards), plus(spot, to, towards), COLOR);
                }
            }
        }
    }

    /// Lines of the key: loads and where they act.
    pub(super) fn forces_in_words(&self) -> Vec<String> {
        let words = |value: &Value| {
            let load = load(value)?;
            let parts: Vec<String> = load.components.iter().map(|c| written(c)).collect();
            let amount = if parts.len() == 1 { parts[0].clone() } else { format!("({})", parts.join(", ")) };
            let sides: Vec<&str> = list(load.spec, "on").iter().filter_map(Value::as_str).collect();
            let place = if sides.is_empty() { text(load.spec, "body").to_owned() } else { sides.join(", ") };
            let unit = self.load_unit(load.kind);
            let amount = format!("{amount} {unit}").trim_end().to_owned();
            let table = value.pointer("/table/file").and_then(Value::as_str);
            let table = table.map_or_else(String::new, |file| format!(" × {file}"));
            Some(format!("{place}: {} {amount}{table}", load.kind.replace('-', " ")))
        };
        list(self.case(), "loads").iter().filter_map(words).collect()
    }

    /// The unit of the values of a load.
    fn load_unit(&self, kind: &str) -> String {
        let unit = |key: &str| text(self.case().get("units").unwrap_or(&Value::Null), key);
        match (kind, unit("length"), unit("time"), unit("mass")) {
            ("body-force", "m", "s", "kg") => "N/m^3".to_owned(),
            ("body-force", length, time, mass) => format!("{mass}/({length}^2 {time}^2)"),
            _ => self.fields.array("stress").map_or_else(String::new, |array| array.unit.clone()),
        }
    }

    /// The conditions of a support: `u_{x} = u_{y} = 0`.
    pub(super) fn support_in_words(support: &Value) -> String {
        let axis = |i: f64| ["u_{x}", "u_{y}", "u_{z}"][(i as usize).min(2)];
        let across = Self::is_held_across(support);
        let axes = vector(support.get("fix")).into_iter().map(axis);
        let fixed: Vec<&str> = axes.chain(across.then_some("u_{n}")).collect();
        let fixed = (!fixed.is_empty()).then(|| fixed.join(" = ") + " = 0");
        let moved = list(support, "move").iter().filter_map(|m| {
            let [axis_number, formula] = m.as_array()?.as_slice() else { return None };
            Some(format!("{} = {}", axis(axis_number.as_f64()?), written(formula)))
        });
        fixed.into_iter().chain(moved).collect::<Vec<_>>().join(", ")
    }

    /// Whether a support fixes the direction across its sides.
    pub(super) fn is_held_across(support: &Value) -> bool {
        support.get("normal").and_then(Value::as_bool) == Some(true)
    }

    /// Directions constrained or moved by a support, by their axes.
    pub(super) fn directions(support: &Value) -> Vec<f64> {
        let moved = list(support, "move").iter().filter_map(|m| m.get(0).and_then(Value::as_f64));
        vector(support.get("fix")).into_iter().chain(moved).collect()
    }
}

/// Direction of a vector on the page, where y points down.
fn heading(vector: &[f64]) -> Option<Point> {
    let d = direction([0.0; 2], [vector.first().copied()?, -vector.get(1).copied().unwrap_or(0.0)]);
    (d != [0.0; 2]).then_some(d)
}
