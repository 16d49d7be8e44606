//! The study file as written: its keys, their types, and where each of them stands. A path names a
//! place as in [`carom_run::case::Problem`]: `arm[0].set."time.step"`.

use std::path::Path;

use carom_record::Expect;
use carom_record::metrics::Overlay;
use carom_record::study::design::{Goal, Kind};
use carom_record::study::ensemble::Ensemble;
use carom_run::case::{Asked, Document, OverlaySpec, Problem, read_expects, read_overlays};
use toml_edit::{Item, TableLike, Value};

use crate::typed::{assignment, flatten, known, not, one_of, tables, text, values};

pub(crate) const KEYS: [&str; 16] = [
    "title",
    "case",
    "set",
    "design",
    "steps",
    "cost_of",
    "goal",
    "accuracy",
    "reference",
    "fine",
    "ensemble",
    "arm",
    "grid",
    "overlay",
    "claim",
    "expect",
];
pub(crate) const FINE: [&str; 3] = ["set", "refine", "mesh"];
pub(crate) const ENSEMBLE: [&str; 4] = ["phases", "swapped", "mesh", "sets"];
pub(crate) const ARM: [&str; 5] = ["name", "case", "set", "expect", "match"];
pub(crate) const CLAIM: [&str; 2] = ["text", "compare"];

/// Name of the computed reference, unless an arm has this name.
pub(crate) const FINE_NAME: &str = "fine";

/// A study file that has been read; parts that could not be read are reported as problems.
#[derive(Default)]
pub(crate) struct StudyFile {
    pub(crate) title: Option<String>,
    /// Case file of the arms that do not name one.
    pub(crate) case: Option<String>,
    /// Changes of all arms and of the computed reference to their case.
    pub(crate) set: Vec<(String, Value)>,
    pub(crate) reference: Option<String>,
    /// How the arms, as methods, are made comparable.
    pub(crate) design: Option<Kind>,
    /// Steps of the levels.
    pub(crate) steps: Vec<f64>,
    /// The method whose cost is matched.
    pub(crate) cost_of: Option<String>,
    pub(crate) goal: Option<Goal>,
    pub(crate) accuracy: Option<f64>,
    /// Changes of the computed reference to the case.
    pub(crate) fine: Vec<(String, Value)>,
    /// Factor by which its step is smaller than the smallest one.
    pub(crate) refine: Option<u32>,
    /// Factors by which its meshes are finer, from the coarsest to the finest; empty: the given
    /// mesh.
    pub(crate) fine_mesh: Vec<f64>,
    /// What the members of every arm differ in.
    pub(crate) ensemble: Option<Ensemble>,
    pub(crate) arms: Vec<ArmEntry>,
    /// Keys with their values.
    pub(crate) grid: Vec<(String, Vec<Value>)>,
    /// Measured data.
    pub(crate) overlays: Vec<Overlay>,
    pub(crate) claims: Vec<carom_record::study::Claim>,
    /// Expectations of the study as a whole.
    pub(crate) expects: Vec<Expect>,
}

/// An `[[arm]]`.
pub(crate) struct ArmEntry {
    pub(crate) name: String,
    /// Keys with their values.
    pub(crate) set: Vec<(String, Value)>,
    /// Its case file, if it is not that of the study.
    pub(crate) case: Option<String>,
    /// Its expectations, as written.
    pub(crate) expect: Option<String>,
    /// Whether its cost is matched in a design of matched steps.
    pub(crate) by_cost: bool,
}

