//! What limits the use of a joint fit.

use core::fmt;

use crate::carrier::agreement::contradicts;
use crate::carrier::estimate::MeasuredBody;
use crate::report::nuisance::Agreement;
use crate::thresholds::noise::SURE;

/// What limits the use of a joint fit. Its `Display` is a sentence.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CarrierWarning {
    /// The records contradict each other; all deviations are enlarged accordingly.
    Contradiction {
        /// Sum of squares of the records' deviations from the answer.
        chi2: f64,
        /// Its degrees of freedom.
        dof: usize,
    },
    /// The object is small beside its deviation.
    LightObject {
        /// Trace of its tensor, kg m².
        trace: f64,
        /// Its standard deviation, kg m².
        sigma: f64,
    },
    /// The physical law holds the answer.
    Held {
        /// Which tensor.
        name: &'static str,
        /// Standard deviations by which it moved the answer.
        pull: f64,
    },
}

impl fmt::Display for CarrierWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Contradiction { chi2, dof } => write!(
                f,
                "the records contradict each other: chi squared is {chi2:.1} of {dof} degrees of freedom; all standard deviations are enlarged \
                 by a factor of {:.1}. Check that the sensor was not moved, and the axes, position and masses of the proof body",
                (chi2 / *dof as f64).sqrt()
            ),
            Self::LightObject { trace, sigma } => write!(
                f,
                "the tensor of the object is hardly larger than its standard deviation: its trace is {trace:.2e} +- {sigma:.2e} kg m^2; take a \
                 lighter carrier, or record longer"
            ),
            Self::Held { name, pull } => write!(
                f,
                "the law I1 + I2 >= I3 limits the tensor of the {name}: without it the answer lies {pull:.1} standard deviations away"
            ),
        }
    }
}

/// That the records contradict each other, where they do.
pub(super) fn contradiction(agreement: Agreement) -> Option<CarrierWarning> {
    let Agreement { chi2, dof } = agreement;
    contradicts(agreement).then_some(CarrierWarning::Contradiction { chi2, dof })
}

/// That an object is small beside its deviation, where it is.
pub(super) fn light(object: &MeasuredBody) -> Option<CarrierWarning> {
    let (trace, sigma) = object.trace();
    (trace <= SURE * sigma).then_some(CarrierWarning::LightObject { trace, sigma })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, SMatrix, UnitQuaternion, Vector3};

    /// The deviation of a trace comes from the entries xx, yy and zz alone, with what they share; five of them hide an object.
    #[test]
    fn an_object_is_light_within_five_deviations_of_its_trace() {
        let object = |sigma: f64| {
            let mut covariance = SMatrix::<f64, 6, 6>::repeat(1e3);
            // 2 + 1 − 2 of the square
            let own = Matrix3::new(2.0, -1.0, 0.0, -1.0, 1.0, 0.0, 0.0, 0.0, 0.0) * (sigma * sigma);
            covariance.fixed_view_mut::<3, 3>(0, 0).copy_from(&own);
            MeasuredBody {
                tensor: Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0)),
                covariance,
                principal: [1.0, 2.0, 3.0],
                sigma_principal: [sigma; 3],
                axes: UnitQuaternion::identity(),
            }
        };
        // a trace of 6 between 5 · 1.1875 and 5 · 1.25
        assert_eq!(light(&object(1.25)), Some(CarrierWarning::LightObject { trace: 6.0, sigma: 1.25 }));
        assert_eq!(light(&object(1.1875)), None);
        assert_eq!(
            [1.25, 0.5, 0.0].map(|sigma| object(sigma).trace()),
            [(6.0, 1.25), (6.0, 0.5), (6.0, 0.0)]
        );
    }

    #[test]
    fn warnings_of_a_joint_fit_say_their_numbers() {
        let agreement = Agreement { chi2: 900.0, dof: 4 };
        let told = contradiction(agreement);
        assert_eq!(told, Some(CarrierWarning::Contradiction { chi2: 900.0, dof: 4 }));
        let says = |warning: CarrierWarning, parts: &[&str]| {
            let text = warning.to_string();
            assert!(parts.iter().all(|part| text.contains(part)), "{text}: {parts:?}");
        };
        // the root of 900/4
        says(told.unwrap(), &["900.0 of 4 degrees", "enlarged by a factor of 15.0"]);
        says(CarrierWarning::LightObject { trace: 6.0, sigma: 1.25 }, &["6.00e0 +- 1.25e0 kg m^2"]);
        says(CarrierWarning::Held { name: "object", pull: 2.5 }, &["of the object", "lies 2.5 standard"]);
        assert_eq!(contradiction(Agreement { chi2: 4.0, dof: 4 }), None);
    }
}
