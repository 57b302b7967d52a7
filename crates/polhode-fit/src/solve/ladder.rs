//! The torque that a record asks for: one rung after the other, each on its gain of likelihood.

use crate::columns::column::Column;
use crate::columns::sets::torque_columns;
use crate::models::MODELS;
use crate::models::equations::Equations;
use crate::models::weighed::{Weighed, asked};
use crate::physical::coordinates::Coordinates;
use crate::settings::torque::TorqueModel;
use crate::signal::covariance::Levels;
use crate::signal::stretch::Stretch;
use crate::solve::levels::{Choice, likeliest};
use crate::solve::radius::{Ends, Failure, descended, estimate};
use crate::solve::rounds::Noise;
use crate::solve::stacked::Stacked;
use crate::solve::weak_estimate::{Convergence, WeakEstimate};
use crate::thresholds::ladder::{FIRST, FURTHER, HOPE};

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
}

/// What a fit is asked to reckon with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Demand<'a> {
    pub(crate) radius: Option<f64>,
    pub(crate) torque: TorqueModel,
    pub(crate) noise: Noise,
    /// Columns that every model has.
    pub(crate) columns: &'a [Column],
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
    chosen.models = ladder.weigh(&chosen);
    Ok(chosen)
}

/// A weak estimate of one model, compared with no other.
fn plain(weak: WeakEstimate, model: TorqueModel) -> Chosen {
    Chosen { weak, model, gain: None, without: None, models: Vec::new() }
}

/// A model that was fitted by itself.
struct Rung {
    model: TorqueModel,
    weak: WeakEstimate,
    /// Its log-likelihood.
    likelihood: f64,
}

impl Rung {
    /// What it makes of the record, `floor` being the likelihood without a torque.
    fn fitted(&self, floor: f64, variance: f64) -> Option<Weighed> {
        let gain = self.likelihood - floor;
        let deviation = (variance * self.weak.misfit(variance).max(1.0)).sqrt();
        let factor = self.weak.root.try_inverse()? * deviation;
        let is_fit = self.weak.has_settled() && gain.is_finite();
        is_fit.then_some(Weighed { model: self.model, gain, x: self.weak.x(), factor, held_out: None })
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
        if let Some(weak) =
            quick.take_if(|weak| is_explained && (!weak.has_settled() || self.is_enough(weak)))
        {
            return Ok(plain(weak, base));
        }
        let best =
            if is_auto { self.highest()? } else { plain(self.descent(base, demand.radius, None)?, base) };
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
        near: Option<&WeakEstimate>,
    ) -> Result<WeakEstimate, Failure> {
        let columns = self.demand.columns(model);
        descended(self.stretches, radius, &columns, self.variance, self.demand.noise, near)
    }

    /// Whether an estimate that noise explains asks for neither torque nor torque noise.
    fn is_enough(&self, first: &WeakEstimate) -> bool {
        let demand = &self.demand;
        let asks =
            |model| gain_of(self.stretches, first, &demand.columns(model), self.variance) > asked(model);
        match demand.noise {
            Noise::Given(_) => return false,
            Noise::Fitted if has_torque_noise(self.stretches, first, self.variance) => return false,
            Noise::White | Noise::Fitted => {}
        }
        demand.torque != TorqueModel::Auto
            || ![TorqueModel::Drag, TorqueModel::Constant].into_iter().any(asks)
    }

    /// The first rung that the next one does not surpass.
    fn highest(&self) -> Result<Chosen, Failure> {
        let (stretches, demand, variance) = (self.stretches, &self.demand, self.variance);
        // one radius for all, so that their likelihoods are those of the same equations
        let drag = self.descent(TorqueModel::Drag, demand.radius, None)?;
        let radius = Some(drag.radius);
        let none = self.rung(TorqueModel::None, self.descent(TorqueModel::None, radius, None)?);
        let gain = gain_of(stretches, &none.weak, &demand.columns(TorqueModel::Constant), variance);
        let may_be_constant = !none.weak.has_settled() || gain > HOPE * asked(TorqueModel::Constant);
        let constant = may_be_constant.then(|| self.descent(TorqueModel::Constant, radius, Some(&none.weak)));
        let without = none.weak.has_settled().then(|| none.weak.x());
        let floor = none.likelihood;
        let mut fitted = vec![none.fitted(floor, variance)];
        let mut climb = |best: Rung, next: Rung| {
            fitted.push(next.fitted(floor, variance));
            let coefficients = |rung: &Rung| torque_columns(rung.model).len();
            let more = coefficients(&next).saturating_sub(coefficients(&best)).max(1);
            let asked = if best.model == TorqueModel::None { asked(next.model) } else { threshold(more) };
            let surpasses = !best.weak.has_settled() || next.likelihood - best.likelihood > asked;
            if next.weak.has_settled() && surpasses { next } else { best }
        };
        let mut best = climb(none, self.rung(TorqueModel::Drag, drag));
        if let Some(Ok(constant)) = constant {
            best = climb(best, self.rung(TorqueModel::Constant, constant));
        }
        if best.model == TorqueModel::Drag
            && may_be_drag3(stretches, &best.weak, demand, variance)
            && let Ok(drag3) = self.descent(TorqueModel::Drag3, radius, Some(&best.weak))
        {
            best = climb(best, self.rung(TorqueModel::Drag3, drag3));
        }
        let is_none = best.model == TorqueModel::None;
        Ok(Chosen {
            gain: Some(best.likelihood - floor).filter(|gain| !is_none && gain.is_finite()),
            without: without.filter(|_| !is_none),
            models: fitted.into_iter().flatten().collect(),
            ..plain(best.weak, best.model)
        })
    }

