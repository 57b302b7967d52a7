//! Ensembles: rows, reductions, and what is refused.

#[cfg(unix)]
mod cluster;
#[allow(clippy::disallowed_methods)] // directions and deviations to the digits of any machine
mod elements;
mod first_order;
#[cfg(unix)]
mod killed;
mod passages;
mod refusals;
mod shards;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::harness::{Scratch, polhode, words};

/// Everything is spread, and the motion is exact.
pub(super) const EXACT: &str = "[body]
moments = [1.0, 2.0, 2.5]
[start]
omega = [0.4, 1.0, -0.3]
[spread]
attitude = 0.05
omega = [0.01, 0.02, 0.03]
moments = 0.05
[run]
members = 301
seed = 7
times = [0.0, 1.0, 100.0]
";

/// Two columns of numbers by steps.
pub(super) const STEPPED: &str = "[body]
inertia = [2.0, 3.0, 4.0, -0.3, 0.1, 0.2]
[start]
omega = [0.4, 1.0, -0.3]
[spread.covariance]
omega = [[1e-4, 5e-5, 0.0], [5e-5, 1e-4, 0.0], [0.0, 0.0, 1e-6]]
[run]
members = 200
method = \"two-turn\"
step = 0.01
until = 5
every = 2.5
";

/// Runs in `scratch`, silently on standard error.
pub(super) fn done(line: &str, scratch: &Scratch) -> String {
    polhode(&words(line), &scratch.0).silent(line)
}

/// Names and contents of the files in a folder, without folders.
pub(super) fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(Result::unwrap).filter(|entry| entry.path().is_file());
    entries.map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap())).collect()
}

/// The numbers of an array, and its shape as it is written.
pub(super) fn array(path: &Path) -> (String, Vec<f64>) {
    let bytes = fs::read(path).unwrap();
    let (head, numbers) = bytes.split_at(128);
    let head = String::from_utf8_lossy(head);
    let shape = head.split_once("'shape': ").unwrap().1.split_once(')').unwrap().0;
    let numbers = numbers.chunks_exact(8).map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap()));
    (format!("{shape})"), numbers.collect())
}

/// A column of a CSV.
pub(super) fn column(folder: &Path, file: &str, name: &str) -> Vec<f64> {
    let mut reader = csv::Reader::from_path(folder.join(file)).unwrap();
    let place = reader.headers().unwrap().iter().position(|found| found == name).unwrap();
    reader.records().map(|row| row.unwrap()[place].parse().unwrap()).collect()
}

#[test]
fn a_step_of_more_than_a_radian_and_ratios_under_a_torque_are_told() {
    let scratch = Scratch::new("ensemble-coarse");
    let spec = STEPPED.replace("step = 0.01", "step = 2.5").replace("members = 200", "members = 2");
    scratch.file("coarse.toml", spec);
    let answer = polhode(&words("ensemble coarse.toml --out coarse"), &scratch.0);
    assert_eq!(answer.code, 0, "{}", answer.err);
    assert!(answer.err.contains("[run]: step: '2.5': turns the body by 2.8 rad per step"), "{}", answer.err);
    let ratios = "propagate --body apophis --torque-body 0,0,1e-3 --method rk4 --step 100 --until 1000";
    let answer = polhode(&words(ratios), &scratch.0);
    assert!(answer.err.contains("apophis: the catalogue has only ratios of its moments"), "{}", answer.err);
}

#[test]
fn times_come_from_a_file_as_from_a_list() {
    let scratch = Scratch::new("ensemble-times");
    std::fs::create_dir(scratch.0.join("specs")).unwrap();
    scratch.file("specs/epochs.csv", "night,t,mag\n1,0.0,9\n1,1.0,9\n2,100.0,8\n");
    scratch.file("list.toml", EXACT);
    done("ensemble list.toml --out list", &scratch);
    let list = contents(&scratch.0.join("list"));
    // without the key of the column it is found by its name, and the file beside the specification
    for (name, keys) in [
        ("named", "times_file = \"epochs.csv\"\ntimes_column = \"t\""),
        ("numbered", "times_file = \"epochs.csv\"\ntimes_column = 2"),
        ("found", "times_file = \"epochs.csv\""),
    ] {
        scratch.file("specs/spec.toml", EXACT.replace("times = [0.0, 1.0, 100.0]", keys));
        done(&format!("ensemble specs/spec.toml --out {name}"), &scratch);
        assert!(contents(&scratch.0.join(name)) == list, "{name}");
    }
}

