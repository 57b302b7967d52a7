//! Who is compared beside the catalogue, and how the work of a step is counted.

use std::ops::RangeInclusive;

use polhode::method::{AnyMethod, Cost};
use polhode_files::error::{Error, unexpected};

/// Schemes beside the catalogue; those that a force does not admit are left out there.
pub(super) const SCHEMES: [&str; 21] = [
    "dmv:4",
    "dmv:6",
    "dmv:16",
    "dmv:20",
    "rattle@suzuki-4",
    "lie-poisson@suzuki-4",
    "lie-poisson@kahan-li-6",
    "two-turn@suzuki-4",
    "two-turn@blanes-moan-s6",
    "two-turn@blanes-moan-s10",
    "two-turn@kahan-li-8",
    "two-turn@sofroniou-spaletta-10",
    "kick-drift@srkn-6b",
    "kick-drift@srkn-11b",
    "kick-drift@srkn-14a",
    "kick-drift@bce-22",
    "kick-drift@omelyan-mryglod-folk-4",
    "kick-drift@aba-10-6-4",
    "dmv:6@srkn-11b",
    "dmv:10@srkn-11b",
    "rk4-projected",
];

/// Methods whose departure from the exact motion is taken back at output, by the exact motion itself.
pub(super) const TAKEN_BACK: [&str; 4] =
    ["rattle+phase", "implicit-midpoint+phase", "lie-poisson+phase", "two-turn+phase"];

/// Whether a method uses the exact motion of a free body: these stand apart, the others are compared among themselves.
pub(super) fn knows_the_motion(name: &str) -> bool {
    name == "exact-step" || name.ends_with("+phase")
}

/// An implicit solution counts as so many evaluations: the sweeps that it takes where a step turns the body by about 15°.
const SOLUTION: u32 = 6;

/// What an evaluation counts as, on average, where solutions weigh more.
pub(super) fn weight(cost: Cost) -> f64 {
    1.0 + f64::from((SOLUTION - 1) * cost.solves) / f64::from(cost.evaluations())
}

/// Evaluations of a step, of all kinds together.
pub(super) fn weighed(cost: Cost) -> f64 {
    f64::from(cost.evaluations()) + f64::from((SOLUTION - 1) * cost.solves)
}

/// `method` at the tightest of the tolerances 10^(-k/2) before the first that is too dear; at the loosest where that is.
pub(super) fn affordable(
    method: &dyn AnyMethod,
    tolerances: RangeInclusive<i32>,
    is_too_dear: impl Fn(&dyn AnyMethod) -> Result<bool, Error>,
) -> Result<Box<dyn AnyMethod>, Error> {
    let mut chosen = None;
    for k in tolerances {
        // the tightest ones are not those of every method
        let Ok(tried) = method.with_tolerance(libm::exp10(-0.5 * f64::from(k))) else { continue };
        if is_too_dear(tried.as_ref())? && chosen.is_some() {
            break;
        }
        chosen = Some(tried);
    }
    chosen.ok_or_else(|| unexpected("a method takes none of the tolerances"))
}
