//! Builds a model from a resolved case. Names that the meshes lack are reported as a [`Problem`]
//! with their key.

mod areas;
mod between_sides;
mod branching;
mod contacts;
mod given;
mod loads;
mod mortar_tie;
mod motions;
mod obstacles;
mod overlaps;
mod repeated;
pub(crate) mod side;
mod supports;
pub mod tie_links;
mod tie_side;
mod ties;
mod tying;
mod unsolvable;
mod weights;

use std::collections::BTreeMap;

use carom_algebra::Threads;
use carom_case::{
    BodySpec, Case, FormulaSpec, InvariantsSpec, MassKind, MaterialSpec, Plane, PlasticSpec, ProbeSpec,
    Problem, SKIN, TieSpec, Volumetric,
};
use carom_mechanics::model::{
    BodyInstance, Mass, Model, Probe, Quantity, free_motions, gap_tolerance, redistribute, value,
};
use carom_solid::material::{Hardening, Hencky, Isochoric, J2, MooneyRivlin, Table, Yeoh};
use carom_solid::{
    Body, Constitutive, Law, Mesh, PlaneState, RegionMaterial, SolidError, VolumeAveraged, body_of_regions,
    mean_dilatation_body,
};

use side::side;
use supports::Supported;
pub(crate) use supports::axes_across;
use ties::Ties;
use tying::Tying;
use weights::Weights;

pub(crate) use overlaps::overlaps;

/// Laws given in place of those of materials, by the material's name.
pub(crate) type Materials = BTreeMap<String, Box<dyn Constitutive>>;

/// Builds the model of a case; `materials`: laws in place of the case's.
///
/// # Errors
/// All problems found: missing sides, probes outside their body, invalid meshes, contacts that
/// cannot be solved.
pub(crate) fn build(case: &Case, materials: &Materials) -> Result<Model, Vec<Problem>> {
    let d = case.dimension;
    let (mut parts, mut ties) = parts(case, materials)?;
    let scale = parts.iter().map(|p| p.body.mesh().diameter()).fold(0.0, f64::max);
    let obstacles = obstacles::carriers(case, &mut parts, scale)?;
    let mut problems = Vec::new();
    let dofs = parts.last().map_or(0, |p| p.nodes().end) * d;
    let Placed { reference, mut initial_position, mut initial_velocity } =
        placed(case, &parts, &obstacles, &mut problems);
    let Supported { mut fixed, mut supports } = supports::supported(case, &parts, &reference, &mut problems);
    let tying = Tying { case, parts: &parts, reference: &reference, ties: &ties };
    let mut stopped = Vec::new();
    for (dof, velocity) in initial_velocity.iter_mut().enumerate().filter(|(dof, _)| fixed[*dof]) {
        if *velocity != 0.0 {
            stopped.push((dof, std::mem::take(velocity)));
        }
    }
    supports.extend(obstacles.iter().filter_map(obstacles::Moving::support));
    obstacles.iter().flat_map(obstacles::Moving::fixed).for_each(|dof| fixed[dof] = true);

    let mut moves = motions::moves(case, &parts, &obstacles, &fixed, &mut problems);
    let released = tying.release(&mut fixed, &mut moves, &mut problems);
    tying.start(&mut initial_position, &mut initial_velocity, &mut problems);
    let motions = moves.motions(case, &parts);
    motions.dofs().for_each(|dof| fixed[dof] = true);
    tying.constrain(&mut fixed);
    let mut loads = loads::loads(case, &parts, &mut problems);

    // For redistributed masses the contact nodes are made massless afterwards.
    let lumped: Vec<bool> = case.bodies.iter().map(|b| b.mass == MassKind::Lumped).collect();
    let mut mass = Mass::assemble(d, &parts, &lumped);
    problems.extend(redistributions(case, &parts, &reference, &mut mass));
    let mut massless: Vec<bool> = (0..dofs).map(|dof| mass.is_massless(dof / d)).collect();
    // The force on a prescribed carrier is averaged like that on the nodes that press on it.
    obstacles.iter().flat_map(obstacles::Moving::prescribed).for_each(|dof| massless[dof] = false);
    tying.check_masses(&massless, &mut problems);
    let weights = Weights { case, parts: &parts, obstacles: &obstacles, mass: &mass };
    let gravity = weights.constant();
    problems.extend(weights.add_varying(&mut loads));
    let mut moved = vec![false; dofs];
    motions.dofs().for_each(|dof| moved[dof] = true);
    let dofs_that = [&massless[..], &fixed[..], &moved[..]];
    let contacts = contacts::contacts(case, &parts, &obstacles, dofs_that, &ties.closed, &mut problems);
    let probes = probes(case, &parts, &mut problems);
    let unconstrained = free_motions(&parts, &fixed, &ties.points);
    // A contact that could not be made might hold them.
    if case.time.scheme.is_static() && contacts.len() == case.contacts.len() {
        problems.extend(unsolvable::unconstrained(&parts, &unconstrained, &contacts));
    }
    problems.extend(unsolvable::massless(case, &parts, &massless));

    for tie in &mut ties.list {
        let nodes = tie.tied.concat();
        tie.supported = released.iter().copied().filter(|dof| nodes.contains(&(dof / d))).collect();
    }
    let [free, unknown] = Model::unknowns(&fixed, d, &ties.points);
    let of_obstacles = case.contacts.iter().map(|contact| contact.primary.largest_coordinate());
    if problems.is_empty() {
        Ok(Model {
            dimension: d,
            parts,
            reference,
            gap_tolerance: gap_tolerance(scale, initial_position.iter().copied().chain(of_obstacles)),
            initial_position,
            initial_velocity,
            stopped,
            fixed,
            free,
            unknown,
            points: ties.points,
            ties: ties.list,
            mass,
            massless,
            gravity,
            loads,
            motions,
            unconstrained,
            contacts,
            supports,
            probes,
            scale,
            threads: Threads::one(),
        })
    } else {
        Err(problems)
    }
}

