//! What each method keeps of heavy tops, and how far its attitude is from the closed form.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use polhode::body::Problem;
use polhode::catalogue::{self, NamedBody};
use polhode::flow::{LagrangeError, LagrangeTop};
use polhode::method::{AnyMethod, catalogue};
use polhode::observe::secular_drift;
use polhode::run::Run;

use super::followed::{Effort, Followed, attitude_error, follow, scatter};
use crate::error::{Error, unexpected};
use crate::experiment::{Context, Report};
use crate::table::{Cell, Column, Table, row};

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let steps = context.scale.pick(2_000, 100_000, 1_000_000);
    let mut parts = Vec::new();
    for top in catalogue::tops() {
        for angle in [0.1, 0.025] {
            for method in catalogue().into_iter().filter(|method| method.claims(Problem::Gravity).is_some()) {
                parts.push((top.clone(), step_size(&top, angle)?, method));
            }
        }
    }
    let rows = context.in_parallel(parts, |(top, h, method)| measure(&top, method.as_ref(), h, steps));
    let caption =
        format!("Largest errors over {steps} steps under gravity, and the attitude error at the end.");
    let mut errors = Table::new("heavy-top", caption, columns());
    for row in rows {
        errors.push(row?);
    }
    let mut report = Report::default();
    for top in catalogue::tops() {
        let caption = format!("{}: {}.", top.name, top.summary);
        let name = format!("heavy-top-{}", top.name);
        report.views.push(errors.view(name, caption, &["top"], ("top", top.name)));
    }
    let title = "Every top that has a closed form, at two steps; runs that diverged are left out";
    report.figures.push(scatter("heavy-top", &errors, title, Problem::Gravity));
    report.tables.push(errors);
    Ok(report)
}

fn columns() -> Vec<Column> {
    let mut columns = vec![
        Column::new("top", "", "name in the catalogue of tops"),
        Column::new("method", "", "name in the catalogue of methods"),
        Column::new("h", "s", "step").latex("$h$").digits(2),
        Column::new("steps", "", "steps taken").hidden(),
        Column::new("energy_error", "", "max |E - E0| / (T0 + |c|) over every step, c the weight moment")
            .heading("energy")
            .digits(2),
        Column::new("momentum_z_error", "", "max |L_Z - L_Z0| over its largest possible value, every step")
            .heading("L_Z")
            .latex("$p_\\varphi$")
            .digits(2),
        Column::new("attitude_error", "rad", "angle between computed and exact attitude at the end")
            .heading("attitude")
            .digits(2),
        Column::new("energy_slope", "1/s", "secular slope of (E - E0)/(T0 + |c|)").heading("slope").digits(2),
        Column::new("energy_slope_half_width", "1/s", "half width of its 95 % interval")
            .heading("±")
            .digits(2),
        Column::new("status", "", "ok, diverged (the row holds the last finite state) or unsolved"),
        Column::new("time_reached", "s", "time of the row").hidden(),
    ];
    columns.extend(Effort::columns());
    columns
}

/// A power of two near `angle` rad per step, so that the times are exact.
fn step_size(top: &NamedBody, angle: f64) -> Result<f64, Error> {
    let moment = top.inertia.principal_moments().into_iter().fold(f64::INFINITY, f64::min);
    // a top at rest moves at the rate of a pendulum
    let weight = Vector3::from(top.weight_moment).norm();
    let fastest = Vector3::from(top.omega_body).norm() + libm::sqrt(weight / moment);
    Ok(libm::exp2(libm::round(libm::log2(angle / fastest))))
}

fn measure(top: &NamedBody, method: &dyn AnyMethod, h: f64, steps: u64) -> Result<Vec<Cell>, Error> {
    let body = top.body().map_err(unexpected)?;
    let [w, x, y, z] = top.attitude;
    let attitude = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z));
    let start = body.state(attitude, top.omega_body.into()).map_err(unexpected)?;
    let mut run = Run::new(method, &body, &start, h).map_err(unexpected)?;
    let exact = match LagrangeTop::from_point(&body, run.start().to_dd()) {
        Ok(exact) => Some(exact),
        Err(LagrangeError::NotSymmetric { .. } | LagrangeError::OffAxis { .. }) => None,
        Err(error) => return Err(unexpected(error)),
    };
    let Followed { last, status, times, energy_changes } = follow(&mut run, steps)?;
    let attitude = exact.map(|exact| attitude_error(&last, &exact.point_at_dd(last.elapsed)));
    let slope = secular_drift(&times, &energy_changes);
    let effort = Effort::of(&run, method, Problem::Gravity, last.steps);
    Ok(row![
        top.name,
        method.name(),
        h,
        last.steps,
        last.worst.energy,
        last.worst.momentum_z,
        attitude,
        slope.map(|d| d.slope),
        slope.map(|d| d.half_width),
        status,
        last.elapsed.hi(),
        effort.evaluations,
        effort.rejected,
    ]
    .to_vec())
}
