//! The programs that may have made a record: the equations of motion, and the mistakes that are made in them.

use super::Frame;
use crate::body::{Body, Field, Forces, Time, Wheels};
use crate::rotation::{Quat, Vec3};

/// How a program turns the attitude: `q̇ = ½ c q ω` or `½ c ω q`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Turn {
    /// Axes in which ω is taken to be.
    pub(super) frame: Frame,
    /// c: −1 of a wrong sign, another number of a wrong unit.
    pub(super) factor: f64,
}

/// How a program moves the angular velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Law {
    /// Euler's equations, or L in space.
    Euler,
    /// Between body and space by the transposed rotation.
    Transposed,
    /// Forces at the transposed attitude.
    TransposedForces,
    /// The torque alone, without ω × Iω.
    NoGyroscopicTerm,
    /// Each component of ω × Iω with a sign of its own.
    GyroscopicSigns([f64; 3]),
}

/// A program: the frame that its angular velocity is in, how it moves it and how it turns the attitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Program {
    pub(super) frame: Frame,
    pub(super) law: Law,
    pub(super) turn: Turn,
}

impl Program {
    /// The program without a mistake.
    pub(super) fn right(frame: Frame) -> Self {
        Program { frame, law: Law::Euler, turn: Turn { frame, factor: 1.0 } }
    }
}

/// A body as the programs see it: principal axes and `f64`.
pub(super) struct Dynamics {
    axes: Quat<f64>,
    moments: Vec3<f64>,
    inverse: Vec3<f64>,
    scale: f64,
    forces: Option<Forces<f64>>,
    wheels: Option<Wheels>,
    /// Where forces or motors are switched: the same between two switchings, and since when.
    phases: Vec<(f64, Dynamics)>,
}

/// Turn of one step, rad.
const STEP: f64 = 0.06;

/// Most steps between two rows; a way of more turns tells nothing.
const MOST_STEPS: f64 = 512.0;

/// That way, rad.
pub(super) const FARTHEST: f64 = MOST_STEPS * STEP;

/// Attitude, body → space, and what the program moves: the momentum in its frame, or ω itself.
type Phase = (Quat<f64>, Vec3<f64>);

impl Dynamics {
    pub(super) fn new(body: &Body) -> Self {
        let times = body.switching_times();
        let first = times.first().map(|time| (f64::NEG_INFINITY, Self::smooth(&body.acting(*time, false))));
        let others = times.iter().map(|time| (*time, Self::smooth(&body.acting(*time, true))));
        Dynamics { phases: first.into_iter().chain(others).collect(), ..Self::smooth(body) }
    }

    fn smooth(body: &Body) -> Self {
        let rotor = body.rotor();
        let free = body.problem() == crate::body::Problem::Free;
        Dynamics {
            axes: body.inertia().frame().map(|x| x.hi()),
            moments: rotor.moments(),
            inverse: rotor.inverse_moments(),
            scale: body.scale(),
            forces: (!free).then(|| body.field()),
            wheels: body.momentum_of_wheels(),
            phases: Vec::new(),
        }
    }

    /// I⁻¹ of a momentum in body axes, in the units of the body.
    pub(super) fn omega(&self, momentum_body: Vec3<f64>) -> Vec3<f64> {
        let inside = self.axes.rotate_back(momentum_body) * (1.0 / self.scale);
        self.axes.rotate(inside.times(self.inverse))
    }

    /// I ω in body axes, in units of the solver frame.
    pub(super) fn momentum(&self, omega_body: Vec3<f64>) -> Vec3<f64> {
        self.axes.rotate(self.axes.rotate_back(omega_body).times(self.moments))
    }

    /// In units of the solver frame.
    pub(super) fn largest_moment(&self) -> f64 {
        self.moments.0.into_iter().fold(0.0, f64::max)
    }

    /// The state after `dt` s, which are positive, of the state (`attitude`, `omega`) at `t` s, with ω in the frame of the program.
    pub(super) fn after(
        &self,
        program: &Program,
        t: f64,
        dt: f64,
        attitude: Quat<f64>,
        omega: Vec3<f64>,
    ) -> (Quat<f64>, Vec3<f64>) {
        if self.phases.is_empty() {
            return self.between_switchings(program, t, dt, attitude, omega);
        }
        let (mut from, mut state) = (t, (attitude, omega));
        for (n, (_, phase)) in self.phases.iter().enumerate() {
            let to = self.phases.get(n + 1).map_or(t + dt, |(next, _)| next.min(t + dt));
            if to > from {
                state = phase.between_switchings(program, from, to - from, state.0, state.1);
                from = to;
            }
        }
        state
    }

