//! Document → case: reads every table with its defaults. Checks that concern a single table are
//! here, the others in `check`.

use std::collections::BTreeMap;
use std::path::Path;

use carom_time::SchemeError;

use super::between::Bodies;
use super::check;
use super::conform;
use super::document::{Document, joined};
use super::draft::Draft;
use super::expect::{self, Asked, Exact};
use super::keys::{self, Kind};
use super::load;
use super::mesh;
use super::obstacle;
use super::place;
use super::problem::{CaseError, Diagnostic, Problem, Problems};
use super::refine::{self, Counts};
use super::suggest;
use super::tree::{Entry, Node, Table};
use super::view::{View, word};
use super::{
    BodySpec, Case, ContactSpec, InitialSpec, MaterialSpec, NewtonSpec, ObstacleMotion, OutputSpec,
    Persistency, Preset, PrimarySpec, ProbeSpec, SchemeSpec, SupportSpec, TimeSpec, Units,
};

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
    let reader = Reader::of(document);
    let mut problems = conform::problems(document);
    let mut draft = Draft {
        dimension: reader.dimension,
        materials: reader.each("material", |v, path| material(v, path, &mut problems)),
        bodies: Vec::new(),
        supports: reader.each("support", |v, _| support(v)),
        loads: Vec::new(),
        contacts: Vec::new(),
        probes: reader.each("probe", |v, _| probe(v)),
        exact: reader.exact(),
        expects: Vec::new(),
        time: reader.one("time").and_then(|v| time(v, &mut problems)),
    };
    let folder = Path::new(document.name()).parent().unwrap_or(Path::new(""));
    let refine = reader.root.number("refine").filter(|factor| *factor >= 1.0).unwrap_or(1.0);
    let counts = |v: View, path: &str| Counts::of(v.table.get("mesh")?.table()?, format!("{path}.mesh"));
    let counts: Vec<_> = reader.each("body", counts).into_iter().flatten().collect();
    problems.extend(refine::problem(refine, &counts));
    draft.bodies =
        reader.each("body", |v, path| body(v, reader.dimension?, refine, folder, path, &mut problems));
    draft.contacts = reader.contacts(&draft, &mut problems);
    draft.loads = reader.each("load", |v, path| load::read(v, folder, path, &mut problems));
    draft.expects = reader.each("expect", |v, path| {
        expect::one(v, path, Asked::OfARun, Exact::Of(&draft.exact), &mut problems)
    });
    check::problems(document, &draft, &mut problems);
    if !problems.is_empty() {
        return Err(problems.into());
    }
    reader.case(document, draft, folder).ok_or_else(|| {
        let why = "all keys passed the checks, but one of them could not be read";
        vec![Problem::new(
            "",
            "internal error: the case cannot be read",
            why,
            "please report this as a bug, with the file",
        )]
        .into()
    })
}

struct Reader<'a> {
    root: View<'a>,
    dimension: Option<usize>,
}

impl<'a> Reader<'a> {
    fn of(document: &'a Document) -> Self {
        let root = View { table: document.root(), keys: keys::CASE.keys, preset: Preset::Default };
        let preset = root.choice("preset").unwrap_or(Preset::Default);
        Self {
            root: View { preset, ..root },
            dimension: root.count("dimension").filter(|d| (1..=2).contains(d)),
        }
    }

