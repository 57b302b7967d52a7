//! `polhode propagate` and `polhode motion`.

use crate::harness::{DYADIC, golden, output, refused, refused_with, run, with, words};

#[test]
fn every_flag_is_in_the_help() {
    let help = output("propagate --help");
    for flag in [
        "--moments",
        "--inertia",
        "--body",
        "--omega",
        "--attitude",
        "--times",
        "--until",
        "--every",
        "--start-time",
        "--method",
        "--step",
        "--tolerance",
        "--format",
        "--out",
    ] {
        assert!(help.contains(flag), "{flag}");
    }
}

#[test]
fn the_exact_motion_is_the_golden_one() {
    golden("exact.csv", &output(&with("--times 0,1,2,-1,1e6")));
}

/// Attitude and angular velocity of the dyadic body at t = 2 and t = −1, 20 digits: Taylor series of the equations
/// of motion with 40 digits (mpmath 1.3, `odefun` with tol = 1e-30), which knows nothing of elliptic functions.
#[expect(clippy::excessive_precision, reason = "digits of the reference")]
const TAYLOR: [(f64, [f64; 7]); 2] = [
    (
        2.0,
        [
            0.41446149207459414034,
            0.81123960424665596691,
            0.29031537828351826779,
            -0.29296579530915863294,
            1.0830787987036790821,
            0.18350856859624909173,
            -0.34143982092447701993,
        ],
    ),
    (
        -1.0,
        [
            0.84091567587658248718,
            -0.45909703747083820029,
            -0.26542497229027488031,
            0.10789031622549386082,
            0.95198318313152534492,
            0.60593731011834949349,
            -0.18223609426135863092,
        ],
    ),
];

#[test]
fn the_golden_rows_are_those_of_a_taylor_series() {
    let text = output(&with("--times 2,-1"));
    let mut rows = csv::Reader::from_reader(text.as_bytes());
    for (row, (t, expected)) in rows.records().map(Result::unwrap).zip(TAYLOR) {
        let cells: Vec<f64> = (0..8).map(|k| row[k].parse().unwrap()).collect();
        assert_eq!(cells[0], t);
        for (found, expected) in cells[1..].iter().zip(expected) {
            approx::assert_abs_diff_eq!(*found, expected, epsilon = 1e-15);
        }
    }
}

#[test]
fn stepping_methods_are_the_golden_ones() {
    golden("rk4.csv", &output(&with("--method rk4 --step 0.125 --until 2 --every 0.5")));
    golden("lie-poisson.csv", &output(&with("--method lie-poisson --step 0.125 --until 2 --every 0.5")));
    golden("lie-poisson-321.csv", &output(&with("--method lie-poisson:321 --step 0.125 --times 1,2")));
    golden("rattle.csv", &output(&with("--method rattle --step 0.125 --times 1,2")));
}

#[test]
fn a_tensor_and_its_principal_moments_turn_alike() {
    let moments = output("propagate --moments 1,2,2.5 --omega 0.5,1,0 --times 0,3");
    let tensor = output("propagate --inertia 1,2,2.5,0,0,0 --omega 0.5,1,0 --times 0,3");
    assert_eq!(moments, tensor);
    golden(
        "tensor.csv",
        &output("propagate --inertia 2,2,3,-0.25,0.125,0.5 --omega 0.5,1,-0.25 --times 0,4"),
    );
}

#[test]
fn times_count_from_the_start_time() {
    let shifted = output(&with("--start-time 5 --until 7 --every 1"));
    let plain = output(&with("--until 2 --every 1"));
    let without_t = |text: &str| -> Vec<String> {
        text.lines().map(|line| line.split_once(',').unwrap().1.to_string()).collect()
    };
    assert_eq!(without_t(&shifted), without_t(&plain));
    assert!(shifted.lines().last().unwrap().starts_with("7.0,"));
    let back = output(&with("--until -2 --every -1"));
    assert_eq!(back.lines().count(), 4);
    // rows end where the last multiple does
    assert_eq!(output(&with("--until 1 --every 0.75")).lines().count(), 3);
    // a step that is no binary fraction still reaches what was typed
    assert_eq!(output(&with("--method rk4 --step 0.1 --times 0.3,0.7,100.1")).lines().count(), 4);
}

#[test]
fn any_norm_of_the_attitude_will_do() {
    let flags = "--times 1 --method lie-poisson --step 0.5 --attitude";
    let unit = output(&with(&format!("{flags} 1,-1,0,1")));
    for scaled in ["2e0,-2,0,2", "1.25e-320,-1.25e-320,0,1.25e-320", "1e308,-1e308,0,1e308"] {
        assert_eq!(output(&with(&format!("{flags} {scaled}"))), unit, "{scaled}");
    }
}

