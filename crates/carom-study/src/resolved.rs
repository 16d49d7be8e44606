//! The cases of a study: that of every arm is resolved, and its model built once; what is wrong is
//! reported at its place in the study, or in the case file if it is wrong without any arm.

use std::collections::BTreeMap;
use std::path::Path;

use carom_record::Warning;
use carom_record::study::Arm;
use carom_run::case::{Case, CaseError, Diagnostic, Document, Problem, read};
use carom_run::{Setup, warnings};

use crate::arms::{self, Draft};
use crate::file::{FINE_NAME, StudyFile};

/// An arm whose case is valid.
pub(crate) struct Planned {
    pub(crate) draft: Draft,
    pub(crate) case: Case,
    pub(crate) warnings: Vec<Warning>,
}

/// The case files of a study, by their names in it.
pub(crate) fn bases(
    study: &Document,
    folder: &Path,
    given: Option<&Document>,
    file: &StudyFile,
    drafts: &[Draft],
) -> Result<BTreeMap<String, Document>, CaseError> {
    let mut bases = BTreeMap::new();
    let named = drafts.iter().map(|d| (d.case.as_ref(), format!("{}.case", d.path)));
    for (name, place) in std::iter::once((file.case.as_ref(), "case".to_owned())).chain(named) {
        if let Some(name) = name.filter(|name| !bases.contains_key(*name)) {
            let base = match given.filter(|case| case.name() == name) {
                Some(case) => case.clone(),
                None => base(study, folder, name, &place)?,
            };
            bases.insert(name.clone(), base);
        }
    }
    Ok(bases)
}

/// The check of the arms of a study, and the problems found so far.
pub(crate) struct Checked<'a> {
    study: &'a Document,
    file: &'a StudyFile,
    bases: &'a BTreeMap<String, Document>,
    found: Vec<Diagnostic>,
}

impl<'a> Checked<'a> {
    pub(crate) fn new(
        study: &'a Document,
        file: &'a StudyFile,
        bases: &'a BTreeMap<String, Document>,
    ) -> Self {
        Self { study, file, bases, found: Vec::new() }
    }

    /// The case file of a draft.
    fn base_of(&self, draft: &Draft) -> Option<&'a Document> {
        let name = draft.case.as_ref().or(self.file.case.as_ref())?;
        self.bases.get(name)
    }

    /// Adds problems of the study file.
    pub(crate) fn problems(&mut self, problems: &[Problem]) -> Result<(), CaseError> {
        self.found.extend(diagnostics(self.study.diagnose_all(problems))?);
        Ok(())
    }

    /// Ends a stage of the check: an error if problems have been found.
    pub(crate) fn end(&mut self) -> Result<(), CaseError> {
        let found = std::mem::take(&mut self.found);
        if found.is_empty() { Ok(()) } else { Err(CaseError::Wrong(found)) }
    }

    /// Reads the cases of drafts without building their models; adds their problems.
    pub(crate) fn read(&mut self, drafts: &[Draft]) -> Result<Vec<Case>, CaseError> {
        let mut cases = Vec::new();
        for draft in drafts {
            let Some(base) = self.base_of(draft) else { continue };
            match read_with(base.name(), base.text(), &changes(draft)) {
                Ok((_, case)) => cases.push(case),
                Err(error) => self.add(draft, base, error, read_with)?,
            }
        }
        Ok(cases)
    }

    /// A draft with its case and warnings; none if the case is wrong.
    fn planned(&mut self, draft: Draft) -> Result<Option<Planned>, CaseError> {
        let Some(base) = self.base_of(&draft) else { return Ok(None) };
        match resolved(base.name(), base.text(), &changes(&draft)) {
            Ok((case, warnings)) => Ok(Some(Planned { draft, case, warnings })),
            Err(error) => self.add(&draft, base, error, resolved).map(|()| None),
        }
    }

    /// Adds the diagnostics in `error` of a draft, at its place in the study. `of` is the reader
    /// that returned the error; it is called again without changes, to find the problems that the
    /// case itself has.
    fn add<T>(
        &mut self,
        draft: &Draft,
        base: &Document,
        error: CaseError,
        of: impl Fn(&str, &str, &[String]) -> Result<T, CaseError>,
    ) -> Result<(), CaseError> {
        let found = diagnostics(error)?;
        let own = of(base.name(), base.text(), &[]).err().map_or_else(|| Ok(Vec::new()), diagnostics)?;
        let of_others = self.found.len();
        for diagnostic in found {
            let placed = arms::placed(self.study, draft, &diagnostic, &own);
            // A mistake that several arms make at one place of the study is reported for the first.
            let place = |of: &Diagnostic| (of.file.clone(), of.line, of.column);
            let alike = |known: &Diagnostic| {
                place(known) == place(&placed) && known.what == placed.what && known.help == placed.help
            };
            if !self.found[..of_others].iter().any(alike) && !self.found.contains(&placed) {
                self.found.push(placed);
            }
        }
        Ok(())
    }

    /// The arms, then the runs of the computed reference, whose step depends on those of all arms.
    pub(crate) fn arms(&mut self, drafts: Vec<Draft>) -> Result<Vec<Planned>, CaseError> {
        let is_asked = self.file.reference.as_deref() == Some(FINE_NAME);
        let is_computed = is_asked && drafts.iter().all(|draft| draft.name != FINE_NAME);
        let count = drafts.len();
        let mut planned = Vec::new();
        for draft in drafts {
            planned.extend(self.planned(draft)?);
        }
        if is_computed && planned.len() == count {
            let step = planned.iter().map(|p| p.case.time.step).fold(f64::INFINITY, f64::min);
            let is_static = planned.iter().all(|p| p.case.time.scheme.is_static());
            match arms::fine(self.file, &planned[0].case, step, is_static) {
                Some(levels) => {
                    for draft in levels {
                        planned.extend(self.planned(draft)?);
                    }
                }
                None => {
                    self.found.push(self.study.diagnose(&Problem::new(
                        "fine.mesh",
                        "no steps of the reference are in the ratios of these factors",
                        "step and mesh are refined together, and every step divides the end time",
                        "choose simple ratios, for example `mesh = [1, 1.5, 2]`",
                    )));
                }
            }
        }
        Ok(planned)
    }

    /// The members of all arms, except for the arms themselves.
    pub(crate) fn members(&mut self, planned: &[Planned]) -> Result<Vec<Arm>, CaseError> {
        let Some(ensemble) = &self.file.ensemble else { return Ok(Vec::new()) };
        let mut members = Vec::new();
        for (i, arm) in planned.iter().enumerate() {
            let all = arms::members(ensemble, i, &arm.draft, &arm.case).into_iter();
            for (j, draft) in all.enumerate() {
                let directory = format!("members/{:02}-{:03}", i + 1, j + 1);
                members.extend(self.planned(draft)?.map(|member| member.stored(directory)));
            }
        }
        let is_swapped = |run: &Arm| run.role.member.is_some_and(|of| of.member.swapped);
        if ensemble.swapped && self.found.is_empty() && !members.iter().any(is_swapped) {
            self.found.push(self.study.diagnose(&Problem::new(
                "ensemble.swapped",
                "no contact has sides that can be swapped",
                "only two sides of bodies can be swapped, not a side and a rigid primary or itself",
                "leave `swapped` out",
            )));
        }
        Ok(members)
    }
}

