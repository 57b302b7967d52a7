//! Hidden names beside a file or folder in the making, and what becomes of those that a killed run has left.

use std::fs::{self, File, Metadata, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile, TempDir};

use super::signals::{Unfinished, pause, remove, watch};

const NEW: &str = ".polhode-new";
const OLD: &str = ".polhode-old";
/// Random letters of a name; that of the process would do only where no two containers share a folder.
const LETTERS: usize = 6;
/// File systems take names of 255 bytes.
const LONGEST: usize = 200;

/// A file that takes the place of `target` later; nobody else may read it if `is_private`.
pub(super) fn file(target: &Path, is_private: bool) -> io::Result<(NamedTempFile, Unfinished)> {
    watch();
    let (folder, prefix) = hidden(target)?;
    clear(folder, &prefix, target);
    let mut builder = builder(&prefix);
    if !is_private {
        share(&mut builder);
    }
    let mut paused = pause();
    loop {
        let file = builder.tempfile_in(folder)?;
        let is_taken = matches!(file.as_file().try_lock(), Err(TryLockError::WouldBlock));
        // another run may have taken it for abandoned before it was locked
        if !is_taken && file.path().exists() {
            let unfinished = Unfinished::new(file.path(), &mut paused);
            return Ok((file, unfinished));
        }
    }
}

/// Lets others read the file, as far as the user's mask lets them.
#[cfg(unix)]
fn share(builder: &mut Builder<'_, '_>) {
    use std::os::unix::fs::PermissionsExt;
    builder.permissions(fs::Permissions::from_mode(0o666));
}

#[cfg(not(unix))]
fn share(_: &mut Builder<'_, '_>) {}

/// The same for a folder. The file is the lock, which ends with the process.
pub(super) fn folder(target: &Path) -> io::Result<(TempDir, Option<File>, Unfinished)> {
    watch();
    let (parent, prefix) = hidden(target)?;
    clear(parent, &prefix, target);
    let mut paused = pause();
    loop {
        let folder = builder(&prefix).tempdir_in(parent)?;
        let lock = File::open(folder.path()).ok();
        let is_taken =
            lock.as_ref().is_some_and(|lock| matches!(lock.try_lock(), Err(TryLockError::WouldBlock)));
        if !is_taken && folder.path().exists() {
            let unfinished = Unfinished::new(folder.path(), &mut paused);
            return Ok((folder, lock, unfinished));
        }
    }
}

fn builder(prefix: &str) -> Builder<'_, 'static> {
    let mut builder = Builder::new();
    builder.prefix(prefix).suffix(NEW).rand_bytes(LETTERS);
    builder
}

/// The folder of `target` and the beginning of the hidden names in it, so that a rename stays on one file system.
fn hidden(target: &Path) -> io::Result<(&Path, String)> {
    let name = target.file_name().ok_or(io::ErrorKind::InvalidInput)?.to_string_lossy();
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let ends = name.char_indices().map(|(start, c)| start + c.len_utf8());
    let end = ends.take_while(|end| *end <= LONGEST).last().unwrap_or(0);
    Ok((folder, format!(".{}.", &name[..end])))
}

/// Where the old folder waits while the new one of this path takes its place.
pub(super) fn old_beside(new: &Path) -> PathBuf {
    new.with_extension(&OLD[1..])
}

/// A lock on what stands at `path`, if no living process holds one.
pub(super) fn lock(path: &Path) -> Option<File> {
    let is_plain = fs::symlink_metadata(path).is_ok_and(|found| found.is_file() || found.is_dir());
    File::open(path).ok().filter(|file| is_plain && file.try_lock().is_ok())
}

/// Removes what killed runs have left; an old folder whose place is empty returns to it.
fn clear(folder: &Path, prefix: &str, target: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let Some(rest) = name.to_str().and_then(|name| name.strip_prefix(prefix)) else { continue };
        let is_old = rest.ends_with(OLD);
        let letters = rest.strip_suffix(if is_old { OLD } else { NEW });
        if letters.is_none_or(|letters| letters.len() != LETTERS) {
            continue;
        }
        let path = entry.path();
        let Some(_lock) = lock(&path) else { continue };
        if !(is_old && !target.exists() && fs::rename(&path, target).is_ok()) {
            remove(&path);
        }
    }
}

/// Gives what stands at `path` the owner and the mode of the `old`, as far as the system allows it.
#[cfg(unix)]
pub(super) fn take_over(old: &Metadata, path: &Path) {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, chown};
    let mut mode = old.mode() & 0o7777;
    let (owner, group) = (Some(old.uid()), Some(old.gid()));
    if chown(path, owner, group).is_err() && chown(path, None, group).is_err() {
        // what the old group was allowed is not for another one
        mode &= !0o2070;
    }
    let _ = fs::set_permissions(path, fs::Permissions::from_mode(mode));
}

#[cfg(not(unix))]
pub(super) fn take_over(old: &Metadata, path: &Path) {
    let _ = fs::set_permissions(path, old.permissions());
}
