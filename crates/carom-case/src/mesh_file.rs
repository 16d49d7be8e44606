//! A mesh from a .msh file. It is read together with the case, so that its errors are reported at
//! the key that names it. The resolved case stores its hash, so that a run is never resumed with a
//! different mesh.

use std::path::{Path, PathBuf};

use carom_solid::{Element, Mesh, generate, gmsh};
use serde::{Deserialize, Serialize};

use super::document::joined;
use super::keys::Kind::Text;
use super::keys::{Key, Keys, View};
use super::no_mesh::NoMesh;
use super::problem::Problem;
use super::suggest;
use carom_record::available_memory;

/// A body from a Gmsh file; its sides are the physical curves (dimension 1: points, dimension 3:
/// surfaces) on its boundary. A group without a name is called by its number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Keys)]
#[keys(name = "mesh from a file")]
pub struct FileMesh {
    /// Path of a .msh file of version 4.1 or 2.2, relative to the folder of the case.
    #[key(Text, example = "\"impact.msh\"")]
    pub file: PathBuf,
    /// Name of the physical surface (dimension 1: curve) that is the body; in dimension 3 give
    /// `volume`. A body with `materials` needs neither: it consists of their groups.
    #[key(Text, unless = "volume", optional = "\"cylinder\"", with = group_name)]
    pub surface: String,
    /// Dimension 3: name of the physical volume that is the body.
    #[key(Text, optional = "\"part\"")]
    #[serde(skip)]
    pub volume: (),
    /// Physical groups whose cells have a material of their own: the regions of the mesh, in this
    /// order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub regions: Vec<String>,
    /// Whether neighbouring cells may have separate nodes at the same place: a closed slit, or
    /// pieces that touch. Otherwise this is an error.
    #[key(default = "false")]
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub slits: bool,
    /// BLAKE3 hash of the file when the case was read.
    pub hash: String,
    /// Number of nodes of the mesh.
    pub nodes: usize,
    /// Number of cells of the mesh.
    pub cells: usize,
    /// Names of the sides of the mesh.
    pub sides: Vec<String>,
    /// Descriptions of the repairs made when the mesh was read.
    pub repairs: Vec<String>,
    /// Number of parts into which every edge is divided.
    #[serde(default = "whole")]
    pub parts: usize,
}

/// The physical group of a file that is the body; empty if the body consists of the groups of its
/// materials.
fn group_name(v: &View) -> Option<String> {
    let named = v.keys.iter().map(|key| key.name).filter(|key| ["surface", "volume"].contains(key));
    let given = named.rev().find_map(|key| v.get::<Option<String>>(key)?);
    if given.is_some() || v.materials.is_some() {
        return Some(given.unwrap_or_default());
    }
    // A value of another type, and a key that is probably misspelt, are reported elsewhere.
    if v.has("surface") || v.has("volume") || v.has_unknown_key() {
        return None;
    }
    let key = if v.dimension == Some(3) && v.keys.iter().any(|key| key.name == "volume") {
        "volume"
    } else {
        "surface"
    };
    let meaning = v.keys.iter().find(|known| known.name == key).map_or_else(String::new, Key::meaning);
    let what = format!("mesh from a file needs `{key}`");
    let why = format!("`{key}` is required. {meaning}");
    let example = if key == "volume" { "part" } else { "cylinder" };
    v.wrong_key("", what, why, format!("add `{key} = \"{example}\"`"))
}

/// Default of `parts`: edges remain as they are in the file.
fn whole() -> usize {
    1
}

/// The named physical group of a file as a mesh: a curve in dimension 1, a surface in dimension 2,
/// a volume in space.
fn group(file: gmsh::MshFile, dimension: usize, of: &FileMesh) -> Result<Mesh, gmsh::MshError> {
    let file = of.with_group(file.with_slits(of.slits), dimension)?.with_regions(of.regions.clone());
    let name = of.group();
    match dimension {
        1 => file.bar(&name),
        3 => file.volume(&name),
        _ => file.body(&name),
    }
}

