//! How often a mistake in a tensor is noticed, and how often its true cause is named first.

use nalgebra::{Matrix3, Vector3};
use polhode::inertia::{Amount, Evidence, MassProperties, Solid, Validity, diagnose};
use polhode::num::Random;
use polhode_files::error::Error;
use polhode_pages::table::{Column, Table, row};

use super::failed;
use crate::experiment::Context;

/// A random body, and what may be known of it.
struct Patient {
    body: MassProperties,
    /// Its tensor about the origin, kg m².
    about_origin: Matrix3<f64>,
    evidence: Evidence,
}

/// A mistake: what the table calls it, the name of the cause that should be found, and what it does to a tensor.
type Mistake = (&'static str, &'static str, fn(&Patient, &mut Random) -> Matrix3<f64>);

const MISTAKES: [Mistake; 12] = [
    ("none", "", |patient, _| patient.body.tensor()),
    ("products with the other sign", "product-signs", |patient, _| {
        let tensor = patient.body.tensor();
        tensor.map_with_location(|j, k, value| if j == k { value } else { -value })
    }),
    ("about the origin", "another-point", |patient, _| patient.about_origin),
    ("parallel-axis term subtracted twice", "another-point", |patient, _| {
        2.0 * patient.body.tensor() - patient.about_origin
    }),
    ("kg mm^2", "unit", |patient, _| patient.body.tensor() * 1e6),
    ("g mm^2", "unit", |patient, _| patient.body.tensor() * 1e9),
    ("six numbers listed by rows", "entry-order", |patient, _| {
        let t = patient.body.tensor();
        Matrix3::new(t.m11, t.m22, t.m23, t.m22, t.m12, t.m33, t.m23, t.m33, t.m13)
    }),
    ("two moments exchanged", "swapped-entries", |patient, random| {
        let (mut tensor, j) = (patient.body.tensor(), random.below(3) as usize);
        let k = (j + 1) % 3;
        tensor.swap((j, j), (k, k));
        tensor
    }),
    ("a moment 10 times too large", "decimal-slip", |patient, random| slipped(patient, random, 10.0)),
    ("a moment 10 times too small", "decimal-slip", |patient, random| slipped(patient, random, 0.1)),
    ("a minus on the diagonal", "negative-moments", |patient, random| slipped(patient, random, -1.0)),
    ("second moments", "second-moments", |patient, _| {
        let tensor = patient.body.tensor();
        Matrix3::identity() * (0.5 * tensor.trace()) - tensor
    }),
];

fn slipped(patient: &Patient, random: &mut Random, factor: f64) -> Matrix3<f64> {
    let (mut tensor, k) = (patient.body.tensor(), random.below(3) as usize);
    tensor[(k, k)] *= factor;
    tensor
}

/// Three to five boxes of ordinary densities, side by side.
fn patient(random: &mut Random) -> Result<Patient, Error> {
    let size = libm::exp(random.between(-4.0, 1.0));
    let mut parts = Vec::new();
    let (mut low, mut high) = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
    for _ in 0..3 + random.below(3) {
        let edges = Vector3::from([(); 3].map(|()| size * random.between(0.1, 1.0)));
        let at = Vector3::from([(); 3].map(|()| size * random.between(-0.5, 0.7)));
        let density = libm::exp(random.between(6.0, 9.0));
        let part = Solid::Box(edges.into()).with(Amount::Density(density)).and_then(|part| part.moved(at));
        parts.push(part.map_err(|error| failed(&error))?);
        (low, high) = (low.inf(&(at - edges * 0.5)), high.sup(&(at + edges * 0.5)));
    }
    let body = MassProperties::sum(parts).map_err(|error| failed(&error))?;
    let about_origin = body.tensor_about(Vector3::zeros()).map_err(|error| failed(&error))?;
    let evidence = Evidence::default()
        .with_mass(body.mass())
        .with_center_of_mass(body.center_of_mass())
        .with_extents(<[f64; 3]>::from(high - low));
    Ok(Patient { body, about_origin, evidence })
}

pub(super) fn rates(context: &Context, random: &Random, failures: &mut Vec<String>) -> Result<Table, Error> {
    let bodies = context.scale.pick(50, 200, 5000);
    let mut table = Table::new(
        "doctor",
        format!(
            "Mistakes made with {bodies} random bodies of three to five boxes: how many are noticed, and in how many the true cause comes first."
        ),
        vec![
            Column::new("mistake", "", "what was done to the tensor"),
            Column::new("known", "", "what was known besides the tensor"),
            Column::new("bodies", "", "number of bodies").hidden(),
            Column::new("noticed", "%", "tensors that were not called valid"),
            Column::new("first", "%", "of those, the true cause first and the tensor restored to 1e-9"),
        ],
    );
    let cells = MISTAKES.iter().flat_map(|mistake| (0..3).map(move |known| (*mistake, known))).collect();
    let counted = context.in_parallel(cells, |((name, word, spoil), known)| {
        // every cell sees the same bodies
        let mut random = random.clone();
        let (mut noticed, mut first, mut condemned) = (0, 0, 0);
        for _ in 0..bodies {
            let patient = patient(&mut random)?;
            let spoiled = spoil(&patient, &mut random);
            let evidence = match known {
                0 => Evidence::default(),
                1 => patient.evidence.with_extents(None),
                _ => patient.evidence,
            };
            let found = diagnose(spoiled, &evidence).map_err(|error| failed(&error))?;
            let truth = patient.body.tensor();
            let right = found.causes.first().is_some_and(|first| {
                first.cause.name() == word && (first.corrected - truth).amax() < 1e-9 * truth.amax()
            });
            noticed += u64::from(found.verdict != Validity::Valid);
            condemned += u64::from(found.verdict == Validity::Invalid);
            first += u64::from(right);
        }
        Ok::<_, Error>((name, known, noticed, first, condemned))
    });
    for counts in counted {
        let (name, known, noticed, first, condemned) = counts?;
        let known = ["nothing", "mass and centre", "and extents"][known];
        if name == "none" && condemned > 0 {
            failures.push(format!("{condemned} of {bodies} sound tensors are called invalid, {known} known"));
        }
        let percent = |part: u64, of: u64| if of == 0 { f64::NAN } else { 100.0 * part as f64 / of as f64 };
        let first = if name == "none" { f64::NAN } else { percent(first, noticed) };
        table.push(row![name, known, bodies as u64, percent(noticed, bodies as u64), first]);
    }
    Ok(table)
}
