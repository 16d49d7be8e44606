//! The study file as written: its keys, their types, and where each of them stands. A path names a place as in
//! [`carom::case::Problem`]: `arm[0].set."time.step"`.

use carom::case::{Asked, Document, Problem, read_expects};
use carom_record::Expect;
use toml_edit::{Item, TableLike, Value};

pub(crate) const KEYS: [&str; 7] = ["title", "case", "reference", "arm", "grid", "claim", "expect"];
pub(crate) const ARM: [&str; 4] = ["name", "case", "set", "expect"];
pub(crate) const CLAIM: [&str; 2] = ["text", "compare"];

/// A study file, read; what could not be read is a problem.
#[derive(Default)]
pub(crate) struct StudyFile {
    pub(crate) title: Option<String>,
    /// Case of the arms that name none.
    pub(crate) case: Option<String>,
    pub(crate) reference: Option<String>,
    pub(crate) arms: Vec<ArmEntry>,
    /// Keys with their values.
    pub(crate) grid: Vec<(String, Vec<Value>)>,
    pub(crate) claims: Vec<carom_record::study::Claim>,
    /// What is expected of the arms together.
    pub(crate) expects: Vec<Expect>,
}

/// An `[[arm]]`.
pub(crate) struct ArmEntry {
    pub(crate) name: String,
    /// Keys with their values.
    pub(crate) set: Vec<(String, Value)>,
    /// The case file it names instead of the study's.
    pub(crate) case: Option<String>,
    /// What is expected of its record, as written.
    pub(crate) expect: Option<String>,
}

/// Reads the keys of a study file.
pub(crate) fn read(document: &Document, problems: &mut Vec<Problem>) -> StudyFile {
    let mut file = StudyFile::default();
    // `Document` has parsed the same text already.
    let Ok(parsed) = toml_edit::Document::parse(document.text()) else { return file };
    let root = parsed.as_table();
    known(root, &KEYS, "a study", "", problems);
    file.title = text(root, "title", "", problems);
    file.reference = text(root, "reference", "", problems);
    let arms = tables(root, "arm", problems);
    let named = !arms.is_empty() && !root.contains_key("grid") && arms.iter().all(|arm| arm.contains_key("case"));
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
        let mut set = Vec::new();
        match table.get("set").and_then(Item::as_table_like) {
            Some(values) => flatten(values, "", &mut set),
            None if table.contains_key("set") => {
                problems.push(not(&format!("{path}.set"), "a table", "set = { \"time.step\" = 1e-3 }"));
            }
            None => {}
        }
        let expect = expected(document, table, &format!("{path}.expect"), problems);
        let case = text(table, "case", &path, problems);
        match text(table, "name", &path, problems) {
            Some(name) => file.arms.push(ArmEntry { name, set, case, expect }),
            None if table.contains_key("name") => {}
            None => problems.push(
                Problem::new(
                    &path,
                    "the arm has no `name`",
                    "tables and figures call it by its name",
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
    tables(root, "expect", problems);
    file.expects = read_expects(document, "expect", Asked::OfArms, problems);
    for (i, table) in tables(root, "claim", problems).into_iter().enumerate() {
        let path = format!("claim[{i}]");
        known(table, &CLAIM, "[[claim]]", &path, problems);
        let (words, compare) = (text(table, "text", &path, problems), text(table, "compare", &path, problems));
        match (words, compare) {
            (Some(text), Some(compare)) => file.claims.push(carom_record::study::Claim { text, compare }),
            _ if table.contains_key("text") && table.contains_key("compare") => {}
            _ => {
                let why = "a claim is a statement and the comparison that decides it";
                let help = "add `text = \"…\"` and `compare = 'METRIC of \"ARM\" > METRIC of \"ARM\"'`";
                problems.push(Problem::new(&path, "the claim has not both `text` and `compare`", why, help).at_key());
            }
        }
    }
    file
}

/// Expectations of an arm: checked where they stand, and as the text that replaces those of its case.
fn expected(document: &Document, table: &dyn TableLike, path: &str, problems: &mut Vec<Problem>) -> Option<String> {
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

/// Dotted keys are tables to TOML and one key here.
fn flatten(table: &dyn TableLike, before: &str, out: &mut Vec<(String, Value)>) {
    for (key, item) in table.iter() {
        let key = format!("{before}{key}");
        match item {
            Item::Value(Value::InlineTable(inner)) if inner.is_dotted() => flatten(inner, &format!("{key}."), out),
            Item::Table(inner) => flatten(inner, &format!("{key}."), out),
            Item::Value(value) => out.push((key, value.clone())),
            Item::ArrayOfTables(_) | Item::None => {}
        }
    }
}

fn tables<'a>(root: &'a dyn TableLike, key: &str, problems: &mut Vec<Problem>) -> Vec<&'a dyn TableLike> {
    match root.get(key) {
        None => Vec::new(),
        Some(Item::ArrayOfTables(list)) => list.iter().map(|t| t as &dyn TableLike).collect(),
        Some(Item::Value(Value::Array(list))) if list.iter().all(Value::is_inline_table) => {
            list.iter().filter_map(Value::as_inline_table).map(|t| t as &dyn TableLike).collect()
        }
        Some(_) => {
            problems.push(not(key, "a list of tables", &format!("[[{key}]]")));
            Vec::new()
        }
    }
}

fn text(table: &dyn TableLike, key: &str, path: &str, problems: &mut Vec<Problem>) -> Option<String> {
    let item = table.get(key)?;
    let found = item.as_str().map(str::to_owned);
    if found.is_none() {
        let path = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
        problems.push(not(&path, "a text", &format!("{key} = \"…\"")));
    }
    found
}

fn not(path: &str, what: &str, example: &str) -> Problem {
    let key = path.rsplit('.').next().unwrap_or(path);
    Problem::new(
        path,
        format!("`{key}` is not {what}"),
        format!("it must be {what}"),
        format!("write it as `{example}`"),
    )
}

fn known(table: &dyn TableLike, keys: &[&str], name: &str, path: &str, problems: &mut Vec<Problem>) {
    for (key, _) in table.iter().filter(|(key, _)| !keys.contains(key)) {
        let near = keys.iter().min_by_key(|k| strsim::damerau_levenshtein(key, k));
        let near = near.filter(|k| strsim::damerau_levenshtein(key, k) <= (key.chars().count() / 3).max(1));
        let help = near.map_or_else(|| format!("use one of: {}", keys.join(", ")), |k| format!("did you mean `{k}`?"));
        let path = if path.is_empty() { format!("\"{key}\"") } else { format!("{path}.\"{key}\"") };
        let why = format!("{name} has the keys {}", keys.join(", "));
        problems.push(Problem::new(path, format!("unknown key `{key}` in {name}"), why, help).at_key());
    }
}
