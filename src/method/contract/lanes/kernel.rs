//! Loops over the lanes of a block.
//!
//! Each loop is short: a processor looks about a hundred operations ahead, and the operations of one lane wait for each other.
//! So one loop takes the sines of a turn and another turns by them, while a whole step of the Runge–Kutta method, in which
//! less waits, is one.

use core::ops::Range;

use multiversion::multiversion;

use super::block::PARTS;
use crate::body::{Point, RENORMALIZE_EVERY};
use crate::flow::turn_by;
use crate::method::rk4::{RK4_CONSTANTS, Rk4Step};
use crate::method::solve::turns::RENORMALIZE_SMALL_EVERY;
use crate::num::trig::{sin_versine_moderate, sin_versine_small};
use crate::num::{LANES, Lane};

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
    /// The classical Runge–Kutta method, normalised or not; the constants are those of [`Rk4Step`].
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
            let mut angles = [Lane::ZERO; 2];
            let every = match width {
                Width::Small => RENORMALIZE_SMALL_EVERY,
                Width::Moderate => RENORMALIZE_EVERY,
            };
            for step in range {
                for (axis, half_rates) in axes.iter().zip(constants) {
                    turn(*axis, *width, points, half_rates, &mut angles);
                }
                if step % every == every - 1 {
                    each!(points, |n, x| x.renormalize());
                }
            }
        }
        Kernel::Rk4(normalized) => {
            if let Some(constants) = constants.first_chunk() {
                for _ in range {
                    if *normalized {
                        rk4::<true>(points, constants);
                    } else {
                        rk4::<false>(points, constants);
                    }
                }
            }
        }
    }
}

/// A turn; `angles` is room for the sines of half the angles, and for one less their cosines.
#[inline(always)]
fn turn(axis: usize, width: Width, points: &mut [Lane; PARTS], half_rates: &Lane, angles: &mut [Lane; 2]) {
    let [sines, versines] = angles;
    let momenta = &points[4 + axis % 3];
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
    }
    match axis {
        0 => each!(points, |n, x| turn_by::<0, f64>(x, (sines[n], versines[n]))),
        1 => each!(points, |n, x| turn_by::<1, f64>(x, (sines[n], versines[n]))),
        _ => each!(points, |n, x| turn_by::<2, f64>(x, (sines[n], versines[n]))),
    }
}

#[inline(always)]
fn rk4<const NORMALIZED: bool>(points: &mut [Lane; PARTS], constants: &[Lane; RK4_CONSTANTS]) {
    let [c0, c1, c2, c3, c4, c5, c6, c7, c8] = constants;
    each!(points, |n, x| {
        let rk4 = Rk4Step::of([c0[n], c1[n], c2[n], c3[n], c4[n], c5[n], c6[n], c7[n], c8[n]]);
        let mut moved = rk4.free(x.phase());
        if NORMALIZED {
            moved.attitude = moved.attitude.normalized();
        }
        x.set_phase(moved);
    });
}
