//! The joint equations against differences of themselves, and closed forms for records that say everything.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use polhode::inertia::{Inertia, MassProperties};
use polhode::num::Random;
use polhode::record::{Record, Segment};

use crate::carrier::error::CarrierError;
use crate::carrier::estimate::SizeSource;
use crate::carrier::fit_carrier;
use crate::carrier::law::{bodies, is_held, is_physical};
use crate::carrier::least::least;
use crate::carrier::proof::{ProofBody, parallel_axis};
use crate::carrier::records::{Attached, CarrierRecords};
use crate::carrier::start::{Alone, Start, start};
use crate::carrier::system::{Part, System};
use crate::carrier::told::Told;
use crate::columns::effect::Class;
use crate::columns::sets::sensor_columns;
use crate::estimator::{Drawn, fitted};
use crate::physical::coordinates::{ENTRIES, coordinates, symmetric};
use crate::physical::nearest::Normal;
use crate::settings::Settings;
use crate::settings::sensor::SensorPriors;
use crate::settings::torque::TorqueModel;
use crate::simulate::{Disturbances, Gyroscope, simulate_with};

fn carrier() -> Matrix3<f64> {
    Matrix3::new(0.02, 0.002, -0.001, 0.002, 0.03, 0.003, -0.001, 0.003, 0.04)
}

fn object() -> Matrix3<f64> {
    Matrix3::new(0.006, 0.0, 0.001, 0.0, 0.004, 0.0, 0.001, 0.0, 0.007)
}

fn proof() -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(0.015, 0.004, 0.016))
}

/// A record with a wheel, and what it tells beside offsets of the sensor.
fn told(tensor: Matrix3<f64>, settings: &Settings, seed: u64) -> Told {
    Told::new(&drawn(tensor, settings, seed), &[]).unwrap()
}

/// What its estimate was drawn from.
fn drawn(tensor: Matrix3<f64>, settings: &Settings, seed: u64) -> Drawn {
    fitted(&record(tensor, seed), settings).unwrap().drawn.unwrap()
}

fn record(tensor: Matrix3<f64>, seed: u64) -> Record {
    let times: Vec<f64> = (0..400).map(|k| 0.025 * f64::from(k)).collect();
    let wheel = Vector3::new(0.004, -0.002, 0.01);
    let acting = Disturbances::default().with_wheel(wheel).with_relative_drag(0.01);
    let body = Inertia::from_tensor(tensor).unwrap();
    let (omega, gyroscope) = (Vector3::new(1.0, 3.0, 2.0), Gyroscope::default().with_noise(2e-3));
    let rates = simulate_with(&body, omega, &times, &acting, &gyroscope, &mut Random::new(seed)).unwrap();
    let mut record = Record::default();
    let momenta = vec![wheel; times.len()];
    record.segments.push(Segment::new("tumble", times, rates).unwrap().with_wheel(momenta).unwrap());
    record
}

/// By what an estimate may be off beside its noise, its record may be off among others.
#[test]
fn what_widens_an_estimate_widens_what_its_record_tells() {
    let mut drawn = drawn(carrier(), &Settings::default().with_torque(TorqueModel::Drag), 1);
    let size = drawn.weak.columns.len() + 5;
    let covariance = |drawn: &Drawn| {
        let inverse = Told::new(drawn, &[]).unwrap().root.try_inverse().unwrap();
        &inverse * inverse.transpose()
    };
    drawn.beside = DMatrix::zeros(size, 0);
    let before = covariance(&drawn);
    // of torques nothing, which are at their best for the rest
    let off = DMatrix::from_fn(size, 1, |k, _| if k + 5 < size { 0.3 } else { 1e-3 * (k + 6 - size) as f64 });
    drawn.beside = off.clone();
    let of_input = drawn.weak.columns.iter().position(|column| column.class() == Class::Input).unwrap();
    let input = off[(of_input, 0)] / drawn.input.unwrap();
    let readings = std::iter::once(input).chain(off.iter().skip(size - 5).copied());
    let expected = DVector::from_iterator(6, readings);
    let more = covariance(&drawn) - before;
    let expected = &expected * expected.transpose();
    assert!((&more - &expected).amax() < 1e-9 * expected.amax(), "{more} {expected}");
}

