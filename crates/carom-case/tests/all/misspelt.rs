//! Every key of the shipped cases, misspelt: each gives one error, whose help suggests the right
//! key. The first of the keys with one path is misspelt in three ways, the others in one of them in
//! turn, because the suggestion depends on the keys of the table alone; by day three of each path.

use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use toml_edit::{Document, Item, Key, TableLike, Value};

use super::{BARS, resolved_as};

/// The byte spans of all keys, with their paths.
fn keys(table: &dyn TableLike, path: &str, found: &mut Vec<(Range<usize>, String)>) {
    for (key, item) in table.iter() {
        let span = table.key(key).and_then(Key::span);
        let path = &format!("{path}.{key}");
        found.extend(span.map(|span| (span, path.clone())));
        // The keys of [exact] are names of columns, those of `materials` names of groups.
        if ["exact", "materials"].contains(&key) {
            continue;
        }
        match item {
            Item::Table(table) => keys(table, path, found),
            Item::ArrayOfTables(tables) => tables.iter().for_each(|table| keys(table, path, found)),
            Item::Value(value) => keys_within(value, path, found),
            Item::None => {}
        }
    }
}

fn keys_within(value: &Value, path: &str, found: &mut Vec<(Range<usize>, String)>) {
    match value {
        Value::InlineTable(table) => keys(table, path, found),
        Value::Array(list) => list.iter().for_each(|value| keys_within(value, path, found)),
        _ => {}
    }
}

/// Every case of a directory and its subdirectories, without studies.
fn shipped(directory: &Path) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(shipped(&path));
        } else if path.extension().is_some_and(|e| e == "toml") {
            let text = std::fs::read_to_string(&path).unwrap();
            found.extend(text.contains("[[body]]").then(|| (path.display().to_string(), text)));
        }
    }
    found
}

/// Misspells keys of a case, as long as fewer than `most` with the same path are met; returns the
/// number of misspellings. `met` counts the keys of every path.
fn misspellings(name: &str, text: &str, most: usize, met: &Mutex<HashMap<String, usize>>) -> usize {
    let document = Document::parse(text).unwrap();
    let mut found = Vec::new();
    keys(document.as_table(), "", &mut found);
    let mut checked = 0;
    for (span, path) in found {
        let key = path.rsplit('.').next().unwrap_or_default();
        let before = {
            let mut met = met.lock().unwrap();
            let count = met.entry(path.clone()).or_default();
            *count += 1;
            *count - 1
        };
        if before >= most {
            continue;
        }
        let doubled = format!("{key}{}", &key[key.len() - 1..]);
        // Keys of one letter, `x` and `y`, have no letters to swap.
        let swapped = key
            .get(1..2)
            .map_or_else(|| doubled.clone(), |second| format!("{second}{}{}", &key[..1], &key[2..]));
        let capital = format!("{}{}", key[..1].to_uppercase(), &key[1..]);
        let ways = [doubled, swapped, capital];
        let chosen = if before == 0 { &ways[..] } else { std::slice::from_ref(&ways[before % 3]) };
        for wrong in chosen.iter().filter(|wrong| *wrong != key) {
            let text = format!("{}{wrong}{}", &text[..span.start], &text[span.end..]);
            let problems = resolved_as(name, &text, &[]).expect_err(wrong);
            // Also where a misspelt header leaves other tables of the same list.
            let found: Vec<_> = problems.iter().map(|p| format!("{} / {}", p.what, p.help)).collect();
            assert_eq!(problems.len(), 1, "{wrong} for {key}: {found:#?}");
            assert!(problems[0].what.starts_with(&format!("unknown key `{wrong}`")), "{found:?}");
            assert!(problems[0].help.contains(&format!("`{key}`")), "{found:?}");
            assert!(problems[0].quoted.contains(wrong.as_str()));
            checked += 1;
        }
    }
    checked
}

/// Misspells keys of all shipped cases, at most so many of one path; returns the number of
/// misspellings.
fn recognised(most: usize) -> usize {
    let mut shipped = shipped(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases"));
    assert!(shipped.len() >= 2);
    shipped.push(("bars.toml".to_owned(), BARS.to_owned()));
    let next = AtomicUsize::new(0);
    let checked = AtomicUsize::new(0);
    let met = Mutex::default();
    let work = || {
        while let Some((name, text)) = shipped.get(next.fetch_add(1, Ordering::Relaxed)) {
            checked.fetch_add(misspellings(name, text, most, &met), Ordering::Relaxed);
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        work();
    });
    checked.into_inner()
}

#[test]
fn misspelt_keys_are_recognised() {
    assert!(recognised(3) > 400);
}

#[test]
#[ignore = "every key of every case: .ci/nightly"]
fn every_misspelt_key_is_recognised() {
    assert!(recognised(usize::MAX) > 4000);
}
