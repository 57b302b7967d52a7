//! Attitudes from rates, increments and averages against the exact motion.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::body::Body;
use polhode::flow::{ExactMotion, FreeMotion};
use polhode::inertia::Inertia;
use polhode::num::{Dd, Precise, Real};
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode::strapdown::{
    Budgeted, Estimate, Flight, FlightError, Kind, Rule, Sensor, Strapdown, StrapdownError, attitudes,
    choose, noise,
};

use crate::motions::started;

/// A motion whose attitude and rates are known at any time.
struct Known {
    body: Body,
    motion: ExactMotion,
}

impl Known {
    fn of((body, start): (Body, polhode::State)) -> Self {
        let motion = ExactMotion::new(&body, &start).unwrap();
        Known { body, motion }
    }

    fn free() -> Self {
        Self::of(started(Body::free(Inertia::from_moments([1.0, 2.0, 3.0]).unwrap()), [0.4, 1.0, -0.3]))
    }

    fn top() -> Self {
        let inertia = Inertia::from_moments([1.0, 1.0, 0.25]).unwrap();
        Self::of(started(Body::heavy(inertia, [0.0, 0.0, 0.7].into()).unwrap(), [0.3, -0.2, 0.9]))
    }

    fn attitude(&self, t: f64) -> Quat<f64> {
        self.motion.at(t).unwrap().attitude
    }

    fn rate(&self, t: f64) -> Vec3<f64> {
        self.body.omega_body(&self.motion.at(t).unwrap()).into()
    }

