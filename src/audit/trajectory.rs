//! A trajectory from elsewhere: numbers in columns, whose meaning is to be told.

use super::AuditError;

/// Fewest rows that a verdict needs: nine intervals, against which the six numbers of a start can be checked.
pub const FEWEST_ROWS: usize = 10;

/// A record of a rotating body: times, and attitudes, angular velocities or angular momenta in conventions that need not be
/// known.
///
/// ```
/// use polhode::audit::{Attitudes, Trajectory};
/// let times: Vec<f64> = (0..20).map(|k| 0.1 * f64::from(k)).collect();
/// let still = Trajectory::new(times).with_attitude(Attitudes::Quaternions(vec![[1.0, 0.0, 0.0, 0.0]; 20]));
/// assert!(still.check().is_ok());
/// assert!(still.with_rates(vec![[0.0; 3]; 19]).check().is_err()); // one row short
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Trajectory {
    /// Times, s, ascending.
    pub times: Vec<f64>,
    /// Attitudes, where the record has them.
    pub attitude: Option<Attitudes>,
    /// Components of the angular velocity, in an unknown frame and unit.
    pub rates: Option<Vec<[f64; 3]>>,
    /// Components of the angular momentum, in an unknown frame.
    pub momentum: Option<Vec<[f64; 3]>>,
    /// Significant decimal digits of the numbers, where it is known how they were written.
    pub digits: Digits,
}

/// Significant decimal digits of each column, where it is known how its numbers were written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Digits {
    /// Of the attitude.
    pub attitude: Option<u32>,
    /// Of the angular velocity.
    pub rates: Option<u32>,
    /// Of the angular momentum.
    pub momentum: Option<u32>,
}

/// Attitudes as the columns have them.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Attitudes {
    /// Quaternions, scalar first or last.
    Quaternions(Vec<[f64; 4]>),
    /// Rotation matrices, row by row: r11, r12, r13, r21, …
    Matrices(Vec<[f64; 9]>),
    /// Three Euler angles in the order of their columns.
    Angles(Vec<[f64; 3]>),
    /// Modified Rodrigues parameters, the axis times tan(φ/4).
    Rodrigues(Vec<[f64; 3]>),
}

impl Attitudes {
    /// What they are written as: `quaternion`, `rotation matrix`, `Euler angles` or `modified Rodrigues parameters`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Attitudes::Quaternions(_) => "quaternion",
            Attitudes::Matrices(_) => "rotation matrix",
            Attitudes::Angles(_) => "Euler angles",
            Attitudes::Rodrigues(_) => "modified Rodrigues parameters",
        }
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Attitudes::Quaternions(rows) => rows.len(),
            Attitudes::Matrices(rows) => rows.len(),
            Attitudes::Angles(rows) | Attitudes::Rodrigues(rows) => rows.len(),
        }
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The numbers of row `k`.
    pub(super) fn row(&self, k: usize) -> &[f64] {
        match self {
            Attitudes::Quaternions(rows) => &rows[k],
            Attitudes::Matrices(rows) => &rows[k],
            Attitudes::Angles(rows) | Attitudes::Rodrigues(rows) => &rows[k],
        }
    }
}

impl Trajectory {
    /// A record with these times, s, and no columns yet.
    #[must_use]
    pub fn new(times: Vec<f64>) -> Self {
        Trajectory { times, attitude: None, rates: None, momentum: None, digits: Digits::default() }
    }

    /// The same with attitudes.
    #[must_use]
    pub fn with_attitude(mut self, attitude: Attitudes) -> Self {
        self.attitude = Some(attitude);
        self
    }

    /// The same with angular velocities.
    #[must_use]
    pub fn with_rates(mut self, rates: Vec<[f64; 3]>) -> Self {
        self.rates = Some(rates);
        self
    }

    /// The same with angular momenta.
    #[must_use]
    pub fn with_momentum(mut self, momentum: Vec<[f64; 3]>) -> Self {
        self.momentum = Some(momentum);
        self
    }

    /// The same with the numbers of significant decimal digits that were written.
    #[must_use]
    pub fn with_digits(mut self, digits: Digits) -> Self {
        self.digits = digits;
        self
    }

    /// Whether the columns can be audited at all.
    ///
    /// # Errors
    /// Fewer than [`FEWEST_ROWS`] rows, columns of other lengths, times that do not ascend, numbers that are not finite,
    /// attitudes of zeros, numbers of no significant digit, and a record of times alone.
    pub fn check(&self) -> Result<(), AuditError> {
        let rows = self.times.len();
        if rows < FEWEST_ROWS {
            return Err(AuditError::TooFewRows { rows, needed: FEWEST_ROWS });
        }
        let lengths = [
            ("attitude", self.attitude.as_ref().map(Attitudes::len)),
            ("angular velocity", self.rates.as_ref().map(Vec::len)),
            ("angular momentum", self.momentum.as_ref().map(Vec::len)),
        ];
        if lengths.iter().all(|(_, length)| length.is_none()) {
            return Err(AuditError::NoColumns);
        }
        for (column, length) in lengths {
            if let Some(found) = length.filter(|length| *length != rows) {
                return Err(AuditError::Lengths { column, found, rows });
            }
        }
        let digits = [
            ("attitude", self.digits.attitude),
            ("angular velocity", self.digits.rates),
            ("angular momentum", self.digits.momentum),
        ];
        if let Some((column, _)) = digits.into_iter().find(|(_, digits)| *digits == Some(0)) {
            return Err(AuditError::NoDigits { column });
        }
        if let Some(row) = self.times.iter().position(|t| !t.is_finite()) {
            return Err(AuditError::NotFinite { column: "time", row, value: self.times[row] });
        }
        if let Some(before) = self.times.windows(2).position(|pair| pair[1] <= pair[0]) {
            let (time, previous) = (self.times[before + 1], self.times[before]);
            return Err(AuditError::TimesNotAscending { row: before + 1, time, previous });
        }
        let finite = |column, row, values: &[f64]| match values.iter().find(|x| !x.is_finite()) {
            Some(&value) => Err(AuditError::NotFinite { column, row, value }),
            None => Ok(()),
        };
        for row in 0..rows {
            if let Some(attitude) = &self.attitude {
                finite("attitude", row, attitude.row(row))?;
                let any = matches!(attitude, Attitudes::Angles(_) | Attitudes::Rodrigues(_));
                if !any && attitude.row(row).iter().all(|x| *x == 0.0) {
                    return Err(AuditError::NoAttitude { row });
                }
            }
            if let Some(rates) = &self.rates {
                finite("angular velocity", row, &rates[row])?;
            }
            if let Some(momentum) = &self.momentum {
                finite("angular momentum", row, &momentum[row])?;
            }
        }
        Ok(())
    }
}
