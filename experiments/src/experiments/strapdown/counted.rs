//! A double that counts the operations done with it.

use core::cell::Cell;
use core::ops::{Add, Div, Mul, Neg, Sub};

use polhode::num::{Dd, Precise, Real};

/// What a sine with its cosine counts: about as many operations as its polynomials take.
const SINE: u64 = 20;

thread_local! {
    static OPERATIONS: Cell<u64> = const { Cell::new(0) };
}

/// A double; sums, products, quotients and roots count one each, a sine with its cosine [`SINE`].
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(super) struct Counted(f64);

/// Operations on this thread while `work` was done.
pub(super) fn operations(work: impl FnOnce()) -> u64 {
    let before = OPERATIONS.get();
    work();
    OPERATIONS.get() - before
}

fn counted(value: f64, operations: u64) -> Counted {
    OPERATIONS.set(OPERATIONS.get() + operations);
    Counted(value)
}

impl Add for Counted {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        counted(self.0 + b.0, 1)
    }
}
impl Sub for Counted {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        counted(self.0 - b.0, 1)
    }
}
impl Mul for Counted {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        counted(self.0 * b.0, 1)
    }
}
impl Div for Counted {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        counted(self.0 / b.0, 1)
    }
}
impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Counted(-self.0)
    }
}

impl Real for Counted {
    const ROUNDOFF: f64 = f64::ROUNDOFF;
    fn of(x: f64) -> Self {
        Counted(x)
    }
    fn sqrt(self) -> Self {
        counted(self.0.sqrt(), 1)
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = Real::sin_cos(self.0);
        (counted(sin, SINE), Counted(cos))
    }
    fn magnitude(self) -> f64 {
        self.0.magnitude()
    }
}

impl Precise for Counted {
    fn to_dd(self) -> Dd {
        self.0.to_dd()
    }
    fn to_f64(self) -> f64 {
        self.0
    }
    fn abs(self) -> Self {
        Counted(Precise::abs(self.0))
    }
    fn round(self) -> Self {
        Counted(Precise::round(self.0))
    }
    fn atan2(self, x: Self) -> Self {
        counted(Precise::atan2(self.0, x.0), SINE)
    }
    fn exp(self) -> Self {
        counted(Precise::exp(self.0), SINE)
    }
    fn exp_m1(self) -> Self {
        counted(Precise::exp_m1(self.0), SINE)
    }
    fn ln(self) -> Self {
        counted(Precise::ln(self.0), SINE)
    }
}
