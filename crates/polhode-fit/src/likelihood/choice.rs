//! The torque that samples of a motion ask for, and whether a steady spin explains them as well.

use nalgebra::Vector3;

use crate::likelihood::alternatives::{self, Alternatives};
use crate::likelihood::descent::Problem;
use crate::likelihood::growth::{Followed, steady};
use crate::likelihood::sums::Reduced;
use crate::likelihood::track::Track;
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
}

impl Found {
    /// Of one torque, compared with no other.
    pub(crate) fn of(moved: Option<Moved>, torque: Acting) -> Option<Found> {
        Some(Found { moved: moved?, torque, gain: None, without: None })
    }
}

/// The model with the torque that is asked for.
pub(crate) fn with_torque(model: TorqueModel, moved: impl Fn(bool) -> Option<Moved>) -> Option<Found> {
    match model {
        TorqueModel::None => Found::of(moved(false), Acting::Nothing),
        TorqueModel::Drag => Found::of(moved(true), Acting::Drag),
        TorqueModel::Constant => Found::of(moved(false), Acting::Constant),
        _ => chosen(moved),
    }
}

/// The torque that the samples ask for: none, or the one of drag and a constant torque that gains more.
fn chosen(moved: impl Fn(bool) -> Option<Moved>) -> Option<Found> {
    let Some(free) = moved(false) else { return Found::of(moved(true), Acting::Drag) };
    let found = free.alternatives.as_ref();
    let more = of_three();
    let drag = found.and_then(|found| found.drag.as_ref()).map_or(f64::INFINITY, |drag| drag.gain);
    let constant = found.map_or(0.0, |found| found.constant.gain);
    if drag <= ladder::FIRST && constant <= more {
        return Found::of(Some(free), Acting::Nothing);
    }
    let without = Some(free.followed.model.x);
    let slowed = moved(true).map(|slowed| {
        let gain = 0.5 * (free.followed.cost() - slowed.followed.cost());
        (slowed, gain)
    });
    match slowed {
        Some((slowed, gain)) if gain > ladder::FIRST && gain - ladder::FIRST >= constant - more => {
            Some(Found { moved: slowed, torque: Acting::Drag, gain: Some(gain), without })
        }
        // one that is too large for the first order is reckoned with only where noise cannot be it, and then refused
        _ if constant > more && (constant > MOVING || is_linear_of(&free)) => {
            Some(Found { moved: free, torque: Acting::Constant, gain: Some(constant), without })
        }
        _ => Found::of(Some(free), Acting::Nothing),
    }
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
    (cost - least <= SIGNIFICANT_GAIN).then(|| Reduced::new(&sums, None, 0.0)?.of_tensor()).flatten()
}
