//! The audit on trajectories whose convention, mistakes and faults are known.
//!
//! Definitions of the families, fixed before the first count:
//! - The deviation of a row is the angle between its attitude and that of the exact motion that the record was made from, rad, and
//!   the distance of its angular velocity (of momenta: of the angular velocity that they belong to) from that of the motion,
//!   relative to the root mean square of the record. It counts before noise is added and digits are cut, in the columns that
//!   are written, at the time that the row states. Where another start of the same body comes nearer, it counts from there.
//! - Allowed is the largest of the tolerance, 1e-6; of the rounding, the largest distance by which its digits take a row of the
//!   record from what is written; and of ten standard deviations of a component of the noise that is declared.
//! - False right: called right although the deviation of some row exceeds what is allowed. It must not happen.
//! - True right: an exact motion, written in 6 to 17 digits or in single precision, without noise or with declared noise, that
//!   is called right. 99 % must be. The others are undecided or wrong.
//!
//! The faults are put in by code that knows nothing of the judge.

mod alike;
mod families;
mod faulty;
mod mistakes;
mod motion;
mod nearest;
mod specimen;
mod truth;
mod writing;

use polhode::audit::{Judgement, Question, Reading, audit};
use polhode::body::Body;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Column, Table, row};

use crate::experiment::{Context, Report};
use crate::statistics::Interval;
use alike::{ORDERS, alike};
use families::Families;
use mistakes::{Mistake, claims, wrong};
use motion::Motion;
use writing::{Form, Writing, convention, one_of, written};

const SEED: u64 = 662_607;

/// Errors between the tolerance over this and the tolerance times it are neither clearly right nor clearly wrong.
const MARGIN: f64 = 10.0;

const TOLERANCE: f64 = 1e-6;

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let (trials, each) = context.scale.pick((8, 1), (20, 2), (500, 40));
    let seeds = Random::new(SEED);
    let found = context.in_parallel((0..trials).collect(), |k: u64| one(&mut seeds.stream(k)));
    let found = found.into_iter().collect::<Result<Vec<Found>, Error>>()?;
    let readings = readings(&found);
    let parts: Vec<(usize, u64)> =
        (0..Mistake::ALL.len()).flat_map(|m| (0..each).map(move |k| (m, k))).collect();
    let named = context.in_parallel(parts, |(m, k)| {
        let stream = (1 << 32) + ((m as u64) << 16) + k;
        named(Mistake::ALL[m], &mut seeds.stream(stream))
    });
    let named = named.into_iter().collect::<Result<Vec<Named>, Error>>()?;
    let mistakes = mistakes_table(&named, each as usize);
    let families = Families::run(context, &seeds)?;
    let mut failures = demands(&found, &named);
    failures.extend(families.demands());
    let mut views = vec![readings.clone(), mistakes.clone()];
    views.extend(families.tables());
    let mut tables = vec![readings, mistakes, trials_table(&found)];
    tables.extend(families.tables());
    Ok(Report { tables, views, seed: Some(SEED), failures, ..Report::default() })
}

/// What the audit made of one trajectory.
struct Found {
    /// `None` of the exact motion.
    method: Option<String>,
    form: Form,
    how: Writing,
    /// Of the numbers before they are written: the largest distance from the exact motion, rad or relative.
    error: f64,
    /// The same from the nearest exact motion, where the error is large.
    least: f64,
    suspect: String,
    written: &'static str,
    /// The true reading is the first, or one of those that nobody can tell apart.
    first: bool,
    tied: bool,
    /// The readings of the tie are exactly those that nobody can tell apart.
    tie_exact: bool,
    judgement: Judgement,
    false_right: bool,
    false_wrong: bool,
}

