//! Why there is no advice.

use thiserror::Error;

use super::trial::SAME_RUN;
use crate::body::StateError;
use crate::num::Shown;
use crate::run::RunError;
use crate::truth::TruthError;

/// Why there is no advice.
#[derive(Clone, Debug, Error)]
#[non_exhaustive]
pub enum AdviseError {
    /// A part of the demand is not a positive number.
    #[error("{quantity} is {}{}{unit}; it must be a finite number above 0", Shown(*value), if unit.is_empty() { "" } else { " " })]
    NotPositive {
        /// What it is.
        quantity: &'static str,
        /// Its unit.
        unit: &'static str,
        /// What was given.
        value: f64,
    },
    /// An attitude error that is none.
    #[error("an attitude error of {} rad leaves the attitude unknown; ask for 1 rad or less", Shown(*attitude_error))]
    Lost {
        /// What was asked for, rad.
        attitude_error: f64,
    },
    /// An energy error of a motion that does not conserve energy.
    #[error(
        "the torques on the body, or the motor of a wheel, do not conserve its energy, so that no energy error can be limited; leave the energy error out"
    )]
    NotConserved,
    /// The start is not usable.
    #[error(transparent)]
    State(#[from] StateError),
    /// An energy error that no state in doubles has.
    #[error(
        "a relative energy error of {demand:.1e} is below rounding: to round the angular momentum to doubles changes the energy \
         by up to {:.1e}; ask for more than that",
        f64::EPSILON
    )]
    EnergyBelowRounding {
        /// What was asked for.
        demand: f64,
    },
    /// Nothing moves.
    #[error("the body is at rest and stays so: every method is exact")]
    AtRest,
    /// The demand is below what the digits of the start allow.
    #[error(
        "an attitude error of {demand:.1e} rad at t = {} s is below what the start allows: one unit in the last digit of the \
         angular momentum grows to {attainable:.1e} rad until then; ask for more than that, or for a shorter time",
        Shown(*until)
    )]
    Conditioning {
        /// What was asked for, rad.
        demand: f64,
        /// What one unit in the last digit of the start grows to, rad.
        attainable: f64,
        /// Duration, s.
        until: f64,
    },
    /// No run in double-double takes the forces.
    #[error(
        "the forces on the body cannot be evaluated in double-double, so that no run can be judged; write them for every Real"
    )]
    NoReference,
    /// Two runs by different methods part, as do starts that differ by a rounding.
    #[error(
        "two runs by different methods agree to {demand:.1e} rad up to t = {} s only: the motion is chaotic; ask for a time below that",
        Shown(*agree_until)
    )]
    Chaotic {
        /// What was asked for, rad.
        demand: f64,
        /// Until when they agree, s.
        agree_until: f64,
    },
    /// No candidate meets the demand.
    #[error(
        "no method meets {demand:.1e} rad until t = {} s; the best is {method} with {error:.1e} rad, and up to {SAME_RUN} times \
         that between the times that were checked", Shown(*until)
    )]
    Unreached {
        /// What was asked for, rad.
        demand: f64,
        /// The nearest method.
        method: String,
        /// The error that it is expected to have, rad.
        error: f64,
        /// Duration, s.
        until: f64,
    },
    /// No candidate meets the demand on the energy.
    #[error(
        "no method meets a relative energy error of {demand:.1e} until t = {} s; the best is {method} with {error:.1e}, and up \
         to {SAME_RUN} times that between the times that were checked", Shown(*until)
    )]
    EnergyUnreached {
        /// What was asked for.
        demand: f64,
        /// The nearest method.
        method: String,
        /// The relative error that it is expected to have.
        error: f64,
        /// Duration, s.
        until: f64,
    },
    /// No candidate meets the demand within the budget.
    #[error("no method meets the demand within {} s of processor time; the quickest is {method} with {seconds:.2e} s", Shown(*budget))]
    Budget {
        /// What was given, s.
        budget: f64,
        /// The quickest method.
        method: String,
        /// What it takes, s.
        seconds: f64,
    },
    /// Runs of the whole time would take too long.
    #[error(
        "the motion has no closed form, and to t = {} s the body turns by about {turn:.1e} rad: a run of all of it takes minutes or \
         more; ask for a time up to {reach:.3e} s", Shown(*until)
    )]
    TooLong {
        /// Duration, s.
        until: f64,
        /// The turn to there, rad.
        turn: f64,
        /// About the longest duration that is run, s.
        reach: f64,
    },
    /// The torque jumps.
    #[error(
        "the torque jumps at t = {} s: no method has its order across a jump, and methods that choose their steps do not agree \
         there to {demand:.1e} rad; end the run there and begin another, ask for a larger error, or write the torque without jumps",
        Shown(*time)
    )]
    Jumps {
        /// What was asked for, rad.
        demand: f64,
        /// When it first jumps, s since the start.
        time: f64,
    },
    /// The torque jumps, and runs that choose their steps would take too long.
    #[error(
        "the torque jumps at t = {} s: no method has its order across a jump, and an adaptive reference run for {demand:.1e} \
         rad would take about {steps:.1e} steps, more than the {most:.1e} allowed; end the run there and begin another, ask for \
         a larger error or a shorter time, or write the torque without jumps",
        Shown(*time)
    )]
    LongAcrossJump {
        /// What was asked for, rad.
        demand: f64,
        /// When it first jumps, s since the start.
        time: f64,
        /// Steps of a run.
        steps: f64,
        /// The most that are taken in all.
        most: f64,
    },
    /// Two runs by different methods part, and neither chaos nor a jump of the torque is why.
    #[error(
        "two runs by different methods agree to {demand:.1e} rad up to t = {} s only: their rounding does not allow more, or a force \
         changes too fast; ask for a larger error or for a time below that",
        Shown(*agree_until)
    )]
    Undecided {
        /// What was asked for, rad.
        demand: f64,
        /// Until when they agree, s.
        agree_until: f64,
    },
    /// A choice that is none of this library's methods, or that the body or the step refuses.
    #[error("{method} cannot be run: {why}")]
    Unusable {
        /// Its name.
        method: String,
        /// What was said.
        why: String,
    },
    /// The true motion is not known for another reason.
    #[error(transparent)]
    Truth(TruthError),
    /// The run of a choice failed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Everything is excluded.
    #[error("no method is left: all that can take the forces on the body are excluded")]
    NoCandidate,
}

impl AdviseError {
    /// Why a true motion is not known, where `demand` rad were asked for.
    pub(super) fn of(error: TruthError, demand: f64) -> Self {
        match error {
            TruthError::Jumps { time } => AdviseError::Jumps { demand, time },
            TruthError::LongAcrossJump { time, steps, most } => {
                AdviseError::LongAcrossJump { demand, time, steps, most }
            }
            error => error.into(),
        }
    }
}

impl From<TruthError> for AdviseError {
    fn from(error: TruthError) -> Self {
        match error {
            TruthError::State(error) => AdviseError::State(error),
            TruthError::NotFollowed(_) => AdviseError::NoReference,
            TruthError::TooLong { until, steps, reach, .. } => {
                AdviseError::TooLong { until, turn: steps, reach }
            }
            error => AdviseError::Truth(error),
        }
    }
}
