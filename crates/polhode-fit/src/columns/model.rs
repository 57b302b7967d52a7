//! What the weak equations reckon with beside the tensor: torques on the body, and errors of the sensor.
//!
//! J ω' + ω × J ω + D ω + c |ω| J ω − τ₀ = 0 with ω = P y − b of the readings y. Every unknown but the tensor is one column.

use crate::settings::torque::TorqueModel;
use crate::signal::terms::Terms;
use nalgebra::Matrix3;

use crate::physical::coordinates::{Coordinates, symmetric, tensor};
use crate::settings::sensor::SensorPriors;
use crate::signal::stretch::Stretch;

/// An unknown beside the tensor, in units of the root mean square rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    /// k in the torque −k J ω.
    Drag,
    /// An entry of D in the torque −D ω, in the order xx, yy, zz, xy, xz, yz.
    Viscous(usize),
    /// c in the torque −c |ω| J ω.
    Quadratic,
    /// A component of the torque τ₀.
    Constant(usize),
    /// A component of the offset b.
    Offset(usize),
    /// The relative error of scale of all axes.
    Scale,
    /// That of one axis.
    AxisScale(usize),
    /// The angle by which a pair of axes is not a right one: the third axis is its number.
    Misalignment(usize),
    /// The delay of an axis behind the first.
    Skew(usize),
    /// The change of the offset of an axis from one time to another, in proportion to the time between them.
    Walk { axis: usize, from: f64, until: f64 },
    /// A component of a constant momentum inside the body, as of a wheel that nobody knows of.
    Rotor(usize),
    /// One over the trace of the tensor: the factor of wheel momenta and known torques.
    Input,
}

/// An unknown and the standard deviation of its prior about zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Column {
    pub(crate) kind: Kind,
    pub(crate) prior: Option<f64>,
    /// The one stretch that it acts on, by its number in the record; without it all.
    pub(crate) segment: Option<usize>,
}

