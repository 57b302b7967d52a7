//! Rounds of the weak equations at samples that each round moves further onto them.

use crate::thresholds::radius::PART;
use crate::thresholds::rounds::{
    BESIDE, BOUNDLESS, CLEAR, DESCENT, FALL, FIRST, FULL_ROUNDS, KEPT, NEGLIGIBLE, REACHED, RELAXED, ROUNDS,
    SAME, SHARES, SIGNIFICANT_GAIN, STILL, TORQUES,
};
use nalgebra::Vector3;
use polhode::record::both;

use crate::columns::column::{Column, Unknowns};
use crate::physical::coordinates::{Coordinates, Form, eigen, tensor};
use crate::signal::covariance::{Covariance, Levels};
use crate::signal::stretch::Stretch;
use crate::signal::test_functions::TestFunctions;
use crate::solve::levels::likeliest;
use crate::solve::linearised::{Linearised, Whitened};
use crate::solve::stacked::{Pull, Stacked};
use crate::solve::weak_estimate::{Part, WeakEstimate};
use crate::thresholds::noise::SURE;

/// What of its noise a descent fits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Noise {
    /// No torque noise.
    White,
    /// Torque noise of a given level.
    Given(f64),
    /// Torque noise by restricted likelihood, and the noise of the rates of each of several stretches.
    Fitted,
}

/// The rows of the equations of one stretch whitened, and nothing else of them.
fn whitened_rows(
    stretch: &Stretch,
    noise: &[Vector3<f64>],
    part: Linearised,
    levels: Levels,
) -> Option<Vec<f64>> {
    let factor = part.covariance(stretch, noise).into_factor(levels)?;
    let mut rows = part.rows;
    factor.forward(&mut rows, part.width);
    Some(rows)
}

/// Where rounds have ended, from where others of the same stretches may go on.
pub(crate) struct Reached {
    columns: Vec<Column>,
    at: Unknowns,
    stretches: Vec<ReachedBy>,
    driven: bool,
}

/// Where they have ended for one stretch.
struct ReachedBy {
    /// Its number.
    stretch: usize,
    levels: Levels,
    /// The noise of its samples, which a part of the record does not tell.
    noise: Option<Vec<Vector3<f64>>>,
}

impl Reached {
    /// Where an estimate ended.
    pub(crate) fn of(weak: &WeakEstimate) -> Self {
        let each = weak.parts.iter().map(|part| ReachedBy {
            stretch: part.stretch,
            levels: part.levels,
            noise: Some(part.noise.clone()),
        });
        let (columns, at) = (weak.columns.clone(), weak.at.clone());
        Reached { columns, at, stretches: each.collect(), driven: false }
    }

    /// The same of one that is not needed any more.
    pub(crate) fn of_former(weak: WeakEstimate) -> Self {
        let each = weak.parts.into_iter().map(|part| ReachedBy {
            stretch: part.stretch,
            levels: part.levels,
            noise: Some(part.noise),
        });
        Reached { columns: weak.columns, at: weak.at, stretches: each.collect(), driven: false }
    }

    /// Where rounds of a part of the record have ended, whose stretches keep their numbers.
    pub(crate) fn of_part(rounds: &Rounds<'_>) -> Self {
        let each = rounds.used.iter().zip(&rounds.levels);
        let each =
            each.map(|((_, s, _), levels)| ReachedBy { stretch: s.index, levels: *levels, noise: None });
        Reached {
            columns: rounds.columns.to_vec(),
            at: rounds.at.clone(),
            stretches: each.collect(),
            driven: rounds.driven,
        }
    }
}

pub(crate) struct Rounds<'a> {
    used: Vec<(usize, &'a Stretch, TestFunctions)>,
    columns: &'a [Column],
    noise: Vec<Vec<Vector3<f64>>>,
    levels: Vec<Levels>,
    pub(crate) at: Unknowns,
    pull: Option<Pull>,
    /// Whether the effect of torque noise is taken out of the derivatives.
    driven: bool,
    /// Whether a descent goes on from where another has ended.
    resumed: bool,
}

