//! The classical Runge–Kutta method, `rk4` and `rk4-normalized`.

use crate::body::{Field, Instant, Phase, Point, Problem, Rotor, Time};
use crate::method::contract::lanes::Kernel;
use crate::method::runge_kutta::claims;
use crate::method::{Claimed, Claims, Map, Method, SideBySide};
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

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
    /// Half a step and a whole one, s.
    later: [Dd; 2],
    step: Rk4Step<S>,
    scaled: Scaled<S>,
    field: F,
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
        let inverse = rotor.inverse_moments::<Dd>();
        Rk4Map {
            later: [h * 0.5, h],
            step: Rk4Step::new(rotor, h),
            scaled: Scaled {
                torque: inverse.map(|inverse| S::from_dd(inverse * h * h * 0.125)),
                rate: S::from_dd(Dd::of(4.0) / h),
            },
            field: field.clone(),
            normalized: self.normalized,
        }
    }
}

impl<S: Real, F: Field<S>> Map<S> for Rk4Map<S, F> {
    #[inline(always)]
    fn apply(&mut self, at: Time, point: &mut Point<S>) {
        let x = point.phase();
        let mut x = if F::ACTS {
            let [middle, end] = self.later.map(|duration| at.later(duration));
            self.step.forced([at, middle, end], &self.field, &self.scaled, x)
        } else {
            self.step.free(x)
        };
        if self.normalized {
            x.attitude = x.attitude.normalized();
        }
        point.set_phase(x);
    }

    fn side_by_side(&self) -> Option<SideBySide<S>> {
        let free = self.step.constants.iter().copied();
        Some(if F::ACTS {
            let Scaled { torque: Vec3(torque), rate } = self.scaled;
            SideBySide::new(Kernel::Rk4(self.normalized), free.chain(torque).chain([rate]).collect())
        } else {
            SideBySide::new(Kernel::FreeRk4(self.normalized), free.collect())
        })
    }
}

/// The step in p = (h/4) I⁻¹m, and h/2 as the unit of time.
///
/// Then `q' = q ∘ p` and `p_i' = D_i p_j p_k`, (i, j, k) cyclic, `D_i = 2 (I_j − I_k)/I_i`: no length of a step and no moment is
/// left in a stage. The momentum itself is kept, and moved by what p moves.
#[derive(Clone, Copy, Debug)]
pub(in crate::method) struct Rk4Step<S> {
    /// p over m, D, and a third of m over p, per axis.
    constants: [S; RK4_CONSTANTS],
}

pub(in crate::method) const RK4_CONSTANTS: usize = 9;

/// What takes forces into these variables.
#[derive(Clone, Copy, Debug)]
struct Scaled<S> {
    /// p' over the torque, h²/8 I⁻¹.
    torque: Vec3<S>,
    /// Angular velocity over p, 4/h.
    rate: S,
}

impl<S: Real> Rk4Step<S> {
    fn new(rotor: &Rotor, h: Dd) -> Self {
        let i = rotor.moments::<Dd>();
        let quarter = h * 0.25;
        let ([a, b, c], [u, v, w]) = (i.map(|i| quarter / i).0, i.map(|i| i / (quarter * 3.0)).0);
        let [d, e, f] = [(0, 1, 2), (1, 2, 0), (2, 0, 1)].map(|(k, l, m)| (i[l] - i[m]) / i[k] * 2.0);
        Rk4Step { constants: [a, b, c, d, e, f, u, v, w].map(S::from_dd) }
    }

    #[inline(always)]
    pub(in crate::method) fn of(constants: [S; RK4_CONSTANTS]) -> Self {
        Rk4Step { constants }
    }

    /// p of the momentum `m`.
    #[inline(always)]
    pub(in crate::method) fn scaled(&self, m: Vec3<S>) -> Vec3<S> {
        let [a, b, c, ..] = self.constants;
        m.times(Vec3([a, b, c]))
    }

    /// `D_i p_j r_k`.
    #[inline(always)]
    fn gyroscopic(&self, p: Vec3<S>, r: Vec3<S>) -> Vec3<S> {
        let [_, _, _, d, e, f, ..] = self.constants;
        Vec3([d, e, f]).times(Vec3([p[1] * r[2], p[2] * r[0], p[0] * r[1]]))
    }

