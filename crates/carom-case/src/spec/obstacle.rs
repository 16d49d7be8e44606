//! Rigid obstacles: their shapes, and how they move.

use serde::{Deserialize, Serialize};

use super::formula::FormulaSpec;
use super::load::displacements;
use crate::keys::Kind::{Formula, Formulas, Number, Points, Vector};
use crate::keys::{IN_TIME, Keys, NOT_NEGATIVE, POSITIVE, View};
use crate::surface_file::SurfaceSpec;

/// A primary surface that does not deform: exactly one shape, fixed, moved by `motion`, or free
/// with `mass`.
#[derive(Keys)]
#[keys(name = "a rigid primary", later = ["spring"])]
pub(crate) struct Rigid {
    /// A rigid half-space.
    #[key(example = "{ point = [0.0, 0.0], normal = [0.0, 1.0] }")]
    plane: Option<HalfSpace>,
    /// A rigid circle, with bodies outside or inside it; dimension 2.
    #[key(example = "{ center = [0.0, 0.0], radius = 1.0, inside = true }")]
    circle: Option<Circle>,
    /// A rigid sphere, with bodies outside or inside it; dimension 3.
    #[key(example = "{ center = [0.0, 0.0, 0.0], radius = 1.0, inside = true }")]
    sphere: Option<Circle>,
    /// A rigid infinite cylinder, with bodies outside or inside it; dimension 3.
    #[key(example = "{ point = [0.0, 0.0, 0.0], axis = [0.0, 1.0, 0.0], radius = 0.5 }")]
    cylinder: Option<Cylinder>,
    /// A rigid triangulated surface from a file, with bodies outside it; dimension 3.
    #[key(example = "{ file = \"part.stl\" }")]
    surface: Option<SurfaceSpec>,
    /// A rigid chain of segments, solid to the left of the direction of travel; dimension 2.
    #[key(example = "{ points = [[2.0, 0.0], [0.0, 0.0], [-2.0, 1.0]], radius = 0.1 }")]
    polyline: Option<Polyline>,
    /// Prescribed motion by formulas in t, with implicit schemes. Its reaction forces are recorded
    /// under the name of the contact, and its work is external_work.
    #[key(example = "{ x = \"0.1*t\" }")]
    motion: Option<Motion>,
    /// Mass of an obstacle that is free in translation and does not turn; its position and velocity
    /// are recorded under the name of the contact.
    #[key(Number(POSITIVE), unit = "mass", example = "0.5")]
    mass: Option<f64>,
    /// Initial velocity, with `mass`. Default: zero.
    #[key(Vector, unit = "length/time", example = "[0.0, -1.0]")]
    velocity: Option<Vec<f64>>,
    /// Gravitational acceleration, with `mass`: numbers, or formulas in t. Default: zero.
    #[key(Formulas(IN_TIME), unit = "length/time²", example = "[0.0, -9.81]")]
    gravity: Option<Vec<FormulaSpec>>,
}

/// A rigid half-space.
#[derive(Keys)]
#[keys(name = "plane")]
struct HalfSpace {
    /// A point on its boundary.
    #[key(Vector, unit = "length", example = "[0.0, 0.0]")]
    point: Vec<f64>,
    /// Outward normal, of any length > 0.
    #[key(Vector, example = "[0.0, 1.0]")]
    normal: Vec<f64>,
}

/// A rigid circle or sphere.
#[derive(Keys)]
#[keys(name = "circle or sphere")]
struct Circle {
    /// Its centre.
    #[key(Vector, unit = "length", example = "[0.0, 0.0]")]
    center: Vec<f64>,
    /// Its radius.
    #[key(Number(POSITIVE), unit = "length", example = "1.0")]
    radius: f64,
    /// Whether bodies are inside it; outside otherwise.
    #[key(default = "false")]
    inside: bool,
}

/// A rigid infinite cylinder.
#[derive(Keys)]
#[keys(name = "cylinder")]
struct Cylinder {
    /// A point of its axis.
    #[key(Vector, unit = "length", example = "[0.0, 0.0, 0.0]")]
    point: Vec<f64>,
    /// Direction of its axis, of any length > 0.
    #[key(Vector, example = "[0.0, 1.0, 0.0]")]
    axis: Vec<f64>,
    /// Its radius.
    #[key(Number(POSITIVE), unit = "length", example = "0.5")]
    radius: f64,
    /// Whether bodies are inside it; outside otherwise.
    #[key(default = "false")]
    inside: bool,
}

