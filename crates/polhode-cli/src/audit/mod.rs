//! `polhode audit`: a verdict on the trajectory of another program.

mod against;
mod arguments;
mod golden;

use std::path::{Path, PathBuf};

use clap::Args;
use polhode::audit::{Attitudes, Judgement, Noise, Question, Reading, Trajectory, audit, step_length};
use polhode::body::Body;
use polhode_files::error::{Error, warn};
use polhode_files::numbers::{list, positive};
use polhode_files::text::{short, visible};
use polhode_files::trajectory::FoundTrajectory;
use polhode_files::{NamedBy, trajectory};
use polhode_pages::document::Form;
use polhode_pages::output::Output;
use polhode_pages::table::Format;
use polhode_pages::verdict::{self, Adviser, Outcome};

use crate::flags::body::BodyArguments;
use crate::flags::force::ForceArguments;
use crate::flags::wheel::WheelArguments;
use crate::memory;
use against::Golden;
use arguments::ReadingArguments;

const USAGE: &str = "polhode audit <RUN.csv> [BODY] [FORCE] [OPTIONS]
       polhode audit --golden <DIR>
  BODY:  --moments <I1,I2,I3> | --inertia <Ixx,...,Iyz> | --body <NAME>
  FORCE: --weight-moment <cx,cy,cz> | --gravity-gradient <n[,e]> | ...";

const EXAMPLES: &str = "Examples:
  polhode propagate --moments 1,2,3 --omega 0.4,1,-0.3 --until 20 \\
    --every 0.1 --fields t,q,omega --out run.csv
  polhode audit run.csv --moments 1,2,3
  polhode audit run.csv --report audit.html --figure audit.svg
  polhode audit --golden golden
  polhode audit golden/free-generic.csv --against golden/free-generic.csv";

