//! Comparison of a record with expected values.

use carom_record::{Bound, Column, Deviation, Expect, History, Norm};

fn history(columns: &[(&str, Vec<f64>)]) -> History {
    let column = |name: &str| Column {
        name: name.into(),
        unit: String::new(),
        description: String::new(),
        integer: false,
    };
    let (names, values) = columns.iter().map(|(name, values)| (column(name), values.clone())).unzip();
    History::new(names, values)
}

fn expect(what: &str, bound: Bound) -> Expect {
    Expect {
        what: what.into(),
        bound,
        source: None,
        deviation: None,
        after: None,
        before: None,
        order: None,
        norm: None,
        slow: false,
    }
}

fn record() -> History {
    history(&[
        ("time", vec![0.0, 1.0, 2.0, 3.0, 4.0]),
        ("a", vec![1.0, 3.0, -2.0, 2.0, 0.0]),
        ("b", vec![1.0, 1.0, 1.0, 1.0, 5.0]),
    ])
}

/// Values calculated by hand.
#[test]
fn forms_and_arithmetic() {
    let record = record();
    let get = |what: &str| expect(what, Bound::AtMost(0.0)).got(&record);
    for (what, value) in [
        ("range a", 5.0),
        ("drift a", 3.0),
        ("peak a", 3.0),
        ("rms a", (18.0_f64 / 5.0).sqrt()),
        ("last b / first b", 5.0),
        ("( max a - min a ) / 2 + 1", 3.5),
        ("rms [ a - b ]", ((0.0 + 4.0 + 9.0 + 1.0 + 25.0) / 5.0_f64).sqrt()),
        ("time of max [ a * b ]", 1.0),
        ("a:min", -2.0),
    ] {
        assert_eq!(get(what), Ok(value), "{what}");
    }
    for (what, part) in [
        ("rms c", "no column `c`"),
        ("max a / 0", "inf"),
        ("last a of \"x\"", "no arm \"x\""),
        ("difference a of 'x' with 'y'", "COLUMN of"),
        ("a:median", "min, max, roughness"),
        ("rms [ a", "rms [ a"),
        ("min", "missing"),
    ] {
        assert!(get(what).unwrap_err().contains(part), "{what}: {}", get(what).unwrap_err());
    }
}

#[test]
fn windows_are_strict() {
    let record = record();
    let windowed = |what: &str, after, before| Expect { after, before, ..expect(what, Bound::AtMost(0.0)) };
    assert_eq!(windowed("max a", Some(1.0), None).got(&record), Ok(2.0));
    assert_eq!(windowed("drift b", None, Some(4.0)).got(&record), Ok(0.0));
    assert!(windowed("max a", Some(1.0), Some(2.0)).got(&record).unwrap_err().contains("no rows between"));
}

/// a − (1 + t) by hand: 0, 1, −5, −2, −5.
#[test]
fn deviations_from_a_formula() {
    let record = record();
    let with = |norm, scale, bound| {
        let deviation = Some(Deviation { formula: "1 + t".into(), exact: None, norm, scale });
        Expect { deviation, ..expect("a", bound) }
    };
    assert_eq!(with(Norm::Max, 1.0, Bound::AtMost(5.0)).got(&record), Ok(5.0));
    assert_eq!(with(Norm::Max, 2.0, Bound::AtMost(5.0)).got(&record), Ok(2.5));
    let rms = with(Norm::Rms, 1.0, Bound::Near { value: 3.3, tolerance: 0.02 });
    assert_eq!(rms.got(&record), Ok(11.0_f64.sqrt()));
    let verdict = rms.verdict(rms.got(&record));
    assert!(verdict.pass);
    assert_eq!(
        (verdict.what.as_str(), verdict.value, verdict.tolerance),
        ("rms |a − (1 + t)|", Some(3.3), Some(0.02))
    );
    let early = Expect { before: Some(1.5), ..with(Norm::Max, 1.0, Bound::AtMost(1.0)) };
    assert_eq!(early.got(&record), Ok(1.0));
    let nowhere = Expect {
        deviation: Some(Deviation { formula: "1/t".into(), exact: None, norm: Norm::Max, scale: 1.0 }),
        ..expect("a", Bound::AtMost(1.0))
    };
    assert!(nowhere.got(&record).unwrap_err().contains("inf at t = 0"));
}
