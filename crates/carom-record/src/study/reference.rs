//! The reference that the arms of a study are compared with, and its uncertainty.
//!
//! ```text
//! computed    runs at decreasing steps on finer meshes; each level is run with every member of the study's
//!             ensemble. Value: the median of the members at the finest level. Uncertainty: that of the
//!             refinement (convergence.rs) of a member, the median over the members, at least the distance to a
//!             second scheme and the change of the last halving of the step on the same mesh; plus the largest
//!             distance of a member from the median, plus for each event the step of the level before over the
//!             number of phases, or a row if it is longer, plus twice what averaging over a short time changes, for
//!             extremes and largest means (metrics/averaged.rs)
//! an arm      the same with the arms that differ from it only in step and refinement
//! exact       the formulas of [exact] of each arm, uncertainty 0, and the metrics that can be computed from these
//!             columns (exact.rs)
//! ideal       zero: energy that time integrator or contact dissipates or creates, penetration; without friction
//!             and plastic flow, changes of energy (measure.rs)
//! ```
//!
//! The medians of levels whose members scatter may converge with an order that no member has.
//!
//! Nothing is established on one mesh. A value is established if its uncertainty is less than half
//! of it; a column, or a group of columns with one scale (groups.rs), in the same way with the norm
//! of the difference between levels in the place of differences. Averaged forces and stresses are
//! uncertain by at least their distance from the next coarser mesh: two schemes on one mesh have
//! the error of that mesh in common. Only established values are used for rankings.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::convergence::{converged, converged_by};
use super::digits::short;
use super::ensemble::Spread;
use super::exact::Exact;
use super::groups::{Group, groups};
pub use super::known::Known;
use super::known::{ONE_MESH, RESOLVED};
pub use super::levels::Level;
use super::levels::Levels;
pub use super::trajectory::{FORCE, Trajectory};
use crate::Reason;
use crate::facts::{ContactFacts, Facts};
use crate::metrics::{self, Metric};

/// An overshoot, over what averaging over a short time changes: with schemes that do not dissipate,
/// averaging removes a little more than half of it.
const OVERSHOOT: f64 = 2.0;

/// Metrics that are instants or differences of instants, and of how many events that a record
/// resolves to one step.
const INSTANTS: [(&str, f64); 5] = [
    ("contact_start", 1.0),
    ("contact_end", 1.0),
    ("contact_duration", 2.0),
    ("turning_time", 1.0),
    ("apex_time", 1.0),
];

/// Number of events that determine a metric, each of which a record resolves to a row.
fn events(name: &str) -> f64 {
    INSTANTS.iter().find(|(instant, _)| *instant == name).map_or(0.0, |(_, events)| *events)
}

/// The reference beside a run.
pub(super) struct Beside<'a> {
    /// The run of the reference.
    pub(super) run: Cow<'a, Trajectory>,
    /// The solution that gives the scales of errors, if it is another one than that of the first
    /// arm.
    pub(super) scales: Option<Trajectory>,
}

/// A value that a reference establishes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Established {
    /// The value.
    pub value: f64,
    /// Uncertainty of the value, in the same unit.
    pub uncertainty: f64,
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

/// Reference that arms are compared with: runs at several levels of refinement, or exact formulas.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reference {
    /// Description in words.
    pub what: String,
    pub(super) runs: Levels,
    /// Metrics of the finest run after averaging over a short time.
    pub averaged: Vec<Metric>,
    /// Groups of columns in which arms are compared.
    pub known: Vec<Known>,
    /// Whether arms have other exact solutions than the first one.
    pub differs: bool,
    /// Uncertainties by column, which take the whole record to compute.
    uncertainties: BTreeMap<String, Result<f64, Reason>>,
}

impl Reference {
    /// Creates a reference from levels of decreasing steps, the finest last.
    pub fn of_levels(what: String, levels: Vec<Level>) -> Self {
        let runs = Levels { all: levels, ..Levels::default() };
        let mut reference = Self { what, runs, ..Self::default() };
        let columns = reference.columns().into_iter();
        reference.uncertainties = columns.map(|c| (c.to_owned(), reference.of_column(c))).collect();
        reference
    }

