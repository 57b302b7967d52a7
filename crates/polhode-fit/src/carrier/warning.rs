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
                "the records contradict each other: chi squared is {chi2:.1} of {dof} degrees of freedom; check that the sensor sits \
                 as before, and the axes, place and masses of the proof body; all deviations are enlarged by {:.1}",
                (chi2 / *dof as f64).sqrt()
            ),
            Self::LightObject { trace, sigma } => write!(
                f,
                "the object is small beside its deviation: its trace is {trace:.2e} +- {sigma:.2e} kg m^2; take a lighter carrier, \
                 or record longer"
            ),
            Self::Held { name, pull } => write!(
                f,
                "the law I1 + I2 >= I3 holds the tensor of the {name}: without it the answer lies {pull:.1} standard deviations away"
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
