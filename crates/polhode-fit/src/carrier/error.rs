//! Why a joint fit was refused.

use thiserror::Error;

use polhode::inertia::MassError;

use crate::carrier::records::Attached;
use crate::error::FitError;
use crate::physical::failure::SolverFailure;

impl From<CarrierError> for polhode::Error {
    fn from(error: CarrierError) -> Self {
        polhode::Error::new(error)
    }
}

/// Why a joint fit of a carrier was refused.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CarrierError {
    /// One of the records cannot be fitted.
    #[error("the record of {attached}: {error}")]
    Record {
        /// What tumbled.
        attached: Attached,
        /// Why.
        error: Box<FitError>,
    },
    /// Two records are one.
    #[error(
        "the record of {attached} has samples of that of {before}, although the carrier tumbles differently with another body on it; give \
         each its own record"
    )]
    Same {
        /// What is said to have tumbled.
        attached: Attached,
        /// What is said of the record before.
        before: Attached,
    },
    /// The body turns by so much between samples that a record has no weak equations.
    #[error(
        "the samples of the record of {attached} are too far apart for a joint fit: record so fast that the body makes less than a tenth of a \
         turn from one sample to the next"
    )]
    Sparse {
        /// What tumbled.
        attached: Attached,
    },
    /// A value that cannot be used.
    #[error("{name} is {value:?}; {rule}")]
    Setting {
        /// Which one.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        rule: &'static str,
    },
    /// Something is known of the tensors that a joint fit does not take.
    #[error(
        "a joint fit takes no {name}: the size comes from the proof body, from wheels or from torques; leave it out"
    )]
    Beforehand {
        /// What.
        name: &'static str,
    },
    /// The proof body has a tensor that no body has.
    #[error("the proof body: {0}")]
    Proof(MassError),
    /// Nothing gives the size of the tensors.
    #[error(
        "nothing gives the size of the carrier{}: give a record with a proof body, known wheel momenta or known torques",
        told.map_or(String::new(), |(value, sigma)| format!(
            ": 1/trace by wheels and torques is {value:.2e} +- {sigma:.2e} 1/(kg m^2), too uncertain"
        ))
    )]
    NoSize {
        /// One over the trace of the carrier by wheels and torques and its standard deviation, 1/(kg m²), where there are any.
        told: Option<(f64, f64)>,
    },
    /// The proof body changes the motion by no more than the deviation of the records.
    #[error(
        "the proof body is too light. It adds a trace of {trace:.3e} kg m^2; from the two shapes, 1/trace of carrier and proof body is \
         {inverse:.2e} +- {sigma:.2e} 1/(kg m^2), which is {:.1} standard deviations where {needed} are needed. It is heavy enough if \
         the trace of both is below {bound:.3e} kg m^2. Take one at least {:.1} times as heavy, or of another shape, or record longer", inverse / sigma, needed / (inverse / sigma).max(1.0)
    )]
    TooLight {
        /// Trace of what it adds, kg m².
        trace: f64,
        /// One over the trace of carrier and proof body, 1/(kg m²).
        inverse: f64,
        /// Its standard deviation, 1/(kg m²).
        sigma: f64,
        /// Standard deviations that are needed.
        needed: f64,
        /// The largest trace of carrier and proof body that it would tell, kg m².
        bound: f64,
    },
    /// The proof body changes the shape the other way.
    #[error(
        "the shape changes in the direction opposite to what the proof body adds: 1/trace of carrier and proof body would be \
         {inverse:.2e} +- {sigma:.2e} 1/(kg m^2); check which record is which, that the axes are right-handed, and the axes, the signs of \
         the products of inertia and the position of the proof body"
    )]
    Opposite {
        /// One over the trace of carrier and proof body, 1/(kg m²).
        inverse: f64,
        /// Its standard deviation, 1/(kg m²).
        sigma: f64,
    },
    /// The size of the object is not told.
    #[error(
        "the record of the object determines five of the six numbers of its tensor, and nothing determines the size: record carrier, object \
         and proof body together, or let a wheel turn{}",
        moved.map_or(String::new(), |(value, sigma)| format!(
            "; with the proof body 1/trace is {value:.2e} +- {sigma:.2e} 1/(kg m^2)"
        ))
    )]
    ObjectSize {
        /// One over the trace of carrier, object and proof body and its standard deviation, 1/(kg m²), where they tumbled together.
        moved: Option<(f64, f64)>,
    },
    /// Records of which only some have a wheel.
    #[error(
        "the record of {with} has wheel momenta and that of {without} has none: all records must have the same wheel; give zeros where \
         it is at rest"
    )]
    Wheels {
        /// The first that has.
        with: Attached,
        /// The first that has not.
        without: Attached,
    },
    /// The axis of the wheel whose inertia is to be found differs between records.
    #[error(
        "the axis of the wheel in the record of {attached} differs by {angle:.2e} rad from that in the first record: its moment of inertia \
         is found about one axis; give the same axis in all records"
    )]
    WheelAxis {
        /// What tumbled.
        attached: Attached,
        /// Angle between the two axes, rad.
        angle: f64,
    },
    /// The moment of the wheel that is to be found would be negative.
    #[error(
        "the moment of inertia of the wheel would be {inertia:.3e} +- {sigma:.1e} kg m^2, {:.1} standard deviations below zero: reverse the axis \
         of the wheel, or the sign of its speed",
        -*inertia / *sigma
    )]
    WheelSense {
        /// The moment, kg m².
        inertia: f64,
        /// Its standard deviation, kg m².
        sigma: f64,
    },
    /// With the deviations that the contradiction asks for, the size of the carrier is open.
    #[error(
        "the records contradict each other so much that they do not determine the size: chi squared is {chi2:.1} of {dof} degrees of freedom; \
         with standard deviations enlarged by a factor of {:.1} the trace of the carrier would be {trace:.2e} +- {sigma:.2e} kg m^2. Check \
         that the sensor was not moved, which record is which, and the axes, position and masses of the proof body",
        (chi2 / *dof as f64).sqrt()
    )]
    Contradicted {
        /// Sum of squares of the records' deviations from the answer.
        chi2: f64,
        /// Its degrees of freedom.
        dof: usize,
        /// Trace of the carrier, kg m².
        trace: f64,
        /// Its standard deviation, enlarged, kg m².
        sigma: f64,
    },
    /// Gauss's and Newton's method did not come to rest.
    #[error(
        "the joint fit did not converge in {rounds} rounds: a further one would move the answer by {moved:.1e} standard deviations; the \
         records may contradict each other: check axes, positions and masses"
    )]
    Unsettled {
        /// Rounds that were made.
        rounds: usize,
        /// Standard deviations by which a further round would move the answer.
        moved: f64,
    },
    /// The equations have no solution.
    #[error("the joint fit failed: {0}")]
    Solver(#[from] SolverFailure),
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a refusal asks for follows from its numbers: deviations, how much heavier a proof body must be, how far deviations are enlarged.
    #[test]
    fn refusals_of_a_joint_fit_say_their_numbers() {
        let says = |error: CarrierError, parts: &[&str]| {
            let text = error.to_string();
            assert!(parts.iter().all(|part| text.contains(part)), "{text}: {parts:?}");
        };
        let (trace, sigma) = (0.5, 0.25);
        let light = |inverse| CarrierError::TooLight { trace, inverse, sigma, needed: 5.0, bound: 0.8 };
        says(light(0.5), &["2.0 standard deviations where 5 are", "at least 2.5 times", "below 8.000e-1"]);
        // below one deviation its size tells nothing
        says(light(0.125), &["0.5 standard deviations", "at least 5.0 times"]);
        says(CarrierError::WheelSense { inertia: -1.5, sigma }, &["-1.500e0 +-", "6.0 standard"]);
        let contradicted = CarrierError::Contradicted { chi2: 900.0, dof: 4, trace, sigma };
        says(contradicted, &["900.0 of 4", "enlarged by a factor of 15.0", "5.00e-1 +- 2.50e-1"]);
        says(CarrierError::NoSize { told: Some((trace, sigma)) }, &["5.00e-1 +- 2.50e-1 1/(kg m^2), too"]);
        assert!(!CarrierError::NoSize { told: None }.to_string().contains("too uncertain"));
        says(CarrierError::ObjectSize { moved: Some((trace, sigma)) }, &["with the proof body 1/trace"]);
        assert!(!CarrierError::ObjectSize { moved: None }.to_string().contains("with the proof body"));
        says(CarrierError::Unsettled { rounds: 60, moved: 0.5 }, &["60 rounds", "5.0e-1 standard"]);
    }
}
