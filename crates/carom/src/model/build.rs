//! From a resolved case to a model. Whatever the case names and the meshes lack is a [`Problem`] with the key it stands under.

use carom_contact::{ContactMethod, NodeToPlane};
use carom_solid::{Cover, Law};

use super::dimension::{Dimension, Space};
use super::formulas::value;
use super::held::unheld;
use super::{Contact, Loads, Mass, Model, Motions, Part, Probe, Support, exists_in, redistribution};
use crate::case::{
    self, ActiveSetRule, Case, ContactLaw, Enforcement, ForceTime, FormulaSpec, MassKind, Persistency, PrimarySpec,
    Problem,
};

/// A side in global node numbers.
pub(super) struct Side {
    pub(super) part: usize,
    pub(super) nodes: Vec<usize>,
    facets: Vec<Vec<usize>>,
    outward: f64,
}

/// Builds the model of a case of dimension `D`.
///
/// # Errors
/// All problems found: missing sides, probes outside their body, meshes that cannot be made, contacts that cannot be solved, initial overlaps.
pub fn build<const D: usize>(case: &Case) -> Result<Model<D>, Vec<Problem>>
where
    Space: Dimension<D>,
{
    let parts = parts::<D>(case)?;
    let mut problems = Vec::new();
    let dofs = parts.last().map_or(0, |p| p.nodes().end) * D;
    let mut reference = Vec::with_capacity(dofs);
    let (mut initial_position, mut initial_velocity) = (Vec::with_capacity(dofs), Vec::with_capacity(dofs));
    for (k, (part, spec)) in parts.iter().zip(&case.bodies).enumerate() {
        let places = part.body.mesh().nodes.as_flattened();
        reference.extend(places);
        match &spec.position {
            Some(formulas) => nodal(part, k, "position", formulas, &mut initial_position, &mut problems),
            None => initial_position.extend(places),
        }
        nodal(part, k, "velocity", &spec.velocity, &mut initial_velocity, &mut problems);
        // Where a formula has no value the rest is told too: every dof needs a number.
        initial_position.resize(reference.len(), 0.0);
        initial_velocity.resize(reference.len(), 0.0);
    }

    let mut fixed = vec![false; dofs];
    let mut supports = Vec::new();
    for (k, spec) in case.supports.iter().enumerate() {
        let mut held = Vec::new();
        for (j, name) in spec.on.iter().enumerate() {
            match side(&parts, name, &format!("support[{k}].on[{j}]")) {
                Ok(side) => {
                    let dofs = |axis: usize| side.nodes.iter().map(move |n| n * D + axis).collect::<Vec<_>>();
                    for dof in spec.fix.iter().flat_map(|i| dofs(*i)) {
                        fixed[dof] = true;
                        initial_velocity[dof] = 0.0;
                        held.push(dof);
                    }
                    held.extend(spec.moves.iter().flat_map(|(i, _)| dofs(*i)));
                }
                Err(problem) => problems.push(problem),
            }
        }
        held.sort_unstable();
        held.dedup();
        if let Some(name) = &spec.name {
            supports.push(Support { name: name.clone(), dofs: held });
        }
    }

    let motions = Motions::build(case, &parts, &fixed, &mut problems);
    motions.dofs().for_each(|dof| fixed[dof] = true);
    let loads = Loads::build(case, &parts, &mut problems);

    let kinds: Vec<_> = case.bodies.iter().map(|b| b.mass).collect();
    let mut mass = Mass::assemble(&parts, &kinds);
    problems.extend(redistributions(case, &parts, &reference, &mut mass));
    let massless: Vec<bool> = (0..dofs).map(|dof| mass.is_massless(dof / D)).collect();
    let gravity = gravity(case, &parts, &mass, dofs);
    let contacts = contacts(case, &parts, &massless, &mut problems);
    let probes = probes(case, &parts, &mut problems);
    let is_static = case.time.scheme.is_static();
    let unheld = if is_static { unheld(&parts, &fixed, &contacts, &mut problems) } else { Vec::new() };

    problems.extend(massless_refusals(case, &parts, &massless));

    let free: Vec<usize> = (0..dofs).filter(|&i| !fixed[i]).collect();
    let mut unknown = vec![usize::MAX; dofs];
    for (place, &dof) in free.iter().enumerate() {
        unknown[dof] = place;
    }
    let scale = parts.iter().map(|p| p.body.mesh().diameter()).fold(0.0, f64::max);
    if problems.is_empty() {
        Ok(Model {
            parts,
            reference,
            initial_position,
            initial_velocity,
            fixed,
            free,
            unknown,
            mass,
            massless,
            gravity,
            loads,
            motions,
            unheld,
            contacts,
            supports,
            probes,
            scale,
        })
    } else {
        Err(problems)
    }
}

