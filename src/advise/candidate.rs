//! The methods that are tried: the catalogue, and the best of its bases under schemes of higher order.

use super::{Demand, Setting};
use crate::body::{Body, Problem};
use crate::method::{AnyMethod, Claimed, Claims, Energy, ToleranceError, method, without_projections};

/// Methods beside those of the catalogue: its bases with other orders and schemes.
const BESIDES: [&str; 24] = [
    "dmv:4",
    "dmv:6",
    "dmv:8",
    "dmv:12",
    "dmv:14",
    "dmv:16",
    "dmv:20",
    "two-turn@suzuki-4",
    "two-turn@blanes-moan-s6",
    "two-turn@blanes-moan-s10",
    "two-turn@kahan-li-8",
    "two-turn@sofroniou-spaletta-8",
    "two-turn@sofroniou-spaletta-10",
    "two-turn@blanes-casas-murua-10-23",
    "dmv:12@srkn-6b",
    "dmv:12@srkn-11b",
    "dmv:12@srkn-14a",
    "kick-drift@srkn-6b",
    "kick-drift@srkn-11b",
    "kick-drift@srkn-14a",
    "kick-drift@aba-10-6-4",
    "kick-drift@sofroniou-spaletta-8",
    "taylor:20",
    "taylor:30",
];

/// Methods that are quick on every body.
const FIRST: [&str; 3] = ["dop853", "rk8", "two-turn@sofroniou-spaletta-10"];

/// Where a search for a tolerance begins.
const COARSE: f64 = 1e-4;

/// A method that may be advised.
pub(super) struct Candidate {
    pub(super) name: String,
    method: Box<dyn AnyMethod>,
    pub(super) claims: Claims,
}

impl Candidate {
    /// All that take the forces on `body` and are not excluded.
    pub(super) fn all(body: &Body, demand: &Demand) -> Vec<Self> {
        let problem = body.problem();
        let besides = BESIDES.iter().filter_map(|name| method(name).ok());
        let all = without_projections().into_iter().chain(besides);
        let taken = all.filter_map(|method| Candidate::of(method, problem)).filter(|candidate| {
            let (name, exact) = (&candidate.name, candidate.is_exact());
            let base = name.split([':', '@']).next().unwrap_or_default();
            let excluded = demand
                .excluded
                .iter()
                .any(|other| other == name || other == base || (exact && other == "exact"));
            // without a force, one name for the steps along the one orbit is enough
            let twice = problem == Problem::Free && exact && base == "kick-drift";
            !excluded && !twice
        });
        let mut all: Vec<Self> = taken.collect();
        // the quick ones first: they tell which need not be tried in short steps
        all.sort_by_key(|candidate| {
            let first = FIRST.iter().position(|name| *name == candidate.name).unwrap_or(FIRST.len());
            (first, core::cmp::Reverse(candidate.claims.order.unwrap_or(u32::MAX)))
        });
        all
    }

    /// `method`, where it takes `problem`.
    pub(super) fn of(method: Box<dyn AnyMethod>, problem: Problem) -> Option<Self> {
        let claims = method.claims(problem)?;
        Some(Candidate { name: method.name(), method, claims })
    }

    /// Whether the method chooses its steps.
    pub(super) fn is_adaptive(&self) -> bool {
        self.method.tolerance().is_some()
    }

    /// Whether it has no error of discretisation.
    pub(super) fn is_exact(&self) -> bool {
        self.claims.order.is_none() && !self.is_adaptive()
    }

    /// How its error falls with the step or the tolerance: as this power.
    pub(super) fn power(&self) -> f64 {
        self.claims.order.map_or(1.0, f64::from)
    }

    /// Whether the energy moves away.
    pub(super) fn drifts(&self) -> bool {
        self.claims.kept.energy == Energy::Drifts
    }

    /// The setting that is tried first: a step of two radians, or a coarse tolerance.
    pub(super) fn coarse(&self, rate: f64) -> f64 {
        if self.is_adaptive() { COARSE } else { 2.0 / rate }
    }

    /// The method at the step or tolerance `value`.
    ///
    /// # Errors
    /// A tolerance that it does not take.
    pub(super) fn at(&self, value: f64) -> Result<Prepared<'_>, ToleranceError> {
        if self.is_adaptive() {
            Ok(Prepared::Made(self.method.with_tolerance(value)?))
        } else {
            Ok(Prepared::Given(self.method.as_ref()))
        }
    }

    /// `value` as what a user sets, over the time `until` in `steps` steps.
    pub(super) fn setting(&self, value: f64, until: f64, steps: u64) -> Setting {
        if self.is_adaptive() {
            Setting::Tolerance { tolerance: value, step: until }
        } else {
            Setting::Step(until / steps as f64)
        }
    }
}

/// A method at a tolerance, or one that takes none.
pub(super) enum Prepared<'a> {
    Given(&'a dyn AnyMethod),
    Made(Box<dyn AnyMethod>),
}

impl Prepared<'_> {
    pub(super) fn method(&self) -> &dyn AnyMethod {
        match self {
            Prepared::Given(method) => *method,
            Prepared::Made(method) => method.as_ref(),
        }
    }
}
