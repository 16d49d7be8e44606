//! The [`Body`] interface of a solid.

use std::ops::Range;

use carom_algebra::sums::max_or_nan;
use carom_algebra::{Mat, Vector, wide};

use super::memory::{Energies, Step};
use super::rotation::{angle, strain};
use super::{Medium, Place, ShapePoint, Solid};
use crate::body::{Ask, Body, Configuration, Geometry, Inverted, PointState, Response};
use crate::bounds::Bounds;
use crate::material::{NotPositive, Past, Pointwise};
use crate::mesh::Mesh;
use crate::points::{LANES, get};
use crate::reference::{self, gradient};
use crate::shape::Shape;
use crate::tree::Tree;

impl<const D: usize, const N: usize, S: Shape<D, N>> Geometry for Solid<D, N, S> {
    fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    fn add_cells(&self, first: usize, locals: &[f64], sum: &mut [f64]) {
        let locals = locals.as_chunks::<D>().0.as_chunks::<N>().0;
        let sum = sum.as_chunks_mut::<D>().0;
        let cells = &self.mesh.cells.as_chunks::<N>().0[first..];
        for (nodes, local) in cells.iter().zip(locals) {
            for (node, local) in nodes.iter().zip(local) {
                let sum = &mut sum[*node];
                for i in 0..D {
                    sum[i] += local[i];
                }
            }
        }
    }

    fn cell_volumes(&self, cell: usize, volumes: &mut [f64]) {
        volumes.fill(0.0);
        self.each_mass_point(cell, |values, volume| {
            for a in 0..N {
                volumes[a] += volume * values[a];
            }
        });
    }

    fn each_volume_point(&self, cell: usize, visit: &mut dyn FnMut(&[f64], &[f64], f64)) {
        let x = self.reference(cell);
        self.each_mass_point(cell, |values, volume| {
            let mut position = Vector::<D>::ZERO;
            for a in 0..N {
                position += x[a] * values[a];
            }
            visit(values, &position.0, volume);
        });
    }

    fn each_moved_point(&self, cell: usize, y: &[f64], visit: &mut dyn FnMut(&[f64], &[f64], &[f64], f64)) {
        let x = self.reference(cell);
        let u = self.displacements(cell, y);
        for ShapePoint { values, gradients, weight, .. } in &self.mass_points[usize::from(self.curved[cell])]
        {
            let derivative = gradient(&x, gradients);
            let inverse_transposed = derivative.inverse().transposed();
            let h = gradient(&u, &gradients.map(|g| inverse_transposed.apply(&g)));
            let place = reference::interpolate(values, &x);
            let moved = place + reference::interpolate(values, &u);
            visit(&place.0, &moved.0, h.0.as_flattened(), weight * derivative.det() * self.thickness);
        }
    }

    fn cell_turn(&self, cell: usize, y: &[f64]) -> [f64; 2] {
        let u = self.displacements(cell, y);
        let Place { points, inverse, .. } = &self.places[cell];
        let found = self.points[points.clone()].iter().flat_map(|points| {
            let h = points.gradient(&u, inverse);
            (0..points.count).map(move |l| [angle(&get(&h, l)), strain(&get(&h, l))])
        });
        found.fold([0.0; 2], |most, one| [0, 1].map(|i| f64::max(most[i], one[i])))
    }

    fn shape(&self, xi: &[f64], values: &mut [f64]) {
        values.copy_from_slice(&S::values(&vector(xi)));
    }

    fn reference_nodes(&self) -> Vec<Vec<f64>> {
        S::NODES.iter().map(|x| x.0.to_vec()).collect()
    }

    fn locate(&self, point: &[f64]) -> Vec<(usize, Vec<f64>)> {
        let x = self.mesh.nodes.flat();
        let tree =
            self.tree.get_or_init(|| Tree::new(self.mesh.cell_count(), |cell| self.cell_bounds(cell, x)));
        let mut near = Vec::new();
        tree.find_into(&Bounds::of(point), &mut near);
        near.into_iter().filter_map(|cell| Some((cell, self.invert(cell, x, point)?))).collect()
    }

    fn cell_bounds(&self, cell: usize, y: &[f64]) -> Bounds {
        let nodes = self.nodes(cell);
        let y = y.as_chunks::<D>().0;
        let bounds = self.hull.bounds(|a| &y[nodes[a]]);
        bounds.grown(reference::MARGIN * bounds.size())
    }

    fn invert(&self, cell: usize, y: &[f64], point: &[f64]) -> Option<Vec<f64>> {
        let y = y.as_chunks::<D>().0;
        let nodes = self.nodes(cell).map(|node| Vector(y[node]));
        reference::invert::<D, N, S>(&nodes, &vector(point)).map(|xi| xi.0.to_vec())
    }
}

