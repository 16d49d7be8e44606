//! The linear system of one Newton iteration over free dofs and active multipliers,
//!
//! ```text
//! [ K  Gᵀ ] [Δy]   [−r]        K = w.mass a' M + w.internal K_int − w.external K_ext + Σ w.contact λ ∇²g,   rows of G: w.contact ∇g
//! [ G −C  ] [Δλ] = [−g]       C = 0, or w.contact/(∂λ/∂g) of a spring
//! ```
//!
//! Of the tangent of follower pressures, K_ext, the symmetric part is taken: all of it where the side is closed or its ends are held and the
//! pressure is uniform. Elsewhere Newton converges at a linear rate, to the same root.
//!
//! Bodies have a pattern of their own, made once, with the slots of every cell; contact entries are merged in when the set of rows changes, and only then is
//! the system analysed again. The pattern is a function of the rows alone: a resumed run eliminates in the same order.

use std::sync::Arc;

use carom_algebra::{FaerSolver, Inertia, LinearError, LinearSolver, Pattern};
use carom_contact::Row;
use carom_solid::Inverted;

use crate::cells;
use crate::constraints::Constraints;
use crate::equations::Equations;
use crate::kept_factor::KeptFactor;
use crate::model::{LoadsAt, Model};
use crate::renewal::Point;

/// Slot of an entry that is not stored: that of a held dof, or of a facet's upper triangle.
const SKIP: u32 = u32::MAX;

/// The system and its solver.
pub(crate) struct System {
    base: Pattern,
    stiffness: Vec<f64>,
    mass: Vec<f64>,
    /// Symmetric part of ∂f_ext/∂y.
    follower: Vec<f64>,
    /// Diagonals of both: read far more often than they are made.
    diagonals: [Vec<f64>; 2],
    /// Slots of each cell's pairs of dofs, the lower triangle by rows, cell after cell through all bodies.
    slots: Vec<u32>,
    /// Slots of every two dofs of the facets under pressure.
    facet_slots: Vec<u32>,
    merged: Pattern,
    from_base: Vec<usize>,
    /// Stencils of the rows the merged pattern was made for.
    rows: Vec<Vec<usize>>,
    analysed: bool,
    solver: FaerSolver,
    rhs: Vec<f64>,
    solution: Vec<f64>,
    /// The kept factor, and that of the mass.
    pub(crate) kept: KeptFactor,
    /// Whether the last factor is the kept tangent's or a condensed mass matrix.
    condensed: bool,
    /// Factorisations so far.
    pub factorisations: u64,
}

impl System {
    /// Pattern and slots of the bodies of a model.
    pub(crate) fn new(model: &Model) -> Self {
        let base = pattern(model);
        let mut slots = Vec::new();
        for_each_cell_pair(model, |pair| {
            slots.push(pair.and_then(|(a, b)| base.slot(a, b)).map_or(SKIP, |s| s as u32));
        });
        let (d, mut mass) = (model.dimension, vec![0.0; base.len()]);
        for node in 0..model.mass.nodes() {
            for (other, value) in model.mass.row(node) {
                for i in 0..d {
                    if let (Some(a), Some(b)) = (model.unknown(node * d + i), model.unknown(other * d + i))
                        && a >= b
                        && let Some(slot) = base.slot(a, b)
                    {
                        mass[slot] += value;
                    }
                }
            }
        }
        let mut facet_slots = Vec::new();
        model.loads.each_facet_tangent(d, None, |nodes, _| {
            let dofs = || nodes.iter().flat_map(|n| (0..d).map(move |i| n * d + i)).map(|dof| model.unknown(dof));
            for a in dofs() {
                for b in dofs() {
                    let slot = a.zip(b).filter(|(a, b)| a >= b).and_then(|(a, b)| base.slot(a, b));
                    facet_slots.push(slot.map_or(SKIP, |s| s as u32));
                }
            }
        });
        let diagonals = [diagonal_of(&base, &mass), vec![0.0; model.free.len()]];
        Self {
            stiffness: vec![0.0; base.len()],
            diagonals,
            follower: vec![0.0; if model.loads.follow() { base.len() } else { 0 }],
            mass,
            facet_slots,
            slots,
            merged: Pattern::default(),
            from_base: Vec::new(),
            rows: Vec::new(),
            analysed: false,
            solver: FaerSolver::default(),
            rhs: Vec::new(),
            solution: Vec::new(),
            kept: KeptFactor::default(),
            condensed: false,
            factorisations: 0,
            base,
        }
    }

