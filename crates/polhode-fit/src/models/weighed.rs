//! What each model of the torque makes of a record, and how far the answer rests on the choice of one.

use nalgebra::SymmetricEigen;

use crate::columns::sets::torque_columns;
use crate::models::reading_error::ReadingError;
use crate::physical::coordinates::{Coordinates, Form};
use crate::settings::torque::TorqueModel;
use crate::solve::ladder::threshold;
use crate::thresholds::choice::{LEAST, RARE};
use crate::thresholds::warnings::SENSOR;

/// Distance of the tensor of a needle from that of a sphere, shares of the trace: no other body's is larger.
const FARTHEST: f64 = 0.408_248_290_463_863; // 1/√6

/// What a model makes of a record.
#[derive(Clone, Debug)]
pub(crate) struct Weighed {
    pub(crate) model: TorqueModel,
    /// An error of the record, which takes the place of a torque, with its largest component: rad, a ratio, rad/s, s.
    pub(crate) error: Option<(ReadingError, f64)>,
    /// Whether a level of torque noise is one of its unknowns.
    pub(crate) has_noise: bool,
    /// Log-likelihood less that without a torque.
    pub(crate) gain: f64,
    pub(crate) x: Coordinates,
    /// A factor F of the covariance F Fᵀ of x.
    pub(crate) factor: Form,
    /// Mean square of the equations of each segment, over their noise, at what the other segments say; of several segments.
    pub(crate) held_out: Option<f64>,
}

impl Weighed {
    /// Whether it is this torque, and no error of the record.
    pub(crate) fn is_torque(&self, model: TorqueModel) -> bool {
        self.model == model && self.error.is_none()
    }

    /// Its log-likelihood less one for every coefficient; a level of torque noise is one, since it takes the place of a torque.
    pub(crate) fn score(&self) -> f64 {
        let count = self.error.map_or_else(|| torque_columns(self.model).len(), |(error, _)| error.count());
        self.gain - (count + usize::from(self.has_noise)) as f64
    }
}

/// The gain of log-likelihood that is asked of a model before it is chosen instead of none.
pub(crate) fn asked(model: TorqueModel) -> f64 {
    match torque_columns(model).len() {
        0 => 0.0,
        coefficients => threshold(coefficients),
    }
}

/// The share of each model: its likelihood beside that of the others, each less one for every coefficient. The choice itself asks for more:
/// what it leaves out is not refuted by that. Drag about the axes of the sensor has one where a drag was chosen, as only then the choice asks
/// for it: else a turn of the sensor would change what is said of a free body. Errors of the record have one where a torque
/// was chosen, as only then the record asks for one of the two, or where they explain far more than chance.
///
/// Source: H. Akaike, Biometrika 66 (1979) 237; K. P. Burnham and D. R. Anderson, Model
/// Selection and Multimodel Inference, Springer (2002), section 2.9.
pub(crate) fn shares(models: &[Weighed], chosen: TorqueModel) -> Vec<f64> {
    let is_asked = |one: &Weighed| {
        if one.error.is_some() {
            return chosen != TorqueModel::None || one.gain > SENSOR;
        }
        let drags = [TorqueModel::Drag, TorqueModel::Quadratic, TorqueModel::Drag3];
        one.model != TorqueModel::Drag3 || drags.contains(&chosen)
    };
    let score = |one: &Weighed| if is_asked(one) { one.score() } else { f64::NEG_INFINITY };
    let best = models.iter().map(score).fold(f64::NEG_INFINITY, f64::max);
    let weights: Vec<f64> = models.iter().map(|one| libm::exp(score(one) - best)).collect();
    let sum: f64 = weights.iter().sum();
    weights.into_iter().map(|weight| weight / sum).collect()
}

/// Mean and covariance of x by a model, and by that no tensor of a body lies further than `FARTHEST` from that of a sphere: a normal
/// distribution of this width beside what the record says. Only where the model leaves the tensor all but open that matters.
fn of_bodies(one: &Weighed) -> Option<(Coordinates, Form)> {
    let (all, own) = (FARTHEST * FARTHEST, one.factor * one.factor.transpose());
    let kept = (own + Form::identity() * all).cholesky()?.inverse() * all;
    let covariance = kept * own;
    Some((kept * one.x, (covariance + covariance.transpose()) * 0.5))
}

