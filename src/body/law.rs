//! The law of a force: a potential or a torque, in every scalar that evaluates it.

use std::sync::Arc;

use super::Time;
use crate::num::{Dd, Precise, Real, Series};
use crate::rotation::{Quat, Vec3};

/// A torque that comes from a potential energy U(t, q).
///
/// An implementation for every `S: Real` serves steps in `f64`, references in double-double and the
/// [power series](crate::num::Series) of [Taylor's method](crate::method::Taylor) alike; a closure in `f64` becomes one by
/// [`Force::potential_fn`](super::Force::potential_fn), without the series.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::{Body, Conserved, Force, Potential, Time};
/// use polhode::inertia::Inertia;
/// use polhode::num::Real;
/// use polhode::rotation::{Quat, Vec3};
///
/// /// A magnet along body z in a field along space x: U = −s x·R e_z.
/// struct Magnet(f64);
///
/// impl<S: Real> Potential<S> for Magnet {
///     fn energy(&self, _: Time, attitude: Quat<S>) -> S {
///         -(S::of(self.0) * attitude.rotate(Vec3::unit(2))[0])
///     }
///     fn torque(&self, _: Time, attitude: Quat<S>) -> Vec3<S> {
///         Vec3::unit(2).cross(attitude.rotate_back(Vec3::unit(0))) * S::of(self.0)
///     }
/// }
///
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 2.5])?).with(Force::potential("magnet", Magnet(0.5)));
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.0, 1.0, 0.0))?;
/// assert_eq!(body.energy(&start), 1.0); // 1 J of spin; the magnet lies across the field
/// # Ok::<(), polhode::Error>(())
/// ```
pub trait Potential<S: Real>: Send + Sync {
    /// Potential energy, J, at the time `at` and the attitude `attitude`, body → space. With methods that do not keep |q|
    /// the attitude is not exactly of norm 1.
    fn energy(&self, at: Time, attitude: Quat<S>) -> S;

    /// Torque, N m, body axes: −∂U/∂θ of a turn θ about the body axes.
    fn torque(&self, at: Time, attitude: Quat<S>) -> Vec3<S>;

    /// What motion in this potential alone conserves. The default is the energy: override it if U depends on `at`, or if
    /// L_z is conserved too.
    fn conserved(&self) -> Vec<Conserved> {
        vec![Conserved::Energy]
    }

    /// The moment c, N m, body axes, of a potential `U = c·Γ` that is linear in the vertical Γ = Qᵀ e_z, such as that of
    /// [uniform gravity](super::Force::gravity); `None`, the default, of all others. Where it is given, energy and torque must be
    /// those of c, and methods take them from it by the closed forms of a [linear potential](super::LinearPotential).
    fn linear_moment(&self) -> Option<Vec3<f64>> {
        None
    }
}

/// A torque of any kind, such as drag or a thruster's.
pub trait Torque<S: Real>: Send + Sync {
    /// Torque, N m, body axes, at the time `at`, the attitude `attitude`, body → space, and the angular velocity
    /// `omega_body`, rad/s, body axes.
    fn torque(&self, at: Time, attitude: Quat<S>, omega_body: Vec3<S>) -> Vec3<S>;
}

/// A quantity that a motion may conserve.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Conserved {
    /// Kinetic and potential energy, without that of the spin of wheels: [`Body::energy`](super::Body::energy).
    Energy,
    /// |L|, the length of the angular momentum of body and wheels.
    MomentumNorm,
    /// The angular momentum L in space, as a vector.
    Momentum,
    /// The component of L along z of space.
    MomentumZ,
    /// Jacobi's constant E − n L_z, of a potential that turns about z of space at the rate n.
    Jacobi {
        /// n, rad/s.
        rate: f64,
    },
}

/// A law in both precisions.
#[derive(Clone)]
pub(crate) enum Law {
    Potential(Arc<dyn PrecisePotential>),
    Torque(Arc<dyn PreciseTorque>),
}

/// A potential in both precisions.
pub(crate) trait PrecisePotential: Potential<f64> + Potential<Dd> {}
impl<P: Potential<f64> + Potential<Dd>> PrecisePotential for P {}

/// A torque in both precisions.
pub(crate) trait PreciseTorque: Torque<f64> + Torque<Dd> {}
impl<T: Torque<f64> + Torque<Dd>> PreciseTorque for T {}

/// A law on power series in both precisions.
#[derive(Clone)]
pub(crate) enum SeriesLaw {
    Potential(Arc<dyn SeriesPotential>),
    Torque(Arc<dyn SeriesTorque>),
}

pub(crate) trait SeriesPotential: Potential<Series<f64>> + Potential<Series<Dd>> {}
impl<P: Potential<Series<f64>> + Potential<Series<Dd>>> SeriesPotential for P {}

pub(crate) trait SeriesTorque: Torque<Series<f64>> + Torque<Series<Dd>> {}
impl<T: Torque<Series<f64>> + Torque<Series<Dd>>> SeriesTorque for T {}

/// The scalars in which every law can be evaluated.
pub(crate) trait Evaluated: Precise {
    fn torque(law: &Law, at: Time, attitude: Quat<Self>, omega_body: Vec3<Self>) -> Vec3<Self>;
    fn energy(law: &Law, at: Time, attitude: Quat<Self>) -> Self;
    fn series(
        law: &SeriesLaw,
        at: Time,
        attitude: Quat<Series<Self>>,
        omega_body: Vec3<Series<Self>>,
    ) -> Vec3<Series<Self>>;
}

macro_rules! evaluated {
    ($scalar:ty) => {
        impl Evaluated for $scalar {
            fn torque(law: &Law, at: Time, attitude: Quat<Self>, omega_body: Vec3<Self>) -> Vec3<Self> {
                match law {
                    Law::Potential(potential) => Potential::<Self>::torque(&**potential, at, attitude),
                    Law::Torque(torque) => Torque::<Self>::torque(&**torque, at, attitude, omega_body),
                }
            }
            fn energy(law: &Law, at: Time, attitude: Quat<Self>) -> Self {
                match law {
                    Law::Potential(potential) => Potential::<Self>::energy(&**potential, at, attitude),
                    Law::Torque(_) => Self::of(0.0),
                }
            }
            fn series(
                law: &SeriesLaw,
                at: Time,
                attitude: Quat<Series<Self>>,
                omega_body: Vec3<Series<Self>>,
            ) -> Vec3<Series<Self>> {
                match law {
                    SeriesLaw::Potential(potential) => {
                        Potential::<Series<Self>>::torque(&**potential, at, attitude)
                    }
                    SeriesLaw::Torque(torque) => {
                        Torque::<Series<Self>>::torque(&**torque, at, attitude, omega_body)
                    }
                }
            }
        }
    };
}
evaluated!(f64);
evaluated!(Dd);
