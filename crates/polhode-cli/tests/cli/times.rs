//! Output times from lists, files and pipes; units, dates and the columns of the rows.

use std::io::Write;
use std::process::{Command, Stdio};

use crate::harness::{DYADIC, Scratch, output, refused, run, with, words};
use crate::propagate::column;

#[test]
fn times_of_a_file_a_pipe_and_a_list_give_the_same_rows() {
    let scratch = Scratch::new("times");
    let listed = output(&with("--times 0,0.1,-2.5,1e6"));
    let lines = scratch.file("epochs.txt", "0\n0.1\n\n-2.5\n1e6\n");
    assert_eq!(output(&with(&format!("--times {lines}"))), listed);
    let rows = scratch.file("epochs.csv", "# of the night\nmag,t\n9,0\n8,0.1\n7,-2.5\n6,1e6\n");
    assert_eq!(output(&with(&format!("--times {rows}"))), listed);
    assert_eq!(output(&with(&format!("--times {rows} --times-column 2"))), listed);
    let mut child = Command::new(env!("CARGO_BIN_EXE_polhode"))
        .args(words(&with("--times -")))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(b"t\n0\n0.1\n-2.5\n1e6\n").unwrap();
    assert_eq!(String::from_utf8(child.wait_with_output().unwrap().stdout).unwrap(), listed);
    // a stepping method reads the file before its first step
    let steps = scratch.file("steps.txt", "0.5\n1\n1\n8\n");
    let stepped = output(&with(&format!("--times {steps} --method rk4 --step 0.125")));
    assert_eq!(stepped, output(&with("--times 0.5,1,1,8 --method rk4 --step 0.125")));
}

#[test]
fn times_have_units_and_dates() {
    assert_eq!(output(&with("--times 1min,1.5h,1d")), output(&with("--times 60,5400,86400")));
    assert_eq!(output(&with("--until 1h --every 20min")), output(&with("--until 3600 --every 1200")));
    let dated = "--epoch 1992-11-09T12:00 --times 2448936,1992-11-09T18:00:00,90min,2448937.25";
    assert_eq!(output(&with(dated)), output(&with("--times 0,21600,5400,108000")));
    let scaled = "--epoch 1992-11-09T12:00Z --times 2448936UTC,1992-11-09T18:00:00Z,90min,2448937.25UTC";
    assert_eq!(output(&with(scaled)), output(&with("--times 0,21600,5400,108000")));
    // the leap second of 2016, and 69.184 s between both scales
    let utc = "--time-scale utc --epoch 2016-12-31 --times 2017-01-01,2017-01-01T00:01:09.184TT";
    assert_eq!(output(&with(utc)), output(&with("--times 86401,86401")));
    refused(
        &with("--epoch 1992-11-09T12:00 --times 1992-11-09T18:00:00Z"),
        &["--times: '1992-11-09T18:00:00Z': one date is in UTC", "differ by a minute"],
    );
    refused(&with("--epoch 2017-01-01 --times 1h --time-scale GMT"), &["unknown time scale 'GMT'"]);
    let span = "--epoch 2448936 --until 1992-11-10T12:00 --every 12h --start-time 2448936";
    assert_eq!(output(&with(span)), output(&with("--until 86400 --every 43200")));
    let rk4 = "--until 500ms --every 250ms --method rk4 --step 125ms";
    assert_eq!(output(&with(rk4)), output(&with("--until 0.5 --every 0.25 --method rk4 --step 0.125")));
}

