//! From a first tensor to the largest likelihood, in windows that double about the middle of each stretch.

use nalgebra::Vector3;
use polhode::record::median;
use polhode::rotation::{Quat, Vec3};

use crate::likelihood::descent::{Levels, Problem, Settled};
use crate::likelihood::local::node;
use crate::likelihood::motion::Start;
use crate::likelihood::profile::{Profile, profile};
use crate::likelihood::sums::{Pull, Sums};
use crate::likelihood::track::{Kind, Model, Track};
use crate::physical::coordinates::{Coordinates, Form};
use crate::thresholds::likelihood::{FIRST, HELD, OUTLIER, PULL, ROUNDS, SAME, SAMPLES, SHARE_KEPT, SURE};
use crate::thresholds::noise::LEAST;

/// The median of |r| of three normal components, in their standard deviations.
const MEDIAN: f64 = 1.538_172_254_455_052;

/// A model of the largest likelihood.
pub(crate) struct Followed {
    pub(crate) model: Model,
    /// Whether the search ended at it.
    pub(crate) is_still: bool,
    /// The samples that were used in the end.
    pub(crate) tracks: Vec<Track>,
    /// Noise that is left: standard deviations of a component.
    pub(crate) levels: Levels,
    /// Components of attitudes and of rates that were used, less the unknowns they pay for.
    pub(crate) dof: [f64; 2],
    /// The largest deviation of the tensor, over the trace.
    pub(crate) deviation: f64,
    /// Displacements of the tensor by which the ellipsoid of the second derivative is too small, as one deviation each.
    pub(crate) beyond: Vec<Coordinates>,
}

impl Followed {
    /// Twice the negative logarithm of the likelihood, up to a constant.
    pub(crate) fn cost(&self) -> f64 {
        let of = |dof: f64, level: f64| if dof > 0.0 { dof * libm::log(level * level) } else { 0.0 };
        of(self.dof[0], self.levels.attitude) + of(self.dof[1], self.levels.rate)
    }
}

/// The likeliest model from a first tensor, alignment and levels of noise; `None` where no motion is found.
///
/// The first tensor of a motion near a steady spin may lie anywhere: unless what it leads to is the bottom, and narrow, another search
/// starts from the sphere, and the likelier of the two counts.
pub(crate) fn follow(
    tracks: &[Track],
    x: Coordinates,
    alignment: Quat<f64>,
    levels: Levels,
    has_drag: bool,
) -> Option<Followed> {
    let search = |x| search(tracks, x, alignment, levels, has_drag);
    let first = search(x);
    if first.as_ref().is_some_and(|found| found.is_still && found.deviation < SURE) {
        return first;
    }
    let of_both = [first, search(Coordinates::zeros())].into_iter().flatten();
    of_both.min_by(|a, b| b.is_still.cmp(&a.is_still).then(a.cost().total_cmp(&b.cost())))
}

/// The same from that tensor alone.
pub(crate) fn search(
    tracks: &[Track],
    x: Coordinates,
    alignment: Quat<f64>,
    levels: Levels,
    has_drag: bool,
) -> Option<Followed> {
    let weight = 1.0 / (PULL * PULL);
    let pull = Pull { information: Form::identity() * weight, centre: x, drag: weight };
    let first = Model {
        x,
        alignment,
        is_aligned: has_both(tracks),
        drag: has_drag.then_some(0.0),
        starts: Vec::new(),
    };
    let model = grow(tracks, first, levels, pull, false)?;
    let mut found = refine(tracks.to_vec(), model, levels)?;
    for _ in 0..ROUNDS {
        let Followed { model, tracks, levels, .. } = &found;
        let problem = Problem { tracks, levels: *levels, radius: f64::INFINITY, pull: None };
        let profile = if found.is_still { profile(&problem, model) } else { None };
        match profile {
            Some(Profile::Higher(model)) => found = refine(tracks.clone(), *model, *levels)?,
            Some(Profile::Beyond { deviation, each }) => {
                return Some(Followed { deviation, beyond: each, ..found });
            }
            None => return Some(found),
        }
    }
    // one rise after the other
    Some(Followed { is_still: false, ..found })
}

/// The steady spins nearest to the samples: the motions of a sphere. With what they leave of the samples, as the sum that is made least,
/// and their normal equations.
pub(crate) fn steady(tracks: &[Track], alignment: Quat<f64>, levels: Levels) -> Option<(Vec<Sums>, f64)> {
    let pull = Pull { information: Form::identity() * HELD, centre: Coordinates::zeros(), drag: 0.0 };
    let first =
        Model { x: pull.centre, alignment, is_aligned: has_both(tracks), drag: None, starts: Vec::new() };
    let model = grow(tracks, first, levels, pull, true)?;
    Problem { tracks, levels, radius: f64::INFINITY, pull: None }.sums(&model)
}

