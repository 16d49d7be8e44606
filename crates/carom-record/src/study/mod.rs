//! Study directories, and their tables as functions of the records alone.
//!
//! ```text
//! runs/paper/study.json              what is compared: arms with their cases, claims, the files as given
//!            arms/01-hu/ …           one run directory per arm
//!            study.csv               one row per arm, one column per metric
//!            study_tidy.csv          arm,metric,value,unit
//!            checks.json             one arm computed again with more threads, and resumed (in a study with a goal)
//!            claims.csv              claims with both numbers and the verdict
//!            study.html figures/     the page
//! ```

mod alike;
#[doc(hidden)]
pub mod arm;
mod arms;
pub mod checks;
mod claim;
pub mod compared;
#[doc(hidden)]
pub mod convergence;
pub mod design;
mod digits;
pub mod ensemble;
mod exact;
#[doc(hidden)]
pub mod groups;
mod known;
#[doc(hidden)]
pub mod latex;
#[doc(hidden)]
pub mod levels;
mod manifest;
#[doc(hidden)]
pub mod measure;
#[doc(hidden)]
pub mod orders;
mod ranked;
pub mod ranking;
pub mod reference;
mod reference_of;
#[doc(hidden)]
pub mod roles;
mod row;
#[doc(hidden)]
pub mod systems;
mod tables;
#[doc(hidden)]
pub mod trajectory;
#[doc(hidden)]
pub mod verdict;

use std::path::{Path, PathBuf};

use crate::metrics::Metric;
use crate::{Expectation, Reason, RecordError, Run, Status, Warning};
pub use arm::{Arm, count, scalar, sets_step, step};
pub use arms::ArmRecords;
use checks::Checks;
pub use claim::{Claim, Comparison, Confirmed, Verdict};
use compared::{Compared, PhaseOrders, orders_by_phase};
use design::{Goal, MemberOf};
use ensemble::{Ensemble, Spread};
pub use manifest::{StudyManifest, StudySource};
use measure::standing;
pub use orders::{Refinement, Sought, refined_keys};
use ranking::{Ranking, Ranks};
use reference::{Established, Reference, Trajectory};
pub use row::Row;
use systems::Systems;

/// A study that has been read.
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    /// Path of the study directory.
    pub directory: PathBuf,
    /// The manifest of the study.
    pub manifest: StudyManifest,
    /// Results of the arms, one row per arm.
    pub rows: Vec<Row>,
    /// Results of the members of ensembles, one row per member, in the order of the manifest.
    pub members: Vec<Row>,
    /// Outcomes of the claims, one per claim.
    pub verdicts: Vec<Verdict>,
    /// Outcomes of the expectations of the study as a whole; an order may have one per group of
    /// arms.
    pub expectations: Vec<Expectation>,
    /// The reference that arms are compared with, if it has finished.
    pub reference: Option<Reference>,
    /// The comparison of each arm with the reference.
    pub compared: Vec<Option<Compared>>,
    /// Orders of the methods of a design, in smooth phases and across the impact.
    pub phase_orders: Vec<PhaseOrders>,
    /// The ranking, if the study has a goal.
    pub ranking: Option<Ranking>,
    /// The rankings for the other goals.
    pub other_rankings: Vec<Ranking>,
    /// Checks of one arm, which was computed two more times.
    pub checks: Option<Checks>,
    /// The systems of units of the arms.
    pub systems: Systems,
}

impl Study {
    /// The warnings of all arms, each once, with the numbers of the arms that gave it.
    pub fn warnings(&self) -> Vec<(&Warning, Vec<usize>)> {
        Warning::shared(self.rows.iter().map(|row| &row.warnings[..]))
    }

    /// The number of the recommended arm, if there is one.
    pub fn recommended(&self) -> Option<usize> {
        Some(self.ranking.as_ref()?.verdict.as_ref().ok()?.arm)
    }

