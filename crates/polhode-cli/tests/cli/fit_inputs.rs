//! `polhode fit` with what is known besides the record: priors, wheels, torques, sensors, noise.

use serde_json::Value;

use crate::harness::{Scratch, output, refused, run};

/// A body with the trace 5.6 kg m^2.
const SIMULATE: &str = "simulate --moments 1,2,2.6 --omega 0.3,1,0.4 --every 0.02";

fn json(line: &str) -> Value {
    let answer = run(&format!("{line} --format json"));
    assert_eq!(answer.code, 0, "{line}: {}", answer.err);
    serde_json::from_str(&answer.out).unwrap()
}

fn number(answer: &Value, path: &str) -> f64 {
    let found = answer.pointer(path).and_then(Value::as_f64);
    assert!(found.is_some(), "{path} in {answer:#}");
    found.unwrap()
}

#[test]
fn a_prior_tensor_is_joined_or_contradicted() {
    let scratch = Scratch::new("fit-prior");
    let record = scratch.0.join("record.csv").display().to_string();
    output(&format!("{SIMULATE} --until 20 --noise 1e-2 --out {record}"));
    let alone = json(&format!("fit {record}"));
    let joined = json(&format!("fit {record} --prior-inertia 1.001,2.001,2.601,0.001"));
    assert!(number(&joined, "/sigma_principal/0") < 0.9 * number(&alone, "/sigma_principal/0"));
    assert!((number(&joined, "/inertia/1/1") - 2.0).abs() < 0.02, "{joined:#}");
    assert!(number(&joined, "/prior/chi2") < 20.5 && number(&joined, "/prior/dof") == 5.0);
    assert!(alone["prior"].is_null() && alone["inertia"].is_null());
    let shape = json(&format!("fit {record} --prior-shape 10,20,26,0,0,0,0.003"));
    assert!(shape["inertia"].is_null() && shape["prior"].is_object());
    let text = run(&format!("fit {record} --format table --prior-shape 10,20,26,0.003")).out;
    assert!(text.contains("record against prior tensor: chi^2"), "{text}");
    refused(
        &format!("fit {record} --prior-inertia 2.6,1,2,0.01"),
        &["the prior tensor and the record exclude each other", "of 5 degrees of freedom", "leave it out"],
    );
    refused(&format!("fit {record} --prior-inertia 1,1,3,0.01"), &["the law I1 + I2 >= I3"]);
    refused(&format!("fit {record} --prior-inertia 1,2,2.6,-0.01"), &["--prior-inertia", "must be positive"]);
    refused(&format!("fit {record} --prior-inertia 1,2,2.6"), &["3 numbers", "3 moments or 6 entries"]);
    refused(&format!("fit {record} --prior-inertia 1,2,2.6,0.01 --trace 9"), &["gives 9.0000e0"]);

    // a pure spin tells its axis alone
    let spin = scratch.0.join("spin.csv").display().to_string();
    output(&format!(
        "simulate --moments 1,2,2.6 --omega 0,0,1 --every 0.05 --until 20 --noise 1e-3 --out {spin}"
    ));
    assert_eq!(run(&format!("fit {spin}")).code, 1);
    let filled = json(&format!("fit {spin} --prior-inertia 1,2,2.6,0.01"));
    assert_eq!(filled["identifiable"], false);
    assert!(number(&filled, "/rank") == 2.0 && filled["null_directions"].as_array().unwrap().len() == 3);
    assert!((number(&filled, "/ratios/0") * 2.6 - 1.0).abs() < 0.02, "{filled:#}");
    let text = run(&format!("fit {spin} --format table --prior-inertia 1,2,2.6,0.01")).out;
    assert!(text.contains("the record alone determines 2 of the 5 numbers of the shape"), "{text}");
}

