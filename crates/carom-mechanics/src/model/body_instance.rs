//! A body instance: a body with its nodes and dofs in the numbering of the model.

use std::sync::OnceLock;

use carom_solid::{Body, Bounds, Facet};

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
    /// Boundary of the body, found on the first query.
    skin: OnceLock<Vec<Facet>>,
}

impl BodyInstance {
    /// A body whose nodes are numbered from `first_node` on.
    pub fn new(name: String, first_node: usize, body: Box<dyn Body>) -> Self {
        let mesh = body.mesh();
        let d = mesh.dimension();
        let total_mass = total_mass(&*body);
        let dofs =
            mesh.cells.iter().flat_map(|node| (0..d).map(move |i| ((first_node + node) * d + i) as u32));
        let dofs = dofs.collect();
        Self { name, first_node, body, total_mass, point_mass: 0.0, dofs, skin: OnceLock::new() }
    }

    /// The nodes that carry a rigid obstacle, the first one with a mass ≥ 0: a body without cells.
    pub fn rigid(name: String, first_node: usize, body: Box<dyn Body>, mass: f64) -> Self {
        Self { point_mass: mass, total_mass: mass, ..Self::new(name, first_node, body) }
    }

    /// Whether it carries a rigid obstacle.
    pub fn is_rigid(&self) -> bool {
        self.body.mesh().cells.is_empty()
    }

    /// Whether the density of all its cells is zero: its balance is enforced at s + 1, without
    /// inertia.
    pub fn is_massless(&self) -> bool {
        let cells = 0..self.body.mesh().cell_count();
        self.point_mass == 0.0 && cells.into_iter().all(|cell| self.body.density(cell) == 0.0)
    }

    /// The whole boundary of the body, [`Mesh::skin`](carom_solid::Mesh::skin).
    pub fn skin(&self) -> &[Facet] {
        self.skin.get_or_init(|| self.body.mesh().skin())
    }

    /// Whether each of its nodes lies on its boundary.
    pub fn on_boundary(&self) -> Vec<bool> {
        self.body.mesh().nodes_of(self.skin())
    }

    /// Count of numbers that its materials remember.
    pub fn memory(&self) -> usize {
        self.body.memory() * self.body.mesh().cell_count()
    }

    /// Cells of the body, or of one of its regions.
    pub(super) fn cells(&self, region: Option<usize>) -> impl Iterator<Item = usize> {
        let mesh = self.body.mesh();
        (0..mesh.cell_count()).filter(move |&cell| region.is_none_or(|region| mesh.region(cell) == region))
    }

    /// Global numbers of its nodes.
    pub fn nodes(&self) -> std::ops::Range<usize> {
        self.first_node..self.first_node + self.body.mesh().nodes.len()
    }

    /// Its section of a vector over all nodes.
    pub fn of<'a>(&self, all: &'a [f64]) -> &'a [f64] {
        let nodes = self.nodes();
        let d = self.body.mesh().dimension();
        &all[nodes.start * d..nodes.end * d]
    }

    /// Its section of a vector over all nodes, to be changed.
    pub fn of_mut<'a>(&self, all: &'a mut [f64]) -> &'a mut [f64] {
        let nodes = self.nodes();
        let d = self.body.mesh().dimension();
        &mut all[nodes.start * d..nodes.end * d]
    }

    /// Global dofs of a cell, node-major.
    pub fn cell_dofs(&self, cell: usize) -> &[u32] {
        let n = self.body.mesh().element.dofs();
        &self.dofs[cell * n..(cell + 1) * n]
    }

    /// The points at which a force per reference volume of a region, or of the whole body, is
    /// evaluated, flat.
    pub(super) fn volume_points(&self, region: Option<usize>) -> Vec<f64> {
        let mut points = Vec::new();
        for cell in self.cells(region) {
            self.body.each_volume_point(cell, &mut |_, place, _| points.extend_from_slice(place));
        }
        points
    }

    /// fᵃ += ∫φᵃ b dΩ₀ over a region or the whole body, with b per reference volume from
    /// `density(cell, place, b)`, flat over all nodes.
    ///
    /// # Errors
    /// The first point where b has no value.
    pub(super) fn add_body_force(
        &self,
        region: Option<usize>,
        mut density: impl FnMut(usize, &[f64], &mut [f64]) -> Result<(), NoValue>,
        force: &mut [f64],
    ) -> Result<(), NoValue> {
        let mesh = self.body.mesh();
        let d = mesh.dimension();
        let mut local = vec![0.0; mesh.element.dofs()];
        let mut b = vec![0.0; d];
        let mut failure = Ok(());
        for cell in self.cells(region) {
            local.fill(0.0);
            self.body.each_volume_point(cell, &mut |shape, place, volume| {
                if failure.is_ok() {
                    failure = density(cell, place, &mut b);
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

/// Total mass of a body. With one density it is the product with the volume.
fn total_mass(body: &dyn Body) -> f64 {
    let mesh = body.mesh();
    let mut volumes = vec![0.0; mesh.element.nodes()];
    let mut volume = 0.0;
    let mut mass = 0.0;
    let first = if mesh.cell_count() > 0 { body.density(0) } else { 0.0 };
    let mut is_uniform = true;
    for cell in 0..mesh.cell_count() {
        body.cell_volumes(cell, &mut volumes);
        let of_cell = volumes.iter().sum::<f64>();
        let density = body.density(cell);
        volume += of_cell;
        mass += density * of_cell;
        is_uniform &= density == first;
    }
    if is_uniform { volume * first } else { mass }
}

/// A box around all bodies with cells at positions `y`, flat over all nodes.
pub fn bounds(bodies: &[BodyInstance], y: &[f64]) -> Bounds {
    let with_cells = bodies.iter().filter(|body| !body.is_rigid());
    with_cells.flat_map(|body| body.of(y).chunks(body.body.mesh().dimension())).collect()
}
