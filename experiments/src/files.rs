//! Files that are written whole or not at all.

use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::error::Error;

/// Writes `bytes` to `path`: a reader sees the old file or the new one, never a part.
///
/// Pipes and devices, which cannot be replaced, are written to directly.
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    replace_named_by("--out", path, bytes)
}

/// The same for a path that another flag names.
pub(crate) fn replace_named_by(flag: &str, path: &Path, bytes: &[u8]) -> Result<(), Error> {
    // A link is followed, so that its target is replaced and not the link.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let written = match fs::metadata(&target) {
        Ok(old) if old.is_dir() => Err(io::Error::from(io::ErrorKind::IsADirectory)),
        Ok(old) if !old.is_file() => {
            OpenOptions::new().write(true).open(&target).and_then(|mut file| file.write_all(bytes))
        }
        _ => replace_file(&target, bytes),
    };
    written.map_err(|reason| unwritable(flag, path, &reason))
}

fn replace_file(target: &Path, bytes: &[u8]) -> io::Result<()> {
    let temporary = beside(target, "new")?;
    let written = write_synced(&temporary, bytes).and_then(|()| fs::rename(&temporary, target));
    if written.is_err() {
        let _ = fs::remove_file(&temporary);
    }
    written
}

fn write_synced(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = OpenOptions::new().write(true).create_new(true).open(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

/// A hidden name in the same folder, so that a rename stays on one file system.
fn beside(target: &Path, role: &str) -> io::Result<PathBuf> {
    let name = target.file_name().ok_or(io::ErrorKind::InvalidInput)?;
    Ok(target.with_file_name(format!(".{}.{}.{role}", name.to_string_lossy(), std::process::id())))
}

fn unwritable(flag: &str, path: &Path, reason: &io::Error) -> Error {
    Error::Input(format!(
        "{flag}: '{}': cannot be written: {reason}; name a place that exists and that you may write to",
        path.display()
    ))
}

/// A folder of results in the making; it takes its place in [`commit`](Self::commit), or vanishes.
pub(crate) struct Staging {
    target: PathBuf,
    temporary: PathBuf,
}

/// The file by which a folder of results is known, and may be replaced.
pub(crate) const MARK: &str = "run.toml";

impl Staging {
    /// Prepares to write `target`, which is left as it is until the commit.
    ///
    /// # Errors
    /// When no folder can be made there, or when one stands there that is not a folder of results.
    pub(crate) fn new(target: &Path) -> Result<Self, Error> {
        let foreign = fs::read_dir(target).is_ok_and(|mut entries| entries.next().is_some())
            && !target.join(MARK).is_file();
        if foreign {
            return Err(Error::input(
                "--out",
                &target.display().to_string(),
                &format!("holds files but no {MARK}, so it is not a folder of results to be replaced"),
                "move it away or name another --out",
            ));
        }
        let create = || {
            if let Some(parent) = target.parent() {
                fs::create_dir_all(parent)?;
            }
            let temporary = beside(target, "new")?;
            fs::create_dir(&temporary)?;
            Ok(temporary)
        };
        let temporary = create().map_err(|reason| unwritable("--out", target, &reason))?;
        Ok(Self { target: target.to_path_buf(), temporary })
    }

    /// Writes one file of the folder.
    pub(crate) fn write(&self, name: &str, bytes: &[u8]) -> Result<(), Error> {
        let path = self.temporary.join(name);
        write_synced(&path, bytes).map_err(|reason| unwritable("--out", &self.target.join(name), &reason))
    }

    /// Puts the folder in place of the one that stood there.
    pub(crate) fn commit(self) -> Result<(), Error> {
        let exchange = || {
            let old = beside(&self.target, "old")?;
            let replaced = self.target.exists();
            if replaced {
                fs::rename(&self.target, &old)?;
            }
            if let Err(reason) = fs::rename(&self.temporary, &self.target) {
                if replaced {
                    fs::rename(&old, &self.target)?;
                }
                return Err(reason);
            }
            if replaced { fs::remove_dir_all(&old) } else { Ok(()) }
        };
        exchange().map_err(|reason: io::Error| unwritable("--out", &self.target, &reason))
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        // After a commit the temporary folder has moved, and there is nothing to remove.
        let _ = fs::remove_dir_all(&self.temporary);
    }
}

/// Reads a text file; the message of a failure ends in `remedy`.
pub(crate) fn read(path: &Path, remedy: &str) -> Result<String, Error> {
    fs::read_to_string(path)
        .map_err(|reason| Error::Input(format!("{}: cannot be read: {reason}; {remedy}", path.display())))
}

/// Rows for the user: to the file of `--out` when given, else to standard output.
pub(crate) fn emit(text: &str, out: Option<&Path>) -> Result<(), Error> {
    if let Some(path) = out {
        return replace(path, text.as_bytes());
    }
    match io::stdout().lock().write_all(text.as_bytes()).and_then(|()| io::stdout().flush()) {
        // The reader has seen enough: `polhode … | head`.
        Err(reason) if reason.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        Err(reason) => {
            Err(Error::Input(format!("standard output: cannot be written: {reason}; use --out FILE")))
        }
        Ok(()) => Ok(()),
    }
}

/// An empty folder for one test, removed with it.
#[cfg(test)]
pub(crate) mod scratch {
    use std::path::{Path, PathBuf};

    pub(crate) struct Scratch(PathBuf);

    impl Scratch {
        pub(crate) fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("polhode-{name}-{}", std::process::id()));
            let _ = std::fs::remove_dir_all(&path);
            std::fs::create_dir_all(&path).unwrap();
            Self(path)
        }

        pub(crate) fn path(&self) -> &Path {
            &self.0
        }

        pub(crate) fn names(&self) -> Vec<String> {
            let entries = std::fs::read_dir(&self.0).unwrap();
            let mut names: Vec<String> =
                entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
            names.sort();
            names
        }
    }

    impl Drop for Scratch {
        fn drop(&mut self) {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::scratch::Scratch;
    use super::*;

    #[test]
    fn a_file_is_replaced_and_nothing_is_left_beside_it() {
        let scratch = Scratch::new("replace");
        let path = scratch.path().join("rows.csv");
        replace(&path, b"old").unwrap();
        replace(&path, b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(scratch.names(), ["rows.csv"]);
    }

    #[test]
    fn a_folder_or_a_place_below_a_file_is_refused() {
        let scratch = Scratch::new("refuse");
        let file = scratch.path().join("file");
        fs::write(&file, "kept").unwrap();
        for path in [scratch.path().to_path_buf(), file.join("rows.csv"), scratch.path().join("no/rows.csv")]
        {
            let error = replace(&path, b"x").unwrap_err();
            assert_eq!(error.exit_code(), 2);
            assert!(error.to_string().contains(&path.display().to_string()), "{error}");
        }
        assert!(Staging::new(&file.join("smoke/drift")).is_err());
        assert_eq!(scratch.names(), ["file"]);
        assert_eq!(fs::read(&file).unwrap(), b"kept");
    }

    #[test]
    fn results_are_exchanged_as_a_whole() {
        let scratch = Scratch::new("exchange");
        let target = scratch.path().join("drift");
        for (name, content) in [("old.csv", "1"), ("new.csv", "2")] {
            let staging = Staging::new(&target).unwrap();
            staging.write(MARK, b"").unwrap();
            staging.write(name, content.as_bytes()).unwrap();
            staging.commit().unwrap();
        }
        assert!(target.join("new.csv").is_file() && !target.join("old.csv").exists());
        assert_eq!(scratch.names(), ["drift"]);
    }

    #[test]
    fn an_abandoned_folder_vanishes_and_a_foreign_one_is_kept() {
        let scratch = Scratch::new("foreign");
        let target = scratch.path().join("drift");
        drop(Staging::new(&target).unwrap());
        assert!(scratch.names().is_empty());
        fs::create_dir(&target).unwrap();
        fs::write(target.join("thesis.tex"), "years of work").unwrap();
        assert!(Staging::new(&target).err().unwrap().to_string().contains("run.toml"));
    }

    #[test]
    fn a_link_is_followed() {
        let scratch = Scratch::new("link");
        let (file, link) = (scratch.path().join("file"), scratch.path().join("link"));
        fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        replace(&link, b"new").unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    }
}
