//! The derivative on the separatrix at any time: the axis comes to rest there on the upper vertical, where the spin goes on.

use std::sync::OnceLock;

use super::transition::TopDerivative;
use crate::body::Point;
use crate::flow::lagrange::LagrangeTop;
use crate::flow::lagrange::top::Motion;
use crate::flow::scaled::{FOLDS, SETTLED, Scaled};
use crate::flow::{DerivativeError, TimeError, TurnAxes};
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

impl LagrangeTop {
    /// As [`at_with_derivative`](Self::at_with_derivative), but for a sleeping top that is not stable and on its separatrix at times too at
    /// which the derivative has left the range of a double: its matrices are then to be multiplied by 2 to the power of
    /// [`exponent`](TopDerivative::exponent).
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::body::Body;
    /// use polhode::flow::{LagrangeTop, TurnAxes};
    /// use polhode::inertia::Inertia;
    /// let body = Body::heavy(Inertia::from_moments([1.0, 1.0, 0.5])?, Vector3::new(0.0, 0.0, 1.0))?;
    /// let asleep = LagrangeTop::from_omega(&body, UnitQuaternion::identity(), Vector3::new(0.0, 0.0, 2.0))?;
    /// let t = 1e6;
    /// assert!(asleep.at_with_derivative(t).is_err());
    /// let found = asleep.at_with_scaled_derivative(t)?;
    /// let e_folds = f64::from(found.exponent()) * 2_f64.ln() + found.by_momentum(TurnAxes::Space).amax().ln();
    /// assert!((e_folds - t * 0.75_f64.sqrt()).abs() < 2.0);
    /// # Ok::<(), polhode::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`at`](Self::at); an exponent beyond that of an `i32`; and a motion that starts so near to the vertical that it has not come back to
    /// it when the derivative leaves the range of a double.
    pub fn at_with_scaled_derivative(&self, t: f64) -> Result<TopDerivative, DerivativeError> {
        TimeError::check(t, self.reach())?;
        let out_of_range = DerivativeError::OutOfRange { t };
        let times = libm::ceil(self.growth() * t.abs() / FOLDS);
        if times <= 1.0 {
            return self.at_with_derivative(t);
        }
        let step = t / times;
        let asleep = self.asleep(step).ok_or(out_of_range)?;
        let first = Scaled::of(self.at_with_derivative(step)?.by_momentum(TurnAxes::Body));
        let each = Scaled::of(asleep.at_with_derivative(step)?.by_momentum(TurnAxes::Body));
        let (rows, exponent) = each.power_times(times as u64 - 1, first).rows().ok_or(out_of_range)?;
        Ok(self.scaled(&self.point_at(t), rows, exponent))
    }

    /// The rate at which changes grow for ever, 1/s; 0 off the separatrix.
    fn growth(&self) -> f64 {
        match &self.motion {
            Motion::Vertical => {
                let up = self.start.attitude.rotate_back(Vec3::unit(2))[2];
                let half = self.start.momentum_body[2] / self.transverse * 0.5;
                let square = self.weight / self.transverse - half * half;
                if up > Dd::ZERO && square > Dd::ZERO { square.sqrt().hi() } else { 0.0 }
            }
            Motion::Nutating { nutation, unit, .. } if nutation.half.is_none() => {
                nutation.rate.scaled(-unit).hi()
            }
            Motion::Nutating { .. } => 0.0,
        }
    }

    /// The sleeping top in which the motion ends, if it is there at the time `t`.
    fn asleep(&self, t: f64) -> Option<LagrangeTop> {
        let off = |q: Quat<f64>| q.v[0].abs().max(q.v[1].abs());
        let (before, after) = (off(self.along_axis(0.0).0), off(self.along_axis(t).0));
        if after > SETTLED || after > before {
            return None;
        }
        let mut asleep = self.clone();
        asleep.start = Point::new(Quat::identity(), Vec3::unit(2) * self.start.momentum_body[2]);
        asleep.motion = Motion::Vertical;
        asleep.derivative = OnceLock::new();
        Some(asleep)
    }
}
