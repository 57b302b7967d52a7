//! A table of attitudes, and the free motions that lead from each to the next.

use nalgebra::{UnitQuaternion, Vector3};

use super::passages::{Passage, ThroughError};
use crate::body::State;
use crate::flow::TimeError;
use crate::flow::free::FreeMotion;
use crate::inertia::Inertia;
use crate::rotation::{Quat, rotation_angle};

/// The exact motion between the attitudes of a table: from each to the next the free motion through both.
///
/// Where several motions lead from one attitude to the next, those are taken whose angular velocities fit together best: the sum of the
/// squares of the jumps at the attitudes is least. Of a free body they are all one motion.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::flow::{FreeMotion, Interpolation};
/// use polhode::inertia::Inertia;
/// let body = Inertia::from_moments([1.0, 2.0, 3.0])?;
/// let motion = FreeMotion::from_omega(&body, UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let table: Result<Vec<_>, _> = [0.0, 2.0, 4.0, 6.0].map(|t| Ok((t, motion.at(t)?.rotation()))).into_iter().collect();
/// let between = Interpolation::new(&body, &table.map_err(|error: polhode::flow::TimeError| error)?, 1.0)?;
/// let (state, slerp_error) = between.at(3.0)?;
/// assert!(state.rotation().angle_to(&motion.at(3.0)?.rotation()) < 1e-13);
/// assert!(slerp_error > 0.1); // rad
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Debug)]
#[must_use]
pub struct Interpolation {
    table: Vec<(f64, UnitQuaternion<f64>)>,
    pieces: Vec<Passage>,
}

impl Interpolation {
    /// Through the attitudes of `table`, whose times ascend, with at most `turns` turns between two of them.
    ///
    /// # Errors
    /// Fewer than two attitudes, times that do not ascend, and as [`FreeMotion::through`] between any two.
    pub fn new(
        inertia: &Inertia,
        table: &[(f64, UnitQuaternion<f64>)],
        turns: f64,
    ) -> Result<Self, ThroughError> {
        if table.len() < 2 {
            return Err(ThroughError::TooFew { attitudes: table.len() });
        }
        let mut choices = Vec::with_capacity(table.len() - 1);
        for pair in table.windows(2) {
            let (first, second) = (pair[0], pair[1]);
            if first.0 > second.0 {
                return Err(ThroughError::NotAscending { before: first.0, after: second.0 });
            }
            let mut found = FreeMotion::through(inertia, first, second, turns)?;
            let time = second.0 - first.0;
            let ends = |passage: Passage| {
                let end = passage.motion.omega_at(time).unwrap_or(passage.omega_body);
                Choice { end, passage }
            };
            found.list.sort_by(|a, b| a.turns.total_cmp(&b.turns));
            choices.push(found.list.into_iter().map(ends).collect::<Vec<_>>());
        }
        Ok(Interpolation { table: table.to_vec(), pieces: smoothest(choices) })
    }

    /// The first and the last time, s.
    #[must_use]
    pub fn span(&self) -> [f64; 2] {
        [self.table[0].0, self.table[self.table.len() - 1].0]
    }

    /// The motions from each attitude to the next.
    pub fn pieces(&self) -> &[Passage] {
        &self.pieces
    }

    /// The largest jump of the angular velocity at an attitude, rad/s: rounding where the body is free.
    #[must_use]
    pub fn largest_jump(&self) -> f64 {
        let jump = |n: usize| {
            let end = self.pieces[n].motion.omega_at(self.table[n + 1].0 - self.table[n].0);
            end.map_or(f64::INFINITY, |end| (self.pieces[n + 1].omega_body - end).norm())
        };
        (0..self.pieces.len().saturating_sub(1)).map(jump).fold(0.0, f64::max)
    }

    /// The state at the time `t` (s), and the angle (rad) by which the attitude of spherical linear interpolation (slerp) is off there.
    ///
    /// # Errors
    /// A time that is not between the first and the last.
    pub fn at(&self, t: f64) -> Result<(State, f64), ThroughError> {
        let [first, last] = self.span();
        if !(first..=last).contains(&t) {
            return Err(ThroughError::Outside { t, first, last });
        }
        let after = self.table.partition_point(|(time, _)| *time <= t);
        let n = after.clamp(1, self.pieces.len()) - 1;
        let ((t0, q0), (t1, q1)) = (self.table[n], self.table[n + 1]);
        let outside = |_: TimeError| ThroughError::Outside { t, first, last };
        let state = self.pieces[n].motion.at(t - t0).map_err(outside)?;
        let share = (t - t0) / (t1 - t0);
        let (q0, q1): (Quat<f64>, Quat<f64>) = (q0.into(), q1.into());
        let slerp = q0 * Quat::exponential((q0.conjugate() * q1).logarithm() * share);
        Ok((state, rotation_angle(slerp, state.attitude)))
    }
}

/// One way from an attitude to the next, with the angular velocity at its end.
struct Choice {
    passage: Passage,
    end: Vector3<f64>,
}

/// One choice of each step, so that the squares of the jumps between them add up to least; with equal sums that of fewer turns.
fn smoothest(steps: Vec<Vec<Choice>>) -> Vec<Passage> {
    // by dynamic programming: the best sum that ends with each choice, and where it came from
    let mut sums: Vec<f64> = steps.first().map_or_else(Vec::new, |first| vec![0.0; first.len()]);
    let mut origins: Vec<Vec<usize>> = Vec::new();
    for pair in steps.windows(2) {
        let best = |choice: &Choice| {
            let total = |(n, before): (usize, &Choice)| {
                (n, sums[n] + (choice.passage.omega_body - before.end).norm_squared())
            };
            pair[0].iter().enumerate().map(total).min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0))
        };
        let (from, next): (Vec<usize>, Vec<f64>) = pair[1].iter().map(best).unzip();
        origins.push(from);
        sums = next;
    }
    let least = sums.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1));
    let mut places = vec![least.map_or(0, |(n, _)| n)];
    for from in origins.iter().rev() {
        places.push(from[places[places.len() - 1]]);
    }
    places.reverse();
    steps
        .into_iter()
        .zip(places)
        .filter_map(|(step, n)| step.into_iter().nth(n))
        .map(|choice| choice.passage)
        .collect()
}
