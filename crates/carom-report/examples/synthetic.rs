//! Writes the tests' made-up run and its report, to look at: `cargo run -p carom-report --example synthetic -- DIR`.

#[path = "../tests/common/mod.rs"]
mod common;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let directory = std::env::args().nth(1).ok_or("give a directory that does not exist")?;
    let directory = std::path::Path::new(&directory);
    common::write(directory, "Cylinder falling on a prism, half model", None);
    carom_report::report(directory)?;
    Ok(())
}
