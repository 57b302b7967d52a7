//! A folder that is replaced as a whole.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use polhode_files::error::Error;
use polhode_files::inputs;
use polhode_files::text::visible;
use tempfile::TempDir;

use super::replacement::follow;
use super::signals::{Unfinished, pause};
use super::{temporary, unwritable};

/// A folder of results in the making; it takes its place in [`commit`](Self::commit), or vanishes.
pub struct Staging {
    temporary: TempDir,
    _lock: Option<File>,
    _unfinished: Unfinished,
    target: PathBuf,
}

/// The file by which a folder of results is known, and may be replaced.
pub const MARK: &str = "run.toml";

impl Staging {
    /// Prepares to write `target`, which is left as it is until the commit.
    ///
    /// # Errors
    /// When no folder can be made there, or when one stands there that is not a folder of results or holds an input.
    pub fn new(target: &Path) -> Result<Self, Error> {
        check_holds_no_input(target)?;
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
            if fs::metadata(target).is_ok_and(|found| !found.is_dir()) {
                return Err(io::ErrorKind::NotADirectory.into());
            }
            let end = follow(target);
            if let Some(parent) = end.parent() {
                fs::create_dir_all(parent)?;
            }
            Ok((temporary::folder(&end)?, end))
        };
        let ((temporary, lock, unfinished), end) =
            create().map_err(|reason: io::Error| unwritable("--out", target, &reason))?;
        Ok(Self { temporary, _lock: lock, _unfinished: unfinished, target: end })
    }

    /// Writes one file of the folder.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), Error> {
        let _paused = pause();
        let path = self.temporary.path().join(name);
        let write = || {
            let mut file = OpenOptions::new().write(true).create_new(true).open(&path)?;
            file.write_all(bytes)?;
            file.sync_all()
        };
        write().map_err(|reason: io::Error| unwritable("--out", &self.target.join(name), &reason))
    }

    /// Makes one file of the folder, to be written and read piece by piece before the commit.
    pub fn file(&self, name: &str) -> Result<File, Error> {
        let _paused = pause();
        let path = self.temporary.path().join(name);
        let made = OpenOptions::new().read(true).write(true).create_new(true).open(&path);
        made.map_err(|reason| unwritable("--out", &self.target.join(name), &reason))
    }

    /// Opens one file of the folder, to be read before the commit.
    pub fn open(&self, name: &str) -> Result<File, Error> {
        let opened = File::open(self.temporary.path().join(name));
        opened.map_err(|reason| unwritable("--out", &self.target.join(name), &reason))
    }

    /// Removes one file of the folder.
    pub fn remove(&self, name: &str) -> Result<(), Error> {
        let removed = fs::remove_file(self.temporary.path().join(name));
        removed.map_err(|reason| unwritable("--out", &self.target.join(name), &reason))
    }

    /// Puts the folder in place of the one that stood there, which is then removed.
    pub fn commit(self) -> Result<(), Error> {
        check_holds_no_input(&self.target)?;
        if let Ok(old) = fs::metadata(&self.target) {
            temporary::take_over(&old, self.temporary.path());
        }
        let _paused = pause();
        exchange(self.temporary.path(), &self.target)
            .map_err(|reason| unwritable("--out", &self.target, &reason))
    }
}

/// Refuses to replace a folder with a file in it that this process reads.
fn check_holds_no_input(target: &Path) -> Result<(), Error> {
    let Some(input) = inputs::within(target) else { return Ok(()) };
    let rule = format!("it holds the input '{}', which would be lost", visible(&input.display().to_string()));
    Err(Error::input("--out", &target.display().to_string(), &rule, "name another folder"))
}

/// Puts `new` at `target`, and what stood there, if anything did, at `new`.
#[cfg(target_os = "linux")]
fn exchange(new: &Path, target: &Path) -> io::Result<()> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    use rustix::io::Errno;
    // another run may make or remove the target between the two calls
    loop {
        for (flags, other) in [(RenameFlags::EXCHANGE, Errno::NOENT), (RenameFlags::NOREPLACE, Errno::EXIST)]
        {
            match renameat_with(CWD, new, CWD, target, flags) {
                Ok(()) => return Ok(()),
                Err(error) if error == other => {}
                // not every file system can
                Err(Errno::INVAL | Errno::NOSYS | Errno::OPNOTSUPP) => return rename_twice(new, target),
                Err(error) => return Err(error.into()),
            }
        }
    }
}

#[cfg(not(target_os = "linux"))]
fn exchange(new: &Path, target: &Path) -> io::Result<()> {
    rename_twice(new, target)
}

