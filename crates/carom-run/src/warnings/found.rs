//! What a rule finds.

/// Where a rule applies, and what it found there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    pub(super) place: String,
    pub(super) what: String,
}

impl Found {
    pub(super) fn of_body(name: &str, what: String) -> Self {
        Self { place: format!("body \"{name}\""), what }
    }

    pub(super) fn of_contact(name: &str, what: String) -> Self {
        Self { place: format!("contact \"{name}\""), what }
    }
}

/// A number with three digits.
pub(super) fn short(x: f64) -> String {
    let digits = (2 - x.abs().max(1e-300).log10().floor() as i32).clamp(0, 9) as usize;
    if x != 0.0 && !(1e-4..1e6).contains(&x.abs()) { format!("{x:.2e}") } else { format!("{x:.digits$}") }
}