    /// ∫ω dt by Gauss's rule of four points in each of four parts.
    fn increment(&self, from: f64, to: f64) -> Vec3<f64> {
        const POINTS: [(f64, f64); 2] = [
            (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
            (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
        ];
        let h = (to - from) / 4.0;
        let mut sum = Vec3::zero();
        for part in 0..4 {
            let middle = from + h * (f64::from(part) + 0.5);
            for (x, weight) in POINTS {
                let pair = self.rate(middle - 0.5 * h * x) + self.rate(middle + 0.5 * h * x);
                sum = sum + pair * (0.5 * h * weight);
            }
        }
        sum
    }

    fn readings(&self, kind: Kind, times: &[f64]) -> Vec<Vec3<f64>> {
        let reading = |k: usize| match (kind, k) {
            (Kind::Rate, _) => self.rate(times[k]),
            // of the first interval nothing is known, and nothing may depend on it
            (_, 0) => Vec3([0.3, -0.1, 0.2]),
            (Kind::Increment, _) => self.increment(times[k - 1], times[k]),
            (Kind::Average, _) => self.increment(times[k - 1], times[k]) * (1.0 / (times[k] - times[k - 1])),
        };
        (0..times.len()).map(reading).collect()
    }

    fn vectors(&self, kind: Kind, times: &[f64]) -> Vec<Vector3<f64>> {
        self.readings(kind, times).into_iter().map(Vector3::from).collect()
    }

    fn start(&self, times: &[f64]) -> UnitQuaternion<f64> {
        self.attitude(times[0]).into()
    }

    /// The largest attitude error over samples at `times`.
    fn error(&self, kind: Kind, rule: Rule, times: &[f64]) -> f64 {
        let all = integrated(kind, rule, self.attitude(times[0]), times, &self.readings(kind, times));
        let errors = all.iter().zip(times).map(|(q, t)| rotation_angle(*q, self.attitude(*t)));
        errors.fold(0.0, f64::max)
    }
}

/// The attitudes of a stream, one for each sample.
fn integrated<S: Precise>(
    kind: Kind,
    rule: Rule,
    start: Quat<S>,
    times: &[S],
    readings: &[Vec3<S>],
) -> Vec<Quat<S>> {
    let mut strapdown = Strapdown::new(kind, rule, start).unwrap();
    let mut known = Vec::new();
    for (k, (time, reading)) in times.iter().zip(readings).enumerate() {
        known.extend_from_slice(strapdown.push(*time, *reading).unwrap());
        // an attitude waits for as many samples as the rule says
        assert!(k < 12 || known.len() == k + 1 - strapdown.delay());
    }
    known.extend_from_slice(strapdown.finish());
    assert_eq!(known.len(), times.len());
    assert!(known.iter().zip(times).all(|(known, t)| known.time == *t));
    known.into_iter().map(|known| known.attitude).collect()
}

/// Uniform numbers in (0, 1): SplitMix64 (Steele, Lea, Flood 2014).
struct Uniform(u64);

impl Uniform {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((z ^ (z >> 31)) >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
    }

    /// Uniform with mean 0 and variance 1 along each axis.
    fn vector(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| (self.next() - 0.5) * 12_f64.sqrt())
    }
}

fn even(h: f64, until: f64) -> Vec<f64> {
    (0..=(until / h).round() as u32).map(|k| h * f64::from(k)).collect()
}

fn magnus(order: u32, samples: usize) -> Rule {
    Rule::magnus(order, samples).unwrap()
}

#[test]
fn errors_are_those_of_an_independent_program() {
    // moments 1, 2, 3 at 0.055 rad a sample: figures of a program in Python, over 1000 s, of errors that grow with the time, here
    // over a quarter of it
    let body = Known::free();
    let times = even(0.05, 250.0);
    for (kind, rule, expected) in [
        (Kind::Rate, Rule::Trapezoid, 3.5e-2),
        (Kind::Rate, Rule::RungeKutta, 3.5e-2),
        (Kind::Rate, Rule::TwoSpeed, 3.4e-2),
        (Kind::Rate, magnus(4, 4), 2.7e-6),
        (Kind::Rate, magnus(6, 6), 3.8e-9),
        (Kind::Rate, magnus(6, 8), 3.5e-10),
        (Kind::Increment, magnus(6, 8), 3.5e-10),
    ] {
        let ratio = body.error(kind, rule, &times) / (0.25 * expected);
        assert!((0.8..1.3).contains(&ratio), "{kind} {rule}: {ratio}");
    }
}

#[test]
fn rules_have_their_orders_on_the_free_body_and_on_a_top() {
    for (name, motion) in [("free", Known::free()), ("top", Known::top())] {
        for kind in Kind::ALL {
            let of = |rule: Rule, order: f64, h: f64| {
                let error = |h: f64| motion.error(kind, rule, &even(h, 12.8));
                let slope = libm::log2(error(h) / error(0.5 * h));
                assert!((slope - order).abs() < 0.15, "{name} {kind} {rule}: {slope}");
            };
            of(magnus(2, 2), 2.0, 0.1);
            of(magnus(4, 4), 4.0, 0.1);
            of(magnus(6, 6), 6.0, 0.2);
            of(Rule::Hold, if kind == Kind::Rate { 1.0 } else { 2.0 }, 0.05);
            of(Rule::Trapezoid, if kind == Kind::Rate { 2.0 } else { 3.0 }, 0.1);
            if kind == Kind::Rate {
                of(Rule::TwoSpeed, 2.0, 0.025);
            }
        }
    }
}

/// Times with a scatter of a third of the interval, and two gaps of some intervals.
fn scattered(h: f64, count: u32) -> Vec<f64> {
    let golden = |k: u32| (0.618_033_988_749_894_9 * f64::from(k)).fract() - 0.5;
    let shift = |k: u32| f64::from(u8::from(k > count / 3)) * 2.0 + f64::from(u8::from(k > count / 2));
    (0..count).map(|k| h * (f64::from(k) + 0.6 * golden(k) + shift(k))).collect()
}

#[test]
fn rates_and_increments_agree_at_any_stamps() {
    let body = Known::free();
    for (h, bound) in [(0.1, 3e-5), (0.05, 2e-7)] {
        let times = scattered(h, (20.0 / h) as u32);
        let start = body.attitude(times[0]);
        let [rates, increments, averages] = Kind::ALL.map(|kind| {
            integrated(kind, magnus(6, 8), start, &times, &body.readings(kind, &times)).pop().unwrap()
        });
        let truth = body.attitude(times[times.len() - 1]);
        let truncation = rotation_angle(rates, truth);
        assert!(truncation < bound && rotation_angle(increments, truth) < bound, "{truncation:e}");
        assert!(rotation_angle(increments, averages) < 1e-13);
    }
}

#[test]
fn double_double_has_the_digits_that_the_rule_has() {
    // ω = (cos νt, sin νt, 2): q(t) = exp(½ t (1, 0, 2 + ν)) exp(−½ t (0, 0, ν)), ν = 3
    let end = |h: f64| {
        let count = (4.0 / h) as u32;
        let times: Vec<Dd> = (0..=count).map(|k| Dd::of(h) * f64::from(k)).collect();
        let rate = |t: &Dd| {
            let (sin, cos) = (*t * 3.0).sin_cos();
            Vec3([cos, sin, Dd::of(2.0)])
        };
        let rates: Vec<Vec3<Dd>> = times.iter().map(rate).collect();
        let start = Quat::<Dd>::identity();
        let last = integrated(Kind::Rate, magnus(6, 12), start, &times, &rates).pop().unwrap();
        let turn = |z: f64| Quat::exponential(Vec3([Dd::ZERO, Dd::ZERO, Dd::of(z)]));
        let exact = Quat::exponential(Vec3([Dd::of(4.0), Dd::ZERO, Dd::of(20.0)])) * turn(-12.0);
        rotation_angle(last, exact).hi()
    };
    let (coarse, fine) = (end(1.0 / 256.0), end(1.0 / 512.0));
    assert!(fine < 1e-18 && (libm::log2(coarse / fine) - 6.0).abs() < 0.1, "{coarse:e} {fine:e}");
}

#[test]
fn a_constant_rate_is_exact_by_every_rule_and_at_every_number_of_samples() {
    let rate = Vec3([0.3, -0.2, 0.9]);
    for kind in Kind::ALL {
        for rule in Rule::RIVALS.into_iter().chain([magnus(2, 2), magnus(4, 6), magnus(6, 12)]) {
            if rule.check(kind).is_err() {
                assert_eq!((rule, kind == Kind::Rate), (Rule::RungeKutta, false));
                continue;
            }
            for count in [1, 2, 3, 5, 8, 13, 40, 100] {
                let times = scattered(0.2, count);
                let size = |k: usize| times[k] - times[k.saturating_sub(1)];
                let reading = |k: usize| if kind == Kind::Increment { rate * size(k) } else { rate };
                let readings: Vec<_> = (0..times.len()).map(reading).collect();
                let last = integrated(kind, rule, Quat::identity(), &times, &readings).pop().unwrap();
                let exact = Quat::exponential(rate * (times[times.len() - 1] - times[0]));
                let bound = if rule == Rule::RungeKutta { 1e-3 } else { 1e-12 };
                assert!(rotation_angle(last, exact) < bound, "{kind} {rule} {count}");
            }
        }
    }
}

#[test]
fn a_budget_has_the_bits_of_the_stream_and_its_own_error() {
    let body = Known::free();
    for kind in Kind::ALL {
        for rule in [magnus(2, 2), magnus(4, 4), magnus(6, 8), Rule::Hold, Rule::Trapezoid, Rule::TwoSpeed] {
            for times in [even(0.2, 60.0), scattered(0.1, 300)] {
                let (readings, start) = (body.vectors(kind, &times), body.start(&times));
                let all = attitudes(&times, &readings, kind, rule, start, Sensor::default()).unwrap();
                let plain = integrated(kind, rule, start.into(), &times, &body.readings(kind, &times));
                for (estimate, q) in all.iter().zip(&plain) {
                    assert_eq!(estimate.attitude, UnitQuaternion::from(*q));
                }
                let last = all.last().unwrap();
                let error = last.error(body.attitude(times[times.len() - 1]).into()).norm();
                let ratio = last.budget.truncation / error;
                assert!((0.5..2.0).contains(&ratio), "{kind} {rule}: {error:e}, {ratio}");
            }
        }
    }
}

#[test]
fn covariances_are_those_of_differences() {
    // each cause by finite differences of whole runs, at a turn of 0.35 rad a sample, where stencils do not just add up
    let body = Known::free();
    let times = even(0.3, 6.0);
    for (kind, rule) in
        [(Kind::Rate, magnus(6, 8)), (Kind::Increment, magnus(6, 6)), (Kind::Rate, Rule::Trapezoid)]
    {
        let (readings, start) = (body.vectors(kind, &times), body.start(&times));
        let run = |readings: &[Vector3<f64>], sensor: Sensor| -> Estimate {
            *attitudes(&times, readings, kind, rule, start, sensor).unwrap().last().unwrap()
        };
        let plain = run(&readings, Sensor::default());
        let step = 1e-6;
        let moved = |change: &dyn Fn(usize) -> Vector3<f64>| {
            let changed: Vec<_> = readings.iter().enumerate().map(|(k, r)| r + change(k)).collect();
            plain.error(run(&changed, Sensor::default()).attitude) / step
        };
        let unit = |axis: usize| Vector3::ith(axis, step);
        let size =
            |k: usize| if kind == Kind::Increment { 0.3 } else { f64::from(u8::from(k < times.len())) };
        let mut by_noise = 0.0;
        for j in 0..times.len() {
            for axis in 0..3 {
                by_noise += moved(&|k| if k == j { unit(axis) } else { Vector3::zeros() }).norm_squared();
            }
        }
        let by_bias: f64 = (0..3).map(|axis| moved(&|k| unit(axis) * size(k)).norm_squared()).sum();
        let own = |axis: usize| move |k: usize, r: &[Vector3<f64>]| Vector3::ith(axis, step * r[k][axis]);
        let by_scale: f64 = (0..3).map(|axis| moved(&|k| own(axis)(k, &readings)).norm_squared()).sum();
        let sensor = Sensor::default().with_noise(1e-3).with_bias(1e-3).with_scale(1e-3);
        let found = run(&readings, sensor).budget;
        for (name, sum, found) in [
            ("noise", by_noise, found.random_walk),
            ("bias", by_bias, found.bias),
            ("scale", by_scale, found.scale),
        ] {
            let ratio = found / (1e-3 * (sum / 3.0_f64).sqrt());
            assert!((ratio - 1.0).abs() < 0.02, "{kind} {rule} {name}: {ratio}");
        }
    }
}

#[test]
fn stamps_move_rates_as_their_slope_and_increments_as_their_ends() {
    let body = Known::free();
    let times = even(0.05, 10.0);
    let mut uniform = Uniform(3);
    for (kind, rule) in
        [(Kind::Rate, magnus(6, 6)), (Kind::Average, magnus(6, 6)), (Kind::Increment, magnus(6, 6))]
    {
        let start = body.start(&times);
        let mut square = 0.0;
        const RUNS: usize = 40;
        for _ in 0..RUNS {
            let true_times: Vec<f64> = times.iter().map(|t| t + 1e-4 * uniform.vector().x).collect();
            let readings = body.vectors(kind, &true_times);
            let all = attitudes(&times, &readings, kind, rule, start, Sensor::default()).unwrap();
            square += all.last().unwrap().error(body.attitude(times[times.len() - 1]).into()).norm_squared();
        }
        let sensor = Sensor::default().with_stamps(1e-4);
        let readings = body.vectors(kind, &times);
        let found =
            attitudes(&times, &readings, kind, rule, start, sensor).unwrap().last().unwrap().budget.stamps;
        let ratio = found / (square / (3 * RUNS) as f64).sqrt();
        assert!((0.75..1.33).contains(&ratio), "{kind}: {ratio}");
    }
}

#[test]
fn noise_is_found_and_the_rule_is_chosen_with_it() {
    let body = Known::free();
    let times = even(0.2, 100.0);
    let exact = body.vectors(Kind::Rate, &times);
    let noisy = |sigma: f64| -> Vec<Vector3<f64>> {
        let mut uniform = Uniform(1);
        exact.iter().map(|w| w + uniform.vector() * sigma).collect()
    };
    assert!(noise(&times, &exact) < 2e-6);
    for sigma in [1e-1, 1e-2, 1e-3] {
        let found = noise(&times, &noisy(sigma));
        assert!((found / sigma - 1.0).abs() < 0.15, "{sigma}: {found}");
    }
    let chosen = |sigma: f64| {
        let sensor = Sensor::default().with_noise(sigma);
        choose(&times, &noisy(sigma), Kind::Rate, None, None, sensor).unwrap()
    };
    let order = |rule: Rule| if let Rule::Magnus(magnus) = rule { magnus.order() } else { 0 };
    assert_eq!(order(chosen(1e-9)), 6);
    assert!(order(chosen(0.1)) < 6);
}

#[test]
fn a_long_flight_has_the_covariance_that_its_time_needs() {
    let body = Inertia::from_moments([1.0, 2.0, 3.0]).unwrap();
    let omega = Vector3::new(0.4, 1.0, -0.3);
    let truth = FreeMotion::from_omega(&body, UnitQuaternion::identity(), omega).unwrap();
    let sensor = Sensor::default().with_noise(1e-3);
    let sigma = |until: f64| {
        let times: Vec<f64> = (0..1000).map(|k| until * f64::from(k) / 999.0).collect();
        let rates: Vec<_> = times.iter().map(|t| truth.omega_at(*t).unwrap()).collect();
        let flight = Flight::fit(&body, &times, &rates, UnitQuaternion::identity(), sensor).unwrap();
        flight.at(&times).unwrap()[999].budget.sigma()
    };
    // the mean precession is known to 1/sqrt(n), and the angle is that times the time: JᵀJ has a condition of 1e10 and more here
    let (short, long) = (sigma(1e3), sigma(1e6));
    assert!((long / short / 1e3 - 1.0).abs() < 0.05, "{short} {long}");
    // three thousand components of rates
    assert!((0.3..3.0).contains(&(short / (1e3 * 1e-3 / 3000.0_f64.sqrt()))), "{short}");
}

#[test]
fn a_flight_is_smoothed_on_its_exact_motion() {
    let inertia = Inertia::from_moments([1.0, 2.0, 3.0]).unwrap();
    let truth =
        FreeMotion::from_omega(&inertia, UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3)).unwrap();
    let times = even(0.05, 60.0);
    let sigma = 1e-2;
    let mut uniform = Uniform(2);
    let rates: Vec<Vector3<f64>> =
        times.iter().map(|t| truth.omega_at(*t).unwrap() + uniform.vector() * sigma).collect();
    let sensor = Sensor::default().with_noise(sigma);
    let flight = Flight::fit(&inertia, &times, &rates, UnitQuaternion::identity(), sensor).unwrap();
    let smoothed = flight.at(&times).unwrap();
    let plain =
        attitudes(&times, &rates, Kind::Rate, magnus(4, 4), UnitQuaternion::identity(), sensor).unwrap();
    let last = |all: &[Estimate]| *all.last().unwrap();
    assert!(last(&smoothed).budget.sigma() < last(&plain).budget.sigma());
    let error = last(&smoothed).error(truth.at(60.0).unwrap().rotation()).norm();
    assert!(error < 4.0 * 3_f64.sqrt() * last(&smoothed).budget.sigma(), "{error:e}");
    assert!((flight.chi2_per_dof().unwrap() - 1.0).abs() < 0.1);
    let apart = |smoothed: &[Estimate]| {
        let pairs = smoothed.iter().zip(&plain);
        pairs.map(|(one, other)| one.deviations_from(other)).fold(0.0, f64::max)
    };
    assert!(apart(&smoothed) < Estimate::CONTRADICTION, "{}", apart(&smoothed));
    // a body that is one percent another one leaves little in the residuals, and has another attitude
    let near = Inertia::from_moments([1.0, 2.02, 3.0]).unwrap();
    let flight = Flight::fit(&near, &times, &rates, UnitQuaternion::identity(), sensor).unwrap();
    let smoothed = flight.at(&times).unwrap();
    assert!(flight.chi2_per_dof().unwrap() < 1.25, "{flight:?}");
    assert!(apart(&smoothed) > Estimate::CONTRADICTION, "{}", apart(&smoothed));
    // another body
    let other = Inertia::from_moments([1.0, 1.2, 2.0]).unwrap();
    let refused = Flight::fit(&other, &times, &rates, UnitQuaternion::identity(), sensor);
    assert!(matches!(refused, Err(FlightError::Contradicted { .. })), "{refused:?}");
    let few = Flight::fit(&inertia, &times[..5], &rates[..5], UnitQuaternion::identity(), sensor);
    assert_eq!(few.unwrap_err(), FlightError::Few { samples: 5 });
}

