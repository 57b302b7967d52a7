//! The motion from one sample to the next, with its derivatives and what torque noise does on the way.

use nalgebra::{Matrix3, SMatrix, Vector3};
use polhode::rotation::Quat;

use crate::columns::column::{Column, Unknowns, terms_of_all};
use crate::likelihood::motion::Start;
use crate::physical::coordinates::{basis, tensor};
use crate::signal::terms::Terms;
use crate::thresholds::smoothed::{PARTS, STEP};

/// Numbers that all stretches share: the coordinates of the tensor and at most three coefficients of a torque.
pub(crate) const SHARED: usize = 8;
/// Those and attitude and rate.
pub(crate) const ALL: usize = 6 + SHARED;

pub(super) type Square = SMatrix<f64, 6, 6>;
pub(super) type Derivative = SMatrix<f64, 6, ALL>;

/// Euler's equations of a tensor under a torque.
pub(super) struct Law {
    terms: Terms,
    inverse: Matrix3<f64>,
    columns: Vec<Column>,
}

/// Where the motion from a sample has come at the next.
pub(super) struct Carried {
    pub(super) attitude: Quat<f64>,
    pub(super) rate: Vector3<f64>,
    /// Derivative of rotation vector and rate by those at the sample before and by what is shared.
    pub(super) by: Derivative,
    /// Their covariance by torque noise of level 1: an angular acceleration that is alike along all axes, and a torque that is.
    pub(super) noise: [Square; 2],
}

/// A point of the integration, or its slope.
#[derive(Clone, Copy)]
struct Point {
    attitude: Quat<f64>,
    rate: Vector3<f64>,
    by: Derivative,
    noise: [Square; 2],
}

impl Point {
    fn plus(&self, slope: &Point, h: f64) -> Point {
        Point {
            attitude: self.attitude + slope.attitude * h,
            rate: self.rate + slope.rate * h,
            by: self.by + slope.by * h,
            noise: [0, 1].map(|k| self.noise[k] + slope.noise[k] * h),
        }
    }
}

impl Law {
    /// `None` of a tensor that has no inverse.
    pub(super) fn new(unknowns: &Unknowns, columns: &[Column]) -> Option<Law> {
        let terms = terms_of_all(columns, unknowns);
        let inverse = tensor(&unknowns.x).try_inverse()?;
        Some(Law { terms, inverse, columns: columns.to_vec() })
    }

    /// ω', its derivative by ω, and by what is shared.
    fn acceleration(&self, w: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>, SMatrix<f64, 3, SHARED>) {
        let Terms { j, drag, quadratic, viscous, constant, .. } = self.terms;
        let size = w.norm();
        let torque = constant - viscous * w - j * w * (quadratic * size);
        let slope = self.inverse * (torque - w.cross(&(j * w)));
        let by_rate = -self.inverse * self.terms.by_rate(w, &Vector3::zeros());
        let mut shared = SMatrix::<f64, 3, SHARED>::zeros();
        for k in 0..5 {
            let b = basis(k);
            let moved = b * slope + w.cross(&(b * w)) + b * w * (drag + quadratic * size);
            shared.set_column(k, &(-self.inverse * moved));
        }
        for (k, column) in self.columns.iter().enumerate() {
            let own = column.effect().acceleration(&self.inverse, w).unwrap_or_default();
            shared.set_column(5 + k, &own);
        }
        (slope, by_rate, shared)
    }

    fn slope(&self, at: &Point) -> Point {
        let w = at.rate;
        let (rate, by_rate, shared) = self.acceleration(&w);
        let mut flow = Square::zeros();
        flow.fixed_view_mut::<3, 3>(0, 0).copy_from(&-w.cross_matrix());
        flow.fixed_view_mut::<3, 3>(0, 3).fill_with_identity();
        flow.fixed_view_mut::<3, 3>(3, 3).copy_from(&by_rate);
        let mut by = flow * at.by;
        let mut own = by.fixed_view_mut::<3, SHARED>(3, 6);
        own += shared;
        let acting = [Matrix3::identity(), self.inverse * self.inverse / 9.0];
        let noise = [0, 1].map(|k| {
            let mut grown = flow * at.noise[k];
            grown += grown.transpose();
            let mut own = grown.fixed_view_mut::<3, 3>(3, 3);
            own += acting[k];
            grown
        });
        Point { attitude: at.attitude.rate(w.into()), rate, by, noise }
    }

