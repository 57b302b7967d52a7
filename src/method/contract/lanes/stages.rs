//! The classical Runge–Kutta method under forces, all bodies of a block stage by stage.

use super::acting::{Acting, FORCES, Torques, quaternion, set_quaternion, set_vector, vector};
use super::block::PARTS;
use crate::body::{Clock, Phase};
use crate::method::rk4::sum_of_stages;
use crate::method::runge_kutta::rate_under;
use crate::num::{Dd, LANES, Lane};

/// Attitudes and momenta of a block, or changes of them.
#[derive(Debug)]
struct Phases {
    attitude: [Lane; 4],
    momentum: [Lane; 3],
}

impl Phases {
    const ZERO: Phases = Phases { attitude: [Lane::ZERO; 4], momentum: [Lane::ZERO; 3] };

    #[inline(always)]
    fn at(&self, n: usize) -> Phase<f64> {
        phase(&self.attitude, &self.momentum, n)
    }

    #[inline(always)]
    fn set(&mut self, n: usize, x: Phase<f64>) {
        set_quaternion(&mut self.attitude, n, x.attitude);
        set_vector(&mut self.momentum, n, x.momentum_body);
    }
}

#[inline(always)]
fn phase(attitude: &[Lane; 4], momentum: &[Lane; 3], n: usize) -> Phase<f64> {
    Phase { attitude: quaternion(attitude, n), momentum_body: vector(momentum, n) }
}

/// Room for the stages of a step.
#[derive(Debug)]
pub(super) struct Stages {
    /// Where the rates of a stage are taken.
    here: Phases,
    omega: [Lane; 3],
    torques: Torques,
    /// k₁.
    first: Phases,
    /// k₂, then k₂ + k₃.
    middle: Phases,
}

impl Stages {
    pub(super) const ZERO: Stages = Stages {
        here: Phases::ZERO,
        omega: [Lane::ZERO; 3],
        torques: Torques::ZERO,
        first: Phases::ZERO,
        middle: Phases::ZERO,
    };

    /// Takes step number `step`: for each lane the operations of the scalar step in their order.
    #[inline(always)]
    pub(super) fn step(
        &mut self,
        (acting, numbers): (&Acting, &[Lane; FORCES]),
        inverse_moments: &[Lane; 3],
        clock: &Clock,
        step: u64,
        points: &mut [Lane; PARTS],
    ) {
        let Stages { here, omega, torques, first, middle } = self;
        let Some((q, points)) = points.split_first_chunk_mut::<4>() else { return };
        let Some((m, _)) = points.split_first_chunk_mut::<3>() else { return };
        let (h, whole, begin) = (clock.step, Dd::from(clock.step), clock.at(step));
        let places = [begin, begin.later(whole * 0.5), begin.later(whole)].map(|at| acting.place(at));
        let half = h * 0.5;

        for n in 0..LANES {
            set_vector(omega, n, vector(m, n).times(vector(inverse_moments, n)));
        }
        acting.torques(numbers, places[0].as_ref(), q, omega, torques);
        for n in 0..LANES {
            let x = phase(q, m, n);
            let k = rate_under(&x, vector(omega, n), vector(&torques.torque, n));
            first.set(n, k);
            let x = x + k * half;
            here.set(n, x);
            set_vector(omega, n, x.momentum_body.times(vector(inverse_moments, n)));
        }
        acting.torques(numbers, places[1].as_ref(), &here.attitude, omega, torques);
        for n in 0..LANES {
            let k = rate_under(&here.at(n), vector(omega, n), vector(&torques.torque, n));
            middle.set(n, k);
            let x = phase(q, m, n) + k * half;
            here.set(n, x);
            set_vector(omega, n, x.momentum_body.times(vector(inverse_moments, n)));
        }
        acting.torques(numbers, places[1].as_ref(), &here.attitude, omega, torques);
        for n in 0..LANES {
            let k = rate_under(&here.at(n), vector(omega, n), vector(&torques.torque, n));
            middle.set(n, middle.at(n) + k);
            let x = phase(q, m, n) + k * h;
            here.set(n, x);
            set_vector(omega, n, x.momentum_body.times(vector(inverse_moments, n)));
        }
        acting.torques(numbers, places[2].as_ref(), &here.attitude, omega, torques);
        for n in 0..LANES {
            let k = rate_under(&here.at(n), vector(omega, n), vector(&torques.torque, n));
            let x = sum_of_stages(h, phase(q, m, n), first.at(n), middle.at(n), k);
            set_quaternion(q, n, x.attitude);
            set_vector(m, n, x.momentum_body);
        }
    }
}
