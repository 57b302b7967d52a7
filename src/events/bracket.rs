//! Roots and minima of a function of one variable between two places.

use crate::num::Real;

/// A place and the value there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    pub(super) u: f64,
    pub(super) value: f64,
}

/// Where the bracket of a root is narrower than this share of the whole, it is found.
const FOUND: f64 = 1.0 / (1u64 << 50) as f64;

/// The root between `a` and `b`, whose values have different signs or are zero: the two places next to it, in their order.
///
/// By Chandrupatla's choice between inverse quadratic interpolation and bisection (Adv. Eng. Software 28 (1997) 145).
pub(super) fn root<E>(
    a: Place,
    b: Place,
    mut value: impl FnMut(f64) -> Result<f64, E>,
) -> Result<(Place, Place), E> {
    // and no narrower than two units in the last place
    let narrow = (FOUND * (b.u - a.u).abs()).max(4.0 * f64::ROUNDOFF * a.u.abs().max(b.u.abs()));
    let (mut a, mut b) = (b, a);
    let mut share: f64 = 0.5;
    loop {
        if a.value == 0.0 || b.value == 0.0 {
            let zero = if a.value == 0.0 { a } else { b };
            return Ok((zero, zero));
        }
        if (b.u - a.u).abs() <= narrow {
            return Ok(if a.u <= b.u { (a, b) } else { (b, a) });
        }
        let least = (0.5 * narrow / (b.u - a.u).abs()).min(0.5);
        let u = a.u + share.clamp(least, 1.0 - least) * (b.u - a.u);
        let new = Place { u, value: value(u)? };
        if u == a.u || u == b.u {
            return Ok(if a.u <= b.u { (a, b) } else { (b, a) });
        }
        // of the three last places, the two with different signs
        let c = if (new.value > 0.0) == (a.value > 0.0) { a } else { core::mem::replace(&mut b, a) };
        a = new;
        let (xi, phi) = ((a.u - b.u) / (c.u - b.u), (a.value - b.value) / (c.value - b.value));
        share = 0.5;
        if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
            let (ba, ca, bc) = (b.value - a.value, c.value - a.value, b.value - c.value);
            let (along, beside) = (a.value / ba * (c.value / bc), a.value / ca * (b.value / -bc));
            share = along + (c.u - a.u) / (b.u - a.u) * beside;
        }
        if !share.is_finite() {
            share = 0.5;
        }
    }
}

/// Where the minimum is known to this share of the whole, its value no longer changes.
const FLAT: f64 = 1e-9;

/// The least value between `a` and `b`, behind `a` lower than there and before `b` too, by golden sections; ends at the first
/// value that is not positive.
pub(super) fn minimum<E>(
    a: Place,
    b: Place,
    mut value: impl FnMut(f64) -> Result<f64, E>,
) -> Result<Place, E> {
    const GOLDEN: f64 = 0.381_966_011_250_105_2;
    let mut place = |u: f64| value(u).map(|value| Place { u, value });
    let (mut low, mut high) = (a.u, b.u);
    let mut left = place(low + GOLDEN * (high - low))?;
    let mut right = place(high - GOLDEN * (high - low))?;
    loop {
        let best = if left.value <= right.value { left } else { right };
        if best.value <= 0.0 || (high - low).abs() <= FLAT * (b.u - a.u).abs() {
            return Ok(best);
        }
        if left.value <= right.value {
            (high, right) = (right.u, left);
            left = place(low + GOLDEN * (high - low))?;
        } else {
            (low, left) = (left.u, right);
            right = place(high - GOLDEN * (high - low))?;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn never(x: f64) -> Result<f64, core::convert::Infallible> {
        Ok(x)
    }

    #[test]
    fn roots_are_found_to_rounding_in_few_values() {
        for (a, b, f) in [
            (0.0, 2.0, (|x| x * x - 2.0) as fn(f64) -> f64),
            (-1.0, 4.0, |x| x * x * x - 1.0),
            (0.0, 1.0, |x| libm::exp(50.0 * x) - 2.0),
            (-3.0, 1.0, |x| if x < 0.3 { -1.0 } else { 1.0 }),
        ] {
            let (mut count, place) = (0, |u| Place { u, value: f(u) });
            let Ok((left, right)) = root(place(a), place(b), |u| {
                count += 1;
                never(f(u))
            });
            assert!(right.u - left.u <= 4e-15 && left.value * right.value <= 0.0, "{left:?} {right:?}");
            assert!(count < 60, "{count}");
        }
    }

    #[test]
    fn a_minimum_is_found_as_far_as_its_value_tells() {
        let f = |x: f64| 1.0 + (x - 0.3) * (x - 0.3);
        let place = |u| Place { u, value: f(u) };
        let Ok(least) = minimum(place(-1.0), place(2.0), |u| never(f(u)));
        assert!((least.u - 0.3).abs() < 1e-7 && least.value == 1.0, "{least:?}");
    }
}
