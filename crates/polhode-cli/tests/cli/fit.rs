//! `polhode simulate` and `polhode fit` as their users meet them: from a record to a tensor, and every refusal.

use std::fs;

use serde_json::Value;

use crate::harness::{Scratch, golden, output, run};

fn refused(code: i32, line: &str, says: &[&str]) {
    let answer = run(line);
    assert_eq!(answer.code, code, "{line}: {}", answer.err);
    assert!(answer.err.starts_with("error: "), "{line}: {}", answer.err);
    for part in says {
        assert!(answer.err.contains(part), "{line}: '{part}' is not in: {}", answer.err);
    }
}

fn json(line: &str) -> Value {
    serde_json::from_str(&run(&format!("{line} --format json")).out).unwrap()
}

const SIMULATE: &str = "simulate --moments 1,2,2.6 --omega 0.3,1,0.4 --every 0.02";

#[test]
fn a_simulated_record_is_the_golden_one() {
    let found = output(&format!("{SIMULATE} --until 0.2 --noise 0.01 --jitter 0.5 --seed 3"));
    golden("simulate.csv", &found);
    let exact = output(&format!("{SIMULATE} --until 0.2"));
    let propagated = output("propagate --moments 1,2,2.6 --omega 0.3,1,0.4 --times 0.2");
    let last = |text: &str, from: usize| -> Vec<f64> {
        text.lines().last().unwrap().split(',').skip(from).take(3).map(|c| c.parse().unwrap()).collect()
    };
    for (a, b) in last(&exact, 1).iter().zip(last(&propagated, 5)) {
        assert!((a - b).abs() < 1e-15);
    }
}

/// Two tosses with everything at once, and what each row must add up to.
#[test]
fn a_simulated_instrument_is_the_golden_one() {
    let found = output(&format!(
        "{SIMULATE} --until 0.1 --noise 0.01 --hidden-jitter 0.5 --tosses 2 --pause 1 --scatter 0.1 --seed 3 \
         --relative-drag 0.2 --drag 0.1,0.2,0.3 --torque 0,0.01,0 --known-torque 0.5,0,0 --torque-noise 0.01 \
         --wheel-momentum 0,0,1 --wheel-rate 1,0,0 --offset 0.01,0,-0.02 --offset-walk 0.001 --scale-error 0.01 \
         --axis-scale-errors 0,0.02,0 --misalignment 0.01,0,0 --quantum 0.001 --skew 0,0.001,0.002 \
         --spikes 0.2,5"
    ));
    golden("simulate-instrument.csv", &found);
    assert!(
        found.starts_with("t,wx,wy,wz,hx (N m s),hy (N m s),hz (N m s),tx (N m),ty (N m),tz (N m)\n0.0,"),
        "{found}"
    );
    let rows: Vec<Vec<f64>> =
        found.lines().skip(1).map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len(), 12);
    for (k, row) in rows.iter().enumerate() {
        let toss = (k / 6) as f64;
        assert!((row[0] - (1.1 * toss + 0.02 * (k % 6) as f64)).abs() < 1e-12);
        assert!(row[1..4].iter().all(|w| (w / 0.001 - (w / 0.001).round()).abs() < 1e-9));
        assert!((row[4] - (row[0] - 1.1 * toss)).abs() < 1e-12 && row[5..] == [0.0, 1.0, 0.5, 0.0, 0.0]);
    }
    // what is zero changes nothing
    let plain = format!("{SIMULATE} --until 0.2 --noise 0.01 --jitter 0.5 --seed 3");
    let zeros =
        "--relative-drag 0 --drag 0,0,0 --torque 0,0,0 --offset 0,0,0 --spikes 0,5 --quantum 0 --tosses 1";
    assert_eq!(output(&plain), output(&format!("{plain} {zeros}")));
}