/// Reads the keys of a study file; the paths of its measured data start at `folder`.
pub(crate) fn read(document: &Document, folder: &Path, problems: &mut Vec<Problem>) -> StudyFile {
    let mut file = StudyFile::default();
    // `Document` has parsed the same text already.
    let Ok(parsed) = toml_edit::Document::parse(document.text()) else { return file };
    let root = parsed.as_table();
    if !document.is_study() && root.contains_key("body") {
        let why = "it has bodies, and neither `case`, `arm` nor `grid`";
        let help = "run it with carom run, or name it as the `case` of a study";
        problems.push(Problem::new("body", "this is a case, not a study", why, help).at_key());
        return file;
    }
    known(root, &KEYS, "a study", "", problems);
    file.title = text(root, "title", "", problems);
    file.reference = text(root, "reference", "", problems);
    file.set = values(root, "", "{ \"output.fields_every\" = 0 }", problems);
    comparison(root, &mut file, problems);
    file.ensemble = ensemble(root, problems);
    let arms = tables(root, "arm", problems);
    let named =
        !arms.is_empty() && !root.contains_key("grid") && arms.iter().all(|arm| arm.contains_key("case"));
    match text(root, "case", "", problems) {
        Some(case) => file.case = Some(case),
        None if root.contains_key("case") || named => {}
        None => problems.push(Problem::new(
            "",
            "the study has no `case`",
            "a study compares runs of one case",
            "add `case = \"impact.toml\"`, relative to this file",
        )),
    }
    for (i, table) in arms.into_iter().enumerate() {
        let path = format!("arm[{i}]");
        known(table, &ARM, "[[arm]]", &path, problems);
        let set = values(table, &path, "{ \"time.step\" = 1e-3 }", problems);
        let expect = expected(document, table, &format!("{path}.expect"), problems);
        let case = text(table, "case", &path, problems);
        let by_cost = matched(table, &path, file.design, problems);
        match text(table, "name", &path, problems) {
            Some(name) => file.arms.push(ArmEntry { name, set, case, expect, by_cost }),
            None if table.contains_key("name") => {}
            None => problems.push(
                Problem::new(
                    &path,
                    "the arm has no `name`",
                    "tables and figures identify arms by name",
                    "add `name = \"fine\"`",
                )
                .at_key(),
            ),
        }
    }
    match root.get("grid").map(Item::as_table_like) {
        Some(Some(table)) => {
            let mut entries = Vec::new();
            flatten(table, "", &mut entries);
            for (key, value) in entries {
                match value.as_array().filter(|list| !list.is_empty()) {
                    Some(list) => file.grid.push((key, list.iter().cloned().collect())),
                    None => problems.push(not(
                        &format!("grid.\"{key}\""),
                        "a list of values",
                        "\"time.step\" = [1e-3, 5e-4]",
                    )),
                }
            }
        }
        Some(None) => problems.push(not("grid", "a table", "[grid]")),
        None => {}
    }
    tables(root, "overlay", problems);
    let measured = |spec: OverlaySpec| {
        let OverlaySpec { name, column, times, values, source, .. } = spec;
        Overlay { name, column, times, values, source }
    };
    file.overlays = read_overlays(document, folder, problems).into_iter().map(measured).collect();
    tables(root, "expect", problems);
    file.expects = read_expects(document, "expect", Asked::OfArms, problems);
    for (i, table) in tables(root, "claim", problems).into_iter().enumerate() {
        let path = format!("claim[{i}]");
        known(table, &CLAIM, "[[claim]]", &path, problems);
        let (words, compare) =
            (text(table, "text", &path, problems), text(table, "compare", &path, problems));
        match (words, compare) {
            (Some(text), Some(compare)) => file.claims.push(carom_record::study::Claim { text, compare }),
            _ if table.contains_key("text") && table.contains_key("compare") => {}
            _ => {
                let why = "a claim is a statement and the comparison that decides it";
                let help = "add `text = \"…\"` and `compare = 'METRIC of \"ARM\" > METRIC of \"ARM\"'`";
                problems.push(
                    Problem::new(&path, "the claim needs both `text` and `compare`", why, help).at_key(),
                );
            }
        }
    }
    file
}

