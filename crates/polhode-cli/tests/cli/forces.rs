//! What acts on a body, by its flags: rows, golden refusals, and the column of Jacobi's constant.

use crate::harness::{golden, output, run};

const BODY: &str = "propagate --moments 1,2,2.5 --omega 0.3,1,-0.4";

fn columns(text: &str) -> Vec<&str> {
    text.lines().next().unwrap().split(',').collect()
}

fn cell<'a>(text: &'a str, column: &str) -> &'a str {
    let at = columns(text).iter().position(|name| *name == column).unwrap();
    text.lines().last().unwrap().split(',').nth(at).unwrap()
}

#[test]
fn errors_are_filled_where_the_forces_conserve_their_quantity() {
    let of = |forces: &str| output(&format!("{BODY} {forces} --method rk4 --step 0.01 --until 1 --every 1"));
    for (forces, energy, momentum, vertical) in [
        ("", true, true, false),
        ("--weight-moment 0.1,0,0.2", true, false, true),
        ("--drag 0.1", false, false, false),
        ("--torque-body 0.1,0,0 --torque-space 0,0,0.1", false, false, false),
        ("--gravity-gradient 0.5,0.2", false, false, false),
        ("--gravity-gradient 0.5 --orbit-plane 0deg,60deg,0deg", false, false, false),
        ("--orbit 2,1.5,4.25", false, false, false),
    ] {
        let text = of(forces);
        assert!(!columns(&text).contains(&"jacobi_error"), "{forces}");
        for (column, filled) in [
            ("energy_error", energy),
            ("momentum_error", momentum),
            ("momentum_vector_error", momentum),
            ("momentum_z_error", vertical),
        ] {
            assert_eq!(!cell(&text, column).is_empty(), filled, "{forces}: {column}");
        }
    }
    let text = of("--gravity-gradient 0.5");
    assert_eq!(columns(&text).last(), Some(&"jacobi_error"));
    assert!(cell(&text, "jacobi_error").parse::<f64>().unwrap() < 1e-8);
    assert_eq!(cell(&text, "energy_error"), "");
}

#[test]
fn motions_under_forces_are_the_golden_ones() {
    let line = |forces: &str, method: &str| {
        output(&format!("{BODY} {forces} --method {method} --step 0.125 --start-time 1 --times 1,2,9"))
    };
    golden("gravity-gradient.csv", &line("--gravity-gradient 0.5", "kick-drift@srkn-6b"));
    golden("elliptic.csv", &line("--gravity-gradient 0.5,0.3", "lie-poisson@kahan-li-6"));
    // a flyby: the closest distance is passed between the first and the second row
    let flyby = "--orbit 2,1.5,4.25,1.5 --orbit-plane 0.4rad,0.9rad,-1.3rad";
    golden("flyby.csv", &line(flyby, "kick-drift@srkn-6b"));
    golden("drag.csv", &line("--drag 0.1,0.2 --torque-space 0.1,0,0", "implicit-midpoint"));
}

#[test]
fn schemes_are_listed() {
    golden("schemes.csv", &output("methods --schemes"));
}

#[test]
fn every_unusable_force_or_scheme_is_refused_with_value_rule_and_remedy() {
    let mut told = String::new();
    let stepped = "--step 0.1 --times 1";
    for flags in [
        format!("--drag -0.1 --method rk4 {stepped}"),
        format!("--drag 0.1,0.2,0.3 --method rk4 {stepped}"),
        format!("--drag 0.1 --method lie-poisson {stepped}"),
        "--drag 0.1 --times 1".into(),
        format!("--gravity-gradient 0.5,1 --method rk4 {stepped}"),
        format!("--gravity-gradient 0.5,-0.1 --method rk4 {stepped}"),
        "--gravity-gradient 0.5 --times 1".into(),
        format!("--orbit 3.986e14,0,4.2 --method rk4 {stepped}"),
        format!("--orbit 3.986e14,3.8e7,-0.1 --method rk4 {stepped}"),
        format!("--orbit 3.986e14,3.8e7 --method rk4 {stepped}"),
        format!("--orbit 1e300,1e-300,1 --method rk4 {stepped}"),
        format!("--orbit 3.986e14,3.8e7,4.2 --gravity-gradient 0.5 --method rk4 {stepped}"),
        format!("--orbit-plane 0deg,60deg,0deg --method rk4 {stepped}"),
        format!("--orbit 3.986e14,3.8e7,4.2 --orbit-plane 0,60,0 --method rk4 {stepped}"),
        format!("--orbit 3.986e14,3.8e7,4.2 --orbit-plane 0deg,60deg --method rk4 {stepped}"),
        format!("--torque-body 1,nan,0 --method rk4 {stepped}"),
        format!("--torque-space 1,2 --method rk4 {stepped}"),
        format!("--method kick-drift@suzuki-5 {stepped}"),
        format!("--method kick-drift@ {stepped}"),
        format!("--method rk4@suzuki-4 {stepped}"),
        format!("--method rattle@srkn-6b {stepped}"),
        format!("--method implicit-midpoint@blanes-moan-s6 {stepped}"),
        format!("--method kick-drift:6 {stepped}"),
        format!("--method kick-drift:4@suzuki-4 {stepped}"),
        format!("--method lie-poisson:322@suzuki-4 {stepped}"),
        format!("--method exact@suzuki-4 {stepped}"),
    ] {
        let line = format!("{BODY} {flags}");
        let answer = run(&line);
        assert_eq!((answer.code, answer.out.as_str()), (2, ""), "{line}: {}", answer.err);
        told += &format!("{flags}\n  {}\n", answer.err.trim_end().replace('\n', "\n  "));
    }
    golden("force-refusals.txt", &told);
}
