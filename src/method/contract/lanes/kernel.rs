//! Loops over the lanes of a block.
//!
//! Each loop is short: a processor looks about a hundred operations ahead, and the operations of one lane wait for each other.
//! So one loop takes the sines of a turn and another turns by them, while a whole step of the Runge–Kutta method, in which
//! less waits, is one.

use core::f64::consts::FRAC_PI_4;
use core::ops::Range;

use multiversion::multiversion;

use super::acting::{Acting, FORCES, Torques, quaternion, vector};
use super::block::{Block, PARTS};
use super::dmv::{self, Solves};
use super::stages::Stages;
use crate::body::{Clock, LinearPotential, Place, Point, Time};
use crate::flow::{Flow as _, FreeLanes, quarter_squared, quarters, turn_by};
use crate::method::Map as _;
use crate::method::contract::map::SOLVED;
use crate::method::rattle::DMV_CONSTANTS;
use crate::method::rk4::{RK4_CONSTANTS, Rk4Step};
use crate::num::trig::{
    SMALL, sin_cos_moderate, sin_versine, sin_versine_moderate, sin_versine_small, sinc_cos_small,
};
use crate::num::{Dd, LANES, Lane, Real as _};
use crate::rotation::Vec3;

/// Numbers of each body that [`LaneFlow::Gradient`] reads.
const GRADIENT_CONSTANTS: usize = 7;

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
    /// Flows, one after another, with as many constants each as they [take](LaneFlow::constants).
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
    /// The free flow; the constant is its length, s.
    Free,
    /// A kick, so many seconds after the beginning of the step; the constant is its length, s.
    Kick(Dd),
    /// The gradient of a squared torque; the constants are its share, the reciprocal moments and the moment of gravity.
    Gradient,
    /// The discrete Moser–Veselov map; the constants are those of [`DmvMap`], and above degree 0 those of the polynomials of this
    /// degree that modify it.
    Dmv(usize),
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
    /// How many numbers of each body it reads.
    pub(super) fn constants(self) -> usize {
        match self {
            LaneFlow::Gradient => GRADIENT_CONSTANTS,
            LaneFlow::Dmv(degree) => DMV_CONSTANTS + dmv::constants(degree),
            _ => 1,
        }
    }

    /// The same so many seconds later.
    pub(super) fn later(self, duration: Dd) -> Self {
        match self {
            LaneFlow::Kick(begun) => LaneFlow::Kick(begun + duration),
            other => other,
        }
    }
}

impl Kernel {
    /// Whether it takes free flows of bodies.
    pub(super) fn takes_free_flows(&self) -> bool {
        matches!(self, Kernel::Flows(flows) if flows.contains(&LaneFlow::Free))
    }

    /// Whether the numbers of forces stand before its constants.
    pub(super) fn takes_forces(&self) -> bool {
        match self {
            Kernel::Flows(flows) => flows.iter().any(|flow| matches!(flow, LaneFlow::Kick(_))),
            Kernel::FreeRk4(_) => false,
            Kernel::Rk4(_) => true,
        }
    }

    /// Where the bodies are on their orbit whenever the steps with the numbers `steps` ask for torques; nowhere without one.
    pub(super) fn places(&self, acting: &Acting, clock: &Clock, steps: Range<u64>) -> Vec<Place<f64>> {
        if !acting.is_on_orbit() {
            return Vec::new();
        }
        let whole = Dd::from(clock.step);
        let asked: Vec<Dd> = match self {
            Kernel::Flows(flows) => {
                let begun =
                    |flow: &LaneFlow| if let LaneFlow::Kick(begun) = flow { Some(*begun) } else { None };
                flows.iter().filter_map(begun).collect()
            }
            Kernel::FreeRk4(_) => Vec::new(),
            Kernel::Rk4(_) => vec![Dd::ZERO, whole * 0.5, whole],
        };
        let place = |(step, duration): (u64, Dd)| acting.place(clock.at(step).later(duration));
        steps.flat_map(|step| asked.iter().map(move |duration| (step, *duration))).filter_map(place).collect()
    }
}

/// The steps with the numbers `range` and their `places`, by the widest instructions of the processor.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
pub(super) fn widest(block: &mut Block, places: &[Place<f64>], range: Range<u64>) {
    steps(block, places, range);
}

/// The same by AVX2 at most.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn avx2(block: &mut Block, places: &[Place<f64>], range: Range<u64>) {
    steps(block, places, range);
}

