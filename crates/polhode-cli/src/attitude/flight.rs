//! Free flights of a known body: its exact motion through the rates.

use nalgebra::UnitQuaternion;
use polhode::record::Segment;
use polhode::strapdown::{Estimate, Flight, FlightError, Kind, Sensor};
use polhode_files::error::{Error, tell, warn};
use polhode_files::text::rounded;

use super::readings::Readings;
use crate::flags::body::{Described, described};

/// Where the exact motion of the body and the readings part most, in terms of their budgets.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Apart {
    deviations: f64,
    time: f64,
    angle: f64,
}

impl Apart {
    /// One more pair of attitudes of the same time; the angle between both, rad.
    pub(super) fn push(&mut self, smoothed: &Estimate, integrated: &Estimate) -> f64 {
        let (angle, deviations) =
            (smoothed.error(integrated.attitude).norm(), smoothed.deviations_from(integrated));
        if deviations > self.deviations {
            *self = Apart { deviations, time: smoothed.time, angle };
        }
        angle
    }

    /// Says where both contradict each other.
    pub(super) fn tell(self) {
        let Apart { deviations, time, angle } = self;
        if deviations > Estimate::CONTRADICTION {
            warn(&format!(
                "at t = {} s the exact motion of the body and the integrated readings are {angle:.2e} rad apart, \
                 {deviations:.1} standard deviations: a torque such as drag acts, the tensor is not exact, or an error of the \
                 sensor is not stated (--bias, --scale-error); attitude_sigma does not include it",
                rounded(time)
            ));
        }
    }
}

/// The attitudes of the body that `--body` names in one segment, on its exact motion.
pub(super) fn smoothed(
    body: &str,
    readings: &Readings,
    segment: &Segment,
    start: UnitQuaternion<f64>,
    sensor: Sensor,
) -> Result<Vec<Estimate>, Error> {
    let Described { inertia, weight_moment, wheels, .. } = described(body)?;
    let refused = |rule: &str, remedy: &str| Err(Error::input("--body", body, rule, remedy));
    if weight_moment != [0.0; 3] {
        return refused("is a top under gravity, and --body needs a free body here", "name a free body");
    }
    if !wheels.is_empty() {
        return refused(
            "carries wheels, and --body needs a body without wheels here",
            "name a body without wheels",
        );
    }
    if readings.kind != Kind::Rate {
        let rule = format!("a flight is fitted to rates, and the readings are {}s", readings.kind);
        return refused(&rule, "leave --body out");
    }
    let failed = |error: FlightError| match &error {
        FlightError::Contradicted { .. } => Error::Failed(format!(
            "{}: {error}; --window t0,t1 cuts out the flight, --rate-unit and --axes say how it was read",
            readings.name()
        )),
        FlightError::Samples(samples) => readings.refused(segment, 0, samples),
        _ => Error::Input(format!("{}: --body: {error}", readings.name())),
    };
    let flight = Flight::fit(&inertia, segment.times(), segment.rates(), start, sensor).map_err(failed)?;
    let chi2 = flight
        .chi2_per_dof()
        .map_or(String::new(), |chi2| format!(", chi^2 {chi2:.2} per degree of freedom"));
    tell(
        "note",
        &format!("exact motion of the body: {:.1e} rad/s left of the rates{chi2}", flight.residual()),
    );
    flight.at(segment.times()).map_err(failed)
}