#[test]
fn times_that_cannot_be_used_are_refused_by_file_line_and_column() {
    let scratch = Scratch::new("times-refused");
    let of = |name: &str, text: &str| format!("--times {}", scratch.file(name, text));
    let other = "9007199254740993";
    refused(
        &with(&format!("--times 1,{other}")),
        &["--times: item 2", "too many digits for a double", "9.007199254740992e15"],
    );
    refused(
        &with(&format!("--until {other} --every 1d")),
        &["--until: '9007199254740993'", "too many digits for a double"],
    );
    refused(&with(&of("h", &format!("{other}\n"))), &["h, line 1", "too many digits for a double"]);
    refused(
        &with(&of("i", &format!("t (ns)\n{other}\n"))),
        &["i, line 2", "too many digits for a double", "a later time"],
    );
    refused(&with(&of("a", "1\n2\nx\n")), &["a, line 3, column 1 (t): 'x': is not a number"]);
    refused(&with(&of("b", "t,mag\n1,\n,2\n")), &["b, line 3, column 1 (t): a number is missing"]);
    refused(
        &with(&of("c", "when,mag\n1,2\n")),
        &["c, line 1: no column for time", "'when', 'mag'", "--times-column"],
    );
    refused(&with(&of("d", "")), &["d: no rows", "one time a line"]);
    refused(&with(&of("e", "1\n1e300\n")), &["--times: 1e300", "with an answer"]);
    let stepped = of("f", "0.5\n0.3\n");
    refused(&with(&format!("{stepped} --method rk4 --step 0.125")), &["--times: 0.3 comes after 0.5"]);
    refused(
        &with("--times absent.txt"),
        &["--times", "'absent.txt' is not a number", "no file of that name"],
    );
    refused(&with("--times 2025-11-22"), &["--times: '2025-11-22' is a date", "--epoch"]);
    refused(
        &with("--times 1 --epoch tomorrow"),
        &["--epoch", "'tomorrow' is not a date", "2025-11-22T10:20:30"],
    );
    refused(&with("--times 3fortnights"), &["unknown unit of time 'fortnights'", "min, h or d"]);
    refused(&with("--until 1e999 --every 1"), &["--until: '1e999'", "finite"]);
    refused(&with("--until 1 --every 1 --times-column 2"), &["--times-column", "--times"]);
}

#[test]
fn fields_are_the_columns_that_are_asked_for() {
    let all = output(&with("--times 0,2"));
    let some = output(&with("--times 0,2 --fields t,q,omega"));
    for (whole, part) in all.lines().zip(some.lines()) {
        assert_eq!(whole.split(',').take(8).collect::<Vec<_>>().join(","), part);
    }
    assert!(output(&with("--times 1 --fields q_w,t")).starts_with("q_w,t\n"));
    let stepped = output(&with("--times 1 --method rk4 --step 0.5 --fields t,errors"));
    assert!(stepped.starts_with(
        "t,energy_error,momentum_error,momentum_vector_error,momentum_z_error,attitude_error\n"
    ));
    refused(&with("--times 1 --fields t,omga"), &["--fields: 'omga': no such column", "'omega'"]);
    refused(&with("--times 1 --fields t,q,q_x"), &["--fields: 'q_x'", "twice"]);
    refused(&with("--times 1 --fields jacobi_error"), &["--fields: 'jacobi_error'", "no such quantity"]);
}

#[test]
fn euler_angles_are_columns_and_a_start() {
    // a turn by 0.3 about z, 0.5 about x, -0.2 about z
    let start = "propagate --moments 1,2,3 --omega 0.4,1,-0.3 --angles 0.3,0.5,-0.2 --euler zxz --times 0";
    let text = output(start);
    let (head, row) = text.trim_end().split_once('\n').unwrap();
    assert!(head.ends_with(",phi,theta,psi"), "{head}");
    let cells: Vec<f64> = row.rsplit(',').take(3).map(|cell| cell.parse().unwrap()).collect();
    for (found, expected) in cells.iter().rev().zip([0.3, 0.5, -0.2]) {
        assert!((found - expected).abs() < 1e-15, "{row}");
    }
    let degrees = start.replace("0.3,0.5,-0.2", "17.188733853924695,28.64788975654116,-11.459155902616466");
    let turned = output(&format!("{degrees} --angle-unit deg"));
    let last = |text: &str| text.rsplit(',').next().unwrap().trim().parse::<f64>().unwrap();
    assert!((last(&turned) + 0.2).abs() < 1e-15, "{turned}");
    // a unit that was forgotten
    let silent = run(&degrees);
    let says =
        "17.188733853924695 is taken as rad and exceeds a whole turn; for degrees give --angle-unit deg";
    assert!(silent.code == 0 && silent.err.contains(says), "{silent:?}");
    refused(&with("--times 0 --euler zxx"), &["--euler", "zxx", "such as zxz"]);
    refused(&with("--times 0 --euler zyx --fields t,q"), &["--euler: 'zyx'", "none are given"]);
    refused(&with("--times 0 --angles 1,2,3 --attitude 1,0,0,0"), &["--angles", "--attitude"]);
    refused(&with("--times 0 --angle-unit gon"), &["--angle-unit", "'gon'", "rad or deg"]);
}

