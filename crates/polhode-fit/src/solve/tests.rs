//! The weak equations of a stretch summed sample by sample, beside the sums, bands and eliminations that stand for them.

use nalgebra::{DMatrix, DVector, Matrix3, SMatrix, Vector3};
use polhode::num::Random;
use polhode::rotation::{Quat, Vec3};

use crate::columns::axis_scale::AxisScale;
use crate::columns::column::{Column, Unknowns, terms_of};
use crate::columns::constant::Constant;
use crate::columns::drag::Drag;
use crate::columns::input::Input;
use crate::columns::magnet::Magnet;
use crate::columns::misalignment::Misalignment;
use crate::columns::offset::Offset;
use crate::columns::quadratic::Quadratic;
use crate::columns::rotor::Rotor;
use crate::columns::scale::Scale;
use crate::columns::skew::Skew;
use crate::columns::viscous::Viscous;
use crate::columns::walk::Walk;
use crate::columns::wheel_axis::WheelAxis;
use crate::likelihood::motion::{Motion, Start};
use crate::physical::coordinates::{Coordinates, Form, tensor};
use crate::signal::banded::Banded;
use crate::signal::covariance::{Covariance, Levels, Shape};
use crate::signal::stretch::{KnownInputs, Stretch};
use crate::signal::test_functions::{Seen, TestFunctions};
use crate::solve::linearised::Linearised;
use crate::solve::rows::{Rows, rows};
use crate::solve::weak_estimate::Part;

/// Readings of a free motion with wheels and torques beside it, so far apart that no two are taken for one.
struct Example {
    stretch: Stretch,
    tests: TestFunctions,
    noise: Vec<Vector3<f64>>,
    /// Takes coordinates along the axes at the first sample to those at each.
    to_body: Vec<Matrix3<f64>>,
    columns: Vec<Column>,
    at: Unknowns,
}

/// What the unknowns make of torque and sensor: J ω' + ω × (J ω + h) + D ω + c |ω| J ω = τ with ω = P y − b.
struct Law {
    j: Matrix3<f64>,
    d: Matrix3<f64>,
    c: f64,
    constant: Vector3<f64>,
    p: Matrix3<f64>,
    b: Vector3<f64>,
    input: f64,
    of_wheel: Vector3<f64>,
    rotor: Vector3<f64>,
    skew: Vector3<f64>,
    walk: f64,
    magnets: [f64; 2],
}

/// The step of the walk, and the components of magnet and field.
const STEP: Walk = Walk { axis: 1, from: 2.0, until: 5.0 };
const MAGNETS: [(usize, usize); 2] = [(0, 1), (2, 0)];

fn columns() -> Vec<Column> {
    let mut columns = vec![Column::new(Drag, None), Column::new(Quadratic, None), Column::new(Scale, None)];
    for k in 0..3 {
        columns.push(Column::new(Viscous(k), None));
        columns.push(Column::new(Constant(k), None));
        columns.push(Column::new(Offset(k), None));
        columns.push(Column::new(AxisScale(k), None));
        columns.push(Column::new(Misalignment(k), None));
        columns.push(Column::new(WheelAxis(k), None));
        columns.push(Column::new(Rotor(k), None));
    }
    columns.extend([1, 2].map(|k| Column::new(Skew(k), None)));
    columns.push(Column::new(STEP, None).of_segment(3));
    let magnet = |(magnet, field)| Column::new(Magnet { magnet, field, segment: 3 }, None).of_segment(3);
    columns.extend(MAGNETS.map(magnet));
    columns.push(Column::new(Input, None));
    // of another stretch
    columns.push(Column::new(Offset(0), None).of_segment(4));
    columns
}

fn axis(name: &str) -> usize {
    ["x", "y", "z"].iter().position(|letter| name.ends_with(letter)).unwrap()
}

impl Law {
    fn new(columns: &[Column], at: &Unknowns) -> Law {
        let mut law = Law {
            j: tensor(&at.x),
            d: Matrix3::zeros(),
            c: 0.0,
            constant: Vector3::zeros(),
            p: Matrix3::identity(),
            b: Vector3::zeros(),
            input: 0.0,
            of_wheel: Vector3::zeros(),
            rotor: Vector3::zeros(),
            skew: Vector3::zeros(),
            walk: 0.0,
            magnets: [0.0; 2],
        };
        let mut magnets = law.magnets.iter_mut();
        for (column, &value) in columns.iter().zip(&at.c).filter(|(column, _)| column.segment != Some(4)) {
            match column.label().name {
                "drag" => law.d += law.j * value,
                "quadratic_drag" => law.c += value,
                "scale" => law.p += Matrix3::identity() * value,
                "inverse_trace" => law.input += value,
                "magnet" => *magnets.next().unwrap() += value,
                "walk_y" => law.walk += value,
                "misalignment_yz" => (law.p[(1, 2)], law.p[(2, 1)]) = (value / 2.0, value / 2.0),
                "misalignment_xz" => (law.p[(0, 2)], law.p[(2, 0)]) = (value / 2.0, value / 2.0),
                "misalignment_xy" => (law.p[(0, 1)], law.p[(1, 0)]) = (value / 2.0, value / 2.0),
                name if name.starts_with("drag_") => law.d[(axis(name), axis(name))] += value,
                name if name.starts_with("scale_") => law.p[(axis(name), axis(name))] += value,
                name if name.starts_with("torque_") => law.constant[axis(name)] += value,
                name if name.starts_with("offset_") => law.b[axis(name)] += value,
                name if name.starts_with("told_") => law.of_wheel[axis(name)] += value,
                name if name.starts_with("wheel_") => law.rotor[axis(name)] += value,
                name if name.starts_with("skew_") => law.skew[axis(name)] += value,
                name => panic!("{name}"),
            }
        }
        law
    }

