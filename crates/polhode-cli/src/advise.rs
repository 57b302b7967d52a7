//! `polhode advise`: which method, with which step.

use std::io::IsTerminal as _;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use polhode::advise::{
    Advice, AdviseError, Choice, Demand, Progress, Setting, advise_telling, check_telling,
};
use polhode::method::method;
use polhode_files::error::{Error, tell, warn};
use polhode_files::instant::{duration, positive_duration};
use polhode_files::numbers::positive;
use polhode_files::text::short;
use polhode_pages::output::emit;
use polhode_pages::table::{Cell, Column, Format, Table, row};
use serde_json::json;

use crate::flags::motion::MotionArguments;

const USAGE: &str = "polhode advise <BODY> [START] --until <T> --attitude-error <E> [OPTIONS]
  BODY:  --moments <I1,I2,I3> | --inertia <Ixx,...,Iyz> | --body <NAME>
  START: --omega <wx,wy,wz> | --momentum-body <mx,my,mz> | ...
         and --attitude <w,x,y,z> | --angles <phi,theta,psi> | ...";

const EXAMPLES: &str = "Examples:
  polhode advise --moments 1,2,3 --omega 0.4,1,-0.3 --until 1e4 \\
    --attitude-error 1e-6 --exclude exact --check
  polhode advise --body simo-wong --omega 0,0,50 --attitude 0.99,0.15,0,0 \\
    --until 10 --attitude-error 1e-5 --format json";

/// Which method and step for this body, time and accuracy, and what it costs
///
/// Every method runs on the body itself for a short time, in shorter and shorter steps, and is compared with the exact motion, or with
/// two runs of different methods that agree. The quickest candidates then run to the end. The first row is the advice; `propagate`
/// takes its method, step and tolerance as they are. Times are those of this machine. The search usually ends within two seconds
/// plus ten times the run that it advises.
///
/// Columns, with their headings in the table: predicted_error (attitude) and predicted_energy_error (energy), the largest errors up to T;
/// factor, by which predicted_error may be wrong; predicted_cost (time), processor time, s; times_longer (longer), that time over the
/// least; whole_time (csv and json alone), whether the runs behind the prediction went as far as T; actual_error (actual), with --check.
#[derive(Args, Clone, Debug)]
#[command(override_usage = USAGE, after_help = EXAMPLES)]
pub(crate) struct Advise {
    #[command(flatten)]
    pub(crate) motion: MotionArguments,
    /// Duration of the motion, s, or with a unit, as 30d
    #[arg(long, value_name = "T", value_parser = positive_duration, allow_hyphen_values = true, help_heading = "Demand")]
    until: f64,
    /// Largest attitude error allowed up to then, rad
    #[arg(long, value_name = "E", value_parser = positive, allow_hyphen_values = true, help_heading = "Demand")]
    attitude_error: f64,
    /// Largest relative energy error allowed
    #[arg(long, value_name = "E", value_parser = positive, allow_hyphen_values = true, help_heading = "Demand")]
    energy_error: Option<f64>,
    /// Largest processor time allowed, s
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_hyphen_values = true, help_heading = "Demand")]
    budget: Option<f64>,
    /// Method to leave out; repeatable. `exact` leaves out the closed form and all methods that use it in each step
    #[arg(long, value_name = "METHOD", help_heading = "Demand")]
    exclude: Vec<String>,
    /// Time of the start, s, or with a unit, for forces that depend on time
    #[arg(long, value_name = "t0", value_parser = duration, allow_hyphen_values = true, default_value = "0", help_heading = "Demand")]
    start_time: f64,
    /// Run the advice to T and compare its attitude with the exact motion, or with two runs of different methods that agree; exit code
    /// 1 if the attitude error is larger than asked for. The energy error is not checked
    #[arg(long, help_heading = "Output")]
    check: bool,
    /// Show every method that meets the demand, not only the quickest ten
    #[arg(long, help_heading = "Output")]
    all: bool,
    /// How rows are printed: table on a terminal, csv otherwise
    #[arg(long, value_enum, help_heading = "Output")]
    format: Option<Format>,
    /// Write to this file instead of standard output
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    out: Option<PathBuf>,
}

/// Bases that are no methods without an order.
const BASES: [&str; 2] = ["dmv", "gauss"];

