//! The study file: its tables with their keys, and what they say together. A path names a place as
//! in [`carom_run::case::Problem`]: `arm[0].set."time.step"`.

use std::path::Path;

use carom_case::keys::Kind::{ChangeLists, Changes, Choice, Count, Grid, Number, Numbers, Table, Tables};
use carom_case::keys::{Keys, POSITIVE, Range, View, Words};
use carom_case::{Asked, Document, EXPECT, OVERLAY, OverlaySpec, Problem, expects, overlays, read_table};
use carom_record::Expect;
use carom_record::metrics::Overlay;
use carom_record::study::design::{Goal, Kind};
use carom_record::study::ensemble::Ensemble;
use toml_edit::Value;

/// Name of the computed reference, unless an arm has this name.
pub(crate) const FINE_NAME: &str = "fine";

/// A comparison of many runs of one case.
#[derive(Default, Keys)]
#[keys(name = "a study", lenient)]
pub(crate) struct StudyFile {
    /// Title of the page.
    #[key(example = "\"Integrators\"")]
    pub(crate) title: Option<String>,
    /// The case file, relative to the study file.
    #[key(example = "\"impact.toml\"")]
    pub(crate) case: Option<String>,
    /// Values of the case that all arms and the computed reference replace.
    #[key(Changes, optional = "{ \"output.fields_every\" = 0 }", with = set)]
    pub(crate) set: Vec<(String, Value)>,
    /// How the arms are made comparable: as methods, each run at every one of `steps`
    /// (matched-step), or at the steps at which its cost equals that of the method `cost_of`
    /// (matched-cost).
    #[key(example = "\"matched-step\"")]
    pub(crate) design: Option<Kind>,
    /// Decreasing time steps of the levels of a design. Default: the step of the case.
    #[key(Numbers(POSITIVE), optional = "[1e-3, 5e-4]")]
    pub(crate) steps: Vec<f64>,
    /// The method whose cost the others are matched to, with matched cost or `match = "cost"`.
    /// Default: the first by name of those without a step of their own.
    #[key(example = "\"hht\"")]
    pub(crate) cost_of: Option<String>,
    /// Goal by which the arms are ranked.
    #[key(example = "\"force\"")]
    pub(crate) goal: Option<Goal>,
    /// Required accuracy: the largest acceptable error, its uncertainty included. Default: none,
    /// and 0.05 for the goal `cost`.
    #[key(Number(POSITIVE), example = "0.05")]
    pub(crate) accuracy: Option<f64>,
    /// Time over which contact forces and stresses are averaged. Default: 1/16 of the longest
    /// closed interval of contact of the reference.
    #[key(Number(POSITIVE), example = "1e-3")]
    pub(crate) window: Option<f64>,
    /// The arm that the others are compared with, "exact" for the formulas of [exact], or "fine"
    /// for a computed reference.
    #[key(example = "\"fine\"")]
    pub(crate) reference: Option<String>,
    /// The computed reference.
    #[key(optional = "{ refine = 8 }")]
    pub(crate) fine: Fine,
    /// Every arm is run several times, with all combinations of these changes; claims and rankings
    /// are then medians with intervals.
    #[key(Table(&Members::TABLE), example = "{ phases = 5 }", with = Members::ensemble)]
    pub(crate) ensemble: Option<Ensemble>,
    /// An arm: one variant of the case that is simulated.
    #[key(name = "arm", optional = "")]
    pub(crate) arms: Vec<ArmEntry>,
    /// Lists of values; every combination is an arm.
    #[key(Grid, optional = "{ \"time.step\" = [1e-3, 5e-4] }", with = grid)]
    pub(crate) grid: Vec<(String, Vec<Value>)>,
    /// Measured data.
    #[key(Tables(&OVERLAY), name = "overlay", optional = "", with = measured)]
    pub(crate) overlays: Vec<Overlay>,
    /// A claim about the arms, confirmed or refuted by a comparison.
    #[key(name = "claim", optional = "")]
    pub(crate) claims: Vec<ClaimKeys>,
    /// Expectations of the study as a whole.
    #[key(Tables(&EXPECT), name = "expect", optional = "", with = of_arms)]
    pub(crate) expects: Vec<Expect>,
}

/// The computed reference.
#[derive(Default, Keys)]
#[keys(name = "[fine]")]
pub(crate) struct Fine {
    /// Values of the case that it replaces. Default scheme: that of Chung and Hulbert with ρ∞ =
    /// 0.1.
    #[key(Changes, optional = "{ \"time.scheme\" = { kind = \"hu\" } }", with = set)]
    pub(crate) set: Vec<(String, Value)>,
    /// Factor by which its step is smaller than the smallest one of the study.
    #[key(Count(1), default = "8")]
    pub(crate) refine: usize,
    /// Factors by which its meshes are finer than that of the case, one for each run, the coarsest
    /// first; the steps shrink by the same factors, down to the finest one. Default: 1, 2 and 4 in
    /// one dimension, 1, 2 and 3 in the plane, and 1, 1.5 and 2 in space (1 and 2 where cells
    /// cannot be smaller by exactly 1.5). With 1 alone, only the steps are refined, and nothing is
    /// established.
    #[key(Numbers(FACTOR), optional = "[1, 2, 4]", with = factors)]
    pub(crate) mesh: Vec<f64>,
}

