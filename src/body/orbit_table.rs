//! Orbits on a table of places: a polynomial through the neighbouring rows.

use core::sync::atomic::{AtomicU64, Ordering};

use super::ForceError;
use super::force::finite;
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

const NAME: &str = "orbit";

/// Rows that a place is worked out from, half of them on either side.
const ROWS: usize = 8;

/// Rows of the estimate beside it.
const FEWER: usize = 6;

/// Two rows are a gap where the places by both differ between them by this share of the distance.
const GAP: f64 = 1e-3;

/// How many tables there have been.
static TABLES: AtomicU64 = AtomicU64::new(0);

/// Times and places of an orbit, with how far places between them are off.
#[derive(Debug)]
pub(super) struct Table {
    /// No other table has or had it, as an address could.
    number: u64,
    gm: f64,
    times: Vec<f64>,
    places: Vec<Vec3<f64>>,
    error: f64,
}

/// No two of them are compared row by row.
impl PartialEq for Table {
    fn eq(&self, other: &Table) -> bool {
        self.number == other.number
    }
}

impl Table {
    pub(super) fn new(gm: f64, times: &[f64], places: &[[f64; 3]]) -> Result<Self, ForceError> {
        let gm = finite(NAME, "the gravitational parameter", gm)?;
        if gm <= 0.0 {
            let quantity = "the gravitational parameter";
            return Err(ForceError::NotPositive { force: NAME, quantity, value: gm });
        }
        if times.len() != places.len() || times.len() < ROWS {
            return Err(ForceError::Rows { times: times.len(), places: places.len(), needed: ROWS });
        }
        for time in times {
            finite(NAME, "a time", *time)?;
        }
        if let Some(pair) = times.windows(2).find(|pair| pair[0] >= pair[1]) {
            return Err(ForceError::NotAscending { before: pair[0], after: pair[1] });
        }
        let places: Vec<Vec3<f64>> = places.iter().map(|place| Vec3(*place)).collect();
        for place in &places {
            let distance = finite(NAME, "a distance", place.norm())?;
            if !(gm / distance / distance / distance).is_normal() {
                return Err(ForceError::NotPositive { force: NAME, quantity: "a distance", value: distance });
            }
        }
        let number = TABLES.fetch_add(1, Ordering::Relaxed);
        let mut table = Table { number, gm, times: times.to_vec(), places, error: 0.0 };
        for k in 0..times.len() - 1 {
            let middle = 0.5 * (times[k] + times[k + 1]);
            let since = |node: f64| middle - node;
            let (place, beside) =
                (table.through::<f64, ROWS>(k, since), table.through::<f64, FEWER>(k, since));
            let error = (place - beside).norm() / place.norm();
            // NaN included
            if error.partial_cmp(&GAP).is_none_or(|order| order.is_gt()) {
                return Err(ForceError::Gap { from: times[k], to: times[k + 1], error });
            }
            table.error = table.error.max(error);
        }
        Ok(table)
    }

    pub(super) fn span(&self) -> [f64; 2] {
        [self.times[0], self.times[self.times.len() - 1]]
    }

    pub(super) fn number(&self) -> u64 {
        self.number
    }

    pub(super) fn error(&self) -> f64 {
        self.error
    }

    /// 3 GM/r³ and r̂; not a number outside of the table.
    pub(super) fn at<S: Real>(&self, now: Dd) -> (S, Vec3<S>) {
        let [first, last] = self.span();
        if !(first..=last).contains(&now.hi()) {
            return (S::of(f64::NAN), Vec3([S::of(f64::NAN); 3]));
        }
        let after = self.times.partition_point(|time| *time <= now.hi());
        let k = after.clamp(1, self.times.len() - 1) - 1;
        let place = self.through::<S, ROWS>(k, |node| S::linear(now - Dd::of(node), 1.0));
        let near = S::of(1.0) / place.norm();
        (S::of(3.0 * self.gm) * (near * near * near), place * near)
    }

    /// By the polynomial through the `N` rows about those from `k` to `k + 1`; `since` is the time from a row's.
    fn through<S: Real, const N: usize>(&self, k: usize, since: impl Fn(f64) -> S) -> Vec3<S> {
        let first = (k + 1).saturating_sub(N / 2).min(self.times.len() - N);
        let times = &self.times[first..first + N];
        let whole = times[N - 1] - times[0];
        let shares: [S; N] = core::array::from_fn(|j| since(times[j]) * S::of(1.0 / whole));
        let mut place = Vec3([S::of(0.0); 3]);
        for j in 0..N {
            let others = (0..N).filter(|i| *i != j);
            let (mut weight, mut divisor) = (S::of(1.0), 1.0);
            for i in others {
                weight = weight * shares[i];
                divisor *= (times[j] - times[i]) / whole;
            }
            weight = weight * S::of(1.0 / divisor);
            place = place + Vec3(self.places[first + j].0.map(S::of)) * weight;
        }
        place
    }
}
