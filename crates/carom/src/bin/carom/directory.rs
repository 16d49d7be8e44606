//! Directories of new runs; existing ones are never overwritten.

use std::io::ErrorKind;
use std::ops::Deref;
use std::path::{Path, PathBuf};

use crate::command::STDIN;
use crate::exit::Failure;

/// The directory of a new run. One that was created to reserve its name, so that no other process
/// takes it, is removed when this is dropped if nothing was written into it.
pub(crate) struct NewDirectory {
    path: PathBuf,
    reserved: bool,
    /// A parent that was created with it.
    parent: Option<PathBuf>,
}

impl Deref for NewDirectory {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.path
    }
}

impl Drop for NewDirectory {
    fn drop(&mut self) {
        // Directories that are not empty are not removed.
        let removed = self.reserved && std::fs::remove_dir(&self.path).is_ok();
        if let Some(parent) = self.parent.take().filter(|_| removed) {
            let _ = std::fs::remove_dir(parent);
        }
    }
}

/// The directory of a new run: `--out`, which is not created here, or the first free one of
/// `runs/NAME`, `runs/NAME-2`, … with the name of the case file.
pub(crate) fn of_run(case: &Path, out: Option<&Path>) -> Result<NewDirectory, Failure> {
    if let Some(out) = out {
        return given(out, "name another directory, or omit --out");
    }
    let case = if case == Path::new(STDIN) { Path::new("stdin") } else { case };
    let name = case.file_stem().map_or_else(|| "run".to_owned(), |stem| stem.to_string_lossy().into_owned());
    reserved(Path::new("runs"), &name)
}

/// The directory of `--out`, which must not exist and is not created here.
pub(crate) fn given(out: &Path, help: &str) -> Result<NewDirectory, Failure> {
    if out.exists() {
        let what = format!("{} exists already, and Carom never overwrites a run", out.display());
        return Err(Failure::argument(what, help));
    }
    Ok(NewDirectory { path: out.to_owned(), reserved: false, parent: None })
}

/// A new directory `RUN-WORD` beside a run, or `--out`.
pub(crate) fn beside(run: &Path, word: &str, out: Option<&Path>) -> Result<NewDirectory, Failure> {
    if out.is_some() {
        return of_run(run, out);
    }
    let whole = std::path::absolute(run).unwrap_or_else(|_| run.to_owned());
    let name = whole.file_name().map_or_else(|| "run".to_owned(), |name| name.to_string_lossy().into_owned());
    let parent = run.parent().filter(|parent| !parent.as_os_str().is_empty() && run.file_name().is_some());
    reserved(parent.unwrap_or(Path::new(".")), &format!("{name}-{word}"))
}

/// Creates the first of `NAME`, `NAME-2`, … that does not exist. Creating a directory fails if
/// another process has just done so, unlike a look whether it exists.
fn reserved(parent: &Path, name: &str) -> Result<NewDirectory, Failure> {
    let is_new = !parent.exists();
    std::fs::create_dir_all(parent).map_err(|error| Failure::cannot("create", parent, &error))?;
    let mut number = 1_u64;
    loop {
        let path = parent.join(if number == 1 { name.to_owned() } else { format!("{name}-{number}") });
        match std::fs::create_dir(&path) {
            Ok(()) => {
                let parent = is_new.then(|| parent.to_owned());
                return Ok(NewDirectory { path, reserved: true, parent });
            }
            Err(error) if error.kind() == ErrorKind::AlreadyExists => number += 1,
            Err(error) => return Err(Failure::cannot("create", &path, &error)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_count_up_and_unused_ones_are_given_back() {
        let parent = std::env::temp_dir().join(format!("carom-directory-{}", std::process::id()));
        let made = ["impact", "impact-2", "impact-3"].map(|name| {
            let made = reserved(&parent, "impact").unwrap();
            assert_eq!(*made, *parent.join(name));
            made
        });
        std::fs::write(made[1].join("manifest.json"), "").unwrap();
        assert!(of_run(Path::new("impact.toml"), Some(&parent)).is_err());
        drop(made);
        assert!(parent.join("impact-2").is_dir() && !parent.join("impact").exists());
        assert_eq!(*reserved(&parent, "impact").unwrap(), *parent.join("impact"));
        std::fs::remove_dir_all(&parent).unwrap();
        drop(reserved(&parent, "impact").unwrap());
        assert!(!parent.exists());
    }

    /// Many threads at once get as many directories.
    #[test]
    fn a_name_is_given_once() {
        let parent = std::env::temp_dir().join(format!("carom-directories-{}", std::process::id()));
        let made: Vec<NewDirectory> = std::thread::scope(|scope| {
            let each: Vec<_> = (0..8).map(|_| scope.spawn(|| reserved(&parent, "a").unwrap())).collect();
            each.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        let mut names: Vec<_> = made.iter().map(|made| made.to_path_buf()).collect();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), 8);
        drop(made);
        std::fs::remove_dir_all(&parent).unwrap_or_default();
    }
}
