//! How a number is spread over the members.

use super::Rows;
use crate::body::Conserved;
use crate::num::Compensated;

/// The distribution of a number over members: the largest, the root mean square, quantiles.
///
/// Sums are taken in the order of the values, so that the same members give the same bits however they were divided.
///
/// ```
/// use polhode::run::Spread;
/// let spread = Spread::of([3.0, 1.0, 2.0, 4.0]).ok_or("values")?;
/// assert_eq!((spread.largest(), spread.quantile(0.5)), (4.0, 2.5));
/// assert_eq!(spread.root_mean_square(), 7.5_f64.sqrt());
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Debug)]
#[must_use]
pub struct Spread {
    ascending: Vec<f64>,
    mean_square: f64,
}

impl Spread {
    /// Of `values`, in the order of the members; `None` where there is none, or one is not finite.
    #[must_use]
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut ascending: Vec<f64> = values.into_iter().collect();
        if ascending.is_empty() || ascending.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let mut sum = Compensated::new(0.0);
        for x in &ascending {
            sum.add(x * x);
        }
        let mean_square = sum.value() / ascending.len() as f64;
        ascending.sort_by(f64::total_cmp);
        Some(Spread { ascending, mean_square })
    }

    /// How many values there are.
    #[must_use]
    pub fn members(&self) -> usize {
        self.ascending.len()
    }

    /// The largest value.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.ascending.last().copied().unwrap_or(0.0)
    }

    /// √⟨x²⟩.
    #[must_use]
    pub fn root_mean_square(&self) -> f64 {
        self.mean_square.sqrt()
    }

    /// The value below which the share `share`, from 0 to 1, of the others lies, linear between neighbours (R. J. Hyndman and
    /// Y. Fan, Am. Stat. 50 (1996) 361, definition 7).
    #[must_use]
    pub fn quantile(&self, share: f64) -> f64 {
        let place = share.clamp(0.0, 1.0) * (self.ascending.len() - 1) as f64;
        let (below, part) = (place.floor(), place - place.floor());
        let low = self.ascending[below as usize];
        let high = self.ascending[(below as usize + 1).min(self.ascending.len() - 1)];
        low + part * (high - low)
    }
}

/// Errors of all members, time by time, collected from [`Rows`] in their order. Members that have failed are left out.
///
/// It holds 8 bytes for each member, time and quantity.
#[derive(Clone, Debug, Default)]
#[must_use]
pub struct Tally {
    /// For each time, of each quantity of [`QUANTITIES`] and of the attitude.
    times: Vec<[Vec<f64>; 6]>,
}

const QUANTITIES: [Conserved; 5] = [
    Conserved::Energy,
    Conserved::MomentumNorm,
    Conserved::Momentum,
    Conserved::MomentumZ,
    Conserved::Jacobi { rate: 0.0 },
];

impl Tally {
    /// Of no rows.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes in the rows of the next members.
    pub fn add(&mut self, rows: &Rows) {
        self.times.resize(self.times.len().max(rows.times()), Default::default());
        for (time, [quantities @ .., attitude]) in self.times.iter_mut().enumerate().take(rows.times()) {
            for errors in rows.errors(time).unwrap_or_default() {
                for (values, quantity) in quantities.iter_mut().zip(QUANTITIES) {
                    values.extend(errors.of(quantity));
                }
            }
            let angles = rows.attitude_errors(time).unwrap_or_default();
            attitude.extend(angles.iter().filter(|angle| angle.is_finite()));
        }
    }

    /// Relative errors of `quantity` at the `time`-th time; `None` where none was observed.
    #[must_use]
    pub fn errors(&self, time: usize, quantity: Conserved) -> Option<Spread> {
        let same = |other: &Conserved| core::mem::discriminant(other) == core::mem::discriminant(&quantity);
        let place = QUANTITIES.iter().position(same)?;
        Spread::of(self.times.get(time)?[place].iter().copied())
    }

    /// Angles to the exact attitude, rad, at the `time`-th time; `None` where none was observed.
    #[must_use]
    pub fn attitude_errors(&self, time: usize) -> Option<Spread> {
        Spread::of(self.times.get(time)?[5].iter().copied())
    }
}
