//! The steps at which fields are written. By default, about [`REGULAR`] frames are spread over the
//! run, and more are written while contact is closed. The choice is causal and depends on the case
//! and the states alone: any number of threads and a resumed run write the same frames.
//!
//! The shortest contact of elastic bodies lasts two crossings of a pressure wave, to the far side
//! of the thinner body and back. In contact the first frames are therefore so close that
//! `FIRST` of them fit into this time; the distance doubles whenever as many have been written,
//! until it is that of the regular frames.

use carom_case::Case;
use carom_mechanics::Simulation;
use serde::{Deserialize, Serialize};

use crate::waves::crossing;

/// Regular frames of a run, if it has that many steps.
pub const REGULAR: f64 = 80.0;
/// Fewest regular frames of a large model.
const FEWEST: f64 = 20.0;
/// Frames in contact between two doublings of their distance; more than the 20 that a page needs.
const FIRST: u32 = 24;
/// Doublings after which only regular frames are written.
const DOUBLINGS: u32 = 2;
/// Bytes of a node in a frame: 23 numbers.
const NODE: f64 = 184.0;
/// Bytes that the regular frames may take before there are fewer of them.
const BYTES: f64 = 2e9;

/// The steps at which the fields of a run are written.
pub struct Frames {
    /// Steps between regular frames; 0: none.
    pub every: u64,
    /// Steps of the requested times.
    pub at: Vec<u64>,
    /// Steps between the first frames in contact; none if the case says how often.
    pub in_contact: Option<u64>,
    /// The frames so far.
    pub written: Written,
}

/// The frames that were written, as far as the next ones depend on them.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Written {
    /// Step of the last one.
    last: u64,
    /// Number of those between the regular ones.
    in_contact: u32,
}

impl Frames {
    pub(super) fn new(case: &Case, simulation: &Simulation) -> Self {
        let at = case.output.at_times.iter().map(|time| simulation.grid().nearest(*time)).collect();
        let written = Written::default();
        if let Some(every) = case.output.fields_every {
            return Self { every: every as u64, at, in_contact: None, written };
        }
        let model = simulation.model();
        let affordable = BYTES / (NODE * model.mass.nodes() as f64);
        let frames = affordable.clamp(FEWEST, REGULAR);
        let every = (simulation.steps() as f64 / frames).round().max(1.0);
        let shortest = crossing(case, model).map(|time| 2.0 * time / case.time.step);
        let in_contact = shortest.map(|steps| (steps / f64::from(FIRST)).floor().max(1.0) as u64);
        Self { every: every as u64, at, in_contact, written }
    }

    /// Whether no fields are written at all.
    pub(super) fn is_empty(&self) -> bool {
        self.every == 0 && self.at.is_empty()
    }

    /// Whether the fields of a step are written; `last`: of the run.
    pub fn take(&mut self, step: u64, last: bool, in_contact: bool) -> bool {
        let regular = self.every > 0 && (step.is_multiple_of(self.every) || last) || self.at.contains(&step);
        let between = !regular && in_contact && self.is_due_in_contact(step);
        if regular || between {
            self.written.last = step;
        }
        self.written.in_contact += u32::from(between);
        regular || between
    }

    fn is_due_in_contact(&self, step: u64) -> bool {
        let doublings = self.written.in_contact / FIRST;
        let distance = self.in_contact.map(|steps| steps << doublings.min(DOUBLINGS));
        doublings <= DOUBLINGS
            && distance.is_some_and(|steps| steps < self.every && step - self.written.last >= steps)
    }
}
