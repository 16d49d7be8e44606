//! Reads the primary of a contact: a side, or a rigid obstacle with its motion.

use std::path::Path;

use super::load::displacements;
use super::problem::Problem;
use super::surface_file;
use super::tree::{Node, Table};
use super::view::{View, formula};
use super::{ObstacleMotion, PrimarySpec};

/// Shapes with the dimension that they need.
const SHAPES: [(&str, Option<usize>); 6] = [
    ("plane", None),
    ("circle", Some(2)),
    ("sphere", Some(3)),
    ("cylinder", Some(3)),
    ("polyline", Some(2)),
    ("surface", Some(3)),
];

/// Reads `primary`.
pub(super) fn read(
    v: &View,
    dimension: Option<usize>,
    folder: &Path,
    path: &str,
    problems: &mut Vec<Problem>,
) -> Option<(PrimarySpec, ObstacleMotion)> {
    let node = v.table.get("primary")?;
    if let Some(side) = node.text() {
        return Some((PrimarySpec::Side(side.to_owned()), ObstacleMotion::Fixed));
    }
    let path = format!("{path}.primary");
    let table = node.table()?;
    // A misspelt key is reported once, by `conform`.
    let is_known = |key: &str| {
        SHAPES.iter().any(|(shape, _)| *shape == key)
            || ["motion", "mass", "velocity", "gravity"].contains(&key)
    };
    if table.0.iter().any(|entry| !is_known(&entry.key)) {
        return None;
    }
    let shape = shape(table, dimension, folder, &path, problems);
    let motion = motion(table, dimension, &path, problems);
    Some((shape?, motion?))
}

fn shape(
    table: &Table,
    dimension: Option<usize>,
    folder: &Path,
    path: &str,
    problems: &mut Vec<Problem>,
) -> Option<PrimarySpec> {
    let given: Vec<_> = SHAPES.into_iter().filter(|(key, _)| table.get(key).is_some()).collect();
    let [(shape, needs)] = given[..] else {
        let names: Vec<_> = given.iter().map(|(name, _)| *name).collect();
        let had = if given.is_empty() { "none".to_owned() } else { names.join(", ") };
        let what = format!("a rigid primary has exactly one shape; this one has {had}");
        let why = "the shape is `plane`, `circle`, `sphere`, `cylinder`, `polyline` or `surface`";
        let [point, normal] = match dimension {
            Some(1) => ["[0.0]", "[1.0]"],
            Some(3) => ["[0.0, 0.0, 0.0]", "[0.0, 0.0, 1.0]"],
            _ => ["[0.0, 0.0]", "[0.0, 1.0]"],
        };
        let help =
            format!("write for example primary = {{ plane = {{ point = {point}, normal = {normal} }} }}");
        problems.push(Problem::new(path, what, why, help).at_key());
        return None;
    };
    if let (Some(needs), Some(d)) = (needs, dimension)
        && needs != d
    {
        let what = format!("a {shape} needs dimension = {needs}");
        let help = match d {
            1 => "use a plane with normal = [1.0] or [-1.0]",
            2 => "use a circle",
            _ => "use a plane, a sphere, a cylinder or a triangulated surface",
        };
        let why = format!("the case has dimension = {d}");
        problems.push(Problem::new(format!("{path}.{shape}"), what, why, help));
        return None;
    }
    let keys = table.get(shape)?.table()?;
    let number = |key: &str, default: f64| keys.get(key).map_or(Some(default), Node::number);
    Some(match shape {
        "plane" => PrimarySpec::Plane { point: numbers(keys, "point")?, normal: numbers(keys, "normal")? },
        "circle" | "sphere" => PrimarySpec::Circle {
            center: numbers(keys, "center")?,
            radius: keys.get("radius")?.number()?,
            inside: keys.get("inside").map_or(Some(false), Node::flag)?,
        },
        "cylinder" => PrimarySpec::Cylinder {
            point: numbers(keys, "point")?,
            axis: numbers(keys, "axis")?,
            radius: keys.get("radius")?.number()?,
            inside: keys.get("inside").map_or(Some(false), Node::flag)?,
        },
        "surface" => surface_file::read(keys, folder, &format!("{path}.surface"), problems)?,
        _ => PrimarySpec::Polyline {
            points: keys
                .get("points")?
                .list()?
                .iter()
                .map(|point| match point.list()? {
                    [x, y] => Some([x.number()?, y.number()?]),
                    _ => None,
                })
                .collect::<Option<_>>()?,
            radius: number("radius", 0.0)?,
        },
    })
}