    fn wheel(&self, told: &Vector3<f64>) -> Vector3<f64> {
        told * self.input + told.component_mul(&self.of_wheel) + self.rotor
    }
}

impl Example {
    fn new() -> Example {
        let mut random = Random::new(21);
        let mut uniform = move |low: f64, high: f64| random.between(low, high);
        let mut times = vec![0.3];
        for k in 0..70 {
            times.push(times[k] + uniform(0.09, 0.13));
        }
        let columns = columns();
        let x = Coordinates::from_column_slice(&[0.05, 0.02, 0.01, -0.03, 0.02]);
        let mut at = Unknowns::at(x, &columns);
        at.c.iter_mut().for_each(|c| *c = uniform(0.01, 0.06));
        let mut three = || Vector3::from_fn(|_, _| uniform(-1.0, 1.0));
        let start = Start { attitude: Quat::identity(), rate: Vector3::new(0.5, 0.9, -0.3) };
        let motion = Motion::new(&x, &start, 0.0).unwrap();
        let moved: Vec<_> = times.iter().map(|t| motion.at(*t).unwrap()).collect();
        let turn = |q: Quat<f64>| {
            Matrix3::from_columns(&[0, 1, 2].map(|k| q.rotate(Vec3::from(Vector3::ith(k, 1.0))).into()))
        };
        let first = turn(moved[0].attitude);
        let to_body = moved.iter().map(|moved| turn(moved.attitude).transpose() * first).collect();
        let law = Law::new(&columns, &at);
        let inverse = law.p.try_inverse().unwrap();
        let noise: Vec<Vector3<f64>> = times.iter().map(|_| three() * 0.02).collect();
        let rates =
            moved.iter().zip(&noise).map(|(moved, noise)| inverse * (moved.rate + law.b) + noise).collect();
        let wheel = times.iter().map(|_| three()).collect();
        let torque = times.iter().map(|_| three()).collect();
        let inputs = Some(KnownInputs { wheel, torque });
        let stretch = Stretch { inputs, index: 3, ..Stretch::new(times, rates) };
        let tests = TestFunctions::new(&stretch, 1.0).unwrap();
        Example { stretch, tests, noise, to_body, columns, at }
    }

    /// ω of each sample, at readings less `share` of the noise; late axes and the walk of the offset are taken into account to first
    /// order.
    fn rates(&self, law: &Law, share: f64) -> Vec<Vector3<f64>> {
        let inputs = self.stretch.inputs.as_ref().unwrap();
        let inverse = law.j.try_inverse().unwrap();
        let each = self.stretch.rates.iter().zip(&self.noise).enumerate();
        each.map(|(i, (reading, noise))| {
            let w = law.p * (reading - noise * share) - law.b;
            let momentum = law.j * w + law.wheel(&inputs.wheel[i]) - law.rotor;
            let drag = law.d * w + law.j * w * (law.c * w.norm());
            let slope = inverse * (law.constant - w.cross(&momentum) - drag);
            let walked = ((self.stretch.times[i] - STEP.from) / (STEP.until - STEP.from)).clamp(0.0, 1.0);
            w + slope.component_mul(&law.skew) - Vector3::ith(STEP.axis, law.walk * walked)
        })
        .collect()
    }

    /// Σ w (−φ' (J ω + h) + φ (ω × (J ω + h) + D ω + c |ω| J ω − τ)) of each test function.
    fn residuals(&self, law: &Law, rates: &[Vector3<f64>]) -> DVector<f64> {
        let inputs = self.stretch.inputs.as_ref().unwrap();
        let mut sums = DVector::zeros(3 * self.tests.count);
        for (i, w) in rates.iter().enumerate() {
            let momentum = law.j * w + law.wheel(&inputs.wheel[i]);
            let drag = law.d * w + law.j * w * (law.c * w.norm());
            let mut torque = law.constant + inputs.torque[i] * law.input;
            for ((magnet, field), value) in MAGNETS.into_iter().zip(law.magnets) {
                torque += Vector3::ith(magnet, value).cross(&self.to_body[i].column(field));
            }
            let pushed = w.cross(&momentum) + drag - torque;
            for (m, slope, value) in Seen::new(&self.tests, self.stretch.times[i]).each() {
                let mut own = sums.fixed_rows_mut::<3>(3 * m);
                own += (pushed * value - momentum * slope) * self.stretch.weights[i];
            }
        }
        sums
    }