    fn rung(&self, model: TorqueModel, weak: WeakEstimate) -> Rung {
        let likelihood = likelihood(self.stretches, &weak, self.variance);
        Rung { model, weak, likelihood }
    }

    /// What every model makes of the record. Of one that was not fitted by itself the equations of the chosen one say it, to first
    /// order, as they say what each predicts of a segment from the others.
    fn weigh(&self, chosen: &Chosen) -> Vec<Weighed> {
        let (weak, variance, common) = (&chosen.weak, self.variance, self.demand.columns);
        let equations = weak.has_settled().then(|| Equations::new(self.stretches, weak, common, variance));
        let Some(equations) = equations.flatten() else { return Vec::new() };
        let fitted = |model| chosen.models.iter().find(|one| one.model == model).cloned();
        let own = equations.of(chosen.model).stacked().squares;
        let none = equations.of(TorqueModel::None).stacked().squares;
        let base = fitted(chosen.model).map_or(0.5 * (none - own) / variance, |one| one.gain);
        let deviation = (variance * weak.misfit(variance).max(1.0)).sqrt();
        let each = MODELS.into_iter().filter_map(|model| {
            let equations = equations.of(model);
            let linear = || {
                let stacked = equations.stacked();
                let gain = base + 0.5 * (own - stacked.squares) / variance;
                let factor = stacked.root.try_inverse()? * deviation;
                Some(Weighed { model, gain, x: stacked.minimiser()?.x, factor, held_out: None })
            };
            Some(Weighed { held_out: equations.held_out(), ..fitted(model).or_else(linear)? })
        });
        each.filter(|one| one.factor.iter().chain(&one.x).all(|v| v.is_finite())).collect()
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
fn likelihood(stretches: &[Stretch], weak: &WeakEstimate, variance: f64) -> f64 {
    let mut sum = weak.squares / variance;
    for part in &weak.parts {
        let white = part.covariance(&stretches[part.stretch]).into_factor(Levels::WHITE);
        let Some(white) = white else { return f64::NEG_INFINITY };
        sum += part.log_determinant - white.log_determinant();
    }
    if weak.parts.is_empty() { f64::NEG_INFINITY } else { -0.5 * sum }
}

/// Whether the residuals of an estimate without torque noise ask for some.
fn has_torque_noise(stretches: &[Stretch], weak: &WeakEstimate, variance: f64) -> bool {
    let free = weak.dof().max(1) as f64 / weak.rows.max(1) as f64;
    let choice = Choice { white: false };
    weak.parts.iter().any(|part| {
        let e = part.linearised.residuals(&weak.at);
        likeliest(&part.covariance(&stretches[part.stretch]), &e, variance, free, choice, None)
            .is_some_and(|levels| levels.torque > 0.0)
    })
}

/// Gain of log-likelihood that `columns` would bring to the equations of an estimate that has only the last of them.
fn gain_of(stretches: &[Stretch], weak: &WeakEstimate, columns: &[Column], variance: f64) -> f64 {
    let with = with_columns(stretches, weak, columns, variance);
    with.map_or(0.0, |with| 0.5 * (weak.squares - with.squares) / variance)
}

/// Whether drag about three axes may be worth a fit beside the drag of an estimate.
fn may_be_drag3(stretches: &[Stretch], weak: &WeakEstimate, demand: &Demand<'_>, variance: f64) -> bool {
    let three = torque_columns(TorqueModel::Drag3);
    let more = three.len().saturating_sub(torque_columns(TorqueModel::Drag).len());
    let both: Vec<Column> = three.into_iter().chain(demand.columns(TorqueModel::Drag)).collect();
    !weak.has_settled() || gain_of(stretches, weak, &both, variance) > HOPE * threshold(more)
}

/// The equations of an estimate with further columns, which come first and are zero where it stands.
fn with_columns(
    stretches: &[Stretch],
    weak: &WeakEstimate,
    columns: &[Column],
    variance: f64,
) -> Option<Stacked> {
    let mut at = weak.at.clone();
    at.c = vec![0.0; columns.len() - at.c.len()].into_iter().chain(at.c).collect();
    let parts = weak.parts.iter().map(|part| part.with_columns(&stretches[part.stretch], columns, &at));
    let whitened: Vec<Vec<f64>> = parts.collect::<Option<_>>()?;
    let rows: Vec<&[f64]> = whitened.iter().map(Vec::as_slice).collect();
    Some(Stacked::new(&rows, columns, &at, variance.sqrt()))
}
