//! The check that every cell is valid (J > 0) at the end of a step and on the straight paths of its
//! nodes in it, everywhere and not only at its quadrature points.
//!
//! A check of all cells also gives the distance that nodes may move, relative to their body, before
//! one of them can become invalid (`cell_margin` of [`Body`](carom_solid::Body)). Until a node has
//! moved so far, a step costs one pass over the positions. A result does not depend on when cells
//! were checked: within the margin, the check would succeed. What lies between two positions within
//! the margin is within it, too: it is convex. Paths are therefore examined only of cells whose
//! nodes left it.

use crate::cells;
use crate::model::{BodyInstance, Model};
use crate::rejected::Rejected;

/// Numbers per block of positions: a multiple of every dimension.
const BLOCK: usize = 6;

/// Cells whose paths a thread examines at once.
const SHARE: usize = 64;

/// Positions of the last check of each body. A cache.
#[derive(Debug, Default)]
pub struct ValidCells {
    checked: Vec<Checked>,
    /// Time of the positions to which paths were examined last.
    reached: Option<f64>,
}

/// A body that passed a check, and the distance that its nodes may move before it can fail.
#[derive(Debug, Default)]
pub(crate) struct Checked {
    y: Vec<f64>,
    margin: f64,
    /// Since paths were examined.
    is_new: bool,
}

impl Checked {
    /// At positions `y` of the body.
    pub(crate) fn set(&mut self, y: &[f64], margin: f64) {
        self.y.clear();
        self.y.extend_from_slice(y);
        (self.margin, self.is_new) = (margin, true);
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
    pub fn check(&mut self, model: &Model, y: &[f64]) -> Result<(), Rejected> {
        self.checked.resize_with(model.parts.len(), Checked::default);
        for (part, checked) in model.parts.iter().zip(&mut self.checked) {
            let now = part.of(y);
            let dimension = part.body.mesh().dimension();
            if checked.holds(now, dimension) {
                continue;
            }
            checked.margin = 0.0;
            checked.set(now, margin(model, part, now)?);
        }
        Ok(())
    }

    /// Checks the paths from the state at `start`, with positions `before`, to that at `end`, with
    /// positions `now`, which have passed [`Self::check`].
    ///
    /// # Errors
    /// The first cell that is not certified valid on the way.
    pub fn check_paths(
        &mut self,
        model: &Model,
        [start, end]: [f64; 2],
        [before, now]: [&[f64]; 2],
    ) -> Result<(), Rejected> {
        let known = self.reached == Some(start);
        self.reached = None;
        for (part, checked) in model.parts.iter().zip(&mut self.checked) {
            // Both are within the margin of the same positions.
            if known && !checked.is_new {
                continue;
            }
            let [before, now] = [before, now].map(|y| part.of(y));
            let dimension = part.body.mesh().dimension();
            if !checked.holds(before, dimension) {
                check_paths(model, part, before, now)?;
            }
            checked.is_new = false;
        }
        self.reached = Some(end);
        Ok(())
    }
}

/// Checks the paths of a body's cells.
fn check_paths(model: &Model, part: &BodyInstance, before: &[f64], now: &[f64]) -> Result<(), Rejected> {
    let body = &part.body;
    let d = part.body.mesh().dimension();
    let mut left = Vec::new();
    let compute = |first: usize, margins: &mut [f64], _: &mut [f64]| {
        body.cell_margins(first, now, margins).map(|()| None)
    };
    let add = |cell: usize, margin: &[f64]| {
        let nodes = body.mesh().cell(cell);
        let moved = |node: usize, i: usize| now[d * node + i] - before[d * node + i];
        let within = nodes
            .iter()
            .all(|&node| (0..d).all(|i| (moved(node, i) - moved(nodes[0], i)).abs() <= margin[0]));
        if !within {
            left.push(cell);
        }
    };
    let add = cells::added_one_by_one(1, add);
    cells::for_each(&model.threads, body.mesh().cell_count(), 1, compute, add)
        .map_err(|inverted| Rejected::Inverted { body: part.name.clone(), inverted })?;
    let mut lost = vec![None; left.len()];
    model.threads.for_each_block(&mut lost, SHARE, |first, lost| {
        let cells = left[first..].iter();
        lost.iter_mut()
            .zip(cells)
            .for_each(|(lost, cell)| *lost = body.cell_lost_between(*cell, before, now));
    });
    match left.into_iter().zip(lost).find_map(|(cell, lost)| Some((cell, lost?))) {
        Some((cell, theta)) => Err(Rejected::InvertedOnTheWay { body: part.name.clone(), cell, theta }),
        None => Ok(()),
    }
}

/// The smallest margin of a body's cells.
fn margin(model: &Model, part: &BodyInstance, y: &[f64]) -> Result<f64, Rejected> {
    let mut least = f64::INFINITY;
    let compute = |first: usize, margins: &mut [f64], _: &mut [f64]| {
        part.body.cell_margins(first, y, margins).map(|()| None)
    };
    let add = |_: usize, margins: &[f64]| least = margins.iter().fold(least, |least, m| least.min(*m));
    cells::for_each(&model.threads, part.body.mesh().cell_count(), 1, compute, add)
        .map_err(|inverted| Rejected::Inverted { body: part.name.clone(), inverted })?;
    Ok(least)
}

/// Whether no component has changed by more than `margin`, apart from the motion of the first node.
pub fn is_within(before: &[f64], now: &[f64], dimension: usize, margin: f64) -> bool {
    if before.len() != now.len() || margin == 0.0 {
        return false;
    }
    let mut common = [0.0; BLOCK];
    (0..BLOCK).for_each(|i| common[i] = now[i % dimension] - before[i % dimension]);
    let old = before.chunks(BLOCK);
    let new = now.chunks(BLOCK);
    let mut within = true;
    for (old, new) in old.zip(new) {
        for ((old, new), common) in old.iter().zip(new).zip(&common) {
            // A NaN is not within.
            within &= (new - old - common).abs() <= margin;
        }
    }
    within
}
