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
use carom_contact::Linearised;
use carom_solid::Inverted;

use crate::cells::Cells;
use crate::held::Held;
use crate::kept::Point;
use crate::model::{LoadsAt, Model};

/// Slot of an entry that is not stored: that of a held dof, or of a facet's upper triangle.
const SKIP: u32 = u32::MAX;

/// Why a factor is not to be had at a point.
pub(crate) enum HoldError {
    /// A cell is inverted.
    Inverted((String, Inverted)),
    /// The matrix is not positive definite.
    Indefinite,
}

/// One active contact row: its linearised gap and the weight of its contact force.
pub(crate) struct Row<'a, const D: usize> {
    /// Gap, gradient, λ-contracted second derivative.
    pub gap: &'a Linearised<D>,
    /// Weight of the contact force in the balance.
    pub weight: f64,
    /// What a unit of multiplier gives of gap: 0 for a constraint, 1/(∂λ/∂g) for a spring.
    pub compliance: f64,
}

/// The system and its solver.
pub(crate) struct System<const D: usize> {
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
    cells: Cells,
    merged: Pattern,
    from_base: Vec<usize>,
    /// Stencils of the rows the merged pattern was made for.
    rows: Vec<Vec<usize>>,
    analysed: bool,
    solver: FaerSolver,
    rhs: Vec<f64>,
    solution: Vec<f64>,
    held: Held,
    /// Whether the last factor is the kept tangent's or a condensed mass matrix.
    condensed: bool,
    /// Factorisations so far.
    pub factorisations: u64,
}

impl<const D: usize> System<D> {
    /// Pattern and slots of the bodies of a model.
    pub(crate) fn new(model: &Model<D>, threads: usize) -> Self {
        let n = model.free.len();
        let mut entries = Vec::new();
        for_each_cell_pair(model, |pair| entries.extend(pair));
        entries.sort_unstable();
        entries.dedup();
        let base = Pattern::from_entries(n, entries);
        let mut slots = Vec::new();
        for_each_cell_pair(model, |pair| {
            slots.push(pair.and_then(|(a, b)| base.slot(a, b)).map_or(SKIP, |s| s as u32));
        });
        let mut mass = vec![0.0; base.len()];
        for node in 0..model.mass.nodes() {
            for (other, value) in model.mass.row(node) {
                for i in 0..D {
                    let (a, b) = (model.unknown[node * D + i], model.unknown[other * D + i]);
                    if a != usize::MAX
                        && b != usize::MAX
                        && a >= b
                        && let Some(slot) = base.slot(a, b)
                    {
                        mass[slot] += value;
                    }
                }
            }
        }
        let mut facet_slots = Vec::new();
        model.loads.each_facet_tangent(None, |nodes, _| {
            let dofs: Vec<usize> = nodes.iter().flat_map(|n| (0..D).map(move |i| n * D + i)).collect();
            for a in dofs.iter().map(|&dof| model.unknown[dof]) {
                for b in dofs.iter().map(|&dof| model.unknown[dof]) {
                    let stored = a != usize::MAX && b != usize::MAX && a >= b;
                    facet_slots.push(if stored { base.slot(a, b).map_or(SKIP, |s| s as u32) } else { SKIP });
                }
            }
        });
        let diagonals = [diagonal_of(&base, &mass), vec![0.0; n]];
        Self {
            stiffness: vec![0.0; base.len()],
            diagonals,
            follower: vec![0.0; if model.loads.follow() { base.len() } else { 0 }],
            mass,
            facet_slots,
            slots,
            cells: Cells::new(threads),
            merged: Pattern::default(),
            from_base: Vec::new(),
            rows: Vec::new(),
            analysed: false,
            solver: FaerSolver::default(),
            rhs: Vec::new(),
            solution: Vec::new(),
            held: Held::default(),
            condensed: false,
            factorisations: 0,
            base,
        }
    }

