//! What is wrong with body and sensor in each row, and what the fit is told of it.

use nalgebra::Vector3;
use polhode::num::Random;
use polhode_fit::{Disturbances, Gyroscope, SensorPriors, Settings};

use super::bound::Unknown;

/// What the fit knows of a case.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Model {
    /// A model of it: the answer must be at the bound, and its deviations true.
    AtHand,
    /// None: the answer may be off, but not silently.
    Missing,
    /// The record is given in other units than it says: it must be refused.
    WrongUnit,
}

impl Model {
    /// As tables print it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::AtHand => "at hand",
            Self::Missing => "missing",
            Self::WrongUnit => "wrong unit",
        }
    }
}

/// One row.
pub(super) struct Case {
    pub(super) name: &'static str,
    pub(super) model: Model,
    /// Drag k, 1/s.
    drag: f64,
    /// White torque noise, rad/s² √s per trace.
    torque_noise: f64,
    /// Constant torque in a random direction, rad/s² per trace.
    torque: f64,
    /// Size of each component, of random sign: offset (rad/s), scale errors of the axes, misalignment (rad).
    offset: f64,
    axis_scales: f64,
    misalignment: f64,
    /// Common scale error, of random sign.
    scale: f64,
    /// How much the second and third axis are late, s.
    skew: f64,
    quantum: f64,
    offset_walk: f64,
    /// Share of samples with spikes of fifty deviations.
    spikes: f64,
    /// Momentum of a wheel over that of the body, and whether the fit is told of it.
    wheel: f64,
    pub(super) wheel_known: bool,
    /// Priors that the fit is given.
    offset_prior: Option<f64>,
    scale_prior: Option<f64>,
    /// Factors on the rates and times that the fit is given.
    pub(super) rate_factor: f64,
    pub(super) time_factor: f64,
}

const IDEAL: Case = Case {
    name: "ideal",
    model: Model::AtHand,
    drag: 0.0,
    torque_noise: 0.0,
    torque: 0.0,
    offset: 0.0,
    axis_scales: 0.0,
    misalignment: 0.0,
    scale: 0.0,
    skew: 0.0,
    quantum: 0.0,
    offset_walk: 0.0,
    spikes: 0.0,
    wheel: 0.0,
    wheel_known: false,
    offset_prior: None,
    scale_prior: None,
    rate_factor: 1.0,
    time_factor: 1.0,
};
const UNMODELLED: Case = Case { model: Model::Missing, ..IDEAL };
const DEGREES: f64 = 180.0 / core::f64::consts::PI;
const DEGREES_READ: Case = Case { model: Model::WrongUnit, rate_factor: DEGREES, ..IDEAL };
const MILLISECONDS_READ: Case = Case { model: Model::WrongUnit, time_factor: 1000.0, ..IDEAL };

/// The rows.
pub(super) const CASES: [Case; 24] = [
    IDEAL,
    Case { name: "drag 0.1 %/s", drag: 1e-3, ..IDEAL },
    Case { name: "drag 1 %/s", drag: 1e-2, ..IDEAL },
    Case { name: "drag 10 %/s", drag: 0.1, ..IDEAL },
    Case { name: "constant torque 3e-4", torque: 3e-4, ..IDEAL },
    Case { name: "torque noise 3e-4", torque_noise: 3e-4, ..IDEAL },
    Case { name: "torque noise 3e-3", torque_noise: 3e-3, ..IDEAL },
    Case { name: "spikes, 2 % of 50 sigma", spikes: 0.02, ..IDEAL },
    Case { name: "offset 0.01, prior 0.02", offset: 0.01, offset_prior: Some(0.02), ..IDEAL },
    Case { name: "scale 2 %, prior 2 %", scale: 0.02, scale_prior: Some(0.02), ..IDEAL },
    Case {
        name: "drag, offset and scale",
        drag: 1e-2,
        offset: 0.01,
        offset_prior: Some(0.02),
        scale: 0.02,
        scale_prior: Some(0.02),
        ..IDEAL
    },
    Case { name: "known wheel, 10 %", wheel: 0.1, wheel_known: true, ..IDEAL },
    Case { name: "offset 0.01", offset: 0.01, ..UNMODELLED },
    Case { name: "scale 2 %", scale: 0.02, ..UNMODELLED },
    Case { name: "axis scales 2 %", axis_scales: 0.02, ..UNMODELLED },
    Case { name: "misalignment 0.02", misalignment: 0.02, ..UNMODELLED },
    Case { name: "skew 2 ms", skew: 2e-3, ..UNMODELLED },
    Case { name: "steps of 1 deg/s", quantum: 1.0 / DEGREES, ..UNMODELLED },
    Case { name: "offset walk 5e-4", offset_walk: 5e-4, ..UNMODELLED },
    Case { name: "unknown wheel, 0.1 %", wheel: 1e-3, ..UNMODELLED },
    Case { name: "deg/s read as rad/s", ..DEGREES_READ },
    Case { name: "deg/s read as rad/s, drag", drag: 1e-2, ..DEGREES_READ },
    Case { name: "ms read as s", ..MILLISECONDS_READ },
    Case { name: "ms read as s, drag 1 %/s", drag: 1e-2, ..MILLISECONDS_READ },
];

