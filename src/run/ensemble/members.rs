//! Members in little room: inertias and starts as they were given.

use crate::body::{Body, Point, StateError};
use crate::inertia::{Inertia, InertiaError};
use crate::num::Dd;
use crate::rotation::{Quat, Vec3};

/// The inertia of every member.
pub(super) enum Inertias {
    /// None is known yet; with the room that was asked for.
    Unknown(usize),
    /// One for all.
    Shared(Inertia, usize),
    /// Principal moments along the body axes.
    Moments(Vec<[f64; 3]>),
    /// Tensors in any axes.
    Any(Vec<Inertia>),
}

impl Inertias {
    pub(super) fn with_capacity(members: usize) -> Self {
        Inertias::Unknown(members)
    }

    /// Of the next member, before which there are `members`.
    pub(super) fn push(&mut self, inertia: &Inertia, members: usize) {
        match self {
            Inertias::Unknown(room) => *self = Inertias::Shared(inertia.clone(), *room),
            Inertias::Shared(shared, _) if shared == inertia => {}
            Inertias::Shared(shared, room) => {
                let room = (*room).max(members + 1);
                if let Some(given) = moments(shared) {
                    let mut all = Vec::with_capacity(room);
                    all.resize(members, given);
                    *self = Inertias::Moments(all);
                } else {
                    let mut all = Vec::with_capacity(room);
                    all.resize(members, shared.clone());
                    *self = Inertias::Any(all);
                }
                self.push(inertia, members);
            }
            Inertias::Moments(all) => match moments(inertia) {
                Some(given) => all.push(given),
                None => {
                    let valid = |given: &[f64; 3]| Inertia::from_positive_moments(*given).ok();
                    *self = Inertias::Any(all.iter().filter_map(valid).collect());
                    self.push(inertia, members);
                }
            },
            Inertias::Any(all) => all.push(inertia.clone()),
        }
    }

    /// Keeps the place of a member without inertia.
    pub(super) fn push_any(&mut self) {
        match self {
            Inertias::Unknown(_) | Inertias::Shared(..) => {}
            Inertias::Moments(all) => all.push([1.0; 3]),
            Inertias::Any(all) => all.extend(all.last().cloned()),
        }
    }

    /// Of member `k`, which is not one without.
    pub(super) fn of(&self, k: usize) -> Result<Inertia, InertiaError> {
        match self {
            Inertias::Unknown(_) => Inertia::from_positive_moments([0.0; 3]),
            Inertias::Shared(inertia, _) => Ok(inertia.clone()),
            Inertias::Moments(all) => Inertia::from_positive_moments(all[k]),
            Inertias::Any(all) => Ok(all[k].clone()),
        }
    }
}

/// The numbers that `inertia` is made from, where those are moments along the body axes.
fn moments(inertia: &Inertia) -> Option<[f64; 3]> {
    let given: [f64; 3] = inertia.tensor().diagonal().into();
    (Inertia::from_positive_moments(given).as_ref() == Ok(inertia)).then_some(given)
}

/// The start of a member.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    attitude: [f64; 4],
    rotation: [f64; 3],
    /// Whether that is an angular velocity, else it is a momentum.
    is_omega: bool,
}

impl Start {
    /// Of a member that has no motion.
    pub(super) const NOWHERE: Start = Start { attitude: [0.0; 4], rotation: [0.0; 3], is_omega: false };

    pub(super) fn of_momentum(attitude: [f64; 4], momentum: [f64; 3]) -> Self {
        Start { attitude, rotation: momentum, is_omega: false }
    }

    pub(super) fn of_omega(attitude: [f64; 4], omega: [f64; 3]) -> Self {
        Start { attitude, rotation: omega, is_omega: true }
    }

    /// In the solver frame of `body`.
    pub(super) fn enter(&self, body: &Body) -> Result<Point<Dd>, StateError> {
        let (attitude, rotation) = (Quat::from_components(self.attitude), Vec3(self.rotation));
        if self.is_omega {
            body.enter_omega(attitude, rotation)
        } else {
            body.enter(&crate::body::State { attitude, momentum_body: rotation })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_take_the_room_that_is_stated() {
        let room = [size_of::<Start>(), size_of::<[f64; 3]>(), size_of::<Inertia>()];
        assert_eq!(room, [64, 24, 192]);
    }
}
