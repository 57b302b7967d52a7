//! The weak form of Euler's equation: nothing is differentiated.
//!
//! J ω' + ω × J ω = 0, multiplied by a test function φ of compact support and integrated by parts, is
//! ∫ (−φ' J ω + φ ω × J ω) dt = 0: linear in J, and free of bias to first order in the noise of ω.
//!
//! The noise n of the samples enters test m as Σ_i A_mi n_i with A_mi = w_i (−φ'_m J + φ_m ([ω]ₓ J − [J ω]ₓ)), so the
//! residuals have the banded covariance C = Σ_i A_mi A_m'iᵀ (times σ²). Each round solves the least-squares problem
//! weighted by C⁻¹ at the samples ω − n̂ that the round before left on the constraints, n̂ = Aᵀ C⁻¹ r. Its fixed
//! point minimises |n|² subject to the weak equations (Gauss–Helmert), which weights at the raw samples do not.
//!
//! | here | meaning |
//! |---|---|
//! | r, G | residuals of the weak equations, and their derivatives with respect to the coordinates x of J |
//! | H | Gᵀ C⁻¹ G: information, in units of 1/σ² |
//! | V | what the noise in G adds to H at raw samples, in expectation and in units of 1/σ² |
//! | D | Dᵀ D is what errors of the mean rates may add to H where nothing but their mean stands out of the noise |

use std::rc::Rc;

use faer::Mat;
use nalgebra::{Matrix3, Matrix4, SMatrix, Vector3, Vector4};

use super::banded::Banded;
use super::coordinates::{Coordinates, Form, basis, tensor};
use super::quadrature;

/// Test functions per radius.
const TESTS_PER_RADIUS: f64 = 4.0;
/// Fewest samples in the support of one test function.
pub(super) const SAMPLES_PER_TEST: f64 = 8.0;

/// One stretch of samples without gaps, in units of the root mean square rate and its inverse.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    pub(super) times: Vec<f64>,
    pub(super) rates: Vec<Vector3<f64>>,
    weights: Vec<f64>,
}

impl Stretch {
    pub(super) fn new(times: Vec<f64>, rates: Vec<Vector3<f64>>) -> Self {
        let weights = quadrature::weights(&times);
        Stretch { times, rates, weights }
    }

    pub(super) fn duration(&self) -> f64 {
        self.times.last().zip(self.times.first()).map_or(0.0, |(b, a)| b - a)
    }

    /// Its first `count` samples.
    pub(super) fn head(&self, count: usize) -> Stretch {
        Stretch::new(self.times[..count].to_vec(), self.rates[..count].to_vec())
    }
}

/// The test functions of one stretch: φ = (1 − u²)⁴, u = (t − centre)/radius, centres evenly spaced.
#[derive(Clone, Debug)]
pub(super) struct Tests {
    first: f64,
    spacing: f64,
    radius: f64,
    pub(super) count: usize,
    /// How many neighbours on one side a test overlaps.
    reach: usize,
    /// Cubics q(u) of each test, with which φ' + φ q/radius sums by parts exactly: see [`by_parts`](Self::by_parts).
    corrections: Rc<[Vector4<f64>]>,
}

impl Tests {
    /// `None` where the stretch is shorter than one test function, or has too few samples for it.
    pub(super) fn new(stretch: &Stretch, radius: f64) -> Option<Tests> {
        let duration = stretch.duration();
        let samples = stretch.times.len() as f64;
        // a radius that was cut from this very duration may exceed half of it by rounding
        if 2.0 * radius > duration * (1.0 + 1e-9) || samples * 2.0 * radius < SAMPLES_PER_TEST * duration {
            return None;
        }
        let room = (duration - 2.0 * radius).max(0.0);
        // nudged off the ties, so that a change of units cannot change the count
        let steps = (TESTS_PER_RADIUS * room / radius + 1e-6).round();
        let count = steps as usize + 1;
        let spacing = if count > 1 { room / steps } else { radius };
        let overlap = if count > 1 { (2.0 * radius / spacing - 1e-9) as usize } else { 0 };
        let mut tests = Tests {
            first: stretch.times[0] + radius,
            spacing,
            radius,
            count,
            reach: overlap.min(count - 1),
            corrections: vec![Vector4::zeros(); count].into(),
        };
        tests.corrections = tests.by_parts(stretch);
        Some(tests)
    }

