//! `polhode audit`: files of other programs as they are, the forms of the answer, golden trajectories, refusals.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::harness::{Answer, Scratch, output, polhode, refused, run, words};

const BODY: &str = "--moments 1,2,3";

/// t, q (w, x, y, z) and ω in body axes of the motion by `method`.
fn rows(method: &str) -> Vec<[f64; 8]> {
    rows_at("--until 20 --every 0.1", method)
}

/// The same at other times.
fn rows_at(times: &str, method: &str) -> Vec<[f64; 8]> {
    let line = format!(
        "propagate {BODY} --omega 0.4,1,-0.3 --attitude 0.9,0.1,-0.3,0.2 {times} --fields t,q,omega --format csv"
    );
    let text = output(&format!("{line} {method}"));
    let numbers = |line: &str| -> Vec<f64> { line.split(',').map(|cell| cell.parse().unwrap()).collect() };
    text.lines().skip(1).map(|line| numbers(line)[..8].try_into().unwrap()).collect()
}

fn verdict(answer: &Answer) -> Value {
    assert!(answer.out.starts_with(['{', '[']), "{} {}", answer.out, answer.err);
    serde_json::from_str(&answer.out).unwrap()
}

/// The body vector `v` in space.
fn rotated(q: &[f64], v: &[f64]) -> [f64; 3] {
    let q = nalgebra::UnitQuaternion::new_normalize(nalgebra::Quaternion::new(q[0], q[1], q[2], q[3]));
    (q * nalgebra::Vector3::new(v[0], v[1], v[2])).into()
}

fn table(header: &str, rows: impl Iterator<Item = Vec<f64>>) -> String {
    let mut text = format!("{header}\n");
    for row in rows {
        let cells: Vec<String> = row.iter().map(|x| format!("{x:?}")).collect();
        let _ = writeln!(text, "{}", cells.join(","));
    }
    text
}

#[test]
fn layouts_of_common_programs_need_no_flags() {
    let scratch = Scratch::new("audit-layouts");
    let rows = rows("");
    let numbered = |stem: &str, count: usize| (0..count).map(|k| format!(",{stem}[{k}]")).collect::<String>();
    let mujoco = table(
        &format!("time{}{}", numbered("qpos", 7), numbered("qvel", 6)),
        rows.iter().map(|r| {
            vec![r[0], 0.5, 0.1, 2.0, r[1], r[2], r[3], r[4], 0.0, 0.1, -9.81 * r[0], r[5], r[6], r[7]]
        }),
    );
    let basilisk = table(
        "time,sigma_BN_1,sigma_BN_2,sigma_BN_3,omega_BN_B_1,omega_BN_B_2,omega_BN_B_3",
        rows.iter().map(|r| {
            let sign = if r[1] < 0.0 { -1.0 } else { 1.0 };
            let s = |k: usize| sign * r[k] / (1.0 + sign * r[1]);
            vec![r[0], s(2), s(3), s(4), r[5], r[6], r[7]]
        }),
    );
    let plain = table("t,w,x,y,z", rows.iter().map(|r| r[..5].to_vec()));
    let mut lammps = String::new();
    for (k, r) in rows.iter().enumerate() {
        let momentum = rotated(&r[1..5], &[r[5], 2.0 * r[6], 3.0 * r[7]]);
        let _ = writeln!(
            lammps,
            "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n-1 1\n-1 1\n-1 1\n\
             ITEM: ATOMS id type c_quat[1] c_quat[2] c_quat[3] c_quat[4] angmomx angmomy angmomz\n\
             1 1 {:?} {:?} {:?} {:?} {:?} {:?} {:?}",
            20 * k,
            r[1],
            r[2],
            r[3],
            r[4],
            momentum[0],
            momentum[1],
            momentum[2]
        );
    }
    for (name, text) in
        [("mujoco.csv", &mujoco), ("basilisk.csv", &basilisk), ("plain.csv", &plain), ("rod.dump", &lammps)]
    {
        let file = scratch.file(name, text);
        let answer = run(&format!("audit {file} {BODY} --format json"));
        let found = verdict(&answer);
        assert_eq!(answer.code, 0, "{name}: {} {found:#}", answer.err);
        assert_eq!(found["verdict"], "right", "{name}");
        assert_eq!(found["reading"]["attitude"], "body-to-space", "{name}");
        assert!(found["attitude_error"].as_f64().unwrap() < 1e-6, "{name}: {found:#}");
        if name == "rod.dump" {
            let note = found["warnings"][0].as_str().unwrap();
            assert!(note.contains("they are taken to be 0.005 s long"), "{note}");
        }
    }
}

