//! Writes the page of run directories again, and says which records cannot be read.

fn main() {
    for directory in std::env::args().skip(1) {
        if let Err(error) = carom_report::report(std::path::Path::new(&directory)) {
            eprintln!("{error}");
        }
    }
}
