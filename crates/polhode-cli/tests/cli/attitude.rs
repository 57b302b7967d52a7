//! `polhode attitude`: attitudes from records, budgets, and records that tell no attitude.

use crate::harness::{Answer, Scratch, polhode, refused_with, run, words};

/// A record of the command itself in a file of `scratch`.
fn simulated(scratch: &Scratch, name: &str, flags: &str) -> String {
    let path = scratch.0.join(name).display().to_string();
    let line = format!("simulate --body textbook --omega 0.4,1,-0.3 --until 20 {flags} --out {path}");
    assert_eq!(run(&line).code, 0, "{line}");
    path
}

fn column(text: &str, name: &str) -> Vec<f64> {
    let mut lines = text.lines();
    let place = lines.next().unwrap().split(',').position(|found| found == name).unwrap();
    lines.map(|line| line.split(',').nth(place).unwrap().parse().unwrap()).collect()
}

/// The exact attitudes of the simulated motion.
fn exact(scratch: &Scratch, every: f64) -> String {
    let path = scratch.0.join("exact.csv").display().to_string();
    let line = format!(
        "propagate --body textbook --omega 0.4,1,-0.3 --attitude 1,0,0,0 --until 20 --every {every} --fields t,q --out {path}"
    );
    assert_eq!(run(&line).code, 0, "{line}");
    path
}

fn last(values: &[f64]) -> f64 {
    *values.last().unwrap()
}

#[test]
fn columns_are_those_of_the_contract_and_errors_those_of_the_budget() {
    let scratch = Scratch::new("attitude-columns");
    let record = simulated(&scratch, "rates.csv", "--every 0.05");
    let reference = exact(&scratch, 0.05);
    let answer = run(&format!("attitude {record} --kind rate --against {reference} --noise 0"));
    assert_eq!(answer.code, 0, "{}", answer.err);
    assert!(answer.out.starts_with("t,q_w,q_x,q_y,q_z,attitude_sigma,truncation,attitude_error\n"));
    assert_eq!(answer.out.lines().count(), 402);
    let (error, truncation) = (column(&answer.out, "attitude_error"), column(&answer.out, "truncation"));
    assert!(last(&error) < 1e-8 && last(&error) > 0.0, "{}", last(&error));
    assert!((0.3..3.0).contains(&(last(&truncation) / last(&error))));
    assert!(answer.err.contains("; at t = 20 s: truncation"), "{}", answer.err);
    assert!(answer.err.contains("the trapezoid with coning would differ by"), "{}", answer.err);
    assert!(answer.err.contains("401 rows compared, read as body to space"), "{}", answer.err);
    // the rules that others run, and orders by hand
    let of = |flags: &str| {
        let answer = run(&format!("attitude {record} --kind rate --against {reference} {flags}"));
        assert_eq!(answer.code, 0, "{}", answer.err);
        last(&column(&answer.out, "attitude_error"))
    };
    let (hold, trapezoid) = (of("--rule hold"), of("--rule trapezoid"));
    let (second, fourth, sixth) = (of("--order 2"), of("--order 4 --samples 4"), of("--order 6 --samples 6"));
    assert!(hold > 1e-3 && trapezoid > 1e-5 && second > 1e-5, "{hold} {trapezoid} {second}");
    assert!(fourth < 1e-2 * second && sixth < 0.1 * fourth, "{second} {fourth} {sixth}");
}

