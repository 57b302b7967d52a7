//! `polhode experiment`.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::harness::{Scratch, names, output, polhode, refused, run, words};

/// Every file below `folder` with its bytes, by path.
fn tree(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for name in names(folder) {
        let path = folder.join(&name);
        if path.is_dir() {
            files.extend(tree(&path).into_iter().map(|(below, bytes)| (format!("{name}/{below}"), bytes)));
        } else {
            files.push((name, fs::read(path).unwrap()));
        }
    }
    files
}

/// The root of this project.
fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

#[test]
fn a_folder_of_something_else_is_not_replaced_by_results() {
    let scratch = Scratch::new("foreign");
    let folder = scratch.0.join("smoke/order");
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("thesis.tex"), "kept").unwrap();
    let line = format!("experiment run order --scale smoke --out {}", scratch.0.display());
    refused(&line, &["--out", "no run.toml", "move it away"]);
    assert_eq!(names(&folder), ["thesis.tex"]);
}

#[test]
#[ignore = "an experiment at smoke scale: takes seconds, `.ci/run` does it"]
fn experiments_run_and_can_be_published() {
    let scratch = Scratch::new("experiments");
    // the main job, and what else is quick and has tables of other forms: `experiment check` runs them all
    let text = output(&format!("experiment run --scale smoke --out {}", scratch.0.display()));
    assert!(text.contains("claims that were checked hold.") && text.contains("Tables: "), "{text}");
    output(&format!(
        "experiment run long-run conservation separatrix lecture --scale smoke --out {}",
        scratch.0.display()
    ));
    let files = tree(&scratch.0.join("smoke"));
    for experiment in ["work-precision", "order", "long-run"] {
        for ending in [".csv", ".md", ".tex", ".svg", "run.toml"] {
            let of_it = |(name, bytes): &&(String, Vec<u8>)| {
                name.starts_with(&format!("{experiment}/")) && name.ends_with(ending) && !bytes.is_empty()
            };
            assert!(files.iter().any(|file| of_it(&file)), "{experiment} has no {ending}");
        }
    }
    for (name, bytes) in &files {
        let text = String::from_utf8(bytes.clone()).unwrap();
        if name.ends_with("run.toml") {
            let stated = |key: &str| text.lines().any(|line| line.starts_with(&format!("{key} = ")));
            assert!(stated("seconds") && stated("cores"), "{name}: {text}");
        }
        assert!(!text.contains("NaN") && !text.contains(",inf"), "{name}");
    }
    // a project whose committed results are these
    let project = scratch.0.join("project");
    fs::create_dir_all(project.join("experiments")).unwrap();
    fs::create_dir_all(project.join("paper")).unwrap();
    let results = project.join("experiments/results");
    fs::rename(scratch.0.join("smoke"), &results).unwrap();
    let rounded = files.iter().filter_map(|(name, bytes)| Some((name.strip_suffix(".tex")?, bytes)));
    // the last rows of a run are no part that can be cut from its table by a column
    let rounded: Vec<_> = rounded.filter(|(name, _)| !name.ends_with("/summary")).collect();
    assert!(rounded.len() > 20, "{}", rounded.len());
    let readme = |text: fn(&Path, &str) -> String| {
        let block = |name: &str| {
            format!("<!-- begin generated: {name} -->\n{}<!-- end generated -->\n", text(&results, name))
        };
        rounded.iter().map(|(name, _)| block(name)).collect::<String>()
    };
    fs::write(project.join("README.md"), readme(|_, _| String::new())).unwrap();
    let input = |(name, _): &(&str, _)| format!("\\input{{generated/{}}}\n", name.replacen('/', "-", 1));
    let article: String = rounded.iter().map(input).collect();
    fs::write(project.join("paper/main.tex"), article + "{generated/long-run-series.csv}").unwrap();
    assert_eq!(output(&format!("experiment publish --root {}", project.display())), "");
    // what is made from the CSVs is what the run made of its tables
    let written = readme(|results, name| fs::read_to_string(results.join(format!("{name}.md"))).unwrap());
    assert_eq!(fs::read_to_string(project.join("README.md")).unwrap(), written);
    for (name, bytes) in &rounded {
        let file = format!("paper/generated/{}.tex", name.replacen('/', "-", 1));
        let text = fs::read_to_string(project.join(&file)).unwrap();
        let (head, table) = text.split_once('\n').unwrap();
        assert!(
            head.starts_with(&format!("% {}, commit ", name.split_once('/').unwrap().0)),
            "{file}: {head}"
        );
        assert_eq!(table.as_bytes(), *bytes, "{file}");
    }
    let series = fs::read(project.join("paper/generated/long-run-series.csv")).unwrap();
    assert_eq!(series, fs::read(results.join("long-run/series.csv")).unwrap());
}

