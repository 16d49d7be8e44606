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

use super::integrals::scale;
use super::memory::Step;
use super::{Place, Solid};
use crate::body::{Ask, Configuration, Inverted, PointState};
use crate::material::{Mean, NotPositive, Past, Pointwise};
use crate::points::{LANES, lanes, sum};
use crate::shape::{Domain, Shape};

/// Blocks of quadrature points of a cell: eight points of Hex8, the largest that has this.
const BLOCKS: usize = 2;

/// The volumetric part of a cell: its force without the pressure, g, and m.
struct Swelling {
    gradient: Vec<f64>,
    measure: f64,
}

impl<const D: usize, const N: usize, S: Shape<D, N>> Solid<D, N, S> {
    /// Whether a body of this shape may have a mean dilatation: Q4 and Hex8 (`factory.rs`). For
    /// others none of this is compiled.
    pub(super) const MAY_AVERAGE: bool = D > 1 && S::DEGREE == 1 && S::Domain::TENSOR;

    /// Volume of a cell (× thickness) by the rule of the forces.
    fn volume(&self, cell: usize) -> f64 {
        let place = &self.places[cell];
        let weights = self.points[place.points.clone()].iter();
        place.volume * weights.map(|points| points.weights[..points.count].iter().sum::<f64>()).sum::<f64>()
    }

    fn swelling(
        &self,
        mean: &Mean<D>,
        cell: usize,
        y: &[f64],
        tangent: Option<&mut [f64]>,
    ) -> Result<Swelling, Inverted> {
        let mut gradient = vec![0.0; N * D];
        let sum = match tangent {
            None => self.force_of(Step::elastic(&*mean.measure, cell), y, &mut gradient)?,
            Some(tangent) => {
                self.tangent_of(Step::elastic(&*mean.measure, cell), y, &mut gradient, tangent)?
            }
        };
        Ok(Swelling { gradient, measure: sum.stored / self.volume(cell) })
    }

