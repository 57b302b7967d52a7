//! What becomes of an ensemble: tables, a figure, and the record of what they are.

use std::collections::BTreeMap;

use polhode_files::error::{Error, unexpected};
use polhode_pages::figure::{Curve, Figure, Scale};
use polhode_pages::table::{Cell, Column, Table};

use super::folder::failures_table;
use super::passages;
use super::record::Record;
use super::reduce::Reduced;
use super::work::{ATTITUDES, OMEGAS, Shares};

/// Rows of the summary that are shown at the end of a run.
const SHOWN: usize = 12;

/// The files of the results besides the arrays, with their contents, and the record.
pub(super) struct Results {
    summary: Table,
    tables: Vec<Table>,
    figure: Figure,
    record: Record,
}

impl Results {
    pub(super) fn new(reduced: &[Option<Reduced>], shares: &Shares, mut record: Record) -> Self {
        let summary = summary(reduced, shares);
        let identity = &record.identity;
        let mut tables = vec![dispersion(reduced, shares), failures_table(&shares.failures)];
        if !identity.observer.is_empty() {
            tables.push(seen(reduced, shares));
        }
        if identity.event.is_some() {
            tables.push(passages::table(&shares.passages));
        }
        record.files = tables.iter().chain([&summary]).map(columns_of).collect();
        for (name, kept, width, what) in [
            (ATTITUDES, identity.attitudes, 4, "q_w, q_x, q_y, q_z; zeros where a member has no row"),
            (
                OMEGAS,
                identity.omegas,
                3,
                "angular velocity, body axes [rad/s]; zeros where a member has no row",
            ),
        ] {
            if kept {
                let shape = format!(
                    "{} x {} x {width}, times x members x components",
                    identity.times, identity.members
                );
                let entries = [("shape".to_string(), shape), ("entries".to_string(), what.to_string())];
                record.files.insert(name.into(), entries.into());
            }
        }
        let figure = figure(reduced, shares);
        Self { summary, tables, figure, record }
    }

    /// Names and contents of what goes beside the arrays and the record.
    pub(super) fn files(&self) -> Vec<(String, String)> {
        let tables = [&self.summary].into_iter().chain(&self.tables);
        let mut files: Vec<(String, String)> =
            tables.map(|table| (format!("{}.csv", table.name), table.csv())).collect();
        files.push((format!("{}.svg", self.figure.name), self.figure.svg()));
        files
    }

    /// The record, with the checksums of all files beside it.
    pub(super) fn record(&self, sha256: BTreeMap<String, String>) -> Result<String, Error> {
        Record { sha256, ..self.record.clone() }.sealed_text().map_err(unexpected)
    }

    /// Numbers of the rows that are shown.
    pub(super) fn rows_shown(&self) -> Vec<usize> {
        let rows = self.summary.rows().len();
        let (last, count) = (rows.saturating_sub(1), rows.min(SHOWN));
        (0..count).map(|k| if count > 1 { k * last / (count - 1) } else { 0 }).collect()
    }

    /// Some rows of the summary, for reading.
    pub(super) fn shown(&self) -> String {
        let mut table = Table::new("summary", "", self.summary.columns.clone());
        for k in self.rows_shown() {
            table.push(self.summary.rows()[k].clone());
        }
        table.terminal()
    }
}

fn columns_of(table: &Table) -> (String, BTreeMap<String, String>) {
    let meaning = |column: &Column| match &*column.unit {
        "" => column.meaning.to_string(),
        unit => format!("{} [{unit}]", column.meaning),
    };
    let columns = table.columns.iter().map(|column| (column.name.to_string(), meaning(column)));
    (format!("{}.csv", table.name), columns.collect())
}

