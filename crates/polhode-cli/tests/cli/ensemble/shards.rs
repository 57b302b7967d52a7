//! Shares of an ensemble: the same bits in any number, on any threads, by whichever launcher.

use std::fs;
use std::process::Command;

use super::refusals::{refusal, sha256};
use super::{EXACT, STEPPED, contents, done};
use crate::harness::{Scratch, names, polhode, words};

#[test]
fn any_number_of_shards_and_threads_gives_the_bits_of_one_run() {
    let scratch = Scratch::new("ensemble-shards");
    for (name, spec) in [("exact", EXACT), ("stepped", STEPPED)] {
        scratch.file("spec.toml", spec);
        done(&format!("ensemble spec.toml --out {name}"), &scratch);
        let whole = contents(&scratch.0.join(name));
        let files = [
            "attitudes.npy",
            "dispersion.csv",
            "dispersion.svg",
            "failures.csv",
            "omegas.npy",
            "run.toml",
            "summary.csv",
        ];
        assert_eq!(whole.keys().collect::<Vec<_>>(), files);
        for threads in [1, 2, 5] {
            done(&format!("ensemble spec.toml --out {name}-{threads} --threads {threads}"), &scratch);
            assert!(
                contents(&scratch.0.join(format!("{name}-{threads}"))) == whole,
                "{name}: {threads} threads"
            );
        }
        for count in [3, 16] {
            let out = format!("{name}-of-{count}");
            // in an order that is not theirs
            for k in (1..=count).rev() {
                let threads = 1 + k % 3;
                done(
                    &format!("ensemble spec.toml --out {out} --shard {k}/{count} --threads {threads}"),
                    &scratch,
                );
            }
            done(&format!("gather {out}"), &scratch);
            assert!(contents(&scratch.0.join(&out)) == whole, "{name}: {count} shards");
            // gathered again, on one thread
            done(&format!("gather {out} --threads 1"), &scratch);
            assert!(contents(&scratch.0.join(&out)) == whole, "{name}: {count} shards again");
        }
    }
}

/// The record of results has the checksum of each file beside it, and of itself without that line.
#[test]
fn results_have_the_checksums_of_their_files() {
    let scratch = Scratch::new("ensemble-sums");
    for (name, spec) in [("exact", EXACT.to_string()), ("bare", format!("{EXACT}[output]\narrays = []\n"))] {
        scratch.file("spec.toml", spec);
        done(&format!("ensemble spec.toml --out {name}"), &scratch);
        let mut files = contents(&scratch.0.join(name));
        let record = String::from_utf8(files.remove("run.toml").unwrap()).unwrap();
        let told =
            record.lines().filter(|line| line.split_once(" = \"").is_some_and(|(_, sum)| sum.len() == 65));
        let told: Vec<&str> = told.filter(|line| line.starts_with('"')).collect();
        assert_eq!(told.len(), files.len() + 1, "{told:?}");
        let line = |name: &str, bytes: &[u8]| format!("\"{name}\" = \"{}\"", sha256(bytes));
        for (name, bytes) in &files {
            assert!(told.contains(&line(name, bytes).as_str()), "{name}: {told:?}");
        }
        let bare = record.lines().filter(|line| !line.starts_with("\"run.toml\" = "));
        let bare: String = bare.map(|line| format!("{line}\n")).collect();
        assert!(told.contains(&line("run.toml", bare.as_bytes()).as_str()), "{told:?}");
    }
}

#[test]
fn every_set_of_instructions_gives_the_same_bytes() {
    let scratch = Scratch::new("ensemble-sets");
    let near_the_separatrix = EXACT.replace("[0.4, 1.0, -0.3]", "[0.02, 1.0, -0.01]");
    let stepped = |method: &str, step: f64| {
        let step = format!("method = \"{method}\"\nstep = {step}");
        STEPPED.replace("method = \"two-turn\"\nstep = 0.01", &step)
    };
    for (name, spec) in [
        ("exact", EXACT.to_string()),
        ("dual", near_the_separatrix),
        ("two", stepped("two-turn", 0.01)),
        ("wide", stepped("two-turn:31", 0.25)),
        ("three", stepped("lie-poisson@suzuki-4", 0.01)),
        ("rk4", stepped("rk4", 0.05)),
        ("unit", stepped("rk4-normalized", 0.05)),
    ] {
        scratch.file("spec.toml", &spec);
        let [widest, avx2, baseline] = ["widest", "avx2", "baseline"].map(|set| {
            let out = format!("{name}-{set}");
            done(&format!("ensemble spec.toml --out {out} --instructions {set}"), &scratch);
            contents(&scratch.0.join(out))
        });
        assert_eq!(widest.len(), 7, "{name}");
        assert!(widest == avx2, "{name}: avx2");
        assert!(widest == baseline, "{name}: baseline");
    }
}

#[test]
fn comments_and_the_order_of_keys_make_no_other_run() {
    let scratch = Scratch::new("ensemble-hash");
    scratch.file("one.toml", EXACT);
    let other = EXACT.replace("members = 301\nseed = 7", "seed = 7  # the same\nmembers = 301");
    scratch.file("other.toml", format!("# with a comment\n{other}"));
    scratch.file("third.toml", EXACT.replace("seed = 7", "seed = 8"));
    done("ensemble one.toml --out out --shard 1/2", &scratch);
    done("ensemble other.toml --out out --shard 2/2", &scratch);
    done("gather out", &scratch);
    let answer = polhode(&words("ensemble third.toml --out out --shard 2/2"), &scratch.0);
    assert_eq!(answer.code, 2);
    assert!(answer.err.contains("is a shard of another run"), "{}", answer.err);
}