#[test]
fn a_start_is_a_rate_in_any_unit_or_a_momentum() {
    let body = "propagate --moments 2,4,5 --times 0,1 --attitude 0.5,0.5,0.5,0.5";
    let plain = output(&format!("{body} --omega 1,0.5,-0.25"));
    assert_eq!(output(&format!("{body} --momentum-body 2,2,-1.25")), plain);
    // the attitude takes x to y, y to z, z to x
    assert_eq!(output(&format!("{body} --momentum-space=-1.25,2,2")), plain);
    assert_eq!(
        output(
            &format!("{body} --rotation 0,0,1,1,0,0,0,1,0 --omega 1,0.5,-0.25")
                .replace("--attitude 0.5,0.5,0.5,0.5 ", "")
        ),
        plain
    );
    let column = |text: &str, k: usize| {
        text.lines().nth(1).unwrap().split(',').nth(k).unwrap().parse::<f64>().unwrap()
    };
    for (unit, factor) in [
        ("deg/s", 0.017_453_292_519_943_295),
        ("rpm", 0.104_719_755_119_659_77),
        ("rev/d", 7.272_205_216_643_04e-5),
    ] {
        let found = column(&output(&format!("{body} --omega 1,2,3 --rate-unit {unit}")), 5);
        assert!((found / factor - 1.0).abs() < 1e-15, "{unit}: {found:e}");
    }
    refused(&format!("{body} --omega 1,2,3 --rate-unit knots"), &["--rate-unit", "'knots'", "deg/s"]);
    refused(&format!("{body} --omega 1,2,3 --momentum-body 1,2,3"), &["--momentum-body", "--omega"]);
    let moments = "propagate --moments 2,4,5 --times 0 --omega 1,0,0 --rotation";
    refused(&format!("{moments} 1,0,0,0,1,0,0,0,2"), &["--rotation", "not orthonormal", "3.0e0"]);
    refused(&format!("{moments} 1,0,0,0,1,0,0,0,-1"), &["--rotation", "reflection"]);
    let rounded = run(&format!("{moments} 0.8661,-0.5,0,0.5,0.8661,0,0,0,1"));
    assert!(
        rounded.code == 0 && rounded.err.contains("--rotation: R^T R differs from 1 by 1.3e-4"),
        "{}",
        rounded.err
    );
}

#[test]
fn the_start_of_the_catalogue_is_that_of_the_body() {
    let own = output("propagate --body dyadic --times 0");
    assert!(own.lines().nth(1).unwrap().starts_with("0.0,1.0,0.0,0.0,0.0,2.8,0.5,-0.875,"), "{own}");
    // as it was typed, whatever the moments
    let typed = output("propagate --moments 0.7,0.9,1.1 --omega 0.05,0.1,0.3 --times 0");
    assert!(typed.lines().nth(1).unwrap().starts_with("0.0,1.0,0.0,0.0,0.0,0.05,0.1,0.3,"), "{typed}");
    let top = output("propagate --body gyroscope --times 0 --fields q,omega");
    assert!(top.lines().nth(1).unwrap().starts_with("0.96592582628906"), "{top}");
    assert!(DYADIC.contains("--omega"));
}

