//! What every test of the command line needs: a folder, a run with its answer, golden files, refusals.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// An empty folder for one test, removed with it.
pub(crate) struct Scratch(pub(crate) PathBuf);

impl Scratch {
    /// `name` is that of no other test.
    pub(crate) fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("polhode-cli-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// Writes a file and returns its path.
    pub(crate) fn file(&self, name: &str, content: impl AsRef<[u8]>) -> String {
        let path = self.0.join(name);
        fs::write(&path, content).unwrap();
        path.display().to_string()
    }

    pub(crate) fn names(&self) -> Vec<String> {
        names(&self.0)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Names of the files in a folder, sorted.
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[derive(Debug)]
pub(crate) struct Answer {
    pub(crate) code: i32,
    pub(crate) out: String,
    /// What it complains of.
    pub(crate) err: String,
    /// What the attitude of a catalogued body refers to.
    pub(crate) notes: String,
}

/// Runs `polhode` in `folder`; whatever it is asked, it neither panics nor prints what is not a number.
pub(crate) fn polhode(arguments: &[&str], folder: &Path) -> Answer {
    let done =
        Command::new(env!("CARGO_BIN_EXE_polhode")).args(arguments).current_dir(folder).output().unwrap();
    let told = String::from_utf8(done.stderr).unwrap();
    let (notes, err) = told.split_inclusive('\n').partition(|line| {
        line.starts_with("note: ")
            && (line.contains(": attitude ") || line.contains(": the gravity gradient of"))
    });
    let out = String::from_utf8(done.stdout).unwrap();
    let answer = Answer { code: done.status.code().unwrap(), out, err, notes };
    for text in [&answer.out, &answer.err] {
        assert!(!text.contains("panicked"), "{arguments:?}: {text}");
    }
    let mut words = answer.out.split(|c: char| !c.is_ascii_alphanumeric());
    assert!(!words.any(|word| ["NaN", "nan", "inf"].contains(&word)), "{arguments:?}: {}", answer.out);
    answer
}

/// A command line written as a shell would take it; only what stands in single quotes holds blanks.
pub(crate) fn words(line: &str) -> Vec<&str> {
    let parts = line.split('\'').enumerate();
    parts
        .flat_map(|(n, part)| if n % 2 == 1 { vec![part] } else { part.split_whitespace().collect() })
        .collect()
}

pub(crate) fn run(line: &str) -> Answer {
    polhode(&words(line), Path::new("."))
}

/// The output of `line`, which has to succeed silently on standard error.
pub(crate) fn output(line: &str) -> String {
    run(line).silent(line)
}

impl Answer {
    /// The output of a run that has nothing to complain of.
    pub(crate) fn silent(self, line: &str) -> String {
        assert_eq!((self.code, self.err.as_str()), (0, ""), "{line}");
        self.out
    }
}

/// Compares with `tests/golden/<name>`, or rewrites it.
pub(crate) fn golden(name: &str, found: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name);
    if std::env::var_os("POLHODE_BLESS").is_some() {
        fs::write(&path, found).unwrap();
    }
    let expected = fs::read_to_string(&path).unwrap();
    assert_eq!(found, expected, "{name} differs from the committed file");
}

/// The refusal of `line`: exit code 2, nothing on standard output, one `error:` that holds every part of `says`.
pub(crate) fn refused(line: &str, says: &[&str]) {
    refused_with(&words(line), says);
}

/// [`refused`] for arguments that may hold blanks or nothing.
pub(crate) fn refused_with(arguments: &[&str], says: &[&str]) {
    let answer = polhode(arguments, Path::new("."));
    let Answer { code, out, err, .. } = &answer;
    assert_eq!((*code, out.as_str()), (2, ""), "{arguments:?}: {err}");
    assert!(err.starts_with("error: "), "{arguments:?}: {err}");
    assert_eq!(err.lines().filter(|line| line.starts_with("error:")).count(), 1, "{arguments:?}: {err}");
    for part in says {
        assert!(err.contains(part), "{arguments:?}: '{part}' is not in: {err}");
    }
    let written_out = |word: &str| word.len() > 60 && !word.contains(['/', '<']);
    assert!(!err.split_whitespace().any(written_out), "{arguments:?}: a value written out in full: {err}");
}

/// The first words of many command lines: a body whose moments and start are exact in binary.
pub(crate) const DYADIC: &str = "propagate --body dyadic --omega 1,0.5,-0.25";

/// [`DYADIC`] with further flags.
pub(crate) fn with(flags: &str) -> String {
    format!("{DYADIC} {flags}")
}
