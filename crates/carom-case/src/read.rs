//! Document → case: all tables, what follows from several of them, and the checks.

use std::cell::RefCell;
use std::path::Path;

use super::between::Bodies;
use super::check;
use super::conform::{self, Conformity};
use super::document::Document;
use super::draft::Draft;
use super::keys::{Keys, View};
use super::problem::{CaseError, Problem, Problems, is_within};
use super::refine::{self, Counts};
use super::{BodySpec, Case, ContactSpec, FormulaSpec, Persistency, Preset};

impl Case {
    /// Reads a case from its text, with overrides `key=value` applied in their order. Files that it
    /// names are looked for in the working directory.
    ///
    /// # Errors
    /// Everything wrong with it that can be found in one pass, with line and column.
    pub fn from_text(text: &str, sets: &[&str]) -> Result<Self, CaseError> {
        Self::of(&Document::parse("case", text, &owned(sets))?)
    }

    /// Reads a case from its file, with overrides `key=value` applied in their order.
    ///
    /// # Errors
    /// As [`Case::from_text`], and if the file cannot be read.
    pub fn from_file(path: impl AsRef<Path>, sets: &[&str]) -> Result<Self, CaseError> {
        Self::of(&Document::open(path.as_ref(), &owned(sets))?)
    }

    fn of(document: &Document) -> Result<Self, CaseError> {
        read(document).map_err(|problems| document.diagnose_all(&problems))
    }
}

fn owned(sets: &[&str]) -> Vec<String> {
    sets.iter().map(|&set| set.to_owned()).collect()
}

/// Reads a case; on failure all problems that can be found in one pass.
///
/// # Errors
/// These problems.
pub fn read(document: &Document) -> Result<Case, Problems> {
    if let Some(key) = document.study_key() {
        let why = "`case`, `arm` and `grid` are keys of a study, which runs one case many times";
        let help = "run it with carom study, or check it with carom check";
        return Err(vec![Problem::new(key, "this is a study, not a case", why, help).at_key()].into());
    }
    let Conformity { problems, misspelt } = conform::file(document, &Draft::TABLE);
    let known = problems.len();
    let problems = RefCell::new(problems);
    let root = View::of_keys(document.root(), Draft::TABLE.keys, &problems);
    let folder = Path::new(document.name()).parent().unwrap_or(Path::new(""));
    let is_paper = root.get("preset") == Some(Preset::Paper);
    let dimension = root.get("dimension").filter(|d| (1..=3).contains(d));
    let root = View { is_paper, dimension, folder, ..root };
    let mut draft = Draft::read(&root).unwrap_or_default();
    draft.dimension = dimension;
    draft.refine(&root);
    draft.expand_contacts(&root);
    let mut problems = problems.take();
    check::problems(document, &draft, &misspelt, &mut problems);
    only_judged(&mut problems, known, &misspelt);
    if !problems.is_empty() {
        return Err(problems.into());
    }
    let case = draft.case(document).ok_or_else(|| {
        let why = "all keys passed the checks, but one of them could not be read";
        vec![Problem::new(
            "",
            "internal error: the case cannot be read",
            why,
            "please report this as a bug, with the file",
        )]
    })?;
    case.fits_memory().map_err(|problem| vec![problem])?;
    Ok(case)
}

/// Reads a file with the keys of a table, and adds everything wrong with it to `problems`; relative
/// paths of files start at `folder`.
pub fn read_table<T: Keys + Default>(document: &Document, folder: &Path, problems: &mut Vec<Problem>) -> T {
    let Conformity { problems: found, misspelt } = conform::file(document, &T::TABLE);
    let known = found.len();
    let reported = RefCell::new(found);
    let view = View { folder, ..View::of_keys(document.root(), T::TABLE.keys, &reported) };
    let read = T::read(&view);
    let mut found = reported.take();
    only_judged(&mut found, known, &misspelt);
    problems.extend(found);
    read.unwrap_or_default()
}

