//! Samples that stand out of their neighbours: Hampel's rule about what short polynomials through them foresee.
//!
//! Source: Hampel 1974, Journal of the American Statistical Association 69, 383, with predictions in place of the median,
//! since rates of a tumbling body have slopes.

use core::ops::Range;
use std::collections::BTreeMap;

use nalgebra::Vector3;

use super::both::both;
use super::median::median;

/// A sample that was left out because it stands out of its neighbours, alone or with others in a burst.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spike {
    /// Index of the segment in the record.
    pub segment: usize,
    /// Index of the sample in the segment.
    pub sample: usize,
    /// Its time, s.
    pub time: f64,
    /// Its line in the file, from 1; of a record that is not read from a text its place among the samples.
    pub line: usize,
    /// The number in the segment, from 0, of the burst that it lies in; `None` of one that stands alone.
    pub burst: Option<usize>,
}

impl Spike {
    /// How many of `spikes`, which are in the order of the record, lie in bursts, and in how many of these.
    #[must_use]
    pub fn bursts(spikes: &[Spike]) -> (usize, usize) {
        let in_bursts = || spikes.iter().filter_map(|spike| Some((spike.segment, spike.burst?)));
        let changes = in_bursts().zip(in_bursts().skip(1)).filter(|(a, b)| a != b).count();
        let samples = in_bursts().count();
        (samples, changes + usize::from(samples > 0))
    }
}

/// Sets of neighbours that foresee a sample: -2 is the second before it, 3 the third after it, 0 none.
const SETS: [[isize; 4]; 7] = [
    [-1, -2, 1, 2],
    [-1, -2, -3, 1],
    [-1, 1, 2, 3],
    [-1, -2, -3, 0],
    [1, 2, 3, 0],
    [-1, -2, -4, 0],
    [1, 2, 4, 0],
];
/// The weights of the neighbours in each set where none is missing.
const WEIGHTS: [[f64; 4]; 7] = [
    [2.0 / 3.0, -1.0 / 6.0, 2.0 / 3.0, -1.0 / 6.0],
    [1.5, -1.0, 0.25, 0.25],
    [0.25, 1.5, -1.0, 0.25],
    [3.0, -3.0, 1.0, 0.0],
    [3.0, -3.0, 1.0, 0.0],
    [8.0 / 3.0, -2.0, 1.0 / 3.0, 0.0],
    [8.0 / 3.0, -2.0, 1.0 / 3.0, 0.0],
];
/// Samples of which two halves are gone through side by side.
const MANY: usize = 100_000;
/// The farthest neighbour of a set.
const FARTHEST: usize = 4;
/// Sets on one side of a sample, those before and those after it; of two the worse counts, as a second spike may be such that
/// one of them foresees the first.
const SIDES: [[usize; 2]; 2] = [[3, 5], [4, 6]];
/// Samples on each side among which the usual deviation is sought.
const NEIGHBOURS: usize = 25;
/// Samples on each side whose predictions a spike may change.
const SPAN: usize = 12;
/// Usual deviations that a spike exceeds by the median of its predictions: normal noise does so once in 1e17 samples.
const FAR: f64 = 6.0;
/// The same by the predictions of either side: beside a jump one side is as usual, which noise alone doubles in one sample of thirty.
const EVERY: f64 = 2.0;
/// The deviation over the difference of two predictions, at least: what one prediction is off by where the motion is too fast for
/// the sampling, another is not, as their errors have other signs or powers of the interval.
const AGREE: f64 = 2.0;
/// Pairs of predictions that must agree.
const PAIRS: [[[isize; 4]; 2]; 3] = [[SETS[0], SETS[1]], [SETS[0], SETS[2]], [SETS[1], SETS[2]]];
/// The same of the first and last two samples, which too few of these sets foresee.
const PAIRS_AT_THE_END: [[[isize; 4]; 2]; 2] = [[SETS[3], [-1, -2, -3, -4]], [SETS[4], [1, 2, 3, 4]]];

/// Places of samples at nearly even ascending `times`, in units of the usual interval: whole numbers, of which lost rows leave some out.
pub(super) fn places(times: &[f64]) -> Vec<f64> {
    let intervals: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let usual = median(&mut intervals.clone()).unwrap_or(1.0);
    let mut place = 0.0;
    let steps = intervals.into_iter().map(|interval| {
        place += (interval / usual).round().max(1.0);
        place
    });
    core::iter::once(0.0).chain(steps).take(times.len()).collect()
}

