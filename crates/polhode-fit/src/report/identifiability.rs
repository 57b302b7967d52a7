//! Which combinations of the five numbers a record determines, and which it does not.

use crate::thresholds::identifiability::{LONGER, PRINCIPAL, PURE, VAGUE};
use core::fmt;

use nalgebra::{Matrix3, Vector3};

use crate::error::capital;
use crate::physical::coordinates::{Coordinates, Form, eigen, trace_free};

/// A principal axis that a record determines, though not the tensor. Its `Display` is a sentence.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalAxis {
    /// Unit vector in sensor axes, of either sign.
    pub axis: Vector3<f64>,
    /// Its number among the axes that [`Undetermined`] speaks of, from 1; of the axis of a pure spin, which needs none, `None`.
    pub number: Option<usize>,
}

impl fmt::Display for PrincipalAxis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named =
            named(&self.axis).map_or(String::new(), |name| format!(", the {name} axis of the sensor,"));
        let axis = direction(&self.axis);
        match self.number {
            Some(number) => write!(f, "{axis}{named} is a principal axis (axis {number} here)"),
            None => write!(f, "{axis}{named} is a principal axis: the body spins about it"),
        }
    }
}

/// A combination of entries that a record leaves undetermined. Its `Display` is a sentence.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Undetermined {
    /// All ratios and axes: the motion cannot be told from its noise.
    Everything,
    /// The ratio of the two moments across the axis of a pure spin.
    TransverseRatio,
    /// The ratio of the moment about that axis to the others.
    SpinRatio,
    /// The directions of the principal axes across it.
    TransverseAxes,
    /// Both ratios of a record of pure spins about several principal axes.
    Ratios,
    /// The ratio of two moments.
    Ratio {
        /// The axis of the one, from 1.
        low: usize,
        /// The axis of the other.
        high: usize,
    },
    /// The directions of two axes about the third.
    Axes {
        /// The one, from 1.
        low: usize,
        /// The other.
        high: usize,
        /// The third.
        about: usize,
    },
}

impl fmt::Display for Undetermined {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Everything => "no ratio and no axis is determined: the motion cannot be distinguished from noise",
            Self::TransverseRatio => {
                "the ratio of the two moments perpendicular to the spin axis is undetermined: the body spins about one axis"
            }
            Self::SpinRatio => {
                "the ratio of the moment about the spin axis to the other two is undetermined: a spin about one axis does not depend on it"
            }
            Self::TransverseAxes => "the directions of the principal axes perpendicular to the spin axis are undetermined",
            Self::Ratios => {
                "the ratios I1/I2 and I2/I3 are undetermined: the record has only spins about single principal axes"
            }
            Self::Ratio { low, high } => return write!(f, "the ratio I{low}/I{high} is undetermined"),
            Self::Axes { low, high, about } => {
                return write!(f, "the directions of axes {low} and {high} about axis {about} are undetermined");
            }
        })
    }
}

/// The spectrum of information about the five numbers of a tensor of trace 1.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Identifiability {
    /// Standard deviations (share of the trace) along the principal directions of the information, ascending; infinite
    /// where the motion carries no information.
    pub deviations: [f64; 5],
    /// How many of the five are determined.
    pub rank: usize,
    /// The undetermined combinations.
    pub null_directions: Vec<Undetermined>,
    /// The same as trace-free tensors of Frobenius norm 1, dimensionless, in sensor axes.
    pub null_tensors: Vec<Matrix3<f64>>,
    /// The principal axes that are determined nevertheless.
    pub known: Vec<PrincipalAxis>,
}

impl Identifiability {
    /// From the singular values of the whitened equations with their directions; `scatter` is the mean of ω ωᵀ and
    /// `estimate` the tensor so far.
    pub(crate) fn new(
        (singular, directions): &(Coordinates, Form),
        scatter: &Matrix3<f64>,
        estimate: &Matrix3<f64>,
    ) -> Self {
        let deviations =
            core::array::from_fn(|k| if singular[k] > 0.0 { 1.0 / singular[k] } else { f64::INFINITY });
        let null_tensors: Vec<_> = (0..5)
            .filter(|&k| deviations[k] > VAGUE)
            .map(|k| trace_free(&directions.column(k).into_owned()))
            .collect();
        let rank = 5 - null_tensors.len();
        let (null_directions, known) = unknowns(&null_tensors, rank, scatter, estimate);
        Identifiability { deviations, rank, null_directions, null_tensors, known }
    }

    /// Whether everything but the scale is determined.
    pub fn complete(&self) -> bool {
        self.rank == 5
    }

