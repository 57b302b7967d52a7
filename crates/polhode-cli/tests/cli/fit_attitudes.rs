//! `polhode simulate --attitude-noise` and `polhode fit` of attitudes, as their users meet them.

use std::fs;

use serde_json::Value;

use crate::harness::{Scratch, output, run};

const SIMULATE: &str = "simulate --moments 1,2,2.6 --omega 0.3,1,0.4 --until 20 --every 0.1 --seed 4";

fn json(line: &str) -> Value {
    let answer = run(&format!("{line} --format json"));
    assert!(answer.out.starts_with('{'), "{line}: {}", answer.err);
    serde_json::from_str(&answer.out).unwrap()
}

/// What a refusal says, with its code.
fn refused(code: i32, line: &str, says: &[&str]) {
    let answer = run(line);
    assert_eq!(answer.code, code, "{line}: {}", answer.err);
    for part in says {
        assert!(answer.err.contains(part), "{line}: '{part}' is not in: {}", answer.err);
    }
}

/// The components of the quaternions of a simulated record, with its times.
fn rows(text: &str) -> Vec<[f64; 5]> {
    let row = |line: &str| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        [cells[0], cells[1], cells[2], cells[3], cells[4]]
    };
    text.lines().skip(1).map(row).collect()
}

fn table(header: &str, rows: impl Iterator<Item = Vec<f64>>) -> String {
    let line = |cells: Vec<f64>| cells.iter().map(f64::to_string).collect::<Vec<_>>().join(",") + "\n";
    format!("{header}\n{}", rows.map(line).collect::<String>())
}

#[test]
fn one_motion_is_read_from_quaternions_matrices_and_angles_alike() {
    let scratch = Scratch::new("fit-attitudes");
    let text = output(&format!("{SIMULATE} --attitude-noise 0.01"));
    assert!(text.starts_with("t,q_w,q_x,q_y,q_z\n0.0,"));
    let file = scratch.file("poses.csv", &text);
    let whole = json(&format!("fit {file}"));
    let of = |value: &Value| value["principal"][0].as_f64().unwrap();
    let sigma = whole["sigma_principal"][0].as_f64().unwrap();
    assert!((of(&whole) - 1.0 / 5.6).abs() < 4.0 * sigma && sigma < 1e-3, "{whole}");
    let attitudes = &whole["attitudes"];
    assert_eq!(attitudes["direction"], "body-to-space");
    assert!(attitudes["direction_stated"] == false && attitudes["direction_gain"].as_f64() > Some(100.0));
    assert!((attitudes["noise_sigma"].as_f64().unwrap() / 0.01 - 1.0).abs() < 0.1);
    assert_eq!(whole["method"], "maximum likelihood on the exact motion of the free body");

    let quaternions = rows(&text);
    let matrix = |[t, w, x, y, z]: [f64; 5]| {
        vec![
            t,
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - w * z),
            2.0 * (x * z + w * y),
            2.0 * (x * y + w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - w * x),
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            1.0 - 2.0 * (x * x + y * y),
        ]
    };
    let header = "t,r11,r12,r13,r21,r22,r23,r31,r32,r33";
    let matrices = scratch.file("matrices.csv", table(header, quaternions.iter().map(|q| matrix(*q))));
    assert!((of(&json(&format!("fit {matrices}"))) - of(&whole)).abs() < 1e-9);
    // a frame of the other hand has the determinant -1
    let mirrored = quaternions.iter().map(|q| {
        let mut m = matrix(*q);
        m[1..4].iter_mut().for_each(|entry| *entry = -*entry);
        m
    });
    let mirrored = scratch.file("mirrored.csv", table(header, mirrored));
    refused(2, &format!("fit {mirrored}"), &["determinant -1.0000", "left-handed"]);

    // numbers without names leave the scalar open, and so does the motion
    let last = quaternions.iter().map(|[t, w, x, y, z]| vec![*t, *x, *y, *z, *w]);
    let last = scratch.file("last.csv", table("t,q0,q1,q2,q3", last));
    refused(2, &format!("fit {last}"), &["--quaternion wxyz or xyzw", "nor the motion shows"]);
    let stated = json(&format!("fit {last} --quaternion xyzw"));
    assert!((of(&stated) - of(&whole)).abs() < 1e-9);
    assert_eq!(stated["attitudes"]["reading"], "quaternion x,y,z,w");

    // yaw, pitch and roll of turns about z, y and x, in degrees
    let angles: Vec<Vec<f64>> = quaternions
        .iter()
        .map(|[t, w, x, y, z]| {
            let degrees = |x: f64| x.to_degrees();
            vec![
                *t,
                degrees(libm::atan2(2.0 * (x * y + w * z), 1.0 - 2.0 * (y * y + z * z))),
                degrees(libm::asin((2.0 * (w * y - x * z)).clamp(-1.0, 1.0))),
                degrees(libm::atan2(2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y))),
            ]
        })
        .collect();
    // columns that say what they turn about, in any order
    for header in ["t,yaw (deg),pitch (deg),roll (deg)", "t,roll (deg),pitch (deg),yaw (deg)"] {
        let in_order = |row: &Vec<f64>| match header.starts_with("t,yaw") {
            true => row.clone(),
            false => vec![row[0], row[3], row[2], row[1]],
        };
        let named = scratch.file("named.csv", table(header, angles.iter().map(in_order)));
        assert!((of(&json(&format!("fit {named} --euler zyx"))) - of(&whole)).abs() < 1e-9, "{header}");
        refused(2, &format!("fit {named} --euler zxz"), &["--euler: 'zxz'", "about x, y and z"]);
    }
    let angles = scratch.file("angles.csv", table("t,euler_1,euler_2,euler_3", angles.into_iter()));
    refused(2, &format!("fit {angles}"), &["--euler, as zyx"]);
    refused(2, &format!("fit {angles} --euler zyx"), &["--angle-unit rad or deg"]);
    let by_angles = json(&format!("fit {angles} --euler zyx --angle-unit deg"));
    assert!((of(&by_angles) - of(&whole)).abs() < 1e-9, "{by_angles}");
}

