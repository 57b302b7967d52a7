//! What acts on a body, by its flags: rows, golden refusals, and the column of Jacobi's constant.

use crate::harness::{Scratch, golden, output, polhode, refused, run, words};

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

/// Hyperion moves on the orbit that the catalogue has with it: the same conic by its least distance, in units of the semi-major axis, and
/// the time of that.
#[test]
fn a_body_of_the_catalogue_is_turned_on_its_orbit() {
    let sheet = output("bodies hyperion --format csv");
    let row: Vec<f64> = ["mean_motion", "eccentricity", "mean_anomaly"]
        .map(|name| {
            let at = columns(&sheet).iter().position(|column| *column == name).unwrap();
            // the columns of an orbit are the last ones, behind texts with commas
            let behind = columns(&sheet).len() - at;
            sheet.lines().last().unwrap().rsplit(',').nth(behind - 1).unwrap().parse().unwrap()
        })
        .into();
    let [n, e, anomaly] = row[..] else { panic!("{row:?}") };
    let of = |forces: &str| {
        let line = format!("propagate --body hyperion {forces} --times 20d --fields q --method taylor");
        let text = output(&line);
        let last: Vec<f64> = text.lines().last().unwrap().split(',').map(|x| x.parse().unwrap()).collect();
        last
    };
    let own = of("");
    let typed = of(&format!("--orbit {:e},{:e},{e},{:e}", n * n, 1.0 - e, -anomaly / n));
    let apart = |other: &[f64]| own.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart(&typed) < 1e-10, "{own:?} {typed:?}");
    // its axes are neither the ecliptic nor those of the ICRF
    for (flag, frame) in [("--frame ecliptic", "ecliptic J2000"), ("--to-frame icrf", "ICRF")] {
        let line = format!("propagate --body hyperion --attitude 1,0,0,0 {flag} --times 20d --method taylor");
        refused(&line, &[frame, "the gravity gradient of Saturn acts", "--orbit-plane"]);
    }
    // another orbit takes its place
    assert!(apart(&of(&format!("--gravity-gradient {n:e},{e}"))) > 1e-3);
    let free = output("propagate --moments 0.314,0.474,0.542 --omega 1e-5,2e-6,6e-6 --times 20d --fields q");
    let without = output(
        "propagate --body hyperion --omega 1e-5,2e-6,6e-6 --attitude 1,0,0,0 --gravity-gradient 0 --times 20d --fields q --method taylor",
    );
    for (a, b) in free.lines().last().unwrap().split(',').zip(without.lines().last().unwrap().split(',')) {
        assert!((a.parse::<f64>().unwrap() - b.parse::<f64>().unwrap()).abs() < 1e-12, "{free} {without}");
    }
    let refused = run("propagate --body hyperion --times 20d");
    assert!(refused.err.contains("gravity gradient acts on the body"), "{}", refused.err);
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

#[test]
fn an_orbit_is_read_from_a_table() {
    let scratch = Scratch::new("orbit-table");
    // a circle of radius 2 about a mass with GM = 2
    let rate = 0.5;
    let row = |k: u32| {
        let (sin, cos) = libm::sincos(rate * f64::from(k) * 0.25);
        format!("{:?},{:?},{:?},0\n", 0.25 * f64::from(k), 2.0 * cos, 2.0 * sin)
    };
    let rows: String = (0..=80).map(row).collect();
    scratch.file("circle.csv", format!("# places of an ephemeris\nt,x,y,z\n{rows}"));
    let motion =
        "propagate --moments 1,2,2.5 --omega 0.3,1,-0.4 --method rk8 --step 0.0625 --times 20 --fields q";
    let of = |flags: &str| {
        let answer = polhode(&words(&format!("{motion} {flags}")), &scratch.0);
        assert_eq!(answer.code, 0, "{}", answer.err);
        let row = answer.out.lines().nth(1).unwrap().to_owned();
        (row.split(',').map(|cell| cell.parse().unwrap()).collect::<Vec<f64>>(), answer.err)
    };
    let (table, note) = of("--orbit-table circle.csv --gm 2");
    let (conic, _) = of("--orbit 2,2,0");
    for (a, b) in table.iter().zip(&conic) {
        assert!((a - b).abs() < 1e-8, "{table:?} {conic:?}");
    }
    assert!(note.contains("circle.csv: from 0.0 s to 20.0 s") && note.contains("of the distance"), "{note}");
    let mut told = String::new();
    scratch.file("few.csv", "t,x,y,z\n0,1,0,0\n1,1,1,0\n");
    scratch.file("named.csv", "time,x,y,z\n0,1,0,0\n");
    scratch.file("ragged.csv", "t,x,y,z\n0,1,0\n");
    scratch.file("wrong.csv", "t,x,y,z\n0,1,0,up\n");
    for flags in [
        "--orbit-table circle.csv",
        "--gm 2",
        "--orbit-table circle.csv --gm -2",
        "--orbit-table circle.csv --gm 2 --orbit 2,2,0",
        "--orbit-table absent.csv --gm 2",
        "--orbit-table few.csv --gm 2",
        "--orbit-table named.csv --gm 2",
        "--orbit-table ragged.csv --gm 2",
        "--orbit-table wrong.csv --gm 2",
    ] {
        let answer = polhode(&words(&format!("{motion} {flags}")), &scratch.0);
        assert_eq!((answer.code, answer.out.as_str()), (2, ""), "{flags}: {}", answer.err);
        told += &format!("$ polhode propagate ... {flags}\n{}\n", answer.err);
    }
    golden("orbit-table.txt", &told);
    // beyond the table there is no force
    let late = motion.replace("--times 20", "--times 25");
    let answer = polhode(&words(&format!("{late} --orbit-table circle.csv --gm 2")), &scratch.0);
    assert_eq!(answer.code, 1, "{}", answer.err);
    assert!(answer.err.contains("gravity gradient"), "{}", answer.err);
}