fn one(random: &mut Random) -> Result<Found, Error> {
    let motion = Motion::random(random)?;
    let form = one_of(random, [Form::Quaternion, Form::Matrix, Form::Angles, Form::Rodrigues]);
    let how = Writing::random(random);
    let mut truth = convention(random, form);
    let order = one_of(random, ORDERS);
    truth.moments = order;
    let mut given = [0.0; 3];
    for axis in 0..3 {
        given[order[axis]] = motion.moments[axis];
    }
    let file = written(random, &motion.rows, &truth, form, how);
    let whole = written(random, &motion.exact, &truth, form, Writing::WHOLE);
    let alike = alike(&whole, &truth, given);
    let mut question = Question::new(Some(Body::free(Inertia::from_moments(given).map_err(unexpected)?)));
    question.tolerance = TOLERANCE;
    question.claims.moments = None;
    let verdict = audit(&file, &question).map_err(unexpected)?;
    let tie: &[Reading] = verdict.tie.as_ref().map_or(&[], |tie| &tie.readings);
    let tie_exact = if tie.is_empty() {
        alike.len() == 1
    } else {
        tie.len() == alike.len() && tie.iter().all(|reading| alike.contains(reading))
    };
    let (error, allowed) = (motion.error(), TOLERANCE.max(how.resolution()));
    // the start of a record is known to its digits and noise: what another start explains is no error of the motion
    let least = if error > MARGIN * allowed { motion.least_error(error)? } else { error };
    let judgement = verdict.judgement;
    Ok(Found {
        error,
        least,
        suspect: verdict.suspect.to_string(),
        form,
        how,
        method: motion.method,
        written: how.limit(),
        first: verdict.reading == truth || tie_exact && tie.contains(&truth),
        tied: !tie.is_empty(),
        tie_exact,
        judgement,
        false_right: judgement == Judgement::Right && least > MARGIN * allowed,
        false_wrong: judgement == Judgement::Wrong && error < allowed / MARGIN,
    })
}

fn readings(found: &[Found]) -> Table {
    let count = |name, meaning| Column::new(name, "", meaning);
    let mut table = Table::new(
        "readings",
        "Trajectories of free bodies in random conventions: which reading is found, and the verdict.",
        vec![
            Column::new("source", "", "the exact motion, or a method of the catalogue"),
            Column::new("written", "", "what limits the numbers: noise of 1e-9 to 1e-3, float32, or digits"),
            count("trials", "trajectories"),
            count("first", "with the true reading first, or in the set that nobody can tell apart"),
            count("low", "lower end of the 95 % interval (Wilson) of their share").heading("from"),
            count("high", "upper end of it").heading("to"),
            count("tied", "with a tie"),
            count("other_ties", "with other readings in the tie, or none, than nobody can tell apart")
                .heading("other ties"),
            count("right", "judged right"),
            count("wrong", "judged wrong"),
            count("undecided", "not decided"),
            count("false_right", "judged right, ten times what is allowed from the nearest exact motion")
                .heading("false right"),
            count("false_wrong", "judged wrong with an error of a tenth of what is allowed")
                .heading("false wrong"),
        ],
    );
    for exact in [true, false] {
        for written in ["12 to 17 digits", "6 to 11 digits", "float32", "noise"] {
            let cell: Vec<&Found> = found
                .iter()
                .filter(|found| found.method.is_none() == exact && found.written == written)
                .collect();
            let number =
                |which: &dyn Fn(&Found) -> bool| cell.iter().filter(|found| which(found)).count() as u64;
            let first = Interval::new(number(&|found| found.first), cell.len() as u64);
            table.push(row![
                if exact { "exact" } else { "methods" },
                written,
                cell.len() as u64,
                number(&|found| found.first),
                first.map(|x| x.low),
                first.map(|x| x.high),
                number(&|found| found.tied),
                number(&|found| !found.tie_exact),
                number(&|found| found.judgement == Judgement::Right),
                number(&|found| found.judgement == Judgement::Wrong),
                number(&|found| found.judgement == Judgement::Undecided),
                number(&|found| found.false_right),
                number(&|found| found.false_wrong),
            ]);
        }
    }
    table
}