#[test]
fn a_flag_of_a_form_of_attitudes_that_no_file_has_is_refused() {
    let scratch = Scratch::new("fit-attitudes-forms");
    let turned = |k: u32| {
        let (angle, t) = (0.1 * f64::from(k), f64::from(k));
        let (c, s) = (libm::cos(angle), libm::sin(angle));
        vec![t, c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0]
    };
    let header = "t,r11,r12,r13,r21,r22,r23,r31,r32,r33";
    let matrices = scratch.file("matrices.csv", table(header, (0..30).map(turned)));
    let quaternion = |k: u32| {
        let half = 0.05 * f64::from(k);
        vec![f64::from(k), libm::cos(half), 0.0, 0.0, libm::sin(half)]
    };
    let quaternions = scratch.file("quaternions.csv", table("t,q0,q1,q2,q3", (0..30).map(quaternion)));
    let rated = (0..30).map(|k| [quaternion(k), vec![0.0, 0.0, 0.1]].concat());
    let rated = scratch.file("rated.csv", table("t,q0,q1,q2,q3,wx (rad/s),wy (rad/s),wz (rad/s)", rated));
    let of_quaternions = "is for a quaternion, and none is read";
    let of_angles = "is for a triple of Euler angles, and none is read";
    refused(2, &format!("fit {matrices} --quaternion xyzw"), &["--quaternion: 'xyzw'", of_quaternions]);
    for flag in ["--euler zyx", "--angle-unit deg"] {
        refused(2, &format!("fit {matrices} {flag}"), &[of_angles]);
        for line in [
            format!("fit {quaternions} --quaternion wxyz {flag}"),
            format!("fit {rated} --from both --quaternion wxyz {flag}"),
            // the attitudes beside rates that are fitted tell the axes of these
            format!("fit {rated} --quaternion wxyz {flag}"),
        ] {
            refused(2, &line, &[flag.split(' ').next().unwrap(), of_angles]);
        }
    }
    // one of several files that has the form is enough
    let both = format!("fit {matrices} {quaternions} --quaternion wxyz --angle-unit deg");
    refused(2, &both, &["error: --angle-unit: 'deg'", of_angles]);
}

#[test]
fn a_direction_that_is_stated_wrongly_and_one_that_nobody_can_tell_are_refused() {
    let scratch = Scratch::new("fit-attitudes-direction");
    let text = output(&format!("{SIMULATE} --attitude-noise 0.01"));
    let file = scratch.file("poses.csv", &text);
    refused(2, &format!("fit {file} --attitude space-to-body"), &["look inverted", "0.1784", "--attitude"]);
    let inverse = rows(&text).into_iter().map(|[t, w, x, y, z]| vec![t, w, -x, -y, -z]);
    let inverse = scratch.file("inverse.csv", table("t,q_w,q_x,q_y,q_z", inverse));
    let found = json(&format!("fit {inverse}"));
    assert_eq!(found["attitudes"]["direction"], "space-to-body");
    let top = "simulate --moments 1,1.6,1.6 --omega 0.5,0.8,0.4 --until 20 --every 0.1 --attitude-noise 0.01";
    let top = scratch.file("top.csv", output(top));
    refused(1, &format!("fit {top}"), &["axisymmetric", "--attitude body-to-space or space-to-body"]);
    let stated = json(&format!("fit {top} --attitude body-to-space"));
    assert!((stated["principal"][0].as_f64().unwrap() - 1.0 / 4.2).abs() < 1e-2);
}