#[test]
fn the_attitude_of_the_catalogue_stays_unless_another_is_given() {
    let tilted = |flags: &str| {
        let answer = run(&format!("propagate --body gyroscope {flags} --times 0 --fields q"));
        (answer.out.lines().nth(1).unwrap().starts_with("0.96592582628906"), answer.notes)
    };
    for flags in ["", "--omega 0,0,60", "--momentum-body 0,0,0.003"] {
        assert_eq!(
            tilted(flags),
            (true, "note: gyroscope: attitude in the frame gravity along -z\n".into()),
            "{flags}"
        );
    }
    assert_eq!(tilted("--omega 0,0,60 --attitude 1,0,0,0"), (false, String::new()));
    let unknown = run("propagate --body racket --times 0");
    assert_eq!(unknown.notes, "note: racket: attitude unknown, taken as the identity\n");
    // published: doi of arXiv:1504.02024
    let toutatis = run("motion --body toutatis");
    for (name, expected) in [("lambda", 180.2_f64), ("beta", -54.75)] {
        let found = column(&toutatis.out, name)[0].to_degrees();
        let apart = (found - expected).rem_euclid(360.0);
        assert!(apart.min(360.0 - apart) < 0.3, "{name} {found}");
    }
    let dated = |epoch: &str| run(&format!("propagate --body toutatis --epoch {epoch} --times 1992-11-10"));
    assert_eq!(dated("1992-11-09T17:49:47").err, "");
    assert!(dated("1992-11-09T17:50").err.contains("published start is that at 1992-11-09T17:49:47 UTC"));
    // it is the date of --start-time that counts, not that of t = 0
    assert_eq!(dated("1992-11-08T17:49:47 --start-time 1992-11-09T17:49:47").err, "");
    let late = dated("1992-11-09T17:49:47 --start-time 6h").err;
    assert!(late.contains("it is used at --start-time, +21600 s from it"), "{late}");
}

#[test]
fn rows_have_dates_and_where_the_observer_stands() {
    let dated =
        "propagate --body apophis --epoch 2456284.676388UTC --times 0s,12h,2456300.5UTC --angle-unit deg";
    let rows = |flags: &str| -> Vec<Vec<f64>> {
        let text = output(&format!("{dated} {flags}"));
        text.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
    };
    let found = rows("--observer 210,5 --fields jd,observer,q");
    for (row, julian) in found.iter().zip([2_456_284.676_388, 2_456_285.176_388, 2_456_300.5]) {
        assert!((row[0] - julian).abs() < 1e-9, "{row:?}");
        // the direction from the body is that in space, turned back
        let (longitude, latitude) = (row[1], row[2]);
        let inside = nalgebra::Vector3::new(
            libm::cos(longitude) * libm::cos(latitude),
            libm::sin(longitude) * libm::cos(latitude),
            libm::sin(latitude),
        );
        let q = nalgebra::Quaternion::new(row[3], row[4], row[5], row[6]);
        let back = nalgebra::UnitQuaternion::from_quaternion(q) * inside;
        let (longitude, latitude) = (210_f64.to_radians(), 5_f64.to_radians());
        let expected = nalgebra::Vector3::new(
            libm::cos(longitude) * libm::cos(latitude),
            libm::sin(longitude) * libm::cos(latitude),
            libm::sin(latitude),
        );
        assert!((back - expected).norm() < 1e-13, "{row:?}");
    }
    // asked for by its flag it stands beside all that a motion has, a date by name alone
    let head = output(&format!("{dated} --observer 210,5"));
    assert!(
        head.lines().next().unwrap().ends_with("attitude_error,observer_longitude,observer_latitude"),
        "{head}"
    );
    refused("propagate --body apophis --times 0 --observer 210,5", &["--observer: the latitude 5.0", "deg"]);
    refused("propagate --body apophis --times 0 --fields jd", &["--fields", "jd needs --epoch"]);
    refused(
        "propagate --body apophis --times 0 --observer 1,0 --fields t,q",
        &["--observer: none of its columns is among --fields"],
    );
    refused(
        "propagate --body apophis --times 0 --fields observer",
        &["--fields", "observer needs --observer"],
    );
}
