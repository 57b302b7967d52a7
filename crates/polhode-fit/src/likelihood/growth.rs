//! From a first tensor to the largest likelihood, in windows that double about the middle of each stretch.

use nalgebra::Vector3;
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
const MEDIAN: f64 = 1.538_172_254_455_036;

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
    let [attitude, rate] = sizes.map(|mut sizes| {
        let middle = sizes.len() / 2;
        if sizes.is_empty() { 0.0 } else { *sizes.select_nth_unstable_by(middle, f64::total_cmp).1 / MEDIAN }
    });
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
