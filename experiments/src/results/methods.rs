//! The page of methods, docs/methods.md: what each claims, and what the committed results measured of it.

use polhode_files::error::Error;
use polhode_pages::table::{Cell, Column, Table};

use super::committed::{REMEDY, Results};
use crate::methods;

/// The page, from the root of the project.
pub(super) const PAGE: &str = "docs/methods.md";

const HEAD: &str = "<!-- made by `polhode experiment publish`; edit the methods, and not this page -->

The catalogue of methods, with measured orders and times. `polhode methods` lists two more: `linearly-implicit-euler`, the step of MuJoCo's
`implicit`, and `dissipating:LOSS`, for a body with inner friction. A name is taken by [`method()`](crate::method()) and by `--method`; it may have an
argument and a scheme, `BASE[:ARGUMENT][@SCHEME][+phase]`, as in `lie-poisson:321@kahan-li-8`. `polhode methods --schemes` lists the schemes.
`no-squish` is another name of `lie-poisson:321`, `kick-drift:4` one of `kick-drift@suzuki-4`.

All claims are those of free motion, and each is tested; only the order of `kick-drift`, which is exact there, is that of motion in a
potential. Energy is *exact* up to rounding, *bounded* for exponentially long times, or *drifts*. In formulas x = (m, q) is the momentum
in body axes and the attitude, ω = I⁻¹m, τ the torque, f the right-hand side of the equations of motion, and a prime marks the end of a
step. *Measured order* is that of the attitude, against the exact motion in double-double. *Step* is the processor time of a step over that
of `rk4`, on one machine, with default tolerances and output at every step.
";

/// The page as it follows from the committed results of the experiments `order` and `drift`.
///
/// # Errors
/// Results that are missing or cannot be read.
pub(super) fn page(results: &[Results]) -> Result<String, Error> {
    let of = |experiment: &'static str| {
        let found = results.iter().find(|found| found.origin.experiment == experiment);
        found.ok_or_else(|| Error::input(PAGE, experiment, "has no committed results", REMEDY))
    };
    let (order, drift) = (of("order")?, of("drift")?);
    let orders = Measured::of(order, "orders", "attitude_order")?;
    let times = Measured::of(drift, "timing", "step_ns")?;
    let (table, rk4) = (methods::table(), times.value("rk4"));
    let columns = [
        Column::new("formula", "", "one step"),
        Column::new("order", "", "order of convergence"),
        Column::new("measured order", "", "of the attitude").digits(4),
        Column::new("cost", "", "work per step"),
        Column::new("step", "", "processor time of a step, in steps of rk4").heading("step (rk4)").digits(2),
        Column::new("file", "", "where it is written"),
        Column::new("source", "", "where it comes from"),
    ];
    let kept = ["energy", "momentum", "momentum_vector", "norm", "symmetric", "poisson", "symplectic"];
    let mut shown = vec![table.columns[0].clone()];
    shown.extend(columns[..5].iter().cloned());
    shown.extend(table.columns.iter().filter(|column| kept.contains(&&*column.name)).cloned());
    shown.extend(columns[5..].iter().cloned());
    let mut page = Table::new("methods", table.caption.clone(), shown);
    for row in table.rows() {
        let name = row[0].exact();
        let cells = page.columns.iter().map(|column| match &*column.name {
            "measured order" => orders.value(&name).into(),
            "step" => times.value(&name).zip(rk4).map(|(time, rk4)| time / rk4).into(),
            known => table.place(known).map_or(Cell::Empty, |k| row[k].clone()),
        });
        let cells: Vec<Cell> = cells.collect();
        page.push(cells);
    }
    let origin = format!("Measured order: {}. Step: {}.\n", order.origin, drift.origin);
    Ok(format!("{HEAD}\n{}\n{origin}", page.markdown()))
}

/// One number a method.
struct Measured(Vec<(String, f64)>);

impl Measured {
    fn of(results: &Results, table: &str, column: &str) -> Result<Self, Error> {
        let text = results.csv(table)?;
        let mut lines = text.lines();
        let place = |name: &str, head: &str| head.split(',').position(|column| column == name);
        let head = lines.next().unwrap_or_default();
        let (Some(method), Some(value)) = (place("method", head), place(column, head)) else {
            let file = results.folder.join(format!("{table}.csv")).display().to_string();
            return Err(Error::input(&file, column, "is no column beside 'method'", REMEDY));
        };
        let pair = |line: &str| {
            let cells: Vec<&str> = line.split(',').collect();
            Some((cells.get(method)?.to_string(), cells.get(value)?.parse().ok()?))
        };
        Ok(Self(lines.filter_map(pair).collect()))
    }

    fn value(&self, method: &str) -> Option<f64> {
        self.0.iter().find(|(name, _)| name == method).map(|(_, value)| *value)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn the_page_of_methods_is_that_of_the_catalogue_and_the_committed_results() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let results = ["order", "drift"].map(|name| Results::open(root.join("results").join(name)).unwrap());
        let (path, made) = (root.join("..").join(PAGE), page(&results).unwrap());
        if std::env::var_os("POLHODE_BLESS").is_some() {
            std::fs::write(&path, &made).unwrap();
        }
        let committed = std::fs::read_to_string(path).unwrap();
        assert!(committed == made, "{PAGE} is stale: run `polhode experiment publish`");
    }

    #[test]
    fn a_method_without_measurement_has_empty_cells() {
        let scratch = tempfile::tempdir().unwrap();
        let write = |experiment: &str, file: &str, text: &str| {
            let folder = scratch.path().join(experiment);
            std::fs::create_dir_all(&folder).unwrap();
            let described = format!(
                "experiment = \"{experiment}\"\nscale = \"paper\"\ncommit = \"0\"\nchanged = \"false\"\n"
            );
            std::fs::write(folder.join("run.toml"), described).unwrap();
            std::fs::write(folder.join(file), text).unwrap();
            Results::open(folder).unwrap()
        };
        let results = [
            write("order", "orders.csv", "method,attitude_order\nrk4,3.50001\n"),
            write("drift", "timing.csv", "method,step_ns\nrk4,20\nrattle,50\n"),
        ];
        let text = page(&results).unwrap();
        let row = |name: &str| {
            let line = text.lines().find(|line| line.starts_with(&format!("| {name} |"))).unwrap();
            line.split(" | ").map(String::from).collect::<Vec<_>>()
        };
        assert_eq!((&*row("rk4")[3], &*row("rk4")[5]), ("3.500", "1"));
        assert_eq!((&*row("rattle")[3], &*row("rattle")[5]), ("", "2.5"));
        assert!(text.ends_with("Step: drift, commit 0, scale paper.\n"));
        assert!(page(&results[..1]).unwrap_err().to_string().contains("'drift'"));
    }
}
