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
    answer.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path} in {answer:#}"))
}

#[test]
fn a_prior_tensor_is_joined_or_contradicted() {
    let scratch = Scratch::new("fit-prior");
    let record = scratch.0.join("record.csv").display().to_string();
    output(&format!("{SIMULATE} --until 20 --noise 1e-2 --out {record}"));
    let alone = json(&format!("fit {record}"));
    let joined = json(&format!("fit {record} --prior-inertia 1.001,2.001,2.601,0.003"));
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
}
