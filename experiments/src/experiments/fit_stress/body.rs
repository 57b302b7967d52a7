//! Bodies that are not free, and bodies that are not rigid: their rates, by the classical method of Runge and Kutta.

use nalgebra::{Matrix3, Quaternion, Vector3};
use polhode::num::Random;

/// What acts on the body, or moves in it. Its trace is 1, so that a torque is in rad/s².
#[derive(Clone, Copy)]
pub(super) enum Acting {
    Nothing,
    /// −k J ω, 1/s.
    Drag(f64),
    /// −c |ω| J ω, per rad.
    Quadratic(f64),
    /// Constant in body axes, random direction, rad/s².
    Constant(f64),
    /// A magnet in a field that is fixed in space: μ × b, both directions random, rad/s².
    Magnet(f64),
    /// Eddy currents in that field: −k b × (ω × b), 1/s.
    Eddy(f64),
    /// The tensor breathes: its share and its frequency, Hz.
    Flexible(f64, f64),
    /// A ball of fluid in a round tank: its share of the trace, and the time in which friction brings it along, s.
    Fluid(f64, f64),
    /// The tensor grows about one axis by this share, after this part of the record.
    Deployed(f64, f64),
    /// A hand: its torque, rad/s², when, as a part of the record, and the time in which it fades to both sides, s.
    Hand(f64, f64, f64),
    /// A wheel that nobody knows of: its momentum over that of the body.
    Wheel(f64),
    /// White torque noise over the trace, rad/s² √s.
    Noise(f64),
}

/// A body with what acts on it, directions drawn.
struct Body {
    acting: Acting,
    j: Matrix3<f64>,
    /// Two directions.
    a: Vector3<f64>,
    b: Vector3<f64>,
    duration: f64,
    wheel: Vector3<f64>,
}

/// Angular momentum in body axes, attitude, momentum of a fluid, and their derivatives.
#[derive(Clone, Copy)]
struct State {
    m: Vector3<f64>,
    q: Quaternion<f64>,
    fluid: Vector3<f64>,
}

impl State {
    fn plus(&self, slope: &State, h: f64) -> State {
        State { m: self.m + slope.m * h, q: self.q + slope.q * h, fluid: self.fluid + slope.fluid * h }
    }
}

impl Body {
    fn tensor(&self, t: f64) -> Matrix3<f64> {
        match self.acting {
            Acting::Flexible(share, hertz) => {
                let phase = core::f64::consts::TAU * hertz * t;
                self.j * (1.0 + share * libm::sin(phase) * 0.5) + self.along(share * libm::sin(phase))
            }
            Acting::Deployed(share, part) if t > part * self.duration => self.j + self.along(share),
            _ => self.j,
        }
    }

    /// What mass moved along the first direction adds to the moments about the other two.
    fn along(&self, share: f64) -> Matrix3<f64> {
        (Matrix3::identity() - self.a * self.a.transpose()) * (0.5 * share)
    }

    fn rate(&self, t: f64, state: &State) -> Vector3<f64> {
        let inverse = self.tensor(t).try_inverse().unwrap_or_default();
        inverse * (state.m - self.wheel)
    }

    fn slope(&self, t: f64, state: &State) -> State {
        let w = self.rate(t, state);
        let mut slope = State {
            m: state.m.cross(&w),
            q: state.q * Quaternion::from_imag(w) * 0.5,
            fluid: Vector3::zeros(),
        };
        // the second direction is fixed in space
        let field = || (state.q.conjugate() * Quaternion::from_imag(self.b) * state.q).imag();
        slope.m += match self.acting {
            Acting::Drag(k) => self.j * w * -k,
            Acting::Quadratic(c) => self.j * w * (-c * w.norm()),
            Acting::Constant(size) => self.a * size,
            Acting::Magnet(size) => self.a.cross(&field()) * size,
            Acting::Eddy(k) => field().cross(&w.cross(&field())) * -k,
            Acting::Hand(size, part, fades) => {
                self.a * (size * libm::exp(-(t - part * self.duration).abs() / fades))
            }
            Acting::Fluid(share, time) => {
                let pull = (w - state.fluid / share) * (share / time);
                slope.fluid = state.fluid.cross(&w) + pull;
                -pull
            }
            _ => Vector3::zeros(),
        };
        slope
    }