#[test]
fn a_wrong_frame_is_found_and_a_claim_makes_it_wrong() {
    let scratch = Scratch::new("audit-frame");
    let turned = rows("");
    let turned = turned.iter().map(|r| {
        let space = rotated(&r[1..5], &r[5..8]);
        let mut row = vec![r[0], r[2], r[3], r[4], r[1]];
        row.extend(space.map(f64::to_degrees));
        row
    });
    let text = table("t,q0,q1,q2,q3,wx,wy,wz", turned);
    let file = scratch.file("turned.csv", &text);
    let answer = run(&format!("audit {file} {BODY} --format json"));
    let found = verdict(&answer);
    assert_eq!((answer.code, &found["verdict"]), (0, &Value::from("right")), "{found:#}");
    assert_eq!(found["reading"]["quaternion"], "xyzw");
    assert_eq!(found["reading"]["omega_frame"], "space");
    assert_eq!(found["reading"]["rate_unit"], "deg/s");
    for (claim, suspect) in [("--omega-frame body", "omega-frame"), ("--rate-unit rad/s", "degrees")] {
        let answer = run(&format!("audit {file} {BODY} {claim} --format json"));
        let found = verdict(&answer);
        assert_eq!((answer.code, &found["suspect"]), (1, &Value::from(suspect)), "{found:#}");
        assert!(answer.err.contains(&format!("wrong, suspect {suspect}")), "{}", answer.err);
    }
}

#[test]
fn an_integrator_is_told_by_its_errors() {
    let scratch = Scratch::new("audit-integrator");
    let text = table(
        "t,q_w,q_x,q_y,q_z,omega_body_x,omega_body_y,omega_body_z",
        rows("--method explicit-euler --step 0.01").iter().map(|r| r.to_vec()),
    );
    scratch.file("run.csv", text);
    let audit = |flags: &str| polhode(&words(&format!("audit run.csv {BODY} {flags}")), &scratch.0);
    let answer = audit("--format json");
    let found = verdict(&answer);
    assert_eq!((answer.code, &found["verdict"]), (1, &Value::from("wrong")), "{found:#}");
    assert_eq!(found["suspect"], "integrator:explicit-euler", "{found:#}");
    // every form of the answer
    let answer = audit("--format table --figure audit.svg --report audit.html");
    assert_eq!(answer.code, 1);
    for part in
        ["run.csv: wrong; suspect: integrator:explicit-euler", "Reading: quaternion w,x,y,z", "Flips: "]
    {
        assert!(answer.out.contains(part), "{part}: {}", answer.out);
    }
    assert!(answer.out.lines().all(|line| line.chars().count() <= 80), "{}", answer.out);
    let page = fs::read_to_string(scratch.0.join("audit.html")).unwrap();
    assert!(page.contains("<svg") && page.contains("Suspect: integrator:explicit-euler."));
    assert!(fs::read_to_string(scratch.0.join("audit.svg")).unwrap().contains("Direction of L in space"));
    let answer = audit("--format csv");
    assert!(answer.out.starts_with("id,rows,verdict,suspect,"), "{}", answer.out);
    assert_eq!(audit("--report audit.pdf").code, 2);
}

#[test]
fn bodies_of_one_file_are_told_apart_by_their_id() {
    let scratch = Scratch::new("audit-bodies");
    let (right, wrong) = (rows(""), rows("--method explicit-euler --step 0.05"));
    let mut text = String::from("id,t,q_w,q_x,q_y,q_z\n");
    for (a, b) in right.iter().zip(&wrong) {
        for (id, r) in [("good", a), ("bad", b)] {
            let _ = writeln!(text, "{id},{:?},{:?},{:?},{:?},{:?}", r[0], r[1], r[2], r[3], r[4]);
        }
    }
    let file = scratch.file("two.csv", text);
    let answer = run(&format!("audit {file} {BODY} --format json"));
    let found = verdict(&answer);
    assert_eq!((answer.code, found.as_array().unwrap().len()), (1, 2), "{found:#}");
    assert_eq!((&found[0]["id"], &found[0]["verdict"]), (&"good".into(), &"right".into()), "{found:#}");
    assert_eq!((&found[1]["id"], &found[1]["verdict"]), (&"bad".into(), &"wrong".into()), "{found:#}");
    assert_eq!(run(&format!("audit {file} {BODY} --id good --format json")).code, 0);
    refused(&format!("audit {file} {BODY} --id godo"), &["--id: 'godo': no such body", "known: good, bad"]);
    let text = fs::read_to_string(&file).unwrap();
    let alone =
        text.lines().filter(|line| !line.contains("bad")).fold(String::new(), |all, line| all + line + "\n");
    let alone = scratch.file("alone.csv", alone);
    assert_eq!(run(&format!("audit {alone} {BODY} --id good --format json")).code, 0);
    assert!(!run(&format!("audit {alone} {BODY} --format table")).out.contains("body good"));
}

#[test]
fn angular_velocity_alone_gets_the_verdict_that_it_allows() {
    let scratch = Scratch::new("audit-rates");
    let text = table("t,wx,wy,wz", rows("").iter().map(|r| vec![r[0], r[5], r[6], r[7]]));
    let file = scratch.file("rates.csv", text);
    let answer = run(&format!("audit {file} {BODY} --rate-unit rad/s --format json"));
    let found = verdict(&answer);
    assert_eq!((answer.code, &found["verdict"]), (0, &Value::from("right")), "{found:#}");
    assert!(found["warnings"].to_string().contains("no attitude"), "{found:#}");
    assert!(found["energy_error"].as_f64().unwrap() < 1e-12 && found["attitude_error"].is_null());
}