impl<'a> Rounds<'a> {
    pub(crate) fn new(
        stretches: &'a [Stretch],
        radius: f64,
        columns: &'a [Column],
        at: Unknowns,
    ) -> Option<Self> {
        let used: Vec<_> = stretches
            .iter()
            .enumerate()
            .filter_map(|(k, s)| TestFunctions::new(s, radius).map(|tests| (k, s, tests)))
            .collect();
        let rows: usize = used.iter().map(|(_, _, tests)| 3 * tests.count).sum();
        if rows < 6 {
            return None;
        }
        let noise = used.iter().map(|(_, s, _)| vec![Vector3::zeros(); s.times.len()]).collect();
        let levels = vec![Levels::WHITE; used.len()];
        Some(Rounds { used, columns, noise, levels, at, pull: None, driven: false, resumed: false })
    }

    /// With what is known of the tensor beforehand, in units of the noise of the rates.
    pub(crate) fn with_pull(self, pull: Pull) -> Self {
        Rounds { pull: Some(pull), ..self }
    }

    /// From where others of the same stretches have ended; `None` where they had not all of these. Columns that those had not
    /// are zero.
    pub(crate) fn resumed(mut self, mut from: Reached) -> Option<Self> {
        // those beyond a part of the record are like the first of it
        let first = from.stretches.first().filter(|first| first.noise.is_none()).map(|first| first.levels);
        for ((k, stretch, _), (levels, noise)) in
            self.used.iter().zip(self.levels.iter_mut().zip(&mut self.noise))
        {
            let Some(own) = from.stretches.iter_mut().find(|own| own.stretch == *k) else {
                *levels = first?;
                continue;
            };
            *levels = own.levels;
            if let Some(of_samples) = own.noise.take() {
                if of_samples.len() != stretch.times.len() {
                    return None;
                }
                *noise = of_samples;
            }
        }
        self.at.x = from.at.x;
        for (c, column) in self.at.c.iter_mut().zip(self.columns) {
            let alike = from.columns.iter().position(|other| other.is_alike(column));
            *c = alike.map_or(*c, |k| from.at.c[k]);
        }
        self.resumed = true;
        self.driven = from.driven;
        Some(self)
    }

    /// The equations of each stretch at the samples so far, with their covariances.
    fn with_covariances(&self) -> (Vec<Linearised>, Vec<Covariance>) {
        let each = self.used.iter().zip(&self.noise);
        let of = |((_, s, tests), noise): (&(_, &Stretch, TestFunctions), &Vec<_>)| {
            Linearised::with_covariance(s, noise, self.columns, self.at.clone(), tests.clone())
        };
        each.map(of).unzip()
    }

    /// These equations without their rows, and what they are whitened.
    pub(crate) fn whiten(&self) -> Option<(Vec<Linearised>, Vec<Whitened>)> {
        let (mut parts, covariances) = self.with_covariances();
        let each = parts.iter_mut().zip(covariances).zip(&self.levels);
        let whitened = each.map(|((part, covariance), levels)| {
            let factor = covariance.into_factor(*levels)?;
            Some(part.take_whitened(factor, *levels, self.driven.then_some(self.columns)))
        });
        let whitened = whitened.collect::<Option<_>>()?;
        Some((parts, whitened))
    }

    /// Whether parts of a round are worked out side by side.
    fn is_beside(&self) -> bool {
        self.noise.iter().map(Vec::len).sum::<usize>() > BESIDE
    }

    pub(crate) fn stack(&self, whitened: &[Whitened], variance: f64) -> Stacked {
        self.stack_rows(whitened.iter().map(|w| w.rows.as_slice()), variance)
    }

