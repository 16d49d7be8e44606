//! The reference that the arms of a study are compared with, and its uncertainty.
//!
//! ```text
//! computed    runs at decreasing steps on finer meshes; each level is run with every member of the study's
//!             ensemble. Value: the median of the members at the finest level. Uncertainty: that of the
//!             refinement (convergence.rs) of a member, the median over the members, at least the distance to a
//!             second scheme and the change of the last halving of the step on the same mesh; plus the largest
//!             distance of a member from the median, plus the step of the level before for each event, plus 5/4 of
//!             what averaging over a short time changes, for extremes (metrics/averaged.rs)
//! an arm      the same with the arms that differ from it only in step and refinement
//! exact       the formulas of [exact], and the metrics that can be computed from these columns; uncertainty 0
//! ideal       the values for elastic bodies: no change or dissipation of energy, no penetration
//! ```
//!
//! The medians of levels whose members scatter may converge with an order that no member has.
//!
//! Nothing is established on one mesh. A value is established if its uncertainty is less than half
//! of it; a column, or a group of columns with one scale (groups.rs), in the same way with the norm
//! of the difference between levels in the place of differences. Averaged forces and stresses are
//! uncertain by at least their distance from the next coarser mesh: two schemes on one mesh have
//! the error of that mesh in common. Only established values are used for rankings.

use std::collections::BTreeMap;

use carom_formula::Formula;

use super::convergence::converged;
use super::digits::short;
use super::ensemble::Spread;
use super::groups::{Group, Kind, groups};
use super::trajectory::forces;
pub use super::trajectory::{FORCE, Trajectory};
use crate::Reason;
use crate::metrics::{self, Distance, Metric};
use crate::order::SAFE;
use crate::{Column, History};

/// Largest uncertainty of an established value, relative to the value; of a column, relative to its
/// range.
const RESOLVED: f64 = 0.5;

/// Metrics whose exact value is zero in every case.
pub const IDEAL: [&str; 9] = [
    "energy_lost",
    "energy_created",
    "energy_drift",
    "energy_error",
    "energy_lost_impact",
    "dissipated_integrator",
    "dissipated_contact",
    "penetration",
    "penetration_mean",
];

/// Metrics that are instants or differences of instants, and of how many events that a record
/// resolves to one step.
const INSTANTS: [(&str, f64); 5] = [
    ("contact_start", 1.0),
    ("contact_end", 1.0),
    ("contact_duration", 2.0),
    ("turning_time", 1.0),
    ("apex_time", 1.0),
];

/// A reference value, or why there is none.
#[derive(Clone, Debug, PartialEq)]
pub enum Standing {
    /// The reference establishes a value.
    Established {
        /// The value.
        value: f64,
        /// Uncertainty of the value, in the same unit.
        uncertainty: f64,
    },
    /// The reference establishes no value, for this reason.
    Not(String),
}

impl Standing {
    /// Value and uncertainty.
    pub fn established(&self) -> Option<(f64, f64)> {
        match self {
            Self::Established { value, uncertainty } => Some((*value, *uncertainty)),
            Self::Not(_) => None,
        }
    }
}

/// A value from refinement, with what its uncertainty consists of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Median of the members at the finest level.
    pub value: f64,
    /// Half-width of the interval that should contain the limit in 95 of 100 cases.
    pub uncertainty: f64,
    /// Observed order of convergence, where it is monotone.
    pub order: Option<f64>,
    /// Largest distance of a member from the median, at the finest level.
    pub spread: f64,
}

/// The runs of one level of refinement.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// Time step; cells shrink with it where the mesh is refined too.
    pub step: f64,
    /// Factor of mesh refinement.
    pub mesh: f64,
    /// Number of different phases of the members.
    pub phases: usize,
    /// Members of the level's ensemble, the run as given first.
    pub members: Vec<Trajectory>,
}

