//! Carrier, proof body, object and wheel from several records at once.

use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, Vector3};
use polhode::inertia::{Inertia, MassProperties};
use polhode::num::Random;
use polhode_fit::Attached::{self, Nothing, Object, ObjectAndProof, Proof};
use polhode_fit::{
    CarrierError, CarrierEstimate, CarrierRecords, CarrierWarning, Disturbances, FitError, Gyroscope, Known,
    ProofBody, Record, Segment, SensorPriors, Settings, SizeSource, TorqueModel, fit_carrier, simulate_with,
};

use crate::measured::{ENTRIES, entries, random_rotation, sampled, turned};

/// A wheel of this moment of inertia, kg m², runs up about an axis that is none of a body's.
const WHEEL: f64 = 2e-4;
const NOISE: f64 = 2e-3;

/// What one record is made of.
#[derive(Clone, Copy)]
struct Tumbling {
    attached: Attached,
    omega: Vector3<f64>,
}

/// A set-up: its tensors, kg m², and its records.
#[derive(Clone)]
struct Bench {
    carrier: Matrix3<f64>,
    object: Matrix3<f64>,
    proof: Matrix3<f64>,
    /// What the fit is told of the proof body.
    told: Matrix3<f64>,
    /// Inertia of the wheel; zero without one.
    wheel: f64,
    tumblings: Vec<Tumbling>,
    gyroscope: Gyroscope,
}

impl Bench {
    /// Of bodies some 10 cm large, each in axes of its own.
    fn new(attached: &[Attached], wheel: f64, random: &mut Random) -> Bench {
        let mut of = |moments: [f64; 3]| turned(moments, &random_rotation(random));
        let (carrier, object) = (of([0.010, 0.017, 0.021]), of([0.004, 0.006, 0.009]));
        let proof = of([0.003, 0.011, 0.012]);
        let tumbling = |&attached| Tumbling { attached, omega: random.normal_vector().normalize() * 3.0 };
        let tumblings = attached.iter().map(tumbling).collect();
        let gyroscope = Gyroscope::default().with_noise(NOISE);
        Bench { carrier, object, proof, told: proof, wheel, tumblings, gyroscope }
    }

    fn axis() -> Vector3<f64> {
        Vector3::new(0.6, 0.0, 0.8)
    }

    fn times() -> Vec<f64> {
        sampled(40, 8)
    }

    fn tensor(&self, attached: Attached) -> Matrix3<f64> {
        let object = matches!(attached, Object | ObjectAndProof);
        let proof = matches!(attached, Proof | ObjectAndProof);
        let part = |is: bool, tensor: Matrix3<f64>| if is { tensor } else { Matrix3::zeros() };
        self.carrier + part(object, self.object) + part(proof, self.proof)
    }

    fn rates(
        &self,
        k: usize,
        omega: Vector3<f64>,
        read: &Gyroscope,
        random: &mut Random,
    ) -> Vec<Vector3<f64>> {
        let body = Inertia::from_tensor(self.tensor(self.tumblings[k].attached)).unwrap();
        let axis = Bench::axis() * self.wheel;
        let acting = Disturbances::default().with_wheel(axis * 40.0).with_wheel_rate(axis * 8.0);
        simulate_with(&body, omega, &Bench::times(), &acting, read, random).unwrap()
    }

    /// Noisy records; the speeds of the wheel times `inertia` are its momenta.
    fn records(&self, inertia: f64, random: &mut Random) -> CarrierRecords {
        let proof = ProofBody::adding(self.told).unwrap();
        let mut all = CarrierRecords::new(self.record(0, inertia, random));
        for k in 1..self.tumblings.len() {
            let record = self.record(k, inertia, random);
            all = match self.tumblings[k].attached {
                Proof => all.with_proof(record, proof),
                Object => all.with_object(record),
                _ => all.with_object_and_proof(record, proof),
            };
        }
        all
    }

    fn record(&self, k: usize, inertia: f64, random: &mut Random) -> Record {
        let rates = self.rates(k, self.tumblings[k].omega, &self.gyroscope, random);
        let times = Bench::times();
        let momenta = times.iter().map(|t| Bench::axis() * (inertia * (40.0 + 8.0 * t))).collect();
        let mut segment = Segment::new("bench", times, rates).unwrap();
        if self.wheel > 0.0 {
            segment = segment.with_wheel(momenta).unwrap();
        }
        let mut record = Record::default();
        record.segments.push(segment);
        record
    }

