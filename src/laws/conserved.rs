//! What is constant along the numerical solution, in double-double: 1e-28 of what is kept, and seen to be lost of the rest.

use super::LawsError;
use super::case::EXACT;
use super::finding::{Finding, NOT_FINITE};
use super::subject::{Subject, largest};
use super::words::{Law, Quantity};
use crate::body::{Conserved, Point};
use crate::method::Energy;
use crate::num::{Dd, Real};
use crate::observe::secular_drift;

/// Steps that are looked at.
const STEPS: u64 = 240;

/// Each quantity that the motion conserves, and |q|.
pub(super) fn measure(subject: &Subject<'_>) -> Result<Vec<Finding>, LawsError> {
    let h = subject.telling_step(0.125);
    let points = subject.integrate(h, STEPS, 1)?;
    let times: Vec<f64> = (0..STEPS).map(|n| n as f64 * h).collect();
    let (case, kept) = (subject.case, subject.claims.kept);
    let conserved = case.body.conserved();
    let all = [
        (Some(Conserved::Energy), Quantity::Energy, kept.energy == Energy::Exact),
        (Some(Conserved::MomentumNorm), Quantity::MomentumNorm, kept.momentum_norm),
        (Some(Conserved::Momentum), Quantity::MomentumSpace, kept.momentum_space),
        (Some(Conserved::MomentumZ), Quantity::MomentumZ, kept.momentum_z),
        (None, Quantity::Norm, kept.norm),
    ];
    let of_motion = all.into_iter().filter(|(law, ..)| law.is_none_or(|law| conserved.contains(&law)));
    Ok(of_motion
        .map(|(_, quantity, claimed)| {
            let error = error_of(subject, quantity);
            let mut errors: Vec<f64> = points.iter().map(|x| error(x).hi()).collect();
            let is_kept = claimed || subject.is_to_rounding();
            // a method that diverges loses what it does not keep before its numbers leave the range
            let diverges = errors.iter().position(|error| !error.is_finite());
            errors.truncate(diverges.filter(|_| !is_kept).unwrap_or(points.len()));
            let worst = largest(errors.iter().map(|error| error.abs()));
            let finding = Finding::new(case.problem(), Law::Conserved, quantity, subject.kept(claimed));
            let finding = finding.judged(is_kept, worst, EXACT, 1e14 * EXACT);
            let finding = match diverges {
                Some(n) => finding.because(format!("{NOT_FINITE} after {n} steps")),
                None => finding,
            };
            let drift = secular_drift(&times, &errors).filter(|drift| drift.slope.is_finite());
            Finding { drift, ..finding }
        })
        .collect())
}

/// The error of `quantity` at a point, relative but for |q|²; of L without sign.
fn error_of<'a>(subject: &Subject<'a>, quantity: Quantity) -> impl Fn(&Point<Dd>) -> Dd + use<'a> {
    let case = subject.case;
    let wheels = subject.momentum_of_wheels();
    let momentum = move |x: &Point<Dd>| x.momentum_body + wheels;
    let space = move |x: &Point<Dd>| x.attitude.rotate(momentum(x));
    let x0 = &case.start;
    let (e0, squared, l0) = (case.energy(x0), momentum(x0).norm_squared(), space(x0));
    move |x| match quantity {
        Quantity::Energy => case.energy(x) / e0 - Dd::ONE,
        Quantity::MomentumNorm => momentum(x).norm_squared() / squared - Dd::ONE,
        Quantity::MomentumSpace => (space(x) - l0).norm() / l0.norm(),
        Quantity::MomentumZ => (space(x) - l0)[2] / l0.norm(),
        _ => x.attitude.norm_squared() - Dd::ONE,
    }
}

/// Largest relative error of the energy at `points` points, after every so many steps of `h`.
pub(super) fn worst_energy(subject: &Subject<'_>, h: f64, points: u64, every: u64) -> Result<f64, LawsError> {
    let error = error_of(subject, Quantity::Energy);
    Ok(largest(subject.integrate(h, points, every)?.iter().map(|x| error(x).magnitude())))
}
