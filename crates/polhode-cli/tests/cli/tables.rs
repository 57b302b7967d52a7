//! One file of each kind through every command that reads tables: the same columns, the same convention, the same refusal.

use std::fmt::Write as _;

use serde_json::Value;

use crate::harness::{Answer, Scratch, output, run};

const BODY: &str = "--moments 1,2,3";
const START: &str = "--omega 0.4,1,-0.3 --attitude 0.9,0.1,-0.3,0.2";
const COMMANDS: [&str; 4] = ["audit", "compare", "fit", "propagate"];

/// t, q (w, x, y, z) and ω in body axes of the true motion.
fn rows() -> Vec<Vec<f64>> {
    let text =
        output(&format!("propagate {BODY} {START} --until 10 --every 0.05 --fields t,q,omega --format csv"));
    text.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
}

/// A text with a header and a row of each state.
fn table(header: &str, delimiter: &str, row: impl Fn(&[f64]) -> Vec<f64>) -> String {
    let mut text = format!("{header}\n");
    for state in rows() {
        let cells: Vec<String> = row(&state).iter().map(|x| format!("{x:?}")).collect();
        let _ = writeln!(text, "{}", cells.join(delimiter));
    }
    text
}

/// What a command makes of a file: what it has read, or its refusal from the line on, without what to do.
fn outcome(command: &str, file: &str, flags: &str) -> String {
    let line = match command {
        "audit" => format!("audit {file} {BODY} --format json {flags}"),
        "compare" => format!(
            "compare {BODY} {START} --until 10 --methods rk4 --steps 0.5 --format csv --trajectory {file} {flags}"
        ),
        "fit" => format!("fit {file} --format json {flags}"),
        _ => format!("propagate {BODY} {START} --format csv --times {file}"),
    };
    let Answer { code, out, err, .. } = run(&line);
    if code == 2 {
        let message = err.replace(&format!("--times: {file}"), "").replace(file, "");
        let message = message.trim().trim_start_matches("error: ").trim_start_matches([',', ':', ' ']);
        return format!("refused: {}", message.split("; ").next().unwrap_or_default());
    }
    let json = || serde_json::from_str::<Value>(&out).unwrap_or_default();
    match command {
        "audit" => {
            let found = json();
            let told = |found: &Value| {
                let (verdict, reading) = (&found["verdict"], &found["reading"]);
                let part = |key: &str| reading[key].as_str().unwrap_or("-").to_string();
                let parts = ["quaternion", "attitude", "omega_frame", "rate_unit"].map(part);
                format!("{} {}", verdict.as_str().unwrap_or_default(), parts.join(" "))
            };
            match found.as_array().map(Vec::as_slice) {
                None => told(&found),
                Some([first, second]) if told(first) == told(second) => {
                    let name = |found: &Value| found["id"].as_str().unwrap_or("-").replace(".0", "");
                    format!("{} and {}: {}", name(first), name(second), told(first))
                }
                Some(_) => found.to_string(),
            }
        }
        "compare" => {
            let lines: Vec<Vec<&str>> = out.lines().map(|line| line.split(',').collect()).collect();
            let cell = |name: &str| {
                let place = lines[0].iter().position(|column| *column == name).unwrap();
                lines[2][place]
            };
            let error = cell("attitude_error").parse::<f64>().unwrap_or(9.0);
            if error < 1e-6 { "right".into() } else { format!("{} {error:e}", cell("status")) }
        }
        "fit" if code == 0 => format!("{} samples", json()["samples"]),
        "fit" => format!("exit {code}"),
        _ => format!("{} times", out.lines().count() - 1),
    }
}

/// Kinds by commands as a table, for a message.
fn shown(outcomes: &[(&str, [String; 4])]) -> String {
    let mut text = format!("\n{:<34} | {}\n", "", COMMANDS.join(" | "));
    for (kind, row) in outcomes {
        let _ = writeln!(text, "{kind:<34} | {}", row.join(" | "));
    }
    text
}

