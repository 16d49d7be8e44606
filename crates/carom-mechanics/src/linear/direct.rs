//! Direct solution: the frozen tangent is factored, with the bodies condensed to the interface
//! nodes, on which contact can act; contact is solved on those alone.
//!
//! ```text
//! [ A + Σ w λ∇²g  Fᵀ ] [Δy]   [−r]       A = w.mass a' M + w.internal K_int − w.external K_ext at the frozen point
//! [ G             −C ] [Δλ] = [−g]       (or M where velocities are projected)
//! ```
//!
//! F = G except with friction. Gradients and second derivatives of the gaps are those of the
//! current iterate: nodes may come, leave and slide without a new factor. Only A is old.

use std::collections::VecDeque;
use std::sync::Arc;

use carom_algebra::{Condensed, Elimination, LinearError, Pattern, Precision, Saddle};

use crate::contact::constraints::Constraints;
use crate::linear::matrices::Matrices;
use crate::linear::preconditioner::Preconditioner;
use crate::model::Model;
use crate::rejected::Rejected;
use crate::stage::renewal::Point;
use carom_solid::Configuration;

/// Cost of forming and factoring a tangent, in solves with the frozen one.
const COST: f64 = 6.0;
/// Unknowns above which a factor exceeds the processor's caches.
pub const LARGE: usize = 10_000;
/// Largest ratio of stiffness to mass, (ωΔt)² times a factor, on the diagonal of a single-precision
/// factor.
const STIFF: f64 = 1e3;
/// Dofs that a thread copies.
const BLOCK: usize = 4096;
/// Number of stored structures.
const REMEMBERED: usize = 2;
/// Stiffness added along the rows, as a multiple of theirs: enough to outweigh the curvature terms
/// of contact.
const STIFFENING: f64 = 10.0;
/// Stiffness added along the rows where only motions that keep all gaps matter.
const HELD: f64 = 100.0;
/// Margin around the nodes of the rows, relative to their extent.
const MARGIN: f64 = 0.3;

/// The matrices of the bodies, factors of the frozen tangent and of the mass, and buffers of their
/// solves.
pub struct Direct {
    /// Built when they are first needed.
    matrices: Option<Matrices>,
    /// The pattern of a lumped mass, which fills nothing when it is factored.
    lumped: Option<Pattern>,
    /// Diagonals of the mass and of the last tangent.
    diagonals: [Vec<f64>; 2],
    /// The point of the tangent's factor.
    point: Option<Arc<Point>>,
    positive: bool,
    tangent: Option<Condensed>,
    mass: Option<Condensed>,
    of_mass: bool,
    /// Interface nodes and structures, most recent first, of matrices of the bodies' pattern and of
    /// diagonal ones: tangent and mass usually share them, and a rejected step returns to the
    /// previous one.
    latest: [VecDeque<(Vec<usize>, Arc<Elimination>)>; 2],
    saddle: Saddle,
    /// Whether each constraint is a spring, which has no row in the dense system.
    springs: Vec<bool>,
    /// Right-hand side and solution, over unknowns and rows; and in elimination order.
    solution: Vec<f64>,
    inner: Vec<f64>,
}

impl Direct {
    /// out += K x over the free dofs, with the last tangent.
    pub(crate) fn stiffness_product(&self, x: &[f64], out: &mut [f64]) {
        if let Some(matrices) = &self.matrices {
            matrices.stiffness_product(x, out);
        }
    }