    fn stack_rows<'b>(&self, rows: impl Iterator<Item = &'b [f64]>, variance: f64) -> Stacked {
        let rows: Vec<&[f64]> = rows.collect();
        match self.at.x == Coordinates::zeros() {
            true => Stacked::new(&rows, &self.columns_at_sphere(), &self.at, variance.sqrt()),
            false => Stacked::new(&rows, self.columns, &self.at, variance.sqrt()),
        }
    }

    fn columns_at_sphere(&self) -> Vec<Column> {
        self.columns.iter().map(|column| column.at_sphere()).collect()
    }

    /// One round: by how many standard deviations it would move the tensor if it took its whole step, and the misfit of the
    /// equations.
    ///
    /// A ridge as weak as one reading keeps x finite before it is known that the record determines it.
    pub(crate) fn round(&mut self, variance: f64, full: bool) -> Option<(f64, f64)> {
        let (parts, whitened) = self.whiten()?;
        let stacked = self.stack(&whitened, variance);
        let next = match &self.pull {
            Some(pull) => stacked.pulled(pull)?,
            None => stacked.ridge(variance)?,
        };
        // where torques act, full steps may end in going to and fro
        let misfit = stacked.excess(variance);
        let relax = if full || misfit < TORQUES { 1.0 } else { RELAXED };
        Some((self.advance(&parts, &whitened, &stacked, &next, relax, variance), misfit))
    }

    fn advance(
        &mut self,
        parts: &[Linearised],
        whitened: &[Whitened],
        stacked: &Stacked,
        next: &Unknowns,
        relax: f64,
        variance: f64,
    ) -> f64 {
        let step = next.x - self.at.x;
        let relax = relax * self.room(&step);
        let used = self.used.iter().map(|(_, s, _)| *s);
        for (((part, white), s), noise) in parts.iter().zip(whitened).zip(used).zip(&mut self.noise) {
            white.carry(part, s, noise, next, relax);
        }
        self.at.x += step * relax;
        for (c, next) in self.at.c.iter_mut().zip(&next.c) {
            *c += (next - *c) * relax;
        }
        (stacked.root * step).norm() / (variance * stacked.excess(variance)).sqrt()
    }

    /// The share of `step` after which the smallest moment is not yet lost.
    fn room(&self, step: &Coordinates) -> f64 {
        let smallest = |share: f64| eigen(tensor(&(self.at.x + step * share))).0[0];
        let least = KEPT * smallest(0.0);
        if smallest(1.0) >= least {
            return 1.0;
        }
        // a step that ends where the moment vanishes keeps just that much at the first of them
        let shares = core::iter::successors(Some(1.0 - KEPT), |share| Some(0.5 * share));
        shares.take(SHARES).find(|&share| smallest(share) >= REACHED * least).unwrap_or(0.0)
    }

    /// Rounds until the tensor stands still, and by how many standard deviations the last would have moved it.
    pub(crate) fn settle(&mut self, variance: f64) -> Option<f64> {
        self.settle_unless(variance, |_, _| false)
    }

    /// The same, ended where the misfits of two rounds one after the other say so; it has then not settled.
    pub(crate) fn settle_unless(&mut self, variance: f64, ends: impl Fn(f64, f64) -> bool) -> Option<f64> {
        let (mut moved, mut before) = (f64::INFINITY, f64::INFINITY);
        for round in 0..ROUNDS {
            let misfit;
            (moved, misfit) = self.round(variance, round < FULL_ROUNDS)?;
            if moved <= STILL {
                break;
            }
            if ends(before, misfit) {
                return Some(f64::INFINITY);
            }
            before = misfit;
        }
        Some(moved)
    }

    /// Rounds from boundless torque noise, where the equations are those of convex least squares, down to the likeliest; or from
    /// where others ended.
    pub(crate) fn descend(&mut self, variance: f64, noise: Noise) -> Option<f64> {
        let several = self.used.len() > 1;
        let mut moved = f64::INFINITY;
        for round in 0..DESCENT {
            let (parts, covariances) = self.with_covariances();
            if round == 0 && !self.resumed {
                let boundless = |part: &Covariance| {
                    let (noise, torque) = part.mean_variances();
                    Levels { torque: BOUNDLESS * noise / torque, ..Levels::WHITE }
                };
                self.levels = covariances.iter().map(boundless).collect();
            }
            let each = parts.iter().zip(&covariances).zip(&self.levels);
            let whitened = each.map(|((part, covariance), levels)| {
                let driven = self.driven.then_some(self.columns);
                Some(part.whitened(covariance.factor(*levels)?, *levels, driven))
            });
            let whitened: Vec<Whitened> = whitened.collect::<Option<_>>()?;
            let stacked = self.stack(&whitened, variance);
            let next = stacked.ridge(variance)?;
            let fitted = (stacked.rows.saturating_sub(5).max(1)) as f64 / stacked.rows.max(1) as f64;
            let (before, is_first) = (self.levels.clone(), round == 0 && !self.resumed);
            let target = |((part, covariance), levels): ((&Linearised, &Covariance), &Levels)| match noise {
                Noise::White => Some(Levels::WHITE),
                Noise::Given(torque) => Some(Levels { torque, ..Levels::WHITE }),
                Noise::Fitted => {
                    let last = (!is_first).then_some(*levels);
                    likeliest(covariance, &part.residuals(&next), variance, fitted, several, last)
                }
            };
            let targets;
            (moved, targets) = both(
                self.is_beside(),
                || self.advance(&parts, &whitened, &stacked, &next, 1.0, variance),
                || parts.iter().zip(&covariances).zip(&before).map(target).collect::<Option<Vec<Levels>>>(),
            );
            let mut changed = false;
            for ((covariance, levels), target) in covariances.iter().zip(&mut self.levels).zip(targets?) {
                let (own, torque) = covariance.mean_variances();
                let floor = FALL * levels.torque;
                let mut new = Levels { torque: target.torque.max(floor), ..target };
                if new.torque * torque < NEGLIGIBLE * own * new.white && target.torque < new.torque {
                    new.torque = target.torque;
                }
                changed |= (new.torque - levels.torque).abs() > SAME * levels.torque;
                *levels = new;
            }
            let done = moved <= STILL && !changed;
            let torques = self.levels.iter().any(|levels| levels.torque > 0.0);
            if done && (self.driven || !torques) {
                break;
            }
            // not on the way down, where the problem is to stay convex
            self.driven |= !changed && torques;
        }
        Some(moved)
    }

    /// With the levels that other rounds of the same stretches have found.
    pub(crate) fn with_levels(mut self, other: &Rounds<'_>) -> Self {
        self.driven = other.driven;
        let of = |stretch: usize| other.used.iter().position(|(k, ..)| *k == stretch);
        for ((k, ..), levels) in self.used.iter().zip(&mut self.levels) {
            if let Some(at) = of(*k) {
                *levels = other.levels[at];
            }
        }
        self
    }

    pub(crate) fn finish(self, variance: f64, moved: f64) -> Option<WeakEstimate> {
        let (mut parts, mut whitened, mut determinants) = (Vec::new(), Vec::new(), Vec::new());
        for (((_, s, tests), noise), levels) in self.used.iter().zip(&self.noise).zip(&self.levels) {
            let part = Linearised::new(s, noise, self.columns, self.at.clone(), tests.clone());
            let (rows, determinant) = if *levels == Levels::WHITE {
                (part.whitened_by_rates(s, noise)?, 0.0)
            } else {
                let covariance = part.covariance(s, noise);
                let white = covariance.factor(Levels::WHITE);
                let driven = self.driven.then_some(self.columns);
                let own = part.whitened(covariance.into_factor(*levels)?, *levels, driven);
                let determinant = own.log_determinant_over(white.as_ref());
                (own.rows, determinant)
            };
            parts.push(part);
            whitened.push(rows);
            determinants.push(determinant);
        }
        let stacked = self.stack_rows(whitened.iter().map(Vec::as_slice), variance);
        let best = self.pull.as_ref().map_or_else(|| stacked.minimiser(), |pull| stacked.pulled(pull));
        let at = best.unwrap_or_else(|| self.at.clone());
        // the rounds have taken the noise out of G, but for the three numbers by which each motion starts: where it
        // stands out of the noise by far, they add nothing; where it does not, they would pass for a motion
        let unit = variance * stacked.excess(variance);
        let is_clear = self.gain_of_part(&whitened, variance) > CLEAR * SIGNIFICANT_GAIN * unit;
        let stands_out = is_clear
            || self.squares_of_sphere(&self.used, variance)? - stacked.squares > SIGNIFICANT_GAIN * unit;
        let (root, doubt) =
            if stands_out { (stacked.root, Form::zeros()) } else { self.constant_rates(variance)? };
        let radius = self.used.first()?.2.radius;
        let each = self.used.into_iter().zip(parts).zip(whitened).zip(determinants);
        let each = each.zip(self.levels).zip(self.noise);
        let each = each.map(|((((((k, ..), mut linearised), rows), log_determinant), levels), noise)| {
            let left = linearised.residuals(&at);
            linearised.rows = Vec::new();
            Part { stretch: k, linearised, rows, left, levels, log_determinant, noise }
        });
        let parts = each.collect();
        Some(WeakEstimate {
            radius,
            columns: self.columns.to_vec(),
            at,
            moved,
            root,
            doubt,
            squares: stacked.squares,
            rows: stacked.rows,
            stacked: Some(stacked),
            parts,
        })
    }

    /// What can be said without any tensor to go by: the information of constant rates, weighted as for a sphere.
    pub(crate) fn at_sphere(mut self, variance: f64) -> Option<WeakEstimate> {
        self.at = Unknowns::at(Coordinates::zeros(), self.columns);
        let ((root, doubt), squares) =
            (self.constant_rates(variance)?, self.squares_of_sphere(&self.used, variance)?);
        let rows = self.used.iter().map(|(_, _, tests)| 3 * tests.count).sum();
        Some(WeakEstimate {
            radius: self.used.first()?.2.radius,
            columns: self.columns.to_vec(),
            at: self.at,
            moved: f64::INFINITY,
            root,
            doubt,
            squares,
            rows,
            stacked: None,
            parts: Vec::new(),
        })
    }

    /// By how much the sphere leaves more of the first equations of the longest stretch than the tensor does; zero where that has none so
    /// short.
    fn gain_of_part(&self, whitened: &[Vec<f64>], variance: f64) -> f64 {
        let longest = self.used.iter().zip(whitened).max_by_key(|((_, s, _), _)| s.times.len());
        let Some(((k, stretch, tests), own)) = longest else { return 0.0 };
        let head = stretch.head(PART.min(stretch.times.len() / FIRST));
        let Some(tests) = TestFunctions::new(&head, tests.radius) else { return 0.0 };
        let part = 3 * tests.count;
        let of_sphere = self.squares_of_sphere(&[(*k, &head, tests)], variance);
        // rows are whitened by those before them alone
        let width = self.columns.len() + 6;
        let rows = own.chunks_exact(width).take(part);
        let of_tensor: f64 = rows.map(|row| row[width - 1] * row[width - 1]).sum();
        of_sphere.map_or(0.0, |of_sphere| of_sphere - of_tensor)
    }

    /// What the weak equations of the sphere leave of stretches, whose rates are constant but for the columns.
    fn squares_of_sphere(&self, used: &[(usize, &Stretch, TestFunctions)], variance: f64) -> Option<f64> {
        let origin = Unknowns { x: Coordinates::zeros(), c: self.at.c.clone() };
        let mut all = Vec::new();
        for (k, s, tests) in used {
            let levels = self.used.iter().position(|(own, ..)| own == k).map(|place| self.levels[place])?;
            let raw = vec![Vector3::zeros(); s.times.len()];
            let part = Linearised::new(s, &raw, self.columns, origin.clone(), tests.clone());
            all.push(whitened_rows(s, &raw, part, levels)?);
        }
        let rows: Vec<&[f64]> = all.iter().map(Vec::as_slice).collect();
        Some(Stacked::new(&rows, &self.columns_at_sphere(), &origin, variance.sqrt()).squares_at(&origin.x))
    }

    /// R of motions that keep their mean rates, and D.
    fn constant_rates(&self, variance: f64) -> Option<(Form, Form)> {
        let (mut at_means, mut displaced) = (Vec::new(), Vec::new());
        let width = self.columns.len() + 6;
        for ((_, s, tests), levels) in self.used.iter().zip(&self.levels) {
            let count = s.rates.len() as f64;
            let mean = s.rates.iter().sum::<Vector3<f64>>() / count;
            let at = |rate: Vector3<f64>| {
                let noise: Vec<_> = s.rates.iter().map(|w| w - rate).collect();
                let part = Linearised::new(s, &noise, self.columns, self.at.clone(), tests.clone());
                whitened_rows(s, &noise, part, *levels)
            };
            at_means.push(at(mean)?);
            let sure = SURE * (variance / count).sqrt();
            for axis in 0..3 {
                let step = Vector3::ith(axis, sure);
                let (above, below) = (at(mean + step)?, at(mean - step)?);
                let rows = above.chunks_exact(width).zip(below.chunks_exact(width));
                let tensor = self.columns.len()..width;
                let difference = |(a, b): (&[f64], &[f64])| {
                    let pairs = a[tensor.clone()].iter().zip(&b[tensor.clone()]);
                    pairs.map(|(a, b)| 0.5 * (a - b)).collect::<Vec<f64>>()
                };
                displaced.push(rows.flat_map(difference).collect::<Vec<f64>>());
            }
        }
        let root = |rows: &[Vec<f64>], columns: &[Column]| {
            let rows: Vec<&[f64]> = rows.iter().map(Vec::as_slice).collect();
            let at = Unknowns { x: self.at.x, c: self.at.c[..columns.len()].to_vec() };
            Stacked::new(&rows, columns, &at, variance.sqrt()).root
        };
        Some((root(&at_means, self.columns), root(&displaced, &[])))
    }

    /// V.
    pub(crate) fn inflation(&self, parts: &[Linearised], whitened: &[Whitened]) -> Form {
        let samples = self.used.iter().map(|(_, s, _)| *s).zip(&self.noise);
        let each = parts.iter().zip(whitened).zip(samples);
        each.map(|((p, w), (s, noise))| p.inflation(w, s, noise)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::drag::Drag;
    use crate::columns::offset::Offset;
    use crate::columns::scale::Scale;
    use crate::physical::coordinates::coordinates;
    use crate::signal::covariance::Shape;
    use crate::simulate::simulate;
    use nalgebra::Matrix3;
    use polhode::inertia::Inertia;
    use polhode::num::Random;

    /// A body of the moments 1, 2 and 2.6 in noise of a hundredth.
    fn tumbling() -> [Stretch; 1] {
        let times: Vec<f64> = (0..=200).map(|k| 0.1 * f64::from(k)).collect();
        let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
        let rates = simulate(&body, Vector3::new(0.5, 0.8, -0.4), &times, 1e-2, &mut Random::new(3)).unwrap();
        [Stretch::new(times, rates)]
    }

    /// A round of a misfit that noise does not explain goes half of the way, where it does not have to be whole: tensor, columns and samples. How far
    /// the whole way is in deviations does not depend on that.
    #[test]
    fn a_later_round_under_torques_goes_half_of_the_way() {
        let (stretches, columns) = (tumbling(), [Column::new(Drag, Some(0.1))]);
        let at = Unknowns { x: moments(0.2, 0.33, 0.47), c: vec![0.02] };
        for (variance, is_half) in [(1e-6, true), (1e-3, false)] {
            let of = |full: bool| {
                let mut rounds = Rounds::new(&stretches, 1.0, &columns, at.clone()).unwrap();
                let stacked = rounds.stack(&rounds.whiten().unwrap().1, variance);
                let (moved, misfit) = rounds.round(variance, full).unwrap();
                assert_eq!((misfit, misfit >= TORQUES), (stacked.excess(variance), is_half));
                (rounds, stacked.root, moved, misfit)
            };
            let ((whole, root, moved, misfit), (half, _, same, _)) = (of(true), of(false));
            let share = if is_half { 0.5 } else { 1.0 };
            let step = whole.at.x - at.x;
            assert!((half.at.x - at.x - step * share).amax() < 1e-14 && step.norm() > 1e-3);
            assert!((half.at.c[0] - at.c[0] - (whole.at.c[0] - at.c[0]) * share).abs() < 1e-14);
            for (whole, half) in whole.noise[0].iter().zip(&half.noise[0]) {
                assert!((half - whole * share).amax() < 1e-14);
            }
            let deviations = (root * step).norm() / (variance * misfit).sqrt();
            assert!((moved / deviations - 1.0).abs() < 1e-9 && same == moved, "{moved} {deviations}");
        }
    }

    /// A descent from boundless torque noise ends at rest at the noise that it is to reach; where that is torque noise, its effect is taken out of
    /// the derivatives.
    #[test]
    fn a_descent_ends_at_the_noise_that_is_asked_for() {
        let stretches = tumbling();
        let given = Levels { torque: 0.5, ..Levels::WHITE };
        for (noise, expected) in [(Noise::White, Levels::WHITE), (Noise::Given(0.5), given)] {
            let at = Unknowns { x: Coordinates::zeros(), c: Vec::new() };
            let mut rounds = Rounds::new(&stretches, 1.0, &[], at).unwrap();
            let moved = rounds.descend(1e-4, noise).unwrap();
            assert!(moved <= STILL, "{noise:?}: {moved}");
            assert_eq!((&rounds.levels[..], rounds.driven), (&[expected][..], expected.torque > 0.0));
            let apart = (rounds.at.x - moments(1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6)).amax();
            assert!(apart < 0.02, "{noise:?}: {apart}");
        }
    }

    /// Noise of four times the variance has a quarter of the information and of the squares, and log 4 more in its determinant for each equation.
    #[test]
    fn an_estimate_is_told_at_its_levels() {
        let stretches = tumbling();
        let of = |white: f64| {
            let at = Unknowns { x: moments(1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6), c: Vec::new() };
            let mut rounds = Rounds::new(&stretches, 1.0, &[], at).unwrap();
            rounds.levels[0].white = white;
            rounds.finish(1e-4, 0.25).unwrap()
        };
        let (one, four) = (of(1.0), of(4.0));
        assert!((one.x() - four.x()).amax() < 1e-10 && (one.moved, one.radius) == (0.25, 1.0));
        let information = |weak: &WeakEstimate| weak.root.tr_mul(&weak.root);
        assert!((information(&one) - information(&four) * 4.0).amax() < 1e-9 * information(&one).amax());
        assert!((four.squares * 4.0 / one.squares - 1.0).abs() < 1e-9);
        assert_eq!((one.doubt, four.doubt, one.rows), (Form::zeros(), Form::zeros(), four.rows));
        let (first, second) = (&one.parts[0], &four.parts[0]);
        assert_eq!((first.log_determinant, first.stretch, second.levels.white), (0.0, 0, 4.0));
        // three equations for each of 4 (20 − 2) + 1 test functions
        assert_eq!(one.rows, 219);
        let more = 219.0 * libm::log(4.0);
        assert!((second.log_determinant / more - 1.0).abs() < 1e-9, "{}", second.log_determinant);
    }

    /// By the sphere as a tensor the first equations of a stretch are left what a sphere leaves of them, which is no gain, and by the body that moves
    /// next to nothing. Where they have no test function nothing is gained either.
    #[test]
    fn the_first_equations_tell_the_body_from_a_sphere() {
        // a quarter of the samples ends where a test function of the whole does
        let times: Vec<f64> = (0..206).map(|k| 0.1 * f64::from(k)).collect();
        let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
        let rates = simulate(&body, Vector3::new(0.5, 0.8, -0.4), &times, 0.0, &mut Random::new(3)).unwrap();
        let stretches = [Stretch::new(times, rates)];
        // the gain, and what the tensor leaves of three equations for each of 4 (5 − 2) + 1 test functions
        let of = |x: Coordinates, radius: f64| {
            let rounds = Rounds::new(&stretches, radius, &[], Unknowns { x, c: Vec::new() }).unwrap();
            let (_, whitened) = rounds.whiten().unwrap();
            let rows: Vec<Vec<f64>> = whitened.into_iter().map(|own| own.rows).collect();
            let part = rows[0].chunks_exact(6).take(39);
            (rounds.gain_of_part(&rows, 1e-4), part.map(|row| row[5] * row[5]).sum::<f64>())
        };
        let (none, of_sphere) = of(Coordinates::zeros(), 1.0);
        assert!(none.abs() < 0.05 * of_sphere, "{none:e} {of_sphere:e}");
        let (gain, of_body) = of(moments(1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6), 1.0);
        assert!((gain / of_sphere - 1.0).abs() < 0.05, "{gain:e} {of_sphere:e}");
        assert!(of_body < 1e-3 * of_sphere, "{of_body:e} {of_sphere:e}");
        assert_eq!(of(Coordinates::zeros(), 3.0).0, 0.0);
    }

    fn moments(a: f64, b: f64, c: f64) -> Coordinates {
        coordinates(&Matrix3::from_diagonal(&Vector3::new(a, b, c)))
    }

    /// A step is taken whole while a tenth of the smallest moment is left, and else as far as leaves that, or half of it, a quarter, and so on.
    #[test]
    fn a_step_leaves_a_tenth_of_the_smallest_moment() {
        let times: Vec<f64> = (0..100).map(|k| 0.1 * f64::from(k)).collect();
        let stretches = [Stretch::new(times, vec![Vector3::x(); 100])];
        let at = Unknowns { x: moments(0.4, 0.1, 0.5), c: Vec::new() };
        let rounds = Rounds::new(&stretches, 1.0, &[], at).unwrap();
        // of the smallest moment, 0.1, so much is lost
        let shares = [(-0.1, 1.0), (0.0899, 1.0), (0.1, 0.9), (0.2, 0.45), (0.35, 0.225), (0.4, 0.225)];
        for (lost, share) in shares {
            let found = rounds.room(&moments(0.5 * lost, -lost, 0.5 * lost));
            assert!(f64::abs(found - share) < 1e-15, "{lost}: {found}");
        }
        // no stretch holds a test function of that size
        let at = Unknowns { x: moments(0.4, 0.1, 0.5), c: Vec::new() };
        assert!(Rounds::new(&stretches, 5.0, &[], at).is_none());
    }

    /// Six equations are the fewest: two test functions of one stretch, or one of each of two.
    #[test]
    fn rounds_need_six_equations() {
        let times: Vec<f64> = (0..100).map(|k| 0.1 * f64::from(k)).collect();
        let stretches = [0, 1].map(|_| Stretch::new(times.clone(), vec![Vector3::x(); 100]));
        let of = |count: usize, share: f64| {
            let radius = stretches[0].duration() * share;
            Rounds::new(&stretches[..count], radius, &[], Unknowns::at(Coordinates::zeros(), &[])).is_some()
        };
        // a quarter of a radius beside the first one has room for a second
        assert!(!of(1, 0.5) && of(1, 1.0 / 2.25) && of(2, 0.5));
    }

    /// Rounds go on with the levels and the noise of each stretch by its number, with the tensor, and with the columns that both have; a stretch
    /// that is not among the others is like the first of a part of the record, and of a whole one they do not go on.
    #[test]
    fn rounds_go_on_from_where_others_ended() {
        let times: Vec<f64> = (0..100).map(|k| 0.1 * f64::from(k)).collect();
        let stretches = [0, 1].map(|_| Stretch::new(times.clone(), vec![Vector3::x(); 100]));
        let (drag, offset) = (Column::new(Drag, None), Column::new(Offset(0), Some(0.1)));
        let columns = [drag, offset];
        let level = |torque: f64| Levels { white: 1.5, torque, shape: Shape::Alike };
        let x = moments(0.4, 0.1, 0.5);
        let from = |stretches: Vec<ReachedBy>| Reached {
            columns: vec![offset.with_prior(None), Column::new(Scale, None)],
            at: Unknowns { x, c: vec![0.3, 0.7] },
            stretches,
            driven: true,
        };
        let by = |stretch: usize, samples: Option<usize>| {
            let noise = samples.map(|samples| vec![Vector3::y(); samples]);
            ReachedBy { stretch, levels: level(1.0 + stretch as f64), noise }
        };
        let resumed = |of: Vec<ReachedBy>| {
            let at = Unknowns { x: Coordinates::zeros(), c: vec![0.1, 0.2] };
            Rounds::new(&stretches, 1.0, &columns, at).unwrap().resumed(from(of))
        };
        let found = resumed(vec![by(1, Some(100)), by(0, None)]).unwrap();
        assert_eq!(found.levels, [level(1.0), level(2.0)]);
        assert_eq!(found.noise, [vec![Vector3::zeros(); 100], vec![Vector3::y(); 100]]);
        assert_eq!((found.at.x, found.at.c), (x, vec![0.1, 0.3]));
        assert!(found.resumed && found.driven);
        assert_eq!(resumed(vec![by(0, None)]).unwrap().levels, [level(1.0), level(1.0)]);
        for lacking in [0, 1] {
            assert!(resumed(vec![by(lacking, Some(100))]).is_none());
        }
        assert!(resumed(vec![by(0, Some(100)), by(1, Some(99))]).is_none());
    }
}
