//! A free body of another shape that moves as the record does.

use super::detective::investigate;
use super::deviation::{Allowances, deviation};
use super::{Judgement, OtherBody, Question, Trajectory};
use crate::body::Problem;

/// Products of inertia above this share of the trace turn the axes.
const TURNED: f64 = 1e-3;

/// The body whose motion every row of `record` is, where that of the question is not it; `None` where there is none, or where the
/// record does not tell.
pub(super) fn other_body(
    record: &Trajectory,
    question: &Question,
    allowances: &Allowances,
) -> Option<OtherBody> {
    let given = question.body.as_ref().filter(|body| body.problem() == Problem::Free)?;
    // without rates any turn of attitudes is some angular velocity, and momenta depend on the body
    record.rates.as_ref()?;
    let mut bare = question.clone();
    bare.body = None;
    let finding = investigate(record, &bare).ok()?;
    let first = finding.right.first()?;
    let found = deviation(record, &first.reading, &first.body, None, true, allowances)?;
    if found.judgement != Judgement::Right {
        return None;
    }
    let inertia = found.start.body.inertia();
    let scale = given.inertia().tensor().trace() / inertia.tensor().trace();
    let tensor = inertia.tensor() * scale;
    let products = tensor[(0, 1)].abs().max(tensor[(0, 2)].abs()).max(tensor[(1, 2)].abs());
    let principal = products > TURNED * tensor.trace();
    let moments = if principal {
        inertia.principal_moments().map(|moment| moment * scale)
    } else {
        [0, 1, 2].map(|axis| tensor[(axis, axis)])
    };
    Some(OtherBody { moments, principal })
}
