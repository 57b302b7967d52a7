//! The symplectic form ξ₁·δm₂ − ξ₂·δm₁ + m·(ξ₁ × ξ₂) of two variations, ξ a turn of the body about its own axes, m with the momentum of
//! wheels.

use super::LawsError;
use super::difference::derivative;
use super::finding::{Finding, yes};
use super::subject::{Subject, largest};
use super::words::{Law, Quantity};
use crate::body::{Point, Problem};
use crate::method::StepError;
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

/// Largest difference that one step makes to the form of two of the six unit variations.
pub(super) fn measure(subject: &Subject<'_>) -> Result<Vec<Finding>, LawsError> {
    // the motion under a torque is none of a Hamiltonian
    let to_rounding = subject.is_to_rounding() && subject.problem() != Problem::Torque;
    let claimed = subject.claims.symplectic || to_rounding;
    let finding = Finding::new(subject.problem(), Law::Symplectic, Quantity::Form, yes(claimed));
    Ok(vec![finding.judged(claimed, defect(subject, 0.25)?, 1e-22, 1e-13)])
}

fn defect(subject: &Subject<'_>, h: f64) -> Result<f64, StepError> {
    let form = |m: Vec3<Dd>, a: &[Dd; 6], b: &[Dd; 6]| {
        let part = |v: &[Dd; 6], k: usize| Vec3([v[k], v[k + 1], v[k + 2]]);
        let turns = m.dot(part(a, 0).cross(part(b, 0)));
        part(a, 0).dot(part(b, 3)) - part(b, 0).dot(part(a, 3)) + turns
    };
    let (columns, image) = tangent(subject, h)?;
    let wheels = subject.momentum_of_wheels();
    let unit = |axis: usize| core::array::from_fn(|k| if k == axis { Dd::ONE } else { Dd::ZERO });
    let pairs = (0..6).flat_map(|i| (0..i).map(move |j| (i, j)));
    Ok(largest(pairs.map(|(i, j)| {
        let before = form(subject.case.start.momentum_body + wheels, &unit(i), &unit(j));
        (form(image + wheels, &columns[i], &columns[j]) - before).magnitude()
    })))
}

/// The derivative of one step at the start, left-trivialised: columns for turns of the body by ξ about its own axes and for
/// changes of its momentum, rows for those that they lead to. Also the momentum after the step.
fn tangent(subject: &Subject<'_>, h: f64) -> Result<([[Dd; 6]; 6], Vec3<Dd>), StepError> {
    let map = |turn: Vec3<Dd>, push: Vec3<Dd>| {
        let Point { attitude, momentum_body, .. } = subject.case.start;
        let turned = attitude * Quat::cayley(turn * Dd::of(0.5));
        subject.one_step(Point::new(turned, momentum_body + push), h)
    };
    let image = map(Vec3::zero(), Vec3::zero())?;
    let moved = |turn, push| {
        let x = map(turn, push)?;
        let turned = image.attitude.conjugate() * x.attitude;
        let turned = turned.v * (Dd::of(2.0) / turned.w);
        let pushed = x.momentum_body - image.momentum_body;
        Ok([turned[0], turned[1], turned[2], pushed[0], pushed[1], pushed[2]])
    };
    let mut columns = [[Dd::ZERO; 6]; 6];
    for (axis, column) in columns.iter_mut().enumerate() {
        *column = derivative(|d| {
            let by = Vec3::unit(axis % 3) * d;
            if axis < 3 { moved(by, Vec3::zero()) } else { moved(Vec3::zero(), by) }
        })?;
    }
    Ok((columns, image.momentum_body))
}
