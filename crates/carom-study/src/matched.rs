//! Steps at which methods have the same counted cost (`carom_record::metrics::KERNELS`).
//!
//! ```text
//! Δt = end/N,  N ← N · budget/cost                  until two trials bracket the budget, that of `cost_of` at the level
//! N between them, interpolated in logarithms        until the cost is within 5 % of the budget, or N has no neighbour left
//! ```
//!
//! Longer steps need more iterations each, so that the cost may grow much slower than N. A budget
//! between the costs of two successive numbers of steps cannot be met; the cost that was reached is
//! in `study.json` and on the page.
//!
//! Counts are the same on every machine, and therefore the steps are. The trials are stored in
//! `pilots/ARM/pilot.json`. A pilot is a complete run, because contact costs more than flight; the
//! accepted one becomes the arm.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use carom_record::metrics::cost;
use carom_record::study::{Arm, StudyManifest, sets_step};
use carom_record::{Manifest, RecordError, Status, json};
use carom_run::case::Case;
use carom_run::recording::{self, RunError};
use serde::{Deserialize, Serialize};

use crate::compute::{case_of, compute};
use crate::error::StudyError;
use crate::jobs::{Ended, Event, OnStep, side_by_side, threads};

/// Relative difference from the budget at which a cost is accepted; the page states twice this.
const CLOSE: f64 = 0.05;
/// Largest number of pilot runs of an arm.
const TRIALS: usize = 12;
/// Largest step, relative to that of the first pilot: beyond it most steps are rejected and
/// bisected, so that the run has no definite step.
const LONGEST: u64 = 16;
/// Largest factor of the number of steps from one trial to the next, without a bracket.
const FACTOR: f64 = 4.0;
/// Part of a bracket, in logarithms, that a trial within it leaves out at either end.
const INNER: f64 = 0.1;

/// A pilot run that ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Trial {
    /// Number of time steps.
    steps: u64,
    /// Counted cost of the run; none if it did not reach its end.
    cost: Option<f64>,
}

/// Pilot runs of an arm, stored in `pilots/ARM/pilot.json`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Pilot {
    budget: Option<f64>,
    trials: Vec<Trial>,
    /// Index of the trial that was accepted.
    settled: Option<usize>,
}

impl Pilot {
    fn read(folder: &Path) -> Result<Self, RecordError> {
        let found = json::read(&folder.join("pilot.json"), "delete it, and resume the study")?;
        Ok(found.unwrap_or_default())
    }

    fn write(&self, folder: &Path) -> Result<(), RecordError> {
        json::write(&folder.join("pilot.json"), self)
    }

    /// Steps of the next trial; none if a trial is accepted or there is nothing left to try.
    fn next(&self, first: u64) -> Option<u64> {
        let Some(last) = self.trials.last() else { return Some(first) };
        let budget = self.budget?;
        let tried = |next: u64| self.trials.iter().any(|t| t.steps == next);
        if last.cost.is_none() {
            // The step was not possible, for example above the stable step of an explicit scheme:
            // go half way back to the nearest trial that ran.
            let ran = self.trials.iter().filter(|t| t.cost.is_some()).map(|t| t.steps);
            let next = (ran.min_by_key(|s| s.abs_diff(last.steps))? + last.steps).div_ceil(2);
            return (self.trials.len() < TRIALS && !tried(next)).then_some(next);
        }
        // Logarithms of the steps and of cost over budget.
        let off = self.trials.iter().filter_map(|t| Some(((t.steps as f64).ln(), (t.cost? / budget).ln())));
        let nearest = |side: f64| {
            let on_side = off.clone().filter(|t| t.1 * side > 0.0);
            on_side.min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
        };
        let (steps, excess) = off.clone().min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
        if excess.exp_m1().abs() <= CLOSE || self.trials.len() >= TRIALS {
            return None;
        }
        let wanted = match nearest(-1.0).zip(nearest(1.0)) {
            Some((below, above)) => {
                let share = below.1 / (below.1 - above.1);
                below.0 + share.clamp(INNER, 1.0 - INNER) * (above.0 - below.0)
            }
            None => steps - excess.clamp(-FACTOR.ln(), FACTOR.ln()),
        };
        let next = (wanted.exp().round() as u64).max(first.div_ceil(LONGEST));
        (!tried(next)).then_some(next)
    }

    /// The trial that was accepted.
    fn accepted(&self) -> Option<&Trial> {
        self.trials.get(self.settled?)
    }

    /// The trial whose cost is closest to the budget; the first one if none has a cost.
    fn closest(&self) -> usize {
        let off = |t: &Trial| {
            t.cost.zip(self.budget).map_or(f64::INFINITY, |(cost, budget)| (cost / budget).ln().abs())
        };
        (0..self.trials.len())
            .min_by(|a, b| off(&self.trials[*a]).total_cmp(&off(&self.trials[*b])))
            .unwrap_or(0)
    }
}

