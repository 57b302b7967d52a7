//! Which warnings an estimate needs.

use crate::thresholds::noise::{DEVIATIONS, STATED};
use crate::thresholds::poses::{DOUBTFUL, MOVING};
use crate::thresholds::warnings::{APART, AS_WELL, FAR, FEW, NOISY, RESIDUALS, UNCERTAIN, UNEXPLAINED};
use nalgebra::Vector3;
use polhode::record::{Record, Segment, Spike, median};

use crate::likelihood::alternatives::{Alternatives, RateError};
use crate::models::reading_error::ReadingError;
use crate::poses::free::{Free, by_chance};
use crate::report::attitudes::AttitudeFit;
use crate::report::differing::Differing;
use crate::report::estimate::{Estimate, Method};
use crate::report::parts::{Halves, Scatter, halves};
use crate::report::suspect::{Refuted, Suspect};
use crate::report::torque_free::{InvariantTrend, blow, memory};
use crate::report::warning::Warning;
use crate::settings::torque::TorqueModel;
use crate::signal::filtered::Filtered;
use crate::solve::weak_estimate::{Convergence, WeakEstimate};
use crate::units::Others;

/// Whether the record has wheel momenta or torques, and they are zero in all its samples.
pub(crate) fn has_zero_inputs(record: &Record) -> bool {
    let inputs = || record.segments.iter().filter_map(Segment::inputs);
    let values = || inputs().flat_map(|inputs| inputs.wheel.iter().chain(&inputs.torque));
    values().next().is_some() && values().all(|value| *value == Vector3::zeros())
}

/// What was left out of the rates of a record before the fit: samples, `spikes` among them, and all but `used` segments.
pub(crate) fn of_record(record: &Record, spikes: &[Spike], used: usize) -> Vec<Warning> {
    let mut list = Vec::new();
    if record.merged() > 0 {
        list.push(Warning::Merged { samples: record.merged() });
    }
    if let Some(rate) = record.new_readings_rate() {
        list.push(Warning::Repeated { samples: record.repeated(), rate });
    }
    if record.stale() > 0 {
        list.push(Warning::Stale { samples: record.stale() });
    }
    if record.saturated() > 0 {
        list.push(Warning::Saturated { samples: record.saturated() });
    }
    let (in_bursts, alone): (Vec<&Spike>, Vec<&Spike>) =
        spikes.iter().partition(|spike| spike.burst.is_some());
    if let Some(first) = alone.first() {
        list.push(Warning::Spikes { samples: alone.len(), line: first.line });
    }
    if let Some(first) = in_bursts.first() {
        let (samples, bursts) = Spike::bursts(spikes);
        list.push(Warning::Bursts { samples, bursts, line: first.line });
    }
    list.extend(short_segments(used, record.segments.len()));
    list
}

/// That all but `used` of the segments were too short, where there are others.
pub(crate) fn short_segments(used: usize, segments: usize) -> Option<Warning> {
    let short = segments.saturating_sub(used);
    (short > 0).then_some(Warning::ShortSegments { short, segments })
}

/// What warnings are drawn from, besides the estimate.
pub(super) struct Grounds<'a> {
    pub(super) record: &'a Record,
    pub(super) weak: &'a WeakEstimate,
    /// Mean square of the residuals over the noise.
    pub(super) misfit: f64,
    /// Variance of the noise, in units of the mean square rate.
    pub(super) variance: f64,
    /// Units that explain the record as well.
    pub(super) open: Option<&'a Others>,
    /// The noise that is stated, and another one that the readings show, rad/s.
    pub(super) contradicted: Option<(f64, f64)>,
    /// The noise of the readings, where they were filtered.
    pub(super) filtered: Option<Filtered>,
    /// What the fit takes to be zero and would explain the record better.
    pub(super) suspect: Option<&'a Suspect>,
    /// The error of the sensor that is fitted and larger than its prior allows.
    pub(super) refuted: Option<Refuted>,
    /// The error of the record that explains it without a torque as well as the chosen torque, with its size and its log-likelihood less
    /// that of this.
    pub(super) as_well: Option<(ReadingError, f64, f64)>,
    /// The two tensors that do so without a torque, and their log-likelihood less that of this.
    pub(super) instead: Option<(Halves, f64)>,
    /// What the free motion leaves of the samples, of a free body: mean square of a component over that of the noise, and the number of
    /// components.
    pub(super) left: Option<(f64, f64)>,
    /// How far the parts of the record contradict each other.
    pub(super) scatter: Option<Scatter>,
    /// The unknowns beside the tensor in which they differ.
    pub(super) differing: Option<&'a Differing>,
    /// Whether the fit has found the torque by itself.
    pub(super) found: bool,
    /// The same of torque noise.
    pub(super) noise_found: bool,
    /// Whether wheels or known torques act, which change |J ω| and ω·J ω.
    pub(super) driven: bool,
    /// One over the trace that they give, in its standard deviations.
    pub(super) size: Option<f64>,
}

