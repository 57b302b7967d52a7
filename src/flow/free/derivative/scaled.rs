//! The derivative on the separatrix at any time, with a power of two beside it.
//!
//! On the separatrix a motion ends as a steady spin about the middle axis. From there the derivative over a time is the same each time, in axes of
//! the body: over n times it is the n-th power, which repeated squares give.

use nalgebra::SMatrix;

use super::transition::StateDerivative;
use crate::body::Point;
use crate::flow::{DerivativeError, FreeMotion, TurnAxes};
use crate::num::Dd;
use crate::rotation::{Quat, Vec3};

/// Most e-folds of growth in one time; half of them bring the motion to the spin.
const FOLDS: f64 = 256.0;

/// Of rotation vector, momentum and tensor, times 2^exponent.
#[derive(Clone, Copy)]
struct Scaled {
    matrix: SMatrix<f64, 12, 12>,
    exponent: i64,
}

/// Angle from the middle axis, as a share, below which no digit of a double-double tells the motion from the spin about it.
const SETTLED: f64 = 1e-40;

impl Scaled {
    fn of(derivative: &StateDerivative) -> Self {
        let mut matrix = SMatrix::<f64, 12, 12>::identity();
        matrix.fixed_view_mut::<6, 12>(0, 0).copy_from(&derivative.by_momentum(TurnAxes::Body));
        Scaled { matrix, exponent: 0 }
    }

    fn times(&self, first: &Scaled) -> Self {
        let product = self.matrix * first.matrix;
        let by = libm::ilogb(product.amax());
        Scaled {
            matrix: product.map(|x| libm::scalbn(x, -by)),
            exponent: self.exponent + first.exponent + i64::from(by),
        }
    }

    /// `self` to the `n`-th times `first`.
    fn power_times(mut self, mut n: u64, mut first: Scaled) -> Self {
        while n > 0 {
            if n % 2 == 1 {
                first = self.times(&first);
            }
            self = self.times(&self);
            n /= 2;
        }
        first
    }
}

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
        let first = Scaled::of(&self.at_with_derivative(step)?);
        let each = Scaled::of(&spin.at_with_derivative(step)?);
        let all = each.power_times(times as u64 - 1, first);
        let exponent = i32::try_from(all.exponent).map_err(|_| out_of_range)?;
        let matrix = all.matrix.fixed_view::<6, 9>(0, 3).into_owned();
        let found = self.derivative().scaled(self.body(), &self.point_at(t), matrix, exponent);
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
