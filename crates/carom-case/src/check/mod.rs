//! Checks across tables: names and references, sides, dimensions, steps.

mod contact;
mod expect;
mod fallback;
mod friction;
mod joined;
mod linear;
mod loads;
mod restitution;
mod scheme;
mod ties;
mod time;

use carom_solid::Element;

use super::columns;
use super::document::{Document, joined};
use super::draft::Draft;
use super::keys::Keys;
use super::problem::{Problem, is_within};
use super::spec::SKIN;
use super::suggest;
use super::tree::{Node, Table};
use super::{BodySpec, MaterialSpec, MeshSpec, SchemeSpec};

/// Adds the problems found across tables.
pub(super) fn problems(document: &Document, draft: &Draft, misspelt: &[String], problems: &mut Vec<Problem>) {
    let mut check = Check { document, draft, misspelt, problems };
    check.dimension();
    for list in ["material", "body", "support", "load", "contact", "tie", "probe", "overlay"] {
        check.unique_names(list);
    }
    check.supports_beside_bodies();
    check.bodies();
    check.supports();
    check.motions();
    check.loads();
    check.starts();
    check.manufactured();
    check.contacts();
    check.ties();
    check.joined();
    check.probes();
    check.time();
    check.requirements_of_scheme();
    check.fallback();
    check.linear();
    check.expects();
}

struct Check<'a> {
    document: &'a Document,
    draft: &'a Draft,
    /// Paths of the tables that have a misspelt key.
    misspelt: &'a [String],
    problems: &'a mut Vec<Problem>,
}

impl<'a> Check<'a> {
    fn add(
        &mut self,
        path: impl Into<String>,
        what: impl Into<String>,
        why: impl Into<String>,
        help: impl Into<String>,
    ) {
        self.problems.push(Problem::new(path, what, why, help));
    }