/// Determines the step of every arm whose cost is matched, and computes these arms. Returns whether
/// all of them are settled.
///
/// # Errors
/// Input/output or system error.
pub(crate) fn settle(
    manifest: &mut StudyManifest,
    directory: &Path,
    jobs: usize,
    observe: &mut dyn FnMut(&Event),
    stop: &AtomicBool,
) -> Result<bool, StudyError> {
    let arms_with = |property: &dyn Fn(&Arm) -> bool| {
        (0..manifest.arms.len()).filter(|i| property(&manifest.arms[*i])).collect::<Vec<_>>()
    };
    let others = arms_with(&|arm| manifest.by_cost(arm));
    if others.is_empty() {
        return Ok(true);
    }
    let matched_to = manifest.design.as_ref().map(|design| &design.cost_of);
    let anchors = arms_with(&|arm| !arm.role.fine && arm.role.method.as_ref() == matched_to);
    let not_ended = |i: &usize| !manifest.has_ended(directory, &manifest.arms[*i]);
    let waiting = anchors.iter().copied().filter(not_ended).collect();
    let one = |i: usize, progress: OnStep| compute(manifest, directory, i, threads(jobs), progress, stop);
    side_by_side(waiting, jobs, &one, observe, stop)?;
    if anchors.iter().any(not_ended) {
        return Ok(false);
    }
    let one = |i: usize, progress: OnStep| {
        let is_of_level = |arm: &&Arm| arm.role.level == manifest.arms[i].role.level;
        let anchor = anchors.iter().map(|i| &manifest.arms[*i]).find(is_of_level);
        let budget = anchor.map_or(Ok(None), |arm| counted_cost(&directory.join(&arm.directory)))?;
        pilot(manifest, directory, i, budget, progress, stop)
    };
    side_by_side(others.iter().copied().collect(), jobs, &one, observe, stop)?;
    let mut all_settled = true;
    for i in others {
        let pilot = Pilot::read(&folder(manifest, directory, i))?;
        // A stop may have left an accepted trial without the record of its arm.
        match pilot.accepted().filter(|_| directory.join(&manifest.arms[i].directory).exists()) {
            Some(trial) => {
                adopt(manifest, i, trial.steps)?;
                manifest.arms[i].role.cost = trial.cost.zip(pilot.budget).map(|(cost, budget)| cost / budget);
            }
            None => all_settled = false,
        }
    }
    manifest.write(directory)?;
    Ok(all_settled)
}

/// The folder of the pilot runs of an arm.
fn folder(manifest: &StudyManifest, directory: &Path, i: usize) -> PathBuf {
    let arm = &manifest.arms[i].directory;
    directory.join("pilots").join(arm.rsplit('/').next().unwrap_or(arm))
}

/// The counted cost of a run; none if it did not reach its end.
fn counted_cost(path: &Path) -> Result<Option<f64>, RecordError> {
    let run = Manifest::read(path)?;
    Ok(cost(&run.counters, run.facts.stepping).filter(|_| run.status == Status::Finished))
}

/// Gives an arm and its members the step of that many steps of the arm, in their cases and in their
/// changes. A member with a phase has one step more.
fn adopt(manifest: &mut StudyManifest, i: usize, steps: u64) -> Result<(), StudyError> {
    let step = case_with(manifest, i, steps)?.time.step;
    let adopting = manifest.runs_of(i);
    let runs = manifest.arms.iter_mut().chain(&mut manifest.members).enumerate();
    for (_, run) in runs.filter(|(run, _)| adopting.contains(run)) {
        let mut case = case_of(run)?;
        case.time.step = step;
        run.sets.retain(|set| !sets_step(set));
        run.sets.push(format!("time.step={step:?}"));
        run.steps = case.time.steps() as u64;
        run.facts = case.facts();
        run.case = case.to_json().unwrap_or_default();
    }
    Ok(())
}

/// The case of an arm with a number of steps.
fn case_with(manifest: &StudyManifest, i: usize, steps: u64) -> Result<Case, StudyError> {
    let arm = &manifest.arms[i];
    let mut case = case_of(arm)?;
    if steps != arm.steps {
        case.time.step = case.time.end / steps as f64;
    }
    Ok(case)
}

