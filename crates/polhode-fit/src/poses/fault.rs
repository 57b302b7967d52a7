//! Why a fit to attitudes is refused.

use core::f64::consts::TAU;

use polhode::num::Shown;
use thiserror::Error;

use crate::error::UNSTATED;
use crate::thresholds::poses::{HALF_TURN, STILL};

/// Why a fit to attitudes is refused.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PoseFault {
    /// Nearly half a turn, or more, from one attitude to the next.
    #[error(
        "from sample {} of {source_name}, at {} s, to the next that is used, {step:.3e} s later, the attitude turns by {turn:.3} rad, or the \
         other way round by {:.3} rad; the rate would be {:.3e} or {:.3e} rad/s. To distinguish the two, record {:.3e} attitudes a second or \
         more; or leave the sample out if it is wrong",
        sample, Shown(*time), TAU - turn, turn / step, (TAU - turn) / step, (TAU - turn) / step / HALF_TURN
    )]
    HalfTurn {
        /// Where they come from.
        source_name: String,
        /// The first of the two, from 1, of all that were given.
        sample: usize,
        /// Its time, s.
        time: f64,
        /// The shorter turn, rad.
        turn: f64,
        /// Time between the two, s.
        step: f64,
    },
    /// The body does not turn.
    #[error(
        "the attitudes change by {turn:.2e} rad in all, and their noise is {noise:.2e} rad: the body hardly turns; let it turn by more than \
         {:.2e} rad", STILL * *noise
    )]
    NoTurn {
        /// Root mean square of the turn of an attitude from the first, rad.
        turn: f64,
        /// Noise of a component, rad.
        noise: f64,
    },
    /// The body turns so far from one attitude to the next that its motion looks like noise.
    #[error(
        "from one attitude to the next the body turns by up to {turn:.2} rad, and by {all:.2} rad in all: attitudes so far apart show neither \
         its motion nor their noise; record faster, or state their noise"
    )]
    FarApart {
        /// Largest turn from one attitude to the next, rad.
        turn: f64,
        /// Root mean square of the turn of an attitude from the first, rad.
        all: f64,
    },
    /// The attitudes would differ by their noise alone as it is stated, and not as neighbours show it.
    #[error(
        "the stated noise of the attitudes is {stated:.2e} rad, and neighbouring attitudes show {shown:.2e} rad; the body turns too little for \
         the stated noise: {}",
        UNSTATED
    )]
    StatedNoise {
        /// Noise of a component as it is stated, rad.
        stated: f64,
        /// The same as neighbouring attitudes show it, rad.
        shown: f64,
    },
    /// No motion of any body follows the attitudes, under no torque that a fit has a model of.
    #[error(
        "no free motion follows the attitudes, nor one with drag, a constant torque or small torque noise: the nearest one leaves residuals of \
         {residual:.2e} rad (root mean square of a component){}. Torques act, or a frame or a sequence of angles is read wrongly, or the body \
         makes more than half a turn between samples ({turn:.2} rad as read); throw the body, fit only the part of the record in which it is \
         free, or record faster",
        noise.map_or(String::new(), |noise| format!(", where their noise is {noise:.2e} rad"))
    )]
    NotFree {
        /// Root mean square of what is left of a component, rad; a radian or more where no motion was found.
        residual: f64,
        /// Noise of a component, where it is known, rad.
        noise: Option<f64>,
        /// Largest turn from one attitude to the next, rad.
        turn: f64,
    },
    /// The likelihood tells no tensor: the search for its maximum did not end, or ended so far from all bodies that their likelihood is
    /// not foreseen.
    #[error(
        "bodies with very different moments follow the samples nearly as well, as near a steady spin, and the search for the likeliest of them \
         did not converge; throw the body with a larger wobble, or record longer"
    )]
    Unsettled,
    /// Both directions explain the attitudes.
    #[error(
        "the motion does not show whether the attitudes are body to space or space to body: with body to space I1 : I2 : I3 = {}, with space \
         to body {} (log-likelihood {} by {gain:.1}). The body may be axisymmetric; state the direction",
        three(as_read), three(inverse), if *gain >= 0.0 { "of the first higher" } else { "of the second higher" }, gain = gain.abs()
    )]
    Direction {
        /// Principal moments as shares of the trace, read as body axes → space.
        as_read: [f64; 3],
        /// The same of the inverse.
        inverse: [f64; 3],
        /// Log-likelihood of the first less that of the second.
        gain: f64,
    },
    /// The inverse direction explains the attitudes, and that in which they were read does not.
    #[error(
        "the attitudes look inverted: their inverses are those of a free body with I1 : I2 : I3 = {} (log-likelihood higher by {gain:.0}), while \
         no free body has them as they were read; state the other direction",
        three(inverse)
    )]
    Inverted {
        /// Principal moments of the inverse, as shares of the trace.
        inverse: [f64; 3],
        /// Its gain of log-likelihood.
        gain: f64,
    },
    /// The rates beside the attitudes are their mirror image.
    #[error(
        "the rates turn in the direction opposite to that of the attitudes: check for a mirrored axis of either, and for attitudes in the wrong \
         direction (body to space or space to body)"
    )]
    Mirrored,
    /// The rates beside the attitudes have another size.
    #[error(
        "the rates are {scale:.4} times those of the attitudes: the units of rates, times or angles are probably mistaken; check them"
    )]
    Scale {
        /// Root mean square of the rates over that of the attitudes.
        scale: f64,
    },
    /// A torque that a fit of attitudes with rates beside them has no model of.
    #[error(
        "a fit of rates and attitudes includes drag in proportion to the momentum or a small constant torque, and no other torque; ask for one \
         of these, or fit the attitudes or the rates alone"
    )]
    Torque,
    /// A setting that only a fit of rates has.
    #[error("{name} has no meaning for a fit of attitudes; leave it out, or fit the rates alone")]
    OnlyRates {
        /// Which one.
        name: &'static str,
    },
}