/// The committed trajectories are those that the command writes, and each checker accepts what is right and refuses what is not.
#[test]
fn golden_trajectories_and_their_checkers() {
    let scratch = Scratch::new("audit-golden");
    assert_eq!(polhode(&words("audit --golden golden"), &scratch.0).code, 0);
    let committed = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden");
    let folder = scratch.0.join("golden");
    let mut names = crate::harness::names(&folder);
    assert_eq!(names, crate::harness::names(&committed));
    for name in &names {
        let [new, old] = [&folder, &committed].map(|folder| fs::read_to_string(folder.join(name)).unwrap());
        assert_eq!(new, old, "golden/{name}: write it again with polhode audit --golden golden");
    }
    names.retain(|name| name.ends_with(".csv"));
    let compiled = Command::new("cc").args(["check.c", "-o", "check", "-lm"]).current_dir(&folder).status();
    let checkers = [
        ("python3", vec!["check.py"], Command::new("python3").arg("--version").output().is_ok()),
        ("./check", vec![], compiled.is_ok_and(|status| status.success())),
    ];
    for name in &names {
        let text = fs::read_to_string(folder.join(name)).unwrap();
        // every row with the attitude of the next
        let mut shifted = String::new();
        let lines: Vec<&str> = text.lines().collect();
        for (k, line) in lines.iter().enumerate() {
            let time = line.split(',').next().unwrap();
            match lines.get(k + 1) {
                Some(after) if time.parse::<f64>().is_ok() => {
                    let _ = writeln!(shifted, "{time},{}", after.split_once(',').unwrap().1);
                }
                _ => shifted += &format!("{line}\n"),
            }
        }
        fs::write(folder.join("late.csv"), shifted).unwrap();
        for (program, first, there) in &checkers {
            if !there {
                println!("{program} is not there: its checker was not run");
                continue;
            }
            let check = |run: &str| {
                let mut command = Command::new(program);
                if *program == "./check" {
                    command = Command::new(folder.join("check"));
                }
                command.args(first).args([name.as_str(), run]).current_dir(&folder).output().unwrap()
            };
            let same = check(name);
            assert!(same.status.success(), "{program} {name}: {}", String::from_utf8_lossy(&same.stdout));
            assert_eq!(check("late.csv").status.code(), Some(1), "{program} {name}");
        }
        let [same, late] = [name, "late.csv"].map(|run| {
            polhode(&words(&format!("audit golden/{run} --against golden/{name} --format json")), &scratch.0)
        });
        assert_eq!(same.code, 0, "{name}: {} {}", same.out, same.err);
        assert_eq!(verdict(&same)["against"]["largest"], 0.0, "{name}");
        assert_eq!(late.code, 1, "{name}: {}", late.out);
    }
}

/// An integration in 26 digits that shares nothing with this program comes to the same motions, to the digits of a double.
#[test]
fn golden_trajectories_are_right() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = root.join("golden");
    let files = crate::harness::names(&folder).into_iter().filter(|name| name.ends_with(".csv"));
    let mut python = Command::new("python3");
    python.arg(root.join("tests/cli/golden_motion.py")).args(files).current_dir(&folder);
    let Ok(done) = python.output() else {
        println!("python3 is not there: the motions were not integrated");
        return;
    };
    let text = String::from_utf8(done.stdout).unwrap();
    assert_eq!(text.lines().count(), 7, "{text}{}", String::from_utf8_lossy(&done.stderr));
    for line in text.lines() {
        let errors: Vec<f64> = line.split(',').skip(1).map(|cell| cell.parse().unwrap()).collect();
        assert!(errors.iter().all(|error| *error < 3e-15), "{line}");
    }
}

#[test]
fn what_cannot_be_audited_is_refused_with_file_line_and_column() {
    let scratch = Scratch::new("audit-refusals");
    let file = |name: &str, text: &str| scratch.file(name, text);
    let header = "t,q_w,q_x,q_y,q_z\n";
    let short = file("short.csv", &format!("{header}0,1,0,0,0\n1,1,0,0,0\n"));
    refused(&format!("audit {short} {BODY}"), &["short.csv: the record has 2 rows", "at least 10"]);
    let unnamed = file("unnamed.csv", "t,a,b,c,d\n0,1,0,0,0\n");
    refused(
        &format!("audit {unnamed}"),
        &["unnamed.csv, line 1: ", "'t', 'a', 'b', 'c', 'd'", "--columns t=NAME,qw=NAME,qx=NAME,..."],
    );
    let back = file("back.csv", &format!("{header}0,1,0,0,0\n2,1,0,0,0\n1,1,0,0,0\n"));
    refused(
        &format!("audit {back}"),
        &["back.csv, line 4, column 1 (t): '1': does not come after", "sort the rows"],
    );
    let text = file("text.csv", &format!("{header}0,1,0,x,0\n"));
    refused(&format!("audit {text}"), &["text.csv, line 2, column 4 (q_y): 'x': is not a number"]);
    let zero = file("zero.csv", &format!("{header}0,0,0,0,0\n"));
    refused(
        &format!("audit {zero}"),
        &["zero.csv, line 2, column 2 (q_w): '0': every component of the attitude is zero"],
    );
    refused("audit absent.csv", &["absent.csv: cannot be read", "name a text file"]);
    for force in ["--drag 1", "--orbit 3.986e14,3.8e7,4.2", "--orbit-plane 0deg,60deg,0deg"] {
        refused(&format!("audit {short} {force}"), &["--moments: missing: a force needs a body"]);
    }
    refused(&format!("audit {short} --columns q=1"), &["--columns", "'q=1' has no known key", "qw qx qy qz"]);
    refused(&format!("audit {short} --against {short}"), &["short.csv: no line '# moments: I1,I2,I3'"]);
    let own = scratch.file("README.md", "# Mine\n");
    refused(
        &format!("audit --golden {}", scratch.0.display()),
        &["--golden", "README.md of another kind", "empty folder"],
    );
    assert_eq!(fs::read_to_string(own).unwrap(), "# Mine\n");
    let checks = scratch.0.join("checks");
    fs::create_dir(&checks).unwrap();
    fs::write(checks.join("check.py"), "mine").unwrap();
    refused(&format!("audit --golden {}", checks.display()), &["--golden", "has a check.py of another kind"]);
    assert_eq!(crate::harness::names(&checks), ["check.py"]);
    assert_eq!(fs::read(checks.join("check.py")).unwrap(), b"mine");
    for flags in [
        "--report r.html",
        "--figure f.svg",
        "--out o.json",
        "--tolerance 1e-3",
        "--id 3",
        "--time-unit ms",
        "--drag 0.1",
        "--omega-frame space",
        "--wheel 1,0,0,0.1@3",
    ] {
        let line = format!("audit --golden {} {flags}", scratch.0.join("new").display());
        refused(&line, &["--golden", "cannot be used with"]);
    }
}

