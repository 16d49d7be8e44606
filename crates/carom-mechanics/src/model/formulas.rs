//! Formulas of position and time: evaluated with their arguments, and reported with them if they
//! have no value.

use carom_formula::Formula;

/// A formula without a value that is allowed: it is not finite, or negative.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "{what} {} at X = {place:?}, t = {time}: {formula} = {value}",
    if value.is_finite() { "is negative" } else { "has no finite value" }
)]
pub struct NoValue {
    /// The source of the formula.
    pub what: String,
    /// The formula as written.
    pub formula: String,
    /// Reference position.
    pub place: Vec<f64>,
    /// Time.
    pub time: f64,
    /// The resulting value.
    pub value: f64,
}

/// Arguments X, (Y, Z,) t of a formula.
pub(super) struct Arguments {
    values: [f64; 4],
    count: usize,
}

impl Arguments {
    pub(super) fn new(place: &[f64], time: f64) -> Self {
        let mut values = [time; 4];
        values[..place.len()].copy_from_slice(place);
        Self { values, count: place.len() + 1 }
    }

    pub(super) fn as_slice(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

/// Value of a formula of position and time.
///
/// # Errors
/// If it is not finite.
pub fn value(formula: &Formula, what: &str, place: &[f64], time: f64) -> Result<f64, NoValue> {
    let value = formula.value(Arguments::new(place, time).as_slice());
    finite(value, formula, what, place, time)
}

/// Values of a formula at many places; a function of a program is called once.
///
/// # Errors
/// The first one that is not finite.
pub(super) fn values<'a>(
    formula: &Formula,
    what: &str,
    places: impl Iterator<Item = &'a [f64]>,
    time: f64,
) -> Result<Vec<f64>, NoValue> {
    let Some(function) = formula.function() else {
        return places.map(|place| value(formula, what, place, time)).collect();
    };
    let places: Vec<&[f64]> = places.collect();
    let Some(width) = places.first().map(|place| place.len() + 1) else { return Ok(Vec::new()) };
    let values =
        function.values(&points(&places, time), width).into_iter().chain(std::iter::repeat(f64::NAN));
    places.iter().zip(values).map(|(place, value)| finite(value, formula, what, place, time)).collect()
}

/// The variables of all places at a time, place after place.
pub(super) fn points(places: &[&[f64]], time: f64) -> Vec<f64> {
    places.iter().flat_map(|place| place.iter().copied().chain([time])).collect()
}

/// The value, if it is finite.
pub(super) fn finite(
    value: f64,
    formula: &Formula,
    what: &str,
    place: &[f64],
    time: f64,
) -> Result<f64, NoValue> {
    if value.is_finite() {
        return Ok(value);
    }
    let formula = formula.text().to_owned();
    Err(NoValue { what: what.to_owned(), formula, place: place.to_vec(), time, value })
}
