//! Context of a failed arm: the arms of the same method that finished.

use serde_json::Value;

use super::{Study, step};
use crate::Status;

impl Study {
    /// For an arm that failed, the arms that finished and differ from it in their step, output and
    /// expectations only, in a sentence.
    pub fn finished_alike(&self, arm: usize) -> Option<String> {
        if self.rows[arm].status != Some(Status::Failed) {
            return None;
        }
        let arms = &self.manifest.arms;
        let method = method(&arms[arm].case);
        let own = step(&arms[arm], "time.step")?;
        let finished = (0..arms.len()).filter(|&other| self.rows[other].status == Some(Status::Finished));
        let alike: Vec<usize> = finished.filter(|&other| self::method(&arms[other].case) == method).collect();
        let named = |word: &str, meets: &dyn Fn(f64) -> bool| {
            let names = alike.iter().filter(|&&other| step(&arms[other], "time.step").is_some_and(meets));
            let names: Vec<String> = names.map(|&other| format!("\"{}\"", arms[other].name)).collect();
            (!names.is_empty()).then(|| format!("with a {word} step: {}", names.join(", ")))
        };
        let parts = [named("longer", &|step| step > own), named("shorter", &|step| step < own)];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        (!parts.is_empty()).then(|| format!("the same method finished {}", parts.join("; ")))
    }
}

/// A case without step, output and expectations.
fn method(case: &Value) -> Value {
    let mut method = case.clone();
    if let Some(table) = method.as_object_mut() {
        ["output", "expects", "title"].iter().for_each(|key| _ = table.remove(*key));
    }
    if let Some(time) = method.get_mut("time").and_then(Value::as_object_mut) {
        time.remove("step");
    }
    method
}
