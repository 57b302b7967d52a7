//! Events of motions in closed form.

use super::along::{Rates, Search, intervals};
use super::{Event, EventError, Events};
use crate::body::Body;
use crate::body::Point;
use crate::flow::{ExactMotion, FreeMotion};
use crate::num::Dd;

impl FreeMotion {
    /// What happens from `from` to `to`, s, of `events`, with a look each `spacing` s; also far away, where a look costs no more.
    ///
    /// Of events with a bounded rate none is missed between looks. See [`events`](crate::events).
    ///
    /// # Errors
    /// Times beyond [`reach`](Self::reach), an end before the beginning, a spacing that is not positive or leads to more than
    /// 1e10 looks; a function that is no number, jumps, or changes faster than it was said to.
    pub fn events(&self, events: &[Event], from: f64, to: f64, spacing: f64) -> Result<Events, EventError> {
        self.check_time(from).and_then(|()| self.check_time(to))?;
        look(self.body(), events, [from, to, spacing], |t| self.point_after(t))
    }
}

impl ExactMotion {
    /// As [`FreeMotion::events`].
    ///
    /// # Errors
    /// As [`FreeMotion::events`].
    pub fn events(&self, events: &[Event], from: f64, to: f64, spacing: f64) -> Result<Events, EventError> {
        match self {
            ExactMotion::Free(motion) => motion.events(events, from, to, spacing),
            ExactMotion::Lagrange(top) => {
                self.check_time(from).and_then(|()| self.check_time(to))?;
                look(top.body(), events, [from, to, spacing], |t| self.point_at(t))
            }
        }
    }
}

fn look(
    body: &Body,
    events: &[Event],
    [from, to, spacing]: [f64; 3],
    point: impl Fn(Dd) -> Point<f64>,
) -> Result<Events, EventError> {
    let looks = intervals(from, to, spacing)?;
    let start = point(Dd::from(from));
    let mut search = Search::new(events, Some(rates(body, &start)));
    let mut states = |t: Dd| Ok::<_, EventError>(body.leave(&point(t)));
    search.begin::<EventError>(Dd::from(from), &body.leave(&start))?;
    for k in 1..=looks {
        if search.has_ended() {
            break;
        }
        let time = if k < looks { Dd::from(from) + Dd::product(k as f64, spacing) } else { Dd::from(to) };
        let state = states(time)?;
        search.go_on(time, &state, &mut states)?;
    }
    Ok(search.finish(spacing))
}

/// What a body with the energy of the point `x` turns by and accelerates by at most, without or with uniform gravity.
fn rates(body: &Body, x: &Point<f64>) -> Rates {
    let inverse = body.rotor().inverse_moments::<f64>();
    let (largest, least) =
        (inverse.0.into_iter().fold(0.0, f64::max), inverse.0.into_iter().fold(f64::MAX, f64::min));
    let m = x.momentum_body;
    let weight = body.linear_potential::<f64>().map_or(0.0, |linear| linear.moment.norm());
    // |m|²/2 times the least of 1/I is at most T, and T at most what it is now and what gravity gives
    let kinetic = 0.5 * m.times(inverse).dot(m) + 2.0 * weight;
    let momentum = if weight == 0.0 { m.norm() } else { (2.0 * kinetic / least).sqrt() };
    let speed = if weight == 0.0 { momentum * largest } else { (2.0 * kinetic * largest).sqrt() };
    // bounds, not estimates: with room for rounding
    let room = 1.0 + 1e-9;
    Rates { speed: speed * room, acceleration: (momentum * speed + weight) * largest * room }
}
