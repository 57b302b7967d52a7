//! `polhode motion`: readings of a free motion, and starts by periods.

use crate::harness::{golden, output, refused};

/// The cells of the only row, by name.
fn cell(text: &str, name: &str) -> String {
    let (head, row) = text.trim_end().split_once('\n').unwrap();
    let place = head.split(',').position(|found| found == name).unwrap();
    row.split(',').nth(place).unwrap().into()
}

fn number(text: &str, name: &str) -> f64 {
    cell(text, name).parse().unwrap()
}

#[test]
fn the_sheet_has_the_names_of_the_field() {
    let sheet = output("motion --body toutatis --format table");
    golden("motion-toutatis.txt", &sheet);
    for (symbol, days) in [("P_psi", "5.38"), ("P_phi", "7.39")] {
        let line = sheet.lines().find(|line| line.contains(symbol)).unwrap();
        assert!(line.contains(days), "{line}");
    }
    golden("motion-middle.txt", &output("motion --moments 1,2,3 --omega 0,1,0 --format table"));
}

#[test]
fn a_steady_spin_names_its_axis_and_its_growth() {
    let of = |flags: &str| output(&format!("motion {flags}"));
    let middle = of("--moments 1,2,3 --omega 0,-1,0");
    assert_eq!((cell(&middle, "axis"), cell(&middle, "stability")), ("middle".into(), "unstable".into()));
    assert_eq!(number(&middle, "axis_y"), -1.0);
    assert!((number(&middle, "growth_rate") - 1.0 / 3_f64.sqrt()).abs() < 1e-15);
    let short = of("--moments 1,2,3 --omega 0,0,1");
    assert_eq!((cell(&short, "axis"), cell(&short, "stability")), ("short".into(), "stable".into()));
    let sphere = of("--moments 1,1,1 --omega 0,0,1");
    assert_eq!((cell(&sphere, "axis"), cell(&sphere, "stability")), ("any".into(), "neutral".into()));
    // the modulus of a symmetric body is zero without a sign
    assert_eq!(cell(&of("--moments 1,1,2 --omega 0.3,0,1"), "modulus"), "0.0");
}

#[test]
fn periods_make_a_start_and_come_back() {
    let flags = "--moments 0.61,0.965,1 --periods 27.38h,263h --mode sam --pole 250,-75 --phases 152,14 --angle-unit deg";
    let text = output(&format!("motion {flags}"));
    for (name, expected) in [
        ("precession_period", 27.38 * 3600.0),
        ("polhode_period", 263.0 * 3600.0),
        ("lambda", 250_f64.to_radians()),
        ("beta", -75_f64.to_radians()),
        ("phi", 152_f64.to_radians()),
        ("psi", 14_f64.to_radians()),
    ] {
        assert!((number(&text, name) / expected - 1.0).abs() < 1e-12, "{name}: {text}");
    }
    assert!((number(&text, "combined_period") / 3600.0 - 30.56).abs() < 0.01, "{text}");
    // what motion prints is a start for propagate
    let start = |names: [&str; 4]| names.map(|name| cell(&text, name)).join(",");
    let omega = ["omega_body_x", "omega_body_y", "omega_body_z"].map(|name| cell(&text, name)).join(",");
    let q = start(["q_w", "q_x", "q_y", "q_z"]);
    let typed = output(&format!(
        "propagate --moments 0.61,0.965,1 --omega {omega} --attitude {q} --times 30d --fields q"
    ));
    let named = output(&format!("propagate {flags} --times 30d --fields q"));
    let cells = |text: &str| {
        text.lines().nth(1).unwrap().split(',').map(|x| x.parse().unwrap()).collect::<Vec<f64>>()
    };
    for (a, b) in cells(&typed).into_iter().zip(cells(&named)) {
        assert!((a - b).abs() < 1e-12, "{typed}{named}");
    }
}

#[test]
fn periods_without_a_motion_are_refused() {
    let of = |flags: &str| format!("motion --moments 0.61,0.965,1 {flags}");
    refused(&of("--periods 1h,5h --mode sam"), &["--periods: P_psi/P_phi = 5.0", "must be above 7.56"]);
    refused(&of("--periods 1h --mode sam"), &["--periods", "1 given, 2 needed"]);
    refused(&of("--periods 1h,0h --mode sam"), &["--periods", "not positive"]);
    refused(&of("--periods 1h,10h"), &["--mode"]);
    refused(&of("--periods 1h,10h --mode sam --omega 1,0,0"), &["--periods", "--omega"]);
    refused(&of("--periods 1h,10h --mode sam --pole 250,-75"), &["--pole: the latitude -75.0", "deg"]);
    refused(&of("--periods 1h,10h --mode sam --pole 10,95 --angle-unit deg"), &["--pole: the latitude 95.0"]);
    refused(&of("--periods 1h,10h --mode tumbling"), &["--mode", "lam, sam"]);
    refused("motion --moments 1,1,2 --periods 1h,10h --mode lam", &["--mode: no long-axis motion"]);
    refused(&of(""), &["--omega: missing", "--periods"]);
}