#[test]
fn a_noisy_record_has_its_random_walk() {
    let scratch = Scratch::new("attitude-noise");
    let record = simulated(&scratch, "noisy.csv", "--every 0.05 --noise 1e-3");
    let answer = run(&format!("attitude {record} --kind rate --bias 1e-4 --scale-error 1e-3 --euler zyx"));
    assert_eq!(answer.code, 0, "{}", answer.err);
    assert!(answer.out.starts_with("t,q_w,q_x,q_y,q_z,attitude_sigma,truncation,phi,theta,psi\n"));
    let walk = 1e-3 * (0.05_f64 * 20.0).sqrt();
    let sigma = column(&answer.out, "attitude_sigma");
    assert_eq!(sigma[0], 0.0);
    assert!(last(&sigma) > walk && last(&sigma) < 20.0 * walk, "{} {walk}", last(&sigma));
    for part in ["random walk", "(noise found in the record)", "bias", "scale"] {
        assert!(answer.err.contains(part), "{part}: {}", answer.err);
    }
    // a body that is known: its exact motion, with far less error
    let smoothed = run(&format!("attitude {record} --kind rate --body textbook"));
    assert_eq!(smoothed.code, 0, "{}", smoothed.err);
    assert!(smoothed.out.starts_with("t,q_w,q_x,q_y,q_z,attitude_sigma,truncation,integrated\n"));
    assert!(last(&column(&smoothed.out, "attitude_sigma")) < walk);
    assert!(last(&column(&smoothed.out, "integrated")) < 6.0 * walk);
    assert!(smoothed.err.contains("chi^2") && !smoothed.err.contains("warning"), "{}", smoothed.err);
    // one percent of a moment
    let near = scratch.file("near.json", r#"{"inertia": [[1, 0, 0], [0, 2.02, 0], [0, 0, 3]]}"#);
    let near = run(&format!("attitude {record} --kind rate --body {near}"));
    assert_eq!(near.code, 0, "{}", near.err);
    assert!(
        near.err.contains("warning: at t = ") && near.err.contains(" standard deviations: "),
        "{}",
        near.err
    );
    let other = run(&format!("attitude {record} --kind rate --body racket"));
    assert_eq!((other.code, other.out.as_str()), (1, ""));
    assert!(other.err.contains("the record contradicts the body"), "{}", other.err);
}

/// The first 65,536 rows tell the noise, and a record that is louder behind them has more than its budget.
#[test]
fn a_part_of_a_long_record_that_is_noisier_than_the_first_is_told() {
    let scratch = Scratch::new("attitude-louder");
    let mut state = 1_u64;
    let mut white = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut told = |loud: f64| {
        let row = |k: u32| {
            let size = if k < 66_000 { 1e-4 } else { loud };
            let [x, y, z] = [0.1, 0.2, 0.3].map(|rate| rate + size * white());
            format!("{},{x},{y},{z}\n", 0.01 * f64::from(k))
        };
        let rows: String = (0..70_000).map(row).collect();
        let file = scratch.file("long.csv", format!("t (s),wx (rad/s),wy (rad/s),wz (rad/s)\n{rows}"));
        let answer = run(&format!("attitude {file} --kind rate"));
        assert_eq!(answer.code, 0, "{}", answer.err);
        answer.err
    };
    let (loud, steady) = (told(1e-2), told(1e-4));
    assert!(loud.contains("the readings are noisier (2."), "{loud}");
    assert!(!steady.contains("noisier"), "{steady}");
}

/// Four readings of whatever noise lie on a cubic.
#[test]
fn a_record_that_is_too_short_for_its_budget_says_what_is_missing() {
    let scratch = Scratch::new("attitude-short");
    let told = |rows: u32, flags: &str| {
        let row = |t: f64| format!("{t},{},{},{}\n", 0.1 + 0.1 * t, 0.3 - 0.1 * t, 0.2 + 0.2 * t);
        let rows: String = (0..rows).map(|k| row(0.25 * f64::from(k))).collect();
        let file = scratch.file("short.csv", format!("t,wx,wy,wz\n{rows}"));
        let answer = run(&format!("attitude {file} --kind rate {flags}"));
        assert_eq!(answer.code, 0, "{answer:?}");
        answer.err
    };
    let noise = "warning: fewer than 5 samples, too few to find their noise";
    let truncation = "warning: one polynomial goes through all 4 samples";
    let four = told(4, "--order 4 --samples 4");
    assert!(four.contains(noise) && four.contains(truncation), "{four}");
    assert!(!four.contains("noise found in the record"), "{four}");
    let stated = told(4, "--samples 2 --order 2 --noise 1e-3 --stamps 1e-3");
    assert!(!stated.contains("warning: "), "{stated}");
    let five = told(5, "--order 4 --samples 4");
    assert!(!five.contains("warning: ") && five.contains("noise found in the record"), "{five}");
}

/// Readings that all rest on one step do not show what they are off within it, and add it up: as a bias of q/√12 it has a deviation that
/// grows with time.
#[test]
fn what_readings_on_one_step_are_off_is_warned_of_until_it_is_stated() {
    let scratch = Scratch::new("attitude-steps");
    let rows: String = (0..400).map(|k| format!("{},0.02,0.02,-0.02\n", 0.05 * f64::from(k))).collect();
    let file = scratch.file("steps.csv", format!("t (s),wx (rad/s),wy (rad/s),wz (rad/s)\n{rows}"));
    let answer = |flags: &str| {
        let answer = run(&format!("attitude {file} --kind rate {flags}"));
        assert_eq!(answer.code, 0, "{flags}: {}", answer.err);
        answer
    };
    let says = "warning: the readings rest on so few values";
    let bare = answer("");
    assert!(bare.err.contains(says), "{}", bare.err);
    // true rates within half a step of the readings, unseen
    assert!(last(&column(&bare.out, "attitude_sigma")) < 1e-12);
    let bias = 0.02 / 12.0_f64.sqrt();
    let stated = answer(&format!("--bias {bias}"));
    assert!(!stated.err.contains(says), "{}", stated.err);
    let grown = last(&column(&stated.out, "attitude_sigma")) / (bias * 19.95);
    assert!((0.95..1.0).contains(&grown), "{grown}");
    assert!(!answer("--noise 1e-3").err.contains(says));
}

/// Rates that jump by Δ between two rows at a distance h leave a turn open that lies anywhere within Δ h, of deviation Δ h/√12; averages
/// have the turn.
#[test]
fn the_turn_that_a_jump_between_two_rows_leaves_open_is_told() {
    let scratch = Scratch::new("attitude-jump");
    let told = |jump: f64, kind: &str| {
        let row = |k: u32| {
            let rate = 0.5 + if k < 200 { 0.0 } else { jump };
            let [x, z] = [k % 7, k % 5].map(|steps| 1e-3 * f64::from(steps));
            format!("{},{x},0,{}\n", 0.05 * f64::from(k), rate + z)
        };
        let rows: String = (0..400).map(row).collect();
        let file = scratch.file("jump.csv", format!("t (s),wx (rad/s),wy (rad/s),wz (rad/s)\n{rows}"));
        let answer = run(&format!("attitude {file} --kind {kind}"));
        assert_eq!((answer.code, answer.out.lines().count()), (0, 401), "{}", answer.err);
        answer.err
    };
    let says = "warning: 1 jumps of the rates, the first before 10 s: ";
    let jump = told(1.0, "rate");
    assert!(jump.contains(says) && jump.contains("leaves 1.4e-2 rad open"), "{jump}");
    for (jump, kind) in [(0.0, "rate"), (1.0, "average")] {
        let none = told(jump, kind);
        assert!(!none.contains("jumps of the rates"), "{none}");
    }
}

#[test]
fn the_kind_is_told_by_the_unit_or_asked_for() {
    let scratch = Scratch::new("attitude-kind");
    let rows = |head: &str| {
        let rows: String = (0..50).map(|k| format!("{:.1},0.01,0.02,0.03\n", 0.1 * f64::from(k))).collect();
        scratch.file(&format!("{}.csv", head.len()), format!("{head}\n{rows}"))
    };
    let answer = |path: &str, flags: &str| -> Answer {
        let line = format!("attitude {path} {flags}");
        polhode(&words(&line), &scratch.0)
    };
    let angle = |answer: &Answer| {
        let [w, x, y, z] = ["q_w", "q_x", "q_y", "q_z"].map(|name| last(&column(&answer.out, name)));
        2.0 * libm::atan2((x * x + y * y + z * z).sqrt(), w)
    };
    let size = 0.001_4_f64.sqrt(); // rad/s, or rad
    let silent = rows("t,wx,wy,wz");
    refused_with(&["attitude", &silent], &["--kind", "cannot be told", "rate", "increment", "average"]);
    // 49 intervals of 0.1 s, or 49 increments
    assert!((angle(&answer(&silent, "--kind rate")) - 4.9 * size).abs() < 1e-12);
    assert!((angle(&answer(&silent, "--kind increment")) - 49.0 * size).abs() < 1e-12);
    let rates = rows("t (s),wx (rad/s),wy (rad/s),wz (rad/s)");
    let told = answer(&rates, "");
    assert!((angle(&told) - 4.9 * size).abs() < 1e-12);
    assert!(told.err.contains("taken as rates"), "{}", told.err);
    let angles = rows("t (s),wx (rad),wy (rad),wz (rad)");
    assert!((angle(&answer(&angles, "")) - 49.0 * size).abs() < 1e-12);
    refused_with(&["attitude", &angles, "--kind", "rate"], &["--kind", "unit", "angle", "increment"]);
    refused_with(
        &["attitude", &rates, "--kind", "increment"],
        &["--kind: 'increment'", "rad/s (header), that of a rate", "rad or deg"],
    );
    refused_with(
        &["attitude", &silent, "--kind", "increment", "--rate-unit", "rpm"],
        &["--rate-unit: 'rpm'", "increments are angles"],
    );
    let degrees = answer(&silent, "--kind increment --rate-unit deg/s");
    assert!((angle(&degrees) - (49.0 * size).to_radians()).abs() < 1e-12);
    // a row that is missing is a turn that is missing
    assert!(!answer(&angles, "").err.contains("intervals are longer"));
    let text = std::fs::read_to_string(&angles).unwrap();
    let kept = text.split_inclusive('\n').filter(|line| !line.starts_with("2.0,"));
    let missing = scratch.file("missing.csv", kept.collect::<String>());
    let missing = answer(&missing, "--order 2 --samples 2");
    assert!((angle(&missing) - 48.0 * size).abs() < 1e-12);
    let says = "1 intervals are longer than 1.5 usual ones, the first ends at 2.1 s";
    assert!(missing.err.contains(says), "{}", missing.err);
    // a fit needs rates
    refused_with(&["fit", &angles], &["column 2 (wx (rad))", "rad/s, deg/s, rpm"]);
}

#[test]
fn the_unit_of_the_times_is_told() {
    let scratch = Scratch::new("attitude-times");
    let told = |time: &str, first: u64, step: u64, flags: &str| {
        let rows: String = (0..50).map(|k| format!("{},0.01,0.02,0.03\n", first + k * step)).collect();
        let file = scratch.file("times.csv", format!("{time},wx (rad/s),wy (rad/s),wz (rad/s)\n{rows}"));
        let answer = run(&format!("attitude {file} --kind rate {flags}"));
        assert_ne!(answer.code, 2, "{answer:?}");
        answer.err
    };
    let bare = told("t", 0, 10, "");
    assert!(bare.contains("note: ") && bare.contains("times taken as s (no unit in the header)"), "{bare}");
    assert!(told("t (ms)", 0, 10, "").contains("times in ms (header)"));
    assert!(told("t", 0, 10, "--time-unit ms").contains("times in ms (as stated)"));
    // 14 days in ns are as many as 38 years in us
    let guessed = told("timestamp", 1_200_000_000_000_000, 10_000_000, "");
    let says = "times in us since 1970 (by the values); if they count from another time";
    assert!(guessed.lines().any(|line| line.starts_with("warning: ") && line.contains(says)), "{guessed}");
    let stated = told("timestamp", 1_200_000_000_000_000, 10_000_000, "--time-unit ns");
    assert!(stated.contains("times in ns (as stated)") && !stated.contains("since 1970"), "{stated}");
}

#[test]
fn records_that_tell_no_attitude_are_refused_by_name() {
    let scratch = Scratch::new("attitude-refused");
    let file = |name: &str, rows: &str| {
        scratch.file(name, format!("t (s),wx (rad/s),wy (rad/s),wz (rad/s)\n{rows}"))
    };
    let fast = file("fast.csv", "0,1,0,0\n0.1,1,0,0\n0.2,40,0,0\n0.3,1,0,0\n");
    refused_with(
        &["attitude", &fast],
        &["fast.csv, line 4", "a turn by 4 rad", "half a turn", "aliasing", "--rate-unit"],
    );
    let even: String = (0..40).map(|k| format!("{:.1},1,0,0\n", 0.1 * f64::from(k))).collect();
    let late: String = (0..40).map(|k| format!("{:.1},1,0,0\n", 9.0 + 0.1 * f64::from(k))).collect();
    let gap = file("gap.csv", &format!("{even}{late}"));
    refused_with(&["attitude", &gap], &["gap.csv, line 42", "a gap from 3.9", "9", "--window", "--restart"]);
    let restarted = run(&format!("attitude {gap} --kind rate --restart"));
    assert_eq!((restarted.code, restarted.out.lines().count()), (0, 81), "{}", restarted.err);
    assert!(restarted.err.contains("2 parts without a gap"), "{}", restarted.err);
    // readings that rise and fall as a square, and six at the end of the range in between
    let squares = (0..=10).chain([10; 5]).chain((0..10).rev()).map(|k: i32| f64::from(k * k) / 100.0);
    let clipped: String =
        squares.enumerate().map(|(k, x)| format!("{:.1},{x},0.1,0.2\n", 0.1 * k as f64)).collect();
    let clipped = file("clipped.csv", &clipped);
    refused_with(&["attitude", &clipped], &["at the end of its range (6 samples in all)", "--restart"]);
    let restarted = run(&format!("attitude {clipped} --kind rate --restart"));
    assert_eq!(restarted.code, 0, "{}", restarted.err);
    for says in ["6 samples at the end of the sensor's range are left out", "2 parts without a gap"] {
        assert!(restarted.err.contains(says), "{says}: {}", restarted.err);
    }
    assert_eq!(run(&format!("attitude {gap} --kind rate --window 9,20")).code, 0);
    // windows that touch are one
    let [one, two] = ["--window 0,3.5", "--window 2,3.5 --window 0,2"]
        .map(|windows| run(&format!("attitude {gap} --kind rate {windows}")));
    assert_eq!((one.code, two.code), (0, 0), "{}", two.err);
    assert_eq!((one.out.lines().count(), &one.out), (37, &two.out));
    let twice = file("twice.csv", &format!("{even}3.9,2,0,0\n4,1,0,0\n"));
    refused_with(
        &["attitude", &twice, "--kind", "average"],
        &["1 rows have the time of the row before", "averages"],
    );
    let merged = run(&format!("attitude {twice} --kind rate"));
    assert!(merged.code == 0 && merged.err.contains("averaged"), "{}", merged.err);
    let two = "name,t,wx,wy,wz\na,0,1,0,0\nb,0.1,2,0,0\na,0.2,1,0,0\nb,0.3,2,0,0\n";
    let two = scratch.file("two.csv", two);
    refused_with(
        &["attitude", &two, "--kind", "rate"],
        &["line 4", "(name)", "rows of 'b' lie between rows of this body"],
    );
    let broken = file("broken.csv", "0,1,0,0\n0.1,nan,0,0\n");
    refused_with(&["attitude", &broken], &["line 3", "nan"]);
    let plain = file("plain.csv", &even);
    let bare = simulated(&scratch, "bare.csv", "--every 0.1");
    let of_bare = |flags: &str| run(&format!("attitude {bare} --kind rate {flags}")).err;
    assert!(
        of_bare("").contains("no unit of the readings is named, they are read as rad/s"),
        "{}",
        of_bare("")
    );
    assert!(!of_bare("--rate-unit rad/s").contains("no unit of the readings"));
    let with = |flags: &str| format!("attitude {plain} {flags}");
    let refused = |flags: &str, says: &[&str]| refused_with(&words(&with(flags)), says);
    refused("--samples 5", &["--samples", "5", "even"]);
    refused("--order 6 --samples 4", &["--samples", "from 6 to 12"]);
    refused("--order 3", &["--order", "3"]);
    refused("--rule runge-kutta --kind average", &["--rule", "runge-kutta", "rates"]);
    refused("--rule hold --order 4", &["--rule", "--order"]);
    refused("--bias=-1", &["--bias", "-1"]);
    refused("--start 0,0,0,0", &["--start", "zero"]);
    refused("--body nobody", &["--body", "nobody"]);
    refused("--body gyroscope", &["--body", "gravity"]);
    refused("--kind average --body phone", &["--body", "rates"]);
    let other = scratch.file("other.csv", "t,q_w,q_x,q_y,q_z\n100,1,0,0,0\n101,1,0,0,0\n");
    refused(&format!("--against {other}"), &["--against", "no row at a time"]);
    refused(&format!("--start 1,0,0,0 --against {other}"), &["--against", "no row at a time"]);
    let later = scratch.file("later.csv", "t,q_w,q_x,q_y,q_z\n1,1,0,0,0\n2,1,0,0,0\n");
    refused(&format!("--against {later}"), &["--against", "no attitude at the first time", "--start"]);
    let open = scratch.file("open.csv", "t,q0,q1,q2,q3\n0,1,0,0,0\n1,1,0,0,0\n");
    refused(
        &format!("--against {open}"),
        &["--against", "whether the scalar is first or last", "q_w, q_x, q_y, q_z"],
    );
    // a second time that jumps
    let clock = |k: i32| 0.1 * f64::from(k) + if k > 20 { 0.4 } else { 0.0 };
    let rows: String = (0..40).map(|k| format!("{},{:.2},1,0,0,0\n", 100 * k, clock(k))).collect();
    let clocks = scratch.file("clocks.csv", format!("time_ms,t,q_w,q_x,q_y,q_z\n{rows}"));
    let answer = run(&with(&format!("--against {clocks}")));
    // of a body that turned the attitude is not the identity
    assert_eq!(answer.code, 1, "{}", answer.err);
    assert!(answer.err.contains("clocks.csv: not read: t; column 't' is also a time"), "{}", answer.err);
    let angles = scratch.file("angles.csv", "t,phi,theta,psi\n0,0,0,0\n1,0,0,1\n");
    refused(&format!("--against {angles}"), &["--against", "the sequence of its Euler angles is not known"]);
}

#[test]
fn an_attitude_that_is_lost_ends_with_exit_code_1() {
    let scratch = Scratch::new("attitude-lost");
    let record = simulated(&scratch, "rates.csv", "--every 0.05");
    let answer = run(&format!("attitude {record} --kind rate --bias 0.2"));
    assert_eq!((answer.code, answer.out.lines().count()), (1, 402));
    assert!(answer.err.contains("the attitude is lost: from t = "), "{}", answer.err);
}

/// The exact attitudes are inside the budget of readings without noise, which is the truncation alone, and those of readings in
/// another unit are not.
#[test]
fn the_summary_says_whether_the_budget_holds() {
    let scratch = Scratch::new("attitude-verdict");
    let record = simulated(&scratch, "rates.csv", "--every 0.05");
    let reference = exact(&scratch, 0.05);
    let line = format!("attitude {record} --kind rate --against {reference}");
    for flags in ["", "--noise 0", "--rule hold"] {
        let answer = run(&format!("{line} {flags}"));
        assert_eq!(answer.code, 0, "{}", answer.err);
        let says = "401 within their 95 % bound: the 95 % bounds hold";
        assert!(answer.err.contains(says) && !answer.err.contains("exceed"), "{flags}: {}", answer.err);
    }
    let degrees = run(&format!("{line} --rate-unit deg/s"));
    assert_eq!((degrees.code, degrees.out.lines().count()), (1, 402), "{}", degrees.err);
    for part in
        ["the 95 % bounds are contradicted", "contradicts the attitudes: ", " of 400 errors exceed twice"]
    {
        assert!(degrees.err.contains(part), "{part}: {}", degrees.err);
    }
    // digits that the reference does not have contradict nothing
    let text = std::fs::read_to_string(&reference).unwrap();
    let rounded = text.lines().enumerate().map(|(k, line)| {
        let cells = line.split(',').map(|cell| match cell.parse::<f64>() {
            Ok(number) if k > 0 => format!("{number:.4}"),
            _ => cell.to_owned(),
        });
        cells.collect::<Vec<_>>().join(",") + "\n"
    });
    let rounded = scratch.file("rounded.csv", rounded.collect::<String>());
    let answer = run(&format!("attitude {record} --kind rate --against {rounded}"));
    assert_eq!(answer.code, 0, "{}", answer.err);
    assert!(answer.err.contains("the 95 % bounds are too small"), "{}", answer.err);
}

/// Matrices of the inverse turns contradict the attitudes in as many digits as there are, and the right ones in none.
#[test]
fn transposed_matrices_of_a_reference_contradict_the_attitudes() {
    let scratch = Scratch::new("attitude-matrices");
    let record = simulated(&scratch, "rates.csv", "--every 0.05");
    let text = std::fs::read_to_string(exact(&scratch, 0.05)).unwrap();
    let row = |line: &str, sign: f64, digits: usize| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let [t, w, x, y, z] = <[f64; 5]>::try_from(cells).unwrap();
        let w = sign * w;
        let matrix = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ];
        let cells: Vec<String> =
            matrix.as_flattened().iter().map(|entry| format!("{entry:.digits$}")).collect();
        format!("{t},{}\n", cells.join(","))
    };
    for (sign, digits, code, says) in [
        (1.0, 15, 0, "the 95 % bounds hold"),
        (1.0, 4, 0, "the 95 % bounds are too small"),
        (-1.0, 15, 1, "the 95 % bounds are contradicted"),
        (-1.0, 4, 1, "the 95 % bounds are contradicted"),
    ] {
        let rows: String = text.lines().skip(1).map(|line| row(line, sign, digits)).collect();
        let head = "t,r11,r12,r13,r21,r22,r23,r31,r32,r33";
        let file = scratch.file("matrices.csv", format!("{head}\n{rows}"));
        let answer = run(&format!("attitude {record} --kind rate --against {file}"));
        assert_eq!(answer.code, code, "{sign} {digits}: {}", answer.err);
        assert!(answer.err.contains(says), "{sign} {digits}: {}", answer.err);
    }
}

