//! Splittings of the kinetic energy by every order of the axes: what the h² term of the modified energy predicts, and what is
//! measured.

use polhode::body::{Body, Point};
use polhode::inertia::Inertia;
use polhode::method::{AnyMethod, AxisOrder, AxisSplit, Kicks, LiePoisson, Splitting, TwoAxes, TwoTurn};
use polhode::num::Dd;
use polhode::rotation::{Quat, Vec3};
use polhode::truth::{AGREEMENT, Care, Truth, evenly};
use polhode_files::error::{Error, unexpected};
use polhode_pages::figure::{Curve, Figure};
use polhode_pages::table::{Cell, Column, Table, row};

use crate::experiment::{Context, Report};

/// A body, and its angular velocity at the start, rad/s, of about 1.
struct Subject {
    name: &'static str,
    moments: [f64; 3],
    omega_body: [f64; 3],
}

const SUBJECTS: [Subject; 5] = [
    Subject { name: "1 : 2 : 3", moments: [1.0, 2.0, 3.0], omega_body: [0.4, 1.0, -0.3] },
    Subject { name: "5/8 : 3/4 : 1", moments: [0.625, 0.75, 1.0], omega_body: [0.875, 0.25, -0.375] },
    Subject { name: "Fassò 1 : 3/4 : 1/4", moments: [1.0, 0.75, 0.25], omega_body: [0.5, 0.75, 0.5] },
    Subject { name: "racket", moments: [0.0389, 0.4619, 0.4993], omega_body: [0.25, 1.0, 0.125] },
    Subject { name: "SPHERES", moments: [0.0241, 0.0234, 0.0201], omega_body: [0.25, 0.875, 0.375] },
];

/// The coarser of two steps and the end, s: powers of two, so that the times are exact.
#[derive(Clone, Copy)]
struct Plan {
    coarse: f64,
    span: f64,
}

/// A splitting with the term that it adds to the energy.
#[derive(Clone, Copy)]
enum Split {
    Three(AxisOrder),
    Two(TwoAxes),
}

impl Split {
    fn all() -> Vec<Split> {
        let three = AxisOrder::ALL.into_iter().map(Split::Three);
        three.chain(TwoAxes::ALL.into_iter().map(Split::Two)).collect()
    }

    fn method(self) -> Box<dyn AnyMethod> {
        match self {
            Split::Three(axes) => Box::new(LiePoisson::strang(AxisSplit { axes: Some(axes) }, Kicks)),
            Split::Two(axes) => Box::new(Splitting::strang(TwoTurn { axes: Some(axes) }, Kicks)),
        }
    }

    /// H₃: the splitting keeps H + h² H₃ up to O(h⁴).
    fn term(self, m: Vec3<f64>, moments: Vec3<f64>) -> f64 {
        match self {
            Split::Three(axes) => axes.modified_energy(m, moments),
            Split::Two(axes) => axes.modified_energy(m, moments),
        }
    }

    /// Root mean square of the rate of the attitude error over h², rad/s³.
    fn rate(self, m: Vec3<f64>, moments: Vec3<f64>) -> Option<f64> {
        match self {
            Split::Three(axes) => axes.attitude_error_rate(m, moments),
            Split::Two(axes) => axes.attitude_error_rate(m, moments),
        }
    }
}

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let (steps_per_s, span) = context.scale.pick((16.0, 64.0), (32.0, 1024.0), (64.0, 4096.0));
    let plan = Plan { coarse: 1.0 / steps_per_s, span };
    let mut parts = Vec::new();
    for subject in &SUBJECTS {
        let inertia = Inertia::from_moments(subject.moments).map_err(unexpected)?;
        let body = Body::free(inertia);
        let start = body.enter_omega(Quat::identity(), Vec3(subject.omega_body)).map_err(unexpected)?;
        parts.push((subject, body, start));
    }
    let found = context.in_parallel(parts, |(subject, body, start)| of_body(subject, &body, &start, plan));
    let caption = format!(
        "Splittings of free motion by every order of the axes, outermost first, over {span} s at a step of 1/{} s: largest \
         relative energy error, and root mean square of attitude error over time; predicted from the h^2 term of the modified \
         energy, and measured; orders from twice the step.",
        2.0 * steps_per_s
    );
    let mut table = Table::new("splittings", caption, columns());
    let mut figure = Figure::log_log(
        "splittings",
        format!(
            "Each point a splitting of a body at h = 1/{} s over {span} s; on the dotted line prediction and measurement agree",
            2.0 * steps_per_s
        ),
        "predicted rate of the attitude error (rad/s)",
        "measured rate (rad/s)",
    )
    .scatter();
    let (mut all, mut failures) = (Vec::new(), Vec::new());
    for (subject, rows) in SUBJECTS.iter().zip(found) {
        let mut points = Vec::new();
        for row in rows? {
            if span > 1e3 {
                failures.extend(row.failure(subject.name));
            }
            points.extend(row.rates());
            table.push(row.cells(subject.name));
        }
        all.extend(points.iter().map(|point| point.0));
        figure.series.push(Curve::new(subject.name, points));
    }
    let ends = [all.iter().copied().fold(f64::INFINITY, f64::min), all.iter().copied().fold(0.0, f64::max)];
    if ends[0] < ends[1] {
        figure.guide("equal", 1.0, (ends[0], ends[0]), ends);
    }
    let views = SUBJECTS.iter().enumerate().map(|(k, subject)| {
        let caption = format!("{}, starting at omega = {:?} rad/s.", subject.name, subject.omega_body);
        table.view(format!("splittings-{}", k + 1), caption, &["body"], ("body", subject.name))
    });
    let views = views.collect();
    Ok(Report { tables: vec![table], views, figures: vec![figure], failures, ..Report::default() })
}