/// What the formulas of a body's `key`, in X and Y, give at its nodes.
fn nodal<const D: usize>(
    part: &Part<D>,
    body: usize,
    key: &str,
    formulas: &[FormulaSpec],
    values: &mut Vec<f64>,
    problems: &mut Vec<Problem>,
) {
    let path = format!("body[{body}].{key}");
    let what = format!("the {key} of body \"{}\"", part.name);
    let variables = case::keys::variables(case::keys::IN_SPACE, D);
    let formulas: Vec<_> = match formulas.iter().map(|f| f.formula(&variables)).collect() {
        Ok(formulas) => formulas,
        Err(error) => {
            let error: carom_formula::FormulaError = error;
            return problems.push(Problem::new(path, what, error.to_string(), ""));
        }
    };
    for place in &part.body.mesh().nodes {
        for formula in &formulas {
            match value(formula, &what, place, 0.0) {
                Ok(value) => values.push(value),
                Err(error) => {
                    let help = "change the formula so that it has a value in the whole body";
                    let what = format!("the initial {key} has no value");
                    return problems.push(Problem::new(path, what, error.to_string(), help));
                }
            }
        }
    }
}

fn parts<const D: usize>(case: &Case) -> Result<Vec<Part<D>>, Vec<Problem>>
where
    Space: Dimension<D>,
{
    let mut parts = Vec::new();
    let mut problems = Vec::new();
    let mut first_node = 0;
    for (k, spec) in case.bodies.iter().enumerate() {
        let Some(material) = case.materials.iter().find(|m| m.name == spec.material) else { continue };
        let (lambda, mu) = (material.lambda, material.mu);
        let law = match material.law {
            case::Law::NeoHookean => Law::NeoHookean { lambda, mu },
            case::Law::SaintVenantKirchhoff => Law::SaintVenantKirchhoff { lambda, mu },
            case::Law::LinearElastic => Law::LinearElastic { lambda, mu },
        };
        let made = Space::mesh(spec).and_then(|mesh| {
            Space::body(mesh, law, case.plane, material.density, case.thickness).map_err(|e| e.to_string())
        });
        match made {
            Ok(body) => {
                let mesh = body.mesh();
                let n = mesh.element.nodes();
                let mut volumes = vec![0.0; n];
                let mut volume = 0.0;
                for cell in 0..mesh.cell_count() {
                    body.cell_volumes(cell, &mut volumes);
                    volume += volumes.iter().sum::<f64>();
                }
                let nodes = mesh.nodes.len();
                let massless = material.density == 0.0;
                let total_mass = volume * material.density;
                parts.push(Part { name: spec.name.clone(), first_node, body, massless, total_mass });
                first_node += nodes;
            }
            Err(why) => problems.push(Problem::new(
                format!("body[{k}].mesh"),
                format!("the mesh of body \"{}\" cannot be made", spec.name),
                why,
                "change what `mesh` names",
            )),
        }
    }
    if problems.is_empty() { Ok(parts) } else { Err(problems) }
}

/// Gravity as nodal forces M g with the mass matrix of the case: lumped or not, a free body falls without deforming.
fn gravity<const D: usize>(case: &Case, parts: &[Part<D>], mass: &Mass, dofs: usize) -> Vec<f64> {
    let mut acceleration = Vec::with_capacity(dofs);
    for (part, spec) in parts.iter().zip(&case.bodies) {
        for _ in part.nodes() {
            acceleration.extend_from_slice(&spec.gravity);
        }
    }
    let mut force = vec![0.0; dofs];
    mass.multiply_into(&acceleration, &mut force);
    force
}

