//! Reads and checks a study: the case of every arm is resolved, and its model built, before
//! anything is written.

use std::collections::{BTreeMap, VecDeque};
use std::path::{Path, PathBuf};

use carom_record::study::design::{Design, Goal, MemberOf, Role};
use carom_record::study::{Arm, Comparison, StudyManifest, StudySource};
use carom_record::{Machine, Source, Status, now};
use carom_run::Setup;
use carom_run::case::{Case, CaseError, Diagnostic, Document, Problem, read};

use crate::arms::{self, Draft};
use crate::{expects, file};

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
}

impl Plan {
    /// Reads a study file and its cases.
    ///
    /// # Errors
    /// All problems, with their places in the study file, or in the case file for problems that it
    /// has without any arm.
    pub fn read(path: &Path) -> Result<Self, CaseError> {
        let study = Document::open(path, &[])?;
        let mut problems = Vec::new();
        let file = file::read(&study, &mut problems);
        let drafts = arms::all(&file);
        // Parts that could not be read would give misleading errors about unknown names.
        if problems.is_empty() {
            names(&file, &drafts, &mut problems);
        }
        if !problems.is_empty() {
            return Err(study.diagnose_all(&problems));
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut cases: BTreeMap<String, Base> = BTreeMap::new();
        let named = drafts.iter().map(|d| (d.case.as_ref(), format!("{}.case", d.path)));
        for (name, place) in std::iter::once((file.case.as_ref(), "case".to_owned())).chain(named) {
            if let Some(name) = name.filter(|name| !cases.contains_key(*name)) {
                cases.insert(name.clone(), Base::read(&study, folder, name, &place)?);
            }
        }
        let mut found: Vec<Diagnostic> = Vec::new();
        let mut planned: Vec<(Draft, Vec<String>, Case, &Base)> = Vec::new();
        let computed = arms::computes_reference(&file, &drafts);
        let mut waiting: VecDeque<Draft> = drafts.into();
        let mut methods = waiting.len();
        while let Some(draft) = waiting.pop_front() {
            let Some(base) = draft.case.as_ref().or(file.case.as_ref()).and_then(|name| cases.get(name))
            else {
                continue;
            };
            let mut sets: Vec<String> = draft.sets.iter().map(|(set, _)| set.clone()).collect();
            sets.push(draft.expect.0.clone());
            match resolved(&base.path, &sets) {
                Ok(case) => {
                    sets.pop();
                    planned.push((draft, sets, case, base));
                    // The step of the computed reference depends on those of all methods.
                    if computed && planned.len() == methods {
                        let times = planned.iter().map(|(_, _, case, _)| case.time.step);
                        let step = times.fold(f64::INFINITY, f64::min);
                        let (end, refine) = (planned[0].2.time.end, planned[0].2.refine);
                        match arms::fine(&file, step, end, refine) {
                            Some(levels) => waiting.extend(levels),
                            None => found.push(study.diagnose(&no_steps())),
                        }
                        methods = 0;
                    }
                }
                Err(error) => {
                    for diagnostic in diagnostics(error)? {
                        let placed = arms::placed(&study, &draft, &diagnostic, &base.diagnostics);
                        if !found.contains(&placed) {
                            found.push(placed);
                        }
                    }
                }
            }
        }
        let known: Vec<(&str, &Case)> =
            planned.iter().map(|(d, _, case, _)| (d.name.as_str(), case)).collect();
        let mut problems = Vec::new();
        expects::check(&file.expects, &known, &mut problems);
        if let Err(CaseError::Wrong(more)) =
            if problems.is_empty() { Ok(()) } else { Err(study.diagnose_all(&problems)) }
        {
            found.extend(more);
        }
        if !found.is_empty() {
            return Err(CaseError::Wrong(found));
        }
        let stem = path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        let texts = |name: &String| cases.get(name).map(|base| base.text.clone()).unwrap_or_default();
        let main = file.case.clone().unwrap_or_default();
        let others = cases.keys().filter(|name| **name != main).map(|name| (name.clone(), texts(name)));
        let sources = StudySource {
            study: study.text().to_owned(),
            case: texts(&main),
            others: others.collect(),
            case_path: main,
        };
        let texts = std::iter::once(sources.case.clone()).chain(sources.others.values().cloned());
        let hash = Source { text: sources.study.clone(), sets: texts.collect() }.hash();
        let arm = |(i, (draft, sets, case, _)): (usize, &(Draft, Vec<String>, Case, &Base))| Arm {
            name: draft.name.clone(),
            directory: format!("arms/{:02}-{}", i + 1, arms::slug(&draft.name)),
            sets: sets.clone(),
            steps: case.time.steps() as u64,
            role: draft.role.clone(),
            case_path: draft.case.clone(),
            case: serde_json::to_value(case).unwrap_or_default(),
        };
        let mut members = Vec::new();
        for (i, (draft, _, case, base)) in planned.iter().enumerate() {
            let all = file.ensemble.iter().flat_map(|ensemble| arms::members(ensemble, draft, case));
            for (j, (member, draft)) in all.enumerate() {
                let mut sets: Vec<String> = draft.sets.iter().map(|(set, _)| set.clone()).collect();
                sets.push(draft.expect.0.clone());
                let case = match resolved(&base.path, &sets) {
                    Ok(case) => case,
                    Err(error) => {
                        for diagnostic in diagnostics(error)? {
                            let placed = arms::placed(&study, &draft, &diagnostic, &base.diagnostics);
                            if !found.contains(&placed) {
                                found.push(placed);
                            }
                        }
                        continue;
                    }
                };
                sets.pop();
                let role = Role { member: Some(MemberOf { arm: i, member }), ..draft.role };
                members.push(Arm {
                    directory: format!("members/{:02}-{:03}", i + 1, j + 1),
                    sets,
                    steps: case.time.steps() as u64,
                    role,
                    case_path: draft.case,
                    case: serde_json::to_value(&case).unwrap_or_default(),
                    name: draft.name,
                });
            }
        }
        if !found.is_empty() {
            return Err(CaseError::Wrong(found));
        }
        let design = file.design.map(|kind| {
            let of = |level: usize| planned.iter().find(|(d, ..)| d.role.level == level && !d.role.fine);
            let cost_of = file.cost_of.clone().or_else(|| of(0)?.0.role.method.clone()).unwrap_or_default();
            let steps = if file.steps.is_empty() {
                of(0).map(|p| p.2.time.step).into_iter().collect()
            } else {
                file.steps.clone()
            };
            Design { kind, cost_of, steps }
        });
        let manifest = StudyManifest {
            goal: file.goal.or(design.as_ref().map(|_| Goal::Trajectory)),
            design,
            accuracy: file.accuracy,
            status: Status::Running,
            title: file.title.unwrap_or(stem),
            version: env!("CARGO_PKG_VERSION").into(),
            input_hash: hash,
            created: now(),
            machine: Machine::current(),
            reference: file.reference,
            arms: planned.iter().enumerate().map(arm).collect(),
            ensemble: file.ensemble,
            members,
            claims: file.claims,
            expects: file.expects,
            source: sources,
        };
        let arm = |(_, sets, case, base): (Draft, Vec<String>, Case, &Base)| PlannedArm {
            case,
            source: Source { text: base.text.clone(), sets },
        };
        Ok(Self { manifest, arms: planned.into_iter().map(arm).collect() })
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
    path: PathBuf,
    text: String,
    /// Its problems without any change.
    diagnostics: Vec<Diagnostic>,
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
        let diagnostics = resolved(&path, &[]).err().map_or_else(|| Ok(Vec::new()), diagnostics)?;
        Ok(Self { text: document.text().to_owned(), path, diagnostics })
    }
}

/// Checks the names of arms: that there are some, that they are unique, and that references to them
/// exist.
fn names(file: &file::StudyFile, drafts: &[Draft], problems: &mut Vec<Problem>) {
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

/// A case with changes; its model is built once, to find problems that only the model shows.
pub(crate) fn resolved(path: &Path, sets: &[String]) -> Result<Case, CaseError> {
    let document = Document::open(path, sets)?;
    let case = read(&document).map_err(|problems| document.diagnose_all(&problems))?;
    Setup::new(&case).start().map_err(|problems| document.diagnose_all(&problems))?;
    Ok(case)
}

/// The diagnostics of a wrong case; input/output and system errors are returned as errors.
fn diagnostics(error: CaseError) -> Result<Vec<Diagnostic>, CaseError> {
    match error {
        CaseError::Wrong(found) => Ok(found),
        error @ CaseError::Refused { .. } => Err(error),
    }
}
