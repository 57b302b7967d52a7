//! `polhode propagate --event`: when something happens.

use polhode::nalgebra::{Quaternion, UnitQuaternion, Vector3};
use polhode::{FreeMotion, Inertia};

use crate::harness::{Scratch, output, refused, run};

const BODY: &str = "propagate --moments 1,2,3 --omega 0.001,1,0 --format csv";
const CONE: &str = "angle(body z, space x) < 40deg";

/// What is printed with the events `events` and `flags`.
fn rows(flags: &str, events: &[&str]) -> Vec<Vec<String>> {
    let events: String = events.iter().map(|event| format!(" --event '{event}'")).collect();
    let answer = run(&format!("{BODY} {flags}{events}"));
    assert_eq!(answer.code, 0, "{}", answer.err);
    let mut rows = answer.out.lines().map(cells);
    assert_eq!(rows.next().unwrap()[..2], ["event", "t"]);
    rows.collect()
}

/// The cells of a row, of which the first may be quoted.
fn cells(row: &str) -> Vec<String> {
    match row.strip_prefix('"').and_then(|rest| rest.split_once("\",")) {
        Some((first, rest)) => [first].into_iter().chain(rest.split(',')).map(String::from).collect(),
        None => row.split(',').map(String::from).collect(),
    }
}

fn number(cell: &str) -> f64 {
    cell.parse().unwrap()
}

/// The angle between body z and space x, degrees.
fn angle(row: &[String]) -> f64 {
    let [w, x, y, z] = [2, 3, 4, 5].map(|k| number(&row[k]));
    let turn = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
    (turn * Vector3::z()).angle(&Vector3::x()).to_degrees()
}

#[test]
fn every_flip_is_a_row() {
    let found = rows("--until 300", &["flip"]);
    let inertia = Inertia::from_moments([1.0, 2.0, 3.0]).unwrap();
    let motion =
        FreeMotion::from_omega(&inertia, UnitQuaternion::identity(), Vector3::new(0.001, 1.0, 0.0)).unwrap();
    assert_eq!(found.len() as u64, motion.flips(300.0.into()));
    for row in found {
        let omega = motion.at(number(&row[1])).unwrap().momentum()[1] / 2.0;
        assert!(row[0] == "flip" && omega.abs() < 1e-13 && number(&row[7]).abs() < 1e-13, "{row:?}");
    }
}

#[test]
fn the_search_ends_with_the_first_where_it_is_told_to() {
    let all = rows("--until 300", &[CONE, "flip"]);
    let first = rows("--until 300 --stop", &[CONE, "flip"]);
    assert_eq!(first[..], all[..1]);
    assert!(all.iter().any(|row| row[0] == CONE) && all.iter().any(|row| row[0] == "flip"));
    assert!(all.windows(2).all(|pair| number(&pair[0][1]) <= number(&pair[1][1])));
    for row in all.iter().filter(|row| row[0] == CONE) {
        assert!((angle(row) - 40.0).abs() < 1e-10, "{}", angle(row));
    }
}

/// To the error of the method.
#[test]
fn methods_find_what_the_exact_motion_has() {
    let exact = rows("--until 40", &[CONE]);
    assert!(!exact.is_empty());
    for (method, error) in [("rk4 --step 0.01", 1e-6), ("dop853:1e-12", 1e-9), ("two-turn --step 0.01", 0.01)]
    {
        let found = rows(&format!("--until 40 --method {method}"), &[CONE]);
        assert_eq!(found.len(), exact.len(), "{method}");
        for (found, exact) in found.iter().zip(&exact) {
            let off = (number(&found[1]) - number(&exact[1])).abs();
            assert!(off < error && (angle(found) - 40.0).abs() < 1e-9, "{method}: {off:e}");
        }
    }
}