    /// The cubics q that make Σ w (φ' + φ q/radius) p + Σ w φ p' = 0 for every cubic p.
    ///
    /// It is by this identity that the weak form rests on Euler's equation; a quadrature alone obeys it up to its error,
    /// which a short support or irregular times would make a bias.
    fn by_parts(&self, stretch: &Stretch) -> Rc<[Vector4<f64>]> {
        let mut sums = vec![(Matrix4::<f64>::zeros(), Vector4::<f64>::zeros()); self.count];
        for (&t, &weight) in stretch.times.iter().zip(&stretch.weights) {
            for m in self.at(t) {
                let (value, slope) = self.value(m, t);
                let u = self.position(m, t);
                let powers = Vector4::new(1.0, u, u * u, u * u * u);
                let slopes = Vector4::new(0.0, 1.0, 2.0 * u, 3.0 * u * u);
                sums[m].0 += powers * powers.transpose() * (weight * value);
                sums[m].1 -= powers * (weight * slope * self.radius) + slopes * (weight * value);
            }
        }
        sums.into_iter().map(|(m, b)| m.cholesky().map_or(Vector4::zeros(), |m| m.solve(&b))).collect()
    }

    /// u of test `m` at `t`.
    fn position(&self, m: usize, t: f64) -> f64 {
        (t - self.first - m as f64 * self.spacing) / self.radius
    }

    /// The tests that are not zero at `t`.
    fn at(&self, t: f64) -> core::ops::Range<usize> {
        let low = ((t - self.radius - self.first) / self.spacing).ceil().max(0.0) as usize;
        let high = ((t + self.radius - self.first) / self.spacing).floor();
        if high < 0.0 { 0..0 } else { low..(high as usize + 1).min(self.count) }
    }

    fn centres(&self) -> Vec<f64> {
        (0..self.count).map(|m| self.first + m as f64 * self.spacing).collect()
    }

    /// φ_m and φ'_m at `t`.
    fn value(&self, m: usize, t: f64) -> (f64, f64) {
        let u = self.position(m, t);
        let v = (1.0 - u * u).max(0.0);
        (v * v * v * v, -8.0 * u * v * v * v / self.radius)
    }
}

/// Most rows that one sample takes part in: three for each of the tests that overlap it.
const MOST: usize = 30;

/// The rows that see one sample, three to a test, with their weights w φ' and w φ.
struct Seen {
    first: usize,
    count: usize,
    slope: [f64; MOST],
    value: [f64; MOST],
}

impl Seen {
    fn new(tests: &Tests, t: f64, weight: f64) -> Seen {
        let range = tests.at(t);
        let count = (3 * range.len()).min(MOST);
        let mut seen = Seen { first: 3 * range.start, count, slope: [0.0; MOST], value: [0.0; MOST] };
        for (k, m) in range.take(count / 3).enumerate() {
            let (value, slope) = tests.value(m, t);
            let (u, q) = (tests.position(m, t), &tests.corrections[m]);
            let correction = value / tests.radius * (q[0] + u * (q[1] + u * (q[2] + u * q[3])));
            seen.slope[3 * k..3 * k + 3].fill(weight * (slope + correction));
            seen.value[3 * k..3 * k + 3].fill(weight * value);
        }
        seen
    }

    /// −slope·a + value·b by row, with the rows of `a` and `b` in turn: one axis of the tests' share in a product.
    fn mix(&self, a: [f64; 3], b: [f64; 3]) -> [f64; MOST] {
        let mut mixed = [0.0; MOST];
        for ((m, s), v) in mixed.chunks_mut(3).zip(self.slope.chunks(3)).zip(self.value.chunks(3)) {
            for q in 0..3 {
                m[q] = v[q] * b[q] - s[q] * a[q];
            }
        }
        mixed
    }
}

