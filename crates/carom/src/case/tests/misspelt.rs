//! Every key of every shipped case, misspelt in three ways: one error, whose help names the key that was meant.

use super::super::Document;
use super::{BARS, IMPACT, REBOUND, resolved};
use crate::case::tree::{Node, Table, Value};

/// The byte spans of all keys, with their names.
fn keys(table: &Table, found: &mut Vec<(std::ops::Range<usize>, String)>) {
    for entry in &table.0 {
        found.push((entry.origin.span.clone(), entry.key.clone()));
        values(&entry.node, found);
    }
}

fn values(node: &Node, found: &mut Vec<(std::ops::Range<usize>, String)>) {
    match &node.value {
        Value::Table(table) => keys(table, found),
        Value::List(list) => list.iter().for_each(|node| values(node, found)),
        _ => {}
    }
}

#[test]
fn every_misspelt_key_is_recognised() {
    let mut checked = 0;
    for text in [IMPACT, REBOUND, BARS] {
        let document = Document::parse("case.toml", text, &[]).unwrap();
        let mut found = Vec::new();
        keys(document.root(), &mut found);
        assert!(found.len() > 40);
        for (span, key) in found {
            let doubled = format!("{key}{}", &key[key.len() - 1..]);
            let swapped = format!("{}{}{}", &key[1..2], &key[..1], &key[2..]);
            let capital = format!("{}{}", key[..1].to_uppercase(), &key[1..]);
            for wrong in [doubled, swapped, capital].into_iter().filter(|wrong| *wrong != key) {
                let text = format!("{}{wrong}{}", &text[..span.start], &text[span.end..]);
                let problems = resolved(&text, &[]).expect_err(&wrong);
                // A header of a list that is misspelt leaves the others of the list: one problem all the same.
                let told: Vec<_> = problems.iter().map(|p| format!("{} / {}", p.what, p.help)).collect();
                assert_eq!(problems.len(), 1, "{wrong} for {key}: {told:#?}");
                assert!(problems[0].what.starts_with(&format!("unknown key `{wrong}`")), "{told:?}");
                assert!(problems[0].help.contains(&format!("`{key}`")), "{told:?}");
                assert!(problems[0].quoted.contains(&wrong));
                checked += 1;
            }
        }
    }
    assert!(checked > 400, "{checked}");
}
