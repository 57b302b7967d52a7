//! Runs that are killed at any moment, and runs at the same time: results are the old or the new ones, and whole.
//!
//! `POLHODE_KILLS=200 cargo test -p polhode-cli --test cli interrupted` kills more often.

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::harness::{Scratch, names, output, words};

/// How often each test kills.
fn kills() -> u32 {
    std::env::var("POLHODE_KILLS").ok().and_then(|text| text.parse().ok()).unwrap_or(10)
}

fn start(line: &str) -> Child {
    Command::new(env!("CARGO_BIN_EXE_polhode"))
        .args(words(line))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

fn send(signal: &str, child: &Child) {
    let line = format!("kill -{signal} {}", child.id());
    // the process may have ended by itself
    let _ = Command::new("sh").args(["-c", &line]).stderr(Stdio::null()).status().unwrap();
}

/// Moments spread evenly over a run and a little more.
fn moments(whole: Duration) -> impl Iterator<Item = Duration> {
    let golden = 0.618_033_988_749_894_9;
    (1..=kills()).map(move |k| whole.mul_f64(1.1 * (f64::from(k) * golden).fract()))
}

fn time_of(line: &str) -> Duration {
    let begin = Instant::now();
    output(line);
    begin.elapsed()
}

#[test]
fn a_killed_run_leaves_the_old_rows_or_the_new_ones() {
    let scratch = Scratch::new("killed-rows");
    let path = scratch.0.join("rows.csv");
    let lines = ["1,0.5,-0.25", "1,0.5,0.25"].map(|omega| {
        format!("propagate --body dyadic --omega {omega} --until 500 --every 0.1 --out {}", path.display())
    });
    let whole = time_of(&lines[0]);
    let first = fs::read(&path).unwrap();
    output(&lines[1]);
    let both = [first, fs::read(&path).unwrap()];
    assert_ne!(both[0], both[1]);
    for (k, moment) in moments(whole).enumerate() {
        let mut child = start(&lines[k % 2]);
        std::thread::sleep(moment);
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(both.contains(&fs::read(&path).unwrap()), "killed after {moment:?} of {whole:?}");
    }
    output(&lines[0]);
    assert_eq!(fs::read(&path).unwrap(), both[0]);
    assert_eq!(scratch.names(), ["rows.csv"]);
}

/// The files of a folder of results but for the times, of which run.toml has a line.
fn results(folder: &Path) -> BTreeMap<String, String> {
    let text = |name: &String| {
        let text = fs::read_to_string(folder.join(name)).unwrap();
        text.lines()
            .filter(|line| !line.starts_with("seconds = "))
            .fold(String::new(), |text, line| text + line + "\n")
    };
    let deterministic = names(folder).into_iter().filter(|name| name != "timing.csv");
    deterministic.map(|name| (name.clone(), text(&name))).collect()
}

/// Whether signal `number` is ignored here, and so in every program that is started from here: a shell does that for what it
/// starts in the background.
fn is_ignored(number: i32) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).unwrap_or("0");
    u64::from_str_radix(mask.trim(), 16).is_ok_and(|mask| mask >> (number - 1) & 1 == 1)
}

#[test]
fn a_killed_experiment_leaves_the_old_results_or_the_new_ones() {
    let scratch = Scratch::new("killed-experiment");
    let line = format!("experiment run order --scale smoke --out {}", scratch.0.display());
    let begin = Instant::now();
    assert_eq!(start(&line).wait().unwrap().code(), Some(0));
    let whole = begin.elapsed();
    let folder = scratch.0.join("smoke/order");
    let new = results(&folder);
    let mut old = new.clone();
    old.insert("old".into(), "from the run before\n".into());
    for moment in moments(whole) {
        fs::write(folder.join("old"), &old["old"]).unwrap();
        let mut child = start(&line);
        std::thread::sleep(moment);
        child.kill().unwrap();
        child.wait().unwrap();
        let found = results(&folder);
        assert!(found == old || found == new, "killed after {moment:?} of {whole:?}: {:?}", found.keys());
    }
    assert_eq!(start(&line).wait().unwrap().code(), Some(0));
    assert_eq!(results(&folder), new);
    assert_eq!(names(&scratch.0.join("smoke")), ["order"]);
}

#[test]
fn a_signal_leaves_nothing_beside_the_old_file() {
    let scratch = Scratch::new("signalled");
    let path = scratch.0.join("rows.csv");
    let line = |until: u32| {
        format!(
            "propagate --body dyadic --omega 1,0.5,-0.25 --until {until} --every 0.1 --out {}",
            path.display()
        )
    };
    output(&line(1));
    let old = fs::read(&path).unwrap();
    let signals =
        [("HUP", 1), ("INT", 2), ("TERM", 15)].into_iter().filter(|(_, number)| !is_ignored(*number));
    for (name, number) in signals {
        // far longer than the test waits
        let mut child = start(&line(5_000_000));
        let begin = Instant::now();
        while scratch.names().len() < 2 && begin.elapsed() < Duration::from_secs(20) {
            std::thread::sleep(Duration::from_millis(5));
        }
        send(name, &child);
        assert_eq!(child.wait().unwrap().signal(), Some(number));
        assert_eq!(scratch.names(), ["rows.csv"], "SIG{name}");
        assert_eq!(fs::read(&path).unwrap(), old);
    }
}

#[test]
fn runs_at_the_same_time_all_succeed_and_one_of_them_is_last() {
    let scratch = Scratch::new("at-once");
    let path = scratch.0.join("rows.csv");
    let line = format!(
        "propagate --body dyadic --omega 1,0.5,-0.25 --until 100 --every 0.1 --out {}",
        path.display()
    );
    output(&line);
    let rows = fs::read(&path).unwrap();
    let experiment = format!("experiment run order --scale smoke --out {}", scratch.0.display());
    for line in [line, experiment] {
        let mut children: Vec<Child> = (0..4).map(|_| start(&line)).collect();
        for child in &mut children {
            assert_eq!(child.wait().unwrap().code(), Some(0), "{line}");
        }
    }
    assert_eq!(fs::read(&path).unwrap(), rows);
    assert_eq!(scratch.names(), ["rows.csv", "smoke"]);
    assert_eq!(names(&scratch.0.join("smoke")), ["order"]);
    assert!(scratch.0.join("smoke/order/run.toml").is_file());
}