/// Readings, their slopes and the linear equations are those of differences; residuals of priors count too.
#[test]
fn joint_equations_are_those_of_differences() {
    let sensor = SensorPriors::default().with_offset(0.01).with_scale(0.02);
    let settings = Settings::default().with_sensor(sensor).with_torque(TorqueModel::Drag);
    let priors: Vec<f64> = sensor_columns(&sensor, 1.0).iter().filter_map(|column| column.prior).collect();
    assert_eq!(priors, [0.01, 0.01, 0.01, 0.02]);
    let part = |tensor: Matrix3<f64>, has_object, added: Matrix3<f64>, is_uncertain: bool, seed| Part {
        told: told(tensor, &settings, seed),
        has_object,
        added,
        uncertain: is_uncertain.then_some((0, [2e-4, 1e-4, 2e-4, 1e-4, 2e-4, 1e-4])),
    };
    let parts = vec![
        part(carrier(), false, Matrix3::zeros(), false, 1),
        part(carrier() + proof(), false, proof(), true, 2),
        part(carrier() + object(), true, Matrix3::zeros(), false, 3),
    ];
    let begin = Start { carrier: carrier(), object: Some(object()), wheel: Some(1.1), sizes: Vec::new() };
    let (system, mut z) = System::new(parts, priors, &begin);
    // four errors of the sensor, six entries of the proof body, a wheel, and two tensors
    assert_eq!(
        (z.len(), system.wheel.unwrap().0, system.object.unwrap().0, system.carrier.0),
        (23, 10, 11, 17)
    );
    assert!((system.body(system.carrier, &z) - carrier()).amax() < 1e-15);
    assert!((system.body(system.object.unwrap(), &z) - object()).amax() < 1e-15);
    // 4 + 1 + 5 readings of each record and ten priors
    assert_eq!(system.dof(23), 30 + 10 - 23);
    z.rows_mut(0, 10).copy_from(&DVector::from_fn(10, |k, _| 0.3 - 0.05 * k as f64));
    let readings = system.readings(&system.parts[1], &z).unwrap();
    let mut uncertain = carrier() + proof();
    for (k, sigma) in [2e-4, 1e-4, 2e-4, 1e-4, 2e-4, 1e-4].iter().enumerate() {
        uncertain += symmetric(k) * (sigma * z[4 + k]);
    }
    assert!((readings[0] - 0.01 * z[0]).abs() < 1e-15 && (readings[3] - 0.02 * z[3]).abs() < 1e-15);
    assert!((readings[4] - 1.1 / uncertain.trace()).abs() < 1e-9);
    let shape = coordinates(&(uncertain / uncertain.trace()));
    assert!((0..5).all(|k| (readings[5 + k] - shape[k]).abs() < 1e-12));

    let squares = |z: &DVector<f64>| {
        let each = system.parts.iter().map(|part| {
            let readings = system.readings(part, z).unwrap();
            (&part.told.root * readings + &part.told.right).norm_squared()
        });
        each.sum::<f64>() + z.rows(0, 10).norm_squared()
    };
    assert!((system.squares(&z).unwrap() / squares(&z) - 1.0).abs() < 1e-12);
    // ∇ = 2 Rᵀ R (z − centre)
    let normal = system.linearised(&z).unwrap();
    let gradient = normal.root.tr_mul(&(&normal.root * (&z - &normal.centre))) * 2.0;
    for k in 0..z.len() {
        let moved = |by: f64| {
            let mut z = z.clone();
            z[k] += by;
            squares(&z)
        };
        let h = 1e-6;
        let slope = (moved(h) - moved(-h)) / (2.0 * h);
        assert!((slope - gradient[k]).abs() < 1e-4 * gradient.amax(), "{k}: {slope:e} {:e}", gradient[k]);
    }
    // where the search ends no further round moves the answer, and the squares are least
    let (best, there) = least(&system, z.clone(), None).unwrap();
    assert!((&there.root * (&there.centre - &best)).norm() <= 1e-6);
    for k in 0..z.len() {
        let around = [1e-3, -1e-3].map(|by| {
            let mut off = best.clone();
            off[k] += by;
            squares(&off)
        });
        assert!(around.iter().all(|other| *other > squares(&best)) && squares(&best) < squares(&z), "{k}");
    }
    // of a drag that acts no part is held at zero; a shape far off would ask for one that gives energy
    assert!(
        system.parts[0].told.gains(&system.readings(&system.parts[0], &normal.centre).unwrap()).is_empty()
    );
}