    fn step(&self, t: f64, state: &State, h: f64) -> State {
        let a = self.slope(t, state);
        let b = self.slope(t + 0.5 * h, &state.plus(&a, 0.5 * h));
        let c = self.slope(t + 0.5 * h, &state.plus(&b, 0.5 * h));
        let d = self.slope(t + h, &state.plus(&c, h));
        let sum = State {
            m: a.m + (b.m + c.m) * 2.0 + d.m,
            q: a.q + (b.q + c.q) * 2.0 + d.q,
            fluid: a.fluid + (b.fluid + c.fluid) * 2.0 + d.fluid,
        };
        let next = state.plus(&sum, h / 6.0);
        State { q: next.q / next.q.norm(), ..next }
    }
}

/// Longest step, rad of the motion: errors of 1e-9 over a minute.
const STEP: f64 = 0.02;

/// Rates at ascending `times` of a body of trace 1 that starts with `omega` at time 0; the first direction drawn is that of what acts.
pub(super) fn rates(
    j: &Matrix3<f64>,
    omega: &Vector3<f64>,
    times: &[f64],
    acting: Acting,
    random: &mut Random,
) -> Vec<Vector3<f64>> {
    let (a, b) = (random.normal_vector().normalize(), random.normal_vector().normalize());
    let duration = times.last().copied().unwrap_or(0.0);
    let wheel =
        if let Acting::Wheel(share) = acting { a * (share * (j * omega).norm()) } else { Vector3::zeros() };
    let body = Body { acting, j: *j, a, b, duration, wheel };
    let share = if let Acting::Fluid(share, _) = acting { share } else { 0.0 };
    let mut state =
        State { m: body.tensor(0.0) * omega + wheel, q: Quaternion::identity(), fluid: omega * share };
    let mut t = 0.0;
    let mut rates = Vec::with_capacity(times.len());
    for &next in times {
        let steps = libm::ceil((next - t) * omega.norm() / STEP).max(1.0);
        let h = (next - t) / steps;
        for k in 0..steps as u64 {
            state = body.step(t + k as f64 * h, &state, h);
            if let Acting::Noise(size) = acting {
                state.m += random.normal_vector() * (size * h.abs().sqrt());
            }
        }
        t = next;
        rates.push(body.rate(t, &state));
    }
    rates
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitQuaternion;
    use polhode::flow::FreeMotion;
    use polhode::inertia::Inertia;

    /// A free body, and the body in each of the others whose disturbance is nil, have the rates of the exact motion.
    #[test]
    fn without_a_disturbance_the_motion_is_the_exact_one() {
        let j = Matrix3::from_diagonal(&(Vector3::new(1.0, 2.0, 2.6) / 5.6));
        let omega = Vector3::new(0.3, 1.0, 0.4);
        let body = Inertia::from_tensor(j).unwrap();
        let exact = FreeMotion::from_omega(&body, UnitQuaternion::identity(), omega).unwrap();
        let times: Vec<f64> = (0..600).map(|i| f64::from(i) / 10.0).collect();
        for acting in [
            Acting::Nothing,
            Acting::Drag(0.0),
            Acting::Magnet(0.0),
            Acting::Flexible(0.0, 0.5),
            Acting::Fluid(1e-12, 1.0),
            Acting::Deployed(0.0, 0.5),
            Acting::Wheel(0.0),
        ] {
            let found = rates(&j, &omega, &times, acting, &mut Random::new(1));
            for (t, w) in times.iter().zip(&found) {
                let m: Vector3<f64> = exact.at(*t).unwrap().momentum_body.into();
                let error = (w - j.try_inverse().unwrap() * m).norm();
                assert!(error < 1e-8, "{t} {error:e}");
            }
        }
    }

    /// What acts from inside leaves the angular momentum in space as it is, and friction takes energy.
    #[test]
    fn inner_forces_keep_the_angular_momentum() {
        let j = Matrix3::from_diagonal(&(Vector3::new(1.0, 2.0, 2.6) / 5.6));
        let (a, b) = (Vector3::x(), Vector3::y());
        let omega = Vector3::new(0.3, 1.0, 0.4);
        for acting in [Acting::Fluid(0.05, 2.0), Acting::Flexible(0.02, 0.5), Acting::Deployed(0.03, 0.5)] {
            let share = if let Acting::Fluid(share, _) = acting { share } else { 0.0 };
            let body = Body { acting, j, a, b, duration: 20.0, wheel: Vector3::zeros() };
            let mut state = State { m: j * omega, q: Quaternion::identity(), fluid: omega * share };
            let in_space = |s: &State| (s.q * Quaternion::from_imag(s.m + s.fluid) * s.q.conjugate()).imag();
            let before = in_space(&state);
            for k in 0..2000 {
                state = body.step(f64::from(k) * 0.01, &state, 0.01);
            }
            assert!((in_space(&state) - before).norm() < 1e-9, "{:e}", (in_space(&state) - before).norm());
        }
    }
}
