//! `polhode fit` on whole recordings: held, thrown, caught.

use serde_json::Value;

use crate::harness::{Scratch, output, run};

/// Rows of a hand that turns the body for a while from `start`, s.
fn held(start: f64, rows: usize) -> String {
    let row = |i: usize| {
        let t = start + 0.01 * i as f64;
        let w = |a: f64, b: f64, c: f64| 2.0 * libm::sin(a * t) + 1.5 * libm::cos(b * t + c);
        format!("{t:.2},{},{},{}\n", w(7.0, 13.1, 0.3), w(9.3, 5.7, 1.9), w(11.9, 6.1, 4.0))
    };
    (0..rows).map(row).collect()
}

/// Rows of a throw from `start`, s.
fn thrown(start: f64, omega: &str, seed: u32) -> String {
    let simulated = output(&format!(
        "simulate --moments 1,2,2.6 --omega {omega} --until 0.99 --every 0.01 --noise 0.005 --seed {seed}"
    ));
    let later = |row: &str| {
        let (t, rates) = row.split_once(',').unwrap();
        format!("{:.2},{rates}\n", start + t.parse::<f64>().unwrap())
    };
    simulated.lines().skip(1).map(later).collect()
}

fn recording() -> String {
    let parts = [
        "t,wx,wy,wz\n".to_string(),
        held(0.0, 150),
        thrown(1.5, "2,9,4", 1),
        held(2.5, 150),
        thrown(4.0, "8,1,-3", 2),
        held(5.0, 100),
    ];
    parts.concat()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

#[test]
fn a_recording_of_throws_is_fitted_by_its_flights() {
    let scratch = Scratch::new("flights");
    let file = scratch.file("throws.csv", recording());
    let page = scratch.0.join("fit.md");
    let answer = run(&format!("fit {file} --format json --report {}", page.display()));
    assert_eq!(answer.code, 0, "{}", answer.err);
    let says = "the record as a whole is not that of a free body: the fit uses 2 flights of free rotation, ";
    assert!(answer.err.contains(says), "{}", answer.err);
    let found: Value = serde_json::from_str(&answer.out).unwrap();
    let flights = found["flights"].as_array().unwrap();
    assert_eq!(flights.len(), 2);
    for (flight, start) in flights.iter().zip([1.5, 4.0]) {
        assert!((number(&flight[0]) - start).abs() < 0.1 && (number(&flight[1]) - start - 1.0).abs() < 0.1);
    }
    assert!(found["flight_limits"][1][0].as_str().unwrap().starts_with("torque "));
    assert!(found["warnings"].as_array().unwrap().iter().any(|w| w.as_str().unwrap().contains(says)));
    for (k, moment) in [1.0, 2.0, 2.6].into_iter().enumerate() {
        let off = number(&found["principal"][k]) - moment / 5.6;
        assert!(off.abs() < 5.0 * number(&found["sigma_principal"][k]), "I{}: {off}", k + 1);
    }
    let page = std::fs::read_to_string(page).unwrap();
    let first = format!("| 1 | {:.3} | {:.3} |", number(&flights[0][0]), number(&flights[0][1]));
    assert!(page.contains("## Flights") && page.contains(&first), "{page}");

    let text = run(&format!("fit {file} --format table")).out;
    let head = "flight   from (s)     to (s)  samples  angle (rad)  before           after";
    assert!(text.lines().any(|line| line == head), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
}

#[test]
fn windows_of_the_user_come_before_flights() {
    let scratch = Scratch::new("flights-windows");
    let file = scratch.file("throws.csv", recording());
    let answer = run(&format!("fit {file} --window 1.55,2.4 --window 4.05,4.9 --format json"));
    assert_eq!(answer.code, 0, "{}", answer.err);
    assert!(!answer.err.contains("flight"), "{}", answer.err);
    let found: Value = serde_json::from_str(&answer.out).unwrap();
    assert_eq!((&found["flights"], &found["segments"]), (&Value::Array(Vec::new()), &Value::from(2)));
}

#[test]
fn a_free_record_is_one_flight() {
    let scratch = Scratch::new("flights-free");
    let line = "simulate --moments 1,2,2.6 --omega 0.3,1,0.4 --until 20 --every 0.02 --noise 0.01";
    let file = scratch.file("free.csv", output(line));
    let found: Value = serde_json::from_str(&output(&format!("fit {file} --format json"))).unwrap();
    assert_eq!(found["flights"], serde_json::json!([[0.0, 20.0]]));
    assert_eq!(found["warnings"], serde_json::json!([]));
    let whole = output(&format!("fit {file} --window 0,20"));
    assert_eq!(output(&format!("fit {file}")), whole);
}

#[test]
fn a_recording_without_a_flight_is_refused_with_the_reason() {
    let scratch = Scratch::new("flights-none");
    let file = scratch.file("held.csv", format!("t,wx,wy,wz\n{}", held(0.0, 800)));
    let answer = run(&format!("fit {file} --format json"));
    assert_eq!(answer.code, 1, "{}", answer.err);
    for part in ["held.csv: the body rotates freely nowhere in the record", "at most 0.02", "--window t0,t1"]
    {
        assert!(answer.err.contains(part), "'{part}' is not in: {}", answer.err);
    }
    let found: Value = serde_json::from_str(&answer.out).unwrap();
    let known = serde_json::json!([]);
    assert_eq!((&found["identifiable"], &found["known"]), (&Value::Bool(false), &known));
}

#[test]
fn a_simulated_body_of_the_catalogue_spins_as_published() {
    let line = "simulate --body toutatis --until 86400 --every 43200";
    let first = output(line).lines().nth(1).unwrap().to_string();
    let published = output("propagate --body toutatis --times 0 --fields omega");
    let numbers = |row: &str| row.split(',').map(|cell| cell.parse().unwrap()).collect::<Vec<f64>>();
    for (simulated, published) in numbers(&first)[1..].iter().zip(numbers(published.lines().nth(1).unwrap()))
    {
        assert!((simulated / published - 1.0).abs() < 1e-14, "{first}");
    }
    let answer = run("simulate --moments 1,2,3 --until 1 --every 0.1");
    assert_eq!(answer.code, 2);
    assert!(answer.err.starts_with("error: --omega: missing; give --omega wx,wy,wz"), "{}", answer.err);
}
