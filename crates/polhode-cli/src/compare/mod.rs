//! `polhode compare`: methods at steps and tolerances on one body, against its true motion.

mod trajectory;

use std::path::PathBuf;

use clap::Args;
use polhode::body::{Body, Clock, Point};
use polhode::method::{AnyMethod, Claimed, ToleranceError};
use polhode::num::Dd;
use polhode::run::{RunError, Schedule, ScheduleError};
use polhode::truth::{AGREEMENT, Care, Ending, Judged, Truth, TruthError, evenly};
use polhode_experiments::timing::StepTime;
use polhode_files::error::{Error, warn};
use polhode_files::moment::duration;
use polhode_files::numbers::{list, positive};
use polhode_files::text::short;
use polhode_pages::figure::{Figure, Curve};
use polhode_pages::output::{Output, emit};
use polhode_pages::table::{Cell, Column, Format, Table, row};

use crate::cost;
use crate::flags::motion::MotionArguments;
use crate::flags::table::{Order, TableArguments};
use crate::methods::{adaptive, allowed, named, not_taken};
use crate::plot::Picture;
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
    --method mujoco-rk4 --step 0.01 --out simulator.csv
  polhode compare --moments 1,2,3 --omega 0.4,1,-0.3 --until 10 \\
    --methods rk4 --steps 0.01 --trajectory simulator.csv";

/// Looks at the attitude of a run, at equal distances.
const LOOKS: u32 = 64;

