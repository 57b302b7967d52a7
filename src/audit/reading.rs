//! A reading of the columns: which convention their numbers are in.

use core::fmt;

use crate::rotation::EulerSequence;
use crate::units::{AngleUnit, RateUnit};

/// Place of the scalar in a quaternion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QuaternionOrder {
    /// w, x, y, z.
    ScalarFirst,
    /// x, y, z, w.
    ScalarLast,
}

/// What an attitude takes where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Body components to space components: `v_space = R v_body`.
    BodyToSpace,
    /// Space components to body components.
    SpaceToBody,
}

/// The sign of the quaternion product.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Product {
    /// i j = k.
    Hamilton,
    /// i j = −k, as at the Jet Propulsion Laboratory.
    Jpl,
}

/// Axes that components refer to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// Axes fixed in the body.
    Body,
    /// Axes fixed in space.
    Space,
}

/// What the turns of Euler angles are about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turns {
    /// Axes that turn along, each turn about the new axis.
    Intrinsic,
    /// Axes that stay.
    Extrinsic,
}

/// Convention of Euler angles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Angles {
    /// Axes in the order of the columns.
    pub sequence: EulerSequence,
    /// About turned axes or fixed ones.
    pub turns: Turns,
    /// Their unit.
    pub unit: AngleUnit,
}

/// One convention of all columns; what the record has no column for is `None`.
///
/// ```
/// use polhode::audit::{Direction, Frame, QuaternionOrder, Reading};
/// use polhode::units::RateUnit;
/// let mut mujoco = Reading::default();
/// mujoco.quaternion = Some(QuaternionOrder::ScalarFirst);
/// mujoco.attitude = Some(Direction::BodyToSpace);
/// mujoco.omega_frame = Some(Frame::Body);
/// mujoco.rate_unit = Some(RateUnit::RadiansPerSecond);
/// assert_eq!(
///     mujoco.to_string(),
///     "quaternion w,x,y,z; attitude body to space (Hamilton; space to body by JPL's product); omega in body axes, rad/s"
/// );
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Reading {
    /// Place of the scalar.
    pub quaternion: Option<QuaternionOrder>,
    /// Direction of the attitude; of quaternions by Hamilton's product. By JPL's the same numbers are the other direction.
    pub attitude: Option<Direction>,
    /// Convention of Euler angles.
    pub angles: Option<Angles>,
    /// Axes of the angular velocity.
    pub omega_frame: Option<Frame>,
    /// Unit of the angular velocity.
    pub rate_unit: Option<RateUnit>,
    /// Axes of the angular momentum.
    pub momentum_frame: Option<Frame>,
    /// Which of the given moments, from 0, belongs to each body axis; `[0, 1, 2]` as they were given.
    pub moments: [usize; 3],
}

impl Default for Reading {
    /// Of no columns, with the moments as given.
    fn default() -> Self {
        Reading {
            quaternion: None,
            attitude: None,
            angles: None,
            omega_frame: None,
            rate_unit: None,
            momentum_frame: None,
            moments: [0, 1, 2],
        }
    }
}

impl Reading {
    /// The direction of a quaternion's attitude by `product`: the conjugate of one product is the quaternion of the other.
    #[must_use]
    pub fn direction(&self, product: Product) -> Option<Direction> {
        match product {
            Product::Hamilton => self.attitude,
            Product::Jpl => self.attitude.map(Direction::other),
        }
    }

    /// The axes, from 0, that the Euler angles turn about, in the order of their columns.
    #[must_use]
    pub fn angle_axes(&self) -> Option<[usize; 3]> {
        self.angles.map(|angles| angles.sequence.axes())
    }

    /// Whether the moments are in the order in which they were given.
    #[must_use]
    pub(super) fn moments_as_given(&self) -> bool {
        self.moments == [0, 1, 2]
    }
}

impl Direction {
    /// The opposite direction.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Direction::BodyToSpace => Direction::SpaceToBody,
            Direction::SpaceToBody => Direction::BodyToSpace,
        }
    }
}

impl fmt::Display for QuaternionOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            QuaternionOrder::ScalarFirst => "wxyz",
            QuaternionOrder::ScalarLast => "xyzw",
        })
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Direction::BodyToSpace => "body-to-space",
            Direction::SpaceToBody => "space-to-body",
        })
    }
}

impl fmt::Display for Frame {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Frame::Body => "body",
            Frame::Space => "space",
        })
    }
}

impl fmt::Display for Turns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Turns::Intrinsic => "intrinsic",
            Turns::Extrinsic => "extrinsic",
        })
    }
}

impl fmt::Display for Reading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words = |direction: Direction| direction.to_string().replace('-', " ");
        let mut parts = Vec::new();
        if let Some(order) = self.quaternion {
            let order = order.to_string().chars().map(String::from).collect::<Vec<_>>().join(",");
            parts.push(format!("quaternion {order}"));
        }
        if let Some(Angles { sequence, turns, unit }) = self.angles {
            parts.push(format!("Euler angles {sequence}, {turns}, {unit}"));
        }
        if let Some(direction) = self.attitude {
            let mut part = format!("attitude {}", words(direction));
            if self.quaternion.is_some() {
                part += &format!(" (Hamilton; {} by JPL's product)", words(direction.other()));
            }
            parts.push(part);
        }
        if let Some(frame) = self.omega_frame {
            let unit = self.rate_unit.map_or(String::new(), |unit| format!(", {unit}"));
            parts.push(format!("omega in {frame} axes{unit}"));
        }
        if let Some(frame) = self.momentum_frame {
            parts.push(format!("momentum in {frame} axes"));
        }
        if !self.moments_as_given() {
            let [a, b, c] = self.moments.map(|k| k + 1);
            parts.push(format!("moments in the order {a},{b},{c} of those given"));
        }
        f.write_str(&parts.join("; "))
    }
}
