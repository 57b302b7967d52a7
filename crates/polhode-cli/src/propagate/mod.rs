//! `polhode propagate`: one body to given times.

mod columns;
mod events;
mod through;

use std::path::PathBuf;

use clap::Args;
use polhode::body::{Body, Clock, Point, Time};
use polhode::flow::ExactMotion;
use polhode::method::{AnyMethod, Claimed, StepError};
use polhode::num::{Dd, Real};
use polhode::observe::Monitor;
use polhode::rotation::{Vec3, rotation_angle};
use polhode::run::{Run, RunError, Sample, Watch};
use polhode_files::error::Error;
use polhode_files::instant::positive_duration;
use polhode_files::numbers::{numbers, positive};
use polhode_pages::table::{Format, RowWriter};

use crate::cost;
use crate::flags::body::note_density;
use crate::flags::event::{TypedEvent, event};
use crate::flags::motion::{MotionArguments, stepping_method};
use crate::flags::times::{OutputTimes, TimeArguments};
use crate::flags::tumbling::latitude;
use crate::methods::{Unusable, adaptive, at_tolerance, moving, not_taken, unknown};
use columns::{Asked, Columns, Reading};

const USAGE: &str = "polhode propagate <BODY> [START] <TIMES> [OPTIONS]
  BODY:  --moments <I1,I2,I3> | --inertia <Ixx,...,Iyz> | --body <NAME>
  START: --omega <wx,wy,wz> | --momentum-body <mx,my,mz> | ...
         and --attitude <w,x,y,z> | --angles <phi,theta,psi> | ...
  TIMES: --times <LIST|FILE|-> | --until <T> --every <DT>|--event <EVENT>
  or --through <POSES> --every <DT> in place of START and TIMES";

const EXAMPLES: &str = "Examples:
  polhode propagate --moments 1,2,3 --omega 0.4,1,-0.3 --times 0,10,1e6
  polhode propagate --body toutatis --until 30d --every 6h --fields t,q,omega
  polhode propagate --body gyroscope --until 1 --every 0.1 --euler zxz
  polhode propagate --body toutatis --epoch 1992-11-09T17:49:47 \\
    --times 1992-11-10,1992-12-04 --fields t,omega
  polhode propagate --body phone --omega 0,10,1 --until 5 --every 1 \\
    --drag 1e-5 --method rk4 --step 0.01
  polhode propagate --moments 1,2,3 --omega 0.4,1,-0.3 --until 100 --every 10 \\
    --method dop853 --tolerance 1e-12
  polhode propagate --body t-handle --until 60 --event flip
  polhode propagate --moments 1,2,3 --omega 0.4,1,-0.3 --until 8 --every 2 \\
    --fields t,q --out poses.csv
  polhode propagate --moments 1,2,3 --through poses.csv --every 0.1
  polhode propagate --moments 1,2,3 --omega 0.4,1,-0.3 --until 1d \\
    --event 'angle(body z, space x) < 30deg' --stop";

