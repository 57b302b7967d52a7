//! What each method keeps of heavy tops, and how far its attitude is from the closed form.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use polhode::body::{Body, Point, Problem};
use polhode::catalogue::{self, NamedBody};
use polhode::flow::{LagrangeError, LagrangeTop};
use polhode::method::{AnyMethod, catalogue};
use polhode::num::Dd;
use polhode::observe::secular_drift;
use polhode::run::Run;
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Cell, Column, Table, row};

use super::followed::{
    Followed, columns_of_effort, columns_of_ending, effort, follow, is_whole, rows_of_methods, status,
};
use crate::experiment::{Context, Report};

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let steps = context.scale.pick(2_000, 100_000, 1_000_000);
    let mut parts = Vec::new();
    for top in catalogue::tops() {
        for angle in [0.1, 0.025] {
            for method in catalogue().into_iter().filter(|method| method.claims(Problem::Linear).is_some()) {
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
    let tops: Vec<&str> = catalogue::tops().iter().map(|top| top.name).collect();
    let title = format!(
        "Errors of {steps} steps under gravity, the energy relative to T₀ + |c|: a dot for each top ({}), the mark is the median",
        tops.join(", ")
    );
    let kinds = ["steps of about 0.1 rad", "about 0.025 rad"];
    report.drawings.push(rows_of_methods("heavy-top", &errors, "top", title, kinds));
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
        Column::new(
            "energy_error_exchanged",
            "",
            "max |E - E0| / (max U - min U), U the potential energy of the exact motion",
        )
        .heading("of exchanged")
        .latex("$/\\Delta U$")
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
    ];
    columns.extend(columns_of_ending());
    columns.extend(columns_of_effort());
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

/// max U − min U, J, of the exact motion at equal times up to `until`, s: as its energy is constant, that of its kinetic energy.
fn exchanged_energy(body: &Body, exact: &LagrangeTop, until: f64) -> f64 {
    const LOOKS: u32 = 256;
    let kinetic = |k: u32| {
        let x = exact.point_at_dd(Dd::from(until) * (f64::from(k) / f64::from(LOOKS)));
        kinetic_energy(body, &x)
    };
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for energy in (0..=LOOKS).map(kinetic) {
        (least, most) = (least.min(energy), most.max(energy));
    }
    most - least
}

/// Kinetic energy of a point of the solver frame, J.
fn kinetic_energy(body: &Body, x: &Point<Dd>) -> f64 {
    let state = body.leave(x);
    0.5 * body.omega_body(&state).dot(&state.momentum())
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
    let motion = |elapsed| exact.as_ref().map(|exact| exact.point_at_dd(elapsed));
    let Followed { last, ending, attitude_error, times, energy_changes } =
        follow(&mut run, (steps, h), motion)?;
    // what a run that failed leaves behind is no error of the method
    let of_whole = |error: Option<f64>| error.filter(|_| is_whole(ending));
    let slope = secular_drift(&times, &energy_changes).filter(|_| is_whole(ending));
    let scale = kinetic_energy(&body, &run.start().to_dd()) + Vector3::from(top.weight_moment).norm();
    let exchanged = exact.as_ref().map(|exact| exchanged_energy(&body, exact, last.elapsed.hi()));
    let over_exchanged =
        of_whole(last.worst.energy).zip(exchanged).map(|(energy, exchanged)| energy * scale / exchanged);
    let [evaluations, rejected] = effort(&run, method, Problem::Linear, last.steps);
    Ok(row![
        top.name,
        method.name(),
        h,
        last.steps,
        of_whole(last.worst.energy),
        over_exchanged,
        of_whole(last.worst.momentum_z),
        attitude_error,
        slope.map(|d| d.slope),
        slope.map(|d| d.half_width),
        status(ending),
        last.elapsed.hi(),
        evaluations,
        rejected,
    ]
    .to_vec())
}
