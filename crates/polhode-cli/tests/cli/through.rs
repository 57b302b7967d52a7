//! `polhode propagate --through`: the motion between the attitudes of a file.

use crate::harness::{Scratch, output, refused, run};

const BODY: &str = "propagate --moments 1,2,3";

fn columns(text: &str) -> Vec<Vec<f64>> {
    text.lines().skip(1).map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
}

#[test]
fn rows_between_attitudes_are_those_of_the_motion_itself() {
    let scratch = Scratch::new("through");
    let poses = scratch.0.join("poses.csv");
    let (fields, times) = ("--fields t,q,omega --format csv", "--until 12 --every");
    output(&format!("{BODY} --omega 0.4,1,-0.3 {times} 2 --fields t,q --out {}", poses.display()));
    let exact = columns(&output(&format!("{BODY} --omega 0.4,1,-0.3 {times} 0.5 {fields}")));
    let answer = run(&format!("{BODY} --through {} --every 0.5 {fields}", poses.display()));
    assert_eq!(answer.code, 0, "{}", answer.err);
    let found = columns(&answer.out);
    assert_eq!(found.len(), exact.len());
    for (row, exact) in found.iter().zip(&exact) {
        // a quaternion and its opposite are one attitude
        let sign = (1..5).map(|k| row[k] * exact[k]).sum::<f64>().signum();
        for k in 0..8 {
            let value = if (1..5).contains(&k) { row[k] * sign } else { row[k] };
            assert!((value - exact[k]).abs() < 1e-12, "{row:?} {exact:?}");
        }
    }
    let worst = found.iter().map(|row| row[8]).fold(0.0, f64::max);
    assert!(worst > 0.1 && answer.err.contains("spherical linear interpolation differs by up to"), "{worst}");
}

#[test]
fn what_of_a_file_is_not_used_is_told_and_dates_go_with_no_other_epoch() {
    let scratch = Scratch::new("through-heard");
    let poses = scratch.0.join("more.csv").display().to_string();
    output(&format!("{BODY} --omega 0.4,1,-0.3 --until 4 --every 2 --fields t,q,omega,energy --out {poses}"));
    let answer = run(&format!("{BODY} --through {poses} --every 0.5"));
    let says = "more.csv: not read: energy; its angular velocities are not used";
    assert!(answer.code == 0 && answer.err.contains(says), "{answer:?}");
    // the motion has the attitudes of the file, and none of the catalogue
    let racket = "propagate --body racket";
    output(&format!("{racket} --omega 0.4,1,-0.3 --until 4 --every 2 --fields t,q --out {poses}"));
    let answer = run(&format!("{racket} --through {poses} --every 0.5"));
    assert_eq!((answer.code, answer.notes.as_str()), (0, ""), "{answer:?}");
    let rows = "1700000000,0,1,0,0,0\n1700000001,0,0.8,0.6,0,0\n";
    let stamped = scratch.file("stamp.csv", format!("stamp.secs,stamp.nsecs,q_w,q_x,q_y,q_z\n{rows}"));
    let line = format!("{BODY} --through {stamped} --every 0.5 --epoch 2026-01-01 --fields jd,q");
    refused(&line, &["--epoch: the times of", "are s and ns, and t counts from the first of them"]);
}

/// Turns by 1, 1 + d and 1 rad about a principal axis, each in 1 s: between them the rates are those numbers, and jump by d at both rows, and
/// the momentum changes by the share d.
#[test]
fn attitudes_of_no_free_motion_end_with_exit_code_1() {
    let scratch = Scratch::new("through-broken");
    for (jump, code) in [(0.0_f64, 0), (0.05, 0), (0.5, 1)] {
        let turned = [0.0, 1.0, 2.0 + jump, 3.0 + jump];
        let rows = turned.iter().enumerate().map(|(t, angle)| {
            let (sin, cos) = libm::sincos(0.5 * angle);
            format!("{t},{cos},0,0,{sin}\n")
        });
        let poses = scratch.file("poses.csv", format!("t,q_w,q_x,q_y,q_z\n{}", rows.collect::<String>()));
        let answer = run(&format!("{BODY} --through {poses} --every 0.5 --fields t,omega --format csv"));
        assert_eq!((answer.code, answer.out.lines().count()), (code, 8), "{jump}: {}", answer.err);
        let says = format!("the angular velocity jumps by up to {jump:.1e} rad/s at them");
        assert_eq!(answer.err.contains(&says), jump > 0.0, "{jump}: {}", answer.err);
        let word = if code == 1 { "error: --through: these are not" } else { "warning: these are not" };
        assert_eq!(answer.err.contains(word), jump > 0.0, "{jump}: {}", answer.err);
        let says = "and the angular momentum in space changes by up to 50 %";
        assert_eq!(answer.err.contains(says), code == 1, "{jump}: {}", answer.err);
    }
    // dense rows of another body jump less than those of this one with noise, and yet it is another body
    let poses = scratch.0.join("dense.csv").display().to_string();
    let motion = "--omega 0.4,3,-0.3 --until 8 --every 0.05";
    output(&format!("propagate --moments 1,2,2.5 {motion} --fields t,q --out {poses}"));
    let jump = |moments: &str, code: i32| {
        let answer = run(&format!("propagate --moments {moments} --through {poses} --every 0.2 --fields t"));
        assert_eq!(answer.code, code, "{moments}: {}", answer.err);
        let (_, rest) = answer.err.split_once("jumps by up to ").unwrap();
        rest.split_once(' ').unwrap().0.parse::<f64>().unwrap()
    };
    let of_another = jump("1,2,3", 1);
    output(&format!("simulate --moments 1,2,2.5 {motion} --attitude-noise 1e-3 --out {poses}"));
    assert!(jump("1,2,2.5", 0) > of_another);
}

#[test]
fn what_is_no_table_of_attitudes_is_refused() {
    let scratch = Scratch::new("through-refused");
    let refuse = |text: &str, flags: &str, says: &str| {
        let file = scratch.file("poses.csv", text);
        refused(&format!("{BODY} --through {file} --every 0.5 {flags}"), &[says]);
    };
    let two = "t,q_w,q_x,q_y,q_z\n0,1,0,0,0\n1,0.8,0.6,0,0\n";
    refuse("t,q_w,q_x,q_y,q_z\n0,1,0,0,0\n", "", "too few");
    refuse("t,q_w,q_x,q_y,q_z\n0,1,0,0,0\n1,0,0,0,0\n", "", "which is not a rotation");
    refuse("t,wx,wy,wz\n0,1,0,0\n1,0,0,0\n", "", "no quaternions");
    refuse(two, "--turns 0.01", "allow more turns");
    refuse(two, "--omega 1,2,3", "--omega");
    refuse(two, "--drag 0.1", "free bodies");
}
