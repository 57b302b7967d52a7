//! The record of a law on power series.

use core::any::Any;
use core::cell::RefCell;

use super::recurrence::{Kind, Operation, Recurrence};
use super::series::Term;
use super::{Real, Series};

/// The operations of a law on power series, with the coefficients that are known of each result.
///
/// The law is evaluated once; where it takes the same operations as at the last [`record`](Tape::record), what was found out
/// about them is kept. Each next coefficient of its arguments then gives the next of its results, by the recurrences of
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
    width: usize,
    arguments: usize,
    /// What the law does, by entry.
    operations: Vec<Operation>,
    /// The first coefficients, by entry.
    firsts: Vec<S>,
    /// Slopes of lines, and numbers that entries are multiplied with or divided by.
    numbers: Vec<S>,
    results: Vec<Term<S>>,
    /// The number of entries at the end of each part of the law.
    parts: Vec<usize>,
    /// How many entries there are by now.
    entered: usize,
    /// Whether the law does something else than before.
    is_new: bool,
    recurrence: Recurrence<S>,
    /// What the variable counts, s, once it has been said.
    unit: Option<f64>,
    /// How many coefficients are known.
    known: usize,
}

thread_local! {
    /// The tape that records.
    static RECORDING: RefCell<Option<Box<dyn Any>>> = const { RefCell::new(None) };
}

/// What `f` makes of the tape that records; `None` if none does.
#[inline]
pub(super) fn on_tape<S: Real, R>(f: impl FnOnce(&mut Tape<S>) -> R) -> Option<R> {
    RECORDING.with_borrow_mut(|tape| tape.as_mut()?.downcast_mut::<Tape<S>>().map(f))
}

impl<S: Real> Tape<S> {
    /// For series of `width` coefficients.
    pub fn new(width: usize) -> Self {
        let width = width.max(1);
        Tape {
            width,
            arguments: 0,
            operations: Vec::new(),
            firsts: Vec::new(),
            numbers: Vec::new(),
            results: Vec::new(),
            parts: Vec::new(),
            entered: 0,
            is_new: true,
            recurrence: Recurrence::new(width),
            unit: None,
            known: 0,
        }
    }

    /// Evaluates `law` on series with these first coefficients.
    pub fn record<R: IntoIterator<Item = Series<S>>>(
        &mut self,
        arguments: &[S],
        law: impl FnOnce(&[Series<S>]) -> R,
    ) {
        let mut tape = core::mem::replace(self, Tape::new(0));
        tape.parts.clear();
        (tape.entered, tape.unit, tape.known) = (0, None, 1);
        tape.is_new |= tape.arguments != arguments.len();
        tape.arguments = arguments.len();
        let given: Vec<_> =
            arguments.iter().map(|c| tape.enter(Kind::Given, [0; 2], *c, S::of(0.0))).collect();
        let before = RECORDING.replace(Some(Box::new(tape)));
        let results = law(&given);
        let recorded = RECORDING.replace(before).and_then(|tape| tape.downcast::<Tape<S>>().ok());
        if let Some(tape) = recorded {
            *self = *tape;
        }
        self.take(results);
    }

    /// Takes the results of a law that has been evaluated.
    fn take(&mut self, results: impl IntoIterator<Item = Series<S>>) {
        let before = core::mem::take(&mut self.results);
        // an entry of another tape is none of this
        let own = |Series(term)| match term {
            Term::Entry(k) if k as usize >= self.entered => Term::Number(S::of(f64::NAN)),
            term => term,
        };
        self.results = results.into_iter().map(own).collect();
        let is_same = !self.is_new
            && self.entered == self.operations.len()
            && before.iter().map(Term::entry).eq(self.results.iter().map(Term::entry));
        if !is_same {
            self.operations.truncate(self.entered);
            self.firsts.truncate(self.entered);
            self.numbers.truncate(self.entered);
            let results = self.entries_of_results();
            self.recurrence.arrange(&self.operations, self.arguments, &results, true);
            self.is_new = false;
        }
        self.recurrence.begin(&self.firsts, &self.numbers);
    }

    /// The variable of the series counts `unit` seconds, a power of two; comes before the first [`push`](Self::push), which else
    /// takes a second.
    pub fn count_in(&mut self, unit: f64) {
        self.unit = Some(unit);
    }

    /// Takes the next coefficient of each argument, and works out that of everything made of them. Those beyond the width are
    /// dropped.
    pub fn push(&mut self, arguments: &[S]) {
        let n = self.known;
        if n < self.width {
            self.known += 1;
            self.recurrence.next(n, arguments, &self.numbers, S::of(self.unit.unwrap_or(1.0)));
        }
    }

    /// The coefficient `power` of the result `index`: 0 where it is not known yet.
    #[must_use]
    pub fn result(&self, index: usize, power: usize) -> S {
        match self.results.get(index) {
            Some(Term::Number(c)) if power == 0 => *c,
            Some(Term::Entry(k)) if power < self.known => {
                self.recurrence.coefficient(*k, power).unwrap_or(S::of(0.0))
            }
            _ => S::of(0.0),
        }
    }

    /// Ends a part of the law that is being recorded.
    pub(crate) fn end_part() {
        on_tape(|tape: &mut Tape<S>| tape.parts.push(tape.entered));
    }

