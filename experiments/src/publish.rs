//! `polhode experiment publish`: numbers reach documents only from result files.
//!
//! A block in README.md between `<!-- begin generated: experiment/table -->` and `<!-- end generated -->` is replaced
//! by that table of the committed results of paper scale; every LaTeX table and CSV goes to paper/generated, headed by
//! the experiment, commit and scale that made it. A block `<!-- begin generated: methods -->` holds the catalogue.
//! Nothing is read or written outside of the root, whatever the results and the markers say.

use std::fmt;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::error::Error;
use crate::files::{emit, read};
use crate::methods;

const RESULTS: &str = "experiments/results/paper";
const METHODS: &str = "methods";
const NAMES: &str = "names have small letters, digits and hyphens";
const REMEDY: &str = "run `polhode experiment run all --scale paper --out experiments/results` first";

#[derive(Deserialize)]
struct Origin {
    experiment: String,
    scale: String,
    commit: String,
    changed: String,
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let changes = if self.changed == "false" { "" } else { " with changes" };
        write!(f, "{}, commit {}{changes}, scale {}", self.experiment, self.commit, self.scale)
    }
}

pub(crate) fn run(root: &Path) -> Result<(), Error> {
    let results = within(root, root.join(RESULTS))?;
    let readme_path = within(root, root.join("README.md"))?;
    let readme = with_blocks_filled(&read(&readme_path, "run this in the project's root")?, &results)?;
    let generated = within(root, root.join("paper/generated"))?;
    let mut files = Vec::new();
    for experiment in folders(&results)? {
        let origin = origin(&experiment)?;
        let head = origin.to_string();
        for path in sorted_entries(&experiment)? {
            let path = within(root, path)?;
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let target = generated.join(format!("{}-{name}", origin.experiment));
            match path.extension().and_then(|ending| ending.to_str()) {
                Some("tex") => files.push((target, format!("% {head}\n{}", read(&path, REMEDY)?))),
                Some("csv") => files.push((target, read(&path, REMEDY)?)),
                _ => {}
            }
        }
        files.push((
            generated.join(format!("{}-origin.tex", origin.experiment)),
            format!("% {head}\n{head}%\n"),
        ));
    }
    let head = format!("% catalogue of methods, version {}\n", env!("CARGO_PKG_VERSION"));
    files.push((generated.join("methods.tex"), head + &methods::table().latex()));
    // all is known before the first file is touched
    std::fs::create_dir_all(&generated)
        .map_err(|reason| Error::Input(format!("{}: cannot be made: {reason}", generated.display())))?;
    for (path, _) in &files {
        within(root, path.clone())?;
    }
    for (path, text) in &files {
        emit(text, Some(path))?;
    }
    emit(&readme, Some(&readme_path))
}

fn origin(experiment: &Path) -> Result<Origin, Error> {
    let path = experiment.join("run.toml");
    let origin: Origin = toml::from_str(&read(&path, REMEDY)?)
        .map_err(|error| Error::Input(format!("{}: {error}", path.display())))?;
    if !is_name(&origin.experiment) {
        let place = format!("{}: experiment", path.display());
        return Err(Error::input(&place, &origin.experiment, NAMES, REMEDY));
    }
    Ok(origin)
}

/// Whether `name` can be that of an experiment or a table: it leads to no other folder.
fn is_name(name: &str) -> bool {
    !name.is_empty() && name.bytes().all(|b| matches!(b, b'a'..=b'z' | b'0'..=b'9' | b'-'))
}

/// `path`, if no link leads out of `root`.
fn within(root: &Path, path: PathBuf) -> Result<PathBuf, Error> {
    let leads_out = match (root.canonicalize(), path.canonicalize()) {
        (Ok(root), Ok(end)) => !end.starts_with(root),
        // what is not there yet is made here, unless a link says where
        _ => path.is_symlink(),
    };
    if leads_out {
        let value = path.display().to_string();
        let remedy = "put a file or folder in its place";
        return Err(Error::input("--root", &value, "is a link that leads out of it", remedy));
    }
    Ok(path)
}

fn folders(results: &Path) -> Result<Vec<PathBuf>, Error> {
    Ok(sorted_entries(results)?.into_iter().filter(|path| path.is_dir()).collect())
}

fn sorted_entries(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let unreadable = |reason: std::io::Error| {
        Error::Input(format!("{}: cannot be read: {reason}; {REMEDY}", folder.display()))
    };
    let entries = std::fs::read_dir(folder).map_err(unreadable)?;
    let mut paths =
        entries.map(|entry| entry.map(|e| e.path())).collect::<Result<Vec<_>, _>>().map_err(unreadable)?;
    paths.sort();
    Ok(paths)
}

