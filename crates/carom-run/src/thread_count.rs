//! How many threads compute a run. The result does not depend on it.

/// Number of threads of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThreadCount {
    /// This many.
    Exactly(usize),
    /// At most this many, and one for a model so small that to wake others takes longer than what
    /// they compute.
    UpTo(usize),
}

/// Unknowns below which two threads take longer than one (book, "Scaling").
const PAYS: usize = 4000;

impl ThreadCount {
    /// The number for a model.
    pub(crate) fn of(self, unknowns: usize) -> usize {
        match self {
            Self::UpTo(_) if unknowns < PAYS => 1,
            Self::Exactly(count) | Self::UpTo(count) => count,
        }
    }
}

impl From<usize> for ThreadCount {
    fn from(count: usize) -> Self {
        Self::Exactly(count)
    }
}
