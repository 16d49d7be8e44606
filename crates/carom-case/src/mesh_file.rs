//! A mesh from a .msh file. It is read together with the case, so that its errors are reported at
//! the key that names it. The resolved case stores its hash, so that a run is never resumed with a
//! different mesh.

use std::path::Path;

use carom_solid::{Element, Mesh, generate, gmsh};

use super::MeshSpec;
use super::no_mesh::NoMesh;
use super::view::View;
use carom_record::available_memory;

/// The named physical group of a file as a mesh: a curve in dimension 1, a surface in dimension 2,
/// a volume in space.
fn group(file: gmsh::MshFile, dimension: usize, name: &str, slits: bool) -> Result<Mesh, gmsh::MshError> {
    let file = file.with_slits(slits);
    match dimension {
        1 => file.bar(name),
        3 => file.volume(name),
        _ => file.body(name),
    }
}

/// What a mesh from a file is for.
#[derive(Clone, Copy)]
pub(super) struct Purpose {
    /// Its dimension.
    pub dimension: usize,
    /// Element of the body, if it is known.
    pub element: Option<Element>,
    /// Whether the body is the extrusion of the mesh.
    pub extruded: bool,
}

/// Reads the table of a mesh from a file; its path is relative to the folder of the case.
pub(super) fn read(v: &View, purpose: Purpose) -> Option<MeshSpec> {
    let Purpose { dimension, element, extruded } = purpose;
    let (name, slits) = (v.text("file")?, v.flag("slits")?);
    let (named, other) = if dimension == 3 { ("volume", "surface") } else { ("surface", "volume") };
    // The table of an extrusion has no such key.
    if v.has(other) && !extruded {
        let what = format!("the body of a file is its `{named}`, not its `{other}`");
        let why = format!("the case has dimension = {dimension}");
        return v.report(v.problem(other, what, why, format!("write `{named}`")).at_key());
    }
    let surface = v.text(named)?;
    let file = v.file("file")?;
    let wrong = |key: &str, what: String, why: String, help: &str| {
        // A file of several bodies is reported once.
        if key == "file" && v.has_problem(|known| known.what == what) {
            return None;
        }
        v.wrong(key, what, why, help)
    };
    let bytes = match bytes(&file) {
        Ok(bytes) => bytes,
        Err(why) => {
            let what = format!("the mesh \"{name}\" cannot be read");
            return wrong("file", what, why, "check the path; it is relative to the folder of the case");
        }
    };
    let mesh = match gmsh::read(&bytes).and_then(|file| group(file, dimension, &surface, slits)) {
        Ok(mesh) => mesh,
        Err(error) => {
            // `slits` may be misspelt, which `conform` reports.
            let unknown = || {
                v.table.0.iter().any(|e| !["file", "surface", "volume", "slits"].contains(&e.key.as_str()))
            };
            if matches!(error.fault, gmsh::Fault::Coincident { .. }) && unknown() {
                return None;
            }
            let key = if matches!(error.fault, gmsh::Fault::NoName { .. }) { named } else { "file" };
            return wrong(key, format!("{name}: {error}"), error.why(), error.help());
        }
    };
    let found = if extruded { generate::extruded(mesh.element)? } else { mesh.element };
    if let Some(element) = element.filter(|e| *e != found && e.dimension() == found.dimension()) {
        let of = if extruded { "the extrusion of " } else { "" };
        let what = format!("{of}\"{surface}\" of {name} has {found:?} cells, not {element:?}");
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
    Some(MeshSpec::File {
        file,
        surface,
        slits,
        hash: blake3::hash(&bytes).to_hex().to_string(),
        nodes: mesh.nodes.len(),
        cells: mesh.cell_count(),
        sides: mesh.sides.into_keys().collect(),
        repairs: mesh.repairs,
        parts: 1,
    })
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

/// The mesh of a resolved case, if its file is still the one the case was resolved with.
///
/// # Errors
/// Why it cannot be read, or is not a mesh.
pub(crate) fn mesh(
    file: &Path,
    dimension: usize,
    surface: &str,
    slits: bool,
    hash: &str,
) -> Result<Mesh, NoMesh> {
    let bytes = unchanged(file, hash)?;
    let none = |error: gmsh::MshError| NoMesh::File { file: file.to_owned(), error: Box::new(error) };
    gmsh::read(&bytes).and_then(|f| group(f, dimension, surface, slits)).map_err(none)
}

/// The file of a mesh that was read with its case, once more.
pub(super) fn again(spec: &MeshSpec) -> Option<gmsh::MshFile> {
    let MeshSpec::File { file, hash, .. } = spec else { return None };
    gmsh::read(&unchanged(file, hash).ok()?).ok()
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

impl MeshSpec {
    /// Whether the mesh is still the one the case was resolved with: that its file is there and
    /// unchanged.
    ///
    /// # Errors
    /// A message with the file's name.
    pub fn verify(&self) -> Result<(), NoMesh> {
        match self.source() {
            Self::File { file, hash, .. } => unchanged(file, hash).map(|_| ()),
            _ => Ok(()),
        }
    }
}