fn outcomes(scratch: &Scratch, kind: &str, text: &str, flags: &str) -> [String; 4] {
    let name: String = kind.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
    let file = scratch.file(&format!("{name}.csv"), text);
    COMMANDS.map(|command| outcome(command, &file, flags))
}

#[test]
fn what_one_command_reads_every_command_reads() {
    let scratch = Scratch::new("tables-kinds");
    let own = |r: &[f64]| r.to_vec();
    let last = |r: &[f64]| vec![r[0], r[2], r[3], r[4], r[1], r[5], r[6], r[7]];
    let inverse = |r: &[f64]| vec![r[0], r[1], -r[2], -r[3], -r[4], r[5], r[6], r[7]];
    let degrees = |r: &[f64]| {
        let rate = |k: usize| r[k].to_degrees();
        vec![1e3 * r[0], r[1], r[2], r[3], r[4], rate(5), rate(6), rate(7)]
    };
    let sigma = |r: &[f64]| {
        let sign = if r[1] < 0.0 { -1.0 } else { 1.0 };
        let s = |k: usize| sign * r[k] / (1.0 + sign * r[1]);
        vec![r[0], s(2), s(3), s(4), r[5], r[6], r[7]]
    };
    let joint =
        |r: &[f64]| vec![r[0], 0.5, 0.1, 2.0, r[1], r[2], r[3], r[4], 0.0, 0.1, 0.2, r[5], r[6], r[7]];
    let numbers = |stem: &str, count: usize| (0..count).map(|k| format!(",{stem}{k}")).collect::<String>();
    let mujoco = format!("time{}{}", numbers("qpos", 7), numbers("qvel", 6));
    let decimal =
        table("time (ms);qw;qx;qy;qz;wx (deg/s);wy (deg/s);wz (deg/s)", ";", degrees).replace('.', ",");
    let nanoseconds = |r: &[f64]| [vec![(r[0] * 1e9).round()], r[5..8].to_vec(), r[1..5].to_vec()].concat();
    let read = ["right wxyz body-to-space body rad/s", "right", "201 samples", "201 times"];
    let kinds: [(&str, String, &str, [&str; 4]); 10] = [
        ("polhode", table("t,q_w,q_x,q_y,q_z,omega_body_x,omega_body_y,omega_body_z", ",", own), "", read),
        (
            "numbered, scalar last",
            table("t,q0,q1,q2,q3,wx,wy,wz", ",", last),
            "",
            ["right xyzw body-to-space body rad/s", read[1], read[2], read[3]],
        ),
        ("numbered, scalar first", table("t,q1,q2,q3,q4,wx,wy,wz", ",", own), "", read),
        (
            "space to body",
            table("t,qw,qx,qy,qz,wx,wy,wz", ",", inverse),
            "",
            ["right wxyz space-to-body body rad/s", read[1], read[2], read[3]],
        ),
        (
            "ms and deg/s, decimal commas",
            decimal,
            "",
            ["right wxyz body-to-space body deg/s", read[1], read[2], read[3]],
        ),
        ("numpy, header in a comment", table("# t w x y z wx wy wz", " ", own), "", read),
        (
            "Basilisk",
            table("time,sigma_BN_1,sigma_BN_2,sigma_BN_3,omega_BN_B_1,omega_BN_B_2,omega_BN_B_3", ",", sigma),
            "",
            ["right - body-to-space body rad/s", read[1], read[2], read[3]],
        ),
        ("MuJoCo", table(&mujoco, ",", joint), "", read),
        (
            "EuRoC",
            table(
                "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []",
                ",",
                nanoseconds,
            ),
            "",
            read,
        ),
        (
            "counter with its rate",
            table("Counter,qw,qx,qy,qz,gyr_x,gyr_y,gyr_z", ",", |r| {
                [vec![(20.0 * r[0]).round()], r[1..].to_vec()].concat()
            }),
            "--sample-rate 20",
            [read[0], read[1], read[2], "refused: line 1: no column for time"],
        ),
    ];
    let mut found: Vec<(&str, [String; 4])> = Vec::new();
    let mut expected: Vec<(&str, [String; 4])> = Vec::new();
    for (kind, text, flags, says) in &kinds {
        let short = |text: String| {
            text.split(", the header").next().unwrap().split("; the header").next().unwrap().to_string()
        };
        found.push((kind, outcomes(&scratch, kind, text, flags).map(short)));
        expected.push((kind, says.map(String::from)));
    }
    assert!(found == expected, "found:{}expected:{}", shown(&found), shown(&expected));
}

