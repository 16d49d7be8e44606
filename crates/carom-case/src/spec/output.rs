//! Records of a run: probes, rows of history.csv, fields, checkpoints; measured data.

use serde::{Deserialize, Serialize};

use crate::keys::Kind::{Choices, Count, Name, Numbers, Text, Vector};
use crate::keys::{ANY, Keys, View};

/// A material point whose quantities are recorded as columns name.quantity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Keys)]
#[keys(name = "[[probe]]")]
pub struct ProbeSpec {
    /// Name; its columns are name.quantity.
    #[key(Name, example = "\"A\"")]
    pub name: String,
    /// Reference position of the point.
    #[key(Vector, unit = "length", example = "[0.0, 1.5]")]
    pub at: Vec<f64>,
    /// Body it belongs to.
    #[key(Name, example = "\"cylinder\"")]
    pub body: String,
    /// Where materials of a body meet: the one of which stress, strain and volume ratio are
    /// recorded, which have a value on each side.
    #[key(Name, optional = "\"pad\"")]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// Recorded quantities: displacement, velocity, acceleration, Cauchy stress, von Mises stress,
    /// volume ratio, equivalent plastic strain, the share of quadrature points that have yielded,
    /// Green–Lagrange strain.
    #[key(Choices(Quantity::WORDS), example = "[\"uy\", \"sigma_yy\"]")]
    pub record: Vec<Quantity>,
}

/// Measured data of a column, in the units of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OverlaySpec {
    /// Name in figures and metrics.
    pub name: String,
    /// Name of the file as written.
    pub file: String,
    /// The column of history.csv.
    pub column: String,
    /// Times.
    pub times: Vec<f64>,
    /// Values.
    pub values: Vec<f64>,
    /// Where the data come from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
}

/// Quantities that a probe can record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Keys)]
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
    PlasticStrain,
    Yielded,
    StrainXx,
    StrainYy,
    StrainZz,
    StrainXy,
    StrainYz,
    StrainXz,
}

impl Quantity {
    /// Whether it is a component of the Cauchy stress, or von Mises stress.
    pub fn is_stress(self) -> bool {
        self == Self::VonMises || self.word().starts_with("sigma_")
    }
}

/// What is written, and how often.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, Keys)]
#[keys(name = "[output]")]
pub struct OutputSpec {
    /// Steps between two outputs of the fields; 0: none. Default: 0 if at_times is given; otherwise
    /// about 80 outputs spread over the run, fewer of a large model, and up to 72 more while
    /// contact is closed.
    #[key(Count(0), optional = "20", with = fields_every)]
    pub fields_every: Option<usize>,
    /// Field format: one VTU file per output, listed in fields.pvd; Run.to_vtkhdf in Python makes
    /// one file of them.
    #[key(Text, default = "\"vtu\"", with = only_vtu)]
    #[serde(skip)]
    pub format: (),
    /// Fields are also written at the steps nearest to these times.
    #[key(Numbers(ANY), unit = "time", default = "[]")]
    pub at_times: Vec<f64>,
    /// Steps between two rows of history.csv.
    #[key(Count(1), default = "1")]
    pub history_every: usize,
    /// Steps between two checkpoints, from which a run that is killed is continued; after a power
    /// failure, from the last one that was flushed to the disk (at most one in five seconds).
    #[key(Count(1), default = "50")]
    pub checkpoint_every: usize,
}

/// Reads the number of steps between two outputs of the fields; none if outputs are spread over the
/// run.
fn fields_every(v: &View) -> Option<usize> {
    if v.has("fields_every") {
        return v.get("fields_every");
    }
    v.has("at_times").then_some(0)
}

fn only_vtu(v: &View) -> Option<()> {
    let format: String = v.get("format")?;
    if format == "vtu" {
        return Some(());
    }
    v.wrong(
        "format",
        "fields are written as VTU, the only format",
        "one file per output remains readable if the run is killed; a single file for viewers is made after it",
        "leave format out; after the run, carom.open(DIRECTORY).to_vtkhdf(FILE) in Python makes one VTKHDF file",
    )
}