    fn spec(name: &str) -> &'static [keys::Key] {
        match keys::CASE.key(name).map(|k| k.kind) {
            Some(Kind::Table(table) | Kind::Tables(table)) => table.keys,
            _ => &[],
        }
    }

    /// A table; an empty one with all defaults if it is not given.
    fn one(&self, name: &str) -> Option<View<'a>> {
        const EMPTY: &Table = &Table(Vec::new());
        let table = self.root.table.get(name).map_or(Some(EMPTY), Node::table)?;
        Some(View { table, keys: Self::spec(name), preset: self.root.preset })
    }

    fn each<T>(&self, name: &str, mut read: impl FnMut(View<'a>, &str) -> Option<T>) -> Vec<Option<T>> {
        let list = self.root.table.get(name).and_then(Node::list).unwrap_or(&[]);
        let view = |node: &'a Node| {
            Some(View { table: node.table()?, keys: Self::spec(name), preset: self.root.preset })
        };
        list.iter().enumerate().map(|(i, node)| read(view(node)?, &format!("{name}[{i}]"))).collect()
    }

    /// The contacts of all tables; those of `between` need the bodies.
    fn contacts(&self, draft: &Draft, problems: &mut Vec<Problem>) -> Vec<Option<ContactSpec>> {
        let mut entry = 0..;
        let tables = self.each("contact", |v, path| {
            let entry = entry.next()?;
            Some((v, path.to_owned(), contact(v, entry, self.dimension, problems)))
        });
        let specs = tables.iter().flatten().filter_map(|(.., contact)| contact.clone());
        let declared: Vec<ContactSpec> = specs.filter(|contact| !contact.between).collect();
        let bodies = Bodies { bodies: &draft.bodies, materials: &draft.materials };
        let mut contacts = Vec::new();
        for table in tables {
            match table {
                Some((v, path, Some(one))) if one.between => {
                    match bodies.contacts(&v, &one, &declared, &path, problems) {
                        Some(several) => contacts.extend(several.into_iter().map(Some)),
                        None => contacts.push(None),
                    }
                }
                Some((.., contact)) => contacts.push(contact),
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

    fn case(&self, document: &Document, draft: Draft, folder: &Path) -> Option<Case> {
        let dimension = draft.dimension?;
        let stem =
            std::path::Path::new(document.name()).file_stem().map(|s| s.to_string_lossy().into_owned());
        let units = self.one("units")?;
        let mut bodies: Vec<BodySpec> = all(draft.bodies)?;
        for body in &mut bodies {
            body.gravity.resize(dimension, 0.0);
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
            },
            preset: self.root.preset,
            materials: all(draft.materials)?,
            bodies,
            supports: all(draft.supports)?,
            loads: all(draft.loads)?,
            initial: self.root.has("initial").then(|| initial(self.one("initial")?, folder)).flatten(),
            manufactured: self
                .root
                .has("manufactured")
                .then(|| self.one("manufactured")?.formulas("y"))
                .flatten(),
            contacts,
            time,
            newton: newton(self.one("newton")?)?,
            probes: all(draft.probes)?,
            output: output(self.one("output")?)?,
            exact: draft.exact,
            expects: all(draft.expects)?,
            functions: carom_formula::Functions::default(),
        })
    }
}

fn all<T>(list: Vec<Option<T>>) -> Option<Vec<T>> {
    list.into_iter().collect()
}

fn material(v: View, path: &str, problems: &mut Vec<Problem>) -> Option<MaterialSpec> {
    let (name, law, density) = (v.text("name"), v.choice("law"), v.number("density"));
    let given: Vec<_> = ["lambda", "mu", "young", "poisson"].into_iter().filter(|k| v.has(k)).collect();
    let (lambda, mu) = match given.as_slice() {
        ["lambda", "mu"] => (v.number("lambda")?, v.number("mu")?),
        ["young", "poisson"] => {
            let (young, poisson) = (v.number("young")?, v.number("poisson")?);
            (young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), young / (2.0 * (1.0 + poisson)))
        }
        given => {
            // A misspelt key is reported once, not as a missing key too.
            let misspelt = v.table.0.iter().any(|e| !v.keys.iter().any(|k| k.name == e.key));
            if !misspelt || given.len() > 2 {
                let had = if given.is_empty() { "none".to_owned() } else { given.join(", ") };
                let what = format!("the elastic constants are not a valid pair: {had}");
                let help = elastic_help(v, given);
                problems.push(
                    Problem::new(path, what, "an isotropic material has two elastic constants", help)
                        .at_key(),
                );
            }
            return None;
        }
    };
    if mu > 0.0 && 3.0 * lambda + 2.0 * mu <= 0.0 {
        let what = format!("the elastic constants Λ = {lambda}, μ = {mu} are not positive definite");
        let why = format!("the bulk modulus Λ + 2μ/3 = {} must be > 0", lambda + 2.0 * mu / 3.0);
        let help = format!("lambda must be > {}", -2.0 * mu / 3.0);
        problems.push(Problem::new(format!("{path}.lambda"), what, why, help));
    }
    Some(MaterialSpec { name: name?, law: law?, density: density?, lambda, mu })
}

