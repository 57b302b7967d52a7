//! Explicit methods on (q, m): the yardsticks that people run today.
//!
//! The right-hand side is Euler's equation and the kinematic one, `m' = m × I⁻¹m + τ(t, q, ω)`, `q' = ½ q ∘ (0, I⁻¹m)`.

use super::lanes::Kernel;
use super::{Claimed, Claims, Cost, Kept, Map, Method, SideBySide};
use crate::body::{Field, Phase, Point, Problem, Rotor, Time};
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

/// What an explicit method on (q, m) claims of every motion: nothing kept but, with `norm`, |q|.
fn claims(order: u32, norm: bool, right_sides: u32, source: &'static str) -> Option<Claims> {
    Some(Claims::new(Some(order), Kept { norm, ..Kept::NOTHING }, Cost::right_sides(right_sides), source))
}

/// The right-hand side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Equations<S, F> {
    inverse_moments: Vec3<S>,
    field: F,
}

impl<S: Real, F: Field<S>> Equations<S, F> {
    pub(super) fn new(rotor: &Rotor, field: &F) -> Self {
        Self::of(rotor.inverse_moments(), field.clone())
    }

    #[inline(always)]
    pub(super) fn of(inverse_moments: Vec3<S>, field: F) -> Self {
        Equations { inverse_moments, field }
    }

    /// q' and m'.
    #[inline]
    pub(super) fn rate(&self, at: Time, x: &Phase<S>) -> Phase<S> {
        let omega = x.momentum_body.times(self.inverse_moments);
        Phase { attitude: x.attitude.rate(omega), momentum_body: self.momentum_rate(at, x, omega) }
    }

    /// m × ω + τ.
    #[inline]
    fn momentum_rate(&self, at: Time, x: &Phase<S>, omega: Vec3<S>) -> Vec3<S> {
        let rate = x.momentum_body.cross(omega);
        if F::ACTS { rate + self.field.torque(at, x.attitude, omega) } else { rate }
    }
}

/// The classical Runge–Kutta method of order 4.
///
/// Φ_h: `x + h/6 (k₁ + 2k₂ + 2k₃ + k₄)`. Keeps nothing: energy falls ∝ h⁵ t, |q| too unless `normalized`.
///
/// ```
/// use polhode::body::Problem;
/// use polhode::method::{Claimed, Energy, Rk4};
/// let claims = Rk4 { normalized: true }.claims(Problem::Torque).unwrap();
/// assert_eq!((claims.order, claims.kept.norm), (Some(4), true));
/// assert_eq!(claims.kept.energy, Energy::Drifts);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rk4 {
    /// Divide q by its norm after every step.
    pub normalized: bool,
}

/// A prepared [`Rk4`].
#[derive(Clone, Debug)]
pub struct Rk4Map<S, F> {
    h: S,
    /// Half a step and a whole one, s.
    later: [Dd; 2],
    equations: Equations<S, F>,
    free: FreeRk4<S>,
    normalized: bool,
}

impl Claimed for Rk4 {
    fn name(&self) -> String {
        if self.normalized { "rk4-normalized" } else { "rk4" }.into()
    }
    fn claims(&self, _: Problem) -> Option<Claims> {
        claims(4, self.normalized, 4, "Kutta 1901; Hairer, Norsett and Wanner, Solving ODEs I, table II.1.2")
    }
}

impl<S: Real> Method<S> for Rk4 {
    type Map<F: Field<S>> = Rk4Map<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> Rk4Map<S, F> {
        Rk4Map {
            h: S::from_dd(h),
            later: [h * 0.5, h],
            equations: Equations::new(rotor, field),
            free: FreeRk4::new(S::from_dd(h), rotor.inverse_moments()),
            normalized: self.normalized,
        }
    }
}