/// Rotation of one body: attitude, angular velocity and errors at given times
///
/// The columns:
///
///   t                      time, s
///   q_w, q_x, q_y, q_z     attitude: unit quaternion, body to space, scalar first
///   omega_body_x, _y, _z   angular velocity, body axes, rad/s
///   energy                 kinetic and potential energy, J
///   momentum               |m|, the size of the angular momentum, kg m^2/s
///   energy_error           relative error of the energy
///   momentum_error         relative error of |m|
///   momentum_vector_error  relative error of L, the angular momentum in space
///   momentum_z_error       relative error of L_z, where L as a whole changes
///   jacobi_error           relative error of E - n L_z, only with the gravity
///                          gradient on a circle with the mean motion n
///   attitude_error         angle to the exact attitude, rad; empty for exact, and
///                          where there is no closed form
///   phi, theta, psi        Euler angles, rad, with --euler
///   observer_longitude,    direction to the observer in body axes, rad, with
///   observer_latitude      --observer
///   jd                     Julian date, with --epoch, where --fields names it
///
/// A relative error is the largest so far, and empty where the motion does not
/// conserve the quantity. With forces the energy error is relative to the sum of
/// kinetic energy, weight moment, potentials and torques at the start.
///
/// Exit code 1: the numbers stop being those of a rotation, as where a run
/// diverges; the rows so far are printed.
#[derive(Args, Clone, Debug)]
#[command(verbatim_doc_comment, override_usage = USAGE, after_help = EXAMPLES)]
pub(crate) struct Propagate {
    #[command(flatten)]
    motion: MotionArguments,
    #[command(flatten)]
    times: TimeArguments,
    /// Print the times at which this happens, from the start to --until: 'flip'; 'angle(body z, space x) < 10deg' (or >); 'rate > 5rad/s' (or <); 'nearest(w,x,y,z)', the nearest approach to an attitude. Repeatable
    #[arg(long = "event", value_name = "EVENT", value_parser = event, help_heading = "Events")]
    events: Vec<TypedEvent>,
    /// Stop at the first event
    #[arg(long, requires = "events", help_heading = "Events")]
    stop: bool,
    /// Exact motion through the attitudes of a file (t, q_w, q_x, q_y, q_z; body to space unless the names of its columns say otherwise), from the first to the last with --every between rows, with the error of spherical linear interpolation in the column slerp_error, rad. Exit code 1: no free motion of this body leads through them, and between them its angular momentum changes by more than a tenth
    #[arg(long, value_name = "POSES", requires = "every", help_heading = "Through attitudes",
          conflicts_with_all = ["omega", "momentum_body", "momentum_space", "attitude", "angles", "rotation", "frame", "to_frame", "periods", "times", "times_column", "until", "start_time", "events", "method", "step", "tolerance"])]
    through: Option<PathBuf>,
    /// Largest number of turns between two attitudes, at the mean spin 2E/|L| [default: 1]
    #[arg(long, value_name = "N", value_parser = positive, allow_hyphen_values = true, requires = "through", help_heading = "Through attitudes")]
    turns: Option<f64>,
    /// Method: exact, or BASE[:ARGUMENT][@SCHEME][+phase] as in kick-drift@srkn-6b; see `polhode methods` and `polhode methods --schemes`
    ///
    /// dissipating:LOSS[@SCHEME] is for a body with inner friction, which loses energy and keeps its angular momentum
    #[arg(long, value_name = "NAME", default_value = "exact", help_heading = "Method")]
    method: String,
    /// Step of a method with fixed steps, s; exact takes none; taylor, dop853 and tsit5 need none
    #[arg(long, value_name = "h", value_parser = positive_duration, allow_hyphen_values = true, help_heading = "Method")]
    step: Option<f64>,
    /// Relative tolerance of the methods that choose their steps: taylor, dop853, tsit5
    #[arg(long, value_name = "TOL", value_parser = positive, allow_hyphen_values = true, help_heading = "Method")]
    tolerance: Option<f64>,
    /// Direction to an observer in space: longitude from x towards y and latitude, rad or --angle-unit. Adds the sub-observer point: observer_longitude and observer_latitude, body axes, rad
    #[arg(long, value_name = "lambda,beta", value_parser = numbers::<2>, allow_hyphen_values = true, help_heading = "Output")]
    observer: Option<[f64; 2]>,
    /// Columns to print, separated by commas: t, jd (with --epoch), q, omega, energy, momentum, errors, euler, observer, or names of single columns [default: all but jd]
    #[arg(long, value_name = "NAMES", value_delimiter = ',', help_heading = "Output")]
    fields: Vec<String>,
    /// How rows are printed [default: table on a terminal, csv otherwise]
    #[arg(long, value_enum, help_heading = "Output")]
    format: Option<Format>,
    /// Write to this file instead of standard output; its ending names the format: .csv, .json or .txt
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    out: Option<PathBuf>,
}

impl Propagate {
    pub(crate) fn run(&self) -> Result<(), Error> {
        let angles = ["euler", "phi", "theta", "psi"];
        let prints_angles =
            self.fields.is_empty() || self.fields.iter().any(|field| angles.contains(&field.as_str()));
        self.motion.start.check_angles(self.observer.is_some(), prints_angles)?;
        let t = self.times.start()?;
        let body = self.motion.body(t)?;
        if let Some(file) = &self.through {
            return self.through(&body, file);
        }
        if !self.events.is_empty() {
            return self.look_for_events(&body);
        }
        let columns = Columns::chosen(&self.fields, self.asked()?, &body)?;
        let start = self.motion.start(&body, t)?;
        let times = self.times.output()?;
        self.compare_epoch();
        if self.method == "exact" {
            self.exact(&body, start, &times, columns)
        } else {
            self.stepped(&body, start, &times, columns)
        }
    }

    /// Says what the start of the catalogue refers to, where it is that of the motion, and the density of a mesh.
    pub(crate) fn note(&self) {
        match (&self.through, self.motion.body.mesh()) {
            (None, _) => self.motion.note(),
            (Some(_), Some(file)) => note_density(file),
            (Some(_), None) => {}
        }
    }

