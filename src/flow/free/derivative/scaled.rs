//! The derivative on the separatrix at any time: a motion ends there as a steady spin about the middle axis.

use super::transition::StateDerivative;
use crate::body::Point;
use crate::flow::scaled::{FOLDS, SETTLED, Scaled};
use crate::flow::{DerivativeError, FreeMotion, TurnAxes};
use crate::num::Dd;
use crate::rotation::{Quat, Vec3};

impl FreeMotion {
    /// As [`at_with_derivative`](Self::at_with_derivative), but on the separatrix at times too at which the derivative has left the range of
    /// a double: its matrices are then to be multiplied by 2 to the power of [`exponent`](StateDerivative::exponent).
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::flow::{FreeMotion, TurnAxes};
    /// use polhode::inertia::Inertia;
    /// let racket = Inertia::from_moments([1.0, 2.0, 3.0])?;
    /// let spin = FreeMotion::from_omega(&racket, UnitQuaternion::identity(), Vector3::new(0.0, 1.0, 0.0))?;
    /// let t = 1e6;
    /// assert!(spin.at_with_derivative(t).is_err());
    /// let found = spin.at_with_scaled_derivative(t)?;
    /// let e_folds = f64::from(found.exponent()) * 2_f64.ln() + found.by_momentum(TurnAxes::Space).amax().ln();
    /// assert!((e_folds - t / 3_f64.sqrt()).abs() < 2.0);
    /// # Ok::<(), polhode::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`at`](Self::at); an exponent beyond that of an `i32`; and a motion that starts so near to the middle axis that it has not come back to
    /// it when the derivative leaves the range of a double.
    pub fn at_with_scaled_derivative(&self, t: f64) -> Result<StateDerivative, DerivativeError> {
        self.check_time(t)?;
        let out_of_range = DerivativeError::OutOfRange { t };
        let times = libm::ceil(self.derivative().folds(t) / FOLDS);
        if times <= 1.0 {
            return self.at_with_derivative(t);
        }
        let step = t / times;
        let spin = self.final_spin(step).ok_or(out_of_range)?;
        let first = Scaled::of(self.at_with_derivative(step)?.by_momentum(TurnAxes::Body));
        let each = Scaled::of(spin.at_with_derivative(step)?.by_momentum(TurnAxes::Body));
        let (rows, exponent) = each.power_times(times as u64 - 1, first).rows().ok_or(out_of_range)?;
        let columns = rows.fixed_columns::<9>(3).into_owned();
        let found = self.derivative().scaled(self.body(), &self.point_at(t), columns, exponent);
        found.ok_or(out_of_range)
    }

    /// The spin about the middle axis in which the motion ends, if it is there at the time `t`.
    fn final_spin(&self, t: f64) -> Option<FreeMotion> {
        let middle = self.body().rotor().moments::<Dd>().ascending()[1];
        let off = |m: Vec3<f64>| {
            let mut across = m;
            across[middle] = 0.0;
            across.magnitude() / m.magnitude()
        };
        let (start, there) = (self.point_at_dd(Dd::ZERO).momentum_body, self.point_at(t).momentum_body);
        let (before, after) = (off(start.map(Dd::hi)), off(there));
        if after > SETTLED || after > before {
            return None;
        }
        let size = if there[middle] < 0.0 { -start.norm() } else { start.norm() };
        let point = Point::new(Quat::identity(), Vec3::unit(middle) * size);
        Some(FreeMotion::from_point(self.body().inertia(), point))
    }
}