pub(super) fn side<const D: usize>(parts: &[Part<D>], name: &str, path: &str) -> Result<Side, Problem> {
    let missing = |why: String, help: String| Problem::new(path, format!("there is no side \"{name}\""), why, help);
    let bodies = || parts.iter().map(|p| p.name.as_str()).collect::<Vec<_>>().join(", ");
    let (body, side) = name
        .split_once('.')
        .ok_or_else(|| missing("a side is written body.side".into(), format!("bodies: {}", bodies())))?;
    let part = parts
        .iter()
        .position(|p| p.name == body)
        .ok_or_else(|| missing(format!("there is no body \"{body}\""), format!("bodies: {}", bodies())))?;
    let mesh = parts[part].body.mesh();
    let first = parts[part].first_node;
    let (Some(facets), Some(nodes)) = (mesh.sides.get(side), mesh.side_nodes(side)) else {
        let sides = mesh.sides.keys().map(String::as_str).collect::<Vec<_>>().join(", ");
        return Err(missing(format!("the sides of \"{body}\" are: {sides}"), "use one of them".into()));
    };
    // Dimension 1: out of the body is away from the other nodes of the end's cell.
    let outward = facets.first().map_or(0.0, |f| {
        let end = mesh.nodes[f.nodes[0]][0];
        let cell = mesh.cell(f.cell);
        (end - cell.iter().map(|&n| mesh.nodes[n][0]).sum::<f64>() / cell.len() as f64).signum()
    });
    Ok(Side {
        part,
        nodes: nodes.iter().map(|n| n + first).collect(),
        facets: facets.iter().map(|f| f.nodes.iter().map(|n| n + first).collect()).collect(),
        outward,
    })
}

fn contacts<const D: usize>(
    case: &Case,
    parts: &[Part<D>],
    massless: &[bool],
    problems: &mut Vec<Problem>,
) -> Vec<Contact<D>>
where
    Space: Dimension<D>,
{
    let averages = case.time.scheme.is_alpha();
    let mut contacts = Vec::new();
    for (k, spec) in case.contacts.iter().enumerate() {
        let secondary = match side(parts, &spec.secondary, &format!("contact[{k}].secondary")) {
            Ok(side) => side,
            Err(problem) => {
                problems.push(problem);
                continue;
            }
        };
        let mut primary_part = None;
        let mut surface = secondary.nodes.clone();
        let method: Box<dyn ContactMethod<D>> = match &spec.primary {
            PrimarySpec::Plane { point, normal } => {
                let array = |v: &[f64]| std::array::from_fn(|i| v[i]);
                Box::new(NodeToPlane::new(secondary.nodes.clone(), array(point), array(normal)))
            }
            PrimarySpec::Side(name) => match side(parts, name, &format!("contact[{k}].primary")) {
                Ok(primary) if primary.part == secondary.part => {
                    problems.push(Problem::new(
                        format!("contact[{k}].primary"),
                        format!("contact \"{}\" is of body \"{}\" with itself", spec.name, parts[primary.part].name),
                        "self-contact is not in this version",
                        "name sides of two bodies",
                    ));
                    continue;
                }
                Ok(primary) => {
                    primary_part = Some(primary.part);
                    surface.extend(&primary.nodes);
                    Space::between(spec, &secondary.nodes, &primary.facets, primary.outward)
                }
                Err(problem) => {
                    problems.push(problem);
                    continue;
                }
            },
        };
        let light = |part: usize| case.bodies[part].mass.is_redistributed();
        let projects = spec.law == Some(ContactLaw::Position)
            && spec.enforcement == Enforcement::Multiplier
            && !case.time.scheme.is_static()
            && !light(secondary.part)
            && !primary_part.is_some_and(light);
        surface.sort_unstable();
        surface.dedup();
        let contact = Contact {
            name: spec.name.clone(),
            penalty: (spec.enforcement == Enforcement::Penalty)
                .then(|| method.secondary().iter().map(|&node| spec.stiffness * node_stiffness(parts, node)).collect()),
            predictor: spec.law == Some(ContactLaw::Predictor),
            method,
            primary_part,
            secondary_facets: secondary.facets,
            surface,
            // Other schemes take the contact force at the ends of their stages: there is nothing to average.
            force: if averages { spec.force } else { ForceTime::AlphaF },
            // A predictor that respects the contact, a spring, load steps, and nodes without mass that follow the other side leave nothing to project:
            // projected, a massive side would be given the velocity of the light one.
            persistency: if projects { spec.persistency } else { Persistency::None },
            within: spec.active_set == ActiveSetRule::Within,
            restitution: spec.restitution,
        };
        let has_mass = |nodes: &[usize]| nodes.iter().any(|n| !massless[n * D]);
        let primary_has_mass = matches!(&spec.primary, PrimarySpec::Side(name)
            if side(parts, name, "").is_ok_and(|s| has_mass(&s.nodes)));
        if contact.persistency == Persistency::Project && !has_mass(&secondary.nodes) && !primary_has_mass {
            problems.push(Problem::new(
                format!("contact[{k}]"),
                format!("no node of contact \"{}\" has mass", spec.name),
                "velocities where contact begins are projected with the mass as weight, and there is none",
                "persistency = \"none\" for this contact",
            ));
        }
        contacts.push(contact);
    }
    contacts
}