    /// The unknowns, but for what acts to first order alone: late axes, the walk, magnets and momenta inside the body.
    fn at_zero(&self) -> Unknowns {
        let linear = ["skew", "walk", "magnet", "wheel"];
        let is_linear = |column: &Column| linear.iter().any(|name| column.label().name.starts_with(name));
        let mut at = self.at.clone();
        at.c.iter_mut()
            .zip(&self.columns)
            .filter(|(_, column)| is_linear(column))
            .for_each(|(c, _)| *c = 0.0);
        at
    }

    fn moved(&self, k: usize, by: f64) -> DVector<f64> {
        let mut at = self.at_zero();
        match k.checked_sub(self.columns.len()) {
            Some(k) => at.x[k] += by,
            None => at.c[k] += by,
        }
        let law = Law::new(&self.columns, &at);
        self.residuals(&law, &self.rates(&law, 1.0))
    }

    /// The derivative of the residuals with respect to a column or a coordinate.
    fn derivative(&self, k: usize) -> DVector<f64> {
        (self.moved(k, 1e-5) - self.moved(k, -1e-5)) / 2e-5
    }

    /// The residuals where their noise counts to first order.
    fn linear_in_noise(&self) -> DVector<f64> {
        let law = Law::new(&self.columns, &self.at_zero());
        let at = |share: f64| self.residuals(&law, &self.rates(&law, share));
        at(1.0) + (at(1.0 - 1e-3) - at(1.0 + 1e-3)) / 2e-3
    }

    /// A: the derivatives of all residuals with respect to the rate of each sample.
    fn by_rates(&self, x: &Coordinates) -> Vec<DMatrix<f64>> {
        let at = Unknowns { x: *x, ..self.at_zero() };
        let law = Law::new(&self.columns, &at);
        let rates = self.rates(&law, 1.0);
        let each = (0..rates.len()).map(|i| {
            let column = |k: usize| {
                let moved = |by: f64| {
                    let mut rates = rates.clone();
                    rates[i][k] += by;
                    self.residuals(&law, &rates)
                };
                (moved(1e-4) - moved(-1e-4)) / 2e-4
            };
            DMatrix::from_columns(&[column(0), column(1), column(2)])
        });
        each.collect()
    }

    fn linearised(&self) -> Linearised {
        let (columns, at) = (&self.columns, self.at.clone());
        Linearised::new(&self.stretch, &self.noise, columns, at, self.tests.clone())
    }

    fn covariance(&self) -> Covariance {
        self.linearised().covariance(&self.stretch, &self.noise)
    }

    /// C, sample by sample.
    fn dense(&self, levels: Levels) -> DMatrix<f64> {
        let size = 3 * self.tests.count;
        let by_rates = self.by_rates(&self.at.x);
        let of_rates = by_rates.iter().fold(DMatrix::zeros(size, size), |sum, a| sum + a * a.transpose());
        of_rates * levels.white + self.torque(levels)
    }

    /// T: what torque noise adds to it.
    fn torque(&self, levels: Levels) -> DMatrix<f64> {
        let (radius, centres, j) = (self.tests.radius, self.tests.centres(), tensor(&self.at.x));
        let phi = |t: f64, centre: f64| {
            let u = (t - centre) / radius;
            if u.abs() < 1.0 { (1.0 - u * u) * (1.0 - u * u) * (1.0 - u * u) * (1.0 - u * u) } else { 0.0 }
        };
        let shape = match levels.shape {
            Shape::Moments => j * j,
            Shape::Alike => Matrix3::identity() / 9.0,
        };
        let overlap = |a: f64, b: f64| {
            let at = |i: usize| a - radius + (i as f64 + 0.5) * radius / 500.0;
            (0..1000).map(|i| phi(at(i), a) * phi(at(i), b)).sum::<f64>() * radius / 500.0
        };
        let overlaps = DMatrix::from_fn(centres.len(), centres.len(), |m, n| overlap(centres[m], centres[n]));
        overlaps.kronecker(&(shape * levels.torque))
    }
}

/// A factor as a dense matrix.
fn lower(l: &Banded, size: usize) -> DMatrix<f64> {
    DMatrix::from_fn(size, size, |i, k| if i >= k { l.get(i, k) } else { 0.0 })
}

const NOISY: Levels = Levels { white: 1.7, torque: 0.3, shape: Shape::Moments };

