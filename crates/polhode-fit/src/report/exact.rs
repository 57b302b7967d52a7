//! The report on a likelihood on the exact motion.

use nalgebra::{Matrix3, Vector3};
use polhode::rotation::Quat;

use crate::columns::column::Column;
use crate::columns::sets::torque_columns;
use crate::error::FitError;
use crate::likelihood::alternatives::Found;
use crate::likelihood::choice::{Acting, left_out};
use crate::likelihood::descent::{Levels, Problem};
use crate::likelihood::growth::Followed;
use crate::likelihood::profile::fall;
use crate::likelihood::readings::beside;
use crate::likelihood::sums::{Reduced, Sums};
use crate::likelihood::track::{COMMON, Kind, Track};
use crate::models::reading_error::{ReadingError, Units};
use crate::models::weighed::spread;
use crate::physical::coordinates::{Coordinates, Form, entries_of_coordinates};
use crate::physical::face::Nearest;
use crate::physical::failure::SolverFailure;
use crate::physical::law::LARGEST_SHARE;
use crate::physical::nearest::nearest;
use crate::poses::fault::PoseFault;
use crate::poses::free::Free;
use crate::report::answer::{Answer, of_entries, ratios, ratios_at, shape_of, sigmas};
use crate::report::attitudes::{AlignmentFit, AttitudeFit};
use crate::report::deviations::{Deviations, deviations};
use crate::report::estimate::{Estimate, Method, Residuals};
use crate::report::likelihood::{Of, Told, absolute, identify, joined};
use crate::report::mirror::{mirror_sigmas, mirrored};
use crate::report::model::models;
use crate::report::next_step::Origin;
use crate::report::nuisance::{FittedTorque, Nuisance};
use crate::report::parts::deviate_of_ratio;
use crate::report::scale::{Noise, Scale, scale_of};
use crate::report::segments::{SegmentSummary, WithoutSegment, to_shares};
use crate::report::systematic::of_readings;
use crate::report::torque_free::{InvariantTrend, Whiteness};
use crate::report::warning::Warning;
use crate::report::warnings::{Doubts, of_likelihood, of_rates};
use crate::settings::Settings;
use crate::settings::known::Known;
use crate::settings::torque::TorqueModel;
use crate::signal::stretch::Stretch;
use crate::thresholds::likelihood::{NARROW, PARTED};
use crate::thresholds::noise::LEAST;
use crate::thresholds::warnings::LEFT_OUT;

/// What the samples say at one level of noise.
struct Information {
    sums: Vec<Sums>,
    all: Reduced,
    tensor: Form,
    /// The same by the second derivative of the likelihood alone.
    curvature: Form,
    levels: Levels,
    /// What a constant torque moves the coordinates by.
    moved: Coordinates,
    torques: Vec<Nuisance>,
}

