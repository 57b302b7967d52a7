//! `polhode propagate`: one body to given times.

use std::path::PathBuf;

use clap::Args;
use polhode::body::{Body, Clock, Conserved, Point, Problem, Time};
use polhode::flow::ExactMotion;
use polhode::method::{ADAPTIVE, AnyMethod, StepError, UnknownMethod, method};
use polhode::num::{Dd, Precise};
use polhode::observe::{Errors, Monitor};
use polhode::rotation::rotation_angle;
use polhode::run::{Run, RunError, Sample, Schedule, ScheduleError};

use crate::arguments::{Times, number, positive, regular, times};
use crate::body_arguments::{BodyArguments, StartArguments};
use crate::error::{Error, warn};
use crate::force_arguments::ForceArguments;
use crate::methods::unknown;
use crate::table::{Column, Format, Rows, Table, row};

const USAGE: &str = "polhode propagate <BODY> --omega <wx,wy,wz> <TIMES> [OPTIONS]
  BODY:  --moments <I1,I2,I3> | --inertia <Ixx,...,Iyz> | --body <NAME>
  TIMES: --times <t1,t2,...> | --until <T> --every <DT>";

const EXAMPLES: &str = "Examples:
  polhode propagate --moments 1,2,3 --omega 0.4,1,-0.3 --times 0,10,1e6
  polhode propagate --body t-handle --omega 20,0.02,0.01 --until 60 --every 0.1
  polhode propagate --body gyroscope --omega 0,0,400 --until 1 --every 0.1
  polhode propagate --body phone --omega 0,10,1 --until 5 --every 1 \\
    --drag 1e-5 --method rk4 --step 0.01
  polhode propagate --moments 1,2,3 --omega 0.4,1,-0.3 --until 100 --every 10 \\
    --method dop853 --tolerance 1e-12";

