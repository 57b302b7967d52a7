//! What every report of `polhode fit` holds: how the files were read, units, the next record; no line wider than a terminal.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::harness::{Scratch, output, run};

const TOSSES: &str = "simulate --moments 1,2,2.6 --omega 2,9,4 --until 1 --every 0.01 --noise 0.02 --tosses 4 --scatter 1 --seed 4";

fn json(line: &str) -> Value {
    let answer = run(&format!("{line} --format json"));
    assert!(answer.out.starts_with('{'), "{line}: {}", answer.err);
    serde_json::from_str(&answer.out).unwrap()
}

fn text(line: &str) -> String {
    let text = run(&format!("{line} --format table")).out;
    assert!(!text.is_empty() && text.lines().all(|line| line.chars().count() <= 80), "{line}: {text}");
    text
}

/// Text in one line, so that words which were wrapped are found.
fn joined(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The rows with their header, and with times in ms.
fn with_header(record: &str, header: &str) -> String {
    let row = |line: &str| {
        let (t, rest) = line.split_once(',').unwrap();
        format!("{},{rest}\n", 1000.0 * t.parse::<f64>().unwrap())
    };
    format!("{header}\n{}", record.lines().skip(1).map(row).collect::<String>())
}

#[test]
fn units_and_hand_as_they_were_read_stand_in_every_report() {
    let scratch = Scratch::new("report-units");
    let record = output(TOSSES);
    let bare = scratch.file("bare.csv", &record);
    let named = scratch.file("named.csv", with_header(&record, "t (ms),wx (rad/s),wy (rad/s),wz (rad/s)"));
    let page = scratch.0.join("fit.md").display().to_string();
    let taken = "read: rates taken as rad/s and times as s (no unit in the header), 100 Hz; axes taken as right-handed";
    assert!(joined(&text(&format!("fit {bare} --report {page}"))).contains(taken));
    let page_text = fs::read_to_string(&page).unwrap();
    assert!(page_text.contains(&format!("R{}.", &taken[1..])), "{page_text}");
    let by_header = "read: rates in rad/s and times in ms (header), 100 Hz; axes taken as right-handed";
    assert!(joined(&text(&format!("fit {named}"))).contains(by_header));
    let stated = joined(&text(&format!("fit {bare} --rate-unit rad/s --axes y,-x,z")));
    let says = "read: rates in rad/s (as stated), times taken as s (no unit in the header), 100 Hz; axes y, -x, z of the columns (--axes), \
                taken as right-handed";
    assert!(stated.contains(says), "{stated}");
    // files that were read differently are named
    let both = joined(&text(&format!("fit {bare} {named}")));
    let of = |file: &str, says: &str| format!("{file}: {}", says.trim_start_matches("read: "));
    assert!(both.contains(&of(&bare, taken)) && both.contains(&of(&named, by_header)), "{both}");

    let of = &json(&format!("fit {named} --axes x,y,z"))["read_as"][0];
    assert_eq!((&of["rate_unit"], &of["rate_unit_by"]), (&Value::from("rad/s"), &Value::from("header")));
    assert_eq!((&of["time_unit"], &of["time_unit_by"]), (&Value::from("ms"), &Value::from("header")));
    assert!((of["sample_rate"].as_f64().unwrap() - 100.0).abs() < 1e-6);
    assert_eq!((&of["axes"], &of["taken_as_right_handed"]), (&Value::from("x, y, z"), &Value::from(true)));

    // attitudes have a unit of time alone, and tell the hand
    let poses = output("simulate --body phone --omega 1,9,2 --until 3 --every 0.02 --attitude-noise 0.005");
    let poses = scratch.file("poses.csv", poses);
    let attitudes = joined(&text(&format!("fit {poses}")));
    assert!(
        attitudes.contains("read: times taken as s (no unit in the header), 50 Hz attitudes read as"),
        "{attitudes}"
    );
    assert!(!attitudes.contains("right-handed"));
    assert!(json(&format!("fit {poses}"))["read_as"][0]["rate_unit"].is_null());
    // and a carrier has it too
    let joint = format!("fit --carrier {bare} --proof {named} --proof-body 0.1,0.4,0.2 --format json");
    assert!(run(&joint).err.contains("error"), "records of one body are no carrier and proof body");
}

#[test]
fn a_refusal_says_how_it_read_the_record_and_which_record_would_tell_more() {
    let scratch = Scratch::new("report-refusal");
    let spin = output("simulate --moments 1,2,2.6 --omega 0,0,2 --until 10 --every 0.01 --noise 1e-3");
    let spin = scratch.file("spin.csv", spin);
    let page = scratch.0.join("fit.md").display().to_string();
    let line = format!("fit {spin} --report {page}");
    let found = joined(&text(&line));
    let next = "record a throw that wobbles: start with rotation about at least two of the principal axes";
    assert!(found.contains(&format!("Next record: {next}")), "{found}");
    assert!(found.contains("read: rates taken as rad/s"), "{found}");
    assert!(run(&line).err.contains("Record a throw that wobbles"));
    let answer = json(&line);
    assert!(answer["next_steps"][0].as_str().unwrap().starts_with(next), "{answer}");
    assert!(answer["reason"].as_str().unwrap().contains("does not determine the tensor"));
    assert_eq!(answer["read_as"][0]["rate_unit_by"], "none");
    let page = fs::read_to_string(page).unwrap();
    for part in [
        "**✖ No inertia tensor: the record determines 2 of its 5 numbers.**",
        "## Next record",
        "Read: rates taken as",
    ] {
        assert!(page.contains(part), "{part}: {page}");
    }
}

#[test]
fn every_number_has_a_unit_and_each_segment_the_answer_without_it() {
    let scratch = Scratch::new("report-segments");
    let tosses = scratch.file("tosses.csv", output(TOSSES));
    let poses = TOSSES.replace("--noise 0.02", "--attitude-noise 0.01");
    let poses = scratch.file("poses.csv", output(&poses));
    for (file, noise) in [(&tosses, "noise: rad/s"), (&poses, "rotation vector, rad")] {
        let page = scratch.0.join("fit.html").display().to_string();
        let text = joined(&text(&format!("fit {file} --report {page}")));
        assert!(text.contains("torque weight I1/I3 I2/I3 shift 1 101 "), "{text}");
        for part in [
            noise,
            "angular acceleration by torque noise, (rad/s^2)^2 s",
            "in standard deviations",
            "I1 + I2 - I3: ",
            "of the trace",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert!(!text.contains("(-0.00000") && !text.contains("optimality"), "{text}");
        let page = fs::read_to_string(page).unwrap();
        assert!(page.contains("<th>I1/I3</th>") && !page.contains("−0.00000<"), "{page}");
        let answer = json(&format!("fit {file}"));
        for segment in answer["per_segment"].as_array().unwrap() {
            let number = |key: &str, k: usize| segment[key][k].as_f64().unwrap();
            for (k, truth) in [1.0 / 2.6, 2.0 / 2.6].into_iter().enumerate() {
                let sigma = number("sigma_ratios_without", k);
                assert!(
                    (number("ratios_without", k) - truth).abs() < 5.0 * sigma && sigma < 0.05,
                    "{segment}"
                );
                assert!(sigma > answer["sigma_ratios"][k].as_f64().unwrap(), "{segment}");
            }
            assert!(segment["shift"].as_f64().unwrap() > 0.0);
        }
        // a row of the CSV has a unit, or is a plain number
        let rows = run(&format!("fit {file} --format csv")).out;
        assert!(rows.lines().all(|row| row.split(',').count() == 4), "{rows}");
        for part in ["principal_1,", "triangle_slack,", "rms_rate,", "noise_sigma,"] {
            let row = rows.lines().find(|row| row.starts_with(part)).unwrap();
            assert!(row.ends_with(",of the trace") || row.ends_with(",rad/s"), "{row}");
        }
    }
    let single = json(&format!("fit {tosses} --window 0,1"));
    assert!(
        single["per_segment"][0]["ratios_without"].is_null() && single["per_segment"][0]["shift"].is_null()
    );
}

/// Beside a constant torque without noise stand drag with torque noise, marked by a star, and drag about three axes without it, which a first
/// order refutes: of that no gain is told, though it has drag among its values.
#[test]
fn gains_that_a_first_order_does_not_reach_are_not_told() {
    let scratch = Scratch::new("report-gains");
    let driven =
        "simulate --body phone --omega 1,9,2 --until 3 --every 0.01 --noise 0.01 --torque 1e-4,2e-4,0";
    let line = format!("fit {}", scratch.file("driven.csv", output(driven)));
    let answer = json(&line);
    let of = |torque: &str| {
        let models = answer["models"].as_array().unwrap();
        let one = models.iter().find(|one| one["torque"] == torque).unwrap();
        (one["torque_noise"].as_bool().unwrap(), one["log_likelihood"].as_f64().unwrap())
    };
    assert_eq!(answer["torque"]["model"], "constant");
    let [drag, drag3] = [of("drag"), of("drag3")];
    assert!(drag.0 && drag.1 > 0.0, "{drag:?}");
    assert!(!drag3.0 && drag3.1 < -1000.0, "{drag3:?}");
    let text = text(&line);
    let gain = |name: &str| {
        let row = text.lines().find_map(|line| line.strip_prefix(&format!("  {name} "))).unwrap();
        row.split_whitespace().next().unwrap()
    };
    assert_eq!([gain("drag*"), gain("drag3")], [format!("{:.1}", drag.1).as_str(), "-"], "{text}");
    let said = joined(&text);
    assert!(said.contains("*: with torque noise") && said.contains("gain -: below -1000"), "{said}");
}

/// The Python answer has every field of the JSON, under the same name; of the torque, which is a dict of coefficients there, under names of its own.
#[test]
fn the_python_answer_has_every_field_of_the_json() {
    let scratch = Scratch::new("report-python");
    let stubs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../polhode-python/python/polhode/_polhode.pyi");
    let stubs = fs::read_to_string(stubs).unwrap();
    let class = stubs.split("class Estimate:").nth(1).unwrap().split("\nclass ").next().unwrap();
    let has = |name: &str| class.contains(&format!("def {name}(self)"));
    let answer = json(&format!("fit {}", scratch.file("tosses.csv", output(TOSSES))));
    for key in answer.as_object().unwrap().keys() {
        assert!(has(key), "{key}");
    }
    for key in answer["torque"].as_object().unwrap().keys() {
        let name = match key.as_str() {
            "coefficients" => "torque",
            "model" => "torque_model",
            "gain" => "torque_gain",
            other => other,
        };
        assert!(has(name), "{key}");
    }
    // and of each segment, by its source
    let parts = Path::new(env!("CARGO_MANIFEST_DIR")).join("../polhode-python/src/parts.rs");
    let parts = fs::read_to_string(parts).unwrap();
    let inner = ["per_segment", "read_as"].map(|key| answer[key][0].as_object().unwrap().keys().cloned());
    for key in inner.into_iter().flatten() {
        assert!(parts.contains(&format!("\"{key}\"")), "{key}");
    }
}
