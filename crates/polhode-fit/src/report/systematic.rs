//! What errors of the sensor, and a wheel inside the body, that a fit takes to be zero would do to the moments.

use crate::thresholds::errors::{MAGNET, MOST, WALK, WALK_STEPS, WHEEL};
use nalgebra::{Matrix3, Vector3};

use crate::columns::column::Column;
use crate::columns::rotor::Rotor;
use crate::columns::sets::{magnet_columns, reported_errors, told_components, walk_columns};
use crate::columns::wheel_axis::WheelAxis;
use crate::likelihood::sums::{Reduced, Sums};
use crate::likelihood::track::{Left, Model, Track};
use crate::models::equations::Equations;
use crate::physical::coordinates::{Coordinates, pair, tensor};
use crate::report::nuisance::Systematic;
use crate::signal::stretch::Stretch;
use crate::solve::stacked::responses;
use crate::solve::weak_estimate::WeakEstimate;

/// An error, and the columns that it is made of with the size of each; those of a random one are independent.
struct Line {
    name: &'static str,
    unit: &'static str,
    size: f64,
    columns: Vec<(Column, f64)>,
}

/// The columns of the errors that a fit with columns `own` takes to be zero; `rms` is the unit rate, rad/s.
pub(crate) fn errors(own: &[Column], stretches: &[Stretch], rms: f64) -> Vec<Column> {
    // of momenta the sizes alone depend on the tensor
    let lines = lines(own, &Matrix3::identity(), stretches, rms);
    let told = told_components(stretches).into_iter().map(|axis| Column::new(WheelAxis(axis), None));
    lines.iter().flat_map(|line| &line.columns).map(|(column, _)| *column).chain(told).collect()
}

/// Root mean square of the momentum of a body of the tensor `j`.
pub(crate) fn momentum(stretches: &[Stretch], j: &Matrix3<f64>) -> f64 {
    let (mut squares, mut count) = (0.0, 0.0);
    for rate in stretches.iter().flat_map(|stretch| &stretch.rates) {
        squares += (j * rate).norm_squared();
        count += 1.0;
    }
    (squares / f64::max(count, 1.0)).sqrt()
}

/// These errors in the units of the fit, with the sizes that a report speaks of for a body of the tensor `j`.
fn lines(own: &[Column], j: &Matrix3<f64>, stretches: &[Stretch], rms: f64) -> Vec<Line> {
    let alone = |column: Column, size: f64, factor: f64| {
        let label = column.label();
        Line { name: label.name, unit: label.unit, size, columns: vec![(column, size * factor)] }
    };
    let estimated = |column: &Column| own.iter().any(|own| own.is_alike(column));
    let sensor = reported_errors().into_iter().filter(|column| !estimated(column));
    let line = |column: Column| {
        Some(alone(column, column.effect().reported_size()?, 1.0 / column.label().factor(rms)))
    };
    let mut lines: Vec<Line> = sensor.filter_map(line).collect();
    let momentum = momentum(stretches, j);
    lines.extend([0, 1, 2].map(|axis| alone(Column::new(Rotor(axis), None), WHEEL, momentum)));
    let magnet = magnet_columns(stretches);
    if magnet.len() <= MOST {
        // of both directions at random each product has a third of the size
        let columns = magnet.into_iter().map(|column| (column, MAGNET / 3.0 / rms / rms)).collect();
        lines.push(Line { name: "magnet", unit: "rad/s^2", size: MAGNET, columns });
    }
    let walk = walk_columns(stretches, WALK / rms / rms.sqrt(), WALK_STEPS);
    if walk.len() <= MOST {
        let step = |column: Column| column.prior.map(|size| (column.with_prior(None), size));
        let columns = walk.into_iter().filter_map(step).collect();
        lines.push(Line { name: "walk", unit: "rad/s/sqrt(s)", size: WALK, columns });
    }
    lines
}

/// The lines of the report; `axes` and `moments` are the principal ones, ascending, and `rms` is the unit rate, rad/s.
///
/// With g the derivative of the equations with respect to an error, the estimate moves by what makes |G δ − g| least.
pub(crate) fn systematic(
    weak: &WeakEstimate,
    equations: &Equations,
    stretches: &[Stretch],
    axes: &[Vector3<f64>; 3],
    moments: &[f64; 3],
    variance: f64,
    rms: f64,
) -> Vec<Systematic> {
    let lines = lines(&weak.columns, &tensor(&weak.x()), stretches, rms);
    let errors = equations.errors().len();
    let columns: Vec<Column> =
        equations.errors().iter().copied().chain(weak.columns.iter().copied()).collect();
    let Some(whitened) = equations.with_errors(&weak.columns) else { return Vec::new() };
    let rows: Vec<&[f64]> = whitened.iter().map(Vec::as_slice).collect();
    let Some(steps) = responses(&rows, &columns, errors, variance.sqrt()) else { return Vec::new() };
    let mut place = 0;
    let each = lines.into_iter().map(|line| {
        let begin = place;
        place += line.columns.len();
        let of = line.columns.iter().enumerate().map(|(k, &(_, size))| {
            let step = steps[begin + k] * size;
            changes(&step, axes, moments)
        });
        let of: Vec<[f64; 5]> = of.collect();
        let [a, b, c, d, e] = match of.as_slice() {
            [one] => *one,
            many => core::array::from_fn(|k| many.iter().map(|own| own[k] * own[k]).sum::<f64>().sqrt()),
        };
        let (name, size, unit) = (line.name, line.size, line.unit);
        Systematic { name, size, unit, principal: [a, b, c], ratios: [d, e] }
    });
    each.filter(|s| s.principal.iter().all(|v| v.is_finite())).collect()
}

