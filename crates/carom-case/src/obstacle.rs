//! Reads the primary of a contact: a side, or a rigid obstacle with its motion.

use super::load::displacements;
use super::surface_file;
use super::view::View;
use super::{FormulaSpec, ObstacleMotion, PrimarySpec};

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
pub(super) fn read(v: &View, dimension: Option<usize>) -> Option<(PrimarySpec, ObstacleMotion)> {
    if let Some(side) = v.text("primary") {
        return Some((PrimarySpec::Side(side), ObstacleMotion::Fixed));
    }
    let rigid = v.at("primary").filter(|rigid| v.has("primary") && !rigid.has_unknown_key())?;
    let (shape, motion) = (shape(&rigid, dimension), motion(&rigid, dimension));
    Some((shape?, motion?))
}

fn shape(v: &View, dimension: Option<usize>) -> Option<PrimarySpec> {
    let given: Vec<_> = SHAPES.into_iter().filter(|(key, _)| v.has(key)).collect();
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
        return v.report(v.problem("", what, why, help).at_key());
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
        return v.wrong(shape, what, why, help);
    }
    let v = v.at(shape)?;
    Some(match shape {
        "plane" => PrimarySpec::Plane { point: v.numbers("point")?, normal: v.numbers("normal")? },
        "circle" | "sphere" => PrimarySpec::Circle {
            center: v.numbers("center")?,
            radius: v.number("radius")?,
            inside: v.flag("inside")?,
        },
        "cylinder" => PrimarySpec::Cylinder {
            point: v.numbers("point")?,
            axis: v.numbers("axis")?,
            radius: v.number("radius")?,
            inside: v.flag("inside")?,
        },
        "surface" => surface_file::read(&v)?,
        _ => PrimarySpec::Polyline { points: v.points("points")?, radius: v.number("radius")? },
    })
}

fn motion(v: &View, dimension: Option<usize>) -> Option<ObstacleMotion> {
    if v.has("motion") && v.has("mass") {
        let why = "a prescribed motion does not depend on a mass";
        return v.report(
            v.problem("mass", "the obstacle has both `motion` and `mass`", why, "leave one of them out")
                .at_key(),
        );
    }
    if let Some(key) = ["velocity", "gravity"].into_iter().find(|key| v.has(key) && !v.has("mass")) {
        let why = "it belongs to an obstacle that is free to move";
        return v.report(
            v.problem(key, format!("`{key}` needs `mass`"), why, "add `mass`, or prescribe a `motion`")
                .at_key(),
        );
    }
    if v.has("mass") {
        let d = dimension?;
        return Some(ObstacleMotion::Free {
            mass: v.number("mass")?,
            velocity: if v.has("velocity") { v.numbers("velocity")? } else { vec![0.0; d] },
            gravity: if v.has("gravity") {
                v.formulas("gravity")?
            } else {
                vec![FormulaSpec::Number(0.0); d]
            },
        });
    }
    if !v.has("motion") {
        return Some(ObstacleMotion::Fixed);
    }
    let v = v.at("motion").filter(|motion| !motion.has_unknown_key())?;
    let turns = v.has("rotate");
    if turns != v.has("about") {
        let (key, help) = if turns { ("rotate", "add `about = [x, y]`") } else { ("about", "add `rotate`") };
        let what = "`rotate` and `about` belong together";
        return v.report(v.problem(key, what, "an obstacle turns about a point by an angle", help).at_key());
    }
    let absent: &[&str] = match dimension {
        Some(1) => &["y", "z", "rotate"],
        Some(2) => &["z"],
        Some(3) => &["rotate"],
        _ => &[],
    };
    if let (Some(d), Some(key)) = (dimension, absent.iter().find(|key| v.has(key))) {
        let what = format!("there is no motion `{key}` in dimension {d}");
        let why = format!("the case has dimension = {d}");
        let axes = ["x", "x and y", "x, y and z"][d.clamp(1, 3) - 1];
        let help = format!("an obstacle moves along {axes} here; in the plane it also turns");
        return v.report(v.problem(key, what, why, help).at_key());
    }
    let moves = displacements(&v)?;
    if moves.is_empty() && !turns {
        let why = "a motion has at least one of `x`, `y`, `z` and `rotate`";
        return v.report(
            v.problem("", "the motion is empty", why, "leave `motion` out for a fixed obstacle").at_key(),
        );
    }
    let rotate = if turns { Some((v.formula("rotate")?, v.numbers("about")?)) } else { None };
    Some(ObstacleMotion::Prescribed { moves, rotate })
}
