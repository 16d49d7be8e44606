//! Reads and checks a study: the case of every arm is resolved, and its model built, before
//! anything is written.

use std::collections::BTreeMap;
use std::path::Path;

use carom_record::study::design::{Design, Goal, MemberOf, Role};
use carom_record::study::{Arm, Comparison, StudyManifest, StudySource};
use carom_record::{Machine, Source, Status, Warning, now};
use carom_run::case::{Case, CaseError, Diagnostic, Document, Problem, read};
use carom_run::{Setup, warnings};

use crate::arms::{self, Draft};
use crate::expects;
use crate::file::{self, StudyFile};

/// A study that can be started.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The manifest.
    pub manifest: StudyManifest,
    /// Its simulations.
    pub arms: Vec<PlannedArm>,
}

/// A simulation of a study.
#[derive(Clone, Debug)]
pub struct PlannedArm {
    /// The case.
    pub case: Case,
    /// Text of the case file, and changes.
    pub source: Source,
    /// The warnings that the case and its model give.
    pub warnings: Vec<Warning>,
}

impl Plan {
    /// The warnings that the cases of all arms give before they run, each once, with the numbers of
    /// the arms.
    pub fn warnings(&self) -> Vec<(&Warning, Vec<usize>)> {
        let given = self.arms.iter().enumerate();
        Warning::shared(given.flat_map(|(arm, planned)| planned.warnings.iter().map(move |w| (arm, w))))
    }

    /// Reads a study file and its cases.
    ///
    /// # Errors
    /// As [`Self::of`].
    pub fn read(path: &Path) -> Result<Self, CaseError> {
        Self::of(&Document::open(path, &[])?, path.parent().unwrap_or(Path::new("")))
    }

    /// Of a study file that has been read; the paths of its cases start at `folder`.
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
        let mut checked = Checked { study, found: Vec::new() };
        let cases = checked.read(&file, &drafts, &bases)?;
        checked.end().map(|()| cases)
    }

    /// As [`Self::of`], with a case that has been read, and need not be a file: that of its name.
    ///
    /// # Errors
    /// As [`Self::of`].
    pub fn with_case(study: &Document, folder: &Path, case: Option<&Document>) -> Result<Self, CaseError> {
        let (file, drafts, bases) = opened(study, folder, case)?;
        let mut problems = Vec::new();
        let mut checked = Checked { study, found: Vec::new() };
        // A misspelt key of one arm is told before the models of the others are built.
        checked.read(&file, &drafts, &bases)?;
        checked.end()?;
        let planned = checked.arms(&file, drafts, &bases)?;
        let known: Vec<(&str, &Case)> = planned.iter().map(|p| (p.draft.name.as_str(), &p.case)).collect();
        expects::overlays(&file.overlays, &known, &mut problems);
        expects::check(&file.expects, &file.overlays, &known, &mut problems);
        checked.found.extend(diagnostics(study.diagnose_all(&problems))?);
        checked.end()?;
        let members = checked.members(&file, &planned)?;
        checked.end()?;
        let manifest = manifest(study, file, &bases, &planned, members);
        let arm = |p: Planned| PlannedArm {
            case: p.case,
            source: Source { text: p.base.text.clone(), sets: p.sets, folder: None },
            warnings: p.warnings,
        };
        Ok(Self { manifest, arms: planned.into_iter().map(arm).collect() })
    }
}

/// Changes of a case, the case and its warnings.
type Resolved = (Vec<String>, Case, Vec<Warning>);

/// An arm whose case is valid.
struct Planned<'a> {
    draft: Draft,
    sets: Vec<String>,
    case: Case,
    warnings: Vec<Warning>,
    base: &'a Base,
}

/// A study file that has been read, its arms, and the case files that they change.
fn opened(
    study: &Document,
    folder: &Path,
    case: Option<&Document>,
) -> Result<(StudyFile, Vec<Draft>, BTreeMap<String, Base>), CaseError> {
    let mut problems = Vec::new();
    let file = file::read(study, folder, &mut problems);
    let drafts = arms::all(&file);
    // Parts that could not be read would give misleading errors about unknown names.
    if problems.is_empty() {
        names(&file, &drafts, &mut problems);
    }
    if !problems.is_empty() {
        return Err(study.diagnose_all(&problems));
    }
    let bases = bases(study, folder, case, &file, &drafts)?;
    Ok((file, drafts, bases))
}

