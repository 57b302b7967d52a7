//! The flags that name a body and its start, for every command that takes them.

use clap::Args;
use nalgebra::Matrix3;
use polhode::body::{Body, Point};
use polhode::catalogue;
use polhode::inertia::Inertia;
use polhode::num::Dd;
use polhode::rotation::{Quat, Vec3};

use crate::arguments::{numbers, quaternion};
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
            let found = catalogue::body(name)
                .or_else(|| catalogue::top(name))
                .ok_or_else(|| Error::unknown_name("--body", "body", name, known.iter().copied()))?;
            Ok((found.inertia, found.weight_moment))
        }
    }
}

/// Angular velocity and attitude at the start.
#[derive(Args, Clone, Debug)]
pub(crate) struct StartArguments {
    /// Angular velocity at the start, body axes, rad/s
    #[arg(long, value_name = "wx,wy,wz", value_parser = numbers::<3>, allow_hyphen_values = true)]
    omega: [f64; 3],
    /// Attitude at the start: quaternion from body to space axes, scalar first, of any norm but zero
    #[arg(long, value_name = "w,x,y,z", value_parser = quaternion, allow_hyphen_values = true, default_value = "1,0,0,0")]
    attitude: [f64; 4],
}

impl StartArguments {
    /// The exact start of `body` in the solver frame.
    pub(crate) fn inside(&self, body: &Body) -> Result<Point<Dd>, Error> {
        let start = body.enter_omega(Quat::from_components(self.attitude), Vec3(self.omega));
        start.map_err(|error| Error::Input(format!("--omega: {error}")))
    }
}
