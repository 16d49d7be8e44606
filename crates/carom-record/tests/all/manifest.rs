//! `manifest.json`: what was run, on which machine, and how it ended.

use carom_record::Source;
use carom_record::manifest::timestamp;

/// Against `date -u -d @N`.
#[test]
fn timestamps() {
    assert_eq!(timestamp(0), "1970-01-01T00:00:00Z");
    assert_eq!(timestamp(951_782_400), "2000-02-29T00:00:00Z");
    assert_eq!(timestamp(1_772_366_399), "2026-03-01T11:59:59Z");
}

#[test]
fn hash_depends_on_where_parts_end() {
    let source = |text: &str, sets: &[&str]| Source {
        text: text.into(),
        sets: sets.iter().map(ToString::to_string).collect(),
        ..Source::default()
    };
    assert_ne!(source("a", &["bc"]).hash(), source("ab", &["c"]).hash());
    assert_ne!(source("a", &[]).hash(), source("a", &[""]).hash());
    assert_eq!(source("a", &["b"]).hash(), source("a", &["b"]).hash());
}
