//! Free flights of a known body: its exact motion through the rates.

use nalgebra::UnitQuaternion;
use polhode::record::Segment;
use polhode::strapdown::{Estimate, Flight, FlightError, Kind, Sensor};
use polhode_files::error::{Error, tell, warn};

use super::readings::Readings;
use crate::flags::body::{Described, described};

/// χ² per degree of freedom above which a remark is made.
const EXCESS: f64 = 2.0;

/// The attitudes of the body that `--body` names in one segment, on its exact motion.
pub(super) fn smoothed(
    body: &str,
    readings: &Readings,
    segment: &Segment,
    start: UnitQuaternion<f64>,
    sensor: Sensor,
) -> Result<Vec<Estimate>, Error> {
    let Described { inertia, weight_moment } = described(body)?;
    let refused = |rule: &str, remedy: &str| Err(Error::input("--body", body, rule, remedy));
    if weight_moment != [0.0; 3] {
        return refused("is a top under gravity, and a flight is that of a free body", "name a free body");
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
    if flight.chi2_per_dof().is_some_and(|chi2| chi2 > EXCESS) {
        warn(
            "the residuals exceed the noise of the sensor: a torque such as drag, or a body that is not quite this one; attitude_sigma takes \
             them for white noise, which such errors are not: the column integrated says how far the attitudes are apart",
        );
    }
    flight.at(segment.times()).map_err(failed)
}
