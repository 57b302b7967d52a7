//! The torque that a record asks for: one rung after the other, each on its gain of likelihood.

use crate::columns::column::{Column, terms_of_all};
use crate::columns::dissipation::dissipation;
use crate::columns::effect::Class;
use crate::columns::sets::torque_columns;
use crate::models::MODELS;
use crate::models::equations::Equations;
use crate::models::reading_error::{ReadingError, Units};
use crate::models::weighed::{Weighed, asked};
use crate::physical::coordinates::Coordinates;
use crate::physical::nearest::nearest;
use crate::settings::torque::TorqueModel;
use crate::signal::stretch::Stretch;
use crate::solve::joint::Joint;
use crate::solve::levels::likeliest;
use crate::solve::radius::{Ends, Failure, descended, estimate, is_long};
use crate::solve::rounds::{Noise, Reached};
use crate::solve::weak_estimate::{Convergence, WeakEstimate};
use crate::thresholds::ladder::{ALIKE, FIRST, FURTHER, HOPE};

/// A weak estimate with the torque it was made with.
pub(crate) struct Chosen {
    pub(crate) weak: WeakEstimate,
    pub(crate) model: TorqueModel,
    /// Gain of log-likelihood over no torque.
    pub(crate) gain: Option<f64>,
    /// Coordinates without the torque.
    pub(crate) without: Option<Coordinates>,
    /// What every model makes of the record; empty where the rounds did not settle.
    pub(crate) models: Vec<Weighed>,
    /// Its equations with every torque and error of the sensor; `None` where the rounds did not settle.
    pub(crate) equations: Option<Equations>,
}

/// What a fit is asked to reckon with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Demand<'a> {
    pub(crate) radius: Option<f64>,
    pub(crate) torque: TorqueModel,
    pub(crate) noise: Noise,
    /// Columns that every model has.
    pub(crate) columns: &'a [Column],
    /// Errors of the sensor that are taken to be zero.
    pub(crate) errors: &'a [Column],
    /// Unit of the rates, rad/s.
    pub(crate) rms: f64,
}

impl Demand<'_> {
    fn columns(&self, model: TorqueModel) -> Vec<Column> {
        torque_columns(model).into_iter().chain(self.columns.iter().copied()).collect()
    }
}

/// The weak estimate that the demand asks for.
pub(crate) fn climb(stretches: &[Stretch], demand: Demand<'_>, variance: f64) -> Result<Chosen, Failure> {
    let ladder = Ladder { stretches, demand, variance };
    let mut chosen = ladder.choose()?;
    if chosen.equations.is_none() && chosen.weak.has_settled() {
        chosen.equations = ladder.equations(&chosen.weak);
    }
    chosen.models = ladder.weigh(&chosen);
    Ok(chosen)
}

/// A weak estimate of one model, compared with no other.
fn plain(weak: WeakEstimate, model: TorqueModel) -> Chosen {
    Chosen { weak, model, gain: None, without: None, models: Vec::new(), equations: None }
}

/// A model that was fitted by itself.
struct Rung {
    model: TorqueModel,
    weak: WeakEstimate,
    /// Its log-likelihood.
    likelihood: f64,
    /// What the physical law takes of it.
    loss: f64,
    /// Its equations with every torque, where they were asked for.
    equations: Option<Equations>,
}

impl Rung {
    /// How many coefficients its torque has, its noise being one.
    fn coefficients(&self) -> usize {
        torque_columns(self.model).len() + usize::from(self.weak.has_torque_noise())
    }

    /// What it makes of the record, `floor` being the likelihood without a torque.
    fn fitted(&self, floor: f64, variance: f64) -> Option<Weighed> {
        let gain = self.likelihood - floor;
        let deviation = (variance * self.weak.misfit(variance).max(1.0)).sqrt();
        let factor = self.weak.root.try_inverse()? * deviation;
        let is_fit = self.weak.has_settled() && gain.is_finite();
        is_fit.then_some(Weighed {
            model: self.model,
            error: None,
            has_noise: self.weak.has_torque_noise(),
            gain,
            x: self.weak.x(),
            factor,
            held_out: None,
        })
    }
}

