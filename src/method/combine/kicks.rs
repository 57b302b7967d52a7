//! Kicks of the potential as maps.

use crate::body::{Field, Point, Rotor, Time};
use crate::flow::{Flow, Kick};
use crate::method::contract::lanes::LaneFlow;
use crate::method::{Map, Method, SideBySide};
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// The [kicks](Kick) of the potential, as the part B of a splitting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kicks;

impl<S: Real> Method<S> for Kicks {
    type Map<F: Field<S>> = KickMap<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, _: &Rotor, field: &F) -> KickMap<S, F> {
        KickMap { kick: Kick::new(field.clone()), h: S::from_dd(h), gradient: None }
    }
}

/// A kick of one length.
#[derive(Clone, Debug)]
pub struct KickMap<S, F> {
    kick: Kick<S, F>,
    h: S,
    gradient: Option<Gradient<S>>,
}

/// What is added to the potential: −`share` h² τᵀI⁻¹τ.
#[derive(Clone, Copy, Debug)]
struct Gradient<S> {
    share: S,
    inverse_moments: Vec3<S>,
}

impl<S: Real, F: Field<S>> KickMap<S, F> {
    /// With the gradient `share` of a step `h`; with a share of 0 as it is.
    pub(in crate::method) fn with_gradient(self, share: Dd, h: Dd, rotor: &Rotor) -> Self {
        let share = share * h * h * h;
        let gradient = (share != Dd::ZERO)
            .then(|| Gradient { share: S::from_dd(share), inverse_moments: rotor.inverse_moments() });
        KickMap { gradient, ..self }
    }
}

impl<S: Real, F: Field<S>> Map<S> for KickMap<S, F> {
    fn part_side_by_side(&self) -> Option<SideBySide<S>> {
        let kick = LaneFlow::Kick(Dd::ZERO);
        let Some((gradient, linear)) = self.gradient.zip(self.kick.field().linear_part()) else {
            return Some(SideBySide::flows([(kick, self.h)]));
        };
        let constants =
            [self.h, gradient.share].into_iter().chain(gradient.inverse_moments.0).chain(linear.moment.0);
        Some(SideBySide::reading(vec![kick, LaneFlow::Gradient], constants.collect()))
    }

    #[inline(always)]
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        let gradient = self.gradient.zip(self.kick.field().linear_part()).map(|(gradient, linear)| {
            linear.gradient_of_squared_torque(gradient.inverse_moments, x.attitude) * gradient.share
        });
        self.kick.flow(at, self.h, x);
        if let Some(gradient) = gradient {
            x.add_momentum(gradient);
        }
    }
}
