//! Mean dilatation: the volumetric energy of a cell depends on one measure m of its change of
//! volume alone (J. C. Nagtegaal, D. M. Parks, J. R. Rice, Comput. Methods Appl. Mech. Engrg. 4
//! (1974) 153–177; J. C. Simo, R. L. Taylor, K. S. Pister, ibid. 51 (1985) 177–208),
//!
//! ```text
//! U = Σ w Ψ₀(F) + V W(m),   m = (1/V) Σ w q(F),   Ψ = Ψ₀ + W(q)
//! f = f₀ + p g,   g = Σ w ∂q/∂y,   p = W′(m),      K = K₀ + p ∂g/∂y + W″/V g ⊗ g
//! ```
//!
//! with Ψ₀ the law without Λ and q its measure (`material/volumetric.rs`): m is the relative change
//! of the cell's volume for the neo-Hookean law. A cell of nearly incompressible material has one
//! constraint instead of one at each of its points. Where F is constant in a cell, it changes
//! nothing.
//!
//! The discrete gradient is p̄ ḡ with the quotient p̄ = ΔW/Δm and the discrete gradient ḡ of Σ w q,
//! so that its work is V ΔW exactly.

use carom_algebra::wide;

use super::body::divergence_of;
use super::integrals::scale;
use super::{Place, Solid, SolidError};
use crate::body::{Body, Inverted, PointState};
use crate::bounds::Bounds;
use crate::material::{NotPositive, Pointwise, Volumetric};
use crate::mesh::Mesh;
use crate::points::{LANES, sum};
use crate::shape::Shape;

/// Blocks of quadrature points of a cell: eight points of Hex8, the largest that has this.
const BLOCKS: usize = 2;

/// A solid with mean dilatation.
pub struct MeanDilatation<const D: usize, const N: usize, S, L: Volumetric<D>> {
    /// The body of Ψ₀.
    solid: Solid<D, N, S>,
    law: L,
    measure: L::Measure,
}

/// The volumetric part of a cell: its force without the pressure, g, and m.
struct Swelling {
    gradient: Vec<f64>,
    measure: f64,
}

impl<const D: usize, const N: usize, S: Shape<D, N>, L: Volumetric<D>> MeanDilatation<D, N, S, L> {
    /// Body of a mesh, a law, a density ≥ 0 and a thickness > 0.
    ///
    /// # Errors
    /// If a number is out of range, or the reference shape of a cell is degenerate or inverted.
    pub fn new(mesh: Mesh, law: L, density: f64, thickness: f64) -> Result<Self, SolidError> {
        let solid = Solid::new(mesh, Box::new(law.without_volumetric()), density, thickness)?;
        Ok(Self { solid, measure: law.measure(), law })
    }

    /// Volume of a cell (× thickness) by the rule of the forces.
    fn volume(&self, cell: usize) -> f64 {
        let place = &self.solid.places[cell];
        let weights = self.solid.points[place.points.clone()].iter();
        place.volume * weights.map(|points| points.weights[..points.count].iter().sum::<f64>()).sum::<f64>()
    }

    fn swelling(&self, cell: usize, y: &[f64], tangent: Option<&mut [f64]>) -> Result<Swelling, Inverted> {
        let mut gradient = vec![0.0; N * D];
        let sum = match tangent {
            None => self.solid.force_of(&self.measure, cell, y, &mut gradient)?,
            Some(tangent) => self.solid.tangent_of(&self.measure, cell, y, &mut gradient, tangent)?,
        };
        Ok(Swelling { gradient, measure: sum / self.volume(cell) })
    }

