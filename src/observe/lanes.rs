//! Errors of a block of steps at once, with error-free transformations: one lane for each point, so that loops over a block
//! are vectorised by the widest instructions the processor has, with the same bits on each.

use multiversion::multiversion;
use multiversion::target::target_cfg_f;

use super::Invariants;
use super::circle::{Angles, Circle};
use super::monitor::BLOCK;
use crate::body::{LinearPotential, Point};
use crate::num::error_free::two_prod;
use crate::num::{Compensated, Dd};
use crate::rotation::{Quat, Vec3};

/// One number for each point of a block.
pub(super) type Lane = [f64; BLOCK];

/// Points side by side, one array for each component.
#[derive(Clone, Debug)]
pub(super) struct Lanes {
    attitude: [Lane; 4],
    momentum: [Lane; 3],
}

impl Lanes {
    /// Of at most [`BLOCK`] points; the places that are left hold zeros.
    pub(super) fn of(points: &[Point<f64>]) -> Self {
        let mut lanes = Lanes { attitude: [[0.0; BLOCK]; 4], momentum: [[0.0; BLOCK]; 3] };
        for (n, x) in points.iter().enumerate().take(BLOCK) {
            for (lane, component) in lanes.attitude.iter_mut().zip(x.attitude.components()) {
                lane[n] = component;
            }
            for (lane, component) in lanes.momentum.iter_mut().zip(x.momentum_body.0) {
                lane[n] = component;
            }
        }
        lanes
    }

    #[inline(always)]
    fn attitude(&self, n: usize) -> Quat<f64> {
        let [w, x, y, z] = &self.attitude;
        Quat::new(w[n], Vec3([x[n], y[n], z[n]]))
    }

    #[inline(always)]
    fn momentum(&self, n: usize) -> Vec3<f64> {
        let [x, y, z] = &self.momentum;
        Vec3([x[n], y[n], z[n]])
    }
}

/// What the points are compared with, leading and trailing parts side by side.
#[derive(Clone, Debug)]
pub(super) struct Reference {
    inverse_moments: [Vec3<f64>; 2],
    energy: [f64; 2],
    momentum_squared: [f64; 2],
    momentum_space: [Vec3<f64>; 2],
    moment: [Vec3<f64>; 2],
    /// No product that matters is near the smallest numbers: then the error of a product is the same number by Dekker's
    /// way and by a fused multiply-add.
    ordinary: bool,
}

/// Below this a difference is as good as zero where the reference is ordinary: what underflow leaves is smaller.
const NOTHING: f64 = 1e-280;

impl Reference {
    pub(super) fn new(
        inverse_moments: Vec3<Dd>,
        start: &Invariants,
        linear: Option<LinearPotential<Dd>>,
    ) -> Self {
        let parts = |x: Dd| [x.hi(), x.lo()];
        let vector = |v: Vec3<Dd>| [v.map(Dd::hi), v.map(Dd::lo)];
        let moment = linear.map_or(Vec3::zero(), |linear| linear.moment);
        let ordinary = |x: f64| (1e-100..1e100).contains(&x);
        Reference {
            inverse_moments: vector(inverse_moments),
            energy: parts(start.energy),
            momentum_squared: parts(start.momentum_squared),
            momentum_space: vector(start.momentum_space),
            moment: vector(moment),
            ordinary: inverse_moments.0.iter().all(|x| ordinary(x.hi()))
                && ordinary(start.momentum_squared.hi())
                && (linear.is_none() || ordinary(moment.norm_squared().hi())),
        }
    }

    /// |E − E₀|, ||m|² − |m₀|²| and |L − L₀| of each point, without forces.
    pub(super) fn free(&self, points: &[Point<f64>]) -> [Lane; 3] {
        free(self, &Lanes::of(points))
    }

    /// |E − E₀| and |L_z − L_z₀| of each point, in a linear potential.
    pub(super) fn heavy(&self, points: &[Point<f64>]) -> [Lane; 2] {
        heavy(self, &Lanes::of(points))
    }

    /// The change of Jacobi's constant at each point, by the gravity gradient on a circle alone.
    pub(super) fn circular(&self, circle: &mut Circle, points: &[Point<f64>]) -> [Lane; 1] {
        let directions = circle.directions(points.iter().map(Point::steps));
        circular(self, circle, &directions, &Lanes::of(points))
    }

