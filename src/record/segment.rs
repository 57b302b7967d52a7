//! Samples without a gap.

use core::ops::Range;

use nalgebra::Vector3;

use super::error::RecordError;
use crate::units::RateUnit;

/// Samples without a gap between them: finite, at ascending times.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::record::Segment;
/// let rates = vec![Vector3::new(0.1, 2.0, 0.3); 2];
/// let segment = Segment::new("toss 1", vec![0.0, 0.01], rates.clone())?;
/// assert_eq!((segment.source(), segment.times().len()), ("toss 1", 2));
///
/// let turned = Segment::new("toss 1", vec![0.01, 0.0], rates).unwrap_err();
/// assert!(turned.to_string().starts_with("toss 1, line 2: time 0 s comes after 0.01 s"));
/// # Ok::<(), polhode::record::RecordError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    pub(super) source: String,
    pub(super) times: Vec<f64>,
    pub(super) rates: Vec<Vector3<f64>>,
    /// The line of each sample in its source, from 1.
    pub(super) lines: Vec<usize>,
    pub(super) inputs: Option<Inputs>,
    /// The unit of the rates in the source, where that or a setting names one.
    pub(super) rate_unit: Option<RateUnit>,
    /// Samples before which so many were left out that the two sides are apart as by a gap; ascending.
    pub(super) breaks: Vec<usize>,
}

/// Samples left out in a row that part a segment: the interval is then longer than that of a gap.
const BREAK: usize = 8;

/// Wheel momenta (N m s) and torques (N m) at the times of a segment, sensor axes; a list is empty where there are none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inputs {
    /// Of wheels.
    pub wheel: Vec<Vector3<f64>>,
    /// On the body.
    pub torque: Vec<Vector3<f64>>,
}