fn motion(
    table: &Table,
    dimension: Option<usize>,
    path: &str,
    problems: &mut Vec<Problem>,
) -> Option<ObstacleMotion> {
    let given = |key: &str| table.get(key).is_some();
    let mut wrong = |key: &str, what: &str, why: &str, help: &str| {
        problems.push(Problem::new(format!("{path}.{key}"), what, why, help).at_key());
    };
    if given("motion") && given("mass") {
        let why = "a prescribed motion does not depend on a mass";
        wrong("mass", "the obstacle has both `motion` and `mass`", why, "leave one of them out");
        return None;
    }
    if let Some(key) = ["velocity", "gravity"].into_iter().find(|key| given(key) && !given("mass")) {
        let what = format!("`{key}` needs `mass`");
        let why = "it belongs to an obstacle that is free to move";
        wrong(key, &what, why, "add `mass`, or prescribe a `motion`");
        return None;
    }
    if given("mass") {
        let vector = |key| match table.get(key) {
            Some(_) => numbers(table, key),
            None => Some(vec![0.0; dimension?]),
        };
        let mass = table.get("mass")?.number()?;
        return Some(ObstacleMotion::Free {
            mass,
            velocity: vector("velocity")?,
            gravity: vector("gravity")?,
        });
    }
    let Some(keys) = table.get("motion") else { return Some(ObstacleMotion::Fixed) };
    let keys = keys.table()?;
    if keys.0.iter().any(|entry| !["x", "y", "z", "rotate", "about"].contains(&entry.key.as_str())) {
        return None;
    }
    let turns = keys.get("rotate").is_some();
    if turns != keys.get("about").is_some() {
        let (key, help) = if turns { ("rotate", "add `about = [x, y]`") } else { ("about", "add `rotate`") };
        let what = "`rotate` and `about` belong together";
        wrong(&format!("motion.{key}"), what, "an obstacle turns about a point by an angle", help);
        return None;
    }
    let absent: &[&str] = match dimension {
        Some(1) => &["y", "z", "rotate"],
        Some(2) => &["z"],
        Some(3) => &["rotate"],
        _ => &[],
    };
    if let (Some(d), Some(key)) = (dimension, absent.iter().find(|key| keys.get(key).is_some())) {
        let what = format!("there is no motion `{key}` in dimension {d}");
        let why = format!("the case has dimension = {d}");
        let axes = ["x", "x and y", "x, y and z"][d.clamp(1, 3) - 1];
        let help = format!("an obstacle moves along {axes} here; in the plane it also turns");
        wrong(&format!("motion.{key}"), &what, &why, &help);
        return None;
    }
    let moves = displacements(keys)?;
    if moves.is_empty() && !turns {
        let why = "a motion has at least one of `x`, `y`, `z` and `rotate`";
        wrong("motion", "the motion is empty", why, "leave `motion` out for a fixed obstacle");
        return None;
    }
    let rotate = match keys.get("rotate") {
        Some(angle) => Some((formula(angle)?, numbers(keys, "about")?)),
        None => None,
    };
    Some(ObstacleMotion::Prescribed { moves, rotate })
}

fn numbers(table: &Table, key: &str) -> Option<Vec<f64>> {
    table.get(key)?.list()?.iter().map(Node::number).collect()
}
