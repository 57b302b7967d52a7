//! Truncated power series as scalars of kernels: a law that is written over any [`Real`] is recorded once, and gives the
//! Taylor coefficients of its result one after another.

use core::any::Any;
use core::cell::RefCell;
use core::ops::{Add, Div, Mul, Neg, Sub};

use super::{Dd, Real};

/// A power series `c₀ + c₁ s + c₂ s² + …` while a [`Tape`] records what becomes of it: a number, or an entry of the tape.
///
/// As a [`Real`] its [magnitude](Real::magnitude) is that of c₀, which has the bits of arithmetic in `S`. Two operations need
/// an analytic result: a division, a divisor whose c₀ is not 0, and a square root, a series of zeros or one whose c₀ is
/// positive. Elsewhere what comes out is not finite. So is everything that is made of entries when no tape records.
#[derive(Clone, Copy, Debug)]
#[must_use]
pub struct Series<S>(Term<S>);

#[derive(Clone, Copy, Debug)]
enum Term<S> {
    Number(S),
    Entry(u32),
}

/// How the coefficients of an entry follow from those of others.
#[derive(Clone, Copy, Debug)]
enum Operation<S> {
    /// From outside.
    Given,
    /// Of a straight line c₀ + slope · t, with the slope in seconds.
    Line(f64),
    /// Over the time in seconds.
    Integral(Term<S>),
    Sum(Term<S>, Term<S>),
    Difference(Term<S>, Term<S>),
    Negative(u32),
    Product(Term<S>, Term<S>),
    Quotient(Term<S>, Term<S>),
    Root(u32),
    /// n cₙ.
    Slope(u32),
    /// By the entries of the slope of the angle and of the cosine.
    Sine(u32, u32),
    /// By the entries of the slope of the angle and of the sine.
    Cosine(u32, u32),
}

#[derive(Clone, Copy, Debug)]
struct Entry<S> {
    operation: Operation<S>,
    /// The highest power whose coefficient may differ from 0.
    degree: usize,
    /// Whether it depends on the time alone, so that all its coefficients are known from the start.
    of_time: bool,
}

/// The operations of a law on power series, with the coefficients that are known of each result.
///
/// The law is evaluated once. Each next coefficient of its arguments then gives the next of its results, by the recurrences of
/// Knuth, The Art of Computer Programming 2, §4.7: a product takes n + 1 multiplications for its coefficient n. A law must
/// therefore take the same operations for all orders, which one without branches does.
///
/// ```
/// use polhode::num::{Real, Series, Tape};
/// // y' = sin² y, y(0) = 1, to the power 5
/// let mut tape = Tape::new(6);
/// let mut y = vec![1.0];
/// tape.record(&y, |y| [y[0].sin_cos().0 * y[0].sin_cos().0]);
/// tape.count_in(1.0);
/// for n in 0..5 {
///     y.push(tape.result(0, n) / (n + 1) as f64);
///     tape.push(&[y[n + 1]]);
/// }
/// // cot y = cot 1 − t
/// let (sine, cosine) = y.iter().rev().fold(0.0, |sum, c| sum * 0.01 + c).sin_cos();
/// assert!((cosine / sine - (1.0 / 1f64.tan() - 0.01)).abs() < 1e-12);
/// ```
#[derive(Clone, Debug)]
#[must_use]
pub struct Tape<S> {
    entries: Vec<Entry<S>>,
    /// `width` coefficients of each entry.
    coefficients: Vec<S>,
    width: usize,
    /// What the variable counts, s, once it has been said.
    unit: Option<f64>,
    /// 1/n.
    shares: Vec<S>,
    /// How many coefficients are known of what depends on the arguments.
    known: usize,
    arguments: usize,
    results: Vec<Series<S>>,
    /// The number of entries at the end of each part of the law.
    parts: Vec<usize>,
}

thread_local! {
    /// The tape that records.
    static RECORDING: RefCell<Option<Box<dyn Any>>> = const { RefCell::new(None) };
}

/// What `f` makes of the tape that records; `None` if none does.
fn on_tape<S: Real, R>(f: impl FnOnce(&mut Tape<S>) -> R) -> Option<R> {
    RECORDING.with_borrow_mut(|tape| tape.as_mut()?.downcast_mut::<Tape<S>>().map(f))
}

