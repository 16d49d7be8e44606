//! Document → case: all tables (`tables.rs`), what follows from several of them, and the checks.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;

use super::between::Bodies;
use super::check;
use super::conform;
use super::document::Document;
use super::draft::Draft;
use super::expect::{self, Asked, Exact};
use super::keys;
use super::load;
use super::overlay;
use super::problem::{CaseError, Problem, Problems};
use super::refine::{self, Counts};
use super::tables::{body, contact, initial, material, newton, output, probe, support, time};
use super::tree::{Entry, Node};
use super::view::View;
use super::{BodySpec, Case, ContactSpec, FormulaSpec, Persistency, Preset, Units};

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
    let problems = RefCell::new(conform::problems(document));
    let reader = Reader::of(document, &problems);
    let materials = reader.each("material", material);
    let time = reader.root.at("time").and_then(|v| time(&v));
    let refine = reader.root.number("refine").filter(|factor| *factor >= 1.0).unwrap_or(1.0);
    let counts = |v: &View| Counts::of(v.table.get("mesh")?.table()?, format!("{}.mesh", v.path));
    let counts: Vec<_> = reader.each("body", counts).into_iter().flatten().collect();
    problems.borrow_mut().extend(refine::problem(refine, &counts));
    let bodies = reader.each("body", |v| body(v, reader.dimension?, refine));
    let exact = reader.exact();
    let draft = Draft {
        dimension: reader.dimension,
        contacts: reader.contacts(&Bodies { bodies: &bodies, materials: &materials }),
        supports: reader.each("support", support),
        loads: reader.each("load", load::read),
        probes: reader.each("probe", probe),
        overlays: reader.each("overlay", overlay::read),
        expects: reader.each("expect", |v| {
            // An unknown key may be a misspelt `exact`.
            let known = if reader.root.has_unknown_key() { Exact::Later } else { Exact::Of(&exact) };
            expect::one(v, Asked::OfARun, known)
        }),
        materials,
        bodies,
        exact,
        time,
    };
    let mut problems = problems.take();
    check::problems(document, &draft, &mut problems);
    if !problems.is_empty() {
        return Err(problems.into());
    }
    let case = reader.case(document, draft).ok_or_else(|| {
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

struct Reader<'a> {
    root: View<'a>,
    dimension: Option<usize>,
}

impl<'a> Reader<'a> {
    fn of(document: &'a Document, problems: &'a RefCell<Vec<Problem>>) -> Self {
        let root = View::of_keys(document.root(), keys::CASE.keys, problems);
        let preset = root.choice("preset").unwrap_or(Preset::Default);
        let folder = Path::new(document.name()).parent().unwrap_or(Path::new(""));
        let root = View { preset, folder, ..root };
        Self { dimension: root.count("dimension").filter(|d| (1..=3).contains(d)), root }
    }

    fn each<T>(&self, name: &str, read: impl FnMut(&View<'a>) -> Option<T>) -> Vec<Option<T>> {
        self.root.each(name, read).unwrap_or_default()
    }

    /// The contacts of all tables; those of `between` need the bodies.
    fn contacts(&self, bodies: &Bodies) -> Vec<Option<ContactSpec>> {
        let mut entry = 0..;
        let tables = self.each("contact", |v| Some((v.clone(), contact(v, entry.next()?, self.dimension))));
        let specs = tables.iter().flatten().filter_map(|(_, contact)| contact.clone());
        let declared: Vec<ContactSpec> = specs.filter(|contact| !contact.between).collect();
        let mut contacts = Vec::new();
        for table in tables {
            match table {
                Some((v, Some(one))) if one.between => match bodies.contacts(&v, &one, &declared) {
                    Some(several) => contacts.extend(several.into_iter().map(Some)),
                    None => contacts.push(None),
                },
                Some((_, contact)) => contacts.push(contact),
                None => contacts.push(None),
            }
        }
        contacts
    }

    /// Formulas by column, as written.
    fn exact(&self) -> BTreeMap<String, String> {
        let table = self.root.table.get("exact").and_then(Node::table);
        let formula = |entry: &Entry| {
            let node = &entry.node;
            Some((
                entry.key.clone(),
                node.text().map(str::to_owned).or_else(|| Some(node.number()?.to_string()))?,
            ))
        };
        table.into_iter().flat_map(|t| &t.0).filter_map(formula).collect()
    }

    fn case(&self, document: &Document, draft: Draft) -> Option<Case> {
        let dimension = draft.dimension?;
        let stem =
            std::path::Path::new(document.name()).file_stem().map(|s| s.to_string_lossy().into_owned());
        let units = self.root.at("units")?;
        let mut bodies: Vec<BodySpec> = all(draft.bodies)?;
        for body in &mut bodies {
            body.gravity.resize(dimension, FormulaSpec::Number(0.0));
        }
        let mut contacts: Vec<ContactSpec> = all(draft.contacts)?;
        let time = draft.time?;
        for contact in &mut contacts {
            contact.law.get_or_insert(time.scheme.contact_law());
            if time.scheme.nonsmooth().is_some() {
                // Nothing to project: the contact law of the scheme makes velocities compatible.
                contact.persistency = Persistency::None;
            }
        }
        Some(Case {
            title: self.root.text("title").or(stem).unwrap_or_default(),
            dimension,
            plane: self.root.choice("plane")?,
            thickness: self.root.number("thickness")?,
            refine: self.root.number("refine")?,
            units: Units {
                length: units.text("length")?,
                time: units.text("time")?,
                mass: units.text("mass")?,
                declared: self.root.has("units"),
            },
            preset: self.root.preset,
            materials: all(draft.materials)?,
            bodies,
            supports: all(draft.supports)?,
            loads: all(draft.loads)?,
            initial: self.root.has("initial").then(|| initial(&self.root.at("initial")?)).flatten(),
            manufactured: self
                .root
                .has("manufactured")
                .then(|| self.root.at("manufactured")?.formulas("y"))
                .flatten(),
            contacts,
            time,
            newton: newton(&self.root.at("newton")?)?,
            probes: all(draft.probes)?,
            overlays: all(draft.overlays)?,
            output: output(&self.root.at("output")?)?,
            exact: draft.exact,
            expects: all(draft.expects)?,
            functions: carom_formula::Functions::default(),
        })
    }
}

fn all<T>(list: Vec<Option<T>>) -> Option<Vec<T>> {
    list.into_iter().collect()
}