impl Level {
    /// A single run whose mesh is refined with its step.
    pub fn single(step: f64, run: Trajectory) -> Self {
        Self { step, mesh: 1.0 / step, phases: 1, members: vec![run] }
    }

    /// Range of all phases relative to that of the members: n phases, 1/n of a step apart, cover
    /// (n − 1)/n of the range of a quantity that changes evenly with the phase.
    fn between_phases(&self) -> f64 {
        if self.phases > 1 { self.phases as f64 / (self.phases - 1) as f64 } else { 1.0 }
    }
}

/// Columns with one scale, of which the reference is known up to an uncertainty.
#[derive(Clone, Debug, PartialEq)]
pub struct Known {
    /// The columns.
    pub group: Group,
    /// Scale of the errors.
    pub scale: f64,
    /// Windows of the averages: w, w/2 and 2w for forces and stresses, none for motion.
    pub windows: Vec<f64>,
    /// Uncertainty of the average over each window, or why there is none.
    pub uncertainty: Result<Vec<f64>, Reason>,
    /// Uncertainty of the rough part, where that converges.
    pub noise: Option<f64>,
}

/// Why nothing is known from one mesh.
const ONE_MESH: &str = "its mesh was not refined";
/// Ratio of successive distances below which a rough part converges.
const CONVERGES: f64 = 0.9;

/// Distances of the runs of a reference.
struct Apart {
    /// Distances between successive levels.
    levels: Vec<Distance>,
    /// Largest distances of a member from the first, at the finest level.
    members: Distance,
    /// Largest distances of another scheme and of a longer step.
    checks: Distance,
}

impl Apart {
    /// Values whose differences are the distances between the levels.
    fn cumulated(&self) -> Vec<f64> {
        let mut values = vec![0.0];
        for level in self.levels.iter().rev() {
            values.push(values[values.len() - 1] + level.smooth);
        }
        values.reverse();
        values
    }
}

/// Uncertainties, if the first one, that of the window itself, is small enough to be used.
fn is_resolved(bounds: Vec<f64>) -> Result<Vec<f64>, Reason> {
    match bounds.first() {
        Some(bound) if *bound > RESOLVED => {
            Err(format!("its uncertainty, {} of its norm, is more than half of it", short(*bound)).into())
        }
        _ => Ok(bounds),
    }
}

/// Reference that arms are compared with: runs at several levels of refinement, or exact formulas.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Description in words.
    pub what: String,
    /// Levels of refinement, the finest last; for exact formulas, one level sampled from them.
    levels: Vec<Level>,
    /// Metrics of the finest run after averaging over a short time.
    averaged: Vec<Metric>,
    /// Runs of another scheme and of twice the step on the finest mesh.
    checks: Vec<Trajectory>,
    /// Groups of columns in which arms are compared.
    pub known: Vec<Known>,
    /// Uncertainties by column, which take the whole record to compute.
    uncertainties: BTreeMap<String, Standing>,
    exact: bool,
}

impl Reference {
    /// Creates a reference from levels of decreasing steps, the finest last.
    pub fn of_levels(what: String, levels: Vec<Level>) -> Self {
        let mut reference = Self {
            what,
            levels,
            averaged: Vec::new(),
            checks: Vec::new(),
            known: Vec::new(),
            uncertainties: BTreeMap::new(),
            exact: false,
        };
        let columns = reference.columns().into_iter();
        reference.uncertainties = columns.map(|c| (c.to_owned(), reference.of_column(c))).collect();
        reference
    }

    /// Sets the description, and the metrics of the finest run after averaging over a short time.
    pub(super) fn described(self, what: String, averaged: Vec<Metric>) -> Self {
        Self { what, averaged, ..self }
    }

    /// Sets the runs of another scheme and of twice the step on the finest mesh.
    pub(super) fn checked(self, checks: Vec<Trajectory>) -> Self {
        Self { checks, ..self }
    }