    /// Determines the groups of columns in which arms are compared; `bodies`: those of the probes;
    /// `window`: the time to average over.
    pub fn grouped(mut self, bodies: &BTreeMap<String, String>, window: &Result<f64, Reason>) -> Self {
        let Some(finest) = self.finest() else { return self };
        let is_exact = self.is_exact();
        let compared = |group: Group| if is_exact { group } else { group.touching(finest) };
        let found =
            groups(finest, bodies).into_iter().map(compared).filter(|group| !group.columns.is_empty());
        self.known = found.filter_map(|group| Known::of(group, &self.runs, window)).collect();
        self
    }

    /// Whether it consists of formulas.
    pub(super) fn is_exact(&self) -> bool {
        self.runs.exact.is_some()
    }

    /// Whether the uncertainty includes that of the mesh: the reference is exact, or its mesh was
    /// refined.
    pub fn refines_mesh(&self) -> bool {
        self.runs.refines_mesh()
    }

    /// The first member of the finest level.
    pub(super) fn finest(&self) -> Option<&Trajectory> {
        self.runs.finest()
    }

    /// Creates an exact reference from the formulas of a case with these contacts, in t up to
    /// `end`.
    pub fn of_formulas(formulas: &BTreeMap<String, String>, contacts: &[ContactFacts], end: f64) -> Self {
        let exact = Exact::of(formulas, contacts, end);
        let levels = exact.sampled().map(|run| Level::single(1.0, run)).into();
        let runs = Levels { all: levels, exact: Some(exact), ..Levels::default() };
        Self { what: "the exact formulas of [exact]".to_owned(), runs, ..Self::default() }
    }

