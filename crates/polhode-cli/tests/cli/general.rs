//! What all commands share: help, names, places for rows, formats.

use std::fs;
use std::path::Path;

use crate::harness::{Scratch, golden, output, polhode, refused, run, with, words};

/// Every command, by the list of its own help; the first is the program itself.
fn commands() -> Vec<String> {
    let mut found = vec![String::new()];
    let mut k = 0;
    while k < found.len() {
        let help = output(&format!("{} --help", found[k]));
        let listed = help.split_once("\nCommands:\n").map_or("", |(_, rest)| rest);
        for line in listed.lines().take_while(|line| !line.is_empty()) {
            // the description of a command goes on further to the right
            let name = line.strip_prefix("  ").and_then(|line| line.split(' ').next()).unwrap();
            if !name.is_empty() && name != "help" {
                found.push(format!("{} {name}", found[k]));
            }
        }
        k += 1;
    }
    found
}

#[test]
fn help_is_everywhere_and_fits_into_80_columns() {
    let commands = commands();
    assert!(commands.len() >= 13, "{commands:?}");
    for command in commands {
        for flag in ["--help", "-h"] {
            let text = output(&format!("{command} {flag}"));
            assert!(text.contains("Usage: polhode"), "{command}: {text}");
            for line in text.lines() {
                assert!(line.chars().count() <= 80, "{command} {flag}: {line}");
            }
        }
    }
    assert!(output("--version").starts_with("polhode "));
}

/// Where `-` is read from standard input it names no file to write either.
#[test]
fn standard_output_is_no_file_of_that_name() {
    let scratch = Scratch::new("no-file");
    for line in [
        "propagate --moments 1,2,3 --omega 0.4,1,-0.3 --times 1 --out -",
        "motion --moments 1,2,3 --omega 0.4,1,-0.3 --out -",
        "compare --moments 1,2,3 --omega 0.4,1,-0.3 --until 1 --methods rk4 --steps 0.5 --out -",
    ] {
        let answer = polhode(&words(line), &scratch.0);
        assert_eq!((answer.code, answer.out.as_str()), (2, ""), "{line}: {}", answer.err);
        assert!(answer.err.contains("--out: '-': means standard output"), "{line}: {}", answer.err);
    }
    assert!(scratch.names().is_empty());
}

/// What the experiments read and write, in a folder of its own.
fn project(scratch: &Scratch) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let copied =
        ["README.md", "paper", "experiments/results", "experiments/tests/golden", "examples/ensemble.toml"];
    for folder in ["experiments/tests", "examples"] {
        fs::create_dir_all(scratch.0.join(folder)).unwrap();
    }
    for name in copied {
        copy(&root.join(name), &scratch.0.join(name));
    }
}

fn copy(from: &Path, to: &Path) {
    if !from.is_dir() {
        fs::copy(from, to).unwrap();
        return;
    }
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        copy(&entry.path(), &to.join(entry.file_name()));
    }
}

#[test]
fn every_help_ends_with_two_examples_that_run() {
    let scratch = Scratch::new("examples");
    project(&scratch);
    // the record that is simulated is the one that is fitted
    let mut commands = commands();
    commands.sort_by_key(|command| command != " simulate");
    for command in commands {
        let help = output(&format!("{command} --help"));
        let (_, examples) =
            help.split_once("Examples:\n").unwrap_or_else(|| panic!("{command}: no examples"));
        let examples = examples.replace("\\\n", " ");
        let lines: Vec<&str> =
            examples.lines().map(|line| line.trim().strip_prefix("polhode ").unwrap()).collect();
        assert!(lines.len() >= 2, "{command}: {lines:?}");
        // .ci/run compares the committed results, and another test runs the main ones at smoke scale
        let elsewhere =
            |line: &&str| line.starts_with("experiment check") || *line == "experiment run --scale smoke";
        for line in lines.into_iter().filter(|line| !elsewhere(line)) {
            let answer = polhode(&words(line), &scratch.0);
            assert_eq!(answer.code, 0, "{line}: {}", answer.err);
        }
    }
}

#[test]
fn json_and_table_hold_the_rows_of_the_csv() {
    let flags = "--until 1 --every 0.5 --attitude 0,0,3,4";
    golden("exact.json", &output(&with(&format!("{flags} --format json"))));
    golden("exact.txt", &output(&with(&format!("{flags} --format table"))));
    golden("methods.csv", &output("methods"));
    golden("experiments.csv", &output("experiment list"));
    let text = output("methods --format table");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
}

