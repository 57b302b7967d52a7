//! The random bodies, each with one start and its true motion.

use polhode::body::{Body, Force};
use polhode::num::Random;
use polhode::rotation::{Quat, Vec3};
use polhode::truth::{AGREEMENT, Truth};
use polhode_files::error::{Error, unexpected};

use super::super::{phase, separatrix};
use crate::experiment::Context;

pub(super) const SEED: u64 = 1765;

/// Rate at the start, rad/s; next to the separatrix about the middle axis.
const RATE: f64 = 1.0;

/// Mean motion of the bodies in orbit, rad/s.
const MEAN_MOTION: f64 = 0.125;

/// Looks up to each horizon.
const LOOKS: u32 = 32;

/// What is asked of a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// From any start.
    Free,
    /// Free, at the distance k'² of ten to this power from the separatrix.
    Near(i32),
    /// Three different moments under gravity, from any start.
    Top,
    /// In a circular orbit, from any start.
    Orbit,
}

impl Kind {
    pub(super) const ALL: [Kind; 6] =
        [Kind::Free, Kind::Near(-2), Kind::Near(-4), Kind::Near(-8), Kind::Top, Kind::Orbit];

    /// As tables print it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Kind::Free => "free body",
            Kind::Near(_) => "free body near the separatrix",
            Kind::Top => "asymmetric top",
            Kind::Orbit => "body in orbit",
        }
    }

    /// k'² of the starts next to the separatrix.
    pub(super) fn complement(self) -> Option<f64> {
        match self {
            Kind::Near(decade) => Some(separatrix::ten(decade)),
            _ => None,
        }
    }

    /// The true motion of one body, looked at `times`, s.
    fn truth(self, member: u64, times: &[f64]) -> Result<Truth, Error> {
        // every kind has the same bodies
        let (body, start) = phase::drawn(Random::new(SEED).stream(member))?;
        let mut random = Random::new(SEED).stream((1 << 32) | member);
        let body = match self {
            Kind::Free => return Truth::new(&body, &start, times).map_err(unexpected),
            Kind::Near(decade) => {
                let (point, _) = separatrix::near(&body, decade, member, RATE, random)?;
                return Truth::from_point(&body, point, 0.0, times, AGREEMENT).map_err(unexpected);
            }
            Kind::Top => {
                let mut moments = body.inertia().principal_moments();
                moments.sort_by(f64::total_cmp);
                // gravity turns it as quickly as it spins
                let weight = random.normal_vector().normalize() * (moments[1] * RATE * RATE);
                Body::heavy(body.inertia().clone(), weight).map_err(unexpected)?
            }
            Kind::Orbit => body.with(Force::gravity_gradient(MEAN_MOTION, 0.0).map_err(unexpected)?),
        };
        let attitude = Quat::from_components([(); 4].map(|()| random.normal()));
        let omega = random.normal_vector().normalize() * RATE;
        let point = body.enter_omega(attitude, Vec3(omega.into())).map_err(unexpected)?;
        Truth::from_point(&body, point.to_f64(), 0.0, times, AGREEMENT).map_err(unexpected)
    }
}

/// The bodies of one kind.
pub(super) struct Ensemble {
    pub(super) kind: Kind,
    pub(super) truths: Vec<Truth>,
    /// Times of comparison, s, which are the units of time.
    pub(super) horizons: Vec<f64>,
}

impl Ensemble {
    /// Those whose motion is known up to a horizon, if they are at least half.
    pub(super) fn starts(&self, horizon: f64) -> Vec<usize> {
        let known = |k: &usize| self.truths[*k].known_until() >= horizon * (1.0 - 1e-9);
        let found: Vec<usize> = (0..self.truths.len()).filter(known).collect();
        if 2 * found.len() >= self.truths.len() { found } else { Vec::new() }
    }
}

/// All kinds.
pub(super) fn all(context: &Context) -> Result<Vec<Ensemble>, Error> {
    let of_scale = |kind: Kind| {
        let members: u64 = match kind {
            Kind::Near(_) => context.scale.pick(3, 8, 64),
            _ => context.scale.pick(4, 16, 128),
        };
        // a closed form is known at any time, a run in double-double costs its time
        let closed = matches!(kind, Kind::Free | Kind::Near(_));
        let horizons: &[f64] = if closed { context.scale.pick(&[1e2], &[1e2], &[1e2, 1e3]) } else { &[1e2] };
        (kind, members, horizons)
    };
    let kinds = Kind::ALL.map(of_scale);
    let parts = kinds.iter().flat_map(|&(kind, members, horizons)| {
        let mut times: Vec<f64> =
            horizons.iter().flat_map(|horizon| polhode::truth::evenly(*horizon, LOOKS)).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        (0..members).map(move |member| (kind, member, times.clone()))
    });
    // those without a closed form stand last and take longest: first, so that no core waits at the end
    let mut parts: Vec<(Kind, u64, Vec<f64>)> = parts.collect();
    parts.reverse();
    let found = context.in_parallel(parts, |(kind, member, times)| kind.truth(member, &times));
    let mut found = found.into_iter().rev();
    let of = |&(kind, members, horizons): &(Kind, u64, &[f64])| {
        let truths = found.by_ref().take(members as usize).collect::<Result<Vec<_>, Error>>()?;
        Ok(Ensemble { kind, truths, horizons: horizons.to_vec() })
    };
    kinds.iter().map(of).collect()
}
