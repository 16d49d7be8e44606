//! Properties of a case that metrics, expectations and studies depend on.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::ContactColumns;
use crate::expect::Expect;

/// Properties of a case, filled in by whoever resolves the case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Facts {
    /// Title of the case.
    pub title: String,
    /// Space dimension: 1, 2 or 3.
    pub dimension: usize,
    /// Whether the case has load steps instead of time steps.
    pub is_static: bool,
    /// Computations of a step of its scheme.
    #[serde(default)]
    pub stepping: Stepping,
    /// End time.
    pub end: f64,
    /// Factor by which all meshes were refined.
    pub refine: f64,
    /// Contacts.
    pub contacts: Vec<ContactFacts>,
    /// Names of bodies that ties join to another body.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tied: Vec<String>,
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
#[allow(clippy::struct_excessive_bools)] // Each is a fact of the case, independent of the others.
pub struct ContactFacts {
    /// Name of the contact; it is also in the names of the columns of a moving obstacle.
    pub name: String,
    /// Secondary side, `body.side`.
    pub secondary: String,
    /// Primary side, `body.side`; none if the other party is an obstacle.
    pub primary: Option<String>,
    /// Whether the obstacle moves.
    pub moves: bool,
    /// Rotation of the obstacle; none if it does not turn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turns: Option<Turns>,
    /// Whether contact is enforced by a penalty.
    pub is_penalty: bool,
    /// Whether velocities are projected where contact begins.
    pub projects: bool,
    /// Whether the contact is a mortar, which has a pressure field.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_mortar: bool,
}

/// Rotation of a rigid obstacle about the point whose position and velocity are in the history.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Turns {
    /// Angle in degrees as a formula in t.
    pub angle: String,
    /// Direction of the axis.
    pub axis: [f64; 3],
}

/// An axis along which a support holds a body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Held {
    /// Name of the body.
    pub body: String,
    /// Number of the axis; none for the direction across a side where only the case is known.
    pub axis: Option<usize>,
    /// Displacement as a formula in X, Y, Z and t; none where it is constant.
    pub displacement: Option<String>,
}

/// Measured data, in the units of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Overlay {
    /// Name of the data in figures and metrics.
    pub name: String,
    /// Column of the history that the data belong to.
    pub column: String,
    /// Times of the data.
    pub times: Vec<f64>,
    /// Values of the data.
    pub values: Vec<f64>,
    /// Where the data come from.
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
    /// The columns of `contact.csv`.
    pub fn contact_columns(&self) -> ContactColumns {
        ContactColumns {
            axes: self.dimension.max(2),
            has_field: self.contacts.iter().any(|contact| contact.is_mortar),
        }
    }
}

/// The body of a side `body.side`.
pub fn body_of(side: &str) -> &str {
    side.split_once('.').map_or(side, |(body, _)| body)
}

/// Computations of a step of a scheme, by which its cost differs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stepping {
    /// Equilibrium at an instant, by Newton's method.
    #[default]
    Implicit,
    /// Equilibrium with a discrete gradient, by Newton's method.
    EnergyMomentum,
    /// Accelerations from forces.
    Explicit,
}
