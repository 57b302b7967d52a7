//! The derivative of the motion of Lagrange's top against central differences in double-double, over random tops near every special case.
//!
//! Differences by the constants of the top are taken between doubles: where changes have grown a millionfold only the start is
//! changed. Cases of which a
//! difference knows less than 1e-13 are counted.

use core::array::from_fn;

use crate::top_derivative::{Case, PROMISE, in_units};
use polhode::body::Point;
use polhode::flow::TurnAxes;
use polhode::num::{Dd, Random, Real};
use polhode::rotation::{Quat, Vec3};

impl Case {
    fn end(&self, column: usize, relative: f64) -> Point<Dd> {
        let unit = self.units().1[column];
        let mut other = *self;
        match column {
            6 => other.transverse *= 1.0 + relative,
            7 => other.axial *= 1.0 + relative,
            8 => other.weight += relative * unit,
            _ => {
                return self.changed(Some((column, Dd::product(relative, unit)))).point_at_dd(Dd::of(self.t));
            }
        }
        other.top().point_at_dd(Dd::of(self.t))
    }

    /// Central differences in the size `relative`, a power of two, in units.
    fn difference(&self, column: usize, relative: f64) -> [Dd; 6] {
        let scale = self.body().scale();
        let (high, low) = (self.end(column, relative), self.end(column, -relative));
        let other = low.attitude;
        let along = high.attitude.w * other.w + high.attitude.v.dot(other.v);
        let other = if along < Dd::ZERO { -other } else { other };
        let turn = (high.attitude * other.conjugate()).v * Dd::of(1.0 / relative);
        let m =
            (high.momentum_body - low.momentum_body) * Dd::of(scale * self.units().0[3] / (2.0 * relative));
        from_fn(|row| if row < 3 { turn[row] } else { m[row - 3] })
    }
}

/// `bits` binary digits of x, so that sums with small powers of two of it are exact.
fn short(x: f64, bits: i32) -> f64 {
    if x == 0.0 {
        0.0
    } else {
        libm::scalbn(libm::round(libm::scalbn(x, bits - libm::ilogb(x))), libm::ilogb(x) - bits)
    }
}

fn random_case(random: &mut Random) -> Case {
    let mut decades = |from: f64, to: f64| libm::exp10(random.between(from, to));
    let transverse = short(decades(-0.5, 0.5), 14);
    let axial = short(transverse * decades(-2.0, 0.3), 14);
    let weight = short(decades(-3.0, 1.0), 14);
    let falling = libm::sqrt(weight / transverse);
    let [spin, tilt, slow, turned] =
        [decades(-2.0, 1.5), decades(-9.0, 0.4), decades(-9.0, 0.5), decades(-1.0, 3.0)];
    let (kind, sign) = (random.below(5), if random.below(2) == 0 { 1.0 } else { -1.0 });
    let tilt = if random.below(2) == 0 { tilt } else { core::f64::consts::PI - tilt };
    let (sin, cos) = libm::sincos(tilt);
    let mut momentum: [f64; 3] = from_fn(|_| random.normal() * slow * falling * transverse);
    momentum[2] = sign * spin * falling * transverse;
    match kind {
        // the sleeping top's separatrix and next to it
        0 if cos > 0.0 => {
            let m3 = libm::sqrt(2.0 * transverse * weight * (1.0 + cos)) * 0.7;
            momentum = [0.0, 0.0, m3];
            // m·Γ = m₃ with the energy of the upright
            let across = m3 * (1.0 - cos) / sin;
            let rest = 2.0 * transverse * weight * (1.0 - cos) - across * across;
            momentum[0] = if rest > 0.0 { libm::sqrt(rest) } else { 0.0 };
            momentum[1] = across * (1.0 + slow);
        }
        // steady precession and next to it
        1 => {
            let rate = falling * spin;
            let m3 = (transverse * rate * rate * cos + weight) / rate;
            momentum = [0.0, transverse * rate * sin, m3 * (1.0 + 1e-3 * slow)];
        }
        _ => {}
    }
    let (sin, cos) = libm::sincos(0.5 * tilt);
    let turn = random.between(-1.5, 1.5);
    let about = Quat::new(libm::cos(turn), Vec3::unit(2) * libm::sin(turn));
    let attitude = about * Quat::new(cos, Vec3::unit(0) * sin);
    let fastest = falling.max(Vec3(momentum).norm() / transverse);
    Case { transverse, axial, weight, momentum, attitude: attitude.components(), t: sign * turned / fastest }
}

