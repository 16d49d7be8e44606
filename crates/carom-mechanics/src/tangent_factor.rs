//! The kept factor: bodies condensed on the nodes that contact can act on, contact itself solved on
//! those alone.
//!
//! ```text
//! [ A + Σ w λ∇²g  Gᵀ ] [Δy]   [−r]       A = w.mass a' M + w.internal K_int − w.external K_ext at the kept point
//! [ G             0  ] [Δλ] = [−g]       (or M where velocities are projected)
//! ```
//!
//! Gradients and second derivatives of the gaps are those of the present iterate: nodes may come,
//! leave and slide without a new factor. Only A is old.

use std::collections::VecDeque;
use std::sync::Arc;

use carom_algebra::{Condensed, Elimination, LinearError, Pattern, Precision, Saddle};

use crate::constraints::Constraints;
use crate::model::Model;
use crate::rejected::Rejected;
use crate::renewal::Point;

/// Factors of the kept tangent and of the mass matrix, and the scratch of their solves.
#[derive(Default)]
pub(crate) struct TangentFactor {
    /// What the tangent's factor was made of.
    point: Option<Arc<Point>>,
    positive: bool,
    tangent: Option<Condensed>,
    mass: Option<Condensed>,
    of_mass: bool,
    /// Boundaries and structures, the one used last first: tangent and mass have the same as a
    /// rule, and a rejected step goes back to the one before.
    latest: VecDeque<(Vec<usize>, Arc<Elimination>)>,
    saddle: Saddle,
    /// The row of the dense system that each constraint is; none of springs.
    places: Vec<Option<usize>>,
    /// Right-hand side and solution, over unknowns and rows; and in the order of elimination.
    solution: Vec<f64>,
    inner: Vec<f64>,
}

impl TangentFactor {
    /// Factors `mass` M + `stiffness` K − `follower` K_ext for a point; the matrices are given in
    /// the slots of the pattern, the last may be empty. Whether the matrix is positive definite.
    ///
    /// # Errors
    /// A number is none.
    pub(crate) fn factor(
        &mut self,
        model: &Model,
        pattern: &Pattern,
        point: &Arc<Point>,
        double: bool,
        [mass, stiffness, follower]: [&[f64]; 3],
    ) -> Result<bool, LinearError> {
        self.point = None;
        let elimination = self.elimination(model, pattern, &point.boundary)?;
        let single = !double && single_is_enough(pattern, point, mass, stiffness);
        let precision = if single { Precision::Single } else { Precision::Double };
        let fits = |t: &Condensed| Arc::ptr_eq(t.elimination(), &elimination) && t.precision() == precision;
        if !self.tangent.as_ref().is_some_and(fits) {
            // The old factor is not wanted beside the new one.
            self.tangent = None;
            self.tangent = Some(Condensed::new(&elimination, precision).on(&model.threads));
        }
        if let Some(tangent) = &mut self.tangent {
            self.positive = tangent.factor(|k| {
                let internal = point.mass * mass[k] + point.stiffness * stiffness[k];
                if follower.is_empty() { internal } else { internal - point.follower * follower[k] }
            })?;
        }
        self.point = Some(point.clone());
        Ok(self.positive)
    }

    /// The order of elimination that leaves these nodes for last.
    fn elimination(
        &mut self,
        model: &Model,
        pattern: &Pattern,
        boundary: &[usize],
    ) -> Result<Arc<Elimination>, LinearError> {
        if let Some(known) = self.latest.iter().position(|(nodes, _)| nodes == boundary) {
            self.latest.swap(0, known);
            return Ok(self.latest[0].1.clone());
        }
        let groups: Vec<usize> = model.free.iter().map(|dof| dof / model.dimension).collect();
        let d = model.dimension;
        let dofs = boundary.iter().flat_map(|node| (0..d).map(move |i| node * d + i));
        let last: Vec<usize> = dofs.filter_map(|dof| model.unknown(dof)).collect();
        let elimination = Arc::new(Elimination::new(pattern, &groups, &last)?);
        self.latest.truncate(REMEMBERED - 1);
        self.latest.push_front((boundary.to_vec(), elimination.clone()));
        Ok(elimination)
    }

    /// Whether it is positive definite, if it is the factor of a point.
    pub(crate) fn of(&self, point: &Arc<Point>) -> Option<bool> {
        (self.point.as_ref() == Some(point)).then_some(self.positive)
    }

    /// Whether the kept factor can take these rows.
    pub(crate) fn spans(&self, rows: &Constraints) -> bool {
        self.point.as_ref().is_some_and(|point| spans(&point.boundary, rows))
    }

