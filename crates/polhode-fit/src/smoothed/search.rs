//! From a first path to the likeliest one, with tensor, torque and noise.

use nalgebra::{DMatrix, DVector, SMatrix, SVector, Vector3};
use polhode::rotation::{Quat, Vec3};

use crate::columns::column::{Column, Unknowns};
use crate::likelihood::local::node;
use crate::likelihood::motion::Start;
use crate::likelihood::track::Track;
use crate::physical::coordinates::{Coordinates, Form, eigen, tensor};
use crate::settings::torque::TorqueNoise;
use crate::smoothed::dynamics::{ALL, Law, SHARED};
use crate::smoothed::filter::{Kept, Level, Link, Sums, filter, links, smoothed};
use crate::solve::levels::{golden, newton, vertex};
use crate::thresholds::levels::{GAIN, RESHAPED};
use crate::thresholds::likelihood::{FIRST, OUTLIER};
use crate::thresholds::noise::LEAST;
use crate::thresholds::rounds::{FALL, KEPT, REACHED, SAME, SHARES, STILL};
use crate::thresholds::smoothed::{ALONE, DECADES, ROUNDS};

/// What is known of the noise.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Noise {
    /// Standard deviation of a component of an attitude, where it is given, rad.
    pub(crate) attitude: Option<f64>,
    /// Torque noise in units of the rate.
    pub(crate) torque: TorqueNoise,
}

/// Tensor, torque, noise and path of the largest likelihood.
#[derive(Clone)]
pub(crate) struct Found {
    pub(crate) columns: Vec<Column>,
    pub(crate) at: Unknowns,
    /// Attitude and rate at each sample of each track.
    pub(crate) paths: Vec<Vec<Start>>,
    /// The samples that were used in the end.
    pub(crate) tracks: Vec<Track>,
    pub(crate) level: Level,
    /// Variance of a component of an attitude.
    pub(crate) variance: f64,
    /// Information on the tensor and the coefficients, each stretch with its start at its best.
    pub(crate) information: DMatrix<f64>,
    /// The same on the tensor by each stretch alone, where it tells all of it.
    pub(crate) of_each: Vec<Form>,
    /// By all stretches but each one: the step of the tensor from here, and its covariance.
    pub(crate) without: Vec<Option<(Coordinates, Form)>>,
    /// The innovations of each track over their deviations, by sample.
    pub(crate) whitened: Vec<Vec<(usize, Vector3<f64>)>>,
    /// Log-likelihood, the unknowns at their best.
    pub(crate) likelihood: f64,
    /// Components that were used, less the unknowns.
    pub(crate) dof: f64,
    /// Change of the rates from each sample to the next, and what of it the model does not explain.
    changes: Vec<Vec<[Vector3<f64>; 2]>>,
    /// Whether the search came to rest.
    pub(crate) is_still: bool,
}

/// The equations of all stretches at a path.
struct Solved {
    /// Of the shared unknowns.
    step: SVector<f64, SHARED>,
    starts: Vec<SVector<f64, 6>>,
    information: SMatrix<f64, SHARED, SHARED>,
    /// Twice the negative logarithm of the restricted likelihood, and of the likelihood.
    restricted: f64,
    plain: f64,
    variance: f64,
    dof: f64,
}

struct Search<'a> {
    columns: &'a [Column],
    noise: Noise,
    tracks: Vec<Track>,
    at: Unknowns,
    paths: Vec<Vec<Start>>,
    level: Level,
}

/// The search from a first tensor; `None` where no path can be followed.
pub(crate) fn first(tracks: &[Track], x: Coordinates, columns: &[Column], noise: Noise) -> Option<Found> {
    let path = |track: &Track| -> Option<Vec<Start>> {
        let each = (0..track.times.len()).map(|k| node(&track.times, &track.attitudes, k, FIRST));
        each.map(|node| node.map(|node| Start { attitude: node.attitude, rate: node.rate })).collect()
    };
    let paths = tracks.iter().map(path).collect::<Option<Vec<_>>>()?;
    let at = Unknowns::at(x, columns);
    Search { columns, noise, tracks: tracks.to_vec(), at, paths, level: boundless(tracks) }.run()
}