/// Everything that can be said of the tensor of a free motion.
pub(crate) fn report(
    repeated: usize,
    settings: &Settings,
    free: &Free,
    told: Told,
) -> Result<Estimate, FitError> {
    let (information, rates) = (information(settings, free)?, fitted_rates(free));
    let x = free.followed.model.x + information.moved;
    let identifiability =
        identify(&rates, &free.followed.model.x, &free.steady.unwrap_or(information.tensor));
    let (joined, agreed) =
        joined(settings, &identifiability, free.followed.is_still, &x, &information.tensor)?;
    let answer = nearest(&joined, &settings.limits, &[])?;
    if agreed.is_none() && !holds_at(free, &answer) {
        return Err(PoseFault::Unsettled.into());
    }
    let Deviations { free: factor, on_face, .. } = deviations(&joined, &[], &settings.limits, &[], &answer)?;
    let Answer { shape, moments, axes, v } = Answer::new(&answer.x)?;
    let (sigma_principal, sigma_axes) = sigmas(&on_face, &v, &moments);
    let ratios = ratios(&on_face, &v, &moments);
    let has_attitudes = free.followed.tracks.iter().any(Track::has_attitudes);
    let Levels { attitude, rate } = information.levels;
    let (attitude, rate) = if has_attitudes { (attitude, 0.0) } else { (0.0, rate) };
    let (j, both) = (shape.tensor(), on_face * on_face.transpose());
    let scale =
        |known: Known, path: &[Stretch], of: Of| size(known, path, of, free.read.unit, &j, (attitude, rate));
    let (inertia, inertia_covariance) =
        absolute(settings, &rates, model_of(free.torque), &j, &both, &answer.x, scale)?;
    let residuals = residuals(free, information.levels)?;
    let entries = entries_of_coordinates();
    let bound = information.curvature.cholesky().map(|c| c.inverse());
    let widened =
        information.tensor.cholesky().zip(bound).map(|(c, b)| (c.inverse().trace() / b.trace()).sqrt());
    let misfit = free.misfit(settings);
    let excess = misfit.unwrap_or(1.0);
    let count: f64 = free.followed.dof.iter().sum();
    let pull = answer.pull;
    let drag = free.alternatives.as_ref().and_then(|found| found.drag.as_ref());
    let drag = drag.map(|drag| (drag.values[0] * free.read.unit, drag.sigmas[0] * free.read.unit));
    let slowed = information.torques.first().filter(|_| free.torque == Acting::Drag);
    let drag = slowed.map(|drag| (drag.value, drag.sigma)).or(drag);
    // a constant torque, which is none of the unknowns of the motion, takes a part of an error
    let systematic = if has_attitudes || free.torque == Acting::Constant {
        Vec::new()
    } else {
        of_readings(&free.followed.tracks, &free.followed.model, &v, &moments.into(), free.read.unit)
    };
    let mut estimate = Estimate {
        principal: moments.into(),
        sigma_principal,
        axes,
        sigma_axes,
        ratios: ratios.map(|r| r.0),
        sigma_ratios: ratios.map(|r| r.1),
        covariance: of_entries(&on_face),
        free_covariance: of_entries(&factor),
        bound: bound.map(|bound| entries * bound * entries.transpose()),
        bound_ratio: widened.filter(|_| agreed.is_none()),
        inertia,
        inertia_covariance,
        quanta: [0.0; 3],
        rms_rate: free.read.unit,
        noise_sigma: if free.read.has_rates { information.levels.rate * free.read.unit } else { 0.0 },
        chi2_per_dof: excess + pull * pull / f64::max(count, 1.0),
        pull,
        dof: count as usize,
        samples: free.followed.tracks.iter().map(|t| t.used.iter().filter(|used| **used).count()).sum(),
        segments: free.read.used.len(),
        method: Method::ExactMotion,
        radius: None,
        identifiability,
        triangle_slack: (2.0 * (LARGEST_SHARE - moments[2])).max(0.0),
        active_constraints: answer.active,
        certificate: answer.certificate,
        momentum_trend: drag.map(|(drag, sigma)| InvariantTrend { rate: -drag, sigma }),
        energy_trend: None,
        whiteness: Whiteness::new(residuals.iter().map(|r| r.values.as_flattened())),
        torque: torque(free, information.torques.clone(), settings.torque == TorqueModel::Auto),
        models: models(&free.models, model_of(free.torque), None),
        reading_errors: Vec::new(),
        nuisances: Vec::new(),
        systematic,
        prior: agreed,
        per_segment: summaries(free, &information),
        unexplained: None,
        attitudes: has_attitudes.then(|| attitudes(repeated, settings, free, told, &information)),
        mirror: if has_attitudes { None } else { shape_of(&mirrored(&shape.tensor())).ok() },
        sigma_mirror: (!has_attitudes).then(|| mirror_sigmas(&answer.x, &on_face)),
        unseen_change: None,
        spikes: Vec::new(),
        residuals,
        warnings: Vec::new(),
        shape,
    };
    let alternatives = free.alternatives.as_ref().filter(|_| free.torque != Acting::Constant);
    // an error of the rates that explains more is named in its place
    let alternatives = alternatives.filter(|found| found.error_of_rates().is_none());
    let doubts = Doubts {
        misfit,
        widened: widened.filter(|_| !free.followed.beyond.is_empty()),
        constant: alternatives.and_then(|found| left_out(&free.followed, &found.constant)),
        outliers: outliers(free),
    };
    let beside = of_rates(free, settings.noise);
    let suspect = suspect(free, &rates, information.levels.rate);
    let all = beside.into_iter().chain(of_likelihood(&estimate, &doubts)).chain(suspect);
    estimate.warnings = all.collect();
    Ok(estimate)
}