/// Positions and velocities of all nodes.
struct Placed {
    reference: Vec<f64>,
    initial_position: Vec<f64>,
    initial_velocity: Vec<f64>,
}

/// The nodes of bodies and obstacles at the start.
fn placed(
    case: &Case,
    parts: &[BodyInstance],
    obstacles: &[obstacles::Moving],
    problems: &mut Vec<Problem>,
) -> Placed {
    let mut reference = Vec::new();
    let mut initial_position = Vec::new();
    let mut initial_velocity = Vec::new();
    for (k, (part, spec)) in parts.iter().zip(&case.bodies).enumerate() {
        let places = part.body.mesh().nodes.flat();
        reference.extend(places);
        match &spec.position {
            Some(formulas) => nodal(part, k, "position", formulas, &mut initial_position, problems),
            None => initial_position.extend(places),
        }
        nodal(part, k, "velocity", &spec.velocity, &mut initial_velocity, problems);
        // Without a value the other problems are reported too: every dof needs a number.
        initial_position.resize(reference.len(), 0.0);
        initial_velocity.resize(reference.len(), 0.0);
    }
    for obstacle in obstacles {
        reference.extend(parts[obstacle.part].body.mesh().nodes.flat());
        initial_position.extend(parts[obstacle.part].body.mesh().nodes.flat());
        initial_velocity.extend(obstacle.velocity());
    }
    Placed { reference, initial_position, initial_velocity }
}

/// Values of the formulas of a body's `key` at its nodes.
fn nodal(
    part: &BodyInstance,
    body: usize,
    key: &str,
    formulas: &[FormulaSpec],
    values: &mut Vec<f64>,
    problems: &mut Vec<Problem>,
) {
    let path = format!("body[{body}].{key}");
    let what = format!("the {key} of body \"{}\"", part.name);
    let variables = carom_case::keys::variables(carom_case::keys::IN_SPACE, part.body.mesh().dimension());
    let formulas = match formulas.iter().map(|f| f.formula(&variables)).collect::<Result<Vec<_>, _>>() {
        Ok(formulas) => formulas,
        Err(error) => return problems.push(Problem::new(path, what, error.to_string(), "")),
    };
    for place in &part.body.mesh().nodes {
        for formula in &formulas {
            match value(formula, &what, place, 0.0) {
                Ok(value) => values.push(value),
                Err(error) => {
                    let help = "change the formula so that it has a finite value in the whole body";
                    let what = format!("the initial {key} has no finite value");
                    return problems.push(Problem::new(path, what, error.to_string(), help));
                }
            }
        }
    }
}

