//! A case as JSON, as the manifest of its run stores it. Its many types are serialised here alone:
//! each crate that did so itself would compile them again.

use serde_json::{Error, Value};

use crate::spec::Case;

impl Case {
    /// All of a case as JSON.
    ///
    /// # Errors
    /// None for a case that was read.
    pub fn to_json(&self) -> Result<Value, Error> {
        serde_json::to_value(self)
    }

    /// The case that [`to_json`](Self::to_json) stored.
    ///
    /// # Errors
    /// Where the JSON is not that of a case of this version.
    pub fn from_json(json: Value) -> Result<Self, Error> {
        serde_json::from_value(json)
    }
}