/// Gain of twice the log-likelihood that torque noise brings to a motion under a torque, to a decade of its level.
pub(crate) fn gain_of_noise(
    tracks: &[Track],
    at: Unknowns,
    columns: &[Column],
    paths: Vec<Vec<Start>>,
    noise: Noise,
) -> Option<f64> {
    let search = Search { columns, noise, tracks: tracks.to_vec(), at, paths, level: boundless(tracks) };
    let links = search.links(&Law::new(&search.at, columns)?)?;
    let cost = |level| search.solve(&links, level).map(|solved| solved.restricted);
    let none = cost(Level { torque: 0.0, ..search.level })?;
    let decades = (0..DECADES).map(|decade| search.level.torque * libm::pow(10.0, 1.0 - decade as f64));
    let least = decades.filter_map(|torque| cost(Level { torque, ..search.level })).fold(none, f64::min);
    Some(none - least)
}

/// So much torque noise that each sample is heard for a part of a radian: the variance of an attitude over a time is that of the torque noise
/// over its fourth power.
fn boundless(tracks: &[Track]) -> Level {
    let spans = tracks.iter().map(|t| t.reach() / t.times.len() as f64);
    Level { torque: 2.0 * spans.fold(0.0, f64::max) / (ALONE * ALONE * ALONE * ALONE), shape: 0 }
}

impl Found {
    /// The search for a model with other coefficients, from here.
    pub(crate) fn with(&self, columns: &[Column], noise: Noise) -> Option<Found> {
        let value = |column: &Column| {
            let own = self.columns.iter().position(|own| own.is_alike(column));
            own.map_or(0.0, |k| self.at.c[k])
        };
        let at = Unknowns { x: self.at.x, c: columns.iter().map(value).collect() };
        let (tracks, paths) = (self.tracks.clone(), self.paths.clone());
        Search { columns, noise, tracks, at, paths, level: self.level }.run()
    }

    /// Share of the squared change of the rates, within times in which the body turns by about a radian, that torque noise makes.
    pub(crate) fn unexplained(&self) -> f64 {
        let (mut left, mut all) = (0.0, 0.0);
        for (track, changes) in self.tracks.iter().zip(&self.changes) {
            let mut sums = [Vector3::zeros(); 2];
            let mut from = track.times[0];
            for (changed, t) in changes.iter().zip(&track.times[1..]) {
                sums = [0, 1].map(|k| sums[k] + changed[k]);
                if t - from >= FIRST {
                    all += sums[0].norm_squared();
                    left += sums[1].norm_squared();
                    (sums, from) = ([Vector3::zeros(); 2], *t);
                }
            }
        }
        if all > 0.0 { left / all } else { 0.0 }
    }

    /// The covariance of the coordinates of the tensor.
    pub(crate) fn covariance(&self) -> Option<Form> {
        let all = self.information.clone().cholesky()?.inverse();
        Some(all.fixed_view::<5, 5>(0, 0).into_owned())
    }
}

