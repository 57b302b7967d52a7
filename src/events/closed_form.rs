//! Events of motions in closed form.

use super::along::{Rates, Search, intervals};
use super::{Event, EventError, Events};
use crate::body::{Body, Point, Time};
use crate::flow::{ExactMotion, FreeMotion, TimeError};
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
        let (found, ended) = self.events_so_far(events, from, to, spacing);
        ended.map(|()| found)
    }

    /// As [`events`](Self::events): what happened, also before the error that ended the search, and that error.
    pub fn events_so_far(
        &self,
        events: &[Event],
        from: f64,
        to: f64,
        spacing: f64,
    ) -> (Events, Result<(), EventError>) {
        let checked = self.check_time(from).and_then(|()| self.check_time(to));
        found(self.body(), events, [from, to, spacing], checked, |t| self.point_after(t))
    }
}

impl ExactMotion {
    /// As [`FreeMotion::events`].
    ///
    /// # Errors
    /// As [`FreeMotion::events`].
    pub fn events(&self, events: &[Event], from: f64, to: f64, spacing: f64) -> Result<Events, EventError> {
        let (found, ended) = self.events_so_far(events, from, to, spacing);
        ended.map(|()| found)
    }

    /// As [`FreeMotion::events_so_far`].
    pub fn events_so_far(
        &self,
        events: &[Event],
        from: f64,
        to: f64,
        spacing: f64,
    ) -> (Events, Result<(), EventError>) {
        let body = match self {
            ExactMotion::Free(motion) => motion.body(),
            ExactMotion::Lagrange(top) => top.body(),
            ExactMotion::Gyrostat(motion) => motion.body(),
        };
        let checked = self.check_time(from).and_then(|()| self.check_time(to));
        found(body, events, [from, to, spacing], checked, |t| self.point_at(t))
    }
}

/// What happens to the `point` of `body`, where its times are `checked`, and why the search ended early.
fn found(
    body: &Body,
    events: &[Event],
    span: [f64; 3],
    checked: Result<(), TimeError>,
    point: impl Fn(Dd) -> Point<f64>,
) -> (Events, Result<(), EventError>) {
    let mut search = Search::new(events, None);
    let ended = match checked {
        Ok(()) => look(&mut search, body, events, span, point),
        Err(error) => Err(error.into()),
    };
    (search.finish(span[2]), ended)
}

fn look<'a>(
    search: &mut Search<'a>,
    body: &Body,
    events: &'a [Event],
    [from, to, spacing]: [f64; 3],
    point: impl Fn(Dd) -> Point<f64>,
) -> Result<(), EventError> {
    let looks = intervals(from, to, spacing)?;
    let start = point(Dd::from(from));
    *search = Search::new(events, Some(rates(body, &start)));
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
    Ok(())
}

/// What a body with the energy of the point `x` turns by and accelerates by at most, without or with uniform gravity or wheels.
fn rates(body: &Body, x: &Point<f64>) -> Rates {
    let inverse = body.rotor().inverse_moments::<f64>();
    let (largest, least) =
        (inverse.0.into_iter().fold(0.0, f64::max), inverse.0.into_iter().fold(f64::MAX, f64::min));
    let m = x.momentum_body;
    let weight = body.linear_potential::<f64>().map_or(0.0, |linear| linear.moment.norm());
    // |m|²/2 times the least of 1/I is at most T, and T at most what it is now and what gravity gives
    let kinetic = 0.5 * m.times(inverse).dot(m) + 2.0 * weight;
    let wheels = body.momentum_of_wheels().map(|wheels| wheels.at(Time::from_seconds(0.0)).map(Dd::hi));
    let momentum = match wheels {
        // that of body and wheels, which is constant, and I ω' = m × ω
        Some(wheels) => (m + wheels).norm(),
        None if weight == 0.0 => m.norm(),
        None => (2.0 * kinetic / least).sqrt(),
    };
    let moves_freely = weight == 0.0 && wheels.is_none();
    let speed = if moves_freely { momentum * largest } else { (2.0 * kinetic * largest).sqrt() };
    // bounds, not estimates: with room for rounding
    let room = 1.0 + 1e-9;
    Rates { speed: speed * room, acceleration: (momentum * speed + weight) * largest * room }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inertia::Inertia;

    /// A free body, and a top that swings through small momenta, whose direction then turns fast.
    #[test]
    fn no_event_changes_faster_than_its_bound() {
        let moments = |moments| Inertia::from_moments(moments).unwrap();
        let top = Body::heavy(moments([1.0, 1.0, 0.25]), [0.0, 0.0, 2.0].into()).unwrap();
        for (body, omega) in [
            (Body::free(moments([1.0, 2.0, 3.0])), [0.4, 1.0, -0.3]),
            (top.clone(), [0.0, 0.3, 0.01]),
            (top, [0.1, 0.2, 20.0]),
        ] {
            let tilted = nalgebra::UnitQuaternion::from_euler_angles(0.3, -0.5, 1.1);
            let motion = ExactMotion::new(&body, &body.state(tilted, omega.into()).unwrap()).unwrap();
            let events = [
                Event::flip(&body),
                Event::enters_cone([0.6, 0.0, 0.8].into(), [0.0, 0.0, 1.0].into(), 1.0).unwrap(),
                Event::rate_above(&body, 0.9).unwrap(),
            ];
            let point = |t: f64| motion.point_at(Dd::from(t));
            let bounds = Search::new(&events, Some(rates(&body, &point(0.0)))).bounds;
            let (step, mut most) = (1.0 / 1024.0, [0.0_f64; 3]);
            for k in 0..20_000 {
                let [before, after] = [k, k + 1].map(|k| body.leave(&point(f64::from(k) * step)));
                for (most, event) in most.iter_mut().zip(&events) {
                    *most = most.max((event.value(0.0, &after) - event.value(0.0, &before)).abs() / step);
                }
            }
            for ((most, bound), event) in most.into_iter().zip(bounds).zip(&events) {
                let bound = bound.unwrap();
                assert!(most <= bound && most > 0.0, "{event:?}: {most} of {bound}");
            }
        }
    }
}