/// The error of the sensor that rates without attitudes show by more than chance, where it explains more than a torque; of several what explains
/// most. `rates` are those of the motion, and `level` is their noise, in units of the fit.
///
/// A constant torque that is part of the answer is none of the unknowns of the motion: beside it nothing is said.
fn suspect(free: &Free, rates: &[Stretch], level: f64) -> Option<Warning> {
    let Followed { model, tracks, dof, .. } = &free.followed;
    if tracks.iter().any(Track::has_attitudes) || free.torque == Acting::Constant {
        return None;
    }
    let units = Units { rms: free.read.unit, input: 0.0 };
    let errors = ReadingError::all(rates);
    let columns: Vec<Vec<Column>> = errors.iter().map(|error| error.columns(rates, units)).collect();
    let all = beside(tracks, model, level.max(LEAST.sqrt()), &columns)?;
    // more unknowns explain more in any case
    let worth = |found: &Found| found.gain - found.values.len() as f64;
    let torques = free.alternatives.iter().flat_map(|found| [found.drag.as_ref(), Some(&found.constant)]);
    let most = torques.flatten().map(worth).fold(0.0, f64::max);
    // the noise is told by the same readings
    let is_rare = |found: &Found| {
        let (count, squares) = (found.values.len() as f64, 2.0 * found.gain);
        let ratio = (squares / count) / ((dof[1] - squares) / (dof[1] - count));
        deviate_of_ratio(ratio, [count, dof[1] - count]) > LEFT_OUT
    };
    let each = errors.iter().zip(&columns).zip(&all);
    let each = each.filter(|&(_, found)| worth(found) > most && is_rare(found));
    let ((error, columns), found) = each.max_by(|a, b| worth(a.1).total_cmp(&worth(b.1)))?;
    let size = found.values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    Some(Warning::LeftOut {
        what: error.in_words(),
        size: size * error.factor(units),
        unit: columns.first().map_or("", |column| column.label().unit),
        gain: found.gain,
        origin: Origin::Sensor,
    })
}

fn model_of(torque: Acting) -> TorqueModel {
    match torque {
        Acting::Nothing => TorqueModel::None,
        Acting::Drag => TorqueModel::Drag,
        Acting::Constant => TorqueModel::Constant,
    }
}

/// The torque that was reckoned with.
fn torque(free: &Free, coefficients: Vec<Nuisance>, is_chosen: bool) -> FittedTorque {
    let model = model_of(free.torque);
    let ratios_without = free.without.as_ref().map(ratios_at);
    FittedTorque { model, is_chosen, coefficients, gain: free.gain, ratios_without }
}

/// At the noise that was given, or as much as is left where that is more.
fn information(settings: &Settings, free: &Free) -> Result<Information, FitError> {
    let own = free.followed.levels;
    let rate = settings.noise.map_or(own.rate, |noise| own.rate.max(noise / free.read.unit));
    let levels = Levels {
        attitude: settings.attitude_noise.map_or(own.attitude, |noise| own.attitude.max(noise)),
        rate,
    };
    let problem = Problem { tracks: &free.followed.tracks, levels, radius: f64::INFINITY, pull: None };
    let singular = || FitError::Solver(SolverFailure::Information);
    let (sums, _) = problem.sums(&free.followed.model).ok_or_else(singular)?;
    let all = Reduced::new(&sums).ok_or_else(singular)?;
    let mut tensor = all.of_tensor().ok_or_else(singular)?;
    let (mut moved, mut torques) = (Coordinates::zeros(), Vec::new());
    let widened = |information: Form, more: Form| {
        let covariance = information.cholesky()?.inverse() + more;
        Some(covariance.cholesky()?.inverse())
    };
    let constant = free.alternatives.as_ref().filter(|_| free.torque == Acting::Constant);
    if let Some(constant) = constant.map(|found| &found.constant) {
        moved = Coordinates::from_fn(|k, _| constant.moved[k]);
        let spread = constant.spread.rows(0, 5);
        let added = spread * spread.transpose();
        tensor = widened(tensor, Form::from_fn(|i, k| added[(i, k)])).ok_or_else(singular)?;
        let each =
            torque_columns(TorqueModel::Constant).into_iter().zip(&constant.values).zip(&constant.sigmas);
        torques.extend(
            each.map(|((column, value), sigma)| Nuisance::new(&column, *value, *sigma, free.read.unit)),
        );
    }
    if let Some(drag) = free.followed.model.drag {
        let sigma =
            all.information.cholesky().map_or(f64::MAX, |c| c.inverse()[(COMMON - 1, COMMON - 1)].sqrt());
        let each = torque_columns(TorqueModel::Drag).into_iter();
        torques.extend(each.map(|column| Nuisance::new(&column, drag, sigma, free.read.unit)));
    }
    let spreads = [free.moving.as_ref().map(|own| own.spread), free.misread.map(|own| own.spread)];
    for spread in spreads.into_iter().flatten() {
        tensor = widened(tensor, spread).ok_or_else(singular)?;
    }
    let curvature = tensor;
    // samples that leave a number open have no covariance, and are refused for it
    if settings.torque == TorqueModel::Auto && tensor.cholesky().is_some() {
        tensor = widened(tensor, spread(&free.models, model_of(free.torque))).ok_or_else(singular)?;
    }
    if !free.followed.beyond.is_empty() {
        // as far as the noise of the levels is that of the walk
        let enlarged = (levels.attitude / own.attitude).max(levels.rate / own.rate);
        let added = free.followed.beyond.iter().fold(Form::zeros(), |sum, d| sum + d * d.transpose());
        tensor = widened(tensor, added * (enlarged * enlarged)).ok_or_else(singular)?;
    }
    Ok(Information { sums, all, tensor, curvature, levels, moved, torques })
}