#[test]
fn what_is_finished_is_not_run_again() {
    let scratch = Scratch::new("ensemble-finished");
    scratch.file("spec.toml", EXACT);
    for (line, file) in [
        ("ensemble spec.toml --out out --shard 2/3", "out/shards/2-of-3/attitudes.npy"),
        ("ensemble spec.toml --out whole", "whole/attitudes.npy"),
    ] {
        done(line, &scratch);
        let written = || fs::metadata(scratch.0.join(file)).unwrap().modified().unwrap();
        let first = written();
        let again = polhode(&words(line), &scratch.0);
        assert_eq!((again.code, again.out.as_str()), (0, ""));
        assert!(again.err.starts_with("note: ") && again.err.contains("already"), "{}", again.err);
        assert_eq!(written(), first);
    }
    assert_eq!(names(&scratch.0.join("out/shards")), ["2-of-3"]);
    // results that have lost a file are no results
    let whole = contents(&scratch.0.join("whole"));
    fs::remove_file(scratch.0.join("whole/summary.csv")).unwrap();
    done("ensemble spec.toml --out whole", &scratch);
    assert!(contents(&scratch.0.join("whole")) == whole);
}

#[test]
fn gathering_leaves_no_file_of_other_results_beside_its_own() {
    let scratch = Scratch::new("ensemble-stale");
    scratch.file("both.toml", format!("{EXACT}[event]\nfirst = \"rate > 2rad/s\"\n"));
    scratch.file("one.toml", format!("{EXACT}[output]\narrays = [\"attitudes\"]\n"));
    assert_eq!(polhode(&words("ensemble both.toml --out out"), &scratch.0).code, 0);
    scratch.file("out/notes.txt", "mine");
    for k in [1, 2] {
        done(&format!("ensemble one.toml --out out --shard {k}/2"), &scratch);
    }
    let before = contents(&scratch.0.join("out"));
    let told = refusal(&scratch, "gather out");
    assert!(told.contains("holds results of another run: ") && told.contains("--replace"), "{told}");
    assert!(contents(&scratch.0.join("out")) == before);
    done("gather out --replace", &scratch);
    assert_eq!(fs::read(scratch.0.join("out/notes.txt")).unwrap(), b"mine");
    fs::remove_file(scratch.0.join("out/notes.txt")).unwrap();
    done("ensemble one.toml --out whole", &scratch);
    assert!(contents(&scratch.0.join("out")) == contents(&scratch.0.join("whole")));
}

#[test]
fn ranks_without_a_share_write_nothing() {
    let scratch = Scratch::new("ensemble-ranks");
    scratch.file("spec.toml", EXACT);
    let run = |flags: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_polhode"));
        command.env("SLURM_PROCID", "1").env("SLURM_STEP_NUM_TASKS", "2").env("PMIX_RANK", "1");
        command.args(["ensemble", "spec.toml", "--out", "out"]).args(flags);
        let done = command.current_dir(&scratch.0).output().unwrap();
        (done.status.code(), String::from_utf8(done.stderr).unwrap())
    };
    let (code, told) = run(&[]);
    assert!(code == Some(2) && told.contains("several processes are started"), "{code:?} {told}");
    assert_eq!(scratch.names(), ["spec.toml"]);
    // as asked for
    assert_eq!(run(&["--shard", "2/2"]).0, Some(0));
    assert_eq!(names(&scratch.0.join("out/shards")), ["2-of-2"]);
}

#[test]
fn launchers_name_the_shard() {
    let scratch = Scratch::new("ensemble-launchers");
    scratch.file("spec.toml", EXACT);
    let run = |variables: &[(&str, String)], out: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_polhode"));
        for (name, value) in variables {
            command.env(name, value);
        }
        let done =
            command.args(["ensemble", "spec.toml", "--out", out]).current_dir(&scratch.0).output().unwrap();
        let told = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(0), "{told}");
        assert!(told.contains("note: shard "), "{told}");
    };
    done("ensemble spec.toml --out whole", &scratch);
    for k in 0..3 {
        let slurm = [("ID", k + 4), ("MIN", 4), ("MAX", 6), ("COUNT", 3)];
        let names =
            ["SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_MAX", "SLURM_ARRAY_TASK_COUNT"];
        let slurm: Vec<_> = names.into_iter().zip(slurm.map(|(_, value)| value.to_string())).collect();
        run(&slurm, "slurm");
        run(&[("OMPI_COMM_WORLD_RANK", k.to_string()), ("OMPI_COMM_WORLD_SIZE", "3".into())], "mpi");
        run(&[("PMI_RANK", k.to_string()), ("PMI_SIZE", "3".into())], "pmi");
    }
    let whole = contents(&scratch.0.join("whole"));
    for out in ["slurm", "mpi", "pmi"] {
        done(&format!("gather {out}"), &scratch);
        assert!(contents(&scratch.0.join(out)) == whole, "{out}");
    }
}