/// Properties of a body that the mesh from its file must match.
#[derive(Clone, Copy)]
pub(crate) struct Purpose {
    /// Dimension of the mesh in the file: 1, 2 or 3.
    pub(crate) dimension: usize,
    /// Element of the body, if it is known.
    pub(crate) element: Option<Element>,
    /// Whether the body is the extrusion of the mesh.
    pub(crate) extruded: bool,
}

/// The shape of an element's cells.
fn shape(element: Element) -> &'static str {
    match element {
        Element::L2 | Element::L3 | Element::L4 => "lines",
        Element::T3 | Element::T6 | Element::T10 => "triangles",
        Element::Q4 | Element::Q9 => "quadrilaterals",
        Element::Tet4 | Element::Tet10 | Element::Tet20 => "tetrahedra",
        Element::Hex8 | Element::Hex27 => "hexahedra",
    }
}

/// The file's bytes, or why it cannot be read.
pub(super) fn bytes(file: &Path) -> Result<Vec<u8>, String> {
    let facts = std::fs::metadata(file).map_err(|e| match e.kind() {
        std::io::ErrorKind::NotFound => format!("there is no file {}", file.display()),
        _ => e.to_string(),
    })?;
    if !facts.is_file() {
        return Err(format!("{} is not a regular file", file.display()));
    }
    if let Some(available) = available_memory().filter(|available| facts.len() as f64 > *available) {
        let length = facts.len();
        return Err(format!("it has {length} bytes, and {available:.0} bytes of memory are available"));
    }
    std::fs::read(file).map_err(|e| e.to_string())
}

/// The region that a fault is about: its name, or an empty one if it is about the division into
/// regions; none if it is about something else.
fn region_of<'a>(fault: &gmsh::Fault, regions: &'a [String]) -> Option<&'a str> {
    match fault {
        gmsh::Fault::NoName { name, .. } | gmsh::Fault::EmptyRegion { region: name, .. } => {
            regions.iter().find(|region| *region == name).map(String::as_str)
        }
        gmsh::Fault::NoRegion { .. } | gmsh::Fault::SeveralRegions { .. } => Some(""),
        _ => None,
    }
}

/// A problem with the division into materials, at the key `materials` of the body whose mesh `v`
/// is.
fn at_materials(v: &View, region: &str, file: &str, error: &gmsh::MshError) -> Problem {
    let body = v.path.rsplit_once(".mesh").map_or("", |(body, _)| body);
    let path = format!("{body}.materials");
    let what = format!("{file}: {error}");
    if region.is_empty() {
        return Problem::new(path, what, error.why(), error.help());
    }
    let help = match &error.fault {
        gmsh::Fault::NoName { names, .. } => suggest::help(region, names.iter().map(String::as_str)),
        _ => error.help().to_owned(),
    };
    Problem::new(joined(&path, region), what, error.why(), help).at_key()
}

