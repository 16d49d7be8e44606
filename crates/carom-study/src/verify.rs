//! Runs a suite and evaluates its expectations: cases and arms run concurrently, the longest first,
//! with one thread each. Fields and pages are written only on request. Expectations are about the
//! arms of a study: the members of its ensemble are not run.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use carom_record::question::Question;
use carom_record::study::{Arm, Study, StudyManifest};
use carom_record::verification::{Row, SetUp, Verification};
use carom_record::{Expect, Expectation, Machine, RecordError, Run, Source, Status, judge, now};
use carom_run::case::Case;
use carom_run::recording::{self, Progress};

use crate::error::StudyError;
use crate::jobs::{Ended, Event, OnStep, side_by_side};
use crate::memory::fit;
use crate::suite::{Item, Kind, Suite};

/// How a suite is run.
#[derive(Clone, Copy, Debug)]
pub struct VerifyOptions {
    /// Number of concurrent runs.
    pub jobs: usize,
    /// Whether runs write fields and checkpoints as set in their cases, so that pages can be made.
    pub whole: bool,
    /// Whether to stop at the first set-up that misses an expectation or stops unexpectedly; short
    /// set-ups are then run first.
    pub fail_fast: bool,
}

/// A simulation that a suite runs: a case, or an arm of a study.
struct Unit {
    item: usize,
    name: String,
    directory: PathBuf,
    case: Case,
    source: Source,
}

/// Name and length of a simulation of a suite.
#[derive(Clone, Debug)]
pub struct Named {
    /// Family, file and arm, as one text.
    pub name: String,
    /// Number of time steps.
    pub steps: u64,
}

impl Suite {
    /// Runs everything into a new directory; none if it was interrupted. With `fail_fast`, returns
    /// the results up to the first miss. `begin` is called with all runs; events refer to them by
    /// number.
    ///
    /// # Errors
    /// Input/output or system error. Runs that stop and expectations that are missed are not
    /// errors.
    pub fn verify(
        &self,
        directory: &Path,
        options: VerifyOptions,
        begin: &mut dyn FnMut(&[Named]),
        observe: &mut dyn FnMut(&Event),
        stop: &AtomicBool,
    ) -> Result<Option<Verification>, StudyError> {
        let started = now();
        let began = Instant::now();
        let places = self.places();
        let mut units = Vec::new();
        for (i, item) in self.items.iter().enumerate() {
            units.extend(item.units(i, &directory.join(&places[i]), options.whole)?);
        }
        let named: Vec<Named> =
            units.iter().map(|u| Named { name: u.name.clone(), steps: u.case.time.steps() as u64 }).collect();
        fit(units.iter().map(|unit| &unit.case), options.jobs)?;
        begin(&named);
        let order = order(&units, self.items.len(), options.fail_fast);
        // Set by Ctrl-C, and with `fail_fast` by the first miss.
        let halt = AtomicBool::new(false);
        let one = |i: usize, progress: OnStep| {
            let Unit { name, directory, case, source, .. } = &units[i];
            let mut watched = |p: &Progress| {
                halt.fetch_or(stop.load(Ordering::Relaxed), Ordering::Relaxed);
                progress(p);
            };
            let done = recording::run(case, source.clone(), directory, 1, &mut watched, &halt);
            done.map(Ended::of).map_err(|source| StudyError::Arm { arm: name.clone(), source })
        };
        let mut judged: Vec<Option<Result<SetUp, StudyError>>> = self.items.iter().map(|_| None).collect();
        let mut walls = vec![0.0; self.items.len()];
        let mut left = vec![0; self.items.len()];
        units.iter().for_each(|unit| left[unit.item] += 1);
        let mut watch = |event: &Event| {
            if let Event::Ended(i, ended) = event
                && ended.status != Status::Stopped
            {
                let k = units[*i].item;
                walls[k] += ended.wall;
                left[k] -= 1;
                if left[k] == 0 {
                    let set_up = self.items[k].judged(directory, &places[k], walls[k], self.fast);
                    let bad = set_up.as_ref().map_or(true, SetUp::is_bad);
                    halt.fetch_or(options.fail_fast && bad, Ordering::Relaxed);
                    judged[k] = Some(set_up);
                }
            }
            observe(event);
        };
        side_by_side(VecDeque::from(order), options.jobs, &one, &mut watch, &halt)?;
        if stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let verification = Verification {
            version: env!("CARGO_PKG_VERSION").into(),
            started,
            machine: Machine::current(),
            jobs: options.jobs,
            wall: began.elapsed().as_secs_f64(),
            fast: self.fast,
            set_ups: judged.into_iter().flatten().collect::<Result<_, _>>()?,
        };
        verification.write(directory)?;
        Ok(Some(verification))
    }

    /// Directories of the items: family/name, numbered if two would be the same.
    fn places(&self) -> Vec<String> {
        let mut places: Vec<String> = Vec::new();
        for item in &self.items {
            let first = format!("{}/{}", item.family, item.name);
            let numbered = (2..).map(|n| format!("{first}-{n}"));
            let mut possible = std::iter::once(first.clone()).chain(numbered);
            places.extend(possible.find(|place| !places.contains(place)));
        }
        places
    }
}

