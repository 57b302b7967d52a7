//! Files that are written whole or not at all.

mod claimed;
mod replacement;
mod signals;
mod staging;
mod temporary;

use std::io::{self, BufWriter, ErrorKind, Stdout, Write};
use std::path::{Path, PathBuf};

use polhode_files::error::Error;
use polhode_files::inputs;
use polhode_files::text::visible;

use replacement::Replacement;
pub use staging::{MARK, Staging};

/// Where a command writes: a file, which is replaced as a whole in [`finish`](Self::finish), or standard output.
///
/// It is opened before the work, so that a place that cannot be written is found out first.
pub enum Output {
    /// A file, and the flag that names it.
    #[allow(missing_docs, reason = "the variant says what they are")]
    File { file: Replacement, flag: &'static str, path: PathBuf },
    /// Standard output.
    Standard(BufWriter<Stdout>),
}

impl Output {
    /// To the file of `--out` when given, else to standard output.
    pub fn new(out: Option<&Path>) -> Result<Self, Error> {
        match out {
            Some(path) => Self::to_file("--out", path),
            None => Ok(Self::Standard(BufWriter::new(io::stdout()))),
        }
    }

    /// To the file that `flag` names.
    ///
    /// # Errors
    /// A place that cannot be written, or standard output as `-`; a file that this process reads, under whichever name, or that
    /// another flag names too. What is read only after this is refused in [`finish`](Self::finish).
    pub fn to_file(flag: &'static str, path: &Path) -> Result<Self, Error> {
        if path.as_os_str() == "-" {
            let remedy = if flag == "--out" { "leave it out, and rows go there" } else { "name a file" };
            return Err(Error::input(flag, "-", "means standard output, which is not a file", remedy));
        }
        check_is_no_input(flag, path)?;
        claimed::claim(flag, path)?;
        let file = Replacement::new(path).map_err(|reason| unwritable(flag, path, &reason))?;
        Ok(Self::File { file, flag, path: path.to_path_buf() })
    }

    /// # Errors
    /// [`Error::Unread`] where the reader of standard output has seen enough: `polhode … | head`.
    pub fn write(&mut self, text: &str) -> Result<(), Error> {
        self.write_bytes(text.as_bytes())
    }

    /// The same for what is no text.
    pub fn write_bytes(&mut self, bytes: &[u8]) -> Result<(), Error> {
        match self {
            Self::File { file, flag, path } => {
                file.write(bytes).map_err(|reason| unwritable(flag, path, &reason))
            }
            Self::Standard(stdout) => stdout.write_all(bytes).map_err(|reason| unprinted(&reason)),
        }
    }

    /// Puts the file in its place.
    pub fn finish(self) -> Result<(), Error> {
        match self {
            Self::File { file, flag, path } => {
                check_is_no_input(flag, &path)?;
                file.commit().map_err(|reason| unwritable(flag, &path, &reason))
            }
            Self::Standard(mut stdout) => stdout.flush().map_err(|reason| unprinted(&reason)),
        }
    }

    /// The whole of a text that is short.
    pub fn write_whole(self, text: &str) -> Result<(), Error> {
        self.write_whole_bytes(text.as_bytes())
    }