    /// The force of a cell, from one pass over its points: the pressure is known at its end.
    #[inline(always)]
    fn force_of(&self, cell: usize, y: &[f64], force: &mut [f64]) -> Result<f64, Inverted> {
        let none = [[[0.0; LANES]; D]; D];
        let (mut stresses, mut cofactors) = ([none; BLOCKS], [none; BLOCKS]);
        let (mut energy, mut swollen, mut cell_volume) = (0.0, 0.0, 0.0);
        let (u, Place { points, inverse, volume }) =
            (self.solid.displacements(cell, y), &self.solid.places[cell]);
        let points = &self.solid.points[points.clone()];
        for ((points, stress), cofactor) in points.iter().zip(&mut stresses).zip(&mut cofactors) {
            let (h, count) = (points.gradient(&u, inverse), points.count);
            let inverted = |NotPositive(det_f)| Inverted { cell, det_f };
            let densities = self.solid.law.stresses(&h, count, stress).map_err(inverted)?;
            let measures = Pointwise::stresses(&self.measure, &h, count, cofactor).map_err(inverted)?;
            let weights = points.weights.map(|weight| volume * weight);
            for l in 0..count {
                energy += weights[l] * densities[l];
                swollen += weights[l] * measures[l];
                cell_volume += weights[l];
            }
            scale(stress, &weights);
            scale(cofactor, &weights);
        }
        let [swelling, pressure, _] = self.law.volumetric(swollen / cell_volume);
        let mut f = [[[0.0; LANES]; D]; N];
        for ((points, stress), cofactor) in points.iter().zip(&mut stresses).zip(&cofactors) {
            for (stress, cofactor) in stress
                .as_flattened_mut()
                .as_flattened_mut()
                .iter_mut()
                .zip(cofactor.as_flattened().as_flattened())
            {
                *stress += pressure * cofactor;
            }
            points.add_force(stress, inverse, &mut f);
        }
        for (force, f) in force.iter_mut().zip(f.as_flattened()) {
            *force = sum(f);
        }
        Ok(energy + cell_volume * swelling)
    }

    /// The nodal vector of a cell from one over all nodes.
    fn of_cell(&self, cell: usize, vector: &[f64]) -> Vec<f64> {
        let vector = vector.as_chunks::<D>().0;
        self.solid.nodes(cell).iter().flat_map(|&node| vector[node]).collect()
    }
}

