//! Directories of new runs; existing ones are never overwritten.

use std::path::{Path, PathBuf};

use crate::command::STDIN;
use crate::exit::Failure;

/// The directory of a new run, which is not created here: `--out`, or `runs/NAME`, `runs/NAME-2`, …
/// with the name of the case file.
pub(crate) fn of_run(case: &Path, out: Option<&Path>) -> Result<PathBuf, Failure> {
    if let Some(out) = out {
        return if out.exists() {
            let what = format!("{} exists already, and Carom never overwrites a run", out.display());
            Err(Failure::Argument { what, help: "name another directory, or omit --out".to_owned() })
        } else {
            Ok(out.to_owned())
        };
    }
    let case = if case == Path::new(STDIN) { Path::new("stdin") } else { case };
    let name = case.file_stem().map_or_else(|| "run".to_owned(), |stem| stem.to_string_lossy().into_owned());
    Ok(free(Path::new("runs"), &name))
}

fn free(parent: &Path, name: &str) -> PathBuf {
    let first = parent.join(name);
    if !first.exists() {
        return first;
    }
    let mut others = (2..).map(|n: u64| parent.join(format!("{name}-{n}")));
    others.find(|path| !path.exists()).unwrap_or(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_count_up() {
        let parent = std::env::temp_dir().join(format!("carom-directory-{}", std::process::id()));
        assert_eq!(free(&parent, "impact"), parent.join("impact"));
        for (made, next) in [("impact", "impact-2"), ("impact-2", "impact-3")] {
            std::fs::create_dir_all(parent.join(made)).unwrap();
            assert_eq!(free(&parent, "impact"), parent.join(next));
        }
        assert!(of_run(Path::new("impact.toml"), Some(&parent)).is_err());
        std::fs::remove_dir_all(&parent).unwrap();
    }
}
