//! Cells with constant strain, simplices of degree 1: they have one quadrature point, and four
//! cells are computed at once. Each lane gives the bits of its cell alone.

use carom_algebra::{Four, Mat, wide};

use super::Solid;
use crate::body::{Inverted, one_by_one};
use crate::points::LANES;
use crate::shape::{Domain, Shape};

impl<const D: usize, const N: usize, S: Shape<D, N>> Solid<D, N, S> {
    /// Whether F is constant in every cell.
    pub(super) const HAS_CONSTANT_STRAIN: bool = S::DEGREE == 1 && !S::Domain::TENSOR;

    /// [`Body::cell_forces`](crate::Body::cell_forces) of cells with constant strain.
    pub(super) fn constant_forces(
        &self,
        first: usize,
        y: &[f64],
        forces: &mut [f64],
        energies: &mut [f64],
    ) -> Result<(), Inverted> {
        let blocks = forces.chunks_mut(LANES * N * D).zip(energies.chunks_mut(LANES));
        for (block, (forces, energies)) in blocks.enumerate() {
            let cells = first + block * LANES;
            let valid = wide(
                #[inline(always)]
                || self.forces_of_four(cells, y, forces, energies),
            );
            if !valid {
                // One by one, to find it.
                one_by_one(self, cells, y, forces, energies)?;
            }
        }
        Ok(())
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

    /// Forces and energies of up to four cells; returns false if one is inverted.
    #[inline(always)]
    fn forces_of_four(&self, first: usize, y: &[f64], forces: &mut [f64], energies: &mut [f64]) -> bool {
        let count = energies.len();
        let (mut local, mut maps) = ([[[0.0; LANES]; D]; D], [[[0.0; LANES]; D]; D]);
        let mut weights = [0.0; LANES];
        // The first lane has the gradients and the weight of the one point.
        let point = &self.points[0];
        for l in 0..count {
            let (place, u) = (&self.places[first + l], self.displacements(first + l, y));
            weights[l] = place.volume * point.weights[0];
            for i in 0..D {
                for j in 0..D {
                    maps[i][j][l] = place.inverse.0[i][j];
                    let mut sum = 0.0;
                    for a in 0..N {
                        sum += u[a][i] * point.gradients[a][j][0];
                    }
                    local[i][j][l] = sum;
                }
            }
        }
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
        let mut stresses = [[[0.0; LANES]; D]; D];
        let Ok(densities) = self.law.stresses(&h, count, &mut stresses) else { return false };
        let mut pulled = [[[0.0; LANES]; D]; D];
        for i in 0..D {
            for j in 0..D {
                for k in 0..D {
                    for l in 0..LANES {
                        pulled[i][j][l] += stresses[i][k][l] * weights[l] * maps[j][k][l];
                    }
                }
            }
        }
        for a in 0..N {
            for i in 0..D {
                let mut sum = [0.0; LANES];
                for j in 0..D {
                    for l in 0..LANES {
                        sum[l] += pulled[i][j][l] * point.gradients[a][j][0];
                    }
                }
                for l in 0..count {
                    forces[l * N * D + a * D + i] = sum[l];
                }
            }
        }
        for l in 0..count {
            energies[l] = weights[l] * densities[l];
        }
        true
    }
}
