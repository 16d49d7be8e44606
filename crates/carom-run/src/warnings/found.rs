//! The finding of a rule.

use carom_case::ContactSpec;

/// Where a rule applies, and what it found there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    pub(super) place: String,
    pub(super) what: String,
    /// Advice for this place, instead of that of the entry.
    pub(super) advice: Option<String>,
}

impl Found {
    pub(super) fn at(place: String, what: String) -> Self {
        Self { place, what, advice: None }
    }

    pub(super) fn of_body(name: &str, what: String) -> Self {
        Self::at(format!("body \"{name}\""), what)
    }

    pub(super) fn of_the_run(what: String) -> Self {
        Self::at("the run".into(), what)
    }

    pub(super) fn of_contact(name: &str, what: String) -> Self {
        Self::at(format!("contact \"{name}\""), what)
    }

    pub(super) fn of_material(name: &str, what: String) -> Self {
        Self::at(format!("material \"{name}\""), what)
    }

    pub(super) fn with_advice(self, advice: String) -> Self {
        Self { advice: Some(advice), ..self }
    }
}

/// The sides of contacts between bodies that meet elsewhere, as words to be appended; nothing
/// without any.
pub(super) fn covered_by(contacts: &[&ContactSpec]) -> String {
    let named = |contact: &&ContactSpec| match contact.primary.side() {
        Some(primary) => format!("\"{}\" acts between {} and {primary}", contact.name, contact.secondary),
        None => format!("\"{}\" acts on {}", contact.name, contact.secondary),
    };
    if contacts.is_empty() {
        return String::new();
    }
    format!(", elsewhere than where {}", contacts.iter().map(named).collect::<Vec<_>>().join(" and "))
}

/// A number with three digits.
pub(super) fn short(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let digits = (2 - x.abs().max(1e-300).log10().floor() as i32).clamp(0, 9) as usize;
    if (1e-4..1e6).contains(&x.abs()) { format!("{x:.digits$}") } else { format!("{x:.2e}") }
}
