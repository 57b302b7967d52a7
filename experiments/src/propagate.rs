//! `polhode propagate`: one body to given times.

use std::path::PathBuf;

use clap::Args;
use polhode::body::{Body, State};
use polhode::method::{AnyMethod, StepError, UnknownMethod, catalogue, method};
use polhode::num::{Dd, Precise};
use polhode::observe::{Errors, Monitor};
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode::run::{Run, RunError};

use crate::arguments::{Times, number, numbers, positive, regular, times};
use crate::body_arguments::{BodyArguments, StartArguments};
use crate::error::{Error, warn};
use crate::files::emit;
use crate::reference::Reference;
use crate::table::{Column, Format, Table, row};

const USAGE: &str = "polhode propagate <BODY> --omega <wx,wy,wz> <TIMES> [OPTIONS]
  BODY:  --moments <I1,I2,I3> | --inertia <Ixx,...,Iyz> | --body <NAME>
  TIMES: --times <t1,t2,...> | --until <T> --every <DT>";

/// One body to given times: attitude, angular velocity and errors at each
#[derive(Args, Clone, Debug)]
#[command(override_usage = USAGE)]
pub(crate) struct Propagate {
    #[command(flatten)]
    body: BodyArguments,
    #[command(flatten)]
    start: StartArguments,
    /// Weight moment M g x centre of mass, body axes: the body has a fixed point under gravity along -Z of space
    #[arg(long, value_name = "cx,cy,cz", value_parser = numbers::<3>, allow_hyphen_values = true)]
    weight_moment: Option<[f64; 3]>,
    /// Output times, s
    #[arg(long, value_name = "t1,t2,...", value_parser = times, allow_hyphen_values = true,
          conflicts_with_all = ["until", "every"])]
    times: Option<Times>,
    /// Last output time, s, with --every
    #[arg(long, value_name = "T", value_parser = number, allow_hyphen_values = true)]
    until: Option<f64>,
    /// Distance of output times, s, with --until
    #[arg(long, value_name = "DT", value_parser = number, allow_hyphen_values = true)]
    every: Option<f64>,
    /// Time of the start, s
    #[arg(long, value_name = "t0", value_parser = number, allow_hyphen_values = true, default_value = "0")]
    start_time: f64,
    /// Method: exact, or one of `polhode methods`
    #[arg(long, value_name = "NAME", default_value = "exact")]
    method: String,
    /// Step of a stepping method, s
    #[arg(long, value_name = "h", value_parser = positive, allow_hyphen_values = true)]
    step: Option<f64>,
    /// How rows are printed: table on a terminal, csv otherwise
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// Write to this file instead of standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl Propagate {
    pub(crate) fn run(&self) -> Result<(), Error> {
        let body = self.body.heavy(self.weight_moment)?;
        let start = self.start.inside(&body)?;
        let times = self.output_times()?;
        let mut table = Table::new("trajectory", "Motion of a free body.", columns());
        let ended = if self.method == "exact" {
            self.exact(&body, start, &times, &mut table)
        } else {
            self.stepped(&body, start, &times, &mut table)
        };
        if matches!(ended, Ok(()) | Err(Error::Failed(_))) {
            emit(&Format::or_default(self.format, self.out.is_some()).write(&table), self.out.as_deref())?;
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
                "--until: '{until:?}': needs the distance of the rows; give --every DT too"
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

    fn exact(&self, body: &Body, start: State<Dd>, times: &[f64], table: &mut Table) -> Result<(), Error> {
        if self.step.is_some() {
            return Err(Error::Input(
                "--step: has no meaning with --method exact, which needs none; leave it out, or name a method".into(),
            ));
        }
        let motion = Reference::new(body, start).map_err(|error| {
            Error::Input(format!("--method exact: {error}; take kick-drift:4 and a --step"))
        })?;
        for &t in times {
            let elapsed = t - self.start_time;
            // an overflow of the difference is out of reach too
            motion
                .check(elapsed)
                .map_err(|error| Error::Input(format!("{}: {t:?}: {error}", self.times_flag())))?;
        }
        let mut monitor = Monitor::new(body, &rounded(&start));
        for &t in times {
            let elapsed = Dd::from(t) - Dd::from(self.start_time);
            let exact = motion.inside_at_dd(elapsed);
            let x = rounded(&exact);
            if monitor.observe(&[x]) == 0 {
                return Err(Error::Failed(format!(
                    "--method exact: at {t:?} s the state is not finite; take kick-drift:4 and a --step"
                )));
            }
            let error = rotation_angle(State::<Dd>::of(x).attitude, exact.attitude).hi();
            table.push(self::row(body, t, &x, monitor.worst(), Some(error)));
        }
        Ok(())
    }

    fn stepped(&self, body: &Body, start: State<Dd>, times: &[f64], table: &mut Table) -> Result<(), Error> {
        let method = self.stepping_method()?;
        let Some(h) = self.step else {
            return Err(Error::Input(format!(
                "--step: missing; --method {} needs a step in seconds",
                self.method
            )));
        };
        let steps = self.step_counts(h, times)?;
        let mut run =
            Run::new(method.as_ref(), body, &body.leave(&start), h).map_err(|error| match error {
                RunError::Step(error @ StepError::Torque { .. }) => {
                    Error::Input(format!("--weight-moment: {error}"))
                }
                error => Error::Input(format!("--step: {error}")),
            })?;
        let speed = body.omega_body(&start).norm();
        if h * speed > 1.0 {
            warn(&format!(
                "--step: '{h:?}': turns the body by {:?} rad a step; above 1 rad expect little of any stepping method, take a smaller one",
                h * speed
            ));
        }
        // a heavy body that is no Lagrange top has no closed form: its attitude error is left empty
        let exact = Reference::new(body, State::of(run.start())).ok();
        for (&t, n) in times.iter().zip(steps) {
            let sample = match run.advance_to(n) {
                Ok(sample) => sample,
                Err(error @ (RunError::Diverged { .. } | RunError::Unsolved { .. })) => {
                    return Err(Error::Failed(format!("--method {}: {error}", self.method)));
                }
                Err(error) => return Err(Error::Input(error.to_string())),
            };
            let error = exact.as_ref().map(|exact| {
                let there = exact.inside_at_dd(sample.elapsed);
                rotation_angle(State::<Dd>::of(sample.inside).attitude, there.attitude).hi()
            });
            table.push(self::row(body, t, &sample.inside, sample.worst, error));
        }
        Ok(())
    }

    fn stepping_method(&self) -> Result<Box<dyn AnyMethod>, Error> {
        method(&self.method).map_err(|error| match error {
            UnknownMethod::Name { name } => {
                let mut known: Vec<String> = catalogue().iter().map(|method| method.name()).collect();
                known.insert(0, "exact".into());
                Error::unknown_name("--method", "method", &name, known.iter().map(String::as_str))
            }
            UnknownMethod::Argument { name, rule } => Error::input(
                "--method",
                &name,
                "has an argument that it cannot take",
                &format!("allowed: {rule}"),
            ),
        })
    }

    /// The whole number of steps to each time.
    fn step_counts(&self, h: f64, times: &[f64]) -> Result<Vec<u64>, Error> {
        let start = self.start_time;
        let mut counts = Vec::with_capacity(times.len());
        let mut before = start;
        for &t in times {
            if t < before {
                return Err(Error::Input(format!(
                    "{}: {t:?} comes after {before:?}; a stepping method wants ascending times from --start-time on, use --method exact or sort them",
                    self.times_flag()
                )));
            }
            before = t;
            let n = ((t - start) / h).round();
            if n >= 9_007_199_254_740_992.0 {
                return Err(Error::Input(format!(
                    "--step: '{h:?}': takes {n:e} steps to t = {t:?}, and at most 2^53 can be counted; take a larger step"
                )));
            }
            let reached = (Dd::from(start) + Dd::product(n, h)).to_f64();
            if (reached - t).abs() > 4.0 * ulp(t.abs().max(start.abs()).max(h)) {
                return Err(Error::Input(format!(
                    "--step: '{h:?}': does not reach the output time {t:?} in whole steps; the nearest time that it reaches is {reached:?}"
                )));
            }
            counts.push(n as u64);
        }
        Ok(counts)
    }
}

/// Distance of doubles at `x` > 0.
fn ulp(x: f64) -> f64 {
    x.next_up() - x
}

fn rounded(x: &State<Dd>) -> State<f64> {
    State {
        attitude: Quat::from_components(x.attitude.components().map(Dd::hi)),
        momentum_body: Vec3(x.momentum_body.0.map(Dd::hi)),
    }
}

fn row(
    body: &Body,
    t: f64,
    inside: &State<f64>,
    worst: Errors,
    attitude_error: Option<f64>,
) -> Vec<crate::table::Cell> {
    let invariants = polhode::observe::Invariants::of(body, inside);
    let [w, x, y, z] = body.leave(inside).attitude.components();
    let omega = body.omega_body(inside);
    row![
        t,
        w,
        x,
        y,
        z,
        omega.x,
        omega.y,
        omega.z,
        body.energy(inside),
        invariants.momentum().hi() * body.scale(),
        worst.energy,
        worst.momentum,
        worst.momentum_vector,
        worst.momentum_z,
        attitude_error,
    ]
    .to_vec()
}

fn columns() -> Vec<Column> {
    let column = Column::new;
    vec![
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
    ]
}