/// The model of the whole stretches, by windows that double; the pull of the tensor ends with the last window unless it `stays`.
fn grow(tracks: &[Track], first: Model, levels: Levels, pull: Pull, stays: bool) -> Option<Model> {
    let starts = tracks.iter().map(|track| start(track, &first.alignment)).collect::<Option<Vec<_>>>()?;
    let mut model = Model { starts, ..first };
    let end = tracks.iter().map(Track::reach).fold(0.0, f64::max);
    let mut radius = FIRST;
    while tracks.iter().any(|track| track.within(radius) < SAMPLES.min(track.times.len())) {
        radius *= 2.0;
    }
    loop {
        let levels = scales(tracks, &model, radius, levels)?;
        let last = radius >= end;
        let problem = Problem { tracks, levels, radius, pull: (stays || !last).then_some(pull) };
        model = problem.settle(model)?.model;
        if last {
            return Some(model);
        }
        radius *= 2.0;
    }
}

/// Levels of noise by what is left, and outliers left out, until both stand still.
fn refine(mut tracks: Vec<Track>, mut model: Model, mut levels: Levels) -> Option<Followed> {
    let (mut found, mut is_still) = (None, false);
    for _ in 0..ROUNDS {
        levels = scales(&tracks, &model, f64::INFINITY, levels)?;
        let problem = Problem { tracks: &tracks, levels, radius: f64::INFINITY, pull: None };
        let settled = problem.settle(model)?;
        (model, is_still) = (settled.model, settled.is_still);
        let (squares, counts) = squares(&tracks, &model)?;
        let unknowns = unknowns(&tracks, &model);
        let share = 1.0 - unknowns / (counts[0] + counts[1]);
        if share <= 0.0 {
            return None;
        }
        let dof = counts.map(|count| count * share);
        let level = |k: usize| (squares[k] / dof[k].max(1.0)).max(LEAST).sqrt();
        let new = Levels { attitude: level(0), rate: level(1) };
        let left_out = leave_out(&mut tracks, &model, levels)?;
        let same = |a: f64, b: f64| (a - b).abs() <= SAME * b;
        let still = same(new.attitude, levels.attitude) && same(new.rate, levels.rate);
        levels = new;
        found = Some(dof);
        if !is_still || still && !left_out {
            break;
        }
    }
    let dof = found?;
    if is_still {
        // at the levels that were found, so that its information is that of the noise
        let problem = Problem { tracks: &tracks, levels, radius: f64::INFINITY, pull: None };
        Settled { model, is_still } = problem.settle(model)?;
    }
    Some(Followed { model, is_still, tracks, levels, dof, deviation: f64::INFINITY, beyond: Vec::new() })
}

/// Whether there are both attitudes and rates.
fn has_both(tracks: &[Track]) -> bool {
    tracks.iter().any(Track::has_attitudes) && tracks.iter().any(Track::has_rates)
}

/// Numbers that the model has for these samples.
fn unknowns(tracks: &[Track], model: &Model) -> f64 {
    let own: usize = tracks.iter().map(|track| if track.has_attitudes() { 6 } else { 3 }).sum();
    (own + 5 + if model.is_aligned { 3 } else { 0 } + usize::from(model.drag.is_some())) as f64
}

/// Sums of squares and numbers of components of attitudes and rates.
pub(crate) fn squares(tracks: &[Track], model: &Model) -> Option<([f64; 2], [f64; 2])> {
    let (mut squares, mut counts) = ([0.0; 2], [0.0; 2]);
    for (track, start) in tracks.iter().zip(&model.starts) {
        track.visit(model, start, f64::INFINITY, |left| {
            let k = usize::from(left.kind == Kind::Rate);
            squares[k] += left.residual.norm_squared();
            counts[k] += 3.0;
        })?;
    }
    Some((squares, counts))
}

