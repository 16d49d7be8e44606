//! Loads in the drawing of a case: arrows at sides and in bodies. Their directions are those at the
//! end of the run or, where the load is then zero, at the last of a few earlier times.

use std::fmt::Write as _;

use carom_formula::Formula;
use serde_json::Value;

use super::drawing::Setup;
use crate::pen::Point;
use crate::scientific::given;
use crate::symbols::{along, arrow, direction, distance, plus};
use crate::values::{list, text, texts, unit, vector};

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

/// A number, or a formula typeset.
pub(super) fn written(value: &Value) -> String {
    value.as_str().map_or_else(|| value.as_f64().map_or(String::new(), given), typeset)
}

/// Whether t is a word of a formula.
fn depends_on_time(formula: &str) -> bool {
    formula.split(|c: char| !(c.is_alphanumeric() || c == '_')).any(|word| word == "t")
}

/// A formula with minus signs, π, and dots of multiplication where they are needed.
pub(crate) fn typeset(formula: &str) -> String {
    without_dots(&signs(formula))
}

/// `40·t·t` as `40 t^2`, `2·π·t` as `2 π t`: a space that breaks no line stands for the dot after
/// a number that is no divisor or exponent.
fn without_dots(formula: &str) -> String {
    let is_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.');
    let mut out = String::with_capacity(formula.len());
    let mut rest = formula;
    while let Some(c) = rest.chars().next() {
        let before = out.chars().last().unwrap_or(' ');
        let can_start = !is_word(before) && !matches!(before, '/' | '^' | '{');
        let word = &rest[..rest.find(|c| !is_word(c)).unwrap_or(rest.len())];
        if word.is_empty() {
            out.push(c);
            rest = &rest[c.len_utf8()..];
            continue;
        }
        rest = &rest[word.len()..];
        out.push_str(word);
        let is_number = word == "π" || word.starts_with(|c: char| c.is_ascii_digit());
        if !can_start {
            continue;
        }
        let equal = |tail: &'_ str| -> Option<usize> {
            let after = tail.strip_prefix('·')?.strip_prefix(word)?;
            let ends = !after.starts_with(|c| is_word(c) || matches!(c, '^' | '('));
            ends.then_some(tail.len() - after.len())
        };
        let mut power = 1;
        while let Some(length) = equal(rest).filter(|_| !is_number) {
            (power, rest) = (power + 1, &rest[length..]);
        }
        if power > 1 {
            let _ = write!(out, "^{power}");
        }
        // `2 if(t < 1, …)` would be read as a condition.
        let after = rest.strip_prefix('·').filter(|after| is_number && !after.starts_with("if("));
        if let Some(after) = after.filter(|after| after.starts_with(|c: char| c.is_alphabetic() || c == '('))
        {
            out.push('\u{202f}');
            rest = after;
        }
    }
    out
}