    /// Determines the groups of columns in which arms are compared; `bodies`: those of the probes;
    /// `window`: the time to average over.
    pub(super) fn grouped(mut self, bodies: &BTreeMap<String, String>, window: &Result<f64, Reason>) -> Self {
        let Some(finest) = self.finest() else { return self };
        let of = |group: Group| self.of_group(group, finest, window);
        self.known = groups(finest, bodies).into_iter().filter_map(of).collect();
        self
    }

    fn of_group(&self, group: Group, finest: &Trajectory, window: &Result<f64, Reason>) -> Option<Known> {
        let scale = group.scale(finest)?;
        let windows = match (group.kind, window) {
            (Kind::Motion, _) => vec![0.0],
            (_, Ok(window)) => vec![*window, window / 2.0, 2.0 * window],
            (_, Err(why)) => {
                let uncertainty = Err(why.clone());
                return Some(Known { group, scale, windows: Vec::new(), uncertainty, noise: None });
            }
        };
        if self.exact {
            let uncertainty = Ok(vec![0.0; windows.len()]);
            return Some(Known { group, scale, windows, uncertainty, noise: Some(0.0) });
        }
        let found: Option<Vec<_>> =
            windows.iter().map(|w| self.apart(&group, finest, *w).map(|apart| (apart, *w))).collect();
        let bound = |(apart, _): &(Apart, f64)| {
            let last = apart.levels.last()?.smooth;
            let refined = converged(&self.sizes(), &apart.cumulated())?.uncertainty;
            let least = if group.kind == Kind::Motion { 0.0 } else { last };
            Some((apart.checks.smooth.max(refined).max(least) + apart.members.smooth) / scale)
        };
        let uncertainty = match &found {
            _ if !self.refines_mesh() => Err(ONE_MESH.into()),
            Some(found) => {
                let bounds = found.iter().map(bound).collect::<Option<Vec<f64>>>();
                bounds.ok_or_else(|| "a single run gives no error estimate".into()).and_then(is_resolved)
            }
            None => Err("a run of the reference lacks it".into()),
        };
        let rough = |(apart, _): &(Apart, f64)| {
            let [.., before, last] = &apart.levels[..] else { return None };
            let off = last.rough.max(apart.checks.rough) + apart.members.rough;
            (last.rough < CONVERGES * before.rough).then_some(off / scale)
        };
        let noise = found.as_ref().and_then(|found| rough(found.first()?));
        Some(Known { group, scale, windows, uncertainty, noise })
    }

    /// Distances of the runs of the reference in a group of columns; none if a run lacks it.
    fn apart(&self, group: &Group, finest: &Trajectory, window: f64) -> Option<Apart> {
        let between = |a: &Trajectory, b: &Trajectory| group.signal(a)?.distance(&group.signal(b)?, window);
        let levels = self.levels.windows(2);
        let levels = levels.map(|pair| between(pair[0].members.first()?, pair[1].members.first()?));
        let farthest = |runs: &[Trajectory]| {
            runs.iter().try_fold(Distance::default(), |most, run| {
                let next = between(run, finest)?;
                Some(Distance { smooth: most.smooth.max(next.smooth), rough: most.rough.max(next.rough) })
            })
        };
        let levels = levels.collect::<Option<Vec<Distance>>>()?;
        let members = farthest(self.levels.last()?.members.get(1..)?)?;
        Some(Apart { levels, members, checks: farthest(&self.checks)? })
    }

    /// Levels of refinement, the finest last.
    pub(super) fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// Whether the uncertainty includes that of the mesh: the reference is exact, or its mesh was
    /// refined.
    pub fn refines_mesh(&self) -> bool {
        self.exact || self.levels.windows(2).any(|pair| pair[1].mesh > pair[0].mesh)
    }

    fn sizes(&self) -> Vec<f64> {
        self.levels.iter().map(|level| level.step).collect()
    }