#[test]
fn rates_and_angles_are_read_in_their_units() {
    let scratch = Scratch::new("ensemble-units");
    let spread = "[spread.covariance]\nomega = [[1e-4, 5e-5, 0.0], [5e-5, 1e-4, 0.0], [0.0, 0.0, 1e-6]]\n\
                  attitude = [[1e-4, 0.0, 0.0], [0.0, 2e-4, 0.0], [0.0, 0.0, 1e-6]]\n";
    let unit = std::f64::consts::PI / 180.0;
    let mean_of = |name: &str, spec: &str| {
        scratch.file("spec.toml", spec);
        done(&format!("ensemble spec.toml --out {name}"), &scratch);
        let rows = ["angle_rms", "angle_max"].map(|of| column(&scratch.0.join(name), "summary.csv", of));
        (rows, array(&scratch.0.join(name).join("omegas.npy")).1)
    };
    let start = |omega: [f64; 3], units: &str| {
        format!(
            "[body]\nmoments = [1.0, 2.0, 2.5]\n[start]\nomega = {omega:?}\n{units}\n{}[run]\nmembers = 20\ntimes = [0.0, 1.0]\n",
            if units.is_empty() { scaled(spread, unit * unit) } else { spread.into() }
        )
    };
    let degrees =
        mean_of("degrees", &start([20.0, 50.0, -15.0], "rate_unit = \"deg/s\"\nangle_unit = \"deg\""));
    let radians = mean_of("radians", &start([20.0 * unit, 50.0 * unit, -15.0 * unit], ""));
    let close = |a: &[f64], b: &[f64]| {
        assert_eq!(a.len(), b.len());
        a.iter().zip(b).for_each(|(a, b)| assert!((a - b).abs() < 1e-12, "{a} {b}"));
    };
    close(&degrees.1, &radians.1);
    degrees.0.iter().zip(&radians.0).for_each(|(a, b)| close(a, b));
    // the start of the first member lies near that of the body
    assert!((degrees.1[0] - 20.0 * unit).abs() < 0.01 && degrees.1[0] != 20.0 * unit);
}

/// The numbers of a table times a factor.
fn scaled(table: &str, factor: f64) -> String {
    let number = |text: &str| text.parse::<f64>().map_or(text.into(), |x| format!("{:e}", x * factor));
    table
        .split_inclusive([' ', ',', '[', ']', '\n'])
        .map(|word| {
            let end = word.len() - 1;
            number(&word[..end]) + &word[end..]
        })
        .collect()
}

#[test]
fn a_tolerance_is_that_of_the_method() {
    let scratch = Scratch::new("ensemble-tolerance");
    let named = STEPPED.replace("\"two-turn\"\nstep = 0.01", "\"dop853:1e-10\"");
    let keyed = STEPPED.replace("\"two-turn\"\nstep = 0.01", "\"dop853\"\ntolerance = 1e-10");
    let other = keyed.replace("1e-10", "1e-6");
    let [named, keyed, other] = [("named", named), ("keyed", keyed), ("other", other)].map(|(name, spec)| {
        scratch.file("spec.toml", spec);
        done(&format!("ensemble spec.toml --out {name}"), &scratch);
        contents(&scratch.0.join(name))
    });
    assert!(named == keyed);
    assert!(named["attitudes.npy"] != other["attitudes.npy"]);
}

