//! Ties of explicit steps. With a lumped mass, accelerations a = M⁻¹f that points and their
//! carriers share follow from a correction,
//!
//! ```text
//! a := a − M⁻¹Gᵀ (G M⁻¹Gᵀ)⁻¹ G a,   G a = a_P − Σ w_a a_a   of each point P
//! ```
//!
//! whose matrix is constant and sparse: points are coupled where they have a carrier in common. It
//! is factored once; groups of ties that share no node are independent blocks of it.

use std::collections::BTreeMap;
use std::sync::Arc;

use carom_algebra::{Condensed, Elimination, LinearError, Pattern, Precision};

use crate::model::Model;

/// The factor of G M⁻¹Gᵀ, and buffers of its solves.
pub(crate) struct TiedMass {
    factor: Condensed,
    gaps: Vec<f64>,
    forces: Vec<f64>,
    inner: Vec<f64>,
}

impl std::fmt::Debug for TiedMass {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("TiedMass").field("size", &self.gaps.len()).finish_non_exhaustive()
    }
}

impl TiedMass {
    /// For the points of a model with these 1/m, zero at constrained dofs; none without points.
    ///
    /// # Errors
    /// If a point and all that carries it are constrained, or have no mass.
    pub(crate) fn new(model: &Model, inverse_mass: &[f64]) -> Result<Option<Self>, LinearError> {
        if model.points.is_empty() {
            return Ok(None);
        }
        let d = model.dimension;
        // The points of each carrier, with their weights.
        let mut carried: BTreeMap<usize, Vec<(usize, f64)>> = BTreeMap::new();
        let mut count = 0;
        for (p, point) in model.points.iter().enumerate() {
            carried.entry(point.node).or_default().push((p, 1.0));
            for &(carrier, weight) in &point.weights {
                carried.entry(carrier).or_default().push((p, -weight));
            }
            count += 1;
        }
        let coupled = |visit: &mut dyn FnMut(usize, usize, f64)| {
            for (node, points) in &carried {
                for &(p, of_p) in points {
                    for &(q, of_q) in points.iter().filter(|(q, _)| *q <= p) {
                        for axis in 0..d {
                            visit(p * d + axis, q * d + axis, of_p * of_q * inverse_mass[node * d + axis]);
                        }
                    }
                }
            }
        };
        let mut entries = Vec::new();
        coupled(&mut |row, column, _| entries.push((row, column)));
        let pattern = Pattern::from_entries(count * d, entries);
        let mut values = vec![0.0; pattern.len()];
        coupled(&mut |row, column, value| {
            if let Some(slot) = pattern.slot(row, column) {
                values[slot] += value;
            }
        });
        // Where supports hold a point and its carriers nothing is left to correct.
        for unknown in 0..count * d {
            let slot = pattern.starts[unknown];
            if values[slot] == 0.0 {
                values[slot] = 1.0;
            }
        }
        let groups: Vec<usize> = (0..count * d).map(|unknown| unknown / d).collect();
        let elimination = Arc::new(Elimination::new(&pattern, &groups, &[])?);
        let mut factor = Condensed::new(&elimination, Precision::Double).on(&model.threads);
        factor.factor(|k| values[k])?;
        Ok(Some(Self { factor, gaps: vec![0.0; count * d], forces: vec![0.0; count * d], inner: Vec::new() }))
    }

    /// Corrects accelerations, or velocities after impulses, M⁻¹f of forces f.
    pub(crate) fn correct(&mut self, model: &Model, inverse_mass: &[f64], a: &mut [f64]) {
        let d = model.dimension;
        for (point, gaps) in model.points.iter().zip(self.gaps.chunks_exact_mut(d)) {
            for (axis, gap) in gaps.iter_mut().enumerate() {
                let carried = point.weights.iter().map(|(node, weight)| weight * a[node * d + axis]);
                *gap = a[point.node * d + axis] - carried.sum::<f64>();
            }
        }
        self.factor.eliminate_into(&self.gaps, &mut self.inner);
        self.factor.substitute_into(&mut self.inner, &mut self.forces);
        for (point, forces) in model.points.iter().zip(self.forces.chunks_exact(d)) {
            for (axis, force) in forces.iter().enumerate() {
                for &(node, weight) in &point.weights {
                    let dof = node * d + axis;
                    a[dof] += inverse_mass[dof] * weight * force;
                }
            }
        }
        model.points.carry(a);
    }
}