    /// The symmetric part of the loads' tangent; it does not depend on the positions.
    pub(crate) fn loads_tangent(&mut self, model: &Model, at: &LoadsAt) {
        self.follower.fill(0.0);
        let mut slots = self.facet_slots.iter();
        let follower = &mut self.follower;
        model.loads.each_facet_tangent(model.dimension, Some(at), |nodes, k| {
            let n = nodes.len() * model.dimension;
            for a in 0..n {
                for b in 0..n {
                    if let Some(&slot) = slots.next().filter(|slot| **slot != SKIP) {
                        follower[slot as usize] += 0.5 * (k[a * n + b] + k[b * n + a]);
                    }
                }
            }
        });
    }

    /// Internal forces over all dofs and the tangent ∂f_int/∂y of the free ones; the strain energy is returned. With `before`, the forces are the discrete
    /// gradient from there to `y`, and of their tangent the symmetric part is taken. With `pull`, its second vector becomes ∂f_int/∂y times its first,
    /// over all dofs.
    pub(crate) fn internal_tangent(
        &mut self,
        model: &Model,
        before: Option<&[f64]>,
        y: &[f64],
        force: &mut [f64],
        mut pull: Option<(&[f64], &mut [f64])>,
    ) -> Result<f64, (String, Inverted)> {
        force.fill(0.0);
        if let Some((_, product)) = &mut pull {
            product.fill(0.0);
        }
        self.stiffness.fill(0.0);
        let mut slots = self.slots.iter();
        let mut strain = 0.0;
        for part in &model.parts {
            let (mesh, stiffness) = (part.body.mesh(), &mut self.stiffness);
            let n = mesh.element.dofs();
            let compute = |cell: usize, local: &mut [f64]| {
                let (force, tangent) = local.split_at_mut(n);
                match before {
                    None => part.body.cell_tangent(cell, part.of(y), force, tangent),
                    Some(before) => part.body.cell_between(cell, part.of(before), part.of(y), force, Some(tangent)),
                }
            };
            let add = |cell: usize, local: &[f64]| {
                let (dofs, (f, k)) = (part.cell_dofs(cell), local.split_at(n));
                for (dof, f) in dofs.iter().zip(f) {
                    force[*dof as usize] += f;
                }
                if let Some((moved, product)) = &mut pull {
                    for (dof, row) in dofs.iter().zip(k.chunks_exact(n)) {
                        product[*dof as usize] +=
                            row.iter().zip(dofs).map(|(k, other)| k * moved[*other as usize]).sum::<f64>();
                    }
                }
                for (row, k) in k.chunks_exact(n).enumerate() {
                    for (value, slot) in k[..=row].iter().zip(slots.by_ref()) {
                        if *slot != SKIP {
                            stiffness[*slot as usize] += value;
                        }
                    }
                }
            };
            strain += cells::for_each(&model.threads, mesh.cell_count(), n + n * n, compute, add)
                .map_err(|inverted| (part.name.clone(), inverted))?;
        }
        self.diagonals[1] = diagonal_of(&self.base, &self.stiffness);
        Ok(strain)
    }