fn three([a, b, c]: &[f64; 3]) -> String {
    format!("{} : {} : {}", four(*a), four(*b), four(*c))
}

fn four(x: f64) -> Shown {
    Shown(format!("{x:.4}").parse().unwrap_or(x))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rates both ways round, how much the body must turn, and how many attitudes a second would tell follow from the numbers.
    #[test]
    fn faults_of_attitudes_say_their_numbers() {
        let says = |fault: PoseFault, parts: &[&str]| {
            let text = fault.to_string();
            assert!(parts.iter().all(|part| text.contains(part)), "{text}: {parts:?}");
        };
        let half =
            PoseFault::HalfTurn { source_name: "a.csv".into(), sample: 7, time: 12.25, turn: 3.0, step: 0.5 };
        // 2 π − 3 = 3.28319, over 0.5 and that over 2.83
        says(
            half,
            &[
                "sample 7 of a.csv, at 12.25 s, to",
                "5.000e-1 s later",
                "3.283 rad",
                "6.000e0 or 6.566e0",
                "2.320e0 attitudes",
            ],
        );
        says(PoseFault::NoTurn { turn: 0.02, noise: 0.01 }, &["2.00e-2 rad in all", "more than 5.00e-2 rad"]);
        says(PoseFault::FarApart { turn: 2.125, all: 2.25 }, &["up to 2.12 rad", "by 2.25 rad in all"]);
        let not_free = |noise| PoseFault::NotFree { residual: 0.04, noise, turn: 1.5 };
        says(not_free(Some(0.01)), &["4.00e-2 rad (root", "noise is 1.00e-2 rad", "(1.50 rad as read)"]);
        assert!(!not_free(None).to_string().contains("their noise"));
        let (as_read, inverse) = ([0.2, 0.3, 0.5], [0.1, 0.4, 0.5]);
        let direction = |gain| PoseFault::Direction { as_read, inverse, gain };
        says(direction(3.0), &["0.2 : 0.3 : 0.5", "body 0.1 : 0.4 : 0.5", "of the first higher by 3.0"]);
        says(direction(-3.0), &["of the second higher by 3.0"]);
        says(PoseFault::Inverted { inverse: [0.12348, 0.4, 0.5], gain: 120.4 }, &["0.1235 : 0.4", "by 120)"]);
        says(PoseFault::Scale { scale: 1.5 }, &["1.5000 times"]);
    }
}