#[test]
fn unknown_names_are_answered_with_the_nearest() {
    refused(&with("--times 1 --method exakt"), &["--method: 'exakt': no such method", "'exact'"]);
    refused(&with("--times 1 --step 1 --method ratle"), &["did you mean 'rattle'?"]);
    refused(&with("--times 1 --step 1 --method verlet"), &["'verlet'", "known: exact, explicit-euler, "]);
    refused(&with("--times 1 --step 1 --method lie-poisson:322"), &["'lie-poisson:322'", "lie-poisson:321"]);
    refused(&with("--times 1 --step 1 --method rk4:2"), &["--method: 'rk4:2'", "takes no argument"]);
    refused("propagate --body dyadik --omega 1,0,0 --times 1", &["--body: 'dyadik'", "'dyadic'"]);
    refused("propagate --body moon --omega 1,0,0 --times 1", &["--body: 'moon'", "known: toutatis"]);
    refused("experiment run all drfit", &["'drfit'"]);
    refused("experiment run drfit", &["'drfit': no such experiment", "'drift'"]);
    refused("experiment run drift --scale smok", &["--scale", "'smok'", "'smoke'"]);
    refused("methods --format yaml", &["--format", "'yaml'", "table, csv, json"]);
    refused("propagat", &["'propagat'", "'propagate'"]);
    refused(&with("--unti 1"), &["'--unti'", "'--until'"]);
}

#[test]
fn a_place_that_cannot_be_written_is_refused_and_left_as_it_was() {
    let scratch = Scratch::new("out");
    let file = scratch.0.join("file");
    fs::write(&file, "kept").unwrap();
    let below = file.join("rows.csv").display().to_string();
    let folder = scratch.0.display().to_string();
    let absent = scratch.0.join("absent/rows.csv").display().to_string();
    for out in [&below, &folder, &absent] {
        refused(&with(&format!("--times 1 --out {out}")), &["--out: '", "cannot be written"]);
        refused(&format!("methods --out {out}"), &["--out: '", "cannot be written"]);
    }
    let run_out = file.display().to_string();
    refused(
        &format!("experiment run order --scale smoke --out {run_out}"),
        &["--out: '", "cannot be written"],
    );
    assert_eq!(scratch.names(), ["file"]);
    assert_eq!(fs::read_to_string(&file).unwrap(), "kept");
    // a refusal of anything else does not touch the file either
    refused(&with(&format!("--method rk4 --step 0 --times 1 --out {run_out}")), &["--step"]);
    assert_eq!(fs::read_to_string(&file).unwrap(), "kept");
}

#[test]
fn rows_go_whole_into_the_file_and_replace_the_old_ones() {
    let scratch = Scratch::new("file");
    let path = scratch.0.join("rows.csv");
    let to_file = with(&format!("--until 1 --every 0.5 --out {}", path.display()));
    assert_eq!(output(&to_file), "");
    let first = fs::read_to_string(&path).unwrap();
    assert_eq!(first, output(&with("--until 1 --every 0.5")));
    assert_eq!(output(&to_file.replace("--every 0.5", "--every 1")), "");
    assert_eq!(fs::read_to_string(&path).unwrap().lines().count(), 3);
    assert_eq!(scratch.names(), ["rows.csv"]);
}

/// A hundred thousand rows took 95 MB when they were collected first.
#[cfg(target_os = "linux")]
#[test]
fn long_runs_need_no_memory_for_their_rows() {
    let scratch = Scratch::new("memory");
    for format in ["csv", "json"] {
        let out = scratch.0.join(format).display().to_string();
        let line = with(&format!("--until 1e5 --every 1 --format {format} --out {out}"));
        let mut child =
            std::process::Command::new(env!("CARGO_BIN_EXE_polhode")).args(words(&line)).spawn().unwrap();
        let mut most = 0;
        while child.try_wait().unwrap().is_none() {
            let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
            let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.strip_suffix("kB"));
            most = most.max(peak.map_or(0, |peak| peak.trim().parse().unwrap()));
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
        assert!(most > 0 && most < 30_000, "{format}: {most} kB");
        assert!(fs::read_to_string(out).unwrap().lines().count() > 100_000);
    }
}

#[test]
fn a_table_that_nobody_reads_is_refused() {
    let line = with("--until 10000 --every 1 --format table");
    refused(&line, &["--format: 'table'", "10001 rows", "at most 10000", "give --format csv"]);
    assert!(run(&line.replace("--until 10000", "--until 100")).out.contains("omega_body_x"));
    refused(
        "simulate --body phone --omega 1,1,1 --until 20 --every 0.001 --format table",
        &["--format: 'table'", "20001 rows"],
    );
}
