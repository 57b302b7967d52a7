//! The rows of the weak equations of one stretch.

use core::ops::Range;

use nalgebra::{Matrix3, Vector3};
use polhode::record::both;
use polhode::rotation::Quat;

use crate::columns::column::{Column, Unknowns, terms_of};
use crate::columns::effect::SampleChange;
use crate::columns::equation::{Corrected, Equation, crossed};
use crate::columns::squared::Squared;
use crate::physical::coordinates::basis;
use crate::signal::moments::{Moments, group, ranges};
use crate::signal::stretch::Stretch;
use crate::signal::terms::Terms;
use crate::signal::test_functions::{Seen, TestFunctions};
use crate::signal::zeros::zeros;
use crate::thresholds::radius::LONG;

/// The equations of a stretch, linearised at samples `rates` − `noise`: derivatives with respect to the columns and to the
/// coordinates of the tensor, and residuals, not whitened.
///
/// The sums that all of them are made of are here; the rows of some tests are to the last bit what they are among those of all.
pub(crate) struct Rows<'a> {
    stretch: &'a Stretch,
    noise: &'a [Vector3<f64>],
    columns: &'a [Column],
    origin: &'a Unknowns,
    tests: &'a TestFunctions,
    terms: Terms,
    moments: Moments,
    squared: Option<Squared>,
    /// Columns that act on the stretch.
    acting: Vec<usize>,
    /// Samples of the groups, where columns act on these one by one, and how the body has turned at each, where one asks for it.
    groups: Vec<Range<usize>>,
    turned: Vec<Quat<f64>>,
}

/// The same of all tests row by row.
pub(crate) fn rows(
    stretch: &Stretch,
    noise: &[Vector3<f64>],
    columns: &[Column],
    origin: &Unknowns,
    tests: &TestFunctions,
) -> Vec<f64> {
    let rows = Rows::new(stretch, noise, columns, origin, tests);
    let width = columns.len() + 6;
    let mut all = zeros(3 * tests.count * width);
    // the halves of a long stretch side by side, whatever the machine is
    let long = noise.len() > LONG;
    let split = if long { tests.count / 2 } else { 0 };
    let (before, after) = all.split_at_mut(3 * width * split);
    both(long, || rows.write(before, 0..split), || rows.write(after, split..tests.count));
    all
}

impl<'a> Rows<'a> {
    pub(crate) fn new(
        stretch: &'a Stretch,
        noise: &'a [Vector3<f64>],
        columns: &'a [Column],
        origin: &'a Unknowns,
        tests: &'a TestFunctions,
    ) -> Self {
        let terms = terms_of(columns, origin, stretch);
        let moments = Moments::new(stretch, noise, tests);
        let squared = Squared::new(stretch, noise, &terms, tests, columns);
        let acting: Vec<usize> = (0..columns.len()).filter(|&k| columns[k].acts_on(stretch)).collect();
        let turns = acting.iter().any(|&k| turns(&columns[k]));
        let changes = |&k: &usize| columns[k].effect().sample_change(&terms).is_some();
        let acts = turns || acting.iter().any(changes);
        let groups = if acts { ranges(stretch, tests.radius, 0).collect() } else { Vec::new() };
        let turned = if turns { turned(stretch, noise, &terms, &groups) } else { Vec::new() };
        Rows { stretch, noise, columns, origin, tests, terms, moments, squared, acting, groups, turned }
    }

    /// Those of some tests.
    pub(crate) fn of(&self, own: Range<usize>) -> Vec<f64> {
        let mut rows = zeros(3 * own.len() * (self.columns.len() + 6));
        self.write(&mut rows, own);
        rows
    }

