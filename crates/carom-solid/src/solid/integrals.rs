//! Sums over the quadrature points of a cell: forces, tangents, and differentials of forces.

use carom_algebra::Vector;

use super::memory::{Energies, Step};
use super::{Place, Solid};
use crate::body::Inverted;
use crate::discrete_gradient::{between, change_between};
use crate::material::{AtFour, Moduli, NotPositive};
use crate::points::{Blocks, LANES, Lanes, Mats, lanes, sum};
use crate::potential::Potential;
use crate::shape::Shape;

impl<const D: usize, const N: usize, S: Shape<D, N>> Solid<D, N, S> {
    /// Forces and, if requested, the tangent of a cell from `at(law, H, memory, moduli)` for the
    /// gradients H of several displacement fields at the points of a block: their energies, P and,
    /// for a tangent, the moduli.
    fn integrate<const M: usize>(
        &self,
        step: Step<D>,
        fields: [&[f64]; M],
        at: impl Fn(&Potential<D>, &[Mats<D>; M], &mut [f64], &mut Moduli<D>) -> Result<AtFour<D>, NotPositive>,
        force: &mut [f64],
        tangent: Option<&mut [f64]>,
    ) -> Result<Energies, Inverted> {
        let Step { law, cell, past, memory } = step;
        let size = law.memory();
        let mut u = [[Vector::ZERO; N]; M];
        for m in 0..M {
            u[m] = self.displacements(cell, fields[m]);
        }
        let mut f = [[[0.0; LANES]; D]; N];
        let mut blocks: Blocks<D, N> = [[[[[0.0; LANES]; D]; D]; N]; N];
        let mut energies = Energies::default();
        let Place { points, inverse, volume } = &self.places[cell];
        for (block, points) in self.points[points.clone()].iter().enumerate() {
            let mut gradients = [[[[0.0; LANES]; D]; D]; M];
            for m in 0..M {
                gradients[m] = points.gradient(&u[m], inverse);
            }
            let mut moduli = [[[[[0.0; LANES]; D]; D]; D]; D];
            let count = points.count;
            let own = block * LANES * size..(block * LANES + count) * size;
            let past = past.within(&own);
            let memory = memory.get_mut(own).unwrap_or(&mut []);
            let found = at(&Potential { law, past, count }, &gradients, memory, &mut moduli)
                .map_err(|NotPositive(det_f)| Inverted { cell, det_f })?;
            let weights = points.weights.map(|weight| volume * weight);
            for l in 0..count {
                energies.stored += weights[l] * found.stored.0[l];
                energies.dissipated += weights[l] * found.dissipated.0[l];
            }
            let mut stresses = lanes(&found.stress);
            scale(&mut stresses, &weights);
            points.add_force(&stresses, inverse, &mut f);
            if tangent.is_some() {
                moduli.as_flattened_mut().iter_mut().for_each(|block| scale(block, &weights));
                points.add_tangent(&moduli, inverse, &mut blocks);
            }
        }
        for (force, f) in force.iter_mut().zip(f.as_flattened()) {
            *force = sum(f);
        }
        if let Some(tangent) = tangent {
            spread(&blocks, tangent);
        }
        Ok(energies)
    }

    /// Force of a law; returns the energies.
    pub(super) fn force_of(&self, step: Step<D>, y: &[f64], force: &mut [f64]) -> Result<Energies, Inverted> {
        self.integrate(
            step,
            [y],
            |of, [h], memory, _| of.law.stresses(h, &of.past, of.count, memory),
            force,
            None,
        )
    }

    /// Force and tangent of a law; returns the energies.
    pub(super) fn tangent_of(
        &self,
        step: Step<D>,
        y: &[f64],
        force: &mut [f64],
        tangent: &mut [f64],
    ) -> Result<Energies, Inverted> {
        self.integrate(
            step,
            [y],
            |of, [h], memory, moduli| of.law.tangents(h, &of.past, of.count, memory, moduli),
            force,
            Some(tangent),
        )
    }

