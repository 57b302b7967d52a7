//! Repeated attitudes, gaps, and single attitudes that jump.

use core::ops::Range;

use polhode::record::median;
use polhode::rotation::{Quat, rotation_angle};

use crate::thresholds::poses::{GAP, JUMP};

/// The attitudes that do not repeat the one before to the last digit; all of a body at rest.
pub(super) fn new_readings(attitudes: &[Quat<f64>]) -> Vec<usize> {
    let same = |k: usize| attitudes[k] == attitudes[k - 1] || attitudes[k] == -attitudes[k - 1];
    let new: Vec<usize> = (0..attitudes.len()).filter(|&k| k == 0 || !same(k)).collect();
    if new.len() == 1 { (0..attitudes.len()).collect() } else { new }
}

/// Where times have no gap: an interval of more than some medians.
pub(super) fn split(times: &[f64]) -> Vec<Range<usize>> {
    let mut intervals: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let median = median(&mut intervals).unwrap_or(0.0);
    let mut ranges = Vec::new();
    let mut start = 0;
    for k in 1..=times.len() {
        if k == times.len() || times[k] - times[k - 1] > GAP * median {
            ranges.push(start..k);
            start = k;
        }
    }
    ranges
}

/// Angles between neighbouring attitudes, rad.
pub(crate) fn turns(attitudes: &[Quat<f64>]) -> Vec<f64> {
    attitudes.windows(2).map(|pair| rotation_angle(pair[0], pair[1])).collect()
}

/// Single attitudes that lie far off both neighbours, which lie near each other: swapped markers, a bad frame.
pub(crate) fn jumps(attitudes: &[Quat<f64>]) -> Vec<usize> {
    let turns = turns(attitudes);
    let usual = JUMP * median(&mut turns.clone()).unwrap_or(0.0);
    let is_jump = |k: &usize| {
        let past = rotation_angle(attitudes[*k - 1], attitudes[*k + 1]);
        turns[*k - 1].min(turns[*k]) > usual && past < usual
    };
    (1..attitudes.len().saturating_sub(1)).filter(is_jump).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use polhode::rotation::Vec3;

    fn spin(count: usize) -> Vec<Quat<f64>> {
        (0..count).map(|k| Quat::exponential(Vec3([0.0, 0.0, 0.05 * k as f64]))).collect()
    }

    #[test]
    fn repeated_attitudes_are_left_out_whatever_their_sign() {
        let one = spin(3);
        let held = [one[0], one[0], -one[0], one[1], one[1], one[2]];
        assert_eq!(new_readings(&held), [0, 3, 5]);
        assert_eq!(new_readings(&[one[0]; 4]), [0, 1, 2, 3]); // at rest
    }

    #[test]
    fn a_bad_frame_is_a_jump_and_a_turn_is_none() {
        let mut attitudes = spin(40);
        assert!(jumps(&attitudes).is_empty());
        attitudes[7] = attitudes[7] * Quat::exponential(Vec3([1.5, 0.0, 0.0]));
        attitudes[20] = -attitudes[20];
        assert_eq!(jumps(&attitudes), [7]);
        // what stays turned is another motion, and no jump of one sample
        for q in &mut attitudes[30..] {
            *q = *q * Quat::exponential(Vec3([1.5, 0.0, 0.0]));
        }
        assert_eq!(jumps(&attitudes), [7]);
    }

    #[test]
    fn gaps_part_segments() {
        assert_eq!(split(&[0.0, 1.0, 2.0, 11.0, 12.0]), [0..3, 3..5]);
        assert_eq!(split(&[0.0]).len(), 1);
    }

    /// A gap is more than eight median intervals, a jump more than eight median turns off both neighbours.
    #[test]
    fn gaps_and_jumps_begin_beyond_eight_medians() {
        let times = |gap: f64| [0.0, 1.0, 2.0, 2.0 + gap, 3.0 + gap];
        assert_eq!((split(&times(8.0)).len(), split(&times(8.1)).len()), (1, 2));
        // √(0.05² + 0.35²) = 0.354 and √(0.05² + 0.45²) = 0.453 off both, about eight turns of 0.05
        for (off, expected) in [(0.35, vec![]), (0.45, vec![7])] {
            let mut attitudes = spin(40);
            attitudes[7] = attitudes[7] * Quat::exponential(Vec3([off, 0.0, 0.0]));
            assert_eq!(jumps(&attitudes), expected, "{off}");
        }
        assert!((turns(&spin(3))[1] - 0.05).abs() < 1e-13);
        assert!(jumps(&spin(2)).is_empty() && split(&[]).is_empty());
    }
}