/// Whether the likelihood falls to an answer that the law or a limit holds as its quadratic form says.
fn holds_at(free: &Free, answer: &Nearest) -> bool {
    if answer.active.is_empty() || free.followed.deviation < NARROW {
        return true;
    }
    let Followed { model, tracks, levels, .. } = &free.followed;
    let problem = Problem { tracks, levels: *levels, radius: f64::INFINITY, pull: None };
    let (foreseen, found) = (answer.pull * answer.pull, fall(&problem, model, &answer.x));
    found.is_some_and(|found| (found - foreseen).abs() <= PARTED.max(0.5 * found.max(foreseen)))
}

/// The rates of the motion at the samples, axes of the tensor, in units of the fit.
fn fitted_rates(free: &Free) -> Vec<Stretch> {
    let model = &free.followed.model;
    let tracks = free.followed.tracks.iter().zip(&model.starts).zip(&free.read.used);
    let each = tracks.map(|((track, start), &(segment, _))| {
        let motion = model.motion(start);
        let rate =
            |t: &f64| motion.as_ref().and_then(|motion| motion.at(*t)).map_or(Vector3::zeros(), |m| m.rate);
        let rates = track.times.iter().map(rate).collect();
        Stretch { segment, ..Stretch::new(track.times.clone(), rates) }
    });
    each.collect()
}

/// The size by the rates of a motion, in this unit, that was fitted to attitudes or rates whose noise has these deviations; that of a segment has
/// besides what a straight line through the turns leaves open of its slope.
pub(super) fn size(
    known: Known,
    path: &[Stretch],
    of: Of,
    unit: f64,
    j: &Matrix3<f64>,
    (attitude, rate): (f64, f64),
) -> Scale {
    let slope = match of {
        Of::All => 0.0,
        Of::Segment => attitude / path.iter().map(Stretch::duration).sum::<f64>(),
    };
    let variance = rate * rate + 12.0 * slope * slope;
    scale_of(known, path, unit, j, Noise { variance, is_in_rates: false })
}

/// Residuals of attitudes, or of rates where there are no attitudes, in standard deviations.
fn residuals(free: &Free, levels: Levels) -> Result<Vec<Residuals>, FitError> {
    let model = &free.followed.model;
    let each = free.followed.tracks.iter().zip(&model.starts).zip(&free.read.used);
    each.map(|((track, start), &(segment, middle))| {
        let shown = if track.has_attitudes() { Kind::Attitude } else { Kind::Rate };
        let (mut times, mut values) = (Vec::new(), Vec::new());
        let seen = track.visit(model, start, f64::INFINITY, |left| {
            if left.kind == shown {
                times.push(middle + track.times[left.sample] / free.read.unit);
                values.push((left.residual / levels.of(left.kind)).into());
            }
        });
        seen.ok_or(FitError::Solver(SolverFailure::Information))?;
        Ok(Residuals::new(segment, times, values))
    })
    .collect()
}

/// Each segment: what it contributes, and where the tensor would be without it.
fn summaries(free: &Free, information: &Information) -> Vec<SegmentSummary> {
    let total = information.tensor;
    let inverse = total.cholesky().map(|c| c.inverse());
    let all = information.all.of_tensor().and_then(|all| Some(all.cholesky()?.inverse()));
    let each = free.read.used.iter().enumerate().map(|(k, &(segment, _))| {
        let own = Reduced::new(&information.sums[k..=k]).and_then(|own| own.of_tensor());
        let weight = own.zip(inverse).map_or(0.0, |(own, inverse)| (inverse * own).trace() / 5.0);
        let others = || {
            let sums = &information.sums;
            let rest: Vec<Sums> = sums[..k].iter().chain(&sums[k + 1..]).cloned().collect();
            let rest = Reduced::new(&rest).filter(|_| sums.len() > 1)?;
            let own = rest.of_tensor()?.cholesky()?;
            let step = own.solve(&rest.gradient_of_tensor()?);
            let covariance = own.inverse() + (inverse? - all?);
            let x = free.followed.model.x + information.moved + step;
            Some(WithoutSegment::new(&x, &covariance, step.dot(&(total * step)).sqrt()))
        };
        let track: &Track = &free.followed.tracks[k];
        SegmentSummary {
            segment,
            samples: track.used.iter().filter(|used| **used).count(),
            noise_sigma: if free.read.has_rates { information.levels.rate * free.read.unit } else { 0.0 },
            torque_noise: 0.0,
            weight,
            without: others(),
        }
    });
    let mut each: Vec<SegmentSummary> = each.collect();
    to_shares(each.iter_mut().map(|s| &mut s.weight).collect());
    each
}

