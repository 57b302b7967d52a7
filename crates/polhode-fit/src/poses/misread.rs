//! An offset of rates beside attitudes, or an error of their scale, as part of the model.
//!
//! Readings (1 + s) ω + b are taken back to ω. What the model then asks for beside is added to b or to s, until it asks for no more.

use nalgebra::Vector3;

use crate::likelihood::alternatives::{Alternatives, RateError};
use crate::likelihood::choice::Found;
use crate::likelihood::track::Track;
use crate::physical::coordinates::Form;
use crate::poses::moving::added;
use crate::thresholds::poses::{REST, TURNS};

/// An error of the rates, and what it is worth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Misread {
    pub(crate) error: RateError,
    /// b, in the unit of the rates.
    pub(crate) offset: Vector3<f64>,
    /// s.
    pub(crate) scale: f64,
    /// Gain of log-likelihood, by one step of least squares.
    pub(crate) gain: f64,
    /// What the error adds to the covariance of the tensor.
    pub(crate) spread: Form,
}

/// The model of rates without their error, where they have one; `found` is that of the rates as they are read, `of` fits others.
pub(crate) fn without_error_of_rates(
    tracks: &[Track],
    found: Found,
    of: impl Fn(&[Track]) -> Option<Found>,
) -> (Found, Option<Misread>) {
    let named = found.moved.alternatives.as_ref().and_then(Alternatives::error_of_rates);
    let Some((error, gain)) = named.map(|(error, own)| (error, own.gain)) else { return (found, None) };
    let none = Misread { error, offset: Vector3::zeros(), scale: 0.0, gain, spread: Form::zeros() };
    let mut taken: Option<Misread> = None;
    let mut best = found;
    for _ in 0..TURNS {
        let own = taken.unwrap_or(none);
        let step = best.moved.alternatives.as_ref().and_then(|all| all.of_error(error));
        let Some(step) = step.filter(|step| step.gain >= REST) else { break };
        let further = own.further(&step.values);
        let next = of(&further.taken_out(tracks)).filter(|next| further.cost(next) < own.cost(&best));
        let Some(next) = next else { break };
        (taken, best) = (Some(further), next);
    }
    // what a further step would move counts as a deviation
    let step = best.moved.alternatives.as_ref().and_then(|all| all.of_error(error));
    let spread = step.map_or(Form::zeros(), |step| added(&step.spread, &step.moved));
    (best, taken.map(|own| Misread { spread, ..own }))
}

impl Misread {
    /// The same error, larger by what rates without it still show.
    fn further(&self, values: &[f64]) -> Misread {
        match self.error {
            RateError::Offset => {
                Misread { offset: self.offset + Vector3::from_column_slice(values), ..*self }
            }
            RateError::Scale => Misread { scale: self.scale + (1.0 + self.scale) * values[0], ..*self },
        }
    }

    /// The samples as they would be without the error.
    pub(crate) fn taken_out(&self, tracks: &[Track]) -> Vec<Track> {
        let of = |track: &Track| Track {
            rates: track.rates.iter().map(|w| (w - self.offset) / (1.0 + self.scale)).collect(),
            ..track.clone()
        };
        tracks.iter().map(of).collect()
    }

    /// Twice the negative logarithm of the likelihood of the rates as they are read, up to a constant.
    fn cost(&self, found: &Found) -> f64 {
        let followed = &found.moved.followed;
        followed.cost() + 2.0 * followed.dof[1] * libm::log1p(self.scale)
    }
}
