//! Mistakes in case files with the messages that they give, in files of `tests/corpus`: every
//! mistake of `keys.txt` is one that `make.py` derives from the schema, those of `checks.txt` are
//! written by hand. `CAROM_CORPUS=write` writes the messages as they are now, so that a change of
//! messages is a difference of these files.

use std::path::{Path, PathBuf};

use crate::resolved_as;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus")
}

/// The text of a case with the changes of a line `CASE: OLD -> NEW && OLD -> NEW`.
fn changed(line: &str) -> (PathBuf, String) {
    let (case, changes) = line.split_once(": ").unwrap();
    let path = folder().join(format!("{case}.toml"));
    let mut text = std::fs::read_to_string(&path).unwrap();
    for change in changes.split(" && ") {
        let (old, new) = change.split_once(" -> ").unwrap();
        let [old, new] = [old, new].map(|part| part.replace("\\n", "\n"));
        assert!(text.contains(&old), "{line}: {old:?} is not in {case}.toml");
        text = text.replacen(&old, &new, 1);
    }
    (path, text)
}

/// Every message: where and what, why, and what to try, each on a line.
fn messages(line: &str) -> Vec<String> {
    let (path, text) = changed(line);
    let Err(found) = resolved_as(&path.to_string_lossy(), &text, &[]) else {
        return vec!["  accepted".to_owned()];
    };
    let of = |problem: &carom_case::Diagnostic| {
        let place = format!("{}:{}+{}", problem.line, problem.column, problem.length);
        [
            format!("  {place} {}", problem.what),
            format!("  why: {}", problem.why),
            format!("  try: {}", problem.help),
        ]
    };
    let here = folder().to_string_lossy().into_owned();
    found.iter().flat_map(of).map(|text| text.replace(&here, "FOLDER").trim_end().to_owned()).collect()
}

/// The number of mistakes in a file, whose messages must be those of today.
fn compare(name: &str) -> usize {
    let text = std::fs::read_to_string(folder().join(name)).unwrap_or_default();
    let mistakes: Vec<&str> = text.lines().filter(|line| !line.starts_with("  ")).collect();
    let mut now = String::new();
    for line in &mistakes {
        now += line;
        now += "\n";
        for message in messages(line) {
            now += &message;
            now += "\n";
        }
    }
    check(name, &now);
    mistakes.len()
}

/// Compares a text with a file of the corpus, or writes it.
fn check(name: &str, now: &str) {
    let path = folder().join(name);
    let text = std::fs::read_to_string(&path).unwrap_or_default();
    if std::env::var("CAROM_CORPUS").is_ok_and(|what| what == "write") {
        std::fs::write(&path, now).unwrap();
    } else if let Some((k, (is, was))) = now.lines().zip(text.lines()).enumerate().find(|(_, (a, b))| a != b)
    {
        panic!("{name}:{}: this is now\n{is}\nand was\n{was}", k + 1);
    } else {
        assert_eq!(now.lines().count(), text.lines().count());
    }
}

#[test]
fn mistakes_give_the_messages_of_the_corpus() {
    let count = compare("keys.txt") + compare("checks.txt");
    assert!(count >= 500, "{count} mistakes");
}

/// Every case of the repository is stored in a manifest as it is in `stored.txt`, which has a hash
/// of it.
#[test]
fn cases_are_stored_as_before() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap();
    let mut files = Vec::new();
    let mut folders =
        vec![root.join("cases"), root.join("docs/book/examples"), root.join("crates/carom/templates")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|end| end == "toml") {
                files.push(path);
            }
        }
    }
    files.sort();
    let mut now = String::new();
    for file in files {
        let Ok(case) = carom_case::Case::from_file(&file, &[]) else { continue };
        let here = root.to_string_lossy();
        let stored = case.to_json().unwrap().to_string().replace(&*here, "ROOT");
        let name = file.strip_prefix(&root).unwrap().to_string_lossy().into_owned();
        now += &[&name, " ", blake3::hash(stored.as_bytes()).to_hex().as_str(), "\n"].concat();
    }
    assert!(now.lines().count() > 50);
    check("stored.txt", &now);
}