/// Indices of the spikes among samples at `places`, ascending.
///
/// A sample counts as one only if neither side foresees it: those beside a jump have a side without it. What is found is no
/// neighbour of the others any more. What is left after that must foresee it alike from either side and from both: otherwise the
/// motion bends there more than its samples tell.
pub(super) fn spikes(places: &[f64], rates: &[Vector3<f64>]) -> Vec<usize> {
    let samples = Samples { places, rates };
    let mut scores = Scores::new(samples);
    let around = |i: usize, reach: usize| i.saturating_sub(reach)..(i + reach + 1).min(rates.len());
    // where the motion is too fast for the sampling, all samples deviate
    let stands_out = |scores: &Scores, i: usize| {
        if !scores.may_be_far(i) {
            return false;
        }
        let own = scores.at(i);
        if !own.is_far() {
            return false;
        }
        let mut near: Vec<f64> = around(i, NEIGHBOURS).map(|k| scores.at(k).middle).collect();
        median(&mut near).is_some_and(|near| own.middle > FAR * near)
    };
    let among = |range: Range<usize>| range.filter(|&i| stands_out(&scores, i)).collect::<Vec<usize>>();
    let middle = rates.len() / 2;
    let (mut suspects, after) = both(samples.are_many(), || among(0..middle), || among(middle..rates.len()));
    suspects.extend(after);
    let mut left = vec![true; if suspects.is_empty() { 0 } else { rates.len() }];
    let mut found = Vec::new();
    while let Some(worst) = (0..suspects.len())
        .max_by(|&a, &b| scores.at(suspects[a]).first.total_cmp(&scores.at(suspects[b]).first))
    {
        let spike = suspects.swap_remove(worst);
        found.push(spike);
        left[spike] = false;
        for i in around(spike, SPAN).filter(|&i| left[i]) {
            scores.changed.insert(i, scores.among(&left, i));
        }
        // without the spike among their neighbours others may stand out, or no longer do
        suspects.retain(|&i| i.abs_diff(spike) > NEIGHBOURS);
        suspects.extend(around(spike, NEIGHBOURS).filter(|&i| left[i] && stands_out(&scores, i)));
    }
    // a sample between two spikes may have looked worse than they do
    found.retain(|&i| {
        let keep = scores.among(&left, i).is_far();
        left[i] = !keep;
        keep
    });
    // one that goes back among the others may show that those next to it are no spikes either
    let mut is_found: Vec<bool> = left.iter().map(|left| !left).collect();
    let mut is_open = is_found.clone();
    let mut open = found.clone();
    while let Some(i) = open.pop() {
        is_open[i] = false;
        if scores.among(&left, i).is_far() && samples.predictions_agree(&left, i) {
            continue;
        }
        (is_found[i], left[i]) = (false, true);
        let closed = around(i, SPAN).filter(|&k| is_found[k] && !core::mem::replace(&mut is_open[k], true));
        open.extend(closed);
    }
    found.retain(|&i| is_found[i]);
    found.sort_unstable();
    found
}

/// The scores of all samples. They are computed when they are asked for: of a long record there are few that matter.
struct Scores<'a> {
    samples: Samples<'a>,
    all: Vec<bool>,
    /// The median deviation of each set.
    usual: Deviations,
    /// Those that samples left out have changed.
    changed: BTreeMap<usize, Score>,
}

impl<'a> Scores<'a> {
    fn new(samples: Samples<'a>) -> Self {
        let rates = samples.rates;
        let all = vec![true; rates.len()];
        let of_sets = |sets: Range<usize>| {
            let mut of_set: Vec<f64> = Vec::with_capacity(rates.len());
            let each = sets.map(|set| {
                of_set.clear();
                let each = (0..rates.len()).map(|i| samples.deviations(&all, i, [set])[0]);
                of_set.extend(each.filter(|deviation| deviation.is_finite()));
                median(&mut of_set).unwrap_or(0.0)
            });
            each.collect::<Vec<f64>>()
        };
        let middle = SETS.len() / 2;
        let (first, second) = both(samples.are_many(), || of_sets(0..middle), || of_sets(middle..SETS.len()));
        let mut usual = [0.0; SETS.len()];
        usual.iter_mut().zip(first.into_iter().chain(second)).for_each(|(usual, of_set)| *usual = of_set);
        Scores { samples, all, usual, changed: BTreeMap::new() }
    }