/// A rigid chain of straight segments, with the rigid material to the left of the direction of
/// travel.
#[derive(Keys)]
#[keys(name = "polyline")]
struct Polyline {
    /// Its points in order; closed if the last one repeats the first. The first and last segment of
    /// an open chain continue to infinity.
    #[key(Points(2), unit = "length", example = "[[2.0, 0.0], [0.0, 0.0], [-2.0, 1.0]]")]
    points: Vec<[f64; 2]>,
    /// Radius of the arcs that round the corners, tangent to both segments; 0: sharp corners. At a
    /// sharp concave corner a node is constrained by one of the segments only.
    #[key(Number(NOT_NEGATIVE), unit = "length", default = "0.0")]
    radius: f64,
}

/// Prescribed motion of a rigid obstacle, zero at t = 0: rotation about a point that moves with it.
#[derive(Keys)]
#[keys(name = "motion")]
struct Motion {
    /// Displacement along x.
    #[key(Formula(IN_TIME), unit = "length", example = "\"0.1*t\"")]
    x: Option<FormulaSpec>,
    /// Displacement along y; dimensions 2 and 3.
    #[key(Formula(IN_TIME), unit = "length", example = "\"-0.1*t\"")]
    y: Option<FormulaSpec>,
    /// Displacement along z; dimension 3.
    #[key(Formula(IN_TIME), unit = "length", example = "\"-0.1*t\"")]
    z: Option<FormulaSpec>,
    /// Angle of rotation, in the plane counter-clockwise, in space by the right hand about `axis`;
    /// dimensions 2 and 3.
    #[key(Formula(IN_TIME), unit = "degrees", example = "\"360*t\"")]
    rotate: Option<FormulaSpec>,
    /// Centre of the rotation at t = 0; required with `rotate`.
    #[key(Vector, unit = "length", example = "[0.0, 0.0]")]
    about: Option<Vec<f64>>,
    /// Direction of the axis of the rotation; required with `rotate` in dimension 3.
    #[key(Vector, example = "[0.0, 0.0, 1.0]")]
    axis: Option<Vec<f64>>,
}

/// Shapes with the dimension that they need.
const SHAPES: [(&str, Option<usize>); 6] = [
    ("plane", None),
    ("circle", Some(2)),
    ("sphere", Some(3)),
    ("cylinder", Some(3)),
    ("polyline", Some(2)),
    ("surface", Some(3)),
];

impl Rigid {
    /// The shape of the obstacle in the table of a contact, and its motion.
    pub(crate) fn of(v: &View) -> Option<Obstacle> {
        let v = v.at("primary").filter(|_| v.has("primary"))?;
        let rigid = Self::read(&v)?;
        let motion = rigid.motion(&v);
        Some(Obstacle { shape: rigid.shape(&v)?, motion: motion? })
    }

    fn shape(self, v: &View) -> Option<PrimarySpec> {
        let given: Vec<_> = SHAPES.into_iter().filter(|(key, _)| v.has(key)).collect();
        let [(shape, needs)] = given[..] else {
            let names: Vec<_> = given.iter().map(|(name, _)| *name).collect();
            let had = if given.is_empty() { "none".to_owned() } else { names.join(", ") };
            let what = format!("a rigid primary has exactly one shape; this one has {had}");
            let why = "the shape is `plane`, `circle`, `sphere`, `cylinder`, `polyline` or `surface`";
            let [point, normal] = match v.dimension {
                Some(1) => ["[0.0]", "[1.0]"],
                Some(3) => ["[0.0, 0.0, 0.0]", "[0.0, 0.0, 1.0]"],
                _ => ["[0.0, 0.0]", "[0.0, 1.0]"],
            };
            let help =
                format!("write for example primary = {{ plane = {{ point = {point}, normal = {normal} }} }}");
            return v.wrong_key("", what, why, help);
        };
        if let (Some(needs), Some(d)) = (needs, v.dimension)
            && needs != d
        {
            let what = format!("a {shape} needs dimension = {needs}");
            let help = match d {
                1 => "use a plane with normal = [1.0] or [-1.0]",
                2 => "use a circle",
                _ => "use a plane, a sphere, a cylinder or a triangulated surface",
            };
            return v.wrong(shape, what, format!("the case has dimension = {d}"), help);
        }
        Some(match shape {
            "plane" => {
                let HalfSpace { point, normal } = self.plane?;
                PrimarySpec::Plane { point, normal }
            }
            "circle" | "sphere" => {
                let Circle { center, radius, inside } = self.circle.or(self.sphere)?;
                PrimarySpec::Circle { center, radius, inside }
            }
            "cylinder" => {
                let Cylinder { point, axis, radius, inside } = self.cylinder?;
                PrimarySpec::Cylinder { point, axis, radius, inside }
            }
            "surface" => PrimarySpec::Surface(self.surface?.resolved(&v.at("surface")?)?),
            _ => {
                let Polyline { points, radius } = self.polyline?;
                PrimarySpec::Polyline { points, radius }
            }
        })
    }