/// A wheel of 0.4 N m s about z at 40 rad/s has 0.01 kg m^2.
#[test]
fn a_wheel_is_calibrated_by_a_body_that_is_known() {
    let scratch = Scratch::new("fit-calibrate");
    let path = |name: &str| scratch.0.join(name).display().to_string();
    let (momenta, record) = (path("momenta.csv"), path("proof.csv"));
    let body = path("body.json");
    output(&format!("inertia tensor 1,2,2.6,0,0,0 --mass 30 --format json --out {body}"));
    output(&format!("{SIMULATE} --until 20 --noise 1e-3 --wheel-momentum 0,0,0.4 --out {momenta}"));
    let text = std::fs::read_to_string(&momenta).unwrap();
    let rows = text.lines().skip(1).map(|row| {
        let cells: Vec<&str> = row.split(',').take(4).collect();
        format!("{},40,21\n", cells.join(","))
    });
    let rows = rows.collect::<String>();
    std::fs::write(&record, format!("t,wx,wy,wz,wheel (rad/s),temperature\n{rows}")).unwrap();
    let line = format!("fit {record} --calibrate-wheel 0,0,1 --body {body}");
    let answer = json(&line);
    let (value, sigma) = (number(&answer, "/wheel_inertia"), number(&answer, "/sigma"));
    assert!((value - 0.01).abs() < 5.0 * sigma && sigma < 2e-4, "{value} +- {sigma}");
    assert_eq!(answer["unused_columns"], serde_json::json!(["temperature"]));
    assert_eq!(answer["warnings"], serde_json::json!([]));
    let told = run(&format!("{line} --format table"));
    assert!(told.out.starts_with("wheel inertia: (") && told.out.contains(" kg m^2 (95 %)"), "{}", told.out);
    assert_eq!(told.err, "warning: columns not used: temperature\n");
    assert!(run(&format!("{line} --format csv")).out.contains("\nwheel_inertia,0.0"));

    let reversed = run(&format!("fit {record} --calibrate-wheel 0,0,-1 --body {body}"));
    assert_eq!(reversed.code, 2, "{reversed:?}");
    assert!(reversed.err.contains("the moment of inertia of the wheel would be -"), "{}", reversed.err);
    assert!(reversed.err.contains("reverse the axis of the wheel"), "{}", reversed.err);
    refused(&format!("fit {record} --calibrate-wheel 0,0,1"), &["--body"]);
    refused(&format!("fit {record} --calibrate-wheel 0,0,0 --body {body}"), &["no direction"]);
    refused(
        &format!("fit {momenta} --calibrate-wheel 0,0,1 --body {body}"),
        &["momenta.csv: no column for the speed of the wheel", "name the column wheel"],
    );
    // one file with a wheel, one without
    let bare = path("bare.csv");
    output(&format!("{SIMULATE} --until 20 --noise 1e-3 --out {bare}"));
    refused(
        &format!("fit {momenta} {bare}"),
        &["segment 1", "momenta.csv", "has wheel momenta and segment 2", "bare.csv", "has none"],
    );
}

/// Samples that two files have in common are counted, whole or in part, of rates and of attitudes, and where the second counts its times from
/// its own first row; windows without them, and the same motion measured twice, are not.
#[test]
fn readings_under_two_names_are_said_to_count_twice() {
    let scratch = Scratch::new("fit-twice");
    for (noise, from) in [("--noise 1e-3", "rates"), ("--attitude-noise 1e-3", "attitudes")] {
        let text = output(&format!("{SIMULATE} --until 20 {noise}"));
        let (one, copy) = (scratch.file("one.csv", &text), scratch.file("copy.csv", &text));
        let count = text.lines().count() - 1;
        let told = |line: &str| run(&format!("fit {line} --from {from}")).err;
        let found = told(&format!("{one} {copy}"));
        assert!(
            found.contains(&format!("copy.csv: {count} of its {count} samples are also in a file")),
            "{found}"
        );
        let (head, rows) = text.split_once('\n').unwrap();
        let rows: Vec<(f64, &str)> = rows
            .lines()
            .map(|row| row.split_once(',').unwrap())
            .map(|(t, row)| (t.parse().unwrap(), row))
            .collect();
        let part = |rows: &[(f64, &str)], start: f64| {
            rows.iter().fold(head.to_string(), |text, (t, row)| format!("{text}\n{},{row}", t - start))
        };
        let (until, since) = (3 * count / 4, count / 2);
        let first = scratch.file("first.csv", part(&rows[..until], 0.0));
        for start in [0.0, rows[since].0] {
            let second = scratch.file("second.csv", part(&rows[since..], start));
            let found = told(&format!("{first} {second}"));
            let says = format!("second.csv: {} of its {} samples are", until - since, count - since);
            assert!(found.contains(&says), "{start}: {found}");
            let end = rows[since].0 - 1e-3;
            let found = told(&format!("{first} {second} --window 1:0,{end} --window 2:0,20"));
            assert!(!found.contains("count twice"), "{start}: {found}");
        }
    }
    // one motion twice in steps that hide most of the noise
    let coarse =
        |seed: u8| output(&format!("{SIMULATE} --until 20 --noise 1e-3 --quantum 0.01 --seed {seed}"));
    let (one, two) = (scratch.file("one.csv", coarse(1)), scratch.file("two.csv", coarse(2)));
    let found = run(&format!("fit {one} {two}")).err;
    assert!(!found.contains("count twice"), "{found}");
}

