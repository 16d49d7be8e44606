//! What a run records: probes, rows of the history, fields, checkpoints.

use carom_record::FieldFormat;
use serde::{Deserialize, Serialize};

/// A point whose quantities become columns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProbeSpec {
    /// Name; columns are `name.quantity`.
    pub name: String,
    /// Reference point.
    pub at: Vec<f64>,
    /// Body it belongs to.
    pub body: String,
    /// Quantities.
    pub record: Vec<Quantity>,
}

/// What a probe may record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs)]
pub enum Quantity {
    Ux,
    Uy,
    Vx,
    Vy,
    Ax,
    Ay,
    SigmaXx,
    SigmaYy,
    SigmaXy,
    VonMises,
    DetF,
}

/// What is written, and when.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OutputSpec {
    /// Fields every so many steps; 0: none.
    pub fields_every: usize,
    /// How fields are written.
    #[serde(default)]
    pub format: FieldFormat,
    /// Fields at the steps nearest to these times, besides.
    pub at_times: Vec<f64>,
    /// History rows every so many steps.
    pub history_every: usize,
    /// Checkpoints every so many steps.
    pub checkpoint_every: usize,
}