/// Whether a trajectory of another program is right, its convention and its error
///
/// Reads CSV and other tables with a time and an attitude (quaternion, matrix,
/// Euler angles, MRP), an angular velocity or an angular momentum, in columns of
/// any common names; qpos and qvel of MuJoCo; LAMMPS dumps. A column id says which
/// body a row belongs to. Every convention that the columns allow is tried, and the
/// one in which the rows obey the equations of motion is kept. Without a body its
/// moments are fitted up to a factor. The speed of a wheel is that at the first
/// row.
///
/// right: every row and every column that is read agrees with one motion of the
/// body, within --tolerance, within the precision of its digits, those of the times
/// included, or within the noise that --noise declares. A record that agrees only
/// within a noise that is not declared is undecided, and so are attitudes alone
/// that turn by less than ten times what they may be off. A record that contradicts
/// what a name or an option states (a direction, a frame, a unit, the axes of roll,
/// pitch and yaw, the order of the moments) is wrong. With --against the verdict is
/// undecided unless all times of one file are in the other.
///
/// suspect: what explains the errors.
///
///   kinematics-sign          the attitude turns the wrong way
///   omega-frame              angular velocity in body axes, used or stated as one
///                            in space axes, or the other way round
///   transposed               a rotation, used or stated in place of its inverse
///   moments-order            the moments belong to other axes
///   degrees                  another unit of the angular velocity
///   angles-order             Euler angles about other axes than their columns say
///   gyroscopic-term-missing  Euler's equations without w x I w
///   gyroscopic-sign          a term of w x I w with the wrong sign
///   integrator:NAME          errors like those of this method
///   discontinuity            the state jumps
///   other-body               the motion of a body with other moments
///   other-torque             L changes as under another torque
///   other-wheel              a wheel of another speed, or free instead of held
///   none                     nothing that is known
///
/// If it is the integrator, the report also names a method and a step that are
/// accurate enough, unless the search for them takes more than two seconds.
///
/// Exit code 0: right; 1: wrong or undecided.
#[derive(Args, Clone, Debug)]
#[command(verbatim_doc_comment, override_usage = USAGE, after_help = EXAMPLES)]
#[command(mut_group("BodyArguments", |group| group.required(false)))]
pub(crate) struct Audit {
    /// Rows of the trajectory; - reads standard input
    #[arg(value_name = "RUN.csv", required_unless_present = "golden")]
    record: Option<PathBuf>,
    #[command(flatten)]
    body: Option<BodyArguments>,
    #[command(flatten)]
    wheels: WheelArguments,
    #[command(flatten)]
    forces: ForceArguments,
    #[command(flatten)]
    reading: ReadingArguments,
    /// Audit only this body of the column id
    #[arg(long, value_name = "NAME", help_heading = "Reading")]
    id: Option<String>,
    /// Largest error that a right record may have, rad and relative, at most 0.1
    #[arg(long, value_name = "E", value_parser = tolerance, allow_hyphen_values = true, default_value = "1e-6", help_heading = "Verdict")]
    tolerance: f64,
    /// Noise of the record, without which a noisy record is undecided: standard deviations of a component of the attitude, rad, and of the angular velocity, rad/s; 0 where the record has no such columns
    #[arg(long, value_name = "ANGLE[,RATE]", value_parser = noise, allow_hyphen_values = true, help_heading = "Verdict")]
    noise: Option<Noise>,
    /// Compare also with this reference trajectory, such as one of --golden; its header names the body
    #[arg(long, value_name = "GOLDEN.csv", conflicts_with_all = ["BodyArguments", "weight_moment"], help_heading = "Verdict")]
    against: Option<PathBuf>,
    /// Write reference trajectories into this folder, with programs that compare others with them
    #[arg(long, value_name = "DIR", conflicts_with_all = ["record", "against", "BodyArguments", "id", "tolerance", "noise", "figure", "report", "format", "out",
        "columns", "time_unit", "sample_rate", "quaternion", "attitude", "euler", "angle_unit", "omega_frame", "momentum_frame", "rate_unit", "any_order",
        "wheels", "weight_moment", "gravity_gradient", "orbit", "orbit_plane", "orbit_table", "torque_body", "torque_space", "drag"], help_heading = "Output")]
    golden: Option<PathBuf>,
    /// Draw the errors of energy, |m|, direction of L and attitude against time to this file
    #[arg(long, value_name = "FILE.svg", help_heading = "Output")]
    figure: Option<PathBuf>,
    /// Write one page with the verdict, its numbers and the figure to this file
    #[arg(long, value_name = "FILE.html|.md", help_heading = "Output")]
    report: Option<PathBuf>,
    /// How the verdict is written: words on a terminal, csv otherwise
    #[arg(long, value_enum, help_heading = "Output")]
    format: Option<Format>,
    /// Write to this file instead of standard output
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    out: Option<PathBuf>,
}

impl Audit {
    pub(crate) fn run(&self) -> Result<(), Error> {
        if let Some(folder) = &self.golden {
            return golden::write(folder);
        }
        let path = self.record.as_deref().unwrap_or_else(|| Path::new("-"));
        let name = if path.as_os_str() == "-" {
            "standard input".into()
        } else {
            visible(&path.display().to_string()).into_owned()
        };
        let format = Format::of(self.format, self.out.as_deref())?;
        let form = self.report.as_deref().map(|path| Form::of("--report", path)).transpose()?;
        let outcomes = self.outcomes(path, &name)?;
        let text = match format {
            Format::Table => verdict::text(&name, &outcomes),
            Format::Json => verdict::json(&outcomes),
            Format::Csv => verdict::rows(&outcomes).csv(),
        };
        // all places are found to be usable before the first is written
        let figure = self.figure.as_deref().map(|path| Output::to_file("--figure", path)).transpose()?;
        let report = self.report.as_deref().map(|path| Output::to_file("--report", path)).transpose()?;
        let output = Output::new(self.out.as_deref())?;
        if let Some(file) = figure {
            file.write_whole(&verdict::panels(&name, &outcomes).svg)?;
        }
        if let Some((file, form)) = report.zip(form) {
            file.write_whole(&verdict::page(&name, &outcomes, form))?;
        }
        output.write_whole(&text)?;
        if format == Format::Csv {
            // words and JSON hold them too
            outcomes.iter().flat_map(Outcome::warnings).for_each(|warning| warn(&warning));
        }
        let mut bad = outcomes.iter().filter(|outcome| !outcome.is_right());
        let Some(first) = bad.next() else { return Ok(()) };
        let of = first.body.as_ref().map_or(String::new(), |body| format!(", body {body}"));
        let suspect =
            if first.is_suspected() { format!(", suspect {}", first.suspect()) } else { String::new() };
        let others = match bad.count() {
            0 => String::new(),
            more => format!("; {more} more of {} bodies are not right", outcomes.len()),
        };
        Err(Error::Failed(format!("{name}{of}: {}{suspect}{others}", first.judgement())))
    }