/// The same with a moment between two renames at which nothing stands at `target`; a run that is killed there leaves
/// the old folder to the next one, which puts it back.
fn rename_twice(new: &Path, target: &Path) -> io::Result<()> {
    let old = temporary::old_beside(new);
    loop {
        let _lock = temporary::lock(target);
        let is_replaced = match fs::rename(target, &old) {
            Ok(()) => true,
            Err(error) if error.kind() == io::ErrorKind::NotFound => false,
            Err(error) => return Err(error),
        };
        let placed = fs::rename(new, target);
        match &placed {
            Ok(()) if is_replaced => fs::rename(&old, new)?,
            Err(error) if error.kind() == io::ErrorKind::DirectoryNotEmpty => {
                // another run was faster; its folder is the one to be replaced now
                if is_replaced {
                    fs::remove_dir_all(&old)?;
                }
                continue;
            }
            Err(_) if is_replaced => fs::rename(&old, target)?,
            _ => {}
        }
        return placed;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::scratch::Scratch;

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
    fn both_ways_of_exchange_put_the_one_in_place_of_the_other() {
        for (name, exchange) in [("swap", exchange as fn(&Path, &Path) -> _), ("renames", rename_twice)] {
            let scratch = Scratch::new(name);
            let [new, target] = [".drift.abcdef.polhode-new", "drift"].map(|name| scratch.path().join(name));
            fs::create_dir(&new).unwrap();
            fs::write(new.join("rows"), "1").unwrap();
            exchange(&new, &target).unwrap();
            assert_eq!(scratch.names(), ["drift"], "{name}");
            fs::create_dir(&new).unwrap();
            fs::write(new.join("rows"), "2").unwrap();
            exchange(&new, &target).unwrap();
            assert_eq!(fs::read(target.join("rows")).unwrap(), b"2", "{name}");
            assert_eq!(fs::read(new.join("rows")).unwrap(), b"1", "{name}");
            assert_eq!(scratch.names(), [".drift.abcdef.polhode-new", "drift"], "{name}");
            fs::remove_dir_all(&new).unwrap();
            let gone: io::Result<()> = exchange(&new, &target);
            assert_eq!(gone.unwrap_err().kind(), io::ErrorKind::NotFound, "{name}");
            assert_eq!(fs::read(target.join("rows")).unwrap(), b"2", "{name}");
        }
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
        let file = scratch.path().join("file");
        fs::write(&file, "kept").unwrap();
        assert!(Staging::new(&file).is_err());
        assert_eq!(fs::read(&file).unwrap(), b"kept");
    }

    #[test]
    fn what_a_killed_run_left_is_cleared_and_what_a_living_one_makes_is_not() {
        let scratch = Scratch::new("stale");
        let target = scratch.path().join("drift");
        let living = Staging::new(&target).unwrap();
        let abandoned = scratch.path().join(".drift.abcdef.polhode-new");
        fs::create_dir(&abandoned).unwrap();
        fs::write(abandoned.join("half.csv"), "1").unwrap();
        // killed between the two renames
        let old = scratch.path().join(".drift.abcdef.polhode-old");
        fs::create_dir(&old).unwrap();
        fs::write(old.join(MARK), "old").unwrap();
        for foreign in [".drift.other", ".drift.toolong.polhode-new", ".order.abcdef.polhode-new"] {
            fs::write(scratch.path().join(foreign), "kept").unwrap();
        }
        drop(Staging::new(&target).unwrap());
        assert!(living.temporary.path().is_dir() && !abandoned.exists() && !old.exists());
        assert_eq!(fs::read(target.join(MARK)).unwrap(), b"old");
        drop(living);
        let kept = [".drift.other", ".drift.toolong.polhode-new", ".order.abcdef.polhode-new", "drift"];
        assert_eq!(scratch.names(), kept);
    }

    #[test]
    fn runs_at_the_same_time_leave_one_whole_folder() {
        let scratch = Scratch::new("race");
        let target = scratch.path().join("drift");
        std::thread::scope(|scope| {
            for run in 0..4 {
                let target = &target;
                scope.spawn(move || {
                    for _ in 0..20 {
                        let staging = Staging::new(target).unwrap();
                        staging.write(MARK, format!("{run}").as_bytes()).unwrap();
                        staging.write("rows", format!("{run}").as_bytes()).unwrap();
                        staging.commit().unwrap();
                    }
                });
            }
        });
        assert_eq!(fs::read(target.join(MARK)).unwrap(), fs::read(target.join("rows")).unwrap());
        assert_eq!(scratch.names(), ["drift"]);
    }
}
