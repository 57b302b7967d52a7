//! `two-turn`: two turns and a turn about L: the splitting of the kinetic energy modulo |m|².

use core::fmt;
use core::str::FromStr;

use thiserror::Error;

use super::schemes::{Pairs, STRANG, Scheme, Stages};
use super::{Cost, Energy, FreePart, Map, Method, SideBySide, Symmetric, WheelSplit};
use crate::body::{Clock, Field, Point, Rotor, Time};
use crate::flow::{Casimir, Flow};
use crate::method::contract::lanes::LaneFlow;
use crate::method::solve::modified_energy::{ModifiedEnergy, Orbit, PhaseErrorRates, of_least_error};
use crate::method::solve::turns::Turns;
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// Strang splitting of the kinetic energy less that of a ball, by two axes.
///
/// With a reference axis j, `T = |m|²/(2I_j) + ½(1/I_o − 1/I_j) m_o² + ½(1/I_i − 1/I_j) m_i²`. |m|² commutes with every
/// function of m and turns the body about L only, so two turns remain:
/// Φ_h = C(h) R_o(h/2) R_i(h) R_o(h/2), R the exact turns about an axis, C the [turn about L](Casimir).
/// In free motion neighbouring turns about o are one, and C is taken at output alone, in double-double. Keeps |m|, L and
/// the Lie–Poisson bracket, the energy within O(h²) for exponentially long times.
///
/// The two turns are two flows: a scheme for any two flows makes of them a splitting of free motion of its order, such as
/// `two-turn@blanes-moan-s10`. With forces there are compositions only.
///
/// Reference: Fassò, J. Comput. Phys. 189 (2003) 527, compares the energy errors of such splittings.
///
/// ```
/// use polhode::method::{Claimed, Kicks, Splitting, TwoTurn};
/// let outer_z = TwoTurn { axes: Some("31".parse()?) };
/// assert_eq!(Splitting::strang(outer_z, Kicks).name(), "two-turn:31");
/// # Ok::<(), polhode::method::TwoAxesError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TwoTurn {
    /// Outer and inner axis; `None` takes those with the smallest leading error of the attitude as a root mean square over all starts of
    /// the orbit, and under forces and in compositions, where the orbit is not that of these turns, those that are usual for the
    /// moments.
    pub axes: Option<TwoAxes>,
}

/// The axes of the two turns, the outer one first: `31` is Φ = C(h) R3(h/2) R1(h) R3(h/2).
///
/// ```
/// use polhode::method::TwoAxes;
/// let axes: TwoAxes = "31".parse()?;
/// assert_eq!((axes.axes(), axes.reference()), ([2, 0], 1));
/// # Ok::<(), polhode::method::TwoAxesError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TwoAxes([usize; 2]);

impl TwoAxes {
    /// All six pairs.
    pub const ALL: [TwoAxes; 6] = [
        TwoAxes([0, 1]),
        TwoAxes([0, 2]),
        TwoAxes([1, 0]),
        TwoAxes([1, 2]),
        TwoAxes([2, 0]),
        TwoAxes([2, 1]),
    ];

    /// Outer and inner axis, from 0.
    pub fn axes(self) -> [usize; 2] {
        self.0
    }

    /// The axis that neither turns about.
    pub fn reference(self) -> usize {
        3 - self.0[0] - self.0[1]
    }

    /// Those whose leading error of the attitude is smallest on the orbit of free motion through the momentum `m`, as a root
    /// mean square over all starts on it: so they are the same wherever on the orbit a run begins.
    pub fn best(m: Vec3<f64>, moments: Vec3<f64>) -> Self {
        let candidates = Self::ALL.map(|axes| (axes, axes.leading_term(moments)));
        of_least_error(candidates, m, moments).unwrap_or_else(|| Self::usual(moments))
    }

    /// H₃ at the momentum `m`: the splitting keeps H + h² H₃ up to O(h⁴), for the same unit of moments and momentum.
    pub fn modified_energy(self, m: Vec3<f64>, moments: Vec3<f64>) -> f64 {
        self.leading_term(moments).at(m)
    }

    /// Root mean square of the rate at which the attitude of free motion runs away on the orbit through the momentum `m`, over
    /// h²: rad/s³. `None` for pure spins, spheres and next to the separatrix.
    pub fn attitude_error_rate(self, m: Vec3<f64>, moments: Vec3<f64>) -> Option<f64> {
        Some(self.leading_term(moments).attitude_error_rate(&Orbit::through(m, moments)?))
    }