/// Columns named roll, pitch and yaw turn about x, y and z; a program that exchanges two of them is wrong, not another convention.
#[test]
fn angles_under_the_names_of_others_are_wrong() {
    let scratch = Scratch::new("audit-angles");
    let line = format!(
        "propagate {BODY} --omega 0.4,1,-0.3 --attitude 0.8,0.3,-0.4,0.2 --until 6 --every 0.3 --euler zyx --fields t,euler,omega"
    );
    let text = output(&format!("{line} --format csv"));
    let (_, rows) = text.split_once('\n').unwrap();
    let rates = "omega_body_x,omega_body_y,omega_body_z";
    // the columns are turns about z, y and x
    for (names, expected) in [
        ("yaw,pitch,roll", ("right", "none")),
        ("roll,pitch,yaw", ("wrong", "angles-order")),
        ("phi,theta,psi", ("right", "none")),
    ] {
        let file = scratch.file("angles.csv", format!("t,{names},{rates}\n{rows}"));
        let answer = run(&format!("audit {file} {BODY} --format json"));
        let found = &verdict(&answer);
        assert_eq!(
            (&found["verdict"], &found["suspect"]),
            (&expected.0.into(), &expected.1.into()),
            "{found:#}"
        );
        let warned = found["warnings"].to_string().contains("are turns about x, y and z");
        assert_eq!(warned, expected.0 == "wrong", "{found:#}");
        // nor is it beside others a trajectory of another convention
        let line = format!(
            "compare {BODY} --omega 0.4,1,-0.3 --attitude 0.8,0.3,-0.4,0.2 --until 6 --methods rk4 --steps 0.1"
        );
        let beside = run(&format!("{line} --trajectory {file}"));
        assert_eq!(beside.code, if expected.0 == "right" { 0 } else { 2 }, "{names}: {}", beside.err);
        // without rates the exchange is another convention of a body with its moments in another order: still not this body
        let angles = rows.lines().map(|row| row.split(',').take(4).collect::<Vec<_>>().join(",") + "\n");
        let alone = scratch.file("alone.csv", format!("t,{names}\n{}", angles.collect::<String>()));
        let found = verdict(&run(&format!("audit {alone} {BODY} --format json")));
        assert_eq!(
            (&found["verdict"], &found["suspect"]),
            (&expected.0.into(), &expected.1.into()),
            "{found:#}"
        );
        // the names of columns state nothing where flags name them
        let named: Vec<&str> = names.split(',').collect();
        let line =
            format!("audit {file} {BODY} --columns t=t,e1={},e2={},e3={}", named[0], named[1], named[2]);
        let answer = run(&format!("{line},wx=omega_body_x,wy=omega_body_y,wz=omega_body_z --format json"));
        assert_eq!(verdict(&answer)["verdict"], "right", "{}", answer.err);
    }
}

#[test]
fn rodrigues_parameters_are_named_in_the_reading() {
    let scratch = Scratch::new("audit-rodrigues");
    let sigma = rows("").into_iter().map(|r| {
        let sign = if r[1] < 0.0 { -1.0 } else { 1.0 };
        let s = |k: usize| sign * r[k] / (1.0 + sign * r[1]);
        vec![r[0], s(2), s(3), s(4), r[5], r[6], r[7]]
    });
    let file = scratch.file("mrp.csv", table("time,sigma_1,sigma_2,sigma_3,wx,wy,wz", sigma));
    let answer = run(&format!("audit {file} {BODY} --format table"));
    assert!(
        answer.out.contains("Reading: modified Rodrigues parameters; attitude body to space"),
        "{}",
        answer.out
    );
    let answer = run(&format!("audit {file} {BODY} --format json"));
    assert_eq!(verdict(&answer)["reading"]["form"], "modified Rodrigues parameters");
}

