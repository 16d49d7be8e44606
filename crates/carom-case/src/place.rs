//! Placement of a body: x ↦ about + R(x − about) + shift, read from `place` and applied to the mesh
//! before anything else.

use carom_solid::Mesh;

use super::PlaceSpec;
use super::view::View;

/// Reads the table `place` of a body.
pub(super) fn read(v: &View, dimension: usize) -> Option<PlaceSpec> {
    let (rotate, axis) = match v.table.get("rotate") {
        Some(node) if node.table().is_some() => about_axis(&v.at("rotate")?)?,
        Some(node) => (node.number()?, Vec::new()),
        None => (0.0, Vec::new()),
    };
    if dimension == 1 && rotate != 0.0 {
        let (what, why) = ("a bar cannot be rotated", "the case has dimension = 1");
        return v.wrong("rotate", what, why, "leave it out, or use `shift` alone");
    }
    let [about, shift] = ["about", "shift"].map(|name| v.vector(name, dimension));
    Some(PlaceSpec { rotate, axis, about: about?, shift: shift? })
}

/// The angle and the unit axis of a rotation in space.
fn about_axis(v: &View) -> Option<(f64, Vec<f64>)> {
    let axis = v.numbers("axis")?;
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    if !(length > 0.0 && length.is_finite()) {
        let what = "the axis of the rotation has no direction";
        let why = "its components are all zero, or too large";
        let help = "give a direction, for example axis = [0.0, 0.0, 1.0]";
        return v.wrong("axis", what, why, help);
    }
    Some((v.number("angle")?, axis.iter().map(|x| x / length).collect()))
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

#[cfg(test)]
mod tests {
    use super::*;
    use carom_solid::{Element, generate};

    /// Arc nodes lie on the circle about the moved centre, and distances are unchanged.
    #[test]
    fn a_placed_disc_is_the_disc_elsewhere() {
        let made = generate::disc(Element::T10, 0.5, [1.0, 2.0], 0.2).unwrap();
        let mut mesh = made.clone();
        PlaceSpec { rotate: 30.0, axis: Vec::new(), about: vec![1.0, 0.0], shift: vec![-3.0, 0.25] }
            .apply(&mut mesh);
        let (s, c) = (0.5, 0.75_f64.sqrt());
        let center = [1.0 - 2.0 * s - 3.0, 2.0 * c + 0.25];
        for n in mesh.side_nodes("arc").unwrap() {
            let r = (mesh.nodes[n][0] - center[0]).hypot(mesh.nodes[n][1] - center[1]);
            assert!((r - 0.5).abs() < 1e-14);
        }
        let length =
            |m: &Mesh, a: usize| (m.nodes[a][0] - m.nodes[0][0]).hypot(m.nodes[a][1] - m.nodes[0][1]);
        assert!((1..made.nodes.len()).all(|a| (length(&made, a) - length(&mesh, a)).abs() < 1e-14));
    }

    #[test]
    fn right_angles_are_exact() {
        let made = generate::rectangle(Element::T3, [0.0, 0.0], [0.3, 0.1], [3, 1]).unwrap();
        for (rotate, ends) in
            [(90.0, [-0.1, 0.3]), (-180.0, [-0.3, -0.1]), (630.0, [0.1, -0.3]), (720.0, [0.3, 0.1])]
        {
            let mut mesh = made.clone();
            PlaceSpec { rotate, axis: Vec::new(), about: vec![0.0; 2], shift: vec![0.0; 2] }.apply(&mut mesh);
            assert!(mesh.nodes.iter().any(|x| x == ends), "{rotate}");
        }
    }
}
