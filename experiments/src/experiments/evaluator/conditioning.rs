//! What the rounding of the input does to the exact attitude, whatever evaluates it.

use nalgebra::{Matrix3, Vector3};
use polhode::flow::TurnAxes;
use polhode::rotation::Vec3;
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Column, Table, row};

use super::bound::{errors, library, motion_of};
use super::grid::Start;
use super::reference::Reference;
use crate::experiment::Report;
use crate::statistics::rounded;

/// Motions by name: moments and angular velocity, rad/s.
const MOTIONS: [(&str, [f64; 3], [f64; 3]); 4] = [
    ("generic", [1.0, 2.0, 3.0], [0.7, 0.5, 0.6]),
    ("next to the separatrix", [1.0, 2.0, 3.0], [1e-6, 1.0, 1e-6]),
    ("nearly symmetric", [1.0, 1.000_001, 1.5], [0.7, 0.5, 0.6]),
    ("slender", [1e-4, 0.999_95, 1.0], [0.7, 0.5, 0.6]),
];

const TURNED: [f64; 5] = [1.0, 1e3, 1e6, 1e9, 1e12];

/// The largest length of `columns · x` over |x_k| ≤ `sizes_k`.
fn largest(columns: Matrix3<f64>, sizes: Vector3<f64>) -> f64 {
    let signs = [[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0]];
    let lengths = signs.map(|signs| (columns * sizes.component_mul(&Vector3::from(signs))).norm());
    lengths.into_iter().fold(0.0, f64::max)
}

pub(super) fn run(report: &mut Report) -> Result<(), Error> {
    let mut table = Table::new(
        "conditioning",
        "By how many units u = 2^-53, in rad, the exact attitude turns where each number of an input is changed by at most u of itself, all at once and with the worst signs; beside it the error of the evaluation.",
        vec![
            Column::new("motion", "", "kind of motion"),
            Column::new("turned", "rad", "|omega| t"),
            Column::new("by_omega", "u", "angle by changes of the three components of omega at the start")
                .heading("by omega"),
            Column::new("by_moments", "u", "the same of the three moments").heading("by the moments"),
            Column::new("by_t", "u", "the same of the time").heading("by t"),
            Column::new("evaluation", "u", "attitude error of the evaluation there"),
        ],
    );
    for (name, moments, omega) in MOTIONS {
        let start = Start { moments, omega };
        let (motion, reference) = (motion_of(&start)?, Reference::new(&start));
        for turned in TURNED {
            let t = turned / Vec3(omega).norm();
            let derivative = motion.at_with_derivative(t).map_err(unexpected)?.by_omega(TurnAxes::Space);
            let columns = |first: usize| derivative.fixed_view::<3, 3>(0, first).into_owned();
            let speed = motion.omega_at(t).map_err(unexpected)?.norm();
            let here = library(&motion, &[t])?;
            table.push(row![
                name,
                turned,
                rounded(largest(columns(3), omega.into())),
                rounded(largest(columns(6), moments.into())),
                rounded(speed * t),
                rounded(errors(here[0], reference.at(t))[0]),
            ]);
        }
    }
    report.checks += table.rows().len() as u64;
    report.tables.push(table);
    Ok(())
}