#[test]
fn another_body_is_told_in_words() {
    let scratch = Scratch::new("audit-causes");
    let columns = "t,q_w,q_x,q_y,q_z,omega_body_x,omega_body_y,omega_body_z";
    let free = scratch.file("free.csv", table(columns, rows("").iter().map(|r| r.to_vec())));
    let answer = run(&format!("audit {free} --moments 1,2,2.9 --format table"));
    for part in ["free.csv: wrong; suspect: other-body", "The motion is that of another body: moments"] {
        assert!(answer.out.contains(part), "{part}: {}", answer.out);
    }
}

/// Also one whose effect over a window is small beside what the rows of a record differ by from the motion that it would make.
#[test]
fn a_torque_that_is_told_and_does_not_act_is_named() {
    let scratch = Scratch::new("audit-torque");
    let columns = "t,q_w,q_x,q_y,q_z,omega_body_x,omega_body_y,omega_body_z";
    let file = scratch.file("free.csv", table(columns, rows("").iter().map(|r| r.to_vec())));
    for torque in [
        "--torque-body 3e-1,0,0",
        "--torque-body 3e-3,1e-3,-2e-3",
        "--torque-space 1e-4,0,0",
        "--torque-body 3e-6,-3e-6,3e-6",
    ] {
        let answer = run(&format!("audit {file} {BODY} {torque} --format json"));
        let found = verdict(&answer);
        assert_eq!(found["suspect"], "other-torque", "{torque}: {found:#}");
        assert!(found["other_torque"]["factor"].as_f64().unwrap().abs() < 0.05, "{found:#}");
    }
    // one that turns the body by less than the tolerance is no fault
    let small = run(&format!("audit {file} {BODY} --torque-body 1e-9,0,0 --format json"));
    assert_eq!(verdict(&small)["verdict"], "right");
    // and one that acts as it is told is none
    let told = "--torque-body 3e-3,1e-3,-2e-3";
    let driven = rows(&format!("--method rk8 --step 0.01 {told}"));
    let file = scratch.file("driven.csv", table(columns, driven.iter().map(|r| r.to_vec())));
    assert_eq!(verdict(&run(&format!("audit {file} {BODY} {told} --format json")))["verdict"], "right");
}

/// Neither noise nor digits hide which of two readings is that of rows that are wrong in both.
#[test]
fn readings_that_are_wrong_alike_are_not_laid_to_noise() {
    let scratch = Scratch::new("audit-misfit");
    let motion = "propagate --moments 1,2,3 --omega 0.4,1,-0.3 --until 20 --every 0.05 --fields t,q,omega --format csv";
    let mistaken = output(motion).replace("q_w,q_x,q_y,q_z", "q_z,q_w,q_x,q_y");
    let file = scratch.file("mistaken.csv", mistaken);
    let answer = run(&format!("audit {file} --moments 1,2,3 --format csv"));
    let says = "2 readings fit equally well: the rows do not obey the equations of motion in any of them";
    assert!(answer.code == 1 && answer.err.contains(says), "{answer:?}");
    assert!(!answer.err.contains("noise or missing digits"), "{}", answer.err);
    // nor does a body whose rates were never written spin about one axis
    let zero = output(motion).lines().enumerate().fold(String::new(), |text, (k, line)| {
        let cells: Vec<&str> = line.split(',').collect();
        text + &if k == 0 { format!("{line}\n") } else { format!("{},0,0,0\n", cells[..5].join(",")) }
    });
    let answer = run(&format!("audit {} --moments 1,2,3 --format csv", scratch.file("zero.csv", zero)));
    assert!(
        answer.code == 1 && answer.err.contains("the rows do not obey the equations of motion"),
        "{answer:?}"
    );
}

/// A program without the 1/2 of q' = 1/2 q ω turns its attitudes twice as fast: here the rates are half of those of the attitudes.
#[test]
fn attitudes_that_turn_twice_as_fast_as_their_rates_are_told_so() {
    let scratch = Scratch::new("audit-twice");
    for (factor, words) in [(0.5, Some("turn twice as fast")), (2.0, Some("turn half as fast")), (1.1, None)]
    {
        let scaled = rows("").into_iter().map(|r| [&r[..5], &[5, 6, 7].map(|n| factor * r[n])[..]].concat());
        let record = scratch.file("run.csv", table("t,q_w,q_x,q_y,q_z,wx,wy,wz", scaled));
        let answer = run(&format!("audit {record} {BODY} --format json"));
        let told = verdict(&answer)["warnings"].to_string();
        assert_eq!(answer.code, 1, "{told}");
        assert_eq!(words.is_some_and(|words| told.contains(words)), words.is_some(), "{factor}: {told}");
        assert_eq!(told.contains(" as fast as the angular"), words.is_some(), "{factor}: {told}");
    }
}

