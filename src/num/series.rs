//! Truncated power series as scalars of kernels: a law that is written over any [`Real`] gives the Taylor coefficients of
//! its result.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::{Dd, Real};

/// The most coefficients of a series.
const TERMS: usize = 41;

/// A power series `c₀ + c₁ s + c₂ s² + …` of which the first coefficients are known.
///
/// An operation gives as many coefficients as are known of all its operands, by the recurrences of Knuth, The Art of Computer
/// Programming 2, §4.7; a product of n coefficients takes n²/2 multiplications. A number is a series of which all are known,
/// and arithmetic of the first coefficients alone has the bits of arithmetic of the numbers.
///
/// Two operations need an analytic result: a division, a divisor whose c₀ is not 0, and a square root, one whose c₀ is
/// positive, or a series of zeros. Elsewhere what comes out is not finite.
///
/// ```
/// use polhode::num::{Real, Series};
/// let x = Series::from_coefficients(&[0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
/// let (sine, cosine) = x.sin_cos();
/// assert_eq!(sine.coefficient(3), -1.0 / 6.0);
/// let one = sine * sine + cosine * cosine;
/// assert_eq!((one.known(), one.coefficient(0)), (6, 1.0));
/// assert!((1..6).all(|n| one.coefficient(n).abs() < 1e-16));
/// ```
#[derive(Clone, Copy, Debug)]
#[must_use]
pub struct Series<S> {
    coefficients: [S; TERMS],
    /// The highest power whose coefficient may differ from 0.
    degree: usize,
    known: usize,
}

impl<S: Real> Series<S> {
    /// The highest power that a series can hold.
    pub const LARGEST_POWER: usize = TERMS - 1;

    /// The series with these coefficients, of which the first 41 are taken, and all known if there is none.
    pub fn from_coefficients(coefficients: &[S]) -> Self {
        let mut series = Series::number(S::of(0.0));
        if let Some(last) = coefficients.len().min(TERMS).checked_sub(1) {
            (series.degree, series.known) = (last, last + 1);
            series.coefficients[..=last].copy_from_slice(&coefficients[..=last]);
        }
        series
    }

    /// The series of a number.
    pub fn number(c: S) -> Self {
        let mut coefficients = [S::of(0.0); TERMS];
        coefficients[0] = c;
        Series { coefficients, degree: 0, known: TERMS }
    }

    /// The coefficient of the power `power`; 0 where it is not known.
    #[must_use]
    pub fn coefficient(&self, power: usize) -> S {
        if power <= self.degree { self.coefficients[power] } else { S::of(0.0) }
    }

    /// How many coefficients are known.
    #[must_use]
    pub fn known(&self) -> usize {
        self.known
    }

    /// Adds the next coefficient; the 42nd is dropped.
    pub(crate) fn push(&mut self, c: S) {
        if self.known < TERMS {
            self.coefficients[self.known] = c;
            (self.degree, self.known) = (self.known, self.known + 1);
        }
    }

    /// A series of zeros to the power `degree`, `known` of which are to be known.
    fn zeros(degree: usize, known: usize) -> Self {
        Series { degree: degree.min(known - 1), known, ..Series::number(S::of(0.0)) }
    }

    /// The same with each coefficient mapped by `f`, which takes 0 to 0.
    fn map(mut self, f: impl Fn(S) -> S) -> Self {
        for c in &mut self.coefficients[..=self.degree] {
            *c = f(*c);
        }
        self
    }

    /// The coefficients of the two at each power.
    fn zip(self, b: Self, f: impl Fn(S, S) -> S) -> Self {
        let mut sum = Series::zeros(self.degree.max(b.degree), self.known.min(b.known));
        for (n, c) in sum.coefficients[..=sum.degree].iter_mut().enumerate() {
            *c = f(self.coefficients[n], b.coefficients[n]);
        }
        sum
    }

    /// `Σ a_k b_{n−k}`, k in `from..=n`, over coefficients that may differ from 0.
    #[inline]
    fn convolution(&self, b: &Self, from: usize, n: usize) -> S {
        let mut sum = S::of(0.0);
        for k in from.max(n.saturating_sub(b.degree))..=n.min(self.degree) {
            sum = sum + self.coefficients[k] * b.coefficients[n - k];
        }
        sum
    }
}