/// The text with each generated block replaced.
fn with_blocks_filled(text: &str, results: &Path) -> Result<String, Error> {
    const BEGIN: &str = "<!-- begin generated: ";
    const END: &str = "<!-- end generated -->";
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(BEGIN) {
        let (before, block) = rest.split_at(at);
        let unclosed =
            || Error::Input(format!("README.md: a block that begins with '{BEGIN}' has no '{END}'"));
        let (marker, _) = block.split_once('\n').ok_or_else(unclosed)?;
        let name = marker.trim_start_matches(BEGIN).trim_end_matches("-->").trim();
        let end = block.find(END).ok_or_else(unclosed)?;
        let table = match name {
            METHODS => methods::table().markdown(),
            _ if !name.split('/').all(is_name) || name.split('/').count() != 2 => {
                let remedy = "write <!-- begin generated: experiment/table -->";
                return Err(Error::input("README.md: begin generated", name, NAMES, remedy));
            }
            _ => read(&within(results, results.join(format!("{name}.md")))?, REMEDY)?,
        };
        out += &format!("{before}{marker}\n{table}{END}");
        rest = &block[end + END.len()..];
    }
    Ok(out + rest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::scratch::Scratch;

    #[test]
    fn blocks_are_replaced_and_the_rest_is_kept() {
        let scratch = Scratch::new("publish");
        std::fs::create_dir(scratch.path().join("drift")).unwrap();
        std::fs::write(scratch.path().join("drift/table.md"), "| new |\n").unwrap();
        let catalogue =
            with_blocks_filled("<!-- begin generated: methods -->\n<!-- end generated -->", scratch.path());
        assert!(catalogue.unwrap().contains("| rattle |"));
        let text = "a\n<!-- begin generated: drift/table -->\n| old |\n<!-- end generated -->\nb\n";
        let filled = with_blocks_filled(text, scratch.path()).unwrap();
        assert_eq!(filled, text.replace("old", "new"));
        assert_eq!(with_blocks_filled(&filled, scratch.path()).unwrap(), filled);
    }

    #[test]
    fn nothing_outside_of_the_root_is_read_or_written() {
        let scratch = Scratch::new("publish-outside");
        let root = scratch.path().join("root");
        let results = root.join(RESULTS).join("drift");
        std::fs::create_dir_all(&results).unwrap();
        std::fs::write(scratch.path().join("secret.md"), "secret").unwrap();
        let readme = root.join("README.md");
        let refused = |part: &str| {
            let error = super::run(&root).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
            assert_eq!(scratch.names(), ["root", "secret.md"]);
        };
        let mark = |experiment: &str| {
            let origin = format!(
                "experiment = \"{experiment}\"\nscale = \"paper\"\ncommit = \"0\"\nchanged = \"false\"\n"
            );
            std::fs::write(results.join("run.toml"), origin).unwrap();
        };
        mark("drift");
        for name in ["../../../../secret", "drift/../secret", "drift", "/secret", "drift/"] {
            std::fs::write(&readme, format!("<!-- begin generated: {name} -->\n<!-- end generated -->\n"))
                .unwrap();
            refused("small letters, digits and hyphens");
        }
        std::fs::write(&readme, "text\n").unwrap();
        mark("../../../evil");
        refused("'../../../evil': names have small letters");
        mark("drift");
        std::fs::create_dir_all(root.join("paper")).unwrap();
        let generated = root.join("paper/generated");
        std::os::unix::fs::symlink(scratch.path(), &generated).unwrap();
        refused("leads out");
        std::fs::remove_file(&generated).unwrap();
        super::run(&root).unwrap();
        assert!(generated.join("drift-origin.tex").is_file());
        std::fs::remove_file(generated.join("drift-origin.tex")).unwrap();
        std::os::unix::fs::symlink(scratch.path().join("new"), generated.join("drift-origin.tex")).unwrap();
        refused("leads out");
    }

    #[test]
    fn a_missing_result_and_an_open_block_are_refused() {
        let scratch = Scratch::new("publish-missing");
        let missing = "<!-- begin generated: x/y -->\n<!-- end generated -->";
        assert!(
            with_blocks_filled(missing, scratch.path()).unwrap_err().to_string().contains("--scale paper")
        );
        assert!(with_blocks_filled("<!-- begin generated: x/y -->\n", scratch.path()).is_err());
    }
}
