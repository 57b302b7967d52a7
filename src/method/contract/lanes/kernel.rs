//! Loops over the lanes of a block.
//!
//! Each loop is short: a processor looks about a hundred operations ahead, and the operations of one lane wait for each other.
//! So one loop takes the sines of a turn and another turns by them, while a whole step of the Runge–Kutta method, in which
//! less waits, is one.

use core::f64::consts::FRAC_PI_4;
use core::ops::Range;

use multiversion::multiversion;

use super::acting::{Acting, FORCES, Torques, vector};
use super::block::{Block, PARTS};
use super::stages::Stages;
use crate::body::{Place, Point};
use crate::flow::{quarter_squared, quarters, turn_by};
use crate::method::rk4::{RK4_CONSTANTS, Rk4Step};
use crate::num::trig::{
    SMALL, sin_cos_moderate, sin_versine, sin_versine_moderate, sin_versine_small, sinc_cos_small,
};
use crate::num::{Dd, LANES, Lane, Real as _};
use crate::rotation::Vec3;

/// Does `$step` with the point of every lane in turn.
macro_rules! each {
    ($points:expr, |$n:ident, $x:ident| $step:expr) => {{
        let [q0, q1, q2, q3, m0, m1, m2, r0, r1, r2, r3, n0, n1, n2] = &mut *$points;
        for $n in 0..LANES {
            let parts = [
                q0[$n], q1[$n], q2[$n], q3[$n], m0[$n], m1[$n], m2[$n], r0[$n], r1[$n], r2[$n], r3[$n],
                n0[$n], n1[$n], n2[$n],
            ];
            let $x = &mut Point::from_parts(parts, 0);
            $step;
            [
                q0[$n], q1[$n], q2[$n], q3[$n], m0[$n], m1[$n], m2[$n], r0[$n], r1[$n], r2[$n], r3[$n],
                n0[$n], n1[$n], n2[$n],
            ] = $x.parts();
        }
    }};
}

/// What steps are made of.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Kernel {
    /// Flows, one after another, with a constant each.
    Flows(Vec<LaneFlow>),
    /// The classical Runge–Kutta method without forces, normalised or not; the constants are those of [`Rk4Step`].
    FreeRk4(bool),
    /// The same under forces; the constants are those, and after them those of [`Scaled`].
    Rk4(bool),
}

/// A part of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LaneFlow {
    /// A turn about a principal axis; the constant is half its angle over the momentum about the axis.
    Turn(usize, Width),
    /// A turn about the momentum; the constant is a quarter of its angle over |m|.
    Ball,
    /// A kick, so many seconds after the beginning of the step; the constant is its length, s.
    Kick(Dd),
    /// Brings |q| back to 1 in the last of so many steps; the constant is of no use.
    Renormalize(u64),
}

/// How far a turn goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Width {
    /// Half of each angle is at most [`SMALL`](crate::num::trig::SMALL).
    Small,
    /// At most π/4.
    Moderate,
    /// Any angle: as the momenta are.
    Any,
}

impl LaneFlow {
    /// The same so many seconds later.
    pub(super) fn later(self, duration: Dd) -> Self {
        match self {
            LaneFlow::Kick(begun) => LaneFlow::Kick(begun + duration),
            other => other,
        }
    }
}

impl Kernel {
    /// Whether the numbers of forces stand before its constants.
    pub(super) fn takes_forces(&self) -> bool {
        match self {
            Kernel::Flows(flows) => flows.iter().any(|flow| matches!(flow, LaneFlow::Kick(_))),
            Kernel::FreeRk4(_) => false,
            Kernel::Rk4(_) => true,
        }
    }
}

/// The steps with the numbers `steps`, by the widest instructions of the processor.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
pub(super) fn widest(block: &mut Block, range: Range<u64>) {
    steps(block, range);
}

/// The same by AVX2 at most.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn avx2(block: &mut Block, range: Range<u64>) {
    steps(block, range);
}

/// The same by what the program is compiled for.
#[inline(never)]
pub(super) fn baseline(block: &mut Block, range: Range<u64>) {
    steps(block, range);
}

#[inline(always)]
fn steps(block: &mut Block, range: Range<u64>) {
    let takes_forces = block.kernel.takes_forces();
    let Block { kernel, acting, clock, points, constants, .. } = block;
    let (numbers, constants) = constants.split_at(if takes_forces { FORCES } else { 0 });
    match kernel {
        Kernel::Flows(flows) => {
            let (mut angles, mut torques) = ([Lane::ZERO; 2], Torques::ZERO);
            for step in range {
                for (flow, constants) in flows.iter().zip(constants) {
                    match flow {
                        LaneFlow::Turn(axis, width) => turn(*axis, *width, points, constants, &mut angles),
                        LaneFlow::Ball => ball(points, constants, &mut angles),
                        LaneFlow::Kick(begun) => {
                            let Some(numbers) = numbers.first_chunk() else { return };
                            let place = acting.place(clock.at(step).later(*begun));
                            kick((acting, numbers), place.as_ref(), points, constants, &mut torques);
                        }
                        LaneFlow::Renormalize(every) if step % every == every - 1 => {
                            each!(points, |n, x| x.renormalize());
                        }
                        LaneFlow::Renormalize(_) => {}
                    }
                }
            }
        }
        Kernel::FreeRk4(normalized) => {
            if let Some(constants) = constants.first_chunk() {
                for _ in range {
                    if *normalized {
                        free_rk4::<true>(points, constants);
                    } else {
                        free_rk4::<false>(points, constants);
                    }
                }
            }
        }
        Kernel::Rk4(normalized) => {
            let Some(numbers) = numbers.first_chunk() else { return };
            let Some((rk4, constants)) = constants.split_first_chunk() else { return };
            let Some(scaled) = constants.first_chunk() else { return };
            let mut stages = Stages::ZERO;
            for step in range {
                stages.step((acting, numbers), (rk4, scaled), clock, step, points);
                if *normalized {
                    each!(points, |n, x| x.attitude = x.attitude.normalized());
                }
            }
        }
    }
}

