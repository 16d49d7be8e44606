//! What metrics, expectations and studies need to know of a case.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::expect::Expect;

/// Facts of a case, which whoever resolves the case states.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Facts {
    /// Title.
    pub title: String,
    /// Space dimension: 1, 2 or 3.
    pub dimension: usize,
    /// Whether it has load steps in place of time steps.
    pub is_static: bool,
    /// End time.
    pub end: f64,
    /// Factor by which all meshes were refined.
    pub refine: f64,
    /// Contacts.
    pub contacts: Vec<ContactFacts>,
    /// Axes along which supports hold or move bodies.
    pub held: Vec<Held>,
    /// Names of the probes.
    pub probes: Vec<String>,
    /// Exact solution by column, as formulas in t.
    pub exact: BTreeMap<String, String>,
    /// Measured data of columns.
    pub overlays: Vec<Overlay>,
    /// Expected values.
    pub expects: Vec<Expect>,
}

/// Facts of a contact.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactFacts {
    /// Its name; the columns of an obstacle that moves have it too.
    pub name: String,
    /// Secondary side, `body.side`.
    pub secondary: String,
    /// Primary side; none of an obstacle.
    pub primary: Option<String>,
    /// Whether the obstacle moves.
    pub moves: bool,
    /// Whether contact is enforced by a penalty.
    pub is_penalty: bool,
    /// Whether velocities are projected where contact begins.
    pub projects: bool,
}

/// An axis along which a support holds a body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Held {
    /// The body.
    pub body: String,
    /// The axis; none across the side, whose direction is not recorded.
    pub axis: Option<usize>,
    /// Displacement as a formula in X, Y, Z and t; none where it is constant.
    pub displacement: Option<String>,
}

/// Measured data, in the units of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Overlay {
    /// Its name in figures and metrics.
    pub name: String,
    /// The column of the history that it belongs to.
    pub column: String,
    /// Times.
    pub times: Vec<f64>,
    /// Values.
    pub values: Vec<f64>,
    /// Where they come from.
    pub source: Option<String>,
}

impl Overlay {
    /// The points between two times.
    pub fn within(&self, first: f64, last: f64) -> (Vec<f64>, Vec<f64>) {
        let points = self.times.iter().zip(&self.values).filter(|(t, _)| (first..=last).contains(*t));
        points.map(|(t, y)| (*t, *y)).unzip()
    }
}

impl Facts {
    /// Number of axes in the rows of `contact.csv`: 3 in dimension 3, otherwise 2.
    pub fn contact_axes(&self) -> usize {
        self.dimension.max(2)
    }
}

/// The body of a side `body.side`.
pub fn body_of(side: &str) -> &str {
    side.split_once('.').map_or(side, |(body, _)| body)
}
