//! Measures of goals: the errors of all runs, and their uncertainty.

use super::compared::Compared;
use super::design::Goal;
use super::groups::Kind;
use super::manifest::StudyManifest;
use super::reference::{Established, Known, Reference};
use super::row::Row;
use crate::{Reason, Status};

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
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Errors {
    /// Error by which arms are ranked.
    pub error: f64,
    /// The error as a vector whose length is `error`, up to the sampling of histories.
    pub vector: Vec<f64>,
    /// Rough part of the error, of averaged quantities.
    pub noise: Option<f64>,
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

impl Errors {
    /// Distance of two runs from each other; what sampling misses is bounded by their errors.
    pub fn distance(&self, other: &Self) -> f64 {
        let apart = product(&self.vector, &self.vector) + product(&other.vector, &other.vector)
            - 2.0 * product(&self.vector, &other.vector);
        let least = (self.error - other.error).abs();
        apart.max(0.0).sqrt().clamp(least, self.error + other.error)
    }

    /// Whether every solution within the uncertainty of the reference is nearer to this run than to
    /// another one.
    pub fn is_nearer(&self, other: &Self, uncertainty: f64) -> bool {
        // Errors themselves are known up to round-off only.
        let is_less = other.error - self.error > 2.0 * ROUND_OFF;
        let excess = other.error.powi(2) - self.error.powi(2);
        is_less && excess > 2.0 * uncertainty * self.distance(other)
    }
}

/// A measure with the errors of all runs.
pub(super) struct Measured<'a> {
    pub(super) manifest: &'a StudyManifest,
    pub(super) measure: Measure,
    pub(super) runs: Vec<Option<Errors>>,
}

impl Measured<'_> {
    /// The errors of the members of an arm.
    fn members(&self, arm: usize) -> impl Iterator<Item = &Errors> {
        self.manifest.runs_of(arm).into_iter().filter_map(|run| self.runs[run].as_ref())
    }

    /// Whether the first of two arms is distinguishably better.
    pub(super) fn is_better(&self, arm: usize, other: usize) -> bool {
        let beats = |far: &Errors| self.members(arm).all(|own| own.is_nearer(far, self.measure.uncertainty));
        self.members(other).any(beats)
    }

    /// The largest distance of a member of one arm from the closest member of the other.
    fn excess(&self, arm: usize, other: usize) -> f64 {
        let closest =
            |far: &Errors| self.members(arm).map(|own| own.distance(far)).fold(f64::INFINITY, f64::min);
        self.members(other).map(closest).fold(0.0, f64::max)
    }

    /// Whether the errors of two arms differ by at most a share of them, whatever the solution.
    pub(super) fn is_within(&self, share: f64, arm: usize, other: usize) -> bool {
        let error = self.members(arm).map(|own| own.error).fold(0.0, f64::max);
        let apart = self.excess(arm, other).max(self.excess(other, arm));
        apart <= share * (error - self.measure.uncertainty)
    }
}

/// Least uncertainty of an error in a metric: an energy that is conserved up to round-off is
/// conserved.
const ROUND_OFF: f64 = 1e-9;
/// Why there is no measure.
const NO_REFERENCE: &str = "the study has no reference";

/// Metrics whose exact value is zero in every case.
const IDEAL: [&str; 6] = [
    "energy_created",
    "energy_error",
    "dissipated_integrator",
    "dissipated_contact",
    "penetration",
    "penetration_mean",
];
/// Metrics whose exact value is zero where neither friction nor plastic flow dissipates energy.
const CONSERVED: [&str; 3] = ["energy_lost", "energy_drift", "energy_lost_impact"];
/// Metrics that runs with friction or plastic flow have.
const DISSIPATED: [&str; 2] = ["friction_lost", "plastic_lost"];

/// The reference value of a metric of a study with these runs.
///
/// # Errors
/// The reason why there is none.
pub fn standing(reference: Option<&Reference>, rows: &[Row], metric: &str) -> Result<Established, Reason> {
    let is_conserved = || rows.iter().all(|row| DISSIPATED.iter().all(|metric| row.value(metric).is_none()));
    if IDEAL.contains(&metric) || CONSERVED.contains(&metric) && is_conserved() {
        return Ok(Established::default());
    }
    reference.ok_or(NO_REFERENCE)?.metric(metric)
}

/// |m − r|, relative if r is not 0.
pub fn error(value: f64, right: f64) -> f64 {
    relative(value - right, right).abs()
}

/// A difference from r, relative to |r| if r is not 0.
fn relative(difference: f64, right: f64) -> f64 {
    if right == 0.0 { difference } else { difference / right.abs() }
}

