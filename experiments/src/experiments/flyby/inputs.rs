//! The encounter and the spin states: every number with its source.

use polhode::body::{Body, Force, Orbit};
use polhode::flow::{Mode, TumblingElements, TumblingPopulation, TumblingSolution};
use polhode::inertia::Inertia;
use polhode::num::Covariance;
use polhode::units::Date;
use polhode_files::error::{Error, unexpected};

/// GM of the Earth, km³/s²: IERS Conventions (2010), table 1.1.
pub(super) const GM: f64 = 398_600.441_8;

/// Osculating orbit about the Earth next to the perigee, ecliptic and equinox J2000: JPL Horizons, solution of November 2023, as
/// printed in the readme of github.com/disruptiveplanets/AIME. Least distance in km.
pub(super) const PERIGEE: f64 = 38_011.486_491_291_03;
pub(super) const ECCENTRICITY: f64 = 4.253_901_873_212_79;
/// Longitude of the node, inclination and argument of the perigee, degrees.
pub(super) const PLANE: [f64; 3] = [152.001_949_090_403_7, 162.856_154_313_485, 32.567_622_071_074_16];
/// When it is passed.
const PASSAGE: &str = "2462240.4070919347 TDB";

/// Pravec et al., Icarus 233 (2014) 48: short-axis mode, epoch with the light time taken off. Their uncertainties are three standard
/// deviations; those of the phases and of the moments, which are not symmetric, are taken as half of the whole range.
const EPOCH: &str = "2456284.676388 UTC";
const PERIODS: [f64; 2] = [27.38, 263.0];
const PERIODS_3_SIGMA: [f64; 2] = [0.07, 6.0];
const POLE: [f64; 2] = [250.0, -75.0];
/// Of the ellipse of 27 by 14 degrees on the sky; its longer axis is taken along the parallel.
const POLE_3_SIGMA: [f64; 2] = [27.0, 14.0];
const PHASES: [f64; 2] = [152.0, 14.0];
const PHASES_3_SIGMA: [f64; 2] = [0.5 * (173.0 + 64.0), 0.5 * (44.0 + 11.0)];
pub(super) const RATIOS: [f64; 2] = [0.61, 0.965];
const RATIOS_3_SIGMA: [f64; 2] = [0.5 * (0.11 + 0.08), 0.5 * (0.009 + 0.015)];

/// Ďurech et al., Astron. Astrophys. 709 (2026) A278 (arXiv:2604.24566): periods with their standard deviations, h. Pole, moments and
/// phases of their solutions, and its two aliases, were not to be had: those above are taken.
const LATER_PERIODS: [f64; 2] = [27.374, 262.2];
const LATER_SIGMA: [f64; 2] = [0.001, 0.1];

const HOUR: f64 = 3600.0;

/// A spin state as it is published.
pub(super) struct Published {
    pub(super) name: &'static str,
    pub(super) population: TumblingPopulation,
}

/// Both.
pub(super) fn published() -> Result<[Published; 2], Error> {
    let third = |sigma: [f64; 2]| sigma.map(|x| x / 3.0);
    let (_, across) = libm::sincos(POLE[1].to_radians());
    let of = |name, periods: [f64; 2], deviations: [f64; 2]| -> Result<Published, Error> {
        let elements = TumblingElements::new(Mode::ShortAxis, periods.map(|period| period * HOUR))
            .with_pole(POLE.map(f64::to_radians))
            .with_angles(PHASES.map(f64::to_radians));
        let [along_parallel, along_meridian] = third(POLE_3_SIGMA).map(f64::to_radians);
        let [phi, psi] = third(PHASES_3_SIGMA).map(f64::to_radians);
        let [smallest, middle] = third(RATIOS_3_SIGMA);
        let [precession, rotation] = deviations.map(|deviation| deviation * HOUR);
        let all = [precession, rotation, along_parallel / across, along_meridian, phi, psi, smallest, middle];
        let covariance = Covariance::independent(all).map_err(unexpected)?;
        let solution = TumblingSolution::new(inertia()?, elements, covariance);
        let population = TumblingPopulation::new(vec![(1.0, solution)]).map_err(unexpected)?;
        Ok(Published { name, population })
    };
    Ok([of("Pravec 2014", PERIODS, third(PERIODS_3_SIGMA))?, of("Durech 2026", LATER_PERIODS, LATER_SIGMA)?])
}

/// Moments of the nominal body.
pub(super) fn inertia() -> Result<Inertia, Error> {
    Inertia::from_moments([RATIOS[0], RATIOS[1], 1.0]).map_err(unexpected)
}

/// From the epoch of the elements to the perigee, s.
pub(super) fn until_perigee() -> Result<f64, Error> {
    let date = |text: &str| text.parse::<Date>().map_err(unexpected);
    date(PASSAGE)?.seconds_since(&date(EPOCH)?).map_err(unexpected)
}

/// The body on the orbit, which passes the perigee at t = 0; lengths in km.
pub(super) fn encountering(inertia: Inertia) -> Result<Body, Error> {
    let orbit = Orbit::conic(GM, PERIGEE, ECCENTRICITY).map_err(unexpected)?;
    let orbit = orbit.in_plane(PLANE.map(f64::to_radians)).map_err(unexpected)?;
    Ok(Body::free(inertia).with(Force::gravity_gradient_on(orbit)))
}
