//! The closed form against fixtures of 40 digits (tests/data/gyrostat, Taylor series) and against itself in double-double.

use super::*;
use crate::rotation::rotation_angle;

struct Case {
    scenario: String,
    moments: Vec3<Dd>,
    wheel: Vec3<Dd>,
    start: Point<Dd>,
    t: Dd,
    after: Point<Dd>,
}

fn cases() -> Vec<Case> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/gyrostat/reference.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let case = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        // those of the start are doubles
        let double = |at: usize| Dd::of(fields[at].parse().unwrap());
        let start = |at: usize| Vec3([0, 1, 2].map(|k| double(at + k)));
        let vector = |at: usize| Vec3([0, 1, 2].map(|k| fields[at + k].parse::<Dd>().unwrap()));
        let quat =
            |at: usize| Quat::from_components([0, 1, 2, 3].map(|k| fields[at + k].parse::<Dd>().unwrap()));
        Case {
            scenario: fields[0].into(),
            moments: start(2),
            wheel: start(5),
            start: Point::new(quat(11), start(8)),
            t: double(15),
            after: Point::new(quat(19), vector(16)),
        }
    };
    text.lines().skip(1).map(case).collect()
}

/// Errors of attitude (rad) and momentum (of |m|).
fn off(found: &Point<Dd>, truth: &Point<Dd>) -> [f64; 2] {
    let norm = truth.momentum_body.norm_of_any_size().hi();
    let momentum = (found.momentum_body - truth.momentum_body).norm_of_any_size().hi();
    let sign = (found.attitude - truth.attitude).magnitude() < 1.0;
    assert!(sign, "the other lift");
    [
        rotation_angle(found.attitude.normalized(), truth.attitude).hi(),
        if norm == 0.0 { momentum } else { momentum / norm },
    ]
}

#[test]
fn fixtures_of_all_regimes() {
    let mut worst: Vec<(String, [f64; 4])> = Vec::new();
    for case in cases() {
        let orbit = match GyrostatOrbit::new(case.moments, case.wheel, case.start) {
            Ok(orbit) => orbit,
            Err(reason) => {
                println!("{}: {reason}", case.scenario);
                continue;
            }
        };
        let [q, m] = off(&orbit.point_after(case.t).to_dd(), &case.after);
        let [q_dd, m_dd] = off(&orbit.point_at_dd(case.t), &case.after);
        if worst.last().is_none_or(|last| last.0 != case.scenario) {
            worst.push((case.scenario.clone(), [0.0; 4]));
        }
        if let Some(last) = worst.last_mut() {
            for (x, new) in last.1.iter_mut().zip([q, m, q_dd, m_dd]) {
                *x = x.max(new);
            }
        }
    }
    for (scenario, [q, m, q_dd, m_dd]) in worst {
        println!("{scenario:40} {q:.1e} {m:.1e}   {q_dd:.1e} {m_dd:.1e}");
    }
}

struct Random(u64);

impl Random {
    fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / 4_503_599_627_370_496.0 - 1.0
    }

    /// Between 10^low and 10^high.
    fn decade(&mut self, low: f64, high: f64) -> f64 {
        let place = 0.5 * (self.number() + 1.0);
        libm::exp10(low + (high - low) * place)
    }

    fn vector(&mut self) -> Vec3<f64> {
        Vec3([self.number(), self.number(), self.number()])
    }

    fn choice(&mut self, of: usize) -> usize {
        ((0.5 * (self.number() + 1.0)) * of as f64) as usize
    }

    /// Moments, wheel and start of a body of one of the kinds, with its name.
    fn gyrostat(&mut self) -> (&'static str, Vec3<Dd>, Vec3<Dd>, Point<Dd>) {
        let mut moments = self.vector().map(|x| 1.5 + 0.5 * x);
        let mut wheel = self.vector();
        let mut momentum = self.vector();
        let axis = self.choice(3);
        let other = (axis + 1) % 3;
        let kinds = [
            "generic",
            "weak",
            "strong",
            "axial",
            "plane",
            "symmetric",
            "almost",
            "ball",
            "start",
            "rod",
            "near axial",
            "free",
        ];
        let kind = kinds[self.choice(kinds.len())];
        match kind {
            "weak" => wheel = wheel * self.decade(-16.0, -1.0),
            "strong" => {
                let at = wheel * self.decade(0.0, 3.0);
                (wheel, momentum) = (at, at + momentum);
            }
            "axial" => wheel = Vec3::unit(axis) * wheel[axis],
            "plane" => wheel[axis] = 0.0,
            "symmetric" => {
                moments[axis] = moments[other];
                if self.number() > 0.0 {
                    (wheel[axis], wheel[other]) = (0.0, 0.0);
                }
            }
            "almost" => moments[axis] = moments[other] * (1.0 + self.decade(-16.0, -1.0)),
            "near axial" => {
                let (one, two) = (self.decade(-20.0, -1.0), self.decade(-20.0, -1.0));
                moments[axis] = moments[other] * (1.0 + self.decade(-16.0, -1.0));
                (wheel[axis], wheel[other]) = (one, two);
            }
            "free" => wheel = Vec3::zero(),
            "ball" => moments = Vec3([0, 1, 2].map(|_| 1.5 * (1.0 + 1e-3 * self.decade(-14.0, 0.0)))),
            "start" => momentum[axis] = 0.0,
            "rod" => moments[axis] = self.decade(-3.0, 0.0),
            _ => {}
        }
        let q = Quat::from_components([self.number(), self.number(), self.number(), self.number()]);
        let q = q.map(Dd::of).normalized();
        (kind, moments.map(Dd::of), wheel.map(Dd::of), Point::new(q, momentum.map(Dd::of)))
    }
}