impl<S: Real> Tape<S> {
    /// For series of `width` coefficients.
    pub fn new(width: usize) -> Self {
        let share = |n: usize| S::of(1.0) / S::of(n.max(1) as f64);
        Tape {
            entries: Vec::new(),
            coefficients: Vec::new(),
            width: width.max(1),
            unit: None,
            shares: (0..width.max(1)).map(share).collect(),
            known: 0,
            arguments: 0,
            results: Vec::new(),
            parts: Vec::new(),
        }
    }

    /// Evaluates `law` on series with these first coefficients.
    pub fn record<R: IntoIterator<Item = Series<S>>>(
        &mut self,
        arguments: &[S],
        law: impl FnOnce(&[Series<S>]) -> R,
    ) {
        let width = self.width;
        let mut tape = core::mem::replace(self, Tape::new(width));
        tape.clear();
        tape.arguments = arguments.len();
        let given: Vec<_> =
            arguments.iter().map(|c| tape.enter(Operation::Given, *c, usize::MAX, false)).collect();
        let before = RECORDING.replace(Some(Box::new(tape)));
        let results = law(&given).into_iter().collect();
        let recorded = RECORDING.replace(before).and_then(|tape| tape.downcast::<Tape<S>>().ok());
        if let Some(tape) = recorded {
            *self = *tape;
        }
        self.results = results;
    }

    fn clear(&mut self) {
        self.entries.clear();
        self.coefficients.clear();
        self.parts.clear();
        (self.unit, self.known) = (None, 1);
    }

    /// The variable of the series counts `unit` seconds, a power of two. Works out what depends on the time alone; comes before
    /// the first [`push`](Self::push), which else takes a second.
    pub fn count_in(&mut self, unit: f64) {
        self.unit = Some(unit);
        // sine and cosine of an angle need each other's lower coefficients
        for n in 1..self.width {
            for k in 0..self.entries.len() {
                let Entry { operation, degree, of_time } = self.entries[k];
                if of_time && n <= degree {
                    let coefficient = match operation {
                        Operation::Line(slope) => S::of(slope * unit),
                        _ => self.next(k, n),
                    };
                    self.coefficients[k * self.width + n] = coefficient;
                }
            }
        }
    }

    /// Takes the next coefficient of each argument, and works out that of everything made of them. Those beyond the width are
    /// dropped.
    pub fn push(&mut self, arguments: &[S]) {
        let n = self.known;
        if n >= self.width {
            return;
        }
        if self.unit.is_none() {
            self.count_in(1.0);
        }
        self.known += 1;
        for (k, c) in arguments.iter().enumerate().take(self.arguments) {
            self.coefficients[k * self.width + n] = *c;
        }
        for k in self.arguments..self.entries.len() {
            if !self.entries[k].of_time {
                self.coefficients[k * self.width + n] = self.next(k, n);
            }
        }
    }

    /// The coefficient `power` of the result `index`: 0 where it is not known yet.
    #[must_use]
    pub fn result(&self, index: usize, power: usize) -> S {
        let Some(Series(term)) = self.results.get(index) else { return S::of(0.0) };
        self.coefficient(*term, power)
    }

    /// Ends a part of the law that is being recorded.
    pub(crate) fn end_part() {
        on_tape(|tape: &mut Tape<S>| tape.parts.push(tape.entries.len()));
    }

    /// The first part in which a coefficient of this power is not finite although those of all arguments are.
    pub(crate) fn culprit(&self, power: usize) -> Option<usize> {
        let finite = |k: usize| self.coefficients[k * self.width + power].magnitude().is_finite();
        if power >= self.width || !(0..self.arguments).all(finite) {
            return None;
        }
        let first = (self.arguments..self.entries.len()).find(|k| !finite(*k))?;
        let part = self.parts.partition_point(|end| *end <= first);
        (part < self.parts.len()).then_some(part)
    }

    fn enter(&mut self, operation: Operation<S>, first: S, degree: usize, of_time: bool) -> Series<S> {
        let index = self.entries.len();
        self.entries.push(Entry { operation, degree, of_time });
        self.coefficients.resize((index + 1) * self.width, S::of(0.0));
        self.coefficients[index * self.width] = first;
        Series(Term::Entry(index as u32))
    }

