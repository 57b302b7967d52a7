//! Checkpoints: the complete state of a run as text.

use core::fmt;
use core::str::FromStr;

use thiserror::Error;

use super::Watch;
use crate::body::{Body, Clock, Point};
use crate::num::Dd;
use crate::observe::{Errors, Memory};
use crate::rotation::Vec3;

/// The complete state of a run: when resumed, it continues as if it had not been interrupted, bit for bit.
///
/// Its text (`Display`, `FromStr`) holds every double exactly and is the same on every machine. The body is not part of it,
/// as forces are code; what identifies it is, and [`Run::resume`](super::Run::resume) compares.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Checkpoint {
    pub(super) method: String,
    pub(super) body: Vec<String>,
    pub(super) clock: Clock,
    pub(super) watch: Watch,
    pub(super) start: Point<f64>,
    pub(super) point: Point<f64>,
    /// What the method remembers besides the point.
    pub(super) method_memory: Vec<f64>,
    pub(super) memory: Memory,
    pub(super) residual: f64,
    /// Whether steps have been taken that were not watched.
    pub(super) missed: bool,
}

/// Why a run cannot be resumed.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// The text is not that of a checkpoint.
    #[error("line {line} of the checkpoint is {found:?}; {rule}")]
    Text {
        /// Line, counted from 1.
        line: usize,
        /// What it says.
        found: String,
        /// What it should be.
        rule: &'static str,
    },
    /// The run was made by another method.
    #[error("the checkpoint is of a run by {expected}, and the method given is {given}")]
    Method {
        /// The method of the run.
        expected: String,
        /// The method given.
        given: String,
    },
    /// The run was that of another body.
    #[error("the checkpoint is of a body with {expected}, and the body given has {given}")]
    Body {
        /// What identifies the body of the run.
        expected: String,
        /// The same of the body given.
        given: String,
    },
    /// The method remembers another count of numbers.
    #[error("the checkpoint holds {stored} numbers that the method remembers, and the method needs {needed}")]
    Memory {
        /// How many the method needs.
        needed: usize,
        /// How many there are.
        stored: usize,
    },
}

/// First line of the text; the number is that of the format.
const HEAD: &str = "polhode checkpoint 3";

/// What a body is identified by: moments, scale and principal axes, weight moment, the names of its forces, and energy and
/// torque at the start, which tell forces of one name from each other.
pub(super) fn identity(body: &Body, clock: Clock, start: &Point<f64>) -> Vec<String> {
    let numbers =
        |v: Vec3<Dd>| v.0.iter().map(|x| format!("{:?} {:?}", x.hi(), x.lo())).collect::<Vec<_>>().join(" ");
    let moments = format!("moments {} times {:?}", numbers(body.rotor().moments()), body.scale());
    let weight = body.linear_potential::<Dd>().map(|linear| format!("weight {}", numbers(linear.moment)));
    let axes = body.inertia().principal_axes();
    let axes = format!("axes {:?} {:?} {:?} {:?}", axes.w, axes.i, axes.j, axes.k);
    let forces = body.remainder().map(|force| match force.intervals() {
        None => format!("force {:?}", force.name()),
        Some(intervals) => format!("force {:?} during {intervals:?}", force.name()),
    });
    let wheels = body.wheels().iter().map(|wheel| format!("wheel {wheel}"));
    let (at, start) = (clock.at(0), start.to_dd());
    let energy = body.energy_of(at, &start);
    let at_start =
        format!("start {:?} {:?} {}", energy.hi(), energy.lo(), numbers(body.torque_of(at, &start)));
    [moments, axes].into_iter().chain(weight).chain(forces).chain(wheels).chain([at_start]).collect()
}

impl Checkpoint {
    /// Steps that the run has taken.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.point.steps()
    }

    /// Whether `method` and `body` are those of the run.
    pub(super) fn check(&self, method: &str, body: &Body) -> Result<(), CheckpointError> {
        let method = method.escape_debug().to_string();
        if self.method != method {
            return Err(CheckpointError::Method { expected: self.method.clone(), given: method });
        }
        let given = identity(body, self.clock, &self.start);
        if self.body != given {
            let (expected, given) = (self.body.join(", "), given.join(", "));
            return Err(CheckpointError::Body { expected, given });
        }
        Ok(())
    }
}

impl fmt::Display for Checkpoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |numbers: &[f64]| numbers.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(" ");
        let worst =
            self.memory.worst.parts().map(|error| error.map_or("-".into(), |e| format!("{e:?}"))).join(" ");
        let sign = match self.memory.positive {
            None => "0",
            Some(true) => "+",
            Some(false) => "-",
        };
        writeln!(f, "{HEAD}\nmethod \"{}\"", self.method)?;
        for line in &self.body {
            writeln!(f, "body {line}")?;
        }
        writeln!(f, "clock {:?} {:?}", self.clock.start, self.clock.step)?;
        writeln!(f, "watch {} {}", self.watch, if self.missed { "missed" } else { "seen" })?;
        writeln!(f, "start {}", list(&self.start.parts()))?;
        writeln!(f, "steps {}", self.point.steps())?;
        writeln!(f, "point {}", list(&self.point.parts()))?;
        match self.method_memory.as_slice() {
            [] => writeln!(f, "memory -")?,
            memory => writeln!(f, "memory {}", list(memory))?,
        }
        writeln!(f, "worst {worst}")?;
        writeln!(f, "flips {} {sign}", self.memory.flips)?;
        writeln!(f, "residual {:?}", self.residual)
    }
}