impl Seen {
    /// Σ over pairs of tests of the blocks Z of `inverse`, weighted by slope·slope, slope·value and value·value; in
    /// the second the row belongs to the value. Lower halves only are summed, then mirrored.
    fn sums(&self, inverse: &Banded) -> [Matrix3<f64>; 3] {
        let (mut slopes, mut values) = ([[0.0; MOST]; 3], [[0.0; MOST]; 3]);
        for row in 0..self.count {
            let (a, b, p) = (self.slope[row], self.value[row], row % 3);
            let entries = inverse.row(self.first + row, self.first, self.first + row + 1);
            for ((z, s), v) in entries[..row].iter().zip(&mut slopes[p]).zip(&mut values[p]) {
                *s += a * z;
                *v += b * z;
            }
            slopes[p][row] += 0.5 * a * entries[row];
            values[p][row] += 0.5 * b * entries[row];
        }
        let sum = |rows: &[[f64; MOST]; 3], weights: &[f64; MOST]| {
            Matrix3::from_fn(|p, q| (q..self.count).step_by(3).map(|i| rows[p][i] * weights[i]).sum::<f64>())
        };
        let (aa, ab) = (sum(&slopes, &self.slope), sum(&values, &self.slope));
        let (ba, bb) = (sum(&slopes, &self.value), sum(&values, &self.value));
        [aa + aa.transpose(), ab + ba.transpose(), bb + bb.transpose()]
    }
}

/// [ω]ₓ B − [B ω]ₓ: the derivative of ω × B ω.
pub(super) fn cross_derivative(b: &Matrix3<f64>, w: &Vector3<f64>) -> Matrix3<f64> {
    w.cross_matrix() * b - (b * w).cross_matrix()
}

/// The weak equations of one stretch, linearised at samples `rates` − `noise` and tensor J, whitened by L⁻¹.
pub(super) struct Linearised {
    tests: Tests,
    factor: Banded,
    /// The coordinates that the last column is the residual of: what is left of x is small, and so is its rounding.
    origin: Coordinates,
    /// L⁻¹ [G | r], row by row.
    rows: Vec<[f64; 6]>,
}

impl Linearised {
    /// `None` where the covariance is not positive, as for a tensor far from physical.
    pub(super) fn new(
        stretch: &Stretch,
        noise: &[Vector3<f64>],
        origin: Coordinates,
        tests: Tests,
    ) -> Option<Self> {
        let j = &tensor(&origin);
        let size = 3 * tests.count;
        let mut covariance = Banded::zeros(size, 3 * tests.reach + 2);
        let mut rows = vec![[0.0; 6]; size];
        let bases: [Matrix3<f64>; 6] = core::array::from_fn(|k| if k < 5 { basis(k) } else { *j });
        let jj = j * j;
        for (i, noise) in noise.iter().enumerate() {
            let seen = Seen::new(&tests, stretch.times[i], stretch.weights[i]);
            let w = stretch.rates[i] - noise;
            let products = bases.map(|b| b * w);
            let crosses = products.map(|p| w.cross(&p));
            let k = cross_derivative(j, &w);
            let (jn, kn) = (j * noise, k * noise);
            let (jk, kk) = (j * k.transpose(), k * k.transpose());
            let with_noise = |v: &[Vector3<f64>; 6], own: &Vector3<f64>| -> [[f64; 6]; 3] {
                core::array::from_fn(|c| {
                    core::array::from_fn(|l| if l < 5 { v[l][c] } else { v[l][c] + own[c] })
                })
            };
            let (products, crosses) = (with_noise(&products, &jn), with_noise(&crosses, &kn));
            // A Aᵀ by rows p: slope times (slope J J − value J Kᵀ) and value times (value K Kᵀ − slope K J)
            let line = |m: &Matrix3<f64>, p: usize| [m[(p, 0)], m[(p, 1)], m[(p, 2)]];
            let kj = jk.transpose();
            let by_slope: [_; 3] = core::array::from_fn(|p| seen.mix(line(&jj, p), line(&jk, p)));
            let by_value: [_; 3] = core::array::from_fn(|p| seen.mix(line(&kj, p), line(&kk, p)));
            for row in 0..seen.count {
                let (a, b, p) = (seen.slope[row], seen.value[row], row % 3);
                for ((sum, cross), product) in
                    rows[seen.first + row].iter_mut().zip(&crosses[p]).zip(&products[p])
                {
                    *sum += b * cross - a * product;
                }
                let entries = covariance.row_mut(seen.first + row, seen.first, seen.first + row + 1);
                for ((entry, s), v) in entries.iter_mut().zip(&by_slope[p]).zip(&by_value[p]) {
                    *entry += b * v - a * s;
                }
            }
        }
        if !covariance.factor() {
            return None;
        }
        covariance.forward(&mut rows);
        Some(Linearised { tests, factor: covariance, origin, rows })
    }

