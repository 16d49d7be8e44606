//! Moving supports: y = X + u(X, t) with v = u̇ and a = ü from the formula's own derivatives. The
//! scheme's relations between d, v and a are not used for these dofs, so they cannot ring, and
//! their inertia M a acts on their neighbours.

use carom_formula::Formula;

use super::formulas::{Arguments, NoValue, finite, points};

/// A prescribed dof.
#[derive(Clone, Debug)]
struct Moved {
    dof: usize,
    /// Index into `formulas`.
    formula: usize,
    place: Vec<f64>,
}

/// All prescribed motions of a model.
#[derive(Default)]
pub struct Motions {
    formulas: Vec<(String, Formula)>,
    moved: Vec<Moved>,
}

/// A dof's displacement, velocity and acceleration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prescribed {
    /// Global dof.
    pub dof: usize,
    /// u, u̇, ü.
    pub motion: [f64; 3],
}

impl Motions {
    /// Prescribed displacements by formulas of position and time: formulas with their labels, and
    /// each prescribed dof once, ascending, with the index of its formula and its reference
    /// position.
    pub fn new(
        formulas: Vec<(String, Formula)>,
        moved: impl IntoIterator<Item = (usize, usize, Vec<f64>)>,
    ) -> Self {
        let moved = moved.into_iter().map(|(dof, formula, place)| Moved { dof, formula, place }).collect();
        Self { formulas, moved }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.moved.is_empty()
    }

    /// Prescribed dofs, ascending.
    pub fn dofs(&self) -> impl Iterator<Item = usize> + '_ {
        self.moved.iter().map(|m| m.dof)
    }

    /// Displacements, velocities and accelerations at a time; `out` is reused.
    ///
    /// # Errors
    /// The first formula without a finite value or derivative.
    pub fn at(&self, time: f64, out: &mut Vec<Prescribed>) -> Result<(), NoValue> {
        out.clear();
        let mut given: Vec<_> = (0..self.formulas.len()).map(|k| self.given(k, time).into_iter()).collect();
        for moved in &self.moved {
            let (label, formula) = &self.formulas[moved.formula];
            let motion = match formula.function() {
                Some(_) => given[moved.formula].next().unwrap_or([f64::NAN; 3]),
                None => {
                    formula.with_derivatives(Arguments::new(&moved.place, time).as_slice(), moved.place.len())
                }
            };
            for value in motion {
                finite(value, formula, label, &moved.place, time)?;
            }
            out.push(Prescribed { dof: moved.dof, motion });
        }
        Ok(())
    }

    /// Displacements of the dofs of formula `k` with their derivatives, if it is a function of a
    /// program, which is called once.
    fn given(&self, k: usize, time: f64) -> Vec<[f64; 3]> {
        let Some(function) = self.formulas[k].1.function() else { return Vec::new() };
        let moved = self.moved.iter().filter(|moved| moved.formula == k);
        let places: Vec<&[f64]> = moved.map(|moved| moved.place.as_slice()).collect();
        let Some(width) = places.first().map(|place| place.len() + 1) else { return Vec::new() };
        function.with_derivatives(&points(&places, time), width)
    }
}
