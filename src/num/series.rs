//! Truncated power series as scalars of kernels: a law that is written over any [`Real`] is recorded once, and gives the
//! Taylor coefficients of its result one after another.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::recurrence::Kind;
use super::tape::on_tape;
use super::{Dd, Real, Tape};

/// A power series `c₀ + c₁ s + c₂ s² + …` while a [`Tape`](super::Tape) records what becomes of it: a number, or an entry of the tape.
///
/// As a [`Real`] its [magnitude](Real::magnitude) is that of c₀, which has the bits of arithmetic in `S`. Two operations need
/// an analytic result: a division, a divisor whose c₀ is not 0, and a square root, a series of zeros or one whose c₀ is
/// positive. Elsewhere what comes out is not finite. So is everything that is made of entries when no tape records.
#[derive(Clone, Copy, Debug)]
#[must_use]
pub struct Series<S>(pub(super) Term<S>);

#[derive(Clone, Copy, Debug)]
pub(super) enum Term<S> {
    Number(S),
    Entry(u32),
}

impl<S> Term<S> {
    pub(super) fn entry(&self) -> Option<u32> {
        match self {
            Term::Entry(k) => Some(*k),
            Term::Number(_) => None,
        }
    }
}

impl<S: Real> Series<S> {
    /// The series of a number.
    pub fn number(c: S) -> Self {
        Series(Term::Number(c))
    }

    /// What the tape that records makes of entries; not a number without one.
    fn recorded(enter: impl FnOnce(&mut Tape<S>) -> Self) -> Self {
        on_tape(enter).unwrap_or(Series::number(S::of(f64::NAN)))
    }

    fn is(c: S, number: f64) -> bool {
        (c - S::of(number)).magnitude() == 0.0
    }
}

impl<S: Real> Add for Series<S> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        match (self.0, b.0) {
            (Term::Number(a), Term::Number(b)) => Series::number(a + b),
            (Term::Entry(a), Term::Entry(b)) => {
                Series::recorded(|tape| tape.operate(Kind::Sum, [a, b], |[a, b]| a + b))
            }
            (Term::Entry(k), Term::Number(c)) | (Term::Number(c), Term::Entry(k)) => {
                if Self::is(c, 0.0) {
                    return Series(Term::Entry(k));
                }
                Series::recorded(|tape| tape.operate(Kind::Shifted, [k; 2], |[a, _]| a + c))
            }
        }
    }
}

impl<S: Real> Sub for Series<S> {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        match (self.0, b.0) {
            (Term::Number(a), Term::Number(b)) => Series::number(a - b),
            (Term::Entry(a), Term::Entry(b)) => {
                Series::recorded(|tape| tape.operate(Kind::Difference, [a, b], |[a, b]| a - b))
            }
            (_, Term::Number(b)) => self + Series::number(-b),
            (Term::Number(_), Term::Entry(_)) => -b + self,
        }
    }
}

impl<S: Real> Neg for Series<S> {
    type Output = Self;
    fn neg(self) -> Self {
        match self.0 {
            Term::Number(a) => Series::number(-a),
            Term::Entry(a) => {
                Series::recorded(|tape| tape.operate(Kind::Negative, [a; 2], |[a, _]: [S; 2]| -a))
            }
        }
    }
}

impl<S: Real> Mul for Series<S> {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        match (self.0, b.0) {
            (Term::Number(a), Term::Number(b)) => Series::number(a * b),
            (Term::Entry(a), Term::Entry(b)) => {
                Series::recorded(|tape| tape.operate(Kind::Product, [a, b], |[a, b]| a * b))
            }
            (Term::Entry(k), Term::Number(c)) | (Term::Number(c), Term::Entry(k)) => {
                if Self::is(c, 1.0) {
                    return Series(Term::Entry(k));
                }
                Series::recorded(|tape| {
                    let first: S = tape.first(k) * c;
                    // of zeros nothing has to be worked out
                    if Self::is(c, 0.0) && first.magnitude() == 0.0 {
                        return Series::number(first);
                    }
                    tape.operate_with(Kind::Scaled, k, c, |a| a * c)
                })
            }
        }
    }
}

impl<S: Real> Div for Series<S> {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        match (self.0, b.0) {
            (Term::Number(a), Term::Number(b)) => Series::number(a / b),
            (Term::Entry(a), Term::Entry(b)) => {
                Series::recorded(|tape| tape.operate(Kind::Quotient, [a, b], |[a, b]| a / b))
            }
            (Term::Entry(a), Term::Number(b)) => {
                Series::recorded(|tape| tape.operate_with(Kind::Scaled, a, S::of(1.0) / b, |a| a / b))
            }
            (Term::Number(a), Term::Entry(b)) => {
                Series::recorded(|tape| tape.operate(Kind::Reciprocal, [b; 2], |[_, b]| a / b))
            }
        }
    }
}

impl<S: Real> Real for Series<S> {
    const ROUNDOFF: f64 = S::ROUNDOFF;
    const NEWTON_STEPS: u32 = S::NEWTON_STEPS;

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
        Series::recorded(|tape| tape.enter(Kind::Line, [0; 2], S::from_dd(value), S::of(slope)))
    }

    fn solution<const N: usize>(
        x: [Self; N],
        rates: impl FnOnce([Self; N]) -> [Self; N],
    ) -> Option<[Self; N]> {
        let solution = on_tape(|tape: &mut Tape<S>| x.map(|x| tape.enter_integral(x)))?;
        let rates = rates(solution);
        on_tape(|tape: &mut Tape<S>| {
            for (x, rate) in solution.into_iter().zip(rates) {
                tape.set_rate(x, rate);
            }
        })?;
        Some(solution)
    }

    fn sqrt(self) -> Self {
        match self.0 {
            Term::Number(a) => Series::number(a.sqrt()),
            Term::Entry(a) => {
                Series::recorded(|tape| tape.operate(Kind::Root, [a; 2], |[a, _]: [S; 2]| a.sqrt()))
            }
        }
    }

    fn sin_cos(self) -> (Self, Self) {
        match self.0 {
            Term::Number(a) => {
                let (sin, cos) = a.sin_cos();
                (Series::number(sin), Series::number(cos))
            }
            Term::Entry(a) => {
                let entered = on_tape(|tape: &mut Tape<S>| tape.enter_sine_and_cosine(a));
                entered.unwrap_or([(); 2].map(|()| Series::number(S::of(f64::NAN))).into())
            }
        }
    }

    /// Of an entry without the branch at 0, which would take its first coefficient for all.
    fn sinc_cos_of_root(self) -> (Self, Self) {
        if let Term::Number(c) = self.0 {
            let (sinc, cos) = c.sinc_cos_of_root();
            return (Series::number(sinc), Series::number(cos));
        }
        let x = self.sqrt();
        let (sin, cos) = x.sin_cos();
        (sin / x, cos)
    }

    fn magnitude(self) -> f64 {
        match self.0 {
            Term::Number(c) => c.magnitude(),
            Term::Entry(k) => {
                on_tape(|tape: &mut super::Tape<S>| tape.first(k).magnitude()).unwrap_or(f64::NAN)
            }
        }
    }
}
