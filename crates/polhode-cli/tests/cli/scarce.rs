//! Threads and memory that cannot be had: the work is done without, or refused in a line of ours.

use std::os::unix::process::ExitStatusExt;
use std::process::Command;

use super::ensemble::{EXACT, STEPPED};
use crate::harness::{Scratch, polhode, words};

/// Stacks of threads of this size do not fit into any address space, so that every thread is refused; unlike `ulimit -u` that binds
/// every user.
const NO_THREADS: (&str, &str) = ("RUST_MIN_STACK", "1152921504606846976");

fn scratch(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch.file("exact.toml", EXACT.replace("members = 301", "members = 20000"));
    scratch.file("stepped.toml", STEPPED);
    let line = "propagate --moments 1,2,2.5 --omega 0.4,1,-0.3 --until 40 --every 0.02 --fields t,q,omega --out run.csv";
    polhode(&words(line), &scratch.0).silent(line);
    let line = "simulate --moments 1,2,2.5 --omega 4,10,-3 --until 5 --every 0.01 --noise 1e-3 --out log.csv";
    assert_eq!(polhode(&words(line), &scratch.0).code, 0);
    scratch
}

#[test]
fn every_command_does_without_threads() {
    let scratch = scratch("threads");
    let free = "--moments 1,2,2.5 --omega 0.4,1,-0.3";
    let heavy = format!("{free} --weight-moment 0.1,0.2,0.3");
    let lines = [
        format!("propagate {free} --until 10 --every 1 --out rows.csv"),
        format!("propagate {heavy} --until 1 --every 0.1 --method rk4 --step 0.01"),
        format!("motion {free}"),
        format!("advise {free} --until 10 --attitude-error 1e-3"),
        format!("compare {heavy} --until 10 --methods rk4,rattle --steps 0.1,0.05"),
        format!("plot omega {free} --until 10 --out omega.svg"),
        format!("plot poinsot {free} --until 10 --out poinsot.html"),
        format!("show {free} --until 10 --against rk4:0.1 --out show.html"),
        "audit run.csv --moments 1,2,2.5".to_string(),
        "ensemble exact.toml --out exact --threads 4".into(),
        "ensemble stepped.toml --out stepped".into(),
        "ensemble exact.toml --out shards --shard 1/2 --threads 4".into(),
        "ensemble exact.toml --out shards --shard 2/2 --threads 4".into(),
        "gather shards --threads 4".into(),
        "fit log.csv".into(),
        format!("simulate {free} --until 10 --every 1"),
        "methods".into(),
        "bodies".into(),
        "inertia box 1,2,3 --mass 2".into(),
        "experiment list".into(),
        "experiment run order --scale smoke --out results".into(),
    ];
    for line in lines {
        alone(&line, &scratch);
    }
    // and with the same results
    let with = "ensemble exact.toml --out with --threads 4";
    polhode(&words(with), &scratch.0).silent(with);
    for folder in ["exact", "shards"] {
        let [one, other] = [folder, "with"]
            .map(|folder| std::fs::read(scratch.0.join(folder).join("attitudes.npy")).unwrap());
        assert!(one == other, "{folder}");
    }
}

#[test]
fn advice_under_a_force_does_without_threads() {
    let scratch = scratch("threads-advice");
    for rest in ["", " --check"] {
        let body = "--moments 1,2,2.5 --omega 0.4,1,-0.3 --weight-moment 0.1,0.2,0.3";
        alone(&format!("advise {body} --until 10 --attitude-error 1e-3{rest}"), &scratch);
    }
}

/// A run without threads, which ends as it should.
fn alone(line: &str, scratch: &Scratch) {
    let run = Command::new(env!("CARGO_BIN_EXE_polhode"))
        .args(words(line))
        .current_dir(&scratch.0)
        .env(NO_THREADS.0, NO_THREADS.1)
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&run.stderr);
    assert!(!told.contains("panicked"), "{line}: {told}");
    assert!(matches!(run.status.code(), Some(0 | 1)), "{line}: {:?}: {told}", run.status);
}

/// A run in a shell that allows so many kilobytes of addresses.
fn limited(kilobytes: u32, line: &str, scratch: &Scratch) -> (std::process::ExitStatus, String) {
    let command = format!("ulimit -v {kilobytes} && exec \"$0\" {line}");
    let run = Command::new("sh")
        .args(["-c", &command, env!("CARGO_BIN_EXE_polhode")])
        .current_dir(&scratch.0)
        .output()
        .unwrap();
    (run.status, String::from_utf8_lossy(&run.stderr).into_owned())
}

#[test]
fn memory_that_is_short_is_told() {
    let scratch = scratch("memory");
    let line = "propagate --moments 1,2,2.5 --omega 0.4,1,-0.3 --until 1000 --every 0.01 --fields t,q,omega --out long.csv";
    polhode(&words(line), &scratch.0).silent(line);
    // what the program itself takes differs from build to build
    let (free, _) = limited(1_000_000, "methods", &scratch);
    if !free.success() || cfg!(not(target_os = "linux")) {
        eprintln!("skipped: this shell has no limit on addresses");
        return;
    }
    let least =
        (1..40).map(|k| 5000 * k).find(|size| limited(*size, "methods", &scratch).0.success()).unwrap();
    for line in ["ensemble exact.toml --out out", "audit long.csv --moments 1,2,2.5", "fit long.csv"] {
        let (status, told) = limited(least + 4000, line, &scratch);
        assert_eq!((status.code(), status.signal()), (Some(2), None), "{line}: {told}");
        assert!(told.starts_with("error: ") && told.contains("of memory, and "), "{line}: {told}");
    }
    assert!(!scratch.0.join("out").exists());
}