/// Every arm is run several times, with all combinations of these changes; claims and rankings are
/// then medians with intervals.
#[derive(Keys)]
#[keys(name = "[ensemble]")]
struct Members {
    /// Number of phases: shifts of the instants of the steps by 0, 1/n, … of a step (time.phase).
    #[key(Count(1), default = "1")]
    phases: usize,
    /// Whether every run is repeated with secondary and primary sides swapped.
    #[key(default = "false")]
    swapped: bool,
    /// Factors by which all meshes are refined; the first one is 1.
    #[key(Numbers(FACTOR), default = "[1]", with = factors)]
    mesh: Vec<f64>,
    /// Changes of the case with each of which every run is repeated; an arm that sets one of their
    /// keys itself is not.
    #[key(ChangeLists, optional = "[{ \"contact.NAME.persistency\" = \"none\" }]", with = sets)]
    sets: Vec<Vec<String>>,
}

/// An arm: one variant of the case that is simulated.
#[derive(Keys)]
#[keys(name = "[[arm]]")]
pub(crate) struct ArmEntry {
    /// Name in tables, figures and claims.
    #[key(example = "\"fine\"")]
    pub(crate) name: String,
    /// Case file of this arm, relative to the study file, instead of that of the study.
    #[key(example = "\"impact.toml\"")]
    pub(crate) case: Option<String>,
    /// Values of the case that this arm replaces: "time.step" = 1e-3, "body.cylinder.element" =
    /// "T6".
    #[key(Changes, optional = "{ \"time.step\" = 1e-3 }", with = set)]
    pub(crate) set: Vec<(String, Value)>,
    /// Expectations of this arm, as the override that replaces those of its case.
    #[key(Tables(&EXPECT), optional = "[{ what = \"last A.uy\", value = 1.0, tolerance = 1e-3 }]", with = of_arm)]
    pub(crate) expect: Option<String>,
    /// In a design of matched steps: at every level, this method has the step at which its cost
    /// equals that of `cost_of`; meant for explicit schemes.
    #[key(Choice(Words::plain(&["cost"])), name = "match", optional = "\"cost\"", given)]
    pub(crate) by_cost: bool,
}

/// A claim about the arms, confirmed or refuted by a comparison.
#[derive(Keys)]
#[keys(name = "[[claim]]")]
pub(crate) struct ClaimKeys {
    /// The claim, in words.
    #[key(example = "\"A is smoother than B\"")]
    pub(crate) text: String,
    /// The comparison that decides it: 'METRIC of "ARM" > METRIC of "ARM"'.
    #[key(example = "'restitution of \"A\" > restitution of \"B\"'")]
    pub(crate) compare: String,
}

fn set(v: &View) -> Option<Vec<(String, Value)>> {
    v.changes("set")
}

/// The lists of values of the grid.
fn grid(v: &View) -> Option<Vec<(String, Vec<Value>)>> {
    let list = |(key, value): (String, Value)| Some((key, value.as_array()?.iter().cloned().collect()));
    v.changes("grid")?.into_iter().map(list).collect()
}

/// The changes of an ensemble, each as `key=value`.
fn sets(v: &View) -> Option<Vec<Vec<String>>> {
    let of = |(key, value): &(String, Value)| assignment(key, value);
    Some(v.lists_of_changes("sets")?.iter().map(|set| set.iter().map(of).collect()).collect())
}

fn measured(v: &View) -> Option<Vec<Overlay>> {
    let of = |spec: OverlaySpec| {
        let OverlaySpec { name, column, times, values, source, .. } = spec;
        Overlay { name, column, times, values, source }
    };
    Some(overlays(v)?.into_iter().flatten().map(of).collect())
}

fn of_arms(v: &View) -> Option<Vec<Expect>> {
    Some(expects(v, Asked::OfArms)?.into_iter().flatten().collect())
}

/// The expectations of an arm, checked, as TOML.
fn of_arm(v: &View) -> Option<String> {
    expects(v, Asked::OfARun)?;
    v.toml("expect").map(|list| list.to_string())
}

/// Refinement of meshes.
const FACTOR: Range = Range { low: Some((1.0, true)), high: Some((64.0, true)) };

/// `mesh`, a list of increasing factors; empty if it is not given.
fn factors(v: &View) -> Option<Vec<f64>> {
    let list: Vec<f64> = v.get("mesh")?;
    if list.windows(2).all(|pair| pair[0] < pair[1]) {
        return Some(list);
    }
    let why = "its numbers are factors by which meshes are finer, the coarsest first";
    v.wrong("mesh", "the numbers of `mesh` do not increase", why, "write for example `mesh = [1, 2, 4]`")
}