/// The longest run first, so that all jobs are busy until the end; or set-up by set-up, the
/// shortest first, so that a miss is found early.
fn order(units: &[Unit], items: usize, shortest_first: bool) -> Vec<usize> {
    let mut order: Vec<usize> = (0..units.len()).collect();
    let mut works = vec![0.0; items];
    units.iter().for_each(|unit| works[unit.item] += unit.case.work());
    let rank = |i: usize| {
        if shortest_first { works[units[i].item] } else { -units[i].case.work() }
    };
    order.sort_by(|a, b| rank(*a).total_cmp(&rank(*b)));
    order
}

/// A case that, unless `whole`, writes only its history, which is bitwise the same.
fn bare(mut case: Case, whole: bool) -> Case {
    if !whole {
        case.output.fields_every = Some(0);
        case.output.at_times.clear();
        case.output.checkpoint_every = usize::MAX;
    }
    case
}

impl Item {
    fn units(&self, item: usize, directory: &Path, whole: bool) -> Result<Vec<Unit>, StudyError> {
        let name = format!("{}/{}", self.family, self.name);
        match &self.kind {
            Kind::Case(case, source) => Ok(vec![Unit {
                item,
                name,
                directory: directory.to_owned(),
                case: bare((**case).clone(), whole),
                source: source.clone(),
            }]),
            Kind::Study(plan) => {
                let path = directory.join("arms");
                std::fs::create_dir_all(&path).map_err(RecordError::io("create", &path))?;
                of_arms(&plan.manifest).write(directory)?;
                let arms = plan.arms.iter().zip(&plan.manifest.arms);
                let units = arms.map(|(planned, arm)| Unit {
                    item,
                    name: format!("{name}, {}", arm.name),
                    directory: directory.join(&arm.directory),
                    case: bare(planned.case.clone(), whole),
                    source: plan.manifest.source_of(arm),
                });
                Ok(units.collect())
            }
        }
    }

    /// Compares the records of a case or study with its expectations.
    fn judged(&self, root: &Path, place: &str, wall: f64, fast: bool) -> Result<SetUp, StudyError> {
        let directory = root.join(place);
        let row = |arm: Option<&str>, directory: String, verdict: Expectation| Row {
            arm: arm.map(str::to_owned),
            directory,
            verdict,
        };
        let mut set_up = SetUp {
            family: self.family.clone(),
            name: self.name.clone(),
            file: self.file.display().to_string(),
            directory: place.to_owned(),
            runs: 1,
            wall,
            ..SetUp::default()
        };
        match &self.kind {
            Kind::Case(case, _) => {
                let run = Run::open(&directory)?;
                set_up.title.clone_from(&case.title);
                set_up.input_hash.clone_from(&run.manifest.input_hash);
                set_up.contact = run.had_dynamic_contact();
                if run.manifest.status == Status::Failed
                    && !case.expects.iter().any(Expect::asks_whether_stopped)
                {
                    set_up.stopped.push(run.manifest.reason.clone().unwrap_or_default());
                }
                set_up.rows =
                    judge(&run, &case.expects).into_iter().map(|v| row(None, place.to_owned(), v)).collect();
            }
            Kind::Study(plan) => {
                let manifest = StudyManifest { status: Status::Finished, ..of_arms(&plan.manifest) };
                manifest.write(&directory)?;
                let study = Study::open(&directory, &mut |_, _| ())?;
                study.write_tables()?;
                set_up.title.clone_from(&manifest.title);
                set_up.input_hash.clone_from(&manifest.input_hash);
                set_up.runs = manifest.arms.len();
                set_up.contact = study.rows.iter().any(|r| r.contact);
                for (arm, found) in manifest.arms.iter().zip(&study.rows) {
                    if found.status == Some(Status::Failed) && !stop_expected(&manifest, arm) {
                        let reason = found.reason.as_deref().unwrap_or_default();
                        set_up.stopped.push(format!("\"{}\": {reason}", arm.name));
                    }
                    let place = format!("{place}/{}", arm.directory);
                    let of_arm = found.expectations.iter().cloned();
                    set_up.rows.extend(of_arm.map(|v| row(Some(&arm.name), place.clone(), v)));
                }
                set_up.rows.extend(study.expectations.into_iter().map(|v| row(None, place.to_owned(), v)));
            }
        }
        set_up.rows.retain(|row| !(fast && row.verdict.slow));
        Ok(set_up)
    }
}

/// A study without its ensemble.
fn of_arms(manifest: &StudyManifest) -> StudyManifest {
    StudyManifest { ensemble: None, members: Vec::new(), ..manifest.clone() }
}

/// Whether an expectation of the arm, or one of the study about the arm, depends on `stopped`.
fn stop_expected(manifest: &StudyManifest, arm: &Arm) -> bool {
    let name = Some(arm.name.as_str());
    let about = |e: &Expect| {
        Question::parse(&e.what).is_ok_and(|q| q.asks_whether_stopped() && q.arms().contains(&name))
    };
    arm.facts.expects.iter().any(Expect::asks_whether_stopped) || manifest.expects.iter().any(about)
}
