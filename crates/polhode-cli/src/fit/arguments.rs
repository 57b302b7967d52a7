//! The flags of what the fit reckons with: torques, the sensor, and what gives the absolute size.

use clap::{Args, ValueEnum};
use nalgebra::{Matrix3, Vector3};
use polhode::inertia::{Inertia, InertiaShape};
use polhode_files::error::Error;
use polhode_files::numbers::{list, number, numbers, positive};
use polhode_fit::{Estimate, Known, Prior, SensorPriors, TorqueModel};

use crate::flags::body::{ReadOnce, check_size, described};

/// The torque models of the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Torque {
    /// The body is free
    None,
    /// -k J w, in proportion to the angular momentum (J: tensor)
    Drag,
    /// -D w, D diagonal in sensor axes
    Drag3,
    /// -c |w| J w, growing with the square of the rate
    Quadratic,
    /// Constant in body axes
    Constant,
    /// The simplest model that the record does not contradict
    Auto,
}

impl From<Torque> for TorqueModel {
    fn from(torque: Torque) -> Self {
        match torque {
            Torque::None => TorqueModel::None,
            Torque::Drag => TorqueModel::Drag,
            Torque::Drag3 => TorqueModel::Drag3,
            Torque::Quadratic => TorqueModel::Quadratic,
            Torque::Constant => TorqueModel::Constant,
            Torque::Auto => TorqueModel::Auto,
        }
    }
}

/// Standard deviations of what may be wrong with the sensor.
#[derive(Args, Clone, Debug)]
pub(super) struct SensorArguments {
    /// Estimate the offset of each axis, rad/s, with this prior standard deviation
    #[arg(long, value_name = "SIGMA", value_parser = positive, allow_hyphen_values = true, help_heading = "Errors of the sensor")]
    gyro_bias: Option<f64>,
    /// Estimate the relative scale error that all axes share, with this prior standard deviation
    #[arg(long, value_name = "SIGMA", value_parser = positive, allow_hyphen_values = true, help_heading = "Errors of the sensor")]
    gyro_scale: Option<f64>,
    /// Estimate the relative scale error of each axis, with this prior standard deviation
    #[arg(long, value_name = "SIGMA", value_parser = positive, allow_hyphen_values = true, help_heading = "Errors of the sensor")]
    gyro_axis_scales: Option<f64>,
    /// Estimate the deviations of the angles between axes from a right angle, rad, with this prior standard deviation
    #[arg(long, value_name = "SIGMA", value_parser = positive, allow_hyphen_values = true, help_heading = "Errors of the sensor")]
    gyro_misalignment: Option<f64>,
    /// Estimate the delays of y and z against x, s, with this prior standard deviation; a delay is positive where a reading shows the
    /// motion of an earlier time
    #[arg(long, value_name = "SIGMA", value_parser = positive, allow_hyphen_values = true, help_heading = "Errors of the sensor")]
    gyro_skew: Option<f64>,
    /// Step of the digital readings, rad/s, which counts as noise of variance Q^2/12 [default: found in the readings]
    #[arg(long, value_name = "Q", value_parser = positive, allow_hyphen_values = true, help_heading = "Errors of the sensor")]
    quantum: Option<f64>,
}

impl SensorArguments {
    pub(super) fn quantum(&self) -> Option<f64> {
        self.quantum
    }

    pub(super) fn priors(&self) -> SensorPriors {
        SensorPriors::default()
            .with_offset(self.gyro_bias)
            .with_scale(self.gyro_scale)
            .with_axis_scales(self.gyro_axis_scales)
            .with_misalignment(self.gyro_misalignment)
            .with_skew(self.gyro_skew)
    }
}

/// What gives the absolute size: at most one of these.
#[derive(Args, Clone, Debug)]
#[group(multiple = false)]
pub(super) struct KnownArguments {
    /// Body whose tensor has the trace of the one to be fitted: a name of the catalogue, or a file of `polhode inertia`
    #[arg(long, value_name = "NAME|FILE", help_heading = "Known about the tensor")]
    body: Option<String>,
    /// Trace of the tensor, kg m^2
    #[arg(long, value_name = "TRACE", value_parser = number, allow_hyphen_values = true, help_heading = "Known about the tensor")]
    trace: Option<f64>,
    /// Magnitude of the angular momentum, the same in all segments, kg m^2/s
    #[arg(long, value_name = "L", value_parser = number, allow_hyphen_values = true, help_heading = "Known about the tensor")]
    momentum: Option<f64>,
    /// Twice the kinetic energy, the same in all segments, kg m^2/s^2
    #[arg(long, value_name = "2T", value_parser = number, allow_hyphen_values = true, help_heading = "Known about the tensor")]
    twice_energy: Option<f64>,
    /// Moment about an axis, kg m^2
    #[arg(long, value_name = "nx,ny,nz,I", value_parser = numbers::<4>, allow_hyphen_values = true, help_heading = "Known about the tensor")]
    moment: Option<[f64; 4]>,
    /// What --body names.
    #[arg(skip)]
    read: ReadOnce,
}

