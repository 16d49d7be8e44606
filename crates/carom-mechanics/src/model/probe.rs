//! Points whose quantities are recorded as columns, interpolated in their cell; a stress at a node
//! is the mean over its cells.
//!
//! A state is accepted if J > 0 at every quadrature point. In a corner of a strongly distorted cell
//! J may still be ≤ 0, where the law has no stress. Such a cell is excluded from the mean; without
//! any cell the stress is NaN, and the log reports when that begins. J itself is always the mean
//! over all cells, of either sign.

use carom_solid::{Body, Past};

use super::body_instance::BodyInstance;

/// Quantities of a probe; axes count from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Displacement along an axis.
    Displacement(usize),
    /// Velocity along an axis.
    Velocity(usize),
    /// Acceleration along an axis.
    Acceleration(usize),
    /// A component of the Cauchy stress.
    Stress(usize, usize),
    /// A component of the Green–Lagrange strain.
    Strain(usize, usize),
    /// The von Mises stress of the Cauchy stress.
    VonMises,
    /// Volume ratio J.
    DetF,
    /// Equivalent plastic strain.
    PlasticStrain,
    /// Share of the quadrature points that have yielded.
    Yielded,
}

/// A resolved probe.
#[derive(Clone, Debug)]
pub struct Probe {
    /// Name in the case.
    pub name: String,
    /// Index of its body.
    pub part: usize,
    /// Cells that contain the point, with its reference coordinates.
    pub places: Vec<(usize, Vec<f64>)>,
    /// Quantities to record.
    pub record: Vec<Quantity>,
}

impl Probe {
    /// The recorded quantities at positions, velocities and accelerations of all nodes, and the
    /// memory of all bodies, in order; a stress is NaN if no cell at the point has one.
    pub fn values(
        &self,
        parts: &[BodyInstance],
        reference: &[f64],
        motion: [&[f64]; 3],
        memory: &[f64],
        out: &mut Vec<f64>,
    ) {
        let past = past_of(parts, self.part, memory);
        let part = &parts[self.part];
        let [y, v, a] = motion;
        let nodal = |field: &[f64], i: usize| {
            let (cell, xi) = &self.places[0];
            interpolated(&*part.body, *cell, xi, part.of(field), i)
        };
        for quantity in &self.record {
            out.push(match quantity {
                Quantity::Displacement(i) => nodal(y, *i) - nodal(reference, *i),
                Quantity::Velocity(i) => nodal(v, *i),
                Quantity::Acceleration(i) => nodal(a, *i),
                // The mean of the values in cells would be the von Mises stress of no stress.
                Quantity::VonMises => {
                    let mean = |i, j| self.mean(&*part.body, part.of(y), &past, Quantity::Stress(i, j));
                    let mut stress = [[0.0; 3]; 3];
                    for i in 0..3 {
                        for j in i..3 {
                            stress[i][j] = mean(i, j);
                            stress[j][i] = stress[i][j];
                        }
                    }
                    von_mises(&stress)
                }
                other => self.mean(&*part.body, part.of(y), &past, *other),
            });
        }
    }

    /// Whether the stresses it records, if any, exist at given positions.
    pub fn has_stress(&self, parts: &[BodyInstance], y: &[f64], memory: &[f64]) -> bool {
        let past = past_of(parts, self.part, memory);
        let part = &parts[self.part];
        let y = part.of(y);
        !self.record.iter().any(|q| is_stress(*q))
            || self.places.iter().any(|(c, xi)| part.body.point(*c, xi, y, &past).is_ok())
    }

    fn mean(&self, body: &dyn Body, y: &[f64], past: &Past, quantity: Quantity) -> f64 {
        let mut sum = 0.0;
        let mut count = 0;
        for (cell, xi) in &self.places {
            let point = body.point(*cell, xi, y, past);
            let value = match (quantity, &point) {
                (Quantity::DetF, Err(inverted)) => Some(inverted.det_f),
                (_, Err(_)) => None,
                (_, Ok(p)) => Some(match quantity {
                    Quantity::Stress(i, j) => p.cauchy[i][j],
                    Quantity::Strain(i, j) => p.strain[i][j],
                    Quantity::PlasticStrain => p.plastic_strain,
                    Quantity::Yielded => p.yielded,
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

/// What a body remembers, of the memory of all bodies; empty if none remembers anything.
pub fn past_of<'a>(parts: &[BodyInstance], part: usize, memory: &'a [f64]) -> Past<'a> {
    let first: usize = parts[..part].iter().map(BodyInstance::memory).sum();
    let memory = memory.get(first..first + parts[part].memory()).unwrap_or(&[]);
    Past::new(memory, 0.0)
}

fn is_stress(quantity: Quantity) -> bool {
    matches!(quantity, Quantity::Stress(..) | Quantity::VonMises)
}

fn interpolated(body: &dyn Body, cell: usize, xi: &[f64], field: &[f64], i: usize) -> f64 {
    let nodes = body.mesh().cell(cell);
    let d = body.mesh().dimension();
    let mut shape = vec![0.0; nodes.len()];
    body.shape(xi, &mut shape);
    nodes.iter().zip(&shape).map(|(&n, s)| s * field[n * d + i]).sum()
}

/// √(3/2 s:s) with the deviator s.
pub fn von_mises(s: &[[f64; 3]; 3]) -> f64 {
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