    /// For the bodies of a model.
    pub fn new(model: &Model) -> Self {
        let d = model.dimension;
        let n = model.free.len();
        let is_between_nodes =
            |node: usize| model.mass.row(node).any(|(other, mass)| other != node && mass != 0.0);
        let is_lumped = model.points.is_empty() && !(0..model.mass.nodes()).any(is_between_nodes);
        let of_node = |node: usize| -> f64 {
            model.mass.row(node).filter(|(other, _)| *other == node).map(|(_, mass)| mass).sum()
        };
        let mass = model.free.iter().map(|dof| of_node(dof / d)).collect();
        Self {
            matrices: None,
            lumped: is_lumped.then(|| Pattern::from_entries(n, [])),
            diagonals: [mass, vec![0.0; n]],
            point: None,
            positive: false,
            tangent: None,
            mass: None,
            of_mass: false,
            latest: [VecDeque::new(), VecDeque::new()],
            saddle: Saddle::default(),
            springs: Vec::new(),
            solution: Vec::new(),
            inner: Vec::new(),
        }
    }

    /// Factors the last tangent with the coefficients of a point; returns whether it is positive
    /// definite.
    ///
    /// # Errors
    /// If a number is not finite.
    pub(crate) fn factor(
        &mut self,
        model: &Model,
        point: &Arc<Point>,
        double: bool,
    ) -> Result<bool, LinearError> {
        self.point = None;
        let Self { matrices, latest, .. } = self;
        let Matrices { pattern, mass, stiffness, follower, .. } = built(matrices, model);
        let elimination = elimination(latest, model, pattern, &point.boundary)?;
        let single = !double && single_is_enough(pattern, point, mass, stiffness);
        let precision = if single { Precision::Single } else { Precision::Double };
        let fits = |t: &Condensed| Arc::ptr_eq(t.elimination(), &elimination) && t.precision() == precision;
        // Free the old factor before allocating the new one.
        self.tangent = self.tangent.take().filter(fits);
        let new = || Condensed::new(&elimination, precision).on(&model.threads);
        self.positive = self.tangent.get_or_insert_with(new).factor(|k| {
            let internal = point.mass * mass[k] + point.stiffness * stiffness[k];
            if follower.is_empty() { internal } else { internal - point.follower * follower[k] }
        })?;
        self.point = Some(point.clone());
        Ok(self.positive)
    }

    /// The dense system on the interface. A spring adds its stiffness instead of a row. Returns
    /// whether all is positive definite. `stiffening`: stiffness added along the rows.
    fn constrain(
        &mut self,
        model: &Model,
        rows: &Constraints,
        curved: bool,
        stiffening: f64,
    ) -> Result<bool, LinearError> {
        let Some(condensed) = (if self.of_mass { &self.mass } else { &self.tangent }) else {
            return Err(no_factor(model));
        };
        let saddle = &mut self.saddle;
        let elimination = condensed.elimination();
        self.springs.clear();
        self.springs.extend(rows.list.iter().map(|row| row.compliance != 0.0));
        let count = self.springs.iter().filter(|is_spring| !**is_spring).count();
        saddle.begin(condensed.schur(), elimination.schur_size(), count);
        let is_turned = rows.is_skew || rows.list.iter().any(|row| row.yields != 0.0);
        if is_turned {
            saddle.direct();
        }
        let place = |dof: usize| {
            let unknown = model.unknown(dof).filter(|_| !(self.of_mass && model.massless[dof]));
            unknown.and_then(|unknown| elimination.schur_place(unknown))
        };
        let points = &model.points;
        let mut places = Vec::new();
        let mut count = 0;
        for ((row, gradient), direction) in rows.list.iter().zip(rows.rows.iter()).zip(rows.directions.iter())
        {
            if row.compliance == 0.0 {
                let at_places = |(dof, slope): (usize, f64)| Some((place(dof)?, row.weight * slope));
                let slopes = points.pulled(gradient.entries()).filter_map(at_places);
                slopes.for_each(|(a, slope)| saddle.add_row(count, a, slope));
                if is_turned {
                    let slopes = points.pulled(direction.entries()).filter_map(at_places);
                    slopes.for_each(|(a, slope)| saddle.add_direction(count, a, slope));
                }
                saddle.yields(count, row.weight * row.yields);
                count += 1;
            }
            if row.compliance == 0.0 && !curved {
                continue;
            }
            // An entry with the places that carry its dof.
            let carried = |(i, (dof, _)): (usize, (usize, f64))| {
                points.carriers(dof).filter_map(move |(dof, weight)| Some((i, place(dof)?, weight)))
            };
            places.clear();
            places.extend(gradient.entries().enumerate().flat_map(carried));
            for &(i, a, of_a) in &places {
                for &(j, b, of_b) in places.iter().filter(|(_, b, _)| a >= *b) {
                    let value = row.stiffness(gradient.gradient, [i, j], row.compliance, curved);
                    saddle.add(a, b, of_a * of_b * value);
                }
            }
        }
        if !self.of_mass {
            saddle.augment(stiffening);
        }
        Ok(saddle.factor() && (self.of_mass || self.positive))
    }

