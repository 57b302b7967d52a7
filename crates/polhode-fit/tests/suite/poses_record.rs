//! Records of attitudes: what is refused, cut, joined and looked at.

use nalgebra::{UnitQuaternion, Vector3};
use polhode_fit::{Poses, PosesError};

const RATE: Vector3<f64> = Vector3::new(0.2, -0.1, 0.5);

fn turned(times: &[f64]) -> Vec<UnitQuaternion<f64>> {
    times.iter().map(|t| UnitQuaternion::from_scaled_axis(RATE * *t)).collect()
}

fn times() -> Vec<f64> {
    // a gap of ten intervals before the thirty-first
    (0..60).map(|k| 0.1 * f64::from(k) + if k < 30 { 0.0 } else { 1.0 }).collect()
}

/// Each refusal names the sample, from 1, and its numbers.
#[test]
fn what_is_no_record_of_attitudes_is_refused_by_its_sample() {
    let (times, attitudes) = (times(), turned(&times()));
    let short = Poses::new("a", &times[1..], &attitudes).unwrap_err();
    assert_eq!(
        short,
        PosesError::Lengths { source_name: "a".into(), what: "attitudes", times: 59, found: 60 }
    );
    let rates = vec![RATE; 58];
    let PosesError::Lengths { what, times: 60, found: 58, .. } =
        Poses::with_rates("a", &times, &attitudes, &rates).unwrap_err()
    else {
        panic!()
    };
    assert_eq!(what, "angular velocities");
    assert_eq!(Poses::new("a", &[], &[]).unwrap_err(), PosesError::Empty { window: None });
    let mut late = times.clone();
    late[7] = late[6];
    let error = Poses::new("a", &late, &attitudes).unwrap_err();
    let (time, before) = (late[7], late[6]);
    assert_eq!(error, PosesError::Order { source_name: "a".into(), sample: 8, time, before });
    late[7] = f64::NAN;
    let error = Poses::new("a", &late, &attitudes).unwrap_err();
    assert_eq!(error, PosesError::Value { source_name: "a".into(), sample: 8, what: "time" });
    let mut rates = vec![RATE; 60];
    rates[59].z = f64::INFINITY;
    let error = Poses::with_rates("a", &times, &attitudes, &rates).unwrap_err();
    assert_eq!(error, PosesError::Value { source_name: "a".into(), sample: 60, what: "angular velocity" });
    let mut none = attitudes;
    none[2] = UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(0.0, 0.0, 0.0, 0.0));
    let error = Poses::new("a", &times, &none).unwrap_err();
    assert_eq!(error, PosesError::NoAttitude { source_name: "a".into(), sample: 3 });
}

/// Windows keep what lies in them, both ends included, with its samples; what is empty is refused by its numbers.
#[test]
fn windows_keep_the_samples_within_them() {
    let (times, attitudes) = (times(), turned(&times()));
    let rates = vec![RATE; 60];
    let all = Poses::with_rates("a", &times, &attitudes, &rates).unwrap();
    assert_eq!((all.segments().len(), all.gaps(), all.samples(), all.repeated()), (2, 1, 60, 0));
    let cut = all.windows(&[(times[5], times[9]), (times[28], times[33])]).unwrap();
    let own: Vec<&[f64]> = cut.segments().iter().map(|s| s.times()).collect();
    assert_eq!(own, [&times[5..10], &times[28..30], &times[30..34]]);
    assert!(cut.segments().iter().all(|s| s.rates().len() == s.times().len() && s.source() == "a"));
    for (segment, first) in cut.segments().iter().zip([5, 28, 30]) {
        for (found, expected) in segment.attitudes().zip(&attitudes[first..]) {
            assert!(found.angle_to(expected) < 1e-12);
        }
    }
    let (a, b) = (times[29] + 0.01, times[30] - 0.01);
    assert_eq!(all.windows(&[(a, b)]).unwrap_err(), PosesError::Empty { window: Some((a, b)) });
    for (start, end) in [(1.0, 1.0), (2.0, 1.0)] {
        assert_eq!(all.windows(&[(start, end)]).unwrap_err(), PosesError::Window { start, end });
    }
    assert!(all.windows(&[(f64::NAN, 1.0)]).is_err() && all.windows(&[(0.0, f64::INFINITY)]).is_err());
}

/// Windows that overlap are one, and where one ends and the next begins the attitude is of the first: none serves twice.
#[test]
fn overlapping_windows_of_attitudes_are_one() {
    let times = times();
    let all = Poses::new("a", &times, &turned(&times)).unwrap();
    let spans = [(8, 14), (3, 10), (14, 20), (3, 10)].map(|(start, end)| (times[start], times[end]));
    let cut = all.windows(&spans).unwrap();
    let own: Vec<&[f64]> = cut.segments().iter().map(|s| s.times()).collect();
    assert_eq!(own, [&times[3..15], &times[15..21]]);
}

/// Joined records keep their counts; inverses and bare attitudes are those of each sample.
#[test]
fn records_are_joined_inverted_and_bared_sample_by_sample() {
    let (times, mut attitudes) = (times(), turned(&times()));
    attitudes[10] = attitudes[9];
    let first = Poses::with_rates("a", &times, &attitudes, &[RATE; 60]).unwrap();
    assert_eq!((first.samples(), first.repeated()), (59, 1));
    let second = Poses::new("b", &times[..20], &turned(&times[..20])).unwrap().with_open_direction();
    assert!(first.has_rates() && !second.has_rates() && !first.direction_is_open());
    let both = first.clone().join(second);
    assert_eq!((both.segments().len(), both.samples(), both.repeated(), both.gaps()), (3, 79, 1, 1));
    assert!(both.direction_is_open() && both.has_rates());
    let bare = both.without_rates();
    assert!(!bare.has_rates() && bare.samples() == 79);
    for (segment, inverse) in both.segments().iter().zip(both.inverse().segments()) {
        for (own, inverse) in segment.attitudes().zip(inverse.attitudes()) {
            assert!((own * inverse).angle() < 1e-12);
        }
    }
    // the rates that were measured, and else those of the attitudes
    let measured = first.rates();
    assert_eq!(measured.segments.iter().map(|s| s.times().len()).sum::<usize>(), 59);
    assert!(measured.segments.iter().flat_map(|s| s.rates()).all(|w| *w == RATE));
    let even = Poses::new("c", &times[..30], &turned(&times[..30])).unwrap().rates();
    assert!(even.segments[0].times().len() > 3);
    assert!(even.segments[0].rates().iter().all(|w| (w - RATE).norm() < 1e-9));
}
