//! Ranking of the arms by the goal of a study.
//!
//! ```text
//! metric      e = |m − r|/|r|, |m| if r = 0
//! columns     e = rms over vectors of ‖⟨m − r⟩‖ / scale       motion, averaged forces and stresses
//! of an arm   the largest error of its members; its interval: e ± U, the uncertainty of the reference
//! a better    (‖b − r‖² − ‖a − r‖²) / (2 ‖a − b‖) > U         for all members a of one and some member b of the other
//! a, b same   ‖a − b‖ ≤ 0.05 (e − U)                          for every member a some member b, and conversely
//! ```
//!
//! The quotient is the distance of r from the solutions that are as far from a as from b: an arm is
//! distinguishably better if every solution within U of r is nearer to it. The errors of arms that
//! are the same differ by at most 5 % for each of these solutions. Intervals without a
//! common point imply that; an error that both arms have in common, such as that of their mesh,
//! makes intervals overlap, but does not hide the difference. The place of an arm is one plus the
//! number of arms of its level that are distinguishably better; arms with the same results to the
//! last bit count as one. An arm is set apart, with the reason, if it or one of its members
//! stopped, created energy or penetrated. Nothing depends on measured times, nor on the order of
//! the arms.

use super::arm::Arm;
use super::design::Goal;
use super::digits::short;
use super::groups::Kind;
use super::measure::{Errors, Measured};
pub use super::measure::{Measure, Ranks, error};
pub use super::ranked::{Apart, Ranked};
use super::row::Row;
pub use super::verdict::{Confidence, Verdict};
use super::verdict::{Field, recommended};
use crate::{Reason, Status};

/// Identifier of the warning about energy that friction hides.
const HIDDEN: &str = "hidden-energy";

/// Windows of averages: w, w/2 and 2w.
const WINDOWS: usize = 3;
/// Largest penetration of an arm that is not set apart, relative to the largest motion of a body.
const DEEP: f64 = 0.02;

/// The ranking of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranking {
    /// The goal of the ranking.
    pub goal: Goal,
    /// The measure, or why there is none.
    pub measure: Result<Measure, Reason>,
    /// Ranked arms per level, the best first.
    pub levels: Vec<Vec<Ranked>>,
    /// Arms that are set apart.
    pub apart: Vec<Apart>,
    /// The recommendation, or the reasons why there is none.
    pub verdict: Result<Verdict, Vec<String>>,
}

