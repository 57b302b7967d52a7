//! The rows of `--residuals FILE.csv`.

use polhode_fit::{Estimate, FittedMotion, Record};
use polhode_pages::table::{Cell, Column, Table};

/// Measured and fitted rates, and their difference.
pub(super) fn rows(record: &Record, motion: &[FittedMotion]) -> Table {
    let rate = |name, meaning| Column::new(name, "rad/s", meaning);
    let columns = vec![
        Column::new("segment", "", "number of the segment"),
        Column::new("t", "s", "time"),
        rate("wx", "measured rate about x, corrected for the fitted errors of the sensor"),
        rate("wy", "the same about y"),
        rate("wz", "the same about z"),
        rate("fitted_x", "rate of the fitted motion about x"),
        rate("fitted_y", "the same about y"),
        rate("fitted_z", "the same about z"),
        rate("residual_x", "measured less fitted about x; empty where the sample was left out"),
        rate("residual_y", "the same about y"),
        rate("residual_z", "the same about z"),
    ];
    let mut table = Table::new("residuals", "Measured less fitted rates.", columns);
    for m in motion {
        let times = record.segments.get(m.segment).map_or(&[][..], |s| s.times());
        for (i, (t, w)) in times.iter().zip(&m.measured).enumerate() {
            let fitted = m.fitted.as_ref().map(|rates| rates[i]);
            let left = fitted.filter(|_| m.used[i]).map(|fitted| w - fitted);
            let mut cells = vec![Cell::from(m.segment as u64 + 1), Cell::from(*t)];
            cells.extend(w.iter().map(|x| Cell::from(*x)));
            for of in [fitted, left] {
                cells.extend((0..3).map(|k| Cell::from(of.map(|v| v[k]))));
            }
            table.push(cells);
        }
    }
    table
}

/// What the fitted motion leaves of attitudes.
pub(super) fn turns(e: &Estimate, noise: f64) -> Table {
    let turn = |name, meaning| Column::new(name, "rad", meaning);
    let columns = vec![
        Column::new("segment", "", "number of the segment"),
        Column::new("t", "s", "time"),
        turn(
            "turn_x",
            "rotation vector from the fitted attitude to the measured one about the x axis of the body",
        ),
        turn("turn_y", "the same about y"),
        turn("turn_z", "the same about z"),
    ];
    let mut table = Table::new("residuals", "Measured less fitted attitudes.", columns);
    for of in &e.residuals {
        for (t, values) in of.times.iter().zip(&of.values) {
            let mut cells = vec![Cell::from(of.segment as u64 + 1), Cell::from(*t)];
            cells.extend(values.iter().map(|value| Cell::from(value * noise)));
            table.push(cells);
        }
    }
    table
}
