//! `carom new`: a new folder with a commented case.

use std::io::ErrorKind;
use std::path::PathBuf;

use crate::exit::{Exit, Failure};
use crate::out;

/// Create a folder with a commented case to start from
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  carom new drop
  carom new fall --template impact-3d
  carom new drop --template gmsh
  carom new studies/bar --template bar-1d")]
pub(crate) struct Arguments {
    /// Folder to create, which must not exist yet; the case in it has the same name
    name: PathBuf,
    /// The case to start from
    #[arg(long, value_enum, default_value = "impact-2d")]
    template: Template,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Template {
    /// A disc strikes a block
    #[value(name = "impact-2d")]
    Impact2d,
    /// A bar strikes a rigid wall, with its exact solution
    #[value(name = "bar-1d")]
    Bar1d,
    /// A box tumbles over a floor, in space
    #[value(name = "impact-3d")]
    Impact3d,
    /// Bodies and sides from a Gmsh mesh
    Gmsh,
}

impl Template {
    fn case(self) -> &'static str {
        match self {
            Self::Impact2d => include_str!("../../../../templates/impact-2d.toml"),
            Self::Bar1d => include_str!("../../../../templates/bar-1d.toml"),
            Self::Impact3d => include_str!("../../../../templates/impact-3d.toml"),
            Self::Gmsh => include_str!("../../../../templates/gmsh.toml"),
        }
    }

    /// Files besides the case.
    fn files(self) -> &'static [(&'static str, &'static [u8])] {
        match self {
            Self::Gmsh => &[
                ("mesh.geo", include_bytes!("../../../../templates/mesh.geo")),
                ("mesh.msh", include_bytes!("../../../../templates/mesh.msh")),
            ],
            _ => &[],
        }
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let folder = &arguments.name;
    let Some(name) = folder.file_name().and_then(|n| n.to_str()) else {
        return Err(Failure::argument(
            format!("{} is not a valid folder name", folder.display()),
            "give a name such as `carom new drop`",
        ));
    };
    if let Some(parent) = folder.parent().filter(|p| !p.as_os_str().is_empty()) {
        std::fs::create_dir_all(parent).map_err(|e| Failure::cannot("create", parent, &e))?;
    }
    std::fs::create_dir(folder).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => Failure::argument(
            format!("{} exists already and is not overwritten", folder.display()),
            "choose another name",
        ),
        _ => Failure::cannot("create", folder, &error),
    })?;
    let schema = serde_json::to_string_pretty(&carom::case::schema()).map_err(std::io::Error::from)?;
    let case = format!("{name}.toml");
    let mut files =
        vec![(case.as_str(), arguments.template.case().as_bytes()), ("schema.json", schema.as_bytes())];
    files.extend(arguments.template.files());
    for (file, bytes) in files {
        let path = folder.join(file);
        std::fs::write(&path, bytes).map_err(|e| Failure::cannot("write", &path, &e))?;
    }
    let case = folder.join(case);
    let quoted = if case.to_string_lossy().contains(' ') {
        format!("'{}'", case.display())
    } else {
        case.display().to_string()
    };
    out::line(&format!(
        "{}\n\nnext:\n  carom check {quoted}\n  carom run {quoted}\n\n\
         An editor that supports TOML schemas (Taplo, Even Better TOML) completes and explains keys with {}.",
        case.display(),
        folder.join("schema.json").display()
    ))?;
    Ok(Exit::Done)
}
