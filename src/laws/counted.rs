//! A double that counts sines and square roots.

use core::cell::Cell;
use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::num::{Dd, Precise, Real};

thread_local! {
    static SINES: Cell<u32> = const { Cell::new(0) };
    static ROOTS: Cell<u32> = const { Cell::new(0) };
    static TORQUES: Cell<u32> = const { Cell::new(0) };
}

/// A double that counts, on each thread, how often a sine and cosine and a square root are taken: the scalar that
/// [`check_cost`](super::check_cost) needs a method for.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Counted(pub(super) f64);

/// Sines, roots and torques while `work` was done, on this thread.
pub(super) fn counts(work: impl FnOnce()) -> [u32; 3] {
    let counters = [&SINES, &ROOTS, &TORQUES];
    for counter in counters {
        counter.set(0);
    }
    work();
    counters.map(|counter| counter.get())
}

pub(super) fn count_torque() {
    count(&TORQUES);
}

fn count(counter: &'static std::thread::LocalKey<Cell<u32>>) {
    counter.set(counter.get().saturating_add(1));
}

impl Add for Counted {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Counted(self.0 + b.0)
    }
}
impl Sub for Counted {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Counted(self.0 - b.0)
    }
}
impl Mul for Counted {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Counted(self.0 * b.0)
    }
}
impl Div for Counted {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        Counted(self.0 / b.0)
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
        count(&ROOTS);
        Counted(self.0.sqrt())
    }
    fn sin_cos(self) -> (Self, Self) {
        count(&SINES);
        let (s, c) = Real::sin_cos(self.0);
        (Counted(s), Counted(c))
    }
    fn magnitude(self) -> f64 {
        self.0.abs()
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
        Counted(self.0.abs())
    }
    fn round(self) -> Self {
        Counted(self.0.round())
    }
    fn atan2(self, x: Self) -> Self {
        Counted(Precise::atan2(self.0, x.0))
    }
    fn exp(self) -> Self {
        Counted(Precise::exp(self.0))
    }
    fn exp_m1(self) -> Self {
        Counted(Precise::exp_m1(self.0))
    }
    fn ln(self) -> Self {
        Counted(Precise::ln(self.0))
    }
}
