//! Every key of every shipped case, misspelt in three ways: each gives one error, whose help
//! suggests the right key.

use std::ops::Range;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use toml_edit::{Document, Item, Key, TableLike, Value};

use super::{BARS, resolved_as};

/// The byte spans of all keys, with their names.
fn keys(table: &dyn TableLike, found: &mut Vec<(Range<usize>, String)>) {
    for (key, item) in table.iter() {
        let span = table.key(key).and_then(Key::span);
        found.extend(span.map(|span| (span, key.to_owned())));
        // The keys of [exact] are names of columns.
        if key == "exact" {
            continue;
        }
        match item {
            Item::Table(table) => keys(table, found),
            Item::ArrayOfTables(tables) => tables.iter().for_each(|table| keys(table, found)),
            Item::Value(value) => keys_within(value, found),
            Item::None => {}
        }
    }
}

fn keys_within(value: &Value, found: &mut Vec<(Range<usize>, String)>) {
    match value {
        Value::InlineTable(table) => keys(table, found),
        Value::Array(list) => list.iter().for_each(|value| keys_within(value, found)),
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

/// Misspells every key of a case; returns the number of misspellings.
fn misspellings(name: &str, text: &str) -> usize {
    let document = Document::parse(text).unwrap();
    let mut found = Vec::new();
    keys(document.as_table(), &mut found);
    let mut checked = 0;
    for (span, key) in found {
        let doubled = format!("{key}{}", &key[key.len() - 1..]);
        // Keys of one letter, `x` and `y`, have no letters to swap.
        let swapped = key
            .get(1..2)
            .map_or_else(|| doubled.clone(), |second| format!("{second}{}{}", &key[..1], &key[2..]));
        let capital = format!("{}{}", key[..1].to_uppercase(), &key[1..]);
        for wrong in [doubled, swapped, capital].into_iter().filter(|wrong| *wrong != key) {
            let text = format!("{}{wrong}{}", &text[..span.start], &text[span.end..]);
            let problems = resolved_as(name, &text, &[]).expect_err(&wrong);
            // Also where a misspelt header leaves other tables of the same list.
            let found: Vec<_> = problems.iter().map(|p| format!("{} / {}", p.what, p.help)).collect();
            assert_eq!(problems.len(), 1, "{wrong} for {key}: {found:#?}");
            assert!(problems[0].what.starts_with(&format!("unknown key `{wrong}`")), "{found:?}");
            assert!(problems[0].help.contains(&format!("`{key}`")), "{found:?}");
            assert!(problems[0].quoted.contains(&wrong));
            checked += 1;
        }
    }
    checked
}

#[test]
fn every_misspelt_key_is_recognised() {
    let mut shipped = shipped(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases"));
    assert!(shipped.len() >= 2);
    shipped.push(("bars.toml".to_owned(), BARS.to_owned()));
    let (next, checked) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let work = || {
        while let Some((name, text)) = shipped.get(next.fetch_add(1, Ordering::Relaxed)) {
            checked.fetch_add(misspellings(name, text), Ordering::Relaxed);
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        work();
    });
    assert!(checked.into_inner() > 400);
}
