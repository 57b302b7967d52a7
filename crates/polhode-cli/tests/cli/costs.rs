//! Runs of more steps than can be taken are refused before the first of them.

use std::time::{Duration, Instant};

use super::ensemble::STEPPED;
use crate::harness::{Scratch, polhode, refused, words};

const BODY: &str = "--moments 1,2,2.5 --omega 0.4,1,-0.3";

#[test]
fn steps_without_end_are_refused_at_once() {
    let scratch = Scratch::new("costs");
    let figure = scratch.0.join("p.svg").display().to_string();
    let begin = Instant::now();
    for (line, says) in [
        (
            "propagate BODY --times 1 --method rk4 --step 1e-12".to_string(),
            "--step: '1e-12': asks for 1e12 steps",
        ),
        (
            "propagate BODY --until 2e12 --every 1e12 --method lie-poisson --step 1".into(),
            "--step: '1': asks for 1e12 steps",
        ),
        (
            "propagate BODY --until 1e12 --every 1e12 --method tsit5".into(),
            "the body turns by 1.12e12 rad up to then",
        ),
        (
            "propagate BODY --until 1e12 --every 1e12 --method dop853 --tolerance 1e-9".into(),
            "fewer than 1e12",
        ),
        (
            format!("plot conserved BODY --until 1 --method rk4 --step 1e-12 --out {figure}"),
            "asks for 1e12 steps",
        ),
        (
            format!("plot conserved BODY --until 1e13 --method taylor --out {figure}"),
            "the body turns by 1.12e13 rad up to then",
        ),
        (
            "compare BODY --until 1 --methods rk4,rattle --steps 0.1,1e-12".into(),
            "--steps: '1e-12': asks for 1e12 steps",
        ),
        ("compare BODY --until 1e13 --methods dop853".into(), "the body turns by 1.12e13 rad up to then"),
    ] {
        refused(&line.replace("BODY", BODY), &[says, "a run has fewer than 1e12"]);
    }
    for (change, says) in [
        (("step = 0.01\nuntil = 5\nevery = 2.5", "step = 1e-12\ntimes = [1]"), "1e12 steps to the last time"),
        (
            (
                "members = 200\nmethod = \"two-turn\"\nstep = 0.01\nuntil = 5\nevery = 2.5",
                "members = 100000\nmethod = \"rk4\"\nstep = 1e-10\ntimes = [1]",
            ),
            "100000 members of 1e10 steps are 1e15 steps",
        ),
    ] {
        scratch.file("spec.toml", STEPPED.replace(change.0, change.1));
        let answer = polhode(&words("ensemble spec.toml --out out"), &scratch.0);
        assert_eq!(answer.code, 2, "{}", answer.err);
        assert!(answer.err.contains(says), "{}", answer.err);
    }
    // ten processes, the slowest of them a fraction of a second; a run of 1e12 steps takes a day
    assert!(begin.elapsed() < Duration::from_secs(60), "{:?}", begin.elapsed());
    assert_eq!(scratch.names(), ["spec.toml"]);
}

#[test]
fn a_step_that_is_tiny_is_not_told_in_three_hundred_digits() {
    let scratch = Scratch::new("costs-digits");
    scratch.file("spec.toml", STEPPED.replace("step = 0.01", "step = 1e-300"));
    let answer = polhode(&words("ensemble spec.toml --out out"), &scratch.0);
    assert_eq!(answer.code, 2, "{}", answer.err);
    assert!(answer.err.contains("steps of 1e-300 s lead to t = "), "{}", answer.err);
    assert!(answer.err.split_whitespace().all(|word| word.len() < 60), "{}", answer.err);
}