/// Whether none of `angles` is larger than `most`.
#[inline(always)]
fn are_within(most: f64, angles: &Lane) -> bool {
    // counted, as what ends a loop early is not done in vectors
    let mut within = 0;
    for n in 0..LANES {
        within += usize::from(angles[n].abs() <= most);
    }
    within == LANES
}

/// A turn; `angles` is room for the sines of half the angles, and for one less their cosines.
#[inline(always)]
fn turn(axis: usize, width: Width, points: &mut [Lane; PARTS], half_rates: &Lane, angles: &mut [Lane; 2]) {
    let [sines, versines] = angles;
    let momenta = &points[4 + axis % 3];
    let width = match width {
        Width::Any => {
            for n in 0..LANES {
                sines[n] = momenta[n] * half_rates[n];
            }
            if are_within(FRAC_PI_4, sines) { Width::Moderate } else { Width::Any }
        }
        known => known,
    };
    match width {
        Width::Small => {
            for n in 0..LANES {
                (sines[n], versines[n]) = sin_versine_small(momenta[n] * half_rates[n]);
            }
        }
        Width::Moderate => {
            for n in 0..LANES {
                (sines[n], versines[n]) = sin_versine_moderate(momenta[n] * half_rates[n]);
            }
        }
        Width::Any => {
            for n in 0..LANES {
                (sines[n], versines[n]) = sin_versine(momenta[n] * half_rates[n]);
            }
        }
    }
    match axis {
        0 => each!(points, |n, x| turn_by::<0, f64>(x, (sines[n], versines[n]))),
        1 => each!(points, |n, x| turn_by::<1, f64>(x, (sines[n], versines[n]))),
        _ => each!(points, |n, x| turn_by::<2, f64>(x, (sines[n], versines[n]))),
    }
}

/// A turn about the momentum; `angles` is room for a quarter of the angles.
#[inline(always)]
fn ball(points: &mut [Lane; PARTS], rates: &Lane, angles: &mut [Lane; 2]) {
    let [sincs, cosines] = angles;
    let [_, _, _, _, a, b, c, ..] = points;
    for n in 0..LANES {
        let squared = quarter_squared(rates[n], Vec3([a[n], b[n], c[n]]));
        (sincs[n], cosines[n]) = (squared, squared.sqrt());
    }
    if are_within(SMALL * SMALL, sincs) {
        for n in 0..LANES {
            (sincs[n], cosines[n]) = sinc_cos_small(sincs[n]);
        }
    } else if are_within(FRAC_PI_4, cosines) {
        for n in 0..LANES {
            let (squared, x) = (sincs[n], cosines[n]);
            let (small, (sin, cos)) = (sinc_cos_small(squared), sin_cos_moderate(x));
            (sincs[n], cosines[n]) = if squared <= SMALL * SMALL { small } else { (sin / x, cos) };
        }
    } else {
        for n in 0..LANES {
            (sincs[n], cosines[n]) = sincs[n].sinc_cos_of_root();
        }
    }
    each!(points, |n, x| {
        let turned = quarters(rates[n], x.momentum_body, (sincs[n], cosines[n]));
        x.add_attitude(x.attitude * turned);
    });
}

/// A kick at `place`.
#[inline(always)]
fn kick(
    (acting, numbers): (&Acting, &[Lane; FORCES]),
    place: Option<&Place<f64>>,
    points: &mut [Lane; PARTS],
    lengths: &Lane,
    torques: &mut Torques,
) {
    let Some(attitude) = points.first_chunk() else { return };
    acting.torques(numbers, place, attitude, &[Lane::ZERO; 3], torques);
    each!(points, |n, x| x.add_momentum(vector(&torques.torque, n) * lengths[n]));
}

#[inline(always)]
fn free_rk4<const NORMALIZED: bool>(points: &mut [Lane; PARTS], constants: &[Lane; RK4_CONSTANTS]) {
    each!(points, |n, x| {
        let mut moved = rk4_of(constants, n).free(x.phase());
        if NORMALIZED {
            moved.attitude = moved.attitude.normalized();
        }
        x.set_phase(moved);
    });
}

/// The step of the body in lane `n`.
#[inline(always)]
pub(super) fn rk4_of(constants: &[Lane; RK4_CONSTANTS], n: usize) -> Rk4Step<f64> {
    let [c0, c1, c2, c3, c4, c5, c6, c7, c8] = constants;
    Rk4Step::of([c0[n], c1[n], c2[n], c3[n], c4[n], c5[n], c6[n], c7[n], c8[n]])
}
