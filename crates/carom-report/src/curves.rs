//! Curves of several arms: which are the same, which are too rough to be drawn over each other, and
//! when there is contact.

use carom_record::study::Study;

use crate::axis::range;
use crate::labels::listed;
use crate::plot::Curve;
use crate::text::width;

/// Curves that differ by less than this share of the range, half a pixel of a small pane, are drawn
/// once.
const SAME: f64 = 3e-3;
/// A curve whose total variation is this many times its range is rough.
const ROUGH: f64 = 12.0;
/// A contact that takes more than this share of the time needs no enlargement.
const LONG: f64 = 0.5;

/// Whether curves over the same time differ by no more than `SAME` at the points of either.
fn is_same(a: &Curve, b: &Curve) -> bool {
    let (low, high) = range(a.y.iter().chain(&b.y));
    let ends = |curve: &Curve| Some((*curve.x.first()?, *curve.x.last()?));
    let (Some(one), Some(other)) = (ends(a), ends(b)) else { return false };
    let most = SAME * (high - low);
    let near = |from: &Curve, to: &Curve| {
        from.x.iter().zip(&from.y).all(|(x, y)| y.is_nan() || (y - between(to, *x)).abs() <= most)
    };
    (one.0 - other.0).abs() + (one.1 - other.1).abs() <= SAME * (one.1 - one.0) && near(a, b) && near(b, a)
}

/// The value of a curve between its points.
fn between(curve: &Curve, x: f64) -> f64 {
    let i = curve.x.partition_point(|at| *at < x).min(curve.x.len() - 1);
    if i == 0 || curve.x[i] <= x {
        return curve.y[i];
    }
    let share = (x - curve.x[i - 1]) / (curve.x[i] - curve.x[i - 1]);
    curve.y[i - 1] + share * (curve.y[i] - curve.y[i - 1])
}

/// The first of every set of curves that are the same, with the labels of the others.
pub(crate) fn merged(curves: Vec<Curve>) -> Vec<(Curve, Vec<String>)> {
    let mut found: Vec<(Curve, Vec<String>)> = Vec::new();
    for curve in curves {
        let known = found.iter_mut().find(|(known, _)| known.apart == curve.apart && is_same(known, &curve));
        match known {
            Some((known, others)) => {
                known.chosen |= curve.chosen;
                known.quiet &= curve.quiet;
                others.push(curve.label);
            }
            None => found.push((curve, Vec::new())),
        }
    }
    found
}

/// Labels of at most this width, in units of the font size, name both of two curves.
const WIDE: f64 = 21.0;

/// A curve with those that it is drawn for in its label.
pub(crate) fn with(curve: Curve, others: &[String]) -> Curve {
    let first = &curve.label;
    let label = match others {
        [] => return curve,
        [other] if width(first) + width(other) < WIDE => format!("{first} and {other}"),
        [_] => format!("{first} and 1 other"),
        others => format!("{first} and {} others", others.len()),
    };
    Curve { label, ..curve }
}

/// What is said about curves that are drawn once: `Curves that differ by less than 0.3 % of the
/// range are drawn once: “a”, “b” and “c”; …`; nothing where there are none.
pub(crate) fn drawn_once<'a>(found: impl Iterator<Item = (&'a String, &'a Vec<String>)>) -> String {
    let sets = found.filter(|(_, others)| !others.is_empty());
    let quoted = |name: &String| format!("“{name}”");
    let together = |(first, others): (&String, &Vec<String>)| {
        listed(&std::iter::once(first).chain(others).map(quoted).collect::<Vec<_>>())
    };
    let sets: Vec<String> = sets.map(together).collect();
    if sets.is_empty() {
        return String::new();
    }
    format!(" Curves that differ by less than 0.3 % of the range are drawn once: {}.", sets.join("; "))
}

/// Whether a curve goes up and down so often that it hides others.
pub(crate) fn is_rough(curve: &Curve) -> bool {
    let (low, high) = range(&curve.y);
    let variation: f64 = curve.y.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|d| d.is_finite()).sum();
    high > low && variation > ROUGH * (high - low)
}

/// The keys in the names of arms.
pub(crate) struct Keys<'a> {
    all: Vec<&'a str>,
    /// The unit of time, empty where arms have several.
    time: &'a str,
}

/// The key and the value of a part of a name.
fn setting(part: &str) -> Option<(&str, &str)> {
    part.split_once('=').filter(|(key, _)| !key.contains(' '))
}

impl<'a> Keys<'a> {
    /// Of arms with these names and a unit of time.
    pub(crate) fn of(names: impl Iterator<Item = &'a str>, time: &'a str) -> Self {
        let mut keys: Vec<&str> =
            names.flat_map(|name| name.split(", ")).filter_map(setting).map(|s| s.0).collect();
        keys.sort_unstable();
        keys.dedup();
        Self { all: keys, time }
    }

