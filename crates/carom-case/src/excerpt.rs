//! A case file reduced to some of its bodies and contacts, that continues from a saved state.

use std::collections::BTreeMap;

use toml_edit::{DocumentMut, Item, TableLike, Value, value};

use super::problem::{CaseError, Diagnostic};

/// Parts of a case that remain in an excerpt, and the files that it refers to.
#[derive(Clone, Debug, Default)]
pub struct Excerpt {
    /// Names of the bodies that remain.
    pub bodies: Vec<String>,
    /// Numbers of the tables of the contacts that remain, with another name if it needs one: that
    /// of the only contact that is left of those between bodies.
    pub contacts: BTreeMap<usize, Option<String>>,
    /// End time of the simulation.
    pub end: f64,
    /// File of the state from which the excerpt continues, beside the case.
    pub state: String,
    /// Mesh files of bodies beside the case.
    pub meshes: BTreeMap<String, String>,
    /// Files of surfaces of obstacles beside the case, by the number of the contact's table.
    pub surfaces: BTreeMap<usize, String>,
    /// Tables of loads beside the case, in the order of the loads; empty where there is none.
    pub tables: Vec<String>,
    /// Comment lines at the top of the file.
    pub comment: String,
}

/// The text of a case with its overrides applied.
///
/// # Errors
/// If the text or an override is not valid TOML.
pub fn merged(text: &str, sets: &[String]) -> Result<String, CaseError> {
    applied(text, sets).map(|case| case.to_string())
}

fn applied(text: &str, sets: &[String]) -> Result<DocumentMut, CaseError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let wrong = |name: &str, text: &str, e: &toml_edit::TomlError| {
        CaseError::Wrong(vec![Diagnostic::of_syntax(name, text, e)])
    };
    let mut case: DocumentMut = text.parse().map_err(|e| wrong("case", text, &e))?;
    for set in sets {
        apply(&mut case, set).ok_or_else(|| {
            let what = "an override of the run cannot be applied";
            let why = set.as_str();
            CaseError::of_file("--set", what, why, "")
        })?;
    }
    Ok(case)
}

/// Keys that an excerpt drops: those of measurements and expectations, and the initial state.
const WATCHED: [&str; 5] = ["probe", "overlay", "expect", "exact", "initial"];

impl Excerpt {
    /// The text of the reduced case, from that of the whole one with its overrides.
    ///
    /// # Errors
    /// If the text or an override is not valid TOML.
    pub fn of(&self, text: &str, sets: &[String]) -> Result<String, CaseError> {
        let mut case = applied(text, sets)?;
        WATCHED.iter().for_each(|key| {
            case.remove(key);
        });
        let mut load = 0;
        each(&mut case, "load", &mut |table| {
            if let Some(name) = self.tables.get(load).filter(|name| !name.is_empty()) {
                table.insert("table", value(name.as_str()));
            }
            load += 1;
        });
        let named = |table: &dyn TableLike, names: &[String]| {
            table.get("name").and_then(Item::as_str).is_some_and(|name| names.iter().any(|n| n == name))
        };
        let kept = |side: &str| self.bodies.iter().any(|body| side.split('.').next() == Some(body));
        retain(&mut case, "body", &mut |body| named(body, &self.bodies));
        let mut entry = 0..;
        retain(&mut case, "contact", &mut |_| entry.next().is_some_and(|k| self.contacts.contains_key(&k)));
        let mut tables = self.contacts.iter();
        each(&mut case, "contact", &mut |contact| {
            let Some((entry, name)) = tables.next() else { return };
            if let Some(name) = name {
                contact.insert("name", value(name.as_str()));
            }
            let primary = contact.get_mut("primary").and_then(Item::as_table_like_mut);
            let surface = primary.and_then(|primary| primary.get_mut("surface"));
            if let (Some(file), Some(surface)) =
                (self.surfaces.get(entry), surface.and_then(Item::as_table_like_mut))
            {
                surface.insert("file", value(file.as_str()));
            }
            if let Some(sides) = contact.get_mut("between").and_then(Item::as_array_mut) {
                sides.retain(|side| side.as_str().is_some_and(kept));
            }
        });
        retain(&mut case, "tie", &mut |tie| {
            ["secondary", "primary"].iter().all(|side| tie.get(side).and_then(Item::as_str).is_none_or(kept))
        });
        each(&mut case, "body", &mut |body| {
            // The state has it. The initial position says which depths a contact keeps.
            body.remove("velocity");
            let name = body.get("name").and_then(Item::as_str).unwrap_or_default().to_owned();
            if let (Some(file), Some(mesh)) =
                (self.meshes.get(&name), body.get_mut("mesh").and_then(Item::as_table_like_mut))
            {
                // The file may be that of an extrusion.
                let plane = if mesh.contains_key("of") { mesh.get_mut("of") } else { None };
                match plane.and_then(Item::as_table_like_mut) {
                    Some(of) => of.insert("file", value(file.as_str())),
                    None => mesh.insert("file", value(file.as_str())),
                };
            }
        });
        for list in ["support", "load"] {
            each(&mut case, list, &mut |table| {
                if let Some(on) = table.get_mut("on").and_then(Item::as_array_mut) {
                    on.retain(|side| side.as_str().is_some_and(kept));
                }
            });
            retain(&mut case, list, &mut |table| {
                let on = table.get("on").and_then(Item::as_array);
                on.is_none_or(|on| !on.is_empty())
                    && table.get("body").and_then(Item::as_str).is_none_or(kept)
            });
        }
        let mut used = Vec::new();
        each(&mut case, "body", &mut |body| {
            used.extend(body.get("material").and_then(Item::as_str).map(ToOwned::to_owned));
            let of_groups = body.get("materials").and_then(Item::as_table_like);
            let names = of_groups.into_iter().flat_map(TableLike::iter);
            used.extend(names.filter_map(|(_, name)| name.as_str().map(ToOwned::to_owned)));
        });
        retain(&mut case, "material", &mut |material| named(material, &used));
        let end = &mut case["time"]["end"];
        if number(end) != Some(self.end) {
            *end = value(self.end);
        }
        case["output"]["fields_every"] = value(1);
        case["output"]["history_every"] = value(1);
        if let Some(output) = case["output"].as_table_like_mut() {
            output.remove("at_times");
        }
        let mut initial = toml_edit::Table::new();
        initial.insert("from", value(self.state.as_str()));
        case.insert("initial", Item::Table(initial));
        let text = case.to_string();
        Ok(format!("{}\n{}", self.comment, text.trim_start()))
    }
}