/// Most of the errors say nothing of one that is a turn by half, nor does the start that is that of the reference say anything.
#[test]
fn one_wild_row_and_a_start_alone_are_no_agreement() {
    let scratch = Scratch::new("attitude-wild");
    let record = simulated(&scratch, "rates.csv", "--every 0.05");
    let text = std::fs::read_to_string(exact(&scratch, 0.05)).unwrap();
    let (rows, _) = text.trim_end().rsplit_once('\n').unwrap();
    let wild = scratch.file("wild.csv", format!("{rows}\n20,0,0,1,0\n"));
    let answer = run(&format!("attitude {record} --kind rate --against {wild}"));
    assert_eq!((answer.code, answer.out.lines().count()), (1, 402), "{}", answer.err);
    for part in [
        "400 within their 95 % bound: the 95 % bounds do not hold everywhere",
        "1 of 400 errors exceed ten times their 95 % bound and ten times the median error, the first at t = 20 s",
    ] {
        assert!(answer.err.contains(part), "{part}: {}", answer.err);
    }
    // a clock in ms that names no unit meets the record at its start alone
    let mut lines = text.lines();
    let head = lines.next().unwrap();
    let slow = lines.map(|line| {
        let (t, rest) = line.split_once(',').unwrap();
        format!("{},{rest}\n", 1000.0 * t.parse::<f64>().unwrap())
    });
    let slow = scratch.file("slow.csv", format!("{head}\n{}", slow.collect::<String>()));
    let answer = run(&format!("attitude {record} --kind rate --against {slow}"));
    let says = "no attitude after the start is at a time of ";
    assert!(answer.code == 1 && answer.err.contains(says), "{}", answer.err);
    assert!(
        answer.err.contains("1 row compared") && !answer.err.contains("the 95 % bounds hold"),
        "{}",
        answer.err
    );
}

