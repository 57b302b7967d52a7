//! Rounds of the weak equations at samples that each round moves further onto them.

use faer::Mat;
use nalgebra::Vector3;

use super::linearised::Linearised;
use super::noise::SURE;
use super::stacked::Stacked;
use super::test_functions::{Stretch, TestFunctions};
use crate::fit::physical::coordinates::{Coordinates, Form, eigen, pair, tensor};
use crate::fit::physical::law::LARGEST_SHARE;

/// Most rounds at one radius; at low noise two or three do.
pub(crate) const ROUNDS: usize = 12;
/// Rounds that take their whole step.
const FULL_ROUNDS: usize = 6;
/// Shares of a step that are tried.
const SHARES: usize = 30;
/// Standard deviations by which the last round may still move the tensor.
const STILL: f64 = 0.01;
/// The same beyond which there is no answer.
pub(crate) const RESTLESS: f64 = 0.5;
/// Misfit that noise does not explain.
pub(crate) const TORQUES: f64 = 4.0;
/// Fall of χ² that no wobble of pure noise brings about: its chance is e⁻²⁵ for each frequency that is tried.
const SIGNIFICANT_GAIN: f64 = 50.0;
/// What a round may leave of the smallest moment: at none at all the covariance of the equations has no inverse.
const KEPT: f64 = 0.1;
/// How far beyond the law, as a share of the trace, torques may carry an estimate that the law is to bring back.
const BEYOND: f64 = 0.05;

/// The weak estimate of a record: where its rounds ended.
pub(crate) struct WeakEstimate {
    pub(crate) radius: f64,
    pub(crate) x: Coordinates,
    /// Standard deviations by which a further round would move x; infinite where no round could be made, and this is
    /// good for one question only: what is undetermined.
    pub(crate) moved: f64,
    /// Upper triangular, Rᵀ R = H at a motion free of noise.
    pub(crate) root: Form,
    /// D of the mean rates; zero where R is taken at a motion that stands out of the noise.
    doubt: Form,
    /// Sum of squares of the whitened residuals.
    pub(crate) squares: f64,
    /// Equations.
    pub(crate) rows: usize,
    /// Each stretch that is long enough.
    pub(crate) parts: Vec<Part>,
}

/// The whitened equations of one stretch.
pub(crate) struct Part {
    pub(crate) stretch: usize,
    pub(crate) centres: Vec<f64>,
    linearised: Linearised,
}

impl Part {
    /// Three for each centre.
    pub(crate) fn residuals(&self, x: &Coordinates) -> Vec<f64> {
        self.linearised.residuals(x)
    }
}

impl WeakEstimate {
    /// Whether the rounds ended near enough to a fixed point.
    pub(crate) fn settled(&self) -> bool {
        self.moved <= RESTLESS
    }

    /// Whether they stood still there.
    pub(crate) fn still(&self) -> bool {
        self.moved <= STILL
    }

    /// Whether a body may have this tensor, or one near it: J = n nᵀ solves the equations of any spin about n, with
    /// residuals and covariance that vanish together, and rounds may end there.
    pub(crate) fn possible(&self, variance: f64) -> bool {
        let (moments, axes) = eigen(tensor(&self.x));
        let top = axes.column(2).into_owned();
        let share = self.root.transpose().solve_lower_triangular(&pair(&top, &top));
        let excess = variance * self.misfit(variance).max(1.0);
        let deviation = share.map_or(f64::INFINITY, |g| g.norm() * excess.sqrt());
        moments[2] - LARGEST_SHARE <= (SURE * deviation).max(BEYOND)
    }

    /// Equations beyond the unknowns.
    pub(crate) fn dof(&self) -> usize {
        self.rows - 5
    }

    /// Mean square of the residuals over the noise.
    pub(crate) fn misfit(&self, variance: f64) -> f64 {
        self.squares / variance / self.dof().max(1) as f64
    }

    /// Singular values of R less what is in doubt, descending, and the directions they belong to: the eigenvalues of H
    /// without its squares.
    pub(crate) fn spectrum(&self) -> Option<(Coordinates, Form)> {
        let svd = Mat::from_fn(5, 5, |i, k| self.root[(i, k)]).svd().ok()?;
        let (values, directions) = (svd.S().column_vector(), svd.V());
        let mut pairs: [(f64, Coordinates); 5] = core::array::from_fn(|k| {
            let direction = Coordinates::from_fn(|i, _| directions[(i, k)]);
            let sure = values[k] * values[k] - (self.doubt * direction).norm_squared();
            (sure.max(0.0).sqrt(), direction)
        });
        pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
        Some((Coordinates::from_fn(|k, _| pairs[k].0), Form::from_fn(|i, k| pairs[k].1[i])))
    }
}

pub(crate) struct Rounds<'a> {
    used: Vec<(usize, &'a Stretch, TestFunctions)>,
    noise: Vec<Vec<Vector3<f64>>>,
    pub(crate) x: Coordinates,
}

impl<'a> Rounds<'a> {
    pub(crate) fn new(stretches: &'a [Stretch], radius: f64, x: Coordinates) -> Option<Self> {
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
        Some(Rounds { used, noise, x })
    }

    pub(crate) fn linearise(&self) -> Option<Vec<Linearised>> {
        self.used
            .iter()
            .zip(&self.noise)
            .map(|((_, s, tests), n)| Linearised::new(s, n, self.x, tests.clone()))
            .collect()
    }

