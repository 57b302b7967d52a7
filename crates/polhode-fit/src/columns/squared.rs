//! Sums for drag that grows with the square of the rate: those of |ω| ω against the test functions.

use crate::signal::terms::slope;
use nalgebra::Vector3;

use crate::columns::column::Column;
use crate::columns::quadratic::Quadratic;
use crate::signal::stretch::Stretch;
use crate::signal::terms::Terms;
use crate::signal::test_functions::{Seen, TestFunctions};

/// Σ w φ |ω| ω of each test function, ω = P y − b.
pub(crate) struct Squared {
    /// At the readings less the noise.
    pub(crate) motion: Vec<Vector3<f64>>,
    /// The same, with the noise to first order.
    pub(crate) readings: Vec<Vector3<f64>>,
    /// The derivative with respect to each column that is an offset or an error of scale or alignment.
    pub(crate) sensor: Vec<Vec<Vector3<f64>>>,
}

impl Squared {
    /// `None` where no column asks for it.
    pub(crate) fn new(
        stretch: &Stretch,
        noise: &[Vector3<f64>],
        terms: &Terms,
        tests: &TestFunctions,
        columns: &[Column],
    ) -> Option<Self> {
        let quadratic = Column::new(Quadratic, None);
        let asked = |column: &Column| column.is_alike(&quadratic) && column.acts_on(stretch);
        if !columns.iter().any(asked) {
            return None;
        }
        let none = || vec![Vector3::zeros(); tests.count];
        // where there is none of this drag, errors of the rates change nothing of it
        let acts = terms.quadratic != 0.0;
        let of_sensor = |column: &Column| acts && column.effect().change_of_rate(&Vector3::zeros()).is_some();
        let mut sums = Squared {
            motion: none(),
            readings: none(),
            sensor: columns.iter().map(|c| if of_sensor(c) { none() } else { Vec::new() }).collect(),
        };
        for (i, n) in noise.iter().enumerate() {
            let reading = stretch.rates[i] - n;
            let w = terms.rate(&reading);
            let (value, slope) = (w * w.norm(), slope(&w));
            let linear = value + slope * (terms.sensor * n);
            let changes: Vec<Option<Vector3<f64>>> = columns
                .iter()
                .take(if acts { columns.len() } else { 0 })
                .map(|column| column.effect().change_of_rate(&reading).map(|change| slope * change))
                .collect();
            for (m, _, by) in Seen::new(tests, stretch.times[i]).each() {
                let by = by * stretch.weights[i];
                sums.motion[m] += value * by;
                sums.readings[m] += linear * by;
                for (sum, change) in sums.sensor.iter_mut().zip(&changes) {
                    if let (Some(sum), Some(change)) = (sum.get_mut(m), change) {
                        *sum += change * by;
                    }
                }
            }
        }
        Some(sums)
    }
}