    /// Whitened residuals at `x`.
    pub(super) fn residuals(&self, x: &Coordinates) -> Vec<f64> {
        let step = x - self.origin;
        self.rows.iter().map(|row| row[5] + (0..5).map(|k| row[k] * step[k]).sum::<f64>()).collect()
    }

    /// The noise n̂ = Aᵀ C⁻¹ r that carries the samples onto the weak equations of `x`.
    pub(super) fn noise(
        &self,
        stretch: &Stretch,
        old: &[Vector3<f64>],
        j: &Matrix3<f64>,
        x: &Coordinates,
    ) -> Vec<Vector3<f64>> {
        let mut multipliers = self.residuals(x);
        self.factor.backward(&mut multipliers);
        (0..stretch.times.len())
            .map(|i| {
                let seen = Seen::new(&self.tests, stretch.times[i], stretch.weights[i]);
                let (mut slopes, mut values) = (Vector3::<f64>::zeros(), Vector3::<f64>::zeros());
                for row in 0..seen.count {
                    slopes[row % 3] += multipliers[seen.first + row] * seen.slope[row];
                    values[row % 3] += multipliers[seen.first + row] * seen.value[row];
                }
                let k = cross_derivative(j, &(stretch.rates[i] - old[i]));
                k.transpose() * values - j * slopes
            })
            .collect()
    }

    /// V of this stretch.
    pub(super) fn inflation(&self, stretch: &Stretch, noise: &[Vector3<f64>]) -> Form {
        let inverse = self.factor.inverse_band();
        let bases: [Matrix3<f64>; 5] = core::array::from_fn(basis);
        let mut sum = Form::zeros();
        for (i, noise) in noise.iter().enumerate() {
            let seen = Seen::new(&self.tests, stretch.times[i], stretch.weights[i]);
            let [aa, ab, bb] = seen.sums(&inverse);
            let ba = ab.transpose();
            let w = stretch.rates[i] - noise;
            let k = bases.map(|b| cross_derivative(&b, &w));
            // Σ tr Z D_l D_kᵀ with D_k = −φ' B_k + φ K_k
            for l in 0..5 {
                let from_slope = bases[l] * aa - k[l] * ba;
                let from_value = k[l] * bb - bases[l] * ab;
                for m in 0..=l {
                    // tr(M Nᵀ) is the entry by entry product
                    sum[(l, m)] += from_slope.dot(&bases[m]) + from_value.dot(&k[m]);
                }
            }
        }
        sum.fill_upper_triangle_with_lower_triangle();
        sum
    }
}

/// min |R (x − origin) + z|²: what all stretches say together.
pub(super) struct Stacked {
    origin: Coordinates,
    /// Upper triangular, Rᵀ R = H.
    pub(super) root: Form,
    z: Coordinates,
    /// Sum of squares of the whitened residuals that no x removes.
    pub(super) misfit: f64,
    /// Equations.
    pub(super) rows: usize,
}

impl Stacked {
    /// The triangle of all whitened rows, without forming their squares.
    pub(super) fn new(stretches: &[Linearised]) -> Stacked {
        let rows: Vec<[f64; 6]> = stretches.iter().flat_map(|s| s.rows.iter().copied()).collect();
        Stacked::triangle(&rows, stretches.first().map_or(Coordinates::zeros(), |s| s.origin))
    }

    /// The same of unweighted rows.
    pub(super) fn of_rows(rows: &[[f64; 6]]) -> Stacked {
        Stacked::triangle(rows, Coordinates::zeros())
    }

    fn triangle(rows: &[[f64; 6]], origin: Coordinates) -> Stacked {
        let stack = Mat::from_fn(rows.len().max(6), 6, |i, k| rows.get(i).map_or(0.0, |row| row[k]));
        let qr = stack.qr();
        let r = qr.thin_R();
        Stacked {
            origin,
            root: Form::from_fn(|i, k| if i <= k { r[(i, k)] } else { 0.0 }),
            z: Coordinates::from_fn(|i, _| r[(i, 5)]),
            misfit: r[(5, 5)] * r[(5, 5)],
            rows: rows.len(),
        }
    }

    /// Mean square of what is left over that of the noise, where it is more than 1.
    fn excess(&self, variance: f64) -> f64 {
        (self.misfit / variance / self.rows.saturating_sub(5).max(1) as f64).max(1.0)
    }

    fn information(&self) -> Form {
        self.root.transpose() * self.root
    }