impl<const D: usize, const N: usize, S: Shape<D, N>> Body for Solid<D, N, S> {
    fn respond(
        &self,
        first: usize,
        at: &Configuration,
        ask: Ask,
        out: Response,
    ) -> Result<Option<f64>, Inverted> {
        let Response { numbers, energies, memory, dissipated } = out;
        if const { Self::HAS_CONSTANT_STRAIN }
            && self.memory == 0
            && let (Ask::Force, None) = (ask, at.before)
        {
            return self.constant_forces(first, at.y, numbers, energies).map(Some);
        }
        let width = numbers.len() / energies.len().max(1);
        let mut memories = memory.chunks_exact_mut(self.memory.max(1));
        let mut dissipated = dissipated.iter_mut();
        for (k, (numbers, energy)) in numbers.chunks_exact_mut(width).zip(energies).enumerate() {
            let memory = memories.next().unwrap_or(&mut []);
            let response = self.respond_of_cell(first + k, at, ask, numbers, memory)?;
            *energy = response.stored;
            if let Some(dissipated) = dissipated.next() {
                *dissipated = response.dissipated;
            }
        }
        Ok(None)
    }

    fn memory(&self) -> usize {
        self.memory
    }

    fn cell_mass(&self, cell: usize, mass: &mut [f64]) {
        mass.fill(0.0);
        let density = self.density(cell);
        self.each_mass_point(cell, |values, volume| {
            for a in 0..N {
                for b in 0..N {
                    mass[a * N + b] += density * volume * values[a] * values[b];
                }
            }
        });
    }

    fn stress_divergence(&self, cell: usize, h: &[f64], second: &[f64], out: &mut [f64]) -> Result<(), f64> {
        let Medium { law, mean, .. } = self.medium(cell);
        let law = mean.as_ref().map_or(law, |mean| &mean.law);
        let h = Mat(std::array::from_fn(|i| std::array::from_fn(|j| h[i * D + j])));
        out.copy_from_slice(&law.divergence(&h, second).map_err(|NotPositive(det_f)| det_f)?.0);
        Ok(())
    }

    fn min_det_f(&self, cells: Range<usize>, y: &[f64], past: &Past) -> f64 {
        if const { Self::HAS_CONSTANT_STRAIN } && self.memory == 0 && cells.start.is_multiple_of(LANES) {
            return self.constant_min_det_f(cells, y);
        }
        cells.map(|cell| self.cell_min_det_f(cell, y, past)).fold(f64::INFINITY, f64::min)
    }

    fn plastic_strain(&self, past: &Past) -> f64 {
        let cells = 0..self.mesh.cell_count();
        let of_cell =
            |cell| self.medium(cell).law.largest_plastic_strain(past.part(cell, self.memory).memory);
        // A law of the user's own does not tell it.
        cells.map(of_cell).fold(0.0, max_or_nan)
    }

    fn quadrature_points(&self, cell: usize, y: &[f64], past: &Past) -> Result<Vec<PointState>, Inverted> {
        let law = &*self.medium(cell).law;
        if law.memory() > 0 && !past.memory.is_empty() {
            return Ok(self.projection(law, cell, y, past)?.states);
        }
        let points = &self.force_rules[usize::from(self.curved[cell])].points;
        points.iter().map(|point| self.point_of(law, cell, &point.0, y, &Past::default())).collect()
    }

    fn cell_lost_between(&self, cell: usize, before: &[f64], now: &[f64]) -> Option<f64> {
        if self.may_invert(cell) {
            return None;
        }
        let nodes = self.nodes(cell);
        let [before, now] = [before, now].map(|y| nodes.map(|node| Vector(y.as_chunks::<D>().0[node])));
        self.validity.lost_between(&before, &now).map(|loss| loss.theta)
    }

    fn cell_margins(&self, first: usize, y: &[f64], margins: &mut [f64]) -> Result<(), Inverted> {
        for (block, margins) in margins.chunks_mut(LANES).enumerate() {
            let first = first + block * LANES;
            let certifies = |k: usize| !self.may_invert(first + k);
            if const { Self::HAS_CONSTANT_STRAIN }
                && (0..margins.len()).all(certifies)
                && self.constant_margins(first, y, margins)
            {
                continue;
            }
            for (k, margin) in margins.iter_mut().enumerate() {
                *margin = self.margin(first + k, y)?;
            }
        }
        Ok(())
    }

    fn points(
        &self,
        cell: usize,
        places: &[Vec<f64>],
        y: &[f64],
        past: &Past,
    ) -> Vec<Result<PointState, Inverted>> {
        let Medium { law, mean, .. } = self.medium(cell);
        let remembers = law.memory() > 0 && !past.memory.is_empty();
        let projection = remembers.then(|| self.projection(&**law, cell, y, past));
        let at = |xi: &Vec<f64>| {
            let mut state = match &projection {
                Some(projection) => {
                    self.projected(&**law, cell, xi, y, projection.as_ref().map_err(|e| *e)?)?
                }
                None => self.point_of(&**law, cell, xi, y, &Past::default())?,
            };
            if const { Self::MAY_AVERAGE }
                && let Some(mean) = mean
            {
                self.add_mean_stress(mean, cell, xi, y, &mut state)?;
            }
            Ok(state)
        };
        places.iter().map(at).collect()
    }