/// Calls `of` for every table of the list `list` of a case.
fn each(case: &mut DocumentMut, list: &str, of: &mut dyn FnMut(&mut dyn TableLike)) {
    match case.get_mut(list) {
        Some(Item::ArrayOfTables(tables)) => tables.iter_mut().for_each(|table| of(table)),
        Some(Item::Value(Value::Array(tables))) => {
            tables.iter_mut().filter_map(Value::as_inline_table_mut).for_each(|table| of(table));
        }
        _ => {}
    }
}

/// Removes the tables of a list for which `keep` is false, and the list if none remains.
fn retain(case: &mut DocumentMut, list: &str, keep: &mut dyn FnMut(&dyn TableLike) -> bool) {
    let empty = match case.get_mut(list) {
        Some(Item::ArrayOfTables(tables)) => {
            tables.retain(|table| keep(table));
            tables.is_empty()
        }
        Some(Item::Value(Value::Array(tables))) => {
            tables.retain(|table| table.as_inline_table().is_some_and(|table| keep(table)));
            tables.is_empty()
        }
        _ => false,
    };
    if empty {
        case.remove(list);
    }
}

/// The value of an item that is an integer or a float.
fn number(item: &Item) -> Option<f64> {
    item.as_float().or_else(|| item.as_integer().map(|whole| whole as f64))
}

/// Applies an override `key=value`, as [`Document`](crate::Document) does.
fn apply(case: &mut DocumentMut, set: &str) -> Option<()> {
    let (key, text) = set.split_once('=')?;
    let keys = toml_edit::Key::parse(key).ok()?;
    let parsed = format!("v={text}\n").parse::<DocumentMut>();
    let mut new = parsed.ok().and_then(|mut v| v.remove("v")).unwrap_or_else(|| value(text.trim()));
    if let Some(new) = new.as_value_mut() {
        // Nothing stands between `=` and the value of an override.
        new.decor_mut().clear();
    }
    let mut item = case.as_item_mut();
    for (depth, key) in keys.iter().enumerate() {
        let key = key.get();
        let rest = &keys[depth + 1..];
        item = match item {
            Item::ArrayOfTables(tables) => {
                let is = |table: &toml_edit::Table| table.get("name").and_then(Item::as_str) == Some(key);
                let place = tables.iter().position(is)?;
                // A table of an array is no item: its last key is set here.
                return table_in(tables.get_mut(place)?, rest, new);
            }
            Item::Value(Value::Array(values)) => {
                let is = |v: &Value| {
                    v.as_inline_table().and_then(|t| t.get("name")).and_then(Value::as_str) == Some(key)
                };
                let place = values.iter().position(is)?;
                return table_in(values.get_mut(place)?.as_inline_table_mut()?, rest, new);
            }
            item => item.as_table_like_mut()?.entry(key).or_insert(Item::Table(toml_edit::Table::new())),
        };
    }
    *item = new;
    Some(())
}

/// Sets a key path in a table.
fn table_in(table: &mut dyn TableLike, keys: &[toml_edit::Key], new: Item) -> Option<()> {
    let (last, path) = keys.split_last()?;
    let mut table = table;
    for key in path {
        table = table
            .entry(key.get())
            .or_insert(Item::Value(Value::InlineTable(toml_edit::InlineTable::new())))
            .as_table_like_mut()?;
    }
    table.insert(last.get(), new);
    Some(())
}
