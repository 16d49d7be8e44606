//! Points whose quantities become columns: interpolated in their cell; a stress at a node is the mean over its cells.

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
    /// The recorded quantities in a state, in order; NaN where the cell is inverted (never in an accepted state).
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

    fn mean<const D: usize>(&self, body: &dyn Body<D>, y: &[[f64; D]], quantity: Quantity) -> f64 {
        let mut sum = 0.0;
        for (cell, xi) in &self.places {
            sum += body.point(*cell, xi, y).map_or(f64::NAN, |p| {
                let s = &p.cauchy;
                match quantity {
                    Quantity::SigmaXx => s[0][0],
                    Quantity::SigmaYy => s[1][1],
                    Quantity::SigmaXy => s[0][1],
                    Quantity::VonMises => von_mises(s),
                    _ => p.det_f,
                }
            });
        }
        sum / self.places.len() as f64
    }
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
