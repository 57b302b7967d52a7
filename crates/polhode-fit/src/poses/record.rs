//! A record of measured attitudes.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::record::{Record, Segment, joined, shared};
use polhode::rotation::Quat;

use crate::likelihood::local;
use crate::poses::clean::{new_readings, split};
use crate::poses::error::PosesError;

/// Measured attitudes of one body, body axes → space, and where they were measured too its angular velocities: segments that share one
/// tensor, each with a motion of its own.
///
/// A quaternion and its negative are the same attitude. The axes of space may be any that do not turn.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode_fit::Poses;
/// let turned = |t: f64| UnitQuaternion::from_scaled_axis(Vector3::z() * t);
/// let times = [0.0, 0.1, 0.2, 5.0, 5.1, 5.2];
/// let poses = Poses::new("poses.csv", &times, &times.map(turned))?;
/// assert_eq!((poses.segments().len(), poses.gaps(), poses.samples()), (2, 1, 6)); // a gap of more than eight intervals
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Poses {
    segments: Vec<PoseSegment>,
    repeated: usize,
    gaps: usize,
    direction_is_open: bool,
}

/// Attitudes without a gap between them.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseSegment {
    source: String,
    pub(crate) times: Vec<f64>,
    pub(crate) attitudes: Vec<Quat<f64>>,
    /// Empty where there are none.
    pub(crate) rates: Vec<Vector3<f64>>,
    /// The sample of the source that each is, from 1.
    pub(crate) samples: Vec<usize>,
}

impl PoseSegment {
    /// Where it comes from.
    #[must_use]
    pub fn source(&self) -> &str {
        &self.source
    }

    /// Ascending times, s.
    #[must_use]
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Attitudes, body axes → space, one per time.
    pub fn attitudes(&self) -> impl Iterator<Item = UnitQuaternion<f64>> + '_ {
        self.attitudes.iter().map(|q| (*q).into())
    }

    /// Angular velocities, rad/s, one per time, in the axes of their sensor; empty where there are none.
    #[must_use]
    pub fn rates(&self) -> &[Vector3<f64>] {
        &self.rates
    }

    fn part(&self, range: core::ops::Range<usize>) -> PoseSegment {
        PoseSegment {
            source: self.source.clone(),
            times: self.times[range.clone()].to_vec(),
            attitudes: self.attitudes[range.clone()].to_vec(),
            rates: self.rates.get(range.clone()).map(<[_]>::to_vec).unwrap_or_default(),
            samples: self.samples[range].to_vec(),
        }
    }
}

impl Poses {
    /// From ascending times, s, and as many attitudes, body axes → space; `source` names them in messages.
    ///
    /// Attitudes that repeat the one before to the last digit are left out: a log that is written faster than it measures.
    ///
    /// # Errors
    /// Lists of different lengths, numbers that are not finite, quaternions of norm zero, times that do not ascend, no samples.
    pub fn new(source: &str, times: &[f64], attitudes: &[UnitQuaternion<f64>]) -> Result<Poses, PosesError> {
        Poses::of(source, times, attitudes, None)
    }