/// The case files of a study, by their names in it.
fn bases(
    study: &Document,
    folder: &Path,
    given: Option<&Document>,
    file: &StudyFile,
    drafts: &[Draft],
) -> Result<BTreeMap<String, Base>, CaseError> {
    let mut bases = BTreeMap::new();
    let named = drafts.iter().map(|d| (d.case.as_ref(), format!("{}.case", d.path)));
    for (name, place) in std::iter::once((file.case.as_ref(), "case".to_owned())).chain(named) {
        if let Some(name) = name.filter(|name| !bases.contains_key(*name)) {
            let base = match given.filter(|case| case.name() == name) {
                Some(case) => Base::of(case),
                None => Base::read(study, folder, name, &place)?,
            };
            bases.insert(name.clone(), base);
        }
    }
    Ok(bases)
}

/// The check of the arms of a study, and the problems found so far.
struct Checked<'a> {
    study: &'a Document,
    found: Vec<Diagnostic>,
}

impl Checked<'_> {
    /// An error if there are problems.
    fn end(&mut self) -> Result<(), CaseError> {
        let found = std::mem::take(&mut self.found);
        if found.is_empty() { Ok(()) } else { Err(CaseError::Wrong(found)) }
    }

    /// The cases of drafts; their models are not built.
    fn read(
        &mut self,
        file: &StudyFile,
        drafts: &[Draft],
        bases: &BTreeMap<String, Base>,
    ) -> Result<Vec<Case>, CaseError> {
        let mut cases = Vec::new();
        for draft in drafts {
            let Some(base) = base_of(file, draft, bases) else { continue };
            match read_with(&base.name, &base.text, &changes(draft)) {
                Ok((_, case)) => cases.push(case),
                Err(error) => self.add(draft, base, error, read_with)?,
            }
        }
        Ok(cases)
    }

    /// The changes of a draft, its case and warnings; none if the case is wrong.
    fn resolved(&mut self, draft: &Draft, base: &Base) -> Result<Option<Resolved>, CaseError> {
        let mut sets = changes(draft);
        match resolved(&base.name, &base.text, &sets) {
            Ok((case, warnings)) => {
                sets.pop();
                Ok(Some((sets, case, warnings)))
            }
            Err(error) => self.add(draft, base, error, resolved).map(|()| None),
        }
    }

    /// Adds what is wrong with a draft, at its place in the study.
    /// `of` gives what was wrong, and is asked the same of the case without changes.
    fn add<T>(
        &mut self,
        draft: &Draft,
        base: &Base,
        error: CaseError,
        of: impl Fn(&str, &str, &[String]) -> Result<T, CaseError>,
    ) -> Result<(), CaseError> {
        let found = diagnostics(error)?;
        let own = of(&base.name, &base.text, &[]).err().map_or_else(|| Ok(Vec::new()), diagnostics)?;
        for diagnostic in found {
            let placed = arms::placed(self.study, draft, &diagnostic, &own);
            if !self.found.contains(&placed) {
                self.found.push(placed);
            }
        }
        Ok(())
    }

    /// The arms, then the runs of the computed reference, whose step depends on those of all arms.
    fn arms<'a>(
        &mut self,
        file: &StudyFile,
        drafts: Vec<Draft>,
        bases: &'a BTreeMap<String, Base>,
    ) -> Result<Vec<Planned<'a>>, CaseError> {
        let (computed, count) = (arms::computes_reference(file, &drafts), drafts.len());
        let mut planned = Vec::new();
        self.plan(file, drafts, bases, &mut planned)?;
        if computed && planned.len() == count {
            let step = planned.iter().map(|p| p.case.time.step).fold(f64::INFINITY, f64::min);
            let first = &planned[0].case;
            match arms::fine(file, step, first.time.end, first.refine) {
                Some(levels) => self.plan(file, levels, bases, &mut planned)?,
                None => self.found.push(self.study.diagnose(&no_steps())),
            }
        }
        Ok(planned)
    }

    fn plan<'a>(
        &mut self,
        file: &StudyFile,
        drafts: Vec<Draft>,
        bases: &'a BTreeMap<String, Base>,
        planned: &mut Vec<Planned<'a>>,
    ) -> Result<(), CaseError> {
        for draft in drafts {
            if let Some(base) = base_of(file, &draft, bases)
                && let Some((sets, case, warnings)) = self.resolved(&draft, base)?
            {
                planned.push(Planned { draft, sets, case, warnings, base });
            }
        }
        Ok(())
    }

    /// The members of all arms, except for the arms themselves.
    fn members(&mut self, file: &StudyFile, planned: &[Planned]) -> Result<Vec<Arm>, CaseError> {
        let mut members = Vec::new();
        for (i, arm) in planned.iter().enumerate() {
            let all = file.ensemble.iter().flat_map(|e| arms::members(e, &arm.draft, &arm.case));
            for (j, (member, draft)) in all.enumerate() {
                let Some((sets, case, _)) = self.resolved(&draft, arm.base)? else { continue };
                let role = Role { member: Some(MemberOf { arm: i, member }), ..draft.role.clone() };
                let directory = format!("members/{:02}-{:03}", i + 1, j + 1);
                members.push(Arm { role, ..stored(&draft, directory, sets, &case) });
            }
        }
        Ok(members)
    }
}

