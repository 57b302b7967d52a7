//! Methods by name: the dynamic outside of the static inside.

use thiserror::Error;

use super::{
    Advance, AxisOrder, Claimed, Composed, ExplicitEuler, ImplicitMidpoint, KickDrift, LiePoisson, Method,
    Rattle, Rk4, SUZUKI_4, SemiImplicitEuler, Step, StepError,
};
use crate::body::{Body, State};
use crate::num::Dd;

/// A method whose type is known only at run time.
pub trait AnyMethod: Claimed + Send + Sync {
    /// As [`Method::prepare`], in `f64`.
    ///
    /// # Errors
    /// As [`Method::prepare`].
    fn prepare_f64(&self, h: f64, body: &Body, x: &State<f64>) -> Result<Box<dyn Advance>, StepError>;

    /// As [`Method::prepare`], in double-double, for measuring below the rounding of `f64`.
    ///
    /// # Errors
    /// As [`Method::prepare`].
    fn prepare_dd(&self, h: f64, body: &Body, x: &State<Dd>) -> Result<Box<dyn Step<Dd>>, StepError>;
}

impl<M: Method<f64> + Method<Dd> + Send + Sync> AnyMethod for M {
    fn prepare_f64(&self, h: f64, body: &Body, x: &State<f64>) -> Result<Box<dyn Advance>, StepError> {
        accepts(self, body)?;
        Ok(Box::new(self.prepare(h, body, x)?))
    }
    fn prepare_dd(&self, h: f64, body: &Body, x: &State<Dd>) -> Result<Box<dyn Step<Dd>>, StepError> {
        accepts(self, body)?;
        Ok(Box::new(self.prepare(h, body, x)?))
    }
}

/// Refuses a heavy body for a method without torque.
fn accepts(method: &impl Claimed, body: &Body) -> Result<(), StepError> {
    if body.gravity::<f64>().is_some() && method.claims().potential.is_none() {
        return Err(StepError::Torque { method: method.name() });
    }
    Ok(())
}

/// Every method, in the order in which tables show them.
pub fn catalogue() -> Vec<Box<dyn AnyMethod>> {
    vec![
        Box::new(ExplicitEuler),
        Box::new(SemiImplicitEuler),
        Box::new(Rk4 { normalized: false }),
        Box::new(Rk4 { normalized: true }),
        Box::new(ImplicitMidpoint),
        Box::new(Rattle),
        Box::new(LiePoisson { axes: None }),
        Box::new(KickDrift),
        Box::new(Composed { base: KickDrift, scheme: SUZUKI_4 }),
    ]
}

/// The method called `name`, an entry of the catalogue or one with an argument, as `lie-poisson:321`.
///
/// # Errors
/// A name that the catalogue does not have, or an argument that the method does not take.
///
/// ```
/// use polhode::method::method;
/// assert_eq!(method("rattle")?.claims().order, 2);
/// assert!(method("rk5").is_err());
/// # Ok::<(), polhode::method::UnknownMethod>(())
/// ```
pub fn method(name: &str) -> Result<Box<dyn AnyMethod>, UnknownMethod> {
    if let Some(axes) = name.strip_prefix("lie-poisson:") {
        let order: AxisOrder = axes.parse().map_err(|_| UnknownMethod::Argument {
            name: name.into(),
            rule: "a permutation of 123, such as lie-poisson:321",
        })?;
        return Ok(Box::new(LiePoisson { axes: Some(order) }));
    }
    let name = if name == "kick-drift:2" { "kick-drift" } else { name };
    let mut known = catalogue();
    if let Some(position) = known.iter().position(|method| method.name() == name) {
        return Ok(known.swap_remove(position));
    }
    if let Some((head, _)) = name.split_once(':')
        && known.iter().any(|method| method.name() == head)
    {
        return Err(UnknownMethod::Argument {
            name: name.into(),
            rule: if head == "kick-drift" {
                "2 or 4, its order"
            } else {
                "none: this method takes no argument"
            },
        });
    }
    Err(UnknownMethod::Name { name: name.into() })
}

/// Why a method could not be found.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum UnknownMethod {
    /// No such name.
    #[error("there is no method {name:?}")]
    Name {
        /// What was asked for.
        name: String,
    },
    /// The name is known, the argument is not.
    #[error("method {name:?} has an argument that it cannot take; allowed: {rule}")]
    Argument {
        /// What was asked for.
        name: String,
        /// What would have been right.
        rule: &'static str,
    },
}