fn alone(
    attached: Attached,
    tensor: Matrix3<f64>,
    proof: Option<ProofBody>,
    wheel: Option<f64>,
    sure: f64,
) -> Alone {
    let shape = coordinates(&(tensor / tensor.trace()));
    let inverse = wheel.map(|wheel| wheel / tensor.trace());
    let centre: Vec<f64> = inverse.into_iter().chain(shape.iter().copied()).collect();
    let size = centre.len();
    Alone {
        attached,
        proof,
        told: Normal { centre: DVector::from_vec(centre), root: DMatrix::identity(size, size) * sure },
    }
}

/// Shapes with and without a proof body tell both sizes, and quotients of a wheel its inertia, with the deviation that they have.
#[test]
fn closed_forms_give_the_tensors_of_exact_records() {
    let body = ProofBody::adding(proof()).unwrap();
    let sure = 1e5;
    let all = [
        alone(Attached::Nothing, carrier(), None, None, sure),
        alone(Attached::Proof, carrier() + proof(), Some(body), None, sure),
        alone(Attached::Object, carrier() + object(), None, None, sure),
        alone(Attached::ObjectAndProof, carrier() + object() + proof(), Some(body), None, sure),
    ];
    let found = start(&all, false).unwrap();
    assert!((found.carrier - carrier()).amax() < 1e-12 && found.wheel.is_none());
    assert!((found.object.unwrap() - object()).amax() < 1e-12);
    // both shapes err by 1/sure in each coordinate, the carrier's in proportion to its share
    let (both, own) = ((carrier() + proof()).trace(), carrier().trace());
    let response = coordinates(&proof()) - coordinates(&(carrier() / own)) * proof().trace();
    let sigma = (1.0 + (own / both) * (own / both)).sqrt() / sure / response.norm();
    // relative in the trace of the carrier: one over that of both, over its own share of it
    let relative = sigma * both * both / own;
    assert!(
        (found.sizes[0].relative / relative - 1.0).abs() < 1e-6,
        "{} {relative}",
        found.sizes[0].relative
    );
    // an uncertain proof body makes it less sure
    let mut uncertain = all;
    uncertain[1].proof = Some(body.with_deviation(1e-3));
    assert!(start(&uncertain, false).unwrap().sizes[0].relative > 1.5 * relative);

    // a wheel of 0.02 kg m²
    let wheel = Some(0.02);
    let turning = [
        alone(Attached::Nothing, carrier(), None, wheel, sure),
        alone(Attached::Proof, carrier() + proof(), Some(body), wheel, sure),
        alone(Attached::Object, carrier() + object(), None, wheel, sure),
    ];
    let found = start(&turning, true).unwrap();
    assert!((found.wheel.unwrap() / 0.02 - 1.0).abs() < 1e-9 && (found.carrier - carrier()).amax() < 1e-11);
    assert!((found.object.unwrap() - object()).amax() < 1e-11);
    // of known momenta one record is enough
    let known = [alone(Attached::Nothing, carrier(), None, Some(1.0), sure)];
    let found = start(&known, false).unwrap();
    assert!((found.carrier - carrier()).amax() < 1e-14);
    assert!((found.sizes[0].relative * sure / own - 1.0).abs() < 1e-9);

    let both = [
        alone(Attached::Nothing, carrier(), None, Some(1.0), sure),
        alone(Attached::Object, carrier() + object(), None, Some(1.0), sure),
    ];
    assert!((start(&both, false).unwrap().object.unwrap() - object()).amax() < 1e-14);

    // too light, the other way round, and no size at all
    let refused = |all: &[Alone]| start(all, false).err().unwrap();
    let vague = |tensor: Matrix3<f64>| {
        [
            alone(Attached::Nothing, carrier(), None, None, 1.0),
            alone(Attached::Proof, tensor, Some(body), None, 1.0),
        ]
    };
    let CarrierError::TooLight { trace, sigma, needed, bound, inverse } =
        refused(&vague(carrier() + proof()))
    else {
        panic!()
    };
    assert!((trace / proof().trace() - 1.0).abs() < 1e-12 && (bound * needed * sigma - 1.0).abs() < 1e-12);
    assert!(inverse < needed * sigma);
    let mut swapped = vague(carrier());
    swapped[0] = alone(Attached::Nothing, carrier() + proof(), None, None, sure);
    swapped[1] = alone(Attached::Proof, carrier(), Some(body), None, sure);
    assert!(matches!(refused(&swapped), CarrierError::Opposite { inverse, sigma } if inverse < -5.0 * sigma));
    assert!(matches!(refused(&all_but_proof(sure)), CarrierError::NoSize { told: None }));
}