/// What is not read is not right; what stands twice is not read.
#[test]
fn columns_that_are_not_read_are_named_and_none_stands_twice() {
    let scratch = Scratch::new("audit-unread");
    let file = |name: &str, more: &str, cells: &[f64]| {
        let head = format!("t,q_w,q_x,q_y,q_z,wx,wy,wz{more}");
        let rows = rows("").into_iter().map(|row| row.into_iter().chain(cells.iter().copied()).collect());
        scratch.file(name, table(&head, rows))
    };
    let beside = file("beside.csv", ",energy,lx,ly", &[7.0, 1.0, 2.0]);
    let answer = run(&format!("audit {beside} {BODY} --format json"));
    assert_eq!(answer.code, 0, "{answer:?}");
    assert_eq!(verdict(&answer)["warnings"][0], "not read: energy, lx, ly");
    let twice = file("twice.csv", ",qw,qx,qy,qz", &[1.0, 0.0, 0.0, 0.0]);
    let answer = run(&format!("audit {twice} {BODY}"));
    assert_eq!(answer.code, 2, "{answer:?}");
    assert!(answer.err.contains("columns 2 and 9 both have this name"), "{answer:?}");
    let answer = run(&format!("audit {beside} {BODY} --tolerance 0.5"));
    assert!(answer.code == 2 && answer.err.contains("0.5 is more than 0.1"), "{answer:?}");
}

#[test]
fn flags_of_columns_that_a_record_has_not_are_refused() {
    let scratch = Scratch::new("audit-flags");
    let columns = "t,q_w,q_x,q_y,q_z,omega_body_x,omega_body_y,omega_body_z";
    let file = scratch.file("free.csv", table(columns, rows("").iter().map(|r| r.to_vec())));
    for (flag, value) in
        [("--euler", "zyx"), ("--angle-unit", "deg"), ("--momentum-frame", "space"), ("--id", "3")]
    {
        let says = format!("{flag}: '{value}'");
        refused(&format!("audit {file} {BODY} {flag} {value}"), &[says.as_str(), "leave it out"]);
    }
    let poses = table("t,q_w,q_x,q_y,q_z", rows("").iter().map(|r| r[..5].to_vec()));
    let poses = scratch.file("poses.csv", poses);
    refused(&format!("audit {poses} {BODY} --omega-frame body"), &["--omega-frame: 'body'", "leave it out"]);
    refused(&format!("audit {poses} {BODY} --rate-unit rpm"), &["--rate-unit: 'rpm'", "leave it out"]);
    let says = "poses.csv: the noise of the angular velocity is declared to be 0.01, and the record has no";
    refused(&format!("audit {poses} {BODY} --noise 0,0.01"), &[says, "declare 0"]);
    let rates = table("t,wx,wy,wz", rows("").iter().map(|r| vec![r[0], r[5], r[6], r[7]]));
    let rates = scratch.file("rates.csv", rates);
    for (flag, value) in [("--quaternion", "xyzw"), ("--attitude", "space-to-body")] {
        let says = format!("{flag}: '{value}'");
        refused(&format!("audit {rates} {BODY} {flag} {value}"), &[says.as_str(), "and none is read"]);
    }
    let says = "rates.csv: the noise of the attitude is declared to be 0.01, and the record has no";
    refused(&format!("audit {rates} {BODY} --noise 0.01"), &[says, "declare 0"]);
}

/// Of the bodies of a file only the one that is audited counts.
#[test]
fn flags_of_columns_that_the_chosen_body_has_not_are_refused() {
    let scratch = Scratch::new("audit-chosen");
    let second = "box2_qw,box2_qx,box2_qy,box2_qz,box2_wx,box2_wy,box2_wz";
    let header = format!("t,box1_qw,box1_qx,box1_qy,box1_qz,{second}");
    let both = rows("").into_iter().map(|r| [&r[..5], &r[1..]].concat());
    let file = scratch.file("both.csv", table(&header, both));
    let line = format!("audit {file} {BODY} --omega-frame body --id");
    assert_eq!(run(&format!("{line} box2")).code, 0);
    refused(&format!("{line} box1"), &["--omega-frame: 'body'", "leave it out"]);
}

#[test]
fn any_order_is_refused_where_no_moments_could_change_places() {
    let scratch = Scratch::new("audit-order");
    let columns = "t,q_w,q_x,q_y,q_z,omega_body_x,omega_body_y,omega_body_z";
    let file = scratch.file("free.csv", table(columns, rows("").iter().map(|r| r.to_vec())));
    let code = |flags: &str| run(&format!("audit {file} --moments 1,3,2 {flags}")).code;
    assert_eq!((code(""), code("--any-order")), (1, 0));
    refused(&format!("audit {file} --any-order"), &["--any-order: no moments are given"]);
    let wheel = format!("audit {file} {BODY} --wheel 0,0,1,0.05@3 --any-order");
    refused(&wheel, &["--any-order: a body with wheels has its moments in a fixed order"]);
}

/// What is written of a row.
type Cells<'a> = &'a dyn Fn(&[f64; 8]) -> Vec<f64>;

/// A golden trajectory with a line of moments above its header.
fn golden(scratch: &Scratch, name: &str, header: &str, rows: impl Iterator<Item = Vec<f64>>) -> String {
    scratch.file(name, table(&format!("# moments: 1,2,3\n{header}"), rows))
}

