//! The examples of the book run as the book says, and give what they expect.

#![allow(clippy::unwrap_used)]

mod common;

use common::{Place, text};

/// A path in the folder of the book's examples.
fn example(name: &str) -> String {
    concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/book/examples/").to_owned() + name
}

/// A block is pressed, and another run begins where that one ended: there the block stays in equilibrium until a disc strikes it.
#[test]
fn a_run_that_starts_from_another() {
    let place = Place::new("book");
    let run = |name: &str, more: &[&str]| {
        let case = example(name);
        let out = place.carom(&[&["run", &case, "--no-report"], more].concat());
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
        let said = text(&out.stdout);
        assert!(said.contains("as expected") && !said.contains("NOT as expected"), "{said}");
    };
    run("preload.toml", &["--out", "runs/preload"]);
    let from = format!("initial.from={:?}", place.0.join("runs/preload"));
    run("struck.toml", &["--out", "runs/struck", "--set", &from]);

    let missing = place.carom(&["run", &example("struck.toml"), "--set", "initial.from=\"runs/none\""]);
    assert_eq!(missing.status.code(), Some(2));
    let said = text(&missing.stderr);
    assert!(said.contains("cannot be started from") && said.contains("--set:1:"), "{said}");
}
