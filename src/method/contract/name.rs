//! Methods by name, with argument and scheme.

use thiserror::Error;

use crate::method::phase::TAKEN_BACK;
use crate::method::schemes::{STRANG, SUZUKI_4, Scheme, UnknownScheme, scheme};
use crate::method::{
    AdaptiveTaylor, AnyMethod, AxisOrder, AxisSplit, Buss, Claimed, Composed, Dmv, DormandPrince853,
    Embedded, ExactFlow, ExactStep, ExplicitEuler, FreePart, Gauss, ImplicitMidpoint, LieGroup, LieNewmark,
    LinearlyImplicitEuler, Method, MomentumEuler, MujocoRk4, Pair, PhaseCorrected, PhaseError,
    PreprocessedDmv, ProjectedRk4, Richardson, Rk4, Rk8, SchemeError, SemiImplicitEuler, Splitting,
    Symmetric, SymmetricProjection, Taylor, Tsitouras54, TwoAxes, TwoTurn, VariationalCayley,
};
use crate::num::Dd;

/// The method called `name`: `base`, `base:argument`, `base@scheme` or `base:argument@scheme`, as in
/// `lie-poisson:321@kahan-li-8`, each with or without `+phase` behind it.
///
/// Bases are those of the [catalogue](super::catalogue()) and `linearly-implicit-euler`, schemes those of
/// [`schemes::ALL`](crate::method::schemes::ALL). `lie-poisson` takes an order of axes as its argument, `two-turn` its two axes,
/// `dmv` and `gauss` an order, `taylor` an order (a step is one series) or a tolerance, `dop853` and `tsit5` a tolerance;
/// `kick-drift:2` and `kick-drift:4` are other names of `kick-drift` and `kick-drift@suzuki-4`, `no-squish` one of
/// `lie-poisson:321`: that is the method of Miller et al., J. Chem. Phys. 116 (2002) 8649, which molecular dynamics programs
/// write in quaternions and their momenta. `+phase` corrects the [phase error](PhaseCorrected) at output.
///
/// # Errors
/// A base or a scheme that does not exist, an argument that the base does not take, a scheme that does not fit it, or a
/// phase error that cannot be corrected.
///
/// ```
/// use polhode::body::Problem;
/// use polhode::method::{Claimed, method};
/// assert_eq!(method("rattle")?.claims(Problem::Free).unwrap().order, Some(2));
/// assert_eq!(method("kick-drift@srkn-11b")?.claims(Problem::Linear).unwrap().order, Some(6));
/// assert!(method("rk5").is_err());
/// # Ok::<(), polhode::method::UnknownMethod>(())
/// ```
pub fn method(name: &str) -> Result<Box<dyn AnyMethod>, UnknownMethod> {
    if let Some(base) = name.strip_suffix(TAKEN_BACK) {
        // one call deeper, however often the suffix is written
        let bare = base.trim_end_matches(TAKEN_BACK);
        let corrected = PhaseCorrected::new(&*method(bare)?)?;
        if bare.len() < base.len() {
            return Err(PhaseError::TakenBack { method: format!("{bare}{TAKEN_BACK}") }.into());
        }
        return Ok(Box::new(corrected));
    }
    let (head, scheme) = split(name, '@');
    let (base, argument) = split(head, ':');
    let asked = Asked { name, argument, scheme };
    match base {
        "explicit-euler" => plain(ExplicitEuler, asked.scheme_alone()?),
        "semi-implicit-euler" => plain(SemiImplicitEuler, asked.scheme_alone()?),
        "rk4" => plain(Rk4 { normalized: false }, asked.scheme_alone()?),
        "rk4-normalized" => plain(Rk4 { normalized: true }, asked.scheme_alone()?),
        "implicit-midpoint" => composed(ImplicitMidpoint, asked.scheme_alone()?),
        "rattle" => kicked(Dmv, asked.scheme_alone()?),
        "dmv" => {
            let chosen = asked.scheme()?;
            let rule = "an even order from 4 to 20, such as dmv:10";
            let order = argument.and_then(|order| order.parse().ok());
            let order = order.and_then(|order| PreprocessedDmv::of_order(order).ok());
            kicked(order.ok_or_else(|| asked.refused(rule))?, chosen)
        }
        "lie-poisson" => {
            let chosen = asked.scheme()?;
            let axes = argument.map(str::parse::<AxisOrder>).transpose();
            let axes = axes.map_err(|_| asked.refused("a permutation of 123, such as lie-poisson:321"))?;
            kicked(AxisSplit { axes }, chosen)
        }
        "no-squish" => kicked(AxisSplit { axes: Some(AxisOrder::NO_SQUISH) }, asked.scheme_alone()?),
        "two-turn" => {
            let chosen = asked.scheme()?;
            let axes = argument.map(str::parse::<TwoAxes>).transpose();
            let rule = "two different axes of 123, the outer one first, such as two-turn:31";
            kicked(TwoTurn { axes: axes.map_err(|_| asked.refused(rule))? }, chosen)
        }
        "exact-step" => match asked.scheme_alone()? {
            None => Ok(Box::new(ExactStep)),
            Some(_) => Err(asked.refused("none, and no scheme: its steps are exact")),
        },
        "kick-drift" => match (argument, asked.scheme()?) {
            (None, chosen) => kicked(ExactFlow, chosen),
            (Some("2"), None) => kicked(ExactFlow, None),
            (Some("4"), None) => kicked(ExactFlow, Some(SUZUKI_4)),
            (Some(_), None) => Err(asked.refused("2 or 4, its order")),
            (Some(_), Some(_)) => Err(asked.refused("none beside a scheme")),
        },
        "gauss" => {
            let order = argument.and_then(|order| order.parse().ok());
            match (order.and_then(|order| Gauss::of_order(order).ok()), asked.scheme()?) {
                (Some(gauss), None) => Ok(Box::new(gauss)),
                _ => Err(asked.refused("an order 2, 4, 6 or 8, such as gauss:6, and no scheme")),
            }
        }
        "variational-cayley" => kicked(VariationalCayley, asked.scheme_alone()?),
        "rkmk4" => plain(LieGroup::RKMK_4, asked.scheme_alone()?),
        "commutator-free-4" => plain(LieGroup::COMMUTATOR_FREE_4, asked.scheme_alone()?),
        "crouch-grossman-3" => plain(LieGroup::CROUCH_GROSSMAN_3, asked.scheme_alone()?),
        "momentum-euler" => plain(MomentumEuler, asked.scheme_alone()?),
        "buss-2" => plain(Buss { augmented: false }, asked.scheme_alone()?),
        "buss-2-augmented" => plain(Buss { augmented: true }, asked.scheme_alone()?),
        "linearly-implicit-euler" => plain(LinearlyImplicitEuler, asked.scheme_alone()?),
        "mujoco-rk4" => plain(MujocoRk4, asked.scheme_alone()?),
        "lie-newmark" => match asked.scheme_alone()? {
            None => Ok(Box::new(LieNewmark)),
            Some(scheme) => {
                Err(SchemeError::Foretells { scheme: scheme.name, base: LieNewmark.name() }.into())
            }
        },
        "lie-poisson-projected" => {
            composed(SymmetricProjection::new(AxisSplit { axes: None }), asked.scheme_alone()?)
        }
        "rk4-projected" => plain(ProjectedRk4, asked.scheme_alone()?),
        "richardson" => plain(Richardson, asked.scheme_alone()?),
        "taylor" => {
            let chosen = asked.scheme()?;
            match argument {
                None => plain(AdaptiveTaylor::to_rounding(), chosen),
                Some(text) => {
                    let refused = || asked.refused(TAYLOR_RULE);
                    match (text.parse(), text.parse()) {
                        (Ok(order), _) => plain(Taylor::of_order(order).map_err(|_| refused())?, chosen),
                        (_, Ok(tolerance)) => {
                            plain(AdaptiveTaylor::of_tolerance(tolerance).map_err(|_| refused())?, chosen)
                        }
                        _ => Err(refused()),
                    }
                }
            }
        }
        "dop853" => pair::<DormandPrince853>(&asked),
        "tsit5" => pair::<Tsitouras54>(&asked),
        "rk8" => plain(Rk8, asked.scheme_alone()?),
        _ => Err(UnknownMethod::Name { name: name.into() }),
    }
}