    /// The verdict on every body of the file.
    fn outcomes(&self, path: &Path, name: &str) -> Result<Vec<Outcome>, Error> {
        let mut golden = self.against.as_deref().map(Golden::read).transpose()?;
        let mut wheels = Vec::new();
        let body = match (&golden, &self.body) {
            (Some(golden), _) => Some(self.forces.act_on(golden.body.clone(), None)?),
            (None, Some(body)) => {
                body.check_size(self.forces.is_sized() || self.wheels.is_any())?;
                let own = body.own_orbit().map(|(orbit, _)| orbit);
                let (body, of_file) = body.heavy(self.forces.weight_moment)?;
                wheels = self.wheels.all(of_file);
                Some(self.forces.act_on(body, own)?)
            }
            (None, None) => None,
        };
        if self.wheels.is_any() && self.body.is_none() {
            let remedy = "give --moments, --inertia or --body too";
            return Err(Error::input("--wheel", "", "a wheel needs a body", remedy));
        }
        if body.is_none() && self.forces.is_any() {
            let remedy = "give --moments, --inertia or --body too";
            return Err(Error::input("--moments", "", "missing: a force needs a body", remedy));
        }
        self.reading.check_order(body.is_some(), !wheels.is_empty())?;
        memory::check_files(&[path.to_path_buf()], 2)?;
        let mut found = trajectory::read(path, &self.reading.table())?;
        if let Some(golden) = &mut golden {
            golden.align(&found.read_as)?;
        }
        self.choose(&mut found)?;
        self.reading.check_used(&found)?;
        self.reading.order(&mut found, name)?;
        if !found.second_attitude.is_empty() && !self.reading.names_quantities() {
            let rule = format!(
                "the columns {} hold another attitude, which is not read",
                found.second_attitude.join(", ")
            );
            return Err(Error::input(name, "", &rule, "name those of one body by --columns"));
        }
        let of_golden = golden.as_ref().and_then(|golden| golden.remark.clone());
        let mut remarks: Vec<String> = found.remark().into_iter().chain(of_golden).collect();
        let unit_is_open = !found.counts_steps && found.read_as.times.1 == NamedBy::Nothing;
        let claims = self.reading.claims(found.claims);
        let adviser = Adviser::new();
        let mut outcomes = Vec::new();
        for (id, mut record) in found.bodies {
            let place = id.as_ref().map_or(name.to_string(), |id| format!("{name}, body {id}"));
            let mut notes = Vec::new();
            if found.counts_steps {
                notes.push(timed(&mut record, body.as_ref(), &place)?);
            }
            notes.append(&mut remarks);
            let mut question = Question::new(body.clone());
            (question.tolerance, question.claims) = (self.tolerance, claims);
            question.noise = self.noise.unwrap_or_default();
            question.wheels.clone_from(&wheels);
            let verdict =
                audit(&record, &question).map_err(|error| Error::Input(format!("{place}: {error}")))?;
            if verdict.judgement != Judgement::Right {
                notes.extend(clock(&record, &verdict.reading, unit_is_open));
            }
            let allowed = (self.tolerance, question.noise.attitude > 0.0);
            let against = golden.as_ref().map(|golden| golden.difference(&place, &record, &verdict, allowed));
            let against = against.transpose()?;
            let compared = golden.as_ref().zip(against.as_ref());
            notes.extend(compared.and_then(|(golden, difference)| golden.note(&record, difference)));
            outcomes.push(Outcome {
                body: id,
                rows: record.times.len(),
                form: record.attitude.as_ref().map(Attitudes::name),
                advice: adviser.advice(&record, &verdict, self.tolerance),
                verdict,
                against,
                notes,
            });
        }
        Ok(outcomes)
    }

