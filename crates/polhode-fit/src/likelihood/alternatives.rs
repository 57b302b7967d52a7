//! What would explain the samples better: a torque, axes of rates and attitudes that move against each other, or an error of the rates.
//!
//! To first order in its coefficients c a torque moves the motion by Φ(t) ∫ Φ(s)⁻¹ (0, J⁻¹ ∂τ/∂c) ds, with Φ the derivative by the
//! start.

use nalgebra::{DMatrix, DVector, Matrix3, SMatrix, SVector, UnitQuaternion, Vector3};

use crate::likelihood::descent::Levels;
use crate::likelihood::motion::{Motion, Moved, Start};
use crate::likelihood::sums::fill;
use crate::likelihood::track::{ALL, COMMON, Model, OWN, Track};
use crate::physical::coordinates::tensor;
use crate::thresholds::likelihood::PANEL;
use crate::thresholds::poses;

/// Columns beside those of the model: drag, a constant torque, turns over the time of the axes of attitudes and of rates, an offset of the
/// rates and an error of their scale.
const FURTHER: usize = 14;
const WIDTH: usize = ALL + FURTHER;
const DRAG: core::ops::Range<usize> = 0..1;
const CONSTANT: core::ops::Range<usize> = 1..4;
const MOVING: [core::ops::Range<usize>; 2] = [4..7, 7..10];
const OFFSET: core::ops::Range<usize> = 10..13;
const SCALE: core::ops::Range<usize> = 13..14;

type Rows = SMatrix<f64, 3, WIDTH>;
/// A rotation vector and a rate by the three components of a torque.
type ByTorque = SMatrix<f64, 6, 3>;

/// Coefficients that were left out of the model, as one step of least squares finds them.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    pub(crate) values: Vec<f64>,
    /// By how much they move what all stretches share, and a factor of what their covariance adds to its own.
    pub(crate) moved: DVector<f64>,
    pub(crate) spread: DMatrix<f64>,
    /// Their standard deviations.
    pub(crate) sigmas: Vec<f64>,
    /// Gain of log-likelihood.
    pub(crate) gain: f64,
}

/// What each alternative would bring.
pub(crate) struct Alternatives {
    /// −c J ω, in units of the rate; `None` where the model has it.
    pub(crate) drag: Option<Found>,
    /// Over the trace and the squared unit of the rate, axes of the tensor.
    pub(crate) constant: Found,
    /// The likelier of both kinds of axes that move; without either kind of sample `None`.
    pub(crate) moving: Option<MovingAxes>,
    of_attitudes: Option<Found>,
    of_rates: Option<Found>,
    offset: Option<Found>,
    scale: Option<Found>,
}

/// An error of rates that stand beside attitudes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RateError {
    /// A constant is added to them.
    Offset,
    /// They are too large by one share along all axes.
    Scale,
}

/// By how much the axes of one kind of sample turn from the first sample of a stretch to its last, rad.
#[derive(Clone, Debug)]
pub(crate) struct MovingAxes {
    pub(crate) found: Found,
    pub(crate) is_of_rates: bool,
}

impl Alternatives {
    /// `None` where the samples do not determine the model.
    pub(crate) fn new(tracks: &[Track], model: &Model, levels: Levels) -> Option<Alternatives> {
        let mut information = DMatrix::zeros(COMMON + FURTHER, COMMON + FURTHER);
        let mut gradient = DVector::zeros(COMMON + FURTHER);
        for (track, start) in tracks.iter().zip(&model.starts) {
            add(track, model, start, levels, &mut information, &mut gradient)?;
        }
        for k in 0..COMMON {
            // without both attitudes and rates there is no alignment
            if information[(k, k)] == 0.0 {
                information[(k, k)] = 1.0;
            }
        }
        let of = |columns: core::ops::Range<usize>| found(&information, &gradient, columns);
        // it may be the one or the other that moves on the body
        let of_axes = |columns| if model.is_aligned { of(columns) } else { None };
        let [of_attitudes, of_rates] = MOVING.map(of_axes);
        let each = [&of_attitudes, &of_rates].into_iter().zip([false, true]);
        let each =
            each.filter_map(|(found, is_of_rates)| Some(MovingAxes { found: found.clone()?, is_of_rates }));
        let moving = each.max_by(|a, b| a.found.gain.total_cmp(&b.found.gain));
        let drag = if model.drag.is_none() { Some(of(DRAG)?) } else { None };
        let (offset, scale) = (of_axes(OFFSET), of_axes(SCALE));
        Some(Alternatives { drag, constant: of(CONSTANT)?, moving, of_attitudes, of_rates, offset, scale })
    }