    /// What columns are worked out by beside the motion.
    fn asked(&self) -> Result<Asked, Error> {
        let unit = self.motion.start.angle_unit();
        if let Some(observer) = self.observer {
            latitude(observer, unit).map_err(|error| Error::Input(format!("--observer: {error}")))?;
        }
        let observer = self.observer.map(|angles| {
            let [(sin, cos), (up, across)] = angles.map(|angle| Real::sin_cos(angle * unit));
            Vec3([cos * across, sin * across, up])
        });
        let epoch = self.times.epoch().map(|epoch| epoch.date);
        Ok(Asked { sequence: self.motion.start.euler, observer, epoch })
    }

    fn compare_epoch(&self) {
        let published = self.motion.body.published_start().filter(|_| !self.motion.start.has_attitude());
        if let Some(epoch) = published.and_then(|start| start.orientation?.epoch) {
            self.times.compare_epoch(epoch);
        }
    }

    /// The rows that `fill` writes, also where it fails after some of them.
    fn write(
        &self,
        columns: &Columns,
        count: Option<usize>,
        fill: impl FnOnce(&mut RowWriter) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let mut rows = RowWriter::new(columns.table(), self.format, self.out.as_deref(), count)?;
        let ended = fill(&mut rows);
        if matches!(ended, Ok(()) | Err(Error::Failed(_))) {
            rows.finish()?;
        }
        ended
    }

    fn exact_motion(&self, body: &Body, start: Point<Dd>) -> Result<ExactMotion, Error> {
        if self.step.is_some() {
            return Err(Error::Input(
                "--step: --method exact takes no step; leave it out, or name a stepping method".into(),
            ));
        }
        if let Some(tolerance) = self.tolerance {
            return Err(self.without_tolerance(tolerance));
        }
        ExactMotion::from_point(body, start).map_err(|error| {
            let method = stepping_method(body);
            Error::Input(format!("--method exact: {error}; use --method {method} with a --step"))
        })
    }

    fn exact(
        &self,
        body: &Body,
        start: Point<Dd>,
        times: &OutputTimes,
        columns: Columns,
    ) -> Result<(), Error> {
        let motion = self.exact_motion(body, start)?;
        let start_time = self.times.start()?;
        let check = |t: f64| {
            // an overflow of the difference is out of reach too
            let checked = motion.check_time(t - start_time);
            checked.map_err(|error| Error::Input(format!("{}: {t:?}: {error}", self.times.flag())))
        };
        let count = times.check(check)?;
        let mut monitor = columns.errors().then(|| Monitor::new(body, Clock::new(1.0), &start.to_f64()));
        self.write(&columns, count, |rows| {
            for t in times.iter()? {
                let t = t?;
                check(t)?;
                let elapsed = Dd::from(t) - Dd::from(start_time);
                let x = motion.point_at(elapsed);
                let finite = monitor.as_mut().map_or(x.is_finite(), |monitor| monitor.observe(&[x]) == 1);
                if !finite {
                    return Err(Error::Failed(format!(
                        "--method exact: at {t:?} s the state is not finite; use --method kick-drift@srkn-6b with a --step"
                    )));
                }
                let reading = Reading {
                    // the start is what was typed
                    state: if elapsed == Dd::ZERO { body.leave(&start) } else { body.leave(&x) },
                    omega: if elapsed == Dd::ZERO { body.omega_of(&start) } else { body.omega_of(&x) },
                    at: Time::from_seconds(t),
                    point: &x,
                    worst: monitor.as_ref().map(Monitor::worst),
                    attitude_error: None,
                };
                rows.push(columns.cells(body, &reading))?;
            }
            Ok(())
        })
    }