    /// The entries of carrier and object and the inertia of the wheel, as far as they are unknowns.
    fn unknowns(&self, object: bool, wheel: bool) -> DVector<f64> {
        let (carrier, object_entries) = (entries(&self.carrier), entries(&self.object));
        let bodies = carrier.iter().chain(&object_entries).copied();
        let count = if object { 12 } else { 6 };
        let all: Vec<f64> = bodies.take(count).chain(wheel.then_some(self.wheel)).collect();
        DVector::from_vec(all)
    }

    fn at(&self, unknowns: &DVector<f64>, object: bool, wheel: bool) -> Bench {
        let tensor = |from: usize| {
            let mut body = Matrix3::zeros();
            for (k, (i, j)) in ENTRIES.into_iter().enumerate() {
                body[(i, j)] = unknowns[from + k];
                body[(j, i)] = unknowns[from + k];
            }
            body
        };
        let mut bench = Bench { carrier: tensor(0), ..self.clone() };
        if object {
            bench.object = tensor(6);
        }
        if wheel {
            bench.wheel = unknowns[unknowns.len() - 1];
        }
        bench
    }

    /// The Cramér–Rao bound by differences of the exact rates: each record has a start of its own.
    fn bound(&self, object: bool, wheel: bool) -> DMatrix<f64> {
        let (exact, mut random) = (Gyroscope::default(), Random::new(1));
        let unknowns = self.unknowns(object, wheel);
        let (size, own) = (unknowns.len(), 3 * self.tumblings.len());
        let mut information = DMatrix::<f64>::zeros(size + own, size + own);
        for k in 0..self.tumblings.len() {
            let mut column = |unknown: usize| {
                let mut difference = |sign: f64| {
                    let (mut at, mut omega) = (unknowns.clone(), self.tumblings[k].omega);
                    let step = if unknown < size {
                        let unit =
                            if wheel && unknown == size - 1 { self.wheel } else { self.carrier.trace() };
                        let step = 1e-5 * unit;
                        at[unknown] += sign * step;
                        step
                    } else {
                        omega[unknown - size] += sign * 1e-5;
                        1e-5
                    };
                    (self.at(&at, object, wheel).rates(k, omega, &exact, &mut random), step)
                };
                let ((above, step), (below, _)) = (difference(1.0), difference(-1.0));
                let each = above.iter().zip(&below).flat_map(|(a, b)| {
                    let slope = (a - b) / (2.0 * step * NOISE);
                    [slope.x, slope.y, slope.z]
                });
                DVector::from_vec(each.collect::<Vec<f64>>())
            };
            let columns: Vec<DVector<f64>> = (0..size + 3).map(&mut column).collect();
            let place = |i: usize| if i < size { i } else { i + 3 * k };
            for i in 0..size + 3 {
                for j in 0..size + 3 {
                    information[(place(i), place(j))] += columns[i].dot(&columns[j]);
                }
            }
        }
        // in units of the deviations, so that the inverse keeps its digits
        let unit = information.diagonal().map(|v| 1.0 / v.sqrt());
        let scaled = DMatrix::from_fn(size + own, size + own, |i, k| information[(i, k)] * unit[i] * unit[k]);
        let inverse = scaled.cholesky().unwrap().inverse();
        DMatrix::from_fn(size, size, |i, k| inverse[(i, k)] * unit[i] * unit[k])
    }
}

fn answer(e: &CarrierEstimate) -> DVector<f64> {
    let carrier = entries(&e.carrier.tensor);
    let object = e.object.as_ref().map(|object| entries(&object.tensor));
    let all = carrier.iter().copied().chain(object.iter().flat_map(|o| o.iter().copied()));
    DVector::from_vec(all.chain(e.wheel.map(|wheel| wheel.inertia)).collect::<Vec<f64>>())
}