fn many(count: usize, seed: u64) {
    let mut random = Random(seed);
    let mut worst: Vec<(&str, [f64; 4], usize, usize, [f64; 2])> = Vec::new();
    for case in 0..count {
        let (kind, moments, wheel, start) = random.gyrostat();
        let place = worst.iter().position(|row| row.0 == kind).unwrap_or_else(|| {
            worst.push((kind, [0.0; 4], 0, 0, [0.0; 2]));
            worst.len() - 1
        });
        worst[place].2 += 1;
        let orbit = match GyrostatOrbit::new(moments, wheel, start) {
            Ok(orbit) => orbit,
            Err(reason) => {
                worst[place].3 += 1;
                println!(
                    "{case} {kind} {reason:?} {:?}",
                    [moments, wheel, start.momentum_body].map(|v| v.map(Dd::hi))
                );
                continue;
            }
        };
        let fast = (start.momentum_body.norm() + wheel.norm()).hi()
            / moments.0.iter().map(|i| i.hi()).fold(9.0, f64::min);
        let [one, two] = [(); 2].map(|()| random.number() * random.decade(-1.0, 3.0) / fast);
        let far = random.number() * random.decade(0.0, 9.0) / fast;
        let [q, m] = off(&orbit.point_after(Dd::of(far)).to_dd(), &orbit.point_at_dd(Dd::of(far)));
        // the motion from a later start is the same motion
        let later = match GyrostatOrbit::new(moments, wheel, orbit.point_at_dd(Dd::of(one))) {
            Ok(orbit) => orbit,
            Err(reason) => {
                worst[place].3 += 1;
                println!(
                    "{case} {kind} later {reason:?} {:?}",
                    [moments, wheel, start.momentum_body].map(|v| v.map(Dd::hi))
                );
                continue;
            }
        };
        let [q_later, m_later] =
            off(&later.point_at_dd(Dd::of(two)), &orbit.point_at_dd(Dd::of(one) + Dd::of(two)));
        if let (Kind::Moving(a), Kind::Moving(b)) = (&orbit.kind, &later.kind) {
            let rate = ((a.spinor.rate * a.rate - b.spinor.rate * b.rate).magnitude()) / fast;
            let twists = (a.spinor.twist * a.rate - b.spinor.twist * b.rate) / (a.spinor.rate * a.rate * 0.5);
            let twist = (twists - twists.round()).magnitude() * (a.spinor.rate * a.rate).hi() / fast;
            if rate > worst[place].4[0] || twist > worst[place].4[1] {
                println!("{case} {kind} rate {rate:.1e} twist {twist:.1e}");
                worst[place].4 = [rate.max(worst[place].4[0]), twist.max(worst[place].4[1])];
            }
        }
        if q > 3e-15 || q_later > worst[place].1[2] {
            let Kind::Moving(moving) = &orbit.kind else { continue };
            println!(
                "{case} {kind} {q:.1e} {m:.1e} {q_later:.1e} terms {} {}",
                moving.spinor.terms.len(),
                moving.quick.as_ref().map_or(0, |quick| quick.terms.len())
            );
        }
        for (x, new) in worst[place].1.iter_mut().zip([q, m, q_later, m_later]) {
            *x = x.max(new);
        }
    }
    for (kind, [q, m, q_later, m_later], all, refused, [rate, twist]) in worst {
        println!(
            "{kind:12} {all} refused {refused}  {q:.1e} {m:.1e}   {q_later:.1e} {m_later:.1e} rate {rate:.1e} {twist:.1e}"
        );
    }
}