#[test]
fn a_golden_trajectory_is_read_by_the_rules_of_any_other() {
    let scratch = Scratch::new("audit-golden-rules");
    let columns = "t,q_w,q_x,q_y,q_z,omega_body_x,omega_body_y,omega_body_z";
    let all = rows("");
    let record = scratch.file("run.csv", table(columns, all.iter().map(|r| r.to_vec())));
    let against = |header: &str, of: Cells| {
        let file = golden(&scratch, "golden.csv", header, all.iter().map(of));
        format!("audit {record} --against {file} --format json")
    };
    let second = "t,q_w,q_x,q_y,q_z,box2_qw,box2_qx,box2_qy,box2_qz";
    let cases: [(&str, Cells, &str); 4] = [
        (second, &|r| [&r[..5], &r[1..5]].concat(), "the columns box2_qw, box2_qx, box2_qy, box2_qz hold"),
        ("t,q0,q1,q2,q3", &|r| r[..5].to_vec(), "do not show whether the scalar is first or last"),
        ("t,phi,theta,psi", &|r| r[..4].to_vec(), "the sequence of its Euler angles is not known"),
        ("t,sigma_1,sigma_2,sigma_3", &|r| vec![r[0], 1e200, 0.0, 0.0], "outside the range of a double"),
    ];
    for (header, of, says) in cases {
        refused(&against(header, of), &["golden.csv: ", says, "polhode audit --golden DIR"]);
    }
    let text = table("t,q_w,q_x,q_y,q_z", all.iter().map(|r| r[..5].to_vec()));
    let dated = |(k, row): (usize, &str)| match row.split_once(',') {
        Some((_, rest)) if k > 0 => format!("{},{rest}\n", 1_700_000_000_000_u64 + 100 * k as u64),
        _ => format!("# moments: 1,2,3\n{row}\n"),
    };
    let dated = scratch.file("dated.csv", text.lines().enumerate().map(dated).collect::<String>());
    refused(&format!("audit {record} --against {dated}"), &["dated.csv: ", "ms since 1970"]);
    let answer = run(&against("t,q_w,q_x,q_y,q_z,energy", &|r| [&r[..5], &[7.0][..]].concat()));
    let warnings = verdict(&answer)["warnings"].to_string();
    assert_eq!(answer.code, 0, "{warnings}");
    assert!(warnings.contains("golden.csv: not read: energy"), "{warnings}");
}

/// Rows are at one time where their moments are one, however both are written.
#[test]
fn dates_and_counts_since_1970_are_matched_by_their_moments() {
    let scratch = Scratch::new("audit-golden-dates");
    let all = rows("");
    let header = "q_w,q_x,q_y,q_z,omega_body_x,omega_body_y,omega_body_z";
    let written = |name: &str, head: &str, rows: &[[f64; 8]], time: &dyn Fn(f64) -> String| {
        let row = |row: &[f64; 8]| {
            let cells: Vec<String> = row[1..].iter().map(f64::to_string).collect();
            format!("{},{}\n", time(row[0]), cells.join(","))
        };
        let rows: String = rows.iter().map(row).collect();
        scratch.file(name, format!("# moments: 1,2,3\n{head},{header}\n{rows}"))
    };
    let count = |t: f64| format!("{}", 1_700_000_000_000_u64 + (1e3 * t).round() as u64);
    let date = |t: f64| format!("2023-11-14T22:13:{:06.3}Z", 20.0 + t);
    let unzoned = |t: f64| date(t).replace('Z', "");
    let dates = written("dates.csv", "t", &all, &date);
    let counts = written("counts.csv", "t (ms)", &all, &count);
    // the second half, by the other clock
    let late_counts = written("late-counts.csv", "t (ms)", &all[100..], &count);
    let late_dates = written("late-dates.csv", "t", &all[100..], &date);
    for (record, golden) in [(&dates, &late_counts), (&counts, &late_dates), (&counts, &late_counts)] {
        let answer = run(&format!("audit {record} --against {golden} --format json"));
        let found = verdict(&answer);
        assert_eq!((answer.code, &found["verdict"]), (0, &"right".into()), "{golden}: {found:#}");
        assert_eq!((&found["against"]["rows"], &found["against"]["of"]), (&101.into(), &101.into()));
    }
    let plain = written("plain.csv", "t", &all, &|t: f64| t.to_string());
    let says = "counted from its first row, 1700000010000; the times of the record have no such origin";
    refused(&format!("audit {plain} --against {late_counts}"), &["late-counts.csv: ", says, "since 1970"]);
    // an hour that nobody told
    let open = written("open.csv", "t", &all, &unzoned);
    refused(&format!("audit {open} --against {late_counts}"), &["late-counts.csv: ", "no time scale"]);
}

/// Four decimals of a quaternion leave 2e-4 rad open: a motion that is seen from axes of space that are turned by more is another.
#[test]
fn digits_hide_no_more_of_a_difference_than_they_leave_open() {
    let scratch = Scratch::new("audit-golden-digits");
    let header = "t,q_w,q_x,q_y,q_z,omega_body_x,omega_body_y,omega_body_z";
    let all = rows("");
    let reference = golden(&scratch, "golden.csv", header, all.iter().map(|r| r.to_vec()));
    for (angle, code) in [(0.0, 0), (5e-4, 1)] {
        let turn = nalgebra::UnitQuaternion::from_euler_angles(0.0, 0.0, angle).into_inner();
        let written = all.iter().map(|r| {
            let q = turn * nalgebra::Quaternion::new(r[1], r[2], r[3], r[4]);
            let q = [q.w, q.i, q.j, q.k].map(|x| (x * 1e4).round() / 1e4);
            [&r[..1], &q[..], &r[5..]].concat()
        });
        let record = scratch.file("run.csv", table(header, written));
        assert_eq!(run(&format!("audit {record} {BODY}")).code, 0, "{angle}: a motion of the body");
        assert_eq!(run(&format!("audit {record} --against {reference}")).code, code, "{angle}");
    }
}