    /// The reference beside a run with these times of rows: the finest run, or the exact solution
    /// of an arm with these facts.
    pub(super) fn beside(&self, facts: &Facts, rows: &[f64]) -> Option<Beside<'_>> {
        let Some(exact) = &self.runs.exact else {
            return Some(Beside { run: Cow::Borrowed(self.finest()?), scales: None });
        };
        let own = Exact::of(&facts.exact, &facts.contacts, facts.end);
        let scales = (!own.is_alike(exact)).then(|| own.samples());
        Some(Beside { scales, run: Cow::Owned(own.beside(rows)) })
    }

    /// Value of a metric with its uncertainty.
    ///
    /// # Errors
    /// The reason why the reference has no such value.
    pub fn estimate(&self, name: &str) -> Result<Estimate, Reason> {
        if self.differs {
            return Err("the arms have different formulas in [exact], or different ends".into());
        }
        if let Some(exact) = &self.runs.exact {
            let value = |level: &Level| level.members.first()?.value(name);
            let values: Option<Vec<f64>> = self.runs.all.iter().map(value).collect();
            let Some([coarse, value]) = values.as_deref() else {
                return Err("[exact] lacks a column that it is computed from, such as `active` for instants of contact".into());
            };
            let uncertainty = (value - coarse).abs() + events(name) * exact.row();
            return Ok(Estimate { value: *value, uncertainty, order: None, spread: 0.0 });
        }
        let of = |level: &Level| Spread::of(level.members.iter().filter_map(|run| run.value(name)));
        let levels: Option<Vec<Spread>> = self.runs.all.iter().map(of).collect();
        let levels = levels.ok_or("a run of the reference has no value")?;
        let medians: Vec<f64> = levels.iter().map(Spread::median).collect();
        let found = converged(&self.runs.sizes(), &medians)?;
        let refined = self.refined_members(name).map_or(found.uncertainty, |of_members| of_members.median());
        let single = self.runs.all.last().and_then(|level| level.members.first()?.value(name));
        let checks = self.runs.checks.iter().filter_map(|run| Some((run.value(name)? - single?).abs()));
        let refined = checks.fold(refined, f64::max);
        let (value, spread) = levels.last().map_or((0.0, 0.0), |s| (s.median(), s.half_width()));
        let instant = self.detected(name);
        let averaged =
            self.averaged.iter().find(|metric| metric.name == name).and_then(|metric| metric.value);
        let smoothed = single.zip(averaged).map_or(0.0, |(one, other)| OVERSHOOT * (one - other).abs());
        let between = self.runs.all.last().map_or(1.0, Level::between_phases);
        let uncertainty = refined + between * spread + instant + smoothed;
        Ok(Estimate { value, uncertainty, order: found.order, spread })
    }

    /// Uncertainty of the detection of events, which are late by up to a row at each level: the
    /// difference of two levels is known up to the longer one of their rows. Where every step is a
    /// row, n phases resolve an event to 1/n of a step, and their median is late by half a step at
    /// every level, which converges as the refinement does. Most phases may have the same duration,
    /// late by up to half a step.
    fn detected(&self, name: &str) -> f64 {
        let events = events(name);
        let before = self.runs.all.len().saturating_sub(2);
        let Some(level) = self.runs.all.get(before) else { return 0.0 };
        let share = 1.0 / level.phases.max(1) as f64;
        let least = if events > 1.0 { 0.5 } else { 0.0 };
        events * level.step * (level.steps_of_a_row() - 1.0 + share.max(least))
    }

    /// Uncertainties of the refinement of each member alone; none where a member has no value at a
    /// level.
    fn refined_members(&self, name: &str) -> Option<Spread> {
        let sizes = self.runs.sizes();
        let members = 0..self.runs.all.last()?.members.len();
        let of = |k: usize| {
            let values = self.runs.all.iter().map(|level| level.members.get(k)?.value(name));
            Some(converged(&sizes, &values.collect::<Option<Vec<f64>>>()?).ok()?.uncertainty)
        };
        Spread::of(members.map(of).collect::<Option<Vec<f64>>>()?)
    }

    /// Reference value of a metric.
    ///
    /// # Errors
    /// The reason why the reference establishes none.
    pub fn metric(&self, name: &str) -> Result<Established, Reason> {
        let Estimate { value, uncertainty, .. } = self.estimate(name)?;
        if !self.refines_mesh() {
            return Err(ONE_MESH.into());
        }
        if uncertainty <= RESOLVED * value.abs() {
            return Ok(Established { value, uncertainty });
        }
        let off = short(uncertainty);
        Err(format!("its uncertainty, {off}, is more than half of its value, {}", short(value)).into())
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
        let between: Option<Vec<f64>> = self.runs.all.windows(2).map(between).collect();
        let finest = self.runs.all.last()?;
        let (one, others) = finest.members.split_first()?;
        let spread = others.iter().map(|other| apart(other, one)).collect::<Option<Vec<f64>>>()?;
        Some((between?, spread.into_iter().fold(0.0, f64::max)))
    }

    /// Uncertainty of a column, relative to its range: root mean square over its rows.
    ///
    /// # Errors
    /// The reason why the reference does not establish the column.
    pub fn uncertainty(&self, column: &str) -> Result<f64, Reason> {
        if self.runs.exact.is_some() {
            return Ok(0.0);
        }
        self.uncertainties.get(column).cloned().unwrap_or_else(|| self.of_column(column))
    }

    fn of_column(&self, column: &str) -> Result<f64, Reason> {
        let found = self.deviations(column);
        let (between, spread) = found.ok_or("a run of the reference has no such column")?;
        let refined = converged_by(&self.runs.sizes(), between.into_iter())?;
        if !self.refines_mesh() {
            return Err(ONE_MESH.into());
        }
        let uncertainty = refined.uncertainty + spread;
        if uncertainty <= RESOLVED {
            return Ok(uncertainty);
        }
        let off = short(uncertainty);
        Err(format!("its uncertainty, {off} of its range, is more than half of it").into())
    }

    /// Uncertainty of a column at the times of the reference: the difference of the two finest
    /// levels, scaled to the uncertainty of the column.
    pub fn band(&self, column: &str) -> Vec<f64> {
        let Some((times, values)) = self.column(column) else { return Vec::new() };
        if self.is_exact() {
            return vec![0.0; times.len()];
        }
        let before = self.runs.all.iter().rev().nth(1).and_then(|level| level.members.first());
        let other = before.and_then(|run| Some((&run.times, run.columns.get(column)?)));
        let last = self.deviations(column).and_then(|(apart, _)| apart.last().copied());
        let scale = match (self.uncertainty(column), last) {
            (Ok(uncertainty), Some(last)) if last > 0.0 => uncertainty / last,
            _ => 1.0,
        };
        let off = |(t, v): (&f64, &f64)| {
            let there = other.and_then(|(times, values)| metrics::at(times, values, *t));
            there.map_or(0.0, |x| scale * (x - v).abs())
        };
        times.iter().zip(values).map(off).collect()
    }
}
