//! Cells with constant strain, simplices of degree 1: they have one quadrature point, and four
//! cells are computed at once. Each lane gives the bits of its cell alone.

use std::ops::Range;

use carom_algebra::{Four, Mat, wide};

use super::Solid;
use crate::body::Inverted;
use crate::material::Past;
use crate::points::{LANES, Lanes, Mats, Packed, get, lanes, set};
use crate::shape::{Domain, Shape};

impl<const D: usize, const N: usize, S: Shape<D, N>> Solid<D, N, S> {
    /// Whether F is constant in every cell.
    pub(super) const HAS_CONSTANT_STRAIN: bool = S::DEGREE == 1 && !S::Domain::TENSOR;

    /// Forces and energies of consecutive cells with constant strain. Returns their smallest J.
    pub(super) fn constant_forces(
        &self,
        first: usize,
        y: &[f64],
        forces: &mut [f64],
        energies: &mut [f64],
    ) -> Result<f64, Inverted> {
        if !first.is_multiple_of(LANES) {
            return self.one_by_one(first, y, forces, energies);
        }
        let mut least = f64::INFINITY;
        let blocks = forces.chunks_mut(LANES * N * D).zip(energies.chunks_mut(LANES));
        for (block, (forces, energies)) in blocks.enumerate() {
            let cells = first + block * LANES;
            let found = wide(
                #[inline(always)]
                || self.forces_of_four(cells, y, forces, energies),
            );
            least = least.min(match found {
                Some(det_f) => det_f,
                // One by one, to find the inverted one.
                None => self.one_by_one(cells, y, forces, energies)?,
            });
        }
        Ok(least)
    }

    /// Forces and energies of cells, one after the other. Returns their smallest J.
    fn one_by_one(
        &self,
        first: usize,
        y: &[f64],
        forces: &mut [f64],
        energies: &mut [f64],
    ) -> Result<f64, Inverted> {
        let mut least = f64::INFINITY;
        for (k, (force, energy)) in forces.chunks_exact_mut(N * D).zip(energies).enumerate() {
            *energy = self.force(first + k, y, force)?;
            least = least.min(self.cell_min_det_f(first + k, y, &Past::default()));
        }
        Ok(least)
    }

    /// [`Body::cell_margins`](crate::Body::cell_margins) of up to four cells with constant strain;
    /// returns false if one is not certified.
    pub(super) fn constant_margins(&self, first: usize, y: &[f64], margins: &mut [f64]) -> bool {
        let y = y.as_chunks::<D>().0;
        wide(
            #[inline(always)]
            || {
                let mut edges = Mat::<D, Four>::ZERO;
                for l in 0..LANES {
                    // The last cell again in lanes that are left over.
                    let nodes = self.nodes(first + l.min(margins.len() - 1));
                    for i in 0..D {
                        for j in 0..D {
                            edges.0[i][j].0[l] = y[nodes[i + 1]][j] - y[nodes[0]][j];
                        }
                    }
                }
                let found = self.validity.margin_of_edges(&edges);
                if let Some(found) = &found {
                    margins.iter_mut().zip(found.0).for_each(|(margin, found)| *margin = found);
                }
                found.is_some()
            },
        )
    }

    /// The maps and weights of four cells from the first of every block on.
    pub(super) fn pack_constant(&mut self) {
        if !Self::HAS_CONSTANT_STRAIN {
            return;
        }
        let weight = self.points[0].weights[0];
        let blocks = self.places.chunks(LANES).map(|places| {
            let mut packed = Packed { maps: [[[0.0; LANES]; D]; D], weights: [0.0; LANES] };
            for (l, place) in places.iter().enumerate() {
                set(&mut packed.maps, l, &place.inverse);
                packed.weights[l] = place.volume * weight;
            }
            packed
        });
        self.packed = blocks.collect();
    }

    /// Energy densities and stresses of up to four cells, each by the law of its region; none if
    /// one is inverted.
    #[inline(always)]
    fn stresses_of_four(&self, first: usize, count: usize, h: &Mats<D>) -> Option<(Lanes, Mats<D>)> {
        let region = self.mesh.region(first);
        let alike = self.mesh.regions.is_empty()
            || (first..first + count).all(|cell| self.mesh.region(cell) == region);
        if alike {
            let found = self.media[region].law.stresses(h, &Past::default(), count, &mut []).ok()?;
            return Some((found.stored.0, lanes(&found.stress)));
        }
        let mut densities = [0.0; LANES];
        let mut stresses = [[[0.0; LANES]; D]; D];
        for (region, medium) in self.media.iter().enumerate() {
            // H = 0, which every law admits, in the lanes of other regions.
            let mut own = [[[0.0; LANES]; D]; D];
            let is_own = |l: &usize| self.mesh.region(first + l) == region;
            (0..count).filter(is_own).for_each(|l| set(&mut own, l, &get(h, l)));
            let found = medium.law.stresses(&own, &Past::default(), count, &mut []).ok()?;
            for l in (0..count).filter(is_own) {
                densities[l] = found.stored.0[l];
                set(&mut stresses, l, &get(&lanes(&found.stress), l));
            }
        }
        Some((densities, stresses))
    }

