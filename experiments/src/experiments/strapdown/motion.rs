//! Motions whose attitudes and rates are known, and what gyroscopes would read of them.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::body::{Body, State};
use polhode::flow::ExactMotion;
use polhode::inertia::Inertia;
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode::strapdown::{Kind, Rule, Strapdown};
use polhode_files::error::{Error, unexpected};

/// Gauss's rule of eight points on [−1, 1]: abscissas and weights, Abramowitz and Stegun, table 25.4.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_29),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_47),
    (0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
];

/// A motion in closed form.
pub(super) struct Known {
    body: Body,
    motion: ExactMotion,
}

impl Known {
    pub(super) fn new(body: Body, omega: Vector3<f64>) -> Result<Self, Error> {
        let tilt = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.5);
        let start = body.state(tilt, omega).map_err(unexpected)?;
        let motion = ExactMotion::new(&body, &start).map_err(unexpected)?;
        Ok(Known { body, motion })
    }

    /// The body with moments 1, 2, 3, from a start whose motion has no symmetry.
    pub(super) fn free(omega: Vector3<f64>) -> Result<Self, Error> {
        Self::new(Body::free(Inertia::from_moments([1.0, 2.0, 3.0]).map_err(unexpected)?), omega)
    }

    /// A symmetric top under gravity that nods and turns at like rates.
    pub(super) fn top() -> Result<Self, Error> {
        let inertia = Inertia::from_moments([1.0, 1.0, 0.25]).map_err(unexpected)?;
        let body = Body::heavy(inertia, Vector3::new(0.0, 0.0, 0.7)).map_err(unexpected)?;
        Self::new(body, Vector3::new(0.3, -0.2, 0.9))
    }

    fn states(&self, times: &[f64]) -> Result<Vec<State>, Error> {
        match &self.motion {
            ExactMotion::Free(motion) => motion.at_many(times).map_err(unexpected),
            other => times.iter().map(|t| other.at(*t).map_err(unexpected)).collect(),
        }
    }

    pub(super) fn attitudes(&self, times: &[f64]) -> Result<Vec<Quat<f64>>, Error> {
        Ok(self.states(times)?.into_iter().map(|state| state.attitude).collect())
    }

    pub(super) fn rates(&self, times: &[f64]) -> Result<Vec<Vec3<f64>>, Error> {
        Ok(self.states(times)?.iter().map(|state| self.body.omega_body(state).into()).collect())
    }

    /// What a gyroscope reads: at the first time, of increments and averages, nothing.
    pub(super) fn readings(&self, kind: Kind, times: &[f64]) -> Result<Vec<Vec3<f64>>, Error> {
        if kind == Kind::Rate {
            return self.rates(times);
        }
        let mut points = Vec::with_capacity(8 * times.len());
        for pair in times.windows(2) {
            let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
            points.extend(GAUSS.iter().flat_map(|(x, _)| [middle - half * x, middle + half * x]));
        }
        let rates = self.rates(&points)?;
        let mut readings = vec![Vec3::zero()];
        for (pair, rates) in times.windows(2).zip(rates.chunks_exact(8)) {
            let two = rates.chunks_exact(2).zip(GAUSS);
            let mean = two.fold(Vec3::zero(), |sum, (two, (_, w))| sum + (two[0] + two[1]) * (0.5 * w));
            let size = if kind == Kind::Increment { pair[1] - pair[0] } else { 1.0 };
            readings.push(mean * size);
        }
        Ok(readings)
    }

    /// The largest attitude error of a rule over samples at `times`, rad.
    pub(super) fn error(&self, kind: Kind, rule: Rule, times: &[f64]) -> Result<f64, Error> {
        let (truth, readings) = (self.attitudes(times)?, self.readings(kind, times)?);
        let mut largest = 0.0_f64;
        let mut known = 0;
        let mut compare = |attitude: Quat<f64>| {
            largest = largest.max(rotation_angle(attitude, truth[known]));
            known += 1;
        };
        let mut strapdown = Strapdown::new(kind, rule, truth[0]).map_err(unexpected)?;
        for (t, reading) in times.iter().zip(readings) {
            let ready = strapdown.push(*t, reading).map_err(unexpected)?;
            ready.iter().for_each(|stamped| compare(stamped.attitude));
        }
        strapdown.finish().iter().for_each(|stamped| compare(stamped.attitude));
        Ok(largest)
    }
}

/// Times from 0 in steps of `h`, up to `until`.
pub(super) fn even(h: f64, until: f64) -> Vec<f64> {
    (0..=(until / h).round() as u64).map(|k| h * k as f64).collect()
}