fn add(to: &mut [f64], factor: f64, from: &[f64]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to += factor * from);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl<const D: usize, const N: usize, S: Shape<D, N>, L: Volumetric<D>> Body for MeanDilatation<D, N, S, L> {
    fn mesh(&self) -> &Mesh {
        self.solid.mesh()
    }

    fn cell_force(&self, cell: usize, y: &[f64], force: &mut [f64]) -> Result<f64, Inverted> {
        wide(
            #[inline(always)]
            || self.force_of(cell, y, force),
        )
    }

    fn add_cells(&self, first: usize, locals: &[f64], sum: &mut [f64]) {
        self.solid.add_cells(first, locals, sum);
    }

    fn cell_tangent(
        &self,
        cell: usize,
        y: &[f64],
        force: &mut [f64],
        tangent: &mut [f64],
    ) -> Result<f64, Inverted> {
        let shear = self.solid.cell_tangent(cell, y, force, tangent)?;
        let mut turning = vec![0.0; tangent.len()];
        let Swelling { gradient, measure } = self.swelling(cell, y, Some(&mut turning))?;
        let volume = self.volume(cell);
        let [energy, pressure, stiffness] = self.law.volumetric(measure);
        add(force, pressure, &gradient);
        add(tangent, pressure, &turning);
        for (row, a) in tangent.chunks_exact_mut(N * D).zip(&gradient) {
            row.iter_mut().zip(&gradient).for_each(|(entry, b)| *entry += stiffness / volume * (a * b));
        }
        Ok(shear + volume * energy)
    }

    fn cell_between(
        &self,
        cell: usize,
        before: &[f64],
        now: &[f64],
        force: &mut [f64],
    ) -> Result<f64, Inverted> {
        let shear = self.solid.cell_between(cell, before, now, force)?;
        let mut gradient = vec![0.0; N * D];
        let sum = self.solid.between_of(&self.measure, cell, [before, now], &mut gradient)?;
        let (volume, start) = (self.volume(cell), self.swelling(cell, before, None)?.measure);
        let end = sum / volume;
        let [pressure, _] = self.law.volumetric_between([start, end]);
        add(force, pressure, &gradient);
        Ok(shear + volume * self.law.volumetric(end)[0])
    }

    fn cell_product(
        &self,
        cell: usize,
        before: Option<&[f64]>,
        y: &[f64],
        change: &[f64],
        product: &mut [f64],
    ) -> Result<(), Inverted> {
        self.solid.cell_product(cell, before, y, change, product)?;
        let mut turning = vec![0.0; N * D];
        self.solid.product_of(&self.measure, cell, before, [y, change], &mut turning)?;
        let volume = self.volume(cell);
        let now = self.swelling(cell, y, None)?;
        let swells = dot(&now.gradient, &self.of_cell(cell, change)) / volume;
        let (pressure, stiffness, along) = match before {
            None => {
                let [_, pressure, stiffness] = self.law.volumetric(now.measure);
                (pressure, stiffness, now.gradient)
            }
            Some(before) => {
                let start = self.swelling(cell, before, None)?.measure;
                let [pressure, stiffness] = self.law.volumetric_between([start, now.measure]);
                let mut along = vec![0.0; N * D];
                self.solid.between_of(&self.measure, cell, [before, y], &mut along)?;
                (pressure, stiffness, along)
            }
        };
        add(product, pressure, &turning);
        add(product, stiffness * swells, &along);
        Ok(())
    }

    fn point(&self, cell: usize, xi: &[f64], y: &[f64]) -> Result<PointState, Inverted> {
        let mut state = self.solid.point(cell, xi, y)?;
        let unit = self.solid.point_of(&self.measure, cell, xi, y)?;
        let [_, pressure, _] = self.law.volumetric(self.swelling(cell, y, None)?.measure);
        let cauchy = state.cauchy.as_flattened_mut().iter_mut().zip(unit.cauchy.as_flattened());
        cauchy.for_each(|(stress, unit)| *stress += pressure * unit);
        Ok(state)
    }

    fn cell_mass(&self, cell: usize, mass: &mut [f64]) {
        self.solid.cell_mass(cell, mass);
    }

    fn cell_volumes(&self, cell: usize, volumes: &mut [f64]) {
        self.solid.cell_volumes(cell, volumes);
    }

    fn each_volume_point(&self, cell: usize, visit: &mut dyn FnMut(&[f64], &[f64], f64)) {
        self.solid.each_volume_point(cell, visit);
    }

    fn each_moved_point(&self, cell: usize, y: &[f64], visit: &mut dyn FnMut(&[f64], &[f64], &[f64], f64)) {
        self.solid.each_moved_point(cell, y, visit);
    }

    fn stress_divergence(&self, h: &[f64], second: &[f64], out: &mut [f64]) -> Result<(), f64> {
        divergence_of(&self.law, h, second, out)
    }

    fn cell_min_det_f(&self, cell: usize, y: &[f64]) -> f64 {
        self.solid.cell_min_det_f(cell, y)
    }

    fn cell_turn(&self, cell: usize, y: &[f64]) -> [f64; 2] {
        self.solid.cell_turn(cell, y)
    }

    fn cell_margin(&self, cell: usize, y: &[f64]) -> Result<f64, Inverted> {
        self.solid.cell_margin(cell, y)
    }

    fn cell_lost_between(&self, cell: usize, before: &[f64], now: &[f64]) -> Option<f64> {
        self.solid.cell_lost_between(cell, before, now)
    }

    fn shape(&self, xi: &[f64], values: &mut [f64]) {
        self.solid.shape(xi, values);
    }

    fn reference_nodes(&self) -> Vec<Vec<f64>> {
        self.solid.reference_nodes()
    }

    fn locate(&self, point: &[f64]) -> Vec<(usize, Vec<f64>)> {
        self.solid.locate(point)
    }

    fn cell_bounds(&self, cell: usize, y: &[f64]) -> Bounds {
        self.solid.cell_bounds(cell, y)
    }

    fn invert(&self, cell: usize, y: &[f64], point: &[f64]) -> Option<Vec<f64>> {
        self.solid.invert(cell, y, point)
    }

    fn density(&self) -> f64 {
        self.solid.density()
    }
}