    /// Reads a study arm by arm, with only one record in memory at a time. `visit` is called for
    /// every arm that has a record, in the units of the first arm. An arm whose record is damaged
    /// is a row with the reason.
    ///
    /// # Errors
    /// Input/output or system error, or no study.
    pub fn open(directory: &Path, visit: &mut dyn FnMut(usize, &Run)) -> Result<Self, RecordError> {
        let manifest = StudyManifest::read(directory)?;
        let comparisons: Vec<_> =
            manifest.claims.iter().map(|c| Comparison::parse(&c.compare).ok()).collect();
        let mut needs = orders::needs(&manifest);
        needs.questions.extend(comparisons.iter().flatten().flat_map(Comparison::questions).cloned());
        // Of the arms, and of each member of the ensemble, the arms being the first.
        let kinds = manifest.ensemble.as_ref().map_or_else(Vec::new, Ensemble::members);
        let mut records = vec![ArmRecords::default(); kinds.len().max(1)];
        let reference = manifest.reference(directory)?;
        let contact = reference.as_ref().and_then(|r| {
            let time = |name: &str| r.metric(name).ok().map(|known| known.value);
            time("contact_start").zip(time("contact_end"))
        });
        let mut rows = Vec::new();
        let mut compared = Vec::new();
        let mut systems = Systems::of(&manifest);
        for (i, arm) in manifest.runs().enumerate() {
            let record = match manifest.record(directory, arm) {
                Err(error) if !error.is_system() => Err(Row::damaged(arm, &error, directory)),
                record => record?.ok_or_else(|| Row { name: arm.name.clone(), ..Row::default() }),
            };
            let mut run = match record {
                Ok(run) => run,
                Err(row) => {
                    rows.push(row);
                    compared.push(None);
                    continue;
                }
            };
            let mut row = Row::of(arm, &run, &manifest.overlays);
            let of_kind = |of: MemberOf| {
                let kind = kinds.iter().position(|kind| *kind == of.member)?;
                Some((kind, &manifest.arms[of.arm].name))
            };
            // Claims and expectations refer to the numbers of the record, in its own units.
            if let Some((kind, name)) = arm.role.member.map_or(Some((0, &arm.name)), of_kind) {
                records[kind].gather(name, &run, &row.metrics, &needs);
            }
            systems.convert(i, &mut run, &mut row);
            if i < manifest.arms.len() {
                visit(i, &run);
            }
            let other = reference.as_ref().filter(|_| row.status == Some(Status::Finished));
            compared.push(other.map(|r| Compared::of(&Trajectory::of(&run, &[]), arm, r, contact)));
            rows.push(row);
        }
        let verdicts = manifest
            .claims
            .iter()
            .zip(&comparisons)
            .map(|(claim, c)| Verdict::of(claim, c.as_ref(), &records[0], &records));
        let judged = manifest.expects.iter().flat_map(|expect| match &expect.order {
            Some(order) => orders::judge(expect, order, &manifest, &records[0], reference.as_ref()),
            None => vec![expect.verdict(expect.got(&records[0]))],
        });
        let expectations = judged.collect();
        let verdicts = verdicts.collect();
        let ranks =
            Ranks { manifest: &manifest, rows: &rows, compared: &compared, reference: reference.as_ref() };
        let ranking_of = |goal| ranks.of(goal);
        let ranking = manifest.goal.map(ranking_of);
        let rubs = rows.iter().any(|row| row.value("friction_lost").is_some());
        let others = Goal::all().filter(|goal| {
            manifest.goal.is_some_and(|own| own != *goal) && (rubs || *goal != Goal::Friction)
        });
        let other_rankings: Vec<Ranking> = others.map(ranking_of).collect();
        let members = rows.split_off(manifest.arms.len());
        compared.truncate(manifest.arms.len());
        let phase_orders =
            reference.as_ref().map(|r| orders_by_phase(&manifest, &compared, r)).unwrap_or_default();
        let checks = Checks::read(directory)?;
        let directory = directory.to_path_buf();
        Ok(Self {
            directory,
            manifest,
            rows,
            members,
            verdicts,
            expectations,
            reference,
            compared,
            phase_orders,
            ranking,
            other_rankings,
            checks,
            systems,
        })
    }

    /// The reference value of a metric.
    ///
    /// # Errors
    /// The reason why there is none.
    pub fn standing(&self, metric: &str) -> Result<Established, Reason> {
        standing(self.reference.as_ref(), &self.rows, metric)
    }

    /// The values of a metric over the members of an arm's ensemble, the arm included.
    pub fn spread(&self, arm: usize, metric: &str) -> Option<Spread> {
        let row = |run: usize| self.rows.get(run).or_else(|| self.members.get(run - self.rows.len()));
        let runs = self.manifest.runs_of(arm);
        Spread::of(runs.into_iter().filter_map(|run| row(run)?.value(metric)))
    }

    /// Every metric that an arm has, in order: name, unit, definition.
    pub fn metrics(&self) -> Vec<&Metric> {
        let mut found: Vec<&Metric> = Vec::new();
        for metric in self.rows.iter().flat_map(|row| &row.metrics) {
            if !found.iter().any(|m| m.name == metric.name) {
                found.push(metric);
            }
        }
        found
    }
}
