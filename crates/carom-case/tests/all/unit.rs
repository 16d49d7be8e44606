//! Advice where a number is written with its unit.

use carom_case::unit::{Labels, bare};

#[test]
fn numbers_are_converted_to_the_units_of_the_case() {
    let labels = Labels(["mm", "s", "t"].map(str::to_owned));
    for (text, number) in [
        ("100 ms", "0.1"),
        ("2e-4 s", "2e-4"),
        ("2e-4s", "2e-4"),
        ("3 us", "3e-6"),
        ("-0.7 m", "-700"),
        ("7 µm", "0.007"),
        ("1.5e3 cm", "15000"),
    ] {
        let advice = labels.advice("key", None, text).unwrap();
        assert!(advice.starts_with(&format!("write `key = {number}`: the number alone, in ")), "{advice}");
    }
    // Tonnes have no prefix that is known, and a pressure is made of several units.
    for text in ["2 kg", "1 MPa", "20 °", "3 m/s"] {
        let advice = labels.advice("key", None, text).unwrap();
        let words =
            "write the number alone, in the units of the case, whose length is in mm, time in s, mass in t";
        assert_eq!(advice, words);
    }
    let advice = |unit, text| labels.advice("key", Some(unit), text).unwrap();
    assert!(advice("time", "100 ms").starts_with("write `key = 0.1`: the number alone, in s"));
    assert!(
        advice("mass/length³", "2 mm").starts_with("write the number alone, in mass/length³ of the case")
    );
    assert_eq!(advice("", "0.3 m"), "write `key = 0.3`: the number alone, it has no unit");
    for text in ["heavy", "2", "2e-4", "", "s 3", "nan s"] {
        assert_eq!(labels.advice("key", None, text), None, "{text}");
    }
}

#[test]
fn values_without_quotes() {
    assert_eq!(bare("step = 2e-4 s   # short"), Some(("step", "2e-4 s")));
    for line in ["step = 2e-4", "title = two s", "# step", "at = [1 m, 2 m]", "on = 3.", "a = 1979-05-27"] {
        assert_eq!(bare(line), None, "{line}");
    }
}
