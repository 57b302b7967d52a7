//! The equations of all records in all unknowns: carrier, object, wheel, errors of the sensor, proof bodies.

use nalgebra::{DMatrix, DVector, Matrix3};

use crate::carrier::start::{Start, of_entries, slope_of_shape};
use crate::carrier::told::Told;
use crate::physical::coordinates::{ENTRIES, coordinates, symmetric};
use crate::physical::nearest::Normal;

/// One record in the joint equations.
pub(super) struct Part {
    pub(super) told: Told,
    pub(super) has_object: bool,
    /// What the proof body adds, kg m².
    pub(super) added: Matrix3<f64>,
    /// Standard deviations of its entries, where they are unknowns, and the place of the first of these, in deviations.
    pub(super) uncertain: Option<(usize, [f64; 6])>,
}

/// All of them. The unknowns stand in the order: errors of the sensor, in standard deviations of their priors; entries of uncertain
/// proof bodies, in standard deviations; the wheel; the object; the carrier, each in a unit of its own.
pub(super) struct System {
    pub(super) parts: Vec<Part>,
    /// Standard deviations of the priors of the errors of the sensor, SI.
    pub(super) priors: Vec<f64>,
    /// Places of the first entries, and units, kg m².
    pub(super) wheel: Option<(usize, f64)>,
    pub(super) object: Option<(usize, f64)>,
    pub(super) carrier: (usize, f64),
}

impl System {
    /// The unknowns laid out, each in a unit of the size where it starts, and that start.
    pub(super) fn new(mut parts: Vec<Part>, priors: Vec<f64>, start: &Start) -> (System, DVector<f64>) {
        let mut next = priors.len();
        let mut place = |count: usize| {
            next += count;
            next - count
        };
        for (first, _) in parts.iter_mut().filter_map(|part| part.uncertain.as_mut()) {
            *first = place(6);
        }
        let unit = |size: f64| if size.is_normal() { size } else { start.carrier.trace() };
        let wheel = start.wheel.map(|wheel| (place(1), unit(wheel.abs())));
        let object = start.object.map(|object| (place(6), unit(object.norm())));
        let carrier = (place(6), start.carrier.trace());
        let mut z = DVector::zeros(next);
        if let (Some((k, unit)), Some(value)) = (wheel, start.wheel) {
            z[k] = value / unit;
        }
        for (placed, body) in [(object, start.object), (Some(carrier), Some(start.carrier))] {
            if let (Some((first, unit)), Some(body)) = (placed, body) {
                ENTRIES.iter().enumerate().for_each(|(k, entry)| z[first + k] = body[*entry] / unit);
            }
        }
        (System { parts, priors, wheel, object, carrier }, z)
    }

    /// A tensor whose entries begin at a place, kg m².
    pub(super) fn body(&self, (first, unit): (usize, f64), z: &DVector<f64>) -> Matrix3<f64> {
        of_entries(&z.as_slice()[first..first + 6]) * unit
    }

    /// What tumbles in a record, kg m².
    fn tensor(&self, part: &Part, z: &DVector<f64>) -> Matrix3<f64> {
        let mut all = self.body(self.carrier, z) + part.added;
        if let Some(object) = self.object.filter(|_| part.has_object) {
            all += self.body(object, z);
        }
        if let Some((first, sigmas)) = &part.uncertain {
            let off: Vec<f64> = sigmas.iter().enumerate().map(|(k, sigma)| sigma * z[first + k]).collect();
            all += of_entries(&off);
        }
        all
    }

    /// The readings of a record at `z`; `None` where nothing has such a tensor.
    pub(super) fn readings(&self, part: &Part, z: &DVector<f64>) -> Option<DVector<f64>> {
        let tensor = self.tensor(part, z);
        let trace = tensor.trace();
        if !(trace > 0.0 && trace.is_finite()) {
            return None;
        }
        let sensor = self.priors.iter().zip(z.iter()).map(|(prior, z)| prior * z);
        let wheel = self.wheel.map_or(1.0, |(k, unit)| unit * z[k]);
        let inverse = part.told.has_input.then_some(wheel / trace);
        let x = coordinates(&(tensor / trace));
        let all = sensor.chain(inverse).chain(x.iter().copied());
        Some(DVector::from_iterator(part.told.right.len(), all))
    }