/// The case file of a draft.
fn base_of<'a>(file: &StudyFile, draft: &Draft, bases: &'a BTreeMap<String, Base>) -> Option<&'a Base> {
    draft.case.as_ref().or(file.case.as_ref()).and_then(|name| bases.get(name))
}

/// The changes of a draft, the last of which are its expectations.
fn changes(draft: &Draft) -> Vec<String> {
    draft.sets.iter().map(|(set, _)| set).chain([&draft.expect.0]).cloned().collect()
}

/// A run as it is stored.
fn stored(draft: &Draft, directory: String, sets: Vec<String>, case: &Case) -> Arm {
    Arm {
        name: draft.name.clone(),
        directory,
        sets,
        steps: case.time.steps() as u64,
        role: draft.role.clone(),
        case_path: draft.case.clone(),
        case: serde_json::to_value(case).unwrap_or_default(),
    }
}

fn manifest(
    study: &Document,
    file: StudyFile,
    bases: &BTreeMap<String, Base>,
    planned: &[Planned],
    members: Vec<Arm>,
) -> StudyManifest {
    let stem = Path::new(study.name()).file_stem();
    let stem = stem.map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let text = |name: &String| bases.get(name).map(|base| base.text.clone()).unwrap_or_default();
    let main = file.case.clone().unwrap_or_default();
    let others = bases.keys().filter(|name| **name != main).map(|name| (name.clone(), text(name)));
    let source = StudySource {
        study: study.text().to_owned(),
        case: text(&main),
        others: others.collect(),
        case_path: main,
    };
    let texts = std::iter::once(source.case.clone()).chain(source.others.values().cloned());
    let input_hash = Source { text: source.study.clone(), sets: texts.collect(), folder: None }.hash();
    let arm = |(i, p): (usize, &Planned)| {
        let directory = format!("arms/{:02}-{}", i + 1, arms::slug(&p.draft.name));
        stored(&p.draft, directory, p.sets.clone(), &p.case)
    };
    let design = file.design.map(|kind| {
        let of = |level: usize| planned.iter().find(|p| p.draft.role.level == level && !p.draft.role.fine);
        let cost_of = file.cost_of.clone().or_else(|| of(0)?.draft.role.method.clone()).unwrap_or_default();
        let steps = if file.steps.is_empty() {
            of(0).map(|p| p.case.time.step).into_iter().collect()
        } else {
            file.steps.clone()
        };
        Design { kind, cost_of, steps }
    });
    StudyManifest {
        goal: file.goal.or(design.as_ref().map(|_| Goal::Trajectory)),
        design,
        accuracy: file.accuracy,
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
        claims: file.claims,
        expects: file.expects,
        source,
    }
}

/// The steps of the computed reference do not divide the end time in the ratios of its meshes.
fn no_steps() -> Problem {
    Problem::new(
        "fine.mesh",
        "no steps of the reference are in the ratios of these factors",
        "step and mesh are refined together, and every step divides the end time",
        "choose simple ratios, for example `mesh = [1, 1.5, 2]`",
    )
}

