//! Sums over the quadrature points of a cell: forces, tangents, and differentials of forces.

use carom_algebra::{Mat, Vector};

use super::{Place, Solid};
use crate::body::Inverted;
use crate::discrete_gradient::{between, change_between};
use crate::material::{Material, NotPositive, moduli_of};
use crate::points::{Blocks, LANES, Mats, Moduli, get, set, set_moduli, sum};
use crate::shape::Shape;

impl<const D: usize, const N: usize, S: Shape<D, N>, L: Material<D>> Solid<D, N, S, L> {
    /// Forces and, if requested, the tangent of a cell from `at(h)` for the gradients H of several
    /// displacement fields at a point: energy, P and the moduli.
    #[inline(always)]
    fn integrate<const M: usize>(
        &self,
        cell: usize,
        fields: [&[f64]; M],
        at: impl Fn([Mat<D>; M], bool) -> Result<(f64, Mat<D>, Option<Moduli<D>>), NotPositive>,
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
            for l in 0..points.count {
                let w = volume * points.weights[l];
                let mut h = [Mat::ZERO; M];
                for m in 0..M {
                    h[m] = get(&gradients[m], l);
                }
                let (density, stress, of_point) =
                    at(h, tangent.is_some()).map_err(|NotPositive(det_f)| Inverted { cell, det_f })?;
                energy += w * density;
                set(&mut stresses, l, &stress, w);
                if let Some(of_point) = of_point {
                    set_moduli(&mut moduli, l, &of_point, w);
                }
            }
            points.add_force(&stresses, inverse, &mut f);
            if tangent.is_some() {
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

    /// `integrate` with a law in one configuration.
    #[inline(always)]
    pub(super) fn integrate_at<M: Material<D>>(
        &self,
        law: &M,
        cell: usize,
        y: &[f64],
        force: &mut [f64],
        tangent: Option<&mut [f64]>,
    ) -> Result<f64, Inverted> {
        self.integrate(
            cell,
            [y],
            #[inline(always)]
            |[h], with_moduli| {
                let point = law.at(&h)?;
                let moduli = with_moduli.then(|| moduli_of(law, &point));
                Ok((law.energy(&point), law.stress(&point), moduli))
            },
            force,
            tangent,
        )
    }

    /// `integrate` with the discrete gradient between two configurations, forces only.
    #[inline(always)]
    pub(super) fn integrate_between<M: Material<D>>(
        &self,
        law: &M,
        cell: usize,
        ends: [&[f64]; 2],
        force: &mut [f64],
    ) -> Result<f64, Inverted> {
        self.integrate(
            cell,
            ends,
            #[inline(always)]
            |[start, end], _| {
                let (energy, stress) = between(law, [&start, &end])?;
                Ok((energy, stress, None))
            },
            force,
            None,
        )
    }

    /// Derivative of [`Self::integrate_at`] or, with `before`, of [`Self::integrate_between`] along
    /// `change`.
    #[inline(always)]
    pub(super) fn product<M: Material<D>>(
        &self,
        law: &M,
        cell: usize,
        before: Option<&[f64]>,
        [y, change]: [&[f64]; 2],
        product: &mut [f64],
    ) -> Result<(), Inverted> {
        let Some(before) = before else {
            return self.differentiate(
                cell,
                [y],
                change,
                #[inline(always)]
                |[h], dh, count| law.changes(h, dh, count),
                product,
            );
        };
        self.differentiate(
            cell,
            [before, y],
            change,
            #[inline(always)]
            |[start, end], dh, count| {
                let mut changes = [[[0.0; LANES]; D]; D];
                for l in 0..count {
                    let ends = [&get(start, l), &get(end, l)];
                    set(&mut changes, l, &change_between(law, ends, &get(dh, l))?, 1.0);
                }
                Ok(changes)
            },
            product,
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
        let (nodes, change) = (self.nodes(cell), change.as_chunks::<D>().0);
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
            for i in 0..D {
                for j in 0..D {
                    for l in 0..LANES {
                        stresses[i][j][l] *= volume * points.weights[l];
                    }
                }
            }
            points.add_force(&stresses, inverse, &mut f);
        }
        for (product, f) in product.iter_mut().zip(f.as_flattened()) {
            *product = sum(f);
        }
        Ok(())
    }
}

/// Both triangles of a symmetric matrix from the blocks a ≤ b.
#[inline(always)]
fn spread<const D: usize, const N: usize>(blocks: &Blocks<D, N>, tangent: &mut [f64]) {
    for b in 0..N {
        for a in 0..=b {
            for i in 0..D {
                for j in 0..D {
                    let (row, column, value) = (a * D + i, b * D + j, sum(&blocks[b][a][i][j]));
                    tangent[row * N * D + column] = value;
                    tangent[column * N * D + row] = value;
                }
            }
        }
    }
}