    /// Discrete gradient of a law; returns the energies at the end.
    pub(super) fn between_of(
        &self,
        step: Step<D>,
        ends: [&[f64]; 2],
        force: &mut [f64],
    ) -> Result<Energies, Inverted> {
        self.integrate(
            step,
            ends,
            |of, [start, end], memory, _| between(of, [start, end], memory),
            force,
            None,
        )
    }

    /// Product of the tangent of a law, or of its discrete gradient, and a change.
    pub(super) fn product_of(
        &self,
        step: &Step<D>,
        before: Option<&[f64]>,
        [y, change]: [&[f64]; 2],
        product: &mut [f64],
    ) -> Result<(), Inverted> {
        match before {
            None => self.differentiate(
                step,
                [y],
                change,
                |of, [h], dh| of.law.increments(h, dh, &of.past, of.count),
                product,
            ),
            Some(before) => self.differentiate(
                step,
                [before, y],
                change,
                |of, [start, end], dh| change_between(of, [start, end], dh),
                product,
            ),
        }
    }

    /// Forces of the stress increments `at(law, H, dH)` in lanes, from the gradients of fields and
    /// of an increment of the last.
    fn differentiate<const M: usize>(
        &self,
        step: &Step<D>,
        fields: [&[f64]; M],
        change: &[f64],
        at: impl Fn(&Potential<D>, &[Mats<D>; M], &Mats<D>) -> Result<Mats<D>, NotPositive>,
        product: &mut [f64],
    ) -> Result<(), Inverted> {
        let Step { law, cell, past, .. } = *step;
        let size = law.memory();
        let mut u = [[Vector::ZERO; N]; M];
        for m in 0..M {
            u[m] = self.displacements(cell, fields[m]);
        }
        let nodes = self.nodes(cell);
        let change = change.as_chunks::<D>().0;
        let mut du = [Vector::ZERO; N];
        for a in 0..N {
            du[a] = Vector(change[nodes[a]]);
        }
        let mut f = [[[0.0; LANES]; D]; N];
        let Place { points, inverse, volume } = &self.places[cell];
        for (block, points) in self.points[points.clone()].iter().enumerate() {
            let mut gradients = [[[[0.0; LANES]; D]; D]; M];
            for m in 0..M {
                gradients[m] = points.gradient(&u[m], inverse);
            }
            let count = points.count;
            let own = block * LANES * size..(block * LANES + count) * size;
            let of = Potential { law, past: past.within(&own), count };
            let mut stresses = at(&of, &gradients, &points.gradient(&du, inverse))
                .map_err(|NotPositive(det_f)| Inverted { cell, det_f })?;
            scale(&mut stresses, &points.weights.map(|weight| volume * weight));
            points.add_force(&stresses, inverse, &mut f);
        }
        for (product, f) in product.iter_mut().zip(f.as_flattened()) {
            *product = sum(f);
        }
        Ok(())
    }
}

/// Multiplies the matrices of the points by their weights.
#[inline(always)]
pub(super) fn scale<const D: usize>(mats: &mut Mats<D>, weights: &Lanes) {
    for i in 0..D {
        for j in 0..D {
            for l in 0..LANES {
                mats[i][j][l] *= weights[l];
            }
        }
    }
}

/// Both triangles of a symmetric matrix from the blocks a ≤ b.
#[inline(always)]
pub(super) fn spread<const D: usize, const N: usize>(blocks: &Blocks<D, N>, tangent: &mut [f64]) {
    for b in 0..N {
        for a in 0..=b {
            for i in 0..D {
                for j in 0..D {
                    let row = a * D + i;
                    let column = b * D + j;
                    let value = sum(&blocks[b][a][i][j]);
                    tangent[row * N * D + column] = value;
                    tangent[column * N * D + row] = value;
                }
            }
        }
    }
}
