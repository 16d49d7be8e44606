//! Values and derivatives against hand calculations and finite differences; errors with their
//! place.

#![allow(clippy::unwrap_used)]

use carom_formula::Formula;
use proptest::prelude::*;

fn value(text: &str) -> f64 {
    Formula::parse(text, &[]).unwrap().value(&[])
}

#[test]
fn arithmetic_is_read_as_in_print() {
    for (text, expected) in [
        ("1 + 2*3", 7.0),
        ("2 - 3 - 4", -5.0),
        ("8/4/2", 1.0),
        ("-2^2", -4.0),
        ("(-2)^2", 4.0),
        ("2^-1", 0.5),
        ("2^3^2", 512.0),
        ("--3", 3.0),
        ("-3 + 5", 2.0),
        ("2*-3", -6.0),
        ("1e-3 + .5 + 2.", 2.501),
        ("min(3, 2) + max(3, 2)", 5.0),
        ("mod(-1, 3)", 2.0),
        ("mod(7.5, 2)", 1.5),
        ("if(1 < 2 && 2 <= 2, 10, 20)", 10.0),
        ("if(1 > 2 || 3 == 4, 10, 20)", 20.0),
        ("if(0 != 0, 1/0, 3)", 3.0),
        ("sign(-2) + floor(1.7) + abs(-4)", 4.0),
        ("sqrt(16) + ln(exp(2))", 6.0),
        ("(3 > 2) + (2 >= 3)", 1.0),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
    let near = |text: &str, expected: f64| {
        assert!((value(text) - expected).abs() < 1e-15, "{text}: {}", value(text));
    };
    near("sin(pi/6)", 0.5);
    near("cos(pi/3)", 0.5);
    near("tan(pi/4)", 1.0);
    near("atan2(1, -1)", 0.75 * std::f64::consts::PI);
    near("asin(1) + acos(1) + atan(0)", std::f64::consts::FRAC_PI_2);
    near("cosh(1)^2 - sinh(1)^2", 1.0);
}

#[test]
fn derivatives_by_hand() {
    let at = |text: &str, t: f64| Formula::parse(text, &["X", "t"]).unwrap().with_derivatives(&[3.0, t], 1);
    assert_eq!(at("X*t^3", 2.0), [24.0, 36.0, 36.0]);
    assert_eq!(at("t^2", 0.0), [0.0, 0.0, 2.0]);
    assert_eq!(at("t^0", 0.0), [1.0, 0.0, 0.0]);
    assert_eq!(at("(t - 1)^3", 0.0), [-1.0, 3.0, -6.0]);
    assert_eq!(at("1/t", 2.0), [0.5, -0.25, 0.25]);
    assert_eq!(at("min(t/0.1, 1)", 0.05), [0.5, 10.0, 0.0]);
    assert_eq!(at("min(t/0.1, 1)", 0.2), [1.0, 0.0, 0.0]);
    assert_eq!(at("abs(t)", -2.0), [2.0, -1.0, 0.0]);
    assert_eq!(at("mod(t, 2)", 5.0), [1.0, 1.0, 0.0]);
    assert_eq!(at("if(t < 1, t^2, 5*t)", 3.0), [15.0, 5.0, 0.0]);
    // A constant stays one where its function has an infinite slope.
    assert_eq!(at("sqrt(X - 3) + t", 1.0), [1.0, 1.0, 0.0]);
    assert_eq!(at("sin(t)", 0.0), [0.0, 1.0, 0.0]);
    assert!(at("1/t", 0.0)[0].is_infinite() && at("ln(-t)", 1.0)[0].is_nan());
}

proptest! {
    #[test]
    fn derivatives_by_differences(t in 0.15..0.85, x in 0.2..2.0) {
        for text in [
            "sin(X*t)*cos(t)", "tan(t/2)", "asin(t)*X", "acos(t/2)", "atan(3*t - X)", "sinh(t)*cosh(X*t)", "tanh(2*t)", "exp(-t*X)",
            "ln(1 + t^2)", "sqrt(1 + X*t)", "abs(X*t - 4)", "t^X", "X^t", "t^2.5", "(t - 5)^3", "1/(1 + t^2)", "t/(X + t)",
            "mod(t, 1)*t", "atan2(t, X - 1)", "atan2(X - 1, -t)", "min(t^2, 4)*max(t^3, -1)", "if(t < 0.9, exp(t), 0)", "-t*t - +t",
        ] {
            let formula = Formula::parse(text, &["t", "X"]).unwrap();
            let [value, first, second] = formula.with_derivatives(&[t, x], 0);
            let h = 1e-3;
            let f = |k: f64| formula.value(&[t + k * h, x]);
            // Sixth-order differences: error h⁶ times a seventh derivative.
            let slope = (45.0 * (f(1.0) - f(-1.0)) - 9.0 * (f(2.0) - f(-2.0)) + f(3.0) - f(-3.0)) / (60.0 * h);
            let pairs = 270.0 * (f(1.0) + f(-1.0)) - 27.0 * (f(2.0) + f(-2.0)) + 2.0 * (f(3.0) + f(-3.0));
            let bend = (pairs - 490.0 * f(0.0)) / (180.0 * h * h);
            prop_assert!((value - f(0.0)).abs() <= 1e-15 * (1.0 + value.abs()), "{text}");
            prop_assert!((first - slope).abs() < 1e-9 * (1.0 + slope.abs()), "{text}: {first} against {slope}");
            prop_assert!((second - bend).abs() < 1e-6 * (1.0 + bend.abs()), "{text}: {second} against {bend}");
        }
    }

    #[test]
    fn no_text_makes_it_panic(text in "[-+*/^()., a-z0-9<>=&|é]{0,40}") {
        if let Err(error) = Formula::parse(&text, &["t"]) {
            prop_assert!(error.at.end <= text.len() && text.get(error.at.clone()).is_some(), "{text:?}: {error:?}");
        }
    }
}

#[test]
fn mistakes_have_a_place_and_a_word_of_help() {
    for (text, at, message) in [
        ("", 0..0, "the formula is empty"),
        ("  ", 0..2, "the formula is empty"),
        ("2*", 2..2, "the formula ends where a number, a variable or a function is expected"),
        ("2*(t", 4..4, "the formula ends where an operator or a closing parenthesis is expected"),
        ("2 t", 2..3, "`t` found where an operator is expected"),
        ("2*)", 2..3, "`)` found where a number, a variable or a function is expected"),
        ("t)", 1..2, "this parenthesis has no opening parenthesis"),
        ("t**2", 1..3, "a power is written ^, not **"),
        ("3 + $", 4..5, "`$` found where a number, a variable or a function is expected"),
        ("3 = t", 2..3, "`=` found where an operator is expected"),
        ("T + 1", 0..1, "there is no variable `T`: did you mean `t`?"),
        ("1 + velocity", 4..12, "there is no variable `velocity`: the variables are X, t"),
        ("Pi*2", 0..2, "there is no variable `Pi`: did you mean `pi`?"),
        ("2*sun(t)", 2..5, "there is no function `sun`: did you mean `sin`?"),
        ("t(3)", 0..1, "`t` is not a function: write `t*(`"),
        ("sin + 1", 0..3, "`sin` is a function: write its argument in parentheses"),
        ("1 + min(t)", 4..10, "`min` takes 2 arguments, not 1"),
        ("sin(t, 2)", 0..9, "`sin` takes 1 argument, not 2"),
        ("if(t, 2)", 0..8, "`if` takes 3 arguments, not 2"),
        ("1e999", 0..5, "the number 1e999 is too large"),
        ("SQRT(t)", 0..4, "there is no function `SQRT`: did you mean `sqrt`?"),
        ("sin t", 0..3, "`sin` is a function: write its argument in parentheses"),
        ("t*(X + velocity", 7..15, "there is no variable `velocity`: the variables are X, t"),
        ("1e*t", 1..2, "`e` found where an operator is expected"),
        ("sin()", 4..5, "`)` found where a number, a variable or a function is expected"),
    ] {
        let error = Formula::parse(text, &["X", "t"]).unwrap_err();
        assert_eq!((error.message.as_str(), error.at), (message, at), "{text:?}");
    }
    let deep = format!("{}t{}", "(".repeat(65), ")".repeat(65));
    assert_eq!(Formula::parse(&deep, &["t"]).unwrap_err().at, 64..65);
    assert!(Formula::parse(&"-".repeat(5000), &[]).is_err());
    assert_eq!(Formula::parse(&format!("-{}", "é".repeat(3000)), &[]).unwrap_err().at, 4095..6001);
    assert!(Formula::parse(&format!("{}1", "-".repeat(4000)), &[]).is_ok());
    assert!(Formula::parse(&format!("1{}", "^1".repeat(2000)), &[]).is_ok());
}

#[test]
fn a_formula_is_stored_as_its_text() {
    let formula = Formula::parse("X + 2*t", &["X", "t"]).unwrap();
    assert_eq!(serde_json::to_string(&formula).unwrap(), r#""X + 2*t""#);
    assert!(formula.depends_on("t") && !Formula::parse("X", &["X", "t"]).unwrap().depends_on("t"));
    let constant = Formula::constant(-2.5);
    assert_eq!((constant.text(), constant.value(&[1.0])), ("-2.5", -2.5));
}
