//! The flags of a carrier, a proof body and an object on it.

use std::path::PathBuf;

use clap::Args;
use nalgebra::{Matrix3, Vector3};
use polhode::inertia::MassProperties;
use polhode_files::error::Error;
use polhode_files::numbers::{list, numbers, positive};
use polhode_fit::{CarrierError, ProofBody};

use crate::flags::body::named;

/// Records of a carrier and of what was attached to it.
#[derive(Args, Clone, Debug)]
pub(crate) struct CarrierArguments {
    /// Record of the carrier alone; DATA.csv, if given, is the carrier with the object on it. One joint fit of all records gives the
    /// absolute tensors of carrier and object. All records are of one sensor, in its axes. The N of --window counts the files of --carrier,
    /// --proof, DATA and --object-proof, in this order
    #[arg(long, value_name = "FILE.csv", help_heading = "Carrier", conflicts_with_all = [
        "at_least", "at_most", "body", "trace", "momentum", "twice_energy", "moment", "prior_inertia", "prior_shape",
        "residuals", "figure", "from", "quaternion", "attitude", "product", "euler", "angle_unit", "attitude_noise",
    ])]
    carrier: Vec<PathBuf>,
    /// Record of carrier and proof body, which gives the size
    #[arg(
        long,
        value_name = "FILE.csv",
        help_heading = "Carrier",
        requires = "carrier",
        requires = "proof_body"
    )]
    proof: Vec<PathBuf>,
    /// Record of carrier, object and proof body, which gives the size of the object if no wheel turns and no torque is known
    #[arg(
        long,
        value_name = "FILE.csv",
        help_heading = "Carrier",
        requires = "carrier",
        requires = "proof_body"
    )]
    object_proof: Vec<PathBuf>,
    /// Tensor of the proof body about its centre of mass, kg m^2, sensor axes: three moments or six entries, a body of the catalogue,
    /// or a file as of `polhode inertia`. Without --proof-at it is the whole tensor that the proof body adds to the carrier
    #[arg(
        long,
        value_name = "Ixx,Iyy,Izz[,Ixy,Ixz,Iyz]|NAME|FILE",
        help_heading = "Carrier",
        requires = "carrier",
        allow_hyphen_values = true
    )]
    proof_body: Option<String>,
    /// Relative standard deviation s of the tensor D that the proof body adds: s sqrt(Dii Djj) for the entry Dij [default: exact]
    #[arg(long, value_name = "SIGMA", value_parser = positive, help_heading = "Carrier", requires = "proof_body", allow_hyphen_values = true)]
    proof_sigma: Option<f64>,
    /// Centre of mass of the proof body relative to that of the carrier, m, sensor axes, and its mass, kg: adds the parallel-axis term
    #[arg(long, value_name = "x,y,z,MASS", value_parser = numbers::<4>, help_heading = "Carrier", requires = "proof_body", requires = "carrier_mass", allow_hyphen_values = true)]
    proof_at: Option<[f64; 4]>,
    /// The same for the object: the answer then also has its tensor about its own centre of mass
    #[arg(long, value_name = "x,y,z,MASS", value_parser = numbers::<4>, help_heading = "Carrier", requires = "carrier_mass", allow_hyphen_values = true)]
    object_at: Option<[f64; 4]>,
    /// Mass of the carrier, kg
    #[arg(long, value_name = "MASS", value_parser = positive, help_heading = "Carrier", requires = "carrier", allow_hyphen_values = true)]
    carrier_mass: Option<f64>,
}

impl CarrierArguments {
    /// Whether a joint fit is asked for.
    pub(crate) fn is_given(&self) -> bool {
        !self.carrier.is_empty()
    }

