//! The kept factor: bodies condensed on the nodes that contact can act on, contact itself solved on those alone.
//!
//! ```text
//! [ A + Σ w λ∇²g  Gᵀ ] [Δy]   [−r]       A = w.mass a' M + w.internal K_int at the kept point
//! [ G             0  ] [Δλ] = [−g]       (or M where velocities are projected)
//! ```
//!
//! Gradients and second derivatives of the gaps are those of the present iterate: nodes may come, leave and slide without a new factor. Only A is old.

use std::sync::Arc;

use carom_algebra::{Condensed, LinearError, Pattern, Saddle};

use crate::kept::Point;
use crate::model::Model;
use crate::system::Row;

/// A factor and the nodes it was analysed for.
#[derive(Default)]
struct Factor {
    condensed: Condensed,
    boundary: Option<Vec<usize>>,
}

/// Factors of the kept tangent and of the mass matrix, and the scratch of their solves.
#[derive(Default)]
pub(crate) struct Held {
    /// What the tangent's factor was made of.
    pub(crate) point: Option<Arc<Point>>,
    tangent: Factor,
    mass: Factor,
    of_mass: bool,
    saddle: Saddle,
    right: Vec<f64>,
    x: Vec<f64>,
    solution: Vec<f64>,
}

impl Factor {
    fn analyse<const D: usize>(
        &mut self,
        model: &Model<D>,
        pattern: &Pattern,
        boundary: &[usize],
    ) -> Result<bool, LinearError> {
        if self.boundary.as_deref() == Some(boundary) {
            return Ok(false);
        }
        self.boundary = None;
        let groups: Vec<usize> = model.free.iter().map(|dof| dof / D).collect();
        let dofs = boundary.iter().flat_map(|node| (0..D).map(move |i| node * D + i));
        let last: Vec<usize> = dofs.map(|dof| model.unknown[dof]).filter(|&u| u != usize::MAX).collect();
        self.condensed.analyse(pattern, &groups, &last)?;
        self.boundary = Some(boundary.to_vec());
        Ok(true)
    }
}

impl Held {
    /// Factors `mass` M + `stiffness` K for a point; M and K are given in the slots of the pattern.
    ///
    /// # Errors
    /// The matrix is not positive definite.
    pub(crate) fn factor<const D: usize>(
        &mut self,
        model: &Model<D>,
        pattern: &Pattern,
        point: &Arc<Point>,
        (mass, stiffness): (&[f64], &[f64]),
    ) -> Result<(), LinearError> {
        self.point = None;
        self.tangent.analyse(model, pattern, &point.boundary)?;
        self.tangent.condensed.fill(|k| point.mass * mass[k] + point.stiffness * stiffness[k]);
        self.tangent.condensed.factor()?;
        self.point = Some(point.clone());
        Ok(())
    }

    /// Whether the kept factor can take these rows.
    pub(crate) fn covers<const D: usize>(&self, rows: &[Row<D>]) -> bool {
        self.point.as_ref().is_some_and(|point| covers(&point.boundary, rows))
    }

    /// Factors M with these rows; `boundary` if it covers them.
    pub(crate) fn factor_mass<const D: usize>(
        &mut self,
        model: &Model<D>,
        pattern: &Pattern,
        mass: &[f64],
        rows: &[Row<D>],
    ) -> Result<(), LinearError> {
        let kept = self.point.as_ref().filter(|point| covers(&point.boundary, rows));
        let boundary = kept.map_or_else(|| nodes(rows), |point| point.boundary.clone());
        if self.mass.analyse(model, pattern, &boundary)? {
            self.mass.condensed.fill(|k| mass[k]);
            self.mass.condensed.factor().inspect_err(|_| self.mass.boundary = None)?;
            self.mass.condensed.seal();
        }
        self.of_mass = true;
        self.constrain(model, rows, false)
    }

    /// Takes the rows up for solves with the kept tangent.
    pub(crate) fn prepare<const D: usize>(&mut self, model: &Model<D>, rows: &[Row<D>]) -> Result<(), LinearError> {
        self.of_mass = false;
        // A multiplier far from its value can bend the sides too much: without second derivatives there still is a descent.
        self.constrain(model, rows, true).or_else(|_| self.constrain(model, rows, false))
    }