    fn density(&self, cell: usize) -> f64 {
        self.medium(cell).density
    }
}

impl<const D: usize, const N: usize, S: Shape<D, N>> Solid<D, N, S> {
    /// Response of a cell.
    fn respond_of_cell(
        &self,
        cell: usize,
        at: &Configuration,
        ask: Ask,
        numbers: &mut [f64],
        memory: &mut [f64],
    ) -> Result<Energies, Inverted> {
        let Medium { law, mean, .. } = self.medium(cell);
        let law = &**law;
        // A law may use fewer numbers than the body has for a cell: the others are zero.
        memory.fill(0.0);
        let remembers = law.memory() > 0;
        // The mean dilatation is in the same pass over the points.
        if !remembers && let (Ask::Force, None) = (ask, at.before) {
            return Ok(Energies { stored: self.force(cell, at.y, numbers)?, dissipated: 0.0 });
        }
        // At the start of a run nothing is remembered.
        let is_virgin = remembers && at.past.memory.is_empty();
        let none = if is_virgin { vec![0.0; self.memory] } else { Vec::new() };
        let past = match (remembers, is_virgin) {
            (false, _) => Past::default(),
            (true, true) => Past::new(&none, at.past.dt),
            (true, false) => at.past.part(cell, self.memory),
        };
        let memory = if remembers { memory } else { &mut [] };
        let step = Step { law, cell, past, memory };
        let mut energies = match (ask, at.before) {
            (Ask::Force, None) => self.force_of(step, at.y, numbers)?,
            (Ask::Force, Some(before)) => self.between_of(step, [before, at.y], numbers)?,
            (Ask::Tangent, _) => {
                let (force, tangent) = numbers.split_at_mut(N * D);
                self.tangent_of(step, at.y, force, tangent)?
            }
            (Ask::Product(change), before) => {
                self.product_of(&step, before, [at.y, change], numbers)?;
                Energies::default()
            }
        };
        if const { Self::MAY_AVERAGE }
            && let Some(mean) = mean
        {
            energies.stored += self.add_mean(mean, cell, at, ask, numbers)?;
        }
        Ok(energies)
    }

    /// Smallest J over the quadrature points of a cell.
    pub(super) fn cell_min_det_f(&self, cell: usize, y: &[f64], past: &Past) -> f64 {
        let u = self.displacements(cell, y);
        let law = &self.medium(cell).law;
        let past = past.part(cell, self.memory);
        let size = law.memory();
        let Place { points, inverse, .. } = &self.places[cell];
        let blocks = self.points[points.clone()].iter().enumerate();
        let ratios = blocks.flat_map(|(block, points)| {
            let h = points.gradient(&u, inverse);
            let first = block * LANES;
            (0..points.count).map(move |l| law.volume_ratio_at(&get(&h, l), &past.part(first + l, size)))
        });
        ratios.fold(f64::INFINITY, f64::min)
    }

    /// Force of a cell; returns its energy.
    pub(super) fn force(&self, cell: usize, y: &[f64], force: &mut [f64]) -> Result<f64, Inverted> {
        let Medium { law, mean, .. } = self.medium(cell);
        if const { Self::MAY_AVERAGE }
            && let Some(mean) = mean
        {
            return self.mean_force(&**law, mean, cell, y, force);
        }
        Ok(self.force_of(Step::elastic(&**law, cell), y, force)?.stored)
    }

    /// Margin of one cell.
    fn margin(&self, cell: usize, y: &[f64]) -> Result<f64, Inverted> {
        if !self.may_invert(cell) {
            let nodes = self.nodes(cell);
            let y = y.as_chunks::<D>().0;
            let nodes = nodes.map(|node| Vector(y[node]));
            let margin = wide(
                #[inline(always)]
                || self.validity.margin(&nodes),
            );
            return margin.map_err(|loss| {
                let gradients = S::gradients(&loss.place);
                let reference = gradient(&self.reference(cell), &gradients).det();
                Inverted { cell, det_f: gradient(&nodes, &gradients).det() / reference }
            });
        }
        Ok(f64::INFINITY)
    }

    /// [`Body::point`] of another law.
    pub(super) fn point_of(
        &self,
        law: &dyn Pointwise<D>,
        cell: usize,
        xi: &[f64],
        y: &[f64],
        past: &Past,
    ) -> Result<PointState, Inverted> {
        let x = self.reference(cell);
        let inverse_transposed = gradient(&x, &S::gradients(&vector(xi))).inverse().transposed();
        let g = S::gradients(&vector(xi)).map(|g| inverse_transposed.apply(&g));
        let h = gradient(&self.displacements(cell, y), &g);
        law.state_at(&h, past).map_err(|NotPositive(det_f)| Inverted { cell, det_f })
    }
}

/// Reference coordinates from a slice of `D` numbers.
fn vector<const D: usize>(xi: &[f64]) -> Vector<D> {
    Vector(std::array::from_fn(|i| xi[i]))
}