/// Errors, cost and flips of methods on a body, against its true motion
///
/// The true motion is the closed form of a free body or a symmetric top; of any other body two runs in double-double, as long as
/// they agree. attitude_error: angle at the end, rad; an attitude that is more than 1 rad off counts as lost. evaluations: number
/// of elementary operations of the method: forces, turns, exact free motions, solutions of implicit equations. seconds:
/// processor time of the run without the check of its errors. rk4_steps: that time over the time of a step of rk4 on this
/// body, measured side by side.
#[derive(Args, Clone, Debug)]
#[command(override_usage = USAGE, after_help = EXAMPLES)]
pub(crate) struct Compare {
    #[command(flatten)]
    motion: MotionArguments,
    /// Methods, separated by commas: BASE[:ARGUMENT][@SCHEME] as in kick-drift@srkn-6b; see `polhode methods`
    #[arg(long, value_name = "A,B,...", value_delimiter = ',', required = true, help_heading = "Methods")]
    methods: Vec<String>,
    /// Steps of the methods, s, separated by commas; a whole number of each leads to T
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
    /// A trajectory of another program as one more row: any file with an attitude that `polhode audit` reads, in the convention
    /// that its rows show; with an angular velocity also its errors of energy and momentum and its flips, at the rows of the
    /// file; repeatable
    #[arg(long, value_name = "FILE.csv", help_heading = "Methods")]
    trajectory: Vec<PathBuf>,
    #[command(flatten)]
    table: TableArguments,
    /// State the place of the scalar in the quaternions of trajectories [default: as named, else found from the rows]
    #[arg(long, value_enum, help_heading = "Reading")]
    quaternion: Option<Order>,
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

/// Numbers above zero, a value of its own because clap reads `Vec` as a repeated flag.
#[derive(Clone, Debug)]
struct Positives(Vec<f64>);

fn positives(text: &str) -> Result<Positives, String> {
    let _ = list(text)?;
    let items = text.split(',').enumerate();
    let item = |(k, item)| positive(item).map_err(|error| format!("item {}: {error}", k + 1));
    items.map(item).collect::<Result<_, _>>().map(Positives)
}

/// A method with the step or the tolerance that it is run with.
struct Entry {
    method: Box<dyn AnyMethod>,
    /// Stem of its name, the same at every step and tolerance.
    family: String,
    step: Option<f64>,
    tolerance: Option<f64>,
}

impl Compare {
    pub(crate) fn run(&self) -> Result<(), Error> {
        let body = self.motion.body()?;
        let start = self.motion.start(&body)?;
        let span = self.span()?;
        let entries = self.entries(span)?;
        let speed = body.omega_of(&start).norm();
        for entry in &entries {
            self.check_cost(entry, &body, &start, speed, span)?;
        }
        let trajectories: Vec<Trajectory> = self
            .trajectory
            .iter()
            .map(|path| {
                let order = self.quaternion.map(Into::into);
                Trajectory::read(path, &self.table.reading(None), order, &body, (self.start_time, self.until))
            })
            .collect::<Result<_, _>>()?;
        // a place that cannot be written is found out before the work
        let figure_file = self.figure.as_deref().map(|path| {
            let picture = Picture::of("--figure", path, &[Picture::Svg, Picture::Png])?;
            Ok::<_, Error>((Output::to_file("--figure", path)?, picture))
        });
        let figure_file = figure_file.transpose()?;
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
                "--until: '{until}': two runs in double-double agree up to t = {known} only; attitude errors and flips are of that time"
            ));
        }
        let mut table = Table::new("comparison", "Methods on one body.", columns(&body));
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
            table.push(self.row(&truth, entry, &judged, spent));
            if let Some(error) = judged.attitude_error() {
                match figure.series.iter_mut().find(|series| series.name == entry.family) {
                    Some(series) => series.points.push((spent.1, error)),
                    None => figure.series.push(Curve::new(entry.family.clone(), vec![(spent.1, error)])),
                }
            }
        }
        for trajectory in &trajectories {
            table.push(self.foreign(&truth, trajectory)?);
        }
        for series in &mut figure.series {
            series.points.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        if let Some((file, picture)) = figure_file {
            if figure.series.is_empty() {
                return Err(Error::Failed(
                    "--figure: every attitude is lost, and nothing is left to draw; take smaller steps or an earlier end".into(),
                ));
            }
            crate::plot::write(file, picture, &figure.page())?;
        }
        emit(&Format::of(self.format, self.out.as_deref())?.write(&table), self.out.as_deref())
    }

    fn span(&self) -> Result<f64, Error> {
        let span = self.until - self.start_time;
        if span > 0.0 && span.is_finite() {
            return Ok(span);
        }
        let rule = format!("must come after the start, t = {}", short(self.start_time));
        Err(Error::input("--until", &short(self.until), &rule, "give a later time"))
    }

    /// Every method at every step or tolerance that it takes.
    fn entries(&self, span: f64) -> Result<Vec<Entry>, Error> {
        let mut entries = Vec::new();
        for name in &self.methods {
            let name = name.trim();
            if name == "exact" {
                let rule = "is what the others are compared with";
                return Err(Error::input("--methods", name, rule, "leave it out; exact-step takes steps"));
            }
            let method = named("--methods", name)?;
            if method.tolerance().is_none() {
                let Some(Positives(steps)) = &self.steps else {
                    let rule = format!("missing: {name} needs steps in seconds");
                    return Err(Error::input("--steps", "", &rule, "give --steps h1,h2,..."));
                };
                for &step in steps {
                    self.check_step(step, span)?;
                    let (method, family) = (named("--methods", name)?, method.name());
                    entries.push(Entry { method, family, step: Some(step), tolerance: None });
                }
                continue;
            }
            let given = method.tolerance().filter(|_| name.contains(':'));
            match (&self.tolerances, given) {
                (Some(Positives(tolerances)), None) => {
                    for &tolerance in tolerances {
                        let method = method.with_tolerance(tolerance).map_err(|error| match error {
                            ToleranceError::OutOfRange { method, range, .. } => {
                                not_taken("--tolerances", tolerance, name, &allowed(method, range))
                            }
                            error => Error::Input(format!("--tolerances: {error}")),
                        })?;
                        let (family, tolerance) = (name.to_owned(), Some(tolerance));
                        entries.push(Entry { method, family, step: None, tolerance });
                    }
                }
                (_, tolerance) => {
                    let family = name.split(':').next().unwrap_or(name).to_owned();
                    entries.push(Entry { method, family, step: None, tolerance });
                }
            }
        }
        if let (Some(Positives(tolerances)), true) =
            (&self.tolerances, entries.iter().all(|entry| entry.step.is_some()))
        {
            let rule = "none of the methods chooses its steps";
            let remedy = format!("leave it out, or take one of {}", adaptive());
            let value: Vec<String> = tolerances.iter().map(|tolerance| format!("{tolerance:e}")).collect();
            return Err(Error::input("--tolerances", &value.join(","), rule, &remedy));
        }
        Ok(entries)
    }

    fn check_step(&self, step: f64, span: f64) -> Result<(), Error> {
        let clock = Clock { start: self.start_time, step };
        let Err(error) = Schedule::at_times(clock, &[self.until]) else { return Ok(()) };
        let (value, until) = (short(step), short(self.until));
        let divided = short(span / (span / step).round().max(1.0));
        Err(match error {
            ScheduleError::NotReached { nearest, .. } => Error::input(
                "--steps",
                &value,
                &format!(
                    "no whole number of these steps leads to --until {until}; the nearest time is {}",
                    short(nearest)
                ),
                &format!("take {divided}, or --until {}", short(nearest)),
            ),
            error => Error::Input(format!("--steps: '{value}': {error}")),
        })
    }

    /// Refuses a method that would take forever, and says on a terminal of one that takes long.
    fn check_cost(
        &self,
        entry: &Entry,
        body: &Body,
        start: &Point<Dd>,
        speed: f64,
        span: f64,
    ) -> Result<(), Error> {
        let step = match entry.step {
            Some(step) => {
                cost::check("--steps", step, span / step, "take larger steps or an earlier end")?;
                step
            }
            None => {
                cost::check_turn("--until", self.until, speed * span)?;
                span.min(1.0 / speed)
            }
        };
        let clock = Clock { start: self.start_time, step };
        cost::announce(entry.method.as_ref(), body, start.to_f64(), clock, libm::ceil(span / step) as u64);
        Ok(())
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

    fn row(
        &self,
        truth: &Truth,
        entry: &Entry,
        judged: &Judged,
        (seconds, rk4_steps): (f64, f64),
    ) -> Vec<Cell> {
        let Judged { last, ending, evaluations, .. } = judged;
        let known = truth.known_until();
        let whole = last.elapsed.hi() <= known * (1.0 + 1e-12);
        let flips = last.flips.filter(|_| whole && matches!(ending, Ending::Held | Ending::Lost(_)));
        let exact = flips.and_then(|_| truth.flips(known));
        let right = match (flips, exact) {
            (Some(flips), Some(exact)) => Some(if flips == exact { "right" } else { "wrong" }),
            _ => None,
        };
        let worst = last.worst;
        let attitude = judged.attitude_error();
        row![
            entry.method.name(),
            entry.step,
            entry.tolerance,
            attitude,
            judged.largest_attitude_error(known),
            attitude.map(|_| self.start_time + known),
            worst.energy,
            truth.exchanged_energy_error(&worst),
            worst.momentum_norm,
            worst.momentum_vector,
            worst.momentum_z,
            worst.jacobi,
            *evaluations,
            seconds,
            rk4_steps,
            last.flips,
            exact,
            right,
            ending.by_clock(self.start_time).to_string(),
        ]
        .to_vec()
    }

    fn foreign(&self, truth: &Truth, trajectory: &Trajectory) -> Result<Vec<Cell>, Error> {
        let found = trajectory.against(truth, self.start_time)?;
        let columns = columns(truth.body());
        let mut row = vec![Cell::Empty; columns.len()];
        let mut set = |name: &str, value: Cell| {
            if let Some(place) = columns.iter().position(|column| column.name == name) {
                row[place] = value;
            }
        };
        set("method", trajectory.name.clone().into());
        set("status", found.ending.by_clock(self.start_time).to_string().into());
        if let Some((worst, flips, exact)) = found.invariants {
            set("energy_error", worst.energy.into());
            set("exchanged_energy_error", truth.exchanged_energy_error(&worst).into());
            set("momentum_error", worst.momentum_norm.into());
            set("momentum_vector_error", worst.momentum_vector.into());
            set("momentum_z_error", worst.momentum_z.into());
            set("flips", flips.into());
            set("flips_exact", exact.into());
            set("flips_right", exact.map(|exact| if flips == exact { "right" } else { "wrong" }).into());
        }
        if found.ending == Ending::Held {
            set("attitude_error", found.attitude_error.into());
            set("attitude_time", found.at.map(|at| self.start_time + at).into());
        }
        Ok(row)
    }
}

