//! The torque that samples of a motion ask for, and whether a steady spin explains them as well.

use nalgebra::Vector3;

use crate::likelihood::alternatives::{self, Alternatives};
use crate::likelihood::descent::Problem;
use crate::likelihood::growth::{Followed, steady};
use crate::likelihood::sums::Reduced;
use crate::likelihood::track::Track;
use crate::models::weighed::Weighed;
use crate::physical::coordinates::{Coordinates, Form, tensor};
use crate::settings::torque::TorqueModel;
use crate::thresholds::ladder;
use crate::thresholds::likelihood::LINEAR;
use crate::thresholds::poses::MOVING;
use crate::thresholds::rounds::SIGNIFICANT_GAIN;

/// What acts on the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Acting {
    Nothing,
    /// In proportion to the momentum, exactly.
    Drag,
    /// Constant in the axes of the tensor, to first order.
    Constant,
}

/// A model that follows the samples, and what would explain them better.
pub(crate) struct Moved {
    pub(crate) followed: Followed,
    pub(crate) alternatives: Option<Alternatives>,
}

impl Moved {
    pub(crate) fn new(followed: Followed) -> Moved {
        let alternatives = Alternatives::new(&followed.tracks, &followed.model, followed.levels);
        Moved { followed, alternatives }
    }
}

/// A model with its torque.
pub(crate) struct Found {
    pub(crate) moved: Moved,
    pub(crate) torque: Acting,
    pub(crate) gain: Option<f64>,
    pub(crate) without: Option<Coordinates>,
    /// What each torque makes of the samples.
    pub(crate) models: Vec<Weighed>,
}

impl Found {
    /// Of a torque that was asked for.
    fn of(moved: Moved, torque: Acting, models: Vec<Weighed>) -> Found {
        Found { moved, torque, gain: None, without: None, models }
    }
}

/// The model with the torque that is asked for.
pub(crate) fn with_torque(model: TorqueModel, moved: impl Fn(bool) -> Option<Moved>) -> Option<Found> {
    let torque = match model {
        TorqueModel::None => Acting::Nothing,
        TorqueModel::Constant => Acting::Constant,
        TorqueModel::Drag => {
            let slowed = moved(true)?;
            let models = moved(false).map_or(Vec::new(), |free| weighed(&free, Some(&slowed)));
            return Some(Found::of(slowed, Acting::Drag, models));
        }
        _ => return chosen(moved),
    };
    let free = moved(false)?;
    let models = weighed(&free, None);
    Some(Found::of(free, torque, models))
}

/// What each torque makes of the samples beside the free motion, drag by what was followed with it where that was done. A constant
/// torque that turns the body by more than the first order holds is left out.
fn weighed(free: &Moved, slowed: Option<&Moved>) -> Vec<Weighed> {
    let Some(own) = covariance(&free.followed) else { return Vec::new() };
    let of = |model, gain, x, covariance: Form| {
        let factor = covariance.cholesky()?.l();
        Some(Weighed { model, error: None, has_noise: false, gain, x, factor, held_out: None })
    };
    let x = free.followed.model.x;
    let linear = |model, found: &alternatives::Found| {
        let (spread, moved) = (found.spread.rows(0, 5), Coordinates::from_fn(|k, _| found.moved[k]));
        let added = spread * spread.transpose();
        of(model, found.gain, x + moved, own + Form::from_fn(|i, k| added[(i, k)]))
    };
    let found = free.alternatives.as_ref();
    let drag = match slowed {
        Some(Moved { followed, .. }) => covariance(followed)
            .and_then(|covariance| of(TorqueModel::Drag, gain(free, followed), followed.model.x, covariance)),
        None => found.and_then(|found| linear(TorqueModel::Drag, found.drag.as_ref()?)),
    };
    let constant = found.map(|found| &found.constant).filter(|torque| is_linear(&free.followed, torque));
    let constant = constant.and_then(|torque| linear(TorqueModel::Constant, torque));
    [of(TorqueModel::None, 0.0, x, own), drag, constant].into_iter().flatten().collect()
}

/// The covariance of the tensor by the second derivative of the likelihood.
fn covariance(followed: &Followed) -> Option<Form> {
    let Followed { model, tracks, levels, .. } = followed;
    let problem = Problem { tracks, levels: *levels, radius: f64::INFINITY, pull: None };
    let (sums, _) = problem.sums(model)?;
    Some(Reduced::new(&sums)?.of_tensor()?.cholesky()?.inverse())
}

