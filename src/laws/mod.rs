//! Laws: what a method, a force or a scheme claims, measured.
//!
//! [`check`] measures every claim of a [method](crate::method::AnyMethod) on [six bodies](cases): free, under gravity, in a
//! potential, under a torque, with wheels, and with wheels in a potential. Laws that hold in exact arithmetic are measured in double-double,
//! where they hold to some 1e-28, so that rounding does not hide a broken law. Round-off and secular drifts are measured in double
//! precision. Claims that say no are measured too: what a method does not claim to keep must be seen to change. If a measurement does
//! not decide a law, the report says so.
//!
//! An example with false claims: Heun's method of order 2, which claims order 3 and a symmetric map.
//!
//! ```
//! use polhode::body::{Field, Phase, Point, Problem, Rotor, Time};
//! use polhode::laws::{Law, check_only};
//! use polhode::method::{Claimed, Claims, Cost, Kept, Map, Method};
//! use polhode::num::{Dd, Real};
//! use polhode::rotation::Vec3;
//!
//! #[derive(Clone)]
//! struct Wrong;
//!
//! impl Claimed for Wrong {
//!     fn name(&self) -> String {
//!         "wrong".into()
//!     }
//!     fn claims(&self, problem: Problem) -> Option<Claims> {
//!         let mut claims = Claims::new(Some(3), Kept::NOTHING, Cost::right_sides(2), "nobody");
//!         claims.symmetric = true;
//!         (problem == Problem::Free).then_some(claims)
//!     }
//! }
//!
//! struct WrongMap<S> {
//!     h: S,
//!     inverse_moments: Vec3<S>,
//! }
//!
//! impl<S: Real> Method<S> for Wrong {
//!     type Map<F: Field<S>> = WrongMap<S>;
//!     fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, _: &F) -> WrongMap<S> {
//!         WrongMap { h: S::from_dd(h), inverse_moments: rotor.inverse_moments() }
//!     }
//! }
//!
//! impl<S: Real> Map<S> for WrongMap<S> {
//!     fn apply(&mut self, _: Time, point: &mut Point<S>) {
//!         let rate = |x: &Phase<S>| {
//!             let omega = x.momentum_body.times(self.inverse_moments);
//!             Phase { attitude: x.attitude.rate(omega), momentum_body: x.momentum_body.cross(omega) }
//!         };
//!         let x = point.phase();
//!         let first = rate(&x);
//!         let second = rate(&(x + first * self.h));
//!         point.set_phase(x + (first + second) * (self.h * S::of(0.5)));
//!     }
//! }
//!
//! let report = check_only(&Wrong, &[Problem::Free], &[Law::Order, Law::Symmetry, Law::Conserved])?;
//! let found: Vec<_> = report.false_claims().map(|finding| finding.sentence()).collect();
//! assert_eq!(found[0], "free, order, attitude: claimed 3, measured 2.000 ± 1.9e-5, limit 0.060");
//! assert_eq!(found[2], "free, symmetry, state: claimed yes, measured 1.0e-3, limit 1.0e-27");
//! println!("{report}");
//! # Ok::<(), polhode::Error>(())
//! ```

mod case;
mod conserved;
mod cost;
mod counted;
mod counted_forces;
mod difference;
mod drift;
mod error;
mod fields;
mod finding;
mod force;
mod order;
mod poisson;
mod report;
mod reversibility;
mod rounding;
mod scheme;
mod subject;
mod suite;
mod symmetry;
mod symplectic;
mod takes;
mod text;
mod time;
mod words;

pub use case::{Case, cases};
pub use cost::check_cost;
pub use counted::{Counted, Operations, operations};
pub use error::LawsError;
pub use finding::Finding;
pub use force::check_force;
pub use report::Report;
pub use scheme::{check_scheme, exponents_of};
pub use suite::{check, check_only, check_order};
pub use text::ReportError;
pub use words::{Law, Quantity, UnknownWord, Verdict};
