//! A case file: its tables, as they are read one by one, for `check` to compare.

use std::collections::BTreeMap;

use carom_record::Expect;

use crate::expect::{self, Asked, Exact, ExpectKeys};
use crate::keys::Kind::{self, ByColumn, Formulas, Number, Tables};
use crate::keys::{IN_SPACE_AND_TIME, Keys, POSITIVE, Range, View};
use crate::overlay;
use crate::spec::{
    self, BodySpec, ContactSpec, FormulaSpec, InitialSpec, LoadKeys, LoadSpec, MaterialKeys, MaterialSpec,
    NewtonSpec, OutputSpec, OverlaySpec, Plane, Preset, ProbeSpec, SupportKeys, SupportSpec, TieSpec,
    TimeSpec, Units,
};
use crate::tree::{Entry, Node};

/// One simulation of impact or contact of deformable bodies.
#[derive(Default, Keys)]
#[keys(name = "the case", lenient)]
pub struct Draft {
    /// Title of figures and report pages. Default: the name of the file.
    #[key(example = "\"Two bars\"")]
    pub(crate) title: Option<String>,
    /// Space dimension: 1 (bars), 2 (the plane) or 3.
    #[key(Kind::Count(1), example = "2", required)]
    pub(crate) dimension: Option<usize>,
    /// Plane state, in dimension 2.
    #[key(default = "\"strain\"")]
    pub(crate) plane: Option<Plane>,
    /// Out-of-plane thickness; in dimension 1, the area of the cross-section.
    #[key(Number(POSITIVE), unit = "length, or length² in dimension 1", default = "1.0")]
    pub(crate) thickness: Option<f64>,
    /// Refinement of all meshes: built-in shapes are made with cells smaller by this factor;
    /// numbers of `cells` are multiplied by it and must remain whole; for meshes of files it must
    /// be an integer, the number of parts into which every edge is divided.
    #[key(Number(AT_LEAST_ONE), default = "1.0")]
    pub(crate) refine: Option<f64>,
    /// Unit labels in figures and columns; values are not converted.
    #[key(Kind::Table(&Units::TABLE), example = "{ length = \"m\", time = \"s\", mass = \"kg\" }", with = units)]
    pub(crate) units: Option<Units>,
    /// Set of default values; keys given explicitly take precedence.
    #[key(default = "\"default\"")]
    pub(crate) preset: Option<Preset>,
    /// A material; bodies refer to it by name.
    #[key(Tables(&MaterialKeys::TABLE), with = spec::materials)]
    pub(crate) material: Vec<Option<MaterialSpec>>,
    /// A deformable body.
    #[key()]
    pub(crate) body: Vec<Option<BodySpec>>,
    /// Displacement boundary condition: sides fixed or moved in given directions.
    #[key(Tables(&SupportKeys::TABLE), optional = "", with = spec::supports)]
    pub(crate) support: Vec<Option<SupportSpec>>,
    /// A load: traction or pressure on sides, or body force in a body.
    #[key(Tables(&LoadKeys::TABLE), optional = "", with = spec::loads)]
    pub(crate) load: Vec<Option<LoadSpec>>,
    /// Start from the final state of another run instead of the reference positions. After a
    /// finished run time starts at 0 again, also in the formulas of loads and motions; a saved
    /// state continues at its time.
    #[key(optional = "")]
    pub(crate) initial: Option<InitialSpec>,
    /// A manufactured solution: load, boundary motion and initial state are derived from it, and
    /// errors are measured against it.
    #[key(optional = "")]
    pub(crate) manufactured: Option<Manufactured>,
    /// A contact pair: two sides that may come into contact.
    #[key(Tables(&ContactSpec::TABLE), optional = "", with = contacts)]
    pub(crate) contact: Vec<Option<ContactSpec>>,
    /// A tie: a side whose nodes move with another side.
    #[key(optional = "")]
    pub(crate) tie: Vec<Option<TieSpec>>,
    /// Time interval, time step and time integrator.
    #[key(required)]
    pub(crate) time: Option<TimeSpec>,
    /// Settings of Newton's method.
    #[key(optional = "")]
    pub(crate) newton: NewtonSpec,
    /// Measured data, drawn with a column of history.csv and compared with it.
    #[key(Tables(&overlay::OVERLAY), optional = "", with = overlay::overlays)]
    pub(crate) overlay: Vec<Option<OverlaySpec>>,
    /// A material point whose quantities are recorded as columns of history.csv.
    #[key(optional = "")]
    pub(crate) probe: Vec<Option<ProbeSpec>>,
    /// What is written, and how often.
    #[key(optional = "")]
    pub(crate) output: OutputSpec,
    /// Exact solution by column, as formulas in t: used by `formula = "exact"` in [[expect]] and by
    /// `reference = "exact"` in a study.
    #[key(ByColumn, optional = "{ \"A.uy\" = \"-0.5*9.81*t^2\" }", with = exact)]
    pub(crate) exact: BTreeMap<String, String>,
    /// An expected value; a case that has one is also a test.
    #[key(Tables(&ExpectKeys::TABLE), optional = "", with = expects)]
    pub(crate) expect: Vec<Option<Expect>>,
}

const AT_LEAST_ONE: Range = Range { low: Some((1.0, true)), high: None };

fn units(v: &View) -> Option<Units> {
    Some(Units { declared: v.has("units"), ..Units::read(&v.at("units")?)? })
}

/// A manufactured solution for all bodies: the load is ρÿ − Div P, boundary nodes follow the given
/// motion, and history.csv has the columns error_l2 and error_h1.
#[derive(Keys)]
#[keys(name = "[manufactured]")]
pub(crate) struct Manufactured {
    /// Current positions as formulas in X, Y, Z and t.
    #[key(
        Formulas(IN_SPACE_AND_TIME),
        unit = "length",
        example = "[\"X + 0.1*sin(X + 2*Y)*t\", \"Y - 0.1*cos(X*Y)*t\"]"
    )]
    pub(crate) y: Vec<FormulaSpec>,
}

/// The contacts of a case as its tables declare them.
fn contacts(v: &View) -> Option<Vec<Option<ContactSpec>>> {
    let mut entry = 0..;
    v.each("contact", |v| ContactSpec::of(v, entry.next()?))
}

/// The expectations of a case.
fn expects(v: &View) -> Option<Vec<Option<Expect>>> {
    let formulas = exact(v)?;
    // An unknown key may be a misspelt `exact`.
    let known = if v.has_unknown_key() { Exact::Later } else { Exact::Of(&formulas) };
    v.each("expect", |v| expect::one(v, Asked::OfARun, known))
}

/// Formulas by column, as written.
fn exact(v: &View) -> Option<BTreeMap<String, String>> {
    let table = v.table.get("exact").map_or(Some(View::EMPTY), Node::table)?;
    let formula = |entry: &Entry| {
        let node = &entry.node;
        let text = node.text().map(str::to_owned);
        Some((entry.key.clone(), text.or_else(|| Some(node.number()?.to_string()))?))
    };
    Some(table.0.iter().filter_map(formula).collect())
}