/// Each column of the equations is the derivative of their residuals, the residual itself linear in the noise.
#[test]
fn rows_are_those_of_the_equations_sample_by_sample() {
    let example = Example::new();
    let (count, width) = (example.columns.len(), example.columns.len() + 6);
    let rows = example.linearised().rows;
    assert_eq!(rows.len(), 3 * example.tests.count * width);
    let column =
        |k: usize| DVector::from_iterator(rows.len() / width, rows.iter().skip(k).step_by(width).copied());
    let mut residual = example.linear_in_noise();
    for k in 0..count + 5 {
        let expected = example.derivative(k);
        let name = example.columns.get(k).map_or("tensor", |column| column.label().name);
        // attitudes by a rule of the fourth order in steps of a tenth
        let near = if name == "magnet" { 1e-4 } else { 1e-8 };
        let apart = (column(k) - &expected).amax();
        assert!(apart < near, "{name} {k}: {apart:e} of {:e}", expected.amax());
        let other = example.columns.get(k).is_some_and(|column| column.segment == Some(4));
        assert!(expected.amax() > 1e-3 || other, "{name}");
        // to first order alone
        if ["skew", "walk", "magnet"].iter().any(|kind| name.starts_with(kind)) {
            residual += expected * example.at.c[k];
        }
    }
    let apart = (column(width - 1) - residual).amax();
    assert!(apart < 1e-5, "{apart:e}");
}

/// The rows of some tests are to the last bit what they are among those of all.
#[test]
fn rows_of_some_tests_are_those_among_all() {
    let Example { stretch, tests, noise, columns, at, .. } = Example::new();
    let all = rows(&stretch, &noise, &columns, &at, &tests);
    let each = Rows::new(&stretch, &noise, &columns, &at, &tests);
    for together in [1, 7, tests.count] {
        let blocks = (0..tests.count).step_by(together).map(|k| each.of(k..tests.count.min(k + together)));
        assert_eq!(blocks.flatten().collect::<Vec<f64>>(), all, "{together}");
    }
}

/// Rows that are made and whitened block by block are those of one block to the last bit, with torque noise and without, whether all columns have
/// a value or some are zero.
#[test]
fn whitened_blocks_are_those_of_the_whole() {
    for kept in [1, 2] {
        let mut example = Example::new();
        example.at.c.iter_mut().enumerate().filter(|(k, _)| k % kept > 0).for_each(|(_, c)| *c = 0.0);
        let louder = Levels { white: 1.7, ..Levels::WHITE };
        for levels in [Levels::WHITE, louder, NOISY, Levels { shape: Shape::Alike, ..NOISY }] {
            let factor = example.covariance().into_factor(levels).unwrap();
            let linearised = example.linearised();
            let expected = linearised.whitened(factor, levels, Some(&example.columns)).rows;
            let by_rates = linearised.whitened_by_rates(&example.stretch, &example.noise).unwrap();
            assert_eq!(by_rates == expected, levels == Levels::WHITE);
            let (noise, rows, left) = (example.noise.clone(), Vec::new(), Vec::new());
            let part = Part { stretch: 0, linearised, rows, left, levels, log_determinant: 0.0, noise };
            for together in [1, 5, example.tests.count] {
                let mut found = Vec::new();
                let take = |rows: &[f64]| found.extend_from_slice(rows);
                part.with_columns(&example.stretch, &example.columns, &example.at, together, take).unwrap();
                assert_eq!(found, expected, "{levels:?} {together}");
            }
        }
    }
}

/// The band is Σ A Aᵀ of the derivatives A of the residuals with respect to the samples, and the overlaps of the test functions.
#[test]
fn the_covariance_is_that_of_the_samples() {
    let example = Example::new();
    let size = 3 * example.tests.count;
    for levels in [Levels::WHITE, NOISY, Levels { shape: Shape::Alike, ..NOISY }] {
        let dense = example.dense(levels);
        let l = example.covariance().into_factor(levels).unwrap();
        let own = lower(&l, size);
        let apart = (&own * own.transpose() - &dense).amax() / dense.amax();
        assert!(apart < 1e-7, "{levels:?}: {apart:e}");
        let cholesky = dense.clone().cholesky().unwrap();
        let e = DVector::from_fn(size, |k, _| 1.0 - (k % 7) as f64 / 3.0);
        let (determinant, squares) = example.covariance().likelihood(e.as_slice(), levels).unwrap();
        let expected = 2.0 * cholesky.l().diagonal().map(libm::log).sum();
        assert!((determinant - expected).abs() < 1e-5, "{levels:?}: {determinant} {expected}");
        assert!((squares / e.dot(&cholesky.solve(&e)) - 1.0).abs() < 1e-5, "{levels:?}");
    }
    let (white, torque) = example.covariance().mean_variances();
    assert!((white * size as f64 / example.dense(Levels::WHITE).trace() - 1.0).abs() < 1e-7);
    // over nine, as that of a sphere
    let alike = example.torque(Levels { white: 0.0, torque: 1.0, shape: Shape::Alike });
    assert!((torque * size as f64 / alike.trace() - 1.0).abs() < 1e-9);
}

