//! `polhode fit --carrier`: carrier, proof body, object and wheel as one fit.
//!
//! Carrier 6 kg, object 2 kg at (-0.04, 0.04, 0.02) m, proof body 2 kg at (0.05, -0.02, 0.03) m from it: the parallel-axis terms have
//! 6 × 2/8 = 1.5 kg on the carrier and 8 × 2/10 = 1.6 kg, at (0.06, -0.03, 0.025) m, on carrier and object.

use serde_json::Value;

use crate::harness::{Scratch, output, refused, run};

const CARRIER: &str = "0.03,0.051,0.063,0.003,-0.006,0.002";
const WITH_PROOF: &str = "0.03495,0.0671,0.07935,0.0045,-0.00825,0.0029";
const WITH_OBJECT: &str = "0.037,0.06,0.0768,0.0054,-0.0048,0.0018";
const WITH_BOTH: &str = "0.04244,0.07776,0.096,0.00828,-0.0072,0.003";
const PROOF: &str = "--proof-body 0.003,0.011,0.012 --proof-at 0.05,-0.02,0.03,2 --carrier-mass 6";

/// Files of the four tumbles, by turns about different axes.
fn tumbles(scratch: &Scratch, more: &str) -> [String; 4] {
    let bodies = [("carrier", CARRIER), ("proof", WITH_PROOF), ("object", WITH_OBJECT), ("both", WITH_BOTH)];
    let omegas = ["1,2.5,1.5", "2,1,2", "-1,2,2", "2,2,-1"];
    core::array::from_fn(|k| {
        let file = scratch.0.join(format!("{}.csv", bodies[k].0)).display().to_string();
        let (tensor, omega) = (bodies[k].1, omegas[k]);
        output(&format!(
            "simulate --inertia {tensor} --omega {omega} --until 8 --every 0.02 --noise 1e-3 --seed {k} {more} --out {file}"
        ));
        file
    })
}

fn json(line: &str) -> Value {
    let answer = run(&format!("{line} --format json"));
    assert_eq!(answer.code, 0, "{line}: {}", answer.err);
    serde_json::from_str(&answer.out).unwrap()
}

/// Every entry within 4.5 of its standard deviations, which are small.
fn agrees(body: &Value, truth: &str) {
    let truth: Vec<f64> = truth.split(',').map(|v| v.parse().unwrap()).collect();
    for (k, (i, j)) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].into_iter().enumerate() {
        let value = body["inertia"][i][j].as_f64().unwrap();
        let sigma = body["inertia_covariance"][k][k].as_f64().unwrap().sqrt();
        assert!((value - truth[k]).abs() < 4.5 * sigma, "{i}{j}: {value} +- {sigma}, not {}", truth[k]);
        assert!(sigma < 0.02 * truth[2], "{sigma}");
    }
}

