//! What the tests of studies share: a folder with case files and a study of them.

use std::fs;
use std::path::PathBuf;

use carom_run::case::{CaseError, Diagnostic};
use carom_study::Plan;

/// Density 1, wave speed 10.
pub(crate) const STEEL: &str = r#"
dimension = 1
[[material]]
name = "steel"
law = "linear-elastic"
density = 1.0
young = 100.0
poisson = 0.0
"#;

/// A folder with cases, each with [`STEEL`], and a study.
pub(crate) fn folder(cases: &[(&str, &str)], study: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    for (name, case) in cases {
        fs::write(folder.path().join(name), format!("{STEEL}{case}")).unwrap();
    }
    let path = folder.path().join("study.toml");
    fs::write(&path, study).unwrap();
    (folder, path)
}

/// A folder with these cases as they stand, and a study.
pub(crate) fn raw_folder(cases: &[(&str, &str)], study: &str) -> (tempfile::TempDir, PathBuf) {
    let (folder, path) = folder(&[], study);
    for (name, case) in cases {
        fs::write(folder.path().join(name), case).unwrap();
    }
    (folder, path)
}

/// What is wrong with the study in a folder.
pub(crate) fn wrong((_folder, path): (tempfile::TempDir, PathBuf)) -> Vec<Diagnostic> {
    match Plan::read(&path) {
        Err(CaseError::Wrong(found)) => found,
        other => panic!("{other:?}"),
    }
}