#[test]
fn rates_about_the_axes_of_space_are_told_by_the_attitudes_beside_them() {
    let scratch = Scratch::new("fit-attitudes-space");
    for noise in ["--attitude-noise 1e-4 --noise 1e-4", "--attitude-noise 0.01 --noise 0.02"] {
        let text = output(&format!("{SIMULATE} {noise}"));
        let file = scratch.file("body.csv", &text);
        assert_eq!(run(&format!("fit {file}")).code, 0);
        let turned = text.lines().skip(1).map(|line| {
            let mut cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            let attitude = nalgebra::Quaternion::new(cells[1], cells[2], cells[3], cells[4]);
            let rate = nalgebra::Vector3::new(cells[5], cells[6], cells[7]);
            let rate = nalgebra::UnitQuaternion::new_normalize(attitude) * rate;
            cells[5..].copy_from_slice(rate.as_slice());
            cells
        });
        let space = scratch.file("space.csv", table(text.lines().next().unwrap(), turned));
        let says = ["space.csv", "rates are those about the axes of space", "--from attitudes"];
        refused(2, &format!("fit {space}"), &says);
        assert_eq!(run(&format!("fit {space} --from attitudes")).code, 0);
    }
}

/// Attitudes that are missing beside rates are no reason not to fit the rates.
#[test]
fn rates_are_fitted_where_attitudes_beside_them_are_missing() {
    let scratch = Scratch::new("fit-attitudes-missing");
    let text = output(&format!("{SIMULATE} --attitude-noise 0.01 --noise 0.02"));
    let with = |attitude: &str, is_without: fn(usize) -> bool| {
        let line = |(k, line): (usize, &str)| {
            let cells: Vec<&str> = line.split(',').collect();
            let without = format!("{},{attitude},{}", cells[0], cells[5..].join(","));
            if k > 0 && is_without(k) { without + "\n" } else { format!("{line}\n") }
        };
        text.lines().enumerate().map(line).collect::<String>()
    };
    let lost = scratch.file("lost.csv", with(",,,", |k| k == 50));
    refused(2, &format!("fit {lost}"), &["line 51, column 2 (q_w): a number is missing", "--from rates"]);
    let whole = scratch.file("whole.csv", &text);
    // a sensor that estimates no attitude writes zeros
    let none = scratch.file("none.csv", with("0,0,0,0", |_| true));
    let fitted = |line: &str| json(line)["principal"].clone();
    let expected = fitted(&format!("fit {whole}"));
    assert_eq!(fitted(&format!("fit {lost} --from rates")), expected);
    assert_eq!(fitted(&format!("fit {none}")), expected);
}

#[test]
fn rates_beside_attitudes_are_fitted_where_they_are_asked_for() {
    let scratch = Scratch::new("fit-attitudes-both");
    let file = scratch.file("both.csv", output(&format!("{SIMULATE} --attitude-noise 0.01 --noise 0.02")));
    let rates = run(&format!("fit {file} --format json"));
    assert!(rates.err.contains("--from both"), "{}", rates.err);
    let rates: Value = serde_json::from_str(&rates.out).unwrap();
    assert!(rates["attitudes"].is_null() && rates["radius"].is_f64());
    let (page, residuals) = (scratch.file("fit.html", ""), scratch.file("residuals.csv", ""));
    let both = json(&format!("fit {file} --from both --report {page} --residuals {residuals}"));
    let alignment = &both["attitudes"]["alignment"];
    assert!(
        alignment["turn"][0].as_f64().unwrap() > 0.999_99 && alignment["moving_gain"].as_f64() < Some(12.0)
    );
    assert!(both["sigma_principal"][0].as_f64() < rates["sigma_principal"][0].as_f64());
    let page = fs::read_to_string(page).unwrap();
    assert!(page.contains("Attitudes") && page.contains("body to space (found from the motion"), "{page}");
    let residuals = fs::read_to_string(residuals).unwrap();
    assert!(residuals.starts_with("segment,t,turn_x,turn_y,turn_z\n1,0"), "{residuals}");
    assert_eq!(residuals.lines().count(), 202);
    let text = output(&format!("fit {file} --from attitudes --format table"));
    for line in [
        "attitudes read as quaternion w,x,y,z, body to space",
        "noise of a component of the rotation vector",
        "parts of the record are not compared",
    ] {
        assert!(text.contains(line), "{text}");
    }
    refused(2, &format!("fit {file} --from attitudes --wheel 0,0,1,1e-3"), &["--wheel", "--from rates"]);
    refused(2, &format!("fit {file} --from attitudes --gyro-bias 0.1"), &["offset", "no meaning"]);
    refused(2, &format!("fit {file} --from both --torque drag3"), &["drag in proportion to the momentum"]);
}

