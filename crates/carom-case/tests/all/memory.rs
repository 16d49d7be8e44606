//! The memory that a case needs, estimated before anything is allocated.

use carom_case::Case;

const MIB: f64 = 1024.0 * 1024.0;
const GIB: f64 = 1024.0 * MIB;

const SOLID: &str = include_str!("../../../../cases/perf/solid.toml");
const DISC: &str = include_str!("../../../../cases/perf/disc-19k.toml");

const EXPLICIT: [&str; 3] =
    ["time.scheme={ kind = \"central-difference\" }", "body.block.mass=lumped", "body.block.element=Tet4"];
const DIRECT: &str = "newton.linear=direct";
const ITERATIVE: &str = "newton.linear=iterative";

fn total(text: &str, sets: &[&str]) -> f64 {
    Case::from_text(text, sets).unwrap().memory().total()
}

/// Peaks of the resident size that `scripts/memory_table.py` has measured.
#[test]
fn estimates_are_within_a_factor_of_two_of_peaks() {
    let explicit = |cells| [&EXPLICIT[..], &[cells]].concat();
    let runs: &[(&str, Vec<&str>, f64)] = &[
        (SOLID, explicit("body.block.mesh.cells=[16, 16, 16]"), 38.0),
        (SOLID, explicit("body.block.mesh.cells=[40, 40, 40]"), 240.0),
        (SOLID, vec![ITERATIVE], 61.0),
        (SOLID, vec![DIRECT, "body.block.mesh.cells=[6, 6, 6]"], 108.0),
        (SOLID, vec![DIRECT, "body.block.mesh.cells=[8, 8, 8]"], 231.0),
        (DISC, vec![], 75.0),
    ];
    for (text, sets, peak) in runs {
        let ratio = total(text, sets) / (peak * MIB);
        assert!((0.5..=2.0).contains(&ratio), "{sets:?}: {ratio}");
    }
}

/// A million unknowns: an explicit run makes no factor, an iterative one no factor, and a factor of
/// a solid has thousands of entries in a row.
#[test]
fn a_factor_counts_where_it_is_made() {
    let cells = "body.block.mesh.cells=[68, 68, 68]";
    let explicit = total(SOLID, &[&EXPLICIT[..], &[cells]].concat());
    let iterative = total(SOLID, &["body.block.element=Tet4", cells, ITERATIVE]);
    assert!(explicit < iterative && iterative < 4.0 * GIB, "{explicit:e} {iterative:e}");
    // No test machine has the memory for a factor of this size: it is refused, or fits.
    let direct = Case::from_text(SOLID, &["body.block.element=Tet4", cells, DIRECT]);
    let need = direct.map_or_else(|error| error.to_string(), |case| format!("{}", case.memory().total()));
    let refused = need.contains("needs about") && need.contains("\"iterative\" needs about");
    assert!(refused || need.parse().is_ok_and(|need: f64| need > 20.0 * GIB), "{need}");
}

/// A bar with two cells across is factored without the fill of a square.
#[test]
fn a_slender_body_fills_little() {
    let cells = |cells: &str| {
        let sets = [DIRECT, &format!("body.block.mesh.cells={cells}")].map(str::to_owned);
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        Case::from_text(SOLID, &sets).unwrap().memory()
    };
    let slender = cells("[250, 2, 2]");
    let cube = cells("[10, 10, 10]");
    assert!(slender.factors < 0.3 * cube.factors, "{slender:?} {cube:?}");
}

/// A refusal names the key that makes the run large, the memory it needs, and what there is.
#[test]
fn what_is_too_large_is_refused_at_its_key() {
    let refused = |sets: &[&str]| Case::from_text(DISC, sets).unwrap_err().to_string();
    let mesh = refused(&["body.disc.mesh.size=1e-7"]);
    assert!(mesh.contains("the mesh of `disc` is too large for the memory"), "{mesh}");
    let refined = refused(&["body.disc.mesh.size=0.5", "refine=1e5"]);
    assert!(refined.contains("--set:1:8: the mesh of"), "{refined}");
    let polygon = "body.disc.mesh={ shape = \"polygon\", points = [[0, 0], [1, 0], [1, 1]], size = 1e-9 }";
    let polygon = refused(&[polygon, "contact.strike.secondary=disc.side1"]);
    assert!(polygon.contains("the mesh of `disc` is too large"), "{polygon}");
    let rows = refused(&["time.end=1.5e6"]);
    for part in ["the record is too large for the memory: 8.000e8 rows", "GiB", "output.history_every"] {
        assert!(rows.contains(part), "{rows}");
    }
}
