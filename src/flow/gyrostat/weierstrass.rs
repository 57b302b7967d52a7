//! The argument u of Weierstrass's function from X = ℘(u) and Y = ℘'(u).
//!
//! Carlson's integral R_F(X − e₁, X − e₂, X − e₃) in complex `f64`, then Newton's method in theta functions of the nome
//! q = e^{iπω₂/T}: `℘(u) − e₁ = (π/T)² (θ₁'(0)/θ₂(0))² (θ₂(z)/θ₁(z))²`, z = πu/T. Both X and Y guide it, since next to a
//! half period X alone has half the digits.

use super::lattice::Lattice;
use super::level::Place;
use crate::num::complex::Complex;
use crate::num::{Dd, Precise, Real};

/// A lattice with weights of theta functions.
#[derive(Clone, Debug)]
pub(super) struct Weierstrass {
    pub(super) lattice: Lattice,
    /// q^{n² + n}, which is real.
    weights: Vec<Dd>,
    /// (π/T)² (θ₁'(0)/θ₂(0))².
    factor: Dd,
    per_period: Dd, // π/T
}

/// θ₂/θ₁, its derivative by u, and θ₁'/θ₁, by u.
struct Quotient {
    value: Complex<Dd>,
    derivative: Complex<Dd>,
    logarithmic: Complex<Dd>,
}

impl Weierstrass {
    pub(super) fn new(lattice: Lattice) -> Self {
        let square = (-(lattice.ratio() * Dd::TAU)).exp(); // |q|²
        let square = if lattice.is_skew { -square } else { square };
        let (mut weights, mut power, mut weight) = (vec![Dd::ONE], square, square);
        // at the edge of the cell a term is the root of |q| larger for each power of the exponential
        while weight.magnitude() > 1e-36 && weights.len() < 60 {
            weights.push(weight);
            power = power * square;
            weight = weight * power;
        }
        let (mut one, mut two) = (Dd::ZERO, Dd::ZERO);
        for (n, &weight) in weights.iter().enumerate() {
            two = two + weight;
            one = one + weight * (signed(n) * odd(n));
        }
        let per_period = Dd::PI / lattice.period;
        let root = one / two * per_period;
        Weierstrass { lattice, weights, factor: root * root, per_period }
    }

    fn quotient(&self, u: Complex<Dd>) -> Quotient {
        let z = u.scaled(self.per_period);
        let size = (-z.im).exp();
        let up = Complex::phase(z.re).scaled(size);
        let down = up.inverse_conjugate().conjugate();
        let (up2, down2) = (up * up, down * down);
        let (mut up, mut down) = (up, down);
        let zero = Complex::new(Dd::ZERO, Dd::ZERO);
        // iθ₁, θ₂ and their derivatives by iz
        let [mut one, mut two, mut one_rate, mut two_rate] = [zero; 4];
        for (n, &weight) in self.weights.iter().enumerate() {
            let (sum, difference) = ((up + down).scaled(weight), (up - down).scaled(weight));
            one = one + difference.scaled(Dd::of(signed(n)));
            one_rate = one_rate + sum.scaled(Dd::of(signed(n) * odd(n)));
            two = two + sum;
            two_rate = two_rate + difference.scaled(Dd::of(odd(n)));
            (up, down) = (up * up2, down * down2);
        }
        let inverse = one.inverse_conjugate().conjugate();
        let (value, logarithmic) = (two * inverse, one_rate * inverse);
        let derivative = two_rate * inverse - value * logarithmic;
        // d/du = i π/T d/d(iz), and θ₂/θ₁ = i θ₂/(iθ₁)
        let turned = |x: Complex<Dd>| Complex::new(-x.im, x.re);
        Quotient {
            value: turned(value),
            derivative: derivative.scaled(-self.per_period),
            logarithmic: turned(logarithmic).scaled(self.per_period),
        }
    }

    /// θ₁'(z)/θ₁(z), z = πu/T, as a derivative by u.
    pub(super) fn logarithmic(&self, u: Complex<Dd>) -> Complex<Dd> {
        self.quotient(u).logarithmic
    }