/// The keys that make arms comparable and rank them.
fn comparison(root: &dyn TableLike, file: &mut StudyFile, problems: &mut Vec<Problem>) {
    let kinds = [("matched-step", Kind::MatchedStep), ("matched-cost", Kind::MatchedCost)];
    file.design = one_of(root, "design", &kinds, problems);
    file.goal = one_of(root, "goal", &Goal::NAMES.map(|(name, goal, _)| (name, goal)), problems);
    file.cost_of = text(root, "cost_of", "", problems);
    let positive =
        |item: &Item| item.as_float().or_else(|| item.as_integer().map(|i| i as f64)).filter(|x| *x > 0.0);
    if let Some(item) = root.get("accuracy") {
        match positive(item) {
            Some(value) => file.accuracy = Some(value),
            None => problems.push(not("accuracy", "a positive number", "accuracy = 0.05")),
        }
    }
    if let Some(item) = root.get("steps") {
        let list = item
            .as_array()
            .map(|l| l.iter().map(|v| positive(&Item::Value(v.clone()))).collect::<Option<Vec<_>>>());
        match list {
            Some(Some(steps)) if !steps.is_empty() && steps.windows(2).all(|h| h[0] > h[1]) => {
                file.steps = steps;
            }
            _ => problems.push(not("steps", "a list of decreasing positive numbers", "steps = [1e-3, 5e-4]")),
        }
    }
    let of_designs = [("steps", !file.steps.is_empty()), ("cost_of", file.cost_of.is_some())];
    for (key, _) in of_designs.iter().filter(|(_, given)| *given && !root.contains_key("design")) {
        let why = "it defines the levels of a design, at which all methods are run";
        let help = "add `design = \"matched-step\"`, or put steps into [grid]";
        problems.push(Problem::new(*key, format!("`{key}` without a design"), why, help).at_key());
    }
    let Some(item) = root.get("fine") else { return };
    let Some(table) = item.as_table_like() else {
        problems.push(not("fine", "a table", "[fine]"));
        return;
    };
    known(table, &FINE, "[fine]", "fine", problems);
    file.fine = values(table, "fine", "{ \"time.scheme\" = { kind = \"hu\" } }", problems);
    if let Some(item) = table.get("refine") {
        match item.as_integer().and_then(|n| u32::try_from(n).ok()).filter(|n| *n > 0) {
            Some(n) => file.refine = Some(n),
            None => problems.push(not("fine.refine", "a positive integer", "refine = 8")),
        }
    }
    file.fine_mesh = factors(table, "fine", problems);
    if file.reference.as_deref() != Some(FINE_NAME) {
        let help = format!("add `reference = \"{FINE_NAME}\"`");
        problems.push(
            Problem::new("fine", "[fine] is not used", "it defines the computed reference", help).at_key(),
        );
    }
}

/// Most phases of an ensemble: beyond it, intervals no longer change.
const MOST_PHASES: u32 = 100;

/// The table [ensemble].
fn ensemble(root: &dyn TableLike, problems: &mut Vec<Problem>) -> Option<Ensemble> {
    let item = root.get("ensemble")?;
    let Some(table) = item.as_table_like() else {
        problems.push(not("ensemble", "a table", "[ensemble]"));
        return None;
    };
    known(table, &ENSEMBLE, "[ensemble]", "ensemble", problems);
    let phases = table.get("phases").map_or(Some(1), |item| {
        item.as_integer().and_then(|n| u32::try_from(n).ok()).filter(|n| (1..=MOST_PHASES).contains(n))
    });
    if phases.is_none() {
        problems.push(not("ensemble.phases", &format!("an integer from 1 to {MOST_PHASES}"), "phases = 5"));
    }
    let swapped = table.get("swapped").map_or(Some(false), Item::as_bool);
    if swapped.is_none() {
        problems.push(not("ensemble.swapped", "true or false", "swapped = true"));
    }
    let mut mesh = factors(table, "ensemble", problems);
    if mesh.is_empty() {
        mesh.push(1.0);
    }
    if mesh[0] != 1.0 {
        problems.push(Problem::new(
            "ensemble.mesh",
            format!("the first factor is {}, not 1", mesh[0]),
            "the arms themselves are members, on the given mesh",
            "write for example `mesh = [1, 1.5, 2]`",
        ));
    }
    let sets = changes(table, problems);
    let ensemble = Ensemble { phases: phases?, swapped: swapped?, mesh, sets };
    if ensemble.members().len() < 2 && problems.is_empty() {
        problems.push(
            Problem::new(
                "ensemble",
                "the ensemble has one member",
                "its members are all combinations of phases, roles and meshes",
                "add `phases = 5`",
            )
            .at_key(),
        );
    }
    Some(ensemble)
}