/// What the median residual says of the noise, at least a part of what was known of it.
fn scales(tracks: &[Track], model: &Model, radius: f64, known: Levels) -> Option<Levels> {
    let mut sizes: [Vec<f64>; 2] = [Vec::new(), Vec::new()];
    for (track, start) in tracks.iter().zip(&model.starts) {
        track.visit(model, start, radius, |left| {
            sizes[usize::from(left.kind == Kind::Rate)].push(left.residual.norm());
        })?;
    }
    let [attitude, rate] = sizes.map(|mut sizes| median(&mut sizes).map_or(0.0, |size| size / MEDIAN));
    Some(Levels {
        attitude: attitude.max(SHARE_KEPT * known.attitude),
        rate: rate.max(SHARE_KEPT * known.rate),
    })
}

/// Leaves out the samples of which a reading stands out of the noise; whether there was one.
fn leave_out(tracks: &mut [Track], model: &Model, levels: Levels) -> Option<bool> {
    let mut any = false;
    for (track, start) in tracks.iter_mut().zip(&model.starts) {
        let mut out = Vec::new();
        track.visit(model, start, f64::INFINITY, |left| {
            if left.residual.norm() > OUTLIER * levels.of(left.kind) {
                out.push(left.sample);
            }
        })?;
        any |= !out.is_empty();
        out.into_iter().for_each(|sample| track.used[sample] = false);
    }
    Some(any)
}

/// Attitude and rate at the middle of a track, axes of the tensor.
fn start(track: &Track, alignment: &Quat<f64>) -> Option<Start> {
    let middle = track.times.partition_point(|t| *t < 0.0).min(track.times.len().checked_sub(1)?);
    if track.has_attitudes() {
        let near = node(&track.times, &track.attitudes, middle, FIRST)?;
        let rate = alignment.rotate(Vec3::from(near.rate));
        // the node stands at a sample, the middle may lie between two
        let attitude = near.attitude * alignment.conjugate() * Quat::exponential(rate * -near.time);
        return Some(Start { attitude, rate: rate.into() });
    }
    let near: Vec<usize> = (0..track.times.len()).filter(|k| track.times[*k].abs() <= 0.25 * FIRST).collect();
    let of = |near: &[usize]| near.iter().map(|k| track.rates[*k]).sum::<Vector3<f64>>() / near.len() as f64;
    let rate = if near.is_empty() { track.rates[middle] } else { of(&near) };
    Some(Start { attitude: Quat::identity(), rate })
}

#[cfg(test)]
mod tests {
    use super::*;

    impl Followed {
        /// Where a search ended, of no samples.
        pub(crate) fn at(model: Model, levels: Levels, dof: [f64; 2]) -> Self {
            let (tracks, beyond) = (Vec::new(), Vec::new());
            Self { model, is_still: true, tracks, levels, dof, deviation: 0.0, beyond }
        }
    }

    fn begin() -> Start {
        Start { attitude: Quat::identity(), rate: Vector3::new(0.5, 0.8, -0.4) }
    }

    fn model(is_aligned: bool, drag: Option<f64>) -> Model {
        let x = Coordinates::new(-0.06, 0.02, 0.03, -0.02, 0.04);
        Model { x, alignment: Quat::identity(), is_aligned, drag, starts: vec![begin()] }
    }

    /// Rates of the model that are off by so much at −1, 0, 1, 2 and 3.
    fn off_by(sizes: [f64; 5]) -> Track {
        let motion = model(false, None).motion(&begin()).unwrap();
        let times: Vec<f64> = (0..5).map(|k| f64::from(k) - 1.0).collect();
        let rate = |(t, size): (&f64, f64)| motion.at(*t).unwrap().rate + Vector3::y() * size;
        let rates = times.iter().zip(sizes).map(rate).collect();
        Track { rates, attitudes: Vec::new(), used: vec![true; 5], times }
    }

    /// Half of a Maxwell distribution lies below the median: erf(m/√2) − √(2/π) m exp(−m²/2) is a half.
    #[test]
    fn the_median_is_that_of_three_normal_components() {
        let root = core::f64::consts::FRAC_1_SQRT_2;
        let density = core::f64::consts::FRAC_2_SQRT_PI * root * libm::exp(-0.5 * MEDIAN * MEDIAN);
        assert!((libm::erf(MEDIAN * root) - density * MEDIAN - 0.5).abs() < 1e-12);
    }

    /// Six numbers of a start with attitudes and three of one without, five of the tensor, three of an alignment and one of drag.
    #[test]
    fn unknowns_are_counted() {
        let rates = off_by([0.0; 5]);
        let both = Track { attitudes: vec![Quat::identity(); 5], ..rates.clone() };
        let tracks = [both, rates];
        assert!(has_both(&tracks) && !has_both(&tracks[1..]));
        assert_eq!(unknowns(&tracks, &model(true, Some(0.0))), 18.0);
        assert_eq!(unknowns(&tracks, &model(false, None)), 14.0);
        assert_eq!(unknowns(&tracks[1..], &model(false, Some(0.0))), 9.0);
    }

