//! The flag of wheels that a body carries.

use clap::Args;
use polhode::body::{Body, Point, WheelAtStart, WheelError};
use polhode::num::Dd;
use polhode_files::error::Error;
use polhode_files::wheel;

/// Wheels, beside those that the file of a body names.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Body")]
pub(crate) struct WheelArguments {
    /// A wheel on the body; repeatable. ax,ay,az: its axis in body axes; I: its moment of inertia about this axis, kg m^2; SPEED: its
    /// speed relative to the body at the start, rad/s or with a unit, as 3000rpm. The speed is held constant. With ,free the wheel turns
    /// without friction instead. With ,torque=T a motor turns it against the body with T, N m, from t = 0 or ,from=t to the end or
    /// ,until=t, s. The inertia of the body includes its wheels, at rest on it
    #[arg(long = "wheel", value_name = "ax,ay,az,I@SPEED[,free|,torque=T]", value_parser = wheel::parse, allow_hyphen_values = true)]
    wheels: Vec<WheelAtStart>,
}

impl WheelArguments {
    /// Whether the flag names a wheel.
    pub(crate) fn is_any(&self) -> bool {
        !self.wheels.is_empty()
    }

    /// The wheels of the file and of the flag.
    pub(crate) fn all(&self, of_file: Vec<WheelAtStart>) -> Vec<WheelAtStart> {
        of_file.into_iter().chain(self.wheels.iter().copied()).collect()
    }

    /// `body` with the wheels of its file and of the flag, of a motion that starts at the time `t`, s. `start` is asked for the start of
    /// the body with all of them held, where the momentum of one that is not depends on it.
    pub(crate) fn carried(
        &self,
        body: Body,
        of_file: Vec<WheelAtStart>,
        t: f64,
        start: impl FnOnce(&Body) -> Result<Point<Dd>, Error>,
    ) -> Result<Body, Error> {
        let wheels = self.all(of_file);
        let held = wheels.iter().try_fold(body.clone(), |body, wheel| body.with_wheel(wheel.at_speed()));
        let held = held.map_err(|error| refused(&error))?;
        if wheels.iter().all(WheelAtStart::is_held) {
            return Ok(held);
        }
        let omega = held.omega_of(&start(&held)?);
        body.with_wheels_at_start(&wheels, t, omega).map_err(|error| refused(&error))
    }
}

/// What is wrong with a wheel.
pub(crate) fn refused(error: &WheelError) -> Error {
    Error::Input(format!("--wheel: {error}"))
}