#[test]
fn doubles_and_later_starts_agree() {
    many(3000, 1);
}

#[test]
#[ignore = "takes seconds, `.ci/run` does it"]
fn doubles_and_later_starts_agree_in_many_cases() {
    many(100_000, 2);
}

#[test]
#[ignore = "a measurement, which prints"]
fn times() {
    let mut random = Random(5);
    let draws: Vec<_> = (0..2000).map(|_| random.gyrostat()).collect();
    let clock = std::time::Instant::now();
    let orbits: Vec<_> =
        draws.iter().filter_map(|(_, i, h, x)| GyrostatOrbit::new(*i, *h, *x).ok()).collect();
    println!("set-up {:?}", clock.elapsed() / 2000);
    let clock = std::time::Instant::now();
    let mut sum = 0.0;
    for orbit in &orbits {
        for n in 0..100 {
            sum += orbit.point_after(Dd::of(f64::from(n) * 10.123)).attitude.w;
        }
    }
    println!("double {:?} {sum}", clock.elapsed() / (100 * orbits.len() as u32));
    let clock = std::time::Instant::now();
    for orbit in &orbits {
        for n in 0..10 {
            sum += orbit.point_at_dd(Dd::of(f64::from(n) * 10.123)).attitude.w.hi();
        }
    }
    println!("double-double {:?} {sum}", clock.elapsed() / (10 * orbits.len() as u32));
}

#[test]
#[ignore = "prints"]
fn scan() {
    use crate::flow::gyrostat::steady_spins;
    let mut random = Random(11);
    for _ in 0..6 {
        let moments = random.vector().map(|x| 1.5 + 0.5 * x).map(Dd::of);
        let wheel = (random.vector() * 0.2).map(Dd::of);
        let spins = steady_spins(moments, wheel, Dd::ONE);
        let Some(saddle) = spins.iter().find(|spin| spin.growth_rate > 0.0) else { continue };
        let along = random.vector();
        println!("{saddle:?}");
        for k in 1..=15 {
            let m = saddle.momentum + along * libm::exp10(-f64::from(k));
            let q = Quat::identity();
            let start = Point::new(q, m.map(Dd::of));
            let one = match GyrostatOrbit::new(moments, wheel, start) {
                Ok(one) => one,
                Err(e) => {
                    println!("{k} {e}");
                    continue;
                }
            };
            let Kind::Moving(moving) = &one.kind else { continue };
            let mut worst = [0.0_f64; 4];
            for n in 0..20 {
                let t = Dd::of(f64::from(n) * 10.0);
                let later = match GyrostatOrbit::new(moments, wheel, one.point_at_dd(t)) {
                    Ok(x) => x,
                    Err(e) => {
                        println!("later {e}");
                        continue;
                    }
                };
                let two = Dd::of(50.0);
                let [a, b] = off(&later.point_at_dd(two), &one.point_at_dd(t + two));
                let [c, d] = off(&one.point_after(t).to_dd(), &one.point_at_dd(t));
                for (x, new) in worst.iter_mut().zip([a, b, c, d]) {
                    *x = x.max(new);
                }
            }
            let level = match Level::of(moments, wheel, start.momentum_body) {
                Course::Moving(l) => l,
                _ => continue,
            };
            let lattice = Lattice::new(&level.pencil);
            println!(
                "{k} T {:.4} terms {} {} apart {:.1e} y/T {:.3} skew {} dis {:.1e} defect {:.1e} later {:.1e} {:.1e} f64 {:.1e} {:.1e}",
                moving.period.hi(),
                moving.spinor.terms.len(),
                moving.quick.as_ref().map_or(0, |quick| quick.terms.len()),
                level.pencil.apart,
                lattice.ratio().hi(),
                lattice.is_skew,
                moving.spinor.disagreement,
                defect(&level, &moving.spinor),
                worst[0],
                worst[1],
                worst[2],
                worst[3]
            );
        }
    }
}