/// Samples less Aᵀ C⁻¹ r meet the equations, but for the square of what they were moved by.
#[test]
fn carried_samples_meet_the_equations() {
    let mut example = Example::new();
    // what acts to first order alone stays out of it
    example.at = example.at_zero();
    let part = example.linearised();
    let law = Law::new(&example.columns, &example.at);
    // the errors of scale of the sensor are small beside its readings, and the carried noise is that of the rates
    let off = (law.p - Matrix3::identity()).amax();
    let before = example.linear_in_noise().norm();
    let whitened =
        part.whitened(example.covariance().into_factor(Levels::WHITE).unwrap(), Levels::WHITE, None);
    let mut noise = example.noise.clone();
    whitened.carry(&part, &example.stretch, &mut noise, &example.at, 1.0);
    // Aᵀ C⁻¹ r by the dense equations
    let cholesky = example.dense(Levels::WHITE).cholesky().unwrap();
    let multipliers = cholesky.solve(&example.linear_in_noise());
    for (a, found) in example.by_rates(&example.at.x).iter().zip(&noise) {
        assert!((a.tr_mul(&multipliers) - found).amax() < 1e-6, "{found}");
    }
    // by a third of the way
    let mut partly = example.noise.clone();
    whitened.carry(&part, &example.stretch, &mut partly, &example.at, 1.0 / 3.0);
    for ((old, new), partly) in example.noise.iter().zip(&noise).zip(&partly) {
        assert!((old + (new - old) / 3.0 - partly).amax() < 1e-12);
    }
    example.noise = noise;
    let after = example.residuals(&law, &example.rates(&law, 1.0)).norm();
    assert!(off < 0.15 && after < 0.25 * before, "{before:e} {after:e}");
}

/// The derivatives by the tensor and by errors of scale lose B J⁻¹ T C⁻¹ r, and no others do.
#[test]
fn the_effect_of_torque_noise_is_taken_out_of_the_slopes() {
    let example = Example::new();
    let part = example.linearised();
    let (count, width) = (example.columns.len(), part.width);
    for levels in [NOISY, Levels { shape: Shape::Alike, ..NOISY }] {
        let factor = example.covariance().into_factor(levels).unwrap();
        let with = part.whitened(factor.clone(), levels, Some(&example.columns)).rows;
        let without = part.whitened(factor.clone(), levels, None).rows;
        let size = 3 * example.tests.count;
        let l = lower(&factor, size);
        let column = |rows: &[f64], k: usize| {
            DVector::from_iterator(size, rows.iter().skip(k).step_by(width).copied())
        };
        let r = &l * column(&without, width - 1);
        let effect = example.torque(levels) * example.dense(levels).cholesky().unwrap().solve(&r);
        let inverse = tensor(&example.at.x).try_inverse().unwrap();
        let changed = |map: Matrix3<f64>| {
            let each = effect.as_slice().chunks_exact(3).map(|e| map * Vector3::from_column_slice(e));
            DVector::from_iterator(size, each.flat_map(|v| v.iter().copied().collect::<Vec<f64>>()))
        };
        for k in 0..width {
            let taken = &l * (column(&without, k) - column(&with, k));
            let name = example.columns.get(k).map_or("tensor", |column| column.label().name);
            let distorts = name.starts_with("scale") || name.starts_with("misalignment");
            let expected = if (count..count + 5).contains(&k) {
                let mut unit = Coordinates::zeros();
                unit[k - count] = 1.0;
                changed((tensor(&unit) - tensor(&Coordinates::zeros())) * inverse)
            } else if distorts {
                let mut at = Unknowns::at(Coordinates::zeros(), &example.columns);
                at.c[k] = 1.0;
                let q = Law::new(&example.columns, &at).p - Matrix3::identity();
                changed(tensor(&example.at.x) * q * inverse)
            } else {
                DVector::zeros(size)
            };
            assert!((taken - &expected).amax() < 1e-7, "{name} {k}");
            assert!(expected.amax() > 1e-4 || !distorts, "{name}");
        }
    }
}

/// V is what noise in the derivatives adds to the information: Σ tr D_kᵀ C⁻¹ D_l with the derivatives D_k of A by the tensor.
#[test]
fn the_inflation_is_that_of_noise_in_the_derivatives() {
    let mut example = Example::new();
    // drag that all rates share alone depends on the tensor
    example.at = example.at_zero();
    let levels = NOISY;
    let part = example.linearised();
    let whitened = part.whitened(example.covariance().into_factor(levels).unwrap(), levels, None);
    let found = part.inflation(&whitened, &example.stretch, &example.noise);
    let cholesky = example.dense(levels).cholesky().unwrap();
    let slopes: Vec<Vec<DMatrix<f64>>> = (0..5)
        .map(|k| {
            let at = |by: f64| {
                let mut x = example.at.x;
                x[k] += by;
                example.by_rates(&x)
            };
            at(1e-3).iter().zip(at(-1e-3)).map(|(a, b)| (a - b) / 2e-3).collect()
        })
        .collect();
    let entry = |k: usize, l: usize| {
        slopes[k].iter().zip(&slopes[l]).map(|(a, b)| a.dot(&cholesky.solve(b))).sum::<f64>() * levels.white
    };
    let expected = Form::from_fn(entry);
    let apart = (found - expected).amax() / expected.amax();
    assert!(apart < 1e-5, "{apart:e}");
    assert!(terms_of(&example.columns, &example.at, &example.stretch).drag > 0.0);
}

