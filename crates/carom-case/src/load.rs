//! Reads loads, motions of supports and initial velocities of bodies.

use super::keys::{self, IN_SPACE_AND_TIME};
use super::load_table;
use super::view::View;
use super::{FormulaSpec, LoadKind, LoadSpec};

/// Reads a `[[load]]`.
pub(super) fn read(v: &View) -> Option<LoadSpec> {
    let given: Vec<_> = ["traction", "pressure", "body_force"].into_iter().filter(|k| v.has(k)).collect();
    let place = if given == ["body_force"] { "body" } else { "on" };
    let other = if place == "body" { "on" } else { "body" };
    if given.len() != 1 || !v.has(place) || v.has(other) {
        if !v.has_unknown_key() {
            let had = if given.is_empty() { "no force".to_owned() } else { given.join(", ") };
            let places: Vec<_> = ["on", "body"].into_iter().filter(|k| v.has(k)).collect();
            let where_ = if places.is_empty() { "no place".to_owned() } else { places.join(", ") };
            let what = format!("the load needs exactly one force and its place; it has {had} and {where_}");
            let help = "give `on` with `traction` or `pressure`, or `body` with `body_force`";
            let why = "tractions and pressures act on sides, a body force acts in a body";
            return v.report(v.problem("", what, why, help).at_key());
        }
        return None;
    }
    let kind = match given[0] {
        "traction" => LoadKind::Traction { on: v.texts("on")?, value: v.formulas("traction")? },
        "pressure" => LoadKind::Pressure { on: v.texts("on")?, value: v.formula("pressure")? },
        _ => LoadKind::BodyForce { body: v.text("body")?, value: v.formulas("body_force")? },
    };
    let table = match v.text("table") {
        Some(file) => match load_table::read(&v.folder.join(&file), &file) {
            Ok(table) => Some(table),
            Err(error) => {
                let what = format!("the table \"{file}\" cannot be used");
                return v.wrong("table", what, error.why, error.help);
            }
        },
        None => None,
    };
    Some(LoadSpec { name: v.text("name"), kind, table })
}

/// Reads the displacements of a support: (direction, formula).
pub(super) fn motion(v: &View) -> Option<Vec<(usize, FormulaSpec)>> {
    displacements(&v.at("move")?)
}

/// Reads displacements by direction.
pub(super) fn displacements(v: &View) -> Option<Vec<(usize, FormulaSpec)>> {
    let axis = |(i, name)| v.has(name).then(|| Some((i, v.formula(name)?)));
    ["x", "y", "z"].into_iter().enumerate().filter_map(axis).collect()
}

/// Reads a body's initial velocity; a rigid-body motion is converted to formulas.
pub(super) fn velocity(v: &View, dimension: usize) -> Option<Vec<FormulaSpec>> {
    let Some(v) = v.at("velocity") else { return v.formulas("velocity") };
    let linear = v.vector("linear", dimension)?;
    let angular = match v.number("angular") {
        Some(about_z) => vec![0.0, 0.0, about_z],
        None => v.vector("angular", 3)?,
    };
    if angular.iter().all(|component| *component == 0.0) {
        return Some(linear.into_iter().map(FormulaSpec::Number).collect());
    }
    if v.has_unknown_key() {
        return None;
    }
    if dimension == 1 {
        let why = "the case has dimension = 1";
        return v.wrong("angular", "a bar cannot rotate", why, "leave `angular` out");
    }
    if !v.has("about") {
        let help = if dimension == 2 { "add `about = [x, y]`" } else { "add `about = [x, y, z]`" };
        return v.wrong("angular", "the rotation has no centre", "a body rotates about a point", help);
    }
    let about = v.numbers("about")?;
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