    /// The dense system on the boundary.
    fn constrain<const D: usize>(
        &mut self,
        model: &Model<D>,
        rows: &[Row<D>],
        curved: bool,
    ) -> Result<(), LinearError> {
        let condensed = if self.of_mass { &self.mass.condensed } else { &self.tangent.condensed };
        let saddle = &mut self.saddle;
        saddle.begin(condensed.schur(), condensed.kept(), rows.len());
        let place = |dof: usize| Some(model.unknown[dof]).filter(|&u| u != usize::MAX).map(|u| condensed.kept_place(u));
        for (r, row) in rows.iter().enumerate() {
            let gap = row.gap;
            for p in 0..gap.count {
                for i in 0..D {
                    let Some(Some(a)) = place(gap.nodes[p] * D + i) else { continue };
                    saddle.add_row(r, a, row.weight * gap.gradient[p][i]);
                    for q in (0..gap.count).filter(|_| curved) {
                        for j in 0..D {
                            if let Some(Some(b)) = place(gap.nodes[q] * D + j)
                                && a >= b
                            {
                                saddle.add(a, b, row.weight * gap.hessian[p][q].0[i][j]);
                            }
                        }
                    }
                }
            }
        }
        if curved {
            saddle.augment(STIFFENING);
        }
        saddle.factor()
    }

    /// Solves with what was prepared last: `forces` over all dofs, `gaps` one per row; answers alike (held dofs get zero).
    pub(crate) fn solve<const D: usize>(
        &mut self,
        model: &Model<D>,
        forces: &[f64],
        gaps: &[f64],
        increment: &mut [f64],
        multipliers: &mut Vec<f64>,
    ) -> Result<(), LinearError> {
        let condensed = if self.of_mass { &mut self.mass.condensed } else { &mut self.tangent.condensed };
        self.right.clear();
        self.right.extend(model.free.iter().map(|&dof| forces[dof]));
        condensed.eliminate_into(&self.right, &mut self.x);
        multipliers.clear();
        multipliers.extend_from_slice(gaps);
        self.saddle.solve(condensed.kept_part(&mut self.x), multipliers);
        self.solution.clear();
        self.solution.resize(self.right.len(), 0.0);
        condensed.substitute_into(&mut self.x, &mut self.solution);
        increment.fill(0.0);
        for (value, &dof) in self.solution.iter().zip(&model.free) {
            increment[dof] = *value;
        }
        if self.solution.iter().chain(multipliers.iter()).all(|x| x.is_finite()) {
            Ok(())
        } else {
            Err(LinearError::Inaccurate { size: self.solution.len(), residual: f64::NAN })
        }
    }
}

fn nodes<const D: usize>(rows: &[Row<D>]) -> Vec<usize> {
    let mut nodes: Vec<usize> = rows.iter().flat_map(|row| row.gap.nodes[..row.gap.count].iter().copied()).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

fn covers<const D: usize>(boundary: &[usize], rows: &[Row<D>]) -> bool {
    let mut all = rows.iter().flat_map(|row| &row.gap.nodes[..row.gap.count]);
    all.all(|node| boundary.binary_search(node).is_ok())
}

/// Nodes to eliminate last: those the rows touch and what lies around them on the sides in contact, so that it need not be chosen anew soon. The last
/// choice is kept while it covers the rows and is not much too large.
pub(crate) fn boundary<const D: usize>(
    model: &Model<D>,
    y: &[[f64; D]],
    rows: &[Row<D>],
    last: Option<&Point>,
) -> Vec<usize> {
    let touched = nodes(rows);
    let last = last.map_or(&[][..], |point| &point.boundary);
    if touched.is_empty() {
        return last.to_vec();
    }
    let (mut low, mut high) = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
    for &node in &touched {
        for i in 0..D {
            (low[i], high[i]) = (low[i].min(y[node][i]), high[i].max(y[node][i]));
        }
    }
    let margin = MARGIN * (0..D).map(|i| high[i] - low[i]).fold(0.0, f64::max);
    let near = |node: &usize| (0..D).all(|i| y[*node][i] >= low[i] - margin && y[*node][i] <= high[i] + margin);
    let around = model.contacts.iter().flat_map(|contact| contact.surface.iter().copied().filter(near));
    let mut chosen: Vec<usize> = touched.iter().copied().chain(around).collect();
    chosen.sort_unstable();
    chosen.dedup();
    if covers(last, rows) && last.len() <= 2 * chosen.len() { last.to_vec() } else { chosen }
}

/// What the rows add to the stiffness along themselves, as a multiple of it: enough that bending contact leaves it positive definite.
const STIFFENING: f64 = 10.0;
/// What is added on each side of the touched nodes, as a share of their extent.
const MARGIN: f64 = 0.3;
