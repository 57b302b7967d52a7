//! The torque noise of a stretch, and the noise of its rates, by restricted likelihood.

use polhode::record::both;

use crate::signal::banded::REGISTER;
use crate::signal::covariance::{Covariance, Levels, Shape};
use crate::thresholds::levels::{BETWEEN, DECADES, FIRST_DECADE, GAIN, RESHAPED, SECTIONS, STEP};
use crate::thresholds::rounds::BESIDE;

/// The likeliest levels for residuals `e` (not whitened) of variance `variance`; `free` is the share of the residuals
/// that the estimate has not fitted away, `white` whether the noise of the rates may differ from that of the record, `last` what the
/// search begins at.
pub(crate) fn likeliest(
    part: &Covariance,
    e: &[f64],
    variance: f64,
    free: f64,
    white: bool,
    last: Option<Levels>,
) -> Option<Levels> {
    let search = |shape| Search { part, e, variance, free, white, shape };
    let near = last.filter(|last| last.torque > 0.0);
    // the shape of before first
    let first = near.map_or(Shape::Moments, |last| last.shape);
    let second = if first == Shape::Moments { Shape::Alike } else { Shape::Moments };
    let (none, found) = match near {
        Some(near) => stepped(near, search(first), search(second)),
        None => {
            let none = search(Shape::Moments).at(0.0);
            let of = |shape| search(shape).most_likely(none.as_ref());
            let (first, second) = both(e.len() > BESIDE / 3, || of(first), || of(second));
            (none, [first, second])
        }
    };
    let mut best: Option<Found> = None;
    for found in found.into_iter().flatten() {
        if best.as_ref().is_none_or(|b| found.cost < b.cost - RESHAPED) {
            best = Some(found);
        }
    }
    let best = match (best, none) {
        (Some(best), Some(none)) if none.cost - best.cost <= GAIN => Some(none),
        (best, none) => best.or(none),
    }?;
    Some(best.levels)
}

/// No torque noise, and one step from `near` towards the likeliest of each shape.
fn stepped(near: Levels, first: Search<'_>, second: Search<'_>) -> (Option<Found>, [Option<Found>; 2]) {
    let (unit, none) = (first.unit(), Search { shape: Shape::Moments, ..first });
    let middle = libm::log10(near.torque / near.white / unit);
    let around = [-STEP, 0.0, STEP].map(|step| unit * libm::pow(10.0, middle + step));
    let [a, b, c] = around;
    let asked = [(none, 0.0), (first, a), (first, b), (first, c), (second, a), (second, b), (second, c)];
    let [none, a, b, c, other_a, other_b, other_c] = together(asked);
    let cost = |found: Option<Found>| found.map_or(f64::INFINITY, |found| found.cost);
    let next = |costs: [Option<Found>; 3]| unit * libm::pow(10.0, nearer(costs.map(cost), middle));
    let (of_first, of_second) = (next([a, b, c]), next([other_a, other_b, other_c]));
    // two alone are done sooner than a register of which six are idle, and have the same bits
    let (first, second) = both(first.e.len() > BESIDE / 3, || first.at(of_first), || second.at(of_second));
    (none, [first, second])
}

