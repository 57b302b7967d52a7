//! The bodies, starts and forces of the comparison.

use polhode::body::{Body, Force, Point};
use polhode::catalogue;
use polhode::inertia::Inertia;
use polhode::num::Dd;
use polhode::rotation::{Quat, Vec3};

use crate::error::{Error, unexpected};
use crate::experiment::Scale;
use crate::text::short;

/// One panel of the figure.
pub(super) struct Case {
    pub(super) name: String,
    /// Moments, forces and start, for readers.
    pub(super) what: String,
    pub(super) body: Body,
    pub(super) start: Point<Dd>,
    /// About the time of one radian, s, a power of two.
    pub(super) unit: f64,
    /// Times of comparison, in units.
    pub(super) horizons: &'static [f64],
}

/// Moments and a generic angular velocity of about 1 rad/s.
const FREE: [(&str, [f64; 3], [f64; 3]); 5] = [
    ("textbook", [1.0, 2.0, 3.0], [0.4, 1.0, -0.3]),
    ("dyadic", [0.625, 0.75, 1.0], [0.875, 0.25, -0.375]),
    ("toutatis", [1.0, 3.0836, 3.235], [-0.875, 0.125, 0.375]),
    ("racket", [0.0389, 0.4619, 0.4993], [0.25, 1.0, 0.125]),
    ("spacecraft", [0.0241, 0.0234, 0.0201], [0.25, 0.875, 0.375]),
];

/// Share of the angular velocity across the middle axis of a start next to the separatrix.
const NEAR: f64 = 1e-3;

const WHOLE: &[f64] = &[1e2, 1e4, 1e6];

/// All cases of a scale.
pub(super) fn all(scale: Scale) -> Result<Vec<Case>, Error> {
    // a closed form is known at any time, a run in double-double costs its time
    let closed = &WHOLE[..scale.pick(1, 2, 3)];
    let followed: &[f64] = scale.pick(&[1e2], &[1e2, 1e3], &[1e2, 1e3, 1e4]);
    let orbiting: &[f64] = scale.pick(&[], &[1e2], &[1e2, 1e3]);
    let mut cases = Vec::new();
    let bodies = scale.pick(1, FREE.len(), FREE.len());
    for (name, moments, omega) in &FREE[..bodies] {
        let body = Body::free(Inertia::from_moments(*moments).map_err(unexpected)?);
        cases.push(Case::new(format!("{name}, generic"), body.clone(), *omega, UPRIGHT, closed)?);
        let mut axes = [0, 1, 2];
        axes.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
        let mut near = [0.0; 3];
        (near[axes[0]], near[axes[1]], near[axes[2]]) = (NEAR, 1.0, NEAR);
        cases.push(Case::new(format!("{name}, separatrix"), body, near, UPRIGHT, closed)?);
    }
    let tops = scale.pick(1, 2, 2);
    for name in &["simo-wong", "bruls-cardona"][..tops] {
        let top = catalogue::top(name).ok_or_else(|| unexpected("a top of the catalogue is missing"))?;
        let body = top.body().map_err(unexpected)?;
        cases.push(Case::new(format!("{name} top"), body, top.omega_body, top.attitude, closed)?);
    }
    // figure VII.5.3 of Hairer, Lubich and Wanner; and Kovalevskaya's top
    let heavy = [
        ("asymmetric top", [0.5, 0.85, 1.0], [0.0, 0.0, 1.0], [0.4, 1.0 / 0.85, 0.4], [0.4, 0.2, 0.4, 0.8]),
        ("Kovalevskaya top", [2.0, 2.0, 1.0], [1.3, 0.0, 0.0], [0.35, -0.2, 0.9], [0.9, 0.2, -0.3, 0.4]),
    ];
    for (name, moments, weight, omega, attitude) in heavy.into_iter().take(tops) {
        let inertia = Inertia::from_moments(moments).map_err(unexpected)?;
        let body = Body::heavy(inertia, weight.into()).map_err(unexpected)?;
        cases.push(Case::new(name.into(), body, omega, attitude, followed)?);
    }
    if !orbiting.is_empty() {
        let (_, moments, omega) = FREE[4];
        let inertia = Inertia::from_moments(moments).map_err(unexpected)?;
        let force = Force::gravity_gradient(&inertia, 0.125, 0.0).map_err(unexpected)?;
        let body = Body::free(inertia).with(force);
        cases.push(Case::new("spacecraft in orbit".into(), body, omega, UPRIGHT, orbiting)?);
    }
    Ok(cases)
}

const UPRIGHT: [f64; 4] = [1.0, 0.0, 0.0, 0.0];

impl Case {
    fn new(
        name: String,
        body: Body,
        omega: [f64; 3],
        attitude: [f64; 4],
        horizons: &'static [f64],
    ) -> Result<Case, Error> {
        let start = body.enter_omega(Quat::from_components(attitude), Vec3(omega)).map_err(unexpected)?;
        let least = body.rotor().moments::<f64>().0.into_iter().fold(f64::INFINITY, f64::min);
        let weight = body.gravity::<f64>().map_or(0.0, |gravity| gravity.weight_moment.norm());
        // a top at rest moves at the rate of a pendulum
        let rate = Vec3(omega).norm() + libm::sqrt(weight / least);
        let unit = libm::exp2(libm::round(-libm::log2(rate)));
        let force = match (weight > 0.0, body.forces().is_empty()) {
            (true, _) => ", heavy",
            (false, false) => ", gravity gradient of a circular orbit at 0.125 rad/s",
            (false, true) => "",
        };
        let list = |numbers: [f64; 3]| {
            numbers.map(|x| format!("{:.4e}", x).parse().map_or(String::new(), short)).join(", ")
        };
        let moments = body.rotor().moments::<f64>().0.map(|moment| moment * body.scale());
        let what = format!("moments {} kg m²{force}; ω = {} rad/s at the start", list(moments), list(omega));
        Ok(Case { name, what, body, start, unit, horizons })
    }

    /// The end, in units.
    pub(super) fn end(&self) -> f64 {
        self.horizons.last().copied().unwrap_or(0.0)
    }

    /// Times of the looks, s: 32 up to each horizon.
    pub(super) fn looks(&self) -> Vec<f64> {
        let looks = |horizon: &f64| {
            let every = horizon * self.unit / 32.0;
            (1..=32).map(move |k| every * f64::from(k))
        };
        let mut times: Vec<f64> = self.horizons.iter().flat_map(looks).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }
}
