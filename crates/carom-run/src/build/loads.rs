//! The loads of a model; names and formulas were checked when the case was read.

use std::collections::BTreeMap;

use carom_case::{Case, LoadKind, LoadSpec, Problem};
use carom_formula::Formula;
use carom_mechanics::model::{Amplitude, BodyInstance, InBody, Load, Loads, Manufactured};
use carom_solid::LoadedSide;

use super::given::in_space_and_time;
use super::side::side;

/// The loads of a case.
pub(super) fn loads(case: &Case, parts: &[BodyInstance], problems: &mut Vec<Problem>) -> Loads {
    let mut loads = Loads::default();
    if let Some(y) = &case.manufactured {
        match y.iter().map(|f| in_space_and_time(case, f, "manufactured.y")).collect() {
            Ok(y) => loads.manufactured = Some(Manufactured::new(y, !case.time.scheme.is_static())),
            Err(problem) => problems.push(problem),
        }
        problems.extend(parts.iter().enumerate().filter(|(_, part)| part.memory() > 0).map(remembering));
    }
    for (k, spec) in case.loads.iter().enumerate() {
        let specs = match &spec.kind {
            LoadKind::Traction { value, .. } | LoadKind::BodyForce { value, .. } => value.as_slice(),
            LoadKind::Pressure { value, .. } => std::slice::from_ref(value),
        };
        let read = |f| in_space_and_time(case, f, &format!("load[{k}]"));
        let value: Vec<Formula> = match specs.iter().map(read).collect() {
            Ok(value) => value,
            Err(problem) => {
                problems.push(problem);
                continue;
            }
        };
        if let LoadKind::BodyForce { body, material, .. } = &spec.kind
            && let Some(part) = parts.iter().position(|p| p.name == *body)
        {
            let names = case.bodies[part].material_names();
            let region =
                material.as_ref().and_then(|material| names.iter().position(|name| name == material));
            loads.add_body_force(load(spec, InBody { part, region }, value.clone()));
        }
        let mut taken = BTreeMap::new();
        for (j, name) in spec.sides().iter().enumerate() {
            let path = format!("load[{k}].on[{j}]");
            match loaded(case, parts, name, &path).and_then(|side| once(side, name, &mut taken, &path)) {
                Ok(side) if matches!(spec.kind, LoadKind::Pressure { .. }) => {
                    loads.add_pressure(load(spec, side, value.clone()));
                }
                Ok(side) => loads.add_traction(load(spec, side, value.clone())),
                Err(problem) => problems.push(problem),
            }
        }
    }
    loads
}

/// A body with a memory whose motion is prescribed.
fn remembering((k, part): (usize, &BodyInstance)) -> Problem {
    Problem::new(
        format!("body[{k}].material"),
        format!("the material of body \"{}\" cannot be used with [manufactured]", part.name),
        "the load of the motion follows from the strain at each instant, and the stress of a material that yields, or has another memory, from all strains before".to_owned(),
        "use a material without memory".to_owned(),
    )
}

/// A side, if it has no facet of the sides before it; `taken`: their facets.
fn once<'a>(
    side: LoadedSide,
    name: &'a str,
    taken: &mut BTreeMap<Vec<usize>, &'a str>,
    path: &str,
) -> Result<LoadedSide, Problem> {
    for facet in side.facets() {
        let mut nodes = facet.clone();
        nodes.sort_unstable();
        if let Some(other) = taken.insert(nodes, name) {
            let what = match other {
                other if other == name => format!("\"{name}\" is named twice"),
                other => format!("\"{name}\" has facets of \"{other}\""),
            };
            let help = "name each part of the boundary once; the loads of two [[load]] tables add up";
            return Err(Problem::new(path, what, "the load would act on them twice", help));
        }
    }
    Ok(side)
}

fn loaded(case: &Case, parts: &[BodyInstance], name: &str, path: &str) -> Result<LoadedSide, Problem> {
    let part = &parts[side(parts, name, path)?.part];
    let mesh = part.body.mesh();
    let facets = name.split_once('.').and_then(|(_, side)| mesh.sides.get(side));
    let facets = facets.map_or(&[][..], Vec::as_slice);
    Ok(LoadedSide::new(mesh, facets, part.first_node, case.thickness))
}

/// A load with the name and the amplitude of its table in the case.
fn load<On>(spec: &LoadSpec, on: On, value: Vec<Formula>) -> Load<On> {
    let amplitude = spec.table.clone().map(|table| -> Amplitude { Box::new(move |time| table.value(time)) });
    Load { on, value, label: format!("the load \"{}\"", spec.label()), amplitude }
}