    /// Overwrites a right-hand side over unknowns and rows with the factor's solution.
    fn solve_all(&mut self, unknowns: usize, x: &mut [f64]) {
        let Some(condensed) = (if self.of_mass { &mut self.mass } else { &mut self.tangent }) else { return };
        let (x, multipliers) = x.split_at_mut(unknowns);
        condensed.eliminate_into(x, &mut self.inner);
        self.saddle.solve(condensed.schur_part(&mut self.inner), multipliers);
        condensed.substitute_into(&mut self.inner, x);
    }
}

impl Preconditioner for Direct {
    fn cost(&self) -> f64 {
        COST
    }

    fn diagonals(&self) -> &[Vec<f64>; 2] {
        &self.diagonals
    }

    fn assemble(&mut self, model: &Model, at: &Configuration) -> Result<(), Rejected> {
        self.diagonals[1] = built(&mut self.matrices, model).assemble(model, at)?;
        Ok(())
    }

    fn of(&self, point: &Arc<Point>) -> Option<bool> {
        (self.point.as_ref() == Some(point)).then_some(self.positive)
    }

    fn form(&mut self, model: &Model, point: &Arc<Point>, double: bool) -> Result<bool, Rejected> {
        let Self { matrices, diagonals, latest, .. } = self;
        let matrices = built(matrices, model);
        let pattern = matrices.pattern.clone();
        let (diagonal, ordered) = model.threads.join(
            || matrices.assemble(model, &point.configuration()),
            || elimination(latest, model, &pattern, &point.boundary),
        );
        diagonals[1] = diagonal?;
        ordered?;
        if point.follower != 0.0 {
            built(&mut self.matrices, model).assemble_loads(model, point.time, &point.at)?;
        }
        Ok(self.factor(model, point, double)?)
    }

    fn form_mass(&mut self, model: &Model, rows: &Constraints) -> Result<(), Rejected> {
        let Self { matrices, lumped, diagonals, latest, .. } = self;
        let (pattern, mass) = if let Some(pattern) = lumped {
            (&*pattern, &diagonals[0])
        } else {
            let Matrices { pattern, mass, .. } = built(matrices, model);
            (&**pattern, &*mass)
        };
        let current = self.point.as_ref().filter(|point| spans(model, &point.boundary, rows));
        let boundary = current.map_or_else(|| interface(model, rows), |point| point.boundary.clone());
        let elimination = elimination(latest, model, pattern, &boundary)?;
        if !self.mass.as_ref().is_some_and(|factor| Arc::ptr_eq(factor.elimination(), &elimination)) {
            self.mass = None;
            let mut factor = Condensed::new(&elimination, Precision::Double).on(&model.threads);
            let mut mass = mass.clone();
            for place in (0..model.free.len()).filter(|&place| model.massless[model.free[place]]) {
                mass[pattern.starts[place]] = 1.0;
            }
            if !factor.factor(|k| mass[k])? {
                return Err(Rejected::NegativeMass);
            }
            self.mass = Some(factor);
        }
        self.of_mass = true;
        Ok(self.constrain(model, rows, false, STIFFENING).map(|_| ())?)
    }

