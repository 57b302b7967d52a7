//! A column of the weak equations: an unknown, its prior, and the stretch that it acts on.

use crate::columns::axis_scale::AxisScale;
use crate::columns::constant::Constant;
use crate::columns::drag::Drag;
use crate::columns::effect::{Class, Effect, Label};
use crate::columns::input::Input;
use crate::columns::magnet::Magnet;
use crate::columns::misalignment::Misalignment;
use crate::columns::offset::Offset;
use crate::columns::quadratic::Quadratic;
use crate::columns::rotor::Rotor;
use crate::columns::scale::Scale;
use crate::columns::skew::Skew;
use crate::columns::viscous::Viscous;
use crate::columns::walk::Walk;
use crate::columns::wheel_axis::WheelAxis;
use crate::physical::coordinates::{Coordinates, tensor};
use crate::signal::stretch::Stretch;
use crate::signal::terms::Terms;
use crate::thresholds::errors::HELD;

macro_rules! kinds {
    ($($name:ident),*) => {
        /// Every unknown; what it does stands in its own file.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(crate) enum Kind {
            $(#[doc = concat!("See `", stringify!($name), "`.")] $name($name),)*
        }

        impl Kind {
            fn effect(&self) -> &dyn Effect {
                match self {
                    $(Kind::$name(effect) => effect,)*
                }
            }
        }

        $(impl From<$name> for Kind {
            fn from(effect: $name) -> Kind {
                Kind::$name(effect)
            }
        })*
    };
}

kinds!(
    Drag,
    Viscous,
    Quadratic,
    Constant,
    Offset,
    Scale,
    AxisScale,
    Misalignment,
    Skew,
    Walk,
    Rotor,
    Magnet,
    Input,
    WheelAxis
);

/// An unknown and the standard deviation of its prior about zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Column {
    kind: Kind,
    pub(crate) prior: Option<f64>,
    /// The one stretch that it acts on, by its number in the record; without it all.
    pub(crate) segment: Option<usize>,
}

impl Column {
    /// Of all stretches.
    pub(crate) fn new(kind: impl Into<Kind>, prior: Option<f64>) -> Column {
        Column { kind: kind.into(), prior, segment: None }
    }

    /// With this prior, or none.
    pub(crate) fn with_prior(self, prior: Option<f64>) -> Column {
        Column { prior, ..self }
    }

    /// As good as known where it is an error of scale or alignment. The equations of a sphere, J ω' = 0, would be met by rates without a
    /// scale, whatever they are.
    pub(crate) fn at_sphere(self) -> Column {
        let prior = self.prior.map_or(HELD, |prior| prior.min(HELD));
        if self.effect().distortion().is_some() { self.with_prior(Some(prior)) } else { self }
    }

    /// Of one stretch alone, by its number in the record.
    pub(crate) fn of_segment(self, segment: usize) -> Column {
        Column { segment: Some(segment), ..self }
    }

    /// What it does.
    pub(crate) fn effect(&self) -> &dyn Effect {
        self.kind.effect()
    }

    pub(crate) fn label(&self) -> Label {
        self.effect().label()
    }

    pub(crate) fn class(&self) -> Class {
        self.effect().class()
    }

    /// Whether both are the same unknown, whatever their priors are.
    pub(crate) fn is_alike(&self, other: &Column) -> bool {
        self.kind == other.kind && self.segment == other.segment
    }

    pub(crate) fn acts_on(&self, stretch: &Stretch) -> bool {
        self.segment.is_none_or(|segment| segment == stretch.index)
    }
}

/// Values of all unknowns.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Unknowns {
    pub(crate) x: Coordinates,
    /// One for each column.
    pub(crate) c: Vec<f64>,
}

impl Unknowns {
    pub(crate) fn at(x: Coordinates, columns: &[Column]) -> Self {
        Unknowns { x, c: vec![0.0; columns.len()] }
    }
}

/// Torque and sensor at `unknowns`, of the columns that act on a stretch.
pub(crate) fn terms_of(columns: &[Column], unknowns: &Unknowns, stretch: &Stretch) -> Terms {
    sum(columns.iter().zip(&unknowns.c).filter(|(column, _)| column.acts_on(stretch)), &unknowns.x)
}

/// The same of all columns.
pub(crate) fn terms_of_all(columns: &[Column], unknowns: &Unknowns) -> Terms {
    sum(columns.iter().zip(&unknowns.c), &unknowns.x)
}

fn sum<'a>(acting: impl Iterator<Item = (&'a Column, &'a f64)>, x: &Coordinates) -> Terms {
    let mut terms = Terms::at(tensor(x));
    for (column, &value) in acting {
        column.effect().add_to(&mut terms, value);
    }
    terms.viscous += terms.j * terms.drag;
    terms
}
