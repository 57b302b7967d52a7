//! One clone through the encounter: what it is before and after.

use polhode::body::{Clock, Member, Point};
use polhode::flow::{FreeMotion, Mode, TumblingElements};
use polhode::inertia::Inertia;
use polhode::method::method;
use polhode::num::{Dd, Real};
use polhode::rotation::{Quat, Vec3};
use polhode_files::error::{Error, unexpected};

use super::inputs::encountering;

/// What a free body does, by its state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spin {
    /// Angular momentum in space, in the unit of the moments.
    pub(super) momentum: Vec3<f64>,
    /// 2E/|L|, rad/s.
    pub(super) effective: f64,
    /// Energy over the least with this momentum.
    pub(super) energy_ratio: f64,
    /// `None` where it does not tumble.
    pub(super) elements: Option<TumblingElements>,
}

impl Spin {
    pub(super) fn of(motion: &FreeMotion) -> Result<Self, Error> {
        let momentum = motion.point_at_dd(Dd::ZERO).momentum_space().map(Dd::hi) * motion.body().scale();
        let effective = motion.character().map_err(unexpected)?.spin;
        let [.., largest] = motion.body().inertia().principal_moments();
        let energy_ratio = largest * effective / momentum.norm();
        Ok(Spin { momentum, effective, energy_ratio, elements: motion.tumbling() })
    }

    pub(super) fn mode(&self) -> Option<Mode> {
        self.elements.map(|elements| elements.mode)
    }

    /// Longitude and latitude of L, degrees.
    pub(super) fn pole(&self) -> [f64; 2] {
        let [x, y, z] = self.momentum.0;
        let longitude = libm::atan2(y, x).to_degrees().rem_euclid(360.0);
        [longitude, libm::atan2(z, libm::hypot(x, y)).to_degrees()]
    }

    /// Angle between the poles of two, degrees.
    pub(super) fn angle(&self, other: &Spin) -> f64 {
        let (a, b) = (self.momentum, other.momentum);
        libm::atan2(a.cross(b).norm(), a.dot(b)).to_degrees()
    }
}

/// A body and its state so long before the perigee.
pub(super) struct Approach {
    pub(super) inertia: Inertia,
    pub(super) window: f64,
    pub(super) point: Point<f64>,
}

impl Approach {
    /// Of a member whose t = 0 is `until_perigee` s before the perigee.
    pub(super) fn of(member: &Member, until_perigee: f64, window: f64) -> Result<Self, Error> {
        let (attitude, omega) = (member.attitude.into(), member.omega_body.into());
        let motion = FreeMotion::from_omega(&member.inertia, attitude, omega).map_err(unexpected)?;
        Ok(Self::along(&motion, until_perigee, window))
    }

    pub(super) fn along(motion: &FreeMotion, until_perigee: f64, window: f64) -> Self {
        let point = motion.point_at_dd(Dd::of(until_perigee) - window).to_f64();
        Approach { inertia: motion.body().inertia().clone(), window, point }
    }

    /// The state, as that of a free body.
    pub(super) fn spin(&self) -> Result<Spin, Error> {
        Spin::of(&self.free(self.point))
    }

    /// The free motion from a point, also as long after the perigee.
    pub(super) fn free(&self, point: Point<f64>) -> FreeMotion {
        let attitude = Quat::<Dd>::of(point.attitude).normalized();
        FreeMotion::from_point(&self.inertia, Point::new(attitude, Vec3::of(point.momentum_body)))
    }

    /// As long after the perigee, by the method `name` in one interval of output.
    pub(super) fn passed(&self, name: &str) -> Result<Point<f64>, Error> {
        let body = encountering(self.inertia.clone())?;
        let clock = Clock { start: -self.window, step: 2.0 * self.window };
        let mut step = method(name).map_err(unexpected)?.prepare_f64(clock, &body).map_err(unexpected)?;
        let mut point = self.point;
        step.steps(&mut point, 1);
        Ok(point)
    }
}
