//! Bodies with starts and forces on which the methods that choose their steps are tried.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::body::{Body, Force, Potential, State, Time};
use polhode::inertia::Inertia;
use polhode::method::method;
use polhode::num::Real;
use polhode::rotation::{Quat, Vec3};
use polhode::run::Run;

pub(crate) fn free() -> (Body, State) {
    started(Body::free(Inertia::from_moments([1.0, 2.0, 3.0]).unwrap()), [0.4, 1.0, -0.3])
}

pub(crate) fn top() -> (Body, State) {
    let inertia = Inertia::from_moments([1.0, 1.0, 0.25]).unwrap();
    started(Body::heavy(inertia, [0.0, 0.0, 0.7].into()).unwrap(), [0.3, -0.2, 5.0])
}

/// A magnet along body z in a field along space x, on a body whose tensor is not diagonal.
pub(crate) struct Magnet(pub(crate) f64);

impl<S: Real> Potential<S> for Magnet {
    fn energy(&self, _: Time, attitude: Quat<S>) -> S {
        -(S::of(self.0) * attitude.rotate(Vec3::unit(2))[0])
    }
    fn torque(&self, _: Time, attitude: Quat<S>) -> Vec3<S> {
        Vec3::unit(2).cross(attitude.rotate_back(Vec3::unit(0))) * S::of(self.0)
    }
}

pub(crate) fn magnet() -> (Body, State) {
    let tensor = Matrix3::new(1.0, 0.1, 0.2, 0.1, 2.0, 0.3, 0.2, 0.3, 2.5);
    let body = Body::free(Inertia::from_tensor(tensor).unwrap());
    started(body.with(Force::potential("magnet", Magnet(0.5))), [0.4, 1.0, -0.3])
}

pub(crate) fn satellite() -> (Body, State) {
    let inertia = Inertia::from_moments([10.0, 25.0, 30.0]).unwrap();
    let gradient = Force::gravity_gradient(0.001, 0.3).unwrap();
    started(Body::free(inertia).with(gradient), [2e-4, -3e-4, 1.2e-3])
}

/// On from t = 3 to 4.5: steps are rejected at both ends.
pub(crate) fn thruster() -> (Body, State) {
    let (body, start) = free();
    let push = |t: f64| Vector3::new(0.0, 0.0, if (3.0..4.5).contains(&t) { 0.5 } else { 0.0 });
    (body.with(Force::torque_fn("thruster", move |t, _, _| push(t))), start)
}

pub(crate) fn started(body: Body, omega: [f64; 3]) -> (Body, State) {
    let tilt = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.5);
    let start = body.state(tilt, omega.into()).unwrap();
    (body, start)
}

pub(crate) fn run(name: &str, (body, start): &(Body, State), h: f64) -> Run {
    Run::new(&method(name).unwrap(), body, start, h).unwrap()
}
