//! Torque and sensor at which the weak equations are linearised.
//!
//! J ω' + ω × J ω + D ω + c |ω| J ω − τ₀ = 0 with ω = P y − b of the readings y.

use nalgebra::{Matrix3, Vector3};

/// [ω]ₓ B − [B ω]ₓ: the derivative of ω × B ω.
pub(crate) fn cross_derivative(b: &Matrix3<f64>, w: &Vector3<f64>) -> Matrix3<f64> {
    w.cross_matrix() * b - (b * w).cross_matrix()
}

/// The derivative of |ω| ω.
pub(crate) fn slope(w: &Vector3<f64>) -> Matrix3<f64> {
    let size = w.norm();
    if size == 0.0 { Matrix3::zeros() } else { Matrix3::identity() * size + w * w.transpose() / size }
}

/// What the unknowns make of torque and sensor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terms {
    pub(crate) j: Matrix3<f64>,
    /// k.
    pub(crate) drag: f64,
    /// c.
    pub(crate) quadratic: f64,
    /// D, with k J.
    pub(crate) viscous: Matrix3<f64>,
    /// τ₀.
    pub(crate) constant: Vector3<f64>,
    /// P.
    pub(crate) sensor: Matrix3<f64>,
    /// b.
    pub(crate) offset: Vector3<f64>,
    /// Delay of each axis.
    pub(crate) skew: Vector3<f64>,
    /// One over the trace.
    pub(crate) input: f64,
    /// What is added to it for each component of the momentum of wheels.
    pub(crate) of_wheel: Vector3<f64>,
}

impl Terms {
    /// Of a tensor alone.
    pub(crate) fn at(j: Matrix3<f64>) -> Terms {
        Terms {
            j,
            drag: 0.0,
            quadratic: 0.0,
            viscous: Matrix3::zeros(),
            constant: Vector3::zeros(),
            sensor: Matrix3::identity(),
            offset: Vector3::zeros(),
            skew: Vector3::zeros(),
            input: 0.0,
            of_wheel: Vector3::zeros(),
        }
    }

    /// ω of a reading.
    pub(crate) fn rate(&self, reading: &Vector3<f64>) -> Vector3<f64> {
        self.sensor * reading - self.offset
    }

    /// u h of a momentum h of wheels.
    pub(crate) fn wheel(&self, told: &Vector3<f64>) -> Vector3<f64> {
        told * self.input + told.component_mul(&self.of_wheel)
    }

    /// The derivative of ω × (J ω + u h) + D ω + c |ω| J ω.
    pub(crate) fn by_rate(&self, w: &Vector3<f64>, wheel: &Vector3<f64>) -> Matrix3<f64> {
        let own = cross_derivative(&self.j, w) + self.viscous - self.wheel(wheel).cross_matrix();
        if self.quadratic == 0.0 { own } else { own + self.j * slope(w) * self.quadratic }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Along the rate |ω| ω grows twice as fast as across it, where |ω| is 5; at rest it does not grow.
    #[test]
    fn squares_grow_twice_as_fast_along_the_rate() {
        let (along, across) = (Vector3::new(0.0, 0.0, 5.0), Vector3::new(1.0, 0.0, 0.0));
        assert_eq!((slope(&along) * along, slope(&along) * across), (along * 10.0, across * 5.0));
        assert_eq!(slope(&Vector3::zeros()), Matrix3::zeros());
    }

    /// A turn by ω × B ω is quadratic: half the derivative times ω is the value; B + 1 turns as B does.
    #[test]
    fn the_derivative_of_a_turn_is_that_of_a_square() {
        let b = Matrix3::new(2.0, 1.0, 0.0, 1.0, 3.0, -1.0, 0.0, -1.0, 5.0);
        let w = Vector3::new(1.0, -2.0, 3.0);
        assert_eq!(cross_derivative(&b, &w) * w, w.cross(&(b * w)) * 2.0);
        assert_eq!(cross_derivative(&(b + Matrix3::identity()), &w), cross_derivative(&b, &w));
    }

    /// Readings lose their offset after the sensor; a wheel has the common factor and that of its own axis.
    #[test]
    fn rates_and_wheels_are_linear_in_their_factors() {
        let of = Terms::at(Matrix3::identity());
        let (offset, of_wheel) = (Vector3::new(1.0, 2.0, 3.0), Vector3::new(0.0, 1.0, -2.0));
        let terms = Terms { sensor: of.sensor * 2.0, offset, input: 3.0, of_wheel, ..of };
        let told = Vector3::new(1.0, 10.0, 100.0);
        assert_eq!((of.rate(&told), terms.rate(&told)), (told, Vector3::new(1.0, 18.0, 197.0)));
        assert_eq!((of.wheel(&told), terms.wheel(&told)), (Vector3::zeros(), Vector3::new(3.0, 40.0, 100.0)));
    }
}