    /// What the axes of one kind of sample would bring if they moved.
    pub(crate) fn of_axes(&self, of_rates: bool) -> Option<&Found> {
        if of_rates { self.of_rates.as_ref() } else { self.of_attitudes.as_ref() }
    }

    /// What an error of the rates would bring; `None` without attitudes beside them.
    pub(crate) fn of_error(&self, error: RateError) -> Option<&Found> {
        match error {
            RateError::Offset => self.offset.as_ref(),
            RateError::Scale => self.scale.as_ref(),
        }
    }

    /// The error of the rates that explains the samples better than the other does, and better than a torque or axes that move.
    pub(crate) fn error_of_rates(&self) -> Option<(RateError, &Found)> {
        // more unknowns explain more in any case
        let worth = |found: &Found| found.gain - found.values.len() as f64;
        let moving = self.moving.as_ref().map(|moving| &moving.found);
        let others = [self.drag.as_ref(), Some(&self.constant), moving];
        let most = others.into_iter().flatten().map(worth).fold(0.0, f64::max);
        let each = [(RateError::Offset, poses::MOVING), (RateError::Scale, poses::SCALED)];
        let each = each.into_iter().filter_map(|(error, least)| Some((error, least, self.of_error(error)?)));
        let each = each.filter(|&(_, least, found)| found.gain > least && worth(found) > most);
        let best = each.max_by(|a, b| worth(a.2).total_cmp(&worth(b.2)));
        best.map(|(error, _, found)| (error, found))
    }
}

/// Some further columns beside those of the model.
pub(crate) fn found(
    information: &DMatrix<f64>,
    gradient: &DVector<f64>,
    columns: core::ops::Range<usize>,
) -> Option<Found> {
    let (first, count) = (COMMON + columns.start, columns.len());
    let own = information.view((0, 0), (COMMON, COMMON)).into_owned().cholesky()?;
    let mixed = information.view((0, first), (COMMON, count)).into_owned();
    let left = information.view((first, first), (count, count)) - mixed.tr_mul(&own.solve(&mixed));
    let right =
        gradient.rows(first, count) - mixed.tr_mul(&own.solve(&gradient.rows(0, COMMON).into_owned()));
    let covariance = left.cholesky()?.inverse();
    let values = &covariance * &right;
    let response = -own.solve(&mixed);
    Some(Found {
        moved: &response * &values,
        spread: response * covariance.clone().cholesky()?.l(),
        gain: 0.5 * values.dot(&right),
        sigmas: (0..count).map(|k| covariance[(k, k)].sqrt()).collect(),
        values: values.as_slice().to_vec(),
    })
}

