//! Stretches of samples of a free motion, and what a model leaves of them.

use nalgebra::{SMatrix, UnitQuaternion, Vector3};
use polhode::rotation::Quat;

use crate::likelihood::motion::{Motion, Start};
use crate::physical::coordinates::Coordinates;

/// Numbers of a start, those that all stretches share, and both.
pub(crate) const OWN: usize = 6;
pub(crate) const COMMON: usize = 9;
pub(crate) const ALL: usize = OWN + COMMON;

/// One stretch, in units of a rate and its inverse; time 0 is its middle.
#[derive(Clone, Debug)]
pub(crate) struct Track {
    /// Ascending.
    pub(crate) times: Vec<f64>,
    /// Body axes of the attitudes → space; empty where there are none.
    pub(crate) attitudes: Vec<Quat<f64>>,
    /// Axes of the tensor; empty where there are none.
    pub(crate) rates: Vec<Vector3<f64>>,
    /// Whether each sample is used.
    pub(crate) used: Vec<bool>,
}

/// What the samples are compared with.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    pub(crate) x: Coordinates,
    /// Takes coordinates along the body axes of the attitudes to those of the tensor.
    pub(crate) alignment: Quat<f64>,
    /// Whether it is unknown: without rates beside the attitudes it would turn tensor and starts alone.
    pub(crate) is_aligned: bool,
    /// k of −k J ω, where drag is fitted.
    pub(crate) drag: Option<f64>,
    /// One for each track.
    pub(crate) starts: Vec<Start>,
}

/// What a reading is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Attitude,
    Rate,
}

/// What a model leaves of one reading, and the derivative of the model by start, coordinates, alignment and drag.
pub(crate) struct Left {
    pub(crate) kind: Kind,
    /// Which sample.
    pub(crate) sample: usize,
    pub(crate) residual: Vector3<f64>,
    pub(crate) rows: SMatrix<f64, 3, ALL>,
}

impl Model {
    pub(crate) fn motion(&self, start: &Start) -> Option<Motion> {
        Motion::new(&self.x, start, self.drag.unwrap_or(0.0))
    }
}

impl Track {
    /// Samples within `radius` of the middle.
    pub(crate) fn within(&self, radius: f64) -> usize {
        self.times.iter().filter(|t| t.abs() <= radius).count()
    }

    pub(crate) fn has_attitudes(&self) -> bool {
        !self.attitudes.is_empty()
    }

    pub(crate) fn has_rates(&self) -> bool {
        !self.rates.is_empty()
    }

    /// The farther end from the middle.
    pub(crate) fn reach(&self) -> f64 {
        self.times.iter().fold(0.0, |far, t| t.abs().max(far))
    }

    /// Gives `each` what `model` leaves of the used samples within `radius`; `None` where there is no such motion.
    pub(crate) fn visit(
        &self,
        model: &Model,
        start: &Start,
        radius: f64,
        mut each: impl FnMut(&Left),
    ) -> Option<()> {
        let motion = model.motion(start)?;
        let turn = UnitQuaternion::from(model.alignment).to_rotation_matrix();
        let back = turn.matrix().transpose();
        for (sample, &t) in self.times.iter().enumerate().filter(|(k, t)| self.used[*k] && t.abs() <= radius)
        {
            let moved = motion.at(t)?;
            if let Some(attitude) = self.attitudes.get(sample) {
                let mut rows = SMatrix::<f64, 3, ALL>::zeros();
                let by = back * moved.by.fixed_rows::<3>(0);
                rows.fixed_view_mut::<3, 11>(0, 0).copy_from(&by);
                if model.is_aligned {
                    rows.fixed_view_mut::<3, 3>(0, OWN + 5).fill_with_identity();
                }
                if model.drag.is_some() {
                    rows.set_column(ALL - 1, &(back * moved.by_drag.fixed_rows::<3>(0)));
                }
                let left = (moved.attitude * model.alignment).conjugate() * *attitude;
                each(&Left { kind: Kind::Attitude, sample, residual: left.logarithm().into(), rows });
            }
            if let Some(rate) = self.rates.get(sample) {
                let mut rows = SMatrix::<f64, 3, ALL>::zeros();
                rows.fixed_view_mut::<3, 11>(0, 0).copy_from(&moved.by.fixed_rows::<3>(3));
                if model.drag.is_some() {
                    rows.set_column(ALL - 1, &moved.by_drag.fixed_rows::<3>(3));
                }
                each(&Left { kind: Kind::Rate, sample, residual: rate - moved.rate, rows });
            }
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both ends of a window belong to it, and the farther end of a track is its reach.
    #[test]
    fn windows_and_reach_count_from_the_middle() {
        let track = |times: &[f64]| Track {
            times: times.to_vec(),
            attitudes: Vec::new(),
            rates: vec![Vector3::x(); times.len()],
            used: vec![true; times.len()],
        };
        let one = track(&[-3.0, -1.0, 0.0, 1.0, 2.0]);
        assert_eq!([0.5, 1.0, 2.5, 3.0].map(|radius| one.within(radius)), [1, 3, 4, 5]);
        assert_eq!((one.reach(), track(&[-1.0, 4.0]).reach(), track(&[]).reach()), (3.0, 4.0, 0.0));
        assert!(one.has_rates() && !one.has_attitudes());
    }
}