impl FileMesh {
    /// Reads the file and completes the description of the mesh; problems are reported at the keys
    /// of `v`.
    pub(crate) fn resolved(self, v: &View, purpose: Purpose) -> Option<Self> {
        let Purpose { dimension, element, extruded } = purpose;
        let of_materials = v.materials.map_or(&[][..], |groups| &groups.0);
        let mut regions: Vec<String> = of_materials.iter().map(|entry| entry.key.clone()).collect();
        regions.sort_unstable();
        let mut of = Self { regions, ..self };
        let name: String = v.get("file")?;
        let (named, other) = if dimension == 3 { ("volume", "surface") } else { ("surface", "volume") };
        // The table of an extrusion has no such key.
        if v.has(other) && !extruded {
            let what = format!("the body of a file is its `{named}`, not its `{other}`");
            let why = format!("the case has dimension = {dimension}");
            return v.wrong_key(other, what, why, format!("write `{named}`"));
        }
        let wrong = |key: &str, what: String, why: String, help: &str| {
            // A file of several bodies is reported once.
            if key == "file" && v.has_problem(|known| known.what == what) {
                return None;
            }
            v.wrong(key, what, why, help)
        };
        let bytes = match bytes(&of.file) {
            Ok(bytes) => bytes,
            Err(why) => {
                let what = format!("the mesh \"{name}\" cannot be read");
                return wrong("file", what, why, "check the path; it is relative to the folder of the case");
            }
        };
        let mesh = match gmsh::read(&bytes).and_then(|file| group(file, dimension, &of)) {
            Ok(mesh) => mesh,
            Err(error) => {
                if let Some(region) = region_of(&error.fault, &of.regions) {
                    return v.report(at_materials(v, region, &name, &error));
                }
                let key = if matches!(error.fault, gmsh::Fault::NoName { .. }) { named } else { "file" };
                return wrong(key, format!("{name}: {error}"), error.why(), error.help());
            }
        };
        let found = if extruded { generate::extruded(mesh.element)? } else { mesh.element };
        if let Some(element) = element.filter(|e| *e != found && e.dimension() == found.dimension()) {
            let extrusion = if extruded { "the extrusion of " } else { "" };
            let body = of.group();
            let what = format!("{extrusion}\"{body}\" of {name} has {found:?} cells, not {element:?}");
            let wanted = element.degree();
            let in_gmsh = if found.degree() == wanted {
                let cells = if extruded { generate::plane_of(element)? } else { element };
                format!("mesh it with {}", shape(cells))
            } else {
                format!("set Mesh.ElementOrder = {wanted}")
            };
            let help = format!("write element = \"{found:?}\", or {in_gmsh} in Gmsh");
            return wrong(named, what, "the element of a body must be that of its mesh".into(), &help);
        }
        of.hash = blake3::hash(&bytes).to_hex().to_string();
        of.nodes = mesh.nodes.len();
        of.cells = mesh.cell_count();
        of.sides = mesh.sides.into_keys().collect();
        of.repairs = mesh.repairs;
        of.parts = 1;
        Some(of)
    }

    /// The mesh of a resolved case, if its file is still the one the case was resolved with.
    ///
    /// # Errors
    /// Why it cannot be read, or is not a mesh.
    pub(crate) fn mesh(&self, dimension: usize) -> Result<Mesh, NoMesh> {
        let none = |error: gmsh::MshError| NoMesh::File { file: self.file.clone(), error: Box::new(error) };
        let file = gmsh::read(&unchanged(&self.file, &self.hash)?);
        let mesh = file.and_then(|file| group(file, dimension, self)).map_err(none)?;
        Ok(mesh.subdivided(self.parts))
    }

    /// Name of the physical group that is the body; of one that consists of several, all of them.
    pub fn group(&self) -> String {
        if self.surface.is_empty() { self.regions.join(" + ") } else { self.surface.clone() }
    }

    /// The file with the group of the body, also of one that consists of several.
    pub(crate) fn with_group(
        &self,
        file: gmsh::MshFile,
        dimension: usize,
    ) -> Result<gmsh::MshFile, gmsh::MshError> {
        if self.surface.is_empty() {
            file.with_union(dimension, &self.group(), &self.regions)
        } else {
            Ok(file)
        }
    }

    /// Reads the mesh file again; none if it has changed or cannot be read.
    pub(crate) fn again(&self) -> Option<gmsh::MshFile> {
        gmsh::read(&unchanged(&self.file, &self.hash).ok()?).ok()
    }
}

/// The bytes of a file that is still the one with this hash.
pub(super) fn unchanged(file: &Path, hash: &str) -> Result<Vec<u8>, NoMesh> {
    let bytes = bytes(file).map_err(NoMesh::Unreadable)?;
    if blake3::hash(&bytes).to_hex().as_str() == hash {
        return Ok(bytes);
    }
    let file = file.display();
    Err(NoMesh::Unreadable(format!(
        "the mesh file {file} has changed since the run began (BLAKE3 was {hash}): restore the file, or run the case again"
    )))
}