fn body(
    v: View,
    dimension: usize,
    refine: f64,
    folder: &Path,
    path: &str,
    problems: &mut Vec<Problem>,
) -> Option<BodySpec> {
    let shape = v.value("mesh")?;
    let mesh = mesh::read(
        shape.table()?,
        dimension,
        v.choice("element"),
        folder,
        v.preset,
        &format!("{path}.mesh"),
        problems,
    )?;
    Some(BodySpec {
        name: v.text("name")?,
        material: v.text("material")?,
        element: v.choice("element")?,
        mesh: mesh.refined(refine),
        place: match v.table.get("place") {
            Some(node) => {
                let Some(Kind::Table(spec)) = v.keys.iter().find(|k| k.name == "place").map(|k| k.kind)
                else {
                    return None;
                };
                let v = View { table: node.table()?, keys: spec.keys, preset: v.preset };
                Some(place::read(v, dimension, &format!("{path}.place"), problems)?)
            }
            None => None,
        },
        position: if v.has("position") { Some(v.formulas("position")?) } else { None },
        gravity: if v.has("gravity") { v.numbers("gravity")? } else { Vec::new() },
        velocity: load::velocity(&v, dimension, path, problems)?,
        mass: v.choice("mass")?,
    })
}

fn support(v: View) -> Option<SupportSpec> {
    let fix = if v.has("fix") { v.texts("fix")? } else { Vec::new() };
    let fix = fix.iter().map(|d| ["x", "y"].iter().position(|x| x == d)).collect::<Option<_>>()?;
    Some(SupportSpec { name: v.text("name"), on: v.texts("on")?, fix, moves: load::motion(&v)? })
}

fn initial(v: View, folder: &Path) -> Option<InitialSpec> {
    let joined = folder.join(v.text("from")?);
    let from = std::path::absolute(&joined).unwrap_or(joined);
    Some(InitialSpec { from, velocities: v.choice("velocities")? })
}

fn contact(
    v: View,
    entry: usize,
    dimension: Option<usize>,
    problems: &mut Vec<Problem>,
) -> Option<ContactSpec> {
    let between = v.has("between");
    let (secondary, primary, motion) = if between {
        (String::new(), PrimarySpec::Side(String::new()), ObstacleMotion::Fixed)
    } else {
        let (primary, motion) = obstacle::read(&v, dimension, &format!("contact[{entry}]"), problems)?;
        (v.text("secondary")?, primary, motion)
    };
    Some(ContactSpec {
        name: v.text("name")?,
        entry,
        between,
        secondary,
        primary,
        motion,
        enforcement: v.choice("enforcement")?,
        stiffness: v.number("stiffness")?,
        force: v.choice("force")?,
        persistency: v.choice("persistency")?,
        active_set: v.choice("active_set")?,
        detection: v.choice("detection")?,
        xi: v.choice("xi")?,
        law: v.choice("law"),
        overlap: v.choice("overlap")?,
        restitution: v.number("restitution")?,
    })
}

/// The pair of elastic constants that was probably meant.
fn elastic_help(v: View, given: &[&str]) -> String {
    let pairs = "give `lambda` and `mu`, or `young` and `poisson`";
    let ([mu, poisson], ["lambda", "mu", "poisson"]) =
        (["mu", "poisson"].map(|key| v.number(key).filter(|x| x.is_finite())), given)
    else {
        return pairs.to_owned();
    };
    let (Some(mu), Some(poisson)) = (mu, poisson) else { return pairs.to_owned() };
    // Where there is no such material, the nearest that there is.
    let poisson = poisson.clamp(-0.99, 0.49);
    let lambda = (2.0 * mu * poisson / (1.0 - 2.0 * poisson) * 1e6).round() / 1e6;
    format!("{pairs}; with this `mu`, Poisson's ratio is {poisson} for `lambda = {lambda}`")
}

fn probe(v: View) -> Option<ProbeSpec> {
    let record = v.texts("record")?.iter().map(|q| word(q)).collect::<Option<_>>()?;
    Some(ProbeSpec { name: v.text("name")?, at: v.numbers("at")?, body: v.text("body")?, record })
}

