//! What happened between two grid times, for the log.

use std::collections::BTreeSet;

use carom_contact::PairEvent;

use crate::check::overlapping::Overlap;
use crate::check::penetration::Depths;
use crate::rejected::Rejected;
use crate::stepper::StepReport;

/// An event for the log.
#[derive(Clone, Debug, PartialEq)]
pub enum LogEvent {
    /// A step was rejected and will be bisected.
    Rejected {
        /// Time at its start.
        time: f64,
        /// Step size.
        dt: f64,
        /// Reason.
        rejected: Rejected,
    },
    /// No load step converges from a start that lacks balance, and what is lacking fades.
    Faded {
        /// Time at the start.
        time: f64,
        /// Time until which it fades.
        end: f64,
    },
    /// The run would have stopped, and the fallback takes the grid step.
    Fallback {
        /// Time at its start.
        time: f64,
        /// Its length.
        dt: f64,
        /// Why the run would have stopped.
        reason: String,
    },
    /// A secondary node came into contact or left it.
    ActiveSet {
        /// Time at the end of the (sub)step.
        time: f64,
        /// Index of the contact.
        contact: usize,
        /// Global node.
        node: usize,
        /// Whether it came (true) or left.
        active: bool,
        /// When it first met the other side, if that is known.
        met: Option<f64>,
    },
    /// A pair changed its facet or slid off the end.
    Pair {
        /// Time at the end of the (sub)step.
        time: f64,
        /// Index of the contact.
        contact: usize,
        /// The event.
        event: PairEvent,
    },
    /// Bodies overlap without a contact, one crosses itself, or the sides of a contact penetrate
    /// each other deeply, for the first time.
    Overlap {
        /// Time.
        time: f64,
        /// What overlaps.
        overlap: Overlap,
    },
    /// Stick and slip of the contacts are not unique.
    Ambiguous {
        /// Time at the end of the (sub)step.
        time: f64,
        /// The smallest relative singular value of the interface, with the sign of its determinant.
        regularity: f64,
    },
    /// The equilibrium of a load step is unstable.
    Unstable {
        /// Time at the end of the (sub)step.
        time: f64,
    },
    /// Closed gaps depend on others, or supports and ties keep them closed.
    Dependent {
        /// Time at the end of the (sub)step.
        time: f64,
        /// Contact and node of each of them.
        gaps: Vec<(usize, usize)>,
    },
    /// Velocities were projected where contact or stick began.
    Projection {
        /// Time.
        time: f64,
        /// Jump of kinetic energy.
        jump: f64,
    },
    /// An explicit step with another length was begun in contact: the half step of the contact
    /// force that precedes it has another length, too.
    Begun {
        /// Time.
        time: f64,
        /// Jump of kinetic energy.
        jump: f64,
    },
    /// Velocities of nodes that left contact were changed by its restitution.
    Restitution {
        /// Time.
        time: f64,
        /// Jump of kinetic energy.
        jump: f64,
    },
}

/// Events between two grid times.
#[derive(Clone, Debug, Default)]
pub struct GridReport {
    /// Newton iterations of the accepted steps.
    pub newton: u32,
    /// Rejected steps.
    pub rejected: u32,
    /// Grid steps that the fallback took.
    pub fallbacks: u32,
    /// Nodes that came into contact.
    pub activations: u32,
    /// Nodes that left contact.
    pub releases: u32,
    /// Largest penetration at the ends of its steps.
    pub penetration: Depths,
    /// Contacts of which a node was then too deep to be trusted.
    pub doubtful: BTreeSet<usize>,
    /// Whether velocities were projected at the end of a stage within a step.
    pub projected_within: bool,
    /// Events in order.
    pub events: Vec<LogEvent>,
}

impl GridReport {
    /// Adds an accepted step that ended at a time.
    pub(crate) fn add(&mut self, time: f64, step: StepReport) {
        self.newton += step.newton;
        self.activations += step.activations.len() as u32;
        self.releases += step.releases.len() as u32;
        self.penetration = self.penetration.max(step.penetration);
        self.doubtful.extend(step.doubtful);
        self.projected_within |= step.projected_within;
        let met = step.meetings.into_iter().chain(std::iter::repeat(None));
        for ((contact, node), met) in step.activations.into_iter().zip(met) {
            self.events.push(LogEvent::ActiveSet { time, contact, node, active: true, met });
        }
        for (contact, node) in step.releases {
            self.events.push(LogEvent::ActiveSet { time, contact, node, active: false, met: None });
        }
        let pairs = step.events.into_iter();
        self.events.extend(pairs.map(|(contact, event)| LogEvent::Pair { time, contact, event }));
        if let Some(regularity) = step.ambiguity {
            self.events.push(LogEvent::Ambiguous { time, regularity });
        }
        if step.unstable {
            self.events.push(LogEvent::Unstable { time });
        }
        if !step.dependent.is_empty() {
            let mut gaps = step.dependent;
            gaps.sort_unstable();
            gaps.dedup();
            self.events.push(LogEvent::Dependent { time, gaps });
        }
        if step.projection != 0.0 {
            self.events.push(LogEvent::Projection { time, jump: step.projection });
        }
        if step.begun != 0.0 {
            self.events.push(LogEvent::Begun { time, jump: step.begun });
        }
        if step.restitution != 0.0 {
            self.events.push(LogEvent::Restitution { time, jump: step.restitution });
        }
    }

    pub(crate) fn reject(&mut self, time: f64, dt: f64, rejected: Rejected) {
        self.rejected += 1;
        self.events.push(LogEvent::Rejected { time, dt, rejected });
    }

    /// The fallback takes a grid step of length `dt`.
    pub(crate) fn fall_back(&mut self, time: f64, dt: f64, reason: String) {
        self.fallbacks += 1;
        self.events.push(LogEvent::Fallback { time, dt, reason });
    }

    /// Forgets the steps since an earlier report, but not the work on them.
    pub(crate) fn return_to(&mut self, earlier: Self) {
        let newton = self.newton;
        let rejected = self.rejected;
        let later = self.events.split_off(earlier.events.len());
        *self = Self { newton, rejected, ..earlier };
        let rejections = |event: &LogEvent| matches!(event, LogEvent::Rejected { .. });
        self.events.extend(later.into_iter().filter(rejections));
    }
}

/// A rejected attempt at a step, for those who watch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attempt {
    /// Time at its start.
    pub time: f64,
    /// Its step size.
    pub dt: f64,
    /// Rejected attempts since the last grid time.
    pub rejected: u32,
}
