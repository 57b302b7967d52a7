//! A file that is replaced as a whole.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::signals::{Unfinished, pause};
use super::temporary;

/// A file in the making: a reader sees the old one or, after [`commit`](Self::commit), the new one, never a part.
///
/// Mode and owner of the old file are kept; its other names, if it has hard links, keep the old contents.
pub enum Replacement {
    /// Drops in this order, so that a signal finds what is left.
    File { file: BufWriter<NamedTempFile>, unfinished: Unfinished, target: PathBuf },
    /// Pipes and devices, which cannot be replaced, are written to directly.
    Device(BufWriter<File>),
}

impl Replacement {
    pub(super) fn new(path: &Path) -> io::Result<Self> {
        let exists = match fs::metadata(path) {
            Ok(old) if old.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
            Ok(old) if !old.is_file() => {
                let device = OpenOptions::new().write(true).open(path)?;
                return Ok(Self::Device(BufWriter::new(device)));
            }
            Ok(_) => true,
            Err(error) if error.kind() == io::ErrorKind::NotFound => false,
            Err(error) => return Err(error),
        };
        let target = follow(path);
        let (file, unfinished) = temporary::file(&target, exists)?;
        Ok(Self::File { file: BufWriter::with_capacity(1 << 16, file), unfinished, target })
    }

    pub(super) fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::File { file, .. } => file.write_all(bytes),
            Self::Device(device) => device.write_all(bytes),
        }
    }

    pub(super) fn commit(self) -> io::Result<()> {
        let (file, unfinished, target) = match self {
            Self::File { file, unfinished, target } => (file, unfinished, target),
            Self::Device(mut device) => return device.flush(),
        };
        let file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
        if let Ok(old) = fs::metadata(&target) {
            temporary::take_over(&old, file.path());
        }
        file.as_file().sync_all()?;
        let paused = pause();
        let placed = file.persist(&target).map_err(|error| error.error);
        drop(paused);
        drop(unfinished);
        placed.map(|_| ())
    }
}

/// The end of a chain of links, whether it exists or not.
pub(super) fn follow(path: &Path) -> PathBuf {
    let mut end = path.to_path_buf();
    // as many as Linux follows
    for _ in 0..40 {
        let Ok(link) = fs::read_link(&end) else { break };
        end = end.parent().map_or_else(|| link.clone(), |folder| folder.join(&link));
    }
    end
}
