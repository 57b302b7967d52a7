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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::choice::{Acting, Moved};
    use crate::likelihood::descent::Levels;
    use crate::likelihood::growth::Followed;
    use crate::likelihood::track::Model;
    use crate::physical::coordinates::Coordinates;
    use core::cell::Cell;
    use polhode::rotation::Quat;

    fn misread(error: RateError, offset: Vector3<f64>, scale: f64) -> Misread {
        Misread { error, offset, scale, gain: 0.0, spread: Form::zeros() }
    }

    /// Readings (1 + s) ω + b are taken back to ω, and an error that is found after another is taken out in one with it.
    #[test]
    fn errors_that_are_taken_out_are_none() {
        let (offset, rate) = (Vector3::new(0.5, -0.25, 1.0), Vector3::new(1.0, 2.0, -3.0));
        let track = |rates| Track { times: vec![0.0], attitudes: Vec::new(), rates, used: vec![true] };
        let out = |of: &Misread, rate: Vector3<f64>| of.taken_out(&[track(vec![rate])])[0].rates[0];
        let both = misread(RateError::Scale, offset, 0.25);
        assert!((out(&both, rate * 1.25 + offset) - rate).norm() < 1e-15);
        // 1.25 · 1.2 = 1 + 0.5
        let scale = misread(RateError::Scale, Vector3::zeros(), 0.25).further(&[0.2]);
        assert!((scale.scale - 0.5).abs() < 1e-15 && scale.offset == Vector3::zeros());
        assert!((out(&scale, rate * 1.5) - rate).norm() < 1e-14);
        let added = misread(RateError::Offset, offset, 0.0).further(&[0.25, 0.5, -2.0]);
        assert_eq!((added.offset, added.scale), (Vector3::new(0.75, 0.25, -1.0), 0.0));
    }

    /// Of readings that are larger by one half every deviation of the rates is, too: each counts log 1.5 more, twice over.
    #[test]
    fn the_likelihood_is_that_of_the_readings() {
        let (x, alignment) = (Coordinates::zeros(), Quat::identity());
        let model = Model { x, alignment, is_aligned: true, drag: None, starts: Vec::new() };
        let followed = Followed::at(model, Levels { attitude: 0.5, rate: 0.25 }, [10.0, 6.0]);
        let moved = Moved { followed, alternatives: None };
        let found = Found { moved, torque: Acting::Nothing, gain: None, without: None, models: Vec::new() };
        // −10 log 4 − 6 log 16 = −44 log 2
        let plain = -44.0 * core::f64::consts::LN_2;
        let cost = |scale: f64| misread(RateError::Scale, Vector3::zeros(), scale).cost(&found);
        assert!((cost(0.0) - plain).abs() < 1e-13);
        assert!((cost(0.5) - plain - 12.0 * libm::log(1.5)).abs() < 1e-13);
    }

    /// A motion with so much log-likelihood, and what an offset of the rates would gain beside it.
    fn followed(likelihood: f64, gain: f64) -> Found {
        let (x, alignment) = (Coordinates::zeros(), Quat::identity());
        let model = Model { x, alignment, is_aligned: true, drag: None, starts: Vec::new() };
        // of one component
        let followed =
            Followed::at(model, Levels { attitude: 0.5, rate: libm::exp(-likelihood) }, [0.0, 1.0]);
        let alternatives = Some(Alternatives::gaining([gain, 0.0, 0.0, 0.0, 0.0]));
        let moved = Moved { followed, alternatives };
        Found { moved, torque: Acting::Nothing, gain: None, without: None, models: Vec::new() }
    }

    /// An offset is taken out from a gain of 15 on, in up to six steps while each gains a hundredth and makes the readings likelier; where the first does
    /// not, none is. Its gain is that of the first step.
    #[test]
    fn an_error_is_taken_out_while_that_is_likelier() {
        // of the first step the gain; by how much each step is likelier, and the gain of the next
        for (first, more, next, steps, likelihood, is_taken) in [
            (15.1, 1.0, 0.011, 6, 6.0, true),
            (15.1, 1.0, 0.009, 1, 1.0, true),
            (15.1, -1.0, 9.0, 1, 0.0, false),
            (14.9, 1.0, 9.0, 0, 0.0, false),
        ] {
            let count = Cell::new(0);
            let of = |_: &[Track]| {
                count.set(count.get() + 1);
                Some(followed(more * f64::from(count.get()), next))
            };
            let (best, taken) = without_error_of_rates(&[], followed(0.0, first), of);
            assert_eq!((count.get(), taken.map(|own| own.gain)), (steps, is_taken.then_some(first)));
            let found = -0.5 * best.moved.followed.cost();
            assert!((found - likelihood).abs() < 1e-12, "{first} {more} {next}: {found}");
        }
    }
}