#[test]
fn every_member_moves_as_propagate_moves_it_alone() {
    let scratch = Scratch::new("ensemble-alone");
    let rows = [
        ("1,2,3", "0.4,1,-0.3", "1,0,0,0"),
        ("1,2,2.5", "0.4,1,-0.3", "0.5,0.5,-0.5,0.5"),
        ("2,2,1", "1e-9,0,5", "0,0,0,1"),
        ("3,1,2.5", "0,0,0", "1,0,0,0"),
    ];
    let mut csv = "name,i1,i2,i3,omega_x,omega_y,omega_z,q_w,q_x,q_y,q_z\n".to_string();
    for (k, (moments, omega, attitude)) in rows.iter().enumerate() {
        csv += &format!("candidate {k},{moments},{omega},{attitude}\n");
    }
    scratch.file("candidates.csv", csv);
    for (method, flags) in [
        ("\"exact\"", "--method exact"),
        ("\"rk4\"\nstep = 0.125", "--method rk4 --step 0.125"),
        ("\"implicit-midpoint\"\nstep = 0.125", "--method implicit-midpoint --step 0.125"),
    ] {
        let spec = format!(
            "[spread]\nmembers_file = \"candidates.csv\"\n[run]\nmethod = {method}\ntimes = [1, \"3s\", 70]\n"
        );
        scratch.file("spec.toml", spec);
        done("ensemble spec.toml --out out --replace", &scratch);
        let out = scratch.0.join("out");
        let (shape, attitudes) = array(&out.join("attitudes.npy"));
        assert_eq!(shape, "(3, 4, 4)");
        let (shape, omegas) = array(&out.join("omegas.npy"));
        assert_eq!(shape, "(3, 4, 3)");
        let mut largest = [0.0_f64; 3];
        for (k, (moments, omega, attitude)) in rows.iter().enumerate() {
            let line = format!(
                "propagate --moments {moments} --omega {omega} --attitude {attitude} --times 1,3,70 {flags} --fields q,omega,errors --out alone.csv"
            );
            done(&line, &scratch);
            for (name, numbers, width, place) in [
                ("q_w", &attitudes, 4, 0),
                ("q_z", &attitudes, 4, 3),
                ("omega_body_x", &omegas, 3, 0),
                ("omega_body_z", &omegas, 3, 2),
            ] {
                let alone = column(&scratch.0, "alone.csv", name);
                let here = [0, 1, 2].map(|time| numbers[(time * rows.len() + k) * width + place]);
                assert_eq!(here.to_vec(), alone, "{method}: {name} of member {k}");
            }
            for (largest, error) in largest.iter_mut().zip(column(&scratch.0, "alone.csv", "energy_error")) {
                *largest = largest.max(error);
            }
        }
        // those of propagate are the largest up to the row, these are of the row
        let errors = column(&out, "summary.csv", "energy_error_max");
        assert!(
            errors.iter().zip(largest).all(|(here, alone)| *here <= alone),
            "{method}: {errors:?} {largest:?}"
        );
        assert!(method.contains("exact") || errors[2] > 0.0, "{method}: {errors:?}");
    }
}

#[test]
fn a_spread_rate_about_one_axis_spreads_the_angle_about_it() {
    // a ball turns about a fixed axis: angles at t are uniform between 5 t and 5.01 t
    let scratch = Scratch::new("ensemble-ball");
    let spec = "[body]\nmoments = [1, 1, 1]\n[start]\nomega = [0, 0, 5]\n[spread.range]\n\
                omega = [[0, 0], [0, 0], [5, 5.01]]\n[run]\nmembers = 4000\ntimes = [0, 10, 40]\n";
    scratch.file("spec.toml", spec);
    done("ensemble spec.toml --out out", &scratch);
    let out = scratch.0.join("out");
    let of = |name| column(&out, "summary.csv", name);
    for (t, (k, half)) in [(0.0, (0, 0.0)), (10.0, (1, 0.05)), (40.0, (2, 0.2))] {
        // five standard deviations of an estimate from 4000 numbers
        let near = |found: f64, truth: f64, deviation: f64| {
            assert!(
                (found - truth).abs() <= 5.0 * deviation / 4000_f64.sqrt() + 1e-15,
                "t = {t}: {found} for {truth}"
            );
        };
        near(of("angle_rms")[k], half / 3_f64.sqrt(), half * 0.26);
        near(of("angle_p50")[k], 0.5 * half, half * 0.5);
        near(of("angle_p95")[k], 0.95 * half, half * 0.22);
        near(of("angle_max")[k], half, half * 0.6);
        assert_eq!(of("members")[k], 4000.0);
        let mean = 2.0 * libm::atan2(of("q_z")[k], of("q_w")[k]);
        let turned = (mean - 5.005 * t) / core::f64::consts::TAU;
        near((turned - turned.round()) * core::f64::consts::TAU, 0.0, half / 3_f64.sqrt());
    }
    let of = |name| column(&out, "dispersion.csv", name)[2];
    assert_eq!((of("axis_1_z"), of("axis_1_x")), (1.0, 0.0));
    assert!((of("sigma_1") / (0.2 / 3_f64.sqrt()) - 1.0).abs() < 0.05 && of("sigma_2") < 1e-8);
    let figure = fs::read_to_string(out.join("dispersion.svg")).unwrap();
    assert!(figure.contains("4000 members") && figure.contains("95 %"));
}