/// Means over bench after bench.
struct Scatter {
    /// eᵀ C⁻¹ e over its degrees of freedom, C being the stated covariance.
    error: f64,
    /// Stated variances over the bound, of the first.
    width: f64,
    /// χ² of the records over its degrees of freedom.
    agreement: f64,
    /// Square of the wheel's error in its deviations.
    wheel: f64,
}

/// `wheel`: whether its inertia is to be found, where there is one.
fn scatter(attached: &[Attached], wheel: Option<bool>, count: u32) -> Scatter {
    let mut random = Random::new(91);
    let object = attached.iter().any(|a| matches!(a, Object | ObjectAndProof));
    let finds = wheel == Some(true);
    let mut sum = Scatter { error: 0.0, width: 0.0, agreement: 0.0, wheel: 0.0 };
    for k in 0..count {
        let bench = Bench::new(attached, if wheel.is_some() { WHEEL } else { 0.0 }, &mut random);
        let records = bench.records(if finds { 1.0 } else { WHEEL }, &mut random);
        let records = if finds { records.with_unknown_wheel() } else { records };
        // the bound reckons with no torque
        let settings = Settings::default().with_torque(TorqueModel::None);
        let e = fit_carrier(&records, &settings).unwrap();
        let error = answer(&e) - bench.unknowns(object, finds);
        sum.error += distance(&error, &e.covariance) / error.len() as f64;
        if k == 0 {
            let ratios = e.covariance.diagonal().component_div(&bench.bound(object, finds).diagonal());
            sum.width = ratios.mean();
        }
        sum.agreement += e.agreement.chi2 / e.agreement.dof.max(1) as f64;
        let z = e.wheel.map_or(0.0, |found| (found.inertia - WHEEL) / found.sigma);
        sum.wheel += z * z;
        assert!(e.pull > 0.0 || e.warnings.is_empty(), "{:?}", e.warnings);
        let expected = if wheel == Some(false) { SizeSource::Inputs } else { SizeSource::Proof };
        assert!(e.sizes.iter().all(|size| size.source == expected && size.relative < 0.1), "{:?}", e.sizes);
    }
    let mean = |sum: f64| sum / f64::from(count);
    let found =
        Scatter { error: mean(sum.error), agreement: mean(sum.agreement), wheel: mean(sum.wheel), ..sum };
    println!(
        "{attached:?} {wheel:?}: errors {:.3}, variances over the bound {:.3}, agreement {:.3}, wheel {:.3}",
        found.error, found.width, found.agreement, found.wheel
    );
    found
}

/// eᵀ C⁻¹ e.
fn distance(e: &DVector<f64>, c: &DMatrix<f64>) -> f64 {
    let unit = c.diagonal().map(|v| v.sqrt());
    let scaled = DMatrix::from_fn(c.nrows(), c.nrows(), |i, k| c[(i, k)] / unit[i] / unit[k]);
    let e = e.component_div(&unit);
    e.dot(&scaled.cholesky().unwrap().solve(&e))
}

/// The mean of χ² over n degrees of freedom scatters over 16 benches by √(2/(16 n)): 0.14 of six and 0.10 of
/// twelve, over 8 by 0.14.
#[test]
#[ignore = "an ensemble: takes seconds, `.ci/run` does it"]
fn tensors_reach_the_bound_and_are_covered() {
    let carrier = scatter(&[Nothing, Proof], None, 16);
    let both = scatter(&[Nothing, Proof, Object, ObjectAndProof], None, 16);
    let known = scatter(&[Nothing, Object], Some(false), 8);
    let found = scatter(&[Nothing, Proof, Object], Some(true), 16);
    assert!((0.58..1.42).contains(&carrier.error), "{}", carrier.error);
    for of in [&both, &known, &found] {
        assert!((0.7..1.3).contains(&of.error), "{}", of.error);
    }
    for of in [&carrier, &both, &known, &found] {
        assert!((0.95..1.15).contains(&of.width), "{}", of.width);
    }
    for of in [&carrier, &both, &found] {
        assert!((0.5..1.5).contains(&of.agreement), "{}", of.agreement);
    }
    assert!(known.agreement < 1e-15, "{}", known.agreement); // nothing that records could contradict
    // of 16 squares: 1 to within √(2/16) = 0.35
    assert!((0.25..2.1).contains(&found.wheel), "{}", found.wheel);
}