/// The readings of several stretches with columns of some of them and priors, as one dense problem of least squares.
mod least_squares {
    use super::*;
    use crate::physical::nearest::Normal;
    use crate::solve::joint::Joint;
    use crate::solve::stacked::{Pull, Stacked, responses};
    use crate::solve::weak_estimate::WeakEstimate;

    struct Problem {
        rows: Vec<Vec<f64>>,
        columns: Vec<Column>,
        origin: Unknowns,
        deviation: f64,
    }

    impl Problem {
        fn new() -> Problem {
            let mut random = Random::new(5);
            let columns = vec![
                Column::new(Offset(0), Some(0.4)),
                Column::new(Drag, None),
                Column::new(Offset(1), None).of_segment(1),
                Column::new(Scale, Some(0.2)),
            ];
            let width = columns.len() + 6;
            let rows = (0..3).map(|part: usize| {
                let mut rows: Vec<f64> = (0..(20 + 7 * part) * width).map(|_| random.normal()).collect();
                if part != 1 {
                    rows.iter_mut().skip(2).step_by(width).for_each(|entry| *entry = 0.0);
                }
                rows
            });
            let rows = rows.collect();
            let c = vec![0.3, -0.2, 0.5, 0.1];
            let x = Coordinates::from_fn(|_, _| 0.1 * random.normal());
            Problem { rows, columns, origin: Unknowns { x, c }, deviation: 0.7 }
        }

        fn rows(&self) -> Vec<&[f64]> {
            self.rows.iter().map(Vec::as_slice).collect()
        }

        fn stacked(&self) -> Stacked {
            Stacked::new(&self.rows(), &self.columns, &self.origin, self.deviation)
        }

        /// A and e of |A (u − origin) + e|² with the priors among its rows, u = (c, x).
        fn dense(&self) -> (DMatrix<f64>, DVector<f64>) {
            let (count, width) = (self.columns.len(), self.columns.len() + 6);
            let mut all: Vec<Vec<f64>> =
                self.rows.iter().flat_map(|rows| rows.chunks_exact(width).map(<[f64]>::to_vec)).collect();
            for (k, column) in self.columns.iter().enumerate() {
                let Some(prior) = column.prior else { continue };
                let mut row = vec![0.0; width];
                (row[k], row[width - 1]) =
                    (self.deviation / prior, self.deviation / prior * self.origin.c[k]);
                all.push(row);
            }
            let a = DMatrix::from_fn(all.len(), count + 5, |i, k| all[i][k]);
            (a, DVector::from_fn(all.len(), |i, _| all[i][width - 1]))
        }

        fn together(at: &Unknowns) -> DVector<f64> {
            DVector::from_iterator(at.c.len() + 5, at.c.iter().chain(&at.x).copied())
        }

        /// The sum of squares at `u`.
        fn squares(&self, u: &DVector<f64>) -> f64 {
            let (a, e) = self.dense();
            (a * (u - Problem::together(&self.origin)) + e).norm_squared()
        }

        /// The least of A and e, and their information.
        fn solved(&self, further: Option<(&DMatrix<f64>, &DVector<f64>)>) -> (DVector<f64>, DMatrix<f64>) {
            let (a, e) = self.dense();
            let (mut normal, mut right) = (a.tr_mul(&a), a.tr_mul(&e));
            if let Some((a, e)) = further {
                normal += a.tr_mul(a);
                right += a.tr_mul(e);
            }
            let step = normal.clone().cholesky().unwrap().solve(&-right);
            (Problem::together(&self.origin) + step, normal)
        }
    }

    /// The columns without a prior have one that says nothing: a thousand deviations.
    const NEAR: f64 = 1e-5;

    fn alike(found: &Unknowns, expected: &DVector<f64>) -> bool {
        (Problem::together(found) - expected).amax() < NEAR
    }

