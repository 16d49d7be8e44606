//! The settings of arms: those that all arms share, and those in which they differ.

use carom_record::study::{Arm, Study};
use serde_json::Value;

/// Arms other than those of a computed reference.
fn arms(study: &Study) -> impl Iterator<Item = &Arm> {
    study.manifest.arms.iter().filter(|arm| !arm.role.fine)
}

/// Whether all arms have a setting.
pub(crate) fn is_shared(study: &Study, set: &str) -> bool {
    study.manifest.arms.len() > 1 && arms(study).all(|arm| arm.sets.iter().any(|other| other == set))
}

/// Settings that all arms have.
pub(crate) fn shared(study: &Study) -> Vec<&String> {
    let first = arms(study).next();
    first.into_iter().flat_map(|arm| &arm.sets).filter(|set| is_shared(study, set)).collect()
}

/// Settings joined by commas, without those that all arms have.
pub(crate) fn own_settings(study: &Study, joined: &str) -> String {
    // A value may contain a comma: shared settings are removed as a whole.
    let mut own = joined.to_owned();
    for set in shared(study) {
        for (from, to) in [(format!(", {set}, "), ", "), (format!("{set}, "), ""), (format!(", {set}"), "")] {
            own = own.replace(&from, to);
        }
        if own == *set {
            own.clear();
        }
    }
    own
}

/// The parameters in which arms differ, in order, each with the value of every arm that sets it.
pub(crate) fn varied(study: &Study) -> Vec<(&str, Vec<Option<&str>>)> {
    let mut found: Vec<(&str, Vec<Option<&str>>)> = Vec::new();
    let count = study.manifest.arms.len();
    for (i, arm) in study.manifest.arms.iter().enumerate().filter(|(_, arm)| !arm.role.fine) {
        let own = arm.sets.iter().filter(|set| !is_shared(study, set));
        for (key, value) in own.filter_map(|set| set.split_once('=')) {
            let (key, value) = (key.trim(), value.trim());
            let at = found.iter().position(|(known, _)| *known == key).unwrap_or_else(|| {
                found.push((key, vec![None; count]));
                found.len() - 1
            });
            found[at].1[i] = Some(value);
        }
    }
    found.retain(|(key, values)| !is_as_in_case(study, key, values));
    found
}

/// Whether the arms that set a key give it the value that the others have from the case.
fn is_as_in_case(study: &Study, key: &str, values: &[Option<&str>]) -> bool {
    let arms = study.manifest.arms.iter().zip(values).filter(|(arm, _)| !arm.role.fine);
    let mut all = arms.map(|(arm, set)| set.map(str::to_owned).or_else(|| of_case(arm, key)));
    all.next().flatten().is_some_and(|first| all.all(|other| other.as_ref() == Some(&first)))
}

/// Largest number of entries of a table that is given as a value.
const ENTRIES: usize = 4;

/// A number, a word, a truth or a short list of them in TOML.
fn plain(value: &Value) -> Option<String> {
    match value {
        Value::Number(number) => Some(number.to_string()),
        Value::String(word) => Some(format!("\"{word}\"")),
        Value::Bool(truth) => Some(truth.to_string()),
        Value::Array(list) if (1..=ENTRIES).contains(&list.len()) => {
            let all: Option<Vec<String>> = list.iter().map(plain).collect();
            all.map(|all| format!("[{}]", all.join(", ")))
        }
        _ => None,
    }
}