    /// The first part in which a coefficient of this power is not finite although those of all arguments are.
    pub(crate) fn culprit(&self, power: usize) -> Option<usize> {
        let (mut each, width) = (Recurrence::new(self.width), self.arguments);
        each.arrange(&self.operations, width, &self.entries_of_results(), false);
        each.begin(&self.firsts, &self.numbers);
        for n in 1..self.known.min(power + 1) {
            let coefficient = |k| self.recurrence.coefficient(k, n).unwrap_or(S::of(f64::NAN));
            let arguments: Vec<S> = (0..width as u32).map(coefficient).collect();
            each.next(n, &arguments, &self.numbers, S::of(self.unit.unwrap_or(1.0)));
        }
        let first = each.not_finite().filter(|first| *first >= width)?;
        let part = self.parts.partition_point(|end| *end <= first);
        (part < self.parts.len()).then_some(part)
    }

    fn entries_of_results(&self) -> Vec<u32> {
        self.results.iter().filter_map(Term::entry).collect()
    }

    /// The first coefficient of an entry; not a number where there is none.
    #[inline]
    pub(super) fn first(&self, k: u32) -> S {
        if (k as usize) < self.entered { self.firsts[k as usize] } else { S::of(f64::NAN) }
    }

    #[inline]
    pub(super) fn enter(&mut self, kind: Kind, terms: [u32; 2], first: S, number: S) -> Series<S> {
        let (k, operation) = (self.entered, Operation { kind, terms });
        self.entered += 1;
        if let Some(known) = self.operations.get_mut(k) {
            self.is_new |= *known != operation;
            (*known, self.firsts[k], self.numbers[k]) = (operation, first, number);
        } else {
            self.is_new = true;
            self.operations.push(operation);
            self.firsts.push(first);
            self.numbers.push(number);
        }
        Series(Term::Entry(k as u32))
    }

    /// Enters an operation on entries.
    #[inline]
    pub(super) fn operate(&mut self, kind: Kind, terms: [u32; 2], f: impl FnOnce([S; 2]) -> S) -> Series<S> {
        if terms.iter().any(|k| *k as usize >= self.entered) {
            return Series::number(S::of(f64::NAN));
        }
        let first = f(terms.map(|k| self.first(k)));
        self.enter(kind, terms, first, S::of(0.0))
    }

    /// Enters an operation on an entry and a number.
    #[inline]
    pub(super) fn operate_with(
        &mut self,
        kind: Kind,
        k: u32,
        number: S,
        f: impl FnOnce(S) -> S,
    ) -> Series<S> {
        let Term::Entry(entry) = self.operate(kind, [k; 2], |[a, _]| f(a)).0 else {
            return Series::number(S::of(f64::NAN));
        };
        self.numbers[entry as usize] = number;
        Series(Term::Entry(entry))
    }

    /// Enters both functions of an angle, each by the other.
    pub(super) fn enter_sine_and_cosine(&mut self, angle: u32) -> (Series<S>, Series<S>) {
        let (sin, cos) = self.first(angle).sin_cos();
        let known = self.operations.get(..self.entered).and_then(|all| all.get(angle as usize));
        let of_line = known.is_some_and(|angle| angle.kind == Kind::Line);
        let (sine, cosine, by) = if of_line {
            (Kind::LineSine, Kind::LineCosine, angle)
        } else {
            match self.operate(Kind::Slope, [angle; 2], |_| S::of(0.0)).0 {
                Term::Entry(slope) => (Kind::Sine, Kind::Cosine, slope),
                Term::Number(none) => return (Series::number(none), Series::number(none)),
            }
        };
        let this = self.entered as u32;
        let zero = S::of(0.0);
        (self.enter(sine, [by, this + 1], sin, zero), self.enter(cosine, [by, this], cos, zero))
    }

    /// Enters what starts at `x`, with a rate that is not known yet.
    pub(super) fn enter_integral(&mut self, Series(x): Series<S>) -> Series<S> {
        let first = match x {
            Term::Number(c) => c,
            Term::Entry(k) => self.first(k),
        };
        let known = self.operations.get(self.entered).copied();
        let known = known.filter(|known| matches!(known.kind, Kind::Integral | Kind::Line));
        let Operation { kind, terms } = known.unwrap_or(Operation { kind: Kind::Line, terms: [0; 2] });
        self.enter(kind, terms, first, S::of(0.0))
    }

    /// Sets the rate of what has been entered without.
    pub(super) fn set_rate(&mut self, Series(x): Series<S>, Series(rate): Series<S>) {
        let Term::Entry(x) = x else { return };
        let own = |k: u32| (k as usize) < self.entered;
        let (operation, slope) = match rate {
            Term::Entry(rate) if own(rate) => {
                (Operation { kind: Kind::Integral, terms: [rate; 2] }, S::of(0.0))
            }
            Term::Entry(_) => (Operation { kind: Kind::Line, terms: [0; 2] }, S::of(f64::NAN)),
            Term::Number(slope) => (Operation { kind: Kind::Line, terms: [0; 2] }, slope),
        };
        if let Some(known) = self.operations.get_mut(x as usize).filter(|_| own(x)) {
            self.is_new |= *known != operation;
            (*known, self.numbers[x as usize]) = (operation, slope);
        }
    }
}