fn time(v: View, problems: &mut Vec<Problem>) -> Option<TimeSpec> {
    let scheme = v.value("scheme").and_then(|node| scheme(node.table()?, v.preset, "time.scheme", problems));
    Some(TimeSpec {
        end: v.number("end")?,
        step: v.number("step")?,
        phase: v.number("phase")?,
        scheme: scheme?,
        energy_guard: v.value("energy_guard")?.number(),
    })
}

fn scheme(table: &Table, preset: Preset, path: &str, problems: &mut Vec<Problem>) -> Option<SchemeSpec> {
    let kind = table.get("kind")?.text()?;
    let v = View { table, keys: keys::schemes().table(kind)?.keys, preset };
    let numbers = v.keys.iter().filter(|k| matches!(k.kind, Kind::Number(_)));
    let parameters = numbers.filter_map(|k| Some((k.name.to_owned(), v.number(k.name)?))).collect();
    let forces = if v.keys.iter().any(|k| k.name == "forces") {
        v.choice("forces")?
    } else {
        carom_time::ForceRule::default()
    };
    let spec = SchemeSpec { kind: kind.to_owned(), parameters, forces };
    if let Err(error) = spec.integrator()
        && !problems.iter().any(|p| p.path.starts_with(path))
    {
        let help = match &error {
            SchemeError::OutOfRange { hint, .. } => hint.clone(),
            SchemeError::Missing { examples, .. } | SchemeError::Superfluous { examples, .. } => {
                let written: Vec<_> = examples.iter().map(|example| format!("`{example}`")).collect();
                format!("write for example {}", written.join(" or "))
            }
            SchemeError::UnknownKind { .. } => suggest::help(kind, error.known().iter().copied()),
        };
        let why = keys::schemes().table(kind).map_or(keys::schemes().doc, |t| t.doc);
        problems.push(Problem::new(joined(path, error.key()), error.to_string(), why, help));
    }
    Some(spec)
}

/// A scheme by its kind and parameters `key=value`, as `carom explain` takes them.
pub fn read_scheme(kind: &str, parameters: &[String]) -> Result<SchemeSpec, CaseError> {
    let line = |parameter: &String| {
        let (key, value) =
            parameter.split_once('=').map_or((parameter.trim(), ""), |(k, v)| (k.trim(), v.trim()));
        // A word needs no quotes on the command line.
        let value = value.parse().unwrap_or_else(|_| toml_edit::Value::from(value));
        format!("{key} = {}", value.to_string().trim())
    };
    if let Some(parameter) = parameters.iter().find(|parameter| !parameter.contains('=')) {
        let what = format!("`{parameter}` is not a parameter");
        let (why, help) = ("parameters are written KEY=VALUE", "write for example rho_inf=0.1");
        return Err(CaseError::Wrong(vec![Diagnostic::of_file("carom explain", what, why, help)]));
    }
    let kind_line = format!("kind = {}", toml_edit::Value::from(kind));
    let text = std::iter::once(kind_line).chain(parameters.iter().map(line)).collect::<Vec<_>>().join("\n");
    let document = Document::parse("arguments", &text, &[])?;
    let mut problems = conform::variant(document.root(), keys::schemes());
    let spec = scheme(document.root(), Preset::Default, "", &mut problems);
    spec.filter(|_| problems.is_empty()).ok_or_else(|| document.diagnose_all(&problems))
}

fn newton(v: View) -> Option<NewtonSpec> {
    Some(NewtonSpec {
        tolerance: v.number("tolerance")?,
        max_iterations: v.count("max_iterations")?,
        tangent: v.choice("tangent")?,
        mixing: v.count("mixing")?,
    })
}

fn output(v: View) -> Option<OutputSpec> {
    let every = if v.has("at_times") { 0 } else { 20 };
    Some(OutputSpec {
        fields_every: if v.has("fields_every") { v.count("fields_every")? } else { every },
        format: v.choice("format")?,
        at_times: v.numbers("at_times")?,
        history_every: v.count("history_every")?,
        checkpoint_every: v.count("checkpoint_every")?,
    })
}
