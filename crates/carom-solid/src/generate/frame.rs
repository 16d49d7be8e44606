//! The place of a shape with an axis: an origin and three directions, the third along the axis.

use carom_algebra::Vector;

use super::MeshError;
use crate::triangles::cross;

/// An origin and an orthonormal, right-handed basis.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    origin: [f64; 3],
    axes: [[f64; 3]; 3],
    /// The coordinates along the axes, if they are those of the space in cyclic order.
    coordinates: Option<[usize; 3]>,
}

impl Frame {
    /// With the third direction along `axis`, of any length. Along a coordinate the others follow
    /// it in cyclic order.
    ///
    /// # Errors
    /// If the axis is zero, or a number is not finite.
    pub fn along(axis: [f64; 3], origin: [f64; 3]) -> Result<Self, MeshError> {
        let length = Vector(axis).norm();
        if !(length.is_finite() && length > 0.0 && origin.iter().all(|x| x.is_finite())) {
            return Err(MeshError::Axis { axis, origin });
        }
        let up = axis.map(|x| x / length);
        let unit = |i: usize| std::array::from_fn(|j| f64::from(u8::from(i == j)));
        if let Some(z) = (0..3).find(|&i| up == unit(i)) {
            let coordinates = [(z + 1) % 3, (z + 2) % 3, z];
            return Ok(Self { origin, axes: coordinates.map(unit), coordinates: Some(coordinates) });
        }
        let least = (0..3).min_by(|&a, &b| up[a].abs().total_cmp(&up[b].abs())).unwrap_or_default();
        let across = cross(unit(least), up);
        let across = across.map(|x| x / Vector(across).norm());
        Ok(Self { origin, axes: [across, cross(up, across), up], coordinates: None })
    }

    /// The point with these coordinates in the frame.
    pub(super) fn place(&self, local: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| {
            let [a, b, c] = [0, 1, 2].map(|j| local[j] * self.axes[j][i]);
            self.origin[i] + (a + b + c)
        })
    }

    /// Directions of the frame across which planes of symmetry cut, from those along x, y, z.
    ///
    /// # Errors
    /// If there are any, and the axis is not along a coordinate.
    pub fn cuts(&self, symmetry: [bool; 3]) -> Result<[bool; 3], MeshError> {
        match self.coordinates {
            Some(coordinates) => Ok(coordinates.map(|i| symmetry[i])),
            None if symmetry.contains(&true) => Err(MeshError::Oblique { axis: self.axes[2] }),
            None => Ok([false; 3]),
        }
    }

    /// Name of the plane of symmetry across a direction of the frame.
    pub(super) fn plane(&self, direction: usize) -> String {
        let coordinate = self.coordinates.map_or(direction, |coordinates| coordinates[direction]);
        format!("plane_{}", ["x", "y", "z"][coordinate])
    }
}
