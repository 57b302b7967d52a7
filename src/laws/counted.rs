//! A double that counts what is done with it.

use core::cell::Cell;
use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::num::{Dd, Precise, Real};

thread_local! {
    static DONE: Cell<Operations> = const { Cell::new(Operations::NONE) };
    static TORQUES: Cell<u32> = const { Cell::new(0) };
}

/// A double that counts, on each thread, the [operations] done with it: the scalar that [`check_cost`](super::check_cost) needs a
/// method for.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Counted(pub(super) f64);

/// Numbers of operations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Operations {
    /// Sums, differences, products and quotients.
    pub arithmetic: u64,
    /// Square roots.
    pub roots: u64,
    /// Sines with their cosines.
    pub sines: u64,
    /// Arcs, exponentials and logarithms.
    pub others: u64,
}

impl Operations {
    const NONE: Operations = Operations { arithmetic: 0, roots: 0, sines: 0, others: 0 };
}

/// Operations with [`Counted`] on this thread while `work` was done.
///
/// ```
/// use polhode::laws::{Counted, operations};
/// use polhode::num::Real;
/// use polhode::rotation::Vec3;
/// let v = Vec3([1.0, 2.0, 3.0].map(Counted::of));
/// let done = operations(|| _ = v.cross(v));
/// assert_eq!((done.arithmetic, done.roots, done.sines), (9, 0, 0));
/// ```
pub fn operations(work: impl FnOnce()) -> Operations {
    let before = DONE.replace(Operations::NONE);
    work();
    let done = DONE.get();
    DONE.set(Operations {
        arithmetic: before.arithmetic + done.arithmetic,
        roots: before.roots + done.roots,
        sines: before.sines + done.sines,
        others: before.others + done.others,
    });
    done
}

/// Sines, roots and torques while `work` was done, on this thread.
pub(super) fn counts(work: impl FnOnce()) -> [u32; 3] {
    TORQUES.set(0);
    let done = operations(work);
    let narrow = |count: u64| u32::try_from(count).unwrap_or(u32::MAX);
    [narrow(done.sines), narrow(done.roots), TORQUES.get()]
}

pub(super) fn count_torque() {
    TORQUES.set(TORQUES.get().saturating_add(1));
}

fn count(add: impl FnOnce(&mut Operations)) {
    let mut done = DONE.get();
    add(&mut done);
    DONE.set(done);
}

fn arithmetic(value: f64) -> Counted {
    count(|done| done.arithmetic += 1);
    Counted(value)
}

fn other(value: f64) -> Counted {
    count(|done| done.others += 1);
    Counted(value)
}

impl Add for Counted {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        arithmetic(self.0 + b.0)
    }
}
impl Sub for Counted {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        arithmetic(self.0 - b.0)
    }
}
impl Mul for Counted {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        arithmetic(self.0 * b.0)
    }
}
impl Div for Counted {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        arithmetic(self.0 / b.0)
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
        count(|done| done.roots += 1);
        Counted(self.0.sqrt())
    }
    fn sin_cos(self) -> (Self, Self) {
        count(|done| done.sines += 1);
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
        other(Precise::atan2(self.0, x.0))
    }
    fn exp(self) -> Self {
        other(Precise::exp(self.0))
    }
    fn exp_m1(self) -> Self {
        other(Precise::exp_m1(self.0))
    }
    fn ln(self) -> Self {
        other(Precise::ln(self.0))
    }
}
