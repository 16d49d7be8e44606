//! Values of a study file by their types: what is of another type, or no known key, is a problem
//! with its place.

use carom_run::case::Problem;
use toml_edit::{Item, TableLike, Value};

/// The value that a word stands for.
pub(crate) fn one_of<T: Copy>(
    root: &dyn TableLike,
    key: &str,
    known: &[(&str, T)],
    problems: &mut Vec<Problem>,
) -> Option<T> {
    let word = text(root, key, "", problems)?;
    let found = known.iter().find(|(name, _)| *name == word).map(|(_, value)| *value);
    if found.is_none() {
        let names = known.iter().map(|(name, _)| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
        let near =
            known.iter().min_by_key(|(name, _)| strsim::damerau_levenshtein(name, &word)).map_or("", |n| n.0);
        let what = format!("there is no {key} \"{word}\"");
        problems.push(Problem::new(
            key,
            what,
            format!("{key} is one of {names}"),
            format!("did you mean \"{near}\"?"),
        ));
    }
    found
}

/// Changes in the `set` of a table.
pub(crate) fn values(
    table: &dyn TableLike,
    path: &str,
    example: &str,
    problems: &mut Vec<Problem>,
) -> Vec<(String, Value)> {
    let mut set = Vec::new();
    match table.get("set").map(Item::as_table_like) {
        Some(Some(values)) => flatten(values, "", &mut set),
        Some(None) => {
            let place = if path.is_empty() { "set".to_owned() } else { format!("{path}.set") };
            problems.push(not(&place, "a table", &format!("set = {example}")));
        }
        None => {}
    }
    set
}

/// TOML reads dotted keys as nested tables; here they are single keys.
pub(crate) fn flatten(table: &dyn TableLike, before: &str, out: &mut Vec<(String, Value)>) {
    for (key, item) in table.iter() {
        let key = format!("{before}{key}");
        match item {
            Item::Value(Value::InlineTable(inner)) if inner.is_dotted() => {
                flatten(inner, &format!("{key}."), out);
            }
            Item::Table(inner) => flatten(inner, &format!("{key}."), out),
            Item::Value(value) => out.push((key, value.clone())),
            Item::ArrayOfTables(_) | Item::None => {}
        }
    }
}

/// `key=value`.
pub(crate) fn assignment(key: &str, value: &Value) -> String {
    format!("{key}={}", one_line(value))
}

/// A value as it is written, on one line.
pub(crate) fn one_line(value: &Value) -> String {
    value.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The tables of a list.
pub(crate) fn tables<'a>(
    root: &'a dyn TableLike,
    key: &str,
    problems: &mut Vec<Problem>,
) -> Vec<&'a dyn TableLike> {
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

/// A string.
pub(crate) fn text(
    table: &dyn TableLike,
    key: &str,
    path: &str,
    problems: &mut Vec<Problem>,
) -> Option<String> {
    let item = table.get(key)?;
    let found = item.as_str().map(str::to_owned);
    if found.is_none() {
        let path = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
        problems.push(not(&path, "a string", &format!("{key} = \"…\"")));
    }
    found
}

/// A value of another type.
pub(crate) fn not(path: &str, what: &str, example: &str) -> Problem {
    let key = path.rsplit('.').next().unwrap_or(path);
    Problem::new(
        path,
        format!("`{key}` is not {what}"),
        format!("it must be {what}"),
        format!("write it as `{example}`"),
    )
}

/// That a table has no unknown keys.
pub(crate) fn known(
    table: &dyn TableLike,
    keys: &[&str],
    name: &str,
    path: &str,
    problems: &mut Vec<Problem>,
) {
    for (key, _) in table.iter().filter(|(key, _)| !keys.contains(key)) {
        let near = keys.iter().min_by_key(|k| strsim::damerau_levenshtein(key, k));
        let near = near.filter(|k| strsim::damerau_levenshtein(key, k) <= (key.chars().count() / 3).max(1));
        let help = near
            .map_or_else(|| format!("use one of: {}", keys.join(", ")), |k| format!("did you mean `{k}`?"));
        let path = if path.is_empty() { format!("\"{key}\"") } else { format!("{path}.\"{key}\"") };
        let why = format!("the keys of {name} are: {}", keys.join(", "));
        problems.push(Problem::new(path, format!("unknown key `{key}` in {name}"), why, help).at_key());
    }
}
