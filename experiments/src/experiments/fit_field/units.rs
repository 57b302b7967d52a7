//! Records in other units than they are read in, and with a mirrored axis, under torque noise.
//!
//! What is counted, fixed before the first count:
//! - *right*: a record in the units in which it is read. It is *refused* where a refusal blames the units or the sampling,
//!   *open* where an answer says that the record cannot tell its units, *other* where it is refused for another reason.
//! - *wrong*: the same with rate × time off by the factor of one of the common products. It is *caught* where the units or the
//!   sampling are blamed, *open* and *other* as above, and *silent* where an answer says no word of the units.
//! - *mirrored*: the same with one axis reversed. It is *named* where an answer carries the line of the mirror and that is the true
//!   body, each moment within five of its deviations and a hundredth of the trace; *unnamed* where it does not.
//!
//! Rates alone are scaled: a fit knows only the product of rate and time.

use nalgebra::Vector3;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode::units::RateUnit;
use polhode_files::error::{Error, unexpected};
use polhode_fit::{
    Disturbances, FitError, Gyroscope, Record, Settings, UnitProduct, Warning, fit, simulate_with,
};
use polhode_pages::table::{Column, Table, row};

use crate::experiment::Context;
use crate::experiments::tensors::{random_rotation, tensor_along};

const SEED: u64 = 350_035;
/// Torque noise over a third of the trace, rad/s² √s: that of tosses in air is 1e-2 to 6e-2.
const TORQUE_NOISES: [f64; 5] = [0.0, 1e-3, 1e-2, 3e-2, 6e-2];
/// Rate, rad/s, and noise of a component of its readings.
const RATE: f64 = 12.0;
const NOISE: f64 = 1e-2;

/// A toss of a body that nobody chose.
struct Toss {
    times: Vec<f64>,
    rates: Vec<Vector3<f64>>,
    moments: [f64; 3],
}

fn toss(level: usize, k: u64) -> Result<Toss, Error> {
    let mut random = Random::new(SEED).stream(((level as u64) << 32) + k);
    // moments by the principal second moments of mass, so that every body is possible
    let second = Vector3::from_fn(|_, _| 0.02 + random.uniform());
    let moments =
        Vector3::new(second.y + second.z, second.x + second.z, second.x + second.y) / (2.0 * second.sum());
    let j = tensor_along(&random_rotation(&mut random), moments);
    let body = Inertia::from_tensor(j).map_err(unexpected)?;
    let samples = [100, 200, 300][(k % 3) as usize];
    let times: Vec<f64> = (0..=samples).map(|i| f64::from(i) / 100.0).collect();
    let drag = if k.is_multiple_of(2) { 0.0 } else { 1e-2 };
    let acting =
        Disturbances::default().with_relative_drag(drag).with_torque_noise(TORQUE_NOISES[level] / 3.0);
    let sensor = Gyroscope::default()
        .with_noise(NOISE)
        .with_axis_scales(random.normal_vector() * 5e-3)
        .with_misalignment(random.normal_vector() * 5e-3);
    let omega = random.normal_vector().normalize() * RATE;
    let rates = simulate_with(&body, omega, &times, &acting, &sensor, &mut random).map_err(unexpected)?;
    let mut moments: [f64; 3] = moments.into();
    moments.sort_by(f64::total_cmp);
    Ok(Toss { times, rates, moments })
}

/// What became of one record.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Outcome {
    Blamed,
    Other,
    Open,
    /// An answer without a word on the units, and whether it names the true body as its mirror.
    Answered(bool),
}

fn outcome(toss: &Toss, of_rate: impl Fn(&Vector3<f64>) -> Vector3<f64>) -> Result<Outcome, Error> {
    let rates: Vec<Vector3<f64>> = toss.rates.iter().map(of_rate).collect();
    let record = Record::from_samples(&toss.times, &rates).map_err(unexpected)?;
    Ok(match fit(&record, &Settings::default()) {
        Err(FitError::Units { .. } | FitError::Undersampled { .. }) => Outcome::Blamed,
        Err(_) => Outcome::Other,
        Ok(estimate) if estimate.warnings.iter().any(|w| matches!(w, Warning::Units { .. })) => Outcome::Open,
        Ok(estimate) => {
            let named = estimate.mirror.as_ref().is_some_and(|mirror| {
                let own = mirror.principal_moments();
                let largest = estimate.sigma_principal.iter().copied().fold(0.0, f64::max);
                // the derivatives of the map to the mirror are of order one
                (0..3).all(|k| (own[k] - toss.moments[k]).abs() < 5.0 * largest + 1e-2)
            });
            Outcome::Answered(named)
        }
    })
}

