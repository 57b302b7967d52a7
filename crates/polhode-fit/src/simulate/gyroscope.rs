//! A rate sensor and its errors.

use crate::setters::setters;
use nalgebra::{Matrix3, Vector3};
use polhode::num::Random;

use crate::simulate::{SimulationError, check};

/// Errors of a rate sensor; the default has none.
///
/// It reads `(1 + s) (1 + diag a) (1 + Γ) ω + b + walk + noise`, in steps of a quantum, with spikes on single components.
/// Γ is symmetric: an antisymmetric part would turn the sensor as a whole, and with it the tensor that is fitted.
#[non_exhaustive]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gyroscope {
    /// Standard deviation of the white noise of each component, rad/s.
    pub noise: f64,
    /// Constant offset b, rad/s.
    pub offset: Vector3<f64>,
    /// Random walk of the offset of each component, 0 at the first sample: standard deviation after 1 s, rad/s per √s.
    pub offset_walk: f64,
    /// Scale error s that all axes share.
    pub scale: f64,
    /// Scale error a of each axis.
    pub axis_scales: Vector3<f64>,
    /// Γ_xy, Γ_xz, Γ_yz, rad: how far each axis leans towards another. The angle of the pair is off by twice that.
    pub misalignment: Vector3<f64>,
    /// How much later each axis is read than the time says, s. A delay of the reading behind the motion, which a fit estimates, has the other
    /// sign.
    pub skew: Vector3<f64>,
    /// Step of the digital output, rad/s; 0 for none.
    pub quantum: f64,
    /// Share of the samples that carry a spike, on one component at random.
    pub spikes: f64,
    /// Size of the spikes, either sign, rad/s.
    pub spike_size: f64,
}

impl Gyroscope {
    setters! {
        options {}
        values {
            noise => with_noise(f64),
            offset => with_offset(Vector3<f64>),
            offset_walk => with_offset_walk(f64),
            scale => with_scale(f64),
            axis_scales => with_axis_scales(Vector3<f64>),
            misalignment => with_misalignment(Vector3<f64>),
            skew => with_skew(Vector3<f64>),
            quantum => with_quantum(f64),
            spikes => with_spikes(f64),
            spike_size => with_spike_size(f64),
        }
    }

    /// What it reads of true `rates` (rad/s) at `times` (s), as another simulation has them.
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use polhode::num::Random;
    /// use polhode_fit::Gyroscope;
    /// let read = Gyroscope::default().with_offset(Vector3::x() * 0.1).read(&[0.0], &[Vector3::y()], &mut Random::new(1))?;
    /// assert_eq!(read, [Vector3::new(0.1, 1.0, 0.0)]);
    /// # Ok::<(), polhode_fit::SimulationError>(())
    /// ```
    ///
    /// # Errors
    /// Numbers that are not finite or have a wrong sign; a skew, for which rates at other times are needed; another number of rates than
    /// of times.
    pub fn read(
        &self,
        times: &[f64],
        rates: &[Vector3<f64>],
        random: &mut Random,
    ) -> Result<Vec<Vector3<f64>>, SimulationError> {
        self.check()?;
        let setting = |name, value, rule| Err(SimulationError::Setting { name, value, rule });
        if let Some(value) = self.skew.iter().copied().find(|skew| *skew != 0.0) {
            return setting("a time skew", value, "give none: it asks for rates at other times");
        }
        if times.len() != rates.len() {
            return setting("the number of rates", rates.len() as f64, "give as many as times");
        }
        let errors = self.errors(times, random);
        Ok(rates.iter().zip(&errors).map(|(rate, error)| self.reading(rate, error)).collect())
    }

    pub(super) fn check(&self) -> Result<(), SimulationError> {
        check("the noise", &[self.noise], false)?;
        check("the offset", self.offset.as_slice(), true)?;
        check("the walk of the offset", &[self.offset_walk], false)?;
        check("the scale error", &[self.scale], true)?;
        check("a scale error of an axis", self.axis_scales.as_slice(), true)?;
        check("a misalignment", self.misalignment.as_slice(), true)?;
        check("a time skew", self.skew.as_slice(), true)?;
        check("the quantum", &[self.quantum], false)?;
        check("the share of spikes", &[self.spikes], false)?;
        check("the size of spikes", &[self.spike_size], false)?;
        if self.spikes > 1.0 {
            let rule = "give a share from 0 to 1";
            return Err(SimulationError::Setting { name: "the share of spikes", value: self.spikes, rule });
        }
        Ok(())
    }

    /// What is added to the scaled rates at each of `times`.
    pub(super) fn errors(&self, times: &[f64], random: &mut Random) -> Vec<Vector3<f64>> {
        let mut errors: Vec<Vector3<f64>> =
            times.iter().map(|_| self.offset + random.normal_vector() * self.noise).collect();
        if self.offset_walk > 0.0 {
            let mut walk = Vector3::zeros();
            for (k, error) in errors.iter_mut().enumerate().skip(1) {
                walk += random.normal_vector() * (self.offset_walk * (times[k] - times[k - 1]).abs().sqrt());
                *error += walk;
            }
        }
        if self.spikes > 0.0 {
            for error in &mut errors {
                let (chance, place) = (random.uniform(), random.below(6) as usize);
                if chance < self.spikes {
                    error[place / 2] += if place % 2 == 0 { self.spike_size } else { -self.spike_size };
                }
            }
        }
        errors
    }

    pub(super) fn reading(&self, rate: &Vector3<f64>, error: &Vector3<f64>) -> Vector3<f64> {
        let [xy, xz, yz] = self.misalignment.into();
        let lean = Matrix3::new(0.0, xy, xz, xy, 0.0, yz, xz, yz, 0.0);
        let aligned = rate + lean * rate;
        let scaled = (aligned + aligned.component_mul(&self.axis_scales)) * (1.0 + self.scale);
        let read = scaled + error;
        if self.quantum > 0.0 { read.map(|x| (x / self.quantum).round() * self.quantum) } else { read }
    }
}
