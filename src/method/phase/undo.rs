//! What takes a departure back.

use crate::body::{Evaluated, Point, Rotor, Time};
use crate::flow::{Casimir, Flow, FreeFlow, direction, smallest_turn};
use crate::num::{Dd, Precise};
use crate::rotation::{Quat, Vec3};

/// Rounds for the axis of the tilt, which is that of the state without it: each is nearer by the tilt.
const TILT_ROUNDS: usize = 8;

/// Takes departures back from states of a body.
pub(super) struct Undo<S> {
    flow: FreeFlow<S>,
    rotor: Rotor,
}

impl<S: Evaluated + Precise> Undo<S> {
    pub(super) fn new(rotor: &Rotor) -> Self {
        Undo { flow: FreeFlow::new(rotor), rotor: *rotor }
    }

    /// The smallest turn after which L is `along`.
    pub(super) fn lean(&self, point: &mut Point<S>, along: Vec3<Dd>) {
        let lean = smallest_turn(along.map(S::from_dd), direction(point.momentum_space()));
        point.attitude = lean.conjugate() * point.attitude;
    }

    /// A turn by `tilt` (rad) about ṁ as it is without it.
    pub(super) fn tilt(&self, point: &mut Point<S>, tilt: Dd) {
        let inverse = self.rotor.inverse_moments();
        let (sin, cos) = (S::from_dd(tilt) * S::of(0.5)).sin_cos();
        let mut turn = Quat::identity();
        for _ in 0..TILT_ROUNDS {
            let m = turn.rotate(point.momentum_body);
            let speed: Vec3<S> = m.cross(m.times(inverse));
            turn = Quat::new(cos, direction(speed) * sin);
        }
        point.attitude = point.attitude * turn.conjugate();
        point.momentum_body = turn.rotate(point.momentum_body);
    }

    /// The exact free motion back by `shift` (s), and a turn back by `twist` (rad) about L, of which `inverse_norm` is 1/|L|.
    pub(super) fn shift_and_twist(
        &mut self,
        at: Time,
        point: &mut Point<S>,
        [shift, twist]: [Dd; 2],
        inverse_norm: Dd,
    ) {
        self.flow.flow(at, S::from_dd(-shift), point);
        let twist = twist - (twist / Dd::TAU).round() * Dd::TAU;
        Casimir::new(S::from_dd(inverse_norm)).flow(at, S::from_dd(-twist), point);
    }
}

/// 1/|m|, or zero of a body at rest.
pub(super) fn inverse_norm_of<S: Precise>(point: &Point<S>) -> Dd {
    let norm = point.momentum_body.map(S::to_dd).norm();
    if norm == Dd::ZERO { Dd::ZERO } else { Dd::ONE / norm }
}