    /// Those of the rows and nearby ones on the sides in contact, so that the choice lasts. The
    /// last choice is reused while it includes the rows and is not much too large.
    fn boundary(&self, model: &Model, y: &[f64], rows: &Constraints, last: Option<&Point>) -> Vec<usize> {
        let row_nodes = interface(model, rows);
        let d = model.dimension;
        let last = last.map_or(&[][..], |point| &point.boundary);
        if row_nodes.is_empty() {
            return last.to_vec();
        }
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for &node in &row_nodes {
            for i in 0..d {
                (low[i], high[i]) = (low[i].min(y[node * d + i]), high[i].max(y[node * d + i]));
            }
        }
        let margin = MARGIN * (0..d).map(|i| high[i] - low[i]).fold(0.0, f64::max);
        let within = |x: f64, i: usize| x >= low[i] - margin && x <= high[i] + margin;
        let near = |node: &usize| (0..d).all(|i| within(y[*node * d + i], i));
        let around = model.contacts.iter().flat_map(|contact| contact.surface.iter().copied().filter(near));
        let mut chosen: Vec<usize> = row_nodes.iter().copied().chain(around).collect();
        chosen.sort_unstable();
        chosen.dedup();
        if spans(model, last, rows) && last.len() <= 2 * chosen.len() { last.to_vec() } else { chosen }
    }

    fn spans(&self, model: &Model, rows: &Constraints) -> bool {
        self.point.as_ref().is_some_and(|point| spans(model, &point.boundary, rows))
    }

    fn prepare(&mut self, model: &Model, rows: &Constraints) -> Result<bool, LinearError> {
        self.of_mass = false;
        // An inaccurate multiplier can make the curvature terms too large: without second
        // derivatives there is still a descent direction.
        Ok(self.constrain(model, rows, true, STIFFENING)?
            || self.constrain(model, rows, false, STIFFENING)?
            || self.constrain(model, rows, true, STIFFENING)?)
    }

    fn is_stable(
        &mut self,
        model: &Model,
        point: &Point,
        rows: &Constraints,
    ) -> Result<Option<bool>, Rejected> {
        self.assemble(model, &point.configuration())?;
        let Self { matrices, latest, .. } = self;
        let Matrices { pattern, stiffness, .. } = built(matrices, model);
        let elimination = elimination(latest, model, pattern, &point.boundary)?;
        let mut factor = Condensed::new(&elimination, Precision::Double).on(&model.threads);
        factor.factor(|k| point.stiffness * stiffness[k])?;
        let is_inner_stable = factor.is_inner_positive();
        let last = self.tangent.replace(factor);
        self.of_mass = false;
        let constrained = self.constrain(model, rows, true, HELD);
        self.tangent = last;
        constrained?;
        Ok(Some(is_inner_stable && self.saddle.is_positive()))
    }

    fn regularity(&self) -> Option<f64> {
        self.saddle.regularity()
    }

    fn solve(
        &mut self,
        model: &Model,
        [forces, gaps]: [&[f64]; 2],
        increment: &mut [f64],
        multipliers: &mut Vec<f64>,
    ) -> Result<(), LinearError> {
        let unknowns = model.free.len();
        let mut x = std::mem::take(&mut self.solution);
        x.resize(unknowns, 0.0);
        model.threads.for_each_block(&mut x, BLOCK, |first, x| {
            x.iter_mut().zip(&model.free[first..]).for_each(|(x, dof)| *x = forces[*dof]);
        });
        for point in model.points.iter() {
            for dof in point.node * model.dimension..(point.node + 1) * model.dimension {
                model.moved_by(dof).for_each(|(unknown, weight)| x[unknown] += weight * forces[dof]);
            }
        }
        x.extend(self.springs.iter().zip(gaps).filter(|(is_spring, _)| !**is_spring).map(|(_, gap)| *gap));
        self.solve_all(unknowns, &mut x);
        model.threads.for_each_block(increment, BLOCK, |first, increment| {
            for (value, unknown) in increment.iter_mut().zip(&model.unknown[first..]) {
                *value = x.get(*unknown).copied().unwrap_or(0.0);
            }
        });
        model.points.carry(increment);
        multipliers.clear();
        let mut found = x[unknowns..].iter().copied();
        let of = |is_spring: &bool| if *is_spring { None } else { found.next() };
        multipliers.extend(self.springs.iter().map(of).map(Option::unwrap_or_default));
        let finite = x.iter().all(|x| x.is_finite());
        self.solution = x;
        if finite { Ok(()) } else { Err(LinearError::Inaccurate { size: unknowns, residual: f64::NAN }) }
    }
}

