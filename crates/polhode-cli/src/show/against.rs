//! The second body of a page: moved by a method, or by another program.

use std::path::{Path, PathBuf};

use nalgebra::UnitQuaternion;
use polhode::body::{Clock, Problem};
use polhode::flow::ExactMotion;
use polhode::method::{Claimed, method};
use polhode::num::Dd;
use polhode::observe::Monitor;
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode::truth::LOST;
use polhode_files::error::{Error, warn};
use polhode_files::numbers::{positive, turn};
use polhode_files::text::{short, visible};
use polhode_files::{ReadOptions, trajectory};
use polhode_pages::scene::{Flips, Track};

use super::{MOST, Show, keeps_energy};
use crate::compare::trajectory::Trajectory;
use crate::methods::unknown;
use crate::plot::animation::track;
use crate::plot::looks::{Course, Ended, Flags, Looks, middle_axis};

/// What `--against` names.
pub(super) enum Against {
    File(PathBuf),
    /// As typed, with its step where it has fixed ones.
    Method {
        typed: String,
        name: String,
        step: Option<f64>,
    },
}

/// A track and what is to be known of it.
pub(super) struct Rival {
    pub(super) track: Track,
    pub(super) note: String,
    /// Whether it was read from quaternions.
    pub(super) has_quaternions: bool,
}

const FLAGS: Flags = Flags { method: "--against", step: "--against" };

impl Against {
    pub(super) fn of(text: &str) -> Result<Self, Error> {
        if Path::new(text).is_file() {
            return Ok(Against::File(text.into()));
        }
        let typed = text.to_owned();
        // the step follows the last colon; what chooses its steps takes a tolerance there or nothing
        if let Ok(found) = method(text)
            && found.tolerance().is_some()
        {
            return Ok(Against::Method { name: typed.clone(), typed, step: None });
        }
        let (name, step) = match text.rsplit_once(':') {
            Some((name, step)) if positive(step).is_ok() => (name, positive(step).ok()),
            _ => (text, None),
        };
        if name == "exact" {
            let rule = "is the reference of the comparison";
            return Err(Error::input("--against", text, rule, "name a method and its step, as rk4:0.1"));
        }
        match method(name) {
            Ok(_) if step.is_some() => Ok(Against::Method { typed, name: name.into(), step }),
            Ok(_) => {
                let rule = "missing: the step of the method, s";
                Err(Error::input("--against", text, rule, &format!("write it after a colon, as {text}:0.1")))
            }
            Err(_) if text.contains(['/', '.']) && step.is_none() => {
                let rule = "no such file, and no method with its step";
                Err(Error::input(
                    "--against",
                    text,
                    rule,
                    "name a file with attitudes, or METHOD:STEP as rk4:0.1",
                ))
            }
            Err(error) => Err(unknown("--against", error)),
        }
    }
}

/// The last time of the files among them.
pub(super) fn last_time(against: &[Against], reading: &ReadOptions) -> Result<Option<f64>, Error> {
    let mut last: Option<f64> = None;
    for against in against {
        let Against::File(path) = against else { continue };
        let found = trajectory::read(path, reading)?;
        let times = found.bodies.iter().filter_map(|(_, rows)| rows.times.last().copied());
        last = times.fold(last, |last, t| Some(last.map_or(t, |last| last.max(t))));
    }
    Ok(last)
}

impl Show {
    /// The body that moves beside `first`.
    pub(super) fn rival(
        &self,
        against: &Against,
        course: &Course,
        looks: &Looks,
        upright: UnitQuaternion<f64>,
        first: &Track,
    ) -> Result<Rival, Error> {
        let mut rival = match against {
            Against::Method { typed, name, step } => {
                self.stepped(typed, name, *step, course, upright, keeps_energy(&looks.body))?
            }
            Against::File(path) => self.recorded(path, course, looks, upright, first)?,
        };
        let exact = looks.exact.as_ref().filter(|_| course.method == "exact");
        let of_first = |t: f64| match exact {
            Some(motion) => Some(upright * exact_attitude(motion, looks, t - course.start_time)),
            None => first.attitude(t),
        };
        let pairs = rival.track.times.iter().zip(&rival.track.attitudes);
        let angle =
            |p: UnitQuaternion<f64>, q: &UnitQuaternion<f64>| rotation_angle::<f64>(p.into(), (*q).into());
        rival.track.angles = pairs.map(|(t, q)| of_first(*t).map_or(0.0, |p| angle(p, q))).collect();
        Ok(rival)
    }

