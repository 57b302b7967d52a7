//! The flags of what acts on the body and of what is wrong with the sensor.

use clap::Args;
use nalgebra::Vector3;
use polhode::body::Wheel;
use polhode_files::numbers::{not_negative, number, numbers};
use polhode_fit::{Disturbances, Gyroscope};

/// What acts on the body.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Torques (body axes, none by default)")]
pub(super) struct DisturbanceArguments {
    /// Drag in proportion to the angular momentum of the body, -k J w, 1/s
    #[arg(long, value_name = "K", value_parser = not_negative, allow_hyphen_values = true, default_value = "0", hide_default_value = true)]
    relative_drag: f64,
    /// Viscous drag about each axis, -d w, N m s: three coefficients, where --drag of propagate has one for all axes
    #[arg(long, value_name = "dx,dy,dz", value_parser = drags, allow_hyphen_values = true)]
    drag: Option<[f64; 3]>,
    /// Constant torque that is not written to the record, N m (--torque of fit, in contrast, names a model)
    #[arg(long, value_name = "tx,ty,tz", value_parser = numbers::<3>, allow_hyphen_values = true)]
    torque: Option<[f64; 3]>,
    /// Constant torque that is written to columns tx, ty, tz, N m
    #[arg(long, value_name = "tx,ty,tz", value_parser = numbers::<3>, allow_hyphen_values = true)]
    known_torque: Option<[f64; 3]>,
    /// White noise of each component of the torque: standard deviation of its impulse over 1 s, N m s^(1/2)
    #[arg(long, value_name = "S", value_parser = not_negative, allow_hyphen_values = true, default_value = "0", hide_default_value = true)]
    torque_noise: f64,
    /// Angular momentum of wheels at the start, besides those of --wheel; the sum is written to the columns hx, hy, hz (N m s)
    #[arg(long, value_name = "hx,hy,hz", value_parser = numbers::<3>, allow_hyphen_values = true)]
    wheel_momentum: Option<[f64; 3]>,
    /// Rate of change of --wheel-momentum, N m
    #[arg(long, value_name = "x,y,z", value_parser = numbers::<3>, allow_hyphen_values = true)]
    wheel_rate: Option<[f64; 3]>,
}

fn vector(given: Option<[f64; 3]>) -> Vector3<f64> {
    given.map_or_else(Vector3::zeros, Vector3::from)
}

impl DisturbanceArguments {
    /// With `wheels` besides.
    pub(super) fn disturbances(&self, wheels: &[Wheel]) -> Disturbances {
        Disturbances::default()
            .with_relative_drag(self.relative_drag)
            .with_drag(vector(self.drag))
            .with_torque(vector(self.torque) + vector(self.known_torque))
            .with_torque_noise(self.torque_noise)
            .with_wheel(vector(self.wheel_momentum))
            .with_wheels(wheels.to_vec())
            .with_wheel_rate(vector(self.wheel_rate))
    }

    /// The torque that the record tells.
    pub(super) fn known_torque(&self) -> Option<[f64; 3]> {
        self.known_torque
    }

    /// Whether a torque acts that does not grow with the body, or a wheel.
    pub(super) fn is_sized(&self) -> bool {
        self.drag.is_some()
            || self.torque.is_some()
            || self.known_torque.is_some()
            || self.torque_noise > 0.0
            || self.has_wheel()
    }

    pub(super) fn has_wheel(&self) -> bool {
        self.wheel_momentum.is_some() || self.wheel_rate.is_some()
    }
}

/// What is wrong with the sensor.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Sensor errors (sensor axes = body axes, none by default)")]
pub(super) struct GyroscopeArguments {
    /// Standard deviation of the noise of each component, rad/s
    #[arg(long, value_name = "SIGMA", value_parser = not_negative, allow_hyphen_values = true)]
    noise: Option<f64>,
    /// Write attitudes (q_w, q_x, q_y, q_z, body to space), each turned by a rotation vector whose components have this standard
    /// deviation, rad: in place of the rates, or beside them where --noise is given
    #[arg(long, value_name = "SIGMA", value_parser = not_negative, allow_hyphen_values = true)]
    attitude_noise: Option<f64>,
    /// Constant offset, rad/s
    #[arg(long, value_name = "bx,by,bz", value_parser = numbers::<3>, allow_hyphen_values = true)]
    offset: Option<[f64; 3]>,
    /// Random walk of the offset: standard deviation after 1 s, rad/s^(3/2)
    #[arg(long, value_name = "W", value_parser = not_negative, allow_hyphen_values = true, default_value = "0", hide_default_value = true)]
    offset_walk: f64,
    /// Scale error of all axes: with 0.01 they read 1 % too much
    #[arg(long, value_name = "S", value_parser = number, allow_hyphen_values = true, default_value = "0", hide_default_value = true)]
    scale_error: f64,
    /// Scale error of each axis
    #[arg(long, value_name = "ax,ay,az", value_parser = numbers::<3>, allow_hyphen_values = true)]
    axis_scale_errors: Option<[f64; 3]>,
    /// Misalignment of the axes x and y, x and z, y and z, rad: both axes of a pair lean towards each other by this angle. Their angle is
    /// off by twice as much, which is what `fit` estimates
    #[arg(long, value_name = "xy,xz,yz", value_parser = numbers::<3>, allow_hyphen_values = true)]
    misalignment: Option<[f64; 3]>,
    /// Step of the digital output, rad/s
    #[arg(long, value_name = "Q", value_parser = not_negative, allow_hyphen_values = true, default_value = "0", hide_default_value = true)]
    quantum: f64,
    /// Skew: time after that of its row at which each axis is read, s. The delays that `fit` estimates have the other sign
    #[arg(long, value_name = "sx,sy,sz", value_parser = numbers::<3>, allow_hyphen_values = true)]
    skew: Option<[f64; 3]>,
    /// Fraction of the samples with a spike on one component, and its size, rad/s
    #[arg(long, value_name = "FRACTION,SIZE", value_parser = spikes, allow_hyphen_values = true)]
    spikes: Option<[f64; 2]>,
}

/// Three numbers, none negative.
fn drags(text: &str) -> Result<[f64; 3], String> {
    let found = numbers(text)?;
    match found.iter().find(|d| **d < 0.0) {
        Some(d) => Err(format!("{d:?} would drive the body; give drags of 0 or more")),
        None => Ok(found),
    }
}

/// A fraction and a size.
fn spikes(text: &str) -> Result<[f64; 2], String> {
    let [share, size] = numbers(text)?;
    match (0.0..=1.0).contains(&share) && size >= 0.0 {
        true => Ok([share, size]),
        false => Err("give a fraction from 0 to 1 and a size of 0 or more".into()),
    }
}

impl GyroscopeArguments {
    /// The noise of attitudes, where they are written.
    pub(super) fn attitude_noise(&self) -> Option<f64> {
        self.attitude_noise
    }

    /// Whether rates are written.
    pub(super) fn has_rates(&self) -> bool {
        self.attitude_noise.is_none() || self.noise.is_some()
    }

    pub(super) fn gyroscope(&self) -> Gyroscope {
        let [spikes, spike_size] = self.spikes.unwrap_or_default();
        Gyroscope::default()
            .with_noise(self.noise.unwrap_or(0.0))
            .with_offset(vector(self.offset))
            .with_offset_walk(self.offset_walk)
            .with_scale(self.scale_error)
            .with_axis_scales(vector(self.axis_scale_errors))
            .with_misalignment(vector(self.misalignment))
            .with_skew(vector(self.skew))
            .with_quantum(self.quantum)
            .with_spikes(spikes)
            .with_spike_size(spike_size)
    }
}