    fn motion(&self, v: &View) -> Option<ObstacleMotion> {
        if v.has("motion") && v.has("mass") {
            let why = "a prescribed motion does not depend on a mass";
            return v.wrong_key(
                "mass",
                "the obstacle has both `motion` and `mass`",
                why,
                "leave one of them out",
            );
        }
        if let Some(key) = ["velocity", "gravity"].into_iter().find(|key| v.has(key) && !v.has("mass")) {
            let why = "it belongs to an obstacle that is free to move";
            let help = if v.has("motion") {
                "leave it out: the motion says where the obstacle is at every time"
            } else {
                "add `mass`, or prescribe a `motion`"
            };
            return v.wrong_key(key, format!("`{key}` needs `mass`"), why, help);
        }
        if v.has("mass") {
            let d = v.dimension?;
            let zero = || vec![FormulaSpec::Number(0.0); d];
            return Some(ObstacleMotion::Free {
                mass: self.mass?,
                velocity: self.velocity.clone().unwrap_or_else(|| vec![0.0; d]),
                gravity: self.gravity.clone().unwrap_or_else(zero),
            });
        }
        match &self.motion {
            None => (!v.has("motion")).then_some(ObstacleMotion::Fixed),
            Some(motion) => motion.prescribed(&v.at("motion")?),
        }
    }
}

impl Motion {
    fn prescribed(&self, v: &View) -> Option<ObstacleMotion> {
        let turns = v.has("rotate");
        if turns != v.has("about") {
            let (key, help) =
                if turns { ("rotate", "add `about = [x, y]`") } else { ("about", "add `rotate`") };
            let what = "`rotate` and `about` belong together";
            return v.wrong_key(key, what, "an obstacle turns about a point by an angle", help);
        }
        let absent: &[&str] = match v.dimension {
            Some(1) => &["y", "z", "rotate"],
            Some(2) => &["z", "axis"],
            _ => &[],
        };
        if let (Some(d), Some(key)) = (v.dimension, absent.iter().find(|key| v.has(key))) {
            let what = format!("there is no motion `{key}` in dimension {d}");
            let axes = ["x", "x and y", "x, y and z"][d.clamp(1, 3) - 1];
            let turns = if d == 2 { ", and turns about the normal of the plane" } else { "" };
            let help = format!("an obstacle moves along {axes} here{turns}");
            return v.wrong_key(key, what, format!("the case has dimension = {d}"), help);
        }
        if v.dimension == Some(3) && turns != v.has("axis") {
            let (key, help) =
                if turns { ("rotate", "add `axis = [x, y, z]`") } else { ("axis", "add `rotate`") };
            let what = "`rotate` and `axis` belong together in dimension 3";
            return v.wrong_key(key, what, "an obstacle turns about an axis by an angle", help);
        }
        if self.axis.as_ref().is_some_and(|axis| axis.iter().all(|x| *x == 0.0)) {
            let why = "it is the direction of the axis of the rotation, so its length must be > 0";
            return v.wrong("axis", "the axis is zero", why, "write for example axis = [0.0, 0.0, 1.0]");
        }
        let moves = displacements([&self.x, &self.y, &self.z]);
        if moves.is_empty() && !turns {
            let why = "a motion has at least one of `x`, `y`, `z` and `rotate`";
            return v.wrong_key("", "the motion is empty", why, "leave `motion` out for a fixed obstacle");
        }
        let rotate = self.rotate.clone().zip(self.about.clone());
        Some(ObstacleMotion::Prescribed { moves, rotate, axis: self.axis.clone() })
    }
}

