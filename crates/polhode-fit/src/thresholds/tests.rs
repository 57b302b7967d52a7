//! What holds of the table of thresholds.

use super::*;
use std::path::Path;

/// Constants that are no thresholds: sizes of arrays, coefficients and counts of a formula, the law itself.
const NO_THRESHOLDS: &[&str] = &[
    "alternatives FURTHER",
    "alternatives WIDTH",
    "banded PIVOTS",
    "banded REGISTER",
    "banded WIDEST",
    "blocks TOGETHER",
    "coordinates HALF_ROOT",
    "coordinates SIXTH_ROOT",
    "covariance ROOM",
    "covariance ROWS",
    "dynamics ALL",
    "dynamics SHARED",
    "equations LOCAL",
    "equations OTHERS",
    "equations UNKNOWNS",
    "free_body UNKNOWNS",
    "growth MEDIAN",
    "invariants ROOT",
    "law LARGEST_SHARE",
    "levels SHARE",
    "moments TOGETHER",
    "moments WITH_SLOPE",
    "moments WITH_VALUE",
    "product DEGREE",
    "sums FEATURES",
    "sums REST",
    "test_functions LANES",
    "test_functions MOST",
    "test_functions PARTS",
    "test_functions SUMS",
    "track ALL",
    "track COMMON",
    "track OWN",
    "weighed FARTHEST",
    "wheels OWN",
    "zeros PAGE",
];

fn sources(folder: &Path, found: &mut Vec<std::path::PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() { sources(&path, found) } else { found.push(path) }
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn no_threshold_stands_outside_of_the_table() {
    let mut files = Vec::new();
    sources(&root().join("src"), &mut files);
    let mut found = Vec::new();
    for file in files.iter().filter(|f| !f.ends_with("thresholds.rs") && !f.ends_with("tests.rs")) {
        let text = std::fs::read_to_string(file).unwrap();
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap();
        for line in code.lines().map(str::trim_start) {
            let Some((before, after)) = line.split_once("const ") else { continue };
            let Some((name, kind)) = after.split_once(": ") else { continue };
            let number = ["f64", "usize", "[f64", "[(f64"].iter().any(|k| kind.starts_with(k));
            let number = number && name.len() > 1 && !name.contains(char::is_lowercase);
            if number && (before.is_empty() || before.starts_with("pub")) {
                found.push(format!("{} {name}", file.file_stem().unwrap().to_string_lossy()));
            }
        }
    }
    found.sort();
    assert_eq!(found, NO_THRESHOLDS, "a threshold belongs into the table of thresholds.rs");
}

#[test]
fn sources_of_thresholds_are_tests_of_this_crate() {
    let mut files = Vec::new();
    sources(&root().join("src"), &mut files);
    sources(&root().join("tests"), &mut files);
    let text: String = files
        .iter()
        .filter(|f| f.extension().is_some_and(|e| e == "rs") && !f.ends_with("thresholds.rs"))
        .map(|f| std::fs::read_to_string(f).unwrap())
        .collect();
    for row in TABLE.iter().filter(|row| ![UNMEASURED, DERIVED].contains(&row.source)) {
        assert!(text.contains(&format!("fn {}(", row.source)), "{}::{}: {}", row.place, row.name, row.source);
    }
}

/// The page thresholds.md is this table; `POLHODE_BLESS=1` writes it anew.
#[test]
fn the_page_of_thresholds_is_the_table() {
    let mut page = String::from(
        "# Thresholds of the fit\n\nThe numbers by which the fit decides, module by module. The last column names the test that shows a \
         number: `unmeasured` if no test or experiment of the repository has set it, `derived` if it follows from a distribution or \
         from rounding.\n",
    );
    let mut section = "";
    for &Threshold { place, about, name, value, meaning, source } in TABLE {
        if place != section {
            section = place;
            page += &format!(
                "\n## `{place}`: {about}\n\n| threshold | value | meaning | shown by |\n|---|---|---|---|\n"
            );
        }
        page += &format!("| `{name}` | `{value}` | {} | {source} |\n", meaning.replace('|', "\\|"));
    }
    let path = root().join("thresholds.md");
    if std::env::var_os("POLHODE_BLESS").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    assert_eq!(std::fs::read_to_string(&path).unwrap(), page, "POLHODE_BLESS=1 writes the page anew");
}
