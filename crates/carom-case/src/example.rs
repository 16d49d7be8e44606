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

    /// A value of a key, as TOML.
    pub(super) fn example(&self, key: &Key) -> String {
        let one = |names: &[String], none: &str| format!("{:?}", names.first().map_or(none, String::as_str));
        match (key.kind, key.name) {
            (Kind::Side | Kind::SideOr(_), name) => format!("{:?}", self.side(name == "primary")),
            (Kind::Sides, _) => format!("[{:?}]", self.side(false)),
            (Kind::Name, "body") => one(&self.bodies, "BODY"),
            (Kind::Name, "material") => one(&self.materials, "MATERIAL"),
            _ => key.example.to_owned(),
        }
    }

    /// `--set body.NAME.element=T6`, with a body of the case.
    pub(super) fn override_example(&self) -> String {
        let body = self.bodies.first().map_or("NAME", String::as_str);
        format!("for example --set time.step=1e-3 or --set body.{body}.element=T6")
    }

    /// A side of the first body, or of the last one.
    fn side(&self, last: bool) -> &str {
        let sides = if last { self.sides.last() } else { self.sides.first() };
        sides.and_then(|sides| sides.first()).map_or("BODY.SIDE", String::as_str)
    }
}

/// Sides of the built-in shapes; first the one most likely to be in contact.
fn sides_of(shape: &str) -> &'static [&'static str] {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::shapes;

    /// Every built-in shape is listed here, with the sides that its documentation names.
    #[test]
    fn sides_are_those_of_the_shapes() {
        for (shape, table) in shapes().tables {
            let sides = sides_of(shape);
            assert!(!sides.is_empty() && sides.iter().all(|side| table.doc.contains(side)), "{shape}");
        }
    }
}
