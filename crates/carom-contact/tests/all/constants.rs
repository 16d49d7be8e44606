//! Constants of geometric decisions stand in one table.

use std::path::Path;

/// Constants that are accuracies of iterations, bounds that are derived, or data of a method, by
/// the end of their file's path.
const OTHERS: [(&str, &[&str]); 16] = [
    ("../src/active_set.rs", &["RELEASE"]),
    ("../src/discrete_gradient.rs", &["ROUND_OFF", "NOISE"]),
    ("../src/friction.rs", &["EDGE"]),
    ("kinematics/mortar/cut.rs", &["ROUND_OFF"]),
    ("kinematics/mortar/field.rs", &["ALIKE"]),
    ("kinematics/mortar/measured.rs", &["STRAIGHT"]),
    ("kinematics/obstacle/path.rs", &["SHORTEST"]),
    ("kinematics/opposed.rs", &["SHORTER"]),
    ("kinematics/rounding.rs", &["KNOWN"]),
    ("kinematics/space/edge_crossing.rs", &["AMPLIFIED"]),
    ("kinematics/space/edge_gap.rs", &["LAST_DIGITS", "ALONG"]),
    ("kinematics/space/folds.rs", &["SHARES"]),
    ("kinematics/swept/edge_path.rs", &["WEIGHTS"]),
    ("kinematics/swept/patch_path.rs", &["WEIGHTS"]),
    ("kinematics/swept/path.rs", &["UNIT_ROUNDOFF", "WEIGHTS", "THIRD", "SIXTH"]),
    ("kinematics/way.rs", &["KNOWN", "LEAST"]),
];

/// Literals below 1 in formulas, by the end of their file's path.
const IN_FORMULAS: [(&str, &str); 4] = [
    ("kinematics/space/patch.rs", "0.32"),
    ("kinematics/swept/edge_path.rs", "0.754_877_666_246_692_7"),
    ("kinematics/swept/patch_path.rs", "0.754_877_666_246_692_7"),
    ("kinematics/tip_to_facet.rs", "0.125"),
];

/// Largest accuracy of an iteration, which no decision is made by.
const ACCURACY: f64 = 1e-12;

/// Constants of the table that follow from no other one.
const MOST: usize = 30;

/// Literals of numbers in a line without its comment.
fn literals(line: &str) -> Vec<&str> {
    let code = line.split("//").next().unwrap_or_default();
    let mut found = Vec::new();
    let mut before = ' ';
    let mut rest = code;
    while let Some(first) = rest.chars().next() {
        let begins = first.is_ascii_digit() && !before.is_alphanumeric() && !"_.".contains(before);
        let mut last = first;
        let mut goes_on = |c: char| {
            let is_part = c.is_ascii_alphanumeric() || "_.".contains(c) || c == '-' && last == 'e';
            last = c;
            is_part
        };
        let length = if begins { rest.find(|c| !goes_on(c)).unwrap_or(rest.len()) } else { first.len_utf8() };
        let (word, behind) = rest.split_at(length);
        found.extend(begins.then_some(word));
        before = word.chars().last().unwrap_or(' ');
        rest = behind;
    }
    found
}

/// Whether a literal is a real number that a decision could be made by: below 1, above the
/// accuracies of iterations, and not ½.
fn decides(literal: &str) -> bool {
    let value: f64 = literal.replace('_', "").parse().unwrap_or(0.0);
    value > ACCURACY && value < 1.0 && value != 0.5
}

/// Every source file below a folder.
fn sources(folder: &Path, found: &mut Vec<std::path::PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn geometric_constants_stand_in_one_table() {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    sources(&own.join("../src"), &mut files);
    sources(&own.join("../../carom-mechanics/src/check"), &mut files);
    let mut outside = Vec::new();
    for path in files {
        let name = path.to_string_lossy().replace('\\', "/");
        if name.ends_with("src/constants.rs") {
            continue;
        }
        let known = OTHERS.iter().filter(|(end, _)| name.ends_with(end)).flat_map(|(_, names)| *names);
        let known: Vec<&str> = known.copied().collect();
        let in_formulas = IN_FORMULAS.iter().filter(|(end, _)| name.ends_with(end));
        let in_formulas: Vec<&str> = in_formulas.map(|&(_, literal)| literal).collect();
        for line in std::fs::read_to_string(&path).unwrap().lines() {
            let Some((_, rest)) = line.split_once("const ") else {
                let unknown = literals(line).into_iter().filter(|literal| decides(literal));
                let unknown = unknown.filter(|literal| !in_formulas.contains(literal));
                outside.extend(unknown.map(|literal| format!("{name}: {literal}")));
                continue;
            };
            let Some((constant, kind)) = rest.split_once(": ") else { continue };
            let is_real = kind.starts_with("f64 =") || kind.starts_with("[f64");
            let digits =
                kind.split_once('=').is_some_and(|(_, value)| value.contains('.') || value.contains("e-"));
            if is_real && digits && !known.contains(&constant) {
                outside.push(format!("{name}: {constant}"));
            }
        }
    }
    assert_eq!(outside, Vec::<String>::new());
}

/// A constant that has a number of its own is a free choice; those that follow from others are not.
#[test]
fn few_constants_are_free() {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    let table = std::fs::read_to_string(own.join("../src/constants.rs")).unwrap();
    let values = table.lines().filter_map(|line| line.split_once("const ")?.1.split_once(" = "));
    let free: Vec<&str> = values
        .filter(|(_, value)| {
            let value =
                value.trim_end_matches(';').trim_start_matches("Angle::degrees(").trim_end_matches(')');
            value.parse::<f64>().is_ok()
        })
        .map(|(name, _)| name)
        .collect();
    assert!(free.len() <= MOST, "{} constants are free: {free:?}", free.len());
    assert!(free.len() > MOST / 2, "the table is not read: {free:?}");
}