/// Records of one sensor with an offset: it is one unknown in all of them.
#[test]
fn errors_of_the_sensor_are_one_unknown_in_all_records() {
    let mut random = Random::new(92);
    let offset = Vector3::new(0.02, -0.03, 0.01);
    let settings = Settings::default().with_sensor(SensorPriors::default().with_offset(0.03));
    let (mut of_offset, mut of_tensor, mut agreement, count) = (0.0, 0.0, 0.0, 12);
    for _ in 0..count {
        let mut bench = Bench::new(&[Nothing, Proof], 0.0, &mut random);
        bench.gyroscope = bench.gyroscope.with_offset(offset);
        let e = fit_carrier(&bench.records(1.0, &mut random), &settings).unwrap();
        assert_eq!(
            e.nuisances.iter().map(|n| n.name).collect::<Vec<_>>(),
            ["offset_x", "offset_y", "offset_z"]
        );
        for (k, nuisance) in e.nuisances.iter().enumerate() {
            let z = (nuisance.value - offset[k]) / nuisance.sigma;
            of_offset += z * z / 3.0;
            for (_, alone) in &e.records {
                assert!(nuisance.sigma < alone.nuisances[k].sigma, "{nuisance:?} {:?}", alone.nuisances[k]);
            }
        }
        of_tensor += distance(&(answer(&e) - bench.unknowns(false, false)), &e.covariance) / 6.0;
        assert_eq!(e.agreement.dof, 10); // 2 × (5 + 3) readings and 3 priors, of 6 + 3 unknowns
        agreement += e.agreement.chi2 / 10.0;
    }
    let mean = |sum: f64| sum / f64::from(count);
    println!(
        "offset {:.3}, tensor {:.3}, agreement {:.3}",
        mean(of_offset),
        mean(of_tensor),
        mean(agreement)
    );
    // to √(2/36) = 0.24, √(2/72) = 0.17 and √(2/120) = 0.13
    assert!((0.4..1.8).contains(&mean(of_offset)) && (0.5..1.5).contains(&mean(of_tensor)));
    assert!((0.5..1.5).contains(&mean(agreement)));
}

/// The tensor of point masses about their common centre, kg m².
fn of_points(points: &[(f64, Vector3<f64>)]) -> MassProperties {
    MassProperties::of_points(points.iter().copied()).unwrap()
}

/// Carrier, proof body and object of point masses: what tumbles is their sum about the common centre of mass, which no parallel-axis
/// formula of the fit computes.
#[test]
fn attached_bodies_are_counted_from_their_own_places() {
    let mut random = Random::new(93);
    let mut cloud = |count: usize, mass: f64, size: f64, at: Vector3<f64>| -> Vec<(f64, Vector3<f64>)> {
        let points: Vec<Vector3<f64>> = (0..count).map(|_| random.normal_vector() * size).collect();
        let centre = points.iter().sum::<Vector3<f64>>() / count as f64;
        points.iter().map(|p| (mass / count as f64, p - centre + at)).collect()
    };
    let (at_proof, at_object) = (Vector3::new(0.08, -0.05, 0.1), Vector3::new(-0.04, 0.06, 0.03));
    let carrier = cloud(5, 3.0, 0.06, Vector3::zeros());
    let (proof, object) = (cloud(4, 2.0, 0.04, at_proof), cloud(6, 1.5, 0.05, at_object));
    let of = |parts: &[&[(f64, Vector3<f64>)]]| of_points(&parts.concat()).tensor();
    let mut bench = Bench::new(&[Nothing, Proof, Object, ObjectAndProof], 0.0, &mut random);
    bench.carrier = of(&[&carrier]);
    let tensors =
        [bench.carrier, of(&[&carrier, &proof]), of(&[&carrier, &object]), of(&[&carrier, &object, &proof])];
    let mut all = Vec::new();
    for (tensor, tumbling) in tensors.iter().zip(&bench.tumblings) {
        let read = Gyroscope::default().with_noise(1e-5);
        let body = Inertia::from_tensor(*tensor).unwrap();
        let free = Disturbances::default();
        let times = Bench::times();
        let rates = simulate_with(&body, tumbling.omega, &times, &free, &read, &mut random).unwrap();
        all.push(Record::from_samples(&times, &rates).unwrap());
    }
    let [alone, with_proof, with_object, with_both] = <[Record; 4]>::try_from(all).unwrap();
    let body = of_points(&proof);
    let proof_on_carrier = ProofBody::attached(&body, 3.0).unwrap();
    // counted from the centre of carrier and object
    let centre = at_object * (1.5 / 4.5);
    let proof_on_both = ProofBody::attached(&body.moved(-centre).unwrap(), 4.5).unwrap();
    let records = CarrierRecords::new(alone)
        .with_proof(with_proof, proof_on_carrier)
        .with_object(with_object)
        .with_object_and_proof(with_both, proof_on_both)
        .with_object_at(1.5, at_object, 3.0)
        .unwrap();
    let e = fit_carrier(&records, &Settings::default()).unwrap();
    let own = of_points(&object).tensor();
    let itself = e.object_itself.unwrap();
    for (found, truth) in [(&e.carrier, bench.carrier), (&itself, own)] {
        let error = entries(&(found.tensor - truth));
        let chi2 = error.dot(&found.covariance.cholesky().unwrap().solve(&error));
        assert!(chi2 < 28.0, "{chi2}"); // 1e-4 of six degrees
        assert!(found.covariance.trace().sqrt() < 1e-3 * truth.trace(), "{}", found.covariance);
    }
    assert!(e.warnings.is_empty() && e.agreement.chi2 < 34.0, "{:?}", e.agreement); // 1e-4 of eight
}

