//! The weak equations of one stretch, linearised.

use crate::columns::model::terms_of;
use multiversion::multiversion;
use nalgebra::{Matrix3, Vector3};

use crate::columns::model::{Column, Kind, Unknowns, distortion};
use crate::columns::squared::Quadratic;
use crate::physical::coordinates::{Form, basis, symmetric};
use crate::signal::banded::Banded;
use crate::signal::covariance::{Covariance, Levels};
use crate::signal::moments::{Group, Inputs, Moments, Sums, groups};
use crate::signal::stretch::Stretch;
use crate::signal::terms::{Terms, cross_derivative, slope};
use crate::signal::test_functions::{Seen, TestFunctions};
use crate::solve::driven::take_out;

/// Σ v × B v from S = Σ v vᵀ; of an S that is not symmetric, Σ v × B u from Σ v uᵀ.
fn crossed(s: &Matrix3<f64>, b: &Matrix3<f64>) -> Vector3<f64> {
    let p = s * b.transpose();
    Vector3::new(p[(1, 2)] - p[(2, 1)], p[(2, 0)] - p[(0, 2)], p[(0, 1)] - p[(1, 0)])
}

/// The weak equations of one stretch, linearised at samples `rates` − `noise`, a tensor and values of the columns.
///
/// Rows hold the derivatives with respect to the columns, to the coordinates of the tensor, and the residual.
pub(crate) struct Linearised {
    pub(crate) tests: TestFunctions,
    /// Numbers in a row.
    pub(crate) width: usize,
    /// Row by row, not whitened.
    pub(crate) rows: Vec<f64>,
    /// What the unknowns make of torque and sensor.
    pub(crate) terms: Terms,
    /// Where it was linearised.
    pub(crate) origin: Unknowns,
}

/// Equations that are whitened by the covariance of their noise.
pub(crate) struct Whitened {
    factor: Banded,
    pub(crate) levels: Levels,
    pub(crate) width: usize,
    pub(crate) rows: Vec<f64>,
}

impl Linearised {
    pub(crate) fn new(
        stretch: &Stretch,
        noise: &[Vector3<f64>],
        columns: &[Column],
        origin: Unknowns,
        tests: TestFunctions,
    ) -> Self {
        let terms = terms_of(columns, &origin, stretch);
        let rows = rows(stretch, noise, columns, &origin, &tests);
        Linearised { tests, width: columns.len() + 6, rows, terms, origin }
    }

    /// The covariance of the equations, which were linearised at the samples of `stretch` less their `noise`.
    pub(crate) fn covariance(&self, stretch: &Stretch, noise: &[Vector3<f64>]) -> Covariance {
        Covariance::new(stretch, noise, &self.terms, &self.tests)
    }

    /// The equations whitened by the factor of the covariance of their residuals at `levels`; with `driven` columns the
    /// effect of torque noise is taken out of their derivatives.
    pub(crate) fn whitened(&self, factor: Banded, levels: Levels, driven: Option<&[Column]>) -> Whitened {
        let mut rows = self.rows.clone();
        if let Some(columns) = driven {
            take_out(&mut rows, columns, &self.terms.j, &factor, levels, &self.tests);
        }
        factor.forward(&mut rows, self.width);
        Whitened { factor, levels, width: self.width, rows }
    }

    /// Residuals at other unknowns, not whitened.
    pub(crate) fn residuals(&self, at: &Unknowns) -> Vec<f64> {
        residuals(&self.rows, self.width, &self.origin, at)
    }

