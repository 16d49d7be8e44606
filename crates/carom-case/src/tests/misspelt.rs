//! Every key of every shipped case, misspelt in three ways: each gives one error, whose help
//! suggests the right key.

use super::super::Document;
use super::{BARS, resolved_as};
use crate::tree::{Node, Table, Value};

/// The byte spans of all keys, with their names.
fn keys(table: &Table, found: &mut Vec<(std::ops::Range<usize>, String)>) {
    for entry in &table.0 {
        found.push((entry.origin.span.clone(), entry.key.clone()));
        // The keys of [exact] are names of columns.
        if entry.key != "exact" {
            values(&entry.node, found);
        }
    }
}

fn values(node: &Node, found: &mut Vec<(std::ops::Range<usize>, String)>) {
    match &node.value {
        Value::Table(table) => keys(table, found),
        Value::List(list) => list.iter().for_each(|node| values(node, found)),
        _ => {}
    }
}

/// Every case of a directory and its subdirectories, without studies.
fn shipped(directory: &std::path::Path) -> Vec<(String, String)> {
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

#[test]
fn every_misspelt_key_is_recognised() {
    let mut checked = 0;
    let shipped = shipped(std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases")));
    assert!(shipped.len() >= 2);
    let bars = ("bars.toml".to_owned(), BARS.to_owned());
    for (name, text) in shipped.iter().chain([&bars]) {
        let document = Document::parse(name, text, &[]).unwrap();
        let mut found = Vec::new();
        keys(document.root(), &mut found);
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
    }
    assert!(checked > 400, "{checked}");
}