    /// Diagonal of `mass_factor` M + `stiffness_factor` K over the free dofs: the force that stands for one unit of displacement.
    pub(crate) fn diagonal(&self, mass_factor: f64, stiffness_factor: f64) -> impl Iterator<Item = f64> + '_ {
        let [mass, stiffness] = &self.diagonals;
        mass.iter().zip(stiffness).map(move |(m, k)| mass_factor * m + stiffness_factor * k)
    }

    /// What the last digits of the positions alone make of the residual.
    pub(crate) fn round_off(&self, equations: &Equations) -> f64 {
        let diagonal = self.diagonal(equations.mass_factor(), equations.stiffness_factor());
        16.0 * f64::EPSILON * equations.model.scale * diagonal.map(|d| d * d).sum::<f64>().sqrt()
    }

    /// Mean diagonal of the tangent: makes a gap comparable with a multiplier.
    pub(crate) fn mean_stiffness(&self, equations: &Equations) -> f64 {
        let sum: f64 = self.diagonal(equations.mass_factor(), equations.stiffness_factor()).sum();
        // Before a first tangent without inertia there is nothing to compare with.
        if sum > 0.0 { sum / self.base.size() as f64 } else { 1.0 }
    }

    /// out += K x over the free dofs, with the last tangent.
    pub(crate) fn stiffness_product(&self, x: &[f64], out: &mut [f64]) {
        self.base.multiply_add(&self.stiffness, x, out);
    }

    /// Makes the kept factor that of a point, unless it is already; `double`: with all its digits. Whether the matrix is positive definite.
    ///
    /// # Errors
    /// A cell is inverted there.
    pub(crate) fn hold(
        &mut self,
        model: &Model,
        point: &Arc<Point>,
        double: bool,
        force: &mut [f64],
    ) -> Result<bool, (String, Inverted)> {
        if self.kept.is_of(point) {
            return Ok(true);
        }
        self.internal_tangent(model, None, &point.at, force, None)?;
        self.factorisations += 1;
        let parts = (self.mass.as_slice(), self.stiffness.as_slice());
        let made = self.kept.factor(model, &self.base, point, double, parts).is_ok();
        if made {
            // The memory of a full tangent is as large again.
            (self.solver, self.merged, self.from_base) = (FaerSolver::default(), Pattern::default(), Vec::new());
            self.analysed = false;
        }
        Ok(made)
    }

    /// Factors the system of the last tangents with these rows.
    pub(crate) fn factor(
        &mut self,
        model: &Model,
        mass_factor: f64,
        stiffness_factor: f64,
        follower_factor: f64,
        rows: &Constraints,
    ) -> Result<Inertia, LinearError> {
        self.condensed = false;
        self.analyse(model, rows)?;
        let values = self.solver.values();
        values.fill(0.0);
        for (k, &slot) in self.from_base.iter().enumerate() {
            let follower = self.follower.get(k).copied().unwrap_or_default();
            values[slot] =
                mass_factor * self.mass[k] + stiffness_factor * self.stiffness[k] - follower_factor * follower;
        }
        let n = self.base.size();
        let merged = &self.merged;
        for r in 0..rows.len() {
            if let Some(slot) = merged.slot(n + r, n + r) {
                values[slot] -= rows.weights[r] * rows.compliances[r];
            }
        }
        let mut add = |a: usize, b: usize, value: f64| {
            if let Some(slot) = merged.slot(a, b) {
                values[slot] += value;
            }
        };
        rows.each_entry(model, |r, a, slope| add(n + r, a, slope));
        rows.each_curvature(model, add);
        self.factorisations += 1;
        self.solver.factor()
    }

    /// Factors [M Gᵀ; G 0] over the free dofs that have mass; massless ones keep a unit diagonal and stay out of the rows.
    pub(crate) fn factor_mass(&mut self, model: &Model, rows: &Constraints) -> Result<Inertia, LinearError> {
        self.factorisations += 1;
        self.condensed = !model.massless.contains(&true);
        if self.condensed {
            self.kept.factor_mass(model, &self.base, &self.mass, rows)?;
            return Ok(Inertia { positive: self.base.size(), negative: rows.len(), zero: 0 });
        }
        self.analyse(model, rows)?;
        let values = self.solver.values();
        values.fill(0.0);
        for (k, &slot) in self.from_base.iter().enumerate() {
            values[slot] = self.mass[k];
        }
        let n = self.base.size();
        for (place, &dof) in model.free.iter().enumerate() {
            if model.massless[dof]
                && let Some(slot) = self.merged.slot(place, place)
            {
                values[slot] = 1.0;
            }
        }
        rows.each_entry(model, |r, a, slope| {
            if !model.massless[model.free[a]]
                && let Some(slot) = self.merged.slot(n + r, a)
            {
                values[slot] += slope;
            }
        });
        self.solver.factor()
    }

    /// Solves with the last factorisation: `forces` over all dofs, `gaps` one per row; answers alike (held dofs get zero).
    pub(crate) fn solve(
        &mut self,
        model: &Model,
        forces: &[f64],
        gaps: &[f64],
        increment: &mut [f64],
        multipliers: &mut Vec<f64>,
    ) -> Result<(), LinearError> {
        if self.condensed {
            return self.kept.solve(model, forces, gaps, increment, multipliers);
        }
        let n = self.base.size();
        self.rhs.clear();
        self.rhs.extend(model.free.iter().map(|&dof| forces[dof]));
        self.rhs.extend_from_slice(gaps);
        self.solution.clear();
        self.solution.resize(self.rhs.len(), 0.0);
        self.solver.solve(&self.rhs, &mut self.solution)?;
        increment.fill(0.0);
        for (place, &dof) in model.free.iter().enumerate() {
            increment[dof] = self.solution[place];
        }
        multipliers.clear();
        multipliers.extend_from_slice(&self.solution[n..]);
        Ok(())
    }

    /// The matrix last factored times a vector over free dofs and rows, for tests.
    #[cfg(test)]
    pub(crate) fn product(&mut self, x: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; x.len()];
        self.merged.multiply_add(self.solver.values(), x, &mut out);
        out
    }

    /// Merges the rows into the pattern and orders it anew, unless the rows touch the same dofs as last time.
    fn analyse(&mut self, model: &Model, rows: &Constraints) -> Result<(), LinearError> {
        let n = self.base.size();
        let unknowns = |row: Row| row.entries().filter_map(|(dof, _)| model.unknown(dof)).collect();
        let stencils: Vec<Vec<usize>> = rows.rows.iter().map(unknowns).collect();
        if self.analysed && stencils == self.rows {
            return Ok(());
        }
        let mut entries = Vec::new();
        for (r, stencil) in stencils.iter().enumerate() {
            for &a in stencil {
                entries.push((n + r, a));
                entries.extend(stencil.iter().filter(|&&b| a >= b).map(|&b| (a, b)));
            }
        }
        let contact = Pattern::from_entries(n + rows.len(), entries);
        self.merge(&contact);
        // A multiplier is eliminated right after the dofs of a node its row really depends on.
        let mut groups: Vec<usize> = model.free.iter().map(|dof| dof / model.dimension).collect();
        groups.extend(rows.rows.iter().map(|row| anchor(model, row)));
        let mut names = groups.clone();
        names.sort_unstable();
        names.dedup();
        for g in &mut groups {
            *g = names.binary_search(g).unwrap_or(0);
        }
        self.solver.analyse(&self.merged, &groups)?;
        self.rows = stencils;
        self.analysed = true;
        Ok(())
    }

    fn merge(&mut self, contact: &Pattern) {
        let size = contact.size();
        self.merged = Pattern { starts: vec![0], rows: Vec::with_capacity(self.base.len() + contact.len()) };
        self.from_base.clear();
        for j in 0..size {
            let base: &[usize] = if j < self.base.size() { self.base.column(j) } else { &[] };
            let mut extra = contact.column(j).iter().peekable();
            for &row in base {
                while let Some(&r) = extra.next_if(|&&r| r < row) {
                    self.merged.rows.push(r);
                }
                extra.next_if_eq(&&row);
                self.from_base.push(self.merged.rows.len());
                self.merged.rows.push(row);
            }
            self.merged.rows.extend(extra);
            self.merged.starts.push(self.merged.rows.len());
        }
    }
}

