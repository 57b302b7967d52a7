//! The heavy ball whose axis rests on the vertical, upright or hanging: its changes are linear with constant coefficients.

use super::step::Response;
use crate::flow::free::reduce;
use crate::num::{Dd, Precise, Real};

/// At the time `t`, with g times the cosine of the tilt, which is 1 or −1, and the spin ω₃; in axes that have turned about e₃ by
/// `beside` beside those of the ball.
///
/// With θ = δθ₁ + iδθ₂ and w alike, `θ' = −iω₃θ + w`, `w' = ±gθ`: the axes turn by ω₃t/2, and in them all is a combination of
/// cosh and sinh of √D t, D = ±g − ω₃²/4.
pub(super) fn at(t: Dd, g: Dd, spin: Dd, beside: Dd) -> Response {
    let half = spin * 0.5;
    let square = g - half * half;
    let root = square.abs().sqrt();
    let phase = root * t;
    let (even, odd) = if phase.hi() == 0.0 {
        (Dd::ONE, t)
    } else if square > Dd::ZERO {
        let (grown, shrunk) = (phase.exp(), (-phase).exp());
        let even = (grown + shrunk) * 0.5;
        let odd = if phase.magnitude() < 1e-3 { small_sinh(phase) } else { (grown - shrunk) * 0.5 };
        (even, odd / root)
    } else {
        let (sin, cos) = reduce(phase, Dd::TAU).sin_cos();
        (cos, sin / root)
    };
    let (even, odd, swung, pushed) = (even.hi(), odd.hi(), (odd * half).hi(), (odd * g).hi());
    let mut response = Response::zeros();
    for (k, other, sign) in [(0, 1, 1.0), (1, 0, -1.0)] {
        response[(k, k)] = even;
        response[(k, other)] = sign * swung;
        response[(k, 3 + k)] = odd;
        response[(3 + k, k)] = pushed;
        response[(3 + k, 3 + k)] = even;
        response[(3 + k, 3 + other)] = -sign * swung;
    }
    response[(2, 2)] = 1.0;
    response[(2, 5)] = t.hi();
    response[(5, 5)] = 1.0;
    turned(response, -(half * t + beside))
}

/// sinh x, |x| < 1e-3, without a difference.
fn small_sinh(x: Dd) -> Dd {
    let y = x * x;
    x * (Dd::ONE + y / 6.0 * (Dd::ONE + y / 20.0))
}

/// The rows turned about e₃ by `angle`, rad.
fn turned(mut rows: Response, angle: Dd) -> Response {
    let (sin, cos) = reduce(angle, Dd::TAU).sin_cos();
    let (sin, cos) = (sin.hi(), cos.hi());
    for first in [0, 3] {
        for column in 0..7 {
            let (x, y) = (rows[(first, column)], rows[(first + 1, column)]);
            (rows[(first, column)], rows[(first + 1, column)]) = (cos * x - sin * y, sin * x + cos * y);
        }
    }
    rows
}