/// A reference with noise of its own is far off where the budget is small still, just after the start, and contradicts nothing; one that has but
/// start and end, the end five times the 95 % of its budget off, does.
#[test]
fn noise_of_a_reference_is_told_from_attitudes_that_are_off() {
    let scratch = Scratch::new("attitude-noisy");
    let record = simulated(&scratch, "rates.csv", "--every 0.05 --noise 1e-3");
    let text = std::fs::read_to_string(exact(&scratch, 0.05)).unwrap();
    let (head, rows) = text.trim_end().split_once('\n').unwrap();
    let count = rows.lines().count();
    // attitudes of these rows, turned about body x by so much, rad
    let turned = |name: &str, rows: &[usize], by: &dyn Fn(usize) -> f64| {
        let row = |k: &usize| {
            let cells: Vec<f64> =
                text.lines().nth(k + 1).unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
            let ([t, w, x, y, z], s) = (<[f64; 5]>::try_from(cells).unwrap(), 0.5 * by(*k));
            let c = (1.0 - s * s).sqrt();
            format!("\n{t},{},{},{},{}", w * c - x * s, x * c + w * s, y * c + z * s, z * c - y * s)
        };
        let path = scratch.file(name, head.to_string() + &rows.iter().map(row).collect::<String>());
        run(&format!("attitude {record} --kind rate --against {path}"))
    };
    let all: Vec<usize> = (0..count).collect();
    let noisy =
        turned("noisy.csv", &all, &|k| if k == 0 { 0.0 } else { 2e-3 * (2.0 * (k % 2) as f64 - 1.0) });
    assert_eq!(noisy.code, 0, "{}", noisy.err);
    let [error, sigma] = ["attitude_error", "attitude_sigma"].map(|name| column(&noisy.out, name)[1]);
    assert!(error > 10.0 * 2.795 * sigma, "{error} {sigma}");
    let by = 5.0 * 2.795 * last(&column(&noisy.out, "attitude_sigma"));
    let off = turned("off.csv", &[0, count - 1], &|k| if k == 0 { 0.0 } else { by });
    let says = "1 of 1 errors exceed twice their 95 % bound";
    assert!(off.code == 1 && off.err.contains(says), "{}", off.err);
    assert!(
        off.err.contains("2 rows compared") && off.err.contains("the 95 % bounds are contradicted"),
        "{}",
        off.err
    );
}