#[test]
fn a_member_that_fails_is_a_row_of_its_own() {
    let scratch = Scratch::new("ensemble-fails");
    // the energy of explicit Euler grows with spin and step: the faster members leave the range of a double
    let spec = "[body]\nmoments = [1, 2, 3]\n[start]\nomega = [1, 1, 1]\n[spread.range]\n\
                omega = [[0.01, 1], [0.01, 1], [0.01, 1]]\n[run]\nmembers = 40\nmethod = \"explicit-euler\"\n\
                step = 0.5\ntimes = [0, 1, 20]\n";
    scratch.file("spec.toml", spec);
    let answer = polhode(&words("ensemble spec.toml --out out"), &scratch.0);
    assert_eq!(answer.code, 0, "{}", answer.err);
    assert!(answer.err.contains("of 40 members failed"), "{}", answer.err);
    let out = scratch.0.join("out");
    let failed = column(&out, "failures.csv", "member");
    assert!(!failed.is_empty() && failed.len() < 40, "{failed:?}");
    let left = column(&out, "summary.csv", "members");
    assert_eq!((left[0], left[2]), (40.0, 40.0 - failed.len() as f64));
    let (_, attitudes) = array(&out.join("attitudes.npy"));
    assert!(attitudes.iter().all(|x| x.is_finite()));
    for k in 0..40 {
        let is_zero = attitudes[(2 * 40 + k) * 4..][..4] == [0.0; 4];
        assert_eq!(is_zero, failed.contains(&(k as f64 + 1.0)), "member {}", k + 1);
    }
    let reasons = fs::read_to_string(out.join("failures.csv")).unwrap();
    assert!(reasons.contains(",20.0,"), "{reasons}");
}

/// A step of explicit Euler takes the quaternion 1 of a ball with ω = 2/h about z to 1 + k: a quarter of a turn, of norm √2.
#[test]
fn a_quaternion_weighs_the_same_whatever_norm_a_method_leaves_it() {
    let scratch = Scratch::new("ensemble-norm");
    scratch.file("members.csv", "omega_x,omega_y,omega_z\n0,0,0\n0,0,2\n");
    let spec = "[body]\nmoments = [1, 1, 1]\n[spread]\nmembers_file = \"members.csv\"\n[run]\n\
                method = \"explicit-euler\"\nstep = 1\ntimes = [1]\n";
    scratch.file("spec.toml", spec);
    done("ensemble spec.toml --out out", &scratch);
    let out = scratch.0.join("out");
    let (_, attitudes) = array(&out.join("attitudes.npy"));
    assert_eq!(attitudes[4..], [1.0, 0.0, 0.0, 1.0]);
    // the mean is half way between them
    for name in ["angle_rms", "angle_p50", "angle_max"] {
        let angle = column(&out, "summary.csv", name)[0];
        assert!((angle - core::f64::consts::FRAC_PI_4).abs() < 1e-14, "{name}: {angle}");
    }
}

/// A step of rk4 takes a momentum of size w to one of the order of 1e-13 w^16, the square of which is beyond a double.
#[test]
fn a_member_whose_errors_are_beyond_a_double_fails() {
    let scratch = Scratch::new("ensemble-beyond");
    scratch.file("members.csv", "omega_x,omega_y,omega_z\n0,0,0\n1e12,1e12,1e12\n");
    let spec = "[body]\nmoments = [1, 2, 2.5]\n[spread]\nmembers_file = \"members.csv\"\n[run]\n\
                method = \"rk4\"\nstep = 0.5\ntimes = [0, 0.5]\n";
    scratch.file("spec.toml", spec);
    let answer = polhode(&words("ensemble spec.toml --out out"), &scratch.0);
    assert!(answer.code == 0 && answer.err.contains("1 of 2 members failed"), "{}", answer.err);
    let out = scratch.0.join("out");
    assert_eq!(column(&out, "failures.csv", "t"), [0.5]);
    assert_eq!(column(&out, "summary.csv", "members"), [2.0, 1.0]);
    assert_eq!(column(&out, "summary.csv", "energy_error_max"), [0.0, 0.0]);
}

