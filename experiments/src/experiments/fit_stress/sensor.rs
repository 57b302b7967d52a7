//! What a sensor makes of the rates beyond the errors that the library's own has.

use nalgebra::Vector3;
use polhode::num::Random;
use polhode_fit::Gyroscope;

/// An error that readings have beside their white noise.
#[derive(Clone, Copy)]
pub(super) enum Error {
    None,
    /// Errors of a gyroscope, each component of random sign.
    Scale(f64),
    AxisScales(f64),
    Misalignment(f64),
    Offset(f64),
    /// An offset that grows from nothing to this, rad/s.
    Ramp(f64),
    Walk(f64),
    Skew(f64),
    Quantum(f64),
    Spikes(f64),
    /// Readings end at this share of the largest.
    Clipped(f64),
    /// Each reading repeated so many times.
    Repeated(usize),
    /// One reading in so many stays as the one before.
    Stale(usize),
    /// So many bursts of 3 to 6 readings, of 50 deviations.
    Bursts(usize),
    /// A filter of first order, Hz.
    LowPass(f64),
    /// A vibration: frequency, Hz, and amplitude, rad/s.
    Vibration(f64, f64),
    /// Proportional to the products of the rates, as where acceleration moves the sensor, s/rad.
    Acceleration(f64),
    /// The x axis reversed.
    Mirrored,
    /// The x and y axes exchanged.
    Exchanged,
}

impl Error {
    /// As the report names it, with its size: what its lines of systematic errors must cover.
    pub(super) fn lines(self) -> Vec<(&'static str, f64)> {
        match self {
            Error::Scale(size) => vec![("scale", size)],
            Error::AxisScales(size) => ["scale_x", "scale_y", "scale_z"].map(|name| (name, size)).to_vec(),
            Error::Misalignment(size) => {
                ["misalignment_xy", "misalignment_xz", "misalignment_yz"].map(|name| (name, size)).to_vec()
            }
            Error::Offset(size) => ["offset_x", "offset_y", "offset_z"].map(|name| (name, size)).to_vec(),
            Error::Skew(size) => vec![("skew_y", size), ("skew_z", 2.0 * size)],
            Error::Walk(size) => vec![("walk", size)],
            _ => Vec::new(),
        }
    }

    pub(super) fn is_mirror(self) -> bool {
        matches!(self, Error::Mirrored | Error::Exchanged)
    }

    /// The errors that a gyroscope of the library has.
    pub(super) fn gyroscope(self, noise: f64, random: &mut Random) -> Gyroscope {
        let mut signs =
            |size: f64| Vector3::from_fn(|_, _| if random.uniform() < 0.5 { -size } else { size });
        let of = Gyroscope::default().with_noise(noise);
        match self {
            Error::Scale(size) => of.with_scale(signs(size).x),
            Error::AxisScales(size) => of.with_axis_scales(signs(size)),
            Error::Misalignment(size) => of.with_misalignment(signs(size)),
            Error::Offset(size) => of.with_offset(signs(size)),
            Error::Walk(size) => of.with_offset_walk(size),
            Error::Quantum(size) => of.with_quantum(size),
            Error::Spikes(share) => of.with_spikes(share).with_spike_size(50.0 * noise),
            _ => of,
        }
    }

    /// Before the noise comes in.
    pub(super) fn on_rates(self, times: &[f64], rates: &mut [Vector3<f64>]) {
        match self {
            Error::LowPass(hertz) => {
                for k in 1..rates.len() {
                    let kept = libm::exp(-core::f64::consts::TAU * hertz * (times[k] - times[k - 1]));
                    rates[k] = rates[k - 1] * kept + rates[k] * (1.0 - kept);
                }
            }
            Error::Vibration(hertz, size) => {
                for (t, w) in times.iter().zip(rates) {
                    let phase = core::f64::consts::TAU * hertz * t;
                    *w += Vector3::new(libm::sin(phase), libm::cos(phase), libm::sin(phase + 1.0)) * size;
                }
            }
            Error::Acceleration(size) => {
                rates.iter_mut().for_each(|w| *w += Vector3::new(w.y * w.z, w.z * w.x, w.x * w.y) * size);
            }
            Error::Ramp(size) => {
                let last = times.last().copied().unwrap_or(1.0);
                let grown = times.iter().zip(rates);
                grown.for_each(|(t, w)| *w += Vector3::new(1.0, -1.0, 1.0) * (size * t / last));
            }
            _ => {}
        }
    }

    /// After the noise has come in.
    pub(super) fn on_readings(self, rates: &mut [Vector3<f64>], noise: f64, random: &mut Random) {
        match self {
            Error::Clipped(share) => {
                let end = share * rates.iter().map(|w| w.amax()).fold(0.0, f64::max);
                rates.iter_mut().for_each(|w| *w = w.map(|x| x.clamp(-end, end)));
            }
            Error::Repeated(times) => {
                for k in 0..rates.len() {
                    rates[k] = rates[k - k % times];
                }
            }
            Error::Stale(of) => {
                for k in 1..rates.len() {
                    if random.below(of as u64) == 0 {
                        rates[k] = rates[k - 1];
                    }
                }
            }
            Error::Bursts(count) => {
                for _ in 0..count {
                    let (first, length) = (random.below(rates.len() as u64 - 6), 3 + random.below(4));
                    let size = Vector3::from_fn(|_, _| if random.uniform() < 0.5 { -50.0 } else { 50.0 });
                    for k in first..first + length {
                        rates[k as usize] += size * noise;
                    }
                }
            }
            Error::Mirrored => rates.iter_mut().for_each(|w| w.x = -w.x),
            Error::Exchanged => rates.iter_mut().for_each(|w| *w = Vector3::new(w.y, w.x, w.z)),
            _ => {}
        }
    }
}