/// The entries of the rotation matrix of a quaternion w, x, y, z, by rows.
fn matrix(q: &[f64]) -> [f64; 9] {
    let (w, x, y, z) = (q[0], q[1], q[2], q[3]);
    [
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
}

/// φ, θ, ψ of R_z(φ) R_x(θ) R_z(ψ).
fn euler(q: &[f64]) -> [f64; 3] {
    let r = matrix(q);
    [r[2].atan2(-r[5]), r[8].acos(), r[6].atan2(r[7])]
}

/// A dump of LAMMPS with the time of each block; L = m in space.
fn dump() -> String {
    let mut text = String::new();
    for (k, r) in rows().iter().enumerate() {
        let (m, e) = ([r[5], 2.0 * r[6], 3.0 * r[7]], matrix(&r[1..5]));
        let l = [0, 1, 2].map(|i| e[3 * i] * m[0] + e[3 * i + 1] * m[1] + e[3 * i + 2] * m[2]);
        let _ = write!(
            text,
            "ITEM: TIME\n{:?}\nITEM: TIMESTEP\n{k}\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n-1 1\n-1 1\n-1 1\n\
             ITEM: ATOMS id c_q[1] c_q[2] c_q[3] c_q[4] angmomx angmomy angmomz\n\
             1 {:?} {:?} {:?} {:?} {:?} {:?} {:?}\n",
            r[0], r[1], r[2], r[3], r[4], l[0], l[1], l[2]
        );
    }
    text
}

/// Messages as `rostopic echo` prints them.
fn messages() -> String {
    let mut text = String::new();
    for r in rows() {
        let nanoseconds = (r[0] * 1e9).round() as u64;
        let _ = write!(
            text,
            "header:\n  seq: 1\n  stamp:\n    secs: {}\n    nsecs: {}\n  frame_id: \"imu\"\norientation:\n  x: {:?}\n  y: {:?}\n  \
             z: {:?}\n  w: {:?}\norientation_covariance: [0.0]\nangular_velocity:\n  x: {:?}\n  y: {:?}\n  z: {:?}\n---\n",
            nanoseconds / 1_000_000_000,
            nanoseconds % 1_000_000_000,
            r[2],
            r[3],
            r[4],
            r[1],
            r[5],
            r[6],
            r[7]
        );
    }
    text
}

#[test]
fn layouts_that_are_no_plain_rows_are_read_alike_too() {
    let scratch = Scratch::new("tables-layouts");
    let entries = |r: &[f64]| [vec![r[0]], matrix(&r[1..5]).to_vec(), r[5..8].to_vec()].concat();
    let angles = |r: &[f64]| [vec![r[0]], euler(&r[1..5]).to_vec(), r[5..8].to_vec()].concat();
    let named = |r: &[f64]| [vec![r[0], 7.0], r[1..8].to_vec()].concat();
    let two = |text: String| {
        let mut lines = text.lines().map(String::from);
        let head = lines.next().unwrap_or_default() + "\n";
        lines.fold(head, |text, line| text + &line + "\n" + &line.replacen(",7.0,", ",8.0,", 1) + "\n")
    };
    let read = ["right wxyz body-to-space body rad/s", "right", "201 samples", "201 times"];
    let turned = ["right - body-to-space body rad/s", read[1], read[2], read[3]];
    let ids = table("t,id,qw,qx,qy,qz,wx,wy,wz", ",", named);
    let kinds: [(&str, String, &str, [&str; 4]); 6] = [
        ("matrices", table("t,r11,r12,r13,r21,r22,r23,r31,r32,r33,wx,wy,wz", ",", entries), "", turned),
        ("Euler angles", table("t,phi,theta,psi,wx,wy,wz", ",", angles), "", turned),
        ("ids", ids.clone(), "", read),
        // a record is of one body, and each row has a time
        (
            "two bodies",
            two(ids),
            "",
            [
                "7 and 8: right wxyz body-to-space body rad/s",
                "refused: has 2 bodies",
                "refused: line 4, column 2 (id): '7.0': rows of '8.0' lie between rows of this body",
                "402 times",
            ],
        ),
        // a dump holds no angular velocity: its attitudes are fitted
        ("LAMMPS", dump(), "", ["right wxyz body-to-space - -", read[1], read[2], read[3]]),
        ("ROS", messages(), "", read),
    ];
    let mut found: Vec<(&str, [String; 4])> = Vec::new();
    let mut expected: Vec<(&str, [String; 4])> = Vec::new();
    for (kind, text, flags, says) in &kinds {
        let short = |text: String| text.split("; the header").next().unwrap().to_string();
        found.push((kind, outcomes(&scratch, kind, text, flags).map(short)));
        expected.push((kind, says.map(String::from)));
    }
    assert!(found == expected, "found:{}expected:{}", shown(&found), shown(&expected));
}

#[test]
fn what_one_command_refuses_every_command_refuses_in_the_same_words() {
    let scratch = Scratch::new("tables-refusals");
    let good = table("t,qw,qx,qy,qz,wx,wy,wz", ",", <[f64]>::to_vec);
    let good: Vec<&str> = good.lines().take(13).collect();
    let whole = good.join("\n") + "\n";
    let with = |header: &str| format!("{header}\n{}\n", good[1..].join("\n"));
    let row = |change: &dyn Fn(&str) -> String| {
        let mut lines: Vec<String> = good.iter().map(ToString::to_string).collect();
        lines[5] = change(&lines[5]);
        lines.join("\n") + "\n"
    };
    // the last: whether the times of the file are refused, too
    let kinds: [(&str, String, &str, bool); 8] = [
        (
            "two columns of one name",
            with("t,qw,qx,qy,qz,wx,wx,wz"),
            "line 1: columns 6 and 7 both have this name",
            false,
        ),
        (
            "two times",
            with("t,qw,qx,qy,qz,wx,wy,wz").replace("t,qw", "t,t"),
            "line 1: columns 1 and 2 both have this name",
            true,
        ),
        (
            "mixed delimiters",
            row(&|line| line.replace(',', ";")),
            "line 6: cells separated by semicolons where the header has commas",
            true,
        ),
        (
            "a row longer than its header",
            row(&|line| format!("{line},7")),
            "line 6: 9 cells where the header has 8",
            true,
        ),
        (
            "torn",
            whole.trim_end().rsplit_once(',').unwrap().0.to_string(),
            "line 13: the file ends in the middle of this row",
            true,
        ),
        (
            "a counter in place of time",
            with("Packet number,qw,qx,qy,qz,wx,wy,wz"),
            "line 1, column 1 (Packet number): counts samples and is not a time",
            false,
        ),
        (
            "an unknown unit",
            with("t,qw,qx,qy,qz,wx (mph),wy,wz"),
            "line 1, column 6 (wx (mph)): 'mph': unknown unit",
            false,
        ),
        (
            "a text in place of a number",
            row(&|line| format!("zero,{}", line.split_once(',').unwrap().1)),
            "line 6, column 1 (t): 'zero': is not a number",
            true,
        ),
    ];
    let mut found: Vec<(&str, [String; 4])> = Vec::new();
    let mut expected: Vec<(&str, [String; 4])> = Vec::new();
    for (kind, text, says, times_too) in &kinds {
        let mut row = outcomes(&scratch, kind, text, "");
        let says = format!("refused: {says}");
        if !times_too {
            row[3].clone_from(&says);
        }
        found.push((kind, row));
        expected.push((kind, [0; 4].map(|_| says.clone())));
    }
    assert!(found == expected, "found:{}expected:{}", shown(&found), shown(&expected));
}
