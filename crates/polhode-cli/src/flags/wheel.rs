//! The flag of wheels that a body carries.

use clap::Args;
use polhode::body::{Body, Point, Wheel, WheelError};
use polhode::num::Dd;
use polhode_files::error::Error;
use polhode_files::wheel::GivenWheel;

/// Wheels, beside those that the file of a body names.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Body")]
pub(crate) struct WheelArguments {
    /// A wheel on the body; give the flag once for each. Axis in body axes, moment of inertia about it, kg m^2, and speed relative to the
    /// body at the start, rad/s or with a unit as 3000rpm. The speed is held, unless ,free is behind it: then the wheel turns without
    /// friction; or ,torque=T, N m, of a motor that turns it against the body, from t = 0 on or ,from=t, to the end or ,until=t, s. The
    /// inertia of the body includes its wheels, at rest on it
    #[arg(long = "wheel", value_name = "ax,ay,az,I@SPEED[,free|,torque=T]", value_parser = GivenWheel::parse, allow_hyphen_values = true)]
    wheels: Vec<GivenWheel>,
}

impl WheelArguments {
    /// Whether the flag names a wheel.
    pub(crate) fn is_any(&self) -> bool {
        !self.wheels.is_empty()
    }

    /// `body` with the wheels of its file and of the flag. `start` is asked for the start of the body with all of them held, where the
    /// momentum of one that is not depends on it.
    pub(crate) fn carried(
        &self,
        body: Body,
        of_file: Vec<GivenWheel>,
        start: impl FnOnce(&Body) -> Result<Point<Dd>, Error>,
    ) -> Result<Body, Error> {
        let wheels: Vec<GivenWheel> = of_file.into_iter().chain(self.wheels.iter().copied()).collect();
        let held = carrying(&body, &wheels, |wheel| Ok(wheel.held()))?;
        if wheels.iter().all(GivenWheel::is_held) {
            return Ok(held);
        }
        let omega = held.omega_of(&start(&held)?);
        carrying(&body, &wheels, |wheel| wheel.of_start(omega.into()))
    }

    /// The same where no start is known.
    pub(crate) fn held(&self, body: Body, of_file: Vec<GivenWheel>) -> Result<Body, Error> {
        self.carried(body, of_file, |_| {
            let rule = "the momentum of a wheel that is free or driven depends on the start, which is not given here";
            Err(Error::input("--wheel", "", rule, "give wheels whose speed is held"))
        })
    }
}

/// `body` with the wheels that `made` makes.
fn carrying(
    body: &Body,
    wheels: &[GivenWheel],
    made: impl Fn(&GivenWheel) -> Result<Wheel, WheelError>,
) -> Result<Body, Error> {
    let carry = |body: Body, wheel: &GivenWheel| body.with_wheel(made(wheel)?);
    let carried = wheels.iter().try_fold(body.clone(), carry);
    carried.map_err(|error| Error::Input(format!("--wheel: {error}")))
}