    /// Files of carrier, carrier and proof body, carrier and object, and all three.
    pub(crate) fn files<'a>(&'a self, data: &'a [PathBuf]) -> [&'a [PathBuf]; 4] {
        [&self.carrier, &self.proof, data, &self.object_proof]
    }

    /// Refuses a place or a mass that nothing uses; `has_object`: whether a record has the object on the carrier.
    pub(super) fn check_used(&self, has_object: bool) -> Result<(), Error> {
        if self.object_at.is_some() && !has_object {
            let rule = "no record has the object on the carrier";
            let remedy = "give DATA.csv or --object-proof, or leave it out";
            return Err(Error::input("--object-at", "", rule, remedy));
        }
        if let (Some(mass), None, None) = (self.carrier_mass, self.proof_at, self.object_at) {
            let rule = "goes with the position of a proof body or an object, and none is given";
            let remedy = "give --proof-at or --object-at too, or leave it out";
            return Err(Error::input("--carrier-mass", &mass.to_string(), rule, remedy));
        }
        Ok(())
    }

    /// The proof body on the carrier.
    pub(super) fn proof_body(&self) -> Result<Option<ProofBody>, Error> {
        self.proof(ProofBody::attached)
    }

    /// The same on carrier and object.
    pub(super) fn proof_body_beside_object(&self) -> Result<Option<ProofBody>, Error> {
        if self.object_proof.is_empty() {
            return Ok(None);
        }
        match (self.proof_at, self.object_place()?) {
            (Some(_), None) => Err(Error::input(
                "--object-proof",
                "",
                "the position of the proof body counts from the common centre of mass of carrier and object, which is not known",
                "give position and mass of the object by --object-at",
            )),
            (_, Some((mass, place, _))) => {
                self.proof(|body, carrier| ProofBody::attached_beside(body, carrier, (mass, place)))
            }
            (None, None) => self.proof_body(),
        }
    }

    /// Mass and place of the object, and the mass of the carrier.
    pub(super) fn object_place(&self) -> Result<Option<(f64, Vector3<f64>, f64)>, Error> {
        let given = self.object_at.zip(self.carrier_mass);
        given
            .map(|([x, y, z, m], carrier)| Ok((mass("--object-at", m)?, Vector3::new(x, y, z), carrier)))
            .transpose()
    }

    /// The proof body, placed by `attach`, which takes the mass of the carrier, where a place is given.
    fn proof(
        &self,
        attach: impl Fn(&MassProperties, f64) -> Result<ProofBody, CarrierError>,
    ) -> Result<Option<ProofBody>, Error> {
        let Some(text) = &self.proof_body else { return Ok(None) };
        let tensor = own(text)?;
        let refused = |error: String| Error::Input(format!("--proof-body: {error}"));
        let body = match self.proof_at.zip(self.carrier_mass) {
            None => ProofBody::adding(tensor),
            Some(([x, y, z, m], carrier)) => {
                let body = MassProperties::new(mass("--proof-at", m)?, Vector3::new(x, y, z), tensor);
                attach(&body.map_err(|error| refused(error.to_string()))?, carrier)
            }
        };
        Ok(Some(body.map_err(|error| refused(error.to_string()))?.with_deviation(self.proof_sigma)))
    }
}

/// The tensor of the proof body about its centre of mass.
fn own(text: &str) -> Result<Matrix3<f64>, Error> {
    match list(text).as_deref() {
        Ok(&[x, y, z]) => Ok(Matrix3::from_diagonal(&Vector3::new(x, y, z))),
        Ok(&[xx, yy, zz, xy, xz, yz]) => Ok(Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)),
        Ok(found) => {
            let rule = format!("{} numbers, and 3 moments or 6 entries are needed", found.len());
            Err(Error::input("--proof-body", text, &rule, "separate them by commas"))
        }
        Err(_) => Ok(named("--proof-body", text)?.inertia.tensor()),
    }
}

fn mass(flag: &str, value: f64) -> Result<f64, Error> {
    if value > 0.0 {
        return Ok(value);
    }
    let rule = "the mass is not positive";
    Err(Error::input(flag, &value.to_string(), rule, "give the position, then the mass in kg"))
}
