//! The files that this process has opened for reading, so that no output replaces one of them.
//!
//! Nothing else in this crate and in the command opens a file for reading; clippy refuses it.

#![allow(clippy::disallowed_methods, reason = "here files are opened")]

use std::collections::BTreeSet;
use std::fs::{self, File, Metadata};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// A file that was read.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Input {
    /// As it was named.
    name: PathBuf,
    /// Where the name stands, with the links of its folder resolved, and where it leads.
    places: [PathBuf; 2],
    identity: Option<Identity>,
}

/// By which a file is known under every name.
type Identity = (u64, u64);

static INPUTS: Mutex<BTreeSet<Input>> = Mutex::new(BTreeSet::new());

/// Opens a file for reading; from now on no output replaces it.
///
/// # Errors
/// Those of [`File::open`].
pub fn open(path: &Path) -> io::Result<File> {
    let file = File::open(path)?;
    keep(path, path, file.metadata().ok().as_ref());
    Ok(file)
}

/// The same for a file that will be opened later.
pub fn register(path: &Path) {
    if let Ok(found) = fs::metadata(path) {
        keep(path, path, Some(&found));
    }
}

/// Opens a file that outputs may replace: one of the program's own, which it writes again, or of the system.
///
/// # Errors
/// Those of [`File::open`].
pub fn open_own(path: &Path) -> io::Result<File> {
    File::open(path)
}

/// Standard input; the file behind it, if there is one, is not replaced by an output either.
pub fn standard() -> io::Stdin {
    #[cfg(unix)]
    {
        use std::os::fd::AsFd;
        let found = io::stdin().as_fd().try_clone_to_owned().and_then(|end| File::from(end).metadata());
        if let Ok(found) = found {
            keep(Path::new("standard input"), Path::new("/dev/stdin"), Some(&found));
        }
    }
    io::stdin()
}

fn keep(name: &Path, path: &Path, found: Option<&Metadata>) {
    // nothing replaces a pipe or a device
    if found.is_some_and(|found| !found.is_file()) {
        return;
    }
    let input = Input { name: name.to_path_buf(), places: places(path), identity: found.and_then(identity) };
    INPUTS.lock().unwrap_or_else(PoisonError::into_inner).insert(input);
}

/// The name of the input that is the file at `path`, under whichever name, link or spelling.
pub fn same_file(path: &Path) -> Option<PathBuf> {
    let found = fs::metadata(path).ok()?;
    let (known, [_, end]) = (identity(&found), places(path));
    // the number of a file that was removed belongs to another one later
    let is_there = |input: &Input| fs::metadata(&input.places[1]).is_ok_and(|now| identity(&now) == known);
    let is_same = |input: &&Input| {
        input.places[1] == end || (known.is_some() && input.identity == known && is_there(input))
    };
    let inputs = INPUTS.lock().unwrap_or_else(PoisonError::into_inner);
    inputs.iter().find(is_same).map(|input| input.name.clone())
}

/// The name of an input that stands in the folder at `path` or below it.
pub fn within(path: &Path) -> Option<PathBuf> {
    let folder = path.canonicalize().ok()?;
    let inputs = INPUTS.lock().unwrap_or_else(PoisonError::into_inner);
    let found = inputs.iter().find(|input| input.places.iter().any(|place| place.starts_with(&folder)));
    found.map(|input| input.name.clone())
}

fn places(path: &Path) -> [PathBuf; 2] {
    let end = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let place = folder.canonicalize().ok().zip(path.file_name()).map(|(folder, name)| folder.join(name));
    [place.unwrap_or_else(|| end.clone()), end]
}

#[cfg(unix)]
fn identity(found: &Metadata) -> Option<Identity> {
    use std::os::unix::fs::MetadataExt;
    Some((found.dev(), found.ino()))
}

/// Without numbers of files two names are compared with their links resolved.
#[cfg(not(unix))]
fn identity(_: &Metadata) -> Option<Identity> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_input_is_known_under_every_name() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("run.csv"), "t\n0\n").unwrap();
        fs::write(at("other.csv"), "t\n0\n").unwrap();
        fs::create_dir(at("sub")).unwrap();
        assert_eq!(same_file(&at("run.csv")), None);
        assert_eq!(within(folder.path()), None);
        open(&at("run.csv")).unwrap();
        #[cfg(unix)]
        {
            fs::hard_link(at("run.csv"), at("hard.csv")).unwrap();
            std::os::unix::fs::symlink("run.csv", at("soft.csv")).unwrap();
        }
        let names: &[&str] = &["run.csv", "sub/../run.csv", "./run.csv", "hard.csv", "soft.csv"];
        for name in if cfg!(unix) { names } else { &names[..3] } {
            assert_eq!(same_file(&at(name)), Some(at("run.csv")), "{name}");
        }
        for name in ["other.csv", "new.csv"] {
            assert_eq!(same_file(&at(name)), None, "{name}");
        }
        assert_eq!(within(folder.path()), Some(at("run.csv")));
        assert_eq!(within(&at("sub")), None);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_in_a_folder_is_an_input_of_that_folder() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("results")).unwrap();
        fs::write(at("members.csv"), "t\n0\n").unwrap();
        std::os::unix::fs::symlink("../members.csv", at("results/link.csv")).unwrap();
        open(&at("results/link.csv")).unwrap();
        assert_eq!(within(&at("results")), Some(at("results/link.csv")));
    }
}
