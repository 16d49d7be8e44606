//! Makes the report of a run directory again: `cargo run -p carom-report --example again -- DIR`.

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let directory = std::env::args().nth(1).ok_or("give a run directory")?;
    carom_report::report(std::path::Path::new(&directory))?;
    Ok(())
}
