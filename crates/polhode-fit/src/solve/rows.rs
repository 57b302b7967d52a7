//! The rows of the weak equations of one stretch.

use nalgebra::Vector3;

use crate::columns::column::{Column, Unknowns, terms_of};
use crate::columns::effect::SampleChange;
use crate::columns::equation::{Corrected, Equation, crossed};
use crate::columns::squared::Squared;
use crate::physical::coordinates::basis;
use crate::signal::moments::{Group, Moments, groups};
use crate::signal::stretch::Stretch;
use crate::signal::terms::Terms;
use crate::signal::test_functions::{Seen, TestFunctions};

/// The equations of a stretch row by row, linearised at samples `rates` − `noise`: derivatives with respect to the columns
/// and to the coordinates of the tensor, and residuals, not whitened.
pub(crate) fn rows(
    stretch: &Stretch,
    noise: &[Vector3<f64>],
    columns: &[Column],
    origin: &Unknowns,
    tests: &TestFunctions,
) -> Vec<f64> {
    let terms = terms_of(columns, origin, stretch);
    let moments = Moments::new(stretch, noise, tests);
    let width = columns.len() + 6;
    let mut rows = vec![0.0; 3 * tests.count * width];
    // columns that act on the samples one by one, of which one at a time is kept beside the rows
    let groups = || groups(stretch, noise, tests.radius);
    let mut is_put: Vec<bool> = columns.iter().map(|column| !column.acts_on(stretch)).collect();
    for (k, column) in columns.iter().enumerate().filter(|(_, column)| column.acts_on(stretch)) {
        let Some(change) = column.effect().sample_change(&terms) else { continue };
        is_put[k] = true;
        let changed = changed(groups(), &terms, tests, change);
        for (row, value) in rows.chunks_exact_mut(width).zip(changed.iter().flat_map(Vector3::iter)) {
            row[k] = *value;
            row[width - 1] += value * origin.c[k];
        }
    }
    let squared = Squared::new(stretch, noise, &terms, tests, columns);
    for m in 0..tests.count {
        let inputs = moments.inputs.get(m);
        let area = moments.area(m);
        let motion = Corrected::new(&terms, &moments.motion(m), area);
        let readings = Corrected::new(&terms, &moments.readings(m), area);
        let put_already = Vector3::from_fn(|p, _| rows[(3 * m + p) * width + width - 1]);
        let mut residual = readings.residual(&terms, inputs) + put_already;
        let by_square = squared.as_ref().map_or(Vector3::zeros(), |sums| sums.motion[m]);
        if let Some(sums) = &squared {
            residual += terms.j * sums.readings[m] * terms.quadratic;
        }
        let mut put = |column: usize, values: Vector3<f64>| {
            for p in 0..3 {
                rows[(3 * m + p) * width + column] = values[p];
            }
        };
        let equation = Equation { terms: &terms, motion: &motion, inputs, by_square };
        for (k, column) in columns.iter().enumerate().filter(|(k, _)| !is_put[*k]) {
            let own = squared.as_ref().and_then(|sums| sums.sensor[k].get(m));
            let by_sensor = own.map_or(Vector3::zeros(), |sum| terms.j * sum * terms.quadratic);
            put(k, column.effect().derivative(&equation) + by_sensor);
        }
        for k in 0..5 {
            let b = basis(k);
            let drag = motion.value * terms.drag + by_square * terms.quadratic;
            let own = b * (drag - motion.slope) + crossed(&motion.square, &b);
            put(columns.len() + k, own);
        }
        put(columns.len() + 5, residual);
    }
    rows
}

/// What the equations of each test change with a change of the rates, given at a group of samples and its rate.
fn changed(
    groups: impl Iterator<Item = Group>,
    terms: &Terms,
    tests: &TestFunctions,
    change: SampleChange<'_>,
) -> Vec<Vector3<f64>> {
    let mut sums = vec![Vector3::zeros(); tests.count];
    for group in groups {
        let w = terms.rate(&group.reading);
        let change = change(&group, &w) * group.weight;
        let (by_slope, by_value) = (terms.j * change, terms.by_rate(&w, &group.wheel) * change);
        for (m, slope, value) in Seen::new(tests, group.time).each() {
            sums[m] += by_value * value - by_slope * slope;
        }
    }
    sums
}
