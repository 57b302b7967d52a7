//! `polhode compare`: methods at steps and tolerances on one body, against its true motion.

mod entries;
mod phase;
mod rows;
pub(crate) mod trajectory;

use std::path::PathBuf;

use clap::Args;
use polhode::method::Claimed;
use polhode::run::RunError;
use polhode::truth::{AGREEMENT, Care, Judged, Truth, TruthError, evenly};
use polhode_experiments::timing::StepTime;
use polhode_files::error::{Error, warn};
use polhode_files::instant::duration;
use polhode_files::text::short;
use polhode_pages::figure::{Curve, Figure};
use polhode_pages::output::Output;
use polhode_pages::table::{Format, Table};

use crate::flags::attitude::{check_used, of_order};
use crate::flags::motion::MotionArguments;
use crate::flags::table::{Order, TableArguments};
use crate::flags::times::span_until;
use crate::plot::Picture;
use entries::{Entry, Positives, positives};
use trajectory::Trajectory;

const USAGE: &str = "polhode compare <BODY> <START> --methods <A,...> --until <T> [OPTIONS]
  BODY:  --moments <I1,I2,I3> | --inertia <Ixx,...,Iyz> | --body <NAME>
  START: --omega <wx,wy,wz> [--attitude <w,x,y,z>]";

const EXAMPLES: &str = "Examples:
  polhode compare --moments 1,2,3 --omega 0.4,1,-0.3 --until 100 \\
    --methods rk4,rattle,two-turn@blanes-moan-s6 --steps 0.1,0.05,0.025 \\
    --figure work.svg
  polhode compare --body gyroscope --omega 0,0,400 --until 1 \\
    --methods kick-drift@srkn-11b,dop853 --steps 1e-3 --tolerances 1e-8,1e-12
  polhode propagate --moments 1,2,3 --omega 0.4,1,-0.3 --until 10 --every 1 \\
    --method mujoco-rk4 --step 0.01 --fields t,q,omega --out simulator.csv
  polhode compare --moments 1,2,3 --omega 0.4,1,-0.3 --until 10 \\
    --methods rk4 --steps 0.01 --trajectory simulator.csv";

/// Looks at the attitude of a run, at equal distances.
const LOOKS: u32 = 64;

/// Errors, cost and flips of methods on a body, against its true motion
///
/// The true motion is the closed form where there is one, else two runs in double-double, as long as they agree.
///
/// Columns: attitude_error, angle to the true attitude at the end, rad, where more than 1 rad counts as lost; largest_attitude_error, the
/// largest up to then; energy_error, momentum_error and so on, as in `propagate`; evaluations, number of elementary operations of the
/// method (forces, turns, exact free motions, solutions of implicit equations); seconds, processor time of the run without the check of
/// its errors; rk4_steps, this time over that of a step of rk4 on the same body, measured side by side; flips and flips_exact, how often
/// the body turned over, and should have; status, ok or what became of the run. The table leaves some of them out.
///
/// Exit code 0: compared; 1: the rates of a trajectory contradict its attitudes, or none of its rows after the start is compared.
#[derive(Args, Clone, Debug)]
#[command(override_usage = USAGE, after_help = EXAMPLES)]
pub(crate) struct Compare {
    #[command(flatten)]
    pub(crate) motion: MotionArguments,
    /// Methods, separated by commas: BASE[:ARGUMENT][@SCHEME][+phase] as in kick-drift@srkn-6b; see `polhode methods`
    #[arg(long, value_name = "A,B,...", value_delimiter = ',', required = true, help_heading = "Methods")]
    methods: Vec<String>,
    /// Steps of the methods, s, separated by commas; T must be a whole number of each
    #[arg(long, value_name = "h1,h2,...", value_parser = positives, allow_hyphen_values = true, help_heading = "Methods")]
    steps: Option<Positives>,
    /// Tolerances of the methods that choose their steps (taylor, dop853, tsit5) [default: that of the method]
    #[arg(long, value_name = "TOL1,TOL2,...", value_parser = positives, allow_hyphen_values = true, help_heading = "Methods")]
    tolerances: Option<Positives>,
    /// The end: s, or with a unit, as 30d
    #[arg(long, value_name = "T", value_parser = duration, allow_hyphen_values = true, help_heading = "Times")]
    until: f64,
    /// Time of the start: s, or with a unit
    #[arg(long, value_name = "t0", value_parser = duration, allow_hyphen_values = true, default_value = "0", help_heading = "Times")]
    start_time: f64,
    /// Add a trajectory of another program as a row; repeatable. The file is one with attitudes that `polhode audit` reads, in the
    /// convention that its rows show; the motion of another body is refused. Where it has angular velocities, the row also has its
    /// errors of energy and momentum and its flips, counted from row to row: rows far apart miss flips. Rates that contradict the
    /// attitudes are reported as status, and make the exit code 1
    #[arg(long, value_name = "FILE.csv", help_heading = "Methods")]
    trajectory: Vec<PathBuf>,
    #[command(flatten)]
    table: TableArguments,
    /// Place of the scalar in the quaternions of trajectories [default: as named, else found from the rows]
    #[arg(long, value_enum, requires = "trajectory", help_heading = "Reading")]
    quaternion: Option<Order>,
    /// Predict the attitude error at the end from a short run: how fast it grows as a shift in time along the polhode (s/s) and as
    /// a twist about L (rad/s). For methods that keep energy and |m| of a free body within bounds, without forces or under weak
    /// ones. Oscillations and rounding are not included
    #[arg(long, help_heading = "Output")]
    phase: bool,
    /// Draw attitude error against processor time to this file
    #[arg(long, value_name = "FILE.svg|.png", help_heading = "Output")]
    figure: Option<PathBuf>,
    /// How rows are printed: table on a terminal, csv otherwise
    #[arg(long, value_enum, help_heading = "Output")]
    format: Option<Format>,
    /// Write to this file instead of standard output
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    out: Option<PathBuf>,
}

