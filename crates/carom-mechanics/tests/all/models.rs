//! Small models from plain numbers.

use carom_contact::{Boundary, Detection, Kinematics, NodeToFacet, NodeToPatch, Surface, Unilateral};
use carom_mechanics::model::{
    AllowedDepths, BodyInstance, Contact, Loads, Mass, Model, Motions, Point, Points, gap_tolerance,
};
use carom_solid::{Law, LoadedSide, Mesh, body};

/// Bodies of one material, with consecutive node numbers.
pub(crate) fn parts(meshes: impl IntoIterator<Item = Mesh>, law: Law, density: f64) -> Vec<BodyInstance> {
    let mut first_node = 0;
    let part = |(k, mesh): (usize, Mesh)| {
        let body = body(mesh, law, density, 1.0).unwrap();
        let part = BodyInstance::new(format!("body {k}"), first_node, body);
        first_node = part.nodes().end;
        part
    };
    meshes.into_iter().enumerate().map(part).collect()
}

/// Nodes of a side.
pub(crate) fn nodes(part: &BodyInstance, side: &str) -> Vec<usize> {
    part.body.mesh().side_nodes(side).unwrap().into_iter().map(|node| part.first_node + node).collect()
}

/// A side under loads.
pub(crate) fn loaded(part: &BodyInstance, side: &str) -> LoadedSide {
    let mesh = part.body.mesh();
    LoadedSide::new(mesh, &mesh.sides[side], part.first_node, 1.0)
}

/// Contact of a side of one body with a side of another, by multipliers, in the plane or in space.
pub(crate) fn contact(parts: &[BodyInstance], secondary: (usize, &str), primary: (usize, &str)) -> Contact {
    let facets = |(k, side): (usize, &str)| -> Vec<Vec<usize>> {
        let of =
            |facet: &carom_solid::Facet| facet.nodes.iter().map(|node| parts[k].first_node + node).collect();
        parts[k].body.mesh().sides[side].iter().map(of).collect()
    };
    let shape = |k: usize| parts[k].body.mesh().element.facet_shape();
    let secondary_nodes = nodes(&parts[secondary.0], secondary.1);
    let target = facets(primary);
    let mut surface = [&secondary_nodes[..], &nodes(&parts[primary.0], primary.1)].concat();
    surface.sort_unstable();
    let kinematics: Box<dyn Kinematics> = if parts[0].body.mesh().dimension() == 3 {
        Box::new(NodeToPatch::new(secondary_nodes, Boundary::new(shape(primary.0), &target, &[], 0)))
    } else {
        let target = Surface::new(shape(primary.0), &target, &vec![1.0; target.len()]);
        Box::new(NodeToFacet::new(secondary_nodes, target, Detection::ClosestPoint))
    };
    Contact {
        name: "strike".to_owned(),
        kinematics,
        interface: Box::new(Unilateral),
        primary_part: Some(primary.0),
        itself: false,
        facets: vec![(shape(secondary.0), facets(secondary))],
        depths: AllowedDepths { smooth: 1e-6, kinks: 0.01, others: 0.1 },
        friction: None,
        augmentation: None,
        springs: None,
        predictor: false,
        surface,
        at_the_end: false,
        projects: true,
        within: true,
        restitution: 0.0,
    }
}

/// A model with consistent masses, at rest in its reference configuration; fixed and prescribed
/// dofs are constrained.
pub(crate) fn model(
    mut parts: Vec<BodyInstance>,
    fixed: &[usize],
    motions: Motions,
    loads: Loads,
    contacts: Vec<Contact>,
) -> Model {
    let dimension = parts[0].body.mesh().dimension();
    let mass = Mass::assemble(dimension, &parts, &vec![false; parts.len()]);
    for part in &mut parts {
        part.total_mass = part.nodes().flat_map(|node| mass.row(node)).map(|(_, mass)| mass).sum();
    }
    let reference: Vec<f64> = parts.iter().flat_map(|part| part.body.mesh().nodes.flat()).copied().collect();
    let dofs = reference.len();
    let mut constrained = vec![false; dofs];
    fixed.iter().copied().chain(motions.dofs()).for_each(|dof| constrained[dof] = true);
    let points = Points::default();
    let [free, unknown] = Model::unknowns(&constrained, dimension, &points);
    let scale = parts.iter().map(|part| part.body.mesh().diameter()).fold(0.0, f64::max);
    Model {
        dimension,
        gap_tolerance: gap_tolerance(scale, reference.iter().copied()),
        initial_position: reference.clone(),
        initial_velocity: vec![0.0; dofs],
        stopped: Vec::new(),
        fixed: constrained,
        free,
        unknown,
        points,
        ties: Vec::new(),
        massless: (0..dofs).map(|dof| mass.is_massless(dof / dimension)).collect(),
        mass,
        gravity: vec![0.0; dofs],
        loads,
        motions,
        unconstrained: Vec::new(),
        contacts,
        supports: Vec::new(),
        probes: Vec::new(),
        scale,
        threads: carom_algebra::Threads::one(),
        reference,
        parts,
    }
}

/// The model with the nodes of a side of one body as the nearest points of a side of another.
pub(crate) fn tied(mut model: Model, secondary: (usize, &str), primary: (usize, &str)) -> Model {
    let part = &model.parts[primary.0];
    let mesh = part.body.mesh();
    let d = model.dimension;
    let place = |node: usize| -> [f64; 3] {
        std::array::from_fn(|i| if i < d { model.reference[node * d + i] } else { 0.0 })
    };
    let nearest = |node: usize| {
        let points = mesh.sides[primary.1].iter().map(|facet| {
            let nodes: Vec<usize> = facet.nodes.iter().map(|node| part.first_node + node).collect();
            let places: Vec<[f64; 3]> = nodes.iter().map(|&node| place(node)).collect();
            (mesh.element.facet_shape().closest(&places, place(node)), nodes)
        });
        let (point, nodes) = points.min_by(|a, b| a.0.distance.total_cmp(&b.0.distance)).unwrap();
        assert!(point.distance < 1e-12);
        Point { node, weights: nodes.into_iter().zip(point.values).collect() }
    };
    let given = nodes(&model.parts[secondary.0], secondary.1).into_iter().map(nearest).collect();
    model.points = Points::new(d, model.dofs() / d, given).unwrap();
    [model.free, model.unknown] = Model::unknowns(&model.fixed, d, &model.points);
    model
}
