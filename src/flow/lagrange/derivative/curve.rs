//! The cubic of the nutation about three values of u, and how its zeros change with the motion.

use super::Row;
use super::ball::Ball;
use super::elapsed::Elapsed;
use crate::flow::lagrange::nutation::Nutation;
use crate::num::Dd;
use crate::num::complex::Complex;

/// Constants of the motion.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    pub(super) g: f64,
    /// ω₃.
    pub(super) a: f64,
    e: f64,
    d: f64,
    /// b (1 + u) and b (1 − u) where the transverse angular velocity would vanish, and there m·Γ/A − au.
    apex: [f64; 2],
    apex_product: f64,
    pub(super) rate: f64,
    pub(super) p: f64,
    pub(super) q: f64,
    /// p − q.
    rest: f64,
    pub(super) elapsed: Elapsed,
    /// (b/8)(m·Γ/A − a u₁).
    pub(super) line: f64,
    /// Whether u₁, and u₂, are given by 1 + u rather than by 1 − u.
    low: [bool; 2],
    w3: f64,
    /// Of α, β and ζ.
    pub(super) about: [Cubic; 3],
}

/// `μ³ + A μ² + B μ − ϖ²` about one value of u.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cubic {
    pub(super) root: f64, // ϖ
    /// μ₁, μ₂, μ₃.
    pub(super) zeros: [f64; 3],
}

/// What a change of the motion makes of ϖ, A and B.
struct Coefficients {
    root: f64,
    a: f64,
    b: f64,
}

/// Changes in each direction.
#[derive(Clone, Debug)]
pub(super) struct Changes {
    /// Of p and of p − q.
    pub(super) p: Row,
    pub(super) rest: Row,
    /// Of (b/4)(u₃ − u) of the point.
    pub(super) point: Row,
    /// Of b u'/8 of the point.
    pub(super) slope: Row,
    /// Of μ₃ of α, β and ζ.
    pub(super) last: [Row; 3],
    /// ϖ δμ/2μ of α, β and ζ.
    pub(super) logarithms: [[Row; 3]; 3],
}

/// A change of the ball in its own axes.
pub(super) struct Change {
    /// δθ₁ + iδθ₂.
    pub(super) across: Complex<f64>,
    /// δω₁ + iδω₂.
    pub(super) zeta: Complex<f64>,
    pub(super) a: f64,
    pub(super) g: f64,
    /// δΓ₁ + iδΓ₂.
    pub(super) up: Complex<f64>,
}

impl Curve {
    pub(super) fn new(nutation: &Nutation, g: f64, a: f64) -> Self {
        let quarter = 0.5 * g;
        let ([x1, x2, x3], [y1, y2], w3) = (nutation.x.map(Dd::hi), nutation.y.map(Dd::hi), nutation.w3.hi());
        let (e, d) = (nutation.e.hi(), nutation.d.hi());
        let apex = nutation.apex.map(|x| 2.0 * g * x.hi());
        let apex_product = nutation.apex_product().hi();
        let [to_second, to_third] = nutation.apex_apart().map(Dd::hi);
        let cubic = |root: f64, zeros: [f64; 3]| Cubic { root, zeros: zeros.map(|z| z * quarter) };
        let p = (nutation.rate * nutation.rate).hi();
        let (q, rest) = (p * nutation.parameter.hi(), p * nutation.complement.hi());
        let about = [
            cubic(0.5 * quarter * e, [x1, x2, x3]),
            cubic(-(0.5 * quarter * d), [-y1, -y2, w3]),
            cubic(
                0.5 * quarter * apex_product,
                [(nutation.x[0] - nutation.apex[0]).hi(), -to_second, to_third],
            ),
        ];
        let first_low = x1 < 1.0;
        let lowest = if first_low { e - a * x1 } else { d + a * y1 };
        Curve {
            g,
            a,
            e,
            d,
            apex,
            apex_product,
            rate: nutation.rate.hi(),
            p,
            q,
            rest,
            elapsed: Elapsed::new(nutation.rate.hi(), nutation.parameter.hi()),
            line: 0.5 * quarter * lowest,
            low: [first_low, x2 < 1.0 || (first_low && is_close(q, about[0]))],
            w3: quarter * w3,
            about,
        }
    }

    /// (b/4)(u₃ − u) at a point.
    pub(super) fn above(&self, ball: &Ball) -> f64 {
        self.w3 + 0.5 * self.g * ball.tilt()[1]
    }

    /// b u'/8 at a point.
    pub(super) fn slope(&self, ball: &Ball) -> f64 {
        0.25 * self.g * (ball.up().conjugate() * ball.zeta).im
    }