/// The same of the sensor alone, of rates that were fitted on the exact motion.
///
/// With e the derivative of the readings with respect to an error, the estimate moves by what makes |G δ − e| least, G that of the motion.
pub(crate) fn of_readings(
    tracks: &[Track],
    model: &Model,
    axes: &[Vector3<f64>; 3],
    moments: &[f64; 3],
    rms: f64,
) -> Vec<Systematic> {
    let (columns, j) = (reported_errors(), tensor(&model.x));
    let Some(inverse) = j.try_inverse() else { return Vec::new() };
    let drag = model.drag.unwrap_or(0.0);
    // of each error in each track
    let mut all: Vec<Vec<Sums>> = vec![Vec::new(); columns.len()];
    for (track, start) in tracks.iter().zip(&model.starts) {
        let mut each = vec![Sums::zero(); columns.len()];
        let seen = track.visit(model, start, f64::INFINITY, |left| {
            let w = track.rates[left.sample] - left.residual;
            let slope = inverse * (j * w).cross(&w) - w * drag;
            for (sums, column) in each.iter_mut().zip(&columns) {
                let change = column.effect().change_of_reading(&w, &slope, track.times[left.sample]);
                sums.add(&Left { residual: change.unwrap_or_else(Vector3::zeros), ..*left }, 1.0);
            }
        });
        if seen.is_none() {
            return Vec::new();
        }
        all.iter_mut().zip(each).for_each(|(all, sums)| all.push(sums));
    }
    let line = |(column, sums): (&Column, &Vec<Sums>)| {
        let (label, size) = (column.label(), column.effect().reported_size()?);
        let step = Reduced::new(sums)?.step()?.common.fixed_rows::<5>(0) * (size / label.factor(rms));
        let [a, b, c, d, e] = changes(&step, axes, moments);
        Some(Systematic { name: label.name, size, unit: label.unit, principal: [a, b, c], ratios: [d, e] })
    };
    columns.iter().zip(&all).filter_map(line).collect()
}

/// The changes of the principal moments and of the ratios by a step.
fn changes(step: &Coordinates, axes: &[Vector3<f64>; 3], moments: &[f64; 3]) -> [f64; 5] {
    let change: [f64; 3] = core::array::from_fn(|k| pair(&axes[k], &axes[k]).dot(step));
    let ratio = |k: usize| (change[k] - change[2] * moments[k] / moments[2]) / moments[2];
    [change[0], change[1], change[2], ratio(0), ratio(1)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::scale::Scale;
    use crate::thresholds::errors::{ALIGNMENT, DELAY, OFFSET, SCALE};

    /// Segments that last for one step of a walk, with momenta of which one of two is zero.
    fn segments(count: usize) -> Vec<Stretch> {
        let of = |index| {
            let rates = vec![Vector3::new(3.0, 0.0, 4.0), Vector3::zeros()];
            Stretch { index, ..Stretch::new(vec![0.0, 0.64], rates) }
        };
        (0..count).map(of).collect()
    }

    /// Each error has its size in the units of the fit, that of a wheel over the root mean square of the momentum; both directions of a magnet
    /// are random, and a walk grows with the root of the time.
    #[test]
    fn errors_have_their_sizes_in_the_units_of_the_fit() {
        let (j, rms) = (Matrix3::from_diagonal(&Vector3::new(0.2, 0.3, 0.25)), 4.0);
        // (0.6² + 1²)/2
        let momentum = 0.68_f64.sqrt();
        let lines = lines(&[], &j, &segments(1), rms);
        for (name, count, size) in [
            ("scale", 1, SCALE),
            ("scale_z", 1, SCALE),
            ("misalignment_xy", 1, ALIGNMENT),
            ("offset_x", 1, OFFSET / 4.0),
            ("skew_y", 1, DELAY * 4.0),
            ("wheel_z", 1, WHEEL * momentum),
            ("magnet", 9, MAGNET / 48.0),
            ("walk", 3, WALK / 8.0 * 0.8),
        ] {
            let line = lines.iter().find(|line| line.name == name).unwrap();
            assert_eq!(line.columns.len(), count, "{name}");
            for (column, found) in &line.columns {
                assert!((found / size - 1.0).abs() < 1e-12, "{name}: {found} {size}");
                assert_eq!(column.prior, None, "{name}");
            }
        }
        // those that are fitted are none
        let own = [Column::new(Scale, Some(0.1))];
        let names = |own: &[Column]| errors(own, &segments(1), rms).into_iter().map(|c| c.label().name);
        assert!(names(&[]).any(|name| name == "scale") && !names(&own).any(|name| name == "scale"));
    }

    /// Magnets of up to six segments and walks of up to sixty steps are asked for.
    #[test]
    fn many_segments_are_not_asked_for_magnets_and_walks() {
        for (count, magnet, walk) in
            [(6, true, true), (7, false, true), (20, false, true), (21, false, false)]
        {
            let lines = lines(&[], &Matrix3::identity(), &segments(count), 1.0);
            let has = |name: &str| lines.iter().any(|line| line.name == name);
            assert_eq!((has("magnet"), has("walk")), (magnet, walk), "{count}");
        }
    }
}
