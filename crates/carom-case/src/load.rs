//! Reads loads, motions of supports and initial velocities of bodies.

use std::path::Path;

use super::keys::{self, IN_SPACE_AND_TIME};
use super::load_table;
use super::problem::Problem;
use super::tree::{Node, Table};
use super::view::{View, formula};
use super::{FormulaSpec, LoadKind, LoadSpec};

/// Reads a `[[load]]`.
pub(super) fn read(v: View, folder: &Path, path: &str, problems: &mut Vec<Problem>) -> Option<LoadSpec> {
    let given: Vec<_> = ["traction", "pressure", "body_force"].into_iter().filter(|k| v.has(k)).collect();
    let place = if given == ["body_force"] { "body" } else { "on" };
    let other = if place == "body" { "on" } else { "body" };
    if given.len() != 1 || !v.has(place) || v.has(other) {
        // A misspelt key is reported once, not as a missing key too.
        if !v.table.0.iter().any(|e| !v.keys.iter().any(|k| k.name == e.key)) {
            let had = if given.is_empty() { "no force".to_owned() } else { given.join(", ") };
            let places: Vec<_> = ["on", "body"].into_iter().filter(|k| v.has(k)).collect();
            let where_ = if places.is_empty() { "no place".to_owned() } else { places.join(", ") };
            let what = format!("the load needs exactly one force and its place; it has {had} and {where_}");
            let help = "give `on` with `traction` or `pressure`, or `body` with `body_force`";
            problems.push(
                Problem::new(
                    path,
                    what,
                    "tractions and pressures act on sides, a body force acts in a body",
                    help,
                )
                .at_key(),
            );
        }
        return None;
    }
    let kind = match given[0] {
        "traction" => LoadKind::Traction { on: v.texts("on")?, value: v.formulas("traction")? },
        "pressure" => LoadKind::Pressure { on: v.texts("on")?, value: v.formula("pressure")? },
        _ => LoadKind::BodyForce { body: v.text("body")?, value: v.formulas("body_force")? },
    };
    let table = match v.text("table") {
        Some(file) => match load_table::read(&folder.join(&file), &file) {
            Ok(table) => Some(table),
            Err(error) => {
                let what = format!("the table \"{file}\" cannot be used");
                problems.push(Problem::new(format!("{path}.table"), what, error.why, error.help));
                return None;
            }
        },
        None => None,
    };
    Some(LoadSpec { name: v.text("name"), kind, table })
}

/// Reads the displacements of a support: (direction, formula).
pub(super) fn motion(v: &View) -> Option<Vec<(usize, FormulaSpec)>> {
    v.table.get("move").map_or_else(|| Some(Vec::new()), |table| displacements(table.table()?))
}

/// Reads displacements by direction.
pub(super) fn displacements(table: &Table) -> Option<Vec<(usize, FormulaSpec)>> {
    let axis = |(i, name)| table.get(name).map(|node| Some((i, formula(node)?)));
    ["x", "y", "z"].into_iter().enumerate().filter_map(axis).collect()
}

/// Reads a body's initial velocity; a rigid-body motion is converted to formulas.
pub(super) fn velocity(
    v: &View,
    dimension: usize,
    path: &str,
    problems: &mut Vec<Problem>,
) -> Option<Vec<FormulaSpec>> {
    let Some(node) = v.table.get("velocity") else { return Some(vec![FormulaSpec::Number(0.0); dimension]) };
    let Some(table) = node.table() else { return v.formulas("velocity") };
    let numbers = |key| match table.get(key) {
        Some(node) => node.list()?.iter().map(Node::number).collect::<Option<Vec<f64>>>(),
        None => Some(vec![0.0; dimension]),
    };
    let linear = numbers("linear")?;
    let angular = match table.get("angular") {
        Some(node) => match node.list() {
            Some(list) => list.iter().map(Node::number).collect::<Option<Vec<f64>>>()?,
            None => vec![0.0, 0.0, node.number()?],
        },
        None => vec![0.0; 3],
    };
    if angular.iter().all(|component| *component == 0.0) {
        return Some(linear.into_iter().map(FormulaSpec::Number).collect());
    }
    let misspelt = table.0.iter().any(|e| !["linear", "angular", "about"].contains(&e.key.as_str()));
    if misspelt {
        return None;
    }
    if dimension == 1 || table.get("about").is_none() {
        let (key, what, why, help) = if dimension == 1 {
            ("angular", "a bar cannot rotate", "the case has dimension = 1", "leave `angular` out")
        } else {
            let help = if dimension == 2 { "add `about = [x, y]`" } else { "add `about = [x, y, z]`" };
            ("angular", "the rotation has no centre", "a body rotates about a point", help)
        };
        problems.push(Problem::new(format!("{path}.velocity.{key}"), what, why, help));
        return None;
    }
    let about = numbers("about")?;
    // Component i of linear + ω × (X − about), without the terms that vanish.
    let component = |i: usize| {
        let [j, k] = [(i + 1) % 3, (i + 2) % 3];
        let term = |sign: &str, omega: f64, axis: usize| {
            let exists = axis < dimension && omega != 0.0;
            let arm = || format!(" {sign} {omega:?}*({} - {:?})", ["X", "Y", "Z"][axis], about[axis]);
            exists.then(arm).unwrap_or_default()
        };
        format!("{:?}{}{}", linear[i], term("+", angular[j], k), term("-", angular[k], j))
    };
    Some((0..dimension).map(|i| FormulaSpec::Text(component(i))).collect())
}

/// Variables of a load's formulas in a space of this dimension.
pub fn load_variables(dimension: usize) -> Vec<&'static str> {
    keys::variables(IN_SPACE_AND_TIME, dimension)
}
