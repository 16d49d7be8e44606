//! Boundary conditions and loads: fixed and moving supports, forces on sides and in bodies.

use serde::{Deserialize, Serialize};

use super::formula::FormulaSpec;
use crate::keys::Kind::{Choices, Formula, Formulas, Name, Sides, Vector};
use crate::keys::{self, IN_SPACE_AND_TIME, Keys, View};
use crate::load_table::{self, TableSpec};

/// Sides fixed or moved in some directions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SupportSpec {
    /// Name; the reaction forces of a named support are recorded.
    pub name: Option<String>,
    /// Sides, `body.side`.
    pub on: Vec<String>,
    /// Fixed directions: 0 is x, 1 is y.
    pub fix: Vec<usize>,
    /// Whether the direction across each side is fixed, which must be plane.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub normal: bool,
    /// Point about which the moment of the reactions is recorded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moment_about: Option<Vec<f64>>,
    /// Prescribed displacements by direction: formulas in X, Y, t.
    #[serde(rename = "move", default)]
    pub moves: Vec<(usize, FormulaSpec)>,
}

/// Displacement boundary condition: sides fixed in some directions with `fix`, or moved with
/// `move`.
#[derive(Keys)]
#[keys(name = "[[support]]")]
pub(crate) struct SupportKeys {
    /// Name; the reaction forces of a named support are recorded.
    #[key(Name, example = "\"floor\"")]
    name: Option<String>,
    /// Sides that are constrained.
    #[key(example = "[\"prism.bottom\"]")]
    on: Vec<String>,
    /// Directions that are fixed; normal: that of the side, which must be plane and normal to x, y
    /// or z.
    #[key(Choices(&["x", "y", "z", "normal"]), example = "[\"x\", \"y\"]")]
    fix: Option<Vec<String>>,
    /// Point about which the moment of the reactions is recorded too, for a named support in
    /// dimension 2 or 3.
    #[key(Vector, unit = "length", example = "[0.0, 0.0]")]
    moment_about: Option<Vec<f64>>,
    /// Prescribed displacements by direction, from the reference positions: zero at t = 0, and
    /// after `initial.from` those at the end of that run; velocity and acceleration are the time
    /// derivatives of the formula.
    #[key(example = "{ y = \"-0.1*t\" }")]
    r#move: Option<Move>,
}

/// Displacements of a side from its reference position.
#[derive(Keys)]
#[keys(name = "move")]
struct Move {
    /// Displacement along x.
    #[key(Formula(IN_SPACE_AND_TIME), unit = "length", example = "\"0.1*t\"")]
    x: Option<FormulaSpec>,
    /// Displacement along y.
    #[key(Formula(IN_SPACE_AND_TIME), unit = "length", example = "\"-0.1*t\"")]
    y: Option<FormulaSpec>,
    /// Displacement along z; dimension 3.
    #[key(Formula(IN_SPACE_AND_TIME), unit = "length", example = "\"0.1*t\"")]
    z: Option<FormulaSpec>,
}