impl Grounds<'_> {
    /// Equations within one turn of the body, at most a quarter of those of the longest segment.
    fn lags(&self, e: &Estimate) -> usize {
        let longest = e.residuals.iter().max_by_key(|r| r.times.len());
        let Some((r, radius)) = longest.zip(e.radius) else { return 0 };
        let [Some(first), Some(last)] = [r.times.first(), r.times.last()] else { return 0 };
        let count = r.times.len();
        let spacing = (last - first) / count.saturating_sub(1).max(1) as f64 * self.weak.radius / radius;
        ((core::f64::consts::TAU / spacing) as usize).clamp(1, (count / 4).max(1))
    }
}

/// What of the record, the residuals and the answer limits the use of `e`.
pub(super) fn warnings(e: &Estimate, grounds: &Grounds<'_>) -> Vec<Warning> {
    let mut list = Vec::new();
    let Grounds { record, weak, misfit, open, suspect, found, noise_found, driven, .. } = *grounds;
    if let Some(others) = open {
        list.push(Warning::Units {
            products: others.products.clone(),
            unexplained: others.as_read,
            other: others.best,
        });
    }
    if has_zero_inputs(record) {
        list.push(Warning::ZeroInputs);
    }
    list.extend(of_record(record, &e.spikes, e.segments));
    list.extend(grounds.contradicted.map(|(stated, shown)| Warning::StatedNoise { stated, shown }));
    let of_noise = |Filtered { correlation, times }| Warning::Filtered { correlation, times };
    list.extend(grounds.filtered.map(of_noise));
    if misfit > (1.0 + DEVIATIONS * (2.0 / e.dof.max(1) as f64).sqrt()).max(RESIDUALS) {
        list.push(Warning::Residuals { times: misfit.sqrt(), noise: e.noise_sigma });
    }
    if weak.convergence() != Convergence::Still {
        list.push(Warning::NotConverged { moved: weak.moved });
    }
    if e.whiteness.significant() {
        list.push(Warning::Correlated(e.whiteness));
    }
    list.extend(memory(&e.residuals, grounds.lags(e)).map(Warning::Memory));
    list.extend(blow(&e.residuals, misfit).map(Warning::Blow));
    // the noise itself is known from as many samples, less well
    let surely = |components: f64| 1.0 + 2.0 * DEVIATIONS * (2.0 / components).sqrt();
    let left = grounds.left.filter(|(left, components)| *left > surely(*components));
    list.extend(left.map(|(left, _)| Warning::Vibration { times: left.sqrt(), noise: e.noise_sigma }));
    if driven {
        list.extend(grounds.size.filter(|_| e.inertia.is_none()).map(|size| Warning::NoScale { size }));
    } else if e.torque.model == TorqueModel::None {
        let counts = |trend: &InvariantTrend| trend.significant();
        list.extend(e.momentum_trend.filter(counts).map(Warning::MomentumTrend));
        list.extend(e.energy_trend.filter(counts).map(Warning::EnergyTrend));
    }
    // nothing else explains more
    let refuted = grounds.refuted.filter(|own| suspect.is_none_or(|other| own.gain > other.gain - AS_WELL));
    if let Some(Refuted { what, size, prior, unit, gain }) = refuted {
        list.push(Warning::RefutedPrior { what, size, prior, unit, gain });
    }
    if found && e.torque.model != TorqueModel::None {
        list.push(Warning::Torque(e.torque.clone()));
        list.extend(grounds.as_well.map(|(error, size, gain)| Warning::AsWell { error, size, gain }));
        list.extend(grounds.instead.map(|(parts, gain)| Warning::TwoTensors { parts, gain }));
    }
    let density = e.per_segment.iter().map(|s| s.torque_noise).fold(0.0, f64::max);
    if noise_found && density > 0.0 && e.unexplained.is_none_or(|share| share > UNEXPLAINED) {
        list.push(Warning::TorqueNoise { density, unexplained: e.unexplained });
    }
    if let Some(&Suspect { what, origin, size, unit, gain, .. }) = suspect {
        list.push(Warning::LeftOut { what, size, unit, gain, origin });
    }
    list.extend(halves(weak, grounds.variance * misfit.max(1.0)).map(Warning::Halves));
    list.extend(grounds.scatter.map(Warning::Scatter));
    let named = grounds.differing.map(|found| found.named.clone()).filter(|named| !named.is_empty());
    list.extend(named.map(|unknowns| Warning::Differing { unknowns }));
    let mut levels: Vec<f64> = e.residuals.iter().map(|r| r.mean_square).collect();
    if let Some(median) = median(&mut levels).filter(|_| levels.len() > 2) {
        list.extend(e.residuals.iter().filter(|r| r.mean_square > NOISY * median).map(|r| {
            Warning::NoisySegment {
                segment: r.segment,
                start: record.segments[r.segment].times().first().copied().unwrap_or(0.0),
                times: (r.mean_square / median).sqrt(),
            }
        }));
    }
    list.extend(of_answer(e));
    list
}