#[test]
fn a_body_at_rest_stays() {
    for method in ["exact", "rk4 --step 0.5", "lie-poisson --step 0.5", "rattle --step 0.5"] {
        let text = output(&format!("propagate --moments 1,2,3 --omega 0,0,0 --times 1 --method {method}"));
        let error = if method == "exact" { "" } else { "0.0" };
        let expected = format!("1.0,1.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,,{error}\n");
        assert!(text.ends_with(&expected), "{text}");
    }
}

/// The cells of a column of CSV, as numbers.
pub(crate) fn column(text: &str, name: &str) -> Vec<f64> {
    let mut rows = csv::Reader::from_reader(text.as_bytes());
    let place = rows.headers().unwrap().iter().position(|header| header.starts_with(name)).unwrap();
    rows.records().map(|row| row.unwrap()[place].parse().unwrap()).collect()
}

#[test]
fn a_lagrange_top_of_any_size_keeps_its_invariants() {
    let tilted = "--attitude 0.9,0.3,0.2,0.1";
    for flags in [
        &format!("--moments 1,1,1 --weight-moment 0,0,-2.27 --omega 0.4,-0.2,1 {tilted} --times 0,1,5"),
        "--moments 1,1,0.5 --weight-moment 0,0,1e104 --omega 1e52,0,1e52 --times 0,1e-52",
        "--moments 1,1,2 --weight-moment 0,0,1e200 --omega 0,1e50,1 --times 1e-100,4e-98",
        "--moments 1,1,2 --weight-moment 0,0,1e-180 --omega 1e-90,0,1e-90 --times 1e90",
    ] {
        let text = output(&format!("propagate {flags}"));
        for name in ["energy_error", "momentum_z_error"] {
            let found = column(&text, name);
            assert!(found.iter().all(|error| (0.0..1e-14).contains(error)), "{flags}: {found:?}");
        }
    }
    let weak = "propagate --moments 1,1,2 --weight-moment 0,0,1e-200 --omega 0,1e-90,1 --times 1";
    refused(weak, &["--method exact", "2.5e-201", "at least 1e-80", "leave it out"]);
    let upright = "propagate --moments 1,1,2 --weight-moment 0,0,1e200 --omega 0,1,1 --times 1e-100";
    refused(upright, &["--method exact", "1.0e-100 away from rest on the vertical", "at least 1e-70"]);
}

#[test]
fn errors_under_gravity_are_measured_at_any_scale() {
    let large = "propagate --moments 1,2,2.5 --weight-moment 3e169,1e169,1e170 --omega 0.5e85,0.1e85,1e85 \
                 --attitude 0.9,0.3,0.2,0.1 --times 1e-83 --method rattle --step 1e-86";
    let small = "propagate --moments 1,2,2.5 --weight-moment 3e-181,1e-181,1e-180 --omega 0,0,0 --times 1e91 \
                 --method rattle --step 1e89";
    for line in [large, small] {
        let text = output(line);
        let [error, vertical] = ["energy_error", "momentum_z_error"].map(|name| column(&text, name)[0]);
        assert!(error > 1e-12 && error < 1e-2 && vertical > 0.0 && vertical < 1e-13, "{line}: {text}");
    }
}

#[test]
fn numbers_are_refused_by_place_value_and_rule() {
    refused(&with("--times 1,nan"), &["--times", "item 2", "'nan'", "finite"]);
    refused(&with("--times inf"), &["--times", "'inf'", "finite"]);
    refused(&with("--times 1,,2"), &["--times", "item 2", "missing"]);
    refused(&with("--times 1,x"), &["--times", "item 2", "'x' is not a number", "0.5 or 1e-3"]);
    refused(&with("--until 1e999 --every 1"), &["--until", "1e999", "finite"]);
    refused(&with("--times"), &["--times", "value is required"]);
    refused_with(&[&words(DYADIC)[..], &["--times", ""]].concat(), &["--times", "missing"]);
    refused("propagate --moments 1,2 --omega 1,0,0 --times 1", &["--moments", "2 given, 3 needed"]);
    refused("propagate --moments 1,2,3,4 --omega 1,0,0 --times 1", &["--moments", "4 given, 3 needed"]);
    refused("propagate --inertia 1,2,3 --omega 1,0,0 --times 1", &["--inertia", "3 given, 6 needed"]);
    refused("propagate --body dyadic --omega 1,0 --times 1", &["--omega", "2 given, 3 needed"]);
    refused("propagate --body dyadic --omega 1,NaN,0 --times 1", &["--omega", "item 2", "finite"]);
    refused(&with("--times 1 --attitude 1,0,0"), &["--attitude", "3 given, 4 needed"]);
    refused(&with("--times 1 --attitude 0,0,-0,0"), &["--attitude", "zero quaternion", "1,0,0,0"]);
    refused(&with("--times 1e300"), &["--times", "1e300", "digits", "with an answer"]);
    refused(&with("--times 1e308 --start-time -1e308"), &["--times", "1e308", "not a finite number"]);
}

