//! The case as a whole: its tables, units, preset and initial state.

use std::collections::BTreeMap;
use std::path::PathBuf;

use carom_formula::Functions;
use carom_record::Expect as ExpectSpec;
use serde::{Deserialize, Serialize};

use super::body::{BodySpec, MaterialSpec, Plane};
use super::contact::ContactSpec;
use super::formula::FormulaSpec;
use super::load::{LoadSpec, SupportSpec};
use super::output::{OutputSpec, OverlaySpec, ProbeSpec};
use super::tie::TieSpec;
use super::time::{NewtonSpec, TimeSpec};
use crate::keys::Keys;

fn unrefined() -> f64 {
    1.0
}

/// A simulation, fully resolved: all defaults are filled in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// Title for figures and pages.
    pub title: String,
    /// Space dimension: 1, 2 or 3.
    pub dimension: usize,
    /// Plane strain or plane stress; dimension 2.
    pub plane: Plane,
    /// Out-of-plane thickness; in dimension 1 the area of the cross-section.
    pub thickness: f64,
    /// Factor by which all meshes were refined.
    #[serde(default = "unrefined")]
    pub refine: f64,
    /// Unit labels in figures and columns; values are not converted.
    pub units: Units,
    /// Set of default values that the case was resolved with.
    pub preset: Preset,
    /// Materials by name.
    pub materials: Vec<MaterialSpec>,
    /// Deformable bodies.
    pub bodies: Vec<BodySpec>,
    /// Sides fixed or moved.
    pub supports: Vec<SupportSpec>,
    /// Forces on sides and in bodies.
    #[serde(default)]
    pub loads: Vec<LoadSpec>,
    /// The run whose final state is the initial state; none: the reference positions.
    #[serde(default)]
    pub initial: Option<InitialSpec>,
    /// Manufactured solution, from which load, boundary motion and initial state are derived:
    /// current positions, formulas in X, Y, t.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub manufactured: Option<Vec<FormulaSpec>>,
    /// Contact pairs of sides.
    pub contacts: Vec<ContactSpec>,
    /// Ties of sides.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ties: Vec<TieSpec>,
    /// Time interval, step and scheme.
    pub time: TimeSpec,
    /// Newton's method.
    pub newton: NewtonSpec,
    /// Points whose quantities are recorded as columns.
    pub probes: Vec<ProbeSpec>,
    /// Measured data of columns.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub overlays: Vec<OverlaySpec>,
    /// Output settings: what is written, and how often.
    pub output: OutputSpec,
    /// Exact solution by column, as formulas in t.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub exact: BTreeMap<String, String>,
    /// Expected values.
    pub expects: Vec<ExpectSpec>,
    /// Functions of a program that loads and motions name (`@push`). They are not stored: whoever
    /// resumes a run gives them again.
    #[serde(skip)]
    pub functions: Functions,
}

impl Case {
    /// Indices of the bodies of which a material yields.
    pub fn yielding(&self) -> impl Iterator<Item = usize> {
        let materials: Vec<&MaterialSpec> = self.materials.iter().collect();
        (0..self.bodies.len()).filter(move |k| self.bodies[*k].yields(&materials))
    }

    /// The materials of a body.
    pub fn materials_of(&self, body: &BodySpec) -> Vec<&MaterialSpec> {
        let named = |name: &str| self.materials.iter().find(|material| material.name == name);
        body.material_names().into_iter().filter_map(named).collect()
    }

    /// An estimate of the work, steps × nodes, used to start long runs before short ones.
    pub fn work(&self) -> f64 {
        let nodes: f64 = self.bodies.iter().map(|body| body.mesh.estimate(body.element).1).sum();
        self.time.steps() as f64 * nodes
    }
}

/// Unit labels in figures and columns; values are not converted.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[keys(name = "units")]
pub struct Units {
    /// Unit label of length.
    #[key(default = "\"m\"")]
    pub length: String,
    /// Unit label of time.
    #[key(default = "\"s\"")]
    pub time: String,
    /// Unit label of mass.
    #[key(default = "\"kg\"")]
    pub mass: String,
    /// Whether the case declares its units; otherwise they may be any consistent ones.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub declared: bool,
}

/// Set of default values; keys given explicitly take precedence.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// Carom's defaults.
    #[default]
    Default,
    /// The paper as printed, where a key exists for it.
    Paper,
}

/// Start from the final state of another run with the same meshes; time starts at 0 again. Or
/// continue from a state that `carom reduce` saved, at its time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Keys)]
#[keys(name = "[initial]")]
pub struct InitialSpec {
    /// Directory of the finished run, or file of a saved state, relative to the folder of the case.
    #[key(example = "\"runs/preload\"")]
    pub from: PathBuf,
    /// Initial velocities.
    #[key(default = "\"keep\"")]
    pub velocities: Velocities,
}

/// Initial velocities of a case that starts from another run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
pub enum Velocities {
    /// Those at the end of the other run.
    Keep,
    /// Zero: all bodies start at rest.
    Zero,
}
