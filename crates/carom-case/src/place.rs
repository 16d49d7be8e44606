//! Placement of a body: x ↦ about + R(x − about) + shift, read from `place` and applied to the mesh
//! before anything else.

use carom_solid::Mesh;
use serde::{Deserialize, Serialize};

use super::keys::Kind::{self, Vector};
use super::keys::{Keys, Node, View};

/// A rigid motion of a mesh: x ↦ about + R(rotate)(x − about) + shift.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlaceSpec {
    /// Angle in degrees, counter-clockwise; 0 in dimension 1.
    pub rotate: f64,
    /// Unit axis of the rotation, in dimension 3; empty if there is none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub axis: Vec<f64>,
    /// Centre of rotation.
    pub about: Vec<f64>,
    /// Translation.
    pub shift: Vec<f64>,
}

/// Rotation, then translation of a mesh, built in or from a file.
#[derive(Keys)]
#[keys(name = "place")]
pub(crate) struct PlaceKeys {
    /// Angle of rotation, counter-clockwise, in dimension 2; the table of axis and angle in
    /// dimension 3. Default: none.
    #[key(Kind::Rotation(&Rotation::TABLE), unit = "degrees", optional = "30.0", with = rotation)]
    rotate: Rotation,
    /// Centre of rotation. Default: the origin.
    #[key(Vector, unit = "length", example = "[0.0, 0.0]")]
    about: Option<Vec<f64>>,
    /// Translation. Default: zero.
    #[key(Vector, unit = "length", example = "[0.0, 1.0]")]
    shift: Option<Vec<f64>>,
}

/// A rotation in space.
#[derive(Default, Keys)]
#[keys(name = "rotate")]
struct Rotation {
    /// Direction of the axis, of any length.
    #[key(Vector, example = "[0.0, 0.0, 1.0]")]
    axis: Vec<f64>,
    /// Angle, right-handed about the axis.
    #[key(unit = "degrees", example = "30.0")]
    angle: f64,
}

/// The angle, and in space the unit axis of the rotation.
fn rotation(v: &View) -> Option<Rotation> {
    let given = v.table.get("rotate");
    if given.is_none_or(|node| node.table().is_none()) {
        return Some(Rotation { axis: Vec::new(), angle: given.map_or(Some(0.0), Node::number)? });
    }
    let Rotation { axis, angle } = v.get("rotate")?;
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    if !(length > 0.0 && length.is_finite()) {
        let what = "the axis of the rotation has no direction";
        let why = "its components are all zero, or too large";
        let help = "give a direction, for example axis = [0.0, 0.0, 1.0]";
        return v.at("rotate")?.wrong("axis", what, why, help);
    }
    Some(Rotation { axis: axis.iter().map(|x| x / length).collect(), angle })
}

/// Reads the placement of a body, if it has one.
pub(super) fn read(body: &View) -> Option<PlaceSpec> {
    let v = body.at("place").filter(|_| body.has("place"))?;
    let place = PlaceKeys::read(&v)?;
    let Rotation { axis, angle: rotate } = place.rotate;
    if v.dimension == Some(1) && rotate != 0.0 {
        let why = "the case has dimension = 1";
        return v.wrong("rotate", "a bar cannot be rotated", why, "leave it out, or use `shift` alone");
    }
    let zero = vec![0.0; v.dimension?];
    let about = place.about.unwrap_or_else(|| zero.clone());
    Some(PlaceSpec { rotate, axis, about, shift: place.shift.unwrap_or(zero) })
}

impl PlaceSpec {
    /// Moves the nodes of a mesh.
    pub fn apply(&self, mesh: &mut Mesh) {
        let (sin, cos) = sine_and_cosine(self.rotate);
        for x in &mut mesh.nodes {
            let mut rotated: Vec<f64> = x.iter().zip(&self.about).map(|(x, about)| x - about).collect();
            match (&rotated[..], &self.axis[..]) {
                (&[a, b], _) => rotated = vec![cos * a - sin * b, sin * a + cos * b],
                // Rodrigues' formula: a cos + n × a sin + n (n·a)(1 − cos).
                (&[a, b, c], &[l, m, n]) => {
                    let along = (l * a + m * b + n * c) * (1.0 - cos);
                    rotated = vec![
                        a * cos + (m * c - n * b) * sin + l * along,
                        b * cos + (n * a - l * c) * sin + m * along,
                        c * cos + (l * b - m * a) * sin + n * along,
                    ];
                }
                _ => {}
            }
            for i in 0..x.len() {
                // Without a rotation, (x − about) + about would add round-off.
                let at = if self.rotate == 0.0 { x[i] } else { self.about[i] + rotated[i] };
                x[i] = at + self.shift[i];
            }
        }
    }
}

/// Sine and cosine of an angle in degrees; exact at multiples of 90°.
fn sine_and_cosine(degrees: f64) -> (f64, f64) {
    let turn = degrees.rem_euclid(360.0);
    match turn {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => turn.to_radians().sin_cos(),
    }
}