/// Of a run that no member of comes to its end the exit code is 1, although all have the row of the start, and again where its results
/// stand already.
#[test]
fn a_run_of_which_every_member_fails_is_no_success() {
    let scratch = Scratch::new("ensemble-none-left");
    scratch.file("members.csv", "omega_x,omega_y,omega_z\n2e12,1e12,1e12\n1e12,1e12,1e12\n");
    let spec = "[body]\nmoments = [1, 2, 2.5]\n[spread]\nmembers_file = \"members.csv\"\n[run]\n\
                method = \"rk4\"\nstep = 0.5\ntimes = [0, 0.5]\n";
    scratch.file("spec.toml", spec);
    for says in ["2 of 2 members failed, the first of them", "already, in which 2 of 2 members failed"] {
        let answer = polhode(&words("ensemble spec.toml --out out"), &scratch.0);
        assert_eq!(answer.code, 1, "{}", answer.err);
        for part in [says, "every member failed; see failures.csv"] {
            assert!(answer.err.contains(part), "{part}: {}", answer.err);
        }
    }
    assert_eq!(column(&scratch.0.join("out"), "summary.csv", "members"), [2.0, 0.0]);
    // a launcher would end the other shards by the status of one, so that they leave it to the gathering
    for (k, says) in
        [(1, "1 of 1 members failed"), (2, "1 of 1 members failed"), (1, "already, in which 1 of 1")]
    {
        let answer = polhode(&words(&format!("ensemble spec.toml --out parts --shard {k}/2")), &scratch.0);
        assert!(answer.code == 0 && answer.err.contains(says), "{}", answer.err);
    }
    let answer = polhode(&words("gather parts"), &scratch.0);
    assert!(answer.code == 1 && answer.err.contains("every member failed"), "{}", answer.err);
}

#[test]
fn rows_of_members_that_are_left_out_are_told() {
    let scratch = Scratch::new("ensemble-fewer");
    scratch.file("members.csv", "i1,i2,i3\n1,1.1,0.5\n1,1.2,0.5\n1,1.3,0.5\n");
    let spec = "[start]\nomega = [0.1, 0.2, 5]\n[spread]\nmembers_file = \"members.csv\"\n[run]\nmembers = 2\ntimes = [2]\n";
    scratch.file("spec.toml", spec);
    let answer = polhode(&words("ensemble spec.toml --out out"), &scratch.0);
    assert_eq!(answer.code, 0, "{}", answer.err);
    assert!(answer.err.contains("has 3 rows, and [run]: members asks for 2"), "{}", answer.err);
}

#[test]
fn forces_act_on_every_member() {
    let scratch = Scratch::new("ensemble-forces");
    let line = |body: &str| {
        format!(
            "propagate {body} --omega 0.1,0.2,5 --times 2 --method rk4 --step 0.01 --weight-moment 0,0,0.5 --drag 0.01,0.02 --torque-space 0,0,0.1 --orbit 2,1.5,4.25,1 --orbit-plane 0.4rad,0.9rad,-1.3rad --fields q,omega --out alone.csv"
        )
    };
    scratch.file("members.csv", "i1,i2,i3\n1,1.1,0.5\n1,1.2,0.5\n");
    let spec = "[start]\nomega = [0.1, 0.2, 5]\n[spread]\nmembers_file = \"members.csv\"\n\
                [run]\nmethod = \"rk4\"\nstep = 0.01\ntimes = [2]\n\
                [force]\nweight_moment = [0, 0, 0.5]\ndrag = [0.01, 0.02]\ntorque_space = [0, 0, 0.1]\n\
                orbit = [2, 1.5, 4.25, 1]\norbit_plane = \"0.4rad, 0.9rad, -1.3rad\"\n[output]\narrays = [\"omegas\"]\n";
    scratch.file("spec.toml", spec);
    done("ensemble spec.toml --out out", &scratch);
    let out = scratch.0.join("out");
    assert!(!out.join("attitudes.npy").exists());
    let (_, omegas) = array(&out.join("omegas.npy"));
    for (k, moments) in ["1,1.1,0.5", "1,1.2,0.5"].into_iter().enumerate() {
        done(&line(&format!("--moments {moments}")), &scratch);
        assert_eq!(column(&scratch.0, "alone.csv", "omega_body_x"), [omegas[3 * k]]);
        assert_eq!(column(&scratch.0, "alone.csv", "omega_body_z"), [omegas[3 * k + 2]]);
    }
    // nothing is conserved, so that no error is told
    let summary = fs::read_to_string(out.join("summary.csv")).unwrap();
    assert!(summary.lines().nth(1).unwrap().contains(",,,2"), "{summary}");
}
