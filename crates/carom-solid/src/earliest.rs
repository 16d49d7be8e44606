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
    queue: BinaryHeap<Entry<P>>,
    budget: usize,
}

impl<P: Piece> Earliest<P> {
    /// With a number of pieces examined before the search stops at the earliest one.
    pub fn new(budget: usize) -> Self {
        Self { queue: BinaryHeap::new(), budget }
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
        if !discarded(&whole) {
            self.queue.push(Entry(whole));
        }
        let mut examined = 0;
        while let Some(Entry(piece)) = self.queue.pop() {
            examined += 2;
            let Some(parts) = halves(&piece).filter(|_| examined <= self.budget) else {
                return Some(piece);
            };
            for part in parts {
                if !part.is_clear() && !discarded(&part) {
                    self.queue.push(Entry(part));
                }
            }
        }
        None
    }
}

/// In the order of the queue: earlier first, then smaller, which ends the search sooner.
#[derive(Clone, Debug)]
struct Entry<P>(P);

impl<P: Piece> Ord for Entry<P> {
    fn cmp(&self, other: &Self) -> Ordering {
        let (a, b) = (&self.0, &other.0);
        let earlier = b.theta().total_cmp(&a.theta());
        earlier.then(a.level().cmp(&b.level())).then(b.place().total_cmp(&a.place()))
    }
}

impl<P: Piece> PartialOrd for Entry<P> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<P: Piece> PartialEq for Entry<P> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl<P: Piece> Eq for Entry<P> {}
