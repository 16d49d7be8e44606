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
pub(super) fn is_trajectory(column: &str) -> bool {
    column
        .rsplit('.')
        .next()
        .is_some_and(|q| ["ux", "uy", "uz", "center_x", "center_y", "center_z"].contains(&q))
}

/// Whether a column is a stress.
fn is_stress(column: &str) -> bool {
    column.rsplit('.').next().is_some_and(|q| q.starts_with("sigma_") || q == "von_mises")
}

/// The groups of a run; `bodies`: the bodies of its probes.
pub(super) fn groups(run: &Trajectory, bodies: &BTreeMap<String, String>) -> Vec<Group> {
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
    pub(super) fn signal<'a>(&self, run: &'a Trajectory) -> Option<Signal<'a>> {
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
    pub(super) fn scale(&self, run: &Trajectory) -> Option<f64> {
        let scale = if self.kind == Kind::Motion {
            self.motion(run)? * (self.vectors() as f64).sqrt()
        } else {
            self.signal(run)?.norms(0.0)?.smooth
        };
        (scale > 0.0).then_some(scale)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(columns: &[(&str, [f64; 3])]) -> Trajectory {
        let columns = columns.iter().map(|(name, values)| ((*name).to_owned(), values.to_vec())).collect();
        Trajectory { times: vec![0.0, 0.5, 1.0], columns, ..Trajectory::default() }
    }

    /// By hand: a body moves 3 along x and 4e-5 along y. An error of 4e-5 along y is 1.3e-5 of its
    /// motion, not all of it.
    #[test]
    fn a_tiny_component_has_the_scale_of_its_vector() {
        let bodies = [("P".to_owned(), "disc".to_owned())].into();
        let right = run(&[("P.ux", [0.0, 1.0, 3.0]), ("P.uy", [0.0, 4e-5, 0.0]), ("P.vx", [1.0; 3])]);
        let arm = run(&[("P.ux", [0.0, 1.0, 3.0]), ("P.uy", [0.0; 3])]);
        let [group] = &groups(&right, &bodies)[..] else { panic!() };
        assert_eq!((group.name.as_str(), group.columns.len()), ("displacements of disc", 2));
        assert_eq!(group.scale(&right), Some(3.0));
        let signal = |run| group.signal(run).unwrap();
        let error = signal(&arm).distance(&signal(&right), 0.0).unwrap().relative_to(3.0).smooth;
        assert!(error < 1e-5, "{error}");
        assert!(is_stress("B.sigma_yy") && is_stress("B.von_mises") && !is_stress("B.uy"));
    }

    /// By hand: the error of a body is that of one of its probes, however many there are of it.
    #[test]
    fn more_probes_do_not_change_an_error() {
        let error = |count: usize| {
            let names: Vec<String> = (0..count).map(|i| format!("P{i}.ux")).collect();
            let bodies = (0..count).map(|i| (format!("P{i}"), "disc".to_owned())).collect();
            let of = |end: f64| {
                let columns: Vec<_> = names.iter().map(|name| (name.as_str(), [0.0, end, end])).collect();
                run(&columns)
            };
            let right = of(2.0);
            let [group] = &groups(&right, &bodies)[..] else { panic!() };
            let arm = of(2.2);
            let far = group.signal(&arm).unwrap().distance(&group.signal(&right).unwrap(), 0.0).unwrap();
            far.smooth / group.scale(&right).unwrap()
        };
        assert!((error(4) - error(1)).abs() < 1e-12);
    }
}