/// Samples that jump or stand out of the motion.
fn outliers(free: &Free) -> usize {
    let out = free.followed.tracks.iter().flat_map(|track| &track.used).filter(|used| !**used);
    free.read.jumps + out.count()
}

fn attitudes(
    repeated: usize,
    settings: &Settings,
    free: &Free,
    told: Told,
    information: &Information,
) -> AttitudeFit {
    AttitudeFit {
        noise_sigma: information.levels.attitude,
        noise_is_given: settings.attitude_noise.is_some(),
        residual: free.followed.levels.attitude,
        local_noise: free.read.local_noise,
        is_inverse: told.is_inverse,
        direction_gain: told.gain,
        largest_turn: free.read.largest_turn,
        left_out: outliers(free),
        repeated,
        alignment: free.read.has_rates.then(|| alignment(free, information)),
    }
}

fn alignment(free: &Free, information: &Information) -> AlignmentFit {
    let covariance = information.all.information.cholesky().map(|c| c.inverse());
    let step = free.alternatives.as_ref().and_then(|all| all.moving.as_ref()).map(|moving| &moving.found);
    let step =
        step.map_or((0.0, 0.0), |found| (Vector3::from_column_slice(&found.values).norm(), found.gain));
    let (moving, moving_gain) = free.moving.as_ref().map_or(step, |own| (own.turn.norm(), own.gain));
    let turn: Quat<f64> = free.followed.model.alignment;
    AlignmentFit {
        turn: turn.into(),
        sigma: [5, 6, 7].map(|k| covariance.map_or(f64::INFINITY, |c| c[(k, k)].sqrt())),
        moving,
        moving_gain,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::alternatives::RateError;
    use crate::likelihood::motion::Start;
    use crate::likelihood::track::Model;
    use crate::physical::certificate::Certificate;
    use crate::physical::constraint::{ActiveConstraint, Constraint};
    use crate::physical::coordinates::{ENTRIES, coordinates};
    use crate::poses::free::Read;
    use crate::poses::misread::Misread;
    use crate::poses::moving::Moving;
    use crate::report::answer::ratios_of;
    use crate::report::warning::Warning;
    use polhode::rotation::Vec3;

    /// Where a body is that tumbles about the middle of the third segment, at 5 s; samples are off by this rotation vector or rate, and the second is
    /// not used.
    fn tumbling(times: Vec<f64>, has_attitudes: bool, off: Vector3<f64>) -> Free {
        let x = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.25, 0.35, 0.4)));
        let start = Start { attitude: Quat::identity(), rate: Vector3::new(0.3, 1.0, -0.4) };
        let alignment = Quat::identity();
        let model = Model { x, alignment, is_aligned: false, drag: None, starts: vec![start] };
        let used = (0..times.len()).map(|k| k != 1).collect();
        let motion = model.motion(&start).unwrap();
        let (mut attitudes, mut rates) = (Vec::new(), Vec::new());
        for moved in times.iter().map(|t| motion.at(*t).unwrap()) {
            if has_attitudes {
                attitudes.push(moved.attitude * Quat::exponential(Vec3::from(off)));
            } else {
                rates.push(moved.rate + off);
            }
        }
        let tracks = vec![Track { times, attitudes, rates, used }];
        let levels = Levels { attitude: 0.01, rate: 0.25 };
        let followed = Followed { tracks, ..Followed::at(model, levels, [4.0, 6.0]) };
        let read = Read { used: vec![(2, 5.0)], jumps: 2, has_rates: !has_attitudes, ..Read::nothing() };
        let (torque, gain, without) = (Acting::Drag, Some(7.0), Some(x));
        Free { torque, gain, without, ..Free::of(followed, read) }
    }

    /// The same with a second segment, the fifth of the record, of a body that turns at this rate in its middle.
    fn and_again(mut free: Free, x: Coordinates, rate: Vector3<f64>) -> Free {
        let (first, start) = (&free.followed.tracks[0], Start { attitude: Quat::identity(), rate });
        let motion = Model { x, ..free.followed.model.clone() }.motion(&start).unwrap();
        let (times, used, has_attitudes) = (first.times.clone(), first.used.clone(), first.has_attitudes());
        let (mut attitudes, mut rates) = (Vec::new(), Vec::new());
        for moved in times.iter().map(|t| motion.at(*t).unwrap()) {
            if has_attitudes {
                attitudes.push(moved.attitude);
            } else {
                rates.push(moved.rate);
            }
        }
        free.followed.tracks.push(Track { times, attitudes, rates, used });
        free.followed.model.starts.push(start);
        free.read.used.push((4, 9.0));
        free
    }

    /// 101 samples about the middle of a segment.
    fn ten() -> Vec<f64> {
        (0..=100).map(|k| 0.1 * f64::from(k) - 5.0).collect()
    }

    /// Ten units of time of the free body, at a noise of a thousandth.
    fn quiet(has_attitudes: bool) -> Free {
        let mut free = tumbling(ten(), has_attitudes, Vector3::zeros());
        (free.torque, free.gain, free.without) = (Acting::Nothing, None, None);
        free.followed.levels = Levels { attitude: 1e-3, rate: 1e-3 };
        free
    }

    /// What the samples leave open, or the steady spins within their noise do, is refused before a search that did not come to rest, and both are
    /// before any number is told.
    #[test]
    fn what_is_open_is_refused_before_what_is_not_at_rest() {
        let settings = Settings::default().with_torque(TorqueModel::None);
        let refused = |is_still: bool, noise: f64, steady: Option<f64>| {
            let mut free = quiet(true);
            (free.followed.is_still, free.followed.levels.attitude) = (is_still, noise);
            free.steady = steady.map(|information| Form::identity() * information);
            report(0, &settings, &free, Told { is_inverse: false, gain: None }).err()
        };
        // deviations of a thousandth and of one
        assert_eq!((refused(true, 1e-3, None), refused(true, 1e-3, Some(1e6))), (None, None));
        assert_eq!(refused(false, 1e-3, None), Some(FitError::Poses(PoseFault::Unsettled)));
        for (is_still, noise, steady) in [(true, 1e3, None), (false, 1e3, None), (true, 1e-3, Some(1.0))] {
            let found = refused(is_still, noise, steady);
            assert!(matches!(found, Some(FitError::Unidentifiable(_))), "{is_still} {noise}: {found:?}");
        }
    }

    /// What lies beyond the ellipsoid of the second derivative is by how much the deviations exceed their bound: of three times its squares they are
    /// twice as large, which is warned of.
    #[test]
    fn what_lies_beyond_the_ellipsoid_exceeds_the_bound() {
        let settings = Settings::default().with_torque(TorqueModel::None);
        let mut free = quiet(true);
        let squares = information(&settings, &free).unwrap().tensor.try_inverse().unwrap().trace();
        let of = |free: &Free| report(0, &settings, free, Told { is_inverse: false, gain: None }).unwrap();
        let times = |e: &Estimate| {
            e.warnings.iter().find_map(|warning| match warning {
                Warning::Profile { times } => Some(*times),
                _ => None,
            })
        };
        let plain = of(&free);
        assert!((plain.bound_ratio.unwrap() - 1.0).abs() < 1e-9 && times(&plain).is_none());
        free.followed.beyond = vec![Coordinates::new(0.5, -0.5, 0.0, 0.5, 0.5) * (3.0 * squares).sqrt()];
        let more = of(&free);
        let (ratio, told) = (more.bound_ratio.unwrap(), times(&more).unwrap());
        assert!((ratio / 2.0 - 1.0).abs() < 1e-6 && told == ratio, "{ratio} {told}");
    }

    /// Of two segments alike each has half of the information, and without one of them variances are twice as large about the same tensor. Of two
    /// that differ the other says its own.
    #[test]
    fn without_one_of_two_segments_the_tensor_is_that_of_the_other() {
        let settings = Settings::default().with_torque(TorqueModel::None);
        let of = |moments: [f64; 3]| {
            let x = coordinates(&Matrix3::from_diagonal(&Vector3::from(moments)));
            let free = tumbling(ten(), true, Vector3::zeros());
            let free = and_again(free, x, Vector3::new(0.3, 1.0, -0.4));
            let information = information(&settings, &free).unwrap();
            let found = summaries(&free, &information);
            (found, ratios_of(&x, &information.tensor.try_inverse().unwrap()))
        };
        let (alike, both) = of([0.25, 0.35, 0.4]);
        for (own, segment) in alike.iter().zip([2, 4]) {
            // the second sample is not used
            assert_eq!((own.segment, own.samples, own.noise_sigma), (segment, 100, 0.0));
            assert!((own.weight - 0.5).abs() < 1e-9, "{}", own.weight);
            let without = own.without.unwrap();
            assert!(without.shift < 1e-6, "{:e}", without.shift);
            for (k, (ratio, sigma)) in both.into_iter().enumerate() {
                assert!((without.ratios[k] - ratio).abs() < 1e-9, "{k}: {}", without.ratios[k]);
                let times = without.sigma_ratios[k] / sigma;
                assert!((times / core::f64::consts::SQRT_2 - 1.0).abs() < 1e-6, "{k}: {times}");
            }
        }
        let (differ, other) = of([0.25002, 0.35002, 0.39996]);
        let [of_second, of_first] = [0, 1].map(|k: usize| differ[k].without.unwrap().ratios);
        for k in 0..2 {
            let apart = (other[k].0 - both[k].0).abs();
            assert!((of_second[k] - other[k].0).abs() < 0.02 * apart, "{k}: {} {}", of_second[k], other[k].0);
            assert!((of_first[k] - both[k].0).abs() < 0.02 * apart, "{k}: {} {}", of_first[k], both[k].0);
        }
    }

    /// A drag of the motion is told for a second, and momentum falls by as much; its deviation goes with the noise of the attitudes.
    #[test]
    fn a_drag_is_told_for_a_second_and_is_the_trend() {
        let mut free = tumbling(ten(), true, Vector3::zeros());
        free.followed.levels.attitude = 1e-3;
        let model = Model { drag: Some(0.02), ..free.followed.model.clone() };
        let motion = model.motion(&model.starts[0]).unwrap();
        let track = &mut free.followed.tracks[0];
        track.attitudes = track.times.iter().map(|t| motion.at(*t).unwrap().attitude).collect();
        free.followed.model = model;
        let of = |noise: Option<f64>| {
            let settings = Settings::default().with_torque(TorqueModel::Drag).with_attitude_noise(noise);
            let e = report(0, &settings, &free, Told { is_inverse: false, gain: None }).unwrap();
            let [drag] = &e.torque.coefficients[..] else { panic!("{:?}", e.torque) };
            // in units of 2 rad/s
            assert!((drag.value / 0.04 - 1.0).abs() < 1e-12, "{}", drag.value);
            assert_eq!(e.momentum_trend, Some(InvariantTrend { rate: -drag.value, sigma: drag.sigma }));
            drag.sigma
        };
        let sigma = of(None);
        assert!(sigma > 0.0 && (of(Some(4e-3)) / sigma - 4.0).abs() < 1e-6, "{sigma:e}");
    }

    /// A size by the energy of a motion has the noise of what the motion was fitted to: of attitudes none beside that of the shape, so that the
    /// energy stays as it is known; of rates none of a straight line through turns, so that energies of a tenth apart contradict each other.
    #[test]
    fn a_size_has_the_noise_of_its_readings_alone() {
        let settings = Settings::default().with_torque(TorqueModel::None).with_known(Known::TwiceEnergy(3.0));
        let told = Told { is_inverse: false, gain: None };
        let free = quiet(true);
        let covariance = report(0, &settings, &free, told).unwrap().inertia_covariance.unwrap();
        let rates = fitted_rates(&free);
        let scatter = rates[0].rates.iter().map(|w| w * w.transpose()).sum::<Matrix3<f64>>();
        // Σ ω·J ω by the entries of J, of which the products come twice
        let by_entries = nalgebra::Vector6::from_fn(|k, _| {
            let (a, b) = ENTRIES[k];
            if a == b { scatter[(a, b)] } else { 2.0 * scatter[(a, b)] }
        });
        let variance = by_entries.dot(&(covariance * by_entries));
        let most = by_entries.norm_squared() * covariance.amax();
        assert!(variance.abs() < 1e-9 * most && most > 0.0, "{variance:e} {most:e}");

        let free = quiet(false);
        let x = free.followed.model.x;
        let free = and_again(free, x, Vector3::new(0.3, 1.0, -0.4) * 1.05);
        match report(0, &settings, &free, told) {
            Err(FitError::SizeDiffers { factor, largest: 4, smallest: 2, .. }) => {
                assert!((factor / (1.05 * 1.05) - 1.0).abs() < 0.02, "{factor}");
            }
            other => panic!("{:?}", other.err()),
        }
    }

    /// Attitudes that are 0.03 rad off are three deviations of a hundredth off, and rates by 0.5 two of a quarter; only samples that are used count, at
    /// their times in the record. The rates of the motion are those of the model at all samples.
    #[test]
    fn residuals_are_in_deviations_at_the_times_of_the_record() {
        for (has_attitudes, off, expected) in
            [(true, Vector3::y() * 0.03, Vector3::y() * 3.0), (false, Vector3::z() * 0.5, Vector3::z() * 2.0)]
        {
            let free = tumbling(vec![-1.0, 0.0, 1.0], has_attitudes, off);
            let found = residuals(&free, free.followed.levels).unwrap();
            let [Residuals { segment: 2, times, values, mean_square }] = &found[..] else {
                panic!("{found:?}")
            };
            assert_eq!(times[..], [4.5, 5.5]);
            assert!(
                values.len() == 2 && values.iter().all(|own| (Vector3::from(*own) - expected).amax() < 1e-9)
            );
            assert!((mean_square * 3.0 / expected.norm_squared() - 1.0).abs() < 1e-9, "{mean_square}");
            // two that jump, and one that is not used
            assert_eq!(outliers(&free), 3);
            let [path] = &fitted_rates(&free)[..] else { panic!() };
            assert_eq!((path.segment, &path.times[..]), (2, &[-1.0, 0.0, 1.0][..]));
            assert!((path.rates[1] - Vector3::new(0.3, 1.0, -0.4)).amax() < 1e-12);
            let torque = torque(&free, Vec::new(), true);
            let [low, middle] = torque.ratios_without.unwrap();
            assert!((low - 0.625).abs() < 1e-12 && (middle - 0.875).abs() < 1e-12, "{low} {middle}");
            assert!(torque.model == TorqueModel::Drag && torque.is_chosen && torque.gain == Some(7.0));
        }
    }

    /// An answer that a wall holds is one where the likelihood falls to it as foreseen: by no more than four more or less, or by half of the
    /// larger. Where nothing holds it, or the tensor is known so well that the likelihood is quadratic, that is not asked.
    #[test]
    fn an_answer_at_a_wall_is_where_the_likelihood_falls_to_it() {
        let times = (0..=40).map(|k| 0.1 * f64::from(k) - 2.0).collect();
        let mut free = tumbling(times, true, Vector3::zeros());
        free.followed.deviation = NARROW;
        let x = free.followed.model.x;
        let wall = || ActiveConstraint { constraint: Constraint::Triangle, multiplier: 1.0 };
        let certificate = Certificate { stationarity: 0.0, violation: 0.0, dual_violation: 0.0, rounds: 0 };
        let answer = |x: Coordinates, square: f64, active| Nearest {
            x,
            others: Vec::new(),
            active,
            pull: f64::sqrt(square),
            certificate,
        };
        let holds =
            |free: &Free, x: Coordinates, square: f64| holds_at(free, &answer(x, square, vec![wall()]));
        assert!(holds(&free, x, 0.99 * PARTED) && !holds(&free, x, 1.01 * PARTED));
        assert!(holds_at(&free, &answer(x, 1e3, Vec::new())));
        let Followed { model, tracks, levels, .. } = &free.followed;
        let problem = Problem { tracks, levels: *levels, radius: f64::INFINITY, pull: None };
        let other = x + Coordinates::new(0.05, 0.0, 0.0, 0.0, 0.0);
        let found = fall(&problem, model, &other).unwrap();
        assert!(found > 2.0 * PARTED, "{found}");
        for (share, is_there) in [(0.49, false), (0.51, true), (1.98, true), (2.02, false)] {
            assert_eq!(holds(&free, other, share * found), is_there, "{share}");
        }
        free.followed.deviation = 0.999 * NARROW;
        assert!(holds(&free, x, 1e3));
    }

    /// The covariance of the tensor is that of the noise that is given, or of what is left where that is more; what moving axes and an error of the rates
    /// add to it comes on top, and so does what lies beyond the ellipsoid, which grows with the noise and is no part of the curvature.
    #[test]
    fn deviations_are_those_of_the_larger_noise_and_of_what_is_beside_it() {
        let times = (0..=40).map(|k| 0.1 * f64::from(k) - 2.0).collect();
        let mut free = tumbling(times, true, Vector3::zeros());
        let of = |free: &Free, noise: Option<f64>| {
            let settings = Settings::default().with_torque(TorqueModel::None).with_attitude_noise(noise);
            let Information { levels, tensor, curvature, moved, .. } = information(&settings, free).unwrap();
            assert_eq!(moved, Coordinates::zeros());
            (levels.attitude, tensor.try_inverse().unwrap(), curvature.try_inverse().unwrap())
        };
        let near = |found: Form, expected: Form| (found - expected).amax() < 1e-7 * expected.amax();
        let (own, covariance, curvature) = of(&free, None);
        assert!(own == 0.01 && near(curvature, covariance));
        let (less, same, _) = of(&free, Some(0.005));
        assert!(less == 0.01 && near(same, covariance));
        let (more, twice, _) = of(&free, Some(0.02));
        assert!(more == 0.02 && near(twice, covariance * 4.0));

        let size = covariance.amax();
        let spread = Form::identity() * (2.0 * size);
        free.moving = Some(Moving { turn: Vector3::zeros(), gain: 0.0, spread });
        let (error, offset) = (RateError::Offset, Vector3::zeros());
        free.misread = Some(Misread { error, offset, scale: 0.0, gain: 0.0, spread: spread * 0.5 });
        let beside = spread * 1.5;
        assert!(near(of(&free, None).1, covariance + beside));
        let far = Coordinates::new(1.0, -0.5, 0.0, 2.0, 1.0) * size.sqrt();
        free.followed.beyond = vec![far];
        let beyond = far * far.transpose();
        for (noise, times) in [(0.005, 1.0), (0.02, 4.0)] {
            let (_, found, curvature) = of(&free, Some(noise));
            assert!(near(found, covariance * times + beside + beyond * times), "{noise}");
            assert!(near(curvature, covariance * times + beside), "{noise}");
        }
    }
}