fn columns(body: &Body) -> Vec<Column> {
    let conserved = body.conserved();
    let free = conserved.contains(&polhode::body::Conserved::Momentum);
    let shown = |column: Column, shown: bool| if shown { column } else { column.hidden() };
    let energy = conserved.contains(&polhode::body::Conserved::Energy);
    let jacobi = !energy && !conserved.is_empty();
    vec![
        Column::new("method", "", "name in the catalogue, or the file of the trajectory"),
        Column::new("step", "s", "step").heading("h"),
        Column::new("tolerance", "", "tolerance of a method that chooses its steps").hidden(),
        Column::new("attitude_error", "rad", "angle to the true attitude at the end")
            .heading("attitude")
            .digits(2),
        Column::new("largest_attitude_error", "rad", "the largest at 64 times up to then").hidden(),
        Column::new("attitude_time", "s", "time of the attitude error").hidden(),
        shown(
            Column::new("energy_error", "", "largest relative error of the energy")
                .heading("energy")
                .digits(2),
            energy,
        ),
        Column::new("exchanged_energy_error", "", "max |E - E0| over (max U - min U), under gravity")
            .hidden(),
        Column::new("momentum_error", "", "largest relative error of |m|").hidden(),
        shown(
            Column::new("momentum_vector_error", "", "largest relative error of L in space")
                .heading("L")
                .digits(2),
            free,
        ),
        shown(
            Column::new("momentum_z_error", "", "largest relative error of L along space z, under torque")
                .heading("L_z")
                .digits(2),
            energy && !free,
        ),
        shown(
            Column::new("jacobi_error", "", "largest relative error of E - n L_z")
                .heading("Jacobi")
                .digits(2),
            jacobi,
        ),
        Column::new("evaluations", "", "right sides, turns, flows, solutions and kicks together")
            .heading("evals"),
        Column::new("seconds", "s", "processor time, unwatched").hidden(),
        Column::new("rk4_steps", "", "the same in steps of rk4").heading("rk4 steps").digits(2),
        Column::new("flips", "", "changes of sign of the momentum along the middle axis").hidden(),
        Column::new("flips_exact", "", "the same of the true motion").hidden(),
        Column::new("flips_right", "", "whether they agree").heading("flips"),
        Column::new("status", "", "ok, or what became of the run"),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_steps_are_positive_numbers() {
        assert_eq!(positives("0.1, 2e-3").map(|p| p.0), Ok(vec![0.1, 2e-3]));
        assert!(positives("0.1,0").unwrap_err().starts_with("item 2: 0.0 is not positive"));
        assert!(positives("").is_err() && positives("1,x").is_err());
    }
}