/// Pilot runs of an arm until its cost matches the budget. Returns how the accepted one ended.
fn pilot(
    manifest: &StudyManifest,
    directory: &Path,
    i: usize,
    budget: Option<f64>,
    progress: OnStep,
    stop: &AtomicBool,
) -> Result<Ended, StudyError> {
    let arm = &manifest.arms[i];
    let folder = folder(manifest, directory, i);
    fs::create_dir_all(&folder).map_err(RecordError::io("create", &folder))?;
    let mut pilot = Pilot::read(&folder)?;
    if pilot.budget.is_none() && budget.is_some() {
        pilot.budget = budget;
        pilot.write(&folder)?;
    }
    // Starts or resumes a run of that many steps.
    let mut computed = |steps: u64, path: &Path| -> Result<Ended, StudyError> {
        let done = if path.join("manifest.json").is_file() {
            recording::resume(path, 1, progress, stop)
        } else {
            let case = case_with(manifest, i, steps)?;
            let mut source = manifest.source_of(arm);
            source.sets.retain(|set| !sets_step(set));
            source.sets.push(format!("time.step={:?}", case.time.step));
            recording::run(&case, source, path, 1, progress, stop)
        };
        done.map(Ended::of).map_err(|source| StudyError::Arm { arm: arm.name.clone(), source })
    };
    let settled = loop {
        if let Some(settled) = pilot.settled {
            break settled;
        }
        if let Some(steps) = pilot.next(arm.steps) {
            let path = folder.join((pilot.trials.len() + 1).to_string());
            let cost = match computed(steps, &path) {
                Ok(ended) if ended.status == Status::Stopped => return Ok(ended),
                Ok(_) => counted_cost(&path)?,
                // Not possible, for example above the stable step of an explicit scheme.
                Err(StudyError::Arm { source: RunError::Case(_), .. }) => None,
                Err(error) => return Err(error),
            };
            pilot.trials.push(Trial { steps, cost });
        } else {
            pilot.settled = Some(pilot.closest());
        }
        pilot.write(&folder)?;
    };
    let from = folder.join((settled + 1).to_string());
    let to = directory.join(&arm.directory);
    if !to.exists() {
        // The record of an accepted trial may have been removed together with that of its arm.
        if !from.is_dir() {
            let ended = computed(pilot.trials[settled].steps, &from)?;
            if ended.status == Status::Stopped {
                return Ok(ended);
            }
        }
        fs::rename(&from, &to).map_err(RecordError::io("move", &from))?;
    }
    // The costs of the other trials are in pilot.json; their records are removed to save space.
    for trial in (1..=pilot.trials.len()).map(|trial| folder.join(trial.to_string())) {
        if trial.is_dir() {
            fs::remove_dir_all(&trial).map_err(RecordError::io("remove", &trial))?;
        }
    }
    let run = Manifest::read(&to)?;
    let wall = run.timings.get("total").copied().unwrap_or(0.0);
    Ok(Ended { status: run.status, reason: run.reason, wall })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pilot(trials: &[(u64, Option<f64>)]) -> Pilot {
        let trials = trials.iter().map(|(steps, cost)| Trial { steps: *steps, cost: *cost }).collect();
        Pilot { budget: Some(10.0), trials, ..Pilot::default() }
    }

    /// Twice the budget gives half the steps; within 5 % a trial is accepted; the closest one is
    /// used. Between 7 and 20 the cost grows as N^0.757, so that 10 needs 160 steps; between
    /// successive numbers of steps there is no further trial.
    #[test]
    fn steps_follow_the_budget() {
        assert_eq!(pilot(&[]).next(400), Some(400));
        assert_eq!(pilot(&[(400, Some(20.0))]).next(400), Some(200));
        assert_eq!(pilot(&[(400, Some(20.0)), (200, Some(10.4))]).next(400), None);
        assert_eq!(pilot(&[(400, Some(20.0)), (200, Some(14.142))]).next(400), Some(141));
        assert_eq!(pilot(&[(400, Some(20.0)), (100, Some(7.0))]).next(400), Some(160));
        // At most sixteen times the first step.
        assert_eq!(pilot(&[(400, Some(200.0)), (40, Some(30.0))]).next(400), Some(25));
        assert_eq!(pilot(&[(400, Some(200.0)), (25, Some(30.0))]).next(400), None);
        assert_eq!(pilot(&[(41, Some(12.0)), (40, Some(8.0))]).next(41), None);
        assert_eq!(pilot(&[(400, Some(20.0)), (200, None)]).next(400), Some(300));
        assert_eq!(pilot(&[(400, None)]).next(400), None);
        assert_eq!(pilot(&[(400, Some(20.0)), (200, Some(12.0)), (166, None)]).closest(), 1);
    }

    /// 25 seconds in 500 steps, and in 501 with a phase. A budget that is met with 501 steps of the
    /// arm gives its member the same step, and therefore 502 steps.
    #[test]
    fn members_have_the_step_of_their_arm() {
        let folder = tempfile::tempdir().unwrap();
        let bars = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/bar/two-bars.toml");
        let hu = "set = { \"time.scheme\" = { kind = \"hu\" } }";
        let study = format!(
            "case = '{}'\ndesign = \"matched-cost\"\n[ensemble]\nphases = 2\n[[arm]]\nname = \"a\"\n\
             [[arm]]\nname = \"b\"\n{hu}\n",
            bars.display()
        );
        let path = folder.path().join("study.toml");
        fs::write(&path, study).unwrap();
        let mut manifest = crate::Plan::read(&path).unwrap().manifest;
        let steps = |manifest: &StudyManifest| {
            manifest.runs_of(1).into_iter().map(|run| manifest.run(run).steps).collect::<Vec<_>>()
        };
        assert_eq!(steps(&manifest), [500, 501]);
        adopt(&mut manifest, 1, 501).unwrap();
        assert_eq!(steps(&manifest), [501, 502]);
        for run in manifest.runs_of(1) {
            assert_eq!(manifest.run(run).case["time"]["step"], 25.0 / 501.0);
        }
    }
}
