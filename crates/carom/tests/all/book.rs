//! The examples of the book run as described there and meet their expectations; every kind of
//! scheme has its page in the book and its rows in the verification.

use crate::common::{Place, text};

/// A path in the folder of the book's examples.
fn example(name: &str) -> String {
    concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/book/examples/").to_owned() + name
}

/// A block is preloaded in one run, and another run starts from its final state: the block stays in
/// equilibrium until a disc strikes it.
#[test]
fn a_run_that_starts_from_another() {
    let place = Place::new("book");
    let run = |name: &str, more: &[&str]| {
        let case = example(name);
        let out = place.carom(&[&["run", &case, "--no-report"], more].concat());
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
        let output = text(&out.stdout);
        assert!(output.contains("as expected") && !output.contains("MISSED"), "{output}");
    };
    run("preload.toml", &["--out", "runs/preload"]);
    let from = format!("initial.from={:?}", place.0.join("runs/preload"));
    run("struck.toml", &["--out", "runs/struck", "--set", &from]);

    let missing = place.carom(&["run", &example("struck.toml"), "--set", "initial.from=\"runs/none\""]);
    assert_eq!(missing.status.code(), Some(2));
    let output = text(&missing.stderr);
    assert!(output.contains("cannot be used") && output.contains("--set:1:"), "{output}");
}

/// Every kind of scheme must be documented and verified.
#[test]
fn every_scheme_has_a_page_and_rows_in_the_suite() {
    let read = |path: &str| {
        let path = format!("{}/../../{path}", env!("CARGO_MANIFEST_DIR"));
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
    };
    let contents = read("docs/book/src/SUMMARY.md");
    let orders = read("cases/order/orders.toml") + &read("cases/order/nonsmooth.toml");
    let damping = read("cases/order/damping.toml");
    for kind in carom_time::KINDS {
        let (name, row) = (kind.name, format!("kind = \"{}\"", kind.name));
        assert!(
            contents.contains(&format!("(integrators/{name}.md)")),
            "SUMMARY.md has no integrators/{name}.md"
        );
        assert!(
            read(&format!("docs/book/src/integrators/{name}.md")).contains(&row),
            "{name}.md shows no {row}"
        );
        if name != carom_time::STATIC {
            assert!(orders.contains(&row), "neither cases/order/orders.toml nor nonsmooth.toml has {row}");
            assert!(damping.contains(&row), "cases/order/damping.toml has no {row}");
        }
    }
}