impl<S: Real> Add for Series<S> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        self.zip(b, |a, b| a + b)
    }
}

impl<S: Real> Sub for Series<S> {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self.zip(b, |a, b| a - b)
    }
}

impl<S: Real> Neg for Series<S> {
    type Output = Self;
    fn neg(self) -> Self {
        self.map(|c| -c)
    }
}

impl<S: Real> Mul for Series<S> {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let mut product = Series::zeros(self.degree + b.degree, self.known.min(b.known));
        product.coefficients[0] = self.coefficients[0] * b.coefficients[0];
        for n in 1..=product.degree {
            product.coefficients[n] = self.convolution(&b, 0, n);
        }
        product
    }
}

impl<S: Real> Div for Series<S> {
    type Output = Self;
    /// `q_n = (a_n − Σ q_k b_{n−k})/b₀`, k < n.
    fn div(self, b: Self) -> Self {
        let degree = if b.degree == 0 { self.degree } else { TERMS };
        let mut quotient = Series::zeros(degree, self.known.min(b.known));
        quotient.coefficients[0] = self.coefficients[0] / b.coefficients[0];
        for n in 1..=quotient.degree {
            // b from its power 1 on
            let taken = b.convolution(&quotient, 1, n);
            quotient.coefficients[n] = (self.coefficients[n] - taken) / b.coefficients[0];
        }
        quotient
    }
}

impl<S: Real> Real for Series<S> {
    const ROUNDOFF: f64 = S::ROUNDOFF;
    /// Two for the first coefficient, and six that double how many are right.
    const NEWTON_STEPS: u32 = S::NEWTON_STEPS + 6;

    fn of(x: f64) -> Self {
        Series::number(S::of(x))
    }

    fn from_dd(x: Dd) -> Self {
        Series::number(S::from_dd(x))
    }

    fn rounded(x: Dd) -> Dd {
        S::rounded(x)
    }

    fn linear(value: Dd, slope: f64) -> Self {
        let mut line = Series::zeros(1, TERMS);
        line.coefficients[..2].copy_from_slice(&[S::from_dd(value), S::of(slope)]);
        line
    }

    /// `2 r₀ r_n = a_n − Σ r_k r_{n−k}`, 0 < k < n.
    fn sqrt(self) -> Self {
        if self.magnitude() == 0.0 {
            return self;
        }
        let mut root = Series::zeros(if self.degree == 0 { 0 } else { TERMS }, self.known);
        root.coefficients[0] = self.coefficients[0].sqrt();
        let twice = root.coefficients[0] + root.coefficients[0];
        for n in 1..=root.degree {
            // of this power the root holds a zero yet, which takes the terms with r₀ out of the sum
            root.coefficients[n] = (self.coefficients[n] - root.convolution(&root, 1, n)) / twice;
        }
        root
    }

    /// `n s_n = Σ k a_k c_{n−k}` and `n c_n = −Σ k a_k s_{n−k}`, 0 < k ≤ n.
    fn sin_cos(self) -> (Self, Self) {
        let zeros = Series::zeros(if self.degree == 0 { 0 } else { TERMS }, self.known);
        let (mut sine, mut cosine) = (zeros, zeros);
        (sine.coefficients[0], cosine.coefficients[0]) = self.coefficients[0].sin_cos();
        let mut slope = self;
        for k in 0..=slope.degree {
            slope.coefficients[k] = slope.coefficients[k] * S::of(k as f64);
        }
        for n in 1..=zeros.degree {
            let share = S::of(1.0) / S::of(n as f64);
            let (s, c) = (slope.convolution(&cosine, 1, n), slope.convolution(&sine, 1, n));
            (sine.coefficients[n], cosine.coefficients[n]) = (s * share, -(c * share));
        }
        (sine, cosine)
    }

    fn magnitude(self) -> f64 {
        self.coefficients[..=self.degree].iter().fold(0.0, |largest: f64, c| {
            let c = c.magnitude();
            if c.is_nan() || largest.is_nan() { f64::NAN } else { largest.max(c) }
        })
    }
}
