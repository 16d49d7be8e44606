//! Cells of laws with memory: forces, tangents, and differentials of forces, from the memory of
//! each quadrature point at the start of a step.

use carom_algebra::{Vector, wide};

use super::integrals::{scale, spread};
use super::{Place, Solid};
use crate::body::{Ask, Configuration, Inverted};
use crate::material::{Evolution, Evolved, ModuliMats, NotPositive, Past, Pointwise};
use crate::points::{Blocks, LANES, sum};
use crate::shape::Shape;

/// Energy that a cell stores, and energy that it dissipates in a step.
#[derive(Clone, Copy, Default)]
pub(super) struct Energies {
    pub(super) stored: f64,
    pub(super) dissipated: f64,
}

/// Results of a cell: what it remembers, unless that is empty, its force or a change of it, and its
/// tangent.
struct Out<'a> {
    memory: &'a mut [f64],
    force: &'a mut [f64],
    tangent: Option<&'a mut [f64]>,
}

impl<const D: usize, const N: usize, S: Shape<D, N>> Solid<D, N, S> {
    /// Count of numbers of the cell with the most: those of all its points, of the law that
    /// remembers most.
    pub(super) fn memory_of_cells(&self) -> usize {
        let of_point = self.media.iter().map(|medium| medium.law.memory()).max().unwrap_or(0);
        let has = |curved: bool| usize::from(self.curved.contains(&curved));
        let points =
            [false, true].map(|curved| has(curved) * self.force_rules[usize::from(curved)].points.len());
        of_point * points[0].max(points[1])
    }

    /// Response of a cell of a law with memory; the energies of a product are zero.
    pub(super) fn evolve(
        &self,
        law: &dyn Pointwise<D>,
        cell: usize,
        at: &Configuration,
        ask: Ask,
        numbers: &mut [f64],
        memory: &mut [f64],
    ) -> Result<Energies, Inverted> {
        // A law may use fewer numbers than the body has for a cell: the others are zero.
        memory.fill(0.0);
        // At the start of a run nothing is remembered.
        let none = if at.past.memory.is_empty() { vec![0.0; self.memory] } else { Vec::new() };
        let virgin = Past { memory: &none, dt: at.past.dt };
        let past = if at.past.memory.is_empty() { virgin } else { at.past.part(cell, self.memory) };
        let at = Configuration { past, ..*at };
        let (force, tangent) = numbers.split_at_mut(N * D);
        let change = match ask {
            Ask::Product(change) => Some(self.vectors(cell, change)),
            _ => None,
        };
        wide(
            #[inline(always)]
            || match ask {
                Ask::Tangent => {
                    self.evolve_points(law, cell, &at, None, Out { memory, force, tangent: Some(tangent) })
                }
                _ => self.evolve_points(law, cell, &at, change, Out { memory, force, tangent: None }),
            },
        )
    }

    /// The points of a cell, with the memory of the cell alone.
    #[inline(always)]
    fn evolve_points(
        &self,
        law: &dyn Pointwise<D>,
        cell: usize,
        at: &Configuration,
        change: Option<[Vector<D>; N]>,
        out: Out,
    ) -> Result<Energies, Inverted> {
        let Out { memory, force, tangent } = out;
        let size = law.memory();
        let u = self.displacements(cell, at.y);
        let start = at.before.map(|before| self.displacements(cell, before));
        let mut f = [[[0.0; LANES]; D]; N];
        let mut blocks: Blocks<D, N> = [[[[[0.0; LANES]; D]; D]; N]; N];
        let mut moduli: ModuliMats<D> = [[[[[0.0; LANES]; D]; D]; D]; D];
        let mut energies = Energies::default();
        let Place { points, inverse, volume } = &self.places[cell];
        for (k, points) in self.points[points.clone()].iter().enumerate() {
            let first = k * LANES;
            let own = first * size..(first + points.count) * size;
            let step = Evolution {
                before: start.as_ref().map(|start| points.gradient(start, inverse)),
                h: points.gradient(&u, inverse),
                count: points.count,
                past: Past { memory: &at.past.memory[own.clone()], dt: at.past.dt },
                change: change.as_ref().map(|change| points.gradient(change, inverse)),
            };
            let mut out = Evolved {
                stored: [0.0; LANES],
                dissipated: [0.0; LANES],
                stress: [[[0.0; LANES]; D]; D],
                moduli: tangent.is_some().then_some(&mut moduli),
                memory: memory.get_mut(own).unwrap_or(&mut []),
            };
            law.evolve(&step, &mut out).map_err(|NotPositive(det_f)| Inverted { cell, det_f })?;
            let weights = points.weights.map(|weight| volume * weight);
            for l in 0..points.count {
                energies.stored += weights[l] * out.stored[l];
                energies.dissipated += weights[l] * out.dissipated[l];
            }
            scale(&mut out.stress, &weights);
            points.add_force(&out.stress, inverse, &mut f);
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

    /// Vectors at the nodes of a cell from those at all nodes.
    #[inline(always)]
    fn vectors(&self, cell: usize, all: &[f64]) -> [Vector<D>; N] {
        let all = all.as_chunks::<D>().0;
        self.nodes(cell).map(|node| Vector(all[node]))
    }
}