struct Ladder<'a> {
    stretches: &'a [Stretch],
    demand: Demand<'a>,
    variance: f64,
}

impl Ladder<'_> {
    fn choose(&self) -> Result<Chosen, Failure> {
        let demand = &self.demand;
        let is_auto = demand.torque == TorqueModel::Auto;
        if let Noise::Given(_) = demand.noise
            && !is_auto
        {
            return Ok(plain(self.descent(demand.torque, demand.radius, None)?, demand.torque));
        }
        // most records need neither torque nor torque noise
        let base = if is_auto { TorqueModel::None } else { demand.torque };
        let columns = demand.columns(base);
        let first = |ends| estimate(self.stretches, demand.radius, &columns, self.variance, ends);
        let mut quick = first(Ends::Torques)?;
        let explained = |weak: &WeakEstimate| weak.misfit(self.variance) <= weak.expected_misfit();
        let is_explained = quick.as_ref().is_some_and(explained);
        let mut equations = None;
        if let Some(weak) = quick
            .take_if(|weak| is_explained && (!weak.has_settled() || self.is_enough(weak, &mut equations)))
        {
            return Ok(Chosen { equations, ..plain(weak, base) });
        }
        drop(equations);
        let best = if is_auto {
            self.highest(quick.take_if(|weak| is_long(self.stretches) && weak.has_settled()))?
        } else {
            plain(self.descent(base, demand.radius, None)?, base)
        };
        // what a descent did not settle, plain rounds may have
        let is_plain =
            is_auto && is_explained && best.model == TorqueModel::None && !best.weak.has_torque_noise();
        if best.weak.has_settled() && !is_plain {
            return Ok(best);
        }
        let settled = |weak: &WeakEstimate| match is_auto {
            true => weak.has_settled(),
            false => weak.convergence() == Convergence::Still,
        };
        let first = if quick.is_some() { quick } else { first(Ends::Rest)? };
        Ok(first.filter(settled).map_or(best, |weak| plain(weak, base)))
    }

    fn descent(
        &self,
        model: TorqueModel,
        radius: Option<f64>,
        near: Option<Reached>,
    ) -> Result<WeakEstimate, Failure> {
        let columns = self.demand.columns(model);
        descended(self.stretches, radius, &columns, self.variance, self.demand.noise, near)
    }

    /// Whether an estimate that noise explains asks for neither torque nor torque noise, with its equations where these say so.
    fn is_enough(&self, first: &WeakEstimate, equations: &mut Option<Equations>) -> bool {
        let demand = &self.demand;
        match demand.noise {
            Noise::Given(_) => return false,
            Noise::Fitted if has_torque_noise(self.stretches, first, self.variance) => return false,
            Noise::White | Noise::Fitted => {}
        }
        if demand.torque != TorqueModel::Auto {
            return true;
        }
        *equations = self.equations(first);
        let Some(equations) = equations else { return true };
        let squares = |model| equations.of(model).stacked().squares;
        let gain = |model| 0.5 * (first.squares - squares(model)) / self.variance;
        ![TorqueModel::Drag, TorqueModel::Constant].into_iter().any(|model| gain(model) > asked(model))
    }

    /// The equations of an estimate with every torque and error of the sensor.
    fn equations(&self, weak: &WeakEstimate) -> Option<Equations> {
        Equations::new(self.stretches, weak, self.demand.errors, self.demand.columns, self.variance)
    }

    /// The first rung that the next one does not surpass; it goes on from `quick` where there is
    /// one.
    fn highest(&self, quick: Option<WeakEstimate>) -> Result<Chosen, Failure> {
        let (stretches, demand, variance) = (self.stretches, &self.demand, self.variance);
        // one radius for all, so that their likelihoods are those of the same equations
        let drag = self.descent(TorqueModel::Drag, demand.radius, quick.map(Reached::of_former))?;
        let radius = Some(drag.radius);
        let drag = self.rung(TorqueModel::Drag, drag);
        // a long record goes on from where it stands
        let near = (is_long(stretches) && drag.weak.has_settled()).then(|| Reached::of(&drag.weak));
        let mut none = self.rung(TorqueModel::None, self.descent(TorqueModel::None, radius, near)?);
        // gains by torques: the errors of the sensor, many more columns, are asked for of the rung that is chosen
        none.equations = Equations::new(stretches, &none.weak, &[], demand.columns, variance);
        let gain = gain_of(&none, &[TorqueModel::Constant], variance);
        let of_drag3 = gain_of(&none, &[TorqueModel::Drag3], variance);
        none.equations = None;
        let floor = none.likelihood;
        // what is hopeless beside a drag is not tried in a long record
        let beside =
            if is_long(stretches) && drag.weak.has_settled() { drag.likelihood - floor } else { 0.0 };
        // torque noise takes the place of a torque, so that the equations with it promise little
        let is_open = !none.weak.has_settled() || (none.weak.has_torque_noise() && !is_long(stretches));
        let may_be_constant = is_open || gain > HOPE * asked(TorqueModel::Constant).max(beside);
        let constant = may_be_constant
            .then(|| self.descent(TorqueModel::Constant, radius, Some(Reached::of(&none.weak))));
        let without = none.weak.has_settled().then(|| none.weak.x());
        let mut fitted = vec![none.fitted(floor, variance)];
        let mut climb = |best: Rung, next: Rung| {
            fitted.push(next.fitted(floor, variance));
            // as many coefficients of another torque fit noise as well: one that was chosen gives way to what surely explains more
            let asked = threshold(next.coefficients().saturating_sub(best.coefficients()));
            let gain = next.likelihood - best.likelihood;
            // what only an impossible body would show gives way to what explains about as much of a possible one
            let by_law = if gain.abs() < ALIKE { best.loss - next.loss } else { 0.0 };
            let surpasses = !best.weak.has_settled() || gain + by_law > asked;
            if next.weak.has_settled() && surpasses { next } else { best }
        };
        let mut best = climb(none, drag);
        if let Some(Ok(constant)) = constant {
            best = climb(best, self.rung(TorqueModel::Constant, constant));
        }
        if best.model == TorqueModel::Drag {
            best.equations = self.equations(&best.weak);
        }
        let is_quadratic = best.model == TorqueModel::Drag
            && gain_of(&best, &[TorqueModel::Quadratic], variance) > HOPE * FIRST;
        if is_quadratic
            && let Ok(quadratic) = self.descent(TorqueModel::Quadratic, radius, Some(Reached::of(&best.weak)))
        {
            best = climb(best, self.rung(TorqueModel::Quadratic, quadratic));
            if best.model == TorqueModel::Quadratic {
                best.equations = self.equations(&best.weak);
            }
        }
        // a drag that has no part along one axis is far from one in proportion to the momentum
        let is_drag3 = match best.model {
            TorqueModel::Drag | TorqueModel::Quadratic => may_be_drag3(&best, variance),
            TorqueModel::Constant => of_drag3 > gain,
            _ => false,
        };
        if is_drag3 && let Ok(drag3) = self.descent(TorqueModel::Drag3, radius, Some(Reached::of(&best.weak)))
        {
            best = climb(best, self.rung(TorqueModel::Drag3, drag3));
        }
        let is_none = best.model == TorqueModel::None;
        Ok(Chosen {
            gain: Some(best.likelihood - floor).filter(|gain| !is_none && gain.is_finite()),
            without: without.filter(|_| !is_none),
            models: fitted.into_iter().flatten().collect(),
            equations: best.equations.filter(|_| best.weak.has_settled()),
            ..plain(best.weak, best.model)
        })
    }

    fn rung(&self, model: TorqueModel, weak: WeakEstimate) -> Rung {
        let likelihood = likelihood(&weak, self.variance);
        let loss = loss_by_law(&weak, self.variance);
        Rung { model, weak, likelihood, loss, equations: None }
    }

    /// What every model makes of the record, and every error of it in the place of a torque. Of one that was not fitted by itself the
    /// equations of the chosen one say it, to first order, as they say what each predicts of a segment from the others.
    fn weigh(&self, chosen: &Chosen) -> Vec<Weighed> {
        let (weak, demand, variance) = (&chosen.weak, &self.demand, self.variance);
        let Some(equations) = &chosen.equations else { return Vec::new() };
        let fitted = |model| chosen.models.iter().find(|one| one.model == model).cloned();
        let own = equations.of(chosen.model).stacked().squares;
        let none = equations.of(TorqueModel::None).stacked().squares;
        let base = fitted(chosen.model).map_or(0.5 * (none - own) / variance, |one| one.gain);
        let deviation = (variance * weak.misfit(variance).max(1.0)).sqrt();
        let units = Units { rms: demand.rms, input: terms_of_all(&weak.columns, &weak.at).input };
        let of_errors = ReadingError::all(self.stretches).into_iter().filter_map(|error| {
            let columns = error.columns(self.stretches, units);
            let equations = equations.of_errors(&columns)?;
            let stacked = equations.stacked();
            let best = stacked.minimiser()?;
            let largest = best.c.iter().take(columns.len()).fold(0.0, |most: f64, c| most.max(c.abs()));
            Some(Weighed {
                model: TorqueModel::None,
                error: Some((error, largest * error.factor(units))),
                has_noise: weak.has_torque_noise(),
                gain: base + 0.5 * (own - stacked.squares) / variance,
                x: best.x,
                factor: stacked.root.try_inverse()? * deviation,
                held_out: equations.held_out(),
            })
        });
        let each = MODELS.into_iter().filter_map(|model| {
            let equations = equations.of(model);
            let linear = || {
                let stacked = equations.stacked();
                let gain = base + 0.5 * (own - stacked.squares) / variance;
                let factor = stacked.root.try_inverse()? * deviation;
                let (x, has_noise) = (stacked.minimiser()?.x, weak.has_torque_noise());
                Some(Weighed { model, error: None, has_noise, gain, x, factor, held_out: None })
            };
            Some(Weighed { held_out: equations.held_out(), ..fitted(model).or_else(linear)? })
        });
        each.chain(of_errors).filter(|one| one.factor.iter().chain(&one.x).all(|v| v.is_finite())).collect()
    }
}