/// A load on sides (`on` with `traction` or `pressure`) or in a body (`body` with `body_force`).
/// Formulas are functions of the reference position X, Y, Z and the time t.
#[derive(Keys)]
#[keys(name = "[[load]]")]
pub(crate) struct LoadKeys {
    /// Name used in messages.
    #[key(Name, example = "\"press\"")]
    name: Option<String>,
    /// Loaded sides, with `traction` or `pressure`.
    #[key(Sides, example = "[\"prism.top\"]")]
    on: Option<Vec<String>>,
    /// Loaded body, with `body_force`.
    #[key(Name, example = "\"prism\"")]
    body: Option<String>,
    /// The material of a body of several in whose cells the `body_force` acts.
    #[key(Name, example = "\"pad\"")]
    material: Option<String>,
    /// Dead load per reference area.
    #[key(
        Formulas(IN_SPACE_AND_TIME),
        unit = "mass/(length·time²)",
        example = "[\"0\", \"-5*min(t/0.1, 1)\"]"
    )]
    traction: Option<Vec<FormulaSpec>>,
    /// Follower load per current area, acting against the outward normal; in plane stress per
    /// current length and undeformed thickness.
    #[key(Formula(IN_SPACE_AND_TIME), unit = "mass/(length·time²)", example = "\"2*t\"")]
    pressure: Option<FormulaSpec>,
    /// Dead load per reference volume.
    #[key(Formulas(IN_SPACE_AND_TIME), unit = "mass/(length²·time²)", example = "[\"0\", \"-3*X\"]")]
    body_force: Option<Vec<FormulaSpec>>,
    /// CSV file with the columns t and value: a factor on the load, linearly interpolated in time.
    /// Steps take loads at their ends, or in their middle.
    #[key(example = "\"amplitude.csv\"")]
    table: Option<String>,
}

/// A load: forces on sides or in a body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LoadSpec {
    /// Name used in messages.
    pub name: Option<String>,
    /// The force, and where it acts.
    pub kind: LoadKind,
    /// Factor over time.
    pub table: Option<TableSpec>,
}

impl LoadSpec {
    /// Sides it acts on; none for a body force.
    pub fn sides(&self) -> &[String] {
        match &self.kind {
            LoadKind::Traction { on, .. } | LoadKind::Pressure { on, .. } => on,
            LoadKind::BodyForce { .. } => &[],
        }
    }

    /// Description for messages.
    pub fn label(&self) -> String {
        match (&self.name, &self.kind) {
            (Some(name), _) => name.clone(),
            (None, LoadKind::BodyForce { body, .. }) => format!("in {body}"),
            (None, _) => format!("on {}", self.sides().join(", ")),
        }
    }
}

/// A force, and where it acts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LoadKind {
    /// Dead load per reference area.
    Traction {
        /// Sides, `body.side`.
        on: Vec<String>,
        /// Components, formulas in X, Y, t.
        value: Vec<FormulaSpec>,
    },
    /// Follower load per current area, acting against the outward normal.
    Pressure {
        /// Sides, `body.side`.
        on: Vec<String>,
        /// Formula in X, Y, t.
        value: FormulaSpec,
    },
    /// Dead load per reference volume.
    BodyForce {
        /// Body.
        body: String,
        /// The material in whose cells it acts; none: everywhere.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        material: Option<String>,
        /// Components, formulas in X, Y, t.
        value: Vec<FormulaSpec>,
    },
}

/// The loads of a case.
pub(crate) fn loads(v: &View) -> Option<Vec<Option<LoadSpec>>> {
    v.each("load", load)
}

/// The supports of a case.
pub(crate) fn supports(v: &View) -> Option<Vec<Option<SupportSpec>>> {
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
    if place == "on" && v.has("material") {
        let what = "a load on a side has no `material`";
        let why = "`material` restricts a `body_force` to the cells of one material of its body";
        return v.wrong_key("material", what, why, "leave it out; name the part of the side in the mesh");
    }
    let LoadKeys { name, on, body, material, traction, pressure, body_force, table } = LoadKeys::read(v)?;
    let kind = match given[0] {
        "traction" => LoadKind::Traction { on: on?, value: traction? },
        "pressure" => LoadKind::Pressure { on: on?, value: pressure? },
        _ => LoadKind::BodyForce { body: body?, material, value: body_force? },
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
pub(crate) fn displacements(along: [&Option<FormulaSpec>; 3]) -> Vec<(usize, FormulaSpec)> {
    along.into_iter().enumerate().filter_map(|(i, formula)| Some((i, formula.clone()?))).collect()
}

/// Variables of a load's formulas in a space of this dimension.
pub fn load_variables(dimension: usize) -> Vec<&'static str> {
    keys::variables(IN_SPACE_AND_TIME, dimension)
}