fn look_at(cases: usize, seed: u64) {
    let mut random = Random::new(seed);
    let (mut known, mut worst) = (0, [0.0_f64; 2]);
    for _ in 0..cases {
        let case = random_case(&mut random);
        let units = case.units();
        let found = match case.top().at_with_derivative(case.t) {
            Ok(found) => in_units(&found.by_momentum(TurnAxes::Space), &units),
            Err(error) => panic!("{case:?}: {error}"),
        };
        let fastest =
            libm::sqrt(case.weight / case.transverse).max(Vec3(case.momentum).norm() / case.transverse);
        // what is left beyond Richardson's extrapolation is some 1e-20; where changes grow the motion is linear over less
        let scale = (case.t * fastest).abs().max(found.amax()).max(1.0);
        let size = libm::exp2(-18.0 - libm::ceil(libm::log2(scale)));
        // sums of constants with so small a part are not doubles
        let columns = if size < libm::exp2(-36.0) { 6 } else { 9 };
        let (mut error, mut uncertain) = (0.0_f64, 0.0_f64);
        for column in 0..columns {
            let [rough, middle, fine] = [1.0, 0.5, 0.25].map(|part| case.difference(column, size * part));
            for row in 0..6 {
                let better = |narrow: Dd, wide: Dd| (narrow * 4.0 - wide) / 3.0;
                let value = better(fine[row], middle[row]);
                uncertain = uncertain.max((value - better(middle[row], rough[row])).magnitude());
                let off = (value - Dd::of(found[(row, column)])).magnitude();
                error = if off.is_nan() { f64::INFINITY } else { error.max(off) };
            }
        }
        let largest = found.amax();
        let (error, uncertain) = (error / largest, uncertain / largest);
        if uncertain > 1e-9 {
            continue; // nothing to compare with
        }
        let mut condition = 0.0_f64;
        for n in 0..6 {
            let mut other = case;
            let more = 1.0 + f64::EPSILON;
            match n {
                0 => other.transverse *= more,
                1 => other.axial *= more,
                2 => other.weight *= more,
                n => other.momentum[n - 3] *= more,
            }
            if let Ok(changed) = other.top().at_with_derivative(case.t) {
                let changed = in_units(&changed.by_momentum(TurnAxes::Space), &units);
                condition = condition.max(0.5 * (changed - found).amax() / largest);
            }
        }
        let allowed = PROMISE + 4.0 * condition + 4.0 * uncertain;
        assert!(
            error <= allowed,
            "{case:?}: error {error:.1e}, differences known to {uncertain:.1e}, condition {condition:.1e}, largest {largest:.1e}"
        );
        if uncertain < 1e-13 {
            known += 1;
            worst[0] = worst[0].max(error);
            worst[1] = worst[1].max(error - 4.0 * condition);
        }
    }
    println!(
        "{known} of {cases} known; error {:.1e}, beyond four times the condition {:.1e}",
        worst[0], worst[1]
    );
    assert!(known * 10 > cases * 6, "{known} of {cases}");
}

#[test]
fn derivatives_of_tops_agree_with_differences_in_double_double() {
    look_at(150, 3);
}

#[test]
#[ignore = "twenty thousand tops take minutes"]
fn derivatives_of_tops_agree_with_differences_of_many_tops() {
    look_at(20_000, 4);
}