/// Adds the normal equations of a track, its start taken out.
fn add(
    track: &Track,
    model: &Model,
    start: &Start,
    levels: Levels,
    information: &mut DMatrix<f64>,
    gradient: &mut DVector<f64>,
) -> Option<()> {
    let motion = model.motion(start)?;
    let inverse = tensor(&model.x).try_inverse()?;
    let back = UnitQuaternion::from(model.alignment).to_rotation_matrix().matrix().transpose();
    let span = track.times.last()? - track.times.first()?;
    let both = track.has_attitudes() && track.has_rates();
    let mut matrix = SMatrix::<f64, WIDTH, WIDTH>::zeros();
    let mut right = SVector::<f64, WIDTH>::zeros();
    let mut put = |rows: Rows, residual: Vector3<f64>, level: f64| {
        matrix += rows.tr_mul(&rows) / (level * level);
        right += rows.tr_mul(&residual) / (level * level);
    };
    let mut sample = |k: usize, moved: &Moved, by_torque: &ByTorque| {
        let t = track.times[k];
        let (turn, slowed) = (moved.by_drag.fixed_rows::<3>(0), moved.by_drag.fixed_rows::<3>(3));
        if let Some(attitude) = track.attitudes.get(k) {
            let mut rows = Rows::zeros();
            rows.fixed_view_mut::<3, 11>(0, 0).copy_from(&(back * moved.by.fixed_rows::<3>(0)));
            if model.is_aligned {
                rows.fixed_view_mut::<3, 3>(0, OWN + 5).fill_with_identity();
            }
            if model.drag.is_some() {
                rows.set_column(ALL - 1, &(back * turn));
            }
            rows.set_column(ALL, &(back * turn));
            rows.fixed_view_mut::<3, 3>(0, ALL + 1).copy_from(&(back * by_torque.fixed_rows::<3>(0)));
            if both {
                let share = Matrix3::identity() * (t / span);
                rows.fixed_view_mut::<3, 3>(0, ALL + 4).copy_from(&share);
            }
            let left = (moved.attitude * model.alignment).conjugate() * *attitude;
            put(rows, left.logarithm().into(), levels.attitude);
        }
        if let Some(rate) = track.rates.get(k) {
            let mut rows = Rows::zeros();
            rows.fixed_view_mut::<3, 11>(0, 0).copy_from(&moved.by.fixed_rows::<3>(3));
            if model.drag.is_some() {
                rows.set_column(ALL - 1, &slowed);
            }
            rows.set_column(ALL, &slowed);
            rows.fixed_view_mut::<3, 3>(0, ALL + 1).copy_from(&by_torque.fixed_rows::<3>(3));
            if both {
                let turned = moved.rate.cross_matrix() * (t / span);
                rows.fixed_view_mut::<3, 3>(0, ALL + 7).copy_from(&turned);
                rows.fixed_view_mut::<3, 3>(0, ALL + 10).fill_with_identity();
                rows.set_column(ALL + 13, &moved.rate);
            }
            put(rows, rate - moved.rate, levels.rate);
        }
    };
    let split = track.times.partition_point(|t| *t < 0.0);
    let used = |k: &usize| track.used[*k];
    outwards(&motion, &inverse, (split..track.times.len()).filter(used), &track.times, &mut sample)?;
    outwards(&motion, &inverse, (0..split).rev().filter(used), &track.times, &mut sample)?;

    let mut own = matrix.fixed_view::<OWN, OWN>(0, 0).into_owned();
    fill(own.as_mut_slice(), OWN);
    let own = own.cholesky()?;
    let mixed = matrix.fixed_view::<OWN, { WIDTH - OWN }>(0, OWN).into_owned();
    let rest =
        matrix.fixed_view::<{ WIDTH - OWN }, { WIDTH - OWN }>(OWN, OWN) - mixed.tr_mul(&own.solve(&mixed));
    let of_start = right.fixed_rows::<OWN>(0).into_owned();
    let left = right.fixed_rows::<{ WIDTH - OWN }>(OWN) - mixed.tr_mul(&own.solve(&of_start));
    *information += DMatrix::from_column_slice(WIDTH - OWN, WIDTH - OWN, rest.as_slice());
    *gradient += DVector::from_column_slice(left.as_slice());
    Some(())
}

/// Goes from time 0 through some samples, each further away than the one before, and integrates what a torque does by the trapezoidal
/// rule in steps of a part of a radian.
fn outwards(
    motion: &Motion,
    inverse: &Matrix3<f64>,
    samples: impl Iterator<Item = usize>,
    times: &[f64],
    sample: &mut impl FnMut(usize, &Moved, &ByTorque),
) -> Option<()> {
    let drive = |moved: &Moved| -> Option<ByTorque> {
        let mut torque = ByTorque::zeros();
        torque.fixed_view_mut::<3, 3>(3, 0).copy_from(inverse);
        Some(moved.by.fixed_columns::<6>(0).into_owned().try_inverse()? * torque)
    };
    let mut before = drive(&motion.at(0.0)?)?;
    let (mut at, mut sum) = (0.0, ByTorque::zeros());
    for k in samples {
        let parts = ((times[k] - at).abs() / PANEL).ceil().max(1.0);
        let (from, h) = (at, (times[k] - at) / parts);
        for part in 1..=parts as usize {
            at = if part as f64 == parts { times[k] } else { from + part as f64 * h };
            let moved = motion.at(at)?;
            let here = drive(&moved)?;
            sum += (before + here) * (0.5 * h);
            before = here;
            if part as f64 == parts {
                sample(k, &moved, &(moved.by.fixed_columns::<6>(0) * sum));
            }
        }
    }
    Some(())
}

