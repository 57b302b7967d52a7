//! The sums that the weak equation of one test function is made of.

use nalgebra::{Matrix3, Vector3};

use crate::signal::moments::{Inputs, Sums};
use crate::signal::terms::Terms;

/// Σ v × B v from S = Σ v vᵀ; of an S that is not symmetric, Σ v × B u from Σ v uᵀ.
pub(crate) fn crossed(s: &Matrix3<f64>, b: &Matrix3<f64>) -> Vector3<f64> {
    let p = s * b.transpose();
    Vector3::new(p[(1, 2)] - p[(2, 1)], p[(2, 0)] - p[(0, 2)], p[(0, 1)] - p[(1, 0)])
}

/// Sums of the rates ω = P y − b from those of the readings y.
pub(crate) struct Corrected {
    pub(crate) slope: Vector3<f64>,
    pub(crate) value: Vector3<f64>,
    pub(crate) square: Matrix3<f64>,
    pub(crate) mixed: Matrix3<f64>,
    pub(crate) area: f64,
    /// Σ w φ' y.
    pub(crate) slope_of_readings: Vector3<f64>,
    /// Σ w φ y.
    pub(crate) value_of_readings: Vector3<f64>,
    /// Σ w φ y ωᵀ.
    pub(crate) with_readings: Matrix3<f64>,
    /// Σ w φ y hᵀ.
    pub(crate) mixed_of_readings: Matrix3<f64>,
}

impl Corrected {
    pub(crate) fn new(terms: &Terms, s: &Sums, area: f64) -> Corrected {
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

    pub(crate) fn residual(&self, terms: &Terms, inputs: Option<&Inputs>) -> Vector3<f64> {
        let own = terms.viscous * self.value - terms.j * self.slope - terms.constant * self.area;
        own + crossed(&self.square, &terms.j)
            + inputs.map_or(Vector3::zeros(), |i| {
                self.input(terms, i) * terms.input + self.by_component(terms, i, &terms.of_wheel)
            })
    }

    /// Σ w (−φ' h + φ ω × h − φ τ).
    pub(crate) fn input(&self, terms: &Terms, inputs: &Inputs) -> Vector3<f64> {
        let mixed = self.mixed - terms.offset * inputs.value.transpose();
        crossed(&mixed, &Matrix3::identity()) - inputs.slope - inputs.torque
    }

    /// Σ w (−φ' h + φ ω × h), each component of h times one of the `factors`.
    pub(crate) fn by_component(
        &self,
        terms: &Terms,
        inputs: &Inputs,
        factors: &Vector3<f64>,
    ) -> Vector3<f64> {
        let mixed = self.mixed - terms.offset * inputs.value.transpose();
        crossed(&mixed, &Matrix3::from_diagonal(factors)) - inputs.slope.component_mul(factors)
    }
}

/// The equation of one test function, linearised.
pub(crate) struct Equation<'a> {
    pub(crate) terms: &'a Terms,
    /// Sums of the rates at the samples less their noise.
    pub(crate) motion: &'a Corrected,
    /// Of wheel momenta and known torques, where the record has them.
    pub(crate) inputs: Option<&'a Inputs>,
    /// Σ w φ |ω| ω, zero where no column asks for it.
    pub(crate) by_square: Vector3<f64>,
}

impl Equation<'_> {
    /// What Σ w φ ω hᵀ changes by, times the factor of the inputs.
    pub(crate) fn by_wheel(&self, mixed: Matrix3<f64>) -> Vector3<f64> {
        let Terms { input, of_wheel, .. } = self.terms;
        crossed(&mixed, &Matrix3::identity()) * *input + crossed(&mixed, &Matrix3::from_diagonal(of_wheel))
    }

    /// The derivative with respect to an error of scale or alignment, by which P changes by `q`.
    pub(crate) fn by_distortion(&self, q: &Matrix3<f64>) -> Vector3<f64> {
        let Equation { terms, motion, .. } = self;
        let square = q * motion.with_readings;
        let own = terms.viscous * (q * motion.value_of_readings) - terms.j * (q * motion.slope_of_readings);
        own + crossed(&(square + square.transpose()), &terms.j) + self.by_wheel(q * motion.mixed_of_readings)
    }
}