    /// Of the direction `n`, by the change there of the `ball`.
    pub(super) fn change(&self, ball: &Ball, change: &Change, n: usize, changes: &mut Changes) {
        let Curve { g, a, e, d, apex: [top, bottom], apex_product, .. } = *self;
        let (b, db, da) = (2.0 * g, 2.0 * change.g, change.a);
        let ([x, y], up, zeta) = (ball.tilt(), ball.up(), ball.zeta);
        // of u, of |ζ|², and of the products of Γ and ω
        let dx = up.re * change.across.im - up.im * change.across.re;
        let d_square = 2.0 * (zeta.conjugate() * change.zeta).re;
        let product = change.up.conjugate() * zeta + up.conjugate() * change.zeta;
        let de = product.re + x * da + a * dx;
        let dd = product.re - y * da + a * dx;
        let d_top = x * db + b * dx + d_square;
        let d_bottom = y * db - b * dx - d_square;
        // b times the product, in whose change that of u has no part
        let last = b * apex_product;
        let d_last =
            b * product.re - zeta.norm_squared() * da - a * d_square + db * (up.conjugate() * zeta).re;
        let of = [
            Coefficients {
                root: (db * e + b * de) * 0.125,
                a: -(0.5 * db + 0.25 * d_top + 0.5 * a * da),
                b: (db * (top + a * e) + b * (d_top + da * e + a * de)) * 0.125,
            },
            Coefficients {
                root: -((db * d + b * dd) * 0.125),
                a: 0.5 * db + 0.25 * d_bottom - 0.5 * a * da,
                b: (db * (bottom + a * d) + b * (d_bottom + da * d + a * dd)) * 0.125,
            },
            Coefficients {
                root: d_last * 0.125,
                a: 0.25 * (d_top - d_bottom) - 0.5 * a * da,
                b: (2.0 * (da * last + a * d_last) - d_top * bottom - top * d_bottom) * 0.0625,
            },
        ];

        let zeros = self.zeros(&of, db);
        changes.p[n] = zeros[2] - zeros[0];
        changes.rest[n] = zeros[2] - zeros[1];
        changes.point[n] = zeros[2] + 0.25 * (y * db - b * dx);
        changes.slope[n] = 0.125 * (db * (up.conjugate() * zeta).im + b * product.im);
        let shifts = [0.5 * db, 0.0, 0.25 * d_bottom];
        for (k, of) in of.iter().enumerate() {
            changes.last[k][n] = zeros[2] + shifts[k];
            let mut found = self.logarithms(&self.about[k], of);
            // where 1 + u is not small, or 1 − u, the other one tells more of a zero
            let is_far = |zero: usize| match k {
                0 => zero == 2 || !self.low[zero],
                1 => zero < 2 && self.low[zero],
                _ => false,
            };
            for zero in 0..3 {
                if is_far(zero) {
                    let Cubic { root, zeros: at } = self.about[k];
                    found[zero] = 0.5 * root * (zeros[zero] + shifts[k]) / at[zero];
                }
                changes.logarithms[k][zero][n] = found[zero];
            }
        }
    }

    /// The derivative of the cubic at each zero.
    fn slopes(&self) -> [f64; 3] {
        let Curve { p, q, rest, .. } = *self;
        [p * q, -(q * rest), p * rest]
    }

    /// δμ of the zeros about u = 1.
    fn zeros(&self, of: &[Coefficients; 3], db: f64) -> [f64; 3] {
        let slopes = self.slopes();
        let alone = |k: usize, zero: usize| {
            let (Cubic { root, zeros }, Coefficients { root: d_root, a, b }) = (self.about[k], &of[k]);
            (2.0 * root * d_root - zeros[zero] * (b + zeros[zero] * a)) / slopes[zero]
        };
        let shift = |low: bool| if low { 0.5 * db } else { 0.0 };
        let base = self.low.map(|low| usize::from(!low));
        let mut found =
            [alone(base[0], 0) - shift(self.low[0]), alone(base[1], 1) - shift(self.low[1]), alone(1, 2)];
        if self.rest == 0.0 {
            // only the sum of the two has a derivative
            found[1] = 0.5 * (-of[1].a - found[0]);
            found[2] = found[1];
            return found;
        }
        let k = base[1];
        let about = self.about[k];
        if is_close(self.q, about) {
            // sum and product of the two without a difference
            let [_, _, third] = about.zeros;
            let d_third = found[2] + shift(k == 0);
            let product = about.root * (about.root / third);
            let d_product = 2.0 * (about.root / third) * of[k].root - product / third * d_third;
            let sum = about.zeros[0] + about.zeros[1];
            let d_sum = (of[k].b - d_product - sum * d_third) / third - 2.0 * shift(k == 0);
            if is_one(self.q, about) {
                found[0] = 0.5 * d_sum;
            }
            found[1] = d_sum - found[0];
        }
        found
    }

    /// ϖ δμ/2μ of the zeros of a cubic, finite where ϖ and μ vanish.
    fn logarithms(&self, cubic: &Cubic, of: &Coefficients) -> [f64; 3] {
        let slopes = self.slopes();
        let Cubic { root, zeros } = *cubic;
        let alone = |k: usize| {
            let others = zeros[(k + 1) % 3] * zeros[(k + 2) % 3];
            (others * of.root - 0.5 * root * (of.b + zeros[k] * of.a)) / slopes[k]
        };
        let mut found = [0, 1, 2].map(alone);
        if self.rest == 0.0 {
            found[1] = 0.5 * (of.root - found[0]);
            found[2] = found[1];
        } else if is_close(self.q, *cubic) {
            if is_one(self.q, *cubic) {
                found[0] = 0.5 * (of.root - found[2]);
            }
            found[1] = of.root - found[2] - found[0];
        }
        found
    }
}

/// Whether the first two zeros are nearer to one another than to the value that the cubic is taken about.
fn is_close(q: f64, cubic: Cubic) -> bool {
    q < 0.5 * cubic.zeros[0].abs()
}

/// Whether they are one but for rounding: then only their sum has a derivative.
fn is_one(q: f64, cubic: Cubic) -> bool {
    q <= f64::EPSILON * cubic.zeros[0].abs()
}
