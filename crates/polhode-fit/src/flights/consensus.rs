//! One tensor that many short windows of a record agree on.

use crate::flights::equations::{LOCAL, Normal, Reduced, Test, UNKNOWNS, Vector};
use crate::physical::coordinates::{Coordinates, Form, eigen, tensor};
use crate::physical::law::LARGEST_SHARE;
use crate::thresholds::flights::{
    BEYOND, COMMON_TORQUE, DRAG, FALL, FAST, GROSS, JUDGES, LASTING, MOST_TORQUE, REFINEMENTS, REWEIGHTED,
    SLOW, STRIDE, SURE, TRIED, WINDOW,
};

/// Precisions of the unknowns in a window, where `speed` is the rate of the motion: of the tensor one that only keeps
/// undetermined numbers finite, about the sphere; no constant torque.
pub(super) fn precisions(speed: f64) -> Vector {
    let drag = 1.0 / (DRAG * speed);
    Vector::from_fn(|k, _| match k {
        5..8 => drag * drag,
        8 => f64::EPSILON,
        _ => 1.0,
    })
}

/// A window that is long and fast enough to judge a tensor by.
struct Window {
    stretch: usize,
    first: usize,
    sums: Reduced,
    /// The tensor that explains it best.
    own: Coordinates,
}

/// What windows agree on.
pub(super) struct Consensus {
    pub(super) x: Coordinates,
    /// Of each stretch which tests lie in a window that agrees.
    pub(super) free: Vec<Vec<bool>>,
}

/// The smallest mean square torque of all windows, over that of a free one; `None` without any window.
pub(super) struct NoConsensus {
    pub(super) least: Option<f64>,
}

/// Those without a test that is `taken`.
fn windows(all: &[Vec<Test>], taken: &[Vec<bool>], speed: f64, variance: f64) -> Vec<Window> {
    let mut windows = Vec::new();
    let is_taken = |stretch: usize, first: usize| {
        let own = taken.get(stretch).and_then(|taken| taken.get(first..first + WINDOW));
        own.is_some_and(|own| own.contains(&true))
    };
    let (prior, sphere) = (precisions(speed), Vector::zeros());
    for (stretch, tests) in all.iter().enumerate() {
        let Some(last) = tests.len().checked_sub(WINDOW) else { continue };
        for first in (0..last).step_by(STRIDE).chain([last]) {
            let own = &tests[first..first + WINDOW];
            if own.iter().any(|test| test.is_slow(speed)) || is_taken(stretch, first) {
                continue;
            }
            let mut normal = Normal::prior(&prior, &sphere);
            own.iter().for_each(|test| normal.add(test, test.scale(MOST_TORQUE, variance), LOCAL));
            if let (Some(sums), Some(x)) = (normal.of_tensor(), normal.solve()) {
                let own = x.fixed_rows::<5>(0).into_owned();
                windows.push(Window { stretch, first, sums, own });
            }
        }
    }
    windows
}

/// Whether a body may have this tensor, or one near it.
fn is_possible(x: &Coordinates) -> bool {
    let (moments, _) = eigen(tensor(x));
    moments[0] > -BEYOND && moments[2] < LARGEST_SHARE + BEYOND
}

/// The tensor that most windows agree on, each with its own drag.
pub(super) fn consensus(all: &[Vec<Test>], speed: f64, variance: f64) -> Result<Consensus, NoConsensus> {
    consensus_beside(&[], all, speed, variance)
}

