//! Which active pairs become rows of the linear system: a redundant row would make it singular, and its residual would not tell.
//!
//! A row counts where its gradient, less what other rows of the same secondary node already say (Gram–Schmidt), has length left on free dofs: a node on a
//! symmetry axis keeps both its support and its contact, a corner node in two contacts at one facet keeps one.

use carom_algebra::Vector;
use carom_contact::Pair;

use crate::model::Model;
use crate::workspace::Workspace;

/// Rows shorter than this (their gradient is of order one) say nothing about free dofs.
const SHORT_ROW: f64 = 1e-8;

/// Active pairs whose rows say something new about the free dofs: (contact, pair). Redundant ones would make the system singular.
pub(crate) fn independent_rows<const D: usize>(
    model: &Model<D>,
    pairs: &[Vec<Pair>],
    work: &Workspace<D>,
) -> Vec<(usize, usize)> {
    let mut rows: Vec<(usize, usize)> = Vec::new();
    // Orthonormal rows kept so far at each secondary node: only rows that share it can repeat each other.
    let mut kept: Vec<(usize, Vec<(usize, Vector<D>)>)> = Vec::new();
    for (k, contact) in model.contacts.iter().enumerate() {
        for (p, pair) in pairs[k].iter().enumerate().filter(|(_, pair)| pair.active) {
            let gap = &work.gaps[k][p];
            let mut row: Vec<(usize, Vector<D>)> = (0..gap.count)
                .map(|q| {
                    let held = |i: usize| model.fixed[gap.nodes[q] * D + i];
                    let free = Vector(std::array::from_fn(|i| if held(i) { 0.0 } else { gap.gradient[q][i] }));
                    (gap.nodes[q], free)
                })
                .collect();
            let node = contact.method.secondary()[pair.node];
            for (_, other) in kept.iter().filter(|(n, _)| *n == node) {
                let overlap: f64 = product(&row, other);
                for (m, v) in other {
                    match row.iter_mut().find(|(n, _)| n == m) {
                        Some((_, r)) => *r -= *v * overlap,
                        None => row.push((*m, *v * -overlap)),
                    }
                }
            }
            let length = product(&row, &row).sqrt();
            if length > SHORT_ROW {
                for (_, v) in &mut row {
                    *v = *v * length.recip();
                }
                kept.push((node, row));
                rows.push((k, p));
            }
        }
    }
    rows
}

fn product<const D: usize>(a: &[(usize, Vector<D>)], b: &[(usize, Vector<D>)]) -> f64 {
    a.iter().map(|(n, v)| b.iter().filter(|(m, _)| m == n).map(|(_, w)| v.dot(w)).sum::<f64>()).sum()
}