/// `sets` of an ensemble: each a table of values, as `key=value`.
fn changes(table: &dyn TableLike, problems: &mut Vec<Problem>) -> Vec<Vec<String>> {
    let Some(item) = table.get("sets") else { return Vec::new() };
    let of = |value: &Value| {
        let mut entries = Vec::new();
        flatten(value.as_inline_table()?, "", &mut entries);
        let set: Vec<String> = entries.iter().map(|(key, value)| assignment(key, value)).collect();
        (!set.is_empty()).then_some(set)
    };
    let list = item.as_array().and_then(|list| list.iter().map(of).collect::<Option<Vec<_>>>());
    list.unwrap_or_else(|| {
        let example = "sets = [{ \"contact.NAME.persistency\" = \"none\" }]";
        problems.push(not("ensemble.sets", "a list of tables of values", example));
        Vec::new()
    })
}

/// `mesh`, a list of increasing factors of at least 1; empty if it is not given.
fn factors(table: &dyn TableLike, path: &str, problems: &mut Vec<Problem>) -> Vec<f64> {
    let Some(item) = table.get("mesh") else { return Vec::new() };
    let number = |v: &Value| v.as_float().or_else(|| v.as_integer().map(|i| i as f64));
    let list = item.as_array().and_then(|list| list.iter().map(number).collect::<Option<Vec<f64>>>());
    let valid = |list: &Vec<f64>| {
        !list.is_empty()
            && list[0] >= 1.0
            && list.windows(2).all(|f| f[0] < f[1])
            && list[list.len() - 1] <= 64.0
    };
    list.filter(valid).unwrap_or_else(|| {
        let what = "a list of increasing numbers from 1 to 64";
        problems.push(not(&format!("{path}.mesh"), what, "mesh = [1, 2, 4]"));
        Vec::new()
    })
}

/// Checks the expectations of an arm, and returns them as the text that replaces those of its case.
fn expected(
    document: &Document,
    table: &dyn TableLike,
    path: &str,
    problems: &mut Vec<Problem>,
) -> Option<String> {
    let item = table.get("expect")?;
    read_expects(document, path, Asked::OfARun, problems);
    let text = match item {
        Item::Value(Value::Array(list)) => list.to_string(),
        Item::ArrayOfTables(list) => Value::Array(list.clone().into_array()).to_string(),
        _ => {
            problems.push(not(
                path,
                "a list of tables",
                "expect = [{ what = \"last A.uy\", value = 1.0, tolerance = 1e-3 }]",
            ));
            return None;
        }
    };
    Some(text.lines().map(str::trim).collect::<Vec<_>>().join(" "))
}

/// Whether the cost of an arm is matched to that of another, in a design of matched steps.
fn matched(table: &dyn TableLike, path: &str, design: Option<Kind>, problems: &mut Vec<Problem>) -> bool {
    let word = text(table, "match", path, problems);
    let place = format!("{path}.match");
    match (word.as_deref(), design) {
        (None, _) => return false,
        (Some("cost"), Some(Kind::MatchedStep)) => return true,
        (Some("cost"), _) => problems.push(Problem::new(
            place,
            "`match` without a design of matched steps",
            "it matches an arm by cost where the other arms have the steps of the design",
            "add `design = \"matched-step\"`; with \"matched-cost\" every arm is matched by cost already",
        )),
        (Some(word), _) => problems.push(Problem::new(
            place,
            format!("an arm cannot match \"{word}\""),
            "the only allowed value is \"cost\"",
            "write `match = \"cost\"`",
        )),
    }
    false
}