/// Mean over the directions of a node's diagonal of the tangent in the reference position.
fn node_stiffness<const D: usize>(parts: &[Part<D>], node: usize) -> f64 {
    let Some(part) = parts.iter().find(|part| part.nodes().contains(&node)) else { return 0.0 };
    let mesh = part.body.mesh();
    let n = mesh.element.nodes() * D;
    let (mut force, mut tangent, mut sum) = (vec![0.0; n], vec![0.0; n * n], 0.0);
    for cell in 0..mesh.cell_count() {
        let Some(place) = mesh.cell(cell).iter().position(|&m| m + part.first_node == node) else { continue };
        // The reference position is never inverted.
        if part.body.cell_tangent(cell, &mesh.nodes, &mut force, &mut tangent).is_ok() {
            sum += (place * D..(place + 1) * D).map(|i| tangent[i * n + i]).sum::<f64>() / D as f64;
        }
    }
    sum
}

/// Takes the mass off the nodes of contacts, in the bodies that ask for it.
fn redistributions<const D: usize>(case: &Case, parts: &[Part<D>], reference: &[f64], mass: &mut Mass) -> Vec<Problem> {
    let mut light = vec![false; reference.len() / D];
    for contact in &case.contacts {
        let primary = if let PrimarySpec::Side(name) = &contact.primary { Some(name) } else { None };
        for name in std::iter::once(&contact.secondary).chain(primary) {
            // Names that are wrong are reported where contacts are made.
            side(parts, name, "").into_iter().flat_map(|side| side.nodes).for_each(|node| light[node] = true);
        }
    }
    let mut problems = Vec::new();
    for (k, (part, spec)) in parts.iter().zip(&case.bodies).enumerate().filter(|(_, (_, b))| b.mass.is_redistributed())
    {
        let nearest = spec.mass == MassKind::RedistributedNearest;
        let what = format!("the mass of body \"{}\" cannot be redistributed", part.name);
        let path = format!("body[{k}].mass");
        if !part.nodes().any(|node| light[node]) {
            let why = "none of its sides belongs to a contact";
            problems.push(Problem::new(path, what, why, "mass = \"consistent\""));
        } else if let Err(why) =
            redistribution::redistribute(mass, part.nodes(), &light, reference.as_chunks::<D>().0, nearest)
        {
            problems.push(Problem::new(path, what, why, "a finer mesh, or mass = \"consistent\""));
        }
    }
    problems
}