#[test]
fn times_count_from_where_the_start_is_said_to_be() {
    let plain = rows("--until 40 --stop", &[CONE]);
    for method in ["", "--method rk4 --step 0.01"] {
        let plain = rows(&format!("--until 40 --stop {method}"), &[CONE]);
        let later = rows(&format!("--start-time 1000 --until 1040 --stop {method}"), &[CONE]);
        assert!((number(&later[0][1]) - number(&plain[0][1]) - 1000.0).abs() < 1e-11, "{later:?}");
        assert_eq!(later[0][2..6].len(), 4);
    }
    let dated = rows("--epoch 2026-01-01 --until 2026-01-02 --stop", &[CONE]);
    assert_eq!(dated, plain);
}

#[test]
fn what_rows_do_not_say_is_said_beside_them() {
    let note = |event: &str, flags: &str| {
        let answer = run(&format!("{BODY} --until 10 --event '{event}' {flags}"));
        assert_eq!(answer.code, 0, "{}", answer.err);
        (answer.out.lines().count(), answer.err)
    };
    let (lines, said) = note("rate > 0.5rad/s", "");
    assert!(lines == 2 && said.contains("rate > 0.5rad/s: already true at the start"), "{said}");
    let (lines, said) = note("rate > 5rad/s", "");
    assert!(lines == 1 && said.contains("none of the events happens from 0 s to 10 s"), "{said}");
    // the bounds of the closed form exclude that a cone is missed, and say nothing of a nearest approach
    assert!(!note(CONE, "").1.contains("may be missed"));
    let (_, said) = note("nearest(0.6,0,0.8,0)", "");
    assert!(said.contains("what begins and ends within 0.125 s"), "{said}");
    let (_, said) = note(CONE, "--method rk4 --step 0.125");
    assert!(said.contains("within 0.125 s may be missed"), "{said}");
    let (_, said) = note(CONE, "--method rk4 --step 0.125 --every 0.01");
    assert!(said.contains("within 0.01 s may be missed"), "{said}");
}

/// Of a turn by h ω a step Euler's method stretches the quaternion by √(1 + (h ω/2)²), here to 1.8 in 20 steps.
#[test]
fn events_of_numbers_that_are_no_rotation_fail() {
    let event = "--event 'rate > 0.5rad/s'";
    let answer = run(&format!("{BODY} --until 10 {event} --method explicit-euler --step 0.5"));
    assert_eq!((answer.code, answer.out.lines().count()), (1, 2), "{answer:?}");
    for part in ["--method explicit-euler", "the quaternion", "no longer describe the motion"] {
        assert!(answer.err.contains(part), "{}", answer.err);
    }
    // the norm is 1.5 after 14 steps: of the cosine of the angle the first change of sign is before, and the next one, a turn later, behind
    let event = "--event 'angle(body x, space x) > 90deg'";
    let answer = run(&format!("{BODY} --until 10 {event} --method explicit-euler --step 0.5"));
    assert_eq!((answer.code, answer.out.lines().count()), (1, 2), "{answer:?}");
    let time = number(&cells(answer.out.lines().last().unwrap())[1]);
    assert!((1.5..1.7).contains(&time), "{time}");
    assert!(answer.err.contains("--method explicit-euler: at 8.125 s the quaternion"), "{}", answer.err);
    let coarse = run(&format!("{BODY} --until 10 {event} --method rk4 --step 2"));
    assert!(coarse.err.contains("--step: '2': turns the body by 2.0 rad per step"), "{}", coarse.err);
}

