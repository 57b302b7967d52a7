//! The records of a joint fit, and what was attached to the carrier in each.

use core::fmt;

use nalgebra::{Matrix3, Vector3};
use polhode::record::Record;

use crate::carrier::error::CarrierError;
use crate::carrier::proof::{ProofBody, parallel_axis};

/// What tumbled.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attached {
    /// The carrier alone.
    Nothing,
    /// Carrier and proof body.
    Proof,
    /// Carrier and object.
    Object,
    /// Carrier, object and proof body.
    ObjectAndProof,
}

impl fmt::Display for Attached {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Attached::Nothing => "carrier",
            Attached::Proof => "carrier and proof body",
            Attached::Object => "carrier and object",
            Attached::ObjectAndProof => "carrier, object and proof body",
        })
    }
}

impl Attached {
    pub(super) fn has_object(self) -> bool {
        matches!(self, Attached::Object | Attached::ObjectAndProof)
    }
}

/// One record.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tumble {
    pub(super) attached: Attached,
    pub(super) record: Record,
    pub(super) proof: Option<ProofBody>,
}

/// Records of one carrier and one sensor, in the axes of that sensor: of the carrier alone and of what was attached to it.
#[derive(Clone, Debug, PartialEq)]
pub struct CarrierRecords {
    pub(super) tumbles: Vec<Tumble>,
    pub(super) object_term: Option<Matrix3<f64>>,
    pub(super) finds_wheel: bool,
}

impl CarrierRecords {
    /// Of the carrier alone.
    #[must_use]
    pub fn new(carrier: Record) -> CarrierRecords {
        let alone = Tumble { attached: Attached::Nothing, record: carrier, proof: None };
        CarrierRecords { tumbles: vec![alone], object_term: None, finds_wheel: false }
    }

    /// With a record of carrier and proof body; several such records may have proof bodies of their own.
    #[must_use]
    pub fn with_proof(self, record: Record, proof: ProofBody) -> CarrierRecords {
        self.with(Attached::Proof, record, Some(proof))
    }

    /// With a record of carrier and object.
    #[must_use]
    pub fn with_object(self, record: Record) -> CarrierRecords {
        self.with(Attached::Object, record, None)
    }

    /// With a record of carrier, object and proof body: it tells the size of the object where no wheel and no torque does. What
    /// the proof body adds is counted from the common centre of mass of carrier and object.
    #[must_use]
    pub fn with_object_and_proof(self, record: Record, proof: ProofBody) -> CarrierRecords {
        self.with(Attached::ObjectAndProof, record, Some(proof))
    }

    /// With the mass of the object, kg, its centre of mass from that of the carrier, m, sensor axes, and the mass of the carrier:
    /// the fit then gives the tensor of the object about its own centre of mass, too.
    ///
    /// # Errors
    /// Masses that are not positive, a place that is not finite.
    pub fn with_object_at(
        mut self,
        mass: f64,
        place: Vector3<f64>,
        carrier_mass: f64,
    ) -> Result<CarrierRecords, CarrierError> {
        self.object_term = Some(parallel_axis(mass, place, carrier_mass)?);
        Ok(self)
    }

    /// The wheel momenta of the records are those of a wheel of 1 kg m², its axis times its speed relative to the body, rad/s: its
    /// moment of inertia is found.
    #[must_use]
    pub fn with_unknown_wheel(mut self) -> CarrierRecords {
        self.finds_wheel = true;
        self
    }

    /// What is said to have tumbled in the first record that is one before it too, wholly or in part, and in that one.
    pub(super) fn repeated(&self) -> Option<(Attached, Attached)> {
        self.tumbles.iter().enumerate().find_map(|(k, Tumble { attached, record, .. })| {
            let is_same = |before: &&Tumble| before.record.shared(record) > 0;
            self.tumbles[..k].iter().find(is_same).map(|before| (*attached, before.attached))
        })
    }

    fn with(mut self, attached: Attached, record: Record, proof: Option<ProofBody>) -> CarrierRecords {
        self.tumbles.push(Tumble { attached, record, proof });
        self
    }
}
