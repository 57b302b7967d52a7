//! What a body adds to the tensor of the carrier that it is attached to.

use nalgebra::{Matrix3, Vector3};
use polhode::inertia::MassProperties;

use crate::carrier::error::CarrierError;
use crate::physical::coordinates::ENTRIES;

/// A body whose mass properties are known, attached to the carrier.
///
/// ```
/// use nalgebra::{Matrix3, Vector3};
/// use polhode::inertia::{Amount, MassProperties, Solid};
/// use polhode_fit::ProofBody;
/// // a ball of 2 kg and 5 cm on a carrier of 3 kg, its centre 0.2 m from the carrier's along x, known to a thousandth
/// let ball = Solid::named("sphere", &[0.05])?.with(Amount::Mass(2.0))?.moved(Vector3::x() * 0.2)?;
/// let proof = ProofBody::attached(&ball, 3.0)?.with_deviation(1e-3);
/// let own = 0.4 * 2.0 * 0.05 * 0.05;
/// let away = own + 2.0 * 3.0 / 5.0 * 0.2 * 0.2;
/// let expected = Matrix3::from_diagonal(&Vector3::new(own, away, away));
/// assert!((proof.added() - expected).norm() < 1e-15);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProofBody {
    added: Matrix3<f64>,
    deviation: Option<f64>,
}

impl ProofBody {
    /// By the tensor that it adds to the carrier's, kg m², sensor axes: its own about its centre of mass and the parallel-axis term.
    ///
    /// # Errors
    /// A tensor that no body has.
    pub fn adding(tensor: Matrix3<f64>) -> Result<ProofBody, CarrierError> {
        let added = MassProperties::new(1.0, Vector3::zeros(), tensor).map_err(CarrierError::Proof)?.tensor();
        let trace = added.trace();
        if !(trace * trace).is_normal() {
            let rule = "give a positive number whose square neither underflows nor overflows";
            return Err(CarrierError::Setting { name: "the trace of the proof body", value: trace, rule });
        }
        Ok(ProofBody { added, deviation: None })
    }

    /// By its mass properties in sensor axes, its centre of mass counted from that of the carrier, whose mass is
    /// `carrier_mass`, kg.
    ///
    /// # Errors
    /// A mass of the carrier that is not positive.
    pub fn attached(body: &MassProperties, carrier_mass: f64) -> Result<ProofBody, CarrierError> {
        let term = parallel_axis(body.mass(), body.center_of_mass(), carrier_mass)?;
        ProofBody::adding(body.tensor() + term)
    }

    /// The same on a carrier that holds an object of mass `object.0`, kg, whose centre of mass is at `object.1`, m: both places are counted
    /// from the centre of mass of the carrier alone.
    ///
    /// # Errors
    /// A mass that is not positive, a place that is not finite.
    pub fn attached_beside(
        body: &MassProperties,
        carrier_mass: f64,
        object: (f64, Vector3<f64>),
    ) -> Result<ProofBody, CarrierError> {
        let (mass, place) = object;
        // the object is checked as what is attached to the carrier
        parallel_axis(mass, place, carrier_mass)?;
        let centre = place / (1.0 + carrier_mass / mass);
        let from_centre = body.moved(-centre).map_err(CarrierError::Proof)?;
        ProofBody::attached(&from_centre, carrier_mass + mass)
    }

    /// With independent standard deviations of the entries ij of what it adds, `share` √(D_ii D_jj); without it they are exact. Those of
    /// different records are independent, too.
    #[must_use]
    pub fn with_deviation(self, share: impl Into<Option<f64>>) -> ProofBody {
        ProofBody { deviation: share.into(), ..self }
    }

    /// What it adds to the tensor of the carrier, kg m², sensor axes.
    #[must_use]
    pub fn added(&self) -> Matrix3<f64> {
        self.added
    }

    /// The standard deviations of its entries xx, yy, zz, xy, xz, yz, kg m², where it has any.
    pub(super) fn deviations(&self) -> Result<Option<[f64; 6]>, CarrierError> {
        let Some(share) = self.deviation else { return Ok(None) };
        if !(share > 0.0 && (share * share).is_normal()) {
            let rule = "give a positive number, or leave it out if the body is exact";
            return Err(CarrierError::Setting {
                name: "the deviation of the proof body",
                value: share,
                rule,
            });
        }
        let size = |(i, j): (usize, usize)| share * (self.added[(i, i)] * self.added[(j, j)]).max(0.0).sqrt();
        Ok(Some(ENTRIES.map(size)))
    }
}

/// μ (|d|² 1 − d dᵀ) of a body of this mass, kg, with its centre of mass at `place`, m, from that of a carrier of mass `carrier`.
pub(super) fn parallel_axis(
    mass: f64,
    place: Vector3<f64>,
    carrier: f64,
) -> Result<Matrix3<f64>, CarrierError> {
    let rule = "give a positive number, kg";
    for (name, value) in [("the mass of the attached body", mass), ("the mass of the carrier", carrier)] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(CarrierError::Setting { name, value, rule });
        }
    }
    if let Some(value) = place.iter().copied().find(|value| !value.is_finite()) {
        let (name, rule) = ("the position of the attached body", "give finite numbers, m");
        return Err(CarrierError::Setting { name, value, rule });
    }
    // no product of the masses, so that neither over- nor underflows
    let reduced = mass / (1.0 + mass / carrier);
    Ok((Matrix3::identity() * place.norm_squared() - place * place.transpose()) * reduced)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The deviation of an entry ij is the share times the root of D_ii D_jj, that of no entry where there is none.
    #[test]
    fn deviations_of_a_proof_body_go_with_its_moments() {
        let tensor = Matrix3::new(4.0, 1.0, 0.0, 1.0, 9.0, 0.0, 0.0, 0.0, 9.0);
        let body = ProofBody::adding(tensor).unwrap();
        // halves of 4, 9, 9, of √36, √36 and √81
        let halves = [2.0, 4.5, 4.5, 3.0, 3.0, 4.5];
        assert_eq!(body.with_deviation(0.5).deviations(), Ok(Some(halves)));
        assert_eq!(body.with_deviation(0.5).with_deviation(None::<f64>).deviations(), Ok(None));
        for share in [0.0, -0.5, f64::NAN, f64::INFINITY, 1e-170] {
            let refused = body.with_deviation(share).deviations();
            let Err(CarrierError::Setting { name, .. }) = refused else { panic!("{share}: {refused:?}") };
            assert_eq!(name, "the deviation of the proof body");
        }
        // squares of 22e-150 are numbers, those of 22e-160 have lost their digits
        assert!(ProofBody::adding(tensor * 1e-150).is_ok());
        let refused = ProofBody::adding(tensor * 1e-160);
        let Err(CarrierError::Setting { name, value, .. }) = refused else { panic!("{refused:?}") };
        assert!(name == "the trace of the proof body" && (value / 22e-160 - 1.0).abs() < 1e-12, "{value:e}");
    }
}