    // No loops over components below: only the innermost loop, that over the points, is vectorised.

    #[inline(always)]
    fn free_differences<const FUSED: bool>(&self, q: Quat<f64>, m: Vec3<f64>) -> [f64; 3] {
        let mut squared = Compensated::minus(self.momentum_squared);
        squared.add_square::<FUSED>(m[0]);
        squared.add_square::<FUSED>(m[1]);
        squared.add_square::<FUSED>(m[2]);
        let rotated = Rotated::new::<FUSED>(q, m);
        let difference = Vec3([
            self.momentum_difference::<FUSED, 0>(&rotated).value(),
            self.momentum_difference::<FUSED, 1>(&rotated).value(),
            self.momentum_difference::<FUSED, 2>(&rotated).value(),
        ]);
        let mut twice_energy = Compensated::minus([2.0 * self.energy[0], 2.0 * self.energy[1]]);
        self.add_kinetic::<FUSED>(&mut twice_energy, m);
        [0.5 * twice_energy.value().abs(), squared.value().abs(), difference.norm()]
    }

    #[inline(always)]
    fn heavy_differences<const FUSED: bool>(&self, q: Quat<f64>, m: Vec3<f64>) -> [f64; 2] {
        let mut twice_energy = Compensated::minus([2.0 * self.energy[0], 2.0 * self.energy[1]]);
        self.add_kinetic::<FUSED>(&mut twice_energy, m);
        let (w, Vec3([x, y, z])) = (q.w, q.v);
        // 2 U = c · 2Γ, with ½Γ₁ = xz − wy, ½Γ₂ = yz + wx and Γ₃ = w² + z² − x² − y²
        let [high, low] = self.moment;
        let mut vertical = Compensated::of_product::<FUSED>(x, z);
        vertical.add_product_by::<FUSED>(-w, y);
        twice_energy.add_scaled_by::<FUSED>(vertical, [4.0 * high[0], 4.0 * low[0]]);
        let mut vertical = Compensated::of_product::<FUSED>(y, z);
        vertical.add_product_by::<FUSED>(w, x);
        twice_energy.add_scaled_by::<FUSED>(vertical, [4.0 * high[1], 4.0 * low[1]]);
        let mut vertical = Compensated::of_product::<FUSED>(w, w);
        vertical.add_square::<FUSED>(z);
        vertical.add_product_by::<FUSED>(-x, x);
        vertical.add_product_by::<FUSED>(-y, y);
        twice_energy.add_scaled_by::<FUSED>(vertical, [2.0 * high[2], 2.0 * low[2]]);
        let difference = self.momentum_difference::<FUSED, 2>(&Rotated::new::<FUSED>(q, m)).value();
        [0.5 * twice_energy.value().abs(), difference.abs()]
    }

