//! Messages about texts and files that are not cases, and about tables of loads.

use super::IMPACT;
use super::messages::shown;
use carom_case::{CaseError, Document, read};

#[test]
fn texts_that_are_not_cases() {
    let message = |text: &str| shown(text, &[]);
    assert_eq!(
        message(
            "title = \"a
"
        )
        .lines()
        .next(),
        Some("a/case.toml:1:11: this is not TOML")
    );
    let open = message(&IMPACT.replace("half model\"", "half model"));
    assert!(open.starts_with("a/case.toml:4:49: this is not TOML\n  title = \"Cylinder"), "{open}");
    assert!(message("").contains("the case is empty"));
    assert!(message("# nothing\n").contains("the case is empty"));
    assert!(message("title = 1\ntitle = 2\n").contains("duplicate key"));
    assert!(message(&format!("a = {}", "[".repeat(100_000))).contains("this is not TOML"));
    let study = message("case = \"impact.toml\"\n[[arm]]\nname = \"a\"\n");
    assert!(study.starts_with("a/case.toml:1:1: this is a study, not a case"), "{study}");
    assert!(message("a = 1\n\u{0}").contains("this is not TOML"));
}

#[test]
fn names_of_measured_data_are_unique() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    std::fs::write(folder.path().join("m.csv"), "t,value\n0,0\n0.5,1\n").unwrap();
    let overlay = "\n[[overlay]]\nname = \"camera\"\nfile = \"m.csv\"\ncolumn = \"A.uy\"\n";
    std::fs::write(&path, format!("{IMPACT}{overlay}{overlay}")).unwrap();
    let document = Document::open(&path, &[]).unwrap();
    let message = document.diagnose_all(&read(&document).unwrap_err()).to_string();
    assert!(message.contains("two tables [[overlay]] are named `camera`"), "{message}");
}

/// Errors in tables of loads are reported at the key that names the table, with file and line.
#[test]
fn tables_of_loads() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    let load = "\n[[load]]\non = [\"prism.top\"]\npressure = 1\ntable = \"a.csv\"\n";
    std::fs::write(&path, format!("{IMPACT}{load}")).unwrap();
    let line = IMPACT.lines().count() + 5;
    let message = |table: &str| {
        std::fs::write(folder.path().join("a.csv"), table).unwrap();
        let document = Document::open(&path, &[]).unwrap();
        document.diagnose_all(&read(&document).unwrap_err()).to_string()
    };
    for (table, messages) in [
        (
            "t,force\n0,1\n9,1\n",
            ["the table \"a.csv\" cannot be used", "a.csv:1: there is no column `value`"],
        ),
        ("t,value\n0,1\n0.5,1\n", ["the table \"a.csv\" does not cover the run", "its last t = 0.5"]),
        (
            "t,value\n0.1,1\n9,1\n",
            ["the table \"a.csv\" does not cover the run", "its first line is t = 0.1"],
        ),
    ] {
        let message = message(table);
        assert!(message.contains(&format!("case.toml:{line}:9: ")), "{message}");
        assert!(messages.iter().all(|m| message.contains(m)), "{message}");
    }
}

#[test]
fn files_that_are_not_cases() {
    let place = std::env::temp_dir().join(format!("carom-case-{}", std::process::id()));
    std::fs::create_dir_all(&place).unwrap();
    let message = |name: &str, bytes: Option<&[u8]>| {
        let path = place.join(name);
        if let Some(bytes) = bytes {
            std::fs::write(&path, bytes).unwrap();
        }
        match Document::open(&path, &[]) {
            Err(CaseError::Wrong(found)) => found[0].to_string(),
            other => panic!("{other:?}"),
        }
    };
    let none = message("none.toml", None);
    assert!(none.contains("there is no such file") && none.ends_with("try: check the path"), "{none}");
    assert!(message("", None).contains("this is a directory"));
    assert!(message("empty.toml", Some(b"")).contains("the case is empty"));
    assert!(message("binary.toml", Some(b"\x7fELF\xff\x00")).contains("byte 5 is not valid UTF-8"));
    assert!(message("huge.toml", Some(&vec![b'#'; 10_000_001])).contains("too large to be a case"));
    std::fs::remove_dir_all(&place).unwrap();
}