    /// V of this stretch, at the samples that the equations were linearised at.
    pub(crate) fn inflation(&self, whitened: &Whitened, stretch: &Stretch, noise: &[Vector3<f64>]) -> Form {
        let inverse = whitened.factor.inverse_band();
        let bases: [Matrix3<f64>; 5] = core::array::from_fn(basis);
        let mut sum = Form::zeros();
        for group in groups(stretch, noise, self.tests.radius) {
            let seen = Seen::new(&self.tests, group.time);
            let [aa, ba, bb] = seen.sums(&inverse);
            let ab = ba.transpose();
            let w = self.terms.rate(&group.reading);
            let drag = Matrix3::identity() * self.terms.drag + slope(&w) * self.terms.quadratic;
            let k = bases.map(|b| cross_derivative(&b, &w) + b * drag);
            // Σ tr Z D_l D_kᵀ with D_k = −φ' B_k + φ K_k
            for l in 0..5 {
                let from_slope = bases[l] * aa - k[l] * ba;
                let from_value = k[l] * bb - bases[l] * ab;
                for m in 0..=l {
                    // tr(M Nᵀ) is the entry by entry product
                    sum[(l, m)] += group.square * (from_slope.dot(&bases[m]) + from_value.dot(&k[m]));
                }
            }
        }
        sum.fill_upper_triangle_with_lower_triangle();
        sum * whitened.levels.white
    }
}

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
    let is_put = |column: &Column| {
        matches!(column.kind, Kind::Skew(_) | Kind::Walk { .. }) || !column.acts_on(stretch)
    };
    for (k, column) in columns.iter().enumerate().filter(|(_, column)| column.acts_on(stretch)) {
        let changed = match column.kind {
            Kind::Skew(axis) => skewed(groups(), &terms, tests, axis),
            Kind::Walk { axis, from, until } => {
                let share = |time: f64| ((time - from) / (until - from)).clamp(0.0, 1.0);
                let change = |group: &Group, _: &Vector3<f64>| Vector3::ith(axis, -share(group.time));
                changed(groups(), &terms, tests, change)
            }
            _ => continue,
        };
        for (row, value) in rows.chunks_exact_mut(width).zip(changed.iter().flat_map(Vector3::iter)) {
            row[k] = *value;
            row[width - 1] += value * origin.c[k];
        }
    }
    let quadratic = Quadratic::new(stretch, noise, &terms, tests, columns);
    for m in 0..tests.count {
        let inputs = moments.inputs.get(m);
        let area = moments.area(m);
        let motion = Corrected::new(&terms, &moments.motion(m), area);
        let readings = Corrected::new(&terms, &moments.readings(m), area);
        let put_already = Vector3::from_fn(|p, _| rows[(3 * m + p) * width + width - 1]);
        let mut residual = readings.residual(&terms, inputs) + put_already;
        let by_square = quadratic.as_ref().map_or(Vector3::zeros(), |sums| sums.motion[m]);
        if let Some(sums) = &quadratic {
            residual += terms.j * sums.readings[m] * terms.quadratic;
        }
        let mut put = |column: usize, values: Vector3<f64>| {
            for p in 0..3 {
                rows[(3 * m + p) * width + column] = values[p];
            }
        };
        for (k, column) in columns.iter().enumerate().filter(|(_, column)| !is_put(column)) {
            let derivative = match &quadratic {
                Some(_) if column.kind == Kind::Quadratic => terms.j * by_square,
                sums => {
                    let own = sums.as_ref().and_then(|sums| sums.sensor[k].get(m));
                    let by_sensor = own.map_or(Vector3::zeros(), |sum| terms.j * sum * terms.quadratic);
                    motion.derivative(column.kind, &terms, inputs) + by_sensor
                }
            };
            put(k, derivative);
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

impl Whitened {
    /// log |C|.
    pub(crate) fn log_determinant(&self) -> f64 {
        self.factor.log_determinant()
    }

    /// Whitened residuals at `at`.
    pub(crate) fn residuals(&self, origin: &Unknowns, at: &Unknowns) -> Vec<f64> {
        residuals(&self.rows, self.width, origin, at)
    }

    /// Moves `noise` by a share of the way to n̂ = Aᵀ C⁻¹ r, which carries the samples onto the weak equations at `at`.
    pub(crate) fn carry(
        &self,
        part: &Linearised,
        stretch: &Stretch,
        noise: &mut [Vector3<f64>],
        at: &Unknowns,
        share: f64,
    ) {
        let mut multipliers = self.residuals(&part.origin, at);
        self.factor.backward(&mut multipliers);
        let by_axis = [0, 1, 2].map(|axis| {
            let mut own = part.tests.room();
            own.iter_mut().zip(multipliers.iter().skip(axis).step_by(3)).for_each(|(own, l)| *own = *l);
            own
        });
        carry(part, stretch, noise, &by_axis, self.levels.white * share, 1.0 - share);
    }
}

/// The noise times `kept` and w Aᵀ λ times `share`, λ being the multipliers about each axis.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn carry(
    part: &Linearised,
    stretch: &Stretch,
    noise: &mut [Vector3<f64>],
    multipliers: &[Vec<f64>; 3],
    share: f64,
    kept: f64,
) {
    let terms = &part.terms;
    for (i, n) in noise.iter_mut().enumerate() {
        let seen = Seen::new(&part.tests, stretch.times[i]);
        let [x, y, z] = [0, 1, 2].map(|axis| seen.dot(&multipliers[axis]));
        let (slopes, values) = (Vector3::new(x.0, y.0, z.0), Vector3::new(x.1, y.1, z.1));
        let w = terms.rate(&(stretch.rates[i] - *n));
        // Kᵀ of the values
        let mut own = terms.j * (values.cross(&w) - slopes) - values.cross(&(terms.j * w))
            + terms.viscous.tr_mul(&values);
        if let Some(inputs) = &stretch.inputs {
            own -= values.cross(&(inputs.wheel[i] * terms.input));
        }
        if terms.quadratic != 0.0 {
            own += slope(&w) * (terms.j * values) * terms.quadratic;
        }
        *n = *n * kept + own * (stretch.weights[i] * share);
    }
}

pub(crate) fn residuals(rows: &[f64], width: usize, origin: &Unknowns, at: &Unknowns) -> Vec<f64> {
    let columns = origin.c.len();
    let mut step: Vec<f64> = at.c.iter().zip(&origin.c).map(|(a, b)| a - b).collect();
    step.extend((at.x - origin.x).iter());
    rows.chunks_exact(width)
        .map(|row| row[columns + 5] + row.iter().zip(&step).map(|(g, s)| g * s).sum::<f64>())
        .collect()
}

/// The derivative of the equations of each test with respect to the delay of an axis.
fn skewed(
    groups: impl Iterator<Item = Group>,
    terms: &Terms,
    tests: &TestFunctions,
    axis: usize,
) -> Vec<Vector3<f64>> {
    let Some(inverse) = terms.j.try_inverse() else { return vec![Vector3::zeros(); tests.count] };
    changed(groups, terms, tests, |group, w| {
        let momentum = terms.j * w + group.wheel * terms.input;
        let drag = terms.viscous * w + terms.j * w * (w.norm() * terms.quadratic);
        let slope = inverse * (terms.constant - w.cross(&momentum) - drag);
        Vector3::ith(axis, slope[axis])
    })
}

/// What the equations of each test change with a change of the rates, given at a group of samples and its rate.
fn changed(
    groups: impl Iterator<Item = Group>,
    terms: &Terms,
    tests: &TestFunctions,
    change: impl Fn(&Group, &Vector3<f64>) -> Vector3<f64>,
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

/// Sums of the rates ω = P y − b from those of the readings y.
struct Corrected {
    slope: Vector3<f64>,
    value: Vector3<f64>,
    square: Matrix3<f64>,
    mixed: Matrix3<f64>,
    area: f64,
    /// Σ w φ' y.
    slope_of_readings: Vector3<f64>,
    /// Σ w φ y.
    value_of_readings: Vector3<f64>,
    /// Σ w φ y ωᵀ.
    with_readings: Matrix3<f64>,
    /// Σ w φ y hᵀ.
    mixed_of_readings: Matrix3<f64>,
}

impl Corrected {
    fn new(terms: &Terms, s: &Sums, area: f64) -> Corrected {
        let (p, b) = (terms.sensor, terms.offset);
        let turned = p * s.value;
        let value = turned - b * area;
        let with_readings = s.square * p.transpose() - s.value * b.transpose();
        Corrected {
            slope: p * s.slope,
            value,
            square: p * with_readings - b * value.transpose(),
            mixed: p * s.mixed,
            area,
            slope_of_readings: s.slope,
            value_of_readings: s.value,
            with_readings,
            mixed_of_readings: s.mixed,
        }
    }

    fn residual(&self, terms: &Terms, inputs: Option<&Inputs>) -> Vector3<f64> {
        let own = terms.viscous * self.value - terms.j * self.slope - terms.constant * self.area;
        own + crossed(&self.square, &terms.j)
            + inputs.map_or(Vector3::zeros(), |i| self.input(terms, i) * terms.input)
    }

    /// Σ w (−φ' h + φ ω × h − φ τ).
    fn input(&self, terms: &Terms, inputs: &Inputs) -> Vector3<f64> {
        let mixed = self.mixed - terms.offset * inputs.value.transpose();
        crossed(&mixed, &Matrix3::identity()) - inputs.slope - inputs.torque
    }

    /// The derivative of the residual with respect to a column.
    fn derivative(&self, kind: Kind, terms: &Terms, inputs: Option<&Inputs>) -> Vector3<f64> {
        let wheel = |mixed: Matrix3<f64>| crossed(&mixed, &Matrix3::identity()) * terms.input;
        match kind {
            Kind::Drag => terms.j * self.value,
            Kind::Viscous(k) => symmetric(k) * self.value,
            Kind::Constant(k) => Vector3::ith(k, -self.area),
            Kind::Offset(k) => {
                let e = Vector3::ith(k, 1.0);
                let square = e * self.value.transpose() + self.value * e.transpose();
                let own = -(terms.viscous * e) * self.area - crossed(&square, &terms.j);
                own - inputs.map_or(Vector3::zeros(), |i| wheel(e * i.value.transpose()))
            }
            Kind::Input => inputs.map_or(Vector3::zeros(), |i| self.input(terms, i)),
            Kind::Rotor(k) => self.value.cross(&Vector3::ith(k, 1.0)),
            Kind::Skew(_) | Kind::Walk { .. } | Kind::Quadratic => Vector3::zeros(),
            Kind::Scale | Kind::AxisScale(_) | Kind::Misalignment(_) => {
                let q = distortion(kind).unwrap_or_else(Matrix3::zeros);
                let square = q * self.with_readings;
                let own =
                    terms.viscous * (q * self.value_of_readings) - terms.j * (q * self.slope_of_readings);
                own + crossed(&(square + square.transpose()), &terms.j) + wheel(q * self.mixed_of_readings)
            }
        }
    }
}