    fn tables(&self, list: &str) -> &'a [Node] {
        self.document.root().get(list).and_then(Node::list).unwrap_or(&[])
    }

    /// The value of a key of a table in a list, as it was written.
    fn given(&self, list: &str, i: usize, key: &str) -> Option<&'a Node> {
        self.tables(list).get(i)?.table()?.get(key)
    }

    /// The scheme, if it could be read.
    fn scheme(&self) -> Option<&'a SchemeSpec> {
        self.draft.time.as_ref().map(|time| &time.scheme)
    }

    fn is_static(&self) -> bool {
        self.scheme().is_some_and(SchemeSpec::is_static)
    }

    /// Whether a table, or one in it, has a misspelt key; checks that depend on it are then
    /// skipped.
    fn is_misspelt(&self, path: &str) -> bool {
        self.misspelt.iter().any(|table| is_within(table, path))
    }

    /// Names of a list of tables; `None` if one of them cannot be read, occurs twice or has a
    /// misspelt header, because a reference might be to that one.
    fn names(&self, list: &str) -> Option<Vec<&'a str>> {
        let tables = self.tables(list);
        let root = &self.document.root().0;
        if root
            .iter()
            .any(|e| Draft::TABLE.key(&e.key).is_none() && suggest::nearest(&e.key, [list]).is_some())
        {
            return None;
        }
        let names: Option<Vec<_>> = tables.iter().map(|n| n.table()?.get("name")?.text()).collect();
        let twice = |names: &[&str]| names.iter().enumerate().any(|(i, name)| names[..i].contains(name));
        names.filter(|names| !names.is_empty() && !twice(names))
    }

    fn dimension(&mut self) {
        let given = self.document.root().get("dimension").and_then(Node::count);
        if let Some(d) = given.filter(|d| *d > 3) {
            let why = "a case has 1, 2 or 3 dimensions";
            self.add(
                "dimension",
                format!("dimension {d} is not supported"),
                why,
                "use dimension = 1, 2 or 3",
            );
        }
        let plane = self.document.root().get("plane").and_then(Node::text);
        if given.is_some_and(|d| d != 2) && plane == Some("stress") {
            let why = "a bar has no plane state, its only strain is along x; nor has a body in space";
            self.add("plane", "plane = \"stress\" needs dimension = 2", why, "leave it out");
        }
    }

    fn unique_names(&mut self, list: &str) {
        let names: Vec<_> = self.tables(list).iter().map(|n| n.table()?.get("name")?.text()).collect();
        for (i, name) in names.iter().enumerate() {
            if let Some(first) = name.and_then(|_| names[..i].iter().position(|n| n == name)) {
                let name = name.unwrap_or_default();
                let why =
                    format!("{list} number {} already has this name, and names must be unique", first + 1);
                self.add(
                    format!("{list}[{i}].name"),
                    format!("two tables [[{list}]] are named `{name}`"),
                    why,
                    "rename one of them",
                );
            }
        }
    }

    /// No support may have the name of a body: both begin the names of columns.
    fn supports_beside_bodies(&mut self) {
        let name = |node: &Node| node.table()?.get("name")?.text().map(str::to_owned);
        let bodies: Vec<String> = self.tables("body").iter().filter_map(name).collect();
        let supports: Vec<Option<String>> = self.tables("support").iter().map(name).collect();
        for (i, name) in supports.iter().enumerate() {
            if let Some(name) = name.as_ref().filter(|name| bodies.contains(name)) {
                let what = format!("a body and a support are both named `{name}`");
                let why = "the columns of a body and of a support begin with their names";
                self.add(format!("support[{i}].name"), what, why, "rename the support");
            }
        }
    }

    /// Adds a problem with a key of a contact, once for all contacts of its table.
    fn add_unique(
        &mut self,
        path: String,
        what: impl Into<String>,
        why: impl Into<String>,
        help: impl Into<String>,
    ) {
        let problem = Problem::new(path, what, why, help);
        let same = |known: &Problem| known.path == problem.path && known.why == problem.why;
        if !self.problems.iter().any(same) {
            self.problems.push(problem);
        }
    }

    /// Adds a problem with a reference, unless an earlier reference had the same one: the mistake
    /// is then probably in the name that both refer to.
    fn add_once(&mut self, path: String, what: String, why: &str, help: String) {
        if !self.problems.iter().any(|known| known.what == what) {
            self.add(path, what, why, help);
        }
    }

    /// Reports a reference to a name that does not exist.
    fn reference(&mut self, list: &str, name: &str, path: String) {
        let Some(names) = self.names(list).filter(|names| !names.contains(&name)) else { return };
        let why = format!("it must be the name of a table [[{list}]]");
        let help = suggest::help(name, names.iter().copied());
        self.add_once(path, format!("there is no {list} `{name}`"), &why, help);
    }

    /// The body that a side belongs to; reports a side that does not exist.
    fn side(&mut self, side: &str, path: String) -> Option<&'a BodySpec> {
        let bodies = self.names("body")?;
        let Some((name, part)) = side.split_once('.') else {
            let why = "a side is written body.side";
            let help =
                self.body(side).map_or_else(|| format!("the bodies are: {}", bodies.join(", ")), known_sides);
            self.add(path, format!("`{side}` is not a side"), why, help);
            return None;
        };
        if !bodies.contains(&name) {
            let help = suggest::nearest(name, bodies.iter().copied()).map_or_else(
                || format!("the bodies are: {}", bodies.join(", ")),
                |near| format!("did you mean `{near}.{part}`?"),
            );
            self.add_once(path, format!("there is no body `{name}`"), "a side is written body.side", help);
            return None;
        }
        let body = self.body(name)?;
        let place = bodies.iter().position(|body| *body == name)?;
        let sides = body.mesh.sides();
        let is_skin = part == SKIN && self.draft.dimension != Some(1);
        if !is_skin && !sides.iter().any(|s| s == part) && !self.is_misspelt(&format!("body[{place}]")) {
            let help = match suggest::nearest(part, sides.iter().map(String::as_str)) {
                Some(near) => format!("did you mean `{name}.{near}`?"),
                None if sides.is_empty() => no_sides(body, self.draft.dimension.unwrap_or(2)),
                None => "use one of these sides".to_owned(),
            };
            let why = [known_sides(body)]
                .into_iter()
                .chain(inside(body, part).cloned())
                .collect::<Vec<_>>()
                .join("; ");
            self.add_once(path, format!("body `{name}` has no side `{part}`"), &why, help);
            return None;
        }
        Some(body)
    }

    fn body(&self, name: &str) -> Option<&'a BodySpec> {
        self.draft.body.iter().flatten().find(|b| b.name == name)
    }

    /// Whether a body has no mass.
    fn massless(&self, body: &BodySpec) -> bool {
        let names = body.material_names();
        let mut of_body = self.draft.material.iter().flatten().filter(|m| names.contains(&m.name.as_str()));
        of_body.any(|material| material.density == 0.0)
    }

    /// Checks the materials of the groups of a body.
    fn materials(&mut self, i: usize, body: &'a Table) {
        let Some(groups) = body.get("materials").and_then(Node::table) else { return };
        for entry in &groups.0 {
            if let Some(name) = entry.node.text() {
                self.reference("material", name, joined(&format!("body[{i}].materials"), &entry.key));
            }
        }
        let path = format!("body[{i}].materials");
        let mesh = body.get("mesh").and_then(Node::table);
        let of = mesh.and_then(|mesh| mesh.get("of")?.table());
        // An extrusion has the groups of its plane mesh. A mesh without `shape` and `file` is
        // reported elsewhere.
        let is_built_in = |mesh: &Table| mesh.get("file").is_none() && mesh.get("shape").is_some();
        let misspelt = self.misspelt.iter().any(|table| is_within(table, &format!("body[{i}].mesh")));
        if of.or(mesh).is_some_and(is_built_in) && !misspelt {
            let what = "a built-in shape has no `materials`";
            let why = "materials belong to the physical groups of a mesh from a file";
            self.problems.push(
                Problem::new(path, what, why, "write `material`, or use `mesh = { file = … }`").at_key(),
            );
            return;
        }
        let used = |material: &&MaterialSpec| {
            groups.0.iter().any(|entry| entry.node.text() == Some(material.name.as_str()))
        };
        let of_body: Vec<_> = self.draft.material.iter().flatten().filter(used).collect();
        let [light, heavy] = [true, false].map(|light| of_body.iter().find(|m| (m.density == 0.0) == light));
        if let (Some(light), Some(heavy)) = (light, heavy) {
            let what = format!(
                "the materials `{}` without density and `{}` are in one body",
                light.name, heavy.name
            );
            let why = "a body has mass everywhere or nowhere: without mass its balance has no inertia";
            self.add(path, what, why, "give both a density > 0, or both density = 0");
        }
    }

    /// Reports a material that is none of those of a body.
    fn material_of(&mut self, body: &str, material: &str, path: String) {
        let Some(body) = self.body(body) else { return };
        let names = body.material_names();
        // An unknown name is reported where it is.
        let known = self.names("material").unwrap_or_default();
        if names.contains(&material) || names.iter().any(|name| !known.contains(name)) {
            return;
        }
        let what = format!("body `{}` has no material `{material}`", body.name);
        let why = format!("its materials are: {}", names.join(", "));
        let help = suggest::help(material, names.iter().copied());
        self.add_once(path, what, &why, help);
    }

    fn bodies(&mut self) {
        for (i, table) in self.tables("body").iter().enumerate() {
            let text = |key| table.table()?.get(key)?.text();
            if let Some(material) = text("material") {
                self.reference("material", material, format!("body[{i}].material"));
            }
            if let Some(table) = table.table() {
                self.materials(i, table);
            }
            let element: Option<Element> = text("element").and_then(super::keys::word);
            if let (Some(d), Some(element)) = (self.draft.dimension, element)
                && element.dimension() != d
            {
                let help = [
                    "use L2, L3 or L4",
                    "use T3, T6, T10, Q4 or Q9",
                    "use Tet4, Tet10, Tet20, Hex8 or Hex27",
                ][d.clamp(1, 3) - 1];
                let what = format!("the element {element:?} has dimension {}", element.dimension());
                self.add(format!("body[{i}].element"), what, format!("the case has dimension = {d}"), help);
            }
            if let Some(element) = element
                && text("volumetric") != Some("mean")
            {
                self.plastic_flow(i, element);
            }
            if text("volumetric") == Some("mean")
                && let Some(element) = element
            {
                self.mean_dilatation(element, format!("body[{i}].volumetric"));
            }
            let mesh = table.table().and_then(|table| table.get("mesh")?.table());
            let shape_of = |mesh: Option<&'a Table>| mesh?.get("shape")?.text().filter(|s| *s != "rectangle");
            let of = mesh.and_then(|mesh| mesh.get("of")?.table());
            let unfilled = match element {
                Some(Element::Q4 | Element::Q9) => shape_of(mesh).map(|shape| {
                    let why = "of the built-in shapes, quadrilaterals fill rectangles only";
                    (format!("the shape \"{shape}\""), why, "T3, T6 or T10")
                }),
                Some(Element::Hex8 | Element::Hex27) => shape_of(of).map(|shape| {
                    let why =
                        "of the built-in shapes, quadrilaterals, the faces of hexahedra, fill rectangles only";
                    (format!("the extrusion of a \"{shape}\""), why, "Tet4, Tet10 or Tet20")
                }),
                _ => None,
            };
            if let (Some(element), Some((shape, why, others))) = (element, unfilled) {
                let what = format!("the element {element:?} does not fill {shape}");
                let help = format!("use {others}, or a mesh of quadrilaterals from a file");
                self.add(format!("body[{i}].element"), what, why, help);
            }
        }
    }

    /// Reports elements of degree 1 that would lock in plastic flow.
    fn plastic_flow(&mut self, i: usize, element: Element) {
        // A misspelt key of the case itself may be `plane`.
        if self.misspelt.iter().any(String::is_empty) {
            return;
        }
        let is_sheet = self.document.root().get("plane").and_then(Node::text) == Some("stress");
        let other = match element {
            Element::T3 | Element::Q4 if is_sheet => return,
            Element::T3 | Element::Tet4 => String::new(),
            Element::Q4 | Element::Hex8 => ", or volumetric = \"mean\"".to_owned(),
            _ => return,
        };
        let Some(spec) = self.draft.body.get(i).and_then(Option::as_ref) else { return };
        let names = spec.material_names();
        let flows =
            |material: &&MaterialSpec| material.plastic.is_some() && names.contains(&material.name.as_str());
        let Some(material) = self.draft.material.iter().flatten().find(flows) else { return };
        let what = format!("the element {element:?} locks where the material `{}` flows", material.name);
        let why = "plastic flow keeps the volume, and a cell of degree 1 that keeps it at every point can \
                   hardly deform: forces would be far too large";
        let help =
            element.with_degree(2).map_or_else(String::new, |other| format!("use element = \"{other:?}\""));
        self.add(format!("body[{i}].element"), what, why, format!("{help}{other}"));
    }

    fn mean_dilatation(&mut self, element: Element, path: String) {
        use Element::{Hex8, Q4, T3, Tet4};
        let [taking, next] = if element.dimension() == 3 { ["Hex8", "Tet10"] } else { ["Q4", "T6"] };
        let stress = self.document.root().get("plane").and_then(Node::text) == Some("stress");
        let (what, why, help) = match element {
            Q4 if stress => {
                let why = "the thickness changes freely in plane stress, and nothing locks";
                (
                    "volumetric = \"mean\" has no use in plane stress".to_owned(),
                    why,
                    "leave it out".to_owned(),
                )
            }
            Q4 | Hex8 => return,
            T3 | Tet4 => {
                let what = format!("volumetric = \"mean\" changes nothing for {element:?}");
                let why = "the volume ratio of such a cell is constant already";
                (what, why, format!("use {taking} with it, or {next} without"))
            }
            _ => {
                let what = format!("the element {element:?} has no volumetric = \"mean\"");
                let why =
                    "one pressure in a cell is too coarse for cells of higher degree, which hardly lock";
                (what, why, format!("leave it out, or use {taking}"))
            }
        };
        self.add(path, what, why, help);
    }

    fn supports(&mut self) {
        for (i, table) in self.tables("support").iter().enumerate() {
            let texts = |key| {
                let list = table.table().and_then(|t| t.get(key)?.list()).unwrap_or(&[]);
                list.iter().enumerate().filter_map(|(j, n)| Some((j, n.text()?)))
            };
            for (j, side) in texts("on") {
                self.side(side, format!("support[{i}].on[{j}]"));
            }
            if let Some(keys) = table.table().filter(|keys| keys.get("moment_about").is_some()) {
                let why = if self.draft.dimension == Some(1) {
                    "forces on a line have no moment"
                } else if keys.get("name").is_none() {
                    "only the reactions of a named support are recorded"
                } else {
                    ""
                };
                if !why.is_empty() {
                    let help = "leave it out, or name the support in dimension 2 or 3";
                    self.add(format!("support[{i}].moment_about"), "there is no moment to record", why, help);
                }
            }
            let axes = &["x", "y", "z"][..self.draft.dimension.unwrap_or(3).min(3)];
            let missing: Vec<_> = texts("fix").filter(|(_, axis)| !axes.contains(axis)).collect();
            for (j, axis) in missing.into_iter().filter(|(_, axis)| ["y", "z"].contains(axis)) {
                let why = format!("the case has dimension = {}", axes.len());
                let help = format!("use fix = {axes:?}");
                self.add(
                    format!("support[{i}].fix[{j}]"),
                    format!("there is no direction {axis}"),
                    why,
                    help,
                );
            }
        }
    }

    fn probes(&mut self) {
        for (i, probe) in self.draft.probe.iter().enumerate() {
            let Some(probe) = probe else { continue };
            self.reference("body", &probe.body, format!("probe[{i}].body"));
            if let Some(material) = &probe.material {
                self.material_of(&probe.body, material, format!("probe[{i}].material"));
            }
            for (j, quantity) in probe.record.iter().enumerate() {
                let name = quantity.word();
                let path = format!("probe[{i}].record[{j}]");
                if let Some(d) = self.draft.dimension.filter(|d| !columns::exists(*quantity, *d)) {
                    let why = format!("the case has dimension = {d}");
                    let help = if d == 1 {
                        "use ux, vx, ax, sigma_xx, strain_xx, plastic_strain, yielded or det_f"
                    } else {
                        "use a quantity of the plane, sigma_zz or strain_zz"
                    };
                    self.add(path, format!("there is no quantity {name}"), why, help);
                } else if probe.record[..j].contains(quantity) {
                    self.add(
                        path,
                        format!("{name} is recorded twice"),
                        "each quantity is one column",
                        "leave one of them out",
                    );
                }
            }
        }
    }
}

fn known_sides(body: &BodySpec) -> String {
    let sides: Vec<_> = body.mesh.sides().into_iter().map(|side| format!("{}.{side}", body.name)).collect();
    match &sides[..] {
        [] => "no physical group of its file has a part of its boundary".to_owned(),
        sides => format!("its mesh has the sides: {}", sides.join(", ")),
    }
}

/// Message of the repair that left out a part of this side when the mesh was read, if one did.
fn inside<'a>(body: &'a BodySpec, side: &str) -> Option<&'a String> {
    let MeshSpec::File(file) = body.mesh.source() else { return None };
    file.repairs.iter().find(|repair| repair.contains(&format!("\"{side}\"")))
}

/// Advice for a mesh from a file without sides.
fn no_sides(body: &BodySpec, dimension: usize) -> String {
    let example = match dimension {
        1 => "Physical Point(\"left\") = {1};",
        2 => "Physical Curve(\"bottom\") = {1};",
        _ => "Physical Surface(\"bottom\") = {1};",
    };
    let skin = if dimension > 1 {
        format!(", or write `{}.{SKIN}`, its whole boundary", body.name)
    } else {
        String::new()
    };
    format!("add one to the geometry, for example {example} and mesh again{skin}")
}