impl Compare {
    pub(crate) fn run(&self) -> Result<(), Error> {
        self.motion.start.check_angles(false, false)?;
        let body = self.motion.body(self.start_time)?;
        let start = self.motion.start(&body, self.start_time)?;
        let span = span_until(self.start_time, self.until)?;
        self.table.check_read(!self.trajectory.is_empty(), "--trajectory FILE")?;
        let entries = self.entries(span)?;
        let speed = body.omega_of(&start).norm();
        for entry in &entries {
            self.check_cost(entry, &body, &start, speed, span)?;
            phase::check(entry, &body, &start, [self.start_time, span])?;
        }
        let trajectories: Vec<Trajectory> = self
            .trajectory
            .iter()
            .map(|path| {
                let order = self.quaternion.map(Into::into);
                Trajectory::read(path, &self.table, order, &body, (self.start_time, self.until))
            })
            .collect::<Result<_, _>>()?;
        let has_quaternions = trajectories.iter().any(|trajectory| trajectory.has_quaternions);
        check_used(of_order(self.quaternion), has_quaternions, "a quaternion")?;
        // a place that cannot be written is found out before the work
        let figure_file = self.figure.as_deref().map(|path| {
            let picture = Picture::of("--figure", path, &[Picture::Svg, Picture::Png])?;
            Ok::<_, Error>((Output::to_file("--figure", path)?, picture))
        });
        let figure_file = figure_file.transpose()?;
        let output = Output::new(self.out.as_deref())?;
        let times = evenly(span, LOOKS);
        let truth = Truth::from_point(&body, start.to_f64(), self.start_time, &times, AGREEMENT);
        let truth = truth.map_err(|error| match error {
            TruthError::NotFollowed(_) => Error::Input(error.to_string()),
            error => Error::Input(format!("--until: {:?}: {error}", times.last().copied().unwrap_or(span))),
        })?;
        let known = truth.known_until();
        if known < span {
            let (until, known) = (short(self.until), short(self.start_time + known));
            warn(&format!(
                "--until: '{until}': two runs in double-double agree only up to t = {known}; attitude errors and flips are those at that time"
            ));
        }
        let mut table = Table::new("comparison", "Methods on one body.", self.columns(&body));
        let mut figure = Figure::log_log(
            "comparison",
            format!("Attitude error against processor time: {}, {} s", self.motion.body.label(), short(span)),
            "processor time (steps of rk4)",
            "attitude error (rad)",
        );
        for entry in &entries {
            let (judged, time) = self.judged(&truth, entry)?;
            let steps = judged.last.steps as f64;
            let spent = (time.seconds * steps, time.seconds / time.rk4 * steps);
            let mut row = self.row(&truth, entry, &judged, spent);
            if self.phase {
                row.extend(phase::cells(entry, &body, &start, [self.start_time, span]));
            }
            table.push(row);
            if let Some(error) = judged.attitude_error() {
                match figure.series.iter_mut().find(|series| series.name == entry.family) {
                    Some(series) => series.points.push((spent.1, error)),
                    None => figure.series.push(Curve::new(entry.family.clone(), vec![(spent.1, error)])),
                }
            }
        }
        let end = self.start_time + known.min(span);
        let mut failures: Vec<(&str, Vec<&str>)> = Vec::new();
        for trajectory in &trajectories {
            let (row, failure) = self.foreign(&truth, trajectory)?;
            table.push(row);
            if let Some(failure) = failure {
                match failures.iter_mut().find(|(known, _)| *known == failure) {
                    Some((_, names)) => names.push(trajectory.name.as_str()),
                    None => failures.push((failure, vec![trajectory.name.as_str()])),
                }
            }
            let is_judged = |t: &f64| *t - self.start_time <= known;
            let last = trajectory.rows.iter().rev().map(|row| row.t).find(is_judged);
            if let Some(last) = last.filter(|t| *t < end - 1e-9 * span) {
                let (name, end, last) = (&trajectory.name, short(end), short(last));
                warn(&format!(
                    "{name}: its last row is at t = {last} s: its errors are those at that time, and those of the methods are at t = {end} s"
                ));
            }
        }
        for series in &mut figure.series {
            series.points.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        if let Some((file, picture)) = figure_file {
            if figure.series.is_empty() {
                return Err(Error::Failed(
                    "--figure: every attitude is lost, and nothing is left to draw; use smaller steps or an earlier end".into(),
                ));
            }
            crate::plot::write(file, picture, &figure.page())?;
        }
        output.write_whole(&Format::of(self.format, self.out.as_deref())?.write(&table))?;
        if failures.is_empty() {
            return Ok(());
        }
        let told = failures.iter().map(|(failure, names)| format!("{failure}: {}", names.join(", ")));
        Err(Error::Failed(told.collect::<Vec<_>>().join("; ")))
    }

    fn judged(&self, truth: &Truth, entry: &Entry) -> Result<(Judged, StepTime), Error> {
        let step = entry.step.or(truth.times().next()).unwrap_or(self.until - self.start_time);
        let judged =
            truth.judge(entry.method.as_ref(), step, Care::default()).map_err(|error| match error {
                RunError::Step(error) => Error::Input(format!("--methods: {error}")),
                error => Error::Failed(format!("{}: {error}", entry.method.name())),
            })?;
        Ok((judged, StepTime::of(entry.method.as_ref(), truth, step)?))
    }
}