#[test]
fn rates_that_are_left_out_because_another_file_has_none_are_named() {
    let scratch = Scratch::new("fit-attitudes-mixed");
    let short = SIMULATE.replace("--until 20", "--until 12");
    let both = scratch.file("both.csv", output(&format!("{short} --attitude-noise 0.01 --noise 0.02")));
    let bare = scratch.file(
        "bare.csv",
        output(&format!("{} --attitude-noise 0.01", short.replace("--seed 4", "--seed 5"))),
    );
    for files in [format!("{both} {bare}"), format!("{bare} {both}")] {
        let answer = run(&format!("fit {files} --format json"));
        let note = "both.csv: its attitudes are fitted, and the rates beside them are not";
        assert!(answer.code == 0 && answer.err.contains(note), "{}", answer.err);
        assert_eq!(answer.err.lines().count(), 1, "{}", answer.err);
        let stated = run(&format!("fit {files} --format json --from attitudes"));
        assert_eq!((stated.err.as_str(), stated.out), ("", answer.out));
    }
}

#[test]
fn torques_on_attitudes_are_found_or_refused() {
    let scratch = Scratch::new("fit-attitudes-torque");
    let drag = output(&format!("{SIMULATE} --attitude-noise 0.01 --relative-drag 0.02"));
    let drag = json(&format!("fit {}", scratch.file("drag.csv", drag)));
    assert_eq!(drag["torque"]["model"], "drag");
    let found = &drag["torque"]["coefficients"]["drag"];
    assert!((found["value"].as_f64().unwrap() - 0.02).abs() < 5.0 * found["sigma"].as_f64().unwrap());
    let noise = output(&format!("{SIMULATE} --attitude-noise 0.01 --torque-noise 0.02"));
    let noise = json(&format!("fit {}", scratch.file("noise.csv", noise)));
    assert!(noise["method"].as_str().unwrap().contains("filter and smoother"), "{}", noise["method"]);
    let moments = &noise["principal"];
    assert!((moments[0].as_f64().unwrap() - 1.0 / 5.6).abs() < 0.02, "{moments}");
    // turned to and fro about three axes
    let hand = (0..200).map(|k| {
        let to_and_fro = |period: u32| (f64::from(k % period) / f64::from(period) - 0.5).abs() - 0.25;
        let v = [23, 31, 17].map(|period| 1.6 * to_and_fro(period));
        let w = (1.0 - v.iter().map(|v| v * v).sum::<f64>()).sqrt();
        format!("{},{w},{},{},{}\n", 0.1 * f64::from(k), v[0], v[1], v[2])
    });
    let hand = format!("t,qw,qx,qy,qz\n{}", hand.collect::<String>());
    let hand = scratch.file("hand.csv", hand);
    refused(1, &format!("fit {hand}"), &["does not determine the tensor", "3 of 5"]);
    let by_exact_motion = json(&format!("fit {hand}"));
    assert_eq!(by_exact_motion["method"], "maximum likelihood on the exact motion of the free body");
    assert_eq!(by_exact_motion["rank"], 3);
    let by_smoother = json(&format!("fit {hand} --torque drag3"));
    assert!(by_smoother["method"].as_str().unwrap().contains("filter and smoother"), "{by_smoother}");
    let fast = "simulate --moments 1,2,2.6 --omega 3,10,4 --until 20 --every 0.3 --attitude-noise 0.01";
    let fast = scratch.file("fast.csv", output(fast));
    refused(
        1,
        &format!("fit {fast}"),
        &["the attitude turns by 2.99", "or the other way round by 3.28", "rad/s"],
    );
}