    #[inline(always)]
    fn circular_differences<const FUSED: bool>(
        &self,
        circle: &Circle,
        directions: &[Angles; 2],
        n: usize,
        q: Quat<f64>,
        m: Vec3<f64>,
    ) -> [f64; 1] {
        let [[a, b], [c, d]] = directions;
        let [[a, b], [c, d]] = [[a, b], [c, d]].map(|angle| angle.map(|[high, low]| [high[n], low[n]]));
        let mut cosine = Compensated::of_product_of_parts::<FUSED>(a, c);
        cosine.add_product_of_parts::<FUSED>(b.map(|b| -b), d);
        let mut sine = Compensated::of_product_of_parts::<FUSED>(a, d);
        sine.add_product_of_parts::<FUSED>(b, c);
        let (cosine, sine) = (cosine.parts(), sine.parts());
        let (w, Vec3([x, y, z])) = (q.w, q.v);
        // r̂ = cos X + sin Y, of the rows X and Y of the rotation, off the diagonal by their halves
        let mut along = Compensated::of_product::<FUSED>(w, w);
        along.add_square::<FUSED>(x);
        along.add_product_by::<FUSED>(-y, y);
        along.add_product_by::<FUSED>(-z, z);
        let mut first = Compensated::of_product_of_parts::<FUSED>(along.parts(), cosine);
        let mut half = Compensated::of_product::<FUSED>(x, y);
        half.add_product_by::<FUSED>(w, z);
        first.add_scaled_by::<FUSED>(half, sine.map(|s| 2.0 * s));
        let mut along = Compensated::of_product::<FUSED>(w, w);
        along.add_square::<FUSED>(y);
        along.add_product_by::<FUSED>(-x, x);
        along.add_product_by::<FUSED>(-z, z);
        let mut second = Compensated::of_product_of_parts::<FUSED>(along.parts(), sine);
        let mut half = Compensated::of_product::<FUSED>(x, y);
        half.add_product_by::<FUSED>(-w, z);
        second.add_scaled_by::<FUSED>(half, cosine.map(|c| 2.0 * c));
        let mut half = Compensated::of_product::<FUSED>(x, z);
        half.add_product_by::<FUSED>(w, y);
        let mut third = Compensated::of_product_of_parts::<FUSED>(half.parts(), cosine.map(|c| 2.0 * c));
        let mut half = Compensated::of_product::<FUSED>(y, z);
        half.add_product_by::<FUSED>(-w, x);
        third.add_scaled_by::<FUSED>(half, sine.map(|s| 2.0 * s));
        let r = [first.parts(), second.parts(), third.parts()];
        let mut twice = Compensated::minus([2.0 * self.energy[0], 2.0 * self.energy[1]]);
        self.add_kinetic::<FUSED>(&mut twice, m);
        twice.add_product_of_three::<FUSED>(r[0], r[0], circle.weights[0]);
        twice.add_product_of_three::<FUSED>(r[1], r[1], circle.weights[1]);
        twice.add_product_of_three::<FUSED>(r[2], r[2], circle.weights[2]);
        twice.add_product_of_three::<FUSED>(r[1], r[2], circle.weights[3]);
        twice.add_product_of_three::<FUSED>(r[2], r[0], circle.weights[4]);
        twice.add_product_of_three::<FUSED>(r[0], r[1], circle.weights[5]);
        let momentum_z = self.momentum_difference::<FUSED, 2>(&Rotated::new::<FUSED>(q, m));
        twice.add_scaled_by::<FUSED>(momentum_z, [-2.0 * circle.rate, 0.0]);
        [0.5 * twice.value().abs()]
    }

    /// Adds m · I⁻¹ m.
    #[inline(always)]
    fn add_kinetic<const FUSED: bool>(&self, sum: &mut Compensated<f64>, m: Vec3<f64>) {
        self.add_kinetic_of::<FUSED, 0>(sum, m);
        self.add_kinetic_of::<FUSED, 1>(sum, m);
        self.add_kinetic_of::<FUSED, 2>(sum, m);
    }

    #[inline(always)]
    fn add_kinetic_of<const FUSED: bool, const K: usize>(&self, sum: &mut Compensated<f64>, m: Vec3<f64>) {
        let [high, low] = self.inverse_moments;
        let (square, rest) = product::<FUSED>(m[K], m[K]);
        let (term, error) = product::<FUSED>(square, high[K]);
        sum.add_parts(term, error + (rest * high[K] + square * low[K]));
    }

    /// The component K of L − L₀.
    #[inline(always)]
    fn momentum_difference<const FUSED: bool, const K: usize>(&self, x: &Rotated) -> Compensated<f64> {
        let (i, j) = ((K + 1) % 3, (K + 2) % 3);
        let mut cross = Compensated::of_product::<FUSED>(x.v[i], x.m[j]);
        cross.add_product_by::<FUSED>(-x.v[j], x.m[i]);
        let mut l = Compensated::minus([self.momentum_space[0][K], self.momentum_space[1][K]]);
        l.add_scaled_by::<FUSED>(x.diagonal, [x.m[K], 0.0]);
        l.add_scaled_by::<FUSED>(x.along, [2.0 * x.v[K], 0.0]);
        l.add_scaled_by::<FUSED>(cross, [2.0 * x.w, 0.0]);
        l
    }
}

/// The parts of `L = (w² − |v|²) m + 2 (v·m) v + 2 w (v × m)`, which is not divided by |q|².
struct Rotated {
    w: f64,
    v: Vec3<f64>,
    m: Vec3<f64>,
    diagonal: Compensated<f64>,
    along: Compensated<f64>,
}

