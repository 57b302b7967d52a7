//! The Cramér–Rao bound of a record that is planned, with torques and errors of the sensor among the unknowns.

use crate::thresholds::bound::{PARTS_OF_PLAN, STEP_OF_PLAN};
use nalgebra::{DMatrix, Matrix3, Matrix3xX, SMatrix, Vector3};
use polhode::inertia::Inertia;

use crate::bound::of_entries;
use crate::columns::column::{Column, Unknowns, terms_of};
use crate::columns::sets::{sensor_columns, torque_columns};
use crate::physical::coordinates::{Form, basis, coordinates};
use crate::settings::Settings;
use crate::signal::stretch::Stretch;
use crate::signal::terms::{Terms, cross_derivative, slope};

/// The bound of [`foreseen_bound`](crate::foreseen_bound) for a fit with `settings`: their torque, with `coefficients` in
/// the order of [`FittedTorque::coefficients`](crate::FittedTorque::coefficients) as it acts, their errors of the
/// sensor, and their prior tensor. `Auto` stands for no torque; torque noise is left out.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode_fit::{SensorPriors, Settings, TorqueModel, foreseen_bound, foreseen_bound_with};
/// use polhode::inertia::Inertia;
/// let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
/// let times: Vec<f64> = (0..1000).map(|i| f64::from(i) / 100.0).collect();
/// let omega = Vector3::new(0.3, 1.0, 0.4);
/// let free = foreseen_bound(&body, omega, &times, 1e-3).ok_or("tumbles")?;
/// // drag of 5 per cent a second, and an offset of the sensor of some 0.01 rad/s
/// let sensor = SensorPriors::default().with_offset(0.01);
/// let settings = Settings::default().with_torque(TorqueModel::Drag).with_sensor(sensor);
/// let real = foreseen_bound_with(&body, omega, &times, 1e-3, &settings, &[0.05]).ok_or("tumbles")?;
/// assert!(real.trace() > free.trace());
/// # Ok::<(), polhode::Error>(())
/// ```
///
/// `None` where the motion does not determine the tensor, an argument is not finite, or the number of coefficients is not
/// that of the torque.
#[must_use]
pub fn foreseen_bound_with(
    inertia: &Inertia,
    omega_body: Vector3<f64>,
    times: &[f64],
    sigma: f64,
    settings: &Settings,
    coefficients: &[f64],
) -> Option<SMatrix<f64, 6, 6>> {
    let rate = omega_body.norm();
    let first = *times.first()?;
    let scaled: Vec<f64> = times.iter().map(|t| (t - first) * rate).collect();
    let stretch = Stretch::new(scaled.clone(), vec![Vector3::zeros(); scaled.len()]);
    let mut columns = torque_columns(settings.torque);
    if columns.len() != coefficients.len() {
        return None;
    }
    let mut values: Vec<f64> =
        columns.iter().zip(coefficients).map(|(c, v)| v / c.label().factor(rate)).collect();
    columns.extend(sensor_columns(&settings.sensor, rate));
    values.resize(columns.len(), 0.0);
    let shape = inertia.tensor() / inertia.tensor().trace();
    let at = Unknowns { x: coordinates(&shape), c: values };
    let law =
        Law { inverse: shape.try_inverse()?, terms: terms_of(&columns, &at, &stretch), columns: &columns };
    let deviation = sigma / rate;
    let mut information = law.information(&scaled, omega_body / rate) / (deviation * deviation);
    for (k, column) in columns.iter().enumerate() {
        if let Some(prior) = column.prior {
            information[(5 + k, 5 + k)] += 1.0 / (prior * prior);
        }
    }
    if let Some(prior) = &settings.prior {
        let root = prior.told().ok()?.shape().root;
        let mut of_shape = information.view_mut((0, 0), (5, 5));
        of_shape += root.transpose() * root;
    }
    // the others at their best: what is left to the tensor
    let others = information.nrows() - 5;
    let own = information.view((5, 5), (others, others)).into_owned().cholesky()?;
    let mixed = information.view((5, 0), (others, 5)).into_owned();
    let left = information.view((0, 0), (5, 5)) - mixed.transpose() * own.solve(&mixed);
    of_entries(Form::from_fn(|i, k| left[(i, k)]), |own| Some(own.cholesky()?.inverse()))
}

