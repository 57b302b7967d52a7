//! Shift and twist of a run: what they are, and how fast they grow.

use polhode::body::Point;
use polhode::flow::FreeMotion;
use polhode::num::{Dd, Precise, Real};
use polhode::rotation::Vec3;
use polhode::run::Run;
use polhode_files::error::{Error, unexpected};

use super::{Rates, turn_in_space};

/// One look at a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    /// Time, s.
    pub(super) t: f64,
    /// Shift in time along the polhode, s.
    pub(super) shift: f64,
    /// Twist about L, rad.
    pub(super) twist: f64,
    /// Angle of the attitude error that is neither, rad.
    pub(super) rest: f64,
}

/// Looks at the steps `steps`, which ascend.
pub(super) fn looks(run: &mut Run, motion: &FreeMotion, steps: &[u64]) -> Result<Vec<Look>, Error> {
    let start = run.start().to_dd();
    let axis = start.momentum_space();
    let axis = axis * (Dd::ONE / axis.norm());
    let mut looks: Vec<Look> = Vec::new();
    for &n in steps {
        let sample = run.advance_to(n).map_err(unexpected)?;
        let t = sample.elapsed;
        // both are followed from look to look: a period more or a turn more would look the same
        let before = looks.last().map_or(Rates { shift: 0.0, twist: 0.0 }, |look| Rates {
            shift: look.shift / look.t,
            twist: look.twist / look.t,
        });
        let point = sample.point.to_dd();
        let (shift, exact) = shift(motion, &point, t, before.shift * t.hi());
        let turn = turn_in_space(exact.attitude, point.attitude);
        let along = turn.dot(axis);
        // of a turn by the vector v sin(φ/2) · 2 and the cosine w: the part about L is 2 atan2(v·L, w)
        let w = (point.attitude * exact.attitude.conjugate()).w.abs();
        let wrapped = 2.0 * libm::atan2(0.5 * along.hi(), w.hi());
        let turns = libm::round((before.twist * t.hi() - wrapped) / core::f64::consts::TAU);
        looks.push(Look {
            t: t.hi(),
            shift,
            twist: wrapped + core::f64::consts::TAU * turns,
            rest: (turn - axis * along).norm().hi(),
        });
    }
    Ok(looks)
}

/// The τ next to `guess` at which the exact momentum of the time t + τ is nearest to that of `point`, and the exact point.
fn shift(motion: &FreeMotion, point: &Point<Dd>, t: Dd, guess: f64) -> (f64, Point<Dd>) {
    let inverse: Vec3<Dd> = motion.body().rotor().inverse_moments();
    let mut shift = Dd::of(guess);
    let mut exact = motion.point_at_dd(t + shift);
    for _ in 0..8 {
        let speed = exact.momentum_body.cross(exact.momentum_body.times(inverse));
        let change = (point.momentum_body - exact.momentum_body).dot(speed) / speed.norm_squared();
        shift = shift + change;
        exact = motion.point_at_dd(t + shift);
        if change.abs().hi() <= 1e-13 * shift.abs().hi() {
            break;
        }
    }
    (shift.hi(), exact)
}

/// The slopes of straight lines through shift and twist against time.
pub(super) fn rates(looks: &[Look]) -> Rates {
    let slope = |value: fn(&Look) -> f64| {
        let count = looks.len() as f64;
        let mean = |of: &dyn Fn(&Look) -> f64| looks.iter().map(of).sum::<f64>() / count;
        let (t, v) = (mean(&|look| look.t), mean(&value));
        let covariance = mean(&|look| (look.t - t) * (value(look) - v));
        covariance / mean(&|look| (look.t - t) * (look.t - t))
    };
    Rates { shift: slope(|look| look.shift), twist: slope(|look| look.twist) }
}