fn pair<P: Pair>(asked: &Asked<'_>) -> Result<Box<dyn AnyMethod>, UnknownMethod> {
    let chosen = asked.scheme()?;
    let Some(text) = asked.argument else {
        return plain(Embedded::<P>::default(), chosen);
    };
    let refused =
        || asked.refused("a tolerance from 1e-15, some roundings of a double, to 1e-3, such as dop853:1e-12");
    let tolerance = text.parse().map_err(|_| refused())?;
    plain(Embedded::<P>::of_tolerance(tolerance).map_err(|_| refused())?, chosen)
}

const TAYLOR_RULE: &str = "an order from 8 to 40, such as taylor:20, or a tolerance from 1.2e-16, as the rounding of a double is \
                           1.1e-16, to 1e-3, such as taylor:1e-12";

/// The parts before and after the first `mark`.
fn split(text: &str, mark: char) -> (&str, Option<&str>) {
    text.split_once(mark).map_or((text, None), |(before, behind)| (before, Some(behind)))
}

/// The name of a method with its argument and scheme.
struct Asked<'a> {
    name: &'a str,
    argument: Option<&'a str>,
    scheme: Option<&'a str>,
}

impl Asked<'_> {
    fn scheme(&self) -> Result<Option<Scheme>, UnknownScheme> {
        Ok(self.scheme.map(scheme).transpose()?.copied())
    }

    /// The scheme, where the base takes no argument.
    fn scheme_alone(&self) -> Result<Option<Scheme>, UnknownMethod> {
        let chosen = self.scheme()?;
        match self.argument {
            Some(_) => Err(self.refused("none: this method takes no argument")),
            None => Ok(chosen),
        }
    }

    fn refused(&self, rule: &'static str) -> UnknownMethod {
        UnknownMethod::Argument { name: self.name.into(), rule }
    }
}

