//! JSON Schema (draft 2020-12) of the study file, for editors: its own keys, and the keys of the
//! case where values are set.

use carom_case::keys::Keys;
use serde_json::{Value, json};

use crate::file::StudyFile;

/// The schema of a study file.
pub fn schema() -> Value {
    let mut schema = carom_case::schema_of(&StudyFile::TABLE, "Carom study");
    // The case of the study is not needed where every arm has its own.
    let own = json!({
        "properties": { "arm": { "items": { "required": ["case"] } } },
        "required": ["arm"],
        "not": { "required": ["grid"] }
    });
    schema["anyOf"] = json!([{ "required": ["case"] }, own]);
    schema
}