/// The gain that is asked of so many coefficients.
pub(crate) fn threshold(coefficients: usize) -> f64 {
    FIRST + FURTHER * (coefficients.max(1) - 1) as f64
}

/// Log-likelihood of an estimate, the unknowns at their best; estimates at one radius can be compared.
///
/// It is that of the samples: the determinants are over those without torque noise, since residuals and covariance
/// that both shrink with the tensor tell nothing.
pub(crate) fn likelihood(weak: &WeakEstimate, variance: f64) -> f64 {
    let sum = weak.parts.iter().fold(weak.squares / variance, |sum, part| sum + part.log_determinant);
    if weak.parts.is_empty() { f64::NEG_INFINITY } else { -0.5 * sum }
}

/// Loss of log-likelihood by that the tensor is one of a body and that drag takes energy: half the square of the distance to the nearest
/// such unknowns.
fn loss_by_law(weak: &WeakEstimate, variance: f64) -> f64 {
    let kept = |column: &Column| matches!(column.class(), Class::Drag | Class::Input);
    let nearest = |joint: Joint| nearest(&joint.told, &[], &dissipation(&weak.columns, &joint.kept)).ok();
    Joint::new(weak, kept, variance.sqrt()).and_then(nearest).map_or(0.0, |one| 0.5 * one.pull * one.pull)
}

