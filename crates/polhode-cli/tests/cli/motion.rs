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
    refused(&of("--periods 1h,5h --mode sam"), &["--periods: P_psi/P_phi = 5.0", "ratios above 7.56"]);
    refused(&of("--periods 1h --mode sam"), &["--periods", "1 given, 2 needed"]);
    refused(&of("--periods 1h,0h --mode sam"), &["--periods", "not positive"]);
    refused(&of("--periods 1h,10h"), &["--mode"]);
    refused(&of("--periods 1h,10h --mode sam --omega 1,0,0"), &["--periods", "--omega"]);
    refused(&of("--periods 1h,10h --mode tumbling"), &["--mode", "lam, sam"]);
    refused("motion --moments 1,1,2 --periods 1h,10h --mode lam", &["--mode: no long-axis motion"]);
    refused(&of(""), &["--omega: missing", "--periods"]);
}