    /// One round, and by how many standard deviations it would move the tensor if it took its whole step.
    ///
    /// A ridge as weak as one reading keeps x finite before it is known that the record determines it.
    pub(crate) fn round(&mut self, variance: f64, full: bool) -> Option<f64> {
        let parts = self.linearise()?;
        let stacked = Stacked::new(&parts);
        let x = stacked.ridge(variance)?;
        // where torques act, full steps may end in going to and fro
        let relax = if full || stacked.excess(variance) < TORQUES { 1.0 } else { 0.5 };
        let step = x - self.x;
        let relax = relax * self.room(&step);
        let j = tensor(&self.x);
        for ((part, (_, s, _)), noise) in parts.iter().zip(&self.used).zip(&mut self.noise) {
            let next = part.noise(s, noise, &j, &x);
            for (old, new) in noise.iter_mut().zip(next) {
                *old += (new - *old) * relax;
            }
        }
        self.x += step * relax;
        Some((stacked.root * step).norm() / (variance * stacked.excess(variance)).sqrt())
    }

    /// The share of `step` after which the smallest moment is not yet lost.
    fn room(&self, step: &Coordinates) -> f64 {
        let smallest = |share: f64| eigen(tensor(&(self.x + step * share))).0[0];
        let least = KEPT * smallest(0.0);
        if smallest(1.0) >= least {
            return 1.0;
        }
        // a step that ends where the moment vanishes keeps just that much at the first of them
        let shares = core::iter::successors(Some(1.0 - KEPT), |share| Some(0.5 * share));
        shares.take(SHARES).find(|&share| smallest(share) >= 0.99 * least).unwrap_or(0.0)
    }

    /// Rounds until the tensor stands still, and by how many standard deviations the last would have moved it.
    pub(crate) fn settle(&mut self, variance: f64) -> Option<f64> {
        let mut moved = f64::INFINITY;
        for round in 0..ROUNDS {
            moved = self.round(variance, round < FULL_ROUNDS)?;
            if moved <= STILL {
                break;
            }
        }
        Some(moved)
    }

    pub(crate) fn finish(&self, variance: f64, moved: f64) -> Option<WeakEstimate> {
        let parts = self.linearise()?;
        let stacked = Stacked::new(&parts);
        let x = stacked.minimiser().filter(|x| x.iter().all(|v| v.is_finite())).unwrap_or(self.x);
        // the rounds have taken the noise out of G, but for the three numbers by which each motion starts: where it
        // stands out of the noise by far, they add nothing; where it does not, they would pass for a motion
        let gain = (self.squares_of_sphere()? - stacked.squares) / (variance * stacked.excess(variance));
        let (root, doubt) = if gain > SIGNIFICANT_GAIN {
            (stacked.root, Form::zeros())
        } else {
            self.constant_rates(variance)?
        };
        Some(WeakEstimate {
            radius: self.used.first()?.2.radius,
            x,
            moved,
            root,
            doubt,
            squares: stacked.squares,
            rows: stacked.rows,
            parts: self
                .used
                .iter()
                .zip(parts)
                .map(|((k, _, tests), linearised)| Part { stretch: *k, centres: tests.centres(), linearised })
                .collect(),
        })
    }

    /// What can be said without any tensor to go by: the information of constant rates, weighted as for a sphere.
    pub(crate) fn at_sphere(mut self, variance: f64) -> Option<WeakEstimate> {
        self.x = Coordinates::zeros();
        let ((root, doubt), squares) = (self.constant_rates(variance)?, self.squares_of_sphere()?);
        let rows = self.used.iter().map(|(_, _, tests)| 3 * tests.count).sum();
        Some(WeakEstimate {
            radius: self.used.first()?.2.radius,
            x: self.x,
            moved: f64::INFINITY,
            root,
            doubt,
            squares,
            rows,
            parts: Vec::new(),
        })
    }

    /// What the weak equations of the sphere leave, whose rates are constant.
    fn squares_of_sphere(&self) -> Option<f64> {
        let mut sum = 0.0;
        for (_, s, tests) in &self.used {
            let raw = vec![Vector3::zeros(); s.times.len()];
            let part = Linearised::new(s, &raw, Coordinates::zeros(), tests.clone())?;
            sum += part.rows.iter().map(|row| row[5] * row[5]).sum::<f64>();
        }
        Some(sum)
    }

    /// R of motions that keep their mean rates, and D.
    fn constant_rates(&self, variance: f64) -> Option<(Form, Form)> {
        let (mut at_means, mut displaced) = (Vec::new(), Vec::new());
        for (_, s, tests) in &self.used {
            let count = s.rates.len() as f64;
            let mean = s.rates.iter().sum::<Vector3<f64>>() / count;
            let at = |rate: Vector3<f64>| {
                let noise: Vec<_> = s.rates.iter().map(|w| w - rate).collect();
                Linearised::new(s, &noise, self.x, tests.clone())
            };
            at_means.extend(at(mean)?.rows);
            let sure = SURE * (variance / count).sqrt();
            for axis in 0..3 {
                let step = Vector3::ith(axis, sure);
                let (above, below) = (at(mean + step)?.rows, at(mean - step)?.rows);
                let difference =
                    |(a, b): (&[f64; 6], &[f64; 6])| core::array::from_fn(|k| (a[k] - b[k]) / 2.0);
                displaced.extend(above.iter().zip(&below).map(difference));
            }
        }
        Some((Stacked::triangle(&at_means, self.x).root, Stacked::triangle(&displaced, self.x).root))
    }

    /// V.
    pub(crate) fn inflation(&self, parts: &[Linearised]) -> Form {
        parts.iter().zip(&self.used).zip(&self.noise).map(|((p, (_, s, _)), n)| p.inflation(s, n)).sum()
    }
}