/// The bodies of a case, and its ties.
fn parts(case: &Case, materials: &Materials) -> Result<(Vec<BodyInstance>, Ties), Vec<Problem>> {
    let mut parts = Vec::new();
    let mut problems = Vec::new();
    let mut first_node = 0;
    let mut meshes = meshes(case)?;
    let ties = ties::ties(case, &mut meshes, &mut problems);
    for ((k, spec), mesh) in case.bodies.iter().enumerate().zip(meshes) {
        let of_body = case.materials_of(spec);
        let averages = spec.volumetric == Volumetric::Mean;
        let own = of_body.iter().find(|material| materials.contains_key(&material.name));
        if let Some(material) = own.filter(|_| averages) {
            let what = format!("the law of \"{}\" is your own, and has no mean dilatation", material.name);
            let why = "the volumetric part of a law must be known to be averaged over a cell";
            let help = "leave volumetric out, or use an element of higher degree";
            problems.push(Problem::new(format!("body[{k}].volumetric"), what, why, help));
            continue;
        }
        match body(case, spec, mesh, materials) {
            Ok(body) => {
                let nodes = body.mesh().nodes.len();
                parts.push(BodyInstance::new(spec.name.clone(), first_node, body));
                first_node += nodes;
            }
            Err(error) => problems.push(no_mesh(case, k, error.to_string())),
        }
    }
    if problems.is_empty() { Ok((parts, ties)) } else { Err(problems) }
}

/// The meshes of a case whose ties have moved their nodes.
///
/// # Errors
/// A mesh cannot be made, or a tie has no points.
pub(crate) fn tied_meshes(case: &Case) -> Result<Vec<carom_solid::Mesh>, Vec<Problem>> {
    let mut meshes = meshes(case)?;
    let mut problems = Vec::new();
    ties::ties(case, &mut meshes, &mut problems);
    if problems.is_empty() { Ok(meshes) } else { Err(problems) }
}

/// The meshes of the bodies.
fn meshes(case: &Case) -> Result<Vec<carom_solid::Mesh>, Vec<Problem>> {
    let mut meshes = Vec::new();
    let mut problems = Vec::new();
    for (k, spec) in case.bodies.iter().enumerate() {
        match spec.make_mesh(case.dimension) {
            Ok(mesh) => meshes.push(with_materials(spec, with_skin(case, &spec.name, mesh))),
            Err(error) => problems.push(no_mesh(case, k, error.to_string())),
        }
    }
    if problems.is_empty() { Ok(meshes) } else { Err(problems) }
}

fn no_mesh(case: &Case, k: usize, why: String) -> Problem {
    let name = &case.bodies[k].name;
    let what = format!("the mesh of body \"{name}\" cannot be generated");
    let is_adjusted = |tie: &TieSpec| tie.adjust.is_some() && tie.bodies()[0] == name;
    let help = match case.ties.iter().find(|tie| is_adjusted(tie)) {
        Some(tie) => format!("change the values of `mesh`, or give tie `{}` a smaller `adjust`", tie.name),
        None => "change the values of `mesh`".to_owned(),
    };
    Problem::new(format!("body[{k}].mesh"), what, why, help)
}

/// The body of a mesh whose regions are those of the body's materials.
fn body(
    case: &Case,
    spec: &BodySpec,
    mesh: Mesh,
    materials: &Materials,
) -> Result<Box<dyn Body>, SolidError> {
    let of_body = case.materials_of(spec);
    if spec.volumetric == Volumetric::Mean {
        let averaged: Vec<_> = of_body.iter().map(|material| averaged(material)).collect();
        let of_regions: Vec<_> = averaged
            .iter()
            .zip(&of_body)
            .map(|(law, material)| RegionMaterial { law: &**law, density: material.density })
            .collect();
        return mean_dilatation_body(mesh, &of_regions, case.thickness);
    }
    let of_case: Vec<_> = of_body.iter().map(|material| constitutive(material)).collect();
    let of_regions = of_body.iter().zip(&of_case).map(|(material, of_case)| RegionMaterial {
        law: &**materials.get(&material.name).unwrap_or(of_case),
        density: material.density,
    });
    let plane = match (mesh.dimension(), case.plane) {
        (2, Plane::Stress) => PlaneState::Stress,
        _ => PlaneState::Strain,
    };
    body_of_regions(mesh, &of_regions.collect::<Vec<_>>(), plane, case.thickness)
}

/// The law of a material of the case, with its plastic flow.
fn constitutive(material: &MaterialSpec) -> Box<dyn Constitutive> {
    match plastic(material) {
        Some(law) => law.constitutive(),
        None => law(material).constitutive(),
    }
}

/// The law of a material of the case, for mean dilatation.
fn averaged(material: &MaterialSpec) -> Box<dyn VolumeAveraged> {
    match plastic(material) {
        Some(law) => Box::new(law),
        None => Box::new(law(material)),
    }
}

