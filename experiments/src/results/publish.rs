//! `polhode experiment publish`: numbers reach documents only from result files.
//!
//! The committed results are CSVs with a `run.toml` beside them. A block in README.md or a page of `docs` between
//! `<!-- begin generated: experiment/table -->` and `<!-- end generated -->` is replaced by that table in Markdown, and
//! every `generated/experiment-table` that an article names is made: a LaTeX table, a CSV, or the experiment, commit and
//! scale as a sentence (`generated/experiment-origin`). `methods` is the catalogue in both, in articles without sources;
//! `work-precision/which` the quickest methods by kind of problem, `work-precision/claim` whether any is quicker than the
//! general-purpose ones everywhere, `work-precision/spans` whether that changes as the time grows, and `generated/work-precision-curves.csv` cost against accuracy. `generated/style` is the
//! style of figures for LaTeX. The page docs/methods.md is the catalogue with what was measured of each method.
//! Nothing is read or written outside of the root, whatever the results and the markers say.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use polhode_files::error::Error;
use polhode_files::read_own;
use polhode_pages::figure;
use polhode_pages::output::{MARK, Staging, emit};
use polhode_pages::table::{Column, Table};

use super::RESULTS;
use super::committed::{NAMES, REMEDY, Results, is_name, within};
use super::methods::{PAGE, page};
use crate::methods;

const GENERATED: &str = "generated/";
const METHODS: &str = "methods";
const ORIGIN: &str = "origin";
const STYLE: &str = "style";
const BEGIN: &str = "<!-- begin generated: ";

/// Fills README.md, the pages of docs and paper/generated below `root`, after taking over the results of the folder `from`, if given.
pub(super) fn run(root: &Path, from: Option<&Path>) -> Result<(), Error> {
    if let Some(from) = from {
        take_over(root, from)?;
    }
    let documents = documents(root)?;
    let results = within(root, root.join(RESULTS))?;
    let results = folders(&results)?.into_iter().map(|folder| Results::open(within(root, folder)?));
    let results = results.collect::<Result<Vec<_>, _>>()?;
    let generated = within(root, root.join("paper").join(GENERATED))?;
    let mut files = BTreeMap::new();
    for (path, text) in documents {
        let name = path.strip_prefix(root).unwrap_or(&path).display().to_string();
        files.insert(within(root, path)?, with_blocks_filled(&name, &text, &results)?);
    }
    let methods = root.join(PAGE);
    if methods.is_file() {
        files.insert(within(root, methods)?, page(&results)?);
    }
    for name in named_by_articles(root)? {
        let (file, text) = for_articles(&name, &results)?;
        files.insert(within(root, generated.join(file))?, text);
    }
    // all is known before the first file is touched
    if files.keys().any(|path| path.starts_with(&generated)) {
        std::fs::create_dir_all(&generated)
            .map_err(|reason| Error::Input(format!("{}: cannot be made: {reason}", generated.display())))?;
    }
    files.iter().try_for_each(|(path, text)| emit(text, Some(path)))
}

/// README.md and the pages of docs that have generated blocks.
fn documents(root: &Path) -> Result<Vec<(PathBuf, String)>, Error> {
    let readme = within(root, root.join("README.md"))?;
    let text = read_own(&readme, "run this in the project's root")?;
    let mut documents = vec![(readme, text)];
    let docs = root.join("docs");
    let pages = if docs.is_dir() { sorted_entries(&within(root, docs)?)? } else { Vec::new() };
    for path in pages.into_iter().filter(|path| path.extension().is_some_and(|ending| ending == "md")) {
        let path = within(root, path)?;
        let text = read_own(&path, "name a text file")?;
        if text.contains(BEGIN) {
            documents.push((path, text));
        }
    }
    Ok(documents)
}

