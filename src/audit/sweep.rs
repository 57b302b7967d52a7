//! Every row of a record beside the exact motion, one after the other.

use core::cell::Cell;

use super::columns::{Columns, Source};
use super::motion::{follow, way};
use super::program::Dynamics;
use super::start::Start;
use super::{Reading, Trajectory};
use crate::rotation::{Quat, Vec3};

/// Rows and the way, rad, up to which a motion without closed form is followed in double-double.
const FEW: usize = 2000;
const FAR: f64 = 1e4;

/// One row as it was written and as it should be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub(super) row: usize,
    pub(super) time: f64,
    /// Body → space, of the record; `None` where it has none.
    pub(super) attitude: Option<Quat<f64>>,
    /// Body axes, rad/s, of the record; `None` where it has none.
    pub(super) omega: Option<Vec3<f64>>,
    /// Attitude and ω of the motion.
    pub(super) exact: (Quat<f64>, Vec3<f64>),
    /// From the motion to the record, in space, rad.
    pub(super) turn: Option<Vec3<f64>>,
    /// ω of the record without that of the motion, relative to the size of ω.
    pub(super) rates: Option<Vec3<f64>>,
    /// The same of momenta that stand beside rates, relative to the size of the momentum.
    pub(super) momentum: Option<Vec3<f64>>,
}

/// What a record is compared with.
pub(super) struct Sweep<'a> {
    pub(super) record: &'a Trajectory,
    pub(super) reading: &'a Reading,
    pub(super) start: &'a Start,
    /// Root mean square of ω, rad/s.
    pub(super) size: f64,
    /// Momenta of the record over those of the solver frame.
    pub(super) scale: f64,
}

impl Sweep<'_> {
    /// Shows every row to `each`; `None` where the motion cannot be followed.
    pub(super) fn every(&self, each: &mut dyn FnMut(&Seen)) -> Option<()> {
        self.over(&mut (0..self.record.times.len()), each)
    }

    /// Shows the rows `rows`, in ascending order, to `each`; `None` where the motion cannot be followed.
    pub(super) fn over(
        &self,
        rows: &mut dyn Iterator<Item = usize>,
        each: &mut dyn FnMut(&Seen),
    ) -> Option<()> {
        let (record, reading) = (self.record, self.reading);
        let source = Columns::new(record).source;
        let dynamics = Dynamics::new(&self.start.body);
        let beside = record.rates.is_some() && record.momentum.is_some();
        let scale = self.scale;
        let size = dynamics.momentum(self.start.row.omega).norm() * scale.abs();
        let row = Cell::new(0);
        let mut look = |q: Quat<f64>, omega: Vec3<f64>| {
            let row = row.get();
            let attitude = reading.attitude(record, row);
            let measured = match source {
                Source::Rates => reading.omega_body(record, row),
                Source::Momentum => reading.momentum_body(record, row).map(|m| dynamics.omega(m)),
                Source::Attitude => None,
            };
            let momentum = reading.momentum_body(record, row).filter(|_| beside);
            let seen = Seen {
                row,
                time: record.times[row],
                attitude,
                omega: measured,
                exact: (q, omega),
                turn: attitude.map(|found| q.rotate((q.conjugate() * found).logarithm())),
                rates: measured.map(|found| (found - omega) * (1.0 / self.size)),
                momentum: momentum.map(|m| (m - dynamics.momentum(omega) * scale) * (1.0 / size)),
            };
            each(&seen);
        };
        let precise = record.times.len() <= FEW
            && way(&self.start.body, &self.start.row, &record.times).is_some_and(|way| way < FAR);
        // the motion asks for the next time when the row before has been looked at
        let mut times = rows.map(|next| {
            row.set(next);
            record.times[next]
        });
        follow(&self.start.body, &self.start.row, &mut times, precise, &mut look)
    }
}

/// What a column leaves open, per row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Allowance {
    /// Largest deviation that tolerance and digits allow.
    pub(super) exact: f64,
    /// Half a unit of the last digit, as a deviation.
    pub(super) rounding: f64,
    /// Standard deviation of a component that is declared; 0 without.
    pub(super) noise: f64,
}

impl Allowance {
    pub(super) fn of(tolerance: f64, rounding: f64, noise: f64) -> Self {
        Allowance { exact: tolerance.max(1.05 * rounding), rounding, noise }
    }

