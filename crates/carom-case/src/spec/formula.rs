//! Values that may vary in space and time.

use carom_formula::{Formula, FormulaError};
use serde::{Deserialize, Serialize};

/// Begins the name of a function of a program, in place of a formula.
const FUNCTION: char = '@';

/// A number, or a formula as written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum FormulaSpec {
    /// Constant in space and time.
    Number(f64),
    /// A formula.
    Text(String),
}

impl FormulaSpec {
    /// The formula in these variables.
    ///
    /// # Errors
    /// The text is not a formula.
    pub fn formula(&self, variables: &[&str]) -> Result<Formula, FormulaError> {
        match self {
            Self::Number(value) => Ok(Formula::constant(*value)),
            Self::Text(text) => Formula::parse(text, variables),
        }
    }

    /// Name of the function that the program provides for this value: `push` of `@push`; none of a
    /// formula.
    pub fn function(&self) -> Option<&str> {
        match self {
            Self::Number(_) => None,
            Self::Text(text) => text.strip_prefix(FUNCTION),
        }
    }

    /// The constant value; none if the formula contains a variable.
    pub fn constant(&self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(*value),
            Self::Text(text) => Some(Formula::parse(text, &[]).ok()?.value(&[])),
        }
    }

    /// Whether it is zero.
    pub fn is_zero(&self) -> bool {
        self.constant() == Some(0.0)
    }
}

/// Writes the number or formula as it was given.
impl std::fmt::Display for FormulaSpec {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(value) => write!(f, "{value}"),
            Self::Text(text) => f.write_str(text),
        }
    }
}
