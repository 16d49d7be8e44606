//! The case as a whole, what concerns all of it, and where it starts from.

use std::collections::BTreeMap;
use std::path::PathBuf;

use carom_record::Expect as ExpectSpec;
use serde::{Deserialize, Serialize};

use super::body::{BodySpec, MaterialSpec};
use super::contact::ContactSpec;
use super::formula::FormulaSpec;
use super::load::{LoadSpec, SupportSpec};
use super::output::{OutputSpec, ProbeSpec};
use super::time::{NewtonSpec, TimeSpec};

/// One simulation, fully resolved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// Title for figures and pages.
    pub title: String,
    /// Space dimension: 1 or 2.
    pub dimension: usize,
    /// Plane strain or plane stress; dimension 2.
    pub plane: Plane,
    /// Out-of-plane thickness; in dimension 1 the area of the cross-section.
    pub thickness: f64,
    /// Labels for figures and columns; nothing is converted.
    pub units: Units,
    /// Set of defaults the case was resolved with.
    pub preset: Preset,
    /// Materials by name.
    pub materials: Vec<MaterialSpec>,
    /// Deformable bodies.
    pub bodies: Vec<BodySpec>,
    /// Sides held or moved.
    pub supports: Vec<SupportSpec>,
    /// Forces on sides and in bodies.
    #[serde(default)]
    pub loads: Vec<LoadSpec>,
    /// The run whose end is the start; none: the reference positions.
    #[serde(default)]
    pub initial: Option<InitialSpec>,
    /// The motion that loads, boundary and start are derived from: positions, formulas in X, Y, t.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub manufactured: Option<Vec<FormulaSpec>>,
    /// Contact pairs of sides.
    pub contacts: Vec<ContactSpec>,
    /// Time interval, step and scheme.
    pub time: TimeSpec,
    /// Newton's method.
    pub newton: NewtonSpec,
    /// Points whose quantities become columns.
    pub probes: Vec<ProbeSpec>,
    /// What is written, and when.
    pub output: OutputSpec,
    /// What columns should be, as formulas in t.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub exact: BTreeMap<String, String>,
    /// Expected values that make the case a test.
    pub expects: Vec<ExpectSpec>,
}

impl Case {
    /// A measure of the work it is, to put long runs before short ones: steps × nodes.
    pub fn work(&self) -> f64 {
        let nodes: f64 = self.bodies.iter().map(|body| body.mesh.estimate(body.element).1).sum();
        self.time.steps() as f64 * nodes
    }
}

/// Plane state of a two-dimensional body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Plane {
    /// No strain out of the plane.
    Strain,
    /// No stress out of the plane.
    Stress,
}

/// Labels of the units the case's numbers are in.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Units {
    /// Length, `m` by default.
    pub length: String,
    /// Time, `s` by default.
    pub time: String,
    /// Mass, `kg` by default.
    pub mass: String,
}

/// Which column of the table of defaults a case starts from (explicit keys win).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// Carom's defaults.
    Default,
    /// The paper as printed, where a switch exists for it.
    Paper,
}

/// A start from the end of another run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct InitialSpec {
    /// Absolute path of its directory.
    pub from: PathBuf,
    /// Whether its velocities are taken over.
    pub velocities: Velocities,
}

/// What becomes of the velocities of the run a case starts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Velocities {
    /// They are taken over.
    Keep,
    /// All bodies begin at rest.
    Zero,
}