/// A change of the unit of mass by a power of two changes no bit.
#[test]
fn no_size_is_taken_for_granted() {
    let bench = Bench::new(&[Nothing, Proof, Object, ObjectAndProof], 0.0, &mut Random::new(94));
    let small = libm::ldexp(1.0, -40);
    let find = |unit: f64| {
        let told = Bench { told: bench.told * unit, ..bench.clone() };
        fit_carrier(&told.records(1.0, &mut Random::new(95)), &Settings::default()).unwrap()
    };
    let (whole, scaled) = (find(1.0), find(small));
    assert_eq!(whole.carrier.tensor * small, scaled.carrier.tensor);
    assert_eq!(whole.covariance * (small * small), scaled.covariance);
}

/// A proof body that is known to some per cent gives a carrier of the same relative deviation, and no better.
#[test]
fn the_carrier_is_as_sure_as_the_proof_body() {
    let bench = Bench::new(&[Nothing, Proof], 0.0, &mut Random::new(96));
    let several = |share: Option<f64>, seeds: &[u64]| {
        let proof = ProofBody::adding(bench.proof).unwrap().with_deviation(share);
        let alone = CarrierRecords::new(bench.record(0, 1.0, &mut Random::new(97)));
        let record = |seed: &u64| bench.record(1, 1.0, &mut Random::new(*seed));
        let all = seeds.iter().fold(alone, |records, seed| records.with_proof(record(seed), proof));
        fit_carrier(&all, &Settings::default())
    };
    let find = |share: Option<f64>| several(share, &[98]);
    let relative = |e: &CarrierEstimate| {
        let c = e.carrier.covariance.fixed_view::<3, 3>(0, 0).sum();
        c.sqrt() / e.carrier.tensor.trace()
    };
    let (exact, rough) = (find(None).unwrap(), find(Some(0.05)).unwrap());
    assert!(relative(&exact) < 0.01, "{}", relative(&exact));
    // D scales the answer: six independent entries of 5 % leave as many, and more where the shapes are alike
    assert!((0.01..0.2).contains(&relative(&rough)), "{}", relative(&rough));
    assert!(matches!(
        find(Some(-1.0)),
        Err(CarrierError::Setting { name: "the deviation of the proof body", .. })
    ));
}

