//! At which steps a run is looked at.

/// Ascending numbers of steps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Schedule(Vec<u64>);

impl Schedule {
    /// Every `interval` steps up to `total`, and at `total`.
    pub fn every(interval: u64, total: u64) -> Self {
        let mut steps: Vec<u64> = (1..=total / interval.max(1)).map(|k| k * interval.max(1)).collect();
        if steps.last() != Some(&total) {
            steps.push(total);
        }
        Schedule(steps)
    }

    /// `per_decade` points in each decade of steps from 1 to `total`, and `total` itself.
    ///
    /// ```
    /// use polhode::run::Schedule;
    /// let steps: Vec<u64> = Schedule::logarithmic(1000, 3).into_iter().collect();
    /// assert_eq!(steps, [1, 2, 5, 10, 22, 46, 100, 215, 464, 1000]);
    /// ```
    pub fn logarithmic(total: u64, per_decade: u32) -> Self {
        let mut steps = Vec::new();
        for k in 0.. {
            let step = libm::round(libm::pow(10.0, f64::from(k) / f64::from(per_decade.max(1))));
            if step >= total as f64 {
                break;
            }
            steps.push(step as u64);
        }
        steps.push(total);
        steps.dedup();
        Schedule(steps)
    }

    /// At these numbers of steps, sorted.
    pub fn at(mut steps: Vec<u64>) -> Self {
        steps.sort_unstable();
        Schedule(steps)
    }
}

impl IntoIterator for Schedule {
    type Item = u64;
    type IntoIter = std::vec::IntoIter<u64>;
    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}