/// Every trajectory, for those who look for one.
fn trials_table(found: &[Found]) -> Table {
    let column = |name, meaning| Column::new(name, "", meaning);
    let mut table = Table::new(
        "trials",
        "Trajectories of free bodies in random conventions, one by one.",
        vec![
            column("trial", "number of the stream of random numbers"),
            column("source", "exact, or the method that computed it"),
            column("form", "what the attitude is written as"),
            column("digits", "significant digits that are written"),
            column("single", "whether the numbers are of single precision"),
            column("noise", "noise of each number, relative to its column"),
            column("error", "largest distance from the exact motion before it is written, rad or relative"),
            column(
                "least_error",
                "the same from the nearest exact motion, where it is ten times what is allowed",
            ),
            column("verdict", "right, wrong or undecided"),
            column("suspect", "what is wrong"),
            column("first", "whether the true reading is first, or in the set that nobody can tell apart"),
            column("tied", "whether a tie is stated"),
            column("tie_exact", "whether the tie is the set that nobody can tell apart"),
            column("false_verdict", "right or wrong, where that is false"),
        ],
    );
    let yes = |is: bool| if is { "yes" } else { "no" };
    for (trial, found) in found.iter().enumerate() {
        table.push(row![
            trial as u64,
            found.method.clone().unwrap_or_else(|| "exact".into()),
            format!("{:?}", found.form).to_lowercase(),
            found.how.digits as u64,
            yes(found.how.single),
            found.how.noise,
            found.error,
            found.least,
            found.judgement.to_string(),
            found.suspect.clone(),
            yes(found.first),
            yes(found.tied),
            yes(found.tie_exact),
            (found.false_right || found.false_wrong).then(|| found.judgement.to_string()),
        ]);
    }
    table
}

/// What the audit made of a program with a mistake.
struct Named {
    named: bool,
    right: bool,
}

fn named(mistake: Mistake, random: &mut Random) -> Result<Named, Error> {
    let wrong = wrong(mistake, random);
    let form = one_of(random, [Form::Quaternion, Form::Matrix, Form::Angles, Form::Rodrigues]);
    let noise = one_of(random, [0.0, 1e-6, 1e-4]);
    let mut reading = convention(random, form);
    reading.attitude = Some(polhode::audit::Direction::BodyToSpace);
    reading.omega_frame = Some(polhode::audit::Frame::Body);
    let record = written(random, &wrong.rows, &reading, form, Writing { noise, ..Writing::WHOLE });
    let body = Body::free(Inertia::from_moments(wrong.moments).map_err(unexpected)?);
    let mut question = Question::new(Some(body));
    question.claims = claims(mistake);
    question.claims.rate_unit = reading.rate_unit;
    let verdict = audit(&record, &question).map_err(unexpected)?;
    Ok(Named {
        named: verdict.suspect.to_string() == mistake.name(),
        right: verdict.judgement == Judgement::Right,
    })
}

fn mistakes_table(named: &[Named], each: usize) -> Table {
    let mut table = Table::new(
        "mistakes",
        "Programs with one mistake each: how often it is named first.",
        vec![
            Column::new("mistake", "", "name of the suspect"),
            Column::new("program", "", "what the program does"),
            Column::new("trials", "", "trajectories"),
            Column::new("named", "", "with this suspect"),
            Column::new("low", "", "lower end of the 95 % interval (Wilson) of their share").heading("from"),
            Column::new("high", "", "upper end of it").heading("to"),
            Column::new("right", "", "judged right"),
        ],
    );
    for (mistake, cell) in Mistake::ALL.into_iter().zip(named.chunks(each)) {
        let named = cell.iter().filter(|trial| trial.named).count() as u64;
        let interval = Interval::new(named, cell.len() as u64);
        table.push(row![
            mistake.name(),
            mistake.meaning(),
            cell.len() as u64,
            named,
            interval.map(|x| x.low),
            interval.map(|x| x.high),
            cell.iter().filter(|trial| trial.right).count() as u64,
        ]);
    }
    table
}

/// What has to hold, and does not.
fn demands(found: &[Found], named: &[Named]) -> Vec<String> {
    let count = |which: fn(&Found) -> bool| found.iter().filter(|found| which(found)).count();
    let mut failures = Vec::new();
    let first = count(|found| found.first);
    if (first as f64) < 0.99 * found.len() as f64 {
        failures.push(format!("the true reading is first in {first} of {} trajectories", found.len()));
    }
    for (what, number) in [
        ("falsely right", count(|found| found.false_right)),
        ("falsely wrong", count(|found| found.false_wrong)),
    ] {
        if number > 0 {
            failures.push(format!("{number} of {} trajectories are judged {what}", found.len()));
        }
    }
    let unnamed = named.iter().filter(|trial| !trial.named).count();
    if unnamed > 0 {
        failures.push(format!("{unnamed} of {} mistakes are not named", named.len()));
    }
    failures
}
