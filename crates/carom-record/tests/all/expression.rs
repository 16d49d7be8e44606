//! Arithmetic expressions in quantities.

use carom_record::Reason;
use carom_record::expression::{Token, parse, tokens};

/// The quantities are `x` = 2, and anything in brackets = 10.
fn value(text: &str) -> Result<f64, Reason> {
    let name = |words: &[Token]| Ok(words[0].word().unwrap_or_default().to_owned());
    let parsed = parse(&tokens(text)?, &name)?;
    parsed.value(&mut |q: &String| match q.as_str() {
        "x" => Ok(2.0),
        "[" => Ok(10.0),
        other => Err(format!("no {other}").into()),
    })
}

#[test]
fn arithmetic() {
    for (text, expected) in [
        ("1 - 2 - 3", -4.0),
        ("12 / x / 3", 2.0),
        ("1 + 2 * x", 5.0),
        ("( 1 + 2 ) * x", 6.0),
        ("-1.5e0 * x", -3.0),
        ("x - [ a - b ]", -8.0),
        ("( x - ( 1 - x ) ) / 3", 1.0),
    ] {
        assert_eq!(value(text), Ok(expected), "{text}");
    }
}

#[test]
fn errors_say_what_is_wrong() {
    for (text, part) in [
        ("", "missing"),
        ("x +", "missing"),
        ("( x", "not closed"),
        ("x )", "not opened"),
        ("'a", "not closed"),
        ("y", "no y"),
    ] {
        assert!(value(text).unwrap_err().contains(part), "{text}");
    }
}
