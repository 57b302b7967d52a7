//! Whether the noise of readings was averaged, filtered or interpolated before they were sampled.
//!
//! Five samples that are m apart leave a mean square V(m) of a cubic. Of white noise V is the same for all m. A random walk of the rates, as by torque
//! noise, makes V grow with m, in proportion to W(m) = Σ s_k² (t_k+1 − t_k)/Σ c_i², s_k being the sum of the first k + 1 coefficients c_i. Of both
//! together V(W) is a straight line, whatever their sizes are. A filter lets V grow up to its memory and no further: V bends down, and at 2m
//! it lies above the chord from m to 4m. Of a motion, whose V grows with the eighth power of m, and of differenced noise, whose V falls, it lies below.

use nalgebra::Vector3;
use polhode::record::median;

use crate::signal::noise::off_cubic;
use crate::signal::stretch::Stretch;
use crate::thresholds::filtered::{DITHERED, FEWEST, MOST, SLOW, STRIDES, SURE};
use crate::thresholds::noise::{LEAST, OUTLYING, WHITE};
use crate::thresholds::warnings::RESIDUALS;

/// Noise of readings that is correlated from one to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Filtered {
    /// Correlation of the noise of a reading with that of the next.
    pub(crate) correlation: f64,
    /// Deviation of the noise over many readings, over that which neighbours show.
    pub(crate) times: f64,
}

/// What five samples leave of a cubic, over all their places in a record.
struct Left {
    stride: usize,
    /// Mean square of a component.
    square: f64,
    /// The same by a random walk, a unit of its density.
    walk: f64,
    /// Mean fourth power over the squared mean square, over that of a normal distribution.
    tail: f64,
    /// Places.
    count: f64,
    /// Largest square of a component that counts.
    limit: f64,
}

/// The noise of the readings where it surely was filtered; `rounding` is the variance of their rounding.
pub(crate) fn filtered(stretches: &[Stretch], rounding: f64) -> Option<Filtered> {
    let (turn, steps) = stretches.iter().fold((0.0, 0.0), |(turn, steps), s| {
        (turn + s.duration(), steps + s.times.len().saturating_sub(1) as f64)
    });
    let is_slow = |stride: usize| stride as f64 * turn <= SLOW * steps;
    let strides = (0..STRIDES).map(|k| 1_usize << k).take_while(|stride| is_slow(stride / 8));
    let all: Vec<Left> = strides.map_while(|stride| left(stretches, stride)).collect();
    let of = all.windows(4).rev().find(|of| is_slow(of[0].stride) && is_bent(of))?;
    let (near, far) = (&all[0], &of[2]);
    let each = covariances(stretches, far);
    let [own, next, ..] = each.as_slice() else { return None };
    let long = 2.0 * each.iter().sum::<f64>() - own;
    let is_told = near.square > LEAST && far.square > DITHERED * rounding;
    let found = Filtered { correlation: next / own, times: (long / near.square).max(0.0).sqrt() };
    (is_told && found.correlation > 0.0 && long > RESIDUALS * near.square).then_some(found)
}

/// What five samples that are `stride` apart leave of a cubic, at each place; white noise keeps its variance, and a walk gets the second number, a
/// unit of its density.
fn windows(s: &Stretch, stride: usize) -> impl Iterator<Item = (Vector3<f64>, f64)> + '_ {
    (0..s.times.len().saturating_sub(4 * stride)).map(move |first| {
        let at: [usize; 5] = core::array::from_fn(|i| first + i * stride);
        let t = at.map(|k| s.times[k]);
        let c = off_cubic(t);
        let norm: f64 = c.iter().map(|c| c * c).sum();
        let left = at.iter().zip(c).fold(Vector3::<f64>::zeros(), |sum, (&k, c)| sum + s.rates[k] * c);
        let (mut reached, mut walk) = (0.0, 0.0);
        for (c, t) in c.iter().zip(t.windows(2)) {
            reached += c;
            walk += reached * reached * (t[1] - t[0]);
        }
        (left / norm.sqrt(), walk / norm)
    })
}

/// `None` of too few places.
fn left(stretches: &[Stretch], stride: usize) -> Option<Left> {
    let each = stretches.iter().flat_map(|s| windows(s, stride)).take(MOST);
    let each: Vec<(f64, f64)> = each.map(|(left, walk)| (left.norm_squared() / 3.0, walk)).collect();
    if each.len() < FEWEST {
        return None;
    }
    let mut squares: Vec<f64> = each.iter().map(|(square, _)| *square).collect();
    let limit = OUTLYING * median(&mut squares)?;
    let (mut sum, mut fourth, mut walks, mut count) = (0.0, 0.0, 0.0, 0.0);
    for (square, walk) in each.into_iter().filter(|(square, _)| *square <= limit) {
        sum += square;
        fourth += square * square;
        walks += walk;
        count += 1.0;
    }
    let square = sum / count;
    // the mean of the squares of three normal components has the square 5/3
    let tail = (0.6 * fourth / (count * square * square)).max(1.0);
    Some(Left { stride, square, walk: walks / count, tail, count, limit })
}