/// Times are whole sixteenths of a second.
#[test]
fn a_comparison_of_some_rows_promises_nothing_of_all() {
    let scratch = Scratch::new("audit-golden-times");
    let header = "t,q_w,q_x,q_y,q_z,omega_body_x,omega_body_y,omega_body_z";
    let record = rows_at("--until 20 --every 0.125", "");
    let record = scratch.file("run.csv", table(header, record.iter().map(|r| r.to_vec())));
    let against = |rows: &mut dyn Iterator<Item = [f64; 8]>| {
        let file = golden(&scratch, "golden.csv", header, rows.map(|r| r.to_vec()));
        format!("audit {record} --against {file} --format json")
    };
    let every = |times: &str| rows_at(times, "").into_iter();
    let beside = |rows: &mut dyn Iterator<Item = [f64; 8]>| {
        let answer = run(&against(rows));
        let found = verdict(&answer);
        let words = found["verdict"].as_str().unwrap().to_string();
        (answer.code, words, found["against"]["rows"].clone(), found["warnings"].to_string())
    };
    // all rows of the golden trajectory, or all of the record
    let (code, found, rows, told) = beside(&mut every("--until 20 --every 0.25"));
    assert_eq!((code, found.as_str(), rows), (0, "right", 81.into()), "{told}");
    let (code, found, rows, told) = beside(&mut every("--until 40 --every 0.125"));
    assert_eq!((code, found.as_str(), rows), (0, "right", 161.into()), "{told}");
    assert!(
        told.contains("161 of the 321 rows of")
            && !told.contains("all times of one file must be in the other"),
        "{told}"
    );
    // the times of both are the multiples of 0.375 s up to 20 s
    let (code, found, rows, told) = beside(&mut every("--until 30 --every 0.1875"));
    assert_eq!((code, found.as_str(), rows), (1, "undecided", 54.into()), "{told}");
    for part in ["54 of the 161 rows of", "(t = 0 to 30 s)", "161 rows of the record (t = 0 to 20 s)"] {
        assert!(
            told.contains(part) && told.contains("all times of one file must be in the other"),
            "{part}: {told}"
        );
    }
    // one time of 81
    let odd = |r: &[f64; 8]| r[0] == 0.0 || (r[0] / 0.1875) % 2.0 == 1.0;
    let (code, found, rows, told) = beside(&mut every("--until 30 --every 0.1875").filter(odd));
    assert_eq!((code, found.as_str(), rows), (1, "undecided", 1.into()), "{told}");
    // a difference at any of them is one
    let still = |r: [f64; 8]| [r[0], 1.0, 0.0, 0.0, 0.0, r[5], r[6], r[7]];
    let (code, found, _, told) = beside(&mut every("--until 30 --every 0.1875").map(still));
    assert_eq!((code, found.as_str()), (1, "wrong"), "{told}");
    let later = |r: [f64; 8]| [r[0] + 100.0, r[1], r[2], r[3], r[4], r[5], r[6], r[7]];
    let line = against(&mut every("--until 20 --every 0.25").map(later));
    refused(&line, &["run.csv: 0 of the 81 rows of", "(t = 100 to 120 s)", "the 161 rows of the record"]);
}

#[test]
fn a_second_attitude_that_is_not_read_is_no_part_of_a_verdict() {
    let scratch = Scratch::new("audit-second");
    let line = "propagate --moments 1,2,3 --omega 0.4,1,-0.3 --attitude 1,0,0,0 --until 5 --every 0.1 --fields t,q,omega";
    let text = output(line);
    let mut lines = text.lines();
    let header = format!("{},box2_qw,box2_qx,box2_qy,box2_qz\n", lines.next().unwrap());
    let rows: String = lines.map(|row| format!("{row},1,0,0,0\n")).collect();
    let table = header + &rows;
    for stem in ["box2.q", "/box2/orientation/", "box2_orientation_"] {
        let file = scratch.file("other.csv", table.replace("box2_q", stem));
        let columns = format!("the columns {stem}w, {stem}x, {stem}y, {stem}z hold another attitude");
        refused(&format!("audit {file} --moments 1,2,3"), &["other.csv", columns.as_str()]);
    }
    let file = scratch.file("two.csv", table);
    refused(
        &format!("audit {file} --moments 1,2,3"),
        &["two.csv", "the columns box2_qw, box2_qx, box2_qy, box2_qz hold another attitude", "--columns"],
    );
    // the name of the times alone tells not whose attitude is meant
    refused(&format!("audit {file} --moments 1,2,3 --columns t=t"), &["two.csv", "hold another attitude"]);
    let named = "--columns qw=q_w,qx=q_x,qy=q_y,qz=q_z,wx=omega_body_x,wy=omega_body_y,wz=omega_body_z";
    let answer = run(&format!("audit {file} --moments 1,2,3 {named}"));
    assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
}
