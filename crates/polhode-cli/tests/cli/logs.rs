//! Logs with columns that have to be named, rows that cannot be read, and units that are numbers.

use crate::harness::{Scratch, output, polhode, refused, run, words};

/// A simulated record with its header and a row replaced.
fn log(scratch: &Scratch, header: &str, change: impl Fn(usize, &str) -> String) -> String {
    let simulated = "simulate --moments 1,2,2.6 --omega 0.3,1,0.4 --until 20 --every 0.01 --noise 1e-3";
    let text = output(simulated);
    let rows = text.lines().enumerate().skip(1).map(|(k, row)| change(k, row) + "\n");
    scratch.file("log.csv", format!("{header}\n{}", rows.collect::<String>()))
}

fn shape(line: &str) -> (String, String) {
    let answer = run(line);
    assert_eq!(answer.code, 0, "{line}: {}", answer.err);
    let found: serde_json::Value = serde_json::from_str(&answer.out).unwrap();
    (found["shape"].to_string(), answer.err)
}

#[test]
fn columns_that_are_named_are_those_of_the_header() {
    let scratch = Scratch::new("log-columns");
    let plain = log(&scratch, "t,wx,wy,wz", |_, row| row.into());
    let (expected, _) = shape(&format!("fit {plain} --format json"));
    let foreign = log(&scratch, "A,B,C,D", |_, row| row.into());
    refused(
        &format!("fit {foreign}"),
        &["log.csv, line 1: no column for time", "'A', 'B', 'C', 'D'", "--columns t=NAME,wx=NAME"],
    );
    for columns in ["t=A,x=B,y=C,z=D", "z=4,y=3,x=2,t=1"] {
        assert_eq!(
            shape(&format!("fit {foreign} --columns {columns} --format json")).0,
            expected,
            "{columns}"
        );
    }
    refused(&format!("fit {foreign} --columns t=A,x=B,y=C,z=E"), &["no column for 'E'", "'D'"]);
    refused(&format!("fit {foreign} --columns t=A,x=B,y=C"), &["--columns", "wz=NAME is missing"]);
    refused(&format!("fit {foreign} --columns A,B,C,D"), &["--columns", "'A' has no known key"]);
    // counts of ten milliseconds
    let counted = log(&scratch, "A,B,C,D", |k, row| format!("{},{}", k - 1, row.split_once(',').unwrap().1));
    let line = format!("fit {counted} --columns t=A,x=B,y=C,z=D --time-unit 0.01 --format json");
    assert_eq!(shape(&line).0, expected);
    refused(&format!("fit {plain} --time-unit fortnight"), &["--time-unit", "or a number of seconds"]);
}

#[test]
fn a_bad_row_is_left_out_and_told() {
    let scratch = Scratch::new("log-rows");
    let spoiled = log(&scratch, "t,wx,wy,wz", |k, row| if k == 700 { "6.99,,,".into() } else { row.into() });
    let answer = polhode(&words(&format!("fit {spoiled} --format json")), &scratch.0);
    assert_eq!(answer.code, 0, "{}", answer.err);
    for part in ["warning: 1 row is left out beside 2000", "log.csv, line 701, column 2 (wx)"] {
        assert!(answer.err.contains(part), "{}", answer.err);
    }
    refused(&format!("fit {spoiled} --skip-rows 0"), &["line 701, column 2 (wx)", "--skip-rows FRACTION"]);
    refused(&format!("fit {spoiled} --skip-rows 1"), &["--skip-rows", "from 0 to below 1"]);
}