    fn stepped(
        &self,
        body: &Body,
        start: Point<Dd>,
        times: &OutputTimes,
        columns: Columns,
    ) -> Result<(), Error> {
        let method = self.stepping_method()?;
        let adaptive = method.tolerance().is_some();
        let speed = body.omega_of(&start).norm();
        // the errors of a method that chooses its steps are watched at each output, or at each radian of the turn
        let regular = self.times.every().filter(|every| *every > 0.0);
        let watched =
            regular.unwrap_or(if speed > 0.0 { libm::exp2(-libm::ceil(libm::log2(speed))) } else { 1.0 });
        let h = self.step_or(adaptive.then_some(watched))?;
        let clock = Clock { start: self.times.start()?, step: h };
        let chosen = adaptive.then_some(speed);
        let mut before = clock.start;
        let count = times.check(|t| self.check_time(clock, chosen, &mut before, t))?;
        let last = ((before - clock.start) / h) as u64;
        let mut run = run_of(&method, body, start, clock)?;
        if !columns.errors() {
            run = run.watching(Watch::Never);
        }
        if !adaptive {
            cost::warn_coarse("--step", h, speed);
        }
        let turn = speed * (before - clock.start);
        let trial = if adaptive && speed > 0.0 {
            (Clock { step: h.min(1.0 / speed), ..clock }, libm::ceil(turn) as u64)
        } else {
            (clock, last)
        };
        cost::announce(method.as_ref(), body, start.to_f64(), trial.0, trial.1);
        // without closed form the attitude error is left empty
        let exact = columns.attitude_error().then(|| ExactMotion::from_point(body, run.start().to_dd()).ok());
        let exact = exact.flatten();
        self.write(&columns, count, |rows| {
            let mut before = clock.start;
            for t in times.iter()? {
                let t = t?;
                self.check_time(clock, chosen, &mut before, t)?;
                let sample = run.at(t).map_err(|error| self.ended(error))?;
                let error = exact.as_ref().map(|exact| {
                    let there = exact.point_at_dd(sample.elapsed);
                    rotation_angle(sample.point.to_dd().attitude, there.attitude).hi()
                });
                let reading = Reading {
                    state: sample.state,
                    omega: sample.omega_body,
                    at: Time::from_seconds(t),
                    point: &sample.point,
                    worst: columns.errors().then_some(sample.worst),
                    attitude_error: error,
                };
                rows.push(columns.cells(body, &reading))?;
                self.check_sense(&sample)?;
            }
            Ok(())
        })
    }

    /// Why a run cannot go on.
    fn ended(&self, error: RunError) -> Error {
        match error {
            RunError::Diverged { .. }
            | RunError::Unsolved { .. }
            | RunError::Stuck { .. }
            | RunError::Force { .. }
            | RunError::Nonsense { .. }
            | RunError::OutOfRange { .. } => Error::Failed(format!("--method {}: {error}", self.method)),
            error => Error::Input(error.to_string()),
        }
    }

    /// The step that was given, else `chosen`.
    fn step_or(&self, chosen: Option<f64>) -> Result<f64, Error> {
        self.step.or(chosen).ok_or_else(|| {
            Error::Input(format!("--step: missing; --method {} needs a step in seconds", self.method))
        })
    }

    /// Refuses a time `t` that comes before `before`, or that takes too many steps; of a method that chooses its steps `speed` is
    /// |ω| at the start.
    fn check_time(&self, clock: Clock, speed: Option<f64>, before: &mut f64, t: f64) -> Result<(), Error> {
        if t < *before {
            return Err(Error::Input(format!(
                "{}: {t:?} comes after {:?}; a stepping method needs ascending times, none before --start-time; sort them, or use --method exact",
                self.times.flag(),
                *before
            )));
        }
        *before = t;
        let steps = (t - clock.start) / clock.step;
        cost::check("--step", clock.step, steps, "use a larger step or an earlier time")?;
        if let Some(speed) = speed {
            cost::check_turn(self.times.flag(), t, speed * (t - clock.start))?;
        }
        Ok(())
    }

    /// Refuses to go on where the numbers no longer are those of a rotation.
    fn check_sense(&self, sample: &Sample) -> Result<(), Error> {
        sample.nonsense().map_or(Ok(()), |why| Err(Error::Failed(format!("--method {}: {why}", self.method))))
    }

    fn without_tolerance(&self, tolerance: f64) -> Error {
        let rule = format!("--method {} does not choose its steps", self.method);
        let remedy = format!("leave it out, or use one of {}", adaptive());
        Error::input("--tolerance", &format!("{tolerance:e}"), &rule, &remedy)
    }

    fn stepping_method(&self) -> Result<Box<dyn AnyMethod>, Error> {
        let Some(tolerance) = self.tolerance else { return moving("--method", &self.method) };
        at_tolerance(&self.method, tolerance).map_err(|why| match why {
            Unusable::Unknown(error) => unknown("--method", error),
            Unusable::FixedSteps => self.without_tolerance(tolerance),
            Unusable::Twice => Error::input(
                "--tolerance",
                &format!("{tolerance:e}"),
                &format!("--method {} has a tolerance already", self.method),
                "give one of the two",
            ),
            Unusable::OutOfRange(allowed) => not_taken("--tolerance", tolerance, &self.method, &allowed),
        })
    }
}

/// The run from `start` on, unless the method or the step is not for it.
fn run_of(method: &dyn AnyMethod, body: &Body, start: Point<Dd>, clock: Clock) -> Result<Run, Error> {
    Run::from_point(method, body, start.to_f64(), clock).map_err(|error| match error {
        RunError::Step(error @ StepError::Refused { .. }) => Error::Input(format!("--method: {error}")),
        error => Error::Input(format!("--step: {error}")),
    })
}