/// What a model of this share weighs: its share, but of more than a thousandth at least so much that the ellipsoid of 99.9 % seldom leaves
/// it out. By its share alone one of a hundredth would lie outside wherever it is far, or less certain.
fn weight(share: f64) -> f64 {
    share.max(LEAST * (share / RARE).min(1.0))
}

/// What the choice adds to the covariance of x: of each other model, by [`weight`], the square of its distance and what it is less certain
/// of.
///
/// With shares in the place of weights that is the covariance of the mixture of all models about the chosen one, but for models that are surer than
/// that one: J. A. Hoeting et al., Statistical Science 14 (1999) 382, equation (3). A mixture has longer tails than a normal distribution
/// of its covariance.
pub(crate) fn spread(models: &[Weighed], chosen: TorqueModel) -> Form {
    let mut sum = Form::zeros();
    let Some(own) = models.iter().find(|one| one.is_torque(chosen)).and_then(of_bodies) else { return sum };
    let others = models.iter().zip(shares(models, chosen)).filter(|(other, _)| !other.is_torque(chosen));
    for (other, share) in others {
        let Some(other) = of_bodies(other) else { continue };
        let apart = other.0 - own.0;
        let SymmetricEigen { eigenvectors: v, eigenvalues } = SymmetricEigen::new(other.1 - own.1);
        let wider = v * Form::from_diagonal(&eigenvalues.map(|value| value.max(0.0))) * v.transpose();
        sum += (wider + apart * apart.transpose()) * weight(share);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::thresholds::ladder::{FIRST, FURTHER};

    fn of(model: TorqueModel, gain: f64, x: f64, deviation: f64) -> Weighed {
        let x = Coordinates::new(x, 0.0, 0.0, 0.0, 0.0);
        Weighed {
            model,
            error: None,
            has_noise: false,
            gain,
            x,
            factor: Form::identity() * deviation,
            held_out: None,
        }
    }

    /// A coefficient that gains one weighs as much as none.
    #[test]
    fn models_weigh_by_their_likelihood_less_their_coefficients() {
        let (gain, unit) = (1.0, 1e-6);
        let alike = |added: Form, expected: [f64; 5]| {
            let expected = Form::from_diagonal(&Coordinates::from(expected));
            assert!((added / (unit * unit) - expected).norm() < 1e-6, "{added}");
        };
        let both =
            [of(TorqueModel::None, 0.0, 0.0, unit), of(TorqueModel::Drag, gain, 3.0 * unit, 2.0 * unit)];
        assert_eq!(shares(&both, TorqueModel::None), [0.5, 0.5]);
        // half of 2² − 1² in each direction, and half of 3² along the first
        alike(spread(&both, TorqueModel::None), [6.0, 1.5, 1.5, 1.5, 1.5]);
        // a model that is surer narrows nothing
        alike(spread(&both, TorqueModel::Drag), [4.5, 0.0, 0.0, 0.0, 0.0]);
        // one that the record refutes adds nothing
        let refuted =
            [of(TorqueModel::None, 0.0, 0.0, unit), of(TorqueModel::Drag, gain + 800.0, 1e-3, unit)];
        assert_eq!(spread(&refuted, TorqueModel::Drag), Form::zeros());
    }

    /// A model of more than a thousandth lies within the ellipsoid of 99.9 % wherever it is, and one that is refuted adds little.
    #[test]
    fn a_far_model_lies_within_the_ellipsoid_unless_it_is_refuted() {
        // chi squared of 5 degrees of freedom that is exceeded with a chance of a thousandth
        let (far, rare) = (40.0, 20.515);
        let square = |share: f64| {
            let score = libm::log(share / (1.0 - share));
            let models =
                [of(TorqueModel::None, 0.0, 0.0, 1e-6), of(TorqueModel::Drag, score + 1.0, far * 1e-6, 1e-6)];
            let sum = Form::identity() * 1e-12 + spread(&models, TorqueModel::None);
            (far * 1e-6) * (far * 1e-6) / sum[(0, 0)]
        };
        for share in [1.1e-3, 0.01, 0.05, 0.3, 0.9] {
            assert!(square(share) < 0.3 * rare, "{share}: {}", square(share));
        }
        assert!(square(1e-6) > rare);
        assert_eq!([0.0, LEAST, 0.5, 1.0].map(weight), [0.0, LEAST, 0.5, 1.0]);
    }

    /// Torque noise that stands in for a torque weighs as much as one coefficient of it.
    #[test]
    fn torque_noise_is_a_coefficient() {
        let noisy = Weighed { has_noise: true, ..of(TorqueModel::None, 1.0, 0.0, 1e-6) };
        let both = [noisy, of(TorqueModel::Drag, 1.0, 0.0, 1e-6)];
        assert_eq!(shares(&both, TorqueModel::None), [0.5, 0.5]);
    }

    /// A model under which the record tells nothing of the tensor adds no more than the tensors of all bodies differ.
    #[test]
    fn a_model_that_leaves_the_tensor_open_adds_what_the_law_leaves() {
        let models = [of(TorqueModel::None, 0.0, 0.0, 1e-3), of(TorqueModel::Constant, 3.0, 50.0, 30.0)];
        let added = spread(&models, TorqueModel::None).symmetric_eigenvalues();
        // half of 1/6, the square of the largest distance from the sphere
        assert!(added.iter().all(|variance| (0.99..1.01).contains(&(12.0 * variance))), "{added}");
    }

    /// Drag about three axes has a share where a drag was chosen, an error of the record where a torque was, or where it explains far more than
    /// chance.
    #[test]
    fn models_have_a_share_where_the_choice_asks_for_them() {
        let error = |gain: f64| Weighed {
            error: Some((ReadingError::Delays, 1e-3)),
            ..of(TorqueModel::None, gain, 0.0, 1e-6)
        };
        let has = |other: &Weighed, chosen: TorqueModel| {
            let both = shares(&[of(chosen, 40.0, 0.0, 1e-6), other.clone()], chosen);
            assert!((both[0] + both[1] - 1.0).abs() < 1e-14);
            both[1] > 0.0
        };
        let drag3 = of(TorqueModel::Drag3, 40.0, 0.0, 1e-6);
        for (chosen, is_drag) in [
            (TorqueModel::None, false),
            (TorqueModel::Constant, false),
            (TorqueModel::Drag, true),
            (TorqueModel::Quadratic, true),
            (TorqueModel::Drag3, true),
        ] {
            assert_eq!(has(&drag3, chosen), is_drag, "{chosen}");
            assert!(has(&of(TorqueModel::Constant, 40.0, 0.0, 1e-6), chosen), "{chosen}");
            assert_eq!(has(&error(SENSOR), chosen), chosen != TorqueModel::None, "{chosen}");
            assert!(has(&error(1.01 * SENSOR), chosen), "{chosen}");
        }
    }

    /// A score is the gain less one for each column, of an error those of it alone; a choice asks for more, and of none for nothing.
    #[test]
    fn scores_and_choices_count_the_columns() {
        let torque = |model| of(model, 8.0, 0.0, 1e-6);
        let error = |error| Weighed { error: Some((error, 0.1)), ..torque(TorqueModel::None) };
        let noisy = Weighed { has_noise: true, ..error(ReadingError::Delays) };
        assert_eq!(torque(TorqueModel::None).score(), 8.0);
        assert_eq!(torque(TorqueModel::Quadratic).score(), 7.0);
        assert_eq!(torque(TorqueModel::Constant).score(), 5.0);
        assert_eq!(error(ReadingError::Misalignment).score(), 5.0);
        assert_eq!((error(ReadingError::Delays).score(), noisy.score()), (6.0, 5.0));
        assert!(torque(TorqueModel::Drag).is_torque(TorqueModel::Drag));
        assert!(!torque(TorqueModel::Drag).is_torque(TorqueModel::Drag3));
        assert!(!error(ReadingError::Delays).is_torque(TorqueModel::None));
        let three = FIRST + 2.0 * FURTHER;
        let models = [TorqueModel::None, TorqueModel::Drag, TorqueModel::Drag3, TorqueModel::Constant];
        assert_eq!(models.map(asked), [0.0, FIRST, three, three]);
        // below a thousandth a weight falls with the share
        assert_eq!([RARE, 0.5 * RARE].map(weight), [LEAST, 0.5 * LEAST]);
    }
}