/// A step of Euler's method stretches |m| by √(1 + (h ω)²), ω that across m: the run leaves the range of a double, and what is the case at
/// its start was before that.
#[test]
fn events_before_a_run_diverges_are_rows() {
    let wild = "propagate --moments 1,2,3 --omega 30,20,-10 --until 1000 --method explicit-euler --step 1";
    let answer = run(&format!("{wild} --event 'rate > 10rad/s' --format csv"));
    assert_eq!((answer.code, answer.out.lines().count()), (1, 2), "{answer:?}");
    let row = cells(answer.out.lines().last().unwrap());
    assert!(row[0] == "rate > 10rad/s" && number(&row[1]) == 0.0, "{row:?}");
    for part in ["error: --method explicit-euler: ", " steps, t = ", "use a smaller step"] {
        assert!(answer.err.contains(part), "{}", answer.err);
    }
    let folder = Scratch::new("events-so-far");
    let file = folder.file("events.csv", "");
    let written = run(&format!("{wild} --event 'rate > 10rad/s' --out {file}"));
    assert_eq!((written.code, written.out.as_str()), (1, ""), "{written:?}");
    assert_eq!(std::fs::read_to_string(file).unwrap(), answer.out);
    // of a motion that ends early nobody says what does not happen in it
    let none = run(&format!("{wild} --event 'rate < 1e-9rad/s' --format csv"));
    assert_eq!((none.code, none.out.lines().count()), (1, 1), "{none:?}");
    assert!(!none.err.contains("none of the events happens"), "{}", none.err);
}

/// An axis that stays at the limit of a cone is there once, at the start, and hides no event of another.
#[test]
fn an_axis_that_stays_at_a_limit_hides_no_other_event() {
    let spin = "propagate --moments 1,2,3 --omega 0,0,1 --angles 0,85,0 --angle-unit deg --euler zxz --until 100 --format csv";
    let answer = run(&format!(
        "{spin} --event 'angle(body z, space z) > 85deg' --event 'angle(body x, space x) > 45deg'"
    ));
    assert_eq!(answer.code, 0, "{}", answer.err);
    let rows: Vec<Vec<String>> = answer.out.lines().skip(1).map(cells).collect();
    let (others, at_limit): (Vec<_>, Vec<_>) =
        rows.iter().partition(|row| row[0] == "angle(body x, space x) > 45deg");
    assert!(at_limit.len() == 1 && number(&at_limit[0][1]) == 0.0, "{at_limit:?}");
    assert_eq!(others.len(), 16);
    for (k, row) in others.into_iter().enumerate() {
        // cos(t) of the turn about body z, whose tilt leaves space x
        let time = (2.0 * k as f64 + 0.25) * std::f64::consts::PI;
        assert!((number(&row[1]) - time).abs() < 1e-9, "{row:?}");
    }
}

#[test]
fn what_is_no_event_is_refused() {
    let with = |event: &str, flags: &str, says: &[&str]| {
        refused(&format!("{BODY} {flags} --event '{event}'"), says);
    };
    with("flips", "--until 10", &["--event", "unknown event", "write flip"]);
    with("angle(body z, space x) < 10", "--until 10", &["has no unit", "10deg"]);
    with("angle(body (0,0,0), space x) < 10deg", "--until 10", &["--event", "a vector with a direction"]);
    with("angle(body z, space x) < 190deg", "--until 10", &["between 0 and pi"]);
    with("rate > -1rad/s", "--until 10", &["positive number of rad/s"]);
    with("nearest(0,0,0,0)", "--until 10", &["zero"]);
    with("flip", "--times 1,2", &["--times", "give --until T"]);
    with("flip", "--every 1", &["--until: missing"]);
    with("flip", "--until 10 --times-column 3", &["--times-column: '3'", "--times names none"]);
    with("flip", "--until -1", &["--until", "does not come after the start"]);
    with("flip", "--until 10 --every 0", &["--every", "positive"]);
    with("flip", "--until 1e9 --every 1e-9", &["--every", "is too long"]);
    with("flip", "--until 10 --fields t,energy_error", &["--fields", "energy_error", "leave it out"]);
    with("flip", "--until 10 --method rk4", &["--step: missing"]);
    let round = "propagate --moments 1,1,2 --omega 0.3,0,1 --until 10 --event flip";
    refused(round, &["--event: 'flip'", "there is no middle axis"]);
    assert!(run(&format!("{BODY} --until 10 --every 1 --stop")).err.contains("--event"));
    assert!(output("propagate --help").contains("angle(body z, space x) < 10deg"));
}