    /// The first member of the finest level.
    pub(super) fn finest(&self) -> Option<&Trajectory> {
        self.levels.last()?.members.first()
    }

    /// Creates an exact reference from formulas in t by column, sampled at `rows` + 1 times from 0
    /// to `end`; none if a formula cannot be read.
    pub fn of_formulas(formulas: &BTreeMap<String, String>, end: f64, rows: usize) -> Option<Self> {
        let times: Vec<f64> = (0..=rows).map(|i| end * i as f64 / rows as f64).collect();
        let mut columns = BTreeMap::new();
        for (name, text) in formulas {
            let formula = Formula::parse(text, &["t"]).ok()?;
            columns.insert(name.clone(), times.iter().map(|t| formula.value(&[*t])).collect::<Vec<_>>());
        }
        let names = std::iter::once("time").chain(columns.keys().map(String::as_str));
        let described = names.map(|name| Column {
            name: name.into(),
            unit: String::new(),
            description: String::new(),
            integer: false,
        });
        let values = std::iter::once(times.clone()).chain(columns.values().cloned());
        let history = History::new(described.collect(), values.collect());
        let mut known = metrics::all(&history);
        for column in columns.keys() {
            known.extend(metrics::of_columns(&history, column));
        }
        if history.column("contact_force_x").is_some() {
            columns.insert(FORCE.to_owned(), metrics::contact_force(&history));
        }
        let sampled = Trajectory { times, columns, forces: forces(&history), metrics: known };
        let what = "the exact formulas of [exact]".to_owned();
        let levels = vec![Level::single(1.0, sampled)];
        Some(Self { uncertainties: BTreeMap::new(), exact: true, ..Self::of_levels(what, levels) })
    }

    /// Value of a metric with its uncertainty.
    ///
    /// # Errors
    /// The reason why the reference has no such value.
    pub fn estimate(&self, name: &str) -> Result<Estimate, Reason> {
        if self.exact {
            let value = self.finest().and_then(|run| run.value(name));
            let value = value.ok_or("[exact] has no columns to compute it from")?;
            return Ok(Estimate { value, uncertainty: 0.0, order: None, spread: 0.0 });
        }
        let of = |level: &Level| Spread::of(level.members.iter().filter_map(|run| run.value(name)));
        let levels: Option<Vec<Spread>> = self.levels.iter().map(of).collect();
        let levels = levels.ok_or("a run of the reference has no value")?;
        let medians: Vec<f64> = levels.iter().map(Spread::median).collect();
        let found = converged(&self.sizes(), &medians).ok_or("a single run gives no error estimate")?;
        let refined = self.refined_members(name).map_or(found.uncertainty, |of_members| of_members.median());
        let single = self.levels.last().and_then(|level| level.members.first()?.value(name));
        let checks = self.checks.iter().filter_map(|run| Some((run.value(name)? - single?).abs()));
        let refined = checks.fold(refined, f64::max);
        let (value, spread) = levels.last().map_or((0.0, 0.0), |s| (s.median(), s.half_width()));
        // An event is late by up to a step at each level: the difference of two levels is known up
        // to the longer one of their steps.
        let before = self.levels.len().saturating_sub(2);
        let late = self.levels.get(before).map_or(0.0, |level| level.step);
        let events = INSTANTS.iter().find(|(instant, _)| *instant == name).map_or(0.0, |(_, events)| *events);
        let instant = events * late;
        let averaged =
            self.averaged.iter().find(|metric| metric.name == name).and_then(|metric| metric.value);
        let smoothed = single.zip(averaged).map_or(0.0, |(one, other)| SAFE * (one - other).abs());
        let between = self.levels.last().map_or(1.0, Level::between_phases);
        let uncertainty = refined + between * spread + instant + smoothed;
        Ok(Estimate { value, uncertainty, order: found.order, spread })
    }

