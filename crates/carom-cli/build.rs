//! The program includes the cases of the repository, so it is rebuilt when they change.

fn main() -> std::io::Result<()> {
    use std::io::Write as _;
    writeln!(std::io::stdout(), "cargo::rerun-if-changed=../../cases")
}