    /// The whole of a picture.
    pub fn write_whole_bytes(mut self, bytes: &[u8]) -> Result<(), Error> {
        match self.write_bytes(bytes).and_then(|()| self.finish()) {
            Err(Error::Unread) => Ok(()),
            other => other,
        }
    }
}

/// Writes `text` to the file of `--out` when given, else to standard output.
pub fn emit(text: &str, out: Option<&Path>) -> Result<(), Error> {
    Output::new(out)?.write_whole(text)
}

fn check_is_no_input(flag: &str, path: &Path) -> Result<(), Error> {
    let Some(input) = inputs::same_file(path) else { return Ok(()) };
    let rule = format!("it would replace the input '{}'", visible(&input.display().to_string()));
    Err(Error::input(flag, &path.display().to_string(), &rule, "name another file"))
}

fn unprinted(reason: &io::Error) -> Error {
    match reason.kind() {
        ErrorKind::BrokenPipe => Error::Unread,
        _ => Error::Input(format!("standard output: cannot be written: {reason}; use --out FILE")),
    }
}

/// Why `path` cannot be written, and what helps.
pub fn unwritable(flag: &str, path: &Path, reason: &io::Error) -> Error {
    let other = reason.to_string();
    let (cause, remedy) = match reason.kind() {
        ErrorKind::NotFound => ("the folder does not exist", "make it first"),
        ErrorKind::NotADirectory | ErrorKind::AlreadyExists => {
            ("there is a file where a folder is needed", "name another place")
        }
        ErrorKind::IsADirectory => ("it is a folder", "name a file in it"),
        ErrorKind::PermissionDenied => (
            "permission denied",
            "name a place that you may write to; as a file is replaced as a whole, that holds for its folder too",
        ),
        ErrorKind::ReadOnlyFilesystem => ("the file system is read-only", "name a place on another one"),
        ErrorKind::StorageFull => ("the disk is full", "free some space, or name a place on another one"),
        ErrorKind::QuotaExceeded => {
            ("your share of the disk is full", "free some space, or name a place on another one")
        }
        ErrorKind::FileTooLarge => {
            ("it grows beyond the size that files may have here", "raise that limit, or ask for fewer rows")
        }
        ErrorKind::InvalidFilename => ("the name is too long", "name a shorter one"),
        ErrorKind::InvalidInput => ("it names no file", "name one"),
        _ => (other.as_str(), "name another place"),
    };
    Error::Input(format!("{flag}: '{}': cannot be written: {cause}; {remedy}", path.display()))
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
    use std::fs;

    use super::scratch::Scratch;
    use super::*;

    fn replace(path: &Path, text: &str) -> Result<(), Error> {
        emit(text, Some(path))
    }

    #[test]
    fn a_file_is_replaced_and_nothing_is_left_beside_it() {
        let scratch = Scratch::new("replace");
        let path = scratch.path().join("rows.csv");
        replace(&path, "old").unwrap();
        // as a killed run leaves it
        let stale = scratch.path().join(".rows.csv.abcdef.polhode-new");
        fs::write(&stale, "half").unwrap();
        replace(&path, "new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(scratch.names(), ["rows.csv"]);
    }

    #[test]
    fn an_output_that_is_not_finished_changes_nothing() {
        let scratch = Scratch::new("unfinished");
        let path = scratch.path().join("rows.csv");
        replace(&path, "old").unwrap();
        let mut output = Output::new(Some(&path)).unwrap();
        output.write("new").unwrap();
        assert_eq!(scratch.names().len(), 2);
        drop(output);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(scratch.names(), ["rows.csv"]);
    }

    #[test]
    fn a_folder_or_a_place_below_a_file_is_refused() {
        let scratch = Scratch::new("refuse");
        let file = scratch.path().join("file");
        fs::write(&file, "kept").unwrap();
        for (path, remedy) in [
            (scratch.path().to_path_buf(), "it is a folder; name a file in it"),
            (file.join("rows.csv"), "there is a file where a folder is needed"),
            (scratch.path().join("no/rows.csv"), "the folder does not exist; make it first"),
            (scratch.path().join("x".repeat(256)), "name a shorter one"),
        ] {
            let error = replace(&path, "x").unwrap_err();
            assert_eq!(error.exit_code(), 2);
            for part in [&path.display().to_string(), remedy] {
                assert!(error.to_string().contains(part), "{error}");
            }
            assert!(!error.to_string().contains("polhode-new"), "{error}");
        }
        assert!(Staging::new(&file.join("smoke/drift")).is_err());
        assert_eq!(scratch.names(), ["file"]);
        assert_eq!(fs::read(&file).unwrap(), b"kept");
    }

    #[test]
    fn a_name_may_be_as_long_as_the_system_allows() {
        let scratch = Scratch::new("long");
        for name in ["x".repeat(255), "é".repeat(127)] {
            replace(&scratch.path().join(&name), "rows").unwrap();
            assert_eq!(fs::read(scratch.path().join(&name)).unwrap(), b"rows");
        }
        assert_eq!(scratch.names().len(), 2);
    }

    #[test]
    fn a_link_is_followed() {
        let scratch = Scratch::new("link");
        let (file, link) = (scratch.path().join("file"), scratch.path().join("link"));
        std::os::unix::fs::symlink("file", &link).unwrap();
        // the second time it leads to a file
        for text in ["old", "new"] {
            replace(&link, text).unwrap();
            assert_eq!(fs::read_to_string(&file).unwrap(), text);
            assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        }
        let circle = scratch.path().join("circle");
        std::os::unix::fs::symlink("circle", &circle).unwrap();
        assert_eq!(replace(&circle, "x").unwrap_err().exit_code(), 2);
        assert!(fs::symlink_metadata(&circle).unwrap().is_symlink());
        assert_eq!(scratch.names(), ["circle", "file", "link"]);
    }

    #[test]
    fn a_replaced_file_keeps_its_mode() {
        use std::os::unix::fs::PermissionsExt;
        let scratch = Scratch::new("mode");
        let path = scratch.path().join("rows.csv");
        let mode = || fs::metadata(&path).unwrap().permissions().mode() & 0o7777;
        for kept in [0o600, 0o664, 0o444] {
            replace(&path, "old").unwrap();
            fs::set_permissions(&path, fs::Permissions::from_mode(kept)).unwrap();
            replace(&path, "new").unwrap();
            assert_eq!(mode(), kept);
        }
        fs::remove_file(&path).unwrap();
        fs::write(scratch.path().join("plain"), "").unwrap();
        replace(&path, "fresh").unwrap();
        let plain = fs::metadata(scratch.path().join("plain")).unwrap().permissions().mode() & 0o7777;
        assert_eq!(mode(), plain);
    }

    #[test]
    fn a_line_without_end_is_refused() {
        let error = polhode_files::read(Path::new("/dev/zero"), "name a text file").unwrap_err().to_string();
        assert_eq!(
            error,
            "/dev/zero: cannot be read: line 1 is longer than 16777216 bytes; name a text file"
        );
    }
}
