//! What each method keeps and loses on real bodies, and how far its attitude is from the exact one.

use polhode::body::{Body, Clock, Problem};
use polhode::catalogue::{self, NamedBody};
use polhode::flow::FreeMotion;
use polhode::method::{AnyMethod, AxisOrder, AxisSplit, Kicks, LiePoisson, method, without_projections};
use polhode::observe::secular_drift;
use polhode::run::{Run, RunError};
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Cell, Column, Table, row};

use super::contestants::TAKEN_BACK;
use super::followed::{
    Followed, columns_of_effort, columns_of_ending, effort, follow, is_whole, rows_of_methods, status,
};
use crate::experiment::{Context, Report};
use crate::timing::StepTime;

const BODIES: [&str; 7] = ["textbook", "toutatis", "racket", "t-handle", "phone", "water", "spacecraft"];

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let steps = context.scale.pick(2_000, 50_000, 1_000_000);
    let mut parts = Vec::new();
    for body in BODIES.iter().filter_map(|name| catalogue::body(name)) {
        for h in step_sizes(&body) {
            for method in methods(&body) {
                parts.push((body.clone(), h, method));
            }
        }
    }
    let rows = context.in_parallel(parts, |(body, h, method)| measure(&body, method.as_ref(), h, steps));
    let mut report = Report::default();
    let mut drift = Table::new("drift", caption(steps), columns());
    let mut timing = Table::new(
        "timing",
        "Nanoseconds per step, the least of several bursts on this machine.",
        vec![
            Column::new("method", "", "name in the catalogue"),
            Column::new("step_ns", "ns", "time per step, nobody watching").heading("ns/step"),
        ],
    );
    for row in rows {
        drift.push(row?);
    }
    let hidden = ["body"];
    for named in BODIES.iter().filter_map(|name| catalogue::body(name)) {
        let caption = format!("{}: {}.", named.name, named.summary);
        let name = format!("drift-{}", named.name);
        report.views.push(drift.view(name, caption, &hidden, ("body", named.name)));
    }
    if let Some(textbook) = catalogue::body("textbook") {
        // steps of those whose phase is taken back are those of their base
        let is_timed = |method: &dyn AnyMethod| !TAKEN_BACK.contains(&method.name().as_str());
        for method in methods(&textbook).into_iter().filter(|method| is_timed(method.as_ref())) {
            timing.push(row![method.name(), step_time(&textbook, method.as_ref())?]);
        }
    }
    let title = format!(
        "Errors of {steps} free steps: a dot for each of {} bodies ({}), the mark is the median",
        BODIES.len(),
        BODIES.join(", ")
    );
    let kinds = ["steps of about 0.1 rad", "about 0.01 rad"];
    report.drawings.push(rows_of_methods("drift", &drift, "body", title, kinds));
    report.tables.push(drift);
    report.timing = Some(timing);
    Ok(report)
}

fn caption(steps: u64) -> String {
    format!("Largest errors over {steps} steps of torque-free rotation, and the attitude error at the end.")
}

fn columns() -> Vec<Column> {
    let mut columns = vec![
        Column::new("body", "", "name in the catalogue of bodies"),
        Column::new("method", "", "name in the catalogue of methods"),
        Column::new("h", "s", "step").latex("$h$").digits(2),
        Column::new("angle_per_step", "rad", "h times the angular velocity at the start").hidden(),
        Column::new("steps", "", "steps taken").hidden(),
        Column::new("energy_error", "", "max |E - E0| / |E0| over every step").heading("energy").digits(2),
        Column::new("momentum_error", "", "max ||m| - |m0|| / |m0| over every step")
            .heading("|m|")
            .latex("$|m|$")
            .digits(2),
        Column::new("momentum_vector_error", "", "max |L - L0| / |L0| over every step, in space")
            .heading("L")
            .latex("$L$")
            .digits(2),
        Column::new("attitude_error", "rad", "angle between computed and exact attitude at the end")
            .heading("attitude")
            .digits(2),
        Column::new("energy_slope", "1/rad", "secular slope of (E - E0)/E0 per radian turned").hidden(),
        Column::new("energy_slope_half_width", "1/rad", "half width of its 95 % interval").hidden(),
        Column::new("flips", "", "changes of sign of the momentum along the middle axis, step by step")
            .hidden(),
        Column::new("flips_exact", "", "the same of the exact motion").hidden(),
        Column::new("flips_right", "", "whether they agree").heading("flips").latex("flips"),
    ];
    columns.extend(columns_of_ending());
    columns.extend(columns_of_effort());
    columns
}

