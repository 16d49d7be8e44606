//! A rigid triangulated surface from a file in STL or from Gmsh. It is read together with the case,
//! so that its errors are reported at the key that names it; the resolved case stores its hash.

use std::path::PathBuf;

use carom_solid::{Triangles, gmsh, stl};
use serde::{Deserialize, Serialize};

use super::keys::Kind::Number;
use super::keys::{Keys, POSITIVE, View};
use super::mesh_file::{bytes, unchanged};
use super::no_mesh::NoMesh;

/// A rigid triangulated surface, with the vertices of its triangles counter-clockwise as seen from
/// outside. It may be closed, or open: past its rim there is no contact, and behind it a body is
/// inside. Nodes of bodies must not penetrate it; its own edges and vertices do not meet facets of
/// bodies between their nodes. A node that slides across a convex edge of more than 30° leaves the
/// surface; in a groove it is constrained by one of the faces only.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Keys)]
#[keys(name = "surface")]
pub struct SurfaceSpec {
    /// A file in STL, text or binary, or a .msh of Gmsh with triangles of order 1; relative to the
    /// folder of the case.
    #[key(example = "\"part.stl\"")]
    pub file: PathBuf,
    /// Physical surface of a .msh. Default: all triangles of the file.
    #[key(example = "\"tool\"")]
    pub group: Option<String>,
    /// Factor of the coordinates of the file.
    #[key(Number(POSITIVE), default = "1.0")]
    pub scale: f64,
    /// Whether inside and outside are exchanged.
    #[key(default = "false")]
    pub reverse: bool,
    /// BLAKE3 of the file.
    pub hash: String,
    /// Number of triangles of the surface.
    pub triangles: usize,
    /// Number of edges of the surface with a triangle on one side only.
    pub rim: usize,
    /// Number of triangles between touching solids, which are not part of the surface.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub inner: usize,
}

#[allow(clippy::trivially_copy_pass_by_ref)] // as serde calls it
fn is_zero(count: &usize) -> bool {
    *count == 0
}

/// Why a file gives no surface: the key at fault, what, why, and what to try.
struct Fault {
    key: &'static str,
    what: String,
    why: String,
    help: String,
}

/// The triangles of a file, or of a physical group in it.
fn triangles(bytes: &[u8], group: Option<&str>) -> Result<Triangles, Fault> {
    let help = "repair the surface where it was made: merge its points, remove what is there twice, orient its \
        triangles counter-clockwise as seen from outside";
    let why = "a rigid surface has one outside: at most two triangles at an edge, oriented alike, and one fan at a corner";
    let no_surface = |what: String| Fault { key: "file", what, why: why.to_owned(), help: help.to_owned() };
    if !bytes.starts_with(b"$MeshFormat") {
        if group.is_some() {
            let what = "a file in STL has no groups".to_owned();
            let why = "`group` is a physical surface of a file from Gmsh".to_owned();
            return Err(Fault { key: "group", what, why, help: "leave it out".to_owned() });
        }
        return stl::read(bytes).map_err(|error| match error {
            stl::StlError::Surface(error) => no_surface(error.to_string()),
            stl::StlError::Cut(_) => Fault {
                key: "file",
                what: error.to_string(),
                why: "the file was cut, perhaps while it was copied or written".to_owned(),
                help: "copy it again, or save it again where it was made".to_owned(),
            },
            stl::StlError::Format(_) => Fault {
                key: "file",
                what: error.to_string(),
                why: "the file is read as STL, text or binary, since it does not begin with $MeshFormat as a mesh from Gmsh".to_owned(),
                help: "save it again as STL, or as .msh with Gmsh".to_owned(),
            },
        });
    }
    let of_msh = |error: gmsh::MshError| {
        let key = if matches!(error.fault, gmsh::Fault::NoName { .. }) { "group" } else { "file" };
        Fault { key, what: error.to_string(), why: error.why(), help: error.help().to_owned() }
    };
    let file = gmsh::read(bytes).map_err(of_msh)?;
    file.triangles(group).map_err(|error| match error {
        gmsh::SurfaceError::File(error) => of_msh(error),
        gmsh::SurfaceError::Surface(error) => no_surface(error.to_string()),
    })
}

impl SurfaceSpec {
    /// The surface with what its file says.
    pub(crate) fn resolved(self, v: &View) -> Option<Self> {
        if self.scale <= 0.0 {
            return None;
        }
        let name: String = v.get("file")?;
        let found = bytes(&self.file)
            .map_err(|why| {
                let what = format!("the surface \"{name}\" cannot be read");
                let help = "check the path; it is relative to the folder of the case".to_owned();
                Fault { key: "file", what, why, help }
            })
            .and_then(|bytes| triangles(&bytes, self.group.as_deref()).map(|triangles| (bytes, triangles)));
        match found {
            Ok((bytes, triangles)) => Some(Self {
                hash: blake3::hash(&bytes).to_hex().to_string(),
                triangles: triangles.corners().len(),
                rim: triangles.rim(),
                inner: triangles.inner(),
                ..self
            }),
            Err(Fault { key, what, why, help }) => {
                let what = if what.contains(&name) { what } else { format!("{name}: {what}") };
                v.wrong(key, what, why, help)
            }
        }
    }

    /// The triangles of a resolved case, if the file is still the one the case was resolved with.
    ///
    /// # Errors
    /// Why it cannot be read.
    pub fn triangles(&self) -> Result<Triangles, NoMesh> {
        let bytes = unchanged(&self.file, &self.hash)?;
        let none = |fault: Fault| NoMesh::Unreadable(format!("{}: {}", self.file.display(), fault.what));
        let triangles = triangles(&bytes, self.group.as_deref()).map_err(none)?;
        Ok(triangles.placed(self.scale, self.reverse))
    }
}