/// What speaks against a likelihood on the exact motion, beside the estimate.
pub(super) struct Doubts {
    /// What is left over the noise, where that is known.
    pub(super) misfit: Option<f64>,
    /// By how much the profile of the likelihood widens the deviations, where it does.
    pub(super) widened: Option<f64>,
    /// Gain of log-likelihood by a constant torque that is left out, and by how much that turns the body, rad.
    pub(super) constant: Option<(f64, f64)>,
    /// Samples that were left out because they jump or stand out of the motion.
    pub(super) outliers: usize,
}

/// What limits the use of a tensor of the largest likelihood.
pub(super) fn of_likelihood(e: &Estimate, doubts: &Doubts) -> Vec<Warning> {
    let Doubts { misfit, widened, constant, outliers } = *doubts;
    let mut list: Vec<Warning> = widened.map(|times| Warning::Profile { times }).into_iter().collect();
    list.extend(constant.map(|(gain, turn)| Warning::ConstantTorque { gain, turn }));
    let repeated = e.attitudes.as_ref().map_or(0, |attitudes| attitudes.repeated);
    if repeated > 0 {
        list.push(Warning::RepeatedAttitudes { samples: repeated });
    }
    if outliers > 0 {
        list.push(Warning::Outliers { samples: outliers });
    }
    if let Some(attitudes) = &e.attitudes {
        let AttitudeFit { largest_turn: turn, noise_sigma, .. } = *attitudes;
        let chance = by_chance(e.dof as f64);
        if turn > DOUBTFUL {
            list.push(Warning::CoarseAttitudes { turn });
        }
        let most = chance.max(RESIDUALS);
        if let Some(times) = misfit.filter(|misfit| *misfit > most).map(f64::sqrt) {
            list.push(Warning::AttitudeResiduals { times, noise: noise_sigma / times });
        }
        // torque noise that is given too large leaves little too, and neighbours the same
        let is_calm = match attitudes.local_noise {
            Some(local) => STATED * local < noise_sigma,
            None => e.method == Method::ExactMotion,
        };
        let is_less = misfit.is_some_and(|misfit| STATED * STATED * chance * misfit < 1.0);
        if attitudes.noise_is_given && is_less && is_calm {
            list.push(Warning::StatedAttitudeNoise { stated: noise_sigma, shown: attitudes.residual });
        }
        if let Some(alignment) = attitudes.alignment.filter(|alignment| alignment.moving_gain > MOVING) {
            list.push(Warning::MovingAxes { turn: alignment.moving, gain: alignment.moving_gain });
        }
    }
    if e.whiteness.significant() {
        list.push(Warning::Correlated(e.whiteness));
    }
    if e.torque.model == TorqueModel::None {
        list.extend(e.momentum_trend.filter(|trend| trend.significant()).map(Warning::MomentumTrend));
    } else if e.torque.gain.is_some() {
        list.push(Warning::Torque(e.torque.clone()));
    }
    list.extend(of_answer(e));
    list
}