impl Column {
    /// Of all stretches.
    pub(crate) fn new(kind: Kind, prior: Option<f64>) -> Column {
        Column { kind, prior, segment: None }
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

/// The columns of what may be wrong with a sensor, in units of the rate `rms`.
pub(crate) fn sensor_columns(priors: &SensorPriors, rms: f64) -> Vec<Column> {
    let each = [
        (priors.offset.map(|p| p / rms), [0, 1, 2].map(Kind::Offset).to_vec()),
        (priors.scale, vec![Kind::Scale]),
        (priors.axis_scales, [0, 1, 2].map(Kind::AxisScale).to_vec()),
        (priors.misalignment, [0, 1, 2].map(Kind::Misalignment).to_vec()),
        (priors.skew.map(|p| p * rms), [1, 2].map(Kind::Skew).to_vec()),
    ];
    let columns = |(prior, kinds): (Option<f64>, Vec<Kind>)| {
        let kinds = if prior.is_some() { kinds } else { Vec::new() };
        kinds.into_iter().map(move |kind| Column::new(kind, prior))
    };
    each.into_iter().flat_map(columns).collect()
}

/// Steps of the offset's walk in one stretch, where it is fitted.
pub(crate) const STEPS: usize = 20;
/// Shortest of them, in units of the rate: the body turns by less.
const SHORTEST: f64 = 0.5;

/// The columns of a random walk of the offsets, whose standard deviation after a unit of time is `walk`: in each stretch
/// at most `most` steps of a line from knot to knot, which are independent.
pub(crate) fn walk_columns(stretches: &[Stretch], walk: f64, most: usize) -> Vec<Column> {
    let mut columns = Vec::new();
    for stretch in stretches {
        let (Some(first), duration) = (stretch.times.first(), stretch.duration()) else { continue };
        let steps = ((duration / SHORTEST) as usize).clamp(1, most);
        let width = duration / steps as f64;
        for step in 0..steps {
            let from = first + step as f64 * width;
            let walks = (0..3).map(|axis| Kind::Walk { axis, from, until: from + width });
            let prior = Some(walk * width.sqrt());
            columns.extend(walks.map(|kind| Column { kind, prior, segment: Some(stretch.index) }));
        }
    }
    columns
}

/// The change of P with an error of scale or alignment, which is that of ω = P y.
pub(crate) fn distortion(kind: Kind) -> Option<Matrix3<f64>> {
    match kind {
        Kind::Scale => Some(Matrix3::identity()),
        Kind::AxisScale(k) => Some(symmetric(k)),
        // xy has z as its third axis, and so on
        Kind::Misalignment(third) => Some(symmetric(5 - third) * 0.5),
        _ => None,
    }
}

/// Torque and sensor at `unknowns`, of the columns that act on a stretch.
pub(crate) fn terms_of(columns: &[Column], unknowns: &Unknowns, stretch: &Stretch) -> Terms {
    let mut terms = Terms::at(tensor(&unknowns.x));
    let acting = columns.iter().zip(&unknowns.c).filter(|(column, _)| column.acts_on(stretch));
    for (column, &value) in acting {
        match column.kind {
            Kind::Drag => terms.drag += value,
            Kind::Quadratic => terms.quadratic += value,
            // to first order, in its own column
            Kind::Walk { .. } => {}
            Kind::Viscous(k) => terms.viscous += symmetric(k) * value,
            Kind::Constant(k) => terms.constant[k] += value,
            Kind::Offset(k) => terms.offset[k] += value,
            Kind::Skew(k) => terms.skew[k] += value,
            Kind::Input => terms.input += value,
            kind => terms.sensor += distortion(kind).unwrap_or_else(Matrix3::zeros) * value,
        }
    }
    terms.viscous += terms.j * terms.drag;
    terms
}

/// Name and unit of an unknown, and the power of the unit rate that it goes with.
pub(crate) fn named(kind: Kind) -> (&'static str, &'static str, i32) {
    let of = |names: [&'static str; 6], k: usize| names[k.min(5)];
    match kind {
        Kind::Drag => ("drag", "1/s", 1),
        Kind::Viscous(k) => {
            (of(["drag_xx", "drag_yy", "drag_zz", "drag_xy", "drag_xz", "drag_yz"], k), "1/s", 1)
        }
        Kind::Quadratic => ("quadratic_drag", "1/rad", 0),
        Kind::Walk { axis, .. } => (of(["walk_x", "walk_y", "walk_z", "", "", ""], axis), "rad/s", 1),
        Kind::Rotor(k) => (of(["wheel_x", "wheel_y", "wheel_z", "", "", ""], k), "of |L|", 0),
        Kind::Constant(k) => (of(["torque_x", "torque_y", "torque_z", "", "", ""], k), "rad/s^2", 2),
        Kind::Offset(k) => (of(["offset_x", "offset_y", "offset_z", "", "", ""], k), "rad/s", 1),
        Kind::Scale => ("scale", "", 0),
        Kind::AxisScale(k) => (of(["scale_x", "scale_y", "scale_z", "", "", ""], k), "", 0),
        Kind::Misalignment(k) => {
            (of(["misalignment_yz", "misalignment_xz", "misalignment_xy", "", "", ""], k), "rad", 0)
        }
        Kind::Skew(k) => (of(["skew_x", "skew_y", "skew_z", "", "", ""], k), "s", -1),
        Kind::Input => ("inverse_trace", "1/(kg m^2)", 0),
    }
}

/// Whether an unknown is a torque rather than an error of the sensor.
pub(crate) fn is_torque(column: &Column) -> bool {
    is_drag(column) || matches!(column.kind, Kind::Constant(_))
}

/// Whether it is a coefficient of drag, which takes energy.
pub(crate) fn is_drag(column: &Column) -> bool {
    matches!(column.kind, Kind::Drag | Kind::Viscous(_) | Kind::Quadratic)
}

/// The factor from the fit's units to SI of an unknown; `rms` is the unit rate, rad/s.
pub(crate) fn unit(kind: Kind, rms: f64) -> f64 {
    match named(kind).2 {
        2 => rms * rms,
        1 => rms,
        -1 => 1.0 / rms,
        _ => 1.0,
    }
}

/// The columns of a torque.
pub(crate) fn columns_of(model: TorqueModel) -> Vec<Column> {
    let flat = |kind| Column::new(kind, None);
    match model {
        TorqueModel::None | TorqueModel::Auto => Vec::new(),
        TorqueModel::Drag => vec![flat(Kind::Drag)],
        TorqueModel::Drag3 => (0..3).map(Kind::Viscous).map(flat).collect(),
        TorqueModel::Drag6 => (0..6).map(Kind::Viscous).map(flat).collect(),
        TorqueModel::Quadratic => vec![flat(Kind::Quadratic)],
        TorqueModel::Constant => (0..3).map(Kind::Constant).map(flat).collect(),
    }
}