    /// Which record would tell more, in words; empty where this one determines everything.
    pub fn next_record(&self) -> String {
        let weakest = self.deviations.iter().copied().fold(0.0, f64::max);
        let times = (weakest / VAGUE) * (weakest / VAGUE);
        let what = match self.null_directions.first() {
            None => return String::new(),
            Some(Undetermined::Everything) => {
                "spin the body faster, with a wobble well above the noise".into()
            }
            Some(Undetermined::TransverseRatio | Undetermined::SpinRatio | Undetermined::TransverseAxes) => {
                "record a throw that wobbles: start with rotation about at least two of the principal axes"
                    .into()
            }
            Some(Undetermined::Ratios) => {
                "record a throw with rotation about two or three principal axes at once".into()
            }
            Some(Undetermined::Ratio { .. } | Undetermined::Axes { .. }) if times <= LONGER => format!(
                "start with rotation about all three axes, or record {} times as long",
                libm::ceil(times).max(2.0)
            ),
            Some(_) => "start with rotation about all three axes, with a larger wobble".to_string(),
        };
        format!("{what}; or give a tensor known beforehand, for instance from CAD, as a prior")
    }

    /// Both lists in one sentence.
    pub fn verdict(&self) -> String {
        let known = match (self.known.is_empty(), self.rank) {
            (true, 0) => "nothing".into(),
            (true, _) => "no axis and no ratio, only combinations of them".into(),
            _ => joined(&self.known),
        };
        format!(
            "{} of 5 numbers are known. {}. Known: {known}",
            self.rank,
            capital(&joined(&self.null_directions))
        )
    }
}

fn joined<T: fmt::Display>(facts: &[T]) -> String {
    facts.iter().map(T::to_string).collect::<Vec<_>>().join("; ")
}

/// A unit vector of either sign, the largest component positive.
pub(crate) fn direction(v: &Vector3<f64>) -> String {
    // what is zero to the digits shown has no sign
    let v = (v * v[v.iamax()].signum()).map(|part| if part.abs() < 5e-5 { 0.0 } else { part });
    format!("({:.4}, {:.4}, {:.4})", v.x, v.y, v.z)
}

/// The axis of the sensor that a unit vector is, to the digits shown.
fn named(v: &Vector3<f64>) -> Option<&'static str> {
    let across = v.iter().enumerate().filter(|(k, _)| *k != v.iamax());
    let is_one = across.map(|(_, part)| part.abs()).all(|part| part < 5e-4);
    is_one.then(|| ["x", "y", "z"][v.iamax()])
}

fn unknowns(
    null: &[Matrix3<f64>],
    rank: usize,
    scatter: &Matrix3<f64>,
    estimate: &Matrix3<f64>,
) -> (Vec<Undetermined>, Vec<PrincipalAxis>) {
    if rank == 5 {
        return (Vec::new(), Vec::new());
    }
    let (spread, directions) = eigen(*scatter);
    let main: Vector3<f64> = directions.column(2).into_owned();
    if rank == 0 {
        return (vec![Undetermined::Everything], Vec::new());
    }
    let common = common_frame(null);
    let frame = common.unwrap_or_else(|| eigen(*estimate).1);
    if rank <= 2 && spread[1] <= PURE * spread[2] {
        return (
            vec![Undetermined::TransverseRatio, Undetermined::SpinRatio, Undetermined::TransverseAxes],
            vec![PrincipalAxis { axis: main, number: None }],
        );
    }
    let known = (0..3)
        .map(|k| frame.column(k).into_owned())
        .enumerate()
        .filter(|(_, v)| null.iter().all(|t| (t * v - v * v.dot(&(t * v))).norm() < PRINCIPAL))
        .map(|(k, axis)| PrincipalAxis { axis, number: Some(k + 1) })
        .collect();
    if common.is_some() && rank == 3 {
        return (vec![Undetermined::Ratios], known);
    }
    let mut open = Vec::new();
    for tensor in null {
        let n = frame.transpose() * tensor * frame;
        let off = [(0, 1), (0, 2), (1, 2)].map(|(i, j)| (n[(i, j)].abs() * core::f64::consts::SQRT_2, i, j));
        let diagonal = n.diagonal().norm();
        let turn = off.iter().copied().fold((0.0, 0, 0), |a, b| if b.0 > a.0 { b } else { a });
        if diagonal >= turn.0 {
            let d = n.diagonal();
            let (low, high) = (d.imin().min(d.imax()) + 1, d.imin().max(d.imax()) + 1);
            open.push(Undetermined::Ratio { low, high });
        } else {
            let third = 3 - turn.1 - turn.2;
            open.push(Undetermined::Axes { low: turn.1 + 1, high: turn.2 + 1, about: third + 1 });
        }
    }
    (open, known)
}