    /// The symmetric part of the loads' tangent; it does not depend on the positions.
    pub(crate) fn loads_tangent(&mut self, model: &Model<D>, at: &LoadsAt) {
        self.follower.fill(0.0);
        let mut slots = self.facet_slots.iter();
        let follower = &mut self.follower;
        model.loads.each_facet_tangent(Some(at), |nodes, k| {
            let n = nodes.len() * D;
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
        model: &Model<D>,
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
            let mesh = part.body.mesh();
            let positions = &y.as_chunks::<D>().0[part.nodes()];
            let before = before.map(|y| &y.as_chunks::<D>().0[part.nodes()]);
            let stiffness = &mut self.stiffness;
            let add = |cell: usize, f: &[f64], k: &[f64]| {
                for (node, f) in mesh.cell(cell).iter().zip(f.as_chunks::<D>().0) {
                    for i in 0..D {
                        force[(part.first_node + node) * D + i] += f[i];
                    }
                }
                if let Some((moved, product)) = &mut pull {
                    let dof = |k: usize| (part.first_node + mesh.cell(cell)[k / D]) * D + k % D;
                    for a in 0..f.len() {
                        let row = &k[a * f.len()..(a + 1) * f.len()];
                        product[dof(a)] += row.iter().enumerate().map(|(b, k)| k * moved[dof(b)]).sum::<f64>();
                    }
                }
                for (row, k) in k.chunks_exact(f.len()).enumerate() {
                    for (value, slot) in k[..=row].iter().zip(slots.by_ref()) {
                        if *slot != SKIP {
                            stiffness[*slot as usize] += value;
                        }
                    }
                }
            };
            strain += self
                .cells
                .for_each(&*part.body, before, positions, add)
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

    /// out += K x over the free dofs, with the last tangent.
    pub(crate) fn stiffness_product(&self, x: &[f64], out: &mut [f64]) {
        self.base.multiply_add(&self.stiffness, x, out);
    }

    /// Makes the factor of a point, unless it is there already; `double`: with all its digits.
    ///
    /// # Errors
    /// A cell is inverted there, or the matrix is not positive definite.
    pub(crate) fn hold(
        &mut self,
        model: &Model<D>,
        point: &Arc<Point>,
        double: bool,
        force: &mut [f64],
    ) -> Result<(), HoldError> {
        if self.holds(point) {
            return Ok(());
        }
        self.internal_tangent(model, None, &point.at, force, None).map_err(HoldError::Inverted)?;
        self.factorisations += 1;
        let parts = (self.mass.as_slice(), self.stiffness.as_slice());
        self.held.factor(model, &self.base, point, double, parts).map_err(|_| HoldError::Indefinite)?;
        // The memory of a full tangent is as large again.
        (self.solver, self.merged, self.from_base) = (FaerSolver::default(), Pattern::default(), Vec::new());
        self.analysed = false;
        Ok(())
    }

    /// Whether the kept factor is that of a point.
    pub(crate) fn holds(&self, point: &Arc<Point>) -> bool {
        self.held.point.as_ref() == Some(point)
    }

    /// Forgets the kept factor, memory and all.
    pub(crate) fn release(&mut self) {
        self.held.release();
    }

    /// Whether the kept factor can take these rows.
    pub(crate) fn covers(&self, rows: &[Row<D>]) -> bool {
        self.held.covers(rows)
    }

    /// Takes the rows up for solves with the kept factor.
    pub(crate) fn constrain(&mut self, model: &Model<D>, rows: &[Row<D>]) -> Result<(), LinearError> {
        self.condensed = true;
        self.held.prepare(model, rows)
    }

    /// Factors the system of the last tangents with these rows.
    pub(crate) fn factor(
        &mut self,
        model: &Model<D>,
        mass_factor: f64,
        stiffness_factor: f64,
        follower_factor: f64,
        rows: &[Row<D>],
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
        for (r, row) in rows.iter().enumerate() {
            let gap = row.gap;
            if let Some(slot) = self.merged.slot(n + r, n + r) {
                values[slot] -= row.weight * row.compliance;
            }
            for p in 0..gap.count {
                for i in 0..D {
                    let a = model.unknown[gap.nodes[p] * D + i];
                    if a == usize::MAX {
                        continue;
                    }
                    if let Some(slot) = self.merged.slot(n + r, a) {
                        values[slot] += row.weight * gap.gradient[p][i];
                    }
                    for q in 0..gap.count {
                        for j in 0..D {
                            let b = model.unknown[gap.nodes[q] * D + j];
                            if b != usize::MAX
                                && a >= b
                                && let Some(slot) = self.merged.slot(a, b)
                            {
                                values[slot] += row.weight * gap.hessian[p][q].0[i][j];
                            }
                        }
                    }
                }
            }
        }
        self.factorisations += 1;
        self.solver.factor()
    }

    /// Factors [M Gᵀ; G 0] over the free dofs that have mass; massless ones keep a unit diagonal and stay out of the rows.
    pub(crate) fn factor_mass(&mut self, model: &Model<D>, rows: &[Row<D>]) -> Result<Inertia, LinearError> {
        self.factorisations += 1;
        self.condensed = !model.massless.contains(&true);
        if self.condensed {
            self.held.factor_mass(model, &self.base, &self.mass, rows)?;
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
        for (r, row) in rows.iter().enumerate() {
            for p in 0..row.gap.count {
                for i in 0..D {
                    let dof = row.gap.nodes[p] * D + i;
                    let a = model.unknown[dof];
                    if a != usize::MAX
                        && !model.massless[dof]
                        && let Some(slot) = self.merged.slot(n + r, a)
                    {
                        values[slot] += row.gap.gradient[p][i];
                    }
                }
            }
        }
        self.solver.factor()
    }

    /// Solves with the last factorisation: `forces` over all dofs, `gaps` one per row; answers alike (held dofs get zero).
    pub(crate) fn solve(
        &mut self,
        model: &Model<D>,
        forces: &[f64],
        gaps: &[f64],
        increment: &mut [f64],
        multipliers: &mut Vec<f64>,
    ) -> Result<(), LinearError> {
        if self.condensed {
            return self.held.solve(model, forces, gaps, increment, multipliers);
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
    fn analyse(&mut self, model: &Model<D>, rows: &[Row<D>]) -> Result<(), LinearError> {
        let n = self.base.size();
        let dofs = |row: &Row<D>| -> Vec<usize> {
            let all = row.gap.nodes[..row.gap.count].iter().flat_map(|&node| (0..D).map(move |i| node * D + i));
            all.map(|dof| model.unknown[dof]).filter(|&u| u != usize::MAX).collect()
        };
        let stencils: Vec<Vec<usize>> = rows.iter().map(dofs).collect();
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
        let mut groups: Vec<usize> = model.free.iter().map(|dof| dof / D).collect();
        for row in rows {
            groups.push(anchor(model, row));
        }
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
fn anchor<const D: usize>(model: &Model<D>, row: &Row<D>) -> usize {
    let freedom = |p: usize| -> f64 {
        (0..D)
            .filter(|i| model.unknown[row.gap.nodes[p] * D + i] != usize::MAX)
            .map(|i| row.gap.gradient[p][i].powi(2))
            .sum()
    };
    let best = (1..row.gap.count).fold(0, |best, p| if freedom(p) > 10.0 * freedom(best) { p } else { best });
    row.gap.nodes[best]
}

/// The diagonal of a symmetric matrix: the first entry of each column of its lower triangle.
fn diagonal_of(pattern: &Pattern, values: &[f64]) -> Vec<f64> {
    pattern.starts[..pattern.size()].iter().map(|&slot| values[slot]).collect()
}

/// Calls `visit` with the unknowns of every two dofs of every cell, the larger first, in the order of the lower triangles of the cells' tangents; with none
/// where one is held.
fn for_each_cell_pair<const D: usize>(model: &Model<D>, mut visit: impl FnMut(Option<(usize, usize)>)) {
    let mut unknowns = Vec::new();
    for part in &model.parts {
        let mesh = part.body.mesh();
        for cell in 0..mesh.cell_count() {
            unknowns.clear();
            let dofs = mesh.cell(cell).iter().flat_map(|node| (0..D).map(move |i| (part.first_node + node) * D + i));
            unknowns.extend(dofs.map(|dof| model.unknown[dof]));
            for (row, &a) in unknowns.iter().enumerate() {
                for &b in &unknowns[..=row] {
                    visit((a != usize::MAX && b != usize::MAX).then(|| (a.max(b), a.min(b))));
                }
            }
        }
    }
}
