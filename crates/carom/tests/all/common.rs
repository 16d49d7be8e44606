//! What the tests of the binary share: a place to run it in.

#![allow(dead_code)] // each test file uses its part

use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

/// The impact of the paper.
pub(crate) const IMPACT: &str = include_str!("../../../../cases/impact/impact.toml");

/// The impact on a coarse mesh: 400 steps, about half a second.
pub(crate) const COARSE: [&str; 4] =
    ["--set", "body.cylinder.mesh.size=0.25", "--set", "body.prism.mesh.cells=[4,2]"];

/// A square of two triangles.
pub(crate) const SQUARE: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat
$PhysicalNames\n1\n2 1 \"square\"\n$EndPhysicalNames
$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes
$Elements\n2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 3 4\n$EndElements\n";

/// A directory of its own per test, removed when it ends.
pub(crate) struct Place(pub(crate) PathBuf);

impl Place {
    pub(crate) fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("carom-command-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(crate) fn file(&self, name: &str, bytes: impl AsRef<[u8]>) -> &Self {
        std::fs::write(self.0.join(name), bytes).unwrap();
        self
    }

    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_carom"));
        command.current_dir(&self.0).args(arguments).stdin(Stdio::null());
        command
    }

    pub(crate) fn carom(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// A run into `out` that is killed after the checkpoint that follows that of its start.
    pub(crate) fn killed(&self, mut command: Command, out: &str) {
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        while !self.0.join(out).join("checkpoint/b.bin").is_file() {
            assert!(child.try_wait().unwrap().is_none(), "the run ended without a checkpoint");
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        child.kill().unwrap();
        child.wait().unwrap();
    }

    pub(crate) fn entries(&self) -> Vec<String> {
        let names = std::fs::read_dir(&self.0)
            .unwrap()
            .map(|e| e.unwrap().file_name().to_string_lossy().into_owned());
        let mut names: Vec<_> = names.collect();
        names.sort();
        names
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}