    /// The last part of a key, with as many parts before it as distinguish it from the other keys.
    fn short<'b>(&self, key: &'b str) -> &'b str {
        let mut ends = key.rmatch_indices('.').map(|(at, _)| &key[at + 1..]);
        let is_another = |other: &str, end: &str| {
            let rest = other.strip_suffix(end).filter(|_| other != key);
            rest.is_some_and(|rest| rest.is_empty() || rest.ends_with('.'))
        };
        ends.find(|end| !self.all.iter().any(|other| is_another(other, end))).unwrap_or(key)
    }

    /// The name of an arm as a label: without the tables of its keys, and without a word that says
    /// that a scheme is one.
    pub(crate) fn label(&self, name: &str) -> String {
        let part = |part: &str| match setting(part) {
            Some(("time.scheme", value)) => value.to_owned(),
            Some((key, value)) => match self.short(key) {
                "mu" => format!("μ = {value}"),
                "step" if key == "time.step" => format!("Δt = {value} {}", self.time).trim_end().to_owned(),
                short => format!("{short} = {value}"),
            },
            _ => part.to_owned(),
        };
        name.split(", ").map(part).collect::<Vec<_>>().join(", ")
    }
}

/// The first contact of all sound arms with a quarter of its duration on either side, unless it
/// takes most of the time.
pub(crate) fn contact(study: &Study, end: f64) -> Option<(f64, f64)> {
    let of = |name: &str| -> Vec<f64> {
        study.rows.iter().filter(|row| !row.is_unsound()).filter_map(|row| row.value(name)).collect()
    };
    let (first, last) = (range(&of("contact_start")).0, range(&of("contact_end")).1);
    let room = 0.25 * (last - first);
    let span = ((first - room).max(0.0), (last + room).min(end));
    (span.0.is_finite() && span.1 > span.0 && span.1 - span.0 < LONG * end).then_some(span)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(label: &str, y: &[f64]) -> Curve {
        let x = (0..y.len()).map(|i| i as f64).collect();
        Curve { label: label.into(), x, y: y.to_vec(), ..Curve::default() }
    }

    #[test]
    fn curves_within_half_a_pixel_are_one() {
        let all = vec![
            curve("a", &[0.0, 1.0, 2.0]),
            curve("b", &[0.0, 1.0, 2.005]),
            curve("c", &[0.0, 1.0, 2.01]),
            curve("d", &[0.0, 1.0]),
        ];
        let found: Vec<(String, Vec<String>)> =
            merged(all).into_iter().map(|(curve, others)| (curve.label, others)).collect();
        assert_eq!(found.len(), 3);
        assert_eq!(found[0].1, ["b"]);
        // The same line at other points.
        let line = |n: usize| {
            let x: Vec<f64> = (0..=n).map(|i| i as f64 / n as f64).collect();
            Curve { y: x.clone(), x, ..Curve::default() }
        };
        assert_eq!(merged(vec![line(3), line(7)]).len(), 1);
        assert!(
            drawn_once(found.iter().map(|(name, others)| (name, others)))
                .contains("drawn once: “a” and “b”.")
        );
    }

    #[test]
    fn labels_have_no_tables() {
        let label = |name| Keys::of([name].into_iter(), "").label(name);
        assert_eq!(label("time.scheme=hu, time.step=0.001875"), "hu, Δt = 0.001875");
        let timed = Keys::of(["time.step=0.1"].into_iter(), "s");
        assert_eq!(timed.label("time.step=0.1"), "Δt = 0.1 s");
        assert_eq!(label("Bathe, ρ∞ = 0.5"), "Bathe, ρ∞ = 0.5");
        assert_eq!(label("contact.a.mu=0.2"), "μ = 0.2");
    }

    #[test]
    fn labels_of_different_keys_differ() {
        let names = ["body.a.young=1", "body.b.young=1, time.step=1e-3", "material.a.young=1", "young=1"];
        let keys = Keys::of(names.into_iter(), "");
        let labels: Vec<String> = names.iter().map(|name| keys.label(name)).collect();
        let wanted = ["body.a.young = 1", "b.young = 1, Δt = 1e-3", "material.a.young = 1", "young = 1"];
        assert_eq!(labels, wanted);
    }

    /// A wave of 30 periods has a variation of 60 ranges, a ramp of one.
    #[test]
    fn waves_are_rough() {
        let wave: Vec<f64> =
            (0..3000).map(|i| (f64::from(i) * std::f64::consts::TAU / 100.0).sin()).collect();
        assert!(is_rough(&curve("", &wave)));
        assert!(!is_rough(&curve("", &wave[..400])));
        assert!(!is_rough(&curve("", &[0.0, 1.0, 2.0])));
    }
}
