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
        for line in std::fs::read_to_string(&path).unwrap().lines() {
            let Some((_, rest)) = line.split_once("const ") else { continue };
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
