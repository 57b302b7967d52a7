//! What is asked of a record, and what is claimed of it.

use super::bodies::Told;
use super::{
    AngleUnit, Angles, AuditError, Direction, Frame, QuaternionOrder, RateUnit, Reading, Trajectory,
};
use crate::body::{Body, WheelAtStart};

/// Most noise of the attitude that may be declared, rad, and the largest tolerance, rad and relative: more hides any motion.
pub(super) const MOST: f64 = 0.1;

/// What is asked of a record.
///
/// ```
/// use polhode::audit::Question;
/// use polhode::{Body, Inertia};
/// let of_this_body = Question::new(Some(Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?)));
/// assert_eq!((of_this_body.tolerance, of_this_body.claims.moments), (1e-6, Some([0, 1, 2])));
/// # Ok::<(), polhode::inertia::InertiaError>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Question {
    /// The body with what acts on it; `None`: a free body whose shape is found from the record.
    pub body: Option<Body>,
    /// Wheels that the body carries besides, by their speed at the first row. The momentum of one that is free or driven follows from
    /// how the body turns there.
    pub wheels: Vec<WheelAtStart>,
    /// Largest error of a record that is right, rad and relative; at most 0.1.
    pub tolerance: f64,
    /// Noise of the record that is declared; without it a noisy record is undecided at best.
    pub noise: Noise,
    /// What is claimed of the convention.
    pub claims: Convention,
}

/// Standard deviations of a component that a record is declared to have; 0 of what it does not hold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Noise {
    /// Of the attitude, rad.
    pub attitude: f64,
    /// Of the angular velocity, rad/s, or of that which follows from an angular momentum; where it is more than a tenth of the
    /// angular velocity, nothing is decided.
    pub rates: f64,
}

/// What is claimed of the convention of a record; `None` is to be told from the record.
///
/// The place of the scalar, the Euler sequence and the unit of angles are taken as given. A direction, a frame, a unit of rates,
/// axes of angles or an order of moments that the record contradicts makes it wrong, with the claim as the suspect.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Convention {
    /// Place of the scalar.
    pub quaternion: Option<QuaternionOrder>,
    /// Direction of the attitude, by Hamilton's product.
    pub attitude: Option<Direction>,
    /// Convention of Euler angles.
    pub angles: Option<Angles>,
    /// Unit of Euler angles, where the rest is to be told.
    pub angle_unit: Option<AngleUnit>,
    /// What the Euler angles turn about by the names of their columns: of roll, pitch and yaw x, y and z, `[0, 1, 2]`.
    pub angle_axes: Option<[usize; 3]>,
    /// Axes of the angular velocity.
    pub omega_frame: Option<Frame>,
    /// Unit of the angular velocity.
    pub rate_unit: Option<RateUnit>,
    /// Axes of the angular momentum.
    pub momentum_frame: Option<Frame>,
    /// Order of the moments; the default claims that they belong to the axes as they were given.
    pub moments: Option<[usize; 3]>,
}

impl Default for Convention {
    /// Nothing but the order of the moments.
    fn default() -> Self {
        Convention {
            quaternion: None,
            attitude: None,
            angles: None,
            angle_unit: None,
            angle_axes: None,
            omega_frame: None,
            rate_unit: None,
            momentum_frame: None,
            moments: Some([0, 1, 2]),
        }
    }
}

impl Question {
    /// Is the record right, to 1e-6, for this body, in whatever convention?
    #[must_use]
    pub fn new(body: Option<Body>) -> Self {
        Question {
            body,
            wheels: Vec::new(),
            tolerance: 1e-6,
            noise: Noise::default(),
            claims: Convention::default(),
        }
    }

    /// The body with the wheels by their speed; `None` without such wheels, or without a body.
    pub(super) fn told(&self) -> Option<Told> {
        let body = self.body.as_ref().filter(|_| !self.wheels.is_empty())?;
        Some(Told { body: body.clone(), wheels: self.wheels.clone() })
    }

    pub(super) fn check(&self, record: &Trajectory) -> Result<(), AuditError> {
        match &self.body {
            None if !self.wheels.is_empty() => return Err(AuditError::WheelsNeedBody),
            None => {}
            Some(body) => {
                let carrying = body.clone().with_wheels_at_start(&self.wheels, 0.0, Default::default())?;
                if record.momentum.is_some() && !carrying.wheels().is_empty() {
                    return Err(AuditError::MomentumOfWheels);
                }
            }
        }
        if !(self.tolerance > 0.0 && self.tolerance <= MOST) {
            return Err(AuditError::Tolerance { value: self.tolerance, most: MOST });
        }
        let Noise { attitude, rates } = self.noise;
        if !(0.0..=MOST).contains(&attitude) {
            return Err(AuditError::Noise { quantity: "attitude", value: attitude, most: MOST });
        }
        if !(rates >= 0.0 && rates.is_finite()) {
            return Err(AuditError::Noise { quantity: "angular velocity", value: rates, most: f64::MAX });
        }
        let has_rates = record.rates.is_some() || record.momentum.is_some();
        for (quantity, value, is_there) in
            [("attitude", attitude, record.attitude.is_some()), ("angular velocity", rates, has_rates)]
        {
            if value > 0.0 && !is_there {
                return Err(AuditError::NoiseOfNothing { quantity, value });
            }
        }
        Ok(())
    }
}

impl Convention {
    /// Whether `reading` is one of those that are looked at: what is taken as given holds.
    pub(super) fn admit(&self, reading: &Reading) -> bool {
        !contradicts(self.quaternion, reading.quaternion)
            && !contradicts(self.angles, reading.angles)
            && !contradicts(self.angle_unit, reading.angles.map(|read| read.unit))
    }
}

/// Whether what is claimed is read otherwise.
pub(super) fn contradicts<T: PartialEq>(claimed: Option<T>, read: Option<T>) -> bool {
    claimed.zip(read).is_some_and(|(claimed, read)| claimed != read)
}
