//! One type for every error of the library.

use core::fmt;

/// Any error of the library, for functions that meet several kinds: `?` makes it of each typed error.
///
/// It says what the typed error says, and [`downcast_ref`](Self::downcast_ref) gives that error back. An error of one's own becomes one
/// by [`new`](Self::new).
///
/// ```
/// use polhode::body::StateError;
/// use polhode::{Body, Inertia};
/// fn spin(moments: [f64; 3], omega: [f64; 3]) -> Result<f64, polhode::Error> {
///     let body = Body::free(Inertia::from_moments(moments)?);
///     Ok(body.energy(&body.state(Default::default(), omega.into())?))
/// }
/// assert_eq!(spin([1.0, 2.0, 3.0], [0.0, 1.0, 0.0])?, 1.0);
/// let error = spin([1.0, 2.0, 3.0], [0.0, f64::NAN, 0.0]).unwrap_err();
/// assert!(matches!(error.downcast_ref(), Some(StateError::NotFinite { .. })));
/// # Ok::<(), polhode::Error>(())
/// ```
pub struct Error(Box<dyn core::error::Error + Send + Sync>);

impl Error {
    /// The error `error`.
    pub fn new(error: impl core::error::Error + Send + Sync + 'static) -> Self {
        Error(Box::new(error))
    }

    /// The typed error, if it is an `E`.
    #[must_use]
    pub fn downcast_ref<E: core::error::Error + 'static>(&self) -> Option<&E> {
        self.0.downcast_ref()
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// As a program prints it that ends with the error.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl core::error::Error for Error {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        self.0.source()
    }
}

/// For what a body does not have, as `motion.tumbling().ok_or("it tumbles")?` says it.
impl From<&'static str> for Error {
    fn from(words: &'static str) -> Self {
        Error(words.into())
    }
}

macro_rules! from {
    ($($error:path),* $(,)?) => {$(
        impl From<$error> for Error {
            fn from(error: $error) -> Self {
                Error::new(error)
            }
        }
    )*};
}

from!(
    crate::advise::AdviseError,
    crate::audit::AuditError,
    crate::body::ForceError,
    crate::body::StateError,
    crate::body::WheelError,
    crate::events::EventError,
    crate::flow::AtRest,
    crate::flow::CovarianceError,
    crate::flow::DerivativeError,
    crate::flow::LagrangeError,
    crate::flow::NoClosedForm,
    crate::flow::ThroughError,
    crate::flow::TimeError,
    crate::flow::TumblingError,
    crate::inertia::MassDistributionError,
    crate::inertia::InertiaError,
    crate::inertia::MassError,
    crate::inertia::MeshError,
    crate::laws::LawsError,
    crate::laws::ReportError,
    crate::laws::UnknownWord,
    crate::method::AxisOrderError,
    crate::method::DmvOrderError,
    crate::method::GaussOrderError,
    crate::method::LossError,
    crate::method::PhaseError,
    crate::method::SchemeError,
    crate::method::StepError,
    crate::method::TaylorOrderError,
    crate::method::ToleranceError,
    crate::method::TwoAxesError,
    crate::method::UnknownMethod,
    crate::method::schemes::UnknownScheme,
    crate::num::DistributionError,
    crate::num::ParseDdError,
    crate::record::RecordError,
    crate::rotation::EulerSequenceError,
    crate::run::CheckpointError,
    crate::run::EnsembleError,
    crate::run::HalvingError,
    crate::run::MemberError,
    crate::run::RunError,
    crate::run::ScheduleError,
    crate::strapdown::FlightError,
    crate::strapdown::RuleError,
    crate::strapdown::StrapdownError,
    crate::strapdown::UnknownKind,
    crate::units::DateError,
    crate::units::ScaleError,
);
#[cfg(any(test, feature = "random"))]
from!(crate::body::NoMember, crate::flow::NoTumbler);