/// Rows that are shown unless all are asked for.
const SHOWN: usize = 10;

impl Advise {
    pub(crate) fn run(&self) -> Result<(), Error> {
        self.motion.start.check_angles(false, false)?;
        for name in self.exclude.iter().filter(|name| *name != "exact") {
            if let Err(error) = method(name)
                && !BASES.contains(&name.as_str())
            {
                return Err(Error::Input(format!("--exclude: {error}")));
            }
        }
        let body = self.motion.body(self.start_time)?;
        let start = body.leave(&self.motion.start(&body, self.start_time)?);
        let mut demand = Demand::new(self.until, self.attitude_error);
        demand.energy_error = self.energy_error;
        demand.budget = self.budget;
        demand.excluded.clone_from(&self.exclude);
        demand.start_time = self.start_time;
        let mut patience = Patience::new();
        let advice = advise_telling(&body, &start, &demand, &mut |progress| patience.heed(progress));
        patience.end();
        let advice = advice.map_err(told)?;
        let actual = if self.check {
            let cost = CHECK * advice.best.seconds.value;
            if cost > QUIET.as_secs_f64() {
                let cost = short(format!("{cost:.1e}").parse().unwrap_or(cost));
                tell("note", &format!("--check follows the motion to the end again: up to about {cost} s"));
            }
            let heed = &mut |progress: &Progress| patience.heed(progress);
            let checked = check_telling(&body, &start, &demand, &advice.best, heed);
            patience.end();
            Some(checked.map_err(|error| Error::Failed(format!("--check: {error}")))?)
        } else {
            None
        };
        let format = Format::of(self.format, self.out.as_deref())?;
        let text = match format {
            Format::Json => json(&advice, actual),
            _ => format.write(&self.table(&advice, actual)),
        };
        emit(&text, self.out.as_deref())?;
        if let Some(time) = advice.jump {
            warn(&format!(
                "the torque jumps, first at t = {} s: steps and tolerances hold only for this start and time",
                short(self.start_time + time)
            ));
        }
        match (advice.best.whole_time, actual, self.energy_error) {
            (false, None, _) => {
                warn("the error at the end is extrapolated from a shorter run; --check runs to the end");
            }
            (false, Some(_), Some(_)) => {
                warn(
                    "the energy error is extrapolated from a shorter run; --check measures only the attitude error",
                );
            }
            _ => {}
        }
        match actual.filter(|error| *error > self.attitude_error) {
            Some(error) => Err(Error::Failed(format!(
                "--check: the attitude error of {} is {error:.1e} rad, and {:.1e} rad were asked for",
                advice.best.method, self.attitude_error
            ))),
            None => Ok(()),
        }
    }

    fn table(&self, advice: &Advice, actual: Option<f64>) -> Table {
        let column = Column::new;
        let mut columns = vec![
            column("method", "", "name on the command line"),
            column("step", "s", "step; of a method with a tolerance the interval of its output").digits(9),
            column("tolerance", "", "relative to the state").digits(2),
            column("predicted_error", "rad", "largest attitude error up to T").heading("attitude").digits(2),
            column("factor", "", "by which the predicted error may be wrong").digits(2),
            column("predicted_energy_error", "", "largest relative energy error up to T")
                .heading("energy")
                .digits(2),
            column("predicted_cost", "s", "processor time on this machine").heading("time").digits(2),
            column("times_longer", "", "that time over the quickest").heading("longer").digits(2),
            column("whole_time", "", "whether the runs of the prediction went as far as T").hidden(),
        ];
        if self.check {
            columns.push(
                column("actual_error", "rad", "attitude error of the advice when run to T")
                    .heading("actual")
                    .digits(2),
            );
        }
        let caption = format!(
            "Methods that meet an attitude error of {:e} rad up to {} s, the quickest first.",
            self.attitude_error, self.until
        );
        let mut table = Table::new("advice", caption, columns);
        let best = &advice.best;
        let shown = if self.all { usize::MAX } else { SHOWN };
        for (place, choice) in std::iter::once(best).chain(&advice.others).take(shown).enumerate() {
            let mut row = row(choice, choice.seconds.value / best.seconds.value);
            if self.check {
                row.push(Cell::from(actual.filter(|_| place == 0)));
            }
            table.push(row);
        }
        table
    }
}