#[test]
fn bodies_that_cannot_exist_are_refused() {
    let moments = |list: &str, says: &[&str]| {
        refused(&format!("propagate --moments {list} --omega 1,0,0 --times 1"), says);
    };
    moments("0,2,2", &["--moments", "0, 2, 2", "positive"]);
    moments("-1,2,2", &["--moments", "-1, 2, 2", "positive"]);
    moments("1,2,4", &["--moments", "1, 2, 4", "I1 + I2 >= I3 by 1 (25.000 %"]);
    moments("1,2,3.0001", &["--moments", "I1 + I2 >= I3"]);
    refused(
        "propagate --inertia 1,2,3,5,0,0 --omega 1,0,0 --times 1",
        &["--inertia", "-3.5249378105604", "positive"],
    );
    refused("propagate --inertia 1,1,3,0,0,0 --omega 1,0,0 --times 1", &["--inertia", "I1 + I2 >= I3"]);
    refused("propagate --moments 1e308,1e308,1e308 --omega 1,1,1 --times 1", &["range of a double", "units"]);
    refused("propagate --moments 1,2,3 --omega 1e200,0,0 --times 1", &["--omega", "1e200", "units"]);
    refused("propagate --moments 1,2,3 --omega 1e-310,0,0 --times 1", &["--omega", "e-310 rad/s", "units"]);
    refused(
        "propagate --moments 1e300,1e300,1e290 --omega 1e-200,1e-200,0 --times 1",
        &["--omega", "angular velocity 1e-200 rad/s", "range of a double"],
    );
    moments(
        "1e-46,1e-46,3e-46",
        &["--moments", "principal moments 1e-46, 1e-46, 3e-46 violate", "by 1e-46 ("],
    );
}

#[test]
fn steps_that_do_not_fit_are_refused() {
    refused(&with("--method rk4 --times 1"), &["--step: missing", "--method rk4"]);
    refused(&with("--method rk4 --step 0 --times 1"), &["--step", "0.0 is not positive", "above zero"]);
    refused(&with("--method rk4 --step -0.5 --times 1"), &["--step", "-0.5 is not positive"]);
    refused(&with("--method rk4 --step nan --times 1"), &["--step", "'nan' is not a finite number"]);
    refused(&with("--step 0.5 --times 1"), &["--step", "--method exact", "leave it out"]);
    refused(&with("--method rk4 --step 0.5 --times 3,1"), &["--times", "1.0 comes after 3.0", "ascending"]);
    refused(&with("--method rk4 --step 0.5 --times -1"), &["--times", "-1.0 comes after 0.0"]);
    refused(&with("--method rk4 --step 0.5 --until -1 --every -1"), &["--until: -1.0 comes after"]);
    refused(
        &with("--method rk4 --step 1e-300 --times 1"),
        &["--step: '1e-300'", "1e300 steps", "larger step"],
    );
    refused(&with("--until 1 --every 0"), &["--every", "'0'", "not zero"]);
    refused(&with("--until 1 --every -0.5"), &["--every: '-0.5'", "--until 1.0", "change its sign"]);
    refused(&with("--start-time 5 --until 1 --every 1"), &["start time 5.0", "change its sign"]);
    refused(&with("--until 1 --every 1e-20"), &["--every: '1e-20'", "1e20 rows", "larger DT"]);
    refused(&with("--until 1e300 --every 1"), &["--every: '1.0'", "1e300 rows"]);
}

#[test]
fn flags_that_exclude_or_need_each_other_say_so() {
    refused("propagate --body dyadic --moments 1,2,3 --omega 1,0,0 --times 1", &["'--body", "'--moments"]);
    refused("propagate --omega 1,0,0 --times 1", &["--moments", "--inertia", "--body", "not provided"]);
    refused("propagate --moments 1,2,3 --times 1", &["--omega: missing", "--momentum-body"]);
    refused(&with("--times 1 --until 2"), &["--times", "cannot be used with", "--until"]);
    refused(&with("--times 1 --every 2"), &["--times", "cannot be used with", "--every"]);
    refused(&with("--until 2"), &["--until: '2'", "give --every DT too"]);
    refused(&with("--every 2"), &["--every: '2.0'", "give --until T too"]);
    refused(DYADIC, &["--times: missing", "--until T --every DT"]);
    refused(&with("--times 1 --times 2"), &["--times", "multiple times"]);
}

