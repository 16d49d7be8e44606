//! The program carries the shipped cases: it is built anew when they change.

fn main() -> std::io::Result<()> {
    use std::io::Write as _;
    writeln!(std::io::stdout(), "cargo::rerun-if-changed=../../cases")
}
