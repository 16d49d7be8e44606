//! Formulas of place and time in a model: evaluated with their arguments, and refused with them where they have no value.

use carom_formula::Formula;

/// A formula without a finite value.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{what} has no finite value at X = {place:?}, t = {time}: {formula} = {value}")]
pub struct NoValue {
    /// Whose formula.
    pub what: String,
    /// The formula as written.
    pub formula: String,
    /// Reference place.
    pub place: Vec<f64>,
    /// Time.
    pub time: f64,
    /// What came out.
    pub value: f64,
}

/// Arguments X, (Y,) t of a formula, to be cut at [..=D].
pub(super) fn arguments<const D: usize>(place: &[f64; D], time: f64) -> [f64; 4] {
    std::array::from_fn(|i| if i < D { place[i] } else { time })
}

/// Value of a formula of place and time.
pub(super) fn value<const D: usize>(
    formula: &Formula,
    what: &str,
    place: &[f64; D],
    time: f64,
) -> Result<f64, NoValue> {
    let value = formula.value(&arguments(place, time)[..=D]);
    finite(value, formula, what, place, time)
}

/// The value, if it is finite.
pub(super) fn finite<const D: usize>(
    value: f64,
    formula: &Formula,
    what: &str,
    place: &[f64; D],
    time: f64,
) -> Result<f64, NoValue> {
    if value.is_finite() {
        return Ok(value);
    }
    let formula = formula.text().to_owned();
    Err(NoValue { what: what.to_owned(), formula, place: place.to_vec(), time, value })
}