/// Rotation of one body: attitude, angular velocity and errors at given times
#[derive(Args, Clone, Debug)]
#[command(override_usage = USAGE, after_help = EXAMPLES)]
pub(crate) struct Propagate {
    #[command(flatten)]
    body: BodyArguments,
    #[command(flatten)]
    start: StartArguments,
    #[command(flatten)]
    forces: ForceArguments,
    /// Output times, s, separated by commas
    #[arg(long, value_name = "t1,t2,...", value_parser = times, allow_hyphen_values = true,
          conflicts_with_all = ["until", "every"])]
    times: Option<Times>,
    /// Last output time, s, with --every
    #[arg(long, value_name = "T", value_parser = number, allow_hyphen_values = true)]
    until: Option<f64>,
    /// Time between output rows, s, with --until
    #[arg(long, value_name = "DT", value_parser = number, allow_hyphen_values = true)]
    every: Option<f64>,
    /// Time of the start, s
    #[arg(long, value_name = "t0", value_parser = number, allow_hyphen_values = true, default_value = "0")]
    start_time: f64,
    /// Method: exact, or BASE[:ARGUMENT][@SCHEME] as in kick-drift@srkn-6b; see `polhode methods` and `polhode methods --schemes`
    #[arg(long, value_name = "NAME", default_value = "exact")]
    method: String,
    /// Step, s; every method but exact needs one; of methods that choose their steps the interval of output, by default DT
    #[arg(long, value_name = "h", value_parser = positive, allow_hyphen_values = true)]
    step: Option<f64>,
    /// Tolerance of methods that choose their steps (taylor, dop853, tsit5), relative to the state
    #[arg(long, value_name = "TOL", value_parser = positive, allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// How rows are printed: table on a terminal, csv otherwise
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// Write to this file instead of standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl Propagate {
    pub(crate) fn run(&self) -> Result<(), Error> {
        let body = self.forces.act_on(self.body.heavy(self.forces.weight_moment)?)?;
        let start = self.start.inside(&body)?;
        let times = self.output_times()?;
        let table = Table::new("trajectory", "Motion of a body.", columns(&body));
        let mut rows = Rows::new(table, self.format, self.out.as_deref(), times.len())?;
        let ended = if self.method == "exact" {
            self.exact(&body, start, &times, &mut rows)
        } else {
            self.stepped(&body, start, &times, &mut rows)
        };
        if matches!(ended, Ok(()) | Err(Error::Failed(_))) {
            rows.finish()?;
        }
        ended
    }

    fn output_times(&self) -> Result<Vec<f64>, Error> {
        match (&self.times, self.until, self.every) {
            (Some(Times(times)), ..) => Ok(times.clone()),
            (None, Some(until), Some(every)) => {
                Ok(regular(self.start_time, until, every).map_err(Error::Input)?.collect())
            }
            (None, Some(until), None) => Err(Error::Input(format!(
                "--until: '{until:?}': needs the time between rows; give --every DT too"
            ))),
            (None, None, Some(every)) => Err(Error::Input(format!(
                "--every: '{every:?}': needs the last output time; give --until T too"
            ))),
            (None, None, None) => {
                Err(Error::Input("--times: missing; give --times t1,t2,... or --until T --every DT".into()))
            }
        }
    }

    fn times_flag(&self) -> &'static str {
        if self.until.is_some() { "--until" } else { "--times" }
    }

    fn exact(&self, body: &Body, start: Point<Dd>, times: &[f64], rows: &mut Rows) -> Result<(), Error> {
        if self.step.is_some() {
            return Err(Error::Input(
                "--step: --method exact takes no step; leave it out, or name a stepping method".into(),
            ));
        }
        if let Some(tolerance) = self.tolerance {
            return Err(self.without_tolerance(tolerance));
        }
        let motion = ExactMotion::from_point(body, start).map_err(|error| {
            let method = if body.problem() == Problem::Torque { "rk4" } else { "kick-drift@srkn-6b" };
            Error::Input(format!("--method exact: {error}; use --method {method} with a --step"))
        })?;
        for &t in times {
            let elapsed = t - self.start_time;
            // an overflow of the difference is out of reach too
            motion
                .check_time(elapsed)
                .map_err(|error| Error::Input(format!("{}: {t:?}: {error}", self.times_flag())))?;
        }
        let mut monitor = Monitor::new(body, Clock::new(1.0), &start.to_f64());
        for &t in times {
            let elapsed = Dd::from(t) - Dd::from(self.start_time);
            let exact = motion.point_at_dd(elapsed);
            let x = exact.to_f64();
            if monitor.observe(&[x]) == 0 {
                return Err(Error::Failed(format!(
                    "--method exact: at {t:?} s the state is not finite; use --method kick-drift@srkn-6b with a --step"
                )));
            }
            let error = rotation_angle(x.to_dd().attitude, exact.attitude).hi();
            rows.push(self::row(body, Time::from_seconds(t), (&x, &exact), monitor.worst(), Some(error)))?;
        }
        Ok(())
    }

    fn stepped(&self, body: &Body, start: Point<Dd>, times: &[f64], rows: &mut Rows) -> Result<(), Error> {
        let method = self.stepping_method()?;
        let regular = if self.is_adaptive() { self.every.filter(|every| *every > 0.0) } else { None };
        let Some(h) = self.step.or(regular) else {
            return Err(Error::Input(format!(
                "--step: missing; --method {} needs a step in seconds",
                self.method
            )));
        };
        let clock = Clock { start: self.start_time, step: h };
        let steps = Schedule::at_times(clock, times).map_err(|error| self.unreachable(&error))?;
        let mut run = Run::from_point(&method, body, start.to_f64(), clock).map_err(|error| match error {
            RunError::Step(error @ StepError::Refused { .. }) => Error::Input(format!("--method: {error}")),
            error => Error::Input(format!("--step: {error}")),
        })?;
        let speed = body.omega_of(&start).norm();
        if h * speed > 1.0 && !self.is_adaptive() {
            warn(&format!(
                "--step: '{h:?}': turns the body by {:?} rad per step; above 1 rad no stepping method is accurate; take a smaller step",
                h * speed
            ));
        }
        // without closed form the attitude error is left empty
        let exact = ExactMotion::from_point(body, run.start().to_dd()).ok();
        for (&t, n) in times.iter().zip(steps) {
            let sample = match run.advance_to(n) {
                Ok(sample) => sample,
                Err(
                    error @ (RunError::Diverged { .. }
                    | RunError::Unsolved { .. }
                    | RunError::Stuck { .. }
                    | RunError::Force { .. }
                    | RunError::OutOfRange { .. }),
                ) => {
                    return Err(Error::Failed(format!("--method {}: {error}", self.method)));
                }
                Err(error) => return Err(Error::Input(error.to_string())),
            };
            let error = exact.as_ref().map(|exact| {
                let there = exact.point_at_dd(sample.elapsed);
                rotation_angle(sample.point.to_dd().attitude, there.attitude).hi()
            });
            let point = &sample.point;
            rows.push(self::row(body, Time::from_seconds(t), (point, point), sample.worst, error))?;
            self.check_sense(&sample)?;
        }
        Ok(())
    }

    /// Refuses to go on where the numbers no longer are those of a rotation.
    fn check_sense(&self, sample: &Sample) -> Result<(), Error> {
        let norm = sample.point.attitude.norm_squared().sqrt();
        let lost = if (norm - 1.0).abs() > 0.5 {
            format!("the quaternion of the attitude has the norm {norm:.1e}, not 1")
        } else {
            let errors = [("energy", sample.worst.energy), ("|m|", sample.worst.momentum_norm)];
            match errors.into_iter().find(|(_, error)| error.is_some_and(|error| error > 1.0)) {
                Some((what, Some(error))) => format!("the relative error of {what} is {error:.1e}"),
                _ => return Ok(()),
            }
        };
        Err(Error::Failed(format!(
            "--method {}: at {:?} s {lost}: the numbers no longer describe the motion; take a smaller step or another method",
            self.method,
            sample.time.hi()
        )))
    }

    /// Whether the method chooses its steps: an order, as of taylor:20, is of steps as given.
    fn is_adaptive(&self) -> bool {
        let (base, argument) = self.method.split_once(':').unwrap_or((&self.method, ""));
        ADAPTIVE.contains(&base) && argument.parse::<u32>().is_err()
    }

    fn without_tolerance(&self, tolerance: f64) -> Error {
        let rule = format!("--method {} does not choose its steps", self.method);
        let remedy = format!("leave it out, or take one of {}", ADAPTIVE.join(", "));
        Error::input("--tolerance", &format!("{tolerance:e}"), &rule, &remedy)
    }

    fn stepping_method(&self) -> Result<Box<dyn AnyMethod>, Error> {
        let found = match self.tolerance {
            None => method(&self.method),
            Some(tolerance) if ADAPTIVE.contains(&self.method.as_str()) => {
                let named = method(&format!("{}:{tolerance:e}", self.method));
                return named.map_err(|error| match error {
                    UnknownMethod::Argument { rule, .. } => Error::input(
                        "--tolerance",
                        &format!("{tolerance:e}"),
                        &format!("--method {} cannot take it", self.method),
                        &format!("allowed: {rule}"),
                    ),
                    error => Error::Input(format!("--tolerance: {error}")),
                });
            }
            Some(tolerance) => match method(&self.method) {
                Ok(_) if self.is_adaptive() => {
                    return Err(Error::input(
                        "--tolerance",
                        &format!("{tolerance:e}"),
                        &format!("--method {} has a tolerance already", self.method),
                        "give one of the two",
                    ));
                }
                Ok(_) => return Err(self.without_tolerance(tolerance)),
                error => error,
            },
        };
        found.map_err(|error| unknown("--method", error))
    }

    /// Why no steps lead to the times that were asked for.
    fn unreachable(&self, error: &ScheduleError) -> Error {
        let step = self.step.unwrap_or_default();
        Error::Input(match *error {
            ScheduleError::NotAscending { t, before } => format!(
                "{}: {t:?} comes after {before:?}; a stepping method needs ascending times, none before --start-time; sort them, or use --method exact",
                self.times_flag()
            ),
            ScheduleError::TooMany { t, steps, .. } => format!(
                "--step: '{step:?}': takes {steps:e} steps to t = {t:?}, and at most 2^53 can be counted; take a larger step"
            ),
            ScheduleError::NotReached { t, nearest, .. } => format!(
                "--step: '{step:?}': no whole number of steps leads to the output time {t:?}; the nearest time reached is {nearest:?}"
            ),
            error => format!("--step: {error}"),
        })
    }
}