/// What is said of rates beside attitudes: an error that was taken out of them, one that is left, and what the motion leaves of them over
/// their noise, which is `given` or told by neighbours; or a given noise that is far more.
pub(super) fn of_rates(free: &Free, given: Option<f64>) -> Vec<Warning> {
    let unit = free.read.unit;
    let named = |error, offset: f64, scale, gain, is_fitted| match error {
        RateError::Offset => Warning::RateOffset { size: offset * unit, gain, is_fitted },
        RateError::Scale => Warning::RateScale { scale, gain, is_fitted },
    };
    let taken = free.misread.map(|own| named(own.error, own.offset.norm(), own.scale, own.gain, true));
    let left = free.alternatives.as_ref().and_then(Alternatives::error_of_rates);
    let left = left.map(|(error, found)| {
        let size = found.values.iter().map(|value| value * value).sum::<f64>().sqrt();
        named(error, size, found.values[0], found.gain, false)
    });
    // of rates alone the noise that is given is compared with what is left elsewhere
    let noise = given.or(free.read.rate_noise).filter(|noise| *noise > 0.0 && free.followed.model.is_aligned);
    let beyond = noise.map(|noise| (free.followed.levels.rate * unit / noise, noise));
    let most = by_chance(free.followed.dof[1]).max(RESIDUALS);
    let beyond = beyond.filter(|(times, _)| times * times > most);
    let beyond = beyond.map(|(times, noise)| Warning::RateResiduals { times, noise });
    // no torque noise is fitted beside rates: what is left of them is theirs
    let shown = free.followed.levels.rate * unit;
    let least = STATED * by_chance(free.followed.dof[1]).sqrt() * shown;
    let less = given.filter(|stated| free.followed.model.is_aligned && *stated > least);
    let less = less.map(|stated| Warning::StatedNoise { stated, shown });
    [taken, left, beyond, less].into_iter().flatten().collect()
}

/// What limits the use of a tensor of attitudes under torques; `misfit` is what is left over the noise, where that is known, `density` that of torque noise.
pub(super) fn of_smoothed(e: &Estimate, misfit: Option<f64>, density: f64) -> Vec<Warning> {
    let outliers = e.attitudes.as_ref().map_or(0, |attitudes| attitudes.left_out);
    let doubts = Doubts { misfit, widened: None, constant: None, outliers };
    let noise = (density > 0.0).then_some(Warning::TorqueNoise { density, unexplained: e.unexplained });
    noise.into_iter().chain(of_likelihood(e, &doubts)).collect()
}

/// What of the answer itself limits its use, however it was found.
pub(super) fn of_answer(e: &Estimate) -> Vec<Warning> {
    let mut list: Vec<Warning> = e.active_constraints.iter().cloned().map(Warning::Held).collect();
    if e.pull > FAR {
        list.push(Warning::Contradiction { pull: e.pull });
    }
    // Frobenius, which no turn of the sensor changes
    let c = &e.free_covariance;
    let deviation = (c.trace() + c[(3, 3)] + c[(4, 4)] + c[(5, 5)]).sqrt();
    if deviation > UNCERTAIN {
        list.push(Warning::Uncertain { deviation });
    }
    for (low, high) in [(0, 1), (1, 2)] {
        let (a, b) = (e.sigma_principal[low], e.sigma_principal[high]);
        if e.principal[high] - e.principal[low] < APART * (a * a + b * b).sqrt() {
            list.push(Warning::EqualMoments { low: low + 1, high: high + 1 });
        }
    }
    if e.dof < FEW {
        list.push(Warning::FewEquations { dof: e.dof });
    }
    list
}
