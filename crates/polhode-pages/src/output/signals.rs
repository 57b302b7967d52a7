//! An interrupted run leaves nothing half-made behind.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};

/// Files and folders that this process is making.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Holds off the cleaning by a signal while files change their places.
pub(super) fn pause() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A temporary that a signal removes, until this is dropped.
pub struct Unfinished(PathBuf);

impl Unfinished {
    /// `paused` shows that no signal was served since the temporary was made.
    pub(super) fn new(path: &Path, paused: &mut BTreeSet<PathBuf>) -> Self {
        paused.insert(path.to_path_buf());
        Self(path.to_path_buf())
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        pause().remove(&self.0);
    }
}

/// Removes a file or a folder; what cannot be removed stays.
pub(super) fn remove(path: &Path) {
    let is_folder = std::fs::symlink_metadata(path).is_ok_and(|found| found.is_dir());
    let _ = if is_folder { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
}

/// From now on SIGINT, SIGTERM and SIGHUP remove what is unfinished before they end the process, and a file that grows beyond
/// the size that the shell allows is refused by the write instead of a signal.
pub(super) fn watch() {
    static WATCHED: Once = Once::new();
    WATCHED.call_once(start);
}

#[cfg(unix)]
fn start() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    let (ready, started) = std::sync::mpsc::channel();
    let serve = move || {
        // nohup ignores SIGHUP; where that is not told, it stays as it is
        let ends = [SIGINT, SIGTERM].into_iter().filter(|signal| is_ignored(*signal) != Some(true));
        let hangs_up = Some(SIGHUP).filter(|signal| is_ignored(*signal) == Some(false));
        let signals = Signals::new(ends.chain(hangs_up).chain([SIGXFSZ]));
        let _ = ready.send(());
        let Ok(mut signals) = signals else { return };
        for signal in signals.forever().filter(|signal| *signal != SIGXFSZ) {
            let paused = pause();
            paused.iter().for_each(|path| remove(path));
            let _ = emulate_default_handler(signal);
        }
    };
    // Without the thread a signal ends the process as it always did, and the next run clears what is left.
    if std::thread::Builder::new().name("signals".into()).spawn(serve).is_ok() {
        let _ = started.recv();
    }
}

#[cfg(not(unix))]
fn start() {}

/// Whether the process was started with `signal` ignored, as a shell does with SIGINT for a command in the background;
/// `None` where the system does not tell.
#[cfg(unix)]
fn is_ignored(signal: i32) -> Option<bool> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"))?;
    let mask = u64::from_str_radix(mask.trim(), 16).ok()?;
    Some(mask >> (signal - 1) & 1 == 1)
}
