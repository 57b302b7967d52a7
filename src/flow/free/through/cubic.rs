//! A half angle between two places of which values and slopes are known.

use super::branch::{Moving, folded};

/// Change of the half angle by a slope over a piece, up to which it is followed, rad.
const FOLLOWED: f64 = 0.8;
/// Difference of the two changes by the slopes, and of the change from their mean, in a smooth piece, rad.
const TURNED: f64 = 0.6;
const BENT: f64 = 0.03;

/// Changes of a half angle over a piece, rad: the whole one, and those that the slopes at both ends would make.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cubic {
    nearest: f64,
    change: f64,
    slopes: [f64; 2],
}

impl Cubic {
    pub(super) fn between(low: Moving, high: Moving, width: f64) -> Cubic {
        let slopes = [low.slope * width, high.slope * width];
        let mean = 0.5 * (slopes[0] + slopes[1]);
        Cubic {
            nearest: low.value.abs().min(high.value.abs()),
            change: mean + folded(high.value - low.value - mean),
            slopes,
        }
    }

    /// Whether the half angle changes as the slopes say and, where it comes near to zero, at most once turns round.
    pub(super) fn is_smooth(&self) -> bool {
        let [first, last] = self.slopes;
        let bent = (self.change - 0.5 * (first + last)).abs();
        first.abs().max(last.abs()) < FOLLOWED
            && (first - last).abs() < TURNED
            && bent < BENT
            && (first * last < 0.0 || self.is_monotone() || self.nearest > first.abs().max(last.abs()))
    }

    /// The sufficient condition of Fritsch and Carlson (SIAM J. Numer. Anal. 17 (1980) 238) on the cubic with slopes of one sign.
    fn is_monotone(&self) -> bool {
        let [first, last] = self.slopes;
        first * self.change >= 0.0 && first.abs().max(last.abs()) <= 3.0 * self.change.abs()
    }
}
