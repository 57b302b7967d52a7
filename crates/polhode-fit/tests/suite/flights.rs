//! Free rotation found in whole recordings: held, thrown and caught, with drag, noise and spikes.

use nalgebra::Vector3;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_fit::{
    Disturbances, FitError, FlightLimit, Gyroscope, Record, Settings, during, fit, flights, simulate_with,
};

const STEP: f64 = 0.01;
const BODY: [f64; 3] = [1.0, 2.0, 2.6];

/// Rates of a hand that turns the body to and fro: three sines a component, about `size` rad/s.
struct Hand {
    sines: [[(f64, f64, f64); 3]; 3],
}

impl Hand {
    fn new(size: f64, random: &mut Random) -> Hand {
        let mut sine = || {
            let frequency = 4.0 + 12.0 * random.uniform();
            (size * (0.3 + 0.7 * random.uniform()), frequency, 7.0 * random.uniform())
        };
        Hand { sines: core::array::from_fn(|_| core::array::from_fn(|_| sine())) }
    }

    fn rate(&self, t: f64) -> Vector3<f64> {
        Vector3::from_fn(|k, _| {
            self.sines[k].iter().map(|(size, frequency, phase)| size * libm::sin(frequency * t + phase)).sum()
        })
    }
}

/// What happens for a while, s.
enum Part {
    Still(f64),
    Held(f64),
    Thrown(f64, Vector3<f64>),
}

/// Times, rates, and the spans of the throws, s.
#[derive(Default)]
struct Recording {
    times: Vec<f64>,
    rates: Vec<Vector3<f64>>,
    throws: Vec<(f64, f64)>,
}

impl Recording {
    fn new(parts: &[Part], drag: f64, gyroscope: &Gyroscope, seed: u64) -> Recording {
        let body = Inertia::from_moments(BODY).unwrap();
        let mut random = Random::new(seed);
        let hand = Hand::new(1.5, &mut random);
        let mut all = Recording::default();
        for part in parts {
            let start = all.times.len() as f64 * STEP;
            let (Part::Still(span) | Part::Held(span) | Part::Thrown(span, _)) = part;
            let own: Vec<f64> = (0..(span / STEP) as usize).map(|i| i as f64 * STEP).collect();
            let read = match part {
                Part::Thrown(_, omega) => {
                    all.throws.push((start, start + span));
                    let air = Disturbances::default().with_relative_drag(drag);
                    simulate_with(&body, *omega, &own, &air, gyroscope, &mut random).unwrap()
                }
                Part::Still(_) => own.iter().map(|_| random.normal_vector() * gyroscope.noise).collect(),
                Part::Held(_) => own
                    .iter()
                    .map(|t| hand.rate(start + t) + random.normal_vector() * gyroscope.noise)
                    .collect(),
            };
            all.times.extend(own.iter().map(|t| start + t));
            all.rates.extend(read);
        }
        all
    }
}

fn throw(k: usize) -> Vector3<f64> {
    let starts = [[2.0, 9.0, 4.0], [8.0, 1.0, 3.0], [1.0, 4.0, 9.0], [-5.0, 6.0, 2.0], [3.0, -9.0, 1.0]];
    starts[k % starts.len()].into()
}

fn tosses(count: usize) -> Vec<Part> {
    let toss = |k: usize| [Part::Held(1.3), Part::Thrown(0.9, throw(k))];
    let parts = (0..count).flat_map(toss);
    core::iter::once(Part::Still(2.0)).chain(parts).chain([Part::Held(1.0), Part::Still(1.0)]).collect()
}

fn noise(sigma: f64) -> Gyroscope {
    Gyroscope::default().with_noise(sigma)
}

