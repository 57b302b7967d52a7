//! What errors of the sensor, and a wheel inside the body, that a fit takes to be zero would do to the moments.

use nalgebra::Vector3;

use crate::columns::model::{Column, Kind, named, unit, walk_columns};
use crate::physical::coordinates::{pair, tensor};
use crate::report::nuisance::Systematic;
use crate::signal::stretch::Stretch;
use crate::solve::stacked::responses;
use crate::solve::weak_estimate::WeakEstimate;

/// Each error with its size: an offset of 0.01 rad/s, 1 per cent of scale, 0.01 rad of alignment, 1 ms of delay.
const ERRORS: [(Kind, f64); 12] = [
    (Kind::Scale, 0.01),
    (Kind::AxisScale(0), 0.01),
    (Kind::AxisScale(1), 0.01),
    (Kind::AxisScale(2), 0.01),
    (Kind::Misalignment(2), 0.01),
    (Kind::Misalignment(1), 0.01),
    (Kind::Misalignment(0), 0.01),
    (Kind::Offset(0), 0.01),
    (Kind::Offset(1), 0.01),
    (Kind::Offset(2), 0.01),
    (Kind::Skew(1), 1e-3),
    (Kind::Skew(2), 1e-3),
];
/// Momentum of a wheel inside the body over that of the body.
const WHEEL: f64 = 1e-3;
/// Random walk of the offsets, rad/s per √s.
const WALK: f64 = 1e-4;
/// Steps of that walk in each segment: the slow ones matter.
const WALK_STEPS: usize = 6;
/// Columns of a walk beyond which it is not asked for: the segments are many, and each is short.
const MOST: usize = 60;

/// An error, and the columns that it is made of with the size of each; those of a random one are independent.
struct Line {
    name: &'static str,
    unit: &'static str,
    size: f64,
    columns: Vec<(Column, f64)>,
}

/// The errors that a fit with `weak.columns` takes to be zero, in the units of the fit.
fn lines(weak: &WeakEstimate, stretches: &[Stretch], rms: f64) -> Vec<Line> {
    let alone = |kind: Kind, size: f64, factor: f64| {
        let (name, unit, _) = named(kind);
        Line { name, unit, size, columns: vec![(Column::new(kind, None), size * factor)] }
    };
    let estimated = |kind: Kind| weak.columns.iter().any(|column| column.kind == kind);
    let sensor = ERRORS.into_iter().filter(|(kind, _)| !estimated(*kind));
    let mut lines: Vec<Line> = sensor.map(|(kind, size)| alone(kind, size, 1.0 / unit(kind, rms))).collect();
    let j = tensor(&weak.x());
    let (mut squares, mut count) = (0.0, 0.0);
    for rate in stretches.iter().flat_map(|stretch| &stretch.rates) {
        squares += (j * rate).norm_squared();
        count += 1.0;
    }
    let momentum = (squares / f64::max(count, 1.0)).sqrt();
    lines.extend([0, 1, 2].map(|axis| alone(Kind::Rotor(axis), WHEEL, momentum)));
    let walk = walk_columns(stretches, WALK / rms / rms.sqrt(), WALK_STEPS);
    let fitted = weak.columns.iter().any(|column| matches!(column.kind, Kind::Walk { .. }));
    if walk.len() <= MOST && !fitted {
        let step = |column: Column| column.prior.map(|size| (Column { prior: None, ..column }, size));
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
    stretches: &[Stretch],
    axes: &[Vector3<f64>; 3],
    moments: &[f64; 3],
    variance: f64,
    rms: f64,
) -> Vec<Systematic> {
    let lines = lines(weak, stretches, rms);
    let first = lines.iter().flat_map(|line| &line.columns).map(|(column, _)| *column);
    let columns: Vec<Column> = first.chain(weak.columns.iter().copied()).collect();
    let errors = columns.len() - weak.columns.len();
    let mut at = weak.at.clone();
    at.c = vec![0.0; errors].into_iter().chain(at.c).collect();
    let parts = weak.parts.iter().map(|part| part.with_columns(&stretches[part.stretch], &columns, &at));
    let Some(whitened) = parts.collect::<Option<Vec<Vec<f64>>>>() else { return Vec::new() };
    let rows: Vec<&[f64]> = whitened.iter().map(Vec::as_slice).collect();
    let Some(steps) = responses(&rows, &columns, errors, variance.sqrt()) else { return Vec::new() };
    // of the principal moments and of the ratios, by a column of a given size
    let changes = |k: usize, size: f64| -> [f64; 5] {
        let step = steps[k] * size;
        let change: [f64; 3] = core::array::from_fn(|k| pair(&axes[k], &axes[k]).dot(&step));
        let ratio = |k: usize| (change[k] - change[2] * moments[k] / moments[2]) / moments[2];
        [change[0], change[1], change[2], ratio(0), ratio(1)]
    };
    let mut place = 0;
    let each = lines.into_iter().map(|line| {
        let begin = place;
        place += line.columns.len();
        let of = line.columns.iter().enumerate().map(|(k, &(_, size))| changes(begin + k, size));
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
