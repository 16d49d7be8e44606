//! What a run records: probes, rows of history.csv, fields, checkpoints.

use carom_record::FieldFormat;
use serde::{Deserialize, Serialize};

/// A material point whose quantities are recorded as columns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProbeSpec {
    /// Name; columns are `name.quantity`.
    pub name: String,
    /// Reference position.
    pub at: Vec<f64>,
    /// Body it belongs to.
    pub body: String,
    /// Recorded quantities.
    pub record: Vec<Quantity>,
}

/// Quantities that a probe can record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs)]
pub enum Quantity {
    Ux,
    Uy,
    Uz,
    Vx,
    Vy,
    Vz,
    Ax,
    Ay,
    Az,
    SigmaXx,
    SigmaYy,
    SigmaZz,
    SigmaXy,
    SigmaYz,
    SigmaXz,
    VonMises,
    DetF,
}

/// What is written, and how often.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OutputSpec {
    /// Steps between two outputs of the fields; 0: none.
    pub fields_every: usize,
    /// Format of the fields.
    #[serde(default)]
    pub format: FieldFormat,
    /// Fields are also written at the steps nearest to these times.
    pub at_times: Vec<f64>,
    /// Steps between two rows of history.csv.
    pub history_every: usize,
    /// Steps between two checkpoints.
    pub checkpoint_every: usize,
}