fn all_but_proof(sure: f64) -> [Alone; 1] {
    [alone(Attached::Nothing, carrier(), None, None, sure)]
}

/// What a body adds is the difference of the tensors of all masses about their common centres, with it and without it.
#[test]
fn attached_bodies_add_what_the_masses_say() {
    let (mass, place, own) = (0.7, Vector3::new(0.1, -0.2, 0.05), proof() * 0.1);
    let (held, at, carrier_mass) = (0.4, Vector3::new(-0.3, 0.1, 0.2), 1.9);
    let body = MassProperties::new(mass, place, own).unwrap();
    let about = |points: &[(f64, Vector3<f64>)]| {
        let total: f64 = points.iter().map(|(m, _)| m).sum();
        let centre = points.iter().map(|(m, r)| r * *m).sum::<Vector3<f64>>() / total;
        let one = |(m, r): &(f64, Vector3<f64>)| {
            let d = r - centre;
            (Matrix3::identity() * d.norm_squared() - d * d.transpose()) * *m
        };
        points.iter().map(one).sum::<Matrix3<f64>>()
    };
    let origin = (carrier_mass, Vector3::zeros());
    let alone = ProofBody::attached(&body, carrier_mass).unwrap().added();
    assert!((alone - own - about(&[origin, (mass, place)])).amax() < 1e-15);
    let beside = ProofBody::attached_beside(&body, carrier_mass, (held, at)).unwrap().added();
    let with = about(&[origin, (held, at), (mass, place)]) - about(&[origin, (held, at)]);
    assert!((beside - own - with).amax() < 1e-15, "{beside} {with}");
}

/// A body is physical while no moment exceeds the sum of the others, with what is added to its entries.
#[test]
fn the_law_is_that_of_the_body_without_its_term() {
    let flat = |more: f64| DVector::from_vec(vec![9.0, 1.0, 2.0, 3.0 + more, 0.0, 0.0, 0.0]);
    let itself = (1, 0.1, Matrix3::zeros());
    assert!(is_physical(&itself, &flat(-1e-9)) && !is_physical(&itself, &flat(1e-9)));
    assert!(is_held(&itself, &flat(0.0)) && !is_held(&itself, &flat(-0.1)));
    // with a term about z taken off there is room
    let with_term = (1, 0.1, -symmetric(2) * 0.5);
    assert!(is_physical(&with_term, &flat(0.4)) && !is_physical(&with_term, &flat(0.6)));
    assert_eq!(ENTRIES[2], (2, 2));
}

/// An inequality holds an answer where it is open by less than a millionth of the trace, or of the unit of a body that is smaller.
#[test]
fn the_law_holds_up_to_a_millionth() {
    let body = (0, 1.0, Matrix3::zeros());
    // 100 + 200 and 0.1 + 0.2 exceed the third by so much
    for (unit, near, far) in [(100.0, 5e-4, 7e-4), (0.1, 8e-7, 1.2e-6)] {
        let open = |by: f64| DVector::from_vec(vec![unit, 2.0 * unit, 3.0 * unit - by, 0.0, 0.0, 0.0]);
        assert!(is_held(&body, &open(near)) && !is_held(&body, &open(far)), "{unit}");
    }
}

