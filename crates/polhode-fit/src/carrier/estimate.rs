//! What a joint fit of carrier, proof body and object tells.

use core::fmt;

use nalgebra::{DMatrix, Matrix3, SMatrix, UnitQuaternion};

use crate::carrier::records::Attached;
use crate::carrier::warning::CarrierWarning;
use crate::report::estimate::Estimate;
use crate::report::nuisance::{Agreement, Nuisance};

/// What gives the size of the tensors.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SizeSource {
    /// Wheels of known momentum, or known torques.
    Inputs,
    /// The proof body.
    Proof,
}

impl fmt::Display for SizeSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            SizeSource::Inputs => "wheels or torques",
            SizeSource::Proof => "proof body",
        })
    }
}

/// How well a source tells the size by itself.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size {
    /// The source.
    pub source: SizeSource,
    /// Relative standard deviation of the trace of the carrier by it.
    pub relative: f64,
}

/// An absolute tensor and its uncertainty.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredBody {
    /// The tensor, kg m², sensor axes.
    pub tensor: Matrix3<f64>,
    /// Covariance of its entries xx, yy, zz, xy, xz, yz, (kg m²)².
    pub covariance: SMatrix<f64, 6, 6>,
    /// Principal moments, ascending, kg m².
    pub principal: [f64; 3],
    /// Their standard deviations, kg m².
    pub sigma_principal: [f64; 3],
    /// Takes coordinates along the principal axes (ascending, right-handed) to sensor axes.
    pub axes: UnitQuaternion<f64>,
}

impl MeasuredBody {
    /// The trace and its standard deviation, kg m².
    pub(super) fn trace(&self) -> (f64, f64) {
        (self.tensor.trace(), self.covariance.fixed_view::<3, 3>(0, 0).sum().max(0.0).sqrt())
    }
}

/// The moment of inertia of a wheel about its axis.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredWheel {
    /// The moment, kg m².
    pub inertia: f64,
    /// Its standard deviation, kg m².
    pub sigma: f64,
}

/// What a joint fit of carrier, proof body and object tells.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct CarrierEstimate {
    /// The carrier, about its centre of mass.
    pub carrier: MeasuredBody,
    /// What the object adds to it: its tensor with the parallel-axis term.
    pub object: Option<MeasuredBody>,
    /// The object about its own centre of mass, where its mass and place were given.
    pub object_itself: Option<MeasuredBody>,
    /// The wheel, where its inertia was to be found.
    pub wheel: Option<MeasuredWheel>,
    /// Covariance of the entries xx, yy, zz, xy, xz, yz of the carrier, those of what the object adds, and the inertia of the wheel, as far
    /// as they are there, (kg m²)².
    pub covariance: DMatrix<f64>,
    /// What was estimated of the sensor from all records together, each with its prior.
    pub nuisances: Vec<Nuisance>,
    /// What gives the size of the carrier; the surest counts most.
    pub sizes: Vec<Size>,
    /// How the records agree: χ² where model and records are right.
    pub agreement: Agreement,
    /// Distance, in standard deviations, by which the physical law moved the answer.
    pub pull: f64,
    /// Each record by itself, without a size where the inertia of the wheel was to be found.
    pub records: Vec<(Attached, Estimate)>,
    /// What limits the use of the estimate, beside the warnings of each record.
    pub warnings: Vec<CarrierWarning>,
}

impl CarrierEstimate {
    /// All warnings in words, those of each record with what tumbled.
    #[must_use]
    pub fn all_warnings(&self) -> Vec<String> {
        let of_records = self.records.iter().flat_map(|(attached, of)| {
            of.warnings.iter().map(move |warning| format!("{attached}: {warning}"))
        });
        of_records.chain(self.warnings.iter().map(ToString::to_string)).collect()
    }
}