impl Rotated {
    #[inline(always)]
    fn new<const FUSED: bool>(q: Quat<f64>, m: Vec3<f64>) -> Self {
        let (w, v) = (q.w, q.v);
        let mut diagonal = Compensated::of_product::<FUSED>(w, w);
        diagonal.add_product_by::<FUSED>(-v[0], v[0]);
        diagonal.add_product_by::<FUSED>(-v[1], v[1]);
        diagonal.add_product_by::<FUSED>(-v[2], v[2]);
        let mut along = Compensated::of_product::<FUSED>(v[0], m[0]);
        along.add_product_by::<FUSED>(v[1], m[1]);
        along.add_product_by::<FUSED>(v[2], m[2]);
        Rotated { w, v, m, diagonal, along }
    }
}

// A sum that begins with a product takes it as it is: added to zero it would take eight operations, and have the same bits.
impl Compensated<f64> {
    #[inline(always)]
    fn of_product<const FUSED: bool>(a: f64, b: f64) -> Self {
        let (term, rest) = product::<FUSED>(a, b);
        Compensated::of([term, rest])
    }

    #[inline(always)]
    fn of_product_of_parts<const FUSED: bool>(a: [f64; 2], b: [f64; 2]) -> Self {
        let (term, rest) = product_of_parts::<FUSED>(a, b);
        Compensated::of([term, rest])
    }

    #[inline(always)]
    fn add_product_by<const FUSED: bool>(&mut self, a: f64, b: f64) {
        let (term, rest) = product::<FUSED>(a, b);
        self.add_parts(term, rest);
    }

    #[inline(always)]
    fn add_square<const FUSED: bool>(&mut self, a: f64) {
        self.add_product_by::<FUSED>(a, a);
    }

    /// Adds another sum times the number `high + low`.
    #[inline(always)]
    fn add_scaled_by<const FUSED: bool>(&mut self, other: Self, number: [f64; 2]) {
        self.add_product_of_parts::<FUSED>(other.parts(), number);
    }

    /// Adds the product of two numbers in two parts.
    #[inline(always)]
    fn add_product_of_parts<const FUSED: bool>(&mut self, a: [f64; 2], b: [f64; 2]) {
        let (term, rest) = product_of_parts::<FUSED>(a, b);
        self.add_parts(term, rest);
    }

    /// Adds the product of three.
    #[inline(always)]
    fn add_product_of_three<const FUSED: bool>(&mut self, a: [f64; 2], b: [f64; 2], c: [f64; 2]) {
        let (term, rest) = product_of_parts::<FUSED>(a, b);
        self.add_product_of_parts::<FUSED>([term, rest], c);
    }
}

/// `a · b` and the exact error of its rounding.
#[inline(always)]
#[expect(
    clippy::disallowed_methods,
    reason = "exact, and taken only where the processor has the instruction"
)]
fn product<const FUSED: bool>(a: f64, b: f64) -> (f64, f64) {
    if FUSED {
        let p = a * b;
        (p, a.mul_add(b, -p))
    } else {
        two_prod(a, b)
    }
}