/// A known torque gives the size without a proof body.
#[test]
fn a_known_torque_gives_the_size() {
    let mut random = Random::new(99);
    let bench = Bench::new(&[Nothing, Object], 0.0, &mut random);
    let torque = Vector3::new(0.004, -0.002, 0.003);
    let mut pushed = |tensor: Matrix3<f64>, omega: Vector3<f64>| {
        let (times, body) = (Bench::times(), Inertia::from_tensor(tensor).unwrap());
        let acting = Disturbances::default().with_torque(torque);
        let rates = simulate_with(&body, omega, &times, &acting, &bench.gyroscope, &mut random).unwrap();
        let torques = vec![torque; times.len()];
        let mut record = Record::default();
        record.segments.push(Segment::new("pushed", times, rates).unwrap().with_torque(torques).unwrap());
        record
    };
    let [first, second] = [0, 1].map(|k| bench.tumblings[k].omega);
    let records = CarrierRecords::new(pushed(bench.carrier, first));
    let records = records.with_object(pushed(bench.carrier + bench.object, second));
    let e = fit_carrier(&records, &Settings::default().with_torque(TorqueModel::None)).unwrap();
    let chi2 = distance(&(answer(&e) - bench.unknowns(true, false)), &e.covariance);
    assert!(chi2 < 39.0 && e.sizes[0].relative < 0.05, "{chi2} {:?}", e.sizes); // 1e-4 of twelve degrees
}

/// A flat object: its tensor is on the edge of the physical law, and noise carries every other answer beyond it.
#[test]
fn the_physical_law_holds_carrier_and_object() {
    let mut random = Random::new(100);
    let (mut held, mut square, count) = (0, 0.0, 8);
    for _ in 0..count {
        let mut bench = Bench::new(&[Nothing, Proof, Object], WHEEL, &mut random);
        bench.object = turned([0.003, 0.005, 0.008], &random_rotation(&mut random));
        let e = fit_carrier(&bench.records(WHEEL, &mut random), &Settings::default()).unwrap();
        let found = e.object.as_ref().unwrap();
        let [a, b, c] = found.principal;
        assert!(a + b >= c * (1.0 - 1e-9), "{:?}", found.principal);
        let is_held = e.warnings.iter().any(|w| matches!(w, CarrierWarning::Held { name: "object", .. }));
        assert_eq!(is_held, e.pull > 0.0);
        assert_eq!(is_held, a + b - c < 1e-6 * (a + b + c), "{:?}", found.principal);
        held += usize::from(is_held);
        let error = entries(&(found.tensor - bench.object));
        square += error.norm_squared() / found.covariance.trace() / f64::from(count);
    }
    println!("held {held} of {count}, squares of errors over variances {square:.3}");
    assert!((1..count as usize).contains(&held), "{held}");
    assert!((0.2..2.5).contains(&square), "{square}");
}