/// Whether V bends down, of four strides, each twice the one before, by more than white noise and a walk bring. Vibration makes it fall again.
fn is_bent(of: &[Left]) -> bool {
    let [one, two, four, eight] = of else { return false };
    let share = (two.walk - one.walk) / (four.walk - one.walk);
    let above = two.square - one.square - (four.square - one.square) * share;
    let density = ((four.square - one.square) / (four.walk - one.walk)).max(0.0);
    let white = (one.square - density * one.walk).max(0.0);
    // V of a walk is 20/70 of what it adds from one sample of the stride to the next
    let step = 3.5 * density * one.walk / one.stride as f64;
    let parts = [(share - 1.0, one.stride), (1.0, two.stride), (-share, four.stride)];
    let mut sum = 0.0;
    for (a, one) in parts {
        for (b, other) in parts {
            sum += a * b * squares(one, other, white, step);
        }
    }
    let deviation = (2.0 / (3.0 * four.count) * sum * two.tail).sqrt();
    let rises = four.square * WHITE > two.square && eight.square * WHITE > four.square;
    rises && above > SURE * deviation
}

/// The sum over all lags of the squared covariance of what five evenly spaced samples leave at one stride with that at another, where the noise has the
/// variance `white` and a walk adds `step` from each sample to the next. A mean over n places of squares of such normal numbers has twice this
/// over n for its covariance with the other.
///
/// Source: M. S. Bartlett, J. R. Stat. Soc. Suppl. 8 (1946) 27.
fn squares(one: usize, other: usize, white: f64, step: f64) -> f64 {
    let (one, other) = (one as i64, other as i64);
    let c = [1.0, -4.0, 6.0, -4.0, 1.0];
    let covariance = |lag: i64| {
        let mut sum = 0.0;
        for (a, first) in (0_i64..).zip(c) {
            for (b, second) in (0_i64..).zip(c) {
                let apart = one * a - other * b - lag;
                let own = if apart == 0 { white } else { -0.5 * step * apart.abs() as f64 };
                sum += first * second * own;
            }
        }
        sum / 70.0
    };
    (-4 * other..=4 * one).map(|lag| covariance(lag) * covariance(lag)).sum()
}