/// The data of a study that rankings are made from.
pub struct Ranks<'a> {
    /// What is compared.
    pub manifest: &'a StudyManifest,
    /// The results of all runs.
    pub rows: &'a [Row],
    /// Their comparison with the reference.
    pub compared: &'a [Option<Compared>],
    /// The reference, if it has finished.
    pub reference: Option<&'a Reference>,
}

/// Root mean square.
fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_u32), |(sum, count), x| (sum + x * x, count + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

impl<'a> Ranks<'a> {
    /// The measure of a goal, or why there is none; `window`: number of the window of averages.
    pub(super) fn measured(&self, goal: Goal, window: usize) -> Result<Measured<'a>, Reason> {
        match goal {
            Goal::Energy => self.of_metrics(&["energy_error"]),
            Goal::Friction => self.of_metrics(&["friction_lost", "stick_share"]),
            Goal::Force => self.of_groups(Kind::Force, window),
            Goal::Stress => self.of_groups(Kind::Stress, window),
            Goal::Trajectory | Goal::Cost => self.of_groups(Kind::Motion, 0),
        }
    }

    /// Why there is no reference: the study has none, or a run of it has not finished.
    fn no_reference(&self) -> Reason {
        let Some(name) = &self.manifest.reference else { return NO_REFERENCE.into() };
        let arms = self.manifest.arms.iter().zip(self.rows);
        let mut runs = arms.filter(|(arm, _)| arm.role.fine || arm.name == *name);
        let stopped = runs.find_map(|(arm, row)| {
            let why = row.reason.as_ref().filter(|_| row.status == Some(Status::Failed))?;
            Some(format!("the run \"{}\" of the reference stopped ({why})", arm.name))
        });
        stopped.unwrap_or_else(|| "the reference has not finished".to_owned()).into()
    }

    /// The errors of those metrics that the reference establishes, root mean square.
    fn of_metrics(&self, names: &[&str]) -> Result<Measured<'a>, Reason> {
        let mut known = Vec::new();
        let mut left_out = Vec::new();
        for name in names {
            match standing(self.reference, self.rows, name) {
                Ok(Established { value, uncertainty }) => known.push((*name, value, uncertainty)),
                Err(why) => left_out.push(format!("{name} ({why})")),
            }
        }
        if known.is_empty() {
            return Err(left_out.join("; ").into());
        }
        let count = (known.len() as f64).sqrt();
        let of = |row: &Row| {
            let each =
                known.iter().map(|(name, right, _)| Some(relative(row.value(name)? - right, *right) / count));
            let vector: Vec<f64> = each.collect::<Option<_>>()?;
            let error = product(&vector, &vector).sqrt();
            error.is_finite().then_some(Errors { error, vector, noise: None })
        };
        let bounds = known.iter().map(|(_, right, off)| relative(*off, *right));
        let words = known.iter().map(|(name, right, _)| {
            if *right == 0.0 { format!("{name} (exactly 0)") } else { format!("error of {name}") }
        });
        let words = words.collect::<Vec<_>>().join(" and ");
        let measure = Measure {
            words: if known.len() > 1 { format!("root mean square of {words}") } else { words },
            uncertainty: bounds.fold(ROUND_OFF, f64::max),
            noise: None,
            left_out,
        };
        Ok(Measured { manifest: self.manifest, measure, runs: self.rows.iter().map(of).collect() })
    }

    /// The distance of groups of columns from the reference, relative to their scales.
    fn of_groups(&self, kind: Kind, window: usize) -> Result<Measured<'a>, Reason> {
        let reference = self.reference.ok_or_else(|| self.no_reference())?;
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
            let none = "the reference has no column of this kind";
            return Err(if left_out.is_empty() { none.into() } else { left_out.join("; ").into() });
        }
        let names: Vec<&str> = used.iter().map(|(_, known)| known.group.name.as_str()).collect();
        let averaged = match used[0].1.windows.get(window) {
            Some(w) if *w > 0.0 => format!(", averaged over {}", super::digits::short(*w)),
            _ => String::new(),
        };
        let of = |compared: &Option<Compared>| {
            let compared = compared.as_ref()?;
            let each = used.iter().map(|(i, _)| compared.groups.get(*i)?.as_ref()?.get(window));
            let each: Vec<_> = each.collect::<Option<_>>()?;
            let count = (each.len() as f64).sqrt();
            let sampled = each.iter().flat_map(|deviation| &deviation.errors);
            let error = rms(each.iter().map(|deviation| deviation.distance.smooth));
            error.is_finite().then(|| Errors {
                error,
                vector: sampled.map(|x| x / count).collect(),
                noise: (kind != Kind::Motion).then(|| rms(each.iter().map(|d| d.distance.rough))),
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
        Ok(Measured { manifest: self.manifest, measure, runs: self.compared.iter().map(of).collect() })
    }
}
