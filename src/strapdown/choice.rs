//! The rule for a record: the one that leaves the least error, with its noise.

use nalgebra::{UnitQuaternion, Vector3};

use super::budget::{Budgeted, Estimate};
use super::error::StrapdownError;
use super::rule::Rule;
use super::{Kind, Sensor};

/// Orders and samples that are tried, the plainest first.
const CANDIDATES: [(u32, usize); 6] = [(2, 2), (4, 4), (4, 6), (6, 6), (6, 8), (6, 10)];

/// Samples that a choice looks at.
const LOOKED_AT: usize = 1000;

/// Attitudes with budgets at all samples, by `rule` from the attitude `start` at the first.
///
/// # Errors
/// As [`Budgeted`]; lists of different lengths, no samples.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::strapdown::{Kind, Rule, Sensor, attitudes};
/// let times: Vec<f64> = (0..=10).map(|k| 0.1 * f64::from(k)).collect();
/// let (rates, start) = (vec![Vector3::z(); times.len()], UnitQuaternion::identity());
/// let found = attitudes(&times, &rates, Kind::Rate, Rule::magnus(4, 4)?, start, Sensor::default())?;
/// let last = found.last().ok_or("there are samples")?;
/// // 1 s at 1 rad/s
/// assert!(last.error(UnitQuaternion::from_scaled_axis(Vector3::z())).norm() < 1e-14);
/// # Ok::<(), polhode::Error>(())
/// ```
pub fn attitudes(
    times: &[f64],
    readings: &[Vector3<f64>],
    kind: Kind,
    rule: Rule,
    start: UnitQuaternion<f64>,
    sensor: Sensor,
) -> Result<Vec<Estimate>, StrapdownError> {
    let mut all = Vec::with_capacity(times.len());
    along(times, readings, kind, rule, start, sensor, |estimate| all.push(*estimate))?;
    Ok(all)
}

fn along(
    times: &[f64],
    readings: &[Vector3<f64>],
    kind: Kind,
    rule: Rule,
    start: UnitQuaternion<f64>,
    sensor: Sensor,
    mut each: impl FnMut(&Estimate),
) -> Result<(), StrapdownError> {
    if times.len() != readings.len() {
        return Err(StrapdownError::Lengths { times: times.len(), readings: readings.len() });
    }
    if times.is_empty() {
        return Err(StrapdownError::Empty);
    }
    let mut budgeted = Budgeted::new(kind, rule, start, sensor)?;
    for (time, reading) in times.iter().zip(readings) {
        budgeted.push(*time, *reading)?.iter().for_each(&mut each);
    }
    budgeted.finish().iter().for_each(each);
    Ok(())
}

/// The Magnus rule that leaves these readings the least error: of orders 2, 4 and 6 (or of `order` alone) and some numbers of samples
/// (or of `samples` alone), the one with the least mean of truncation² + 3 random walk², the variance of all three
/// components, over its first 1000 samples.
///
/// A wide polynomial follows a fast motion better, and amplifies noise where the body turns far between samples.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::strapdown::{Kind, Sensor, choose};
/// let times: Vec<f64> = (0..500).map(|k| 0.05 * f64::from(k)).collect();
/// let rates: Vec<_> = times.iter().map(|t| Vector3::new(libm::sin(3.0 * t), libm::cos(3.0 * t), 0.5)).collect();
/// let silent = choose(&times, &rates, Kind::Rate, None, None, Sensor::default())?;
/// assert!(silent.to_string().starts_with("magnus:6,"));
/// // of order 4
/// let fourth = choose(&times, &rates, Kind::Rate, Some(4), None, Sensor::default())?;
/// assert!(fourth.to_string().starts_with("magnus:4,"));
/// # Ok::<(), polhode::Error>(())
/// ```
///
/// # Errors
/// As [`attitudes`]; an order or a number of samples that no rule has.
pub fn choose(
    times: &[f64],
    readings: &[Vector3<f64>],
    kind: Kind,
    order: Option<u32>,
    samples: Option<usize>,
    sensor: Sensor,
) -> Result<Rule, crate::Error> {
    let mut rules = Vec::new();
    match (order, samples) {
        (Some(order), Some(samples)) => rules.push(Rule::magnus(order, samples)?),
        (None, Some(samples)) => {
            // the highest order that these samples allow, and those below
            let orders = [2, 4, 6].into_iter().filter(|order| *order as usize <= samples);
            for order in orders {
                rules.push(Rule::magnus(order, samples)?);
            }
            if rules.is_empty() {
                rules.push(Rule::magnus(2, samples)?);
            }
        }
        (order, None) => {
            let wanted = |candidate: &&(u32, usize)| order.is_none_or(|order| order == candidate.0);
            for (order, samples) in CANDIDATES.iter().filter(wanted) {
                rules.push(Rule::magnus(*order, *samples)?);
            }
            if let (true, Some(order)) = (rules.is_empty(), order) {
                rules.push(Rule::magnus(order, order as usize)?);
            }
        }
    }
    let [first, others @ ..] = &rules[..] else { return Err(StrapdownError::Empty.into()) };
    if others.is_empty() {
        return Ok(*first);
    }
    let some = times.len().min(readings.len()).min(LOOKED_AT);
    let noise = Sensor::default().with_noise(sensor.noise);
    let mut best = (f64::INFINITY, *first);
    for rule in &rules {
        let mut sum = 0.0;
        along(
            &times[..some],
            &readings[..some],
            kind,
            *rule,
            UnitQuaternion::identity(),
            noise,
            |estimate| {
                sum += estimate.budget.covariance.trace();
            },
        )?;
        if sum < best.0 {
            best = (sum, *rule);
        }
    }
    Ok(best.1)
}
