//! Samples without a gap.

use nalgebra::Vector3;

use super::error::RecordError;

/// Samples without a gap between them: finite, at ascending times.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::fit::Segment;
/// let rates = vec![Vector3::new(0.1, 2.0, 0.3); 2];
/// let segment = Segment::new("toss 1", vec![0.0, 0.01], rates.clone())?;
/// assert_eq!((segment.source(), segment.times().len()), ("toss 1", 2));
///
/// let turned = Segment::new("toss 1", vec![0.01, 0.0], rates).unwrap_err();
/// assert!(turned.to_string().starts_with("toss 1, line 2: time 0 s comes after 0.01 s"));
/// # Ok::<(), polhode::fit::RecordError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    pub(super) source: String,
    pub(super) times: Vec<f64>,
    pub(super) rates: Vec<Vector3<f64>>,
}

impl Segment {
    /// From ascending `times` (s) and as many angular velocities (rad/s, sensor axes); `source` names them in messages.
    ///
    /// # Errors
    /// Lists of different lengths, values that are not finite, times that do not ascend, no samples.
    pub fn new(source: &str, times: Vec<f64>, rates: Vec<Vector3<f64>>) -> Result<Self, RecordError> {
        if times.len() != rates.len() {
            return Err(RecordError::Lengths { times: times.len(), rates: rates.len() });
        }
        if times.is_empty() {
            return Err(RecordError::Empty { file: source.into(), window: None, span: (0.0, 0.0) });
        }
        for (line, (&t, w)) in times.iter().zip(&rates).enumerate() {
            let row = [t, w.x, w.y, w.z];
            if let Some(k) = row.iter().position(|v| !v.is_finite()) {
                return Err(RecordError::Value {
                    file: source.into(),
                    line: line + 1,
                    column: k + 1,
                    name: NAMES[k].into(),
                    value: row[k].to_string(),
                });
            }
        }
        if let Some(k) = times.windows(2).position(|pair| pair[0] >= pair[1]) {
            let (before, time) = (times[k], times[k + 1]);
            return Err(RecordError::Order { file: source.into(), line: k + 2, time, before });
        }
        Ok(Segment { source: source.into(), times, rates })
    }

    /// Where it comes from.
    pub fn source(&self) -> &str {
        &self.source
    }

    /// Ascending times, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Angular velocities in sensor axes, rad/s, one per time.
    pub fn rates(&self) -> &[Vector3<f64>] {
        &self.rates
    }
}

/// Columns of a record that is not read from a text.
pub(super) const NAMES: [&str; 4] = ["t", "wx", "wy", "wz"];
