//! Free parts made of exact flows: one's own splitting of the kinetic energy.

use super::schemes::Scheme;
use super::{FreePart, Kicks, SchemeError, Splitting, Symmetric};
use crate::body::{Field, Point, Rotor, Time};
use crate::flow::Flow;
use crate::method::{Cost, Energy, Kept, Map, Method};
use crate::num::{Dd, Precise, Real};

/// A splitting of the kinetic energy, T = T₁ + … + T_n, each part with an exact flow.
///
/// [`Splitting::of_flows`] makes the method of it: Φ_h = F₁(h/2) … F_{n−1}(h/2) F_n(h) F_{n−1}(h/2) … F₁(h/2), of order 2, in a
/// scheme and with kicks under a potential. Flows of functions of m keep |m|, L and the bracket, and where their energies add up to T,
/// that within bounds; where they do not, [`kept`](Self::kept) has to say so.
///
/// Source: Strang, SIAM J. Numer. Anal. 5 (1968) 506.
///
/// ```
/// use polhode::body::{Conserved, Rotor};
/// use polhode::flow::Turn;
/// use polhode::method::{KineticSplit, Splitting, schemes::STRANG};
/// use polhode::num::Precise;
/// use polhode::{Body, Inertia, Run};
///
/// #[derive(Clone)]
/// struct ThreeTurns;
///
/// impl KineticSplit for ThreeTurns {
///     type Flows<S: Precise> = [Turn<S>; 3];
///     fn name(&self) -> String {
///         "three-turns".into()
///     }
///     fn flows<S: Precise>(&self, rotor: &Rotor) -> [Turn<S>; 3] {
///         Turn::of(rotor)
///     }
/// }
///
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(Default::default(), [0.4, 1.0, -0.3].into())?;
/// let method = Splitting::of_flows(ThreeTurns, STRANG)?;
/// let end = Run::new(&method, &body, &start, 0.01)?.advance_to(10_000)?;
/// assert!(end.worst.of(Conserved::Momentum).is_some_and(|error| error < 1e-14));
/// # Ok::<(), polhode::Error>(())
/// ```
pub trait KineticSplit: Clone + Send + Sync {
    /// The flows in the order in which a step takes them.
    type Flows<S: Precise>: InTurn<S>;

    /// Name of the method that alternates them with kicks by Strang's scheme.
    fn name(&self) -> String;

    /// The flows for a body with the constants `rotor`.
    fn flows<S: Precise>(&self, rotor: &Rotor) -> Self::Flows<S>;

    /// What free motion keeps: the energy within bounds, and all else, unless said otherwise.
    fn kept(&self) -> Kept {
        Kept::all_of_free_motion(Energy::Bounded)
    }

    /// Whether the flows keep the Lie–Poisson bracket and the symplectic form.
    fn symplectic(&self) -> bool {
        true
    }

    /// Work of one step; as many turns as flows are taken, unless said otherwise.
    fn cost(&self) -> Cost {
        Cost::turns(2 * <Self::Flows<f64> as InTurn<f64>>::COUNT - 1)
    }

    /// Where it comes from.
    fn source(&self) -> &'static str {
        ""
    }
}

/// Flows that are taken one after the other, forwards and back again: an array, or a tuple of two to four.
pub trait InTurn<S: Real>: Clone + Send + 'static {
    /// How many they are, at least one.
    const COUNT: u32;

    /// Takes all for half of `t`, the last for `t`, and the others for half of it again in the reverse order.
    fn there_and_back(&self, at: Time, t: S, half: S, x: &mut Point<S>);
}

impl<S: Real, F: Flow<S> + Clone + Send + 'static, const N: usize> InTurn<S> for [F; N] {
    const COUNT: u32 = {
        assert!(N > 0, "a step takes one flow at least");
        N as u32
    };

    #[inline]
    fn there_and_back(&self, at: Time, t: S, half: S, x: &mut Point<S>) {
        let Some((last, others)) = self.split_last() else { return };
        others.iter().for_each(|flow| flow.flow(at, half, x));
        last.flow(at, t, x);
        others.iter().rev().for_each(|flow| flow.flow(at, half, x));
    }
}

macro_rules! in_turn {
    ($last:ident: $count:literal $(, $flow:ident)+; $($reverse:ident),+) => {
        impl<S: Real, $($flow: Flow<S> + Clone + Send + 'static,)+ $last: Flow<S> + Clone + Send + 'static> InTurn<S>
            for ($($flow,)+ $last)
        {
            const COUNT: u32 = $count;

            #[inline]
            #[allow(non_snake_case)]
            fn there_and_back(&self, at: Time, t: S, half: S, x: &mut Point<S>) {
                let ($($flow,)+ $last) = self;
                $($flow.flow(at, half, x);)+
                $last.flow(at, t, x);
                $($reverse.flow(at, half, x);)+
            }
        }
    };
}
in_turn!(B: 2, A; A);
in_turn!(C: 3, A, B; B, A);
in_turn!(D: 4, A, B, C; C, B, A);

/// The [free part](FreePart) that takes the flows of `T` there and back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Palindrome<T>(T);

impl<T: KineticSplit> Splitting<Palindrome<T>, Kicks> {
    /// The flows of `parts`, and under a potential its kicks, by `scheme`.
    ///
    /// # Errors
    /// As [`kicked`](Self::kicked): a scheme of an order above 2 that is no composition.
    pub fn of_flows(parts: T, scheme: Scheme) -> Result<Self, SchemeError> {
        Splitting::kicked(Palindrome(parts), scheme)
    }
}

impl<T: KineticSplit> Symmetric for Palindrome<T> {}

impl<T: KineticSplit> FreePart for Palindrome<T> {
    fn name(&self) -> String {
        self.0.name()
    }
    fn order(&self) -> Option<u32> {
        Some(2)
    }
    fn energy(&self) -> Energy {
        self.kept().energy
    }
    fn kept(&self) -> Kept {
        self.0.kept()
    }
    fn poisson(&self) -> bool {
        self.0.symplectic()
    }
    fn symplectic(&self) -> bool {
        self.0.symplectic()
    }
    fn cost(&self) -> Cost {
        self.0.cost()
    }
    fn source(&self) -> &'static str {
        self.0.source()
    }
}

impl<S: Precise, T: KineticSplit> Method<S> for Palindrome<T> {
    type Map<F: Field<S>> = PalindromeMap<S, T::Flows<S>>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, _: &F) -> Self::Map<F> {
        PalindromeMap { flows: self.0.flows(rotor), h: S::from_dd(h), half: S::from_dd(h * 0.5) }
    }
}

/// A prepared [`Palindrome`].
#[derive(Clone, Debug)]
pub struct PalindromeMap<S, T> {
    flows: T,
    h: S,
    half: S,
}

impl<S: Real, T: InTurn<S>> Map<S> for PalindromeMap<S, T> {
    #[inline]
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        self.flows.there_and_back(at, self.h, self.half, x);
        x.renormalize_at_times();
    }
}
