//! Parallel projection of space onto the page.

use std::fmt::Write as _;

use super::skin::Place;
use crate::chart::write_text;
use crate::pen::{Point, polyline};
use crate::symbols::{direction, plus};

/// A direction of view; z points up on the page.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    /// Unit vectors to the right, up, and towards the eye.
    pub(crate) axes: [Place; 3],
}

/// Degrees by which the eye of the figures is turned from −y towards +x, and raised.
const TURNED: f64 = 35.0;
const RAISED: f64 = 25.0;

/// Directions of the light, from the upper left before the page, and the share of it that falls on
/// all facets.
const LIGHT: Place = [-0.32, 0.51, 0.8];
const AMBIENT: f64 = 0.7;

impl View {
    /// The view of the figures.
    pub(crate) fn axonometric() -> Self {
        let (sin_a, cos_a) = TURNED.to_radians().sin_cos();
        let (sin_b, cos_b) = RAISED.to_radians().sin_cos();
        Self {
            axes: [
                [cos_a, sin_a, 0.0],
                [-sin_a * sin_b, cos_a * sin_b, cos_b],
                [sin_a * cos_b, -cos_a * cos_b, sin_b],
            ],
        }
    }

    /// The view in words.
    pub(crate) fn words() -> String {
        format!("parallel projection, azimuth {TURNED}° from −y towards +x, elevation {RAISED}°")
    }

    /// Coordinates to the right, up, and towards the eye.
    pub(crate) fn of(&self, p: Place) -> Place {
        self.axes.map(|axis| dot(axis, p))
    }

    /// Coordinates to the right and up.
    pub(crate) fn on_page(&self, p: Place) -> Point {
        let [right, up, _] = self.of(p);
        [right, up]
    }

    /// Brightness of a triangle between 0 and 1 from its corners in view coordinates; none if it
    /// turns its back to the eye.
    pub(crate) fn brightness([a, b, c]: [Place; 3]) -> Option<f64> {
        let normal = cross(minus(b, a), minus(c, a));
        let length = length(normal);
        (normal[2] > 1e-9 * length)
            .then(|| AMBIENT + (1.0 - AMBIENT) * (dot(normal, LIGHT) / length).clamp(0.0, 1.0))
    }

    /// The axes x, y, z as arrows from a point of the page.
    pub(crate) fn triad(&self, out: &mut String, from: Point, length: f64) {
        for (d, name) in ["x", "y", "z"].into_iter().enumerate() {
            let to = [0, 1].map(|i| self.axes[i][d] * length);
            let to = [from[0] + to[0], from[1] - to[1]];
            let along = direction(from, to);
            // An axis along the line of sight.
            if along == [0.0; 2] {
                continue;
            }
            let neck = plus(to, -6.0, along);
            let [a, b] = [2.6, -2.6].map(|s| plus(neck, s, [-along[1], along[0]]));
            let shaft = polyline(&[from, neck]);
            let head = polyline(&[to, a, b]);
            let _ = writeln!(
                out,
                "<path d=\"{shaft}\" stroke=\"#222\" stroke-width=\"1.2\"/><path d=\"{head}z\" fill=\"#222\"/>"
            );
            let at = plus(to, 8.0, along);
            write_text(out, at[0], at[1] + 4.0, "text-anchor=\"middle\" font-style=\"italic\"", name);
        }
    }
}

pub(crate) fn dot(a: Place, b: Place) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn length(v: Place) -> f64 {
    dot(v, v).sqrt()
}

pub(crate) fn minus(a: Place, b: Place) -> Place {
    [0, 1, 2].map(|d| a[d] - b[d])
}

pub(crate) fn cross(a: Place, b: Place) -> Place {
    [0, 1, 2].map(|d| {
        let [i, j] = [(d + 1) % 3, (d + 2) % 3];
        a[i] * b[j] - a[j] * b[i]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_right_handed_and_orthonormal() {
        let [right, up, eye] = View::axonometric().axes;
        assert!(dot(minus(cross(right, up), eye), minus(cross(right, up), eye)) < 1e-28);
        assert!([right, up, eye].iter().all(|a| (dot(*a, *a) - 1.0).abs() < 1e-14));
        assert!((LIGHT.iter().map(|l| l * l).sum::<f64>() - 1.0).abs() < 0.01);
    }
}
