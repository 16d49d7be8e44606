//! A case half read: what `read` makes of the tables and `check` holds against each other.

use std::collections::BTreeMap;

use super::{BodySpec, ContactSpec, ExpectSpec, LoadSpec, MaterialSpec, ProbeSpec, SupportSpec, TimeSpec};

/// Tables read so far: `None` where one of them could not be.
pub(super) struct Draft {
    pub(super) dimension: Option<usize>,
    pub(super) materials: Vec<Option<MaterialSpec>>,
    pub(super) bodies: Vec<Option<BodySpec>>,
    pub(super) supports: Vec<Option<SupportSpec>>,
    pub(super) loads: Vec<Option<LoadSpec>>,
    pub(super) contacts: Vec<Option<ContactSpec>>,
    pub(super) probes: Vec<Option<ProbeSpec>>,
    pub(super) exact: BTreeMap<String, String>,
    pub(super) expects: Vec<Option<ExpectSpec>>,
    pub(super) time: Option<TimeSpec>,
}