    /// Force of a cell, from one pass over its points: the pressure is known at its end. Returns
    /// its energy.
    pub(super) fn mean_force(
        &self,
        law: &dyn Pointwise<D>,
        mean: &Mean<D>,
        cell: usize,
        y: &[f64],
        force: &mut [f64],
    ) -> Result<f64, Inverted> {
        let none = [[[0.0; LANES]; D]; D];
        let mut stresses = [none; BLOCKS];
        let mut cofactors = [none; BLOCKS];
        let mut energy = 0.0;
        let mut swollen = 0.0;
        let mut cell_volume = 0.0;
        let u = self.displacements(cell, y);
        let Place { points, inverse, volume } = &self.places[cell];
        let points = &self.points[points.clone()];
        for ((points, stress), cofactor) in points.iter().zip(&mut stresses).zip(&mut cofactors) {
            let h = points.gradient(&u, inverse);
            let count = points.count;
            let inverted = |NotPositive(det_f)| Inverted { cell, det_f };
            let elastic = law.stresses(&h, &Past::default(), count, &mut []).map_err(inverted)?;
            let measure = mean.measure.stresses(&h, &Past::default(), count, &mut []).map_err(inverted)?;
            *stress = lanes(&elastic.stress);
            *cofactor = lanes(&measure.stress);
            let weights = points.weights.map(|weight| volume * weight);
            for l in 0..count {
                energy += weights[l] * elastic.stored.0[l];
                swollen += weights[l] * measure.stored.0[l];
                cell_volume += weights[l];
            }
            scale(stress, &weights);
            scale(cofactor, &weights);
        }
        let [swelling, pressure, _] = mean.volumetric.at(swollen / cell_volume);
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

    /// Adds the volumetric part of a response; returns its energy, zero of a product.
    pub(super) fn add_mean(
        &self,
        mean: &Mean<D>,
        cell: usize,
        at: &Configuration,
        ask: Ask,
        numbers: &mut [f64],
    ) -> Result<f64, Inverted> {
        match (ask, at.before) {
            (Ask::Force, None) => {
                let Swelling { gradient, measure } = self.swelling(mean, cell, at.y, None)?;
                let [energy, pressure, _] = mean.volumetric.at(measure);
                add(numbers, pressure, &gradient);
                Ok(self.volume(cell) * energy)
            }
            (Ask::Force, Some(before)) => self.add_mean_between(mean, cell, [before, at.y], numbers),
            (Ask::Tangent, _) => {
                let (force, tangent) = numbers.split_at_mut(N * D);
                self.add_mean_tangent(mean, cell, at.y, force, tangent)
            }
            (Ask::Product(change), before) => {
                self.add_mean_product(mean, cell, before, [at.y, change], numbers)?;
                Ok(0.0)
            }
        }
    }

    /// Adds the volumetric force of a cell and its tangent; returns its energy, as the following.
    fn add_mean_tangent(
        &self,
        mean: &Mean<D>,
        cell: usize,
        y: &[f64],
        force: &mut [f64],
        tangent: &mut [f64],
    ) -> Result<f64, Inverted> {
        let mut turning = vec![0.0; tangent.len()];
        let Swelling { gradient, measure } = self.swelling(mean, cell, y, Some(&mut turning))?;
        let volume = self.volume(cell);
        let [energy, pressure, stiffness] = mean.volumetric.at(measure);
        add(force, pressure, &gradient);
        add(tangent, pressure, &turning);
        for (row, a) in tangent.chunks_exact_mut(N * D).zip(&gradient) {
            row.iter_mut().zip(&gradient).for_each(|(entry, b)| *entry += stiffness / volume * (a * b));
        }
        Ok(volume * energy)
    }

    /// Adds the discrete gradient of the volumetric energy of a cell.
    fn add_mean_between(
        &self,
        mean: &Mean<D>,
        cell: usize,
        [before, now]: [&[f64]; 2],
        force: &mut [f64],
    ) -> Result<f64, Inverted> {
        let mut gradient = vec![0.0; N * D];
        let step = Step::elastic(&*mean.measure, cell);
        let sum = self.between_of(step, [before, now], &mut gradient)?.stored;
        let volume = self.volume(cell);
        let start = self.swelling(mean, cell, before, None)?.measure;
        let end = sum / volume;
        let [pressure, _] = mean.volumetric.between([start, end]);
        add(force, pressure, &gradient);
        Ok(volume * mean.volumetric.at(end)[0])
    }

    /// Adds the product of the tangent of the volumetric force.
    fn add_mean_product(
        &self,
        mean: &Mean<D>,
        cell: usize,
        before: Option<&[f64]>,
        [y, change]: [&[f64]; 2],
        product: &mut [f64],
    ) -> Result<(), Inverted> {
        let mut turning = vec![0.0; N * D];
        self.product_of(&Step::elastic(&*mean.measure, cell), before, [y, change], &mut turning)?;
        let volume = self.volume(cell);
        let now = self.swelling(mean, cell, y, None)?;
        let swells = dot(&now.gradient, &self.of_cell(cell, change)) / volume;
        let (pressure, stiffness, along) = match before {
            None => {
                let [_, pressure, stiffness] = mean.volumetric.at(now.measure);
                (pressure, stiffness, now.gradient)
            }
            Some(before) => {
                let start = self.swelling(mean, cell, before, None)?.measure;
                let [pressure, stiffness] = mean.volumetric.between([start, now.measure]);
                let mut along = vec![0.0; N * D];
                self.between_of(Step::elastic(&*mean.measure, cell), [before, y], &mut along)?;
                (pressure, stiffness, along)
            }
        };
        add(product, pressure, &turning);
        add(product, stiffness * swells, &along);
        Ok(())
    }

    /// Adds the volumetric stress at a point.
    pub(super) fn add_mean_stress(
        &self,
        mean: &Mean<D>,
        cell: usize,
        xi: &[f64],
        y: &[f64],
        state: &mut PointState,
    ) -> Result<(), Inverted> {
        let unit = self.point_of(&*mean.measure, cell, xi, y, &Past::default())?;
        let [_, pressure, _] = mean.volumetric.at(self.swelling(mean, cell, y, None)?.measure);
        let cauchy = state.cauchy.as_flattened_mut().iter_mut().zip(unit.cauchy.as_flattened());
        cauchy.for_each(|(stress, unit)| *stress += pressure * unit);
        Ok(())
    }

    /// The nodal vector of a cell from one over all nodes.
    fn of_cell(&self, cell: usize, vector: &[f64]) -> Vec<f64> {
        let vector = vector.as_chunks::<D>().0;
        self.nodes(cell).iter().flat_map(|&node| vector[node]).collect()
    }
}

fn add(to: &mut [f64], factor: f64, from: &[f64]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to += factor * from);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