/// Columns beside the readings, and beside the attitudes of a reference, are named.
#[test]
fn what_a_file_holds_and_is_not_read_is_told() {
    let scratch = Scratch::new("attitude-unread");
    let record = simulated(&scratch, "rates.csv", "--every 0.05");
    let rates = std::fs::read_to_string(&record).unwrap();
    let (head, rows) = rates.split_once('\n').unwrap();
    let rows: String = rows.lines().map(|row| format!("{row},20\n")).collect();
    let warm = scratch.file("warm.csv", format!("{head},temperature\n{rows}"));
    let answer = run(&format!("attitude {warm} --kind rate"));
    assert!(
        answer.code == 0 && answer.err.contains("warm.csv: columns not used: temperature"),
        "{}",
        answer.err
    );
    let text = std::fs::read_to_string(exact(&scratch, 0.05)).unwrap();
    let (head, rows) = text.split_once('\n').unwrap();
    let rows: String = rows.lines().map(|row| format!("{row},20\n")).collect();
    let more = scratch.file("more.csv", format!("{head},lift\n{rows}"));
    let answer = run(&format!("attitude {record} --kind rate --against {more}"));
    assert!(answer.code == 0 && answer.err.contains("more.csv: not read: lift"), "{}", answer.err);
    let rows: String = text.lines().skip(1).map(|row| format!("{row},0,0,9\n")).collect();
    let head = text.lines().next().unwrap();
    let rates = scratch.file("both.csv", format!("{head},omega_x,omega_y,omega_z\n{rows}"));
    let answer = run(&format!("attitude {record} --kind rate --against {rates}"));
    let says = "both.csv: its angular velocities are not used";
    assert!(answer.code == 0 && answer.err.contains(says), "{}", answer.err);
}