impl<S: Real, F: Field<S>> Map<S> for Rk4Map<S, F> {
    #[inline]
    fn apply(&mut self, at: Time, point: &mut Point<S>) {
        let x = point.phase();
        point.set_phase(match (F::ACTS, self.normalized) {
            (false, true) => self.free.step::<true>(x),
            (false, false) => self.free.step::<false>(x),
            (true, normalized) => {
                let [middle, end] = self.later.map(|duration| at.later(duration));
                let mut x = rk4_step(self.h, [at, middle, end], &self.equations, x);
                if normalized {
                    x.attitude = x.attitude.normalized();
                }
                x
            }
        });
    }

    fn side_by_side(&self) -> Option<SideBySide<S>> {
        let kernel = Kernel::Rk4(self.normalized);
        (!F::ACTS).then(|| SideBySide { kernel, constants: self.free.constants.to_vec() })
    }
}

/// One step of `h` between the first and the last of `times`, with its middle between them.
#[inline(always)]
fn rk4_step<S: Real, F: Field<S>>(
    h: S,
    [begin, middle, end]: [Time; 3],
    equations: &Equations<S, F>,
    x: Phase<S>,
) -> Phase<S> {
    let (half, two) = (h * S::of(0.5), S::of(2.0));
    let k1 = equations.rate(begin, &x);
    let k2 = equations.rate(middle, &(x + k1 * half));
    let k3 = equations.rate(middle, &(x + k2 * half));
    let k4 = equations.rate(end, &(x + k3 * h));
    x + (k1 + (k2 + k3) * two + k4) * (h / S::of(6.0))
}

/// The same step without torque, by an eighth fewer operations and with the same bits.
///
/// What differs are powers of two. The outer stages have reciprocal moments of half their size, so that k₁ and k₄ come out as
/// halves and k₂ + k₃ need not be doubled; the half of `q' = ½ q ∘ ω` stands in the lengths of the steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct FreeRk4<S> {
    constants: [S; FREE_CONSTANTS],
}

/// A whole, half and quarter of the step, a third and a sixth, the reciprocal moments and their halves.
pub(super) const FREE_CONSTANTS: usize = 11;

impl<S: Real> FreeRk4<S> {
    fn new(h: S, inverse_moments: Vec3<S>) -> Self {
        let (half, sixth) = (S::of(0.5), h / S::of(6.0));
        let (Vec3([a, b, c]), Vec3([d, e, f])) = (inverse_moments, inverse_moments * half);
        FreeRk4 { constants: [h, h * half, h * half * half, sixth + sixth, sixth, a, b, c, d, e, f] }
    }

    #[inline(always)]
    pub(super) fn of(constants: [S; FREE_CONSTANTS]) -> Self {
        FreeRk4 { constants }
    }

    #[inline(always)]
    pub(super) fn step<const NORMALIZED: bool>(&self, x: Phase<S>) -> Phase<S> {
        let [h, half, quarter, third, sixth, inverse @ ..] = self.constants;
        let [a, b, c, d, e, f] = inverse;
        let (inner, outer) = (Vec3([a, b, c]), Vec3([d, e, f]));
        let k1 = free_rate(&x, outer);
        let k2 = free_rate(&moved(&x, &k1, [half, h]), inner);
        let k3 = free_rate(&moved(&x, &k2, [quarter, half]), inner);
        let k4 = free_rate(&moved(&x, &k3, [half, h]), outer);
        let mut x = moved(&x, &(k1 + (k2 + k3) + k4), [sixth, third]);
        if NORMALIZED {
            x.attitude = x.attitude.normalized();
        }
        x
    }
}

/// `q ∘ (0, ω)` and `m × ω` with ω = m by the reciprocal moments.
#[inline(always)]
fn free_rate<S: Real>(x: &Phase<S>, inverse_moments: Vec3<S>) -> Phase<S> {
    let omega = x.momentum_body.times(inverse_moments);
    let q = x.attitude;
    let attitude = Quat { w: -q.v.dot(omega), v: omega * q.w + q.v.cross(omega) };
    Phase { attitude, momentum_body: x.momentum_body.cross(omega) }
}

