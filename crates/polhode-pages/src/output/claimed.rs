//! The files that a process writes, each by one flag: of two outputs on one path the second would replace the first.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use polhode_files::error::Error;

use super::replacement::follow;

static CLAIMED: Mutex<BTreeMap<PathBuf, &'static str>> = Mutex::new(BTreeMap::new());

/// Takes the file at `path` for `flag`.
///
/// # Errors
/// Another flag has taken it, under whichever name; a pipe or a device takes any number of outputs.
pub(super) fn claim(flag: &'static str, path: &Path) -> Result<(), Error> {
    if fs::metadata(path).is_ok_and(|found| !found.is_file()) {
        return Ok(());
    }
    let mut claimed = CLAIMED.lock().unwrap_or_else(PoisonError::into_inner);
    let other = *claimed.entry(place(path)).or_insert(flag);
    if other == flag {
        return Ok(());
    }
    let rule = format!("it would replace {other}");
    Err(Error::input(flag, &path.display().to_string(), &rule, "name another file"))
}

/// Where a file is written: its links followed, and those of its folder resolved.
fn place(path: &Path) -> PathBuf {
    let end = follow(path);
    let folder = end.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let place = folder.canonicalize().ok().zip(end.file_name()).map(|(folder, name)| folder.join(name));
    place.unwrap_or(end)
}

#[cfg(test)]
mod tests {
    use super::super::scratch::Scratch;
    use super::*;

    #[test]
    fn a_file_is_the_output_of_one_flag() {
        let scratch = Scratch::new("claimed");
        let at = |name: &str| scratch.path().join(name);
        fs::create_dir(at("sub")).unwrap();
        claim("--out", &at("rows.csv")).unwrap();
        claim("--out", &at("rows.csv")).unwrap();
        let refused = claim("--figure", &at("sub/../rows.csv")).unwrap_err().to_string();
        assert!(refused.ends_with("it would replace --out; name another file"));
        claim("--figure", &at("rows.svg")).unwrap();
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("rows.csv", at("soft.csv")).unwrap();
            assert!(claim("--report", &at("soft.csv")).is_err());
            claim("--out", Path::new("/dev/null")).unwrap();
            claim("--figure", Path::new("/dev/null")).unwrap();
        }
    }
}