/// A body without mass balances at s + 1 alone; rules that act inside the step have no meaning for it.
fn massless_refusals<const D: usize>(case: &Case, parts: &[Part<D>], massless: &[bool]) -> Vec<Problem> {
    let mut problems = Vec::new();
    let light = |part: &Part<D>| part.nodes().any(|node| massless[node * D]);
    let Some(part) = parts.iter().find(|p| light(p)) else { return problems };
    let what = |rule: &str| {
        let which = if part.massless { "has no mass" } else { "has nodes without mass" };
        format!("body \"{}\" {which}, and {rule} needs it", part.name)
    };
    let why = "its balance holds at the end of the step, not at the averaged state";
    if case.time.scheme.forces == carom_time::ForceRule::AverageState {
        let help = "forces = \"average-forces\", or a small density";
        problems.push(Problem::new("time.scheme.forces", what("forces = \"average-state\""), why, help));
    }
    if case.time.scheme.kind == "energy-momentum" {
        let help = "a scheme that is not midpoint, such as bathe, or a small density";
        problems.push(Problem::new("time.scheme.kind", what("kind = \"energy-momentum\""), why, help));
    }
    let touches =
        |name: &str| name.split_once('.').is_some_and(|(body, _)| parts.iter().any(|p| light(p) && p.name == body));
    for (k, contact) in case.contacts.iter().enumerate() {
        if contact.law == Some(ContactLaw::Predictor) {
            let why = "the predictor is projected with the mass as weight";
            let help = "law = \"position\", which needs no cure where contact nodes have no mass";
            problems.push(Problem::new(format!("contact[{k}].law"), what("law = \"predictor\""), why, help));
        }
        let primary = matches!(&contact.primary, PrimarySpec::Side(name) if touches(name));
        if contact.force == ForceTime::End && (primary || touches(&contact.secondary)) {
            let why = "the share of the contact force on a massless side is that of its internal forces";
            let help = "force = \"alpha_f\", or a small density";
            problems.push(Problem::new(format!("contact[{k}].force"), what("force = \"end\""), why, help));
        }
    }
    problems
}

fn probes<const D: usize>(case: &Case, parts: &[Part<D>], problems: &mut Vec<Problem>) -> Vec<Probe> {
    let mut probes = Vec::new();
    for (k, spec) in case.probes.iter().enumerate() {
        let Some(part) = parts.iter().position(|p| p.name == spec.body) else { continue };
        let point: [f64; D] = std::array::from_fn(|i| spec.at[i]);
        let places = parts[part].body.locate(&point);
        if places.is_empty() {
            let mesh = parts[part].body.mesh();
            let distance = |x: &[f64; D]| (0..D).map(|i| (x[i] - point[i]).powi(2)).sum::<f64>();
            let nearest = mesh.nodes.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
            problems.push(Problem::new(
                format!("probe[{k}].at"),
                format!("probe \"{}\" lies outside body \"{}\"", spec.name, spec.body),
                format!("no cell of the reference mesh contains {:?}", spec.at),
                nearest.map_or(String::new(), |x| format!("the nearest node is at {x:?}")),
            ));
        }
        if let Some(j) = spec.record.iter().position(|q| !exists_in(*q, D)) {
            problems.push(Problem::new(
                format!("probe[{k}].record[{j}]"),
                format!("probe \"{}\" asks for a quantity that dimension {D} does not have", spec.name),
                "a bar has ux, vx, ax, sigma_xx and det_f",
                "remove it",
            ));
        }
        probes.push(Probe { name: spec.name.clone(), part, places, record: spec.record.clone() });
    }
    probes
}

/// Initial overlaps deeper than round-off: a problem per contact with the deepest place.
///
/// Closing an overlap in one step throws the bodies apart, so it is refused.
pub fn overlaps<const D: usize>(model: &Model<D>) -> Vec<Problem> {
    let x = model.initial_position.as_chunks::<D>().0;
    let mut problems = Vec::new();
    for (k, contact) in model.contacts.iter().enumerate() {
        let mut deepest: Option<(f64, usize)> = None;
        // Behind a side is not yet inside its body: a plate has a lower side too.
        let primary = contact.primary_part.filter(|_| D > 1).map(|p| &model.parts[p]);
        let cover = primary.map(|part| Cover::new(&*part.body, &x[part.nodes()]));
        for (place, &node) in contact.method.secondary().iter().enumerate() {
            if cover.as_ref().is_some_and(|cover| !cover.contains(&x[node])) {
                continue;
            }
            let Some(gap) = contact.method.signed_distance(place, x) else { continue };
            if gap < -1e-9 * model.scale && deepest.is_none_or(|(g, _)| gap < g) {
                deepest = Some((gap, node));
            }
        }
        if let Some((gap, node)) = deepest {
            problems.push(Problem::new(
                format!("contact[{k}]"),
                format!("the bodies of contact \"{}\" overlap at the start by {:.6e}", contact.name, -gap),
                format!(
                    "the node of the secondary side at {:?} lies inside the primary; closing an overlap in one step would throw the bodies apart",
                    x[node]
                ),
                format!("move a body by at least {:.6e}, or swap secondary and primary if the wrong side was named", -gap),
            ));
        }
    }
    problems
}