/// The axes that diagonalise all of `null`, if there are such.
fn common_frame(null: &[Matrix3<f64>]) -> Option<Matrix3<f64>> {
    // one of these has three distinct eigenvalues, whose axes are the only candidates
    let sums = null.iter().flat_map(|a| null.iter().flat_map(move |b| [*a, a + b, a - b]));
    let gap = |m: &Matrix3<f64>| {
        let (values, _) = eigen(*m);
        (values[1] - values[0]).min(values[2] - values[1])
    };
    let best = sums.max_by(|a, b| gap(a).total_cmp(&gap(b)))?;
    let (_, frame) = eigen(best);
    let off = |t: &Matrix3<f64>| {
        let n = frame.transpose() * t * frame;
        n[(0, 1)].abs().max(n[(0, 2)].abs()).max(n[(1, 2)].abs())
    };
    null.iter().all(|t| off(t) < PRINCIPAL).then_some(frame)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is known may be combinations that have no name of their own: then not nothing is known.
    #[test]
    fn known_numbers_without_a_name_are_not_nothing() {
        let of = |rank| Identifiability {
            deviations: [1.0; 5],
            rank,
            null_directions: Vec::new(),
            null_tensors: Vec::new(),
            known: Vec::new(),
        };
        assert!(of(3).verdict().ends_with("Known: no axis and no ratio, only combinations of them"));
        assert!(of(0).verdict().ends_with("Known: nothing"));
    }

    /// A direction of either sign is one text, whose zeros have no sign.
    #[test]
    fn a_direction_is_written_with_its_largest_part_positive() {
        assert_eq!(direction(&Vector3::new(-0.8, 0.6, -1e-6)), "(0.8000, -0.6000, 0.0000)");
        assert_eq!(direction(&Vector3::new(0.8, -0.6, 1e-6)), "(0.8000, -0.6000, 0.0000)");
        assert_eq!(direction(&Vector3::new(6e-5, -4e-5, 1.0)), "(0.0001, 0.0000, 1.0000)");
    }

    /// An axis of the sensor is named where both other parts vanish to the digits that are shown.
    #[test]
    fn an_axis_of_the_sensor_is_named() {
        let near = |part: f64| [named(&Vector3::new(part, -1.0, 0.0)), named(&Vector3::new(0.0, -part, 1.0))];
        assert_eq!(near(4e-4), [Some("y"), Some("z")]);
        assert_eq!(near(6e-4), [None, None]);
        assert_eq!(named(&Vector3::new(-1.0, 4e-4, 6e-4)), None);
        assert_eq!(named(&-Vector3::x()), Some("x"));
        let of = |number| PrincipalAxis { axis: -Vector3::x(), number }.to_string();
        let text = "(1.0000, 0.0000, 0.0000), the x axis of the sensor,";
        assert_eq!(of(Some(3)), format!("{text} is a principal axis (axis 3 here)"));
        assert_eq!(of(None), format!("{text} is a principal axis: the body spins about it"));
    }

    fn open(null: Vec<Undetermined>, weakest: f64) -> Identifiability {
        Identifiability {
            deviations: [1e-4, 1e-4, 1e-4, weakest, 1e-3],
            rank: 5 - null.len(),
            null_directions: null,
            null_tensors: Vec::new(),
            known: Vec::new(),
        }
    }

    /// What is open is said by its axes, one after the other.
    #[test]
    fn what_is_open_is_said_by_its_axes() {
        let ratio = Undetermined::Ratio { low: 1, high: 3 };
        let axes = Undetermined::Axes { low: 1, high: 2, about: 3 };
        let known = |axis, number| PrincipalAxis { axis, number: Some(number) };
        let known = vec![known(Vector3::z(), 1), known(Vector3::new(0.6, 0.8, 0.0), 2)];
        let both = Identifiability { known, ..open(vec![ratio, axes], 0.2) };
        assert_eq!(
            both.verdict(),
            "3 of 5 numbers are known. The ratio I1/I3 is undetermined; the directions of axes 1 and 2 about axis 3 are \
             undetermined. Known: (0.0000, 0.0000, 1.0000), the z axis of the sensor, is a principal axis (axis 1 here); \
             (0.6000, 0.8000, 0.0000) is a principal axis (axis 2 here)"
        );
        assert!(!both.complete() && open(Vec::new(), 1e-3).complete());
    }

    /// A record that lacks a ratio or a direction may be that many times as long, by the square of its deviation, up to twenty times.
    #[test]
    fn the_next_record_is_as_long_as_the_square_of_the_deviation() {
        let ratio = Undetermined::Ratio { low: 1, high: 2 };
        let axes = Undetermined::Axes { low: 1, high: 2, about: 3 };
        for null in [ratio, axes] {
            let of = |weakest| open(vec![null], weakest).next_record();
            for (weakest, times) in [(0.101, 2), (0.141, 2), (0.142, 3), (0.31, 10), (0.447, 20)] {
                let expected = format!("all three axes, or record {times} times as long; or give a tensor");
                assert!(of(weakest).contains(&expected), "{weakest}: {}", of(weakest));
            }
            assert!(of(0.448).starts_with("start with rotation about all three axes, with a larger wobble;"));
        }
        let of = |null| open(vec![null, ratio], 0.2).next_record();
        assert!(of(Undetermined::Everything).starts_with("spin the body faster"));
        assert!(of(Undetermined::Ratios).contains("two or three principal axes at once"));
        for null in [Undetermined::TransverseRatio, Undetermined::SpinRatio, Undetermined::TransverseAxes] {
            assert!(of(null).starts_with("record a throw that wobbles"));
        }
        assert_eq!(open(Vec::new(), 0.2).next_record(), "");
    }
}