impl Search<'_> {
    fn run(mut self) -> Option<Found> {
        let mut is_still = false;
        for round in 0..ROUNDS {
            let law = Law::new(&self.at, self.columns)?;
            let links = self.links(&law)?;
            let solved = self.solve(&links, self.level)?;
            let moved = solved.step.dot(&(solved.information * solved.step)).max(0.0).sqrt();
            let target = self.target(&links, round > 0, moved <= STILL)?;
            let level = Level { torque: target.torque.max(FALL * self.level.torque), ..target };
            // what changes nothing is nothing
            let level = if target.torque == 0.0 && self.is_nothing(&links, level)? { target } else { level };
            let is_same = (level.torque - self.level.torque).abs() <= SAME * level.torque
                && level.shape == self.level.shape;
            self.advance(&links, &solved)?;
            self.level = level;
            if moved <= STILL && is_same {
                is_still = true;
                if !self.leave_out()? {
                    break;
                }
            }
        }
        self.found(is_still)
    }

    fn links(&self, law: &Law) -> Option<Vec<Vec<Link>>> {
        self.tracks.iter().zip(&self.paths).map(|(track, path)| links(track, path, law)).collect()
    }

    fn sums(&self, links: &[Vec<Link>], level: Level) -> Option<Vec<Sums>> {
        let each = self.tracks.iter().zip(&self.paths).zip(links);
        each.map(|((track, path), links)| filter(track, path, links, level, |_| {})).collect()
    }

    fn solve(&self, links: &[Vec<Link>], level: Level) -> Option<Solved> {
        let sums = self.sums(links, level)?;
        let mut information = SMatrix::<f64, SHARED, SHARED>::zeros();
        let mut right = SVector::<f64, SHARED>::zeros();
        let (mut squares, mut determinant, mut count) = (0.0, 0.0, 0.0);
        let (mut of_starts, mut own) = (0.0, Vec::with_capacity(sums.len()));
        for one in &sums {
            let taken = Taken::new(one)?;
            information += taken.information;
            right += taken.right;
            squares += one.squares - taken.start.dot(&(taken.inverse * taken.start));
            of_starts += taken.log_determinant;
            determinant += one.log_determinant;
            count += one.count;
            own.push(taken);
        }
        // coefficients that the model has not
        for k in 5 + self.columns.len()..SHARED {
            information[(k, k)] = 1.0;
        }
        let cholesky = information.cholesky()?;
        let step = cholesky.solve(&right);
        squares = (squares - step.dot(&right)).max(0.0);
        let unknowns = (6 * sums.len() + 5 + self.columns.len()) as f64;
        let dof = count - unknowns;
        if dof <= 0.0 {
            return None;
        }
        let variance = self.noise.attitude.map_or((squares / dof).max(LEAST), |sigma| sigma * sigma);
        let of_unknowns = of_starts + 2.0 * cholesky.l().diagonal().map(libm::log).sum();
        let fit = squares / variance + determinant;
        let starts = own.iter().map(|of| of.inverse * (of.start - of.mixed * step)).collect();
        Some(Solved {
            step,
            starts,
            information: (information + information.transpose()) * (0.5 / variance),
            restricted: fit + dof * libm::log(variance) + of_unknowns,
            plain: fit + count * libm::log(variance),
            variance,
            dof,
        })
    }

    /// Moves path and unknowns, which must stay finite.
    fn advance(&mut self, links: &[Vec<Link>], solved: &Solved) -> Option<()> {
        let of_tensor = solved.step.fixed_rows::<5>(0).into_owned();
        let share = self.room(&of_tensor);
        for (((track, path), links), start) in
            self.tracks.iter().zip(&mut self.paths).zip(links).zip(&solved.starts)
        {
            let mut kept: Vec<Kept> = Vec::with_capacity(path.len());
            filter(track, path, links, self.level, |at| kept.push(at))?;
            let p = together(start, &solved.step);
            for (at, moved) in path.iter_mut().zip(smoothed(&kept, links, &p)) {
                let turn = Vec3([moved[0], moved[1], moved[2]]) * share;
                at.attitude = (at.attitude * Quat::exponential(turn)).normalized();
                at.rate += moved.fixed_rows::<3>(3) * share;
            }
        }
        self.at.x += of_tensor * share;
        self.at.c.iter_mut().zip(solved.step.iter().skip(5)).for_each(|(c, step)| *c += step * share);
        self.at.x.iter().chain(&self.at.c).all(|v| v.is_finite()).then_some(())
    }

    /// The share of a step after which the smallest moment is not yet lost.
    fn room(&self, step: &Coordinates) -> f64 {
        let smallest = |share: f64| eigen(tensor(&(self.at.x + step * share))).0[0];
        let least = KEPT * smallest(0.0);
        let shares = core::iter::successors(Some(1.0), |share| Some(0.5 * share));
        shares.take(SHARES).find(|&share| smallest(share) >= REACHED * least).unwrap_or(0.0)
    }

    /// The likeliest torque noise where the search stands, near that of before where it has `begun`.
    fn target(&self, links: &[Vec<Link>], begun: bool, is_at_rest: bool) -> Option<Level> {
        let at = |level: Level| self.solve(links, level).map_or(f64::INFINITY, |solved| solved.restricted);
        let none = Level { torque: 0.0, ..self.level };
        match self.noise.torque {
            TorqueNoise::None => return Some(none),
            TorqueNoise::Given(density) => {
                let variance = self.solve(links, self.level)?.variance;
                return Some(Level { torque: density / variance, shape: 0 });
            }
            TorqueNoise::Fitted if self.level.torque == 0.0 => return Some(none),
            TorqueNoise::Fitted => {}
        }
        let near = begun.then_some(libm::log10(self.level.torque));
        let mut best: Option<(f64, Level)> = None;
        // the axes of torque noise from where there is a motion
        let shapes = [self.level.shape, 1 - self.level.shape];
        for &shape in &shapes[..if near.is_some() && !is_at_rest { 1 } else { 2 }] {
            let cost = |exponent: f64| at(Level { torque: libm::pow(10.0, exponent), shape });
            let exponent = match near {
                Some(near) => {
                    let (step, least) = (newton(cost, near) - near, cost(near));
                    // far from a minimum a whole step may lead over it
                    let shares = [1.0, 0.3, 0.1].map(|share| near + share * step);
                    shares.into_iter().find(|exponent| cost(*exponent) < least).unwrap_or(near)
                }
                None => {
                    let top = libm::log10(self.level.torque) + 1.0;
                    let each = (0..DECADES).map(|decade| top - decade as f64).map(|e| (cost(e), e));
                    let (_, decade) = each.min_by(|a, b| a.0.total_cmp(&b.0))?;
                    vertex(cost, golden(cost, decade - 1.0, decade + 1.0))
                }
            };
            let (found, torque) = (cost(exponent), libm::pow(10.0, exponent));
            if best.is_none_or(|(least, _)| found < least - RESHAPED) {
                best = Some((found, Level { torque, shape }));
            }
        }
        let (cost, level) = best?;
        Some(if at(none) - cost <= GAIN { none } else { level })
    }

    /// Whether a level of torque noise is as good as none.
    fn is_nothing(&self, links: &[Vec<Link>], level: Level) -> Option<bool> {
        let none = Level { torque: 0.0, ..level };
        let (with, without) = (self.solve(links, level)?, self.solve(links, none)?);
        let moved = with.step - without.step;
        Some(moved.dot(&(without.information * moved)) < STILL && with.restricted - without.restricted < GAIN)
    }

    /// Leaves out the samples that stand out of the noise; whether there was one.
    fn leave_out(&mut self) -> Option<bool> {
        let found = self.found(true)?;
        let mut any = false;
        for (track, whitened) in self.tracks.iter_mut().zip(&found.whitened) {
            for (sample, _) in whitened.iter().filter(|(_, left)| left.norm() > OUTLIER) {
                track.used[*sample] = false;
                any = true;
            }
        }
        Some(any)
    }

    /// What is found where the search stands.
    fn found(&self, is_still: bool) -> Option<Found> {
        let law = Law::new(&self.at, self.columns)?;
        let links = self.links(&law)?;
        let solved = self.solve(&links, self.level)?;
        let deviation = solved.variance.sqrt();
        let (mut whitened, mut of_each, mut taken) = (Vec::new(), Vec::new(), Vec::new());
        for (((track, path), links), start) in
            self.tracks.iter().zip(&self.paths).zip(&links).zip(&solved.starts)
        {
            let p = together(start, &solved.step);
            let (mut own, mut sample) = (Vec::new(), 0);
            let sums = filter(track, path, links, self.level, |at| {
                own.extend(at.whitened(&p).map(|left| (sample, left / deviation)));
                sample += 1;
            })?;
            whitened.push(own);
            of_each.push(of_tensor(&sums, self.columns.len()).unwrap_or_else(Form::zeros) / solved.variance);
            taken.push(Taken::new(&sums)?);
        }
        let size = 5 + self.columns.len();
        let without = (0..taken.len()).map(|k| by_others(&taken, k, size, solved.variance)).collect();
        let changes = links.iter().zip(&self.paths).map(|(links, path)| {
            let each = links.iter().zip(path.windows(2));
            each.map(|(link, path)| [path[1].rate - path[0].rate, -link.left_of_rate()]).collect()
        });
        let changes = changes.collect();
        Some(Found {
            columns: self.columns.to_vec(),
            at: self.at.clone(),
            paths: self.paths.clone(),
            tracks: self.tracks.clone(),
            level: self.level,
            variance: solved.variance,
            information: DMatrix::from_fn(size, size, |i, k| solved.information[(i, k)]),
            of_each,
            without,
            whitened,
            likelihood: -0.5 * solved.plain,
            dof: solved.dof,
            changes,
            is_still,
        })
    }
}