#[test]
fn times_that_count_from_the_first_rows_of_two_files_are_compared_by_their_moments() {
    let scratch = Scratch::new("attitude-since");
    let first = 1_700_000_000_000_u64; // ms since 1970
    let file = |name: &str, first: u64, head: &str, row: &str| {
        let rows: String = (0..20).map(|k| format!("{},{row}\n", first + 100 * k)).collect();
        scratch.file(name, format!("{head}\n{rows}"))
    };
    let record = file("record.csv", first, "t,wx (rad/s),wy (rad/s),wz (rad/s)", "0,0,0");
    let reference = |name: &str, first: u64| file(name, first, "t,q_w,q_x,q_y,q_z", "1,0,0,0");
    let one = run(&format!("attitude {record} --kind rate --against {}", reference("one.csv", first)));
    assert!(one.code == 0 && one.err.contains("20 rows compared"), "{one:?}");
    let dates: String =
        (0..20).map(|k| format!("2023-11-14T22:13:{:04.1}Z,1,0,0,0\n", 20.0 + 0.1 * f64::from(k))).collect();
    let dated = scratch.file("dated.csv", format!("t,q_w,q_x,q_y,q_z\n{dates}"));
    let dated = run(&format!("attitude {record} --kind rate --against {dated}"));
    assert!(dated.code == 0 && dated.err.contains("20 rows compared"), "{dated:?}");
    // half a second later, fifteen rows are at a time of both
    let later = reference("later.csv", first + 500);
    let from = run(&format!("attitude {record} --kind rate --start 1,0,0,0 --against {later}"));
    assert!(from.code == 0 && from.err.contains("15 rows compared"), "{from:?}");
    refused_with(
        &["attitude", &record, "--kind", "rate", "--against", &later],
        &["--against", "later.csv", "no attitude at the first time", "--start"],
    );
    let plain = scratch.file("plain.csv", "t,wx (rad/s),wy (rad/s),wz (rad/s)\n0,1,0,0\n0.1,1,0,0\n");
    let says = "counted from its first row, 1700000000500; the times of the record have no such origin";
    refused_with(&["attitude", &plain, "--against", &later], &["--against", "later.csv", says]);
}

