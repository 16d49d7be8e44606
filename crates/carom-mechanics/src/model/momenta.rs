//! Momenta and centres of a model, in one pass over its nodes.

use super::{BodyInstance, Model};

/// Momentum of all bodies, and their moment of momentum about the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Momenta {
    /// Σ p, with zeros for directions that the model does not have.
    pub linear: [f64; 3],
    /// Σ y × p; in the plane the last component alone.
    pub angular: [f64; 3],
}

impl Model {
    /// Momenta at positions and velocities.
    pub fn momenta(&self, y: &[f64], v: &[f64]) -> Momenta {
        let mut momentum = vec![0.0; v.len()];
        self.mass.multiply_into(v, &mut momentum);
        match self.dimension {
            2 => momenta::<2>(y, &momentum),
            3 => momenta::<3>(y, &momentum),
            _ => Momenta { linear: [weighted::<1>(&momentum, |_| 1.0)[0], 0.0, 0.0], angular: [0.0; 3] },
        }
    }

    /// Mean of a field over the nodes of a body, with a weight for each node of the model.
    pub fn mean(&self, part: &BodyInstance, weights: &[f64], field: &[f64]) -> [f64; 3] {
        let weights = &weights[part.nodes()];
        let field = part.of(field);
        let mut mean = [0.0; 3];
        match self.dimension {
            1 => mean[..1].copy_from_slice(&weighted::<1>(field, |node| weights[node])),
            2 => mean[..2].copy_from_slice(&weighted::<2>(field, |node| weights[node])),
            _ => mean = weighted::<3>(field, |node| weights[node]),
        }
        mean
    }
}

/// Σ w x over nodes, each component in the order of the nodes.
fn weighted<const D: usize>(field: &[f64], weight: impl Fn(usize) -> f64) -> [f64; D] {
    // The sum of no numbers is −0.
    let mut sum = [-0.0; D];
    for (node, x) in field.as_chunks::<D>().0.iter().enumerate() {
        for i in 0..D {
            sum[i] += weight(node) * x[i];
        }
    }
    sum
}

fn momenta<const D: usize>(y: &[f64], momentum: &[f64]) -> Momenta {
    let mut linear = [-0.0; D];
    let mut angular = [-0.0; 3];
    for (y, p) in y.as_chunks::<D>().0.iter().zip(momentum.as_chunks::<D>().0) {
        for i in 0..D {
            linear[i] += p[i];
        }
        for i in if D == 2 { 2..3 } else { 0..3 } {
            let j = (i + 1) % 3;
            let k = (i + 2) % 3;
            angular[i] += y[j] * p[k] - y[k] * p[j];
        }
    }
    Momenta { linear: std::array::from_fn(|i| if i < D { linear[i] } else { 0.0 }), angular }
}