/// A start and what is shared.
fn together(start: &SVector<f64, 6>, shared: &SVector<f64, SHARED>) -> SVector<f64, ALL> {
    SVector::from_iterator(start.iter().chain(shared.iter()).copied())
}

/// The equations of one stretch on what all share, its start taken out.
struct Taken {
    information: SMatrix<f64, SHARED, SHARED>,
    right: SVector<f64, SHARED>,
    /// Of the start: inverse of the information on it, its right-hand side, and its part in what is shared.
    inverse: SMatrix<f64, 6, 6>,
    start: SVector<f64, 6>,
    mixed: SMatrix<f64, 6, SHARED>,
    /// Logarithm of the determinant of the information on the start.
    log_determinant: f64,
}

impl Taken {
    /// `None` where the start is not determined.
    fn new(of: &Sums) -> Option<Taken> {
        let cholesky = of.matrix.fixed_view::<6, 6>(0, 0).into_owned().cholesky()?;
        let inverse = cholesky.inverse();
        let mixed = of.matrix.fixed_view::<6, SHARED>(0, 6).into_owned();
        let start = of.right.fixed_rows::<6>(0).into_owned();
        Some(Taken {
            information: of.matrix.fixed_view::<SHARED, SHARED>(6, 6) - mixed.tr_mul(&(inverse * mixed)),
            right: of.right.fixed_rows::<SHARED>(6) - mixed.tr_mul(&(inverse * start)),
            inverse,
            start,
            mixed,
            log_determinant: 2.0 * cholesky.l().diagonal().map(libm::log).sum(),
        })
    }
}