/// Copies CSVs, `run.toml` and the figures that documents show of every experiment in `from`; the rest of what a run writes
/// follows from them.
fn take_over(root: &Path, from: &Path) -> Result<(), Error> {
    let documents = documents(root)?;
    for folder in folders(from)? {
        let found = Results::open(folder)?;
        if found.origin.scale != "paper" {
            let place = format!("--from: {}: scale", found.folder.display());
            return Err(Error::input(&place, &found.origin.scale, "documents hold paper scale", REMEDY));
        }
        let staging = Staging::new(&within(root, root.join(RESULTS).join(&found.origin.experiment))?)?;
        for path in sorted_entries(&found.folder)? {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let place = format!("{RESULTS}/{}/{name})", found.origin.experiment);
            let figure = || documents.iter().any(|(_, text)| text.contains(&place));
            if name == MARK || name.ends_with(".csv") || (name.ends_with(".svg") && figure()) {
                staging.write(&name, read_own(&path, REMEDY)?.as_bytes())?;
            }
        }
        staging.commit()?;
    }
    Ok(())
}

/// Every `generated/name` in braces in the articles' sources, without the folder.
fn named_by_articles(root: &Path) -> Result<BTreeSet<String>, Error> {
    let mut names = BTreeSet::new();
    let paper = root.join("paper");
    let articles = if paper.is_dir() { folders(&within(root, paper.clone())?)? } else { Vec::new() };
    for folder in articles.into_iter().chain(paper.is_dir().then_some(paper)) {
        for path in sorted_entries(&within(root, folder)?)? {
            if path.extension().is_some_and(|ending| ending == "tex") {
                let text = read_own(&within(root, path)?, "name a text file")?;
                let words = text.lines().flat_map(|line| without_comment(line).split(['{', '}']));
                names.extend(words.filter_map(|word| word.strip_prefix(GENERATED)).map(String::from));
            }
        }
    }
    Ok(names)
}

fn without_comment(line: &str) -> &str {
    let comment = line.match_indices('%').find(|(at, _)| !line[..*at].ends_with('\\'));
    comment.map_or(line, |(at, _)| &line[..at])
}

/// The file that an article names as `generated/name`, and its text.
fn for_articles(name: &str, results: &[Results]) -> Result<(String, String), Error> {
    let stem = name.strip_suffix(".tex").unwrap_or(name);
    if stem == METHODS {
        let head = format!("% catalogue of methods, version {}\n", env!("CARGO_PKG_VERSION"));
        return Ok(("methods.tex".into(), head + &catalogue().latex()));
    }
    if stem == STYLE {
        let head = format!("% style of figures, version {}\n", env!("CARGO_PKG_VERSION"));
        return Ok(("style.tex".into(), head + &figure::latex()));
    }
    let (stem, is_csv) = stem.strip_suffix(".csv").map_or((stem, false), |stem| (stem, true));
    // of two experiments, one may be called as the other begins
    let of =
        |found: &&Results| stem.strip_prefix(&found.origin.experiment).is_some_and(|s| s.starts_with('-'));
    let found = results.iter().filter(of).max_by_key(|found| found.origin.experiment.len());
    let Some(found) = found.filter(|_| is_name(stem)) else {
        let remedy = "name generated/<experiment>-<table>, with the ending .csv or without one";
        return Err(Error::input("paper: generated", name, "no committed result is called so", remedy));
    };
    let table = &stem[found.origin.experiment.len() + 1..];
    let head = found.origin.to_string();
    match (table, is_csv) {
        (_, true) => Ok((format!("{stem}.csv"), found.csv(table)?)),
        (name, false) if found.is_claim(name) => {
            Ok((format!("{stem}.tex"), format!("% {head}\n{}", found.which()?.claim())))
        }
        (ORIGIN, false) => Ok((format!("{stem}.tex"), format!("% {head}\n{head}%\n"))),
        (_, false) => Ok((format!("{stem}.tex"), format!("% {head}\n{}", found.table(table)?.latex()))),
    }
}