    /// `x` moved by `q`, and by a third of `p`.
    #[inline(always)]
    pub(in crate::method) fn moved(&self, x: Phase<S>, q: Quat<S>, p: Vec3<S>) -> Phase<S> {
        let [.., u, v, w] = self.constants;
        Phase { attitude: x.attitude + q, momentum_body: x.momentum_body + p.times(Vec3([u, v, w])) }
    }

    /// A step without torque. p does not depend on q then, and q' is linear in it: the stages of q are q times quaternions that are
    /// made of those of p. So a step waits for no more of the step before than its momentum.
    #[inline(always)]
    pub(in crate::method) fn free(&self, x: Phase<S>) -> Phase<S> {
        let p = self.scaled(x.momentum_body);
        let l1 = self.gyroscopic(p, p);
        let p2 = p + l1;
        let l2 = self.gyroscopic(p2, p2);
        let p3 = p + l2;
        let twice_p3 = p3 + p3;
        let twice_l3 = self.gyroscopic(twice_p3, p3);
        let p4 = p + twice_l3;
        let l4 = self.gyroscopic(p4, p4);
        let l = (l1 + l4) + (twice_l3 + (l2 + l2));

        let and_one = |k: Quat<S>| Quat { w: S::of(1.0) + k.w, v: k.v };
        let k2 = Quat { w: -p.dot(p2), v: p2 + p.cross(p2) };
        let twice_k3 = by(and_one(k2), twice_p3);
        let k4 = by(and_one(twice_k3), p4);
        let k = (k4 + twice_k3) + (k2 + k2);
        let k = Quat { w: k.w, v: k.v + p } * third::<S>();
        self.moved(x, x.attitude * k, l)
    }

    /// A step that begins at the first of the times, has its middle at the second and ends at the third.
    #[inline(always)]
    fn forced<F: Field<S>>(
        &self,
        [begin, middle, end]: [Time; 3],
        field: &F,
        scaled: &Scaled<S>,
        x: Phase<S>,
    ) -> Phase<S> {
        // all before the first of them is needed: they do not wait for each other
        let (begin, middle, end) = (field.instant(begin), field.instant(middle), field.instant(end));
        let (q, p) = (x.attitude, self.scaled(x.momentum_body));
        let (k1, l1) = self.rate(&begin, field, scaled, q, p);
        let (k2, l2) = self.rate(&middle, field, scaled, q + k1, p + l1);
        let (k3, l3) = self.rate(&middle, field, scaled, q + k2, p + l2);
        let (k3, l3) = (k3 + k3, l3 + l3);
        let (k4, l4) = self.rate(&end, field, scaled, q + k3, p + l3);
        let (k, l) = ((k1 + k4) + (k3 + (k2 + k2)), (l1 + l4) + (l3 + (l2 + l2)));
        self.moved(x, k * third::<S>(), l)
    }

    /// q' and p'.
    #[inline(always)]
    fn rate<F: Field<S>>(
        &self,
        at: &Instant<S>,
        field: &F,
        scaled: &Scaled<S>,
        q: Quat<S>,
        p: Vec3<S>,
    ) -> (Quat<S>, Vec3<S>) {
        let (attitude, turned) = self.free_rate(q, p);
        (attitude, turned + field.torque_at(at, q, p * scaled.rate).times(scaled.torque))
    }

    /// The same without forces.
    #[inline(always)]
    pub(in crate::method) fn free_rate(&self, q: Quat<S>, p: Vec3<S>) -> (Quat<S>, Vec3<S>) {
        (by(q, p), self.gyroscopic(p, p))
    }
}

/// `q ∘ (0, p)`.
#[inline(always)]
fn by<S: Real>(q: Quat<S>, p: Vec3<S>) -> Quat<S> {
    Quat { w: -q.v.dot(p), v: p * q.w + q.v.cross(p) }
}

#[inline(always)]
pub(in crate::method) fn third<S: Real>() -> S {
    S::of(1.0) / S::of(3.0)
}