    /// Enters an operation on terms that are on the tape already.
    fn operate(&mut self, operation: Operation<S>, first: S) -> Series<S> {
        let degree = |terms: [Term<S>; 2]| terms.map(|term| self.degree(term));
        let (degree, terms) = match operation {
            Operation::Sum(a, b) | Operation::Difference(a, b) => {
                let [p, q] = degree([a, b]);
                (p.max(q), [a, b])
            }
            Operation::Product(a, b) => {
                let [p, q] = degree([a, b]);
                (p.saturating_add(q), [a, b])
            }
            Operation::Quotient(a, b) => {
                let [p, q] = degree([a, b]);
                (if q == 0 { p } else { usize::MAX }, [a, b])
            }
            Operation::Negative(a) | Operation::Slope(a) => {
                (self.degree(Term::Entry(a)), [Term::Entry(a); 2])
            }
            Operation::Root(a) | Operation::Sine(a, _) | Operation::Cosine(a, _) => {
                (usize::MAX, [Term::Entry(a); 2])
            }
            Operation::Given | Operation::Line(_) | Operation::Integral(_) => {
                (usize::MAX, [Term::Number(first); 2])
            }
        };
        let of_time = terms.iter().all(|term| match term {
            Term::Number(_) => true,
            Term::Entry(k) => self.entries.get(*k as usize).is_some_and(|entry| entry.of_time),
        });
        self.enter(operation, first, degree, of_time)
    }

    fn degree(&self, term: Term<S>) -> usize {
        match term {
            Term::Number(_) => 0,
            Term::Entry(k) => self.entries.get(k as usize).map_or(0, |entry| entry.degree),
        }
    }

    #[inline]
    fn coefficient(&self, term: Term<S>, n: usize) -> S {
        match term {
            Term::Number(c) if n == 0 => c,
            Term::Entry(k) if n < self.width => {
                self.coefficients.get(k as usize * self.width + n).copied().unwrap_or(S::of(f64::NAN))
            }
            _ => S::of(0.0),
        }
    }

    /// `Σ a_k b_{n−k}`, k in `from..=n`, over coefficients that may differ from 0.
    #[inline]
    fn convolution(&self, a: u32, b: u32, from: usize, n: usize) -> S {
        let (a, b) = (a as usize, b as usize);
        let low = from.max(n.saturating_sub(self.entries[b].degree));
        let high = n.min(self.entries[a].degree);
        if low > high {
            return S::of(0.0);
        }
        let (a, b) = (a * self.width, b * self.width + n);
        let ascending = &self.coefficients[a + low..=a + high];
        let descending = &self.coefficients[b - high..=b - low];
        ascending.iter().zip(descending.iter().rev()).fold(S::of(0.0), |sum, (a, b)| sum + *a * *b)
    }

    /// The coefficient `n` of the entry `k`, above 0, from those of lower entries and its own below.
    fn next(&self, k: usize, n: usize) -> S {
        let entry = |k: u32, n: usize| self.coefficients[k as usize * self.width + n];
        match self.entries[k].operation {
            Operation::Given | Operation::Line(_) => S::of(0.0),
            Operation::Integral(a) => {
                self.coefficient(a, n - 1) * S::of(self.unit.unwrap_or(1.0)) * self.shares[n]
            }
            Operation::Sum(a, b) => self.coefficient(a, n) + self.coefficient(b, n),
            Operation::Difference(a, b) => self.coefficient(a, n) - self.coefficient(b, n),
            Operation::Negative(a) => -entry(a, n),
            Operation::Product(Term::Entry(a), Term::Entry(b)) => self.convolution(a, b, 0, n),
            Operation::Product(a, Term::Number(b)) => self.coefficient(a, n) * b,
            Operation::Product(Term::Number(a), b) => a * self.coefficient(b, n),
            Operation::Quotient(a, Term::Number(b)) => self.coefficient(a, n) / b,
            // q_n = (a_n − Σ b_k q_{n−k})/b₀, 0 < k ≤ n
            Operation::Quotient(a, Term::Entry(b)) => {
                (self.coefficient(a, n) - self.convolution(b, k as u32, 1, n)) / entry(b, 0)
            }
            // 2 r₀ r_n = a_n − Σ r_k r_{n−k}, 0 < k < n: of this power the root holds a zero yet
            Operation::Root(a) => {
                let (a, first) = (entry(a, n), entry(k as u32, 0));
                if first.magnitude() == 0.0 && a.magnitude() == 0.0 {
                    return a;
                }
                (a - self.convolution(k as u32, k as u32, 1, n)) / (first + first)
            }
            Operation::Slope(a) => entry(a, n) * S::of(n as f64),
            // n s_n = Σ k a_k c_{n−k} and n c_n = −Σ k a_k s_{n−k}, 0 < k ≤ n
            Operation::Sine(slope, cosine) => self.convolution(slope, cosine, 1, n) * self.shares[n],
            Operation::Cosine(slope, sine) => -(self.convolution(slope, sine, 1, n) * self.shares[n]),
        }
    }
}