#[test]
fn what_is_simulated_is_found_again() {
    let scratch = Scratch::new("again");
    let record = scratch.0.join("record.csv").display().to_string();
    output(&format!("{SIMULATE} --until 30 --noise 1e-3 --out {record}"));
    let answer = json(&format!("fit {record} --trace 5.6"));
    let number = |key: &str, k: usize| answer[key][k].as_f64().unwrap();
    for (k, moment) in [1.0, 2.0, 2.6].into_iter().enumerate() {
        let error = (number("principal", k) - moment / 5.6).abs();
        assert!(error < 5.0 * number("sigma_principal", k) && error < 1e-3, "{answer:#}");
        assert!((answer["inertia"][k][k].as_f64().unwrap() - moment).abs() < 5e-3);
    }
    // the covariance is that of a trace held fixed
    let covariance = |i: usize, j: usize| answer["covariance"][i][j].as_f64().unwrap();
    let along: f64 = (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).map(|(i, j)| covariance(i, j)).sum();
    assert!(along.abs() < 1e-12 * covariance(0, 0));
    for key in [
        "shape",
        "principal",
        "axes",
        "covariance",
        "sigma_principal",
        "noise_sigma",
        "samples",
        "segments",
        "method",
        "identifiable",
        "null_directions",
        "triangle_slack",
        "active_constraints",
        "chi2_per_dof",
        "warnings",
        "inertia",
        "inertia_covariance",
    ] {
        assert!(!answer[key].is_null(), "{key}");
    }
    assert_eq!((&answer["samples"], &answer["identifiable"]), (&Value::from(1501), &Value::from(true)));
    assert!(answer["warnings"].as_array().unwrap().is_empty(), "{answer:#}");
    let shape_only = json(&format!("fit {record}"));
    assert!(shape_only["inertia"].is_null() && shape_only["inertia_covariance"].is_null());

    // rows, and text no wider than a page
    let rows = output(&format!("fit {record}"));
    assert!(rows.starts_with("quantity,value,sigma,unit\nprincipal_1,0.178"), "{rows}");
    // (1, 2, 2.6)/5.6 with the ratios of Euler's equations negated
    for part in
        ["\nunexplained,", "\nmirror_principal_1,0.13", "\nmirror_principal_3,0.459", "\nunseen_change_3,"]
    {
        assert!(rows.contains(part), "{part}: {rows}");
    }
    let text = output(&format!("fit {record} --format table"));
    for part in ["deviation over the Cramer-Rao bound: 1.0", "tensor midway may go unseen: of I1 up to"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    // two windows of the one file, and a drawing
    let svg = scratch.0.join("residuals.svg");
    let line = format!("fit {record} --window 1:0,12 --window 15,30 --residuals {}", svg.display());
    assert_eq!(json(&line)["segments"], Value::from(2));
    assert!(fs::read_to_string(svg).unwrap().starts_with("<svg"));
}

/// The page stands alone, the residuals are those of the noise, and a refusal has its page too.
#[test]
fn a_report_is_one_page_also_of_a_refusal() {
    let scratch = Scratch::new("report");
    let path = |name: &str| scratch.0.join(name).display().to_string();
    let [record, html, markdown, rows] = ["record.csv", "fit.html", "fit.md", "residuals.csv"].map(path);
    output(&format!("{SIMULATE} --until 8 --noise 1e-2 --tosses 3 --scatter 0.3 --out {record}"));
    let text = output(&format!("fit {record} --report {html} --residuals {rows} --format table"));
    assert!(text.starts_with("I1 : I2 : I3 = 0.1"), "{text}");
    assert!(
        text.contains("(95 %, statistical)") && text.lines().all(|line| line.chars().count() <= 80),
        "{text}"
    );
    let page = fs::read_to_string(&html).unwrap();
    for part in ["I1 : I2 : I3 = 0.1", "<th>segment</th>", "Segment 3: rms", "white noise", "|Jω|", "</html>"]
    {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("src=") && !page.contains("href="), "needs another file");
    assert!(page.matches("<svg").count() == 7 && !page.contains("NaN"), "{}", page.matches("<svg").count());
    let residuals = fs::read_to_string(&rows).unwrap();
    let (mut sum, mut count) = (0.0, 0.0);
    for row in residuals.lines().skip(1) {
        let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        assert!((cells[2] - cells[5] - cells[8]).abs() < 1e-15);
        sum += cells[8..].iter().map(|x| x * x).sum::<f64>();
        count += 3.0;
    }
    // 1203 samples of noise 0.01, of which 14 numbers are fitted
    assert!(count == 3609.0 && ((sum / count).sqrt() / 1e-2 - 1.0).abs() < 0.05, "{sum} {count}");
    output(&format!("fit {record} --report {markdown}"));
    let text = fs::read_to_string(&markdown).unwrap();
    assert!(
        text.starts_with(&format!("# Inertia from {record}\n\n**")) && text.contains("I1 : I2"),
        "{text}"
    );

    output(&format!(
        "simulate --moments 1,2,2.6 --omega 0,0,2 --until 10 --every 0.01 --noise 1e-3 --out {record}"
    ));
    refused(1, &format!("fit {record} --report {html}"), &["does not determine the tensor"]);
    let page = fs::read_to_string(&html).unwrap();
    for part in ["No inertia from", "Undetermined", "is a principal axis", "Size of the rate"] {
        assert!(page.contains(part), "{part}");
    }
    let pdf = path("fit.pdf");
    refused(2, &format!("fit {record} --report {pdf}"), &["--report: '", "end in .html or .md"]);
    refused(
        2,
        &format!("fit {record} --report {html} --residuals {html}"),
        &["it would replace --residuals"],
    );
}

#[test]
fn what_is_not_determined_is_said_and_fails() {
    let scratch = Scratch::new("spin");
    let record = scratch.0.join("spin.csv").display().to_string();
    output(&format!(
        "simulate --moments 1,2,2.6 --omega 0,0,2 --until 10 --every 0.01 --noise 1e-3 --out {record}"
    ));
    let line = format!("fit {record}");
    refused(
        1,
        &line,
        &[
            "spin.csv",
            "does not determine the tensor",
            "ratio of the two moments perpendicular to the spin axis",
            "the z axis of the sensor, is a principal axis: the body spins about it",
        ],
    );
    let answer = json(&line);
    assert_eq!(answer["identifiable"], Value::from(false));
    assert!(answer["known"][0].as_str().unwrap().contains("is a principal axis"));
    assert!(answer["null_directions"][0].as_str().unwrap().contains("spins about one axis"));
    assert!(
        run(&format!("{line} --format table"))
            .out
            .contains("Undetermined:\n  the ratio of the two moments perpendicular")
    );
    assert!(run(&line).out.contains("undetermined,"));
}

#[test]
fn a_motion_that_noise_hides_is_a_refusal_and_no_bad_input() {
    let scratch = Scratch::new("hidden");
    let record = scratch.0.join("hidden.csv").display().to_string();
    let spin = "simulate --moments 1,2,3 --omega -0.066,-0.079,-0.995 --until 60 --every 0.04 --noise 0.05";
    output(&format!("{spin} --out {record}"));
    refused(1, &format!("fit {record}"), &["hidden.csv", "did not converge", "Known: ("]);
    let answer: Value = serde_json::from_str(&run(&format!("fit {record} --format json")).out).unwrap();
    assert!(
        answer["known"][0].as_str().unwrap().contains("is a principal axis if no torque acted"),
        "{answer:#}"
    );
}

/// A noiseless symmetric body: its third rate flickers by a unit in the last place.
#[test]
fn what_is_simulated_without_noise_is_read() {
    let scratch = Scratch::new("noiseless");
    let record = scratch.0.join("symmetric.csv").display().to_string();
    output(&format!("simulate --moments 1,1,2 --omega 0.5,0,1 --until 20 --every 0.01 --out {record}"));
    let answer = json(&format!("fit {record}"));
    assert_eq!(answer["samples"], Value::from(2001));
    assert!((answer["principal"][2].as_f64().unwrap() - 0.5).abs() < 1e-9, "{answer:#}");
}

/// Columns as Sensor Logger writes them, and a name before them.
#[test]
fn a_phones_record_gives_the_tensor_of_its_columns() {
    let scratch = Scratch::new("phone");
    let simulated = output(&format!("{SIMULATE} --until 30 --noise 1e-3"));
    let plain = scratch.file("plain.csv", &simulated);
    let rows = simulated.lines().skip(1).enumerate().map(|(i, row)| {
        let cells: Vec<&str> = row.split(',').collect();
        let nanoseconds = 1_727_600_000_000_000_000 + 20_000_000 * i;
        format!("toss 1,{nanoseconds},{},{},{},{}\n", cells[0], cells[3], cells[2], cells[1])
    });
    let rows = rows.collect::<String>();
    let phone = scratch.file("phone.csv", format!("run,time,seconds_elapsed,z,y,x\n{rows}"));
    let [plain, phone] = [plain, phone].map(|file| json(&format!("fit {file}")));
    assert_eq!((&plain["shape"], &plain["samples"]), (&phone["shape"], &phone["samples"]));
    refused(
        2,
        &format!("fit {} --time-unit ns", scratch.0.join("phone.csv").display()),
        &["(seconds_elapsed): the header says s, the flag says ns"],
    );
}

#[test]
fn unusable_input_is_refused_by_file_line_and_column() {
    let scratch = Scratch::new("refused");
    let nan = scratch.file("nan.csv", "t,wx,wy,wz\n0,1,2,3\n0.1,1,nan,3\n");
    refused(2, &format!("fit {nan}"), &["nan.csv, line 3, column 3 (wy): 'nan': is not a finite number"]);
    let short = scratch.file("short.csv", "t,wx,wy,wz\n0,1,2,3\n0.1,1,2,3\n");
    refused(2, &format!("fit {short}"), &["short.csv: 2 samples, at most 2 without a gap", "at least 16"]);
    let still = (0..100).map(|i| format!("{i},0,0,0\n")).collect::<String>();
    let still = scratch.file("still.csv", format!("t,wx,wy,wz\n{still}"));
    refused(1, &format!("fit {still}"), &["still.csv: the rotation is too slow", "root mean square of 0"]);
    let headless = scratch.file("headless.csv", "0,9,1,2,3\n1,9,1,2,3\n");
    refused(2, &format!("fit {headless}"), &["headless.csv: no column for time", "--columns t=NAME"]);
    let thousands = scratch.file("thousands.csv", "t,wx,wy,wz\n0.5,\"1,000\",0,0\n");
    refused(2, &format!("fit {thousands}"), &["thousands.csv, line 2, column 2 (wx): '1,000': has a comma"]);
    let wide = scratch.file("wide.csv", "t,wx,wy,wz\n0,5,1,0,0\n");
    refused(2, &format!("fit {wide}"), &["wide.csv, line 2: 5 cells where the header has 4"]);
    let text = scratch.file("text.csv", "run,t,wx,wy\nr1,0,1,2\nr2,1,1,2\n");
    refused(2, &format!("fit {text}"), &["the header has 'run', 't', 'wx', 'wy'"]);
    let binary = scratch.file("binary.csv", "\u{1}IMU,".repeat(1000));
    let message = run(&format!("fit {binary}")).err;
    assert!(message.contains("no column for time") && message.len() < 400, "{message}");
    refused(2, "fit absent.csv", &["absent.csv: cannot be read"]);
    refused(2, &format!("fit {nan} --rate-unit mph"), &["--rate-unit", "'mph'", "rad/s, deg/s, rpm"]);
    refused(2, &format!("fit {nan} --window 2,1"), &["--window", "not before"]);
    refused(2, &format!("fit {nan} --noise 0"), &["--noise", "not positive"]);
    refused(
        2,
        &format!("fit {short} --window 5,6"),
        &["no samples between 5 s and 6 s", "from 0 s to 0.1 s"],
    );
    refused(2, &format!("fit {short} --window 2:0,1"), &["--window: '2:0.0,1.0'", "there is 1 file"]);
    refused(
        2,
        &format!("fit {short} {wide} --window 1:0,0.1"),
        &["--window", "file 2 has none, and others have", "--window 2:t0,t1"],
    );
    let half = scratch.file("half.csv", "t,wx (deg/s),wy,wz\n0,1,2,3\n1,2,3,4\n");
    refused(2, &format!("fit {half}"), &["half.csv", "column 3 (wy)", "names no unit, and another rate"]);
    refused(2, &format!("fit {short} --trace 1 --momentum 2"), &["--trace", "--momentum", "cannot be used"]);

    let record = scratch.0.join("record.csv").display().to_string();
    output(&format!("{SIMULATE} --until 20 --noise 1e-3 --out {record}"));
    refused(2, &format!("fit {record} --at-most 1,0,0,0.2 --at-least 2,0,0,0.3"), &["exclude each other"]);
    refused(
        1,
        &format!("fit {record} --noise 0.6"),
        &["record.csv: the stated noise of 6.00e-1 rad/s", "that neighbouring readings show", "(--noise)"],
    );
    refused(2, &format!("fit {record} --at-least 0,0,1,0.6"), &["half the trace"]);
    refused(2, &format!("fit {record} --at-least 0,0,0,0.1"), &["limit 1 has the axis"]);
    refused(2, &format!("fit {record} --trace -1"), &["the known quantity is -1"]);
    refused(
        2,
        &format!("fit {record} --rate-unit deg/s"),
        &["record.csv: the units look mistaken", "rates in rad/s read as deg/s", "--trust-units"],
    );
    refused(2, &format!("fit {record} --trace 1e308"), &["the known quantity is 1e308"]);
    refused(2, &format!("fit {record} --at-least 1,0,0,0.3 --at-most 1,0,0,0.3"), &["leave no room"]);
    refused(2, &format!("fit {record} --time-unit ns"), &["times in s read as ns"]);
    refused(2, &format!("fit {record} {record}"), &["the file is given twice"]);
    refused(2, &format!("fit {record} --radius 10"), &["of 10 s needs a segment of 21.25"]);
    let nowhere = run(&format!("fit {record} --residuals /nowhere/r.svg"));
    assert!(nowhere.code == 2 && nowhere.err.contains("--residuals: '/nowhere/r.svg'"), "{}", nowhere.err);
    let before = fs::read_to_string(&record).unwrap();
    refused(2, &format!("fit {record} --out {record}"), &["--out", "it would replace the input"]);
    let same = scratch.0.join("same").display().to_string();
    refused(2, &format!("fit {record} --out {same} --residuals {same}"), &["it would replace --out"]);
    assert_eq!(fs::read_to_string(&record).unwrap(), before);
    refused(2, &format!("{SIMULATE} --until 1 --noise -1"), &["'--noise <SIGMA>'", "-1.0 is negative"]);
    refused(2, &format!("{SIMULATE} --until 1 --jitter 1"), &["'--jitter <FRACTION>'", "keep their order"]);
    for (flags, says) in [
        ("--relative-drag -0.1", ["'--relative-drag <K>'", "-0.1 is negative"]),
        ("--drag 0,-1,0", ["'--drag <dx,dy,dz>'", "-1.0 would drive the body"]),
        ("--spikes 2,5", ["'--spikes <FRACTION,SIZE>'", "a fraction from 0 to 1"]),
        ("--hidden-jitter -1", ["'--hidden-jitter <FRACTION>'", "keep their order"]),
        ("--jitter 0.75 --hidden-jitter 0.5", ["--hidden-jitter: '0.5': with --jitter 0.75", "over 1.25 DT"]),
        ("--jitter 0.5 --hidden-jitter 0.5", ["--hidden-jitter: '0.5'", "must keep their order; give"]),
        ("--tosses 0", ["'--tosses <N>'", "0"]),
        ("--tosses 100000", ["--tosses: '100000'", "51 samples each"]),
        ("--pause 0", ["'--pause <P>'", "not positive"]),
        ("--pause 1", ["--pause: there is one toss", "--tosses"]),
        ("--scatter 1", ["--scatter: there is one toss", "--tosses"]),
        ("--tosses 2 --pause 1us --jitter 0.9", ["--pause: '1e-6'", "tosses overlap"]),
        ("--attitude-noise 1e-3 --offset 0,0.1,0", ["--attitude-noise: without --noise", "give --noise too"]),
        ("--torque 1e99,0,1e98", ["the motion cannot be followed beyond", "weaken the torques"]),
        ("--offset 0,x,0", ["'--offset <bx,by,bz>'", "item 2: 'x' is not a number"]),
    ] {
        refused(2, &format!("{SIMULATE} --until 1 {flags}"), &says);
    }
    // a refusal leaves the file of an earlier answer alone
    let kept = scratch.file("kept.csv", "kept");
    refused(2, &format!("fit {nan} --out {kept}"), &["line 3"]);
    assert_eq!(fs::read_to_string(kept).unwrap(), "kept");
}

#[test]
fn help_names_every_flag_in_80_columns() {
    for (command, flags) in [
        (
            "simulate",
            [
                "--omega",
                "--every",
                "--noise",
                "--jitter",
                "--tosses",
                "--wheel",
                "--spikes",
                "--relative-drag",
            ],
        ),
        (
            "fit",
            [
                "--time-unit",
                "--rate-unit",
                "--window",
                "--radius",
                "--noise",
                "--at-least",
                "--report",
                "--residuals",
            ],
        ),
    ] {
        let help = output(&format!("{command} --help"));
        for flag in flags {
            assert!(help.contains(flag), "{command}: {flag}");
        }
        assert!(help.lines().all(|line| line.chars().count() <= 80), "{help}");
    }
}

/// Columns of wheels and torques give the tensor its size; what cannot be used of them is told by file and line.
#[test]
fn wheels_and_torques_are_columns() {
    let scratch = Scratch::new("wheels");
    let path = |name: &str| scratch.0.join(name).display().to_string();
    let trace = |answer: &Value| {
        let inertia = answer["inertia"].as_array().unwrap_or_else(|| panic!("{answer:#}"));
        (0..3).map(|k| inertia[k][k].as_f64().unwrap()).sum::<f64>()
    };
    let record = path("momenta.csv");
    output(&format!("{SIMULATE} --until 30 --noise 1e-3 --wheel-momentum 0.2,-0.3,0.4 --out {record}"));
    let by_momenta = trace(&json(&format!("fit {record}")));
    assert!((by_momenta - 5.6).abs() < 0.05, "{by_momenta}");
    output(&format!("{SIMULATE} --until 30 --noise 1e-3 --known-torque 0.05,0.02,-0.03 --out {record}"));
    let by_torques = trace(&json(&format!("fit {record}")));
    assert!((by_torques - 5.6).abs() < 0.1, "{by_torques}");

    // the speed of one wheel about z: 0.4 N m s are 40 rad/s of 0.01 kg m²
    output(&format!("{SIMULATE} --until 30 --noise 1e-3 --wheel-momentum 0,0,0.4 --out {record}"));
    let text = fs::read_to_string(&record).unwrap();
    let with_speed = |header: &str, speed: &str| {
        let rows = text.lines().skip(1).map(|row| {
            let cells: Vec<&str> = row.split(',').take(4).collect();
            format!("{},{speed}\n", cells.join(","))
        });
        format!("t,wx,wy,wz,{header}\n{}", rows.collect::<String>())
    };
    let speed = path("speed.csv");
    for (header, value) in [("wheel (rad/s)", "40"), ("Wheel [rpm]", "381.9718634205488")] {
        fs::write(&speed, with_speed(header, value)).unwrap();
        let by_speed = trace(&json(&format!("fit {speed} --wheel 0,0,2,0.01")));
        assert!((by_speed - 5.6).abs() < 0.05, "{header}: {by_speed}");
    }
    let unused = run(&format!("fit {speed}"));
    assert!(
        unused.err.contains("(Wheel [rpm]): the column is not used; give --wheel nx,ny,nz,I"),
        "{}",
        unused.err
    );
    fs::write(&speed, with_speed("wheel", "40")).unwrap();
    let says = ["speed.csv, line 1, column 5 (wheel): the column has no unit", "rad/s, deg/s or rpm"];
    refused(2, &format!("fit {speed} --wheel 0,0,1,0.01"), &says);
    fs::write(&speed, with_speed("wheel (rad/s)", "40").replacen(",40\n", ",fast\n", 1)).unwrap();
    refused(2, &format!("fit {speed} --wheel 0,0,1,0.01"), &["line 2, column 5 (wheel (rad/s))", "'fast'"]);
    refused(2, &format!("fit {record} --wheel 0,0,1,0.01"), &["no column for the speed of the wheel"]);
    refused(2, &format!("fit {record} --wheel 0,0,1,-1"), &["--wheel", "must be positive"]);
    fs::write(&speed, with_speed("hx (N m s)", "40")).unwrap();
    refused(2, &format!("fit {speed}"), &["line 1, column 5 (hx (N m s))", "two columns more"]);
    fs::write(&record, text.replace("(N m s)", "(g m)")).unwrap();
    refused(2, &format!("fit {record}"), &["line 1, column 5 (hx (g m)): 'g m'", "known: N m s"]);
    fs::write(&record, text.replace(" (N m s)", "")).unwrap();
    refused(2, &format!("fit {record}"), &["line 1, column 5 (hx): the column has no unit", "N m s"]);
}

/// A mirrored axis gives another body, which the report of each names; `--axes` undoes it, and says so.
#[test]
fn a_mirrored_axis_is_named_and_undone() {
    let scratch = Scratch::new("mirrored");
    let record = output("simulate --moments 1,2,2.6 --omega 0.3,1,0.4 --until 20 --every 0.02 --noise 1e-3");
    let mirrored: Vec<String> = record
        .lines()
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            let reversed = cells[2].parse::<f64>().map_or(cells[2].to_string(), |rate| (-rate).to_string());
            [cells[0], cells[1], &reversed, cells[3]].join(",")
        })
        .collect();
    let (right, wrong) = (scratch.file("right.csv", &record), scratch.file("wrong.csv", mirrored.join("\n")));
    let fitted = |flags: &str| json(&format!("fit {flags}"));
    let (of_right, of_wrong) = (fitted(&right), fitted(&wrong));
    let shape = |of: &Value, name: &str, k: usize| of[name][k][k].as_f64().unwrap();
    for k in 0..3 {
        assert!((shape(&of_right, "mirror", k) - shape(&of_wrong, "shape", k)).abs() < 2e-3, "{of_wrong}");
    }
    assert!(of_right["unexplained"].as_f64().unwrap() < 1e-3, "{of_right}");
    let undone = fitted(&format!("{wrong} --axes x,-y,z"));
    assert_eq!(undone["shape"], of_right["shape"]);
    let answer = run(&format!("fit {wrong} --axes x,-y,z --format table"));
    assert!(answer.err.contains("columns x, -y, z (a mirror"), "{}", answer.err);
    assert!(
        answer.out.contains("if the axes are left-handed (--axes):\n  I1 : I2 : I3 = 0.13"),
        "{}",
        answer.out
    );
    assert!(answer.out.contains("of |dw/dt|^2 unexplained"), "{}", answer.out);
    refused(2, &format!("fit {right} --axes x,x,z"), &["--axes", "names an axis twice"]);
    // of a body that is known, one hand has its moments
    let phone = output("simulate --body phone --omega 1,9,2 --until 5 --every 0.01 --noise 0.01");
    let phone = scratch.file("phone.csv", phone);
    let answer = run(&format!("fit {phone} --body phone --axes x,-y,z"));
    assert!(answer.err.contains("check for a mirrored axis"), "{}", answer.err);
    let right = run(&format!("fit {phone} --body phone"));
    assert!(!right.err.contains("mirrored") && !right.err.contains("--body"), "{right:?}");
    // another body gives another size
    let other = run(&format!("fit {phone} --body racket"));
    assert!(other.err.contains("and those of --body 0."), "{other:?}");
}