/// The law of a material that yields; none of others.
fn plastic(material: &MaterialSpec) -> Option<J2> {
    let elastic = Hencky { lambda: material.lambda, mu: material.mu };
    let hardening = match material.plastic.as_ref()? {
        &PlasticSpec::Formula { yield_stress, hardening: modulus, rise: 0.0, .. } => {
            Hardening::Linear { yield_stress, modulus }
        }
        &PlasticSpec::Formula { yield_stress, hardening: modulus, rise, rate } => {
            Hardening::Voce { yield_stress, modulus, rise, rate }
        }
        PlasticSpec::Table(points) => Hardening::Table(Table::new(points)?),
    };
    Some(J2 { elastic, hardening })
}

/// The elastic law of a material of the case.
fn law(material: &MaterialSpec) -> Law {
    let lambda = material.lambda;
    let mu = material.mu;
    let bulk = lambda + 2.0 * mu / 3.0;
    match material.law {
        carom_case::Law::NeoHookean => Law::NeoHookean { lambda, mu },
        carom_case::Law::SaintVenantKirchhoff => Law::SaintVenantKirchhoff { lambda, mu },
        carom_case::Law::LinearElastic => Law::LinearElastic { lambda, mu },
        carom_case::Law::Hencky => Law::Hencky { lambda, mu },
        carom_case::Law::MooneyRivlin => {
            let InvariantsSpec { c10, c01, .. } = material.invariants;
            Law::MooneyRivlin(Isochoric { of: MooneyRivlin { c10, c01 }, bulk })
        }
        carom_case::Law::Yeoh => {
            let InvariantsSpec { c10, c20, c30, .. } = material.invariants;
            Law::Yeoh(Isochoric { of: Yeoh { c10, c20, c30 }, bulk })
        }
    }
}

/// The mesh of a body, with its materials as regions: groups of the same material are one.
fn with_materials(spec: &BodySpec, mut mesh: Mesh) -> Mesh {
    let of_regions = spec.materials_of_regions();
    if spec.material_names().len() == 1 {
        mesh.regions.clear();
    }
    mesh.regions.iter_mut().for_each(|region| *region = of_regions[usize::from(*region)] as u16);
    mesh
}

/// The mesh of a body, with its whole boundary as a side if the case refers to that.
fn with_skin(case: &Case, body: &str, mut mesh: Mesh) -> Mesh {
    let name = format!("{body}.{SKIN}");
    let contacts =
        case.contacts.iter().flat_map(|contact| [Some(contact.secondary.as_str()), contact.primary.side()]);
    let supports = case.supports.iter().flat_map(|support| &support.on);
    let loads = case.loads.iter().flat_map(carom_case::LoadSpec::sides);
    let ties = case.ties.iter().flat_map(|tie| [tie.secondary.as_str(), tie.primary.as_str()]);
    let mut sides = contacts.flatten().chain(supports.chain(loads).map(String::as_str)).chain(ties);
    if mesh.dimension() > 1 && sides.any(|side| side == name) && !mesh.sides.contains_key(SKIN) {
        let skin = mesh.ordered_skin();
        mesh.sides.insert(SKIN.to_owned(), skin);
    }
    mesh
}

/// Redistributes the mass of contact nodes in the bodies that request it.
fn redistributions(case: &Case, parts: &[BodyInstance], reference: &[f64], mass: &mut Mass) -> Vec<Problem> {
    let mut light = vec![false; mass.nodes()];
    for contact in &case.contacts {
        for name in std::iter::once(contact.secondary.as_str()).chain(contact.primary.side()) {
            // Wrong names are reported by `contacts`.
            side(parts, name, "").into_iter().flat_map(|side| side.nodes).for_each(|node| light[node] = true);
        }
    }
    let mut problems = Vec::new();
    for (k, part) in parts.iter().take(case.bodies.len()).enumerate() {
        if !case.bodies[k].mass.is_redistributed() {
            continue;
        }
        let what = format!("the mass of body \"{}\" cannot be redistributed", part.name);
        let path = format!("body[{k}].mass");
        if !part.nodes().any(|node| light[node]) {
            let why = "none of its sides belongs to a contact";
            problems.push(Problem::new(path, what, why, "use mass = \"consistent\""));
        } else if let Err(why) = redistribute(mass, part.nodes(), &light, case.dimension, reference) {
            problems.push(Problem::new(path, what, why, "use a finer mesh, or mass = \"consistent\""));
        }
    }
    problems
}