    /// The x that makes |R (x − origin) + z|² + ridge |x|² least.
    fn ridge(&self, ridge: f64) -> Option<Coordinates> {
        // far above the rounding of R, where the record tells nothing and has no noise either; only weights are at stake
        let weight = ridge.sqrt().max(1e-7 * self.root.norm());
        let mut stack = SMatrix::<f64, 10, 6>::zeros();
        stack.fixed_view_mut::<5, 5>(0, 0).copy_from(&self.root);
        stack.fixed_view_mut::<5, 1>(0, 5).copy_from(&self.z);
        stack.fixed_view_mut::<5, 5>(5, 0).copy_from(&(Form::identity() * weight));
        stack.fixed_view_mut::<5, 1>(5, 5).copy_from(&(self.origin * weight));
        let r = stack.qr().r();
        let step = r.fixed_view::<5, 5>(0, 0).solve_upper_triangular(&-r.fixed_view::<5, 1>(0, 5))?;
        Some(self.origin + step)
    }

    /// The x that makes |R (x − origin) + z| least.
    pub(super) fn minimiser(&self) -> Option<Coordinates> {
        Some(self.origin + self.root.solve_upper_triangular(&-self.z)?)
    }
}

/// Why there is no weak estimate.
pub(super) enum Failure {
    /// No stretch carries enough test functions.
    TooShort,
    /// A covariance has no factor.
    Singular,
}

/// The weak estimate of a record: where its rounds ended.
pub(super) struct Weak {
    pub(super) radius: f64,
    pub(super) x: Coordinates,
    /// Standard deviations by which a further round would move x; infinite where no round could be made, and this is
    /// good for one question only: what is undetermined.
    pub(super) moved: f64,
    /// Upper triangular, Rᵀ R = H at a motion free of noise.
    pub(super) root: Form,
    /// D of the mean rates; zero where R is taken at a motion that stands out of the noise.
    doubt: Form,
    /// Sum of squares of the whitened residuals.
    pub(super) misfit: f64,
    /// Equations.
    pub(super) rows: usize,
    /// Whitened residuals of each stretch that is long enough: its index, the tests' centres, three values each.
    pub(super) residuals: Vec<(usize, Vec<f64>, Vec<f64>)>,
}

impl Weak {
    /// Whether the rounds ended near enough to a fixed point.
    pub(super) fn settled(&self) -> bool {
        self.moved <= RESTLESS
    }

    /// Whether they stood still there.
    pub(super) fn still(&self) -> bool {
        self.moved <= STILL
    }

    /// Equations beyond the unknowns.
    pub(super) fn dof(&self) -> usize {
        self.rows - 5
    }

    /// Mean square of the residuals over the noise.
    pub(super) fn misfit_per_dof(&self, variance: f64) -> f64 {
        self.misfit / variance / self.dof().max(1) as f64
    }