#[test]
fn each_throw_of_a_recording_is_found_and_nothing_else() {
    let spiky = Gyroscope::default().with_noise(5e-3).with_spikes(0.005).with_spike_size(3.0);
    for (name, drag, gyroscope) in [
        ("quiet", 0.0, noise(1e-3)),
        ("noisy", 0.0, noise(3e-2)),
        ("in air", 0.2, noise(5e-3)),
        ("with spikes", 0.1, spiky),
    ] {
        for seed in 1..=3 {
            let Recording { times, rates, throws } = Recording::new(&tosses(5), drag, &gyroscope, seed);
            let record = Record::from_samples(&times, &rates).unwrap();
            let found = flights(&record, &Settings::default()).unwrap();
            assert!(!found.whole);
            assert_eq!(found.list.len(), throws.len(), "{name} {seed}: {:?}", found.list);
            assert!(found.others.is_empty() && found.remark_on_others().is_none(), "{:?}", found.others);
            for (flight, (start, end)) in found.list.iter().zip(&throws) {
                // half a radian at either end
                let margin = 0.06;
                assert!(
                    flight.start > start - margin && flight.start < start + 2.0 * margin,
                    "{name} {seed}: {flight:?}"
                );
                assert!(
                    flight.end < end + margin && flight.end > end - 2.0 * margin,
                    "{name} {seed}: {flight:?}"
                );
                for limit in [flight.before, flight.after] {
                    assert!(matches!(limit, FlightLimit::Torque { share } if share > 0.02), "{flight:?}");
                }
                assert!((flight.samples as f64 * STEP - (flight.end - flight.start + STEP)).abs() < 1e-9);
            }
            let estimate = fit(&during(&record, &found.list), &Settings::default()).unwrap();
            for (k, moment) in BODY.iter().enumerate() {
                let off = (estimate.principal[k] - moment / 5.6).abs() / estimate.sigma_principal[k];
                assert!(off < 5.0, "{name} {seed}: I{} is {off} deviations off", k + 1);
            }
        }
    }
}

/// A sensor whose axes change within a record reads two bodies: one is fitted, and where the other is read is said.
#[test]
fn what_another_tensor_explains_is_named() {
    let body = Inertia::from_moments(BODY).unwrap();
    let times: Vec<f64> = (0..2000).map(|i| f64::from(i) * STEP).collect();
    let start = Vector3::new(3.0, 8.0, 4.0);
    let read =
        simulate_with(&body, start, &times, &Disturbances::default(), &noise(1e-2), &mut Random::new(3));
    let read = read.unwrap();
    let changes: [fn(Vector3<f64>) -> Vector3<f64>; 2] =
        [|w| Vector3::new(w.y, w.x, w.z), |w| Vector3::new(w.x, -w.y, w.z)];
    for change in changes {
        let from = 600;
        let rates: Vec<_> =
            read.iter().enumerate().map(|(i, w)| if i < from { *w } else { change(*w) }).collect();
        let found = flights(&Record::from_samples(&times, &rates).unwrap(), &Settings::default()).unwrap();
        let ([one], [other]) = (&found.list[..], &found.others[..]) else { panic!("{found:?}") };
        let mut spans = [(one.start, one.end), (other.start, other.end)];
        spans.sort_by(|a, b| a.0.total_cmp(&b.0));
        let border = from as f64 * STEP;
        let near = |time: f64, expected: f64| (time - expected).abs() < 0.1;
        assert!(near(spans[0].0, 0.0) && near(spans[0].1, border), "{spans:?}");
        assert!(near(spans[1].0, border) && near(spans[1].1, 19.99), "{spans:?}");
        let remark = found.remark_on_others().unwrap();
        assert!(remark.starts_with(&format!("from {:.3} s to {:.3} s the readings", other.start, other.end)));
    }
}

#[test]
fn a_free_record_is_one_flight_and_stays_as_it_is() {
    let body = Inertia::from_moments(BODY).unwrap();
    let times: Vec<f64> = (0..3000).map(|i| f64::from(i) * STEP).collect();
    let none = Disturbances::default();
    let spiky = Gyroscope::default().with_noise(1e-2).with_spikes(0.02).with_spike_size(0.5);
    let off =
        Gyroscope::default().with_noise(1e-2).with_offset(Vector3::new(0.01, -0.01, 0.02)).with_scale(0.02);
    let disturbed = [
        ("quiet", none.clone(), noise(1e-4)),
        ("drowned", none.clone(), noise(0.1)),
        ("drag", none.clone().with_relative_drag(0.1), noise(1e-3)),
        ("torque", none.clone().with_torque(Vector3::new(0.1, 0.0, 0.05)), noise(1e-3)),
        ("torque noise", none.clone().with_torque_noise(0.02), noise(1e-3)),
        ("spikes", none.clone(), spiky),
        ("sensor", none.clone(), off),
    ];
    for (name, disturbances, gyroscope) in disturbed {
        for omega in [Vector3::new(0.3, 1.0, 0.4), Vector3::new(1.0, 0.02, 0.0), Vector3::new(0.0, 0.0, 1.0)]
        {
            let mut random = Random::new(5);
            let rates = simulate_with(&body, omega, &times, &disturbances, &gyroscope, &mut random).unwrap();
            let record = Record::from_samples(&times, &rates).unwrap();
            let found = flights(&record, &Settings::default()).unwrap();
            assert!(found.whole && found.list.len() == 1, "{name} {omega:?}: {found:?}");
            let flight = found.list[0];
            assert_eq!((flight.before, flight.after), (FlightLimit::Edge, FlightLimit::Edge));
            assert_eq!((flight.start, flight.end, flight.samples), (0.0, times[2999], 3000));
            assert_eq!(during(&record, &found.list), record, "{name}");
        }
    }
}

