//! Examples in messages: a key that names a body, a material or a side is shown with a name from
//! the case.

use super::keys::{Key, Kind};
use super::tree::{Node, Table};

/// Names defined in a case.
#[derive(Default)]
pub(super) struct Names {
    bodies: Vec<String>,
    materials: Vec<String>,
    /// `body.side`, by body; only built-in shapes, since the sides of mesh files are not known yet.
    sides: Vec<Vec<String>>,
}

impl Names {
    pub(super) fn of(case: &Table) -> Self {
        let tables =
            |key| case.get(key).and_then(Node::list).unwrap_or_default().iter().filter_map(Node::table);
        let name = |table: &Table| table.get("name").and_then(Node::text).map(str::to_owned);
        let sides = |body: &Table| {
            let shape = body.get("mesh").and_then(Node::table).and_then(|mesh| mesh.get("shape")?.text());
            let sides = sides_of(shape.unwrap_or_default());
            sides.iter().map(|side| Some(format!("{}.{side}", name(body)?))).collect::<Option<Vec<_>>>()
        };
        Self {
            bodies: tables("body").filter_map(name).collect(),
            materials: tables("material").filter_map(name).collect(),
            sides: tables("body").filter_map(sides).filter(|sides| !sides.is_empty()).collect(),
        }
    }

    /// A value of a key, as TOML; `dimension`: of its vectors.
    pub(super) fn example(&self, key: &Key, dimension: Option<usize>) -> String {
        let one = |names: &[String], none: &str| format!("{:?}", names.first().map_or(none, String::as_str));
        match (key.kind, key.name) {
            (Kind::Side | Kind::SideOr(_), name) => format!("{:?}", self.side(name == "primary")),
            (Kind::Sides, _) => format!("[{:?}]", self.side(false)),
            (Kind::Choice(_), "element") => {
                format!("{:?}", ["L3", "T6", "Tet10"][dimension.unwrap_or(2).clamp(1, 3) - 1])
            }
            (Kind::Name, "body") => one(&self.bodies, "BODY"),
            (Kind::Name, "material") => one(&self.materials, "MATERIAL"),
            (Kind::Angular, _) if dimension == Some(3) => format!("[0.0, 0.0, {}]", key.example),
            (Kind::Rotation(_), _) if dimension == Some(3) => {
                format!("{{ axis = [0.0, 0.0, 1.0], angle = {} }}", key.example)
            }
            (
                Kind::Vector
                | Kind::Direction
                | Kind::Counts(_)
                | Kind::Formulas(_)
                | Kind::FormulasOr(..)
                | Kind::Table(_),
                _,
            ) => in_dimension(key.example, dimension),
            _ => key.example.to_owned(),
        }
    }

    /// `--set material.NAME.density=2.0`, with a material of the case.
    pub(super) fn override_example(&self) -> String {
        let material = self.materials.first().map_or("NAME", String::as_str);
        format!("for example --set time.step=1e-3 or --set material.{material}.density=2.0")
    }

    /// A side of the first body, or of the last one.
    fn side(&self, last: bool) -> &str {
        let sides = if last { self.sides.last() } else { self.sides.first() };
        sides.and_then(|sides| sides.first()).map_or("BODY.SIDE", String::as_str)
    }
}

/// An example with its vectors in another dimension: along z there is nothing, or one more number
/// of cells; a single component is one that is not zero.
pub fn in_dimension(example: &str, dimension: Option<usize>) -> String {
    let Some(dimension) = dimension else { return example.to_owned() };
    let mut out = String::new();
    for (i, part) in example.split('[').enumerate() {
        let (inner, rest) = part.split_once(']').unwrap_or((part, ""));
        let mut components: Vec<&str> = inner.split(',').map(str::trim).collect();
        let is_vector = (2..=3).contains(&components.len()) && components.iter().all(|x| is_component(x));
        if i > 0 {
            out.push('[');
        }
        if i == 0 || !is_vector || components.len() == dimension {
            out.push_str(part);
            continue;
        }
        if dimension == 1 {
            let one = components.iter().find(|x| x.parse() != Ok(0.0)).unwrap_or(&components[0]);
            components = vec![one];
        } else if dimension == 2 {
            components.pop();
        } else {
            components.push(if components[0].parse::<usize>().is_ok() { components[1] } else { "0.0" });
        }
        out.push_str(&components.join(", "));
        out.push(']');
        out.push_str(rest);
    }
    out
}

/// A number or a formula.
fn is_component(text: &str) -> bool {
    text.parse::<f64>().is_ok() || text.starts_with('"')
}

/// Sides of the built-in shapes; first the one most likely to be in contact.
pub fn sides_of(shape: &str) -> &'static [&'static str] {
    match shape {
        "interval" => &["left", "right"],
        "rectangle" => &["top", "bottom", "left", "right"],
        "disc" => &["arc"],
        "half-disc" => &["arc", "axis"],
        "ring" => &["outer", "inner"],
        "polygon" => &["side1"],
        "box" => &["top", "bottom", "left", "right", "front", "back"],
        "ball" => &["sphere"],
        "cylinder" => &["side", "bottom", "top"],
        "tube" => &["outer", "inner", "bottom", "top"],
        "extrusion" => &["top", "bottom"],
        _ => &[],
    }
}