impl Planned {
    /// Record of an arm in `study.json`.
    pub(crate) fn stored(&self, directory: String) -> Arm {
        Arm {
            name: self.draft.name.clone(),
            directory,
            sets: self.draft.sets.iter().map(|(set, _)| set.clone()).collect(),
            steps: self.case.time.steps() as u64,
            role: self.draft.role.clone(),
            case_path: self.draft.case.clone(),
            facts: self.case.facts(),
            case: self.case.to_json().unwrap_or_default(),
        }
    }
}

/// The changes of a draft, with its expectations.
fn changes(draft: &Draft) -> Vec<String> {
    draft.sets.iter().map(|(set, _)| set.clone()).chain([draft.expectations()]).collect()
}

/// Reads the case file `name`; errors are reported at `place` of the study.
fn base(study: &Document, folder: &Path, name: &str, place: &str) -> Result<Document, CaseError> {
    let path = folder.join(name);
    Document::open(&path, &[]).map_err(|error| match error {
        CaseError::Wrong(found) if !path.is_file() => {
            let what = format!("the case `{name}` cannot be read: {}", found[0].what);
            let why = "the path is relative to the study file";
            study.diagnose_all(&[Problem::new(place, what, why, "correct the path")])
        }
        error => error,
    })
}

/// A case with changes, and its warnings; its model is built once, to find what only the model
/// shows. Its text is read once: a pipe cannot be read again.
pub(crate) fn resolved(name: &str, text: &str, sets: &[String]) -> Result<(Case, Vec<Warning>), CaseError> {
    let (document, case) = read_with(name, text, sets)?;
    let simulation = Setup::new(&case).start().map_err(|problems| document.diagnose_all(&problems))?;
    let given = warnings(&case, simulation.model());
    Ok((case, given))
}

/// A case with changes, of which no model is built.
fn read_with(name: &str, text: &str, sets: &[String]) -> Result<(Document, Case), CaseError> {
    let document = Document::parse(name, text, sets)?;
    let case = read(&document).map_err(|problems| document.diagnose_all(&problems))?;
    Ok((document, case))
}

/// The diagnostics of a wrong case; input/output and system errors are returned as errors.
fn diagnostics(error: CaseError) -> Result<Vec<Diagnostic>, CaseError> {
    match error {
        CaseError::Wrong(found) => Ok(found),
        error @ CaseError::Refused { .. } => Err(error),
    }
}
