//! The cubic of the nutation and its zeros, each to its own precision. Notation as in [`nutation`](super::nutation).

use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// Constants of the ball and, at the start, x, y, u' and the squared transverse angular velocity.
pub(super) struct Start {
    pub(super) b: Dd,
    pub(super) a: Dd,
    pub(super) e: Dd,
    pub(super) d: Dd,
    pub(super) x: Dd,
    pub(super) y: Dd,
    pub(super) u_rate: Dd,
    pub(super) transverse: Dd,
}

impl Start {
    /// Of the attitude q and the angular velocity ω of the ball, both with e₃ along the weight moment.
    pub(super) fn of(b: Dd, q: Quat<Dd>, omega: Vec3<Dd>) -> Self {
        let (w, Vec3([x, y, z])) = (q.w, q.v);
        let [w1, w2, a] = omega.0;
        let two = Dd::of(2.0);
        let gamma = [two * (x * z - w * y), two * (y * z + w * x)];
        let along = w1 * gamma[0] + w2 * gamma[1];
        let (upper, lower) = (two * (w * w + z * z), two * (x * x + y * y));
        Start {
            b,
            a,
            e: along + a * upper,
            d: along - a * lower,
            x: upper,
            y: lower,
            u_rate: gamma[0] * w2 - gamma[1] * w1,
            transverse: w1 * w1 + w2 * w2,
        }
    }

    /// x₁, x₂, x₃, y₁, y₂ and w₃. Where x₁ or y₂ vanishes, the axis passes through the vertical: their products with
    /// the others, e²/b and d²/b, give them to their own precision.
    pub(super) fn zeros(&self) -> ([Dd; 3], [Dd; 2], Dd) {
        let ([_, x2, x3], [y1, y2], w3) = self.separated_zeros();
        let x1 = self.e * self.e / (self.b * x2 * x3);
        let y2 = if y2 < w3 {
            // by a power of two clear of the end of the range, where d² is not
            let n = exponent(w3);
            let (d, w3) = (self.d.scaled(-n), w3.scaled(-n));
            (d * d / (self.b * y1 * w3)).scaled(n)
        } else {
            y2
        };
        ([x1, x2, x3], [y1, y2], w3)
    }

    /// The same from the quadratic that is left when the best separated zero is divided out.
    fn separated_zeros(&self) -> ([Dd; 3], [Dd; 2], Dd) {
        let Start { b, a, e, d, x, y, transverse, .. } = *self;
        let two = Dd::of(2.0);
        // b y³ − p2 y² − p1 y + d² has the zeros y₁, y₂, −w₃
        let (p2, p1) = (two * b - (transverse - b * y) - a * a, two * (transverse - b * y) - two * a * d);
        let v = largest_zero([p2, -(b * p1), -(b * b * d * d)]);
        let y1 = largest_zero([-(p2 / b), -(p1 / b), d * d / b]);
        let y1 = if y1 > two { two } else { y1 };
        let y2 = p2 / b - y1 + v / b;
        if v + b * two * y2 < b * y1 {
            // u₂ and u₃ are the close pair
            let half_difference = (d * d / y1 - p1) / (b * y1 * two); // (y₂ − w₃)/2
            let n = exponent(if half_difference.abs() > d.abs() { half_difference } else { d });
            let scaled = d.scaled(-n);
            let product = scaled * scaled / (b * y1);
            let (y2, w3) = pair(half_difference.scaled(-n), product);
            let (y2, w3) = (y2.scaled(n), w3.scaled(n));
            return ([two - y1, two - y2, two + w3], [y1, y2], w3);
        }
        if y < x {
            // sum and product of y₁ and y₂, each from the coefficients that do not cancel
            let (y1, y2) = if v < b * y1 {
                let sum = (p2 + v) / b;
                ordered(sum, (v * sum - p1) / b)
            } else {
                ordered((p1 + b * d * d / v) / v, d * d / v)
            };
            return ([two - y1, two - y2, two + v / b], [y1, y2], v / b);
        }
        // the same in x, where it is the small one: b x³ − q2 x² + q1 x − e² with the zeros x₁, x₂, x₃
        let energy = transverse + b * x;
        let (q2, q1) = (two * b + energy + a * a, two * energy + two * a * e);
        let v = largest_zero([-q2, b * q1, -(b * b * e * e)]);
        let (x2, x1) = ordered((q1 - b * e * e / v) / v, e * e / v);
        ([x1, x2, v / b], [two - x1, two - x2], v / b - two)
    }
}

/// n of the power 2ⁿ next below |x|; 0 for 0.
fn exponent(x: Dd) -> i32 {
    if x.hi() == 0.0 { 0 } else { libm::ilogb(x.magnitude()) }
}

/// The larger and the smaller zero of z² − sum z + product, both real and not negative.
fn ordered(sum: Dd, product: Dd) -> (Dd, Dd) {
    let half = sum * Dd::of(0.5);
    let square = half * half - product;
    let root = if square > Dd::ZERO { square.sqrt() } else { Dd::ZERO };
    let larger = half + root;
    if root.hi() == 0.0 { (half, half) } else { (larger, product / larger) }
}

/// y and w, not negative, with (y − w)/2 and y w given.
fn pair(half_difference: Dd, product: Dd) -> (Dd, Dd) {
    let size = half_difference.abs() + (half_difference * half_difference + product).sqrt();
    let other = if size.hi() == 0.0 { Dd::ZERO } else { product / size };
    if half_difference < Dd::ZERO { (other, size) } else { (size, other) }
}

/// The largest zero of z³ + p z² + q z + r, all three real: Newton from above comes down to it.
fn largest_zero([p, q, r]: [Dd; 3]) -> Dd {
    let bound = p.magnitude().max(q.magnitude().sqrt()).max(libm::cbrt(r.magnitude()));
    let mut z = Dd::of(2.0 * bound);
    // a triple zero takes two thirds of the way a step
    for _ in 0..200 {
        let value = ((z + p) * z + q) * z + r;
        let slope = (z * Dd::of(3.0) + p * Dd::of(2.0)) * z + q;
        let next = z - value / slope;
        if next < z {
            z = next;
        } else {
            break;
        }
    }
    z
}
