//! The program carries the shipped cases: those of the repository, or in a package of the registry
//! the copy beside this file. It is rebuilt when they change.

use std::path::Path;

fn main() -> std::io::Result<()> {
    use std::io::Write as _;
    let package = std::env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    let places = ["../../cases", "cases"].map(|place| Path::new(&package).join(place));
    let cases = places.iter().find(|place| place.is_dir()).unwrap_or(&places[0]);
    let mut out = std::io::stdout();
    writeln!(out, "cargo::rerun-if-changed={}", cases.display())?;
    writeln!(out, "cargo::rustc-env=CAROM_CASES={}", cases.display())
}