    /// Leaves the bodies of `found` that are asked for; one that is alone needs no name.
    fn choose(&self, found: &mut FoundTrajectory) -> Result<(), Error> {
        let Some(wanted) = &self.id else {
            if let [(id, _)] = &mut found.bodies[..] {
                *id = None;
            }
            return Ok(());
        };
        let known: Vec<String> = found.bodies.iter().filter_map(|(id, _)| id.clone()).collect();
        found.bodies.retain(|(id, _)| id.as_ref() == Some(wanted));
        if !found.bodies.is_empty() {
            return Ok(());
        }
        if known.is_empty() {
            let rule = "no column names the bodies of the record";
            let remedy = "leave it out, or name the column by --columns id=NAME";
            return Err(Error::input("--id", wanted, rule, remedy));
        }
        Err(Error::unknown_name("--id", "body", wanted, known.iter().map(String::as_str)))
    }
}

fn tolerance(text: &str) -> Result<f64, String> {
    match positive(text)? {
        value if value <= 0.1 => Ok(value),
        value => Err(format!(
            "{value:?} is more than 0.1, with which nearly any record would pass; give a smaller number"
        )),
    }
}

/// Standard deviations of the attitude, rad, and of the angular velocity, rad/s, which is 0 where it is left out.
fn noise(text: &str) -> Result<Noise, String> {
    let (attitude, rates) = match list(text)?[..] {
        [attitude] => (attitude, 0.0),
        [attitude, rates] => (attitude, rates),
        ref given => {
            return Err(format!("{} given, 1 or 2 needed: ANGLE in rad, RATE in rad/s", given.len()));
        }
    };
    if !(0.0..=0.1).contains(&attitude) {
        return Err(format!("ANGLE is {attitude:?} rad; give a number from 0 to 0.1"));
    }
    if rates < 0.0 {
        return Err(format!("RATE is {rates:?} rad/s; give 0 or more"));
    }
    Ok(Noise { attitude, rates })
}

/// In which unit of time the attitudes turn as the angular velocities say, where that is not s and the unit is open; or that they
/// turn twice or half as fast.
fn clock(record: &Trajectory, reading: &Reading, unit_is_open: bool) -> Option<String> {
    record.rates.as_ref()?;
    let length = step_length(record, None)?;
    let rate = reading.rate_unit.unwrap_or_default().radians_per_second(1.0);
    // where the equations of motion are broken too, the unit of the rates may have been read wrongly
    let is_off_by = |times: f64| [rate, 1.0].iter().any(|rate| (length / (rate * times) - 1.0).abs() < 0.02);
    if let Some((_, words)) = [(2.0, "twice"), (0.5, "half")].into_iter().find(|(times, _)| is_off_by(*times))
    {
        return Some(format!(
            "the attitudes turn {words} as fast as the angular velocities say; is the 1/2 of q' = 1/2 q omega there once?"
        ));
    }
    let known = [(1e-3, "ms"), (1e-6, "us"), (1e-9, "ns")];
    let is_near = |seconds: f64| unit_is_open && (length / rate / seconds - 1.0).abs() < 0.1;
    let (_, name) = known.into_iter().find(|(seconds, _)| is_near(*seconds))?;
    Some(format!(
        "the times have no unit; attitudes and angular velocities agree if they are in {name}: --time-unit {name}"
    ))
}

/// Turns counts of steps into times, and says how.
fn timed(record: &mut Trajectory, body: Option<&Body>, place: &str) -> Result<String, Error> {
    let Some(step) = step_length(record, body) else {
        let rule = "counts steps of unknown length";
        let remedy = "give the length of a step, s, as --time-unit, or dump with dump_modify time yes";
        return Err(Error::input(place, "", rule, remedy));
    };
    record.times.iter_mut().for_each(|t| *t *= step);
    Ok(format!(
        "the record counts steps; from the turning of the body they are taken to be {} s long; give their length by --time-unit",
        short(step)
    ))
}