/// The likeliest noise of the rates of searches in one covariance, each with torque noise of a ratio to it.
fn together<const N: usize>(asked: [(Search<'_>, f64); N]) -> [Option<Found>; N] {
    let levels = asked.map(|(search, ratio)| search.levels(ratio));
    let each = asked.first().map(|(search, _)| search.part.likelihoods(search.e, &levels));
    core::array::from_fn(|k| Some(asked[k].0.found(asked[k].1, each.as_ref()?.get(k).copied()??)))
}

/// Levels and twice their negative log-likelihood.
struct Found {
    levels: Levels,
    cost: f64,
    /// What more torque noise costs at least.
    floor: f64,
}

#[derive(Clone, Copy)]
struct Search<'a> {
    part: &'a Covariance,
    e: &'a [f64],
    variance: f64,
    free: f64,
    white: bool,
    shape: Shape,
}

impl Search<'_> {
    /// Torque noise whose part in the equations is that of the noise of the rates, per its level.
    fn unit(&self) -> f64 {
        let (noise, torque) = self.part.mean_variances();
        noise / torque
    }

    /// The likeliest torque noise of this shape; `None` where it does not bring the gain over `none` that is asked for.
    fn most_likely(&self, none: Option<&Found>) -> Option<Found> {
        let unit = self.unit();
        let ratio = |exponent: f64| unit * libm::pow(10.0, exponent);
        let cost = |exponent: f64| self.at(ratio(exponent)).map_or(f64::INFINITY, |found| found.cost);
        let mut best = (f64::INFINITY, 0.0);
        let exponents: [f64; DECADES + 1] = core::array::from_fn(|k| k as f64 - FIRST_DECADE);
        let each = exponents.chunks(REGISTER).flat_map(|exponents| {
            let asked: [(Search<'_>, f64); REGISTER] =
                core::array::from_fn(|k| (*self, ratio(exponents.get(k).copied().unwrap_or(exponents[0]))));
            exponents.iter().copied().zip(together(asked))
        });
        for (exponent, found) in each {
            let Some(found) = found else { continue };
            if found.cost < best.0 {
                best = (found.cost, exponent);
            }
            if found.floor > best.0 {
                break;
            }
        }
        if none.is_some_and(|none| none.cost - best.0 <= BETWEEN * GAIN) {
            return None;
        }
        let middle = golden(cost, best.1 - 1.0, best.1 + 1.0);
        let around = together([-STEP, 0.0, STEP].map(|step| (*self, ratio(middle + step))));
        let costs = around.map(|found| found.map_or(f64::INFINITY, |found| found.cost));
        self.at(ratio(lowest(costs, middle)))
    }

    /// Levels with torque noise of `ratio` times the noise of the rates, which is that of the record.
    fn levels(&self, ratio: f64) -> Levels {
        Levels { white: 1.0, torque: ratio, shape: self.shape }
    }

    /// The likeliest noise of the rates with torque noise of `ratio` times its level.
    fn at(&self, ratio: f64) -> Option<Found> {
        Some(self.found(ratio, self.part.likelihood(self.e, self.levels(ratio))?))
    }

    /// The same from the determinant and the squares at these levels.
    fn found(&self, ratio: f64, (determinant, squares): (f64, f64)) -> Found {
        let count = self.e.len() as f64;
        let squares = squares / self.variance / self.free;
        // what the samples themselves say of their noise counts as much as the residuals do
        let (white, equations) =
            if self.white { ((squares + count) / (2.0 * count), 2.0 * count) } else { (1.0, count) };
        let own = if self.white { count } else { 0.0 };
        let cost = determinant + equations * libm::log(white) + (squares + own) / white;
        // the determinant grows with the torque noise; squares are not negative, nor is the noise of the rates below half
        let floor = determinant + own * 2.0 * (1.0 - core::f64::consts::LN_2);
        Found { levels: Levels { white, torque: white * ratio, shape: self.shape }, cost, floor }
    }
}

/// Where a function with one minimum between `low` and `high` is least.
pub(crate) fn golden(cost: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    const SHARE: f64 = 0.618_033_988_749_894_8;
    let (mut a, mut b) = (high - SHARE * (high - low), low + SHARE * (high - low));
    let (mut at_a, mut at_b) = (cost(a), cost(b));
    for _ in 0..SECTIONS {
        if at_a < at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - SHARE * (high - low);
            at_a = cost(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + SHARE * (high - low);
            at_b = cost(b);
        }
    }
    0.5 * (low + high)
}

/// One step of Newton's method towards the least of a function from `middle`, by no more than a decade: from one round to the next
/// the minimum itself moves.
pub(crate) fn newton(cost: impl Fn(f64) -> f64, middle: f64) -> f64 {
    nearer([-STEP, 0.0, STEP].map(|step| cost(middle + step)), middle)
}

/// The same from what the function is [`STEP`] below `middle`, there, and as far above.
fn nearer([below, least, above]: [f64; 3], middle: f64) -> f64 {
    let (slope, curvature) = (below - above, below - 2.0 * least + above);
    let step = if curvature > 0.0 { STEP * (0.5 * slope / curvature) } else { slope };
    if step.is_finite() { middle + step.clamp(-1.0, 1.0) } else { middle }
}

/// The vertex of the parabola about `middle`, where that is a minimum: a golden section alone ends at one of a few places, and
/// descents would go to and fro between two of them.
pub(crate) fn vertex(cost: impl Fn(f64) -> f64, middle: f64) -> f64 {
    lowest([-STEP, 0.0, STEP].map(|step| cost(middle + step)), middle)
}

/// The same from what the function is [`STEP`] below `middle`, there, and as far above.
fn lowest([below, least, above]: [f64; 3], middle: f64) -> f64 {
    let (slope, curvature) = (below - above, below - 2.0 * least + above);
    if slope.is_finite() && curvature > 0.0 {
        middle + STEP * (0.5 * slope / curvature).clamp(-1.0, 1.0)
    } else {
        middle
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::stretch::Stretch;
    use crate::signal::terms::Terms;
    use crate::signal::test_functions::TestFunctions;
    use nalgebra::{Matrix3, Vector3};
    use polhode::num::Random;

    /// Each step leaves the golden share of the interval, and the answer is its middle.
    #[test]
    fn the_golden_section_closes_in_on_the_least() {
        let left = 0.5 * libm::pow(0.618_033_988_749_894_8, SECTIONS as f64);
        for least in [3.06, 3.4, 3.82, 4.0, 4.54, 4.96] {
            let found = golden(|x| (x - least) * (x - least), 3.0, 5.0);
            assert!((found - least).abs() <= 2.0 * left * (1.0 + 1e-12), "{least}: {found}");
        }
    }

    /// Both reach the least of a parabola within a decade at once, and go no further than a decade.
    #[test]
    fn the_least_of_a_parabola_is_one_step_away() {
        for least in [-0.7, 0.0, 0.4] {
            let cost = |x: f64| 3.0 + 2.0 * (x - least) * (x - least);
            for found in [newton(cost, 0.1), vertex(cost, least + 0.5 * STEP)] {
                assert!((found - least).abs() < 1e-9, "{least}: {found}");
            }
            assert!((newton(cost, least + 3.0) - (least + 2.0)).abs() < 1e-9);
        }
        // where there is none, down the slope or not at all
        assert!(newton(|x| -x * x, 1.0) > 1.0);
        assert_eq!(vertex(|x| -x * x, 1.0), 1.0);
    }

    /// Of 113 test functions, four to a radian.
    fn covariance() -> Covariance {
        let times: Vec<f64> = (0..301).map(|k| 0.1 * f64::from(k)).collect();
        let stretch = Stretch::new(times, vec![Vector3::new(0.6, -0.5, 0.62); 301]);
        let tests = TestFunctions::new(&stretch, 1.0).unwrap();
        let terms = Terms::at(Matrix3::from_diagonal(&Vector3::new(0.2, 0.35, 0.45)));
        Covariance::new(&stretch, &vec![Vector3::zeros(); 301], &terms, &tests)
    }

    /// Twice the negative log-likelihood at a level: of n residuals whose squares are s over the noise it is log |C| + s, and with free noise of the
    /// rates, which n readings tell as well, 2 n log w + (s + n)/w at its least. Without squares it is as low as it can be.
    #[test]
    fn the_cost_is_least_at_its_own_noise() {
        let (part, e) = (covariance(), vec![0.0; 339]);
        let of = |white: bool, squares: f64| {
            let search = Search { part: &part, e: &e, variance: 0.25, free: 0.5, white, shape: Shape::Alike };
            search.found(3.0, (7.0, squares))
        };
        let fixed = of(false, 10.0);
        assert_eq!(fixed.levels, Levels { white: 1.0, torque: 3.0, shape: Shape::Alike });
        assert!((fixed.cost - 87.0).abs() < 1e-12 && fixed.floor == 7.0, "{} {}", fixed.cost, fixed.floor);
        let free = of(true, 10.0);
        let white = 419.0 / 678.0;
        assert!((free.levels.white - white).abs() < 1e-14 && free.levels.shape == Shape::Alike);
        assert!((free.levels.torque - 3.0 * white).abs() < 1e-14);
        let cost = |white: f64| 7.0 + 678.0 * libm::log(white) + 419.0 / white;
        assert!((free.cost - cost(white)).abs() < 1e-10, "{} {}", free.cost, cost(white));
        assert!(cost(white) < cost(1.01 * white) && cost(white) < cost(0.99 * white));
        for white in [false, true] {
            let least = of(white, 0.0);
            assert!((least.cost - least.floor).abs() < 1e-10, "{white}: {} {}", least.cost, least.floor);
        }
        assert!((free.floor - cost(0.5) + 160.0).abs() < 1e-10, "{}", free.floor);
    }

    /// Residuals of a known torque noise tell its level to their scatter; no level of half or twice the size is likelier, and a step from there
    /// stays there. Residuals of zero tell of none.
    #[test]
    fn the_likeliest_torque_noise_is_that_of_the_residuals() {
        let (part, variance) = (covariance(), 0.04);
        let mut random = Random::new(23);
        let size = 339;
        for shape in [Shape::Moments, Shape::Alike] {
            let search = |e| Search { part: &part, e, variance, free: 1.0, white: false, shape };
            let unit = search(&[]).unit();
            let levels = Levels { white: 1.0, torque: 10.0 * unit, shape };
            let factor = part.factor(levels).unwrap();
            let z: Vec<f64> = (0..size).map(|_| 0.2 * random.normal()).collect();
            let e = (0..size).map(|i| (0..=i).map(|k| factor.get(i, k) * z[k]).sum::<f64>());
            let e: Vec<f64> = e.collect();
            let found = likeliest(&part, &e, variance, 1.0, false, None).unwrap();
            let ratio = found.torque / levels.torque;
            assert!(found.white == 1.0 && (1.0 / 3.0..3.0).contains(&ratio), "{shape:?}: {ratio}");
            let cost = |torque: f64| Search { shape: found.shape, ..search(&e) }.at(torque).unwrap().cost;
            let least = cost(found.torque);
            assert!(least < cost(2.0 * found.torque) && least < cost(0.5 * found.torque), "{shape:?}");
            let next = likeliest(&part, &e, variance, 1.0, false, Some(found)).unwrap();
            assert_eq!(next.shape, found.shape);
            assert!(libm::log10(next.torque / found.torque).abs() < 0.1, "{shape:?}: {found:?} {next:?}");
        }
        let none = likeliest(&part, &vec![0.0; size], variance, 1.0, false, None);
        assert_eq!(none, Some(Levels::WHITE));
    }
}
