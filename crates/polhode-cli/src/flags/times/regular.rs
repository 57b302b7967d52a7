//! Times at a regular distance.

/// Up to this many rows the product of a row's number and their distance is rounded once.
const MOST_ROWS: f64 = 9_007_199_254_740_992.0; // 2^53

/// Rows that a command keeps in memory: more are rather a slip of the pen than a wish.
const MOST_KEPT: usize = 2_000_000;

/// The times `start`, `start + every`, … up to the end.
#[derive(Clone, Debug)]
pub(crate) struct Regular {
    start: f64,
    every: f64,
    /// Number of the last, and its time where that is the end as typed.
    last: u64,
    end: Option<f64>,
    next: u64,
}

/// The times `start`, `start + every`, … up to `until`.
///
/// `until` itself is among them, as typed, when it lies within 4 ulp of a multiple.
///
/// # Errors
/// `every` zero or pointing away from `until`, and more rows than can be counted.
pub(crate) fn regular(start: f64, until: f64, every: f64) -> Result<Regular, String> {
    let span = until - start;
    if every == 0.0 {
        return Err("--every: '0': rows need time between them; give a DT that is not zero".into());
    }
    if span != 0.0 && span.signum() != every.signum() {
        return Err(format!(
            "--every: '{every:?}': steps away from --until {until:?} (start time {start:?}); change its sign"
        ));
    }
    let rows = span / every;
    if rows.is_nan() || rows >= MOST_ROWS {
        return Err(format!(
            "--every: '{every:?}': {rows:.0e} rows up to --until {until:?}, and at most 2^53 can be counted; give a larger DT"
        ));
    }
    let ulp = f64::EPSILON * until.abs().max(start.abs()).max(every.abs());
    let nearest = rows.round();
    let exact = (start + nearest * every - until).abs() <= 4.0 * ulp;
    let last = if exact { nearest } else { rows.floor() } as u64;
    Ok(Regular { start, every, last, end: exact.then_some(until), next: 0 })
}

impl Regular {
    /// How many are left.
    pub(crate) fn len(&self) -> usize {
        usize::try_from(self.last + 1 - self.next).unwrap_or(usize::MAX)
    }

    /// Time number `n`, from 0.
    pub(super) fn at(&self, n: usize) -> f64 {
        let n = n as u64;
        self.end.filter(|_| n == self.last).unwrap_or(self.start + n as f64 * self.every)
    }

    /// All of them, for a command that keeps its rows in memory.
    ///
    /// # Errors
    /// More than two million.
    pub(crate) fn kept(self) -> Result<Vec<f64>, String> {
        let rows = self.len();
        if rows > MOST_KEPT {
            return Err(format!(
                "--every: '{:?}': {rows} rows, and at most {MOST_KEPT} are kept in memory here; give a larger DT",
                self.every
            ));
        }
        Ok(self.collect())
    }
}

impl Iterator for Regular {
    type Item = f64;
    fn next(&mut self) -> Option<f64> {
        let n = self.next;
        (n <= self.last).then(|| {
            self.next += 1;
            self.at(n as usize)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regular_times_end_at_the_typed_end() {
        let regular = |a, b, c| regular(a, b, c).map(Iterator::collect::<Vec<_>>);
        assert_eq!(regular(0.0, 0.3, 0.1), Ok(vec![0.0, 0.1, 0.2, 0.3]));
        assert_eq!(regular(0.0, 1.0, 0.4), Ok(vec![0.0, 0.4, 0.8]));
        assert_eq!(regular(5.0, 3.0, -1.0), Ok(vec![5.0, 4.0, 3.0]));
        assert_eq!(regular(2.0, 2.0, 1.0), Ok(vec![2.0]));
        assert_eq!(regular(0.0, 1e4, 1e-2).map(|t| t.len()), Ok(1_000_001));
    }

    #[test]
    fn regular_times_refuse_what_never_arrives() {
        let message = |a, b, c| regular(a, b, c).err().unwrap();
        assert!(message(0.0, 1.0, 0.0).contains("rows need time between them"));
        assert!(message(0.0, 1.0, -0.1).contains("change its sign"));
        assert!(message(0.0, 1e-200, -1e-200).contains("change its sign"));
        assert!(message(0.0, 1.0, 1e-300).contains("1e300 rows"));
        assert!(message(-f64::MAX, f64::MAX, 1.0).contains("inf rows"));
        let many = regular(0.0, 1e9, 1.0).unwrap();
        assert_eq!((many.len(), many.at(1_000_000_000)), (1_000_000_001, 1e9));
        assert!(many.kept().unwrap_err().contains("1000000001 rows, and at most 2000000"));
    }
}
