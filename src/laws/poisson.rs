//! The Lie–Poisson bracket of momenta, {m_i, m_j} = −ε_ijk m_k: D B(m) Dᵀ = B(m'), D the derivative of one step without torque and m the
//! momentum of body and wheels.

use super::LawsError;
use super::difference::derivative;
use super::finding::{Finding, yes};
use super::subject::{Subject, largest};
use super::words::{Law, Quantity};
use crate::body::{Point, Problem};
use crate::method::StepError;
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

/// The defect of the bracket, of free motion.
pub(super) fn measure(subject: &Subject<'_>) -> Result<Vec<Finding>, LawsError> {
    if !matches!(subject.problem(), Problem::Free | Problem::Gyrostat) {
        return Ok(Vec::new());
    }
    let claimed = subject.claims.poisson;
    // what a method of order 8 loses shows in a larger step
    let defect = defect(subject, subject.telling_step(if claimed { 0.25 } else { 0.5 }))?;
    let claimed = claimed || subject.is_to_rounding();
    let finding = Finding::new(subject.problem(), Law::Poisson, Quantity::Bracket, yes(claimed));
    Ok(vec![finding.judged(claimed, defect, 1e-20, 1e-14)])
}

/// Largest entry of `D B(m) Dᵀ − B(m')` over |m'|, B(m) the Lie–Poisson tensor.
fn defect(subject: &Subject<'_>, h: f64) -> Result<f64, StepError> {
    let wheels = subject.momentum_of_wheels();
    let map = |m: Vec3<Dd>| {
        Ok(subject.one_step(Point::new(Quat::identity(), m - wheels), h)?.momentum_body + wheels)
    };
    let m = subject.case.start.momentum_body + wheels;
    let column = |axis: usize| derivative(|d| Ok(map(m + Vec3::unit(axis) * d)?.0));
    let columns = [column(0)?, column(1)?, column(2)?];
    // B(m) v = v × m up to sign, so D B Dᵀ has the entries (row_i × row_j)·m
    let row = |i: usize| Vec3([columns[0][i], columns[1][i], columns[2][i]]);
    let image = map(m)?;
    let defects = [(0, 1, 2), (1, 2, 0), (2, 0, 1)]
        .map(|(i, j, k)| (row(i).cross(row(j)).dot(m) - image[k]).magnitude());
    Ok(largest(defects))
}