#[test]
fn a_unit_or_a_sequence_of_angles_that_none_are_given_in_is_refused() {
    let start = "--moments 1,2,3 --omega 0.4,1,-0.3";
    for command in
        ["motion", "compare --until 1 --methods rk4 --steps 0.1", "plot omega --until 1 --out a.svg"]
    {
        refused(&format!("{command} {start} --angle-unit deg"), &["--angle-unit: 'deg'", "--rate-unit"]);
        refused(&format!("{command} {start} --euler zyx"), &["--euler: 'zyx'", "give --angles"]);
    }
    refused(&format!("propagate {start} --times 0 --angle-unit deg"), &["--angle-unit", "none are given"]);
    let periods = "--moments 0.61,0.965,1 --periods 27.38h,263h --mode sam";
    refused(&format!("motion {periods} --angle-unit deg"), &["--angle-unit", "none are given"]);
    // which are of use beside angles, or where the command prints them
    output(&format!("motion {start} --angles 10,20,30 --euler zyx --angle-unit deg"));
    output(&format!("propagate {start} --times 0 --euler zyx"));
}

#[test]
fn any_two_of_three_periods_are_a_start() {
    let of = |periods: &str| {
        let text = output(&format!("motion --moments 0.61,0.965,1 --mode sam --periods {periods}"));
        ["precession_period", "polhode_period", "combined_period"].map(|name| number(&text, name) / 3600.0)
    };
    let [precession, rotation, combined] = of("27.38h,263h");
    for (periods, expected) in [
        (format!("P_phi={precession:?}h,P_1={combined:?}h"), [precession, rotation, combined]),
        (format!("P_psi={rotation:?}h,P_1={combined:?}h"), [precession, rotation, combined]),
        ("p_psi=263h,p_phi=27.38h".into(), [precession, rotation, combined]),
    ] {
        for (found, expected) in of(&periods).into_iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 1e-11, "{periods}: {found} for {expected}");
        }
    }
    let of = |periods: &str| format!("motion --moments 0.61,0.965,1 --mode sam --periods {periods}");
    refused(&of("P_1=30h,27h"), &["--periods", "name both periods or none"]);
    refused(&of("P_2=30h,P_psi=263h"), &["--periods", "unknown period 'P_2'"]);
    refused(&of("P_1=30h,P_1=263h"), &["--periods", "P_1 is given twice"]);
    refused(&of("P_1=20h,P_phi=27h"), &["--periods: P_1 = ", "1/P_1 = 1/P_phi - 1/P_psi"]);
}

#[test]
fn a_start_is_turned_from_the_ecliptic_to_the_equator() {
    let motion = "motion --moments 0.61,0.965,1 --periods 27.38h,263h --mode sam --angle-unit deg";
    // the pole of the ecliptic: right ascension 18 h, declination the complement of the obliquity
    let text = output(&format!("{motion} --pole 0,90 --frame ecliptic --to-frame icrf"));
    assert_eq!(cell(&text, "frame"), "ICRF");
    let (longitude, latitude) = (number(&text, "lambda").to_degrees(), number(&text, "beta").to_degrees());
    assert!(
        (longitude - 270.0).abs() < 1e-9 && (latitude - 66.560_708_9).abs() < 1e-7,
        "{longitude} {latitude}"
    );
    // there and back, and the catalogue knows its frame
    let toutatis = output("motion --body toutatis");
    let turned = output("motion --body toutatis --to-frame icrf");
    let angles = format!("{},{}", cell(&turned, "lambda"), cell(&turned, "beta"));
    let periods = format!("{},{}", cell(&turned, "precession_period"), cell(&turned, "polhode_period"));
    let back = output(&format!(
        "motion --body toutatis --periods {periods} --mode lam --pole {angles} --frame icrf --to-frame ecliptic"
    ));
    for name in ["lambda", "beta"] {
        assert!((number(&back, name) - number(&toutatis, name)).abs() < 1e-12, "{name}");
    }
    refused("motion --body phone --to-frame icrf", &["--to-frame", "needs the axes", "--frame"]);
    refused("motion --body toutatis --frame icrf", &["--frame", "ecliptic J2000", "--to-frame"]);
    refused("motion --body toutatis --frame equator", &["--frame", "unknown frame 'equator'"]);
}
