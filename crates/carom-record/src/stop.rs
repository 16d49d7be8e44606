//! `stopped.json` and `stopped.vtu`: why and where a simulation stopped. The manifest has their
//! BLAKE3 hashes.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::{FieldSet, Manifest, RecordError, files, json};

/// Names of the two files.
pub(crate) const FILES: [&str; 2] = ["stopped.json", "stopped.vtu"];

/// Why a simulation stopped, and what to try.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Stop {
    /// Keyword of the reason: `penetration`, `energy-guard`, …
    pub kind: String,
    /// The reason in words.
    pub reason: String,
    /// Grid step that could not be computed.
    pub step: u64,
    /// Time at the start of the last attempt; of the energy guard, at the end of the step.
    pub time: f64,
    /// Step size of the last attempt.
    pub dt: f64,
    /// Time of the last accepted state, which `stopped.vtu` contains.
    pub last: f64,
    /// Place of the stop, if it is known.
    pub place: Option<StopPlace>,
    /// The last iterations of Newton's method in the last attempt.
    pub iterations: Vec<StopIteration>,
    /// Suggested remedies, the most promising first.
    pub advice: Vec<Advice>,
}

/// The place of a stop. Positions are those of the last accepted state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StopPlace {
    /// How the place was found, if the reason does not name it.
    pub found: Option<String>,
    /// The node, or the first one of the cell.
    pub node: Option<StopNode>,
    /// Name of the contact.
    pub contact: Option<String>,
    /// Number of the facet that the node faces.
    pub facet: Option<usize>,
    /// Nodes of that facet, from end to end; none of a rigid obstacle.
    pub facet_nodes: Vec<StopNode>,
    /// Body of the cell.
    pub body: Option<String>,
    /// Number of the cell in its body.
    pub cell: Option<usize>,
    /// Point numbers of the cell.
    pub cell_nodes: Vec<usize>,
}

/// A node of the place.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StopNode {
    /// Number of the node's point in `stopped.vtu`.
    pub number: usize,
    /// Name of the body that the node belongs to.
    pub body: String,
    /// Reference position.
    pub reference: Vec<f64>,
    /// Position in the last accepted state.
    pub at: Vec<f64>,
}

/// An iterate of Newton's method, as multiples of the sum of the forces and of the length of the
/// model; what is not finite is none.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct StopIteration {
    pub number: u32,
    pub residual: Option<f64>,
    pub gap: Option<f64>,
    /// Size of the correction relative to the length of the model; none before the first one.
    pub correction: Option<f64>,
    /// Fraction of the correction that was taken.
    pub length: f64,
    pub active: u32,
    /// Whether the active set or a facet changed.
    pub changed: bool,
}

/// Something to try.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Advice {
    /// The remedy in words.
    pub what: String,
    /// The option that makes this change, as `key=value`.
    pub sets: Vec<String>,
}

impl Stop {
    /// Writes both files; the manifest takes their hashes.
    ///
    /// # Errors
    /// An input/output error, or fields that are not consistent.
    pub fn write(
        &self,
        directory: &Path,
        fields: &FieldSet,
        manifest: &mut Manifest,
    ) -> Result<(), RecordError> {
        let path = directory.join(FILES[0]);
        let text = json::text(&path, self)?;
        let fields = fields.to_vtu(self.last)?;
        for (name, bytes) in FILES.into_iter().zip([text, fields]) {
            files::write_atomically(&directory.join(name), &[&bytes])?;
            manifest.hashes.insert(name.into(), blake3::hash(&bytes).to_hex().to_string());
        }
        Ok(())
    }

    /// Reads `stopped.json`; none if the run did not stop, or was made by an earlier version.
    ///
    /// # Errors
    /// The file is missing or has changed.
    pub fn read(directory: &Path, manifest: &Manifest) -> Result<Option<Self>, RecordError> {
        let Some(bytes) = bytes(directory, FILES[0], manifest)? else { return Ok(None) };
        json::value(&directory.join(FILES[0]), &bytes, HINT).map(Some)
    }

    /// Reads `stopped.vtu`.
    ///
    /// # Errors
    /// The file is missing or has changed.
    pub fn fields(directory: &Path, manifest: &Manifest) -> Result<Option<FieldSet>, RecordError> {
        let Some(bytes) = bytes(directory, FILES[1], manifest)? else { return Ok(None) };
        let path = directory.join(FILES[1]);
        FieldSet::from_vtu(&bytes).map(Some).map_err(|what| RecordError::corrupt(&path, None, what, HINT))
    }

    /// Removes both files, of a run that is resumed.
    pub fn forget(directory: &Path, manifest: &mut Manifest) {
        for name in FILES {
            if manifest.hashes.remove(name).is_some() {
                // What is left behind is not in the manifest, and is not read.
                let _ = std::fs::remove_file(directory.join(name));
            }
        }
    }
}

const HINT: &str = "run the case again, or resume the run with `carom resume`";

/// A file whose hash the manifest has.
fn bytes(directory: &Path, name: &str, manifest: &Manifest) -> Result<Option<Vec<u8>>, RecordError> {
    manifest.hashes.contains_key(name).then(|| manifest.file(directory, name)).transpose()
}