    /// u, next to zero in the lattice.
    pub(super) fn argument(&self, place: &Place) -> Complex<Dd> {
        let apart = self.lattice.roots.map(|root| place.x - root);
        self.argument_apart(apart, place.y)
    }

    /// The same from X − e₁, X − e₂, X − e₃ and Y.
    pub(super) fn argument_apart(&self, apart: [Complex<Dd>; 3], y: Complex<Dd>) -> Complex<Dd> {
        let lattice = &self.lattice;
        let size = |x: Complex<Dd>| x.norm_squared().sqrt();
        // a circle that a symmetric body draws: u is half a period away, and where is of no matter
        if size(apart[1]).magnitude().max(size(apart[2]).magnitude()) <= lattice.rounding {
            return Complex::new(lattice.period * 0.25, lattice.height * 0.5);
        }
        let rough = carlson(apart.map(|x| Complex::new(x.re.hi(), x.im.hi())));
        let mut u = lattice.reduced(Complex::new(Dd::of(rough.re), Dd::of(rough.im)));
        let unit = self.per_period * self.per_period;
        for step in 0..4 {
            let quotient = self.quotient(u);
            let above = (quotient.value * quotient.value).scaled(self.factor);
            let mut slope = (quotient.value * quotient.derivative).scaled(self.factor * 2.0);
            if step == 0 && (slope + y).norm_squared() < (slope - y).norm_squared() {
                u = Complex::new(-u.re, -u.im);
                slope = Complex::new(-slope.re, -slope.im);
            }
            let x = above + lattice.roots[0];
            let bend = (x * x).scaled(Dd::of(6.0)) - Complex::new(lattice.g2 * 0.5, Dd::ZERO);
            let (off_x, off_y) = (apart[0] - above, y - slope);
            let sum = (slope.conjugate() * off_x).scaled(unit) + bend.conjugate() * off_y;
            let by = slope.norm_squared() * unit + bend.norm_squared();
            let correction = sum.scaled(Dd::ONE / by);
            let is_small = correction.norm_squared() < lattice.period * lattice.period * 0.01;
            if !is_small {
                break;
            }
            u = u + correction;
            if correction.norm_squared() < lattice.period * lattice.period * 1e-50 {
                break;
            }
        }
        lattice.reduced(u)
    }
}

fn signed(n: usize) -> f64 {
    if n.is_multiple_of(2) { 1.0 } else { -1.0 }
}

fn odd(n: usize) -> f64 {
    2.0 * n as f64 + 1.0
}

/// R_F of complex numbers, up to its sign and periods, which the branches of the roots leave open.
fn carlson(z: [Complex<f64>; 3]) -> Complex<f64> {
    // turned so that the mean is positive, or the roots of nearly equal numbers might lie on different branches
    let mean = z[0] + z[1] + z[2];
    let size = mean.norm_squared().sqrt();
    let turn = if size > 0.0 { mean.conjugate().scaled(1.0 / size) } else { Complex::new(1.0, 0.0) };
    let mut z = z.map(|z| z * turn);
    for _ in 0..40 {
        let [a, b, mut c] = z.map(root);
        // those of e₂ and e₃ on one branch: the half period between two all but equal roots is so far away that f64 would
        // not find back
        if (b * c.conjugate()).re < 0.0 {
            c = c.scaled(-1.0);
        }
        let shift = a * b + b * c + c * a;
        z = z.map(|z| (z + shift).scaled(0.25));
        let mean = (z[0] + z[1] + z[2]).scaled(1.0 / 3.0);
        if z.iter().all(|&z| (z - mean).norm_squared() <= 1e-17 * mean.norm_squared()) {
            break;
        }
    }
    let mean = root((z[0] + z[1] + z[2]).scaled(1.0 / 3.0));
    root(turn) * mean.inverse_conjugate().conjugate()
}

fn root(z: Complex<f64>) -> Complex<f64> {
    let size = z.norm_squared().sqrt();
    if size == 0.0 {
        return z;
    }
    let half = (0.5 * (size + z.re.abs())).sqrt();
    let other = 0.5 * z.im / half;
    if z.re >= 0.0 {
        Complex::new(half, other)
    } else {
        Complex::new(other.abs(), if z.im < 0.0 { -half } else { half })
    }
}