    /// Uncertainties of the refinement of each member alone; none where a member has no value at a
    /// level.
    fn refined_members(&self, name: &str) -> Option<Spread> {
        let sizes = self.sizes();
        let members = 0..self.levels.last()?.members.len();
        let of = |k: usize| {
            let values = self.levels.iter().map(|level| level.members.get(k)?.value(name));
            Some(converged(&sizes, &values.collect::<Option<Vec<f64>>>()?)?.uncertainty)
        };
        Spread::of(members.map(of).collect::<Option<Vec<f64>>>()?)
    }

    /// Reference value of a metric.
    pub fn metric(&self, name: &str) -> Standing {
        match self.estimate(name) {
            Err(why) => Standing::Not(why.into()),
            Ok(_) if !self.refines_mesh() => Standing::Not(ONE_MESH.to_owned()),
            Ok(Estimate { value, uncertainty, .. }) if uncertainty <= RESOLVED * value.abs() => {
                Standing::Established { value, uncertainty }
            }
            Ok(Estimate { value, uncertainty, .. }) => Standing::Not(format!(
                "its uncertainty, {}, is more than half of its value, {}",
                short(uncertainty),
                short(value)
            )),
        }
    }

    /// Times and values of a column.
    pub fn column(&self, name: &str) -> Option<(&[f64], &[f64])> {
        let run = self.finest()?;
        Some((&run.times, run.columns.get(name)?))
    }

    /// Names of the columns of the reference.
    pub fn columns(&self) -> Vec<&str> {
        self.finest().map_or_else(Vec::new, |run| run.columns.keys().map(String::as_str).collect())
    }

    /// Root mean square deviations of a column between successive levels, and the largest one of a
    /// member at the finest level, relative to the range.
    fn deviations(&self, column: &str) -> Option<(Vec<f64>, f64)> {
        let apart = |a: &Trajectory, b: &Trajectory| {
            let fine = b.columns.get(column)?;
            let coarse = a.columns.get(column)?;
            metrics::deviation(&a.times, coarse, (&b.times, fine))
        };
        let between = |pair: &[Level]| apart(pair[0].members.first()?, pair[1].members.first()?);
        let between: Option<Vec<f64>> = self.levels.windows(2).map(between).collect();
        let finest = self.levels.last()?;
        let (one, others) = finest.members.split_first()?;
        let spread = others.iter().map(|other| apart(other, one)).collect::<Option<Vec<f64>>>()?;
        Some((between?, spread.into_iter().fold(0.0, f64::max)))
    }

    /// Uncertainty of a column, relative to its range: root mean square over its rows.
    pub fn uncertainty(&self, column: &str) -> Standing {
        if self.exact {
            return Standing::Established { value: 0.0, uncertainty: 0.0 };
        }
        self.uncertainties.get(column).cloned().unwrap_or_else(|| self.of_column(column))
    }

    fn of_column(&self, column: &str) -> Standing {
        let Some((apart, spread)) = self.deviations(column) else {
            return Standing::Not("a run of the reference has no such column".to_owned());
        };
        // Values whose differences are these deviations.
        let mut values = vec![0.0];
        for deviation in apart.iter().rev() {
            values.push(values[values.len() - 1] + deviation);
        }
        values.reverse();
        let Some(found) = converged(&self.sizes(), &values) else {
            return Standing::Not("a single run gives no error estimate".to_owned());
        };
        let uncertainty = found.uncertainty + spread;
        if !self.refines_mesh() {
            Standing::Not(ONE_MESH.to_owned())
        } else if uncertainty <= RESOLVED {
            Standing::Established { value: 0.0, uncertainty }
        } else {
            Standing::Not(format!(
                "its uncertainty, {} of its range, is more than half of it",
                short(uncertainty)
            ))
        }
    }