#[test]
fn a_long_burst_that_is_left_out_is_a_gap() {
    let scratch = Scratch::new("attitude-burst");
    let quiet = simulated(&scratch, "quiet.csv", "--every 0.05 --noise 1e-2");
    let quiet = std::fs::read_to_string(quiet).unwrap();
    // fifty deviations on each axis, in twelve rows
    let rows = quiet.lines().enumerate().map(|(k, line)| {
        let cells: Vec<&str> = line.split(',').collect();
        let off = |axis: usize, by: f64| cells[axis].parse::<f64>().unwrap() + by;
        match k {
            200..=211 => format!("{},{},{},{}\n", cells[0], off(1, 0.5), off(2, -0.5), off(3, 0.5)),
            _ => format!("{line}\n"),
        }
    });
    let record = scratch.file("burst.csv", rows.collect::<String>());
    let says = ["a burst of readings that are left out from ", "the turn in it is not known", "--restart"];
    refused_with(&["attitude", &record, "--kind", "rate"], &says);
    let restarted = run(&format!("attitude {record} --kind rate --restart"));
    assert_eq!(restarted.code, 0, "{}", restarted.err);
    assert!(restarted.err.contains("12 of them in bursts"), "{}", restarted.err);
    let sigma = column(&restarted.out, "attitude_sigma");
    assert_eq!(sigma.iter().filter(|sigma| **sigma == 0.0).count(), 2);
}
