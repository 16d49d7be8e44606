//! Suites for `carom verify`: the cases and studies with expectations in files and folders, read
//! and checked before anything is written.

use std::path::{Path, PathBuf};

use carom_record::{Expect, Source};
use carom_run::case::{Case, CaseError, Diagnostic, Document};

use crate::Plan;
use crate::resolved::resolved;

/// Cases and studies to verify.
#[derive(Clone, Debug, Default)]
pub struct Suite {
    /// Cases and studies, family by family.
    pub items: Vec<Item>,
    /// Whether slow expectations are skipped.
    pub fast: bool,
}

/// A case file or study file of a suite.
#[derive(Clone, Debug)]
pub struct Item {
    /// Name of the folder by which items are grouped.
    pub family: String,
    /// Name of the file without its ending.
    pub name: String,
    /// Path of the file.
    pub file: PathBuf,
    /// Case or study.
    pub kind: Kind,
}

/// A case, or a study.
#[derive(Clone, Debug)]
pub enum Kind {
    /// A case: one simulation.
    Case(Box<Case>, Source),
    /// A study: many simulations.
    Study(Box<Plan>),
}

impl Suite {
    /// Reads files, and all `.toml` files below folders. Files without expectations, or with `fast`
    /// only slow ones, are skipped.
    ///
    /// # Errors
    /// All problems of all files, with their places.
    pub fn read(paths: &[PathBuf], fast: bool) -> Result<Self, CaseError> {
        let mut files = Vec::new();
        for path in paths {
            let below = if path.is_dir() { toml_files(path)? } else { vec![path.clone()] };
            files.extend(below.into_iter().map(|file| (family(path, &file), file)));
        }
        files.sort();
        files.dedup_by(|a, b| a.1 == b.1);
        let mut suite = Self { items: Vec::new(), fast };
        let mut wrong: Vec<Diagnostic> = Vec::new();
        for (family, file) in files {
            match kind(&file, fast) {
                Ok(Some(kind)) => {
                    let name =
                        file.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
                    suite.items.push(Item { family, name, file, kind });
                }
                Ok(None) => {}
                Err(CaseError::Wrong(found)) => wrong.extend(found),
                Err(error) => return Err(error),
            }
        }
        if wrong.is_empty() { Ok(suite) } else { Err(CaseError::Wrong(wrong)) }
    }
}

/// The subfolder of the given folder that contains the file, or the folder of the file itself.
fn family(named: &Path, file: &Path) -> String {
    // `case.toml` alone has no folder in its path.
    let whole = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    let below = file.strip_prefix(named).ok().and_then(|below| below.parent()?.components().next());
    let name = match below {
        Some(first) => Some(first.as_os_str()),
        None => whole.parent().and_then(Path::file_name),
    };
    name.map_or_else(|| "cases".into(), |name| name.to_string_lossy().into_owned())
}

fn toml_files(folder: &Path) -> Result<Vec<PathBuf>, CaseError> {
    let unreadable = |source| CaseError::Refused { path: folder.display().to_string(), source };
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.is_dir() {
            found.extend(toml_files(&path)?);
        } else if path.extension().is_some_and(|e| e == "toml") {
            found.push(path);
        }
    }
    Ok(found)
}

/// Whether any expectation is evaluated; with `fast`, slow ones are not.
fn wanted<'a>(expects: impl IntoIterator<Item = &'a Expect>, fast: bool) -> bool {
    expects.into_iter().any(|e| !(fast && e.slow))
}

fn kind(file: &Path, fast: bool) -> Result<Option<Kind>, CaseError> {
    let document = Document::open(file, &[])?;
    if document.is_study() {
        // Reading a study builds the models of its arms, so skip it if there is nothing to verify.
        if !document.text().contains("expect") {
            return Ok(None);
        }
        let plan = Plan::of(&document, file.parent().unwrap_or(Path::new("")))?;
        let arms = plan.arms.iter().flat_map(|arm| &arm.case.expects);
        return Ok(wanted(arms.chain(&plan.manifest.expects), fast).then(|| Kind::Study(Box::new(plan))));
    }
    let case = carom_run::case::read(&document).map_err(|problems| document.diagnose_all(&problems))?;
    if !wanted(&case.expects, fast) {
        return Ok(None);
    }
    let source = Source { text: document.text().to_owned(), ..Source::default() };
    resolved(document.name(), document.text(), &[]).map(|(case, _)| Some(Kind::Case(Box::new(case), source)))
}
