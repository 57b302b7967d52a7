//! What a file says is read or refused, and what is asked for is given or refused: nothing is passed over with exit code 0.

use crate::harness::{Scratch, output, refused, run};

const BODY: &str = "--moments 1,2,3";
const MOTION: &str =
    "propagate --moments 1,2,3 --omega 0.4,1,-0.3 --attitude 1,0.2,0,0 --until 6 --every 0.1";

/// The motion with those columns under another header.
fn written(scratch: &Scratch, name: &str, fields: &str, header: &str) -> String {
    let text = output(&format!("{MOTION} --fields {fields}"));
    let (_, rows) = text.split_once('\n').unwrap();
    scratch.file(name, format!("{header}\n{rows}"))
}

/// The same with each row made of the cells that `of` makes.
fn made(
    scratch: &Scratch,
    name: &str,
    fields: &str,
    header: &str,
    of: impl Fn(&[f64]) -> Vec<f64>,
) -> String {
    let text = output(&format!("{MOTION} --fields {fields}"));
    let row = |line: &str| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        of(&cells).iter().map(f64::to_string).collect::<Vec<_>>().join(",")
    };
    let rows: Vec<String> = text.lines().skip(1).map(row).collect();
    scratch.file(name, format!("{header}\n{}\n", rows.join("\n")))
}

const WITH_RATES: &str = "t,q,omega";

#[test]
fn names_of_quaternions_stand_whatever_their_order_is_said_to_be() {
    let scratch = Scratch::new("heard-order");
    let to_xyzw = |row: &[f64]| vec![row[0], row[2], row[3], row[4], row[1], row[5], row[6], row[7]];
    let header = "t,q_x,q_y,q_z,q_w,omega_body_x,omega_body_y,omega_body_z";
    let file = made(&scratch, "xyzw.csv", WITH_RATES, header, to_xyzw);
    for order in ["", "--quaternion xyzw", "--quaternion wxyz"] {
        let answer = run(&format!("audit {file} {BODY} {order} --format json"));
        assert_eq!(answer.code, 0, "{order}: {answer:?}");
        let says = "xyzw.csv: --quaternion has no effect, as the names of its columns tell the scalar";
        assert_eq!(answer.err.contains(says), !order.is_empty(), "{order}: {answer:?}");
        let start = "--omega 0.4,1,-0.3 --attitude 1,0.2,0,0 --until 6 --methods rk8 --steps 0.1";
        let line = format!("compare {BODY} {start} --trajectory {file} --format csv {order}");
        let answer = run(&line);
        let row = answer.out.lines().find(|row| row.contains("xyzw.csv")).unwrap();
        assert!(answer.code == 0 && row.contains(",ok"), "{order}: {answer:?}");
        assert_eq!(answer.err.contains(says), !order.is_empty(), "{order}: {answer:?}");
    }
}

#[test]
fn counts_of_steps_are_no_times() {
    let scratch = Scratch::new("heard-steps");
    let frame = |step: u32, q: &str| {
        format!(
            "ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n-1 1\n-1 1\n-1 1\n\
             ITEM: ATOMS id quatw quati quatj quatk\n1 {q}\n"
        )
    };
    let text = frame(0, "1 0 0 0") + &frame(100, "0.8 0.6 0 0") + &frame(200, "0.6 0.8 0 0");
    let file = scratch.file("dump.lammpstrj", text);
    refused(&format!("propagate {BODY} --through {file} --every 10"), &["--through", "counts steps"]);
    let rates = written(&scratch, "rates.csv", "t,omega", "t,wx (rad/s),wy (rad/s),wz (rad/s)");
    refused(&format!("attitude {rates} --against {file}"), &["--against", "counts steps"]);
}

#[test]
fn a_golden_trajectory_that_counts_steps_is_refused() {
    let scratch = Scratch::new("heard-golden");
    let columns = "q_w,q_x,q_y,q_z,omega_body_x,omega_body_y,omega_body_z";
    let record = written(&scratch, "run.csv", WITH_RATES, &format!("t,{columns}"));
    let golden = |name: &str, time: &str| {
        written(&scratch, name, WITH_RATES, &format!("# moments: 1,2,3\n{time},{columns}"))
    };
    let of_times = golden("golden.csv", "t");
    assert_eq!(run(&format!("audit {record} --against {of_times}")).code, 0);
    let of_steps = golden("steps.csv", "timestep");
    refused(&format!("audit {record} --against {of_steps}"), &["steps.csv", "counts steps"]);
}

