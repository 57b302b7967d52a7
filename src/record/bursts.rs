//! Bursts: samples in a row that neither side foresees, while those before and after them agree with one another.
//!
//! A jump is foreseen by the side before it up to where it happens, and from there on by the side after it, and so is a rate that
//! bends where a torque begins: neither has a sample that both sides fail to foresee.

use core::ops::{Range, RangeInclusive};

use nalgebra::Vector3;

use super::median::median;
use super::polynomial::Polynomial;

/// The longest run that is sought, and samples on either side that must agree: first so many that they do not all lie in another
/// burst, then few, as another may be near.
const TIERS: [(usize, usize); 2] = [(16, 8), (8, 5)];
/// Samples that are enough for a side where the record ends.
const AT_THE_END: usize = 3;
/// Samples beside a run among which those of a side are sought.
const REACH: usize = 16;
/// Samples on each side among which the usual deviation is sought.
const NEIGHBOURS: usize = 25;
/// Samples of a fourth difference, and the sum of the squares of its weights.
const FOURTH: (usize, f64) = (5, 70.0);
/// Usual fourth differences that one across an end of a burst exceeds.
const EDGE: f64 = 4.0;
/// Usual deviations of the record that those beside a burst are below: louder samples follow blows, or a motion too fast for the sampling.
const LOUD: f64 = 4.0;
/// Samples by which one side foresees the next, and the degree of the polynomial through them.
const SIDE: (usize, usize) = (5, 2);
/// Usual deviations by which a side does not foresee the end of a burst that is next to it.
const UNFORESEEN: f64 = 3.0;
/// Degrees of the polynomial through both sides.
const DEGREES: RangeInclusive<usize> = 2..=5;
/// Deviations of the noise that the sides have from it in the mean square, at most.
const AGREE: f64 = 1.7;
/// Usual deviations that both ends of a burst have from it, and more than half of its samples.
const FAR: f64 = 6.0;
/// Usual deviations that a sample within a burst has from it, so that it is left out too.
const OFF: f64 = 3.0;
/// So many degrees more change the deviations of both ends by less than the part `1 / STEADY`: otherwise the motion is too fast for the
/// sampling.
const MORE: usize = 2;
const STEADY: f64 = 2.0;
/// Median length of a vector of three normal components of variance 1.
const MEDIAN: f64 = 1.538_172_254_455_052;

/// A burst.
#[derive(Debug, PartialEq)]
pub(super) struct Burst {
    /// From its first sample to its last.
    pub(super) run: Range<usize>,
    /// Those of its samples that are no spikes and that both sides do not foresee, ascending.
    pub(super) off: Vec<usize>,
}

/// The bursts among samples at `places` from which `spikes` are left out, ascending.
pub(super) fn bursts(places: &[f64], rates: &[Vector3<f64>], spikes: &[usize]) -> Vec<Burst> {
    let Some(mut search) = Search::new(places, rates, spikes) else { return Vec::new() };
    let mut found = Vec::new();
    loop {
        let more = search.pass();
        if more.is_empty() {
            break;
        }
        found.extend(more);
    }
    found.sort_unstable_by_key(|burst: &Burst| burst.run.start);
    found
}

/// Where a side of a run lies.
#[derive(Clone, Copy)]
enum Side {
    Before,
    After,
}

struct Search<'a> {
    /// In units of the usual interval.
    places: &'a [f64],
    rates: &'a [Vector3<f64>],
    /// Lengths of the fourth differences, in units of their noise, and the usual one.
    fourth: Vec<f64>,
    usual: f64,
    /// Samples of those that stand out.
    edges: Vec<usize>,
    /// Samples that are no spikes, and those of them that are in no burst so far.
    whole: Vec<bool>,
    left: Vec<bool>,
}

impl<'a> Search<'a> {
    /// `None` where the samples have no noise.
    fn new(places: &'a [f64], rates: &'a [Vector3<f64>], spikes: &[usize]) -> Option<Self> {
        let (length, squares) = FOURTH;
        let difference = |w: &[Vector3<f64>]| w[0] + w[4] - (w[1] + w[3]) * 4.0 + w[2] * 6.0;
        let fourth: Vec<f64> = rates.windows(length).map(|w| difference(w).norm() / squares.sqrt()).collect();
        let usual = median(&mut fourth.clone()).filter(|usual| *usual > 0.0)?;
        let mut whole = vec![true; rates.len()];
        spikes.iter().for_each(|&i| whole[i] = false);
        let mut search =
            Search { places, rates, fourth, usual, edges: Vec::new(), left: whole.clone(), whole };
        let mut is_edge = vec![false; rates.len()];
        for (i, own) in search.fourth.iter().enumerate().filter(|(_, own)| **own > EDGE * usual) {
            let near = search.near(i + length / 2);
            if *own > EDGE * near && near < LOUD * usual {
                is_edge[i..i + length].fill(true);
            }
        }
        search.edges = (0..rates.len()).filter(|&i| is_edge[i]).collect();
        Some(search)
    }