    /// Factors M with these rows, over the dofs that have mass: the others keep a unit diagonal and
    /// stay out of the rows.
    ///
    /// # Errors
    /// M is not positive definite, or the rows depend on each other.
    pub(crate) fn factor_mass(
        &mut self,
        model: &Model,
        pattern: &Pattern,
        mass: &[f64],
        rows: &Constraints,
    ) -> Result<(), Rejected> {
        let kept = self.point.as_ref().filter(|point| spans(&point.boundary, rows));
        let boundary = kept.map_or_else(|| rows.nodes(), |point| point.boundary.clone());
        let elimination = self.elimination(model, pattern, &boundary)?;
        if !self.mass.as_ref().is_some_and(|factor| Arc::ptr_eq(factor.elimination(), &elimination)) {
            self.mass = None;
            let mut factor = Condensed::new(&elimination, Precision::Double).on(&model.threads);
            let mut mass = mass.to_vec();
            for place in (0..model.free.len()).filter(|&place| model.massless[model.free[place]]) {
                mass[pattern.starts[place]] = 1.0;
            }
            if !factor.factor(|k| mass[k])? {
                return Err(Rejected::NegativeMass);
            }
            self.mass = Some(factor);
        }
        self.of_mass = true;
        Ok(self.constrain(model, rows, false).map(|_| ())?)
    }

    /// Takes the rows up for solves with the kept tangent; whether what is solved is positive
    /// definite where the rows hold.
    ///
    /// # Errors
    /// The rows depend on each other.
    pub(crate) fn prepare(&mut self, model: &Model, rows: &Constraints) -> Result<bool, LinearError> {
        self.of_mass = false;
        // A multiplier far from its value can bend the sides too much: without second derivatives
        // there still is a descent.
        Ok(self.constrain(model, rows, true)?
            || self.constrain(model, rows, false)?
            || self.constrain(model, rows, true)?)
    }

    /// The dense system on the boundary. A spring is no row of it: it adds its stiffness. Whether
    /// all is positive definite.
    fn constrain(&mut self, model: &Model, rows: &Constraints, curved: bool) -> Result<bool, LinearError> {
        let Some(condensed) = (if self.of_mass { &self.mass } else { &self.tangent }) else {
            return Err(no_factor(model));
        };
        let (saddle, elimination) = (&mut self.saddle, condensed.elimination());
        self.places.clear();
        for compliance in &rows.compliances {
            let before = self.places.iter().flatten().count();
            self.places.push((*compliance == 0.0).then_some(before));
        }
        saddle.begin(condensed.schur(), elimination.schur_size(), self.places.iter().flatten().count());
        let place = |unknown: usize| elimination.kept_place(unknown);
        rows.each_entry(model, |r, unknown, slope| {
            let part = !(self.of_mass && model.massless[model.free[unknown]]);
            if let (Some(row), Some(a)) = (self.places[r].filter(|_| part), place(unknown)) {
                saddle.add_row(row, a, slope);
            }
        });
        let mut add = |a: usize, b: usize, value: f64| {
            if let (Some(a), Some(b)) = (place(a), place(b)) {
                saddle.add(a.max(b), a.min(b), value);
            }
        };
        rows.each_spring(model, &mut add);
        if curved {
            rows.each_curvature(model, &mut add);
        }
        if !self.of_mass {
            saddle.augment(STIFFENING);
        }
        Ok(saddle.factor()? && (self.of_mass || self.positive))
    }

    /// Overwrites a right-hand side over unknowns and rows with the factor's solution.
    fn solve_all(&mut self, unknowns: usize, x: &mut [f64]) {
        let Some(condensed) = (if self.of_mass { &mut self.mass } else { &mut self.tangent }) else { return };
        let (x, multipliers) = x.split_at_mut(unknowns);
        condensed.eliminate_into(x, &mut self.inner);
        self.saddle.solve(condensed.kept_part(&mut self.inner), multipliers);
        condensed.substitute_into(&mut self.inner, x);
    }

    /// Solves with what was prepared last: `forces` over all dofs, `gaps` one per row; answers
    /// alike (held dofs and springs get zero).
    pub(crate) fn solve(
        &mut self,
        model: &Model,
        forces: &[f64],
        gaps: &[f64],
        increment: &mut [f64],
        multipliers: &mut Vec<f64>,
    ) -> Result<(), LinearError> {
        let unknowns = model.free.len();
        let mut x = std::mem::take(&mut self.solution);
        x.clear();
        x.extend(model.free.iter().map(|&dof| forces[dof]));
        x.extend(self.places.iter().zip(gaps).filter_map(|(place, gap)| place.map(|_| *gap)));
        self.solve_all(unknowns, &mut x);
        increment.fill(0.0);
        for (value, &dof) in x.iter().zip(&model.free) {
            increment[dof] = *value;
        }
        multipliers.clear();
        multipliers.extend(self.places.iter().map(|place| place.map_or(0.0, |row| x[unknowns + row])));
        let finite = x.iter().all(|x| x.is_finite());
        self.solution = x;
        if finite { Ok(()) } else { Err(LinearError::Inaccurate { size: unknowns, residual: f64::NAN }) }
    }
}