/// What must be physical of an object is what it adds less its parallel-axis term, in its unit; what starts at zero has that of the carrier.
#[test]
fn bodies_of_the_law_have_their_places_and_units() {
    let records = CarrierRecords::new(Record::default());
    let at = |object: Matrix3<f64>, wheel: f64| {
        let begin = Start { carrier: carrier(), object: Some(object), wheel: Some(wheel), sizes: Vec::new() };
        System::new(Vec::new(), vec![0.01], &begin)
    };
    let (system, z) = at(object(), -2.0);
    assert_eq!((z.len(), system.wheel, z[1]), (14, Some((1, 2.0)), -1.0));
    assert_eq!((system.object, system.carrier), (Some((2, object().norm())), (8, carrier().trace())));
    // two equal masses two apart: a term of (0, 2, 2)
    let placed = records.clone().with_object_at(1.0, Vector3::x() * 2.0, 1.0).unwrap();
    let [of_carrier, (place, unit, base)] = bodies(&system, &placed)[..] else { panic!() };
    assert_eq!(of_carrier, (8, carrier().trace(), Matrix3::zeros()));
    assert_eq!((place, unit), (2, object().norm()));
    let term = Matrix3::from_diagonal(&Vector3::new(0.0, 2.0, 2.0));
    assert!((base * unit + term).amax() < 1e-14, "{base}");
    assert_eq!(bodies(&system, &records)[1].2, Matrix3::zeros());
    let (system, z) = at(Matrix3::zeros(), 0.0);
    let unit = carrier().trace();
    assert_eq!((system.wheel, system.object), (Some((1, unit)), Some((2, unit))));
    assert!(z.rows(1, 7).iter().all(|value| *value == 0.0));
    assert!(system.squares(&z).is_some() && system.dof(14) == 0);
}

/// Masses, places and traces that no body has are refused by name.
#[test]
fn what_no_attached_body_has_is_refused_by_name() {
    let name = |error: CarrierError| {
        let CarrierError::Setting { name, .. } = error else { panic!("{error}") };
        name
    };
    let refused = |mass, place, carrier| name(parallel_axis(mass, place, carrier).unwrap_err());
    for bad in [0.0, -1.0, f64::INFINITY] {
        assert_eq!(refused(bad, Vector3::x(), 1.0), "the mass of the attached body");
        assert_eq!(refused(1.0, Vector3::x(), bad), "the mass of the carrier");
    }
    assert_eq!(refused(1.0, Vector3::new(0.0, f64::NAN, 0.0), 1.0), "the position of the attached body");
    // two equal masses two apart: each is one from the centre
    let found = parallel_axis(1.0, Vector3::x() * 2.0, 1.0).unwrap();
    assert_eq!(found, Matrix3::from_diagonal(&Vector3::new(0.0, 2.0, 2.0)));
}

/// Of wheels and a proof body the surer one gives the size where the fit begins, and both are told.
#[test]
fn the_surer_size_begins() {
    let body = ProofBody::adding(proof()).unwrap();
    let trace = carrier().trace();
    // the wheels tell a carrier that is larger by a hundredth, the proof body the right one to 2e-4
    for (sure, expected) in [(1e5, 1.01 * trace), (1e2, trace)] {
        let mut own = alone(Attached::Nothing, carrier(), None, Some(1.0 / 1.01), 1e5);
        own.told.root[(0, 0)] = sure;
        let with = alone(Attached::Proof, carrier() + proof(), Some(body), None, 1e5);
        let found = start(&[own, with], false).unwrap();
        assert!((found.carrier.trace() / expected - 1.0).abs() < 1e-9, "{sure}: {}", found.carrier);
        let sources: Vec<SizeSource> = found.sizes.iter().map(|size| size.source).collect();
        assert_eq!(sources, [SizeSource::Inputs, SizeSource::Proof]);
        assert!((found.sizes[0].relative * sure / (1.01 * trace) - 1.0).abs() < 1e-12);
    }
}

/// A record alone tells a carrier, whose size is as sure as what gives it, and no object beside it.
#[test]
fn one_record_tells_one_body() {
    let settings = Settings::default().with_torque(TorqueModel::Drag);
    let found = fit_carrier(&CarrierRecords::new(record(carrier(), 1)), &settings).unwrap();
    let (trace, sigma) = found.carrier.trace();
    assert!(found.pull == 0.0 && found.agreement.dof == 0 && found.sizes.len() == 1);
    assert!((sigma / trace / found.sizes[0].relative - 1.0).abs() < 1e-6, "{sigma:e} {trace}");

    let added = Matrix3::zeros();
    let part = Part { told: told(carrier(), &settings, 1), has_object: true, added, uncertain: None };
    let begin = Start { carrier: carrier(), object: Some(object()), wheel: None, sizes: Vec::new() };
    let (system, z) = System::new(vec![part], Vec::new(), &begin);
    assert!(z.len() == 12 && system.squares(&z).is_some() && system.linearised(&z).is_none());
}
