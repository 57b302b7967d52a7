//! The spread to first order, beside that of the members.

use super::{EXACT, STEPPED, done};
use crate::harness::Scratch;

const BESIDE: &str = "Members compared with the first order";

/// Root mean squares of the members and to first order, and the nonlinearity, of the last row of the table.
fn last_row(text: &str) -> [f64; 3] {
    let (table, _) = text.split_once(BESIDE).unwrap();
    let row = table.trim_end().lines().last().unwrap();
    let cells: Vec<f64> = row.split_whitespace().map(|cell| cell.parse().unwrap()).collect();
    [cells[1], cells[2], cells[3]]
}

#[test]
fn narrow_spreads_are_told_to_first_order_and_wide_ones_are_not() {
    let scratch = Scratch::new("first-order");
    scratch.file("wide.toml", EXACT);
    let narrow = EXACT.replace("0.05", "0.0005").replace("[0.01, 0.02, 0.03]", "0.0001");
    scratch.file("narrow.toml", narrow);
    scratch.file("stepped.toml", STEPPED);
    let narrow = done("ensemble narrow.toml --out narrow", &scratch);
    assert!(narrow.contains(&format!("{BESIDE}: the first-order covariance agrees")), "{narrow}");
    // 301 members know a standard deviation to 4 %
    let [members, first_order, nonlinearity] = last_row(&narrow);
    assert!((members / first_order - 1.0).abs() < 0.16 && nonlinearity < 0.1, "{narrow}");
    let wide = done("ensemble wide.toml --out wide", &scratch);
    assert!(wide.contains("do not trust") && last_row(&wide)[2] > 0.3, "{wide}");
    assert!(!done("ensemble stepped.toml --out stepped", &scratch).contains(BESIDE));
}
