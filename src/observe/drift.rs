//! Secular drift: the slope of an error series, with the interval that the data allow.

/// A straight line through a series.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Drift {
    /// Slope per unit of the abscissa.
    pub slope: f64,
    /// Half width of the 95 % confidence interval of the slope.
    pub half_width: f64,
}

impl Drift {
    /// Whether the interval excludes zero.
    #[must_use]
    pub fn is_secular(&self) -> bool {
        self.slope.abs() > self.half_width
    }
}

/// The secular slope of `values` at equally spaced `times`; `None` for fewer than 16 points.
///
/// The series is averaged over 16 blocks, so that oscillations and the correlation of neighbours fall out, and a
/// line is fitted to the block means; its interval is Student's with 14 degrees of freedom.
///
/// ```
/// use polhode::observe::secular_drift;
/// let times: Vec<f64> = (0..1600).map(f64::from).collect();
/// let values: Vec<f64> = times.iter().map(|t| 3e-9 * t + 1e-6 * (t % 4.0 - 1.5)).collect();
/// let drift = secular_drift(&times, &values).unwrap();
/// assert!((drift.slope - 3e-9).abs() < 1e-12 && drift.is_secular());
/// ```
#[must_use]
pub fn secular_drift(times: &[f64], values: &[f64]) -> Option<Drift> {
    const BLOCKS: usize = 16;
    const STUDENT_95_14: f64 = 2.144_786_687_917_804;
    let n = times.len().min(values.len());
    if n < BLOCKS {
        return None;
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let block = |series: &[f64], b: usize| mean(&series[b * n / BLOCKS..(b + 1) * n / BLOCKS]);
    let t: Vec<f64> = (0..BLOCKS).map(|b| block(times, b)).collect();
    let y: Vec<f64> = (0..BLOCKS).map(|b| block(values, b)).collect();
    let (t_mean, y_mean) = (mean(&t), mean(&y));
    let spread: f64 = t.iter().map(|t| (t - t_mean) * (t - t_mean)).sum();
    let slope = t.iter().zip(&y).map(|(t, y)| (t - t_mean) * (y - y_mean)).sum::<f64>() / spread;
    let residual: f64 = t.iter().zip(&y).map(|(t, y)| y - y_mean - slope * (t - t_mean)).map(|r| r * r).sum();
    let deviation = (residual / (BLOCKS - 2) as f64 / spread).sqrt();
    Some(Drift { slope, half_width: STUDENT_95_14 * deviation })
}