/// Lines of a text with their numbers, each with its key.
struct Lines<'a> {
    lines: core::iter::Peekable<core::str::Lines<'a>>,
    /// Lines taken so far.
    taken: usize,
}

impl<'a> Lines<'a> {
    fn refused(&self, found: &str, rule: &'static str) -> CheckpointError {
        CheckpointError::Text { line: self.taken, found: found.into(), rule }
    }

    /// What stands behind `key` in the next line.
    fn after(&mut self, key: &str, rule: &'static str) -> Result<&'a str, CheckpointError> {
        self.taken += 1;
        let line = self.lines.next().unwrap_or("");
        let rest = line.strip_prefix(key).and_then(|rest| rest.strip_prefix(' '));
        rest.ok_or_else(|| self.refused(line, rule))
    }

    fn parsed<T>(
        &mut self,
        key: &str,
        rule: &'static str,
        parse: impl Fn(&str) -> Option<T>,
    ) -> Result<T, CheckpointError> {
        let text = self.after(key, rule)?;
        parse(text).ok_or_else(|| self.refused(text, rule))
    }
}

fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|x: &f64| x.is_finite())
}

/// A count of steps, or of what happens once a step at most: as in a [`Schedule`](super::Schedule), no more than 2⁵³.
fn count(text: &str) -> Option<u64> {
    text.parse().ok().filter(|count: &u64| *count <= 1 << 53)
}

/// Infinite where an implicit step had no solution.
fn residual(text: &str) -> Option<f64> {
    text.parse().ok().filter(|residual: &f64| *residual >= 0.0)
}

fn doubles<const N: usize>(text: &str) -> Option<[f64; N]> {
    text.split(' ').map(finite).collect::<Option<Vec<f64>>>()?.try_into().ok()
}

fn memory(text: &str) -> Option<Vec<f64>> {
    if text == "-" { Some(Vec::new()) } else { text.split(' ').map(finite).collect() }
}

fn watched(text: &str) -> Option<(Watch, bool)> {
    let (watch, missed) = text.split_once(' ')?;
    let watch =
        [Watch::EveryStep, Watch::AtSamples, Watch::Never].into_iter().find(|w| w.to_string() == watch)?;
    match missed {
        "seen" => Some((watch, false)),
        "missed" => Some((watch, true)),
        _ => None,
    }
}

fn errors(text: &str) -> Option<[Option<f64>; 5]> {
    let errors = text.split(' ').map(|error| if error == "-" { Some(None) } else { finite(error).map(Some) });
    errors.collect::<Option<Vec<Option<f64>>>>()?.try_into().ok()
}

fn flips(text: &str) -> Option<(u64, Option<bool>)> {
    let (flips, sign) = text.split_once(' ')?;
    let positive = match sign {
        "0" => None,
        "+" => Some(true),
        "-" => Some(false),
        _ => return None,
    };
    Some((count(flips)?, positive))
}

impl FromStr for Checkpoint {
    type Err = CheckpointError;

    fn from_str(text: &str) -> Result<Self, CheckpointError> {
        let mut lines = Lines { lines: text.lines().peekable(), taken: 1 };
        let head = lines.lines.next().unwrap_or("");
        if head != HEAD {
            return Err(lines.refused(head, "it must be 'polhode checkpoint 3'"));
        }
        let quoted = |text: &str| Some(text.strip_prefix('"')?.strip_suffix('"')?.to_owned());
        let method = lines.parsed("method", "it must name the method in quotes", quoted)?;
        let mut body = Vec::new();
        while lines.lines.peek().is_some_and(|line| line.starts_with("body ")) {
            body.push(lines.after("body", "it must identify the body")?.into());
        }
        let [start, step] = lines.parsed("clock", "it must hold start time and step", doubles)?;
        let (watch, missed) = lines.parsed(
            "watch",
            "it must say every-step, at-samples or never, and whether steps were seen or missed",
            watched,
        )?;
        let first = lines.parsed("start", "it must hold 14 numbers", doubles)?;
        let steps = lines.parsed("steps", "it must hold the number of steps, at most 2^53", count)?;
        let point = lines.parsed("point", "it must hold 14 numbers", doubles)?;
        let method_memory =
            lines.parsed("memory", "it must hold numbers, or - where there are none", memory)?;
        let worst = lines.parsed("worst", "it must hold 5 errors, - where there is none", errors)?;
        let (flips, positive) = lines.parsed("flips", "it must hold a count and a sign", flips)?;
        let residual = lines.parsed("residual", "it must hold a number from 0 on", residual)?;
        if let Some(line) = lines.lines.next() {
            lines.taken += 1;
            return Err(lines.refused(line, "the line before is the last"));
        }
        Ok(Checkpoint {
            method,
            body,
            clock: Clock { start, step },
            watch,
            start: Point::from_parts(first, 0),
            point: Point::from_parts(point, steps),
            method_memory,
            memory: Memory { worst: Errors::from_parts(worst), flips, positive },
            residual,
            missed,
        })
    }
}