/// Whether half of the digits are enough for a factor: it is large, so that reading it is what a
/// solve costs, and the matrix is so well conditioned that what rounding leaves over of a
/// correction is far below what an old tangent leaves. Scaled to a unit diagonal, and with a
/// stiffness that is positive semidefinite, the matrix has a condition number of at most some
/// hundred times the largest quotient of its diagonal and the mass's: λ_max is at most the number
/// of dofs of a cell, and λ_min at least that of the scaled mass matrix over that quotient. Another
/// stiffness may do worse; iterations then contract slowly, and it is made anew.
fn single_is_enough(pattern: &Pattern, point: &Point, mass: &[f64], stiffness: &[f64]) -> bool {
    let mut diagonal = pattern.starts[..pattern.size()].iter();
    let soft = |&k: &usize| point.stiffness * stiffness[k] <= STIFF * point.mass * mass[k];
    pattern.size() >= LARGE && diagonal.all(soft)
}

fn no_factor(model: &Model) -> LinearError {
    LinearError::Engine { size: model.free.len(), reason: "solve before factor".into() }
}

fn spans(boundary: &[usize], rows: &Constraints) -> bool {
    rows.rows.iter().flat_map(|row| row.nodes).all(|node| boundary.binary_search(node).is_ok())
}

/// Nodes to eliminate last: those the rows touch and what lies around them on the sides in contact,
/// so that it need not be chosen anew soon. The last choice is kept while it covers the rows and is
/// not much too large.
pub(crate) fn boundary(model: &Model, y: &[f64], rows: &Constraints, last: Option<&Point>) -> Vec<usize> {
    let (touched, d) = (rows.nodes(), model.dimension);
    let last = last.map_or(&[][..], |point| &point.boundary);
    if touched.is_empty() {
        return last.to_vec();
    }
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for &node in &touched {
        for i in 0..d {
            (low[i], high[i]) = (low[i].min(y[node * d + i]), high[i].max(y[node * d + i]));
        }
    }
    let margin = MARGIN * (0..d).map(|i| high[i] - low[i]).fold(0.0, f64::max);
    let within = |x: f64, i: usize| x >= low[i] - margin && x <= high[i] + margin;
    let near = |node: &usize| (0..d).all(|i| within(y[*node * d + i], i));
    let around = model.contacts.iter().flat_map(|contact| contact.surface.iter().copied().filter(near));
    let mut chosen: Vec<usize> = touched.iter().copied().chain(around).collect();
    chosen.sort_unstable();
    chosen.dedup();
    if spans(last, rows) && last.len() <= 2 * chosen.len() { last.to_vec() } else { chosen }
}

/// Unknowns from which a factor does not fit into the processor's caches.
const LARGE: usize = 10_000;
/// Largest ratio of stiffness to mass, (ωΔt)² and a factor, on the diagonal of a factor of single
/// precision.
const STIFF: f64 = 1e3;
/// Structures that are remembered.
const REMEMBERED: usize = 2;
/// What the rows add to the stiffness along themselves, as a multiple of it: enough that bending
/// contact leaves it positive definite.
const STIFFENING: f64 = 10.0;
/// What is added on each side of the touched nodes, as a share of their extent.
const MARGIN: f64 = 0.3;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_of_the_digits_are_for_large_factors_that_mass_holds_together() {
        let point = Point { mass: 2.0, stiffness: 2.0, ..Point::default() };
        let enough = |size: usize, mass: f64, stiffness: f64| {
            let pattern = Pattern::from_entries(size, []);
            let (mut masses, mut stiffnesses) = (vec![1.0; size], vec![10.0; size]);
            (masses[7], stiffnesses[7]) = (mass, stiffness);
            single_is_enough(&pattern, &point, &masses, &stiffnesses)
        };
        assert!(enough(LARGE, 1.0, 999.0));
        assert!(!enough(LARGE - 1, 1.0, 999.0) && !enough(LARGE, 1.0, 1001.0) && !enough(LARGE, 0.0, 1.0));
    }
}
