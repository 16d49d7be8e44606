//! Points whose quantities become columns: interpolated in their cell; a stress at a node is the mean over its cells.
//!
//! A state is accepted when J > 0 at every quadrature point; in a corner of a badly bent cell it may still be ≤ 0, and the law has no stress
//! there. Such a cell is left out of the mean; where no cell is left the stress is NaN, and the log says when that begins. J itself is always
//! the mean over all cells, of whatever sign.

use carom_solid::Body;

use super::Model;
use crate::case::Quantity;
use crate::state::State;

/// A resolved probe.
#[derive(Clone, Debug)]
pub struct Probe {
    /// Name in the case.
    pub name: String,
    /// Body, by its place.
    pub part: usize,
    /// Cells and reference coordinates that meet at the point.
    pub places: Vec<(usize, Vec<f64>)>,
    /// What to record.
    pub record: Vec<Quantity>,
}

impl Probe {
    /// The recorded quantities in a state, in order; a stress is NaN where no cell at the point has one.
    pub fn values<const D: usize>(&self, model: &Model<D>, state: &State, out: &mut Vec<f64>) {
        let part = &model.parts[self.part];
        let range = part.nodes();
        let nodal = |field: &[f64], i: usize| {
            let (cell, xi) = &self.places[0];
            interpolated::<D>(&*part.body, *cell, xi, &field.as_chunks::<D>().0[range.clone()], i)
        };
        for quantity in &self.record {
            out.push(match quantity {
                Quantity::Ux => nodal(&state.y, 0) - nodal(&model.reference, 0),
                Quantity::Uy => nodal(&state.y, 1) - nodal(&model.reference, 1),
                Quantity::Vx => nodal(&state.v, 0),
                Quantity::Vy => nodal(&state.v, 1),
                Quantity::Ax => nodal(&state.a, 0),
                Quantity::Ay => nodal(&state.a, 1),
                stress => self.mean(part.body.as_ref(), &state.y.as_chunks::<D>().0[range.clone()], *stress),
            });
        }
    }

    /// Whether the stresses it records, if any, exist in a state.
    pub fn has_stress<const D: usize>(&self, model: &Model<D>, state: &State) -> bool {
        let part = &model.parts[self.part];
        let y = &state.y.as_chunks::<D>().0[part.nodes()];
        !self.record.iter().any(|q| is_stress(*q))
            || self.places.iter().any(|(c, xi)| part.body.point(*c, xi, y).is_ok())
    }

    fn mean<const D: usize>(&self, body: &dyn Body<D>, y: &[[f64; D]], quantity: Quantity) -> f64 {
        let (mut sum, mut count) = (0.0, 0);
        for (cell, xi) in &self.places {
            let point = body.point(*cell, xi, y);
            let value = match (quantity, &point) {
                (Quantity::DetF, Err(inverted)) => Some(inverted.det_f),
                (_, Err(_)) => None,
                (_, Ok(p)) => Some(match quantity {
                    Quantity::SigmaXx => p.cauchy[0][0],
                    Quantity::SigmaYy => p.cauchy[1][1],
                    Quantity::SigmaXy => p.cauchy[0][1],
                    Quantity::VonMises => von_mises(&p.cauchy),
                    _ => p.det_f,
                }),
            };
            if let Some(value) = value {
                sum += value;
                count += 1;
            }
        }
        // 0/0 is NaN.
        sum / f64::from(count)
    }
}

fn is_stress(quantity: Quantity) -> bool {
    matches!(quantity, Quantity::SigmaXx | Quantity::SigmaYy | Quantity::SigmaXy | Quantity::VonMises)
}

fn interpolated<const D: usize>(body: &dyn Body<D>, cell: usize, xi: &[f64], field: &[[f64; D]], i: usize) -> f64 {
    let nodes = body.mesh().cell(cell);
    let mut shape = [0.0; 20];
    body.shape(xi, &mut shape[..nodes.len()]);
    nodes.iter().zip(&shape).map(|(&n, s)| s * field[n][i]).sum()
}

/// √(3/2 s:s) with s the deviator.
pub(crate) fn von_mises(s: &[[f64; 3]; 3]) -> f64 {
    let mean = (s[0][0] + s[1][1] + s[2][2]) / 3.0;
    let mut square = 0.0;
    for i in 0..3 {
        for j in 0..3 {
            let deviator = s[i][j] - if i == j { mean } else { 0.0 };
            square += deviator * deviator;
        }
    }
    (1.5 * square).sqrt()
}

#[cfg(test)]
mod tests {
    use crate::Simulation;
    use crate::case::{Document, read};

    const SQUARE: &str = r#"
dimension = 2
material = [{ name = "rubber", law = "neo-hookean", density = 1.0, lambda = 2.0, mu = 1.5 }]
body = [{ name = "a", material = "rubber", element = "T6", mesh = { shape = "rectangle", min = [0, 0], max = [1, 1], cells = [1, 1] } }]
time = { end = 1.0, step = 1.0, scheme = { kind = "hu" } }
probe = [
  { name = "corner", at = [1, 0], body = "a", record = ["sigma_xx", "det_f", "ux"] },
  { name = "shared", at = [0, 0], body = "a", record = ["sigma_yy"] },
]
"#;

    /// An edge's middle node four fifths along it: dx/dξ is 4·0.8 − 3 > 0 at its start, 1 − 4·0.2 = −0.2 < 0 backwards from its end, and
    /// positive at every quadrature point.
    #[test]
    fn a_corner_turned_over_has_j_but_no_stress() {
        let document = Document::parse("square.toml", SQUARE, &[]).unwrap();
        let case = read(&document).unwrap_or_else(|p| panic!("{}", document.diagnose_all(&p)));
        let Simulation { model, mut state, .. } = Simulation::<2>::new(&case, 1).unwrap();
        let [corner, shared] = &model.probes[..] else { panic!() };
        assert!(corner.has_stress(&model, &state));
        let middle = model.reference.as_chunks::<2>().0.iter().position(|x| *x == [0.5, 0.0]).unwrap();
        state.y[2 * middle] = 0.8;
        assert!(model.min_det_f(&state.y) > 0.0);
        assert!(!corner.has_stress(&model, &state) && shared.has_stress(&model, &state));
        let mut values = Vec::new();
        corner.values(&model, &state, &mut values);
        assert!(values[0].is_nan() && (values[1] + 0.2).abs() < 1e-14 && values[2].abs() < 1e-14, "{values:?}");
        values.clear();
        shared.values(&model, &state, &mut values);
        assert!(values[0].is_finite());
    }
}
