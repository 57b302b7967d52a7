//! The mistakes that are tested, and how each is undone.

use core::fmt;

use nalgebra::Matrix3;

use super::{Evidence, check_symmetric, parallel_axis_term};
use crate::rotation::AXES;

/// One of the six entries of a symmetric tensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry(usize, usize);

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "I_{}{}", AXES[self.0], AXES[self.1])
    }
}

const XX: Entry = Entry(0, 0);
const YY: Entry = Entry(1, 1);
const ZZ: Entry = Entry(2, 2);
const XY: Entry = Entry(0, 1);
const XZ: Entry = Entry(0, 2);
const YZ: Entry = Entry(1, 2);
/// The order of this project's lists.
const ENTRIES: [Entry; 6] = [XX, YY, ZZ, XY, XZ, YZ];

/// A mistake that spoils a tensor.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Cause {
    /// Products +∫ x y dm stand where the entries −∫ x y dm belong.
    ProductSigns,
    /// A moment is typed with a minus.
    NegativeMoments,
    /// Of a pair across the diagonal one is wrong.
    HalfPair {
        /// The pair.
        entry: Entry,
        /// Whether the one above the diagonal is right.
        upper: bool,
    },
    /// The tensor is about the origin, not about the centre of mass.
    AboutOrigin,
    /// The parallel-axis term was subtracted from a tensor that was about the centre of mass already.
    SubtractedTwice,
    /// The tensor is in another unit.
    Unit {
        /// Its name.
        name: &'static str,
        /// How many kg m² it is.
        factor: f64,
    },
    /// The tensor was converted from a unit it never had.
    ConvertedTwice {
        /// Name of the unit.
        name: &'static str,
        /// How many kg m² it is.
        factor: f64,
    },
    /// The tensor is divided by the mass.
    PerMass,
    /// The six numbers are in another order.
    Order(&'static str),
    /// Two entries are exchanged.
    Swapped(Entry, Entry),
    /// An entry is off by a power of ten.
    DecimalSlip {
        /// The entry.
        entry: Entry,
        /// It is 10 to this power times too large.
        power: i32,
    },
    /// The products have not the signs that the mirrored twin asks for.
    MirroredTwin {
        /// The axis that is reversed between the two.
        axis: char,
    },
    /// The second moments ∫ x_j x_k dm, the covariance of the mass, stand where the inertia belongs.
    SecondMoments,
}

impl Cause {
    /// A word for programs.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Cause::ProductSigns => "product-signs",
            Cause::NegativeMoments => "negative-moments",
            Cause::HalfPair { .. } => "half-pair",
            Cause::AboutOrigin | Cause::SubtractedTwice => "another-point",
            Cause::Unit { .. } | Cause::ConvertedTwice { .. } => "unit",
            Cause::PerMass => "per-mass",
            Cause::Order(_) => "entry-order",
            Cause::Swapped(..) => "swapped-entries",
            Cause::DecimalSlip { .. } => "decimal-slip",
            Cause::MirroredTwin { .. } => "mirrored-twin",
            Cause::SecondMoments => "second-moments",
        }
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Cause::ProductSigns => {
                write!(f, "the products have the other sign: +int xy dm instead of I_xy = -int xy dm")
            }
            Cause::NegativeMoments => write!(f, "a moment on the diagonal has a minus sign"),
            Cause::HalfPair { entry, upper } => {
                let (right, wrong) = if *upper { ("above", "below") } else { ("below", "above") };
                write!(
                    f,
                    "the two entries {entry} differ: the one {wrong} the diagonal is wrong, the one {right} it is right"
                )
            }
            Cause::AboutOrigin => {
                write!(f, "taken about the origin, not about the centre of mass: subtract M (R^2 1 - R R^T)")
            }
            Cause::SubtractedTwice => write!(
                f,
                "already taken about the centre of mass, yet M (R^2 1 - R R^T) was subtracted: add it"
            ),
            Cause::Unit { name, factor } => {
                write!(f, "in {name}, not in kg m^2: multiply by {factor:e}")
            }
            Cause::ConvertedTwice { name, factor } => {
                write!(f, "already in kg m^2, yet converted from {name}: divide by {factor:e}")
            }
            Cause::PerMass => write!(f, "divided by the mass: squares of radii of gyration, not moments"),
            Cause::Order(order) => write!(f, "the six numbers are in the order {order}"),
            Cause::Swapped(a, b) => write!(f, "{a} and {b} are exchanged"),
            Cause::DecimalSlip { entry, power } => {
                let (size, zeros) = if *power > 0 { ("large", power) } else { ("small", &-power) };
                let times = 10_u64.pow(zeros.unsigned_abs());
                write!(f, "{entry} is {times} times too {size}: a decimal slip")
            }
            Cause::MirroredTwin { axis } => {
                write!(f, "the signs of the products do not match those of its mirror image along {axis}")
            }
            Cause::SecondMoments => {
                write!(f, "second moments int x_j x_k dm (a covariance), not inertia: I = tr(J) 1 - J")
            }
        }
    }
}

