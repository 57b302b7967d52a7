//! The flags of a wheel whose speed is a column.

use clap::Args;
use nalgebra::Vector3;
use polhode_files::numbers::numbers;

/// A wheel whose speed is a column.
#[derive(Args, Clone, Debug)]
pub(super) struct WheelArguments {
    /// A wheel: its axis in sensor axes and its moment of inertia about it, kg m^2. Its speed relative to the body is the
    /// column `wheel`, with its unit in the header, as `wheel (rpm)`
    #[arg(long, value_name = "nx,ny,nz,I", value_parser = wheel, allow_hyphen_values = true, help_heading = "Torques and wheels")]
    wheel: Option<Wheel>,
    /// Find the moment of inertia of a wheel with this axis, sensor axes. The tensor of --body, in sensor axes, is that with the
    /// wheel at rest; the speed is the column `wheel` as above. With --carrier it is found together with carrier and object
    #[arg(long, value_name = "nx,ny,nz", value_parser = axis, conflicts_with = "wheel", allow_hyphen_values = true, help_heading = "Torques and wheels")]
    calibrate_wheel: Option<Vector3<f64>>,
}

fn axis(text: &str) -> Result<Vector3<f64>, String> {
    let axis = Vector3::from(numbers::<3>(text)?);
    let size = axis.norm();
    if size > 0.0 && size.is_finite() {
        Ok(axis / size)
    } else {
        Err("the axis has no direction; give a vector that is not zero".into())
    }
}

/// Momentum per speed, kg m².
#[derive(Clone, Copy, Debug, PartialEq)]
struct Wheel(Vector3<f64>);

fn wheel(text: &str) -> Result<Wheel, String> {
    let [x, y, z, inertia] = numbers::<4>(text)?;
    let axis = axis(&format!("{x},{y},{z}"))?;
    if inertia > 0.0 {
        Ok(Wheel(axis * inertia))
    } else {
        Err(format!("the moment of inertia is {inertia:?}; it must be positive"))
    }
}

impl WheelArguments {
    /// The axis of the wheel whose inertia is to be found.
    pub(super) fn calibrated(&self) -> Option<Vector3<f64>> {
        self.calibrate_wheel
    }

    /// The momentum of the wheel whose speed is read, per rad/s; one to be calibrated has 1 kg m² so far.
    pub(super) fn momentum(&self) -> Option<Vector3<f64>> {
        self.wheel.map(|wheel| wheel.0).or(self.calibrate_wheel)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wheel_has_an_axis_and_a_moment() {
        assert_eq!(wheel("0,0,2,3e-6"), Ok(Wheel(Vector3::new(0.0, 0.0, 3e-6))));
        assert!(wheel("0,0,0,1").unwrap_err().contains("no direction"));
        assert!(wheel("0,0,1,-1").unwrap_err().contains("must be positive"));
        assert!(wheel("0,0,1").unwrap_err().contains("3 given, 4 needed"));
    }
}