/// A case with its random signs and directions.
pub(super) struct Drawn {
    pub(super) disturbances: Disturbances,
    pub(super) gyroscope: Gyroscope,
    /// Momentum of a wheel that the fit does not know of, over that of the body.
    unknown_wheel: Vector3<f64>,
}

impl Case {
    /// Of a body of trace 1 with momentum of size `momentum`.
    pub(super) fn draw(&self, noise: f64, momentum: f64, random: &mut Random) -> Drawn {
        let mut sign = || if random.uniform() < 0.5 { -1.0 } else { 1.0 };
        let mut signs = |size: f64| Vector3::from_fn(|_, _| size * sign());
        // three that nothing takes: without them all other numbers would be others
        let (_, offset) = (signs(1.0), signs(self.offset));
        let (axis_scales, misalignment) = (signs(self.axis_scales), signs(self.misalignment));
        let scale = self.scale * sign();
        let share = random.normal_vector().normalize() * self.wheel;
        let wheel = share * momentum;
        let torque = if self.torque > 0.0 {
            random.normal_vector().normalize() * self.torque
        } else {
            Vector3::zeros()
        };
        Drawn {
            unknown_wheel: if self.wheel_known { Vector3::zeros() } else { share },
            disturbances: Disturbances::default()
                .with_relative_drag(self.drag)
                .with_torque(torque)
                .with_torque_noise(self.torque_noise)
                .with_wheel(wheel),
            gyroscope: Gyroscope::default()
                .with_noise(noise)
                .with_offset(offset)
                .with_offset_walk(self.offset_walk)
                .with_scale(scale)
                .with_axis_scales(axis_scales)
                .with_misalignment(misalignment)
                .with_skew(Vector3::new(0.0, self.skew, 2.0 * self.skew))
                .with_quantum(self.quantum)
                .with_spikes(self.spikes)
                .with_spike_size(50.0 * noise),
        }
    }

    pub(super) fn settings(&self) -> Settings {
        let sensor = SensorPriors::default().with_offset(self.offset_prior).with_scale(self.scale_prior);
        Settings::default().with_sensor(sensor)
    }

    /// What the bound has to reckon with.
    pub(super) fn unknown(&self) -> Unknown {
        Unknown {
            trace: self.wheel_known,
            drag: self.drag > 0.0,
            torque: self.torque > 0.0,
            offset: self.offset_prior.unwrap_or(0.0),
            scale: self.scale_prior.unwrap_or(0.0),
        }
    }
}

impl Drawn {
    /// The errors that the fit takes to be zero, by the names that it gives them; of a walk its size.
    pub(super) fn errors(&self) -> Vec<(&'static str, f64)> {
        let g = &self.gyroscope;
        let named = |names: [&'static str; 3], v: &Vector3<f64>| [0, 1, 2].map(|k| (names[k], v[k]));
        let mut errors = vec![("scale", g.scale), ("skew_y", g.skew.y), ("skew_z", g.skew.z)];
        errors.extend(named(["offset_x", "offset_y", "offset_z"], &g.offset));
        errors.extend(named(["scale_x", "scale_y", "scale_z"], &g.axis_scales));
        errors.extend(named(["misalignment_xy", "misalignment_xz", "misalignment_yz"], &g.misalignment));
        errors.extend(named(["wheel_x", "wheel_y", "wheel_z"], &self.unknown_wheel));
        errors.push(("walk", g.offset_walk));
        errors.retain(|(_, value)| *value != 0.0);
        errors
    }
}
