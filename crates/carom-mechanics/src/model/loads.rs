//! Loads as nodal forces f_ext(y, t) without constant gravity: dead tractions, body forces and
//! weights under a gravity that varies, which depend on time only, and follower pressures, which
//! rotate with the side (`carom_solid::LoadedSide`). A manufactured motion adds its own load.

use carom_formula::Formula;
use carom_solid::LoadedSide;

use super::body_instance::BodyInstance;
use super::formulas::{NoValue, values};
use super::manufactured::Manufactured;

/// A factor over time.
pub type Amplitude = Box<dyn Fn(f64) -> f64 + Send + Sync>;

/// All loads of a model.
#[derive(Default)]
pub struct Loads {
    tractions: Vec<Load<LoadedSide>>,
    pressures: Vec<Load<LoadedSide>>,
    body_forces: Vec<Load<InBody>>,
    weights: Vec<Load<Weight>>,
    /// The manufactured motion, if any.
    pub manufactured: Option<Manufactured>,
}

/// A load: where it acts, its components as formulas of position and time, its label.
pub struct Load<On> {
    /// A side, a body, or the masses of one.
    pub on: On,
    /// Components; one for a pressure.
    pub value: Vec<Formula>,
    /// Name in messages.
    pub label: String,
    /// Factor over time; none means 1.
    pub amplitude: Option<Amplitude>,
}

/// A body, or the cells of one of its regions.
#[derive(Clone, Copy, Debug)]
pub struct InBody {
    /// Index of the body.
    pub part: usize,
    /// The region; none: the whole body.
    pub region: Option<usize>,
}

/// The masses that a varying gravity acts on, from a node onwards: row sums of the mass matrix.
pub struct Weight {
    /// The first node.
    pub first_node: usize,
    /// Mass of this node, and of those after it.
    pub masses: Vec<f64>,
}

impl<On> Load<On> {
    fn factor(&self, time: f64) -> f64 {
        self.amplitude.as_ref().map_or(1.0, |amplitude| amplitude(time))
    }

    /// The components at many places, times the factor, place after place.
    fn vectors<'a>(
        &self,
        places: &(impl Iterator<Item = &'a [f64]> + Clone),
        time: f64,
    ) -> Result<Vec<f64>, NoValue> {
        let factor = self.factor(time);
        let d = self.value.len();
        let mut vectors = Vec::new();
        for (i, formula) in self.value.iter().enumerate() {
            let values = values(formula, &self.label, places.clone(), time)?;
            vectors.resize(values.len() * d, 0.0);
            vectors.chunks_exact_mut(d).zip(values).for_each(|(vector, value)| vector[i] = factor * value);
        }
        Ok(vectors)
    }
}

/// Loads at one time, without their dependence on positions.
#[derive(Clone, Debug, Default)]
pub struct LoadsAt {
    /// Nodal forces of the dead loads, flat.
    dead: Vec<f64>,
    /// Pressures at the quadrature points of each pressure's side.
    pressures: Vec<Vec<f64>>,
}

impl Loads {
    /// Adds a dead traction per reference area.
    pub fn add_traction(&mut self, load: Load<LoadedSide>) {
        self.tractions.push(load);
    }

    /// Adds a pressure per current area, against the outward normal.
    pub fn add_pressure(&mut self, load: Load<LoadedSide>) {
        self.pressures.push(load);
    }

    /// Adds a dead force per reference volume of a body.
    pub fn add_body_force(&mut self, load: Load<InBody>) {
        self.body_forces.push(load);
    }

    /// Adds the weight of a body under gravity given by formulas in time alone.
    pub fn add_weight(&mut self, load: Load<Weight>) {
        self.weights.push(load);
    }

    /// Whether there are no loads.
    pub fn is_empty(&self) -> bool {
        self.tractions.is_empty()
            && self.pressures.is_empty()
            && self.body_forces.is_empty()
            && self.weights.is_empty()
            && self.manufactured.is_none()
    }

    /// Whether any depend on the positions.
    pub fn follow_sides(&self) -> bool {
        !self.pressures.is_empty()
    }

    /// Evaluates all formulas and tables at a time; `out` is reused.
    ///
    /// # Errors
    /// The first formula without a finite value.
    pub fn at(
        &self,
        parts: &[BodyInstance],
        dofs: usize,
        time: f64,
        out: &mut LoadsAt,
    ) -> Result<(), NoValue> {
        out.dead.clear();
        out.dead.resize(dofs, 0.0);
        for load in &self.tractions {
            let tractions = load.vectors(&load.on.positions(), time)?;
            load.on.add_traction(tractions.chunks_exact(load.value.len()), &mut out.dead);
        }
        for load in &self.body_forces {
            let InBody { part, region } = load.on;
            let part = &parts[part];
            let places = part.volume_points(region);
            let d = load.value.len();
            let densities = load.vectors(&places.chunks_exact(d), time)?;
            let mut densities = densities.chunks_exact(d);
            let density = |_: usize, _: &[f64], out: &mut [f64]| {
                densities.next().into_iter().for_each(|density| out.copy_from_slice(density));
                Ok(())
            };
            part.add_body_force(region, density, &mut out.dead)?;
        }
        for load in &self.weights {
            let gravity = load.vectors(&std::iter::once(&[][..]), time)?;
            let first = load.on.first_node * gravity.len();
            let nodes = out.dead[first..].chunks_exact_mut(gravity.len()).zip(&load.on.masses);
            for (force, mass) in nodes {
                force.iter_mut().zip(&gravity).for_each(|(force, g)| *force += mass * g);
            }
        }
        if let Some(motion) = &self.manufactured {
            motion.add_load(parts, time, &mut out.dead)?;
        }
        out.pressures.resize_with(self.pressures.len(), Vec::new);
        for (load, pressures) in self.pressures.iter().zip(&mut out.pressures) {
            *pressures = load.vectors(&load.on.positions(), time)?;
        }
        Ok(())
    }

    /// Overwrites `force` with f_ext at positions `y`.
    pub fn force_into(&self, at: &LoadsAt, y: &[f64], force: &mut [f64]) {
        force.copy_from_slice(&at.dead);
        for (load, pressure) in self.pressures.iter().zip(&at.pressures) {
            load.on.add_pressure(pressure, y, force);
        }
    }

    /// Calls `visit(nodes, tangent)` for every facet under pressure, tangent = ∂f_ext/∂y (`(n·D)²`,
    /// row-major) at positions `y`; zero without `at`.
    pub(crate) fn each_facet_tangent(
        &self,
        dimension: usize,
        at: Option<(&LoadsAt, &[f64])>,
        mut visit: impl FnMut(&[usize], &[f64]),
    ) {
        let mut tangent = Vec::new();
        for (k, load) in self.pressures.iter().enumerate() {
            for (facet, nodes) in load.on.facets().iter().enumerate() {
                tangent.clear();
                tangent.resize((nodes.len() * dimension).pow(2), 0.0);
                if let Some((at, y)) = at {
                    load.on.facet_tangent(facet, &at.pressures[k], y, &mut tangent);
                }
                visit(nodes, &tangent);
            }
        }
    }
}