#[test]
fn a_number_that_changed_is_told_with_its_place() {
    let scratch = Scratch::new("check");
    let golden_folder = "experiments/tests/golden/smoke/order";
    let folder = scratch.0.join(golden_folder);
    let line = format!("experiment check order --root {}", scratch.0.display());
    refused(&line, &["--root", "holds no experiments/tests/golden/smoke", "name the project's root"]);
    fs::create_dir_all(&folder).unwrap();
    refused(
        &line.replace("check order", "check ordre"),
        &["experiment check: 'ordre'", "did you mean 'order'?"],
    );
    assert_eq!(output(&format!("{line} --accept")), "");
    assert_eq!(output(&line), "");
    assert_eq!(names(&folder), names(&root().join(golden_folder)));
    let errors = folder.join("errors.csv");
    let text = fs::read_to_string(&errors).unwrap();
    let mut rows: Vec<String> = text.lines().map(String::from).collect();
    let (head, last) = rows[2].rsplit_once(',').unwrap();
    let next = f64::from_bits(last.parse::<f64>().unwrap().to_bits() + 1);
    let expected = format!("row 2, column momentum_order: committed {next:?}, found {last}");
    rows[2] = format!("{head},{next:?}");
    fs::write(&errors, rows.join("\n") + "\n").unwrap();
    fs::remove_file(folder.join("orders.csv")).unwrap();
    fs::write(folder.join("order.csv"), "").unwrap();
    let answer = run(&line);
    assert_eq!((answer.code, answer.out.as_str()), (1, ""));
    let place = |name: &str| format!("{golden_folder}/{name}");
    for part in [
        format!("{}: {expected}", place("errors.csv")),
        format!("{}: is not there", place("orders.csv")),
        format!("{}: no table is called so", place("order.csv")),
        "experiment check --accept".to_string(),
    ] {
        assert!(answer.err.contains(&part), "'{part}' is not in: {}", answer.err);
    }
}

#[test]
fn numbers_of_paper_scale_are_compared_with_the_published_ones() {
    let scratch = Scratch::new("check-paper");
    let line = format!("experiment check order --scale paper --root {}", scratch.0.display());
    refused(&format!("{line} --accept"), &["--accept", "'paper'", "experiment publish --from results/paper"]);
    refused(&line.replace("paper", "standard"), &["--scale", "'standard'", "smoke, paper"]);
    refused(&line, &["--root", "holds no experiments/results", "name the project's root"]);
    let folder = scratch.0.join("experiments/results/order");
    fs::create_dir_all(&folder).unwrap();
    for name in names(&root().join("experiments/results/order")) {
        fs::copy(root().join("experiments/results/order").join(&name), folder.join(&name)).unwrap();
    }
    // times and pictures beside the numbers are not compared
    fs::write(folder.join("order.svg"), "").unwrap();
    let orders = folder.join("orders.csv");
    let text = fs::read_to_string(&orders).unwrap();
    let (kept, last) = text.trim_end().rsplit_once('\n').unwrap();
    fs::write(&orders, format!("{kept}\n")).unwrap();
    let answer = run(&line);
    assert_eq!((answer.code, answer.out.as_str()), (1, ""), "{last}");
    for part in
        ["experiments/results/order/orders.csv: committed rows", "experiment publish --from results/paper"]
    {
        assert!(answer.err.contains(part), "'{part}' is not in: {}", answer.err);
    }
    // the other table is that of paper scale, number by number
    assert!(!answer.err.contains("errors.csv") && !answer.err.contains(".svg"), "{}", answer.err);
}

#[test]
fn publishing_without_results_is_refused() {
    let scratch = Scratch::new("unpublished");
    let line = format!("experiment publish --root {}", scratch.0.display());
    refused(&line, &["README.md", "cannot be read"]);
    fs::write(scratch.0.join("README.md"), "text\n").unwrap();
    refused(&line, &["experiments/results", "--scale paper", "--from results/paper"]);
    assert_eq!(scratch.names(), ["README.md"]);
    let smoke = scratch.0.join("results/smoke/drift");
    fs::create_dir_all(&smoke).unwrap();
    let origin = "experiment = \"drift\"\nscale = \"smoke\"\ncommit = \"0\"\nchanged = \"false\"\n";
    fs::write(smoke.join("run.toml"), origin).unwrap();
    let from = format!("{line} --from {}", smoke.parent().unwrap().display());
    refused(&from, &["--from", "'smoke'", "paper scale"]);
    assert_eq!(scratch.names(), ["README.md", "results"]);
}

#[cfg(unix)]
#[test]
fn experiments_go_on_where_the_system_refuses_threads() {
    let line = format!("experiment check order long-run --root {}", root().display());
    // size of the stack of a new thread, more than any address space has
    let stack = (1_u64 << 60).to_string();
    let mut alone = Command::new(env!("CARGO_BIN_EXE_polhode"));
    let done = alone.args(words(&line)).env("RUST_MIN_STACK", stack).output().unwrap();
    assert_eq!((done.status.code(), String::from_utf8_lossy(&done.stderr).as_ref()), (Some(0), ""));
}

/// Sources that differ from their commit make no results that can be kept; a clean clone sees the other half.
#[test]
fn what_this_program_has_finished_is_not_run_again() {
    let scratch = Scratch::new("experiment-resume");
    let line = "experiment run order lecture --scale smoke --out results --resume";
    let first = polhode(&words(line), &scratch.0);
    assert_eq!(first.code, 0, "{}", first.err);
    let mark = scratch.0.join("results/smoke/order/run.toml");
    let text = fs::read_to_string(&mark).unwrap();
    let is_clean = text.contains("changed = \"false\"");
    fs::remove_dir_all(scratch.0.join("results/smoke/lecture")).unwrap();
    let again = polhode(&words(line), &scratch.0);
    assert_eq!(again.code, 0, "{}", again.err);
    assert_eq!(again.err.contains("note: order: finished by this program"), is_clean, "{}", again.err);
    assert!(!again.err.contains("lecture"), "{}", again.err);
    // another program's results are run again
    fs::write(&mark, text.replace("commit = \"", "commit = \"0")).unwrap();
    assert!(!polhode(&words(line), &scratch.0).err.contains("order: finished"));
    let smoke = polhode(&words("experiment check order --resume results"), &scratch.0);
    assert_eq!(smoke.code, 2);
    assert!(smoke.err.contains("add --scale paper"), "{}", smoke.err);
}
