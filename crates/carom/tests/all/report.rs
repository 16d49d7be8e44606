//! `carom report --format`: figures for print, and measured data on the page of a study.

use std::fs;

use super::common::{COARSE, IMPACT, Place, text};

/// The first steps of the impact, in `run`.
fn run(name: &str) -> Place {
    let place = Place::new(name);
    place.file("case.toml", IMPACT);
    let short = [&["run", "case.toml", "--out", "run", "--set", "time.end=0.01875"], &COARSE[..]].concat();
    assert!(place.carom(&short).status.success());
    place
}

#[test]
fn svg_files_are_named() {
    let place = run("report-svg");
    let named = place.carom(&["report", "run", "--format", "svg"]);
    assert_eq!(named.status.code(), Some(0));
    let named = text(&named.stdout);
    let mut lines = named.lines();
    assert_eq!(lines.next(), Some("run/report.html"));
    assert!(lines.clone().any(|line| line == "run/figures/energy.svg"), "{named}");
    assert!(lines.all(|line| place.0.join(line).is_file()));
    let wrong = place.carom(&["report", "run", "--format", "svg", "--scale", "0"]);
    assert!(wrong.status.code() == Some(2) && text(&wrong.stderr).contains("from 0.1 to 10"));
}

/// Without the libraries nothing is written, and the message says how to get the files.
#[cfg(not(feature = "figures"))]
#[test]
fn other_formats_name_the_cure() {
    let place = run("report-png");
    fs::remove_file(place.0.join("run/report.html")).unwrap();
    let refused = place.carom(&["report", "run", "--format", "png,pdf"]);
    let told = text(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2));
    assert!(told.contains("--features figures") && told.contains("matplotlib"), "{told}");
    assert!(!place.0.join("run/report.html").exists());
}

/// A PNG has the size of its figure times the scale; a PDF has one page of this size.
#[cfg(feature = "figures")]
#[test]
fn png_and_pdf_have_the_size_of_the_figure() {
    let place = run("report-png");
    let done = place.carom(&["report", "run", "--format", "png,pdf", "--scale", "2"]);
    assert!(done.status.success(), "{}", text(&done.stderr));
    let read = |ending: &str| fs::read(place.0.join("run/figures/energy").with_extension(ending)).unwrap();
    let svg = text(&read("svg"));
    let length =
        |key: &str| svg.split_once(key).unwrap().1.split('"').next().unwrap().parse::<u32>().unwrap();
    let size = [length(" width=\""), length(" height=\"")];
    let png = read("png");
    assert_eq!(png[..8], *b"\x89PNG\r\n\x1a\n");
    let number = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
    assert_eq!([number(16), number(20)], size.map(|x| 2 * x));
    let pdf = read("pdf");
    let pdf = String::from_utf8_lossy(&pdf);
    // A pixel is 1/96 inch, 0.75 pt.
    let [width, height] = size.map(|x| 0.75 * f64::from(x));
    let page = pdf.split_once("/MediaBox [").unwrap().1.split_once(']').unwrap().0.to_owned();
    let found: Vec<f64> = page.split_whitespace().map(|x| x.parse().unwrap()).collect();
    assert!((found[2] - width).abs() + (found[3] - height).abs() < 0.02, "{page}");
    assert!(pdf.starts_with("%PDF-") && pdf.trim_end().ends_with("%%EOF"));
    let wrong = place.carom(&["report", "run", "--format", "png", "--font", "run/history.csv"]);
    assert_eq!(wrong.status.code(), Some(2));
}

/// Data of a study are drawn in its figure of their column, and named in the table of metrics.
#[test]
fn measured_data_of_a_study_are_on_its_page() {
    let place = Place::new("report-measured");
    for (name, bytes) in [
        ("fall.toml", include_str!("../../../../cases/free/fall.toml")),
        ("camera.toml", include_str!("../../../../cases/free/camera.toml")),
        ("measured.csv", include_str!("../../../../cases/free/measured.csv")),
    ] {
        place.file(name, bytes);
    }
    let done = place.carom(&["study", "camera.toml", "--out", "st"]);
    assert!(done.status.success(), "{}", text(&done.stderr));
    let read = |name: &str| fs::read_to_string(place.0.join("st").join(name)).unwrap();
    assert!(read("figures/A.uy.svg").contains("measured: camera"));
    assert_eq!(read("figures/A.uy.csv").matches("\"measured: camera\"").count(), 20);
    assert!(read("study.html").contains("<code>overlay_rms:camera</code>"));
    let table = read("study.csv");
    assert!(table.lines().next().unwrap().contains("overlay_shift:camera"), "{table}");
}
