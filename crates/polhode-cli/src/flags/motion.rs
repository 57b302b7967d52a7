//! A body, its start and what acts on it: what every command that moves a body is told.

use clap::Args;
use polhode::body::{Body, Point, Problem};
use polhode::num::Dd;
use polhode_files::error::{Error, tell};

use crate::flags::body::BodyArguments;
use crate::flags::force::ForceArguments;
use crate::flags::start::StartArguments;
use crate::flags::wheel::WheelArguments;

/// A method of steps for a motion without closed form.
pub(crate) fn stepping_method(body: &Body) -> &'static str {
    match body.problem() {
        Problem::Torque => "rk4",
        Problem::Gyrostat | Problem::GyrostatPotential => "taylor",
        _ => "kick-drift@srkn-6b",
    }
}

#[derive(Args, Clone, Debug)]
pub(crate) struct MotionArguments {
    #[command(flatten)]
    pub(crate) body: BodyArguments,
    #[command(flatten)]
    wheels: WheelArguments,
    #[command(flatten)]
    pub(crate) start: StartArguments,
    #[command(flatten)]
    forces: ForceArguments,
}

impl MotionArguments {
    /// The body with all that acts on it, of a motion that starts at the time `t`, s.
    pub(crate) fn body(&self, t: f64) -> Result<Body, Error> {
        self.body.check_size(self.forces.is_sized() || self.wheels.is_any())?;
        let own = self.body.own_orbit().filter(|_| !self.forces.has_orbit());
        if let Some((_, primary)) = &own {
            self.start.check_no_frame(primary)?;
        }
        let (body, of_file) = self.body.heavy(self.forces.weight_moment)?;
        let body = self.forces.act_on(body, own.map(|(orbit, _)| orbit))?;
        self.wheels.carried(body, of_file, t, |held| self.start(held, t))
    }

    /// The exact start of that `body` at the time `t`, s, in the solver frame.
    pub(crate) fn start(&self, body: &Body, t: f64) -> Result<Point<Dd>, Error> {
        self.start.inside(body, t, self.body.published_start())
    }

    /// Says what the attitude at the start refers to where it is that of the catalogue.
    pub(crate) fn note(&self) {
        self.start.note(&self.body);
        if let (Some((_, primary)), false) = (self.body.own_orbit(), self.forces.has_orbit()) {
            tell(
                "note",
                &format!("the gravity gradient of {primary} acts, on the orbit that the catalogue has"),
            );
        }
    }
}