    /// Largest deviation of any of `rows` rows: that of normal deviates exceeds it once in some thousand records.
    pub(super) fn largest(&self, rows: usize) -> f64 {
        self.exact + self.noise * ((2.0 * libm::log(3.0 * rows as f64)).sqrt() + 1.5)
    }
}

/// Blocks of rows whose mean deviations are compared with what noise leaves of them.
const BLOCKS: usize = 64;

/// Fewest rows of a block.
const FEWEST: usize = 16;

/// The noise of independent rows is at most this many times what the second differences of few of them show.
const SEEN: f64 = 2.0;

/// The mean length of a second difference of vectors of normal deviates over the standard deviation of a component:
/// √6 times that of such a vector, 2 √(2/π).
const SECOND_DIFFERENCE: f64 = 3.908_820_095_223_47;

/// Units of the last digit from row to row beyond which the rounding of neighbours is independent.
const MOVING: f64 = 10.0;

/// Deviations of one column over all rows.
#[derive(Clone, Debug)]
pub(super) struct Tally {
    rows: usize,
    allowance: Allowance,
    pub(super) largest: f64,
    pub(super) at: usize,
    squares: f64,
    count: usize,
    /// What a row may be off at most, and how many rows are off by more.
    largest_allowed: f64,
    beyond: usize,
    blocks: Vec<(Vec3<f64>, usize)>,
    /// The deviations of the two rows before, and the sum of the lengths of second differences.
    before: [Vec3<f64>; 2],
    changes: f64,
    /// The largest mean of a block that is rounding, where rounding changes from row to row.
    lasting: Option<f64>,
}

impl Tally {
    pub(super) fn new(rows: usize, allowance: Allowance) -> Self {
        let blocks = (rows / FEWEST).clamp(1, BLOCKS);
        Tally {
            rows,
            allowance,
            largest: 0.0,
            at: 0,
            squares: 0.0,
            count: 0,
            largest_allowed: allowance.largest(rows),
            beyond: 0,
            blocks: vec![(Vec3::zero(), 0); blocks],
            before: [Vec3::zero(); 2],
            changes: 0.0,
            lasting: None,
        }
    }

    /// The same of a column that moves by `change` from row to row: where that is many units of its last digit, rounding is new in
    /// every row, and what lasts over a block of rows is no rounding.
    pub(super) fn moving(self, change: f64, tolerance: f64) -> Self {
        let rounding = self.allowance.rounding;
        let rows = (self.rows / self.blocks.len().max(1)).max(1) as f64;
        // three standard deviations of the mean of what is uniform, and a quarter for the start that was fitted to rounded rows
        let lasting = tolerance + rounding * (0.25 + 3.0 * 0.58 / rows.sqrt());
        let is_new = rows >= FEWEST as f64 && change > MOVING * rounding && tolerance < rounding;
        Self { lasting: is_new.then_some(lasting), ..self }
    }

    /// Whether the deviation at `row` is beyond the allowance, which counts too.
    pub(super) fn add(&mut self, row: usize, deviation: Vec3<f64>) -> bool {
        let size = deviation.norm();
        let [first, second] = self.before;
        if self.count >= 2 {
            self.changes += (deviation - second * 2.0 + first).norm();
        }
        self.before = [second, deviation];
        self.count += 1;
        self.squares += size * size;
        if size > self.largest || size.is_nan() {
            (self.largest, self.at) = (if size.is_nan() { f64::INFINITY } else { size }, row);
        }
        let beyond = size > self.largest_allowed || size.is_nan();
        self.beyond += usize::from(beyond);
        let blocks = self.blocks.len();
        if let Some((sum, count)) = self.blocks.get_mut(row * blocks / self.rows) {
            *sum = *sum + deviation;
            *count += 1;
        }
        beyond
    }

    /// Root mean square of a component.
    pub(super) fn spread(&self) -> f64 {
        (self.squares / (3 * self.count.max(1)) as f64).sqrt()
    }

    /// Noise of a component, by the second differences of neighbours, which an error that lasts leaves out.
    fn between_neighbours(&self) -> f64 {
        self.changes / self.count.saturating_sub(2).max(1) as f64 / SECOND_DIFFERENCE
    }

    /// How many rows were added.
    pub(super) fn rows_seen(&self) -> usize {
        self.count
    }