/// Whether the residuals of an estimate without torque noise ask for some.
fn has_torque_noise(stretches: &[Stretch], weak: &WeakEstimate, variance: f64) -> bool {
    let free = weak.dof().max(1) as f64 / weak.rows.max(1) as f64;
    weak.parts.iter().any(|part| {
        likeliest(&part.covariance(&stretches[part.stretch]), &part.left, variance, free, false, None)
            .is_some_and(|levels| levels.torque > 0.0)
    })
}

/// Gain of log-likelihood that the torques of `models` would bring to the equations of a rung.
fn gain_of(rung: &Rung, models: &[TorqueModel], variance: f64) -> f64 {
    let squares = rung.equations.as_ref().map(|equations| equations.of_all(models).stacked().squares);
    squares.map_or(0.0, |squares| 0.5 * (rung.weak.squares - squares) / variance)
}

/// Whether drag about three axes may be worth a fit beside the drag of an estimate, in proportion to the rate or to its square.
fn may_be_drag3(drag: &Rung, variance: f64) -> bool {
    let count = |model| torque_columns(model).len();
    let more = count(TorqueModel::Drag3).saturating_sub(count(drag.model));
    let both = [TorqueModel::Drag3, drag.model];
    !drag.weak.has_settled() || gain_of(drag, &both, variance) > HOPE * threshold(more)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::column::Unknowns;
    use crate::physical::coordinates::{Form, coordinates};
    use crate::simulate::{Disturbances, Gyroscope, simulate_with};
    use nalgebra::{Matrix3, Vector3};
    use polhode::inertia::Inertia;
    use polhode::num::Random;

    /// A largest share of 0.7 is 0.2 above what a body has, and the nearest body takes a tenth of it to each of the others: 0.06 in squares.
    #[test]
    fn a_tensor_of_no_body_costs_half_the_squares_of_its_distance() {
        let of = |shares: [f64; 3]| {
            let at =
                Unknowns { x: coordinates(&Matrix3::from_diagonal(&Vector3::from(shares))), c: Vec::new() };
            let root = Form::identity() * 100.0;
            let weak = WeakEstimate { root, ..WeakEstimate::plain(Vec::new(), at, 20) };
            loss_by_law(&weak, 0.25)
        };
        assert_eq!(of([0.2, 0.35, 0.45]), 0.0);
        let loss = of([0.05, 0.25, 0.7]);
        assert!((loss / (0.5 * 0.06 * 1e4 / 0.25) - 1.0).abs() < 1e-9, "{loss}");
    }

    /// In a record that is not long a constant torque is tried wherever the equations promise its gain, also where a drag explains far more: of two that
    /// spin against each other and a third it explains only what they share.
    #[test]
    fn a_constant_torque_is_tried_beside_a_larger_drag() {
        let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
        let times: Vec<f64> = (0..200).map(|k| 0.1 * f64::from(k)).collect();
        let (by, sigma) = (Disturbances::default().with_relative_drag(7e-4), 5e-3);
        let (gyroscope, mut random) = (Gyroscope::default().with_noise(sigma), Random::new(3));
        let starts = [[0.3, 0.2, 0.9], [0.3, 0.2, -0.9], [0.2, -0.3, 0.9]].map(Vector3::from);
        let stretches: Vec<Stretch> = starts
            .iter()
            .enumerate()
            .map(|(k, start)| {
                let rates = simulate_with(&body, *start, &times, &by, &gyroscope, &mut random).unwrap();
                Stretch { index: k, segment: k, ..Stretch::new(times.clone(), rates) }
            })
            .collect();
        let (torque, noise) = (TorqueModel::Auto, Noise::White);
        let demand = Demand { radius: Some(1.0), torque, noise, columns: &[], errors: &[], rms: 1.0 };
        let ladder = Ladder { stretches: &stretches, demand, variance: sigma * sigma };
        let chosen = ladder.highest(None).ok().unwrap();
        let gain = |model: TorqueModel| {
            chosen.models.iter().find(|one| one.is_torque(model)).map_or(f64::NAN, |one| one.gain)
        };
        let (drag, constant) = (gain(TorqueModel::Drag), gain(TorqueModel::Constant));
        assert!(constant.is_finite() && drag > 2.0 * constant, "{drag} {constant}");
    }
}