/// A rigid obstacle as it was read.
pub(crate) struct Obstacle {
    pub(crate) shape: PrimarySpec,
    pub(crate) motion: ObstacleMotion,
}

/// Primary side of a contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PrimarySpec {
    /// A side of a body, `body.side`.
    Side(String),
    /// A rigid half-space.
    Plane {
        /// A point on its boundary.
        point: Vec<f64>,
        /// Outward normal, of any length > 0.
        normal: Vec<f64>,
    },
    /// A rigid circle; in space a sphere.
    Circle {
        /// Centre of the circle or sphere.
        center: Vec<f64>,
        /// Radius of the circle or sphere, > 0.
        radius: f64,
        /// Whether bodies are inside the circle or sphere.
        inside: bool,
    },
    /// A rigid infinite cylinder.
    Cylinder {
        /// A point of its axis.
        point: Vec<f64>,
        /// Direction of its axis, of any length > 0.
        axis: Vec<f64>,
        /// Radius of the cylinder, > 0.
        radius: f64,
        /// Whether bodies are inside it.
        inside: bool,
    },
    /// A rigid triangulated surface.
    Surface(SurfaceSpec),
    /// A rigid chain of segments with the material to the left of the direction of travel.
    Polyline {
        /// Points of the chain in order; closed if the last one repeats the first.
        points: Vec<[f64; 2]>,
        /// Radius of its corners, ≥ 0.
        radius: f64,
    },
}

impl PrimarySpec {
    /// Largest coordinate or radius in the formula of its gap, which decides about round-off; zero
    /// where that is made of positions of nodes, or of a file.
    pub fn largest_coordinate(&self) -> f64 {
        let largest = |point: &[f64]| point.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        match self {
            Self::Side(_) | Self::Surface(_) => 0.0,
            Self::Plane { point, .. } => largest(point),
            Self::Circle { center, radius, .. } => radius.max(largest(center)),
            Self::Cylinder { point, radius, .. } => radius.max(largest(point)),
            Self::Polyline { points, radius } => radius.max(largest(points.as_flattened())),
        }
    }

    /// The side of a body; none of a rigid obstacle.
    pub fn side(&self) -> Option<&str> {
        if let Self::Side(side) = self { Some(side) } else { None }
    }
}

/// Motion of a rigid primary.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ObstacleMotion {
    /// The obstacle is fixed.
    #[default]
    Fixed,
    /// The obstacle follows formulas in t.
    Prescribed {
        /// Displacements by direction: 0 is x, 1 is y; the others are zero.
        moves: Vec<(usize, FormulaSpec)>,
        /// Rotation in degrees, counter-clockwise, with its centre.
        rotate: Option<(FormulaSpec, Vec<f64>)>,
        /// Direction of its axis, in space.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        axis: Option<Vec<f64>>,
    },
    /// The obstacle is free in translation and does not turn.
    Free {
        /// Mass of the obstacle, > 0.
        mass: f64,
        /// Initial velocity.
        velocity: Vec<f64>,
        /// Gravitational acceleration: formulas in t.
        gravity: Vec<FormulaSpec>,
    },
}

impl ObstacleMotion {
    /// Whether the obstacle is fixed.
    pub fn is_fixed(&self) -> bool {
        *self == Self::Fixed
    }

    /// Whether the obstacle may move across a line in the plane with a normal.
    pub fn may_cross(&self, normal: [f64; 2]) -> bool {
        match self {
            Self::Fixed => false,
            Self::Prescribed { moves, rotate, .. } => {
                rotate.is_some() || moves.iter().any(|(axis, _)| normal[*axis] != 0.0)
            }
            Self::Free { .. } => true,
        }
    }

    /// Number of nodes that carry the obstacle in a space of some dimension: those of a simplex if
    /// it turns, otherwise one; 0 if it is fixed.
    pub fn nodes(&self, dimension: usize) -> usize {
        match self {
            Self::Fixed => 0,
            Self::Prescribed { rotate: Some(_), .. } => dimension + 1,
            Self::Prescribed { .. } | Self::Free { .. } => 1,
        }
    }
}