#[test]
fn a_tolerance_is_the_argument_of_methods_that_choose_their_steps() {
    for name in ["dop853", "tsit5", "taylor"] {
        let named = output(&with(&format!("--method {name}:1e-9 --step 5 --times 5,10")));
        let given = output(&with(&format!("--method {name} --tolerance 1e-9 --step 5 --times 5,10")));
        assert_eq!(named, given, "{name}");
        // neither the interval of output nor its flag changes the steps
        let regular = run(&with(&format!("--method {name} --tolerance 1e-9 --until 10 --every 2.5")));
        assert_eq!((regular.code, regular.err.as_str()), (0, ""), "{name}");
        let last = |text: &str| text.lines().last().unwrap().split(',').take(8).collect::<Vec<_>>().join(",");
        assert_eq!(last(&regular.out), last(&given), "{name}");
        let error = column(&given, "attitude_error")[1];
        assert!(error > 1e-12 && error < 1e-6, "{name}: {error:e}");
    }
    golden("dop853.csv", &output(&with("--method dop853 --tolerance 1e-10 --until 20 --every 5")));
    golden("tsit5.csv", &output(&with("--method tsit5 --until 20 --every 5")));
    golden("rk8.csv", &output(&with("--method rk8 --step 0.125 --times 1,2")));
}

#[test]
fn tolerances_that_do_not_fit_are_refused() {
    let of = |method: &str, tolerance: &str| {
        with(&format!("--method {method} --tolerance {tolerance} --step 1 --times 1"))
    };
    refused(&of("dop853", "0"), &["--tolerance", "0.0 is not positive"]);
    refused(&of("dop853", "-1e-9"), &["--tolerance", "-1e-9 is not positive"]);
    refused(&of("dop853", "nan"), &["--tolerance", "'nan' is not a finite number"]);
    refused(&of("tsit5", "1e-16"), &["--tolerance: '1e-16'", "--method tsit5", "from 1e-15", "to 1e-3"]);
    refused(&of("dop853", "0.01"), &["--tolerance: '1e-2'", "--method dop853", "from 1e-15", "to 1e-3"]);
    refused(&of("taylor", "1e-17"), &["--tolerance: '1e-17'", "--method taylor", "from 1.2e-16", "to 1e-3"]);
    refused(
        &of("dop853:1e-9", "1e-8"),
        &["--tolerance: '1e-8'", "has a tolerance already", "one of the two"],
    );
    for method in ["rk4", "rattle", "taylor:20", "rk8"] {
        let says = ["--tolerance: '1e-8'", "does not choose its steps", "one of taylor, dop853, tsit5"];
        refused(&of(method, "1e-8"), &says);
    }
    refused(&with("--tolerance 1e-8 --times 1"), &["--tolerance: '1e-8'", "--method exact", "leave it out"]);
    refused(&of("rk5", "1e-8"), &["--method: 'rk5'", "no such method"]);
}

#[test]
fn a_time_between_steps_is_reached_and_changes_no_other_row() {
    for method in ["rk4", "lie-poisson", "gauss:8", "taylor", "dop853"] {
        let rows = |times: &str| {
            let text = output(&with(&format!("--method {method} --step 0.375 --times {times} --format csv")));
            text.lines().skip(1).map(String::from).collect::<Vec<_>>()
        };
        let (on, between) = (rows("0.75,1.5"), rows("0.75,1,1.25,1.5"));
        assert_eq!((&on[0], &on[1]), (&between[0], &between[3]), "{method}");
        let error = |row: &str| -> f64 { row.split(',').nth(14).unwrap().parse().unwrap() };
        assert!(between.iter().all(|row| error(row) < 0.02), "{method}: {between:?}");
    }
    // and methods that choose their steps need none
    for method in ["taylor", "dop853", "tsit5"] {
        let text = output(&with(&format!("--method {method} --times 0.3,17.1 --format csv")));
        assert_eq!(text.lines().count(), 3, "{method}");
    }
}

#[test]
fn a_step_of_more_than_a_radian_is_warned_of() {
    let answer = run(&with("--method lie-poisson --step 1 --times 2"));
    assert_eq!(answer.code, 0);
    assert!(
        answer.err.starts_with("warning: --step: '1': turns the body by 1.1 rad per step"),
        "{}",
        answer.err
    );
    assert_eq!(answer.err.lines().count(), 1);
    assert_eq!(answer.out.lines().count(), 2);
}