    /// The motion from `start` after `duration`; `None` where it is not finite, or too fast to be followed.
    pub(super) fn carry(&self, start: &Start, duration: f64) -> Option<Carried> {
        let mut at = Point {
            attitude: start.attitude,
            rate: start.rate,
            by: Derivative::identity(),
            noise: [Square::zeros(); 2],
        };
        let parts = (duration.abs() * start.rate.norm().max(1.0) / STEP).ceil().max(1.0);
        if parts.is_nan() || parts > PARTS {
            return None;
        }
        let h = duration / parts;
        for _ in 0..parts as usize {
            let a = self.slope(&at);
            let b = self.slope(&at.plus(&a, 0.5 * h));
            let c = self.slope(&at.plus(&b, 0.5 * h));
            let d = self.slope(&at.plus(&c, h));
            let (third, sixth) = (h / 3.0, h / 6.0);
            at = at.plus(&a, sixth).plus(&b, third).plus(&c, third).plus(&d, sixth);
        }
        let Point { attitude, rate, by, noise } = at;
        let finite = rate.iter().chain(by.iter()).all(|v| v.is_finite());
        finite.then_some(Carried { attitude: attitude.normalized(), rate, by, noise })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::sets::torque_columns;
    use crate::likelihood::motion::Motion;
    use crate::physical::coordinates::Coordinates;
    use crate::settings::torque::TorqueModel;
    use polhode::rotation::Vec3;

    const X: [f64; 5] = [0.05, 0.02, 0.01, -0.03, 0.02];

    fn start() -> Start {
        Start { attitude: Quat::exponential(Vec3([0.3, -0.2, 0.9])), rate: Vector3::new(0.3, 1.0, -0.4) }
    }

    /// Without a torque, and with drag along the momentum, the closed forms.
    #[test]
    fn motions_are_those_of_the_closed_forms() {
        for (model, drag) in [(TorqueModel::None, 0.0), (TorqueModel::Drag, 0.1)] {
            let columns = torque_columns(model);
            let mut at = Unknowns::at(Coordinates::from_column_slice(&X), &columns);
            at.c.iter_mut().for_each(|c| *c = drag);
            let found = Law::new(&at, &columns).unwrap().carry(&start(), 2.0).unwrap();
            let exact = Motion::new(&at.x, &start(), drag).unwrap().at(2.0).unwrap();
            assert!((found.rate - exact.rate).norm() < 1e-7);
            assert!((exact.attitude.conjugate() * found.attitude).logarithm().norm() < 1e-7);
            let by = found.by.fixed_view::<6, 11>(0, 0) - exact.by;
            assert!(by.norm() < 1e-6, "{by}");
            if model == TorqueModel::Drag {
                assert!((found.by.column(11) - exact.by_drag).norm() < 1e-6);
            }
        }
    }

    /// Derivatives under every torque against differences, and the covariance of torque noise against its integral over them.
    #[test]
    fn derivatives_are_those_of_differences() {
        let models = [TorqueModel::Drag, TorqueModel::Drag3, TorqueModel::Quadratic, TorqueModel::Constant];
        for model in models {
            let columns = torque_columns(model);
            let mut at = Unknowns::at(Coordinates::from_column_slice(&X), &columns);
            at.c.iter_mut().enumerate().for_each(|(k, c)| *c = 0.03 + 0.02 * k as f64);
            let (t, h) = (1.5, 1e-5);
            let here = Law::new(&at, &columns).unwrap().carry(&start(), t).unwrap();
            for k in 0..11 + columns.len() {
                let moved = |h: f64| {
                    let (mut at, mut start) = (at.clone(), start());
                    match k {
                        0..3 => {
                            let turn = Vec3::from(Vector3::ith(k, h));
                            start.attitude = start.attitude * Quat::exponential(turn);
                        }
                        3..6 => start.rate[k - 3] += h,
                        6..11 => at.x[k - 6] += h,
                        _ => at.c[k - 11] += h,
                    }
                    Law::new(&at, &columns).unwrap().carry(&start, t).unwrap()
                };
                let (above, below) = (moved(h), moved(-h));
                let turn: Vector3<f64> = (below.attitude.conjugate() * above.attitude).logarithm().into();
                let change = (above.rate - below.rate) / (2.0 * h);
                for row in 0..3 {
                    assert!((turn[row] / (2.0 * h) - here.by[(row, k)]).abs() < 1e-6, "{model:?} {k} {row}");
                    assert!((change[row] - here.by[(3 + row, k)]).abs() < 1e-6, "{model:?} {k} {row}");
                }
            }
            let law = Law::new(&at, &columns).unwrap();
            let (parts, mut sums) = (200, [Square::zeros(); 2]);
            for part in 0..parts {
                let s = (f64::from(part) + 0.5) * t / f64::from(parts);
                let from = law.carry(&start(), s).unwrap();
                let from = Start { attitude: from.attitude, rate: from.rate };
                let rest = law.carry(&from, t - s).unwrap().by.fixed_view::<6, 3>(0, 3).into_owned();
                for (sum, acting) in
                    sums.iter_mut().zip([Matrix3::identity(), law.inverse * law.inverse / 9.0])
                {
                    *sum += rest * acting * rest.transpose() * (t / f64::from(parts));
                }
            }
            for (sum, own) in sums.iter().zip(&here.noise) {
                assert!((sum - own).norm() < 1e-4 * own.norm(), "{model:?}");
            }
        }
    }

    /// What takes more than a thousand steps of 0.03 rad is too fast to be followed, and a body that turns slowly takes a step for each 0.03 s.
    #[test]
    fn what_is_too_fast_is_not_followed() {
        let at = Unknowns::at(Coordinates::from_column_slice(&X), &[]);
        let law = Law::new(&at, &[]).unwrap();
        let spin = |rate: f64| Start { attitude: Quat::identity(), rate: Vector3::z() * rate };
        for (rate, duration, is) in
            [(0.1, 29.9, true), (0.1, 30.1, false), (20.0, 1.49, true), (20.0, -1.51, false)]
        {
            assert_eq!(law.carry(&spin(rate), duration).is_some(), is, "{rate} {duration}");
        }
        assert!(law.carry(&spin(f64::NAN), 1.0).is_none() && law.carry(&spin(1.0), f64::NAN).is_none());
    }
}