/// One record: itself, mirrored, or in the units of a product.
#[derive(Clone, Copy)]
enum Kind {
    Right,
    Mirrored,
    Wrong(f64),
}

/// Whether a record is of a kind.
type Is = fn(&Kind) -> bool;

/// Counts of each kind at each level of torque noise, and what should not have happened.
pub(super) fn table(context: &Context) -> Result<(Table, Vec<String>), Error> {
    let (right, wrong, every) = context.scale.pick((2, 1, 12), (2, 1, 12), (250, 10, 1));
    let products = UnitProduct::common(RateUnit::RadiansPerSecond);
    let kinds = |k: u64| {
        let others = products.iter().step_by(every).filter(move |_| k < wrong);
        [Kind::Right, Kind::Mirrored].into_iter().chain(others.map(|p| Kind::Wrong(p.factor)))
    };
    let parts: Vec<(usize, u64, Kind)> = (0..TORQUE_NOISES.len())
        .flat_map(|level| (0..right).map(move |k| (level, k)))
        .flat_map(|(level, k)| kinds(k).map(move |kind| (level, k, kind)).collect::<Vec<_>>())
        .collect();
    let outcomes = context.in_parallel(parts.clone(), |(level, k, kind)| {
        let toss = toss(level, k)?;
        match kind {
            Kind::Right => outcome(&toss, |w| *w),
            Kind::Mirrored => outcome(&toss, |w| Vector3::new(w.x, -w.y, w.z)),
            Kind::Wrong(factor) => outcome(&toss, |w| w / factor),
        }
    });
    let outcomes = outcomes.into_iter().collect::<Result<Vec<Outcome>, Error>>()?;
    let caption = format!(
        "Tosses of 1 to 3 s at 100 Hz and {RATE} rad/s in right units, with one axis reversed, and in {} other products of units.",
        products.iter().step_by(every).count()
    );
    let mut table = Table::new("units", caption, columns());
    let mut failures = Vec::new();
    for (level, torque_noise) in TORQUE_NOISES.into_iter().enumerate() {
        let count = |is_kind: &dyn Fn(&Kind) -> bool, is_outcome: &dyn Fn(Outcome) -> bool| {
            let each = parts.iter().zip(&outcomes);
            each.filter(|((l, _, kind), o)| *l == level && is_kind(kind) && is_outcome(**o)).count() as u64
        };
        let kinds: [(&str, Is); 3] = [
            ("right", |k| matches!(k, Kind::Right)),
            ("mirrored", |k| matches!(k, Kind::Mirrored)),
            ("wrong", |k| matches!(k, Kind::Wrong(_))),
        ];
        for (name, is_kind) in kinds {
            let of = |is_outcome: &dyn Fn(Outcome) -> bool| count(&is_kind, is_outcome);
            let (blamed, unnamed) = (of(&|o| o == Outcome::Blamed), of(&|o| o == Outcome::Answered(false)));
            let answered = of(&|o| matches!(o, Outcome::Answered(_)));
            table.push(row![
                name,
                torque_noise,
                of(&|_| true),
                blamed,
                of(&|o| o == Outcome::Other),
                of(&|o| o == Outcome::Open),
                answered,
                if name == "mirrored" { Some(answered - unnamed) } else { None },
            ]);
            let mut say = |what: String| failures.push(format!("torque noise {torque_noise}: {what}"));
            match name {
                "wrong" if answered > 0 => say(format!("{answered} wrong units answered silently")),
                "right" if blamed > 0 => say(format!("{blamed} right units refused")),
                "mirrored" if unnamed > 0 => {
                    say(format!("{unnamed} mirrored records whose mirror is not the body"))
                }
                _ => {}
            }
        }
    }
    Ok((table, failures))
}

fn columns() -> Vec<Column> {
    vec![
        Column::new("units", "", "whether the record is in the units in which it is read"),
        Column::new("torque_noise", "rad/s^2 s^1/2", "torque noise over a third of the trace")
            .heading("torque noise"),
        Column::new("records", "", "how many"),
        Column::new("blamed", "", "refused because of units or sampling"),
        Column::new("other", "", "refused for another reason"),
        Column::new("open", "", "answers that say that the record cannot tell its units"),
        Column::new("answered", "", "answers without a word on the units"),
        Column::new("named", "", "of these, those whose line of left-handed axes is the true body")
            .heading("mirror named"),
    ]
}