impl Inputs {
    /// Those of some samples.
    pub(super) fn of(&self, kept: impl Iterator<Item = usize> + Clone) -> Inputs {
        let of = |list: &[Vector3<f64>]| kept.clone().filter_map(|i| list.get(i).copied()).collect();
        Inputs { wheel: of(&self.wheel), torque: of(&self.torque) }
    }
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
        let lines = (1..=times.len()).collect();
        Ok(Segment {
            source: source.into(),
            times,
            rates,
            lines,
            inputs: None,
            rate_unit: Some(RateUnit::default()),
            breaks: Vec::new(),
        })
    }

    /// With the angular momentum of wheels in the body relative to it, N m s, sensor axes, one per time.
    ///
    /// A wheel that turns while the body does gives the tensor its size: the fit then has an absolute tensor.
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use polhode::record::Segment;
    /// let rates = vec![Vector3::new(0.1, 2.0, 0.3); 2];
    /// let segment = Segment::new("toss 1", vec![0.0, 0.01], rates)?;
    /// assert!(segment.clone().with_wheel(vec![Vector3::z() * 1e-3; 2]).is_ok());
    /// assert!(segment.with_wheel(vec![Vector3::z() * 1e-3; 3]).is_err());
    /// # Ok::<(), polhode::record::RecordError>(())
    /// ```
    ///
    /// # Errors
    /// A list of another length than the times, values that are not finite.
    pub fn with_wheel(mut self, momenta: Vec<Vector3<f64>>) -> Result<Self, RecordError> {
        self.check_input(&momenta, "the wheel momentum")?;
        self.inputs.get_or_insert_default().wheel = momenta;
        Ok(self)
    }

    /// With the torque on the body, N m, sensor axes, one per time: it gives the tensor its size.
    ///
    /// # Errors
    /// A list of another length than the times, values that are not finite.
    pub fn with_torque(mut self, torques: Vec<Vector3<f64>>) -> Result<Self, RecordError> {
        self.check_input(&torques, "the torque")?;
        self.inputs.get_or_insert_default().torque = torques;
        Ok(self)
    }

    fn check_input(&self, list: &[Vector3<f64>], name: &str) -> Result<(), RecordError> {
        if list.len() != self.times.len() {
            return Err(RecordError::Lengths { times: self.times.len(), rates: list.len() });
        }
        let broken = list.iter().position(|v| v.iter().any(|v| !v.is_finite()));
        broken.map_or(Ok(()), |k| {
            let axis = (0..3).find(|&axis| !list[k][axis].is_finite()).unwrap_or(0);
            Err(RecordError::Value {
                file: self.source.clone(),
                line: self.lines[k],
                column: axis + 1,
                name: name.into(),
                value: list[k][axis].to_string(),
            })
        })
    }

    /// Angular momentum of wheels, N m s, sensor axes, one per time; `None` where there is none.
    pub fn wheel(&self) -> Option<&[Vector3<f64>]> {
        self.inputs.as_ref().map(|inputs| inputs.wheel.as_slice()).filter(|list| !list.is_empty())
    }

    /// Torque on the body that the record tells, N m, sensor axes, one per time; `None` where it tells none.
    pub fn torque(&self) -> Option<&[Vector3<f64>]> {
        self.inputs.as_ref().map(|inputs| inputs.torque.as_slice()).filter(|list| !list.is_empty())
    }

    /// Wheel momenta and torques, where there are any.
    #[doc(hidden)]
    pub fn inputs(&self) -> Option<&Inputs> {
        self.inputs.as_ref()
    }

    /// The segment without some of its samples; ascending.
    pub(super) fn without(&self, left_out: &[usize]) -> Segment {
        let mut left = left_out.iter().copied().peekable();
        let kept: Vec<usize> = (0..self.times.len()).filter(|i| left.next_if_eq(i).is_none()).collect();
        let is_break = |pair: &[usize]| pair[1] - pair[0] > BREAK || self.parted(pair[0], pair[1]);
        let breaks = kept.windows(2).enumerate().filter(|(_, pair)| is_break(pair)).map(|(k, _)| k + 1);
        Segment {
            source: self.source.clone(),
            times: kept.iter().map(|&i| self.times[i]).collect(),
            rates: kept.iter().map(|&i| self.rates[i]).collect(),
            lines: kept.iter().map(|&i| self.lines[i]).collect(),
            inputs: self.inputs.as_ref().map(|inputs| inputs.of(kept.iter().copied())),
            rate_unit: self.rate_unit,
            breaks: breaks.collect(),
        }
    }

    /// Its samples from `start` to `end`, s, both included; `None` where there are none.
    pub(super) fn between(&self, start: f64, end: f64) -> Option<Segment> {
        let range = self.times.partition_point(|&t| t < start)..self.times.partition_point(|&t| t <= end);
        if range.is_empty() {
            return None;
        }
        let breaks = self.breaks.iter().filter(|k| range.start < **k && **k < range.end);
        Some(Segment {
            source: self.source.clone(),
            times: self.times[range.clone()].to_vec(),
            rates: self.rates[range.clone()].to_vec(),
            lines: self.lines[range.clone()].to_vec(),
            inputs: self.inputs.as_ref().map(|inputs| inputs.of(range.clone())),
            rate_unit: self.rate_unit,
            breaks: breaks.map(|k| k - range.start).collect(),
        })
    }

    /// Whether a break lies behind sample `a`, and not behind `b`, a later one.
    fn parted(&self, a: usize, b: usize) -> bool {
        self.breaks.iter().any(|k| a < *k && *k <= b)
    }

    /// The samples between which none are left out in runs as long as a gap.
    #[doc(hidden)]
    pub fn stretches(&self) -> impl Iterator<Item = Range<usize>> {
        let ends = self.breaks.iter().copied().chain([self.times.len()]);
        ends.scan(0, |start, end| Some(core::mem::replace(start, end)..end))
    }

    /// The line of each sample in its source, from 1; of a segment that was not read from a text its place.
    pub fn lines(&self) -> &[usize] {
        &self.lines
    }

    /// The unit of the rates in its source; `None` where neither that nor a setting names one, and rad/s is a guess.
    pub fn rate_unit(&self) -> Option<RateUnit> {
        self.rate_unit
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
