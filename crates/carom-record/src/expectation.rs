//! Expectations.
use crate::Run;
/// Evaluates.
pub fn evaluate(_run: &Run, _what: &str) -> Result<f64, String> { Err(String::new()) }
