//! One tensor that many short windows of a record agree on.

use crate::flights::equations::{LOCAL, Normal, Reduced, Test, UNKNOWNS, Vector};
use crate::physical::coordinates::{Coordinates, Form, eigen, tensor};
use crate::physical::law::LARGEST_SHARE;
use crate::thresholds::flights::{
    BEYOND, COMMON_TORQUE, DRAG, GROSS, JUDGES, LASTING, MOST_TORQUE, REFINEMENTS, REWEIGHTED, STRIDE, SURE,
    TRIED, WINDOW,
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

fn windows(all: &[Vec<Test>], speed: f64, variance: f64) -> Vec<Window> {
    let mut windows = Vec::new();
    let (prior, sphere) = (precisions(speed), Vector::zeros());
    for (stretch, tests) in all.iter().enumerate() {
        let Some(last) = tests.len().checked_sub(WINDOW) else { continue };
        for first in (0..last).step_by(STRIDE).chain([last]) {
            let own = &tests[first..first + WINDOW];
            if own.iter().any(|test| test.is_slow(speed)) {
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
    let windows = windows(all, speed, variance);
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