/// A formula with minus signs, dots of multiplication and π.
fn signs(formula: &str) -> String {
    let mut out = String::with_capacity(formula.len());
    let mut word = String::new();
    let end = |word: &mut String, out: &mut String| {
        // Numbers have no more digits than elsewhere in the key.
        let number = word.parse().ok().filter(|_| word.starts_with(|c: char| c.is_ascii_digit()));
        match (word.as_str(), number) {
            ("pi", _) => out.push('π'),
            (_, Some(number)) => out.push_str(&given(number)),
            (word, None) => out.push_str(word),
        }
        word.clear();
    };
    for c in formula.chars() {
        if c.is_alphanumeric() || matches!(c, '.' | '_') {
            word.push(c);
            continue;
        }
        end(&mut word, &mut out);
        match c {
            '-' => out.push('−'),
            '*' => out.push('·'),
            c => out.push(c),
        }
    }
    end(&mut word, &mut out);
    out
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
        self.last_values(&load.components, place)
    }

    /// The gravity of a body, at the last time when it is not zero.
    pub(super) fn gravity(&self, body: &Value) -> Vec<f64> {
        self.last_values(&list(body, "gravity").iter().collect::<Vec<_>>(), &[])
    }

    fn last_values(&self, components: &[&Value], place: &[f64]) -> Vec<f64> {
        let end = self.case().pointer("/time/end").and_then(Value::as_f64).unwrap_or(0.0);
        let at = |share: f64| -> Vec<f64> {
            components.iter().map(|c| Self::value(c, place, share * end)).collect()
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
            for walk in texts(load.spec, "on").flat_map(|side| self.walks(side)) {
                let mut spots = along(&walk, SPACING);
                if self.flat {
                    spots = vec![(plus(walk[0].0, 0.5, [0.0, walk[1].0[1] - walk[0].0[1]]), walk[0].1)];
                } else if let [(a, _), (b, _)] = spots[..]
                    && distance(a, b) < 0.5 * SPACING
                {
                    // One arrow at a short side: heads of several would cover each other.
                    spots = vec![along(&walk, 0.5 * distance(a, b))[1]];
                }
                for (spot, n) in spots {
                    let values = self.values(&load, spot);
                    let towards = match (load.kind, values.first()) {
                        ("pressure", Some(p)) => (*p != 0.0).then(|| n.map(|c| -c * p.signum())),
                        _ => heading(&values),
                    };
                    let Some(towards) = towards else { continue };
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
            let sides: Vec<&str> = texts(load.spec, "on").collect();
            let place = if sides.is_empty() { text(load.spec, "body").to_owned() } else { sides.join(", ") };
            let unit = self.load_unit(load.kind);
            let is_formula = load.components.iter().any(|c| c.as_str().is_some_and(depends_on_time));
            let time = if is_formula { self.with_time() } else { String::new() };
            let amount = format!("{amount} {unit}{time}").trim_end().to_owned();
            let table = value.pointer("/table/file").and_then(Value::as_str);
            let table = table.map_or_else(String::new, |file| format!(" × {file}"));
            Some(format!("{place}: {} {amount}{table}", load.kind.replace('-', " ")))
        };
        list(self.case(), "loads").iter().filter_map(words).collect()
    }

    /// What t is in a formula: a time or, in a static analysis, a parameter without a unit.
    pub(super) fn with_time(&self) -> String {
        if self.run.is_static() {
            return ", with the load parameter t".to_owned();
        }
        format!(", with t in {}", unit(self.case(), "time"))
    }

    /// The unit of the values of a load.
    fn load_unit(&self, kind: &str) -> String {
        let unit = |key: &str| unit(self.case(), key);
        match (kind, unit("length"), unit("time"), unit("mass")) {
            ("body-force", "m", "s", "kg") => "N/m^3".to_owned(),
            ("body-force", length, time, mass) => format!("{mass}/({length}^2 {time}^2)"),
            _ => self.fields.unit("stress").to_owned(),
        }
    }

    /// The conditions of a support: `u_{x} = u_{y} = 0`.
    pub(super) fn support_in_words(&self, support: &Value) -> String {
        let axis = |i: f64| ["u_{x}", "u_{y}", "u_{z}"][(i as usize).min(2)];
        let across = Self::is_held_across(support);
        let axes = vector(support.get("fix")).into_iter().map(axis);
        let fixed: Vec<&str> = axes.chain(across.then_some("u_{n}")).collect();
        let fixed = (!fixed.is_empty()).then(|| fixed.join(" = ") + " = 0");
        let moved = list(support, "move").iter().filter_map(|m| {
            let [axis_number, formula] = m.as_array()?.as_slice() else { return None };
            let length = unit(self.case(), "length");
            let words = format!("{} = {} {length}", axis(axis_number.as_f64()?), written(formula));
            let is_formula = formula.as_str().is_some_and(depends_on_time);
            Some(if is_formula { words + &self.with_time() } else { words })
        });
        fixed.into_iter().chain(moved).collect::<Vec<_>>().join(", ")
    }

    /// Whether a support fixes the direction across its sides.
    pub(super) fn is_held_across(support: &Value) -> bool {
        support.get("normal").and_then(Value::as_bool) == Some(true)
    }

    /// The direction that a support with one condition constrains.
    pub(super) fn constrained(support: &Value) -> Point {
        if Self::directions(support).first() == Some(&0.0) { [1.0, 0.0] } else { [0.0, 1.0] }
    }

    /// Whether a support with one condition leaves its side free along the normal.
    pub(super) fn is_guided(support: &Value, walk: &[(Point, Point)]) -> bool {
        let axis = Self::constrained(support);
        let is_along = |(_, n): &(Point, Point)| (n[0] * axis[0] + n[1] * axis[1]).abs() > 0.7;
        !Self::is_held_across(support) && !walk.iter().all(is_along)
    }

    /// The axis along which a support moves its sides, as a direction.
    pub(super) fn moved_axis(support: &Value) -> Option<Point> {
        let axis = list(support, "move").first()?.get(0)?.as_f64()?;
        Some(if axis == 0.0 { [1.0, 0.0] } else { [0.0, 1.0] })
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dots_are_left_out_where_nothing_changes() {
        for (formula, text) in [
            ("-40*t*t", "−40\u{202f}t^2"),
            ("0.08443*(1 - cos(2*pi*t))", "0.08443\u{202f}(1 − cos(2\u{202f}π\u{202f}t))"),
            ("X + Z*t", "X + Z·t"),
            ("X/2*t", "X/2·t"),
            ("X^2*t", "X^2·t"),
            ("X/t*t", "X/t·t"),
            ("t*t^2", "t·t^2"),
            ("t*t*t", "t^3"),
            ("2*if(t < 1, t, 1)", "2·if(t < 1, t, 1)"),
        ] {
            assert_eq!(typeset(formula), text);
        }
    }
}