impl<S: Real> Series<S> {
    /// The series of a number.
    pub fn number(c: S) -> Self {
        Series(Term::Number(c))
    }

    /// The operation `operation` on entries with `first` of the first coefficients.
    fn operated(operation: impl FnOnce() -> Operation<S>, first: impl FnOnce(&Tape<S>) -> S) -> Self {
        let entered = on_tape(|tape| {
            let first = first(tape);
            tape.operate(operation(), first)
        });
        entered.unwrap_or(Series::number(S::of(f64::NAN)))
    }

    fn binary(self, b: Self, operation: fn(Term<S>, Term<S>) -> Operation<S>, f: impl Fn(S, S) -> S) -> Self {
        match (self.0, b.0) {
            (Term::Number(a), Term::Number(b)) => Series::number(f(a, b)),
            (a, b) => {
                Series::operated(|| operation(a, b), |tape| f(tape.coefficient(a, 0), tape.coefficient(b, 0)))
            }
        }
    }

    fn unary(self, operation: fn(u32) -> Operation<S>, f: impl Fn(S) -> S) -> Self {
        match self.0 {
            Term::Number(a) => Series::number(f(a)),
            Term::Entry(a) => Series::operated(|| operation(a), |tape| f(tape.coefficient(self.0, 0))),
        }
    }
}

impl<S: Real> Add for Series<S> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        self.binary(b, Operation::Sum, |a, b| a + b)
    }
}

impl<S: Real> Sub for Series<S> {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self.binary(b, Operation::Difference, |a, b| a - b)
    }
}

impl<S: Real> Neg for Series<S> {
    type Output = Self;
    fn neg(self) -> Self {
        self.unary(Operation::Negative, |a| -a)
    }
}

impl<S: Real> Mul for Series<S> {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        self.binary(b, Operation::Product, |a, b| a * b)
    }
}

impl<S: Real> Div for Series<S> {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        self.binary(b, Operation::Quotient, |a, b| a / b)
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
        let entered = on_tape(|tape| tape.enter(Operation::Line(slope), S::from_dd(value), 1, true));
        entered.unwrap_or(Series::number(S::of(f64::NAN)))
    }

    fn solution<const N: usize>(
        x: [Self; N],
        rates: impl FnOnce([Self; N]) -> [Self; N],
    ) -> Option<[Self; N]> {
        let enter = |tape: &mut Tape<S>, Series(x): Series<S>| {
            let first = tape.coefficient(x, 0);
            // the rates may depend on arguments, too
            tape.enter(Operation::Integral(Term::Number(S::of(0.0))), first, usize::MAX, false)
        };
        let solution = on_tape(|tape: &mut Tape<S>| x.map(|x| enter(tape, x)))?;
        let rates = rates(solution);
        on_tape(|tape: &mut Tape<S>| {
            for (Series(x), Series(rate)) in solution.into_iter().zip(rates) {
                if let Term::Entry(k) = x
                    && let Some(entry) = tape.entries.get_mut(k as usize)
                {
                    entry.operation = Operation::Integral(rate);
                }
            }
        })?;
        Some(solution)
    }

    fn sqrt(self) -> Self {
        self.unary(Operation::Root, S::sqrt)
    }

    fn sin_cos(self) -> (Self, Self) {
        match self.0 {
            Term::Number(a) => {
                let (sin, cos) = a.sin_cos();
                (Series::number(sin), Series::number(cos))
            }
            Term::Entry(a) => {
                let entered = on_tape(|tape: &mut Tape<S>| {
                    let (sin, cos) = tape.coefficient(self.0, 0).sin_cos();
                    // the slope, and after it both functions, each by the other
                    let slope = tape.entries.len() as u32;
                    let _ = tape.operate(Operation::Slope(a), S::of(0.0));
                    (
                        tape.operate(Operation::Sine(slope, slope + 2), sin),
                        tape.operate(Operation::Cosine(slope, slope + 1), cos),
                    )
                });
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
            Term::Entry(_) => {
                on_tape(|tape: &mut Tape<S>| tape.coefficient(self.0, 0).magnitude()).unwrap_or(f64::NAN)
            }
        }
    }
}