#[test]
fn a_run_that_diverges_prints_the_rows_so_far() {
    let answer = run(&with("--method explicit-euler --step 1 --until 200 --every 20"));
    assert_eq!(answer.code, 1);
    let rows: Vec<&str> = answer.out.lines().collect();
    assert!(rows.len() > 1 && rows.len() < 12, "{}", answer.out);
    assert!(rows[1].starts_with("0.0,1.0,"), "{}", answer.out);
    let error = answer.err.lines().find(|line| line.starts_with("error: ")).unwrap();
    for part in ["--method explicit-euler", "no longer describe the motion", "smaller step"] {
        assert!(error.contains(part), "{error}");
    }
}

#[test]
fn an_implicit_step_without_solution_is_told_and_fails() {
    let answer = run(&with("--method rattle --step 8 --times 0,80"));
    assert_eq!(answer.code, 1);
    assert_eq!(answer.out.lines().count(), 2, "{}", answer.out);
    assert!(answer.err.contains("error: --method rattle: "), "{}", answer.err);
    assert!(answer.err.contains("smaller"), "{}", answer.err);
}

#[test]
fn a_weight_moment_makes_a_top() {
    // Brüls and Cardona's top at t = 2 s, tests/data/tops/reference.csv
    let exact = output("propagate --body bruls-cardona --omega 0,150,-4.61538 --times 2 --format csv");
    let row: Vec<&str> = exact.lines().nth(1).unwrap().split(',').collect();
    let expected = [0.1229471350415335, -0.491079892550027, 0.35043003034362097, -0.7879868875504856];
    for (found, expected) in row[1..5].iter().zip(expected) {
        assert!((found.parse::<f64>().unwrap() - expected).abs() < 1e-14, "{found}, expected {expected}");
    }
    // under gravity |m| and L are not kept, the momentum about the vertical is
    assert_eq!((row[11], row[12]), ("", ""));
    assert!(row[13].parse::<f64>().unwrap() < 1e-15);

    let heavy = "propagate --moments 1,2,3 --weight-moment 0,0,1 --omega 1,1,1 --times 1";
    refused(heavy, &["--method exact", "1, 2, 3", "two equal ones", "kick-drift@srkn-6b"]);
    refused(
        "propagate --moments 2,2,3 --weight-moment 0.1,0,1 --omega 1,1,1 --times 1",
        &["--method exact", "away from the symmetry axis"],
    );
    refused(
        "propagate --moments 1,2,3 --weight-moment 0,0 --omega 1,1,1 --times 1",
        &["--weight-moment", "3 needed"],
    );
    refused("motion --body gyroscope --omega 1,1,1", &["--body", "gyroscope", "gravity"]);
    // no closed form: the attitude error is left empty
    let stepped = output(&format!("{heavy} --method kick-drift:4 --step 0.015625 --format csv"));
    assert!(stepped.lines().nth(1).unwrap().ends_with(','), "{stepped}");
}

#[test]
fn a_body_with_inner_friction_keeps_l_and_loses_energy() {
    let of = |method: &str| {
        format!(
            "propagate --moments 1,2,3 --omega 0.4,1,0.8 --method {method} --step 0.05 --times 0,100,2000 \
             --fields t,omega,energy,momentum_vector_error"
        )
    };
    let rows: Vec<Vec<f64>> = output(&of("dissipating:1e-2@suzuki-4"))
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    assert!(rows[1][4] < rows[0][4] && rows[2][4] < rows[1][4], "{rows:?}");
    assert!(rows[2][5] < 1e-14, "{rows:?}");
    // it ends about the axis of the largest moment, with all of |m|
    let momentum = (0.4_f64 * 0.4 + 4.0 + 5.76).sqrt();
    assert!((rows[2][3] - momentum / 3.0).abs() < 1e-3, "{rows:?}");
    refused(&of("dissipating:0"), &["--method: dissipating:0: the loss is 0", "above 0 and below 1"]);
    refused(&of("dissipating:x"), &["--method: dissipating:x", "not a number"]);
    refused(&of("dissipating:1e-3@strong"), &["--method", "strong"]);
    // it is no rigid body, so that nothing compares it with one
    refused(
        "compare --moments 1,2,3 --omega 0.4,1,0.8 --methods dissipating:1e-3 --steps 0.1 --until 10",
        &["--methods", "dissipating:1e-3"],
    );
}