    /// Whether every row is within what tolerance and digits allow.
    pub(super) fn is_exact(&self) -> bool {
        let mean = |(sum, count): &(Vec3<f64>, usize)| sum.norm() / (*count).max(1) as f64;
        let lasts = |limit: f64| self.blocks.iter().any(|block| mean(block) > limit);
        self.largest <= self.allowance.exact && !self.lasting.is_some_and(lasts)
    }

    /// Whether the deviations are within the noise that is declared: each of them, their spread, and the means of blocks, in
    /// which an error that lasts adds up and noise does not. Where neighbours differ by less than the declared noise, an error that
    /// lasts hides in no more than that.
    pub(super) fn is_declared_noise(&self) -> bool {
        let Allowance { exact, noise, .. } = self.allowance;
        let fewer = |count: usize| 1.0 / (count.max(1) as f64).sqrt();
        let lasting = noise.min(SEEN * self.between_neighbours());
        let in_blocks = |(sum, count): &(Vec3<f64>, usize)| {
            let mean = sum.norm() * (1.0 / (*count).max(1) as f64);
            // a quarter: what the start that was fitted to some of the rows leaves
            mean <= exact + lasting * (5.0 * fewer(*count) + 0.25)
        };
        noise > 0.0
            && self.beyond == 0
            && self.spread() <= exact + noise * (1.05 + 3.0 * fewer(3 * self.count))
            && self.blocks.iter().all(in_blocks)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_row_of_many_is_seen() {
        for (rows, bad) in [(10, 9), (1000, 0), (100_000, 77_777)] {
            let mut tally = Tally::new(rows, Allowance::of(1e-6, 1e-16, 0.0));
            for row in 0..rows {
                let deviation = if row == bad { 2e-6 } else { 9e-7 };
                assert_eq!(tally.add(row, Vec3([deviation, 0.0, 0.0])), row == bad);
            }
            assert!(!tally.is_exact());
            assert_eq!((tally.beyond, tally.at), (1, bad));
        }
    }

    #[test]
    fn what_lasts_over_a_block_of_a_moving_column_is_no_rounding() {
        // digits of 1e-6, in blocks of 64 rows
        let is_exact = |change: f64, tolerance: f64, of: &dyn Fn(usize) -> f64| {
            let mut tally = Tally::new(4096, Allowance::of(tolerance, 1e-6, 0.0)).moving(change, tolerance);
            (0..4096).for_each(|row| {
                tally.add(row, Vec3([of(row), 0.0, 0.0]));
            });
            tally.is_exact()
        };
        let swing = |row: usize| if row.is_multiple_of(2) { 9e-7 } else { -9e-7 };
        assert!(is_exact(1e-3, 1e-9, &swing));
        for block in [0, 20, 63] {
            let lasts = |row: usize| if row / 64 == block { 9e-7 } else { swing(row) };
            assert!(!is_exact(1e-3, 1e-9, &lasts), "{block}");
            // of a column that hardly moves rounding lasts, and a tolerance above the digits allows it
            assert!(is_exact(1e-6, 1e-9, &lasts) && is_exact(1e-3, 1e-5, &lasts), "{block}");
        }
    }

    #[test]
    fn noise_must_be_declared_and_nothing_else_hides_in_it() {
        // alternating signs of one size have the spread of noise, and a mean of zero
        let tally_of = |noise: f64, of: &dyn Fn(usize) -> f64| {
            let mut tally = Tally::new(4096, Allowance::of(1e-6, 1e-16, noise));
            (0..4096).for_each(|row| {
                tally.add(row, Vec3([1.0, 1.0, -1.0]) * of(row));
            });
            (tally.is_exact(), tally.is_declared_noise())
        };
        let swing = |row: usize| if row.is_multiple_of(2) { 1e-3 } else { -1e-3 };
        assert_eq!(tally_of(0.0, &swing), (false, false));
        assert_eq!(tally_of(1e-3, &swing), (false, true));
        assert_eq!(tally_of(0.9e-3, &swing), (false, false));
        assert_eq!(tally_of(1e-3, &|row| swing(row) + if row > 2000 { 9e-4 } else { 0.0 }), (false, false));
        assert_eq!(tally_of(1e-3, &|row| if row == 5 { 8e-3 } else { swing(row) }), (false, false));
        assert_eq!(tally_of(1e-3, &|_| f64::NAN), (false, false));
        // what is smooth is no noise, however much is declared
        assert_eq!(tally_of(1e-2, &|row| 1e-6 * row as f64), (false, false));
    }
}