#[test]
fn flights_reach_the_ends_of_segments() {
    // thrown before the sensor was switched on, and a gap within the second throw
    let parts = [Part::Thrown(0.8, throw(0)), Part::Held(1.0), Part::Thrown(1.6, throw(1)), Part::Held(1.0)];
    let Recording { mut times, mut rates, .. } = Recording::new(&parts, 0.0, &noise(2e-3), 11);
    times.drain(260..280);
    rates.drain(260..280);
    let record = Record::from_samples(&times, &rates).unwrap();
    assert_eq!(record.segments.len(), 2);
    let found = flights(&record, &Settings::default()).unwrap();
    let limits: Vec<(usize, bool, bool)> = found
        .list
        .iter()
        .map(|f| (f.segment, f.before == FlightLimit::Edge, f.after == FlightLimit::Edge))
        .collect();
    assert_eq!(limits, [(0, true, false), (0, false, true), (1, true, false)]);
    assert_eq!(found.list[0].start, 0.0);
    assert_eq!((found.list[1].end, found.list[2].start), (times[259], times[260]));
    let turned = found.list[0].turned;
    let expected = throw(0).norm() * 0.8;
    assert!(turned > 0.7 * expected && turned < 1.3 * expected, "{turned}");
}

/// The record of an app that is started in the hand, of one throw, and of the rest after it: however long it rests, the throw alone is fitted.
#[test]
fn one_throw_before_or_after_a_rest_is_cut_out() {
    for (k, rest) in [1.0, 2.0, 4.0].into_iter().enumerate() {
        for (seed, sigma) in [(1, 1e-3), (2, 2e-2)] {
            let before = [Part::Still(rest), Part::Thrown(0.9, throw(k))];
            let after = [Part::Thrown(0.9, throw(k)), Part::Still(rest)];
            let both = [Part::Still(0.7), Part::Thrown(0.9, throw(k)), Part::Still(rest)];
            for parts in [&before[..], &after[..], &both[..]] {
                let Recording { times, rates, throws } = Recording::new(parts, 0.1, &noise(sigma), seed);
                let record = Record::from_samples(&times, &rates).unwrap();
                let found = flights(&record, &Settings::default()).unwrap();
                let ([flight], [(start, end)]) = (&found.list[..], &throws[..]) else { panic!("{found:?}") };
                assert!(!found.whole && found.others.is_empty(), "{rest} {sigma}: {found:?}");
                // a radian at either end
                let is_near = |time: f64, expected: f64| (time - expected).abs() < 0.12;
                assert!(
                    is_near(flight.start, *start) && is_near(flight.end, *end),
                    "{rest} {sigma}: {flight:?}"
                );
                let estimate = fit(&during(&record, &found.list), &Settings::default()).unwrap();
                for (k, moment) in BODY.iter().enumerate() {
                    let off = (estimate.principal[k] - moment / 5.6).abs() / estimate.sigma_principal[k];
                    assert!(off < 5.0, "{rest} {sigma}: I{} is {off} deviations off", k + 1);
                }
            }
        }
    }
}