#[test]
fn a_wrong_proof_body_is_seen_by_the_records() {
    let bench = Bench::new(&[Nothing, Proof], 0.0, &mut Random::new(101));
    let of = |told: Matrix3<f64>| {
        let bench = Bench { told, ..bench.clone() };
        fit_carrier(&bench.records(1.0, &mut Random::new(102)), &Settings::default())
    };
    // mounted askew by 0.03 rad
    let askew = Rotation3::from_scaled_axis(Vector3::new(0.01, -0.02, 0.02)).into_inner();
    let e = of(askew * bench.proof * askew.transpose()).unwrap();
    let Some(CarrierWarning::Contradiction { chi2, dof: 4 }) = e.warnings.first().copied() else {
        panic!("{:?}", e.warnings)
    };
    assert!(chi2 > 100.0);
    let trace = bench.carrier.trace();
    assert!((e.carrier.tensor.trace() - trace).abs() < 0.2 * trace, "{}", e.carrier.tensor.trace());
    // its axes x and y exchanged: deviations enlarged by so much leave the size open
    let exchanged = Matrix3::new(0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    let error = of(exchanged * bench.proof * exchanged).unwrap_err();
    let CarrierError::Contradicted { chi2, dof: 4, trace, sigma } = error else { panic!("{error}") };
    assert!(chi2 > 1e6 && trace <= 5.0 * sigma, "{error}");
    // the records exchanged
    let mut turned = Bench { told: bench.proof, ..bench.clone() };
    turned.tumblings[0].attached = Proof;
    turned.tumblings[1].attached = Nothing;
    let exchanged = CarrierRecords::new(turned.record(0, 1.0, &mut Random::new(102)));
    let proof = ProofBody::adding(bench.proof).unwrap();
    let exchanged = exchanged.with_proof(turned.record(1, 1.0, &mut Random::new(103)), proof);
    let error = fit_carrier(&exchanged, &Settings::default()).unwrap_err();
    assert!(matches!(error, CarrierError::Opposite { inverse, .. } if inverse < 0.0), "{error}");
    let right = Bench { told: bench.proof, ..bench };
    let e = fit_carrier(&right.records(1.0, &mut Random::new(102)), &Settings::default()).unwrap();
    assert!(e.warnings.is_empty() && e.agreement.chi2 < 24.0, "{:?}", e.agreement); // 1e-4 of four
}

#[test]
fn a_proof_body_too_light_is_refused_with_its_bound() {
    let mut bench = Bench::new(&[Nothing, Proof], 0.0, &mut Random::new(103));
    let whole = fit_carrier(&bench.records(1.0, &mut Random::new(104)), &Settings::default()).unwrap();
    assert!(whole.sizes[0].relative < 0.02);
    (bench.proof, bench.told) = (bench.proof * 1e-4, bench.told * 1e-4);
    let error = fit_carrier(&bench.records(1.0, &mut Random::new(104)), &Settings::default()).unwrap_err();
    let CarrierError::TooLight { trace, sigma, needed, bound, .. } = error else { panic!("{error}") };
    assert!((trace / bench.proof.trace() - 1.0).abs() < 1e-12 && needed == 5.0);
    assert!((bound * needed * sigma - 1.0).abs() < 1e-12 && bound < bench.carrier.trace());
    let text = error.to_string();
    assert!(text.contains("the proof body is too light") && text.contains("times as heavy"), "{text}");
    // one of the carrier's own shape changes nothing, however heavy
    (bench.proof, bench.told) = (bench.carrier * 2.0, bench.carrier * 2.0);
    let error = fit_carrier(&bench.records(1.0, &mut Random::new(104)), &Settings::default()).unwrap_err();
    assert!(matches!(error, CarrierError::TooLight { .. }), "{error}");
}

#[test]
fn what_gives_no_size_is_refused() {
    let mut random = Random::new(105);
    let (plain, settings) = (Bench::new(&[Nothing, Proof, Object], 0.0, &mut random), Settings::default());
    let turning = Bench { wheel: WHEEL, ..plain.clone() };
    let alone = CarrierRecords::new(plain.record(0, 1.0, &mut random));
    assert_eq!(fit_carrier(&alone, &settings), Err(CarrierError::NoSize { told: None }));
    // a wheel of unknown inertia has no size either
    let unknown = CarrierRecords::new(turning.record(0, 1.0, &mut random)).with_unknown_wheel();
    assert_eq!(fit_carrier(&unknown, &settings), Err(CarrierError::NoSize { told: None }));
    // five numbers of an object
    let error = fit_carrier(&plain.records(1.0, &mut random), &settings).unwrap_err();
    assert_eq!(error, CarrierError::ObjectSize { moved: None });
    assert!(error.to_string().contains("five of the six numbers"), "{error}");

    let proof = ProofBody::adding(plain.proof).unwrap();
    let mixed = CarrierRecords::new(turning.record(0, 1.0, &mut random));
    let mixed = mixed.with_proof(plain.record(1, 1.0, &mut random), proof);
    assert_eq!(fit_carrier(&mixed, &settings), Err(CarrierError::Wheels { with: Nothing, without: Proof }));
    // another axis
    let mut tilted = turning.record(1, 1.0, &mut random);
    let axes = vec![Vector3::x(); Bench::times().len()];
    tilted.segments[0] = tilted.segments[0].clone().with_wheel(axes).unwrap();
    let other = CarrierRecords::new(turning.record(0, 1.0, &mut random)).with_proof(tilted, proof);
    let error = fit_carrier(&other.with_unknown_wheel(), &settings).unwrap_err();
    assert!(
        matches!(error, CarrierError::WheelAxis { attached: Proof, angle } if (angle - 0.8).abs() < 1e-12)
    );
    // speeds of the wrong sign
    let reversed = Bench { tumblings: turning.tumblings[..2].to_vec(), ..turning.clone() };
    let reversed = reversed.records(-1.0, &mut Random::new(107)).with_unknown_wheel();
    let error = fit_carrier(&reversed, &settings.clone().with_torque(TorqueModel::None)).unwrap_err();
    assert!(
        matches!(error, CarrierError::WheelSense { inertia, sigma } if inertia < -5.0 * sigma),
        "{error}"
    );
    // no wheel where one is to be found
    let error = fit_carrier(&alone.clone().with_unknown_wheel(), &settings).unwrap_err();
    assert_eq!(error, CarrierError::Record { attached: Nothing, error: Box::new(FitError::NoWheelSpeed) });

    let known = Settings::default().with_known(Known::Trace(1.0));
    assert_eq!(fit_carrier(&alone, &known), Err(CarrierError::Beforehand { name: "known quantity" }));
    // a record that spins about one axis
    let axis =
        Bench { tumblings: vec![Tumbling { attached: Nothing, omega: Vector3::z() }], ..plain.clone() };
    let axis = Bench { carrier: Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.6)), ..axis };
    let error = fit_carrier(&CarrierRecords::new(axis.record(0, 1.0, &mut random)), &settings).unwrap_err();
    let text = error.to_string();
    assert!(text.starts_with("the record of carrier: the record does not determine the tensor"), "{text}");
    // one record for two, also as a part of the other
    let [one, other] = [0, 1].map(|k| plain.record(k, 1.0, &mut random));
    let both = other.join(one.clone());
    for (first, second) in [(&one, &one), (&one, &both), (&both, &one)] {
        let records = CarrierRecords::new(first.clone()).with_proof(second.clone(), proof);
        let same = CarrierError::Same { attached: Proof, before: Nothing };
        assert_eq!(fit_carrier(&records, &settings), Err(same));
    }
}

