//! Every misspelling of a key in the cases and studies of the repository is an error that names it.
//! `scripts/check_schema.py` checks the same for the schema.

use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use carom::case::{Document, read};
use carom_study::Plan;
use serde_json::Value;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// Every file in cases/ and in the templates, with its text.
fn shipped() -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    let mut folders = vec![Path::new(ROOT).join("cases"), Path::new(ROOT).join("crates/carom/templates")];
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

/// Every variant of a document with one misspelt key, and the path of the key; of the tables of a
/// list with a common key, only the first has it misspelt.
fn misspelt(document: &Value) -> Vec<(String, Value)> {
    let mut found = Vec::new();
    match document {
        Value::Object(map) => {
            for (key, value) in map {
                let wrong = format!("{key}{}", &key[key.len() - 1..]);
                let renamed =
                    |(k, v): (&String, &Value)| (if k == key { &wrong } else { k }.clone(), v.clone());
                found.push((wrong.clone(), Value::Object(map.iter().map(renamed).collect())));
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
                for (wrong, inner) in
                    misspelt(value).into_iter().filter(|(wrong, _)| seen.insert(wrong.clone()))
                {
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

/// Checks that the misspelt variants of a file are errors that name the key, but for those to skip;
/// returns their number. That the file itself is valid is checked by `carom verify`.
fn misspellings(
    path: &Path,
    text: &str,
    reads: &dyn Fn(&str) -> Result<(), String>,
    skips: &dyn Fn(&str) -> bool,
) -> usize {
    let name = path.display();
    let document: Value = toml_edit::de::from_str(text).unwrap();
    let mut wrong = misspelt(&document);
    wrong.retain(|(key, _)| !skips(key));
    for (key, document) in &wrong {
        let text = toml_edit::ser::to_string(document).unwrap();
        let error = reads(&text).expect_err(&format!("{name}: the reader accepts `{key}`"));
        let named = key.rsplit('.').next().unwrap_or(key);
        assert!(error.contains(named), "{name}, `{key}`: {error}");
    }
    wrong.len()
}

/// Misspells the keys of all cases except those to skip; returns the number of misspellings.
fn refused_in_cases(skips: &dyn Fn(&str) -> bool) -> usize {
    let shipped = shipped();
    let cases: Vec<_> = shipped.iter().filter(|(_, text)| !is_study(text)).collect();
    assert!(cases.len() >= 8);
    let refused = |(path, text): &&(PathBuf, String)| {
        let reads = |text: &str| {
            let document =
                Document::parse(path.to_str().unwrap(), text, &[]).map_err(|e| format!("{e:?}"))?;
            read(&document).map(|_| ()).map_err(|problems| format!("{problems:#?}"))
        };
        misspellings(path, text, &reads, skips)
    };
    cases.iter().map(refused).sum()
}

#[test]
fn no_misspelt_key_of_a_case_passes() {
    // A key may be read in the first case only because of another key of its table.
    let met = Mutex::new(HashMap::<String, usize>::new());
    let skips = |key: &str| {
        let mut met = met.lock().unwrap();
        let count = met.entry(key.to_owned()).or_default();
        *count += 1;
        *count > 3
    };
    assert!(refused_in_cases(&skips) > 300);
}

#[test]
#[ignore = "every key of every case: .ci/nightly"]
fn no_misspelt_key_of_any_case_passes() {
    assert!(refused_in_cases(&|_| false) > 3000);
}

/// Copies the folders of a folder, with the files in them.
fn copy_folders(from: &Path, to: &Path) {
    for folder in std::fs::read_dir(from).unwrap().map(|f| f.unwrap().path()).filter(|path| path.is_dir()) {
        let copy = to.join(folder.file_name().unwrap());
        std::fs::create_dir(&copy).unwrap();
        for beside in std::fs::read_dir(&folder).unwrap().map(|f| f.unwrap().path()) {
            std::fs::copy(&beside, copy.join(beside.file_name().unwrap())).unwrap();
        }
    }
}

/// A changed study is read in a copy of all folders of cases, which it may use.
fn reads_study(scratch: &Path, path: &Path, text: &str, skips: &dyn Fn(&str) -> bool) -> usize {
    let folder = path.parent().unwrap();
    let reads = |text: &str| {
        let changed = scratch.join(folder.file_name().unwrap()).join("changed.toml");
        std::fs::write(&changed, text).unwrap();
        Plan::read(&changed).map(|_| ()).map_err(|e| format!("{e:?}"))
    };
    misspellings(path, text, &reads, skips)
}

#[test]
fn no_misspelt_key_of_a_study_passes() {
    let studies: Vec<_> = shipped().into_iter().filter(|(_, text)| is_study(text)).collect();
    let (next, checked) = (AtomicUsize::new(0), AtomicUsize::new(0));
    // All arms are resolved before a key is rejected: each key is misspelt in one study only.
    let seen = Mutex::new(BTreeSet::new());
    let skips = |key: &str| !seen.lock().unwrap().insert(key.to_owned());
    let work = || {
        let scratch = tempfile::tempdir().unwrap();
        copy_folders(&Path::new(ROOT).join("cases"), scratch.path());
        while let Some((path, text)) = studies.get(next.fetch_add(1, Ordering::Relaxed)) {
            checked.fetch_add(reads_study(scratch.path(), path, text, &skips), Ordering::Relaxed);
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        work();
    });
    assert!(studies.len() >= 2 && checked.into_inner() > 60);
}