    /// The same with angular velocities at the same times, rad/s, in axes of their own that are fixed in the body: the turn between
    /// both axes is fitted, and the tensor is in those of the angular velocities.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_rates(
        source: &str,
        times: &[f64],
        attitudes: &[UnitQuaternion<f64>],
        rates: &[Vector3<f64>],
    ) -> Result<Poses, PosesError> {
        Poses::of(source, times, attitudes, Some(rates))
    }

    fn of(
        source: &str,
        times: &[f64],
        attitudes: &[UnitQuaternion<f64>],
        rates: Option<&[Vector3<f64>]>,
    ) -> Result<Poses, PosesError> {
        let name = || source.to_string();
        let count = times.len();
        let lengths = [("attitudes", Some(attitudes.len())), ("angular velocities", rates.map(<[_]>::len))];
        for (what, found) in lengths {
            if let Some(found) = found.filter(|found| *found != count) {
                return Err(PosesError::Lengths { source_name: name(), what, times: count, found });
            }
        }
        if count == 0 {
            return Err(PosesError::Empty { window: None });
        }
        for k in 0..count {
            let finite = [
                ("time", times[k].is_finite()),
                ("angular velocity", rates.is_none_or(|rates| rates[k].iter().all(|v| v.is_finite()))),
            ];
            if let Some((what, _)) = finite.into_iter().find(|(_, finite)| !finite) {
                return Err(PosesError::Value { source_name: name(), sample: k + 1, what });
            }
            let q = attitudes[k].coords;
            if q.iter().any(|x| !x.is_finite()) || q.iter().all(|x| *x == 0.0) {
                return Err(PosesError::NoAttitude { source_name: name(), sample: k + 1 });
            }
            if k > 0 && times[k] <= times[k - 1] {
                let (time, before) = (times[k], times[k - 1]);
                return Err(PosesError::Order { source_name: name(), sample: k + 1, time, before });
            }
        }
        let attitudes: Vec<Quat<f64>> = attitudes.iter().map(|q| Quat::from(*q)).collect();
        let kept = new_readings(&attitudes);
        let whole = PoseSegment {
            source: name(),
            times: kept.iter().map(|&k| times[k]).collect(),
            attitudes: kept.iter().map(|&k| attitudes[k]).collect(),
            rates: rates.map_or(Vec::new(), |rates| kept.iter().map(|&k| rates[k]).collect()),
            samples: kept.iter().map(|k| k + 1).collect(),
        };
        let parts = split(&whole.times);
        Ok(Poses {
            gaps: parts.len() - 1,
            segments: parts.into_iter().map(|range| whole.part(range)).collect(),
            repeated: count - kept.len(),
            direction_is_open: false,
        })
    }

    /// Its segments.
    #[must_use]
    pub fn segments(&self) -> &[PoseSegment] {
        &self.segments
    }

    /// Number of samples.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.segments.iter().map(|s| s.times.len()).sum()
    }

    /// Number of samples left out because they repeat the attitude before.
    #[must_use]
    pub fn repeated(&self) -> usize {
        self.repeated
    }

    /// Number of places where the record was split because of a gap.
    #[must_use]
    pub fn gaps(&self) -> usize {
        self.gaps
    }

    /// Whether angular velocities stand beside the attitudes.
    #[must_use]
    pub fn has_rates(&self) -> bool {
        self.segments.iter().any(|s| !s.rates.is_empty())
    }

    /// The same attitudes where nobody knows whether they are body axes → space or the inverse: a fit tells it from the motion, or
    /// refuses. An axisymmetric body moves alike both ways.
    #[must_use]
    pub fn with_open_direction(self) -> Poses {
        Poses { direction_is_open: true, ..self }
    }

    /// Whether the direction is to be told from the motion.
    #[must_use]
    pub fn direction_is_open(&self) -> bool {
        self.direction_is_open
    }

    /// The inverse of each attitude.
    #[must_use]
    pub fn inverse(&self) -> Poses {
        let inverse = |s: &PoseSegment| PoseSegment {
            attitudes: s.attitudes.iter().map(|q| q.conjugate()).collect(),
            ..s.clone()
        };
        Poses { segments: self.segments.iter().map(inverse).collect(), ..self.clone() }
    }

    /// These attitudes alone.
    #[must_use]
    pub fn without_rates(&self) -> Poses {
        let bare = |s: &PoseSegment| PoseSegment { rates: Vec::new(), ..s.clone() };
        Poses { segments: self.segments.iter().map(bare).collect(), ..self.clone() }
    }

    /// The parts that lie in the windows (start, end), s, both ends included. Windows that overlap count as one, and where one ends
    /// and the next begins the attitude is of the first, as in [`Record::windows`].
    ///
    /// # Errors
    /// A window that is not ascending, or without samples.
    pub fn windows(&self, windows: &[(f64, f64)]) -> Result<Poses, PosesError> {
        let mut segments = Vec::new();
        let mut last = f64::NEG_INFINITY;
        for (start, end) in joined(windows).map_err(|(start, end)| PosesError::Window { start, end })? {
            let first = if start == last { last.next_up() } else { start };
            last = end;
            let before = segments.len();
            for s in &self.segments {
                let low = s.times.partition_point(|t| *t < first);
                let high = s.times.partition_point(|t| *t <= end);
                segments.extend((low < high).then(|| s.part(low..high)));
            }
            if segments.len() == before {
                return Err(PosesError::Empty { window: Some((start, end)) });
            }
        }
        Ok(Poses { segments, ..self.clone() })
    }

    /// These attitudes and others of the same body.
    #[must_use]
    pub fn join(mut self, other: Poses) -> Poses {
        self.segments.extend(other.segments);
        self.repeated += other.repeated;
        self.gaps += other.gaps;
        self.direction_is_open |= other.direction_is_open;
        self
    }

    /// How many attitudes of `other` it has too, as [`Record::shared`] counts samples.
    #[doc(hidden)]
    #[must_use]
    pub fn shared(&self, other: &Poses) -> usize {
        fn attitudes(poses: &Poses) -> Vec<&[Quat<f64>]> {
            poses.segments.iter().map(|s| &s.attitudes[..]).collect()
        }
        let key = |q: &Quat<f64>| q.components().map(f64::to_bits);
        shared(&attitudes(self), &attitudes(other), key)
    }

    /// The angular velocities beside the attitudes, or else those that parabolas through neighbouring attitudes have at some of their
    /// times: what a record of rates would hold, for a look at the motion.
    #[must_use]
    pub fn rates(&self) -> Record {
        let stretches: Vec<(Vec<f64>, Vec<Quat<f64>>)> =
            self.segments.iter().map(|s| (s.times.clone(), s.attitudes.clone())).collect();
        let width = local::width(&stretches, 0.0).unwrap_or(0.0);
        let mut record = Record::default();
        for s in &self.segments {
            let (times, rates) = if s.rates.is_empty() {
                // a third of the width: as many as its samples can tell apart
                let nodes = local::nodes(&s.times, &s.attitudes, width / 3.0);
                match nodes.len() {
                    0 => (s.times.clone(), vec![Vector3::zeros(); s.times.len()]),
                    _ => nodes.into_iter().map(|node| (node.time, node.rate)).unzip(),
                }
            } else {
                (s.times.clone(), s.rates.clone())
            };
            record.segments.extend(Segment::new(&s.source, times, rates));
        }
        record
    }
}
