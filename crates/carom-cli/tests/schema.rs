//! `carom schema` held against the reader by a validator of JSON Schema: both accept every case and study of the repository, and both
//! refuse every misspelling of every key in them.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use carom::case::{Document, read};
use carom_study::Plan;
use jsonschema::Validator;
use serde_json::Value;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// Every file of cases/ and of the templates, with its text.
fn shipped() -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    let mut folders = vec![Path::new(ROOT).join("cases"), Path::new(ROOT).join("crates/carom-cli/templates")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "toml") {
                let text = std::fs::read_to_string(&path).unwrap();
                found.push((path, text));
            }
        }
    }
    found
}

fn is_study(text: &str) -> bool {
    text.lines().any(|line| line.starts_with("case ") || line.starts_with("case="))
}

fn validator(option: &[&str]) -> Validator {
    let program = env!("CARGO_BIN_EXE_carom");
    let printed = std::process::Command::new(program).arg("schema").args(option).output().unwrap().stdout;
    let schema: Value = serde_json::from_slice(&printed).unwrap();
    jsonschema::draft202012::meta::validate(&schema).unwrap();
    jsonschema::draft202012::new(&schema).unwrap()
}

/// Every variant of a document with one key misspelt, and where; of a list's tables that have a key in common, the first has it misspelt.
fn misspelt(document: &Value) -> Vec<(String, Value)> {
    let mut found = Vec::new();
    match document {
        Value::Object(map) => {
            for (key, value) in map {
                let doubled = format!("{key}{}", &key[key.len() - 1..]);
                let swapped = key
                    .get(1..2)
                    .map_or_else(|| doubled.clone(), |second| format!("{second}{}{}", &key[..1], &key[2..]));
                let capital = format!("{}{}", key[..1].to_uppercase(), &key[1..]);
                for wrong in [doubled, swapped, capital].into_iter().filter(|wrong| wrong != key) {
                    let renamed = |(k, v): (&String, &Value)| (if k == key { &wrong } else { k }.clone(), v.clone());
                    found.push((wrong.clone(), Value::Object(map.iter().map(renamed).collect())));
                }
                // The keys of this table are columns, which only the reader knows.
                let inner = if key == "exact" { Vec::new() } else { misspelt(value) };
                for (wrong, inner) in inner {
                    let mut map = map.clone();
                    map[key] = inner;
                    found.push((format!("{key}.{wrong}"), Value::Object(map)));
                }
            }
        }
        Value::Array(list) => {
            let mut seen = BTreeSet::new();
            for (i, value) in list.iter().enumerate() {
                for (wrong, inner) in misspelt(value).into_iter().filter(|(wrong, _)| seen.insert(wrong.clone())) {
                    let mut list = list.clone();
                    list[i] = inner;
                    found.push((wrong, Value::Array(list)));
                }
            }
        }
        _ => {}
    }
    found
}

/// Holds schema and reader against each other on one file; how many misspellings both refused.
fn agree(path: &Path, text: &str, validator: &Validator, reads: &dyn Fn(&str) -> Result<(), String>) -> usize {
    let name = path.display();
    let document: Value = toml_edit::de::from_str(text).unwrap();
    let told: Vec<_> = validator.iter_errors(&document).map(|e| format!("{e} at {}", e.instance_path())).collect();
    assert!(told.is_empty(), "{name}: {told:#?}");
    reads(&toml_edit::ser::to_string(&document).unwrap()).unwrap_or_else(|e| panic!("{name}: {e}"));
    let wrong = misspelt(&document);
    for (key, document) in &wrong {
        assert!(!validator.is_valid(document), "{name}: the schema lets `{key}` pass");
        let text = toml_edit::ser::to_string(document).unwrap();
        assert!(reads(&text).is_err(), "{name}: the reader lets `{key}` pass");
    }
    wrong.len()
}

#[test]
fn schema_and_reader_agree_on_every_case() {
    let validator = validator(&[]);
    let mut checked = (0, 0);
    for (path, text) in shipped().iter().filter(|(_, text)| !is_study(text)) {
        let reads = |text: &str| {
            let document = Document::parse(path.to_str().unwrap(), text, &[]).map_err(|e| format!("{e:?}"))?;
            read(&document).map(|_| ()).map_err(|problems| format!("{problems:#?}"))
        };
        checked = (checked.0 + 1, checked.1 + agree(path, text, &validator, &reads));
    }
    assert!(checked.0 >= 8 && checked.1 > 1000, "{checked:?}");
}

#[test]
fn schema_and_reader_agree_on_every_study() {
    let validator = validator(&["--study"]);
    let mut checked = (0, 0);
    let scratch = tempfile::tempdir().unwrap();
    for (path, text) in shipped().iter().filter(|(_, text)| is_study(text)) {
        // Studies name cases of their own folder and of those beside it.
        let folder = path.parent().unwrap();
        for folder in std::fs::read_dir(folder.parent().unwrap()).unwrap().map(|f| f.unwrap().path()) {
            let copy = scratch.path().join(folder.file_name().unwrap());
            std::fs::create_dir_all(&copy).unwrap();
            for beside in std::fs::read_dir(&folder).unwrap().map(|f| f.unwrap().path()) {
                std::fs::copy(&beside, copy.join(beside.file_name().unwrap())).unwrap();
            }
        }
        let reads = |text: &str| {
            let changed = scratch.path().join(folder.file_name().unwrap()).join("changed.toml");
            std::fs::write(&changed, text).unwrap();
            Plan::read(&changed).map(|_| ()).map_err(|e| format!("{e:?}"))
        };
        checked = (checked.0 + 1, checked.1 + agree(path, text, &validator, &reads));
    }
    assert!(checked.0 >= 2 && checked.1 > 60, "{checked:?}");
}
