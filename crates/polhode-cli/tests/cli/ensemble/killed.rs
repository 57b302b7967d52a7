//! Shards that are killed at any moment: whole or absent, and as good as new when they are run again.
//!
//! `POLHODE_KILLS=200 cargo test -p polhode-cli --test cli killed` kills more often.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::{EXACT, contents, done};
use crate::harness::{Scratch, names};

#[test]
fn a_killed_shard_is_absent_or_whole_and_gathers_to_the_bits_of_one_run() {
    let scratch = Scratch::new("ensemble-killed");
    // a shard takes long enough to be killed in the middle
    let spec = EXACT
        .replace("members = 301", "members = 6000")
        .replace("[0.0, 1.0, 100.0]", "[0, 1, 5, 10, 50, 100]");
    scratch.file("spec.toml", spec);
    done("ensemble spec.toml --out whole", &scratch);
    let whole = contents(&scratch.0.join("whole"));
    let begin = Instant::now();
    done("ensemble spec.toml --out shards --shard 2/3", &scratch);
    let duration = begin.elapsed();
    let folder = scratch.0.join("shards/shards");
    let finished = contents(&folder.join("2-of-3"));

    let kills: u32 = std::env::var("POLHODE_KILLS").ok().and_then(|text| text.parse().ok()).unwrap_or(10);
    let mut absent = 0;
    for k in 1..=kills {
        std::fs::remove_dir_all(folder.join("2-of-3")).unwrap();
        let moment = duration.mul_f64(1.1 * (f64::from(k) * 0.618_033_988_749_894_9).fract());
        absent += u32::from(!survives(&scratch.0, &folder, moment));
        if names(&folder).iter().any(|name| name == "2-of-3") {
            assert!(contents(&folder.join("2-of-3")) == finished, "killed after {moment:?} of {duration:?}");
        }
        done_or_finished(&scratch);
        assert_eq!(names(&folder), ["2-of-3"], "killed after {moment:?}");
        assert!(contents(&folder.join("2-of-3")) == finished, "run again after {moment:?}");
    }
    assert!(absent > 0, "no kill came before the end of the shard");
    for k in [1, 3] {
        done(&format!("ensemble spec.toml --out shards --shard {k}/3"), &scratch);
    }
    done("gather shards", &scratch);
    assert!(contents(&scratch.0.join("shards")) == whole);
}

/// Whether the shard stands after a run that is killed after `moment`.
fn survives(folder: &Path, shards: &Path, moment: Duration) -> bool {
    let mut child = Command::new(env!("CARGO_BIN_EXE_polhode"))
        .args(["ensemble", "spec.toml", "--out", "shards", "--shard", "2/3"])
        .current_dir(folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(moment);
    child.kill().unwrap();
    child.wait().unwrap();
    shards.join("2-of-3").exists()
}

/// Runs the shard again; one that was finished before the kill says so.
fn done_or_finished(scratch: &Scratch) {
    let line = "ensemble spec.toml --out shards --shard 2/3";
    let answer = crate::harness::polhode(&crate::harness::words(line), &scratch.0);
    assert_eq!(answer.code, 0, "{}", answer.err);
}