/// The methods without their sources, which the article cites.
fn catalogue() -> Table {
    let mut table = methods::table();
    let without = |column: Column| if column.name == "source" { column.hidden() } else { column };
    table.columns = table.columns.into_iter().map(without).collect();
    table
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
fn with_blocks_filled(document: &str, text: &str, results: &[Results]) -> Result<String, Error> {
    const END: &str = "<!-- end generated -->";
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(BEGIN) {
        let (before, block) = rest.split_at(at);
        let unclosed =
            || Error::Input(format!("{document}: a block that begins with '{BEGIN}' has no '{END}'"));
        let (marker, _) = block.split_once('\n').ok_or_else(unclosed)?;
        let name = marker.trim_start_matches(BEGIN).trim_end_matches("-->").trim();
        let end = block.find(END).ok_or_else(unclosed)?;
        let refused =
            |rule, remedy| Error::input(&format!("{document}: begin generated"), name, rule, remedy);
        let text = match name.split_once('/') {
            None if name == METHODS => methods::table().markdown(),
            Some((experiment, table)) if is_name(experiment) && is_name(table) => {
                let found = results.iter().find(|found| found.origin.experiment == experiment);
                let found =
                    found.ok_or_else(|| refused("no such experiment has committed results", REMEDY))?;
                if found.is_claim(table) { found.which()?.claim() } else { found.table(table)?.markdown() }
            }
            _ => return Err(refused(NAMES, "write <!-- begin generated: experiment/table -->")),
        };
        out += &format!("{before}{marker}\n{text}{END}");
        rest = &block[end + END.len()..];
    }
    Ok(out + rest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::tempdir;

    const CSV: &str = "method,steps,error\nrk4,10,0.25\nrattle,20,1e-9\n";

    /// A folder of results with one table and one view.
    fn write_results(folder: &Path, experiment: &str) {
        let described = format!(
            "experiment = \"{experiment}\"\nscale = \"paper\"\ncommit = \"0\"\nchanged = \"false\"\n\
             [[tables.\"errors.csv\".shown]]\nname = \"method\"\n\
             [[tables.\"errors.csv\".shown]]\nname = \"error\"\nunit = \"rad\"\ndigits = 2\n\
             [views.best]\ntable = \"errors\"\ncolumn = \"method\"\nvalue = \"rattle\"\nhidden = [\"method\"]\n"
        );
        std::fs::create_dir_all(folder).unwrap();
        std::fs::write(folder.join("run.toml"), described).unwrap();
        std::fs::write(folder.join("errors.csv"), CSV).unwrap();
    }

    #[test]
    fn blocks_are_replaced_and_the_rest_is_kept() {
        let scratch = tempdir().unwrap();
        let folder = scratch.path().join("drift");
        write_results(&folder, "drift");
        let results = [Results::open(folder).unwrap()];
        let catalogue =
            with_blocks_filled("README.md", "<!-- begin generated: methods -->\n<!-- end generated -->", &[]);
        assert!(catalogue.unwrap().contains("| rattle |"));
        let text = "a\n<!-- begin generated: drift/best -->\n| old |\n<!-- end generated -->\nb\n";
        let filled = with_blocks_filled("README.md", text, &results).unwrap();
        assert_eq!(filled, text.replace("| old |", "| error [rad] |\n| ---: |\n| 1e-9 |"));
        assert_eq!(with_blocks_filled("README.md", &filled, &results).unwrap(), filled);
    }

    #[test]
    fn the_article_gets_the_files_that_it_names() {
        let scratch = tempdir().unwrap();
        let root = scratch.path();
        write_results(&root.join(RESULTS).join("drift"), "drift");
        write_results(&root.join(RESULTS).join("drift-long"), "drift-long");
        std::fs::write(root.join("README.md"), "text\n").unwrap();
        std::fs::create_dir_all(root.join("paper/exact")).unwrap();
        let main = root.join("paper/style.tex");
        std::fs::write(
            &main,
            "\\input{generated/drift-long-best} 5\\% {generated/methods} % {generated/no}\n",
        )
        .unwrap();
        let section = "table {generated/drift-errors.csv}; \\input{generated/drift-origin}\n";
        std::fs::write(root.join("paper/exact/results.tex"), section).unwrap();
        run(root, None).unwrap();
        let generated = root.join("paper/generated");
        let mut names: Vec<_> = sorted_entries(&generated)
            .unwrap()
            .iter()
            .map(|path| path.file_name().unwrap().to_owned())
            .collect();
        names.sort();
        assert_eq!(names, ["drift-errors.csv", "drift-long-best.tex", "drift-origin.tex", "methods.tex"]);
        let text = |name: &str| std::fs::read_to_string(generated.join(name)).unwrap();
        assert_eq!(text("drift-errors.csv"), CSV);
        assert_eq!(
            text("drift-origin.tex"),
            "% drift, commit 0, scale paper\ndrift, commit 0, scale paper%\n"
        );
        assert!(text("drift-long-best.tex").contains("$10^{-9}$"));
        for name in ["drift", "other-errors", "drift-x", "drift-../errors.csv", "drift-errors.svg"] {
            std::fs::write(&main, format!("\\input{{generated/{name}}}\n")).unwrap();
            assert!(run(root, None).is_err(), "{name}");
        }
    }

    #[test]
    fn results_are_taken_over_without_what_follows_from_them() {
        let scratch = tempdir().unwrap();
        let (root, from) = (scratch.path().join("root"), scratch.path().join("from"));
        write_results(&from.join("drift"), "drift");
        for other in ["errors.md", "shown.svg", "other.svg"] {
            std::fs::write(from.join("drift").join(other), "").unwrap();
        }
        std::fs::create_dir(&root).unwrap();
        let shown = "![errors](experiments/results/drift/shown.svg)\n";
        std::fs::write(root.join("README.md"), shown).unwrap();
        run(&root, Some(&from)).unwrap();
        let committed = sorted_entries(&root.join(RESULTS).join("drift")).unwrap();
        let names = committed.iter().map(|path| path.file_name().unwrap());
        assert_eq!(names.collect::<Vec<_>>(), ["errors.csv", "run.toml", "shown.svg"]);
    }

    #[test]
    fn nothing_outside_of_the_root_is_read_or_written() {
        let scratch = tempdir().unwrap();
        let root = scratch.path().join("root");
        let results = root.join(RESULTS).join("drift");
        write_results(&results, "drift");
        std::fs::write(scratch.path().join("secret.csv"), "secret").unwrap();
        let readme = root.join("README.md");
        let refused = |part: &str| {
            let error = super::run(&root, None).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
            let mut names: Vec<_> =
                std::fs::read_dir(scratch.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
            names.sort();
            assert_eq!(names, ["root", "secret.csv"]);
        };
        for name in ["../../../../secret", "drift/../secret", "drift", "/secret", "drift/"] {
            std::fs::write(&readme, format!("<!-- begin generated: {name} -->\n<!-- end generated -->\n"))
                .unwrap();
            refused("small letters, digits and hyphens");
        }
        std::fs::write(&readme, "text\n").unwrap();
        write_results(&results, "../../../evil");
        refused("'../../../evil': names have small letters");
        write_results(&results, "evil");
        refused("'evil': is not the name of its folder");
        write_results(&results, "drift");
        std::fs::create_dir_all(root.join("paper")).unwrap();
        std::fs::write(root.join("paper/style.tex"), "\\input{generated/drift-origin}\n").unwrap();
        let generated = root.join("paper/generated");
        std::os::unix::fs::symlink(scratch.path(), &generated).unwrap();
        refused("leads out");
        std::fs::remove_file(&generated).unwrap();
        super::run(&root, None).unwrap();
        assert!(generated.join("drift-origin.tex").is_file());
        std::fs::remove_file(generated.join("drift-origin.tex")).unwrap();
        std::os::unix::fs::symlink(scratch.path().join("new"), generated.join("drift-origin.tex")).unwrap();
        refused("leads out");
        std::fs::remove_file(generated.join("drift-origin.tex")).unwrap();
        std::fs::write(root.join("paper/style.tex"), "\\input{generated/drift-errors.csv}\n").unwrap();
        std::fs::remove_file(results.join("errors.csv")).unwrap();
        std::os::unix::fs::symlink(scratch.path().join("secret.csv"), results.join("errors.csv")).unwrap();
        refused("leads out");
    }

    #[test]
    fn a_missing_result_and_an_open_block_are_refused() {
        let missing = "<!-- begin generated: x/y -->\n<!-- end generated -->";
        assert!(
            with_blocks_filled("docs/x.md", missing, &[]).unwrap_err().to_string().contains("--scale paper")
        );
        assert!(with_blocks_filled("README.md", "<!-- begin generated: x/y -->\n", &[]).is_err());
    }
}