/// A case file that arms change.
struct Base {
    name: String,
    text: String,
}

impl Base {
    /// Reads the case file `name`; errors are reported at `place` of the study.
    fn read(study: &Document, folder: &Path, name: &str, place: &str) -> Result<Self, CaseError> {
        let path = folder.join(name);
        let document = Document::open(&path, &[]).map_err(|error| match error {
            CaseError::Wrong(found) if !path.is_file() => {
                let what = format!("the case `{name}` cannot be read: {}", found[0].what);
                let why = "the path is relative to the study file";
                study.diagnose_all(&[Problem::new(place, what, why, "correct the path")])
            }
            error => error,
        })?;
        Ok(Self::of(&document))
    }

    fn of(document: &Document) -> Self {
        Self { name: document.name().to_owned(), text: document.text().to_owned() }
    }
}

/// Checks the names of arms: that there are some, that they are unique, and that references to them
/// exist.
fn names(file: &StudyFile, drafts: &[Draft], problems: &mut Vec<Problem>) {
    if drafts.is_empty() {
        problems.push(Problem::new(
            "",
            "the study has no arms",
            "there is nothing to compare",
            "add an [[arm]] or a [grid]",
        ));
    }
    for (i, draft) in drafts.iter().enumerate() {
        if drafts[..i].iter().any(|d| d.name == draft.name) {
            let what = format!("two arms are named \"{}\"", draft.name);
            let path = if draft.path == "grid" { draft.path.clone() } else { format!("{}.name", draft.path) };
            problems.push(Problem::new(
                path,
                what,
                "tables, figures and claims identify arms by name",
                "rename one of them",
            ));
        }
    }
    if let Some(name) = &file.cost_of
        && !drafts.iter().any(|d| d.role.method.as_ref() == Some(name))
    {
        let methods: Vec<_> = file.arms.iter().map(|a| format!("\"{}\"", a.name)).collect();
        let why = format!("the methods are: {}", methods.join(", "));
        problems.push(Problem::new(
            "cost_of",
            format!("no method is named \"{name}\""),
            why,
            "use one of them",
        ));
    }
    let cost_of = file.cost_of.as_ref().or(drafts.first().and_then(|d| d.role.method.as_ref()));
    for (i, arm) in file.arms.iter().enumerate().filter(|(_, arm)| arm.by_cost && Some(&arm.name) == cost_of)
    {
        let what = format!("\"{}\" cannot match its own cost", arm.name);
        let why = "`match = \"cost\"` matches the cost of the arm `cost_of`, by default the first one, and this is that arm";
        let help = "give another arm in `cost_of`, or leave `match` out";
        problems.push(Problem::new(format!("arm[{i}].match"), what, why, help));
    }
    let known = || drafts.iter().map(|d| format!("\"{}\"", d.name)).collect::<Vec<_>>().join(", ");
    let exists = |name: &str| drafts.iter().any(|d| d.name == name);
    if let Some(reference) =
        file.reference.as_deref().filter(|name| !["exact", file::FINE_NAME].contains(name) && !exists(name))
    {
        let what = format!("the reference \"{reference}\" is not an arm");
        problems.push(Problem::new(
            "reference",
            what,
            format!("the arms are: {}", known()),
            "use one of them, \"exact\", or \"fine\" for a computed reference",
        ));
    }
    for (i, claim) in file.claims.iter().enumerate() {
        let path = format!("claim[{i}].compare");
        match Comparison::parse(&claim.compare) {
            Ok(comparison) => {
                for arm in comparison.arms().into_iter().filter(|arm| !exists(arm)) {
                    let what = format!("no arm is named \"{arm}\"");
                    problems.push(Problem::new(
                        &path,
                        what,
                        format!("the arms are: {}", known()),
                        "use one of them",
                    ));
                }
            }
            Err(why) => {
                let help = "write for example 'restitution of \"ARM\" > 1.1 * restitution of \"ARM\"'";
                problems.push(Problem::new(&path, "this is not a valid comparison", why, help));
            }
        }
    }
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