#[test]
fn a_unit_that_has_two_meanings_is_refused() {
    let scratch = Scratch::new("heard-rps");
    let file = written(&scratch, "rps.csv", "t,omega", "t,wx (rps),wy (rps),wz (rps)");
    for line in [format!("attitude {file}"), format!("fit {file}")] {
        refused(&line, &["rps"]);
    }
}

#[test]
fn mirrors_are_no_attitudes() {
    let scratch = Scratch::new("heard-mirror");
    let mirrored = |row: &[f64]| {
        let (w, [x, y, z]) = (row[1], [row[2], row[3], row[4]]);
        vec![
            row[0],
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - w * z),
            -2.0 * (x * z + w * y),
            2.0 * (x * y + w * z),
            1.0 - 2.0 * (x * x + z * z),
            -2.0 * (y * z - w * x),
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            -1.0 + 2.0 * (x * x + y * y),
        ]
    };
    let header = "t,r11,r12,r13,r21,r22,r23,r31,r32,r33";
    let file = made(&scratch, "mirror.csv", "t,q", header, mirrored);
    let rates = written(&scratch, "rates.csv", "t,omega", "t,wx (rad/s),wy (rad/s),wz (rad/s)");
    refused(&format!("attitude {rates} --against {file}"), &["mirror.csv", "left-handed"]);
    let line = format!("compare {BODY} --omega 0.4,1,-0.3 --until 6 --methods rk4 --steps 0.1");
    refused(&format!("{line} --trajectory {file}"), &["mirror.csv", "left-handed"]);
}

#[test]
fn units_of_a_header_are_all_read() {
    let scratch = Scratch::new("heard-units");
    let rates = "omega_body_x (deg/s),omega_body_y (rad/s),omega_body_z (rad/s)";
    let mixed = written(&scratch, "mixed.csv", WITH_RATES, &format!("t,q_w,q_x,q_y,q_z,{rates}"));
    refused(&format!("audit {mixed} {BODY}"), &["omega_body_y", "one unit"]);
    let degrees = |row: &[f64]| {
        let mut row = row.to_vec();
        row[1..].iter_mut().for_each(|angle| *angle = angle.to_degrees());
        row
    };
    let euler = "t,euler --euler zxz";
    let angles = made(&scratch, "angles.csv", euler, "t,phi (rad),theta (rad),psi (rad)", degrees);
    assert_eq!(run(&format!("audit {angles} {BODY} --euler zxz")).code, 1);
    refused(&format!("audit {angles} {BODY} --euler zxz --angle-unit deg"), &["--angle-unit", "rad"]);
    let below = made(&scratch, "below.csv", euler, "t,phi,theta,psi\ns,rad,rad,rad", degrees);
    assert_eq!(run(&format!("audit {below} {BODY} --euler zxz")).code, 1);
    let right = made(&scratch, "right.csv", euler, "t,phi,theta,psi\ns,deg,deg,deg", degrees);
    assert_eq!(run(&format!("audit {right} {BODY} --euler zxz")).code, 0);
    let two = made(&scratch, "two.csv", euler, "t,phi (deg),theta (rad),psi (rad)", degrees);
    refused(&format!("audit {two} {BODY} --euler zxz"), &["theta", "one unit"]);
    let momenta = |unit: &str| {
        let header = ["x", "y", "z"].map(|axis| format!("Lbody_{axis} ({unit})")).join(",");
        made(&scratch, "momenta.csv", WITH_RATES, &format!("t,q_w,q_x,q_y,q_z,{header}"), |row| {
            let mut row = row.to_vec();
            row[5..].iter_mut().zip([1.0, 2.0, 3.0]).for_each(|(w, moment)| *w *= moment);
            row
        })
    };
    assert_eq!(run(&format!("audit {} {BODY}", momenta("N m s"))).code, 0);
    refused(&format!("audit {} {BODY}", momenta("g cm^2/s")), &["Lbody_x", "g cm^2/s"]);
}

