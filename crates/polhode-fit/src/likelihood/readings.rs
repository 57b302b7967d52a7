//! Errors of the sensor beside rates of a free motion.
//!
//! To first order an error c changes the reading y of a rate by c ∂y/∂c, which stands as a column beside the derivatives of the motion.

use nalgebra::{DMatrix, DVector, Vector3};

use crate::columns::column::Column;
use crate::likelihood::alternatives::{Found, found};
use crate::likelihood::track::{ALL, COMMON, Model, OWN, Track};
use crate::physical::coordinates::tensor;

/// What each of these errors, by its columns in units of the rate, would bring by itself where rates have noise of this standard deviation.
///
/// `None` where the samples do not determine the motion.
pub(crate) fn beside(
    tracks: &[Track],
    model: &Model,
    level: f64,
    errors: &[Vec<Column>],
) -> Option<Vec<Found>> {
    let columns: Vec<&Column> = errors.iter().flatten().collect();
    let (shared, weight) = (COMMON + columns.len(), 1.0 / (level * level));
    let j = tensor(&model.x);
    let inverse = j.try_inverse()?;
    let mut information = DMatrix::<f64>::zeros(shared, shared);
    let mut gradient = DVector::<f64>::zeros(shared);
    for (track, start) in tracks.iter().zip(&model.starts) {
        let mut matrix = DMatrix::<f64>::zeros(OWN + shared, OWN + shared);
        let mut right = DVector::<f64>::zeros(OWN + shared);
        track.visit(model, start, f64::INFINITY, |left| {
            let w = track.rates[left.sample] - left.residual;
            let slope = inverse * (j * w).cross(&w) - w * model.drag.unwrap_or(0.0);
            let change = |column: &&Column| {
                let change = column.effect().change_of_reading(&w, &slope, track.times[left.sample]);
                change.unwrap_or_else(Vector3::zeros)
            };
            let changes: Vec<Vector3<f64>> = columns.iter().map(change).collect();
            let rows = DMatrix::from_fn(3, OWN + shared, |i, k| match k.checked_sub(ALL) {
                None => left.rows[(i, k)],
                Some(k) => changes[k][i],
            });
            matrix += rows.tr_mul(&rows) * weight;
            right += rows.tr_mul(&left.residual) * weight;
        })?;
        // rates do not depend on the attitude at the start
        (0..OWN).for_each(|k| fill(&mut matrix, k));
        let own = matrix.view((0, 0), (OWN, OWN)).into_owned().cholesky()?;
        let mixed = matrix.view((0, OWN), (OWN, shared)).into_owned();
        let of_start = right.rows(0, OWN).into_owned();
        information += matrix.view((OWN, OWN), (shared, shared)) - mixed.tr_mul(&own.solve(&mixed));
        gradient += right.rows(OWN, shared) - mixed.tr_mul(&own.solve(&of_start));
    }
    // without attitudes there is no alignment, and not always drag
    (0..COMMON).for_each(|k| fill(&mut information, k));
    for (k, column) in columns.iter().enumerate() {
        let known = column.prior.map_or(0.0, |prior| 1.0 / (prior * prior));
        information[(COMMON + k, COMMON + k)] += known;
    }
    let mut first = 0;
    let each = errors.iter().map(|own| {
        let begin = first;
        first += own.len();
        found(&information, &gradient, begin..first)
    });
    each.collect()
}

/// A one on the diagonal in place of a zero.
fn fill(square: &mut DMatrix<f64>, k: usize) {
    if square[(k, k)] == 0.0 {
        square[(k, k)] = 1.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::axis_scale::AxisScale;
    use crate::columns::offset::Offset;
    use crate::likelihood::motion::Start;
    use crate::likelihood::sums::{Reduced, Sums};
    use crate::physical::coordinates::Coordinates;
    use polhode::rotation::Quat;

    const LEVEL: f64 = 0.01;

    /// Rates of a free motion with a constant added, and the motion.
    fn off_by(offset: Vector3<f64>) -> (Track, Model) {
        let x = Coordinates::from_fn(|k, _| [0.05, -0.08, 0.02, 0.01, -0.03][k]);
        let start = Start { attitude: Quat::identity(), rate: Vector3::new(0.5, 0.8, -0.4) };
        let model =
            Model { x, alignment: Quat::identity(), is_aligned: false, drag: None, starts: vec![start] };
        let motion = model.motion(&start).unwrap();
        let times: Vec<f64> = (-40..=40).map(|k| 0.4 * f64::from(k)).collect();
        let rates = times.iter().map(|t| motion.at(*t).unwrap().rate + offset).collect();
        (Track { attitudes: Vec::new(), rates, used: vec![true; times.len()], times }, model)
    }

    fn columns(prior: Option<f64>) -> Vec<Vec<Column>> {
        let scales = (0..3).map(|k| Column::new(AxisScale(k), prior)).collect();
        vec![scales, (0..3).map(|k| Column::new(Offset(k), prior)).collect()]
    }

    /// An offset of the readings is found as it is, whatever stands before it, and gains half of the squares that the motion leaves without it; a
    /// prior that forbids it leaves no gain.
    #[test]
    fn an_offset_gains_what_the_motion_leaves_without_it() {
        let offset = Vector3::new(3e-3, -2e-3, 1e-3);
        let (track, model) = off_by(offset);
        let tracks = [track];
        let all = beside(&tracks, &model, LEVEL, &columns(None)).unwrap();
        let [scales, own] = &all[..] else { panic!("{}", all.len()) };
        assert!((Vector3::from_column_slice(&own.values) - offset).amax() < 1e-9, "{:?}", own.values);
        let mut sums = Sums::zero();
        let weight = 1.0 / (LEVEL * LEVEL);
        let each = tracks[0].visit(&model, &model.starts[0], f64::INFINITY, |left| sums.add(left, weight));
        let step = each.and_then(|()| Reduced::new(&[sums])?.step()).unwrap();
        let squares = weight * 81.0 * offset.norm_squared();
        let expected = 0.5 * (squares - step.gain);
        assert!(expected > 0.1 && (own.gain / expected - 1.0).abs() < 1e-6, "{} {expected}", own.gain);
        // nothing explains more than the error that there is
        assert!(scales.gain > 0.0 && scales.gain < own.gain, "{}", scales.gain);
        let forbidden = beside(&tracks, &model, LEVEL, &columns(Some(1e-9))).unwrap();
        assert!(forbidden.iter().all(|found| found.gain < 1e-6 * own.gain));
    }
}