    #[test]
    fn a_triangle_holds_all_that_its_rows_say() {
        let problem = Problem::new();
        let (stacked, count) = (problem.stacked(), problem.columns.len());
        let (best, normal) = problem.solved(None);
        assert!(alike(&stacked.minimiser().unwrap(), &best));
        assert!((stacked.squares / problem.squares(&best) - 1.0).abs() < NEAR);
        // 81 rows of equations beyond two columns without a prior
        assert_eq!(stacked.rows, 81 - 2);
        let covariance = normal.clone().cholesky().unwrap().inverse();
        let of_tensor: Form = covariance.fixed_view::<5, 5>(count, count).into_owned();
        let information = of_tensor.cholesky().unwrap().inverse();
        assert!((stacked.information() - information).amax() < NEAR * information.amax());
        let factor = stacked.joint_factor().unwrap();
        assert!((&factor * factor.transpose() - covariance).amax() < NEAR);
        assert!((stacked.whole().tr_mul(&stacked.whole()) - &normal).amax() < NEAR * normal.amax());
        // |R u + r|² is least where the rows are
        let at_zero = stacked.whole() * &best + stacked.at_zero();
        assert!(at_zero.amax() < 1e-4, "{}", at_zero.amax());

        // the columns at their best for another tensor, and what is then left
        let x = best.fixed_rows::<5>(count).into_owned() + Coordinates::new(0.1, -0.2, 0.05, 0.3, 0.1);
        let with = stacked.with_columns(x).unwrap();
        let own = normal.view((0, 0), (count, count)).into_owned();
        let mixed = normal.view((0, count), (count, 5)).into_owned();
        let follows = own.cholesky().unwrap().solve(&(mixed * (best.fixed_rows::<5>(count) - x)));
        let expected = best.rows(0, count) + follows;
        assert!((DVector::from_column_slice(&with.c) - expected).amax() < NEAR && with.x == x);
        let squares = problem.squares(&Problem::together(&with));
        assert!((stacked.squares_at(&x) / squares - 1.0).abs() < NEAR);

        let variance = 0.3;
        let excess = (stacked.squares / variance / (79.0 - 5.0)).max(1.0);
        assert!((stacked.excess(variance) / excess - 1.0).abs() < 1e-12 && excess > 1.0);
        assert_eq!(stacked.excess(100.0), 1.0);
    }

    #[test]
    fn pulls_and_ridges_are_further_rows() {
        let problem = Problem::new();
        let (stacked, count) = (problem.stacked(), problem.columns.len());
        let root = Form::from_fn(|i, k| if i <= k { 1.0 + (i + 2 * k) as f64 } else { 0.0 });
        let centre = Coordinates::new(0.3, 0.1, -0.2, 0.0, 0.4);
        let mut further = DMatrix::zeros(5, count + 5);
        further.view_mut((0, count), (5, 5)).copy_from(&root);
        let left = DVector::from_column_slice((root * (problem.origin.x - centre)).as_slice());
        let (best, _) = problem.solved(Some((&further, &left)));
        assert!(alike(&stacked.pulled(&Pull { root, centre }).unwrap(), &best));

        let ridge = 2.5_f64;
        further.view_mut((0, count), (5, 5)).copy_from(&(Form::identity() * ridge.sqrt()));
        let left = DVector::from_column_slice((problem.origin.x * ridge.sqrt()).as_slice());
        let (best, _) = problem.solved(Some((&further, &left)));
        assert!(alike(&stacked.ridge(ridge).unwrap(), &best));
        assert!(!alike(&stacked.minimiser().unwrap(), &best));
    }

    /// An error that the fit takes to be zero moves the tensor as an error in the readings in proportion to its column does.
    #[test]
    fn responses_are_those_to_errors_in_the_readings() {
        let problem = Problem::new();
        let (count, width) = (problem.columns.len(), problem.columns.len() + 6);
        let errors = [Column::new(Rotor(0), None), Column::new(Rotor(1), None)];
        let mut random = Random::new(8);
        let wider: Vec<Vec<f64>> = problem
            .rows
            .iter()
            .map(|rows| {
                let each = rows.chunks_exact(width);
                each.flat_map(|row| [random.normal(), random.normal()].into_iter().chain(row.iter().copied()))
                    .collect()
            })
            .collect();
        let all: Vec<Column> = errors.iter().chain(&problem.columns).copied().collect();
        let rows: Vec<&[f64]> = wider.iter().map(Vec::as_slice).collect();
        let found = responses(&rows, &all, 2, problem.deviation).unwrap();
        assert_eq!(found.len(), 2);
        for (k, found) in found.iter().enumerate() {
            // an error of 1 that nobody knows of leaves minus its column
            let mut moved = Problem::new();
            for (own, wide) in moved.rows.iter_mut().zip(&wider) {
                for (own, wide) in own.chunks_exact_mut(width).zip(wide.chunks_exact(width + 2)) {
                    own[width - 1] -= wide[k];
                }
            }
            let (before, after) = (problem.solved(None).0, moved.solved(None).0);
            let expected = (after - before).fixed_rows::<5>(count).into_owned();
            assert!((found - expected).amax() < NEAR, "{found} {expected}");
        }
    }