fn columns() -> Vec<Column> {
    vec![
        Column::new("body", "", "moments of inertia"),
        Column::new("method", "", "splitting with its axes, outermost first"),
        Column::new("h", "s", "step").latex("$h$").hidden(),
        Column::new("energy_predicted", "", "max h^2 |H3 - H3(0)| / E over the true orbit")
            .heading("E pred.")
            .digits(3),
        Column::new("energy_measured", "", "max |E - E0| / E0 over every step").heading("E meas.").digits(3),
        Column::new("energy_order", "", "log2 of the ratio to the error at twice the step")
            .heading("order")
            .digits(3),
        Column::new(
            "attitude_predicted",
            "rad/s",
            "root mean square rate at which the attitude runs away, from the averaged h^2 term",
        )
        .heading("att. pred.")
        .digits(3),
        Column::new(
            "attitude_measured",
            "rad/s",
            "root mean square of attitude error over time in the second half of the run",
        )
        .heading("att. meas.")
        .digits(3),
        Column::new("attitude_order", "", "log2 of the ratio to the rate at twice the step")
            .heading("order")
            .digits(3),
    ]
}

/// One splitting at the finer of the steps.
struct Found {
    method: String,
    h: f64,
    energy: [f64; 2],
    energy_order: Option<f64>,
    attitude: [Option<f64>; 2],
    attitude_order: Option<f64>,
}

impl Found {
    fn cells(self, body: &str) -> Vec<Cell> {
        let [energy_predicted, energy_measured] = self.energy;
        let [attitude_predicted, attitude_measured] = self.attitude;
        row![
            body,
            self.method,
            self.h,
            energy_predicted,
            energy_measured,
            self.energy_order,
            attitude_predicted,
            attitude_measured,
            self.attitude_order,
        ]
        .to_vec()
    }

    /// Prediction and measurement that are more than 3 % apart.
    fn failure(&self, body: &str) -> Option<String> {
        let [predicted, measured] = self.energy;
        let pairs = [Some((predicted, measured)).filter(|pair| pair.0 > 0.0), self.rates()];
        let apart = |pair: &(f64, f64)| (pair.1 / pair.0 - 1.0).abs() > 0.03;
        let (predicted, measured) = pairs.into_iter().flatten().find(apart)?;
        Some(format!("{body}, {}: predicted {predicted:e}, measured {measured:e}", self.method))
    }

    /// Predicted and measured rate of the attitude error, where there is an h² term.
    fn rates(&self) -> Option<(f64, f64)> {
        let [predicted, measured] = self.attitude;
        predicted.filter(|rate| *rate > 1e-9).zip(measured)
    }
}

fn of_body(subject: &Subject, body: &Body, start: &Point<Dd>, plan: Plan) -> Result<Vec<Found>, Error> {
    const LOOKS: u32 = 1000;
    let Plan { coarse, span } = plan;
    let fine_step = 0.5 * coarse;
    let truth =
        Truth::from_point(body, start.to_f64(), 0.0, &evenly(span, LOOKS), AGREEMENT).map_err(unexpected)?;
    let moments: Vec3<f64> = body.rotor().moments();
    let momentum = |x: &Point<Dd>| x.momentum_body.map(|m| m.hi());
    let (m, mut found) = (momentum(start), Vec::new());
    let energy = 0.5 * m.dot(m.times(body.rotor().inverse_moments()));
    for split in Split::all() {
        let method = split.method();
        let mut measured = Vec::new();
        for h in [coarse, fine_step] {
            let run = truth.judge(method.as_ref(), h, Care::default()).map_err(unexpected)?;
            let late = run.looks.iter().filter(|look| look.elapsed >= 0.5 * span);
            let squares = late.map(|look| look.attitude_error / look.elapsed).map(|rate| rate * rate);
            let count = squares.clone().count().max(1) as f64;
            // beyond a radian the angle no longer grows with the error
            let largest = run.largest_attitude_error(span);
            let rate = largest.map(|_| libm::sqrt(squares.sum::<f64>() / count));
            measured.push((run.last.worst.energy.unwrap_or_default(), rate));
        }
        let [coarse, fine] = [measured[0], measured[1]];
        let order = |coarse: f64, fine: f64| (fine > 0.0).then(|| libm::log2(coarse / fine));
        let swing = |x: Point<Dd>| (split.term(momentum(&x), moments) - split.term(m, moments)).abs();
        let mut largest = 0.0_f64;
        for time in truth.times() {
            let x = truth.point_at(Dd::from(time)).map_err(unexpected)?;
            largest = largest.max(swing(x));
        }
        let square = fine_step * fine_step;
        found.push(Found {
            method: method.name(),
            h: fine_step,
            energy: [square * largest / energy, fine.0],
            energy_order: order(coarse.0, fine.0),
            attitude: [split.rate(m, moments).map(|rate| square * rate), fine.1],
            attitude_order: coarse.1.zip(fine.1).and_then(|(coarse, fine)| order(coarse, fine)),
        });
    }
    debug_assert_eq!(found.len(), 12, "splittings of {}", subject.name);
    Ok(found)
}