#[test]
fn what_is_no_proof_body_is_refused() {
    let flat = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 3.0));
    assert!(matches!(ProofBody::adding(flat), Err(CarrierError::Proof(_))));
    assert!(matches!(ProofBody::adding(Matrix3::zeros()), Err(CarrierError::Setting { .. })));
    assert!(matches!(ProofBody::adding(flat * f64::NAN), Err(CarrierError::Proof(_))));
    let point = MassProperties::point(1.0, Vector3::x()).unwrap();
    for mass in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = ProofBody::attached(&point, mass).unwrap_err();
        assert!(matches!(error, CarrierError::Setting { name: "the mass of the carrier", .. }), "{error}");
    }
    // a point of 1 kg, 1 m from a carrier of 3 kg: 3/4 kg m² across
    let added = ProofBody::attached(&point, 3.0).unwrap().added();
    assert!((added - Matrix3::from_diagonal(&Vector3::new(0.0, 0.75, 0.75))).amax() < 1e-15, "{added}");
}

/// Drag takes energy in the joint fit too: where records of a body without drag ask for a negative one, the answer is that without drag.
#[test]
fn drag_that_would_give_energy_is_held_at_zero() {
    let (mut held, mut free) = (Vec::new(), Vec::new());
    for seed in 0..6 {
        let mut random = Random::new(7_000 + seed);
        let bench = Bench::new(&[Nothing, Proof], 0.0, &mut random);
        let records = bench.records(0.0, &mut random);
        let with = |torque| {
            let settings = Settings::default().with_torque(torque).with_radius(0.4);
            fit_carrier(&records, &settings).unwrap_or_else(|error| panic!("{seed}: {error}"))
        };
        let (drag, none) = (with(TorqueModel::Drag), with(TorqueModel::None));
        let is_held = |e: &CarrierEstimate| {
            e.records.iter().all(|(_, record)| record.torque.coefficients.iter().all(|c| c.value == 0.0))
        };
        let apart = (0..3).map(|k| {
            (drag.carrier.principal[k] - none.carrier.principal[k]).abs() / none.carrier.sigma_principal[k]
        });
        let apart = apart.fold(0.0, f64::max);
        println!("{seed}: held {}, {apart:.4} deviations from the answer without drag", is_held(&drag));
        if is_held(&drag) { held.push(apart) } else { free.push(apart) }
    }
    let most = |of: &[f64]| of.iter().copied().fold(0.0, f64::max);
    assert!(!held.is_empty() && most(&held) < 0.02, "{held:?}");
    assert!(most(&free) > 10.0 * most(&held), "{held:?} {free:?}");
}
