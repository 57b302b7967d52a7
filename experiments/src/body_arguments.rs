//! The flags that name a body, for every command that takes them.

use clap::Args;
use nalgebra::Matrix3;
use polhode::body::Body;
use polhode::catalogue::{self, NamedBody};
use polhode::inertia::Inertia;

use crate::arguments::numbers;
use crate::error::Error;

/// A body: exactly one of three flags.
#[derive(Args, Clone, Debug)]
#[group(required = true, multiple = false)]
pub(crate) struct BodyArguments {
    /// Principal moments in the order of the body axes, in any consistent unit
    #[arg(long, value_name = "I1,I2,I3", value_parser = numbers::<3>, allow_hyphen_values = true)]
    moments: Option<[f64; 3]>,
    /// Tensor entries in body axes, I_xy = -sum m x y
    #[arg(long, value_name = "Ixx,Iyy,Izz,Ixy,Ixz,Iyz", value_parser = numbers::<6>, allow_hyphen_values = true)]
    inertia: Option<[f64; 6]>,
    /// Body of the catalogue: toutatis, racket, t-handle, phone, water, spacecraft, textbook, dyadic, prolate, oblate, sphere; or a top with its weight moment: gyroscope, bicycle-wheel, simo-wong, bruls-cardona
    #[arg(long, value_name = "NAME")]
    body: Option<String>,
}

impl BodyArguments {
    /// The body that the flags describe, with the catalogue's weight moment or `weight_moment` in its place.
    pub(crate) fn heavy(&self, weight_moment: Option<[f64; 3]>) -> Result<Body, Error> {
        let (inertia, own) = self.described()?;
        let moment = weight_moment.unwrap_or(own);
        if moment == [0.0; 3] {
            return Ok(Body::free(inertia));
        }
        Body::heavy(inertia, moment.into()).map_err(|error| Error::Input(format!("--weight-moment: {error}")))
    }

    /// The same for what only free bodies do.
    pub(crate) fn free(&self) -> Result<Body, Error> {
        let (inertia, own) = self.described()?;
        if own != [0.0; 3] {
            let name = self.body.as_deref().unwrap_or_default();
            return Err(Error::input(
                "--body",
                name,
                "is a top under gravity, and this command is for free bodies",
                "name a free body, or give its --moments to leave the weight out",
            ));
        }
        Ok(Body::free(inertia))
    }

    /// The spin and attitude of a body of the catalogue.
    pub(crate) fn published_start(&self) -> Option<PublishedStart> {
        self.named().map(|body| PublishedStart { omega: body.omega_body, attitude: body.attitude })
    }

    /// The body of the catalogue that is named.
    fn named(&self) -> Option<NamedBody> {
        let name = self.body.as_deref()?;
        catalogue::body(name).or_else(|| catalogue::top(name))
    }

    /// Inertia, and the weight moment that the catalogue has with it.
    fn described(&self) -> Result<(Inertia, [f64; 3]), Error> {
        let refused =
            |flag: &str, error: polhode::inertia::InertiaError| Error::Input(format!("{flag}: {error}"));
        if let Some(moments) = self.moments {
            Ok((Inertia::from_moments(moments).map_err(|error| refused("--moments", error))?, [0.0; 3]))
        } else if let Some([xx, yy, zz, xy, xz, yz]) = self.inertia {
            let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
            Ok((Inertia::from_tensor(tensor).map_err(|error| refused("--inertia", error))?, [0.0; 3]))
        } else {
            let name = self.body.as_deref().unwrap_or_default();
            let known: Vec<&str> =
                catalogue::bodies().iter().chain(&catalogue::tops()).map(|body| body.name).collect();
            let found = self
                .named()
                .ok_or_else(|| Error::unknown_name("--body", "body", name, known.iter().copied()))?;
            Ok((found.inertia, found.weight_moment))
        }
    }
}

/// The start that a body is published with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PublishedStart {
    /// Body axes, rad/s.
    pub(crate) omega: [f64; 3],
    pub(crate) attitude: [f64; 4],
}