/// The same of the tests that are not `taken`.
pub(super) fn consensus_beside(
    taken: &[Vec<bool>],
    all: &[Vec<Test>],
    speed: f64,
    variance: f64,
) -> Result<Consensus, NoConsensus> {
    let windows = windows(all, taken, speed, variance);
    let agrees = |window: &Window, x: &Coordinates| window.sums.mean_square(x) < 1.0;
    let mut proposals: Vec<&Window> =
        windows.iter().filter(|w| agrees(w, &w.own) && is_possible(&w.own)).collect();
    // those first that determine their tensor best
    let determined = |window: &Window| eigen(window.sums.matrix).0[0];
    proposals.sort_by(|a, b| determined(b).total_cmp(&determined(a)));
    let judges: Vec<&Window> = windows.iter().step_by(windows.len().div_ceil(JUDGES).max(1)).collect();
    let mut best: Option<(usize, Coordinates)> = None;
    for proposal in proposals.into_iter().take(TRIED) {
        let mut x = proposal.own;
        for _ in 0..REFINEMENTS {
            let (mut matrix, mut vector) = (Form::identity(), Coordinates::zeros());
            for window in judges.iter().filter(|w| agrees(w, &x)) {
                matrix += window.sums.matrix;
                vector += window.sums.vector;
            }
            if let Some(factor) = matrix.cholesky() {
                x = factor.solve(&-vector);
            }
        }
        let votes = judges.iter().filter(|w| agrees(w, &x)).count();
        if is_possible(&x) && best.as_ref().is_none_or(|(most, _)| votes > *most) {
            best = Some((votes, x));
        }
    }
    let Some((_, x)) = best.filter(|(votes, _)| *votes > 0) else {
        let own = windows.iter().map(|w| w.sums.mean_square(&w.own));
        return Err(NoConsensus { least: own.min_by(f64::total_cmp) });
    };
    let mut free: Vec<Vec<bool>> = all.iter().map(|tests| vec![false; tests.len()]).collect();
    for window in windows.iter().filter(|w| agrees(w, &x)) {
        free[window.stretch][window.first..window.first + WINDOW].fill(true);
    }
    Ok(Consensus { x, free })
}

/// The tests of a whole record that no tensor, drag and constant torque explain.
pub(super) struct Contradiction {
    /// Tests beyond what any small torque makes.
    gross: Vec<Vec<bool>>,
    turning: usize,
}

impl Contradiction {
    pub(super) fn new(all: &[Vec<Test>], speed: f64, variance: f64) -> Option<Contradiction> {
        let turning = |test: &&Test| !test.is_slow(speed);
        let prior = Vector::from_fn(|k, _| if k == 8 { f64::EPSILON } else { 1.0 });
        let mut x = Vector::zeros();
        for round in 0..REWEIGHTED {
            let mut normal = Normal::prior(&prior, &Vector::zeros());
            for test in all.iter().flatten().filter(turning) {
                let scale = test.scale(COMMON_TORQUE, variance);
                let excess =
                    if round == 0 { 0.0 } else { test.residual(&x).norm_squared() / (scale * scale) };
                normal.add(test, scale * (1.0 + excess).sqrt(), UNKNOWNS);
            }
            x = normal.solve()?;
        }
        let gross = |test: &Test| {
            let (left, torque) = (test.residual(&x).norm_squared(), GROSS * test.size());
            !test.is_slow(speed) && left > torque * torque + SURE * SURE * test.noise(variance)
        };
        let gross = all.iter().map(|tests| tests.iter().map(gross).collect()).collect();
        Some(Contradiction { gross, turning: all.iter().flatten().filter(turning).count() })
    }

    /// Whether the whole record may be that of a free body, or of one under the torques that a fit has columns for.
    pub(super) fn is_none(&self) -> bool {
        self.gross.iter().all(|gross| !gross.windows(LASTING).any(|run| run.iter().all(|g| *g)))
    }

    /// The share of the tests with a turning body.
    pub(super) fn share(&self) -> f64 {
        self.gross.iter().flatten().filter(|g| **g).count() as f64 / self.turning.max(1) as f64
    }
}

/// Whether a body that turns is brought to rest, or set in motion, within a turn by about one radian.
///
/// Without a torque the rate of a body stays above 1/√2 of its largest, whatever its moments: |ω|² is least on the
/// separatrix, I₁I₃ / (I₂(I₁ + I₃ − I₂)) ≥ ½ of it. Drag takes it lower, but not as soon.
pub(super) fn is_held(all: &[Vec<Test>], speed: f64) -> bool {
    all.iter().any(|tests| {
        let mut rates: Vec<f64> = tests.iter().map(|test| test.rate() / speed).collect();
        let ends = stops(&rates);
        rates.reverse();
        ends || stops(&rates)
    })
}

