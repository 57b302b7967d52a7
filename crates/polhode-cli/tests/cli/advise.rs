//! `polhode advise`: what it answers is met, `propagate` takes it as it stands, and what it cannot answer is refused.

use serde_json::Value;

use crate::harness::{output, refused, run};

const BODY: &str = "--moments 1,2,3 --omega 0.4,1,-0.3";

#[test]
fn propagate_takes_the_advice_as_it_stands() {
    let asked =
        format!("advise {BODY} --until 50 --attitude-error 1e-5 --exclude exact --check --format json");
    // on a loaded machine a line on standard error says what takes so long
    let asked = run(&asked);
    assert_eq!(asked.code, 0, "{}", asked.err);
    let answer: Value = serde_json::from_str(&asked.out).unwrap();
    let actual = answer["actual_error"].as_f64().unwrap();
    let (predicted, factor) = (&answer["predicted_error"], &answer["predicted_error_factor"]);
    assert!(actual <= 1e-5 && actual <= predicted.as_f64().unwrap() * factor.as_f64().unwrap(), "{answer}");
    assert!(
        answer["runner_up"].is_string() && answer["predicted_cost"].as_f64().is_some_and(|cost| cost > 0.0)
    );
    let mut line = format!("propagate {BODY} --times 50 --method {}", answer["method"].as_str().unwrap());
    for (flag, key) in [("--step", "step"), ("--tolerance", "tolerance")] {
        if let Some(value) = answer[key].as_f64() {
            line += &format!(" {flag} {value:?}");
        }
    }
    let rows = output(&line);
    let last = |name: &str| {
        let at = rows.lines().next().unwrap().split(',').position(|column| column == name).unwrap();
        rows.lines().last().unwrap().split(',').nth(at).unwrap().parse::<f64>().unwrap()
    };
    assert!(last("attitude_error") <= 1e-5, "{line}: {rows}");
}

#[test]
fn the_closed_form_is_advised_where_there_is_one() {
    // on a loaded machine the advice may say on standard error what it had no time to see
    let asked = run(&format!("advise {BODY} --until 5000 --attitude-error 1e-5 --format json"));
    assert_eq!(asked.code, 0, "{}", asked.err);
    let answer: Value = serde_json::from_str(&asked.out).unwrap();
    assert_eq!((answer["method"].as_str(), &answer["step"]), (Some("exact"), &Value::Null));
}

#[test]
fn what_cannot_be_advised_is_refused_with_flag_value_and_remedy() {
    for (flags, says) in [
        ("--until 1e12 --attitude-error 1e-6", ["--attitude-error: ", "below what the start allows"]),
        ("--until 10 --attitude-error 3", ["--attitude-error: ", "ask for 1 rad or less"]),
        ("--until 10 --attitude-error 1e-6 --exclude exact --budget 1e-12", ["--budget: ", "within 1e-12 s"]),
        ("--until 10 --attitude-error 1e-6 --exclude rk5", ["--exclude: ", "rk5"]),
        ("--until -1 --attitude-error 1e-6", ["--until", "is not positive"]),
        (
            "--until 10 --attitude-error 1e-6 --energy-error 1e-6 --drag 0.1",
            ["--energy-error: ", "do not conserve its energy"],
        ),
        (
            "--until 10 --attitude-error 1e-6 --energy-error 1e-30",
            ["--energy-error: ", "1.0e-30 is below rounding"],
        ),
    ] {
        refused(&format!("advise {BODY} {flags}"), &says);
    }
    refused(
        "advise --moments 1,2,3 --omega 0,0,0 --until 1 --attitude-error 1e-6",
        &["--omega: ", "at rest"],
    );
}
