//! The check that every cell is valid (J > 0) at the end of a step, everywhere and not only at its
//! quadrature points.
//!
//! A check of all cells also gives the distance that nodes may move, relative to their body, before
//! one of them can become invalid ([`Body::cell_margin`](carom_solid::Body::cell_margin)). Until a
//! node has moved so far, a step costs one pass over the positions. A result does not depend on
//! when cells were checked: within the margin, the check would succeed.

use crate::cells;
use crate::model::{BodyInstance, Model};
use crate::rejected::Rejected;

/// Numbers per block of positions: a multiple of every dimension.
const BLOCK: usize = 6;

/// Positions of the last check of each body. A cache.
#[derive(Debug, Default)]
pub(crate) struct ValidCells {
    checked: Vec<Checked>,
}

/// A body that passed a check, and the distance that its nodes may move before it can fail.
#[derive(Debug, Default)]
pub(crate) struct Checked {
    y: Vec<f64>,
    margin: f64,
}

impl Checked {
    /// At positions `y` of the body.
    pub(crate) fn set(&mut self, y: &[f64], margin: f64) {
        self.y.clear();
        self.y.extend_from_slice(y);
        self.margin = margin;
    }

    /// Whether the body would pass at positions `now`.
    pub(crate) fn holds(&self, now: &[f64], dimension: usize) -> bool {
        is_within(&self.y, now, dimension, self.margin)
    }
}

impl ValidCells {
    /// Checks all bodies at positions `y`.
    ///
    /// # Errors
    /// The first cell that is not certified valid.
    pub(crate) fn check(&mut self, model: &Model, y: &[f64]) -> Result<(), Rejected> {
        self.checked.resize_with(model.parts.len(), Checked::default);
        for (part, checked) in model.parts.iter().zip(&mut self.checked) {
            let (now, dimension) = (part.of(y), part.body.mesh().dimension());
            if checked.holds(now, dimension) {
                continue;
            }
            checked.margin = 0.0;
            checked.set(now, margin(model, part, now)?);
        }
        Ok(())
    }
}

/// The smallest margin of a body's cells.
fn margin(model: &Model, part: &BodyInstance, y: &[f64]) -> Result<f64, Rejected> {
    let mut least = f64::INFINITY;
    let compute =
        |first: usize, margins: &mut [f64], _: &mut [f64]| part.body.cell_margins(first, y, margins);
    let add = |_: usize, margin: &[f64]| least = least.min(margin[0]);
    cells::for_each(&model.threads, part.body.mesh().cell_count(), 1, compute, add)
        .map_err(|inverted| Rejected::Inverted { body: part.name.clone(), inverted })?;
    Ok(least)
}

/// Whether no component has changed by more than `margin`, apart from the motion of the first node.
fn is_within(before: &[f64], now: &[f64], dimension: usize, margin: f64) -> bool {
    if before.len() != now.len() || margin == 0.0 {
        return false;
    }
    let mut common = [0.0; BLOCK];
    (0..BLOCK).for_each(|i| common[i] = now[i % dimension] - before[i % dimension]);
    let (old, new) = (before.chunks(BLOCK), now.chunks(BLOCK));
    let mut within = true;
    for (old, new) in old.zip(new) {
        for ((old, new), common) in old.iter().zip(new).zip(&common) {
            // A NaN is not within.
            within &= (new - old - common).abs() <= margin;
        }
    }
    within
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motion_of_the_whole_body_counts_as_none() {
        let before: Vec<f64> = (0..14).map(f64::from).collect();
        let mut now: Vec<f64> = before.iter().enumerate().map(|(i, x)| x + [8.0, -4.0][i % 2]).collect();
        assert!(is_within(&before, &now, 2, 1e-12));
        now[13] += 0.5;
        assert!(is_within(&before, &now, 2, 0.5) && !is_within(&before, &now, 2, 0.4));
        now[13] = f64::NAN;
        assert!(!is_within(&before, &now, 2, f64::INFINITY) && !is_within(&[], &now, 2, 1.0));
    }
}