#[test]
fn columns_that_are_not_used_are_named() {
    let scratch = Scratch::new("fit-unused");
    let text = output(&format!("{SIMULATE} --until 20 --noise 1e-3"));
    let rows = text.lines().skip(1).map(|row| format!("{row},20.5,a\n")).collect::<String>();
    let record = scratch.file("record.csv", format!("t,wx,wy,wz,temperature,mark\n{rows}"));
    let page = scratch.0.join("fit.html").display().to_string();
    let told = run(&format!("fit {record} --format table --report {page}"));
    assert!(told.out.contains("\ncolumns not used: temperature, mark\n"), "{}", told.out);
    assert!(told.err.contains("warning: columns not used: temperature, mark"), "{}", told.err);
    assert!(std::fs::read_to_string(page).unwrap().contains("Columns not used: temperature, mark."));
    let answer = json(&format!("fit {record}"));
    assert_eq!(answer["unused_columns"], serde_json::json!(["temperature", "mark"]));
}

/// Two tosses under one drag, written as steps of 0.01 rad/s.
#[test]
fn torques_and_steps_of_readings_are_reported() {
    let scratch = Scratch::new("fit-models");
    let path = |name: &str| scratch.0.join(name).display().to_string();
    let (one, two) = (path("one.csv"), path("two.csv"));
    let line = format!("{SIMULATE} --until 20 --noise 1e-3 --quantum 0.01 --relative-drag 0.1");
    output(&format!("{line} --out {one}"));
    output(&format!("{line} --seed 5 --out {two}"));
    let fit = format!("fit {one} {two} --torque drag");
    let answer = json(&fit);
    let drag = |of: &str| number(&answer, &format!("/torque/coefficients/drag/{of}"));
    assert!((drag("value") - 0.1).abs() < 4.0 * drag("sigma"), "{}", answer["torque"]);
    assert!((number(&answer, "/quanta/0") - 0.01).abs() < 1e-9, "{}", answer["quanta"]);
    let page = path("fit.html");
    let told = run(&format!("{fit} --format table --report {page}"));
    assert!(told.out.contains("drag") && told.out.contains("\nsegment  samples"), "{}", told.out);
    assert!(told.out.contains("steps of the readings: 1.000e-2"), "{}", told.out);
    assert!(std::fs::read_to_string(page).unwrap().contains("drag"));
    assert!(run(&format!("{fit} --format csv")).out.contains("\ndrag,0."));

    let quadratic = json(&format!("fit {one} --torque quadratic --quantum 0.01"));
    assert!(number(&quadratic, "/torque/coefficients/quadratic_drag/value") > 0.0);
    refused(&format!("fit {one} --quantum 0"), &["--quantum", "not positive"]);
}

#[test]
fn residuals_are_a_png_by_their_ending() {
    let scratch = Scratch::new("fit-png");
    let path = |name: &str| scratch.0.join(name).display().to_string();
    let (record, picture) = (path("record.csv"), path("residuals.png"));
    output(&format!("{SIMULATE} --until 20 --noise 1e-3 --out {record}"));
    output(&format!("fit {record} --residuals {picture} --out {}", path("fit.json")));
    let bytes = std::fs::read(picture).unwrap();
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
    refused(&format!("fit {record} --residuals {}", path("residuals.pdf")), &[".svg, .png or .csv"]);
}
