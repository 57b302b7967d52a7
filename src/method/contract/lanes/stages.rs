//! The classical Runge–Kutta method under forces, all bodies of a block stage by stage.

use super::acting::{Acting, FORCES, Torques, quaternion, set_quaternion, set_vector, vector};
use super::block::PARTS;
use super::kernel::rk4_of;
use crate::body::{Phase, Place};
use crate::method::rk4::{RK4_CONSTANTS, third};
use crate::num::{LANES, Lane};
use crate::rotation::Vec3;

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
        Phase { attitude: quaternion(&self.attitude, n), momentum_body: vector(&self.momentum, n) }
    }

    #[inline(always)]
    fn set(&mut self, n: usize, x: Phase<f64>) {
        set_quaternion(&mut self.attitude, n, x.attitude);
        set_vector(&mut self.momentum, n, x.momentum_body);
    }
}

/// Room for the stages of a step, in the variables of [`Rk4Step`](crate::method::rk4::Rk4Step).
#[derive(Debug)]
pub(super) struct Stages {
    /// Where the rates of a stage are taken: q and p.
    here: Phases,
    omega: [Lane; 3],
    torques: Torques,
    /// k₁.
    first: Phases,
    /// 2 k₂, then 2 k₃ + 2 k₂.
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

    /// Takes a step with its beginning, middle and end at `places`: for each lane the operations of the scalar step in their order.
    #[inline(always)]
    pub(super) fn step(
        &mut self,
        (acting, numbers): (&Acting, &[Lane; FORCES]),
        (rk4, [u, v, w, rates]): (&[Lane; RK4_CONSTANTS], &[Lane; 4]),
        places: [Option<&Place<f64>>; 3],
        points: &mut [Lane; PARTS],
    ) {
        let Stages { here, omega, torques, first, middle } = self;
        let Some((q, points)) = points.split_first_chunk_mut::<4>() else { return };
        let Some((m, _)) = points.split_first_chunk_mut::<3>() else { return };

        /// The rates at `here` under the torques in lane `n`.
        macro_rules! rates_at {
            ($n:expr) => {{
                let x = here.at($n);
                let (k, l) = rk4_of(rk4, $n).free_rate(x.attitude, x.momentum_body);
                let torque = vector(&torques.torque, $n).times(Vec3([u[$n], v[$n], w[$n]]));
                Phase { attitude: k, momentum_body: l + torque }
            }};
        }
        /// Goes on from the beginning of the step by `$k`.
        macro_rules! go {
            ($n:expr, $k:expr) => {{
                let (k, p) = ($k, rk4_of(rk4, $n).scaled(vector(m, $n)));
                let (attitude, momentum_body) = (quaternion(q, $n) + k.attitude, p + k.momentum_body);
                here.set($n, Phase { attitude, momentum_body });
                set_vector(omega, $n, momentum_body * rates[$n]);
            }};
        }

        for n in 0..LANES {
            let p = rk4_of(rk4, n).scaled(vector(m, n));
            here.set(n, Phase { attitude: quaternion(q, n), momentum_body: p });
            set_vector(omega, n, p * rates[n]);
        }
        acting.torques(numbers, places[0], &here.attitude, omega, torques);
        for n in 0..LANES {
            let k = rates_at!(n);
            first.set(n, k);
            go!(n, k);
        }
        acting.torques(numbers, places[1], &here.attitude, omega, torques);
        for n in 0..LANES {
            let k = rates_at!(n);
            middle.set(n, k + k);
            go!(n, k);
        }
        acting.torques(numbers, places[1], &here.attitude, omega, torques);
        for n in 0..LANES {
            let k = rates_at!(n);
            let k = k + k;
            middle.set(n, k + middle.at(n));
            go!(n, k);
        }
        acting.torques(numbers, places[2], &here.attitude, omega, torques);
        for n in 0..LANES {
            let k = (first.at(n) + rates_at!(n)) + middle.at(n);
            let x = Phase { attitude: quaternion(q, n), momentum_body: vector(m, n) };
            let x = rk4_of(rk4, n).moved(x, k.attitude * third::<f64>(), k.momentum_body);
            set_quaternion(q, n, x.attitude);
            set_vector(m, n, x.momentum_body);
        }
    }
}
