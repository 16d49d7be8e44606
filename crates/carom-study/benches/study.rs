//! A complete study, from its files to its tables: four schemes for a bar of 100 cells that strikes
//! a wall, with 400 steps each, one after the other.
//!
//!     cargo bench -p carom-study

use std::path::Path;
use std::sync::atomic::AtomicBool;

use carom_study::{Plan, start};
use divan::Bencher;

const STUDY: &str = r#"
case = "bar.toml"
[grid]
"time.scheme" = [
    { kind = "chung-hulbert", rho_inf = 0.5 },
    { kind = "hht", alpha = 0.2 },
    { kind = "moreau-jean", theta = 1.0 },
    { kind = "central-difference" },
]
"#;

fn main() {
    divan::main();
}

/// A folder with the case, 400 of its 4 000 steps, and the study.
fn write(folder: &Path) -> Plan {
    let case = include_str!("../../../cases/perf/bar.toml");
    let (case, _) = case.split_once("[[expect]]").expect("the case expects something");
    let changes = [
        ("end = 2.0", "end = 0.2"),
        ("min = 5.0, max = 15.0", "min = 1.0, max = 11.0"),
        ("element = \"L2\"", "element = \"L2\"\nmass = \"lumped\""),
    ];
    let case = changes.iter().fold(case.to_owned(), |case, (old, new)| {
        assert!(case.contains(old), "{old}");
        case.replace(old, new)
    });
    std::fs::write(folder.join("bar.toml"), case).expect("a place to write");
    std::fs::write(folder.join("study.toml"), STUDY).expect("a place to write");
    Plan::read(&folder.join("study.toml")).expect("valid")
}

#[divan::bench(sample_count = 10, sample_size = 1)]
fn four_arms(bencher: Bencher) {
    let folder = tempfile::tempdir().expect("a place to write");
    let plan = write(folder.path());
    let mut count = 0;
    bencher.bench_local(|| {
        count += 1;
        let out = folder.path().join(format!("study-{count}"));
        let done = start(&plan, &out, 1, &mut |_| (), &AtomicBool::new(false)).expect("it runs");
        assert!(!done.interrupted);
    });
}