/// J ω' = −ω × J ω − D ω − c |ω| J ω + τ₀, with D = k J + viscous, and its derivatives.
struct Law<'a> {
    inverse: Matrix3<f64>,
    terms: Terms,
    columns: &'a [Column],
}

impl Law<'_> {
    /// ω' and the derivative of S = ∂ω/∂(x, columns, ω₀).
    fn derivative(&self, w: &Vector3<f64>, s: &Matrix3xX<f64>) -> (Vector3<f64>, Matrix3xX<f64>) {
        let Terms { j, drag, quadratic, viscous, constant, .. } = self.terms;
        let size = w.norm();
        let torque = constant - viscous * w - j * w * (quadratic * size);
        let rate = self.inverse * (torque - w.cross(&(j * w)));
        let by_rate = self.inverse * (cross_derivative(&j, w) + viscous + j * slope(w) * quadratic);
        let mut ds = -by_rate * s;
        let mut add = |k: usize, own: Vector3<f64>| {
            let sum = ds.column(k) + own;
            ds.set_column(k, &sum);
        };
        for k in 0..5 {
            let b = basis(k);
            let own = w.cross(&(b * w)) + b * rate + b * w * (drag + quadratic * size);
            add(k, -self.inverse * own);
        }
        for (k, column) in self.columns.iter().enumerate() {
            if let Some(own) = column.effect().acceleration(&self.inverse, w) {
                add(5 + k, own);
            }
        }
        (rate, ds)
    }

    /// Σ of the squares of the derivatives of the readings.
    fn information(&self, times: &[f64], start: Vector3<f64>) -> DMatrix<f64> {
        let size = 5 + self.columns.len() + 3;
        let mut s = Matrix3xX::zeros(size);
        s.view_mut((0, size - 3), (3, 3)).fill_with_identity();
        let (mut w, mut time) = (start, 0.0);
        let mut sum = DMatrix::zeros(size, size);
        for &next in times {
            let parts = ((next - time) * w.norm().max(1.0) / STEP_OF_PLAN).ceil().clamp(1.0, PARTS_OF_PLAN);
            let h = (next - time) / parts;
            for _ in 0..parts as usize {
                let (w1, s1) = self.derivative(&w, &s);
                let (w2, s2) = self.derivative(&(w + w1 * (0.5 * h)), &(&s + &s1 * (0.5 * h)));
                let (w3, s3) = self.derivative(&(w + w2 * (0.5 * h)), &(&s + &s2 * (0.5 * h)));
                let (w4, s4) = self.derivative(&(w + w3 * h), &(&s + &s3 * h));
                w += (w1 + (w2 + w3) * 2.0 + w4) * (h / 6.0);
                s += (s1 + (s2 + s3) * 2.0 + s4) * (h / 6.0);
            }
            time = next;
            let read = self.readings(&w, &s, time);
            sum += read.transpose() * read;
        }
        sum
    }

    /// The derivative of the readings y of ω = P y − b.
    fn readings(&self, w: &Vector3<f64>, s: &Matrix3xX<f64>, time: f64) -> Matrix3xX<f64> {
        let mut read = s.clone();
        let slope = self.derivative(w, s).0;
        for (k, column) in self.columns.iter().enumerate() {
            let own = column.effect().change_of_reading(w, &slope, time).unwrap_or_else(Vector3::zeros);
            let whole = read.column(5 + k) + own;
            read.set_column(5 + k, &whole);
        }
        read
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::skew::Skew;

    /// A delay of the y axis shows the rate of an earlier time: less of J₂ ω₂' = (J₃ − J₁) ω₃ ω₁, and the other axes show what they did.
    #[test]
    fn readings_of_a_delayed_axis_lag_by_its_slope() {
        let j = Matrix3::from_diagonal(&Vector3::new(0.25, 0.25, 0.5));
        let columns = [Column::new(Skew(1), Some(1e-3))];
        let law = Law { inverse: j.try_inverse().unwrap(), terms: Terms::at(j), columns: &columns };
        let s = Matrix3xX::from_fn(9, |i, k| (3 * k + i) as f64);
        let read = law.readings(&Vector3::new(2.0, 5.0, 3.0), &s, 0.0);
        // (0.5 − 0.25) · 3 · 2 / 0.25
        let lag = Vector3::new(0.0, 6.0, 0.0);
        assert!((read.column(5) - (s.column(5) - lag)).amax() < 1e-12, "{read}");
        assert!((0..9).filter(|k| *k != 5).all(|k| read.column(k) == s.column(k)));
    }
}