/// Log-likelihood of a model less that of the free motion.
fn gain(free: &Moved, followed: &Followed) -> f64 {
    0.5 * (free.followed.cost() - followed.cost())
}

/// The torque that the samples ask for: none, or the one of drag and a constant torque that gains more.
fn chosen(moved: impl Fn(bool) -> Option<Moved>) -> Option<Found> {
    let Some(free) = moved(false) else { return Some(Found::of(moved(true)?, Acting::Drag, Vec::new())) };
    let found = free.alternatives.as_ref();
    let more = of_three();
    let drag = found.and_then(|found| found.drag.as_ref()).map_or(f64::INFINITY, |drag| drag.gain);
    let constant = found.map_or(0.0, |found| found.constant.gain);
    if drag <= ladder::FIRST && constant <= more {
        let models = weighed(&free, None);
        return Some(Found::of(free, Acting::Nothing, models));
    }
    let without = Some(free.followed.model.x);
    let slowed = moved(true);
    let models = weighed(&free, slowed.as_ref());
    let slowed = slowed.map(|slowed| (gain(&free, &slowed.followed), slowed));
    Some(match slowed {
        Some((gain, moved)) if gain > ladder::FIRST && gain - ladder::FIRST >= constant - more => {
            Found { moved, torque: Acting::Drag, gain: Some(gain), without, models }
        }
        // one that is too large for the first order is reckoned with only where noise cannot be it, and then refused
        _ if constant > more && (constant > MOVING || is_linear_of(&free)) => {
            Found { moved: free, torque: Acting::Constant, gain: Some(constant), without, models }
        }
        _ => Found::of(free, Acting::Nothing, models),
    })
}

fn is_linear_of(moved: &Moved) -> bool {
    moved.alternatives.as_ref().is_some_and(|found| is_linear(&moved.followed, &found.constant))
}

/// Whether a constant torque turns the body by little.
pub(crate) fn is_linear(followed: &Followed, torque: &alternatives::Found) -> bool {
    turned(followed, torque) <= LINEAR
}

/// By how much a constant torque turns the body within half of the longest stretch, rad.
fn turned(followed: &Followed, torque: &alternatives::Found) -> f64 {
    let inverse = tensor(&followed.model.x).try_inverse();
    let acceleration = inverse.map(|inverse| inverse * Vector3::from_column_slice(&torque.values));
    let half = followed.tracks.iter().map(Track::reach).fold(0.0, f64::max);
    acceleration.map_or(f64::INFINITY, |a| 0.5 * a.norm() * half * half)
}

/// A constant torque that the samples ask for and the model leaves out: its gain of log-likelihood, and by how much it turns the body, rad.
pub(crate) fn left_out(followed: &Followed, torque: &alternatives::Found) -> Option<(f64, f64)> {
    (torque.gain > of_three()).then(|| (torque.gain, turned(followed, torque)))
}

/// Gain of log-likelihood from which a constant torque is reckoned with.
fn of_three() -> f64 {
    ladder::FIRST + 2.0 * ladder::FURTHER
}

