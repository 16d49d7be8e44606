//! Quantities in which runs are compared over their whole history: columns that belong to one
//! vector or tensor of one body have one scale.

use std::collections::{BTreeMap, BTreeSet};

use super::trajectory::Trajectory;
use crate::metrics::Signal;

/// Kind of a group of columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Displacements or positions of the centre.
    Motion,
    /// The contact force, averaged by its impulse.
    Force,
    /// Components of stress.
    Stress,
}

/// Columns with one scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Kind of the quantity.
    pub kind: Kind,
    /// Name in words.
    pub name: String,
    /// Names of the columns.
    pub columns: Vec<String>,
}

/// Whether a column is a displacement or the position of a centre.
pub fn is_trajectory(column: &str) -> bool {
    column
        .rsplit('.')
        .next()
        .is_some_and(|q| ["ux", "uy", "uz", "center_x", "center_y", "center_z"].contains(&q))
}

/// Whether a column is a stress.
pub fn is_stress(column: &str) -> bool {
    column.rsplit('.').next().is_some_and(|q| q.starts_with("sigma_") || q == "von_mises")
}

/// The groups of a run; `bodies`: the bodies of its probes.
pub fn groups(run: &Trajectory, bodies: &BTreeMap<String, String>) -> Vec<Group> {
    let mut found: BTreeMap<(Kind, String), Vec<String>> = BTreeMap::new();
    for column in run.columns.keys() {
        let Some((owner, quantity)) = column.rsplit_once('.') else { continue };
        let body = bodies.get(owner).map_or(owner, String::as_str);
        let key = match () {
            () if is_stress(column) => (Kind::Stress, format!("stresses in {body}")),
            () if !is_trajectory(column) => continue,
            () if quantity.starts_with('u') => (Kind::Motion, format!("displacements of {body}")),
            () => (Kind::Motion, format!("centre of {body}")),
        };
        found.entry(key).or_default().push(column.clone());
    }
    let forces: Vec<String> = run.forces.keys().cloned().collect();
    if !forces.is_empty() {
        found.insert((Kind::Force, "contact force".to_owned()), forces);
    }
    found.into_iter().map(|((kind, name), columns)| Group { kind, name, columns }).collect()
}

impl Group {
    /// The columns of a run as one signal; none if the run lacks one.
    pub fn signal<'a>(&self, run: &'a Trajectory) -> Option<Signal<'a>> {
        if self.kind == Kind::Force {
            let found =
                self.columns.iter().map(|column| run.forces.get(column)).collect::<Option<Vec<_>>>()?;
            let values = found.iter().map(|force| &force.values[..]).collect();
            let impulses = found.iter().map(|force| force.impulse.clone()).collect();
            return Some(Signal::of(&run.times, values).with_integrals(impulses));
        }
        let values = self.columns.iter().map(|column| run.columns.get(column).map(Vec::as_slice));
        Some(Signal::of(&run.times, values.collect::<Option<Vec<_>>>()?))
    }

    /// Without the components of contacts that do not touch in a run, of which there are many where
    /// all pairs of bodies may.
    #[must_use]
    pub(super) fn touching(mut self, run: &Trajectory) -> Self {
        let touches = |name: &String| {
            let force = run.forces.get(name).filter(|_| self.kind == Kind::Force && name.contains('.'));
            force.is_none_or(|force| force.values.iter().any(|value| *value != 0.0))
        };
        self.columns.retain(touches);
        self
    }

    /// Number of vectors whose components the columns are.
    fn vectors(&self) -> usize {
        let owners: BTreeSet<&str> =
            self.columns.iter().filter_map(|column| Some(column.rsplit_once('.')?.0)).collect();
        owners.len()
    }

    /// Largest distance of a vector from its first value.
    pub(super) fn motion(&self, run: &Trajectory) -> Option<f64> {
        let mut vectors: BTreeMap<&str, Vec<&[f64]>> = BTreeMap::new();
        for column in &self.columns {
            let owner = column.rsplit_once('.')?.0;
            vectors.entry(owner).or_default().push(run.columns.get(column)?);
        }
        let distance = |vector: &[&[f64]], row: usize| {
            vector.iter().map(|x| (x[row] - x[0]).powi(2)).sum::<f64>().sqrt()
        };
        let rows = 0..run.times.len();
        let far = |vector: &Vec<&[f64]>| rows.clone().map(|row| distance(vector, row)).fold(0.0, f64::max);
        vectors.values().map(far).reduce(f64::max)
    }

    /// Scale of the errors: of n vectors, √n times the largest motion of one, so that an error is
    /// the root mean square over them; the norm of stresses and forces. None if the quantity is
    /// zero.
    pub fn scale(&self, run: &Trajectory) -> Option<f64> {
        let scale = if self.kind == Kind::Motion {
            self.motion(run)? * (self.vectors() as f64).sqrt()
        } else {
            self.signal(run)?.norms(0.0)?.smooth
        };
        (scale > 0.0).then_some(scale)
    }
}
