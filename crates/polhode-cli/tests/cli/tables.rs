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
            let (verdict, reading) = (&json()["verdict"], &json()["reading"]);
            let part = |key: &str| reading[key].as_str().unwrap_or("-").to_string();
            let parts = ["quaternion", "attitude", "omega_frame", "rate_unit"].map(part);
            format!("{} {}", verdict.as_str().unwrap_or_default(), parts.join(" "))
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
            "line 1: columns 6 and 7 have this one name",
            false,
        ),
        (
            "two times",
            with("t,qw,qx,qy,qz,wx,wy,wz").replace("t,qw", "t,t"),
            "line 1: columns 1 and 2 have this one name",
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
            "line 1, column 1 (Packet number): counts samples and is no time",
            false,
        ),
        (
            "an unknown unit",
            with("t,qw,qx,qy,qz,wx (mph),wy,wz"),
            "line 1, column 6 (wx (mph)): 'mph': no unit that is known here",
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