#[test]
fn what_a_fit_cannot_use_or_write_is_refused() {
    let scratch = Scratch::new("heard-fit");
    let rates = written(&scratch, "rates.csv", "t,omega", "t,wx (rad/s),wy (rad/s),wz (rad/s)");
    let poses = written(&scratch, "poses.csv", "t,q", "t,q_w,q_x,q_y,q_z");
    refused(&format!("fit {poses} --axes x,-y,z"), &["--axes", "attitudes are fitted"]);
    refused(&format!("fit {poses} --rate-unit deg/s"), &["--rate-unit: 'deg/s'", "attitudes are fitted"]);
    refused(
        &format!("fit {poses} --skip-rows 0.1"),
        &["--skip-rows: '0.1'", "every row of attitudes is read"],
    );
    refused(&format!("fit {rates} --attitude-noise 0.1"), &["--attitude-noise", "rates are fitted"]);
    let flags = [
        "--euler zyx",
        "--euler zyx:extrinsic",
        "--quaternion xyzw",
        "--angle-unit deg",
        "--attitude space-to-body",
    ];
    for flag in flags {
        let (name, value) = flag.split_once(' ').unwrap();
        let says = format!("{name}: '{value}': says how attitudes are written, and the rates are fitted");
        refused(&format!("fit {rates} {flag}"), &[says.as_str(), "--from attitudes"]);
    }
    // which is of use where there are attitudes beside the rates
    let numbered = "t,q0,q1,q2,q3,wx (rad/s),wy (rad/s),wz (rad/s)";
    let both = written(&scratch, "both.csv", WITH_RATES, numbered);
    let answer = run(&format!("fit {both} --quaternion wxyz"));
    assert!(!answer.err.contains("--quaternion"), "{answer:?}");
    refused(&format!("fit {both} --from rates --quaternion wxyz"), &["--quaternion", "the rates are fitted"]);
    let body = scratch.file("body.json", r#"{"inertia":[[1,0,0],[0,2,0],[0,0,2.5]]}"#);
    for flag in ["--report a.html", "--residuals a.csv", "--figure a.svg"] {
        let line = format!("fit {rates} --calibrate-wheel 0,0,1 --body {body} {flag}");
        refused(&line, &["--calibrate-wheel", "no page"]);
    }
    let flags = [
        "--prior-inertia 1,2,2.6,0.01",
        "--prior-shape 1,2,2.6,0.01",
        "--at-least 0,0,1,0.1",
        "--at-most 0,0,1,0.45",
        "--trust-units",
    ];
    for flag in flags {
        let name = flag.split(' ').next().unwrap();
        let line = format!("fit {rates} --calibrate-wheel 0,0,1 --body {body} {flag}");
        refused(&line, &[name, "--calibrate-wheel takes the tensor of --body as it is"]);
    }
}

#[test]
fn what_other_commands_cannot_use_is_refused_or_said() {
    let scratch = Scratch::new("heard-others");
    let poses = written(&scratch, "poses.csv", "t,q", "t,q_w,q_x,q_y,q_z");
    for flag in ["--frame ecliptic", "--periods 1h", "--times-column t"] {
        let answer = run(&format!("propagate {BODY} --through {poses} --every 0.5 {flag}"));
        assert_eq!(answer.code, 2, "{flag}: {answer:?}");
    }
    refused(&format!("{MOTION} --fields t,jd"), &["--fields", "jd", "--epoch"]);
    let wheels = r#"{"name":"a","mass":10,"center_of_mass":[0,0,0],"inertia":[[1,0,0],[0,2,0],[0,0,2.5]],
        "wheels":[{"axis":[0,0,1],"inertia":0.05,"speed":300}]}"#;
    let body = scratch.file("wheels.json", wheels);
    let answer = run(&format!("inertia json {body}"));
    assert!(answer.code == 0 && answer.err.contains("wheels"), "{answer:?}");
    let plain = scratch.file("plain.json", r#"{"mass":10,"inertia":[[1,0,0],[0,2,0],[0,0,2.5]]}"#);
    refused(&format!("inertia json {plain} --about 0,0,1 --format urdf"), &["--about"]);
    // its rows end before those of the methods
    let text = std::fs::read_to_string(&poses).unwrap();
    let few: Vec<&str> = text.lines().take(12).collect();
    let short = scratch.file("short.csv", few.join("\n") + "\n");
    let line =
        format!("compare {BODY} --omega 0.4,1,-0.3 --attitude 1,0.2,0,0 --until 6 --methods rk8 --steps 0.1");
    let answer = run(&format!("{line} --trajectory {short}"));
    assert!(answer.code == 0 && answer.err.contains("its last row is at t = 1 s"), "{answer:?}");
    let line = line.replace("--methods rk8", "--methods rk8,dissipating:1e-3");
    refused(&line, &["dissipating", "inner friction"]);
}

#[test]
fn of_two_attitudes_none_is_taken_for_the_one_that_is_meant() {
    let scratch = Scratch::new("heard-second");
    let both = |row: &[f64]| [row, &row[1..]].concat();
    let header = "t,q_w,q_x,q_y,q_z,box2_qw,box2_qx,box2_qy,box2_qz";
    let file = made(&scratch, "second.csv", "t,q", header, both);
    let rates = written(&scratch, "rates.csv", "t,omega", "t,wx (rad/s),wy (rad/s),wz (rad/s)");
    let says = "the columns box2_qw, box2_qx, box2_qy, box2_qz hold another attitude";
    refused(&format!("attitude {rates} --against {file}"), &["--against", "second.csv", says]);
    refused(&format!("propagate {BODY} --through {file} --every 0.5"), &["--through", "second.csv", says]);
    refused(&format!("audit {file} {BODY}"), &["second.csv", says]);
    let line = "--omega 0.4,1,-0.3 --attitude 1,0.2,0,0 --until 6 --methods rk4 --steps 0.1";
    refused(&format!("compare {BODY} {line} --trajectory {file}"), &["second.csv", says]);
}

#[test]
fn a_second_time_that_contradicts_the_first_is_named() {
    let scratch = Scratch::new("heard-time");
    let header = "t,time_ms,q_w,q_x,q_y,q_z,omega_body_x,omega_body_y,omega_body_z";
    let file = |name: &str, shift: f64| {
        made(&scratch, name, WITH_RATES, header, |row| {
            let late = if row[0] > 3.0 { shift } else { 0.0 };
            [&[row[0], 1000.0 * row[0] + late], &row[1..]].concat()
        })
    };
    let told = |file: &str| run(&format!("audit {file} {BODY} --format json")).out;
    assert!(!told(&file("same.csv", 0.0)).contains("contradicts the times"));
    assert!(told(&file("jump.csv", 50.0)).contains("is also a time and contradicts"));
}

#[test]
fn a_clock_in_milliseconds_is_named() {
    let scratch = Scratch::new("heard-clock");
    let header = "t,q_w,q_x,q_y,q_z,omega_body_x,omega_body_y,omega_body_z";
    let milliseconds = |row: &[f64]| [&[1000.0 * row[0]], &row[1..]].concat();
    let file = made(&scratch, "ms.csv", WITH_RATES, header, milliseconds);
    let answer = run(&format!("audit {file} {BODY}"));
    assert_eq!(answer.code, 1, "{answer:?}");
    assert!((answer.out + &answer.err).contains("--time-unit ms"));
    assert_eq!(run(&format!("audit {file} {BODY} --time-unit ms")).code, 0);
}

#[test]
fn a_unit_of_time_is_refused_where_times_have_theirs() {
    let scratch = Scratch::new("heard-stamps");
    let stamped = |row: &[f64]| {
        let whole = row[0].floor();
        [&[1.7e9 + whole, ((row[0] - whole) * 1e9).round()], &row[1..]].concat()
    };
    let header = "stamp.secs,stamp.nsecs,q_w,q_x,q_y,q_z,wx,wy,wz";
    let file = made(&scratch, "stamp.csv", WITH_RATES, header, stamped);
    assert_eq!(run(&format!("audit {file} {BODY}")).code, 0);
    let attitude = format!("attitude {file} --kind rate");
    for command in [format!("audit {file} {BODY}"), format!("fit {file} --from rates"), attitude] {
        refused(&format!("{command} --time-unit ms"), &["--time-unit: 'ms'", "are s and ns already"]);
    }
}

#[test]
fn the_unit_of_a_simulated_start_is_the_one_that_is_named() {
    let line = "simulate --moments 1,2,2.6 --until 2 --every 0.1";
    let plain = output(&format!("{line} --omega 0.5,1,0.25"));
    let turned = output(&format!("{line} --omega 5,10,2.5 --rate-unit deg/s"));
    assert_ne!(plain, turned);
    let first = |text: &str| text.lines().nth(1).unwrap().split(',').nth(1).unwrap().parse::<f64>().unwrap();
    assert!((first(&turned) / 5_f64.to_radians() - 1.0).abs() < 1e-12, "{turned}");
}

#[test]
fn attitudes_from_space_to_body_say_so_in_their_names() {
    let scratch = Scratch::new("heard-direction");
    let rates = written(&scratch, "rates.csv", "t,omega", "t,wx (rad/s),wy (rad/s),wz (rad/s)");
    let line = format!("attitude {rates} --start 1,0.2,0,0");
    let names = "t,q_space_to_body_w,q_space_to_body_x,q_space_to_body_y,q_space_to_body_z,attitude_sigma";
    for (flags, head, read) in [
        ("", "t,q_w,q_x,q_y,q_z,attitude_sigma", "read as body to space"),
        ("--direction space-to-body", names, "read as space to body"),
    ] {
        let file = scratch.0.join("written.csv").display().to_string();
        assert_eq!(run(&format!("{line} {flags} --out {file}")).code, 0, "{flags}");
        assert!(std::fs::read_to_string(&file).unwrap().starts_with(head), "{flags}");
        let answer = run(&format!("attitude {rates} --against {file}"));
        assert!(answer.code == 0 && answer.err.contains(read), "{answer:?}");
        let errors = answer.out.lines().skip(1).map(|row| row.rsplit(',').next().unwrap().parse::<f64>());
        let worst = errors.map(Result::unwrap).fold(0.0, f64::max);
        assert!(worst < 1e-12, "{flags}: {worst}");
    }
    // other commands that read attitudes
    let names = "t,q_space_to_body_w,q_space_to_body_x,q_space_to_body_y,q_space_to_body_z";
    let inverse = |row: &[f64]| vec![row[0], row[1], -row[2], -row[3], -row[4]];
    let inverse = made(&scratch, "inverse.csv", "t,q", names, inverse);
    let poses = written(&scratch, "poses.csv", "t,q", "t,q_w,q_x,q_y,q_z");
    let between = |file: &str| {
        let text = std::fs::read_to_string(file).unwrap();
        let few: Vec<&str> = text.lines().take(5).collect();
        let few = scratch.file("few.csv", few.join("\n") + "\n");
        run(&format!("propagate {BODY} --through {few} --every 0.05"))
    };
    let (found, expected) = (between(&inverse), between(&poses));
    assert_eq!((found.code, found.out), (0, expected.out));
    let header = format!("{names},omega_body_x,omega_body_y,omega_body_z");
    let lie = written(&scratch, "lie.csv", WITH_RATES, &header);
    let answer = run(&format!("audit {lie} {BODY}"));
    assert!(answer.code == 1 && answer.err.contains("transposed"), "{answer:?}");
}

#[test]
fn a_torque_needs_the_mass_of_a_mesh() {
    let scratch = Scratch::new("heard-mesh");
    let corner = "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    let mesh = scratch.file("corner.obj", corner);
    let record = written(&scratch, "poses.csv", "t,q", "t,q_w,q_x,q_y,q_z");
    let line = "simulate --omega 1,9,2 --until 1 --every 0.1";
    let says = ["--body", "a mesh file has no mass"];
    for flags in ["--torque 0.1,0,0", "--known-torque 0.1,0,0", "--wheel-momentum 0,0,0.1"] {
        refused(&format!("{line} --body {mesh} {flags}"), &says);
        let answer = run(&format!("{line} --body racket {flags}"));
        assert!(answer.code == 0 && answer.err.contains("ratios of its moments"), "{flags}: {answer:?}");
    }
    refused(&format!("audit {record} --body {mesh} --torque-body 0.1,0,0"), &says);
    let wheel = "--wheel 0,0,1,1e-3@100";
    for line in [
        format!("propagate --body {mesh} --omega 1,2,0.5 {wheel} --times 1"),
        format!("motion --body {mesh} --omega 1,2,0.5 {wheel}"),
        format!("audit {record} --body {mesh} {wheel}"),
    ] {
        refused(&line, &says);
    }
    let rates = written(&scratch, "rates.csv", "t,omega", "t,wx (rad/s),wy (rad/s),wz (rad/s)");
    let sized = run(&format!("fit {rates} --body {mesh}"));
    assert!(sized.code == 2 && sized.err.contains(says[1]), "{sized:?}");
    // what acts in proportion to the body needs no mass
    for body in [mesh.as_str(), "racket"] {
        output(&format!("{line} --body {body} --relative-drag 0.2"));
    }
    let twice =
        scratch.file("twice.obj", "v 0 0 0\nv 4 0 0\nv 0 2 0\nv 0 0 6\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    let moved = |mesh: &str| -> Vec<f64> {
        let orbit = "--gravity-gradient 0.7 --method kick-drift@srkn-6b --step 0.1";
        let line = format!("propagate --body {mesh} --omega 1,2,0.5 {orbit} --times 5 --fields q,omega");
        let answer = run(&line);
        assert_eq!(answer.code, 0, "{answer:?}");
        answer.out.lines().nth(1).unwrap().split(',').map(|cell| cell.parse().unwrap()).collect()
    };
    let (one, other) = (moved(&mesh), moved(&twice));
    assert!(one.len() == 7 && one.iter().zip(&other).all(|(a, b)| (a - b).abs() < 1e-9), "{one:?} {other:?}");
}
