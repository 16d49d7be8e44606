//! `carom mesh`: the meshes of a case as one file, for Gmsh or ParaView.

use std::io::Write;
use std::path::{Path, PathBuf};

use carom::case::{Case, Document, Problem};
use carom::recording::block;
use carom_record::FieldSet;
use carom_solid::{Mesh, gmsh};

use crate::exit::{Exit, Failure};
use crate::out;

/// Write the meshes of a case into one file, for Gmsh or ParaView
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  carom mesh impact.toml --out impact.msh
  carom mesh impact.toml --set body.cylinder.mesh.size=0.05 --out fine.vtu")]
pub(crate) struct Arguments {
    /// The case file
    case: PathBuf,
    /// File to write: .msh (Gmsh 4.1, with the names of bodies and sides) or .vtu; must not exist
    /// yet
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Replace a value of the case, as in `carom run`
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let path = &arguments.out;
    let msh = match path.extension().and_then(|e| e.to_str()) {
        Some("msh") => true,
        Some("vtu") => false,
        _ => {
            let what = format!("{} is neither .msh nor .vtu", path.display());
            let help = "use a name that ends in .msh (for Gmsh) or .vtu (for ParaView)";
            return Err(Failure::argument(what, help));
        }
    };
    if path.exists() {
        let what = format!("{} exists already and is not overwritten", path.display());
        return Err(Failure::argument(what, "give another file name"));
    }
    let (case, document) = super::case(&arguments.case, &arguments.sets)?;
    let bytes = match (case.dimension, msh) {
        (1, true) => return Err(Failure::argument("bars cannot be written as .msh", "write them as .vtu")),
        (_, false) => vtu(&case, &meshes(&case, &document)?)?,
        (_, true) => {
            let meshes = meshes(&case, &document)?;
            let named: Vec<_> = case.bodies.iter().map(|b| b.name.as_str()).zip(&meshes).collect();
            gmsh::write_msh41(&named).into_bytes()
        }
    };
    write(path, &bytes)?;
    out::line(&path.display().to_string())?;
    Ok(Exit::Done)
}

fn meshes(case: &Case, document: &Document) -> Result<Vec<Mesh>, Failure> {
    let mesh = |(k, spec): (usize, &carom::case::BodySpec)| {
        spec.make_mesh(case.dimension).map_err(|why| {
            let what = format!("the mesh of body \"{}\" cannot be generated", spec.name);
            Failure::Case(document.diagnose_all(&[Problem::new(
                format!("body[{k}].mesh"),
                what,
                why.to_string(),
                "",
            )]))
        })
    };
    case.bodies.iter().enumerate().map(mesh).collect()
}

/// All bodies in one file; they share no points.
fn vtu(case: &Case, meshes: &[Mesh]) -> Result<Vec<u8>, Failure> {
    let mut fields = FieldSet::default();
    for (spec, mesh) in case.bodies.iter().zip(meshes) {
        let first = fields.points.len();
        fields
            .points
            .extend(mesh.nodes.iter().map(|x| std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0))));
        fields.blocks.push(block(&spec.name, mesh, first));
    }
    fields.to_vtu(0.0).map_err(|e| Failure::System { what: e.to_string() })
}

/// Writes a new file atomically; an existing one is not overwritten.
fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let failed = |e: std::io::Error| Failure::System { what: format!("{}: {e}", path.display()) };
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    // The same permissions as for any other file of the user.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder).map_err(failed)?;
    file.write_all(bytes).and_then(|()| file.as_file().sync_all()).map_err(failed)?;
    file.persist_noclobber(path).map(|_| ()).map_err(|e| failed(e.error))
}