fn probes(case: &Case, parts: &[BodyInstance], problems: &mut Vec<Problem>) -> Vec<Probe> {
    let mut probes = Vec::new();
    for (k, spec) in case.probes.iter().enumerate() {
        let Some(part) = parts.iter().position(|p| p.name == spec.body) else { continue };
        let mut places = parts[part].body.locate(&spec.at);
        if places.is_empty() {
            let mesh = parts[part].body.mesh();
            let distance = |x: &[f64]| x.iter().zip(&spec.at).map(|(x, p)| (x - p).powi(2)).sum::<f64>();
            let nearest = mesh.nodes.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
            problems.push(Problem::new(
                format!("probe[{k}].at"),
                format!("probe \"{}\" lies outside body \"{}\"", spec.name, spec.body),
                format!("no cell of the reference mesh contains {:?}", spec.at),
                nearest.map_or(String::new(), |x| format!("the nearest node is at {x:?}")),
            ));
        }
        let mesh = parts[part].body.mesh();
        if let Some(problem) = on_one_side(case, k, spec, mesh, &mut places) {
            problems.push(problem);
        }
        let record = spec.record.iter().map(|q| quantity(*q)).collect();
        probes.push(Probe { name: spec.name.clone(), part, places, record });
    }
    probes
}

/// Leaves the cells of the material of a probe; returns what is wrong with a probe where materials
/// meet, or with its material.
fn on_one_side(
    case: &Case,
    k: usize,
    spec: &ProbeSpec,
    mesh: &Mesh,
    places: &mut Vec<(usize, Vec<f64>)>,
) -> Option<Problem> {
    let body = case.bodies.iter().find(|body| body.name == spec.body)?;
    let names = body.material_names();
    let mut of_point: Vec<usize> = places.iter().map(|(cell, _)| mesh.region(*cell)).collect();
    of_point.sort_unstable();
    of_point.dedup();
    let there: Vec<&str> = of_point.iter().map(|region| names[*region]).collect();
    if let Some(material) = &spec.material {
        places.retain(|(cell, _)| names[mesh.region(*cell)] == material);
        return (places.is_empty() && !there.is_empty()).then(|| {
            let what = format!("probe \"{}\" does not lie in its material", spec.name);
            let why = format!("the point {:?} belongs to {}, not to {material}", spec.at, there.join(", "));
            let help = "change `at` or `material`";
            Problem::new(format!("probe[{k}].material"), what, why, help)
        });
    }
    let has_sides = |name: &carom_case::Quantity| {
        matches!(
            quantity(*name),
            Quantity::Stress(..)
                | Quantity::Strain(..)
                | Quantity::VonMises
                | Quantity::DetF
                | Quantity::PlasticStrain
                | Quantity::Yielded
        )
    };
    (there.len() > 1 && spec.record.iter().any(has_sides)).then(|| {
        let what = format!("probe \"{}\" lies where materials meet", spec.name);
        let why =
            format!("stress, strain and volume ratio have a value in each of {} there", there.join(", "));
        let help = format!("choose one, for example `material = \"{}\"`", there[0]);
        Problem::new(format!("probe[{k}].at"), what, why, help)
    })
}

/// The quantity of a name in the case.
pub(crate) fn quantity(name: carom_case::Quantity) -> Quantity {
    use carom_case::Quantity as Name;
    match name {
        Name::Ux => Quantity::Displacement(0),
        Name::Uy => Quantity::Displacement(1),
        Name::Uz => Quantity::Displacement(2),
        Name::Vx => Quantity::Velocity(0),
        Name::Vy => Quantity::Velocity(1),
        Name::Vz => Quantity::Velocity(2),
        Name::Ax => Quantity::Acceleration(0),
        Name::Ay => Quantity::Acceleration(1),
        Name::Az => Quantity::Acceleration(2),
        Name::SigmaXx => Quantity::Stress(0, 0),
        Name::SigmaYy => Quantity::Stress(1, 1),
        Name::SigmaZz => Quantity::Stress(2, 2),
        Name::SigmaXy => Quantity::Stress(0, 1),
        Name::SigmaYz => Quantity::Stress(1, 2),
        Name::SigmaXz => Quantity::Stress(0, 2),
        Name::VonMises => Quantity::VonMises,
        Name::DetF => Quantity::DetF,
        Name::PlasticStrain => Quantity::PlasticStrain,
        Name::Yielded => Quantity::Yielded,
        Name::StrainXx => Quantity::Strain(0, 0),
        Name::StrainYy => Quantity::Strain(1, 1),
        Name::StrainZz => Quantity::Strain(2, 2),
        Name::StrainXy => Quantity::Strain(0, 1),
        Name::StrainYz => Quantity::Strain(1, 2),
        Name::StrainXz => Quantity::Strain(0, 2),
    }
}