#[cfg(test)]
impl Found {
    /// So many coefficients that gain so much and move nothing.
    pub(crate) fn gaining(gain: f64, count: usize) -> Found {
        let (moved, spread) = (DVector::zeros(COMMON), DMatrix::zeros(COMMON, count));
        Found { values: vec![0.0; count], moved, spread, sigmas: vec![1.0; count], gain }
    }
}

#[cfg(test)]
impl Alternatives {
    /// With the gains of an offset, a scale, drag, a constant torque, axes of rates that move.
    pub(crate) fn gaining([offset, scale, drag, constant, moving]: [f64; 5]) -> Alternatives {
        Alternatives {
            drag: Some(Found::gaining(drag, 1)),
            constant: Found::gaining(constant, 3),
            moving: Some(MovingAxes { found: Found::gaining(moving, 3), is_of_rates: true }),
            of_attitudes: None,
            of_rates: Some(Found::gaining(moving, 3)),
            offset: Some(Found::gaining(offset, 3)),
            scale: Some(Found::gaining(scale, 1)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An error of the rates is named where it gains enough by itself and, less one for each of its numbers, more than the other error, a
    /// torque or axes that move.
    #[test]
    fn an_error_of_the_rates_is_named_where_nothing_explains_more() {
        let (offset, scale) = (Some(RateError::Offset), Some(RateError::Scale));
        // gains of an offset, a scale, drag, a constant torque, axes that move
        for (gains, expected) in [
            ([15.1, 0.0, 0.0, 0.0, 0.0], offset),
            ([14.9, 0.0, 0.0, 0.0, 0.0], None),
            ([0.0, 12.1, 0.0, 0.0, 0.0], scale),
            ([0.0, 11.9, 0.0, 0.0, 0.0], None),
            ([20.0, 17.9, 0.0, 0.0, 0.0], offset),
            ([20.0, 18.1, 0.0, 0.0, 0.0], scale),
            ([20.0, 0.0, 17.9, 0.0, 0.0], offset),
            ([20.0, 0.0, 18.1, 0.0, 0.0], None),
            ([20.0, 0.0, 0.0, 19.9, 0.0], offset),
            ([20.0, 0.0, 0.0, 20.1, 0.0], None),
            ([20.0, 0.0, 0.0, 0.0, 19.9], offset),
            ([20.0, 0.0, 0.0, 0.0, 20.1], None),
        ] {
            let all = Alternatives::gaining(gains);
            assert_eq!(all.error_of_rates().map(|(error, _)| error), expected, "{gains:?}");
            assert_eq!(all.of_error(RateError::Scale).map(|found| found.gain), Some(gains[1]));
            assert!(all.of_axes(true).is_some() && all.of_axes(false).is_none());
        }
    }

    /// Of a single further column c beside one that is told: its value is (g_c − f g)/(h − f²) where the first has the information 1 and
    /// shares f with it; it moves the first by −f times that, and gains half of value times slope.
    #[test]
    fn a_further_column_is_fitted_beside_those_of_the_model() {
        let mut information = DMatrix::<f64>::identity(COMMON + FURTHER, COMMON + FURTHER);
        let mut gradient = DVector::<f64>::zeros(COMMON + FURTHER);
        let (place, shared) = (COMMON + 1, 2.0);
        (information[(0, place)], information[(place, 0)]) = (shared, shared);
        information[(place, place)] = 8.0;
        (gradient[0], gradient[place]) = (0.5, 3.0);
        let found = found(&information, &gradient, CONSTANT).unwrap();
        // (3 − 2 · 0.5)/(8 − 4) of the first, with the other two at rest
        assert!((Vector3::from_column_slice(&found.values) - Vector3::x() * 0.5).amax() < 1e-15);
        assert!((found.sigmas[0] - 0.5).abs() < 1e-15 && (found.sigmas[1] - 1.0).abs() < 1e-15);
        assert!((found.gain - 0.5).abs() < 1e-15 && (found.moved[0] + 1.0).abs() < 1e-15);
        // −2 times a deviation of a half
        assert!((found.spread[(0, 0)] + 1.0).abs() < 1e-15 && found.spread[(1, 0)] == 0.0);
    }
}
