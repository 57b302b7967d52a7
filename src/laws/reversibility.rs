//! Reversibility, ρ ∘ Φ_h ∘ ρ ∘ Φ_h = 1 with ρ(q, m) = (q, −m): steps there, the momentum reversed, and as many on.
//!
//! Free motion and motion in a potential are reversible, and with wheels only if these are reversed too; a map with ρ ∘ Φ_h ∘ ρ = Φ_{−h} is as reversible as it is symmetric.

use super::LawsError;
use super::subject::Subject;
use super::symmetry::returned;
use super::words::Law;
use crate::body::{Clock, Point, Problem};

/// Where 25 steps there and 25 with the momentum reversed lead; nothing of motions under a torque or with
/// wheels.
pub(super) fn measure(subject: &Subject<'_>) -> Result<Vec<super::Finding>, LawsError> {
    if !matches!(subject.problem(), Problem::Free | Problem::Linear | Problem::Potential) {
        return Ok(Vec::new());
    }
    let h = subject.telling_step(0.125);
    let mut x = subject.case.start;
    for _ in 0..2 {
        subject.method.prepare_dd(Clock::new(h), &subject.case.body)?.steps(&mut x, 25);
        x = Point::new(x.attitude, -x.momentum_body);
    }
    Ok(vec![returned(subject, Law::Reversibility, &x)])
}