/// The node whose dofs a row leans on: the secondary one unless supports hold it along the normal.
fn anchor(model: &Model, row: Row) -> usize {
    let d = model.dimension;
    let freedom = |p: usize| -> f64 {
        let free = (0..d).filter(|i| model.unknown(row.nodes[p] * d + i).is_some());
        free.map(|i| row.gradient[p * d + i].powi(2)).sum()
    };
    let best = (1..row.nodes.len()).fold(0, |best, p| if freedom(p) > 10.0 * freedom(best) { p } else { best });
    row.nodes[best]
}

/// The diagonal of a symmetric matrix: the first entry of each column of its lower triangle.
fn diagonal_of(pattern: &Pattern, values: &[f64]) -> Vec<f64> {
    pattern.starts[..pattern.size()].iter().map(|&slot| values[slot]).collect()
}

/// The pattern of the bodies: unknowns of every two nodes that share a cell. Nodes are paired first, so that no list of all pairs of dofs is made.
fn pattern(model: &Model) -> Pattern {
    let (d, mut neighbours) = (model.dimension, vec![Vec::new(); model.dofs() / model.dimension]);
    for part in &model.parts {
        let mesh = part.body.mesh();
        for cell in (0..mesh.cell_count()).map(|cell| mesh.cell(cell)) {
            for &a in cell {
                let below = cell.iter().filter(|b| **b <= a).map(|b| part.first_node + b);
                neighbours[part.first_node + a].extend(below);
            }
        }
    }
    for nodes in &mut neighbours {
        nodes.sort_unstable();
        nodes.dedup();
    }
    let pairs = neighbours.iter().enumerate().flat_map(|(a, below)| below.iter().map(move |&b| (a, b)));
    let entries = pairs.flat_map(|(a, b)| (0..d * d).map(move |k| (a * d + k / d, b * d + k % d)));
    let unknowns = entries.filter_map(|(a, b)| model.unknown(a).zip(model.unknown(b)));
    Pattern::from_entries(model.free.len(), unknowns)
}

/// Calls `visit` with the unknowns of every two dofs of every cell, the larger first, in the order of the lower triangles of the cells' tangents; with none
/// where one is held.
fn for_each_cell_pair(model: &Model, mut visit: impl FnMut(Option<(usize, usize)>)) {
    let mut unknowns = Vec::new();
    for part in &model.parts {
        for cell in 0..part.body.mesh().cell_count() {
            unknowns.clear();
            unknowns.extend(part.cell_dofs(cell).iter().map(|dof| model.unknown(*dof as usize)));
            for (row, a) in unknowns.iter().enumerate() {
                for b in &unknowns[..=row] {
                    visit(a.zip(*b).map(|(a, b)| (a.max(b), a.min(b))));
                }
            }
        }
    }
}
