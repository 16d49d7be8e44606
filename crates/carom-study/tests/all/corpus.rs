//! Mistakes in study files with the messages that they give, in `tests/corpus/mistakes.txt`.
//! `CAROM_CORPUS=write` writes the messages as they are now.

use std::path::{Path, PathBuf};

use carom_run::case::{CaseError, Document};
use carom_study::Plan;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus")
}

/// The messages of a study with a change `STUDY: OLD -> NEW`: where and what, why, what to try.
fn messages(line: &str) -> Vec<String> {
    let (study, change) = line.split_once(": ").unwrap();
    let (old, new) = change.split_once(" -> ").unwrap();
    let path = folder().join(format!("{study}.toml"));
    let [old, new] = [old, new].map(|part| part.replace("\\n", "\n"));
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains(&old), "{line}");
    let read = || {
        Plan::of(&Document::parse(&path.to_string_lossy(), &text.replacen(&old, &new, 1), &[])?, &folder())
    };
    let found = match read() {
        Ok(_) => return vec!["  accepted".to_owned()],
        Err(CaseError::Wrong(found)) => found,
        Err(error) => panic!("{error}"),
    };
    let here = folder().to_string_lossy().into_owned();
    let of = |problem: &carom_run::case::Diagnostic| {
        let place = format!("{}:{}+{}", problem.line, problem.column, problem.length);
        [
            format!("  {place} {}", problem.what),
            format!("  why: {}", problem.why),
            format!("  try: {}", problem.help),
        ]
    };
    found.iter().flat_map(of).map(|text| text.replace(&here, "FOLDER").trim_end().to_owned()).collect()
}

#[test]
fn mistakes_give_the_messages_of_the_corpus() {
    let path = folder().join("mistakes.txt");
    let text = std::fs::read_to_string(&path).unwrap();
    let with_messages = |line: &str| [vec![line.to_owned()], messages(line)].concat();
    let now: Vec<String> =
        text.lines().filter(|line| !line.starts_with("  ")).flat_map(with_messages).collect();
    if std::env::var("CAROM_CORPUS").is_ok_and(|what| what == "write") {
        std::fs::write(&path, now.join("\n") + "\n").unwrap();
        return;
    }
    for (k, (is, was)) in now.iter().zip(text.lines()).enumerate() {
        assert_eq!(is, was, "mistakes.txt:{}", k + 1);
    }
    assert_eq!(now.len(), text.lines().count());
}