/// Units of inertia that tools write: name, kg m², and how rare they are.
const UNITS: [(&str, f64, f64); 6] = [
    ("kg mm^2", 1e-6, 1.0),
    ("g mm^2", 1e-9, 1.5),
    ("g cm^2", 1e-7, 2.5),
    ("kg cm^2", 1e-4, 2.5),
    ("lb in^2", 2.926_396_534_292e-4, 3.0),
    ("lb ft^2", 4.214_011_009_380_48e-2, 3.0),
];

/// Orders in which tools list six entries, and how rare their confusion with this project's order is.
const ORDERS: [(&str, [Entry; 6], f64); 4] = [
    ("xx, xy, xz, yy, yz, zz", [XX, XY, XZ, YY, YZ, ZZ], 2.0),
    ("xx, xy, yy, xz, yz, zz", [XX, XY, YY, XZ, YZ, ZZ], 2.5),
    ("xx, yy, zz, yz, xz, xy", [XX, YY, ZZ, YZ, XZ, XY], 2.5),
    ("xx, yy, zz, xy, yz, xz", [XX, YY, ZZ, XY, YZ, XZ], 2.5),
];

/// Every mistake with the tensor before it was made and the rareness of the mistake.
pub(super) fn candidates(given: &Matrix3<f64>, evidence: &Evidence) -> Vec<(Cause, Matrix3<f64>, f64)> {
    if check_symmetric(given).is_err() {
        return half_pairs(given);
    }
    let mut found = Vec::new();
    let products = [XY, XZ, YZ];
    if products.iter().any(|&entry| get(given, entry) != 0.0) {
        let flipped = products.iter().fold(*given, |tensor, &entry| set(tensor, entry, -get(given, entry)));
        found.push((Cause::ProductSigns, flipped, 1.0));
    }
    let diagonal = [XX, YY, ZZ];
    if diagonal.iter().any(|&entry| get(given, entry) < 0.0) {
        let positive =
            diagonal.iter().fold(*given, |tensor, &entry| set(tensor, entry, get(given, entry).abs()));
        found.push((Cause::NegativeMoments, positive, 1.0));
    }
    if let Some(term) = parallel_axis_term(evidence) {
        found.push((Cause::AboutOrigin, given - term, 1.5));
        found.push((Cause::SubtractedTwice, given + term, 3.0));
    }
    if let Some(mass) = evidence.mass {
        // without a mass no size is wrong
        for (name, factor, rareness) in UNITS {
            found.push((Cause::Unit { name, factor }, given * factor, rareness));
            found.push((Cause::ConvertedTwice { name, factor }, given / factor, rareness + 2.0));
        }
        found.push((Cause::PerMass, given * mass, 3.0));
    }
    for (name, order, rareness) in ORDERS {
        let read = assemble(|k| (order[k], get(given, ENTRIES[k])));
        let written = assemble(|k| (ENTRIES[k], get(given, order[k])));
        found.push((Cause::Order(name), read, rareness));
        if written != read {
            found.push((Cause::Order("xx, yy, zz, xy, xz, yz"), written, rareness + 0.5));
        }
    }
    for (k, &a) in ENTRIES.iter().enumerate() {
        for &b in &ENTRIES[k + 1..] {
            let alike = (a.0 == a.1) == (b.0 == b.1);
            let swapped = set(set(*given, a, get(given, b)), b, get(given, a));
            found.push((Cause::Swapped(a, b), swapped, if alike { 3.0 } else { 4.0 }));
        }
    }
    for entry in ENTRIES {
        for (power, ten, rareness) in [(1, 10.0, 3.5), (2, 100.0, 4.5), (3, 1000.0, 5.5)] {
            let value = get(given, entry);
            found.push((Cause::DecimalSlip { entry, power }, set(*given, entry, value / ten), rareness));
            let power = -power;
            found.push((Cause::DecimalSlip { entry, power }, set(*given, entry, value * ten), rareness));
        }
    }
    let second = Matrix3::identity() * given.trace() - given;
    found.push((Cause::SecondMoments, second, 5.0));
    found.retain(|(_, corrected, _)| corrected != given);
    found
}

/// One of the two entries of each unequal pair is right; the one that agrees in size, or keeps the body valid.
fn half_pairs(given: &Matrix3<f64>) -> Vec<(Cause, Matrix3<f64>, f64)> {
    let wrong: Vec<Entry> =
        [XY, XZ, YZ].into_iter().filter(|e| given[(e.0, e.1)] != given[(e.1, e.0)]).collect();
    let Some(&entry) = wrong.first() else { return Vec::new() };
    let side = |upper: bool| {
        let pick =
            |tensor, e: &Entry| set(tensor, *e, if upper { given[(e.0, e.1)] } else { given[(e.1, e.0)] });
        wrong.iter().fold(*given, pick)
    };
    [true, false].map(|upper| (Cause::HalfPair { entry, upper }, side(upper), 1.0)).into()
}

fn get(tensor: &Matrix3<f64>, Entry(j, k): Entry) -> f64 {
    tensor[(j, k)]
}

fn set(mut tensor: Matrix3<f64>, Entry(j, k): Entry, value: f64) -> Matrix3<f64> {
    tensor[(j, k)] = value;
    tensor[(k, j)] = value;
    tensor
}

fn assemble(entry: impl Fn(usize) -> (Entry, f64)) -> Matrix3<f64> {
    (0..6).map(entry).fold(Matrix3::zeros(), |tensor, (place, value)| set(tensor, place, value))
}
