//! Search for the earliest piece of a path that is neither discarded nor divisible, for pieces of
//! any kind: a queue in the order of θ.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// A piece of a path over a box of parameters.
pub trait Piece {
    /// The lower end of its interval of θ.
    fn theta(&self) -> f64;

    /// Times it was halved.
    fn level(&self) -> u32;

    /// A number that is different for pieces of equal θ and level: results must not depend on the
    /// heap's arrangement.
    fn place(&self) -> f64;

    /// Whether it certainly does not contain what is searched.
    fn is_clear(&self) -> bool;
}

/// The queue, kept between searches for its memory.
#[derive(Clone, Debug)]
pub struct Earliest<P> {
    queue: BinaryHeap<Entry>,
    /// The pieces that entries refer to: they are large, and the heap moves its entries.
    pieces: Vec<P>,
    /// Places of pieces that were taken from the queue.
    free: Vec<usize>,
    budget: usize,
}

impl<P: Piece + Clone> Earliest<P> {
    /// With a number of pieces examined before the search stops at the earliest one.
    pub fn new(budget: usize) -> Self {
        Self { queue: BinaryHeap::new(), pieces: Vec::new(), free: Vec::new(), budget }
    }

    /// The earliest piece of `whole`, which is not clear, that `discarded` does not reject and
    /// `halves` does not divide. Exhaustion of the budget is no reason to discard: the earliest
    /// piece is reported.
    pub fn first(
        &mut self,
        whole: P,
        discarded: impl Fn(&P) -> bool,
        halves: impl Fn(&P) -> Option<[P; 2]>,
    ) -> Option<P> {
        self.queue.clear();
        self.pieces.clear();
        self.free.clear();
        if !discarded(&whole) {
            self.push(whole);
        }
        let mut examined = 0;
        while let Some(Entry { at, .. }) = self.queue.pop() {
            examined += 2;
            let Some(parts) = halves(&self.pieces[at]).filter(|_| examined <= self.budget) else {
                return Some(self.pieces[at].clone());
            };
            self.free.push(at);
            for part in parts {
                if !part.is_clear() && !discarded(&part) {
                    self.push(part);
                }
            }
        }
        None
    }

    fn push(&mut self, piece: P) {
        let theta = piece.theta();
        let level = piece.level();
        let place = piece.place();
        let at = if let Some(at) = self.free.pop() {
            self.pieces[at] = piece;
            at
        } else {
            self.pieces.push(piece);
            self.pieces.len() - 1
        };
        self.queue.push(Entry { theta, level, place, at });
    }
}

/// In the order of the queue: earlier first, then smaller, which ends the search sooner.
#[derive(Clone, Debug)]
struct Entry {
    theta: f64,
    level: u32,
    place: f64,
    at: usize,
}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        let earlier = other.theta.total_cmp(&self.theta);
        earlier.then(self.level.cmp(&other.level)).then(other.place.total_cmp(&self.place))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Entry {}
