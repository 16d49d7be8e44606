//! The warnings of a study, each once, with the arms that gave it.

use carom_record::Warning;
use carom_record::study::StudyManifest;
use serde_json::{Value, json};

/// Most arms that are named.
const NAMED: usize = 4;

/// `"Hu", "Newmark": ` or `all arms: `; nothing in a study of one arm.
pub(crate) fn of_arms(arms: &[usize], manifest: &StudyManifest) -> String {
    match (arms.len(), manifest.arms.len()) {
        (_, 1) => String::new(),
        (some, all) if some == all => "all arms: ".to_owned(),
        _ => {
            let name = |arm: &usize| format!("\"{}\"", manifest.arms[*arm].name);
            let named = if arms.len() == NAMED + 1 { arms.len() } else { NAMED };
            let names: Vec<_> = arms.iter().take(named).map(name).collect();
            let others = arms.len().saturating_sub(named);
            let others = if others > 0 { format!(" and {others} others") } else { String::new() };
            names.join(", ") + &others + ": "
        }
    }
}

/// Warnings as in the events of a run, with the names of the arms.
pub(crate) fn warnings(shared: &[(&Warning, Vec<usize>)], manifest: &StudyManifest) -> Value {
    let names = |arms: &[usize]| arms.iter().map(|arm| manifest.arms[*arm].name.clone()).collect::<Vec<_>>();
    shared
        .iter()
        .map(|(warning, arms)| {
            json!({ "message": warning.to_string(), "warning": warning, "arms": names(arms) })
        })
        .collect()
}