/// 0.01 s for the textbook body, whose figures others have published; elsewhere powers of two of about a tenth and
/// a hundredth of a radian per step, so that the times are exact.
fn step_sizes(body: &NamedBody) -> Vec<f64> {
    if body.name == "textbook" {
        return vec![0.1, 0.01];
    }
    let speed = nalgebra::Vector3::from(body.omega_body).norm();
    [0.1, 0.01].map(|angle| libm::exp2(libm::round(libm::log2(angle / speed)))).to_vec()
}

/// The catalogue, and for the textbook body the splitting in two orders that others use.
fn methods(body: &NamedBody) -> Vec<Box<dyn AnyMethod>> {
    let mut methods = without_projections();
    // without torque kick-drift is exact-step, whatever its scheme
    methods
        .retain(|method| method.claims(Problem::Free).is_some() && !method.name().starts_with("kick-drift"));
    methods.extend(TAKEN_BACK.iter().filter_map(|name| method(name).ok()));
    if body.name == "textbook" {
        let others =
            AxisOrder::ALL.into_iter().filter(|order| ["321", "123"].contains(&order.to_string().as_str()));
        methods.extend(others.map(|order| {
            Box::new(LiePoisson::strang(AxisSplit { axes: Some(order) }, Kicks)) as Box<dyn AnyMethod>
        }));
    }
    methods
}

fn measure(named: &NamedBody, method: &dyn AnyMethod, h: f64, steps: u64) -> Result<Vec<Cell>, Error> {
    let body = Body::free(named.inertia.clone());
    let start = body.state(Default::default(), named.omega_body.into()).map_err(unexpected)?;
    let speed = nalgebra::Vector3::from(named.omega_body).norm();
    let mut run = match Run::new(method, &body, &start, h) {
        Ok(run) => run,
        Err(RunError::Phase(_)) => return Ok(not_predicted(named, method, h)),
        Err(error) => return Err(unexpected(error)),
    };
    let exact = FreeMotion::from_point(body.inertia(), run.start().to_dd());
    let motion = |elapsed| Some(exact.point_at_dd(elapsed));
    let Followed { last, ending, attitude_error, times, energy_changes } =
        follow(&mut run, (steps, h), motion)?;
    // what a run that failed leaves behind is no error of the method
    let of_whole = |error: Option<f64>| error.filter(|_| is_whole(ending));
    let angles: Vec<f64> = times.iter().map(|t| t * speed).collect();
    let slope = secular_drift(&angles, &energy_changes).filter(|_| is_whole(ending));
    let flips = exact.flips(last.elapsed);
    let [evaluations, rejected] = effort(&run, method, Problem::Free, last.steps);
    Ok(row![
        named.name,
        method.name(),
        h,
        h * speed,
        last.steps,
        of_whole(last.worst.energy),
        of_whole(last.worst.momentum_norm),
        of_whole(last.worst.momentum_vector),
        attitude_error,
        slope.map(|d| d.slope),
        slope.map(|d| d.half_width),
        last.flips,
        flips,
        last.flips.filter(|_| is_whole(ending)).map(|found| if found == flips { "right" } else { "wrong" }),
        status(ending),
        last.elapsed.hi(),
        evaluations,
        rejected,
    ]
    .to_vec())
}

/// The row of a start from which nothing is known to take back.
fn not_predicted(named: &NamedBody, method: &dyn AnyMethod, h: f64) -> Vec<Cell> {
    let speed = nalgebra::Vector3::from(named.omega_body).norm();
    let mut cells = row![named.name, method.name(), h, h * speed, 0_u64].to_vec();
    cells.extend(columns().iter().skip(cells.len()).map(|column| match column.name.as_ref() {
        "status" => "not predicted".into(),
        _ => None::<f64>.into(),
    }));
    cells
}

/// Nanoseconds of a step.
fn step_time(named: &NamedBody, method: &dyn AnyMethod) -> Result<f64, Error> {
    let body = Body::free(named.inertia.clone());
    let start = body.state(Default::default(), named.omega_body.into()).map_err(unexpected)?;
    let start = body.enter(&start).map_err(unexpected)?.to_f64();
    Ok(StepTime::measure(method, &body, start, Clock::new(1.0 / 1024.0))?.seconds * 1e9)
}