    /// The usual fourth difference near a sample.
    fn near(&self, i: usize) -> f64 {
        let middle = i.saturating_sub(FOURTH.0 / 2).min(self.fourth.len() - 1);
        let near = middle.saturating_sub(NEIGHBOURS)..(middle + NEIGHBOURS + 1).min(self.fourth.len());
        median(&mut self.fourth[near].to_vec()).unwrap_or(self.usual)
    }

    /// Bursts beside those found before.
    fn pass(&mut self) -> Vec<Burst> {
        let unforeseen = |side: Side| {
            let edges = self.edges.iter().copied();
            edges.filter(|&i| self.left[i] && self.is_unforeseen(i, side)).collect::<Vec<_>>()
        };
        let (starts, ends) = (unforeseen(Side::Before), unforeseen(Side::After));
        let mut found = Vec::new();
        for (longest, count) in TIERS {
            for length in 2..=longest {
                for &start in &starts {
                    let run = start..start + length;
                    if ends.binary_search(&(run.end - 1)).is_ok()
                        && self.left[start]
                        && self.left[run.end - 1]
                        && let Some(off) = self.off(run.clone(), count)
                    {
                        self.left[run.clone()].fill(false);
                        found.push(Burst { run, off });
                    }
                }
            }
        }
        found
    }

    /// Whether what lies next to a sample on one side does not foresee it; beside samples that are left out it may not.
    fn is_unforeseen(&self, i: usize, side: Side) -> bool {
        let next = match side {
            Side::Before => i.checked_sub(1),
            Side::After => Some(i + 1),
        };
        if next.and_then(|next| self.left.get(next)) == Some(&false) {
            return true;
        }
        self.deviation(&self.left, i, side).filter(|own| *own > UNFORESEEN * self.usual).is_some_and(|own| {
            let near = i.saturating_sub(NEIGHBOURS)..(i + NEIGHBOURS + 1).min(self.rates.len());
            let mut near: Vec<f64> = near.filter_map(|k| self.deviation(&self.whole, k, side)).collect();
            median(&mut near).is_some_and(|near| own > UNFORESEEN * near)
        })
    }

    /// How far a sample is from what one side foresees, in units of the noise.
    fn deviation(&self, left: &[bool], i: usize, side: Side) -> Option<f64> {
        let (count, degree) = SIDE;
        let nodes = nearest(left, i..i + 1, side, count);
        let is_enough =
            nodes.len() == count || nodes.len() >= AT_THE_END && ends(left, i..i + 1, side, count);
        is_enough.then(|| {
            let mut through = Polynomial::new(self.places, self.rates, &nodes, &[i]);
            (0..=degree).for_each(|_| through.raise());
            through.rest[nodes.len()].norm() / through.noise[nodes.len()].sqrt()
        })
    }

    /// The samples of a run that do not agree with its sides; `None` where these do not agree with each other, or the run with them.
    fn off(&self, run: Range<usize>, count: usize) -> Option<Vec<usize>> {
        let side = |side: Side| {
            let nodes = nearest(&self.left, run.clone(), side, count);
            let least = if ends(&self.left, run.clone(), side, count) { AT_THE_END } else { count };
            Some(nodes).filter(|nodes| nodes.len() >= least)
        };
        let (mut nodes, after) = side(Side::Before).zip(side(Side::After))?;
        nodes.extend(after);
        let usual = self.usual.max(self.near(run.start)).max(self.near(run.end - 1));
        let most = AGREE * usual / MEDIAN;
        let inside: Vec<usize> = run.filter(|&k| self.left[k]).collect();
        let sides = nodes.len();
        let mut through = Polynomial::new(self.places, self.rates, &nodes, &inside);
        for degree in 0..=*DEGREES.end() {
            if sides <= degree + 1 + MORE {
                return None;
            }
            through.raise();
            let square: f64 = through.rest[..sides].iter().map(Vector3::norm_squared).sum();
            let dof = 3 * (sides - degree - 1);
            if degree >= *DEGREES.start() && square <= most * most * dof as f64 {
                break;
            }
            if degree == *DEGREES.end() {
                return None;
            }
        }
        let rest = through.rest[sides..].to_vec();
        let noise = through.noise[sides..].iter().map(|noise| usual * noise.sqrt());
        let deviations: Vec<f64> = rest.iter().zip(noise).map(|(rest, noise)| rest.norm() / noise).collect();
        let ends = [0, inside.len() - 1];
        let far = deviations.iter().filter(|deviation| **deviation > FAR).count();
        if ends.iter().any(|&k| deviations[k] <= FAR) || 2 * far <= inside.len() {
            return None;
        }
        (0..MORE).for_each(|_| through.raise());
        let is_steady = |&k: &usize| rest[k].norm() > STEADY * (rest[k] - through.rest[sides + k]).norm();
        if !ends.iter().all(is_steady) {
            return None;
        }
        let off = inside.into_iter().zip(deviations).filter(|(_, deviation)| *deviation > OFF);
        Some(off.map(|(k, _)| k).collect())
    }
}