    /// Singular values of R less what is in doubt, descending, and the directions they belong to: the eigenvalues of H
    /// without its squares.
    pub(super) fn spectrum(&self) -> Option<(Coordinates, Form)> {
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

/// Most rounds at one radius; at low noise two or three do.
pub(super) const ROUNDS: usize = 12;
/// Rounds that take their whole step.
const FULL_ROUNDS: usize = 6;
/// Standard deviations by which the last round may still move the tensor.
const STILL: f64 = 0.01;
/// The same beyond which there is no answer.
const RESTLESS: f64 = 0.5;
/// Misfit per equation that noise does not explain.
const TORQUES: f64 = 4.0;
/// Fall of χ² that no wobble of pure noise brings about: its chance is e⁻²⁵ for each frequency that is tried.
const SIGNIFICANT_GAIN: f64 = 50.0;
/// Standard deviations of mean rates within which the true ones are taken to lie.
const SURE: f64 = 5.0;

struct Rounds<'a> {
    used: Vec<(usize, &'a Stretch, Tests)>,
    noise: Vec<Vec<Vector3<f64>>>,
    x: Coordinates,
}

impl<'a> Rounds<'a> {
    fn new(stretches: &'a [Stretch], radius: f64, x: Coordinates) -> Option<Self> {
        let used: Vec<_> = stretches
            .iter()
            .enumerate()
            .filter_map(|(k, s)| Tests::new(s, radius).map(|tests| (k, s, tests)))
            .collect();
        let rows: usize = used.iter().map(|(_, _, tests)| 3 * tests.count).sum();
        if rows < 6 {
            return None;
        }
        let noise = used.iter().map(|(_, s, _)| vec![Vector3::zeros(); s.times.len()]).collect();
        Some(Rounds { used, noise, x })
    }

    fn linearise(&self) -> Option<Vec<Linearised>> {
        self.used
            .iter()
            .zip(&self.noise)
            .map(|((_, s, tests), n)| Linearised::new(s, n, self.x, tests.clone()))
            .collect()
    }

    /// One round, and by how many standard deviations it would move the tensor if it took its whole step.
    ///
    /// A ridge as weak as one reading keeps x finite before it is known that the record determines it.
    fn round(&mut self, variance: f64, full: bool) -> Option<f64> {
        let parts = self.linearise()?;
        let stacked = Stacked::new(&parts);
        let x = stacked.ridge(variance)?;
        // where torques act, full steps may end in going to and fro
        let relax = if full || stacked.excess(variance) < TORQUES { 1.0 } else { 0.5 };
        let j = tensor(&self.x);
        for ((part, (_, s, _)), noise) in parts.iter().zip(&self.used).zip(&mut self.noise) {
            let next = part.noise(s, noise, &j, &x);
            for (old, new) in noise.iter_mut().zip(next) {
                *old += (new - *old) * relax;
            }
        }
        let step = x - self.x;
        self.x += step * relax;
        Some((stacked.root * step).norm() / (variance * stacked.excess(variance)).sqrt())
    }

    /// Rounds until the tensor stands still, and by how many standard deviations the last would have moved it.
    fn settle(&mut self, variance: f64) -> Option<f64> {
        let mut moved = f64::INFINITY;
        for round in 0..ROUNDS {
            moved = self.round(variance, round < FULL_ROUNDS)?;
            if moved <= STILL {
                break;
            }
        }
        Some(moved)
    }

    fn finish(&self, variance: f64, moved: f64) -> Option<Weak> {
        let parts = self.linearise()?;
        let stacked = Stacked::new(&parts);
        let x = stacked.minimiser().filter(|x| x.iter().all(|v| v.is_finite())).unwrap_or(self.x);
        let used = self.used.iter().zip(&parts);
        let residuals = used.map(|((k, _, tests), p)| (*k, tests.centres(), p.residuals(&x))).collect();
        // the rounds have taken the noise out of G, but for the three numbers by which each motion starts: where it
        // stands out of the noise by far, they add nothing; where it does not, they would pass for a motion
        let gain = (self.misfit_of_sphere()? - stacked.misfit) / (variance * stacked.excess(variance));
        let (root, doubt) = if gain > SIGNIFICANT_GAIN {
            (stacked.root, Form::zeros())
        } else {
            self.constant_rates(variance)?
        };
        Some(Weak {
            radius: self.used.first()?.2.radius,
            x,
            moved,
            root,
            doubt,
            misfit: stacked.misfit,
            rows: stacked.rows,
            residuals,
        })
    }

    /// What can be said without any tensor to go by: the information of constant rates, weighted as for a sphere.
    fn at_sphere(mut self, variance: f64) -> Option<Weak> {
        self.x = Coordinates::zeros();
        let ((root, doubt), misfit) = (self.constant_rates(variance)?, self.misfit_of_sphere()?);
        let rows = self.used.iter().map(|(_, _, tests)| 3 * tests.count).sum();
        Some(Weak {
            radius: self.used.first()?.2.radius,
            x: self.x,
            moved: f64::INFINITY,
            root,
            doubt,
            misfit,
            rows,
            residuals: Vec::new(),
        })
    }

    /// What the weak equations of the sphere leave, whose rates are constant.
    fn misfit_of_sphere(&self) -> Option<f64> {
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
    fn inflation(&self, parts: &[Linearised]) -> Form {
        parts.iter().zip(&self.used).zip(&self.noise).map(|((p, (_, s, _)), n)| p.inflation(s, n)).sum()
    }
}

/// The covariance (H/σ² − V)⁻¹ (H/σ²) (H/σ² − V)⁻¹ of an estimate at raw samples.
fn covariance(information: &Form, inflation: &Form, variance: f64) -> Option<Form> {
    let noisy = information / variance;
    let inverse = (noisy - inflation).cholesky()?.inverse();
    Some(inverse * noisy * inverse)
}

/// Radii to choose from, ascending: doubling from half the time in which the body turns by one radian.
fn candidates(stretches: &[Stretch]) -> Vec<f64> {
    let longest = stretches.iter().map(Stretch::duration).fold(0.0, f64::max);
    let samples: usize = stretches.iter().map(|s| s.times.len()).sum();
    let duration: f64 = stretches.iter().map(Stretch::duration).sum();
    let lowest = (SAMPLES_PER_TEST * duration / samples as f64).max(0.5);
    let mut radii: Vec<f64> = (0..6)
        .scan(lowest, |r, _| Some(core::mem::replace(r, 2.0 * *r)))
        .filter(|r| 4.0 * r <= longest)
        .collect();
    if radii.is_empty() {
        radii.push(0.25 * longest);
    }
    radii
}

/// The radius of least predicted covariance, and the coordinates it was judged at.
fn choose_radius(stretches: &[Stretch], variance: f64) -> Option<(f64, Coordinates)> {
    let radii = candidates(stretches);
    let mut start = Coordinates::zeros();
    let mut pilot = Rounds::new(stretches, radii[radii.len() / 2], start)?;
    for _ in 0..2 {
        if pilot.round(variance, true).is_none() {
            break;
        }
        start = pilot.x;
    }
    let mut best = (f64::INFINITY, radii[radii.len() / 2]);
    for radius in radii {
        let Some(rounds) = Rounds::new(stretches, radius, start) else { continue };
        let Some(parts) = rounds.linearise() else { continue };
        let stacked = Stacked::new(&parts);
        // a misfit counts as noise, so that radii too short for the sampling or too long for the torques lose
        let inflated = variance * stacked.excess(variance);
        let spread = covariance(&stacked.information(), &rounds.inflation(&parts), inflated);
        let trace = spread.map_or(f64::INFINITY, |c| c.trace());
        if trace < best.0 {
            best = (trace, radius);
        }
    }
    Some((best.1, start))
}

/// Samples on which the radius is chosen: more would not change it.
const PILOT_SAMPLES: usize = 40_000;

/// The weak estimate; `variance` is that of the noise in units of the mean square rate.
pub(super) fn estimate(stretches: &[Stretch], radius: Option<f64>, variance: f64) -> Result<Weak, Failure> {
    let (first, start, largest) = match radius {
        Some(radius) => (radius, Coordinates::zeros(), radius),
        None => {
            let pilot = pilot(stretches);
            let (radius, start) = choose_radius(&pilot, variance).ok_or(Failure::TooShort)?;
            (radius, start, candidates(&pilot).into_iter().fold(radius, f64::max))
        }
    };
    // a weak wobble in strong noise may need longer test functions than its information alone asks for
    let mut radius = first;
    let mut best: Option<Weak> = None;
    while radius <= largest * (1.0 + 1e-9) {
        let mut rounds = Rounds::new(stretches, radius, start).ok_or(Failure::TooShort)?;
        let moved = rounds.settle(variance).filter(|&moved| moved <= RESTLESS);
        if let Some(weak) = moved.and_then(|moved| rounds.finish(variance, moved)) {
            if weak.still() {
                return Ok(weak);
            }
            // mere noise comes to rest on a motion, if there is one; torques may not let it
            let torques = weak.misfit_per_dof(variance) > TORQUES;
            if torques && best.as_ref().is_none_or(|b| weak.moved < b.moved) {
                best = Some(weak);
            }
        }
        radius *= 2.0;
    }
    let sphere = || Rounds::new(stretches, first, start)?.at_sphere(variance);
    best.or_else(sphere).ok_or(Failure::Singular)
}

/// The first stretches, up to a number of samples.
pub(super) fn pilot(stretches: &[Stretch]) -> Vec<Stretch> {
    let mut left = PILOT_SAMPLES;
    let mut chosen = Vec::new();
    for s in stretches {
        let count = left.min(s.times.len());
        if count > 3 {
            chosen.push(if count < s.times.len() { s.head(count) } else { s.clone() });
        }
        left -= count;
    }
    chosen
}

/// The matrix that takes coordinates to the entries xx, yy, zz, xy, xz, yz.
pub(super) fn entries_of_coordinates() -> SMatrix<f64, 6, 5> {
    SMatrix::from_fn(|row, k| basis(k)[super::coordinates::ENTRIES[row]])
}
