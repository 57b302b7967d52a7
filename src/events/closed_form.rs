//! Events of motions in closed form.

use super::along::{Rates, Search, intervals};
use super::{Event, EventError, Events};
use crate::body::{Body, Point, Time};
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
            ExactMotion::Lagrange(top) => self.look(top.body(), events, [from, to, spacing]),
            ExactMotion::Gyrostat(motion) => self.look(motion.body(), events, [from, to, spacing]),
        }
    }
}

impl ExactMotion {
    fn look(&self, body: &Body, events: &[Event], span: [f64; 3]) -> Result<Events, EventError> {
        self.check_time(span[0]).and_then(|()| self.check_time(span[1]))?;
        look(body, events, span, |t| self.point_at(t))
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