    /// H of up to four cells, those of a packed block.
    #[inline(always)]
    fn gradients_of_four(&self, first: usize, count: usize, y: &[f64]) -> Mats<D> {
        let reference = self.mesh.nodes.of_dimension::<D>();
        let y = y.as_chunks::<D>().0;
        let cells = &self.mesh.cells.as_chunks::<N>().0[first..first + count];
        let mut u = [[[0.0; LANES]; D]; N];
        for l in 0..LANES {
            // The last cell again in lanes that are left over.
            let nodes = &cells[l.min(count - 1)];
            for a in 0..N {
                let now = &y[nodes[a]];
                let before = &reference[nodes[a]];
                for i in 0..D {
                    u[a][i][l] = now[i] - before[i];
                }
            }
        }
        // ∂u/∂ξ: the edges from the first node, by the lengths of those of the reference cell.
        let gradients = &self.points[0].gradients;
        let mut local = [[[0.0; LANES]; D]; D];
        for i in 0..D {
            for j in 0..D {
                for l in 0..LANES {
                    local[i][j][l] = (u[j + 1][i][l] - u[0][i][l]) * gradients[j + 1][j][0];
                }
            }
        }
        let maps = &self.packed[first / LANES].maps;
        let mut h = [[[0.0; LANES]; D]; D];
        for i in 0..D {
            for j in 0..D {
                for k in 0..D {
                    for l in 0..LANES {
                        h[i][j][l] += local[i][k][l] * maps[k][j][l];
                    }
                }
            }
        }
        h
    }

    /// Smallest J of consecutive cells, of which the first is that of a packed block.
    pub(super) fn constant_min_det_f(&self, cells: Range<usize>, y: &[f64]) -> f64 {
        let of_block = |first: usize| {
            let count = LANES.min(cells.end - first);
            let h = wide(
                #[inline(always)]
                || self.gradients_of_four(first, count, y),
            );
            self.min_det_f_of_four(first, count, &h)
        };
        cells.clone().step_by(LANES).map(of_block).fold(f64::INFINITY, f64::min)
    }

    /// Smallest J of up to four cells.
    #[inline(always)]
    fn min_det_f_of_four(&self, first: usize, count: usize, h: &Mats<D>) -> f64 {
        let region = self.mesh.region(first);
        let mut ratios = self.media[region].law.volume_ratios(h);
        for l in (0..count).filter(|l| self.mesh.region(first + l) != region) {
            ratios[l] = self.medium(first + l).law.volume_ratio_at(&get(h, l), &Past::default());
        }
        ratios[..count].iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Forces and energies of up to four cells, those of a packed block. Returns their smallest J;
    /// none if one is inverted.
    #[inline(always)]
    fn forces_of_four(
        &self,
        first: usize,
        y: &[f64],
        forces: &mut [f64],
        energies: &mut [f64],
    ) -> Option<f64> {
        let count = energies.len();
        let gradients = &self.points[0].gradients;
        let Packed { maps, weights } = &self.packed[first / LANES];
        let h = self.gradients_of_four(first, count, y);
        let (densities, stresses) = self.stresses_of_four(first, count, &h)?;
        let mut pulled = [[[0.0; LANES]; D]; D];
        for i in 0..D {
            for j in 0..D {
                for k in 0..D {
                    for l in 0..LANES {
                        pulled[i][j][l] += stresses[i][k][l] * weights[l] * maps[j][k][l];
                    }
                }
                for l in 0..LANES {
                    pulled[i][j][l] *= gradients[j + 1][j][0];
                }
            }
        }
        for i in 0..D {
            let mut first = [0.0; LANES];
            for j in 0..D {
                for l in 0..LANES {
                    first[l] -= pulled[i][j][l];
                }
            }
            for l in 0..count {
                forces[l * N * D + i] = first[l];
                for j in 0..D {
                    forces[l * N * D + (j + 1) * D + i] = pulled[i][j][l];
                }
            }
        }
        for l in 0..count {
            energies[l] = weights[l] * densities[l];
        }
        Some(self.min_det_f_of_four(first, count, &h))
    }
}
