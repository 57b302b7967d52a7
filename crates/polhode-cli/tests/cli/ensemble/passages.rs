//! First passages: those of each member alone, in any number of shards.

use std::fs;

use super::{EXACT, STEPPED, column, contents, done};
use crate::harness::{Scratch, polhode, words};

const CONE: &str = "angle(body z, space x) < 60deg";

/// A specification that looks for an event.
fn watching(spec: &str, event: &str) -> String {
    format!("{spec}[event]\nfirst = \"{event}\"\nevery = 0.5\n")
}

#[test]
fn every_member_passes_when_it_does_alone() {
    let scratch = Scratch::new("ensemble-passages");
    let rows =
        [("1,2,3", "0.4,1,-0.3"), ("2,2,1", "0.001,0,5"), ("3,1,2.5", "0,0,0"), ("1,2,3", "1,0.2,0.1")];
    let csv = rows.iter().map(|(moments, omega)| format!("{moments},{omega}\n")).collect::<String>();
    scratch.file("bodies.csv", format!("i1,i2,i3,omega_x,omega_y,omega_z\n{csv}"));
    for (method, flags) in [
        ("\"exact\"", ""),
        ("\"rk4\"\nstep = 0.125", "--method rk4 --step 0.125"),
        ("\"dop853\"\nstep = 1", "--method dop853 --step 1"),
    ] {
        let spec = format!(
            "[spread]\nmembers_file = \"bodies.csv\"\n[run]\nmethod = {method}\nstart_time = 3\ntimes = [3, 43]\n"
        );
        scratch.file("spec.toml", watching(&spec, CONE));
        let answer = polhode(&words("ensemble spec.toml --out out --replace"), &scratch.0);
        assert_eq!(answer.code, 0, "{}", answer.err);
        // the bound of the closed form excludes that a cone is missed
        assert_eq!(answer.err.contains("may be missed"), !flags.is_empty(), "{}", answer.err);
        assert!(answer.out.contains(" of 4 members by t = 43 s, to 5 % by "), "{}", answer.out);
        let found = fs::read_to_string(scratch.0.join("out/passages.csv")).unwrap();
        let mut happened = 0;
        for (line, (moments, omega)) in found.lines().skip(1).zip(rows) {
            let alone = format!(
                "propagate --moments {moments} --omega {omega} --start-time 3 --until 43 --every 0.5 --stop --fields t,q,omega --format csv {flags} --event '{CONE}'"
            );
            let answer = polhode(&words(&alone), &scratch.0);
            assert_eq!(answer.code, 0, "{}", answer.err);
            let expected = answer.out.lines().nth(1).map(|row| row.split_once("\",").unwrap().1);
            let (outcome, numbers) = line.split_once(',').unwrap().1.split_once(',').unwrap();
            match expected {
                Some(expected) => assert_eq!((outcome, numbers), ("happens", expected), "{method} {moments}"),
                None => {
                    assert_eq!((outcome, numbers), ("not by the last time", ",,,,,,,"), "{method} {moments}")
                }
            }
            happened += usize::from(outcome == "happens");
        }
        assert!((1..=3).contains(&happened), "{found}");
    }
}

#[test]
fn passages_of_shards_are_those_of_one_run() {
    let scratch = Scratch::new("ensemble-passages-shards");
    for (name, spec, event) in [("exact", EXACT, "flip"), ("stepped", STEPPED, "rate > 1.09rad/s")] {
        scratch.file("spec.toml", watching(spec, event));
        let run = |line: &str| assert_eq!(polhode(&words(line), &scratch.0).code, 0, "{line}");
        run(&format!("ensemble spec.toml --out {name} --threads 1"));
        for k in [2, 3, 1] {
            run(&format!("ensemble spec.toml --out {name}-shards --shard {k}/3"));
        }
        run(&format!("gather {name}-shards"));
        let whole = contents(&scratch.0.join(name));
        assert!(
            whole.contains_key("passages.csv")
                && contents(&scratch.0.join(format!("{name}-shards"))) == whole
        );
        let members = column(&scratch.0.join(name), "passages.csv", "member");
        assert!(members.iter().enumerate().all(|(k, member)| *member == k as f64 + 1.0));
        let table = String::from_utf8_lossy(&whole["passages.csv"]).into_owned();
        assert!(table.contains(",happens,") || table.contains(",at start,"), "{name}");
    }
    // what its run did not write is not gathered
    let path = scratch.0.join("exact-shards/shards/2-of-3/passages.csv");
    fs::write(&path, fs::read_to_string(&path).unwrap().replacen("happens", "at start", 1)).unwrap();
    let answer = polhode(&words("gather exact-shards"), &scratch.0);
    assert!(
        answer.code == 2 && answer.err.contains("passages.csv: it has changed since its run wrote it"),
        "{}",
        answer.err
    );
}

/// The second member leaves the range of a double: its momentum is squared, nearly, at each step.
#[test]
fn a_member_of_which_nothing_is_known_is_told() {
    let scratch = Scratch::new("ensemble-passages-unknown");
    scratch.file("bodies.csv", "omega_x,omega_y,omega_z\n0,0,0\n1e50,1e50,1e50\n");
    let spec = "[body]\nmoments = [1, 2, 2.5]\n[spread]\nmembers_file = \"bodies.csv\"\n[run]\n\
                method = \"explicit-euler\"\nstep = 0.5\ntimes = [0, 20]\n\
                [event]\nfirst = \"rate < 1e-3rad/s\"\n";
    scratch.file("spec.toml", spec);
    let answer = polhode(&words("ensemble spec.toml --out out"), &scratch.0);
    assert_eq!(answer.code, 0, "{}", answer.err);
    let says = "whether the event happens is not known for 1 of 2 members, the first of them member 2: ";
    assert!(answer.err.contains(says) && answer.out.contains("; not known for 1.\n"), "{}", answer.err);
}

#[test]
fn an_event_that_cannot_be_looked_for_is_refused_before_the_run() {
    let scratch = Scratch::new("ensemble-passages-refused");
    for (keys, says) in [
        ("first = \"flips\"", "key 'first': unknown event"),
        ("first = \"angle(body (0,0,0), space x) < 1deg\"", "a vector with a direction"),
        ("every = 1", "key 'first': missing in [event]"),
        ("first = \"flip\"\nevery = 0", "key 'every': the time between looks must be positive"),
        ("first = \"flip\"\nlast = 3", "no such key in [event]"),
    ] {
        scratch.file("spec.toml", format!("{EXACT}[event]\n{keys}\n"));
        let answer = polhode(&words("ensemble spec.toml --out out"), &scratch.0);
        assert!(answer.code == 2 && answer.err.contains(says), "{keys}: {}", answer.err);
    }
    let spec = watching(&EXACT.replace("[0.0, 1.0, 100.0]", "[-1.0, 0.0]"), "flip");
    scratch.file("spec.toml", spec);
    let answer = polhode(&words("ensemble spec.toml --out out"), &scratch.0);
    assert!(answer.code == 2 && answer.err.contains("not after the start"), "{}", answer.err);
    assert!(!scratch.0.join("out").exists());
    scratch.file("spec.toml", EXACT);
    done("ensemble spec.toml --out out", &scratch);
    assert!(!scratch.0.join("out/passages.csv").exists());
}
