//! A case while it is being read: the tables as `read` resolves them one by one, for `check` to
//! compare.

use std::collections::BTreeMap;

use super::{
    BodySpec, ContactSpec, ExpectSpec, LoadSpec, MaterialSpec, OverlaySpec, ProbeSpec, SupportSpec, TimeSpec,
};

/// The tables; `None` for one that could not be read.
pub(super) struct Draft {
    pub(super) dimension: Option<usize>,
    pub(super) materials: Vec<Option<MaterialSpec>>,
    pub(super) bodies: Vec<Option<BodySpec>>,
    pub(super) supports: Vec<Option<SupportSpec>>,
    pub(super) loads: Vec<Option<LoadSpec>>,
    pub(super) contacts: Vec<Option<ContactSpec>>,
    pub(super) probes: Vec<Option<ProbeSpec>>,
    pub(super) overlays: Vec<Option<OverlaySpec>>,
    pub(super) exact: BTreeMap<String, String>,
    pub(super) expects: Vec<Option<ExpectSpec>>,
    pub(super) time: Option<TimeSpec>,
}