impl Ranks<'_> {
    /// Ranks the arms by a goal. A verdict that another window of averages changes is withheld.
    pub fn of(&self, goal: Goal) -> Ranking {
        let mut ranking = self.with_window(goal, 0);
        let is_averaged = matches!(goal, Goal::Force | Goal::Stress);
        let Some(verdict) = ranking.verdict.as_ref().ok().filter(|_| is_averaged) else { return ranking };
        if let Some(other) = self.changed(goal, verdict) {
            let why = format!(
                "the verdict depends on the time to average over: {}, and {other} with half or twice that time",
                self.manifest.arms[verdict.arm].name
            );
            ranking.verdict = Err(vec![why]);
        }
        ranking
    }

    /// The verdict with half or twice the window, if it is not that of the window itself.
    fn changed(&self, goal: Goal, verdict: &Verdict) -> Option<String> {
        let name = |arm: usize| self.manifest.arms[arm].name.as_str();
        let is_same = |arm: usize| arm == verdict.arm || verdict.alike.iter().any(|alike| alike == name(arm));
        (1..WINDOWS).find_map(|window| match self.with_window(goal, window).verdict {
            Ok(other) if is_same(other.arm) => None,
            Ok(other) => Some(name(other.arm).to_owned()),
            Err(why) => Some(format!("none ({})", why.join("; "))),
        })
    }

    fn with_window(&self, goal: Goal, window: usize) -> Ranking {
        let measured = self.measured(goal, window);
        let apart = |(arm, _)| self.apart(arm, measured.as_ref().ok());
        let apart: Vec<Apart> = self.arms().filter_map(apart).collect();
        let measured = match measured {
            Ok(measured) => measured,
            Err(why) => {
                let reasons = vec![format!("the reference establishes no measure of this goal: {why}")];
                let levels = Vec::new();
                return Ranking { goal, measure: Err(why), levels, apart, verdict: Err(reasons) };
            }
        };
        let count = self.manifest.arms.iter().map(|arm| arm.role.level + 1).max().unwrap_or(0);
        let level = |level: usize| {
            let sound = self
                .arms()
                .filter(|(i, arm)| arm.role.level == level && !apart.iter().any(|apart| apart.arm == *i));
            let ranked = sound.filter_map(|(arm, _)| self.ranked(arm, &measured));
            self.placed(ranked.collect(), &measured)
        };
        let levels: Vec<Vec<Ranked>> = (0..count).map(level).collect();
        let ranked = levels.iter().flatten().collect();
        let verdict =
            recommended(&Field { goal, rows: self.rows, measured: &measured, apart: &apart, ranked });
        Ranking { goal, measure: Ok(measured.measure), levels, apart, verdict }
    }

    /// The arms that are compared with the reference, with their numbers.
    fn arms(&self) -> impl Iterator<Item = (usize, &Arm)> {
        let reference = self.manifest.reference.as_ref();
        let arms = self.manifest.arms.iter().enumerate();
        arms.filter(move |(_, arm)| !arm.role.fine && reference != Some(&arm.name))
    }

    fn ranked(&self, arm: usize, measured: &Measured) -> Option<Ranked> {
        let uncertainty = measured.measure.uncertainty;
        let members = self.manifest.runs_of(arm).into_iter().map(|run| measured.runs[run].as_ref());
        let members: Vec<&Errors> = members.collect::<Option<_>>()?;
        let error = members.iter().map(|member| member.error).fold(0.0, f64::max);
        let noise = members.iter().filter_map(|member| member.noise).reduce(f64::max);
        let interval = [(error - uncertainty).max(0.0), error + uncertainty];
        let cost = self.rows[arm].value("cost")?;
        error.is_finite().then_some(Ranked { arm, error, noise, interval, cost, place: 0 })
    }

    /// Gives the arms of a level their places, and sorts them.
    fn placed(&self, mut ranked: Vec<Ranked>, measured: &Measured) -> Vec<Ranked> {
        let place = |own: &Ranked| {
            let mut ahead: Vec<usize> = Vec::new();
            for other in ranked.iter().filter(|other| measured.is_better(other.arm, own.arm)) {
                if !ahead.iter().any(|arm| self.rows[*arm].is_twin(&self.rows[other.arm])) {
                    ahead.push(other.arm);
                }
            }
            1 + ahead.len()
        };
        let places: Vec<usize> = ranked.iter().map(place).collect();
        ranked.iter_mut().zip(places).for_each(|(ranked, place)| ranked.place = place);
        let name = |ranked: &Ranked| &self.manifest.arms[ranked.arm].name;
        let errors = |a: &Ranked, b: &Ranked| a.error.total_cmp(&b.error).then(a.cost.total_cmp(&b.cost));
        ranked.sort_by(|a, b| a.place.cmp(&b.place).then(errors(a, b)).then_with(|| name(a).cmp(name(b))));
        ranked
    }

    /// An arm that is set apart, with the reason; none if it is not.
    fn apart(&self, arm: usize, measured: Option<&Measured>) -> Option<Apart> {
        let of = |run: &usize| {
            let row = &self.rows[*run];
            let member = self.manifest.run(*run).role.member.zip(self.manifest.ensemble.as_ref());
            let which = member.map_or_else(String::new, |(of, all)| format!("{}: ", all.name(&of.member)));
            let why = match row.value("energy_created") {
                _ if row.status == Some(Status::Failed) => {
                    format!("it stopped ({})", row.reason.as_deref().unwrap_or("no reason known"))
                }
                Some(share) if row.is_unsound() => format!("it created {} of the energy", short(share)),
                _ => hidden(row).or_else(|| self.deep(row))?,
            };
            Some(format!("{which}{why}"))
        };
        let lacks = |run: &usize| {
            let is_unknown = measured.is_some_and(|measured| measured.runs[*run].is_none());
            is_unknown && self.rows[*run].status == Some(Status::Finished)
        };
        let runs = self.manifest.runs_of(arm);
        let unknown = || {
            let run = runs.iter().find(|run| lacks(run))?;
            let undefined = self.compared[*run].as_ref().and_then(|compared| compared.undefined.as_ref());
            Some(
                undefined
                    .map_or_else(|| "it lacks a quantity of the measure".to_owned(), ToString::to_string),
            )
        };
        let why = runs.iter().find_map(of).or_else(unknown)?;
        Some(Apart { arm, why })
    }

    /// Penetration of a run that is a part of the motion, and more than that of the reference. The
    /// share of a facet by which smooth nodes of the primary side may enter is that of the mesh,
    /// not of the arm.
    fn deep(&self, row: &Row) -> Option<String> {
        let reference = self.reference?;
        let finest = reference.finest()?;
        let motions = reference.known.iter().filter(|known| known.group.kind == Kind::Motion);
        let motion = motions.filter_map(|known| known.group.motion(finest)).reduce(f64::max)?;
        let own = row.value("penetration_secondary")?;
        let right = finest.value("penetration_secondary").unwrap_or(0.0);
        let beyond = (own - right) / motion;
        (beyond > DEEP).then(|| {
            format!(
                "it penetrates by {}, {} of the motion more than the reference, and {DEEP} at most is allowed",
                short(own),
                short(beyond)
            )
        })
    }
}

/// The warning of a run about energy that was created while friction took as much.
fn hidden(row: &Row) -> Option<String> {
    let warning = row.warnings.iter().find(|warning| warning.id == HIDDEN)?;
    Some(warning.what.clone())
}