/// Up to `count` samples that are left beside a run, the nearest first.
fn nearest(left: &[bool], run: Range<usize>, side: Side, count: usize) -> Vec<usize> {
    match side {
        Side::Before => {
            (run.start.saturating_sub(REACH)..run.start).rev().filter(|&k| left[k]).take(count).collect()
        }
        Side::After => {
            (run.end..(run.end + REACH).min(left.len())).filter(|&k| left[k]).take(count).collect()
        }
    }
}

/// Whether the record ends within `count` samples beside a run.
fn ends(left: &[bool], run: Range<usize>, side: Side, count: usize) -> bool {
    match side {
        Side::Before => run.start < count,
        Side::After => run.end + count > left.len(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::spikes::places;
    use super::*;
    use crate::num::Random;

    const NOISE: f64 = 1e-2;

    /// Samples of a slow motion with noise, 100 a second.
    fn slow(count: u32, random: &mut Random) -> Vec<Vector3<f64>> {
        let times = (0..count).map(|i| 0.01 * f64::from(i));
        times
            .map(|t| Vector3::new(libm::sin(t), libm::cos(1.3 * t), 0.2) + random.normal_vector() * NOISE)
            .collect()
    }

    fn found(rates: &[Vector3<f64>], spikes: &[usize]) -> Vec<Burst> {
        let times: Vec<f64> = (0..rates.len()).map(|i| 0.01 * i as f64).collect();
        bursts(&places(&times), rates, spikes)
    }

    #[test]
    fn bursts_are_found_from_their_first_sample_to_their_last() {
        let mut random = Random::new(5);
        let still = slow(400, &mut random);
        assert_eq!(found(&still, &[]), []);
        for length in 2..=8 {
            let mut rates = still.clone();
            // near the beginning, in the middle, and with a spike in it
            for start in [4, 200, 300] {
                rates[start..start + length].iter_mut().for_each(|rate| rate.y += 50.0 * NOISE);
            }
            let expected = [4, 200]
                .map(|start| Burst { run: start..start + length, off: (start..start + length).collect() });
            assert_eq!(found(&rates, &[])[..2], expected);
            let with_spike = Burst { run: 301..300 + length, off: (301..300 + length).collect() };
            assert!(length == 2 || found(&rates, &[300])[2..] == [with_spike], "{length}");
        }
    }

    #[test]
    fn two_bursts_near_each_other_are_found_without_the_samples_between() {
        let mut random = Random::new(6);
        let still = slow(200, &mut random);
        for apart in [1, 2, 3, 6, 12] {
            let mut rates = still.clone();
            let second = 104 + apart;
            rates[100..104].iter_mut().for_each(|rate| rate.y += 50.0 * NOISE);
            rates[second..second + 3].iter_mut().for_each(|rate| rate.z -= 50.0 * NOISE);
            let off: Vec<usize> = found(&rates, &[]).into_iter().flat_map(|burst| burst.off).collect();
            assert_eq!(off, (100..104).chain(second..second + 3).collect::<Vec<_>>(), "{apart}");
        }
    }

    /// A blow changes the rate within some samples, by five to a thousand deviations.
    #[test]
    fn blows_and_torques_that_begin_or_end_are_no_bursts() {
        let mut random = Random::new(7);
        for length in [1, 2, 3, 5, 8, 16] {
            for size in [5.0, 10.0, 20.0, 30.0, 40.0, 50.0, 70.0, 100.0, 200.0, 1000.0] {
                let grown = |i: usize| (i.saturating_sub(100) as f64 / length as f64).min(1.0);
                let rates = slow(200, &mut random);
                let blow = random.normal_vector().normalize() * (size * NOISE);
                let blown: Vec<_> =
                    rates.iter().enumerate().map(|(i, rate)| rate + blow * grown(i)).collect();
                assert_eq!(found(&blown, &[]), [], "{length} {size}");
                let bent: Vec<_> = rates
                    .iter()
                    .enumerate()
                    .map(|(i, rate)| rate + blow * (i.saturating_sub(100) as f64 / 10.0))
                    .collect();
                assert_eq!(found(&bent, &[]), [], "{size}");
            }
        }
    }

    #[test]
    fn samples_without_noise_and_too_few_have_no_bursts() {
        let mut rates: Vec<_> = (0..60).map(|_| Vector3::new(1.0, 2.0, 3.0)).collect();
        rates[30..33].fill(Vector3::zeros());
        assert_eq!(found(&rates, &[]), []);
        (0..12).for_each(|count| assert_eq!(found(&rates[24..24 + count], &[]), []));
    }
}