fn summary(reduced: &[Option<Reduced>], shares: &Shares) -> Table {
    let mean = "chordal mean of the attitudes";
    let columns = vec![
        Column::new("t", "s", "time").digits(6),
        Column::new("q_w", "", mean).hidden(),
        Column::new("q_x", "", mean).hidden(),
        Column::new("q_y", "", mean).hidden(),
        Column::new("q_z", "", mean).hidden(),
        Column::new("angle_rms", "rad", "root mean square of the angles to the mean attitude")
            .heading("angle rms"),
        Column::new("angle_p50", "rad", "angle that half of the members do not exceed").heading("p50"),
        Column::new("angle_p95", "rad", "angle that 95 % of the members do not exceed").heading("p95"),
        Column::new("angle_max", "rad", "largest angle to the mean attitude").heading("max"),
        Column::new("energy_error_max", "", "largest relative energy error of the members")
            .heading("max |ΔE/E|"),
        Column::new("momentum_vector_error_max", "", "largest relative error of L in space")
            .heading("max |ΔL|/|L|"),
        Column::new("members", "", "members that have a row"),
    ];
    let mut table = Table::new("summary", "Mean attitude and dispersion of the members.", columns);
    for ((t, row), largest) in shares.times.iter().zip(reduced).zip(&shares.largest) {
        let of = |value: fn(&Reduced) -> f64| Cell::from(row.as_ref().map(value));
        let [w, x, y, z] = [0, 1, 2, 3].map(|k| Cell::from(row.as_ref().map(|row| row.mean[k])));
        table.push([
            Cell::from(*t),
            w,
            x,
            y,
            z,
            of(|row| row.root_mean_square),
            of(|row| row.median),
            of(|row| row.p95),
            of(|row| row.largest),
            Cell::from(largest.energy),
            Cell::from(largest.momentum_vector),
            Cell::from(row.as_ref().map_or(0, |row| row.members)),
        ]);
    }
    table
}

fn dispersion(reduced: &[Option<Reduced>], shares: &Shares) -> Table {
    let sigma = "standard deviation of the rotation vectors from the mean about this axis, by members - 1";
    let axis = "principal direction of the rotation vectors, axes of space";
    let mut columns = vec![Column::new("t", "s", "time")];
    columns.extend(["sigma_1", "sigma_2", "sigma_3"].map(|name| Column::new(name, "rad", sigma)));
    let names = [
        "axis_1_x", "axis_1_y", "axis_1_z", "axis_2_x", "axis_2_y", "axis_2_z", "axis_3_x", "axis_3_y",
        "axis_3_z",
    ];
    columns.extend(names.map(|name| Column::new(name, "", axis)));
    let mut table = Table::new("dispersion", "Principal directions of the dispersion.", columns);
    for (t, row) in shares.times.iter().zip(reduced) {
        let numbers =
            row.iter().flat_map(|row| row.deviations.into_iter().chain(row.axes.into_iter().flatten()));
        let mut cells: Vec<Cell> = [*t].into_iter().chain(numbers).map(Cell::from).collect();
        cells.resize(table.columns.len(), Cell::Empty);
        table.push(cells);
    }
    table
}

fn seen(reduced: &[Option<Reduced>], shares: &Shares) -> Table {
    let to_mean = "angle to it that this share of the members does not exceed";
    let columns = vec![
        Column::new("t", "s", "time"),
        Column::new("longitude", "rad", "of the mean direction to the observer, body axes, from x towards y"),
        Column::new("latitude", "rad", "of the mean direction to the observer, body axes"),
        Column::new("angle_p50", "rad", to_mean),
        Column::new("angle_p95", "rad", to_mean),
        Column::new("angle_max", "rad", "largest angle to it"),
    ];
    let mut table = Table::new("observer", "Where the observer stands in the sky of the members.", columns);
    for (t, row) in shares.times.iter().zip(reduced) {
        let seen = row.iter().filter_map(|row| row.seen.as_ref());
        let numbers = seen.flat_map(|seen| seen.mean.into_iter().chain(seen.angles));
        let mut cells: Vec<Cell> = [*t].into_iter().chain(numbers).map(Cell::from).collect();
        cells.resize(table.columns.len(), Cell::Empty);
        table.push(cells);
    }
    table
}

fn figure(reduced: &[Option<Reduced>], shares: &Shares) -> Figure {
    let members = reduced.iter().flatten().map(|row| row.members).max().unwrap_or(0);
    let title = format!("Angles of {members} members to their mean attitude");
    let axes = (("time (s)", Scale::Linear), ("angle (rad)", Scale::Log));
    let mut figure = Figure::new("dispersion", title, axes.0, axes.1);
    type Angle = fn(&Reduced) -> f64;
    let curves: [(&str, Angle); 4] = [
        ("largest", |row| row.largest),
        ("95 %", |row| row.p95),
        ("rms", |row| row.root_mean_square),
        ("50 %", |row| row.median),
    ];
    for (name, of) in curves {
        let mut points: Vec<(f64, f64)> =
            shares.times.iter().zip(reduced).filter_map(|(t, row)| Some((*t, of(row.as_ref()?)))).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        figure.series.push(Curve::new(name, points));
    }
    figure
}
