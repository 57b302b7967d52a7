//! What is being thought about, for those who wait.

use core::fmt;

/// What advice is busy with.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Stage {
    /// Two runs of different methods show the motion.
    Motion,
    /// Every method is tried over a short time.
    Methods,
    /// A method is run as far as is affordable.
    Run(String),
    /// A choice is run and compared with the motion.
    Check(String),
}

/// How far advice has come. Nothing is said more often than is useful: a listener may leave out most of it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Progress {
    /// What it is busy with.
    pub stage: Stage,
    /// What part of that is done, from 0 to 1.
    pub done: f64,
    /// How long all of that takes about, s, where it is known.
    pub seconds: Option<f64>,
}

impl Progress {
    pub(super) fn new(stage: &Stage, done: f64, seconds: Option<f64>) -> Self {
        Progress { stage: stage.clone(), done: done.clamp(0.0, 1.0), seconds }
    }
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Stage::Motion => f.write_str("following the motion by two methods"),
            Stage::Methods => f.write_str("trying every method"),
            Stage::Run(method) => write!(f, "running {method}"),
            Stage::Check(method) => write!(f, "checking {method}"),
        }
    }
}