/// A body that drag brings to rest is free to the end, and so is one that is as slender as a needle and turns over.
#[test]
fn a_free_body_that_comes_to_rest_by_itself_is_one_flight() {
    let times: Vec<f64> = (0..3000).map(|i| f64::from(i) * STEP).collect();
    let gyroscope = noise(1e-2);
    for (moments, omega, drag) in [
        (BODY, Vector3::new(3.0, 8.0, 4.0), 0.2),
        (BODY, Vector3::new(3.0, 8.0, 4.0), 1.0),
        (BODY, Vector3::new(8.0, 0.5, 0.5), 0.5),
        ([0.02, 1.0, 1.01], Vector3::new(0.1, 5.0, 0.1), 0.0),
        ([0.02, 1.0, 1.01], Vector3::new(30.0, 2.0, 0.1), 0.5),
    ] {
        let body = Inertia::from_moments(moments).unwrap();
        let air = Disturbances::default().with_relative_drag(drag);
        let rates = simulate_with(&body, omega, &times, &air, &gyroscope, &mut Random::new(5)).unwrap();
        let record = Record::from_samples(&times, &rates).unwrap();
        let found = flights(&record, &Settings::default()).unwrap();
        assert!(found.whole && found.list.len() == 1, "{omega} {drag}: {found:?}");
    }
}

#[test]
fn a_body_that_is_never_let_go_has_no_flight() {
    for seed in 1..=5 {
        let parts = [Part::Still(1.0), Part::Held(9.0), Part::Still(2.0), Part::Held(5.0)];
        let Recording { times, rates, .. } = Recording::new(&parts, 0.0, &noise(2e-3), seed);
        let record = Record::from_samples(&times, &rates).unwrap();
        let error = flights(&record, &Settings::default()).unwrap_err();
        let FitError::NoFlight { share, torque, most } = error.clone() else { panic!("{error:?}") };
        assert!(share > 0.1 && share <= 1.0 && most == 0.02, "{share}");
        assert!(torque.is_none_or(|torque| torque > most && torque < 10.0), "{torque:?}");
        let says = "the body rotates freely nowhere in the record: torques above 0.3 tr(J) |w|^2 act in ";
        assert!(error.to_string().starts_with(says), "{error}");
    }
}

/// In revolutions a second that are read as rad/s no tensor follows the motion of a free body, though a quarter of its time contradicts none: the unit is
/// named, and where units are to be trusted the body is never let go.
#[test]
fn a_free_record_in_a_wrong_unit_is_named_by_its_unit() {
    let body = Inertia::from_moments([0.4, 1.0, 1.2]).unwrap();
    let times: Vec<f64> = (0..2000).map(|i| 0.004 * f64::from(i)).collect();
    let (none, start) = (Disturbances::default(), Vector3::new(8.0, 5.0, 7.0));
    let rates = simulate_with(&body, start, &times, &none, &noise(0.01), &mut Random::new(7)).unwrap();
    let rates: Vec<Vector3<f64>> = rates.iter().map(|w| w / core::f64::consts::TAU).collect();
    let record = Record::from_samples(&times, &rates).unwrap();
    let found = |check: bool| flights(&record, &Settings::default().with_check_units(check)).unwrap_err();
    let refused = found(true);
    assert!(matches!(refused, FitError::Units { .. }), "{refused}");
    assert!(refused.to_string().contains("rates in rev/s read as rad/s"), "{refused}");
    let FitError::NoFlight { share, .. } = found(false) else { panic!() };
    assert!((0.5..0.9).contains(&share), "{share}");
}

#[test]
fn neither_units_nor_the_axes_of_the_sensor_change_the_flights() {
    let Recording { times, rates, throws } = Recording::new(&tosses(3), 0.1, &noise(5e-3), 4);
    let found = |times: &[f64], rates: &[Vector3<f64>]| {
        flights(&Record::from_samples(times, rates).unwrap(), &Settings::default()).unwrap().list
    };
    let spans = |list: &[polhode_fit::Flight], unit: f64| -> Vec<(f64, f64)> {
        list.iter().map(|f| (f.start * unit, f.end * unit)).collect()
    };
    let own = spans(&found(&times, &rates), 1.0);
    assert_eq!(own.len(), throws.len());
    let (slow, fast): (Vec<f64>, Vec<Vector3<f64>>) =
        (times.iter().map(|t| t * 1024.0).collect(), rates.iter().map(|w| w / 1024.0).collect());
    assert_eq!(spans(&found(&slow, &fast), 1.0 / 1024.0), own);
    let cyclic: Vec<Vector3<f64>> = rates.iter().map(|w| Vector3::new(w.z, w.x, w.y)).collect();
    for ((a, b), (c, d)) in spans(&found(&times, &cyclic), 1.0).iter().zip(&own) {
        assert!((a - c).abs() < 0.021 && (b - d).abs() < 0.021, "{a} {b} {c} {d}");
    }
}