    /// The median residual within the radius over that of a unit normal distribution, or half of the noise that is known.
    #[test]
    fn levels_are_those_of_the_median_residual() {
        let tracks = [off_by([0.1, 0.5, 0.2, 0.4, 0.3])];
        let of = |radius: f64, known: f64| {
            let known = Levels { attitude: known, rate: known };
            let found = scales(&tracks, &model(false, None), radius, known).unwrap();
            (found.rate * MEDIAN, found.attitude)
        };
        for (radius, median) in [(f64::INFINITY, 0.3), (1.0, 0.2)] {
            let (found, attitude) = of(radius, 0.01);
            assert!((found / median - 1.0).abs() < 1e-12 && attitude == 0.005, "{radius}: {found}");
        }
        assert_eq!(of(1.0, 1.0), (0.5 * MEDIAN, 0.5));
    }

    /// Readings beyond six deviations are left out, and what is left out is neither counted nor left out again.
    #[test]
    fn outliers_are_left_out_once() {
        let mut tracks = [off_by([0.1, 0.5, 0.2, 0.4, 0.3])];
        let model = model(false, None);
        let levels = |rate| Levels { attitude: 0.0, rate };
        assert_eq!(leave_out(&mut tracks, &model, levels(0.0835)), Some(false));
        assert_eq!(leave_out(&mut tracks, &model, levels(0.055)), Some(true));
        assert_eq!(tracks[0].used, [true, false, true, false, true]);
        assert_eq!(leave_out(&mut tracks, &model, levels(0.055)), Some(false));
        let ([attitudes, rates], counts) = squares(&tracks, &model).unwrap();
        // 0.01 + 0.04 + 0.09
        assert!(attitudes == 0.0 && (rates - 0.14).abs() < 1e-12);
        assert_eq!(counts, [0.0, 9.0]);
    }

    /// Of an even turn the attitude between two samples is that of the middle, along the axes of the tensor.
    #[test]
    fn a_start_is_that_of_the_middle() {
        let (rate, first) = (Vector3::new(0.3, -0.7, 0.4), Quat::exponential(Vec3([0.2, 0.1, 1.0])));
        let alignment = Quat::exponential(Vec3([0.4, -0.2, 0.7]));
        let times = vec![-0.45, -0.25, -0.05, 0.15, 0.35];
        let turned = |t: &f64| first * Quat::exponential(Vec3::from(rate * *t));
        let attitudes: Vec<Quat<f64>> = times.iter().map(turned).collect();
        let track = Track { times, attitudes, rates: Vec::new(), used: vec![true; 5] };
        let found = start(&track, &alignment).unwrap();
        let expected = first * alignment.conjugate();
        assert!((expected.conjugate() * found.attitude).logarithm().norm() < 1e-12);
        let along: Vector3<f64> = alignment.rotate(Vec3::from(rate)).into();
        assert!((found.rate - along).norm() < 1e-12);
        // of rates the mean within a quarter of the first window, or the next one
        for (times, mean) in [
            (vec![-1.0, -0.2, 0.1, 0.25, 0.26, 1.0], 2.0),
            (vec![-1.0, -0.4, 0.3, 0.5, 0.6, 1.0], 2.0),
            (vec![-1.0, -0.9, -0.8, -0.7, -0.6, -0.5], 5.0),
        ] {
            let rates = (0..6).map(|k| Vector3::z() * f64::from(k)).collect();
            let track = Track { times, attitudes: Vec::new(), rates, used: vec![true; 6] };
            let found = start(&track, &alignment).unwrap();
            assert_eq!((found.attitude, found.rate), (Quat::identity(), Vector3::z() * mean));
        }
    }

    /// Of fewer readings than the model has numbers no noise is left to tell, and there is no answer: of six components for eight.
    #[test]
    fn fewer_readings_than_numbers_have_no_answer() {
        let all = off_by([0.0; 5]);
        let (times, rates) = (all.times[..2].to_vec(), all.rates[..2].to_vec());
        let two = Track { times, rates, attitudes: Vec::new(), used: vec![true; 2] };
        let levels = Levels { attitude: 0.0, rate: 1e-3 };
        assert!(search(&[two], model(false, None).x, Quat::identity(), levels, false).is_none());
    }
}
