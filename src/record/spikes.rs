//! Samples that stand out of their neighbours: Hampel's rule about what short polynomials through them foresee.
//!
//! Source: Hampel 1974, Journal of the American Statistical Association 69, 383, with predictions in place of the median,
//! since rates of a tumbling body have slopes.

use std::collections::BTreeMap;

use nalgebra::Vector3;

/// A sample that was left out because it stands out of its neighbours.
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

/// Indices of the spikes among samples at nearly even times, ascending.
///
/// A sample counts as one only if neither side foresees it: those beside a jump have a side without it. What is found is no
/// neighbour of the others any more.
pub(super) fn spikes(rates: &[Vector3<f64>]) -> Vec<usize> {
    let mut scores = Scores::new(rates);
    // where the motion is too fast for the sampling, all samples deviate
    let stands_out = |scores: &Scores, i: usize| {
        let own = scores.at(i);
        if !own.is_far() {
            return false;
        }
        let around = i.saturating_sub(NEIGHBOURS)..(i + NEIGHBOURS + 1).min(rates.len());
        let mut near: Vec<f64> = around.map(|k| scores.at(k).middle).collect();
        median(&mut near).is_some_and(|near| own.middle > FAR * near)
    };
    let mut suspects: Vec<usize> = (0..rates.len()).filter(|&i| stands_out(&scores, i)).collect();
    let mut left = vec![true; if suspects.is_empty() { 0 } else { rates.len() }];
    let mut found = Vec::new();
    let around = |i: usize, reach: usize| i.saturating_sub(reach)..(i + reach + 1).min(rates.len());
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
    found.sort_unstable();
    found
}

/// The scores of all samples. They are computed when they are asked for: of a long record there are few that matter.
struct Scores<'a> {
    rates: &'a [Vector3<f64>],
    all: Vec<bool>,
    /// The median deviation of each set.
    usual: Deviations,
    /// Those that samples left out have changed.
    changed: BTreeMap<usize, Score>,
}

impl<'a> Scores<'a> {
    fn new(rates: &'a [Vector3<f64>]) -> Self {
        let all = vec![true; rates.len()];
        let mut of_set: Vec<f64> = Vec::with_capacity(rates.len());
        let usual = core::array::from_fn(|set| {
            of_set.clear();
            let each = (0..rates.len()).map(|i| deviations(rates, &all, i, [set])[0]);
            of_set.extend(each.filter(|deviation| deviation.is_finite()));
            median(&mut of_set).unwrap_or(0.0)
        });
        Scores { rates, all, usual, changed: BTreeMap::new() }
    }

    /// The score of a sample so far.
    fn at(&self, i: usize) -> Score {
        self.changed.get(&i).copied().unwrap_or_else(|| self.among(&self.all, i))
    }

    /// The same among those that are `left`.
    fn among(&self, left: &[bool], i: usize) -> Score {
        let of_sets: Deviations = deviations(self.rates, left, i, core::array::from_fn(|set| set));
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

/// The deviation of a sample from its prediction by each of some sets, in units of their noise; infinite where neighbours are missing.
fn deviations<const N: usize>(rates: &[Vector3<f64>], left: &[bool], i: usize, sets: [usize; N]) -> [f64; N] {
    // the usual case, whose weights are constants
    let span = i.wrapping_sub(FARTHEST)..=i + FARTHEST;
    if i >= FARTHEST && left.get(span).is_some_and(|span| span.iter().all(|left| *left)) {
        return sets.map(|set| {
            let (mut rest, mut noise) = (rates[i], 1.0);
            for (node, weight) in SETS[set].iter().zip(WEIGHTS[set]).filter(|(node, _)| **node != 0) {
                rest -= rates[i.wrapping_add_signed(*node)] * weight;
                noise += weight * weight;
            }
            rest.norm() / noise.sqrt()
        });
    }
    let before = (0..i).rev().filter(|&k| left[k]);
    let after = (i + 1..rates.len()).filter(|&k| left[k]);
    let (mut low, mut high) = ([None; FARTHEST], [None; FARTHEST]);
    before.zip(&mut low).for_each(|(k, slot)| *slot = Some(k));
    after.zip(&mut high).for_each(|(k, slot)| *slot = Some(k));
    sets.map(|set| {
        let mut nodes = [0; 4];
        let mut count = 0;
        for (slot, &place) in nodes.iter_mut().zip(SETS[set].iter().filter(|place| **place != 0)) {
            let side = if place < 0 { &low } else { &high };
            let Some(node) = side[place.unsigned_abs() - 1] else { return f64::INFINITY };
            *slot = node;
            count += 1;
        }
        let offsets = nodes.map(|k| k as f64 - i as f64);
        let (mut rest, mut noise) = (rates[i], 1.0);
        for k in 0..count {
            let others = (0..count).filter(|&l| l != k);
            let weight: f64 = others.map(|l| offsets[l] / (offsets[l] - offsets[k])).product();
            rest -= rates[nodes[k]] * weight;
            noise += weight * weight;
        }
        rest.norm() / noise.sqrt()
    })
}

fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    if values.is_empty() { None } else { Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Random;

    #[test]
    fn spikes_are_found_and_samples_beside_them_kept() {
        let mut random = Random::new(3);
        let mut rates: Vec<Vector3<f64>> = (0..2000)
            .map(|i| {
                let t = 0.01 * f64::from(i);
                Vector3::new(libm::sin(t), libm::cos(1.3 * t), 0.2) + random.normal_vector() * 1e-2
            })
            .collect();
        assert_eq!(spikes(&rates).len(), 0);
        let at = [3, 500, 501, 505, 1200, 1996];
        for i in at {
            rates[i].y += 0.5;
        }
        assert_eq!(spikes(&rates), at);
    }

    #[test]
    fn spikes_beside_each_other_are_found_at_every_distance_and_sign() {
        let mut random = Random::new(4);
        let still: Vec<Vector3<f64>> = (0..200)
            .map(|i| {
                let t = 0.01 * f64::from(i);
                Vector3::new(libm::sin(t), libm::cos(1.3 * t), 0.2) + random.normal_vector() * 1e-2
            })
            .collect();
        for (apart, size) in (1..6).flat_map(|apart| [(apart, 0.5), (apart, -0.5)]) {
            let mut rates = still.clone();
            rates[100].y += 0.5;
            rates[100 + apart].y += size;
            assert_eq!(spikes(&rates), [100, 100 + apart], "{size}");
        }
    }

    #[test]
    fn a_jump_and_noiseless_samples_have_no_spikes() {
        let mut rates: Vec<Vector3<f64>> =
            (0..400).map(|i| Vector3::new(libm::sin(0.02 * f64::from(i)), 1.0, 0.0)).collect();
        assert!(spikes(&rates).is_empty());
        for rate in &mut rates[200..] {
            rate.z += 3.0;
        }
        assert!(spikes(&rates).is_empty());
    }
}
