//! `polhode methods --check`: the laws of a method.

use crate::harness::{output, refused, run};

#[test]
fn the_claims_of_a_method_are_rows() {
    let csv = output("methods --check explicit-euler --motion free");
    let mut lines = csv.lines();
    let head =
        "method,motion,law,quantity,claim,measured,half_width,limit,slope,slope_half_width,verdict,why";
    assert_eq!(lines.next(), Some(head));
    let rows: Vec<&str> = lines.collect();
    assert!(rows.iter().all(|row| row.starts_with("explicit-euler,free,")), "{csv}");
    let order = rows.iter().find(|row| row.contains(",order,attitude,1,")).unwrap();
    assert!(order.contains(",holds,"), "{order}");
    assert!(!csv.contains(",time,"), "{csv}");
    let json = output("methods --check explicit-euler --motion free --format json");
    assert_eq!(json.matches("\"law\":").count(), rows.len());
}

#[test]
fn the_page_of_a_method_fits_a_terminal() {
    let text = output("methods --check exact-step --time --format table");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    assert!(text.lines().any(|line| line.starts_with("free      time")), "{text}");
    // it is for free motion, and refuses the others
    assert_eq!(text.matches("takes         method    no ").count(), 5, "{text}");
}

#[test]
fn what_cannot_be_checked_is_refused() {
    refused("methods --check ratle", &["--check: 'ratle'", "did you mean 'rattle'?"]);
    refused("methods --check exact", &["--check: 'exact'", "takes no steps"]);
    refused("methods --check rk4 --motion falling", &["--motion", "'falling'", "free, gravity"]);
    refused("methods --motion free", &["--check"]);
    refused("methods --check rk4 --schemes", &["--schemes"]);
}

#[test]
fn every_method_that_a_run_takes_is_listed() {
    let listed = output("methods");
    let line = "propagate --moments 1,2,3 --omega 0.4,1,-0.3 --times 1 --step 0.1 --method";
    for (name, typed) in [
        ("linearly-implicit-euler", "linearly-implicit-euler"),
        ("dissipating:LOSS", "dissipating:1e-3"),
        ("rattle", "rattle"),
    ] {
        let rows = listed.lines().filter(|row| row.split(',').next() == Some(name));
        assert_eq!(rows.count(), 1, "{name}");
        assert_eq!(run(&format!("{line} {typed}")).code, 0, "{typed}");
    }
    refused("methods --check linearly-implicit-eular", &["did you mean 'linearly-implicit-euler'?"]);
    refused("methods --check dissipating:1e-3", &["--check: 'dissipating:1e-3'", "inner friction"]);
    refused(&format!("{line} dissipating"), &["--method: 'dissipating'", "dissipating:1e-3"]);
    let tolerance = line.replace("--step 0.1", "--tolerance 1e-9");
    refused(&format!("{tolerance} dissipating:1e-3"), &["--tolerance", "does not choose its steps"]);
}
