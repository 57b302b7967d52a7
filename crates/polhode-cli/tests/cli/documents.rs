//! Every command that a document shows runs, and prints what the document says.
//!
//! A block `sh` holds commands, one a line; the block `text` after it, if there is one, is what the last of them prints on standard
//! output and standard error, where a line `...` stands for any lines. A comment `# exit code 1` says how a command ends. Commands
//! of cargo and other programs, lines with variables of a shell, and `polhode experiment`, which takes minutes, are not run.

use std::fs;
use std::path::{Path, PathBuf};

use crate::harness::{Scratch, polhode, words};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Files that stand for those of a reader.
fn supplied(scratch: &Scratch) {
    let logs = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/programs");
    fs::copy(logs.join("mujoco-euler.csv"), scratch.0.join("mujoco.csv")).unwrap();
    fs::create_dir(scratch.0.join("examples")).unwrap();
    for name in ["examples/ensemble.toml", "examples/apophis.toml"] {
        fs::copy(root().join(name), scratch.0.join(name)).unwrap();
    }
    fs::copy(root().join("examples/ensemble.toml"), scratch.0.join("spec.toml")).unwrap();
    scratch.file("epochs.csv", "jd\n2448936.5\n2448937.25\n");
    let inertia = "<inertia ixx=\"0.01\" iyy=\"0.02\" izz=\"0.025\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/>";
    let link = format!("<link name=\"forearm\"><inertial><mass value=\"1.5\"/>{inertia}</inertial></link>");
    scratch.file("robot.urdf", format!("<robot name=\"r\">{link}</robot>"));
    // a cube of 20 mm without its last triangle
    let corner = |k: usize| [k & 1, k >> 1 & 1, k >> 2].map(|bit| 20 * bit);
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let halves = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).take(11);
    let triangle = |corners: [usize; 3]| {
        let vertex = |k: usize| {
            let [x, y, z] = corner(k);
            format!("vertex {x} {y} {z}\n")
        };
        let vertices: String = corners.into_iter().map(vertex).collect();
        format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
    };
    scratch
        .file("part.stl", format!("solid part\n{}endsolid part\n", halves.map(triangle).collect::<String>()));
}

/// A command, its exit code, and what it prints, if the document says so.
struct Shown {
    command: String,
    code: i32,
    prints: Option<String>,
}

fn shown(document: &str) -> Vec<Shown> {
    let mut found: Vec<Shown> = Vec::new();
    let mut fences = document.split("\n```");
    let mut after_commands = false;
    fences.next();
    while let (Some(block), between) = (fences.next(), fences.next()) {
        let (language, text) = block.split_once('\n').unwrap_or((block, ""));
        if language == "text" && after_commands {
            found.last_mut().unwrap().prints = Some(text.to_owned());
        }
        if language == "sh" {
            for line in text.lines().filter(|line| line.starts_with("polhode ")) {
                let (command, comment) = line.split_once(" # ").unwrap_or((line, ""));
                let code = comment.trim().strip_prefix("exit code ").map_or(0, |code| code.parse().unwrap());
                found.push(Shown { command: command.trim().to_owned(), code, prints: None });
            }
        }
        after_commands = language == "sh" && between.is_some_and(|between| between.trim().is_empty());
    }
    found
}

/// Whether `printed` is `expected`, where a line `...` stands for any lines.
fn is_as(printed: &str, expected: &str) -> bool {
    fn matches(printed: &[&str], expected: &[&str]) -> bool {
        match expected.split_first() {
            None => printed.is_empty(),
            Some((&"...", rest)) => (0..=printed.len()).any(|k| matches(&printed[k..], rest)),
            Some((line, rest)) => printed.first() == Some(line) && matches(&printed[1..], rest),
        }
    }
    let lines = |text| -> Vec<&str> { str::lines(text).map(str::trim_end).collect() };
    matches(&lines(printed), &lines(expected))
}

fn runs(path: &str) -> usize {
    let text = fs::read_to_string(root().join(path)).unwrap();
    let scratch = Scratch::new(&format!("document-{}", path.replace(['/', '.'], "-")));
    supplied(&scratch);
    let commands = shown(&text);
    for Shown { command, code, prints } in &commands {
        let arguments = words(command.strip_prefix("polhode ").unwrap());
        if (arguments[0] == "experiment" && arguments[1] != "list") || command.contains('$') {
            continue;
        }
        let answer = polhode(&arguments, &scratch.0);
        assert_eq!(answer.code, *code, "{path}: {command}\n{}", answer.err);
        let printed = answer.out + &answer.err;
        if let Some(expected) = prints {
            assert!(
                is_as(&printed, expected),
                "{path}: {command} prints\n{printed}\nwhere the document says\n{expected}"
            );
        }
    }
    commands.len()
}

#[test]
fn every_command_of_the_front_page_runs_and_prints_what_it_says() {
    assert!(runs("README.md") >= 5);
}

#[test]
#[ignore = "many commands: takes seconds, `.ci/run` does it"]
fn every_command_of_the_guide_runs() {
    let pages = fs::read_dir(root().join("docs")).unwrap().map(|entry| entry.unwrap().path());
    let mut names: Vec<String> = pages
        .filter(|path| path.extension().is_some_and(|ending| ending == "md"))
        .map(|path| format!("docs/{}", path.file_name().unwrap().display()))
        .collect();
    names.sort();
    let count: usize = names.iter().map(|name| runs(name)).sum();
    assert!(count > 20, "{count}");
}

#[test]
fn a_line_of_dots_stands_for_any_lines() {
    assert!(is_as("a\nb\nc\n", "a\n...\nc\n") && is_as("a\n", "...\na\n...\n"));
    assert!(!is_as("a\nb\n", "a\n") && !is_as("a\nb\nc\n", "a\n...\nb\n"));
}
