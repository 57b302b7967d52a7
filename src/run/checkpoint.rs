//! A run written down, to be taken up again.

use core::fmt;
use core::str::FromStr;

use thiserror::Error;

use super::Watch;
use crate::body::{Body, Clock, Point};
use crate::num::Dd;
use crate::observe::{Errors, Memory};
use crate::rotation::Vec3;

/// A run as it stands, complete: taken up again it goes on as if it had not been interrupted, bit for bit.
///
/// Its text (`Display`, `FromStr`) holds every double exactly and is the same on every machine. The body is not part of it,
/// as forces are code; what identifies it is, and [`Run::resume`](super::Run::resume) compares.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    pub(super) method: String,
    pub(super) body: Vec<String>,
    pub(super) clock: Clock,
    pub(super) watch: Watch,
    pub(super) start: Point<f64>,
    pub(super) point: Point<f64>,
    pub(super) memory: Memory,
    pub(super) residual: f64,
}

/// Why a run cannot be taken up.
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
}

/// First line of the text; the number is that of the format.
const HEAD: &str = "polhode checkpoint 1";

/// What a body is identified by: moments and scale, weight moment, and the names of its forces.
pub(super) fn identity(body: &Body) -> Vec<String> {
    let numbers =
        |v: Vec3<Dd>| v.0.iter().map(|x| format!("{:?} {:?}", x.hi(), x.lo())).collect::<Vec<_>>().join(" ");
    let moments = format!("moments {} times {:?}", numbers(body.rotor().moments()), body.scale());
    let weight = body.gravity::<Dd>().map(|gravity| format!("weight {}", numbers(gravity.weight_moment)));
    let forces = body.forces().iter().map(|force| format!("force {:?}", force.name()));
    core::iter::once(moments).chain(weight).chain(forces).collect()
}

impl Checkpoint {
    /// Steps that the run has taken.
    pub fn steps(&self) -> u64 {
        self.point.steps()
    }

    /// Whether `method` and `body` are those of the run.
    pub(super) fn check(&self, method: &str, body: &Body) -> Result<(), CheckpointError> {
        if self.method != method {
            return Err(CheckpointError::Method { expected: self.method.clone(), given: method.into() });
        }
        let given = identity(body);
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
        writeln!(f, "{HEAD}\nmethod {}", self.method)?;
        for line in &self.body {
            writeln!(f, "body {line}")?;
        }
        writeln!(f, "clock {:?} {:?}", self.clock.start, self.clock.step)?;
        writeln!(f, "watch {}", self.watch)?;
        writeln!(f, "start {}", list(&self.start.parts()))?;
        writeln!(f, "steps {}", self.point.steps())?;
        writeln!(f, "point {}", list(&self.point.parts()))?;
        writeln!(f, "worst {worst}")?;
        writeln!(f, "flips {} {sign} {}", self.memory.flips, self.memory.loud)?;
        writeln!(f, "residual {:?}", self.residual)
    }
}

/// Lines of a text with their numbers, each with its key.
struct Lines<'a> {
    lines: core::iter::Peekable<core::iter::Enumerate<core::str::Lines<'a>>>,
}

impl<'a> Lines<'a> {
    fn after(&mut self, key: &str, rule: &'static str) -> Result<(usize, &'a str), CheckpointError> {
        let (n, line) = self.lines.next().unwrap_or((0, ""));
        let rest = line.strip_prefix(key).and_then(|rest| rest.strip_prefix(' '));
        rest.map(|rest| (n + 1, rest)).ok_or_else(|| CheckpointError::Text {
            line: n + 1,
            found: line.into(),
            rule,
        })
    }

    fn parsed<T>(
        &mut self,
        key: &str,
        rule: &'static str,
        parse: impl Fn(&str) -> Option<T>,
    ) -> Result<T, CheckpointError> {
        let (line, text) = self.after(key, rule)?;
        parse(text).ok_or_else(|| CheckpointError::Text { line, found: text.into(), rule })
    }
}

fn doubles<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers: Option<Vec<f64>> =
        text.split(' ').map(|x| x.parse().ok().filter(|x: &f64| x.is_finite())).collect();
    numbers?.try_into().ok()
}

impl FromStr for Checkpoint {
    type Err = CheckpointError;

    fn from_str(text: &str) -> Result<Self, CheckpointError> {
        let mut lines = Lines { lines: text.lines().enumerate().peekable() };
        match lines.lines.next() {
            Some((_, HEAD)) => {}
            other => {
                let found = other.map_or("", |(_, line)| line).into();
                return Err(CheckpointError::Text {
                    line: 1,
                    found,
                    rule: "it must be 'polhode checkpoint 1'",
                });
            }
        }
        let method = lines.after("method", "it must name the method")?.1.into();
        let mut body = Vec::new();
        while let Some((_, line)) = lines.lines.next_if(|(_, line)| line.starts_with("body ")) {
            body.push(line.trim_start_matches("body ").into());
        }
        let [start, step] = lines.parsed("clock", "it must hold start time and step", doubles)?;
        let watch = lines.parsed("watch", "it must say every-step, at-samples or never", |text| {
            [Watch::EveryStep, Watch::AtSamples, Watch::Never]
                .into_iter()
                .find(|watch| watch.to_string() == text)
        })?;
        let first = lines.parsed("start", "it must hold 14 numbers", doubles)?;
        let steps = lines.parsed("steps", "it must hold the number of steps", |text| text.parse().ok())?;
        let point = lines.parsed("point", "it must hold 14 numbers", doubles)?;
        let worst = lines.parsed("worst", "it must hold 5 errors, - where there is none", |text| {
            let errors: Option<Vec<Option<f64>>> = text
                .split(' ')
                .map(|error| if error == "-" { Some(None) } else { error.parse().ok().map(Some) })
                .collect();
            errors?.try_into().ok()
        })?;
        let (flips, positive, loud) =
            lines.parsed("flips", "it must hold a count, a sign and a count", |text| {
                let mut words = text.split(' ');
                let flips = words.next()?.parse().ok()?;
                let positive = match words.next()? {
                    "0" => None,
                    "+" => Some(true),
                    "-" => Some(false),
                    _ => return None,
                };
                Some((flips, positive, words.next()?.parse().ok()?))
            })?;
        let [residual] = lines.parsed("residual", "it must hold a number", doubles)?;
        Ok(Checkpoint {
            method,
            body,
            clock: Clock { start, step },
            watch,
            start: Point::from_parts(first, 0),
            point: Point::from_parts(point, steps),
            memory: Memory { worst: Errors::from_parts(worst), flips, positive, loud },
            residual,
        })
    }
}