    #[test]
    fn another_least_with_its_information_takes_the_place_of_the_rows() {
        let problem = Problem::new();
        let (best, normal) = problem.solved(None);
        let mut at = problem.origin.clone();
        at.c[1] += 0.3;
        at.x[2] -= 0.2;
        let information = normal * 2.0 + DMatrix::identity(best.len(), best.len());
        let moved = problem.stacked().at_least(&at, &information).unwrap();
        assert!((moved.whole().tr_mul(&moved.whole()) - &information).amax() < 1e-10 * information.amax());
        let least = moved.minimiser().unwrap();
        assert!((Problem::together(&least) - Problem::together(&at)).amax() < 1e-12);
        assert_eq!((moved.squares, moved.rows), (problem.stacked().squares, problem.stacked().rows));
    }

    fn weak(problem: &Problem) -> WeakEstimate {
        let stacked = problem.stacked();
        let (root, squares) = (stacked.root, stacked.squares);
        let at = stacked.minimiser().unwrap();
        let plain = WeakEstimate::plain(problem.columns.clone(), at, stacked.rows);
        WeakEstimate { root, squares, stacked: Some(stacked), ..plain }
    }

    /// Of some columns and the tensor the marginal distribution; where these are told, the other columns follow.
    #[test]
    fn kept_columns_and_tensor_are_a_marginal_distribution() {
        let problem = Problem::new();
        let (best, normal) = problem.solved(None);
        let keeps = |column: &Column| matches!(column.label().name, "drag" | "scale");
        let deviation = 0.6;
        let joint = Joint::new(&weak(&problem), keeps, deviation).unwrap();
        assert_eq!(joint.kept, [1, 3]);
        let places = [1, 3, 4, 5, 6, 7, 8];
        let covariance = normal.clone().cholesky().unwrap().inverse() * (deviation * deviation);
        let marginal = DMatrix::from_fn(7, 7, |i, k| covariance[(places[i], places[k])]);
        let of = |told: &Normal| {
            let factor = told.root.clone().try_inverse().unwrap();
            &factor * factor.transpose()
        };
        assert!((of(&joint.told) - &marginal).amax() < NEAR * marginal.amax());
        assert!((0..7).all(|k| (joint.told.centre[k] - best[places[k]]).abs() < NEAR));

        let others = [best[1] + 0.2, best[3] - 0.1];
        let x = best.fixed_rows::<5>(4).into_owned() + Coordinates::new(0.05, 0.1, -0.1, 0.0, 0.2);
        let at = joint.unknowns(&others, x);
        // E[rest | kept] with the covariance of all
        let step = DVector::from_iterator(7, [0.2, -0.1, 0.05, 0.1, -0.1, 0.0, 0.2]);
        let told = marginal.clone().cholesky().unwrap().solve(&step);
        for rest in [0, 2] {
            let mixed = DVector::from_fn(7, |k, _| covariance[(rest, places[k])]);
            assert!((at.c[rest] - best[rest] - mixed.dot(&told)).abs() < NEAR, "{rest}");
        }
        assert_eq!(([at.c[1], at.c[3]], at.x), (others, x));
        assert!((joint.moved(&at).column(0) - step).amax() < NEAR);

        // M Mᵀ is added to the covariance
        let more = DMatrix::from_fn(7, 2, |i, k| 0.3 * (i + 1) as f64 - 0.5 * k as f64);
        let added = joint.of_tensor(&(Form::identity() * 4.0));
        let widened = joint.widened(&more).unwrap();
        let expected = &marginal + &more * more.transpose();
        assert!((of(&widened.told) - &expected).amax() < 1e-4 * expected.amax());
        let square = &added * added.transpose();
        assert!((square.view((2, 2), (5, 5)) - Form::identity() * 4.0).amax() < 1e-14);
        assert!(square.view((0, 0), (2, 7)).amax() == 0.0);
        let same = widened.widened(&DMatrix::zeros(7, 1)).unwrap();
        assert!((of(&same.told) - expected).amax() < 1e-3);
    }

    /// The singular values of R less what is in doubt of it, and R without some of the columns.
    #[test]
    fn what_is_in_doubt_is_taken_off_the_spectrum() {
        let problem = Problem::new();
        let mut weak = weak(&problem);
        weak.doubt = Form::from_fn(|i, k| 0.3 / (1.0 + (i + k) as f64));
        let (values, directions) = weak.spectrum().unwrap();
        let information = weak.root.tr_mul(&weak.root);
        let doubt = weak.doubt.tr_mul(&weak.doubt);
        for k in 0..5 {
            let v: SMatrix<f64, 5, 1> = directions.column(k).into_owned();
            let sure = v.dot(&(information * v)) - v.dot(&(doubt * v));
            assert!((v.norm() - 1.0).abs() < 1e-12 && (values[k] * values[k] / sure - 1.0).abs() < 1e-10);
            assert!(k == 0 || values[k] <= values[k - 1]);
        }
        assert_eq!((weak.dof(), weak.misfit(0.5)), (74, weak.squares / 0.5 / 74.0));
        assert!((weak.expected_misfit() - 1.0 - 5.0 * (2.0_f64 / 74.0).sqrt()).abs() < 1e-14);
    }
}
