//! The derivative of the motion of Lagrange's top against central differences in double-double, by regime, and what it costs.

use nalgebra::SMatrix;
use polhode::body::{Body, Point};
use polhode::flow::{LagrangeError, LagrangeTop, TurnAxes};
use polhode::inertia::Inertia;
use polhode::num::{Dd, Real};
use polhode::rotation::{Quat, Vec3};
use polhode_files::error::Error;
use polhode_pages::table::{Column, Table, row};

use super::{PROMISE, failed};
use crate::experiment::{Context, Report};
use crate::statistics::larger;
use crate::timing::{best, discard};

/// A top of the moments 1.25, 1.25 and 0.75 kg m² with the weight moment 2 N m, and its start.
struct Start {
    regime: &'static str,
    /// Of the axis from the vertical, rad.
    tilt: f64,
    momentum: [f64; 3],
}

const MOMENTS: [f64; 3] = [1.25, 1.25, 0.75];
const WEIGHT: f64 = 2.0;

const STARTS: [Start; 8] = [
    Start { regime: "fast", tilt: 0.5, momentum: [0.0, 0.0, 15.0] },
    Start { regime: "looping", tilt: 0.5, momentum: [0.5, 1.25, 2.25] },
    Start { regime: "slow", tilt: 1.5, momentum: [0.125, 0.25, 0.25] },
    Start { regime: "steady precession", tilt: core::f64::consts::FRAC_PI_2, momentum: [0.0, 1.25, 2.0] },
    Start { regime: "sleeping", tilt: 1e-6, momentum: [0.0, 0.0, 8.0] },
    Start { regime: "falls from the vertical", tilt: 0.0, momentum: [1e-3, 0.0, 0.5] },
    Start { regime: "hanging", tilt: 3.0, momentum: [0.5, 0.25, 1.5] },
    Start { regime: "pendulum", tilt: 2.0, momentum: [0.5, 0.0, 0.0] },
];

impl Start {
    fn point(&self, body: &Body) -> Point<Dd> {
        let (sin, cos) = Dd::of(0.5 * self.tilt).sin_cos();
        Point::new(Quat::new(cos, Vec3::unit(0) * sin), Vec3(self.momentum.map(|m| Dd::of(m / body.scale()))))
    }

    /// The size of the momenta, kg m²/s.
    fn size(&self) -> f64 {
        Vec3(self.momentum).norm().max((WEIGHT * MOMENTS[0]).sqrt())
    }
}

pub(super) fn run(context: &Context, report: &mut Report, timing: &mut Table) -> Result<(), Error> {
    let mut table = Table::new(
        "tops",
        "The derivative of the motion of a heavy symmetric top by its start, against central differences in double-double.",
        vec![
            Column::new("regime", "", "kind of motion"),
            Column::new("turned", "rad", "fastest rate times the time").digits(2),
            Column::new(
                "error",
                "",
                "largest error over the largest entry, with the size of the momenta as unit",
            )
            .digits(2),
            Column::new("known", "", "what the differences leave uncertain").digits(2),
        ],
    );
    let inertia = Inertia::from_moments(MOMENTS).map_err(|error| failed("tops", &error))?;
    let body = Body::heavy(inertia, [0.0, 0.0, WEIGHT].into()).map_err(|error| failed("tops", &error))?;
    for start in &STARTS {
        let name = start.regime;
        let set_up = || LagrangeTop::from_point(&body, start.point(&body));
        let top = set_up().map_err(|error| failed(name, &error))?;
        let fastest = start.size() / MOMENTS[0];
        let far = context.scale.pick(100.0, 1e4, 1e6);
        for turned in [1.0, 10.0, far] {
            // a short time, so that products with it are exact
            let t = libm::exp2(libm::round(libm::log2(turned / fastest)));
            let found = top.at_with_derivative(t).map_err(|error| failed(name, &error))?;
            let found = found.by_momentum(TurnAxes::Space).fixed_columns::<6>(0).into_owned();
            let [error, known] =
                beside_differences(&body, start, t, &found).map_err(|error| failed(name, &error))?;
            table.push(row![name, t * fastest, error, known]);
            report.checks += 1;
            if error.is_nan() || error > PROMISE + 4.0 * known {
                report.failures.push(format!("{name}: error {error:e} at {t} s"));
            }
        }
        let times: Vec<f64> = (1..=256).map(|n| f64::from(n) * 12.345 / fastest).collect();
        let burst = || times.iter().for_each(|&t| discard(top.at_with_derivative(t)));
        let first = || discard(set_up().map(|top| top.at_with_derivative(times[0])));
        let plain = || discard(set_up().map(|top| top.at(times[0])));
        let top_of = format!("top: {name}");
        timing.push(row!["at_with_derivative", top_of.as_str(), best(50, &burst) / 256.0 * 1e6]);
        timing.push(row!["set-up of a motion and one state", top_of.as_str(), best(200, &plain) * 1e6]);
        timing.push(row!["set-up of a motion and one derivative", top_of.as_str(), best(200, &first) * 1e6]);
    }
    report.tables.push(table);
    Ok(())
}

/// Error and uncertainty of the differences, relative to the largest entry.
fn beside_differences(
    body: &Body,
    start: &Start,
    t: f64,
    found: &SMatrix<f64, 6, 6>,
) -> Result<[f64; 2], LagrangeError> {
    let size = start.size();
    let row_unit = |row: usize| if row < 3 { 1.0 } else { 1.0 / size };
    let column_unit = |column: usize| if column < 3 { 1.0 } else { size };
    let found = SMatrix::<f64, 6, 6>::from_fn(|row, column| {
        found[(row, column)] * row_unit(row) * column_unit(column)
    });
    let end = |column: usize, e: Dd| {
        let mut x = start.point(body);
        match column {
            0..3 => x.attitude = Quat::exponential(Vec3::unit(column) * e) * x.attitude,
            _ => x.momentum_body[column - 3] = x.momentum_body[column - 3] + e * (size / body.scale()),
        }
        LagrangeTop::from_point(body, x).map(|top| top.point_at_dd(Dd::of(t)))
    };
    let difference = |column: usize, e: f64| -> Result<[Dd; 6], LagrangeError> {
        let (high, low) = (end(column, Dd::of(e))?, end(column, Dd::of(-e))?);
        let turn = high.attitude * low.attitude.conjugate();
        let sign = if turn.w < Dd::ZERO { -1.0 } else { 1.0 };
        let turn = turn.v * Dd::of(sign / e);
        let m = (high.momentum_body - low.momentum_body) * Dd::of(body.scale() / size / (2.0 * e));
        Ok([turn[0], turn[1], turn[2], m[0], m[1], m[2]])
    };
    // what is left beyond Richardson's extrapolation is some 1e-20
    let widest =
        libm::exp2(-18.0 - libm::ceil(libm::log2((t * size / MOMENTS[0]).max(found.amax()).max(1.0))));
    let (mut error, mut known) = (0.0_f64, 0.0_f64);
    for column in 0..6 {
        let rough = difference(column, widest)?;
        let (middle, fine) = (difference(column, 0.5 * widest)?, difference(column, 0.25 * widest)?);
        for row in 0..6 {
            let better = |narrow: Dd, wide: Dd| (narrow * 4.0 - wide) / 3.0;
            let value = better(fine[row], middle[row]);
            known = known.max((value - better(middle[row], rough[row])).magnitude());
            error = larger(error, (value - Dd::of(found[(row, column)])).magnitude());
        }
    }
    Ok([error / found.amax(), known / found.amax()])
}