    /// Uncertainty of a column at the times of the reference: the difference of the two finest
    /// levels, scaled to the uncertainty of the column.
    pub fn band(&self, column: &str) -> Vec<f64> {
        let Some((times, values)) = self.column(column) else { return Vec::new() };
        let before = self.levels.len().checked_sub(2).and_then(|i| self.levels[i].members.first());
        let other = before.and_then(|run| Some((&run.times, run.columns.get(column)?)));
        let last = self.deviations(column).and_then(|(apart, _)| apart.last().copied());
        let scale = match (self.uncertainty(column).established(), last) {
            (Some((_, uncertainty)), Some(last)) if last > 0.0 => uncertainty / last,
            _ => 1.0,
        };
        let off = |(t, v): (&f64, &f64)| {
            let there = other.and_then(|(times, values)| metrics::at(times, values, *t));
            there.map_or(0.0, |x| scale * (x - v).abs())
        };
        times.iter().zip(values).map(off).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(name: &'static str, value: f64) -> Trajectory {
        let metric = Metric { name: name.into(), value: Some(value), unit: String::new(), definition: "" };
        Trajectory { metrics: vec![metric], ..Trajectory::default() }
    }

    /// By hand: 1.4, 1.2, 1.1 at halved steps converge with first order to 1.0; members at the
    /// finest level that differ by 0.05 from their median widen the interval by as much.
    #[test]
    fn refinement_and_spread_add_up() {
        let level = |step: f64, values: &[f64]| Level {
            step,
            mesh: 1.0 / step,
            phases: 1,
            members: values.iter().map(|v| with("m", *v)).collect(),
        };
        let of = |finest: &[f64]| {
            let levels = vec![level(4.0, &[1.4]), level(2.0, &[1.2]), level(1.0, finest)];
            Reference::of_levels(String::new(), levels)
        };
        let found = of(&[1.1]).estimate("m").unwrap();
        assert!((found.order.unwrap() - 1.0).abs() < 1e-9 && (found.uncertainty - 0.125).abs() < 1e-9);
        let spread = of(&[1.1, 1.05, 1.15]).estimate("m").unwrap();
        assert!((spread.uncertainty - 0.175).abs() < 1e-9 && (spread.spread - 0.05).abs() < 1e-12);
        assert!(matches!(of(&[3.0]).metric("m"), Standing::Not(_)));
        let single = Reference::of_levels(String::new(), vec![level(1.0, &[1.0])]);
        assert!(matches!(single.metric("m"), Standing::Not(_)));
    }

    /// By hand: the medians 1.4, 1.2, 1.1 are those of the first member and would be uncertain by
    /// 0.125. The second does not converge and is uncertain by 3 · 0.2, the third by 1.25 · 0.2.
    #[test]
    fn every_member_is_refined_alone() {
        let level = |step: f64, values: [f64; 3]| Level {
            step,
            mesh: 1.0 / step,
            phases: 1,
            members: values.iter().map(|v| with("m", *v)).collect(),
        };
        let levels = [(4.0, [1.4, 1.3, 1.8]), (2.0, [1.2, 1.2, 1.3]), (1.0, [1.1; 3])];
        let levels = levels.map(|(step, values)| level(step, values)).into();
        let found = Reference::of_levels(String::new(), levels).estimate("m").unwrap();
        assert!((found.uncertainty - 0.25).abs() < 1e-9, "{found:?}");
    }

    /// By hand: instants 1.4, 1.2, 1.1 at the steps 4, 2, 1 are uncertain by 0.125 as above, and by
    /// the step 2 of the level before. Members 0.2 before and after the median add 0.2, and 3/2 of
    /// that if they are three phases.
    #[test]
    fn instants_are_late() {
        let of = |phases: usize, finest: &[f64]| {
            let level = |step: f64, values: &[f64]| Level {
                step,
                mesh: 1.0 / step,
                phases,
                members: values.iter().map(|v| with("contact_end", *v)).collect(),
            };
            let levels = vec![level(4.0, &[1.4]), level(2.0, &[1.2]), level(1.0, finest)];
            Reference::of_levels(String::new(), levels).estimate("contact_end").unwrap().uncertainty
        };
        assert!((of(1, &[1.1]) - 2.125).abs() < 1e-9);
        assert!((of(1, &[1.1, 0.9, 1.3]) - 2.325).abs() < 1e-9);
        assert!((of(3, &[1.1, 0.9, 1.3]) - 2.425).abs() < 1e-9);
    }

    /// By hand: averaging changes the peak of the finest run from 1.1 to 0.9; 5/4 of that is 0.25.
    #[test]
    fn what_averaging_changes_is_uncertain() {
        let levels = [(4.0, 1.4), (2.0, 1.2), (1.0, 1.1)];
        let levels = levels.map(|(step, value)| Level::single(step, with("peak_force", value)));
        let mut reference = Reference::of_levels(String::new(), levels.into());
        reference.averaged = with("peak_force", 0.9).metrics;
        assert!((reference.estimate("peak_force").unwrap().uncertainty - 0.375).abs() < 1e-9);
    }

    /// Columns off from 10 t by 0.4, 0.2 and 0.1 on [0, 1], except at the ends, which set the
    /// range: the deviations between successive levels are in the ratio of 2, so that the order is
    /// 1 and the uncertainty 5/4 of the last deviation. By hand, with a row in the middle only of
    /// three.
    #[test]
    fn uncertainty_and_band_of_a_column() {
        let run = |off: f64| Trajectory {
            times: vec![0.0, 0.5, 1.0],
            columns: [("A.uy".to_owned(), vec![0.0, 5.0 + off, 10.0])].into(),
            ..Trajectory::default()
        };
        let levels = |finest: Vec<Trajectory>| {
            let finest = Level { step: 1.0, mesh: 1.0, phases: 1, members: finest };
            let levels = vec![Level::single(4.0, run(0.4)), Level::single(2.0, run(0.2)), finest];
            Reference::of_levels(String::new(), levels)
        };
        let one = levels(vec![run(0.1)]);
        let rms = |off: f64| off / 10.0 / 3.0_f64.sqrt();
        let uncertainty = |of: &Reference| of.uncertainty("A.uy").established().unwrap().1;
        assert!((uncertainty(&one) - 1.25 * rms(0.1)).abs() < 1e-9);
        // In the middle the two finest levels differ by 0.1; five quarters of that.
        let band = one.band("A.uy");
        assert!(band[0] == 0.0 && (band[1] - 0.125).abs() < 1e-9 && band[2] == 0.0, "{band:?}");
        // A member 0.3 away adds its deviation.
        let two = levels(vec![run(0.1), run(0.4)]);
        assert!((uncertainty(&two) - 1.25 * rms(0.1) - rms(0.3)).abs() < 1e-9);
        assert!(matches!(one.uncertainty("B.uy"), Standing::Not(_)) && one.band("B.uy").is_empty());
    }

    /// The bar on a wall: a force of 300 from 0.5 to 7/6. Its impulse is a difference of the
    /// integral.
    #[test]
    fn metrics_of_exact_formulas() {
        let formulas = [
            ("active", "if(t >= 0.5, if(t < 7/6, 1, 0), 0)"),
            ("contact_force_x", "if(t >= 0.5, if(t < 7/6, 300, 0), 0)"),
            ("contact_impulse_x", "300*min(max(t-0.5,0),2/3)"),
        ];
        let formulas = formulas.map(|(name, text)| (name.to_owned(), text.to_owned())).into();
        let reference = Reference::of_formulas(&formulas, 2.0, 2000).unwrap();
        let value = |name: &str| reference.metric(name).established().unwrap();
        assert_eq!(value("peak_force"), (300.0, 0.0));
        assert!((value("impulse_x").0 - 200.0).abs() < 1e-9);
        assert!(matches!(reference.metric("apex"), Standing::Not(_)));
    }
}
