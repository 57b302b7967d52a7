//! Why a fit was refused, with the flags that help, and what it tells all the same.

use polhode_fit::{FitError, PoseFault};

use super::report::Facts;

/// The reason, with the flags that help.
pub(super) fn reason(error: &FitError) -> String {
    let flags = match error {
        FitError::NoFlight { .. } | FitError::Driven { .. } | FitError::Poses(PoseFault::NotFree { .. }) => {
            "--window t0,t1"
        }
        FitError::Units { .. } => "--rate-unit, --time-unit; --trust-units",
        FitError::Poses(PoseFault::Direction { .. } | PoseFault::Inverted { .. }) => {
            "--attitude body-to-space or space-to-body"
        }
        FitError::SameAxes { .. } => "--columns",
        FitError::Poses(PoseFault::FarApart { .. }) => "--attitude-noise",
        FitError::UntoldSensor => {
            "smaller --gyro-bias, --gyro-scale, --gyro-axis-scales, --gyro-misalignment or --gyro-skew"
        }
        FitError::StatedNoise { .. } => "--noise",
        FitError::SizeDiffers { .. } => "--window t0,t1; --trace, --moment",
        FitError::Undersampled { .. } => "--rate-unit, --time-unit",
        _ => return error.to_string(),
    };
    format!("{error} ({flags})")
}

/// What it tells of the record, and whether the fit failed rather than its input.
pub(super) fn facts(error: &FitError) -> (Option<Facts>, bool) {
    match error {
        FitError::Unidentifiable(what) => (Some(Facts::unidentified(what)), true),
        FitError::Unsettled { axes, .. } => (Some(Facts::unsettled(axes)), true),
        FitError::NoFlight { .. } => (Some(Facts::not_free()), true),
        FitError::Driven { .. } | FitError::Poses(PoseFault::NotFree { .. }) => (Some(Facts::driven()), true),
        FitError::Poses(PoseFault::Direction { .. }) => (Some(Facts::direction_open()), true),
        FitError::Poses(PoseFault::Unsettled) => (Some(Facts::several()), true),
        FitError::Untold { names, rank } => (Some(Facts::untold(names, *rank)), true),
        FitError::UntoldSensor => (Some(Facts::untold_sensor()), true),
        FitError::Contradicted { .. }
        | FitError::Exchanged { .. }
        | FitError::Told(_)
        | FitError::ZeroInputs(_) => (Some(Facts::contradicted()), true),
        FitError::NoRotation { .. }
        | FitError::StatedNoise { .. }
        | FitError::Solver(_)
        | FitError::Poses(
            PoseFault::NoTurn { .. }
            | PoseFault::FarApart { .. }
            | PoseFault::StatedNoise { .. }
            | PoseFault::HalfTurn { .. },
        ) => (None, true),
        _ => (None, false),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever leaves the tensor open, the fit has failed, and says what is open and which record would tell more.
    #[test]
    fn records_that_do_not_determine_the_tensor_have_facts() {
        let untold = |rank| FitError::Untold { names: vec!["drag_xx", "drag_zz"], rank };
        for (error, rank, open) in [
            (untold(3), Some(3), "drag_xx, drag_zz"),
            (untold(5), None, "drag_xx, drag_zz"),
            (FitError::UntoldSensor, None, "errors of the sensor"),
            (FitError::Poses(PoseFault::Unsettled), None, "ratios of the moments"),
        ] {
            let (told, failed) = facts(&error);
            let told = told.unwrap();
            assert!(failed && told.rank == rank && told.open[0].contains(open), "{error}: {told:?}");
            assert!(told.next.contains("longer"), "{error}: {told:?}");
        }
    }
}