/// What steady spins tell, where they leave hardly more of the samples.
pub(crate) fn steady_within_noise(followed: &Followed) -> Option<Form> {
    let Followed { model, tracks, levels, .. } = followed;
    let (sums, cost) = steady(tracks, model.alignment, *levels)?;
    let problem = Problem { tracks, levels: *levels, radius: f64::INFINITY, pull: None };
    let (_, least) = problem.sums(model)?;
    (cost - least <= SIGNIFICANT_GAIN).then(|| Reduced::new(&sums)?.of_tensor()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::descent::Levels;
    use crate::likelihood::motion::Start;
    use crate::likelihood::track::{COMMON, Model};
    use nalgebra::{DMatrix, DVector};
    use polhode::rotation::Quat;

    /// A sphere that is followed for 4 at most to one side, with so much log-likelihood, and what drag and a constant torque of a size promise.
    fn moved(likelihood: f64, promised: Option<[f64; 2]>, torque: f64) -> Moved {
        let (x, alignment) = (Coordinates::zeros(), Quat::identity());
        let track =
            Track { times: vec![-4.0, 3.0], attitudes: Vec::new(), rates: Vec::new(), used: vec![false; 2] };
        let model = Model { x, alignment, is_aligned: false, drag: None, starts: Vec::new() };
        // of one component
        let at = Followed::at(model, Levels { attitude: 0.0, rate: libm::exp(-likelihood) }, [0.0, 1.0]);
        let followed = Followed { tracks: vec![track], deviation: 1.0, ..at };
        let alternatives = promised.map(|[drag, constant]| {
            let mut all = Alternatives::gaining([0.0, 0.0, drag, constant, 0.0]);
            all.constant.values = vec![0.0, torque, 0.0];
            all
        });
        Moved { followed, alternatives }
    }

    /// Sizes of a constant torque that turns the sphere by a little less and by a little more than what the first order holds.
    const LITTLE: f64 = 0.099 / 24.0;
    const FAR: f64 = 0.101 / 24.0;

    /// Of drag and a constant torque the one is reckoned with that gains more beyond the 5 or 8 that are asked of it; a constant torque
    /// that turns the body far only from 15 on.
    #[test]
    fn the_torque_that_gains_more_than_is_asked_is_chosen() {
        use Acting::{Constant, Drag, Nothing};
        // what both promise, what drag brings, the size of the constant torque
        for (promised, slowed, torque, acting, gain) in [
            ([4.9, 7.9], 100.0, LITTLE, Nothing, None),
            ([5.0, 8.0], 100.0, LITTLE, Nothing, None),
            ([5.1, 0.0], 5.1, LITTLE, Drag, Some(5.1)),
            ([5.1, 0.0], 4.9, LITTLE, Nothing, None),
            ([5.1, 8.1], 5.05, LITTLE, Constant, Some(8.1)),
            ([5.1, 8.1], 5.2, LITTLE, Drag, Some(5.2)),
            ([0.0, 8.1], 0.0, LITTLE, Constant, Some(8.1)),
            ([5.1, 8.0], 0.0, LITTLE, Nothing, None),
            ([0.0, 14.9], 0.0, FAR, Nothing, None),
            ([0.0, 15.0], 0.0, FAR, Nothing, None),
            ([0.0, 15.1], 0.0, FAR, Constant, Some(15.1)),
        ] {
            let of = |has_drag: bool| match has_drag {
                true => Some(moved(slowed, None, 0.0)),
                false => Some(moved(0.0, Some(promised), torque)),
            };
            let found = with_torque(TorqueModel::Auto, of).unwrap();
            assert_eq!(found.torque, acting, "{promised:?} {slowed}");
            let is_gain = found.gain.zip(gain).map(|(found, gain): (f64, f64)| (found - gain).abs() < 1e-12);
            assert!(is_gain.unwrap_or(found.gain == gain), "{promised:?}: {:?}", found.gain);
            assert_eq!(found.without.is_some(), gain.is_some(), "{promised:?}");
            // the motion with drag is that of drag alone
            assert_eq!(found.moved.alternatives.is_none(), acting == Drag, "{promised:?}");
        }
        // where nothing is promised drag is tried, and where there is no free motion nothing else is left
        let open =
            |slowed: f64| move |has_drag: bool| Some(moved(if has_drag { slowed } else { 0.0 }, None, 0.0));
        assert_eq!([5.1, 4.9].map(|slowed| chosen(open(slowed)).unwrap().torque), [Drag, Nothing]);
        let found = chosen(|has_drag| has_drag.then(|| moved(1.0, None, 0.0))).unwrap();
        assert!(found.torque == Drag && found.gain.is_none());
        assert!(chosen(|_| None).is_none());
    }

    /// A torque that is asked for is there, whatever it gains, and no other one.
    #[test]
    fn a_torque_that_is_asked_for_is_not_compared() {
        let of = |has_drag: bool| Some(moved(if has_drag { 7.0 } else { 0.0 }, Some([100.0; 2]), LITTLE));
        for (model, acting, likelihood) in [
            (TorqueModel::None, Acting::Nothing, 0.0),
            (TorqueModel::Constant, Acting::Constant, 0.0),
            (TorqueModel::Drag, Acting::Drag, 7.0),
        ] {
            let found = with_torque(model, of).unwrap();
            assert!(found.torque == acting && found.gain.is_none() && found.without.is_none());
            assert!((found.moved.followed.cost() + 2.0 * likelihood).abs() < 1e-12, "{model}");
        }
    }

    /// A torque τ turns a sphere, whose moments are a third, by 3 τ T²/2 within the longer side T of a stretch; it is told as left out from
    /// a gain of 8 on.
    #[test]
    fn a_torque_turns_the_body_by_its_acceleration() {
        let free = moved(0.0, None, 0.0).followed;
        let torque = |gain: f64, size: f64| {
            let values = vec![0.0, 0.0, -size];
            alternatives::Found { values, ..alternatives::Found::gaining(gain, 3) }
        };
        let (gain, turn) = left_out(&free, &torque(8.1, 0.125)).unwrap();
        assert!(gain == 8.1 && (turn / 3.0 - 1.0).abs() < 1e-14, "{turn}");
        assert!(left_out(&free, &torque(8.0, 0.125)).is_none());
        assert!(is_linear(&free, &torque(0.0, LITTLE)) && !is_linear(&free, &torque(0.0, FAR)));
    }

    /// The motion of a tensor, by its own rates with this noise, and what drag and a constant torque of a size promise.
    fn exact(x: Coordinates, noise: f64, torque: f64) -> Moved {
        let mut all = moved(0.0, Some([6.0, 7.0]), torque);
        let start = Start { attitude: Quat::identity(), rate: Vector3::new(0.5, 0.8, -0.4) };
        all.followed.model = Model { x, starts: vec![start], ..all.followed.model };
        let motion = all.followed.model.motion(&start).unwrap();
        let times: Vec<f64> = (0..=20).map(|k| 0.4 * f64::from(k) - 4.0).collect();
        let rates = times.iter().map(|t| motion.at(*t).unwrap().rate).collect();
        all.followed.tracks = vec![Track { times, attitudes: Vec::new(), rates, used: vec![true; 21] }];
        all.followed.levels.rate = noise;
        all
    }

    /// To first order a torque moves the tensor and widens what is known of it; one that turns the body far is not weighed. Drag that was
    /// followed stands with its own tensor: of half the noise one component gains log 2.
    #[test]
    fn torques_are_weighed_by_what_they_move_and_widen() {
        let x = Coordinates::new(-0.06, 0.02, 0.03, -0.02, 0.04);
        let by = |size: f64, count: usize| alternatives::Found {
            moved: DVector::from_fn(COMMON, |k, _| size * (k + 1) as f64),
            spread: DMatrix::from_fn(COMMON, count, |i, k| size * (1 + (2 * i + 3 * k) % 5) as f64),
            ..alternatives::Found::gaining(1e3 * size, count)
        };
        let with = |torque: f64| {
            let mut free = exact(x, 0.1, torque);
            let all = free.alternatives.as_mut().unwrap();
            all.drag = Some(by(6e-3, 1));
            all.constant = alternatives::Found { values: vec![0.0, torque, 0.0], ..by(7e-3, 3) };
            free
        };
        let free = with(0.1 * LITTLE);
        let own = covariance(&free.followed).unwrap();
        let alike = |one: &Weighed, model: TorqueModel, gain: f64, x: Coordinates, expected: Form| {
            let found = one.factor * one.factor.transpose();
            assert!(one.is_torque(model) && !one.has_noise && (one.gain - gain).abs() < 1e-12, "{one:?}");
            assert!((one.x - x).amax() < 1e-15, "{one:?}");
            assert!((found - expected).amax() < 1e-9 * expected.amax(), "{found} {expected}");
        };
        let first_order = |one: &Weighed, model: TorqueModel, size: f64, count: usize| {
            let steps = Coordinates::from_fn(|k, _| size * (k + 1) as f64);
            let spread = by(size, count).spread;
            let wider = Form::from_fn(|i, k| (0..count).map(|e| spread[(i, e)] * spread[(k, e)]).sum());
            alike(one, model, 1e3 * size, x + steps, own + wider);
        };
        let models = weighed(&free, None);
        let [none, drag, constant] = &models[..] else { panic!("{models:?}") };
        alike(none, TorqueModel::None, 0.0, x, own);
        first_order(drag, TorqueModel::Drag, 6e-3, 1);
        first_order(constant, TorqueModel::Constant, 7e-3, 3);

        let other = Coordinates::new(0.01, -0.03, 0.0, 0.02, 0.0);
        let slowed = exact(other, 0.05, 0.0);
        let models = weighed(&with(10.0 * FAR), Some(&slowed));
        let [_, drag] = &models[..] else { panic!("{models:?}") };
        let of_slowed = covariance(&slowed.followed).unwrap();
        alike(drag, TorqueModel::Drag, core::f64::consts::LN_2, other, of_slowed);
    }
}