#[test]
fn carrier_and_object_are_absolute_by_a_proof_body() {
    let scratch = Scratch::new("fit-carrier");
    let [carrier, proof, object, both] = tumbles(&scratch, "");
    let alone = json(&format!("fit --carrier {carrier} --proof {proof} {PROOF}"));
    agrees(&alone["carrier"], CARRIER);
    assert!(alone["object"].is_null() && alone["wheel"].is_null());
    assert_eq!(alone["dof"], 4);
    assert_eq!(alone["sizes"][0]["source"], "proof body");

    let line = format!(
        "fit {object} --carrier {carrier} --proof {proof} --object-proof {both} {PROOF} --object-at -0.04,0.04,0.02,2"
    );
    let found = json(&line);
    agrees(&found["carrier"], CARRIER);
    agrees(&found["object"], "0.007,0.009,0.0138,0.0024,0.0012,-0.0002");
    agrees(&found["object_itself"], "0.004,0.006,0.009,0,0,0.001");
    assert_eq!(found["records"].as_array().unwrap().len(), 4);
    assert!(found["chi2"].as_f64().unwrap() < 34.0, "{}", found["chi2"]); // 1e-4 of eight degrees

    // the bodies of the answer are bodies of every command
    let file = scratch.file("joint.json", found.to_string());
    for of in ["carrier", "object_itself"] {
        let entry = |(i, k): (usize, usize)| found[of]["inertia"][i][k].to_string();
        let entries = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(entry).join(",");
        // warnings of the fit are told again
        let motion = |body: &str| {
            let answer = run(&format!("motion {body} --omega 1,2,3 --format json"));
            assert_eq!(answer.code, 0, "{answer:?}");
            answer.out
        };
        assert_eq!(motion(&format!("--body {file}:{of}")), motion(&format!("--inertia={entries}")));
    }
    refused(
        &format!("motion --body {file} --omega 1,2,3"),
        &["has 3 bodies: carrier, object, object_itself"],
    );

    let text = run(&format!("{line} --format table")).out;
    assert!(text.starts_with("carrier: principal moments (kg m^2, 95 %)\n  I1  ("), "{text}");
    for words in ["object about its centre of mass", "size by the proof body", "of 8 degrees of freedom"] {
        assert!(text.contains(words), "{text}");
    }
    assert!(text.lines().all(|line| line.len() <= 80), "{text}");
    let page = scratch.0.join("joint.html").display().to_string();
    output(&format!("{line} --report {page}"));
    let page = std::fs::read_to_string(page).unwrap();
    for words in ["Object about its centre of mass: moments (", "agreement of the records: chi^2", "Records"]
    {
        assert!(page.contains(words), "{words}");
    }
    let rows = run(&format!("{line} --format csv")).out;
    assert!(rows.contains("\ncarrier_xx,0.0") && rows.contains("\nobject_itself_principal_1,0.0"), "{rows}");

    // a window of the second file, counted through: a tenth of the record is less sure
    let cut = json(&format!("fit --carrier {carrier} --proof {proof} {PROOF} --window 1:0,8 --window 2:0,3"));
    let sigma = |answer: &Value| answer["carrier"]["inertia_covariance"][0][0].as_f64().unwrap().sqrt();
    assert!(sigma(&cut) > sigma(&alone), "{} {}", sigma(&cut), sigma(&alone));
}

/// A wheel of 1e-3 kg m^2 about z at 40 rad/s has 0.04 N m s.
#[test]
fn a_wheel_is_found_with_carrier_and_object() {
    let scratch = Scratch::new("fit-carrier-wheel");
    let momenta = tumbles(&scratch, "--wheel-momentum 0,0,0.04");
    let known = json(&format!("fit {} --carrier {}", momenta[2], momenta[0]));
    agrees(&known["object"], "0.007,0.009,0.0138,0.0024,0.0012,-0.0002");
    assert_eq!(known["sizes"][0]["source"], "wheels or torques");
    let speeds = momenta.map(|file| {
        let text = std::fs::read_to_string(&file).unwrap();
        let rows = text.lines().skip(1).map(|row| {
            let cells: Vec<&str> = row.split(',').take(4).collect();
            format!("{},40\n", cells.join(","))
        });
        let spun = file.replace(".csv", "-wheel.csv");
        std::fs::write(&spun, format!("t,wx,wy,wz,wheel (rad/s)\n{}", rows.collect::<String>())).unwrap();
        spun
    });
    let [carrier, proof, object, _] = speeds;
    let line = format!("fit {object} --carrier {carrier} --proof {proof} {PROOF}");
    let found = json(&format!("{line} --calibrate-wheel 0,0,1"));
    agrees(&found["carrier"], CARRIER);
    agrees(&found["object"], "0.007,0.009,0.0138,0.0024,0.0012,-0.0002");
    let wheel = |of: &str| found["wheel"][of].as_f64().unwrap();
    assert!((wheel("inertia") - 1e-3).abs() < 4.5 * wheel("sigma"), "{}", found["wheel"]);
    assert!(wheel("sigma") < 1e-4, "{}", found["wheel"]);
    let text = run(&format!("{line} --calibrate-wheel 0,0,1 --format table")).out;
    assert!(text.contains("\nwheel inertia: ("), "{text}");
    agrees(&json(&format!("{line} --wheel 0,0,1,1e-3"))["carrier"], CARRIER);
}