/// A value of the case that an arm without a setting has: a number, a word, a truth, or a short
/// table of them, in which the kind comes first.
pub(crate) fn of_case(arm: &Arm, key: &str) -> Option<String> {
    let mut node = &arm.case;
    let mut parts = key.split('.');
    while let Some(part) = parts.next() {
        // `body.disc.mass` is the entry named `disc` of the list `bodies`.
        let list = match part {
            "body" => "bodies".to_owned(),
            part => format!("{part}s"),
        };
        node = match (node.get(part), node.get(&list).and_then(|list| list.as_array())) {
            (Some(inner), _) => inner,
            (_, Some(list)) => {
                let name = parts.next()?;
                list.iter().find(|one| one.get("name").is_some_and(|own| own == name))?
            }
            _ => return None,
        };
    }
    let Value::Object(table) = node else { return plain(node) };
    let mut entries: Vec<_> = table.iter().filter(|(_, value)| !value.is_null()).collect();
    entries.sort_by_key(|(key, _)| *key != "kind");
    let entry = |(key, value): (&String, &Value)| Some(format!("{key} = {}", plain(value)?));
    let shown = entries.into_iter().map(entry).collect::<Option<Vec<_>>>()?;
    (1..=ENTRIES).contains(&shown.len()).then(|| format!("{{ {} }}", shown.join(", ")))
}

/// A value with at most five digits in each of its numbers, still in TOML.
pub(crate) fn brief(value: &str) -> String {
    let mut out = String::new();
    let mut word = String::new();
    let flush = |word: &mut String, out: &mut String| {
        let digits = word.chars().filter(char::is_ascii_digit).count();
        match word.parse::<f64>() {
            Ok(number) if digits > 6 => out.push_str(&crate::digits::five(number).replace('−', "-")),
            _ => out.push_str(word),
        }
        word.clear();
    };
    let mut quoted = false;
    for c in value.chars() {
        quoted ^= c == '"';
        if !quoted && (c.is_alphanumeric() || matches!(c, '.' | '-' | '+' | '_')) {
            word.push(c);
        } else {
            flush(&mut word, &mut out);
            out.push(c);
        }
    }
    flush(&mut word, &mut out);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn long_numbers_are_shortened() {
        assert_eq!(
            brief("{ shape = \"disc-1234567\", size = 7.874015748031496 }"),
            "{ shape = \"disc-1234567\", size = 7.874 }"
        );
        assert_eq!(brief("[-78.74015748031496, 1e-3, 0.00000903182300002092]"), "[-78.74, 1e-3, 9.032e-6]");
    }

    #[test]
    fn values_of_the_case_are_found_by_name() {
        let case = json!({
            "time": { "step": 0.01, "scheme": { "rho_inf": 0.6, "kind": "hu" } },
            "bodies": [{ "name": "a", "mass": "lumped" }, { "name": "b", "mass": "consistent" }],
            "contacts": [{ "name": "strike", "mu": 0.0 }],
        });
        let arm: Arm = serde_json::from_value(
            json!({ "name": "", "directory": "", "sets": [], "steps": 1, "case": case }),
        )
        .unwrap();
        let of = |key| of_case(&arm, key);
        assert_eq!(of("time.step").as_deref(), Some("0.01"));
        assert_eq!(of("body.b.mass").as_deref(), Some("\"consistent\""));
        assert_eq!(of("contact.strike.mu").as_deref(), Some("0.0"));
        assert_eq!(of("time.scheme").as_deref(), Some("{ kind = \"hu\", rho_inf = 0.6 }"));
        assert_eq!((of("time"), of("body.c.mass"), of("contact.strike.law")), (None, None, None));
    }

    /// What some arms set to the value of the case does not differ between arms.
    #[test]
    fn settings_equal_to_the_case_do_not_differ() {
        let mut study = crate::trend::tests::study(&[("a", vec![]), ("b", vec![])]);
        for arm in &mut study.manifest.arms {
            arm.case = json!({ "time": { "step": 0.01 }, "contact": { "law": "position" } });
            arm.sets.clear();
        }
        let sets = ["time.step=0.02", "contact.law=\"position\""];
        study.manifest.arms[1].sets = sets.map(str::to_owned).into();
        let keys: Vec<&str> = varied(&study).into_iter().map(|(key, _)| key).collect();
        assert_eq!(keys, ["time.step"]);
    }
}
