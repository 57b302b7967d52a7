//! Elliptic integrals and functions, in `f64` and in double-double.
//!
//! # Notation
//! m = k² is the parameter, **m1 = k'² = 1 − m the complementary one, and the datum**: near a separatrix m1 is
//! tiny, and subtracting a rounded m from 1 would lose it. u is the argument, K the quarter period.
//!
//! ```
//! use polhode::num::elliptic::{Modulus, incomplete};
//! let modulus = Modulus::new(1e-30);
//! let (sn, cn, dn) = modulus.sn_cn_dn(20.0);
//! assert!((dn - cn).abs() < 1e-13 * cn); // almost on the separatrix, where dn = cn = sech u
//! let u = incomplete(sn, cn, 1.0, 1e-30);
//! assert!((u - 20.0).abs() < 1e-14);
//! assert!(modulus.quarter_period() > 35.0);
//! ```
#![doc = include_str!("../accuracy/elliptic.md")]

mod carlson;
mod jacobi;

pub(crate) use carlson::each_r_f;
pub use carlson::{r_c, r_d, r_f, r_j};
pub(crate) use jacobi::quarter_period;
pub use jacobi::{Modulus, incomplete, jacobi};
