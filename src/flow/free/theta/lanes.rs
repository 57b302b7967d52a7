//! One motion at many times side by side.

use multiversion::multiversion;

use super::series::Form;
use super::{Sums, Theta};
use crate::body::Phase;
use crate::flow::free::phase::TOO_FAR;
use crate::num::trig::{nearest, sin_cos_turns};
use crate::num::{Instructions, LANES, Lane};
use crate::rotation::{Quat, Vec3};

/// Attitude and momentum at as many times as there are lanes.
#[derive(Clone, Debug)]
pub(in crate::flow::free) struct Points {
    attitude: [Lane; 4],
    /// Along the axes a, b, c.
    momentum: [Lane; 3],
    axes: [usize; 3],
    /// The larger of the two phases, in turns.
    turns: Lane,
    /// The turn from P(0) along w, a, b, c.
    turn: [Lane; 4],
}

impl Points {
    pub(in crate::flow::free) fn new() -> Self {
        let zero = Lane::ZERO;
        Points { attitude: [zero; 4], momentum: [zero; 3], axes: [0, 1, 2], turns: zero, turn: [zero; 4] }
    }

    /// Gives `each` those of the first `count` lanes, with their numbers.
    #[inline(always)]
    pub(in crate::flow::free) fn each(&self, count: usize, mut each: impl FnMut(usize, Phase<f64>)) {
        let [w, x, y, z] = &self.attitude;
        let [a, b, c] = places(self.axes).map(|place| &self.momentum[place]);
        for n in 0..count.min(LANES) {
            let attitude = Quat::new(w[n], Vec3([x[n], y[n], z[n]]));
            each(n, Phase { attitude, momentum_body: Vec3([a[n], b[n], c[n]]) });
        }
    }
}

impl Theta {
    /// Writes attitude and momentum at the times `t`; false where they have to be taken one by one: a form without lanes, or so
    /// many turns that `f64` pairs cannot reduce them.
    pub(in crate::flow::free) fn at_all(&self, t: &Lane, x: &mut Points, by: Instructions) -> bool {
        if !matches!(self.form, Form::Direct | Form::Dual { .. }) {
            return false;
        }
        match by {
            Instructions::Widest => widest(self, t, x),
            Instructions::Avx2 => avx2(self, t, x),
            Instructions::Baseline => all(self, t, x),
        }
        // a NaN is too far, too
        x.turns.iter().all(|turns| *turns < TOO_FAR)
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
fn widest(theta: &Theta, t: &Lane, x: &mut Points) {
    all(theta, t, x);
}

#[multiversion(targets("x86_64+avx2"))]
fn avx2(theta: &Theta, t: &Lane, x: &mut Points) {
    all(theta, t, x);
}

#[inline(always)]
fn all(theta: &Theta, t: &Lane, x: &mut Points) {
    x.axes = theta.axes;
    match (theta.form, theta.about_smallest) {
        (Form::Dual { width, jump }, true) => along::<true, true>(theta, t, x, width, jump),
        (Form::Dual { width, jump }, false) => along::<true, false>(theta, t, x, width, jump),
        (_, true) => along::<false, true>(theta, t, x, 0.0, [0.0; 2]),
        (_, false) => along::<false, false>(theta, t, x, 0.0, [0.0; 2]),
    }
    compose(theta.attitude, x);
}

/// Momentum, and the turn from P(0).
#[inline(always)]
fn along<const DUAL: bool, const ABOUT_SMALLEST: bool>(
    theta: &Theta,
    t: &Lane,
    x: &mut Points,
    width: f64,
    jump: [f64; 2],
) {
    let Points { momentum: [ma, mb, mc], turns, turn: [tw, ta, tb, tc], .. } = x;
    for n in 0..LANES {
        let (phase, phase_low) = theta.phase.at([t[n], 0.0]);
        let (psi, psi_low) = theta.twist.at([t[n], 0.0]);
        let larger = if phase.abs() > psi.abs() { phase.abs() } else { psi.abs() };
        // a NaN of either stays
        turns[n] = larger + 0.0 * (phase + psi);
        let psi = psi - nearest(psi);
        let (sums, (psi, psi_low)) = if DUAL {
            theta.dual::<ABOUT_SMALLEST>(width, jump, (phase, phase_low), (psi, psi_low))
        } else {
            (theta.direct::<ABOUT_SMALLEST>((phase, phase_low)), (psi, psi_low))
        };
        let Sums { z, w, least } = sums;
        let (turn, m) = theta.assembled::<ABOUT_SMALLEST>(z, w, least, sin_cos_turns(psi, psi_low));
        (tw[n], ta[n], tb[n], tc[n]) = (turn[0], turn[1], turn[2], turn[3]);
        (ma[n], mb[n], mc[n]) = (m[0], m[1], m[2]);
    }
}

/// Where among a, b, c each axis of the body stands.
fn places(axes: [usize; 3]) -> [usize; 3] {
    let mut places = [0; 3];
    for (place, axis) in axes.into_iter().enumerate() {
        places[axis] = place;
    }
    places
}

/// The attitudes, `first` times the turn.
#[inline(always)]
fn compose(first: Quat<f64>, x: &mut Points) {
    let [w, vectors @ ..] = &x.turn;
    let [a, b, c] = places(x.axes).map(|place| &vectors[place]);
    let [q0, q1, q2, q3] = &mut x.attitude;
    for n in 0..LANES {
        let q = first * Quat::new(w[n], Vec3([a[n], b[n], c[n]]));
        (q0[n], q1[n], q2[n], q3[n]) = (q.w, q.v[0], q.v[1], q.v[2]);
    }
}