#[test]
fn readings_that_tell_no_attitude_are_refused_by_name() {
    let new = |kind| Strapdown::new(kind, magnus(4, 4), Quat::<f64>::identity()).unwrap();
    let mut rates = new(Kind::Rate);
    rates.push(0.0, Vec3([1.0, 0.0, 0.0])).unwrap();
    let fast = rates.push(1.0, Vec3([0.0, 3.2, 0.0])).unwrap_err();
    assert_eq!(fast, StrapdownError::HalfTurn { sample: 1, time: 1.0, angle: 3.2 });
    assert!(fast.to_string().contains("aliasing"));
    let again = rates.push(0.0, Vec3([1.0, 0.0, 0.0])).unwrap_err();
    assert_eq!(again, StrapdownError::Order { sample: 1, time: 0.0, before: 0.0 });
    let broken = rates.push(f64::NAN, Vec3([1.0, 0.0, 0.0])).unwrap_err();
    assert!(broken.to_string().starts_with("sample 1: the time is NaN"), "{broken}");
    assert!(rates.push(0.5, Vec3([f64::INFINITY, 0.0, 0.0])).is_err());
    // what was refused was not taken
    rates.push(0.5, Vec3([1.0, 0.0, 0.0])).unwrap();
    assert!(rotation_angle(rates.finish()[0].attitude, Quat::exponential(Vec3([0.5, 0.0, 0.0]))) < 1e-15);
    // more samples may follow
    rates.push(1.0, Vec3([1.0, 0.0, 0.0])).unwrap();
    assert!(rotation_angle(rates.finish()[0].attitude, Quat::exponential(Vec3([1.0, 0.0, 0.0]))) < 1e-15);
    let mut increments = new(Kind::Increment);
    increments.push(0.0, Vec3([9.0, 0.0, 0.0])).unwrap();
    assert!(increments.push(1e-3, Vec3([3.2, 0.0, 0.0])).is_err());
    assert!(Strapdown::new(Kind::Average, Rule::RungeKutta, Quat::<f64>::identity()).is_err());
    assert!(Strapdown::new(Kind::Rate, Rule::Hold, Quat::<f64>::zero()).is_err());
    let sensor = Sensor::default().with_bias(-1.0);
    let bad = Budgeted::new(Kind::Rate, Rule::Hold, UnitQuaternion::identity(), sensor).unwrap_err();
    assert!(bad.to_string().contains("the bias"), "{bad}");
    // 0 times its square would be no number, and count as 0
    let sensor = Sensor::default().with_scale(1e200);
    let bad = Budgeted::new(Kind::Rate, Rule::Hold, UnitQuaternion::identity(), sensor).unwrap_err();
    assert_eq!(bad, StrapdownError::Sensor { name: "the scale error", value: 1e200 });
    assert!(
        attitudes(&[], &[], Kind::Rate, Rule::Hold, UnitQuaternion::identity(), Sensor::default()).is_err()
    );
    assert!("speed".parse::<Kind>().unwrap_err().to_string().contains("rate, increment, average"));
}

#[test]
fn a_stream_takes_constant_memory() {
    // what has nothing to free has no heap that could grow
    const { assert!(!core::mem::needs_drop::<Strapdown<f64>>() && size_of::<Strapdown<f64>>() < 8192) };
}
