//! Reads loads, supports and initial velocities of bodies.

use super::keys::Kind::{self, Vector};
use super::keys::{self, IN_SPACE_AND_TIME, Keys, View};
use super::load_table;
use super::spec::{LoadKeys, SupportKeys};
use super::{FormulaSpec, LoadKind, LoadSpec, SupportSpec};

/// Initial velocity of a rigid-body motion: linear + angular × (X − about).
#[derive(Keys)]
#[keys(name = "velocity")]
pub(crate) struct Velocity {
    /// Velocity of the point `about`. Default: zero.
    #[key(Vector, unit = "length/time", optional = "[0.0, -1.0]", with = linear)]
    linear: Vec<f64>,
    /// Angular velocity: counter-clockwise in dimension 2, [ωx, ωy, ωz] in dimension 3. Default: zero.
    #[key(Kind::Angular, unit = "1/time", optional = "2.0", with = angular)]
    angular: Vec<f64>,
    /// Centre of the rotation; required with `angular`.
    #[key(Vector, unit = "length", example = "[0.0, 1.0]")]
    about: Option<Vec<f64>>,
}

fn linear(v: &View) -> Option<Vec<f64>> {
    v.vector("linear")
}

/// The angular velocity in space.
fn angular(v: &View) -> Option<Vec<f64>> {
    match v.get::<Option<f64>>("angular").flatten() {
        Some(about_z) => Some(vec![0.0, 0.0, about_z]),
        None if v.has("angular") => v.get("angular"),
        None => Some(vec![0.0; 3]),
    }
}

/// The loads of a case.
pub(super) fn loads(v: &View) -> Option<Vec<Option<LoadSpec>>> {
    v.each("load", load)
}

/// The supports of a case.
pub(super) fn supports(v: &View) -> Option<Vec<Option<SupportSpec>>> {
    v.each("support", support)
}

/// Reads a `[[load]]`.
fn load(v: &View) -> Option<LoadSpec> {
    let given: Vec<_> = ["traction", "pressure", "body_force"].into_iter().filter(|k| v.has(k)).collect();
    let place = if given == ["body_force"] { "body" } else { "on" };
    let other = if place == "body" { "on" } else { "body" };
    if given.len() != 1 || !v.has(place) || v.has(other) {
        let had = if given.is_empty() { "no force".to_owned() } else { given.join(", ") };
        let places: Vec<_> = ["on", "body"].into_iter().filter(|k| v.has(k)).collect();
        let where_ = if places.is_empty() { "no place".to_owned() } else { places.join(", ") };
        let what = format!("the load needs exactly one force and its place; it has {had} and {where_}");
        let help = "give `on` with `traction` or `pressure`, or `body` with `body_force`";
        let why = "tractions and pressures act on sides, a body force acts in a body";
        return v.wrong_key("", what, why, help);
    }
    let LoadKeys { name, on, body, traction, pressure, body_force, table } = LoadKeys::read(v)?;
    let kind = match given[0] {
        "traction" => LoadKind::Traction { on: on?, value: traction? },
        "pressure" => LoadKind::Pressure { on: on?, value: pressure? },
        _ => LoadKind::BodyForce { body: body?, value: body_force? },
    };
    let table = match table {
        Some(file) => match load_table::read(&v.folder.join(&file), &file) {
            Ok(table) => Some(table),
            Err(error) => {
                let what = format!("the table \"{file}\" cannot be used");
                return v.wrong("table", what, error.why, error.help);
            }
        },
        None => None,
    };
    Some(LoadSpec { name, kind, table })
}

/// Reads a `[[support]]`.
fn support(v: &View) -> Option<SupportSpec> {
    let SupportKeys { name, on, fix, moment_about, r#move } = SupportKeys::read(v)?;
    let (normal, axes): (Vec<_>, Vec<_>) =
        fix.into_iter().flatten().partition(|direction| direction == "normal");
    let axis = |direction: &String| ["x", "y", "z"].iter().position(|axis| axis == direction);
    let moves = r#move.map_or_else(Vec::new, |by| displacements([&by.x, &by.y, &by.z]));
    Some(SupportSpec {
        name,
        on,
        fix: axes.iter().map(axis).collect::<Option<_>>()?,
        normal: !normal.is_empty(),
        moment_about,
        moves,
    })
}

/// Displacements along x, y and z, where they are given, each with its direction.
pub(super) fn displacements(along: [&Option<FormulaSpec>; 3]) -> Vec<(usize, FormulaSpec)> {
    along.into_iter().enumerate().filter_map(|(i, formula)| Some((i, formula.clone()?))).collect()
}

/// Reads a body's initial velocity; a rigid-body motion is converted to formulas.
pub(super) fn velocity(v: &View) -> Option<Vec<FormulaSpec>> {
    let dimension = v.dimension?;
    if v.table.get("velocity").is_some_and(|node| node.table().is_none()) {
        return v.get("velocity");
    }
    let v = v.at("velocity")?;
    let Velocity { linear, angular, about } = Velocity::read(&v)?;
    if linear.len() != dimension || angular.len() != 3 {
        return None;
    }
    if angular.iter().all(|component| *component == 0.0) {
        return Some(linear.into_iter().map(FormulaSpec::Number).collect());
    }
    if dimension == 1 {
        let why = "the case has dimension = 1";
        return v.wrong("angular", "a bar cannot rotate", why, "leave `angular` out");
    }
    if !v.has("about") {
        let help = if dimension == 2 { "add `about = [x, y]`" } else { "add `about = [x, y, z]`" };
        return v.wrong("angular", "the rotation has no centre", "a body rotates about a point", help);
    }
    let about = about.filter(|about| about.len() == dimension)?;
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