/// `x` with `k` times one length added to the attitude, times another to the momentum.
#[inline(always)]
fn moved<S: Real>(x: &Phase<S>, k: &Phase<S>, [attitude, momentum]: [S; 2]) -> Phase<S> {
    Phase {
        attitude: x.attitude + k.attitude * attitude,
        momentum_body: x.momentum_body + k.momentum_body * momentum,
    }
}

/// Explicit Euler: `x + h k₁`. Spirals outwards at every step.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::{Body, Conserved};
/// use polhode::inertia::Inertia;
/// use polhode::method::ExplicitEuler;
/// use polhode::run::Run;
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let end = Run::new(&ExplicitEuler, &body, &start, 0.1)?.advance_to(100)?;
/// assert!(end.worst.of(Conserved::Energy).is_some_and(|error| error > 0.1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExplicitEuler;

/// A prepared [`ExplicitEuler`].
#[derive(Clone, Debug)]
pub struct ExplicitEulerMap<S, F> {
    h: S,
    equations: Equations<S, F>,
}

impl Claimed for ExplicitEuler {
    fn name(&self) -> String {
        "explicit-euler".into()
    }
    fn claims(&self, _: Problem) -> Option<Claims> {
        claims(1, false, 1, "Euler 1768; Hairer, Norsett and Wanner, Solving ODEs I, (I.7.3)")
    }
}

impl<S: Real> Method<S> for ExplicitEuler {
    type Map<F: Field<S>> = ExplicitEulerMap<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> ExplicitEulerMap<S, F> {
        ExplicitEulerMap { h: S::from_dd(h), equations: Equations::new(rotor, field) }
    }
}

impl<S: Real, F: Field<S>> Map<S> for ExplicitEulerMap<S, F> {
    #[inline]
    fn apply(&mut self, at: Time, point: &mut Point<S>) {
        let x = point.phase();
        point.set_phase(x + self.equations.rate(at, &x) * self.h);
    }
}

/// Semi-implicit Euler as game engines write it: `m' = m + h (m × ω + τ)`, then `q' = norm(q + h/2 q ω')`.
///
/// ```
/// use polhode::body::Problem;
/// use polhode::method::{Claimed, SemiImplicitEuler};
/// let claims = SemiImplicitEuler.claims(Problem::Free).unwrap();
/// assert_eq!((claims.order, claims.symmetric, claims.kept.momentum_norm), (Some(1), false, false));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SemiImplicitEuler;

/// A prepared [`SemiImplicitEuler`].
#[derive(Clone, Debug)]
pub struct SemiImplicitEulerMap<S, F> {
    h: S,
    equations: Equations<S, F>,
}

impl Claimed for SemiImplicitEuler {
    fn name(&self) -> String {
        "semi-implicit-euler".into()
    }
    fn claims(&self, _: Problem) -> Option<Claims> {
        claims(1, true, 1, "common in game engines; momentum first, attitude with the new one")
    }
}

impl<S: Real> Method<S> for SemiImplicitEuler {
    type Map<F: Field<S>> = SemiImplicitEulerMap<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> SemiImplicitEulerMap<S, F> {
        SemiImplicitEulerMap { h: S::from_dd(h), equations: Equations::new(rotor, field) }
    }
}

impl<S: Real, F: Field<S>> Map<S> for SemiImplicitEulerMap<S, F> {
    #[inline]
    fn apply(&mut self, at: Time, point: &mut Point<S>) {
        let inverse = self.equations.inverse_moments;
        let mut x = point.phase();
        let omega = x.momentum_body.times(inverse);
        x.momentum_body = x.momentum_body + self.equations.momentum_rate(at, &x, omega) * self.h;
        let omega = x.momentum_body.times(inverse);
        x.attitude = (x.attitude + x.attitude.rate(omega) * self.h).normalized();
        point.set_phase(x);
    }
}