/// Step and covariance of the tensor by all stretches but the one with number `k`; `size` unknowns are shared.
fn by_others(taken: &[Taken], k: usize, size: usize, variance: f64) -> Option<(Coordinates, Form)> {
    let (mut information, mut right) = (DMatrix::zeros(size, size), DVector::zeros(size));
    for other in taken.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, other)| other) {
        information += other.information.view((0, 0), (size, size));
        right += other.right.rows(0, size);
    }
    let inverse = information.cholesky()?.inverse();
    let step = (&inverse * right).fixed_rows::<5>(0).into_owned();
    Some((step, inverse.fixed_view::<5, 5>(0, 0).into_owned() * variance))
}

/// The information on the tensor by one stretch alone, with `coefficients` of a torque.
fn of_tensor(sums: &Sums, coefficients: usize) -> Option<Form> {
    let others: Vec<usize> = (0..6).chain(11..11 + coefficients).collect();
    let own = DMatrix::from_fn(others.len(), others.len(), |i, k| sums.matrix[(others[i], others[k])]);
    let mixed = DMatrix::from_fn(others.len(), 5, |i, k| sums.matrix[(others[i], 6 + k)]);
    let taken = mixed.tr_mul(&own.cholesky()?.solve(&mixed));
    Some(sums.matrix.fixed_view::<5, 5>(6, 6) - Form::from_fn(|i, k| taken[(i, k)]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use polhode::inertia::Inertia;
    use polhode::num::Random;

    use crate::columns::sets::torque_columns;
    use crate::settings::torque::TorqueModel;
    use crate::simulate::{Disturbances, Gyroscope, simulate_poses};

    const SIGMA: f64 = 3e-3;

    fn x() -> Coordinates {
        Coordinates::new(-0.06, 0.02, 0.03, -0.02, 0.04)
    }

    /// Attitudes of the body `x`, whose trace is 1, under a torque.
    fn tracks(by: &Disturbances) -> Vec<Track> {
        let body = Inertia::from_tensor(tensor(&x())).unwrap();
        let starts =
            [Vector3::new(0.5, 0.8, -0.4), Vector3::new(-0.7, 0.3, 0.6), Vector3::new(0.2, -0.6, 0.8)];
        let mut random = Random::new(14);
        let each = starts.map(|start| {
            let times: Vec<f64> = (0..=120).map(|k| 0.1 * f64::from(k) - 6.0).collect();
            // torque noise acts from time 0 on
            let later: Vec<f64> = times.iter().map(|t| t + 6.0).collect();
            let made =
                simulate_poses(&body, start, &later, by, &Gyroscope::default(), SIGMA, &mut random).unwrap();
            let attitudes = made.attitudes.iter().map(|q| Quat::from(*q)).collect();
            Track { attitudes, rates: Vec::new(), used: vec![true; times.len()], times }
        });
        each.into()
    }

    fn noise(torque: TorqueNoise) -> Noise {
        Noise { attitude: None, torque }
    }

    fn near(found: &Coordinates, information: &Form) -> f64 {
        let off = found - x();
        off.dot(&(information * off))
    }

    /// The information of all is the sum of what each stretch tells, and without one of them the others say what they say alone.
    #[test]
    fn stretches_add_up_and_tell_the_tensor_without_each_other() {
        let tracks = tracks(&Disturbances::default());
        let found = first(&tracks, x(), &[], noise(TorqueNoise::Fitted)).unwrap();
        assert!(found.is_still && found.level.torque == 0.0);
        // 363 attitudes, three starts of six numbers and five of the tensor
        assert_eq!(found.dof, f64::from(3 * 363 - 18 - 5));
        assert!((found.variance.sqrt() / SIGMA - 1.0).abs() < 0.1, "{}", found.variance.sqrt());
        let information = Form::from_fn(|i, k| found.information[(i, k)]);
        let sum: Form = found.of_each.iter().sum();
        assert!((sum - information).amax() < 1e-9 * information.amax());
        assert!((found.covariance().unwrap() * information - Form::identity()).amax() < 1e-9);
        assert!(near(&found.at.x, &information) < 25.75);
        // innovations are white, of variance 1
        let squares = found.whitened.iter().flatten().map(|(_, left)| left.norm_squared()).sum::<f64>();
        assert!((squares / found.dof - 1.0).abs() < 1e-9, "{squares}");
        for (k, without) in found.without.iter().enumerate() {
            let (step, covariance) = without.unwrap();
            let others: Vec<Track> =
                tracks.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, track)| track.clone()).collect();
            let alone = first(&others, found.at.x, &[], noise(TorqueNoise::Fitted)).unwrap();
            let own = covariance.try_inverse().unwrap();
            let apart = found.at.x + step - alone.at.x;
            assert!(apart.dot(&(own * apart)) < 0.01, "{k}: {}", apart.dot(&(own * apart)));
            let ratio =
                alone.covariance().unwrap().trace() / alone.variance * found.variance / covariance.trace();
            assert!((ratio - 1.0).abs() < 0.05, "{k}: {ratio}");
        }
        assert!(found.unexplained() < 1e-6, "{}", found.unexplained());
        // twice the log-likelihood of normal innovations
        let all = 3.0 * 363.0;
        let expected = -0.5 * (found.dof + all * libm::log(found.variance));
        assert!(
            (found.likelihood - expected).abs() < 1e-6 * expected.abs(),
            "{} {expected}",
            found.likelihood
        );
    }

    /// A torque that acts is found by the model that has it, to its deviations, and gains what the model without it lacks.
    #[test]
    fn a_torque_is_found_from_the_search_without_it() {
        let torque = Vector3::new(4e-3, -2e-3, 3e-3);
        let tracks = tracks(&Disturbances::default().with_torque(torque));
        let none = first(&tracks, x(), &[], noise(TorqueNoise::Fitted)).unwrap();
        assert!(none.level.torque > 0.0, "torque noise stands in for a torque");
        let columns = torque_columns(TorqueModel::Constant);
        let with = none.with(&columns, noise(TorqueNoise::Fitted)).unwrap();
        assert!(with.is_still && with.level.torque == 0.0 && with.likelihood > none.likelihood + 10.0);
        let covariance = with.information.clone().try_inverse().unwrap();
        for k in 0..3 {
            let sigma = covariance[(5 + k, 5 + k)].sqrt();
            assert!((with.at.c[k] - torque[k]).abs() < 5.0 * sigma && sigma < 1e-3, "{k}: {}", with.at.c[k]);
        }
        // the search with a torque begins at the values of that before
        let again = with.with(&columns, noise(TorqueNoise::None)).unwrap();
        assert!((again.at.x - with.at.x).amax() < 1e-6 && (again.at.c[0] - with.at.c[0]).abs() < 1e-6);
    }

    /// Torque noise of the simulation is found to its scatter, and what it makes of the rates is not explained.
    #[test]
    fn torque_noise_is_found_where_it_acts() {
        let density = 0.01;
        let made = Disturbances::default().with_torque_noise(density);
        let tracks = tracks(&made);
        let found = first(&tracks, x(), &[], noise(TorqueNoise::Fitted)).unwrap();
        // of the torque, N m √s, or of the angular acceleration that it makes
        let squared = tensor(&x()).try_inverse().map_or(0.0, |inverse| (inverse * inverse).trace() / 3.0);
        let acceleration = density * density * squared;
        let level = match found.level.shape {
            0 => found.level.torque * found.variance / acceleration,
            _ => found.level.torque * found.variance / 9.0 / (density * density),
        };
        assert!(found.is_still && (0.5..2.0).contains(&level), "{level}");
        assert!((found.variance.sqrt() / SIGMA - 1.0).abs() < 0.15, "{}", found.variance.sqrt());
        let information = Form::from_fn(|i, k| found.information[(i, k)]);
        assert!(near(&found.at.x, &information) < 25.75);
        let share = found.unexplained();
        assert!((0.001..0.5).contains(&share), "{share}");
        // given its level, the search stays there
        let given = first(&tracks, x(), &[], noise(TorqueNoise::Given(acceleration))).unwrap();
        let own = given.level.torque * given.variance / acceleration;
        assert!(given.is_still && given.level.shape == 0 && (own - 1.0).abs() < 0.05, "{own}");
        // of motions under it a search without it says how much it lacks
        let free = first(&tracks, x(), &[], noise(TorqueNoise::None)).unwrap();
        let gain =
            gain_of_noise(&tracks, free.at.clone(), &[], free.paths.clone(), noise(TorqueNoise::Fitted));
        assert!(gain.unwrap() > 20.0, "{gain:?}");
    }

    /// Torque noise begins where each sample is heard for half a radian: twice the longest of reach over samples, over its fourth power.
    #[test]
    fn the_search_begins_with_samples_that_stand_alone() {
        let track = |times: &[f64]| Track {
            times: times.to_vec(),
            attitudes: vec![Quat::identity(); times.len()],
            rates: Vec::new(),
            used: vec![true; times.len()],
        };
        let tracks = [track(&[-1.0, 0.0, 0.5, 1.0]), track(&[-3.0, -1.0, 1.0, 2.0])];
        // 2 · (3/4) · 16
        assert_eq!(boundless(&tracks), Level { torque: 24.0, shape: 0 });
    }

    /// A step is halved until a tenth of the smallest moment is left, nearly.
    #[test]
    fn a_step_leaves_a_tenth_of_the_smallest_moment() {
        let search = Search {
            columns: &[],
            noise: noise(TorqueNoise::None),
            tracks: Vec::new(),
            at: Unknowns::at(Coordinates::zeros(), &[]),
            paths: Vec::new(),
            level: Level { torque: 0.0, shape: 0 },
        };
        // of a sphere the moment zz falls from 1/3 to what is asked for
        let to = |zz: f64| Coordinates::new(0.0, (1.0 / 3.0 - zz) * 1.5_f64.sqrt(), 0.0, 0.0, 0.0);
        assert!((tensor(&to(0.2))[(2, 2)] - 0.2).abs() < 1e-15);
        for (zz, share) in [(0.2, 1.0), (0.0332, 1.0), (0.0328, 0.5), (-0.2, 0.5), (-0.5, 0.25)] {
            assert_eq!(search.room(&to(zz)), share, "{zz}");
        }
    }

    /// Changes of the rates count from one time to the next that is a radian later, with what torque noise made of them; what is left over
    /// at the end does not.
    #[test]
    fn the_share_of_torque_noise_is_that_of_changes_within_a_radian() {
        let times = vec![0.0, 0.4, 0.8, 1.2, 1.5, 2.3, 2.4];
        let track = Track { attitudes: Vec::new(), rates: Vec::new(), used: vec![true; 7], times };
        let (x, y) = (Vector3::<f64>::x(), Vector3::<f64>::y());
        // 1 + 1 + 2 and 3 + 0 along x, beside ½ + ½ along y and 1 − 2 along x by noise
        let changes = [(1.0, y * 0.5), (1.0, y * 0.5), (2.0, y * 0.0), (3.0, x), (0.0, x * -2.0), (9.0, x)];
        let found = Found {
            columns: Vec::new(),
            at: Unknowns::at(Coordinates::zeros(), &[]),
            paths: Vec::new(),
            tracks: vec![track],
            level: Level { torque: 1.0, shape: 0 },
            variance: 1.0,
            information: DMatrix::identity(5, 5) * 4.0,
            of_each: Vec::new(),
            without: Vec::new(),
            whitened: Vec::new(),
            likelihood: 0.0,
            dof: 1.0,
            changes: vec![changes.map(|(size, noise)| [x * size, noise]).to_vec()],
            is_still: true,
        };
        // (1 + 1)/(16 + 9)
        assert!((found.unexplained() - 0.08).abs() < 1e-15);
        assert!((found.covariance().unwrap() - Form::identity() * 0.25).amax() < 1e-15);
        let none = Found { changes: vec![Vec::new()], ..found };
        assert_eq!(none.unexplained(), 0.0);
    }

    /// Of attitudes that a path follows to the last digit torque noise tells nothing: a little of it is nothing, and so much that each sample stands
    /// alone is not, as it costs more. Where a torque that the law has not moves the tensor, noise that explains it better is not nothing either.
    #[test]
    fn torque_noise_is_nothing_where_it_neither_costs_nor_moves() {
        let times: Vec<f64> = (0..40).map(|k| 0.1 * f64::from(k) - 1.95).collect();
        let path = |torque: f64| {
            let at = Unknowns { x: x(), c: vec![torque, -torque, torque] };
            let law = Law::new(&at, &torque_columns(TorqueModel::Constant)).unwrap();
            let mut path = vec![Start { attitude: Quat::identity(), rate: Vector3::new(0.5, 0.8, -0.4) }];
            for pair in times.windows(2) {
                let next = law.carry(&path[path.len() - 1], pair[1] - pair[0]).unwrap();
                path.push(Start { attitude: next.attitude, rate: next.rate });
            }
            path
        };
        let is_nothing = |torque: f64, level: f64| {
            let attitudes = path(torque).iter().map(|at| at.attitude).collect();
            let track = Track { attitudes, rates: Vec::new(), used: vec![true; 40], times: times.clone() };
            let search = Search {
                columns: &[],
                noise: Noise { attitude: Some(1e-3), torque: TorqueNoise::Fitted },
                tracks: vec![track],
                at: Unknowns::at(x(), &[]),
                paths: vec![path(0.0)],
                level: Level { torque: level, shape: 0 },
            };
            let links = search.links(&Law::new(&search.at, &[]).unwrap()).unwrap();
            search.is_nothing(&links, search.level).unwrap()
        };
        assert!(is_nothing(0.0, 0.0) && is_nothing(0.0, 1e-9) && !is_nothing(0.0, 1e3));
        assert!(!is_nothing(0.02, 1e3));
    }
}