/// The same by what the program is compiled for.
#[inline(never)]
pub(super) fn baseline(block: &mut Block, places: &[Place<f64>], range: Range<u64>) {
    steps(block, places, range);
}

#[inline(always)]
fn steps(block: &mut Block, places: &[Place<f64>], range: Range<u64>) {
    let mut places = places.iter();
    let takes_forces = block.kernel.takes_forces();
    let Block { kernel, acting, clock, points, constants, free, .. } = block;
    let (numbers, constants) = constants.split_at(if takes_forces { FORCES } else { 0 });
    match kernel {
        Kernel::Flows(flows) => {
            let (mut angles, mut torques) = ([Lane::ZERO; 2], Torques::ZERO);
            let mut solves = Solves::ZERO;
            for step in range {
                let mut left = constants;
                for flow in flows.iter() {
                    let Some((all, others)) = left.split_at_checked(flow.constants()) else { return };
                    let [constants, ..] = all else { return };
                    left = others;
                    match flow {
                        LaneFlow::Turn(axis, width) => turn(*axis, *width, points, constants, &mut angles),
                        LaneFlow::Ball => ball(points, constants, &mut angles),
                        LaneFlow::Free => {
                            let Some(free) = free.as_deref_mut() else { return };
                            flow_free(free, clock.at(step), points, constants);
                        }
                        LaneFlow::Kick(_) => {
                            let Some(numbers) = numbers.first_chunk() else { return };
                            kick((acting, numbers), places.next(), points, constants, &mut torques);
                        }
                        LaneFlow::Gradient => {
                            if let Some(constants) = all.first_chunk() {
                                gradient(points, constants);
                            }
                        }
                        LaneFlow::Dmv(degree) => {
                            if let Some((plain, polynomials)) = all.split_first_chunk() {
                                solves.set(*degree, plain, polynomials, points);
                                let settled = solves.solve(points);
                                step_dmv(&solves, settled, points);
                            }
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
            for _ in range {
                let places = [places.next(), places.next(), places.next()];
                stages.step((acting, numbers), (rk4, scaled), places, points);
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

/// Free flows of the times `t`; of series that have no sum the bodies go alone.
#[inline(always)]
fn flow_free(free: &mut FreeLanes, at: Time, points: &mut [Lane; PARTS], t: &Lane) {
    let (Some(attitude), Some(momentum)) = (points.first_chunk(), points[4..].first_chunk()) else { return };
    let settled = free.sum(t, attitude, momentum);
    let (momentum, attitude) = (&free.momentum, &free.attitude);
    if settled == LANES {
        each!(points, |n, x| {
            x.add_momentum(vector(momentum, n));
            x.add_attitude(quaternion(attitude, n));
        });
        return;
    }
    each!(points, |n, x| {
        if free.is_settled(n) {
            x.add_momentum(vector(momentum, n));
            x.add_attitude(quaternion(attitude, n));
        } else if let Some(flow) = free.alone(n) {
            flow.flow(at, t[n], x);
        }
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

/// What a kick with a gradient adds.
#[inline(always)]
fn gradient(points: &mut [Lane; PARTS], constants: &[Lane; GRADIENT_CONSTANTS]) {
    let [share, a, b, c, x, y, z] = constants;
    each!(points, |n, point| {
        let linear = LinearPotential { moment: Vec3([x[n], y[n], z[n]]) };
        let inverse_moments = Vec3([a[n], b[n], c[n]]);
        let change = linear.gradient_of_squared_torque(inverse_moments, point.attitude) * share[n];
        point.add_momentum(change);
    });
}

/// Steps of the discrete Moser–Veselov map, of which so many are `settled`. A body whose step has no solution gets no momentum: alone it
/// runs into the same and says why.
#[inline(always)]
fn step_dmv(solves: &Solves, settled: usize, points: &mut [Lane; PARTS]) {
    if settled == LANES {
        each!(points, |n, x| solves.map(n).step(x, vector(&solves.solution, n)));
        return;
    }
    each!(points, |n, x| {
        let mut map = solves.map(n);
        if solves.is_settled(n) {
            map.step(x, vector(&solves.solution, n));
        } else {
            let Vec3([a, b, c]) = vector(&solves.solution, n);
            map.step_from(x, a, b, c);
            if map.worst_residual() > SOLVED {
                x.momentum_body = Vec3([f64::NAN; 3]);
            }
        }
    });
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
