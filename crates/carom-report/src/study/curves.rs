//! Curves of several arms: their labels, which are too rough to be drawn over each other, and when
//! there is contact.

use carom_record::study::Study;

use crate::axis::range;
use crate::plot::Curve;

/// A curve whose total variation is this many times its range is rough.
const ROUGH: f64 = 12.0;
/// A contact that takes more than this share of the time needs no enlargement.
const LONG: f64 = 0.5;

/// Whether a curve goes up and down so often that it hides others.
pub(super) fn is_rough(curve: &Curve) -> bool {
    let (low, high) = range(&curve.y);
    let variation: f64 = curve.y.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|d| d.is_finite()).sum();
    high > low && variation > ROUGH * (high - low)
}

/// The keys in the names of arms.
pub(super) struct Keys<'a> {
    all: Vec<&'a str>,
    /// The unit of time, empty where arms have several.
    time: &'a str,
}

/// The key and the value of a part of a name.
fn setting(part: &str) -> Option<(&str, &str)> {
    part.split_once('=').filter(|(key, _)| !key.contains(' '))
}

impl<'a> Keys<'a> {
    /// The keys of arms with these names and a unit of time.
    pub(super) fn of(names: impl Iterator<Item = &'a str>, time: &'a str) -> Self {
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
    pub(super) fn label(&self, name: &str) -> String {
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
pub(super) fn contact(study: &Study, end: f64) -> Option<(f64, f64)> {
    let of = |name: &str| -> Vec<f64> {
        study.rows.iter().filter(|row| !row.is_unsound()).filter_map(|row| row.value(name)).collect()
    };
    let first = range(&of("contact_start")).0;
    let last = range(&of("contact_end")).1;
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
