//! Loops over the lanes of a block.
//!
//! One loop for each turn and not one for each step: a whole step has more numbers than registers, and more operations than
//! a processor looks ahead.

use core::ops::Range;

use multiversion::multiversion;

use super::block::PARTS;
use crate::body::{Free, Point, RENORMALIZE_EVERY, Time};
use crate::flow::{turn_a_little_about, turn_moderately_about};
use crate::method::runge_kutta::{Equations, rk4_step};
use crate::num::{LANES, Lane};
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
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Kernel {
    /// Turns about principal axes, one after another; the constants are half their angles over the momentum about the axis.
    Turns(Vec<usize>, Width),
    /// The classical Runge–Kutta method, normalised or not; the constants are the step and the reciprocal moments.
    Rk4(bool),
}

/// How far the turns go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Width {
    /// Half of each angle is at most [`SMALL`](crate::num::trig::SMALL).
    Small,
    /// At most π/4.
    Moderate,
}

/// The steps with the numbers `steps`, by the widest instructions of the processor.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
pub(super) fn widest(kernel: &Kernel, points: &mut [Lane; PARTS], constants: &[Lane], range: Range<u64>) {
    steps(kernel, points, constants, range);
}

/// The same by AVX2 at most.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn avx2(kernel: &Kernel, points: &mut [Lane; PARTS], constants: &[Lane], range: Range<u64>) {
    steps(kernel, points, constants, range);
}

/// The same by what the caller is compiled for.
#[inline(always)]
pub(super) fn steps(kernel: &Kernel, points: &mut [Lane; PARTS], constants: &[Lane], range: Range<u64>) {
    match kernel {
        Kernel::Turns(axes, width) => {
            for step in range {
                for (axis, half_rates) in axes.iter().zip(constants) {
                    turn(*axis, *width, points, half_rates);
                }
                if step % RENORMALIZE_EVERY == RENORMALIZE_EVERY - 1 {
                    each!(points, |n, x| x.renormalize());
                }
            }
        }
        Kernel::Rk4(normalized) => {
            if let [h, a, b, c] = constants {
                for _ in range {
                    if *normalized {
                        rk4::<true>(points, h, [a, b, c]);
                    } else {
                        rk4::<false>(points, h, [a, b, c]);
                    }
                }
            }
        }
    }
}

#[inline(always)]
fn turn(axis: usize, width: Width, points: &mut [Lane; PARTS], half_rates: &Lane) {
    match (axis, width) {
        (0, Width::Small) => each!(points, |n, x| turn_a_little_about::<0, f64>(x, half_rates[n])),
        (1, Width::Small) => each!(points, |n, x| turn_a_little_about::<1, f64>(x, half_rates[n])),
        (_, Width::Small) => each!(points, |n, x| turn_a_little_about::<2, f64>(x, half_rates[n])),
        (0, Width::Moderate) => each!(points, |n, x| turn_moderately_about::<0>(x, half_rates[n])),
        (1, Width::Moderate) => each!(points, |n, x| turn_moderately_about::<1>(x, half_rates[n])),
        (_, Width::Moderate) => each!(points, |n, x| turn_moderately_about::<2>(x, half_rates[n])),
    }
}

#[inline(always)]
fn rk4<const NORMALIZED: bool>(points: &mut [Lane; PARTS], h: &Lane, [a, b, c]: [&Lane; 3]) {
    let nothing = Time::from_seconds(0.0);
    each!(points, |n, x| {
        let equations = Equations::of(Vec3([a[n], b[n], c[n]]), Free);
        x.set_phase(rk4_step::<NORMALIZED, f64, Free>(h[n], [nothing; 3], &equations, x.phase()));
    });
}