    fn between_switchings(
        &self,
        program: &Program,
        t: f64,
        dt: f64,
        attitude: Quat<f64>,
        omega: Vec3<f64>,
    ) -> (Quat<f64>, Vec3<f64>) {
        // solver frame: vectors in the body turn with the axes
        let inside = |v: Vec3<f64>| if program.frame == Frame::Body { self.axes.rotate_back(v) } else { v };
        let start = inside(omega);
        let q = attitude * self.axes;
        let turned = (program.turn.factor.abs()).max(1.0) * start.norm() * dt.abs();
        let n = (turned / STEP).ceil().max(4.0);
        if n.is_nan() || n > MOST_STEPS {
            return (attitude, omega);
        }
        // the momentum of wheels turns ω in the body however slowly that turns
        let by_wheels =
            [t, t + dt].map(|t| self.turn_by_wheels(t)).into_iter().fold(0.0, f64::max) * dt.abs();
        let n = n.max((by_wheels / STEP).ceil().min(MOST_STEPS));
        let h = dt / n;
        let mut x = (q, self.momentum_of(program, q, start));
        for k in 0..n as usize {
            x = self.rk4(program, t + h * k as f64, h, x);
        }
        let (q, moved) = x;
        let omega = self.omega_of(program, q, moved);
        let q = q * self.axes.conjugate();
        let q = q * (1.0 / q.norm_squared().sqrt());
        (q, if program.frame == Frame::Body { self.axes.rotate(omega) } else { omega })
    }

    /// How fast the momentum of the wheels at the time `t` turns ω in the body at most, rad/s.
    fn turn_by_wheels(&self, t: f64) -> f64 {
        let least = self.inverse.0.into_iter().fold(0.0, f64::max);
        self.wheels.as_ref().map_or(0.0, |wheels| wheels.at(Time::from_seconds(t)).norm().hi() * least)
    }

    fn momentum_of(&self, program: &Program, q: Quat<f64>, omega: Vec3<f64>) -> Vec3<f64> {
        let there = |v: Vec3<f64>| v.times(self.moments);
        match (program.law, program.frame) {
            (Law::Euler | Law::TransposedForces, Frame::Body) => there(omega),
            (Law::Euler | Law::TransposedForces, Frame::Space) => q.rotate(there(q.rotate_back(omega))),
            (Law::Transposed, Frame::Body) => q.rotate_back(there(omega)),
            (Law::Transposed, Frame::Space) => q.rotate_back(there(q.rotate(omega))),
            (Law::NoGyroscopicTerm | Law::GyroscopicSigns(_), _) => omega,
        }
    }

    fn omega_of(&self, program: &Program, q: Quat<f64>, moved: Vec3<f64>) -> Vec3<f64> {
        let back = |v: Vec3<f64>| v.times(self.inverse);
        match (program.law, program.frame) {
            (Law::Euler | Law::TransposedForces, Frame::Body) => back(moved),
            (Law::Euler | Law::TransposedForces, Frame::Space) => q.rotate(back(q.rotate_back(moved))),
            (Law::Transposed, Frame::Body) => back(q.rotate(moved)),
            (Law::Transposed, Frame::Space) => q.rotate_back(back(q.rotate(moved))),
            (Law::NoGyroscopicTerm | Law::GyroscopicSigns(_), _) => moved,
        }
    }

    fn rate(&self, program: &Program, t: f64, (q, moved): Phase) -> Phase {
        let omega = self.omega_of(program, q, moved);
        let turning = omega * program.turn.factor;
        let q_rate = match program.turn.frame {
            Frame::Body => q.rate(turning),
            Frame::Space => (Quat::new(0.0, turning) * q) * 0.5,
        };
        let torque = self.forces.as_ref().map_or(Vec3::zero(), |forces| {
            // the attitude that the program would ask its forces at
            let transposed = matches!(program.law, Law::Transposed | Law::TransposedForces);
            let seen = if transposed { q.conjugate() } else { q };
            let in_body = if program.frame == Frame::Body { omega } else { seen.rotate_back(omega) };
            forces.torque(Time::from_seconds(t), seen, in_body)
        });
        let moved_rate = match (program.law, program.frame) {
            (Law::Euler | Law::TransposedForces, Frame::Body) => moved.cross(omega) + torque,
            (Law::Euler | Law::TransposedForces, Frame::Space) => q.rotate(torque),
            (Law::Transposed, _) => q.rotate_back(torque),
            (Law::GyroscopicSigns(signs), Frame::Body) => {
                let gyroscopic = omega.times(self.moments).cross(omega).times(Vec3(signs));
                (gyroscopic + torque).times(self.inverse)
            }
            (Law::NoGyroscopicTerm, Frame::Body) => torque.times(self.inverse),
            // a sign of a term has no meaning in space
            (Law::NoGyroscopicTerm | Law::GyroscopicSigns(_), Frame::Space) => {
                q.rotate(torque.times(self.inverse))
            }
        };
        (q_rate, moved_rate)
    }

    fn rk4(&self, program: &Program, t: f64, h: f64, x: Phase) -> Phase {
        let along = |(q, m): Phase, (dq, dm): Phase, h: f64| (q + dq * h, m + dm * h);
        let half = 0.5 * h;
        let a = self.rate(program, t, x);
        let b = self.rate(program, t + half, along(x, a, half));
        let c = self.rate(program, t + half, along(x, b, half));
        let d = self.rate(program, t + h, along(x, c, h));
        let mean_m: Vec3<f64> = (a.1 + (b.1 + c.1) * 2.0 + d.1) * (1.0 / 6.0);
        let mean_q: Quat<f64> = (a.0 + (b.0 + c.0) * 2.0 + d.0) * (1.0 / 6.0);
        along(x, (mean_q, mean_m), h)
    }
}