/// Most phases of an ensemble: beyond it, intervals no longer change.
const MOST_PHASES: usize = 100;

impl Members {
    /// The ensemble of a study, if it has one.
    fn ensemble(study: &View) -> Option<Ensemble> {
        let v = study.at("ensemble").filter(|_| study.has("ensemble"))?;
        let Self { phases, swapped, mesh, sets } = Self::read(&v)?;
        if phases > MOST_PHASES {
            let what = format!("`phases` must be an integer from 1 to {MOST_PHASES}, not {phases}");
            return v.wrong(
                "phases",
                what,
                "with more of them, intervals no longer change",
                "write for example `phases = 5`",
            );
        }
        if sets.iter().any(Vec::is_empty) {
            let example = "write for example `sets = [{ \"contact.NAME.persistency\" = \"none\" }]`";
            return v.wrong(
                "sets",
                "one of the changes is empty",
                "the arms themselves are without a change",
                example,
            );
        }
        if mesh.first().is_some_and(|first| *first != 1.0) {
            let what = format!("the first factor is {}, not 1", mesh[0]);
            let why = "the arms themselves are members, on the given mesh";
            return v.wrong("mesh", what, why, "write for example `mesh = [1, 1.5, 2]`");
        }
        let ensemble = Ensemble { phases: phases as u32, swapped, mesh, sets };
        if ensemble.members().len() < 2 && !v.has_unknown_key() {
            let why = "its members are all combinations of phases, roles and meshes";
            return study.wrong_key("ensemble", "the ensemble has one member", why, "add `phases = 5`");
        }
        Some(ensemble)
    }
}

/// Reads a study file; the paths of its measured data start at `folder`.
pub(crate) fn read(document: &Document, folder: &Path, problems: &mut Vec<Problem>) -> StudyFile {
    if !document.is_study() && document.has("body") {
        let why = "it has bodies, and neither `case`, `arm` nor `grid`";
        let help = "run it with carom run, or name it as the `case` of a study";
        problems.push(Problem::new("body", "this is a case, not a study", why, help).at_key());
        return StudyFile::default();
    }
    let file: StudyFile = read_table(document, folder, problems);
    let named =
        file.grid.is_empty() && !file.arms.is_empty() && file.arms.iter().all(|arm| arm.case.is_some());
    let is_unread = document.has("arm") && file.arms.is_empty();
    let is_refined =
        file.reference.as_deref() == Some(FINE_NAME) && file.arms.iter().all(|arm| arm.name != FINE_NAME);
    if !document.has("case") && !is_unread && (!named || is_refined) {
        let why =
            if named { "the computed reference refines it" } else { "a study compares runs of one case" };
        let help = "add `case = \"impact.toml\"`, relative to this file";
        problems.push(Problem::new("", "the study has no `case`", why, help));
    }
    design(document, &file, problems);
    file
}

/// Checks the keys that make arms comparable.
fn design(document: &Document, file: &StudyFile, problems: &mut Vec<Problem>) {
    if file.steps.windows(2).any(|pair| pair[0] <= pair[1]) {
        let what = "the numbers of `steps` do not decrease";
        let help = "write for example `steps = [1e-3, 5e-4]`";
        problems.push(Problem::new(
            "steps",
            what,
            "they are the levels of a design, the coarsest first",
            help,
        ));
    }
    for key in ["steps", "cost_of"].into_iter().filter(|key| document.has(key) && !document.has("design")) {
        let why = "it defines the levels of a design, at which all methods are run";
        let help = "add `design = \"matched-step\"`, or put steps into [grid]";
        problems.push(Problem::new(key, format!("`{key}` without a design"), why, help).at_key());
    }
    for (i, _) in
        file.arms.iter().enumerate().filter(|(_, arm)| arm.by_cost && file.design != Some(Kind::MatchedStep))
    {
        let why = "it matches an arm by cost where the other arms have the steps of the design";
        let help =
            "add `design = \"matched-step\"`; with \"matched-cost\" every arm is matched by cost already";
        let what = "`match` without a design of matched steps";
        problems.push(Problem::new(format!("arm[{i}].match"), what, why, help));
    }
    if document.has("fine") && file.reference.as_deref() != Some(FINE_NAME) {
        let help = format!("add `reference = \"{FINE_NAME}\"`");
        let why = "it defines the computed reference";
        problems.push(Problem::new("fine", "[fine] is not used", why, help).at_key());
    }
}

/// Text of an assignment, `key=value`.
pub(crate) fn assignment(key: &str, value: &Value) -> String {
    format!("{key}={}", one_line(value))
}

/// A value as it is written, on one line.
pub(crate) fn one_line(value: &Value) -> String {
    value.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}