fn plain(
    method: impl AnyMethod + 'static,
    chosen: Option<Scheme>,
) -> Result<Box<dyn AnyMethod>, UnknownMethod> {
    match chosen {
        Some(scheme) => Err(SchemeError::NotSymmetric { scheme: scheme.name, base: method.name() }.into()),
        None => Ok(Box::new(method)),
    }
}

fn composed<M>(base: M, chosen: Option<Scheme>) -> Result<Box<dyn AnyMethod>, UnknownMethod>
where
    M: Symmetric + Claimed + Method<f64> + Method<Dd> + 'static,
{
    Ok(match chosen {
        Some(scheme) if scheme != STRANG => Box::new(Composed::new(base, scheme)?),
        _ => Box::new(base),
    })
}

fn kicked<A>(free: A, chosen: Option<Scheme>) -> Result<Box<dyn AnyMethod>, UnknownMethod>
where
    A: FreePart + Method<f64> + Method<Dd> + 'static,
{
    Ok(Box::new(Splitting::kicked(free, chosen.unwrap_or(STRANG))?))
}

/// Why a method could not be found.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum UnknownMethod {
    /// No such name.
    #[error("there is no method {name:?}")]
    Name {
        /// What was asked for.
        name: String,
    },
    /// The name is known, the argument is not.
    #[error("method {name:?} cannot take this argument; allowed: {rule}")]
    Argument {
        /// What was asked for.
        name: String,
        /// What would have been right.
        rule: &'static str,
    },
    /// No such scheme.
    #[error(transparent)]
    Scheme(#[from] UnknownScheme),
    /// The scheme does not fit the base.
    #[error(transparent)]
    Unfit(#[from] SchemeError),
    /// Energy or |m| are not kept: the phase error is not predicted.
    #[error(transparent)]
    Phase(#[from] PhaseError),
}