#[test]
fn what_a_joint_fit_cannot_use_is_refused() {
    let scratch = Scratch::new("fit-carrier-refused");
    let [carrier, proof, object, both] = tumbles(&scratch, "");
    let line = format!("fit --carrier {carrier} --proof {proof}");
    refused(&format!("fit --carrier {carrier}"), &["nothing gives the size of the carrier", "--proof"]);
    refused(&line, &["--proof-body"]);
    refused(&format!("{line} --proof-body 1,2,2.6 --proof-at 0,0,0.1,2"), &["--carrier-mass"]);
    refused(
        &format!("{line} --proof-body 1,2,2.6 --proof-at 0,0,0.1 --carrier-mass 2"),
        &["3 given, 4 needed"],
    );
    refused(
        &format!("{line} --proof-body 1,2,2.6 --proof-at 0,0,0.1,0 --carrier-mass 2"),
        &["--proof-at", "the mass is not positive"],
    );
    refused(
        &format!("{line} {PROOF} --object-at -0.04,0.04,0.02,2"),
        &["--object-at: no record has the object", "DATA.csv"],
    );
    refused(
        &format!("{line} --proof-body 1,2,2.6 --carrier-mass 6"),
        &["--carrier-mass: '6'", "--proof-at or --object-at"],
    );
    refused(&format!("{line} {PROOF} --product jpl"), &["--product"]);
    refused(&format!("{line} --proof-body 1,1,3"), &["--proof-body", "violate I1 + I2 >= I3"]);
    refused(&format!("{line} --proof-body 1,2"), &["--proof-body", "2 numbers"]);
    refused(&format!("{line} --proof-body nosuch"), &["--proof-body", "nosuch"]);
    refused(&format!("{line} --proof-body 1,2,2.6 --trace 1"), &["--trace"]);
    refused(&format!("fit {carrier} --carrier {carrier} --proof {proof} {PROOF}"), &["given twice"]);
    refused(
        &format!("fit {object} --carrier {carrier} --proof {proof} --object-proof {both} {PROOF}"),
        &["--object-proof", "--object-at"],
    );
    // the same under another name
    let copy = scratch.file("copy.csv", std::fs::read_to_string(&carrier).unwrap());
    let twice = run(&format!("fit --carrier {carrier} --proof {copy} {PROOF}"));
    let says = "the record of carrier and proof body has samples of that of carrier";
    assert!(twice.code == 2 && twice.err.contains(says), "{twice:?}");
    // answers that the records do not hold
    let same = scratch.0.join("same.csv").display().to_string();
    output(&format!(
        "simulate --inertia {CARRIER} --omega 2,1,2 --until 8 --every 0.02 --noise 1e-3 --seed 9 --out {same}"
    ));
    let light = run(&format!("fit --carrier {carrier} --proof {same} --proof-body 3e-7,11e-7,12e-7"));
    assert_eq!(light.code, 1, "{}", light.err);
    for words in ["the proof body is too light", "times as heavy", "kg m^2"] {
        assert!(light.err.contains(words), "{}", light.err);
    }
    let open = run(&format!("fit {object} --carrier {carrier} --proof {proof} {PROOF}"));
    assert_eq!(open.code, 1);
    assert!(
        open.err.contains("five of the six numbers") && open.err.contains("--object-proof"),
        "{}",
        open.err
    );
    for mistaken in
        [format!("fit --carrier {proof} --proof {carrier} {PROOF}"), format!("{line} {PROOF} --axes x,-y,z")]
    {
        let other = run(&mistaken);
        assert_eq!(other.code, 1, "{mistaken}: {}", other.err);
        assert!(
            other.err.contains("the shape changes in the direction opposite"),
            "{mistaken}: {}",
            other.err
        );
    }
    // a mistaken proof body, or a wrong sign in its place
    for mistaken in [
        "0.012,0.011,0.003 --proof-at 0.05,-0.02,0.03,2 --carrier-mass 6",
        "0.003,0.011,0.012 --proof-at 0.05,0.02,0.03,2 --carrier-mass 6",
    ] {
        let wrong = run(&format!("{line} --proof-body {mistaken}"));
        assert_eq!(wrong.code, 1, "{}", wrong.err);
        assert!(wrong.err.contains("do not determine the size: chi squared is"), "{}", wrong.err);
    }
}