    /// The shift in time along the polhode and the twist about L that this error is made of, for a run that begins at the
    /// momentum `m`. `None` where [`attitude_error_rate`](Self::attitude_error_rate) is.
    pub fn phase_error_rates(self, m: Vec3<f64>, moments: Vec3<f64>) -> Option<PhaseErrorRates> {
        Some(self.leading_term(moments).phase_error_rates(&Orbit::through(m, moments)?))
    }

    /// Where no orbit is known: the reference is the middle axis, and the axis with the larger coefficient is outside.
    fn usual(moments: Vec3<f64>) -> Self {
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
        let [small, middle, large] = order;
        let coefficient = |k: usize| (1.0 / moments[k] - 1.0 / moments[middle]).abs();
        if coefficient(small) >= coefficient(large) {
            TwoAxes([small, large])
        } else {
            TwoAxes([large, small])
        }
    }

    /// The turns of a step of `h`, two flows in turn as `scheme` says, the turn about the outer axis first.
    #[cold]
    fn turns<S: Precise>(self, rotor: &Rotor, h: Dd, scheme: &Scheme) -> Turns<S> {
        Turns::two(self.0, self.0.map(|k| self.rate(rotor, k) * h), scheme)
    }

    /// The rate of the turn about axis `k` over the momentum about it: 1/I_k − 1/I_j, j the reference.
    fn rate(self, rotor: &Rotor, k: usize) -> Dd {
        let (i, j) = (rotor.moments::<Dd>(), self.reference());
        // not as a difference of reciprocals, which has fewer digits than the moments
        (i[j] - i[k]) / (i[j] * i[k])
    }

    /// With α, β, γ the reciprocal moments of outer, reference and inner axis,
    /// `24 H₃ = (α−β)²(β−γ) s_o s_j − (α−β)(β−γ)(α+β−2γ) s_o s_i + 2(α−β)(β−γ)² s_j s_i`
    /// (symmetric Baker–Campbell–Hausdorff series).
    pub(in crate::method) fn leading_term(self, moments: Vec3<f64>) -> ModifiedEnergy {
        let [o, i] = self.0;
        let j = self.reference();
        let [alpha, beta, gamma] = [o, j, i].map(|k| 1.0 / moments[k]);
        let (p, q) = (alpha - beta, beta - gamma);
        let mut mixed = [0.0; 3];
        mixed[i] = p * p * q / 24.0;
        mixed[j] = -p * q * (alpha + beta - 2.0 * gamma) / 24.0;
        mixed[o] = p * q * q / 12.0;
        ModifiedEnergy(mixed)
    }
}

impl fmt::Display for TwoAxes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.0[0] + 1, self.0[1] + 1)
    }
}

/// The text is no pair of axes.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("axes {text:?} are not two different axes of 123, such as 31 (the outer one first)")]
#[non_exhaustive]
pub struct TwoAxesError {
    /// What was given.
    pub text: String,
}

impl FromStr for TwoAxes {
    type Err = TwoAxesError;
    fn from_str(text: &str) -> Result<Self, TwoAxesError> {
        let found = Self::ALL.into_iter().find(|axes| axes.to_string() == text);
        found.ok_or_else(|| TwoAxesError { text: text.into() })
    }
}

impl Symmetric for TwoTurn {}

impl FreePart for TwoTurn {
    fn name(&self) -> String {
        match self.axes {
            Some(axes) => format!("two-turn:{axes}"),
            None => "two-turn".into(),
        }
    }
    fn order(&self) -> Option<u32> {
        Some(2)
    }
    fn energy(&self) -> Energy {
        Energy::Bounded
    }
    fn cost(&self) -> Cost {
        Cost::turns(4)
    }
    fn free_cost(&self, scheme: &Scheme) -> Option<Cost> {
        match scheme.stages {
            // of all flows but one: the last turn of a step and the first of the next are one
            Stages::Composition(gamma) => Some(Cost::turns(4 * gamma.len() as u32 + 2)),
            Stages::Alternating { pairs: Pairs::Any | Pairs::NearIntegrable(_), a, b, .. } => {
                Some(Cost::turns(2 * (a.len() + b.len()) as u32 + 2))
            }
            _ => None,
        }
    }
    /// The turn at a constant rate about the reference axis takes no sine.
    fn wheel_cost(&self) -> Option<Cost> {
        Some(Cost::turns(4))
    }
    fn wheel_split(&self, rotor: &Rotor) -> WheelSplit {
        let axes = self.axes.unwrap_or_else(|| TwoAxes::usual(rotor.moments()));
        let ([outer, inner], reference) = (axes.axes(), axes.reference());
        let axes =
            [(reference, Dd::ZERO), (outer, axes.rate(rotor, outer)), (inner, axes.rate(rotor, inner))];
        WheelSplit::Turns { axes, ball: Some(rotor.inverse_moments::<Dd>()[reference]) }
    }
    fn source(&self) -> &'static str {
        "Fasso, J. Comput. Phys. 189 (2003) 527; Hairer, Lubich and Wanner, Geometric Numerical Integration, (VII.5.33)"
    }
}