/// Whether these rates of tests, over that of the motion, fall to rest at once after a window that is fast throughout.
fn stops(rates: &[f64]) -> bool {
    (0..=FALL).any(|fall| {
        rates.windows(WINDOW + fall + LASTING).any(|own| {
            let (before, after) = (&own[..WINDOW], &own[WINDOW + fall..]);
            before.iter().all(|rate| *rate > FAST) && after.iter().all(|rate| *rate < SLOW)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};
    use polhode::inertia::Inertia;
    use polhode::num::Random;

    use crate::flights::equations::tests;
    use crate::physical::coordinates::coordinates;
    use crate::signal::stretch::Stretch;
    use crate::simulate::simulate;

    fn body() -> Matrix3<f64> {
        Matrix3::from_diagonal(&Vector3::new(0.2, 0.35, 0.45))
    }

    /// Tests of 30 s of a body of trace 1 that a hand turns to and fro beside its motion, from 24 s on if there is one.
    fn recording(hand: f64) -> Vec<Test> {
        let times: Vec<f64> = (0..600).map(|k| 0.05 * f64::from(k)).collect();
        let (inertia, start) = (Inertia::from_tensor(body()).unwrap(), Vector3::new(0.5, 0.8, -0.4));
        let mut rates = simulate(&inertia, start, &times, 1e-4, &mut Random::new(3)).unwrap();
        for (t, w) in times.iter().zip(&mut rates).skip(480) {
            *w += Vector3::new(1.0, -0.7, 0.4) * (hand * libm::sin(3.0 * (t - 24.0)));
        }
        tests(&Stretch::new(times, rates), 1.0)
    }

    /// Drag is expected by 0.03 of the momentum a radian, no input and no number of the tensor is; moments may break the law by 0.03.
    #[test]
    fn what_is_expected_of_a_window_and_of_a_tensor() {
        let found = precisions(2.0);
        let drag = 1.0 / (0.06 * 0.06);
        assert!(found.iter().take(5).chain(found.iter().skip(9)).all(|one| *one == 1.0), "{found}");
        assert!((5..8).all(|k| (found[k] / drag - 1.0).abs() < 1e-12) && found[8] == f64::EPSILON, "{found}");
        for (moments, is) in [
            ([-0.02, 0.5, 0.52], true),
            ([-0.04, 0.52, 0.52], false),
            ([0.2, 0.28, 0.52], true),
            ([0.2, 0.26, 0.54], false),
        ] {
            let x = coordinates(&Matrix3::from_diagonal(&Vector3::from(moments)));
            assert_eq!(is_possible(&x), is, "{moments:?}");
        }
    }

    /// Windows of twelve tests begin at every second one, and one ends at the last; none where the body hardly turns.
    #[test]
    fn windows_begin_at_every_second_test() {
        let all = recording(0.0);
        let firsts = |parts: &[Vec<Test>], speed: f64| -> Vec<(usize, usize)> {
            windows(parts, &[], speed, 1e-8).iter().map(|window| (window.stretch, window.first)).collect()
        };
        assert!(firsts(&[all[..11].to_vec()], 1.0).is_empty());
        assert_eq!(firsts(&[all[..12].to_vec()], 1.0), [(0, 0)]);
        let parts = [all[..11].to_vec(), all[..15].to_vec(), all[..16].to_vec()];
        assert_eq!(firsts(&parts, 1.0), [(1, 0), (1, 2), (1, 3), (2, 0), (2, 2), (2, 4)]);
        assert!(firsts(&parts, 1e3).is_empty());
        // the tensor of the body leaves no more than its prior
        let x = coordinates(&body());
        assert!(windows(&parts, &[], 1.0, 1e-8).iter().all(|window| window.sums.mean_square(&x) < 0.01));
    }

    /// The tensor that most windows agree on is that of the body, and the tests that a hand touches are not free.
    #[test]
    fn windows_agree_on_the_body_that_turns_freely() {
        let all = recording(1.0);
        let Ok(found) = consensus(core::slice::from_ref(&all), 1.0, 1e-8) else { panic!() };
        assert!((found.x - coordinates(&body())).norm() < 0.02, "{}", found.x);
        let free = |from: f64, to: f64| {
            let own = all.iter().zip(&found.free[0]).filter(|(test, _)| (from..to).contains(&test.centre));
            let own: Vec<bool> = own.map(|(_, free)| *free).collect();
            own.iter().filter(|free| **free).count() as f64 / own.len() as f64
        };
        assert_eq!((found.free.len(), found.free[0].len()), (1, all.len()));
        assert!(free(0.0, 22.0) == 1.0 && free(26.0, 30.0) < 0.2, "{:?}", found.free);
        // no window, no agreement
        let none = consensus(&[all[..11].to_vec()], 1.0, 1e-8);
        assert!(matches!(none, Err(NoConsensus { least: None })));
    }

    /// Shaken about all axes alike for five minutes, a body passes for a sphere that no window of it agrees with; however many such windows there
    /// are, it is those that agree with their own tensor that propose one.
    #[test]
    fn windows_that_agree_with_no_tensor_propose_none() {
        let times: Vec<f64> = (0..6000).map(|k| 0.05 * f64::from(k)).collect();
        let shaken = |t: f64| [(3.0, 0.0), (3.7, 1.0), (4.3, 2.0)].map(|(w, phase)| libm::sin(w * t + phase));
        let rates: Vec<Vector3<f64>> = times.iter().map(|t| Vector3::from(shaken(*t))).collect();
        let all = [tests(&Stretch::new(times, rates), 1.0), recording(0.0)];
        let Ok(found) = consensus(&all, 1.0, 1e-8) else { panic!() };
        assert!((found.x - coordinates(&body())).norm() < 0.02, "{}", found.x);
        assert!(!found.free[0].contains(&true) && !found.free[1].contains(&false), "{:?}", found.free);
    }

    /// Twelve fast tests and four at rest, in either order, with up to four between them, are those of a body that is held; fewer, or a fall
    /// that takes longer, are not, and neither are those of two stretches.
    #[test]
    fn a_body_that_rests_at_once_is_held() {
        let of = |fast: usize, between: usize, rest: usize| {
            let (fast, between) = (core::iter::repeat_n(0.51, fast), core::iter::repeat_n(0.3, between));
            fast.chain(between).chain(core::iter::repeat_n(0.09, rest)).collect::<Vec<f64>>()
        };
        for between in 0..=4 {
            assert!(stops(&of(12, between, 4)) && stops(&of(20, between, 9)), "{between}");
            assert!(!stops(&of(11, between, 9)) && !stops(&of(20, between, 3)), "{between}");
        }
        assert!(!stops(&of(20, 5, 9)) && !stops(&of(30, 0, 0)) && !stops(&[]));
        // a moment of rest, and rates between rest and motion
        assert!(!stops(&[of(20, 0, 3), of(20, 0, 3)].concat()));
        assert!(!stops(&[vec![0.49; 20], vec![0.05; 20]].concat()));
        assert!(!stops(&[vec![0.8; 20], vec![0.11; 20]].concat()));

        let body = recording(0.0);
        let still: Vec<Vector3<f64>> = vec![Vector3::x() * 1e-3; 200];
        let times: Vec<f64> = (0..200).map(|k| 0.05 * f64::from(k)).collect();
        let rest = tests(&Stretch::new(times, still), 1.0);
        let after = [body.clone(), rest.clone()].concat();
        let before = [rest.clone(), body.clone()].concat();
        assert!(is_held(&[body.clone(), after], 1.0) && is_held(&[before], 1.0));
        assert!(!is_held(&[body, rest], 1.0) && !is_held(&[], 1.0));
    }

    /// Four tests in a row contradict a free body, three and those of two stretches do not; shares are of the tests that turn.
    #[test]
    fn a_contradiction_lasts_for_four_tests() {
        let of = |gross: &[&[u8]], turning| Contradiction {
            gross: gross.iter().map(|own| own.iter().map(|g| *g == 1).collect()).collect(),
            turning,
        };
        let three = of(&[&[0, 1, 1, 1, 0, 1], &[1, 1, 1, 0]], 20);
        assert!(three.is_none() && three.share() == 0.35);
        assert!(!of(&[&[0, 0], &[0, 1, 1, 1, 1]], 20).is_none());
        assert!(of(&[], 0).is_none() && of(&[], 0).share() == 0.0);
        let free = recording(0.0);
        let found = Contradiction::new(core::slice::from_ref(&free), 1.0, 1e-8).unwrap();
        assert!(found.is_none() && found.share() == 0.0 && found.turning == free.len());
        // at a speed beside which it hardly turns
        let slow = Contradiction::new(&[free], 1e3, 1e-8).unwrap();
        assert!(slow.turning == 0 && slow.share() == 0.0);
    }
}
