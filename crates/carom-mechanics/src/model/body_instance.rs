//! A body instance: a body with its nodes and dofs in the numbering of the model.

use carom_solid::Body;

use super::formulas::NoValue;

/// A body and its position among the global nodes.
pub struct BodyInstance {
    /// Name in the case.
    pub name: String,
    /// Global number of its first node.
    pub first_node: usize,
    /// The body: forces, masses and stresses at given positions.
    pub body: Box<dyn Body>,
    /// Total mass.
    pub total_mass: f64,
    /// Mass of its first node beyond that of its cells; only the carrier of a rigid obstacle, which
    /// has no cells, has one.
    pub point_mass: f64,
    /// Global dofs of its cells, cell after cell.
    dofs: Vec<u32>,
}

impl BodyInstance {
    /// A body whose nodes are numbered from `first_node` on.
    pub fn new(name: String, first_node: usize, body: Box<dyn Body>) -> Self {
        let mesh = body.mesh();
        let (d, mut volumes) = (mesh.dimension(), vec![0.0; mesh.element.nodes()]);
        let mut volume = 0.0;
        for cell in 0..mesh.cell_count() {
            body.cell_volumes(cell, &mut volumes);
            volume += volumes.iter().sum::<f64>();
        }
        let total_mass = volume * body.density();
        let dofs =
            mesh.cells.iter().flat_map(|node| (0..d).map(move |i| ((first_node + node) * d + i) as u32));
        let dofs = dofs.collect();
        Self { name, first_node, body, total_mass, point_mass: 0.0, dofs }
    }

    /// The nodes that carry a rigid obstacle, the first one with a mass ≥ 0: a body without cells.
    pub fn rigid(name: String, first_node: usize, body: Box<dyn Body>, mass: f64) -> Self {
        Self { point_mass: mass, total_mass: mass, ..Self::new(name, first_node, body) }
    }

    /// Whether it carries a rigid obstacle.
    pub fn is_rigid(&self) -> bool {
        self.body.mesh().cells.is_empty()
    }

    /// Whether its density is zero: its balance is enforced at s + 1, without inertia.
    pub fn is_massless(&self) -> bool {
        self.body.density() == 0.0 && self.point_mass == 0.0
    }

    /// Global numbers of its nodes.
    pub fn nodes(&self) -> std::ops::Range<usize> {
        self.first_node..self.first_node + self.body.mesh().nodes.len()
    }

    /// Its section of a vector over all nodes.
    pub fn of<'a>(&self, all: &'a [f64]) -> &'a [f64] {
        let (nodes, d) = (self.nodes(), self.body.mesh().dimension());
        &all[nodes.start * d..nodes.end * d]
    }

    /// Its section of a vector over all nodes, to be changed.
    pub fn of_mut<'a>(&self, all: &'a mut [f64]) -> &'a mut [f64] {
        let (nodes, d) = (self.nodes(), self.body.mesh().dimension());
        &mut all[nodes.start * d..nodes.end * d]
    }

    /// Global dofs of a cell, node-major.
    pub fn cell_dofs(&self, cell: usize) -> &[u32] {
        let n = self.body.mesh().element.dofs();
        &self.dofs[cell * n..(cell + 1) * n]
    }

    /// The points at which a force per reference volume is evaluated, flat.
    pub(super) fn volume_points(&self) -> Vec<f64> {
        let mut points = Vec::new();
        for cell in 0..self.body.mesh().cell_count() {
            self.body.each_volume_point(cell, &mut |_, place, _| points.extend_from_slice(place));
        }
        points
    }

    /// fᵃ += ∫φᵃ b dΩ₀ with b per reference volume, flat over all nodes.
    ///
    /// # Errors
    /// The first point where b has no value.
    pub(super) fn add_body_force(
        &self,
        mut density: impl FnMut(&[f64], &mut [f64]) -> Result<(), NoValue>,
        force: &mut [f64],
    ) -> Result<(), NoValue> {
        let mesh = self.body.mesh();
        let d = mesh.dimension();
        let (mut local, mut b) = (vec![0.0; mesh.element.dofs()], vec![0.0; d]);
        let mut failure = Ok(());
        for cell in 0..mesh.cell_count() {
            local.fill(0.0);
            self.body.each_volume_point(cell, &mut |shape, place, volume| {
                if failure.is_ok() {
                    failure = density(place, &mut b);
                }
                for (local, phi) in local.chunks_exact_mut(d).zip(shape) {
                    local.iter_mut().zip(&b).for_each(|(f, b)| *f += phi * volume * b);
                }
            });
            self.body.add_cells(cell, &local, self.of_mut(force));
        }
        failure
    }
}
