//! Sums over the quadrature points of a cell: forces, tangents, and differentials of forces.

use carom_algebra::{Vector, wide};

use super::{Place, Solid};
use crate::body::Inverted;
use crate::material::{ModuliMats, NotPositive, Pointwise};
use crate::points::{Blocks, LANES, Lanes, Mats, sum};
use crate::shape::Shape;

impl<const D: usize, const N: usize, S: Shape<D, N>> Solid<D, N, S> {
    /// Forces and, if requested, the tangent of a cell from `at(h, count, P, moduli)` for the
    /// gradients H of several displacement fields at the points of a block: their energies, P and,
    /// for a tangent, the moduli.
    #[inline(always)]
    fn integrate<const M: usize>(
        &self,
        cell: usize,
        fields: [&[f64]; M],
        at: impl Fn(&[Mats<D>; M], usize, &mut Mats<D>, &mut ModuliMats<D>) -> Result<Lanes, NotPositive>,
        force: &mut [f64],
        tangent: Option<&mut [f64]>,
    ) -> Result<f64, Inverted> {
        let mut u = [[Vector::ZERO; N]; M];
        for m in 0..M {
            u[m] = self.displacements(cell, fields[m]);
        }
        let mut f = [[[0.0; LANES]; D]; N];
        let mut blocks: Blocks<D, N> = [[[[[0.0; LANES]; D]; D]; N]; N];
        let mut energy = 0.0;
        let Place { points, inverse, volume } = &self.places[cell];
        for points in &self.points[points.clone()] {
            let mut gradients = [[[[0.0; LANES]; D]; D]; M];
            for m in 0..M {
                gradients[m] = points.gradient(&u[m], inverse);
            }
            let mut stresses = [[[0.0; LANES]; D]; D];
            let mut moduli = [[[[[0.0; LANES]; D]; D]; D]; D];
            let densities = at(&gradients, points.count, &mut stresses, &mut moduli)
                .map_err(|NotPositive(det_f)| Inverted { cell, det_f })?;
            let weights = points.weights.map(|weight| volume * weight);
            for l in 0..points.count {
                energy += weights[l] * densities[l];
            }
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
        Ok(energy)
    }

    /// Force of a law; returns the energy.
    pub(super) fn force_of(
        &self,
        law: &dyn Pointwise<D>,
        cell: usize,
        y: &[f64],
        force: &mut [f64],
    ) -> Result<f64, Inverted> {
        wide(
            #[inline(always)]
            || {
                self.integrate(
                    cell,
                    [y],
                    #[inline(always)]
                    |[h], count, stress, _| law.stresses(h, count, stress),
                    force,
                    None,
                )
            },
        )
    }

    /// Force and tangent of a law; returns the energy.
    pub(super) fn tangent_of(
        &self,
        law: &dyn Pointwise<D>,
        cell: usize,
        y: &[f64],
        force: &mut [f64],
        tangent: &mut [f64],
    ) -> Result<f64, Inverted> {
        wide(
            #[inline(always)]
            || {
                self.integrate(
                    cell,
                    [y],
                    #[inline(always)]
                    |[h], count, stress, moduli| law.tangents(h, count, stress, moduli),
                    force,
                    Some(tangent),
                )
            },
        )
    }

    /// Discrete gradient of a law; returns the energy at the end.
    pub(super) fn between_of(
        &self,
        law: &dyn Pointwise<D>,
        cell: usize,
        ends: [&[f64]; 2],
        force: &mut [f64],
    ) -> Result<f64, Inverted> {
        wide(
            #[inline(always)]
            || {
                self.integrate(
                    cell,
                    ends,
                    #[inline(always)]
                    |[start, end], count, stress, _| law.between([start, end], count, stress),
                    force,
                    None,
                )
            },
        )
    }

    /// Product of the tangent of a law, or of its discrete gradient, and a change.
    pub(super) fn product_of(
        &self,
        law: &dyn Pointwise<D>,
        cell: usize,
        before: Option<&[f64]>,
        [y, change]: [&[f64]; 2],
        product: &mut [f64],
    ) -> Result<(), Inverted> {
        wide(
            #[inline(always)]
            || match before {
                None => self.differentiate(
                    cell,
                    [y],
                    change,
                    #[inline(always)]
                    |[h], dh, count| law.increments(h, dh, count),
                    product,
                ),
                Some(before) => self.differentiate(
                    cell,
                    [before, y],
                    change,
                    #[inline(always)]
                    |[start, end], dh, count| law.increments_between([start, end], dh, count),
                    product,
                ),
            },
        )
    }

    /// Forces of the stress increments `at(h, dh, count)` in lanes, from the gradients of fields
    /// and of an increment of the last.
    #[inline(always)]
    fn differentiate<const M: usize>(
        &self,
        cell: usize,
        fields: [&[f64]; M],
        change: &[f64],
        at: impl Fn(&[Mats<D>; M], &Mats<D>, usize) -> Result<Mats<D>, NotPositive>,
        product: &mut [f64],
    ) -> Result<(), Inverted> {
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
        for points in &self.points[points.clone()] {
            let mut gradients = [[[[0.0; LANES]; D]; D]; M];
            for m in 0..M {
                gradients[m] = points.gradient(&u[m], inverse);
            }
            let mut stresses = at(&gradients, &points.gradient(&du, inverse), points.count)
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