/// Covariances of what is left of a reading with the readings up to half a stride later, those at the same place first. As long as the
/// noise is not correlated over half a stride, they are those of the noise itself.
fn covariances(stretches: &[Stretch], of: &Left) -> Vec<f64> {
    let each: Vec<Vec<Vector3<f64>>> =
        stretches.iter().map(|s| windows(s, of.stride).map(|(left, _)| left).collect()).collect();
    let counts = |left: &Vector3<f64>| left.norm_squared() <= 3.0 * of.limit;
    let at = |lag: usize| {
        let pairs = each.iter().flat_map(|own| own.iter().zip(own.iter().skip(lag)));
        let (mut sum, mut count) = (0.0, 0.0);
        for (a, b) in pairs.filter(|(a, b)| counts(a) && counts(b)) {
            sum += a.dot(b) / 3.0;
            count += 1.0;
        }
        sum / f64::max(count, 1.0)
    };
    (0..=of.stride / 2).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use polhode::num::Random;

    const COUNT: usize = 12_000;

    fn white(seed: u64) -> Vec<Vector3<f64>> {
        let mut random = Random::new(seed);
        (0..COUNT).map(|_| random.normal_vector()).collect()
    }

    /// A steady motion, of a hundredth of a radian from one reading to the next, with this noise.
    fn read(noise: &[Vector3<f64>]) -> [Stretch; 1] {
        let times: Vec<f64> = (0..noise.len()).map(|k| 0.01 * k as f64).collect();
        let rate = |t: &f64| Vector3::new(0.6 * libm::sin(*t), 0.6 * libm::cos(*t), 0.8);
        let rates = times.iter().zip(noise).map(|(t, noise)| rate(t) + noise * 1e-2).collect();
        [Stretch::new(times, rates)]
    }

    /// Every so many values the sum of so many.
    fn averaged(noise: &[Vector3<f64>], over: usize) -> Vec<Vector3<f64>> {
        noise.windows(over).map(|own| own.iter().sum()).collect()
    }

    fn walk(noise: &[Vector3<f64>], size: f64) -> Vec<Vector3<f64>> {
        let mut at = Vector3::<f64>::zeros();
        let each = noise.iter().map(|own| {
            at += own * size;
            at
        });
        each.collect()
    }

    /// Squares of the coefficients of (1 − z)⁸ are 12870 in sum, and those of a walk, whose fourth differences are third ones of white steps,
    /// of (1 − z)⁶ 924.
    #[test]
    fn squares_are_those_of_binomial_coefficients() {
        for stride in [1, 2, 4] {
            assert!((squares(stride, stride, 2.0, 0.0) - 4.0 * 12_870.0 / 4_900.0).abs() < 1e-12);
        }
        assert!((squares(1, 1, 0.0, 3.0) - 9.0 * 924.0 / 4_900.0).abs() < 1e-12);
    }

    /// Samples of a cubic leave nothing, and a walk 20/70 of its step.
    #[test]
    fn five_samples_leave_nothing_of_a_cubic() {
        let times: Vec<f64> = (0..40).map(|k| 0.1 * f64::from(k)).collect();
        let cubic = |t: &f64| Vector3::new(1.0 + t * t * t, t - 2.0 * t * t, 0.5 * t);
        let s = Stretch::new(times.clone(), times.iter().map(cubic).collect());
        for stride in [1, 2, 4] {
            let found: Vec<(Vector3<f64>, f64)> = windows(&s, stride).collect();
            assert_eq!(found.len(), 40 - 4 * stride);
            for (left, walk) in found {
                assert!(left.norm() < 1e-11 && (walk / (0.1 * stride as f64) - 20.0 / 70.0).abs() < 1e-9);
            }
        }
    }

    /// Means over N readings are correlated by 1 − 1/N from one to the next. Over many readings they count N times as much as white noise of
    /// their variance, and neighbours show 14/70, 10/70 and 5/70 of that variance.
    #[test]
    fn averages_are_named_with_their_correlation() {
        for (over, shown) in [(2, 14.0 / 70.0), (4, 10.0 / 70.0), (8, 5.0 / 70.0)] {
            let found = filtered(&read(&averaged(&white(21), over)), 0.0).unwrap();
            let correlation = 1.0 - 1.0 / over as f64;
            assert!((found.correlation - correlation).abs() < 0.05, "{over}: {found:?}");
            let times = (over as f64 / shown).sqrt();
            assert!((found.times / times - 1.0).abs() < 0.2, "{over}: {found:?} {times}");
        }
    }

    /// A filter of first order that keeps half: over many readings (1 + 1/2)/(1 − 1/2) times the variance of one, of which neighbours show
    /// 1 − (56/2 − 28/4 + 8/8 − 1/16)/35.
    #[test]
    fn a_filter_of_first_order_is_named_with_its_correlation() {
        let mut last = Vector3::<f64>::zeros();
        let each = white(22).into_iter().map(|own| {
            last = last * 0.5 + own;
            last
        });
        let found = filtered(&read(&each.collect::<Vec<_>>()), 0.0).unwrap();
        assert!((found.correlation - 0.5).abs() < 0.1, "{found:?}");
        let times = f64::sqrt(3.0 / (1.0 - (28.0 - 7.0 + 1.0 - 0.0625) / 35.0));
        assert!((found.times / times - 1.0).abs() < 0.2, "{found:?} {times}");
    }

    /// White noise, that with torque noise, torque noise alone, blows, differences of noise, and a motion that turns far between readings are no
    /// filter; nor is vibration.
    #[test]
    fn a_motion_and_other_noise_are_no_filter() {
        let (noise, steps) = (white(23), white(24));
        let sum = |a: &[Vector3<f64>], b: &[Vector3<f64>]| -> Vec<Vector3<f64>> {
            a.iter().zip(b).map(|(a, b)| a + b).collect()
        };
        let differences: Vec<Vector3<f64>> = noise.windows(2).map(|own| own[1] - own[0]).collect();
        let blows: Vec<Vector3<f64>> =
            (0..COUNT).map(|k| Vector3::repeat(if k / 500 % 2 == 0 { 0.0 } else { 40.0 })).collect();
        let vibration: Vec<Vector3<f64>> =
            (0..COUNT).map(|k| Vector3::x() * (3.0 * libm::sin(1.445 * k as f64))).collect();
        for (name, made) in [
            ("white", noise.clone()),
            ("with little torque noise", sum(&noise, &walk(&steps, 0.1))),
            ("with torque noise", sum(&noise, &walk(&steps, 0.5))),
            ("torque noise", walk(&steps, 1.0)),
            ("blows", sum(&noise, &blows)),
            ("differences", differences),
            ("vibration", sum(&noise, &vibration)),
        ] {
            assert_eq!(filtered(&read(&made), 0.0), None, "{name}");
        }
        for turn in [0.1, 0.14, 0.3, 0.6, 1.0] {
            let [s] = read(&noise);
            let times: Vec<f64> = s.times.iter().map(|t| t * turn / 0.01).collect();
            let rate = |t: &f64| Vector3::new(0.6 * libm::sin(*t), 0.6 * libm::cos(*t), 0.8);
            let rates: Vec<Vector3<f64>> =
                times.iter().zip(&noise).map(|(t, noise)| rate(t) + noise * 1e-2).collect();
            assert_eq!(filtered(&[Stretch::new(times, rates)], 0.0), None, "{turn}");
        }
    }

    /// Nothing is said of readings that rest on a step, nor of few.
    #[test]
    fn steps_of_the_size_of_the_noise_and_short_records_tell_no_filter() {
        let all = read(&averaged(&white(25), 2));
        assert!(filtered(&all, 1e-5).is_some());
        assert_eq!(filtered(&all, 1e-4), None);
        assert_eq!(filtered(&[all[0].head(FEWEST)], 0.0), None);
        assert_eq!(filtered(&[], 0.0), None);
    }
}