    /// Whether that of a sample can be far: where three predictions are near, the middle one of at most five is.
    fn may_be_far(&self, i: usize) -> bool {
        let first = self.samples.deviations(&self.all, i, [0, 1, 2]);
        self.changed.contains_key(&i) || !(0..3).all(|k| first[k] / self.usual[k] <= FAR)
    }

    /// The score of a sample so far.
    fn at(&self, i: usize) -> Score {
        self.changed.get(&i).copied().unwrap_or_else(|| self.among(&self.all, i))
    }

    /// The same among those that are `left`.
    fn among(&self, left: &[bool], i: usize) -> Score {
        let of_sets: Deviations = self.samples.deviations(left, i, core::array::from_fn(|set| set));
        let relative = |k: usize| Some(of_sets[k] / self.usual[k]).filter(|s| s.is_finite());
        let sides = SIDES.map(|sets| sets.into_iter().filter_map(relative).reduce(f64::max));
        let (mut each, mut count) = ([0.0; 5], 0);
        for score in (0..3).map(relative).chain(sides).flatten() {
            each[count] = score;
            count += 1;
        }
        let each = &mut each[..count];
        let first = each.first().copied().unwrap_or(0.0);
        let least = sides.into_iter().flatten().fold(f64::INFINITY, f64::min);
        Score { first, least, middle: median(each).unwrap_or(0.0) }
    }
}

/// How far neither side foresees a sample, in usual deviations, and the median of all predictions.
#[derive(Clone, Copy)]
struct Score {
    /// By the set with the least noise: of a spike it is larger than of those beside it.
    first: f64,
    least: f64,
    middle: f64,
}

impl Score {
    fn is_far(&self) -> bool {
        self.least.is_finite() && self.least > EVERY && self.middle > FAR
    }
}

type Deviations = [f64; SETS.len()];

/// Samples, and their places in units of the usual interval.
#[derive(Clone, Copy)]
struct Samples<'a> {
    places: &'a [f64],
    rates: &'a [Vector3<f64>],
}

impl Samples<'_> {
    /// Whether two threads are done with them sooner than one.
    fn are_many(&self) -> bool {
        self.rates.len() > MANY
    }

    /// The deviation of a sample from its prediction by each of some sets, in units of their noise; infinite where neighbours are missing.
    fn deviations<const N: usize>(&self, left: &[bool], i: usize, sets: [usize; N]) -> [f64; N] {
        let rates = self.rates;
        // the usual case, whose weights are constants
        let span = i.wrapping_sub(FARTHEST)..=i + FARTHEST;
        if i >= FARTHEST
            && left.get(span).is_some_and(|span| span.iter().all(|left| *left))
            && self.places[i + FARTHEST] - self.places[i - FARTHEST] == (2 * FARTHEST) as f64
        {
            return sets.map(|set| {
                let (mut rest, mut noise) = (rates[i], 1.0);
                for (node, weight) in SETS[set].iter().zip(WEIGHTS[set]).filter(|(node, _)| **node != 0) {
                    rest -= rates[i.wrapping_add_signed(*node)] * weight;
                    noise += weight * weight;
                }
                rest.norm() / noise.sqrt()
            });
        }
        let neighbours = Neighbours::of(left, i);
        sets.map(|set| {
            let Ok((nodes, count)) = neighbours.nodes(&SETS[set]) else { return f64::INFINITY };
            let (rest, noise) = self.rest(i, &nodes[..count]);
            rest.norm() / noise.sqrt()
        })
    }

    /// What is left of a sample beside the polynomial through some others, and the variance of its noise in units of theirs.
    fn rest(&self, i: usize, nodes: &[usize]) -> (Vector3<f64>, f64) {
        let offset = |k: usize| self.places[nodes[k]] - self.places[i];
        let (mut rest, mut noise) = (self.rates[i], 1.0);
        for k in 0..nodes.len() {
            let others = (0..nodes.len()).filter(|&l| l != k);
            let weight: f64 = others.map(|l| offset(l) / (offset(l) - offset(k))).product();
            rest -= self.rates[nodes[k]] * weight;
            noise += weight * weight;
        }
        (rest, noise)
    }

    /// Whether the predictions of a sample differ by less than it does from each of them.
    fn predictions_agree(&self, left: &[bool], i: usize) -> bool {
        let neighbours = Neighbours::of(left, i);
        let rest =
            |set: &[isize; 4]| neighbours.nodes(set).map(|(nodes, count)| self.rest(i, &nodes[..count]).0);
        let mut has_any = false;
        for pairs in [&PAIRS[..], &PAIRS_AT_THE_END[..]] {
            for [a, b] in pairs {
                match (rest(a), rest(b)) {
                    (Ok(a), Ok(b)) if a.norm().min(b.norm()) > AGREE * (a - b).norm() => has_any = true,
                    (Err(Missing::End), Ok(_) | Err(Missing::End)) | (Ok(_), Err(Missing::End)) => {}
                    _ => return false,
                }
            }
            if has_any {
                break;
            }
        }
        has_any
    }
}

