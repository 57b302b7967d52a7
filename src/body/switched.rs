//! Forces that act during some intervals only.

use std::sync::Arc;

use super::law::{Evaluated, Law, SeriesLaw};
use super::{Body, Force, ForceError, Time, Torque, Wheel};
use crate::rotation::{Quat, Vec3};

/// When a force acts, and its law then.
#[derive(Clone)]
pub(super) struct Switched {
    /// Ascending; from is in, to is not.
    intervals: Arc<[[f64; 2]]>,
    law: Law,
    series: Option<SeriesLaw>,
}

impl Switched {
    /// Whether it acts just after the time `t`, s, or just before it.
    fn acts(&self, t: f64, after: bool) -> bool {
        let begun = self.intervals.partition_point(|i| if after { i[0] <= t } else { i[0] < t });
        begun > 0 && if after { t < self.intervals[begun - 1][1] } else { t <= self.intervals[begun - 1][1] }
    }
}

impl<S: Evaluated> Torque<S> for Switched {
    fn torque(&self, at: Time, attitude: Quat<S>, omega_body: Vec3<S>) -> Vec3<S> {
        if self.acts(at.seconds(), true) {
            S::torque(&self.law, at, attitude, omega_body)
        } else {
            Vec3::zero()
        }
    }
}

impl Force {
    /// The same force, acting only during `intervals` \[from, to), s, which ascend. A potential becomes a torque by this: it
    /// conserves nothing, and its energy is not counted.
    ///
    /// The steps of a [`Run`](crate::Run) end where forces are switched: a step of the run is divided there, and each part is
    /// a step of the method in a smooth field. So its order is kept, and methods that choose their steps lose none.
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use polhode::body::{Body, Force};
    /// use polhode::{Inertia, Run, method};
    /// let burns = [[0.1, 1.3], [2.0, 2.7]];
    /// let thruster = Force::constant_torque_body(Vector3::new(0.0, 0.0, 0.5))?.during(burns)?;
    /// let body = Body::free(Inertia::from_moments([1.0, 1.0, 2.0])?).with(thruster);
    /// let start = body.state(Default::default(), Vector3::zeros())?;
    /// let end = Run::new(&method("rk4")?, &body, &start, 0.5)?.advance_to(8)?;
    /// assert!((end.omega_body.z - 0.25 * 1.9).abs() < 1e-15); // 1.9 s of burning
    /// # Ok::<(), polhode::Error>(())
    /// ```
    ///
    /// # Errors
    /// An interval that does not begin after the one before, or does not end after its beginning. It may last for ever.
    pub fn during(self, intervals: impl IntoIterator<Item = [f64; 2]>) -> Result<Self, ForceError> {
        let intervals: Arc<[[f64; 2]]> = intervals.into_iter().collect();
        let mut before = f64::NEG_INFINITY;
        for &[from, to] in intervals.iter() {
            // a NaN is no bound either
            if !(before <= from && from < to) {
                return Err(ForceError::Interval { from, to, before });
            }
            before = to;
        }
        Ok(self.switched(intervals))
    }

    fn switched(self, intervals: Arc<[[f64; 2]]>) -> Self {
        let acting = self.unswitched();
        let switched = Switched { intervals, law: acting.law, series: acting.series };
        let law = Law::Torque(Arc::new(switched.clone()));
        Force { law, series: None, switched: Some(switched), ..self }
    }

    /// The same force, acting always.
    fn unswitched(&self) -> Self {
        let force = self.clone();
        match &self.switched {
            None => force,
            Some(Switched { law, series, .. }) => {
                Force { law: law.clone(), series: series.clone(), switched: None, ..force }
            }
        }
    }

    /// `acting` during the intervals of this force.
    pub(super) fn switch(&self, acting: Force) -> Force {
        match &self.switched {
            None => acting,
            Some(switched) => acting.switched(Arc::clone(&switched.intervals)),
        }
    }

    /// The intervals during which it acts, s; `None` of a force that acts always.
    #[must_use]
    pub fn intervals(&self) -> Option<&[[f64; 2]]> {
        self.switched.as_ref().map(|switched| &*switched.intervals)
    }
}

impl Body {
    /// When its forces and the motors of its wheels are switched on or off, s, ascending.
    #[must_use]
    pub fn switching_times(&self) -> Vec<f64> {
        let intervals = self.forces().iter().filter_map(Force::intervals).flatten().flatten().copied();
        let motors = self.wheels().iter().flat_map(Wheel::switching_times);
        let mut times: Vec<f64> = intervals.chain(motors).filter(|t| t.is_finite()).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// The body with the forces and motors alone that act just after the time `t`, s, or just before it, and which are not switched.
    pub(crate) fn acting(&self, t: f64, after: bool) -> Body {
        let acts = |force: &Force| force.switched.as_ref().is_none_or(|switched| switched.acts(t, after));
        self.changed(|wheel| wheel.acting(t, after), |force| acts(force).then(|| force.unswitched()))
    }
}