    /// Their derivatives.
    fn slopes(&self, part: &Part, z: &DVector<f64>, readings: &DVector<f64>) -> DMatrix<f64> {
        let (sensors, first) = (self.priors.len(), readings.len() - 5);
        let trace = self.tensor(part, z).trace();
        let x = readings.fixed_rows::<5>(first).into_owned();
        let of_shape = slope_of_shape(&x, trace);
        let mut slopes = DMatrix::zeros(readings.len(), z.len());
        self.priors.iter().enumerate().for_each(|(k, prior)| slopes[(k, k)] = *prior);
        let mut by_entry = |place: usize, entry: usize, unit: f64| {
            slopes.view_mut((first, place), (5, 1)).copy_from(&(of_shape.column(entry) * unit));
            if part.told.has_input {
                slopes[(sensors, place)] = -readings[sensors] / trace * symmetric(entry).trace() * unit;
            }
        };
        let bodies = [Some(self.carrier), self.object.filter(|_| part.has_object)];
        for (place, unit) in bodies.into_iter().flatten() {
            (0..6).for_each(|entry| by_entry(place + entry, entry, unit));
        }
        if let Some((place, sigmas)) = &part.uncertain {
            (0..6).for_each(|entry| by_entry(place + entry, entry, sigmas[entry]));
        }
        if let Some((place, unit)) = self.wheel.filter(|_| part.told.has_input) {
            slopes[(sensors, place)] = unit / trace;
        }
        slopes
    }

    /// Unknowns that have a standard normal prior: the first ones.
    fn known(&self) -> usize {
        self.priors.len() + 6 * self.parts.iter().filter(|part| part.uncertain.is_some()).count()
    }

    /// Sum of squares at `z`.
    pub(super) fn squares(&self, z: &DVector<f64>) -> Option<f64> {
        let each = self.parts.iter().map(|part| {
            let readings = self.readings(part, z)?;
            Some((&part.told.root * readings + &part.told.right).norm_squared())
        });
        Some(each.sum::<Option<f64>>()? + z.rows(0, self.known()).norm_squared())
    }

    /// The equations linearised at `z`: their normal distribution.
    pub(super) fn linearised(&self, z: &DVector<f64>) -> Option<Normal> {
        let (size, known) = (z.len(), self.known());
        let rows: usize = self.parts.iter().map(|part| part.told.right.len()).sum();
        // no fewer rows than columns, so that the triangle is whole
        let mut stack = DMatrix::zeros((rows + known).max(size + 1), size + 1);
        let mut next = 0;
        for part in &self.parts {
            let readings = self.readings(part, z)?;
            let slopes = &part.told.root * self.slopes(part, z, &readings);
            let count = slopes.nrows();
            stack.view_mut((next, 0), (count, size)).copy_from(&slopes);
            let left = &part.told.root * readings + &part.told.right;
            stack.view_mut((next, size), (count, 1)).copy_from(&left);
            next += count;
        }
        for k in 0..known {
            stack[(next + k, k)] = 1.0;
            stack[(next + k, size)] = z[k];
        }
        let r = stack.qr().r();
        let root = r.view((0, 0), (size, size)).into_owned();
        let step = root.solve_upper_triangular(&-r.view((0, size), (size, 1)).column(0).into_owned())?;
        let finite = step.iter().chain(&root).all(|v| v.is_finite());
        finite.then(|| Normal { centre: z + step, root })
    }

    /// Readings beyond the unknowns without a prior.
    pub(super) fn dof(&self, unknowns: usize) -> usize {
        let readings: usize = self.parts.iter().map(|part| part.told.right.len()).sum();
        (readings + self.known()).saturating_sub(unknowns)
    }
}
