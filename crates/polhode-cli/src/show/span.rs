//! How long a motion is shown where no end is given.

use polhode::body::{Body, Point, Problem};
use polhode::flow::{FreeMotion, GyrostatMotion};
use polhode::num::Dd;
use polhode_files::error::Error;

/// A body is shown for so many turns at least, and at most.
const TURNS: [f64; 2] = [12.0, 150.0];
/// A free body for so many rounds of its polhode, two flips each where it flips; a top for so many turns, of which a precession
/// takes many.
const ROUNDS: f64 = 3.0;
const TURNS_OF_A_TOP: f64 = 100.0;

/// s: long enough to see how the body moves from its start.
pub(super) fn span(body: &Body, start: &Point<Dd>) -> Result<f64, Error> {
    let rate = body.omega_of(start).norm();
    let swing = body.linear_potential::<f64>().map_or(0.0, |weight| {
        // moments and weight moment of the solver frame have the same scale
        let most = body.rotor().moments::<f64>().0.into_iter().fold(0.0, f64::max);
        libm::sqrt(weight.moment.norm() / most)
    });
    let rate = rate.max(swing);
    let is_free = body.problem() == Problem::Free;
    if rate == 0.0 {
        if is_free {
            return Ok(1.0);
        }
        let rule = "missing: how fast the body will turn from rest is not known";
        return Err(Error::input("--until", "", rule, "give the end, s"));
    }
    let turn = core::f64::consts::TAU / rate;
    if let Ok(motion) = GyrostatMotion::from_point(body, *start) {
        let period = motion.character().period.unwrap_or(turn);
        return Ok(two_digits((ROUNDS * period).max(TURNS[0] * turn)));
    }
    let [least, most] = TURNS.map(|turns| turns * turn);
    if !is_free {
        return Ok(two_digits(TURNS_OF_A_TOP * turn));
    }
    let motion = FreeMotion::from_point(body.inertia(), *start);
    let period = motion.character().ok().and_then(|found| found.polhode_period).unwrap_or(0.0);
    Ok(two_digits((ROUNDS * period).clamp(least, most)))
}

pub(super) fn two_digits(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
}