/// `x` with more digits, where there are any, as `exact`: attitude and ω are read off it.
fn row<S: Precise>(
    body: &Body,
    at: Time,
    (x, exact): (&Point<f64>, &Point<S>),
    worst: Errors,
    attitude_error: Option<f64>,
) -> Vec<crate::table::Cell> {
    let invariants = polhode::observe::Invariants::of(body, at, x);
    let [q_w, q_x, q_y, q_z] = body.leave(exact).attitude.components();
    let omega = body.omega_of(exact);
    let mut cells = row![
        at.seconds::<f64>(),
        q_w,
        q_x,
        q_y,
        q_z,
        omega.x,
        omega.y,
        omega.z,
        body.energy_of(at, x).hi(),
        invariants.momentum_norm().hi() * body.scale(),
        worst.energy,
        worst.momentum_norm,
        worst.momentum_vector,
        worst.momentum_z,
        attitude_error,
    ]
    .to_vec();
    if has_jacobi(body) {
        cells.push(worst.jacobi.into());
    }
    cells
}

/// Whether Jacobi's constant is what the motion conserves in place of the energy.
fn has_jacobi(body: &Body) -> bool {
    let conserved = body.conserved();
    !conserved.contains(&Conserved::Energy) && conserved.iter().any(|q| matches!(q, Conserved::Jacobi { .. }))
}

fn columns(body: &Body) -> Vec<Column> {
    let column = Column::new;
    let mut columns = vec![
        column("t", "s", "time").digits(6),
        column("q_w", "", "attitude, body to space, scalar part").digits(6),
        column("q_x", "", "attitude, x").digits(6),
        column("q_y", "", "attitude, y").digits(6),
        column("q_z", "", "attitude, z").digits(6),
        column("omega_body_x", "rad/s", "angular velocity, body axis x").digits(6),
        column("omega_body_y", "rad/s", "angular velocity, body axis y").digits(6),
        column("omega_body_z", "rad/s", "angular velocity, body axis z").digits(6),
        column("energy", "J", "energy").digits(6),
        column("momentum", "kg m^2/s", "size of the angular momentum").digits(6),
        column("energy_error", "", "largest relative error of the energy so far").digits(2),
        column("momentum_error", "", "largest relative error of |m| so far").digits(2),
        column("momentum_vector_error", "", "largest relative error of L in space so far").digits(2),
        column("momentum_z_error", "", "largest relative error of L along space z, under torque").digits(2),
        column("attitude_error", "rad", "angle to the exact attitude").digits(2),
    ];
    if has_jacobi(body) {
        columns.push(column("jacobi_error", "", "largest relative error of E - n L_z so far").digits(2));
    }
    columns
}
