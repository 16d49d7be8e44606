//! Measures of goals: the errors of all runs, and their uncertainty.

use super::compared::Compared;
use super::design::Goal;
use super::groups::Kind;
use super::reference::{IDEAL, Known, Reference, Standing};
use super::row::Row;

/// The measure of a ranking.
#[derive(Clone, Debug, PartialEq)]
pub struct Measure {
    /// Description of the measure in words.
    pub words: String,
    /// Uncertainty of the errors that comes from the reference.
    pub uncertainty: f64,
    /// Uncertainty of the noise, where the rough part of the reference converges.
    pub noise: Option<f64>,
    /// Quantities of the same kind that the reference does not establish, with the reasons.
    pub left_out: Vec<String>,
}

/// Error of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Errors {
    /// Error by which arms are ranked.
    pub(super) error: f64,
    /// Rough part of the error, of averaged quantities.
    pub(super) noise: Option<f64>,
}

/// A measure with the errors of all runs.
pub(super) struct Measured {
    pub(super) measure: Measure,
    pub(super) runs: Vec<Option<Errors>>,
}

/// Least uncertainty of an error in a metric: an energy that is conserved up to round-off is
/// conserved.
const ROUND_OFF: f64 = 1e-9;
/// Why there is no measure.
const NO_REFERENCE: &str = "the study has no reference";

/// The reference value of a metric.
pub fn standing(reference: Option<&Reference>, metric: &str) -> Standing {
    if IDEAL.contains(&metric) {
        return Standing::Established { value: 0.0, uncertainty: 0.0 };
    }
    reference.map_or_else(|| Standing::Not(NO_REFERENCE.to_owned()), |r| r.metric(metric))
}

/// |m − r|, relative if r is not 0.
pub fn error(value: f64, right: f64) -> f64 {
    if right == 0.0 { value.abs() } else { ((value - right) / right).abs() }
}

/// The data that measures are computed from.
pub(super) struct Judge<'a> {
    pub(super) rows: &'a [Row],
    pub(super) compared: &'a [Option<Compared>],
    pub(super) reference: Option<&'a Reference>,
}

/// Root mean square.
fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_u32), |(sum, count), x| (sum + x * x, count + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

impl Judge<'_> {
    /// The measure of a goal, or why there is none; `window`: number of the window of averages.
    pub(super) fn measured(&self, goal: Goal, window: usize) -> Result<Measured, String> {
        match goal {
            Goal::Energy => self.of_metrics(&["energy_error"]),
            Goal::Friction => self.of_metrics(&["friction_lost", "stick_share"]),
            Goal::Force => self.of_groups(Kind::Force, window),
            Goal::Stress => self.of_groups(Kind::Stress, window),
            Goal::Trajectory | Goal::Cost => self.of_groups(Kind::Motion, 0),
        }
    }

    /// The mean error of those metrics that the reference establishes.
    fn of_metrics(&self, names: &[&str]) -> Result<Measured, String> {
        let mut known = Vec::new();
        let mut left_out = Vec::new();
        for name in names {
            match standing(self.reference, name) {
                Standing::Established { value, uncertainty } => known.push((*name, value, uncertainty)),
                Standing::Not(why) => left_out.push(format!("{name} ({why})")),
            }
        }
        if known.is_empty() {
            return Err(left_out.join("; "));
        }
        let mean = |row: &Row| {
            let each = known.iter().map(|(name, right, _)| Some(error(row.value(name)?, *right)));
            let each: Vec<f64> = each.collect::<Option<_>>()?;
            Some(Errors { error: each.iter().sum::<f64>() / each.len() as f64, noise: None })
        };
        let relative =
            known.iter().map(|(_, right, off)| if *right == 0.0 { *off } else { (off / right).abs() });
        let words = known.iter().map(|(name, right, _)| {
            if *right == 0.0 { format!("{name}, which should be 0") } else { format!("error of {name}") }
        });
        let measure = Measure {
            words: words.collect::<Vec<_>>().join(" and "),
            uncertainty: relative.fold(ROUND_OFF, f64::max),
            noise: None,
            left_out,
        };
        Ok(Measured { measure, runs: self.rows.iter().map(mean).collect() })
    }

    /// The distance of groups of columns from the reference, relative to their scales.
    fn of_groups(&self, kind: Kind, window: usize) -> Result<Measured, String> {
        let reference = self.reference.ok_or(NO_REFERENCE)?;
        let all = reference.known.iter().enumerate().filter(|(_, known)| known.group.kind == kind);
        let mut used: Vec<(usize, &Known)> = Vec::new();
        let mut left_out = Vec::new();
        for (i, known) in all {
            match &known.uncertainty {
                Ok(_) => used.push((i, known)),
                Err(why) => left_out.push(format!("{} ({why})", known.group.name)),
            }
        }
        if used.is_empty() {
            let none = || "the reference has no column of this kind".to_owned();
            return Err(if left_out.is_empty() { none() } else { left_out.join("; ") });
        }
        let names: Vec<&str> = used.iter().map(|(_, known)| known.group.name.as_str()).collect();
        let averaged = match used[0].1.windows.get(window) {
            Some(w) if *w > 0.0 => format!(", averaged over {}", super::digits::short(*w)),
            _ => String::new(),
        };
        let of = |compared: &Option<Compared>| {
            let compared = compared.as_ref()?;
            let each = used.iter().map(|(i, _)| compared.groups.get(*i)?.as_ref()?.get(window).copied());
            let each: Vec<_> = each.collect::<Option<_>>()?;
            Some(Errors {
                error: rms(each.iter().map(|distance| distance.smooth)),
                noise: (kind != Kind::Motion).then(|| rms(each.iter().map(|distance| distance.rough))),
            })
        };
        let bounds = used.iter().filter_map(|(_, known)| known.uncertainty.as_ref().ok()?.get(window));
        let noise: Option<Vec<f64>> = used.iter().map(|(_, known)| known.noise).collect();
        let measure = Measure {
            words: format!("deviation of {} from the reference{averaged}", names.join(", ")),
            uncertainty: rms(bounds.copied()),
            noise: noise.filter(|_| kind != Kind::Motion).map(|noise| rms(noise.into_iter())),
            left_out,
        };
        Ok(Measured { measure, runs: self.compared.iter().map(of).collect() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_relative_unless_the_reference_is_zero() {
        assert_eq!((error(-0.5, 0.0), error(3.0, -2.0), error(2.0, 2.0)), (0.5, 2.5, 0.0));
    }
}