/// Share of the trace by which a moment of --body may be another without a word: more than a drawing and a sensor are off by.
const OTHER: f64 = 0.05;

impl KnownArguments {
    /// The body that `--body` names.
    pub(super) fn body(&self) -> Result<Option<Inertia>, Error> {
        let Some(text) = &self.body else { return Ok(None) };
        let read = || check_size(text).and_then(|()| described(text));
        Ok(Some(self.read.or_read(read)?.inertia.clone()))
    }

    /// What --body says against the answer: its moments are those of the record's mirror, or of another body.
    pub(super) fn contradiction(&self, estimate: &Estimate) -> Result<Option<String>, Error> {
        let Some(body) = self.body()? else { return Ok(None) };
        let of_body = body.shape().principal_moments();
        let apart = |from: [f64; 3]| (0..3).map(|k| (from[k] - of_body[k]).abs()).fold(0.0, f64::max);
        let largest = estimate.sigma_principal.iter().copied().fold(0.0, f64::max);
        let read = apart(estimate.principal);
        let is_mirror = |mirror: &InertiaShape| apart(mirror.principal_moments()) < 0.2 * read;
        if read <= 5.0 * largest {
            return Ok(None);
        }
        if estimate.mirror.as_ref().is_some_and(is_mirror) {
            return Ok(Some(
                "the moments are not those of --body, but would be in left-handed axes: check for a mirrored axis (--axes)".into(),
            ));
        }
        let shares = |moments: [f64; 3]| moments.map(|share| format!("{share:.3}")).join(" : ");
        Ok((read > OTHER).then(|| {
            format!(
                "the moments are {} of the trace, and those of --body {}: its trace gives the size, so make sure that it is this body",
                shares(estimate.principal),
                shares(of_body)
            )
        }))
    }

    pub(super) fn known(&self) -> Result<Option<Known>, Error> {
        if let Some(body) = self.body()? {
            return Ok(Some(Known::Trace(body.tensor().trace())));
        }
        let moment = |[x, y, z, value]: [f64; 4]| Known::Moment { axis: Vector3::new(x, y, z), value };
        Ok(self
            .trace
            .map(Known::Trace)
            .or(self.momentum.map(Known::Momentum))
            .or(self.twice_energy.map(Known::TwiceEnergy))
            .or(self.moment.map(moment)))
    }
}

/// A tensor that is known beforehand.
#[derive(Args, Clone, Debug)]
#[group(multiple = false)]
pub(super) struct PriorArguments {
    /// Inertia tensor that is known beforehand, as from CAD, kg m^2, sensor axes: three moments or six entries, then s, with
    /// s sqrt(Iii Ijj) the standard deviation of the entry Iij. It is combined with the record
    #[arg(long, value_name = "Ixx,Iyy,Izz[,Ixy,Ixz,Iyz],SIGMA", value_parser = prior, allow_hyphen_values = true, help_heading = "Known about the tensor")]
    prior_inertia: Option<Prior>,
    /// The same in any unit: the ratios of the entries are known, the size is not
    #[arg(long, value_name = "Ixx,Iyy,Izz[,Ixy,Ixz,Iyz],SIGMA", value_parser = prior, allow_hyphen_values = true, help_heading = "Known about the tensor")]
    prior_shape: Option<Prior>,
}

fn prior(text: &str) -> Result<Prior, String> {
    let values = list(text)?;
    let (tensor, sigma) = match values[..] {
        [x, y, z, sigma] => (Matrix3::from_diagonal(&Vector3::new(x, y, z)), sigma),
        [xx, yy, zz, xy, xz, yz, sigma] => (Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz), sigma),
        _ => {
            let rule = "needed are 3 moments or 6 entries, and their relative standard deviation";
            return Err(format!("{} numbers; {rule}", values.len()));
        }
    };
    if sigma <= 0.0 {
        return Err(format!("the relative standard deviation is {sigma:?}; it must be positive"));
    }
    if let Some(moment) = tensor.diagonal().iter().find(|moment| **moment <= 0.0) {
        return Err(format!("the moment {moment:?} is not positive"));
    }
    Ok(Prior::relative(tensor, sigma))
}

impl PriorArguments {
    /// The flag that was given.
    pub(super) fn flag(&self) -> Option<&'static str> {
        let inertia = self.prior_inertia.as_ref().map(|_| "--prior-inertia");
        inertia.or(self.prior_shape.as_ref().map(|_| "--prior-shape"))
    }

    pub(super) fn prior(&self) -> Option<Prior> {
        let shape = self.prior_shape.clone().map(Prior::shape_only);
        self.prior_inertia.clone().or(shape)
    }
}