#[inline(always)]
fn product_of_parts<const FUSED: bool>(a: [f64; 2], b: [f64; 2]) -> (f64, f64) {
    let (term, rest) = product::<FUSED>(a[0], b[0]);
    (term, rest + (a[1] * b[0] + a[0] * b[1]))
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn free(reference: &Reference, lanes: &Lanes) -> [Lane; 3] {
    if target_cfg_f!(target_feature = "fma") && reference.ordinary {
        all(reference, |n| reference.free_differences::<true>(lanes.attitude(n), lanes.momentum(n)))
    } else {
        all(reference, |n| reference.free_differences::<false>(lanes.attitude(n), lanes.momentum(n)))
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn heavy(reference: &Reference, lanes: &Lanes) -> [Lane; 2] {
    if target_cfg_f!(target_feature = "fma") && reference.ordinary {
        all(reference, |n| reference.heavy_differences::<true>(lanes.attitude(n), lanes.momentum(n)))
    } else {
        all(reference, |n| reference.heavy_differences::<false>(lanes.attitude(n), lanes.momentum(n)))
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn circular(reference: &Reference, circle: &Circle, directions: &[Angles; 2], lanes: &Lanes) -> [Lane; 1] {
    if target_cfg_f!(target_feature = "fma") && reference.ordinary {
        all(reference, |n| {
            let (q, m) = (lanes.attitude(n), lanes.momentum(n));
            reference.circular_differences::<true>(circle, directions, n, q, m)
        })
    } else {
        all(reference, |n| {
            let (q, m) = (lanes.attitude(n), lanes.momentum(n));
            reference.circular_differences::<false>(circle, directions, n, q, m)
        })
    }
}

#[inline(always)]
#[expect(clippy::needless_range_loop, reason = "each lane has the same index")]
fn all<const N: usize>(reference: &Reference, differences: impl Fn(usize) -> [f64; N]) -> [Lane; N] {
    let nothing = if reference.ordinary { NOTHING } else { 0.0 };
    let mut lanes = [[0.0; BLOCK]; N];
    for n in 0..BLOCK {
        let of_point = differences(n);
        for k in 0..N {
            // a NaN stays
            lanes[k][n] = if of_point[k] < nothing { 0.0 } else { of_point[k] };
        }
    }
    lanes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{Body, Time};
    use crate::inertia::Inertia;

    #[test]
    fn products_are_the_same_fused_and_not() {
        let inertia = Inertia::from_moments([1.0, 2.3, 2.9]).unwrap();
        let body = Body::heavy(inertia, [0.3, -0.2, 0.7].into()).unwrap();
        // multiples of the golden section modulo 1, of every length of mantissa
        let mut n = 0.0;
        let mut number = || {
            n += 1.0;
            2.0 * (n * 0.618_033_988_749_894_8_f64).fract() - 1.0
        };
        let points: Vec<_> = (0..BLOCK)
            .map(|_| {
                let q = Quat::from_components([number(), number(), number(), number()]).normalized();
                Point::new(q, Vec3([number(), number(), number()]))
            })
            .collect();
        let start = Invariants::of(&body, Time::from_seconds(0.0), &points[0]);
        let reference = Reference::new(body.rotor().inverse_moments(), &start, body.linear_potential());
        assert!(reference.ordinary);
        for x in &points {
            let (q, m) = (x.attitude, x.momentum_body);
            assert_eq!(reference.free_differences::<true>(q, m), reference.free_differences::<false>(q, m));
            assert_eq!(reference.heavy_differences::<true>(q, m), reference.heavy_differences::<false>(q, m));
        }
    }

    /// Where products underflow their errors differ, and every processor takes those by Dekker's way.
    #[test]
    fn products_that_underflow_are_not_fused() {
        let small = libm::scalbn(1.0, -500);
        let inertia = Inertia::from_moments([1.0, 2.3, 2.9]).unwrap();
        let body = Body::free(inertia);
        let attitude = Quat::from_components([0.5, -0.1, 0.7, 0.3]).normalized();
        let at = |k: usize| Point::new(attitude, Vec3([0.3 + 0.01 * k as f64, -0.7, 0.9]) * small);
        let points: Vec<_> = (0..BLOCK).map(at).collect();
        let (mut free_differ, mut heavy_differ) = (false, false);
        for x in &points {
            // of a point alone what is left of its energy is the error of its products
            let start = Invariants::of(&body, Time::from_seconds(0.0), x);
            let reference = Reference::new(body.rotor().inverse_moments(), &start, None);
            assert!(!reference.ordinary);
            let (lanes, q, m) = (Lanes::of(&[*x]), x.attitude, x.momentum_body);
            let (free, heavy) = (free(&reference, &lanes), heavy(&reference, &lanes));
            let expected = reference.free_differences::<false>(q, m);
            assert_eq!(free.map(|lane| lane[0]), expected);
            free_differ |= expected != reference.free_differences::<true>(q, m);
            let expected = reference.heavy_differences::<false>(q, m);
            assert_eq!(heavy.map(|lane| lane[0]), expected);
            heavy_differ |= expected != reference.heavy_differences::<true>(q, m);
        }
        assert!(free_differ && heavy_differ, "the points tell nothing");
    }
}