    fn stepped(
        &self,
        typed: &str,
        name: &str,
        step: Option<f64>,
        course: &Course,
        upright: UnitQuaternion<f64>,
        has_energy: bool,
    ) -> Result<Rival, Error> {
        let mut until = course.until;
        if let Some(step) = step {
            // whole steps, as many as there is room for
            let steps = libm::floor(course.span() / step * (1.0 + 4.0 * f64::EPSILON));
            if steps < 1.0 {
                let rule = format!("the step is longer than the motion, {} s", short(course.span()));
                return Err(Error::input(
                    "--against",
                    typed,
                    &rule,
                    "use a smaller step, or a later --until",
                ));
            }
            until = course.start_time + steps * step;
        }
        let own = Course { method: name, step, tolerance: None, until, most: MOST, flags: FLAGS, ..*course };
        let looks = Looks::of(&own)?;
        let mut found = track(&own, &looks, upright);
        found.name = step.map_or_else(|| name.to_owned(), |h| format!("{name}, h = {} s", short(h)));
        found.energy_changes = if has_energy { looks.energy_changes.clone() } else { Vec::new() };
        (found.omegas, found.momenta) = (Vec::new(), Vec::new());
        let mut note = format!(
            "Faded: {}, {} attitudes from the same start; between two of them the page turns it evenly.",
            found.name,
            found.times.len()
        );
        if let Some(Ended { why, ending }) = &looks.ended {
            let Some(ending) = ending.map(|ending| ending.by_clock(course.start_time)) else {
                return Err(Error::Failed(format!("--against: '{typed}': {why}")));
            };
            let words = ending.to_string();
            let last = found.times.last().copied().unwrap_or(course.start_time);
            note = format!("{note} It {words} s, and is shown up to then.");
            warn(&format!("--against: '{typed}': {words} s; it is shown up to then"));
            found.ending = Some((ending.time().unwrap_or(last).max(last), ending.word().into()));
        }
        Ok(Rival { track: found, note, has_quaternions: false })
    }

    fn recorded(
        &self,
        path: &Path,
        course: &Course,
        looks: &Looks,
        upright: UnitQuaternion<f64>,
        first: &Track,
    ) -> Result<Rival, Error> {
        let (start, end) = (course.start_time, course.until);
        let order = self.quaternion.map(Into::into);
        let read = Trajectory::read(path, &self.table, order, &looks.body, (start, end))?;
        let refused =
            |value: &str, rule: &str, remedy: &str| Err(Error::input(&read.name, value, rule, remedy));
        let mut found = Track { name: file_name(path), ..Track::default() };
        for row in &read.rows {
            let attitude = turn(row.attitude).unwrap_or_default();
            found.times.push(row.t);
            found.attitudes.push(upright * attitude);
        }
        let (Some(t), Some(q)) = (found.times.first().copied(), found.attitudes.first().copied()) else {
            return refused("", "has no rows", "name a file with attitudes");
        };
        if found.times.last() == Some(&t) {
            return refused(&short(t), "is its only time, and nothing would move", "give rows up to --until");
        }
        let apart = first.attitude(t).map_or(0.0, |p| rotation_angle::<f64>(p.into(), q.into()));
        if apart > LOST {
            let rule = format!(
                "its first attitude differs by {apart:.2} rad from this body's at that time: another body or another start"
            );
            return refused(&short(t), &rule, "name the body of the file and its start");
        }
        self.count(&read, looks, course, upright, &mut found)?;
        let note = format!(
            "Faded: {}, {} attitudes from t = {} to {} s; between two of them the page turns it evenly.",
            found.name,
            found.times.len(),
            short(t),
            short(found.times.last().copied().unwrap_or(t))
        );
        if let Some(&last) = found.times.last()
            && last < end - 1e-9 * course.span()
        {
            found.ending = Some((last, "ends".into()));
        }
        Ok(Rival { track: found, note, has_quaternions: read.has_quaternions })
    }

    /// Flips of a file, and its energy where it has angular velocities.
    fn count(
        &self,
        read: &Trajectory,
        looks: &Looks,
        course: &Course,
        upright: UnitQuaternion<f64>,
        found: &mut Track,
    ) -> Result<(), Error> {
        let body = &looks.body;
        let start = self.motion.start(body, course.start_time)?;
        let monitor = Monitor::new(body, Clock { start: course.start_time, step: 1.0 }, &start.to_f64());
        let mut momenta = Vec::new();
        for (row, attitude) in read.rows.iter().zip(&found.attitudes) {
            match row.omega_body {
                Some(omega) => {
                    let quaternion = Quat::from_components(row.attitude);
                    let point = body.enter_omega(quaternion, Vec3(omega)).map_err(|error| {
                        Error::Input(format!("{}: t = {}: {error}", read.name, short(row.t)))
                    })?;
                    if keeps_energy(body) {
                        found.energy_changes.push(monitor.energy_change(&point.to_f64()));
                    }
                    momenta.push(body.leave(&point).momentum());
                }
                // the momentum of a free body stays where it is in space
                None if body.problem() == Problem::Free => {
                    let space = looks.states[0].momentum_space();
                    momenta.push(attitude.inverse() * (upright * space));
                }
                None => return Ok(()),
            }
        }
        let Some(axis) = middle_axis(body).filter(|_| looks.flips.is_some()) else { return Ok(()) };
        let along: Vec<f64> = momenta.iter().map(|m| m.dot(&axis)).collect();
        let changes =
            along.windows(2).zip(&found.times[1..]).filter(|(pair, _)| (pair[0] > 0.0) != (pair[1] > 0.0));
        let times: Vec<f64> = changes.map(|(_, t)| *t).collect();
        found.flips = Some(Flips { count: times.len() as u64, times });
        Ok(())
    }
}

fn file_name(path: &Path) -> String {
    let name = path
        .file_name()
        .map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned());
    visible(&name).into_owned()
}

fn exact_attitude(motion: &ExactMotion, looks: &Looks, elapsed: f64) -> UnitQuaternion<f64> {
    looks.body.leave(&motion.point_at(Dd::from(elapsed))).rotation()
}