/// The matrices, built unless that was done.
fn built<'a>(matrices: &'a mut Option<Matrices>, model: &Model) -> &'a mut Matrices {
    matrices.get_or_insert_with(|| Matrices::new(model))
}

/// The elimination order of a pattern with these nodes last; `latest`: those of recent ones.
fn elimination(
    latest: &mut [VecDeque<(Vec<usize>, Arc<Elimination>)>; 2],
    model: &Model,
    pattern: &Pattern,
    boundary: &[usize],
) -> Result<Arc<Elimination>, LinearError> {
    let latest = &mut latest[usize::from(pattern.is_diagonal())];
    if let Some(known) = latest.iter().position(|(nodes, _)| nodes == boundary) {
        latest.swap(0, known);
        return Ok(latest[0].1.clone());
    }
    let d = model.dimension;
    let groups: Vec<usize> = model.free.iter().map(|dof| dof / d).collect();
    let dofs = boundary.iter().flat_map(|node| (0..d).map(move |i| node * d + i));
    let last: Vec<usize> = dofs.filter_map(|dof| model.unknown(dof)).collect();
    let elimination = Arc::new(Elimination::new(pattern, &groups, &last)?);
    latest.truncate(REMEMBERED - 1);
    latest.push_front((boundary.to_vec(), elimination.clone()));
    Ok(elimination)
}

/// Whether single precision suffices for a factor: it is large, so that reading it dominates the
/// cost of a solve, and the matrix is so well conditioned that the rounding error of a correction
/// is far below the error of an old tangent. Scaled to a unit diagonal, and with a positive
/// semidefinite stiffness, the matrix has a condition number of at most some hundred times the
/// largest quotient of its diagonal and the mass's: λ_max is at most the number of dofs of a cell,
/// and λ_min at least that of the scaled mass matrix over that quotient. An indefinite stiffness
/// may be worse; iterations then converge slowly, and it is refactored.
pub fn single_is_enough(pattern: &Pattern, point: &Point, mass: &[f64], stiffness: &[f64]) -> bool {
    let mut diagonal = pattern.starts[..pattern.size()].iter();
    let soft = |&k: &usize| point.stiffness * stiffness[k] <= STIFF * point.mass * mass[k];
    pattern.size() >= LARGE && diagonal.all(soft)
}

fn no_factor(model: &Model) -> LinearError {
    LinearError::Engine { size: model.free.len(), reason: "solve before factor".into() }
}

fn spans(model: &Model, boundary: &[usize], rows: &Constraints) -> bool {
    let is_in = |node: usize| boundary.binary_search(&node).is_ok();
    if model.points.is_empty() {
        return rows.acting().all(is_in);
    }
    interface(model, rows).into_iter().all(is_in)
}

/// The nodes that the rows act on, ascending; of points those that carry them.
fn interface(model: &Model, rows: &Constraints) -> Vec<usize> {
    let nodes = rows.nodes();
    if model.points.is_empty() {
        return nodes;
    }
    let mut carrying = model.points.carrying(&nodes);
    carrying.sort_unstable();
    carrying.dedup();
    carrying
}
