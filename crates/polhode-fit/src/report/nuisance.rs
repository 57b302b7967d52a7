//! What was estimated beside the tensor, and what errors of the sensor would do to the moments.

use crate::columns::column::Column;
use crate::report::differing::Differing;
use crate::settings::torque::TorqueModel;
use crate::solve::weak_estimate::WeakEstimate;

/// A number that was estimated beside the tensor.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Nuisance {
    /// Its name, as `drag` or `offset_x`.
    pub name: &'static str,
    /// Its unit, empty for a ratio.
    pub unit: &'static str,
    /// Its value.
    pub value: f64,
    /// Its standard deviation.
    pub sigma: f64,
    /// The standard deviation of its prior, where it has one.
    pub prior: Option<f64>,
    pub(crate) column: Column,
}

impl Nuisance {
    /// Of a column whose value and deviation are in units of the rate `rms`, rad/s.
    pub(crate) fn new(column: &Column, value: f64, sigma: f64, rms: f64) -> Nuisance {
        let label = column.label();
        let unit = label.factor(rms);
        Nuisance {
            name: label.name,
            unit: label.unit,
            value: value * unit,
            sigma: sigma * unit,
            prior: column.prior.map(|prior| prior * unit),
            column: *column,
        }
    }
}

/// The unknowns beside the tensor at `values`, with deviations for residuals of `variance` and for what parts of the record differ in, or
/// those of `held` by number.
pub(crate) fn nuisances(
    weak: &WeakEstimate,
    values: &[f64],
    variance: f64,
    rms: f64,
    held: &[(usize, f64)],
    differing: Option<&Differing>,
) -> Vec<Nuisance> {
    let Some(factor) = weak.stacked.as_ref().and_then(|stacked| stacked.joint_factor()) else {
        return Vec::new();
    };
    let each = weak.columns.iter().zip(values).enumerate();
    each.map(|(k, (column, value))| {
        let own = held.iter().find(|(place, _)| *place == k).map(|(_, sigma)| *sigma);
        let more = differing.map_or(0.0, |differing| differing.variance(k));
        let sigma = own.unwrap_or_else(|| (factor.row(k).norm_squared() * variance + more).sqrt());
        Nuisance::new(column, *value, sigma, rms)
    })
    .collect()
}

/// A fitted torque.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct FittedTorque {
    /// The model; never [`TorqueModel::Auto`].
    pub model: TorqueModel,
    /// Whether the fit has chosen it.
    pub is_chosen: bool,
    /// Its coefficients.
    pub coefficients: Vec<Nuisance>,
    /// Gain of log-likelihood over no torque, where both were fitted.
    pub gain: Option<f64>,
    /// I₁/I₃ and I₂/I₃ as they would be without the torque.
    pub ratios_without: Option<[f64; 2]>,
}

/// What an error of the sensor, or a wheel or a magnet in the body, that the fit takes to be zero would do to the moments.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Systematic {
    /// The error, as `offset_x`; `wheel_x` is a constant momentum inside the body, `walk` a random walk of the offsets,
    /// `magnet` the torque on a magnet in the body in a field that is fixed in space, both in random directions, over the trace.
    pub name: &'static str,
    /// Its size.
    pub size: f64,
    /// The unit of its size, empty for a ratio.
    pub unit: &'static str,
    /// The change of the principal moments, as shares of the trace, that an error of this size makes; of a walk and of a
    /// magnet its standard deviation.
    pub principal: [f64; 3],
    /// The same of I₁/I₃ and I₂/I₃.
    pub ratios: [f64; 2],
}

impl Systematic {
    /// Whether it is an error of the sensor, not a wheel or a magnet in the body.
    pub fn is_of_sensor(&self) -> bool {
        !self.name.starts_with("wheel") && self.name != "magnet"
    }
}

/// How a prior tensor and a record agree.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agreement {
    /// Square of their distance in standard deviations of it: χ² where both are right.
    pub chi2: f64,
    /// Its degrees of freedom.
    pub dof: usize,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::column::Unknowns;
    use crate::columns::drag::Drag;
    use crate::columns::offset::Offset;
    use crate::columns::scale::Scale;
    use crate::physical::coordinates::Coordinates;
    use crate::solve::weak_estimate::tests::one_row_each;

    /// Of an unknown that is told with a weight the deviation is that of the noise over it, in the unit of the report; one that a wall holds has
    /// its own.
    #[test]
    fn an_unknown_has_the_deviation_of_its_weight() {
        let columns = [Column::new(Drag, None), Column::new(Offset(1), None), Column::new(Scale, None)];
        let at = Unknowns::at(Coordinates::zeros(), &columns);
        let weights = [10.0, 20.0, 40.0, 1.0, 1.0, 1.0, 1.0, 1.0];
        let mut weak = WeakEstimate::of_rows(&columns, &at, vec![one_row_each(&weights, &[0.0; 8])], 0.5);
        let found = nuisances(&weak, &[0.1, 0.2, 0.3], 0.25, 4.0, &[(2, 0.75)], None);
        let expected = [("drag", 0.4, 0.2), ("offset_y", 0.8, 0.1), ("scale", 0.3, 0.75)];
        assert_eq!(found.len(), 3);
        for (found, (name, value, sigma)) in found.iter().zip(expected) {
            assert_eq!(found.name, name);
            assert!((found.value / value - 1.0).abs() < 1e-12, "{name}: {}", found.value);
            assert!((found.sigma / sigma - 1.0).abs() < 1e-6, "{name}: {}", found.sigma);
        }
        weak.stacked = None;
        assert!(nuisances(&weak, &[0.1, 0.2, 0.3], 0.25, 4.0, &[], None).is_empty());
    }
}