    /// Writes those of some tests into zeros.
    fn write(&self, rows: &mut [f64], own: Range<usize>) {
        let Rows { stretch, columns, terms, moments, squared, .. } = self;
        let width = columns.len() + 6;
        self.add_changes(rows, own.clone());
        for row in rows.chunks_exact_mut(width) {
            row[width - 1] = row.iter().zip(&self.origin.c).map(|(value, c)| value * c).sum();
        }
        let acts_on_samples =
            |column: &Column| column.effect().sample_change(terms).is_some() || turns(column);
        let is_put: Vec<bool> =
            columns.iter().map(|column| !column.acts_on(stretch) || acts_on_samples(column)).collect();
        for (m, rows) in own.zip(rows.chunks_exact_mut(3 * width)) {
            let inputs = moments.inputs.get(m);
            let area = moments.area(m);
            let motion = Corrected::new(terms, &moments.motion(m), area);
            let readings = Corrected::new(terms, &moments.readings(m), area);
            let put_already = Vector3::from_fn(|p, _| rows[p * width + width - 1]);
            let mut residual = readings.residual(terms, inputs) + put_already;
            let by_square = squared.as_ref().map_or(Vector3::zeros(), |sums| sums.motion[m]);
            if let Some(sums) = squared {
                residual += terms.j * sums.readings[m] * terms.quadratic;
            }
            let mut put = |column: usize, values: Vector3<f64>| {
                for p in 0..3 {
                    rows[p * width + column] = values[p];
                }
            };
            let equation = Equation { terms, motion: &motion, inputs, by_square };
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
    }

    /// Adds the columns that act on the samples one by one.
    fn add_changes(&self, rows: &mut [f64], own: Range<usize>) {
        let Rows { stretch, noise, columns, tests, terms, acting, .. } = self;
        let width = columns.len() + 6;
        let changes = acting.iter().filter_map(|&k| Some((k, columns[k].effect().sample_change(terms)?)));
        let changes: Vec<(usize, SampleChange<'_>)> = changes.collect();
        let torques = |to_body: &Matrix3<f64>| {
            let each = acting.iter().filter_map(|&k| Some((k, columns[k].effect().torque_at(to_body)?)));
            each.collect::<Vec<(usize, Vector3<f64>)>>()
        };
        let by_attitude = torques(&Matrix3::identity());
        let places = || changes.iter().map(|(k, _)| *k).chain(by_attitude.iter().map(|(k, _)| *k));
        let Some((first, last)) = places().min().zip(places().max()) else { return };
        // by φ' and by φ, of all columns between the first and the last of these
        let mut sums = vec![[0.0; 6]; last + 1 - first];
        let seen = |sample: usize| tests.at(stretch.times[sample]);
        let from = self.groups.partition_point(|range| seen(range.end - 1).end <= own.start);
        for (number, range) in self.groups.iter().enumerate().skip(from) {
            if seen(range.start).start >= own.end {
                break;
            }
            let group = group(stretch, noise, range.clone());
            let w = terms.rate(&group.reading);
            let by_rate = terms.by_rate(&w, &group.wheel);
            for (k, change) in &changes {
                let change = change(&group, &w) * group.weight;
                let (slope, value) = (terms.j * -change, by_rate * change);
                sums[k - first] = [slope.x, slope.y, slope.z, value.x, value.y, value.z];
            }
            for (k, torque) in self.turned.get(number).map(to_body).iter().flat_map(torques) {
                let value = torque * -group.weight;
                sums[k - first] = [0.0, 0.0, 0.0, value.x, value.y, value.z];
            }
            for (m, slope, value) in Seen::new(tests, group.time).each().filter(|(m, ..)| own.contains(m)) {
                for p in 0..3 {
                    let row = &mut rows[(3 * (m - own.start) + p) * width..][first..=last];
                    for (sum, by) in row.iter_mut().zip(&sums) {
                        *sum += by[3 + p] * value + by[p] * slope;
                    }
                }
            }
        }
    }
}

/// Whether a column asks how the body has turned.
fn turns(column: &Column) -> bool {
    column.effect().torque_at(&Matrix3::identity()).is_some()
}

/// What takes coordinates along the axes that the body had at the first group to those that have turned by this.
fn to_body(turned: &Quat<f64>) -> Matrix3<f64> {
    Matrix3::from_columns(&[0, 1, 2].map(|k| turned.rotate_back(Vector3::ith(k, 1.0).into()).into()))
}

/// How the body has turned from the first group of samples to each.
///
/// From one to the next the rate is taken to change evenly: W. Magnus, Commun. Pure Appl. Math. 7 (1954) 649, to the fourth order.
fn turned(
    stretch: &Stretch,
    noise: &[Vector3<f64>],
    terms: &Terms,
    groups: &[Range<usize>],
) -> Vec<Quat<f64>> {
    let mut attitude = Quat::<f64>::identity();
    let mut before: Option<(f64, Vector3<f64>)> = None;
    let each = groups.iter().map(|range| {
        let group = group(stretch, noise, range.clone());
        let (time, w) = (group.time, terms.rate(&group.reading));
        if let Some((last, from)) = before.replace((time, w)) {
            let h = time - last;
            let turn = (from + w) * (0.5 * h) + from.cross(&w) * (h * h / 12.0);
            attitude = (attitude * Quat::exponential(turn.into())).normalized();
        }
        attitude
    });
    each.collect()
}
