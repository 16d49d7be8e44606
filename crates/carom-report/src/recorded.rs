//! A run with its case as typed facts.

use std::ops::Deref;
use std::path::Path;

use carom_case::{Case, ObstacleMotion};
use carom_record::Run;

use crate::publish::ReportError;

/// A run, and the case that its manifest stores.
pub(crate) struct Recorded {
    run: Run,
    pub(crate) case: Case,
}

impl Deref for Recorded {
    type Target = Run;

    fn deref(&self) -> &Run {
        &self.run
    }
}

impl Recorded {
    /// Reads the record of a directory.
    pub(crate) fn open(directory: &Path) -> Result<Self, ReportError> {
        Self::new(Run::open(directory)?)
    }

    /// Reads the case of a record.
    pub(crate) fn new(run: Run) -> Result<Self, ReportError> {
        let case = Case::from_json(run.manifest.case.clone()).map_err(|source| {
            let version = run.manifest.version.clone();
            ReportError::Case { directory: run.directory.clone(), version, source }
        })?;
        Ok(Self { run, case })
    }

    /// Whether it has load steps in place of time steps.
    pub(crate) fn is_static(&self) -> bool {
        self.case.time.scheme.kind == "static"
    }

    /// Whether the scheme solves no linear system.
    pub(crate) fn is_explicit(&self) -> bool {
        self.case.time.scheme.kind == "central-difference"
    }

    /// Whether supports, loads or obstacles that move drive the bodies.
    pub(crate) fn is_driven(&self) -> bool {
        let is_moved = |motion: &ObstacleMotion| matches!(motion, ObstacleMotion::Prescribed { .. });
        self.case.supports.iter().any(|support| !support.moves.is_empty())
            || !self.case.loads.is_empty()
            || self.case.contacts.iter().any(|contact| is_moved(&contact.motion))
    }

    /// Whether there was contact at any time.
    pub(crate) fn has_contact(&self) -> bool {
        self.column("active").is_some_and(|column| column.iter().any(|count| *count > 0.0))
    }

    /// The sentence of a caption on stresses at nodes and probes where bodies yield.
    pub(crate) fn projected(&self) -> &'static str {
        if self.case.yielding().next().is_none() {
            return "";
        }
        " Stresses of bodies that yield are projected from the quadrature points, and may exceed the yield stress."
    }

    /// The unit of time; none of a load parameter.
    pub(crate) fn time_unit(&self) -> &str {
        if self.is_static() { "" } else { self.history.unit("time") }
    }
}