/// Drops problems, beyond those that are `known`, of tables that have a misspelt key: what depends
/// on it is not judged.
fn only_judged(problems: &mut Vec<Problem>, known: usize, misspelt: &[String]) {
    let tables = || misspelt.iter().filter(|table| !table.is_empty());
    let judged = problems.split_off(known);
    problems
        .extend(judged.into_iter().filter(|problem| !tables().any(|table| is_within(&problem.path, table))));
}

impl Draft {
    /// Refines all meshes.
    fn refine(&mut self, root: &View) {
        let factor = self.refine.filter(|factor| *factor >= 1.0).unwrap_or(1.0);
        let counts = |v: &View| Counts::of(v.table.get("mesh")?.table()?, format!("{}.mesh", v.path));
        let counts: Vec<_> = root.each("body", counts).into_iter().flatten().flatten().collect();
        root.problems.borrow_mut().extend(refine::problem(factor, &counts));
        for body in self.body.iter_mut().flatten() {
            body.mesh = body.mesh.clone().refined(factor);
        }
    }

    /// Replaces the contacts `between` bodies by those that they stand for.
    fn expand_contacts(&mut self, root: &View) {
        let given = std::mem::take(&mut self.contact);
        let owned = |bodies: Vec<&str>| bodies.into_iter().map(str::to_owned).collect::<Vec<String>>();
        let contacts = given.iter().flatten().filter(|contact| !contact.between);
        let of_contacts = contacts.map(|contact| owned(contact.bodies().collect()));
        // The rest of a body with a tie of two of its sides may still meet itself.
        let of_ties = self.tie.iter().flatten().map(|tie| owned(tie.bodies().to_vec()));
        let of_ties = of_ties.filter(|bodies| bodies[0] != bodies[1]);
        let declared: Vec<Vec<String>> = of_contacts.chain(of_ties).collect();
        let bodies = Bodies { bodies: &self.body, materials: &self.material };
        let mut given = given.into_iter();
        let expanded = root.each("contact", |v| {
            let contact = given.next().flatten();
            let Some(one) = contact.as_ref().filter(|contact| contact.between) else {
                return Some(vec![contact]);
            };
            bodies.contacts(v, one, &declared).map(|several| several.into_iter().map(Some).collect())
        });
        let or_unread = |contacts: Option<Vec<_>>| contacts.unwrap_or_else(|| vec![None]);
        self.contact = expanded.into_iter().flatten().flat_map(or_unread).collect();
    }

    fn case(self, document: &Document) -> Option<Case> {
        let dimension = self.dimension?;
        let stem = Path::new(document.name()).file_stem().map(|s| s.to_string_lossy().into_owned());
        let mut bodies: Vec<BodySpec> = all(self.body)?;
        for body in &mut bodies {
            for values in [&mut body.gravity, &mut body.velocity] {
                values.resize(dimension, FormulaSpec::Number(0.0));
            }
        }
        let mut contacts: Vec<ContactSpec> = all(self.contact)?;
        let time = self.time?;
        for contact in &mut contacts {
            contact.law.get_or_insert(time.scheme.contact_law());
            if time.scheme.nonsmooth().is_some() {
                // Nothing to project: the contact law of the scheme makes velocities compatible.
                contact.persistency = Persistency::None;
            }
        }
        Some(Case {
            title: self.title.or(stem).unwrap_or_default(),
            dimension,
            plane: self.plane?,
            thickness: self.thickness?,
            refine: self.refine?,
            units: self.units?,
            preset: self.preset?,
            materials: all(self.material)?,
            bodies,
            supports: all(self.support)?,
            loads: all(self.load)?,
            initial: self.initial,
            manufactured: self.manufactured.map(|solution| solution.y),
            contacts,
            ties: all(self.tie)?,
            time,
            newton: self.newton,
            probes: all(self.probe)?,
            overlays: all(self.overlay)?,
            output: self.output,
            exact: self.exact,
            expects: all(self.expect)?,
            functions: carom_formula::Functions::default(),
        })
    }
}

fn all<T>(list: Vec<Option<T>>) -> Option<Vec<T>> {
    list.into_iter().collect()
}