/// The nearest samples left on either side of a sample, and how many there are with those left out.
struct Neighbours {
    before: [Option<usize>; FARTHEST],
    after: [Option<usize>; FARTHEST],
    of_all: [usize; 2],
}

/// Why a sample has no prediction.
enum Missing {
    /// The record ends.
    End,
    /// Samples are left out.
    LeftOut,
}

impl Neighbours {
    fn of(left: &[bool], i: usize) -> Self {
        let (mut before, mut after) = ([None; FARTHEST], [None; FARTHEST]);
        (0..i).rev().filter(|&k| left[k]).zip(&mut before).for_each(|(k, slot)| *slot = Some(k));
        (i + 1..left.len()).filter(|&k| left[k]).zip(&mut after).for_each(|(k, slot)| *slot = Some(k));
        Neighbours { before, after, of_all: [i, left.len() - i - 1] }
    }

    /// The samples of a set, and their number.
    fn nodes(&self, set: &[isize; 4]) -> Result<([usize; 4], usize), Missing> {
        let (mut nodes, mut count) = ([0; 4], 0);
        for &place in set.iter().filter(|place| **place != 0) {
            let (side, all) =
                if place < 0 { (&self.before, self.of_all[0]) } else { (&self.after, self.of_all[1]) };
            let away = place.unsigned_abs();
            nodes[count] = side[away - 1].ok_or(if all < away { Missing::End } else { Missing::LeftOut })?;
            count += 1;
        }
        Ok((nodes, count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Random;

    fn evenly(rates: &[Vector3<f64>]) -> Vec<usize> {
        let times: Vec<f64> = (0..rates.len()).map(|i| 0.01 * i as f64).collect();
        spikes(&places(&times), rates)
    }

    /// Samples of a slow motion with noise, 100 a second.
    fn slow(count: u32, seed: u64) -> Vec<Vector3<f64>> {
        let mut random = Random::new(seed);
        let mut rate =
            |t: f64| Vector3::new(libm::sin(t), libm::cos(1.3 * t), 0.2) + random.normal_vector() * 1e-2;
        (0..count).map(|i| rate(0.01 * f64::from(i))).collect()
    }

    #[test]
    fn spikes_are_found_and_samples_beside_them_kept() {
        let mut rates = slow(2000, 3);
        assert_eq!(evenly(&rates).len(), 0);
        let at = [3, 500, 501, 505, 1200, 1996];
        for i in at {
            rates[i].y += 0.5;
        }
        assert_eq!(evenly(&rates), at);
    }

    #[test]
    fn spikes_beside_each_other_are_found_at_every_distance_and_sign() {
        let still = slow(200, 4);
        for (apart, size) in (1..6).flat_map(|apart| [(apart, 0.5), (apart, -0.5)]) {
            let mut rates = still.clone();
            rates[100].y += 0.5;
            rates[100 + apart].y += size;
            assert_eq!(evenly(&rates), [100, 100 + apart], "{size}");
        }
    }

    #[test]
    fn a_jump_and_noiseless_samples_have_no_spikes() {
        let mut rates: Vec<Vector3<f64>> =
            (0..400).map(|i| Vector3::new(libm::sin(0.02 * f64::from(i)), 1.0, 0.0)).collect();
        assert!(evenly(&rates).is_empty());
        for rate in &mut rates[200..] {
            rate.z += 3.0;
        }
        assert!(evenly(&rates).is_empty());
    }

    /// Of many samples too, at the middle, where two threads meet, and at both ends.
    #[test]
    fn spikes_of_many_samples_are_those_of_few() {
        let mut random = Random::new(5);
        let count = MANY + 4;
        let mut rates: Vec<Vector3<f64>> = (0..count).map(|_| random.normal_vector() * 1e-2).collect();
        let at = [2, count / 2 - 1, count / 2 + 3, count - 3];
        for i in at {
            rates[i].x += 0.5;
        }
        assert_eq!(evenly(&rates), at);
    }
}
