//! Readings that two records have of one measurement.

use std::collections::HashMap;

/// Changes from one reading to the next that runs of both have in common, at least: at rest a few readings are alike by chance.
const CHANGES: usize = 8;

/// The same of runs that go on in both: coarse steps make a motion and its repetition alike for a while.
const MANY: usize = 64;

/// How many readings of `later` stand `before` too, in runs of readings that are equal by their `key`. A run begins where one of both
/// begins and ends where one of both ends, as the runs of files that overlap do, or is long.
#[doc(hidden)]
pub fn shared<T, const N: usize>(before: &[&[T]], later: &[&[T]], key: impl Fn(&T) -> [u64; N]) -> usize {
    // every run that is long enough has one of them
    let mut anchors: HashMap<[u64; N], (usize, usize)> = HashMap::new();
    for (k, readings) in later.iter().enumerate() {
        for (i, reading) in readings.iter().enumerate().step_by(CHANGES) {
            anchors.entry(key(reading)).or_insert((k, i));
        }
    }
    let mut is_shared: Vec<Vec<bool>> = later.iter().map(|readings| vec![false; readings.len()]).collect();
    let is_same = |a: &T, b: &T| key(a) == key(b);
    for readings in before {
        let (mut at, mut counted) = (0, 0);
        while let Some(reading) = readings.get(at) {
            let Some(&(k, i)) = anchors.get(&key(reading)) else {
                at += 1;
                continue;
            };
            let own = later[k];
            let (past, own_past) = (readings[counted..at].iter().rev(), own[..i].iter().rev());
            let back = past.zip(own_past).take_while(|(a, b)| is_same(a, b)).count();
            let forth = readings[at..].iter().zip(&own[i..]).take_while(|(a, b)| is_same(a, b)).count();
            let run = i - back..i + forth;
            let begins = run.start == 0 || at == back;
            at += forth;
            let ends = run.end == own.len() || at == readings.len();
            let changes = own[run.clone()].windows(2).filter(|pair| !is_same(&pair[0], &pair[1])).count();
            let least = if begins && ends { CHANGES } else { MANY };
            if changes >= least {
                is_shared[k][run].fill(true);
                counted = at;
            }
        }
    }
    is_shared.iter().flatten().filter(|shared| **shared).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(before: &[&[u64]], later: &[&[u64]]) -> usize {
        shared(before, later, |reading| [*reading])
    }

    /// What two files hold of one measurement is counted, wherever it begins in either, and once however often it stands before.
    #[test]
    fn readings_of_one_measurement_are_counted_once() {
        let all: Vec<u64> = (0..100).map(|k| k * k).collect();
        let (first, second) = (&all[..70], &all[60..]);
        assert_eq!((of(&[first], &[second]), of(&[second], &[first])), (10, 10));
        assert_eq!(of(&[&all], &[&all[33..51]]), 18);
        assert_eq!(of(&[&all[33..51]], &[&all]), 18);
        assert_eq!(of(&[&all, &all], &[&all]), 100);
        assert_eq!(of(&[&all[..20], &all[40..60]], &[&all[5..50]]), 15 + 10);
        assert_eq!(of(&[&all[..50]], &[&all[50..]]), 0);
        assert_eq!((of(&[], &[&all]), of(&[&all], &[])), (0, 0));
    }

    /// Eight changes in common are of one measurement, and seven may be chance. Readings at rest are alike however many they are, and before a
    /// motion that both have they hide no part of it.
    #[test]
    fn rest_is_alike_without_a_measurement_in_common() {
        let all: Vec<u64> = (0..40).map(|k| k * k).collect();
        for (common, expected) in [(8, 0), (9, 9)] {
            assert_eq!(of(&[&all[..20]], &[&all[20 - common..]]), expected, "{common}");
        }
        let rest = [7; 500];
        assert_eq!(of(&[&rest], &[&rest]), 0);
        let [one, other] = [[&rest[..30], &all[..]].concat(), [&rest[..], &all[..20]].concat()];
        // with as much of the rest as both have
        assert_eq!(of(&[&one], &[&other]), 50);
    }

    /// What is alike in the midst of both counts from 64 changes on, as where one file misses readings of the other.
    #[test]
    fn runs_in_the_midst_are_long() {
        for (common, expected) in [(64, 0), (65, 65)] {
            let motion: Vec<u64> = (0..common).map(|k| 1000 + k * k).collect();
            let with = |end: u64| [&[end], &motion[..], &[end + 1]].concat();
            assert_eq!(of(&[&with(1)], &[&with(5)]), expected);
        }
    }
}
