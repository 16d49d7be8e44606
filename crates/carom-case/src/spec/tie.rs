//! Ties: sides that are joined for good.

use serde::{Deserialize, Serialize};

use crate::keys::Kind::{Name, Number, Side};
use crate::keys::{Keys, NOT_NEGATIVE};

/// A tie: the nodes of a side move with the points of another side on which they lie. The meshes
/// need not match; the sides may belong to one body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Keys)]
#[keys(name = "[[tie]]")]
pub struct TieSpec {
    /// Name used in records and messages; the force of the tie is recorded.
    #[key(Name, example = "\"bond\"")]
    pub name: String,
    /// Secondary side, whose nodes are tied: that with the finer mesh or, of equal meshes, of the
    /// softer body.
    #[key(Side, example = "\"tread.inner\"")]
    pub secondary: String,
    /// Primary side, whose points the tied nodes are.
    #[key(Side, example = "\"rim.outer\"")]
    pub primary: String,
    /// Discretisation of the tie. `mortar`: dimension 2.
    #[key(default = "\"points\"")]
    #[serde(default, skip_serializing_if = "TieMethod::is_of_points")]
    pub method: TieMethod,
    /// Largest distance of a secondary node from the primary side that is closed, without stress:
    /// the node is moved in the mesh. Default: a millionth of the length of the nearest facet, in
    /// dimension 1 of the shortest cell.
    #[key(Number(NOT_NEGATIVE), unit = "length", example = "0.01")]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub adjust: Option<f64>,
    /// Secondary nodes beside the primary side.
    #[key(default = "\"refuse\"")]
    #[serde(default)]
    pub overhang: Overhang,
}

/// Discretisation of a tie.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
pub enum TieMethod {
    /// A secondary node is a point of the primary side.
    #[default]
    Points,
    /// A secondary node is a mean of points, such that uniform stress passes between meshes that do
    /// not match.
    Mortar,
}

impl TieMethod {
    #[allow(clippy::trivially_copy_pass_by_ref)] // Serde passes a reference.
    fn is_of_points(&self) -> bool {
        *self == Self::Points
    }
}

/// Secondary nodes of a tie beside the primary side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
pub enum Overhang {
    /// The case is refused.
    #[default]
    Refuse,
    /// Such nodes remain free.
    Free,
}

impl TieSpec {
    /// Names of the bodies of its sides, the secondary one first.
    pub fn bodies(&self) -> [&str; 2] {
        [&self.secondary, &self.primary].map(|side| carom_record::body_of(side))
    }
}