fn step_and_tolerance(choice: &Choice) -> (Option<f64>, Option<f64>) {
    match choice.setting {
        Setting::Step(step) => (Some(step), None),
        Setting::Tolerance { tolerance, step } => (Some(step), Some(tolerance)),
        _ => (None, None),
    }
}

fn row(choice: &Choice, longer: f64) -> Vec<Cell> {
    let (step, tolerance) = step_and_tolerance(choice);
    row![
        choice.method.as_str(),
        step,
        tolerance,
        choice.attitude_error.value,
        choice.attitude_error.factor,
        choice.energy_error,
        choice.seconds.value,
        longer,
        if choice.whole_time { "yes" } else { "no" },
    ]
    .to_vec()
}

fn json(advice: &Advice, actual: Option<f64>) -> String {
    let one = |choice: &Choice| {
        let (step, tolerance) = step_and_tolerance(choice);
        json!({
            "method": choice.method,
            "step": step,
            "tolerance": tolerance,
            "predicted_error": choice.attitude_error.value,
            "predicted_error_factor": choice.attitude_error.factor,
            "predicted_energy_error": choice.energy_error,
            "predicted_cost": choice.seconds.value,
            "predicted_cost_factor": choice.seconds.factor,
            "whole_time": choice.whole_time,
        })
    };
    let mut object = one(&advice.best);
    object["runner_up"] = json!(advice.others.first().map(|choice| &choice.method));
    object["actual_error"] = json!(actual);
    object["conditioning"] = json!(advice.conditioning);
    object["others"] = json!(advice.others.iter().map(one).collect::<Vec<_>>());
    let unfit = advice.unfit.iter().map(|(name, error)| json!({"method": name, "smallest_error": error}));
    object["unfit"] = json!(unfit.collect::<Vec<_>>());
    format!("{object:#}\n")
}

/// What a check costs at most, in runs of the advice.
const CHECK: f64 = 10.0;

/// After this time a line says what is being done, where no bar does.
const QUIET: Duration = Duration::from_millis(1500);

/// Progress on a terminal for work over a second; elsewhere one line for work that takes longer.
struct Patience {
    begun: Instant,
    bar: Option<ProgressBar>,
    told: bool,
    seen: Instant,
}

impl Patience {
    fn new() -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(100);
            bar.set_style(
                ProgressStyle::with_template("{msg} {bar:30} {pos} % {elapsed}")
                    .unwrap_or_else(|_| ProgressStyle::default_bar()),
            );
            bar
        });
        Self { begun: Instant::now(), bar, told: false, seen: Instant::now() }
    }

    fn heed(&mut self, progress: &Progress) {
        if self.begun.elapsed() < QUIET {
            return;
        }
        match &self.bar {
            Some(bar) if self.seen.elapsed() > Duration::from_millis(100) => {
                self.seen = Instant::now();
                bar.set_message(progress.stage.to_string());
                bar.set_position((100.0 * progress.done) as u64);
            }
            None if !self.told => {
                self.told = true;
                tell(
                    "note",
                    &format!("{}; this may take up to ten times the run that is found", progress.stage),
                );
            }
            _ => {}
        }
    }

    fn end(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// The flag that an error is about, and its message.
fn told(error: AdviseError) -> Error {
    let flag = match &error {
        AdviseError::NotPositive { .. }
        | AdviseError::Chaotic { .. }
        | AdviseError::Jumps { .. }
        | AdviseError::LongAcrossJump { .. }
        | AdviseError::Undecided { .. }
        | AdviseError::TooLong { .. } => "--until",
        AdviseError::Lost { .. } | AdviseError::Conditioning { .. } | AdviseError::Unreached { .. } => {
            "--attitude-error"
        }
        AdviseError::AtRest | AdviseError::State(_) => "--omega",
        AdviseError::Budget { .. } => "--budget",
        AdviseError::NotConserved
        | AdviseError::EnergyBelowRounding { .. }
        | AdviseError::EnergyUnreached { .. } => "--energy-error",
        AdviseError::NoCandidate => "--exclude",
        _ => "advise",
    };
    Error::Input(format!("{flag}: {error}"))
}