impl<S: Precise> Method<S> for TwoTurn {
    type Map<F: Field<S>> = TwoTurnMap<S>;

    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, _: &F) -> TwoTurnMap<S> {
        TwoTurnMap::new(self.axes, STRANG, h, rotor, false)
    }

    fn free_map<F: Field<S>>(&self, scheme: &Scheme, h: Dd, rotor: &Rotor, _: &F) -> Option<TwoTurnMap<S>> {
        let _ = self.free_cost(scheme)?;
        let free_to_choose = self.axes.is_none() && *scheme == STRANG;
        Some(TwoTurnMap::new(self.axes, *scheme, h, rotor, free_to_choose))
    }
}

/// A prepared [`TwoTurn`].
#[derive(Clone, Debug)]
pub struct TwoTurnMap<S> {
    rotor: Rotor,
    scheme: Scheme,
    h: Dd,
    /// Whether the axes may be chosen by the orbit when the motion is opened.
    free_to_choose: bool,
    axes: TwoAxes,
    /// `None` until it is known whether they are.
    turns: Option<Turns<S>>,
    ball: Casimir<S>,
    momentum_space: Vec3<Dd>, // when opened
}

impl<S: Precise> TwoTurnMap<S> {
    fn new(axes: Option<TwoAxes>, scheme: Scheme, h: Dd, rotor: &Rotor, free_to_choose: bool) -> Self {
        let axes = axes.unwrap_or_else(|| TwoAxes::usual(rotor.moments()));
        TwoTurnMap {
            rotor: *rotor,
            scheme,
            h,
            free_to_choose,
            axes,
            turns: (!free_to_choose).then(|| axes.turns(rotor, h, &scheme)),
            ball: Casimir::new(S::from_dd(Dd::ONE / rotor.moments::<Dd>()[axes.reference()])),
            momentum_space: Vec3::zero(),
        }
    }

    #[inline(always)]
    fn turns(&mut self) -> &mut Turns<S> {
        let TwoTurnMap { rotor, scheme, h, axes, turns, .. } = self;
        turns.get_or_insert_with(|| axes.turns(rotor, *h, scheme))
    }
}

impl<S: Precise> Map<S> for TwoTurnMap<S> {
    #[inline]
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        self.ball.flow(at, S::from_dd(self.h), x);
        self.turns().apply(x);
    }

    fn open(&mut self, _: Time, x: &mut Point<S>) {
        if self.free_to_choose {
            let m = x.momentum_body.map(S::to_f64);
            self.axes = TwoAxes::best(m, self.rotor.moments());
            self.turns = None;
        }
        self.momentum_space = x.attitude.map(S::to_dd).rotate(x.momentum_body.map(S::to_dd));
        self.turns().open(x);
    }

    #[inline]
    fn advance(&mut self, _: Time, x: &mut Point<S>) {
        self.turns().advance(x);
    }

    #[inline]
    fn advance_by(&mut self, n: u64, _: &Clock, x: &mut Point<S>) {
        self.turns().advance_by(n, x);
    }

    #[inline]
    fn fill(&mut self, _: &Clock, x: &mut Point<S>, block: &mut [Point<S>]) {
        self.turns().fill(x, block);
    }

    fn side_by_side(&self) -> Option<SideBySide<S>> {
        self.turns.as_ref()?.side_by_side()
    }

    fn part_side_by_side(&self) -> Option<SideBySide<S>> {
        let ball = (LaneFlow::Ball, self.ball.quarter_rate(S::from_dd(self.h)));
        Some(SideBySide::flows([ball].into_iter().chain(self.turns.as_ref()?.flows())))
    }

    #[inline]
    fn close(&mut self, _: Time, x: &mut Point<S>) {
        self.turns().close(x);
    }

    fn synchronize(&self, elapsed: Dd, x: &mut Point<S>) {
        let l = self.momentum_space;
        let size = l.norm();
        if size.magnitude() == 0.0 {
            return;
        }
        let half_angle = size * elapsed / self.rotor.moments::<Dd>()[self.axes.reference()] * 0.5;
        let (s, c) = half_angle.sin_cos();
        let turned = Quat::new(c, l * (s / size)) * x.attitude.map(S::to_dd);
        let mut phase = x.phase();
        phase.attitude = turned.map(S::from_dd);
        x.set_phase(phase);
    }
}
