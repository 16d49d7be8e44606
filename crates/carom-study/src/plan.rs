//! Reads and checks a study: the case of every arm is resolved, and its model built, before
//! anything is written.

use std::collections::BTreeMap;
use std::path::Path;

use carom_record::study::design::{Design, Goal};
use carom_record::study::{Arm, Claim, StudyManifest, StudySource};
use carom_record::{Machine, Source, Status, Warning, now};
use carom_run::case::{Case, CaseError, Document};

use crate::arms::{self, Draft};
use crate::comparable;
use crate::expects;
use crate::file::{self, ClaimKeys, StudyFile};
use crate::goals;
use crate::names;
use crate::resolved::{Checked, Planned, bases};

/// A study that can be started.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Manifest of the study, to be written as `study.json`.
    pub manifest: StudyManifest,
    /// Simulations of the study, one per arm.
    pub arms: Vec<PlannedArm>,
}

/// A simulation of a study.
#[derive(Clone, Debug)]
pub struct PlannedArm {
    /// Resolved case of the simulation.
    pub case: Case,
    /// The warnings that the case and its model give.
    pub warnings: Vec<Warning>,
}

impl Plan {
    /// The warnings that the cases of all arms give before they run, each once, with the numbers of
    /// the arms.
    pub fn warnings(&self) -> Vec<(&Warning, Vec<usize>)> {
        Warning::shared(self.arms.iter().map(|arm| &arm.warnings[..]))
    }

    /// Reads a study file and its cases.
    ///
    /// # Errors
    /// As [`Self::of`].
    pub fn read(path: &Path) -> Result<Self, CaseError> {
        Self::of(&Document::open(path, &[])?, path.parent().unwrap_or(Path::new("")))
    }

    /// Plans a study from a file that has been read; the paths of its cases are relative to
    /// `folder`.
    ///
    /// # Errors
    /// All problems, with their places in the study file, or in the case file for problems that it
    /// has without any arm.
    pub fn of(study: &Document, folder: &Path) -> Result<Self, CaseError> {
        Self::with_case(study, folder, None)
    }

    /// The cases of all arms, without those of a computed reference and the members of an ensemble;
    /// no model is built.
    ///
    /// # Errors
    /// As [`Self::of`], as far as there are such without models.
    pub fn cases(study: &Document, folder: &Path) -> Result<Vec<Case>, CaseError> {
        let (file, drafts, bases) = opened(study, folder, None)?;
        let mut checked = Checked::new(study, &file, &bases);
        let cases = checked.read(&drafts)?;
        checked.end().map(|()| cases)
    }

    /// As [`Self::of`], with a case that has been read and need not be a file; it takes the place
    /// of the case file of its name.
    ///
    /// # Errors
    /// As [`Self::of`].
    pub fn with_case(study: &Document, folder: &Path, case: Option<&Document>) -> Result<Self, CaseError> {
        let (file, drafts, bases) = opened(study, folder, case)?;
        let mut problems = Vec::new();
        let mut checked = Checked::new(study, &file, &bases);
        // A misspelt key of one arm is told before the models of the others are built.
        checked.read(&drafts)?;
        checked.end()?;
        let planned = checked.arms(drafts)?;
        expects::check(&file, &planned, &mut problems);
        goals::check(&file, &planned, &mut problems);
        comparable::check(&file, &planned, &mut problems);
        checked.problems(&problems)?;
        checked.end()?;
        let members = checked.members(&planned)?;
        checked.end()?;
        let manifest = manifest(study, file, &bases, &planned, members);
        let arm = |Planned { case, warnings, .. }| PlannedArm { case, warnings };
        Ok(Self { manifest, arms: planned.into_iter().map(arm).collect() })
    }
}

/// A study file that has been read, its arms, and the case files that they change.
fn opened(
    study: &Document,
    folder: &Path,
    case: Option<&Document>,
) -> Result<(StudyFile, Vec<Draft>, BTreeMap<String, Document>), CaseError> {
    let mut problems = Vec::new();
    let mut file = file::read(study, folder, &mut problems);
    if let Some(problem) = arms::too_many(&file, study.text().len()) {
        return Err(study.diagnose_all(&[problem]));
    }
    let drafts = arms::all(&file);
    // Parts that could not be read would give misleading errors about unknown names.
    if problems.is_empty() {
        names::resolve(&mut file, &drafts);
        names::check(&file, &drafts, &mut problems);
    }
    if !problems.is_empty() {
        return Err(study.diagnose_all(&problems));
    }
    let bases = bases(study, folder, case, &file, &drafts)?;
    Ok((file, drafts, bases))
}

fn manifest(
    study: &Document,
    file: StudyFile,
    bases: &BTreeMap<String, Document>,
    planned: &[Planned],
    members: Vec<Arm>,
) -> StudyManifest {
    let stem = Path::new(study.name()).file_stem();
    let stem = stem.map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let main = file.case.clone().unwrap_or_default();
    let text = |(name, base): (&String, &Document)| (name.clone(), base.text().to_owned());
    let mut cases: BTreeMap<String, String> = bases.iter().map(text).collect();
    let source = StudySource {
        study: study.text().to_owned(),
        case: cases.remove(&main).unwrap_or_default(),
        others: cases,
        case_path: main,
    };
    let texts = std::iter::once(source.case.clone()).chain(source.others.values().cloned());
    let input_hash = Source { text: source.study.clone(), sets: texts.collect(), ..Source::default() }.hash();
    let arm =
        |(i, p): (usize, &Planned)| p.stored(format!("arms/{:02}-{}", i + 1, arms::slug(&p.draft.name)));
    let design = file.design.map(|kind| {
        let cost_of = arms::cost_of(&file).unwrap_or_default();
        let steps = if file.steps.is_empty() {
            planned.first().map(|p| p.case.time.step).into_iter().collect()
        } else {
            file.steps.clone()
        };
        Design { kind, cost_of, steps }
    });
    StudyManifest {
        goal: file.goal.or(design.as_ref().map(|_| Goal::Trajectory)),
        design,
        accuracy: file.accuracy,
        window: file.window,
        status: Status::Running,
        title: file.title.unwrap_or(stem),
        version: env!("CARGO_PKG_VERSION").into(),
        input_hash,
        created: now(),
        machine: Machine::current(),
        reference: file.reference,
        arms: planned.iter().enumerate().map(arm).collect(),
        ensemble: file.ensemble,
        members,
        overlays: file.overlays,
        claims: file.claims.into_iter().map(|ClaimKeys { text, compare }| Claim { text, compare }).collect(),
        expects: file.expects,
        source,
    }
}
